"""Constants of solvers and of the estimate of a run that were found by trial: what each was calibrated on, and its test."""

from math import pi
from typing import Generic, NamedTuple, TypeVar

Value = TypeVar("Value", float, tuple[float, ...])


class Calibrated(NamedTuple, Generic[Value]):
    """value: a number, or factors c_1, c_2, … of: what it is, or what they multiply. on: what it was calibrated on. held_by:
    the test that fails when it is wrong, file::name."""

    value: Value
    of: str
    on: str
    held_by: str


# LSODA leaves up to 200 times the error that it is given, and cannot be given much less than 1e-13. 10 s of the displaced
# pair: an error of 1e-10 takes LSODA 9 ms, Adams of order 12 11 ms, DOP853 in Python 60; one of 1e-13 only Adams reaches,
# in 16 ms.
CROSSOVER = Calibrated(
    5e-11,
    "tolerance from which LSODA is faster than Adams in equal steps",
    "10 s of the displaced pair at tolerances 1e-3 to 1e-13",
    "test_scenes_and_methods.py::test_errors_and_evaluations_stay_under_their_ceilings",
)
LSODA_SAFETY = Calibrated(
    200.0,
    "tolerance of a run over the local error that LSODA is given",
    "10 s of the displaced pair at tolerances 1e-3 to 1e-10",
    "test_scenes_and_methods.py::test_errors_and_evaluations_stay_under_their_ceilings",
)
DETOUR = Calibrated(
    4 * pi,
    "angle (rad, of the typical rate) over which DOP853 first goes on where another solver stops",
    "the 1,000 wide scenes: those of more than 500 turns beside a dead point",
    "test_cost.py::test_no_run_takes_ten_times_as_long_as_the_best_rung",
)


_WIDE = "300 wide scenes of rotor pairs of up to 100 turns against 80-bit integrations, core and fast"
_COST = "test_cost.py::test_no_run_takes_ten_times_as_long_as_the_best_rung"
_TRIAL = "test_wide_scenes.py::test_no_miss_is_silent"
APART = Calibrated(
    8.0,
    "ratio of the local errors of the two runs that are compared, a power of two",
    "the 1,000 wide scenes and 300 wide systems: of 5 one scene has two runs that are off alike, of 16 two systems",
    "test_wide_scenes.py::test_two_runs_at_local_errors_too_near_each_other_are_off_alike",
)
FIRST = Calibrated(
    1 / 3,
    "local error of the first companion over the wanted error of the run",
    f"{_WIDE}: 19 of 20 need no other",
    _TRIAL,
)
SHORTEST = Calibrated(
    400.0,
    "ten turns over the run beyond which the local error of the first companion no longer grows with their ratio",
    "554 wide scenes of up to 11 turns: local errors gather to less than in proportion in nine of ten",
    _COST,
)
SAFETY = Calibrated(
    2.5,
    "error of the better of two runs over their difference; its square where rounding may be most of it",
    "the 300 wide systems: the estimate is 20 times the true error in the median",
    "test_wide_systems.py::test_an_error_is_known_at_many_times_and_would_be_missed_if_it_were_not",
)
RESOLVED = Calibrated(
    5e-12,
    "local error of the better run below which SAFETY counts twice: rounding may be nearly all that differs between the two",
    "518 pairs of runs of 175 wide scenes: those that exceed twice their difference by much are all below it",
    "test_estimated_run.py::test_below_what_is_resolved_safety_counts_twice",
)
LEAST = Calibrated(
    1e-3,
    "least error over the local error: two runs of a short stretch may take the same few steps and agree",
    "3,881 scenes of up to 20 turns, apart from the recorded ones",
    "test_estimated.py::test_runs_that_take_the_same_steps_are_not_known_to_be_right",
)
LOOSEST = Calibrated(
    0.1,
    "largest local error that a solver is given",
    "the solvers' own tests",
    "test_integrate.py::test_tolerances_out_of_reach_are_refused",
)
GIVEN_UP = Calibrated(1e-5, "local error beyond which no looser run is tried", _WIDE, _TRIAL)
LOST = Calibrated(
    0.1, "error at which two runs have parted; where no tolerance keeps below it, none is tried", _WIDE, _TRIAL
)
ROUNDING = Calibrated(2e-15, "error a turn that no tolerance avoids", _WIDE, _TRIAL)
START = Calibrated(
    3.0,
    "turns whose rounding the start alone brings, in coordinates that it is not given in",
    "the pairs of APART: without it two runs of 0.03 turns are off by 1.7 times what is estimated",
    _TRIAL,
)
SWING = Calibrated(
    0.5,
    "turns within which two runs that part swing through each other: the error up to a time is the difference up to then and so "
    "much later",
    "seed 1209 of the wide systems and one of seeds 2004 to 2099 exceed it without; with it three of seeds 3000 to 3119 still do,"
    " one by 3.8 times",
    "test_wide_systems.py::test_one_of_each_kind_keeps_its_promise",
)
KEPT = Calibrated(
    100.0,
    "times the error estimate that conserved quantities may be off",
    f"{_WIDE}: 99 of 100 runs are off by less than twice the estimate",
    "test_estimated.py::test_a_run_that_does_not_conserve_is_refused",
)
MOST_EVENTS = Calibrated(
    20_000,
    "events of a run, beyond which its budget is spent",
    "a choice, on which no accuracy depends: none of the tests' systems comes near it",
    "test_events.py::test_a_run_of_too_many_events_is_stopped",
)
DEPENDENT = Calibrated(
    1e-4,
    "least singular value of the constraints' rows, each of length one in units of the sizes, below which rounding counts",
    "a point on the circle in which a plane cuts a unit sphere near its pole: of 2e-4 the estimate holds without, of 2e-6 not",
    "test_simulation.py::test_constraints_that_are_nearly_dependent_are_known_no_better_than_they_can_be",
)
