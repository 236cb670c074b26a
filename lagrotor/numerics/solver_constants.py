"""Calibrated constants of the solvers and of the error estimate, each with its calibration and its test."""

from math import pi
from typing import Generic, NamedTuple, TypeVar

Value = TypeVar("Value", float, tuple[float, ...])


class Calibrated(NamedTuple, Generic[Value]):
    """A number, or factors c_1, c_2, …, that was found by trial. `of` is its meaning, `on` the runs on which it was found, and
    `test` the test that fails for wrong values."""

    value: Value
    of: str
    on: str
    test: str


# The error of LSODA is up to 200 times its local error, which cannot be much below 1e-13. 10 s of the displaced pair with an
# error of 1e-10 take LSODA 9 ms, Adams of order 12 11 ms, DOP853 in Python 60 ms; 1e-13 only Adams reaches, in 16 ms.
CROSSOVER = Calibrated(
    5e-11,
    "tolerance from which LSODA is faster than Adams in equal steps",
    "10 s of the displaced pair at tolerances 1e-3 to 1e-13",
    "test_scenes_and_methods.py::test_errors_and_evaluations_stay_under_their_ceilings",
)
LSODA_SAFETY = Calibrated(
    200.0,
    "tolerance of a run divided by the local error of LSODA",
    "10 s of the displaced pair at tolerances 1e-3 to 1e-10",
    "test_scenes_and_methods.py::test_errors_and_evaluations_stay_under_their_ceilings",
)
DETOUR = Calibrated(
    4 * pi,
    "typical rate times the time (rad) for which DOP853 first continues when another solver stops",
    "the 1,000 wide scenes: those of more than 500 turns beside a dead point",
    "test_cost.py::test_no_run_takes_ten_times_as_long_as_the_best_rung",
)


_WIDE = "300 wide scenes of rotor pairs of up to 100 turns against 80-bit integrations, core and fast"
_COST = "test_cost.py::test_no_run_takes_ten_times_as_long_as_the_best_rung"
_TRIAL = "test_wide_scenes.py::test_no_miss_is_silent"
APART = Calibrated(
    8.0,
    "ratio of the local errors of the two runs that are compared, a power of two",
    "the 1,000 wide scenes and 300 wide systems: at 5 the runs of one scene share their error, at 16 those of two systems",
    "test_wide_scenes.py::test_two_runs_at_local_errors_too_near_each_other_are_off_alike",
)
FIRST = Calibrated(
    1 / 3,
    "local error of the first companion divided by the tolerance of the run",
    f"{_WIDE}: 19 of 20 need no second pair",
    _TRIAL,
)
SHORTEST = Calibrated(
    400.0,
    "the local error of the first companion is proportional to 10 / (turns of the run), up to this ratio",
    "554 wide scenes of up to 11 turns: in nine of ten the sum of local errors grows more slowly than the time",
    _COST,
)
SAFETY = Calibrated(
    2.5,
    "estimated error of the better of two runs divided by their difference; squared where that may be mostly rounding",
    "the 300 wide systems: the estimate is 20 times the true error in the median",
    "test_wide_systems.py::test_an_error_is_known_at_many_times_and_would_be_missed_if_it_were_not",
)
RESOLVED = Calibrated(
    5e-12,
    "local error of the better run below which SAFETY counts twice: the difference of the runs may be mostly rounding",
    "518 pairs of runs of 175 wide scenes: all errors far above twice the difference are below it",
    "test_estimated_run.py::test_below_what_is_resolved_safety_counts_twice",
)
LEAST = Calibrated(
    1e-3,
    "least estimated error divided by the local error, since two short runs may take the same few steps and agree",
    "3,881 scenes of up to 20 turns, apart from the recorded ones",
    "test_estimated.py::test_runs_that_take_the_same_steps_are_not_known_to_be_right",
)
LOOSEST = Calibrated(
    0.1,
    "largest local error of a solver",
    "the solvers' own tests",
    "test_integrate.py::test_tolerances_out_of_reach_are_refused",
)
GIVEN_UP = Calibrated(1e-5, "local error beyond which no looser run is tried", _WIDE, _TRIAL)
LOST = Calibrated(
    0.1,
    "error from which a state counts as unknown; if no tolerance keeps the error below it, none is tried",
    _WIDE,
    _TRIAL,
)
ROUNDING = Calibrated(2e-15, "error per turn that no tolerance avoids", _WIDE, _TRIAL)
START = Calibrated(
    3.0,
    "rounding of the initial state in turns, where it is converted to other coordinates",
    "the pairs of APART: without it the error of two runs of 0.03 turns is 1.7 times the estimate",
    _TRIAL,
)
SWING = Calibrated(
    0.5,
    "turns within which two runs that separate may cross: the error at a time includes differences up to this many turns later",
    "without it seed 1209 of the wide systems and one of seeds 2004 to 2099 exceed the estimate; with it three of seeds 3000 to "
    "3119, one by 3.8 times",
    "test_wide_systems.py::test_one_of_each_kind_keeps_its_promise",
)
KEPT = Calibrated(
    100.0,
    "largest error of conserved quantities divided by the error estimate",
    f"{_WIDE}: 99 of 100 runs stay below twice the estimate",
    "test_estimated.py::test_a_run_that_does_not_conserve_is_refused",
)
MOST_EVENTS = Calibrated(
    20_000,
    "largest number of events of a run",
    "a choice on which no accuracy depends: no system of the tests comes near it",
    "test_events.py::test_a_run_of_too_many_events_is_stopped",
)
DEPENDENT = Calibrated(
    1e-4,
    "least singular value of the constraints' rows, each of length one in units of the sizes, below which rounding counts",
    "a point on the circle in which a plane cuts a unit sphere near its pole: at 2e-4 the estimate holds without it, at 2e-6 not",
    "test_simulation.py::test_constraints_that_are_nearly_dependent_are_known_no_better_than_they_can_be",
)
