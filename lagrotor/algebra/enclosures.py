"""Interval enclosures of values at a rational point: an inequality between enclosures is proved at that point.

Every operation rounds outwards (mpmath.iv); a complex value is enclosed in a rectangle.  A point may also hold values of
undefined functions and of their derivatives, which are independent at different arguments.  Moore, Kearfott & Cloud,
Introduction to Interval Analysis, chs. 2, 7.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import reduce
from operator import add, mul
from typing import Any, TypeAlias

import sympy as sp
from mpmath import iv, libmp
from mpmath.ctx_iv import ivmpc
from sympy.core.cache import clear_cache
from sympy.core.evalf import evalf_table, fastlog
from sympy.core.function import AppliedUndef

from lagrotor.algebra.special_enclosures import SPECIAL
from lagrotor.errors import NotExactError

Point: TypeAlias = dict[sp.Expr, sp.Expr]

DIGITS = 120
_MOST_TERMS, _PIECES = 3000, 32  # terms of a sum, pieces of an integral
_LARGEST = 1e6  # argument of a function: larger ones need too many digits
_UNBOUNDED = frozenset({libmp.finf, libmp.fninf, libmp.fnan})  # ends of an interval that is not bounded
_CONSTANTS = {sp.pi: lambda: iv.pi, sp.E: lambda: iv.e, sp.EulerGamma: lambda: iv.euler, sp.I: lambda: iv.mpc(0, 1)}


@contextmanager
def working_digits(number: int) -> Any:
    previous, iv.dps = iv.dps, number
    try:
        yield
    finally:
        iv.dps = previous


def enclosed_at(expression: sp.Expr, point: Point, precision: int = DIGITS) -> Any:
    """Return an interval or complex rectangle that contains the value; raise NotExactError if none is known."""
    with working_digits(precision):
        return PointEnclosure(point).value(expression)


def excludes_zero(value: Any) -> bool:
    """Return True if 0 lies outside an enclosure."""
    return any(0 not in side and side.delta < iv.inf for side in (value.real, value.imag))


def are_apart(lhs: sp.Expr, rhs: sp.Expr, point: Mapping[sp.Expr, Any]) -> bool:
    """Return True if the enclosures of two real sides at a point are disjoint."""
    with working_digits(DIGITS):
        inside = PointEnclosure(point)
        try:
            gap = inside.value(lhs) - inside.value(rhs)
        except (NotExactError, RecursionError):
            return False
        return inside.real and excludes_zero(gap)


def solved_at(A: sp.Matrix, b: sp.Matrix, point: Point) -> list[Any]:
    """Return intervals that contain the solution x of A x = b at a point; raise NotExactError if A may be singular."""
    with working_digits(DIGITS):
        try:
            enclosure = PointEnclosure(point)
            rows = [[_real(enclosure.of(e)) for e in row] for row in A.row_join(b).tolist()]
            return _eliminated(rows)
        except (ArithmeticError, ValueError, libmp.ComplexResult) as error:
            raise NotExactError(f"The value at {point} is not enclosed: {error}.") from None


def apart(first: Sequence[Any], second: Sequence[Any]) -> int | None:
    """Compare two rows of intervals, and return the first index at which they are disjoint; None if each pair overlaps."""
    return next((i for i, (x, y) in enumerate(zip(first, second, strict=True)) if x.b < y.a or y.b < x.a), None)


class PointEnclosure:
    """Enclosures of expressions and of their subexpressions at one point.

    The point gives each symbol a rational value or an interval (lower, upper). `jets` holds the values chosen for undefined
    functions and for their derivatives.
    """

    def __init__(self, point: Mapping[sp.Expr, Any]) -> None:
        self.point = {s: value for s, value in point.items() if not isinstance(value, tuple)}
        boxes = ((s, *value) for s, value in point.items() if s not in self.point)
        self.known: dict[sp.Expr, Any] = {s: iv.mpf([_leaf(low).a, _leaf(high).b]) for s, low, high in boxes}
        self.jets: dict[sp.Expr, sp.Expr] = {}
        self.free: list[tuple[Any, tuple[Any, ...], Any]] = []  # (jet, arguments, value)

    @property
    def real(self) -> bool:
        """True if every enclosed value except i itself is real."""
        return not any(_is_complex(value) for e, value in self.known.items() if e is not sp.I)

    def value(self, e: sp.Expr) -> Any:
        """Return the enclosure of e; raise NotExactError if none is known."""
        try:
            return self.of(e)
        except (ArithmeticError, ValueError, libmp.ComplexResult, TypeError, AttributeError) as error:
            raise NotExactError(f"The value at {self.point} is not enclosed: {error}.") from None

    def of(self, e: sp.Expr) -> Any:
        if e not in self.known:
            value = self._sought(e)
            if not all(map(_UNBOUNDED.isdisjoint, value._mpci_ if _is_complex(value) else (value._mpi_,))):
                raise NotExactError(f"{e} is not enclosed: it is not bounded.")
            self.known[e] = value
        return self.known[e]

    def _sought(self, e: sp.Expr) -> Any:
        if e in self.point:
            return self.of(self.point[e])
        if not e.args:
            return _leaf(e)
        if isinstance(e, sp.Sum | sp.Product):
            return self._repeated(e)
        if isinstance(e, sp.Integral):
            return self._integral(e)
        if isinstance(e, sp.Piecewise):
            return self._piecewise(e)
        if (jet := jet_of(e)) is not None:
            value = self.jets[e] = self._jet(*jet)
            return _leaf(value)
        if e.is_Add or e.is_Mul:
            return reduce(add if e.is_Add else mul, map(self.of, e.args))
        if e.is_Pow:
            exponent = self._order(e.exp)
            return _power(e, self.of(e.base), exponent if exponent.is_Rational else self.of(e.exp))
        if e.func in SPECIAL:
            orders = [self._order(argument) for argument in e.args]
            return SPECIAL[e.func](orders, [self.of(argument) for argument in e.args])
        if e.func not in _FUNCTIONS or len(e.args) != 1:
            raise NotExactError(f"{e.func} is not enclosed.")
        return _FUNCTIONS[e.func](self.of(e.args[0]))

    def _piecewise(self, e: sp.Piecewise) -> Any:
        """Return an interval that contains the values of every piece of a piecewise function that may apply."""
        ends = []
        for piece, condition in e.args:
            holds = self._holds(condition)
            if holds is not False:
                value = _real(self.of(piece))
                ends += [value.a, value.b]
            if holds:
                return iv.mpf([min(end.a for end in ends), max(end.b for end in ends)])
        raise NotExactError(f"{e} is not enclosed: no piece is shown to hold.")

    def _holds(self, condition: sp.Basic) -> bool | None:
        """Return True or False if an equation or inequality is decided at the point; None if it is undecided."""
        if condition in (sp.true, sp.false):
            return bool(condition)
        if isinstance(condition, sp.And | sp.Or):
            whole = isinstance(condition, sp.And)
            answers = [self._holds(clause) for clause in condition.args]
            return None if None in answers and (not whole) not in answers else (all if whole else any)(answers)
        if not isinstance(condition, sp.core.relational.Relational):
            return None
        difference = _real(self.of(condition.lhs - condition.rhs))
        if isinstance(condition, sp.Eq | sp.Ne):
            same = True if difference.a == difference.b == 0 else None if 0 in difference else False
            return same if same is None or isinstance(condition, sp.Eq) else not same
        if isinstance(condition, sp.Lt | sp.Le):
            difference = -difference
        strict = isinstance(condition, sp.Gt | sp.Lt)
        if difference.a > 0 or (difference.a == 0 and not strict):
            return True
        return False if difference.b < 0 or (difference.b == 0 and strict) else None

    def _order(self, e: sp.Expr) -> sp.Expr:
        """Substitute the point into an exponent or order if it is a polynomial in symbols; otherwise return it unchanged."""
        plain = all(n.is_Add or n.is_Mul or n.is_Atom for n in sp.preorder_traversal(e))
        return e.xreplace(dict(self.point)) if plain else e

    def _integral(self, e: sp.Expr) -> Any:
        """Enclose a definite integral. For an undefined function f(u), the values of the antiderivative are free."""
        body, (u, *ends), *others = e.args
        if not others and len(ends) == 2 and not body.has(AppliedUndef, sp.Integral):
            return self._quadrature(body, u, *map(self.of, ends))
        if others or not isinstance(body, AppliedUndef) or body.args != (u,):
            raise NotExactError(f"{e} is not enclosed.")
        values = [self._jet((body.func, (-1,)), (end,)) for end in (ends or [u])]
        if len(values) == 2:
            self.jets[e] = values[1] - values[0]
        return _leaf(values[-1]) - (_leaf(values[0]) if len(values) == 2 else 0)

    def _quadrature(self, body: sp.Expr, u: sp.Symbol, low: Any, high: Any) -> Any:
        """Enclose an integral as a sum over equal pieces: the range of the integrand times the length of the piece."""
        step, total = _real(high - low) / _PIECES, iv.mpf(0)
        for k in range(_PIECES):
            piece = PointEnclosure(self.point)
            ends = low + k * step, low + (k + 1) * step
            piece.known[u] = iv.mpf([min(end.a for end in ends), max(end.b for end in ends)])
            total += _real(piece.of(body)) * step
        return total

    def _repeated(self, e: sp.Expr) -> Any:
        """Enclose a sum or product whose limits are integers."""
        body, (index, low, high), *others = e.args
        start, end = (sp.sympify(side, strict=True).xreplace(dict(self.point)) for side in (low, high))
        if others or not (start.is_Integer and end.is_Integer) or end - start > _MOST_TERMS:
            raise NotExactError(f"{e} is not enclosed.")
        total = iv.mpf(0 if isinstance(e, sp.Sum) else 1)
        for k in range(int(start), int(end) + 1):
            inner = PointEnclosure({**self.point, index: sp.Integer(k)})
            inner.free, inner.jets = self.free, self.jets
            term = inner.of(body.xreplace({index: sp.Integer(k)}))
            total = total + term if isinstance(e, sp.Sum) else total * term
        return total

    def _jet(self, kind: Any, arguments: tuple[sp.Expr, ...]) -> sp.Rational:
        """Return the value chosen for an undefined function or derivative `kind` at some arguments.

        Arguments that may be equal get the same value, all other arguments a new one.
        """
        at = tuple(map(self.of, arguments))
        for earlier, places, value in self.free:
            if earlier == kind and not any(excludes_zero(x - y) for x, y in zip(at, places, strict=True)):
                return value
        k = len(self.free)
        value = sp.Rational(2 * k + 3, 3 * k + 4) + k % 3
        self.free.append((kind, at, value))
        return value


def jet_of(e: sp.Expr) -> tuple[Any, tuple[sp.Expr, ...]] | None:
    """Split a derivative of an undefined function into ((function, derivative orders), arguments); None for anything else."""
    if isinstance(e, sp.Subs):
        inner = jet_of(e.expr)
        if inner is None or not set(e.variables) <= set(inner[1]):
            return None
        replacements = dict(zip(e.variables, e.point, strict=True))
        return inner[0], tuple(a.xreplace(replacements) for a in inner[1])
    if isinstance(e, sp.Derivative):
        inner = e.expr
        if not isinstance(inner, AppliedUndef) or len(set(inner.args)) < len(inner.args):
            return None
        counts = dict(e.variable_count)
        if not set(counts) <= set(inner.args) or not all(c.is_Integer for c in counts.values()):
            return None
        if any(a != c and a.has(c) for a in inner.args for c in counts):
            return None
        return (inner.func, tuple(int(counts.get(a, 0)) for a in inner.args)), inner.args
    if isinstance(e, AppliedUndef):
        return (e.func, (0,) * len(e.args)), e.args
    return None


def _leaf(value: sp.Expr) -> Any:
    if value.is_Rational:
        return iv.mpf(value.p) / value.q
    if value in _CONSTANTS:
        return _CONSTANTS[value]()
    raise NotExactError(f"{value} is not enclosed.")


def _real(x: Any) -> Any:
    if isinstance(x, ivmpc):
        raise NotExactError("A complex value is not enclosed.")
    return x


def _is_complex(x: Any) -> bool:
    return isinstance(x, ivmpc)


def _power(e: sp.Expr, base: Any, exponent: Any) -> Any:
    if isinstance(exponent, sp.Rational):
        if exponent.is_Integer:
            if abs(exponent) > _LARGEST:
                raise NotExactError(f"{e} is not enclosed: its exponent is too large.")
            return base ** int(exponent) if exponent > 0 else 1 / base ** int(-exponent)
        if exponent.q == 2:
            return _power(e, _sqrt(base), sp.Integer(exponent.p))
        exponent = iv.mpf(exponent.p) / exponent.q
    if not _is_complex(base) and not _is_complex(exponent) and base.a == base.b == 0 and exponent.a > 0:
        return iv.mpf(0)
    return _exp(exponent * _log(base))


def _exp(x: Any) -> Any:
    if abs(x).b > _LARGEST:
        raise NotExactError("An argument of exp is too large.")
    return iv.exp(x)


def _log(x: Any) -> Any:
    """Return the principal logarithm. On the branch cut, the negative real axis, its imaginary part is π."""
    if not _is_complex(x):
        if x.a > 0:
            return iv.log(x)
        if x.b < 0:
            return iv.mpc(iv.log(-x), iv.pi)
        raise NotExactError("A logarithm of an interval that holds 0 is not enclosed.")
    if 0 in x.real and 0 in x.imag:
        raise NotExactError("A logarithm of a rectangle that holds 0 is not enclosed.")
    return iv.log(x)


def _sqrt(x: Any) -> Any:
    if not _is_complex(x):
        if x.a >= 0:
            return iv.sqrt(x)
        if x.b < 0:
            return iv.mpc(0, iv.sqrt(-x))
        raise NotExactError("A root of an interval that holds 0 is not enclosed.")
    return iv.exp(_log(x) / 2)


def _atan(x: Any) -> Any:
    if not _is_complex(x):
        return iv.make_mpf(libmp.mpi_atan(x._mpi_, iv.prec))
    i = iv.mpc(0, 1)
    return i * (_log(1 - i * x) - _log(1 + i * x)) / 2


def _asin(x: Any) -> Any:
    """Return asin; on the branch cuts x > 1 and x < −1 it has the same value as in sympy."""
    if not _is_complex(x):
        if x.a > 1 or x.b < -1:
            return iv.pi / 2 - _acos(x)
        if not (x.a >= -1 and x.b <= 1):
            raise NotExactError("asin is not enclosed at the ends of [-1, 1].")
        side = 1 - x * x
        root = iv.sqrt(iv.mpf([max(side.a, iv.mpf(0).a), side.b]))
        return iv.make_mpf(libmp.mpi_atan2(x._mpi_, root._mpi_, iv.prec))
    if 0 in x.imag:
        raise NotExactError("asin is not enclosed near its cut.")
    i = iv.mpc(0, 1)
    return -i * _log(i * x + _sqrt(1 - x * x))


def _acos(x: Any) -> Any:
    """Return acos: real in [−1, 1], i acosh(x) for x > 1, π − i acosh(−x) for x < −1."""
    if _is_complex(x) or (x.a >= -1 and x.b <= 1):
        return iv.pi / 2 - _asin(x)
    return iv.mpc(0, _acosh(x)) if x.a > 1 else iv.pi - iv.mpc(0, _acosh(-x)) if x.b < -1 else _unknown("acos")


def _acosh(x: Any) -> Any:
    if _is_complex(x) or x.a < -1:
        return _unknown("acosh")
    if x.b < 1:
        return iv.mpc(0, 1) * (iv.pi / 2 - _asin(x))
    return _log(x + iv.sqrt(x * x - 1)) if x.a >= 1 else _unknown("acosh")


def _unknown(name: str) -> Any:
    raise NotExactError(f"{name} is not enclosed here.")


def _sin(x: Any) -> Any:
    return iv.sin(x) if abs(x).b < _LARGEST else _unknown("sin")


def _cos(x: Any) -> Any:
    return iv.cos(x) if abs(x).b < _LARGEST else _unknown("cos")


def _tanh(x: Any) -> Any:
    return 1 - 2 / (_exp(2 * x) + 1)


_FUNCTIONS: dict[Any, Any] = {
    sp.sin: _sin, sp.cos: _cos, sp.tan: lambda x: _sin(x) / _cos(x), sp.cot: lambda x: _cos(x) / _sin(x),
    sp.sec: lambda x: 1 / _cos(x), sp.csc: lambda x: 1 / _sin(x), sp.exp: _exp, sp.log: _log,
    sp.sinh: lambda x: (_exp(x) - _exp(-x)) / 2, sp.cosh: lambda x: (_exp(x) + _exp(-x)) / 2, sp.tanh: _tanh,
    sp.coth: lambda x: 1 / _tanh(x), sp.sech: lambda x: 2 / (_exp(x) + _exp(-x)),
    sp.csch: lambda x: 2 / (_exp(x) - _exp(-x)), sp.asin: _asin, sp.acos: _acos, sp.atan: _atan,
    sp.acot: lambda x: _atan(1 / x), sp.asec: lambda x: iv.pi / 2 - _asin(1 / x), sp.acsc: lambda x: _asin(1 / x),
    sp.asinh: lambda x: _unknown("asinh") if _is_complex(x) else _log(x + iv.sqrt(x * x + 1)), sp.acosh: _acosh,
    sp.atanh: lambda x: (
        (_log(1 + x) - _log(1 - x)) / 2 if not _is_complex(x) and x.a > -1 and x.b < 1 else _unknown("atanh")
    ),
    sp.Abs: lambda x: iv.sqrt(x.real * x.real + x.imag * x.imag) if _is_complex(x) else abs(x),
    sp.sign: lambda x: iv.mpf(1) if _real(x).a > 0 else iv.mpf(-1) if x.b < 0 else _unknown("sign"),
    sp.re: lambda x: x.real, sp.im: lambda x: x.imag,
    sp.conjugate: lambda x: iv.mpc(x.real, -x.imag) if _is_complex(x) else x,
}  # fmt: skip


def _eliminated(rows: list[list[Any]]) -> list[Any]:
    """Return the solution x of A x = b by elimination; each row has the entries of a row of A, then the entry of b."""
    n = len(rows)
    for j in range(n):
        pivot = max(range(j, n), key=lambda i: abs(rows[i][j].mid))
        rows[j], rows[pivot] = rows[pivot], rows[j]
        if 0 in rows[j][j]:
            raise NotExactError("The matrix is not shown to be regular.")
        for i in range(j + 1, n):
            factor = rows[i][j] / rows[j][j]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[j], strict=True)]
    unknowns: list[Any] = []
    for row in reversed(rows):
        coefficients = row[n - len(unknowns) : n]
        sum_ = sum((a * x for a, x in zip(coefficients, reversed(unknowns), strict=True)), iv.mpf(0))
        unknowns.append((row[n] - sum_) / row[n - len(unknowns) - 1])
    return unknowns[::-1]


Bounds: TypeAlias = tuple[sp.Rational, sp.Rational]  # lower, upper


def enclosure(e: sp.Expr, point: Mapping[sp.Symbol, Any]) -> Bounds | None:
    """Return rational bounds of e at a point with coordinates that are rationals or pairs (lower, upper); None if unknown."""
    return enclosures([e], point)[0]


def enclosures(expressions: Iterable[sp.Expr], point: Mapping[sp.Symbol, Any]) -> list[Bounds | None]:
    """Return the enclosure of each expression; common subexpressions are enclosed once."""
    with working_digits(DIGITS):
        at_point = PointEnclosure(point)

        def bounds(e: sp.Expr) -> Bounds | None:
            try:
                value = at_point.value(e)
                return None if _is_complex(value) else (_rational(value.real.a), _rational(value.real.b))
            except NotExactError:
                return None

        return [bounds(e) for e in expressions]


def _evalf(e: sp.Expr, precision: int, options: Any) -> tuple[Any, ...]:
    """Return (re, im, bits of re, bits of im), as sympy's `evalf_table` requires.

    If there is no enclosure, the value of sympy is used.
    """
    sides = None
    for number in (precision, 2 * precision + 60, 4 * precision + 600):
        with working_digits(number), suppress(NotExactError, RecursionError):
            value = PointEnclosure({}).value(e)
            sides = [_significant(side, precision) for side in (value.real, value.imag)]
            if all(middle is None or bits >= precision for middle, bits in sides):
                break
    if sides is None:
        return _WITHOUT[type(e)](e, precision, options)  # after a KeyError evalf uses its next method
    (re, re_bits), (im, im_bits) = sides
    return re, im, re_bits, im_bits


def _significant(interval: Any, precision: int) -> tuple[Any, Any]:
    """Return the midpoint of a real interval and the number of its certain bits; (None, None) for the interval 0."""
    if interval.a == interval.b == 0:
        return None, None
    middle, width = interval.mid._mpi_[0], interval.delta._mpi_[1]
    if 0 in interval:
        return width, 0
    bits = precision if width == libmp.fzero else min(fastlog(middle) - fastlog(width), precision)
    return libmp.mpf_pos(middle, precision, "n"), bits


def _rational(end: Any) -> sp.Rational:
    """Return the end of an interval, which is a binary fraction, as a rational number."""
    sign, mantissa, exponent, _ = end._mpi_[0]
    return (-1) ** sign * sp.Integer(int(mantissa)) * sp.Integer(2) ** int(exponent)


# sympy determines signs of numbers, and zeros of their sines, by evalf, which first rounds the argument of a function to a few
# bits: acosh(1 + 1e-8) becomes 0. These entries make such signs certain; signs computed earlier are discarded.
_WITHOUT = dict(evalf_table)
evalf_table.update(dict.fromkeys((_FUNCTIONS.keys() | SPECIAL.keys()) - evalf_table.keys() | {sp.log, sp.tan}, _evalf))
clear_cache()
