"""The ledger decides by identity or by order, and by nothing else."""

import sympy as sp

from lagrotor.paper.audit import record
from lagrotor.paper.catalogue import claims, equations, figures
from lagrotor.paper.ledger import Relation, Statement, chain, follow_errors, judge

x, y = sp.symbols("x y", real=True)
n = sp.Symbol("n", positive=True)


def verdict_of(printed: sp.Expr, derived: sp.Expr, **more: object):
    return judge(Statement("5.01", (Relation(printed, derived),), **more))


def test_the_catalogue_is_whole() -> None:
    assert (len(equations()), len(claims()), len(figures())) == (68, 24, 28)


def test_an_identity_holds_with_its_domain() -> None:
    verdict = verdict_of(sp.tan(x), sp.sin(x) / sp.cos(x))
    assert verdict.verdict == "holds"
    assert sp.cos(x) in verdict.domain


def test_a_wrong_line_is_refuted_and_its_correction_judged() -> None:
    wrong = verdict_of(sp.sin(x) ** 2, 1 + sp.cos(x) ** 2, correction=chain(1 + sp.cos(x) ** 2, 2 - sp.sin(x) ** 2))
    assert (wrong.verdict, wrong.correction_verdict) == ("refuted", "holds")
    worse = verdict_of(sp.sin(x) ** 2, 1 + sp.cos(x) ** 2, correction=chain(1 + sp.cos(x) ** 2, sp.sin(x) ** 2))
    assert (worse.verdict, worse.correction_verdict) == ("refuted", "refuted")


def test_a_condition_is_used_only_where_it_is_needed() -> None:
    needed = verdict_of(x * n, x, given={n: sp.Integer(1)}, condition="one of them")
    assert (needed.verdict, needed.condition) == ("holds-if", "n = 1 (one of them)")
    idle = verdict_of(x * n, n * x, given={n: sp.Integer(1)})
    assert (idle.verdict, idle.condition) == ("holds", None)
    useless = verdict_of(x * n, y, given={n: sp.Integer(1)})
    assert (useless.verdict, useless.condition) == ("refuted", None)


def test_an_order_is_found_and_held_to_what_is_claimed() -> None:
    cosine = Relation(1 - x**2 / 2, sp.cos(x), x, 2)
    assert (judge(Statement("5.01", (cosine,))).verdict, judge(Statement("5.01", (cosine,))).order) == (
        "holds-to-order",
        3,
    )
    too_much = Relation(1 - x**2 / 2, sp.cos(x), x, 4)
    refused = judge(Statement("5.01", (too_much,)))
    assert (refused.verdict, refused.order) == ("refuted", 3)
    assert any("order 4" in line for line in refused.evidence)


def test_the_weakest_relation_decides() -> None:
    good, close, bad = Relation(x, x), Relation(x, sp.sin(x), x, 2), Relation(x, -x)
    assert judge(Statement("5.01", (good, close))).verdict == "holds-to-order"
    assert judge(Statement("5.01", (good, close, bad))).verdict == "refuted"


def test_what_lies_outside_the_class_is_undecided_not_true() -> None:
    f = sp.Function("f")
    open_question = verdict_of(f(x) ** 2, f(x))
    assert open_question.verdict == "undecided"
    assert open_question.evidence


def test_matrices_are_judged_entry_by_entry() -> None:
    turn = sp.Matrix([[sp.cos(x), -sp.sin(x)], [sp.sin(x), sp.cos(x)]])
    assert verdict_of(turn * turn.T, sp.eye(2)).verdict == "holds"
    assert verdict_of(turn * turn, sp.eye(2)).verdict == "refuted"


def test_errors_are_followed_to_the_results() -> None:
    bad = (Relation(x, -x),)
    root = Statement("5.14", bad)
    result = Statement("5.15", bad, depends_on=("5.14",))
    sound = Statement("5.15", (Relation(x, x),), depends_on=("5.14",))
    reached = {v.id: v.reaches_result for v in follow_errors([judge(root), judge(result)])}
    assert reached == {"5.14": True, "5.15": True}
    stopped = {v.id: v.reaches_result for v in follow_errors([judge(root), judge(sound)])}
    assert stopped == {"5.14": False, "5.15": None}


def test_a_record_has_the_promised_keys() -> None:
    keys = "id section title printed derived verdict condition order small domain correction correction_verdict"
    keys += " depends_on reaches_result evidence seconds"
    assert list(record(verdict_of(x, x))) == keys.split()


def test_a_verdict_is_shown_with_what_it_rests_on() -> None:
    held = verdict_of(x * n, x, given={n: sp.Integer(1)}, condition="a < b", evidence=("c & <d>",))._repr_html_()
    assert "5.01: " in held
    assert "holds-if<br>n = 1 (a &lt; b)" in held
    assert "c &amp; &lt;d&gt;" in held
    assert "the correction" not in held
    near = judge(Statement("5.01", (Relation(1 - x**2 / 2, sp.cos(x), x, 2),)))._repr_html_()
    assert "holds-to-order<br>through order 3 in x" in near
