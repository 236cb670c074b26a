"""What an index, a mark or a power makes of a letter: a name, or a power of it."""

import re
from dataclasses import replace

from lagrotor.paper.latex.boxes import GREEK, Box, FormulaError, is_printed_as_vector, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.rows import TENSOR, UNITS, VARIABLES, all_boxes, without_thin
from lagrotor.paper.latex.tree import Call, Letter, Node, is_matrix, is_vector, number
from lagrotor.paper.latex.usage import (
    index_of,
    is_number,
    is_plain_letter,
    name_of,
    power_in,
    stem_of,
    upper_index,
)

_SIGNS = {"*": "star", "star": "star", "+": "plus", "-": "minus"}
_BRACKETS = "write brackets around the power"
_INDICES = ("i", "j", "k", "l", "m", "n", "a", "b", "c", "d")
# Letters that are indices.
INDICES = frozenset("abcdefghijklmnopqrsuvwIJKMN") | {name[1:] for name in GREEK if name[1].islower()}
_GREEK = frozenset(name.removeprefix("\\") for name in GREEK) - {"pi", "hbar"}


def stands_alone(reader: FormulaReader, sign: str) -> bool:
    """Whether a sign that may act on what follows it stands in this formula where nothing follows it."""
    ends = (
        r"\s*(?:[-+=<>,.;)|&^_]|\\(?:right|cdot|times|quad|approx|sim|simeq|l?l?eq?|g?geq?|[,;]?\s*\\)(?![A-Za-z])|$)"
    )
    shown = re.sub(r"[dD]\^\{?\d", "", reader.source) if sign == "d" else reader.source
    return re.search(rf"(?<![A-Za-z\\]){re.escape(sign)}(?![A-Za-z]){ends}", shown) is not None


def index_parts(box: Box) -> list[str]:
    found = index_of(box)
    if found is None:
        part = (box.sub or [box])[0]
        raise FormulaError(part.at, "an index is not letters and numbers", "give the letter another index")
    return found


def mark_of(reader: FormulaReader, box: Box) -> list[str] | None:
    """What a superscript adds to the name, where it is a mark or an upper index and no power."""
    row = without_thin(box.sup or [])
    if not row:
        return None
    if len(row) == 1 and row[0].kind == "operator" and row[0].name in _SIGNS:
        return [_SIGNS[row[0].name]]
    if len(row) == 1 and row[0].kind == "bracket" and row[0].name == "(" and len(row[0].parts[0]) == 1:
        inner = row[0].parts[0][0]
        if inner.kind in ("number", "letter") and inner.sup is None and inner.sub is None:
            return [inner.name]
        if inner.kind == "operator" and inner.name in _SIGNS:  # f^{(-)}
            return [_SIGNS[inner.name]]
    if len(row) == 1 and row[0].kind == "text":
        return [row[0].name] if row[0].name.isalnum() else None
    if (
        len(row) == 1
        and _is_plain(row[0])
        and row[0].name not in ("T", "top", "intercal", "prime")
        and not power_in(box)
    ):
        return [row[0].name + row[0].style]
    if len(row) > 1 and all(_is_plain(b) and b.name in TENSOR for b in row):
        return [b.name for b in row]
    if any(b.kind == "comma" for b in row) and all(_is_plain(b) or b.kind in ("number", "comma", "text") for b in row):
        names = [b.name + b.style for b in row if b.kind != "comma"]
        return names if all(name.isalnum() for name in names) else None
    upper = upper_index(reader.notation, box)
    if not upper and _labels_vector(box, row):
        reader.guess("mark", f"the superscript of the vector {box.name} is part of the name")
        return index_of(replace(box, sub=row, sup=None))
    if not upper and _is_raised(reader, box, row):
        reader.guess("mark", f"the superscript of {box.name} is part of the name")
        upper = [b.name for b in row]
    if not upper and len(row) == 2 and row[1].name in ("dagger", "*") and _is_plain(row[0]):  # b^{s\dagger}
        upper = [row[0].name, "star" if row[1].name == "*" else "dagger"]
    return upper if upper and not {*upper} & {*reader.bound} - {*TENSOR} else None


def _labels_vector(box: Box, row: list[Box]) -> bool:
    """Whether what stands above a vector is no power: a number but 2, a step n + 1, a letter."""
    small = is_printed_as_vector(box) and (box.name[0].islower() or "vec" in box.marks)
    kinds = {b.kind for b in row}
    marked = {b.name for b in row} & {"T", "top", "dagger", "intercal", "prime", "*"}
    return small and [b.name for b in row] != ["2"] and kinds <= {"letter", "number", "operator", "fraction"} and not (
        marked or row[0].kind == "operator" or box.name in ("e", "d")
    )  # fmt: skip


def _is_raised(reader: FormulaReader, box: Box, row: list[Box]) -> bool:
    """Whether what stands above a letter are upper indices by what this formula shows."""
    if box.kind != "letter" or box.name in ("e", "d") or not all(map(_is_plain, row)):
        return False
    if reader.above is None:
        reader.above = frozenset(_raised_in(reader.row))
    return {b.name for b in row} <= reader.above - reader.notation.letters


def _raised_in(row: list[Box]) -> set[str]:
    """Letters above others that are no power: they stand in scripts alone, below another letter or as in T^{ab}_c.

    Of a theory of tensors, mu and nu are indices wherever they stand above a letter.
    """
    large, lower, upper = set[str](), list[str](), list[str]()

    def look(part: list[Box]) -> None:
        for box in part:
            if box.kind == "letter":
                large.add(box.name)
            for inner in box.parts:
                look(inner)
            for script, held in ((box.sub, lower), (box.sup, upper)):
                inner = without_thin(script or [])
                indices = box.kind in ("letter", "partial", "nabla") and box.name != "e" and all(
                    b.kind == "comma" or _is_plain(replace(b, primes=0)) for b in inner
                )  # fmt: skip
                if not indices:
                    look(inner)
                else:
                    held += [b.name for b in inner]
                    if held is upper and len(inner) > 1 and box.sub and all(map(_is_plain, box.sub)):  # t^{ab}_{ij}
                        lower.extend(b.name for b in inner)

    look(row)
    greek = {name for name in TENSOR if (upper + lower).count(name) > 1} | {"mu", "nu"}
    return {*upper} & (greek | {*lower} & {*"abcijkpqrs", "alpha", "beta", "gamma"}) - large


def _is_plain(box: Box) -> bool:
    """Whether a box is a letter without a mark or a script."""
    return box.kind == "letter" and not box.marks and not box.primes and box.sub is None and box.sup is None


def letter_of(reader: FormulaReader, box: Box) -> tuple[Node, bool]:
    """The letter, and whether its superscript is part of its name."""
    raised = mark_of(reader, box)
    if box.primes or box.marks or box.style or box.upright:
        _mark_print(reader, box)
    if box.sub:
        _mark_index(reader, box)
    if box.sup:
        _mark_superscript(reader, box)
    if raised is None and box.sup is not None:
        _check_power(reader, box)
    index = index_parts(box)
    if len(spelled := reader.notation.spelled.get("_".join((box.name, *index)), ())) > 1:
        prints = " and ".join(f"{box.name}_{{{each}}}" for each in sorted(spelled))
        raise left_open(box, f"{prints} are one letter", "give one of them another index")
    name = name_of(box, index, raised or ())
    return Letter(name, is_printed_as_vector(box)), raised is not None


def _mark_print(reader: FormulaReader, box: Box) -> None:
    """Mark what primes, marks and fonts may mean."""
    known = reader.notation
    open_ = (
        ("prime", box.primes and stem_of(box) not in known.primed, "with a prime is a name, and no derivative"),
        ("bar", "bar" in box.marks and (known.seen & {"complex", "ket", "operators"} or box.name[0].isupper()),
         "with a bar is a name, and no conjugate or complement"),
        ("hat", "hat" in box.marks and not is_printed_as_vector(box), "with a hat is a factor, and no operator or direction"),
        ("dot", "times" in known.seen and any(m.endswith("dot") for m in box.marks), "with a dot is its rate in t"),
        ("under", "under" in box.marks, "with a line below is a vector"),
        ("set", box.style == "bb", "with a double line is a letter, and no set or mean"),
        ("unit", box.upright and box.name not in ("d", "e", "i", "O")
         and (len(box.name) == 1 or box.name in UNITS or rf"\{box.name}" in GREEK),
         "is no unit or operator"),
    )  # fmt: skip
    for key, is_open, what in open_:
        if is_open:
            reader.guess(key, f"{box.name} {what}")


def _mark_index(reader: FormulaReader, box: Box) -> None:
    """Mark an index that may be what a letter is differentiated by."""
    known = reader.notation
    below = without_thin(box.sub or [])
    names = [b.name if b.kind == "comma" or is_plain_letter(b) or rf"\{b.name}" in GREEK else "" for b in below]
    behind = names[names.index(",") + 1 :] if "," in names else []
    several = len(below) > 2 and (names[0] or len(below[0].name) > 1)  # \sigma_{11,1} and N_{I,1}, but no a_{1,2}
    by = several and below[-2].name == "," and below[-1].name in ("1", "2", "3")
    by = by or (names[:1] == [""] and 0 < len(behind) < 3 and {*behind} <= VARIABLES)  # A_{1,x}
    if any(b.name == ";" for b in below):
        reader.guess("index", f"the semicolon in the index of {box.name} parts indices, and is no covariant derivative")
    elif by or names[:1] == [","] or (0 < len(behind) < 3 and all(names) and "".join(names).replace(",", "").islower()):
        reader.guess("index", f"the comma in the index of {box.name} parts indices, and is no derivative")
    elif any(b.kind in ("operator", "relation", "bracket") and b.name not in ("+", "-", "/") for b in below):
        reader.guess("index", f"the index of {box.name} is part of the name")
    stem = stem_of(box)
    alone = any({stem, name_of(box)} & shown for shown in (known.bare, known.called.keys(), known.applied))
    differentiated = known.called.get(stem, set()) | known.varied.get(stem, set())
    component = (
        stem in known.arrows
        and len(names) == 1
        and not is_printed_as_vector(box)
        and f"{box.name}_t" not in known.spelled
    ) or (box.name == "e" and is_printed_as_vector(box))
    if names and (({*names} <= set("xyzt") and not component) or (alone and {*names} <= VARIABLES | differentiated)):
        reader.guess("index", f"the index of {box.name} is part of the name, and no derivative")


def _mark_superscript(reader: FormulaReader, box: Box) -> None:
    """Mark a superscript; it is a power where it is a number, or above Euler's e; and a name where it is a word."""
    known, row, stem = reader.notation, without_thin(box.sup or []), stem_of(box)
    if (box.name == "e" and "e" not in known.letters) or not row:
        return
    small = is_printed_as_vector(box) and (box.name[0].islower() or "vec" in box.marks)
    if (reader.above and {b.name for b in row} <= reader.above) or (
        small and power_in(box) and [b.name for b in row] != ["2"]
    ):
        return  # marked where it is read
    if not power_in(box) or upper_index(known, box):
        word = len(row) == 1 and (row[0].upright or row[0].kind == "text") and len(row[0].name) > 1
        transposed = row[0].name in ("top", "intercal") or (row[0].name == "T" and is_printed_as_vector(box))
        if not (word and row[0].name.islower()) and not transposed:
            reader.guess("mark", f"the superscript of {box.name} is part of the name")
        return
    number = row[-1].kind == "number" and len(row) == 1
    if [b.name for b in row] == ["-", "1"]:
        if not is_number(known, box) or known.is_function(box) or (box.name[0].isupper() and stem not in known.numeric):
            reader.guess("inverse", f"{box.name} is one over {box.name}, and no inverse function or matrix")
    elif stem in known.raised or box.style == "bb" or (number and row[0].name in ("0", "1")):
        reader.guess("power", f"the superscript of {box.name} is a power, and no index")
    elif any(b.kind == "letter" for b in all_boxes(row)):
        reader.guess("power", f"the superscript of {box.name} is a power, and no index, label or half step")
    elif not all(b.kind in ("number", "operator", "fraction") for b in row):
        reader.guess("power", f"the superscript of {box.name} is a power")


def _check_power(reader: FormulaReader, box: Box) -> None:
    row, known, bound = without_thin(box.sup or []), reader.notation, {*reader.bound}
    if len(row) == 1 and {row[0].name} & bound and {b.name for b in box.sub or ()} & bound - {row[0].name}:
        raise left_open(row[0], f"{row[0].name} is an upper index or a power", _BRACKETS)
    alike = [b.name for b in row if _is_plain(replace(b, primes=0)) and (b.name in _GREEK or b.name in _INDICES)]
    if alike and len(alike) == len(row) and not set(alike) & known.letters:
        tensor = {name for name in alike if name in TENSOR and name not in known.bare}
        lowered = (set(alike) - set("lmn")) & known.lowered
        if tensor or lowered or any(b.primes for b in row) or (len(alike) > 1 and set(alike) <= set("ijkl")):
            way_out = f'{_BRACKETS}, or in paper.toml [notation] letters = "{alike[0]}"'
            raise left_open(row[0], f"{' '.join(alike)} is an upper index or a power", way_out)
    if len(row) == 1 and row[0].kind == "letter" and row[0].sup and mark_of(reader, row[0]) is not None:
        raise left_open(row[0], f"the marked {row[0].name} is an upper index or a power", _BRACKETS)
    names = [b.name for b in row if _is_plain(b)]
    if len(names) == len(row) > 1 and (len(set(names)) < len(names) or set(names) <= set("xyz")):
        way_out = "write the power with \\cdot, or the indices below"
        raise left_open(row[0], f"{' '.join(names)} are upper indices or a power", way_out)
    transposes = [b.name for b in row] == ["T"] and "T" not in known.bare | known.letters
    capital = len(row) == 1 and row[0].kind == "letter" and row[0].name.isupper() and not row[0].marks
    if capital and box.sub and not transposes:
        raise left_open(row[0], f"{row[0].name} is a mark or a power", _BRACKETS)
    if len(row) == 1 and row[0].kind == "number" and row[0].name == "0":
        raise left_open(row[0], "0 is an upper index or a power", "write the index below")


def power_of(reader: FormulaReader, node: Node, box: Box) -> Node:
    """The node to the power that its box has."""
    if box.sup is None:
        return node
    row = without_thin(box.sup)
    if box.kind == "group" and len(box.parts[0]) == 1:
        _check_power(reader, box)
    if not row:
        raise FormulaError(box.at, "a power is empty", "write it")
    if (marked := _marked(reader, node, box, row)) is not None:
        return marked
    if is_vector(node):
        power = reader.expression(box.sup)
        if power == number(2) and not is_matrix(node):
            return Call("dot", (node, node))
        if power == Call("negative", (number(1),)) and is_matrix(node):
            return Call("inverse", (node,))
        raise FormulaError(row[0].at, "a vector has a power", "write its length")
    power = reader.expression(box.sup)
    if power == Call("quotient", (number(1), number(2))):
        return Call("sqrt", (node,))
    return Call("power", (node, power))


def _marked(reader: FormulaReader, node: Node, box: Box, row: list[Box]) -> Node | None:
    """What a mark above makes of what is no letter: a transpose, a conjugate; None where a power stands above."""
    known, only = reader.notation, row[0] if len(row) == 1 else None
    letter = only.name if only is not None and only.kind == "letter" else ""
    bare = "T" in known.bare
    if letter in ("top", "intercal") or (letter == "T" and (is_vector(node) or not ("T" in known.letters or bare))):
        if letter == "T" and not is_vector(node):
            reader.guess("transpose", "T above transposes, and is no power")
        return Call("transpose", (node,))
    if letter == "T" and "T" not in known.letters:
        raise left_open(row[0], "T is a power or transposes", "write \\top, or the letter in bold")
    if is_vector(node):
        return None
    state = isinstance(node, Call) and node.name.split("_")[0] in ("ket", "bra")
    if box.kind == "bracket" and only is not None and only.name in ("*", "dagger") and not state:
        return Call("conjugate" if only.name == "*" else "adjoint", (node,))
    if any(b.kind == "letter" and b.name in ("dagger", "prime") for b in row) or (only and only.kind == "operator"):
        raise FormulaError(row[0].at, "a mark stands over what is no letter", "write what it means")
    if only is not None and only.kind in ("text", "relation", "comma"):
        raise FormulaError(row[0].at, "words stand as a power", "write them as an index")
    if only is not None and only.kind == "bracket" and only.name == "(" and isinstance(node, Call):
        raise left_open(row[0], "it is an order of derivative or a power", "write what it means")
    return None
