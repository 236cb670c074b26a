"""The command line: what it prints and writes, its exit status, and that bad input leaves nothing but one line."""

import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import lagrotor
from lagrotor import Scene, write_scene
from lagrotor.benchmark import scenes_and_methods as chart_module
from lagrotor.benchmark.runner import Benchmark, ChartPoint
from lagrotor.commands import terminal
from lagrotor.commands.command_line import main
from lagrotor.models import simulate as simulate_module
from lagrotor.pair.notation import M, R
from lagrotor.paper import Paper, claim_tests
from lagrotor.paper.ledger import decide
from lagrotor.paper.plain_text import readable
from lagrotor.paper.record import OnRecord, record_text
from lagrotor.paper.rotor_pair import rotor_pair_audit
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.verdicts import Relation, Statement
from lagrotor.report.formulas import mathml_latex
from lagrotor.report.job import cache, dependencies, folder, reproduce

ROOT = Path(lagrotor.__file__).parent.parent
SINGLE_ROTOR = ("5.01", "5.02", "5.03", "5.04", "5.05", "5.06")
SCENE = ["simulate", "--spins", "10", "-10"]
PULSE = ["--shock", "40", "-11", "0", "--shock-time", "2", "--shock-width", "0.05"]
VARY = ["--vary", "link-mass", "--between"]
FIGURE = """
from matplotlib.figure import Figure
TITLE, CAPTION, ALT = "A < B", "caption | with a pipe", 'the "alt" text'
def figure():
    drawn = Figure()
    drawn.subplots().plot([0, 1], [0, 1])
    return drawn
def measure():
    return {"slope": 1.0}
"""


def paper_in(folder: Path) -> Paper:
    """A paper with one derivation, one figure and nothing on record."""
    for made in (folder, folder / "derivations", folder / "figures"):
        made.mkdir()
    for file in PAPER.data:
        (folder / file.name).write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
    about = (folder / "paper.toml").read_text(encoding="utf-8")
    (folder / "paper.toml").write_text(about.replace(f'"{PAPER.about.model}"', '"stub_model"'), encoding="utf-8")
    model = "def interactive():\n    return '<section id=\"model\"><h2>The model</h2></section>'\n"
    (folder / "stub_model.py").write_text(model, encoding="utf-8")
    script = PAPER.scripts.path("derivations", "s5_2a_single_rotor")
    (folder / "derivations" / script.name).write_text(script.read_text(encoding="utf-8"), encoding="utf-8")
    (folder / "figures" / "fig17_stub.py").write_text(FIGURE, encoding="utf-8")
    return Paper(folder)


@pytest.fixture(scope="module")
def one_paper(tmp_path_factory: pytest.TempPathFactory) -> Paper:
    """The small paper of all tests that only read it."""
    return paper_in(tmp_path_factory.mktemp("one") / "paper")


@pytest.fixture(autouse=True)
def work(one_paper: Paper, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The small paper is the package's own; the working folder is empty."""
    monkeypatch.setattr(rotor_pair_audit, "PAPER", one_paper)
    monkeypatch.setattr(cache, "cache_folder", lambda: tmp_path / "cache")
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def changed_paper(work: Path, monkeypatch: pytest.MonkeyPatch) -> Paper:
    """A small paper that the test may write to."""
    paper = paper_in(work.parent / "paper")
    monkeypatch.setattr(rotor_pair_audit, "PAPER", paper)
    return paper


@pytest.fixture(scope="module")
def made_once(one_paper: Paper, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the small paper's report and its cache."""
    folder = tmp_path_factory.mktemp("made")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cache, "cache_folder", lambda: folder / "cache")
        reproduce.reproduce(one_paper, folder / "report", terminal.progress, 1)
    return folder


@pytest.fixture
def last_report(made_once: Path, work: Path) -> Path:
    """The report of a run before, in the working folder."""
    shutil.copytree(made_once / "cache", work.parent / "cache")
    return Path(shutil.copytree(made_once / "report", work / "report"))


def record(verdicts: dict[str, str]) -> None:
    rows = {identifier: OnRecord(verdict) for identifier, verdict in verdicts.items()}
    rotor_pair_audit.PAPER.record_file.write_text(record_text(rows), encoding="utf-8")


def found() -> dict[str, str]:
    return {verdict.id: verdict.verdict for verdict in rotor_pair_audit.PAPER.audit()}


BAD: dict[str, tuple[list[str], str]] = {
    "unknown command": (["prove"], "invalid choice"),
    "near a model": ([*SCENE, "--model", "Minimal"], "euler: minimal?"),
    "near a structure": (["structure", "cornr"], ": corner?"),
    "no process": (["reproduce", "--jobs", "0"], "--jobs 0 must be at least 1"),
    "a scene no TOML by its name": ([*SCENE, "--write-scene", "scene.json"], "must end in .toml"),
    "unknown option": (["audit", "--fast"], "--fast"),
    "abbreviated option": ([*SCENE, "--samp", "10"], "--samp"),
    "unknown equation": (["audit", "9.99"], "9.99"),
    "equation not judged": (["audit", "5.15"], "not yet judged"),
    "figure no number": (["figure", "seventeen"], "'seventeen' has no script"),
    "figure without a script": (["figure", "1"], "give one of 17"),
    "figure folder missing": (["figure", "17", "--out", "missing"], "no folder missing"),
    "report below a missing folder": (["reproduce", "--out", "missing/report"], "is missing"),
    "spin NaN": (["simulate", "--spins", "nan", "10"], "not a finite number"),
    "inertia without mass": ([*SCENE, "--link-inertia", "0.1"], "give the bar a mass"),
    "shock without time": ([*SCENE, "--shock", "1", "0", "0", "--shock-width", "0.1"], "a shock needs --shock-time"),
    "shock time alone": ([*SCENE, "--shock-time", "2"], "a shock needs --shock and --shock-width"),
    "shock of no width": ([*SCENE, *PULSE[:-1], "0"], "width = 0 s"),
    "no time": ([*SCENE, "--t-end", "0"], "--t-end 0"),
    "one sample": ([*SCENE, "--samples", "1"], "--samples 1"),
    "too many samples": ([*SCENE, "--samples", "10000001"], "--samples 10000001"),
    "unknown model": ([*SCENE, "--model", "magic"], "model = 'magic'"),
    "output folder missing": ([*SCENE, "--out", "missing/run.npz"], "no folder missing"),
    "near an equation": (["audit", "5.1"], "'5.1' is not in the catalogue: 5.01 or 5.10?"),
    "near a claim": (["claims", "8"], "C08?"),
    "no scene and no spins": (["simulate"], "--spins W1 W2 is missing"),
    "sweep no number": (["sweep", *SCENE[1:], *VARY, "0", "x", "3"], "give two numbers and a count"),
    "sweep of no time": (["sweep", *SCENE[1:], *VARY, "0", "1", "3", "--t-end", "0"], "--t-end 0 must be above zero"),
    "no paper": (["audit", "--paper", "nowhere"], "it has no paper.toml; `lagrotor init nowhere` makes one"),
    "paper below a missing folder": (["init", "a/b"], "does not exist: make it first"),
    "paper from a PDF": (["init", "new", "--from", "paper.pdf"], "give a .tex file"),
    "paper from nothing": (["init", "new", "--from", "paper.tex"], "No such file"),
    "rate with a shock": (["rate", "--spins", "1", "1", "--shock", "1", "0", "0"], "--shock"),
}


@pytest.mark.parametrize(("argv", "says"), BAD.values(), ids=BAD)
def test_bad_input_is_one_line_and_leaves_nothing(
    argv: list[str], says: str, capsys: pytest.CaptureFixture[str], work: Path
) -> None:
    assert main(argv) == 2
    out, err = capsys.readouterr()
    assert err.startswith("lagrotor: ")
    assert err.count("\n") == 1
    assert says in err
    assert not out
    assert not list(work.iterdir())


def test_output_is_refused_before_the_run(monkeypatch: pytest.MonkeyPatch, work: Path) -> None:
    monkeypatch.setattr(simulate_module, "simulate", lambda *a, **k: pytest.fail("the run began"))
    (work / "folder.npz").mkdir()
    assert main([*SCENE, "--out", "folder.npz"]) == 2
    assert main([*SCENE, "--out", "folder.npz/run.txt"]) == 2


@pytest.mark.parametrize("argv", [[*SCENE, "--out", "run.npz"], ["figure", "17"], ["reproduce"]])
def test_read_only_folder_is_refused(
    argv: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert main(argv) == 2
    assert "cannot be written to" in capsys.readouterr().err


def test_folder_that_is_no_report_is_not_replaced(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (work / "thesis.tex").write_text("years of work")
    assert main(["reproduce", "--jobs", "1", "--out", "."]) == 2
    assert "holds thesis.tex, which is no part of a report" in capsys.readouterr().err
    assert (work / "thesis.tex").read_text() == "years of work"
    assert main(["reproduce", "--jobs", "1", "--out", "thesis.tex"]) == 2


@pytest.mark.parametrize(
    ("words", "status"),
    [("simulate --spins x 1", 2), ("rate --spins 10 -10 --json | true", 0), ("rate --spins 10 -10 >&-", 0)],
    ids=["bad input", "closed pipe", "closed output"],
)
def test_the_program_leaves_no_traceback(words: str, status: int) -> None:
    command, environment = f"{sys.executable} -m lagrotor {words}", os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, env=environment, check=False)
    assert (done.returncode, done.stdout) == (status, "")
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr
    assert done.stderr.count("\n") == (status == 2)


def test_help_is_quick_and_needs_nothing_heavy() -> None:
    code = (
        "import sys; from lagrotor.commands.command_line import main; main(['--help']);"
        "print(sorted({'sympy', 'matplotlib', 'scipy', 'numpy'} & sys.modules.keys()), file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(ROOT)}
    )
    assert done.stderr.strip() == "[]"
    assert "reproduce" in done.stdout


@pytest.mark.parametrize("command", ["reproduce", "audit", "claims", "figure", "simulate", "rate"])
def test_each_help_ends_with_an_example(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    assert capsys.readouterr().out.strip().splitlines()[-1].startswith(f"example: lagrotor {command}")


def test_run_is_written(work: Path) -> None:
    argv = f"{' '.join(SCENE)} --link-mass 0.01 --link-inertia 0.1 {' '.join(PULSE)} --t-end 10 --samples 1001"
    assert main([*argv.split(), "--model", "minimal", "--tol", "1e-11", "--out", "run.npz"]) == 0
    kept = np.load(work / "run.npz")
    shapes = {name: kept[name].shape for name in ("t", "axes", "tips", "energy", "link_length")}
    n = 1001
    assert shapes == {"t": (n,), "axes": (2, n, 3), "tips": (2, n, 3), "energy": (n,), "link_length": (n,)}
    assert kept["energy"][0] == pytest.approx(100)
    assert [path.name for path in work.iterdir()] == ["run.npz"]


def test_run_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    short = [*SCENE, "--t-end", "0.1", "--samples", "3"]
    assert main(short) == 0
    assert "closed_form (at rest without shock" in capsys.readouterr().out
    assert main([*short, "--model", "minimal"]) == 0
    out = capsys.readouterr().out
    for part in ("minimal", "evaluations", "energy", "link length", "tip 1", "tip 2"):
        assert part in out
    assert main([*short, "--model", "spheres", "--json", "--out", "run.csv"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["model"] == "spheres"
    assert summary["samples"] == 3
    assert summary["energy_last"] == pytest.approx(100)
    assert summary["tip_1"] == pytest.approx([-0.5, 0, 1])
    assert Path("run.csv").read_text().startswith("t [s],")


def test_negative_numbers_in_any_notation(capsys: pytest.CaptureFixture[str]) -> None:
    pulse = ["--shock", "-1e-3", "-.1", "-0", "--shock-time", "-1E0", "--shock-width", "0.1"]
    assert main(["simulate", "--spins", "10", "-1e1", *pulse, "--t-end", "0.1", "--samples", "2"]) == 0
    assert capsys.readouterr().out


def test_rate_with_its_limits(capsys: pytest.CaptureFixture[str]) -> None:
    a, b = 1.25 + 0.25 + 1, 0.25 - 1  # of the bar of 1 kg and 1 kg m²
    heavy = {"equal": 20 / (a + b), "opposite": 20 / np.sqrt(a * a - b * b), "massless": 16, "dumbbell": 20 / 1.75}
    massless = dict.fromkeys(("equal", "opposite", "massless", "dumbbell"), 8)  # I3 omega / J = 10 / (5/4)
    for words, limits in (("10 -10", massless), ("20 -20 --link-mass 1 --link-inertia 1", heavy)):
        argv = ["rate", "--spins", *words.split()]
        assert main([*argv, "--json"]) == 0
        answer = json.loads(capsys.readouterr().out)
        assert answer["rate"] == pytest.approx(limits["opposite"])
        assert answer["period"] == pytest.approx(2 * np.pi / limits["opposite"])
        assert answer.keys() == {"rate", "period", "limits"} and answer["limits"] == pytest.approx(limits)
        assert main(argv) == 0
        shown = capsys.readouterr().out
        assert f"{limits['opposite']:.12g} rad/s" in shown and "G/(a + b)" in shown and "G/√(a² − b²)" in shown
    assert main(["rate", "--spins", "0", "0"]) == 0
    assert "no oscillation" in capsys.readouterr().out


def test_pair_without_a_bar(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_scene(Scene(spins=(10, -10), link=None), work / "free.toml")
    assert main(["rate", "--scene", "free.toml", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["rate"] == pytest.approx(8)
    assert answer["limits"] == {}
    assert main(["rate", "--scene", "free.toml"]) == 0
    assert "limit" not in capsys.readouterr().out
    assert main(["sweep", "--scene", "free.toml", *VARY, "0", "1", "3"]) == 2
    assert "a pair without a bar has none" in capsys.readouterr().err


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_letters_that_a_pipe_lacks_are_no_traceback(encoding: str) -> None:
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONIOENCODING": encoding}
    argv = [sys.executable, "-m", "lagrotor", *SCENE, "--t-end", "0.1", "--samples", "3", "--out", "Ω.csv"]
    done = subprocess.run(argv, capture_output=True, env=environment, check=False)
    assert done.stdout.startswith(b"?.csv: 3 times"), done.stderr
    assert Path("Ω.csv").exists()


def test_a_claim_is_told_with_its_outcome(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    finding = claim_tests.Finding((claim_tests.Part("a part", False),), "word " * 40)
    test = claim_tests.ClaimTest("C08", (1, 1), {}, "", lambda case: {}, lambda measured: finding)
    found = claim_tests.Result(test, {}, finding, 0.0)
    monkeypatch.setattr(Paper, "evaluate", lambda paper, step, wanted: [found])
    assert main(["claims", "C08"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert " ".join(" ".join(lines).split()).startswith(f"C08 {readable(PAPER.claims['C08'].text)} refuted: word word")
    assert max(map(len, lines)) <= 100


def test_audit_table_and_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["audit"]) == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert [line[:4] for line in lines] == [*SINGLE_ROTOR, *(i for i in PAPER.equations if i not in SINGLE_ROTOR)], head
    assert all("  not yet judged  " in line for line in lines[len(SINGLE_ROTOR) :])
    assert "holds if" in lines[0] and "the transverse inertia about the ground joint" in lines[0]
    assert main(["audit", "5.02", "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["id"], row["verdict"], row["domain"]) == ("5.02", "holds-if", [r"\sin \theta \neq 0"])
    assert row["premises"][0]["says"].startswith("I₁ is read as") and row["premises"][0]["put"] == ["I_1 = J"]
    assert [line["verdict"] for line in row["lines"]] == ["holds-if"]


def test_one_equation_is_put_into_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["audit", "5.02"]) == 0
    out = capsys.readouterr().out
    parts = ("5.02  precession rate", "printed    φ̇ = ", "if         I₁ is read", "domain     sin(θ) ≠ 0")
    assert all(part in out for part in (*parts, "derivations/s5_2a"))


def test_what_is_wrong_and_right_is_said(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    line = Relation(M, M + R, quantity=r"\dot\phi")
    wrong = Statement("5.02", (Relation(M, R, quantity=r"\dot\phi"),), correction=(line,), wrong="It is another.")
    right = replace(wrong, correction=(replace(line, printed=R + M),))
    assert decide(wrong).correction_verdict == "refuted"
    monkeypatch.setattr(Paper, "statements", lambda paper, stem: [wrong])
    assert main(["audit", "5.02"]) == 2
    assert "5.02: its correction is refuted" in capsys.readouterr().err
    monkeypatch.setattr(Paper, "statements", lambda paper, stem: [right])
    assert main(["audit", "5.02"]) == 0
    out = capsys.readouterr().out
    assert "refuted" in out
    assert "wrong      It is another." in out
    assert "line       φ̇: refuted: the sides differ by M − R: printed − derived is" in out
    assert "right      φ̇ = M + R" in out
    assert "correction holds" in out


@pytest.mark.parametrize(
    ("change", "status"),
    [
        (lambda kept: kept, 0),
        (lambda kept: kept | {"5.02": "refuted"}, 1),
        (lambda kept: {i: v for i, v in kept.items() if i != "5.02"}, 1),
        (lambda kept: kept | {"5.15": "holds"}, 1),
    ],
    ids=["as recorded", "another verdict", "not on record", "no longer judged"],
)
def test_status_tells_whether_verdicts_are_as_recorded(
    change: Callable[[dict[str, str]], dict[str, str]],
    status: int,
    changed_paper: Paper,
    last_report: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    record(change(found()))
    assert main(["audit", "--json"]) == status
    assert main(["reproduce", "--jobs", "1"]) == status
    out, err = capsys.readouterr()
    assert err.count("lagrotor: changed: 5.") == 2 * status
    assert "5.01" in out


def test_only_the_asked_equations_are_compared(changed_paper: Paper) -> None:
    record(found() | {"5.02": "refuted"})
    assert main(["audit", "5.01"]) == 0
    assert main(["audit", "5.02"]) == 1


def test_broken_record_is_said(changed_paper: Paper, capsys: pytest.CaptureFixture[str]) -> None:
    changed_paper.record_file.write_text("{", encoding="utf-8")
    assert main(["audit"]) == 2
    assert "restore it" in capsys.readouterr().err


def test_figure_writes_the_same_bytes_twice(work: Path) -> None:
    assert main(["figure", "17", "17"]) == 0
    first = {path.name: path.read_bytes() for path in work.iterdir()}
    assert set(first) == {"fig17_stub.svg", "fig17_stub.png"}
    assert main(["figure", "17"]) == 0
    assert {path.name: path.read_bytes() for path in work.iterdir()} == first


def test_chart_names_what_it_wrote(
    work: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    points = tuple(ChartPoint("minimal", "core", tol, tol, 10, 0.1, 0.1) for tol in (1e-3, 1e-6))
    found = Benchmark("displaced", "a scene", points, (), {"minimal": 0.0}, 1e-12)
    monkeypatch.setattr(chart_module, "benchmarks", lambda quick, step: [found])
    assert main(["chart"]) == 0
    files = {path.name for path in work.iterdir()}
    assert files == {"chart.json", "chart-displaced.svg", "chart-displaced.png"}
    assert set(capsys.readouterr().out.splitlines()[-3:]) == files
    monkeypatch.setattr("lagrotor.pictures.benchmark_figures.speed_chart", lambda one: Figure())  # drawn above
    assert main(["chart", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["charts"][0]["scene"] == "displaced"


def test_figure_past_the_paper(changed_paper: Paper, work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    changed_paper.scripts.path("figures", "t6_stub").write_text(FIGURE, encoding="utf-8")
    assert main(["figure", "t6", "017"]) == 0
    assert {path.stem for path in work.iterdir()} == {"t6_stub", "fig17_stub"}
    assert main(["figure", "6"]) == 2
    assert "give one of 17, t6" in capsys.readouterr().err


def test_report_is_complete(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "--jobs", "1"]) == 0
    report = work / "report"
    kept = {str(path.relative_to(report)) for path in report.rglob("*") if path.is_file()}
    drawn = {f"figures/fig17_stub.{kind}" for kind in ("svg", "png")}
    pages = {name for name in kept if name.startswith("pages/")}
    assert {"pages/page.css", "pages/words.js", "pages/section-5.2.html", "pages/about.html"} <= pages
    assert kept - pages == folder.CONTENTS - {"figures", "pages", folder.CERTIFICATES} | drawn
    rows = json.loads((report / "verdicts.json").read_text())
    assert {row["id"] for row in rows if row["verdict"] != "not-yet-judged"} == set(found())
    assert {row["id"] for row in rows} == set(PAPER.equations)
    assert json.loads((report / "measured.json").read_text()) == {"fig17_stub": {"slope": 1.0}}
    out, err = capsys.readouterr()
    assert "no verdicts are on record" in err
    assert "taken" not in out


@pytest.mark.parametrize("stop", [KeyboardInterrupt, RuntimeError])
def test_interrupted_report_leaves_the_last_good_one(
    stop: type[BaseException], last_report: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    last = last_report / "index.html"
    good = last.read_text()
    (last_report / "figures" / "fig17_stub.svg").unlink()  # so that there is something to do

    def interrupted(*_: object) -> None:
        raise stop

    monkeypatch.setattr(reproduce, "errata_sheet", interrupted)
    if stop is KeyboardInterrupt:
        assert main(["reproduce", "--jobs", "1"]) == 130
        says = "interrupted: 2 of 3 results are kept, and the same command goes on from there"  # not a derivation with verdicts
        assert capsys.readouterr().err.splitlines()[-1] == f"lagrotor: {says}"
    else:
        with pytest.raises(stop):
            main(["reproduce", "--jobs", "1"])
    assert last.read_text() == good
    assert list(last_report.parent.iterdir()) == [last_report]


def test_report_of_an_older_version_may_be_replaced(last_report: Path) -> None:
    """It holds fewer files; but only what is a report."""
    (last_report / "report.tex").unlink()
    (last_report / "made.json").touch()
    assert main(["reproduce", "--jobs", "1"]) == 0
    assert (last_report / "report.tex").exists()
    (last_report / "verdicts.json").unlink()
    assert main(["reproduce", "--jobs", "1"]) == 2


def test_second_run_says_what_it_takes(last_report: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "--jobs", "1"]) == 0
    assert "all taken from the last run (same inputs)" in capsys.readouterr().out
    (last_report / "index.html").write_text("edited")
    assert main(["reproduce", "--jobs", "1"]) == 0
    assert "\n1 figure, 1 model taken from earlier runs (same inputs)\n" in capsys.readouterr().out


def test_what_latex_leaves_is_no_obstacle(last_report: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = last_report
    for name in ("report.pdf", "report.aux", "errata.log", "report.synctex.gz"):
        (report / name).touch()
    assert main(["reproduce", "--jobs", "1"]) == 0
    assert (report / "report.pdf").exists(), "nothing had changed"
    (report / "index.html").write_text("edited")
    assert main(["reproduce", "--jobs", "1"]) == 0
    assert {path.name for path in report.iterdir()} == folder.CONTENTS - {folder.CERTIFICATES}, (
        "the PDF was of the last report"
    )
    (report / "thesis.pdf").touch()
    assert main(["reproduce", "--jobs", "1"]) == 2
    assert "holds thesis.pdf, which" in capsys.readouterr().err


def test_report_without_the_converter_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(mathml_latex, "converter", lambda: "1.0")
    assert main(["reproduce", "--jobs", "1"]) == 0
    assert "pip install" not in capsys.readouterr().out
    monkeypatch.setattr(mathml_latex, "converter", lambda: "")
    monkeypatch.setattr(dependencies, "converters", dict)
    assert main(["reproduce", "--jobs", "1"]) == 0
    out = capsys.readouterr().out
    assert out.splitlines()[-1].endswith("pip install 'lagrotor[report]'")
    assert "all taken" not in out, "another page"


def test_interrupted_swap_puts_the_old_report_back(work: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = work / "report"
    with folder.replacement(target) as made:
        (made / "index.html").write_text("good")
    for name in folder.CONTENTS - {"index.html"}:
        (target / name).touch()
    rename = Path.rename

    def failing(path: Path, to: Path) -> Path:
        if path.name.startswith(".report.new-"):
            raise KeyboardInterrupt
        return rename(path, to)

    monkeypatch.setattr(Path, "rename", failing)
    with pytest.raises(KeyboardInterrupt), folder.replacement(target) as made:
        (made / "index.html").write_text("new")
    assert (target / "index.html").read_text() == "good"
    assert [path.name for path in work.iterdir()] == ["report"]


def test_two_runs_at_once_do_not_touch_each_other(work: Path) -> None:
    """The folder of a run that lives is left alone: here that of the process that runs the tests' parent."""
    other = work / f".report.new-{os.getppid()}"
    other.mkdir()
    with folder.replacement(work / "report") as made:
        assert made != other
        (made / "index.html").write_text("mine")
    assert other.is_dir()
    assert (work / "report" / "index.html").read_text() == "mine"


def test_killed_swap_is_mended_by_the_next_run(work: Path) -> None:
    (work / ".report.old").mkdir()
    (work / ".report.old" / "index.html").write_text("good")
    (work / ".report.new-999999999").mkdir()
    with pytest.raises(RuntimeError), folder.replacement(work / "report"):
        raise RuntimeError
    assert (work / "report" / "index.html").read_text() == "good"
    assert [path.name for path in work.iterdir()] == ["report"]


def test_progress_is_a_line_a_step_or_one_line_in_a_terminal(
    changed_paper: Paper, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    record(found())
    assert main(["reproduce", "--jobs", "1"]) == 0
    first, *lines = capsys.readouterr().err.splitlines()
    assert first == "lagrotor: 3 of 3 results to compute, with --jobs 1", "no recorded times, so no remaining time"
    assert [re.sub(r" +\d+ s  ", " ", line) for line in lines] == [
        "[1/4] derivation s5_2a_single_rotor",
        "[2/4] figure 17",
        "[3/4] model",
        "[4/4] report",
    ]
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert main(["reproduce", "--jobs", "1", "--out", "another"]) == 0
    shown = capsys.readouterr().err
    assert shown.count("\n") == 1
    assert shown.count("\r[") == 2, "a derivation and the report"
    assert main(["reproduce", "--jobs", "1", "--out", "another"]) == 0
    assert not capsys.readouterr().err, "nothing to do"


def test_a_second_run_into_the_same_folder_is_refused(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with folder.replacement(work / "report") as made:
        assert main(["reproduce", "--jobs", "1"]) == 2
        assert "is being written by another run" in capsys.readouterr().err
        for name in ("index.html", "verdicts.json"):
            (made / name).write_text("mine")
    assert (work / "report" / "index.html").read_text() == "mine"
    assert [path.name for path in work.iterdir()] == ["report"], "the lock is gone"
    (work / ".report.lock").write_text("999999999")  # of a run that was killed
    with folder.replacement(work / "report"):
        pass


def test_a_terminated_run_leaves_nothing_behind(work: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    context, said = get_context("fork"), work.parent / "said"
    begun = context.Event()

    def wait(*_: object) -> None:
        begun.set()
        time.sleep(60)

    def program() -> None:
        with said.open("w") as sys.stderr:
            sys.exit(main(["reproduce", "--jobs", "1"]))

    monkeypatch.setattr(reproduce, "_make", wait)
    running = context.Process(target=program)
    running.start()
    assert begun.wait(60)
    running.terminate()
    running.join()
    assert running.exitcode == 143
    assert said.read_text() == "lagrotor: terminated: no result is kept yet, and the same command begins again\n"
    assert not list(work.iterdir())


def test_table_wraps_at_the_edge_of_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [("5.01", "holds", "word " * 30)]
    assert terminal.table(("id", "verdict", "title"), rows).count("\n") == 1
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "60")
    lines = terminal.table(("id", "verdict", "title"), rows).splitlines()
    assert len(lines) > 3
    assert max(map(len, lines)) <= 60


LOADING = """
import os, signal, sys
import lagrotor.__main__ as command

signal.signal(signal.SIGINT, signal.default_int_handler)  # one that began in the background ignores it

class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == "lagrotor.commands.command_line":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interrupt())
"""


@pytest.mark.skipif(os.name != "posix", reason="a process interrupts itself by a POSIX signal")
@pytest.mark.parametrize(
    ("call", "silent"), [("command.start()", True), ("import lagrotor.commands.command_line", False)]
)
def test_an_interrupt_while_the_command_loads_leaves_no_traceback(call: str, silent: bool) -> None:
    done = subprocess.run([sys.executable, "-c", LOADING + call], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert ("Traceback" not in done.stderr) == silent
