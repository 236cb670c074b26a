"""Rows of boxes: their ends, their bars in pairs, and what a box in them is."""

import re
from itertools import pairwise

from lagrotor.paper.latex.boxes import Box, FormulaError

_NAMES = (
    "sin cos tan exp log ln det max min lim cot sinh cosh tanh arctan mat Mat vect Vect car dim ker Ker Hom End Aut rang grad "
    "div rot curl Id id tr Tr diag span rank const cst sgn ord deg eff tot kin pot var cov err"
)
_WORDS = frozenset(_NAMES.split())
VARIABLES = frozenset(["x", "y", "z", "t", "r", "s", "xi", "eta", "theta", "phi", "varphi", "rho", "u", "v"])
TENSOR = ("mu", "nu", "rho", "sigma", "kappa", "lambda", "tau")
_UNIT_NAMES = (
    "m s g kg K N J W V A C F H T Pa Hz rad sr mol cd eV keV MeV GeV cm mm nm km min h ms ns yr pc kHz MHz GHz THz kPa "
    "MPa GPa kN kJ kW MW mV kV mA nF pF mH mT l L deg degrees Ohm ohm Nm fm fs ps µs "
    "µm um pm barn mb"
)
UNITS = frozenset(_UNIT_NAMES.split())
DEGREES = frozenset(("circ", "degree", "o"))  # above a number
# What parts statements, and what ends a product.
PARTING = ("relation", "comma", "wide", "text", "arrow")
ENDING = ("operator", *PARTING)
# What a derivative is taken by, behind its sign.
DIVISORS = ("letter", "group", "bracket", "partial")


def strip(row: list[Box]) -> list[Box]:
    """Without spaces and marks of punctuation at its ends."""
    start, end = 0, len(row)
    while start < end and row[start].kind in ("thin", "wide"):
        start += 1
    while end > start and row[end - 1].kind in ("thin", "wide", "comma"):
        end -= 1
    return row[start:end]


def parted(row: list[Box], *kinds: str, but: str = "") -> list[list[Box]]:
    """What stands between the boxes of these kinds, but those of a name."""
    ends = [-1, *(k for k, box in enumerate(row) if box.kind in kinds and (not but or box.name != but)), len(row)]
    return [row[first + 1 : last] for first, last in pairwise(ends)]


def is_related(row: list[Box]) -> bool:
    """Whether a relation stands in a row."""
    return any(box.kind == "relation" for box in row)


def all_boxes(row: list[Box]) -> list[Box]:
    """The boxes of a row and all that they hold."""
    found: list[Box] = []
    rows = [iter(row)]
    while rows:
        for box in rows[-1]:
            found.append(box)
            if box.parts or box.sub or box.sup:
                held = [*box.parts, *(script for script in (box.sub, box.sup) if script)]
                rows += [iter(each) for each in held[::-1]]
                break
        else:
            rows.pop()
    return found


def letters_in_row(row: list[Box]) -> set[str]:
    """The names of the letters of a row and of all that it holds."""
    return {box.name for box in all_boxes(row) if box.kind == "letter"}


def without_thin(row: list[Box]) -> list[Box]:
    """Without thin spaces; the row itself, not to be changed, where it has none."""
    for box in row:
        if box.kind == "thin":
            return [each for each in row if each.kind != "thin"]
    return row


def pair_bars(row: list[Box]) -> list[Box]:
    """Bars in pairs as brackets. Raises FormulaError where they can be paired in two ways."""
    row = _with_places(row)
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
        apart = strip(between) and not any(x.kind in ("operator", "relation") for x in between)
        inner, scripted = strip(row[a + 1 : b]), row[a].sup is not None or row[a].sub is not None
        if apart or scripted or not inner or inner[-1].kind == "operator" or row[a].name != row[b].name:
            raise FormulaError(row[a].at, "how the bars belong together is open", "write \\left| and \\right|")
        sign = r"\|" if row[a].name == "||" else "|"
        closed = Box("bracket", sign, row[a].at, row[b].end, [inner], sub=row[b].sub, sup=row[b].sup, closing=sign)
        made += [*row[last:a], closed]
        last = b + 1
    return [*made, *row[last:]]


def _with_places(row: list[Box]) -> list[Box]:
    """A bar with an equation below it as the bracket that it closes, of what stands just before it."""
    if all(box.kind != "bar" for box in row):
        return row
    single = sum(box.kind == "bar" for box in row) == 1
    made: list[Box] = []
    for box in row:
        below = box.kind == "bar" and box.sub and (single or any(each.kind == "relation" for each in box.sub))
        start = len(made) - 1
        if start > 0 and made[start].kind == "bracket" and made[start - 1].kind == "letter":
            start -= 1  # f(x)|_{x = 0}
        if below and start >= 0 and made[start].kind in ("letter", "fraction", "bracket", "root"):
            made[start:] = [
                Box("bracket", ".", made[start].at, box.end, [made[start:]], sub=box.sub, sup=box.sup, closing="|")
            ]
        else:
            made.append(box)
    return made


def fold_derivatives(row: list[Box], plain: bool) -> list[Box]:
    """d^2x/dt^2 and ∂f/∂x as fractions; plain: whether an italic d is no letter of the paper."""
    if all(box.name != "/" for box in row):
        return row
    made: list[Box] = []
    place = 0
    while place < len(row):
        box, end = row[place], place + 1
        while (
            box.name == "/"
            and end + 1 < len(row)
            and _is_mark(row[end], plain)
            and row[end + 1].kind in ("letter", "group")
        ):
            end += 2
        longest = 3 if made and made[-1].kind == "bracket" else 2  # d f(x)
        marks = [k for k, each in enumerate(made[-longest:], len(made) - longest) if k >= 0 and _is_mark(each, plain)]
        if end > place + 1 and marks and made[marks[-1]].kind == row[place + 1].kind:
            start = marks[-1]
            made[start:] = [Box("fraction", "", made[start].at, row[end - 1].end, [made[start:], row[place + 1 : end]])]
            place = end
        else:
            made.append(box)
            place += 1
    return made


def _is_mark(box: Box, plain: bool) -> bool:
    return is_d(box, "partial") or (is_d(box, "d") and (plain or box.upright))


def is_d(box: Box, mark: str) -> bool:
    if mark == "partial":
        return box.kind == "partial" and box.sub is None
    return box.kind == "letter" and box.name == mark and not box.marks and box.sub is None


def is_measure(box: Box) -> bool:
    r"""Whether a letter is the measure of an integral over functions, \\mathcal{D}q."""
    return box.kind == "letter" and box.name == "D" and box.style in ("cal", "scr") and not (box.sub or box.sup)


def derivative_mark(box: Box) -> str:
    """d, partial, D or delta where a fraction is a derivative; nothing where it is none."""
    over, under = (without_thin(part) for part in box.parts)
    if not over or len(under) < 2:
        return ""
    for mark in ("d", "partial", "D", "delta"):
        below = DIVISORS if mark in ("partial", "delta") else ("letter", "group")
        if is_d(over[0], mark) and is_d(under[0], mark) and under[1].kind in below:
            if mark == "D" and len(over) == 1:
                continue
            return mark
    return ""


def has_differential_above(box: Box) -> bool:
    """Whether a fraction has the differential of an integral above."""
    d = box.kind == "fraction" and any(b.kind == "letter" and b.name == "d" for b in box.parts[0])
    return d and not derivative_mark(box)


def ends_integral(box: Box) -> bool:
    """Whether a box may be an integral's differential, or holds it above a fraction bar."""
    return has_differential_above(box) or is_d(box, "d") or is_measure(box)


def is_derivative_operator(box: Box) -> bool:
    """Whether a fraction is d/dx with nothing above."""
    return bool(derivative_mark(box)) and len(without_thin(box.parts[0])) == 1


def is_moving(box: Box) -> bool:
    """Whether a box is a velocity or a vector, which no argument of a sine has as a second factor."""
    if box.kind == "letter":
        return any(mark.endswith("dot") or mark in ("vec", "hat") for mark in box.marks) or box.style == "bold"
    return box.kind == "fraction" and bool(derivative_mark(box))


def is_unit_like(text: str) -> bool:
    """Whether a text is a unit: km, m/s^2."""
    words = re.sub(r"[\^{}\d\-~.·]", " ", text.replace("/", " ")).split()
    return bool(words) and all(word in UNITS for word in words)


def ends_with_bracket(part: list[Box]) -> bool:
    return bool(part) and part[-1].kind == "bracket"


def refuse_words(row: list[Box]) -> None:
    """Raise FormulaError where letters in a row are a word, const or sin, and no product."""
    run = ""
    for box in [*row, Box("thin", "", 0, 0)]:
        plain = box.kind == "letter" and len(box.name) == 1 and not box.style and not box.marks and not box.upright
        if plain:
            run += box.name
        if not plain or box.sub is not None or box.sup is not None or box.primes:
            if len(run) > 4 or run in _WORDS or re.fullmatch("[A-Z][aeiou][a-z]+", run):
                why = f"{run} is a word"
                raise FormulaError(box.at or row[0].at, why, "write \\text{…} for words, and \\sin for functions")
            run = ""
