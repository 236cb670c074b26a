"""The bead on a turning hoop: a paper written as LaTeX, read from it, derived from text, judged, its report compiled."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.paper import Paper
from lagrotor.paper.catalogue import Catalogue
from lagrotor.paper.latex.init import begin_paper, confirm
from lagrotor.paper.latex.stated_system import write_derivation
from lagrotor.paper.scripts import beside

HOOP = beside("papers/hoop")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(HOOP, tmp_path / "hoop", ignore=shutil.ignore_patterns("__pycache__")))


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text, old
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_the_folder_is_what_its_source_says(tmp_path: Path) -> None:
    begin_paper(tmp_path / "again", HOOP / "paper.tex")
    fresh, kept = Catalogue(tmp_path / "again").equations, Catalogue(HOOP).equations
    assert {i: (e.number, e.label, e.latex, e.line) for i, e in fresh.items()} == {
        i: (e.number, e.label, e.latex, e.line) for i, e in kept.items()
    }
    assert all(entry.is_confirmed for entry in kept.values())


def test_the_two_misprints_are_found_and_no_other() -> None:
    paper = Paper(HOOP)
    audit = paper.audit()
    assert {v.id for v in audit if v.verdict == "refuted"} == {"4", "7"} and not audit.waiting
    assert paper.changes(audit, paper.equations) == []


MISPRINTS = {
    "1": ("theta_dot**2 + Omega**2*sin(theta)**2) + m", "theta_dot**2 - Omega**2*sin(theta)**2) + m"),
    "2": ('["m*R**2*theta_dot"]', '["m*R*theta_dot"]'),
    "3": ("Omega**2*cos(theta) - g/R", "Omega**2*cos(theta) + g/R"),
    "5": ("g/R - Omega**2)", "g/R + Omega**2)"),
    "6": ("Omega**2 - g**2", "Omega**2 + g**2"),
}


def test_every_other_misprint_would_be_found(folder: Path) -> None:
    for old, new in MISPRINTS.values():
        edit(folder / "equations.toml", old, new)
    text = (folder / "equations.toml").read_text(encoding="utf-8")
    by_hand = "\n".join(line for line in text.splitlines() if not line.startswith(("read =", "print =")))
    (folder / "equations.toml").write_text(by_hand, encoding="utf-8")
    assert {v.id for v in Paper(folder).audit() if v.verdict == "refuted"} == {*MISPRINTS, "4", "7"}


def test_a_changed_reading_is_no_longer_confirmed_and_gives_no_verdict(folder: Path) -> None:
    edit(folder / "equations.toml", *MISPRINTS["3"])
    verdict = Paper(folder).audit("3")
    assert verdict.verdict == "undecided" and "it would be refuted" in verdict.evidence[0]


def test_the_derivation_is_written_from_the_text(folder: Path) -> None:
    script = (folder / "derivations" / "s_system.py").read_text(encoding="utf-8")
    assert main(["derive", str(folder)]) == 0
    assert (folder / "derivations" / "s_system.py").read_text(encoding="utf-8") == script


def stated_paper(folder: Path, source: str, system: str, letters: str = "") -> Catalogue:
    """A paper from a source, its equations confirmed, with a system stated as text; letters: more names for symbols.py."""
    (folder.parent / "paper.tex").write_text(source, encoding="utf-8")
    begin_paper(folder, folder.parent / "paper.tex")
    about, names = folder / "paper.toml", folder / "symbols.py"
    about.write_text(about.read_text(encoding="utf-8") + system, encoding="utf-8")
    more = (f'{x} = GLOSSARY.letter("{x}", "?", "?", real=True)\n' for x in letters.split())
    names.write_text(names.read_text(encoding="utf-8") + "".join(more), encoding="utf-8")
    confirm(folder, [i for i, entry in Catalogue(folder).equations.items() if entry.line])
    return Catalogue(folder)


def refusals(folder: Path) -> list[str]:
    """Why equations of a stated system are left out, or all of it is."""
    try:
        return [*write_derivation(Catalogue(folder))[1].values()]
    except InputError as error:
        return [str(error)]


def judged(tmp_path: Path, system: str, prints: dict[str, tuple[str, str]], letters: str = "") -> dict[str, str]:
    """name → verdict, or "refused", of prints: name → (LaTeX, what the print is of the system)."""
    shown = "".join(rf"\begin{{equation}} {latex} \end{{equation}}" for latex, _ in prints.values())
    paper = stated_paper(tmp_path / "mine", rf"\begin{{document}}{shown}\end{{document}}", system, letters)
    about, derives, answers = paper.folder / "paper.toml", "", dict.fromkeys(prints, "refused")
    text = about.read_text(encoding="utf-8") + "[system.derives]\n"
    for number, (_, said) in enumerate(prints.values(), 1):
        about.write_text(f'{text}{number} = "{said}"\n', encoding="utf-8")
        if not refusals(paper.folder):
            derives += f'{number} = "{said}"\n'
    about.write_text(text + derives, encoding="utf-8")
    write_derivation(Catalogue(paper.folder))
    names = [*prints]
    return answers | {names[int(v.id) - 1]: v.verdict for v in Paper(paper.folder).audit() if v.id in derives}


OSCILLATOR = """
[system]
coordinates = "x"
L = "m*x_dot**2/2 - k*x**2/2"
where = ["omega_0 = sqrt(k/m)", "a_0 = 2*k"]
"""
LAGRANGE = r"\frac{d}{dt}\frac{\partial L}{\partial\dot x} = "
SPEEDS = r"\dot x_1^2 + \dot y_1^2 + \dot x_2^2 + \dot y_2^2"
# name → (system, letters of it, the name of a print → (LaTeX, its role, the answer)).
SYSTEMS = {
    "a pendulum whose plane of swing turns": (
        """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 + m*w*(x*y_dot - y*x_dot) - m*g*(x**2 + y**2)/(2*l)"
where = ["omega_0 = sqrt(g/l)"]
""",
        "g l",
        {
            "x": (r"\ddot x - 2 w \dot y + \omega_0^2 x = 0", "motion x", "holds-if"),
            "a multiple": (r"m l\ddot x = 2 m l w \dot y - m g x", "motion x", "holds"),
            "y, misprinted": (r"\ddot y - 2 w \dot x + \omega_0^2 y = 0", "motion y", "refuted"),
            "integral": (r"J = m (x \dot y - y \dot x) + m w (x^2 + y^2)", "integral", "holds"),
            "no integral": (r"K = m (x \dot y - y \dot x) + \frac{m w}{2} (x^2 + y^2)", "integral", "refuted"),
        },
    ),
    "friction, and a letter of which nothing is said": (
        """
[system]
coordinates = "x"
L = "m*x_dot**2/2 - k*x**2/2"
forces = ["-c*x_dot"]
where = ["omega_0 = sqrt(k/m)", "gamma = c/(2*m)"]
""",
        "k c a",
        {
            "motion": (r"\ddot x + 2\gamma\dot x + \omega_0^2 x = 0", "motion x", "holds-if"),
            "misprinted": (r"\ddot x - 2\gamma\dot x + \omega_0^2 x = 0", "motion x", "refuted"),
            "no integral": (r"E = \frac{m}{2} (\dot x^2 + \omega_0^2 x^2)", "integral", "refuted"),
            "no frequency": (r"\omega = \omega_0", "frequency", "refused"),
            "nothing said": (r"\ddot x = a", "acceleration x", "refused"),
        },
    ),
    "the bar of a dumbbell": (
        """
[system]
coordinates = "x_1 y_1 x_2 y_2"
L = "m*(x_1_dot**2 + y_1_dot**2 + x_2_dot**2 + y_2_dot**2)/2 - m*g*(y_1 + y_2)"
constraints = ["(x_1 - x_2)**2 + (y_1 - y_2)**2 - l**2"]
""",
        "l",
        {
            "energy": (rf"E = \frac{{m}}{{2}} ({SPEEDS}) + m g (y_1 + y_2)", "integral", "holds-if"),
            "misprinted": (rf"E = \frac{{m}}{{2}} ({SPEEDS}) + m g (y_1 - y_2)", "integral", "refuted"),
        },
    ),
    "left sides with derivatives": (
        OSCILLATOR,
        "p_dot",
        {
            "rate": (r"\frac{d}{dt}(m\dot x) = - k x", "motion x", "holds"),
            "Lagrange": (LAGRANGE + r"\frac{\partial L}{\partial x} = - k x", "motion x", "holds"),
            "Lagrange, misprinted": (LAGRANGE + "- 2 k x", "motion x", "refuted"),
            "chain": (r"\ddot x = - \omega_0^2 x = - \frac{k}{m} x", "motion x", "holds-if"),
            "chain, misprinted": (r"\ddot x = - \omega_0^2 x = \frac{k}{m} x", "motion x", "refuted"),
            "letter": (r"2 m\ddot x = - a_0 x", "motion x", "holds-if"),
            "a name for it": (r"F = m \ddot x", "motion x", "refused"),
            "nothing said": (r"\dot p = - k x", "motion x", "refused"),
            "no line": (r"L \approx \frac{m}{2} \dot x^2", "L", "refused"),
        },
    ),
    "two frequencies": (
        """
[system]
coordinates = "x_1 x_2"
L = "m*(x_1_dot**2 + x_2_dot**2)/2 - k*(x_1**2 + x_2**2)/2 - c*(x_1 - x_2)**2/2"
""",
        "x_1 x_2 x_1_dot x_2_dot",
        {
            "first": (r"\omega_1^2 = \frac{k}{m}", "frequency^2 1", "holds"),
            "second": (r"\omega_2 = \sqrt{\frac{k + 2 c}{m}}", "frequency 2", "holds"),
            "misprinted": (r"\omega_2 = \sqrt{\frac{k + c}{m}}", "frequency 2", "refuted"),
            "negative": (r"\omega_2 = -\sqrt{\frac{k + 2 c}{m}}", "frequency 2", "refuted"),
            "period": (r"T = 2 \pi \sqrt{\frac{m}{k}}", "period 1", "holds"),
            "period, misprinted": (r"T = 2 \pi \sqrt{\frac{k}{m}}", "period 1", "refuted"),
            "third": (r"\omega_3 = \sqrt{k/m}", "frequency 3", "refused"),
        },
    ),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_print_is_judged_by_the_system_that_the_text_states(name: str, tmp_path: Path) -> None:
    system, letters, prints = SYSTEMS[name]
    answers = judged(tmp_path, system, {print_: row[:2] for print_, row in prints.items()}, letters)
    assert answers == {print_: row[2] for print_, row in prints.items()}


def test_a_definition_is_named_as_a_premise_and_what_is_left_out_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    system, letters, prints = SYSTEMS["a pendulum whose plane of swing turns"]
    derives = '[system.derives]\n1 = "motion x"\n2 = "integral"\n'
    source = r"\begin{document}\begin{equation}" + prints["x"][0] + r"\end{equation}\begin{equation}"
    source += prints["integral"][0] + r"\end{equation}\end{document}"
    paper = stated_paper(tmp_path / "mine", source, system + derives, letters)
    assert main(["derive", str(paper.folder)]) == 0
    assert [premise.formula for premise in Paper(paper.folder).audit("1").premises] == ["ω₀ = √(g/l)"]
    edit(paper.folder / "paper.toml", 'where = ["omega_0 = sqrt(g/l)"]', "")
    capsys.readouterr()
    assert main(["derive", str(paper.folder)]) == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "equation 1 has no single left side" in said and "define its symbols in where" in said
    assert [v.id for v in Paper(paper.folder).audit()] == ["2"], "the other is judged"
    edit(paper.folder / "paper.toml", '2 = "integral"\n', "")
    assert main(["derive", str(paper.folder)]) == 2, "none can be judged"


def test_a_left_side_that_is_no_expression_is_no_equation_of_motion(folder: Path) -> None:
    edit(folder / "equations.toml", "members = [", 'members = ["0", ')
    edit(folder / "paper.toml", '"1" = "L"', '"1" = "motion theta"')
    text = (folder / "equations.toml").read_text(encoding="utf-8")
    (folder / "equations.toml").write_text(text.replace('members = ["0", ', 'members = ["0"] # ', 1), encoding="utf-8")
    assert "no single left side in the symbols" in " ".join(refusals(folder))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('coordinates = "theta"', 'coordinate = "theta"', "'coordinate' is not a key"),
        ('"acceleration theta"', '"acceleration phi"', "names no coordinate: write one of the coordinates theta"),
        ('"energy"', '"action"', "'action' is unknown"),
        ("coordinates =", 'where = ["g"]\ncoordinates =', "defines no symbol"),
        ("coordinates =", 'where = ["g = R"]\ncoordinates =', "g is a symbol of the system"),
        ("coordinates =", 'where = ["theta_0 = theta"]\ncoordinates =', "theta_0 is defined by coordinates"),
        ('"acceleration theta"', '"small motion theta"', "is unknown"),
        ("coordinates =", 'forces = ["0", "0"]\ncoordinates =', "2 for 1 coordinates"),
        ("theta_dot**2 +", "__import__('os') +", "no part of an expression|is not defined"),
        ('"7" = "acceleration theta"', '"9" = "energy"', "'9' is not in the catalogue"),
    ],
)
def test_a_system_that_cannot_be_read_is_refused(old: str, new: str, says: str, folder: Path) -> None:
    edit(folder / "paper.toml", old, new)
    assert re.search(says, " ".join(refusals(folder)))


def test_its_report_and_errata_are_compiled_without_an_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    compiler = shutil.which("pdflatex")
    if compiler is None:
        pytest.skip("no pdflatex on this machine: install a LaTeX distribution to check that the report compiles")
    assert main(["reproduce", "--paper", str(HOOP), "--out", str(tmp_path / "report"), "--jobs", "1"]) == 0
    page = (tmp_path / "report" / "whole.html").read_text(encoding="utf-8")
    page = page.partition("const WORDS")[0]
    assert page.count("Its reading, confirmed") == 7 and "Its reading, not confirmed" not in page
    for name in ("report", "errata"):
        done = subprocess.run(
            [compiler, "-interaction=nonstopmode", f"{name}.tex"],
            cwd=tmp_path / "report",
            capture_output=True,
            check=False,
        )
        if b"not found" in done.stdout:
            pytest.skip("a package that the report loads is not installed")
        assert done.returncode == 0 and b"\n!" not in done.stdout, name
