r"""Letters: as quantities, as functions before a bracket, and those that custom gives a meaning: e, i, d, \\Delta."""

from lagrotor.paper.latex.boxes import GREEK, Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader, asked, settled
from lagrotor.paper.latex.read_derivative import read_differential
from lagrotor.paper.latex.read_scripts import INDICES, index_parts, letter_of, mark_of, power_of, stands_alone
from lagrotor.paper.latex.rows import (
    ENDING,
    UNITS,
    all_boxes,
    derivative_mark,
    is_measure,
    letters_in_row,
    parted,
    without_thin,
)
from lagrotor.paper.latex.tree import Call, Letter, Node, is_vector, number
from lagrotor.paper.latex.usage import (
    ACTED_ON,
    Notation,
    arguments,
    index_of,
    is_number,
    name_of,
    simple_argument,
    stem_of,
    unprimed,
    unscripted,
)

# Names that are mostly functions: before a bracket they are no factors.
_FUNCTION_NAMES = "f g h F G H P Phi Psi phi psi varphi delta Delta Gamma Theta theta zeta eta"
_FUNCTIONS = frozenset(_FUNCTION_NAMES.split())
_BOTH = "write both indices below, or brackets around the power"


def _special(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int] | None:
    """A letter that may be a sign: d, Δ, e, i, π."""
    box = row[place]
    if box.marks or box.sub is not None:
        return None
    if (box.name == "d" and not box.style) or (reader.integrating and is_measure(box)):
        return read_differential(reader, row, place)
    if box.name in ("delta", "Delta") and box.sup is None:
        return _difference(reader, row, place)
    if box.name == "e" and not box.style and not box.primes and _euler(reader, box):
        return _exponential(reader, box), place + 1
    if box.name in ("i", "j", "imath") and not box.style and _is_imaginary(reader, row, place):
        return power_of(reader, Letter("imaginary_unit"), box), place + 1
    if box.name == "pi" and not box.primes and not (_may_call(row, place) and is_called(reader, box, row[place + 1])):
        return _pi(reader, row, place)
    return None


def read_letter(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    _mark_letter(reader, row, place)
    if (special := _special(reader, row, place)) is not None:
        return special
    if box.name == "delta" and box.sup and _may_call(row, place):  # \delta^3(x - y)
        inner = reader.expression(row[place + 1].parts[0])
        power = _dimension(box.sup, is_vector(inner))
        if power is not None and box.sub is None and row[place + 1].sup is None:
            if "delta" in reader.notation.bare:
                raise left_open(box, "delta is Dirac's function or a power", "write \\cdot")
            return Call(f"delta__{power}", (inner,)), place + 2
    _check_scripts(reader, row, place)
    if place and _may_call(row, place) and _is_group(row[place - 1 : place + 2]):
        name = f"{row[place - 1].name}{box.name}"
        raise left_open(box, f"{name}(…) is one name", f"write \\mathrm{{{name}}}")
    if (made := _applied(reader, row, place)) is not None:
        return made
    node, raised = letter_of(reader, box)
    return (node if raised else power_of(reader, node, box)), place + 1


def _applied(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int] | None:
    """A letter as a function of the bracket behind it; None where it is a factor."""
    box = row[place]
    bracket = row[place + 1] if place + 1 < len(row) and row[place + 1].kind == "bracket" else None
    if bracket is not None and bracket.name == "(" and _is_function(reader, row, place):
        return _call(reader, box, bracket), place + 2
    if bracket is not None and bracket.name == "[":
        functional = _is_functional(box, bracket.parts[0])
        if functional or is_entry(reader, box, bracket):
            what = "functional" if functional else "function"
            reader.guess("entry", f"{box.name}[…] is a {what} of what the brackets hold, and no product")
            return _call(reader, box, bracket), place + 2
        _check_square(box, bracket.parts[0])
    if not (box.upright and len(box.name) > 1 and rf"\{box.name}" not in GREEK):
        enclosing = bracket is not None and bracket.name in ("[", r"\{") and box.name not in "Oo"
        if bracket is not None and enclosing and _evidence(reader.notation, box, bracket) is None:
            _mark_applied(reader, box, bracket, False)
        return None
    behind = next((k for k in range(place + 1, len(row)) if row[k].kind != "thin"), place)
    after = row[behind]
    if behind == place or after.kind in ENDING:
        return None
    if after.kind == "bracket" and after.name in ("(", "[", r"\{") and box.sup is None:
        reader.guess("words", f"{box.name} is a function of the bracket that follows it, and no factor")
        return _call(reader, box, after), behind + 1
    raise left_open(box, f"{box.name} acts on what follows", f"write \\operatorname{{{box.name}}}(…) or \\cdot")


def _is_function(reader: FormulaReader, row: list[Box], place: int) -> bool:
    """Whether a letter is a function of the round bracket behind it, marked where that is not evident.

    Raises FormulaError where custom does not say.
    """
    box, bracket = row[place], row[place + 1]
    called = is_called(reader, box, bracket)
    if called is None:
        called = _called_by_custom(reader, row, place)
    elif box.name in "Oo" or _evidence(reader.notation, box, bracket) is called:
        return called
    if called is None:
        way_out = f"write \\cdot, or in paper.toml [notation] {settled(box.name, 'functions', 'letters')}"
        raise left_open(box, f"{box.name}(…) is a function or a product", way_out)
    _mark_applied(reader, box, bracket, called)
    return called


def _mark_applied(reader: FormulaReader, box: Box, bracket: Box, called: bool) -> None:
    what = "a function of the bracket, and no factor" if called else "a factor, and no function of the bracket"
    sign = bracket.name.removeprefix("\\")
    reader.guess("bracket", f"{box.name} before {sign} is {what}", settled(box.name, "functions", "letters"))


def _is_functional(box: Box, inside: list[Box]) -> bool:
    """Whether square brackets behind a capital hold functions or a ket, and no sum or commutator: S[q(t), t], E[|\\psi⟩]."""
    held = [b for b in inside if b.kind == "bracket"]
    capitals = any(b.kind == "letter" and (b.name[0].isupper() or "hat" in b.marks) for b in inside)
    plain = all(b.kind in ("letter", "bracket", "comma", "thin") for b in inside) and bool(held)
    return plain and not capitals and box.name[0].isupper() and box.sup is None


def _check_square(box: Box, inside: list[Box]) -> None:
    """Raise FormulaError for square brackets behind a letter that are no sum or commutator."""
    listed = any(b.kind == "comma" for b in inside)
    operators = any(b.kind == "letter" and (b.name[0].isupper() or "hat" in b.marks) for b in inside)  # A[B, C]
    single = len(without_thin(inside)) == 1 and simple_argument(inside)
    if single or (box.sup is None and not (operators if listed else any(b.kind == "operator" for b in inside[1:]))):
        raise left_open(box, f"{box.name}[…] is a functional or a product", "write \\cdot, or round brackets")


def _is_group(row: list[Box]) -> bool:
    """Whether two capitals and a list or a number in brackets follow each other, as in SO(3, 1)."""
    capitals = all(box.kind == "letter" and box.name.isupper() and not (box.sub or box.sup) for box in row[:2])
    held = row[2].parts[0]
    return capitals and (any(box.kind == "comma" for box in held) or [box.kind for box in held] == ["number"])


def _check_scripts(reader: FormulaReader, row: list[Box], place: int) -> None:
    """Raise FormulaError where an index above a function, or one of a difference, may be meant."""
    box = row[place]
    above = box.sup[0].name if box.sup and [each.kind for each in box.sup] == ["letter"] else ""
    if above and box.sub and _may_call(row, place) and mark_of(reader, box) is None:  # P_l^m(x)
        raise left_open(box, f"{above} is an upper index or a power", _BOTH)
    along = box.name == "delta" and box.sub is not None and len(box.sub) == 1 and box.sub[0].name in "xyzt"
    if along and place + 1 < len(row) and row[place + 1].kind in ("letter", "bracket"):
        raise left_open(box, "delta is a factor or acts on what follows", "write \\cdot")


def _dimension(row: list[Box], of_vector: bool) -> str | None:
    """The dimension of Dirac's function: (3), 3, d, and 2 of a vector."""
    said = len(row) == 1 and row[0].kind == "bracket" and len(row[0].parts[0]) == 1
    if said:
        row = row[0].parts[0]
    plain = len(row) == 1 and row[0].kind in ("number", "letter") and row[0].sup is None and row[0].sub is None
    return row[0].name if plain and (said or of_vector or row[0].name in ("3", "4", "d", "D")) else None


def _may_call(row: list[Box], place: int) -> bool:
    return place + 1 < len(row) and row[place + 1].kind == "bracket" and row[place + 1].name == "("


def is_called(reader: FormulaReader, box: Box, bracket: Box) -> bool | None:
    """Whether a letter before a bracket is a function; None where that is open."""
    known, content = reader.notation, bracket.parts[0]
    index = index_of(box) or ()
    key, plain = name_of(box, index), unscripted(box, index)
    if {box.name, key, plain} & known.functions:
        return True
    if {box.name, key, plain} & known.letters or bracket.sub:
        return False
    if any(b.kind == "comma" for b in content) or box.name == "O" or given_at(bracket):
        return True
    evidence, top = known.called.get(key, known.called.get(plain)), without_thin(content)
    several = any(b.kind == "operator" and b.name in ("+", "-", "pm") for b in top[1:])
    if box.sup is not None and mark_of(reader, box) is None:
        return False if several else None if evidence else (False if not simple_argument(content) else None)
    if (
        not top or any(b.kind == "relation" for b in top) or (not box.sup and [b.name for b in top] == [box.name])
    ):  # R_g (R)
        return None
    if simple_argument(content) and (bracket.sup is None or (evidence is not None and len(top) == 1)):
        return True if evidence is not None or any(b.kind == "letter" for b in top) else None
    if evidence is None:
        numbers = all(b.kind == "number" or b.name == "/" for b in top)  # zeta(3/2)
        late = top[0].kind == "letter" and top[0].name == "t"  # x(t - tau)
        bands = [b.name in "UBVRIJHK" and not b.sub for b in top[::2]]
        colour = box.name == "E" and bands == [True, True] and len(top) == 3  # E(B - V)
        return None if numbers or late or colour or box.name in ("f", "F", "O", "o") or box.style == "cal" else False
    own = {b.name for b in top if b.kind == "letter"}
    if several:
        return True if key not in known.bare else None
    if bracket.sup is not None:
        return None
    return True if own & evidence or (not own and any(b.kind == "number" for b in top)) else None


def _called_by_custom(reader: FormulaReader, row: list[Box], place: int) -> bool | None:
    """What custom takes of a letter before a bracket where the paper does not say; None where it takes neither."""
    box, bracket, known = row[place], row[place + 1], reader.notation
    content, held = without_thin(bracket.parts[0]), all_boxes(bracket.parts[0])
    index = index_of(box) or ()
    key = name_of(box, index)
    evidence, bare = known.called.get(key, known.called.get(unscripted(box))), key in known.bare
    letters = {b.name for b in content if b.kind == "letter"} - {box.name}
    if any(b.kind in ("partial", "nabla") or (b.kind == "fraction" and derivative_mark(b)) for b in held):
        return False
    if any(b.kind == "relation" for b in held) or (box.sup is not None and not (evidence and letters & evidence)):
        return None
    if place + 2 < len(row) and row[place + 2].kind == "bracket":  # a(x - b)(x - c)
        return False
    if len(content) == 1 and content[0].kind == "letter" and bracket.sup is None:
        return True
    if evidence and letters & evidence:
        return None if bracket.sup or "0" in index or content[0].kind == "number" else True
    if bare and (evidence or any(b.name == box.name for b in content)):
        return False  # theta (theta^2 - 1): no function of itself
    return None if bare else True


def given_at(bracket: Box) -> int:
    """The place of the bar of p(a | b), which parts what is given; 0 where there is none, or more."""
    content = bracket.parts[0]
    bars = [k for k, b in enumerate(content) if (b.kind, b.name) in (("bar", "|"), ("relation", "mid"))]
    return bars[0] if len(bars) == 1 and not (content[bars[0]].sub or bracket.sup) else 0


def is_entry(reader: FormulaReader, box: Box, bracket: Box) -> bool:
    """Whether x[n] is x at n: one sign in brackets, or what the paper has so with one sign."""
    inside = bracket.parts[0]
    if box.sup is not None or any(b.kind == "comma" for b in inside) or {box.name} & reader.notation.letters:
        return False
    single = len(without_thin(inside)) == 1 and simple_argument(inside)
    return single or stem_of(box) in reader.notation.entries


def _call(reader: FormulaReader, box: Box, bracket: Box) -> Node:
    """A function of its arguments; x(t) is the letter x where no x, whatever its index, has another argument in the paper."""
    bar = given_at(bracket)
    given = [reader.expression(part) for part in arguments(bracket.parts[0][: bar or None])]
    if bar:
        reader.guess("given", f"the bar in the bracket of {box.name} parts what is given")
        given.append(Call("given", tuple(map(reader.expression, arguments(bracket.parts[0][bar + 1 :])))))
    if box.name == "O" or (box.name == "o" and not box.sub):
        return Call("order" if box.name == "O" else "smaller_than", tuple(given))
    named, raised = letter_of(reader, box)
    if not raised and [each.kind for each in box.sup or ()] == ["letter"]:  # Y_l^m(θ, φ)
        raise left_open(box, f"{(box.sup or [box])[0].name} is an upper index or a power", _BOTH)
    name = name_of(box, index_parts(box), mark_of(reader, box) or ())
    in_time = given == [Letter("t")] and "t" not in reader.bound and stem_of(box) not in reader.notation.elsewhere
    node = named if in_time else Call(name, tuple(given))
    return power_of(reader, node if raised else power_of(reader, node, box), bracket)


def _pi(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int] | None:
    """The number, but where the paper has a quantity of this name."""
    box, known = row[place], reader.notation
    if "pi" in known.letters:
        return None
    counted = place and row[place - 1].kind == "number"  # 2 pi
    if known.pi_is_letter and "pi" not in known.numbers and not counted:
        if "momentum" in known.seen or "pi_" in known.called:
            raise asked(box, "pi is the number or a quantity", "numbers", "letters")
        reader.guess("pi", "pi is the number, and no quantity", settled("pi", "numbers", "letters"))
    return power_of(reader, Letter("pi"), box), place + 1


def _euler(reader: FormulaReader, box: Box) -> bool:
    """Whether e is Euler's number here."""
    known = reader.notation
    if "e" in known.letters:
        return False
    if "e" in known.numbers or box.upright:
        return True
    if box.sup is None:
        return False
    symbolic = any(b.kind in ("letter", "infinity") or b.parts for b in box.sup)
    if not symbolic:
        if known.exponential and "e" not in known.bare:
            raise asked(box, "e is Euler's number", "numbers")
        reader.guess("e", "e is a letter, and not Euler's number", settled("e", "letters", "numbers"))
        return False
    if "e" in known.bare or (len(box.sup) == 1 and box.sup[0].kind == "letter" and "exponent" not in known.seen):  # e^n
        reader.guess("e", "e is Euler's number", settled("e", "numbers", "letters"))
    return True


def _exponential(reader: FormulaReader, box: Box) -> Node:
    if box.sup is None:
        return Call("exp", (number(1),))
    reader.exponents += 1
    power = reader.expression(box.sup)
    reader.exponents -= 1
    return Call("exp", (power,))


def _is_imaginary(reader: FormulaReader, row: list[Box], place: int) -> bool:
    """Whether i is no index."""
    box, beside = row[place], place + 1 < len(row) and row[place + 1].name == "hbar"
    known = reader.notation
    if box.name in reader.bound or box.name in known.letters or (box.name == "j" and box.name not in known.numbers):
        return False
    if box.name in known.numbers or (box.upright and box.name == "i"):
        return True
    free = beside or reader.exponents or "i" not in reader.lowered
    if known.imaginary and box.name == "i" and (free or len(row) > 1):
        if not free or ("i" in known.lowered and not beside):
            reader.guess("i", "i is the imaginary unit", settled("i", "numbers", "letters"))
        return True
    raise asked(box, f"{box.name} is the imaginary unit", "numbers", "letters")


def _difference(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int] | None:
    r"""\Delta x, \delta x as one letter."""
    box = row[place]
    behind = place + 1
    if behind >= len(row) or row[behind].kind not in ACTED_ON or box.primes or box.name in reader.notation.letters:
        return None
    if box.name in reader.notation.bare and (row[behind].kind != "letter" or stands_alone(reader, rf"\{box.name}")):
        raise asked(box, f"\\{box.name} is a factor or a difference", "letters")
    if row[behind].kind != "letter":
        reader.guess("difference", f"{box.name} acts on what follows it, and is no factor", f'letters = "{box.name}"')
        operand, behind = reader.factor(row, behind)
        return Call(box.name, (operand,)), behind
    node, raised = letter_of(reader, row[behind])
    assert isinstance(node, Letter)
    step = box.name == "Delta" and row[behind].name == "t"  # e^{-i\Delta t} may hold a detuning
    if not step or reader.exponents or box.name in reader.notation.bare:
        what = f"{box.name} {row[behind].name} is one quantity, a difference, and no product"
        reader.guess("difference", what, f'usual = "difference" or letters = "{box.name}"')
    letter = Letter(f"{box.name}_{node.name}", node.vector)
    if _may_call(row, behind) and _is_function(reader, row, behind):
        if row[behind].sup is not None or row[behind + 1].sup is not None:
            raise FormulaError(box.at, f"what \\{box.name} acts on is open", "write brackets around it")
        return Call(letter.name, tuple(map(reader.expression, arguments(row[behind + 1].parts[0])))), behind + 2
    return (letter if raised else power_of(reader, letter, row[behind])), behind + 1


# ---- marks


def _mark_letter(reader: FormulaReader, row: list[Box], place: int) -> None:
    """Mark what a letter may be besides: a function or a factor, a number, an operator."""
    box, after, known = row[place], row[place + 1] if place + 1 < len(row) else None, reader.notation
    before = row[place - 1] if place else None
    measured = before is not None and (before.kind in ("number", "unit") or before.upright)
    if measured and box.upright and box.name in UNITS:
        return
    if after is not None and after.kind == "bracket" and after.name in ("(", "[", r"\{"):
        _mark_order(reader, box, after)
        if box.primes:
            reader.guess("prime", f"{box.name} with a prime is a name, and no derivative")
    if not (box.name.isalnum() and (len(box.name) == 1 or f"\\{box.name}" in GREEK or box.upright)):
        reader.guess("sign", f"{box.name} is a letter")
    if _is_laplacian(box, after):
        reader.guess("laplacian", f"{box.name} is a letter, and no Laplacian")
    if not (box.sub or box.marks or box.style or box.name in known.letters | known.numbers | known.functions):
        _mark_constant(reader, box, after)


def _is_laplacian(box: Box, after: Box | None) -> bool:
    """Whether a capital delta or a triangle may be one: without an index, and before no letter of which it is a difference."""
    differs = after is not None and after.kind == "letter" and not (box.sup or box.marks or box.name == "triangle")
    return box.name in ("Delta", "triangle") and not (box.sub or box.style or box.primes or differs)


def _mark_constant(reader: FormulaReader, box: Box, after: Box | None) -> None:
    """Mark letters that may be numbers, and D that may be a derivative."""
    settles = settled(box.name, "letters", "numbers")
    turned = "complex" in reader.notation.seen or (after is not None and after.name == "omega")
    if box.name in ("j", "imath", "jmath") and turned and box.name not in reader.lowered:
        reader.guess("j", f"{box.name} is a letter, and not the imaginary unit", settles)
    if box.name == "e" and not (box.sup or box.upright) and (reader.notation.exponential or _is_a_limit(reader, box)):
        reader.guess("e", "e is a letter, and not Euler's number", settles)
    alone = box.name == "e" and box.sup and len(box.sup) == 1 and box.sup[0].name in INDICES and not box.upright
    if alone and any(name.startswith("e_") for name in reader.notation.bare):
        reader.guess("e", "e is Euler's number, and no vector of a basis", settles)
    acting = ("letter", "group", "text", *(("bracket", "function") if box.upright else ()))
    if box.name == "d" and not box.sup and after is not None and after.kind not in acting:
        reader.guess("differential", "d is a factor, and no differential of what follows", settles)
    if box.name == "D" and "P(D)" in reader.notation.seen:
        reader.guess("operator", "D is a number, and no derivative", settles)


def _is_a_limit(reader: FormulaReader, box: Box) -> bool:
    """Whether e is a side beside others of counting letters alone: (1 + 1/n)^n < e."""
    sides = parted(without_thin(reader.row), "relation", "arrow", "comma")
    letters = {b.name for b in all_boxes(reader.row) if b.kind == "letter"}
    return [box] in sides and len(sides) > 1 and letters <= {"e", "n", "k", "m", "N"}


def _mark_order(reader: FormulaReader, box: Box, bracket: Box) -> None:
    """Mark O(…), which may be a group or a function, and what in a paper that has it may be an order of magnitude."""
    if box.name in "Oo":
        added = reader.source[: box.at].rstrip().endswith(("+", "-", r"\pm", r"\mp", "−"))
        if not added or not letters_in_row(bracket.parts[0]):
            reader.guess("order", f"{box.name}(…) is an order of magnitude, and no group or function")
    elif "order" in reader.notation.seen and box.name in ("omega", "Omega", "theta", "Theta"):
        reader.guess("order", f"{box.name} is a function of the bracket, and no order of magnitude")


def _evidence(known: Notation, box: Box, bracket: Box) -> bool | None:
    """True for a function of the bracket, False for a factor, None where neither author nor paper says."""
    stem, content = stem_of(box), without_thin(bracket.parts[0])
    if any(said := [bool({box.name, unprimed(box), stem} & names) for names in (known.functions, known.letters)]):
        return said[0]
    listed = any(b.kind == "comma" for b in content)
    if box.sup or bracket.name != "(":
        return False if not listed and _is_factor(known, box, content) else None
    if simple_argument(content) and letters_in_row(content) and not bracket.sup and (listed or len(content) == 1):
        numbers = listed and stem in known.factors and any(b.kind == "number" for b in content)  # gamma(1, beta)
        other = known.called.get(unprimed(box), set()) - letters_in_row(content)
        coefficient = box.sub and not listed and rf"\{box.name.lower()}" in GREEK and stem in known.factors  # \xi_4 (P)
        return None if (numbers or coefficient) and not other else True
    if stem in known.applied:
        letters = letters_in_row(content) if box.name not in _FUNCTIONS else set()
        seen = known.called.get(unprimed(box), set()) | known.called.get(stem, set())
        return None if stem in known.factors or bracket.sup or (letters and not letters & seen) else True
    return False if _is_factor(known, box, content) else None


def _is_factor(known: Notation, box: Box, content: list[Box]) -> bool:
    """Whether the paper has a letter as a number among factors, and never before an argument or differentiated."""
    stem = stem_of(box)
    held = {b.name for b in content if b.kind == "letter"}
    held = letters_in_row(content) if len(content) == 2 else held  # E(\\phi(E))
    free = not known.is_function(box) and box.name not in _FUNCTIONS and stem in known.factors and box.style != "cal"
    variable = held & {"t", "tau"} or any(held & letters for letters in known.called.values())
    return free and not variable and is_number(known, box)
