"""The exact paired precession: flow, Floquet multipliers, the family of orbits and its ends."""

import numpy as np
import pytest

from lagrotor import Link, Scene, floquet, orbit_family, simulate
from lagrotor.models import exact_orbit, trace_family
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.variational import flow


def test_slope_of_the_flow_is_the_derivative():
    scene = Scene(spins=(10, -10), link=Link(0.8, 0.9, 0.02))
    through, state = flow(scene), np.array([0.1, 0.2, 0.3, -0.4, 0.5, 0.2])
    slope = through(state, 0.7).slope
    step = 1e-5 * np.eye(6)
    differences = np.column_stack([(through(state + s, 0.7).end - through(state - s, 0.7).end) / 2e-5 for s in step])
    assert np.abs(slope - differences).max() < 1e-7


@pytest.mark.parametrize(
    ("link", "kind", "amplitude"),
    [
        (Link(1, 0, 0), "hyperbolic", 0.15),
        (Link(1.3, 0.1, 0.2), "hyperbolic", 0.08),
        (Link(1, 0.8, 0.1), "elliptic", 0.08),
    ],
)
def test_multipliers(link, kind, amplitude):
    scene = Scene(spins=(10, -10), link=link)
    found = floquet(scene, amplitude)
    assert found.kind == kind
    assert np.prod(found.multipliers).real == pytest.approx(1, abs=1e-10)
    assert np.linalg.det(found.monodromy) == pytest.approx(1, abs=1e-8)
    assert found.error < 1e-11 and found.exponent_error < 1e-3 * (found.growth + found.turning)


@pytest.mark.parametrize(("link", "amplitude"), [(Link(0.7, 0.5, 0.1), 0.2), (Link(1, 0, 0), 0.7)])
def test_a_quarter_of_a_turn_gives_the_whole(link, amplitude):
    scene = Scene(spins=(-6, 6), link=link)
    found, orbit = floquet(scene, amplitude), exact_orbit(scene, amplitude)
    turn = 2 * np.pi / abs(orbit.frequency)
    whole, shorter = (flow(orbit.scene)(MODEL.start(orbit.scene), time).slope for time in (turn, 0.999 * turn))
    assert abs(np.trace(whole) - 4 - found.pair_sum) < found.error
    assert np.abs(whole - found.monodromy).max() < 1e-11 * np.abs(whole).max()
    assert np.abs(shorter - found.monodromy).max() > 1e-4  # twin: another time


def test_the_error_of_large_multipliers_holds_what_rounding_leaves():
    """A short bar, far out: starts that differ in the last digit part by less; twin: by more than what integration adds."""
    scene, r0 = Scene(spins=(10, -10), link=Link(0.37, 0, 0)), 0.9
    found = floquet(scene, r0)
    beside = (floquet(scene, r0 + n * np.spacing(r0)).pair_sum for n in range(1, 4))
    moved = max(abs(pair_sum - found.pair_sum) for pair_sum in beside)
    assert moved < found.error < 1e-7 * found.pair_sum  # 3e-9 or 1.1e-8, as cos Δ is computed
    assert moved > 1e-13 * np.linalg.norm(found.monodromy)


def test_family_agrees_with_shooting():
    scene = Scene(spins=(10, -10), link=Link(1, 0.01, 0.1))
    family = orbit_family(scene, [0.1, 0.4])
    for i, r0 in enumerate((0.1, 0.4)):
        assert family.frequencies[i] == pytest.approx(exact_orbit(scene, r0).frequency, rel=1e-10)
    end = simulate(family.orbit(1).scene, [0.0, 2 * np.pi / family.frequencies[1]], "minimal", 1e-13)
    assert np.abs(end.axes[:, 1] - np.array(family.orbit(1).scene.axes)).max() < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("link", [Link(1, 0, 0), Link(0.6, 0, 0), Link(1.6, 0, 0)])
def test_family_reaches_the_joint_line_without_a_turn(link):
    family = trace_family(Scene(spins=(10, -10), link=link))
    assert family.turns == ()
    assert family.amplitudes[-1] > 0.98
    falls = np.diff(family.frequencies) < 0
    # A long bar's frequency only rises; the others fall to a least value and rise from there.
    assert falls.any() != (link.length > 1)
    assert not falls[-1]
    assert (np.diff(falls.astype(int)) != 0).sum() == (0 if link.length > 1 else 1)
