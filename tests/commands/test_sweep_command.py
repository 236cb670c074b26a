"""The command sweep: a table of scenes, a folder that is resumed, processes, a cluster."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Sweep, sweep
from lagrotor.commands.command_line import main
from tests.models.sweep_family import assert_same_bits

ROOT = Path(__file__).parents[2]
TABLE = "spins_1,spins_2,rates_1y, rates_2y,link_length\n10,-10,0.1,0.1,1\n9,-10,0.1,0.1,\n8,-8,0.2,0.2,1.5\n"
VARIED = ["sweep", "--spins", "10", "-10", "--vary", "paired", "--between", "0.05", "0.3"]


@pytest.fixture
def table(tmp_path: Path) -> str:
    (tmp_path / "runs.csv").write_text(TABLE)
    return str(tmp_path / "runs.csv")


def test_a_table_is_the_sweep_of_its_columns(table: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", "--columns", table, "--t-end", "1", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    y = [0.1, 0.1, 0.2]
    columns = {"spins_1": [10, 9, 8], "spins_2": [-10, -10, -8], "rates_1y": y, "rates_2y": y}
    runs = sweep(columns | {"link_length": [1, np.nan, 1.5]}, [0, 0.5, 1], 1e-8)
    assert [row["tip_1"] for row in rows] == [run.tips[0, -1].tolist() for run in runs]
    assert [(row["run"], row["model"]) for row in rows] == [(0, "minimal"), (1, "spheres"), (2, "minimal")]


def test_a_folder_is_summed_up_and_opened(table: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["sweep", "--columns", table, "--t-end", "1", "--samples", "5", "--folder", str(tmp_path / "out")]
    assert main(words) == 0
    said = capsys.readouterr()
    assert "runs                     3\n" in said.out and "[3/3]" in said.err
    assert main([*words, "--json", "--workers", "2"]) == 0
    assert json.loads(capsys.readouterr().out)["folder"] == str(tmp_path / "out")
    assert Sweep.open(tmp_path / "out").axes.shape == (3, 2, 5, 3)


REFUSED = {
    "neither": (["sweep", "--spins", "10", "-10"], "--vary NAME and --between FROM TO N are needed, or --columns"),
    "both": ([*VARIED, "3", "--columns", "FILE"], "--columns: the file has the scenes: leave out"),
    "no file": (["sweep", "--columns", "nowhere.csv"], "No such file"),
    "no worker": ([*VARIED, "3", "--workers", "0"], "--workers 0: give 1 or more"),
    "two places": ([*VARIED, "3", "--workers", "2", "--scheduler", "tcp://x:1"], "without --scheduler"),
    "one sample": ([*VARIED, "3", "--samples", "1"], "--samples 1 must lie between 2"),
    "a name": (["sweep", "--columns", "spin_1,spins_2\n1,2\n"], "'spin_1' is no column of scenes: spins_1"),
    "a word": (["sweep", "--columns", "spins_1,spins_2\n1,x\n"], "could not convert string 'x' to float"),
    "a short line": (["sweep", "--columns", "spins_1,spins_2\n1,2\n1\n"], "columns changed from 2 to 1 at row 2: give"),
    "no numbers": (["sweep", "--columns", "spins_1,spins_2\n"], "give a line of names and then numbers"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_bad_usage_is_one_line(name: str, table: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words, says = REFUSED[name]
    (tmp_path / "bad.csv").write_text(words[-1])
    words = [str(tmp_path / "bad.csv") if "\n" in word else table if word == "FILE" else word for word in words]
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
    spins = np.linspace(9, 12, 16)
    (tmp_path / "runs.csv").write_text(
        "\n".join(["spins_1,spins_2,rates_1y,rates_2y", *(f"{w!r},-9,.3,.3" for w in spins.tolist())])
    )
    words = ["sweep", "--columns", str(tmp_path / "runs.csv"), "--t-end", "1", "--folder", str(folder), *place]
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
    columns = {"spins_1": spins, "spins_2": -9, "rates": ((0, 0.3, 0), (0, 0.3, 0))}
    assert_same_bits(Sweep.open(folder), sweep(columns, np.linspace(0, 1, 3), 1e-8))


def test_a_scheduler_runs_it(table: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    words = ["sweep", "--columns", table, "--t-end", "1", "--json"]
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster:
        assert main([*words, "--scheduler", cluster.scheduler_address]) == 0
    there = capsys.readouterr().out
    assert main(words) == 0
    assert there == capsys.readouterr().out
