"""`simulate`: starts beside the dead point, what `auto` falls back to, and shocks however short."""

import re
from dataclasses import replace
from functools import lru_cache
from itertools import product
from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, paired_scene, simulate
from lagrotor.errors import SingularError
from lagrotor.mechanics.constraints import project_velocity

TILTED = ((sin(0.3), 0.0, cos(0.3)),) * 2
TURNING = ((0.0, 2.4, 0.0), (0.0, -2.4, 0.0))


def test_unit_vectors_refuse_a_start_beside_the_dead_point_and_one_further_off_runs() -> None:
    def leaning(angle: float, link: Link | None) -> Scene:
        return Scene((10, -10), link=link, axes=((cos(angle), 0, sin(angle)),) * 2, rates=((0, 1, 0), (0, 1, 0)))

    with pytest.raises(
        SingularError, match=r"start 7\.1e-06 rad from the position where bar and axes are in line.*tilt an axis"
    ):
        simulate(leaning(5e-6, Link(1.5)), [0, 1e-5], "spheres")
    assert simulate(leaning(5e-6, Link(1.5)), [0, 1e-5]).model == "minimal"  # which has no constraint to fail there
    assert simulate(leaning(5e-5, Link(1.5)), [0, 1e-5], "spheres").model == "spheres"
    assert simulate(leaning(5e-5, Link(1.5)), [0, 1e-5]).model == "minimal"  # rounding of the constraints costs `tol`


def on_the_line() -> Scene:
    """One axis along the joint line: at r_1 = e_x the bar asks (ell − R)(x_2 − 1) = 0, for ell = R nothing."""
    return Scene((10, -10), axes=((1, 0, 0), (0, 0, 1)), rates=((0, 1, 0), (0, 1, 0)))


def towards_the_line() -> Scene:
    """For ell = R an axis passes through the joint line whenever the twist reaches 90°: here at t = 0.5."""
    since = simulate(
        Scene((2, -2), axes=on_the_line().axes, rates=on_the_line().rates), [0, 0.5], "spheres", 1e-12
    ).after(0.5)
    return Scene((-2, 2), axes=since.axes[:, 0], rates=-since.rates[:, 0])


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (Scene((10, -10), link=None, shock=Shock((1, 2, 0), 0.5, 0.05)), "the scene has no bar to eliminate"),
        (on_the_line(), "axis 1 lies along the joint line"),
        (towards_the_line(), r"the solver stopped near t = 0\.3\d* s \(the coordinates become singular"),
    ],
)
def test_auto_falls_back_to_unit_vectors_and_says_why(scene: Scene, reason: str) -> None:
    times = np.linspace(0, 1, 9)
    run = simulate(scene, times, tol=1e-10)
    assert run.model == "spheres"
    assert re.match(f"regular everywhere; .*{reason}", run.why)
    assert run.axes == pytest.approx(simulate(scene, times, "spheres", 1e-13).axes, abs=1e-10)
    assert scene.shock or np.ptp(run.energy) < 1e-8


# A shock of given impulse, shorter and shorter, becomes a jump of the rates.
IMPULSE, AT, END = (0.8, -1.1, 0.3), 1.0, 2.5
ROTOR, LINK = Rotor(1.3, 0.9, 0.7, 1.1), Link(0.8, 0.3, 0.05)


def start(body: int = 1, width: float | None = None) -> Scene:
    shock = None if width is None else Shock([p / (width * sqrt(pi)) for p in IMPULSE], AT, width, body)
    return Scene((10, -9), ROTOR, LINK, shock, TILTED, TURNING)


@lru_cache
def limit(body: int) -> np.ndarray:
    """Run to the shock, throw the rates by M⁻¹ (impulse + Gᵀ λ) with λ such that the constraints hold, run on."""
    before = simulate(start(), [0, AT], "spheres", 1e-13).after(AT)
    (r1,), (r2,) = before.axes
    k, zero, line = LINK.length / ROTOR.length, np.zeros(3), np.array([LINK.length / ROTOR.length, 0, 0])
    G = np.array([[*r1, *zero], [*zero, *r2], [*(-line - r2), *(line - r1)]])
    assert k * (r2[0] - r1[0]) + 1 - r1 @ r2 == pytest.approx(0, abs=1e-12)
    a, b = start().inertias
    mass = np.kron([[a, b], [b, a]], np.eye(3))
    push = np.zeros(6)
    push[3 * body - 3 : 3 * body] = ROTOR.length * np.array(IMPULSE)
    thrown = before.rates.ravel() + project_velocity(G, np.linalg.solve(mass, push), mass)
    after = Scene((10, -9), ROTOR, LINK, axes=before.axes[:, 0], rates=thrown.reshape(2, 3))
    return simulate(after, [0, END - AT], "spheres", 1e-13).axes[:, -1]


@pytest.mark.parametrize(
    ("model", "body"),
    [*product(("minimal", "spheres"), (1, 2))],
)
def test_shocks_of_one_impulse_converge_to_the_jump_with_first_order(model: str, body: int) -> None:
    """The pulse is even about its centre, but the kinetic energy is quadratic in the rates: the first order stays."""
    widths = [1e-2, 1e-4, 1e-5, 1e-7]
    errors = [np.abs(simulate(start(body, w), [0, END], model, 1e-12).axes[:, -1] - limit(body)).max() for w in widths]
    assert np.log10(errors[1] / errors[2]) == pytest.approx(1, abs=0.02)
    assert np.log10(errors[2] / errors[3]) == pytest.approx(2, abs=0.02)
    assert errors[3] < 2e-8
    assert errors[0] < 1e-2
    # Twin: the other rotor's jump is not the limit.
    assert np.abs(limit(body) - limit(3 - body)).max() > 1e-2


@pytest.mark.parametrize("model", ["minimal", "spheres", "euler"])
def test_a_loose_tolerance_misses_no_shock(model: str) -> None:
    found = simulate(start(1, 1e-6), [0, END], model, 1e-3).axes[:, -1]
    assert found == pytest.approx(limit(1), abs=1e-2)
    assert np.abs(simulate(start(), [0, END], model, 1e-3).axes[:, -1] - limit(1)).max() > 0.1


@pytest.mark.parametrize("at", [1e10, -1e12])
def test_a_shock_that_is_not_felt_costs_no_digit(at: float) -> None:
    scene = paired_scene(Scene((10, -10)), 0.204)
    far = replace(scene, shock=Shock((1, 0, 0), at, 0.1))
    runs = [simulate(s, [0, 1.0, 10.0], "minimal", 1e-10).axes for s in (scene, far)]
    assert (runs[0] == runs[1]).all()
    near = replace(scene, shock=Shock((1, 0, 0), 5.0, 0.1))
    assert np.abs(simulate(near, [0, 1.0, 10.0], "minimal", 1e-10).axes - runs[0]).max() > 1e-2  # twin


@pytest.mark.parametrize("model", ["auto", "spheres"])
def test_progress_is_the_time_that_is_reached_and_changes_nothing(model: str) -> None:
    scene = Scene((10, -10), shock=Shock((40, -11, 0), 0.5, 0.05))
    reached: list[float] = []
    run = simulate(scene, [0, 1.0], model, 1e-6, progress=reached.append)
    assert len(reached) >= run.evaluations / 2 and 0 <= min(reached) < 0.01 and max(reached) > 0.99
    assert (run.axes == simulate(scene, [0, 1.0], model, 1e-6).axes).all()
