"""The contract of runs, held to motions whose errors are made: what is told of a run is what its two integrations say."""

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.numerics import estimated_run
from lagrotor.numerics.estimated_run import UNKNOWN, EstimatedRun, Evolution, Patience, errors_up_to, estimate_run
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.segment import Array, StopError, Stretch

T = np.linspace(0.0, 10.0, 11)
ENOUGH = Patience(1e6, 1e6)
SAFETY, APART, FIRST, ROUNDING, START, LEAST, RESOLVED, LOST, SWING = (
    getattr(estimated_run, name).value
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
        given: dict[str, Any] = {"turn": 1.0, "patience": ENOUGH} | more
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
    least = np.maximum(apart, LEAST * tight) + rounding(later)
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
            patch.setattr(estimated_run, "SWING", estimated_run.SWING._replace(value=swing))
            distance = lambda one, other: np.abs(one - other)[:, 0]  # noqa: E731
            run = estimate_run(Evolution(np.ones(1), integrate, distance, turn, ENOUGH), times, 1e-6)
            return run.errors / (SAFETY * APART * run.local)

    whole, inside = times, (times > 0) & (times < 10 - turn)
    assert (errors(SWING)[inside] >= whole[inside]).all()
    assert not (errors(0.0)[inside] >= whole[inside]).all()  # the twin


def test_two_runs_that_meet_by_chance_at_the_first_time_are_no_better_known_there() -> None:
    """Between the ends of long steps two interpolations swing through the motion; at the first time that is read they agree."""
    times = np.array([0.0, 0.01, 10.0])

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        swing = 5 * np.sin(6 * np.pi * times / 0.01) if companion else 0.0
        states = 1 + (1e-8 * (1 + swing) * ((times > 0) & (times <= 0.01)))[:, None]
        return Stretch(states, states[-1], 1)

    def errors(parts: int) -> Array:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(estimated_run, "_PARTS", parts)
            distance = lambda one, other: np.abs(one - other)[:, 0]  # noqa: E731
            run = estimate_run(Evolution(np.ones(1), integrate, distance, 1.0, ENOUGH), times, 1e-6)
            return run.errors / np.abs(run.states[:, 0] - 1).max()

    assert errors(estimated_run._PARTS)[1] > 1
    assert errors(1)[1] < 0.1  # the twin


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


def test_below_what_is_resolved_safety_counts_twice() -> None:
    made = Made(share=0.01)
    run = made.run(1e-11, T[[0, -1]])
    assert run.local < RESOLVED and len(made.locals) == 2
    apart = SAFETY**2 * 0.01 * (made.locals[0] - made.locals[1]) * T[-1]
    assert run.errors[-1] == pytest.approx(apart + rounding(T)[-1], rel=1e-2, abs=0)
    above = Made(share=0.1).run(10 * RESOLVED * APART / FIRST, T)
    assert above.local > RESOLVED and above.errors[-1] < 1.01 * SAFETY * 0.1 * above.local * (APART - 1) * T[-1] + 1e-13


def test_constraints_that_are_nearly_dependent_are_resolved_as_far_as_they_can_be() -> None:
    """RESOLVED counts slack times, from where the slack was largest; the companion starts off by it in what is zero, too."""
    starts = dict[bool, Array]()

    def told(slack: bool) -> Array:
        made = Made(share=0.01)

        def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
            starts.setdefault(companion, start)
            part = made(start, times, local, companion, budget)
            states = np.column_stack([part.states, np.zeros(len(times)), times])
            return Stretch(states, states[-1], part.evaluations)

        def at(states: Array) -> Array:  # within the first tenth of the run
            return np.where(states[:, 2] < 1, 1e6, 1.0)

        return estimate_run(
            Evolution(
                np.array([1.0, 0, 0]),
                integrate,
                lambda one, other: np.abs(one - other)[:, 0],
                turn=1.0,
                patience=ENOUGH,
                slack=at if slack else None,
            ),
            T,
            1e-8,
        ).errors

    assert told(True)[1:] == pytest.approx(SAFETY * told(False)[1:], rel=1e-4)
    eps = np.finfo(float).eps
    assert not starts[False][1:].any()
    starts.clear()
    told(True)
    assert starts[True][1] == pytest.approx(1e6 * eps * np.cos(2), rel=1e-4) and not starts[False][1:].any()


def test_two_that_agree_are_known_no_better_than_a_share_of_their_local_error() -> None:
    run = Made(share=0.0).run(1e-4)
    assert run.errors == pytest.approx(LEAST * run.local + rounding(T))
    independent = Made(share=0.0).run(1e-4, independent=True)
    assert (independent.errors < LEAST * run.local / 1e3).all()


def test_the_shorter_a_run_the_looser_it_begins() -> None:
    long, short, shortest = Made(share=0.0), Made(share=0.0), Made(share=0.0)
    long.run(1e-8, 10 * T), short.run(1e-8, 0.1 * T), shortest.run(1e-8, 1e-6 * T)
    limit = estimated_run.SHORTEST.value
    assert [made.locals[0] * 1e8 / FIRST for made in (long, short, shortest)] == pytest.approx([1, 10, limit])
    loosest = Made(share=0.0)
    loosest.run(0.1, 1e-6 * T)
    assert loosest.locals[0] == estimated_run.LOOSEST.value


def test_where_the_two_differ_by_too_much_a_third_is_enough_or_a_pair_follows_in_proportion() -> None:
    near = Made(
        share=0.25
    )  # the first two differ by twice the tolerance or so, the second and a third by a fifth of that
    run = near.run(1e-6)
    assert len(near.locals) == 3 and near.locals[2] == pytest.approx(near.locals[1] / APART)
    assert near.locals[1] == pytest.approx(near.locals[0] / APART) and run.errors[-1] <= 1e-6
    far = Made(share=100.0)
    run = far.run(1e-5)
    assert len(far.locals) == 4 and far.locals[2] < far.locals[1] / APART
    assert run.errors[-1] <= 1e-5 < 20 * run.errors[-1]
    assert run.evaluations == far.spent == 400


@pytest.mark.parametrize(("share", "integrations"), [(0.3, 3), (0.4, 4)])
def test_a_third_is_to_give_half_of_the_tolerance(share: float, integrations: int) -> None:
    """A third would be off by 8/5 share tol: 0.48 tol is enough, 0.64 tol is not, although it would keep tol."""
    made = Made(share=share)
    run = made.run(1e-6)
    assert len(made.locals) == integrations and run.errors[-1] < 0.51e-6


@pytest.mark.parametrize("off", [0.9, 1 - 1e-15, 1.0, 1 + 1e-15])
def test_a_pair_at_a_local_error_that_was_refused_is_not_begun(off: float) -> None:
    """The same local error is reached by other ways, which differ by rounding."""
    course = estimated_run._Course(Made().evolution(), T)
    tight = estimated_run._Integration(1e-7, False)
    comparison = estimated_run._Comparison(estimated_run._Integration(5e-7, True), tight, 1, np.full(65, 2e-6), np.inf)
    course.refused.append(off * tight.local / APART)
    asked = next(estimated_run._following(course, comparison, 1e-6), None)
    assert (asked is None) is (off > 0.99)


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


def test_rounding_that_breaks_a_tolerance_is_not_run_against() -> None:
    made = Made(share=0.01)
    run = made.run(1e-13, 1e3 * T)
    assert run.errors[-1] > ROUNDING * 1e4
    assert set(made.locals) == {APART * TIGHTEST, TIGHTEST}


@pytest.mark.parametrize(("share", "integrations"), [(1.01, 4), (0.99, 2)])
def test_what_rounding_leaves_is_the_limit(monkeypatch: pytest.MonkeyPatch, share: float, integrations: int) -> None:
    monkeypatch.setattr(estimated_run, "ROUNDING", estimated_run.ROUNDING._replace(value=1e-9))
    times = np.array([0.0, 60.0])
    made = Made(share=100.0)
    made.run(share * 1e-9 * (START + 60), times)
    assert len(made.locals) >= integrations and (integrations == 4 or len(made.locals) == 2)


def test_where_two_have_parted_nothing_is_known_and_the_better_one_goes_on_alone() -> None:
    made = Made(growth=1.0)
    run = made.run(1e-6, np.linspace(0.0, 200.0, 21))
    assert run.ending.kind == "lost" and run.errors[-1] == UNKNOWN
    lost = run.t[np.argmax(run.errors == UNKNOWN)]
    assert run.ending.at <= lost < 60 and run.horizon < run.ending.at
    beyond = estimated_run.BEYOND.value
    assert run.loosened == pytest.approx(estimated_run.STAGE.value) and made.locals[-1] == beyond > run.local
    said = rf"only up to t = [\d.]+ s; from t = {run.loosened:.6g} s its local error is {beyond:g}"
    with pytest.warns(LagrotorWarning, match=said):
        run.warn_unless_kept("made", 1e-6)


def test_nothing_is_known_from_the_very_time_at_which_two_have_parted() -> None:
    run = Made(growth=1.0).run(1e-6, np.arange(201.0))
    at = int(np.searchsorted(run.t, run.ending.at))
    assert run.t[at] == run.ending.at and run.errors[at] == UNKNOWN > run.errors[at - 1] > LOST / 10


def test_a_run_that_stops_where_it_goes_on_more_loosely_goes_on_at_its_own_local_error() -> None:
    beyond = estimated_run.BEYOND.value

    class Loose(Made):
        def __call__(self, start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
            part = super().__call__(start, times, local, companion, budget)
            if local == beyond:
                raise StopError(float(times[0]), "too loose", evaluations=part.evaluations)
            return part

    made = Loose(growth=1.0)
    run = made.run(1e-7, np.linspace(0.0, 200.0, 21))
    after = made.locals[made.locals.index(beyond) + 1 :]
    assert after and set(after) == {run.local}
    assert run.ending.kind == "lost" and run.t[-1] == 200 and run.loosened == np.inf


def test_the_stages_double() -> None:
    made = Made(share=0.0)
    made.run(1e-6, np.array([0.0, 700.0]))
    stage = estimated_run.STAGE.value
    assert len(made.locals) == 2 * len([end for n in range(20) if (end := stage * 2.0**n) < 700] + [700])


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


def test_a_run_that_stops_in_a_later_stage_is_what_was_reached_in_all() -> None:
    made, times = Made(share=1e-3), np.linspace(0.0, 200.0, 21)
    made.fails[1.0] = StopError(157.0, "it stops", cause="budget")
    run = made.run(1e-6, times)
    assert run.t.tolist() == times[:16].tolist() and (np.diff(run.states[:, 0]) > 0).all()
    assert run.states[:, 0] - 1 == pytest.approx(
        1e-3 * run.local * run.t * (run.states[-1, 0] - 1) / (1e-3 * run.local * 150)
    )


def test_a_run_is_watched_where_its_conservation_is_measured() -> None:
    seen = list[Array]()

    def defect(t: Array, states: Array) -> Array:
        seen.append(t)
        return np.zeros(1)

    made = Made(share=0.1)
    made.run(1e-6, defect=defect, watch=np.array([-1.0, 0.017, 3.1234, 99.0]))
    assert {0.017, 3.1234} < set(seen[0]) and not {-1.0, 99.0} & set(seen[0])
    assert seen[0][0] == 0 and seen[0][-1] == 10


def test_a_singular_position_is_said_only_where_it_is_measured() -> None:
    made = Made(share=0.1)
    made.fails[1.0] = StopError(7.3, "no step")
    measured = made.run(1e-6, singular=lambda y: "the pole" if y[0] > 1 else "")
    assert (measured.ending.kind, measured.ending.reason) == ("singular", "the pole")
    assert made.run(1e-6, singular=lambda y: "").ending.kind == "stopped"


def test_where_the_tight_one_stops_a_looser_pair_runs() -> None:
    made = Made(share=0.1)
    made.fails[1e-7] = StopError(7.3, "too many", cause="budget")
    run = made.run(1e-6)
    assert run.ending.kind == "end" and run.local > 1e-7
    elsewhere = Made(share=0.1)
    elsewhere.fails = made.fails
    run = elsewhere.run(1e-6, elsewhere=True)  # twin: where other coordinates are at hand, it is left to them
    assert run.ending.kind == "budget" and len(elsewhere.locals) == 2


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
    assert [made.locals[0] * APART ** (2 * n) <= estimated_run.GIVEN_UP.value for n in range(2)] == [True, True]
    assert len(made.locals) == 6  # three pairs, of which the last begins beyond GIVEN_UP


def test_of_two_pairs_that_stop_at_one_time_the_better_known_is_kept() -> None:
    made = Made(share=0.01)
    made.fails[1.0] = StopError(7.3, "it goes to infinity", cause="stopped")
    run = made.run(1e-6)
    assert run.ending.at == 7.3 and run.local == min(made.locals) and len(made.locals) > 4
    assert run.horizon == np.inf
    later = Made(share=0.01)  # twin: one that lasts longer is kept, however loose
    later.fails = {20 * FIRST_LOCAL: StopError(7.3, "it stops", cause="stopped"), 1.0: StopError(8.4, "later")}
    run = later.run(1e-6)
    assert run.ending.at == 8.4 and run.local > min(later.locals)


def test_what_does_not_conserve_is_compared_with_a_looser_one() -> None:
    """Whatever is integrated more tightly than at first is off what it must conserve, and refused."""
    made = Made(share=0.01)
    run = made.run(1e-6, defect=lambda t, y: np.array([y[-1, 0] - 1 < 0.09 * FIRST_LOCAL], float))
    assert [local / FIRST_LOCAL for local in made.locals] == pytest.approx([1, 1 / APART, APART])
    assert run.local == made.locals[0] and run.ending.kind == "end"


def test_the_budget_grows_with_the_turns_and_with_what_a_looser_one_took() -> None:
    made = Made(share=0.1)
    made.run(1e-6, patience=Patience(1_000, 10))
    assert made.budgets == [1_100, 1_100]
    dear = Made(share=0.1, cost=5_000)
    dear.run(1e-6, patience=Patience(1_000, 10))
    assert dear.budgets == [1_100, estimated_run.MORE.value * 5_000 + 100]


def test_what_is_conserved_is_held_to_the_error() -> None:
    kept = estimated_run.KEPT.value
    error = Made(share=0.1).run(1e-6).errors[-1]
    assert Made(share=0.1).run(1e-6, defect=lambda t, y: np.array([0.99 * kept * error])).ending.kind == "end"
    with pytest.raises(IntegrationError, match="followed another motion") as refusal:
        Made(share=0.1).run(1e-6, defect=lambda t, y: np.array([-1.01 * kept * error]), elsewhere=True)
    assert refusal.value.evaluations > 0
    far = {"difference": lambda one, other: 10 * error, "defect": lambda t, y: np.array([9.9 * kept * error])}
    assert Made(share=0.1).run(1e-6, **far).ending.kind == "end"
    with pytest.raises(IntegrationError, match="not finite"):
        Made(share=np.nan).run(1e-6, elsewhere=True)


def test_a_better_run_that_conserves_no_better_is_no_better() -> None:
    """Errors e and share e are (1 − share) e apart: the difference counts 2 share/(1 − share) times, of what both are off."""

    def told(looser: float, better: float, share: float = 4e-4) -> float:
        off, error = iter((looser, better)), Made(share=share).run(1e-6).errors[-1]
        return float(Made(share=share).run(1e-6, defect=lambda t, y: np.array([0.0, next(off)])).errors[-1]) / error

    assert told(1e-9, 1e-9 / 3) == pytest.approx(1, rel=1e-3)  # what SAFETY is for
    assert [told(1e-9, 0.5e-9), told(1e-9, 0.99e-9)] == pytest.approx([2, 198], rel=1e-3)
    assert [told(5e-10, share * 5e-10) for share in (0.2, 0.05)] == pytest.approx([1, 1], rel=1e-3)  # and never less
    assert told(1e-9, -1e-9) == pytest.approx(1, rel=1e-3)  # as much, but not alike
    rounding = ROUNDING * (START + 10)
    assert told(9 * rounding, 9 * rounding) == pytest.approx(1)  # rounding may be all that it is
    assert told(11 * rounding, 11 * rounding) == pytest.approx(
        22, rel=1e-2
    )  # the difference is rounding's, at the least


def test_a_pair_that_the_next_one_contradicts_is_not_taken() -> None:
    """Both of the first pair are off alike; a third, which is not, is off the better one by more than was told; no other runs."""

    class Alike(Made):
        def __call__(self, start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
            part = super().__call__(start, times, local, companion, budget)
            if len(self.locals) > 3:
                raise StopError(0.0, "it stops")
            return replace(part, states=part.states + 1e-3 * (len(self.locals) < 3) * (times[:, None] > 0))

    def told() -> float:
        return float(Alike(share=0.25).run(1e-6).errors[-1])

    assert told() > 1e-3
    compare = estimated_run._compare

    def blind(*given: Any) -> Any:
        return replace((yield from compare(*given)), parted=0.0)

    with pytest.MonkeyPatch.context() as patch:  # twin: of all pairs the one that tells least
        patch.setattr(estimated_run, "_compare", blind)
        assert told() < 1e-3


def test_a_better_run_that_costs_less_is_by_another_method() -> None:
    class Cheaper(Made):
        def __call__(self, start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
            return replace(
                super().__call__(start, times, local, companion, budget), evaluations=100 if companion else self.cost
            )

    def told(tol: float, off: float, cost: int) -> float:
        defects = iter((off, 0.6 * off))
        return float(Cheaper(share=0.01, cost=cost).run(tol, defect=lambda t, y: np.array([next(defects)])).errors[-1])

    assert told(1e-6, 1e-9, 200) == pytest.approx(told(1e-6, 1e-9, 199))
    # Below what is resolved SAFETY counts twice, and of twice as many evaluations rounding is what they resolve.
    assert told(1e-11, 1e-12, 199) == pytest.approx(3 * told(1e-11, 1e-12, 200), rel=0.1)
    dearer, as_dear, cheaper = (Cheaper(share=0.01, cost=cost).run(1e-6).errors[-1] for cost in (101, 100, 99))
    assert dearer == as_dear and cheaper == pytest.approx(2 * dearer, rel=1e-3)


def test_a_run_by_another_clock() -> None:
    later = Made(share=0.1).run(1e-6).by_clock(3.0, 2.0)
    assert later.t.tolist() == (3 + 2 * T).tolist() and later.ending.at == 23


def test_between_two_events_that_differ_only_what_is_read_there_is_compared() -> None:
    """A jump of 1 at 4.95 in one run and at 5.05 in the other: what is read at 5 may be either."""

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        at = 4.95 if companion else 5.05
        states = (times >= at)[:, None] * 1.0 + local * times[:, None]
        return Stretch(states, states[-1], 1, (at,) if times[0] < at <= times[-1] else ())

    evolution = replace(Made().evolution(), integrate=integrate)
    run = estimate_run(evolution, T, 1e-3)
    assert run.errors[5] > 1 and run.errors[6] < 1e-3 and run.ending.kind == "end"


def test_no_looser_pair_is_tried_once_one_is_given_up() -> None:
    """All local errors fail: each pair is looser, and the last is the first beyond GIVEN_UP."""
    made, limit = Made(share=0.1), estimated_run.GIVEN_UP.value
    made.fails[1.0] = StopError(7.3, "too many", cause="budget")
    made.run(1e-7)
    assert limit < max(made.locals) <= limit * APART**2


def test_of_too_many_turns_nothing_is_begun() -> None:
    made = Made()
    with pytest.raises(IntegrationError, match=r"1\.0e\+300 turns, after which rounding leaves nothing known"):
        made.run(1e-6, np.array([0.0, 1e300]))
    assert not made.locals


@pytest.mark.parametrize(
    ("growth", "reach"),
    [
        # A difference that grows as t⁴ is LOST where TIGHTEST t⁴ is.
        (lambda t: 1e-6 * t**4, (LOST / TIGHTEST) ** 0.25),
        # One that grows at once, late, by e^(λt) as if from the start.
        (
            lambda t: 1e-6 * np.exp(np.log(LOST / 1e-6) * np.maximum(t - 9, 0)),
            10 * np.log(LOST / TIGHTEST) / np.log(LOST / 1e-6),
        ),
    ],
    ids=["power", "exponential"],
)
def test_two_that_parted_are_hopeless_only_beyond_the_reach_of_the_tightest(growth: Any, reach: float) -> None:
    integration = estimated_run._Integration(1e-6, True)
    for end, hopeless in ((reach / 1.1, False), (reach * 1.1, True)):
        course = estimated_run._Course(Made().evolution(), np.linspace(0, end, 4001))
        errors = growth(course.t)
        lost = float(course.t[np.argmax(errors > LOST)])
        comparison = estimated_run._Comparison(integration, integration, 1, errors, lost)
        assert bool(estimated_run._hopeless(course, comparison)) is hopeless
        assert not estimated_run._hopeless(course, replace(comparison, lost=np.inf))
        begun_lost = replace(comparison, loose=estimated_run._Integration(LOST, True))
        assert not estimated_run._hopeless(course, begun_lost)  # nothing is known of how it grows
