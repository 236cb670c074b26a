"""The ledger decides by identity or by order, under the fewest premises, and by nothing else."""

from dataclasses import replace
from typing import Any

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.pair.notation import r0
from lagrotor.paper import Premise, grammar, judge, ledger, verdict
from lagrotor.paper.equation_statements import statement
from lagrotor.paper.ledger import decide
from lagrotor.paper.record import changes, reaches_result, record_text, recorded
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.verdicts import Relation, Statement, chain

x, y = sp.symbols("x y", real=True)
n = sp.Symbol("n", positive=True)
ONE = Premise("one of them", {n: sp.Integer(1)})


def verdict_of(printed: sp.Expr, derived: sp.Expr, **more: object):
    return decide(Statement("5.01", (Relation(printed, derived),), **more))


def on_paper(*given: object, **more: object) -> Statement:
    """What a derivation states, beside the print."""
    return statement(verdict(*given, **more), PAPER)


def test_an_identity_holds_with_its_domain() -> None:
    decided = verdict_of(sp.tan(x), sp.sin(x) / sp.cos(x))
    assert (decided.verdict, decided.premises) == ("holds", ())
    assert decided.domain == (sp.Ne(sp.cos(x), 0),)


def test_a_wrong_line_is_refuted_and_its_correction_judged() -> None:
    wrong = verdict_of(sp.sin(x) ** 2, 1 + sp.cos(x) ** 2, correction=chain(1 + sp.cos(x) ** 2, 2 - sp.sin(x) ** 2))
    assert (wrong.verdict, wrong.correction_verdict) == ("refuted", "holds")
    worse = verdict_of(sp.sin(x) ** 2, 1 + sp.cos(x) ** 2, correction=chain(1 + sp.cos(x) ** 2, sp.sin(x) ** 2))
    assert (worse.verdict, worse.correction_verdict) == ("refuted", "refuted")


def test_a_premise_is_used_only_where_it_is_needed() -> None:
    needed = verdict_of(x * n, x, premises=(ONE,))
    assert (needed.verdict, needed.condition) == ("holds-if", "one of them")
    idle = verdict_of(x * n, n * x, premises=(ONE,))
    assert (idle.verdict, idle.premises) == ("holds", ())
    useless = verdict_of(x * n, y, premises=(ONE,))
    assert (useless.verdict, useless.premises) == ("refuted", ())


def test_the_fewest_premises_are_reported() -> None:
    other = Premise("the other", {y: sp.Integer(0)})
    third = Premise("a third", {x: sp.Integer(2)})
    both = verdict_of(x * n + y, x, premises=(third, ONE, other))
    assert both.premises == (ONE, other)
    assert decide(Statement("5.01", (Relation(x * n + y, x),), (ONE, third))).verdict == "refuted"


def test_a_line_that_differs_at_a_point_is_not_decided_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without one of the two premises that it needs the line differs, and without the others it holds."""
    answers: list[str] = []

    def decided(*sides: Any) -> Any:
        answers.append((decision := decide_equal(*sides)).answer)
        return decision

    monkeypatch.setattr(ledger, "decide_equal", decided)
    a, b, c, d, x = sp.symbols("a b c d x", real=True)
    given = [Premise(f"{letter} is {value}", {letter: value}) for letter, value in ((a, 1), (b, 2), (c, 3), (d, 4))]
    assert len(judge(a * x + b + c * d, x + 2 + c * d, given).premises) == 2
    assert set(answers) == {"zero"}


def test_premises_that_contradict_each_other_decide_nothing() -> None:
    two = Premise("two of them", {n: sp.Integer(2)})
    for times in (1, 2, 3):
        for premises in ((ONE, two), (two, ONE)):
            decided = verdict_of(x * n, times * x, premises=premises)
            assert (decided.verdict, decided.premises) == ("undecided", ())
            assert "contradict" in decided.evidence[0]
    assert verdict_of(x * n, n * x, premises=(ONE, two)).verdict == "holds", "what needs none of them holds"


def test_the_values_that_the_text_gives_are_a_premise() -> None:
    """Of x n with n = 1 and, in the text, x = 3."""
    there = Relation(sp.Integer(3), x * n, scene={x: sp.Integer(3)})
    assert decide(Statement("5.01", (there,), (ONE,))).premises == (ONE, *there.scene_premises)
    assert decide(Statement("5.01", (replace(there, scene={x: sp.Integer(4)}),), (ONE,))).verdict == "refuted"


def test_a_number_read_off_is_held_to_a_rate_with_roots_and_to_its_sign() -> None:
    rate = n * sp.sqrt((n**2 + 2 * n + 1) / (4 * n**2 * (n + 1) ** 2))  # 1/2 for every positive n
    read = Relation(sp.Rational(1, 2), rate, within=sp.Rational(1, 100))
    assert decide(Statement("5.24", (read,), measured=True)).verdict == "measured"
    for wrong in (sp.Rational(-1, 2), sp.Rational(52, 100), n):
        assert decide(Statement("5.24", (replace(read, printed=wrong),), measured=True)).verdict == "refuted"


def test_an_approximation_brings_in_its_small_quantity() -> None:
    slow = Premise("slow", {x: r0 * y}, small=r0)
    decided = verdict_of(x, sp.sin(x), premises=(slow,))
    assert (decided.verdict, decided.order, decided.small, decided.premises) == ("holds-to-order", 2, r0, (slow,))
    vacuous = verdict_of(2 * x, sp.sin(x), premises=(slow,))
    assert vacuous.verdict == "refuted", "both vanish at zero: what is compared is their leading terms"
    assert "both sides vanish through order 0" in vacuous.evidence[0]
    claimed = Statement("5.01", (Relation(2 * x, sp.sin(x), None, 1),), (slow,))
    assert decide(claimed).verdict == "refuted"


def test_an_order_is_found_and_held_to_what_is_claimed() -> None:
    cosine = decide(Statement("5.01", (Relation(1 - x**2 / 2, sp.cos(x), x, 2),)))
    assert (cosine.verdict, cosine.order) == ("holds-to-order", 3)
    assert [premise.small for premise in cosine.premises] == [x]
    refused = decide(Statement("5.01", (Relation(1 - x**2 / 2, sp.cos(x), x, 4),)))
    assert (refused.verdict, refused.order, refused.premises) == ("refuted", 3, ())
    assert any("order 4" in line for line in refused.evidence)


def test_the_weakest_relation_decides() -> None:
    good, close, bad = Relation(x, x), Relation(x, sp.sin(x), x, 2), Relation(x, -x)
    assert decide(Statement("5.01", (good, close))).verdict == "holds-to-order"
    assert decide(Statement("5.01", (good, close, bad))).verdict == "refuted"
    assert decide(Statement("5.01", (bad,))).correction_verdict is None
    closer = Relation(1 - x**2 / 2, sp.cos(x), x, 2)
    for relations in ((close, closer), (closer, close)):
        assert decide(Statement("5.01", relations)).order == 2
    none, one = Relation(1 + x, 1 + 2 * x, x, 0), Relation(x, x + x**2, x, 1)
    for relations in ((none, one), (one, none)):
        assert decide(Statement("5.01", relations)).order == 0


def test_matrices_are_judged_entry_by_entry() -> None:
    turn = sp.Matrix([[sp.cos(x), -sp.sin(x)], [sp.sin(x), sp.cos(x)]])
    assert verdict_of(turn * turn.T, sp.eye(2)).verdict == "holds"
    assert verdict_of(turn * turn, sp.eye(2)).verdict == "refuted"


def test_a_printed_quantity_must_be_derived_and_a_corrected_one_too() -> None:
    with pytest.raises(InputError, match=r"5\.03 prints M_3: derive it"):
        on_paper("5.03", {"M_z": x})
    with pytest.raises(InputError, match="derive it"):
        on_paper("5.01")
    with pytest.raises(InputError, match="which was not derived"):
        on_paper("5.01", x, correction={"E": x})


def test_a_line_that_another_equation_defines_needs_its_statement() -> None:
    centre = grammar.vector("X")
    with pytest.raises(InputError, match=r"3\.03: M is defined in 3\.01: give its statement"):
        on_paper("3.03", centre)
    with pytest.raises(InputError, match=r"X_cm is defined in 3\.03"):
        on_paper("3.05", centre, uses=["3.03"])


def test_what_another_equation_defines_may_be_a_vector() -> None:
    mass = verdict("3.01", n)
    centre = verdict("3.03", grammar.column(x, y, 1), uses=[mass])
    (relation,) = on_paper("3.06", grammar.column(0, 0, 0), uses=[centre]).relations
    assert not {s.name for s in relation.printed.free_symbols} & {"X_cm_x", "X_cm_y", "X_cm_z"}
    assert {x, y} <= relation.printed.free_symbols


def test_a_number_that_is_set_equal_to_a_vector_is_refuted() -> None:
    decided = verdict_of(x, grammar.column(x, 0, 0))
    assert (decided.verdict, decided.evidence) == (
        "refuted",
        ("the left side is a vector, the printed right side a number",),
    )
    assert verdict_of(grammar.column(x, 0, 0), grammar.column(x, 0, 0)).verdict == "holds"


def test_a_correction_may_rest_on_premises_and_they_are_reported() -> None:
    idle, needed = Premise("y = 0", {y: 0}), Premise("n = 1", {n: 1})
    wrong = verdict_of(-x, n * x, premises=(idle, needed), correction=chain(n * x, x))
    assert (wrong.verdict, wrong.correction_verdict, wrong.premises) == ("refuted", "holds-if", (needed,))
    bare = verdict_of(-x, n * x, premises=(idle, needed), correction=chain(n * x, x * n))
    assert (bare.verdict, bare.correction_verdict, bare.premises) == ("refuted", "holds", ())
    kept = verdict_of(x, n * x, premises=(idle, needed), correction=chain(n * x, x * n))
    assert (kept.verdict, kept.correction_verdict, kept.premises) == ("holds-if", "holds", (needed,))


def test_errors_are_followed_to_the_results() -> None:
    uses = {"5.15": ("5.14",), "5.14": ()}
    assert reaches_result("5.14", ["5.15"], {"5.14": "refuted", "5.15": "refuted"}, uses)
    assert not reaches_result("5.14", ["5.15"], {"5.14": "refuted", "5.15": "holds"}, uses)
    assert reaches_result("5.15", ["5.15"], {"5.15": "refuted"}, {})


def test_the_record_is_written_and_read_alike(tmp_path) -> None:
    before, file = PAPER.recorded, tmp_path / "recorded.toml"
    assert recorded(file) == {}
    file.write_text(record_text(before), encoding="utf-8")
    assert recorded(file) == before
    assert file.read_text() == PAPER.record_file.read_text()
    refuted = {"5.01": replace(before["5.01"], verdict="refuted")}
    assert changes(refuted, before, ["5.01"]) == [f"5.01: recorded {before['5.01'].verdict}, found refuted"]


@pytest.mark.parametrize("field", ["printed", "uses", "premises", "domain", "lines", "correction"])
def test_a_change_of_any_part_of_a_verdict_is_named(field: str) -> None:
    before = PAPER.recorded
    assert changes(before, before, before) == []
    identifier = next(i for i, row in before.items() if getattr(row, field))
    other = "x" if field == "printed" else (*getattr(before[identifier], field), "x")
    (said,) = changes(before | {identifier: replace(before[identifier], **{field: other})}, before, before)
    assert said.startswith(f"{identifier}: ") and "recorded" in said and said.endswith("x")


@pytest.mark.parametrize(
    ("printed", "derived", "order", "verdict", "reached"),
    [
        (sp.cot(x), 1 / x - x / 3, 2, "holds-to-order", 2),
        (sp.cot(x), 1 / x - x / 2, 2, "refuted", 0),
        (1 / x, 2 / x, 0, "refuted", -2),
        (sp.sqrt(sp.sin(x)), sp.sqrt(x), 2, "holds-to-order", 2),
        (x * sp.sqrt(x), 2 * x * sp.sqrt(x), 1, "refuted", 1),  # both vanish through order 1, where nothing is compared
        (x * sp.sqrt(x) + x**2, x * sp.sqrt(x), 1, "holds-to-order", 1),
        (sp.log(sp.sin(x)), sp.log(x) - x**2 / 6, 3, "holds-to-order", 3),
        (sp.log(sp.sin(x)), sp.log(x) / 2, 0, "refuted", -1),
        (sp.exp(1 / x), 1 / x, 0, "undecided", None),
    ],
)
def test_series_about_a_singular_point_hold_through_whole_orders(
    printed: sp.Expr, derived: sp.Expr, order: int, verdict: str, reached: int | None
) -> None:
    judged = judge(printed, derived, small=x, order=order)
    assert (judged.verdict, judged.order) == (verdict, reached)


def test_text_is_read_in_the_letters_of_the_derived_side_and_shown_so() -> None:
    decided = judge("n*x", x, premises={n: 1})
    assert repr(decided).splitlines() == ["n·x = x: holds-if", "  under the given premise n = 1"]
    assert "holds-if<br>under the given premise n = 1" in decided._repr_html_()
    assert judge("n*cos(x)", n * sp.sin(x)).verdict == "refuted"
    assert judge("0.5*x", x / 2).verdict == "holds", "a decimal is the rational that it is"


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (lambda: judge("z*x", x), "'z' is not defined: declare the symbol"),
        (lambda: judge(x, "x"), "judge"),
        (lambda: judge([x], x), "judge"),
        (lambda: judge(x, y, premises={x: "y"}), "premises"),
        (lambda: judge(x, y, premises="x >= 0"), "premises"),
        (lambda: judge(x, y, premises=x), "premises"),
        (lambda: judge(x, y, premises=[sp.Or(x > 0, y > 0)]), "premises"),
        (lambda: judge(x, y, premises={sp.ImmutableMatrix([x, y]): sp.Matrix([1, 2, 3])}), "premises"),
        (lambda: Premise("x is y", {x: "y"}), "premise"),
        (lambda: judge(x, sp.sin(x), small="x", order=2), "must be a symbol"),
        (lambda: judge(x, sp.sin(x), small=x, order=-1), "whole number"),
        (lambda: judge("sin(" * 200 + "x" + ")" * 200, sp.sin(x)), "brackets within brackets"),
    ],
)
def test_what_is_no_expression_and_no_premise_is_refused(wrong, says) -> None:
    with pytest.raises(InputError, match=says):
        wrong()
