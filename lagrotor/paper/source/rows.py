"""Rows of boxes: their ends, their bars in pairs, and what a box in them is."""

import re

from lagrotor.paper.source.boxes import Box, FormulaError

_NAMES = (
    "sin cos tan exp log ln det max min lim cot sinh cosh tanh arctan mat Mat vect Vect car dim ker Ker Hom End Aut rang rg grad "
    "div rot curl Id id tr Tr diag span rank const cst sgn ord deg eff tot kin pot"
)
_WORDS = frozenset(_NAMES.split())


def strip(row: list[Box]) -> list[Box]:
    """Without spaces and marks of punctuation at its ends."""
    start, end = 0, len(row)
    while start < end and row[start].kind in ("thin", "wide"):
        start += 1
    while end > start and row[end - 1].kind in ("thin", "wide", "comma"):
        end -= 1
    return row[start:end]


def without_thin(row: list[Box]) -> list[Box]:
    return [box for box in row if box.kind != "thin"]


def pair_bars(row: list[Box]) -> list[Box]:
    """Bars in pairs as brackets. Raises FormulaError where they can be paired in two ways."""
    places = [k for k, box in enumerate(row) if box.kind == "bar"]
    if not places:
        return row
    if len(places) % 2:
        raise FormulaError(row[places[-1]].at, "a bar has no partner", "write \\left| and \\right|")
    made: list[Box] = []
    last = 0
    for n in range(0, len(places), 2):
        a, b = places[n], places[n + 1]
        between = row[places[n - 1] + 1 : a] if n else []
        if n and not any(x.kind in ("operator", "relation") for x in between):
            raise FormulaError(row[a].at, "how the bars belong together is open", "write \\left| and \\right|")
        inner = strip(row[a + 1 : b])
        if (
            not inner
            or inner[-1].kind == "operator"
            or row[a].sup is not None
            or row[a].sub is not None
            or row[a].name != row[b].name
        ):
            raise FormulaError(row[a].at, "how the bars belong together is open", "write \\left| and \\right|")
        sign = r"\|" if row[a].name == "||" else "|"
        closed = Box("bracket", sign, row[a].at, row[b].end, [inner], sub=row[b].sub, sup=row[b].sup, closing=sign)
        made += [*row[last:a], closed]
        last = b + 1
    return [*made, *row[last:]]


def is_d(box: Box, mark: str) -> bool:
    if mark == "partial":
        return box.kind == "partial" and box.sub is None
    return box.kind == "letter" and box.name == mark and not box.marks and box.sub is None


def derivative_mark(box: Box) -> str:
    """d, partial, D or delta where a fraction is a derivative; nothing where it is none."""
    over, under = (without_thin(part) for part in box.parts)
    if not over or len(under) < 2:
        return ""
    for mark in ("d", "partial", "D", "delta"):
        if is_d(over[0], mark) and is_d(under[0], mark) and under[1].kind in ("letter", "group"):
            if mark in ("D", "delta") and len(over) == 1:
                continue
            return mark
    return ""


def has_differential_above(box: Box) -> bool:
    """Whether a fraction has the differential of an integral above."""
    d = box.kind == "fraction" and any(b.kind == "letter" and b.name == "d" for b in box.parts[0])
    return d and not derivative_mark(box)


def is_derivative_operator(box: Box) -> bool:
    """Whether a fraction is d/dx with nothing above."""
    return bool(derivative_mark(box)) and len(without_thin(box.parts[0])) == 1


def is_moving(box: Box) -> bool:
    """Whether a box is a velocity or a vector, which no argument of a sine has as a second factor."""
    if box.kind == "letter":
        return any(mark.endswith("dot") or mark in ("vec", "hat") for mark in box.marks) or box.style == "bold"
    return box.kind == "fraction" and bool(derivative_mark(box))


def is_unit_like(text: str) -> bool:
    return (
        bool(re.fullmatch(r"[A-Za-zµ/^\d{}\s.·~-]{1,12}", text))
        and " and " not in text
        and text not in ("if", "for", "as", "or")
    )


def ends_with_bracket(part: list[Box]) -> bool:
    return bool(part) and part[-1].kind == "bracket"


def refuse_words(row: list[Box]) -> None:
    """Raise FormulaError where letters in a row are a word, const or sin, and no product."""
    run = ""
    for box in [*row, Box("thin", "", 0, 0)]:
        plain = box.kind == "letter" and len(box.name) == 1 and not box.style and not box.marks
        if plain:
            run += box.name
        if not plain or box.sub is not None or box.sup is not None or box.primes:
            if len(run) > 4 or run in _WORDS or re.fullmatch("[A-Z][aeiou][a-z]+", run):
                raise FormulaError(
                    box.at or row[0].at, f"{run} is a word", "write \\text{…} for words, and \\sin for functions"
                )
            run = ""
