"""The runs of `make test-machines`: each has a name and files, what cannot be run says why; what hypothesis draws."""

import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import settings

from tests import machines
from tests.conftest import exploring
from tests.machines import (
    COMPUTING,
    EXTRAS,
    KERNELS,
    OLDEST,
    PYTHONS,
    ROOT,
    SYMBOLIC,
    Environment,
    Run,
    extras_tests,
    runs,
)

WORKFLOW = ROOT / ".github" / "workflows" / "tests.yml"
BUILD = ROOT / ".ci" / "run"
MAKE = Environment.make
HERE = Environment(str(Path(sys.executable).parent.parent))


@pytest.fixture(autouse=True)
def nothing_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Environment, "make", lambda self: "")


def test_every_run_has_a_name_of_its_own_and_files() -> None:
    names = [run.name for run in runs()]
    assert len(set(names)) == len(names) and not any(" " in name for name in names)
    for test in {test for run in runs() for test in (*run.tests, *run.without)}:
        path, _, function = test.partition("::")
        assert (ROOT / path).exists() and (not function or f"def {function}(" in (ROOT / path).read_text()), test
    assert {*KERNELS, "extras", "lowest", "no-vectors"} <= set(names)


def test_the_extras_are_in_the_environment_that_tests_them() -> None:
    chosen = extras_tests()
    assert "fast,notebook" in (ROOT / "Makefile").read_text() and len(chosen) > 8
    # A fixture names a module, a missing one skips the file, tools name their modules: each time the file is whole.
    assert {
        "tests/numerics/test_taylor.py",
        "tests/test_reference.py",
        "tests/benchmarks/test_peers_on_mechanisms.py",
    } <= set(chosen)
    assert "tests/test_examples.py::test_examples_of_docstrings" in chosen and "tests/test_examples.py" not in chosen
    needing = re.compile(rf"importorskip\(\s*\"(?:{'|'.join(EXTRAS)})\"")
    files = [path for path in (ROOT / "tests").rglob("test_*.py") if needing.search(path.read_text())]
    assert {path.relative_to(ROOT).as_posix() for path in files} <= {test.partition("::")[0] for test in chosen}


def test_another_kernel_leaves_out_what_needs_neither_numbers_nor_an_extra() -> None:
    """Tests that another kernel leaves out are not run with the extras either."""
    assert all(run.without == SYMBOLIC for run in runs() if run.tests == COMPUTING)
    assert {test.partition("::")[0] for test in SYMBOLIC}.isdisjoint(test.partition("::")[0] for test in extras_tests())
    for test in SYMBOLIC:
        path, _, function = test.partition("::")
        text = (ROOT / path).read_text()
        text = text[text.index(f"def {function}(") :].split("\n\n\n")[0] if function else text
        assert test.startswith(COMPUTING) and not re.search(r"\bnp\.|numpy|scipy|simulate", text), test


@pytest.mark.skipif(not (WORKFLOW.exists() and BUILD.exists()), reason="installed without the workflow")
def test_what_is_run_elsewhere_is_one_of_the_runs() -> None:
    names, text = {run.name for run in runs()}, WORKFLOW.read_text()
    (listed,) = re.findall(r"run: \[(.*)\]", text)
    assert set(listed.split(", ")) <= names
    assert tuple(re.findall(r'"(3\.\d+)"', re.findall(r"python: \[(.*)\]", text)[0])) == PYTHONS
    (again,) = re.findall(r'RUNS="(.*)"', BUILD.read_text())
    assert again.split() == [OLDEST, "extras"] and set(again.split()) <= names


def test_what_a_kernel_has_run_with_the_extras_is_not_run_again_for_them() -> None:
    named = {run.name: run for run in runs()}
    files, rest = (machines.without_repeats(named["extras"], [named[name]]).tests for name in ("lowest", OLDEST))
    assert files == extras_tests() and set(rest) < set(files)
    assert not any(path.startswith(machines.COMPUTING) for path in rest) and "tests/proofs/test_theorems.py" in rest
    assert machines.without_repeats(named["Haswell"], [named[OLDEST]]) == named["Haswell"]


def test_what_this_machine_cannot_is_said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    other = Run("python9", ("tests",), Environment(".venv-9", python="no-such-python"))
    assert machines.hindrance(other) == "no no-such-python is installed"
    kernel = Run("Haswell", ("tests",), HERE, {"OPENBLAS_CORETYPE": "Haswell"})
    monkeypatch.setattr(machines, "chosen_kernel", lambda run: "Core not found: Haswell")
    monkeypatch.setitem(KERNELS, "Haswell", "no-such-feature")
    assert (
        "Haswell" in machines.hindrance(kernel)
        or "no-such-feature" in machines.hindrance(kernel)
        or ("x86-64" in machines.hindrance(kernel))
    )
    unreached = f"echo 'Retrying {machines._UNREACHED} a timeout' >&2; exit 1"
    monkeypatch.setattr(Environment, "make", MAKE)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    for said, reason in ((unreached, "no network to install its packages from"), ("exit 1", machines.NOT_INSTALLED)):
        (tmp_path / "make").write_text(f"#!/bin/sh\n{said}\n")
        (tmp_path / "make").chmod(0o755)
        assert machines.hindrance(Run("lowest", ("tests",), HERE)) == reason


def test_numpy_is_left_without_what_it_would_choose() -> None:
    run = Run("no-vectors", ("tests",), HERE, vectors=False)
    variables = machines.variables_of(run)
    assert "NPY_DISABLE_CPU_FEATURES" not in machines.variables_of(replace(run, vectors=True))
    done = subprocess.run(
        [HERE.executable, "-W", "error", "-c", machines._FEATURES], env=variables, capture_output=True, text=True
    )
    assert done.returncode == 0 and not done.stdout.strip(), done.stderr


def test_a_run_that_fails_and_a_name_that_is_none(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(machines, "hindrance", lambda run: "no such kernel" if run.name == OLDEST else "")
    monkeypatch.setattr(machines, "passed", lambda run: run.name != "lowest")
    assert machines.main(["extras", OLDEST]) == 0
    assert machines.main(["lowest", "extras"]) == 1
    assert machines.main(["no-run"]) == 2
    said = capsys.readouterr().out
    assert f"NOT TESTED HERE: {OLDEST} !" in said
    for why, status in (("no network to install its packages from", 0), (machines.NOT_INSTALLED, 1)):
        monkeypatch.setattr(machines, "hindrance", lambda run, why=why: why)
        assert machines.main(["extras"]) == status
        assert capsys.readouterr().out.endswith("!!!! NOT RUN, SO NOT TESTED HERE: extras !!!!\n")
    assert (
        f"{OLDEST}: not run, no such kernel" in said and "lowest: FAILED" in said and "no run is called no-run" in said
    )


def test_hypothesis_draws_the_same_values_but_in_the_slow_tests(request: pytest.FixtureRequest) -> None:
    assert settings.default is not None
    assert settings.default.derandomize != exploring(request.config.option.markexpr)
    assert exploring("slow") and exploring("slow or not slow") and not exploring("not slow") and not exploring("")
