"""Exact decision whether a trigonometric-rational expression vanishes identically.

The class: sums, products and integer powers of symbols, rationals, pi, i and square roots of integers, and of

    sin, cos, tan, cot, sec, csc, sinh, cosh, tanh, coth, sech, csch, exp

whose arguments are rational combinations of monomials in the symbols (x, x/2, omega*t), the circular ones also of
rational multiples of pi.  Every angle is a whole multiple of a base angle u, one for each monomial, so by the
addition theorems everything is a quotient of polynomials in the generators, subject to

    sin(u)**2 = 1 - cos(u)**2,    sinh(u)**2 = cosh(u)**2 - 1,    sqrt(p)**2 = p,    i**2 = -1.

Exponentials of rationally independent monomials are algebraically independent over the rational functions, hence
there are no other relations, the quotient ring has no zero divisors, and a quotient vanishes identically if and only
if its numerator, reduced to degree below two in every squared generator, is the zero polynomial.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import reduce
from typing import Any, Literal, NamedTuple

import sympy as sp
from mpmath import mp
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.errors import NotExactError

Pair = tuple[PolyElement, PolyElement]

# Cosine and sine of the circular (False) and the hyperbolic (True) family.
_FAMILY: dict[bool, tuple[Any, Any]] = {False: (sp.cos, sp.sin), True: (sp.cosh, sp.sinh)}
# Each function as numerator and denominator in the pair (cosine, sine): 0 is the cosine, 1 the sine, None is one.
_CIRCULAR: dict[Any, tuple[int | None, int | None]] = {
    sp.cos: (0, None), sp.sin: (1, None), sp.tan: (1, 0), sp.cot: (0, 1), sp.sec: (None, 0), sp.csc: (None, 1),
}  # fmt: skip
_HYPERBOLIC: dict[Any, tuple[int | None, int | None]] = {
    sp.cosh: (0, None), sp.sinh: (1, None), sp.tanh: (1, 0), sp.coth: (0, 1), sp.sech: (None, 0), sp.csch: (None, 1),
}  # fmt: skip
_POINTS = 8
_DIGITS = 34


@dataclass(frozen=True)
class Decision:
    """Whether an expression vanishes identically, where that holds, and what shows it.

    `domain` holds the factors that must not vanish; `witness` is a point where a nonzero expression does not vanish,
    and `evidence` the largest absolute value seen at random points, for nonzero and undecided expressions.
    """

    answer: Literal["zero", "nonzero", "undecided"]
    domain: tuple[sp.Expr, ...]
    reason: str
    witness: Mapping[sp.Symbol, sp.Rational] | None = None
    evidence: float | None = None


def decide_zero(expression: sp.Expr) -> Decision:
    """Decide expression = 0 exactly; outside the class, or with floats in it, the answer is "undecided"."""
    expression = sp.sympify(expression)
    try:
        chart = _chart(expression)
        numerator = _quotient(chart, expression).numerator
    except NotExactError as refusal:
        return Decision("undecided", (), str(refusal), evidence=_largest_value(expression)[1])
    domain = _domain(chart)
    if not numerator:
        return Decision("zero", domain, "The reduced numerator is the zero polynomial.")
    leading = chart.ring.from_dict(dict([numerator.terms()[0]])).as_expr()
    reason = f"The reduced numerator is not zero: terms {len(numerator)}, the leading one {leading}."
    return Decision("nonzero", domain, reason, *_largest_value(expression))


def decide_equal(left: sp.Expr | sp.MatrixBase, right: sp.Expr | sp.MatrixBase) -> Decision:
    """Decide left = right exactly; matrices are equal if every entry is, and unequal if any is.

    Raises ValueError when the two differ in shape.
    """
    left, right = sp.sympify(left), sp.sympify(right)
    shapes = getattr(left, "shape", ()), getattr(right, "shape", ())
    if shapes[0] != shapes[1]:
        raise ValueError(f"shapes {shapes[0]} and {shapes[1]} cannot be compared")
    if not isinstance(left, sp.MatrixBase):
        return decide_zero(left - right)
    entries = [decide_zero(a - b) for a, b in zip(left, right, strict=True)]
    domain = tuple(dict.fromkeys(factor for entry in entries for factor in entry.domain))
    for answer in ("nonzero", "undecided"):
        for place, entry in enumerate(entries):
            if entry.answer == answer:
                row, column = divmod(place, left.cols)
                reason = f"Entry ({row + 1}, {column + 1}): {entry.reason}"
                return Decision(entry.answer, domain, reason, entry.witness, entry.evidence)
    return Decision("zero", domain, "The reduced numerator of every entry is the zero polynomial.")


def normal_form(expression: sp.Expr) -> sp.Expr:
    """Return the expression as a coprime quotient P/Q in sin and cos of the base angles.

    P is of degree below two in every squared generator and Q is free of them, which makes P/Q unique for given base
    angles (x itself, or x/n if the expression has n-th parts of x).  Raises NotExactError outside the class.
    """
    expression = sp.sympify(expression)
    chart = _chart(expression)
    numerator, factors = _quotient(chart, expression)
    denominator = _expanded(chart, factors)
    for index, _ in chart.rules:
        # A + B*g times its conjugate A - B*g is free of g.
        conjugate = chart.ring.from_dict({m: -c if m[index] else c for m, c in denominator.terms()})
        if conjugate != denominator:
            numerator = _reduced(chart, numerator * conjugate)
            denominator = _reduced(chart, denominator * conjugate)
    numerator, denominator = numerator.cancel(denominator)
    return numerator.as_expr() / denominator.as_expr()


class _Quotient(NamedTuple):
    """numerator / product of factor**exponent; the factors are kept apart so that common ones are seen."""

    numerator: PolyElement
    factors: dict[PolyElement, int]


@dataclass(frozen=True)
class _Chart:
    """The polynomial ring of an expression, its rules g**2 = square, and every factor it divides by."""

    ring: PolyRing
    generators: dict[sp.Expr, PolyElement]
    steps: dict[tuple[bool, sp.Expr], int]
    rules: tuple[tuple[int, PolyElement], ...]
    divisors: dict[PolyElement, sp.Expr | None] = field(default_factory=dict)
    known: dict[sp.Expr, _Quotient] = field(default_factory=dict)


def _chart(expression: sp.Expr) -> _Chart:
    """Find the generators: symbols, constants, and a cosine and sine of monomial/n, n the lcm of all denominators."""
    if floats := expression.atoms(sp.Float):
        raise NotExactError(f"The floating-point number {min(floats)} is not exact.")
    atoms: set[sp.Expr] = set()
    steps: dict[tuple[bool, sp.Expr], int] = {}
    _survey(expression, atoms, steps, set())
    squares: dict[sp.Expr, sp.Expr] = {atom: atom**2 for atom in atoms if not (atom.is_Symbol or atom is sp.pi)}
    for (hyperbolic, monomial), step in steps.items():
        c, s = (part(monomial / step) for part in _FAMILY[hyperbolic])
        atoms |= {c, s}
        squares[s] = c**2 - 1 if hyperbolic else 1 - c**2
    symbols = sorted(atoms, key=sp.default_sort_key)
    ring = PolyRing(symbols or [sp.Dummy()], sp.QQ)
    rules = tuple((i, ring.from_expr(squares[g])) for i, g in enumerate(symbols) if g in squares)
    return _Chart(ring, dict(zip(symbols, ring.gens, strict=False)), steps, rules)


def _survey(node: sp.Expr, atoms: set[sp.Expr], steps: dict[tuple[bool, sp.Expr], int], seen: set[sp.Expr]) -> None:
    """Collect atoms and base angles of everything below the node; raise NotExactError outside the class."""
    if node in seen:
        return
    seen.add(node)
    if (node.is_Symbol and node.is_commutative) or node in (sp.pi, sp.I):
        atoms.add(node)
    elif _is_root(node):
        atoms.update(sp.sqrt(prime) for prime in sp.factorint(node.base))
    elif node.func in _CIRCULAR or node.func in _HYPERBOLIC or node.func is sp.exp:
        hyperbolic = node.func not in _CIRCULAR
        turn, rates = _angle(node)
        for monomial, rate in rates.items():
            steps[hyperbolic, monomial] = sp.ilcm(steps.get((hyperbolic, monomial), 1), rate.q)
        for value in (sp.cos(turn * sp.pi), sp.sin(turn * sp.pi)):
            if value.has(sp.cos, sp.sin):
                raise NotExactError(f"{value} is not made of square roots of integers.")
            _survey(value, atoms, steps, seen)
    elif node.is_Add or node.is_Mul or (node.is_Pow and node.exp.is_Integer):
        for part in node.args:
            _survey(part, atoms, steps, seen)
    elif not node.is_Rational:
        raise NotExactError(f"{node} is outside the trigonometric-rational class.")


def _is_root(node: sp.Expr) -> bool:
    return bool(node.is_Pow and node.exp == sp.S.Half and node.base.is_Integer)


def _angle(function: sp.Expr) -> tuple[sp.Rational, dict[sp.Expr, sp.Rational]]:
    """Split the argument into turn*pi + sum of rate*monomial; raise NotExactError if it is nothing of the kind."""
    turn, rates = sp.S.Zero, {}
    for term in sp.Add.make_args(sp.expand(function.args[0])):
        rate, monomial = term.as_coeff_Mul()
        if monomial is sp.pi and function.func in _CIRCULAR:
            turn = rate
        elif rate.is_Rational and _is_monomial(monomial):
            rates[monomial] = rate
        elif rate != 0:
            raise NotExactError(f"The argument of {function} is not a rational combination of monomials and pi.")
    return turn, rates


def _is_monomial(monomial: sp.Expr) -> bool:
    powers = [factor.as_base_exp() for factor in sp.Mul.make_args(monomial)]
    # Whole-number symbols are left out: sin(pi*n/2) obeys relations that sine and cosine in general do not.
    return bool(monomial.free_symbols) and all(
        exponent.is_Integer and (base is sp.pi or (base.is_Symbol and base.is_commutative and not base.is_integer))
        for base, exponent in powers
    )


def _quotient(chart: _Chart, node: sp.Expr) -> _Quotient:
    """Return the node as a quotient in the chart's ring."""
    if node not in chart.known:
        chart.known[node] = _build(chart, node)
    return chart.known[node]


def _build(chart: _Chart, node: sp.Expr) -> _Quotient:
    one = chart.ring.one
    if node in chart.generators:
        return _Quotient(chart.generators[node], {})
    if node.is_Rational:
        return _Quotient(one * sp.QQ(node.p, node.q), {})
    if _is_root(node):
        powers = (chart.generators[sp.sqrt(prime)] ** times for prime, times in sp.factorint(node.base).items())
        return _Quotient(_multiplied(chart, powers), {})
    if node.is_Add:
        return _sum(chart, [_quotient(chart, term) for term in node.args])
    if node.is_Mul:
        return reduce(lambda a, b: _times(chart, a, b), (_quotient(chart, part) for part in node.args))
    if node.is_Pow:
        base = _quotient(chart, node.base)
        if node.exp < 0:
            base = _times(chart, _Quotient(_expanded(chart, base.factors), {}), _inverse(chart, base.numerator))
        times = abs(int(node.exp))
        numerator = _multiplied(chart, [base.numerator] * times)
        return _Quotient(numerator, {factor: times * power for factor, power in base.factors.items()})
    pair = _cosine_and_sine(chart, node)
    if node.func is sp.exp:
        return _Quotient(pair[0] + pair[1], {})
    over, under = (_CIRCULAR | _HYPERBOLIC)[node.func]
    quotient = _Quotient(one if over is None else pair[over], {})
    if under is None:
        return quotient
    name = _FAMILY[node.func in _HYPERBOLIC][under](node.args[0])
    return _times(chart, quotient, _inverse(chart, pair[under], name))


def _cosine_and_sine(chart: _Chart, function: sp.Expr) -> Pair:
    """Add up the angles of the function's argument: C = C1*C2 -+ S1*S2, S = S1*C2 + C1*S2."""
    hyperbolic = function.func not in _CIRCULAR
    sign = 1 if hyperbolic else -1

    def plus(a: Pair, b: Pair) -> Pair:
        return _reduced(chart, a[0] * b[0] + sign * a[1] * b[1]), _reduced(chart, a[1] * b[0] + a[0] * b[1])

    turn, rates = _angle(function)
    cosine, sine = (_quotient(chart, part(turn * sp.pi)).numerator for part in _FAMILY[False])
    total = cosine, sine
    for monomial, rate in rates.items():
        step = chart.steps[hyperbolic, monomial]
        c, s = (chart.generators[part(monomial / step)] for part in _FAMILY[hyperbolic])
        total = reduce(plus, [(c, s if rate > 0 else -s)] * abs(int(rate * step)), total)
    return total


def _reduced(chart: _Chart, polynomial: PolyElement) -> PolyElement:
    """Replace g**(2*k + r) by square**k * g**r, r = 0 or 1, for every squared generator g."""
    for index, square in chart.rules:
        if all(monomial[index] < 2 for monomial in polynomial):
            continue
        parts: dict[int, dict[tuple[int, ...], Any]] = {}
        for monomial, coefficient in polynomial.terms():
            times, rest = divmod(monomial[index], 2)
            parts.setdefault(times, {})[(*monomial[:index], rest, *monomial[index + 1 :])] = coefficient
        polynomial = sum((chart.ring.from_dict(part) * square**times for times, part in parts.items()), chart.ring.zero)
    return polynomial


def _multiplied(chart: _Chart, polynomials: Iterable[PolyElement]) -> PolyElement:
    return reduce(lambda a, b: _reduced(chart, a * b), polynomials, chart.ring.one)


def _expanded(chart: _Chart, factors: Mapping[PolyElement, int]) -> PolyElement:
    return _multiplied(chart, (factor for factor, times in factors.items() for _ in range(times)))


def _times(chart: _Chart, a: _Quotient, b: _Quotient) -> _Quotient:
    factors = {f: a.factors.get(f, 0) + b.factors.get(f, 0) for f in a.factors | b.factors}
    return _Quotient(_reduced(chart, a.numerator * b.numerator), factors)


def _sum(chart: _Chart, terms: list[_Quotient]) -> _Quotient:
    """Bring the terms over the least common multiple of their factors, like denominators first."""
    alike: dict[frozenset[tuple[PolyElement, int]], PolyElement] = {}
    common: dict[PolyElement, int] = {}
    for numerator, factors in terms:
        key = frozenset(factors.items())
        alike[key] = alike.get(key, chart.ring.zero) + numerator
        common |= {factor: max(times, common.get(factor, 0)) for factor, times in factors.items()}
    total = chart.ring.zero
    for key, numerator in alike.items():
        own = dict(key)
        missing = {factor: times - own.get(factor, 0) for factor, times in common.items()}
        total += _reduced(chart, numerator * _expanded(chart, missing))
    return _Quotient(total, common)


def _inverse(chart: _Chart, polynomial: PolyElement, name: sp.Expr | None = None) -> _Quotient:
    """Return 1/polynomial, noting its factors; raise NotExactError if it is zero in the quotient ring."""
    if not polynomial:
        raise NotExactError("A denominator vanishes identically.")
    powers = tuple(min(exponents) for exponents in zip(*polynomial.monoms(), strict=True))
    factors = {g: n for g, n in zip(chart.ring.gens, powers, strict=True) if n}
    rest = {tuple(m - p for m, p in zip(monomial, powers, strict=True)): c for monomial, c in polynomial.terms()}
    if len(rest) > 1:
        factors[chart.ring.from_dict(rest).monic()] = 1
    if name is None:
        for factor in factors:
            chart.divisors.setdefault(factor, None)
    else:
        chart.divisors[polynomial.monic()] = name
    return _Quotient(chart.ring.one * (1 / polynomial.LC), factors)


def _domain(chart: _Chart) -> tuple[sp.Expr, ...]:
    """Return the distinct factors of everything divided by, as functions of the input."""
    factors = [
        factor
        for divisor, name in chart.divisors.items()
        for factor in (_irreducible(chart, divisor) if name is None else [name])
        if factor.free_symbols
    ]
    return tuple(dict.fromkeys(factors))


def _irreducible(chart: _Chart, polynomial: PolyElement) -> list[sp.Expr]:
    found = []
    for index, square in chart.rules:
        # 1 - cos**2 vanishes where the sine does, which says it more plainly.
        quotient, remainder = polynomial.div(square)
        if not remainder and not square.is_ground:
            found.append(chart.ring.symbols[index])
            polynomial = quotient
    named = chart.divisors.get(polynomial.monic())
    return found + ([named] if named is not None else [factor.as_expr() for factor, _ in polynomial.factor_list()[1]])


def _largest_value(expression: sp.Expr) -> tuple[dict[sp.Symbol, sp.Rational] | None, float | None]:
    """Return the point, out of some random rational ones, where |expression| is largest, and that value."""
    generator = random.Random(1)
    symbols = sorted(expression.free_symbols, key=sp.default_sort_key)
    try:
        evaluate = sp.lambdify(symbols, expression, "mpmath", dummify=True)
    except (KeyError, NotImplementedError):  # a constant or an operator that has no numeric counterpart
        return None, None
    best: tuple[dict[sp.Symbol, sp.Rational] | None, float | None] = (None, None)
    for _ in range(_POINTS if symbols else 1):
        point = {symbol: sp.Rational(generator.randrange(150, 950), 499) for symbol in symbols}
        values = []
        for digits in (_DIGITS, 2 * _DIGITS):
            with mp.workdps(digits):
                try:
                    values.append(abs(evaluate(*(mp.mpf(value.p) / value.q for value in point.values()))))
                except (ArithmeticError, NameError, TypeError, ValueError):
                    break
        # At a pole hidden by rounding, the value depends on the number of digits.
        if len(values) == 2 and mp.almosteq(*values, 1e-9, 1e-20):
            size = float(values[1])
            if best[1] is None or size > best[1]:
                best = point, size
    return best
