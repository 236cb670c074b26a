"""A verdict is of the equation: letters renamed, sides exchanged, terms moved, both sides multiplied give the same answer."""

import random
import string
from collections.abc import Iterator
from itertools import permutations

import pytest
import sympy as sp
from sympy import log, sqrt

from lagrotor.algebra.numbering import Numbering
from lagrotor.paper import Verdict, judge
from tests.algebra import textbook

x, y, z, v = sp.symbols("x y z v", real=True)
c, omega, zeta = sp.symbols("c omega zeta", real=True)
ROOTS = [
    (c * sqrt(1 - v**2 / c**2), sqrt(c**2 - v**2), sqrt(c**2 + v**2)),
    (omega * sqrt(1 - zeta**2), sqrt(omega**2 - zeta**2 * omega**2), sqrt(omega**2 - 2 * zeta**2 * omega**2)),
    (x * sqrt(1 + y**2), sqrt(x**2 + x**2 * y**2), sqrt(x**2 + x * y**2)),
    (1 / sqrt(1 - v**2 / c**2), c / sqrt(c**2 - v**2), c / sqrt(c**2 + v**2)),
    (2 * sqrt(x - 1), sqrt(4 * x - 4), sqrt(x - 1)),
    (log(x**2 * y), 2 * log(x) + log(y), log(x) + log(y)),
    (log(x**2 - 1), log(x - 1) + log(x + 1), log(x - 1) + log(x + 2)),
    (sqrt((x - 1) * (y - 2)), sqrt(x - 1) * sqrt(y - 2), sqrt(x - 1) * sqrt(y - 1)),
    (sqrt(x * y * z), sqrt(x) * sqrt(y) * sqrt(z), sqrt(x) * sqrt(y) + sqrt(z)),
]
ROWS = [
    *ROOTS,
    *((left, right, miss) for left, right, _, miss in textbook.BRANCHES),
    *(row for rows in textbook.SUBJECTS.values() for row in rows),
]
Sides = tuple[sp.Expr, sp.Expr]


def pairs(row: tuple[sp.Expr, sp.Expr, sp.Expr]) -> Iterator[Sides]:
    """An identity and its near miss, with the letters as they are and with positive ones that are real only."""
    for other in row[1:]:
        sides = sp.sympify(row[0]), sp.sympify(other)
        letters = sides[0].free_symbols | sides[1].free_symbols
        real = {s: sp.Symbol(s.name, real=True) for s in letters if s.is_positive and not s.is_integer}
        if sides[0] != sides[1]:
            yield sides
            if real:
                yield sides[0].xreplace(real), sides[1].xreplace(real)


def renamed(sides: Sides, draw: random.Random) -> tuple[Sides, dict[sp.Symbol, sp.Symbol]]:
    """The sides in letters with other names, and the way back."""
    letters = sorted(sides[0].free_symbols | sides[1].free_symbols, key=str)
    used = {s.name for side in sides for s in side.atoms(sp.Symbol)}
    names = draw.sample(sorted({*string.ascii_letters, "alpha", "omega", "xi_1"} - used - {*"EIOSNCQ"}), len(letters))
    put = {s: sp.Symbol(name, **s.assumptions0) for s, name in zip(letters, names, strict=True)}
    return (sides[0].xreplace(put), sides[1].xreplace(put)), {new: old for old, new in put.items()}


def rewritten(sides: Sides, draw: random.Random) -> Iterator[Sides]:
    """The same equation in other forms."""
    left, right = sides
    yield right, left
    yield left - right, right - right
    yield left - left, right - left
    if not isinstance(left, sp.MatrixBase):
        term = draw.choice(sp.Add.make_args(left) + sp.Add.make_args(right))
        yield left - term, right - term
    for number in (draw.choice((-1, -3, sp.Rational(2, 7))), draw.choice((sqrt(2), -sp.pi, sp.S.Half + sqrt(3)))):
        yield number * left, number * right


def condition(verdict: Verdict) -> frozenset[tuple[sp.Expr, bool]]:
    """The conditions of a verdict up to their form: what is positive, or not negative."""
    found = set()
    for relation in (r for premise in verdict.premises for r in premise.conditions):
        above = sp.factor(relation.gts - relation.lts)
        found.add((sp.expand(above / abs(above.as_coeff_Mul()[0])), isinstance(relation, sp.Gt | sp.Lt)))
    return frozenset(found)


def images(conditions: frozenset[tuple[sp.Expr, bool]], sides: Sides) -> set[frozenset[tuple[sp.Expr, bool]]]:
    """The conditions, and what they become under exchanges of letters that leave the equation as it is."""
    letters = sorted(sides[0].free_symbols | sides[1].free_symbols, key=str)
    found = {conditions}
    for others in permutations(letters) if conditions and len(letters) < 5 else ():
        put = dict(zip(letters, others, strict=True))
        if all(sp.expand(side.xreplace(put) - side) == 0 for side in sides):
            found.add(frozenset((e.xreplace(put), strict) for e, strict in conditions))
    return found


def check(rows: list[tuple[sp.Expr, sp.Expr, sp.Expr]], seed: int) -> int:
    """Hold each equation of the rows to its other forms; return how many there were."""
    draw, count = random.Random(seed), 0
    for sides in (pair for row in rows for pair in pairs(row)):
        first = judge(*sides)
        for _ in range(2):
            other, back = renamed(sides, draw)
            verdict = judge(*other)
            assert verdict.verdict == first.verdict, (sides, other)
            there = frozenset((e.xreplace(back), strict) for e, strict in condition(verdict))
            assert there in images(condition(first), sides), (sides, other)
        for other in rewritten(sides, draw):
            verdict = judge(*other)
            assert verdict.verdict == first.verdict, (sides, other)
            assert condition(verdict) in images(condition(first), sides), (sides, other)
        count += 1
    return count


@pytest.mark.parametrize("rows", [ROOTS[:2], ROOTS[2:5], ROWS[9:25:8], ROWS[25::80]], ids=len)
def test_an_equation_has_one_verdict_in_all_its_forms(rows: list[tuple[sp.Expr, sp.Expr, sp.Expr]]) -> None:
    assert check(rows, 1) > len(rows)


@pytest.mark.slow
@pytest.mark.parametrize("part", range(8))
def test_all_equations_of_the_tests_have_one_verdict_in_all_their_forms(part: int) -> None:
    assert check(ROWS[part::8], part) >= 40


def test_the_forms_differ_and_a_changed_equation_does_not_pass() -> None:
    """The twin of the tests above: another equation is noticed by the verdict or by the condition."""
    first = judge(x * sqrt(y), sqrt(x**2 * y))
    assert condition(judge(-x * sqrt(y), sqrt(x**2 * y))) != condition(first)
    assert judge(2 * x * sqrt(y), sqrt(x**2 * y)).verdict != first.verdict


def test_letters_are_numbered_by_their_places() -> None:
    for row in ROOTS:
        sides = row[0], row[1]
        other, _ = renamed(sides, random.Random(2))
        one, two = Numbering(sides[0] - sides[1]), Numbering(other[0] - other[1])
        assert one.to_numbered(sides[0] - sides[1]) == two.to_numbered(other[0] - other[1])
        assert one.to_input(one.to_numbered(sides[0])) == sides[0]
    assert Numbering(x - y).symbols != Numbering(y - x).symbols
