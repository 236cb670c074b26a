"""Small motion about rest or a steady motion in symbols, what rolls and what drives included: x' = A x + B u, y = C x + D u.

With M a + h − Q − Gᵀ λ = 0 and G a + γ = 0, small changes of q, v and of inputs u give those of a and λ by

    M δa − Gᵀ δλ = −(∂F/∂q δq + ∂F/∂v δv + ∂F/∂u δu),        G δa = −(∂γ/∂q δq + ∂γ/∂v δv),

F the left side at a = 0. On the constraints Φ = (g, G v + b) = 0 some of (q, v) are given by the others, the states x. For
velocities of one's own, Boltzmann's and Hamel's equations stand in the place of F.

A ball joint has small displacements y of its state (q, u), three turns ϑ about the axes of ω for its four quaternions:

    δ(q, u) = P y,    δq = ½ Eᵀ(q) ϑ of a quaternion,        y' = P⁻ (∂f/∂(q, u) P − P') y

about a motion (q, u)' = f, P⁻ the left inverse. In the turned axes nothing changes with time where a body only spins.

Schwab & Meijaard, Linearized dynamics of nonholonomic systems (2003).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import sympy as sp
from sympy.polys.matrices import DomainMatrix
from sympy.polys.matrices.exceptions import DMNonInvertibleMatrixError

from lagrotor.algebra import along, decide_zero, derivative, normal_form
from lagrotor.errors import InputError, NotExactError, SingularError
from lagrotor.mechanics.bodies.moving_frames import quaternion_rows
from lagrotor.mechanics.equations import Equations, rows_left
from lagrotor.mechanics.equilibria import Equilibrium
from lagrotor.mechanics.expressions import by_symbol, expression, put_in, shortest
from lagrotor.mechanics.lagrangian import euler_lagrange, jacobian, t
from lagrotor.mechanics.linear_modes import LinearSystem, is_identically_zero, reduced, stability_condition
from lagrotor.mechanics.quasi_velocities import independent_rows


def small_states(system: Equations) -> tuple[sp.Symbol, ...]:
    """The names of y: coordinates and velocities, turn_p for the small turn of a ball joint about the axis of p."""
    first = {joint.quaternion[0]: joint.omega for joint in system.ball_joints}
    gone = {q for joint in system.ball_joints for q in joint.quaternion[1:]}
    names = [
        [sp.Symbol(f"turn_{w}", real=True) for w in first[q]] if q in first else [q]
        for q in system.c.q
        if q not in gone
    ]
    return (*(s for part in names for s in part), *system.speeds)


def small_turns(system: Equations, state: Any) -> tuple[list[list[Any]], list[list[Any]]]:
    """P (d, k) and P⁻ (k, d) at a state of d components, affine in it."""
    c, joints = system.c, {joint.quaternion[0]: joint for joint in system.ball_joints}
    gone = {q for joint in joints.values() for q in joint.quaternion[1:]}
    columns, rows = list[dict[int, Any]](), list[dict[int, Any]]()
    for i, s in enumerate((*c.q, *system.speeds)):
        if s in joints:
            places = [c.q.index(q) for q in joints[s].quaternion]
            for row in quaternion_rows(*(state[j] for j in places)):
                columns.append({j: x / 2 for j, x in zip(places, row, strict=True)})
                rows.append({j: 2 * x for j, x in zip(places, row, strict=True)})
        elif s not in gone:
            columns.append({i: 1})
            rows.append({i: 1})
    d = len(c.q) + len(system.speeds)
    return [[e.get(j, 0) for e in columns] for j in range(d)], [[e.get(j, 0) for j in range(d)] for e in rows]


def no_turn(quaternion: Sequence[sp.Symbol], norm: float) -> str:
    """Why a quaternion cannot be a start."""
    return f"the quaternion ({', '.join(map(str, quaternion))}) has norm {norm:.3g} and gives no direction: give one of norm 1"


@dataclass(frozen=True, eq=False)
class StateEquations:
    """x' = A x + B u, y = C x + D u in symbols, for small x: changes of `states`, coordinates and velocities; turn_p is the small
    turn of a ball joint about the axis of p, in its turned axes."""

    states: tuple[sp.Symbol, ...]
    A: sp.Matrix
    B: sp.Matrix
    C: sp.Matrix
    D: sp.Matrix

    def characteristic(self, s: sp.Symbol) -> sp.Expr:
        """det(s − A), factored."""
        return sp.factor(self.A.charpoly(s).as_expr())

    @property
    def stable_if(self) -> sp.Basic:
        """When every motion but a drift stays bounded or decays: see `LinearSystem.stable_if`."""
        s = sp.Symbol("s")
        return stability_condition(sp.eye(self.A.rows) * s - self.A, s)


def state_equations(
    system: Equations, at: Mapping[Any, Any], inputs: Sequence[sp.Symbol] = (), outputs: Sequence[sp.Expr] = ()
) -> StateEquations:
    """The linear system about a point (coordinates and velocities, others zero) at which all accelerations vanish.

    inputs: letters of the system, zero there unless `at` gives them. outputs: expressions in q, v, a and the multipliers.
    Raises SingularError where accelerations are left or the point is singular, InputError for a coordinate without a value, for
    coefficients that change with time, or a point that is off the constraints.
    """
    given = system.kinematics
    V, F = (sp.Matrix(system.c.v), system.motion) if given is None else (given.velocity, system.hamel)
    put = dict(zip(system.c.v, V, strict=True))
    wanted = [_in_speeds(system, expression(f"linearise: outputs[{i}]", e), put) for i, e in enumerate(outputs)]
    G, gamma = (e.xreplace(put) for e in rows_left(system))
    units = [joint.unit_length for joint in system.ball_joints]
    held = [g for g in system.constraints if g not in units]
    residual = [system.residual[i].xreplace(put) for i in system.left]
    letters = system.L.free_symbols.union(
        system.generalised_forces.free_symbols, *(e.free_symbols for e in system.residual)
    )
    inputs = tuple({str(s): s for s in letters}.get(str(u), u) for u in inputs)
    here = _place(system, at, inputs, [*F, *V], residual)
    there = partial(_values, at, here)
    state, rates, lam = (*system.c.q, *system.speeds), system.speed_rates, [system.multipliers[i] for i in system.left]
    n, m, k = len(system.c.q), len(rates), len(lam)
    singular = f"linearise: the mass matrix is singular, or the constraints are dependent, at {dict(at)}: use other coordinates"
    saddle = jacobian(list(F), (*rates, *lam)).col_join(G.row_join(sp.zeros(k, k)))
    whole = sp.Matrix([put_in(e, dict.fromkeys(rates, sp.S.Zero)) for e in F]).col_join(gamma)
    free = whole.applyfunc(lambda e: put_in(e, dict.fromkeys(lam, sp.S.Zero)))
    rest = _solved(there(saddle), -there(free), singular)
    if left := [f"{a} = {e}" for a, e in zip(rates, rest[:m], strict=True) if decide_zero(e).answer != "zero"]:
        raise SingularError(
            f"linearise: {dict(at)} is no steady motion: {', '.join(left)} is left over; start from one"
        )
    here |= dict(zip(lam, rest[m:], strict=True))
    P, back = map(sp.Matrix, small_turns(system, state))
    slope = (jacobian(list(whole), state) * P).row_join(jacobian(list(whole), inputs))
    _check_steady(system, here, there(V), whole, (*slope, *saddle))
    moved, size = _solved(there(saddle), -there(slope), singular), P.cols
    turning = P[:n, :].applyfunc(lambda e: along(e, system.c.q, V))
    carried = there(jacobian(list(V), state) * P - turning).row_join(sp.zeros(n, len(inputs)))
    both = there(back) * carried.col_join(moved[:m, :])
    places, T = _tangent(there(jacobian([*held, *residual], state) * P), size, len(held), size - m)
    own = [i for i in range(size) if i not in places]
    shown = (jacobian(wanted, state) * P).row_join(jacobian(wanted, inputs))
    y = there(shown) + there(jacobian(wanted, (*rates, *lam))) * moved
    names, parts = small_states(system), (both[own, :size] * T, both[own, size:], y[:, :size] * T, y[:, size:])
    return StateEquations(tuple(names[i] for i in own), *(e.applyfunc(sp.factor) for e in parts))


def linearise(system: Equations, at: Mapping[Any, Any] | Equilibrium) -> LinearSystem:
    """The linear system about an equilibrium, in a basis of the null space of the constraints.

    at: values of the coordinates on which the motion depends; velocities are zero unless given (a steady motion in a
    coordinate on which nothing depends), and a parameter may be given too. Where the equations are 0/0 there, they are
    first reduced.

    Raises SingularError when the point is no equilibrium, or a singular one of these coordinates, or the constraints are
    dependent there; InputError when something depends on time.
    """
    c, point = system.c, at.at if isinstance(at, Equilibrium) else at
    if system.generalised_forces.free_symbols & {*system.multipliers}:
        raise InputError(
            "linearise: a force has the reaction of a constraint: give outputs or a velocity, for A, B, C, D"
        )
    motion = euler_lagrange(system.L, c) - system.generalised_forces
    here = _place(system, point, (), motion, list(system.residual))
    there = partial(_values, point, here)
    force, G = there(motion), there(system.rows)
    dependent = f"linearise: the constraints are dependent at {at}: leave out what follows from the others"
    lam = G * force if not G.rows else _solved(G * G.T, G * force, dependent)
    left = [decide_zero(e).answer for e in force - G.T * lam]
    # What `equilibria` solved is an equilibrium, also where its roots are outside the class that is decided.
    if "nonzero" in left or ("undecided" in left and not isinstance(at, Equilibrium)):
        raise SingularError(f"linearise: {at} is no equilibrium: a force is left over; start from one")
    held = motion - system.rows.T * lam
    slopes = [jacobian(held, names) for names in (c.a, c.v, c.q)]
    _check_steady(system, here, [here[v] for v in c.v], held, [e for m in (*slopes, system.rows) for e in m])
    basis = sp.Matrix.hstack(*G.nullspace(iszerofunc=is_identically_zero)) if G.rows else sp.eye(len(c.q))
    mass, gyroscopic, stiffness = ((basis.T * there(m) * basis).applyfunc(reduced) for m in slopes)
    if is_identically_zero(mass.det(method="berkowitz")):
        raise SingularError(f"linearise: the mass matrix is singular at {point}: use coordinates regular there")
    return LinearSystem(mass, gyroscopic, stiffness, basis)


def _place(
    system: Equations,
    at: Mapping[Any, Any],
    inputs: Sequence[sp.Symbol],
    motion: Sequence[sp.Expr],
    residual: Sequence[sp.Expr],
) -> dict[sp.Symbol, sp.Expr]:
    """The point, what it does not name being zero. Raises InputError where an input or a coordinate is amiss, time enters the
    equations of motion, or it is off the constraints."""
    c, speeds, parts = system.c, system.speeds, [*motion, *system.residual]
    used = set[sp.Basic]().union(*(e.free_symbols for e in parts))
    letters = {*c.q, *speeds} | system.L.free_symbols | system.generalised_forces.free_symbols | used
    if strangers := [str(u) for u in inputs if u not in letters or u in (*c.q, *c.v, *speeds, t)]:
        raise InputError(
            f"linearise: inputs {', '.join(strangers)} are no letters of the system's forces or constraints"
        )
    letters = letters - {*c.v} | {*speeds}
    point = by_symbol("linearise: at", at, letters)
    if strangers := [str(s) for s in point if s not in letters]:
        raise InputError(
            f"linearise: {', '.join(strangers)} in the point: it gives coordinates, velocities "
            f"({', '.join(map(str, speeds))}) and letters of the system"
        )
    for joint in system.ball_joints:
        if all(q in point and point[q] == 0 for q in joint.quaternion):
            raise InputError(f"linearise: {no_turn(joint.quaternion, 0)}")
    if any(decide_zero(derivative(e, t)).answer != "zero" for e in parts):
        raise InputError(
            "linearise: the motion depends on time explicitly: write a letter for an input F(t), or simulate it"
        )
    if missing := [str(q) for q in c.q if q not in point and q in used]:
        raise InputError(f"linearise: {', '.join(missing)} without a value: the point needs each coordinate's")
    here = dict.fromkeys((*c.q, *c.v, *c.a, *speeds, *system.speed_rates, *inputs), sp.S.Zero)
    here |= {s: expression(f"linearise: {s}", x) for s, x in point.items()}
    off = _values(at, here, sp.Matrix([*system.constraints, *residual]))
    if wrong := [e for e in off if decide_zero(e).answer == "nonzero"]:
        raise InputError(
            f"linearise: the point is off the constraints: {wrong[0]} is left of one: give coordinates and velocities on them"
        )
    return here


def _values(at: Mapping[Any, Any], here: Mapping[Any, sp.Expr], matrix: sp.Matrix) -> sp.Matrix:
    """The matrix at the point; an entry that is 0/0 there is reduced before. Raises SingularError or InputError where it has no
    values."""
    numbers = {s: x for s, x in here.items() if not x.free_symbols}

    def value(e: sp.Expr) -> sp.Expr:
        e = put_in(e, {s: x for s, x in here.items() if x.free_symbols})
        number = put_in(e, numbers)
        if number.has(sp.nan, sp.zoo, sp.oo):
            try:
                number = put_in(normal_form(e), numbers)
            except NotExactError:
                number = sp.nan
        return shortest(number)

    values = matrix.applyfunc(value) if len(matrix) else matrix
    if values.has(sp.nan, sp.zoo, sp.oo):
        raise SingularError(
            f"linearise: the equations are singular at {dict(at)}: use coordinates that are regular there"
        )
    if values.has(sp.DiracDelta):
        raise InputError(f"linearise: forces jump at {dict(at)}: write the case that holds there")
    return values


def _check_steady(
    system: Equations,
    here: Mapping[Any, sp.Expr],
    flow: Sequence[sp.Expr],
    forces: Sequence[sp.Expr],
    coefficients: Any,
) -> None:
    """Raise InputError where they change as what moves goes on; a ball joint turns about an axis that stays."""
    time = sp.Dummy("tau", real=True)
    rates = dict(zip(system.c.q, flow, strict=True))
    course = {q: here[q] + v * time for q, v in rates.items() if v != 0}
    for joint in system.ball_joints:
        if rate := shortest(sp.sqrt(sp.Add(*(rates[q] ** 2 for q in joint.quaternion)))):
            turned = {
                q: here[q] * sp.cos(rate * time) + rates[q] / rate * sp.sin(rate * time) for q in joint.quaternion
            }
            course |= turned
    for parts, name in ((forces, "forces"), (coefficients, "coefficients")):
        for e in parts:
            if (moving := e.free_symbols & course.keys()) and decide_zero(
                derivative(put_in(put_in(e, course), here), time)
            ).answer != "zero":
                raise InputError(
                    f"linearise: {', '.join(sorted(map(str, moving)))} moves there and enters the equations, whose {name} "
                    "change with time: use coordinates that turn along with the motion"
                )


def _in_speeds(system: Equations, e: sp.Expr, put: Mapping[Any, Any]) -> sp.Expr:
    """An output in q, u, u' and the multipliers that are left."""
    given = system.kinematics
    if given is None:
        return e
    if e.free_symbols & {system.multipliers[i] for i in given.used}:
        raise InputError(
            f"linearise: output {e} has the reaction of a constraint that the velocities use up: leave these out"
        )
    accelerations = given.B * sp.Matrix(system.speed_rates) + given.alpha
    return e.xreplace(dict(zip(system.c.a, accelerations, strict=True))).xreplace(dict(put))


def _solved(matrix: sp.Matrix, right: sp.Matrix, refusal: str) -> sp.Matrix:
    """matrix⁻¹ right, in the field of its letters. Raises SingularError(refusal) where there is none."""
    if not right.cols:
        return right
    both = DomainMatrix.from_Matrix(matrix.row_join(right), extension=True).to_field()
    A, b = both[:, : matrix.cols], both[:, matrix.cols :]
    try:
        return A.to_sparse().lu_solve(b.to_sparse()).to_Matrix().applyfunc(shortest)
    except DMNonInvertibleMatrixError:
        raise SingularError(refusal) from None


def _tangent(slope: sp.Matrix, size: int, held: int, n: int) -> tuple[list[int], sp.Matrix]:
    """The numbers of the states that the others give, coordinates before velocities, and T, with δ(q, v) = T x."""
    if not slope.rows:
        return [], sp.eye(size)
    chosen: list[int] = []
    for rows, columns in ((range(held), range(n - 1, -1, -1)), (range(held, slope.rows), range(size - 1, n - 1, -1))):
        kept = independent_rows(slope.extract(list(rows), list(columns)).T, len(rows)) if rows else []
        chosen += [columns[i] for i in kept]
    own = [i for i in range(size) if i not in chosen]
    T = sp.zeros(size, len(own))
    given = -_solved(
        slope[:, chosen],
        slope[:, own],
        "linearise: the constraints are dependent at the point: leave out what follows from the others",
    )
    for i, j in enumerate(own):
        T[j, i] = 1
    for i, j in enumerate(chosen):
        T[j, :] = given[i, :]
    return chosen, T
