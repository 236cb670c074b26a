"""Constants of the models that were found by trial: what each was calibrated on, and the test that holds it."""

from math import pi

from lagrotor.numerics.solver_constants import Calibrated

_WIDE = "300 wide scenes of up to 100 turns against 80-bit integrations, core and fast"
_BEYOND = "test_estimated.py::test_where_two_runs_have_parted_the_rest_is_cheap"
_COST = "test_cost.py::test_no_run_takes_ten_times_as_long_as_the_best_rung"
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
    "SHORTEST": Calibrated(
        400.0,
        "ten turns over the run beyond which the tolerance of the first companion no longer grows with their ratio",
        "554 wide scenes of up to 11 turns: local errors gather to less than in proportion in nine of ten",
        _COST,
    ),
    "SAFETY": Calibrated(
        2.0,
        "error of the better of two runs over their difference, where rounding hides nothing; where it does, its square",
        "10,281 scenes of up to 20 turns, apart from the recorded ones: exceeded by 26 of 7,260 runs, none missed in silence",
        "test_wide_scenes.py::test_where_rounding_is_all_that_two_runs_resolve_their_difference_is_not_trusted",
    ),
    "RESOLVED": Calibrated(
        1e-12,
        "local error of the better run below which rounding may be nearly all that differs between the two",
        "3,201 further scenes: without it one misses in silence; with it none of 3,199 others, not used in its choice",
        "test_wide_scenes.py::test_where_rounding_is_all_that_two_runs_resolve_their_difference_is_not_trusted",
    ),
    "LEAST": Calibrated(
        1e-3,
        "least error of an axis over the local error: two runs of a short stretch may take the same few steps and agree",
        "3,881 of the same scenes",
        "test_estimated.py::test_runs_that_take_the_same_steps_are_not_known_to_be_right",
    ),
    "MORE": Calibrated(
        3.0,
        "evaluations of a run over those of a looser one beyond which rounding is all that it resolves",
        "554 wide scenes of up to 11 turns",
        _COST,
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
    "STAGE": Calibrated(
        64.0,
        "turns after which two runs are first compared, then after twice as many each time",
        f"{_WIDE}; the 1,000 wide scenes: none is lost in fewer that costs much",
        _BEYOND,
    ),
    "BEYOND": Calibrated(
        1e-6,
        "local error of a run from where it is lost",
        "the pair of the test, tumbling: its energy stays within 4e-7 of itself in 800 turns",
        _BEYOND,
    ),
    "KEPT": Calibrated(
        100.0,
        "times the error estimate that conserved quantities may be off",
        f"{_WIDE}: 99 of 100 runs are off by less than twice the estimate",
        "test_estimated.py::test_a_run_that_does_not_conserve_is_refused",
    ),
    "LINEAR_MARGIN": Calibrated(
        1.2,
        "safety factor on the linear model's error, known to two orders",
        "8,000 random scenes with an estimate up to 0.1: at most 1.05 times off",
        "test_linear.py::test_the_linear_error_is_bounded",
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
OPPOSITE = 2.0  # the most by which two axes differ: an error of which nothing is known
APART, CLEARLY, FIRST, SHORTEST, SAFETY, RESOLVED, LEAST, MORE, LOOSEST, GIVEN_UP, LOST, ROUNDING, *_REST = (
    entry.value for entry in TABLE.values()
)
STAGE, BEYOND, KEPT, LINEAR_MARGIN, GATHERED, SHORT = _REST


def gathered_error(tol: float, angle: float) -> float:
    """Largest global error of a run at local error `tol` over `angle` (rad) of typical rate whose neighbours stay close."""
    return GATHERED * tol * max(1.0, angle / (2 * pi * SHORT))
