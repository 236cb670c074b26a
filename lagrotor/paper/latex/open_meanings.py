r"""What of a print is evident: a reading is unmarked only where each sign in it has evidence for what it is read as.

Evident are signs of one meaning in all of physics (numbers, sums, fractions, roots, named functions of a bracket, derivatives
written in full), what the author declares, and what the paper shows: a letter is a number where it stands below a fraction
bar, a function where it has an argument. All else is marked. A marked reading is what custom takes; no verdict rests on a mark
but on that of log.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import pairwise

from lagrotor.paper.latex.boxes import FUNCTIONS, Box, is_printed_as_vector
from lagrotor.paper.latex.chapters import GROUPS, MEASURES, PROOFS, TAKEN
from lagrotor.paper.latex.formula_reader import FormulaReader, settled
from lagrotor.paper.latex.read_letter import is_called
from lagrotor.paper.latex.read_scripts import INDICES
from lagrotor.paper.latex.read_statements import is_set
from lagrotor.paper.latex.rows import (
    DEGREES,
    PARTING,
    TENSOR,
    UNITS,
    all_boxes,
    derivative_mark,
    has_differential_above,
    is_related,
    is_unit_like,
    letters_in_row,
    parted,
    strip,
    without_thin,
)
from lagrotor.paper.latex.usage import (
    index_of,
    is_number,
    is_plain_letter,
    power_in,
    stem_of,
    touch,
    unprimed,
)

# What is evident by itself, or marked where it is read; what it holds is looked at.
_EVIDENT = ("root", "infinity", "comma", "wide", "thin", "dots", "row", "rows", "group", "percent", "degree", "unit", "binomial",
            "cases", "accent", "matrix", "nabla", "partial", "fraction", "function", "number", "arrow")  # fmt: skip
_FACTORS = ("letter", "bracket", "fraction", "root", "accent", "function", "big", "nabla", "partial", "matrix", "group")
_RELATIONS = ("=", ":=", "<", ">", "<=", ">=", "!=", "<<", ">>", "propto")
_BOUNDS = frozenset(("<", ">", "<=", ">="))
_JOINING = "where with and for if when so then thus hence since but while also let in mit wobei und für wenn pour si avec où et"
_WORDS = frozenset(_JOINING.split())
_SPELT = frozenset(("or", "of", "max", "min", "out", "tot", "eff", "ref", "rms", "ext", "int", "opt"))
# Capitals that are amplitudes before a sine.
_AMPLITUDES = "ABCFINQRVWXYZ"
Marks = Iterator[tuple[str, str, str]]


def mark_open_meanings(reader: FormulaReader, row: list[Box], subject: str = "") -> None:
    """Add to the guesses of a reading what is not evident of signs beside each other; the rest is marked where it is read."""
    for key, what, settles in (*_subject(row, subject.split()), *_lists(row), *_row(reader, row), *_repeated(row)):
        reader.guess(key, what, settles)


def _letters(row: list[Box]) -> list[str]:
    return [b.name for b in all_boxes(row) if b.kind == "letter"]


def _subject(row: list[Box], subjects: list[str]) -> Marks:
    """What no sign says in a text about groups, measures or proofs: that letters are numbers, and what d is of."""
    boxes = all_boxes(row)
    letters = _letters(row)
    sets = any(
        b.style in ("cal", "scr", "frak") or b.name == "prod" or [c.name for c in b.sup or ()] == ["-", "1"]
        for b in boxes
    )
    if (GROUPS in subjects and letters) or (MEASURES in subjects and sets):
        yield GROUPS, TAKEN[GROUPS], ""
    elif PROOFS in subjects and letters:
        yield PROOFS, TAKEN[PROOFS], ""
    if MEASURES in subjects and ("d" in letters or any(b.name == "<<" for b in row)):
        yield MEASURES, TAKEN[MEASURES], ""


def _lists(row: list[Box]) -> Marks:
    """Bounds of several, as in 0 < x, y < 1, and what continues the display before."""
    parts = parted(without_thin(row), "comma")
    bounds = [any(b.kind == "relation" and b.name in _BOUNDS for b in part) for part in parts]
    if any(a and b and part[0].kind != "wide" for a, b, part in zip(bounds, bounds[1:], parts[1:], strict=False)):
        yield "list", "each bound holds for what is beside it alone", ""
    if row and all((b.kind == "letter" and b.name in UNITS) or b.name == "/" for b in without_thin(row)):
        yield "unit", "the letters are a quantity, and no unit", ""
    for part, after in pairwise(parted(without_thin(row), "wide")):
        last = [b for each in parted(part, "comma")[1:][-1:] for b in each]  # of a = b, u = x
        if after and after[0].kind == "relation" and any(b.kind == "relation" for b in last):
            yield "rows", "a row that begins with its sign continues what stands just before it", ""
    if row and row[0].kind == "operator" and row[0].name == "+":
        yield "continued", "the display begins with its sign, and continues none", ""
    for place in (k for k, b in enumerate(row) if b.name == "forall"):
        end = next(
            (k for k in range(place + 1, len(row)) if row[k].kind in PARTING and row[k].kind != "relation"), len(row)
        )
        names = {b.name for b in row[place:end] if b.kind == "relation"}
        if ("=" in names and names & _BOUNDS) or not is_related(row):
            yield "condition", "what holds for all ends where a space or a word does", ""


def _row(reader: FormulaReader, row: list[Box]) -> Marks:
    inner = without_thin(row)
    for place, box in enumerate(inner):
        check = _CHECKS.get(box.kind)
        if check is not None:
            yield from check(reader, inner, place)
        elif box.kind not in _EVIDENT:
            yield "sign", f"{reader.source[box.at : box.end]} has its usual meaning", ""
        after = _behind(inner, place)
        if after is not None and after.kind in _FACTORS:
            yield from _acting(reader, box, after, _behind(inner, place + 1))
        derived = box.kind == "fraction" and bool(derivative_mark(box))  # its d is of all that follows it
        for part in box.parts:
            yield from _row(reader, without_thin(part)[1:] if derived else part)
            derived = False
        if box.kind == "big":
            for part in _indices_below(box):
                yield from _row(reader, part)
        if box.sup and (box.kind == "big" or power_in(box)):
            yield from _row(reader, box.sup)
    yield from _apart(reader, row)
    yield from _names(reader, inner)
    yield from _matrices(inner)


def _indices_below(box: Box) -> Iterator[list[Box]]:
    """What stands below a sum but plain indices, 0 and x' of 0 < x' < 1; what a set or a pair ⟨ij⟩ lists, one by one."""
    for part in map(without_thin, parted(box.sub or [], "relation", "comma")):
        if len(part) == 1 and part[0].name in (r"\langle", r"\{", r"\lbrace"):
            part = [b for b in part[0].parts[0] if b.kind != "comma"]
        if not all(is_plain_letter(b) for b in part):
            yield part


def _behind(row: list[Box], place: int) -> Box | None:
    return row[place + 1] if place + 1 < len(row) else None


def _acting(reader: FormulaReader, box: Box, after: Box, then: Box | None) -> Marks:
    """What stands before a factor is a factor itself where its letters are numbers; else it may act on what follows."""
    known = reader.notation
    if box.kind == "letter":
        matrix = then is not None and (is_printed_as_vector(then) or then.kind == "matrix")
        matrix = matrix or (
            then is not None and then.kind in _FACTORS and stem_of(box) in known.matrices and then.name != "d"
        )
        if after.kind == "bracket" and matrix and not is_number(known, box):
            yield "matrix", f"{box.name} of its argument is a number, and no matrix", ""
        amplitude = after.kind == "function" and after.name in FUNCTIONS and box.name in _AMPLITUDES and not box.marks
        bracketed = after.kind == "bracket" and after.name in ("(", "[", r"\{")
        if box.name in ("Sigma", "Pi") and after.kind == "letter" and is_number(known, box):
            what = f"{box.name} is a factor of what follows, and no sum or product over it"
            yield "sum", what, settled(box.name, "letters")
        named = box.upright and (box.name in UNITS or box.name in FUNCTIONS)
        held = [] if amplitude or bracketed or named else [box]
    elif box.kind == "bracket" and box.name in ("(", "[", r"\{"):
        held = without_thin(box.parts[0])
        applied = [stem_of(b) for b in held if b.kind == "letter"]
        if after.kind == "bracket" and applied and {*applied} <= known.applied | known.differentiated:
            yield "bracket", "the brackets side by side are factors, and none is an argument", ""
    else:
        held = without_thin(box.parts[0]) if box.kind == "fraction" and not derivative_mark(box) else []
    for each in held:
        # steps, variations, products of a field with a form, covariant differentials: \Delta_\mu f, i_\xi\omega, d_A F
        stepping = each.name in ("Delta", "delta", "i", "iota", "d") and [b.kind for b in each.sub or ()] == ["letter"]
        calls = known.called.get(unprimed(each, index_of(each) or ()), set()) if each.kind == "letter" else set()
        if each.kind == "letter" and (stepping or after.name in calls or not is_number(known, each)):
            what = f"{each.name} is a factor of what follows, and no operator on it"
            yield "operator", what, settled(each.name, "letters")
            return
        if each.kind in ("nabla", "partial") or (each.kind == "fraction" and derivative_mark(each)):
            return


# ---- letters


def _letter(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    """A differential; what else a letter may be is marked where it is read."""
    box, after, then = row[place], _behind(row, place), _behind(row, place + 1)
    beside = [b for b in (row[place - 1] if place else None, after) if b is not None and b.name != "d"]
    known, stem = reader.notation, stem_of(box)
    if place and after is not None and after.kind == "bracket" and _is_shift(row[place - 1], [box, *after.parts[0]]):
        yield "operator", "what is of q or z is a factor of what is of the time, and no operator on it", ""
    if stem in known.maps - known.applied and any(b.kind in ("letter", "bracket") for b in beside):
        yield "operator", f"{box.name} is a factor, and no map of what is beside it", settled(box.name, "letters")
    content = after.parts[0] if after is not None and after.kind == "bracket" and box.name == "P" else []
    inside = after.parts[0] if after is not None and after.kind == "bracket" else []
    if [b.name for b in inside] == ["pi"] and "pi" not in known.numeric:
        yield "pi", "pi is the number, and nothing that the function is of", settled("pi", "numbers", "letters")
    events = [b.name.isupper() for b in content if b.kind == "letter"]
    if len(events) > 1 and all(events) and not any(b.kind == "comma" for b in content):
        yield "set", "P is of a sum or product of numbers, and of no events", ""
    if after is not None and after.kind == "matrix" and [b.name for b in box.sup or ()] == ["-", "1"]:
        yield "inverse", f"{box.name} before a matrix is a number, and no matrix that is inverted", ""
    if stem in known.sets - known.letters and any(b.kind == "letter" or b.name in ("/", *_BOUNDS) for b in beside):
        yield "set", f"{box.name} is a number, and no set or group", settled(box.name, "letters")
    if box.name == "e" and box.sup:
        yield from _exponent(reader, box.sup)
    if box.name != "d" or box.sub or after is None:
        return
    if box.style:
        yield "differential", "d is a factor, and no differential", ""
    if after.kind == "letter" and then is not None and then.kind in _FACTORS and then.name != "d":
        yield "differential", "the differential is of the letter that follows it alone", ""


def _is_shift(box: Box, content: list[Box]) -> bool:
    """Whether a factor has the letter of a transform, as A(q) or 1/A(q), and what follows has not, as y(t)."""
    held = [without_thin(b.parts[0]) for b in all_boxes([box]) if b.kind == "bracket"]
    letters = {part[0].name for part in held if len(part) == 1} & {"q", "z"}
    names = {b.name for b in content}
    return bool(letters and names & {"t", "k", "n"}) and not letters & names


def _function(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    """What exp is of, and ∇ that acts on nothing."""
    after = _behind(row, place)
    yield from _unapplied(after.parts[0] if after is not None and after.kind == "bracket" else [])
    if row[place].name != "exp" or after is None:
        return
    if after.kind == "bracket":
        yield from _exponent(reader, after.parts[0])
    elif any(b.kind == "operator" and b.name in ("+", "-") for b in row[place + 1 : place + 4]):
        yield "argument", "the argument of exp ends before the sign behind it", ""


def _binomial(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    r"""Of numbers and of letters that count; \binom{\nu}{e_L} is a column of two."""
    letters = [b for part in row[place].parts for b in all_boxes(part) if b.kind == "letter"]
    if any((len(b.name) > 1 and b.name != "alpha") or any(c.kind == "letter" for c in b.sub or ()) for b in letters):
        yield "binomial", "two in a bracket are a binomial, and no column", ""


def _root(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    yield from _unapplied(row[place].parts[0])


def _unapplied(row: list[Box]) -> Marks:
    """∇ that acts on nothing in what a function or a root is of: some print a letter so."""
    if any(b.kind == "nabla" and (k + 1 == len(row) or row[k + 1].kind == "operator") for k, b in enumerate(row)):
        yield "nabla", "∇ is an operator, and no letter", ""


def _exponent(reader: FormulaReader, content: list[Box]) -> Marks:
    """A capital above e may be an operator or a matrix, but where something is divided, as in E/kT."""
    row = without_thin(content)
    if any(b.kind == "fraction" or b.name == "/" for b in row):
        return
    for each, after in zip(row, [*row[1:], None], strict=True):
        called = after is not None and after.kind == "bracket"
        if each.kind == "bracket":
            yield from _exponent(reader, each.parts[0])
        elif each.kind == "letter" and each.name.isupper() and not called and not is_number(reader.notation, each):
            yield "operator", f"{each.name} is a number, and no operator", settled(each.name, "letters")


# ---- brackets and signs


def _bracket(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    box, content = row[place], without_thin(row[place].parts[0])
    belongs = place and (row[place - 1].kind, row[place - 1].name) == ("relation", "in")
    if box.name in ("(", "[", r"\{", r"\lbrace") and not (belongs and is_set(box)):
        yield from _enclosed(reader, box, row[place - 1] if place else None, content)
    if [b.name for b in box.sup or ()] == ["-", "1"]:
        if not all(is_number(reader.notation, b) for b in all_boxes(content) if b.kind == "letter"):
            yield "inverse", "the bracket with -1 is turned over, and no inverse matrix or function", ""
    elif box.sup and not power_in(box) and [b.name for b in box.sup] not in (["T"], ["top"]):
        yield "mark", "the superscript of a bracket is a mark", ""
    elif box.sup and any(b.kind == "letter" for b in box.sup):
        yield "power", "the superscript of a bracket is a power, and no index", ""
    if box.sub and box.name in ("(", "["):
        yield "index", "the index of a bracket takes a component, or holds what is constant", ""
    if {box.name, box.closing} & {r"\rangle", r"\langle", ">", "<", "⟨", "⟩"}:
        yield from _angles(reader, box, content)
    elif box.name == "." and box.sub and len(box.sub) == 1 and box.sub[0].kind == "letter":
        yield "at", f"the bar with {box.sub[0].name} says where, and not what is held constant", ""
    elif box.closing in ("|", r"\vert", r"\rvert") and box.name != ".":
        yield from _magnitude(reader, content)


def _enclosed(reader: FormulaReader, box: Box, before: Box | None, content: list[Box]) -> Marks:
    """Round, square and curly brackets that are no argument."""
    commas = sum(b.kind == "comma" for b in content)
    adds = any(b.kind == "operator" and b.name in ("+", "-", "pm", "mp") for b in content[1:])
    single = content[0] if len(content) == 1 and not box.sup else None
    if before is not None and before.kind in ("letter", "function"):
        if before.kind == "function" and box.name != "(" and not adds:
            yield "set", f"{box.name} encloses an argument, and no set or class", ""
    elif commas and (box.name == "(" or commas > 1 or not letters_in_row(content)):
        yield "list", "the brackets hold components, and no pair, interval or product", ""
    elif (
        box.name != "("
        and box.closing != "."
        and not commas
        and not (adds and any(b.kind == "bracket" for b in content))
    ):
        yield "set", f"{box.name} encloses a factor, and is no set, class or whole part", ""
    elif single and single.kind == "fraction" and "modular" in reader.notation.seen:
        yield "fraction", "the bracket holds a fraction, and no symbol of Legendre", ""
    elif single and single.kind in ("letter", "number") and not single.sup:
        yield "bracket", "the brackets enclose one sign as a factor, and no argument, class or ideal", ""


def _magnitude(reader: FormulaReader, content: list[Box]) -> Marks:
    known, letters = reader.notation, [b for b in all_boxes(content) if b.kind == "letter"]
    only = content[0] if len(content) == 1 and content[0].kind == "letter" else None
    shown = not only or is_printed_as_vector(only) or stem_of(only) in known.numeric
    shown = shown or (only is not None and stem_of(only) in known.factors and only.name[0].islower())  # |S| may count
    minor = [b.kind for b in content] == ["number"]  # |4|
    if minor or any(b.kind == "comma" for b in content) or not (shown and all(is_number(known, b) for b in letters)):
        yield "bars", "the bars are a magnitude, and no determinant or number of elements", ""


def _fraction(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    over, under = (without_thin(part) for part in row[place].parts)
    if (
        derivative_mark(row[place]) == "d"
        and {"P", "Q"} & {b.name for b in over}
        and {"mu", "nu"} & {b.name for b in under}
    ):
        yield MEASURES, TAKEN[MEASURES], ""


def _group(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    """A sum or product that no bracket encloses, beside a factor or below a power: {a + b}^2, or with a brace under it."""
    beside = [b for b in (row[place - 1] if place else None, _behind(row, place)) if b is not None]
    adds = any(b.kind == "operator" and b.name in ("+", "-", "pm", "mp") for b in row[place].parts[0][1:])
    if (adds and any(b.kind in (*_FACTORS, "number") for b in beside)) or (
        row[place].sup and len(row[place].parts[0]) > 1
    ):
        yield "bracket", "what no bracket encloses is one factor or base of a power", ""


def _bar(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    """A bar that is paired where it is read."""
    below = row[place].sub or []
    if len(below) == 1 and below[0].kind == "letter":
        yield "at", f"the bar with {below[0].name} says where, and not what is held constant", ""
    if any(b.name == "=" for b in below):  # (z - b) y(z)|_{z = b}
        side = parted([b for b in row[:place] if b.kind != "bar"], *PARTING)[-1]
        called = len(side) > 1 and side[-1].kind == "bracket" and side[-2].kind == "letter"
        if letters_in_row(side[: -2 if called else -1]) & letters_in_row(parted(below, "relation")[0]):
            yield "at", "the bar is of what stands just before it alone", ""
    closing = next((k for k in range(place + 1, len(row)) if row[k].kind == "bar"), place)
    yield from _magnitude(reader, row[place + 1 : closing])


def _angles(reader: FormulaReader, box: Box, content: list[Box]) -> Marks:
    """Labels of kets that are no single sign, and means outside quantum mechanics."""
    parts = parted(content, "bar", "comma")
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


def _operator(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    box, known = row[place], reader.notation
    before, after = (row[place - 1] if place else None), _behind(row, place)
    if box.name == "cdot" and reader.source[box.at] == ".":
        yield "cdot", "the full stop multiplies what it stands between", ""
    elif box.name == "cdot":
        beside = [b for b in (before, after) if b is not None]
        along = after is not None and after.kind == "nabla" and before is not None and not is_printed_as_vector(before)
        numbers = any(b.kind in ("number", "root", "function", "nabla") or not letters_in_row([b]) for b in beside)
        small = all(b.name[:1].islower() or stem_of(b) in known.crossed for b in beside)
        vectors = small and all(b.kind == "letter" and is_printed_as_vector(b) for b in beside)
        letters = [c for c in all_boxes(beside) if c.kind == "letter"]
        plain = known.arrows and not (known.raised or known.upper)  # vectors are marked, and these are none
        plain = plain and all(is_number(known, c) and c.name not in known.arrows for c in letters)
        plain = plain and (any(b.kind != "letter" for b in beside) or {*map(stem_of, letters)} <= known.numeric)
        if along or not (numbers or vectors or plain):
            yield "cdot", "the dot multiplies numbers or joins vectors as these are printed", ""
    elif box.name in ("pm", "mp") and any(
        b.kind in ("unit", "text") or (b.upright and len(b.name) > 1) for b in row[place:]
    ):
        yield "unit", "the unit belongs to the uncertainty alone", ""
    elif box.name not in ("+", "-", "pm", "mp", "/", "times", "!") or reader.source.startswith(r"\div", box.at):
        yield "sign", f"{box.name} has its usual meaning", ""


def _relation(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    box = row[place]
    printed = reader.source[box.at : box.end]
    if box.name not in _RELATIONS and printed not in (r"\approx", "≈"):
        yield "relation", f"{printed} is read as {box.name}", ""
    elif box.marks:
        yield "relation", f"what stands over {box.name} changes nothing", ""
    elif box.name == ":=" and printed == r"\equiv" and "modular" in reader.notation.seen:
        yield "relation", r"\equiv is a definition, and no congruence", ""
    elif box.name in "<>" and {b.name for b in row if b.kind == "relation"} >= {"<", ">"}:
        yield "relation", "< and > are relations, and no angle brackets", ""


def _text(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    box, before = row[place], row[place - 1] if place else None
    if before is not None and before.kind == "number" and is_unit_like(box.name):
        return
    if box.name.split(" ")[0].strip(",.;:").lower() not in _WORDS or re.search(r"[$\[\]*=+\\]", box.name):
        yield "words", f"the words {box.name} join statements, and are no factor or function", ""


def _big(reader: FormulaReader, row: list[Box], place: int) -> Marks:
    """Evident are a sum over one index with its first and last value or all, a limit, an integral that its differential ends."""
    box, below = row[place], without_thin(row[place].sub or [])
    rest = row[place + 1 : next((k for k in range(place + 1, len(row)) if row[k].kind in PARTING), len(row))]
    if "int" not in box.name and any(b.kind == "operator" and b.name in ("+", "-", "pm") for b in rest[1:]):
        yield "reach", f"the {box.name} is of the term that follows it alone", ""
    if "bar" in [b.kind for b in box.sup or ()]:
        yield "bars", "the bars are a magnitude, and no determinant or number of elements", ""
    if box.name in ("sum", "prod"):
        counted = len(below) > 2 and is_plain_letter(below[0]) and below[1].name == "=" and bool(box.sup)
        counted = counted and sum(b.kind == "relation" for b in below) == 1
        if not (counted or (len(below) == 1 and is_plain_letter(below[0]) and not box.sup)):
            yield "sum", f"what {box.name} runs over is as it is written", ""
    elif box.name == "int":
        over = [b.name for b in box.sub or ()]  # a letter for what is integrated over, of volumes and areas V and S
        measures = ("mu", "nu", "lambda", *("FGPQR" if len(over) == 1 and over[0] not in _AMPLITUDES else ()))
        variables = [b for a, b in pairwise(rest) if a.name == "d" and b.name in measures]
        inside = [b.name for b in all_boxes(rest)]
        place_d = next((k for k, b in enumerate(rest[:-1]) if b.name == "d" and rest[k + 1].kind == "bracket"), 0)
        apart = place_d and not {*_letters(rest[place_d + 1 : place_d + 2])} & {*_letters(rest[:place_d])}  # f d(a + b)
        if not box.sup and (apart or any(b.name in "FGPQR" or inside.count(b.name) == 1 for b in variables)):
            yield MEASURES, TAKEN[MEASURES], ""
        last = next((k for k, b in enumerate(rest) if b.kind == "big" or has_differential_above(b)), len(rest))
        ends = (k + 1 for k, b in enumerate(rest[:last]) if (b.kind, b.name, b.sup) == ("letter", "d", None))
        last = next(ends, last)
        behind = rest[last + 1] if last + 1 < len(rest) else None
        domain = len(below) == 1 and below[0].kind == "letter" and below[0].name[0].isupper()  # a body, its surface
        if bool(box.sub) != bool(box.sup) and not domain:
            yield "integral", "the integral is over what is written below it", ""
        followed = behind is not None and behind.kind in (*_FACTORS, "number")
        if last >= len(rest) or rest[last].kind == "big" or followed:
            yield "integral", "what follows the differential is integrated, and no factor of the whole", ""
    elif box.name != "lim":
        yield "integral", f"\\{box.name} is an integral over what is written below it", ""


_CHECKS: dict[str, Callable[[FormulaReader, list[Box], int], Marks]] = {
    "letter": _letter, "bracket": _bracket, "operator": _operator, "relation": _relation, "text": _text, "big": _big, "bar": _bar,
    "function": _function, "group": _group, "root": _root,
    "binomial": _binomial, "fraction": _fraction,
}  # fmt: skip


# ---- rows


def _apart(reader: FormulaReader, row: list[Box]) -> Marks:
    """Factors that are set apart by a space, and units in italics."""
    yield from _spaces(reader, row)
    for side in parted(without_thin(row), *PARTING):
        if len(side) < 2 or side[0].kind != "number":
            continue
        if side[-1].kind == "fraction" and side[-2].kind == "number":  # 9.81 m/s^2
            side[-1:] = [b for part in side[-1].parts for b in part]
        if [b.kind for b in side[:3]] == ["number", "operator", "number"] and side[1].name == "-" and len(side) < 5:
            yield "range", "the numbers are taken from each other, and are no ends of a range", ""
        letters = [b for b in side if b.kind == "letter"]
        if [b.name for b in side[-2:-1]] == ["-"] and side[-3].name.isupper() and side[-1].at == side[-2].end:  # J-s
            del side[-2]
        signs = [b for b in side if b.kind != "letter" and b.name not in ("/", "times", "cdot")]
        plain = not any(b.kind == "operator" or letters_in_row([b]) for b in signs)
        scale = letters and letters[0].name in ("C", "F") and {b.name for b in side[0].sup or ()} & DEGREES
        if letters and plain and not scale and not any(b.sub or b.upright for b in letters):
            names = [b.name for b in letters]
            joined = "".join(" " * (a.end != b.at) + b.name for a, b in pairwise([*letters[:1], *letters])).split()
            spaced = reader.source[side[0].end :].lstrip().startswith(r"\,") and all(len(name) == 1 for name in names)
            units = {*names[names[:1] == ["mu"] :]} - {"Omega"} <= UNITS or {*joined} <= UNITS
            if spaced or (units and not _is_no_unit(side, letters, names)):
                yield "unit", f"{letters[0].name} behind the number is a letter, and no unit", ""


def _is_no_unit(side: list[Box], letters: list[Box], names: list[str]) -> bool:
    """Whether letters behind a number are no unit: a litre or a gram has a prefix at most, 2mgl and 2ml² are products."""
    divided = any(b.name == "/" for b in side) or any(b.sup and b.sup[0].name == "-" for b in letters)
    litres = "l" in names and (names not in (["l"], ["m", "l"]) or bool(letters[-1].sup))
    grams = "g" in names and names[:2] != ["k", "g"] and names not in (["g"], ["m", "g"])
    return not divided and (litres or grams)


def _spaces(reader: FormulaReader, row: list[Box]) -> Marks:
    for place, box in enumerate(row[1:-1], 1):
        sides = row[place - 1].kind, row[place + 1].kind
        wide = box.kind == "thin" and reader.source[box.at : box.end] not in (r"\,", r"\!")
        closing = row[place + 1].name == "d" and any("int" in b.name for b in row[:place] if b.kind == "big")
        factors = {*sides} <= {*_FACTORS, "number", "thin"} and sides[1] != "big"
        if wide and factors and not closing:
            yield "spaces", "what a space parts are factors, and no list", ""
    ends = [k for k, b in enumerate(row) if b.kind in PARTING]
    for first, last in pairwise(ends):
        middle = row[first + 1 : last] if row[first].kind == row[last].kind == "relation" else []
        space = max((k for k, b in enumerate(middle) if b.kind == "thin"), default=0)
        behind = middle[space + 1 :] if space else []
        if not space and [b.kind for b in middle[-2:]] == ["fraction", "letter"] and letters_in_row(middle[-2:-1]):
            typed = reader.source[middle[-2].end : middle[-1].at].isspace()  # u = \frac{x}{r} v = \frac{y}{r}
            behind = middle[-1:] if typed else []
        if [b.kind for b in behind] in (["letter"], ["letter", "bracket"]) and behind[0].name != "d":
            yield "spaces", "what a space parts are factors, and no left side", ""
    names = [b.name for b in row if b.kind == "relation"]
    between = row[next((k for k, b in enumerate(row) if b.name == "="), 0) :]
    condition = next((k for k, b in enumerate(between) if b.name in _BOUNDS and b.kind == "relation"), 0)
    if "=" in names and {*names} & _BOUNDS and any(b.kind == "thin" for b in strip(between[1:condition])):
        yield "spaces", "what a space parts are factors, and no condition", ""


def _names(reader: FormulaReader, row: list[Box]) -> Marks:
    """Letters that touch each other are a product where each stands alone in the paper, and they are no row of capitals."""
    run: list[Box] = []
    for place, box in enumerate([*row, Box("thin", "", -2, -2)]):
        letter = box.kind == "letter" and len(box.name) == 1 and not (box.style or box.upright or box.marks)
        if run and not (letter and touch(run[-1], box)):
            name = "".join(each.name for each in run)
            called = box.kind == "bracket" and box.name == "(" and is_called(reader, run[-1], box) is True
            short = len(name) < 3 or (len(name) == 3 and name[:2] == "mg")  # of three letters names are as frequent
            stands = {*name[:-1], name[-1] + "_" * bool(run[-1].sub)} <= reader.notation.apart
            product = short and stands and not (name[0].isupper() and name[1:].islower())
            first = row[place - len(run) - 1] if place > len(run) else run[0]
            below = "".join(b.name for b in first.sub or ()) + name if first.end == run[0].at else ""  # \lambda_max
            product = product and not {name, below} & _SPELT
            if len(run) > 1 and name[0] != "d" and (called or name.isupper() or not product):
                yield "name", f"{name} is a product, and no name", ""
            run = []
        if letter:
            run.append(box)
        before, behind = (row[n] if 0 <= n < len(row) else None for n in (place - 1, place + 1))
        exponent = behind is not None and behind.kind in ("number", "operator") and behind.at == box.end
        if (
            exponent
            and before is not None
            and box.name in ("e", "E")
            and before.kind == "number"
            and before.end == box.at
        ):
            yield "e", f"{box.name} behind a number is a letter, and no power of ten", ""


def _matrices(row: list[Box]) -> Marks:
    """Products of vectors side by side, and what stands between two."""
    product: list[Box] = []
    for box in [*row, Box("relation", "", 0, 0)]:
        if box.kind in ("letter", "bracket", "fraction", "accent", "root", "group", "matrix"):
            product.append(box)
        elif box.name not in ("cdot", "times", "!"):
            vectors = [k for k, b in enumerate(product) if b.kind == "letter" and is_printed_as_vector(b)]
            inner = product[vectors[0] : vectors[-1]] if vectors else []
            if any(b.kind == "letter" and not is_printed_as_vector(b) for b in inner):
                yield "matrix", "the letter between two vectors is a number, and no matrix", ""
            product = []
    vector = [b.kind == "letter" and is_printed_as_vector(b) for b in row]
    if (True, True) in pairwise(vector):
        yield "matrix", "two that are printed as vectors side by side are matrices", ""


def _repeated(row: list[Box]) -> Marks:
    """An index that a term has twice and another has not: a sum over it may be meant."""
    terms: list[list[Box]] = [[]]

    def look(part: list[Box]) -> None:
        for box in part:
            if box.kind in ("rows", "row"):
                for cell in box.parts:
                    look(cell)
                terms.append([])
            elif box.kind in PARTING or box.name in ("+", "-", "pm", "mp"):
                terms.append([])
            else:
                terms[-1].append(box)

    look(row)
    bound = {each.name for box in all_boxes(row) if box.kind == "big" for each in box.sub or ()}
    for box in all_boxes(row):
        below = [b.name for b in box.sub or () if b.name in INDICES - bound]
        if box.kind == "letter" and len(below) > len({*below}) and len(below) > 2:
            yield "sum", f"an index of {box.name} is not summed over", ""
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
        if box.kind == "bracket" and box.closing in (r"\rangle", ">") and len(box.parts[0]) == 1:  # d_{ab}|a⟩|b⟩
            found.update(b.name for b in box.parts[0] if b.name in INDICES)
        if box.kind in ("letter", "partial", "nabla"):
            for script in (box.sub, None if power_in(box) and box.sup and box.sup[0].kind != "letter" else box.sup):
                if script and all(b.kind in ("letter", "comma", "thin", "number") and len(b.name) < 9 for b in script):
                    names = [b.name for b in script if b.kind == "letter" and not b.upright and b.name in INDICES]
                    found.update(names)
                    if box.sup and power_in(box) and [b.name for b in box.sup] == ["2"]:
                        found.update(names)
    return found
