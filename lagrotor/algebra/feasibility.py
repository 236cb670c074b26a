"""Whether equations and inequalities exclude each other, by what values each part of them may take.

Every part of the expressions has one range, an interval with open or closed ends. It is narrowed upwards, from the parts of a
part, and downwards, from the whole to its parts, until some range is empty, which proves that no values of the letters satisfy
all conditions, or until nothing changes, which says nothing. Benhamou, Goualard, Granvilliers & Puget, ICLP 1999 (HC4).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, floor, inf, isqrt
from typing import Any, NamedTuple, TypeAlias

import sympy as sp

from lagrotor.algebra.enclosures import enclosure
from lagrotor.algebra.scalar import parts
from lagrotor.algebra.signs import Region, conditions, is_real, signs

End: TypeAlias = Any  # a Fraction, or ±∞

_ROUNDS, _MOST_PARTS, _BITS, _FAR = 12, 400, 256, 100
_SMALL = Fraction(1, 10**6)  # what a small quantity is below


class _EmptyError(Exception):
    """A part has no value."""


class Range(NamedTuple):
    """Between low and high; whether either end is left out."""

    low: End = -inf
    high: End = inf
    above: bool = False
    below: bool = False

    def both(self, other: Range) -> Range:
        """The values in both; raises where there are none."""
        low, above = max((self.low, self.above), (other.low, other.above))
        high, below = min((self.high, not self.below), (other.high, not other.below))
        if low > high or (low == high and (above or not below)):
            raise _EmptyError
        return Range(low, high, above, not below)

    def joined(self, other: Range) -> Range:
        low, above = min((self.low, self.above), (other.low, other.above))
        high, below = max((self.high, not self.below), (other.high, not other.below))
        return Range(low, high, above, not below)

    def __add__(self, other: Range) -> Range:  # type: ignore[override]
        low, high = _sum(self.low, other.low), _sum(self.high, other.high)
        return Range(low, high, self.above or other.above, self.below or other.below)

    def __neg__(self) -> Range:
        return Range(-self.high, -self.low, self.below, self.above)

    def __mul__(self, other: Range) -> Range:  # type: ignore[override]
        ends = [
            (_product(x, y), (p or q) and not (x == 0 and not p) and not (y == 0 and not q))
            for x, p in self._ends
            for y, q in other._ends
        ]
        (low, above), (high, below) = min(ends), max((value, not open_) for value, open_ in ends)
        return Range(low, high, above, not below)

    @property
    def _ends(self) -> tuple[tuple[End, bool], tuple[End, bool]]:
        return (self.low, self.above), (self.high, self.below)

    @property
    def nonnegative(self) -> bool:
        return self.low >= 0

    @property
    def excludes_zero(self) -> bool:
        return self.low > 0 or self.high < 0 or (self.low == 0 and self.above) or (self.high == 0 and self.below)

    @property
    def short(self) -> Range:
        """Ends of many digits rounded outwards."""
        (low, above), (high, below) = self._ends
        return Range(_short(low, floor), _short(high, ceil), above and _is_short(low), below and _is_short(high))

    def inverse(self) -> Range:
        """1/x, x ≠ 0."""
        if self.low < 0 < self.high:
            return EVERYTHING
        if self.high <= 0 and self.low < 0:
            return -(-self).inverse()
        if self.high == 0:
            raise _EmptyError
        high = inf if self.low == 0 else 1 / Fraction(self.low)
        low = Fraction(0) if self.high == inf else 1 / Fraction(self.high)
        return Range(low, high, self.below or self.high == inf, self.above or self.low == 0)

    def power(self, n: int) -> Range:
        if n < 0:
            return self.power(-n).inverse()
        if n % 2 or self.low >= 0:
            return Range(_power(self.low, n), _power(self.high, n), self.above, self.below)
        if self.high <= 0:
            return (-self).power(n)
        high, below = max(((-self.low), not self.above), (self.high, not self.below))
        return Range(Fraction(0), _power(high, n), False, not below)

    def root(self, n: int) -> Range:
        """The n-th root of what is not negative."""
        (low, exact), (high, also) = (_root(end, n) for end in (max(self.low, Fraction(0)), self.high))
        return Range(low[0], high[1], self.above and exact and self.low >= 0, self.below and also)


EVERYTHING, _ZERO = Range(), Range(Fraction(0), Fraction(0))
_POSITIVE, _NONNEGATIVE = Range(Fraction(0), inf, True), Range(Fraction(0), inf)
_UNIT = Range(Fraction(-1), Fraction(1))


def _is_short(x: End) -> bool:
    return not isinstance(x, Fraction) or max(map(int.bit_length, x.as_integer_ratio())) <= _BITS


def _short(x: End, whole: Any) -> End:
    if not isinstance(x, Fraction) or _is_short(x):
        return x
    scale = Fraction(2) ** (_BITS // 2 + x.denominator.bit_length() - x.numerator.bit_length())
    return Fraction(whole(x * scale)) / scale


def _sum(x: End, y: End) -> End:
    return x if isinstance(x, float) else y if isinstance(y, float) else x + y


def _product(x: End, y: End) -> End:
    if x == 0 or y == 0:
        return Fraction(0)
    return x * y if isinstance(x, Fraction) and isinstance(y, Fraction) else inf if (x > 0) == (y > 0) else -inf


def _power(x: End, n: int) -> End:
    return x**n if isinstance(x, Fraction) else (inf if x > 0 or n % 2 == 0 else -inf)


def _root(x: End, n: int) -> tuple[tuple[End, End], bool]:
    """Two numbers between which the root lies, and whether they are it."""
    if not isinstance(x, Fraction):
        return (x, x), True
    scale = 1 if all(isqrt(k) ** 2 == k for k in (x.numerator, x.denominator)) and n == 2 else 2**60
    over = sp.integer_nthroot(x.numerator * x.denominator ** (n - 1) * scale**n, n)
    low = Fraction(int(over[0]), x.denominator * scale)
    return (low, low if over[1] else low + Fraction(1, x.denominator * scale)), bool(over[1])


# Monotone functions: their inverse, where they are defined, and their values.
_HALF_TURN = Range(Fraction(-355, 226), Fraction(355, 226))  # 355/113 > π
_INCREASING: dict[Any, tuple[Any, Range, Range]] = {
    sp.exp: (sp.log, EVERYTHING, _POSITIVE),
    sp.log: (sp.exp, _POSITIVE, EVERYTHING),
    sp.sinh: (sp.asinh, EVERYTHING, EVERYTHING),
    sp.asinh: (sp.sinh, EVERYTHING, EVERYTHING),
    sp.tanh: (sp.atanh, EVERYTHING, Range(Fraction(-1), Fraction(1), True, True)),
    sp.atanh: (sp.tanh, Range(Fraction(-1), Fraction(1), True, True), EVERYTHING),
    sp.atan: (None, EVERYTHING, _HALF_TURN),
    sp.asin: (None, _UNIT, _HALF_TURN),
    sp.acosh: (sp.cosh, Range(Fraction(1), inf), _NONNEGATIVE),
}
_VALUES: dict[Any, Range] = {
    sp.sin: _UNIT,
    sp.cos: _UNIT,
    sp.acos: Range(Fraction(0), Fraction(355, 113)),
    sp.cosh: Range(Fraction(1), inf),
    sp.sech: Range(Fraction(0), Fraction(1), True),
    sp.Abs: _NONNEGATIVE,
    sp.sign: _UNIT,
}


def is_infeasible(equations: Sequence[sp.Expr], where: Region, small: Sequence[sp.Symbol] = ()) -> bool:
    """Return whether it is proved that at no point of the region every equation is zero.

    small: letters that are as near to 0 as one likes.
    """
    if _excludes_itself(where):
        return True
    if sum(parts(e) for e in (*equations, *(e for e, _ in where.above))) > _MOST_PARTS:
        return False
    facts = [(sign * e, False) for e in equations if is_real(e, where) for sign in (1, -1)]
    conditions = [(e, _ZERO) for e in equations] + [
        (e, _POSITIVE if strict else _NONNEGATIVE) for e, strict in where.above
    ]
    if any(map(_has_no_root, equations)):
        return True
    try:
        _Parts(Region((*facts, *where.above)), small).narrow(
            [(form, values) for e, values in conditions for form in _forms(e)]
        )
    except _EmptyError:
        return True
    return False


def has_principal_values(e: sp.Basic, equations: Sequence[sp.Expr], where: Region) -> bool:
    """Whether principal values are meant: e has i or a complex letter, or is real at no inner point; odd roots may be real."""
    if e.has(sp.I) or not all(s.is_real for s in e.free_symbols):
        return True
    natural = conditions(e)
    odd = any(n.exp.is_Rational and n.exp.q > 2 for n in e.atoms(sp.Pow))
    inside = [sp.Gt(r.gts, r.lts) for r in natural if r is not sp.false]
    return not odd and (sp.false in natural or sp.false in inside or is_infeasible(equations, where.with_(*inside)))


def _excludes_itself(where: Region) -> bool:
    """Return whether linear conditions, and the letters' own, exclude each other: Fourier–Motzkin elimination."""
    rows = [(sp.expand(e), strict) for e, strict in where.above]
    letters = set().union(*(e.free_symbols for e, _ in rows)) if rows else set()
    for letter in letters:
        sign = 1 if letter.is_nonnegative else -1 if letter.is_nonpositive else 0
        if sign:
            rows.append((sign * letter, bool(letter.is_nonzero)))
    for letter in sorted(letters, key=sp.default_sort_key):
        with_it = [row for row in rows if row[0].has(letter)]
        slopes = [sp.expand(e.diff(letter)) for e, _ in with_it]
        rest = [row for row in rows if not row[0].has(letter)]
        if not all(slope.is_Rational for slope in slopes):
            rows = rest  # not linear: what it says is left out, so that less is found empty
            continue
        above = [(e / slope, strict) for (e, strict), slope in zip(with_it, slopes, strict=True) if slope > 0]
        below = [(e / -slope, strict) for (e, strict), slope in zip(with_it, slopes, strict=True) if slope < 0]
        rows = rest + [(sp.expand(a + b), s or z) for a, s in above for b, z in below]
        if len(rows) > 200:
            return False
    return any(e.is_Rational and (e < 0 or (e == 0 and strict)) for e, strict in rows)


def _has_no_root(e: sp.Expr) -> bool:
    """Return whether a polynomial with rational coefficients in one real letter has none."""
    if len(e.free_symbols) != 1 or not next(iter(e.free_symbols)).is_real or not e.is_polynomial():
        return False
    polynomial = sp.Poly(e, *e.free_symbols)
    return bool(polynomial.domain.is_QQ or polynomial.domain.is_ZZ) and polynomial.count_roots() == 0


def _forms(e: sp.Expr) -> list[sp.Expr]:
    """An expression, its product of factors, and itself with its squares completed."""
    if e.has(sp.I):
        return [e]
    try:
        return list(dict.fromkeys((e, sp.factor(e), _completed(sp.expand(e)))))
    except (sp.PolynomialError, NotImplementedError):
        return [e]


def _completed(e: sp.Expr) -> sp.Expr:
    """a x² + b x + c as a (x + b/2a)² + c − b²/4a, letter by letter."""
    for letter in sorted(e.free_symbols, key=sp.default_sort_key):
        if e.is_polynomial(letter) and sp.degree(e, letter) == 2:
            c, b, a = (e.coeff(letter, k) for k in range(3))
            if a.is_Rational:
                return a * (letter + b / (2 * a)) ** 2 + _completed(sp.expand(c - b**2 / (4 * a)))
    return e


class _Parts:
    """The range of each part; `real`: whether it is known to be real, otherwise its range is that of its real values."""

    def __init__(self, where: Region, small: Sequence[sp.Symbol]) -> None:
        self.where, self.small = where, small
        self.ranges: dict[sp.Expr, Range] = {}
        self.real: dict[sp.Expr, bool] = {}

    def narrow(self, conditions: Sequence[tuple[sp.Expr, Range]]) -> None:
        """Narrow all ranges; raises where one becomes empty."""
        for _ in range(_ROUNDS):
            before = dict(self.ranges)
            for e, values in conditions:
                self._up(e)
                self._meet(e, values)
            if before == self.ranges:
                break

    def _meet(self, e: sp.Expr, values: Range) -> None:
        """e takes these values only: so do its parts."""
        number, rest = _scaled(e)
        values = values * _point(1 / number)
        old = self.ranges[rest]
        new = old.both(values)
        if rest.is_integer:
            low, high = (
                end if abs(end) == inf else Fraction(whole(end)) for whole, end in ((ceil, new.low), (floor, new.high))
            )
            new = new.both(Range(low, high))
        self.ranges[rest] = new = new.short
        if rest.args and not rest.is_number and self.real[rest]:
            self._down(rest, new)

    def _of(self, e: sp.Expr) -> Range:
        number, rest = _scaled(e)
        return self.ranges[rest] * _point(number)

    def _up(self, e: sp.Expr) -> bool:
        """Range of e from its parts; whether it is real."""
        rest = _scaled(e)[1]
        if rest not in self.ranges:
            self.ranges[rest], self.real[rest] = self._first(rest)
        if rest.args and not rest.is_number:
            inside = [self._up(part) for part in rest.args]
            self.real[rest] = self.real[rest] or (all(inside) and self._keeps_real(rest))
            if all(inside) or rest.is_Add:
                self.ranges[rest] = self.ranges[rest].both(self._composed(rest, inside)).short
        return self.real[rest]

    def _first(self, e: sp.Expr) -> tuple[Range, bool]:
        if e.is_number:
            between = enclosure(e, {})
            real = between is not None
            return (Range(_fraction(between[0]), _fraction(between[1])) if between else EVERYTHING), real
        found = signs(e, self.where)
        if found is not None and not found:
            raise _EmptyError
        values = EVERYTHING
        if found is not None:
            values = Range(*_SIGNED[min(found)][:1], *_SIGNED[max(found)][1:2], min(found) == 1, max(found) == -1)
        if e in self.small:
            values = values.both(Range(-_SMALL, _SMALL))
        if e.is_Pow and e.exp.is_Rational and e.exp.q % 2 == 0:
            values = values.both(_NONNEGATIVE)
        return values, found is not None

    def _keeps_real(self, e: sp.Expr) -> bool:
        """Return whether e of real parts is real."""
        if e.is_Pow:
            return bool(e.exp.is_integer or self._of(e.base).nonnegative)
        if e.func in _INCREASING:
            there, domain = self._of(e.args[0]), _INCREASING[e.func][1]
            return there.low >= domain.low and there.high <= domain.high
        return e.is_Add or e.is_Mul or e.func in (sp.sin, sp.cos, sp.cosh, sp.sech, sp.Abs)

    def _composed(self, e: sp.Expr, real: list[bool]) -> Range:
        values = [self._of(part) for part in e.args]
        if e.is_Add:
            # A real sum with one part that is not known to be real: so is that part.
            return sum(values[1:], values[0]).both(_waves(e)) if real.count(False) < 2 else EVERYTHING
        if e.is_Mul:
            total = values[0]
            for each in values[1:]:
                total *= each
            return total
        if e.is_Pow and e.exp.is_Integer:
            return values[0].power(int(e.exp))
        if e.is_Pow and e.exp.is_Rational and values[0].nonnegative:
            return values[0].root(int(e.exp.q)).power(int(e.exp.p))
        if isinstance(e, sp.Abs):
            return values[0].power(2).root(2)
        if e.func in _INCREASING:
            _, domain, there = _INCREASING[e.func]
            return there.both(_image(e.func, values[0].both(domain))) if self.real[_scaled(e)[1]] else there
        there = _VALUES.get(e.func, EVERYTHING)
        bounded = e.func in (sp.sin, sp.cos) and max(map(abs, values[0][:2])) < _FAR
        return there.both(_image(e.func, values[0])) if bounded else there

    def _down(self, e: sp.Expr, values: Range) -> None:
        """What the value of e says of its parts, which are real."""
        if e.is_Add or e.is_Mul:
            for part in e.args:
                others = [self._of(other) for other in e.args if other is not part]
                total = others[0]
                for each in others[1:]:
                    total = total + each if e.is_Add else total * each
                if e.is_Add:
                    self._meet(part, values + (-total))
                elif total.excludes_zero:
                    self._meet(part, values * total.inverse())
        elif e.is_Pow and e.exp.is_Integer and e.exp > 0:
            self._meet(e.base, self._rooted(e, values))
        elif e.is_Pow and e.exp == sp.S.Half:
            self._meet(e.base, values.both(_NONNEGATIVE).power(2))
        elif e.is_Pow and e.exp == -1:
            self._meet(e.base, values.inverse())
        elif isinstance(e, sp.Abs):
            self._meet(e.args[0], Range(-values.high, values.high, values.below, values.below))
        elif e.func in _INCREASING and (back := _INCREASING[e.func][0]) is not None:
            self._meet(e.args[0], _image(back, values))

    def _rooted(self, e: sp.Expr, values: Range) -> Range:
        n, base = int(e.exp), self._of(e.base)
        if base.nonnegative or (n % 2 and values.nonnegative):
            return values.both(_NONNEGATIVE).root(n)
        if n % 2:
            return -self._rooted(e, -values) if values.high <= 0 else EVERYTHING
        size = values.both(_NONNEGATIVE).root(n)
        return -size if base.high <= 0 else size.joined(-size)


_SIGNED = {-1: (-inf, Fraction(0)), 0: (Fraction(0), Fraction(0)), 1: (Fraction(0), inf)}


def _scaled(e: sp.Expr) -> tuple[sp.Rational, sp.Expr]:
    """A rational number and the part, so that a part and its multiples are one."""
    number, rest = e.as_coeff_Mul(rational=True)
    if rest.is_Add:
        content, rest = rest.primitive()
        number *= content
        if rest.could_extract_minus_sign():
            number, rest = -number, -rest
    return number, rest


def _point(number: sp.Rational) -> Range:
    return Range(_fraction(number), _fraction(number))


def _waves(e: sp.Expr) -> Range:
    """a cos u + b sin u + c lies within √(a² + b²) of c."""
    rates: dict[sp.Expr, list[sp.Expr]] = {}
    rest = sp.S.Zero
    for term in e.args:
        rate, wave = term.as_coeff_Mul(rational=True)
        if isinstance(wave, sp.sin | sp.cos) and wave.args[0].is_real:
            rates.setdefault(wave.args[0], []).append(rate)
        else:
            rest += term
    if not rest.is_Rational:
        return EVERYTHING
    total = _point(rest)
    for found in rates.values():
        size = _point(sum(rate**2 for rate in found)).root(2)
        total = total + size.joined(-size)
    return total


def _image(function: Any, values: Range) -> Range:
    """The values of an increasing function, or of sin and cos, on a range; rounded outwards."""
    u = sp.Dummy(real=True)
    if function in (sp.sin, sp.cos):
        between = enclosure(function(u), {u: (_rational(values.low), _rational(values.high))})
        return Range(_fraction(between[0]), _fraction(between[1])) if between else EVERYTHING
    low = enclosure(function(u), {u: _rational(values.low)}) if values.low > -inf else None
    high = enclosure(function(u), {u: _rational(values.high)}) if values.high < inf else None
    return Range(
        _fraction(low[0]) if low else -inf,
        _fraction(high[1]) if high else inf,
        low is not None and values.above and low[0] == low[1],
        high is not None and values.below and high[0] == high[1],
    )


def _rational(end: End) -> sp.Rational:
    return sp.Rational(end.numerator, end.denominator)


def _fraction(value: sp.Rational) -> Fraction:
    return Fraction(int(value.p), int(value.q))
