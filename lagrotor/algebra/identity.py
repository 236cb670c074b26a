"""Exact decision whether a trigonometric-rational expression vanishes identically.

The class: sums, products and integer powers of symbols, rationals, pi, i and square roots of integers, and of

    sin, cos, tan, cot, sec, csc, sinh, cosh, tanh, coth, sech, csch, exp

whose arguments are rational combinations of monomials in the symbols (x, x/2, omega*t), the circular ones also of
rational multiples of pi.  Every angle is a whole multiple of a base angle u, one for each monomial, so by the
addition theorems everything is a quotient of polynomials in the generators (exponentials, where no hyperbolic function
stands beside them, are powers of one generator each), subject to

    sin(u)**2 = 1 - cos(u)**2,    sinh(u)**2 = cosh(u)**2 - 1,    sqrt(p)**2 = p,    i**2 = -1.

Exponentials of rationally independent monomials are algebraically independent over the rational functions, hence
there are no other relations, the quotient ring has no zero divisors, and a quotient vanishes identically if and only
if its numerator, reduced to degree below two in every squared generator, is the zero polynomial.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import sympy as sp
from sympy.polys.rings import PolyElement

from lagrotor.algebra.evidence import largest_value
from lagrotor.algebra.generators import CIRCULAR, FAMILY, HYPERBOLIC, Chart, Pair, Quotient, angle_of, chart_of, is_root
from lagrotor.errors import NotExactError

# A divisor larger than this stands in the domain as it is: its factors may take hours to find.
_MOST_TERMS, _MOST_DEGREE = 40, 12


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
        chart = chart_of(expression)
        numerator = _quotient(chart, expression).numerator
    except NotExactError as refusal:
        return Decision("undecided", (), str(refusal), evidence=largest_value(expression)[1])
    domain = _domain(chart)
    if not numerator:
        return Decision("zero", domain, "The reduced numerator is the zero polynomial.")
    leading = chart.ring.from_dict(dict([numerator.terms()[0]])).as_expr()
    reason = f"The reduced numerator is not zero: terms {len(numerator)}, the leading one {leading}."
    return Decision("nonzero", domain, reason, *largest_value(expression))


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
    chart = chart_of(expression)
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


def _quotient(chart: Chart, node: sp.Expr) -> Quotient:
    """Return the node as a quotient in the chart's ring."""
    if node not in chart.known:
        chart.known[node] = _build(chart, node)
    return chart.known[node]


def _build(chart: Chart, node: sp.Expr) -> Quotient:
    one = chart.ring.one
    if node in chart.generators:
        return Quotient(chart.generators[node], {})
    if node.is_Rational:
        return Quotient(one * sp.QQ(node.p, node.q), {})
    if is_root(node):
        powers = (chart.generators[sp.sqrt(prime)] ** times for prime, times in sp.factorint(node.base).items())
        return Quotient(_multiplied(chart, powers), {})
    if node.is_Add:
        return _sum(chart, [_quotient(chart, term) for term in node.args])
    if node.is_Mul:
        return reduce(lambda a, b: _times(chart, a, b), (_quotient(chart, part) for part in node.args))
    if node.is_Pow:
        base = _quotient(chart, node.base)
        if node.exp < 0:
            base = _times(chart, Quotient(_expanded(chart, base.factors), {}), _inverse(chart, base.numerator))
        times = abs(int(node.exp))
        numerator = _multiplied(chart, [base.numerator] * times)
        return Quotient(numerator, {factor: times * power for factor, power in base.factors.items()})
    if node.func is sp.exp and not any(hyperbolic for hyperbolic, _ in chart.steps):
        return _exponential(chart, node)
    pair = _cosine_and_sine(chart, node)
    if node.func is sp.exp:
        return Quotient(pair[0] + pair[1], {})
    over, under = (CIRCULAR | HYPERBOLIC)[node.func]
    quotient = Quotient(one if over is None else pair[over], {})
    if under is None:
        return quotient
    name = FAMILY[node.func in HYPERBOLIC][under](node.args[0])
    return _times(chart, quotient, _inverse(chart, pair[under], name))


def _exponential(chart: Chart, function: sp.Expr) -> Quotient:
    """exp(sum of rate*monomial) as a product of powers of exp(monomial/step); none of them can vanish."""
    numerator, factors = chart.ring.one, {}
    for monomial, rate in angle_of(function)[1].items():
        step = chart.steps[None, monomial]
        generator = chart.generators[sp.exp(monomial / step)]
        if rate > 0:
            numerator *= generator ** int(rate * step)
        else:
            factors[generator] = -int(rate * step)
    return Quotient(numerator, factors)


def _cosine_and_sine(chart: Chart, function: sp.Expr) -> Pair:
    """Add up the angles of the function's argument: C = C1*C2 -+ S1*S2, S = S1*C2 + C1*S2."""
    hyperbolic = function.func not in CIRCULAR
    sign = 1 if hyperbolic else -1

    def plus(a: Pair, b: Pair) -> Pair:
        return _reduced(chart, a[0] * b[0] + sign * a[1] * b[1]), _reduced(chart, a[1] * b[0] + a[0] * b[1])

    turn, rates = angle_of(function)
    cosine, sine = (_quotient(chart, part(turn * sp.pi)).numerator for part in FAMILY[False])
    total = cosine, sine
    for monomial, rate in rates.items():
        step = chart.steps[hyperbolic, monomial]
        c, s = (chart.generators[part(monomial / step)] for part in FAMILY[hyperbolic])
        total = reduce(plus, [(c, s if rate > 0 else -s)] * abs(int(rate * step)), total)
    return total


def _reduced(chart: Chart, polynomial: PolyElement) -> PolyElement:
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


def _multiplied(chart: Chart, polynomials: Iterable[PolyElement]) -> PolyElement:
    return reduce(lambda a, b: _reduced(chart, a * b), polynomials, chart.ring.one)


def _expanded(chart: Chart, factors: Mapping[PolyElement, int]) -> PolyElement:
    return _multiplied(chart, (factor for factor, times in factors.items() for _ in range(times)))


def _times(chart: Chart, a: Quotient, b: Quotient) -> Quotient:
    factors = {f: a.factors.get(f, 0) + b.factors.get(f, 0) for f in a.factors | b.factors}
    return Quotient(_reduced(chart, a.numerator * b.numerator), factors)


def _sum(chart: Chart, terms: list[Quotient]) -> Quotient:
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
    return Quotient(total, common)


def _inverse(chart: Chart, polynomial: PolyElement, name: sp.Expr | None = None) -> Quotient:
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
    return Quotient(chart.ring.one * (1 / polynomial.LC), factors)


def _domain(chart: Chart) -> tuple[sp.Expr, ...]:
    """Return the distinct factors of everything divided by, as functions of the input."""
    factors = [
        factor
        for divisor, name in chart.divisors.items()
        for factor in (_irreducible(chart, divisor) if name is None else [name])
        if factor.free_symbols
    ]
    return tuple(dict.fromkeys(factors))


def _irreducible(chart: Chart, polynomial: PolyElement) -> list[sp.Expr]:
    found = []
    for index, square in chart.rules:
        # 1 - cos**2 vanishes where the sine does, which says it more plainly.
        quotient, remainder = polynomial.div(square)
        if not remainder and not square.is_ground:
            found.append(chart.ring.symbols[index])
            polynomial = quotient
    named = chart.divisors.get(polynomial.monic())
    if named is not None:
        return [*found, named]
    if len(polynomial) > _MOST_TERMS or max(map(sum, polynomial.monoms())) > _MOST_DEGREE:
        return [*found, polynomial.as_expr()]
    return found + [factor.as_expr() for factor, _ in polynomial.factor_list()[1]]
