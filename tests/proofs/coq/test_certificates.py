"""Certificates: Coq accepts what was decided, and rejects a print, a premise, a condition that is another one."""

import json
import re
import shutil
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from lagrotor.commands.command_line import main
from lagrotor.errors import InputError, NotExactError
from lagrotor.paper import Paper, Premise, Relation, Statement, decide, judge
from lagrotor.paper.catalogue import Equation
from lagrotor.proofs.coq import coq_check
from lagrotor.proofs.coq.certificate import (
    PREAMBLE,
    CertifiedLine,
    Proposition,
    _symbols_for_operators,
    certificate,
    certified_line,
    file_name,
)
from lagrotor.proofs.coq.cofactors import cofactors_of
from lagrotor.proofs.coq.coq_check import (
    CERTIFICATE_LIST,
    CertifiedEquation,
    certify,
    check_certificates,
    foreign_word,
    read_certificates,
)
from lagrotor.proofs.coq.coq_terms import Terms, comment, conditions_of_value

coq = pytest.mark.usefixtures("coq_is_here")

x, y, z = sp.symbols("x y z", real=True)
J, I_3, R = sp.symbols("J I_3 R", positive=True)
ENTRY = Equation("1.1", "1", "a line", "x = y")
HEAVY_TOP = Path(__file__).parents[3] / "papers" / "heavy_top"


def of(
    printed: Any, derived: Any, given: Any = (), entry: Equation = ENTRY, **series: Any
) -> tuple[str, CertifiedLine]:
    """The file of one line, and the line."""
    text, (line,) = certificate(judge(printed, derived, given, **series), entry)
    return text, line


@pytest.fixture(scope="session")
def coq_is_here() -> None:
    if why := coq_check.missing_coq() if shutil.which("coqc") else "coqc is not installed":
        pytest.skip(why)


def failures(text: str, lines: tuple[CertifiedLine, ...]) -> Mapping[str, str]:
    row = CertifiedEquation("1.1", "", "equation_1_1.v", lines)
    return coq_check._failures_of([(row, text)])[0]


IDENTITIES: list[tuple[Any, Any, Any]] = [
    ((x**2 - 1) / (x - 1), x + 1, ()),
    (sp.sin(3 * x), 3 * sp.sin(x) - 4 * sp.sin(x) ** 3, ()),
    (sp.cos(x + sp.pi / 2), -sp.sin(x), ()),
    (sp.tan(x / 2), sp.sin(x) / (1 + sp.cos(x)), ()),
    (sp.cot(x) * sp.sec(x), sp.csc(x), ()),
    (sp.cosh(x) ** 2 - sp.sinh(x) ** 2, sp.S.One, ()),
    (sp.exp(x + y) * sp.exp(-y), sp.exp(x), ()),
    (sp.tanh(x), (sp.exp(2 * x) - 1) / (sp.exp(2 * x) + 1), ()),
    (1 / (sp.sqrt(x**2 + 1) + x), sp.sqrt(x**2 + 1) - x, ()),
    (sp.sqrt(R) ** 3 / R, sp.sqrt(R), ()),
    (sp.sqrt((x**2 + 1) / R) ** 2 * R / (y**2 + 1), (x**2 + 1) / (y**2 + 1), ()),
    (1 / (sp.sqrt(x**2 + J / R) - x), (sp.sqrt(J / R + x**2) + x) * R / J, ()),
    (J * x + I_3 * y, I_3 * (x + y), {J: I_3}),
    (sp.sin(y) / J, -sp.sin(x) / (I_3 + R), {y: -x, J: I_3 + R}),
    (sp.sin(x * y + z), sp.sin(x * y) * sp.cos(z) + sp.cos(x * y) * sp.sin(z), ()),
    (sp.cos(y) + 1, sp.S.One, {y: sp.pi / 2}),
]


def accepted(rows: list[tuple[Any, Any, Any]], ending: str = "") -> bool:
    """Whether Coq accepts a line for each row, all in one file; the last theorem of each has a name with this ending."""
    texts, lines = [], []
    for number, (printed, derived, given) in enumerate(rows, 1):
        text, line = of(printed, derived, given)
        assert line.theorems and line.theorems[0] == f"line_1{ending}", (printed, line.why_not)
        texts.append(text.split(PREAMBLE)[1].replace("line_1", f"line_{number}"))
        theorems = tuple(name.replace("line_1", f"line_{number}") for name in line.theorems)
        lines.append(CertifiedLine(f"line_{number}", "", "", theorems))
    return failures(PREAMBLE + "\n".join(texts), tuple(lines)) == {}


FALSE: list[tuple[Any, Any, Any]] = [
    (sp.sin(2 * x), 2 * sp.sin(x), ()),
    (J * x, I_3 * y, {J: I_3}),
    (sp.sqrt(x**2 + y**2), x + y, ()),
    (sp.exp(x + y), sp.exp(x) + sp.exp(y), ()),
    (sp.cosh(x), 1 + x**2 / 2, ()),
    (1 / (x + y), 1 / x + 1 / y, ()),
    (sp.Matrix([x, y]), sp.Matrix([x, y + sp.Rational(1, 10**6) * x]), ()),
]


@coq
@pytest.mark.slow
def test_coq_accepts_identities_of_every_function_and_the_points_at_which_lines_are_refuted() -> None:
    assert accepted(IDENTITIES) and accepted(FALSE, "_refuted")


e = sp.Symbol("e", real=True)
SMALL = [Premise("small angle e", {x: e * x, y: e * y}, e)]
SQUARES = (
    sp.sqrt((1 + sp.sin(x)) ** 2 + sp.sin(y) ** 2),
    sp.sqrt((1 + sp.sin(x)) ** 2 + (1 - sp.cos(y)) ** 2 + sp.sin(y) ** 2),
)


def read_off(printed: Any, derived: Any, within: str, given: Any = (), known: Any = None) -> tuple[str, CertifiedLine]:
    """The file of one number that is read off a run, and the line."""
    relation = Relation(sp.sympify(printed), derived, within=sp.Rational(within), known=known)
    text, (line,) = certificate(decide(Statement("", (relation,), given, measured=True)), ENTRY)
    return text, line


# Kind -> its file and line, and what is changed in it: the print, a hypothesis that is exchanged or dropped.
KINDS: dict[str, tuple[Callable[[], tuple[str, CertifiedLine]], list[tuple[str, str]]]] = {
    "an identity": (
        lambda: of(sp.tan(x / 2), sp.sin(x) / (1 + sp.cos(x))),
        [("tan (x / 2) =", "tan (x / 3) ="), ("(defined_1 : cos (x / 2) <> 0)", ""), ("<> 0)", "<> 1)")],
    ),
    "under an equation": (
        lambda: of(J * x, I_3 * x, {J: I_3}),
        [("x * J =", "2 * x * J ="), ("(premise_1 : J = I_3)", ""), ("(premise_1 : J = I_3)", "(premise_1 : I_3 = x)")],
    ),
    "a point": (
        lambda: of(2 * x, 3 * x),
        [("2 * x - (3 * x)", "3 * x - (3 * x)"), ("exists (", "exists (- ")],
    ),
    "a series in the letter": (
        lambda: of(x, x + e**2 * y / (1 + x**2), small=e, order=1),
        [("\n  x - (", "\n  2 * x - ("), ("= e ^ 2 * (", "= e ^ 3 * (")],
    ),
    "a series of a cosine": (
        lambda: of(y, y / sp.cos(x), small=x, order=1),
        [("\n  y - (", "\n  2 * y - ("), ("= (sin x) ^ 2 * (", "= (sin x) ^ 3 * ("), ("(defined_1 : cos x <> 0)", "")],
    ),
    "a series of roots": (
        lambda: of(1 + 2 * sp.sin(x) ** 2, sp.sqrt(1 + 4 * sp.sin(x) ** 2), small=x, order=3),
        [("1 - (sqrt", "2 - (sqrt"), ("^ 4 * (", "^ 5 * (")],
    ),
    "a series of several sines": (
        lambda: of(*SQUARES, SMALL, small=e, order=3),
        [
            ("\n  sqrt ((sin x + 1)", "\n  sqrt ((sin x + 2)"),
            ("premise_1 : x = e", "premise_1 : x = 1 + e"),
            ("= e ^ 4 * (", "= e ^ 5 * ("),
        ],
    ),
    "refuted at an order": (
        lambda: of(y / sp.cos(x), y * (1 + sp.sin(x) ** 2), small=x, order=2),
        [("/ cos x - (", "/ cos x + ("), ("<= - ", "<= 1 - ")],
    ),
    "a number of a run": (
        lambda: read_off(sp.Rational("11.4"), 80 * R / (7 * I_3), "1/228", [Premise("", {R: I_3})]),
        [("(57 / 5) =", "(56 / 5) ="), ("(premise_1 : R_ = I_3)", ""), ("<= (1 / 228)", "<= (1 / 500)")],
    ),
    "a number of a run, with roots": (
        lambda: read_off(sp.Rational("1.41"), sp.sqrt(2 * R**2 + 2 * J) / sp.sqrt(R**2 + J), "1/100"),
        [("(141 / 100) =", "(142 / 100) ="), ("<= (1 / 100)", "<= (1 / 500)")],
    ),
    "a ratio that changes": (
        lambda: read_off(R / sp.cos(x), R * (1 + sp.sin(x) ** 2), "1/100", known=(x, 3)),
        [("(R_ / cos x) / (", "(2 * R_ / cos x) / ("), ("(sin x) ^ 2 * (", "(sin x) ^ 3 * (")],
    ),
    "equations used together": (
        lambda: of(x**2 + y**2, sp.Integer(5), [sp.Eq(x + y, 3), sp.Eq(x * y, 2)]),
        [("  (premise_1 : x + y = 3)", "  (* *)"), ("x * y = 2", "x * y = 3"), ("= 5", "= 6")],
    ),
    "an equation between functions": (
        lambda: of(sp.cos(x) ** 2, 1 - y**2, [sp.Eq(2 * sp.sin(x), 2 * y)]),
        [("  (premise_1 : 2 * sin x = 2 * y)", "  (* *)"), ("2 * sin x = 2 * y", "2 * cos x = 2 * y")],
    ),
    "an equation between quotients": (
        lambda: of(x / y, z / J, [sp.Eq(x * J, y * z)]),
        [("  (premise_1 : x * J = y * z)", "  (* *)"), ("x * J = y * z", "y * J = x * z")],
    ),
    "a number beside a vector": (
        lambda: of(x, sp.Matrix([x, y, z])),
        [("inl (x) <> (inr", "inr (x, x, x) <> (inr")],
    ),
}


@coq
@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_of_each_kind_coq_accepts_the_certificate_and_rejects_each_change(kind: str) -> None:
    make, changed = KINDS[kind]
    text, line = make()
    assert line.theorems, line.why_not
    assert failures(text, (line,)) == {}, kind
    for old, new in changed:
        assert old in text, (old, text.split(PREAMBLE)[1])
        head, body = text.split(PREAMBLE)
        assert failures(head + PREAMBLE + body.replace(old, new), (line,)), (old, new)


def test_every_kind_has_its_theorems_and_a_series_of_another_function_has_none() -> None:
    for make, _ in KINDS.values():
        assert make()[1].theorems
    _, line = of(1 + x, sp.exp(x), small=x, order=1)
    assert line.verdict == "holds-to-order" and line.why_not.endswith("is a series in x")
    _, line = of(x, sp.sin(x), small=x, order=2)
    assert line.verdict == "holds-to-order" and not line.theorems


def test_cofactors_are_those_of_the_zeros() -> None:
    """x² + y² − 5 = (x + y + 3)(x + y − 3) − 2 (x y − 2); 1 is in no ideal with a zero."""
    ring, a, b = sp.ring("a b", sp.QQ, sp.lex)
    zeros = [a + b - 3, a * b - 2]
    for target in (a**2 + b**2 - 5, a**3 * b - 2 * a**2, (a - b) ** 2 - 1):
        cofactors, rest = cofactors_of(target, zeros)
        assert not rest and sum(q * zero for q, zero in zip(cofactors, zeros, strict=True)) == target
    assert cofactors_of(ring.one, zeros)[1] and cofactors_of(a - 1, zeros)[1]
    cofactors, rest = cofactors_of(ring.one, [a, a * b - 1])
    assert not rest and cofactors[0] * a + cofactors[1] * (a * b - 1) == 1


def rejected(sound: str, *changed: str) -> list[str]:
    """The theorems that Coq rejects in one file: line_1 as it is, and each of the changed, line_2, line_3, …

    Coq takes longer to load its libraries than to check any of them.
    """
    more = [text.split(PREAMBLE)[1].replace("line_1", f"line_{n}") for n, text in enumerate(changed, 2)]
    text = "\n".join([sound, *more])
    lines = tuple(CertifiedLine(name, "", "", (name,)) for name in re.findall(r"^Theorem (\w+)", text, re.MULTILINE))
    return list(failures(text, lines))


@coq
def test_coq_rejects_what_was_changed_and_what_comes_after_it_is_not_hidden() -> None:
    text, _ = of(J * x / z + sp.sin(y) ** 2, I_3 * x / z + 1 - sp.cos(y) ** 2, {J: I_3})
    wrong = [text.replace("x * J / z +", "2 * x * J / z +"), text.replace("  (premise_1 : J = I_3)", "  (* *)")]
    assert text not in wrong
    assert {"line_2", "line_3"} <= {*rejected(text, *wrong, text)} <= {"line_2", "line_3", "line_3_has_a_case"}


@coq
def test_a_refutation_with_another_enclosure_or_point_is_rejected() -> None:
    text, _ = of(2 * x, 3 * x)
    point = re.search(r"exists \((.*?)\)\. at_the_point", text)
    assert point
    elsewhere = text.replace(point[0], "exists (0). at_the_point")
    other = re.sub(r"<= 2 \* x - \(3 \* x\)", "<= 3 * x - (3 * x)", text)
    assert text not in (elsewhere, other) and rejected(text, elsewhere, other) == [
        "line_2_refuted",
        "line_3_refuted",
    ]


def test_a_file_with_an_axiom_a_notation_or_an_open_proof_is_refused() -> None:
    text, line = of(x + y, y + x)
    assert foreign_word(text) == ""
    for added in (
        "Axiom a : 0 = 1.",
        "Admitted.",
        'Notation "a = b" := True.',
        "Parameter p : False.",
        "#[x] Lemma a.",
    ):
        assert failures(text + "\n" + added, (line,))[""]
    assert failures(text.replace("Qed.", "Admitted."), (line,))
    assert foreign_word(f"(* Axiom *) (* (* Axiom a *) *)\n{PREAMBLE}(* Axiom *)") == ""
    assert foreign_word(f"{PREAMBLE}(* *) Axiom a : False. (* *)") == "Axiom"


GIVEN_UP = [
    "- Admitted.",
    "+ Axiom a : 0 = 1. apply a. Qed.",
    "-- ++ *** Admitted.",
    "1:{ Admitted.",
    "{ Admitted.",
    "idtac... Admitted.",
    "Admitted.",
    '(* "(*" *) Admitted. (* "*)" *)',
]


def given_up(script: str) -> tuple[str, CertifiedLine]:
    """A false line, whose proof is the script."""
    text, line = of(x + y, y + x)
    false = f"Theorem line_1 : 0 = 1.\nProof.\n {script}\n"
    return re.sub(r"Theorem line_1.*", lambda _: false, text, flags=re.DOTALL), line


@pytest.mark.parametrize("script", GIVEN_UP)
def test_a_proof_that_is_given_up_is_refused_wherever_that_stands(script: str) -> None:
    text, line = given_up(script)
    assert failures(text, (line,))[""].startswith("the file holds")


@coq
@pytest.mark.slow
@pytest.mark.parametrize("script", GIVEN_UP)
def test_coq_itself_takes_a_proof_that_is_given_up(script: str, tmp_path: Path) -> None:
    assert coq_check._compile(tmp_path, "twin.v", given_up(script)[0]) == ""


@coq
@pytest.mark.slow
def test_files_that_are_checked_together_are_rejected_one_by_one(tmp_path: Path) -> None:
    """Ten equations, of which the third, the fifth and the seventh are false: one theorem, one sentence, one name."""
    texts, rows = [], []
    for place in range(1, 11):
        entry = replace(ENTRY, id=f"1.{place}")
        text, line = of(x + place * y, place * y + x, entry=entry)
        texts.append(text)
        rows.append(CertifiedEquation(entry.id, "holds", file_name(entry.id), (line,)))
    texts[2] = texts[2].replace("= 3 * y + x", "= 4 * y + x").replace("= x + 3 * y", "= x + 4 * y")
    texts[4] = texts[4].replace("Qed.", "- Admitted.")
    texts[6] = texts[6].replace("line_1", "line_2")
    found = coq_check._failures_of(list(zip(rows, texts, strict=True)))
    assert [bool(each) for each in found] == [place in (3, 5, 7) for place in range(1, 11)]
    assert list(found[2]) == ["line_1"] and found[4][""].startswith("the file holds")
    assert "does not hold one" in found[6][""]
    found = coq_check._failures_of([pair for place, pair in enumerate(zip(rows, texts, strict=True)) if place < 2])
    assert found == [{}, {}]


@pytest.mark.parametrize(
    "forged", ["Lemma sin (x : R) : R.", "Theorem sin (x : R) : R.", "Ltac same := admit.", "Definition sin := cos."]
)
def test_no_name_of_the_statements_can_be_taken_by_another_thing(forged: str) -> None:
    """A second sine would make every theorem below it one about something else."""
    text, line = of(x + y, y + x)
    proof = " Proof. exact x. Qed." if forged.endswith(": R.") else ""
    for other in (
        text.replace(PREAMBLE, f"{PREAMBLE}{forged}{proof}\n"),
        text.replace(PREAMBLE, f"{forged}{proof}\n{PREAMBLE}"),
    ):
        assert other != text and failures(other, (line,))[""]
    assert failures(text.replace("Ltac same := ", "Ltac same := try admit; "), (line,))[""]


# ---- what the terms say


CONDITIONS: list[tuple[Any, list[tuple[str, Any]]]] = [
    (1 / (x + y), [("<>", x + y)]),
    (sp.sqrt(x), [("<=", x)]),
    (1 / sp.sqrt(x), [("<", x)]),
    (x ** sp.Rational(3, 2), [("<=", x)]),
    (sp.log(x), [("<", x)]),
    (x**y, [("<", x)]),
    (sp.tan(x), [("<>", sp.cos(x))]),
    (sp.cot(x), [("<>", sp.sin(x))]),
    (sp.asin(x), [("<=", 1 - x), ("<=", 1 + x)]),
    (1 / (x - 1 / y), [("<>", y), ("<>", x - 1 / y)]),
    (x**-2 + 1 / R + sp.sqrt(R) + sp.sqrt(2), [("<>", x)]),
]


def test_a_denominator_a_root_and_a_logarithm_have_their_conditions() -> None:
    assert [conditions_of_value([e]) for e, _ in CONDITIONS] == [found for _, found in CONDITIONS]


FOREIGN = ["R", "sin", "PI", "forall", "I", "exp", "premise_1", "known_1", "Rinv", "by_cofactors"]
HOSTILE = [*FOREIGN, "x'", "a b", "θ", "*)", "1"]


def test_no_letter_hides_a_word_of_the_terms_and_no_two_have_one_name() -> None:
    letters = [sp.Symbol(name) for name in HOSTILE]
    names = Terms(letters).names.values()
    assert len(set(names)) == len(letters) and not set(names) & set(FOREIGN)
    assert all(re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII) for name in names)
    with pytest.raises(NotExactError, match="two symbols are called g"):
        Terms([sp.Symbol("g") + sp.Symbol("g", positive=True)])


@coq
@pytest.mark.slow
def test_letters_with_hostile_names_are_only_letters() -> None:
    a, b, *rest = (sp.Symbol(name, real=True) for name in HOSTILE)
    total = sum(n * letter for n, letter in enumerate(rest, 2))
    text, line = of(sp.sin(a + b) / b + total, (sp.sin(a) * sp.cos(b) + sp.cos(a) * sp.sin(b)) / b + total)
    assert line.theorems and failures(text, (line,)) == {}
    text, line = of(sp.Symbol("PI", real=True), sp.pi)  # the letter is not the number
    assert line.verdict == "refuted" and failures(text, (line,)) == {}


@pytest.mark.parametrize(
    "side",
    [sp.I * x, sp.Float(0.5) * x, sp.Piecewise((x, x > 0), (-x, True)), sp.gamma(x), sp.Symbol("i", imaginary=True)],
)
def test_what_has_no_term_over_the_reals_has_no_certificate(side: Any) -> None:
    assert of(side, side)[1].theorems == ()


CONTRADICTORY = [[(x, 1), (x, 2)], [(x, 0)], [(R, -1)], [(y, x), (y, x + 1)], [(sp.sin(x), 2)], [(x**2, -1)]]


@pytest.mark.parametrize("rows", CONTRADICTORY)
def test_hypotheses_that_contradict_each_other_prove_nothing(rows: list[tuple[Any, Any]]) -> None:
    equations = tuple(("", sp.sympify(left), sp.sympify(right)) for left, right in rows)
    for verdict, derived in (("holds-if", 1 / x + R), ("refuted", 2 / x + R)):
        line = certified_line(Proposition("line_1", "", verdict, 1 / x + R, derived, equations))  # type: ignore[arg-type]
        assert not line.theorems and line.why_not


@coq
def test_an_inequality_is_a_hypothesis_and_a_point_obeys_it() -> None:
    above = (sp.Ge(x, 2), sp.Ne(y, x))
    holds = certified_line(Proposition("line_1", "", "holds-if", (x - y) / (x - y), sp.S.One, region=above))
    refuted = certified_line(Proposition("line_1", "", "refuted", x, 2 * x, region=(sp.Gt(x, 2),)))
    assert "0 <= x - 2" in holds.text and "0 < x - 2" in refuted.text
    assert holds.theorems and refuted.theorems and rejected(PREAMBLE + holds.text, PREAMBLE + refuted.text) == []
    assert not certified_line(Proposition("line_1", "", "holds", x, x, region=(sp.Gt(x, 2), sp.Lt(x, 1)))).theorems
    assert not certified_line(Proposition("line_1", "", "holds", x, x, region=(sp.Or(x > 2, x < 1),))).theorems


def test_words_of_a_paper_stay_in_their_comment() -> None:
    evil = '*) Axiom a : False. (* " *'
    assert comment(evil).count("*)") == 1 and comment(evil).endswith("*)") and '"' not in comment(evil)
    entry = Equation("1.1", "1", evil, evil, reading=evil)
    text, line = of(J * x, I_3 * x, [Premise(evil, {J: I_3})], entry)
    assert line.theorems and foreign_word(text) == ""


@coq
def test_an_unknown_function_is_one_of_which_nothing_is_used() -> None:
    f = sp.Function("f")
    line = certified_line(Proposition("line_1", "", "holds", f((x + y) ** 2) + x, x + f(x**2 + 2 * x * y + y**2)))
    assert "(f : R -> R)" in line.text and failures(PREAMBLE + line.text, (line,)) == {}
    assert not certified_line(Proposition("line_1", "", "refuted", f(x), f(y))).theorems


def test_a_derivative_is_a_letter_that_the_line_does_not_have() -> None:
    f = sp.Function("f")
    rate, taken = sp.diff(f(x), x), sp.Symbol("derivative_1")
    letters = _symbols_for_operators([rate + taken, sp.Integral(f(x), (x, 0, y))])
    assert set(letters) == {rate, sp.Integral(f(x), (x, 0, y))} and len({*letters.values(), taken}) == 3


# ---- the folder, the commands


def test_a_folder_lists_its_lines_and_replaces_only_its_own(tmp_path: Path) -> None:
    paper = Paper(HEAVY_TOP)
    folder = tmp_path / "certificates"
    verdicts = paper.audit().verdicts
    rows = certify(verdicts, paper, folder)
    assert [row.id for row in read_certificates(folder)] == list(paper.equations) == [row.id for row in rows]
    assert (folder / "equation_1_1.v").is_file() and json.loads((folder / CERTIFICATE_LIST).read_text())[0][
        "id"
    ] == "1.1"
    certify(verdicts[1:], paper, folder)
    assert not (folder / "equation_1_1.v").exists() and (folder / "equation_1_2.v").is_file()
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.tex").write_text("mine")
    with pytest.raises(InputError, match="other files"):
        certify(verdicts, paper, other)
    with pytest.raises(InputError, match=r"has no certificates\.json"):
        read_certificates(other)
    assert file_name("5.15") == "equation_5_15.v"


@coq
@pytest.mark.slow
def test_the_heavy_tops_certificates_are_accepted_and_a_changed_one_is_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "certificates"
    assert main(["audit", "--paper", str(HEAVY_TOP), "--certify", str(folder)]) == 0
    assert main(["certify", str(folder), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out.split("\n[")[-1].join(["[", ""]))
    exact = [row for row in rows if row["verdict"] in EXACT and "where epsilon is zero" not in row["why"]]  # no series
    assert {row["checked"] for row in exact} == {"accepted"} and all(row["why"] for row in rows if row not in exact)
    file = folder / "equation_1_2.v"
    file.write_text(file.read_text().replace("psi_dot", "(2 * psi_dot)"))
    assert main(["certify", str(folder)]) == 1
    assert "rejected" in capsys.readouterr().out


@pytest.mark.slow
def test_a_report_links_each_verdict_to_its_certificate(tmp_path: Path) -> None:
    assert (
        main(["reproduce", "--paper", str(HEAVY_TOP), "--out", str(tmp_path / "report"), "--jobs", "1", "--certify"])
        == 0
    )
    page = (tmp_path / "report" / "whole.html").read_text()
    listed = read_certificates(tmp_path / "report" / "certificates")
    assert all((f'href="certificates/{row.file}"' in page) == bool(row.file) for row in listed) and listed[0].file
    assert main(["reproduce", "--paper", str(HEAVY_TOP), "--out", str(tmp_path / "report"), "--jobs", "1"]) == 0
    assert not (tmp_path / "report" / "certificates").exists()


def test_without_coq_nothing_is_said_to_be_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    folder = tmp_path / "certificates"
    certify(Paper(HEAVY_TOP).audit().verdicts, Paper(HEAVY_TOP), folder)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["certify", str(folder)]) == 2
    assert re.search(
        r"nothing was checked, \d+ lines were skipped: coqc is not on the PATH: install", capsys.readouterr().err
    )


@coq
@pytest.mark.slow
def test_every_exact_verdict_of_the_paper_has_a_certificate_that_coq_accepts(audit: Any, tmp_path: Path) -> None:
    from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

    certify(audit, PAPER, tmp_path / "certificates")
    found = check_certificates(tmp_path / "certificates")
    assert [each for each in found if each.status == "rejected"] == []
    assert {(each.id, each.line.verdict) for each in found if each.status == "skipped"} == set()


EXACT = ("holds", "holds-if", "refuted")


@coq
@pytest.mark.slow
@pytest.mark.parametrize("identifier", ["2.12", "3.02", "5.01", "5.12", "5.15", "5.18"])
def test_each_premise_of_a_line_of_the_paper_is_needed(identifier: str, audit: Any) -> None:
    from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

    text, lines = certificate(audit[identifier], PAPER.equation(identifier))
    first = text.split("Theorem line_1_has_a_case")[0]
    line = CertifiedLine("line_1", "", "", ("line_1",))
    assert failures(first, (line,)) == {} and lines[0].theorems
    before = [row for row in first.splitlines() if row.startswith("  (premise_")]
    rejected = [bool(failures(first.replace(row.split("(*")[0].rstrip(" :"), ""), (line,))) for row in before]
    assert any(rejected) and before
