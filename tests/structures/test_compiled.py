"""The fast extra on structures: the equations written out are those of the exact motion, and so are the runs."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Structure
from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.structures import exact_motion
from lagrotor.structures.exact import compiled_motion
from lagrotor.structures.exact.compiled_motion import structure_accelerations
from lagrotor.structures.exact.exact_motion import LineWatch

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.structures.test_exact_motion import LOADED, nine, started

T = np.linspace(0, 2, 11)


@pytest.mark.parametrize("theta", [0.0, 1e-9, 0.3, 1.5, 3.0])
def test_the_hinge_is_exact_from_upright_to_hanging(theta: float) -> None:
    s = Structure([(0, 0)], spins=1, hinge=2.0)
    r = [math.sin(theta), 0.0, math.cos(theta)]
    found = structure_accelerations(exact_motion(s).c, [r], [[0.0] * 3], [0.0], math)
    assert 1.25 * np.hypot(found[0], found[2]) == pytest.approx(2 * theta, rel=1e-13, abs=1e-22)


def same(s: Structure, tol: float) -> bool:
    """Whether the runs of both engines agree within their errors, and keep the bars."""
    start = started(s, size=0.05)
    core, fast = (s.simulate(T, **start, tol=tol, engine=engine) for engine in ("core", "fast"))
    off = np.abs(core.axes - fast.axes)
    stretched = np.abs(fast.link_length - np.array([bar[2] for bar in s.bars])[:, None]).max(initial=0)
    assert stretched < 1e-12 and off[:, 0].max() <= 1e-15 and fast.evaluations > 0
    return off.max() < core.error + fast.error < 2 * tol


@pytest.fixture
def heyoka():
    return pytest.importorskip("heyoka", reason="the fast extra is not installed")


def test_a_run_of_the_fast_extra_is_that_of_the_core(heyoka) -> None:
    assert same(Structure([(0, 0)], spins=20, gravity=9.81, spin_friction=0.3, friction=0.1), 1e-7)


def test_it_is_compiled_once_for_all_spins(heyoka) -> None:
    top = Structure([(0, 0)], spins=20, gravity=9.81)
    top.simulate(T, tilt=[(0.1, 0)], tol=1e-7, engine="fast")
    before = compiled_motion._solver.cache_info().misses
    other = replace(top, spins=-30.0)
    fast, core = (other.simulate(T, tilt=[(0.1, 0)], tol=1e-7, engine=engine) for engine in ("fast", "core"))
    assert compiled_motion._solver.cache_info().misses == before
    assert np.abs(core.axes - fast.axes).max() < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("tol", [1e-6, 1e-10])
@pytest.mark.parametrize("s", [*LOADED.values(), nine()], ids=[*LOADED, "nine"])
def test_a_run_of_any_structure_is_that_of_the_core(heyoka, s, tol) -> None:
    assert same(s, tol)


def test_the_compiled_right_hand_side_is_that_of_the_exact_motion(heyoka) -> None:
    s = replace(LOADED["a braced corner of unequal rotors"], spin_friction=0.4)
    motion = exact_motion(s)
    r, v = np.random.default_rng(4).standard_normal((2, 3, 3))
    y = np.concatenate([(r / np.linalg.norm(r, axis=1, keepdims=True)).ravel(), v.ravel()])
    found = compiled_motion.compiled_right_hand_side(s, motion)(0.7, y)
    assert np.abs(found - motion.rhs(0.7, y)).max() < 1e-12 * np.abs(found).max()
    assert np.abs(found - motion.rhs(0.8, y)).max() > 1e-4


@pytest.mark.parametrize(("engine", "tol"), [("core", 1e-2), ("core", 1e-6), ("fast", 1e-6)])
def test_no_step_passes_a_position_where_a_bar_is_in_line_with_its_axes(engine, tol, request) -> None:
    """A pair without spin falls along its bar, through the line of the joints; across it, through no such place."""
    if engine == "fast":
        request.getfixturevalue("heyoka")
    s = Structure([(0, 0), (1, 0)], [(0, 1)], 0.0, gravity=9.81)
    with pytest.warns(LagrotorWarning, match="bar 0 comes into line with both its axes"):
        run = s.simulate([0, 1, 2, 3], tilt=[(0.01, 0)] * 2, engine=engine, tol=tol)
    assert run.ending.kind == "singular" and run.t.tolist() == [0, 1, 2]
    across = s.simulate([0, 3], tilt=[(0, 0.01)] * 2, engine=engine, tol=tol)
    assert across.axes[0, -1, 2] < 0


def test_a_trial_step_past_such_a_position_that_is_not_taken_is_forgotten() -> None:
    motion = exact_motion(Structure([(0, 0), (1, 0)], [(0, 1)], 0.0))
    watch, before, past = LineWatch(motion), np.array([0.9, 0, 0.4] * 2), np.array([0.9, 0, -0.4] * 2)
    watch.keep(0.0, before)
    watch.keep(1.0, past)
    watch.keep(0.5, before)
    watch.check()
    watch.keep(1.0, past)
    with pytest.raises(IntegrationError, match="near t = 1 s"):
        watch.check()
