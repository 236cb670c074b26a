r"""How a paper uses its letters: which are functions, whether e and i are numbers, whether d is a differential.

What the print does not settle is a question to the author, who answers in `paper.toml`:
[notation] functions = "f V", letters = "e", numbers = "i", decimal_comma = true.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from keyword import iskeyword
from typing import Any

from lagrotor.errors import InputError
from lagrotor.paper.letters import FUNCTIONS as CALLED
from lagrotor.paper.source.boxes import Box, FormulaError, boxes
from lagrotor.paper.source.rows import without_thin

_BEHIND = ("operator", "relation", "function", "bracket", "comma", "wide", "fraction")
# What a δ or Δ before it is no factor of: a difference, a variation, a function of the bracket.
ACTED_ON = ("letter", "bracket", "fraction", "accent", "group", "big", "partial", "nabla", "root")
_KEYS = ("functions", "letters", "numbers", "decimal_comma")


@dataclass
class Notation:
    """What was seen of a paper's letters.

    called: letter → letters that were seen as its arguments; bare: letters seen without a bracket behind them; angles: whole
    arguments of sine and cosine; lowered: indices; spelled: letter with its index → how the index is printed; declared: what
    the author says.
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

    @property
    def pi_is_letter(self) -> bool:
        """Whether pi has an index or a mark somewhere, or arguments."""
        return "pi_" in self.called or any(name.startswith("pi") and name != "pi_" for name in self.bare)


def declared_notation(given: Mapping[str, Any], where: str = "paper.toml") -> Notation:
    """What the author says in [notation]. Raises InputError for a key that means nothing."""
    if unknown := sorted(given.keys() - set(_KEYS)):
        raise InputError(f"{where}: notation: {unknown[0]!r} means nothing here: the keys are {', '.join(_KEYS)}")
    functions, letters, numbers = (frozenset(str(given.get(key, "")).replace(",", " ").split()) for key in _KEYS[:3])
    return Notation(functions=functions, letters=letters, numbers=numbers, decimal_comma=given.get("decimal_comma"))


def notation_of(formulas: Iterable[str], said: Notation | None = None) -> Notation:
    """How the formulas of a paper use their letters."""
    found = said or Notation()
    for latex in formulas:
        try:
            row = boxes(latex)
        except (FormulaError, RecursionError):
            continue
        _look(row, found)
    return found


def name_of(box: Box, index: Iterable[str] = (), raised: Iterable[str] = ()) -> str:
    r"""theta_1_dot for \dot\theta_1, rvec_1 for \vec r_1, T__mu_nu for T^{\mu\nu}: a name that Python and sympy take."""
    marks = [
        mark for mark in box.marks if mark != "vec"
    ]  # the innermost first: the rate of a mean is no mean of a rate
    rates = 0
    while marks and marks[-1].endswith("dot"):
        rates += len(marks.pop()) - len("ot")
    stem = {"lambda": "lamda"}.get(box.name, box.name) + box.style + "vec" * box.marks.count("vec") + "".join(marks)
    stem += "prime" * box.primes
    name = stem + "".join(f"__{part}" for part in raised) + "".join(f"_{part}" for part in index)
    name += f"_{'d' * rates}ot" if rates else ""
    return f"{name}_" if iskeyword(name) or name in CALLED else name


def is_printed_as_vector(box: Box) -> bool:
    """Whether a letter is printed as a vector: bold or with an arrow."""
    return box.style == "bold" or "vec" in box.marks


def index_of(box: Box) -> list[str] | None:
    """The parts of an index, such as ["1"], ["cm"] or ["i", "j"]; None where it is no index of letters and numbers."""
    found: list[str] = []
    alone = True  # a comma or a Greek letter ends a run of letters
    for part in box.sub or ():
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
        named = {"+": "plus", "-": "minus", "*": "star", "cdot": "dot"}.get(part.name, part.name)
        return [named] if named.isalpha() else None
    if part.kind == "group":
        inside = _plain(part.parts[0])
        return None if inside is None else [inside]
    if part.kind in ("function", "unit"):
        return [part.name] if part.name.isalnum() else None
    if part.kind == "relation" and part.name == "=":
        return ["eq"]
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
        if box.kind == "letter":
            _look_at_letter(box, following, found, alone=len(inner) == 1)
        if box.kind in ("letter", "partial", "nabla"):
            found.lowered.update(b.name for b in box.sub or () if b.kind == "letter")
            if box.sub and (index := index_of(box)) is not None:
                found.spelled.setdefault("_".join((box.name, *index)), set()).add(_spelling(box.sub))
        elif box.sub is not None:
            _look(box.sub, found)
        if box.kind == "function" and following is not None and following.kind == "letter":
            after = inner[place + 2] if place + 2 < len(inner) else None
            if after is None or (after.kind in _BEHIND and after.name != "/"):
                found.angles.add(following.name)
        marked = box.kind == "letter" and box.sup is not None and len(box.sup) == 1 and box.sup[0].kind == "bracket"
        if box.sup is not None and not marked and any(each.kind != "letter" or each.sub for each in box.sup):
            _look(box.sup, found)  # letters alone may be indices
        for part in box.parts:
            _look(part, found)


def _look_at_letter(box: Box, following: Box | None, found: Notation, alone: bool) -> None:
    name = box.name
    if name == "i" and following is not None and following.name == "hbar":
        found.imaginary = True
        return
    if name == "e" and box.sup is not None and not box.upright:
        if any(b.kind == "letter" or b.parts for b in box.sup):
            found.exponential = True
            if any(b.kind == "letter" and b.name in ("i", "j") for b in box.sup):
                found.imaginary = True
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
    if name == "d" and box.sup is not None and following is not None and following.kind == "letter":
        return
    if name in ("delta", "Delta") and box.sub is None and (alone if following is None else following.kind in ACTED_ON):
        return  # a difference, or the sign by itself in a sentence
    found.bare.add(key)


def arguments(row: list[Box]) -> Iterator[list[Box]]:
    """What is between the commas."""
    part: list[Box] = []
    for box in row:
        if box.kind == "comma" and box.name != ".":
            yield part
            part = []
        else:
            part.append(box)
    yield part
