"""Quasi-velocities u = A(q, t) v + a(q, t), and the velocities v = q' that they give.

If u has fewer components than q, constraints G v + g = 0 supply the missing rows and hold for every u:

    [A]     [u − a]
    [G] v = [ − g ],        v = B u + b,        v' = B u' + α,

with α the accelerations at u' = 0. Multiplied by Bᵀ, the equations of motion lose the multipliers of these constraints,

    Bᵀ (M B u' + M α + h − Q) = (G' B)ᵀ λ,

with G' the rows of the other constraints. At a pole det [A; G] = 0, and u does not determine v.

Hamel, Theoretische Mechanik (1949), §§ 235–242; Kane & Levinson, Dynamics: Theory and Applications (1985), ch. 2.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import sympy as sp

from lagrotor.algebra import along
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.small_matrices import Stages
from lagrotor.mechanics.expressions import expression, shortest
from lagrotor.mechanics.lagrangian import Coordinates, depends_on, gradient, is_affine, jacobian, t, total_derivative
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
    taken, later = {*c.q, *c.a, t}, {u for u, e in pairs if isinstance(u, sp.Symbol) and u != e} - definitions.keys()
    for u, e in pairs:
        name = f"System: velocities[{u}]"
        if not isinstance(u, sp.Symbol) or u in taken:
            raise InputError(f"{name}: a quasi-velocity must be named by a symbol without another meaning: rename it")
        e = expression(name, e).xreplace(definitions)
        if u in c.v and e != u:
            raise InputError(f"{name} = {e}: {u} is the velocity of a coordinate and cannot be redefined: rename it")
        if wrong := e.free_symbols & later:
            raise InputError(f"{name} = {e} contains {min(map(str, wrong))}, which is defined after it: put that first")
        if wrong := e.free_symbols & {*c.a}:
            raise InputError(f"{name} = {e} contains {min(map(str, wrong))}: write it in q, v and t")
        if not depends_on(e, c.v):
            raise InputError(f"{name} = {e} has no velocity of a coordinate: write it as sum_j A_j(q, t) v_j + a(q, t)")
        if not is_affine(e, c.v):
            raise InputError(f"{name} = {e} is not affine in the velocities: write it as sum_j A_j(q, t) v_j + a(q, t)")
        checked.append((u, e))
        definitions |= {u: e} if u != e else {}
        later.discard(u)
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
    n, entries = K.rows, rows_of(K)
    stages, short, prefix = (keep.made, keep, "_j") if keep else ([], _reduced, "_k")
    inverse, factors = dict[int, dict[int, sp.Expr]](), list[sp.Expr]()
    for number, (rows, columns) in enumerate(_blocks(entries)):
        block = K.extract(rows, columns)
        gram = block * block.T
        if all(sp.expand(gram[i, j]) == 0 for i in range(len(rows)) for j in range(i)):
            squares = [shortest(gram[i, i]) for i in range(len(rows))]
            modulo = {e: _modulo(e, relations, c) for e in {*squares}}
            lengths = [modulo[e] for e in squares] if len(rows) > 1 else [block[0] ** 2]
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
        # The rows K x = e_i of the block, with the columns solved before on the right side.
        right = [
            _combined([({i: sp.S.One}, sp.S.One), *((inverse[j], -e) for j, e in entries[i].items() if j in inverse)])
            for i in rows
        ]
        for j, factors_of_rows in zip(columns, block_inverse.tolist(), strict=True):
            inverse[j] = {k: short(e) for k, e in _combined(zip(right, factors_of_rows, strict=True)).items()}
    moving = {*c.q, t}
    factors = [f for e in factors if _is_short(e) for f in sp.Mul.make_args(sp.factor(e))]
    poles = [f for f in factors if f.free_symbols & moving]
    whole = sp.SparseMatrix(n, n, {(j, k): e for j, row in inverse.items() for k, e in row.items()})
    return stages, whole, list(dict.fromkeys(f.base if f.is_Pow else f for f in poles))


def _combined(rows: Iterable[tuple[Mapping[int, sp.Expr], sp.Expr]]) -> dict[int, sp.Expr]:
    """Return the sum of sparse rows, each times a factor."""
    terms = defaultdict[int, list[sp.Expr]](list)
    for row, factor in rows:
        for k, e in row.items() if factor != 0 else ():
            terms[k].append(e * factor)
    return {k: e for k, products in terms.items() if (e := sp.Add(*products)) != 0}


def rows_of(matrix: sp.Matrix) -> list[dict[int, sp.Expr]]:
    """Return the rows of a matrix, each as a mapping from columns to the entries that are not zero."""
    rows: list[dict[int, sp.Expr]] = [{} for _ in range(matrix.rows)]
    for (i, j), e in sorted(matrix.todok().items(), key=itemgetter(0)):
        rows[i][j] = e
    return rows


def _blocks(entries: Sequence[Mapping[int, sp.Expr]]) -> list[tuple[list[int], list[int]]]:
    """Return (rows, columns) of each block of a block-triangular form of a square matrix, which is given by its sparse rows.

    Rows with one unknown come first, columns that a single row contains come last.
    """
    rows, columns = {*range(len(entries))}, {*range(len(entries))}
    columns_of = [{*row} for row in entries]
    users_of: list[set[int]] = [set() for _ in columns]
    for i, members in enumerate(columns_of):
        for j in members:
            users_of[j].add(i)
    first, last = list[tuple[list[int], list[int]]](), list[tuple[list[int], list[int]]]()

    def unknowns(i: int) -> list[int]:
        return sorted(columns_of[i] & columns)

    def users(j: int) -> list[int]:
        return sorted(users_of[j] & rows)

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


def _values(matrix: sp.Matrix) -> list[list[dict[int, float]]]:
    """Evaluate the sparse rows of the matrix at random states; leave out those at which it has no value."""
    unknown = matrix.atoms(sp.Derivative, sp.core.function.AppliedUndef)
    plain = matrix.xreplace({f: sp.Symbol(f"_f{i}", real=True) for i, f in enumerate(sorted(unknown, key=str))})
    symbols = sorted(plain.free_symbols, key=str)
    names = {s: sp.Symbol(f"x{i}") for i, s in enumerate(symbols)}  # sympy would rename them one after another
    rows = rows_of(plain.xreplace(names))
    function = sp.lambdify([*names.values()], [e for row in rows for e in row.values()], "math", cse=True)
    values = []
    for point in points(symbols, _STATES):
        with suppress(ArithmeticError, ValueError):
            numbers = iter(function(*(float(point[s]) for s in symbols)))
            values.append([{j: float(next(numbers)) for j in row} for row in rows])
    return values


def independent_rows(matrix: sp.Matrix, rank: int) -> list[int]:
    """Return the indices of the first independent rows, at most `rank`, at the random state that has most of them."""
    best: list[int] = []
    for rows in _values(matrix):
        chosen, basis, users = list[int](), list[dict[int, float]](), defaultdict[int, list[int]](list)
        for i, row in enumerate(rows):
            remainder = _without(row, basis, users)
            largest = max(map(abs, remainder.values()), default=0.0)
            if len(chosen) < rank and largest > _ROUNDING * max(map(abs, row.values()), default=1.0):
                size = sum(x * x for x in remainder.values()) ** 0.5
                chosen.append(i)
                for j in remainder:
                    users[j].append(len(basis))
                basis.append({j: x / size for j, x in remainder.items()})
        best = chosen if len(chosen) > len(best) else best
    return best


def _without(
    row: Mapping[int, float], basis: Sequence[Mapping[int, float]], users: Mapping[int, Sequence[int]]
) -> dict[int, float]:
    """Subtract from a sparse row its components along orthonormal vectors, twice to reduce rounding errors.

    `users` gives for each column the numbers of the vectors in which it occurs.
    """
    remainder = dict(row)
    for _ in range(2):
        for k in sorted({k for j in remainder for k in users[j]}):
            component = sum(x * basis[k].get(j, 0.0) for j, x in remainder.items())
            for j, x in basis[k].items():
                remainder[j] = remainder.get(j, 0.0) - component * x
    return remainder
