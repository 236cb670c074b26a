r"""A formula as it is printed: letters with their marks, numbers, fractions, brackets, each with its scripts.

Nothing is interpreted here; every token is in one box.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from keyword import iskeyword
from string import ascii_letters
from typing import NoReturn

from lagrotor.paper.latex.tokens import BRACES, Token, tokenize
from lagrotor.paper.letters import FUNCTIONS as CALLED

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
    "dot": "dot", "ddot": "ddot", "dddot": "dddot", "ddddot": "ddddot", "hat": "hat", "widehat": "hat", "bar": "bar",
    "overline": "bar", "tilde": "tilde", "widetilde": "tilde", "vec": "vec", "overrightarrow": "vec", "underline": "under",
    "check": "check", "breve": "breve", "acute": "acute", "grave": "grave", "mathring": "ring", "utilde": "under",
    "overleftrightarrow": "tensor", "uvec": "hat",
}  # fmt: skip
STYLES = {
    "mathrm": "", "mathbf": "bold", "boldsymbol": "bold", "mathcal": "cal", "mathscr": "scr", "mathfrak": "frak",
    "mathbb": "bb", "mathit": "", "mathsf": "sf", "mathtt": "tt", "mathnormal": "", "symbf": "bold", "rm": "", "bf": "bold",
    "it": "", "cal": "cal", "bfseries": "bold", "text": "", "textrm": "", "mbox": "", "textbf": "bold", "operatorname": "",
    "bm": "bold", "pmb": "bold", "bold": "bold", "vb": "bold",
}  # fmt: skip
_TEXT, _SWITCHES = ("text", "textrm", "mbox"), ("rm", "bf", "it", "cal", "bfseries")
FUNCTIONS = {
    **{name: name for name in ("sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "coth", "sech", "csch", "exp")},
    **{"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh"},
    **{"arsinh": "asinh", "arcosh": "acosh", "artanh": "atanh", "asin": "asin", "acos": "acos", "atan": "atan"},
    **{"ln": "log", "log": "log", "lg": "log10", "sgn": "sign", "sign": "sign", "csch": "csch", "tg": "tan", "ctg": "cot"},
    **{"arctg": "atan", "sh": "sinh", "ch": "cosh", "th": "tanh", "cosec": "csc"},
    **{name: name for name in ("det", "tr", "Tr", "arg", "Re", "Im", "max", "min")},
}  # fmt: skip
BIG = {
    "sum": "Sum", "prod": "Product", "int": "Integral", "oint": "Integral", "iint": "Integral", "iiint": "Integral",
    "lim": "limit",
}  # fmt: skip
RELATIONS = {
    "=": "=", "<": "<", ">": ">", "approx": "~", "simeq": "~", "sim": "~", "cong": "~", "equiv": ":=", "neq": "!=", "ne": "!=",
    "le": "<=", "leq": "<=", "leqslant": "<=", "ge": ">=", "geq": ">=", "geqslant": ">=", "ll": "<<", "gg": ">>",
    "propto": "propto", "to": "->", "rightarrow": "->", "longrightarrow": "->", "mapsto": "->", "in": "in", "lesssim": "<~",
    "gtrsim": ">~", "doteq": "~", "triangleq": ":=", "coloneqq": ":=", "perp": "perp", "parallel": "parallel",
}  # fmt: skip
_ARROWS = ("Rightarrow", "implies", "iff", "Leftrightarrow", "Longrightarrow", "Longleftrightarrow", "therefore", "because",
           "forall")  # fmt: skip
_WIDE = ("quad", "qquad")
_THIN = (",", ";", ":", " ", ">", "thinspace", "medspace", "thickspace", "enspace", "enskip", "\n", "nobreakspace")
_NOTHING = (
    "!", "displaystyle", "textstyle", "scriptstyle", "limits", "nolimits", "negthinspace", "nobreak", "allowbreak", "strut",
    "null", "/", "relax", "hfill", "notag", "nonumber", "noindent", "centering", "small", "footnotesize", "qedhere",
)  # fmt: skip
_DOTS = ("dots", "ldots", "cdots", "vdots", "ddots", "dotsc", "dotsb", "dotso", "dotsm", "hdots")
_OPERATORS = {
    "+": "+", "-": "-", "−": "-", "*": "*", "/": "/", "cdot": "cdot", "times": "times", "pm": "pm", "mp": "mp", "div": "/",
    "ast": "*", "·": "cdot", "×": "times", "wedge": "wedge", "otimes": "otimes", "oplus": "oplus", "circ": "circ",
    "star": "star", "bullet": "bullet",
}  # fmt: skip
_INFIX = {r"\over": "fraction", r"\choose": "binomial"}
_SIZES = re.compile(r"[bB]igg?[lrm]?|middle")
_OPEN = {"(": ")", "[": "]", r"\{": r"\}", r"\langle": r"\rangle", r"\lfloor": r"\rfloor", r"\lceil": r"\rceil",
         r"\lvert": r"\rvert", r"\lVert": r"\rVert", r"\lbrace": r"\rbrace", r"\lbrack": r"\rbrack", "⟨": "⟩"}  # fmt: skip
_CLOSE = set(_OPEN.values())
_MATRICES = ("matrix", "pmatrix", "bmatrix", "vmatrix", "smallmatrix", "array")
ROWS = ("aligned", "split", "gathered", "alignedat", "multlined", "align", "align*", "gather", "gather*", "eqnarray*", "eqnarray",
        "equation", "equation*")  # fmt: skip
_PAIRS = ("aligned", "alignedat", "align", "align*", "split")
_CASES = ("cases", "dcases")
_MOST = 200  # brackets within brackets


class FormulaError(Exception):
    """Where the reading stops: what stands there, and what would help."""

    def __init__(self, what: str, help_: str) -> None:
        super().__init__(what)
        self.what, self.help = what, help_


@dataclass(slots=True)
class Box:
    """One thing as it is printed, from `at` to `end` in the LaTeX.

    kind: letter number operator relation bracket fraction root function big matrix cases rows accent text wide thin comma dots
    arrow bar group partial nabla infinity.  name: the letter's or the command's; style, marks: of a letter; parts: what is in
    it; sub, sup: its scripts; primes.
    """

    kind: str
    name: str
    at: int
    end: int
    parts: Sequence[list["Box"]] = ()
    style: str = ""
    marks: tuple[str, ...] = ()
    sub: "list[Box] | None" = None
    sup: "list[Box] | None" = None
    primes: int = 0
    closing: str = ""
    upright: bool = False
    spaced: bool = False


def boxes(latex: str) -> list[Box]:
    """The boxes of a formula. Raises FormulaError at a token that has no place."""
    reader = _Reader(latex)
    found = reader.sequence(())
    if reader.place < len(reader.items):
        reader.stop("is not opened", "write the bracket that it closes")
    return found


def _items(latex: str) -> list[Token]:
    """Tokens, runs of text as single characters."""
    found: list[Token] = []
    for token in tokenize(latex):
        if token.kind == "text":
            found += [Token("text", c, at) for at, c in enumerate(token.text, token.at) if not c.isspace()]
        else:
            found.append(token)
    return found


class _Reader:
    def __init__(self, latex: str) -> None:
        self.latex, self.items, self.place, self.depth = latex, _items(latex), 0, 0

    def stop(self, what: str, help_: str) -> NoReturn:
        item = self.items[min(self.place, len(self.items) - 1)]
        raise FormulaError(f"{item.text} {what}", help_)

    def peek(self) -> Token | None:
        return self.items[self.place] if self.place < len(self.items) else None

    def take(self) -> Token:
        item = self.items[self.place]
        self.place += 1
        return item

    @property
    def end(self) -> int:
        """The place behind the last token that was taken."""
        last = self.items[self.place - 1]
        return last.at + len(last.text)

    def argument(self, style: str = "") -> list[Box]:
        """What is in braces, or the next single thing."""
        item = self.peek()
        if item is None:
            self.place -= 1
            self.stop("has no argument", "write it in braces")
        if item.kind == "open":
            return self.group(style)
        if item.text.isdecimal():
            self.take()
            return [Box("number", item.text, item.at, item.at + 1)]
        return self.single(style)

    def group(self, style: str = "") -> list[Box]:
        opened = self.take()
        found = self.sequence(("}",), style)
        if self.peek() is None:
            raise FormulaError("{ is not closed", "write the brace that closes it")
        self.take()
        if len(found) == 1 and self.latex.startswith(
            tuple(_INFIX), found[0].at
        ):  # {a \over b} is printed with its braces
            found[0].at, found[0].end = opened.at, self.end
        return found

    def plain(self) -> str:
        """An argument in braces as it stands."""
        item = self.peek()
        if item is None or item.kind != "open":
            return self.take().text if item else ""
        return self.enclosed("}")

    def bracketed(self) -> str | None:
        """An optional argument as it stands."""
        item = self.peek()
        return self.enclosed("]") if item is not None and item.text == "[" else None

    def enclosed(self, closing: str) -> str:
        """What stands between the sign that comes next and the one that closes it."""
        start, depth = self.take().at + 1, 0
        while (item := self.peek()) is not None:
            self.take()
            if item.text == closing and depth == 0:
                return self.latex[start : item.at]
            depth += BRACES.get(item.kind, 0)
        return self.latex[start:]

    def sequence(self, ends: tuple[str, ...], style: str = "") -> list[Box]:
        """Boxes until one of the ends comes next."""
        self.depth += 1
        if self.depth > _MOST:
            self.stop("is too deep", "write fewer brackets within brackets")
        found: list[Box] = []
        while (item := self.peek()) is not None and item.text not in ends:
            if (made := _alone(item, style)) is not None:
                self.place += 1
                found.append(made)
                continue
            if item.kind == "close" or item.text == r"\right" or (item.text in _CLOSE and item.text not in "]"):
                break
            if item.kind == "command" and item.text[1:] in _SWITCHES:
                self.take()
                style = STYLES[item.text[1:]] or "upright"
                continue
            if item.text in _INFIX:
                self.take()
                under = self.sequence(ends, style)
                self.depth -= 1
                return [Box(_INFIX[item.text], "", item.at, self.end, [_without_spaces(found), under])]
            if item.kind == "script":
                self.script(found)
            elif item.text in ("'", "’", "′"):
                self.take()
                self.prime(found, item)
            elif self.latex.startswith("{,}", item.at) and found and found[-1].kind == "number":
                self.comma_in_number(found)
            else:
                self.extend(found, style)
        self.depth -= 1
        return _without_spaces(found)

    def extend(self, found: list[Box], style: str) -> None:
        first = self.peek()
        braced = first is not None and first.kind == "open"
        made = self.single(style)
        before = found[-1] if found else None
        if before is not None and len(made) == 1 and before.end == made[0].at and _joins(before, made[0], style):
            before.name += made[0].name
            before.end = made[0].end
            return
        following = self.peek()
        if following is not None and following.kind == "script" and made:
            own = any(box.sub is not None or box.sup is not None or box.primes for box in made)
            if len(made) > 1 or (braced and own):
                made = [Box("group", "", made[0].at, self.end, [made])]
        found += made

    def comma_in_number(self, found: list[Box]) -> None:
        self.place += 3
        found[-1].name += "{,}"
        found[-1].end = self.end
        item = self.peek()
        if item is None or not item.text.isdecimal():
            self.place -= 1
            self.stop("is no part of a number", "write digits behind the comma")
        while (item := self.peek()) is not None and item.text.isdecimal():
            found[-1].name += self.take().text
            found[-1].end = self.end

    def prime(self, found: list[Box], item: Token) -> None:
        if not found:
            raise FormulaError("' has nothing before it", "write the letter that it belongs to")
        self.primed(found[-1], item, 1)
        found[-1].end = item.at + 1

    @staticmethod
    def primed(target: Box, item: Token, count: int) -> None:
        """Give primes to a letter; behind anything else they are not read."""
        if target.kind != "letter":
            raise FormulaError("' stands behind a sign that is no letter", "write the derivative, or give it a letter")
        target.primes += count

    def script(self, found: list[Box]) -> None:
        item = self.take()
        target = found[-1] if found else None
        if target is None or target.kind in ("operator", "relation", "comma", "wide", "text", "thin", "arrow", "unit"):
            raise FormulaError(f"{item.text} has nothing before it", "write the letter that the script belongs to")
        content = self.argument()
        if item.text == "^":
            if content and all(b.kind == "letter" and b.name == "prime" for b in content):
                self.primed(target, item, len(content))
            elif target.sup is not None:
                raise FormulaError("two powers follow each other", "write braces around the first")
            else:
                target.sup = content
        elif target.sub is not None:
            raise FormulaError("two indices follow each other", "write them in one pair of braces")
        else:
            target.sub = content
        target.end = self.end

    def single(self, style: str) -> list[Box]:
        """The next thing without its scripts; a group in braces gives all it holds."""
        item = self.take()
        text = item.text
        if (made := _alone(item, style) or _letter(item, style)) is not None:
            return [made]
        if item.kind == "open":
            self.place -= 1
            return self.group(style)
        if text in ("|", r"\vert"):
            return [Box("bar", "|", item.at, self.end)]
        if item.kind == "command":
            return self.command(item, style)
        if item.kind == "align":
            return []
        if item.kind in ("math", "param", "stray", "raw"):
            self.place -= 1
            self.stop("cannot stand in a formula", "leave it out")
        if text == "." and (after := self.peek()) is not None and after.text == ".":
            while (after := self.peek()) is not None and after.text == ".":
                self.take()
            return [Box("dots", "dots", item.at, self.end)]
        if text.isdecimal() or (text == "." and (after := self.peek()) is not None and after.text.isdecimal()):
            return [self.number(item)]
        if text in _OPEN:
            return [self.bracket(text, item, style)]
        if text == ":" and (after := self.peek()) is not None and after.text == "=":
            self.take()
            return [Box("relation", ":=", item.at, self.end)]
        if text in _BESIDE:
            return [Box(*_BESIDE[text], item.at, self.end)]
        self.place -= 1
        self.stop("is not known", "write it in LaTeX")

    def number(self, item: Token) -> Box:
        digits = item.text
        while (after := self.peek()) is not None:
            further = self.items[self.place + 1] if self.place + 1 < len(self.items) else None
            point = after.text == "." and "." not in digits and further is not None and further.text.isdecimal()
            if point or (after.text.isdecimal() and after.at == self.end):
                digits += self.take().text
            else:
                break
        return Box("number", digits, item.at, self.end)

    def command(self, item: Token, style: str) -> list[Box]:
        name = item.text[1:]
        if name in _NOTHING:
            return []
        if name in ACCENTS:
            return [self.accent(name, item, style)]
        if name in RELATIONS:
            return [Box("relation", RELATIONS[name], item.at, self.end)]
        if item.text in _OPEN:
            return [self.bracket(item.text, item, style)]
        if name == "left" or _SIZES.fullmatch(name):
            return self.sized(item, name, style)
        if (special := _FORMS.get(name.rstrip("*"))) is not None:
            return special(self, item, style)
        if name in STYLES:
            return self.styled(name, item)
        self.place -= 1
        self.stop("is not known", "write what it stands for, or define it by \\newcommand")

    def accent(self, name: str, item: Token, style: str) -> Box:
        content = self.argument(style)
        mark = ACCENTS[name]
        if len(content) == 1 and content[0].kind == "nabla" and mark == "vec":
            return content[0]
        if len(content) == 1 and content[0].kind == "letter" and content[0].sup is None and not content[0].primes:
            box = content[0]
            box.marks += (mark,)
            box.at, box.end = item.at, self.end
            return box
        return Box("accent", mark, item.at, self.end, [content])

    def styled(self, name: str, item: Token) -> list[Box]:
        r"""\mathbf{r}, \mathrm{kin}, \text{and}: letters one by one, or a word."""
        style = STYLES[name]
        if name == "operatorname" and (after := self.peek()) is not None and after.text == "*":
            self.take()
        word = self.plain_ahead() if name in (*_TEXT, "mathrm", "operatorname", "mathit", "mathsf", "mathtt") else None
        if word is not None:
            stripped = word.strip()
            if name == "operatorname" or (len(stripped) > 1 and stripped in FUNCTIONS):
                self.plain()
                return [Box("function", stripped, item.at, self.end)]
            if name in _TEXT and stripped != "d":
                self.plain()
                return [Box("text" if stripped else "thin", stripped, item.at, self.end)]
            if re.fullmatch(r"[A-Za-z]{2,}", stripped):
                self.plain()
                if stripped[0] == "d" and len(stripped) == 2 and name == "mathrm":
                    d = Box("letter", "d", item.at, item.at + 1, upright=True)
                    return [d, Box("letter", stripped[1], item.at + 1, self.end)]
                return [Box("letter", stripped, item.at, self.end, upright=True)]
            if name == "mathrm" and _UNIT.fullmatch(stripped):
                self.plain()
                return [Box("unit", stripped, item.at, self.end)]
        content = self.argument(style or "upright")
        for box in content:
            if box.kind == "letter" and style:
                box.style = style
            elif box.kind == "letter":
                box.upright = True
            elif box.kind == "number" and style and box.name != "0":
                raise FormulaError(f"{item.text}{{{box.name}}} is not read", "give the unit matrix a letter")
        return content

    def plain_ahead(self) -> str | None:
        """The argument in braces that comes next, as it stands, without taking it."""
        place = self.place
        item = self.peek()
        if item is None or item.kind != "open":
            return None
        word = self.plain()
        self.place = place
        return word

    def sized(self, item: Token, name: str, style: str) -> list[Box]:
        r"""\left( … \right), \bigl(, \middle|."""
        after = self.peek()
        if after is None:
            self.place -= 1
            self.stop("has no bracket", "write one")
        if name != "left":
            if after.text in ("|", r"\|", r"\vert", r"\Vert"):
                self.take()
                double = after.text in (r"\|", r"\Vert")
                return [Box("bar", "||" if double else "|", item.at, self.end)]
            return []  # a bracket of another size: the bracket comes next
        opening = self.take().text
        parts: list[list[Box]] = [self.sequence((r"\right",), style)]
        if self.peek() is None:
            raise FormulaError(r"\left is not closed", r"write \right with its bracket")
        self.take()
        if self.peek() is None:
            raise FormulaError(r"\right has no bracket", "write one, or a full stop")
        closing = self.take().text
        return [Box("bracket", opening, item.at, self.end, parts, closing=closing)]

    def bracket(self, opening: str, item: Token, style: str = "") -> Box:
        closing = _OPEN[opening]
        content = self.sequence((closing,), style)
        after = self.peek()
        if after is not None and after.text.startswith("\\") and _SIZES.fullmatch(after.text[1:]):
            self.take()
            after = self.peek()
        if after is None or after.text != closing:
            raise FormulaError(f"{opening} is not closed by {closing}", f"write {closing} where it ends")
        self.take()
        return Box("bracket", opening, item.at, self.end, [content], closing=closing)

    # ---- commands with a form of their own

    def _frac(self, item: Token, style: str) -> list[Box]:
        style = "" if style == "upright" else style
        over, under = self.argument(style), self.argument(style)
        kind = "binomial" if item.text.endswith("binom") else "fraction"
        return [Box(kind, "", item.at, self.end, [over, under])]

    def _derivative(self, item: Token, style: str) -> list[Box]:
        r"""\dv[2]{x}{t}, \pdv{L}{q} and \dv{t} as fractions."""
        degree, parts = self.bracketed(), [self.argument(style)]
        if (after := self.peek()) is not None and after.kind == "open":
            parts.append(self.argument(style))
        under, order = parts[-1], boxes(degree) if degree else None
        if len(under) != 1 or under[0].sup is not None:
            raise FormulaError(f"{item.text} is by more than a letter", r"write \frac{d f}{d x}")
        kind, name = ("letter", "d") if item.text == r"\dv" else ("partial", "partial")
        marks = [Box(kind, name, item.at, self.end, upright=True, sup=sup) for sup in (order, None)]
        rows = [[marks[0], *(parts[0] if len(parts) > 1 else [])], [marks[1], replace(under[0], sup=order)]]
        return [Box("fraction", "", item.at, self.end, rows)]

    def _enclosed(self, item: Token, style: str) -> list[Box]:
        r"""\abs{x} and \norm{x}."""
        sign = "|" if item.text == r"\abs" else r"\|"
        return [Box("bracket", sign, item.at, self.end, [self.argument(style)], closing=sign)]

    def _differential(self, item: Token, style: str) -> list[Box]:
        return [Box("letter", "d", item.at, item.at + 1, upright=True)]

    def _sqrt(self, item: Token, style: str) -> list[Box]:
        degree = self.bracketed()
        content = self.argument("" if style == "upright" else style)
        parts = [content] + ([boxes(degree)] if degree else [])
        return [Box("root", "", item.at, self.end, parts)]

    def _begin(self, item: Token, style: str) -> list[Box]:
        name = self.plain()
        if name not in (*_MATRICES, *ROWS, *_CASES):
            raise FormulaError(rf"\begin{{{name}}} is not known", "write the formula without this environment")
        self.bracketed()
        if name in ("array", "alignedat") and "|" in self.plain():
            raise FormulaError("a line stands in the matrix", "write its blocks by themselves")
        kind = "cases" if name in _CASES else "rows" if name in ROWS else "matrix"
        rows = self.rows(name, item)
        return [Box(kind, name, item.at, self.end, [[Box("row", "", item.at, self.end, row) for row in rows]])]

    def rows(self, name: str, item: Token) -> list[list[list[Box]]]:
        """Rows of cells until the environment ends."""
        rows: list[list[list[Box]]] = [[[]]]
        while True:
            rows[-1][-1] += self.sequence(("&", r"\\", r"\end", r"\hline", r"\cr"))
            after = self.peek()
            if after is None or after.text not in ("&", r"\\", r"\end", r"\hline", r"\cr"):
                raise FormulaError(rf"\begin{{{name}}} is not closed", rf"write \end{{{name}}}")
            self.take()
            if after.text == "&":
                if name in _PAIRS and len(rows[-1]) % 2 == 0:  # every second & begins another equation
                    rows[-1][-1].append(Box("wide", "", after.at, after.at + 1))
                rows[-1].append([])
            elif after.text in (r"\\", r"\cr"):
                self.bracketed()
                rows.append([[]])
            elif after.text == r"\end":
                self.plain()
                return [row for row in rows if any(row)]

    def _underbrace(self, item: Token, style: str) -> list[Box]:
        content = self.argument(style)
        after = self.peek()
        if after is not None and after.kind == "script":
            self.take()
            self.plain() if (following := self.peek()) is not None and following.kind == "open" else self.take()
        if content and content[0].kind == "operator":  # the sign joins it to what stands before
            return content
        return [Box("group", "", item.at, self.end, [content])]

    def _passed_over(self, item: Token, style: str) -> list[Box]:
        self.plain()
        return [Box("thin", "", item.at, self.end)] if item.text == r"\hspace" else []

    def _line_end(self, item: Token, style: str) -> list[Box]:
        """A line of a display that has one line only: TeX passes over it."""
        self.bracketed()
        return [Box("wide", "", item.at, self.end)]


def _without_spaces(row: list[Box]) -> list[Box]:
    """Return a row without its thin spaces, each of which is said of the box behind it."""
    for before, box in pairwise(row):
        box.spaced |= before.kind == "thin"
    return [box for box in row if box.kind != "thin"]


def _joins(before: Box, made: Box, style: str) -> bool:
    """Whether an upright letter goes on with the word before it."""
    letters = before.kind == made.kind == "letter" and before.upright and made.upright and len(made.name) == 1
    return style == "upright" and letters and before.sub is None and before.sup is None and not before.marks


def is_printed_as_vector(box: Box) -> bool:
    """Whether a letter is printed as a vector: bold or with an arrow."""
    return box.style == "bold" or "vec" in box.marks or "under" in box.marks


def _alone(item: Token, style: str) -> Box | None:
    """The box that a token is whatever stands beside it; None where others may belong to it."""
    text = item.text
    if (sign := _SIGNS.get(text)) is not None:
        return Box(*sign, item.at, item.at + len(text))
    return None if style == "upright" and len(text) == 1 else _letter(item, style)


def _letter(item: Token, style: str) -> Box | None:
    """The letter that a token is; None where it is none."""
    name = _LETTERS.get(item.text)
    if name is None:
        return None
    end, upright = item.at + len(item.text), style == "upright"
    return Box("letter", name, item.at, end, style="" if upright else style, upright=upright)


_SIMPLE = {"partial": "partial", "nabla": "nabla", "infty": "infinity", "%": "percent", "degree": "degree"}
# A unit of several parts, m/s^2.
_UNIT = re.compile(r"(?=.*[A-Za-z].*[A-Za-z/^]|%)[A-Za-z\d\s/^{}.\-~·%]+")

# Characters and commands that are a letter, with its name; those that are another box whatever stands beside them: (kind, name).
_LETTERS = {letter: letter for letter in ascii_letters} | _UNICODE
_LETTERS |= {command: re.sub(r"var(?=[A-Z])", "", command[1:]) for command in GREEK}  # \varDelta is an italic \Delta
_LETTERS |= {rf"\{name}": name for name in ("prime", "dagger", "top", "intercal")}
_UPRIGHT_GREEK = ("Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Phi", "Psi", "Omega")
_COMMANDS: dict[str, tuple[str, str]] = {
    **dict.fromkeys(_WIDE, ("wide", "")),
    **dict.fromkeys(_THIN, ("thin", "")),
    **{name: ("operator", sign) for name, sign in _OPERATORS.items() if name.isalpha()},
    **{name: ("arrow", name) for name in _ARROWS},
    **{name: ("dots", name) for name in _DOTS},
    **{name: ("big", name) for name in BIG},
    **{name: ("function", name) for name in FUNCTIONS},
    **{name: (kind, name) for name, kind in _SIMPLE.items()},
    **{"|": ("bar", "||"), "Vert": ("bar", "||"), "dag": ("letter", "dagger")},
    **{f"Up{name.lower()}": ("letter", name) for name in _UPRIGHT_GREEK},
}
_SIGNS: dict[str, tuple[str, str]] = {
    **{text: ("operator", name) for text, name in _OPERATORS.items() if len(text) == 1},
    **{text: ("relation", name) for text, name in RELATIONS.items() if not text.isalpha()},
    **{",": ("comma", ","), ";": ("comma", ";"), "!": ("operator", "!"), "~": ("thin", "")},
    **{"∂": ("partial", ""), "∇": ("nabla", ""), "∞": ("infinity", "")},
    **{rf"\{name}": sign for name, sign in _COMMANDS.items()},
}
_BESIDE = {":": ("operator", ":"), ".": ("comma", ".")}  # what they are depends on what follows
Form = Callable[[_Reader, Token, str], list[Box]]
_FORMS: dict[str, Form] = {
    **dict.fromkeys(
        ("frac", "dfrac", "tfrac", "cfrac", "sfrac", "nicefrac", "binom", "dbinom", "tbinom"), _Reader._frac
    ),
    "sqrt": _Reader._sqrt,
    "begin": _Reader._begin,
    **dict.fromkeys(("dv", "pdv"), _Reader._derivative),
    **dict.fromkeys(("abs", "norm"), _Reader._enclosed),
    "dd": _Reader._differential,
    **dict.fromkeys(("underbrace", "overbrace"), _Reader._underbrace),
    **dict.fromkeys(("label", "cite", "vspace", "tag", "hspace"), _Reader._passed_over),
    "\\": _Reader._line_end,
}


# ---- rows of boxes


def strip(row: list[Box]) -> list[Box]:
    """Return a row without spaces and punctuation at its ends."""
    start, end = 0, len(row)
    while start < end and row[start].kind == "wide":
        start += 1
    while end > start and row[end - 1].kind in ("wide", "comma"):
        end -= 1
    return row[start:end]


def parted(row: list[Box], *kinds: str) -> list[list[Box]]:
    """Return the parts of a row between the boxes of these kinds; a full stop parts nothing."""
    ends = [-1, *(k for k, box in enumerate(row) if box.kind in kinds and box.name != "."), len(row)]
    return [row[first + 1 : last] for first, last in pairwise(ends)]


def all_boxes(row: Iterable[Box]) -> Iterator[Box]:
    """Yield the boxes of a row and all that they hold."""
    for box in row:
        yield box
        for held in (*box.parts, box.sub or (), box.sup or ()):
            yield from all_boxes(held)


def is_mark(box: Box, mark: str) -> bool:
    """Whether a box is the d or the ∂ of a derivative."""
    if mark == "partial":
        return box.kind == "partial" and box.sub is None
    return box.kind == "letter" and box.name == mark and not (box.marks or box.sub or box.primes or box.style)


def is_derivative(box: Box) -> str:
    """Return d or partial where a fraction is a derivative; nothing where it is none."""
    if box.kind == "fraction":
        over, under = box.parts
        for mark in ("d", "partial"):
            if (
                over
                and len(under) > 1
                and is_mark(over[0], mark)
                and is_mark(under[0], mark)
                and under[1].kind == "letter"
            ):
                return mark
    return ""


# ---- names of letters


def stem_of(box: Box) -> str:
    """Return the name of a letter with its font and marks, without index, dots and primes."""
    return {"lambda": "lamda"}.get(box.name, box.name) + box.style + "".join(_marks(box))


def _marks(box: Box) -> list[str]:
    return sorted((mark for mark in box.marks if not mark.endswith("dot")), key=lambda mark: mark != "vec")


def name_of(box: Box, index: Iterable[str] = (), raised: Iterable[str] = ()) -> str:
    r"""Return the name of a letter in Python: theta_1_dot for \dot\theta_1, rvec_1 for \vec r_1, T__max for T^{\max}."""
    rates = sum(len(mark) - len("ot") for mark in box.marks if mark.endswith("dot"))
    name = stem_of(box) + "prime" * box.primes + "".join(f"__{part}" for part in raised)
    name += "".join(f"_{part}" for part in index) + (f"_{'d' * rates}ot" if rates else "")
    taken = name in CALLED or iskeyword(name) or (name == "hbar" and box.name == "h")  # a mean h is no ħ
    return f"{name}_" if taken else name


def index_of(box: Box) -> list[str]:
    """Return the parts of an index, such as ["1"], ["cm"] or ["i", "j"]. Raises FormulaError for other signs in it."""
    found: list[str] = []
    alone = True  # a comma or a Greek letter ends a run of letters
    for part in box.sub or ():
        if part.kind == "comma" and part.name != ".":
            alone = True
            continue
        inner = _index(part)
        greek = part.kind == "letter" and len(part.name) > 1 and not part.upright
        if alone or greek or len(inner) != 1 or not found:
            found += inner
        else:
            found[-1] += inner[0]
        alone = greek
    return found


def _index(part: Box) -> list[str]:
    """Return the words of one box of an index."""
    if part.kind == "letter" and part.sup is None:
        return [part.name + part.style + "prime" * part.primes + "".join(part.marks), *index_of(part)]
    plain = part.sup is None and part.sub is None
    if part.kind == "number" and plain and "," not in part.name:
        return [part.name.replace(".", "p")]
    name = "".join(c for c in part.name if c.isalnum())
    if part.kind in ("text", "function") and plain and 0 < len(name) <= 24 and "\\" not in part.name:
        return [name]
    if part.kind in ("operator", "infinity", "relation") and part.name in _INDEX_SIGNS:
        return [_INDEX_SIGNS[part.name]]
    if part.kind in ("group", "fraction") and plain:  # i + 1/2
        return ["over".join("".join(word for each in held for word in _index(each)) for held in part.parts)]
    raise FormulaError("an index is not letters and numbers", "give the letter another index")


_INDEX_SIGNS = {"+": "plus", "-": "minus", "*": "star", "/": "over", "infty": "inf", "=": "eq", "->": "to"}
