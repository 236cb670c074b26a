"""Three exact models against independent right-hand sides, folded over, and into the dead point."""

from math import hypot
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor import Link, Rotor, Scene, Shock, simulate
from lagrotor.errors import LagrotorWarning
from lagrotor.mechanics.constraints import project_position, project_velocity, solve_constrained
from lagrotor.models import euler, minimal, spheres

TIMES = np.linspace(0, 10, 41)
ROTOR = Rotor(mass=1.3, length=0.9, I1=0.7, I3=1.1)


def constraints(q: np.ndarray, k: float) -> np.ndarray:
    r1, r2 = q[:3], q[3:]
    return np.array([(r1 @ r1 - 1) / 2, (r2 @ r2 - 1) / 2, k * (r2[0] - r1[0]) + 1 - r1 @ r2])


def normals(q: np.ndarray, k: float) -> np.ndarray:
    r1, r2, line, none = q[:3], q[3:], np.array([k, 0, 0]), np.zeros(3)
    return np.array([[*r1, *none], [*none, *r2], [*(-line - r2), *(line - r1)]])


def scene_near(seed: int, rotor: Rotor, link: Link, spins: tuple[float, float], speed: float = 1.2) -> Scene:
    """A random start near two parallel axes, brought onto its constraints."""
    draw, k = np.random.default_rng(seed), link.length / rotor.length
    guess = np.tile([0.5, 0.2, 0.84], 2) + draw.normal(0, 0.15, 6)
    q = project_position(lambda q: constraints(q, k), lambda q: normals(q, k), guess)
    v = project_velocity(normals(q, k), speed * draw.normal(size=6).clip(-2, 2))
    return Scene(spins, rotor, link, axes=q.reshape(2, 3), rates=v.reshape(2, 3))


# Right-hand sides at one state.


def oracle(scene: Scene) -> np.ndarray:
    """r'' from the energy of three rigid bodies: mass matrix by polarisation, constraints and spins by hand."""
    assert scene.link is not None
    R, ell, rotor, link = scene.rotor.length, scene.link.length, scene.rotor, scene.link
    q, v, k = np.ravel(scene.axes), np.ravel(scene.rates), scene.link.length / scene.rotor.length

    def energy(w: np.ndarray) -> float:
        tip_1, tip_2 = R * w[:3], R * w[3:]
        turning = (tip_2 - tip_1) / ell
        bar = link.mass / 2 * ((tip_1 + tip_2) / 2) @ ((tip_1 + tip_2) / 2) + link.inertia / 2 * turning @ turning
        return bar + (rotor.I1 / 2 + rotor.mass * (R / 2) ** 2 / 2) * w @ w

    basis = np.eye(6)
    mass = np.array([[energy(p + w) - energy(p) - energy(w) for w in basis] for p in basis])
    gamma = np.array([v[:3] @ v[:3], v[3:] @ v[3:], -2 * v[:3] @ v[3:]])
    G_1, G_2 = scene.momenta
    forces = np.concatenate([G_1 * np.cross(q[:3], v[:3]), G_2 * np.cross(q[3:], v[3:])])
    return solve_constrained(mass, np.zeros(6), normals(q, k), gamma, forces)[0]


def accelerations(model: Any, scene: Scene) -> np.ndarray:
    """r'' of a model: its rates of change seen through a complex step of `observe`, exact."""
    state = model.MODEL.start(scene)
    change = np.array(model.MODEL.rate(scene, False)(0.0, state))
    seen = model.MODEL.observe(scene, np.array([state + 1e-30j * change]))
    return (seen.rates[:, 0].imag / 1e-30).ravel()


positive = st.floats(0.3, 2)
spin = st.floats(-20, 20).map(lambda w: round(w, 6))


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    k=st.one_of(st.just(1.0), st.floats(0.6, 1.8)),
    masses=st.one_of(st.just((0.0, 0.0)), st.tuples(st.floats(0.01, 2), st.floats(0, 0.5).map(lambda K: round(K, 6)))),
    spins=st.tuples(spin, spin),
    sizes=st.tuples(positive, positive, positive),
)
def test_the_right_hand_sides_are_those_of_the_bodies(
    seed: int, k: float, masses: tuple[float, float], spins: tuple[float, float], sizes: tuple[float, float, float]
) -> None:
    mass, R, I1 = sizes
    scene = scene_near(seed, Rotor(mass, R, I1, 1.2 * I1), Link(k * R, *masses), spins)
    expected = oracle(scene)
    scale = 1 + np.abs(expected).max()
    assert accelerations(spheres, scene) == pytest.approx(expected, abs=1e-10 * scale)
    squared = min(r[1] ** 2 + r[2] ** 2 for r in scene.axes)
    assert accelerations(minimal, scene) == pytest.approx(expected, abs=1e-10 * scale / squared**2)
    if min(hypot(*r[:2]) for r in scene.axes) > 0.05:
        assert accelerations(euler, scene) == pytest.approx(expected, abs=1e-7 * scale)
    # Twin: the first rotor spinning a little faster is told apart.
    faster = Scene((spins[0] + 1, spins[1]), scene.rotor, scene.link, axes=scene.axes, rates=scene.rates)
    assert np.abs(oracle(faster) - expected).max() > 1e-6 or hypot(*scene.rates[0]) < 0.1


@pytest.mark.parametrize("link", [Link(0.7), Link(0.7, 0.3, 0.02)])
def test_a_scene_may_start_folded_over(link: Link) -> None:
    """Where the twist has turned back, the curve's parameter must come from the other branch."""
    spins = (0.5, -0.8)
    start = minimal.MODEL.observe(Scene(spins, ROTOR, link), np.array([(0.1, 1.2, 0.3, 0.2, 4.0, 0.5)]))
    scene = Scene(spins, ROTOR, link, axes=start.axes[:, 0], rates=start.rates[:, 0])
    run = simulate(scene, TIMES, "spheres", 1e-11)
    for i in range(0, len(TIMES), 2):
        here = Scene(scene.spins, scene.rotor, scene.link, axes=run.axes[:, i], rates=run.rates[:, i])
        seen = minimal.MODEL.observe(here, np.array([minimal.MODEL.start(here)]))
        assert seen.axes[:, 0] == pytest.approx(run.axes[:, i], abs=1e-9)
        assert seen.rates[:, 0] == pytest.approx(run.rates[:, i], abs=1e-7)
        expected = oracle(here)
        assert accelerations(minimal, here) == pytest.approx(expected, abs=1e-6 * (1 + np.abs(expected).max()))


@pytest.mark.parametrize("tol", [1e-4, 1e-11])
def test_a_run_into_the_dead_point_stops_at_every_tolerance(tol: float) -> None:
    """Planar toppling along the bar meets r_1 = r_2 = e_x, where the constraints are dependent; loose steps jumped over it."""
    still = Scene(spins=(0, 0), link=Link(1, 1, 1), shock=Shock((50, 0, 0), at=0.2, width=0.02))
    for model in ("spheres", "auto"):
        with pytest.warns(LagrotorWarning, match="ended early: a singular position was reached at t = "):
            run = simulate(still, np.linspace(0, 6, 13), model, tol)
        assert run.ending.kind == "singular" and run.t[-1] < run.ending.at < 6
    nudged = Scene(spins=(0, 0), link=Link(1, 1, 1), shock=Shock((50, 3.0, 0), at=0.2, width=0.02))
    run = simulate(nudged, [0.0, 6.0], "spheres", min(tol, 1e-6))
    tight = simulate(nudged, [0.0, 6.0], "spheres", 1e-12)
    assert np.abs(run.axes - tight.axes).max() < 1e-2
