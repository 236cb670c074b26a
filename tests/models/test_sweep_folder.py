"""A sweep in a folder: the same bits as in memory, resumed after any interruption, read as memory maps."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagrotor import Scene, Shock, Sweep, sweep
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.models import Ensemble
from lagrotor.models.sweeps import sweep as sweep_module
from lagrotor.models.sweeps import sweep_folder
from tests.models.sweep_family import T, assert_same_bits, columns_of, family

SCENES, CHUNK = family(14), 3  # 5 chunks
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def expected() -> Ensemble:
    return sweep(SCENES, T, chunk=CHUNK)


@pytest.fixture
def runs_of_chunks(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The numbers of scenes of the chunks that are run, instead of read."""
    seen, run = list[int](), sweep_module.run_chunk

    def counted(scenes: Any, *arguments: Any) -> Any:
        seen.append(len(scenes))
        return run(scenes, *arguments)

    monkeypatch.setattr(sweep_module, "run_chunk", counted)
    return seen


def swept(folder: Path, scenes: Any = SCENES, **options: Any) -> Sweep:
    runs = sweep(scenes, T, chunk=CHUNK, folder=folder, **options)
    assert isinstance(runs, Sweep)
    return runs


def stop_after(runs: int) -> Callable[[int, int | None], None]:
    def progress(done: int, total: int | None) -> None:
        if done >= runs:
            raise KeyboardInterrupt

    return progress


def test_a_folder_has_the_bits_of_memory_as_memory_maps_and_as_files_of_numpy(
    tmp_path: Path, expected: Ensemble, runs_of_chunks: list[int]
) -> None:
    runs = swept(tmp_path / "below" / "out")
    for each in (runs, Sweep.open(tmp_path / "below/out"), swept(tmp_path / "below" / "out")):
        assert_same_bits(each, expected)
    assert len(runs_of_chunks) == 5  # and none by the second call
    assert all(isinstance(getattr(runs, name), np.memmap) for name in ("axes", "rates", "errors", "models"))
    for name in ("axes", "errors", "evaluations"):
        np.testing.assert_array_equal(np.load(tmp_path / f"below/out/{name}.npy"), getattr(expected, name))
    assert runs.summary() == {"folder": str(tmp_path / "below/out")} | expected.summary()
    assert len(runs) == 14 and [run.model for run in runs] == [run.model for run in expected]
    assert runs.scenes[1:3] == tuple(SCENES[1:3]) and runs.endings[-2:] == (expected.endings[12], expected.endings[13])
    assert runs.scenes[2] == SCENES[2] and runs.trajectory(5).error == expected.trajectory(5).error


def test_an_interrupted_sweep_opens_as_far_as_it_came_and_goes_on(
    tmp_path: Path, expected: Ensemble, runs_of_chunks: list[int]
) -> None:
    with pytest.raises(KeyboardInterrupt):
        swept(tmp_path, progress=stop_after(6))
    part = Sweep.open(tmp_path)
    assert len(part) == 6 and part.summary()["runs"] == "6 of 14"
    np.testing.assert_array_equal(part.axes, expected.axes[:6])
    assert len(np.load(tmp_path / "axes.npy")) == 6
    seen = list[int]()
    assert_same_bits(swept(tmp_path, progress=lambda done, n: seen.append(done)), expected)
    assert runs_of_chunks == [3, 3, 3, 3, 2] and seen == [3, 6, 9, 12, 14]


KILLED = """
import os, signal, sys
from lagrotor import sweep
from tests.models.sweep_family import T, family
kill = lambda done, n: os.kill(os.getpid(), signal.SIGKILL) if done == 9 else None
sweep(family(14), T, chunk=3, folder=sys.argv[1], progress=kill)
"""


def test_a_killed_process_leaves_whole_chunks(tmp_path: Path, expected: Ensemble, runs_of_chunks: list[int]) -> None:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], env=environment, check=False)
    assert done.returncode == -signal.SIGKILL and len(Sweep.open(tmp_path)) == 9
    assert_same_bits(swept(tmp_path), expected)
    assert runs_of_chunks == [3, 2]


def cut(file: Path, count: int) -> None:
    with file.open("r+b") as opened:
        opened.truncate(file.stat().st_size + count)


def flip(file: Path, at: int) -> None:
    with file.open("r+b") as opened:
        opened.seek(at, os.SEEK_END)
        byte = opened.read(1)
        opened.seek(at, os.SEEK_END)
        opened.write(bytes([byte[0] ^ 1]))


# What is done to the folder of a finished sweep, and the sizes of the chunks that are run again.
DAMAGE: dict[str, tuple[Callable[[Path], object], list[int]]] = {
    "nothing": (lambda folder: None, []),
    "a result cut short": (lambda folder: cut(folder / "axes.npy", -1), [2]),
    "more than a chunk cut off": (lambda folder: cut(folder / "rates.npy", -5 * 2 * 3 * 3 * 8), [3, 2]),
    "a bit of a result": (lambda folder: flip(folder / "errors.npy", -3 * 3 * 8), [3]),
    "a bit of a scene": (lambda folder: flip(folder / "scene_spins.npy", -1), [2]),
    "a file lost": (lambda folder: (folder / "models.npy").unlink(), [3, 3, 3, 3, 2]),
    "the last line cut short": (lambda folder: cut(folder / "chunks.jsonl", -9), [2]),
    "all lines lost": (lambda folder: (folder / "chunks.jsonl").unlink(), [3, 3, 3, 3, 2]),
    "a left-over of an interrupted write": (lambda folder: (folder / ".sweep.json.x").touch(), []),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_a_damaged_chunk_is_run_again(name: str, tmp_path: Path, expected: Ensemble, runs_of_chunks: list[int]) -> None:
    swept(tmp_path)
    runs_of_chunks.clear()
    damage, again = DAMAGE[name]
    damage(tmp_path)
    assert_same_bits(swept(tmp_path), expected)
    assert runs_of_chunks == again
    swept(tmp_path)
    assert runs_of_chunks == again, "the second time everything is there"


def test_a_damaged_folder_is_not_opened(tmp_path: Path) -> None:
    swept(tmp_path)
    cut(tmp_path / "axes.npy", -1)
    with pytest.raises(InputError, match=r"axes\.npy is missing or cut short: the call of the sweep computes it again"):
        Sweep.open(tmp_path)
    for name, text in (("a", ""), ("b", "{}"), ("c", '{"format": 2, "t": [0]}'), ("d", "no JSON")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "sweep.json").write_text(text)
        with pytest.raises(InputError, match="describes no sweep"):
            Sweep.open(tmp_path / name)
    with pytest.raises(InputError, match="No such file"):
        Sweep.open(tmp_path / "nowhere")
    with pytest.raises(KeyboardInterrupt):
        swept(tmp_path / "begun", progress=stop_after(0), executor=Refusing())
    with pytest.raises(InputError, match=r"no chunk of .* is finished"):
        Sweep.open(tmp_path / "begun")


class Refusing(ThreadPoolExecutor):
    """An executor in which nothing is submitted: it is interrupted before."""

    def submit(self, *arguments: Any, **options: Any) -> Any:
        raise KeyboardInterrupt


def test_every_worker_has_a_chunk_and_a_resumed_sweep_keeps_its_chunks(
    tmp_path: Path, expected: Ensemble, runs_of_chunks: list[int]
) -> None:
    with ThreadPoolExecutor(7) as executor:
        sweep(SCENES, T, folder=tmp_path, executor=executor)
        assert runs_of_chunks == [2] * 7
        sweep(iter(SCENES), T, executor=executor)  # of unknown length
        assert runs_of_chunks[7:] == [14]
    assert_same_bits(sweep(SCENES, T, folder=tmp_path), expected)
    assert len(runs_of_chunks) == 8


ANOTHER: dict[str, tuple[dict[str, Any], str]] = {
    "tolerance": ({"tol": 1e-7}, "tol = 1e-06, not 1e-07"),
    "times": ({"t": [0.0, 0.3]}, "t differs"),
    "chunk": ({"chunk": 4}, "chunk = 3, not 4"),
    "fewer scenes": ({"scenes": SCENES[:-1]}, "runs = 14, not 13"),
    "another scene": ({"scenes": [*SCENES[:-1], SCENES[0]]}, "scenes differs"),
    "an iterator": ({"scenes": iter(SCENES)}, "scenes differs"),
}


@pytest.mark.parametrize("name", ANOTHER)
def test_the_folder_of_another_sweep_is_refused(name: str, tmp_path: Path, expected: Ensemble) -> None:
    swept(tmp_path)
    options, says = ANOTHER[name]
    with pytest.raises(InputError, match=f"has another sweep: {says}; give another folder"):
        sweep(**({"scenes": SCENES, "t": T, "chunk": CHUNK, "folder": tmp_path} | options))
    assert_same_bits(Sweep.open(tmp_path), expected)


def test_another_version_and_foreign_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    swept(tmp_path / "out")
    monkeypatch.setattr(sweep_folder, "__version__", "0.0")
    with pytest.raises(InputError, match=r"another sweep: lagrotor = .*, not 0\.0"):
        swept(tmp_path / "out")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.tex").touch()
    with pytest.raises(InputError, match=r"has other files \(thesis\.tex\): give a new folder"):
        swept(tmp_path / "mine")
    with pytest.raises(InputError, match=r"File exists|Not a directory"):
        swept(tmp_path / "mine" / "thesis.tex")
    with pytest.raises(InputError, match="folder = 5 must be a path"):
        sweep(SCENES, T, folder=5)  # type: ignore[arg-type]
    assert os.listdir(tmp_path / "mine") == ["thesis.tex"]


def test_an_iterator_is_taken_as_far_as_chunks_are_in_flight(tmp_path: Path, expected: Ensemble) -> None:
    """With one worker at most three chunks are ahead of those that are written. A second call takes up the rest."""
    taken, ahead = 0, list[int]()

    def chunks() -> Iterator[list[Scene]]:
        nonlocal taken
        for first in range(0, 14, 2):
            taken += 2
            yield SCENES[first : first + 2]

    def progress(done: int, total: int | None) -> None:
        ahead.append(taken - done)
        assert total is None
        if done == 4:
            raise KeyboardInterrupt

    with ThreadPoolExecutor(1) as executor, pytest.raises(KeyboardInterrupt):
        sweep(chunks(), T, folder=tmp_path, executor=executor, progress=progress)
    assert max(ahead) <= 3 * 2 < 14
    assert len(Sweep.open(tmp_path)) == 4 and Sweep.open(tmp_path).summary()["runs"] == "4 of an unknown number"
    with pytest.raises(InputError, match="its scenes from number 2 on are others"):
        sweep(iter([SCENES[:2], SCENES[4:6]]), T, folder=tmp_path)
    with pytest.raises(InputError, match="it has more than 2 runs"):
        sweep(iter([SCENES[:2]]), T, folder=tmp_path)
    runs = sweep(chunks(), T, folder=tmp_path)
    np.testing.assert_allclose(runs.axes, expected.axes, atol=1e-6)
    assert runs.summary()["runs"] == "14" and json.loads((tmp_path / "sweep.json").read_text())["runs"] == 14


def test_a_run_that_ends_early_keeps_its_ending_in_the_folder(tmp_path: Path) -> None:
    falling = Scene((0.0, 0.0), shock=Shock((40.0, 0.0, 0.0), 0.5, 0.05))
    scenes, t = [*SCENES[:4], falling, SCENES[4]], [0.0, 0.1, 5.0, 30.0]
    for folder in (None, tmp_path):
        with pytest.warns(LagrotorWarning, match="1 of 6 runs do not keep"):
            runs = sweep(scenes, t, chunk=2, folder=folder)
        assert runs.failed.tolist() == [4] and runs.endings[4].kind == "singular" and runs.endings[4].reason
        assert runs.trajectory(4).ending == runs.endings[4] == runs.endings[-2] and len(runs.trajectory(4).t) == 2
        if folder is None:
            expected = columns_of(runs)
    np.testing.assert_array_equal(columns_of(Sweep.open(tmp_path))["endings"], expected["endings"])


def test_a_full_disk_is_said_and_the_call_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, expected: Ensemble
) -> None:
    store = sweep_folder.FolderStore.write

    def full(self: Any, first: int, *arguments: Any) -> None:
        if first == 6:
            self.files["rates"] = open("/dev/full", "wb")  # noqa: SIM115
        store(self, first, *arguments)

    if not Path("/dev/full").exists():
        pytest.skip("the system has no /dev/full")
    with monkeypatch.context() as patch:
        patch.setattr(sweep_folder.FolderStore, "write", full)
        with pytest.raises(InputError, match=r"No space left on device: the chunks that are finished stay; make room"):
            swept(tmp_path)
    assert len(Sweep.open(tmp_path)) == 6
    assert_same_bits(swept(tmp_path), expected)


def test_a_dataset_is_lazy_and_whole(tmp_path: Path, expected: Ensemble) -> None:
    for name in ("xarray", "dask"):
        pytest.importorskip(name, reason="the extras `notebook` and `cluster` are not installed")
    runs = swept(tmp_path)
    lazy, whole = runs.to_xarray(), expected.to_xarray()
    assert all(type(lazy[name].data).__module__.startswith("dask") for name in lazy.data_vars)
    assert lazy.identical(whole) and lazy.axes.dims == ("run", "rotor", "t", "component")
    assert lazy.rates.units == "1/s" and lazy.model.flag_meanings == "minimal spheres none"
    assert lazy.shock_force_x.units == "N" and lazy.rotor_I1.units == "kg m²" and lazy.shock_at.units == "s"
    graph = sum(len(str(value)) for value in dict(lazy.axes.data.dask).values())
    assert graph < 2000, "the graph has the name of the file, not its numbers"
