"""A sweep in processes and on a dask cluster: the same bits, workers that are killed, interrupts."""

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from lagrotor import Sweep, sweep
from lagrotor.errors import IntegrationError
from lagrotor.models import Ensemble
from lagrotor.models.sweeps.executors import Pool, completed, process_pool
from tests.models.sweep_family import T, assert_same_bits, family

SCENES, CHUNK = family(14), 2  # 7 chunks
ROOT = Path(__file__).parents[2]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT)}


@pytest.fixture(scope="module")
def expected() -> Ensemble:
    return sweep(SCENES, T, chunk=CHUNK)


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as made:
        yield made


def test_processes_give_the_same_bits_and_end(expected: Ensemble) -> None:
    before = set(multiprocessing.active_children())
    assert_same_bits(sweep(SCENES, T, chunk=CHUNK, executor="processes"), expected)
    assert set(multiprocessing.active_children()) <= before


def test_a_pool_that_loses_a_process_says_how_to_go_on(tmp_path: Path, expected: Ensemble) -> None:
    def run_and_kill() -> None:
        with process_pool(1) as pool:

            def kill(done: int, total: int | None) -> None:
                for process in pool._processes.values():
                    process.kill()

            sweep(SCENES, T, chunk=CHUNK, executor=pool, folder=tmp_path, progress=kill)

    with pytest.raises(IntegrationError, match=r"lost its workers \(.*with folder= the same call goes on"):
        run_and_kill()
    assert 2 <= len(Sweep.open(tmp_path)) < 14
    assert_same_bits(sweep(SCENES, T, chunk=CHUNK, folder=tmp_path), expected)


GUARDLESS = """
from lagrotor import sweep
sweep({"spins": (10, -10)}, [0, 1], executor="processes")
"""


def test_a_script_without_a_guard_is_told_so(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(GUARDLESS)
    done = subprocess.run([sys.executable, script], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "if __name__ == '__main__'" in done.stderr.splitlines()[-1]


def test_an_exception_ends_the_pool_at_once() -> None:
    def interrupt() -> None:
        with process_pool(1) as pool:
            pool.submit(time.sleep, 600)
            raise KeyboardInterrupt

    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        interrupt()
    assert time.perf_counter() - began < 300, "it does not wait for the task"


def alive(pid: int) -> bool:
    with suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    return False


ORPHAN = """
import os, pathlib, signal, sys, time
from lagrotor.models.sweeps.executors import process_pool
if __name__ == "__main__":
    with process_pool(1) as pool:
        pathlib.Path(sys.argv[1]).write_text(str(pool.submit(os.getpid).result()))
        pool.submit(time.sleep, 600)
        time.sleep(0.2)
        os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="the system has no /proc")
def test_a_worker_ends_with_its_parent(tmp_path: Path) -> None:
    file = tmp_path / "pid"
    subprocess.run([sys.executable, "-c", ORPHAN, file], env=ENVIRONMENT, check=False)
    worker = int(file.read_text())
    for _ in range(600):
        if not alive(worker):
            return
        time.sleep(0.1)
    os.kill(worker, signal.SIGKILL)
    pytest.fail("the worker outlives its parent")


class Slow(ThreadPoolExecutor):
    """An executor that finishes tasks in the reverse order of their submission, when four are waiting."""

    waiting: list[tuple[Future[Any], int]]

    def submit(self, function: Any, /, *arguments: Any, **_: Any) -> Any:
        future: Future[Any] = Future()
        self.waiting.append((future, *arguments))
        if len(self.waiting) == 4 or arguments == (9,):
            while self.waiting:
                last, n = self.waiting.pop()
                last.set_result(function(n))
        return future


def test_tasks_are_taken_when_there_is_room_and_any_order_will_do() -> None:
    pool, taken, done = Slow(), list[int](), dict[str, int]()
    pool.waiting = []
    tasks = ((f"task {n}", (taken.append(n) or n,)) for n in range(10))  # type: ignore[func-returns-value]
    for key, value in completed(abs, tasks, Pool(pool, lambda: 2)):
        assert len(taken) - len(done) <= 3 * 2
        done[key] = value
    assert done == {f"task {n}": n for n in range(10)}


def test_a_cluster_gives_the_same_bits_though_a_worker_is_killed(
    cluster: Any, tmp_path: Path, expected: Ensemble
) -> None:
    from distributed import Client

    killed = list[int]()

    def kill(done: int, total: int | None) -> None:
        if not killed:
            killed.append(next(iter(cluster.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    with Client(cluster) as client:
        assert_same_bits(sweep(SCENES, T, chunk=CHUNK, executor=client, folder=tmp_path, progress=kill), expected)
        assert killed
        assert_same_bits(sweep(SCENES, T, chunk=CHUNK, executor=client.get_executor()), expected)


CLIENT = """
import os, signal, sys
from distributed import Client
from lagrotor import sweep
from tests.models.sweep_family import T, family
kill = lambda done, n: os.kill(os.getpid(), signal.SIGKILL) if done == 6 else None
sweep(family(14), T, chunk=2, folder=sys.argv[2], executor=Client(sys.argv[1]), progress=kill)
"""


def test_a_killed_client_leaves_chunks_from_which_another_goes_on(
    cluster: Any, tmp_path: Path, expected: Ensemble
) -> None:
    from distributed import Client

    argv = [sys.executable, "-c", CLIENT, cluster.scheduler_address, str(tmp_path)]
    assert subprocess.run(argv, env=ENVIRONMENT, check=False).returncode == -signal.SIGKILL
    seen = list[int]()
    with Client(cluster) as client:
        runs = sweep(SCENES, T, chunk=2, folder=tmp_path, executor=client, progress=lambda done, n: seen.append(done))
    assert_same_bits(runs, expected)


def test_a_lost_cluster_is_said(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    made = distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0")
    client = distributed.Client(made)

    with made, client, pytest.raises(IntegrationError, match=r"lost its workers"):
        sweep(SCENES, T, chunk=CHUNK, executor=client, folder=tmp_path, progress=lambda done, total: made.close())
    assert len(Sweep.open(tmp_path)) >= 2
