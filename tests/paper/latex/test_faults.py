r"""What TeX would stop at is said with its line, and is no reason to lose what follows; what cannot be a source is refused."""

import json
from pathlib import Path

import pytest

from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.paper.latex.markup import read_source

AFTER = "\nWords.\n\n\\[ x = y \\]\n"
FAULTS = {
    "\\begin{equation} a = b\n\nText after $x = 1$.": (2, r"\begin{equation} is not ended", ["a = b", "x = y"]),
    "\\begin{align} a &= b \\\\ c &= d \\end{equation}": (
        2,
        r"\end{equation} ends \begin{align}",
        ["a = b", "c = d", "x = y"],
    ),
    "\\begin{itemize}\n\\item $a$": (2, r"\begin{itemize} is not ended", ["x = y"]),
    "\\end{equation}": (2, r"\end{equation} ends nothing that has begun", ["x = y"]),
    "\\begin{itemize}\n\\item {\\bf bold\n\\end{itemize}": (3, "{ is not closed", ["x = y"]),
    "\\def\\be{\\begin{equation}}\\def\\ee{\\end{equation}}\n\\be a = b \\ee\n\\be c = d\n\nText.": (
        4,
        r"\begin{equation} is not ended",
        ["a = b", "c = d", "x = y"],
    ),
    "bold}": (2, "} closes no {", ["x = y"]),
    "a\n\\[ \\left( a = b \\]": (3, r"\left is not closed by \right", [r"\left( a = b", "x = y"]),
    "\\[ a \\right) = b \\]": (2, r"\right closes no \left", [r"a \right) = b", "x = y"]),
    "$$ a = b\n\nThen we know. $$ c = d $$": (2, "$$ is not closed", ["a = b", "c = d", "x = y"]),
    "\\[ a = b\n\n": (2, r"\[ is not closed", ["a = b", "x = y"]),
    "a = b \\]": (2, r"\] ends nothing that has begun", ["x = y"]),
    "It costs $5.": (2, "$ is not closed in its paragraph", ["x = y"]),
    "\\verb|a": (2, r"\verb is not closed in its line", ["x = y"]),
    "\\begin{verbatim} a": (2, r"\begin{verbatim} is not ended", ["x = y"]),
    "\\iffalse hidden": (2, r"\iffalse has no \fi: what follows is left out", []),
    "\\newcommand{\\q}{a": (2, "{ is not closed: what follows is taken as its argument", []),
}


def whole(body: str) -> str:
    return f"\\documentclass{{article}}\\begin{{document}}\n{body}{AFTER}\\end{{document}}\n"


@pytest.mark.parametrize("body", FAULTS)
def test_what_is_not_ended_is_said_and_what_follows_is_read(body: str, tmp_path: Path) -> None:
    line, said, displays = FAULTS[body]
    (file := tmp_path / "paper.tex").write_text(whole(body))
    source = read_source(file)
    assert ("paper.tex", line, said) in source.faults
    assert [each.latex for each in source.equations] == displays


@pytest.mark.parametrize(
    "body",
    [
        r"$\left( \begin{array}{ll} a & \text{if $x$} \\ b & c \end{array} \right.$ {\bf \[ a = \text{b if $c$} \]}",
        r"\def\be{\begin{equation}}\def\ee{\end{equation}} \be \left\{ a \right\} = b \ee \begingroup a \endgroup",
        r"\newenvironment{eq}{\begin{equation}\left(}{\right)\end{equation}} \begin{eq} a \end{eq}",
        r"\begin{align} a &= \begin{cases} b & c \\ d & e \end{cases} \\ f &= \{ g \} \end{align} \url{http://a.b/%20c}",
        r"\DefineShortVerb{\|} \verb|{a| and |}| $\begin{pmatrix} a \\ b \end{pmatrix}$ \newif\ifx \ifnum 1=1 {a} \fi",
        r"$\vu$ $\vu\left(a\right)$",
        "{\\bf TeX warns of this brace, and ends",
        "\\DefineVerbatimEnvironment{Code}{Verbatim}{} \\begin{Code}\n} % $ \\end{document} { \\verb|\n\\end{Code}",
        "\\newenvironment{c}{\\VerbatimEnvironment\\begin{minted}{c}}{\\end{minted}} \\begin{c}\n}$\n\\end{c}",
        "\\lstnewenvironment{c}[1][]{\\lstset{#1}}{} \\begin{c}[a=b]\n} \\begin{equation}\n\\end{c}",
        "\\newcommand{\\code}{\\lstinline[a=b]} \\code.{%a. \\code|}| \\lstinline[a=b]|{%|",
        "\\tikzstyle{a b}= [c, begin={\\begin{varwidth}{5em}}, end={\\end{varwidth}}] \\tikzset{a={\\begin{center}}}",
        r"\resizebox{1cm}{!}{\begin{tikzpicture} \onslide<1>{ \node {a}; \end{tikzpicture} } }",
        "\\begin{shown}\n} $ \\begin{equation} \n\\end{shown} \\code|{%| \\code{a % b}",
        r"\expandafter\def\expandafter\baz\eatone##1{(#1)} \ifundef{\begin}{a}{b}",
    ],
)
def test_nothing_is_said_of_what_is_ended(body: str, tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(whole(body))
    source = read_source(file)
    assert source.faults == []
    assert source.equations[-1].latex == "x = y"


def test_what_a_class_beside_the_source_does_is_no_fault_of_the_source(tmp_path: Path) -> None:
    (tmp_path / "own.cls").write_text(
        r"\newenvironment{side}{\begin{lrbox}{\x}}{\end{lrbox}}\def\normal{\more\normal}\normal"
        r"\newcommand\open[1]{\begin{minipage}{#1}}"
    )
    (file := tmp_path / "paper.tex").write_text(
        whole("\\begin{side} a \\end{side} \\open{1cm} b").replace("article", "own")
    )
    assert read_source(file).faults == []
    file.write_text(file.read_text().replace(AFTER, f"\\begin{{equation}} a{AFTER}"))
    assert [said for *_, said in read_source(file).faults] == [r"\begin{equation} is not ended"]


def test_what_a_preamble_leaves_open_is_no_fault(tmp_path: Path) -> None:
    opens = r"\AtBeginDocument{\begin{center}}\AtEndDocument{\end{center}}\begin{document}"
    (file := tmp_path / "paper.tex").write_text(whole("a").replace(r"\begin{document}", opens))
    assert read_source(file).faults == []


def test_a_fault_is_a_finding_and_a_note(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file := tmp_path / "my paper.tex").write_text(whole("\\begin{equation} a = b\n\nText after it."))
    assert main(["check", str(file), "--json"]) == 1
    assert json.loads(capsys.readouterr().out) == [
        {"equation": "", "step": 0, "line": 2, "verdict": "no LaTeX", "why": r"\begin{equation} is not ended"}
    ]
    assert main(["init", str(tmp_path / "new"), "--from", str(file)]) == 0
    assert r"my paper.tex:2: \begin{equation} is not ended" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.tex", bytes(range(256)) * 9, "is no text"),
        ("a.tex", b"%PDF-1.4 text", "is no text"),
        ("a.pdf", b"%PDF-1.4 text", "give a .tex, .md or .ipynb file"),
        (
            "a.tex",
            b"\\[ a = b \\] \\input{b}",
            r"takes in itself, by itself or through another file: leave out one \\input",
        ),
        ("a.tex", b"%" * 21_000_000, "has 21 MB, more than 20: give its parts"),
        ("a.ipynb", b'{"cells": [{"cell_type": "markdown", "source": 5}]}', "it is no notebook"),
    ],
)
def test_what_is_no_source_is_refused(name: str, content: bytes, said: str, tmp_path: Path) -> None:
    (tmp_path / "b.tex").write_text(r"\input{a}")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=said):
        read_source(tmp_path / name)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_every_encoding_and_end_of_line_gives_the_same(encoding: str, end: str, tmp_path: Path) -> None:
    (file := tmp_path / "PAPER.TEX").write_bytes(
        whole("% é\n\\begin{align}\n a &= b \\\\\n é &= c\n\\end{align}").replace("\n", end).encode(encoding)
    )
    source = read_source(file)
    assert [each.latex for each in source.equations] == ["a = b", "é = c", "x = y"]
    assert source.equations[1].place == ("PAPER.TEX", 5)
    assert source.faults == []


def test_half_a_letter_in_a_notebook_is_written(tmp_path: Path) -> None:
    (file := tmp_path / "a.ipynb").write_text(
        json.dumps({"cells": [{"cell_type": "markdown", "source": ["$$a = \ud800$$"]}]})
    )
    assert main(["init", str(tmp_path / "new"), "--from", str(file)]) == 0


def test_a_part_that_could_stand_by_itself_does_not_end_the_source(tmp_path: Path) -> None:
    part = "\\documentclass{standalone}\\begin{document}\\[ c = d \\]\\end{document}\n"
    (tmp_path / "part.tex").write_text(part)
    (file := tmp_path / "paper.tex").write_text(whole("\\begin{figure}\\input{part}\\end{figure}"))
    source = read_source(file)
    assert [each.latex for each in source.equations] == ["c = d", "x = y"]
    assert source.faults == []


STRANGE = "\\documentclass{strange}\n\\begin{document}\n%s\n\\[ a = b \\]\n\\end{document}"


@pytest.mark.parametrize(
    "body",
    [
        r"\begin{seq} x = y+1 \end{seq}",
        r"\begin{seq}[left]{wide} F_{max other} = \frac{a}{b} \label{eq_a} \end{seq}",
        r"\def\bq{\begin{seq}}\def\eq{\end{seq}} \bq \alpha^2 \text{ for all real numbers} \eq",
        r"\begin{box}Words. \begin{seq} \begin{split} a &= b \end{split} \end{seq}\end{box}",
    ],
)
def test_an_environment_that_no_file_defines_and_that_holds_a_formula_is_said_once(body: str, tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(STRANGE % body)
    (note,) = read_source(file).notes
    assert note.startswith(
        r"paper.tex:3: \begin{seq} is not known, and its formula is passed over: put strange.cls, loaded"
    )
    file.write_text(STRANGE.replace("strange", "article") % f"{body}\n{body}")
    (note,) = read_source(file).notes
    assert note.endswith(r"as is 1 more of this name: write equation, or define it by \newenvironment{seq}")
    file.write_text(STRANGE % rf"\newenvironment{{seq}}{{}}{{}}{body}")
    assert read_source(file).notes == [], "it is defined"


@pytest.mark.parametrize(
    "body",
    [
        r"\begin{lemmaq}[Euler $x = y$] Let $x_1 = y$. \[ a^2 = b \] \begin{align} \frac12 &= a \end{align} \end{lemmaq}",
        r"\begin{block}{x = y} \includegraphics[width=0.5\textwidth]{a_b} \cite{a_b} \caption{$a$ = b} \end{block}",
        r"\begin{kframe} key_name = value of it \end{kframe} \begin{jscode} x = y \end{jscode}",
        r"\begin{picture}(1,1) x_1 = y \end{picture} \begin{tikzcd} A_1 \arrow[r] & B^2 \end{tikzcd}",
        r"\begin{ltabu} a = b \end{ltabu}",
        r"\begin{steps} \item<1-> $a_1$ = $b$ \item[x = y] \(c^2\) 100\% \end{steps} \begin{boxes} \end{boxes}",
        "\\begin{session}\nx = 2; y_1 # the second\n\\end{session} \\begin{seq} % x = y\n\\end{seq}",
    ],
)
def test_an_environment_of_words_drawings_or_code_is_not_said(body: str, tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(STRANGE % body)
    assert read_source(file).notes == []


def test_a_source_whose_only_displays_are_unknown_says_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (file := tmp_path / "paper.tex").write_text(whole(r"\begin{seq} x = y+1 \end{seq}").replace(AFTER, ""))
    assert main(["init", str(tmp_path / "new"), "--from", str(file)]) != 0
    assert r"\begin{seq} is not known" in capsys.readouterr().err
    assert main(["check", str(file)]) == 0
    assert r"\begin{seq} is not known" in capsys.readouterr().err
