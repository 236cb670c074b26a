"""Runs with an estimated error: two integrations at different tolerances, held to what the motion conserves.

Twice the difference of the two is taken for the error of the better one, four times where rounding may be most of it. It is
also how far neighbouring motions part: where it exceeds what was promised, the run has reached its horizon.
Where it exceeds LOST, nothing is known any more: there the comparison ends, and the better run goes on alone.
"""

from dataclasses import dataclass, replace
from math import inf, log, pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError
from lagrotor.models.conserved import conservation_defect
from lagrotor.models.estimate_constants import (
    APART,
    BEYOND,
    CLEARLY,
    FIRST,
    GIVEN_UP,
    KEPT,
    LEAST,
    LOOSEST,
    LOST,
    OPPOSITE,
    RESOLVED,
    ROUNDING,
    SAFETY,
    SHORTEST,
)
from lagrotor.models.integrated import Patience
from lagrotor.models.model import Array, Model, Observed
from lagrotor.models.natural_units import PACE
from lagrotor.models.staged import StagedRun, Watched, joined, run_of, seen_in, watch
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.segment import StopError
from lagrotor.numerics.solver_constants import CROSSOVER
from lagrotor.pair.scene import Scene

_PATIENCE = Patience(1_000, 500)  # of a run that a looser one may replace: five times as many serve no scene better


@dataclass(frozen=True, eq=False)
class Estimated:
    """A run at its times: the largest error of an axis up to each of them (n,), the horizon, evaluations of all its runs.

    tol: the local error of the better run. loosened: the time from which nothing is known of it and it goes on at BEYOND.
    """

    seen: Observed
    errors: Array
    horizon: float
    nfev: int
    tol: float
    loosened: float


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two runs compared in the first `stages`: errors (n,) by how much they part up to each time, lost: when beyond LOST."""

    loose: StagedRun
    tight: StagedRun
    stages: int
    errors: Array
    lost: float

    @property
    def error(self) -> float:
        return OPPOSITE if self.lost < inf else float(self.errors[-1])


def run_at(model: Model, scene: Scene, times: Array, tol: float, engine: str, promised: float) -> Estimated:
    """The model at a local error `tol`, its error estimated by a run at another; scene in natural units.

    The horizon is where the estimate exceeds `promised`. Raises what `integrated` does, and IntegrationError where the run
    does not conserve what it must.
    """
    watched = watch(model, scene, times, engine)
    other = tol * APART if tol * APART <= LOOSEST else tol / APART
    run = StagedRun(tol, False)
    seen_in(watched, run, len(watched.stages) - 1)
    try:
        pair = _compared(watched, StagedRun(other, True), run)
    except StopError:
        pair = _compared(watched, StagedRun(max(tol / APART, TIGHTEST), True), run)
    return _estimated(watched, pair, run, promised)


def run_within(model: Model, scene: Scene, times: Array, wanted: float, engine: str, bounded: bool) -> Estimated:
    """The model at tolerances that keep the axes within `wanted` as the estimate has it, else the best there is.

    Each run is compared with the one before it, at APART times the tolerance. Where the two differ by more than `wanted`, a
    third is enough if the tolerance of the second gives it in proportion; else a pair follows at the tolerances that do.
    From where no tolerance keeps two runs together, the best goes on at BEYOND.
    Scene in natural units. Raises as `run_at`.
    """
    watched = watch(model, scene, times, engine, bounded, _PATIENCE)
    try:
        best = _best(watched, _first_tolerance(wanted, float(times[-1])), wanted)
        return _estimated(watched, best, _finished(watched, best), wanted)
    except IntegrationError as refusal:
        refusal.nfev = sum(watched.spent)
        raise


def _first_tolerance(wanted: float, t_end: float) -> float:
    """Local error of the first companion: the larger, the shorter the run, in which it gathers to less."""
    turns = max(PACE * t_end / (2 * pi), 10 / SHORTEST)
    return max(min(wanted * FIRST * max(1.0, 10 / turns), LOOSEST), CLEARLY * TIGHTEST)


def _best(watched: Watched, first: float, wanted: float) -> _Pair:
    """The pair of which the estimate is `wanted` or, of those from the companion's tolerance `first` on, smallest."""
    best = pair = _loosest(watched, first)
    while pair.error > wanted and not _hopeless(watched, pair):
        following = _following(watched, pair, wanted)
        if following is None:
            break
        pair = following
        best = min(pair, best, key=lambda one: (one.error, -one.lost))
    return best


def _following(watched: Watched, pair: _Pair, wanted: float) -> _Pair | None:
    """A pair at the tolerances that give `wanted` in proportion; where a run is refused there, one with the next tighter."""
    if pair.tight.tol < CLEARLY * TIGHTEST:
        return None
    tol = max(min(pair.tight.tol, pair.loose.tol * wanted / pair.error / 2), CLEARLY * TIGHTEST)
    third = pair.error * pair.tight.tol / pair.loose.tol <= wanted / 2
    for loose in (pair.tight,) if third else (run_of(watched, tol, True), pair.tight):
        tight = run_of(watched, _tighter(loose.tol, watched.engine), not loose.companion)
        if tight.tol > max(watched.refused, default=0.0):
            try:
                return _compared(watched, loose, tight)
            except IntegrationError:
                continue
    return None


def _loosest(watched: Watched, tol: float) -> _Pair:
    """The first pair of runs that is not refused, from the companion's tolerance `tol` on to looser ones up to GIVEN_UP."""
    tight: StagedRun | None = None
    while True:
        loose = run_of(watched, tol, tight is None or not tight.companion)
        tight = tight or run_of(watched, _tighter(tol, watched.engine), not loose.companion)
        try:
            return _compared(watched, loose, tight)
        except IntegrationError as refusal:
            if watched.bounded or tol > GIVEN_UP:
                raise
            # A run that was not refused is compared with a looser one.
            stopped = isinstance(refusal, StopError) and len(loose.stages) <= len(tight.stages)
            tight, tol = (None, tol * APART**2) if stopped else (loose, tol * APART)


def _tighter(loose: float, engine: str) -> float:
    """The tolerance of the better run; not beyond where the core's solvers become slow, if it is clearly tighter there."""
    tight = max(loose / APART, TIGHTEST)
    return max(tight, CROSSOVER) if engine == "core" and loose >= CLEARLY * CROSSOVER else tight


def _compared(watched: Watched, loose: StagedRun, tight: StagedRun) -> _Pair:
    """The two runs up to the stage in which they part; refused if the better one does not conserve what it must."""
    parts, faster, lost = list[Array](), 0.0, inf
    for n, t in enumerate(watched.stages):
        one, other = seen_in(watched, loose, n), seen_in(watched, tight, n, loose)
        apart = SAFETY * np.linalg.norm(one.axes - other.axes, axis=-1).max(axis=0)
        if watched.refused or tight.tol < RESOLVED:  # rounding may be nearly all that both resolve
            apart = SAFETY * apart
        parts.append(np.maximum(apart, LEAST * tight.tol) + ROUNDING * (1 + PACE * t / (2 * pi)))
        faster = max(faster, float(np.abs(one.rates - other.rates).max()))
        lost = _first(t, parts[-1] > LOST)
        if lost < inf:
            break
    errors = np.maximum.accumulate(np.concatenate(parts))
    _check_conserved(watched, tight, len(parts), max(float(errors[-1]), tight.tol, faster / PACE))
    return _Pair(loose, tight, len(parts), errors, lost)


def _check_conserved(watched: Watched, run: StagedRun, stages: int, error: float) -> None:
    """Raises IntegrationError unless the first stages of a run conserve what they must, as well as its error allows."""
    if not np.isfinite(error):
        raise IntegrationError(f"{watched.model.name}: a value is not finite; use another model")
    t, nodes = np.concatenate(watched.stages[:stages]), watched.nodes
    scene = replace(watched.scene, shock=watched.scene.shock_until(float(t[-1])))
    whole = nodes if nodes and nodes.t[-1] <= t[-1] else None
    defect = conservation_defect(scene, t, joined(run.stages[:stages]), whole)
    if not defect <= KEPT * error:
        raise IntegrationError(
            f"{watched.model.name}: energy, momentum or the bar's length is off by as much as an error of {defect:.1e} "
            f"makes, although {error:.1e} is estimated: the run followed another motion; use another model or a smaller tol"
        )


def _finished(watched: Watched, pair: _Pair) -> StagedRun:
    """The better run of a pair to the end: after the stage in which they part at BEYOND, at its own tolerance if that stops."""
    last, known = len(watched.stages) - 1, pair.tight.stages[: pair.stages]
    if pair.stages > last:
        return pair.tight
    for tol in (max(BEYOND, pair.tight.tol), pair.tight.tol):
        run = replace(pair.tight, tol=tol, stages=list(known))
        try:
            seen_in(watched, run, last)
            return run
        except StopError:
            if tol == pair.tight.tol:
                raise
    raise AssertionError("the last tolerance returns or raises")


def _estimated(watched: Watched, pair: _Pair, run: StagedRun, promised: float) -> Estimated:
    """A whole run and what is known of its error."""
    t = np.concatenate(watched.stages)
    errors = np.full(len(t), OPPOSITE)
    errors[: len(pair.errors)] = pair.errors
    errors[t >= pair.lost] = OPPOSITE
    seen, read = joined(run.stages), watched.read
    seen = Observed(seen.axes[:, read], seen.rates[:, read], seen.momenta[:, read])
    loosened = float(watched.stages[pair.stages - 1][-1]) if run.tol > pair.tight.tol else inf
    return Estimated(seen, errors[read], _first(t, errors > promised), sum(watched.spent), pair.tight.tol, loosened)


def _first(t: Array, where: NDArray[np.bool_]) -> float:
    return float(t[np.argmax(where)]) if where.any() else inf


def _hopeless(watched: Watched, pair: _Pair) -> bool:
    """Whether two runs parted so fast that no tolerance keeps LOST to the end.

    Their difference grew from the looser tolerance to LOST at `lost`, half the way by `early` (in logarithms): by e^(λt), or
    by a power of t. A tighter tolerance comes as far as the more hopeful of the two says.
    """
    grown, tighter = log(LOST / pair.loose.tol), log(pair.loose.tol / TIGHTEST)
    if pair.lost == inf or grown <= 0:
        return False
    t = np.concatenate(watched.stages[: pair.stages])
    early = max(_first(t, pair.errors > (LOST * pair.loose.tol) ** 0.5), float(t[1]))
    by_power = (pair.lost / early) ** (tighter / (grown / 2))
    return pair.lost * max(1 + tighter / grown, by_power) < watched.t_end
