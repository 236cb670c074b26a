"""An interrupt of `lagrotor reproduce`: heeded at once, at any time, by a terminal or by one signal; nothing is left behind."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import lagrotor

pytestmark = pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="it counts the processes in /proc")
AT_ONCE = 20.0  # s; by far longer than it takes on a busy machine, by far shorter than the whole job


def processes(mark: str) -> list[int]:
    """The numbers of the living processes that have the mark in their environment, and so the descendants of a run."""
    living = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            is_dead = (folder / "stat").read_text().rpartition(")")[2].split()[0] == "Z"
            if not is_dead and mark.encode() in (folder / "environ").read_bytes():
                living.append(int(folder.name))
        except OSError:  # it has ended, or belongs to somebody else
            continue
    return living


class Run:
    """A run of the command in a process group of its own, which is interrupted after `seconds`, or after a text appears."""

    def __init__(self, folder: Path, after: float | str, whole_group: bool) -> None:
        mark = f"LAGROTOR_TEST={folder}"
        environment = os.environ | {
            "XDG_CACHE_HOME": str(folder / "cache"),
            "PYTHONPATH": str(Path(lagrotor.__file__).parent.parent),
            "LAGROTOR_TEST": str(folder),
        }
        command = [sys.executable, "-m", "lagrotor", "reproduce", "--jobs", "2", "--out", str(folder / "report")]
        with (folder / "says").open("w+") as says:
            run = subprocess.Popen(command, env=environment, stdout=says, stderr=says, start_new_session=True)
            if isinstance(after, str):
                while after not in (folder / "says").read_text() and run.poll() is None:
                    time.sleep(0.05)
            else:
                time.sleep(after)
            (os.killpg if whole_group else os.kill)(run.pid, signal.SIGINT)
            try:
                self.status = run.wait(AT_ONCE)
            finally:
                if run.poll() is None:
                    os.killpg(run.pid, signal.SIGKILL)
                    run.wait()
        for _ in range(
            20
        ):  # two seconds, in which a busy machine carries out the signals; a server that lives imports longer
            if not (living := processes(mark)):
                break
            time.sleep(0.1)
        self.living, self.says = living, (folder / "says").read_text()
        for process in living:
            os.kill(process, signal.SIGKILL)


MESSAGE = r"lagrotor: interrupted(: (no result is kept yet, and the same command begins again|.* goes on from there))?"


@pytest.mark.parametrize(
    ("after", "whole_group"),
    [
        (0.7, True),
        *(
            pytest.param(seconds, group, marks=pytest.mark.slow)
            for seconds in (0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0)
            for group in (False, True)
        ),
    ],
)
def test_an_interrupt_ends_the_job_and_all_its_processes(after: float, whole_group: bool, tmp_path: Path) -> None:
    run = Run(tmp_path, after, whole_group)
    assert run.status in (130, -signal.SIGINT)  # the second while Python itself loads
    assert run.living == []
    assert "Traceback" not in run.says
    if run.status == 130:
        assert re.fullmatch(MESSAGE, run.says.splitlines()[-1])
    assert not [entry for entry in os.listdir(tmp_path) if entry.startswith(".report")]


@pytest.mark.slow
def test_finished_results_are_kept(tmp_path: Path) -> None:
    first = Run(tmp_path, "[5/160]", True)
    match = re.search(
        r"interrupted: (\d+) of 159 results are kept, and the same command goes on from there", first.says
    )
    assert match and int(match[1]) >= 1
    again = Run(tmp_path, "results to compute", False)
    assert f"{159 - int(match[1])} of 159 results to compute" in again.says
