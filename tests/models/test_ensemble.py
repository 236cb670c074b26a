"""Ensembles: each trajectory as `simulate` has it, in any executor, and an interrupted sweep goes on."""

import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, simulate, sweep
from lagrotor.benchmark.throughput import displaced_family
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.models.minimal import MODEL, scenes_from_states
from lagrotor.models.model import natural_units
from lagrotor.models.sweeps import chunk
from lagrotor.models.sweeps.chunk import MODELS
from lagrotor.models.sweeps.natural_columns import NaturalColumns, kind_of_number
from lagrotor.models.sweeps.scene_columns import SceneColumns

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

    monkeypatch.setattr(chunk, "simulate", stopped)
    found = sweep([Scene((1.0, 1.0), link=None), *family(1)], [0.0, 1.0])
    assert [MODELS[m] for m in found.models] == ["none", "minimal"]
    assert np.isnan(found.axes[0]).all()
    assert np.isfinite(found.axes[1]).all()
    with pytest.raises(InputError, match=r"the run of scene 0 ended before the first time of t: .*it stops"):
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
    made = chunk._swarm

    def weaker(kind, columns, members):
        return made(kind, columns, [replace(s, shock=replace(s.shock, force=(4.9, -2.0, 1.0))) for s in members])

    monkeypatch.setattr(chunk, "_swarm", weaker)
    again = sweep(scenes, T, 1e-8)  # what the check refuses is run alone
    assert [MODELS[m] for m in again.models] == ["spheres"] * 3 and (again.evaluations > kept.evaluations).all()
    np.testing.assert_allclose(again.axes, kept.axes, atol=1e-7)
    monkeypatch.setattr(
        "lagrotor.models.simulate.conservation_defect", lambda *given: np.zeros(1)
    )  # twin: nothing is checked
    wrong = sweep(scenes, T, 1e-8)
    assert np.abs(wrong.axes - kept.axes).max() > 1e-4 > (wrong.error).max()


def wide(count=12):
    """Scenes with bars of every kind and random starts, without a shock, in which one run takes about ten turns."""
    rng, scenes = np.random.default_rng(5), []
    for i in range(count):
        length = (0.6, 1.0, 1.7)[i % 3]
        link = Link(length, 0.4, rng.uniform(0, 0.4) * length**2 / 3) if i % 2 else Link(length)
        spins = (8.0, -8.0) if i % 4 == 0 else tuple(rng.uniform(6, 15, 2) * rng.choice([-1, 1], 2))
        scenes += scenes_from_states(Scene(spins, link=link), STATE * rng.uniform(0.1, 1.2, (1, 6)))
    return scenes


@pytest.mark.parametrize("engine", ["core", "fast"])
def test_neighbours_in_a_chunk_change_no_bit_of_a_run(engine):
    if engine == "fast":
        pytest.importorskip("heyoka", reason="the fast extra is not installed")
    scenes = [*(mixed() if engine == "core" else []), *wide()]
    together = sweep(scenes, T, 1e-8, engine=engine)
    backwards = sweep(scenes[::-1], T, 1e-8, engine=engine, chunk=5)
    alone = [sweep([scene], T, 1e-8, engine=engine) for scene in scenes[::4]]
    for name in ("axes", "rates", "errors", "evaluations", "models"):
        values = getattr(together, name)
        assert np.array_equal(values, getattr(backwards, name)[::-1]), name
        assert np.array_equal(values[::4], np.concatenate([getattr(one, name) for one in alone])), name


def test_runs_that_are_compared_at_once_are_those_of_one_estimate_each(monkeypatch):
    """Three of the last scenes need a second pair. At 1e-13 no pair keeps the tolerance, and the best one is taken."""
    legs, marched, settle = [], chunk._march, chunk._settle
    monkeypatch.setattr(chunk, "_march", lambda *given: legs.append(len(given[2].times)) or marched(*given))
    for scenes, t, tol in ((wide(), T, 1e-6), (wide(), T, 1e-13), (displaced_family(12), [0.0, 10.0], 1e-5)):
        legs.clear()
        monkeypatch.setattr(chunk, "_settle", settle)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LagrotorWarning)
            at_once = sweep(scenes, t, tol)
            monkeypatch.setattr(chunk, "_settle", lambda kind, *others: np.zeros(len(others[-1]), bool))
            one_by_one = sweep(scenes, t, tol)
        np.testing.assert_array_equal(at_once.models, one_by_one.models)
        np.testing.assert_array_equal(at_once.evaluations, one_by_one.evaluations)
        np.testing.assert_allclose(at_once.errors, one_by_one.errors, rtol=0.01 if tol > 1e-9 else 1)
        np.testing.assert_allclose(at_once.axes, one_by_one.axes, atol=tol)
    assert legs == [24, 3]


def test_no_scene_is_made_for_a_run_that_keeps_the_tolerance(monkeypatch):
    made, columns, check = [], SceneColumns.of_scenes([*wide(), mixed()[6]]), Scene.__post_init__
    monkeypatch.setattr(Scene, "__post_init__", lambda scene: made.append(scene) or check(scene))
    found = sweep(columns.take(np.arange(12)), T, 1e-8)
    assert not made and (found.error <= 1e-8).all()
    assert found.scenes[3].spins and len(made) == 1
    sweep(columns, T, 1e-8)  # twin: one has a shock
    assert len(made) > 1


def test_scenes_have_the_same_natural_units_alone_and_as_arrays():
    scenes = [*wide(), Scene((0.0, 0.0))]
    many = NaturalColumns.of(SceneColumns.of_scenes(scenes))
    for i, scene in enumerate(scenes):
        one = natural_units(scene)
        kind, values = MODEL.kind(one.scene, False)
        assert kind_of_number(many.kinds[i]) == kind
        assert many.rate[i] == pytest.approx(one.rate, rel=1e-14)
        np.testing.assert_allclose(many.take(np.array([i])).parameters(kind)[:, 0], values, rtol=1e-13, atol=1e-13)
        starts, errors, conditioned = many.take(np.array([i])).starts(kind)
        np.testing.assert_allclose(starts[0], MODEL.start(one.scene), rtol=1e-12, atol=1e-14)
        assert conditioned.all() and errors[0] >= 1
