"""The tests on other machines, as far as this one can stand for them: `make test-machines`.

Other kernels of the linear algebra library, numpy without its vector features, other orders of hashing, the lowest
dependencies, with the extras and without, and every Python from 3.11 on that is here. Each run has a name; some of them:
`make test-machines RUNS="Prescott extras"`. What this machine cannot is said. Exit status 1 where a run fails, or is
not run though its packages could be fetched: only what this machine lacks, a network, an interpreter or a processor, excuses it.
"""

import ast
import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# The folders in which numbers are computed, whose last digits depend on the machine. What decides has no floating point.
COMPUTING = tuple(f"tests/{folder}" for folder in ("numerics", "mechanics", "pair", "theory", "models", "structures"))
DECIDING = ("tests/algebra",)
# Of the computing folders, the tests that call neither numpy nor scipy: another kernel or processor cannot change them.
SYMBOLIC = (
    "tests/mechanics/canonical/test_generating_functions.py",
    "tests/mechanics/test_expressions.py",
    "tests/mechanics/test_fourier.py::test_the_drift_of_the_guiding_centre",
    "tests/mechanics/test_linear_modes.py::test_equal_rates_of_gyroscopic_systems_are_seen_in_any_numbers",
    "tests/mechanics/test_peers_texts.py::test_energies_momenta_and_hamiltonians_are_emmys",
    "tests/mechanics/test_quasi_velocities.py::test_integrals_are_decided_in_velocities_of_ones_own",
    "tests/pair/test_scene_document.py",
    "tests/theory/test_derivations.py::test_a_changed_step_is_refused",
)
# OPENBLAS_CORETYPE → what the processor has to have for it.
KERNELS = {"Prescott": "pni", "Nehalem": "sse4_2", "Sandybridge": "avx", "Haswell": "avx2", "SkylakeX": "avx512bw"}
OLDEST = "Prescott"  # its run has no vector features of numpy either
SEEDS = 1, 2, 3
PYTHONS = "3.11", "3.12", "3.13", "3.14"
EXTRAS = "heyoka", "pandas", "xarray", "flint", "distributed"
NOT_INSTALLED = "its packages cannot be installed"
_UNREACHED = "after connection broken by"  # what pip says of a package index that it does not reach
# Prints the vector features that numpy chooses among and this processor has.
_FEATURES = """
try:
    from numpy._core import _multiarray_umath as numpy
except ImportError:
    from numpy.core import _multiarray_umath as numpy
print(*(name for name in numpy.__cpu_dispatch__ if numpy.__cpu_features__[name]))
"""


@dataclass(frozen=True)
class Environment:
    """Where packages are installed: a folder and the mark that `make` leaves in it, and the Python it is made with."""

    folder: str
    mark: str = ".installed"
    python: str = ""

    @property
    def executable(self) -> str:
        return f"{self.folder}/bin/python"

    def make(self) -> str:
        """Made as the Makefile says; what hindered it, or ""."""
        variables = [f"VENV={self.folder}", f"PYTHON={self.python}"] if self.python else []
        command = ["make", "--silent", *variables, f"{self.folder}/{self.mark}"]
        done = subprocess.run(command, cwd=ROOT, stderr=subprocess.PIPE, text=True)
        print(done.stderr, end="", file=sys.stderr)
        if not done.returncode:
            return ""
        return "no network to install its packages from" if _UNREACHED in done.stderr else NOT_INSTALLED


ORDINARY = Environment(".venv", ".installed-test")
WITH_EXTRAS = Environment(".venv-extras")
LOWEST = Environment(".venv-lowest")


@dataclass(frozen=True)
class Run:
    """A run of tests: its name, files, environment and variables. vectors: whether numpy uses its vector features.
    without: files and tests that it leaves out."""

    name: str
    tests: tuple[str, ...]
    environment: Environment
    variables: dict[str, str] = field(default_factory=dict)
    vectors: bool = True
    without: tuple[str, ...] = ()


def extras_tests() -> tuple[str, ...]:
    """The tests that need an extra: the functions that name a module of it in quotes; the whole file where other lines do,
    where a missing module skips the file, and in tests/benchmarks, where tools name their modules."""
    named = re.compile("|".join(map(re.escape, EXTRAS)))
    chosen = list[str]()
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        file, naming, skipped = path.relative_to(ROOT).as_posix(), list[ast.stmt](), False
        for statement in ast.parse(path.read_text(encoding="utf-8")).body:
            skipped |= isinstance(statement, ast.Expr | ast.Assign) and "importorskip" in ast.unparse(statement)
            texts = (node.value for node in ast.walk(statement) if isinstance(node, ast.Constant))
            if any(isinstance(text, str) and named.match(text) for text in texts):
                naming.append(statement)
        alone = all(isinstance(s, ast.FunctionDef) and s.name.startswith("test_") for s in naming)
        if not naming or (alone and not skipped and not file.startswith("tests/benchmarks/")):
            chosen += [f"{file}::{s.name}" for s in naming]  # type: ignore[attr-defined]
        else:
            chosen.append(file)
    return tuple(chosen)


def runs() -> list[Run]:
    """All of them."""
    return [
        *(Run(f"hash-seed-{seed}", ("tests",), ORDINARY, {"PYTHONHASHSEED": str(seed)}) for seed in SEEDS),
        Run("extras", extras_tests(), WITH_EXTRAS),
        *(Run(name, COMPUTING, WITH_EXTRAS, {"OPENBLAS_CORETYPE": name}, name != OLDEST, SYMBOLIC) for name in KERNELS),
        Run("no-vectors", COMPUTING, WITH_EXTRAS, vectors=False, without=SYMBOLIC),
        Run("lowest", (*DECIDING, *COMPUTING), LOWEST),
        *(
            Run(f"python{number}", ("tests",), Environment(f".venv-{number}", ".installed-test", f"python{number}"))
            for number in PYTHONS
        ),
    ]


def without_repeats(run: Run, before: Iterable[Run]) -> Run:
    """The run without the tests that one of those before had with the same packages: what is asked of it is only that."""
    had = tuple(f"{path}/" for other in before if other.environment == run.environment for path in other.tests)
    tests = tuple(path for path in run.tests if not path.startswith(had))
    return run if run.variables or not run.vectors else replace(run, tests=tests)


def hindrance(run: Run) -> str:
    """Why this machine cannot run it; "" if it can."""
    if kernel := run.variables.get("OPENBLAS_CORETYPE"):
        if platform.machine() not in ("x86_64", "AMD64"):
            return f"a kernel of x86-64; this is {platform.machine()}"
        flags = Path("/proc/cpuinfo")
        if flags.exists() and KERNELS[kernel] not in flags.read_text().split():
            return f"the processor has no {KERNELS[kernel]}"
    if run.environment.python:
        try:
            subprocess.run([run.environment.python, "--version"], capture_output=True, check=True)
        except (OSError, subprocess.CalledProcessError):
            return f"no {run.environment.python} is installed"
    if why := run.environment.make():
        return why
    if kernel and f"Core: {kernel}" not in chosen_kernel(run):
        said = chosen_kernel(run).strip() or "numpy's linear algebra is not OpenBLAS"
        return "" if kernel == OLDEST and "Katmai" in said else f"not chosen: {said}"
    return ""


def chosen_kernel(run: Run) -> str:
    """What OpenBLAS says of its choice."""
    variables = os.environ | run.variables | {"OPENBLAS_VERBOSE": "2"}
    done = subprocess.run(
        [run.environment.executable, "-c", "import numpy"], cwd=ROOT, env=variables, capture_output=True, text=True
    )
    return done.stdout + done.stderr


def variables_of(run: Run) -> dict[str, str]:
    """The environment variables of a run."""
    variables = os.environ | run.variables
    if not run.vectors:
        found = subprocess.run(
            [run.environment.executable, "-c", _FEATURES], capture_output=True, text=True, check=True
        )
        variables["NPY_DISABLE_CPU_FEATURES"] = found.stdout.strip()
    return variables


def passed(run: Run) -> bool:
    """Run the tests, their progress shown."""
    command = [run.environment.executable, "-m", "pytest", "-q", *run.tests]
    command += [f"--deselect={test}" for test in run.without]
    return subprocess.run(command, cwd=ROOT, env=variables_of(run)).returncode == 0


def main(names: Iterable[str]) -> int:
    """Run those of the names, or all; exit status."""
    known = {run.name: run for run in runs()}
    if unknown := [name for name in names if name not in known]:
        print(f"no run is called {', '.join(unknown)}: there are {', '.join(known)}")
        return 2
    results, absent, before, failed = list[str](), list[str](), list[Run](), False
    for number, name in enumerate(chosen := list(names) or list(known), start=1):
        print(f"== {number} of {len(chosen)}: {name}", flush=True)
        began, run = time.monotonic(), without_repeats(known[name], before)
        if why := hindrance(run):
            results.append(f"{name}: not run, {why}")
            absent.append(name)
            failed |= why == NOT_INSTALLED
        else:
            good = passed(run)
            before.append(run)
            failed |= not good
            results.append(f"{name}: {'passed' if good else 'FAILED'} in {time.monotonic() - began:.0f} s")
        print(results[-1], flush=True)
    print("== all", *results, sep="\n")
    if absent:
        print(f"!!!! NOT RUN, SO NOT TESTED HERE: {', '.join(absent)} !!!!")
    return int(failed)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
