"""Ensembles: each trajectory as `simulate` has it, in any executor, and an interrupted sweep goes on."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, simulate, sweep
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.models.minimal import scenes_from_states
from lagrotor.models.sweeps import ensemble
from lagrotor.models.sweeps.ensemble import MODELS

T = np.array([0.0, 0.4, 1.0, 2.5])
STATE = np.array([0.1, 0.05, 0.02, 0.3, 1.2, -0.4])


def family(n, scene=None):
    return scenes_from_states(scene or Scene((10.0, -10.0)), STATE * np.linspace(0.3, 1.5, n)[:, None])


def mixed():
    """One scene of each kind: every bar, with and without shock, without bar, and one that starts on the joint line."""
    scenes = [
        family(1, Scene(spins, link=Link(length, *bar)))[0]
        for spins, length in (((10.0, -10.0), 0.6), ((7.0, 3.0), 1.0), ((10.0, -10.0), 1.7))
        for bar in ((0.0, 0.0), (0.3, 0.1))
    ]
    scenes += [replace(s, shock=Shock((5.0, -2.0, 1.0), 0.6, 0.03, body)) for s in scenes[::2] for body in (1, 2)]
    scenes.append(Scene((10.0, -4.0), link=None, rates=((0.5, 0.2, 0.0), (0.0, 0.0, 0.0))))
    return scenes


def test_every_trajectory_is_that_of_simulate():
    tol = 1e-9
    scenes = mixed()
    found = sweep(scenes, T, tol, chunk=7)
    for i, scene in enumerate(scenes):
        expected = simulate(scene, T, "minimal" if scene.link else "spheres", tol)
        np.testing.assert_allclose(found.axes[i], expected.axes, atol=20 * tol)
        np.testing.assert_allclose(found.rates[i], expected.rates, atol=400 * tol)
        run = found.trajectory(i)
        np.testing.assert_allclose(run.energy, expected.energy, rtol=100 * tol)
        assert MODELS[found.models[i]] == run.model == expected.model


def test_a_sweep_that_is_read_at_its_start_alone_gives_the_starts():
    scenes = mixed()
    alone = sweep(scenes, [1.5])
    starts = np.array([scene.axes for scene in scenes], float)
    np.testing.assert_allclose(alone.axes[:, :, 0], starts, atol=1e-13)
    assert (alone.error <= 1e-6).all() and not alone.failed.size


def test_what_minimal_loses_spheres_finishes():
    """An axis driven onto the joint line: the minimal model ends there."""
    scene = Scene((0.0, 0.0), rates=((0.3, 1.0, 0.0), (0.3, -0.6, 0.0)))
    found = sweep([scene, *family(2)], [0.0, 1.0, 2.0], 1e-8)
    assert [MODELS[m] for m in found.models] == ["spheres", "minimal", "minimal"]
    assert np.isfinite(found.axes).all()


def test_what_nothing_finishes_is_nan(monkeypatch):
    from lagrotor.errors import IntegrationError

    def stopped(*arguments):
        raise IntegrationError("it stops")

    monkeypatch.setattr(ensemble, "simulate", stopped)
    found = sweep([Scene((1.0, 1.0), link=None), *family(1)], [0.0, 1.0])
    assert [MODELS[m] for m in found.models] == ["none", "minimal"]
    assert np.isnan(found.axes[0]).all()
    assert np.isfinite(found.axes[1]).all()
    with pytest.raises(InputError, match=r"the run of scene 0 reached no time: .*it stops"):
        found.trajectory(0)


@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_any_executor(kind):
    scenes, seen = family(10), []
    here = sweep(scenes, T)
    with kind(2) as executor:
        there = sweep(scenes, T, chunk=3, executor=executor, progress=lambda done, n: seen.append((done, n)))
    np.testing.assert_allclose(there.axes, here.axes, atol=1e-9)
    assert seen[-1] == (10, 10)
    assert len(seen) == 4


def test_the_fast_extra_runs_the_same_ensemble():
    """Lanes are filled up where their number does not divide the ensemble's; each keeps its own motion."""
    pytest.importorskip("heyoka", reason="the fast extra is not installed")
    scenes = [scene for scene in mixed() if not scene.shock] + family(11)
    core, fast = (sweep(scenes, T, 1e-10, engine=engine) for engine in ("core", "fast"))
    np.testing.assert_allclose(fast.axes, core.axes, atol=1e-8)
    np.testing.assert_allclose(fast.rates, core.rates, atol=1e-7)
    assert (fast.models == core.models).all() and (fast.evaluations > 0).all()
    assert np.abs(fast.axes[-1] - fast.axes[-2]).max() > 1e-2  # twin: one lane is not another


def test_what_nothing_can_finish_is_what_was_reached_with_its_ending():
    """Without spin a shock lays bar and axes in line: no model goes through that."""
    falling, t = Scene((0.0, 0.0), shock=Shock((40.0, 0.0, 0.0), 2.5, 0.05)), [2.0, 2.1, 7.0, 32.0]
    with pytest.warns(LagrotorWarning, match="1 of 2 runs do not keep"):
        found = sweep([family(1)[0], falling], t)
    assert found.failed.tolist() == [1] and np.isfinite(found.axes[0]).all()
    assert np.isfinite(found.axes[1, :, :2]).all() and np.isnan(found.axes[1, :, 2:]).all()
    ending, run = found.endings[1], found.trajectory(1)
    assert ending.kind == "singular" and 2.1 < ending.at < 7 and run.ending == ending
    assert run.t.tolist() == t[:2] and run.error < 1e-5 and np.isnan(found.error[1])
    assert found.endings[0].kind == "end" and found.trajectory(0).t.tolist() == t  # twin


def test_a_sweep_holds_its_runs_to_the_work_of_their_shocks(monkeypatch):
    """Each scene's shock is a run's own: one that is given another force conserves, but not what it must."""
    scenes = [replace(s, shock=Shock((5.0, -2.0, 1.0), 0.6, 0.03)) for s in family(3)]
    kept = sweep(scenes, T, 1e-8)
    assert [MODELS[m] for m in kept.models] == ["minimal"] * 3
    made = ensemble._swarm

    def weaker(kind, members, columns):
        return made(kind, [replace(s, shock=replace(s.shock, force=(4.9, -2.0, 1.0))) for s in members], columns)

    monkeypatch.setattr(ensemble, "_swarm", weaker)
    again = sweep(scenes, T, 1e-8)  # what the check refuses is run alone
    assert [MODELS[m] for m in again.models] == ["spheres"] * 3 and (again.evaluations > kept.evaluations).all()
    np.testing.assert_allclose(again.axes, kept.axes, atol=1e-7)
    monkeypatch.setattr("lagrotor.models.simulate.conservation_defect", lambda *given: 0.0)  # twin: nothing is checked
    wrong = sweep(scenes, T, 1e-8)
    assert np.abs(wrong.axes - kept.axes).max() > 1e-4 > (wrong.error).max()
