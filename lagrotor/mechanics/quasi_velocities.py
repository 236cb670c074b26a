"""Quasi-velocities u = A(q, t) v + a(q, t), and the velocities v = q' that they give.

If u has fewer components than q, constraints G v + g = 0 supply the missing rows and hold for every u:

    [A]     [u − a]
    [G] v = [ − g ],        v = B u + b,        v' = B u' + α,

with α the accelerations at u' = 0. Multiplied by Bᵀ, the equations of motion lose the multipliers of these constraints,

    Bᵀ (M B u' + M α + h − Q) = (G' B)ᵀ λ,

with G' the rows of the other constraints. At a pole det [A; G] = 0, and u does not determine v.

Hamel, Theoretische Mechanik (1949), §§ 235–242; Kane & Levinson, Dynamics: Theory and Applications (1985), ch. 2.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import along, decide_zero
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.small_matrices import Stages
from lagrotor.mechanics.expressions import expression, shortest
from lagrotor.mechanics.lagrangian import Coordinates, gradient, jacobian, t, total_derivative
from lagrotor.numerics.codegen import Stage, solve_symmetric

Pairs = tuple[tuple[sp.Symbol, sp.Expr], ...]
_SMALL = 3  # rows up to which a block is inverted by its adjugate
_SHORT = 100  # operations up to which an expression is factored and reduced
_STATES = 3  # random states at which ranks are determined
_ROUNDING = 1e-9  # relative residual below which a row depends on the others


@dataclass(frozen=True, eq=False)
class Kinematics:
    """The maps v = B u + b and v' = B u' + α, as expressions in q, u and t; α contains v, too.

    They may use the symbols of `stages`, pairs (symbol, expression) to be evaluated first. `rows` is (A v + a, G v + g),
    shape (n, 1), and `inverse` is [A; G]⁻¹, shape (n, n). `used` and `left` are the indices of the constraints in G, and of
    the others. Where an expression in `poles` vanishes, u does not determine v; long expressions are omitted.
    """

    stages: tuple[Stage, ...]
    rows: sp.Matrix
    inverse: sp.Matrix
    B: sp.Matrix
    velocity: sp.Matrix
    alpha: sp.Matrix
    used: tuple[int, ...]
    left: tuple[int, ...]
    poles: tuple[sp.Expr, ...]


def check_velocities(c: Coordinates, velocities: Any, named: Mapping[sp.Symbol, sp.Expr] | None = None) -> Pairs:
    """Return the quasi-velocities, checked, as pairs (u, expression affine in v).

    `named` gives further symbols that these may contain, {symbol: expression in q, v and t}.
    """
    pairs = list(velocities.items()) if isinstance(velocities, Mapping) else velocities
    if not isinstance(pairs, list | tuple) or not all(isinstance(pair, tuple) and len(pair) == 2 for pair in pairs):
        raise InputError(f"System: velocities = {velocities!r} must be {{symbol: expression in q, v and t, …}}")
    checked: list[Stage] = []
    definitions = dict(named or {})
    for u, e in pairs:
        name = f"System: velocities[{u}]"
        if not isinstance(u, sp.Symbol) or u in {*c.q, *c.a, t}:
            raise InputError(f"{name}: a quasi-velocity must be named by a symbol without another meaning: rename it")
        e = expression(name, e).xreplace(definitions)
        if u in c.v and e != u:
            raise InputError(f"{name} = {e}: {u} is the velocity of a coordinate and cannot be redefined: rename it")
        later = {v for v, form in pairs if v != form and v not in definitions}
        if wrong := e.free_symbols & later:
            raise InputError(f"{name} = {e} contains {min(map(str, wrong))}, which is defined after it: put that first")
        if wrong := e.free_symbols & {*c.a}:
            raise InputError(f"{name} = {e} contains {min(map(str, wrong))}: write it in q, v and t")
        slope = jacobian([e], c.v)
        if all(decide_zero(entry).answer == "zero" for entry in slope):
            raise InputError(f"{name} = {e} has no velocity of a coordinate: write it as sum_j A_j(q, t) v_j + a(q, t)")
        if any(decide_zero(entry).answer != "zero" for entry in jacobian(list(slope), c.v)):
            raise InputError(f"{name} = {e} is not affine in the velocities: write it as sum_j A_j(q, t) v_j + a(q, t)")
        checked.append((u, e))
        definitions |= {u: e} if u != e else {}
    names = [str(u) for u, _ in checked]
    if len({*names}) < len(names):
        raise InputError(f"System: velocities {', '.join(names)}: each needs a different name")
    if len(names) > len(c.q):
        raise InputError(f"System: {len(names)} velocities for {len(c.q)} coordinates: leave some out")
    return tuple(checked)


def kinematics(
    c: Coordinates, pairs: Pairs, constraints: Sequence[sp.Expr], residual: sp.Matrix, first: Sequence[int]
) -> Kinematics:
    """Solve the definitions of the quasi-velocities, with as many constraints as needed, for v.

    `residual` is G v + g of all constraints, and `first` has the indices of the constraints to use first. Ranks are
    determined at random states. Raises InputError if the quasi-velocities are dependent or too few.
    """
    velocities = [e for _, e in pairs]
    order = [*first, *(i for i in range(len(residual)) if i not in first)]
    rows = [*velocities, *(residual[i] for i in order)]
    matrix = jacobian(rows, c.v)
    independent = independent_rows(matrix, len(c.q))
    if any(i not in independent for i in range(len(velocities))):
        name = next(u for i, (u, _) in enumerate(pairs) if i not in independent)
        raise InputError(f"System: velocities: {name} depends on the velocities before it: leave it out")
    if len(independent) < len(c.q):
        raise InputError(
            f"System: {len(velocities)} velocities and {len(residual)} constraints do not give {', '.join(map(str, c.v))}: "
            f"{len(c.q) - len(independent)} more are needed; one may be a velocity of a coordinate, {{c.v[0]: c.v[0]}}"
        )
    used = tuple(order[i - len(velocities)] for i in independent[len(velocities) :])
    F, K = sp.Matrix([rows[i] for i in independent]), matrix.extract(independent, list(range(len(c.q))))
    relations = [constraints[i] for i in used if i < len(constraints)]
    stages, inverse, poles = inverse_of(K, relations, c)
    u = sp.Matrix([*(u for u, _ in pairs), *[0] * len(used)])
    still, at_rest = dict.fromkeys(c.a, sp.S.Zero), dict.fromkeys(c.v, sp.S.Zero)
    gamma = F.applyfunc(lambda e: total_derivative(e, c).xreplace(still))
    velocity, alpha = inverse * (u - F.xreplace(at_rest)), -inverse * gamma
    left = tuple(i for i in range(len(residual)) if i not in used)
    B = inverse[:, : len(velocities)]
    return Kinematics(tuple(stages), F, inverse, B, velocity, alpha, used, left, tuple(poles))


def boltzmann_hamel(
    L: sp.Expr, c: Coordinates, kinematics: Kinematics, speeds: Sequence[sp.Symbol]
) -> tuple[sp.Matrix, sp.Matrix]:
    """Return M and h of the equations of motion M u' + h = Bᵀ Q, in q, u and t. The relation must have no stages.

    With L̄(q, U, t) the Lagrangian in all rows U = (u, w), w = G v + g = 0, and π = ∂L̄/∂U, along the column i of B:

        d/dt π_i − Σ_j B_ji (∂L̄/∂q_j + Σ_r π_r (∂U_r/∂q_j − d/dt ∂U_r/∂v_j)) = Σ_j B_ji Q_j.

    Neimark & Fufaev, ch. III, § 3.
    """
    m, n = len(speeds), len(c.q)
    w = [sp.Symbol(f"_w{r}", real=True) for r in range(n - m)]
    velocity_of = dict(zip(c.v, kinematics.velocity, strict=True))
    constraint_term = kinematics.inverse[:, m:] * sp.Matrix(n - m, 1, w)
    whole = shortest(L.xreplace({v: e + constraint_term[j] for j, (v, e) in enumerate(velocity_of.items())}))
    at_rest = dict.fromkeys(w, sp.S.Zero)
    pi = gradient(whole, (*speeds, *w)).xreplace(at_rest)
    bar, K = whole.xreplace(at_rest), jacobian(list(kinematics.rows), c.v)
    still = dict.fromkeys(c.a, sp.S.Zero)
    turns = jacobian(list(kinematics.rows), c.q) - K.applyfunc(lambda e: total_derivative(e, c).xreplace(still))
    twist = (turns * kinematics.B).applyfunc(lambda e: shortest(e.xreplace(velocity_of)))
    drift = pi[:m, :].applyfunc(lambda e: along(e, (*c.q, t), (*kinematics.velocity, 1)))
    h = drift - kinematics.B.T * gradient(bar, c.q) - twist.T * pi
    return jacobian(list(pi[:m, :]), speeds), h.applyfunc(shortest)


def inverse_of(
    K: sp.Matrix, relations: Sequence[sp.Expr], c: Coordinates, keep: Stages | None = None
) -> tuple[list[Stage], sp.Matrix, list[sp.Expr]]:
    """Return stages, K⁻¹ in their symbols, and the factors of det K that depend on q or t.

    A stage is a pair (symbol, expression). `relations` are polynomials in q that vanish at every state. `keep` has the stages
    that K uses and takes the new ones. The blocks of K are solved in order of dependence. The inverse is the transpose for
    orthogonal rows, the adjugate over det K for small blocks, and Kᵀ (K Kᵀ)⁻¹ for others, which needs no pivots.
    """
    n = K.rows
    stages, short, prefix = (keep.made, keep, "_j") if keep else ([], _reduced, "_k")
    inverse, factors, solved = sp.zeros(n, n), list[sp.Expr](), list[int]()
    for number, (rows, columns) in enumerate(_blocks(K)):
        block = K.extract(rows, columns)
        gram = block * block.T
        if all(sp.expand(gram[i, j]) == 0 for i in range(len(rows)) for j in range(i)):
            squares = [shortest(gram[i, i]) for i in range(len(rows))]
            lengths = [_modulo(e, relations, c) for e in squares] if len(rows) > 1 else [block[0] ** 2]
            block_inverse = block.T * sp.diag(*(1 / e for e in lengths))
            factors += lengths
        elif len(rows) <= _SMALL:
            determinant = short(block.det(method="berkowitz"))
            block_inverse = (block.adjugate(method="berkowitz") / determinant).applyfunc(short)
            factors.append(determinant)
        else:
            solving, normal = solve_symmetric(gram, sp.eye(len(rows)), f"{prefix}{number}")
            stages += solving
            block_inverse = block.T * normal
        substituted = K.extract(rows, solved) * inverse.extract(solved, list(range(n)))
        right = sp.eye(n).extract(rows, list(range(n))) - substituted
        for i, line in enumerate((block_inverse * right).tolist()):
            inverse[columns[i], :] = sp.Matrix([[short(e) for e in line]])
        solved += columns
    moving = {*c.q, t}
    factors = [f for e in factors if _is_short(e) for f in sp.Mul.make_args(sp.factor(e))]
    poles = [f for f in factors if f.free_symbols & moving]
    return stages, inverse, list(dict.fromkeys(f.base if f.is_Pow else f for f in poles))


def _blocks(K: sp.Matrix) -> list[tuple[list[int], list[int]]]:
    """Return (rows, columns) of each block of a block-triangular form of K.

    Rows with one unknown come first, columns that a single row contains come last.
    """
    rows, columns = {*range(K.rows)}, {*range(K.rows)}
    columns_of = {i: {j for j in columns if K[i, j] != 0} for i in rows}
    rows_of = {j: {i for i in rows if j in columns_of[i]} for j in columns}
    first, last = list[tuple[list[int], list[int]]](), list[tuple[list[int], list[int]]]()

    def unknowns(i: int) -> list[int]:
        return sorted(columns_of[i] & columns)

    def users(j: int) -> list[int]:
        return sorted(rows_of[j] & rows)

    while rows:
        if single := next((([i], unknowns(i)) for i in sorted(rows) if len(unknowns(i)) == 1), None):
            first.append(single)
        elif single := next(((users(j), [j]) for j in sorted(columns) if len(users(j)) == 1), None):
            last.append(single)
        else:
            break
        rows, columns = rows - {*single[0]}, columns - {*single[1]}
    while rows:
        block, members, fresh = set[int](), set[int](), {min(rows)}
        while fresh:
            block |= fresh
            members |= set().union(*(unknowns(i) for i in fresh))
            fresh = set[int]().union(*(users(j) for j in members)) - block
        first.append((sorted(block), sorted(members)))
        rows -= block
    return [*first, *reversed(last)]


def _is_short(e: Any) -> bool:
    return bool(sp.count_ops(e) <= _SHORT)


def _reduced(e: sp.Expr) -> sp.Expr:
    return shortest(e) if _is_short(e) else e


def _modulo(e: sp.Expr, relations: Sequence[sp.Expr], c: Coordinates) -> sp.Expr:
    """Reduce a polynomial in q modulo polynomials that vanish; return another expression unchanged."""
    applicable = [g for g in relations if g.free_symbols <= {*c.q} and g.free_symbols & e.free_symbols]
    if not applicable or not all(g.is_polynomial(*c.q) for g in (*applicable, e)):
        return e
    return sp.reduced(e, applicable, *sorted(set().union(*(g.free_symbols for g in applicable)), key=str))[1]


def _values(matrix: sp.Matrix) -> list[list[list[float]]]:
    """Evaluate the matrix at random states; leave out those at which it has no value."""
    unknown = matrix.atoms(sp.Derivative, sp.core.function.AppliedUndef)
    plain = matrix.xreplace({f: sp.Symbol(f"_f{i}", real=True) for i, f in enumerate(sorted(unknown, key=str))})
    symbols = sorted(plain.free_symbols, key=str)
    function = sp.lambdify(symbols, plain.tolist(), "math", cse=True, dummify=True)
    values = []
    for point in points(symbols, _STATES):
        with suppress(ArithmeticError, ValueError):
            values.append([[float(e) for e in row] for row in function(*(float(point[s]) for s in symbols))])
    return values


def independent_rows(matrix: sp.Matrix, rank: int) -> list[int]:
    """Return the indices of the first independent rows, at most `rank`, at the random state that has most of them."""
    best: list[int] = []
    for rows in _values(matrix):
        chosen, basis = list[int](), list[list[float]]()
        for i, row in enumerate(rows):
            remainder = _without(row, basis)
            if len(chosen) < rank and max(map(abs, remainder)) > _ROUNDING * (max(map(abs, row)) or 1.0):
                size = sum(x * x for x in remainder) ** 0.5
                chosen.append(i)
                basis.append([x / size for x in remainder])
        best = chosen if len(chosen) > len(best) else best
    return best


def _without(row: Sequence[float], basis: Sequence[Sequence[float]]) -> list[float]:
    """Subtract from a row its components along orthonormal vectors, twice to reduce rounding errors."""
    remainder = list(row)
    for _ in range(2):
        for direction in basis:
            component = sum(x * y for x, y in zip(remainder, direction, strict=True))
            remainder = [x - component * y for x, y in zip(remainder, direction, strict=True)]
    return remainder
