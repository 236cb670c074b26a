"""The twist of equal spins on a cone: Hill's equation, the law and its error, against exact runs."""

import numpy as np
import pytest

from lagrotor import Link, Scene, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.numerics import measured_order
from lagrotor.theory import parallel_scene, twist_bounded, twist_growth, twist_growth_error, twist_multiplier_growth
from tests.theory.random_pairs import COUNTS, held, random_pair


def test_twist_growth_is_first_order_in_the_angle():
    scene = Scene(spins=(10, 10), link=Link(1, 1, 1))
    angles = (0.05, 0.1, 0.2)
    form = twist_growth()
    off = [abs(twist_multiplier_growth(scene, x) - float(form(np.sin(x), 10.0, *scene.inertias))) for x in angles]
    assert measured_order(angles, off) == pytest.approx(3, abs=0.1)


@pytest.mark.parametrize("link", [Link(1, 1, 1), Link(1, 0.5, 0.9)])
def test_the_error_of_the_twists_growth_is_its_next_term(link):
    """Above the true error, and by no more than |beta| for beta against it: at most a fifth at small angles."""
    scene = Scene(spins=(10, 10), link=link)
    for angle in (0.1, 0.2, 0.4):
        arguments = np.sin(angle), 10.0, *scene.inertias
        off = twist_multiplier_growth(scene, angle) - float(twist_growth()(*arguments))
        given = float(twist_growth_error()(*arguments))
        assert off < given < 1.2 * off / (1 - np.sin(angle) ** 2)
        assert float(twist_growth().error(*arguments)) == given


@pytest.mark.parametrize("count", COUNTS)
def test_twist_growth(count):
    """Against Hill's equation, itself held to exact runs below."""
    rng, pairs, refused = np.random.default_rng(7), [], 0
    while len(pairs) + refused < count:
        scene, angle = random_pair(rng, "equal"), rng.uniform(0.02, 1.4)
        arguments = (np.sin(angle), scene.momenta[0], *scene.inertias)
        try:
            law, given = float(twist_growth()(*arguments)), float(twist_growth_error()(*arguments))
        except DomainError:
            assert scene.inertias[1] > 0 and not twist_bounded(scene, angle)
            refused += 1
            continue
        turn = abs(scene.momenta[0]) / (sum(scene.inertias) * np.cos(angle))
        pairs.append((abs(twist_multiplier_growth(scene, angle) - law), given + 5e-6 * turn))
    held(pairs, refused, count, 0.3)


@pytest.mark.parametrize("count", [3, pytest.param(50, marks=pytest.mark.slow)])
def test_hills_equation_against_exact_runs(count):
    rng, checked = np.random.default_rng(8), 0
    while checked < count:
        scene, angle = random_pair(rng, "equal"), rng.uniform(0.1, 0.9)
        growth = twist_multiplier_growth(scene, angle)
        half = np.pi * sum(scene.inertias) * np.cos(angle) / abs(scene.momenta[0])
        if growth * half < 0.02:
            continue
        times = half * np.array([np.ceil(6 / growth / half), np.ceil(11 / growth / half)])
        axes = simulate(parallel_scene(scene, angle, 1e-7), [0.0, *times], "minimal", 1e-12).after(times[0]).axes
        apart = np.linalg.norm(axes[0] - axes[1], axis=-1)
        assert np.log(apart[1] / apart[0]) / (times[1] - times[0]) == pytest.approx(growth, rel=5e-3)
        checked += 1


def test_a_twist_that_lyapunov_bounds_is_bounded_and_beyond_some_grow():
    grown = []
    for mass in (1, 5, 20):
        scene = Scene((10, 10), link=Link(1, mass, 0))
        for angle in np.linspace(0.1, 1.4, 14):
            growth = twist_multiplier_growth(scene, angle)
            if twist_bounded(scene, angle):
                assert growth == 0
            elif growth:
                grown.append(growth)
    assert max(grown) > 1  # twin: the criterion is not empty


def test_refused():
    with pytest.raises(InputError, match="equal spins"):
        twist_multiplier_growth(Scene(spins=(10, -10)), 0.2)
