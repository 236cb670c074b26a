"""Rows of processes: commands in units of `python -c "import sympy"`, derivations of rods, the main job and the tests.

Each runs in a copy of the sources. Short ones are measured by processor time; the main job and the tests, which use several
processes, by the clock on the wall. What is compiled is kept, as by default, even where the environment forbids it: the unit's
modules were compiled when they were installed.
"""

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.ratios.pairs import Pairs, Row
from benchmarks.ratios.runs import ROOT
from benchmarks.scenes import SCENES
from lagrotor.errors import LagrotorError

UNIT = ("-c", "import sympy")
_SHOCK = ("--shock", "40", "-11", "0", "--shock-time", "2", "--shock-width", "0.05")
_SIMULATE = ("--spins", "10", "-10", "--link-mass", "0.01", "--link-inertia", "0.1", *_SHOCK, "--t-end", "1")
_REPRODUCE = ("-m", "lagrotor", "reproduce", "--out", "report")


@dataclass(frozen=True)
class Used:
    """The wall-clock and processor time in s of one process and its children, and the text that it printed."""

    wall: float
    processor: float
    printed: str


def run_python(arguments: tuple[str, ...], folder: Path, says: str = "", cache: Path | None = None) -> Used:
    """Run `python` with the arguments in a folder whose `lagrotor` it imports, with its own cache where one is given. Raises
    LagrotorError if it fails, or does not print the pattern `says`."""
    began = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, *arguments],
        cwd=folder,
        env={name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        | {"PYTHONPATH": str(folder)}
        | ({"XDG_CACHE_HOME": str(cache)} if cache else {}),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert process.stdout is not None
    printed = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode or not re.search(says, printed):
        raise LagrotorError(
            f"python {' '.join(arguments)} ended with {process.returncode}, and should print {says!r}: {printed[-500:]}"
        )
    return Used(time.perf_counter() - began, used.ru_utime + used.ru_stime, printed)


@contextmanager
def copied(source: Path) -> Iterator[Path]:
    """A copy of a checkout without its history, environments, caches and reports."""
    kept = shutil.ignore_patterns(".git", ".venv*", ".*_cache", ".hypothesis", "__pycache__", "report", "report.*")
    with TemporaryDirectory() as base:
        folder = Path(base) / "lagrotor"
        shutil.copytree(source, folder, ignore=lambda at, names: kept(at, names) if Path(at) == source else set())
        yield folder


def command(arguments: tuple[str, ...], says: str) -> Pairs:
    """A command and the unit."""
    with copied(ROOT) as folder:
        run_python(arguments, folder, says)  # compiles
        while True:
            yield run_python(arguments, folder, says).processor, run_python(UNIT, folder).processor


def doubled_rods(n: int) -> Pairs:
    """The derivations of 2 n and of n rods, each in its own process."""
    while True:
        more, few = (float(run_python(("-m", "benchmarks.ratios.rods", str(k)), ROOT).printed) for k in (2 * n, n))
        yield more, few


def reproduce(old: Path) -> Pairs:
    """The main job from nothing, in this checkout and in the one in the folder `old`, each with empty caches."""
    while True:
        with copied(ROOT) as ours, copied(old) as theirs:
            times = [run_python(_REPRODUCE, each, cache=each / "cache").wall for each in (ours, theirs)]
            for folder in (ours, theirs):
                check_report(folder)
        yield times[0], times[1]


def check_report(folder: Path) -> None:
    """Raise LagrotorError unless the report of a checkout shows each of its derivations and figures."""
    pages = "".join(page.read_text(encoding="utf-8") for page in (folder / "report").rglob("*.html"))
    shown = {*re.findall(r"derivation-(\w+)", pages), *(file.stem for file in (folder / "report").rglob("figures/*"))}
    scripts = {script.stem for kind in ("derivations", "figures") for script in (folder / kind).glob("*.py")}
    if not scripts or (lost := scripts - shown):
        raise LagrotorError(
            f"the report of {folder} does not show {', '.join(sorted(lost)) if scripts else 'anything'}"
        )


def one_change() -> Pairs:
    """The main job after a change in one derivation, whose page it renews."""
    changed = "s5_3b_opposite_spins"
    with copied(ROOT) as folder:
        run_python(_REPRODUCE, folder, cache=folder / "cache")
        script, page = (
            folder / "derivations" / f"{changed}.py",
            folder / "report" / "pages" / f"derivation-{changed}.html",
        )
        for i in range(1_000_000):
            page.unlink()
            change_derivation(script, i)
            taken = run_python(_REPRODUCE, folder, cache=folder / "cache").wall
            if f"Change number {i}." not in page.read_text(encoding="utf-8"):
                raise LagrotorError(f"{page} does not have the changed line of {script}")
            yield taken, 1.0


def change_derivation(script: Path, i: int) -> None:
    """Write a line of code and a sentence of the page at the end of a script."""
    added = f"\n# %%\nchanged = {i}\n\n# %% [markdown]\n# Change number {i}.\n"
    script.write_text(script.read_text(encoding="utf-8") + added, encoding="utf-8")


def tests() -> Pairs:
    """The fast tests."""
    with copied(ROOT) as folder:
        while True:
            yield run_python(("-m", "pytest", "-q"), folder, r"\d{4,} passed").wall, 1.0


def rows() -> list[Row]:
    """The rows of commands and of rods."""
    unit = "import sympy"
    commands = [
        ("lagrotor audit 5.22", ("-m", "lagrotor", "audit", "5.22"), "5.22", 5.0),
        ("lagrotor judge", ("-m", "lagrotor", "judge", "sin(x)**2 + cos(x)**2 = 1"), "holds", 2.5),
        ("lagrotor rate", ("-m", "lagrotor", "rate", "--spins", "20", "20"), r"\d\.\d", 1.2),
        ("lagrotor simulate", ("-m", "lagrotor", "simulate", *_SIMULATE, "--samples", "101"), r"\d\.\d", 1.5),
        *((f"first simulate, {kind}", ("-c", _first(kind)), "^101 times", 3.0) for kind in SCENES),
        ("64 rods ready", ("-m", "benchmarks.ratios.rods", "64"), r"\d\.\d", 15.0),
        ("100 rods ready", ("-m", "benchmarks.ratios.rods", "100"), r"\d\.\d", inf),
    ]
    return [
        *(Row(name, unit, wanted, partial(command, arguments, says), 5) for name, arguments, says, wanted in commands),
        Row("32 rods ready", "16 rods ready", 2.3, partial(doubled_rods, 16), 5),
    ]


def _first(kind: str) -> str:
    """A program whose first run is of a kind of scene."""
    begin = "from benchmarks.scenes import SCENES; from lagrotor import simulate; "
    return f"{begin}print(len(simulate(SCENES[{kind!r}](1), [i / 100 for i in range(101)]).t), 'times')"


def whole_rows(old: Path | None) -> list[Row]:
    """The long rows, each measured once; the main job from nothing only beside an older checkout."""
    beside = [Row("lagrotor reproduce, from nothing", "the older one", 1.4, partial(reproduce, old), 1)] if old else []
    return [
        *beside,
        Row("lagrotor reproduce, one derivation changed", "s", 15, one_change, 1),
        Row("the tests", "s", 240, tests, 1),
    ]
