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
from lagrotor.paper.latex.start import begin_paper, confirm
from lagrotor.paper.latex.stated_system import stated_system, write_derivation
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
    (r"Q = m R^2\ddot\theta + m g R\sin\theta - m R^2\Omega^2\sin\theta\cos\theta", "holds"),
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


FOUCAULT = r"""\documentclass{article}\begin{document}
\begin{equation} \ddot x - 2 w \dot y + \omega_0^2 x = 0 \end{equation}
\begin{equation} \ddot y - 2 w \dot x + \omega_0^2 y = 0 \end{equation}
\begin{equation} J = m (x \dot y - y \dot x) + m w (x^2 + y^2) \end{equation}
\begin{equation} K = m (x \dot y - y \dot x) + \frac{m w}{2} (x^2 + y^2) \end{equation}
\end{document}"""
FOUCAULTS_SYSTEM = """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 + m*w*(x*y_dot - y*x_dot) - m*g*(x**2 + y**2)/(2*l)"
where = ["omega_0**2 = g/l"]
[system.derives]
1 = "motion x"
2 = "motion y"
3 = "integral"
4 = "integral"
"""


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


def test_what_the_text_says_of_a_letter_is_a_premise_and_any_integral_may_be_printed(tmp_path: Path) -> None:
    """The plane of a pendulum's swing turns: ω₀ is no letter of L, J is no energy and no momentum."""
    paper = stated_paper(tmp_path / "mine", FOUCAULT, FOUCAULTS_SYSTEM, "g l")
    write_derivation(paper)
    verdicts = {v.id: v for v in Paper(paper.folder).audit()}
    assert {i: v.verdict for i, v in verdicts.items()} == {
        "1": "holds-if",
        "2": "refuted",
        "3": "holds",
        "4": "refuted",
    }
    assert [premise.formula for premise in verdicts["1"].premises] == ["ω₀² = g/l"]


DAMPED = r"""\documentclass{article}\begin{document}
\begin{equation} \ddot x + 2\gamma\dot x + \omega_0^2 x = 0 \end{equation}
\begin{equation} \ddot x - 2\gamma\dot x + \omega_0^2 x = 0 \end{equation}
\begin{equation} E = \frac{m}{2} (\dot x^2 + \omega_0^2 x^2) \end{equation}
\end{document}"""


def test_friction_is_a_force_and_leaves_no_integral(tmp_path: Path) -> None:
    system = """
[system]
coordinates = "x"
L = "m*x_dot**2/2 - k*x**2/2"
forces = ["-c*x_dot"]
where = ["omega_0**2 = k/m", "gamma = c/(2*m)"]
[system.derives]
1 = "motion x"
2 = "motion x"
3 = "integral"
"""
    paper = stated_paper(tmp_path / "mine", DAMPED, system, "k c")
    write_derivation(paper)
    verdicts = {v.id: v.verdict for v in Paper(paper.folder).audit()}
    assert verdicts == {"1": "holds-if", "2": "refuted", "3": "refuted"}
    edit(paper.folder / "paper.toml", '3 = "integral"', '3 = "frequency^2"')
    _, refused = write_derivation(Catalogue(paper.folder))
    assert [*refused] == ["3"] and "with friction small motion has no one frequency" in refused["3"]
    edit(paper.folder / "paper.toml", '["-c*x_dot"]', '["-c*x_dot", "0"]')
    with pytest.raises(InputError, match="2 are given for 1 coordinates"):
        write_derivation(Catalogue(paper.folder))


def test_a_printed_lagrangian_is_proposed_as_the_system(tmp_path: Path) -> None:
    """In comments: without their marks they are a derivation, and what is misprinted is found."""
    begin_paper(tmp_path / "hoop", HOOP / "paper.tex")
    about = tmp_path / "hoop" / "paper.toml"
    text = about.read_text(encoding="utf-8")
    before, mark, proposal = text.partition("# [system]")
    assert mark and '"2" = "momentum theta"' in proposal and '"4" = "energy"' in proposal
    about.write_text(
        before + "\n".join(row.removeprefix("# ") for row in (mark + proposal).splitlines()), encoding="utf-8"
    )
    confirm(tmp_path / "hoop", ["1", "2", "3", "4", "7"])
    write_derivation(Catalogue(tmp_path / "hoop"))
    verdicts = {v.id: v.verdict for v in Paper(tmp_path / "hoop").audit()}
    assert verdicts == {"1": "holds", "2": "holds", "3": "holds", "4": "refuted", "7": "refuted"}


def test_without_a_lagrangian_no_system_is_proposed(tmp_path: Path) -> None:
    assert "[system]" not in (stated_paper(tmp_path / "mine", FOUCAULT, "").folder / "paper.toml").read_text()


def test_a_letter_of_which_nothing_is_said_is_refused(tmp_path: Path) -> None:
    """A true equation was refuted at some value of ω₀."""
    silent = FOUCAULTS_SYSTEM.replace('where = ["omega_0**2 = g/l"]', "")
    paper = stated_paper(tmp_path / "mine", FOUCAULT, silent, "g l")
    _, refused = write_derivation(paper)
    assert [*refused] == ["1", "2"] and "1 is printed with omega_0, of which the system says nothing" in refused["1"]
    assert [v.id for v in Paper(paper.folder).audit()] == ["3", "4"], "the others are judged"


def test_derive_says_what_it_leaves_out_and_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    silent = FOUCAULTS_SYSTEM.replace('where = ["omega_0**2 = g/l"]', "")
    paper = stated_paper(tmp_path / "mine", FOUCAULT, silent, "g l")
    assert main(["derive", str(paper.folder)]) == 1
    said = capsys.readouterr()
    assert "equation 1 is left out" in said.err and "equation 2 is left out" in said.err
    assert "s_system.py" in said.out
    text = (paper.folder / "paper.toml").read_text(encoding="utf-8")
    (paper.folder / "paper.toml").write_text(text.replace('3 = "integral"\n4 = "integral"\n', ""), encoding="utf-8")
    assert main(["derive", str(paper.folder)]) == 2, "none can be judged"


def test_what_is_said_may_be_too_little_or_the_print_itself(tmp_path: Path) -> None:
    """ẍ = a was refuted where a + b alone is known; ω = ν was undecided, as if the text's ν were assumed to be ω."""
    fall = '[system]\ncoordinates = "x"\nL = "m*x_dot**2/2 + m*g*x"\nwhere = ["a + b = g", "2*c = g"]\n'
    prints = {
        "both": (r"\ddot x = a + b", "acceleration x"),
        "one": (r"\ddot x = a", "acceleration x"),
        "twice one": (r"\ddot x - 2 c = 0", "motion x"),
        "misprinted": (r"\ddot x = c", "acceleration x"),
        "name": (r"\omega = \nu", "frequency"),
    }
    answers = {
        "both": "holds-if",
        "one": "refused",
        "twice one": "holds-if",
        "misprinted": "refuted",
        "name": "refused",
    }
    assert judged(tmp_path, "\n" + fall, prints, "m g a b c") == answers


def test_a_name_for_what_is_derived_holds_if_the_text_says_it(tmp_path: Path) -> None:
    system = """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2 - k*x**2)/2"
constraints = ["y - x"]
where = ["nu = sqrt(k/2)"]
"""
    prints = {
        "name": (r"\omega = \nu", "frequency"),
        "twice": (r"\omega = 2 \nu", "frequency"),
        "constraint": (r"y = x", "motion y"),
    }
    assert judged(tmp_path, system, prints, "m k nu") == {
        "name": "holds-if",
        "twice": "refuted",
        "constraint": "refused",
    }


ON_A_CIRCLE = r"""\documentclass{article}\begin{document}
\begin{equation} \ddot x = \frac{x (g y - \dot x^2 - \dot y^2)}{l^2} \end{equation}
\begin{equation} E = \frac{m}{2} (\dot x^2 + \dot y^2) + m g y \end{equation}
\begin{equation} J = m (x \dot y - y \dot x) \end{equation}
\begin{equation} x \ddot y - y \ddot x = - g x \end{equation}
\begin{equation} x \ddot y - y \ddot x = g x \end{equation}
\end{document}"""


def test_what_is_printed_by_the_constraint_holds_if_it_does(tmp_path: Path) -> None:
    """l² for x² + y²: it was refuted off the circle."""
    system = """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 - m*g*y"
constraints = ["x**2 + y**2 - l**2"]
[system.derives]
1 = "acceleration x"
2 = "integral"
3 = "integral"
4 = "motion x"
5 = "motion x"
"""
    paper = stated_paper(tmp_path / "mine", ON_A_CIRCLE, system)
    write_derivation(paper)
    derived = stated_system(paper)["1"]
    s = {symbol.name: symbol for symbol in derived.free_symbols}
    x, y, speed = s["x"], s["y"], s["x_dot"] ** 2 + s["y_dot"] ** 2
    assert (derived - x * (s["g"] * y - speed) / (x**2 + y**2)).simplify() == 0
    verdicts = {v.id: v.verdict for v in Paper(paper.folder).audit()}
    assert verdicts == {"1": "holds-if", "2": "holds-if", "3": "refuted", "4": "holds", "5": "refuted"}


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


def test_small_motion_is_through_first_order_about_an_equilibrium(tmp_path: Path) -> None:
    """A true θ̈ + (g/l) θ = 0 was refuted as an equation of motion; about a lean the deviation has its letter."""
    system = """
[system]
coordinates = "theta"
L = "m*l**2*(theta_dot**2 + Omega**2*sin(theta)**2)/2 + m*g*l*cos(theta)"
forces = ["-c*theta_dot"]
where = ["omega_0**2 = g/l", "delta = theta - acos(g/(l*Omega**2))"]
"""
    upright, leaning = "small motion theta", "small motion theta at theta = acos(g/(l*Omega**2))"
    lean = r"m l^2 \ddot\theta + c \dot\theta SIGN m l^2 (\Omega^2 - \frac{g^2}{l^2 \Omega^2}) \delta = 0"
    prints = {
        "hanging": (r"m l^2 \ddot\theta + c \dot\theta + m l^2 (\omega_0^2 - \Omega^2) \theta = 0", upright),
        "hanging, misprinted": (
            r"m l^2 \ddot\theta + c \dot\theta + m l^2 (\omega_0^2 + \Omega^2) \theta = 0",
            upright,
        ),
        "leaning": (lean.replace("SIGN", "+"), leaning),
        "leaning, misprinted": (lean.replace("SIGN", "-"), leaning),
        "acceleration": (
            r"\ddot\theta = (\Omega^2 - \frac{g}{l}) \theta - \frac{c \dot\theta}{m l^2}",
            "small acceleration theta",
        ),
        "as a whole": (r"m l^2 \ddot\theta + c \dot\theta + m l^2 (\omega_0^2 - \Omega^2) \theta = 0", "motion theta"),
        "at no equilibrium": (
            r"\ddot\theta = (\Omega^2 - \frac{g}{l}) \theta",
            "small acceleration theta at theta = 1",
        ),
        "not small": (r"\ddot\theta = (\Omega^2 - \frac{g}{l}) \theta", "acceleration theta at theta = 0"),
    }
    assert judged(tmp_path, system, prints, "g l m c Omega") == {
        "hanging": "holds-if",
        "hanging, misprinted": "refuted",
        "leaning": "holds-if",
        "leaning, misprinted": "refuted",
        "acceleration": "holds",
        "as a whole": "refuted",
        "at no equilibrium": "refused",
        "not small": "refused",
    }


def test_coupled_small_motion(tmp_path: Path) -> None:
    system = """
[system]
coordinates = "alpha beta"
L = "m*l**2*(alpha_dot**2 + beta_dot**2/2 + alpha_dot*beta_dot*cos(alpha - beta)) + m*g*l*(2*cos(alpha) + cos(beta))"
"""
    prints = {
        "of beta": (r"\ddot\beta = - \ddot\alpha - \frac{g}{l} \beta", "small motion beta"),
        "of alpha": (r"2 l \ddot\alpha = - 2 g \alpha - l \ddot\beta", "small motion alpha"),
        "misprinted": (r"2 l \ddot\alpha = - 2 g \alpha + l \ddot\beta", "small motion alpha"),
    }
    assert judged(tmp_path, system, prints, "m") == {"of beta": "holds", "of alpha": "holds", "misprinted": "refuted"}


def test_small_driven_motion(tmp_path: Path) -> None:
    system = """
[system]
coordinates = "theta"
L = "m*l**2*theta_dot**2/2 + m*l*(g + a*cos(Omega*t))*cos(theta)"
forces = ["F*l*cos(Omega*t)"]
"""
    driven = r"\ddot\theta + \frac{g + a\cos\Omega t}{l}\theta = \frac{F}{m l}\cos\Omega t"
    prints = {
        "driven": (driven, "small motion theta"),
        "misprinted": (driven.replace("m l", "m l^2"), "small motion theta"),
    }
    assert judged(tmp_path, system, prints, "l g m a Omega F t") == {"driven": "holds", "misprinted": "refuted"}


def test_small_motion_of_a_force_with_a_higher_power_and_of_one_without_series(tmp_path: Path) -> None:
    """A print with the letter of a term beyond first order was refused; |x| at zero said that the equations are singular."""
    system = """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 - k*(x**2 + y**2)/2"
forces = ["-c*x_dot*Abs(x_dot)", "OTHER"]
"""
    prints = {
        "linear": (r"m \ddot x + k x = 0", "small motion x"),
        "misprinted": (r"m \ddot x + c \dot x + k x = 0", "small motion x"),
    }
    quadratic = system.replace("OTHER", "-c*y*y_dot")
    assert judged(tmp_path, quadratic, prints, "m k c") == {"linear": "holds", "misprinted": "refuted"}
    kinked = stated_paper(
        tmp_path / "kinked",
        rf"\begin{{document}}\begin{{equation}}{prints['linear'][0]}\end{{equation}}\end{{document}}",
        system.replace("OTHER", "-k*Abs(y)") + '[system.derives]\n1 = "small motion x"\n',
        "m k c",
    )
    assert "no series at zero" in refusals(kinked.folder)[0]


def test_letters_that_the_coordinates_give_change_with_them(tmp_path: Path) -> None:
    """ℓ and r were constants in dF/dt: Laplace's integral was refuted, and so was the energy by a speed; here it is called τ."""
    system = """
[system]
coordinates = "x y"
L = "m*(x_dot**2 + y_dot**2)/2 + k/sqrt(x**2 + y**2)"
where = ["r = sqrt(x**2 + y**2)", "ell = m*(x*y_dot - y*x_dot)", "tau**2 = x_dot**2 + y_dot**2", "s**2 = x**2 + y**2"]
"""
    prints = {
        "Laplace": (r"A = \ell \dot y - \frac{k x}{r}", "integral"),
        "Laplace, misprinted": (r"A = \ell \dot y + \frac{k x}{r}", "integral"),
        "energy": (r"E = \frac{m \tau^2}{2} - \frac{k}{r}", "integral"),
        "energy, misprinted": (r"E = m \tau^2 - \frac{k}{r}", "integral"),
        "momentum": (r"C = \ell", "integral"),
        "by a square": (r"m \ddot x = - \frac{k x}{s^3}", "motion x"),
        "by a square, even": (r"m \ddot x = - \frac{k x}{r s^2}", "motion x"),
        "by a square, misprinted": (r"m \ddot x = \frac{k x}{r s^2}", "motion x"),
    }
    assert judged(tmp_path, system, prints) == {
        "Laplace": "holds-if",
        "Laplace, misprinted": "refuted",
        "energy": "holds-if",
        "energy, misprinted": "refuted",
        "momentum": "holds-if",
        "by a square": "refused",
        "by a square, even": "holds-if",
        "by a square, misprinted": "refuted",
    }


OSCILLATOR = """
[system]
coordinates = "x"
L = "m*x_dot**2/2 - k*x**2/2"
where = ["omega_0**2 = k/m", "a = x_ddot"]
"""


def test_a_left_side_is_read_with_its_derivatives_and_a_name_refutes_nothing(tmp_path: Path) -> None:
    """Each was compared with m ẍ + k x, and refuted."""
    prints = {
        "rate": (r"\frac{d}{dt}(m\dot x) = - k x", "motion x"),
        "rate, misprinted": (r"\frac{d}{dt}(m\dot x) = k x", "motion x"),
        "Lagrange": (
            r"\frac{d}{dt}\frac{\partial L}{\partial\dot x} = \frac{\partial L}{\partial x} = - k x",
            "motion x",
        ),
        "Lagrange, misprinted": (r"\frac{d}{dt}\frac{\partial L}{\partial\dot x} = - 2 k x", "motion x"),
        "chain": (r"\ddot x = - \omega_0^2 x = - \frac{k}{m} x", "motion x"),
        "chain, misprinted": (r"\ddot x = - \omega_0^2 x = \frac{k}{m} x", "motion x"),
        "letter": (r"m a = - k x", "motion x"),
        "letter, misprinted": (r"m a = k x", "motion x"),
        "name": (r"F = m \ddot x", "motion x"),
        "nothing said": (r"\dot p = - k x", "motion x"),
        "lost in the rate": (r"\frac{d}{dt}(m\dot x + \alpha) = - k x", "motion x"),
        "no line": (r"L \approx \frac{m}{2} \dot x^2", "L"),
    }
    expected = ["holds", "refuted"] * 2 + ["holds-if", "refuted"] * 2 + ["refused"] * 4
    assert judged(tmp_path, OSCILLATOR, prints, "p_dot") == dict(zip(prints, expected, strict=True))


def test_what_else_tells_a_frequency_is_no_wrong_frequency(tmp_path: Path) -> None:
    prints = {
        "frequency": (r"\omega = \sqrt{k/m}", "frequency"),
        "misprinted": (r"\omega = 2 \sqrt{k/m}", "frequency"),
        "negative": (r"\omega = - \sqrt{k/m}", "frequency"),
        "square": (r"\omega^2 = \frac{k}{m}", "frequency"),
        "period": (r"T = 2 \pi \sqrt{m/k}", "frequency"),
        "a period": (r"T = 2 \pi \sqrt{\frac{m}{k}}", "period"),
        "a period, misprinted": (r"T = 2 \pi \sqrt{\frac{k}{m}}", "period"),
        "turns": (r"\nu = \frac{1}{2 \pi} \sqrt{k/m}", "frequency"),
        "of a sign of letters": (r"\Omega = \frac{k}{\sqrt{k m}}", "frequency"),
    }
    expected = ["holds", "refuted", "refuted", "refused", "refused", "holds", "refuted", "refused"]
    answers = judged(tmp_path, OSCILLATOR, prints, "omega_0 a x x_dot x_ddot")
    assert [answers[name] for name in prints][:-1] == expected and answers["of a sign of letters"] != "refuted"


def test_another_frequency_of_the_system_is_named(tmp_path: Path) -> None:
    system = """
[system]
coordinates = "x_1 x_2"
L = "m*(x_1_dot**2 + x_2_dot**2)/2 - k*(x_1**2 + x_2**2)/2 - c*(x_1 - x_2)**2/2"
"""
    prints = {
        "first": (r"\omega_1^2 = \frac{k}{m}", "frequency^2 1"),
        "second": (r"\omega_2 = \sqrt{\frac{k + 2 c}{m}}", "frequency 2"),
        "misprinted": (r"\omega_2 = \sqrt{\frac{k + c}{m}}", "frequency 2"),
        "second as first": (r"\omega_1 = \sqrt{\frac{k + 2 c}{m}}", "frequency 1"),
        "its square": (r"\omega_1^2 = \frac{k + 2 c}{m}", "frequency^2 1"),
    }
    expected = ["holds", "holds", "refuted", "refused", "refused"]
    letters = "x_1 x_2 x_1_dot x_2_dot"
    assert judged(tmp_path, system, prints, letters) == dict(zip(prints, expected, strict=True))


def test_the_first_lagrangian_that_is_written_out_is_proposed(tmp_path: Path) -> None:
    """L(θ, θ̇), T − V = …, and φ by its second letter; the L of another motion is not said to be this one."""
    shown = [
        r"L(\varphi, \dot\varphi) = T - V = \frac{m l^2}{2} \dot\varphi^2 + m g l \cos\varphi",
        r"p_\varphi = m l^2 \dot\varphi",
        r"\ddot\varphi = - \frac{g}{l} \sin\varphi",
        r"L = \frac{m l^2}{2} \dot\varphi^2",
        r"\ddot\varphi = - \frac{g}{l} \varphi",
        r"\ddot\varphi + \frac{g}{l} \varphi = 0",
    ]
    equations = "".join(rf"\begin{{equation}} {each} \end{{equation}}" for each in shown)
    paper = stated_paper(tmp_path / "mine", rf"\begin{{document}}{equations}\end{{document}}", "")
    rows = [row for row in (paper.folder / "paper.toml").read_text(encoding="utf-8").splitlines() if row[:3] == '# "']
    small = ['# "5" = "small acceleration varphi"', '# "6" = "small motion varphi"']
    assert rows == ['# "1" = "L"', '# "2" = "momentum varphi"', '# "3" = "acceleration varphi"', *small]


def test_what_is_said_of_a_letter_of_the_lagrangian_alone_is_refused(tmp_path: Path) -> None:
    """r was constant in L, and changed in `where`."""
    system = '[system]\ncoordinates = "x"\nL = "x_dot**2/2 - k/r"\nwhere = ["r = x"]\n'
    with pytest.raises(InputError, match="r = x is about the motion and letters of L alone"):
        stated_system(stated_paper(tmp_path / "mine", DAMPED, system, "k r"))


def test_the_energy_of_a_dumbbell_is_kept_by_its_bar(tmp_path: Path) -> None:
    """With the masses and τ beside nine letters of the constraints it was not decided."""
    system = """
[system]
coordinates = "x_1 y_1 x_2 y_2"
L = "m*(x_1_dot**2 + y_1_dot**2 + x_2_dot**2 + y_2_dot**2)/2 - m*g*(y_1 + y_2)"
constraints = ["(x_1 - x_2)**2 + (y_1 - y_2)**2 - l**2"]
"""
    speeds = r"\dot x_1^2 + \dot y_1^2 + \dot x_2^2 + \dot y_2^2"
    prints = {
        "energy": (rf"E = \frac{{m}}{{2}} ({speeds}) + m g (y_1 + y_2)", "integral"),
        "misprinted": (rf"E = \frac{{m}}{{2}} ({speeds}) + m g (y_1 - y_2)", "integral"),
    }
    assert judged(tmp_path, system, prints, "l") == {"energy": "holds-if", "misprinted": "refuted"}


def test_a_left_side_that_is_no_expression_is_no_equation_of_motion(folder: Path) -> None:
    edit(folder / "equations.toml", "members = [", 'members = ["0", ')
    edit(folder / "paper.toml", '"1" = "L"', '"1" = "motion theta"')
    text = (folder / "equations.toml").read_text(encoding="utf-8")
    (folder / "equations.toml").write_text(text.replace('members = ["0", ', 'members = ["0"] # ', 1), encoding="utf-8")
    assert "no single expression in the coordinates" in " ".join(refusals(folder))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('coordinates = "theta"', 'coordinate = "theta"', "'coordinate' means nothing here"),
        ('"acceleration theta"', '"acceleration phi"', "the coordinates are theta"),
        ('"energy"', '"action"', "'action' is not known"),
        ("coordinates =", 'where = ["g"]\ncoordinates =', "must be one equation"),
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
