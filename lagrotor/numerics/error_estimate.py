"""Error estimate of every run: the motion is integrated at two local errors, and their difference shows the error.

SAFETY times the difference of the two runs is taken for the error of the better one. It is also the distance by which
neighbouring motions separate. From the time at which it exceeds `tol` the run is beyond its horizon; from the time at which it
exceeds LOST nothing is known. Conserved quantities must be conserved within 100 times the estimate.

Where errors are proportional to the local error, the difference is APART − 1 times the error of the better run, and the
estimate is SAFETY (APART − 1) times that error. An error that both runs share is not seen, which is why their local errors
differ by the factor APART. The estimate is not a bound: one of 360 random systems, a chaotic one, exceeds it by 1.6 times, and
warns that `tol` is not kept.
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
    """The number of evaluations that an integration may take: `base`, and `per_turn` for each turn of the motion."""

    base: float
    per_turn: float


@dataclass(frozen=True, eq=False)
class Evolution:
    """A motion to be run: its initial state (d,), its integration, and the measures of its error."""

    start: Array
    # Start (d,), times (n,), local error, companion, most evaluations → the motion from times[0]. A companion uses another order
    # or other steps, where the local error does not set them.
    integrate: Callable[[Array, Array, float, bool, float], Stretch]
    distance: Callable[[Array, Array], Array]  # two runs (n, d) → distance (n,) relative to the size of the states
    turn: float  # typical period in s
    budget: EvaluationBudget
    project: Projection | None = None  # brings a state back onto its constraints
    start_error: float = 1.0  # of the initial state in machine epsilons, by which the companion's start is perturbed
    # States (n, d) → error (n,) along nearly dependent constraints, in machine epsilons of the sizes (d,).
    constraint_uncertainty: Callable[[Array], Array] | None = None
    sizes: Array | float = 1.0
    # Times (n,), states (n, d) → signed state errors that would explain the change of the conserved quantities.
    conservation_error: Callable[[Array, Array], Array] | None = None
    difference: Callable[[Array, Array], float] | None = None  # of two runs in all conserved quantities
    watch: Array = field(default_factory=lambda: np.empty(0))  # times (m,) that the conservation error needs
    singular: Callable[[Array], str] | None = None  # state of a stop → the words for a singular position, or ""
    has_other_coordinates: bool = False  # then a run that stops is not tried again
    sudden: bool = False  # neighbouring motions separate within a small part of a turn, at a narrow force


class Leg(NamedTuple):
    """The arguments of one call of `Evolution.integrate`."""

    start: Array
    times: Array
    local: float
    companion: bool
    budget: float


@dataclass(frozen=True, eq=False)
class EstimatedRun:
    """States (n, d) at the times (n,) that were reached, the largest error up to each time (n,), and the ending. The horizon is
    the time in s from which the errors exceed tol, `local` the local error of the better run."""

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
        """Return the run on another clock, which shows `begin` (s) at time 0 and has the unit of time `unit` (s)."""

        def at(time: float) -> float:
            return begin + unit * time

        ending = replace(self.ending, at=at(self.ending.at))
        changes: dict[str, Any] = {"t": begin + unit * self.t, "horizon": at(self.horizon)}
        return replace(self, ending=ending, **changes)

    def warn_unless_kept(self, name: str, tol: float, stacklevel: int = 2, hint: str = "") -> None:
        """Warn where `tol` is not kept or the run ended early; `hint` adds a possible cause and the way out."""
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
    """An integration at one local error: its states up to its end or to the stop."""

    local: float
    companion: bool
    stretch: Stretch
    stop: StopError | None = None


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two integrations compared: errors (m,) up to each common time, and the time `lost` from which they exceed LOST.
    `refusal` is the reason why the better integration is not the motion up to its last time."""

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
        """A sort key, smallest for the best pair: not refused, small error, lost late, many times, small error up to a stop."""
        estimate = float(np.max(self.errors, initial=0.0))
        return self.refusal is not None, self.error, -self.lost, -len(self.errors), estimate


class _Course:
    """A motion, its times t, its integrations by (local error, companion), and all evaluations so far."""

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
        """Return the integration at a local error, from memory where it exists; a companion starts from a perturbed state."""
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
    """Perturb an initial state (…, d) by a multiple of the rounding error, in no special direction."""
    return y0 * (1 + epsilons * np.finfo(float).eps * np.cos(np.arange(1, y0.shape[-1] + 1)))


def estimate_run(evolution: Evolution, times: Array, tol: float) -> EstimatedRun:
    """Integrate a motion at increasing times (n,) with an estimated error below `tol`, or as small as possible. Raises
    IntegrationError where conserved quantities change, no time is reached, or the rounding of so many turns exceeds the
    states."""

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
    """Estimate many motions together; an IntegrationError takes the place of a refused run. `integrate` maps {number: leg} to
    {number: stretch or stop}."""
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
    """Yield integrations in pairs until a pair keeps `tol`, then return the run. The first pair has the largest useful local
    error, the next the one that the error requires. Local errors add up to less in a short run, so its first one is larger.
    After a refusal looser pairs follow up to GIVEN_UP."""
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
    """Compare the integrations at a local error and at 1/APART of it; refuse the better one if conserved quantities change."""
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
    # Between the two times at which the runs pass the same event, their states are not compared.
    jumps = [np.searchsorted(stretch.jumps, t, side="right") for stretch in (coarse, fine)]
    together = jumps[0] == jumps[1]
    distance = evolution.distance(looser, better)
    finite = bool(np.isfinite(looser).all() and np.isfinite(better).all() and np.isfinite(distance).all())
    uncertain = evolution.constraint_uncertainty
    uncertainty = np.maximum.accumulate(uncertain(better)) if uncertain else 1.0
    rounding = ROUNDING.value * (START.value + course.turns[:m])
    difference = SAFETY.value ** np.where(tight.local < RESOLVED.value * uncertainty, 2, 1) * distance
    least = LEAST.value * tight.local + rounding
    lost = first_time(t, (difference + least > LOST.value) & together)
    conserved = evolution.conservation_error
    violations = [conserved(t, states) for states in (looser, better)] if conserved and finite else []
    factor = _shared_error_factor(violations, rounding[-1])
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
                f"the conserved quantities change by as much as for an error of {violation:.1e}, although {estimate:.1e} is "
                f"estimated: the run followed another motion; {way_out}"
            )
    return _Pair(loose, tight, np.where(together, grown, np.maximum(errors, grown)), lost, refusal)


def _shared_error_factor(defects: Sequence[Array], rounding: float) -> float:
    """Return the factor, at least 1, by which two runs share an error that their difference hides. The conserved quantities
    measure it, unless their change is mostly rounding. SAFETY allows an error of the better run up to half the difference."""
    if not defects or _largest(defects[1]) < 10 * rounding:
        return 1.0
    return max(1.0, 2 * _largest(defects[1]) / max(_largest(defects[1] - defects[0]), rounding))


def _largest(values: Array) -> float:
    return float(np.abs(values).max(initial=0.0))


def errors_up_to(t: Array, errors: Array, turn: float, sudden: bool = False) -> Array:
    """Return the largest errors (n,) up to each time t (n,), for a motion with the typical period `turn`. Two runs that
    separate cross each other, so the maximum extends to the end of a swing. Errors grow by a power of the time or by e^(λt),
    so the logarithm is concave, although two runs may be close by chance. The estimate is the least concave curve above the
    logarithm, unless motions separate suddenly."""
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
    """Return the better integration with its errors and its ending, at the requested times."""
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
    return EstimatedRun(t[read], states[read], errors[read], horizon, course.evaluations, ending, best.tight.local)


def first_time(t: Array, where: NDArray[np.bool_]) -> float:
    """Return the first of the times (n,) at which the condition holds; inf if it never does."""
    return float(t[np.argmax(where)]) if where.any() else inf


def _hopeless(course: _Course, pair: _Pair) -> bool:
    """Return True if two integrations separated so fast that no tolerance keeps the error below LOST to the end. The difference
    grew as e^(λt) or as a power of t, to LOST at `lost` and half the way in logarithms at `early`. A tighter tolerance reaches
    at most the later of the two extrapolated times."""
    local, begin = pair.loose.local, float(course.times[0])
    grown, tighter = log(LOST.value / local), log(local / TIGHTEST)
    if pair.lost == inf or grown <= 0:
        return False
    t, lost = course.t[: len(pair.errors)] - begin, pair.lost - begin
    early = max(first_time(t, pair.errors > (LOST.value * local) ** 0.5), float(t[1]))
    by_power = (lost / early) ** (tighter / (grown / 2))
    return lost * max(1 + tighter / grown, by_power) < course.times[-1] - begin
