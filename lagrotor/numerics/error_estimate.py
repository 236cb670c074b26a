"""Error estimate of every run: the motion is integrated at two local errors, and their difference shows the error.

The error of the better run is estimated as SAFETY times the difference of the two runs, which also shows how far neighbouring
motions separate. From the time at which the estimate exceeds `tol`, the run is beyond its horizon. From the time at which it
exceeds LOST, the states count as unknown. Conserved quantities must not change by more than 100 times the estimate.

Where errors are proportional to the local error, the difference is APART − 1 times the error of the better run. The estimate is
then SAFETY (APART − 1) times that error. An error that both runs share is not seen, which is why their local errors
differ by the factor APART. The estimate is not a bound. Of 360 random systems, one chaotic system has 1.6 times the estimated
error; its run warns that `tol` is not kept.
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
_LEAST_A_TURN = 100  # least evaluations of two integrations per turn
UNKNOWN = 2.0  # the error of an unknown state: the largest difference of two states relative to their size
# The time to the first sample is divided, since one difference there is no estimate: within a step the error of DOP853 is up to
# forty times its error at the ends, with changing sign.
_PARTS = 8
_SAMPLES = 65  # times at which two runs are compared besides the requested times


class EvaluationBudget(NamedTuple):
    """The number of evaluations that an integration may take: `base`, plus `per_turn` for each period of the motion."""

    base: float
    per_turn: float


@dataclass(frozen=True, eq=False)
class Evolution:
    """A motion to be run: its initial state (d,), a function that integrates it, and functions that measure its error."""

    start: Array
    # Start (d,), times (n,), local error, companion, most evaluations → the motion from times[0]. A companion uses another order
    # or other steps, where the local error does not set them.
    integrate: Callable[[Array, Array, float, bool, float], Stretch]
    distance: Callable[[Any, Any], Array]  # two observed runs → distance (n,) relative to the size of the states
    turn: float  # typical period in s
    budget: EvaluationBudget
    project: Projection | None = None  # brings a state back onto its constraints
    start_error: float = 1.0  # of the initial state in machine epsilons, by which the companion's start is perturbed
    # States (n, d) → error (n,) along nearly dependent constraints, in machine epsilons of the sizes (d,).
    constraint_uncertainty: Callable[[Array], Array] | None = None
    sizes: Array | float = 1.0
    # States (n, d) → the quantities that the distance, the conservation error and the difference measure, computed once a run.
    observe: Callable[[Array], Any] = lambda states: states
    # Times (n,), observed run → signed state errors that would explain the change of the conserved quantities.
    conservation_error: Callable[[Array, Any], Array] | None = None
    difference: Callable[[Any, Any], float] | None = None  # of two observed runs in all conserved quantities
    watch: Array = field(default_factory=lambda: np.empty(0))  # times (m,) that the conservation error needs
    singular: Callable[[Array], str] | None = None  # state of a stop → the words for a singular position, or ""
    has_other_coordinates: bool = False  # then a run that stops is not tried again
    sudden: bool = False  # neighbouring motions separate within a small part of a turn, at a narrow force


class Leg(NamedTuple):
    """The arguments of one call of `Evolution.integrate`. The flag `companion` marks the run that only serves for comparison."""

    start: Array
    times: Array
    local: float
    companion: bool
    budget: float


@dataclass(frozen=True, eq=False)
class EstimatedRun:
    """A run with its estimated errors: states (n, d) and the largest error up to each time (n,), at the times (n,) in s that were
    reached. The horizon is the time in s from which the errors exceed tol. The ending says why the run ended, and `local` is the
    local error of the better of two integrations."""

    t: Array
    states: Array
    errors: Array
    horizon: float
    evaluations: int
    ending: Ending
    local: float

    @property
    def run_fields(self) -> dict[str, Any]:
        """The values of the fields of a `Run`, by the name of the field."""
        return {name: getattr(self, name) for name in ("t", "errors", "horizon", "evaluations", "ending")}

    def by_clock(self, begin: float, unit: float) -> "EstimatedRun":
        """Return the run with begin + unit · t, in s, in place of each time t."""

        def at(time: float) -> float:
            return begin + unit * time

        ending = replace(self.ending, at=at(self.ending.at))
        changes: dict[str, Any] = {"t": begin + unit * self.t, "horizon": at(self.horizon)}
        return replace(self, ending=ending, **changes)

    def warn_unless_kept(self, name: str, tol: float, stacklevel: int = 2, hint: str = "") -> None:
        """Warn if the error exceeds `tol` or the run ended early. The run is called `name`, and `hint` adds a possible cause and
        a remedy."""
        sentences, error = [], float(self.errors[-1])
        if error > tol:
            apart = error / self.local
            reason = (
                f"neighbouring motions separate {scientific(apart)}-fold, and tol is kept only up to"
                if apart > 1e5
                else "the solver cannot keep it after"
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
    """An integration at one local error: its states up to the end, or up to the stop if a solver stopped."""

    local: float
    companion: bool
    stretch: Stretch
    stop: StopError | None = None


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two integrations that are compared, the looser and the tighter one. The largest errors up to each common time are `errors`
    (m,). From the time `lost` on they exceed LOST, and the states are unknown. A `refusal` says why the tighter integration is
    not the motion up to its last time."""

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
        """A sort key for pairs of runs, smallest for the best. A better pair, in order of priority, is not refused, has the
        smaller error, is lost later, has more common times, or the smaller error up to a stop."""
        estimate = float(np.max(self.errors, initial=0.0))
        return self.refusal is not None, self.error, -self.lost, -len(self.errors), estimate


class _Course:
    """The state of an error estimate: the motion, the times t (m,) of comparison, the integrations so far by (local error,
    companion), and the number of all evaluations."""

    def __init__(self, evolution: Evolution, times: Array) -> None:
        begin, end = float(times[0]), float(times[-1])
        t = np.union1d(times, np.linspace(begin, end, _SAMPLES))
        t = np.union1d(t, evolution.watch[(evolution.watch > begin) & (evolution.watch < end)])
        t = np.union1d(t, np.linspace(begin, t[min(1, len(t) - 1)], _PARTS + 1))
        self.evolution, self.times, self.t = evolution, times, t
        self.turns = (t - begin) / evolution.turn
        self.evaluations, self.refused = 0, 0.0  # refused: the largest local error at which an integration stopped
        self.integrations: dict[tuple[float, bool], _Integration] = {}

    def integration(self, local: float, companion: bool) -> Generator[Leg, Stretch, _Integration]:
        """Return the integration at a local error, computed only once. A companion, which only serves for comparison, starts from
        a perturbed state."""
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
            self.evaluations += stop.evaluations - stretch.evaluations
        self.evaluations += stretch.evaluations
        if cause or stretch.evaluations > budget:  # a solver may see only at its end that the budget is exceeded
            self.refused = max(self.refused, local)
        run = self.integrations[local, companion] = _Integration(local, companion, stretch, cause)
        return run

    def _perturbed_start(self) -> Array:
        start, project = self.evolution.start, self.evolution.project
        state = perturbed_state(start, self.evolution.start_error)
        if uncertainty := self.evolution.constraint_uncertainty:  # added, since `project` would undo a factor
            spread = np.finfo(float).eps * (uncertainty(start[None])[0] - 1)
            state = state + spread * self.evolution.sizes * np.cos(np.arange(1, len(start) + 1))
        return project(state) if project else state


def perturbed_state(y0: Array, epsilons: float = 1.0) -> Array:
    """Multiply each component of a state (…, d) by 1 and at most `epsilons` machine epsilons more or less, in no special
    direction."""
    return y0 * (1 + epsilons * np.finfo(float).eps * np.cos(np.arange(1, y0.shape[-1] + 1)))


def estimate_run(evolution: Evolution, times: Array, tol: float) -> EstimatedRun:
    """Integrate a motion at increasing times (n,) with an estimated error below `tol`, or as small as possible. Raise
    IntegrationError if conserved quantities change, no time is reached, or rounding errors exceed the states over so many
    turns."""

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
    """Integrate many motions together, each with an estimated error, and return a run or an IntegrationError for each. The
    function `integrate` takes the arguments of the next integration of each motion, a `Leg`, by the motion's number. It returns
    the stretch or the StopError of each."""
    requests = [_requests(evolution, t, tol) for evolution, t in zip(evolutions, times, strict=True)]
    ended: dict[int, EstimatedRun | IntegrationError] = {}
    answers: Mapping[int, Stretch | StopError | None] = dict.fromkeys(range(len(requests)))
    while answers:
        legs = dict[int, Leg]()
        for i, answer in answers.items():
            try:
                # The first answer is None: it starts the generator.
                legs[i] = requests[i].throw(answer) if isinstance(answer, StopError) else requests[i].send(answer)  # type: ignore[arg-type]
            except StopIteration as end:
                ended[i] = end.value
            except IntegrationError as refusal:
                ended[i] = refusal
        answers = integrate(legs) if legs else {}
    return [ended[i] for i in range(len(requests))]


def _requests(evolution: Evolution, times: Array, tol: float) -> Generator[Leg, Stretch, EstimatedRun]:
    """Yield the integrations of pairs until a pair keeps `tol`, then return the run. The first pair has the largest useful local
    error, and the next pair the local error that the estimate requires. In a short run local errors add up to less, so the first
    one is larger. After a refusal looser pairs follow, up to the local error GIVEN_UP."""
    course = _Course(evolution, times)
    turns = float(course.turns[-1])
    unavoidable = ROUNDING.value * (START.value + turns)
    if unavoidable > UNKNOWN:
        raise IntegrationError(
            f"the run has {turns:.1e} turns, over which rounding errors exceed the states: take a shorter run"
        )
    if _LEAST_A_TURN * turns > MOST_EVALUATIONS:
        raise IntegrationError(
            f"the run has {turns:.1e} turns and takes at least {scientific(_LEAST_A_TURN * turns, 1)} evaluations, more than "
            f"{scientific(MOST_EVALUATIONS)}: take a shorter run or a larger tol"
        )
    shortness = 10 / max(turns, 10 / SHORTEST.value)
    local = max(min(tol * FIRST.value * max(1.0, shortness), LOOSEST.value), APART.value * TIGHTEST)
    best = pair = yield from _compare(course, local, True)
    final = evolution.has_other_coordinates
    while pair.refusal and not (final or local > GIVEN_UP.value or _at_singular(pair.refusal)):
        again = pair.loose.stop is None  # then the looser integration is compared with one looser still
        local *= APART.value if again else APART.value**2
        pair = yield from _compare(course, local, pair.loose.companion ^ again)
        best = min(pair, best, key=lambda candidate: candidate.merit)
    pair = best
    while unavoidable <= tol < pair.error and not pair.refusal and not _hopeless(course, pair):
        third = pair.error / APART.value <= tol / 2 and pair.tight.local >= APART.value * TIGHTEST
        local = max(min(pair.tight.local, pair.loose.local * tol / pair.error / 2), APART.value * TIGHTEST)
        local, companion = (pair.tight.local, pair.tight.companion) if third else (local, True)
        if local / APART.value <= 1.1 * course.refused or local >= pair.loose.local:
            break
        pair = yield from _compare(course, local, companion)
        best = min(pair, best, key=lambda candidate: candidate.merit)
    refusal = best.refusal
    if refusal and not (isinstance(refusal, StopError) and len(best.errors) > 1):
        refusal.evaluations = course.evaluations
        raise refusal
    return _estimated(course, best, tol)


def _at_singular(refusal: IntegrationError) -> bool:
    return isinstance(refusal, StopError) and refusal.cause == "singular"


def _compare(course: _Course, local: float, companion: bool) -> Generator[Leg, Stretch, _Pair]:
    """Return the pair of the integrations at the given local error and at 1/APART of it, with its errors. The tighter integration
    is refused if its conserved quantities change by far more than the estimated error explains."""
    evolution = course.evolution
    loose = yield from course.integration(local, companion)
    # Another model or a looser pair is tried next, so the tighter integration is not needed.
    if loose.stop and (evolution.has_other_coordinates or (loose.stop.cause == "budget" and local <= GIVEN_UP.value)):
        return _Pair(loose, loose, np.empty(0), inf, loose.stop)
    tight = yield from course.integration(local / APART.value, not companion)
    stop = tight.stop or loose.stop
    coarse, fine = loose.stretch, tight.stretch
    m = min(len(coarse.states), len(fine.states))
    if not m:
        return _Pair(loose, tight, np.empty(0), inf, stop)
    t, looser, better = course.t[:m], coarse.states[:m], fine.states[:m]
    observed = [evolution.observe(states) for states in (looser, better)]
    # Between the two times at which the runs pass the same event, their states are not compared.
    jumps = [np.searchsorted(stretch.jumps, t, side="right") for stretch in (coarse, fine)]
    together = jumps[0] == jumps[1]
    distance = evolution.distance(*observed)
    finite = bool(np.isfinite(looser).all() and np.isfinite(better).all() and np.isfinite(distance).all())
    uncertain = evolution.constraint_uncertainty
    uncertainty = np.maximum.accumulate(uncertain(better)) if uncertain else 1.0
    rounding = ROUNDING.value * (START.value + course.turns[:m])
    difference = SAFETY.value ** np.where(tight.local < RESOLVED.value * uncertainty, 2, 1) * distance
    least = LEAST.value * tight.local + rounding
    lost = first_time(t, (difference + least > LOST.value) & together)
    conserved = evolution.conservation_error
    violations = [conserved(t, one) for one in observed] if conserved and finite else []
    factor = _shared_error_factor(violations, rounding[-1])
    errors = factor * difference + least
    grown = errors_up_to(t, np.where(together, errors, 0.0), evolution.turn, evolution.sudden)
    refusal: IntegrationError | None = stop
    if not (stop and evolution.has_other_coordinates):
        way_out = "take other coordinates or a smaller tol" if evolution.has_other_coordinates else "take a smaller tol"
        estimate = max(float(grown[-1]) / factor, tight.local)
        if evolution.difference and together.any():
            if not together.all():
                observed = [evolution.observe(states[together]) for states in (looser, better)]
            estimate = max(estimate, evolution.difference(*observed))
        if not finite:
            refusal = IntegrationError(f"a value is not finite: {way_out}")
        elif violations and (violation := _largest(violations[1])) > KEPT.value * estimate:
            refusal = IntegrationError(
                f"the conserved quantities change by as much as for an error of {violation:.1e}, although {estimate:.1e} is "
                f"estimated: the run followed another motion; {way_out}"
            )
    return _Pair(loose, tight, np.where(together, grown, np.maximum(errors, grown)), lost, refusal)


def _shared_error_factor(defects: Sequence[Array], rounding: float) -> float:
    """Return the factor, at least 1, by which the estimate must grow because both runs share an error that their difference
    hides. It follows from the conserved quantities of both runs, unless their change is mostly rounding. SAFETY covers an error
    of the better run up to half the difference."""
    if not defects or _largest(defects[1]) < 10 * rounding:
        return 1.0
    return max(1.0, 2 * _largest(defects[1]) / max(_largest(defects[1] - defects[0]), rounding))


def _largest(values: Array) -> float:
    return float(np.abs(values).max(initial=0.0))


def errors_up_to(t: Array, errors: Array, turn: float, sudden: bool = False) -> Array:
    """Return the largest error up to each time t (n,), shape (n,), for a motion with the typical period `turn` in s. Two runs
    that separate may cross, so the maximum extends to SWING periods later. Errors grow as a power of time or as e^(λt),
    so their logarithm is concave, although two runs may be close by chance. The result is therefore the least concave curve above
    the logarithm, unless motions separate suddenly."""
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
    """Return the tighter integration of a pair at the requested times, with its errors and its ending."""
    states, stop, singular = best.tight.stretch.states, best.tight.stop, course.evolution.singular
    t = course.t[: len(states)]
    errors = np.full(len(t), UNKNOWN)
    errors[: len(best.errors)] = np.minimum(best.errors, UNKNOWN)
    errors[t >= best.lost] = UNKNOWN
    ending = Ending("lost", best.lost) if best.lost < inf else Ending("end", float(course.times[-1]))
    if stop:
        words = singular(best.tight.stretch.end) if singular and stop.cause == "stopped" else ""
        ending = Ending("singular" if words else stop.cause, stop.at, words or stop.reason.rstrip("."))
    read = np.searchsorted(course.t, course.times)
    read, horizon = read[read < len(t)], first_time(t, errors > tol)
    return EstimatedRun(t[read], states[read], errors[read], horizon, course.evaluations, ending, best.tight.local)


def first_time(t: Array, where: NDArray[np.bool_]) -> float:
    """Return the first of the times (n,) at which `where` is true; inf if there is none."""
    return float(t[np.argmax(where)]) if where.any() else inf


def _hopeless(course: _Course, pair: _Pair) -> bool:
    """Return True if two integrations separated so fast that no tolerance keeps the error below LOST to the end. The difference
    grew as e^(λt) or as a power of t. It reached LOST at the time `lost`, and half of that growth in logarithms at `early`. The
    tightest tolerance moves `lost` at most to the later of the two times that these laws predict."""
    local, begin = pair.loose.local, float(course.times[0])
    grown, tighter = log(LOST.value / local), log(local / TIGHTEST)
    if pair.lost == inf or grown <= 0:
        return False
    t, lost = course.t[: len(pair.errors)] - begin, pair.lost - begin
    early = max(first_time(t, pair.errors > (LOST.value * local) ** 0.5), float(t[1]))
    by_power = (lost / early) ** (tighter / (grown / 2))
    return lost * max(1 + tighter / grown, by_power) < course.times[-1] - begin
