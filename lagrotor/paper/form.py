"""A result as a physicist writes it: one text in vectors and sums gives both its LaTeX and its components."""

import inspect
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex, light
from lagrotor.paper.grammar import parsed
from lagrotor.paper.letters import Letters, read

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
