"""Constants of the models that were found by trial: what each was calibrated on, and the test that holds it."""

from math import pi

from lagrotor.numerics.solver_constants import Calibrated

_WIDE = "300 wide scenes of up to 100 turns against 80-bit integrations, core and fast"
_TRIAL = "test_wide_scenes.py::test_no_miss_is_silent"
TABLE = {
    "APART": Calibrated(
        30.0,
        "ratio of the tolerances of a run and its companion: their difference bounds the better one's error",
        _WIDE,
        _TRIAL,
    ),
    "CLEARLY": Calibrated(5.0, "least ratio of the tolerances of a run and its companion", _WIDE, _TRIAL),
    "FIRST": Calibrated(
        1 / 3,
        "tolerance of the first companion over the wanted error",
        f"{_WIDE}: 19 of 20 need no other",
        _TRIAL,
    ),
    "LOOSEST": Calibrated(
        0.1,
        "largest local error that a solver is given",
        "the solvers' own tests",
        "test_integrate.py::test_tolerances_out_of_reach_are_refused",
    ),
    "GIVEN_UP": Calibrated(1e-5, "local error beyond which no looser run is tried", _WIDE, _TRIAL),
    "LOST": Calibrated(
        0.1, "error at which two runs have parted; where no tolerance keeps below it, none is tried", _WIDE, _TRIAL
    ),
    "ROUNDING": Calibrated(2e-15, "error a turn that no tolerance avoids", _WIDE, _TRIAL),
    "KEPT": Calibrated(
        100.0,
        "times the error estimate that conserved quantities may be off",
        f"{_WIDE}: 99 of 100 runs are off by less than twice the estimate",
        "test_estimated.py::test_a_run_that_does_not_conserve_is_refused",
    ),
    "LINEAR_MARGIN": Calibrated(
        2.0,
        "safety factor on the linear model's error, known to leading order, where that is below LINEAR_SMALL",
        "4,397 random scenes: five per cent off below 1e-4, at most 1.93 times off up to 0.01",
        "test_linear.py::test_the_safety_factor_covers_what_the_leading_order_leaves_out",
    ),
    "LINEAR_MARGIN_LARGE": Calibrated(
        5.0,
        "safety factor on the linear model's error where it is not small: the next orders count",
        "10,100 random scenes with an error up to 0.1: at most 3.6 times off",
        "test_linear.py::test_the_safety_factor_covers_what_the_leading_order_leaves_out",
    ),
    "LINEAR_SMALL": Calibrated(
        0.01,
        "error of the linear model up to which the leading order is nearly all of it",
        "10,100 random scenes",
        "test_linear.py::test_the_safety_factor_covers_what_the_leading_order_leaves_out",
    ),
    "GATHERED": Calibrated(
        3e3,
        "global error over local error of a run of SHORT turns whose neighbours stay close",
        f"{_WIDE}: at most 1500",
        _TRIAL,
    ),
    "SHORT": Calibrated(
        20.0,
        "turns after which the error is taken to grow with the run, below which the fast extra integrates at once",
        "random scenes of up to 20 turns",
        "test_choose.py::test_the_fast_extra_misses_none_either_and_foresees_only_long_runs",
    ),
}
APART, CLEARLY, FIRST, LOOSEST, GIVEN_UP, LOST, ROUNDING, KEPT, *_LINEAR, GATHERED, SHORT = (
    entry.value for entry in TABLE.values()
)
LINEAR_MARGIN, LINEAR_MARGIN_LARGE, LINEAR_SMALL = _LINEAR


def linear_bound(error: float) -> float:
    """A bound on the linear model's error, from that error to leading order; two unit vectors are never farther apart than 2."""
    return min((LINEAR_MARGIN if error <= LINEAR_SMALL else LINEAR_MARGIN_LARGE) * error, 2.0)


def gathered_error(tol: float, angle: float) -> float:
    """Largest global error of a run at local error `tol` over `angle` (rad) of typical rate whose neighbours stay close."""
    return GATHERED * tol * max(1.0, angle / (2 * pi * SHORT))
