"""Sums, products and limits with what they run over."""

from lagrotor.paper.source.boxes import BIG, Box, FormulaError
from lagrotor.paper.source.formula_reader import FormulaReader
from lagrotor.paper.source.read_integral import read_integral
from lagrotor.paper.source.read_scripts import letter_of
from lagrotor.paper.source.rows import strip, without_thin
from lagrotor.paper.source.tree import CONDITIONS, Call, Letter, Node


def read_sum(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    kind = BIG.get(box.name, "")
    if not kind:
        raise FormulaError(box.at, f"\\{box.name} is not read", "write its value")
    if kind == "Integral":
        return read_integral(reader, row, place)
    if kind == "limit":
        return _limit(reader, row, place)
    rest = strip(row[place + 1 :])
    if not rest:
        raise FormulaError(box.at, "the sum has no terms", "write them")
    limits = _limits(reader, box)
    index = limits[0].name if isinstance(limits[0], Letter) else ""
    reader.bound.append(index)
    for extra in limits[3:]:
        reader.bound.append(extra.name if isinstance(extra, Letter) else "")
    inner = reader.term(rest)
    del reader.bound[-(1 + len(limits[3:])) :]
    return Call(kind, (inner, *limits)), len(row)


def _limits(reader: FormulaReader, box: Box) -> list[Node]:
    """The index of a sum and its bounds; the index alone where it runs over all its values."""
    below = without_thin(box.sub or [])
    if not below:
        if box.sup is not None:
            raise FormulaError(box.at, "what the sum runs over is missing", "write its index")
        return [Letter("all")]
    relations = [k for k, b in enumerate(below) if b.kind == "relation"]
    if not relations:
        if all(b.kind in ("letter", "comma") for b in below) and box.sup is None:
            if not any(b.kind == "comma" for b in below) and len({b.name for b in below}) < len(below):
                why = "whether words or indices stand below is open"
                raise FormulaError(box.at, why, "write commas between indices")
            letters = [
                letter_of(reader, b)[0] if b.primes or b.name not in ("i", "j") else Letter(b.name)
                for b in below
                if b.kind == "letter"
            ]
            return letters if len(letters) == 1 else [letters[0], Letter("all"), Letter("all"), *letters[1:]]
        if len(below) == 1 and below[0].kind == "text" and below[0].name.isalpha() and box.sup is None:
            return [Letter(f"all_{below[0].name}")]
        raise FormulaError(box.at, "what the sum runs over is not clear", "write \\sum_{i=1}^{n}")
    if len(relations) == 1 and below[relations[0]].name == "=" and below[0].kind == "letter" and relations[0] == 1:
        name = below[0].name
        reader.bound.append(name)
        start = reader.expression(below[2:])
        ends = [reader.expression(box.sup)] if box.sup is not None else []
        reader.bound.pop()
        return [
            letter_of(reader, below[0])[0] if name not in ("i", "j") or below[0].primes else Letter(name),
            start,
            *ends,
        ]
    if len(relations) == 1 and below[relations[0]].name in CONDITIONS and box.sup is None:
        names = [each for each in below if each.kind == "letter"]
        reader.bound += (bound := [each.name for each in names if each.name in ("i", "j")])
        sides = [reader.expression(part) for part in (below[: relations[0]], below[relations[0] + 1 :])]
        del reader.bound[len(reader.bound) - len(bound) :]
        return [Call(CONDITIONS[below[relations[0]].name], tuple(sides))]
    raise FormulaError(below[0].at, "the condition of the sum is not read", "write \\sum_{i=1}^{n}")


def _limit(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    below = without_thin(box.sub or [])
    arrows = [k for k, b in enumerate(below) if b.kind == "relation" and b.name == "->"]
    if len(arrows) != 1:
        raise FormulaError(box.at, "where the limit is taken is missing", "write \\lim_{x\\to 0}")
    variable, value = reader.expression(below[: arrows[0]]), reader.expression(below[arrows[0] + 1 :])
    return Call("limit", (reader.term(strip(row[place + 1 :])), variable, value)), len(row)
