"""The commands' times in units of `python -c "import sympy"`, beside the targets: `python -m benchmarks.units`.

Each command runs in processes of its own, five times, and the median counts; the unit is measured between them, so that a
machine that is busy slows both. `--whole` adds the long commands: the whole audit, the main job and the tests, once each; of
these only the wall-clock counts, since the processor time of their worker processes is not seen here. What is compiled is kept,
as by default, even where the environment forbids it: the unit's modules were compiled when they were installed.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from lagrotor.errors import LagrotorError

ROOT = Path(__file__).resolve().parent.parent
UNIT = ("-c", "import sympy")
REPEATS = 5


@dataclass(frozen=True)
class Command:
    """What `python` is given, and the target in these units. prepare: what is done to the copy of the sources first."""

    name: str
    arguments: tuple[str, ...]
    wanted: float
    repeats: int = REPEATS
    prepare: Callable[[Path], None] | None = None


@dataclass(frozen=True)
class Used:
    """What one process used: wall-clock and processor time in s, and the most memory that it or a child had, in MB."""

    wall: float
    processor: float
    memory: float


@dataclass(frozen=True)
class Row:
    """A command's medians: units of wall-clock and of processor time, and MB."""

    command: Command
    wall: float
    processor: float
    memory: float


_SHOCK = ("--shock", "40", "-11", "0", "--shock-time", "2", "--shock-width", "0.05")
_SIMULATE = ("simulate", "--spins", "10", "-10", "--link-mass", "0.01", "--link-inertia", "0.1", *_SHOCK)
# One scene for each model that may be chosen, and for each kind of program.
_SCENES = {
    "free rotors": "Scene((10, 5), link=None, axes=((0.6, 0, 0.8), (0, 0, 1)))",
    "massless bar, shock": "Scene((10, -10), shock=Shock((40, -11, 0), 1, 0.05))",
    "short bar, shock": "Scene((10, 5), link=Link(0.7, 0.5, 0.1), shock=Shock((30, 20, 0), 0.5, 0.05))",
    "long bar, shock": "Scene((10, 5), link=Link(1.7, 0.5, 0.1), shock=Shock((30, 20, 0), 0.5, 0.05))",
    "equal spins, shock": "Scene((10, 10), link=Link(1, 0.5, 0.1), shock=Shock((30, 20, 0), 0.5, 0.05))",
    "small shock": "Scene((10, -7), link=Link(1, 0.5, 0.1), shock=Shock((1e-4, 0, 0), 0.5, 0.05))",
    "paired precession": "paired_scene(Scene((10, -10)), 0.05)",
}


def _first(scene: str) -> tuple[str, str]:
    names = "Link, Scene, Shock, paired_scene, simulate" if "paired" in scene else "Link, Scene, Shock, simulate"
    return "-c", f"from lagrotor import {names}; simulate({scene}, [0.0, 1.0, 2.0, 3.0])"


def _change_a_derivation(copy: Path) -> None:
    script = copy / "derivations" / "s5_3b_opposite_spins.py"
    script.write_text(script.read_text(encoding="utf-8") + "\nchanged = True\n", encoding="utf-8")


QUICK = (
    Command("lagrotor audit 5.22", ("-m", "lagrotor", "audit", "5.22"), 5),
    Command("lagrotor rate --spins 20 20", ("-m", "lagrotor", "rate", "--spins", "20", "20"), 1.2),
    Command("lagrotor simulate, short run", ("-m", "lagrotor", *_SIMULATE, "--t-end", "1", "--samples", "101"), 1.5),
    *(Command(f"first simulate: {name}", _first(scene), 3) for name, scene in _SCENES.items()),
)
_REPRODUCE = ("-m", "lagrotor", "reproduce", "--out", "report")
LONG = (
    Command("lagrotor audit", ("-m", "lagrotor", "audit"), 15, 1),
    Command("lagrotor reproduce, nothing to reuse", _REPRODUCE, 80, 1),
    Command("lagrotor reproduce, one derivation changed", _REPRODUCE, 15, 1, _change_a_derivation),
    Command("the tests", ("-m", "pytest", "-q"), 350, 1),
)


def measured(arguments: Sequence[str], folder: Path) -> Used:
    """Run `python` with the arguments in a folder whose `lagrotor` it imports. Raises LagrotorError where it fails."""
    began = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, *arguments],
        cwd=folder,
        env={name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        | {"PYTHONPATH": str(folder)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    said = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise LagrotorError(f"python {' '.join(arguments)} ended with {process.returncode}: {said[-500:]}")
    per_megabyte = 2**20 if sys.platform == "darwin" else 2**10
    return Used(time.perf_counter() - began, used.ru_utime + used.ru_stime, used.ru_maxrss / per_megabyte)


def measure(command: Command, folder: Path) -> Row:
    """The medians of a command's runs, each beside a run of the unit; of the unit never fewer than REPEATS."""
    if command.prepare:
        command.prepare(folder)
    pairs = [(measured(UNIT, folder), measured(command.arguments, folder)) for _ in range(command.repeats)]
    units, runs = [unit for unit, _ in pairs], [run for _, run in pairs]
    units += [measured(UNIT, folder) for _ in range(len(units), REPEATS)]
    return Row(
        command,
        median(run.wall for run in runs) / median(unit.wall for unit in units),
        median(run.processor for run in runs) / median(unit.processor for unit in units),
        median(run.memory for run in runs),
    )


def line(row: Row) -> str:
    """A row as a line of the table."""
    numbers = f"{row.command.wanted:8g} {row.wall:8.1f} {row.processor:10.1f} {row.memory:8.0f}"
    return f"{row.command.name:<44}{numbers}"


def main(whole: bool) -> None:
    """Measure in a copy of the sources, and print each row when it is known."""
    print(f"{'units of import sympy':<44}{'wanted':>8} {'wall':>8} {'processor':>10} {'MB':>8}")
    with tempfile.TemporaryDirectory() as base:
        folder = Path(base) / "lagrotor"
        kept = shutil.ignore_patterns(".git", ".venv*", ".*_cache", ".hypothesis", "__pycache__", "report", "report.*")
        shutil.copytree(ROOT, folder, ignore=lambda at, names: kept(at, names) if Path(at) == ROOT else set())
        for command in (*QUICK, *(LONG if whole else ())):
            print(line(measure(command, folder)), flush=True)


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--whole"]):
        sys.exit("usage: python -m benchmarks.units [--whole]")
    main(sys.argv[1:] == ["--whole"])
