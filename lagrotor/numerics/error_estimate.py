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
_BESIDE = (
    1e-9  # distance of a sample from a requested time, as part of the run, below which the sample tells nothing more
)
_NONE = np.empty(0)


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


class Legs(NamedTuple):
    """The arguments of n legs as arrays: starts (n, d), times (n, m), local errors, flags of companions and budgets, (n,) each.
    Rows with fewer times repeat their last one."""

    start: Array
    times: Array
    local: Array
    companion: NDArray[np.bool_]
    budget: Array

    def take(self, rows: NDArray[np.intp]) -> "Legs":
        """Return the legs of some rows."""
        return Legs(self.start[rows], self.times[rows], self.local[rows], self.companion[rows], self.budget[rows])

    @classmethod
    def of(cls, legs: Sequence[Leg]) -> "Legs":
        """Return some legs as arrays."""
        m = max(len(leg.times) for leg in legs)
        times = np.array([np.pad(leg.times, (0, m - len(leg.times)), "edge") for leg in legs])
        columns = [np.array(column) for column in zip(*((leg.start, *leg[2:]) for leg in legs), strict=True)]
        return cls(columns[0], times, *columns[1:])


@dataclass(frozen=True, eq=False)
class Motions:
    """The motions of n legs with states of d components: `components` (d, n, m), of which the first `reached` (n,) times of each
    leg are known, the number of evaluations (n,), and the errors that stopped a solver by the number of the leg."""

    components: Array
    reached: NDArray[np.int64]
    evaluations: NDArray[np.int64]
    stops: dict[int, StopError]

    @classmethod
    def begun(cls, legs: Legs, components: Array | None = None) -> "Motions":
        """Return motions of which only the starts are known, in an array (d, n, m) if it is given."""
        n, m = legs.times.shape
        components = np.empty((legs.start.shape[1], n, m)) if components is None else components
        components[:, :, 0] = legs.start.T
        return cls(components, np.full(n, m), np.zeros(n, np.int64), {})

    @property
    def states(self) -> Array:
        """The states, (n, m, d)."""
        return np.moveaxis(self.components, 0, -1)

    def answer(self, i: int, leg: Leg) -> Stretch | StopError:
        """Return the motion of one leg alone, or the error that stopped it, with the motion up to the stop."""
        n = min(int(self.reached[i]), len(leg.times))
        states, stop = self.states[i, :n].copy(), self.stops.get(i)
        stretch = Stretch(states, states[-1] if n else leg.start, int(self.evaluations[i]))
        if stop is None:
            return stretch
        return StopError(stop.at, stop.reason, stop.reached or stretch, cause=stop.cause)


def finite_times(components: Array) -> NDArray[np.int64]:
    """Return the number (n,) of times up to the first state that is not finite, from components (d, n, m)."""
    finite = np.logical_and.reduce(np.isfinite(components), axis=0)
    return np.where(finite.all(1), finite.shape[1], np.argmin(finite, axis=1))


def march_legs(
    legs: Mapping[int, Leg], march: Callable[[NDArray[np.intp], Legs], Motions]
) -> dict[int, Stretch | StopError]:
    """Integrate legs by a function that takes the numbers of some problems and their legs as arrays."""
    listed = list(legs.values())
    motions = march(np.array(list(legs)), Legs.of(listed))
    return {number: motions.answer(i, leg) for i, (number, leg) in enumerate(legs.items())}


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
        self.evolution, self.times, self.t = evolution, times, comparison_times(times, evolution.watch)
        self.turns = (self.t - times[0]) / evolution.turn
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


def comparison_times(times: Array, watch: Array = _NONE) -> Array:
    """Return the times at which two runs are compared: the requested times (n,), the times of `watch` between them, and
    samples, more of them near the start. A sample next to a requested time is left out."""
    begin, end = times[0], times[-1]
    samples = np.linspace(begin, end, _SAMPLES)[1:-1]
    after = np.searchsorted(times, samples)
    if len(times) > 1:
        samples = samples[np.minimum(times[after] - samples, samples - times[after - 1]) > _BESIDE * (end - begin)]
    t = np.union1d(np.union1d(times, samples if end > begin else _NONE), watch[(watch > begin) & (watch < end)])
    return np.union1d(t, np.linspace(begin, t[min(1, len(t) - 1)], _PARTS + 1))


def perturbed_state(y0: Array, epsilons: float | Array = 1.0) -> Array:
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
    unavoidable = float(unavoidable_error(turns))
    if unavoidable > UNKNOWN:
        raise IntegrationError(
            f"the run has {turns:.1e} turns, over which rounding errors exceed the states: take a shorter run"
        )
    if _LEAST_A_TURN * turns > MOST_EVALUATIONS:
        raise IntegrationError(
            f"the run has {turns:.1e} turns and takes at least {scientific(_LEAST_A_TURN * turns, 1)} evaluations, more than "
            f"{scientific(MOST_EVALUATIONS)}: take a shorter run or a larger tol"
        )
    local = float(first_local_error(turns, tol))
    best = pair = yield from _compare(course, local, True)
    final = evolution.has_other_coordinates
    while pair.refusal and not (final or local > GIVEN_UP.value or _at_singular(pair.refusal)):
        again = pair.loose.stop is None  # then the looser integration is compared with one looser still
        local *= APART.value if again else APART.value**2
        pair = yield from _compare(course, local, pair.loose.companion ^ again)
        best = min(pair, best, key=lambda candidate: candidate.merit)
    pair = best
    while unavoidable <= tol < pair.error and not pair.refusal and not _hopeless(course, pair):
        third, next_local = next_local_error(pair.loose.local, pair.tight.local, pair.error, tol)
        local, companion = float(next_local), pair.tight.companion if third else True
        if local / APART.value <= 1.1 * course.refused or local >= pair.loose.local:
            break
        pair = yield from _compare(course, local, companion)
        best = min(pair, best, key=lambda candidate: candidate.merit)
    refusal = best.refusal
    if refusal and not (isinstance(refusal, StopError) and len(best.errors) > 1):
        refusal.evaluations = course.evaluations
        raise refusal
    return _estimated(course, best, tol)


def unavoidable_error(turns: Array | float) -> Array:
    """Return the error that rounding causes in a run of some turns, (…)."""
    return np.asarray(ROUNDING.value * (START.value + turns))


def first_local_error(turns: Array | float, tol: float) -> Array:
    """Return the local error of the first companion of a run of some turns, (…), for the tolerance of the run."""
    shortness = 10 / np.maximum(turns, 10 / SHORTEST.value)
    wanted = tol * FIRST.value * np.maximum(1.0, shortness)
    return np.maximum(np.minimum(wanted, LOOSEST.value), APART.value * TIGHTEST)


def next_local_error(
    loose: Array | float, tight: Array | float, error: Array | float, tol: float
) -> tuple[NDArray[np.bool_], Array]:
    """Return how pairs (…) continue that have a larger error than `tol`: True if the tighter integration is compared with a third
    one, and the local error of the looser integration of the next pair."""
    third = (error / APART.value <= tol / 2) & (np.asarray(tight) >= APART.value * TIGHTEST)
    required = np.maximum(np.minimum(tight, loose * tol / error / 2), APART.value * TIGHTEST)
    return third, np.where(third, tight, required)


def is_feasible(turns: Array) -> NDArray[np.bool_]:
    """Return True for the numbers of turns (…) of runs that are short enough to be integrated."""
    return (unavoidable_error(turns) <= UNKNOWN) & (_LEAST_A_TURN * turns <= MOST_EVALUATIONS)


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
    conserved = evolution.conservation_error
    violations = [conserved(t, one) for one in observed] if conserved and finite else []
    found = compare_runs(
        t, evolution.turn, tight.local, distance, violations, uncertainty, together, concave=not evolution.sudden
    )
    grown, errors = found.grown, found.errors
    refusal: IntegrationError | None = stop
    if not (stop and evolution.has_other_coordinates):
        way_out = "take other coordinates or a smaller tol" if evolution.has_other_coordinates else "take a smaller tol"
        apart = 0.0
        if evolution.difference and together.any():
            if not together.all():
                observed = [evolution.observe(states[together]) for states in (looser, better)]
            apart = evolution.difference(*observed)
        if not finite:
            refusal = IntegrationError(f"a value is not finite: {way_out}")
        elif not conserves(found, apart):
            refusal = IntegrationError(
                f"the conserved quantities change by as much as for an error of {found.violation:.1e}, although "
                f"{max(found.unshared, apart):.1e} is estimated: the run followed another motion; {way_out}"
            )
    return _Pair(loose, tight, np.where(together, grown, np.maximum(errors, grown)), float(found.lost), refusal)


class Comparison(NamedTuple):
    """The errors of the tighter one of two integrations of each run, (…, m) at the times of comparison.

    - `errors`: the error at each time; `grown`: the largest error up to each time.
    - `lost`: the time from which on the states are unknown, (…); inf if there is none.
    - `unshared`: the largest error, (…), without an error that both integrations share.
    - `violation`: the largest change of the conserved quantities, (…), as the error that would cause it.
    """

    errors: Array
    grown: Array
    lost: Array
    unshared: Array
    violation: Array


def compare_runs(
    t: Array, turn: float, local: Array | float, distance: Array, violations: Sequence[Array],
    uncertainty: Array | float = 1.0, together: NDArray[np.bool_] | bool = True, concave: bool = True,
) -> Comparison:  # fmt: skip
    """Estimate the errors of one run or of many from two integrations of each.

    The times t (…, m) of comparison and the distances of the two integrations have leading axes for the runs. `local` (…) is the
    local error of the tighter integration, `violations` the changes (…, q) of the conserved quantities in both integrations, and
    `together` False at times at which states are not to be compared. `concave` is that of `errors_up_to`.
    """
    tight = np.asarray(local)[..., None]
    rounding = unavoidable_error((t - t[..., :1]) / turn)
    difference = SAFETY.value ** np.where(tight < RESOLVED.value * uncertainty, 2, 1) * distance
    least = LEAST.value * tight + rounding
    lost = first_times(t, (difference + least > LOST.value) & together)
    factor = np.asarray(_shared_error_factor(violations, rounding[..., -1]))
    errors = factor[..., None] * difference + least
    grown = errors_up_to(t, np.where(together, errors, 0.0), turn, concave)
    violation = _largest(violations[1]) if len(violations) else np.zeros(t.shape[:-1])
    return Comparison(errors, grown, lost, np.maximum(grown[..., -1] / factor, local), violation)


def conserves(found: Comparison, apart: Array | float) -> NDArray[np.bool_]:
    """Return True for the runs (…) whose conserved quantities change by no more than the estimated error explains. `apart` (…) is
    the difference of the two integrations in all conserved quantities."""
    return np.asarray(~(found.violation > KEPT.value * np.maximum(found.unshared, apart)))


def _shared_error_factor(defects: Sequence[Array], rounding: Array) -> Array:
    """Return the factor, at least 1, by which the estimate must grow because both runs share an error that their difference
    hides. It follows from the conserved quantities (…, q) of both runs, unless their change is mostly rounding. SAFETY covers an
    error of the better run up to half the difference."""
    if not len(defects):
        return np.ones(rounding.shape)
    largest, apart = _largest(defects[1]), np.maximum(_largest(defects[1] - defects[0]), rounding)
    return np.where(largest < 10 * rounding, 1.0, np.maximum(1.0, 2 * largest / apart))


def _largest(values: Array) -> Array:
    return np.asarray(np.abs(values).max(axis=-1, initial=0.0))


def errors_up_to(t: Array, errors: Array, turn: float, concave: bool = True) -> Array:
    """Return the largest error up to each time t (…, m), shape (…, m), for motions with the typical period `turn` in s. Two runs
    that separate may cross, so the maximum extends to SWING periods later. Errors grow as a power of time or as e^(λt),
    so their logarithm is concave, although two runs may be close by chance. The result is therefore the least concave curve above
    the logarithm, unless `concave` is False: that changes no error at the first and the last time."""
    m = t.shape[-1]
    times, grown = t.reshape(-1, m), np.maximum.accumulate(errors, axis=-1).reshape(-1, m)
    for x, later, row in zip(times, times[:, 1:] + SWING.value * turn, grown, strict=True):
        row[1:] = row[x.searchsorted(later, "right") - 1]
        if concave and row[0] > 0 and np.isfinite(row[-1]):
            np.maximum(row, np.exp(_concave_above(x, np.log(row))), out=row)
    return grown.reshape(errors.shape)


def _concave_above(t: Array, values: Array) -> Array:
    """Return the least concave curve above values (m,) that do not decrease, at the times t (m,)."""
    steps = np.flatnonzero(values[1:] > values[:-1]) + 1
    ends = np.concatenate([[0], steps, [len(t) - 1]])
    corners = list[tuple[float, float]]()
    for x, y in zip(t[ends].tolist(), values[ends].tolist(), strict=True):
        while len(corners) > 1:
            (a, b), (c, d) = corners[-2:]
            if (d - b) * (x - a) > (y - b) * (c - a):
                break
            corners.pop()
        corners.append((x, y))
    at, logs = np.array(corners).T
    return np.interp(t, at, logs)


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


def first_times(t: Array, where: NDArray[np.bool_]) -> Array:
    """Return the first of the times (…, m) at which `where` is true, (…); inf if there is none."""
    first = np.take_along_axis(t, np.argmax(where, axis=-1, keepdims=True), axis=-1)[..., 0]
    return np.where(where.any(axis=-1), first, inf)


def first_time(t: Array, where: NDArray[np.bool_]) -> float:
    """Return the first of the times (n,) at which `where` is true; inf if there is none."""
    return float(first_times(t, where))


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
