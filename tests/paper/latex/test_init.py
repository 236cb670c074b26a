"""A folder made from a source, and made again: what is confirmed or derived stays, what has changed is marked."""

import tomllib
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.paper import Paper
from lagrotor.paper.latex.init import begin_paper, confirm, declare

TEX = r"""\documentclass{article}
\newcommand{\half}{\frac{1}{2}}
\begin{document}
\section{Energy}
\begin{equation}\label{eq:T} T = \half m v^2 \end{equation}
\begin{equation}\label{eq:p} p = m v \end{equation}
\begin{equation} \vec L = \vec r\times\vec p \end{equation}
\end{document}
"""


def rows(folder: Path) -> dict[str, dict[str, Any]]:
    given = tomllib.loads((folder / "equations.toml").read_text(encoding="utf-8"))
    return {row["id"]: row for row in given["equation"]}


@pytest.fixture
def source(tmp_path: Path) -> Path:
    file = tmp_path / "paper.tex"
    file.write_text(TEX, encoding="utf-8")
    begin_paper(tmp_path / "mine", file)
    return file


def test_macros_are_expanded_in_what_is_stored_and_nothing_is_confirmed(source: Path) -> None:
    folder = source.parent / "mine"
    found = rows(folder)
    assert found["1"]["latex"] == r"T = \frac{1}{2} m v^2" and found["1"]["label"] == "eq:T"
    assert {row["read"] for row in found.values()} == {"unconfirmed"}
    paper = Paper(folder)
    assert not paper.equation("1").is_confirmed
    assert [str(member) for line in paper.lines("1") for member in line.members] == ["m*v**2/2"]
    assert paper.lines("3")[0].members[0].shape == (3, 1), "vectors are declared"


def test_what_is_confirmed_stays_and_what_has_changed_is_marked(source: Path) -> None:
    folder = source.parent / "mine"
    confirm(folder, ["1", "2"])
    assert Paper(folder).equation("1").is_confirmed
    more = r"\begin{equation} q = 1 \end{equation}" + "\n" + r"\begin{equation}\label{eq:T}"
    source.write_text(
        TEX.replace(r"\begin{equation}\label{eq:T}", more).replace("p = m v", "p = 2 m v"), encoding="utf-8"
    )
    made = begin_paper(folder, source)
    found = rows(folder)
    assert (found["1"]["label"], found["1"]["number"], found["1"]["read"]) == ("eq:T", "2", "confirmed"), "its id stays"
    assert (found["2"]["read"], found["2"]["changed"]) == ("unconfirmed", "p = m v") and made.changed == ("2",)
    assert [row["latex"] for i, row in found.items() if i not in "123"] == ["q = 1"]


def test_ids_stay_while_numbers_move(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = source.parent / "mine"
    text = TEX.replace(
        r"\begin{equation}\label{eq:T}", r"\begin{equation} q = 1 \end{equation} \begin{equation}\label{eq:T}"
    )
    source.write_text(text.replace(r"\label{eq:p}", r"\label{eq:momentum}"), encoding="utf-8")
    begin_paper(folder, source)
    assert main(["readings", str(folder)]) == 0
    out = capsys.readouterr().out
    assert "1, printed (2)  eq:T: unconfirmed" in out and "2, printed (3)  eq:momentum: unconfirmed" in out


def test_readings_are_shown_with_orders(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "paper.tex"
    rows = (r"g = 9.81 m/s^2", r"y = \frac{1}{2} x + 0{,}5 x^2 + O(x^3)")
    body = "".join(rf"\begin{{equation}} {row} \end{{equation}}" for row in rows)
    source.write_text(rf"\documentclass{{article}}\begin{{document}}{body}\end{{document}}", encoding="utf-8")
    begin_paper(tmp_path / "mine", source)
    assert main(["readings", str(tmp_path / "mine")]) == 0
    out = capsys.readouterr().out
    assert "g = 981/100·m/s²" in out and "O(x³)" in out and "1/2·x" in out


DOCUMENT = r"\documentclass{article}\begin{document}\section{One}"


def made_again(folder: Path, *bodies: str) -> dict[str, dict[str, Any]]:
    """The rows after a source of the first body, all confirmed, has become one of the second."""
    file = folder / "paper.tex"
    for body in bodies:
        file.write_text(rf"{DOCUMENT}{body}\end{{document}}", encoding="utf-8")
        begin_paper(folder / "mine", file)
        if body is bodies[0]:
            confirm(folder / "mine", rows(folder / "mine"))
    return rows(folder / "mine")


def displays(*prints: str) -> str:
    return "".join(rf"\begin{{equation}}{each}\end{{equation}}" for each in prints)


def test_an_equation_before_others_without_labels_leaves_them_confirmed(tmp_path: Path) -> None:
    found = made_again(tmp_path, displays("a = 1", "b = 2", "c = 3"), displays("z = 0", "a = 1", "b = 4", "c = 3"))
    assert [(i, row["latex"], row["read"]) for i, row in found.items()] == [
        ("1'", "z = 0", "unconfirmed"),
        ("1", "a = 1", "confirmed"),
        ("3'", "b = 4", "unconfirmed"),
        ("3", "c = 3", "confirmed"),
        ("2", "b = 2", "gone"),
    ]


def test_a_print_that_another_label_has_is_not_taken_from_it(tmp_path: Path) -> None:
    first = displays(r"\label{A} x = 1", r"\label{B} x = 1")
    found = made_again(tmp_path, first, displays("x = 1") + first)
    assert [(i, row.get("label"), row["read"]) for i, row in found.items()] == [
        ("1'", None, "unconfirmed"),
        ("1", "A", "confirmed"),
        ("2", "B", "confirmed"),
    ]


def test_titles_of_sections_are_those_of_the_source_and_other_tables_stay(tmp_path: Path) -> None:
    made_again(tmp_path, displays("x = 1") + r"\section{Two}" + displays("y = 2"))
    about = tmp_path / "mine" / "paper.toml"
    text = about.read_text(encoding="utf-8").replace('"One"', '"Mine"').replace("[sections]", "[sections] # as printed")
    about.write_text(text + '\n# [system]\n# L = "1"\n\n[system]\ncoordinates = ["q"]\n', encoding="utf-8")
    file = tmp_path / "paper.tex"
    file.write_text(
        file.read_text(encoding="utf-8").replace(r"\section{Two}", r"\section{New}\[ u = 3 \]\section{Two}")
    )
    begin_paper(tmp_path / "mine", file)
    given = tomllib.loads(about.read_text(encoding="utf-8"))
    assert list(given["sections"].items()) == [("1", "One"), ("2", "New"), ("3", "Two")]
    assert '"3" = "Two"\n\n# [system]\n# L = "1"\n\n[system]' in about.read_text(encoding="utf-8")
    assert given["system"] == {"coordinates": ["q"]} and "# as printed" in about.read_text(encoding="utf-8")


def test_a_letter_is_declared_though_a_meaning_has_it_as_a_word(tmp_path: Path) -> None:
    made_again(tmp_path, displays("x = 1"))
    symbols = tmp_path / "mine" / "symbols.py"
    symbols.write_text(symbols.read_text(encoding="utf-8").replace('"?"', '"mass of a ball"', 1), encoding="utf-8")
    made_again(tmp_path, displays("x = 1", "a = 2"))
    assert [line.split()[0] for line in symbols.read_text(encoding="utf-8").splitlines()[5:]] == ["x", "a"]


def test_what_was_added_to_a_line_stays_where_it_is_read_alike(source: Path) -> None:
    folder, file = source.parent / "mine", source.parent / "mine" / "equations.toml"
    text = file.read_text(encoding="utf-8").replace("[[equation.line]]", "[[equation.line]]\norder = 2")
    file.write_text(text, encoding="utf-8")
    source.write_text(TEX.replace("p = m v", "p = m v^2"), encoding="utf-8")
    begin_paper(folder, source)
    assert [row["line"][0].get("order") for row in rows(folder).values()] == [2, None, 2]


def test_what_is_no_longer_in_the_source_or_has_another_name_is_not_confirmed(source: Path) -> None:
    folder = source.parent / "mine"
    confirm(folder, ["1"])
    source.write_text(TEX.replace(r"\label{eq:T} T = \half m v^2", r"\label{eq:p} q = 1"), encoding="utf-8")
    begin_paper(folder, source)
    with pytest.raises(InputError, match="1 is no longer in the source"):
        confirm(folder, ["1"])


def test_comments_stay_above_their_equation(source: Path) -> None:
    folder = source.parent / "mine"
    file = folder / "equations.toml"
    first, mark, rest = file.read_text(encoding="utf-8").partition('[[equation]]\nid = "2"')
    text = f"{first}# looked up\n# twice\n{mark}\n# within{rest}"
    file.write_text(text.replace("[[equation.line]]", "# of the line\n[[equation.line]]", 1), encoding="utf-8")
    confirm(folder, ["1"])
    begin_paper(folder, source)
    again = file.read_text(encoding="utf-8")
    assert '# looked up\n# twice\n# within\n[[equation]]\nid = "2"' in again
    assert '# of the line\n[[equation]]\nid = "1"' in again
    assert rows(folder)["1"]["read"] == "confirmed"


def test_an_equation_that_is_gone_stays_where_a_derivation_states_it(source: Path) -> None:
    folder = source.parent / "mine"
    (folder / "derivations" / "s1.py").write_text('verdict("2", 1)\n', encoding="utf-8")
    kept = [line for line in TEX.splitlines() if "eq:p" not in line and "vec" not in line]
    source.write_text("\n".join(kept), encoding="utf-8")
    made = begin_paper(folder, source)
    assert rows(folder)["2"]["read"] == "gone" and "3" not in rows(folder) and set(made.gone) == {"2", "3"}


def test_a_confirmation_is_of_this_print_and_these_members(source: Path) -> None:
    folder = source.parent / "mine"
    confirm(folder, ["1"])
    file = folder / "equations.toml"
    file.write_text(file.read_text(encoding="utf-8").replace("1/2*m*v**2", "2*m*v**2"), encoding="utf-8")
    assert not Paper(folder).equation("1").is_confirmed
    with pytest.raises(InputError, match="no equation '9'"):
        confirm(folder, ["9"])


def test_numbers_beside_the_source_are_taken(source: Path) -> None:
    source.with_suffix(".aux").write_text(r"\newlabel{eq:T}{{7}{1}}" + "\n", encoding="utf-8")
    begin_paper(source.parent / "other", source)
    assert rows(source.parent / "other")["7"]["label"] == "eq:T"


def test_a_label_that_two_displays_have_gives_neither_its_number(tmp_path: Path) -> None:
    source = tmp_path / "paper.tex"
    body = r"\begin{equation}\label{a} x = 1 \end{equation}\begin{equation}\label{a} y = 2 \end{equation}"
    source.write_text(rf"\documentclass{{article}}\begin{{document}}{body}\end{{document}}", encoding="utf-8")
    source.with_suffix(".aux").write_text(r"\newlabel{a}{{3}{1}}\newlabel{a}{{4}{1}}", encoding="utf-8")
    begin_paper(tmp_path / "mine", source)
    assert {row["latex"]: row["number"] for row in rows(tmp_path / "mine").values()} == {"x = 1": "1", "y = 2": "2"}


def test_readings_are_shown_beside_the_print_and_confirmed(source: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(source.parent / "mine")
    assert main(["readings", folder]) == 0
    out = capsys.readouterr().out
    assert "1  eq:T: unconfirmed" in out and r"printed  T = \frac{1}{2} m v^2" in out
    assert main(["readings", folder, "--confirm", "1"]) == 0
    assert main(["readings", folder, "--json"]) == 0
    assert '"status": "confirmed"' in capsys.readouterr().out


def test_a_folder_that_is_no_paper_is_refused_before_anything_is_written(source: Path, tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "note.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is not a paper"):
        begin_paper(tmp_path / "full", source)
    with pytest.raises(InputError, match="is a paper already"):
        begin_paper(tmp_path / "mine")
    (tmp_path / "empty.tex").write_text("no formula", encoding="utf-8")
    with pytest.raises(InputError, match="no displayed equation"):
        begin_paper(tmp_path / "new", tmp_path / "empty.tex")
    assert not (tmp_path / "new").exists()


def test_what_is_interrupted_leaves_nothing(source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a folder was no paper, and none could be made there."""
    folder = tmp_path / "new"
    with monkeypatch.context() as patched:
        patched.setattr("lagrotor.paper.latex.init._write_symbols", Mock(side_effect=KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            begin_paper(folder, source)
    assert {each.name for each in tmp_path.iterdir()} == {"mine", "paper.tex"}
    folder.mkdir()
    assert begin_paper(folder, source).folder == folder and rows(folder) == rows(tmp_path / "mine")
    assert {each.name for each in tmp_path.iterdir()} == {"mine", "new", "paper.tex"}


def test_the_kinds_of_letters_are_proposed_and_declared_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, folder = tmp_path / "paper.tex", tmp_path / "mine"
    file.write_text(TEX.replace(r"p = m v", r"p = f(x) + g(y)"), encoding="utf-8")
    begin_paper(folder, file)
    assert main(["notation", str(folder), "--confirm", "f", "--real", "g"]) == 0
    shown = {tuple(line.split()[:3]) for line in capsys.readouterr().out.splitlines()}
    assert {("f", "functions", "declared"), ("g", "real", "declared")} <= shown
    assert any(row[1:] == ("vectors", "proposed") for row in shown)
    about = (folder / "paper.toml").read_text(encoding="utf-8")
    assert '[notation]\nfunctions = "f"\nreal = "g"\n' in about
    begin_paper(folder, file)
    assert rows(folder)["2"]["aside"] == ["p = f(x) + g*y"], "no line of the catalogue has an unknown function"
    with pytest.raises(InputError, match="g is in"):
        declare(folder, {"g": "functions"})
    assert main(["notation", str(folder), "--confirm", "q"]) == 2, "nothing is proposed for it"
