"""A formula as printed, without interpretation: a row of boxes such as symbols, fractions and brackets, with scripts."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from keyword import iskeyword
from string import ascii_letters
from typing import Any

from lagrotor.paper.grammar import FUNCTIONS as CALLED
from lagrotor.paper.latex.tokens import BRACES, Token, tokenize

_GREEK_NAMES = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi omega "
    "varepsilon vartheta varphi varrho varsigma varkappa varpi digamma "
    "Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell hbar aleph imath jmath wp "
    "varGamma varDelta varTheta varLambda varXi varPi varSigma varUpsilon varPhi varPsi varOmega"
)
GREEK = {rf"\{name}" for name in _GREEK_NAMES.split()}
_UNICODE_NAMES = (
    "alpha beta gamma delta varepsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon varphi chi psi omega "
    "Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega phi vartheta"
)
_UNICODE = dict(zip("αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩϕϑ", _UNICODE_NAMES.split(), strict=True))
ACCENTS = {
    **{name: name for name in ("dot", "ddot", "dddot", "ddddot", "hat", "bar", "tilde", "vec", "check", "breve", "acute")},
    **{"widehat": "hat", "overline": "bar", "widetilde": "tilde", "overrightarrow": "vec", "underline": "under"},
    **{"grave": "grave", "mathring": "ring"},
}  # fmt: skip
STYLES = {
    **dict.fromkeys(("mathbf", "boldsymbol", "symbf", "bf", "bfseries", "textbf", "bm", "pmb", "bold", "vb"), "bold"),
    **dict.fromkeys(("mathrm", "mathit", "mathnormal", "rm", "it", "text", "textrm", "mbox", "operatorname"), ""),
    **{"mathcal": "cal", "mathscr": "scr", "mathfrak": "frak", "mathbb": "bb", "mathsf": "sf", "mathtt": "tt", "cal": "cal"},
}  # fmt: skip
_TEXT, _SWITCHES = ("text", "textrm", "mbox"), ("rm", "bf", "it", "cal", "bfseries")
FUNCTIONS = {
    **{name: name for name in ("sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "coth", "sech", "csch", "exp")},
    **{"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh"},
    **{"arsinh": "asinh", "arcosh": "acosh", "artanh": "atanh", "asin": "asin", "acos": "acos", "atan": "atan"},
    **{"ln": "log", "log": "log", "lg": "log10", "sgn": "sign", "sign": "sign"},
    **{name: name for name in ("det", "tr", "Tr", "arg", "Re", "Im", "max", "min")},
}  # fmt: skip
BIG = {"sum": "Sum", "prod": "Product", **dict.fromkeys(("int", "oint", "iint", "iiint"), "Integral"), "lim": "limit"}
RELATIONS = {
    "=": "=", "<": "<", ">": ">", "neq": "!=", "ne": "!=", "ll": "<<", "gg": ">>", "lesssim": "<~", "gtrsim": ">~",
    **dict.fromkeys(("approx", "simeq", "sim", "cong", "doteq"), "~"), "propto": "propto", "in": "in",
    **dict.fromkeys(("equiv", "triangleq", "coloneqq"), ":="),
    **dict.fromkeys(("le", "leq", "leqslant"), "<="), **dict.fromkeys(("ge", "geq", "geqslant"), ">="),
    **dict.fromkeys(("to", "rightarrow", "longrightarrow", "mapsto"), "->"), "perp": "perp", "parallel": "parallel",
}  # fmt: skip
_ARROWS = "Rightarrow implies iff Leftrightarrow Longrightarrow Longleftrightarrow therefore because forall"
_THIN = (",", ";", ":", " ", ">", "thinspace", "medspace", "thickspace", "enspace", "enskip", "\n", "nobreakspace")
_PASSED = (
    "! / displaystyle textstyle scriptstyle limits nolimits negthinspace nobreak allowbreak strut null relax hfill notag "
    "nonumber noindent centering small footnotesize qedhere"
)
_NOTHING = frozenset(_PASSED.split())
_OPERATORS = {
    "+": "+", "-": "-", "−": "-", "*": "*", "/": "/", "·": "cdot", "×": "times", "div": "/", "ast": "*",
    **{name: name for name in ("cdot", "times", "pm", "mp", "wedge", "otimes", "oplus", "circ", "star", "bullet")},
}  # fmt: skip
_DOTS = ("dots", "ldots", "cdots", "vdots", "ddots", "dotsc", "dotsb", "dotso", "dotsm", "hdots")
_INFIX = {r"\over": "fraction", r"\choose": "binomial"}
_SIZES = re.compile(r"\\(?:[bB]igg?[lrm]?|middle)")
_OPEN = {"(": ")", "[": "]", r"\{": r"\}", r"\langle": r"\rangle", r"\lfloor": r"\rfloor", r"\lceil": r"\rceil",
         r"\lvert": r"\rvert", r"\lVert": r"\rVert", r"\lbrace": r"\rbrace", r"\lbrack": r"\rbrack"}  # fmt: skip
_CLOSE = {*_OPEN.values(), r"\right"}
_MATRICES = ("matrix", "pmatrix", "bmatrix", "vmatrix", "smallmatrix", "array")
_PAIRS = ("aligned", "alignedat", "align", "align*", "split")
_ROWS = (*_PAIRS, "gathered", "multlined", "gather", "gather*", "eqnarray*", "eqnarray", "equation", "equation*")
_CASES = ("cases", "dcases")
_ROW_ENDS = ("&", r"\\", r"\end", r"\hline", r"\cr")
_MOST = 200  # nested brackets


class FormulaError(Exception):
    """A formula that cannot be read. `what` says why, `help` says what the author should write instead."""

    def __init__(self, what: str, help_: str) -> None:
        super().__init__(what)
        self.what, self.help = what, help_


@dataclass(slots=True)
class Box:
    """One printed object; in the LaTeX it begins at the character `at` and ends before the character `end`.

    kind: letter (any symbol), number, operator, relation, bracket, fraction, binomial, root, function, big, matrix, cases,
    rows, accent, text, wide, comma, dots, arrow, bar, group, partial, nabla, infinity.
    name: the symbol or the command. style: the font of a symbol, "" for italic. marks: its accents. upright: True for
    an upright symbol. contents: the rows of boxes inside, such as numerator and denominator. sub, sup: the boxes of the
    subscript and the superscript, None without one. closing: the closing bracket. spaced: True after a thin space.
    """

    kind: str
    name: str
    at: int
    end: int
    contents: Sequence[list["Box"]] = ()
    style: str = ""
    marks: tuple[str, ...] = ()
    sub: "list[Box] | None" = None
    sup: "list[Box] | None" = None
    primes: int = 0
    closing: str = ""
    upright: bool = False
    spaced: bool = False


def boxes(latex: str) -> list[Box]:
    """Split a formula in LaTeX into its row of boxes. Raises FormulaError at a token that is not allowed there."""
    reader = _Reader(latex)
    row = reader.sequence(())
    if reader.ahead:
        raise FormulaError(f"{reader.ahead} closes no bracket", "write the opening bracket")
    return row


class _Reader:
    def __init__(self, latex: str) -> None:
        self.latex, self.place, self.depth = latex, 0, 0
        self.items: list[Token] = []
        for token in tokenize(latex):
            single = [Token("text", c, at) for at, c in enumerate(token.text, token.at) if not c.isspace()]
            self.items += single if token.kind == "text" else [token]
        self.items.append(Token("end", "", len(latex)))

    @property
    def ahead(self) -> str:
        """The text of the next token; empty at the end."""
        return self.items[self.place].text

    @property
    def opens(self) -> bool:
        """True if the next token is an opening brace."""
        return self.items[self.place].kind == "open"

    def take(self) -> Token:
        item = self.items[self.place]
        self.place += item.kind != "end"
        return item

    @property
    def end(self) -> int:
        """The position in the LaTeX that follows the last consumed token."""
        last = self.items[self.place - 1]
        return last.at + len(last.text)

    def box(self, kind: str, name: str, item: Token, *contents: list[Box], **fields: Any) -> Box:
        """Return a box that begins at the token `item` and ends with the last consumed token."""
        return Box(kind, name, item.at, self.end, list(contents), **fields)

    def argument(self, style: str = "") -> list[Box]:
        """Read the argument of a command: all boxes in braces, or the single object that follows the command."""
        if not self.ahead:
            raise FormulaError(f"{self.items[self.place - 1].text} has no argument", "write its argument in braces")
        if self.opens:
            return self.group(style)
        if not self.ahead.isdecimal():
            return self.single(style)
        item = self.take()
        return [self.box("number", item.text, item)]

    def group(self, style: str = "") -> list[Box]:
        opened = self.take()
        row = self.sequence(("}",), style)
        if not self.ahead:
            raise FormulaError("{ is not closed", "write the closing brace")
        self.take()
        if row:  # its ends have their braces
            row[0].at, row[-1].end = opened.at, self.end
        return row

    def plain(self) -> str:
        """Consume an argument in braces, or a single token, and return its text."""
        return self.enclosed("}") if self.opens else self.take().text

    def bracketed(self) -> str:
        """Consume an optional argument in square brackets and return its text; "" if there is none."""
        return self.enclosed("]") if self.ahead == "[" else ""

    def enclosed(self, closing: str) -> str:
        """Consume the text from the next opening sign to the matching `closing` sign; return the text between them."""
        start, depth = self.take().at + 1, 0
        while self.ahead:
            item = self.take()
            if item.text == closing and depth == 0:
                return self.latex[start : item.at]
            depth += BRACES.get(item.kind, 0)
        return self.latex[start:]

    def sequence(self, ends: tuple[str, ...], style: str = "") -> list[Box]:
        """Read boxes up to the first token that is in `ends`; this token is not consumed."""
        self.depth += 1
        if self.depth > _MOST:
            raise FormulaError(f"{self.ahead} is nested too deeply", "write fewer nested brackets")
        row: list[Box] = []
        while self.ahead and self.ahead not in ends:
            item = self.items[self.place]
            if item.kind == "close" or (item.text in _CLOSE and item.text != "]"):
                break
            if item.kind == "command" and item.text[1:] in _SWITCHES:
                style = STYLES[self.take().text[1:]] or "upright"
            elif item.text in _INFIX:
                self.take()
                row = [self.box(_INFIX[item.text], "", item, _without_spaces(row), self.sequence(ends, style))]
            elif item.kind == "script":
                self.script(row)
            elif item.text in ("'", "’", "′"):
                self.take()
                self.prime(row, 1)
            elif self.latex.startswith("{,}", item.at) and row and row[-1].kind == "number":
                self.comma_in_number(row[-1])
            else:
                self.extend(row, style)
        self.depth -= 1
        return _without_spaces(row)

    def extend(self, row: list[Box], style: str) -> None:
        """Read the next object and append it to a row. If a script follows several boxes in braces, they form a group."""
        braced, new = self.opens, self.single(style)
        if row and len(new) == 1 and row[-1].end == new[0].at and _joins(row[-1], new[0], style):
            row[-1].name += new[0].name
            row[-1].end = new[0].end
            return
        scripted = any(box.sub is not None or box.sup is not None or box.primes for box in new)
        if self.items[self.place].kind == "script" and (len(new) > 1 or (braced and scripted)):
            new = [Box("group", "", new[0].at, self.end, [new])]
        row += new

    def comma_in_number(self, number: Box) -> None:
        self.place += 3
        if not self.ahead.isdecimal():
            raise FormulaError("{,} is not part of a number", "write digits after the comma")
        number.name += "{,}"
        while self.ahead.isdecimal():
            number.name += self.take().text
        number.end = self.end

    def prime(self, row: list[Box], count: int) -> None:
        if not row or row[-1].kind != "letter":
            raise FormulaError("' follows a sign that is not a symbol", "write the derivative, or give it a symbol")
        row[-1].primes += count
        row[-1].end = self.end

    def script(self, row: list[Box]) -> None:
        item, target = self.take(), row[-1] if row else None
        if target is None or target.kind in ("operator", "relation", "comma", "wide", "text", "thin", "arrow"):
            raise FormulaError(f"{item.text} has nothing before it", "write the symbol before its index or power")
        content = self.argument()
        if item.text == "^" and content and all(b.kind == "letter" and b.name == "prime" for b in content):
            self.prime(row, len(content))
        elif (target.sup if item.text == "^" else target.sub) is not None:
            raise FormulaError(f"{item.text} follows another {item.text}", "write both in one pair of braces")
        elif item.text == "^":
            target.sup = content
        else:
            target.sub = content
        target.end = self.end

    def single(self, style: str) -> list[Box]:
        """Read the next object without its scripts. Return one box, or all boxes of a group in braces."""
        if self.opens:
            return self.group(style)
        item = self.take()
        text, sign = item.text, _SIGNS.get(item.text)
        if sign is not None:
            return [self.box(*sign, item)]
        if text in _LETTERS:
            upright = style == "upright"
            return [self.box("letter", _LETTERS[text], item, style="" if upright else style, upright=upright)]
        if item.kind == "command":
            return self.command(item, style)
        if item.kind == "align":
            return []
        if text == "." and self.ahead == ".":
            while self.ahead == ".":
                self.take()
            return [self.box("dots", "dots", item)]
        if text.isdecimal() or (text == "." and self.ahead.isdecimal() and self.items[self.place].at == self.end):
            return [self.number(item)]
        if text in _OPEN:
            return [self.bracket(text, item, style)]
        if text == ":" and self.ahead == "=":
            self.take()
            return [self.box("relation", ":=", item)]
        if text in (":", "."):
            return [self.box("operator" if text == ":" else "comma", text, item)]
        raise FormulaError(f"{text} is unknown", "write the character in LaTeX")

    def number(self, item: Token) -> Box:
        digits = item.text
        while self.ahead:
            point = self.ahead == "." and "." not in digits and self.items[self.place + 1].text.isdecimal()
            if not point and not (self.ahead.isdecimal() and self.items[self.place].at == self.end):
                break
            digits += self.take().text
        return self.box("number", digits, item)

    def command(self, item: Token, style: str) -> list[Box]:
        name = item.text[1:]
        if name in _NOTHING:
            return []
        if name in ACCENTS:
            return [self.accent(ACCENTS[name], item, style)]
        if item.text in _OPEN:
            return [self.bracket(item.text, item, style)]
        if _SIZES.fullmatch(item.text):  # a size command precedes a bracket
            bar = self.ahead in (r"\|", r"\Vert", "|", r"\vert")
            return self.single(style) if bar else []
        form = _FORMS.get(name.rstrip("*"))
        if form is not None:
            return form(self, item, style)
        if name in STYLES:
            return self.styled(name, item)
        raise FormulaError(f"{item.text} is unknown", r"write what it means, or define it by \newcommand")

    def accent(self, mark: str, item: Token, style: str) -> Box:
        content = self.argument(style)
        only = content[0] if len(content) == 1 else None
        if only is None or only.kind != "letter" or only.sup is not None or only.primes:
            return self.box("accent", mark, item, content)
        only.marks += (mark,)
        only.at, only.end = item.at, self.end
        return only

    def styled(self, name: str, item: Token) -> list[Box]:
        r"""Read the argument of a font command: symbols, as in \mathbf{r}, or one word, as in \mathrm{kin}."""
        style, start = STYLES[name], self.place
        worded = self.opens and name in (*_TEXT, "mathrm", "operatorname", "mathit", "mathsf", "mathtt")
        word = self.plain().strip() if worded else "-"
        if name == "operatorname" or (len(word) > 1 and word in FUNCTIONS):
            return [self.box("function", word, item)]
        if worded and name in _TEXT and word != "d":
            if "$" in word:
                raise FormulaError("the argument of a text command contains a formula", "write it outside the words")
            return [self.box("text" if word else "thin", word, item)]
        if len(word) == 2 and word[0] == "d" and word.isalpha() and name == "mathrm":
            return [self.box("letter", letter, item, upright=letter == "d") for letter in word]
        if len(word) > 1 and word.isascii() and word.isalpha():
            return [self.box("letter", word, item, upright=True)]
        if len(word) > 1 and re.search(r"[/%^~.·]", word):
            raise FormulaError(f"{item.text}{{{word}}} is a unit", "write the numbers without units")
        self.place = start
        content = self.argument(style or "upright")
        for box in content:
            if box.kind == "number" and style and box.name != "0":
                raise FormulaError(f"{item.text}{{{box.name}}} is not read", "give the unit matrix a symbol")
            if box.kind == "letter":
                box.style, box.upright = style or box.style, box.upright or not style
        if content:
            content[0].at, content[-1].end = item.at, self.end
        return content

    def bracket(self, opening: str, item: Token, style: str = "") -> Box:
        closing = _OPEN[opening]
        content = self.sequence((closing,), style)
        if _SIZES.fullmatch(self.ahead):
            self.take()
        if self.ahead != closing:
            raise FormulaError(f"{opening} is not closed by {closing}", f"write {closing} at the end")
        self.take()
        return self.box("bracket", opening, item, content, closing=closing)

    # ---- commands with special arguments

    def _left(self, item: Token, style: str) -> list[Box]:
        opening, content = self.take().text, self.sequence((r"\right",), style)
        if not self.take().text or not self.ahead:
            raise FormulaError(r"\left is not closed", r"write \right with its bracket")
        closing = self.take().text
        return [self.box("bracket", opening, item, content, closing=closing)]

    def _frac(self, item: Token, style: str) -> list[Box]:
        style = "" if style == "upright" else style
        kind = "binomial" if item.text.endswith("binom") else "fraction"
        over, under = self.argument(style), self.argument(style)
        return [self.box(kind, "", item, over, under)]

    def _derivative(self, item: Token, style: str) -> list[Box]:
        degree, arguments = self.bracketed(), [self.argument(style)]
        if self.opens:
            arguments.append(self.argument(style))
        under, order = arguments[-1], boxes(degree) if degree else None
        if len(under) != 1 or under[0].sup is not None:
            raise FormulaError(f"{item.text} differentiates by more than one symbol", r"write \frac{d f}{d x}")
        kind, name = ("letter", "d") if item.text == r"\dv" else ("partial", "partial")
        above, below = (self.box(kind, name, item, upright=True, sup=sup) for sup in (order, None))
        over = [above, *(arguments[0] if arguments[1:] else [])]
        return [self.box("fraction", "", item, over, [below, replace(under[0], sup=order)])]

    def _sqrt(self, item: Token, style: str) -> list[Box]:
        degree, content = self.bracketed(), self.argument("" if style == "upright" else style)
        return [self.box("root", "", item, content, *([boxes(degree)] if degree else []))]

    def _begin(self, item: Token, style: str) -> list[Box]:
        name = self.plain()
        if name not in (*_MATRICES, *_ROWS, *_CASES):
            raise FormulaError(rf"\begin{{{name}}} is unknown", "write the formula without this environment")
        self.bracketed()
        if name in ("array", "alignedat") and "|" in self.plain():
            raise FormulaError("a vertical line divides the matrix", "write each block as a matrix of its own")
        rows: list[list[list[Box]]] = [[[]]]
        sign = ""
        while sign != r"\end":
            rows[-1][-1] += self.sequence(_ROW_ENDS)
            if self.ahead not in _ROW_ENDS:
                raise FormulaError(rf"\begin{{{name}}} is not closed", rf"write \end{{{name}}}")
            sign = self.take().text
            if sign == "&":
                second = name in _PAIRS and len(rows[-1]) % 2 == 0  # every second & begins another equation
                rows[-1][-1] += [self.box("wide", "", self.items[self.place - 1])] if second else []
                rows[-1].append([])
            elif sign in (r"\\", r"\cr"):
                self.bracketed()
                rows.append([[]])
        self.plain()
        kind = "cases" if name in _CASES else "rows" if name in _ROWS else "matrix"
        return [self.box(kind, name, item, [self.box("row", "", item, *row) for row in rows if any(row)])]

    def _underbrace(self, item: Token, style: str) -> list[Box]:
        content = self.argument(style)
        if self.items[self.place].kind == "script":
            self.take()
            self.plain()
        joined = bool(content) and content[0].kind == "operator"  # the sign joins it to the term before
        return content if joined else [self.box("group", "brace", item, content)]

    def _skip(self, item: Token, style: str) -> list[Box]:
        self.plain()
        return [self.box("thin", "", item)] if item.text == r"\hspace" else []

    def _line_end(self, item: Token, style: str) -> list[Box]:
        """Read a line break outside any environment; it separates formulas as a wide space does."""
        self.bracketed()
        return [self.box("wide", "", item)]


def _without_spaces(row: list[Box]) -> list[Box]:
    """Return a row without thin spaces; the box after one becomes `spaced`. Three in succession become one wide space."""
    result, after_thin = list[Box](), False
    for thin, run in groupby(row, key=lambda box: box.kind == "thin"):
        boxes = list(run)
        if thin and len(boxes) > 2:
            result.append(replace(boxes[0], kind="wide"))
        elif not thin:
            boxes[0].spaced |= after_thin
            result += boxes
        after_thin = thin
    return result


def _joins(word: Box, letter: Box, style: str) -> bool:
    """Return True if an upright symbol is the next letter of the upright word before it."""
    letters = word.kind == letter.kind == "letter" and word.upright and letter.upright and len(letter.name) == 1
    return style == "upright" and letters and word.sub is None and word.sup is None and not word.marks


# Characters and commands of symbols → name; those of other boxes, independent of their neighbours → (kind, name).
_LETTERS = {letter: letter for letter in ascii_letters} | _UNICODE
_LETTERS |= {command: re.sub(r"var(?=[A-Z])", "", command[1:]) for command in GREEK}  # \varDelta is an italic \Delta
_LETTERS |= {rf"\{'Up' if name[0].isupper() else 'up'}{name.lower()}": name for name in _GREEK_NAMES.split()}
_LETTERS |= {rf"\{name}": name for name in ("prime", "dagger", "top", "intercal")} | {r"\dag": "dagger"}
_COMMANDS: dict[str, tuple[str, str]] = {
    **dict.fromkeys(("quad", "qquad"), ("wide", "")),
    **dict.fromkeys(_THIN, ("thin", "")),
    **{name: ("operator", sign) for name, sign in _OPERATORS.items() if name.isalpha()},
    **{name: ("relation", sign) for name, sign in RELATIONS.items() if name.isalpha()},
    **{name: ("arrow", name) for name in _ARROWS.split()},
    **{name: ("dots", name) for name in _DOTS},
    **{name: ("big", name) for name in BIG},
    **{name: ("function", name) for name in FUNCTIONS},
    **{
        "partial": ("partial", ""),
        "nabla": ("nabla", ""),
        "infty": ("infinity", "infty"),
    },
    **{"|": ("bar", "||"), "Vert": ("bar", "||"), "vert": ("bar", "|")},
}
_SIGNS: dict[str, tuple[str, str]] = {
    **{text: ("operator", name) for text, name in _OPERATORS.items() if len(text) == 1},
    **{text: ("relation", name) for text, name in RELATIONS.items() if not text.isalpha()},
    **{",": ("comma", ","), ";": ("comma", ";"), "!": ("operator", "!"), "~": ("thin", ""), "|": ("bar", "|")},
    **{"∂": ("partial", ""), "∇": ("nabla", ""), "∞": ("infinity", "infty")},
    **{rf"\{name}": sign for name, sign in _COMMANDS.items()},
}
_FRACTIONS = ("frac", "dfrac", "tfrac", "cfrac", "sfrac", "nicefrac", "binom", "dbinom", "tbinom")
_FORMS: dict[str, Callable[[_Reader, Token, str], list[Box]]] = {
    **dict.fromkeys(_FRACTIONS, _Reader._frac),
    **dict.fromkeys(("dv", "pdv"), _Reader._derivative),
    **dict.fromkeys(("underbrace", "overbrace"), _Reader._underbrace),
    **dict.fromkeys(("label", "cite", "vspace", "tag", "hspace"), _Reader._skip),
    **{"left": _Reader._left, "sqrt": _Reader._sqrt, "begin": _Reader._begin, "\\": _Reader._line_end},
}


# ---- rows of boxes


def is_printed_as_vector(box: Box) -> bool:
    """Return True for a symbol in bold, with an arrow or with a line below."""
    return box.style == "bold" or "vec" in box.marks or "under" in box.marks


def strip(row: list[Box]) -> list[Box]:
    """Return a row without wide spaces at its ends and without punctuation at its right end."""
    start, end = 0, len(row)
    while start < end and row[start].kind == "wide":
        start += 1
    while end > start and row[end - 1].kind in ("wide", "comma"):
        end -= 1
    return row[start:end]


def split_at(row: list[Box], *kinds: str) -> list[list[Box]]:
    """Return the parts of a row between the boxes of the given kinds. A full stop does not separate parts."""
    ends = [-1, *(k for k, box in enumerate(row) if box.kind in kinds and box.name != "."), len(row)]
    return [row[first + 1 : last] for first, last in pairwise(ends)]


def all_boxes(row: Iterable[Box]) -> Iterator[Box]:
    """Yield each box of a row, followed by the boxes in its contents and its scripts."""
    for box in row:
        yield box
        for inner in (*box.contents, box.sub or (), box.sup or ()):
            yield from all_boxes(inner)


def is_mark(box: Box, mark: str) -> bool:
    """Return True if a box is the sign of a derivative: the letter `mark`, or ∂ if `mark` is "partial"."""
    if mark == "partial":
        return box.kind == "partial" and box.sub is None
    return box.kind == "letter" and box.name == mark and not (box.marks or box.sub or box.primes or box.style)


def is_derivative(box: Box) -> str:
    """Return 'd' or 'partial' if a box is a fraction that prints a derivative, '' if it is not."""
    if box.kind == "fraction":
        over, under = box.contents
        for mark in ("d", "partial") if over and len(under) > 1 and under[1].kind == "letter" else ():
            if is_mark(over[0], mark) and is_mark(under[0], mark):
                return mark
    return ""


# ---- names of symbols


def stem_of(box: Box) -> str:
    """Return the name of a symbol with its font and its accents; the index, the dots and the primes are left out."""
    return {"lambda": "lamda"}.get(box.name, box.name) + box.style + "".join(_marks(box))


def _marks(box: Box) -> list[str]:
    return sorted((mark for mark in box.marks if not mark.endswith("dot")), key=lambda mark: mark != "vec")


def name_of(box: Box, index: Iterable[str] = (), raised: Iterable[str] = ()) -> str:
    r"""Return the Python name of a symbol: theta_1_dot for \dot\theta_1, rvec_1 for \vec r_1, T__max for T^{\max}.

    index: the words of its subscript. raised: the words of a superscript that is not a power.
    """
    rates = sum(len(mark) - len("ot") for mark in box.marks if mark.endswith("dot"))
    name = stem_of(box) + "prime" * box.primes + "".join(f"__{word}" for word in raised)
    name += "".join(f"_{word}" for word in index) + (f"_{'d' * rates}ot" if rates else "")
    reserved = name in CALLED or iskeyword(name) or (name == "hbar" and box.name == "h")  # a mean h is no ħ
    return f"{name}_" if reserved else name


def index_of(box: Box) -> list[str]:
    """Return the words of a symbol's subscript, such as ["1"], ["cm"] or ["i", "j"]; [] if it has none.

    Raises FormulaError for a subscript that contains signs other than letters and numbers.
    """
    words: list[str] = []
    alone = True  # a comma or a Greek letter ends a word
    for entry in box.sub or ():
        if entry.kind == "comma" and entry.name != ".":
            alone = True
            continue
        inner = _index(entry)
        greek = entry.kind == "letter" and len(entry.name) > 1 and not entry.upright
        if alone or greek or len(inner) != 1 or not words:
            words += inner
        else:
            words[-1] += inner[0]
        alone = greek
    return words


def _index(entry: Box) -> list[str]:
    """Return the words that one box of a subscript contributes to the name of the symbol."""
    if entry.kind == "letter" and entry.sup is None:
        return [entry.name + entry.style + "prime" * entry.primes + "".join(entry.marks), *index_of(entry)]
    plain = entry.sup is None and entry.sub is None
    if entry.kind == "number" and plain and "," not in entry.name:
        return [entry.name.replace(".", "p")]
    name = "".join(c for c in entry.name if c.isalnum())
    if entry.kind in ("text", "function") and plain and 0 < len(name) <= 24 and not re.search(r"\\|d?dot", entry.name):
        return [name]
    if entry.kind in ("operator", "infinity", "relation") and entry.name in _INDEX_SIGNS:
        return [_INDEX_SIGNS[entry.name]]
    if entry.kind in ("group", "fraction") and plain:  # i + 1/2
        return ["over".join("".join(word for inner in row for word in _index(inner)) for row in entry.contents)]
    raise FormulaError("an index has signs other than letters and numbers", "give the symbol a simpler index")


_INDEX_SIGNS = {"+": "plus", "-": "minus", "*": "star", "/": "over", "infty": "inf", "=": "eq", "->": "to"}
