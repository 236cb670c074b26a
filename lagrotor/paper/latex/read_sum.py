"""Sums, products and limits with what they run over."""

from itertools import pairwise

from lagrotor.paper.latex.boxes import BIG, Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_integral import read_integral
from lagrotor.paper.latex.read_scripts import letter_of
from lagrotor.paper.latex.read_statements import read_set
from lagrotor.paper.latex.rows import all_boxes, strip, without_thin
from lagrotor.paper.latex.tree import CONDITIONS, Call, Letter, Node
from lagrotor.paper.latex.usage import arguments

_UNREAD = "the condition of the sum is not read", "write \\sum_{i=1}^{n}"


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
    reader.bound += (bound := [each.name for each in all_boxes(below) if each.name in ("i", "j") and not each.primes])
    try:
        if not relations and box.sup is None:
            return _over_all(reader, box, below)
        if len(relations) == 1 and below[relations[0]].name == "=":
            return _from_first(reader, box, below, relations[0])
        if box.sup is not None and len(relations) > 1:  # j = 1, j \ne i
            first, *others = [strip(part) for part in arguments(below)]
            if len(first) > 2 and first[1].name == "=" and not any(b.name == "=" for part in others for b in part):
                return [*_from_first(reader, box, first, 1), *_where(reader, others)]
        if box.sup is None and relations:
            return _where(reader, [strip(part) for part in arguments(below)])
    finally:
        del reader.bound[len(reader.bound) - len(bound) :]
    if [b.kind for b in below] == ["letter"] and box.sup is not None:  # \sum_k^N
        return [letter_of(reader, below[0])[0], Letter("first"), reader.expression(box.sup)]
    raise FormulaError(below[0].at, *_UNREAD)


def _over_all(reader: FormulaReader, box: Box, below: list[Box]) -> list[Node]:
    """Indices that take all their values, a word, or the pairs ⟨ij⟩."""
    parts = [strip(part) for part in arguments(below)]
    if any(b.kind == "bracket" for b in below):
        return _where(reader, parts)
    if all(b.kind in ("letter", "comma") for b in below):
        if len(parts) == 1 and len({b.name for b in below}) < len(below):
            raise left_open(box, "words or indices stand below", "write commas between indices")
        letters = [letter_of(reader, b)[0] for b in below if b.kind == "letter"]
        return letters if len(letters) == 1 else [letters[0], Letter("all"), Letter("all"), *letters[1:]]
    if len(below) == 1 and below[0].kind == "text" and below[0].name.isalpha():
        return [Letter(f"all_{below[0].name}")]
    raise FormulaError(box.at, "what the sum runs over is not clear", "write \\sum_{i=1}^{n}")


def _from_first(reader: FormulaReader, box: Box, below: list[Box], sign: int) -> list[Node]:
    """From the first value on, i = 1 and i, j = 1, or each of a list, i = 1, 2, 3."""
    names = [strip(part) for part in arguments(below[:sign])]
    values = [strip(part) for part in arguments(below[sign + 1 :])]
    if not all([b.kind for b in part] == ["letter"] for part in names):
        raise FormulaError(below[0].at, *_UNREAD)
    letters = [letter_of(reader, part[0])[0] for part in names]
    reader.bound += (bound := [part[0].name for part in names])
    try:
        first, ends = list(map(reader.expression, values)), [reader.expression(box.sup)] if box.sup else []
    finally:
        del reader.bound[len(reader.bound) - len(bound) :]
    if len(values) == 1:
        return [letters[0], first[0], *ends, *letters[1:]]
    if len(names) > 1 or ends:
        raise FormulaError(below[0].at, *_UNREAD)
    return [Call("In", (letters[0], Call("set", tuple(first))))]


def _where(reader: FormulaReader, parts: list[list[Box]]) -> list[Node]:
    """Indices and the conditions on them, parted by commas: i, j, i ≠ j; i < j < k; ⟨ij⟩."""
    letters: list[Node] = []
    conditions: list[Node] = []
    for part in parts:
        signs = [k for k, b in enumerate(part) if b.kind == "relation"]
        if [b.kind for b in part] == ["letter"]:
            letters.append(letter_of(reader, part[0])[0])
        elif [b.name for b in part] == [r"\langle"] and all(b.kind in ("letter", "comma") for b in part[0].parts[0]):
            pair = [letter_of(reader, b)[0] for b in part[0].parts[0] if b.kind == "letter"]
            conditions.append(Call("pairs", tuple(pair)))
        elif signs and all(part[k].name in CONDITIONS for k in signs):
            sides = [read_set(reader, part[a + 1 : b]) for a, b in pairwise([-1, *signs, len(part)])]
            conditions += [Call(CONDITIONS[part[k].name], two) for k, two in zip(signs, pairwise(sides), strict=True)]
        else:
            at = part[0].at if part else parts[0][0].at
            raise FormulaError(at, *_UNREAD)
    if letters:
        return [letters[0], Letter("all"), Letter("all"), *letters[1:], *conditions]
    return conditions if len(conditions) == 1 else [Call("And", tuple(conditions))]


def _limit(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    below = without_thin(box.sub or [])
    arrows = [k for k, b in enumerate(below) if b.kind == "relation" and b.name == "->"]
    if len(arrows) != 1:
        raise FormulaError(box.at, "where the limit is taken is missing", "write \\lim_{x\\to 0}")
    variable, value = reader.expression(below[: arrows[0]]), reader.expression(below[arrows[0] + 1 :])
    return Call("limit", (reader.term(strip(row[place + 1 :])), variable, value)), len(row)
