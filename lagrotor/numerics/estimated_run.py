"""The contract of runs: a motion integrated twice, at two tolerances, in stages, and what is known of its error.

SAFETY times the difference of the two runs is taken for the error of the better one, its square where rounding may be most of
it, and more where what they conserve, or their cost, says that both are off by nearly the same. It is also how far neighbouring
motions part: where it exceeds the tolerance, the run has reached its horizon. Where it exceeds LOST, nothing is known any more:
there the comparison ends, and the better run goes on alone. What the motion conserves must be kept as well as the error allows.

It is an estimate. Where errors follow the tolerance the difference is APART − 1 times the error of the better run, and the
estimate 12 times that error: the median of 96 random systems read at 64 times more is 13, and none of 104 was off by more than
estimated at any time (tests/told_over_true.py). An error that both runs have is not seen: a scene is known that is off by 1.3
times its estimate, within `tol`.
"""

import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import inf, log
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.numerics.calibrated import (
    APART,
    BEYOND,
    CHEAPER,
    CLEAR,
    FIRST,
    GIVEN_UP,
    KEPT,
    LEAST,
    LOOSEST,
    LOST,
    MORE,
    ODDS,
    RESOLVED,
    ROUNDING,
    SAFETY,
    SHORTEST,
    STAGE,
    START,
    SWING,
    TELLING,
)
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import Array, Projection, StopError, Stretch
from lagrotor.shown import scientific

MOST_EVALUATIONS = 1e8  # of a run: a right-hand side in Python takes minutes for them
_LEAST_A_TURN = 100  # evaluations that two integrations take for a turn at least
UNKNOWN = 2.0  # the most by which two states differ, relative to their size: an error of which nothing is known
# Two runs are compared at so many parts of the time to the first of all others: there one difference is all that is known of the
# error, and between the ends of a step DOP853 is off by up to forty times what it is off at them, with changing sign.
_PARTS = 8
_SAMPLES = 65  # times of a stage at which a run is watched besides those it is read at


class Patience(NamedTuple):
    """Evaluations that an integration may take: `begin` in all, and `turn` more for each turn of the motion."""

    begin: float
    turn: float


@dataclass(frozen=True, eq=False)
class Evolution:
    """A motion to be run: its start (d,), and what a run needs to know of it.

    integrate: (start (d,), times (n,), local error, companion, most evaluations) → the motion from times[0], where the start
    holds; companion: by another order or other steps, where the local error does not set them. Raises StopError, its time one of
    the same clock, with what was reached. distance: two runs (n, d) → how far apart they are (n,), relative to the size of the
    states. turn: the time (s) in which the motion typically turns. project: brings a state back onto its constraints.
    unsure: how far, in units of rounding, the start may be off what it was given as: the companion's is off by as much.
    slack: states (n, d) → how far off, in units of rounding, constraints that are nearly dependent there leave them (n,); of
    the sizes (d,) of the components.
    defect: times (n,) and states (n, d) → the errors, signed, that would explain how far the run is from conserving what it
    must, of each time and each that is conserved, in the order that they come in.
    difference: of two runs in everything that is conserved, where `distance` sees only a part. watch: times (m,) at which the
    defect needs the run. singular: of a state at which a solver stopped, the words of the singular position that it is at, or
    none. elsewhere: whether the motion can be run by other coordinates, so that one that stops is not tried again. independent:
    whether no two runs are by the same order and the same steps, however short, so that where they agree they are right.
    sudden: whether neighbouring motions part within a small part of a turn, at a narrow force.
    """

    start: Array
    integrate: Callable[[Array, Array, float, bool, float], Stretch]
    distance: Callable[[Array, Array], Array]
    turn: float
    patience: Patience
    project: Projection | None = None
    unsure: float = 1.0
    slack: Callable[[Array], Array] | None = None
    sizes: Array | float = 1.0
    defect: Callable[[Array, Array], Array] | None = None
    difference: Callable[[Array, Array], float] | None = None
    watch: Array = field(default_factory=lambda: np.empty(0))
    singular: Callable[[Array], str] | None = None
    elsewhere: bool = False
    independent: bool = False
    sudden: bool = False


class Leg(NamedTuple):
    """What is to be integrated for the estimate: the arguments of `Evolution.integrate`."""

    start: Array
    times: Array
    local: float
    companion: bool
    budget: float


@dataclass(frozen=True, eq=False)
class EstimatedRun:
    """States (n, d) at the times t (n,) that were reached, the largest error up to each (n,), the horizon, the evaluations of
    all integrations, and how it ended.

    local: the local error of the better run. loosened: the time from which nothing is known of it and it goes on at BEYOND.
    """

    t: Array
    states: Array
    errors: Array
    horizon: float
    evaluations: int
    ending: Ending
    local: float
    loosened: float

    @property
    def known(self) -> dict[str, Any]:
        """The fields of a `Run`, by name."""
        return {name: getattr(self, name) for name in ("t", "errors", "horizon", "evaluations", "ending")}

    def by_clock(self, begin: float, unit: float) -> "EstimatedRun":
        """The same run by a clock (s) that shows `begin` where this one shows 0, its unit of time `unit` s."""

        def at(time: float) -> float:
            return begin + unit * time

        ending = replace(self.ending, at=at(self.ending.at))
        parts: dict[str, Any] = {"t": begin + unit * self.t, "horizon": at(self.horizon), "loosened": at(self.loosened)}
        return replace(self, ending=ending, **parts)

    def warn_unless_kept(self, name: str, tol: float, stacklevel: int = 2, hint: str = "") -> None:
        """A LagrotorWarning where `tol` is not kept, or the run ended early; hint: what may be the cause, with the way out."""
        said, error = [], float(self.errors[-1])
        if error > tol:
            apart = error / self.local
            reason = (
                f"neighbouring motions part about {scientific(apart)}-fold, and tol can be meant only up to"
                if apart > 1e5
                else "it is below what the solver can give after"
            )
            beyond = f"; from t = {self.loosened:.6g} s its local error is {BEYOND.value:g}"
            said.append(
                f"{name} does not keep tol = {tol:g}: the estimated error is {scientific(error, 1)}; {reason} "
                f"t = {self.horizon:.6g} s{beyond if self.loosened < inf else ''}"
            )
        if self.ending.early:
            said.append(f"{name} ended early: {self.ending}; it holds what was reached")
        if said:
            said += [hint] if hint else []
            warnings.warn("simulate: " + "; ".join(said), LagrotorWarning, stacklevel=stacklevel + 1)


@dataclass(frozen=True, eq=False)
class _Integration:
    """An integration at one local error, made stage by stage as it is needed; companion: from a start off by rounding."""

    local: float
    companion: bool
    stages: list[Stretch] = field(default_factory=list)
    stops: list[StopError] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class _Comparison:
    """Two integrations compared in the first `stages`: errors up to each time, lost: when beyond LOST; refusal: why the
    better one is not the motion up to its last time; parted: how far the two are apart."""

    loose: _Integration
    tight: _Integration
    stages: int
    errors: Array
    lost: float
    refusal: IntegrationError | None = None
    parted: float = 0.0

    @property
    def error(self) -> float:
        return UNKNOWN if self.lost < inf or self.refusal else float(np.max(self.errors, initial=0.0))

    @property
    def merit(self) -> tuple[bool, float, float, int, float]:
        """Smaller is better: not refused, a small error, kept for long; of two that stop at once, known better up to there."""
        known = float(np.max(self.errors, initial=0.0))
        return self.refusal is not None, self.error, -self.lost, -len(self.errors), known


class _Course:
    """A motion, the stages in which it is integrated with the times at which it is watched, and what was spent on it so far.

    The first stage is STAGE turns, each other one ends at twice the time of the one before it. spent: evaluations; refused: the
    local errors at which an integration stopped, or took more than it may.
    """

    def __init__(self, evolution: Evolution, times: Array) -> None:
        begin, end = float(times[0]), float(times[-1])
        first = STAGE.value * evolution.turn
        doublings = int(max(0.0, np.ceil(np.log2((end - begin) / first)))) if end > begin else 0
        ends = [begin, *(begin + first * 2.0**n for n in range(doublings)), end]
        t = np.unique(np.concatenate([times, *(np.linspace(a, b, _SAMPLES) for a, b in pairwise(ends))]))
        t = np.union1d(t, evolution.watch[(evolution.watch > begin) & (evolution.watch < end)])
        t = np.union1d(t, np.linspace(begin, t[min(1, len(t) - 1)], _PARTS + 1))
        self.evolution, self.times = evolution, times
        self.stages = np.split(t, np.searchsorted(t, ends[1:-1], side="right"))
        self.t, self.read = t, np.isin(t, times)
        self.spent, self.refused = 0, list[float]()
        self.integrations: dict[tuple[float, bool], _Integration] = {}

    def turns(self, t: Array | float) -> Array:
        return np.asarray(t - self.times[0]) / self.evolution.turn

    def integration(self, local: float, companion: bool) -> _Integration:
        return self.integrations.setdefault((local, companion), _Integration(local, companion))

    def stage(self, run: _Integration, n: int, beside: _Integration | None = None) -> Generator[Leg, Stretch, Stretch]:
        """Stage n of an integration, made if it is not there yet; beside: a looser one, MORE times whose evaluations it may
        take."""
        evolution = self.evolution
        while len(run.stages) <= n:
            if run.stops:
                raise run.stops[0]
            i, t = len(run.stages), self.stages[len(run.stages)]
            start = run.stages[-1].end if i else self._beside_start() if run.companion else evolution.start
            t = np.concatenate([self.stages[i - 1][-1:], t]) if i else t
            begin = max(evolution.patience.begin, MORE.value * beside.stages[i].evaluations if beside else 0)
            most = begin + evolution.patience.turn * (t[-1] - t[0]) / evolution.turn
            try:
                leg = Leg(start, t, run.local, run.companion, most)
                part = (yield leg) if len(t) > 1 else Stretch(start[None], start, 0)
            except StopError as stop:
                self.spent += stop.evaluations
                self.refused.append(run.local)
                if stop.reached:
                    stop.reached = replace(stop.reached, states=stop.reached.states[min(i, 1) :])
                run.stops.append(stop)
                raise
            self.spent += part.evaluations
            if part.evaluations > most:  # a solver may find out at its end: it is the last one so tight
                self.refused.append(run.local)
            run.stages.append(replace(part, states=part.states[1:]) if i else part)
        return run.stages[n]

    def _beside_start(self) -> Array:
        start, project = self.evolution.start, self.evolution.project
        beside = start_beside(start, self.evolution.unsure)
        if self.evolution.slack:  # in each component, however small: a factor of it would be taken back by `project`
            off = np.finfo(float).eps * (self.evolution.slack(start[None])[0] - 1)
            beside = beside + off * self.evolution.sizes * np.cos(np.arange(1, len(start) + 1))
        return project(beside) if project else beside


def start_beside(start: Array, unsure: float = 1.0) -> Array:
    """A start (…, d) off by rounding times `unsure`, in no special direction."""
    return start * (1 + unsure * np.finfo(float).eps * np.cos(np.arange(1, start.shape[-1] + 1)))


def _estimated_errors(
    apart: Array,
    local: float,
    turns: Array,
    refused: bool = False,
    independent: bool = False,
    slack: Array | float = 1.0,
) -> Array:
    """Errors (n,) of the better of two runs that are `apart` (n,), its local error, after so many turns (n,).

    refused: whether tighter ones were, so that rounding may be nearly all that both resolve, as it is below RESOLVED, or
    `slack` (n,) times it, unless they are apart by more than CLEAR times the rounding that no tolerance avoids.
    independent and slack: of the two, as `Evolution` has them.
    """
    rounding = ROUNDING.value * (START.value + turns)
    unresolved = (refused | (local < RESOLVED.value * np.asarray(slack))) & (apart < CLEAR.value * slack * rounding)
    least = 0.0 if independent else LEAST.value * local
    return np.maximum(SAFETY.value ** np.where(unresolved, 2, 1) * apart, least) + rounding


def errors_up_to(t: Array, errors: Array, turn: float, sudden: bool = False) -> Array:
    """The largest errors (n,) up to each of the times t (n,), of a motion that turns in the time `turn`.

    Two runs that part swing through each other: as much is known as to the end of a swing. Errors are taken to grow by a power of
    the time or by e^(λt), so that their logarithm is concave, where the difference of two runs that were near by chance grows
    faster. The least curve above it whose logarithm is concave is the estimate. Where a motion is regular for long and then parts
    at once, as at a late near collision, that is more than the error. sudden: where they do, the largest error is taken alone.
    """
    grown = np.maximum.accumulate(errors)
    grown[1:] = grown[np.searchsorted(t, t[1:] + SWING.value * turn, side="right") - 1]
    if sudden or not (grown[0] > 0 and np.isfinite(grown).all()):
        return grown
    corners = list[tuple[float, float]]()
    for x, y in zip(t.tolist(), np.log(grown).tolist(), strict=True):
        while len(corners) > 1:
            (a, b), (c, d) = corners[-2:]
            if (d - b) * (x - a) > (y - b) * (c - a):
                break
            corners.pop()
        corners.append((x, y))
    at, logs = np.array(corners).T
    return np.maximum(grown, np.exp(np.interp(t, at, logs)))


def estimate_run(evolution: Evolution, times: Array, tol: float) -> EstimatedRun:
    """The motion at increasing times (n,), the start holding at times[0], at tolerances that keep it within `tol` as the
    estimate has it, else the best there is.

    Each integration is compared with the one before it, at APART times the local error. Where the two differ by more than `tol`,
    a third is enough if the second's local error gives it in proportion; else a pair follows at those that do. From where no
    tolerance keeps two together, the best goes on at BEYOND. A run that cannot reach its last time is what was reached, and its
    ending says why. Raises IntegrationError for a motion that does not conserve what it must, or of which nothing is reached,
    with its evaluations; and for one of so many turns that rounding alone leaves nothing known.
    """

    def alone(legs: Mapping[int, Leg]) -> dict[int, Stretch | StopError]:
        try:
            return {0: evolution.integrate(*legs[0])}
        except StopError as stop:
            return {0: stop}

    (run,) = estimate_runs([evolution], [times], tol, alone)
    if isinstance(run, IntegrationError):
        raise run
    return run


def estimate_runs(
    evolutions: Sequence[Evolution],
    times: Sequence[Array],
    tol: float,
    integrate: Callable[[Mapping[int, Leg]], Mapping[int, Stretch | StopError]],
) -> list[EstimatedRun | IntegrationError]:
    """Many motions side by side, each at its own times and as `estimate_run` has it, or what refuses it.

    integrate: the legs that are wanted, by the number of the motion → what was made of each, or what stopped it.
    """
    askings = [_asking(evolution, t, tol) for evolution, t in zip(evolutions, times, strict=True)]
    ended: dict[int, EstimatedRun | IntegrationError] = {}
    answers: Mapping[int, Stretch | StopError | None] = dict.fromkeys(range(len(askings)))
    while answers:
        legs = dict[int, Leg]()
        for i, answer in answers.items():
            try:
                # The first answer is none: it begins the asking.
                legs[i] = askings[i].throw(answer) if isinstance(answer, StopError) else askings[i].send(answer)  # type: ignore[arg-type]
            except StopIteration as end:
                ended[i] = end.value
            except IntegrationError as refusal:
                ended[i] = refusal
        answers = integrate(legs) if legs else {}
    return [ended[i] for i in range(len(askings))]


def _asking(evolution: Evolution, times: Array, tol: float) -> Generator[Leg, Stretch, EstimatedRun]:
    turns = float(times[-1] - times[0]) / evolution.turn
    unavoidable = ROUNDING.value * (START.value + turns)
    if unavoidable > UNKNOWN:
        raise IntegrationError(
            f"the run has {turns:.1e} turns, after which rounding leaves nothing known: take a shorter run"
        )
    _check_cost(turns, _LEAST_A_TURN * turns, "at least")
    course = _Course(evolution, times)
    best = comparison = yield from _loosest(course, tol)
    while unavoidable <= tol < comparison.error and not comparison.refusal and not _hopeless(course, comparison):
        following = yield from _following(course, comparison, tol)
        if following is None:
            break
        # An estimate by which the next run cannot be so far off is wrong.
        contradicted = following.loose is best.tight and following.parted > best.error
        comparison = following
        best = comparison if contradicted else min(comparison, best, key=lambda one: one.merit)
    refusal = best.refusal
    if refusal and not (isinstance(refusal, StopError) and len(best.errors) > 1):
        refusal.evaluations = course.spent
        raise refusal
    return (yield from _whole(course, best, tol))


def _check_cost(turns: float, evaluations: float, how: str) -> None:
    """Raise IntegrationError for a run of more than MOST_EVALUATIONS."""
    if evaluations > MOST_EVALUATIONS:
        raise IntegrationError(
            f"the run has {turns:.1e} turns and takes {how} {scientific(evaluations, 1)} evaluations, more than "
            f"{scientific(MOST_EVALUATIONS)}: take a shorter run or a larger tol"
        )


def _loosest(course: _Course, tol: float) -> Generator[Leg, Stretch, _Comparison]:
    """The first pair of integrations of which none is refused, to looser local errors up to GIVEN_UP; else the one that lasts
    longest. The companion begins at the larger an error, the shorter the run, in which it gathers to less."""
    turns = max(float(course.turns(course.times[-1])), 10 / SHORTEST.value)
    local = max(min(tol * FIRST.value * max(1.0, 10 / turns), LOOSEST.value), APART.value * TIGHTEST)
    tight: _Integration | None = None
    best: _Comparison | None = None
    while True:
        loose = course.integration(local, tight is None or not tight.companion)
        tight = tight or course.integration(max(local / APART.value, TIGHTEST), not loose.companion)
        comparison = yield from _compare(course, loose, tight)
        best = comparison if best is None else min(comparison, best, key=lambda one: one.merit)
        singular = isinstance(comparison.refusal, StopError) and comparison.refusal.cause == "singular"
        if not comparison.refusal or course.evolution.elsewhere or local > GIVEN_UP.value or singular:
            return best
        # One that was not refused is compared with a looser one.
        stopped = isinstance(comparison.refusal, StopError) and len(loose.stages) <= len(tight.stages)
        tight, local = (None, local * APART.value**2) if stopped else (loose, local * APART.value)


def _following(course: _Course, comparison: _Comparison, tol: float) -> Generator[Leg, Stretch, _Comparison | None]:
    """A pair at the local errors that give `tol` in proportion; where one is refused there, one with the next tighter."""
    loose, tight = comparison.loose, comparison.tight
    if tight.local < APART.value * TIGHTEST:
        return None
    local = max(min(tight.local, loose.local * tol / comparison.error / 2), APART.value * TIGHTEST)
    third = comparison.error * tight.local / loose.local <= tol / 2
    for companion in (tight,) if third else (course.integration(local, True), tight):
        better = course.integration(max(companion.local / APART.value, TIGHTEST), not companion.companion)
        if better.local > 1.1 * max(course.refused, default=0.0):  # the same by another way, but for rounding
            following = yield from _compare(course, companion, better)
            if not following.refusal:
                return following
    return None


def _compare(course: _Course, loose: _Integration, tight: _Integration) -> Generator[Leg, Stretch, _Comparison]:
    """The two up to the stage in which they part or one stops; refused if the better one does not conserve what it must."""
    evolution, pairs, lost, stop = course.evolution, list[tuple[Array, Array]](), inf, None
    alone = list[NDArray[np.bool_]]()  # where one of the two has passed an event that the other has not
    parts, slacks, farther, spent = list[Array](), [np.ones(1)], 0.0, (0, 0)
    for n, t in enumerate(course.stages):
        one = yield from _states(course, loose, n, None)
        stop = loose.stops[0] if len(loose.stages) <= n else None
        # Where another model or a looser pair is tried next, nothing more is spent on this one.
        if stop and (evolution.elsewhere or (stop.cause == "budget" and loose.local <= GIVEN_UP.value)):
            break
        other = yield from _states(course, tight, n, loose)
        stop = tight.stops[0] if len(tight.stages) <= n else stop
        m, spent = min(len(one.states), len(other.states)), (spent[0] + one.evaluations, spent[1] + other.evaluations)
        pairs.append((one.states[:m], other.states[:m]))
        passed = [
            np.searchsorted([jump for part in (*run.stages[:n], last) for jump in part.jumps], t[:m], side="right")
            for run, last in ((loose, one), (tight, other))
        ]
        alone.append(passed[0] != passed[1])
        together = ~alone[-1]
        if evolution.difference and together.any():
            farther = max(farther, evolution.difference(*(states[together] for states in pairs[-1])))
        parts.append(evolution.distance(*pairs[-1]))
        slack = evolution.slack(other.states[:m]) if evolution.slack else np.ones(m)
        slacks.append(np.maximum.accumulate(np.append(slacks[-1][-1:], slack))[1:])
        errors = _estimated_errors(
            parts[-1], tight.local, course.turns(t[:m]), bool(course.refused), evolution.independent, slacks[-1]
        )
        lost = first_time(t[:m], (errors > LOST.value) & together)
        if lost < inf or stop:
            break
        if n + 1 < len(course.stages):  # what is left costs as much, for its time, as what is done
            share = (course.times[-1] - course.times[0]) / (t[-1] - course.times[0])
            _check_cost(float(course.turns(course.times[-1])), sum(spent) * float(share), "about")
    apart = np.concatenate([np.empty(0), *parts])
    if not len(apart):
        return _Comparison(loose, tight, len(pairs), apart, lost, stop)
    t, off, between = course.t[: len(apart)], None, np.concatenate(alone)
    looser, better = (np.concatenate(states) for states in zip(*pairs, strict=True))
    finite = bool(np.isfinite(looser).all() and np.isfinite(better).all() and np.isfinite(apart).all())
    if evolution.defect and finite and not (stop and evolution.elsewhere):
        off = evolution.defect(t, looser), evolution.defect(t, better)
    slack = np.concatenate(slacks[1:])
    resolved = not course.refused and bool(tight.local >= RESOLVED.value * slack[-1])
    rounding = ROUNDING.value * (START.value + float(course.turns(t[-1])))
    parted = float(apart[~between].max(initial=0.0))
    counts = _counts(spent, off, rounding, resolved)
    errors = _estimated_errors(
        counts * apart, tight.local, course.turns(t), bool(course.refused), evolution.independent, slack
    )
    grown = errors_up_to(t, np.where(between, 0.0, errors), evolution.turn, evolution.sudden)
    known = max(float(grown[-1]) / counts, tight.local, farther)
    errors = np.where(between, np.maximum(errors, grown), grown)
    # Once one of the two has stopped, the pair is refused even if it conserves what it must.
    refusal: IntegrationError | None = stop
    if not (stop and evolution.elsewhere):
        way_out = "take other coordinates or a smaller tol" if evolution.elsewhere else "take a smaller tol"
        if not finite:
            refusal = IntegrationError(f"a value is not finite: {way_out}")
        elif off and (by := _largest(off[1])) > KEPT.value * known:
            refusal = IntegrationError(
                f"what the motion conserves is off by as much as an error of {by:.1e} makes, although {known:.1e} is "
                f"estimated: the run followed another motion; {way_out}"
            )
    return _Comparison(loose, tight, len(pairs), errors, lost, refusal, parted)


def _counts(spent: tuple[int, int], off: tuple[Array, Array] | None, rounding: float, resolved: bool) -> float:
    """How many times SAFETY the difference of two runs counts.

    Errors e and share e differ by (1 − share) e: the better one's is odds = share/(1 − share) times the difference. off: how far
    both are off conserving, a second measure of their errors: odds are those of the better one's to the difference of the two,
    where rounding is not all that it is. SAFETY takes ODDS where nothing is known, and never less: smaller odds, where the better
    one conserves much better, gave one run in a hundred too small an error.
    spent: their evaluations. resolved: whether SAFETY is not squared; where it is, and the better run took twice as many,
    rounding is all that differs, and is in it already.
    """
    counts = CHEAPER.value if spent[1] < spent[0] else 0.0
    if off and (better := _largest(off[1])) > TELLING.value * rounding and (resolved or spent[1] < 2 * spent[0]):
        difference = max(_largest(off[1] - off[0]), rounding)
        counts = max(counts, better / difference / ODDS.value)
    return max(counts, 1.0)


def _largest(values: Array) -> float:
    return float(np.abs(values).max(initial=0.0))


def _states(
    course: _Course, run: _Integration, n: int, beside: _Integration | None
) -> Generator[Leg, Stretch, Stretch]:
    """Stage n of an integration, or what was reached of it."""
    try:
        return (yield from course.stage(run, n, beside if beside and len(beside.stages) > n else None))
    except StopError as stop:
        nothing = Stretch(np.empty((0, len(course.evolution.start))), course.evolution.start, 0)
        return (stop.reached or nothing) if len(run.stages) == n else nothing


def _whole(course: _Course, best: _Comparison, tol: float) -> Generator[Leg, Stretch, EstimatedRun]:
    """The better integration to the end: after the stage in which the two part at BEYOND, at its own local error if that stops;
    and what is known of its error."""
    last, known = len(course.stages) - 1, best.tight.stages[: best.stages]
    run, evolution = best.tight, course.evolution
    if len(known) == best.stages <= last:
        for local in (max(BEYOND.value, run.local), run.local):
            run = replace(run, local=local, stages=list(known), stops=[])
            try:
                yield from course.stage(run, last)
                break
            except StopError:
                continue
    stages = [*run.stages, *(stop.reached for stop in run.stops[:1] if stop.reached)]
    states = np.concatenate([stage.states for stage in stages])
    t, read = course.t[: len(states)], course.read[: len(states)]
    errors = np.full(len(t), UNKNOWN)
    m = min(len(best.errors), len(t))
    errors[:m] = best.errors[:m]
    errors[t >= best.lost] = UNKNOWN
    ending = Ending("lost", best.lost) if best.lost < inf else Ending("end", float(course.times[-1]))
    if run.stops and len(run.stages) <= last:
        stop = run.stops[0]
        words = evolution.singular(stages[-1].end) if evolution.singular and stop.cause == "stopped" else ""
        ending = Ending("singular" if words else stop.cause, stop.at, words or stop.reason.rstrip("."))
    loosened = float(course.stages[best.stages - 1][-1]) if run.local > best.tight.local else inf

    return EstimatedRun(
        t[read],
        states[read],
        errors[read],
        first_time(t, errors > tol),
        course.spent,
        ending,
        best.tight.local,
        loosened,
    )


def first_time(t: Array, where: NDArray[np.bool_]) -> float:
    """The first of the times (n,) at which something is so; inf where it is at none."""
    return float(t[np.argmax(where)]) if where.any() else inf


def _hopeless(course: _Course, comparison: _Comparison) -> bool:
    """Return whether two integrations parted so fast that no tolerance keeps LOST to the end.

    Their difference grew from the looser local error to LOST at `lost`, half the way by `early` (in logarithms): by e^(λt), or
    by a power of t. A tighter tolerance comes as far as the more hopeful of the two says.
    """
    local, begin = comparison.loose.local, float(course.times[0])
    grown, tighter = log(LOST.value / local), log(local / TIGHTEST)
    if comparison.lost == inf or grown <= 0:
        return False
    t, lost = course.t[: len(comparison.errors)] - begin, comparison.lost - begin
    early = max(first_time(t, comparison.errors > (LOST.value * local) ** 0.5), float(t[1]))
    by_power = (lost / early) ** (tighter / (grown / 2))
    return lost * max(1 + tighter / grown, by_power) < course.times[-1] - begin
