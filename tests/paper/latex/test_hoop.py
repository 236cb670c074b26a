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


# Prints of the motion of θ, which is m (R²θ̈ − …) = 0, and what the derivation makes of each.
MOTIONS = [
    (r"\ddot\theta + \frac{g}{R}\sin\theta - \Omega^2\sin\theta\cos\theta = 0", "holds"),
    (r"m R^2 \ddot\theta = m R^2\Omega^2\sin\theta\cos\theta - m g R\sin\theta", "holds"),
    (r"\ddot\theta - \frac{g}{R}\sin\theta - \Omega^2\sin\theta\cos\theta = 0", "refuted"),
    (r"\dot\theta - \Omega^2\sin\theta\cos\theta = 0", "refuted"),
]


@pytest.mark.parametrize(("latex", "answer"), MOTIONS)
def test_an_equation_of_motion_may_be_printed_as_any_multiple(latex: str, answer: str, tmp_path: Path) -> None:
    source, folder = tmp_path / "paper.tex", tmp_path / "mine"
    source.write_text(
        rf"\documentclass{{article}}\begin{{document}}\begin{{equation}} {latex} \end{{equation}}\end{{document}}"
    )
    begin_paper(folder, source)
    text = (HOOP / "paper.toml").read_text(encoding="utf-8")
    system = text[text.index("[system]") : text.index("[system.derives]")] + '[system.derives]\n"1" = "motion theta"\n'
    (folder / "paper.toml").write_text(
        (folder / "paper.toml").read_text(encoding="utf-8") + "\n" + system, encoding="utf-8"
    )
    names = (HOOP / "symbols.py").read_text(encoding="utf-8")
    (folder / "symbols.py").write_text(
        names + 'Q = GLOSSARY.letter("Q", "a force", "?", real=True)\n', encoding="utf-8"
    )
    confirm(folder, ["1"])
    write_derivation(Catalogue(folder))
    assert Paper(folder).audit("1").verdict == answer


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


# name → (system, letters beside those of the prints, the name of a print → (LaTeX, its role, the answer)).
PENDULUM = """
[system]
coordinates = "theta"
L = "m*l**2*(theta_dot**2 + Omega**2*sin(theta)**2)/2 + m*g*l*cos(theta)"
forces = ["-c*theta_dot"]
where = ["omega_0 = sqrt(g/l)", "delta = theta - acos(g/(l*Omega**2))"]
"""
OSCILLATOR = """
[system]
coordinates = "x"
L = "m*x_dot**2/2 - k*x**2/2"
where = ["omega_0 = sqrt(k/m)", "a = x_ddot"]
"""
HANGING = r"m l^2 \ddot\theta + c \dot\theta + m l^2 (\omega_0^2 SIGN \Omega^2) \theta = 0"
LEANING = r"m l^2 \ddot\theta + c \dot\theta SIGN m l^2 (\Omega^2 - \frac{g^2}{l^2 \Omega^2}) \delta = 0"
DRIVEN = r"\ddot\theta + \frac{g + a\cos\Omega t}{l}\theta = \frac{F}{m l}\cos\Omega t"
UPRIGHT, LEAN = "small motion theta", "small motion theta at theta = acos(g/(l*Omega**2))"
SPEEDS = r"\dot x_1^2 + \dot y_1^2 + \dot x_2^2 + \dot y_2^2"
ON_A_CIRCLE = r"\ddot x = \frac{x (g y - \dot x^2 - \dot y^2)}{l^2}"

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
            "y, misprinted": (r"\ddot y - 2 w \dot x + \omega_0^2 y = 0", "motion y", "refuted"),
            "integral": (r"J = m (x \dot y - y \dot x) + m w (x^2 + y^2)", "integral", "holds"),
            "no integral": (r"K = m (x \dot y - y \dot x) + \frac{m w}{2} (x^2 + y^2)", "integral", "refuted"),
        },
    ),
    "friction": (
        """
[system]
coordinates = "x"
L = "m*x_dot**2/2 - k*x**2/2"
forces = ["-c*x_dot"]
where = ["omega_0 = sqrt(k/m)", "gamma = c/(2*m)"]
""",
        "k c",
        {
            "motion": (r"\ddot x + 2\gamma\dot x + \omega_0^2 x = 0", "motion x", "holds-if"),
            "misprinted": (r"\ddot x - 2\gamma\dot x + \omega_0^2 x = 0", "motion x", "refuted"),
            "no integral": (r"E = \frac{m}{2} (\dot x^2 + \omega_0^2 x^2)", "integral", "refuted"),
            "no frequency": (r"\omega = \omega_0", "frequency", "refused"),
        },
    ),
    "a letter of which nothing is said": (
        '\n[system]\ncoordinates = "x"\nL = "m*x_dot**2/2 + m*g*x"\nwhere = ["c = g/2"]\n',
        "m g a b c",
        {
            "one": (r"\ddot x = a", "acceleration x", "refused"),
            "twice one": (r"\ddot x - 2 c = 0", "motion x", "holds-if"),
            "misprinted": (r"\ddot x = c", "acceleration x", "refuted"),
            "name": (r"\omega = \nu", "frequency", "refused"),
        },
    ),
    "a constraint": (
        """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 - m*g*y"
constraints = ["x**2 + y**2 - l**2"]
""",
        "",
        {
            "acceleration": (ON_A_CIRCLE, "acceleration x", "holds-if"),
            "energy": (r"E = \frac{m}{2} (\dot x^2 + \dot y^2) + m g y", "integral", "holds-if"),
            "no integral": (r"J = m (x \dot y - y \dot x)", "integral", "refuted"),
            "torque": (r"x \ddot y - y \ddot x = - g x", "motion x", "holds"),
            "torque, misprinted": (r"x \ddot y - y \ddot x = g x", "motion x", "refuted"),
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
    "small motion about an equilibrium": (
        PENDULUM,
        "g l m c Omega",
        {
            "hanging": (HANGING.replace("SIGN", "-"), UPRIGHT, "holds-if"),
            "hanging, misprinted": (HANGING.replace("SIGN", "+"), UPRIGHT, "refuted"),
            "leaning": (LEANING.replace("SIGN", "+"), LEAN, "holds-if"),
            "leaning, misprinted": (LEANING.replace("SIGN", "-"), LEAN, "refuted"),
            "acceleration": (
                r"\ddot\theta = (\Omega^2 - \frac{g}{l}) \theta - \frac{c \dot\theta}{m l^2}",
                "small acceleration theta",
                "holds",
            ),
            "as a whole": (HANGING.replace("SIGN", "-"), "motion theta", "refuted"),
            "at no equilibrium": (
                r"\ddot\theta = (\Omega^2 - \frac{g}{l}) \theta",
                "small acceleration theta at theta = 1",
                "refused",
            ),
        },
    ),
    "coupled small motion": (
        """
[system]
coordinates = "alpha beta"
L = "m*l**2*(alpha_dot**2 + beta_dot**2/2 + alpha_dot*beta_dot*cos(alpha - beta)) + m*g*l*(2*cos(alpha) + cos(beta))"
""",
        "m",
        {
            "of beta": (r"\ddot\beta = - \ddot\alpha - \frac{g}{l} \beta", "small motion beta", "holds"),
            "of alpha": (r"2 l \ddot\alpha = - 2 g \alpha - l \ddot\beta", "small motion alpha", "holds"),
            "misprinted": (r"2 l \ddot\alpha = - 2 g \alpha + l \ddot\beta", "small motion alpha", "refuted"),
        },
    ),
    "small driven motion": (
        """
[system]
coordinates = "theta"
L = "m*l**2*theta_dot**2/2 + m*l*(g + a*cos(Omega*t))*cos(theta)"
forces = ["F*l*cos(Omega*t)"]
""",
        "l g m a Omega F t",
        {
            "driven": (DRIVEN, UPRIGHT, "holds"),
            "misprinted": (DRIVEN.replace("m l", "m l^2"), UPRIGHT, "refuted"),
        },
    ),
    "a force without a series": (
        """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 - k*(x**2 + y**2)/2"
forces = ["-c*x_dot", "-k*Abs(y)"]
""",
        "m k c",
        {"kinked": (r"m \ddot x + k x = 0", "small motion x", "refused")},
    ),
    "letters that are defined by coordinates": (
        """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 + k/sqrt(x**2 + y**2)"
where = ["r = sqrt(x**2 + y**2)", "ell = m*(x*y_dot - y*x_dot)"]
""",
        "",
        {
            "Laplace": (r"A = \ell \dot y - \frac{k x}{r}", "integral", "holds-if"),
            "Laplace, misprinted": (r"A = \ell \dot y + \frac{k x}{r}", "integral", "refuted"),
            "momentum": (r"C = \ell", "integral", "holds-if"),
            "motion": (r"m \ddot x = - \frac{k x}{r^3}", "motion x", "holds-if"),
            "motion, misprinted": (r"m \ddot x = \frac{k x}{r^3}", "motion x", "refuted"),
        },
    ),
    "left sides with derivatives": (
        OSCILLATOR,
        "p_dot",
        {
            "rate": (r"\frac{d}{dt}(m\dot x) = - k x", "motion x", "holds"),
            "rate, misprinted": (r"\frac{d}{dt}(m\dot x) = k x", "motion x", "refuted"),
            "Lagrange": (
                r"\frac{d}{dt}\frac{\partial L}{\partial\dot x} = \frac{\partial L}{\partial x} = - k x",
                "motion x",
                "holds",
            ),
            "Lagrange, misprinted": (
                r"\frac{d}{dt}\frac{\partial L}{\partial\dot x} = - 2 k x",
                "motion x",
                "refuted",
            ),
            "chain": (r"\ddot x = - \omega_0^2 x = - \frac{k}{m} x", "motion x", "holds-if"),
            "chain, misprinted": (r"\ddot x = - \omega_0^2 x = \frac{k}{m} x", "motion x", "refuted"),
            "letter": (r"m a = - k x", "motion x", "holds-if"),
            "letter, misprinted": (r"m a = k x", "motion x", "refuted"),
            "a name for it": (r"F = m \ddot x", "motion x", "refused"),
            "nothing said": (r"\dot p = - k x", "motion x", "refused"),
            "no line": (r"L \approx \frac{m}{2} \dot x^2", "L", "refused"),
        },
    ),
    "frequencies": (
        OSCILLATOR,
        "omega_0 a x x_dot x_ddot",
        {
            "frequency": (r"\omega = \sqrt{k/m}", "frequency", "holds"),
            "misprinted": (r"\omega = 2 \sqrt{k/m}", "frequency", "refuted"),
            "negative": (r"\omega = - \sqrt{k/m}", "frequency", "refuted"),
            "square": (r"\omega^2 = \frac{k}{m}", "frequency", "refused"),
            "period as frequency": (r"T = 2 \pi \sqrt{m/k}", "frequency", "refused"),
            "period": (r"T = 2 \pi \sqrt{\frac{m}{k}}", "period", "holds"),
            "period, misprinted": (r"T = 2 \pi \sqrt{\frac{k}{m}}", "period", "refuted"),
            "turns": (r"\nu = \frac{1}{2 \pi} \sqrt{k/m}", "frequency", "refused"),
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
            "second as first": (r"\omega_1 = \sqrt{\frac{k + 2 c}{m}}", "frequency 1", "refused"),
            "its square": (r"\omega_1^2 = \frac{k + 2 c}{m}", "frequency^2 1", "refused"),
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
    assert "equation 1 has no single left side" in said and "define its letters in where" in said
    assert [v.id for v in Paper(paper.folder).audit()] == ["2"], "the other is judged"
    edit(paper.folder / "paper.toml", '2 = "integral"\n', "")
    assert main(["derive", str(paper.folder)]) == 2, "none can be judged"


def test_a_left_side_that_is_no_expression_is_no_equation_of_motion(folder: Path) -> None:
    edit(folder / "equations.toml", "members = [", 'members = ["0", ')
    edit(folder / "paper.toml", '"1" = "L"', '"1" = "motion theta"')
    text = (folder / "equations.toml").read_text(encoding="utf-8")
    (folder / "equations.toml").write_text(text.replace('members = ["0", ', 'members = ["0"] # ', 1), encoding="utf-8")
    assert "no single left side in the coordinates" in " ".join(refusals(folder))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('coordinates = "theta"', 'coordinate = "theta"', "'coordinate' means nothing here"),
        ('"acceleration theta"', '"acceleration phi"', "the coordinates are theta"),
        ('"energy"', '"action"', "'action' is not known"),
        ("coordinates =", 'where = ["g"]\ncoordinates =', "defines no letter"),
        ("coordinates =", 'where = ["g = R"]\ncoordinates =', "g is a letter of the system"),
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
