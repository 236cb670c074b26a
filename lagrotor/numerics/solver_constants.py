"""Constants of the solvers that were found by trial: what each was calibrated on, and the test that holds it."""

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
