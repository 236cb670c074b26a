"""The generators of an expression: a polynomial ring in which sines, cosines and exponentials are plain symbols.

Every angle is a whole multiple of a base angle monomial/n, n the least common multiple of the denominators it appears
with; each base angle gives a cosine and a sine, tied by the rule for the sine's square.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import sympy as sp
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.errors import NotExactError

Pair = tuple[PolyElement, PolyElement]
# How finely each monomial is divided, for the circular (False), the hyperbolic (True) and the exponential (None).
Steps = dict[tuple[bool | None, sp.Expr], int]

# Cosine and sine of the circular (False) and the hyperbolic (True) family.
FAMILY: dict[bool, tuple[Any, Any]] = {False: (sp.cos, sp.sin), True: (sp.cosh, sp.sinh)}
# Each function as numerator and denominator in the pair (cosine, sine): 0 is the cosine, 1 the sine, None is one.
CIRCULAR: dict[Any, tuple[int | None, int | None]] = {
    sp.cos: (0, None), sp.sin: (1, None), sp.tan: (1, 0), sp.cot: (0, 1), sp.sec: (None, 0), sp.csc: (None, 1),
}  # fmt: skip
HYPERBOLIC: dict[Any, tuple[int | None, int | None]] = {
    sp.cosh: (0, None), sp.sinh: (1, None), sp.tanh: (1, 0), sp.coth: (0, 1), sp.sech: (None, 0), sp.csch: (None, 1),
}  # fmt: skip


class Quotient(NamedTuple):
    """numerator / product of factor**exponent; the factors are kept apart so that common ones are seen."""

    numerator: PolyElement
    factors: dict[PolyElement, int]


@dataclass(frozen=True)
class Chart:
    """The polynomial ring of an expression, its rules g**2 = square, and every factor it divides by."""

    ring: PolyRing
    generators: dict[sp.Expr, PolyElement]
    steps: Steps
    rules: tuple[tuple[int, PolyElement], ...]
    divisors: dict[PolyElement, sp.Expr | None] = field(default_factory=dict)
    known: dict[sp.Expr, Quotient] = field(default_factory=dict)


def chart_of(expression: sp.Expr) -> Chart:
    """Find the generators: symbols, constants, and a cosine and sine of monomial/n, n the lcm of all denominators."""
    if floats := expression.atoms(sp.Float):
        raise NotExactError(f"The floating-point number {min(floats)} is not exact.")
    atoms: set[sp.Expr] = set()
    steps: Steps = {}
    _survey(expression, atoms, steps, set())
    squares: dict[sp.Expr, sp.Expr] = {atom: atom**2 for atom in atoms if not (atom.is_Symbol or atom is sp.pi)}
    if any(hyperbolic for hyperbolic, _ in steps):
        # Beside cosh and sinh an exponential is their sum.
        for exponential, monomial in [key for key in steps if key[0] is None]:
            step = steps.pop((exponential, monomial))
            steps[True, monomial] = sp.ilcm(steps.get((True, monomial), 1), step)
    for (hyperbolic, monomial), step in steps.items():
        if hyperbolic is None:
            atoms.add(sp.exp(monomial / step))
            continue
        c, s = (part(monomial / step) for part in FAMILY[hyperbolic])
        atoms |= {c, s}
        squares[s] = c**2 - 1 if hyperbolic else 1 - c**2
    symbols = sorted(atoms, key=sp.default_sort_key)
    ring = PolyRing(symbols or [sp.Dummy()], sp.QQ)
    rules = tuple((i, ring.from_expr(squares[g])) for i, g in enumerate(symbols) if g in squares)
    return Chart(ring, dict(zip(symbols, ring.gens, strict=False)), steps, rules)


def _survey(node: sp.Expr, atoms: set[sp.Expr], steps: Steps, seen: set[sp.Expr]) -> None:
    """Collect atoms and base angles of everything below the node; raise NotExactError outside the class."""
    if node in seen:
        return
    seen.add(node)
    if (node.is_Symbol and node.is_commutative) or node in (sp.pi, sp.I):
        atoms.add(node)
    elif is_root(node):
        atoms.update(sp.sqrt(prime) for prime in sp.factorint(node.base))
    elif node.func in CIRCULAR or node.func in HYPERBOLIC or node.func is sp.exp:
        hyperbolic = None if node.func is sp.exp else node.func in HYPERBOLIC
        turn, rates = angle_of(node)
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


def is_root(node: sp.Expr) -> bool:
    return bool(node.is_Pow and node.exp == sp.S.Half and node.base.is_Integer)


def angle_of(function: sp.Expr) -> tuple[sp.Rational, dict[sp.Expr, sp.Rational]]:
    """Split the argument into turn*pi + sum of rate*monomial; raise NotExactError if it is nothing of the kind."""
    turn, rates = sp.S.Zero, {}
    for term in sp.Add.make_args(sp.expand(function.args[0])):
        rate, monomial = term.as_coeff_Mul()
        if monomial is sp.pi and function.func in CIRCULAR:
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
