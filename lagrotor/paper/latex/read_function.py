r"""Functions by name, \\sin and \\ln, and how far an argument without brackets reaches."""

from dataclasses import replace

from lagrotor.paper.latex.boxes import FUNCTIONS, Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_letter import is_called
from lagrotor.paper.latex.read_scripts import mark_of
from lagrotor.paper.latex.rows import ENDING, is_moving
from lagrotor.paper.latex.tree import Call, Node, number
from lagrotor.paper.latex.usage import arguments

_ANGLES = ("theta", "phi", "varphi", "psi", "alpha", "beta", "vartheta", "gamma", "chi")
_NOT_OF_NUMBERS = "det tr Tr diag rank dim arg Re Im max min sup inf ker deg gcd"


def read_function(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    name = FUNCTIONS.get(box.name, box.name)
    if name in ("max", "min", "sup", "inf") and box.sub is not None:
        raise FormulaError(box.at, f"{box.name} over a set is not read", "write its value")
    after, end = [*(b for b in row[place + 1 :] if b.kind != "thin"), box, box][:2]
    bracketed = after.kind == "bracket" and after.name not in ("|", r"\|")
    alone = after.kind in ("letter", "number") and (end is box or end.kind == "operator")
    if (box.name in _NOT_OF_NUMBERS.split() or box.name not in FUNCTIONS) and not (bracketed or alone):
        reader.guess("words", f"{box.name} acts on all that follows it")
    inner, behind = _argument(reader, row, place)
    if behind < len(row) and row[behind].name == "!":
        if name not in ("log", "log10"):
            raise left_open(row[behind], "! is of the argument or of the function", "write brackets")
        inner, behind = (Call("factorial", inner[:1]),), behind + 1  # ln n!
    node = _applied(reader, name, box, inner)
    if box.sup is None:
        return node, behind
    if box.name not in FUNCTIONS:
        raise left_open(box, f"{box.name} has an upper index or a power", "write brackets around what is raised")
    if [b.kind for b in box.sup] == ["bracket"]:
        raise left_open(
            box, "the number in brackets counts derivatives", "write a power without them, or the derivatives"
        )
    power = reader.expression(box.sup)
    if power == Call("negative", (number(1),)):
        inverse = {"sin": "asin", "cos": "acos", "tan": "atan", "sinh": "asinh", "cosh": "acosh", "tanh": "atanh"}
        if name not in inverse:
            raise left_open(box, f"{box.name}^{{-1}} is the inverse function", "write a fraction")
        reader.guess("inverse", f"{box.name}^{{-1}} is the inverse function")
        return _applied(reader, inverse[name], replace(box, sup=None), inner), behind
    return Call("power", (node, power)), behind


def _applied(reader: FormulaReader, name: str, box: Box, inner: tuple[Node, ...]) -> Node:
    if name == "log10" or (name == "log" and box.sub):
        base = reader.expression(box.sub) if box.sub else number(10)
        return Call("quotient", (Call("log", inner), Call("log", (base,))))
    if box.sub is not None:
        raise FormulaError(box.at, f"{box.name} has an index", "write what it means")
    if box.name == "log":
        reader.guess("log", "log is the natural logarithm")
    if name == "det" or name in ("tr", "Tr"):
        return Call(name.lower(), inner)
    return Call(name, inner)


def _argument(reader: FormulaReader, row: list[Box], place: int) -> tuple[tuple[Node, ...], int]:
    """The arguments of a function: a bracket, or what follows it as custom has it."""
    behind = next((k for k in range(place + 1, len(row)) if row[k].kind != "thin"), None)
    if behind is None:
        raise FormulaError(row[place].at, f"{row[place].name} has no argument", "write it in brackets")
    first = row[behind]
    if first.kind == "bracket" and first.name in ("(", "[", r"\{"):
        if first.sub is not None:
            raise FormulaError(first.at, "a bracket has an index", "write what it means")
        if first.sup is not None:
            raise left_open(first, "the power is of the argument or of the function", "write brackets")
        parts = [reader.expression(p) for p in arguments(first.parts[0])]
        return tuple(parts), behind + 1
    if first.kind == "bracket" and first.name in ("|", r"\|", r"\lvert", r"\vert") and first.sup is None:
        return (reader.factor(row, behind)[0],), behind + 1
    if first.kind == "function" and row[place].name != "arg":  # \ln\cosh x; \arg\min is one word
        node, behind = reader.factor(row, behind)
        return (node,), behind
    end = _reach(reader, row, behind, row[place])
    for box in row[behind:end]:
        if box.sup is not None and mark_of(reader, box) is None:
            raise left_open(box, "the power is of the argument or of the function", "write brackets")
    return (reader.product(row[behind:end]),), end


def _reach(reader: FormulaReader, row: list[Box], start: int, function: Box) -> int:
    """Where the argument of a function without brackets ends."""
    end = start
    while end < len(row) and row[end].kind in ("number", "letter", "fraction", "root", "group", "thin"):
        if row[end].kind == "thin" and end > start:
            break
        end += 1
    run = row[start:end]
    if not run:
        raise FormulaError(row[start].at, f"the argument of {function.name} is not clear", "write it in brackets")
    if len(run) == 1:
        _after_one(reader, run[0], row, end, function)
        return end
    if run[0].kind == "number" and len(run) == 2 and run[1].kind == "letter" and not is_moving(run[1]):
        if FUNCTIONS.get(function.name) in ("log", "log10", "exp"):
            reader.guess("argument", f"the argument of {function.name} is the product that follows it")
        return end
    return start + _within(reader, run, function)


def _after_one(reader: FormulaReader, only: Box, row: list[Box], end: int, function: Box) -> None:
    """One thing behind a function; what follows a thin space is another factor where it is plain that it is."""
    after = next((b for b in row[end:] if b.kind != "thin"), None)
    if after is None or after.kind in (*ENDING, "function", "big"):
        return
    if after.kind == "bracket" and only.kind == "letter":
        angle = only.name in _ANGLES or only.name in reader.notation.angles
        if is_called(reader, only, after) or (after.name == "(" and not angle):
            raise left_open(after, f"the bracket belongs to the argument of {function.name}", "write brackets")
        reader.guess("argument", f"the argument of {function.name} ends before the bracket")
        return
    if only.kind == "letter" and (only.name in _ANGLES or only.name in reader.notation.angles or is_moving(after)):
        reader.guess("argument", f"the argument of {function.name} is {only.name} alone")
        return
    if only.kind in ("fraction", "group") and is_moving(after):
        return
    raise FormulaError(after.at, f"where the argument of {function.name} ends is open", "write it in brackets")


def _within(reader: FormulaReader, run: list[Box], function: Box) -> int:
    """How many of the factors behind a function are its argument."""
    moving = next((n for n, b in enumerate(run) if n and is_moving(b)), len(run))
    kept = run[:moving]
    if moving < len(run):
        if len(kept) == 1 or (kept[0].kind == "number" and len(kept) == 2):
            reader.guess("argument", f"the argument of {function.name} ends before what moves")
            return moving
        raise FormulaError(run[0].at, f"where the argument of {function.name} ends is open", "write it in brackets")
    letters = [b for b in kept if b.kind == "letter"]
    if "pi" in {b.name for b in letters[:2]} and all(b.kind in ("letter", "number") for b in kept):
        reader.guess("argument", f"the argument of {function.name} is the product that follows it")
        return len(run)
    if len(letters) == len(kept) or (kept[0].kind in ("number", "fraction") and len(letters) == len(kept) - 1):
        first = letters[0].name if letters else ""
        ends = letters and letters[-1].name in ("t", "tau", "x", "y", "z", "s", "theta", "phi", "varphi")
        begins = first not in (*reader.notation.angles, *_ANGLES[:4], "vartheta", "x", "y", "z", "r", "t")
        spelled = FUNCTIONS.get(function.name) not in ("log", "log10", "exp") and first not in _ANGLES  # cos qa
        if begins and ((ends and (len(letters) <= 2 or kept[0].kind == "number")) or (len(letters) == 2 and spelled)):
            if [first.lower(), *(b.name for b in letters[1:])] != ["omega", "t"]:  # of a rate and the time
                reader.guess("argument", f"the argument of {function.name} is the product that follows it")
            return len(run)
    raise FormulaError(run[0].at, f"where the argument of {function.name} ends is open", "write it in brackets")
