"""Lines that nothing was tuned against: none is wrong, few are undecided. Each sheet was drawn after the last was judged."""

from functools import cache

import pytest
import sympy as sp

from lagrotor.paper import judge

SHEETS = ("first", "second", "third")
Row = tuple[sp.Expr, sp.Expr, sp.Expr]


@cache
def rows_of(sheet: str) -> list[Row]:
    """Some of the lines take sympy long to write down: not before they are judged."""
    from tests.algebra import fresh_lines

    return getattr(fresh_lines, sheet.upper())


def judged(rows: list[Row]) -> dict[str, list[str]]:
    """Lines that are wrong, and lines that are undecided; a near miss that is true on a branch is told with its branch."""
    found: dict[str, list[str]] = {"wrong": [], "undecided": []}
    for left, right, miss in rows:
        for other, true in ((right, True), (miss, False)):
            verdict = judge(left, other)
            if verdict.verdict == "undecided":
                found["undecided"].append(f"{left} = {other}")
            elif (verdict.verdict in ("holds", "holds-if")) != true and not (
                verdict.verdict == "holds-if" and verdict.premises
            ):
                found["wrong"].append(f"{left} = {other}: {verdict.verdict}")
    return found


@pytest.mark.parametrize("sheet", SHEETS)
def test_a_part_of_each_sheet(sheet: str) -> None:
    assert judged(rows_of(sheet)[::12]) == {"wrong": [], "undecided": []}


@pytest.mark.slow
@pytest.mark.parametrize("sheet", SHEETS)
def test_of_a_whole_sheet_none_is_wrong_and_at_most_three_in_a_hundred_are_undecided(sheet: str) -> None:
    found = judged(rows_of(sheet))
    assert found["wrong"] == []
    assert len(found["undecided"]) <= 0.03 * 2 * len(rows_of(sheet)), found["undecided"]


def test_few_lines_of_the_sheets_stand_in_the_table_too() -> None:
    from tests.algebra import textbook

    known = {f"{left} = {right}" for rows in textbook.SUBJECTS.values() for left, right, _ in rows}
    drawn = [f"{left} = {right}" for sheet in SHEETS for left, right, _ in rows_of(sheet)]
    assert len(drawn) == 259 and len(set(drawn) & known) <= 40, sorted(set(drawn) & known)


@pytest.mark.parametrize(
    ("body", "low", "value"),
    [
        (lambda i: 1 / (i * (i + 1)), 1, 1),
        (lambda i: i * sp.Rational(1, 2) ** i, 1, 2),
        (lambda i: 1 / i**6, 1, sp.pi**6 / 945),
        (
            lambda i: sp.Symbol("x", real=True) ** (2 * i + 1) / sp.factorial(2 * i + 1),
            0,
            sp.sinh(sp.Symbol("x", real=True)),
        ),
    ],
)
def test_a_series_has_its_value_and_no_other(body: object, low: int, value: sp.Expr) -> None:
    i = sp.Symbol("i", integer=True)
    series = sp.Sum(body(i), (i, low, sp.oo))  # type: ignore[operator]
    assert judge(series, value).verdict == "holds"
    assert judge(series, value + sp.Rational(1, 10**20)).verdict == "refuted"


@pytest.mark.parametrize("body", [lambda i: 1 / i, lambda i: 2**i, lambda i: sp.S.NegativeOne**i, lambda i: i])
def test_a_series_that_diverges_has_no_value(body: object) -> None:
    i = sp.Symbol("i", integer=True)
    for value in (0, 1, sp.Rational(1, 2), -1):
        assert judge(sp.Sum(body(i), (i, 1, sp.oo)), value).verdict == "undecided"  # type: ignore[operator]
