"""A paper is a folder: what it says, what is refused at the door, and two papers that are not about rotors."""

import shutil
from pathlib import Path

import pytest

from lagrotor.errors import InputError, LagrotorError, ScriptError
from lagrotor.paper import Paper
from lagrotor.paper.audit import in_words
from lagrotor.paper.scripts import beside

PAPERS = beside("papers")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the worked example."""
    return Path(shutil.copytree(PAPERS / "pendulum", tmp_path / "mine"))


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert text.count(old) >= 1, old
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_the_worked_example_is_as_recorded() -> None:
    paper = Paper(PAPERS / "pendulum")
    audit = paper.audit()
    assert audit["1.1"].verdict == "holds-to-order" and repr(audit) == "<Audit of 1 equations: 1 holds-to-order>"
    assert paper.changes([*audit, *paper.evaluate()]) == []
    (test,) = paper.claim_tests.values()
    with paper.importable():
        assert {part: test.evaluated(case).finding.outcome for part, case in test.foreign.items()} == {
            "the period is that of small swings": "refuted"
        }


def test_what_is_not_derived_is_not_yet_judged_and_counted_so(folder: Path) -> None:
    more = '\n[[equation]]\nid = "1.2"\nsection = "1"\ntitle = "energy"\nlatex = "E = T + V"\n'
    with (folder / "equations.toml").open("a", encoding="utf-8") as file:
        file.write(more)
    audit = Paper(folder).audit()
    assert (audit.waiting, audit.counts) == (("1.2",), {"holds-to-order": 1, "not-yet-judged": 1})
    assert "1.2" in audit._repr_html_() and "not-yet-judged" in repr(audit)
    with pytest.raises(InputError, match=r"1\.2 is not yet judged"):
        audit["1.2"]
    with pytest.raises(InputError, match=r"1\.2 is not yet judged"):
        Paper(folder).audit("1.2")
    with pytest.raises(InputError, match=r"'1\.3' is not in the paper"):
        audit["1.3"]


def test_a_printed_letter_that_nothing_derived_has_is_named(folder: Path) -> None:
    """ω₀² for g/l is refuted at some value of ω₀: the terminal says which letter, and where its meaning is written."""
    with (folder / "symbols.py").open("a", encoding="utf-8") as file:
        file.write('omega_0 = GLOSSARY.letter("omega_0", "rate of small swings", "1/s", positive=True)\n')
    edit(folder / "equations.toml", "-g/l*theta", "-omega_0**2*theta")
    paper = Paper(folder)
    verdict = paper.audit("1.1")
    assert verdict.verdict == "refuted" and "ω₀ is printed, but not derived" in in_words(verdict, paper)
    edit(folder / "equations.toml", 'section = "1"\n', 'section = "1"\nletters = { omega_0 = "sqrt(g/l)" }\n')
    paper = Paper(folder)
    verdict = paper.audit("1.1")
    assert verdict.verdict == "holds-to-order" and "not derived" not in in_words(verdict, paper)


def test_claims_figures_and_letters_may_be_left_out(folder: Path) -> None:
    for name in ("claims.toml", "figures.toml", "recorded.toml", "symbols.py", "derivations/c1_period.py"):
        (folder / name).unlink()
    shutil.rmtree(folder / "figures")
    edit(folder / "paper.toml", "[[headline]]", "[unused]\n[[headline]]")
    about = (folder / "paper.toml").read_text(encoding="utf-8")
    (folder / "paper.toml").write_text(about[: about.index("[unused]")], encoding="utf-8")
    edit(folder / "equations.toml", 'title = "equation of motion"', 'title = "a"\nletters = { g = "9.81" }')
    script = "from lagrotor.paper.equation_statements import verdict\nimport sympy as sp\n"
    (folder / "derivations" / "s1_motion.py").write_text(script, encoding="utf-8")
    paper = Paper(folder)
    assert (paper.claims, paper.figures, paper.evaluate(), paper.recorded) == ({}, {}, [], {})
    assert paper.audit().waiting == ("1.1",)


def harmed(folder: Path, file: str, old: str, new: str) -> None:
    """A file with some text replaced; without `old` the file is taken away."""
    if old:
        edit(folder / file, old, new)
    else:
        (folder / file).unlink()


TWICE = '[[equation]]\nid = "1.1"\nsection = "1"\ntitle = ""\nlatex = ""\n[[equation]]'
# What is changed in which file, and what is said then.
DOORS = {
    "no paper.toml": ("paper.toml", "", "", r"is not a paper: it has no paper\.toml"),
    "no equations": ("equations.toml", "", "", r"equations\.toml: .*every paper needs this file"),
    "no TOML": ("paper.toml", "results =", "results", r"paper\.toml: .*line \d"),
    "no title": ("paper.toml", 'title = "The simple pendulum"', "", r"paper\.toml: .*'title' is missing"),
    "brace": ("paper.toml", "{1.1}", "{1.1", r"headline: text: .*write a number as"),
    "unknown key": ("equations.toml", "title =", "titel =", r"equation 1\.1: 'titel' is not a key"),
    "unknown section": ("equations.toml", 'section = "1"', 'section = "7"', r"1\.1: section '7' is not"),
    "unknown table": (
        "equations.toml",
        "[[equation]]",
        "[[equations]]",
        r"'equations' is not a key: write \[\[equation",
    ),
    "key of a line": (
        "equations.toml",
        "small =",
        "smal =",
        r"1\.1: 'smal' is not a key of a line: the keys are quantity, members",
    ),
    "no quantity": ("equations.toml", "quantity =", "names =", r"1\.1: a line has no quantity"),
    "letters of no section": (
        "equations.toml",
        "[[equation]]",
        "[letters.7]\n[[equation]]",
        r"letters: section '7' is not",
    ),
    "id twice": ("equations.toml", "[[equation]]", TWICE, r"equation 1\.1: the id is given twice"),
    "claim": ("claims.toml", '["1.1"]', '["9.9"]', r"claims\.toml: C01: there is no equation 9\.9"),
    "figure": ("figures.toml", '["1.1"]', '["9.9"]', r"figures\.toml: 1: there is no equation 9\.9"),
    "result": ("paper.toml", 'results = ["1.1"]', 'results = ["9.9"]', r"results: there is no equation 9\.9"),
    "claim's id": ("claims.toml", 'id = "C01"', 'id = "first"', r"ids of claims, and only these, are C and a number"),
}


@pytest.mark.parametrize(("file", "old", "new", "says"), DOORS.values(), ids=DOORS)
def test_a_folder_that_does_not_fit_together_is_refused_at_the_door(
    file: str, old: str, new: str, says: str, folder: Path
) -> None:
    Paper(folder)
    harmed(folder, file, old, new)
    with pytest.raises(InputError, match=says):
        Paper(folder)


MOTION = "derivations/s1_motion.py"
SOLVED = (PAPERS / "pendulum" / MOTION).read_text(encoding="utf-8").partition("(acceleration,) =")[0].count("\n") + 1
LETTER = r"s1_motion\.py:\d+: .*equations\.toml: 1\.1: .*'L' is not defined"
FAILURES = {
    "fails": (MOTION, "(acceleration,) =", "(a, b) =", rf"s1_motion\.py:{SOLVED}: ValueError"),
    "no Python": (MOTION, "(acceleration,) =", "(acceleration,) = =", rf"s1_motion\.py:{SOLVED}: invalid syntax"),
    "wrong proof": (
        MOTION,
        "theta_a + m",
        "theta_a - m",
        r"s1_motion\.py:\d+: prove: Lagrange's equation: left − right is nonzero",
    ),
    "unknown equation": (
        MOTION,
        'verdict("1.1"',
        'verdict("1.7"',
        rf"s1_motion\.py:{SOLVED + 1}: there is no equation '1\.7'",
    ),
    "letter": ("equations.toml", '"-g/l*theta"', '"-g/L*theta"', LETTER),
    "symbols": ("symbols.py", "= Glossary()", "= Glossar()", r"symbols\.py: NameError"),
}


@pytest.mark.parametrize(("file", "old", "new", "says"), FAILURES.values(), ids=FAILURES)
def test_a_script_that_fails_is_named_with_file_and_line(
    file: str, old: str, new: str, says: str, folder: Path
) -> None:
    harmed(folder, file, old, new)
    with pytest.raises((InputError, ScriptError), match=says):
        Paper(folder).audit()


def test_two_verdicts_on_one_equation_are_refused(folder: Path) -> None:
    shutil.copy(folder / "derivations/s1_motion.py", folder / "derivations/s2_again.py")
    with pytest.raises(LagrotorError, match=r"s2_again\.py:\d+: a verdict on 1\.1 is in s1_motion\.py:\d+ already"):
        Paper(folder).audit()


def test_a_record_is_renewed_for_what_was_found_and_keeps_the_rest(folder: Path) -> None:
    paper = Paper(folder)
    old = {"1.1": "refuted", "C01": "confirmed", "9.9": "holds"}
    text = "".join(f'["{identifier}"]\nverdict = "{verdict}"\n' for identifier, verdict in old.items())
    paper.record_file.write_text(text, encoding="utf-8")
    verdicts = list(paper.audit())
    assert paper.changes(verdicts, ["1.1"]) == ["1.1: recorded refuted, found holds-to-order"]
    paper.renew_record(verdicts)
    assert {i: row.verdict for i, row in paper.recorded.items()} == {"1.1": "holds-to-order", "C01": "confirmed"}


# What each misprint of the heavy top's catalogue must be found as; the first two stand there already.
TOP = PAPERS / "heavy_top"
MISPRINTS = {
    "1.1": ("I_3/2*(psi_dot", "I_3*(psi_dot"),
    "1.3": ("I_1*sin(theta)**2 + I_3", "I_1*sin(theta)**2 - I_3"),
    "1.6": ("p_psi**2/(2*I_3)", "p_psi**2/(2*I_1)"),
    "1.7": ("m*g*l/I_1*sin(theta)", "m*g*l/I_1*cos(theta)"),
    "2.1": ('Omega - I_1*Omega**2*cos(theta)"', 'Omega + I_1*Omega**2*cos(theta)"'),
    "2.2": ('["m*g*l/(I_3*omega_3)"]', '["2*m*g*l/(I_3*omega_3)"]'),
    "3.1": ('["I_3*omega_3/I_1"]', '["I_1*omega_3/I_3"]'),
}


@pytest.fixture(scope="module")
def top() -> Paper:
    return Paper(TOP)


def test_the_two_misprints_of_the_heavy_top_are_found_and_no_other(top: Paper) -> None:
    audit = top.audit()
    refuted = {v.id: v.correction_verdict for v in audit if v.verdict == "refuted"}
    assert refuted == {"3.2": "holds-to-order", "4.1": "holds"}
    assert len(audit) == len(top.equations) == 13 and not audit.waiting
    assert top.changes(audit, top.equations) == []
    assert audit["2.2"].condition == "gravity is weak, m g l ≪ I₃²ω₃²/I₁"
    assert all(audit[i].reaches_result for i in refuted)


def test_every_other_misprint_of_the_heavy_top_would_be_found(top: Paper, tmp_path: Path) -> None:
    copy = Path(shutil.copytree(TOP, tmp_path / "top"))
    for old, new in MISPRINTS.values():
        edit(copy / "equations.toml", old, new)
    edit(copy / "equations.toml", 'members = ["m*g*l*I_1/(I', 'members = ["2*m*g*l*I_1/(I')
    edit(copy / "equations.toml", 'members = ["4*m*g*l*I_1/I_3"]', 'members = ["4*m*g*l*I_1/I_3**2"]')
    wrong = Paper(copy)
    wrong.scripts.ran.update({copy / path.relative_to(TOP): script for path, script in top.scripts.ran.items()})
    assert {v.id for v in wrong.audit() if v.verdict == "refuted"} == set(MISPRINTS)
