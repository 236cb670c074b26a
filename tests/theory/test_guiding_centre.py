"""The guiding centre of unequal spins: the field's numbers by finite differences, its invariants, exact runs, what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, consistent_scene, natural_rate, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.models import guiding_centre_error
from lagrotor.models.model import scenes_of
from lagrotor.pair import leaning_lagrangian, notation
from lagrotor.pair.notation import G_1, G_2, a, b, k
from lagrotor.theory import charged_particle, guiding_centre, leaning_state
from tests.theory.random_pairs import random_pair


def leaning(pair, lean=0.3, twist=0.1, rates=(0.06, 0.04, 0.06, -0.03)):
    one, other = np.reshape(rates, (2, 2))
    return consistent_scene(
        pair.spins, ((lean, twist, 1), (lean, -twist, 1)), ((*one, 0), (*other, 0)), pair.rotor, pair.link
    )


def test_the_state_and_the_energy_are_those_of_the_lagrangian():
    """Its kinetic part at the coordinates and rates of a random scene, either sign of the twist, and P."""
    rng = np.random.default_rng(0)
    for twist in (0.2, -0.2, 0.0):
        pair = random_pair(rng)
        scene = leaning(pair, rng.uniform(-0.5, 0.5), twist, rng.normal(size=4))
        q, v = leaning_state(scene)
        values = dict(zip((a, b, k, G_1, G_2), (*scene.inertias, scene.k, *scene.momenta), strict=True))
        values |= dict(zip((*notation.LEANING.q, *notation.LEANING.v), (*q, *v), strict=True))
        alpha_v = notation.LEANING.v[2]
        run = simulate(scene, [0.0], "minimal")
        assert float(leaning_lagrangian().diff(alpha_v).subs(values)) == pytest.approx(
            run.joint_line_momentum[0], rel=1e-9
        )
        still = values | {G_1: 0, G_2: 0}
        spinning = sum(G**2 for G in scene.momenta) / (2 * scene.rotor.I3)
        assert float(leaning_lagrangian().subs(still)) + spinning == pytest.approx(run.energy[0], rel=1e-9)


def test_slopes_are_those_of_finite_differences():
    scene = leaning(Scene((9, -2), link=Link(0.8, 0.5, 0.02)))
    at, step = charged_particle._at(scene, 0.3, 0.25), 1e-5
    sides = [
        [charged_particle._at(scene, 0.3 + sign * x, 0.25 + sign * y) for sign in (1, -1)]
        for x, y in ((step, 0), (0, step))
    ]
    slopes = np.array([(one.direction - other.direction) / (2 * step) for one, other in sides])
    assert at.curl == pytest.approx([slopes[1, 2], -slopes[0, 2], slopes[0, 1] - slopes[1, 0]], abs=1e-8)
    assert at.gradient[:2] == pytest.approx([(one.rate - other.rate) / (2 * step) for one, other in sides], abs=1e-7)
    flux = [(one.flux - other.flux) / (2 * step) for one, other in sides]
    assert at.field[:2] == pytest.approx([flux[1], -flux[0]], abs=1e-8)
    assert at.direction @ np.linalg.solve(at.mass, at.direction) == pytest.approx(1, rel=1e-12)
    assert charged_particle._at(scene, 0.4, 0.0).rate == pytest.approx(natural_rate(scene), rel=1e-12)


def test_the_path_keeps_its_energy_and_follows_the_flux_of_a_slow_pair():
    scene = leaning(Scene((11, 5), link=Link(1.2, 0.5, 0.03)))
    centre = guiding_centre(scene)
    path = centre.path(np.linspace(0, 20, 9))
    assert np.ptp(path[:, 1]) > 0.4
    there = [charged_particle._at(scene, *place[:2]) for place in path]
    momentum = there[0].flux + centre.speed * there[0].direction[2]

    def energy(action):
        """J Omega + (P − g_alpha)²/(2 b_alpha²) along the path."""
        return [action * at.rate + ((momentum - at.flux) / at.direction[2]) ** 2 / 2 for at in there]

    assert energy(centre.action) == pytest.approx([centre.energy] * 9, rel=1e-7)
    assert np.ptp(energy(5 * centre.action)) > 1e-3 * centre.energy  # twin: of a wider swing
    assert np.ptp([at.flux for at in there]) < 0.01 * np.abs(scene.momenta).max()


def centres(scene, run):
    return np.array([guiding_centre(one).place for one in scenes_of(scene, run)])


@pytest.mark.parametrize("seed", range(3))
def test_random_pairs_go_where_it_says(seed):
    """Over a time in which the centre goes some tenths; off by the size of the swing at most."""
    rng = np.random.default_rng(seed)
    pair = replace(random_pair(rng), spins=(rng.uniform(5, 15), rng.uniform(-4, 15)))
    rate = natural_rate(pair)
    scene = leaning(pair, rng.uniform(-0.4, 0.4), 0.1, 0.01 * rate * rng.normal(size=4))
    t = np.linspace(0, 8 * 2 * np.pi / rate, 9)
    path = guiding_centre(scene).path(t)
    off = np.abs(path - centres(scene, simulate(scene, t, "minimal", 1e-9))).max()
    assert off < 0.02
    assert np.ptp(path, axis=0).max() > 4 * off
    assert guiding_centre_error(scene, t).max() == pytest.approx(off, rel=1e-6)


def test_its_error_is_of_first_order():
    """A slower pair, for as many times longer."""
    pair, errors = Scene((11, 5), link=Link(1.2, 0.5, 0.03)), []
    for slower in (1.0, 0.5):
        scene = leaning(pair, rates=tuple(slower * v for v in (0.06, 0.04, 0.06, -0.03)))
        errors.append(guiding_centre_error(scene, np.linspace(3, 9, 25) / slower).max())
    assert errors[1] == pytest.approx(errors[0] / 2, rel=0.3)


def test_a_trial_of_a_step_beyond_the_bars_reach_ends_no_path():
    assert len(guiding_centre(FAST).path([0, 8.8])) == 2


LEANING = leaning(Scene((11, 5)))
FAST = leaning(Scene((10, -9.5), link=Link(0.4, 1, 0.05)), 0.6, 0.1, (-0.3, -0.3, -0.3, -0.3))
REFUSALS = [
    *(
        (lambda wrong=wrong: guiding_centre(wrong), r"guiding_centre: .* needs a bar")
        for wrong in (
            Scene((10, -10)),
            Scene((10, 5), link=None),
            replace(LEANING, shock=Shock((1, 0, 0), 1, 0.1)),
            "scene",
        )
    ),
    (lambda: guiding_centre(leaning(Scene((11, 5)), rates=(6, 4, 6, -3))), r"swings by .* rad, beyond 0\.4"),
    (
        lambda: guiding_centre(leaning(Scene((11, 5), link=Link(0.5)))).path([0, 500.0]),
        "into line with an axis before 500 s",
    ),
    (lambda: guiding_centre(FAST).path([0, 9.0]), "into line with an axis before 9 s"),
    (lambda: charged_particle._at(LEANING, 0.1, 1.5), r"in line with an axis or does not reach: \|sin h\|"),
    *(
        (lambda t=t: guiding_centre(LEANING).path(t), "guiding_centre: t")
        for t in ([0, 2, 1], [-1.0, 1], [np.nan], "soon")
    ),
    (lambda: guiding_centre_error(LEANING, [1e6]), "swings long"),
    (lambda: guiding_centre_error(LEANING, [-1.0, 2.0]), "before the start"),
]


@pytest.mark.parametrize(("call", "message"), REFUSALS)
def test_what_it_does_not_hold_is_refused(call, message):
    with pytest.raises((DomainError, InputError), match=message):
        call()
