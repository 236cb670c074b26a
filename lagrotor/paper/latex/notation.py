r"""The notation of a paper: the kinds that its author declares for symbols, and the kinds that its formulas suggest.

Every symbol outside the table is a real number. A name is written as in a reading, without its index: `theta` for
\theta, `rbold` for \mathbf r, `rvec` for \vec r; the name `r` alone covers all three.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from itertools import combinations, pairwise
from typing import Any

from lagrotor.errors import InputError
from lagrotor.paper.latex.boxes import Box, FormulaError, all_boxes, boxes, is_printed_as_vector, stem_of


@dataclass(frozen=True)
class Notation:
    """The symbols of a paper by their kind; every symbol outside these sets is a real number.

    numbers: those of e, i and j that stand for Euler's number and the imaginary unit. real: symbols that the author
    declares as real numbers although the formulas suggest another kind. proposed: symbols that only the formulas suggest
    as functions; a bracket after one is its argument only if that is evident. decimal_comma: True if 1{,}234 is decimal.
    """

    functions: frozenset[str] = frozenset()
    vectors: frozenset[str] = frozenset()
    matrices: frozenset[str] = frozenset()
    operators: frozenset[str] = frozenset()
    indices: frozenset[str] = frozenset()
    positive: frozenset[str] = frozenset()
    numbers: frozenset[str] = frozenset()
    real: frozenset[str] = frozenset()
    decimal_comma: bool = False
    proposed: frozenset[str] = frozenset()


# Keys of the table that list symbols; groups of kinds that exclude each other.
KINDS = tuple(key.name for key in fields(Notation) if key.name not in ("decimal_comma", "proposed"))
_EXCLUSIVE = (
    ("real", "functions", "vectors", "matrices", "operators", "indices", "numbers"),
    ("vectors", "matrices", "operators", "indices", "positive", "numbers"),
)


def declared_notation(table: Mapping[str, Any], where: str = "paper.toml") -> Notation:
    """Return the notation that a table {kind: names, separated by spaces} declares.

    Raise InputError, which names the file `where`, for an unknown key, a value of the wrong type, and a symbol of two kinds that
    exclude each other.
    """
    keys = (*KINDS, "decimal_comma")
    if unknown := sorted(table.keys() - set(keys)):
        raise InputError(f"{where}: notation: {unknown[0]!r} is not a key: the keys are {', '.join(keys)}")
    names: dict[str, frozenset[str]] = {}
    for kind in KINDS:
        value = table.get(kind, "")
        if not isinstance(value, str):
            raise InputError(f'{where}: notation: {kind} is not text: write {kind} = "f V", names separated by spaces')
        names[kind] = frozenset(map(_name, value.replace(",", " ").split()))
    comma = table.get("decimal_comma", False)
    if not isinstance(comma, bool):
        raise InputError(f"{where}: notation: decimal_comma is {comma!r}: write true or false")
    for kinds in _EXCLUSIVE:
        for first, second in combinations(kinds, 2):
            if both := sorted(names[first] & names[second]):
                raise InputError(f"{where}: notation: {both[0]} is in {first} and in {second}: keep one of them")
    return Notation(**names, decimal_comma=comma)


def _name(word: str) -> str:
    r"""Return the name by which readings call a symbol: \theta gives theta, lambda gives lamda."""
    word = word.removeprefix("\\")
    return "lamda" if word == "lambda" else word


@dataclass(frozen=True)
class Proposal:
    """The kind that a formula suggests for a symbol; `evidence` is this formula in LaTeX."""

    kind: str
    symbol: str
    evidence: str


def with_proposals(notation: Notation, proposals: Iterable[Proposal]) -> Notation:
    """Return the notation, extended by the proposals for symbols that the author has not declared."""
    declared = {kind: getattr(notation, kind) for kind in KINDS}
    settled = frozenset[str]().union(*declared.values())
    free = [p for p in proposals if p.symbol not in settled]
    extended: dict[str, Any] = {kind: declared[kind] | {p.symbol for p in free if p.kind == kind} for kind in KINDS}
    return replace(notation, proposed=extended["functions"] - declared["functions"], **extended)


def propose(formulas: Iterable[str]) -> tuple[Proposal, ...]:
    """Return the kinds that formulas in LaTeX suggest for their symbols, each with the first formula that suggests it.

    A symbol before an argument in brackets is a function. A symbol in bold or with an arrow is a vector, or a matrix if it
    multiplies another or is transposed. The symbol below a sum is an index. An e whose power has symbols is Euler's number,
    and an i in that power is the imaginary unit. Both remain symbols if they also occur as such elsewhere.
    """
    sources: dict[tuple[str, str], str] = {}
    for latex in formulas:
        try:
            row = boxes(latex)
        except (FormulaError, RecursionError):
            continue
        evidence = [*_evidence(row)]
        if any(kind in ("vectors", "matrices") for kind, _ in evidence):  # \vec E = E\hat r
            hats = (box for box in all_boxes(row) if "hat" in box.marks and box.name.islower())
            evidence += [("vectors", stem_of(box)) for box in hats]
        for kind, letter in evidence:
            sources.setdefault((kind, letter), latex)
    for letter in ("e", "i", "j"):  # a charge e as well as an exponential, an index i as well as an imaginary unit
        if ("letters", letter) in sources:
            sources.pop(("numbers", letter), None)
    for kind, letter in [*sources]:
        if kind == "vectors" and ("matrices", letter) in sources:
            del sources[kind, letter]
    return tuple(Proposal(kind, letter, latex) for (kind, letter), latex in sources.items() if kind in KINDS)


def has_kind(notation: Notation, kind: str, box: Box) -> bool:
    """Return True if the notation gives a symbol this kind, under its name with or without font and accents."""
    names = getattr(notation, kind)
    return bool(names) and (stem_of(box) in names or _name(box.name) in names)


def _evidence(row: list[Box]) -> Iterator[tuple[str, str]]:
    """Yield a pair (kind, symbol) for each kind that a row of boxes, or a box inside it, suggests for a symbol."""
    for place, (box, following) in enumerate(pairwise([*row, Box("thin", "", 0, 0)])):
        if box.kind == "letter":
            yield from _of_letter(box, following)
            yield from _of_value(row, place)
        elif box.kind == "function" and box.name in ("det", "tr", "Tr"):
            inside = following.contents[0] if following.kind == "bracket" else [following]
            yield from (("matrices", stem_of(b)) for b in inside if b.kind == "letter" and b.name.isupper())
        elif box.kind == "big" and box.name in ("sum", "prod"):
            below = box.sub or []
            yield from (("indices", stem_of(index)) for index in below[:1] if index.kind == "letter")
        for inner in (*box.contents, box.sub or [], box.sup or []):
            yield from _evidence(inner)


def _of_value(row: list[Box], place: int) -> Iterator[tuple[str, str]]:
    """Yield (kind, symbol) if the symbol at a place of a row is equated to a printed matrix or column."""
    following = [item for item in row[place + 1 : place + 3] if item.kind != "align"]
    if len(following) == 2 and following[0].name in ("=", ":=") and row[place].kind == "letter":
        closed = following[1].kind == "bracket" and following[1].closing != "."
        inside = following[1].contents[0] if closed else following[1:]
        if len(inside) == 1 and inside[0].kind == "matrix" and inside[0].name != "vmatrix":
            columns = max(len(line.contents) for line in inside[0].contents[0])
            yield "matrices" if columns > 1 else "vectors", stem_of(row[place])


def _of_letter(box: Box, following: Box) -> Iterator[tuple[str, str]]:
    """Yield a pair (kind, symbol) for each kind that the print of a symbol and the box after it suggest."""
    power = box.sup or []
    if box.name in ("e", "i", "j") and not (box.marks or box.style or box.primes or box.sub):
        letters = {inner.name for inner in all_boxes(power) if inner.kind == "letter"}
        if box.name == "e" and letters:
            yield "numbers", "e"
            yield from (("numbers", unit) for unit in ("i", "j") if unit in letters and len(power) > 1)
        elif box.name == "e":
            yield "letters", "e"
        elif following.name == "hbar":
            yield "numbers", box.name
    if is_printed_as_vector(box):
        transposed = [inner.name for inner in power] in (["T"], ["top"], ["intercal"])
        acts = box.name.isupper() and following.kind == "letter" and is_printed_as_vector(following)
        yield ("matrices" if box.name.isupper() and (transposed or acts) else "vectors"), stem_of(box)
    if box.name not in ("O", "d") and is_evident_argument(box, following):
        yield "functions", stem_of(box)


def is_evident_argument(box: Box, bracket: Box) -> bool:
    """Return True if the bracket after a symbol must be the argument of a function and cannot be a factor.

    This is so if the bracket holds one symbol other than t, or a list, and neither it nor the symbol has a power.
    """
    if bracket.kind != "bracket" or bracket.name != "(" or bracket.sup or (box.sup and box.sup[0].kind == "number"):
        return False
    content = bracket.contents[0]
    if any(item.kind == "relation" for item in content):
        return False
    single = len(content) == 1 and content[0].kind == "letter" and content[0].name != "t"
    return single or any(item.kind == "comma" for item in content)
