"""The exact model of N rotors and B bars, held to the pair's models, to Lagrange's equations, and to what it conserves."""

import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Brace, Link, Rotor, Scene, Structure, simulate
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.structures import exact_motion
from lagrotor.structures.exact.compiled_motion import right_hand_side

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.structures.oracle import accelerations_by_energies

BARS = (Link(1, 0, 0), Link(1, 1, 1), Link(1, 0.3, 0.1))
CORNER = {"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)]}
GRID = [(x, y) for y in range(3) for x in range(3)]
GRID_BARS = [(i, i + 1) for i in range(9) if i % 3 < 2] + [(i, i + 3) for i in range(6)]
LOADED = {
    "a top": Structure(joints=[(0, 0)], spins=[10], gravity=9.81, load=[0.3], friction=0.1),
    "a pair": Structure(
        joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=[12, -7], link=Link(1, 0.3, 0.1), gravity=9.81,
        load=[0.2, 0.5], hinge=3.0, friction=0.2,
    ),
    "a braced corner of unequal rotors": Structure(
        **CORNER, spins=[30, 5, 20], link=[Link(1, 0.3, 0.1), Link(1, 0, 0)],
        rotor=[Rotor(), Rotor(1, 1.2, 0.8, 0.7), Rotor()], gravity=9.81, load=[0.2, 0.5, 0], hinge=3.0,
        friction=0.2, braces=[Brace(0, 2, 4.0, 0.3), Brace(1, (1.0, -2.0, 0.5), 5.0, 0.1)],
    ),
}  # fmt: skip


def started(s, seed=1, size=0.2):
    draw = np.random.default_rng(seed)
    return {"tilt": size * draw.standard_normal((len(s.joints), 2)), "rates": draw.standard_normal((len(s.joints), 2))}


@pytest.mark.parametrize(("link", "model"), [*zip(BARS, ("spheres", "minimal", "spheres"), strict=True)])
def test_two_rotors_without_load_are_the_pair(link, model) -> None:
    s = Structure(joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=[10, -7], link=link)
    run = s.simulate(np.linspace(0, 5, 101), **started(s), tol=1e-10)
    start = {"axes": run.axes[:, 0].tolist(), "rates": run.rates[:, 0].tolist()}
    pair = simulate(Scene(spins=(10, -7), link=link, **start), run.t, model, tol=1e-12)
    assert np.abs(run.axes - pair.axes).max() < 1e-10
    other = simulate(Scene(spins=(10, -7.0001), link=link, **start), run.t, model, tol=1e-12)
    assert np.abs(run.axes - other.axes).max() > 1e-7


@pytest.mark.parametrize("name", LOADED)
def test_at_any_state_it_is_what_energies_friction_and_constraints_say(name) -> None:
    """Of axes above the ground, driven. The twins: one number changed."""
    s, N = replace(LOADED[name], spin_friction=0.4), len(LOADED[name].joints)
    s = replace(s, braces=(*s.braces, Brace(0, (0.3, -1.0, 0.5), 2.0, 0.7)))
    push, ground, draw = np.arange(3.0 * N).reshape(N, 3), np.array([0.5, -0.3, 0.2]), np.random.default_rng(N)
    r, v = draw.standard_normal((2, N, 3))
    r = np.where([False, False, True], np.abs(r), r) / np.linalg.norm(r, axis=1, keepdims=True)
    G = np.array([rotor.I3 * w * np.exp(-0.4 * 1.3 / rotor.I3) for rotor, w in zip(s.rotor, s.spins, strict=True)])
    expected = accelerations_by_energies(s, r, v, G, 1.3 * push, 1.3 * ground)

    def off(other: Structure) -> float:
        found = exact_motion(other, lambda t: push * t, lambda t: ground * t).accelerations(1.3, r, v)
        return np.abs(found - expected).max() / np.abs(expected).max()

    assert off(s) < 1e-11
    changed = dict.fromkeys(("friction", "hinge", "gravity", "load", "spins", "spin_friction"), 0.21)
    for name, value in (changed | {"braces": s.braces[:-1]} | ({"link": Link(1, 0.31, 0.1)} if N > 1 else {})).items():
        assert off(replace(s, **{name: value})) > 1e-4


@pytest.mark.parametrize("name", LOADED)
def test_in_single_numbers_it_is_the_same_right_hand_side(name) -> None:
    s, N = replace(LOADED[name], spin_friction=0.4), len(LOADED[name].joints)
    drives = (
        (lambda t: np.arange(3.0 * N).reshape(N, 3) * np.sin(t)),
        (lambda t: np.array([0.5, -0.3, 0.2]) * np.cos(t)),
    )
    for given in ((None, None), drives):
        motion = exact_motion(s, *given)
        draw = np.random.default_rng(4).standard_normal((2, N, 3))
        axes = motion.c.upright + 0.1 * draw[0]
        state = np.concatenate([axes / np.linalg.norm(axes, axis=1, keepdims=True), draw[1]]).ravel()
        found, kept = right_hand_side(motion)(1.3, state), motion.rhs(1.3, state)
        assert isinstance(found, list)
        assert found == pytest.approx(kept, rel=1e-13, abs=1e-13)
        other = exact_motion(replace(s, friction=0.201), *given)
        assert right_hand_side(other)(1.3, state) != pytest.approx(kept, rel=1e-6)


def nine() -> Structure:
    spins = [-20, 20, 20, 20, -20, 20, 20, 20, -20]
    return Structure(joints=GRID, bars=GRID_BARS, spins=spins, link=Link(1, 0.3, 0.1))


@pytest.mark.parametrize("turns", [10, pytest.param(1000, marks=pytest.mark.slow)])
def test_nine_rotors_keep_energy_and_bars(turns: int) -> None:
    """Tilts of some hundredths: wider swings of so many rotors sooner or later bring an axis into line with its bars."""
    s = nine()
    period = 2 * np.pi * exact_motion(s).c.A.max() / 20
    start = started(s, size=0.05)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)  # neighbours part; what is conserved does not
        run = s.simulate(np.linspace(0, turns * period, 101), start["tilt"], 0.1 * start["rates"], tol=1e-9)
    assert np.abs(run.axes[..., :2]).max() > 0.03
    assert np.abs(run.energy / run.energy[0] - 1).max() < 1e-9
    assert np.abs(run.link_length - 1).max() < 1e-9
    assert np.abs(np.linalg.norm(run.axes, axis=-1) - 1).max() < 1e-12


def test_spins_decay_by_their_own_friction() -> None:
    s = Structure(joints=[(0, 0)], spins=[20], spin_friction=0.3)
    run = s.simulate(np.linspace(0, 4, 9), rates=[(1e-3, 0)], tol=1e-10)
    free = Structure(joints=[(0, 0)], spins=[20]).simulate(run.t, rates=[(1e-3, 0)], tol=1e-10)
    # Small motion: u' = v0 exp(i ∫ G dt / J) in the complex plane.
    angle = 20 / 1.25 * (1 - np.exp(-0.3 * run.t)) / 0.3
    velocity = run.rates[0, :, 0] + 1j * run.rates[0, :, 1]
    assert np.abs(velocity - 1e-3 * np.exp(1j * angle)).max() < 1e-9
    assert np.abs(run.axes - free.axes).max() > 1e-5


def test_bars_of_other_lengths_lean_the_axes() -> None:
    s = Structure(joints=[(0, 0), (1, 0)], bars=[(0, 1, 1.3)], spins=[20, 20])
    run = s.simulate([0.0, 1.0])
    assert run.link_length == pytest.approx(1.3, abs=1e-12)
    assert run.axes[1, 0, 0] == pytest.approx(0.15) and run.axes[0, 0, 0] == pytest.approx(-0.15)


@pytest.mark.parametrize(("engine", "tol"), [("core", 1e-12), ("core", 1e-6), ("fast", 1e-6)])
def test_a_tolerance_that_is_not_kept_is_said(engine, tol) -> None:
    """Also where the tightest pair of runs is the last of several: the two differ, so that the error is found."""
    if engine == "fast":
        pytest.importorskip("heyoka", reason="the fast extra is not installed")
    s = Structure(joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=[1, -1], gravity=9.81, load=5)
    with pytest.warns(LagrotorWarning, match="does not keep"):
        run = s.simulate(np.linspace(0, 12, 13), tilt=[(0, 1e-3)] * 2, rates=[(0.1, 0.3)] * 2, tol=tol, engine=engine)
    assert run.error > tol


def test_a_singular_state_leaves_those_beside_it_alone() -> None:
    motion = exact_motion(Structure(joints=[(0, 0), (1, 0), (2, 0)], bars=[(0, 1), (1, 2)], spins=[10, 10, 10]))
    states = np.random.default_rng(5).normal(size=(18, 6))
    alone = motion.project(states)
    states[:, 2] = np.nan
    beside = motion.project(states)
    kept = [0, 1, 3, 4, 5]
    assert np.array_equal(beside[:, kept], alone[:, kept]) and np.isfinite(alone).all()
    assert np.isnan(beside[:, 2]).any()


@pytest.mark.parametrize(
    ("given", "reason"), [(np.full((1, 3), np.nan), "must be finite"), (np.zeros(2), r"not \(2,\)"), (None, "KeyError")]
)
def test_a_drive_that_fails_between_the_times_of_the_run_is_named(given, reason) -> None:
    """The solver meets it, and would speak of a singular position; after the run's end it does no harm."""
    still, top = np.zeros((1, 3)), Structure(joints=[(0, 0)], spins=10)

    def failing(begin: float):
        return lambda t: still if not begin < t < begin + 0.1 else {}["no such sample"] if given is None else given

    with pytest.raises(InputError, match=rf"drive at t = 0\.\d+ .*{reason}"):
        top.simulate([0, 1], rates=[(0.1, 0)], drive=failing(0.2), tol=1e-5)
    assert top.simulate([0, 1], rates=[(0.1, 0)], drive=failing(1.0), tol=1e-5).error < 1e-5
