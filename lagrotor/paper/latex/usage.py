r"""How a paper uses its letters: which are functions, whether e and i are numbers, whether d is a differential.

What the print does not settle is a question to the author, who answers in `paper.toml`:
[notation] functions = "f V", letters = "e", numbers = "i", decimal_comma = true.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from keyword import iskeyword
from typing import Any

from lagrotor.errors import InputError
from lagrotor.paper.latex.boxes import Box, FormulaError, boxes, is_printed_as_vector
from lagrotor.paper.latex.rows import PARTING, TENSOR, all_boxes, is_moving, parted, without_thin
from lagrotor.paper.letters import FUNCTIONS as CALLED

_BEHIND = ("operator", "relation", "function", "bracket", "comma", "wide", "fraction")
# What a δ or Δ before it is no factor of: a difference, a variation, a function of the bracket.
ACTED_ON = ("letter", "bracket", "fraction", "accent", "group", "big", "partial", "nabla", "root")
_OF_NUMBERS = ("sin", "cos", "tan", "ln", "log", "exp")
# Letters that custom has as numbers, and those of a sign of its own.
_NUMBERS = frozenset(["e", "i", "pi", "hbar", "ell", "d", "delta", "Delta", "imath", "prime"])
_KEYS = ("functions", "letters", "numbers", "usual", "decimal_comma")
_UPRIGHT = ("T", "H", "t", "d", "e", "i", "j")  # transposed, or a number, though upright
_ABOVE = frozenset([*TENSOR, "alpha", "beta", "gamma", "i", "j", "k", "l", "m", "a", "b", "c"])
_TIMES = ("tau", "lambda", "s", "sigma", "T", "eta")


@dataclass
class Notation:
    """What was seen of a paper's letters.

    called: letter → letters that were seen as its arguments; bare: letters seen without a bracket behind them; angles: whole
    arguments of sine and cosine; lowered: indices; spelled: letter with its index → how the index is printed; declared: what
    the author says; usual: kinds of guesses that the author settles as custom has them. Of letters seen elsewhere: applied,
    before what may be an argument; elsewhere, before another than t; factors, in a product; apart, touching no other letter,
    x_ with an index; raised, with an index above; differentiated; matrices; sets, and maps; primed, with and without it in one
    list; twice, with two primes. varied: letter → letters that it is differentiated by. seen: ket, operators, order, hessian,
    P(D), complex, modular, exponent, dot, other time, times, momentum (pi), wedge (of ∇). crossed: vectors, beside a cross or a
    nabla; arrows: letters that are printed as vectors somewhere. equal: letters and what they are equal to. numeric: letters
    that are numbers, below a fraction bar, a root, in a sine or a logarithm, equal to numbers. upper: letters that stand above
    where no power can, as in \\partial x^i and T^{ij}, or below \\partial; above, alone above a letter; exponents: letters in
    powers; paired: g of g_{ij}; pairs: letter → letters of g^{ab}; entries: x of x[n]. made: formula → its boxes, or what
    stopped them.
    """

    called: dict[str, set[str]] = field(default_factory=dict)
    bare: set[str] = field(default_factory=set)
    spelled: dict[str, set[str]] = field(default_factory=dict)
    angles: set[str] = field(default_factory=set)
    lowered: set[str] = field(default_factory=set)
    functions: frozenset[str] = frozenset()
    letters: frozenset[str] = frozenset()
    numbers: frozenset[str] = frozenset()
    decimal_comma: bool | None = None
    imaginary: bool = False
    exponential: bool = False
    usual: frozenset[str] = frozenset()
    applied: set[str] = field(default_factory=set)
    elsewhere: set[str] = field(default_factory=set)
    factors: set[str] = field(default_factory=set)
    apart: set[str] = field(default_factory=set)
    raised: set[str] = field(default_factory=set)
    differentiated: set[str] = field(default_factory=set)
    matrices: set[str] = field(default_factory=set)
    sets: set[str] = field(default_factory=set)
    maps: set[str] = field(default_factory=set)
    primed: set[str] = field(default_factory=set)
    twice: set[str] = field(default_factory=set)
    crossed: set[str] = field(default_factory=set)
    arrows: set[str] = field(default_factory=set)
    numeric: set[str] = field(default_factory=set)
    upper: set[str] = field(default_factory=set)
    above: set[str] = field(default_factory=set)
    exponents: set[str] = field(default_factory=set)
    paired: set[str] = field(default_factory=set)
    pairs: dict[str, set[str]] = field(default_factory=dict)
    entries: set[str] = field(default_factory=set)
    equal: list[tuple[Box, list[Box]]] = field(default_factory=list)
    varied: dict[str, set[str]] = field(default_factory=dict)
    seen: set[str] = field(default_factory=set)
    made: dict[str, list[Box] | FormulaError] = field(default_factory=dict)

    def boxes(self, latex: str) -> list[Box]:
        """The boxes of a formula, made once and not to be changed. Raises FormulaError at a token that has no place."""
        if (made := self.made.get(latex)) is None:
            try:
                made = boxes(latex)
            except FormulaError as stop:
                made = stop
            except RecursionError:
                made = FormulaError(0, "the formula is nested too deeply", "write it in parts")
            self.made[latex] = made
        if isinstance(made, FormulaError):
            raise made.with_traceback(None)
        return made

    def is_function(self, box: Box) -> bool:
        """Whether the paper has a letter before an argument, or differentiates it."""
        stem = stem_of(box)
        return stem in self.applied or stem in self.differentiated or box.name in self.functions

    @property
    def pi_is_letter(self) -> bool:
        """Whether pi has an index or a mark somewhere, or arguments, or is a momentum."""
        marked = any(name.startswith("pi") and name != "pi_" for name in self.bare)
        return "pi_" in self.called or "momentum" in self.seen or marked


def declared_notation(given: Mapping[str, Any], where: str = "paper.toml") -> Notation:
    """What the author says in [notation]. Raises InputError for a key that means nothing."""
    if unknown := sorted(given.keys() - set(_KEYS)):
        raise InputError(f"{where}: notation: {unknown[0]!r} means nothing here: the keys are {', '.join(_KEYS)}")
    functions, letters, numbers, usual = (
        frozenset(str(given.get(key, "")).replace(",", " ").split()) for key in _KEYS[:4]
    )
    comma = given.get("decimal_comma")
    return Notation(functions=functions, letters=letters, numbers=numbers, usual=usual, decimal_comma=comma)


def notation_of(formulas: Iterable[str], said: Notation | None = None) -> Notation:
    """How the formulas of a paper use their letters."""
    found = said or Notation()
    for latex in formulas:
        if "mod" in latex and any(name in latex for name in (r"\pmod", r"\bmod", r"\mod", "{mod")):
            found.seen.add("modular")
        try:
            row = found.boxes(latex)
        except FormulaError:
            continue
        _look(row, found)
    if found.imaginary:
        found.seen.add("complex")
    for stem, names in found.pairs.items():  # of what has two indices below no power stands above
        (found.upper if stem in found.paired else found.exponents).update(names)
    found.upper |= {  # what is no factor anywhere, and stands below as well or in a theory of tensors
        name
        for name in found.above & {*TENSOR, *found.lowered} - found.exponents
        if not {name, f"{name}_"} & found.bare
    } - ({"lambda"} if "lamda" in found.bare else set())
    found.primed -= found.applied | found.twice  # y and y' of a differential equation
    if "dot" in found.seen and "other time" in found.seen:
        found.seen.add("times")
    for letter, side in found.equal:
        found.numeric |= _names(letter) if is_value(side, found) else set()
        rate = any(map(is_moving, side)) if letter.name == "pi" else is_moving(letter)
        if rate and "pi" in (letter.name, *(b.name for b in side[:1] if len(side) == 1)):
            found.seen.add("momentum")
    return found


def letters_printed(latex: str, known: Notation) -> set[str]:
    """The letters of a formula, whether it is read or not; none where it falls into no parts."""
    try:
        return {unscripted(box) for box in all_boxes(known.boxes(latex)) if box.kind == "letter"}
    except FormulaError:
        return set()


def stem_of(box: Box) -> str:
    """A letter with its font and without its marks, indices and primes."""
    return box.name + box.style


def touch(first: Box, second: Box) -> bool:
    """Whether a letter touches the next, as in a name: capitals do in print, whatever spaces are typed."""
    letters = is_plain_letter(first) and second.kind == "letter"
    return letters and (first.end == second.at or (first.name.isupper() and second.name.isupper()))


def is_plain_letter(box: Box) -> bool:
    """Whether a box is an italic letter without marks and scripts."""
    plain = box.kind == "letter" and len(box.name) == 1 and not (box.style or box.upright or box.marks or box.primes)
    return plain and box.sub is None and box.sup is None


def power_in(box: Box) -> bool:
    """Whether a superscript is read as a power, and not as part of a name."""
    row = without_thin(box.sup or [])
    if not row or (len(row) == 2 and row[1].name in ("dagger", "*")):
        return False
    if len(row) == 1:
        only = row[0]
        if only.kind in ("operator", "text") or only.name in ("dagger", "top", "intercal", "prime", "T"):
            return False
        if only.kind == "letter" and (only.upright or (is_printed_as_vector(box) and box.name.islower())):
            return only.name in _UPRIGHT  # another upright letter is a label, and so is one over a vector
        return not (only.kind == "bracket" and len(only.parts[0]) == 1)
    listed = any(b.kind == "comma" for b in row)
    return not (
        box.kind == "letter"
        and (listed or all(is_plain_letter(b) or (b.kind == "letter" and b.name in TENSOR) for b in row))
    )


def upper_index(known: Notation, box: Box) -> list[str]:
    """The letters above, where the paper has each as an index above and none in a power; empty where they are none."""
    row = without_thin(box.sup or []) if box.name != "e" else []
    if [b.name for b in row] == ["0"] and box.kind == "letter" and (box.sub or box.marks or known.upper & {*TENSOR}):
        return ["0"]
    plain = all(b.kind == "letter" and not (b.sub or b.sup or b.marks or b.upright) for b in row)
    names = {b.name for b in row}
    label = names - {"T"} if box.sub and len(row) == 1 and row[0].name.isupper() else set()  # \phi^A_i and no A
    upper = (known.upper | (label - known.bare - known.numeric)) - known.exponents - known.letters
    return [b.name + "prime" * b.primes for b in row] if plain and names <= upper else []


def name_of(box: Box, index: Iterable[str] = (), raised: Iterable[str] = ()) -> str:
    r"""theta_1_dot for \dot\theta_1, rvec_1 for \vec r_1, T__mu_nu for T^{\mu\nu}: a name that Python and sympy take."""
    return _named(box, list(box.marks), box.primes, index, raised)


def unscripted(box: Box, index: Iterable[str] = ()) -> str:
    """A letter with its font and marks, without dots, scripts and primes; or with an index."""
    return _named(box, [mark for mark in box.marks if not mark.endswith("dot")], 0, index)


def unprimed(box: Box, index: Iterable[str] = ()) -> str:
    """A letter with its font, marks, dots and an index."""
    return _named(box, list(box.marks), 0, index)


def _named(box: Box, marks: list[str], primes: int, index: Iterable[str], raised: Iterable[str] = ()) -> str:
    name = {"lambda": "lamda"}.get(box.name, box.name) + box.style
    rates = 0
    if marks:
        vectors = marks.count("vec")
        marks = [mark for mark in marks if mark != "vec"]  # the innermost first: the rate of a mean, no mean of a rate
        while marks and marks[-1].endswith("dot"):
            rates += len(marks.pop()) - len("ot")
        name += "vec" * vectors + "".join(marks)
    if primes:
        name += "prime" * primes
    for part in raised:
        name += f"__{part}"
    for part in index:
        name += f"_{part}"
    if rates:
        name += f"_{'d' * rates}ot"
    planck = name == "hbar" and box.name == "h"  # a mean h is no ħ
    return f"{name}_" if name in CALLED or iskeyword(name) or planck else name


def index_of(box: Box) -> list[str] | None:
    """The parts of an index, such as ["1"], ["cm"] or ["i", "j"]; None where it is no index of letters and numbers."""
    if not box.sub:
        return []
    found: list[str] = []
    alone = True  # a comma or a Greek letter ends a run of letters
    for part in box.sub:
        if part.kind == "comma" and part.name == ".":
            return None
        if part.kind in ("comma", "thin"):
            alone = alone or part.kind == "comma"
            continue
        inner = _index(part)
        if inner is None:
            return None
        greek = part.kind == "letter" and len(part.name) > 1 and not part.upright
        if alone or greek or len(inner) != 1 or not found:
            found += inner
        else:
            found[-1] += inner[0]
        alone = greek
    return found


def _index(part: Box) -> list[str] | None:
    """The text of one box of an index."""
    if part.sup is not None and part.kind != "letter":
        return None
    if part.sub is not None and part.kind != "letter":  # {t,1}_D, 1_a
        inner, own = _index(replace(part, sub=None)), index_of(part)
        return None if inner is None or own is None else [*inner, *own]
    if part.kind == "letter":
        own = index_of(part)
        raised = "" if part.sup is None else _plain(part.sup)
        if own is None or raised is None:
            return None
        return [part.name + part.style + "prime" * part.primes + "".join(part.marks) + raised, *own]
    if part.kind == "number":
        return [part.name.replace(".", "p")] if "," not in part.name else None
    if part.kind == "text":
        if "\\" in part.name:
            return None
        name = "".join(c for c in part.name if c.isalnum())
        return [name] if name and len(name) <= 24 else None
    if part.kind == "infinity":
        return ["inf"]
    if part.kind == "operator":
        named = {"+": "plus", "-": "minus", "*": "star", "cdot": "dot", "/": "over"}.get(part.name, part.name)
        return [named] if named.isalpha() else None
    if part.kind in ("group", "fraction"):  # i + 1/2
        held = [_plain(each) for each in part.parts]
        return None if None in held else ["over".join(map(str, held))]
    if part.kind in ("function", "unit"):
        return [part.name] if part.name.isalnum() else None
    if part.kind == "relation" and part.name in ("=", "->"):
        return ["eq" if part.name == "=" else "to"]
    return None


def _spelling(row: list[Box]) -> str:
    """An index as it is printed, without spaces and fonts."""
    text = ""
    for box in without_thin(row):
        inner = f"({', '.join(map(_spelling, box.parts))})" if box.parts else ""
        text += (
            box.name
            + inner
            + "".join(f"{sign}({_spelling(row)})" for sign, row in (("_", box.sub), ("^", box.sup)) if row)
        )
    return text


def _plain(row: list[Box]) -> str | None:
    """Boxes as one word; None where one is no letter or number."""
    parts = [_index(each) for each in row if each.kind not in ("thin", "comma")]
    return None if None in parts else "".join(word for part in parts for word in part or ())


def simple_argument(row: list[Box]) -> bool:
    """Whether what is in brackets is what functions are called with: letters, numbers and their products, a list of them."""
    inner = without_thin(row)
    kinds = {box.kind for box in inner}
    if not inner or not kinds <= {"letter", "number", "comma"}:
        return False
    if any(box.sup is not None for box in inner):
        return False
    return "comma" in kinds or len(inner) <= 2


def _look(row: list[Box], found: Notation) -> None:
    inner = without_thin(row)
    for place, box in enumerate(inner):
        following = inner[place + 1] if place + 1 < len(inner) else None
        _look_about(inner, place, following, found)
        if box.kind == "letter":
            _look_at_letter(box, following, found, alone=len(inner) == 1)
        if box.kind in ("letter", "partial", "nabla"):
            found.lowered.update(b.name for b in box.sub or () if b.kind == "letter")
            if box.sub and (index := index_of(box)) is not None:
                found.spelled.setdefault("_".join((box.name, *index)), set()).add(_spelling(box.sub))
        elif box.sub is not None:
            _look(box.sub, found)
        if box.name == "exp" and following is not None and following.kind == "bracket":
            found.imaginary |= _is_multiple_of_i(following.parts[0])
        if box.kind == "function" and following is not None and following.kind == "letter":
            after = inner[place + 2] if place + 2 < len(inner) else None
            if after is None or (after.kind in _BEHIND and after.name != "/"):
                found.angles.add(following.name)
        marked = box.kind == "letter" and box.sup is not None and len(box.sup) == 1 and box.sup[0].kind == "bracket"
        if box.sup is not None and not marked and any(each.kind != "letter" or each.sub for each in box.sup):
            _look(box.sup, found)  # letters alone may be indices
        if box.kind == "fraction" and box.parts[0] and box.parts[1]:
            ends = {"i", "hbar"} == {box.parts[0][0].name, box.parts[1][0].name} and len(box.parts[1]) == 1
            found.imaginary = found.imaginary or ends
        for part in box.parts:
            _look(part, found)


def _look_about(row: list[Box], place: int, after: Box | None, found: Notation) -> None:
    """What the neighbours of a box say of it."""
    box, before = row[place], row[place - 1] if place else None
    _look_above(box, found)
    transposed = box.sup and [b.name for b in without_thin(box.sup)] in (["T"], ["top"], ["dagger"], ["intercal"])
    if transposed and any(b.kind == "nabla" for part in box.parts for b in part):
        found.seen.add("hessian")
    if transposed and "vec" not in box.marks:
        found.matrices |= {stem_of(box)} if box.kind == "letter" else _held(box)
    if box.sup and [b.name for b in box.sup] == ["dagger"]:
        found.seen.add("operators")
    if box.name == "pi" and before is not None and before.kind == "number":
        found.numeric.add("pi")
    _look_at_number(box, after, found)
    if box.kind == "function":
        _look_at_function(box, after, found)
    if box.kind in ("nabla", "partial") and after is not None and after.kind == "letter":
        found.differentiated.add(stem_of(after))
    if box.name == "wedge" and before is not None and before.kind == "nabla":
        found.seen.add("wedge")
    if box.kind == "bracket":
        _look_at_bracket(box, before, after, found)
    elif box.kind == "relation" and before is not None and after is not None:
        _look_at_relation(row, place, found)
    elif box.name == "times" or (box.name == "cdot" and before is not None and before.kind == "nabla"):
        found.crossed |= {stem_of(b) for b in (before, after) if b is not None and is_printed_as_vector(b)}
    elif box.kind == "fraction":
        _look_at_derivative(box, after, found)
    elif box.kind == "letter":
        _look_beside(box, before, after, found)


def _look_at_function(box: Box, after: Box | None, found: Notation) -> None:
    """What a function by name says of the letters that it is of."""
    if box.name in ("Re", "Im", "arg"):
        found.seen.add("complex")
    if box.name in ("det", "tr", "Tr", "rank", "ker", "diag") and after is not None:
        inside = without_thin(after.parts[0]) if after.kind == "bracket" else [after]
        found.seen |= {"hessian"} if any(b.kind == "nabla" and b.sup for b in inside) else set()
        found.matrices |= {stem_of(b) for b in inside if b.kind == "letter" and (len(inside) == 1 or b.name.isupper())}


def _look_above(box: Box, found: Notation) -> None:
    """Letters above and below of which the place says whether they are indices or powers."""
    if box.kind in ("partial", "nabla") and box.sub and len(box.sub) == 1:
        found.upper |= {b.name for b in box.sub} & _ABOVE
    if box.kind == "letter" and box.sub and sum(b.kind == "letter" for b in box.sub) > 1:
        found.paired.add(stem_of(box))
    if box.sup:
        above = without_thin(box.sup)
        names = {b.name for b in above if b.kind == "letter" and not b.upright}
        power = box.kind != "letter" or len(above) > 1 or box.name in ("d", "e")
        listed = box.kind == "letter" and box.name not in ("d", "e") and len(names) == len(above) > 1
        if listed and (names <= set("ijkl") or names <= set(TENSOR)):
            found.upper |= names
        elif listed and len(names) == 2 and names <= set("abcdefijklmnpqrs"):
            found.pairs.setdefault(stem_of(box), set()).update(names)
        elif power:
            large = {b.name for b in _printed_large(above) if b.kind == "letter"}
            found.exponents |= large - ({"i", "j"} if box.name == "e" else set())  # the imaginary unit
        elif len(names) == len(above) == 1 and not (above[0].sub or above[0].sup or above[0].primes):
            pair = box.sub and len(box.sub) == 1 and is_plain_letter(box.sub[0])
            found.raised |= {stem_of(box)} if box.name.isupper() and names <= set("abc") else set()
            found.above |= names & {*TENSOR, *"abcijk", *("pqrs" if pair else "")}
    if box.kind == "fraction":
        over, under = (without_thin(part) for part in box.parts)
        if over and under and over[0].kind == under[0].kind == "partial" and over[0].sup is None:
            raised = [b for each in under[1:2] for b in each.sup or () if b.kind == "letter"]
            found.upper |= {b.name for b in raised if not (b.sub or b.sup)} & _ABOVE


def _printed_large(row: list[Box]) -> list[Box]:
    """The boxes of a row and what they hold, without scripts."""
    return [each for box in row for each in (box, *(inner for part in box.parts for inner in _printed_large(part)))]


def _look_at_number(box: Box, after: Box | None, found: Notation) -> None:
    """A letter that stands where only a number can."""
    held: list[Box] = []
    if box.kind in ("fraction", "root"):
        held = without_thin(box.parts[1] if box.kind == "fraction" else box.parts[0])
        if any(b.kind == "bar" or (b.kind == "operator" and b.name not in ("cdot", "times")) for b in held):
            held = []  # a resolvent, a number of elements
    elif box.name == "/" and after is not None:
        held = [after]
    elif box.kind == "big" and box.sub and box.sup:
        held = [b for part in (box.sub, box.sup) if all(b.kind != "bar" for b in part) for b in part]  # but of |S|
    elif box.kind == "function" and box.name in _OF_NUMBERS[:-1] and after is not None:
        held = without_thin(after.parts[0]) if after.kind in ("bracket", "fraction") else [after]
    for each in held:
        found.numeric |= _names(each)


def _names(box: Box) -> set[str]:
    """The name of a letter with its index, and without."""
    return {unscripted(box), unprimed(box, index_of(box) or ())} if box.kind == "letter" else set()


def is_value(row: list[Box], known: Notation) -> bool:
    """Whether a row is a number other than 0 and 1, or arithmetic of numbers and of letters that are numbers."""
    row = without_thin(row)
    one = [box.name for box in row] in (["0"], ["1"])  # of a ring
    return bool(row) and not one and all(_is_arithmetic(box, known) for box in row)


def _is_arithmetic(box: Box, known: Notation) -> bool:
    """Whether a box is a sign, a number or a letter that is one, or a bracket, fraction or root of such."""
    if box.kind == "letter":
        return box.name != "d" and is_number(known, box) and power_in(box) == bool(box.sup)
    signs = ("+", "-", "/", "cdot", "pm", "(", *_OF_NUMBERS)
    return (box.name in signs or box.kind in ("number", "fraction", "root")) and all(
        _is_arithmetic(each, known) for part in (*box.parts, box.sup or []) for each in part if each.kind != "thin"
    )


def is_number(known: Notation, box: Box) -> bool:
    """Whether a letter is evidently a number, or a vector that no operator can be.

    As a number it stands below a fraction bar, under a root, in a sine or a logarithm, or is equal to numbers; small letters
    are numbers by custom, but in a paper that has operators.
    """
    stem = stem_of(box)
    if (box.name in _NUMBERS and not box.marks) or any(
        {box.name, stem} & said for said in (known.letters, known.numbers)
    ):
        return True
    if stem in known.matrices | known.sets:
        return False
    operators = bool(known.seen & {"ket", "operators"})
    if is_printed_as_vector(box):
        return not operators and (not box.name[0].isupper() or stem in known.crossed or "vec" in box.marks)
    plain = not (
        box.upright or box.style in ("cal", "scr", "frak", "bb") or any(not m.endswith("dot") for m in box.marks)
    )
    own = unprimed(box, index_of(box) or ()) if operators else unscripted(box)
    return own in known.numeric or (plain and not operators and box.name[0].islower())


def _look_at_relation(row: list[Box], place: int, found: Notation) -> None:
    """A letter that is equal to a matrix or one of R^(m x n), and what a letter is equal to."""
    before, box, after = row[place - 1 : place + 2]
    alone = place + 2 >= len(row) or row[place + 2].kind not in ("letter", "bracket")
    if box.name == "in" and alone and is_plain_letter(after) and after.name.isupper():
        found.sets.add(stem_of(after))
    if box.name == "->" and place > 1 and row[place - 2].name == ":":  # a map: of what, and to what
        ends = row[place - 1 : next((k for k in range(place + 1, len(row)) if row[k].kind in PARTING), len(row))]
        found.maps |= {stem_of(b) for b in row[max(place - 3, 0) : place - 2] if b.kind == "letter"}
        found.sets |= {stem_of(b) for b in ends if b.kind == "letter" and b.name.isupper()}
    called = before.kind == "bracket" and place > 1 and row[place - 2].kind == "letter"  # U(t) = (…)
    before = row[place - 2] if called else before
    if before.kind != "letter" or (place > 1 + called and row[place - 2 - called].kind not in (*PARTING, "matrix")):
        return
    end = next((k for k in range(place + 1, len(row)) if row[k].kind in PARTING), len(row))
    found.equal += [(before, row[place + 1 : end])] if box.name in ("=", ":=") and not called else []
    inside = [after, *(each for part in after.parts for each in part)]
    real = box.name == "in" and after.style == "bb" and any(b.name == "times" for b in after.sup or ())
    if "vec" not in before.marks and (real or any(b.kind == "matrix" for b in inside)):
        found.matrices.add(stem_of(before))


def _held(box: Box) -> set[str]:
    """The letters in a box, without those that are printed with an arrow."""
    letters = (b for part in box.parts for b in all_boxes(part) if b.kind == "letter")
    return {stem_of(b) for b in letters if "vec" not in b.marks}


def _look_at_bracket(box: Box, before: Box | None, after: Box | None, found: Notation) -> None:
    content = box.parts[0]
    if [b.name for b in box.sup or ()] == ["-", "1"] and any(b.name in ("+", "-") for b in content[1:]):  # a resolvent
        found.matrices |= {
            stem_of(b) for b in content if b.kind == "letter" and b.name.isupper() and not (b.sub or b.sup)
        }
    if box.closing == r"\rangle" and (box.name == "|" or any(b.kind == "bar" for b in content)):
        found.seen.add("ket")
    if box.name == "[" and sum(b.kind == "comma" for b in content) == 1 and _is_commutator(content, before, after):
        found.matrices |= _held(box)
        found.seen.add("operators")
    letters = [b for b in content if b.kind == "letter" and any(c.kind == "comma" for c in content)]
    found.primed |= {stem_of(b) for b in letters if b.primes} & {stem_of(b) for b in letters if not b.primes}


def _is_commutator(content: list[Box], before: Box | None, after: Box | None) -> bool:
    """Whether a list of two is a factor or a side, and no interval."""
    ends = arguments(content)[0], content[-1:]
    if any(b.kind in ("number", "infinity") for part in ends for b in without_thin(part)[-1:] if len(part) == 1):
        return False
    beside = ("relation", "operator", "letter", "fraction")
    joined = after is not None and after.kind in beside and after.name not in ("->", "subset", "times")
    return (before is None or before.kind not in ("letter", "function")) and (
        joined or (before is not None and before.kind in beside and before.name not in ("in", "subset", "times", "->"))
    )


def _look_at_derivative(fraction: Box, after: Box | None, found: Notation) -> None:
    over, under = (without_thin(part) for part in fraction.parts)
    if not (over and len(under) > 1 and over[0].name == under[0].name and over[0].kind in ("partial", "letter")):
        return
    operands = over[1:] or ([after] if after is not None else [])
    found.differentiated |= {stem_of(b) for b in operands if b.kind == "letter" or not over[1:]}
    for each in (b for b in under if b.name not in _NUMBERS):
        found.numeric |= _names(each)
    if any(b.name == "pi" for b in under):
        found.seen.add("momentum")
    for box in operands:
        found.varied.setdefault(stem_of(box), set()).update(b.name for b in under if b.kind == "letter")
    if over[0].name == "d" and (under[1].name in _TIMES or (under[1].name == "t" and under[1].sub)):
        found.seen.add("other time")


def _look_beside(box: Box, before: Box | None, after: Box | None, found: Notation) -> None:
    stem, sup = stem_of(box), without_thin(box.sup) if box.sup else []
    if is_printed_as_vector(box):
        found.arrows.add(box.name)
    if "hat" in box.marks and box.name.isupper() and not is_printed_as_vector(box):
        found.seen.add("operators")
    dotted = bool(box.marks) and any(mark.endswith("dot") for mark in box.marks)
    if dotted:
        found.seen.add("dot")
    if box.primes or dotted:
        found.differentiated.add(stem)
    if box.primes > 1:
        found.twice.add(stem)
    if sup and (sup[0].name in (*TENSOR, "0", "1") or (len(sup) > 1 and all(map(is_plain_letter, sup))) or (
        box.sub and is_plain_letter(sup[0]) and len(sup) == 1 and is_plain_letter(box.sub[0]))):  # fmt: skip
        found.raised.add(stem)
    called = after is not None and after.kind == "bracket" and after.name in ("(", "[")
    if called and after is not None:
        found.seen |= {"order"} if box.name == "O" else set()
        found.seen |= {"P(D)"} if [b.name for b in after.parts[0]] == ["D"] else set()
        content = after.parts[0]
        simple, names = simple_argument(content), {b.name for b in content if b.kind == "letter"}
        marked = box.primes or (sup and [b.kind for b in sup] != ["number"])
        found.entries |= {stem} if after.name == "[" and simple and len(content) == 1 and not sup else set()
        if marked or (simple and names):
            found.applied.add(stem)
        late = "t" in names and any(b.name in ("+", "-") for b in content)  # x(t + 1)
        if (late or (simple and names - {"t"})) and not box.sup:
            found.elsewhere.add(stem)
    if not any(a is not None and b is not None and touch(a, b) for a, b in ((before, box), (box, after))):
        found.apart |= {box.name, f"{box.name}_" if box.sub else box.name}
    beside = ("letter", "number", "fraction", "root")
    rates = called and after is not None and any(m.endswith("dot") for b in all_boxes(after.parts[0]) for m in b.marks)
    if called and not rates:  # b y(n - k) shows no factor y; a sum of rates is no argument
        return
    if (before is not None and before.kind in beside and before.name not in ("d", "delta", "Delta")) or (
        after is not None and after.kind in (*beside, "function") and box.name not in ("d", "delta", "Delta")
    ):
        found.factors.add(stem)


def _look_at_letter(box: Box, following: Box | None, found: Notation, alone: bool) -> None:
    name = box.name
    if name == "i" and following is not None and following.name == "hbar":
        found.imaginary = True
        return
    if name == "e" and box.sup is not None:
        if any(b.kind == "letter" or b.parts for b in box.sup):
            found.exponential = True
            if len(box.sup) > 1:
                found.seen.add("exponent")
            found.imaginary |= _is_multiple_of_i(box.sup)
        return
    if box.upright:
        return
    key = name_of(box, index_of(box) or ())
    if following is not None and following.kind == "bracket" and following.name == "(" and box.sup is None:
        content = following.parts[0]
        if simple_argument(content) and following.sup is None:
            letters = {b.name for b in content if b.kind == "letter"}
            if letters or any(b.kind == "comma" for b in content):
                found.called.setdefault(key, set()).update(letters)
        return
    if name == "d" and following is not None and following.kind in ("letter", "group") and box.sub is None:
        return
    if name in ("delta", "Delta") and box.sub is None and (alone if following is None else following.kind in ACTED_ON):
        return  # a difference, or the sign by itself in a sentence
    found.bare.add(key)


def _is_multiple_of_i(row: list[Box]) -> bool:
    """Whether what is above e has i among others: e^i alone may be a vector of a basis, exp(i) the exponential of a letter."""
    return len(without_thin(row)) > 1 and any(b.name in ("i", "j") and b.kind == "letter" and not b.sub for b in row)


def arguments(row: list[Box]) -> list[list[Box]]:
    """What is between the commas, of which a full stop is none."""
    return parted(row, "comma", but=".")
