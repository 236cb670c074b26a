r"""The reader of expressions: a row of boxes as a tree of sums, products, functions, derivatives and integrals.

The reader takes nothing for granted that the print leaves open: a letter before a bracket is a function where the notation
declares it, x(t) is the coordinate x, and a sum in brackets is a factor. Every other sign that may mean two things stops the
reading with the entry of [notation], or the way of writing, that would settle it.
"""

import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

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
    parted,
    stem_of,
    strip,
    without_thin,
)
from lagrotor.paper.latex.notation import Notation, has_kind
from lagrotor.paper.latex.tree import (
    CONDITIONS,
    Call,
    Letter,
    Node,
    Number,
    is_matrix,
    is_printed_zero,
    is_vector,
    number,
    product_of,
)

_UNIT_NAMES = (
    "m s g kg K N J W V A C F H T Pa Hz rad sr mol cd eV keV MeV GeV cm mm nm km min h ms ns yr kHz MHz GHz kPa MPa GPa kN kJ "
    "kW MW mV kV mA nF pF mH mT deg Ohm Nm µm"
)
UNITS = frozenset(_UNIT_NAMES.split())
_UNIT_PARTS = re.compile(r"[A-Za-zµ%]+|\^\{?-?\d+\}?|[/.~\s·]")
_WORDS = frozenset(
    ["sin", "cos", "tan", "exp", "log", "ln", "det", "max", "min", "lim", "cot", "sinh", "cosh", "tanh", "const", "var"]
)
_MOST_DIGITS = 1000
_INVERSE = {"sin": "asin", "cos": "acos", "tan": "atan", "sinh": "asinh", "cosh": "acosh", "tanh": "atanh"}
_ANGLES = ("theta", "phi", "varphi", "psi", "vartheta", "chi", "alpha", "beta", "gamma")
_LAST = ("t", "tau", "x", "y", "z", "s")  # in which the argument of a sine without brackets ends
_LABELS = {"*": "star", "star": "star", "+": "plus", "-": "minus"}
_TRANSPOSES = ("T", "top", "intercal")
_FUNCTION_LIKE = ("delta", "Delta", "Gamma", "zeta")  # before a bracket these are no factors
_BRACKETS = {r"\lbrace": r"\{", r"\rbrace": r"\}", r"\vert": "|", r"\lvert": "|", r"\rvert": "|", r"\lVert": r"\|", r"\rVert": r"\|",
             r"\Vert": r"\|", "[": "(", "]": ")", r"\{": "(", r"\}": ")"}  # fmt: skip


class Grammar:
    """The reader of one formula in the notation of its paper."""

    def __init__(self, source: str, notation: Notation) -> None:
        self.source, self.notation = source, notation
        self.bound: list[str] = []  # the indices of the sums that are open here
        self.letters: frozenset[str] = frozenset()  # names of letters that stand by themselves in the formula
        self.indices: frozenset[str] = frozenset()  # names of letters in its indices

    def refused(self, box: Box, why: str, *kinds: str, way: str = "") -> FormulaError:
        """Return the stop at a letter, with the entries of [notation] that would allow it."""
        entries = " or ".join(f'{kind} = "{stem_of(box)}"' for kind in kinds)
        said = [f"write in paper.toml [notation] {entries}"] if kinds else []
        return FormulaError(box.at, why, ", or ".join([*said, *([way] if way else [])]))

    # ---- sums and products

    def expression(self, row: list[Box]) -> Node:
        """Return the sum that a row of boxes is. Raises FormulaError where it is none."""
        row = _paired(strip(row))
        if not row:
            raise FormulaError(0, "nothing stands here", "write what is meant")
        terms: list[tuple[str, list[Box]]] = [("+", [])]
        open_integrals = 0
        for place, box in enumerate(row):
            open_integrals += _opens_integral(box) - (open_integrals > 0 and _closes_integral(row, place))
            if box.name in ("pm", "mp") and box.kind == "operator":
                raise FormulaError(
                    box.at, f"\\{box.name} stands for two signs", "write two statements, one for each sign"
                )
            if box.kind == "operator" and box.name in ("+", "-") and not open_integrals:
                if strip(terms[-1][1]):
                    terms.append((box.name, []))
                    continue
                if len(terms) > 1 or place != next(k for k, b in enumerate(row) if b.kind != "thin"):
                    raise FormulaError(box.at, "two signs follow each other", "write brackets around the second")
                terms[-1] = (box.name, [])
            else:
                terms[-1][1].append(box)
        if not strip(terms[-1][1]):
            raise FormulaError(row[-1].at, "nothing follows the sign", "write what is added")
        made = [Call("negative", (self.term(part),)) if sign == "-" else self.term(part) for sign, part in terms]
        if len(made) == 1:
            return made[0]
        self._check_sums([part for _, part in terms])
        kinds = {(is_vector(each), is_matrix(each)) for each in made if not _is_any_kind(each)}
        if len(kinds) > 1:
            raise FormulaError(
                row[0].at, "a vector and a number are added", "declare the vectors in [notation], or mark them alike"
            )
        return Call("sum", tuple(made))

    def _check_sums(self, parts: list[list[Box]]) -> None:
        """Raise FormulaError where a term behind a sum holds the index of that sum."""
        indices: set[str] = set()
        for part in parts:
            held = {each.name for box in part for each in all_boxes(box.sub or ()) if each.kind == "letter"}
            if held & indices and not any(box.kind == "big" for box in part):
                raise FormulaError(
                    part[0].at, "whether the sum ends here is open", "write brackets around what is summed"
                )
            for box in part:
                if box.kind == "big" and box.name in ("sum", "prod"):
                    indices |= {each.name for each in box.sub or () if each.kind == "letter"}

    def term(self, row: list[Box]) -> Node:
        """Return the product that a row of boxes is, its groups joined by signs."""
        row = _folded(strip(row))
        groups: list[tuple[str, list[Node], list[Box]]] = [("", [], [])]
        place = 0
        while place < len(row):
            box = row[place]
            if box.kind == "operator" and box.name in ("cdot", "times", "/", "*"):
                if not groups[-1][1]:
                    raise FormulaError(box.at, f"nothing stands before {box.name}", "write the first factor")
                groups.append((box.name, [], []))
                place += 1
            elif box.kind == "thin":
                place += 1
            else:
                self._check_neighbours(row, place, groups[-1])
                node, behind = self.factor(row, place)
                groups[-1][1].append(node)
                groups[-1][2].extend(row[place:behind])
                place = behind
        if not groups[-1][1]:
            raise FormulaError(row[-1].at if row else 0, "nothing follows the sign", "write the second factor")
        made: Node | None = None
        for sign, factors, part in groups:
            right = self.product(factors, part)
            made = right if made is None else self._joined(made, sign, right, factors, part)
        assert made is not None
        return made

    def _check_neighbours(self, row: list[Box], place: int, group: tuple[str, list[Node], list[Box]]) -> None:
        """Raise FormulaError for a digit behind a factor, a mixed number, a word, and a second factor behind a slash."""
        box, before = row[place], row[place - 1] if place else None
        sign, factors, part = group
        if factors and sign == "/":
            raise FormulaError(box.at, "what the slash divides by is open", r"write \frac or brackets")
        if factors and box.kind == "number" and (part[-1].kind == "number" or (before and before.kind != "thin")):
            raise FormulaError(
                box.at, f"the number {box.name} stands behind a factor", r"write \cdot, or braces around the power"
            )
        if (
            before
            and before.kind == "number"
            and box.kind == "fraction"
            and all(b.kind == "number" for p in box.parts for b in p)
        ):
            raise FormulaError(box.at, "whether a mixed number or a product is meant is open", r"write \cdot")
        run = ""
        for each in row[place:]:
            if each.kind != "letter" or len(each.name) > 1 or each.style or each.marks or each.upright:
                break
            run += each.name
            if run in _WORDS or len(run) > 4 or each.sub or each.sup or each.primes:
                break
        if run in _WORDS or len(run) > 4:
            raise FormulaError(box.at, f"{run} is a word", r"write \text{…} for words, and \sin for functions")

    def product(self, factors: list[Node], part: list[Box]) -> Node:
        """Return the product of factors side by side."""
        vectors = [each for each in factors if is_vector(each)]
        if len(vectors) < 2:
            return product_of(factors)
        if not all(is_matrix(each) for each in vectors[:-1]):
            why = "two vectors stand side by side"
            raise FormulaError(part[0].at, why, 'write \\cdot or \\times, or declare matrices = "…" in [notation]')
        return Call("matmul", tuple(factors))

    def _joined(self, made: Node, sign: str, right: Node, factors: list[Node], part: list[Box]) -> Node:
        """Return two factors joined by a sign."""
        left_vector, right_vector = is_vector(made), is_vector(right)
        if sign == "/":
            if part[0].upright and part[0].name in UNITS:
                raise FormulaError(
                    part[0].at, f"whether upright {part[0].name} is a unit is open", r"write \mathrm{m/s}"
                )
            if right_vector:
                raise FormulaError(part[0].at, "a vector is divided by", "write its length")
            last = made.args[-1] if isinstance(made, Call) and made.name == "product" else made
            if (
                isinstance(last, Call)
                and {last.name, *(n.name for n in last.args[:1] if isinstance(n, Call) and last.name == "power")}
                & _OPEN_ENDED
                and self.source[: part[0].at].rstrip(" /")[-1:] not in ")]}"
            ):
                raise FormulaError(part[0].at, "whether the slash is within the function is open", "write brackets")
            return Call("quotient", (made, right))
        matrices = is_matrix(made) or is_matrix(right)
        if left_vector and right_vector and not matrices:
            if sign == "*":
                raise FormulaError(part[0].at, "two vectors are multiplied by *", r"write \cdot or \times")
            closed = self.source[: part[0].at].rstrip()
            if (
                sign == "times"
                and isinstance(made, Call)
                and made.name == "cross"
                and not re.search(r"[)\]]\s*\\times$", closed)
            ):
                raise FormulaError(part[0].at, "which × comes first is open", "write brackets")
            return Call("dot" if sign == "cdot" else "cross", (made, right))
        if left_vector and right_vector:
            if sign == "times":
                raise FormulaError(part[0].at, "× stands between matrices", "write them side by side")
            return self.product([made, right], part)
        other = right if left_vector else made if right_vector else None
        if sign == "cdot" and isinstance(other, Call) and other.name not in (*_SCALARS, *FUNCTIONS.values()):
            raise FormulaError(part[0].at, f"whether {other.name} is a vector is open", "write it without the dot")
        if sign == "times" and not (_is_numeric(made) or _is_numeric(right)):
            why = "whether × is of vectors or of numbers is open"
            raise FormulaError(part[0].at, why, r"declare the vectors in [notation], or write \cdot")
        return product_of([made, right])

    def factor(self, row: list[Box], place: int) -> tuple[Node, int]:
        """Return one factor and the place behind it."""
        box = row[place]
        read = _FACTORS.get(box.kind)
        if box.kind == "letter" and box.upright and len(box.name) > 1 and box.name in FUNCTIONS and not box.marks:
            read = Grammar._function
        if read is None:
            raise FormulaError(box.at, f"{self.source[box.at : box.end]} is not read here", "write what it stands for")
        if box.sub is not None and box.kind not in ("letter", "bracket", "function", "big", "partial"):
            raise FormulaError(box.at, f"an index stands at {self.source[box.at : box.end]}", "write it on a letter")
        node, behind = read(self, row, place)
        if behind < len(row) and row[behind].name == "!":
            if box.kind == "function":
                raise FormulaError(row[behind].at, "! is of the argument or of the function", "write brackets")
            node, behind = Call("factorial", (node,)), behind + 1
            if behind < len(row) and row[behind].name == "!":
                raise FormulaError(row[behind].at, "!! is not read", "write the product")
        return node, behind

    # ---- letters

    def _kind(self, box: Box, *kinds: str) -> bool:
        """Whether the notation declares a letter to be one of these kinds."""
        return any(has_kind(self.notation, kind, box) for kind in kinds)

    def letter(self, box: Box) -> Letter:
        """Return the letter without its power. Raises FormulaError where its kind is not declared."""
        if self._kind(box, "operators"):
            raise FormulaError(box.at, f"{stem_of(box)} is an operator", "products with operators are not read")
        dots = [mark.endswith("dot") for mark in box.marks]
        if dots != sorted(dots):
            raise FormulaError(box.at, f"a mark stands over the dot of {box.name}", "give the rate a letter")
        matrix = self._kind(box, "matrices")
        vector = matrix or self._kind(box, "vectors")
        if is_printed_as_vector(box) and not vector:
            raise self.refused(
                box, f"{self.source[box.at : box.end]} is printed as a vector or a matrix", "vectors", "matrices"
            )
        return Letter(name_of(box, index_of(box), self._label(box) or ()), vector, matrix)

    def _label(self, box: Box) -> list[str] | None:
        """Return what a superscript adds to the name of a letter; None where the superscript is a power."""
        row = without_thin(box.sup or ())
        only = row[0] if len(row) == 1 else None
        if only is None:
            return None
        if only.kind == "operator" and only.name in _LABELS:
            return [_LABELS[only.name]]
        if only.kind == "bracket" and only.name == "(" and len(only.parts[0]) == 1 and not self._kind(box, "functions"):
            inner = only.parts[0][0]
            if inner.kind in ("number", "letter") and not (inner.sup or inner.sub):
                return [inner.name]
        if only.kind == "text" and only.name.isalnum():
            return [only.name]
        if (
            only.kind == "letter"
            and only.upright
            and (len(only.name) > 1 or only.name not in (*_TRANSPOSES, "d", "e", "i"))
        ):
            return [only.name]
        return None

    def _letter(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if not (box.marks or box.style or box.sub or box.primes) and (made := self._sign(row, place)) is not None:
            return made
        after = row[place + 1] if place + 1 < len(row) else None
        varies = box.name == "delta" and box.sub and [b.name for b in box.sub] in (["x"], ["y"], ["z"], ["t"])
        if (varies and after and after.kind == "letter") or (box.name == "d" and box.upright and box.primes):
            raise FormulaError(box.at, f"whether {box.name} acts on what follows is open", r"write \cdot for a product")
        if (
            box.upright
            and len(box.name) > 1
            and rf"\{box.name}" not in GREEK
            and after
            and after.kind in ("letter", "bracket")
        ):
            raise FormulaError(
                box.at,
                f"whether {box.name} acts on what follows is open",
                rf"write \operatorname{{{box.name}}}(…) or \cdot",
            )
        if after is not None and after.kind == "bracket" and _BRACKETS.get(after.name, after.name) == "(":
            if (made := self._applied(box, after)) is not None:
                return made, place + 2
        if box.primes and self._kind(box, "functions"):
            made: Node = self.letter(replace(box, primes=0))
            for _ in range(box.primes):
                made = Call("prime", (made,))
            return self.power(made, box), place + 1
        return self.power(self.letter(box), box), place + 1

    def _sign(self, row: list[Box], place: int) -> tuple[Node, int] | None:
        """Return a letter that is a sign: e, i, π, d and Δ; None where it is a letter like others."""
        box, after = row[place], row[place + 1] if place + 1 < len(row) else None
        name, declared = (
            box.name,
            self._kind(box, "functions", "vectors", "matrices", "indices", "complex", "positive", "real"),
        )
        if name == "e" and (self._kind(box, "numbers") or box.upright):
            return Call("exp", (self.expression(box.sup) if box.sup else number(1),)), place + 1
        if (
            name == "e"
            and box.sup
            and not declared
            and any(b.kind in ("letter", "infinity", "fraction") for b in all_boxes(box.sup))
        ):
            raise self.refused(box, "whether e is Euler's number is open", "numbers", way="write \\exp(…)")
        if name in ("i", "j") and name not in self.bound:
            if self._kind(box, "numbers") or (box.upright and name == "i"):
                return self.power(Letter("imaginary_unit"), box), place + 1
            if name == "i" and not declared:
                raise self.refused(box, "whether i is the imaginary unit is open", "numbers", "indices")
        if name == "pi" and self._kind(box, "functions") and not (after is not None and after.kind == "bracket"):
            raise FormulaError(box.at, "whether pi is the number or a quantity is open", "give the quantity an index")
        if name == "pi" and not declared:
            return self.power(Letter("pi"), box), place + 1
        acts = after is not None and after.kind in ("letter", "bracket", "group", "partial")
        if name == "d" and acts and not declared:
            return self._differential(row, place)
        if name in ("Delta", "delta") and acts and not declared and not box.sup and after is not None:
            if after.kind != "letter" or stem_of(box) in self.letters:
                raise self.refused(
                    box,
                    f"whether \\{name} is a factor or acts on what follows is open",
                    "functions",
                    way=r"write \cdot",
                )
            changed = self.letter(after)
            changed = replace(changed, name=f"{name}_{changed.name}")
            behind = row[place + 2] if place + 2 < len(row) else None
            if behind is not None and behind.kind == "bracket":
                if self._kind(after, "functions") and not (after.sup or behind.sup):
                    return Call(changed.name, tuple(map(self.expression, parted(behind.parts[0], "comma")))), place + 3
                if [b.name for b in without_thin(behind.parts[0])] != ["t"] or behind.sup:
                    raise self.refused(
                        after, f"whether \\{name} {after.name} is a function or a factor is open", "functions"
                    )
                return self.power(changed, after), place + 3
            return self.power(changed, after), place + 2
        return None

    def _differential(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""Read \mathrm{d}x and \mathrm{d}^3r; an italic d before a letter may be a distance."""
        box, target = row[place], row[place + 1]
        if not box.upright:
            why = "whether d before a letter is a factor or a differential is open"
            raise FormulaError(box.at, why, r"write \cdot behind it, or \mathrm{d} for a differential")
        if target.kind not in ("letter", "bracket"):
            raise FormulaError(target.at, "a differential is of no letter", "write brackets around what it is of")
        if target.kind == "letter" and target.sup:
            raise FormulaError(target.at, "a differential has a power", "write brackets around it")
        inner = self.letter(target) if target.kind == "letter" else self.expression(target.parts[0])
        order = (self.expression(box.sup),) if box.sup else ()
        return Call("differential", (inner, *order)), place + 2

    def _applied(self, box: Box, bracket: Box) -> Node | None:
        """Return a letter as a function of the bracket behind it, x for x(t); None where it is a factor."""
        content = without_thin(bracket.parts[0])
        plain = stem_of(box)
        if plain in ("O", "Ocal") and not (box.sub or box.sup):
            return Call("order", (self.expression(content),))
        if self._kind(box, "real", "positive", "complex"):
            return None
        if self._kind(box, "functions"):
            self._check_call(box, bracket)
            return self._call(box, bracket)
        if (
            bracket.name == "("
            and [(b.kind, b.name, b.sup) for b in content] == [("letter", "t", None)]
            and "t" not in self.bound
        ):
            return self.power(self.power(self.letter(box), box), bracket)
        adds = any(b.kind == "operator" and b.name in ("+", "-") for b in content[1:])
        late = any([b.name for b in part] == ["t"] for part in parted(content, "operator"))  # x(t - \tau)
        derived = [b.kind for b in content] == ["fraction"] and bool(bracket.sup or is_derivative(content[0]))
        if (
            (adds or derived)
            and not late
            and plain not in _FUNCTION_LIKE
            and not any(b.kind in ("comma", "relation") for b in content)
        ):
            return None
        why = f"{self.source[box.at : box.end]} before {bracket.name} is a function or a factor"
        raise self.refused(box, why, "functions", "real")

    def _check_call(self, box: Box, bracket: Box) -> None:
        """Raise FormulaError where the bracket behind a function holds rates in a sum or the function itself."""
        held = without_thin(bracket.parts[0])
        derived = any(b.kind == "partial" or is_derivative(b) for b in held) or (
            len(held) > 1 and any(map(self._moves, held))
        )
        itself = len(held) > 1 and any(b.kind == "letter" and stem_of(b) == stem_of(box) for b in held)
        if (derived or itself) and not any(b.kind == "comma" for b in held):
            raise FormulaError(box.at, f"whether {stem_of(box)} is a factor here is open", "write \\cdot for a product")

    def _call(self, box: Box, bracket: Box) -> Node:
        """Return a declared function of its arguments; of V'(r) the derivative."""
        arguments = tuple(self.expression(part) for part in parted(bracket.parts[0], "comma"))
        if bracket.sub:
            raise FormulaError(bracket.at, "an index stands at a bracket", "write it on a letter")
        above = without_thin(box.sup or ())
        inverse = [b.name for b in above] == ["-", "1"]
        if inverse or any(b.kind == "bracket" for b in above) or any(b.kind == "letter" for b in above):
            why = f"whether {self.source[box.at : box.end]} has a power is open"
            raise FormulaError(box.at, why, "write brackets around what is raised, or the function by another letter")
        named = self.letter(replace(box, primes=0))
        if named.vector and not named.name.split("_")[0].endswith(("bold", "vec")):
            raise FormulaError(box.at, f"{named.name} is a vector and a function", "print it in bold")
        variable = arguments[0] if len(arguments) == 1 else None
        if box.primes and isinstance(variable, Letter):
            order = (number(box.primes),) if box.primes > 1 else ()
            made = Call("Derivative", (Call(named.name, arguments), variable, *order))
        else:
            made = Call(name_of(box, index_of(box)) if box.primes else named.name, arguments)
        return self.power(made if self._label(box) else self.power(made, box), bracket)

    def power(self, node: Node, box: Box) -> Node:
        """Return the node to the power that its box has."""
        if box.sup is None or (box.kind == "letter" and self._label(box) is not None):
            return node
        row = without_thin(box.sup)
        if not row:
            raise FormulaError(box.at, "a power is empty", "write it")
        only = row[0] if len(row) == 1 else None
        if (
            only is not None
            and only.kind == "letter"
            and only.name in _TRANSPOSES
            and (is_vector(node) or only.name != "T")
        ):
            if not is_vector(node):
                raise self.refused(box, f"{only.name} transposes what is no matrix", "matrices")
            return Call("transpose", (node,))
        if only is not None and only.name == "T" and isinstance(node, Letter):
            raise self.refused(
                box,
                f"whether {node.name} is transposed or has a power is open",
                "matrices",
                way="write the power in brackets",
            )
        self._check_power(box, row)
        power = self.expression(box.sup)
        if is_matrix(node):
            if power == Call("negative", (number(1),)):
                return Call("inverse", (node,))
            if not isinstance(power, Number):
                raise FormulaError(row[0].at, "a matrix has a power that is no number", "write the product")
        elif is_vector(node):
            if power != number(2):
                raise FormulaError(row[0].at, "a vector has a power", "write its length")
            return Call("dot", (node, node))
        if power == Call("quotient", (number(1), number(2))):
            return Call("sqrt", (node,))
        return Call("power", (node, power))

    def _check_power(self, box: Box, row: list[Box]) -> None:
        """Raise FormulaError for marks and upper indices that stand where a power does."""
        names = [b.name for b in row if b.kind == "letter"]
        marks = [
            b for b in row if b.kind in ("text", "relation", "comma") or b.primes or b.name in ("dagger", "prime", "*")
        ]
        if marks:
            raise FormulaError(
                row[0].at, f"{self.source[row[0].at : row[-1].end]} stands where a power does", "write it as an index"
            )
        if row[0].kind == "bracket" and len(row) == 1:
            raise FormulaError(
                row[0].at, "whether a number in brackets is a power is open", "write a power without them"
            )
        if box.kind != "letter" or not row:
            return
        numbers = [b for b in row if b.kind == "letter" and self._kind(b, "positive", "complex", "real")]
        if len(names) == len(row) > 1 or (
            len(numbers) < len(names)
            and (
                any(
                    self._kind(b, "indices") or b.name in ("mu", "nu") or b.name in self.indices - self.letters
                    for b in row
                    if b.kind == "letter"
                )
                or (box.sub and any(b.kind == "letter" for b in box.sub))
            )
        ):
            why = f"whether {self.source[row[0].at : row[-1].end]} is an upper index or a power is open"
            raise FormulaError(
                row[0].at,
                why,
                f'write \\cdot or brackets, or in paper.toml [notation] real = "{(names or [""])[0]}"',
            )
        if [b.name for b in row] == ["0"]:
            raise FormulaError(row[0].at, "whether 0 is an upper index or a power is open", "write the index below")

    # ---- numbers

    def _number(self, row: list[Box], place: int) -> tuple[Node, int]:
        box, behind = row[place], place + 1
        node: Node = Number(self._value(box))
        after = next((b for b in row[behind:] if b.kind != "thin"), None)
        if after is not None and after.upright and after.name not in (*UNITS, *FUNCTIONS, "d", "e", "i"):
            raise FormulaError(
                after.at, f"upright {after.name} behind a number is no known unit", "write it in italics"
            )
        if box.sup and [b.name for b in box.sup] in (["circ"], ["degree"], ["o"]):
            if after is not None and after.name in ("C", "F"):
                raise FormulaError(after.at, f"a temperature in degrees {after.name} is not read", "write it in K")
            return Call("quotient", (product_of([node, Letter("pi")]), number(180))), behind
        node = self.power(node, box)
        unit = next((k for k in range(behind, len(row)) if row[k].kind != "thin"), len(row))
        if unit < len(row) and row[unit].kind == "percent":
            return Call("quotient", (node, number(100))), unit + 1
        if unit < len(row) and (row[unit].kind == "unit" or (row[unit].kind == "text" and is_unit(row[unit].name))):
            return product_of([node, _unit(row[unit])]), unit + 1
        factors = [node]
        while unit < len(row) and row[unit].upright and row[unit].name in UNITS and row[unit].sub is None:
            factors.append(self.power(Letter(f"unit_{row[unit].name}"), row[unit]))
            behind = unit + 1
            unit = next((k for k in range(behind, len(row)) if row[k].kind != "thin"), len(row))
        return product_of(factors), behind

    def _value(self, box: Box) -> Fraction:
        text = box.name
        if len(text) > _MOST_DIGITS:
            raise FormulaError(
                box.at, f"{text[:12]}…: a number has more than {_MOST_DIGITS} digits", "give it a letter"
            )
        if "{,}" not in text:
            return Fraction(text)
        whole, *groups = text.split("{,}")
        thousands = whole != "0" and all(len(each.partition(".")[0]) == 3 for each in groups)
        if thousands and not self.notation.decimal_comma:
            return Fraction(whole + "".join(groups))
        if len(groups) > 1 or "." in text:
            raise FormulaError(box.at, f"{text} is no number", "write a decimal point")
        return Fraction(f"{whole}.{groups[0]}")

    def _unit(self, row: list[Box], place: int) -> tuple[Node, int]:
        raise FormulaError(row[place].at, f"{row[place].name} is no letter of a formula", r"write \text{…} for words")

    # ---- functions by name

    def _function(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        name = FUNCTIONS.get(box.name, box.name)
        inner, behind = self._argument(row, place)
        if box.sub is not None and name != "log":
            raise FormulaError(box.at, f"{box.name} has an index", "write what it means")
        if box.sup is not None and [b.name for b in box.sup] == ["-", "1"]:
            if name not in _INVERSE:
                raise FormulaError(
                    box.at, f"whether {box.name}^{{-1}} is the inverse function is open", "write a fraction"
                )
            return Call(_INVERSE[name], inner), behind
        made: Node = Call(name.lower() if name == "Tr" else name, inner)
        if name == "log10" or (name == "log" and box.sub):
            base = self.expression(box.sub) if box.sub else number(10)
            made = Call("quotient", (Call("log", inner), Call("log", (base,))))
        if box.sup is None:
            return made, behind
        if box.name not in FUNCTIONS or [b.kind for b in box.sup] == ["bracket"]:
            raise FormulaError(
                box.at,
                f"whether {box.name} has an upper index or a power is open",
                "write brackets around what is raised",
            )
        return Call("power", (made, self.expression(box.sup))), behind

    def _argument(self, row: list[Box], place: int) -> tuple[tuple[Node, ...], int]:
        """Return the arguments of a function and the place behind them."""
        box = row[place]
        start = next((k for k in range(place + 1, len(row)) if row[k].kind != "thin"), len(row))
        first = row[start] if start < len(row) else None
        if first is None or first.kind in ("operator", "comma", "big"):
            raise FormulaError(box.at, f"{box.name} has no argument", "write it in brackets")
        if first.kind == "bracket" and _BRACKETS.get(first.name, first.name) == "(":
            if first.sub or first.sup:
                raise FormulaError(
                    first.at, "whether the power is of the argument or of the function is open", "write brackets"
                )
            return tuple(self.expression(part) for part in parted(first.parts[0], "comma")), start + 1
        named = FUNCTIONS.get(box.name, box.name)
        if first.kind == "matrix" and first.sup is None:
            return (self.expression([first]),), start + 1
        if box.name not in FUNCTIONS or named in ("det", "tr", "Tr", "arg", "Re", "Im", "max", "min"):
            alone = first.kind == "letter" and all(
                b.kind == "operator" for b in without_thin(row[start + 1 : start + 2])
            )
            if not alone:
                raise FormulaError(first.at, f"where the argument of {box.name} ends is open", "write it in brackets")
            return (self.expression([first]),), start + 1
        if first.kind in ("function", "bracket") and not first.sup and box.name in FUNCTIONS:
            node, behind = self.factor(row, start)
            return (node,), behind
        end = self._reach(row, start, box)
        if any(each.sup is not None and self._label(each) is None for each in row[start:end] if each.name != "e"):
            raise FormulaError(
                first.at, "whether the power is of the argument or of the function is open", "write brackets"
            )
        return (self.term(row[start:end]),), end

    def _reach(self, row: list[Box], start: int, function: Box) -> int:
        """Return where the argument of a function without brackets ends."""
        end = start
        while (
            end < len(row)
            and row[end].kind in ("number", "letter", "fraction", "root", "group")
            and not self._moves(row[end])
        ):
            end += 1
        run, after = row[start:end], row[end] if end < len(row) else None
        names = [each.name for each in run]
        ends = after is None or after.kind in ("operator", "thin", "function", "big") or self._moves(after)
        if len(run) == 1 and (ends or (names[0] in _ANGLES and after is not None and after.kind == "bracket")):
            return end
        if len(run) > 1 and run[0].kind == "letter" and names[0] in _ANGLES and names[1:] != ["t"] and not run[0].sub:
            run = []  # cos(θ) x or cos(θ x)
        letters = [each for each in run if each.kind == "letter"]
        plain = len(letters) + (bool(run) and run[0].kind in ("number", "fraction")) == len(run)
        if (
            ends
            and plain
            and len(run) > 1
            and (names[-1] in _LAST or "pi" in names or len(letters) == 1)
            and names[0] not in _LAST
        ):
            return end
        raise FormulaError(row[start].at, f"where the argument of {function.name} ends is open", "write it in brackets")

    def _moves(self, box: Box) -> bool:
        """Whether a box is a velocity or a vector, which ends the argument of a function."""
        if box.kind == "letter":
            return any(mark.endswith("dot") for mark in box.marks) or self._kind(box, "vectors")
        return box.kind == "fraction" and bool(is_derivative(box))

    # ---- brackets, roots, matrices

    def _bracket(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        pair = _BRACKETS.get(box.name, box.name), _BRACKETS.get(box.closing, box.closing)
        content = without_thin(box.parts[0])
        if pair == (".", "|"):
            return self._at(box, content), place + 1
        if box.sub is not None:
            raise FormulaError(
                box.at, "an index stands at a bracket", "write what it means, or give the bracket a letter"
            )
        if pair in (("|", "|"), (r"\|", r"\|")):
            inner = self.expression(content)
            if is_matrix(inner):
                raise FormulaError(box.at, "whether the bars are a determinant or a length is open", r"write \det")
            if pair[0] != "|" and not is_vector(inner):
                raise FormulaError(
                    box.at, "‖…‖ is of a letter that is no vector", 'write in paper.toml [notation] vectors = "…"'
                )
            return self.power(Call("norm" if is_vector(inner) else "Abs", (inner,)), box), place + 1
        if pair == (r"\{", ".") or (box.name in (r"\{", r"\lbrace") and box.closing == "."):
            if len(content) == 1 and content[0].kind in ("matrix", "rows"):
                return self._cases(content, 0)[0], place + 1
        if pair not in (("(", ")"), (".", ".")):
            raise FormulaError(
                box.at, f"{box.name} … {box.closing} is not read", "means, kets and open brackets are not read"
            )
        parts = [strip(part) for part in parted(box.parts[0], "comma")]
        if any(b.kind == "relation" for b in content):
            raise FormulaError(content[0].at, "a relation stands in brackets", "write it by itself")
        if len(parts) == 1:
            return self.power(self.expression(content), box), place + 1
        if box.name != "(" or not all(parts):
            raise FormulaError(
                box.at,
                f"{box.name}…, …{box.closing} is not read",
                "commutators, Poisson brackets and intervals are not read",
            )
        return self.power(Call("column", tuple(map(self.expression, parts))), box), place + 1

    def _at(self, box: Box, content: list[Box]) -> Node:
        """Read an expression at a place, |_{x = 0}, or between two."""
        where = parted(box.sub or [], "relation")
        if not (len(where) == 2 and all(where)) or (box.sup and len(where[0]) != 1):
            raise FormulaError(box.at, "where it is evaluated is not an equation", "write |_{x = 0}")
        node, variable, value = self.expression(content), self.expression(where[0]), self.expression(where[1])
        if box.sup:
            return Call(
                "sum",
                (
                    Call("at", (node, variable, self.expression(box.sup))),
                    Call("negative", (Call("at", (node, variable, value)),)),
                ),
            )
        return Call("at", (node, variable, value))

    def _group(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        content = strip(box.parts[0])
        if any(b.kind == "operator" and b.name in ("+", "-") for b in content[1:]) and (box.sup or len(strip(row)) > 1):
            raise FormulaError(box.at, "whether brackets stand around a sum is open", "write brackets")
        return self.power(self.expression(content), box), place + 1

    def _root(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        inner = self.expression(box.parts[0])
        if len(box.parts) > 1:
            inner = Call("power", (inner, Call("quotient", (number(1), self.expression(box.parts[1])))))
        else:
            inner = Call("sqrt", (inner,))
        return self.power(inner, box), place + 1

    def _binomial(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        return self.power(Call("binomial", tuple(map(self.expression, box.parts))), box), place + 1

    def _infinity(self, row: list[Box], place: int) -> tuple[Node, int]:
        return self.power(Letter("oo"), row[place]), place + 1

    def _dots(self, row: list[Box], place: int) -> tuple[Node, int]:
        if len(strip(row)) > 1:
            raise FormulaError(row[place].at, "dots stand for factors", "write them, or as a product")
        return Call("dots", ()), place + 1

    def _accent(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""Read \dot{(…)} and \overrightarrow{AB}."""
        box = row[place]
        letters = [b for b in box.parts[0] if b.kind == "letter" and not (b.sub or b.sup or b.marks)]
        if box.name == "vec" and len(letters) == len(box.parts[0]):
            arrow = Box(
                "letter", "".join(b.name for b in letters), box.at, box.end, marks=("vec",), sub=box.sub, sup=box.sup
            )
            return self.power(self.letter(arrow), arrow), place + 1
        if box.name not in ("dot", "ddot"):
            raise FormulaError(box.at, f"a {box.name} stands over several signs", "give them a letter")
        made = Call("rate", (self.expression(box.parts[0]),))
        return self.power(Call("rate", (made,)) if box.name == "ddot" else made, box), place + 1

    def _matrix(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        lines = [[self.expression(cell) for cell in line.parts] for line in box.parts[0]]
        if not lines or len({len(line) for line in lines}) != 1:
            raise FormulaError(box.at, "the rows of a matrix have different lengths", "write every entry")
        if len(lines[0]) == 1 and box.name != "vmatrix":
            return self.power(Call("column", tuple(line[0] for line in lines)), box), place + 1
        rows = tuple(Call("row", tuple(line)) for line in lines)
        made = Call("det", (Call("matrix", rows),)) if box.name == "vmatrix" else Call("matrix", rows)
        return self.power(made, box), place + 1

    def _cases(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        made: list[Node] = []
        for line in box.parts[0]:
            if len(line.parts) != 2:
                raise FormulaError(box.at, "a case has no condition", "write the value, &, and where it holds")
            value, where = (strip(cell) for cell in line.parts)
            words = [b.name.strip(" ,.;").lower() for b in where if b.kind == "text"]
            where = [b for b in where if b.kind not in ("text", "wide", "thin")]
            if where and len(words) < 2 and {*words} <= {"if", "for", "when"}:
                condition = self.condition(where)
            elif not where and words in (["otherwise"], ["else"]):
                condition = Letter("otherwise")
            else:
                raise FormulaError(
                    box.at, "the condition of a case is not read", r"write a relation, or \text{otherwise}"
                )
            made.append(Call("case", (self.expression(value), condition)))
        return Call("cases", tuple(made)), place + 1

    def condition(self, row: list[Box]) -> Node:
        """Return a relation, or a chain of relations, as a node."""
        signs = [k for k, b in enumerate(row) if b.kind == "relation"]
        if not signs or any(row[k].name not in CONDITIONS for k in signs):
            raise FormulaError(row[0].at, "a condition is no relation", "write one relation")
        sides = [self.expression(row[a + 1 : b]) for a, b in pairwise([-1, *signs, len(row)])]
        each = [Call(CONDITIONS[row[k].name], two) for k, two in zip(signs, pairwise(sides), strict=True)]
        return each[0] if len(each) == 1 else Call("And", tuple(each))

    # ---- fractions and derivatives

    def _fraction(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        mark = is_derivative(box)
        if mark:
            return self._derivative(row, place, mark)
        first, second = (without_thin(part)[:1] for part in box.parts)
        if (
            first
            and second
            and first[0].name == second[0].name
            and first[0].name in ("d", "D", "partial", "delta")
            and len(box.parts[1]) > 1
        ):
            why = f"whether the fraction with {first[0].name} is a derivative is open"
            raise FormulaError(box.at, why, r"write \frac{\mathrm{d} f}{\mathrm{d} x}")
        over, under = (self.expression(part) for part in box.parts)
        if is_vector(under):
            raise FormulaError(box.at, "a vector is divided by", "write its length")
        return self.power(Call("quotient", (over, under)), box), place + 1

    def _derivative(self, row: list[Box], place: int, mark: str) -> tuple[Node, int]:
        box = row[place]
        over, under = (without_thin(part) for part in box.parts)
        order, variables, behind = _order(over[0]), self._variables(under, mark), place + 1
        if sum(times for _, times in variables) != order:
            raise FormulaError(box.at, "the orders of the derivative differ", "write the same order above and below")
        if over[1:]:
            node = self.expression(over[1:])
        else:
            node, behind = self._operand(row, behind, box)
        if behind < len(row) and over[1:] and row[behind].kind == "bracket" and row[behind].name == "(":
            at = without_thin(row[behind].parts[0])
            if [b.name for b in at] != ["t"] or variables != [(Letter("t"), order)]:
                if not any(b.kind == "operator" for b in at[1:]):
                    raise FormulaError(
                        row[behind].at,
                        "whether a derivative is taken there or multiplied is open",
                        r"write |_{t = 0} or \cdot",
                    )
            else:
                behind += 1  # \frac{dx}{dt}(t)
        if mark == "d" and len(variables) == 1 and variables[0][0] == Letter("t"):
            made = _rate(node, order)
        else:
            made = node
            for variable, times in variables:
                made = Call("Derivative", (made, variable, number(times)) if times > 1 else (made, variable))
        return (self.power(made, box) if over[1:] else made), behind

    def _variables(self, under: list[Box], mark: str) -> list[tuple[Node, int]]:
        found: list[tuple[Node, int]] = []
        for sign, target in zip(under[::2], under[1::2], strict=False):
            if not is_mark(sign, mark) or sign.sup or target.kind != "letter" or len(under) % 2:
                raise FormulaError(sign.at, "what is differentiated by is not clear", r"write \frac{d f}{d x}")
            found.append((self.letter(replace(target, sup=None)), _order(target)))
        return found

    def _operand(self, row: list[Box], place: int, box: Box) -> tuple[Node, int]:
        """Return what a derivative acts on: the one factor, or the bracket, that follows it."""
        rest = strip(row[place:])
        if not rest or rest[0].kind == "operator":
            raise FormulaError(box.at, "the derivative has nothing to act on", "operators by themselves are not read")
        start = (
            len(row) - len(rest)
            if row[-1] is rest[-1]
            else next(k for k in range(place, len(row)) if row[k] is rest[0])
        )
        node, behind = self.factor(row, start)
        remaining = without_thin(row[behind:])
        if (
            remaining
            and row[start].kind != "bracket"
            and not (remaining[0].kind == "operator" and remaining[0].name != "/")
        ):
            raise FormulaError(
                box.at, "how far the derivative reaches is open", "write brackets around what is differentiated"
            )
        if remaining and remaining[0].kind == "operator" and row[start].kind != "bracket":
            raise FormulaError(
                box.at, "how far the derivative reaches is open", "write brackets around what is differentiated"
            )
        return node, behind

    def _partial(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""Read \partial_x f and \partial_t^2 f."""
        box = row[place]
        below = box.sub or []
        named = len(below) == 1 and below[0].kind == "letter"
        if not named or below[0].name in ("i", "j", "k", "l", "m", "n", "mu", "nu") or self._kind(below[0], "indices"):
            raise FormulaError(box.at, "what ∂ differentiates by is not clear", r"write \frac{\partial f}{\partial x}")
        node, behind = self._operand(row, place + 1, box)
        order = _order(box)
        return Call(
            "Derivative", (node, self.letter(below[0]), number(order)) if order > 1 else (node, self.letter(below[0]))
        ), behind

    def _nabla(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""Read \nabla f, \nabla^2 f, \nabla\cdot\vec f and \nabla\times\vec f."""
        box = row[place]
        after = row[place + 1] if place + 1 < len(row) else box
        sign = after.name if after.kind == "operator" else ""
        if sign in ("cdot", "times") and not box.sup:
            node, behind = self._operand(row, place + 2, box)
            if not is_vector(node):
                raise FormulaError(
                    after.at, f"∇ {sign} is of no vector", 'write in paper.toml [notation] vectors = "…"'
                )
            return Call("divergence" if sign == "cdot" else "curl", (node,)), behind
        node, behind = self._operand(row, place + 1, box)
        if box.sup and _order(box) == 2:
            return Call("laplacian", (node,)), behind
        if box.sup or is_vector(node):
            raise FormulaError(
                box.at, "∇ of a vector, or a power of ∇, is not read", r"write \nabla\cdot or \nabla\times"
            )
        return Call("gradient", (node,)), behind

    # ---- sums, integrals, limits

    def _big(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if BIG[box.name] == "Integral":
            return self._integral(row, place)
        rest = strip(row[place + 1 :])
        if not rest:
            raise FormulaError(box.at, f"\\{box.name} has no terms", "write them")
        below = without_thin(box.sub or ())
        if BIG[box.name] == "limit":
            sides = parted(below, "relation")
            if len(sides) != 2 or not all(sides) or not any(b.name == "->" for b in below):
                raise FormulaError(box.at, "where the limit is taken is missing", r"write \lim_{x\to 0}")
            return Call("limit", (self.term(rest), self.expression(sides[0]), self.expression(sides[1]))), len(row)
        limits = self._limits(box, below)
        names = [each.name for each in below if each.kind == "letter"]
        self.bound += names
        inner = self.term(rest)
        del self.bound[len(self.bound) - len(names) :]
        return Call(BIG[box.name], (inner, *limits)), len(row)

    def _limits(self, box: Box, below: list[Box]) -> list[Node]:
        """Return the index of a sum and its ends; the index alone where it runs over all its values."""
        relations = [b.name for b in below if b.kind == "relation"]
        names = [b.name for b in below if b.kind == "letter" and b.name in ("i", "j")]
        self.bound += names
        try:
            if relations == ["="] and below[0].kind == "letter" and below[1].kind == "relation":
                ends = [self.expression(box.sup)] if box.sup else []
                return [self.letter(below[0]), self.expression(below[2:]), *ends]
            if not box.sup and not relations and below and all(b.kind in ("letter", "comma") for b in below):
                if len({b.name for b in below}) < len(below) - (len(below) > 3):
                    raise FormulaError(
                        box.at, "whether a word or indices stand below the sum is open", "write commas between indices"
                    )
                letters: list[Node] = [self.letter(b) for b in below if b.kind == "letter"]
                return letters if len(letters) == 1 else [letters[0], Letter("all"), Letter("all"), *letters[1:]]
            if not box.sup and relations and not any(b.kind == "comma" for b in below):
                return [self.condition(below)]
        finally:
            del self.bound[len(self.bound) - len(names) :]
        raise FormulaError(box.at, "what the sum runs over is not clear", r"write \sum_{i=1}^{n}")

    def _integral(self, row: list[Box], place: int) -> tuple[Node, int]:
        """Read an integral from its sign to its differential."""
        box = row[place]
        behind = [k for k in range(place + 1, len(row)) if row[k].kind != "thin"]
        at, depth = -1, 1
        for k in behind:
            depth += _opens_integral(row[k]) - _closes_integral(row, k)
            if not depth:
                at = k
                break
        if at < 0:
            raise FormulaError(box.at, "the differential of the integral is missing", "write d and its letter")
        variables: list[Node] = []
        if row[at].kind == "fraction":  # \int \frac{dx}{x} f
            end = next((k for k in behind if k > at and row[k].kind == "operator"), len(row))
            over = without_thin(row[at].parts[0])
            start = next(k for k, b in enumerate(over) if _is_d(b))
            variables.append(self._variable(over[start:]))
            rest = over[:start] or [Box("number", "1", row[at].at, row[at].at)]
            inner = [*row[place + 1 : at], replace(row[at], parts=[rest, row[at].parts[1]]), *row[at + 1 : end]]
            if any(b.kind == "operator" for b in row[place + 1 : at]):
                raise FormulaError(row[at].at, "a differential stands in one term only", "write it at the end")
        else:
            inner, end, k = row[place + 1 : at], at, behind.index(at)
            while (
                k < len(behind)
                and row[behind[k]].kind == "letter"
                and (not variables or _closes_integral(row, behind[k]))
            ):
                variables.append(self._variable([row[n] for n in behind[k : k + 2]]))
                end, k = behind[k + 1] + 1, k + 2
            if at == behind[0] and k < len(behind) and row[behind[k]].kind != "operator":  # \int dx f(x)
                inner, end = row[end:], len(row)
        if end < len(row) and row[end].kind == "bracket" and end > at + 1:
            raise FormulaError(
                row[end].at, "whether the bracket belongs to the differential is open", "write the differential last"
            )
        region: list[Node] = []
        if box.sub and box.sup:
            region = [self.expression(box.sub), self.expression(box.sup)]
            if len(variables) > 1:
                why = "two differentials follow one integral"
                raise FormulaError(box.at, why, "write as many integrals as differentials")
        elif box.sub or box.sup or box.name == "oint":
            words = (
                re.findall(r"\w+", self.source[(box.sub or box.sup or [box])[0].at : box.end])
                if box.sub or box.sup
                else []
            )
            region = [Letter("_".join(("over", *(words or ["loop"]))))]
        variable = variables[0] if len(variables) == 1 else Call("volume", tuple(variables))
        return Call("Integral", (self._integrand(strip(inner), variable), variable, *region)), end

    def _integrand(self, row: list[Box], variable: Node) -> Node:
        """Return what is integrated; with the differential of a vector where a dot or a cross joins them."""
        if not row:
            return number(1)
        if row[-1].kind != "operator":
            return self.expression(row)
        left = self.expression(row[:-1])
        if not (is_vector(left) and is_vector(variable) and row[-1].name in ("cdot", "times")):
            way = "declare the vectors in [notation]"
            raise FormulaError(row[-1].at, "the differential is multiplied by what is no vector", way)
        return Call("dot" if row[-1].name == "cdot" else "cross", (left, Call("differential", (variable,))))

    def _variable(self, marks: list[Box]) -> Node:
        """Return what an integral is over, from its d and the letter behind."""
        if len(marks) != 2 or marks[1].kind != "letter" or marks[1].sup:
            raise FormulaError(marks[0].at, "the differential of the integral is not clear", "write d and its letter")
        letter = self.letter(marks[1])
        return Call("differential", (letter, self.expression(marks[0].sup))) if marks[0].sup else letter


Factor = Callable[[Grammar, list[Box], int], tuple[Node, int]]
_FACTORS: dict[str, Factor] = {
    "number": Grammar._number, "unit": Grammar._unit, "letter": Grammar._letter, "bracket": Grammar._bracket,
    "group": Grammar._group, "root": Grammar._root, "binomial": Grammar._binomial, "infinity": Grammar._infinity,
    "accent": Grammar._accent, "matrix": Grammar._matrix, "cases": Grammar._cases, "fraction": Grammar._fraction,
    "partial": Grammar._partial, "nabla": Grammar._nabla, "function": Grammar._function, "big": Grammar._big,
    "dots": Grammar._dots,
}  # fmt: skip
# Calls of which a vector can be a multiple.
_SCALARS = ("sum", "product", "quotient", "negative", "power", "sqrt", "Abs", "norm", "dot", "Derivative", "rate")
# Functions whose argument may go on behind a slash where no bracket closes it.
_OPEN_ENDED = {*FUNCTIONS.values()} - {"exp"}


def is_unit(text: str) -> bool:
    """Whether a text is a unit: km, m/s^2."""
    words = re.sub(r"[\^{}\d\-~.·]", " ", text.replace("/", " ")).split()
    return bool(words) and all(word in UNITS for word in words)


def _unit(box: Box) -> Node:
    """Return a unit such as m/s^2 as letters unit_m, unit_s."""
    parts = _UNIT_PARTS.findall(box.name)
    if "".join(parts).split() != box.name.split() or parts.count("/") > 1:
        raise FormulaError(box.at, f"{box.name} is no unit", r"write it as \mathrm{m/s^2}")
    factors: list[Node] = []
    below = False
    for part in parts:
        if part == "/":
            below = True
        elif part[0] == "^" and factors:
            power = number(int(part.strip("^{}")))
            last = factors.pop()
            base = last.args[0] if isinstance(last, Call) else last
            factors.append(Call("power", (base, Number(-power.value if below else power.value))))
        elif part[0].isalpha() or part[0] == "%":
            letter = Letter(f"unit_{part}")
            factors.append(Call("power", (letter, number(-1))) if below else letter)
    return product_of(factors)


def _is_numeric(node: Node) -> bool:
    """Whether a node has no letters but those of units."""
    if isinstance(node, Letter):
        return node.name.startswith("unit_")
    return isinstance(node, Number) or (isinstance(node, Call) and bool(node.args) and all(map(_is_numeric, node.args)))


def _is_any_kind(node: Node) -> bool:
    """Whether a term may be a number or a vector: 0, dots and O(…)."""
    return is_printed_zero(node) or (isinstance(node, Call) and node.name in ("dots", "order"))


def _rate(node: Node, order: int) -> Node:
    r"""Return dx/dt as \dot x, and d/dt of other expressions as `rate`."""
    dots = re.search(r"_(d*)dot$", node.name) if isinstance(node, Letter) else None
    total = order + (len(dots[1]) + 1 if dots else 0)
    if isinstance(node, Letter) and total <= 4:
        stem = node.name[: dots.start()] if dots else node.name
        return replace(node, name=f"{stem}_{'d' * (total - 1)}dot")
    for _ in range(order):
        node = Call("rate", (node,))
    return node


def _order(box: Box) -> int:
    """Return the order of a derivative, the number above its sign."""
    if not box.sup:
        return 1
    if len(box.sup) == 1 and box.sup[0].kind == "number" and box.sup[0].name in "123456789":
        return int(box.sup[0].name)
    raise FormulaError(box.at, "the order of the derivative is no number", "write a number")


def _is_d(box: Box) -> bool:
    return is_mark(box, "d")


def _has_differential(box: Box) -> bool:
    """Whether a fraction has the differential of an integral above."""
    return box.kind == "fraction" and any(map(_is_d, box.parts[0])) and not is_derivative(box)


def _opens_integral(box: Box) -> bool:
    return box.kind == "big" and BIG[box.name] == "Integral"


def _closes_integral(row: list[Box], place: int) -> bool:
    """Whether a differential begins here: d before a letter, or above a fraction bar."""
    box = row[place]
    target = next((b for b in row[place + 1 :] if b.kind != "thin"), None)
    plain = _is_d(box) and target is not None and target.kind == "letter" and not _is_d(target)
    return plain or _has_differential(box)


def _paired(row: list[Box]) -> list[Box]:
    """Return a row with its bars in pairs as brackets, and a bar with an equation below as the bracket that it closes."""
    places = [k for k, box in enumerate(row) if box.kind == "bar"]
    if len(places) == 1 and row[places[0]].sub and places[0]:
        last = places[0]
        start = (
            last - 2 if row[last - 1].kind == "bracket" and last > 1 and row[last - 2].kind == "letter" else last - 1
        )
        bar = Box(
            "bracket",
            ".",
            row[start].at,
            row[last].end,
            [row[start:last]],
            sub=row[last].sub,
            sup=row[last].sup,
            closing="|",
        )
        return [*row[:start], bar, *row[last + 1 :]]
    if len(places) % 2:
        raise FormulaError(row[places[-1]].at, "a bar has no partner", r"write \left| and \right|")
    made: list[Box] = []
    last = 0
    for a, b in zip(places[::2], places[1::2], strict=True):
        inner, between = strip(row[a + 1 : b]), strip(row[last:a])
        nested = bool(made) and between and all(x.kind not in ("operator", "relation") for x in between)
        if (
            nested
            or row[a].sup
            or row[a].sub
            or not inner
            or inner[-1].kind == "operator"
            or row[a].name != row[b].name
        ):
            raise FormulaError(row[a].at, "how the bars belong together is open", r"write \left| and \right|")
        sign = r"\|" if row[a].name == "||" else "|"
        made += [
            *row[last:a],
            Box("bracket", sign, row[a].at, row[b].end, [inner], sub=row[b].sub, sup=row[b].sup, closing=sign),
        ]
        last = b + 1
    return [*made, *row[last:]]


def _folded(row: list[Box]) -> list[Box]:
    """Return a row with d^2x/dt^2 and ∂f/∂x as fractions."""
    made: list[Box] = []
    place = 0
    while place < len(row):
        box = row[place]
        mark = row[place + 1] if place + 2 < len(row) else box
        start = len(made) - 2
        if (
            box.name == "/"
            and start >= 0
            and (mark.kind == "partial" or _is_d(mark))
            and row[place + 2].kind == "letter"
        ):
            if made[start].kind == mark.kind and made[start].name == mark.name and made[start + 1].kind == "letter":
                made[start:] = [
                    Box("fraction", "", made[start].at, row[place + 2].end, [made[start:], row[place + 1 : place + 3]])
                ]
                place += 3
                continue
        made.append(box)
        place += 1
    return made
