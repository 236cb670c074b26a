"""A paper of one's own from the shell: begun, audited, reported, tested by pytest; and one from a LaTeX file, end to end."""

import json
import multiprocessing
import re
import sys
from collections.abc import Callable
from importlib.metadata import entry_points
from pathlib import Path

import pytest

import lagrotor
from lagrotor.commands.command_line import main
from lagrotor.paper import Paper
from lagrotor.paper.papers import opened

ROOT = Path(lagrotor.__file__).parent.parent


@pytest.fixture(autouse=True)
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_new_paper_is_green_at_once(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", "my-paper"]) == 0
    assert "my-paper: 1 equation" in capsys.readouterr().out
    for command in (["audit"], ["audit", "1.1", "--json"], ["claims"], ["figure", "1"]):
        assert main([*command, "--paper", "my-paper"]) == 0, command
    capsys.readouterr()
    assert main(["reproduce", "--paper", "my-paper", "--jobs", "1"]) == 0
    assert "1 equation: 1 holds to order\n1 claim tested: 1 confirmed\n1 figure" in capsys.readouterr().out
    for name in ("index.html", "report.md", "report.tex", "errata.tex"):
        text = (work / "report" / name).read_text(encoding="utf-8")
        assert "my-paper" in text and "otor Pairs" not in re.sub(r"(?s)How to cite.*", "", text), name
    assert 'id="model"' not in (work / "report" / "whole.html").read_text(encoding="utf-8"), "it has none"
    assert main(["reproduce", "--paper", "my-paper", "--jobs", "1"]) == 0
    assert "all taken from the last run" in capsys.readouterr().out


def test_a_changed_letter_or_print_makes_the_report_anew(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["reproduce", "--paper", "my-paper", "--jobs", "1"]
    assert main(["init", "my-paper"]) == 0
    before = multiprocessing.get_context("fork").Process(target=lambda: sys.exit(main(command)))
    before.start()  # in a process of its own: what this one reads of a file, it keeps
    before.join()
    assert before.exitcode == 0
    equations = work / "my-paper" / "equations.toml"
    equations.write_text(equations.read_text().replace('"-g/l*theta"', '"g/l*theta"'))
    assert main(command) == 1
    assert "changed: 1.1: recorded holds-to-order, found refuted" in capsys.readouterr().err


def test_a_folder_with_other_files_is_refused(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (work / "something").touch()
    assert main(["init", "."]) == 2
    assert "choose a new or an empty folder" in capsys.readouterr().err
    assert [path.name for path in work.iterdir()] == ["something"]


def test_a_script_that_fails_is_one_line_with_its_place(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", "my-paper"]) == 0
    script = work / "my-paper" / "derivations" / "s1_motion.py"
    script.write_text(script.read_text() + "1 / 0\n")
    last = len(script.read_text().splitlines())
    capsys.readouterr()
    assert main(["audit", "--paper", "my-paper"]) == 2
    line = capsys.readouterr().err.splitlines()[-1]
    assert re.fullmatch(rf"lagrotor: .*s1_motion\.py:{last}: ZeroDivisionError: division by zero", line), line


@pytest.fixture
def plugged_in(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str]]:
    """`pytest --lagrotor …` in this process: its exit status and what it prints."""
    named = [] if entry_points(group="pytest11", name="lagrotor") else ["-p", "lagrotor.commands.pytest_plugin"]
    less = ["-p", "no:cacheprovider", "-p", "no:faulthandler", "-p", "no:xdist", "--capture=no"]

    def run(*argv: str) -> tuple[int, str]:
        capsys.readouterr()
        status = pytest.main([*named, *less, *argv])
        return int(status), capsys.readouterr().out

    return run


def test_each_verdict_on_record_is_a_test_with_the_reason_when_it_changes(
    work: Path, plugged_in: Callable[..., tuple[int, str]]
) -> None:
    assert main(["init", "my-paper"]) == 0
    before = multiprocessing.get_context("fork").Process(
        target=lambda: sys.exit(plugged_in("--lagrotor", "my-paper")[0])
    )
    before.start()  # in a process of its own: what this one reads of a file, it keeps
    before.join()
    assert before.exitcode == 0
    equations = work / "my-paper" / "equations.toml"
    equations.write_text(equations.read_text().replace('"-g/l*theta"', '"g/l*theta"'))
    status, out = plugged_in("--lagrotor", "my-paper")
    assert status == 1 and "1 failed, 1 passed" in out
    assert "1.1: recorded holds-to-order, found refuted" in out
    assert "the sides first differ at order 1 in θ" in out and "Traceback" not in out
    assert plugged_in("--lagrotor", "nowhere")[0] == 4


def test_what_is_on_record_and_no_longer_there_fails(work: Path, plugged_in: Callable[..., tuple[int, str]]) -> None:
    assert main(["init", "my-paper"]) == 0
    (work / "my-paper" / "recorded.toml").write_text(
        '["1.1"]\nverdict = "holds-to-order"\n["1.2"]\nverdict = "holds"\n'
    )
    _, out = plugged_in("--lagrotor", "my-paper")
    assert "2 failed, 1 passed" in out
    assert "1.2: recorded holds, found nothing" in out
    assert "C01: recorded nothing, found confirmed" in out


CHAIN = r"""
\documentclass{article}
\title{Two coupled oscillators}
\author{A. Student}
\begin{document}
\section{Motion}
\begin{equation}\label{eq:lagrangian}
  L = \frac{m}{2}\left(\dot{x}_1^2 + \dot{x}_2^2\right) - \frac{k}{2}\left(x_1^2 + x_2^2\right) - \frac{c}{2}(x_1 - x_2)^2
\end{equation}
\begin{align}
  m\ddot{x}_1 &= -k x_1 + c(x_1 - x_2) \label{eq:first} \\
  m\ddot{x}_2 &= -k x_2 + c(x_1 - x_2)
\end{align}
\section{Modes}
\begin{equation} \omega_+^2 = \frac{k}{m} \end{equation}
\begin{equation} \omega_-^2 = \frac{k + 2 c}{m} \end{equation}
\[ \vec{F} = -\nabla V \]
\end{document}
"""
MODES = """# %% [markdown]
# # Two coupled oscillators

# %%
import sympy as sp
from symbols import c, k, m, x_1, x_1_dot, x_2, x_2_dot

from lagrotor.mechanics import System, coordinates
from lagrotor.paper import verdict

q = coordinates("x_1 x_2")
pair = System(q, m * (x_1_dot**2 + x_2_dot**2) / 2 - k * (x_1**2 + x_2**2) / 2 - c * (x_1 - x_2) ** 2 / 2)
verdict("1", pair.L)
forces = [m * a for a in sp.solve(list(pair.motion), list(q.a), dict=True)[0].values()]
verdict("2", forces[0], correction=-k * x_1 - c * (x_1 - x_2), wrong="The sign of the coupling.")
verdict("3", forces[1])
same, opposite = (sp.cancel(-forces[0].subs(x_2, sign * x_1) / (m * x_1)) for sign in (1, -1))
verdict("4", same)
verdict("5", opposite)
"""


def test_a_latex_file_becomes_a_paper_that_is_judged(work: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (work / "chain.tex").write_text(CHAIN, encoding="utf-8")
    assert main(["init", "chain", "--from", "chain.tex"]) == 0
    assert "6 equations; 5 read" in capsys.readouterr().out
    paper = Paper(work / "chain")
    assert (paper.title, paper.about.authors) == ("Two coupled oscillators", ("A. Student",))
    assert [(e.id, e.title) for e in paper.equations.values()][1] == ("2", "eq:first")
    assert main(["audit", "--paper", "chain", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["verdict"] for row in rows] == ["not-yet-judged"] * 6, "nothing is derived yet"

    (work / "chain" / "derivations" / "s1_modes.py").write_text(MODES, encoding="utf-8")
    unconfirmed = Paper(work / "chain").audit()
    assert unconfirmed.counts == {"undecided": 5, "not-yet-judged": 1}, "no reading is confirmed"
    assert "it would be refuted" in unconfirmed["2"].evidence[0]
    assert main(["readings", "chain", "--confirm", "1", "2", "3", "4", "5"]) == 0
    opened.cache_clear()  # a new process reads the folder again
    audit = Paper(work / "chain").audit()
    assert audit.counts == {"holds": 4, "refuted": 1, "not-yet-judged": 1}
    assert (audit["2"].verdict, audit["2"].correction_verdict) == ("refuted", "holds")

    assert main(["reproduce", "--paper", "chain", "--jobs", "1"]) == 0
    assert "6 equations: 4 holds, 1 refuted, 1 not yet judged" in capsys.readouterr().out
    report = (work / "report" / "report.md").read_text(encoding="utf-8")
    assert '"Two coupled oscillators"' in report.splitlines()[0] and "## Not yet judged" in report
    assert "1 more is not yet judged" in report
    assert r"\emph{Two coupled oscillators}" in (work / "report" / "errata.tex").read_text(encoding="utf-8")
