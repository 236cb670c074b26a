"""Long formulas in lines: widths estimated in em, breaks before relations and signs, outermost brackets first."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element, tostring

from lagrotor.report.formulas.mathml_layout import RELATIONS, SIGNS, bracketed, core, join, leaf, row

# A line of the page in em of its mathematics.
WIDTH = 36.0
_INDENT = 1.5
# A bracket is opened when it takes more than this share of a line; a break inside it costs that much room in em.
_OPENED = 0.5
_COST = 12.0
_HIGH = "2.2em"
_SCRIPT = 0.72
_CELL = 0.8  # padding left and right of a table's cell


def math(items: list[Element], display: bool) -> str:
    """The items of a row as a `<math>` element; on a line of its own it is broken where it is too long."""
    # One row inside, for Firefox would wrap the items of the outermost one.
    inside = [row(_fitted(items, WIDTH) if display else items)]
    element = join("math", inside, display="block") if display else join("math", inside)
    return tostring(element, encoding="unicode")


def width(element: Element) -> float:
    """About how wide a browser draws an element, in em."""
    tag, text = element.tag, element.text or ""
    if tag == "mspace":
        number, unit = re.findall(r"^(-?[\d.]+)(.*)", element.get("width", "0"))[0]
        return float(number) * (1.0 if unit in ("em", "") else 0.1)
    if tag == "mo":
        return _operator(text, element.get("form"))
    if tag in ("mi", "mn", "mtext"):
        return sum(map(_letter, text))
    if tag in ("msub", "msup"):
        return width(element[0]) + _SCRIPT * width(element[1])
    if tag == "msubsup":
        return width(element[0]) + _SCRIPT * max(width(element[1]), width(element[2]))
    if tag in ("mover", "munder", "munderover"):
        return max(width(element[0]), *(_SCRIPT * width(part) for part in element[1:]))
    if tag == "mfrac":
        return 0.2 + max(map(width, element)) * (_SCRIPT if element.get("displaystyle") == "false" else 1)
    if tag == "mtable":
        columns = zip(*element, strict=False)
        return sum(_CELL + max(map(width, column)) for column in columns)
    return (0.9 if tag == "msqrt" else 0.0) + sum(map(width, element))


def _letter(character: str) -> float:
    return 0.25 if character in ".,:;'\u00a0 ijl" else 0.75 if character.isupper() or character in "ωmw" else 0.52


def _operator(text: str, form: str | None) -> float:
    if text in RELATIONS or (text in SIGNS and form == "infix") or text in ("×", "⋅", "·", "∗"):
        return 1.25 if text not in "⋅·" else 0.7
    return 0.75 if text in SIGNS else 1.4 if text == "∑" else 0.4


@dataclass(frozen=True)
class _Token:
    """An item of a row whose wide brackets are opened; `rank` is what a break before it costs, None where none may be."""

    element: Element
    depth: int
    rank: int | None


def _tokens(items: list[Element], limit: float, depth: int = 0) -> Iterator[_Token]:
    for item in items:
        inner = core(item)
        if bracketed(inner) and width(item) > _OPENED * limit and not _is_matrix(inner):
            for end in (inner[0], core(inner[-1])):
                if end.get("stretchy") == "true":  # the two now stand on lines of their own: one size for both
                    end.set("minsize", _HIGH)
                    end.set("maxsize", _HIGH)
            yield _Token(inner[0], depth, None)
            yield from _tokens(list(inner[1:-1]), limit, depth + 1)
            yield _Token(_closed(item, inner), depth, None)
        else:
            yield _Token(_narrow(item, limit), depth, _rank(item, depth))


def _rank(item: Element, depth: int) -> int | None:
    if item.tag != "mo":
        return None
    if item.text in RELATIONS:
        return depth
    return depth + 1 if item.text in SIGNS and item.get("form") == "infix" else None


def _closed(item: Element, inner: Element) -> Element:
    """The closing bracket of a row, with the scripts that the row has."""
    return inner[-1] if item is inner else join(item.tag, (_closed(item[0], inner), *item[1:]))


def _is_matrix(inner: Element) -> bool:
    return len(inner) == 3 and inner[1].tag == "mtable"


def _narrow(item: Element, limit: float) -> Element:
    """An item that is too wide with its parts broken: a matrix, numerator and denominator, a root's inside."""
    if width(item) <= limit:
        return item
    if _is_matrix(item):
        return _elements(item, limit) if len(item[1][0]) > 1 else _vector(item, limit)
    if item.tag in ("mfrac", "msqrt"):
        item[:] = [row(_fitted(_items(part), limit)) for part in item]
    return item


def _vector(matrix: Element, limit: float) -> Element:
    """A column with each component broken into lines."""
    left, table, right = matrix
    components = [join("mtr", [_cell(_fitted([*line[0]], limit - 2 * _CELL))]) for line in table]
    return join("mrow", (left, join("mtable", components, displaystyle="true"), right))


def _elements(matrix: Element, limit: float) -> Element:
    """A matrix as a list of its elements, each with its row and column as an index."""
    lines = []
    for i, line in enumerate(matrix[1], 1):
        for j, cell in enumerate(line, 1):
            dot = join("mrow", (matrix[0], leaf("mo", "⋅", lspace="0", rspace="0"), matrix[2]))
            name = [join("msub", (dot, leaf("mn", f"{i}{j}"))), leaf("mo", "=")]
            lines.append(join("mtr", [_cell([*name, *_fitted([*cell], limit - 4.0)])]))
    return join("mtable", lines, displaystyle="true")


def _items(element: Element) -> list[Element]:
    return [*element] if element.tag == "mrow" and not bracketed(element) else [element]


def _fitted(items: list[Element], limit: float) -> list[Element]:
    """The items as they are where they fit, otherwise one table with a line a row."""
    items = [part for item in items for part in _items(item)]
    if sum(map(width, items)) <= limit:
        return [item for item, after in zip(items, [*items[1:], None], strict=True) if not _breaks_source(item, after)]
    lines: list[list[Element]] = []
    for part in _parts(items):
        goes_on = bool(lines) and part[0].text in RELATIONS
        lines += _lines(list(_tokens(part, limit - _INDENT)), limit, _INDENT if goes_on else 0.0)
    if len(lines) == 1:
        return lines[0]
    return [join("mtable", (join("mtr", [_cell(line)]) for line in lines), displaystyle="true")]


def _parts(items: list[Element]) -> Iterator[list[Element]]:
    """The formulas that wide spaces, or spaces after a comma, part; and where the source begins a line with `=`."""
    part: list[Element] = []
    for item in items:
        wide = item.tag == "mspace" and width(item) >= (0.2 if part and part[-1].text in (",", ";", ".") else 1.0)
        if wide and part:
            yield part
            part = []
        elif not wide:
            part.append(item)
    if part:
        yield part


def _breaks_source(item: Element, after: Element | None) -> bool:
    """Whether a wide space marks the end of a line in the source, before a relation."""
    return item.tag == "mspace" and width(item) >= 1.0 and after is not None and after.text in RELATIONS


def _cell(line: list[Element]) -> Element:
    return join("mtd", [row(line)], style="text-align: left; padding-left: 0")


def _lines(tokens: list[_Token], limit: float, indent: float) -> Iterator[list[Element]]:
    start = 0
    while start < len(tokens):
        end = _end(tokens, start, limit - indent)
        line = [token.element for token in tokens[start:end]]
        yield [join("mspace", (), width=f"{indent:g}em"), *line] if indent else line
        if end < len(tokens):
            indent = _INDENT * (1 + 0.5 * tokens[end].depth)
        start = end


def _end(tokens: list[_Token], start: int, room: float) -> int:
    """Where the line that begins at `start` ends: the cheapest break that leaves it neither too long nor too short."""
    used = 0.0
    breaks: list[tuple[float, int]] = []
    for i in range(start, len(tokens)):
        rank = tokens[i].rank
        if i > start and rank is not None:
            if used > room and breaks:
                break
            breaks.append((used - _COST * rank, i))
        used += width(tokens[i].element)
    return len(tokens) if used <= room or not breaks else max(breaks)[1]
