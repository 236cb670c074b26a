"""The main job: the same bytes from the same inputs, and a second run that takes what has not changed."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import lagrotor
from lagrotor.report.job.folder import CONTENTS, MADE, PRODUCTS, TIMES

ROOT = Path(lagrotor.__file__).parent.parent
LARGEST = 5_000_000  # bytes of the page
# One section, the claims of another, a figure; `lines` may change anything before the run.
SUBSET = """
import sys
from pathlib import Path
from lagrotor.commands import terminal
from lagrotor.paper.rotor_pair.own_paper import PAPER
from lagrotor.paper.scripts import Scripts
from lagrotor.pictures import figures
from lagrotor.report import content, results
from lagrotor.report.job import reach, reproduce
from lagrotor.report.page import whole_page as page
from lagrotor.report.interactive import interactive
kept = {"s2a_angular_momentum", "s3e_link", "c_s2_preliminary", "fig14_euler_angles", "fig16_top_view"}
names = Scripts.names
Scripts.names = lambda scripts, kind, prefix="": [name for name in names(scripts, kind, prefix) if name in kept]
interactive.interactive = lambda: '<section id="model"><h2>The model</h2></section>'
LINES
made = reproduce.reproduce(PAPER, Path(sys.argv[1]), terminal.progress, 1)
print(len(made.taken), *made.taken)
"""


def run(target: Path, seed: int, lines: str = "", source: str = SUBSET) -> str:
    """Run the job in a process of its own; what it prints."""
    done = subprocess.run(
        [sys.executable, "-c", source.replace("LINES", lines), str(target)],
        env=os.environ | {"PYTHONHASHSEED": str(seed), "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert all(re.fullmatch(r"\[\d+/\d+\] +\d+ s  .*", line) for line in done.stderr.splitlines()), "a line a step"
    return done.stdout


def held(target: Path) -> dict[str, bytes]:
    """What must be the same on every run."""
    files = {str(path.relative_to(target)): path.read_bytes() for path in target.rglob("*") if path.is_file()}
    assert {name.split("/")[0] for name in files} == CONTENTS
    return {name: data for name, data in files.items() if name.split("/")[0] not in (TIMES, MADE, PRODUCTS)}


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("first") / "report"
    assert run(target, 1).startswith("0")
    return target


def test_the_same_inputs_give_the_same_bytes(first: Path, tmp_path: Path) -> None:
    run(tmp_path / "report", 2)
    assert held(tmp_path / "report") == held(first)


def test_what_hangs_on_the_hash_seed_is_seen(first: Path, tmp_path: Path) -> None:
    report = Path(shutil.copytree(first, tmp_path / "report"))
    (report / "index.html").write_text("edited")  # the page alone is made anew
    run(report, 2, 'page.balance = lambda report: " ".join({"one", "two", "three", "four", "five"})')
    other, same = held(report), held(first)
    assert {name for name in same if other[name] != same[name]} == {"index.html"}


def test_durations_are_in_one_file(first: Path) -> None:
    times = json.loads((first / TIMES).read_text())
    assert set(times["seconds"]) >= {"derivation s3e_link", "claim C01", "figure 14", "report"}
    for name in ("verdicts.json", "claims.json"):
        assert all("seconds" not in entry for entry in json.loads((first / name).read_text()))


def test_a_second_run_takes_everything_and_touches_nothing(first: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in first.rglob("*")}
    assert run(first, 3) == "1 report\n"
    assert {path: path.stat().st_mtime_ns for path in first.rglob("*")} == before


def test_what_is_damaged_is_made_anew(first: Path) -> None:
    good = held(first)
    (first / "figures" / "fig14_euler_angles.svg").write_text("<svg/>")
    assert "figure 14" not in run(first, 4)
    assert held(first) == good
    (first / "index.html").write_text("edited")
    assert run(first, 5).startswith("8 derivation")
    assert held(first) == good


def test_other_versions_make_everything_anew(first: Path) -> None:
    good = held(first)
    lines = 'reach.versions = lambda: {"Python": "another"}'
    assert run(first, 6, lines).startswith("0")
    assert held(first) != good
    assert b"another" in held(first)["index.html"]


@pytest.mark.slow
def test_the_whole_report_is_the_same_twice_and_small(
    tmp_path: Path, typed_formulas: Callable[[str], list[str]]
) -> None:
    whole = SUBSET[: SUBSET.index("kept =")] + SUBSET[SUBSET.index("made =") :]
    for seed in (1, 2):
        run(tmp_path / f"report{seed}", seed, source=whole)
    assert held(tmp_path / "report1") == held(tmp_path / "report2")
    assert len(held(tmp_path / "report1")["index.html"]) <= LARGEST
    assert typed_formulas((tmp_path / "report1" / "index.html").read_text(encoding="utf-8")) == []
