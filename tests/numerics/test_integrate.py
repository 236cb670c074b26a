"""The solver: its order, its pulses, and how it stops."""

from dataclasses import replace
from math import cos, erf, pi, sqrt

import numpy as np
import pytest

from lagrotor.errors import InputError, IntegrationError
from lagrotor.numerics import integrate as module
from lagrotor.numerics import solvers
from lagrotor.numerics.integrate import Problem, check_tolerance, integrate
from lagrotor.numerics.pulse import pulse_windows
from lagrotor.numerics.segment import Array, RightHandSide, Segment, StopError, Stretch
from lagrotor.numerics.solver_constants import DETOUR

ENOUGH = 1e6
START = np.array([1.0, 0.0])


def oscillate(s: float, y: Array) -> list[float]:
    return [y[1], -y[0]]


def kick(strength: float, width: float) -> RightHandSide:
    def rate(s: float, y: Array) -> list[float]:
        return [y[1], strength * np.exp(-((s / width) ** 2))]

    return rate


def drift(s: float, y: Array) -> list[float]:
    return [y[1], 0.0]


def gained(strength: float, at: float, width: float, times: Array, tol: float) -> Array:
    """Momentum at `times` of a free unit mass under the pulse."""
    problem = Problem(drift, np.zeros(2), ENOUGH, kick(strength, width), at, pulse_windows(width))
    return integrate(problem, times, tol).states[:, 1]


def impulse(strength: float, at: float, width: float, t: float) -> float:
    """The pulse integrated from 0 to t."""
    return strength * width * sqrt(pi) / 2 * (erf((t - at) / width) - erf(-at / width))


def test_the_error_falls_with_the_tolerance_and_stays_below_it() -> None:
    errors, evaluations = [], []
    for tol in (1e-3, 1e-6, 1e-9, 1e-12):
        solution = integrate(Problem(oscillate, START, ENOUGH), np.array([10.0]), tol)
        errors.append(abs(solution.states[0, 0] - cos(10)))
        evaluations.append(solution.evaluations)
        assert errors[-1] < tol
    assert errors == sorted(errors, reverse=True)
    assert evaluations == sorted(evaluations)
    # A thousandth of the error, by order 12, for three times the steps.
    assert evaluations[-1] < 3.5 * evaluations[-2]


WIDTHS = [1e-1, 1e-3, 1e-5, 1e-7, 1e-9]


@pytest.mark.parametrize("tol", [1e-2, 1e-6, 1e-11])
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("at", [4.3717, pi, 0.999999])
def test_no_pulse_is_stepped_over(at: float, width: float, tol: float) -> None:
    """Unit impulse, sparse outputs far from it, whatever the tolerance."""
    strength = 1 / (width * sqrt(pi))
    before, after = gained(strength, at, width, np.array([at / 4, 9.0]), tol)
    assert before == pytest.approx(0, abs=1e-12)
    assert after == pytest.approx(1, abs=min(tol, 1e-4))


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("offset", [0.0, 0.3, 1.7, -0.5, -2.0, 6.5, -6.5])
def test_a_run_that_starts_within_the_pulse_gets_the_rest_of_it(width: float, offset: float) -> None:
    at, strength = offset * width, 1 / width
    expected = impulse(strength, at, width, 5.0)
    assert gained(strength, at, width, np.array([5.0]), 1e-9)[0] == pytest.approx(expected, abs=1e-8)
    if 0 <= offset < 2:
        # Twin: the whole pulse, or half of it, is another number.
        assert expected != pytest.approx(sqrt(pi), abs=1e-3)


def test_output_times_may_lie_on_the_edges() -> None:
    """The cuts of the run, the start and the end, belong to one segment each."""
    at, width = 2.0, 0.125
    edges = np.array([0.0, at - 6.5 * width, at, at + 6.5 * width, 5.0])
    expected = [impulse(1.0, at, width, t) for t in edges]
    assert gained(1.0, at, width, edges, 1e-11) == pytest.approx(expected, abs=1e-11)


def test_the_start_alone_and_a_late_start() -> None:
    only = integrate(Problem(oscillate, START, ENOUGH), np.array([0.0]), 1e-9)
    assert only.states.tolist() == [[1, 0]]
    assert only.evaluations == 0
    late = integrate(Problem(oscillate, START, ENOUGH), np.array([2.0, 3.0]), 1e-10).states
    assert late[:, 0] == pytest.approx(np.cos([2, 3]), abs=1e-9)
    pulsed = integrate(
        Problem(drift, np.zeros(2), ENOUGH, kick(1, 0.1), 0.3, pulse_windows(0.1)), np.array([0.0]), 1e-9
    )
    assert pulsed.states.tolist() == [[0, 0]]


def test_a_motion_that_blows_up_is_stopped_where_it_does() -> None:
    with pytest.raises(IntegrationError, match=r"near t = 0\.5 s .* take another tol"):
        integrate(Problem(lambda s, y: [y[0] ** 2], np.array([2.0]), ENOUGH), np.array([1.0]), 1e-9)
    # Twin: short of the pole it is followed.
    near = integrate(Problem(lambda s, y: [y[0] ** 2], np.array([2.0]), ENOUGH), np.array([0.49]), 1e-9)
    assert near.states[0, 0] == pytest.approx(100, rel=1e-6)


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
@pytest.mark.parametrize("since", [0.0, 0.7])
def test_a_rate_that_is_not_finite_stops_the_run(since: float, bad: float) -> None:
    with pytest.raises(IntegrationError, match=f"near t = {since:g}"), np.errstate(invalid="ignore"):
        integrate(Problem(lambda s, y: [bad if s >= since else 1.0], np.zeros(1), ENOUGH), np.array([1.0]), 1e-6)


@pytest.mark.parametrize("tol", [1e-6, 1e-12])
@pytest.mark.parametrize("bare", [False, True])
def test_a_run_that_finishes_is_kept_whatever_it_took(tol: float, bare: bool) -> None:
    """LSODA counts the evaluations of a bare right-hand side when it is done."""

    def rhs(s: float, y: Array) -> list[float]:
        return oscillate(s, y)

    if bare:
        rhs.bare = oscillate  # type: ignore[attr-defined]
    times = np.linspace(1, 10, 10)
    needed = integrate(Problem(rhs, START, ENOUGH), times, tol)
    again = integrate(Problem(rhs, START, needed.evaluations - 1), times, tol)
    assert (again.states == needed.states).all() and again.evaluations == needed.evaluations


@pytest.mark.parametrize("tol", [1e-6, 1e-12])
def test_a_budget_that_is_spent_is_said_with_all_that_was_spent_and_reached(tol: float) -> None:
    calls = 0

    def counted(s: float, y: Array) -> list[float]:
        nonlocal calls
        calls += 1
        return oscillate(s, y)

    times = np.linspace(0, 2e4, 2001)
    with pytest.raises(StopError, match=r"did not end within \d+ evaluations.*larger tol or a shorter run") as stopped:
        integrate(Problem(counted, START, 20_000, typical_rate=1.0), times, tol)
    stop = stopped.value
    assert stop.cause == "budget" and stop.evaluations == pytest.approx(calls, abs=30) and calls < 41_000
    reached = stop.reached
    assert reached is not None and (times[: len(reached.states)] <= stop.at).all()
    assert np.abs(reached.states[:, 0] - np.cos(times[: len(reached.states)])).max() < 2e4 * tol
    assert len(reached.states) > 1 or tol > 1e-10  # what LSODA has made is not known


def test_what_lsoda_made_before_it_failed_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    times, odeint = np.linspace(0.5, 9.5, 10), solvers._odeint

    def fails(segment: Segment, rhs: RightHandSide, error: float, first: float):  # type: ignore[no-untyped-def]
        states, log = odeint(replace(segment, until=6.0, t_eval=times[times <= 6]), rhs, error, first)
        rest = np.full((1 + len(times) - len(states[1:-1]), 2), 7.0)  # no number that it made
        return np.concatenate([states[:-1], rest]), log | {"message": "Repeated error test failures"}

    segment = Segment(oscillate, START, 0.0, 10.0, times)
    assert solvers.lsoda(segment, 1e-9).states[:, 0] == pytest.approx(np.cos(times), abs=1e-6)
    monkeypatch.setattr(solvers, "_odeint", fails)
    with pytest.raises(StopError, match="Repeated error test failures") as stopped:
        solvers.lsoda(segment, 1e-9)
    reached = stopped.value.reached
    assert reached is not None and stopped.value.at == times[len(reached.states) - 1] <= 6 and len(reached.states) >= 5
    assert reached.states[:, 0] == pytest.approx(np.cos(times[: len(reached.states)]), abs=1e-6)


def test_steps_are_not_shortened_for_what_rounding_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    """A force known to twelve digits: no shorter step lowers the error beyond, and one that does no more is left alone."""

    def rounded(s: float, y: Array) -> list[float]:
        return [y[1], -((3 * y[0] + 1e4) - 1e4) / 3]

    times = np.linspace(0, 20, 41)
    problem = Problem(rounded, START, ENOUGH, typical_rate=1.0)
    found = integrate(problem, times, 1e-12)
    assert found.states[:, 0] == pytest.approx(np.cos(times), abs=5e-12)
    assert found.evaluations < 8_000
    monkeypatch.setattr(solvers, "_IN_VAIN", 1_000)
    assert integrate(problem, times, 1e-12).evaluations > 40_000


@pytest.mark.parametrize("tol", [0, -1e-9, 1e-14, 0.2, float("nan"), float("inf"), "1e-9", None])
def test_tolerances_out_of_reach_are_refused(tol: object) -> None:
    with pytest.raises(InputError, match=r"tol = .* must lie between 1e-13"):
        check_tolerance(tol)  # type: ignore[arg-type]


@pytest.mark.parametrize(("reached", "lost"), [(True, 0), (False, 0), (False, 200), (False, 10**6)])
def test_where_a_solver_stops_dop853_goes_on_and_the_solver_returns(
    monkeypatch: pytest.MonkeyPatch, reached: bool, lost: int
) -> None:
    """From where it came, or from where it began; once as many evaluations are taken as the trial lost, if that ever pays."""
    begun, right, taken, follow = list[float](), module.lsoda, [0], module.dop853

    def stops(segment: Segment, error: float) -> Stretch:
        begun.append(segment.begin)
        if segment.begin > 3:
            return right(segment, error)
        until = segment.begin + 1
        part = replace(segment, until=until, t_eval=segment.t_eval[segment.t_eval <= until])
        raise StopError(until, "no more steps", right(part, error) if reached else None, lost)

    def follows(segment: Segment, error: float) -> Stretch:
        run = follow(segment, error)
        taken.append(run.evaluations)
        return run

    monkeypatch.setattr(module, "lsoda", stops)
    monkeypatch.setattr(module, "dop853", follows)
    times = np.linspace(0, 20, 81)
    problem = Problem(oscillate, START, 1e8, typical_rate=DETOUR.value)  # a detour of one second
    solution = integrate(problem, times, 1e-8)
    assert solution.states[:, 0] == pytest.approx(np.cos(times), abs=1e-7)
    if lost == 10**6:  # to the end, where no more would be saved
        assert begun == [0] and sum(taken) < 10_000
    else:
        detours = int(np.searchsorted(np.cumsum(taken), lost)) or 1
        assert begun[1] == pytest.approx(2 if reached else detours) and begun[-1] > 3
        assert (detours > 1) == (lost > 0)
