"""Empirical constants of the closed forms, each with its calibration and the test that checks it.

The powers and the quantities that they multiply are derived; only the factors are empirical.
"""

from lagrotor.numerics.solver_constants import Calibrated

_RATE = "test_natural_rate.py::"
LARGEST_SWING = Calibrated(
    0.4,
    "amplitude beyond which the errors below are not estimated",
    "150 pairs with 0.5 < k < 2 and any two spins, 20 oscillations each; beyond it pairs topple over within 24 oscillations",
    _RATE + "test_an_amplitude_out_of_range_is_refused",
)
_SWUNG = "pairs with 0.15 < k < 4, bars up to 50 kg and any two spins, oscillations of any phase over 20 periods, and orbits; "
NEXT_SHIFT = Calibrated(
    3.0,
    "factor of N r⁴, the size of the next order of the natural rate's shift",
    _SWUNG + "the largest factor of 3,319 orbits is 1.22",
    _RATE + "test_natural_rate",
)
LARGEST_SHIFT = Calibrated(
    0.12,
    "largest sqrt(N) r² for which successive orders of the natural rate's shift decrease",
    _SWUNG
    + "10,000 oscillations deviate by at most 0.71 of the estimated error, and none of 3,319 orbits by more than it",
    _RATE + "test_the_rate_of_an_orbit_about_upright",
)
LIGHTEST_TWIST = Calibrated(
    0.5,
    "largest sigma r², which is the inertia that the lean adds to a twist, divided by the inertia a − b of the twist",
    _SWUNG + "beyond it the estimate fails for orbits of nearly equal spins",
    _RATE + "test_where_the_twist_grows_or_has_little_inertia_is_refused",
)
MOST_GROWTH = Calibrated(
    6.0,
    "largest lambda t over 20 periods; a twist that grows more moves the oscillation away from the upright position",
    _SWUNG + "of 83 orbits with lambda t above 9 the estimate fails for 4, all with lambda t of 14 or more",
    _RATE + "test_where_the_twist_grows_or_has_little_inertia_is_refused",
)
