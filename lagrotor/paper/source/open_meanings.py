r"""What a print says by custom only: each sign that has a rival meaning which nothing in the paper settles is a guess.

A sign passes where the author declares its meaning, where the paper uses it in one meaning, or where custom has no rival for it;
all else is marked, signs that are not named here as well. A marked reading is what custom takes; no verdict rests on a mark but
on that of log.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import pairwise

from lagrotor.paper.source.boxes import FUNCTIONS, GREEK, Box
from lagrotor.paper.source.formula_reader import FormulaReader
from lagrotor.paper.source.read_letter import is_called
from lagrotor.paper.source.read_statements import PrintedStatement
from lagrotor.paper.source.rows import (
    TENSOR,
    UNITS,
    all_boxes,
    derivative_mark,
    is_joining,
    is_unit_like,
    strip,
    without_thin,
)
from lagrotor.paper.source.usage import (
    Notation,
    is_plain_letter,
    is_printed_as_vector,
    name_of,
    power_in,
    simple_argument,
    stem_of,
)

# Names that are mostly functions: before a bracket they are no factors.
_FUNCTION_NAMES = "f g h F G H P Phi Psi phi psi varphi delta Delta Gamma Theta theta zeta eta"
_FUNCTIONS = frozenset(_FUNCTION_NAMES.split())
_PLAIN = ("root", "infinity", "comma", "wide", "thin", "dots", "row", "rows", "group", "percent", "degree", "unit",
          "binomial", "cases", "partial")  # fmt: skip
_ACTING = ("letter", "bracket", "fraction", "root", "accent", "function", "big", "nabla", "partial")
_ONE_MEANING = ("=", ":=", "<", ">", "<=", ">=", "!=", "<<", ">>", "propto")
_BOUNDS = frozenset(("<", ">", "<=", ">="))
_STATED_SIGNS = "Rightarrow implies iff Leftrightarrow Longrightarrow Longleftrightarrow therefore forall"
_STATED = frozenset(_STATED_SIGNS.split())
_INDICES = frozenset("abcdefghijklmnopqrsuvw") | {name[1:] for name in GREEK if name[1].islower()}
_VARIABLES = frozenset(["x", "y", "z", "t", "r", "s", "xi", "eta", "theta", "phi"])
# Numbers without dimension and functions whose names have two letters.
_NUMBER_NAMES = "Re Ra Pr Nu Ma We Fr Bo Ca Pe St Sc Sh Gr Kn Ro Ek Bi Da De Le Mo Oh Ri Wi Im Tr Ad Id Ei Si Ci Li Ai"
_NUMBERS = frozenset(_NUMBER_NAMES.split())
_WORDS = ("det", "tr", "Tr", "diag", "rank", "dim", "arg", "Re", "Im", "max", "min", "sup", "inf", "ker", "deg", "gcd")
Rivals = Iterator[tuple[str, str, str]]


def mark_open_meanings(reader: FormulaReader, row: list[Box], statements: Iterable[PrintedStatement]) -> None:
    """Add to the guesses of a reading what has a rival meaning."""
    if any(a.node == b.node for each in statements for a, b in pairwise(each.sides)):
        reader.guess("same", "two signs that differ in print are the same, as a dot and a rate")
    for key, what, settles in (*_row(reader, row), *_repeated(row)):
        reader.guess(key, what, settles)


def _row(reader: FormulaReader, row: list[Box]) -> Rivals:
    inner = without_thin(row)
    for place, box in enumerate(inner):
        check = _CHECKS.get(box.kind)
        if check is not None:
            yield from check(reader, inner, place)
        elif box.kind not in _PLAIN:
            yield "sign", f"{reader.source[box.at : box.end]} has its usual meaning", ""
        for part in box.parts:
            yield from _row(reader, part)
        if box.kind == "big":
            yield from _words(reader, without_thin(box.sub or []))
        if box.sup and power_in(box):
            yield from _row(reader, box.sup)
    yield from _apart(reader, row)
    signs = [b.name for b in row if b.kind == "relation"]
    between = row[next((k for k, b in enumerate(row) if b.name == "="), 0) :]
    condition = next((k for k, b in enumerate(between) if b.name in _BOUNDS and b.kind == "relation"), 0)
    if "=" in signs and {*signs} & _BOUNDS and any(b.kind == "thin" for b in strip(between[1:condition])):
        yield "spaces", "what a space parts are factors, and no condition", ""
    yield from _words(reader, inner)
    yield from _order(reader, inner)


def _behind(row: list[Box], place: int) -> Box | None:
    return row[place + 1] if place + 1 < len(row) else None


def _letter(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box, after, known = row[place], _behind(row, place), reader.notation
    stem, acts = stem_of(box), after is not None and after.kind in _ACTING
    bracketed = after is not None and after.kind == "bracket"
    if after is not None and bracketed and after.name in ("(", "[", r"\{"):
        if box.name not in "Oo":
            yield from _before_bracket(reader, box, after)
        elif not place or row[place - 1].kind != "operator" or not _letters(*after.parts[0]):
            yield "order", f"{box.name}(…) is an order of magnitude, and no group or function", ""
    held = (
        ("prime", box.primes and (stem not in known.primed or bracketed), "with a prime is a name, and no derivative"),
        ("bar", "bar" in box.marks and known.seen & {"complex", "ket"}, "with a bar is a name, and no conjugate"),
        (
            "hat",
            "hat" in box.marks and acts and not is_printed_as_vector(box),
            "with a hat is a factor, and no operator or direction",
        ),
        ("dot", "times" in known.seen and any(m.endswith("dot") for m in box.marks), "with a dot is its rate in t"),
        (
            "script",
            box.style in ("cal", "scr", "frak") and acts and not box.sup,
            "in script is a factor, and no operator",
        ),
        (
            "laplacian",
            _is_delta(box) and (box.marks or box.sup or not acts or box.name == "triangle"),
            "is a letter, and no Laplacian",
        ),
        (
            "order",
            bracketed and "order" in known.seen and box.name in ("o", "omega", "Omega", "theta", "Theta"),
            "is a function of the bracket, and no order of magnitude",
        ),
        ("operator", box.name == "D" and not box.sub and "P(D)" in known.seen, "is a number, and no derivative"),
        ("sign", box.name in ("uparrow", "downarrow", "emptyset", "complement"), "is a letter"),
        ("set", box.style == "bb", "with a double line is a letter, and no set or mean"),
    )
    for key, is_open, what in held:
        if is_open:
            yield key, f"{box.name} {what}", ""
    if not (box.sub or box.marks or box.style) and box.name not in known.functions | known.letters | known.numbers:
        yield from _number(reader, box, after)
    if after is not None and acts and not (bracketed or box.sup):
        yield from _acting(known, box, after, _behind(row, place + 1))
    if box.sub:
        yield from _lowered(known, box)
    if box.sup:
        yield from _raised(reader, box)


def _lowered(known: Notation, box: Box) -> Rivals:
    """Indices that may be what a letter is differentiated by."""
    below = [b.name if b.kind == "comma" or is_plain_letter(b) else "" for b in without_thin(box.sub or [])]
    behind = below[below.index(",") + 1 :] if "," in below else []
    if below[:1] == [","] or (0 < len(behind) < 3 and all(below) and "".join(below).replace(",", "").islower()):
        yield "index", f"the comma in the index of {box.name} parts indices, and is no derivative", ""
    stem, held = stem_of(box), set(below)
    alone = bool({stem, name_of(replace(box, sub=None, sup=None))} & (known.bare | known.called.keys()))
    twice = len(below) > 1 and held <= {"x", "y", "z", "t"} and alone
    rates = alone and {f"{box.name}_t", f"{box.name}_x"} <= known.spelled.keys()  # u_t + u u_x = 0
    twice = twice or (rates and held <= {"x", "t"})
    if held <= _VARIABLES and held and (twice or held <= known.varied.get(stem, set()) | known.called.get(stem, set())):
        yield "index", f"the index of {box.name} is part of the name, and no derivative", ""


def _is_delta(box: Box) -> bool:
    """Whether a letter is a capital delta or a triangle, without an index."""
    return box.name in ("Delta", "triangle") and not (box.sub or box.style or box.primes)


def _acting(known: Notation, box: Box, after: Box, then: Box | None) -> Rivals:
    """A letter before a factor: D, L and E may act on it, capitals on a function, and a sigma may be a sum."""
    function = (
        after.kind == "letter" and stem_of(after) in known.applied and not (after.sup or is_printed_as_vector(after))
    )
    function = (function and (then is None or then.kind != "bracket")) or (
        (after.name in ("psi", "Psi") and box.name != "E") or (after.name in _FUNCTIONS and box.name == "D")
    )
    sums = box.name in ("Sigma", "Pi") and not (box.sub or box.marks)
    marked = box.name in ("D", "L", "E") and (box.sub or box.marks)
    capitals = box.name.isupper() and after.name.isupper() and not (box.sub or after.sub)
    applied = capitals and stem_of(box) in known.applied  # E X where E[X] stands
    if box.name not in known.letters and (sums or marked or applied or (function and box.name.isupper())):
        yield "operator", f"{box.name} is a factor of what follows, and no operator on it", f'letters = "{box.name}"'


def _number(reader: FormulaReader, box: Box, after: Box | None) -> Rivals:
    """Letters that may be numbers."""
    settles = f'letters = "{box.name}" or numbers = "{box.name}"'
    turned = "complex" in reader.notation.seen or (after is not None and after.name == "omega")
    if box.name in ("j", "imath", "jmath") and turned and box.name not in reader.lowered:
        yield "j", f"{box.name} is a letter, and not the imaginary unit", settles
    if box.name == "e" and not (box.sup or box.upright) and reader.notation.exponential:
        yield "e", "e is a letter, and not Euler's number", settles


def _raised(reader: FormulaReader, box: Box) -> Rivals:
    """What a superscript of a letter may be besides a power."""
    known, row, stem = reader.notation, without_thin(box.sup or []), stem_of(box)
    if (box.name == "e" and "e" not in known.letters) or not row:
        return
    if not power_in(box):
        first = row[0].name
        if len(row) == 1 and (first in ("dagger", "top", "intercal") or (first == "T" and is_printed_as_vector(box))):
            return
        if len(row) == 1 and (row[0].upright or row[0].kind == "text") and len(first) > 1:
            return
        yield "mark", f"the superscript of {box.name} is part of the name", ""
        return
    number = row[-1].kind == "number" and len(row) == 1
    inverse = [b.name for b in row] == ["-", "1"]
    if stem in known.raised or box.style == "bb" or (number and row[0].name in ("0", "1")):
        yield "power", f"the superscript of {box.name} is a power, and no index", ""
    elif inverse and (stem in known.matrices or box.name[0].isupper() or known.is_function(box)):
        yield "inverse", f"{box.name} is one over {box.name}, and no inverse function or matrix", ""
    elif _letters(*row) and any(b.kind == "fraction" or b.name == "/" for b in row) and box.name[0].isupper():
        yield "power", f"the superscript of {box.name} is a power, and no half step", ""
    elif number or all(b.kind in ("number", "operator") or (b.kind == "fraction" and not _letters(b)) for b in row):
        return
    elif stem not in known.powers or not all(n.islower() and n in known.apart - known.lowered for n in _letters(*row)):
        yield "power", f"the superscript of {box.name} is a power, and no index or label", ""


def _letters(*held: Box) -> set[str]:
    return {b.name for b in all_boxes(list(held)) if b.kind == "letter"}


def _before_bracket(reader: FormulaReader, box: Box, bracket: Box) -> Rivals:
    """A letter before a bracket: a function of it, or a factor."""
    known, content = reader.notation, without_thin(bracket.parts[0])
    settles = f'functions = "{box.name}" or letters = "{box.name}"'
    key = name_of(replace(box, primes=0, sup=None))
    if {box.name, key, stem_of(box)} & (known.functions | known.letters):
        return
    called = bracket.name == "(" and is_called(reader, box, bracket) is True
    if not box.sup and bracket.name == "(":
        evident = _evidence(known, box, content, bracket)
    else:
        listed = any(b.kind == "comma" for b in content)
        evident = False if not listed and _is_factor(known, box, content) else None
    if evident is not called:
        what = "a function of the bracket, and no factor" if called else "a factor, and no function of the bracket"
        yield "bracket", f"{box.name} before {bracket.name.lstrip(chr(92))} is {what}", settles


def _evidence(known: Notation, box: Box, content: list[Box], bracket: Box) -> bool | None:
    """True for a function, False for a factor, None where the paper does not say."""
    letters = any(b.kind == "letter" for b in content)
    listed = any(b.kind == "comma" for b in content)
    if simple_argument(content) and letters and not bracket.sup and (listed or len(content) == 1):
        numbers = (
            listed and stem_of(box) in known.factors and any(b.kind == "number" for b in content)
        )  # gamma(1, beta)
        other = known.called.get(name_of(replace(box, primes=0)), set()) - _letters(*content)
        return None if numbers and not other else True
    if stem_of(box) in known.applied:
        return None if stem_of(box) in known.factors or bracket.sup else True
    return False if _is_factor(known, box, content) else None


def _is_factor(known: Notation, box: Box, content: list[Box]) -> bool:
    """Whether the paper has a letter among factors, and never before an argument or as what is differentiated."""
    stem = stem_of(box)
    variable = {b.name for b in content if b.kind == "letter"} & {"t", "tau", *set().union(*known.called.values(), ())}
    return (
        stem in known.factors
        and stem not in known.applied | known.differentiated
        and not variable
        and box.name not in _FUNCTIONS
    )


def _bracket(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box, content = row[place], without_thin(row[place].parts[0])
    before = row[place - 1] if place else None
    if box.name in ("(", "[", r"\{", r"\lbrace"):
        yield from _enclosed(reader, box, before, content)
    after = _behind(row, place)
    free = "D" not in reader.notation.letters and any(b.name == "D" and not b.sub for b in content)
    if free and after is not None and after.kind in _ACTING and len(content) > 1:
        yield "operator", "D is a number, and no derivative", 'letters = "D"'
    inverse = [b.name for b in box.sup or ()] == ["-", "1"]
    if inverse and any(name.isupper() or name in reader.notation.matrices for name in _letters(*content)):
        yield "inverse", "the bracket with -1 is turned over, and no inverse matrix or function", ""
    if box.sub and box.name in ("(", "["):
        yield "index", "the index of a bracket takes a component, or holds what is constant", ""
    if box.sup and not power_in(box) and [b.name for b in box.sup] not in (["T"], ["top"]):
        yield "mark", "the superscript of a bracket is a mark", ""
    if {box.name, box.closing} & {r"\rangle", r"\langle", ">", "<", "⟨", "⟩"}:
        yield from _angles(reader, box, content)
    elif box.name == "." and box.sub and len(box.sub) == 1 and box.sub[0].kind == "letter":
        yield "at", f"the bar with {box.sub[0].name} says where, and not what is held constant", ""
    elif box.closing in ("|", r"\vert", r"\rvert") and box.name != ".":
        yield from _magnitude(content)


def _enclosed(reader: FormulaReader, box: Box, before: Box | None, content: list[Box]) -> Rivals:
    """Round, square and curly brackets that are no argument."""
    commas = sum(b.kind == "comma" for b in content)
    adds = any(b.kind == "operator" and b.name in ("+", "-", "pm", "mp") for b in content[1:])
    single = content[0] if len(content) == 1 and not box.sup else None
    if before is not None and before.kind in ("letter", "function"):
        if before.kind == "function" and box.name != "(" and not adds:
            yield "set", f"{box.name} encloses an argument, and no set or class", ""
    elif commas and (box.name == "(" or commas > 1 or not _letters(*content)):
        yield "list", "the brackets hold components, and no pair, interval or product", ""
    elif box.name != "(" and not commas and not (adds and any(b.kind == "bracket" for b in content)):
        yield "set", f"{box.name} encloses a factor, and is no set, class or whole part", ""
    elif single and single.kind == "fraction" and "modular" in reader.notation.seen:
        yield "fraction", "the bracket holds a fraction, and no symbol of Legendre", ""
    elif single and single.kind in ("letter", "number") and not single.sup:
        yield "bracket", "the brackets enclose one sign as a factor, and no argument, class or ideal", ""


def _number_sign(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    if len(row[place].name) > 1 and row[place].name.isdecimal() and row[place].name[0] == "0":
        yield "digits", f"{row[place].name} is a number, and no row of digits", ""


def _magnitude(content: list[Box]) -> Rivals:
    only = content[0] if len(content) == 1 and content[0].kind == "letter" else None
    if any(b.kind == "comma" for b in content) or (
        only and (only.name[0].isupper() or only.style) and not is_printed_as_vector(only)
    ):
        yield "bars", "the bars are a magnitude, and no determinant or number of elements", ""


def _bar(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    """A bar that is paired where it is read."""
    below = row[place].sub or []
    if len(below) == 1 and below[0].kind == "letter":
        yield "at", f"the bar with {below[0].name} says where, and not what is held constant", ""
    closing = next((k for k in range(place + 1, len(row)) if row[k].kind == "bar"), place)
    yield from _magnitude(row[place + 1 : closing])


def _angles(reader: FormulaReader, box: Box, content: list[Box]) -> Rivals:
    """Labels of kets that are no single sign, and means outside quantum mechanics."""
    parts: list[list[Box]] = [[]]
    for each in content:
        if each.kind in ("bar", "comma"):
            parts.append([])
        else:
            parts[-1].append(each)
    if "|" not in (box.name, box.closing) and len(parts) == 1 and "ket" not in reader.notation.seen:
        yield "mean", "angle brackets are a mean, and nothing that is generated", ""
    if len(parts) > 1 and not any(b.kind == "bar" for b in content) and box.name not in ("|",):
        yield "inner", "angle brackets with a comma are an inner product", ""
    if len(parts) == 3 and parts[1] and parts[1][0].kind == "operator":
        yield "label", "the sign behind the bar belongs to what stands in a bracket, and joins no bra and ket", ""
    for part in parts if len(parts) != 3 else (parts[0], parts[2]):
        held = [b for b in part if b.kind not in ("operator", "thin")]
        side = any(a.kind != "operator" and b.kind != "operator" for a, b in pairwise(part))
        several = side or any(b.kind == "number" and len(b.name) > 1 for b in held)
        if several and (box.name == "|" or box.closing == "|" or len(parts) > 1):
            yield "label", "letters side by side in a ket are a product, and no list of labels", ""


def _fraction(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box = row[place]
    mark = derivative_mark(box)
    if mark and any(b.kind == "letter" and b.sup and power_in(b) for b in without_thin(box.parts[0])[1:2]):
        yield "derivative", "the power above is differentiated, and is none of the differential", ""
    if mark in ("D", "delta"):
        yield "derivative", f"the fraction with {mark} is a derivative like any other", ""
    if mark == "d" and "times" in reader.notation.seen and [b.name for b in box.parts[1]][1:] == ["t"]:
        yield "dot", "the derivative by t is the rate that a dot has", ""


def _operator(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box, known = row[place], reader.notation
    before, after = (row[place - 1] if place else None), _behind(row, place)
    if box.name == "cdot":
        beside = [b for b in (before, after) if b is not None]
        number = any(
            b.kind in ("number", "fraction", "root", "function", "big", "nabla") or not _letters(b) for b in beside
        )
        matrices = any(
            is_printed_as_vector(b) and b.name[0].isupper() and stem_of(b) not in known.crossed for b in beside
        )
        hats = any("hat" in b.marks and not is_printed_as_vector(b) for b in beside)
        tensors = any(b.kind == "letter" and stem_of(b) in known.raised and not b.sup for b in beside)
        if matrices or hats or tensors or not (number or "bold" in known.seen):
            yield "cdot", "the dot multiplies numbers or joins vectors as these are printed", ""
    elif box.name in ("pm", "mp") and any(
        b.kind in ("unit", "text") or (b.upright and len(b.name) > 1) for b in row[place:]
    ):
        yield "unit", "the unit belongs to the uncertainty alone", ""
    elif box.name not in ("+", "-", "pm", "mp", "/", "times", "!"):
        yield "sign", f"{box.name} has its usual meaning", ""


def _relation(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box, known = row[place], reader.notation
    printed = reader.source[box.at : box.end]
    if box.name not in _ONE_MEANING and printed not in (r"\approx", "≈"):
        yield "relation", f"{printed} is read as {box.name}", ""
    elif box.marks:
        yield "relation", f"what stands over {box.name} changes nothing", ""
    elif box.name == ":=" and printed == r"\equiv" and "modular" in known.seen:
        yield "relation", r"\equiv is a definition, and no congruence", ""
    elif box.name in "<>" and {b.name for b in row if b.kind == "relation"} >= {"<", ">"}:
        yield "relation", "< and > are relations, and no angle brackets", ""


def _arrow(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    if row[place].name not in _STATED:
        yield "relation", f"{row[place].name} joins two statements, and both are meant", ""


def _text(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box, after = row[place], _behind(row, place)
    before = row[place - 1] if place else None
    if before is not None and before.kind == "number" and is_unit_like(box.name):
        return
    apart = all(b is None or b.kind in ("wide", "comma", "relation", "arrow") for b in (before, after))
    if re.search(r"[$\[\]*=+\\]", box.name) or not (apart or is_joining(box.name)):
        yield "words", f"the words {box.name} join statements, and are no factor or function", ""


def _function(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box, after, end = row[place], _behind(row, place), _behind(row, place + 1)
    single = after is not None and after.kind in ("letter", "number")
    ends = end is None or end.kind in ("relation", "operator", "comma", "wide")
    bracketed = after is not None and after.kind == "bracket"
    if (box.name in _WORDS or box.name not in FUNCTIONS) and not (bracketed or (single and ends)):
        yield "words", f"{box.name} acts on all that follows it", ""


def _accent(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    if row[place].name not in ("dot", "ddot"):
        yield "bar", f"the {row[place].name} over several signs is no conjugate or segment", ""


def _big(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box = row[place]
    if box.name in ("oint", "iint", "iiint", "oiint") or ("int" in box.name and box.sub and not box.sup):
        yield "integral", f"\\{box.name} is an integral over what is written below it", ""
    if "int" in box.name:
        rest = strip(row[place + 1 :])
        ends = [k for k, b in enumerate(rest) if b.kind == "letter" and b.name == "d" and k + 1 < len(rest)]
        if (
            ends
            and ends[0] + 2 < len(rest)
            and rest[ends[0] + 2].kind in ("letter", "bracket", "fraction", "function", "root")
        ):
            yield "integral", "what follows the differential is integrated, and no factor of the whole", ""


def _matrix(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    box = row[place]
    if box.name in ("array", "Bmatrix"):
        yield "array", f"the {box.name} is a matrix, and no table or symbol", ""
    if box.name == "pmatrix" and [len(line.parts) for line in box.parts[0]] == [3, 3]:
        yield "array", "the brackets hold a matrix, and no 3j symbol", ""


def _nabla(reader: FormulaReader, row: list[Box], place: int) -> Rivals:
    if row[place].sup and "hessian" in reader.notation.seen:
        yield "laplacian", "\\nabla^2 is the Laplacian, and no matrix of second derivatives", ""


_CHECKS: dict[str, Callable[[FormulaReader, list[Box], int], Rivals]] = {
    "number": _number_sign, "letter": _letter, "bracket": _bracket, "fraction": _fraction, "operator": _operator,
    "relation": _relation, "arrow": _arrow, "text": _text, "function": _function, "accent": _accent, "big": _big,
    "matrix": _matrix, "bar": _bar, "nabla": _nabla,
}  # fmt: skip


def _apart(reader: FormulaReader, row: list[Box]) -> Rivals:
    """Factors that are set apart by a space, and units in italics."""
    for place, box in enumerate(row[1:-1], 1):
        sides = row[place - 1].kind, row[place + 1].kind
        wide = box.kind == "thin" and reader.source[box.at : box.end] in ("\\ ", r"\;", "~", r"\enspace")
        if wide and all(kind in ("letter", "number", "thin", "fraction", "root") for kind in sides):
            yield "spaces", "what a space parts are factors, and no list", ""
    side: list[Box] = []
    for box in [*without_thin(row), Box("relation", "", 0, 0)]:
        if box.kind in ("relation", "comma", "wide", "text", "arrow"):
            if len(side) > 1 and side[-1].kind == "fraction" and side[-2].kind == "number":  # 9.81 m/s^2
                side[-1:] = [b for part in side[-1].parts for b in part]
            letters = [b for b in side if b.kind == "letter"]
            plain = all(b.kind in ("number", "letter") or b.name in ("/", "times", "cdot") for b in side)
            plain = plain and not any(b.sub or b.upright for b in letters)
            names = [b.name for b in letters]
            joined = "".join(" " * (a.end != b.at) + b.name for a, b in pairwise([*letters[:1], *letters])).split()
            named = {*names[names[:1] == ["mu"] :]} <= UNITS or {*joined} <= UNITS
            if letters and plain and side[0].kind == "number" and named:
                yield "unit", f"{letters[0].name} behind the number is a letter, and no unit", ""
            side = []
        else:
            side.append(box)


def _words(reader: FormulaReader, row: list[Box]) -> Rivals:
    """Letters that touch each other may be a name: capitals, more than two, and what is before an argument."""
    run: list[Box] = []
    for place, box in enumerate([*row, Box("thin", "", -2, -2)]):
        letter = box.kind == "letter" and len(box.name) == 1 and not (box.style or box.upright or box.marks)
        if run and not (letter and box.at == run[-1].end and is_plain_letter(run[-1])):
            name = "".join(each.name for each in run)
            called = box.kind == "bracket" and box.name == "(" and is_called(reader, run[-1], box) is True
            two = len(name) == 2 and name.islower() and not re.fullmatch("n[xyztr]", name)
            known = two or (set(name) <= reader.notation.apart and name not in _NUMBERS)
            if len(run) > 1 and name[0] != "d" and (called or name.isupper() or not known):
                yield "name", f"{name} is a product, and no name", ""
            run = []
        if letter:
            run.append(box)
        before = row[place - 1] if place else None
        if before is not None and box.name in ("e", "E") and before.kind == "number" and before.end == box.at:
            yield "e", f"{box.name} behind a number is a letter, and no power of ten", ""


def _order(reader: FormulaReader, row: list[Box]) -> Rivals:
    """Products of what the paper uses as matrices or operators elsewhere."""
    known = reader.notation
    for a, b in pairwise(row):
        capitals = sum(each.name.isupper() and stem_of(each) not in known.matrices for each in (a, b))
        side = a.kind == b.kind == "letter" and is_printed_as_vector(a) and is_printed_as_vector(b)
        if side and (capitals == 2 or stem_of(a) in known.crossed):
            yield "matrix", f"{a.name} and {b.name} side by side are matrices, and no vectors", ""
    product: list[Box] = []
    for box in [*row, Box("relation", "", 0, 0)]:
        if box.kind in ("letter", "bracket", "fraction", "accent", "root", "group", "matrix"):
            product.append(box)
            continue
        if box.kind in ("operator", "relation", "comma", "wide", "text", "arrow") and box.name not in (
            "cdot",
            "times",
            "!",
        ):
            held = [
                b
                for b in product
                if b.kind == "letter" and not is_printed_as_vector(b) and stem_of(b) in known.matrices
            ]
            others = [b for b in product if _letters(b)]
            vectors = [k for k, b in enumerate(product) if b.kind == "letter" and is_printed_as_vector(b)]
            inner = product[vectors[0] : vectors[-1]] if vectors else []
            if any(b.kind == "letter" and not is_printed_as_vector(b) for b in inner):
                yield "matrix", "the letter between two vectors is a number, and no matrix", ""
            capital = next(
                (b.name for b in product if b.kind == "letter" and b.name.isupper() and not (b.sub or b.style)), ""
            )
            if capital and not held and any(b.kind == "matrix" for b in product):
                yield "matrix", f"{capital} beside a matrix is a number, and none itself", ""
            if held and len(others) > 1:
                yield "matrix", f"{held[0].name} commutes with the factors beside it", ""
            product = []


def _repeated(row: list[Box]) -> Rivals:
    """An index that a term has twice and another has not: a sum over it may be meant."""
    terms: list[list[Box]] = [[]]

    def look(part: list[Box]) -> None:
        for box in part:
            if box.kind in ("rows", "row"):
                for cell in box.parts:
                    look(cell)
                terms.append([])
            elif box.kind in ("relation", "wide", "comma", "text", "arrow") or box.name in ("+", "-", "pm", "mp"):
                terms.append([])
            else:
                terms[-1].append(box)

    look(row)
    every = list(all_boxes(row))
    bound = {each.name for box in every if box.kind == "big" for each in box.sub or ()}
    counts = [_indices(term) for term in terms if any(b.kind == "letter" for b in all_boxes(term))]
    lowered = [[b.name for box in all_boxes(term) for b in box.sub or ()] for term in terms]
    tensor = {name for name in TENSOR if not any(part.count(name) > 1 for part in lowered)}
    names = {name for count in counts for name, times in count.items() if times > 1} - bound - tensor
    for name in sorted(names):
        if not all(count[name] for count in counts) or all(count[name] > 1 for count in counts):
            yield "sum", f"the index {name} is not summed over", ""


def _indices(term: list[Box]) -> Counter[str]:
    found: Counter[str] = Counter()
    for box in all_boxes(term):
        if box.kind in ("letter", "partial", "nabla"):
            for script in (box.sub, None if power_in(box) and box.sup and box.sup[0].kind != "letter" else box.sup):
                if script and all(b.kind in ("letter", "comma", "thin") and len(b.name) < 9 for b in script):
                    names = [b.name for b in script if b.kind == "letter" and not b.upright and b.name in _INDICES]
                    found.update(names)
                    if box.sup and power_in(box) and [b.name for b in box.sup] == ["2"]:
                        found.update(names)
    return found
