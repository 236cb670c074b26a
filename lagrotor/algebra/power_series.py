"""Truncated power series in a small quantity, and the first order at which two expressions differ.

With e the small quantity, a series (Laurent for q = 1, Puiseux otherwise) is stored as the finitely many terms

    e**(start/q) * (a_0 + a_1*e**(1/q) + ... + a_(n-1)*e**((n-1)/q)) + o(e**((start + n - 1)/q)).

A function is expanded about the value u0 of its argument: f(u0 + v) = sum of f^(m)(u0) * v**m / m!, where v vanishes with e.
For u = e**s * w with w nonzero at e = 0,

    u**a = e**(s*a) * w**a,    log u = s*log(e) + log w,

with a separate symbol for log(e).  tan, cot, sec, csc and their hyperbolic counterparts are quotients where they have a pole.
Except for roots and logarithms, a function whose argument is unbounded at e = 0 has no such series.

At a logarithm, root or inverse function, u0 (for roots and logarithms w) must lie off the branch cut, or the argument must stay
on the real line; e and symbols without assumptions are taken to be real.  If e may be negative, the formulas above require
0 < s <= 1 and w > 0: sqrt(e**2) has a series in e only if e is declared positive.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from math import ceil, floor, lcm
from typing import NamedTuple

import sympy as sp

from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.evidence import magnitude_at, points
from lagrotor.algebra.identity import decide_zero
from lagrotor.algebra.scalar import scalar
from lagrotor.errors import InputError, NotExactError

# Analytic wherever they are finite, real for real arguments: Taylor expansion is valid.
_ANALYTIC = (
    sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc,
    sp.sinh, sp.cosh, sp.tanh, sp.coth, sp.sech, sp.csch, sp.exp,
)  # fmt: skip
# Branch cuts: the imaginary axis beyond ±i; the real axis beyond ±1. Logarithms and powers: the negative real axis.
_CUT, _CUT_BEYOND_ONE = (sp.atan, sp.asinh), (sp.asin, sp.acos, sp.atanh)
# Orders added when division by powers of the small quantity loses terms, per attempt and at most; the largest q.
_MARGIN, _MOST_LOST, _MOST_ROOTS = 8, 24, 24
_ARGUMENT = sp.Dummy("z")  # one argument for all functions, so that sympy's cache keeps their derivatives
_LOG = sp.Dummy("log", real=True)  # the logarithm of the small quantity
_KNOWN = (sp.Add, sp.Mul, sp.Pow, *_ANALYTIC, *_CUT, *_CUT_BEYOND_ONE, sp.log, sp.acosh)
# Numerator and denominator of the functions with poles.
QUOTIENTS = {
    sp.tan: (sp.sin, sp.cos), sp.cot: (sp.cos, sp.sin), sp.sec: (None, sp.cos), sp.csc: (None, sp.sin),
    sp.tanh: (sp.sinh, sp.cosh), sp.coth: (sp.cosh, sp.sinh), sp.sech: (None, sp.cosh), sp.csch: (None, sp.sinh),
}  # fmt: skip
# Well above the rounding error of a value with more than 30 digits.
_CLEARLY_NONZERO = 1e-15


@dataclass(frozen=True)
class LeadingTerm:
    """The first nonvanishing term coefficient * small**order of a series.

    Attributes
    ----------
    order : int, Rational or None
        The order; a Rational about a branch point, None if every term below small**(through + 1) vanishes.
    coefficient : Expr
        The coefficient; about a logarithmic point it contains log(small).
    through : int
        The highest order that was examined.

    Examples
    --------
    >>> from sympy import sqrt, symbols
    >>> x = symbols("x", positive=True)
    >>> leading_term(sqrt(x) + x, x).order, leading_term(x - x, x).vanishes_through
    (1/2, 8)
    """

    order: int | sp.Rational | None
    coefficient: sp.Expr
    through: int

    @property
    def vanishes_through(self) -> int:
        """The largest integer n for which the series is o(small**n), as far as it was examined."""
        return self.through if self.order is None else ceil(self.order) - 1


def truncated_series(expression: sp.Expr, small: sp.Symbol, order: int) -> sp.Expr:
    """Return the series of an expression through an order, with its principal part.

    Parameters
    ----------
    expression : Expr
        A scalar expression.
    small : Symbol
        The symbol in which it is expanded, about 0.
    order : int
        The highest power of `small`.

    Returns
    -------
    Expr
        The sum of the terms, without O().

    Raises
    ------
    NotExactError
        If the expression is not known to have a series at small = 0.
    InputError
        If the arguments are not a scalar expression, a symbol and an integer.

    Examples
    --------
    >>> from sympy import cos, sin, symbols
    >>> x = symbols("x")
    >>> truncated_series(cos(x)/sin(x), x, 3)
    -x**3/45 - x/3 + 1/x
    """
    terms = [
        sp.expand_mul(coefficient.xreplace({_LOG: sp.log(small)})) * small**power
        for power, coefficient in _terms(scalar(expression, "truncated_series"), small, order)
        if power <= order and decide_zero(coefficient).answer != "zero"
    ]
    return sp.Add(*terms)


def leading_term(expression: sp.Expr, small: sp.Symbol, through: int = 8) -> LeadingTerm:
    """Return the first nonvanishing term of a series.

    Parameters
    ----------
    expression : Expr
        A scalar expression.
    small : Symbol
        The symbol in which it is expanded, about 0.
    through : int, default 8
        The highest order examined, including terms small**(through + 1) * log(small)**k.

    Returns
    -------
    LeadingTerm
        The term; its order is None if the expression is O(small**(through + 1)).

    Raises
    ------
    NotExactError
        If a coefficient is undecided, or the expression has no series at small = 0.

    Examples
    --------
    >>> from sympy import sin, symbols
    >>> x = symbols("x")
    >>> leading_term(x - sin(x), x)
    LeadingTerm(order=3, coefficient=1/6, through=8)
    """
    for power, coefficient in _terms(scalar(expression, "leading_term"), small, through):
        decision = decide_zero(coefficient)
        coefficient = coefficient.xreplace({_LOG: sp.log(small)})
        if decision.answer == "undecided" or decision.partly:
            raise NotExactError(f"coefficient {coefficient} of {small}**{power} is undecided: {decision.reason}")
        if decision.answer == "nonzero":
            return LeadingTerm(power, sp.expand_mul(coefficient), through)
    return LeadingTerm(None, sp.S.Zero, through)


def agreement_order(printed: sp.Expr, derived: sp.Expr, small: sp.Symbol, through: int = 8) -> LeadingTerm:
    """Return the leading term of printed - derived; both agree through order `vanishes_through`.

    The order is absolute even if the sides have a pole: 1/sin(e) and 1/e agree through order 0 and differ by e/6.

    Parameters
    ----------
    printed : Expr
        The first expression.
    derived : Expr
        The second expression.
    small : Symbol
        The symbol in which both are expanded, about 0.
    through : int, default 8
        The highest order examined.

    Returns
    -------
    LeadingTerm
        The leading term of the difference.

    Raises
    ------
    NotExactError
        If a coefficient is undecided, or the difference has no series at small = 0.

    Examples
    --------
    >>> from sympy import cos, symbols
    >>> x = symbols("x")
    >>> agreement_order(cos(x), 1 - x**2/2, x).vanishes_through
    3
    """
    return leading_term(scalar(printed, "agreement_order") - scalar(derived, "agreement_order"), small, through)


class _Series(NamedTuple):
    """A truncated series: the coefficients of small**(start/q), small**((start + 1)/q), …. Later terms are unknown.

    `real` is True if every coefficient except the constant one, known or unknown, is real.
    """

    start: int
    terms: tuple[sp.Expr, ...]
    q: int = 1
    real: bool = True

    @property
    def end(self) -> int:
        return self.start + len(self.terms)

    def at(self, power: int) -> sp.Expr:
        return self.terms[power - self.start] if self.start <= power else sp.S.Zero

    def led_by(self, first: sp.Expr) -> _Series:
        """Return the series with `first` in place of its first coefficient."""
        return self._replace(terms=(first, *self.terms[1:]))


def _terms(expression: sp.Expr, small: sp.Symbol, order: int) -> list[tuple[int | sp.Rational, sp.Expr]]:
    """Return the pairs (power, coefficient) below small**(order + 1), and the logarithmic terms at small**(order + 1)."""
    if not getattr(small, "is_Symbol", False) or isinstance(order, bool) or not isinstance(order, int):
        raise InputError(f"series: small = {small!r} must be a symbol and the order {order!r} a whole number")
    logarithms = [log.args[0] for log in expression.atoms(sp.log)]
    logarithms += [power.base for power in expression.atoms(sp.Pow) if power.exp.has(small)]
    beyond = order + 1 + any(argument.has(small) for argument in logarithms)
    length, longest = max(beyond, 1), max(beyond, 1) + _MOST_LOST
    while length <= longest:
        try:
            series = _expanded(expression, small, length)
        except _TooShortError:
            length += _MARGIN
            continue
        if series.end >= beyond * series.q:
            powers = [sp.Rational(power, series.q) for power in range(series.start, beyond * series.q)]
            terms = [(int(n) if n.is_Integer else n, series.at(series.start + k)) for k, n in enumerate(powers)]
            return [(n, term) for n, term in terms if n < order + 1 or (n == order + 1 and term.has(_LOG))]
        length += beyond - floor(series.end / series.q)
    raise NotExactError(f"division by powers of {small} leaves too few terms of {expression}")


class _TooShortError(Exception):
    """All computed terms of a series vanish, so that more terms are needed to find the leading one."""


def _expanded(node: sp.Expr, small: sp.Symbol, length: int) -> _Series:
    """Expand the node to `length` orders, or to fewer if terms cancel in a denominator."""
    if not node.has(small):
        return _Series(0, _padded([node], length), real=_is_real(node))
    if node == small:
        return _Series(1, _padded([sp.S.One], length))
    if not isinstance(node, _KNOWN):
        raise NotExactError(f"{node} is not known to be analytic in {small}")
    arguments = [_expanded(argument, small, length) for argument in node.args]
    if node.is_Mul:
        return reduce(_times, arguments)
    if node.is_Add:
        real = all(argument.real for argument, term in zip(arguments, node.args, strict=True) if term.has(small))
        return reduce(_plus, arguments)._replace(real=real)
    if node.is_Pow:
        return _of_power(node, arguments[0], arguments[1], small)
    return _of_function(node, arguments[0], small, length)


def _of_power(node: sp.Expr, base: _Series, exponent: _Series, small: sp.Symbol) -> _Series:
    """Return base**exponent; if both depend on small, it is exp(exponent * log(base))."""
    z = _ARGUMENT
    if not node.exp.has(small):
        whole = node.exp.is_Integer and node.exp > 0
        return _power(base, int(node.exp)) if whole else _of_constant_power(node, _stripped(base), small)
    if not node.base.has(small):
        power = _composed(node.base**z, z, _regular(node, exponent, small))
        return power._replace(real=power.real and bool(node.base.is_positive))
    exponent = _times(exponent, _logarithm(node, _stripped(base), small))
    return _composed(sp.exp(z), z, _regular(node, exponent, small))


def _of_function(node: sp.Expr, argument: _Series, small: sp.Symbol, length: int) -> _Series:
    if isinstance(node, sp.log):
        return _logarithm(node, _stripped(argument), small)
    z, inner = _ARGUMENT, _regular(node, argument, small)
    if isinstance(node, sp.acosh) or (isinstance(node, sp.asin | sp.acos) and _vanishes(1 - inner.terms[0] ** 2)):
        return _expanded(_from_branch_point(node, inner.terms[0]), small, length)
    if not isinstance(node, _ANALYTIC):
        _check_cut(node, inner, small)
    above, below = QUOTIENTS.get(node.func, (None, None))
    if below is not None and _vanishes(below(inner.terms[0])):
        inverse = _inverse(_composed(below(z), z, inner))
        return inverse if above is None else _times(_composed(above(z), z, inner), inverse)
    return _composed(node.func(z), z, inner)


def _from_branch_point(node: sp.Expr, u0: sp.Expr) -> sp.Expr:
    """Rewrite acos, asin or acosh near a branch point, u0 = ±1, where these functions have no Taylor series.

    The result contains asin or asinh of a root: acos u = 2 asin √((1 − u)/2), acosh u = 2 asinh √((u − 1)/2).
    """
    u = node.args[0]
    if isinstance(node, sp.acosh):
        return 2 * sp.asinh(sp.sqrt((u - 1) / 2))
    right = _vanishes(1 - u0)
    acos = 2 * sp.asin(sp.sqrt((1 - u if right else 1 + u) / 2))
    acos = acos if right else sp.pi - acos
    return acos if isinstance(node, sp.acos) else sp.pi / 2 - acos


def _of_constant_power(node: sp.Expr, base: _Series, small: sp.Symbol) -> _Series:
    """Return the series of base**a for a constant a. For base = small**s * w it is small**(s*a) * w**a."""
    if base.start and not node.exp.is_Rational:
        raise NotExactError(f"{node} is singular at {small} = 0, and its exponent is no rational number")
    if not node.exp.is_Integer:
        _check_cut(node, base, small)
    shift = node.exp * sp.Rational(base.start, base.q) if base.start else sp.S.Zero
    power = _composed(_ARGUMENT**node.exp, _ARGUMENT, base._replace(start=0))
    power = _refined(power, lcm(base.q, int(shift.q)))
    real = power.real and (node.exp.is_Integer or _is_positive(base, small))
    return power._replace(start=int(shift * power.q), real=real)


def _is_positive(base: _Series, small: sp.Symbol) -> bool:
    """Return True if a real series is certainly positive for small values."""
    return bool(base.terms[0].is_positive and (small.is_extended_nonnegative or not base.start))


def _inverse(series: _Series) -> _Series:
    series = _stripped(series)
    return _composed(1 / _ARGUMENT, _ARGUMENT, series._replace(start=0))._replace(start=-series.start)


def _logarithm(node: sp.Expr, base: _Series, small: sp.Symbol) -> _Series:
    """Return the series of log(base). For base = small**s * w it is s*log(small) + log w."""
    _check_cut(node, base, small)
    series = _composed(sp.log(_ARGUMENT), _ARGUMENT, base._replace(start=0))
    series = series._replace(real=series.real and _is_positive(base, small))
    return series.led_by(series.terms[0] + sp.Rational(base.start, base.q) * _LOG)


def _composed(function: sp.Expr, z: sp.Symbol, inner: _Series) -> _Series:
    """Return the series of f(u0 + v), the sum of f^(m)(u0) * v**m / m!, where the inner series is u0 + v."""
    length, u0 = len(inner.terms), inner.terms[0]
    if u0.has(_LOG):
        raise NotExactError(f"{function} of an argument whose leading term is a logarithm has no series")
    v = inner.led_by(sp.S.Zero)
    power = inner._replace(terms=_padded([sp.S.One], length))
    total = inner._replace(terms=(sp.S.Zero,) * length)
    for m in range(length):
        if all(term is sp.S.Zero for term in power.terms):
            break
        value = function.subs(z, u0) / sp.factorial(m)
        if value.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
            raise NotExactError(f"{function} is singular at {z} = {u0}")
        total = _plus(total, inner._replace(terms=tuple(_product(value, term) for term in power.terms)))
        power = _times(power, v)
        function = derivative(function, z)
    return total._replace(real=inner.real and _is_real(u0))


def _check_cut(node: sp.Expr, inner: _Series, small: sp.Symbol) -> None:
    """Raise NotExactError unless the argument is off the branch cut at small = 0, or stays on the real line."""
    u0, *tail = inner.terms
    one_sided = bool(small.is_extended_nonnegative)
    on_line = False
    if isinstance(node, _CUT):
        off_cut = _is_real(u0) or u0.is_imaginary is False or (1 + u0**2).is_positive
    elif isinstance(node, _CUT_BEYOND_ONE):
        off_cut = u0.is_extended_real is False or (u0.is_extended_real and (1 - u0**2).is_positive)
    else:
        off_cut = u0.is_positive or u0.is_extended_real is False
        on_line = inner.real and all(map(_is_real, tail))
    if inner.start and not one_sided:
        first_order = inner.start < inner.q or (inner.start == inner.q and on_line)
        if not (u0.is_positive and inner.start > 0 and first_order):
            raise NotExactError(
                f"{node} is singular at {small} = 0, and its branch depends on the sign of {small}: declare it positive"
            )
    if not (off_cut or on_line):
        raise NotExactError(
            f"{node} may lie on a branch cut: its argument is {u0} at {small} = 0 and may be complex beside it"
        )


def _is_real(node: sp.Expr) -> bool:
    """Return True if the expression is real wherever it is finite; symbols without assumptions count as real."""
    if node.is_Symbol:
        return node.is_extended_real is not False and node.is_imaginary is not True
    if node.is_extended_real:
        return True
    if node.is_Pow and not node.exp.is_Integer:
        return bool(node.base.is_nonnegative) and _is_real(node.exp)
    is_known = node.is_Add or node.is_Mul or node.is_Pow or isinstance(node, (*_ANALYTIC, *_CUT))
    return is_known and all(map(_is_real, node.args))


def _refined(series: _Series, q: int) -> _Series:
    """Return the same series in powers of small**(1/q), where q is a multiple of the q of the given series."""
    if q > _MOST_ROOTS:
        raise NotExactError(
            f"powers with the common denominator {q} are not expanded: the largest one allowed is {_MOST_ROOTS}"
        )
    factor = q // series.q
    terms = tuple(coefficient for term in series.terms for coefficient in _padded([term], factor))
    return series._replace(start=series.start * factor, terms=terms, q=q)


def _plus(a: _Series, b: _Series) -> _Series:
    q = lcm(a.q, b.q)
    a, b = _refined(a, q), _refined(b, q)
    start, end = min(a.start, b.start), min(a.end, b.end)
    return _Series(start, tuple(a.at(power) + b.at(power) for power in range(start, end)), q, a.real and b.real)


def _times(a: _Series, b: _Series) -> _Series:
    q = lcm(a.q, b.q)
    a, b = _refined(a, q), _refined(b, q)
    terms = (sp.Add(*map(_product, a.terms[: k + 1], b.terms[k::-1])) for k in range(min(len(a.terms), len(b.terms))))
    real = a.real and b.real and _is_real(a.terms[0]) and _is_real(b.terms[0])
    return _Series(a.start + b.start, tuple(terms), q, real)


def _product(a: sp.Expr, b: sp.Expr) -> sp.Expr:
    """Return a b; sympy's product with zero is slow, since it examines whether the other factor is finite."""
    return sp.S.Zero if a is sp.S.Zero or b is sp.S.Zero else a * b


def _power(base: _Series, times: int) -> _Series:
    """Return base**times by repeated squaring, times > 0."""
    half = _power(base, times // 2) if times > 1 else base
    squared = _times(half, half) if times > 1 else base
    return _times(squared, base) if times % 2 and times > 1 else squared


def _padded(terms: list[sp.Expr], length: int) -> tuple[sp.Expr, ...]:
    return (*terms, *[sp.S.Zero] * (length - len(terms)))


def _stripped(series: _Series) -> _Series:
    """Drop leading terms that vanish; raise _TooShortError if all known terms do."""
    for place, term in enumerate(series.terms):
        if not _vanishes(term):
            return series._replace(start=series.start + place, terms=series.terms[place:])
    raise _TooShortError


def _regular(node: sp.Expr, series: _Series, small: sp.Symbol) -> _Series:
    """Return the series of the node's argument with start = 0; raise NotExactError if it has a negative power."""
    for power in range(series.start, min(series.end, 0)):
        if not _vanishes(series.at(power)):
            negative = sp.Rational(power, series.q)
            raise NotExactError(
                f"{node} has an essential singularity or a jump at {small} = 0: its argument has the negative power {negative}"
            )
    if series.end <= 0:
        raise _TooShortError
    first = sp.S.Zero if _vanishes(series.at(0)) else series.at(0)
    return series._replace(start=0, terms=(first, *(series.at(power) for power in range(1, series.end))))


def _vanishes(coefficient: sp.Expr) -> bool:
    decision = decide_zero(coefficient)
    if decision.answer == "undecided":
        sizes = [magnitude_at(coefficient, point) for point in points(coefficient.free_symbols)]
        clear = min((size for size in sizes if size is not None), default=0) > _CLEARLY_NONZERO
    if decision.partly or (decision.answer == "undecided" and not clear):
        raise NotExactError(f"cannot tell whether {coefficient} vanishes: {decision.reason}")
    return decision.answer == "zero"
