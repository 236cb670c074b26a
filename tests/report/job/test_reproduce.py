"""The main job: the same bytes from the same inputs, and a second run that takes what has not changed."""

import itertools
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from subprocess import PIPE

import pytest

import lagrotor
from lagrotor.report.job.folder import CERTIFICATES, CONTENTS, TIMES

ROOT = Path(lagrotor.__file__).parent.parent
LARGEST = 5_500_000  # bytes of the report as one page, with the words that its search knows
# Where a run begins, and what makes the job a part of itself: one section, the claims of another, two figures.
IMPORTS = """
import contextlib, json, os, sys, traceback
from pathlib import Path
import matplotlib.backends.backend_agg, matplotlib.backends.backend_svg, matplotlib.figure, matplotlib.style, scipy.integrate
import PIL.Image, lagrotor.drawing.run_figure, lagrotor.mechanics.running.simulation, lagrotor.models.spring_link.run
import lagrotor.paper.rotor_pair.claims.shock_toppling_and_twist, lagrotor.paper.rotor_pair.premises, lagrotor.pictures.panels
from lagrotor import *
with contextlib.suppress(ImportError):  # of the extra report
    import latex2mathml.converter, mdit_py_plugins.dollarmath
from lagrotor.commands import terminal
from lagrotor.paper import claim_tests, papers
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.scripts import Scripts
from lagrotor.pictures import figures
from lagrotor.report import content, facts
from lagrotor.report.job import cache, dependencies, reproduce
from lagrotor.report.page import sections as page_sections
from lagrotor.report.page import interactive
"""
SUBSET = """
kept = {"s3e_link", "s5_2a_single_rotor", "c_s2_preliminary", "fig14_euler_angles", "fig16_top_view"}
names = Scripts.names
Scripts.names = lambda scripts, kind, prefix="": [name for name in names(scripts, kind, prefix) if name in kept]
interactive.interactive = lambda: '<section id="model"><h2>The model</h2></section>'
def prove(*arguments): raise AssertionError("the job takes the theorems on record")
claim_tests.can_prove = papers.can_prove = lambda: True
for test in PAPER.claim_tests.values(): object.__setattr__(test, "prove", test.prove and prove)
"""
# A line is a run: report, file for what it prints, lines that may change anything before it. Each is in a process of its
# own, a copy of this one, which has imported everything.
RUNS = """
for line in sys.stdin:
    target, said, lines = json.loads(line)
    run = os.fork()
    if run:
        print(os.waitstatus_to_exitcode(os.waitpid(run, 0)[1]), flush=True)
        continue
    status = 1
    try:
        for number, name in ((1, "out"), (2, "err")):
            os.dup2(os.open(f"{said}.{name}", os.O_CREAT | os.O_WRONLY), number)
        cache.cache_folder = lambda: Path(target).parent / "cache"
        exec(lines)
        made = reproduce.reproduce(PAPER, Path(target), terminal.progress, 1)
        print(len(made.reused), *made.reused, flush=True)
        status = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(status)
"""
Run = Callable[..., str]


def runs_with(seed: int, folder: Path) -> Iterator[Run]:
    """`run(target, lines)` with that seed of the hashes: the job in a process of its own; what it prints."""
    command = [sys.executable, "-c", IMPORTS + RUNS]
    environment = os.environ | {"PYTHONHASHSEED": str(seed), "PYTHONPATH": str(ROOT)}
    count = itertools.count()
    with subprocess.Popen(command, env=environment, stdin=PIPE, stdout=PIPE, text=True) as process:
        requests, answers = process.stdin, process.stdout
        assert requests and answers

        def run(target: Path, lines: str = "", part: str = SUBSET) -> str:
            said = folder / f"run{next(count)}"
            print(json.dumps([str(target), str(said), part + lines]), file=requests, flush=True)
            status = answers.readline()
            error = said.with_suffix(".err").read_text(encoding="utf-8")
            assert status == "0\n", error[-2000:]
            first, *lines = error.splitlines() or [""]
            assert not first or (first.startswith("lagrotor: ") and "results to compute, with --jobs 1" in first)
            assert all(re.fullmatch(r"\[\d+/\d+\] +\d+ s  .*", line) for line in lines), "a line a step"
            return said.with_suffix(".out").read_text(encoding="utf-8")

        yield run


@pytest.fixture(scope="module")
def run_first(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    yield from runs_with(1, tmp_path_factory.mktemp("one"))


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    """With another seed than that of the first report."""
    yield from runs_with(2, tmp_path_factory.mktemp("two"))


def held(target: Path) -> dict[str, bytes]:
    """What must be the same on every run."""
    files = {str(path.relative_to(target)): path.read_bytes() for path in target.rglob("*") if path.is_file()}
    assert {name.split("/")[0] for name in files} == CONTENTS - {CERTIFICATES}
    return {name: data for name, data in files.items() if name != TIMES}


@pytest.fixture(scope="module")
def first(run_first: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("first") / "report"
    assert run_first(target).startswith("0")
    return target


def test_the_same_inputs_give_the_same_bytes(first: Path, run: Run, tmp_path: Path) -> None:
    run(tmp_path / "report")
    assert held(tmp_path / "report") == held(first)


def test_what_hangs_on_the_hash_seed_is_seen(first: Path, run: Run, tmp_path: Path) -> None:
    shutil.copytree(first.parent, tmp_path, dirs_exist_ok=True)
    report = tmp_path / "report"
    (report / "index.html").write_text("edited")  # figures and claims are taken from the cache
    said = run(report, 'page_sections.balance = lambda report: " ".join({"one", "two", "three", "four", "five"})')
    assert "figure 14" in said and "derivation s" not in said
    other, same = held(report), held(first)
    assert {name for name in same if other[name] != same[name]} == {"index.html", "whole.html", "pages/words.js"}


def test_a_second_run_takes_everything_and_touches_nothing(first: Path, run: Run) -> None:
    before = {path: path.stat().st_mtime_ns for path in first.parent.rglob("*")}
    assert run(first) == "1 report\n"
    assert {path: path.stat().st_mtime_ns for path in first.parent.rglob("*")} == before


def test_what_is_damaged_is_written_anew(first: Path, run: Run) -> None:
    good = held(first)
    (first / "figures" / "fig14_euler_angles.svg").write_text("<svg/>")
    said = run(first)
    assert "figure 14" in said and "derivation c_s2_preliminary" in said
    assert "derivation s3e_link" not in said, "the cache holds no verdicts"
    assert held(first) == good


@pytest.mark.slow
def test_the_whole_report_is_the_same_twice_and_small(
    run_first: Run, run: Run, tmp_path: Path, typed_formulas: Callable[[str], list[str]]
) -> None:
    run_first(tmp_path / "report1", part="")
    run(tmp_path / "report2", part="")
    assert held(tmp_path / "report1") == held(tmp_path / "report2")
    made = held(tmp_path / "report1")
    assert len(made["whole.html"]) <= LARGEST
    front = made["index.html"]
    assert front.count(b"<") - front.count(b"</") <= 5_000, "elements"
    assert len(front) + len(made["pages/page.css"]) + len(made["pages/page.js"]) <= 600_000, "bytes of the front page"
    for name, data in made.items():
        assert not name.endswith(".html") or typed_formulas(data.decode()) == [], name
