"""Generators of an expression: symbols, square roots, and for each base angle a cosine and sine or an exponential.

Every angle is a multiple of a base angle u = monomial/n, where n is the least common multiple of the denominators.  The
multiples of u are polynomials in its cosine and sine; for large multiples, powers of w = exp(i*u), or exp(u) for hyperbolic
functions, are shorter and replace them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import partial, reduce
from typing import Any

import sympy as sp

from lagrotor.errors import NotExactError, TooLargeError

# Cosine and sine of the circular (False) and the hyperbolic (True) family.
FAMILY: dict[bool, tuple[Any, Any]] = {False: (sp.cos, sp.sin), True: (sp.cosh, sp.sinh)}
# Each function as numerator and denominator in the pair (cosine, sine): 0 is the cosine, 1 the sine, None is one.
CIRCULAR: dict[Any, tuple[int | None, int | None]] = {
    sp.cos: (0, None), sp.sin: (1, None), sp.tan: (1, 0), sp.cot: (0, 1), sp.sec: (None, 0), sp.csc: (None, 1),
}  # fmt: skip
HYPERBOLIC: dict[Any, tuple[int | None, int | None]] = {
    sp.cosh: (0, None), sp.sinh: (1, None), sp.tanh: (1, 0), sp.coth: (0, 1), sp.sech: (None, 0), sp.csch: (None, 1),
}  # fmt: skip
# The largest multiple of a base angle that is expanded in its cosine and sine.
LARGEST_MULTIPLE = 12
# Bounds on the terms and the powers in the argument of a function.
_MOST_TERMS, _MOST_POWER = 200, 1000

Angle = tuple[bool, sp.Expr]  # hyperbolic, monomial
Monomial = frozenset[tuple[sp.Expr, int]]


@dataclass
class Multiples:
    """The multiples of one monomial that occur in the angles of an expression.

    `step` is the least common multiple of the denominators of their factors, and `largest` the largest factor. `exponential` is
    True if they occur in exponentials only.
    """

    step: int = 1
    largest: sp.Rational = sp.S.Zero
    exponential: bool = True


@dataclass
class Survey:
    """The content of some expressions: symbols and pi in `atoms`, radicands of square roots, and angles.

    Multiples of an angle up to `largest` are written in its cosine and sine, larger multiples in an exponential.
    """

    largest: float
    atoms: dict[sp.Expr, None] = field(default_factory=dict)
    radicands: dict[sp.Expr, None] = field(default_factory=dict)
    angles: dict[Angle, Multiples] = field(default_factory=dict)

    def compact(self, angle: Angle) -> bool:
        """Return True if powers of one exponential represent the multiples of this angle."""
        multiples = self.angles[angle]
        return multiples.exponential or multiples.largest * multiples.step > self.largest


def survey(*expressions: sp.Expr, largest: float = LARGEST_MULTIPLE) -> Survey:
    """Return the symbols, radicands and angles that the expressions contain; raise NotExactError outside the class."""
    content, visited, stack = Survey(largest), set[sp.Expr](), list(expressions)
    try:
        while stack:
            node = stack.pop()
            if node not in visited:
                visited.add(node)
                stack += _enter(node, content)
    except NotExactError:
        if floats := set().union(*(expression.atoms(sp.Float) for expression in expressions)):
            raise NotExactError(f"The floating-point number {min(floats)} is not exact.") from None
        raise
    if any(not hyperbolic and content.compact((hyperbolic, m)) for hyperbolic, m in content.angles):
        content.radicands[sp.S.NegativeOne] = None
    return content


def _enter(node: sp.Expr, content: Survey) -> tuple[sp.Expr, ...]:
    """Record a node in the survey, and return those of its subexpressions that are still to be visited."""
    if node.is_Symbol or node is sp.pi:
        _check_symbol(node)
        content.atoms[node] = None
    elif node is sp.I:
        content.radicands[sp.S.NegativeOne] = None
    elif (base := radicand(node)) is not None:
        if not all(step.is_Symbol or step is sp.pi or _is_rational_step(step) for step in sp.preorder_traversal(base)):
            raise NotExactError(f"{node} is outside the class: only roots of rational functions of symbols are in it.")
        content.radicands[base] = None
        return (base,)
    elif node.func in CIRCULAR or node.func in HYPERBOLIC or node.func is sp.exp:
        turn, rates = angle_of(node)
        for monomial, rate in rates.items():
            multiples = content.angles.setdefault((node.func not in CIRCULAR, monomial), Multiples())
            multiples.step = int(sp.ilcm(multiples.step, rate.q))
            multiples.largest = max(multiples.largest, abs(rate))
            multiples.exponential &= node.func is sp.exp
        constants = tuple(function(turn * sp.pi) for function in FAMILY[False])
        for value in constants:
            if value.has(sp.cos, sp.sin):
                raise NotExactError(f"{value} is not made of square roots of integers.")
        return constants
    elif _is_rational_step(node):
        return node.args[:1] if node.is_Pow else node.args
    else:
        raise NotExactError(f"{node} is outside the trigonometric-rational class.")
    return ()


def _check_symbol(node: sp.Expr) -> None:
    if not node.is_commutative or node.is_finite is False:
        raise NotExactError(f"{node} is outside the class: it must commute and be finite.")


def _is_rational_step(node: sp.Expr) -> bool:
    return bool(node.is_Rational or node.is_Add or node.is_Mul or (node.is_Pow and node.exp.is_Integer))


def radicand(node: sp.Expr) -> sp.Expr | None:
    """Return B for a power B**(k/2) with odd k, and x**2 for |x| of a real x, since |x| = sqrt(x**2); None otherwise."""
    if node.is_Pow and node.exp.is_Rational and node.exp.q == 2:
        return node.base
    if isinstance(node, sp.Abs) and node.args[0].is_real:
        return sp.Pow(node.args[0], 2, evaluate=False)
    return None


def angle_of(function: sp.Expr) -> tuple[sp.Rational, dict[sp.Expr, sp.Rational]]:
    """Write an argument as turn*pi + sum of rate*monomial; return (turn, {monomial: rate}) or raise NotExactError."""
    turn, rates = sp.S.Zero, {}
    for powers, rate in _terms(function.args[0], function).items():
        if powers == {(sp.pi, 1)} and function.func in CIRCULAR:
            turn = rate
        # Integer symbols are excluded: sin(pi*n/2) obeys further relations.
        elif all(base is sp.pi or not base.is_integer for base, _ in powers) and powers - {
            (sp.pi, n) for _, n in powers
        }:
            rates[sp.Mul(*(base**power for base, power in powers))] = rate
        else:
            raise _bad_argument(function)
    return turn, rates


def _bad_argument(function: sp.Expr) -> NotExactError:
    return NotExactError(f"The argument of {function} is not a rational combination of monomials and pi.")


def _terms(node: sp.Expr, function: sp.Expr) -> dict[Monomial, sp.Rational]:
    """Expand a polynomial in symbols, their reciprocals and pi into monomial -> coefficient."""
    if node.is_Rational:
        return {frozenset(): node} if node else {}
    if node.is_Symbol or node is sp.pi:
        _check_symbol(node)
        return {frozenset({(node, 1)}): sp.S.One}
    if node.is_Add:
        return _collected(term for argument in node.args for term in _terms(argument, function).items())
    if node.is_Mul:
        return reduce(partial(_product, function), (_terms(argument, function) for argument in node.args))
    if node.is_Pow and node.exp.is_Integer and abs(node.exp) <= _MOST_POWER:
        base = _terms(node.base, function)
        if node.exp < 0:
            if len(base) != 1:
                raise _bad_argument(function)
            base = {frozenset((s, -n) for s, n in powers): 1 / rate for powers, rate in base.items()}
        return reduce(partial(_product, function), [base] * abs(int(node.exp)), {frozenset(): sp.S.One})
    raise _bad_argument(function)


def _product(
    function: sp.Expr, a: dict[Monomial, sp.Rational], b: dict[Monomial, sp.Rational]
) -> dict[Monomial, sp.Rational]:
    if len(a) * len(b) > _MOST_TERMS:
        raise TooLargeError(f"The argument of {function} has more than {_MOST_TERMS} terms.")
    return _collected((_merged(p, q), u * v) for p, u in a.items() for q, v in b.items())


def _merged(p: Monomial, q: Monomial) -> Monomial:
    powers = Counter(dict(p))
    powers.update(dict(q))
    return frozenset((base, power) for base, power in powers.items() if power)


def _collected(terms: Iterable[tuple[Monomial, sp.Rational]]) -> dict[Monomial, sp.Rational]:
    total: dict[Monomial, sp.Rational] = {}
    for powers, rate in terms:
        total[powers] = total.get(powers, sp.S.Zero) + rate
    return {powers: rate for powers, rate in total.items() if rate}
