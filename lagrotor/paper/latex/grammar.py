"""The reader of expressions: a row of boxes becomes a tree of sums, products, functions, derivatives and integrals.

The reader guesses nothing. A symbol before a bracket is a function if the notation declares it; x(t) is the coordinate x;
a sum in brackets is a factor. Any other ambiguous sign stops the reading, and the message names the entry of [notation]
or the spelling that removes the ambiguity.
"""

import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from lagrotor.paper.latex.boxes import (
    BIG,
    FUNCTIONS,
    GREEK,
    Box,
    FormulaError,
    all_boxes,
    index_of,
    is_derivative,
    is_mark,
    is_printed_as_vector,
    name_of,
    split_at,
    stem_of,
    strip,
)
from lagrotor.paper.latex.notation import Notation, has_kind, is_evident_argument
from lagrotor.paper.latex.tree import (
    Call,
    Letter,
    Node,
    Number,
    is_matrix,
    is_printed_zero,
    is_vector,
    letters_of,
    number,
    product_of,
    walk,
)

_NO_NAMES = "sin cos tan exp log ln det max min lim cot sinh cosh tanh const var"
_WORDS = frozenset(_NO_NAMES.split())
_MOST_DIGITS = 1000
_INVERSE = {"sin": "asin", "cos": "acos", "tan": "atan", "sinh": "asinh", "cosh": "acosh", "tanh": "atanh"}
_BRACKETED = ("det", "tr", "Tr", "arg", "Re", "Im", "max", "min")  # functions that need brackets
_ANGLES = ("theta", "phi", "varphi", "psi", "vartheta", "chi", "alpha", "beta", "gamma")
_LAST = ("t", "tau", "x", "y", "z", "s")  # last symbols of a sine's argument without brackets
_HELPS = {
    "cases": "write one statement for each case", "nabla": "write its components",
    "partial": r"write \frac{\partial f}{\partial x}", "text": "write words between statements, and numbers without units",
}  # fmt: skip
_LABELS = {"*": "star", "star": "star", "+": "plus", "-": "minus"}
_TRANSPOSES = ("T", "top", "intercal")
# Symbols that may be functions before a sum in brackets.
_NO_FACTORS = ("delta", "Delta", "Gamma", "zeta", "f", "F", "U", "V", "phi", "psi", "Phi", "Psi")
_NAMES = {"lbrace": r"\{", "rbrace": r"\}", **dict.fromkeys(("vert", "lvert", "rvert"), "|")}
_NAMES |= dict.fromkeys(("Vert", "lVert", "rVert"), r"\|")
_ROUND = ("(", "[", r"\{")
_SETTLED = ("functions", "vectors", "matrices", "indices", "positive", "real")


class Grammar:
    """The reader of one formula in the notation of its paper.

    source: the LaTeX of the formula. alone: names of the symbols that occur outside subscripts and superscripts.
    indices: names of the symbols that occur in subscripts. bound: indices of the sums that are being read.
    """

    def __init__(self, source: str, notation: Notation, alone: frozenset[str], indices: frozenset[str]) -> None:
        self.source, self.notation, self.alone, self.indices = source, notation, alone, indices
        self.bound: list[str] = []

    def _unclear(self, box: Box, what: str, *kinds: str, way: str = r"write \cdot for a product") -> FormulaError:
        """Return the error for an ambiguous symbol. `what` completes the sentence "it is unclear whether …".

        The remedy is an entry of [notation] that declares one of these kinds; without kinds it is the sentence `way`.
        """
        entries = " or ".join(f'{kind} = "{stem_of(box)}"' for kind in kinds)
        way = f"write in paper.toml [notation] {entries}" if kinds else way
        return FormulaError(f"it is unclear whether {what}", way)

    def _text(self, first: Box, last: Box | None = None) -> str:
        return self.source[first.at : (last or first).end]

    def _kind(self, box: Box, *kinds: str) -> bool:
        """Return True if the notation declares one of these kinds for a symbol."""
        return any(has_kind(self.notation, kind, box) for kind in kinds)

    def _expressions(self, row: list[Box]) -> tuple[Node, ...]:
        """Read the expressions that commas separate in a row."""
        return tuple(map(self.expression, split_at(row, "comma")))

    # ---- sums and products

    def expression(self, row: list[Box]) -> Node:
        """Read a row of boxes as a sum. Raises FormulaError if it is not one."""
        row = _pair_bars(strip(row))
        terms: list[tuple[str, list[Box]]] = [("+", [])]
        integrals = 0
        for place, box in enumerate(row):
            integrals += _opens_integral(box) - (integrals > 0 and _closes_integral(row, place))
            if box.kind == "operator" and box.name in ("pm", "mp"):
                raise FormulaError(f"\\{box.name} means two signs", "write two statements, one for each sign")
            if box.kind == "operator" and box.name in ("+", "-") and not integrals:
                if not terms[-1][1] and place:
                    raise FormulaError("two signs follow each other", "write brackets around the second")
                terms = [*terms, (box.name, [])] if place else [(box.name, [])]
            else:
                terms[-1][1].append(box)
        if not terms[-1][1]:
            raise FormulaError("nothing follows the sign" if row else "the expression is empty", "write the expression")
        values = [Call("negative", (self.term(run),)) if sign == "-" else self.term(run) for sign, run in terms]
        if len(values) == 1:
            return values[0]
        _check_sums([run for _, run in terms])
        if len({(is_vector(value), is_matrix(value)) for value in values if not _is_any_kind(value)}) > 1:
            raise FormulaError("a vector and a number are added", "declare the vectors in [notation]")
        return Call("sum", tuple(values))

    def term(self, row: list[Box]) -> Node:
        """Read a row of boxes as one product: groups of adjacent factors, joined by ·, ×, / or *."""
        row = strip(row)
        groups: list[tuple[str, list[Node], list[Box]]] = [("", [], [])]
        place = 0
        while place < len(row):
            box, (sign, factors, content) = row[place], groups[-1]
            if box.kind == "operator" and box.name in ("cdot", "times", "/", "*"):
                if not factors:
                    raise FormulaError(f"nothing precedes {box.name}", "write the first factor")
                groups.append((box.name, [], []))
                place += 1
                continue
            if factors and sign == "/":
                raise FormulaError("it is unclear what the slash divides by", r"write \frac or brackets")
            _check_neighbours(row, place, content[-1] if content else None)
            node, behind = self.factor(row, place)
            factors.append(node)
            content += row[place:behind]
            place = behind
        if not groups[-1][1]:
            raise FormulaError("nothing follows the sign", "write the second factor")
        product: Node | None = None
        for sign, factors, content in groups:
            if len(factors) > 1 and any(isinstance(factor, Call) and factor.name == "order" for factor in factors):
                way = r"write \cdot for a product, or '+ O(…)' for the order of omitted terms"
                raise FormulaError("it is unclear whether O(…) next to a factor is an order", way)
            right = _product(factors)
            product = right if product is None else self._join(product, sign, right, content[0])
        assert product is not None
        return product

    def _join(self, product: Node, sign: str, right: Node, first: Box) -> Node:
        """Return the product or quotient of `product` and `right`, which a sign joins; `first` is the box after it."""
        text = self.source[: first.at].rstrip()
        if sign == "/":
            return self._divide(product, right, text)
        vectors = is_vector(product), is_vector(right)
        if all(vectors) and not (is_matrix(product) or is_matrix(right)):
            if sign == "*":
                raise FormulaError("two vectors are multiplied by *", r"write \cdot or \times")
            chain = sign == "times" and isinstance(product, Call) and product.name == "cross"
            if chain and not re.search(r"[)\]]\s*\\times$", text):
                raise FormulaError("it is unclear which × comes first", "write brackets")
            return Call("dot" if sign == "cdot" else "cross", (product, right))
        if all(vectors):
            if sign == "times":
                raise FormulaError("× is between matrices", "write the matrices side by side")
            return _product([product, right])
        cofactor = right if vectors[0] else product if vectors[1] else None
        if sign == "cdot" and isinstance(cofactor, Call) and cofactor.name not in (*_SCALARS, *FUNCTIONS.values()):
            raise FormulaError(f"it is unclear whether {cofactor.name} is a vector", "remove the dot")
        if sign == "times" and not (_is_numeric(product) or _is_numeric(right)):
            way = r"declare the vectors in [notation], or write \cdot"
            raise FormulaError("it is unclear whether × multiplies vectors or numbers", way)
        return product_of([product, right])

    def _divide(self, dividend: Node, divisor: Node, text: str) -> Node:
        if is_vector(divisor):
            raise FormulaError("the divisor is a vector", "divide by its length")
        last = dividend.args[-1] if isinstance(dividend, Call) and dividend.name == "product" else dividend
        last = last.args[0] if isinstance(last, Call) and last.name == "power" else last
        if isinstance(last, Call) and last.name in _OPEN_ENDED and text.rstrip(" /")[-1:] not in ")]}":
            raise FormulaError("it is unclear whether the slash is inside the function", "write brackets")
        return Call("quotient", (dividend, divisor))

    def factor(self, row: list[Box], place: int) -> tuple[Node, int]:
        """Read the factor that begins at a position of a row; return it and the position after it."""
        box = row[place]
        named = box.kind == "letter" and box.upright and len(box.name) > 1 and box.name in FUNCTIONS and not box.marks
        read = Grammar._function if named else _FACTORS.get(box.kind)
        if box.sub is not None and box.kind not in ("letter", "function", "big", "partial") and box.closing != "|":
            raise FormulaError(f"{self._text(box)} has an index", "write the index on a symbol")
        if box.kind in _SIMPLE:
            node, behind = self.power(_SIMPLE[box.kind](self, box), box), place + 1
        elif read is not None:
            node, behind = read(self, row, place)
        else:
            raise FormulaError(f"{self._text(box)} cannot be read", _HELPS.get(box.kind, "write what it means"))
        if behind < len(row) and row[behind].name == "!":
            if box.kind == "function" or [b.name for b in row[behind + 1 : behind + 2]] == ["!"]:
                raise FormulaError("it is unclear what ! belongs to", "write brackets around n!, or write the product")
            node, behind = Call("factorial", (node,)), behind + 1
        return node, behind

    # ---- letters

    def letter(self, box: Box) -> Letter:
        """Read a symbol without its power. Raises FormulaError if [notation] must declare its kind and does not."""
        if self._kind(box, "operators"):
            way = "products with operators are not read: write the result as an expression"
            raise FormulaError(f"{stem_of(box)} is an operator", way)
        dots = [mark.endswith("dot") for mark in box.marks]
        if dots != sorted(dots):
            raise FormulaError(f"an accent is above the dot of {box.name}", "give the rate a symbol of its own")
        if "hat" in box.marks and box.name.isupper() and not self._kind(box, *_SETTLED):
            raise self._unclear(box, f"{stem_of(box)} is an operator or a symbol", "operators", "vectors", "real")
        matrix = self._kind(box, "matrices")
        vector = matrix or self._kind(box, "vectors")
        if is_printed_as_vector(box) and not vector:
            raise self._unclear(box, f"{stem_of(box)} is a vector or a matrix", "vectors", "matrices")
        return Letter(name_of(box, index_of(box), self._label(box)), vector, matrix)

    def _label(self, box: Box) -> list[str]:
        """Return the words that a superscript adds to the name of a symbol, such as max for T^max; [] for a power."""
        if not box.sup or len(box.sup) > 1 or box.kind != "letter":
            return []
        only = box.sup[0]
        if only.kind == "operator" and only.name in _LABELS:
            return [_LABELS[only.name]]
        bracket = (only.kind, only.name) == ("bracket", "(")
        if bracket and len(only.contents[0]) == 1 and not self._kind(box, "functions"):
            inner = only.contents[0][0]
            return [inner.name] if inner.kind in ("number", "letter") and not (inner.sup or inner.sub) else []
        upright = only.upright and (len(only.name) > 1 or only.name not in (*_TRANSPOSES, "d", "e", "i"))
        worded = only.kind == "text" and only.name.isalnum()
        return [only.name] if worded or (only.kind == "letter" and upright) else []

    def _letter(self, row: list[Box], place: int) -> tuple[Node, int]:
        box, right = row[place], row[place + 1] if place + 1 < len(row) else None
        kind = right.kind if right else ""
        if not (box.marks or box.style or box.sub or box.primes):
            constant = self._special_symbol(row, place, right)
            if constant is not None:
                return constant
        word = box.upright and len(box.name) > 1 and rf"\{box.name}" not in GREEK and kind in ("letter", "bracket")
        if word or (box.name == "d" and box.upright and box.primes):
            way = rf"write \cdot, or \operatorname{{{box.name}}}(…)"
            raise self._unclear(box, f"{box.name} is an operator", way=way)
        if right is not None and kind == "bracket" and _plain(right.name) in _ROUND:
            applied = self._application(box, right)
            if applied is not None:
                return applied, place + 2
        node: Node = self.letter(box)
        if box.primes and self._kind(box, "functions"):
            if self._kind(box, "proposed"):
                raise self._unclear(box, f"{self._text(box)} is a derivative or another symbol", "functions", "real")
            node = self.letter(replace(box, primes=0))
            if is_vector(node):
                raise self._unclear(box, f"{self._text(box)} is a derivative or another vector", "vectors")
            for _ in range(box.primes):
                node = Call("prime", (node,))
        return self.power(node, box), place + 1

    def _special_symbol(self, row: list[Box], place: int, right: Box | None) -> tuple[Node, int] | None:
        """Read e, i, π, d or Δ with its special meaning; return None for an ordinary symbol. `right` is the next box or None."""
        box, name, number_ = row[place], row[place].name, self._kind(row[place], "numbers")
        settled, kind = self._kind(box, *_SETTLED), right.kind if right else ""
        if name == "e" and (number_ or box.upright):
            return Call("exp", (self.expression(box.sup) if box.sup else number(1),)), place + 1
        if name == "e" and not settled and any(b.kind in ("letter", "infinity") for b in all_boxes(box.sup or ())):
            raise self._unclear(box, "e is Euler's number", "numbers", "real")
        if name in ("i", "j") and name not in self.bound:
            if number_ or (box.upright and name == "i"):
                return self.power(Letter("imaginary_unit"), box), place + 1
            if name == "i" and not settled:
                raise self._unclear(box, "i is the imaginary unit", "numbers", "indices", "real")
        if name == "pi" and self._kind(box, "functions") and kind != "bracket":
            raise self._unclear(box, "pi is the number or a quantity", way="give the quantity an index")
        if name == "pi" and not settled:
            return self.power(Letter("pi"), box), place + 1
        proposed = name in ("Delta", "delta") and self._kind(box, "proposed") and kind != "bracket"
        if (settled and not proposed) or right is None or kind in ("operator", "comma", "dots", "percent"):
            return None
        if name in ("Delta", "delta"):
            return None if box.sup else self._difference(row, place)
        if name == "d" and kind in ("letter", "bracket", "group", "partial"):
            raise FormulaError("d precedes a symbol", r"write \cdot for a product, or a derivative or an integral")
        return None

    def _difference(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""Read \Delta x as one symbol, Delta_x; return it and the position after it."""
        box, right = row[place : place + 2]
        if right.kind != "letter" or box.name == "delta" or stem_of(box) in self.alone:
            raise self._unclear(box, f"\\{box.name} is a factor or an operator", "functions", "real")
        letter = self.letter(right)
        if place + 2 < len(row) and row[place + 2].kind == "bracket":
            raise self._unclear(right, f"\\{box.name} {right.name} is a function or a factor", "functions")
        return self.power(replace(letter, name=f"{box.name}_{letter.name}"), right), place + 2

    def _application(self, box: Box, bracket: Box) -> Node | None:
        """Read a symbol as a function of the bracket after it, x(t) as x; return None if the bracket is a factor."""
        content, name = bracket.contents[0], stem_of(box)
        if name in ("O", "Ocal") and not (box.sub or box.sup):
            return Call("order", (self.expression(content),))
        if self._kind(box, "real", "positive"):
            return None
        if self._kind(box, "functions") and (not self._kind(box, "proposed") or is_evident_argument(box, bracket)):
            return self._call(box, bracket)
        time = [(b.kind, b.name, b.sup, b.sub, b.primes) for b in content] == [("letter", "t", None, None, 0)]
        if bracket.name == "(" and time and "t" not in self.bound:
            return self.power(self.power(self.letter(box), box), bracket)
        bars = bool(content) and content[0].name in ("|", "||")  # V(|x - y|)
        adds = not bars and any(b.kind == "operator" and b.name in ("+", "-") for b in content[1:])
        late = any([b.name for b in piece] == ["t"] for piece in split_at(content, "operator"))  # x(t - \tau)
        derived = [b.kind for b in content] == ["fraction"] and bool(bracket.sup or is_derivative(content[0]))
        listed = any(b.kind in ("comma", "relation") for b in content)
        doubtful = name in _NO_FACTORS or self._kind(box, "proposed")
        if (
            (adds or derived)
            and not (late or listed)
            and (any(mark.endswith("dot") for mark in box.marks) or not doubtful)
        ):
            return None
        what = f"{self._text(box)} before {bracket.name} is a function or a factor"
        raise self._unclear(box, what, "functions", "real")

    def _call(self, box: Box, bracket: Box) -> Node:
        """Read a declared function with its arguments; V'(r) is read as the derivative of V by r."""
        content, above = bracket.contents[0], box.sup or []
        derived = any(b.kind == "partial" or is_derivative(b) for b in content) or any(map(self._is_rate, content[1:]))
        itself = len(content) > 1 and any(b.kind == "letter" and stem_of(b) == stem_of(box) for b in content)
        if (derived or itself) and not any(b.kind == "comma" for b in content):
            raise self._unclear(box, f"{stem_of(box)} is a factor here")
        if [b.name for b in above] == ["-", "1"] or any(b.kind in ("bracket", "letter") for b in above):
            way = "write brackets around the base, or use another symbol"
            raise self._unclear(box, f"the superscript of {self._text(box)} is a power", way=way)
        if bracket.sub:
            raise FormulaError("a bracket has an index", "write the index on a symbol")
        named, arguments = self.letter(replace(box, primes=0)), self._expressions(content)
        if named.vector and not named.name.split("_")[0].endswith(("bold", "vec")):
            raise FormulaError(f"{named.name} is a vector and a function", "write the vector in bold")
        if box.primes and len(arguments) == 1 and isinstance(arguments[0], Letter):
            value = _derivative_of(Call(named.name, arguments), arguments[0], box.primes)
        else:
            value = Call(name_of(box, index_of(box)) if box.primes else named.name, arguments)
        return self.power(self.power(value, box), bracket)

    # ---- powers

    def power(self, node: Node, box: Box) -> Node:
        """Return the node raised to the power in the superscript of its box; the node itself without a power."""
        if box.sup is None or self._label(box):
            return node
        if not box.sup:
            raise FormulaError("a power is empty", "write the exponent")
        only = box.sup[0].name if len(box.sup) == 1 and box.sup[0].kind == "letter" else ""
        if only in _TRANSPOSES and (is_vector(node) or only != "T" or isinstance(node, Letter)):
            if not is_vector(node):
                raise self._unclear(box, f"{self._text(box)} is transposed or has a power", "matrices", "real")
            return Call("transpose", (node,))
        self._check_power(box, box.sup)
        power = self.expression(box.sup)
        if is_matrix(node):
            if power == Call("negative", (number(1),)):
                return Call("inverse", (node,))
            if not isinstance(power, Number):
                raise FormulaError("the power of a matrix is not a number", "write the product")
        elif is_vector(node):
            if power != number(2):
                raise FormulaError("a vector has a power", "write the power of its length")
            return Call("dot", (node, node))
        half = power == Call("quotient", (number(1), number(2)))
        return Call("sqrt", (node,)) if half else Call("power", (node, power))

    def _check_power(self, box: Box, row: list[Box]) -> None:
        """Raise FormulaError for a superscript that is a mark or an upper index."""
        text, letters = self._text(row[0], row[-1]), [b for b in row if b.kind == "letter"]
        text = text[1:-1] if text[0] == "{" else text
        if any(b.kind in ("text", "relation", "comma") or b.primes or b.name in ("dagger", "prime", "*") for b in row):
            raise FormulaError(f"the superscript {text} is not a power", "write it as an index")
        if row[0].kind == "bracket" and len(row) == 1:
            way = "write a power without brackets"
            raise FormulaError("it is unclear whether a superscript in brackets is a power", way)
        if box.kind != "letter":
            return
        if [b.name for b in row] in (["0"], ["e"]):
            raise FormulaError(f"it is unclear whether {text} is an upper index or a power", "write the index below")
        unsettled = [b for b in letters if not self._kind(b, "positive", "real")]
        lowered = {"mu", "nu", *(self.indices - self.alone)}
        upper = any(b.name in lowered or self._kind(b, "indices") for b in unsettled)
        below = bool(unsettled) and any(b.kind == "letter" for b in box.sub or ())
        if len(letters) == len(row) > 1 or upper or below:
            raise self._unclear(letters[0], f"{text} is an upper index or a power", "real")

    # ---- numbers

    def _number(self, row: list[Box], place: int) -> tuple[Node, int]:
        box, behind = row[place], place + 1
        node: Node = Number(self._value(box.name))
        right = row[behind] if behind < len(row) else box
        degrees = box.sup is not None and [b.name for b in box.sup] in (["circ"], ["o"])
        if (right.upright and right.name not in (*FUNCTIONS, "d", "e", "i")) or (degrees and right.name in ("C", "F")):
            raise FormulaError(f"upright {right.name} after a number is a unit", "write the number without it")
        if degrees:
            return Call("quotient", (product_of([node, Letter("pi")]), number(180))), behind
        return self.power(node, box), behind

    def _value(self, text: str) -> Fraction:
        if len(text) > _MOST_DIGITS:
            raise FormulaError(f"{text[:12]}…: a number has more than {_MOST_DIGITS} digits", "give it a symbol")
        whole, *groups = text.split("{,}")
        thousands = whole != "0" and all(len(group.partition(".")[0]) == 3 for group in groups)
        if not groups or (thousands and not self.notation.decimal_comma):
            return Fraction(whole + "".join(groups))
        if len(groups) > 1 or "." in text:
            raise FormulaError(f"{text} is not a number", "write a decimal point")
        return Fraction(f"{whole}.{groups[0]}")

    # ---- functions by name

    def _function(self, row: list[Box], place: int) -> tuple[Node, int]:
        box, name = row[place], FUNCTIONS.get(row[place].name, row[place].name)
        inner, behind = self._argument(row, place)
        if behind < len(row) and row[behind].kind == "bracket" and [b.name for b in row[behind].contents[0]] == ["t"]:
            raise FormulaError(f"it is unclear where the argument of {box.name} ends", "write the argument in brackets")
        above = [b.name for b in box.sup or ()]
        if box.sub is not None and name != "log":
            raise FormulaError(f"{box.name} has an index", "write the function without index")
        if above == ["-", "1"] and name in _INVERSE:
            return Call(_INVERSE[name], inner), behind
        if above == ["-", "1"] or (above and (box.name not in FUNCTIONS or (box.sup or [box])[0].kind == "bracket")):
            what = f"the superscript of {box.name} is a mark or a power"
            raise self._unclear(box, what, way="write brackets around the base")
        value = Call(name.lower() if name == "Tr" else name, inner)
        if name == "log10" or (name == "log" and box.sub):
            base = self.expression(box.sub) if box.sub else number(10)
            value = Call("quotient", (Call("log", inner), Call("log", (base,))))
        return Call("power", (value, self.expression(box.sup))) if box.sup else value, behind

    def _argument(self, row: list[Box], place: int) -> tuple[tuple[Node, ...], int]:
        """Read the arguments of a function; return them and the position after them."""
        box, start = row[place], place + 1
        first = row[start] if start < len(row) else box
        if first is box or first.kind in ("operator", "comma", "big"):
            raise FormulaError(f"{box.name} has no argument", "write the argument in brackets")
        what = "it is unclear whether the power belongs to the argument or to the function"
        raised = FormulaError(what, "write the argument in brackets")
        if first.kind == "bracket" and _plain(first.name) in _ROUND:
            if first.sub or first.sup:
                raise raised
            return self._expressions(first.contents[0]), start + 1
        alone = first.kind == "letter" and all(b.kind == "operator" for b in row[start + 1 : start + 2])
        if (first.kind == "matrix" and not first.sup) or (box.name in _BRACKETED and alone):
            return (self.expression([first]),), start + 1
        if box.name not in FUNCTIONS or box.name in _BRACKETED:
            raise FormulaError(f"it is unclear where the argument of {box.name} ends", "write the argument in brackets")
        if first.kind in ("function", "bracket") and not first.sup:
            node, behind = self.factor(row, start)
            return (node,), behind
        end = self._argument_end(row, start)
        if any(item.sup is not None and not self._label(item) and item.name != "e" for item in row[start:end]):
            raise raised
        return (self.term(row[start:end]),), end

    def _argument_end(self, row: list[Box], start: int) -> int:
        """Return the position after a function's argument that has no brackets, such as 2θ, ωt, kx, nπ or one symbol."""
        end, kinds = start, ("number", "letter", "fraction", "root", "group")
        while end < len(row) and row[end].kind in kinds and not self._is_rate(row[end]):
            end += 1
            if end < len(row) and row[end].spaced:
                break
        run, right = row[start:end], row[end] if end < len(row) else None
        names, letters = [item.name for item in run], [item for item in run if item.kind == "letter"]
        stops = ("operator", "function", "big")
        ends = right is None or right.spaced or right.kind in stops or self._is_rate(right)
        angle = bool(run) and names[0] in _ANGLES and not run[0].sub
        if len(run) == 1 and (ends or (angle and right is not None and right.kind == "bracket")):
            return end
        plain = run and len(letters) + (run[0].kind == "number") == len(run) > 1 and names[0] not in _LAST
        is_clear = run and (names[-1] in _LAST or "pi" in names or len(letters) == 1)
        if ends and plain and is_clear and (not angle or names[1:] == ["t"]):  # of cos θ x the angle may be θ x
            return end
        function = row[start - 1].name
        raise FormulaError(f"it is unclear where the argument of {function} ends", "write the argument in brackets")

    def _is_rate(self, box: Box) -> bool:
        """Return True if a box is a time derivative or a vector; it then ends the argument of a function."""
        dotted = any(mark.endswith("dot") for mark in box.marks)
        return bool(is_derivative(box)) or (box.kind == "letter" and (dotted or self._kind(box, "vectors")))

    # ---- brackets, roots, matrices

    def _bracket(self, box: Box) -> Node:
        pair, content = (_plain(box.name), _plain(box.closing)), box.contents[0]
        if pair == (".", "|"):
            return self._evaluation(box, content)
        if pair in (("|", "|"), (r"\|", r"\|")):
            inner = self.expression(content)
            pairs = any(re.search(r"_(?:ij|ik|jk|kl|i_j|i_k|j_k)\b", name) for name in letters_of(inner))
            if is_matrix(inner) or (pairs and not is_vector(inner)):
                raise FormulaError("it is unclear whether the bars are a determinant or a length", r"write \det")
            if pair[0] != "|" and not is_vector(inner):
                raise FormulaError("‖…‖ encloses no vector", 'write in paper.toml [notation] vectors = "…"')
            return Call("norm" if is_vector(inner) else "Abs", (inner,))
        if any(b.kind == "relation" for b in content):
            raise FormulaError("a relation is inside brackets", "write the relation separately")
        pieces = split_at(content, "comma")
        if pair not in (("(", ")"), ("[", "]"), (r"\{", r"\}"), (".", ".")) or (len(pieces) > 1 and box.name != "("):
            way = "write out means, kets, commutators, Poisson brackets and intervals"
            raise FormulaError(f"{box.name} … {box.closing} is not read", way)
        return self.expression(content) if len(pieces) == 1 else Call("column", self._expressions(content))

    def _evaluation(self, box: Box, content: list[Box]) -> Node:
        """Read an expression that a bar with an index evaluates at a point: |_{x = 0}."""
        where = split_at(box.sub or [], "relation")
        if len(where) != 2 or not all(where) or box.sup:
            raise FormulaError("the index of the evaluation bar is not an equation", "write |_{x = 0}")
        return Call("at", (self.expression(content), *map(self.expression, where)))

    def _group(self, box: Box) -> Node:
        """Read a group in braces that has a script, or a group with a brace above or below."""
        if any(b.kind == "operator" and b.name in ("+", "-") for b in box.contents[0][1:]):
            raise FormulaError("it is unclear whether brackets enclose the sum", "write the sum in brackets")
        return self.expression(box.contents[0])

    def _root(self, box: Box) -> Node:
        inner, *degree = map(self.expression, box.contents)
        return Call("power", (inner, Call("quotient", (number(1), degree[0])))) if degree else Call("sqrt", (inner,))

    def _matrix(self, box: Box) -> Node:
        lines = [tuple(map(self.expression, line.contents)) for line in box.contents[0]]
        if len({len(line) for line in lines}) != 1:
            raise FormulaError("the rows of a matrix have different lengths", "write every entry")
        if len(lines[0]) == 1 and box.name != "vmatrix":
            return Call("column", tuple(line[0] for line in lines))
        matrix = Call("matrix", tuple(Call("row", line) for line in lines))
        return Call("det", (matrix,)) if box.name == "vmatrix" else matrix

    # ---- fractions and derivatives

    def _fraction(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if mark := is_derivative(box):
            return self._derivative(row, place, mark)
        first, second = (content[0].name if content else "" for content in box.contents)
        if first == second and first in ("d", "D", "partial", "delta") and len(box.contents[1]) > 1:
            way = r"write \frac{\mathrm{d} f}{\mathrm{d} x}"
            raise FormulaError(f"it is unclear whether the fraction with {first} is a derivative", way)
        over, under = map(self.expression, box.contents)
        if is_vector(under):
            raise FormulaError("the divisor is a vector", "divide by its length")
        return self.power(Call("quotient", (over, under)), box), place + 1

    def _derivative(self, row: list[Box], place: int, mark: str) -> tuple[Node, int]:
        box, (over, under) = row[place], row[place].contents
        order, behind, variables = _order(over[0]), place + 1, list[tuple[Letter, int]]()
        for sign, target in zip(under[::2], under[1::2], strict=False):
            if not is_mark(sign, mark) or sign.sup or target.kind != "letter" or len(under) % 2:
                raise FormulaError("the variable of the derivative is not clear", r"write \frac{d f}{d x}")
            variables.append((self.letter(replace(target, sup=None)), _order(target)))
        if sum(times for _, times in variables) != order:
            way = "write the same order above and below the fraction bar"
            raise FormulaError("the orders of the derivative differ", way)
        in_time = mark == "d" and variables == [(Letter("t"), order)]
        if not over[1:]:
            node, behind = self._operand(row, behind)
        else:
            node, right = self.expression(over[1:]), row[behind] if behind < len(row) else box
            content = right.contents[0] if right.kind == "bracket" and right.name == "(" else []
            if in_time and [(b.name, b.sub) for b in content] == [("t", None)]:
                behind += 1  # \frac{dx}{dt}(t)
            elif content and not any(b.kind == "operator" for b in content[1:]):
                what = "the bracket after a derivative is the point of evaluation or a factor"
                raise self._unclear(box, what, way=r"write |_{t = 0} or \cdot")
        value = _rate(node, order) if in_time else node
        for variable, times in variables if not in_time else ():
            value = _derivative_of(value, variable, times)
        return (self.power(value, box) if over[1:] else value), behind

    def _operand(self, row: list[Box], place: int) -> tuple[Node, int]:
        """Read the operand after d/dx, which is the last factor of a term or a bracket; return it and the next position."""
        if place >= len(row) or row[place].kind == "operator":
            raise FormulaError("the derivative has nothing to act on", "write the differentiated expression after it")
        node, behind = self.factor(row, place)
        if behind < len(row) and row[place].kind != "bracket":
            raise FormulaError("it is unclear how far the derivative reaches", "write brackets around its operand")
        return node, behind

    # ---- sums, integrals, limits

    def _big(self, row: list[Box], place: int) -> tuple[Node, int]:
        box, terms, below = row[place], row[place + 1 :], row[place].sub or []
        if BIG[box.name] == "Integral":
            return self._integral(row, place)
        if BIG[box.name] == "limit":
            raise FormulaError("\\lim is not read", "write the value of the limit")
        if not terms:
            raise FormulaError(f"\\{box.name} has no terms", "write the terms")
        ends = [*map(self.expression, (below[2:], box.sup))] if below[2:] and box.sup else []
        signs = [b.name for b in below[1:2]]
        if not below or below[0].kind != "letter" or signs != ["="] * len(ends[:1]) or bool(box.sup) != bool(ends):
            raise FormulaError("the limits of the sum are not clear", r"write \sum_{i=1}^{n}")
        self.bound.append(below[0].name)
        try:
            return Call(BIG[box.name], (self.term(terms), self.letter(below[0]), *ends)), len(row)
        finally:
            self.bound.pop()

    def _integral(self, row: list[Box], place: int) -> tuple[Node, int]:
        """Read an integral from its sign to its differential; return it and the position after it."""
        box, at, depth = row[place], place, 1
        while depth:
            at += 1
            if at >= len(row):
                raise FormulaError("the differential of the integral is missing", "write d and the variable")
            depth += _opens_integral(row[at]) - _closes_integral(row, at)
        variables, end, inner = list[Letter](), at, row[place + 1 : at]
        if row[at].kind == "fraction":  # \int \frac{dx}{x} f
            end = next((k for k in range(at, len(row)) if row[k].kind == "operator"), len(row))
            over = row[at].contents[0]
            start = next(k for k, b in enumerate(over) if is_mark(b, "d"))
            variables.append(self._variable(over[start:]))
            numerator = over[:start] or [Box("number", "1", row[at].at, row[at].at)]
            if any(b.kind == "operator" for b in inner):
                way = "write the differential at the end of the integrand"
                raise FormulaError("only one term of the integrand has a differential", way)
            inner = [*inner, replace(row[at], contents=[numerator, row[at].contents[1]]), *row[at + 1 : end]]
        else:
            variables.append(self._variable(row[end : end + 2]))
            end += 2
            if end < len(row) and (row[end].kind != "operator" or not inner):
                way = "write the differential last"
                raise self._unclear(box, "the factors after the differential are integrated", way=way)
        limits = [self.expression(limit) for limit in (box.sub, box.sup) if limit]
        if len(limits) == 1 or box.name != "int" or (inner and inner[-1].kind == "operator"):
            what = "the integral is not over one variable between two limits"
            raise FormulaError(what, "write one variable and two limits")
        return Call("Integral", (self.expression(inner) if inner else number(1), variables[0], *limits)), end

    def _variable(self, marks: list[Box]) -> Letter:
        """Read the variable of an integral from two boxes: the sign d and the symbol after it."""
        if len(marks) != 2 or marks[1].kind != "letter" or marks[1].sup or marks[0].sup:
            raise FormulaError("the differential of the integral is not clear", "write d and the variable")
        letter = self.letter(marks[1])
        if letter.vector:
            raise FormulaError("the integral is over a vector", "write one variable and two limits")
        return letter


# Readers of boxes that are a whole factor, and of boxes whose factor includes later boxes.
_SIMPLE: dict[str, Callable[[Grammar, Box], Node]] = {
    "bracket": Grammar._bracket, "group": Grammar._group, "root": Grammar._root, "matrix": Grammar._matrix,
    "infinity": lambda reader, box: Letter("oo"), "dots": lambda reader, box: Call("dots", ()),
    "binomial": lambda reader, box: Call("binomial", tuple(map(reader.expression, box.contents))),
}  # fmt: skip
_FACTORS: dict[str, Callable[[Grammar, list[Box], int], tuple[Node, int]]] = {
    "number": Grammar._number, "letter": Grammar._letter, "fraction": Grammar._fraction, "function": Grammar._function,
    "big": Grammar._big,
}  # fmt: skip
# Calls that can multiply a vector; functions whose argument may continue after a slash.
_SCALARS = ("sum", "product", "quotient", "negative", "power", "sqrt", "Abs", "norm", "dot", "Derivative", "rate")
_OPEN_ENDED = {*FUNCTIONS.values()} - {"exp"}


def _plain(bracket: str) -> str:
    return _NAMES.get(bracket.removeprefix("\\"), bracket)


def _product(factors: list[Node]) -> Node:
    """Return the product of adjacent factors. Raises FormulaError if two of them are vectors and none is a matrix."""
    vectors = [factor for factor in factors if is_vector(factor)]
    if len(vectors) > 1 and not all(map(is_matrix, vectors[:-1])):
        way = 'write \\cdot or \\times, or declare matrices = "…" in [notation]'
        raise FormulaError("two vectors are side by side", way)
    return Call("matmul", tuple(factors)) if len(vectors) > 1 else product_of(factors)


def _check_sums(terms: list[list[Box]]) -> None:
    """Raise FormulaError if a term after a term with Σ uses the index of that Σ: the end of Σ is then unclear."""
    indices: set[str] = set()
    for term in terms:
        letters = {inner.name for box in term for inner in all_boxes(box.sub or ()) if inner.kind == "letter"}
        sums = [box for box in term if box.kind == "big"]
        if letters & indices and not sums:
            raise FormulaError("it is unclear whether the sum ends here", "write brackets around the summand")
        indices |= {b.name for box in sums if box.name in ("sum", "prod") for b in box.sub or () if b.kind == "letter"}


def _check_neighbours(row: list[Box], place: int, previous: Box | None) -> None:
    """Raise FormulaError for a number after a factor, a mixed number, dots among factors, or symbols that form a word."""
    box = row[place]
    if box.kind == "dots" and len(row) > 1:
        raise FormulaError("dots stand for factors", "write the factors, or a product sign")
    if previous is not None and box.kind == "number" and (previous.kind == "number" or not box.spaced):
        raise FormulaError(f"the number {box.name} follows a factor", r"write \cdot, or braces around the power")
    numeric = box.kind == "fraction" and all(b.kind == "number" for content in box.contents for b in content)
    if previous is not None and previous.kind == "number" and numeric:
        raise FormulaError("it is unclear whether a mixed number or a product is meant", r"write \cdot")
    run = ""
    for item in row[place:]:
        plain = item.kind == "letter" and len(item.name) == 1 and not (item.style or item.marks or item.upright)
        run += item.name if plain else ""
        if not plain or run in _WORDS or len(run) > 4 or item.sub or item.sup or item.primes:
            break
    if run in _WORDS or len(run) > 4:
        raise FormulaError(f"{run} is a word", r"write \text{…} for words, and \sin for functions")


def _is_numeric(node: Node) -> bool:
    return not any(isinstance(inner, Letter) for inner in walk(node))


def _is_any_kind(node: Node) -> bool:
    """Return True if a term may be a number as well as a vector: it is 0, dots or O(…)."""
    return is_printed_zero(node) or (isinstance(node, Call) and node.name in ("dots", "order"))


def _derivative_of(node: Node, variable: Letter, times: int) -> Call:
    return Call("Derivative", (node, variable, number(times)) if times > 1 else (node, variable))


def _rate(node: Node, order: int) -> Node:
    r"""Return the time derivative of some order: x with dots for a symbol x, the call `rate` for any other expression."""
    dots = re.search(r"_(d*)dot$", node.name) if isinstance(node, Letter) else None
    total = order + (len(dots[1]) + 1 if dots else 0)
    if isinstance(node, Letter) and total <= 4:
        return replace(node, name=f"{node.name[: dots.start()] if dots else node.name}_{'d' * (total - 1)}dot")
    for _ in range(order):
        node = Call("rate", (node,))
    return node


def _order(box: Box) -> int:
    """Return the order of a derivative, which is the superscript of its sign d or ∂; 1 without a superscript."""
    if not box.sup:
        return 1
    if len(box.sup) == 1 and box.sup[0].kind == "number" and box.sup[0].name in "123456789":
        return int(box.sup[0].name)
    raise FormulaError("the order of the derivative is not a number", "write a number")


def _opens_integral(box: Box) -> bool:
    return box.kind == "big" and BIG[box.name] == "Integral"


def _closes_integral(row: list[Box], place: int) -> bool:
    """Return True if a differential begins at this position: d before a symbol, or a fraction with d in its numerator."""
    box = row[place]
    if box.kind == "fraction":
        return any(is_mark(b, "d") for b in box.contents[0]) and not is_derivative(box)
    target = row[place + 1] if place + 1 < len(row) else None
    return is_mark(box, "d") and target is not None and target.kind == "letter" and not is_mark(target, "d")


def _pair_bars(row: list[Box]) -> list[Box]:
    """Return a row in which each pair of bars | … | has become one bracket."""
    places = [k for k, box in enumerate(row) if box.kind == "bar"]
    if len(places) % 2:
        raise FormulaError("a bar has no partner", r"write \left| and \right|")
    paired: list[Box] = []
    last = 0
    for a, b in zip(places[::2], places[1::2], strict=True):
        inner, between = row[a + 1 : b], row[last:a]
        nested = last and between and all(x.kind not in ("operator", "relation") for x in between)
        odd = not inner or inner[-1].kind == "operator" or row[a].name != row[b].name
        if nested or odd or row[a].sup or row[a].sub:
            raise FormulaError("it is unclear how the bars belong together", r"write \left| and \right|")
        sign, shut = r"\|" if row[a].name == "||" else "|", row[b]
        bars = Box("bracket", sign, row[a].at, shut.end, [inner], sub=shut.sub, sup=shut.sup, closing=sign)
        paired += [*between, bars]
        last = b + 1
    return [*paired, *row[last:]]
