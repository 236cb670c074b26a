"""The contract of runs, held to motions whose errors are made: what is told of a run is what its two integrations say."""

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.numerics import error_estimate
from lagrotor.numerics.error_estimate import (
    UNKNOWN,
    EstimatedRun,
    EvaluationBudget,
    Evolution,
    errors_up_to,
    estimate_run,
)
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.segment import Array, StopError, Stretch

T = np.linspace(0.0, 10.0, 11)
ENOUGH = EvaluationBudget(1e6, 1e6)
SAFETY, APART, FIRST, ROUNDING, START, LEAST, RESOLVED, LOST, SWING = (
    getattr(error_estimate, name).value
    for name in ("SAFETY", "APART", "FIRST", "ROUNDING", "START", "LEAST", "RESOLVED", "LOST", "SWING")
)


class Made:
    """A state that stays at 1, integrated with an error of `share` times the local error times t; what was asked of it."""

    def __init__(self, share: float = 1.0, least: float = 0.0, growth: float = 0.0, cost: int = 100) -> None:
        self.share, self.least, self.growth, self.cost = share, least, growth, cost
        self.locals, self.budgets, self.spent = list[float](), list[float](), 0
        self.fails: dict[float, StopError] = {}
        self.begun = 0.0

    def __call__(self, start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        self.locals.append(local)
        self.budgets.append(budget)
        self.spent += self.cost
        error = max(local * self.share, self.least) * (1 if companion else 0.5 if self.least else 1)
        since = times - self.begun
        wrong = error * (np.expm1(self.growth * since) if self.growth else since)
        states = 1 + wrong[:, None]
        stop = next((stop for above, stop in self.fails.items() if local <= above), None)
        if stop and times[0] <= stop.at < times[-1]:
            kept = states[times <= stop.at]
            raise StopError(stop.at, stop.reason, Stretch(kept, kept[-1], self.cost), cause=stop.cause)
        return Stretch(states, states[-1], self.cost)

    def evolution(self, **more: Any) -> Evolution:
        given: dict[str, Any] = {"turn": 1.0, "budget": ENOUGH} | more
        return Evolution(np.ones(1), self, lambda one, other: np.abs(one - other)[:, 0], **given)

    def run(self, tol: float, times: Array = T, **more: Any) -> EstimatedRun:
        self.begun = float(times[0])
        return estimate_run(self.evolution(**more), times, tol)


def rounding(t: Array) -> Array:
    return ROUNDING * (START + t)


def test_the_error_is_safety_times_the_difference_and_what_rounding_adds() -> None:
    made = Made(share=0.1)
    run = made.run(1e-6)
    loose, tight = made.locals[:2]
    assert loose == pytest.approx(1e-6 * FIRST) and tight == pytest.approx(loose / APART)
    watched = np.union1d(T, np.linspace(0, 10, 65))
    later = np.append(0.0, watched[np.searchsorted(watched, T[1:] + SWING, side="right") - 1])
    apart = SAFETY * 0.1 * (loose - tight) * later
    least = apart + LEAST * tight + rounding(later)
    assert (run.errors >= least * (1 - 1e-6)).all() and (run.errors <= least * 1.05).all()  # `later` is a staircase
    assert run.errors[-1] == pytest.approx(least[-1], rel=1e-6)
    assert run.ending.kind == "end" and run.horizon == np.inf and run.local == tight
    assert run.evaluations == made.spent == 200
    true = np.abs(run.states[:, 0] - 1)
    assert (true <= run.errors).all() and run.errors[-1] < 1.01 * SAFETY * (APART - 1) * true[-1]


def test_two_runs_that_swing_through_each_other_are_no_better_known_where_they_meet() -> None:
    """The difference of two oscillators, out of phase by what grows, is zero twice a turn; their errors are not."""
    times, turn = np.linspace(0.0, 10.0, 2001), 2.0

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        states = 1 + (local * times * (np.sin(2 * np.pi * times / turn) if companion else 0))[:, None]
        return Stretch(states, states[-1], 1)

    def errors(swing: float) -> Array:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(error_estimate, "SWING", error_estimate.SWING._replace(value=swing))
            distance = lambda one, other: np.abs(one - other)[:, 0]  # noqa: E731
            run = estimate_run(Evolution(np.ones(1), integrate, distance, turn, ENOUGH), times, 1e-6)
            return run.errors / (SAFETY * APART * run.local)

    whole, inside = times, (times > 0) & (times < 10 - turn)
    assert (errors(SWING)[inside] >= whole[inside]).all()
    assert not (errors(0.0)[inside] >= whole[inside]).all()  # the twin


def test_two_runs_that_part_slowly_by_chance_are_no_better_known_there() -> None:
    """Errors that grow like t and like t²: their difference is no larger at 7 than at 3, and zero between."""
    t = np.linspace(0.0, 40.0, 401)
    better, looser = 1e-9 * t, 1e-9 * (t + t * (6 - t) / 5)
    told = errors_up_to(t, 1e-15 + SAFETY * np.abs(looser - better), 1.0)
    assert (told >= better).all()
    assert (np.maximum.accumulate(SAFETY * np.abs(looser - better)) < better)[1:].any()  # the twin
    assert (np.diff(np.log(told), 2) < 1e-12).all()


@pytest.mark.parametrize("power", [0, 0.5, 1, 3])
@pytest.mark.parametrize("rate", [0, 0.3])
def test_errors_that_grow_as_those_of_a_motion_are_told_as_they_are(power: float, rate: float) -> None:
    t = np.linspace(0.0, 40.0, 401)
    errors = 1e-9 * (1e-3 + t) ** power * np.exp(rate * t)
    assert errors_up_to(t, errors, 0.0) == pytest.approx(errors, rel=1e-12)
    assert errors_up_to(t, np.where(t > 0, errors, 0.0), 0.0)[1:] == pytest.approx(errors[1:], rel=1e-12)


def test_the_shorter_a_run_the_looser_it_begins() -> None:
    long, short, shortest = Made(share=0.0), Made(share=0.0), Made(share=0.0)
    long.run(1e-8, 10 * T), short.run(1e-8, 0.1 * T), shortest.run(1e-8, 1e-6 * T)
    limit = error_estimate.SHORTEST.value
    assert [made.locals[0] * 1e8 / FIRST for made in (long, short, shortest)] == pytest.approx([1, 10, limit])
    loosest = Made(share=0.0)
    loosest.run(0.1, 1e-6 * T)
    assert loosest.locals[0] == error_estimate.LOOSEST.value


def test_what_no_tolerance_keeps_is_the_best_there_is_and_is_said() -> None:
    made = Made(share=1e4)
    run = made.run(1e-12)
    assert min(made.locals) == TIGHTEST and run.local <= APART * TIGHTEST
    assert run.errors[-1] > 1e-12 and 0 < run.horizon < 10
    with pytest.warns(LagrotorWarning, match=r"made does not keep tol = 1e-12: .* t = [\d.e-]+ s"):
        run.warn_unless_kept("made", 1e-12)
    with warnings.catch_warnings():  # twin
        warnings.simplefilter("error")
        Made(share=0.1).run(1e-6).warn_unless_kept("made", 1e-6)


@pytest.mark.parametrize(("share", "integrations"), [(1.01, 4), (0.99, 2)])
def test_what_rounding_leaves_is_the_limit(monkeypatch: pytest.MonkeyPatch, share: float, integrations: int) -> None:
    monkeypatch.setattr(error_estimate, "ROUNDING", error_estimate.ROUNDING._replace(value=1e-9))
    times = np.array([0.0, 60.0])
    made = Made(share=100.0)
    made.run(share * 1e-9 * (START + 60), times)
    assert len(made.locals) >= integrations and (integrations == 4 or len(made.locals) == 2)


@pytest.mark.parametrize("cause", ["budget", "singular", "stopped"])
def test_a_run_that_stops_is_what_was_reached(cause: Any) -> None:
    made = Made(share=0.1)
    made.fails[1.0] = StopError(7.3, "it stops.", cause=cause)
    run = made.run(1e-6)
    assert run.t.tolist() == T[:8].tolist() and run.states.shape == (8, 1)
    assert (run.ending.kind, run.ending.at, run.ending.reason) == (cause, 7.3, "it stops")
    assert run.evaluations == made.spent and (np.abs(run.states[:, 0] - 1) <= run.errors).all()
    with pytest.warns(LagrotorWarning, match=r"ended early: .* at t = 7\.3 s: it stops"):
        run.warn_unless_kept("made", 1e-6)


def test_a_run_is_watched_where_its_conservation_is_measured() -> None:
    seen = list[Array]()

    def defect(t: Array, states: Array) -> Array:
        seen.append(t)
        return np.zeros(1)

    made = Made(share=0.1)
    made.run(1e-6, conservation_error=defect, watch=np.array([-1.0, 0.017, 3.1234, 99.0]))
    assert {0.017, 3.1234} < set(seen[0]) and not {-1.0, 99.0} & set(seen[0])
    assert seen[0][0] == 0 and seen[0][-1] == 10


def test_a_singular_position_is_said_only_where_it_is_measured() -> None:
    made = Made(share=0.1)
    made.fails[1.0] = StopError(7.3, "no step")
    measured = made.run(1e-6, singular=lambda y: "the pole" if y[0] > 1 else "")
    assert (measured.ending.kind, measured.ending.reason) == ("singular", "the pole")
    assert made.run(1e-6, singular=lambda y: "").ending.kind == "stopped"


FIRST_LOCAL = 1e-6 * FIRST


@pytest.mark.parametrize(
    ("cause", "above", "asked"),
    [
        (
            "budget",
            0.5,
            [1, 1 / APART, APART],
        ),  # the better one stops: the looser one is compared with one looser still
        ("stopped", 0.5, [1, 1 / APART, APART]),
        ("budget", 1.5, [1, APART**2, APART]),  # the looser one stops: nothing is spent on a better one
        ("stopped", 1.5, [1, 1 / APART, APART**2, APART]),  # it may stop where the better one does not
    ],
)
def test_what_stops_is_tried_looser_step_by_step(cause: Any, above: float, asked: list[float]) -> None:
    made = Made(share=0.01)
    made.fails[above * FIRST_LOCAL] = StopError(7.3, "it stops", cause=cause)
    run = made.run(1e-6)
    assert [local / FIRST_LOCAL for local in made.locals] == pytest.approx(asked)
    assert run.ending.kind == "end" and run.local == sorted(made.locals)[-2]


def test_where_none_is_looser_than_given_up_what_was_reached_longest_is_kept() -> None:
    made = Made(share=0.01)
    made.fails[1.0] = StopError(3.5, "it stops", cause="stopped")
    made.fails[20 * FIRST_LOCAL] = StopError(7.3, "it stops later", cause="stopped")
    made.fails = dict(reversed(made.fails.items()))  # the first that holds is taken
    run = made.run(1e-6)
    assert run.ending.at == 7.3 and run.t[-1] == 7 and run.local == made.locals[1]
    assert len(made.locals) == 4  # two pairs, of which the last begins beyond GIVEN_UP


def test_of_two_pairs_that_stop_at_one_time_the_better_known_is_kept() -> None:
    made = Made(share=0.01)
    made.fails[1.0] = StopError(7.3, "it goes to infinity", cause="stopped")
    run = made.run(1e-6)
    assert run.ending.at == 7.3 and run.local == min(made.locals) and len(made.locals) == 4
    assert run.horizon == np.inf
    later = Made(share=0.01)  # twin: one that lasts longer is kept, however loose
    later.fails = {2 * FIRST_LOCAL: StopError(7.3, "it stops", cause="stopped"), 1.0: StopError(8.4, "later")}
    run = later.run(1e-6)
    assert run.ending.at == 8.4 and run.local > min(later.locals)


def test_what_is_conserved_is_held_to_the_error() -> None:
    kept = error_estimate.KEPT.value
    error = Made(share=0.1).run(1e-6).errors[-1]
    assert (
        Made(share=0.1).run(1e-6, conservation_error=lambda t, y: np.array([0.99 * kept * error])).ending.kind == "end"
    )
    with pytest.raises(IntegrationError, match="followed another motion") as refusal:
        Made(share=0.1).run(
            1e-6, conservation_error=lambda t, y: np.array([-1.01 * kept * error]), has_other_coordinates=True
        )
    assert refusal.value.evaluations > 0
    far = {
        "difference": lambda one, other: 10 * error,
        "conservation_error": lambda t, y: np.array([9.9 * kept * error]),
    }
    assert Made(share=0.1).run(1e-6, **far).ending.kind == "end"
    with pytest.raises(IntegrationError, match="not finite"):
        Made(share=np.nan).run(1e-6, has_other_coordinates=True)


def test_between_two_events_that_differ_only_what_is_read_there_is_compared() -> None:
    """A jump of 1 at 4.95 in one run and at 5.05 in the other: what is read at 5 may be either."""

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        at = 4.95 if companion else 5.05
        states = (times >= at)[:, None] * 1.0 + local * times[:, None]
        return Stretch(states, states[-1], 1, (at,) if times[0] < at <= times[-1] else ())

    evolution = replace(Made().evolution(), integrate=integrate)
    run = estimate_run(evolution, T, 1e-3)
    assert run.errors[5] > 1 and run.errors[6] < 1e-3 and run.ending.kind == "end"


def test_of_too_many_turns_nothing_is_begun() -> None:
    made = Made()
    with pytest.raises(IntegrationError, match=r"1\.0e\+300 turns, over which rounding errors exceed the states"):
        made.run(1e-6, np.array([0.0, 1e300]))
    assert not made.locals


@pytest.mark.parametrize(("share", "integrations"), [(0.05, 2), (0.3, 3), (0.45, 3), (0.8, 4), (100.0, 4)])
def test_a_third_integration_is_enough_where_it_gives_half_of_the_tolerance(share: float, integrations: int) -> None:
    made = Made(share=share)
    run = made.run(1e-5)
    assert len(made.locals) == integrations and run.evaluations == made.spent
    assert made.locals[1] == made.locals[0] / APART and made.locals[-1] == made.locals[-2] / APART
    assert run.errors[-1] <= 1e-5 < (1e9 if integrations == 2 else 20 * run.errors[-1])


@pytest.mark.parametrize(
    ("local", "slack", "twice"), [(0.99, 1, True), (1.01, 1, False), (100, 1, False), (100, 1e6, True)]
)
def test_below_what_is_resolved_safety_counts_twice(local: float, slack: float, twice: bool) -> None:
    """Slack of nearly dependent constraints counts from where it is largest; the companion starts off by it in each component."""
    starts, made = dict[bool, Array](), Made(share=0.01)

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        starts.setdefault(companion, start)
        part = made(start, times, local, companion, budget)
        states = np.column_stack([part.states, np.zeros(len(times)), times])
        return Stretch(states, states[-1], part.evaluations)

    evolution = replace(made.evolution(), start=np.array([1.0, 0, 0]), integrate=integrate)
    if slack > 1:
        evolution = replace(evolution, constraint_uncertainty=lambda states: np.where(states[:, 2] < 1, slack, 1.0))
    run = estimate_run(evolution, T, local * RESOLVED * APART / FIRST)
    assert run.local == pytest.approx(local * RESOLVED) and len(made.locals) == 2
    apart = SAFETY ** (1 + twice) * 0.01 * run.local * (APART - 1) * T[-1] + LEAST * run.local
    assert run.errors[-1] == pytest.approx(apart + rounding(T)[-1], rel=1e-2)
    assert (
        starts[True][1] == pytest.approx((slack - 1) * np.finfo(float).eps * np.cos(2)) and not starts[False][1:].any()
    )


def test_two_that_agree_are_known_no_better_than_a_share_of_their_local_error() -> None:
    run = Made(share=0.0).run(1e-4)
    assert run.errors == pytest.approx(LEAST * run.local + rounding(T))


def test_where_two_have_parted_nothing_is_known_from_that_time_on() -> None:
    run = Made(growth=1.0).run(1e-6, np.arange(201.0))
    at = int(np.searchsorted(run.t, run.ending.at))
    assert run.ending.kind == "lost" and run.horizon < run.ending.at < 60 and run.t[-1] == 200
    assert run.t[at] == run.ending.at and run.errors[at] == run.errors[-1] == UNKNOWN > run.errors[at - 1] > LOST / 10
    with pytest.warns(
        LagrotorWarning, match=r"neighbouring motions separate .*, and tol is kept only up to t = [\d.]+ s$"
    ):
        run.warn_unless_kept("made", 1e-6)


def test_the_budget_grows_with_the_turns() -> None:
    made = Made(share=0.1)
    made.run(1e-6, budget=EvaluationBudget(1_000, 10))
    assert made.budgets == [1_100, 1_100]
    made.run(1e-6, budget=EvaluationBudget(1e9, 10))
    assert made.budgets[2:] == [error_estimate.MOST_EVALUATIONS] * 2


def test_what_does_not_conserve_is_compared_with_a_looser_one() -> None:
    """Whatever is integrated more tightly than at first is off what it must conserve, and refused."""
    made = Made(share=0.01)
    run = made.run(1e-6, conservation_error=lambda t, y: np.array([y[-1, 0] - 1 < 0.09 * FIRST_LOCAL], float))
    assert [local / FIRST_LOCAL for local in made.locals] == pytest.approx([1, 1 / APART, APART])
    assert run.local == made.locals[0] and run.ending.kind == "end"


def test_no_tighter_pair_is_tried_than_one_that_was_refused() -> None:
    made = Made(share=30.0)
    made.fails[2e-9] = StopError(7.3, "too many", cause="budget")
    run = made.run(1e-6)
    assert run.ending.kind == "end" and run.errors[-1] > 1e-6 and sum(local < 2e-9 for local in made.locals) == 1
