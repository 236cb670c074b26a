"""Velocities of one's own, u = A(q, t) v + a(q, t), and the velocities v = q' that they give.

Where there are fewer of them than coordinates, constraints G v + g = 0 supply the rows that are missing, and hold for every u:

    [A]     [u − a]
    [G] v = [ − g ],        v = B u + b,        v' = B u' + α,

with α the accelerations at u' = 0. The equations of motion along the columns of B are then free of these constraints'
multipliers,

    Bᵀ (M B u' + M α + h − Q) = (G' B)ᵀ λ,

G' the rows of the constraints that are left. Poles are where det [A; G] = 0.

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
_SHORT = 100  # operations of what is factored and reduced
_STATES = 3  # random ones, at which ranks are read off
_ROUNDING = 1e-9  # of the largest entry of a row, what is left of it where it depends on others


@dataclass(frozen=True, eq=False)
class Kinematics:
    """v = B u + b and v' = B u' + α, in q, u and t; α with v in it. stages: what B, b and α are made of, before them.

    rows: U = (A v + a, G v + g), (n, 1); inverse: [A; G]⁻¹, (n, n). used: the rows of the constraints in G, by number; left:
    the others. poles: expressions in q and t, one of which vanishes where u does not give v, as far as that is written out.
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


def check_velocities(c: Coordinates, given: Any, named: Mapping[sp.Symbol, sp.Expr] | None = None) -> Pairs:
    """The velocities as pairs (u, expression affine in v). named: others, which the expressions may have.

    Raises InputError for what is none.
    """
    pairs = list(given.items()) if isinstance(given, Mapping) else given
    if not isinstance(pairs, list | tuple) or not all(isinstance(pair, tuple) and len(pair) == 2 for pair in pairs):
        raise InputError(
            f"System: velocities = {given!r} must be {{symbol: expression in q, v and t, …}}, a dictionary"
        )
    checked: list[Stage] = []
    known = dict(named or {})
    for u, e in pairs:
        name = f"System: velocities[{u}]"
        if not isinstance(u, sp.Symbol) or u in {*c.q, *c.a, t}:
            raise InputError(f"{name}: a velocity of one's own is named by a symbol that nothing else has: rename it")
        e = expression(name, e).xreplace(known)
        if u in c.v and e != u:
            raise InputError(f"{name} = {e}: {u} is the velocity of a coordinate, which stays what it is: rename it")
        later = {other for other, form in pairs if other != form and other not in known}
        if wrong := e.free_symbols & later:
            raise InputError(f"{name} = {e} contains {min(map(str, wrong))}, which is given after it: put that first")
        if wrong := e.free_symbols & {*c.a}:
            raise InputError(f"{name} = {e} contains {min(map(str, wrong))}: write it in q, v and t")
        slope = jacobian([e], c.v)
        if all(decide_zero(entry).answer == "zero" for entry in slope):
            raise InputError(f"{name} = {e} has no velocity of a coordinate: write it as sum_j A_j(q, t) v_j + a(q, t)")
        if any(decide_zero(entry).answer != "zero" for entry in jacobian(list(slope), c.v)):
            raise InputError(f"{name} = {e} is not affine in the velocities: write it as sum_j A_j(q, t) v_j + a(q, t)")
        checked.append((u, e))
        known |= {u: e} if u != e else {}
    names = [str(u) for u, _ in checked]
    if len({*names}) < len(names):
        raise InputError(f"System: velocities {', '.join(names)}: each needs a name of its own")
    if len(names) > len(c.q):
        raise InputError(
            f"System: {len(names)} velocities for {len(c.q)} coordinates: there are at most as many; leave some out"
        )
    return tuple(checked)


def kinematics(
    c: Coordinates, pairs: Pairs, constraints: Sequence[sp.Expr], residual: sp.Matrix, first: Sequence[int]
) -> Kinematics:
    """The velocities solved for v. residual: G v + g of all constraints, those of places before others; first: what is used
    before the rest.

    The ranks are decided at random states. Raises InputError where the velocities depend on each other, or do not give v
    together with the constraints.
    """
    own = [e for _, e in pairs]
    order = [*first, *(i for i in range(len(residual)) if i not in first)]
    rows = [*own, *(residual[i] for i in order)]
    matrix = jacobian(rows, c.v)
    kept = independent_rows(matrix, len(c.q))
    if any(i not in kept for i in range(len(own))):
        name = next(u for i, (u, _) in enumerate(pairs) if i not in kept)
        raise InputError(f"System: velocities: {name} follows from those before it: leave it out")
    if len(kept) < len(c.q):
        raise InputError(
            f"System: {len(own)} velocities and {len(residual)} constraints do not give {', '.join(map(str, c.v))}: "
            f"{len(c.q) - len(kept)} more are needed; one may be a velocity of a coordinate, {{c.v[0]: c.v[0]}}"
        )
    used = tuple(order[i - len(own)] for i in kept[len(own) :])
    F, K = sp.Matrix([rows[i] for i in kept]), matrix.extract(kept, list(range(len(c.q))))
    held = [constraints[i] for i in used if i < len(constraints)]
    stages, inverse, poles = inverse_of(K, held, c)
    u = sp.Matrix([*(u for u, _ in pairs), *[0] * len(used)])
    still, at_rest = dict.fromkeys(c.a, sp.S.Zero), dict.fromkeys(c.v, sp.S.Zero)
    gamma = F.applyfunc(lambda e: total_derivative(e, c).xreplace(still))
    return Kinematics(
        tuple(stages),
        F,
        inverse,
        inverse[:, : len(own)],
        inverse * (u - F.xreplace(at_rest)),
        -inverse * gamma,
        used,
        tuple(i for i in range(len(residual)) if i not in used),
        tuple(poles),
    )


def boltzmann_hamel(
    L: sp.Expr, c: Coordinates, given: Kinematics, speeds: Sequence[sp.Symbol]
) -> tuple[sp.Matrix, sp.Matrix]:
    """M and h of d'Alembert's principle M u' + h = Bᵀ Q, in q, u and t, without a stage.

    With L̄(q, U, t) the Lagrangian in all rows U = (u, w), w = G v + g = 0, and π = ∂L̄/∂U, along the column i of B:

        d/dt π_i − Σ_j B_ji (∂L̄/∂q_j + Σ_r π_r (∂U_r/∂q_j − d/dt ∂U_r/∂v_j)) = Σ_j B_ji Q_j.

    Neimark & Fufaev, ch. III, § 3.
    """
    m, n = len(speeds), len(c.q)
    w = [sp.Symbol(f"_w{r}", real=True) for r in range(n - m)]
    put = dict(zip(c.v, given.velocity, strict=True))
    off = given.inverse[:, m:] * sp.Matrix(n - m, 1, w)
    whole = shortest(L.xreplace({v: e + off[j] for j, (v, e) in enumerate(put.items())}))
    at_rest = dict.fromkeys(w, sp.S.Zero)
    pi = gradient(whole, (*speeds, *w)).xreplace(at_rest)
    bar, K = whole.xreplace(at_rest), jacobian(list(given.rows), c.v)
    still = dict.fromkeys(c.a, sp.S.Zero)
    turns = jacobian(list(given.rows), c.q) - K.applyfunc(lambda e: total_derivative(e, c).xreplace(still))
    twist = (turns * given.B).applyfunc(lambda e: shortest(e.xreplace(put)))
    drift = pi[:m, :].applyfunc(lambda e: along(e, (*c.q, t), (*given.velocity, 1)))
    h = drift - given.B.T * gradient(bar, c.q) - twist.T * pi
    return jacobian(list(pi[:m, :]), speeds), h.applyfunc(shortest)


def inverse_of(
    K: sp.Matrix, held: Sequence[sp.Expr], c: Coordinates, keep: Stages | None = None
) -> tuple[list[Stage], sp.Matrix, list[sp.Expr]]:
    """Stages, K⁻¹ made of them, and the factors of det K that depend on q or t. held: polynomials in q that are zero. keep:
    stages by which K is made, and each entry that is found is.

    Block by block, each solved after those that it depends on. A block with orthogonal rows is inverted by its transpose, a
    small one by its adjugate, another by K⁻¹ = Kᵀ (K Kᵀ)⁻¹, which needs no pivots.
    """
    n = K.rows
    stages, short, prefix = (keep.made, keep, "_j") if keep else ([], _reduced, "_k")
    inverse, factors, solved = sp.zeros(n, n), list[sp.Expr](), list[int]()
    for number, (rows, columns) in enumerate(_blocks(K)):
        block = K.extract(rows, columns)
        gram = block * block.T
        if all(sp.expand(gram[i, j]) == 0 for i in range(len(rows)) for j in range(i)):
            lengths = (
                [_on(shortest(gram[i, i]), held, c) for i in range(len(rows))] if len(rows) > 1 else [block[0] ** 2]
            )
            own = block.T * sp.diag(*(1 / e for e in lengths))
            factors += lengths
        elif len(rows) <= _SMALL:
            determinant = short(block.det(method="berkowitz"))
            own = (block.adjugate(method="berkowitz") / determinant).applyfunc(short)
            factors.append(determinant)
        else:
            made, normal = solve_symmetric(gram, sp.eye(len(rows)), f"{prefix}{number}")
            stages += made
            own = block.T * normal
        right = sp.eye(n).extract(rows, list(range(n))) - K.extract(rows, solved) * inverse.extract(
            solved, list(range(n))
        )
        for i, line in enumerate((own * right).tolist()):
            inverse[columns[i], :] = sp.Matrix([[short(e) for e in line]])
        solved += columns
    moving = {*c.q, t}
    factors = [f for e in factors if _written(e) for f in sp.Mul.make_args(sp.factor(e))]
    poles = [f for f in factors if f.free_symbols & moving]
    return stages, inverse, list(dict.fromkeys(f.base if f.is_Pow else f for f in poles))


def _blocks(K: sp.Matrix) -> list[tuple[list[int], list[int]]]:
    """Rows and columns of the blocks of K, made triangular: rows with one unknown first, columns with one row last."""
    rows, columns = {*range(K.rows)}, {*range(K.rows)}
    across = {i: {j for j in columns if K[i, j] != 0} for i in rows}
    down = {j: {i for i in rows if j in across[i]} for j in columns}
    first, last = list[tuple[list[int], list[int]]](), list[tuple[list[int], list[int]]]()

    def unknowns(i: int) -> list[int]:
        return sorted(across[i] & columns)

    def users(j: int) -> list[int]:
        return sorted(down[j] & rows)

    while rows:
        if single := next((([i], unknowns(i)) for i in sorted(rows) if len(unknowns(i)) == 1), None):
            first.append(single)
        elif single := next(((users(j), [j]) for j in sorted(columns) if len(users(j)) == 1), None):
            last.append(single)
        else:
            break
        rows, columns = rows - {*single[0]}, columns - {*single[1]}
    while rows:
        block, held, fresh = set[int](), set[int](), {min(rows)}
        while fresh:
            block |= fresh
            held |= set().union(*(unknowns(i) for i in fresh))
            fresh = set[int]().union(*(users(j) for j in held)) - block
        first.append((sorted(block), sorted(held)))
        rows -= block
    return [*first, *reversed(last)]


def _written(e: Any) -> bool:
    """Whether it is short enough to be factored and reduced."""
    return bool(sp.count_ops(e) <= _SHORT)


def _reduced(e: sp.Expr) -> sp.Expr:
    return shortest(e) if _written(e) else e


def _on(e: sp.Expr, held: Sequence[sp.Expr], c: Coordinates) -> sp.Expr:
    """A polynomial in q less what vanishes with `held`."""
    own = [g for g in held if g.free_symbols <= {*c.q} and g.free_symbols & e.free_symbols]
    if not own or not all(g.is_polynomial(*c.q) for g in (*own, e)):
        return e
    return sp.reduced(e, own, *sorted(set().union(*(g.free_symbols for g in own)), key=str))[1]


def _values(matrix: sp.Matrix) -> list[list[list[float]]]:
    """The matrix in numbers at some random states, where it has a value."""
    unknown = matrix.atoms(sp.Derivative, sp.core.function.AppliedUndef)
    plain = matrix.xreplace({f: sp.Symbol(f"_f{i}", real=True) for i, f in enumerate(sorted(unknown, key=str))})
    letters = sorted(plain.free_symbols, key=str)
    function = sp.lambdify(letters, plain.tolist(), "math", cse=True, dummify=True)
    found = []
    for point in points(letters, _STATES):
        with suppress(ArithmeticError, ValueError):
            found.append([[float(e) for e in row] for row in function(*(float(point[s]) for s in letters))])
    return found


def independent_rows(matrix: sp.Matrix, most: int) -> list[int]:
    """The rows, in order, that do not depend on those before them, at the random state where they are most; no more than
    `most`."""
    best: list[int] = []
    for rows in _values(matrix):
        kept, basis = list[int](), list[list[float]]()
        for i, row in enumerate(rows):
            rest = _without(row, basis)
            if len(kept) < most and max(map(abs, rest)) > _ROUNDING * (max(map(abs, row)) or 1.0):
                size = sum(x * x for x in rest) ** 0.5
                kept.append(i)
                basis.append([x / size for x in rest])
        best = kept if len(kept) > len(best) else best
    return best


def _without(row: Sequence[float], basis: Sequence[Sequence[float]]) -> list[float]:
    """A row less its components along orthonormal ones, taken away twice."""
    rest = list(row)
    for _ in range(2):
        for other in basis:
            along = sum(x * y for x, y in zip(rest, other, strict=True))
            rest = [x - along * y for x, y in zip(rest, other, strict=True)]
    return rest
