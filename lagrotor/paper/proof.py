"""The elements of a derivation: formulas, remarks, steps decided by `prove(lhs, rhs, "in words")`, and results as forms.

A `Form` is a result as a physicist writes it: one text in vectors and sums gives both the LaTeX and the components.
"""

import inspect
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from lagrotor.algebra import agreement_order, decide_equal
from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError, ProofError
from lagrotor.mechanics.glossary import latex, light
from lagrotor.paper.grammar import Letters, parsed, read
from lagrotor.renamed import accept_old_keywords, old_attribute


@dataclass(frozen=True)
class Formula:
    r"""An expression, a matrix or an equation that a derivation shows.

    Attributes
    ----------
    expression : Any
        A sympy object.
    name : str, default ''
        LaTeX of the left side, the quantity to which the expression is equal.

    Examples
    --------
    >>> from sympy import symbols
    >>> G, J = symbols("G J")
    >>> Formula(G / J, r"\Omega").tex
    '\\Omega = \\frac{G}{J}'
    """

    expression: Any
    name: str = ""

    @property
    def tex(self) -> str:
        """The formula as LaTeX."""
        prefix = f"{self.name} = " if self.name else ""
        return prefix + latex(self.expression)

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.tex}$"


def left_out(small: sp.Symbol, order: int) -> str:
    """Return the LaTeX of the omitted terms of a series, + O(small**(order + 1))."""
    return rf" + O\left({latex(small ** (order + 1))}\right)"


@dataclass(frozen=True)
class Remark:
    """A result that a derivation states in words, besides the equations that are judged.

    Attributes
    ----------
    title : str
        Heading of the remark.
    text : str
        The result in sentences, with its numbers.
    """

    title: str
    text: str

    def _repr_markdown_(self) -> str:
        return f"**{self.title}.** {self.text}"


# Characters of LaTeX; a longer side cannot be read, so it needs a name or an equation in vectors.
_LONGEST = 240


@dataclass(frozen=True)
class Step:
    """One step of a derivation: equations that `prove` has decided to hold.

    Attributes
    ----------
    pairs : tuple[tuple[Any, Any], ...]
        The left and the right side of each equation.
    says : str
        The step in words.
    domain : tuple[Expr, ...]
        Factors that the proof divides by, so that they must not vanish.
    names : tuple[str, ...], default ()
        LaTeX of the left sides.
    small : Symbol or None, optional
        The variable of the series, if the sides agree through an order only.
    order : int or None, optional
        The order in `small` through which the sides agree.
    equations : tuple[str, ...], default ()
        LaTeX of whole equations, shown instead of the compared components.
    """

    pairs: tuple[tuple[Any, Any], ...]
    says: str
    domain: tuple[sp.Expr, ...]
    names: tuple[str, ...] = ()
    small: sp.Symbol | None = None
    order: int | None = None
    equations: tuple[str, ...] = ()

    if not TYPE_CHECKING:
        __getattr__ = old_attribute

    @property
    def tex(self) -> str:
        """The equations in LaTeX, one below the other."""
        end = left_out(self.small, self.order or 0) if self.small is not None else ""
        lines = [f"{line}{end}" for line in self.equations] or [
            f"{name} &= {latex(right)}{end}" for name, (_, right) in zip(self.names, self.pairs, strict=True)
        ]
        # LaTeX reads a bracket after \\ and \begin as an option.
        guarded = ["{}" * line.startswith("[") + line for line in lines]
        return r"\begin{aligned} " + r" \\ ".join(guarded) + r" \end{aligned}"

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.tex}$"


@accept_old_keywords
def prove(
    lhs: Any,
    rhs: Any,
    says: str = "",
    small: sp.Symbol | None = None,
    order: int | None = None,
    names: str | Sequence[str] = (),
    equations: str | Sequence[str] = (),
) -> Step:
    r"""Decide whether lhs = rhs, exactly or through small**order. Matrices and sequences are compared entry by entry.

    Parameters
    ----------
    lhs : Any
        A sympy expression or matrix, or a sequence of these.
    rhs : Any
        The same number of expressions.
    says : str, default ''
        The step in words.
    small : Symbol or None, optional
        The variable of the series, if the sides are compared as series; without it they are compared exactly.
    order : int or None, optional
        The order in `small` through which the sides are compared.
    names : str or Sequence[str], default ()
        LaTeX shown for the left sides.
    equations : str or Sequence[str], default ()
        LaTeX shown for whole equations, for instance in vectors where components are compared.

    Returns
    -------
    Step
        The decided equations, which the derivation displays as mathematics.

    Raises
    ------
    ProofError
        If a difference is not zero or cannot be decided, or if a left side is too long and has no name.

    Examples
    --------
    >>> from sympy import cos, sin, symbols
    >>> x = symbols("x", real=True)
    >>> prove(sin(x) ** 2, 1 - cos(x) ** 2, "Pythagoras").tex
    '\\begin{aligned} \\sin^{2} x &= 1 - \\cos^{2} x \\end{aligned}'
    """
    pairs = _pairs(lhs, rhs)
    check_names(f"prove: {says or 'this step'}", pairs, small)
    named, equations_tex = ((texts,) if isinstance(texts, str) else tuple(texts) for texts in (names, equations))
    for texts, what in ((named, "names"), (equations_tex, "equations are written")):
        if texts and len(texts) != len(pairs):
            raise ProofError(f"prove: {len(texts)} {what} for {len(pairs)} equations: give one for each equation")
    if not (named or equations_tex):
        named = tuple(latex(side) for side, _ in pairs)
        if any(len(name) > _LONGEST for name in named):
            raise ProofError(
                f"prove: {says or 'this step'}: a left side has more than {_LONGEST} characters: give `names` or `equations`"
            )
    domain: dict[sp.Expr, None] = {}
    for a, b in pairs:
        if small is not None:
            _through(a, b, small, order or 0, says)
            continue
        decision = decide_equal(a, b)
        if decision.answer != "zero":
            raise ProofError(
                f"prove: {says or 'this step'}: left − right is {decision.answer}: left = {a}, right = {b}: {decision.reason}"
            )
        domain |= dict.fromkeys(f for f in decision.domain if not (f.is_positive or f.is_number))
    return Step(pairs, says, tuple(domain), named, small, order, equations_tex)


def _pairs(lhs: Any, rhs: Any) -> tuple[tuple[Any, Any], ...]:
    if isinstance(lhs, sp.Equality) and not isinstance(rhs, Sequence):
        raise ProofError("prove: the left side is an equation: give the two sides, prove(lhs, rhs)")
    if isinstance(lhs, Sequence) or isinstance(rhs, Sequence):
        rows = list(lhs), list(rhs)
        if len(rows[0]) != len(rows[1]):
            raise ProofError(f"prove: {len(rows[0])} left sides and {len(rows[1])} right sides: give as many of each")
        return tuple((sp.sympify(a, strict=True), sp.sympify(b, strict=True)) for a, b in zip(*rows, strict=True))
    return ((sp.sympify(lhs, strict=True), sp.sympify(rhs, strict=True)),)


def _through(a: Any, b: Any, small: sp.Symbol, order: int, says: str) -> None:
    entries = zip(a, b, strict=True) if isinstance(a, sp.MatrixBase) else [(a, b)]
    for p, q in entries:
        first = agreement_order(p, q, small, order)
        if first.order is not None:
            raise ProofError(
                f"prove: {says or 'this step'}: the sides first differ at order {first.order} in {small}; left − right has the "
                f"coefficient {first.coefficient}: left = {p}, right = {q}"
            )


# The number of particles or bodies in a sum by default.
_MANY = 3
_CONSTANTS = ("pi", "sqrt", "sin", "cos", "tan", "exp", "Integer", "Rational", "Float")


@dataclass(frozen=True)
class Form:
    r"""A formula as text, from which both its LaTeX (`tex`) and its components (`value`) are computed.

    The text may call the functions of `grammar.FUNCTIONS`, transpose(A) and sum_i(…). The last is a sum over i = 1 … `bodies`,
    in which X_i stands for X_1, X_2, …. `letters` gives the components of symbols that the section does not declare. `names`
    maps names to LaTeX, as {"n": r"\hat\Omega"}. `remainder` is the first omitted power of a series, in LaTeX.
    """

    text: str
    letters: Mapping[str, Any]
    names: Mapping[str, str]
    bodies: int = _MANY
    remainder: str = ""

    def value(self, section: Letters) -> Any:
        """Return the formula in the section's symbols, vectors as components; raise InputError if the text cannot be read."""
        calls = {"transpose": lambda A: A.T}
        return read(_expanded(self.text, self.bodies), {**section.names, **calls, **self.letters}, "form")

    def tex(self, section: Letters) -> str:
        """Return the text as LaTeX, with arrows on vectors, sums as Σ, and the terms in the order of the text."""
        values, texs = {**section.names, **self.letters}, {**section.latex, **self.names}
        unary = {name for name, value in values.items() if name in texs and inspect.isfunction(value)}
        local: dict[str, Any] = _CALLS | {name: _named_function(name, texs[name]) for name in unary}
        symbols: dict[sp.Symbol, str] = {}
        for name in set(re.findall(r"[A-Za-z_]\w*", self.text)) - set(local) - set(_CONSTANTS):
            kind = values.get(name, values.get(re.sub(r"_i(?=_|$)", "_1", name)))
            local[name] = sp.Symbol(name, commutative=not isinstance(kind, sp.MatrixBase))
            symbols[local[name]] = texs.get(name) or _name(name, kind)
        constants = {name: getattr(sp, name) for name in _CONSTANTS}
        expression = parsed(self.text, constants | local, "form", as_written=True)
        tex = light(sp.latex(expression, symbol_names=symbols, order="none", long_frac_ratio=2))
        return tex + (f" + O({self.remainder})" if self.remainder else "")


def form(
    text: str, names: Mapping[str, str] | None = None, bodies: int = _MANY, remainder: str = "", **letters: Any
) -> Form:
    """Return a `Form`; the keyword arguments `letters` are the components of symbols that the section does not declare."""
    return Form(text, letters, names or {}, bodies, remainder)


def _expanded(text: str, bodies: int) -> str:
    """Write each sum_i(…) in a text as an explicit sum over i = 1 … `bodies`."""
    while (start := text.find("sum_i(")) >= 0:
        depth, end = 1, start + len("sum_i(")
        while depth:
            if end == len(text):
                raise InputError(f"form: {text!r}: a bracket of sum_i(…) is not closed")
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        inside = text[start + len("sum_i(") : end - 1]
        terms = (re.sub(r"(?<=\w_)i(?=_|\b)", str(n), inside) for n in range(1, bodies + 1))
        text = f"{text[:start]}({' + '.join(f'({term})' for term in terms)}){text[end:]}"
    return text


def _name(name: str, kind: Any) -> str:
    """Return the LaTeX of a symbol; a vector gets an arrow, hat_r a hat, and r_dot a dot."""
    if isinstance(kind, sp.Symbol) and kind.name == name and not name.startswith("Delta_"):
        return latex(kind)
    if name.startswith("Delta_"):
        return rf"\Delta {name[6:]}"
    stem, hat = (name[4:], True) if name.startswith("hat_") else (name, False)
    match = re.fullmatch(r"([A-Za-z]+)((?:_[A-Za-z0-9]+)*?)(_d?dot)?", stem)
    if match is None:
        raise InputError(f"form: {name!r} is not a symbol with an index: write it as omega_1 or r_1_dot")
    letter = sp.latex(sp.Symbol(match[1]))
    if hat or (isinstance(kind, sp.MatrixBase) and kind.shape == (3, 1)):
        letter = rf"\{'hat' if hat else 'vec'}{{{letter}}}"
    letter = rf"\{match[3][1:]}{{{letter}}}" if match[3] else letter
    return letter + (f"_{{{match[2][1:].replace('_', ',')}}}" if match[2] else "")


def _bracketed(printer: Any, argument: Any) -> str:
    tex: str = printer._print(argument)
    loose = isinstance(argument, sp.Add | _Cross) or argument.could_extract_minus_sign()
    return rf"\left({tex}\right)" if loose else tex


class _Cross(sp.Function):  # type: ignore[misc]
    def _latex(self, printer: Any, exp: Any = None) -> str:
        u, v = (_bracketed(printer, argument) for argument in self.args)
        return rf"{u}\times {v}"


class _Dot(sp.Function):  # type: ignore[misc]
    def _latex(self, printer: Any, exp: Any = None) -> str:
        u, v = (_bracketed(printer, argument) for argument in self.args)
        return rf"{u}^{{2}}" if u == v else rf"{u}\cdot {v}"


class _Norm(sp.Function):  # type: ignore[misc]
    def _latex(self, printer: Any, exp: Any = None) -> str:
        return rf"\left\|{printer._print(self.args[0])}\right\|" + (f"^{{{exp}}}" if exp else "")


def _named_function(name: str, tex: str) -> Any:
    """Return a sympy function whose calls print as `tex`, whatever their argument, such as the unit vector of an axis."""
    return type(name, (sp.Function,), {"_latex": lambda self, printer, exp=None: tex})


class _Transpose(sp.Function):  # type: ignore[misc]
    def _latex(self, printer: Any, exp: Any = None) -> str:
        return rf"{_bracketed(printer, self.args[0])}^{{T}}"


class _Column(sp.Function):  # type: ignore[misc]
    def _latex(self, printer: Any, exp: Any = None) -> str:
        return rf"\left({', '.join(map(printer._print, self.args))}\right)"


class _Sum(sp.Function):  # type: ignore[misc]
    def _latex(self, printer: Any, exp: Any = None) -> str:
        inside = self.args[0]
        tex = printer._print(inside)
        return rf"\sum_i \left({tex}\right)" if isinstance(inside, sp.Add) else rf"\sum_i {tex}"


_CALLS: dict[str, Any] = {
    "cross": _Cross,
    "dot": _Dot,
    "norm": _Norm,
    "transpose": _Transpose,
    "column": _Column,
    "sum_i": _Sum,
}
