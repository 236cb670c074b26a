"""Small motion about rest or a steady motion in symbols, what rolls and what drives included: x' = A x + B u, y = C x + D u.

With M a + h − Q − Gᵀ λ = 0 and G a + γ = 0, small changes of q, v and of inputs u give those of a and λ by

    M δa − Gᵀ δλ = −(∂F/∂q δq + ∂F/∂v δv + ∂F/∂u δu),        G δa = −(∂γ/∂q δq + ∂γ/∂v δv),

F the left side at a = 0. On the constraints Φ = (g, G v + b) = 0 some of (q, v) are given by the others, the states x.

Schwab & Meijaard, Linearized dynamics of nonholonomic systems (2003).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp
from sympy.polys.matrices import DomainMatrix
from sympy.polys.matrices.exceptions import DMNonInvertibleMatrixError

from lagrotor.algebra import along, decide_zero
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import by_symbol, expression, put_in, shortest
from lagrotor.mechanics.lagrangian import jacobian, t


@dataclass(frozen=True, eq=False)
class StateEquations:
    """x' = A x + B u, y = C x + D u in symbols, for small x: changes of `states`, coordinates and velocities."""

    states: tuple[sp.Symbol, ...]
    A: sp.Matrix
    B: sp.Matrix
    C: sp.Matrix
    D: sp.Matrix

    def characteristic(self, s: sp.Symbol) -> sp.Expr:
        """det(s − A), factored."""
        return sp.factor(self.A.charpoly(s).as_expr())


def state_equations(
    system: Equations, at: Mapping[Any, Any], inputs: Sequence[sp.Symbol] = (), outputs: Sequence[sp.Expr] = ()
) -> StateEquations:
    """The linear system about a point (coordinates and velocities, others zero) at which all accelerations vanish.

    inputs: letters of the system, zero there unless `at` gives them. outputs: expressions in q, v, a and the multipliers.
    Raises SingularError where accelerations are left or the point is singular, InputError for a coordinate without a value, for
    coefficients that change with time, or a point that is off the constraints.
    """
    c, n = system.c, len(system.c.q)
    wanted = tuple(expression(f"linearise: outputs[{i}]", e) for i, e in enumerate(outputs))
    letters = {*c.q, *c.v} | system.L.free_symbols | system.push.free_symbols | system.residual.free_symbols
    if strangers := [str(u) for u in inputs if u not in letters or u in (*c.q, *c.v, t)]:
        raise InputError(
            f"linearise: inputs {', '.join(strangers)} are no letters of the system's forces or constraints"
        )
    point = by_symbol(at, letters)
    used = system.motion.free_symbols | system.residual.free_symbols
    if t in used:
        raise InputError("linearise: the motion depends on time explicitly: there is no steady motion; simulate it")
    if missing := [str(q) for q in c.q if q not in point and q in used]:
        raise InputError(f"linearise: {', '.join(missing)} without a value: the point needs each coordinate's")
    here = dict.fromkeys((*c.v, *c.a, *inputs), sp.S.Zero) | {s: sp.sympify(x) for s, x in point.items()}

    def there(matrix: sp.Matrix) -> sp.Matrix:
        found = matrix.applyfunc(lambda e: shortest(put_in(e, here)))
        if found.has(sp.nan, sp.zoo, sp.oo):
            raise SingularError(
                f"linearise: the equations are singular at {dict(at)}: use coordinates that are regular there"
            )
        return found

    off = there(sp.Matrix([*system.constraints, *system.residual]))
    if wrong := [e for e in off if decide_zero(e).answer == "nonzero"]:
        raise InputError(
            f"linearise: the point is off the constraints: {wrong[0]} is left of one: give coordinates and velocities on them"
        )
    lam = system.multipliers
    M, G = there(system.mass), there(system.rows)
    k = len(lam)
    saddle = M.row_join(-G.T).col_join(G.row_join(sp.zeros(k, k)))
    still = dict.fromkeys(c.a, sp.S.Zero)
    free = sp.Matrix([put_in(e, still) for e in system.motion.subs(dict.fromkeys(lam, 0))])
    held = _solved(saddle, -there(free).col_join(there(system.gamma)), at)
    if left := [f"{a} = {e}" for a, e in zip(c.a, held[:n], strict=True) if decide_zero(e).answer != "zero"]:
        raise SingularError(
            f"linearise: {dict(at)} is no steady motion: {', '.join(left)} is left over; start from one"
        )
    here |= dict(zip(lam, held[n:], strict=True))
    state = (*c.q, *c.v)
    whole = sp.Matrix([put_in(e, still) for e in system.motion]).col_join(system.gamma)
    slope = jacobian(list(whole), (*state, *inputs))
    moving = {q: here[v] for q, v in zip(c.q, c.v, strict=True) if here[v] != 0 and q in slope.free_symbols}
    drift = slope.applyfunc(lambda e: along(e, moving, moving.values()))
    if moving and any(decide_zero(e).answer != "zero" for e in there(drift)):
        raise InputError(
            "linearise: what moves there enters the equations, whose coefficients change with time: use coordinates that "
            "turn along with the motion"
        )
    moved = _solved(saddle, -there(slope), at)
    both = sp.zeros(n, n).row_join(sp.eye(n)).row_join(sp.zeros(n, len(inputs))).col_join(moved[:n, :])
    places, T = _tangent(
        there(jacobian([*system.constraints, *system.residual], state)), 2 * n, len(system.constraints), n
    )
    own = [i for i in range(2 * n) if i not in places]
    shown = jacobian(list(wanted), (*state, *inputs)) if wanted else sp.zeros(0, 2 * n + len(inputs))
    by_rest = there(jacobian(list(wanted), (*c.a, *lam))) if wanted else sp.zeros(0, n + k)
    y = there(shown) + by_rest * moved if wanted else shown
    A, B = both[own, : 2 * n] * T, both[own, 2 * n :]
    return StateEquations(
        tuple(state[i] for i in own), *(m.applyfunc(sp.factor) for m in (A, B, y[:, : 2 * n] * T, y[:, 2 * n :]))
    )


def _solved(matrix: sp.Matrix, right: sp.Matrix, at: Any) -> sp.Matrix:
    """matrix⁻¹ right, in the field of its letters."""
    if not right.cols:
        return right
    both = DomainMatrix.from_Matrix(matrix.row_join(right), extension=True).to_field()
    A, b = both[:, : matrix.cols], both[:, matrix.cols :]
    try:
        return A.to_sparse().lu_solve(b.to_sparse()).to_Matrix().applyfunc(shortest)
    except DMNonInvertibleMatrixError:
        raise SingularError(
            f"linearise: the mass matrix is singular, or the constraints are dependent, at {dict(at)}: use other coordinates"
        ) from None


def _tangent(slope: sp.Matrix, size: int, held: int, n: int) -> tuple[list[int], sp.Matrix]:
    """The numbers of the states that the others give, coordinates before velocities, and T, with δ(q, v) = T x."""
    if not slope.rows:
        return [], sp.eye(size)
    point = next(iter(points(slope.free_symbols)))
    seen = slope.subs(point).evalf(20)
    chosen: list[int] = []
    for rows, columns in ((range(held), range(n - 1, -1, -1)), (range(held, slope.rows), range(size - 1, n - 1, -1))):
        part: list[int] = []
        for j in columns:
            block = seen[list(rows), [*part, j]]
            if len(part) < len(rows) and block.rank(iszerofunc=lambda x: abs(x) < 1e-12) > len(part):
                part.append(j)
        chosen += part
    own = [i for i in range(size) if i not in chosen]
    T = sp.zeros(size, len(own))
    given = -_solved(slope[:, chosen], slope[:, own], {})
    for i, j in enumerate(own):
        T[j, i] = 1
    for i, j in enumerate(chosen):
        T[j, :] = given[i, :]
    return chosen, T
