"""The contract of runs: a motion integrated twice, at two local errors, and the error that their difference shows.

SAFETY times the difference of the two runs is taken for the error of the better one. It is also the distance to which
neighbouring motions part: from the time at which it exceeds `tol` the run is beyond its horizon, and from the time at which it
exceeds LOST nothing is known. The conserved quantities must be conserved as well as the error allows.

Where errors follow the local error, the difference is APART − 1 times the error of the better run, and the estimate
SAFETY (APART − 1) times that error. An error that both runs have alike is not seen, which is why the two local errors differ so
much: at a fifth of the local error, one of the 1,000 recorded scenes has two runs that are off by the same 2×10⁻⁵. It remains an
estimate: of 360 random systems one, whose neighbouring motions part, is off by 1.6 times it, and warns that `tol` is not kept.
"""

import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf, log
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import Array, Projection, StopError, Stretch
from lagrotor.numerics.solver_constants import (
    APART,
    FIRST,
    GIVEN_UP,
    KEPT,
    LEAST,
    LOOSEST,
    LOST,
    RESOLVED,
    ROUNDING,
    SAFETY,
    SHORTEST,
    START,
    SWING,
)
from lagrotor.result_display import scientific

MOST_EVALUATIONS = 1e8  # of a run: a right-hand side in Python takes minutes for them
_LEAST_A_TURN = 100  # evaluations that two integrations take for a turn at least
UNKNOWN = 2.0  # the most by which two states differ, relative to their size: an error of which nothing is known
# Two runs are compared at so many parts of the time to the first of all others: there one difference is all that is known of the
# error, and between the ends of a step DOP853 is off by up to forty times what it is off at them, with changing sign.
_PARTS = 8
_SAMPLES = 65  # times at which a run is watched besides those it is read at


class EvaluationBudget(NamedTuple):
    """Evaluations that an integration may take: `begin` in all, and `turn` more for each turn of the motion."""

    base: float
    per_turn: float


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
    must. difference: of two runs in everything that is conserved, where `distance` sees only a part.
    watch: times (m,) at which the defect needs the run. singular: of a state at which a solver stopped, the words of the
    singular position that it is at, or none. elsewhere: whether the motion can be run by other coordinates, so that one that
    stops is not tried again. sudden: whether neighbouring motions part within a small part of a turn, at a narrow force.
    """

    start: Array
    integrate: Callable[[Array, Array, float, bool, float], Stretch]
    distance: Callable[[Array, Array], Array]
    turn: float
    budget: EvaluationBudget
    project: Projection | None = None
    start_error: float = 1.0
    constraint_uncertainty: Callable[[Array], Array] | None = None
    sizes: Array | float = 1.0
    conservation_error: Callable[[Array, Array], Array] | None = None
    difference: Callable[[Array, Array], float] | None = None
    watch: Array = field(default_factory=lambda: np.empty(0))
    singular: Callable[[Array], str] | None = None
    has_other_coordinates: bool = False
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

    local: the local error of the better run.
    """

    t: Array
    states: Array
    errors: Array
    horizon: float
    evaluations: int
    ending: Ending
    local: float

    @property
    def run_fields(self) -> dict[str, Any]:
        """The fields of a `Run`, by name."""
        return {name: getattr(self, name) for name in ("t", "errors", "horizon", "evaluations", "ending")}

    def by_clock(self, begin: float, unit: float) -> "EstimatedRun":
        """The same run by a clock (s) that shows `begin` where this one shows 0, its unit of time `unit` s."""

        def at(time: float) -> float:
            return begin + unit * time

        ending = replace(self.ending, at=at(self.ending.at))
        changes: dict[str, Any] = {"t": begin + unit * self.t, "horizon": at(self.horizon)}
        return replace(self, ending=ending, **changes)

    def warn_unless_kept(self, name: str, tol: float, stacklevel: int = 2, hint: str = "") -> None:
        """A LagrotorWarning where `tol` is not kept, or the run ended early; hint: what may be the cause, with the way out."""
        sentences, error = [], float(self.errors[-1])
        if error > tol:
            apart = error / self.local
            reason = (
                f"neighbouring motions part about {scientific(apart)}-fold, and tol can be meant only up to"
                if apart > 1e5
                else "it is below what the solver can give after"
            )
            sentences.append(
                f"{name} does not keep tol = {tol:g}: the estimated error is {scientific(error, 1)}; {reason} "
                f"t = {self.horizon:.6g} s"
            )
        if self.ending.early:
            sentences.append(f"{name} ended early: {self.ending}; it holds what was reached")
        if sentences:
            sentences += [hint] if hint else []
            warnings.warn("simulate: " + "; ".join(sentences), LagrotorWarning, stacklevel=stacklevel + 1)


@dataclass(frozen=True, eq=False)
class _Integration:
    """An integration at one local error: its states up to its end or to where it stopped."""

    local: float
    companion: bool
    stretch: Stretch
    stop: StopError | None = None


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two integrations compared: errors (m,) up to each time that both reached, lost: the time from which they exceed LOST.

    refusal: why the better one is not the motion up to its last time.
    """

    loose: _Integration
    tight: _Integration
    errors: Array
    lost: float
    refusal: IntegrationError | None = None

    @property
    def error(self) -> float:
        return UNKNOWN if self.lost < inf or self.refusal else float(np.max(self.errors, initial=0.0))

    @property
    def merit(self) -> tuple[bool, float, float, int, float]:
        """Smaller is better: not refused, a small error, known for long; of two that stop at once, known better up to there."""
        estimate = float(np.max(self.errors, initial=0.0))
        return self.refusal is not None, self.error, -self.lost, -len(self.errors), estimate


class _Course:
    """A motion, the times t at which it is integrated, the integrations, and the evaluations that were spent on it."""

    def __init__(self, evolution: Evolution, times: Array) -> None:
        begin, end = float(times[0]), float(times[-1])
        t = np.union1d(times, np.linspace(begin, end, _SAMPLES))
        t = np.union1d(t, evolution.watch[(evolution.watch > begin) & (evolution.watch < end)])
        t = np.union1d(t, np.linspace(begin, t[min(1, len(t) - 1)], _PARTS + 1))
        self.evolution, self.times, self.t = evolution, times, t
        self.turns = (t - begin) / evolution.turn
        self.spent, self.refused = 0, 0.0  # evaluations; the largest local error at which an integration stopped
        self.integrations: dict[tuple[float, bool], _Integration] = {}

    def integration(self, local: float, companion: bool) -> Generator[Leg, Stretch, _Integration]:
        """The integration at a local error, made if it is not there yet; companion: from a start off by rounding."""
        evolution = self.evolution
        if run := self.integrations.get((local, companion)):
            return run
        start = self._perturbed_start() if companion else evolution.start
        budget = evolution.budget.base + evolution.budget.per_turn * float(self.turns[-1])
        stretch, cause = Stretch(start[None], start, 0), None
        try:
            if len(self.t) > 1:
                stretch = yield Leg(start, self.t, local, companion, min(budget, MOST_EVALUATIONS))
        except StopError as stop:
            cause, stretch = stop, stop.reached or Stretch(np.empty((0, len(start))), start, 0)
            self.spent += stop.evaluations - stretch.evaluations
        self.spent += stretch.evaluations
        if cause or stretch.evaluations > budget:  # a solver may find out at its end: it is the last one so tight
            self.refused = max(self.refused, local)
        run = self.integrations[local, companion] = _Integration(local, companion, stretch, cause)
        return run

    def _perturbed_start(self) -> Array:
        start, project = self.evolution.start, self.evolution.project
        state = perturbed_state(start, self.evolution.start_error)
        if (
            self.evolution.constraint_uncertainty
        ):  # in each component, however small: a factor of it would be taken back by `project`
            spread = np.finfo(float).eps * (self.evolution.constraint_uncertainty(start[None])[0] - 1)
            state = state + spread * self.evolution.sizes * np.cos(np.arange(1, len(start) + 1))
        return project(state) if project else state


def perturbed_state(start: Array, unsure: float = 1.0) -> Array:
    """A start (…, d) off by rounding times `unsure`, in no special direction."""
    return start * (1 + unsure * np.finfo(float).eps * np.cos(np.arange(1, start.shape[-1] + 1)))


def estimate_run(evolution: Evolution, times: Array, tol: float) -> EstimatedRun:
    """The motion at increasing times (n,), the start holding at times[0], at local errors that keep it within `tol` as the
    estimate has it, else the best there is.

    A run that cannot reach its last time is what was reached, and its ending says why. Raises IntegrationError for a motion that
    does not conserve what it must, or of which nothing is reached, with its evaluations; and for one of so many turns that
    rounding alone leaves nothing known.
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
    """Pairs of integrations until one keeps `tol`: the first as loose as it may be, the next as tight as the error requires.

    The first begins at the larger a local error, the shorter the run, in which local errors gather to less. Where it is refused,
    looser ones follow up to GIVEN_UP. A pair whose looser integration is there already costs one integration only.
    """
    course = _Course(evolution, times)
    turns = float(course.turns[-1])
    unavoidable = ROUNDING.value * (START.value + turns)
    if unavoidable > UNKNOWN:
        raise IntegrationError(
            f"the run has {turns:.1e} turns, after which rounding leaves nothing known: take a shorter run"
        )
    if _LEAST_A_TURN * turns > MOST_EVALUATIONS:
        raise IntegrationError(
            f"the run has {turns:.1e} turns and takes at least {scientific(_LEAST_A_TURN * turns, 1)} evaluations, more than "
            f"{scientific(MOST_EVALUATIONS)}: take a shorter run or a larger tol"
        )
    shortness = 10 / max(turns, 10 / SHORTEST.value)
    local = max(min(tol * FIRST.value * max(1.0, shortness), LOOSEST.value), APART.value * TIGHTEST)
    best = pair = yield from _compared(course, local, True)
    while pair.refusal and not (
        evolution.has_other_coordinates or local > GIVEN_UP.value or _at_singular(pair.refusal)
    ):
        again = pair.loose.stop is None  # it is compared with a looser one
        local *= APART.value if again else APART.value**2
        pair = yield from _compared(course, local, pair.loose.companion ^ again)
        best = min(pair, best, key=lambda candidate: candidate.merit)
    pair = best
    while unavoidable <= tol < pair.error and not pair.refusal and not _hopeless(course, pair):
        third = pair.error / APART.value <= tol / 2 and pair.tight.local >= APART.value * TIGHTEST
        local = max(min(pair.tight.local, pair.loose.local * tol / pair.error / 2), APART.value * TIGHTEST)
        local, companion = (pair.tight.local, pair.tight.companion) if third else (local, True)
        if local / APART.value <= 1.1 * course.refused or local >= pair.loose.local:
            break
        pair = yield from _compared(course, local, companion)
        best = min(pair, best, key=lambda candidate: candidate.merit)
    refusal = best.refusal
    if refusal and not (isinstance(refusal, StopError) and len(best.errors) > 1):
        refusal.evaluations = course.spent
        raise refusal
    return _estimated(course, best, tol)


def _at_singular(refusal: IntegrationError) -> bool:
    return isinstance(refusal, StopError) and refusal.cause == "singular"


def _compared(course: _Course, local: float, companion: bool) -> Generator[Leg, Stretch, _Pair]:
    """The integrations at a local error and at the APART-th part of it, compared.

    They are refused if the better one does not conserve what it must."""
    evolution = course.evolution
    loose = yield from course.integration(local, companion)
    # Where another model or a looser pair is tried next, nothing more is spent on this one.
    if loose.stop and (evolution.has_other_coordinates or (loose.stop.cause == "budget" and local <= GIVEN_UP.value)):
        return _Pair(loose, loose, np.empty(0), inf, loose.stop)
    tight = yield from course.integration(local / APART.value, not companion)
    stop = tight.stop or loose.stop
    coarse, fine = loose.stretch, tight.stretch
    m = min(len(coarse.states), len(fine.states))
    if not m:
        return _Pair(loose, tight, np.empty(0), inf, stop)
    t, looser, better = course.t[:m], coarse.states[:m], fine.states[:m]
    # Where one of the two has passed an event that the other has not, only what is read there is compared.
    jumps = [np.searchsorted(stretch.jumps, t, side="right") for stretch in (coarse, fine)]
    together = jumps[0] == jumps[1]
    distance = evolution.distance(looser, better)
    finite = bool(np.isfinite(looser).all() and np.isfinite(better).all() and np.isfinite(distance).all())
    uncertainty = (
        np.maximum.accumulate(evolution.constraint_uncertainty(better)) if evolution.constraint_uncertainty else 1.0
    )
    rounding = ROUNDING.value * (START.value + course.turns[:m])
    difference = SAFETY.value ** np.where(tight.local < RESOLVED.value * uncertainty, 2, 1) * distance
    least = LEAST.value * tight.local + rounding
    lost = first_time(t, (difference + least > LOST.value) & together)
    violations = (
        [evolution.conservation_error(t, states) for states in (looser, better)]
        if evolution.conservation_error and finite
        else []
    )
    factor = _alikeness(violations, rounding[-1])
    errors = factor * difference + least
    grown = errors_up_to(t, np.where(together, errors, 0.0), evolution.turn, evolution.sudden)
    refusal: IntegrationError | None = stop
    if not (stop and evolution.has_other_coordinates):
        way_out = "take other coordinates or a smaller tol" if evolution.has_other_coordinates else "take a smaller tol"
        estimate = max(float(grown[-1]) / factor, tight.local)
        if evolution.difference and together.any():
            estimate = max(estimate, evolution.difference(looser[together], better[together]))
        if not finite:
            refusal = IntegrationError(f"a value is not finite: {way_out}")
        elif violations and (violation := _largest(violations[1])) > KEPT.value * estimate:
            refusal = IntegrationError(
                f"what the motion conserves is off by as much as an error of {violation:.1e} makes, although {estimate:.1e} is "
                f"estimated: the run followed another motion; {way_out}"
            )
    return _Pair(loose, tight, np.where(together, grown, np.maximum(errors, grown)), lost, refusal)


def _alikeness(defects: Sequence[Array], rounding: float) -> float:
    """How many times more than elsewhere the difference of two runs counts whose conserved quantities are off alike.

    The odds of the better one's error to the difference of the two are measured by the defects, where rounding is not most of
    them. SAFETY is for odds up to a half.
    """
    if not defects or _largest(defects[1]) < 10 * rounding:
        return 1.0
    return max(1.0, 2 * _largest(defects[1]) / max(_largest(defects[1] - defects[0]), rounding))


def _largest(values: Array) -> float:
    return float(np.abs(values).max(initial=0.0))


def errors_up_to(t: Array, errors: Array, turn: float, sudden: bool = False) -> Array:
    """The largest errors (n,) up to each of the times t (n,), of a motion that turns in the time `turn`.

    Two runs that part swing through each other: as much is known as to the end of a swing. Errors are taken to grow by a power of
    the time or by e^(λt), so that their logarithm is concave, where the difference of two runs that were near by chance grows
    faster. The least curve above it whose logarithm is concave is the estimate, unless motions part suddenly.
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


def _estimated(course: _Course, best: _Pair, tol: float) -> EstimatedRun:
    """The better integration with its errors and its ending, at the times that are read."""
    states, stop, singular = best.tight.stretch.states, best.tight.stop, course.evolution.singular
    t = course.t[: len(states)]
    errors = np.full(len(t), UNKNOWN)
    errors[: len(best.errors)] = np.minimum(best.errors, UNKNOWN)
    errors[t >= best.lost] = UNKNOWN
    ending = Ending("lost", best.lost) if best.lost < inf else Ending("end", float(course.times[-1]))
    if stop:
        words = singular(best.tight.stretch.end) if singular and stop.cause == "stopped" else ""
        ending = Ending("singular" if words else stop.cause, stop.at, words or stop.reason.rstrip("."))
    read = np.isin(t, course.times)
    horizon = first_time(t, errors > tol)
    return EstimatedRun(t[read], states[read], errors[read], horizon, course.spent, ending, best.tight.local)


def first_time(t: Array, where: NDArray[np.bool_]) -> float:
    """The first of the times (n,) at which something is so; inf where it is at none."""
    return float(t[np.argmax(where)]) if where.any() else inf


def _hopeless(course: _Course, pair: _Pair) -> bool:
    """Return whether two integrations parted so fast that no tolerance keeps LOST to the end.

    Their difference grew from the looser local error to LOST at `lost`, half the way by `early` (in logarithms): by e^(λt), or
    by a power of t. A tighter tolerance comes as far as the more hopeful of the two says.
    """
    local, begin = pair.loose.local, float(course.times[0])
    grown, tighter = log(LOST.value / local), log(local / TIGHTEST)
    if pair.lost == inf or grown <= 0:
        return False
    t, lost = course.t[: len(pair.errors)] - begin, pair.lost - begin
    early = max(first_time(t, pair.errors > (LOST.value * local) ** 0.5), float(t[1]))
    by_power = (lost / early) ** (tighter / (grown / 2))
    return lost * max(1 + tighter / grown, by_power) < course.times[-1] - begin
