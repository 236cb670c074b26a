"""Ensembles: each trajectory as `simulate` has it, in any executor, and an interrupted sweep goes on."""

import shutil
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene, simulate, sweep
from lagrotor.errors import InputError, LagrotorWarning, SingularError
from lagrotor.files import read_arrays, write_arrays
from lagrotor.models import spheres
from lagrotor.models.minimal import MODEL, scenes_from_states
from lagrotor.models.model import integrate_model, natural_units, typical_rate
from lagrotor.models.sweeps import ensemble
from lagrotor.models.sweeps.ensemble import MODELS, run_chunk

T = np.array([0.0, 0.4, 1.0, 2.5])
UP = ((0, 0, 1), (0, 0, 1))
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


def test_the_error_falls_with_the_tolerance():
    scenes = family(40)
    exact = sweep(scenes, [0.0, 3.0], 1e-13)
    errors = [abs(sweep(scenes, [0.0, 3.0], tol).axes - exact.axes).max() for tol in (1e-4, 1e-6, 1e-8, 1e-10)]
    assert all(error < 20 * tol for error, tol in zip(errors, (1e-4, 1e-6, 1e-8, 1e-10), strict=True))
    assert errors == sorted(errors, reverse=True)


def test_evaluations_are_those_of_an_order_of_eight():
    scenes = family(40)
    spent = [sweep(scenes, [0.0, 3.0], tol).evaluations.mean() for tol in (1e-6, 1e-10)]
    assert spent[0] < 1500  # of two or three runs, each about 40 a radian of the natural rate in 3 s
    assert 10 ** (4 / 8) * 0.7 < spent[1] / spent[0] < 10 ** (4 / 8) * 1.3


@pytest.mark.parametrize(
    "scene",
    [
        Scene((60.0, -2.0), Rotor(I1=8.0), rates=((0.1, 0.0, 0.0), (0.1, 0.0, 0.0))),
        Scene((-2.0, 30.0), rates=((0.1, 0.0, 0.0), (0.1, 0.0, 0.0))),
        Scene((0.0, 0.0), rates=((0.0, 8.0, 0.0), (0.0, 1.0, 0.0))),
        Scene((0.0, 0.0), rates=((0.0, 1.0, 0.0), (0.0, 8.0, 0.0))),
        Scene((0.1, 0.1), Rotor(length=0.5), Link(0.5), shock=Shock((0.0, 30.0, 0.0), 0.5, 0.1)),
    ],
)
def test_the_estimated_rate_is_that_of_the_motion(scene):
    """Spins, start or shock alone: the spectrum or the largest rate, whichever is faster, within a factor of three."""
    t = np.linspace(0, 2, 801)
    run = simulate(scene, t, "minimal", 1e-9)
    turning = np.abs(np.gradient(run.rates, t, axis=1)).max() / np.abs(run.rates).max()
    seen = max(np.linalg.norm(run.rates, axis=-1).max(), turning)
    assert seen / 3 < typical_rate(scene) < 3 * seen


def test_a_short_shock_late_in_the_run_is_not_missed():
    scene = replace(family(1)[0], shock=Shock((4e6, 0.0, 0.0), 2.0, 1e-7))
    found, expected = sweep([scene], T, 1e-9), simulate(scene, T, "minimal", 1e-9)
    np.testing.assert_allclose(found.axes[0], expected.axes, atol=1e-7)


def test_what_minimal_loses_spheres_finishes():
    """An axis driven onto the joint line: the minimal model ends there."""
    scene = Scene((0.0, 0.0), rates=((0.3, 1.0, 0.0), (0.3, -0.6, 0.0)))
    found = sweep([scene, *family(2)], [0.0, 1.0, 2.0], 1e-8)
    assert [MODELS[m] for m in found.models] == ["spheres", "minimal", "minimal"]
    assert np.isfinite(found.axes).all()


def test_a_start_on_the_joint_line_is_left_to_spheres_and_one_across_it_is_not():
    """The minimal model has no coordinates for an axis along x; along y it has."""
    along, across = (Scene((1.0, 2.0), axes=axes) for axes in (((1, 0, 0), (0, 0, 1)), ((0, 1, 0), (0, 1, 0))))
    found = sweep([along, across], [0.0, 0.1], 1e-6)
    assert [MODELS[m] for m in found.models] == ["spheres", "minimal"]


def test_what_nothing_finishes_is_nan(monkeypatch):
    from lagrotor.errors import IntegrationError

    def stopped(*arguments):
        raise IntegrationError("it stops")

    monkeypatch.setattr(ensemble, "simulate", stopped)
    found = sweep([Scene((1.0, 1.0), link=None), *family(1)], [0.0, 1.0])
    assert [MODELS[m] for m in found.models] == ["none", "minimal"]
    assert np.isnan(found.axes[0]).all()
    assert np.isfinite(found.axes[1]).all()
    with pytest.raises(InputError, match=r"of scene 0 nothing was reached: .*it stops"):
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


@pytest.mark.slow
def test_a_cluster():
    distributed = pytest.importorskip("distributed", reason="dask is not installed: pip install 'lagrotor[cluster]'")
    scenes = family(10)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        there = sweep(scenes, T, chunk=3, executor=client.get_executor())
    np.testing.assert_allclose(there.axes, sweep(scenes, T).axes, atol=1e-9)


def test_an_interrupted_sweep_goes_on(tmp_path, monkeypatch):
    scenes, ran = family(10), []

    def counted(part, times, tol, engine: str):
        ran.append(len(part))
        return run_chunk(part, times, tol, engine)

    def stop(done, n):
        if done >= 6:
            raise KeyboardInterrupt

    monkeypatch.setattr(ensemble, "run_chunk", counted)
    with pytest.raises(KeyboardInterrupt):
        sweep(scenes, T, chunk=3, folder=tmp_path, progress=stop)
    assert ran == [3, 3]
    assert len(list(tmp_path.glob("chunk-*.npz"))) == 2
    again = sweep(scenes, T, chunk=3, folder=tmp_path)
    assert ran == [3, 3, 3, 1]
    np.testing.assert_array_equal(again.axes, sweep(scenes, T, chunk=3).axes)
    sweep(scenes, T, chunk=3, folder=tmp_path)
    assert len(ran) == 8  # four by the sweep without a folder, none by this one


def test_a_folder_of_another_sweep_is_refused(tmp_path):
    sweep(family(2), T, folder=tmp_path)
    with pytest.raises(InputError, match="another sweep"):
        sweep(family(3), T, folder=tmp_path)
    with pytest.raises(InputError, match="no folder"):
        sweep(family(2), T, folder=tmp_path / "none")


@pytest.mark.parametrize(
    ("scenes", "more"),
    [([], {}), ([1.0], {}), (None, {"chunk": 0}), (None, {"chunk": True}), (None, {"tol": 1.0})],
)
def test_bad_arguments(scenes, more):
    with pytest.raises(InputError):
        sweep(family(1) if scenes is None else scenes, T, **more)


def test_started_keeps_the_states():
    scenes = scenes_from_states(Scene((10.0, -10.0), link=Link(0.7)), [STATE, 2 * STATE])
    np.testing.assert_allclose([MODEL.start(s) for s in scenes], [STATE, 2 * STATE], atol=1e-14)
    with pytest.raises(InputError):
        scenes_from_states(Scene((1.0, 1.0)), STATE)
    with pytest.raises(SingularError):
        scenes_from_states(Scene((1.0, 1.0), link=None), [STATE])


def test_the_fast_extra_runs_the_same_ensemble():
    """Lanes are filled up where their number does not divide the ensemble's; each keeps its own motion."""
    pytest.importorskip("heyoka", reason="the fast extra is not installed")
    scenes = [scene for scene in mixed() if not scene.shock] + family(11)
    core, fast = (sweep(scenes, T, 1e-10, engine=engine) for engine in ("core", "fast"))
    np.testing.assert_allclose(fast.axes, core.axes, atol=1e-8)
    np.testing.assert_allclose(fast.rates, core.rates, atol=1e-7)
    assert (fast.models == core.models).all() and (fast.evaluations > 0).all()
    assert np.abs(fast.axes[-1] - fast.axes[-2]).max() > 1e-2  # twin: one lane is not another


def test_what_an_engine_does_not_do_is_refused_at_the_door():
    with pytest.raises(InputError, match="neither core nor fast"):
        sweep(family(2), T, engine="quick")
    with pytest.raises(InputError, match="takes no shock"):
        sweep([replace(family(1)[0], shock=Shock((1, 0, 0), 0.1, 0.1))], T, engine="fast")


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


@pytest.mark.slow  # thousands of steps up to the place; that runs fall back at all is tested above
def test_beside_a_singular_position_the_fallback_gives_all_it_has():
    scene = consistent_scene((10, -10), UP, ((-1.836, -1.934, 0), (-1.836, 1.934, 0)), link=Link(1, 0.01, 0.1))
    found, exact = sweep([scene], [0.0, 5.0, 10.0], 1e-6), simulate(scene, [0.0, 5.0, 10.0], "spheres", 1e-12)
    assert MODELS[found.models[0]] == "spheres"
    off = np.abs(found.axes[0] - exact.axes).max()
    assert off < found.error[0] < 1e-6
    # Twin: one integration with that local error does not keep it.
    units = natural_units(scene)
    once = integrate_model(spheres.MODEL, units.scene, np.array([0.0, 5.0, 10.0]) * units.rate, 1e-6)
    assert np.abs(spheres.MODEL.observe(units.scene, once.states).axes - exact.axes).max() > max(10 * off, 1e-6)


def other_shape(name, change):
    """The chunk with one array changed, its digest right for what it holds."""

    def spoil(file):
        about, held = read_arrays(file)
        del about["lagrotor"]
        write_arrays(file, about, held | {name: change(held[name])})

    return spoil


def one_nan(axes):
    axes[0, 0, 0, 0] = np.nan
    return axes


DAMAGES = {
    "no archive": lambda file: file.write_bytes(b"PK damaged"),
    "empty": lambda file: file.write_bytes(b""),
    "cut short": lambda file: file.write_bytes(file.read_bytes()[:-200]),
    "without digest": lambda file: np.savez(file, axes=np.zeros((2, 2, 4, 3))),
    "text": lambda file: np.savez(file, about="{}", axes=np.array([["a"]])),
    "one row, which would broadcast": other_shape("axes", lambda a: a[:1]),
    "fewer times": other_shape("rates", lambda a: a[:, :, :1]),
    "a NaN": other_shape("axes", one_nan),
    "no unit vectors": other_shape("axes", lambda a: 2 * a),
    "a model that is none": other_shape("models", lambda a: a + 7),
    "evaluations below zero": other_shape("evaluations", lambda a: a - 10**9),
    "evaluations that are no whole numbers": other_shape("evaluations", lambda a: a + 0.5),
}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A sweep of two chunks, and the folder that keeps them."""
    folder = tmp_path_factory.mktemp("swept")
    return sweep(family(4), T, chunk=2, folder=folder), folder


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_chunk_is_run_again(swept, tmp_path, damage):
    whole, folder = swept
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    file, good = tmp_path / "chunk-000001.npz", (tmp_path / "chunk-000001.npz").read_bytes()
    DAMAGES[damage](file)
    again = sweep(family(4), T, chunk=2, folder=tmp_path)
    for name in ("axes", "rates", "errors", "evaluations", "models"):
        np.testing.assert_array_equal(getattr(again, name), getattr(whole, name))
    assert read_arrays(file)[0] == read_arrays(tmp_path / "chunk-000000.npz")[0] | {"chunk": 1}
    assert len(file.read_bytes()) == len(good)


def test_a_chunk_of_another_sweep_or_place_is_no_result(tmp_path):
    (tmp_path / "a").mkdir(), (tmp_path / "b").mkdir()
    first = sweep(family(4), T, chunk=2, folder=tmp_path / "a")
    sweep(family(4, Scene((9.0, -9.0))), T, chunk=2, folder=tmp_path / "b")
    (tmp_path / "a" / "chunk-000001.npz").replace(tmp_path / "b" / "chunk-000001.npz")
    with pytest.raises(InputError, match=r"chunk-000001\.npz belongs to another sweep"):
        sweep(family(4, Scene((9.0, -9.0))), T, chunk=2, folder=tmp_path / "b")
    # Another place of the same sweep: it is run again.
    (tmp_path / "a" / "chunk-000001.npz").write_bytes((tmp_path / "a" / "chunk-000000.npz").read_bytes())
    np.testing.assert_array_equal(sweep(family(4), T, chunk=2, folder=tmp_path / "a").axes, first.axes)


@pytest.mark.parametrize("more", [{"tol": 1e-7}, {"chunk": 3}, {"t": [0.0, 0.4, 1.0, 2.6]}])
def test_a_sweep_with_other_arguments_does_not_take_the_chunks(tmp_path, more):
    sweep(family(4), T, 1e-6, chunk=2, folder=tmp_path)
    given = {"t": T, "tol": 1e-6, "chunk": 2} | more
    with pytest.raises(InputError, match="another sweep"):
        sweep(family(4), folder=tmp_path, **given)


def test_what_nothing_finished_is_kept_as_such(tmp_path, monkeypatch):
    falling = Scene((0.0, 0.0), shock=Shock((40.0, 0.0, 0.0), 0.5, 0.05))
    found = sweep([falling], [0.0, 5.0, 30.0], folder=tmp_path)
    monkeypatch.setattr(ensemble, "run_chunk", None)  # nothing is run again
    assert sweep([falling], [0.0, 5.0, 30.0], folder=tmp_path).failed.tolist() == found.failed.tolist() == [0]


def test_one_scene_is_no_sequence_of_scenes():
    with pytest.raises(InputError, match="a sequence of at least one Scene"):
        sweep(family(1)[0], T)


def test_scenes_at_rest_stay_there():
    found = sweep([Scene((0.0, 0.0)), *family(1)], T)
    assert (found.axes[0] == [0, 0, 1]).all() and found.error[0] < 1e-12 and found.endings[0].kind == "end"


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


def test_times_at_which_a_sweep_is_read_cost_little():
    """A step is read by its dense output; it used to end at each time."""
    few, many = (sweep(family(5), np.linspace(0, 2.5, n), 1e-8) for n in (2, 1001))
    assert (many.evaluations < 1.3 * few.evaluations).all()
    np.testing.assert_allclose(many.axes[:, :, [0, -1]], few.axes, atol=2e-8)
