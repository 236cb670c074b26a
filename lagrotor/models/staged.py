"""A model's run in stages: each integrated once, when it is wanted, so that a run may end or go on otherwise between two.

The first stage is STAGE turns, each other one ends at twice the time of the one before it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.conserved import PulseNodes, pulse_nodes
from lagrotor.models.estimate_constants import MORE, STAGE
from lagrotor.models.integrated import BY_NAME, Integrated, Patience, integrated
from lagrotor.models.model import Array, Model, Observed
from lagrotor.models.natural_units import PACE
from lagrotor.numerics.segment import StopError
from lagrotor.pair.scene import Scene

_SAMPLES = 65  # times of a stage at which a run is watched besides those it is read at


@dataclass(frozen=True, eq=False)
class StagedRun:
    """An integration at a local error `tol`, made stage by stage as it is needed; companion: from a start off by rounding."""

    tol: float
    companion: bool
    stages: list[Integrated] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class Watched:
    """A model on a scene in natural units, and the times at which it is watched; `read` marks those of the user.

    stages: the times of each of the parts in which it is integrated. patience: as `integrated` has it. So far: spent, the
    evaluations; refused, the local errors at which a run stopped; runs, those that were begun.
    """

    model: Model
    scene: Scene
    stages: tuple[Array, ...]
    read: NDArray[np.intp]
    nodes: PulseNodes | None
    engine: str
    bounded: bool
    patience: Patience
    spent: list[int] = field(default_factory=list)
    refused: list[float] = field(default_factory=list)
    runs: dict[tuple[float, bool], StagedRun] = field(default_factory=dict)

    @property
    def t_end(self) -> float:
        return float(self.stages[-1][-1])


def watch(
    model: Model, scene: Scene, times: Array, engine: str, bounded: bool = False, patience: Patience = BY_NAME
) -> Watched:
    """The model on a scene in natural units, watched at the user's times (n,) and others, the pulse's nodes among them."""
    t_end = float(times[-1])
    nodes, first = pulse_nodes(scene, t_end), 2 * pi * STAGE / PACE
    doublings = int(max(0.0, np.ceil(np.log2(t_end / first)))) if t_end > 0 else 0
    ends = [0.0, *(first * 2.0**n for n in range(doublings)), t_end]
    t = np.unique(np.concatenate([times, *(np.linspace(a, b, _SAMPLES) for a, b in pairwise(ends))]))
    if nodes:
        t = np.union1d(t, nodes.t)
    stages = np.split(t, np.searchsorted(t, ends[1:-1], side="right"))
    return Watched(model, scene, tuple(stages), np.searchsorted(t, times), nodes, engine, bounded, patience)


def run_of(watched: Watched, tol: float, companion: bool) -> StagedRun:
    """The run at a local error `tol`, with the stages that are known of it."""
    return watched.runs.setdefault((tol, companion), StagedRun(tol, companion))


def seen_in(watched: Watched, run: StagedRun, n: int, beside: StagedRun | None = None) -> Observed:
    """What is observed in stage n of a run, integrated if it is not yet. Raises what `integrated` does.

    beside: a looser run of that stage; it may take MORE times as many evaluations.
    """
    while len(run.stages) <= n:
        i, scene = len(run.stages), watched.scene
        begin, start = (float(watched.stages[i - 1][-1]), run.stages[-1].end) if i else (0.0, None)
        t, shock = watched.stages[i] - begin, scene.shock and replace(scene.shock, at=scene.shock.at - begin)
        scene = replace(scene, shock=shock)
        scene = replace(scene, shock=scene.shock_until(float(t[-1])))
        begun = max(watched.patience.begin, MORE * beside.stages[i].nfev if beside else 0)
        patience = Patience(begun, watched.patience.radian)
        how = (watched.engine, watched.bounded, run.companion, start, patience)
        try:
            found = integrated(_begun(watched.model, begin), scene, t, run.tol, *how)
        except StopError as stopped:
            watched.spent.append(stopped.nfev)
            watched.refused.append(run.tol)
            raise StopError(begin + stopped.at, stopped.reason) from None
        watched.spent.append(found.nfev)
        run.stages.append(found)
    return run.stages[n].seen


def _begun(model: Model, begin: float) -> Model:
    """The model reporting the times of a stage from the start of the run on."""
    report = model.progress
    return model if report is None else replace(model, progress=lambda t: report(begin + t))


def joined(stages: Sequence[Integrated]) -> Observed:
    """What is observed over stages that follow each other."""
    parts = [stage.seen for stage in stages]
    axes, rates = np.concatenate([p.axes for p in parts], axis=1), np.concatenate([p.rates for p in parts], axis=1)
    return Observed(axes, rates, np.concatenate([p.momenta for p in parts], axis=1))
