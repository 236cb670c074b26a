"""Empirical constants of the closed forms, each with its calibration and the test that checks it.

The powers and the quantities that they multiply are derived; only the factors are empirical.
"""

from lagrotor.numerics.solver_constants import Calibrated

_RATE = "test_natural_rate.py::"
LARGEST_SWING = Calibrated(
    0.4,
    "amplitude beyond which the errors below are not estimated",
    "150 pairs with 0.5 < k < 2, any two spins, 20 swings; beyond it runs over 24 swings topple over",
    _RATE + "test_an_amplitude_out_of_range_is_refused",
)
_SWUNG = "pairs with 0.15 < k < 4, bars up to 50 kg, any two spins, swings of any phase over 20 turns and orbits; "
NEXT_SHIFT = Calibrated(
    3.0,
    "factor of N r⁴, the size of the next order of the natural rate's shift",
    _SWUNG + "1.22 is the most of 3,319 orbits",
    _RATE + "test_natural_rate",
)
LARGEST_SHIFT = Calibrated(
    0.12,
    "sqrt(N) r², beyond which the orders of the natural rate's shift no longer fall",
    _SWUNG + "10,000 swings miss by at most 0.71 of the error, none of 3,319 orbits by more than it",
    _RATE + "test_the_rate_of_an_orbit_about_upright",
)
LIGHTEST_TWIST = Calibrated(
    0.5,
    "sigma r²: what the lean adds to the inertia of a twist, a − b, over that",
    _SWUNG + "beyond it orbits of nearly equal spins missed",
    _RATE + "test_where_the_twist_grows_or_has_little_inertia_is_refused",
)
MOST_GROWTH = Calibrated(
    6.0,
    "lambda t over 20 turns: a twist that grows more takes the swing away from upright",
    _SWUNG + "4 of 83 beyond 9 missed, the least at 14",
    _RATE + "test_where_the_twist_grows_or_has_little_inertia_is_refused",
)
