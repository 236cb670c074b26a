"""Textbook identities hold and their near misses are refuted; a few rows of each subject quickly, all of them slowly."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal, decide_zero
from lagrotor.algebra.enclosures import enclosed_at, excludes_zero
from lagrotor.errors import InputError
from tests.algebra import textbook

ROWS = [(subject, *row) for subject, rows in textbook.SUBJECTS.items() for row in rows]
QUICK = ROWS[::5]
_MOST_UNDECIDED = 3  # per cent


@pytest.mark.parametrize("row", QUICK, ids=lambda row: f"{row[0]}-{str(row[1])[:40]}")
def test_an_identity_holds_and_its_near_miss_is_refuted(row: tuple[str, sp.Expr, sp.Expr, sp.Expr]) -> None:
    _, left, right, miss = row
    assert decide_equal(left, right).answer == "zero"
    refuted = decide_equal(left, miss)
    assert refuted.answer == "nonzero" and refuted.witness is not None


@pytest.mark.slow
@pytest.mark.parametrize("subject", textbook.SUBJECTS)
def test_none_of_a_subject_is_wrong(subject: str) -> None:
    rows = textbook.SUBJECTS[subject]
    holds = [(row[0], row[1], decide_equal(row[0], row[1]).answer) for row in rows]
    misses = [(row[0], row[2], decide_equal(row[0], row[2]).answer) for row in rows]
    assert [row for row in holds if row[2] == "nonzero"] == []
    assert [row for row in misses if row[2] == "zero"] == []
    undecided = [row for row in (*holds, *misses) if row[2] == "undecided"]
    assert 100 * len(undecided) <= _MOST_UNDECIDED * 2 * len(rows), undecided


@pytest.mark.parametrize(("left", "right", "branch", "miss"), textbook.BRANCHES, ids=lambda e: str(e)[:30])
def test_what_holds_on_a_branch_holds_there_and_is_refuted_elsewhere(
    left: sp.Expr, right: sp.Expr, branch: sp.Basic, miss: sp.Expr
) -> None:
    decision = decide_equal(left, right)
    if left - right != 0:
        assert decision.answer == "nonzero" and decision.partly and decision.branch
        assert decide_equal(left, right, assumptions=decision.branch).answer == "zero"
        assert not all(bool(relation.subs(decision.witness)) for relation in decision.branch)
    assert decide_equal(left, miss).answer == "nonzero"
    if not isinstance(branch, sp.And) and isinstance(branch.gts, sp.Symbol):
        assert decide_equal(left, right, assumptions=[branch]).answer == "zero"


def test_the_witness_of_a_refutation_keeps_both_sides_apart() -> None:
    for _, left, _, miss in QUICK:
        decision = decide_equal(left, miss)
        if decision.residual is not None and decision.points:
            assert excludes_zero(enclosed_at(decision.residual, decision.points[0], 60))


def test_an_unknown_function_takes_values_at_the_witness() -> None:
    f, x = sp.Function("f"), sp.Symbol("x", real=True)
    witness = decide_zero(f(x) - f(x).diff(x)).witness
    assert witness is not None and {f(x), f(x).diff(x), x} <= witness.keys()


@pytest.mark.parametrize("within", [["x > 0"], [sp.Eq(sp.Symbol("x"), 1)], [sp.false]])
def test_a_region_is_made_of_inequalities(within: list[object]) -> None:
    with pytest.raises(InputError, match="inequality"):
        decide_zero(sp.Symbol("x"), assumptions=within)


def test_two_letters_of_one_name_are_refused_at_the_door() -> None:
    one, other = sp.Symbol("g"), sp.Symbol("g", positive=True)
    with pytest.raises(InputError, match="two different symbols are called 'g'"):
        decide_equal(sp.sqrt(one**2), other)


def test_the_oracle_of_this_table_is_independent() -> None:
    """A near miss differs by sympy's own evaluation, too, which is not that of the decision."""
    for subject in ("trigonometry", "hyperbolic", "powers", "mechanics"):
        left, right, miss = textbook.SUBJECTS[subject][1]
        point = {letter: sp.Rational(3, 7 + k) for k, letter in enumerate(sorted((left - miss).free_symbols, key=str))}
        assert abs(sp.N((left - right).subs(point), 40)) < 1e-35 < abs(sp.N((left - miss).subs(point), 40))
