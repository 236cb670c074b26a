"""What every motion of the pair keeps: energy less the shock's work, momentum about the joint line, bar and axes' lengths.

A run that does not keep them within what its error estimate allows is not the pair's motion, whatever the solver says.
"""

from dataclasses import dataclass
from math import inf

import numpy as np

from lagrotor.models.model import Array, Observed
from lagrotor.models.natural_units import PACE
from lagrotor.pair.scene import Scene

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_MOST_PANELS = 2_000  # beyond, the work of a broad pulse is not followed


def _lower_order() -> Array:
    """Weights (12,) that integrate polynomials up to the ninth degree, the two nodes in the middle left out."""
    kept = np.r_[0:5, 7:12]
    moments = [(1 - (-1) ** (n + 1)) / (n + 1) for n in range(10)]
    weights = np.zeros(12)
    weights[kept] = np.linalg.solve(np.vander(_NODES[kept], increasing=True).T, moments)
    return weights


@dataclass(frozen=True, eq=False)
class PulseNodes:
    """Gauss–Legendre nodes t (n,) and weights (n,) over the part of the pulse between `begin` and `end` (s).

    lower (n,): weights of lower order; the difference of the two sums bounds the error of the first.
    """

    t: Array
    weights: Array
    lower: Array
    begin: float
    end: float


def pulse_nodes(scene: Scene, t_end: float) -> PulseNodes | None:
    """Nodes for the shock's work on a scene in natural units; none without shock, or for a pulse of too many turns."""
    if scene.shock is None:
        return None
    begin, end = max(0.0, scene.shock.begin), min(t_end, scene.shock.end)
    count = int(np.ceil((end - begin) / min(scene.shock.width, 1 / PACE)))
    if not 0 < count <= _MOST_PANELS:
        return None
    edges = np.linspace(begin, end, count + 1)
    half = np.diff(edges)[:, None] / 2
    t = (edges[:-1, None] + half * (1 + _NODES)).ravel()
    return PulseNodes(t, (half * _WEIGHTS).ravel(), (half * _lower_order()).ravel(), begin, end)


@dataclass(frozen=True, eq=False)
class Conserved:
    """Energy T (n,) of the tilting and momentum P (n,) about the joint line, and how much an error of 1 in the axes, and
    of PACE in the rates, may change each."""

    energy: Array
    momentum: Array
    energy_scale: float
    momentum_scale: float


def _conserved(scene: Scene, seen: Observed) -> Conserved:
    a, b = scene.inertias
    (r1, r2), (v1, v2) = seen.axes, seen.rates
    p1, p2 = a * v1 + b * v2, a * v2 + b * v1
    energy = ((p1 * v1).sum(-1) + (p2 * v2).sum(-1)) / 2
    turning = np.cross(r1, p1)[:, 0] + np.cross(r2, p2)[:, 0] + seen.momenta[0] * r1[:, 0] + seen.momenta[1] * r2[:, 0]
    size = float(np.sqrt((p1**2 + p2**2).sum(-1)).max())
    return Conserved(energy, turning, PACE * size, size + 2 * PACE * a + float(np.abs(seen.momenta).max()))


def conservation_defect(scene: Scene, t: Array, seen: Observed, nodes: PulseNodes | None) -> float:
    """The error of axes and rates that would explain how far a run at times t (n,) is from conserving what it must.

    The scene is in natural units; `nodes`, where there is a shock, are among the times. Without them its work is not known, and
    what comes after it is held to the first state after it.
    """
    found = _conserved(scene, seen)
    lengths = [np.linalg.norm(seen.axes, axis=-1) - 1]
    if scene.link:
        k = scene.link.length / scene.rotor.length
        bar = seen.axes[1] - seen.axes[0] + np.array([k, 0.0, 0.0])
        lengths.append((np.linalg.norm(bar, axis=-1) - k) * min(1.0, k))
    defects = [float(np.abs(part).max()) for part in lengths]
    before, after = np.ones(len(t), bool), np.zeros(len(t), bool)
    work, turn = (0.0, 0.0), (0.0, 0.0)
    if scene.shock:
        before, after = t <= max(scene.shock.begin, t[0]), t >= min(scene.shock.end, nodes.end if nodes else inf)
    if nodes:
        work, turn = _received(scene, t, seen, nodes)
    for values, (received, unsure), scale in (
        (found.energy, work, found.energy_scale),
        (found.momentum, turn, found.momentum_scale),
    ):
        if scale > 0:
            off = np.abs(values[before] - values[0])
            later = values[after] - (values[0] + received if nodes else values[after][:1])
            defects += [float(part.max(initial=0.0)) / scale for part in (off, np.abs(later) - unsure)]
    return max(defects)


def _received(
    scene: Scene, t: Array, seen: Observed, nodes: PulseNodes
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Work and angular impulse of the pulse, each with a bound on the error of its quadrature."""
    assert scene.shock is not None
    at = np.searchsorted(t, nodes.t)
    i = scene.shock.body - 1
    r, v = seen.axes[i, at], seen.rates[i, at]
    pulse = np.exp(-(((nodes.t - scene.shock.at) / scene.shock.width) ** 2))
    torque = scene.rotor.length * np.array(scene.shock.force)
    power, turning = pulse * (v @ torque), pulse * np.cross(r, torque)[:, 0]

    def total(values: Array) -> tuple[float, float]:
        whole = float(nodes.weights @ values)
        return whole, abs(whole - float(nodes.lower @ values))

    return total(power), total(turning)
