"""Scenes of one kind side by side: the minimal model on arrays, every trajectory with its own step."""

from collections.abc import Sequence
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError
from lagrotor.models.minimal import MODEL, Kind, program, rhs_on_arrays
from lagrotor.models.simulate import simulate
from lagrotor.models.sweeps.batch_dop853 import Index, Rates, Swarm, march
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
MODELS = ("minimal", "spheres", "none")


class Chunk(NamedTuple):
    """axes, rates (n, 2, m, 3), evaluations (n,), models (n,) of part of an ensemble."""

    axes: Array
    rates: Array
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]


def run_chunk(scenes: Sequence[Scene], times: Array, tol: float, engine: str) -> Chunk:
    """The work of one process: a few thousand scenes at once by `minimal`, those that it cannot hold by `spheres`."""
    n, shape = len(scenes), (len(scenes), 2, len(times), 3)
    found = Chunk(np.full(shape, np.nan), np.full(shape, np.nan), np.zeros(n, np.int64), np.full(n, 2))
    groups: dict[Kind | None, list[int]] = {}
    for i, scene in enumerate(scenes):
        groups.setdefault(kind_of(scene), []).append(i)
    for kind, group in groups.items():
        if kind is not None:
            _by_minimal(kind, [scenes[i] for i in group], np.array(group), times, tol, engine, found)
    for i in np.flatnonzero(found.models == MODELS.index("none")).tolist():
        # Beside a singular position any error grows a millionfold: the solver gives all it has.
        try:
            run = simulate(scenes[i], times, "spheres", TIGHTEST if scenes[i].link else tol)
        except IntegrationError:
            continue
        found.axes[i], found.rates[i], found.models[i] = run.axes, run.rates, MODELS.index("spheres")
        found.evaluations[i] += run.evaluations
    return found


def kind_of(scene: Scene) -> Kind | None:
    """Which program runs the scene; None where the minimal model has no coordinates for it."""
    if scene.link is None or max(abs(r[0]) for r in scene.axes) > 1 - 1e-12:
        return None
    k = scene.link.length / scene.rotor.length
    return (
        scene.inertias[1] != 0,
        "equal" if k == 1 else "short" if k < 1 else "long",
        scene.shock.body if scene.shock else 0,
    )


def _by_minimal(
    kind: Kind, scenes: list[Scene], places: Index, times: Array, tol: float, engine: str, found: Chunk
) -> None:
    """Run scenes of one kind side by side and put what comes out whole into its places."""
    ratios = np.array([scene.link.length / scene.rotor.length for scene in scenes if scene.link])
    columns, start = _columns(kind, scenes, ratios), np.array([MODEL.start(scene) for scene in scenes]).T.copy()
    if engine == "fast":
        from lagrotor.numerics.taylor import march_taylor

        states, spent = march_taylor(program(*kind), start, np.array(columns), times, tol)
    else:
        states, spent = march(_swarm(kind, scenes, columns, start), times, tol)
    found.evaluations[places] = spent
    whole = np.isfinite(states).all((1, 2))
    found.models[places[whole]] = MODELS.index("minimal")
    for k in np.unique(ratios):
        alike = np.flatnonzero(whole & (ratios == k))
        if len(alike):
            seen = MODEL.observe(scenes[alike[0]], states[alike].reshape(-1, 6))
            for name, part in (("axes", seen.axes), ("rates", seen.rates)):
                rows = part.reshape(2, len(alike), len(times), 3).swapaxes(0, 1)
                getattr(found, name)[places[alike]] = rows


def _columns(kind: Kind, scenes: list[Scene], ratios: Array) -> list[Array]:
    """The program's parameters but for the force, each for all scenes (n,)."""
    massive, ratio, _ = kind
    inertias = np.array([scene.inertias for scene in scenes])
    momenta = np.array([scene.momenta for scene in scenes])
    columns = [inertias[:, 0], *([inertias[:, 1]] if massive else []), *([] if ratio == "equal" else [ratios])]
    return [*columns, momenta[:, 0], momenta[:, 1]]


def _swarm(kind: Kind, scenes: list[Scene], columns: list[Array], start: Array) -> Swarm:
    """The scenes of one kind as arrays."""
    body, function = kind[2], rhs_on_arrays(*kind)
    at, width, force = np.zeros(len(scenes)), np.zeros(len(scenes)), np.zeros((3, len(scenes)))
    if body:
        shocks = [(scene.shock, scene.rotor.length) for scene in scenes if scene.shock]
        at, width = np.array([s.at for s, _ in shocks]), np.array([s.width for s, _ in shocks])
        force = np.array([[R * f for f in s.force] for s, R in shocks]).T

    def rates(who: Index) -> Rates:
        # What all share goes in as a number: numbers among themselves cost nothing beside arrays.
        given = [float(c[0]) if (c == c[0]).all() else c[who] for c in columns]
        push, broad = force[:, who], width[who]

        def into(s: Array, y: Array, out: Array) -> None:
            pulse = push * np.exp(-((s / broad) ** 2)) if body else ()
            for row, values in zip(out, function(*y, *given, *pulse), strict=True):
                row[:] = values

        return into

    fastest = np.array([_fastest(scene) for scene in scenes])
    return Swarm(rates, start, fastest, at, width)


def _fastest(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: spins, start and shock against the tilting inertia."""
    shock = hypot(*scene.shock.impulse) * scene.rotor.length if scene.shock else 0.0
    spin = abs(scene.momenta[0]) + abs(scene.momenta[1])
    return 1 + (spin + shock) / scene.rotor.J + hypot(*scene.rates[0]) + hypot(*scene.rates[1])
