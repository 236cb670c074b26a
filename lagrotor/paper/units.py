"""The dimensions of a printed line, from the units of its symbols in the glossary.

A dimension is a monomial in the base units: kg*m**2/s for "kg m²/s", 1 for a number or an angle. The terms of a sum and the
sides of a line need one dimension; the argument of a sine and an exponent are numbers (ISO 80000-1, 6.1). Under a premise such
as R = 1, numbers replace quantities, and sides may differ by powers of the dimension of R.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import sympy as sp
from sympy.core.function import AppliedUndef

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import Glossary
from lagrotor.paper.grammar import parsed
from lagrotor.paper.plain_text import readable

_BASES = {name: sp.Symbol(name, positive=True) for name in ("kg", "m", "s", "A", "K", "mol", "cd")}
_KG, _M, _S, _A = (_BASES[name] for name in ("kg", "m", "s", "A"))
_FORCE, _VOLT = _KG * _M / _S**2, _KG * _M**2 / _S**3 / _A
_ONE = sp.S.One
_UNITS: dict[str, sp.Expr] = {
    **_BASES, "rad": _ONE, "sr": _ONE, "deg": _ONE, "g": _KG, "t": _KG, "min": _S, "h": _S, "Hz": 1 / _S, "rpm": 1 / _S,
    "N": _FORCE, "J": _FORCE * _M, "W": _FORCE * _M / _S, "Pa": _FORCE / _M**2, "L": _M**3, "eV": _FORCE * _M, "C": _A * _S,
    "V": _VOLT, "Ohm": _VOLT / _A, "F": _A * _S / _VOLT, "T": _VOLT * _S / _M**2, "Wb": _VOLT * _S, "H": _VOLT * _S / _A,
}  # fmt: skip
_PREFIXED = {
    prefix + name: unit
    for name, unit in _UNITS.items()
    if name not in ("kg", "min", "h", "deg", "rpm", "rad", "sr", "t")
    for prefix in "GMkdcmµnp"
}
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_SUPERSCRIPT = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
# A product after a quotient is ambiguous: in J/kg K the K may be above or below.
_UNCLEAR = re.compile(r"/[^()]*\*(?!\*)")


@cache
def dimension_of(unit: str) -> sp.Expr:
    """Return the dimension of a unit such as kg m²/s or kg m^2 s^-1; raise InputError if it is unknown or ambiguous."""
    text = (
        re.sub(r"[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", lambda dimension: f"^{dimension[0].translate(_RAISED)}", unit)
        .replace("°", "deg")
        .strip()
    )
    text = re.sub(r"\s*[·*]\s*|(?<=[\w)])\s+(?=[\w(])", "*", text).replace("Ω", "Ohm")
    if _UNCLEAR.search(text):
        raise InputError(f"unit {unit!r} can be read in two ways: put the denominator in brackets, J/(kg K)")
    text = re.sub(r"\^\(?(-?\d+(?:/\d+)?)\)?", r"**(\1)", text)
    dimension = parsed(text, {**_PREFIXED, **_UNITS}, f"unit {unit!r}")
    if not _is_monomial(dimension):
        raise InputError(f"unit {unit!r} is not a product of powers of units: write it as kg m²/s")
    return dimension


def _letter_text(name: str) -> str:
    """Return the name of a symbol in plain text; the component Omega_2_z becomes 'z of Ω₂'."""
    whole, _, axes = name.rpartition("_")
    return f"{axes} of {readable(whole)}" if whole and re.fullmatch("[xyz]{1,2}", axes) else readable(name)


def _is_monomial(dimension: Any) -> bool:
    return isinstance(dimension, sp.Expr) and all(
        exponent.is_Rational and (base.is_Symbol or base == 1) for base, exponent in dimension.as_powers_dict().items()
    )


def unit_text(dimension: sp.Expr) -> str:
    """Return a dimension as the text of a unit, such as kg m²/s."""
    powers = {str(base): power for base, power in dimension.as_powers_dict().items() if base != 1}
    ordered = [(name, powers[name]) for name in _BASES if name in powers]
    above = [(name, power) for name, power in ordered if power > 0]
    below = [(name, power) for name, power in ordered if power < 0]
    if len(below) == 1:
        name, power = below[0]
        return f"{_powers(above) or '1'}/{_powers([(name, -power)])}"
    return _powers([*above, *below]) or "1"


def _powers(rows: Iterable[tuple[str, Any]]) -> str:
    return " ".join(
        name + ("" if p == 1 else str(p).translate(_SUPERSCRIPT) if p.is_Integer else f"^({p})") for name, p in rows
    )


@dataclass(frozen=True)
class Dimensions:
    """The dimensional analysis of a line.

    The answer 'in units' means that the sides agree once premises such as R = 1 make quantities numbers.
    """

    answer: Literal["consistent", "in units", "inconsistent", "not known"]
    says: str


def dimensions(printed: Any, derived: Any, glossary: Glossary, values: Mapping[Any, Any]) -> Dimensions:
    """Compare the dimensions of two sides; `values` gives the numbers that premises substitute for symbols."""
    units: dict[sp.Symbol, sp.Expr] = {}
    unread: dict[str, str] = {}
    for symbol, entry in glossary.items():
        if entry.unit.strip() in ("", "?"):
            continue
        try:
            units[symbol] = dimension_of(entry.unit)
        except InputError as refusal:
            unread[symbol.name] = str(refusal)

    def under(numbers: Mapping[Any, sp.Expr]) -> Dimensions:
        return _compared(printed, derived, _Reader(units, unread, tuple(numbers.values())))

    strict = under({})
    if strict.answer != "inconsistent":
        return strict
    numbers = {s: units[s] for s, value in values.items() if value.is_number and value != 0 and units.get(s, _ONE) != 1}
    if under(numbers).answer == "inconsistent":
        return strict
    for symbol in tuple(numbers):
        others = {s: unit for s, unit in numbers.items() if s != symbol}
        if under(others).answer != "inconsistent":
            numbers = others
    values_text = ", ".join(f"{_letter_text(str(s))} = {readable(str(values[s]))}" for s in numbers)
    return Dimensions(
        "in units", f"with {values_text} written as numbers, the units of the sides differ: {strict.says}"
    )


def _compared(printed: Any, derived: Any, reader: "_Reader") -> Dimensions:
    sides = [list(s) if isinstance(s, sp.MatrixBase) else [s] for s in (printed, derived)]
    if len(sides[0]) != len(sides[1]):  # a number is compared with each entry of a vector
        sides = [side * max(map(len, sides)) if len(side) == 1 else side for side in sides]
    unknown, shared = "", list[sp.Expr]()
    for pair in zip(*sides, strict=False):
        pair_dimensions = []
        for name, side in zip(("printed", "derived"), pair, strict=True):
            try:
                pair_dimensions.append(reader.of(side))
            except _UnknownError as refusal:
                unknown = unknown or str(refusal)
            except _InconsistentError as difference:
                return Dimensions("inconsistent", f"{name}: {difference}")
        both = [dimension for dimension in pair_dimensions if dimension is not None]
        if len(both) == 2 and not reader.alike(*both):
            gap = unit_text(both[1] / both[0])
            texts = [unit_text(dimension) for dimension in both]
            return Dimensions("inconsistent", f"printed {texts[0]}, derived {texts[1]}; derived/printed is {gap}")
        shared += both
    if unknown:
        return Dimensions("not known", unknown)
    return Dimensions("consistent", ", ".join(dict.fromkeys(map(unit_text, shared))) or "0")


class _UnknownError(Exception):
    """The error that a dimension does not follow from the units of the symbols."""


class _InconsistentError(Exception):
    """The error that terms of a sum differ in dimension, or that a quantity stands where a number must."""


@dataclass(frozen=True)
class _Reader:
    """The computation of dimensions from the units of symbols.

    `unread` has the symbols whose unit could not be read, with the reason. Products of powers of the dimensions `numbers` count
    as numbers.
    """

    units: Mapping[sp.Symbol, sp.Expr]
    unread: Mapping[str, str]
    numbers: tuple[sp.Expr, ...]

    def alike(self, a: sp.Expr, b: sp.Expr) -> bool:
        """Return True if the ratio of two dimensions is a product of powers of `numbers`."""
        if a == b:
            return True
        rows = [
            [dimension.as_powers_dict().get(base, 0) for base in _BASES.values()]
            for dimension in (*self.numbers, a / b)
        ]
        return bool(sp.Matrix(rows).rank() == sp.Matrix(rows[:-1]).rank()) if self.numbers else False

    def of(self, e: Any) -> sp.Expr | None:
        """Return the dimension of an expression; None for zero, which fits every dimension."""
        if e.is_number:
            return None if e == 0 else _ONE
        if e.is_Symbol or isinstance(e, AppliedUndef):
            return self._letter(e)
        if e.is_Add or isinstance(e, sp.Max | sp.Min):
            return self._common(e.args)
        if e.is_Mul:
            return self._product(e.args)
        if e.is_Pow and e.base is not sp.E:
            return self._power(e)
        if isinstance(e, sp.Abs | sp.re | sp.im | sp.conjugate):
            return self.of(e.args[0])
        if isinstance(e, sp.Derivative):
            below = self._product([x**n for x, n in e.variable_count])
            return self._ratio(self.of(e.expr), below)
        if isinstance(e, sp.Integral):
            return self._product([e.function, *(limit[0] for limit in e.limits)])
        if isinstance(e, sp.sign | sp.atan2):
            self._common(e.args)
            return _ONE
        if isinstance(e, sp.Function):
            for argument in e.args:
                self._number(argument, f"the argument of {e.func.__name__}")
            return _ONE
        raise _UnknownError(f"the dimension of {readable(str(e))} is not known")

    def _letter(self, e: Any) -> sp.Expr:
        if e in self.units:
            return self.units[e]
        name = str(e.func) if isinstance(e, AppliedUndef) else e.name
        named = [unit for symbol, unit in self.units.items() if symbol.name == name and isinstance(e, AppliedUndef)]
        if not named:
            raise _UnknownError(f"{_letter_text(name)}: {self.unread.get(name, 'it has no unit')}")
        return named[0]

    def _common(self, terms: Iterable[Any]) -> sp.Expr | None:
        """Return the dimension that all terms share; terms that differ are reported even if others are unknown."""
        first: tuple[Any, sp.Expr] | None = None
        unknown: _UnknownError | None = None
        for term in terms:
            try:
                dimension = self.of(term)
            except _UnknownError as refusal:
                unknown = unknown or refusal
                continue
            if dimension is None:
                continue
            if first is not None and not self.alike(first[1], dimension):
                texts = [f"{_short_text(t)} is {unit_text(d)}" for t, d in (first, (term, dimension))]
                raise _InconsistentError(f"a sum of different dimensions, {texts[0]}, {texts[1]}")
            first = first or (term, dimension)
        if unknown:
            raise unknown
        return first[1] if first else None

    def _product(self, factors: Iterable[Any]) -> sp.Expr | None:
        product: sp.Expr | None = _ONE
        unknown: _UnknownError | None = None
        for factor in factors:
            try:
                product = self._ratio(product, 1 / d if (d := self.of(factor)) is not None else None)
            except _UnknownError as refusal:
                unknown = unknown or refusal
        if unknown:
            raise unknown
        return product

    def _ratio(self, above: sp.Expr | None, below: sp.Expr | None) -> sp.Expr | None:
        return None if above is None or below is None else above / below

    def _power(self, e: sp.Pow) -> sp.Expr:
        base = self.of(e.base)
        if e.exp.is_Rational and base is not None:
            return base**e.exp
        self._number(e.exp, "an exponent")
        if base is not None and not self.alike(base, _ONE):
            raise _UnknownError(f"{_short_text(e)} is a power of {unit_text(base)} with a symbol in the exponent")
        return _ONE

    def _number(self, e: Any, where: str) -> None:
        dimension = self.of(e)
        if dimension is not None and not self.alike(dimension, _ONE):
            raise _InconsistentError(f"{where}, {_short_text(e)}, is {unit_text(dimension)}")


def _short_text(e: Any) -> str:
    text = readable(str(e))
    return text if len(text) <= 60 else f"{text[:57]}…"
