"""Numbers of this room that were found by trial: what each one is, what it was calibrated on, and the test that holds it.

The powers and the letters that they multiply are derived; the factors in front are empirical wherever they are used.
"""

from lagrotor.numerics.calibrated import Calibrated

_DRIFT = "test_drift_after_shock.py::"
_RATE = "test_natural_rate.py::"
_SHOCKED = (
    "1400 opposite pairs with 0.4 < k < 2.5, m up to 2 kg, K up to m ell², widths up to 1.2/Omega_0, 24 swings, and 600 with "
    "0.3 < sigma < 3 over 8 to 60 swings; largest "
)

LARGEST_SWING = Calibrated(
    0.4,
    "amplitude beyond which the errors below are not estimated",
    "150 pairs with 0.5 < k < 2, any two spins, 20 swings; beyond it runs over 24 swings topple over",
    _RATE + "test_an_amplitude_out_of_range_is_refused",
)
_SWUNG = (
    "pairs with 0.15 < k < 4, bars up to 50 kg, any two spins, swings of any phase over 20 turns and exact orbits; "
)
NEXT_SHIFT = Calibrated(
    3.0,
    "N r⁴, of which size the next order of the natural rate's shift is",
    _SWUNG + "1.22 is the most of 3,319 orbits",
    _RATE + "test_natural_rate",
)
LARGEST_SHIFT = Calibrated(
    0.12,
    "sqrt(N) r², beyond which the orders of the natural rate's shift no longer fall",
    _SWUNG + "2,077 swings miss by at most 0.72 of the error, none of 3,319 orbits by more than it",
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
FOURTH_ORDER = Calibrated(
    (1.0, 1.1, 0.1, 0.7),
    "|G| q⁴ (c_1/k + c_2/k³) + |P| q² (c_3 + c_4/k²), over a + b: the toppling rate's next order",
    _SHOCKED + "0.72 of it",
    _DRIFT + "test_toppling_after_a_shock",
)
FIFTH_ORDER = Calibrated(
    (0.4, 1.3, 6.0, 8.0),
    "|G| q⁵ (c_1 + c_2/k⁴) + |P| q³ (c_3 + c_4/k²), over a + b: the next order of the rate of the mean x",
    _SHOCKED + "0.86 of it",
    _DRIFT + "test_the_mean_x_after_a_shock",
)
CANCELLING = Calibrated(
    1.2,
    "q² (1 + 1/k²): relative distance of the second order's cancelling force from that of exact runs",
    "220 opposite pairs as above with q > 0.05, 8 to 40 swings; largest 0.65 of it",
    _DRIFT + "test_cancelling_force_of_random_pairs",
)
FARTHEST_TURN = Calibrated(
    3.0,
    "rad turned about the joint line beyond which a rate is no longer that of the start",
    "the same pairs; about there the estimates grow past the rates",
    _DRIFT + "test_what_is_out_of_range_is_refused",
)
