"""Random pairs for the tests of the error estimates: rotor, bar, spins, amplitude, shock; and their exact runs side by side.

The fast tests take a few pairs; `pytest -m slow` takes 10,000.
"""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene, natural_rate
from lagrotor.models.linear import pair_modes
from lagrotor.models.minimal import MODEL
from lagrotor.models.model import natural_units
from lagrotor.models.sweeps.batch_dop853 import march_swarm
from lagrotor.models.sweeps.chunk import _swarm
from lagrotor.numerics.error_estimate import Leg, march_legs
from lagrotor.numerics.segment import StopError

COUNTS = [8, pytest.param(10_000, marks=pytest.mark.slow)]


def random_pair(rng, kind="any"):
    """A rotor, a bar with 0.4 < ell/R < 2.5, massless or not, and two spins."""
    transverse = rng.uniform(0.3, 2)
    rotor = Rotor(rng.uniform(0.3, 2), rng.uniform(0.5, 1.5), transverse, rng.uniform(0.3, 1.9) * transverse)
    length = rotor.length * np.exp(rng.uniform(np.log(0.4), np.log(2.5)))
    mass = rng.choice([0, 1]) * rng.uniform(0.01, 2)
    spin = rng.uniform(3, 15) * rng.choice([-1, 1])
    other = {"opposite": -spin, "equal": spin, "any": rng.choice([-spin, spin, rng.uniform(-15, 15)])}[kind]
    return Scene((spin, other), rotor, Link(length, mass, mass and rng.uniform(0, 1) * mass * length**2))


def shocked(rng, scene, least=0.02, largest=0.4):
    """The scene with a shock of random width, direction and rotor, `least` to `largest` of the spin's momentum."""
    G, (a, b), natural = max(np.abs(scene.momenta)), scene.inertias, natural_rate(scene)
    size, width = np.exp(rng.uniform(np.log(least), np.log(largest))), rng.uniform(0.05, 1.2) / natural
    angle = rng.choice([0, rng.uniform(-1, 1) * size, rng.uniform(0, 2 * np.pi)])
    impulse = size * G * np.array([np.cos(angle), np.sin(angle) / np.sqrt((a + b) / (a - b)), 0])
    force = tuple(impulse / (scene.rotor.length * width * np.sqrt(np.pi)))
    shock = Shock(force, 8 * width, width, int(rng.choice([1, 2])))
    return Scene(scene.spins, scene.rotor, scene.link, shock)


def held(pairs, refusals, count, most_refused):
    """True errors below the given ones, and not by refusing too often."""
    true, given = np.array(pairs).T
    worst = int(np.argmax(true / given))
    assert (true <= given).all(), (worst, true[worst], given[worst])
    assert refusals <= most_refused * count


def swinging(rng, scene, amplitude):
    """The scene on its linear mode, the larger inclination of the two being `amplitude`."""
    linear = pair_modes(scene)
    values, vectors = np.linalg.eig(linear.upright @ linear.turning @ np.linalg.inv(linear.upright))
    fastest = np.argmax(values.imag)
    mode = vectors[:, fastest] * np.exp(2j * np.pi * rng.uniform())
    mode *= amplitude / max(np.linalg.norm(mode[[0, 1]]), np.linalg.norm(mode[[0, 2]]))
    axes, rates = (
        [[q[0], q[i], z] for i, z in ((1, up), (2, up))]
        for q, up in ((mode.real, 1.0), ((-values[fastest] * mode).real, 0.0))
    )
    axes = np.array(axes)
    axes[:, 2] = np.sqrt(1 - (axes[:, :2] ** 2).sum(1))
    return consistent_scene(scene.spins, axes, rates, scene.rotor, scene.link)


def exact_axes(scenes, times, local=1e-11):
    """Axes and rates (2, m, 3) of every scene at its own times (m,), from 0 on; None for one that stopped.

    One run of DOP853 each, all side by side.
    """
    units = [natural_units(replace(one, shock=one.shock_until(t[-1]))) for one, t in zip(scenes, times, strict=True)]
    kinds, seen = {}, [None] * len(scenes)
    for i, unit in enumerate(units):
        kinds.setdefault(MODEL.kind(unit.scene, True)[0], []).append(i)
    for kind, those in kinds.items():
        members = [units[i].scene for i in those]
        columns = np.array([MODEL.kind(one, True)[1] for one in members]).T
        legs = {
            j: Leg(MODEL.start(units[i].scene), times[i] * units[i].rate, local, False, 2e5)
            for j, i in enumerate(those)
        }
        swarm = _swarm(kind, columns, members)
        for j, stretch in march_legs(legs, partial(march_swarm, swarm)).items():
            if not isinstance(stretch, StopError):
                one = MODEL.observe(members[j], stretch.states)
                seen[those[j]] = one.axes, one.rates * units[those[j]].rate
    return seen
