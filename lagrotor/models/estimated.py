"""Runs with an estimated error: two integrations at different tolerances, held to what the motion conserves.

The difference of the two bounds the error of the better one. It is also how far neighbouring motions part: where it exceeds
what was promised, the run has reached its horizon.
"""

from dataclasses import dataclass, replace
from math import inf, log

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError
from lagrotor.models.conserved import PulseNodes, conservation_defect, pulse_nodes
from lagrotor.models.estimate_constants import APART, CLEARLY, FIRST, GIVEN_UP, KEPT, LOOSEST, LOST, ROUNDING
from lagrotor.models.integrated import integrated
from lagrotor.models.model import Array, Model, Observed
from lagrotor.models.natural_units import PACE
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.segment import StopError
from lagrotor.numerics.solver_constants import CROSSOVER
from lagrotor.pair.scene import Scene

_SAMPLES = 65  # times at which a run is watched besides those it is read at


@dataclass(frozen=True, eq=False)
class Estimated:
    """A run at its times: the largest error of an axis up to each of them (n,), the horizon, evaluations of all its runs.

    tol: the local error of the better run. lost: when the estimate exceeds LOST.
    """

    seen: Observed
    errors: Array
    horizon: float
    nfev: int
    tol: float
    lost: float = inf


@dataclass(frozen=True, eq=False)
class _Watched:
    """A model on a scene in natural units, and the times at which it is watched; `read` marks those of the user."""

    model: Model
    scene: Scene
    t: Array
    read: NDArray[np.intp]
    nodes: PulseNodes | None
    engine: str
    bounded: bool

    def run(self, tol: float, companion: bool = False) -> tuple[Observed, int]:
        found = integrated(self.model, self.scene, self.t, tol, self.engine, self.bounded, companion)
        return found.seen, found.nfev


def _watched(model: Model, scene: Scene, times: Array, engine: str, bounded: bool) -> _Watched:
    t_end = float(times[-1])
    nodes = pulse_nodes(scene, t_end)
    t = np.union1d(times, np.linspace(0.0, t_end, _SAMPLES))
    if nodes:
        t = np.union1d(t, nodes.t)
    return _Watched(model, scene, t, np.searchsorted(t, times), nodes, engine, bounded)


def run_at(model: Model, scene: Scene, times: Array, tol: float, engine: str, promised: float) -> Estimated:
    """The model at a local error `tol`, its error estimated by a run at another; scene in natural units.

    The horizon is where the estimate exceeds `promised`. Raises what `integrated` does, and IntegrationError where the run
    does not conserve what it must.
    """
    watched = _watched(model, scene, times, engine, False)
    other = tol * APART if tol * APART <= LOOSEST else tol / APART
    run = _single(watched, tol, False)
    try:
        companion = _single(watched, other, True, run.nfev)
    except StopError:
        companion = _single(watched, max(tol / APART, TIGHTEST), True, run.nfev)
    return _estimated(watched, companion, run, promised)


@dataclass(frozen=True, eq=False)
class _Single:
    """One integration: its tolerance, what it gives, whether its start is off by rounding, evaluations of it and before it."""

    tol: float
    seen: Observed
    companion: bool
    nfev: int


def run_within(model: Model, scene: Scene, times: Array, wanted: float, engine: str, bounded: bool) -> Estimated:
    """The model at tolerances that keep the axes within `wanted` as the estimate has it, else the best there is.

    Each run is compared with the one before it, at APART times the tolerance. Where the two differ by more than `wanted`, a
    third is enough if the tolerance of the second gives it in proportion; else a pair follows at the tolerances that do.
    Scene in natural units. Raises as `run_at`.
    """
    watched = _watched(model, scene, times, engine, bounded)
    first = max(min(wanted * FIRST, LOOSEST), CLEARLY * TIGHTEST)
    loose, tight, found = _loosest(watched, first, wanted)
    best, t_end = found, float(watched.t[-1])
    while tight.tol <= _tighter(first, engine) and tight.tol >= CLEARLY * TIGHTEST:
        error = float(found.errors[-1])
        if error <= wanted or _hopeless(found, loose.tol, t_end):
            break
        in_proportion = error * tight.tol / loose.tol <= wanted / 2
        tol = max(min(tight.tol, loose.tol * wanted / error / 2), CLEARLY * TIGHTEST)
        try:
            loose = tight if in_proportion else _single(watched, tol, True, tight.nfev)
            tight = _single(watched, _tighter(loose.tol, engine), not loose.companion, max(tight.nfev, loose.nfev))
            found = _estimated(watched, loose, tight, wanted)
        except IntegrationError:
            break
        best = found if found.errors[-1] < best.errors[-1] else replace(best, nfev=found.nfev)
    return best


def _single(watched: _Watched, tol: float, companion: bool, nfev: int = 0) -> _Single:
    seen, spent = watched.run(tol, companion)
    return _Single(tol, seen, companion, nfev + spent)


def _loosest(watched: _Watched, tol: float, wanted: float) -> tuple[_Single, _Single, Estimated]:
    """The first pair of runs that is not refused, from the companion's tolerance `tol` on to looser ones up to GIVEN_UP."""
    loose: _Single | None = None
    tight: _Single | None = None
    nfev = 0
    while True:
        try:
            loose = loose or _single(watched, tol, tight is None or not tight.companion, nfev)
            tight = tight or _single(watched, _tighter(tol, watched.engine), not loose.companion, loose.nfev)
            return loose, tight, _estimated(watched, loose, tight, wanted)
        except IntegrationError:
            if watched.bounded or tol > GIVEN_UP:
                raise
        # A run that was not refused is compared with a looser one.
        nfev = max((run.nfev for run in (loose, tight) if run), default=nfev)
        loose, tight, tol = None, loose, tol * APART if loose else tol * APART**2


def _tighter(loose: float, engine: str) -> float:
    """The tolerance of the better run; not beyond where the core's solvers become slow, if it is clearly tighter there."""
    tight = max(loose / APART, TIGHTEST)
    return max(tight, CROSSOVER) if engine == "core" and loose >= CLEARLY * CROSSOVER else tight


def _estimated(watched: _Watched, companion: _Single, run: _Single, promised: float) -> Estimated:
    """The run, its error estimated by how far its companion is off; refused if it does not conserve what it must."""
    loose, tight, tol, nfev = companion.seen, run.seen, run.tol, max(run.nfev, companion.nfev)
    t, apart = watched.t, np.linalg.norm(loose.axes - tight.axes, axis=-1).max(axis=0)
    errors = np.maximum.accumulate(apart) + ROUNDING * (1 + PACE * t / (2 * np.pi))
    error = float(errors[-1])
    if not np.isfinite(error):
        raise IntegrationError(f"{watched.model.name}: a value is not finite; use another model")
    defect = conservation_defect(watched.scene, t, tight, watched.nodes)
    if not defect <= KEPT * max(error, tol, float(np.abs(loose.rates - tight.rates).max()) / PACE):
        raise IntegrationError(
            f"{watched.model.name}: energy, momentum or the bar's length is off by as much as an error of {defect:.1e} "
            f"makes, although {error:.1e} is estimated: the run followed another motion; use another model or a smaller tol"
        )
    read = watched.read
    seen = Observed(tight.axes[:, read], tight.rates[:, read], tight.momenta[:, read])
    return Estimated(seen, errors[read], _first(t, errors > promised), nfev, tol, _first(t, errors > LOST))


def _first(t: Array, where: NDArray[np.bool_]) -> float:
    return float(t[np.argmax(where)]) if where.any() else inf


def _hopeless(found: Estimated, loose: float, t_end: float) -> bool:
    """Whether neighbours part so fast that no tolerance keeps LOST to the end: a difference loose e^(λt) has λ from `lost`."""
    return found.lost * log(LOST / TIGHTEST) < t_end * log(LOST / loose)
