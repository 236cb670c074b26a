r"""The reading of a formula: every token is accounted for, or there is none, and it says where it stopped and what would help.

What the print leaves open and custom settles, the reading takes by custom and says so (`guesses`); what custom does not settle
is not read.
"""

import re
from dataclasses import dataclass, field, replace
from fractions import Fraction

from lagrotor.paper.source.boxes import FUNCTIONS, GREEK, Box, FormulaError, boxes
from lagrotor.paper.source.tree import Call, Letter, Node, Number, number, walk
from lagrotor.paper.source.tree import is_vector as vector_valued
from lagrotor.paper.source.usage import (
    Notation,
    arguments,
    index_of,
    is_printed_as_vector,
    name_of,
    simple_argument,
)

_ANGLES = ("theta", "phi", "varphi", "psi", "alpha", "beta", "vartheta", "gamma", "chi")
_TENSOR = ("mu", "nu", "rho", "sigma", "kappa", "lambda", "tau")
_ENDING = ("operator", "relation", "comma", "wide", "text", "arrow")
_GREEK = frozenset(name.removeprefix("\\") for name in GREEK)
_CONDITIONS = {"=": "Eq", "<": "Lt", ">": "Gt", "<=": "Le", ">=": "Ge", "!=": "Ne"}
_MOST_DIGITS = 1000
_ARITHMETIC = ("sum", "product", "quotient", "power", "negative", "sin", "cos", "sqrt", "exp")
_UNIT_LETTERS = frozenset(
    [
        "m",
        "s",
        "g",
        "kg",
        "K",
        "N",
        "J",
        "W",
        "V",
        "A",
        "C",
        "F",
        "H",
        "T",
        "Pa",
        "Hz",
        "rad",
        "sr",
        "mol",
        "cd",
        "eV",
        "keV",
        "MeV",
        "GeV",
        "cm",
        "mm",
        "nm",
        "km",
        "min",
        "h",
        "ms",
        "ns",
        "yr",
        "pc",
    ]
)
_DENYING = re.compile(r"\b(?:not|nor|neither|unless|except|instead|rather)\b")
_UNIT = re.compile(r"[A-Za-zµ%]+|\^\{?-?\d+\}?|[/.~\s,·]|\\[,.%]|-?\d+|[{}]")


@dataclass(frozen=True)
class Side:
    """One side of a relation: what it says and how it is printed."""

    node: Node
    latex: str
    at: int


@dataclass(frozen=True)
class PrintedStatement:
    """Sides and the relations between them; `order`: (small letter, power) of a term O(…) that the last side had.

    kind: equation, approximation, inequality, range, expression or other.
    """

    sides: tuple[Side, ...]
    relations: tuple[str, ...]
    kind: str
    order: tuple[str, int] | None = None


@dataclass(frozen=True)
class Reading:
    """The statements of a formula; none where it is not read. stop: (token, what would help); guesses: what custom settled."""

    statements: tuple[PrintedStatement, ...] = ()
    guesses: tuple[str, ...] = ()
    stop: tuple[str, str] | None = None

    @property
    def whole(self) -> bool:
        """Whether it was read."""
        return self.stop is None and bool(self.statements)


def read_formula(latex: str, notation: Notation | None = None, lead: str = "") -> Reading:
    """The reading of a displayed formula; lead: the left side of the row before, which it continues."""
    source = f"{lead} {latex}" if lead else latex
    reader = _Formula(source, notation or Notation())
    try:
        statements = tuple(reader.statements(boxes(source)))
    except FormulaError as stop:
        return Reading(stop=(stop.what, stop.help))
    except RecursionError:
        return Reading(stop=("the formula is nested too deeply", "write it in parts"))
    if not statements:
        return Reading(stop=("there is no formula", "keep it aside"))
    return Reading(statements, tuple(dict.fromkeys(reader.guesses)))


def _trimmed(row: list[Box]) -> list[Box]:
    """Without spaces and marks of punctuation at its ends."""
    start, end = 0, len(row)
    while start < end and row[start].kind in ("thin", "wide"):
        start += 1
    while end > start and row[end - 1].kind in ("thin", "wide", "comma"):
        end -= 1
    return row[start:end]


@dataclass
class _Formula:
    """Reads the boxes of one formula."""

    source: str
    notation: Notation
    guesses: list[str] = field(default_factory=list)
    bound: list[str] = field(default_factory=list)

    # ---- statements

    def statements(self, row: list[Box]) -> list[PrintedStatement]:
        """The statements of a formula, its rows joined where one continues the other."""
        found: list[PrintedStatement] = []
        for piece in self._pieces(_trimmed(row)):
            found += self._statements(piece)
        return found

    def _pieces(self, row: list[Box]) -> list[list[Box]]:
        """Rows of a display, each continued ones with what they continue."""
        if len(row) == 1 and row[0].kind == "group":
            return self._pieces(_trimmed(row[0].parts[0]))
        system = self._system(row)
        if system is None:
            return [row]
        lines, always = system
        pieces: list[list[Box]] = []
        for line in lines:
            line = [box for box in line if box.kind != "thin"]
            while line and line[0].kind == "wide":
                line = line[1:]
            if not line:
                continue
            if pieces and (always or self._continues(pieces[-1], line)):
                pieces[-1] = [*pieces[-1], *line]
            else:
                pieces.append(line)
        return pieces

    def _system(self, row: list[Box]) -> tuple[list[list[Box]], bool] | None:
        """The lines of a display that is all rows, and whether each continues the one before."""
        if len(row) != 1:
            return None
        box = row[0]
        if box.sub is not None or box.sup is not None:
            return None
        if box.kind == "bracket" and box.name in (r"\{", ".", r"\lbrace") and "." in (box.closing, box.name):
            return self._system(_trimmed(box.parts[0]))
        if box.kind in ("rows", "cases") or (box.kind == "matrix" and box.name == "array"):
            lines = [[each for cell in line.parts for each in cell] for line in box.parts[0]]
            if box.kind == "rows" or all(any(b.kind == "relation" for b in line) for line in lines):
                return lines, False
        return None

    def _continues(self, before: list[Box], line: list[Box]) -> bool:
        last, first = before[-1], line[0]
        if last.kind in ("operator", "relation"):
            return True
        if first.kind == "relation":
            return last.kind != "comma"
        if first.kind == "operator" and first.name in ("+", "-", "cdot", "times", "/", "pm", "mp"):
            return last.kind != "comma" or first.name != "-"
        if first.kind in ("arrow", "text"):
            return False
        if not any(box.kind == "relation" for box in line) and last.kind != "comma":
            raise FormulaError(
                first.at, "a row has no relation", "begin it with the sign that joins it to the row before"
            )
        return False

    def _statements(self, row: list[Box]) -> list[PrintedStatement]:
        """The statements of one piece, parted by wide spaces, words, arrows and commas."""
        parts: list[tuple[str, list[Box]]] = [("", [])]
        for place, box in enumerate(row):
            if box.kind == "arrow" or (box.kind == "text" and not self._is_side(row, place)):
                self._check_words(box)
                parts.append((box.kind, []))
            elif (
                box.kind == "comma"
                and box.name == "."
                and any(b.kind not in ("thin", "wide", "comma") for b in row[place + 1 :])
                and (row[place + 1].kind not in ("wide", "arrow", "text"))
            ):
                raise FormulaError(box.at, "a full stop stands within the formula", "write \\cdot for a product")
            elif box.kind == "wide" or box.kind == "comma":
                if box.kind == "wide" and self._goes_on(row, place, parts[-1][1]):
                    continue
                parts.append((parts[-1][0] if not parts[-1][1] and parts[-1][0] == "text" else box.kind, []))
            elif box.kind == "operator" and box.name == ":" and not parts[-1][1]:
                continue
            else:
                parts[-1][1].append(box)
        found: list[PrintedStatement] = []
        for parted, part in parts:
            part = [box for box in part if box.kind != "thin"] if not part or part[0].kind == "thin" else part
            if not _trimmed(part):
                continue
            has_relation = any(box.kind == "relation" for box in part)
            if parted == "comma" and has_relation and found and found[-1].kind == "expression":
                raise FormulaError(
                    part[0].at, "what stands before the comma has no relation", "write it for each letter"
                )
            if not has_relation and found and parted in ("comma", "wide"):
                self._further(found, _trimmed(part))
            else:
                found.append(self._statement(_trimmed(part)))
        return found

    def _check_words(self, box: Box) -> None:
        """Words that deny what they join are not read; of "or" it is taken that both are stated."""
        if _DENYING.search(box.name):
            raise FormulaError(
                box.at, f"{box.name}: the words deny what they join", "write the statements by themselves"
            )
        if re.search(r"\bor\b", box.name):
            self.guesses.append("what or joins are two statements, and both are meant")

    def _goes_on(self, row: list[Box], place: int, part: list[Box]) -> bool:
        """Whether a wide space stands within a formula: beside an operator or a relation."""
        rest = [box for box in row[place + 1 :] if box.kind not in ("thin", "wide")]
        before = _trimmed(part)
        if before and before[-1].kind in ("operator", "relation"):
            return True
        return bool(rest and before and rest[0].kind in ("relation", "operator") and rest[0].name not in ("-", ":"))

    def _is_side(self, row: list[Box], place: int) -> bool:
        """Whether words are a whole side of a relation, or a unit behind a number."""
        before = next((b for b in reversed(row[:place]) if b.kind != "thin"), None)
        after = row[place + 1] if place + 1 < len(row) else None
        if before is not None and before.kind == "number" and _unit_like(row[place].name):
            return True
        edges = (before is None or before.kind == "relation") and (after is None or after.kind == "relation")
        return edges and not (before is None and after is None)

    def _further(self, found: list[PrintedStatement], part: list[Box]) -> None:
        """What follows a comma without a relation: n = 1, 2, …."""
        last = found[-1]
        if part[0].kind == "number" and part[0].at and self.source[part[0].at - 2 : part[0].at - 1].isdigit():
            raise FormulaError(
                part[0].at - 1,
                "whether the comma is in a number is open",
                "write {,} in the number, or a space behind the comma",
            )
        simple = all(b.kind in ("number", "dots", "letter", "operator", "infinity") for b in part)
        if simple and last.kind in ("equation", "range") and len(last.sides) == 2:
            end = last.sides[-1].node
            if last.kind == "range" or isinstance(end, Number | Letter):
                found[-1] = replace(last, kind="range")
                return
        if last.kind == "expression" or (last.relations and last.relations[-1] in ("in", "->", "!=")):
            found.append(self._statement(part))
            return
        raise FormulaError(part[0].at, "what follows the comma has no relation", "write it as a statement of its own")

    def _statement(self, row: list[Box]) -> PrintedStatement:
        sides: list[list[Box]] = [[]]
        relations: list[str] = []
        for box in row:
            if box.kind == "relation":
                relations.append(box.name)
                sides.append([])
            else:
                sides[-1].append(box)
        if len(sides) > 1 and not _trimmed(sides[0]):
            raise FormulaError(
                row[0].at, "the left side is missing", "write what is equal, or join it to the row before"
            )
        read: list[Side] = []
        for place, side in enumerate(sides):
            side = _trimmed(side)
            if not side:
                raise FormulaError(row[-1].at, "a side of the relation is missing", "write it")
            if len(side) == 1 and side[0].kind == "dots" and relations and place == len(sides) - 1:
                relations.pop()
                continue
            latex = self.source[side[0].at : side[-1].end].strip()
            read.append(Side(self._side(side), latex, side[0].at))
        degrees = {_degree(side.node, side.at) for side in read if not _zero(side.node)}
        if len(degrees) > 1 and not any(relation in ("->", "in") for relation in relations):
            raise FormulaError(
                row[0].at, "a differential stands on one side only", "write the derivative, or both differentials"
            )
        vectors = any(isinstance(n, Letter) and n.vector for s in read if vector_valued(s.node) for n in walk(s.node))
        scalar = next((side for side in read if _scalar(side.node)), None)
        if vectors and scalar is not None and set(relations) <= {"=", ":=", "~"}:
            raise FormulaError(
                scalar.at, "a vector is equal to a number", "mark the vectors alike, as \\hat{\\mathbf r}"
            )
        order = None
        final = read[-1].node
        if isinstance(final, Call) and final.name == "sum":
            order, kept = _order_term(final)
            if order is not None:
                read[-1] = replace(read[-1], node=kept)
        return PrintedStatement(tuple(read), tuple(relations), _kind(relations), order)

    def _side(self, row: list[Box]) -> Node:
        if len(row) == 1 and row[0].kind == "text":
            name = "".join(c if c.isalnum() else "_" for c in row[0].name).strip("_")
            if not re.match(r"[A-Za-z]\w*$", name):
                raise FormulaError(row[0].at, "words stand for a side", "give it a letter")
            return Letter(name)
        return self.expression(row)

    # ---- expressions

    def expression(self, row: list[Box]) -> Node:
        """The sum that a row of boxes is. Raises FormulaError where it is none."""
        row = _paired(_trimmed(row))
        if not row:
            raise FormulaError(0, "nothing stands here", "write what is meant")
        terms: list[tuple[str, list[Box]]] = []
        sign = "+"
        part: list[Box] = []
        for place, box in enumerate(row):
            if box.kind == "operator" and box.name in ("+", "-", "pm", "mp"):
                if not part:
                    if terms or (place and not (sign == "+" and not terms)):
                        raise FormulaError(box.at, "two signs follow each other", "write brackets around the second")
                    sign = box.name
                    continue
                if part[-1].kind == "operator" and part[-1].name != "!":
                    if box.name in ("+", "-") and part[-1].name in ("cdot", "times"):
                        part.append(box)  # a factor with its sign: 3 \cdot -2
                        continue
                    raise FormulaError(box.at, "two signs follow each other", "write brackets around the second")
                if self._open_integral(part):
                    part.append(box)
                    continue
                terms.append((sign, part))
                sign, part = box.name, []
            else:
                part.append(box)
        if not _trimmed(part):
            raise FormulaError(row[-1].at, "nothing follows the sign", "write what is added")
        terms.append((sign, part))
        if any(p and p[0].kind == "dots" for _, p in terms):
            raise FormulaError(row[0].at, "dots stand for terms", "write them, or as a sum")
        return self._added(terms)

    def _added(self, terms: list[tuple[str, list[Box]]]) -> Node:
        made: list[Node] = []
        for sign, part in terms:
            term = self.term(part)
            if sign == "-":
                term = Call("negative", (term,))
            elif sign in ("pm", "mp"):
                rest = made and (made[0] if len(made) == 1 else Call("sum", tuple(made)))
                term = Call("plus_minus" if sign == "pm" else "minus_plus", (rest, term) if rest else (term,))
                made = []
            made.append(term)
        if len(made) == 1:
            return made[0]
        self._check_sums(terms)
        kinds = {vector_valued(each) for each in made if not _zero(each)}
        if len(kinds) > 1 and not any(isinstance(n, Call) and n.name == "order" for n in made):
            raise FormulaError(terms[1][1][0].at, "a vector and a number are added", "mark the vectors alike")
        return Call("sum", tuple(made))

    def _check_sums(self, terms: list[tuple[str, list[Box]]]) -> None:
        """A term behind a sum that has its index: whether the sum ends before it is not clear."""
        indices: set[str] = set()
        for _, part in terms:
            indexed = any(b.kind == "letter" and b.sub and any(s.name in indices for s in b.sub) for b in part)
            if indexed and not any(b.kind == "big" for b in part):
                raise FormulaError(
                    part[0].at, "whether the sum ends here is open", "write brackets around what is summed"
                )
            for box in part:
                if box.kind == "big" and box.name in ("sum", "prod") and box.sub:
                    indices |= {s.name for s in box.sub if s.kind == "letter"}

    @staticmethod
    def _open_integral(part: list[Box]) -> bool:
        """Whether an integral's differential is still to come: the sign belongs to what is integrated."""
        opened = 0
        for place, box in enumerate(part):
            if box.kind == "big" and FUNCTION_OF_BIG(box) == "Integral":
                opened += 1
            elif opened and (
                _differential_above(box) or ((box.kind, box.name) == ("letter", "d") and place + 1 < len(part))
            ):
                opened -= 1
        return opened > 0

    def term(self, row: list[Box]) -> Node:
        """The product that a row of boxes is."""
        row = list(row)
        if row and row[-1].kind == "operator" and row[-1].name != "!":
            raise FormulaError(row[-1].at, f"nothing follows {row[-1].name}", "write the second factor")
        groups: list[tuple[str, list[Box]]] = [("", [])]
        for box in row:
            if (
                box.kind == "operator"
                and box.name in ("cdot", "times", "/", "*")
                and not self._in_integral(groups[-1][1])
            ):
                if not _trimmed(groups[-1][1]):
                    raise FormulaError(box.at, f"nothing is before {box.name}", "write the first factor")
                groups.append((box.name, []))
            else:
                groups[-1][1].append(box)
        made: Node | None = None
        for place, (operator, part) in enumerate(groups):
            more = place + 1 < len(groups)
            made = self._joined(made, operator, part, more, groups[place - 1][1] if place else [])
        assert made is not None
        return made

    def _in_integral(self, part: list[Box]) -> bool:
        return any(b.kind == "big" for b in part) or bool(
            part and part[0].kind == "fraction" and _is_operator(part[0]) and len(part) == 1
        )

    def _joined(self, made: Node | None, operator: str, part: list[Box], more: bool, before: list[Box]) -> Node:
        if operator == "/":
            part = _trimmed(part)
            right = self.product(part)
            factors = self._count(part)
            assert made is not None
            if factors > 1:
                raise FormulaError(part[0].at, "what the slash divides by is open", "write \\frac or brackets")
            if len([b for b in before if b.kind == "function"]) and not _bracket_last(before):
                raise FormulaError(part[0].at, "whether the slash is within the function is open", "write brackets")
            if vector_valued(right):
                raise FormulaError(part[0].at, "a vector is divided by", "write its length")
            differentials = [_differential_of(each) for each in (made, right)]
            if all(differentials):
                return self._total(differentials[0], differentials[1], 1, part[0])  # type: ignore[arg-type]
            return Call("quotient", (made, right))
        sign = None
        if part and part[0].kind == "operator" and part[0].name in ("+", "-"):
            sign, part = part[0].name, part[1:]
        right = self.product(_trimmed(part))
        if sign == "-":
            right = Call("negative", (right,))
        if made is None:
            return right
        return self._vector_product(made, operator, right, part[0].at, before)

    @staticmethod
    def _vector_product(made: Node, operator: str, right: Node, at: int, before: list[Box]) -> Node:
        """Two factors joined by a dot, a cross or a star, of vectors or of numbers."""
        left_vector, right_vector = vector_valued(made), vector_valued(right)
        if left_vector and right_vector:
            if operator not in ("cdot", "times"):
                raise FormulaError(at, "two vectors are multiplied by *", "write \\cdot or \\times")
            if operator == "times" and isinstance(made, Call) and made.name == "cross" and not _bracket_last(before):
                raise FormulaError(at, "which × comes first is open", "write brackets")
            return Call("dot" if operator == "cdot" else "cross", (made, right))
        if operator == "cdot" and (left_vector or _hatted(made)) and (right_vector or _hatted(right)):
            raise FormulaError(at, "whether a letter with a hat is a vector is open", "write \\hat{\\mathbf n}")
        if operator == "times" and not (_numeric(made) or _numeric(right)):
            raise FormulaError(at, "whether × is of vectors or of numbers is open", "mark the vectors, or write \\cdot")
        return _product([made, right])

    def _count(self, part: list[Box]) -> int:
        """How many factors stand there: of dx one, of f(x) one."""
        count = place = 0
        while place < len(part):
            box = part[place]
            if box.kind == "thin":
                return 2 if place + 1 < len(part) else count
            if box.kind == "letter" and box.name in ("d", "delta", "Delta") and place + 1 < len(part):
                place += 1
            elif box.kind == "function":
                return count + 1 if place == 0 else 2
            elif box.kind == "bracket" and place and part[place - 1].kind == "letter":
                count -= self._called(part[place - 1], box) is True
            count += 1
            place += 1
        return count

    def product(self, row: list[Box]) -> Node:
        """Factors side by side."""
        row = _trimmed(row)
        if not row:
            raise FormulaError(0, "a factor is missing", "write it")
        _no_word(row)
        factors: list[Node] = []
        place = 0
        while place < len(row):
            if row[place].kind == "thin":
                place += 1
                continue
            self._numbers_apart(row, place)
            node, behind = self.factor(row, place)
            if row[place].kind == "fraction" and behind < len(row) and row[behind].kind == "bracket":
                behind = self._at_its_variable(row, place, behind)
            factors.append(node)
            place = behind
        if sum(map(vector_valued, factors)) > 1:
            return self._matrices(factors, row)
        return _product(factors)

    def _at_its_variable(self, row: list[Box], place: int, behind: int) -> int:
        r"""\frac{dx}{dt}(t): the bracket is the derivative's own argument."""
        box, bracket = row[place], row[behind]
        mark = _derivative_marks(box)
        if (
            not mark
            or len(_without_thin(box.parts[0])) == 1
            or bracket.name != "("
            or not simple_argument(bracket.parts[0])
        ):
            return behind
        variables = self._variables(_without_thin(box.parts[1]), mark)
        if len(bracket.parts[0]) == 1 and self.expression(bracket.parts[0]) == variables[0][0]:
            return behind + 1
        raise FormulaError(
            bracket.at, "whether a derivative is taken there or multiplied is open", "write |_{t = 0} or \\cdot"
        )

    def _matrices(self, factors: list[Node], row: list[Box]) -> Node:
        """Matrices times vectors, side by side; two vectors side by side are not read."""
        scalars = [each for each in factors if not vector_valued(each)]
        others = [each for each in factors if vector_valued(each)]
        if not all(map(_is_matrix, others[:-1])):
            raise FormulaError(row[0].at, "two vectors stand side by side", "write \\cdot or \\times between them")
        made = Call("matmul", tuple(others))
        return _product([*scalars, made])

    @staticmethod
    def _numbers_apart(row: list[Box], place: int) -> None:
        """Numbers side by side are groups of digits, or not read."""
        before, box = row[place - 1] if place else None, row[place]
        if before is None:
            return
        if box.kind == "number" and before.kind == "number":
            raise FormulaError(box.at, "two numbers stand side by side", "write \\cdot between them")
        if box.kind == "number" and before.kind in ("letter", "root", "group"):
            raise FormulaError(
                box.at, "a number stands behind a letter", "write it first, or braces where it is a script"
            )
        parts = [each for part in box.parts for each in part] if box.kind == "fraction" else []
        if before.kind == "number" and before.sup is None and parts and all(each.kind == "number" for each in parts):
            raise FormulaError(
                box.at, "whether a mixed number or a product is meant is open", "write \\cdot between them"
            )

    # ---- factors

    def factor(self, row: list[Box], place: int) -> tuple[Node, int]:
        """One factor and the place behind it."""
        box = row[place]
        reader = getattr(self, f"_{box.kind}", None)
        if reader is None:
            raise FormulaError(
                box.at, f"{self.source[box.at : box.end] or box.name} is not read here", "write what it stands for"
            )
        if box.kind in ("infinity", "root", "binomial") and (
            box.sub is not None or (box.sup and box.kind == "infinity")
        ):
            raise FormulaError(box.at, f"{self.source[box.at : box.end]} has an index", "give it a letter of its own")
        node, behind = reader(row, place)
        while behind < len(row) and row[behind].kind == "operator" and row[behind].name == "!":
            node, behind = Call("factorial", (node,)), behind + 1
        return node, behind

    def _number(self, row: list[Box], place: int) -> tuple[Node, int]:
        box, behind = row[place], place + 1
        text = box.name
        while (
            behind + 1 < len(row)
            and row[behind].kind == "thin"
            and row[behind + 1].kind == "number"
            and len(row[behind + 1].name) == 3
            and re.fullmatch(r"\d{1,3}(?:\d{3})*", text)
            and box.sup is None
        ):
            box = row[behind + 1]
            text += box.name
            behind += 2
        node: Node = Number(self._value(text, box))
        if box.sub is not None:
            raise FormulaError(box.at, "a number has an index", "write the letter that it belongs to")
        if box.sup and len(box.sup) == 1 and (box.sup[0].name in ("circ", "degree")):
            return Call("quotient", (_product([node, Letter("pi")]), number(180))), behind
        node = self._raised(node, box)
        if behind < len(row) and row[behind].kind == "percent":
            return Call("quotient", (node, number(100))), behind + 1
        unit = behind + 1 if behind < len(row) and row[behind].kind == "thin" else behind
        if unit < len(row) and row[unit].kind in ("unit", "text"):
            return _product([node, self._units(row[unit])]), unit + 1
        if unit < len(row) and row[unit].upright and row[unit].name in _UNIT_LETTERS and row[unit].sub is None:
            self.guesses.append(f"upright {row[unit].name} behind a number is a unit")
            return _product([node, self._raised(Letter(f"unit_{row[unit].name}"), row[unit])]), unit + 1
        return node, behind

    def _value(self, text: str, box: Box) -> Fraction:
        if len(text) > _MOST_DIGITS:
            raise FormulaError(
                box.at, f"{text[:12]}…: a number has more than {_MOST_DIGITS} digits", "give it a letter"
            )
        if "{,}" in text:
            whole, *groups = text.split("{,}")
            comma = self.notation.decimal_comma
            if comma is None:
                comma = len(groups) == 1 and (len(groups[0]) != 3 or whole == "0")
                if not comma and len(groups) == 1:
                    self.guesses.append(f"{text} is {whole}{groups[0]}, the comma parts thousands")
            if comma and len(groups) == 1 and "." not in text:
                return Fraction(f"{whole}.{groups[0]}")
            if not all(len(each.partition(".")[0]) == 3 for each in groups):
                raise FormulaError(box.at, f"{text} is no number", "write a decimal point")
            return Fraction(whole + "".join(groups))
        return Fraction(text if not text.startswith(".") else f"0{text}")

    def _unit(self, row: list[Box], place: int) -> tuple[Node, int]:
        raise FormulaError(row[place].at, "upright letters are no letter of a formula", "write \\text{…} for words")

    def _units(self, box: Box) -> Node:
        """A unit such as m/s^2 as letters unit_m, unit_s."""
        parts = _UNIT.findall(box.name)
        if "".join(parts).replace(" ", "") != box.name.replace(" ", "") or not parts:
            raise FormulaError(box.at, f"{box.name} is no unit", "write it as \\mathrm{m/s^2}")
        factors: list[Node] = []
        below = False
        for part in parts:
            if part == "/":
                if below:
                    raise FormulaError(box.at, f"{box.name} has two slashes", "write powers")
                below = True
            elif part[0] in "^-" or part.isdigit():
                if not factors:
                    raise FormulaError(box.at, f"{box.name} is no unit", "write it as \\mathrm{m/s^2}")
                power = number(int(part.strip("^{}")))
                last = factors[-1]
                inverse = isinstance(last, Call)
                base = last.args[0] if isinstance(last, Call) else last
                factors[-1] = Call("power", (base, Number(-power.value if inverse else power.value)))
            elif part[0].isalpha() or part[0] == "%":
                letter = Letter(f"unit_{part}")
                factors.append(Call("power", (letter, number(-1))) if below else letter)
        return _product(factors)

    def _special(self, row: list[Box], place: int) -> tuple[Node, int] | None:
        """A letter that may be a sign: d, Δ, e, i, π."""
        box = row[place]
        if box.marks or box.sub is not None:
            return None
        if box.name == "d" and not box.style:
            return self._differential(row, place)
        if box.name in ("delta", "Delta") and box.sup is None:
            return self._difference(row, place)
        if box.name == "e" and not box.style and not box.primes and self._euler(box):
            return self._exponential(box), place + 1
        if box.name in ("i", "j", "imath") and not box.style:
            return self._raised(self._imaginary(box), box), place + 1
        if box.name == "pi" and not box.primes and not self._may_call(row, place):
            return self._raised(Letter("pi"), box), place + 1
        return None

    def _letter(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if (special := self._special(row, place)) is not None:
            return special
        if self._may_call(row, place):
            called = self._called(box, row[place + 1])
            if called is None:
                raise FormulaError(
                    box.at,
                    f"whether {box.name}(…) is a function or a product is open",
                    f'write \\cdot, or in paper.toml [notation] functions = "{box.name}" or letters = "{box.name}"',
                )
            if called:
                return self._call(box, row[place + 1]), place + 2
        if place + 1 < len(row) and row[place + 1].kind == "bracket" and row[place + 1].name == "[":
            inside = row[place + 1].parts[0]
            if (
                box.sup is None
                and not any(b.kind == "operator" for b in inside[1:])
                and not any(b.kind == "comma" for b in inside)
            ):
                raise FormulaError(
                    box.at,
                    f"whether {box.name}[…] is a functional or a product is open",
                    "write \\cdot, or round brackets",
                )
        if box.upright and len(box.name) > 1 and rf"\{box.name}" not in GREEK:
            after = next((b for b in row[place + 1 :] if b.kind != "thin"), None)
            if after is not None and after.kind not in _ENDING:
                raise FormulaError(
                    box.at,
                    f"whether {box.name} acts on what follows is open",
                    f"write \\operatorname{{{box.name}}}(…) or \\cdot",
                )
        node, raised = self._named(box)
        return (node if raised else self._raised(node, box)), place + 1

    @staticmethod
    def _may_call(row: list[Box], place: int) -> bool:
        return place + 1 < len(row) and row[place + 1].kind == "bracket" and row[place + 1].name == "("

    def _called(self, box: Box, bracket: Box) -> bool | None:
        """Whether a letter before a bracket is a function; None where that is open."""
        known, content = self.notation, bracket.parts[0]
        key = name_of(box, index_of(box) or ())
        plain = name_of(
            replace(box, primes=0, marks=tuple(m for m in box.marks if not m.endswith("dot"))), index_of(box) or ()
        )
        if {box.name, key, plain} & known.functions:
            return True
        if {box.name, key, plain} & known.letters:
            return False
        if any(b.kind == "comma" and b.name != "." for b in content) or box.name == "O":
            return True
        evidence = known.called.get(key, known.called.get(plain))
        top = [b for b in content if b.kind != "thin"]
        several = any(b.kind == "operator" and b.name in ("+", "-", "pm") for b in top[1:])
        if box.sup is not None and not self._mark(box):
            return False if several else None if evidence else (False if not simple_argument(content) else None)
        if any(b.kind == "relation" for b in top):
            return None
        if simple_argument(content) and bracket.sup is None:
            return True if evidence is not None or any(b.kind == "letter" for b in top) else None
        if evidence is None:
            late = bool(top) and top[0].kind == "letter" and top[0].name == "t"  # x(t - tau)
            if not late and any(b.kind == "letter" and b.name == "t" for b in top):  # γ(x - vt), g(x + ct)
                self.guesses.append(f"{box.name}(…) is a product")
            return None if late or box.primes or box.name in ("f", "F", "O", "o") or box.style == "cal" else False
        own = {b.name for b in top if b.kind == "letter"}
        if several:
            return True if own & evidence and key not in known.bare else None
        if bracket.sup is not None:
            return None
        return True if own & evidence or (not own and any(b.kind == "number" for b in top)) else None

    def _call(self, box: Box, bracket: Box) -> Node:
        """A function of its arguments; x(t) is the letter x."""
        given = [self.expression(part) for part in arguments(bracket.parts[0]) if _trimmed(part)]
        if box.name == "O" or (box.name == "o" and not box.sub):
            return Call("order", tuple(given))
        if not given:
            raise FormulaError(bracket.at, "a function has no argument", "write it")
        named, raised = self._named(box)
        name = name_of(box, self._index(box), self._superscript(box) or ())
        if tuple(given) == (Letter("t"),) and not (self.notation.called.get(name, {"t"}) - {"t"}):
            node: Node = named
        else:
            node = Call(f"{name}", tuple(given))
        if not raised:
            node = self._raised(node, box)
        return self._raised(node, bracket)

    def _index(self, box: Box) -> list[str]:
        found = index_of(box)
        if found is None:
            part = (box.sub or [box])[0]
            raise FormulaError(part.at, "an index is not letters and numbers", "give the letter another index")
        return found

    def _mark(self, box: Box) -> bool:
        return self._superscript(box) is not None

    def _superscript(self, box: Box) -> list[str] | None:
        """What a superscript adds to the name, where it is a mark or an upper index and no power."""
        row = [b for b in box.sup or () if b.kind != "thin"]
        if not row:
            return None
        if all(b.kind == "operator" and b.name in ("*", "star", "+", "-") for b in row) and len(row) == 1:
            return [{"*": "star", "star": "star", "+": "plus", "-": "minus"}[row[0].name]]
        if len(row) == 1 and row[0].kind == "letter" and row[0].name == "dagger":
            return ["dagger"]
        if len(row) == 1 and row[0].kind == "bracket" and row[0].name == "(" and len(row[0].parts[0]) == 1:
            inner = row[0].parts[0][0]
            if inner.kind in ("number", "letter") and inner.sup is None and inner.sub is None:
                return [inner.name]
        if len(row) == 1 and row[0].kind == "text":
            return [row[0].name] if row[0].name.isalnum() else None
        if len(row) >= 1 and row[0].kind == "letter" and row[0].upright and len(row[0].name) > 1:
            return [row[0].name]
        greek = all(b.kind == "letter" and b.name in _TENSOR and b.sup is None for b in row)
        if greek and len(row) > 1:
            return [b.name for b in row]
        return None

    def _named(self, box: Box) -> tuple[Node, bool]:
        """The letter, and whether its superscript is part of its name."""
        raised = self._superscript(box)
        if raised is None and box.sup is not None:
            self._check_power(box)
        if raised is not None and raised[0] in _TENSOR and len(raised) > 0:
            self.guesses.append("an index that is repeated, up and down, is summed over")
        name = name_of(box, self._index(box), raised or ())
        vector = (
            is_printed_as_vector(box) and not box.sub_is_component
            if hasattr(box, "sub_is_component")
            else is_printed_as_vector(box)
        )
        hat = "hat" in box.marks and box.style == "bold"
        return Letter(name, vector or hat), raised is not None

    def _check_power(self, box: Box) -> None:
        row = [b for b in box.sup or () if b.kind != "thin"]
        tensor = self.notation.lowered & set(_TENSOR) and not self.notation.letters
        if tensor and len(row) == 1 and row[0].kind == "letter" and row[0].name in _TENSOR:
            raise FormulaError(
                row[0].at,
                f"whether {row[0].name} is an upper index or a power is open",
                f'write brackets around the power, or in paper.toml [notation] letters = "{row[0].name}"',
            )
        if len(row) == 1 and row[0].kind == "letter":
            name = row[0].name
            if (name in _GREEK or name in ("i", "j", "k", "a", "b")) and name in self.notation.lowered:
                raise (
                    FormulaError(
                        row[0].at,
                        f"whether {name} is an upper index or a power is open",
                        f'write brackets around the power, or in paper.toml [notation] letters = "{name}"',
                    )
                    if name not in self.notation.letters
                    else FormulaError(0, "", "")
                )
        if (
            len(row) == 1
            and box.sub is not None
            and row[0].kind == "letter"
            and row[0].name.isupper()
            and not row[0].marks
        ):
            raise FormulaError(
                row[0].at, f"whether {row[0].name} is a mark or a power is open", "write brackets around the power"
            )
        if len(row) == 1 and row[0].kind == "number" and row[0].name == "0":
            raise FormulaError(row[0].at, "whether 0 is an upper index or a power is open", "write the index below")

    def _raised(self, node: Node, box: Box) -> Node:
        """The node to the power that its box has."""
        if box.sup is None:
            return node
        row = [b for b in box.sup if b.kind != "thin"]
        if not row:
            raise FormulaError(box.at, "a power is empty", "write it")
        if (
            len(row) == 1
            and row[0].kind == "letter"
            and row[0].name in ("T", "top", "intercal")
            and (vector_valued(node) or row[0].name != "T")
        ):
            return Call("transpose", (node,))
        if len(row) == 1 and row[0].kind == "letter" and row[0].name == "T" and "T" not in self.notation.letters:
            raise FormulaError(
                row[0].at, "whether T is a power or transposes is open", "write \\top, or the letter in bold"
            )
        if vector_valued(node):
            power = self.expression(box.sup)
            if power == number(2) and not _is_matrix(node):
                return Call("dot", (node, node))
            if power == Call("negative", (number(1),)) and _is_matrix(node):
                return Call("inverse", (node,))
            raise FormulaError(row[0].at, "a vector has a power", "write its length")
        if any(b.kind == "letter" and b.name in ("dagger", "prime") for b in row) or (
            row[0].kind == "operator" and len(row) == 1
        ):
            raise FormulaError(row[0].at, "a mark stands over what is no letter", "write what it means")
        if len(row) == 1 and row[0].kind in ("text", "relation", "comma"):
            raise FormulaError(row[0].at, "words stand as a power", "write them as an index")
        if len(row) == 1 and row[0].kind == "bracket" and row[0].name == "(" and isinstance(node, Call):
            raise FormulaError(
                row[0].at, "whether it is an order of derivative or a power is open", "write what it means"
            )
        power = self.expression(box.sup)
        if power == Call("quotient", (number(1), number(2))):
            return Call("sqrt", (node,))
        return Call("power", (node, power))

    def _euler(self, box: Box) -> bool:
        """Whether e is Euler's number here."""
        known = self.notation
        if "e" in known.letters:
            return False
        if "e" in known.numbers or box.upright:
            return True
        if box.sup is None:
            return False
        symbolic = any(b.kind == "letter" or b.parts for b in box.sup)
        if not symbolic:
            if known.exponential and "e" not in known.bare:
                raise FormulaError(
                    box.at, "whether e is Euler's number is open", 'write in paper.toml [notation] numbers = "e"'
                )
            self.guesses.append("e is a letter, not Euler's number")
            return False
        if "e" in known.bare:
            raise FormulaError(
                box.at,
                "whether e is Euler's number is open",
                'write in paper.toml [notation] numbers = "e" or letters = "e"',
            )
        self.guesses.append("e is Euler's number")
        return True

    def _exponential(self, box: Box) -> Node:
        if box.sup is None:
            return Call("exp", (number(1),))
        self.exponents += 1
        power = self.expression(box.sup)
        self.exponents -= 1
        return Call("exp", (power,))

    def _imaginary(self, box: Box) -> Node:
        """i where it is no index."""
        known = self.notation
        if box.name in self.bound or box.name in known.letters or (box.name == "j" and box.name not in known.numbers):
            return Letter(name_of(box))
        if box.name in known.numbers or (box.upright and box.name == "i"):
            return Letter("imaginary_unit")
        if known.imaginary and box.name == "i" and (self.exponents or "i" not in known.lowered):
            self.guesses.append("i is the imaginary unit")
            return Letter("imaginary_unit")
        raise FormulaError(
            box.at,
            f"whether {box.name} is the imaginary unit is open",
            f'write in paper.toml [notation] numbers = "{box.name}" or letters = "{box.name}"',
        )

    def _differential(self, row: list[Box], place: int) -> tuple[Node, int] | None:
        """dx, d^3 x."""
        box = row[place]
        if box.upright and box.primes:
            raise FormulaError(box.at, "a differential has a prime", "write what it means")
        behind = place + 1
        while behind < len(row) and row[behind].kind == "thin":
            behind += 1
        if (
            behind < len(row)
            and row[behind].kind == "bracket"
            and row[behind].sup is None
            and box.upright
            and box.sup is None
        ):
            return Call("differential", (self.expression(row[behind].parts[0]),)), behind + 1
        if (
            box.upright
            and "d" not in self.notation.letters
            and (behind >= len(row) or row[behind].kind not in ("letter", "group"))
        ):
            raise FormulaError(box.at, "an upright d has no letter", "write the letter behind it")
        if behind >= len(row) or row[behind].kind not in ("letter", "group") or box.primes:
            return None
        if "d" in self.notation.letters or (box.sup is not None and not all(b.kind == "number" for b in box.sup)):
            return None
        if not box.upright and "d" in self.notation.bare and not self.integrating:
            raise FormulaError(
                box.at, "whether d is a letter or a differential is open", "write \\mathrm{d} for the differential"
            )
        if row[behind].kind == "group":
            inner, behind = self.expression(row[behind].parts[0]), behind + 1
            return Call("differential", (inner,)), behind
        target = row[behind]
        node, raised = self._named(target)
        if target.sup is not None and not raised:
            raise FormulaError(target.at, "a differential has a power", "write brackets around it")
        args = (node, self.expression(box.sup)) if box.sup else (node,)
        return Call("differential", args), behind + 1

    integrating: int = 0
    exponents: int = 0  # of e, within which the reading is

    def _difference(self, row: list[Box], place: int) -> tuple[Node, int] | None:
        r"""\Delta x, \delta x as one letter."""
        box = row[place]
        behind = place + 1
        if behind >= len(row) or box.primes or box.name in self.notation.letters:
            return None
        if row[behind].kind != "letter":
            if row[behind].kind in ("bracket", "fraction", "accent", "group", "big", "partial", "nabla", "root"):
                raise FormulaError(
                    box.at,
                    f"whether \\{box.name} is a factor or a difference is open",
                    f'write in paper.toml [notation] letters = "{box.name}"',
                )
            return None
        if box.name in self.notation.bare:
            raise FormulaError(
                box.at,
                f"whether \\{box.name} is a factor or a difference is open",
                f'write in paper.toml [notation] letters = "{box.name}"',
            )
        node, raised = self._named(row[behind])
        assert isinstance(node, Letter)
        self.guesses.append(f"{box.name} {row[behind].name} is one quantity, a difference")
        letter = Letter(f"{box.name}_{node.name}", node.vector)
        return (letter if raised else self._raised(letter, row[behind])), behind + 1

    def _bracket(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if box.sub is not None and not (box.closing in ("|", r"\vert", r"\rvert") and box.name == "."):
            raise FormulaError(box.sub[0].at if box.sub else box.at, "a bracket has an index", "write what it means")
        pair = box.name, box.closing
        content = box.parts[0]
        if pair in (("(", ")"), ("[", "]"), (r"\{", r"\}"), (r"\lbrace", r"\rbrace"), (r"\lbrack", r"\rbrack")):
            return self._raised(self._inside(box, content), box), place + 1
        if pair in (("|", "|"), (r"\vert", r"\vert"), (r"\lvert", r"\rvert")):
            if len(content) == 2 and all(b.kind == "letter" and b.name.isupper() and not b.style for b in content):
                raise FormulaError(box.at, "whether the bars are a distance of points is open", "give it a letter")
            inner = self.expression(content)
            if isinstance(inner, Letter) and _is_matrix(inner):
                self.guesses.append(f"|{inner.name}| is a length, no determinant")
            elif _is_matrix(inner):
                raise FormulaError(box.at, "whether the bars are a determinant or a length is open", "write \\det")
            return self._raised(Call("norm" if vector_valued(inner) else "Abs", (inner,)), box), place + 1
        if pair in ((r"\|", r"\|"), (r"\lVert", r"\rVert"), (r"\Vert", r"\Vert")):
            inner = self.expression(content)
            return self._raised(Call("norm" if vector_valued(inner) else "length", (inner,)), box), place + 1
        if pair in ((r"\langle", r"\rangle"), ("<", ">"), ("⟨", "⟩")):
            if any(b.kind in ("bar", "comma") for b in content):
                raise FormulaError(box.at, "angle brackets with two parts are not read", "write the product in words")
            return self._raised(Call("mean", (self.expression(content),)), box), place + 1
        if pair in ((r"\lfloor", r"\rfloor"), (r"\lceil", r"\rceil")):
            return self._raised(Call(box.name[2:].removeprefix("l"), (self.expression(content),)), box), place + 1
        if pair == (".", "|") or pair == (".", r"\vert") or pair == (".", r"\rvert"):
            return self._evaluated(box, content), place + 1
        if pair == (".", "."):
            return self._raised(self.expression(content), box), place + 1
        raise FormulaError(box.at, f"{box.name} … {box.closing} is not read", "write brackets that belong together")

    def _inside(self, box: Box, content: list[Box]) -> Node:
        """What is in brackets; a list is a vector of components, a commutator or Poisson bracket a call."""
        parts = [_trimmed(part) for part in arguments(content)]
        if len(content) == 1 and content[0].kind == "matrix":
            return self.expression(content)
        if len(parts) == 1:
            if any(b.kind == "relation" for b in content):
                raise FormulaError(
                    content[0].at if content else box.at, "a relation stands in brackets", "write it by itself"
                )
            return self.expression(content)
        if not all(parts):
            raise FormulaError(box.at, "a component is missing", "write it")
        if (
            len(parts) == 2
            and all(b.kind in ("number", "operator", "infinity") for p in parts for b in p)
            and box.name == "["
        ):
            raise FormulaError(box.at, "an interval is not read", "keep it aside")
        name = {"(": "column", "[": "commutator", r"\{": "poisson"}.get(box.name, "column")
        return Call(name, tuple(map(self.expression, parts)))

    def _evaluated(self, box: Box, content: list[Box]) -> Node:
        """An expression at a place: x = 0."""
        where = box.sub or []
        places = [k for k, b in enumerate(where) if b.kind == "relation" and b.name == "="]
        if len(places) != 1 or box.sup is not None:
            raise FormulaError(box.at, "where it is evaluated is not an equation", "write |_{x = 0}")
        left, right = where[: places[0]], where[places[0] + 1 :]
        return Call("at", (self.expression(content), self.expression(left), self.expression(right)))

    def _group(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if box.sub is not None:
            raise FormulaError(box.at, "a group has an index", "write it on the letter")
        return self._raised(self.expression(box.parts[0]), box), place + 1

    def _root(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        inner = self.expression(box.parts[0])
        if len(box.parts) > 1:
            degree = self.expression(box.parts[1])
            return self._raised(Call("power", (inner, Call("quotient", (number(1), degree)))), box), place + 1
        return self._raised(Call("sqrt", (inner,)), box), place + 1

    def _binomial(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        return self._raised(Call("binomial", tuple(map(self.expression, box.parts))), box), place + 1

    def _infinity(self, row: list[Box], place: int) -> tuple[Node, int]:
        return Letter("oo"), place + 1

    def _accent(self, row: list[Box], place: int) -> tuple[Node, int]:
        """A mark over more than a letter: a rate, a mean."""
        box = row[place]
        if box.sub is not None:
            raise FormulaError(box.at, "an index follows what is no letter", "write it on the letter")
        inner = self.expression(box.parts[0])
        if box.name == "dot":
            return self._raised(Call("rate", (inner,)), box), place + 1
        if box.name == "ddot":
            return self._raised(Call("rate", (Call("rate", (inner,)),)), box), place + 1
        if box.name == "bar":
            return self._raised(Call("mean", (inner,)), box), place + 1
        if box.name == "vec" and isinstance(inner, Call) and all(isinstance(a, Letter) for a in inner.args):
            names = "".join(a.name for a in inner.args if isinstance(a, Letter))
            return Letter(f"{names}vec", True), place + 1
        raise FormulaError(box.at, f"a {box.name} stands over what is no letter", "give it a letter of its own")

    def _matrix(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if box.sub is not None:
            raise FormulaError(box.at, "a matrix has an index", "write what it means")
        lines = [[self.expression(cell) for cell in line.parts] for line in box.parts[0]]
        if not lines or len({len(line) for line in lines}) != 1:
            raise FormulaError(box.at, "the rows of a matrix have different lengths", "write every entry")
        if box.name in ("vmatrix",):
            made = Call("det", tuple(Call("row", tuple(line)) for line in lines))
            return self._raised(made, box), place + 1
        if len(lines[0]) == 1:
            return self._raised(Call("column", tuple(line[0] for line in lines)), box), place + 1
        return self._raised(Call("matrix", tuple(Call("row", tuple(line)) for line in lines)), box), place + 1

    def _cases(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        made: list[Node] = []
        for line in box.parts[0]:
            if len(line.parts) != 2:
                raise FormulaError(box.at, "a case has no condition", "write the value, &, and where it holds")
            value, where = (_trimmed(cell) for cell in line.parts)
            where = [b for b in where if b.kind not in ("text", "wide", "thin")]
            condition: Node = Letter("otherwise")
            if where:
                stated = self._statement(_trimmed(where))
                if len(stated.relations) != 1 or stated.relations[0] not in _CONDITIONS:
                    raise FormulaError(where[0].at, "the condition of a case is not read", "write one relation")
                condition = Call(_CONDITIONS[stated.relations[0]], tuple(side.node for side in stated.sides))
            made.append(Call("case", (self.expression(value), condition)))
        return Call("cases", tuple(made)), place + 1

    # ---- fractions and derivatives

    def _fraction(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        if box.sub is not None:
            raise FormulaError(box.at, "a fraction has an index", "write it on a letter")
        if marks := _derivative_marks(box):
            return self._derivative(row, place, marks)
        over, under = (self.expression(part) for part in box.parts)
        if any(map(_has_differential, walk(under))) and not any(map(_has_differential, walk(over))):
            raise FormulaError(box.at, "a differential stands below and none above", "write \\frac{d f}{d x}")
        if vector_valued(under):
            raise FormulaError(box.at, "a vector is divided by", "write its length")
        return self._raised(Call("quotient", (over, under)), box), place + 1

    def _derivative(self, row: list[Box], place: int, mark: str) -> tuple[Node, int]:
        box = row[place]
        over, under = (_without_thin(part) for part in box.parts)
        order = self._order(over[0])
        variables = self._variables(under, mark)
        if sum(n for _, n in variables) != order:
            raise FormulaError(box.at, "the orders of the derivative differ", "write the same order above and below")
        operand = over[1:]
        behind = place + 1
        if operand:
            node = self.expression(operand)
        else:
            node, behind = self._operand(row, behind, box)
        if len(variables) == 1 and mark != "partial":
            made = self._total(node, variables[0][0], order, box)
        else:
            made = node
            for variable, times in variables:
                made = Call("Derivative", (made, variable, *([number(times)] if times > 1 else [])))
        return (self._raised(made, box) if operand else made), behind

    def _order(self, box: Box) -> int:
        if box.sup is None:
            return 1
        if len(box.sup) == 1 and box.sup[0].kind == "number" and box.sup[0].name.isdigit():
            return int(box.sup[0].name)
        raise FormulaError(box.at, "the order of the derivative is no number", "write a number")

    def _variables(self, under: list[Box], mark: str) -> list[tuple[Node, int]]:
        found: list[tuple[Node, int]] = []
        place = 0
        while place < len(under):
            if (
                not _is_d(under[place], mark)
                or place + 1 >= len(under)
                or under[place + 1].kind not in ("letter", "group")
            ):
                raise FormulaError(under[place].at, "what is differentiated by is not clear", "write \\frac{d f}{d x}")
            target = under[place + 1]
            if target.kind == "group":
                variable, times = self.expression(target.parts[0]), self._order(target)
            else:
                marked = self._superscript(target) is not None
                variable = self._named(target if marked else replace(target, sup=None))[0]
                times = 1 if marked else self._order(target)
            found.append((variable, times))
            place += 2
        return found

    def _operand(self, row: list[Box], place: int, box: Box) -> tuple[Node, int]:
        """What a derivative without an operand above acts on: what follows."""
        rest = _trimmed(row[place:])
        if not rest or rest[0].kind == "operator":
            raise FormulaError(box.at, "the derivative has nothing to act on", "write what is differentiated")
        node, behind = self.factor(rest, 0)
        remaining = [b for b in rest[behind:] if b.kind != "thin"]
        if not remaining:
            return node, len(row)
        if rest[0].kind == "bracket":
            self.guesses.append("a derivative acts on the bracket that follows it, not on what is behind")
            return node, len(row) - len(rest) + behind
        if any(b.kind == "fraction" and _derivative_marks(b) for b in rest):
            raise FormulaError(
                box.at, "how far the derivative reaches is open", "write brackets around what is differentiated"
            )
        self.guesses.append("a derivative acts on the whole product that follows it")
        return self.product(rest), len(row)

    def _total(self, node: Node, variable: Node, order: int, box: Box) -> Node:
        r"""dx/dt as \dot x."""
        if variable == Letter("t") and isinstance(node, Letter) and order <= 2:
            dots = re.search(r"_(d*)dot$", node.name)
            total = order + (len(dots[1]) + 1 if dots else 0)
            if total <= 2:
                stem = node.name[: dots.start()] if dots else node.name
                return Letter(f"{stem}_{'d' * (total - 1)}dot", node.vector)
        if variable == Letter("t") and order == 1 and not isinstance(node, Letter):
            return Call("rate", (node,))
        return Call("Derivative", (node, variable, *([number(order)] if order > 1 else [])))

    def _partial(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""\partial_x f, \partial_t^2 u."""
        box = row[place]
        if box.sub is None:
            raise FormulaError(
                box.at, "what ∂ differentiates by is missing", "write \\partial_x or \\frac{\\partial f}{\\partial x}"
            )
        if len(box.sub) != 1 or box.sub[0].kind != "letter":
            raise FormulaError(
                box.at, "what ∂ differentiates by is not clear", "write \\frac{\\partial f}{\\partial x}"
            )
        order = self._order(box)
        variable = self._named(box.sub[0])[0]
        node, behind = self._operand(row, place + 1, box)
        return Call("Derivative", (node, variable, *([number(order)] if order > 1 else []))), behind

    def _nabla(self, row: list[Box], place: int) -> tuple[Node, int]:
        r"""\nabla f, \nabla^2 f; with \cdot and \times it is not read here."""
        box = row[place]
        if box.sub is not None:
            raise FormulaError(box.at, "∇ has an index", "write the derivative")
        if place + 1 >= len(row) or row[place + 1].kind == "operator":
            raise FormulaError(box.at, "∇ with a product is not read", "write the components")
        node, behind = self._operand(row, place + 1, box)
        if box.sup is not None:
            if self._order(box) != 2:
                raise FormulaError(box.at, "a power of ∇ is not read", "write the derivatives")
            return Call("laplacian", (node,)), behind
        if vector_valued(node):
            raise FormulaError(box.at, "∇ of a vector is not read", "write \\cdot or \\times")
        return Call("gradient", (node,)), behind

    # ---- functions, sums and integrals

    def _function(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        name = FUNCTIONS.get(box.name, box.name)
        if name in ("max", "min", "sup", "inf") and box.sub is not None:
            raise FormulaError(box.at, f"{box.name} over a set is not read", "write its value")
        inner, behind = self._argument(row, place)
        node = self._applied(name, box, inner)
        if box.sup is None:
            return node, behind
        power = self.expression(box.sup)
        if power == Call("negative", (number(1),)):
            inverse = {"sin": "asin", "cos": "acos", "tan": "atan", "sinh": "asinh", "cosh": "acosh", "tanh": "atanh"}
            if name not in inverse:
                raise FormulaError(
                    box.at, f"whether {box.name}^{{-1}} is the inverse function is open", "write a fraction"
                )
            self.guesses.append(f"{box.name}^{{-1}} is the inverse function")
            return self._applied(inverse[name], replace(box, sup=None), inner), behind
        return Call("power", (node, power)), behind

    def _applied(self, name: str, box: Box, inner: tuple[Node, ...]) -> Node:
        if name == "log10" or (name == "log" and box.sub):
            base = self.expression(box.sub) if box.sub else number(10)
            return Call("quotient", (Call("log", inner), Call("log", (base,))))
        if box.sub is not None:
            raise FormulaError(box.at, f"{box.name} has an index", "write what it means")
        if box.name == "log":
            self.guesses.append("log is the natural logarithm")
        if name == "det" or name in ("tr", "Tr"):
            return Call(name.lower(), inner)
        return Call(name, inner)

    def _argument(self, row: list[Box], place: int) -> tuple[tuple[Node, ...], int]:
        """The arguments of a function: a bracket, or what follows it as custom has it."""
        behind = place + 1
        while behind < len(row) and row[behind].kind == "thin":
            behind += 1
        if behind >= len(row):
            raise FormulaError(row[place].at, f"{row[place].name} has no argument", "write it in brackets")
        first = row[behind]
        if first.kind == "bracket" and first.name in ("(", "[", r"\{"):
            if first.sup is not None:
                raise FormulaError(
                    first.at, "whether the power is of the argument or of the function is open", "write brackets"
                )
            parts = [self.expression(p) for p in arguments(first.parts[0])]
            return tuple(parts), behind + 1
        end = self._reach(row, behind, row[place])
        for box in row[behind:end]:
            if box.sup is not None and self._superscript(box) is None:
                raise FormulaError(
                    box.at, "whether the power is of the argument or of the function is open", "write brackets"
                )
        if row[behind].kind == "function":
            node, end = self.factor(row, behind)
            return (node,), end
        return (self.product(row[behind:end]),), end

    def _reach(self, row: list[Box], start: int, function: Box) -> int:
        """Where the argument of a function without brackets ends."""
        end = start
        while end < len(row) and row[end].kind in ("number", "letter", "fraction", "root", "group", "thin"):
            if row[end].kind == "thin" and end > start:
                break
            end += 1
        run = row[start:end]
        after = next((b for b in row[end:] if b.kind != "thin"), None)
        if not run:
            raise FormulaError(row[start].at, f"the argument of {function.name} is not clear", "write it in brackets")
        while run and run[-1].kind == "letter" and after is not None and after.kind == "bracket" and len(run) > 1:
            break
        if len(run) == 1:
            self._after_one(run[0], row, end, function)
            return end
        if run[0].kind == "number" and len(run) == 2 and run[1].kind == "letter" and not _moving(run[1]):
            return end
        return start + self._within(run, function)

    def _after_one(self, only: Box, row: list[Box], end: int, function: Box) -> None:
        """One thing behind a function; what follows a thin space is another factor where it is plain that it is."""
        after = next((b for b in row[end:] if b.kind != "thin"), None)
        if after is None or after.kind in (*_ENDING, "function", "big"):
            return
        if after.kind == "bracket" and only.kind == "letter":
            if self._called(only, after):
                raise FormulaError(
                    after.at,
                    f"whether the bracket belongs to the argument of {function.name} is open",
                    "write brackets",
                )
            if after.name == "(" and only.name not in _ANGLES and only.name not in self.notation.angles:
                raise FormulaError(
                    after.at,
                    f"whether the bracket belongs to the argument of {function.name} is open",
                    "write brackets",
                )
            self.guesses.append(f"the argument of {function.name} ends before the bracket")
            return
        if only.kind == "letter" and (only.name in _ANGLES or only.name in self.notation.angles or _moving(after)):
            self.guesses.append(f"the argument of {function.name} is {only.name} alone")
            return
        if only.kind in ("fraction", "group") and _moving(after):
            return
        raise FormulaError(after.at, f"where the argument of {function.name} ends is open", "write it in brackets")

    def _within(self, run: list[Box], function: Box) -> int:
        """How many of the factors behind a function are its argument."""
        moving = next((n for n, b in enumerate(run) if n and _moving(b)), len(run))
        kept = run[:moving]
        if moving < len(run):
            if len(kept) == 1 or (kept[0].kind == "number" and len(kept) == 2):
                self.guesses.append(f"the argument of {function.name} ends before what moves")
                return moving
            raise FormulaError(run[0].at, f"where the argument of {function.name} ends is open", "write it in brackets")
        letters = [b for b in kept if b.kind == "letter"]
        if len(letters) == len(kept) or (kept[0].kind in ("number", "fraction") and len(letters) == len(kept) - 1):
            first = letters[0].name if letters else ""
            ends = letters and letters[-1].name in ("t", "tau", "x", "y", "z", "s", "theta", "phi", "varphi")
            begins = first not in self.notation.angles and first not in (
                *_ANGLES[:4],
                "vartheta",
                "x",
                "y",
                "z",
                "r",
                "t",
            )
            if ends and begins and (len(letters) <= 2 or kept[0].kind == "number"):
                self.guesses.append(f"the argument of {function.name} is the product that follows it")
                return len(run)
        raise FormulaError(run[0].at, f"where the argument of {function.name} ends is open", "write it in brackets")

    def _big(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        kind = FUNCTION_OF_BIG(box)
        if not kind:
            raise FormulaError(box.at, f"\\{box.name} is not read", "write its value")
        if kind == "Integral":
            return self._integral(row, place)
        if kind == "limit":
            return self._limit(row, place)
        rest = _trimmed(row[place + 1 :])
        if not rest:
            raise FormulaError(box.at, "the sum has no terms", "write them")
        limits = self._limits(box)
        index = limits[0].name if isinstance(limits[0], Letter) else ""
        self.bound.append(index)
        for extra in limits[3:]:
            self.bound.append(extra.name if isinstance(extra, Letter) else "")
        inner = self.term(rest)
        del self.bound[-(1 + len(limits[3:])) :]
        return Call(kind, (inner, *limits)), len(row)

    def _limits(self, box: Box) -> list[Node]:
        """The index of a sum and its bounds; the index alone where it runs over all its values."""
        below = [b for b in box.sub or () if b.kind not in ("thin",)]
        if not below:
            if box.sup is not None:
                raise FormulaError(box.at, "what the sum runs over is missing", "write its index")
            return [Letter("all")]
        relations = [k for k, b in enumerate(below) if b.kind == "relation"]
        if not relations:
            if all(b.kind in ("letter", "comma") for b in below) and box.sup is None:
                letters = [
                    self._named(b)[0] if b.name not in ("i", "j") else Letter(b.name)
                    for b in below
                    if b.kind == "letter"
                ]
                return letters if len(letters) == 1 else [letters[0], Letter("all"), Letter("all"), *letters[1:]]
            raise FormulaError(box.at, "what the sum runs over is not clear", "write \\sum_{i=1}^{n}")
        if len(relations) == 1 and below[relations[0]].name == "=" and below[0].kind == "letter" and relations[0] == 1:
            name = below[0].name
            self.bound.append(name)
            start = self.expression(below[2:])
            ends = [self.expression(box.sup)] if box.sup is not None else []
            self.bound.pop()
            return [Letter(name), start, *ends]
        raise FormulaError(below[0].at, "the condition of the sum is not read", "write \\sum_{i=1}^{n}")

    def _limit(self, row: list[Box], place: int) -> tuple[Node, int]:
        box = row[place]
        below = [b for b in box.sub or () if b.kind != "thin"]
        arrows = [k for k, b in enumerate(below) if b.kind == "relation" and b.name == "->"]
        if len(arrows) != 1:
            raise FormulaError(box.at, "where the limit is taken is missing", "write \\lim_{x\\to 0}")
        variable, value = self.expression(below[: arrows[0]]), self.expression(below[arrows[0] + 1 :])
        return Call("limit", (self.term(_trimmed(row[place + 1 :])), variable, value)), len(row)

    def _integral(self, row: list[Box], place: int) -> tuple[Node, int]:
        """From the sign to its differential."""
        box = row[place]
        rest = row[place + 1 :]
        self.integrating += 1
        try:
            end, before = self._differential_at(rest, box)
            if before:  # \int dx f(x): the differential comes first
                variable = self._differential(_without_thin(rest), 0)
                assert variable is not None
                inner_row = _without_thin(rest)[variable[1] :]
                inner: Node = self.expression(inner_row) if inner_row else number(1)
                differential, behind = variable[0], len(row)
            else:
                inner, differential = _taken_out(self.expression(rest[:end]), box)
                behind = place + 1 + end
        finally:
            self.integrating -= 1
        assert isinstance(differential, Call)
        bounds: list[Node] = []
        if box.sub is not None and box.sup is not None:
            bounds = [self.expression(box.sub), self.expression(box.sup)]
        elif box.sub is not None or box.sup is not None:
            bounds = [Letter("over_" + "_".join(re.findall(r"\w+", self.source[(box.sub or box.sup)[0].at : box.end])))]  # type: ignore[index]
        variable_of = differential.args[0] if len(differential.args) == 1 else differential
        return Call("Integral", (inner, variable_of, *bounds)), behind

    def _differential_at(self, rest: list[Box], box: Box) -> tuple[int, bool]:
        """Where the integral's differential ends, and whether it comes first."""
        inner = 0
        first = next((k for k, b in enumerate(rest) if b.kind != "thin"), None)
        for place, each in enumerate(rest):
            if each.kind == "big" and FUNCTION_OF_BIG(each) == "Integral":
                inner += 1
            is_d = (
                each.kind == "letter"
                and each.name == "d"
                and place + 1 < len(rest)
                and not each.marks
                and each.sub is None
            )
            if is_d:
                target = place + 1
                while target < len(rest) and rest[target].kind == "thin":
                    target += 1
                if target >= len(rest) or rest[target].kind not in ("letter", "group"):
                    continue
                if inner:
                    inner -= 1
                    continue
                if place == first and any(b.kind not in ("thin",) for b in rest[target + 1 :]):
                    return target + 1, True
                behind = [b for b in rest[target + 1 :] if b.kind != "thin"]
                if behind and behind[0].kind == "letter" and behind[0].name == "d":
                    raise FormulaError(
                        behind[0].at,
                        "two differentials follow one integral",
                        "write as many integrals as differentials",
                    )
                return target + 1, False
            if (
                each.kind == "fraction"
                and not _derivative_marks(each)
                and any(b.kind == "letter" and b.name == "d" for b in each.parts[0])
            ):
                if inner:
                    inner -= 1
                    continue
                return place + 1, False
        raise FormulaError(box.at, "the differential of the integral is missing", "write d and its letter")


def FUNCTION_OF_BIG(box: Box) -> str:
    """What a large sign stands for."""
    from lagrotor.paper.source.boxes import BIG

    return BIG.get(box.name, "")


def _kind(relations: list[str]) -> str:
    kinds = set(relations)
    if not kinds:
        return "expression"
    if kinds <= {"=", ":="}:
        return "equation"
    if kinds <= {"=", ":=", "~"}:
        return "approximation"
    if kinds <= {"=", ":=", "<", ">", "<=", ">=", "<<", ">>", "!="}:
        return "inequality"
    return "other"


def _degree(node: Node, at: int) -> int:
    """How many differentials its terms have as factors. Raises FormulaError where the terms of a sum have not as many."""
    if not isinstance(node, Call):
        return 0
    if node.name == "differential":
        return 1
    degrees = [_degree(each, at) for each in node.args]
    if node.name in ("product", "dot", "cross", "matmul"):
        return sum(degrees)
    if node.name == "quotient":
        return degrees[0] - degrees[1]
    if node.name == "power" and isinstance(node.args[1], Number):
        return int(degrees[0] * node.args[1].value)
    if node.name in ("sum", "plus_minus", "minus_plus", "column"):
        terms = {d for d, each in zip(degrees, node.args, strict=True) if not _zero(each)}
        if len(terms) > 1:
            raise FormulaError(at, "a differential stands in one term only", "write what is added in each")
        return terms.pop() if terms else 0
    return degrees[0] if node.name in ("negative", "Sum", "Abs", "norm", "sqrt", "transpose") and degrees else 0


_NAMES = (
    "sin cos tan exp log ln det max min lim cot sinh cosh tanh arctan mat Mat vect Vect car dim ker Ker Hom End Aut rang rg grad "
    "div rot curl Id id tr Tr diag span rank const cst sgn ord deg eff tot kin pot"
)
_WORDS = frozenset(_NAMES.split())


def _no_word(row: list[Box]) -> None:
    """Raise FormulaError where letters in a row are a word, const or sin, and no product."""
    run = ""
    for box in [*row, Box("thin", "", 0, 0)]:
        plain = box.kind == "letter" and len(box.name) == 1 and not box.style and not box.marks
        if plain:
            run += box.name
        if not plain or box.sub is not None or box.sup is not None or box.primes:
            if len(run) > 4 or run in _WORDS or re.fullmatch("[A-Z][aeiou][a-z]+", run):
                raise FormulaError(
                    box.at or row[0].at, f"{run} is a word", "write \\text{…} for words, and \\sin for functions"
                )
            run = ""


def _zero(node: Node) -> bool:
    return node == number(0)


def _order_term(node: Call) -> tuple[tuple[str, int] | None, Node]:
    """The power of a term O(x^n), and the sum without it."""
    last = node.args[-1]
    if not (isinstance(last, Call) and last.name == "order" and len(last.args) == 1):
        return None, node
    inner = last.args[0]
    if isinstance(inner, Letter):
        found = inner.name, 1
    elif isinstance(inner, Call) and inner.name == "power" and isinstance(inner.args[0], Letter):
        if not isinstance(inner.args[1], Number) or inner.args[1].value.denominator != 1:
            return None, node
        found = inner.args[0].name, int(inner.args[1].value)
    else:
        return None, node
    rest = node.args[:-1]
    return found, rest[0] if len(rest) == 1 else Call("sum", rest)


def _product(factors: list[Node]) -> Node:
    flat: list[Node] = []
    for each in factors:
        flat += each.args if isinstance(each, Call) and each.name == "product" else (each,)
    return flat[0] if len(flat) == 1 else Call("product", tuple(flat))


def _numeric(node: Node) -> bool:
    """Whether a node has no letters, or begins with a number."""
    if isinstance(node, Call) and node.name in ("product", "quotient"):
        return _numeric(node.args[0]) or all(map(_numeric, node.args))
    return isinstance(node, Number) or (isinstance(node, Call) and all(map(_numeric, node.args)))


def _is_matrix(node: Node) -> bool:
    """Whether a node is a matrix: a bold capital, a matrix as it is written, a transposed one."""
    if isinstance(node, Letter):
        return node.vector and node.name[0].isupper() and "bold" in node.name
    if isinstance(node, Number):
        return False
    if node.name == "product":
        return any(map(_is_matrix, node.args))
    return node.name in ("matrix", "transpose", "inverse", "matmul") or (
        node.name in ("sum", "negative") and _is_matrix(node.args[0])
    )


def _hatted(node: Node) -> bool:
    """Whether a node is a letter with a hat that is not marked as a vector, or a product with one."""
    if isinstance(node, Call) and node.name == "product":
        return any(map(_hatted, node.args))
    return isinstance(node, Letter) and not node.vector and node.name.split("_")[0].endswith("hat")


def _scalar(node: Node) -> bool:
    """Whether a node is arithmetic of letters that are no vectors, and not 0."""
    plain = all(not isinstance(n, Call) or n.name in _ARITHMETIC for n in walk(node))
    return plain and not _zero(node) and not any(isinstance(n, Letter) and n.vector for n in walk(node))


def _bracket_last(part: list[Box]) -> bool:
    return bool(part) and part[-1].kind == "bracket"


def _differential_of(node: Node) -> Node | None:
    if isinstance(node, Call) and node.name == "differential" and len(node.args) == 1:
        return node.args[0]
    return None


def _without_thin(row: list[Box]) -> list[Box]:
    return [box for box in row if box.kind != "thin"]


def _has_differential(node: Node) -> bool:
    return isinstance(node, Call) and node.name == "differential"


def _is_d(box: Box, mark: str) -> bool:
    if mark == "partial":
        return box.kind == "partial" and box.sub is None
    return box.kind == "letter" and box.name == mark and not box.marks and box.sub is None


def _derivative_marks(box: Box) -> str:
    """d, partial, D or delta where a fraction is a derivative; nothing where it is none."""
    over, under = (_without_thin(part) for part in box.parts)
    if not over or len(under) < 2:
        return ""
    for mark in ("d", "partial", "D", "delta"):
        if _is_d(over[0], mark) and _is_d(under[0], mark) and under[1].kind in ("letter", "group"):
            if mark in ("D", "delta") and len(over) == 1:
                continue
            return mark
    return ""


def _differential_above(box: Box) -> bool:
    """Whether a fraction has the differential of an integral above."""
    d = box.kind == "fraction" and any(b.kind == "letter" and b.name == "d" for b in box.parts[0])
    return d and not _derivative_marks(box)


def _is_operator(box: Box) -> bool:
    """Whether a fraction is d/dx with nothing above."""
    return bool(_derivative_marks(box)) and len(_without_thin(box.parts[0])) == 1


def _moving(box: Box) -> bool:
    """Whether a box is a velocity or a vector, which no argument of a sine has as a second factor."""
    if box.kind == "letter":
        return any(mark.endswith("dot") or mark in ("vec", "hat") for mark in box.marks) or box.style == "bold"
    return box.kind == "fraction" and bool(_derivative_marks(box))


def _unit_like(text: str) -> bool:
    return (
        bool(re.fullmatch(r"[A-Za-zµ/^\d{}\s.·~-]{1,12}", text))
        and " and " not in text
        and text not in ("if", "for", "as", "or")
    )


def _taken_out(node: Node, box: Box) -> tuple[Node, Node]:
    """What is integrated, and the differential that is a factor of it."""
    if isinstance(node, Call):
        if node.name == "differential":
            return number(1), node
        if node.name == "negative":
            inner, found = _taken_out(node.args[0], box)
            return Call("negative", (inner,)), found
        if node.name == "quotient":
            inner, found = _taken_out(node.args[0], box)
            return Call("quotient", (inner, node.args[1])), found
        if node.name == "product":
            for place, each in enumerate(node.args):
                if _holds(each):
                    inner, found = _taken_out(each, box)
                    rest = [*node.args[:place], *([] if inner == number(1) else [inner]), *node.args[place + 1 :]]
                    return _product(rest or [number(1)]), found
        if node.name == "sum" and _holds(node.args[-1]):
            inner, found = _taken_out(node.args[-1], box)
            return Call("sum", (*node.args[:-1], inner)), found
        if node.name in ("dot", "cross") and _holds(node.args[-1]) and not _vector_differential(node.args[-1]):
            inner, found = _taken_out(node.args[-1], box)
            return Call(node.name, (*node.args[:-1], inner)), found
        if node.name in ("dot", "cross") and _holds(node.args[-1]):
            differential = next(
                each for each in walk(node.args[-1]) if isinstance(each, Call) and each.name == "differential"
            )
            return node, differential
    raise FormulaError(box.at, "the differential is no factor of what is integrated", "write it at the end")


def _vector_differential(node: Node) -> bool:
    """Whether the differential is of a vector, as in F·dr."""
    return any(_has_differential(each) and vector_valued(each) for each in walk(node))


def _holds(node: Node) -> bool:
    return isinstance(node, Call) and (
        node.name == "differential"
        or (node.name in ("product", "quotient", "negative", "sum") and any(map(_holds, node.args)))
    )


def _paired(row: list[Box]) -> list[Box]:
    """Bars in pairs as brackets. Raises FormulaError where they can be paired in two ways."""
    places = [k for k, box in enumerate(row) if box.kind == "bar"]
    if not places:
        return row
    if len(places) % 2:
        raise FormulaError(row[places[-1]].at, "a bar has no partner", "write \\left| and \\right|")
    made: list[Box] = []
    last = 0
    for n in range(0, len(places), 2):
        a, b = places[n], places[n + 1]
        between = row[places[n - 1] + 1 : a] if n else []
        if n and not any(x.kind in ("operator", "relation") for x in between):
            raise FormulaError(row[a].at, "how the bars belong together is open", "write \\left| and \\right|")
        inner = _trimmed(row[a + 1 : b])
        if (
            not inner
            or inner[-1].kind == "operator"
            or row[a].sup is not None
            or row[a].sub is not None
            or row[a].name != row[b].name
        ):
            raise FormulaError(row[a].at, "how the bars belong together is open", "write \\left| and \\right|")
        sign = r"\|" if row[a].name == "||" else "|"
        closed = Box("bracket", sign, row[a].at, row[b].end, [inner], sub=row[b].sub, sup=row[b].sup, closing=sign)
        made += [*row[last:a], closed]
        last = b + 1
    return [*made, *row[last:]]
