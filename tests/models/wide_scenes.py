"""Random scenes as wide as the package accepts: what `simulate` promises is tested on them, seeds fixed.

ell/R from 0.2 to 4 and within 1e-14 of 1, bars up to 20 kg or massless or none, inertias over twelve decades, spins from 0
to 10⁴ rad/s in all combinations, starts anywhere and beside the joint line, shocks of any width and time, runs of 10⁻³ to
10⁴ turns, tol 1e-12 to 1e-3.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor import Link, Rotor, Scene, Shock, Trajectory, simulate
from lagrotor.errors import InputError, IntegrationError
from tests.models.oracle import exact_axes, pace

Array = NDArray[np.float64]
SEED, COUNT = 1, 1000  # of the trials whose references are recorded
IN_128_BITS = (50, 192, 777)  # of them, beside a dead point, where 80 bits are off by more than they say


@dataclass(frozen=True)
class Wide:
    """A scene, the times at which it is read (s) and the tolerance."""

    scene: Scene
    t: Array
    tol: float


def wide_scenes(seed: int, count: int, most_turns: float = 1e4) -> list[Wide]:
    """`count` random trials; a scene that `Scene` refuses is drawn again."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        try:
            found.append(_draw(rng, most_turns))
        except InputError:
            continue
    return found


def _draw(rng: np.random.Generator, most_turns: float) -> Wide:
    def power(low: float, high: float) -> float:
        return float(10 ** rng.uniform(low, high))

    R, I1 = power(-0.7, 0.7), power(-6, 6)
    rotor = Rotor(power(-6, 1), R, I1, I1 * power(-2, 0.3))
    k = float(rng.uniform(0.2, 4)) if rng.random() < 0.6 else 1 + float(rng.choice([-1, 0, 1])) * power(-14, -1)
    link = None if rng.random() < 0.05 else Link(k * R)
    if link and rng.random() < 0.7:
        mass = power(-3, np.log10(20))
        link = Link(k * R, mass, 0.0 if rng.random() < 0.3 else mass * (k * R) ** 2 * power(-3, -0.5))
    first, second = (0.0 if rng.random() < 0.15 else float(rng.choice([-1, 1])) * power(-2, 4) for _ in range(2))
    spins = (first, (first, -first, second)[rng.integers(3)])
    axes, rates = _start(rng, k, link is not None)
    pace = rotor.I3 * (abs(spins[0]) + abs(spins[1])) / rotor.J or power(-2, 2)
    rates = rates * (0.0 if rng.random() < 0.2 else pace * power(-4, 0.5))
    turns = power(2, np.log10(most_turns)) if rng.random() < 0.1 and most_turns > 100 else power(-3, 2)
    t_end = 2 * np.pi * turns / (pace + np.linalg.norm(rates))
    shock = None
    if rng.random() < 0.5:
        width = t_end * power(-6, 1)
        push = pace * rotor.J / R / (width * np.sqrt(np.pi)) * power(-4, 0.7)
        shock = Shock(tuple(push * _unit(rng)), t_end * float(rng.uniform(-0.1, 1.1)), width, int(rng.integers(1, 3)))
    scene = Scene(spins, rotor, link, shock, tuple(map(tuple, axes)), tuple(map(tuple, rates)))
    return Wide(scene, t_end * np.array([0.3, 0.7, 1.0]), power(-12, -3))


def _unit(rng: np.random.Generator) -> Array:
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def _start(rng: np.random.Generator, k: float, bar: bool) -> tuple[Array, Array]:
    """Axes on the bar, upright, anywhere or beside the joint line, and rates (2, 3) of length 1 that it allows.

    |k e_x + r_2 − r_1| = k puts r_2 on the circle where the unit sphere meets that of radius k about r_1 − k e_x.
    """
    kind = rng.integers(3)
    r1 = np.array([0.0, 0.0, 1.0]) if kind == 0 else _unit(rng)
    if kind == 2:
        r1 = np.array([rng.choice([-1.0, 1.0]), 0, 0]) + 10 ** rng.uniform(-8, -1) * _unit(rng)
        r1 /= np.linalg.norm(r1)
    r2 = r1 if kind == 0 else _unit(rng)
    if bar and kind:
        centre = r1 - [k, 0, 0]
        away = centre @ centre
        middle = centre * (1 - k * r1[0]) / away
        side = np.linalg.svd(centre[None])[2][1:]
        angle = rng.uniform(0, 2 * np.pi)
        r2 = middle + k * np.sqrt((r1[1] ** 2 + r1[2] ** 2) / away) * (
            np.cos(angle) * side[0] + np.sin(angle) * side[1]
        )
        r2 /= np.linalg.norm(r2)
    line, zero = np.array([k, 0, 0]), np.zeros(3)
    normals = np.array([[*r1, *zero], [*zero, *r2], *([[*(-line - r2), *(line - r1)]] if bar else [])])
    tangents = np.linalg.svd(normals)[2][len(normals) :]
    v = rng.normal(size=len(tangents)) @ tangents
    return np.array([r1, r2]), (v / np.linalg.norm(v)).reshape(2, 3)


def run(trial: Wide, **how: Any) -> Trajectory:
    """`simulate` at the trial's tolerance, at its times. Raises what it does, and IntegrationError for a run that ended early."""
    whole = simulate(trial.scene, [0.0, *trial.t], tol=trial.tol, **how)
    if whole.ending.early:
        raise IntegrationError(str(whole.ending))
    return whole.after(trial.t[0])


def turns(trial: Wide) -> float:
    """Turns of the run, at the scene's own rate."""
    return float(trial.t[-1] * pace(trial.scene)) / (2 * np.pi)


def reference(trial: Wide, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Exact axes (2, 3, 3), their own uncertainty (3,), and how far motions that start 1e-10 beside it part, over 1e-10."""
    exact = exact_axes(trial.scene, trial.t)
    own = np.abs(exact - exact_axes(trial.scene, trial.t, 1e-17)).max((0, 2))
    beside = [exact_axes(trial.scene, trial.t, 1e-17, rng.normal(size=(2, 2, 3)) * 1e-10) for _ in range(2)]
    parted = np.max([np.abs(axes - exact).max((0, 2)) for axes in beside], axis=0) / 1e-10
    return exact.astype(float), own.astype(np.float32), parted.astype(np.float32)


def renew(path: Path) -> None:
    """Integrate the recorded trials anew: about ten minutes."""
    rng = np.random.default_rng(0)
    trials = wide_scenes(SEED, COUNT)
    axes, own, growth = (np.array(part) for part in zip(*(reference(trial, rng) for trial in trials), strict=True))
    from heyoka import real128

    for i in IN_128_BITS:
        exact, other = (
            exact_axes(trials[i].scene, trials[i].t, tol, X=real128).astype(float) for tol in (1e-26, 1e-23)
        )
        axes[i], own[i] = exact, np.abs(exact - other).max((0, 2))
    np.savez_compressed(path, axes=axes, own=own, growth=growth)


if __name__ == "__main__":
    renew(Path(__file__).with_name("wide_scenes.npz"))
