"""The linear response to a shock: random scenes against the exact model, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor import Link, Rotor, Scene, Shock, natural_rate, shock_response, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.models import shock_response_error
from lagrotor.numerics import measured_order
from tests.theory.random_pairs import COUNTS, exact_axes, held, random_pair, shocked

sizes = st.floats(0.3, 2.0)
spins = st.floats(3.0, 15.0)


@st.composite
def scenes(draw, force=1.0):
    """A random rotor, bar, pair of spins and shock of moderate size times `force`."""
    transverse = draw(sizes)
    rotor = Rotor(draw(sizes), draw(sizes), transverse, draw(st.floats(0.5, 1.9)) * transverse)
    link = Link(draw(sizes), draw(st.floats(0.0, 1.0)) + 0.01, draw(st.floats(0.0, 0.5)))
    signs = draw(st.tuples(st.sampled_from((-1, 1)), st.sampled_from((-1, 1))))
    pair = (signs[0] * draw(spins), signs[1] * draw(spins))
    push = (draw(st.floats(1, 3)) * force, draw(st.floats(-3, 3)) * force, 0.0)
    return Scene(
        spins=pair,
        rotor=rotor,
        link=link,
        shock=Shock(push, 0.6, draw(st.floats(0.03, 0.1)), draw(st.sampled_from((1, 2)))),
    )


def resized(scene, factor):
    shock = scene.shock
    force = tuple(factor * f for f in shock.force)
    return Scene(scene.spins, scene.rotor, scene.link, Shock(force, shock.at, shock.width, shock.body))


def coordinates(run):
    return np.stack([run.axes[0, :, 0], run.axes[0, :, 1], run.axes[1, :, 1]], -1)


@settings(max_examples=5, deadline=None)
@given(scenes(0.3))
def test_error_falls_as_square(scene):
    times = np.linspace(0.0, 1.8, 41)
    factors = (0.01, 0.02, 0.04)
    errors = []
    for factor in factors:
        small = resized(scene, factor)
        errors.append(
            np.abs(shock_response(small).through(times) - coordinates(simulate(small, times, "minimal", 1e-13))).max()
        )
    assert errors[0] < 1e-10 or measured_order(factors, errors) > 1.9


@settings(max_examples=20, deadline=None)
@given(scenes(0.5))
def test_energy_and_after(scene):
    answer = shock_response(scene)
    late = np.array([scene.shock.at + 7 * scene.shock.width + 0.3])
    assert np.abs(answer.after(late) - answer.through(late)).max() < 1e-12
    small = resized(scene, 1e-3)
    gained = np.ptp(simulate(small, np.array([0.0, 1.5]), "minimal", 1e-13).energy)
    assert gained == pytest.approx(shock_response(small).energy, rel=2e-2)
    assert answer.energy <= answer.impulse_energy * (1 + 1e-12)
    wide = Scene((100, -100), link=Link(1, 0.01, 0.1), shock=Shock((1, 0, 0), 50, 5))
    assert np.isfinite(shock_response(wide).through(np.linspace(0, 100, 50))).all()


def test_no_spin_topples_at_the_impulse_over_the_inertia():
    scene = Scene(spins=(0, 0), link=Link(1, 0.01, 0.1), shock=Shock((1, 2, 0), 1, 0.02))
    answer = shock_response(scene)
    a, b = scene.inertias
    assert answer.drift[0] == pytest.approx(answer.impulse[0] / (2 * (a + b)))
    assert not answer.amplitude.any()


@pytest.mark.parametrize(
    ("changed", "word"),
    [
        ({"shock": None}, "shock"),
        ({"link": None}, "bar"),
        ({"rates": ((0, 1, 0), (0, 1, 0))}, "at rest"),
        ({"axes": ((0, 0.6, 0.8), (0, 0.6, 0.8))}, "upright"),
        ({"shock": Shock((1, 0, 0), 0.1, 0.05)}, "before t = 0"),
    ],
)
def test_refused(changed, word):
    with pytest.raises(InputError, match=word):
        shock_response(Scene(**({"spins": (10, -10), "shock": Shock((1, 0, 0), 1, 0.05)} | changed)))


@pytest.mark.parametrize("count", COUNTS)
def test_its_error_on_random_pairs(count):
    rng, told, refused = np.random.default_rng(3), [], 0
    while len(told) + refused < count:
        scene = shocked(rng, random_pair(rng))
        end = scene.shock.end + rng.uniform(0.2, 3) * 2 * np.pi / natural_rate(scene)
        try:
            told.append((scene, np.linspace(0, end, 101), shock_response_error(scene, end)))
        except DomainError:
            refused += 1
    scenes, times, errors = zip(*told, strict=True)
    pairs = []
    for scene, t, (axes, _), error in zip(scenes, times, exact_axes(scenes, times), errors, strict=True):
        seen = shock_response(scene).through(t)
        off = [np.linalg.norm(axes[i, :, :2] - seen[:, [0, i + 1]], axis=-1).max() for i in (0, 1)]
        pairs.append((max(off), error + 1e-9))
    held(pairs, refused, count, 0.5)


def test_a_shock_too_strong_for_an_error_estimate_is_refused():
    scene = Scene((10, -10), link=Link(1, 0.01, 0.1), shock=Shock((40, 0, 0), 0.5, 1 / 20))
    with pytest.raises(DomainError, match="the response is not small"):
        shock_response_error(scene, 5.0)
