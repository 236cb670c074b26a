"""The equations of a long Lagrangian by sweeps through its stages: backward for a gradient, forward along a direction.

With the momenta p = ∂L/∂v, the product M b is the derivative of p when v changes at the rate b. M α + h is dp/dt − ∂L/∂q for v'
= α. A gradient costs about three times as much as L for any number of coordinates. A derivative along a direction costs about
twice as much as its expression.

Griewank & Walther, Evaluating Derivatives, 2nd ed., ch. 3.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from functools import lru_cache
from operator import attrgetter

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.algebra.subexpressions import subexpressions
from lagrotor.mechanics.bodies.small_matrices import Stages
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.lagrangian import jacobian, t
from lagrotor.mechanics.quasi_velocities import inverse_of, rows_of
from lagrotor.numerics.codegen import Stage


def swept_equations(system: Equations) -> tuple[list[Stage], sp.Matrix, sp.Matrix]:
    """Return the stages, M and Q − h of the equations M u' = Q − h + Gᵀ λ. For quasi-velocities these are Bᵀ M B and Bᵀ (Q − M α
    − h)."""
    keep, c, kinematics = Stages(), system.c, system.kinematics
    n, m = len(c.q), len(system.speeds)
    B, alpha, first, place = sp.eye(n), sp.zeros(n, 1), list[Stage](), 0
    onward = dict(zip((*c.q, t), (*c.v, sp.S.One), strict=True))
    if kinematics:
        K = jacobian(list(kinematics.rows), c.v).applyfunc(lambda e: expression_stages(keep, e))
        inverse = inverse_of(K, (), c, keep)[1]
        B, speeds = inverse[:, :m], sp.Matrix([*system.speeds, *[0] * (n - m)])
        v = inverse * (speeds - kinematics.rows.xreplace(dict.fromkeys(c.v, sp.S.Zero)))
        first = [*kinematics.stages, *keep.made, *((a, e) for a, e in zip(c.v, v, strict=True) if a != e)]
        place = len(keep.made)
        gamma = forward_sweep(keep, [expression_stages(keep, e) for e in kinematics.rows], onward)
        alpha = (-inverse * sp.Matrix(gamma)).applyfunc(keep)
    slopes = backward_sweep(keep, expression_stages(keep, system.L), (*c.q, *c.v))
    momenta = slopes[n:]
    drift = forward_sweep(keep, momenta, onward | dict(zip(c.v, alpha, strict=True)))
    forces = sp.Matrix([keep(a - b) for a, b in zip(slopes[:n], drift, strict=True)])
    rows, M = rows_of(B.T), sp.zeros(m, m)
    for j, row in enumerate(rows):
        needed = sorted({i for later in rows[j:] for i in later})
        changes = forward_sweep(keep, [momenta[i] for i in needed], {c.v[i]: b for i, b in row.items()})
        column = dict(zip(needed, changes, strict=True))
        for i in range(j, m):
            products = [b * column[k] for k, b in rows[i].items() if column[k] != 0]
            M[i, j] = M[j, i] = keep(sp.Add(*products))
    return [*first, *keep.made[place:]], M, B.T * (forces + system.generalised_forces)


def swept_energy(system: Equations) -> tuple[list[Stage], sp.Expr]:
    """Return the stages, and in terms of these the Jacobi integral v·∂L/∂v − L."""
    keep, v = Stages(), system.c.v
    L = expression_stages(keep, system.L)
    return keep.made, sp.Add(-L, *(a * p for a, p in zip(v, backward_sweep(keep, L, v), strict=True)))


def expression_stages(keep: Stages, e: sp.Expr) -> sp.Expr:
    """Add a stage for each subexpression of an expression, and return the name of the last one. A sum is built on a shorter sum
    that it contains."""
    sums = sorted((s for s in subexpressions(e) if s.is_Add), key=lambda s: len(s.args))
    terms = {s: {*s.args} for s in sums if len({*s.args}) == len(s.args)}  # left unevaluated, one may have a term twice
    stages, beginning_with = dict[sp.Expr, sp.Expr](), defaultdict[sp.Expr, list[int]](list)
    for i, s in enumerate(sums):
        beginning_with[s.args[0]].append(i)

    def contained(whole: sp.Expr) -> sp.Expr | None:
        """Return the longest sum whose terms are some of the terms of another one."""
        numbers = (
            i for a in whole.args for i in beginning_with[a] if sums[i] in terms and terms[sums[i]] < terms[whole]
        )
        return sums[last] if (last := max(numbers, default=None)) is not None else None

    def stage(term: sp.Expr) -> sp.Expr:
        if term.is_Atom:
            return term
        if term not in stages and not all(isinstance(a, sp.Expr) for a in term.args):
            stages[term] = keep(term)  # a Piecewise or an integral, whose arguments are no values
        if term not in stages:
            shorter = contained(term) if term in terms else None
            if shorter is None:
                stages[term] = keep(term.func(*map(stage, term.args)))
            else:
                stages[term] = keep(sp.Add(stage(shorter), *(stage(a) for a in term.args if a not in terms[shorter])))
        return stages[term]

    return stage(e)


def backward_sweep(keep: Stages, output: sp.Expr, symbols: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """Return ∂output/∂s for each of the symbols, by a sweep backward through the stages. The output is a stage or a multiple of
    one."""
    shares: dict[sp.Expr, list[sp.Expr]] = defaultdict(list)
    for s, slope in _slopes(output):
        shares[s].append(slope)
    for name, e in reversed(_below(keep, [output])):
        weight = keep(sp.Add(*shares[name]))
        for s, slope in _slopes(e):
            shares[s].append(keep(weight * keep(slope)))
    return [keep(sp.Add(*shares[s])) if s in shares else sp.S.Zero for s in symbols]


def forward_sweep(keep: Stages, outputs: Sequence[sp.Expr], direction: Mapping[sp.Symbol, sp.Expr]) -> list[sp.Expr]:
    """Return the derivatives of the outputs when the symbols change at the rates in `direction`."""
    rates = {s: rate for s, rate in direction.items() if rate != 0}

    def rate(e: sp.Expr) -> sp.Expr:
        return keep(sp.Add(*(keep(keep(slope) * rates[s]) for s, slope in _slopes(e) if s in rates)))

    for name, e in _below(keep, outputs):
        if (change := rate(e)) != 0:
            rates[name] = change
    return [rate(e) for e in outputs]


def _below(keep: Stages, outputs: Sequence[sp.Expr]) -> list[Stage]:
    """Return the stages on which the outputs depend, in the order of their computation."""
    body, needed = dict(keep.made), set[sp.Symbol]()
    queue = [s for e in outputs for s in e.free_symbols]
    while queue:
        if (s := queue.pop()) in body and s not in needed:
            needed.add(s)
            queue += body[s].free_symbols
    return [(name, e) for name, e in body.items() if name in needed]


@lru_cache(maxsize=10_000)
def _slopes(e: sp.Expr) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Return the symbols of an expression, each with the partial derivative by it; those of a sum term by term."""
    parts = defaultdict[sp.Symbol, list[sp.Expr]](list)
    for term in sp.Add.make_args(e):
        for s in term.free_symbols:
            parts[s].append(derivative(term, s))
    return [(s, sp.Add(*parts[s])) for s in sorted(parts, key=attrgetter("name"))]
