"""What a derivation shows: formulas, remarks, steps decided by `prove(left, right, "in words")`, and results as forms.

`prove` displays both sides, or raises ProofError. A `Form` is a result as a physicist writes it: one text in vectors and sums
gives both its LaTeX and its components.
"""

import inspect
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import agreement_order, decide_equal
from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError, ProofError
from lagrotor.mechanics.glossary import latex, light
from lagrotor.paper.grammar import Letters, parsed, read


@dataclass(frozen=True)
class Formula:
    """An expression, a matrix or an equation, shown as mathematics; `name` is LaTeX for what it is equal to."""

    expression: Any
    name: str = ""

    @property
    def tex(self) -> str:
        """The formula as LaTeX."""
        left = f"{self.name} = " if self.name else ""
        return left + latex(self.expression)

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.tex}$"


def left_out(small: sp.Symbol, order: int) -> str:
    """+ O(small**(order + 1)), in LaTeX."""
    return rf" + O\left({latex(small ** (order + 1))}\right)"


@dataclass(frozen=True)
class Remark:
    """Something that a derivation found besides the judged equations: a heading and what was found, with its numbers."""

    title: str
    text: str

    def _repr_markdown_(self) -> str:
        return f"**{self.title}.** {self.text}"


# Characters of LaTeX beyond which a side cannot be read: it is to be named, or the equation written in vectors.
_LONGEST = 240


@dataclass(frozen=True)
class Step:
    """Equations that were decided. pairs: (left, right). names: LaTeX of the left sides. written: LaTeX of the equations,
    where vectors read better than the components that were compared. domain: factors that must not vanish. order: of a
    series in `small`."""

    pairs: tuple[tuple[Any, Any], ...]
    says: str
    domain: tuple[sp.Expr, ...]
    names: tuple[str, ...] = ()
    small: sp.Symbol | None = None
    order: int | None = None
    written: tuple[str, ...] = ()

    @property
    def tex(self) -> str:
        """The equations below each other, as LaTeX."""
        end = left_out(self.small, self.order or 0) if self.small is not None else ""
        lines = [f"{line}{end}" for line in self.written] or [
            f"{name} &= {latex(right)}{end}" for name, (_, right) in zip(self.names, self.pairs, strict=True)
        ]
        guarded = ["{}" * line.startswith("[") + line for line in lines]  # after \\ and \begin a bracket is an option
        return r"\begin{aligned} " + r" \\ ".join(guarded) + r" \end{aligned}"

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.tex}$"


def prove(
    left: Any,
    right: Any,
    says: str = "",
    small: sp.Symbol | None = None,
    order: int | None = None,
    names: str | Sequence[str] = (),
    written: str | Sequence[str] = (),
) -> Step:
    """Decide left = right exactly, or through small**order; for rows of expressions and matrices entry by entry.

    Parameters
    ----------
    says : str, default ''
        What is decided, in words.
    names : str or Sequence[str], default ()
        LaTeX shown for the left sides.
    written : str or Sequence[str], default ()
        LaTeX shown for the whole equations, in vectors and sums where what is compared are components.

    Raises
    ------
    ProofError
        With the difference where it does not hold or is not decided, and where a left side is too long to be read and
        neither named nor written.
    """
    pairs = _pairs(left, right)
    check_names(f"prove: {says or 'this step'}", pairs, small)
    named, shown = ((given,) if isinstance(given, str) else tuple(given) for given in (names, written))
    for given, what in ((named, "names"), (shown, "equations are written")):
        if given and len(given) != len(pairs):
            raise ProofError(f"prove: {len(given)} {what} for {len(pairs)} equations")
    if not (named or shown):
        named = tuple(latex(left) for left, _ in pairs)
        if any(len(name) > _LONGEST for name in named):
            raise ProofError(
                f"prove: {says or 'this step'}: a left side is too long to be read; give `names` or `written`"
            )
    domain: dict[sp.Expr, None] = {}
    for a, b in pairs:
        if small is not None:
            _through(a, b, small, order or 0, says)
            continue
        decision = decide_equal(a, b)
        if decision.answer != "zero":
            raise ProofError(f"prove: {says or 'this step'} is {decision.answer}: {a} against {b}: {decision.reason}")
        domain |= dict.fromkeys(f for f in decision.domain if not (f.is_positive or f.is_number))
    return Step(pairs, says, tuple(domain), named, small, order, shown)


def _pairs(left: Any, right: Any) -> tuple[tuple[Any, Any], ...]:
    if isinstance(left, sp.Equality) and not isinstance(right, Sequence):
        raise ProofError("prove: give the two sides, not an equation")
    if isinstance(left, Sequence) or isinstance(right, Sequence):
        rows = list(left), list(right)
        if len(rows[0]) != len(rows[1]):
            raise ProofError(f"prove: {len(rows[0])} left sides and {len(rows[1])} right sides")
        return tuple((sp.sympify(a, strict=True), sp.sympify(b, strict=True)) for a, b in zip(*rows, strict=True))
    return ((sp.sympify(left, strict=True), sp.sympify(right, strict=True)),)


def _through(a: Any, b: Any, small: sp.Symbol, order: int, says: str) -> None:
    entries = zip(a, b, strict=True) if isinstance(a, sp.MatrixBase) else [(a, b)]
    for p, q in entries:
        first = agreement_order(p, q, small, order)
        if first.order is not None:
            raise ProofError(
                f"prove: {says or 'this step'} fails at order {first.order} in {small}, by {first.coefficient}: {p} against {q}"
            )


# How many particles or bodies a sum runs over where the derivation does not say.
_MANY = 3
_CONSTANTS = ("pi", "sqrt", "sin", "cos", "tan", "exp", "Integer", "Rational", "Float")


@dataclass(frozen=True)
class Form:
    """`text` in the letters of a section and `letters`, whose values are components; `tex` and `value` are read off it.

    Besides what a printed line may call, cross(u, v), dot(u, v) …: transpose(A), and sum_i(…), the sum over
    i = 1 … `many`, in which X_i is X_1, X_2, …. tex: names → LaTeX where the letter alone does not say it, such as
    {"n": r"\\hat\\Omega"}. series: the power of what is small from which on terms are left out, in LaTeX.
    """

    text: str
    letters: Mapping[str, Any]
    names: Mapping[str, str]
    many: int = _MANY
    rest: str = ""

    def value(self, section: Letters) -> Any:
        """The components, with the section's letters. Raises InputError where the text cannot be read."""
        calls = {"transpose": lambda A: A.T}
        return read(_expanded(self.text, self.many), {**section.names, **calls, **self.letters}, "form")

    def tex(self, section: Letters) -> str:
        """The text as LaTeX: vectors with arrows, sums as sums, in the order in which it is written."""
        known, written = {**section.names, **self.letters}, {**section.latex, **self.names}
        own = {name for name, value in known.items() if name in written and inspect.isfunction(value)}
        local: dict[str, Any] = _CALLS | {name: _named_function(name, written[name]) for name in own}
        symbols: dict[sp.Symbol, str] = {}
        for name in set(re.findall(r"[A-Za-z_]\w*", self.text)) - set(local) - set(_CONSTANTS):
            kind = known.get(name, known.get(re.sub(r"_i(?=_|$)", "_1", name)))
            local[name] = sp.Symbol(name, commutative=not isinstance(kind, sp.MatrixBase))
            symbols[local[name]] = written.get(name) or _name(name, kind)
        constants = {name: getattr(sp, name) for name in _CONSTANTS}
        made = parsed(self.text, constants | local, "form", as_written=True)
        shown = light(sp.latex(made, symbol_names=symbols, order="none", long_frac_ratio=2))
        return shown + (f" + O({self.rest})" if self.rest else "")


def form(text: str, names: Mapping[str, str] | None = None, many: int = _MANY, rest: str = "", **letters: Any) -> Form:
    """A `Form`: `letters` are the components of those that the section does not have."""
    return Form(text, letters, names or {}, many, rest)


def _expanded(text: str, many: int) -> str:
    """Each sum_i(…) written out."""
    while (start := text.find("sum_i(")) >= 0:
        depth, end = 1, start + len("sum_i(")
        while depth:
            if end == len(text):
                raise InputError(f"form: {text!r}: a bracket is not closed")
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        inside = text[start + len("sum_i(") : end - 1]
        terms = (re.sub(r"(?<=\w_)i(?=_|\b)", str(n), inside) for n in range(1, many + 1))
        text = f"{text[:start]}({' + '.join(f'({term})' for term in terms)}){text[end:]}"
    return text


def _name(name: str, kind: Any) -> str:
    """The LaTeX of a letter: an arrow on a vector, a hat on hat_r, a dot on r_dot."""
    if isinstance(kind, sp.Symbol) and kind.name == name and not name.startswith("Delta_"):
        return latex(kind)
    if name.startswith("Delta_"):
        return rf"\Delta {name[6:]}"
    stem, hat = (name[4:], True) if name.startswith("hat_") else (name, False)
    parts = re.fullmatch(r"([A-Za-z]+)((?:_[A-Za-z0-9]+)*?)(_d?dot)?", stem)
    if parts is None:
        raise InputError(f"form: {name!r} is not a letter with an index")
    letter = sp.latex(sp.Symbol(parts[1]))
    if hat or (isinstance(kind, sp.MatrixBase) and kind.shape == (3, 1)):
        letter = rf"\{'hat' if hat else 'vec'}{{{letter}}}"
    letter = rf"\{parts[3][1:]}{{{letter}}}" if parts[3] else letter
    return letter + (f"_{{{parts[2][1:].replace('_', ',')}}}" if parts[2] else "")


def _bracketed(printer: Any, part: Any) -> str:
    written: str = printer._print(part)
    loose = isinstance(part, sp.Add | _Cross) or part.could_extract_minus_sign()
    return rf"\left({written}\right)" if loose else written


class _Cross(sp.Function):  # type: ignore[misc]
    """u × v, as it is written."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        u, v = (_bracketed(printer, part) for part in self.args)
        return rf"{u}\times {v}"


class _Dot(sp.Function):  # type: ignore[misc]
    """u · v; the square of a vector where both are one."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        u, v = (_bracketed(printer, part) for part in self.args)
        return rf"{u}^{{2}}" if u == v else rf"{u}\cdot {v}"


class _Norm(sp.Function):  # type: ignore[misc]
    """|u|."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        return rf"\left\|{printer._print(self.args[0])}\right\|" + (f"^{{{exp}}}" if exp else "")


def _named_function(name: str, tex: str) -> Any:
    """A function whose values are written as one letter, such as the unit vector of an axis."""
    return type(name, (sp.Function,), {"_latex": lambda self, printer, exp=None: tex})


class _Transpose(sp.Function):  # type: ignore[misc]
    """A transposed."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        return rf"{_bracketed(printer, self.args[0])}^{{T}}"


class _Column(sp.Function):  # type: ignore[misc]
    """A vector of components."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        return rf"\left({', '.join(map(printer._print, self.args))}\right)"


class _Sum(sp.Function):  # type: ignore[misc]
    """Σ over i."""

    def _latex(self, printer: Any, exp: Any = None) -> str:
        inside = self.args[0]
        written = printer._print(inside)
        return rf"\sum_i \left({written}\right)" if isinstance(inside, sp.Add) else rf"\sum_i {written}"


_CALLS: dict[str, Any] = {
    "cross": _Cross,
    "dot": _Dot,
    "norm": _Norm,
    "transpose": _Transpose,
    "column": _Column,
    "sum_i": _Sum,
}
