r"""What TeX would stop at is said with its line, and is no reason to lose what follows; what cannot be a source is refused."""

import json
from pathlib import Path

import pytest

from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.paper.latex.displays import read_source

AFTER = "\nWords.\n\n\\[ x = y \\]\n"
FAULTS = {
    "\\begin{equation} a = b\n\nText after $x = 1$.": (2, r"\begin{equation} is not ended", ["a = b", "x = y"]),
    "\\begin{equation} a = b\n\n\\end{equation}": (2, r"\begin{equation} is not ended", ["a = b", "x = y"]),
    "\\begin{align} a &= b \\\\ c &= d \\end{equation}": (
        2,
        r"\end{equation} ends \begin{align}",
        ["a = b", "c = d", "x = y"],
    ),
    "\\end{equation}": (2, r"\end{equation} has no matching opening", ["x = y"]),
    "\\def\\be{\\begin{equation}}\\def\\ee{\\end{equation}}\n\\be a = b \\ee\n\\be c = d\n\nText.": (
        4,
        r"\begin{equation} is not ended",
        ["a = b", "c = d", "x = y"],
    ),
    "$$ a = b\n\nThen we know. $$ c = d $$": (2, "$$ is not closed", ["a = b", "c = d", "x = y"]),
    "\\[ a = b\n\n": (2, r"\[ is not closed", ["a = b", "x = y"]),
    "\\[ a = b \\section{S}": (2, r"\[ is not closed", ["a = b", "x = y"]),
    "a = b \\]": (2, r"\] has no matching opening", ["x = y"]),
    "It costs $5.": (2, "$ is not closed in its paragraph", ["x = y"]),
    "\\verb|a": (2, r"\verb is not closed on its line", ["x = y"]),
    "\\iffalse hidden": (2, r"\iffalse has no \fi: the text up to the end is skipped", []),
    "\\newcommand{\\q}{a": (2, "{ is not closed: the text up to the end becomes the argument", []),
    "\\newcommand{\\q}[1][a]{#1} \\q[0, 1)": (2, "the argument has no closing ] in its paragraph", ["x = y"]),
}


def whole(body: str) -> str:
    return f"\\documentclass{{article}}\\begin{{document}}\n{body}{AFTER}\\end{{document}}\n"


@pytest.mark.parametrize("body", FAULTS)
def test_what_is_not_ended_is_said_and_what_follows_is_read(body: str, tmp_path: Path) -> None:
    line, said, displays = FAULTS[body]
    (file := tmp_path / "paper.tex").write_text(whole(body))
    source = read_source(file)
    assert ("paper.tex", line, said) in source.faults
    assert len(source.faults) <= 1 + body.startswith("$$")  # the second $$ of the two is closed by the third
    assert [each.latex for each in source.equations] == displays


@pytest.mark.parametrize(
    "body",
    [
        r"$\left( \begin{array}{ll} a & \text{if $x$} \\ b & c \end{array} \right.$ {\bf \[ a = \text{b if $c$} \]}",
        r"\def\be{\begin{equation}}\def\ee{\end{equation}} \be \left\{ a \right\} = b \ee \begingroup a \endgroup",
        r"\newenvironment{eq}{\begin{equation}\left(}{\right)\end{equation}} \begin{eq} a \end{eq}",
        r"\begin{align} a &= \begin{cases} b & c \\ d & e \end{cases} \\ f &= \{ g \} \end{align} \url{http://a.b/%20c}",
        r"\begin{gather} a = b \\ \begin{align} c &= d \\ &= e \end{align} \end{gather}",
        "{\\bf TeX warns of this brace, and ends",
        "\\tikzset{a={\\begin{center}}} \\lstinline[a=b]|{%| \\begin{itemize} \\item a \\end{enumerate} b}",
        "\\begin{verbatim}\n} $ \\begin{equation} \n\\end{verbatim}",
    ],
)
def test_nothing_is_said_of_what_is_ended(body: str, tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(whole(body))
    source = read_source(file)
    assert source.faults == []
    assert source.equations[-1].latex == "x = y"


def test_a_fault_is_a_finding_and_a_note(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file := tmp_path / "my paper.tex").write_text(whole("\\begin{equation} a = b\n\nText after it."))
    assert main(["check", str(file), "--json"]) == 1
    finding = {"equation": "", "step": 0, "line": 2, "verdict": "no LaTeX", "why": r"\begin{equation} is not ended"}
    assert json.loads(capsys.readouterr().out)["findings"] == [finding]
    assert main(["init", str(tmp_path / "new"), "--from", str(file)]) == 0
    assert r"my paper.tex:2: \begin{equation} is not ended" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.tex", bytes(range(256)) * 9, "is not text"),
        ("a.tex", b"%PDF-1.4 text", "is not text"),
        ("a.pdf", b"%PDF-1.4 text", "give a .tex file"),
        (
            "a.tex",
            b"\\[ a = b \\] \\input{b}",
            r"includes itself, directly or through another file: remove one \\input",
        ),
        ("a.tex", b"%" * 21_000_000, "has 21 MB, more than the limit of 20 MB: give its parts"),
    ],
)
def test_what_is_no_source_is_refused(name: str, content: bytes, said: str, tmp_path: Path) -> None:
    (tmp_path / "b.tex").write_text(r"\input{a}")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=said):
        read_source(tmp_path / name)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_every_encoding_and_end_of_line_gives_the_same(encoding: str, tmp_path: Path) -> None:
    end = {"utf-8": "\n", "utf-8-sig": "\r\n"}.get(encoding, "\r")
    (file := tmp_path / "PAPER.TEX").write_bytes(
        whole("% é\n\\begin{align}\n a &= b \\\\\n é &= c\n\\end{align}").replace("\n", end).encode(encoding)
    )
    source = read_source(file)
    assert [each.latex for each in source.equations] == ["a = b", "é = c", "x = y"]
    assert source.equations[1].place == ("PAPER.TEX", 5)
    assert source.faults == []


def test_a_part_that_could_stand_by_itself_does_not_end_the_source(tmp_path: Path) -> None:
    part = "\\documentclass{standalone}\\begin{document}\\[ c = d \\]\\end{document}\n"
    (tmp_path / "part.tex").write_text(part)
    (file := tmp_path / "paper.tex").write_text(whole("\\begin{figure}\\input{part}\\end{figure}"))
    source = read_source(file)
    assert [each.latex for each in source.equations] == ["c = d", "x = y"]
    assert source.faults == []


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (r"\begin{seq} x^2 = y+1 \end{seq}", r"a formula is in \begin{seq}, which is unknown: define this environment"),
        (r"\def\bq{\begin{seq}}\def\eq{\end{seq}} \bq \alpha^2 \text{ for all} \eq", r"a formula is in \begin{seq}"),
        (r"\begin{numcases}{f =} a = b \end{numcases}", r"\begin{numcases} is not read: write equation or align"),
        (r"\begin{box}Words. \begin{seq} x^2 \end{seq}\end{box}", r"a formula is in \begin{seq}"),
        (r"\beq E = m v^2 \eeq", "a formula is outside any environment: define the command that begins it"),
        (r"\begin{lemmaq}[Euler $x = y$] Let $x_1 = y$. \[ a^2 = b \] \begin{align} \frac12 &= a \end{align} \end{lemmaq}", ""),
        (r"\begin{block}{x = y} \includegraphics[width=0.5\textwidth]{a_b} \cite{a_b} \caption{$a$ = b} \end{block}", ""),
        (r"\begin{tikzcd} A_1 \arrow[r] & B^2 \end{tikzcd}", ""),
        (r"\def\beq{\[}\def\eeq{\]}\beq E = m v^2 \eeq \ang{5} a\textsuperscript{2} \verb|^|", ""),
    ],
)  # fmt: skip
def test_a_formula_that_nothing_known_displays_is_said_once(body: str, said: str, tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(whole(f"{body}\n{body}"))
    notes = read_source(file).notes
    assert len(notes) == bool(said) and all(note.startswith(f"paper.tex:2: {said}") for note in notes)


def test_a_source_whose_only_displays_are_unknown_says_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file := tmp_path / "paper.tex").write_text(whole(r"\begin{seq} x^1 = y+1 \end{seq}").replace(AFTER, ""))
    assert main(["init", str(tmp_path / "new"), "--from", str(file)]) != 0
    assert r"in \begin{seq}, which is unknown" in capsys.readouterr().err
    assert main(["check", str(file)]) == 0
    assert r"in \begin{seq}, which is unknown" in capsys.readouterr().err
