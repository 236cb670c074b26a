"""The command sweep: a folder that is resumed, processes, a cluster."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Scene, Sweep, paired_scene, sweep
from lagrotor.commands.command_line import main
from tests.models.sweep_family import assert_same_bits

ROOT = Path(__file__).parents[2]
VARIED = ["sweep", "--spins", "10", "-10", "--vary", "paired", "--between", "0.05", "0.3"]


def test_a_folder_is_summed_up_and_opened(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [*VARIED, "3", "--t-end", "1", "--samples", "5", "--folder", str(tmp_path / "out")]
    assert main(words) == 0
    said = capsys.readouterr()
    assert "runs                     3\n" in said.out and "[3/3]" in said.err
    assert main([*words, "--json", "--workers", "2"]) == 0
    assert json.loads(capsys.readouterr().out)["folder"] == str(tmp_path / "out")
    assert Sweep.open(tmp_path / "out").axes.shape == (3, 2, 5, 3)


REFUSED = {
    "neither": (["sweep", "--spins", "10", "-10"], "--vary NAME and --between FROM TO N are needed"),
    "no worker": ([*VARIED, "3", "--workers", "0"], "--workers 0: give 1 or more"),
    "two places": ([*VARIED, "3", "--workers", "2", "--scheduler", "tcp://x:1"], "without --scheduler"),
    "one sample": ([*VARIED, "3", "--samples", "1"], "--samples 1 must lie between 2"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_bad_usage_is_one_line(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    words, says = REFUSED[name]
    assert main(words) == 2
    said = capsys.readouterr().err
    assert says in said and said.count("\n") == 1


# The command with chunks of two runs; the first argument is the signal that it gets soon after the first chunk, or 0.
SMALL = """
import os, sys, threading
from contextlib import contextmanager
from lagrotor.commands import scene_commands
from lagrotor.commands.command_line import main
from lagrotor.models.sweeps import sweep

@contextmanager
def progress(total):
    yield lambda name, done: done == 2 and threading.Timer(0.01, os.kill, (os.getpid(), number)).start()

if __name__ == "__main__":
    sweep.CHUNK, number = 2, int(sys.argv.pop(1))
    if number:
        scene_commands.progress = progress
    sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
@pytest.mark.parametrize("place", [[], ["--workers", "2"]], ids=["here", "processes"])
def test_an_interrupt_says_how_to_go_on(place: list[str], number: signal.Signals, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    words = [*VARIED, "16", "--t-end", "1", "--folder", str(folder), *place]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    stopped, done = (
        subprocess.run(
            [sys.executable, "-c", SMALL, str(int(sent)), *words],
            env=environment, capture_output=True, text=True, check=False,
        )
        for sent in (number, 0)
    )  # fmt: skip
    assert stopped.returncode == {signal.SIGINT: 130, signal.SIGTERM: 143}[number]
    stop = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}[number]
    assert stopped.stderr == f"lagrotor: {stop}: the finished runs are in {folder}; the same command goes on\n"
    assert stopped.stdout == "" and done.returncode == 0 and "[16/16]" in done.stderr
    scenes = [paired_scene(Scene((10, -10)), 0.05 + 0.25 * i / 15) for i in range(16)]
    assert_same_bits(Sweep.open(folder), sweep(scenes, np.linspace(0, 1, 3), 1e-8))


def test_a_scheduler_runs_it(capsys: pytest.CaptureFixture[str]) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    words = [*VARIED, "3", "--t-end", "1", "--json"]
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster:
        assert main([*words, "--scheduler", cluster.scheduler_address]) == 0
    there = capsys.readouterr().out
    assert main(words) == 0
    assert there == capsys.readouterr().out
