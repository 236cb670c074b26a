"""Formulas as plain text, with factors in the order in which they are written by hand: m g l cos θ, m l² θ̇²/2."""

import re
from collections.abc import Callable
from itertools import islice
from typing import Any

import sympy as sp
from sympy.printing.conventions import split_super_sub
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.pretty.pretty_symbology import greek_unicode, sub, sup
from sympy.printing.str import StrPrinter

VELOCITY = 3  # the place of a velocity in a product, after numbers, masses and parameters
_DOTS = {"_dot": "\u0307", "_ddot": "\u0308"}
_GREEK = greek_unicode | {"ell": "ℓ"}
LONG = "a long expression"
_LONGEST = 120  # nodes of the tree of a formula that is written out


def formula(e: Any, number: Callable[[float], str]) -> str:
    """Return a formula as plain text, or "a long expression" for one of more than two lines; `number` writes a float."""
    if sum(1 for _ in islice(sp.preorder_traversal(e), _LONGEST + 1)) > _LONGEST:
        return LONG
    text = _Text()
    text.number = number
    return str(text.doprint(e))


def with_greek(text: str) -> str:
    """Return a text with Greek letters and indices in place of names: Omega_0 is Ω₀, phi_1' is φ₁'."""
    return re.sub(r"(?<![A-Za-z])([A-Za-z]+)(?:_(\d+))?(?![A-Za-z_])", _letter, text)


def _letter(match: re.Match[str]) -> str:
    name, index = match[1], match[2]
    if name not in _GREEK and (index is None or len(name) > 1):
        return match[0]
    return _GREEK.get(name, name) + "".join(map(sub.__getitem__, index or ""))


def place_of_factor(factor: sp.Expr) -> tuple[int, Any]:
    """Return a sort key of a factor in a product that is written by hand."""
    base = factor.base if factor.is_Pow else factor
    name = base.name if base.is_Symbol else ""
    if factor.is_number:
        place = 0
    elif name:
        place = VELOCITY if name.endswith("_dot") else 4 if name.endswith("_ddot") else 1 if name[0] in "mMIJK" else 2
    else:
        place = 6 if base.is_Add else 5
    return place, factor.sort_key()


def with_plus_first(e: sp.Expr) -> list[sp.Expr]:
    """Return the terms of a sum, one without a minus sign first."""
    terms = list(e.as_ordered_terms())
    first = next((i for i, term in enumerate(terms) if not term.could_extract_minus_sign()), 0)
    return [terms[first], *terms[:first], *terms[first + 1 :]]


def _with_one_root(factors: tuple[sp.Expr, ...]) -> list[sp.Expr]:
    """Return the factors with one root of a quotient, √(g/l), for roots of positive quantities above and below the line."""
    roots = [f for f in factors if f.is_Pow and abs(f.exp) == sp.S.Half and f.base.is_positive]
    if {f.exp for f in roots} != {sp.S.Half, -sp.S.Half}:
        return list(factors)
    quotient = sp.Mul(*(f.base ** sp.sign(f.exp) for f in roots))
    return [*(f for f in factors if f not in roots), sp.Pow(quotient, sp.S.Half, evaluate=False)]


class _Text(StrPrinter):  # type: ignore[misc]
    """Plain text with Greek letters, dots, indices and powers."""

    number: Callable[[float], str]

    def _print_Symbol(self, s: sp.Symbol) -> str:
        stem, dot = next(
            ((s.name[: -len(end)], mark) for end, mark in _DOTS.items() if s.name.endswith(end)), (s.name, "")
        )
        name, above, below = split_super_sub(stem)
        letter = _GREEK.get(name, name)
        indices = ("".join(map(sub.__getitem__, i)) if i.isdigit() else f"_{_GREEK.get(i, i)}" for i in below)
        return letter[:1] + dot + letter[1:] + "".join((*indices, *(f"^{i}" for i in above)))

    def _print_Add(self, e: sp.Expr, order: Any = None) -> str:
        terms = sorted(
            with_plus_first(e), key=lambda term: not any(str(s).endswith(tuple(_DOTS)) for s in term.free_symbols)
        )
        text = " + ".join(map(self._print, terms))
        return text.replace("+ −", "− ")

    def _print_Mul(self, e: sp.Expr) -> str:
        number, product = e.as_coeff_Mul()
        factors = sorted(_with_one_root(sp.Mul.make_args(product)), key=place_of_factor)
        under = [f for f in factors if f.is_Pow and f.exp.could_extract_minus_sign()]
        above, below = [f for f in factors if f not in under], [1 / f for f in under]
        if number.is_Rational:
            above = [*([abs(sp.Integer(number.p))] if abs(number.p) != 1 or not above else []), *above]
            below = [*([sp.Integer(number.q)] if number.q != 1 else []), *below]
        else:
            above = [abs(number), *above]
        top, bottom = (" ".join(self.parenthesize(f, PRECEDENCE["Mul"]) for f in part) for part in (above, below))
        bottom = f"({bottom})" if len(below) > 1 else bottom
        return f"{'−' * bool(number.is_negative)}{top}{'/' if below else ''}{bottom}"

    def _print_Pow(self, e: sp.Expr, rational: bool = False) -> str:
        if e.exp.could_extract_minus_sign():
            return f"1/{self.parenthesize(1 / e, PRECEDENCE['Mul'], strict=False)}"
        if e.exp == sp.S.Half:
            return f"√{self.parenthesize(e.base, PRECEDENCE['Atom'], strict=True)}"
        power = (
            "".join(map(sup.__getitem__, str(e.exp)))
            if e.exp.is_Integer
            else f"^{self.parenthesize(e.exp, PRECEDENCE['Atom'], strict=True)}"
        )
        if power[0] != "^" and isinstance(e.base, sp.sin | sp.cos | sp.tan):
            return self._print_Function(e.base, power)
        return self.parenthesize(e.base, PRECEDENCE["Atom"], strict=True) + power

    def _print_Function(self, e: sp.Expr, power: str = "") -> str:
        inside = ", ".join(map(self._print, e.args))
        bare = isinstance(e, sp.sin | sp.cos | sp.tan) and e.args[0].is_Symbol
        return f"{e.func.__name__}{power}{f' {inside}' if bare else f'({inside})'}"

    def _print_Abs(self, e: sp.Expr) -> str:
        return f"|{self._print(e.args[0])}|"

    def _print_exp(self, e: sp.Expr) -> str:
        return f"exp({self._print(e.args[0])})"

    def _print_Integer(self, e: sp.Expr) -> str:
        return str(e).replace("-", "−")

    def _print_Rational(self, e: sp.Expr) -> str:
        return f"{e.p}/{e.q}".replace("-", "−")

    def _print_Float(self, e: sp.Expr) -> str:
        return self.number(float(e))

    def _print_Pi(self, e: sp.Expr) -> str:
        return "π"

    def _print_ImaginaryUnit(self, e: sp.Expr) -> str:
        return "i"

    def _print_Relational(self, e: Any) -> str:
        sign = {">=": "≥", "<=": "≤", "!=": "≠", "==": "="}.get(e.rel_op, e.rel_op)
        return f"{self._print(e.lhs)} {sign} {self._print(e.rhs)}"

    def _print_BooleanTrue(self, e: Any) -> str:
        return "always"

    def _print_BooleanFalse(self, e: Any) -> str:
        return "never"

    def _print_And(self, e: Any) -> str:
        return " and ".join(map(self._print, e.args))

    def _print_Or(self, e: Any) -> str:
        return " or ".join(map(self._print, e.args))
