"""The guiding centre of unequal spins: the field's numbers by finite differences, its invariants, exact runs, what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, consistent_scene, natural_rate, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.models import guiding_centre_error
from lagrotor.pair import leaning_lagrangian
from lagrotor.pair.notation import G_1, G_2, LEANING, a, b, k
from lagrotor.theory import GuidingCentre, charged_particle, guiding_centre, leaning_state
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
        values |= dict(zip((*LEANING.q, *LEANING.v), (*q, *v), strict=True))
        alpha_v = LEANING.v[2]
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
    slopes = np.array([(one.along - other.along) / (2 * step) for one, other in sides])
    assert at.curl == pytest.approx([slopes[1, 2], -slopes[0, 2], slopes[0, 1] - slopes[1, 0]], abs=1e-8)
    assert at.gradient[:2] == pytest.approx([(one.rate - other.rate) / (2 * step) for one, other in sides], abs=1e-7)
    flux = [(one.flux - other.flux) / (2 * step) for one, other in sides]
    assert at.field[:2] == pytest.approx([flux[1], -flux[0]], abs=1e-8)
    assert at.along @ np.linalg.solve(at.mass, at.along) == pytest.approx(1, rel=1e-12)
    assert charged_particle._at(scene, 0.4, 0.0).rate == pytest.approx(natural_rate(scene), rel=1e-12)


def test_the_path_keeps_its_energy_and_follows_the_flux_of_a_slow_pair():
    scene = leaning(Scene((11, 5), link=Link(1.2, 0.5, 0.03)))
    centre = guiding_centre(scene)
    path = centre.path(np.linspace(0, 20, 9))
    assert np.ptp(path[:, 1]) > 0.4
    assert [centre.energy_at(*place[:2]) for place in path] == pytest.approx([centre.energy] * 9, rel=1e-7)
    flux = [charged_particle._at(scene, *place[:2]).flux for place in path]
    assert np.ptp(flux) < 0.01 * np.abs(scene.momenta).max()
    other = GuidingCentre(scene, centre.place, centre.speed, 5 * centre.action)  # twin: of a wider swing
    assert abs(other.energy_at(*path[-1, :2]) / other.energy - 1) > 1e-3


@pytest.mark.parametrize("seed", range(4))
def test_random_pairs_go_where_it_says(seed):
    """Over a time in which the centre goes some tenths; off by the size of the swing at most."""
    rng = np.random.default_rng(seed)
    pair = replace(random_pair(rng), spins=(rng.uniform(5, 15), rng.uniform(-4, 15)))
    rate = natural_rate(pair)
    scene = leaning(pair, rng.uniform(-0.4, 0.4), 0.1, 0.01 * rate * rng.normal(size=4))
    t = np.linspace(0, 8 * 2 * np.pi / rate, 9)
    run, path = simulate(scene, t, "minimal", 1e-9), guiding_centre(scene).path(t)
    ends = [
        guiding_centre(replace(scene, axes=tuple(map(tuple, run.axes[:, i])), rates=tuple(map(tuple, run.rates[:, i]))))
        for i in range(len(t))
    ]
    off = np.abs(path - [end.place for end in ends]).max()
    assert off < 0.02
    assert np.ptp(path, axis=0).max() > 4 * off


def test_its_error_is_that_of_the_exact_motion_and_of_first_order():
    """A slower pair, for as many times longer; the path of another centre, the twin, is off by more."""
    pair, errors = Scene((11, 5), link=Link(1.2, 0.5, 0.03)), []
    for slower in (1.0, 0.5):
        scene = leaning(pair, rates=tuple(slower * v for v in (0.06, 0.04, 0.06, -0.03)))
        t = np.array([3.0, 6.0, 9.0]) / slower
        errors.append(guiding_centre_error(scene, t))
        run, path = simulate(scene, [0.0, *t], "minimal", 1e-9), guiding_centre(scene).path(t)
        for i, place in enumerate(path, 1):
            state = replace(scene, axes=tuple(map(tuple, run.axes[:, i])), rates=tuple(map(tuple, run.rates[:, i])))
            assert np.abs(place - guiding_centre(state).place).max() <= errors[-1][i - 1] + 1e-9
        assert np.ptp(path, axis=0).max() > 4 * errors[-1].max()
    assert errors[1].max() == pytest.approx(errors[0].max() / 2, rel=0.3)
    with pytest.raises(DomainError, match="swings long"):
        guiding_centre_error(scene, [1e6])
    with pytest.raises(InputError, match="before the start"):
        guiding_centre_error(scene, [-1.0, 2.0])


def test_what_it_does_not_hold_is_refused():
    scene = leaning(Scene((11, 5)))
    for wrong in (Scene((10, -10)), Scene((10, 5), link=None), replace(scene, shock=Shock((1, 0, 0), 1, 0.1)), "scene"):
        with pytest.raises(InputError, match=r"guiding_centre: .* needs a bar"):
            guiding_centre(wrong)
    with pytest.raises(DomainError, match=r"swings by .* rad, beyond 0\.4"):
        guiding_centre(leaning(Scene((11, 5)), rates=(6, 4, 6, -3)))
    with pytest.raises(DomainError, match=r"comes into line with an axis \d+.* s after the start"):
        guiding_centre(leaning(Scene((11, 5), link=Link(0.5)))).path([0, 10.0, 20.0, 30.0, 40.0, 500.0])
    fast = leaning(Scene((10, -9.5), link=Link(0.4, 1, 0.05)), 0.6, 0.1, (-0.3, -0.3, -0.3, -0.3))
    with pytest.raises(DomainError, match=r"an axis 8\.83 s after"):  # a step tries places where the bar does not reach
        guiding_centre(fast).path([0, 500.0])
    assert len(guiding_centre(fast).path([0, 8.8])) == 2
    centre = guiding_centre(scene)
    assert centre.energy_at(*centre.place[:2]) == pytest.approx(centre.energy, rel=1e-9)
    for place in ((1.57, 0.3), (0.1, 1.5), (2.0, 0.0)):
        with pytest.raises(DomainError, match=r"in line with an axis or does not reach: \|sin h\|"):
            centre.energy_at(*place)
    for beta in ("a", np.nan, np.zeros(3)):
        with pytest.raises(InputError, match="energy_at: beta"):
            centre.energy_at(beta, 0.1)
    for times in ([0, 2, 1], [-1.0, 1], [np.nan], "soon"):
        with pytest.raises(InputError, match="guiding_centre: t"):
            guiding_centre(scene).path(times)
