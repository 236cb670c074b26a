"""Small motion about an equilibrium or a steady motion in symbols, with rolling and inputs: x' = A x + B u, y = C x + D u.

With F = M a + h − Q − Gᵀ λ = 0 and G a + γ = 0, small changes of q, v and of the inputs u determine the small changes of a
and λ,

    M δa − Gᵀ δλ = −(∂F/∂q δq + ∂F/∂v δv + ∂F/∂u δu),        G δa = −(∂γ/∂q δq + ∂γ/∂v δv),

with F and γ at a = 0. The constraints Φ = (g, G v + b) = 0 express some of (q, v) by the others, which are the states x. With
quasi-velocities the Boltzmann–Hamel equations replace F.

With a ball joint, small displacements y replace changes of the state (q, u). In y three rotations ϑ about the axes of ω
replace the four components of the quaternion:

    δ(q, u) = P y,    δq = ½ Eᵀ(q) ϑ of a quaternion,        y' = P⁻ (∂f/∂(q, u) P − P') y

about a motion (q, u)' = f, with the left inverse P⁻ of P. In axes fixed to a spinning body the coefficients are constant.

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
from lagrotor.result_display import Shown

Point = Mapping[Any, Any]


def small_states(system: Equations) -> tuple[sp.Symbol, ...]:
    """Return the symbols of the small displacements y: coordinates and velocities.

    For a ball joint with the angular velocities p, q, r the small rotations turn_p, turn_q, turn_r replace the quaternion.
    """
    first = {joint.quaternion[0]: joint.omega for joint in system.ball_joints}
    gone = {q for joint in system.ball_joints for q in joint.quaternion[1:]}
    turns = {q: [sp.Symbol(f"turn_{w}", real=True) for w in omega] for q, omega in first.items()}
    names = [turns.get(q, [q]) for q in system.c.q if q not in gone]
    return (*(s for group in names for s in group), *system.variables[len(system.c.q) :])


def small_turns(system: Equations, state: Any) -> tuple[list[list[Any]], list[list[Any]]]:
    """Return P, shape (d, k), with δ(q, u) = P y, and its left inverse, shape (k, d), as lists of rows.

    `state` are the d values of (q, u), on which the entries depend affinely.
    """
    c, joints = system.c, {joint.quaternion[0]: joint for joint in system.ball_joints}
    gone = {q for joint in joints.values() for q in joint.quaternion[1:]}
    columns, rows = list[dict[int, Any]](), list[dict[int, Any]]()
    for i, s in enumerate(system.variables):
        if s in joints:
            places = [c.q.index(q) for q in joints[s].quaternion]
            for row in quaternion_rows(*(state[j] for j in places)):
                columns.append({j: x / 2 for j, x in zip(places, row, strict=True)})
                rows.append({j: 2 * x for j, x in zip(places, row, strict=True)})
        elif s not in gone:
            columns.append({i: 1})
            rows.append({i: 1})
    d = len(system.variables)
    return [[e.get(j, 0) for e in columns] for j in range(d)], [[e.get(j, 0) for j in range(d)] for e in rows]


def no_turn(quaternion: Sequence[sp.Symbol], norm: float) -> str:
    """Return the end of an error message: why a quaternion is refused as an initial value."""
    return f"the quaternion ({', '.join(map(str, quaternion))}) has norm {norm:.3g} and gives no direction: give one of norm 1"


@dataclass(frozen=True, eq=False, repr=False)
class StateEquations(Shown):
    """The linear equations x' = A x + B u, y = C x + D u for small changes x of the states, in symbols.

    Attributes
    ----------
    states : tuple[Symbol, ...]
        The n independent coordinates and velocities; turn_p is the small rotation of a ball joint about the body's axis of p.
    A : Matrix
        State matrix, shape (n, n).
    B : Matrix
        Input matrix, shape (n, inputs).
    C : Matrix
        Output matrix, shape (outputs, n).
    D : Matrix
        Feedthrough matrix, shape (outputs, inputs).
    """

    _shown = (
        ("states x", "states"),
        ("A", "A"),
        ("B", "B"),
        ("C", "C"),
        ("D", "D"),
    )

    states: tuple[sp.Symbol, ...]
    A: sp.Matrix
    B: sp.Matrix
    C: sp.Matrix
    D: sp.Matrix

    def characteristic(self, s: sp.Symbol) -> sp.Expr:
        """Return the characteristic polynomial det(s − A), factored.

        Parameters
        ----------
        s : Symbol
            The rate.

        Returns
        -------
        Expr
            A polynomial in s of degree n.
        """
        return sp.factor(self.A.charpoly(s).as_expr())

    @property
    def stable_if(self) -> sp.Basic:
        """The condition on the parameters under which all motions but drifts stay bounded: see `LinearSystem.stable_if`."""
        s = sp.Symbol("s")
        return stability_condition(sp.eye(self.A.rows) * s - self.A, s)


def state_equations(
    system: Equations, at: Point, inputs: Sequence[sp.Symbol] = (), outputs: Sequence[sp.Expr] = ()
) -> StateEquations:
    """Linearise about a point at which all accelerations vanish.

    `at` gives the coordinates, and the velocities that are not zero. `inputs` are symbols of the system, which are zero at
    the point unless `at` gives them. `outputs` are expressions in q, v, a and the multipliers. Raises SingularError if an
    acceleration is not zero or the point is singular. Raises InputError if a coordinate is missing, the coefficients change
    with time, or the point is off the constraints.
    """
    kinematics = system.kinematics
    plain = sp.Matrix(len(system.c.q), 1, system.c.v), system.motion
    V, F = plain if kinematics is None else (kinematics.velocity, system.hamel)
    velocity_of = dict(zip(system.c.v, V, strict=True))
    named = [expression(f"linearise: outputs[{i}]", e) for i, e in enumerate(outputs)]
    measured = [_in_speeds(system, e, velocity_of) for e in named]
    G, gamma = (e.xreplace(velocity_of) for e in rows_left(system))
    units = [joint.unit_length for joint in system.ball_joints]
    configuration = [g for g in system.constraints if g not in units]
    residual = [system.residual[i].xreplace(velocity_of) for i in system.left]
    pairs = [(x, f.xreplace(velocity_of)) for x, f in system.states]
    x_dot = sp.Matrix(len(pairs), 1, [f for _, f in pairs])
    symbols = system.L.free_symbols.union(
        system.generalised_forces.free_symbols, x_dot.free_symbols, *(e.free_symbols for e in system.residual)
    )
    inputs = tuple({str(s): s for s in symbols}.get(str(u), u) for u in inputs)
    point = _place(system, at, inputs, [*F, *V, *x_dot], residual)
    evaluate = partial(_values, at, point)
    state, rates, lam = system.variables, system.speed_rates, [system.multipliers[i] for i in system.left]
    n, m, k = len(system.c.q), len(rates), len(lam)
    singular = f"linearise: the mass matrix is singular, or the constraints are dependent, at {dict(at)}: use other coordinates"
    saddle = jacobian(list(F), (*rates, *lam)).col_join(G.row_join(sp.zeros(k, k)))
    whole = sp.Matrix([put_in(e, dict.fromkeys(rates, sp.S.Zero)) for e in F]).col_join(gamma)
    free = whole.applyfunc(lambda e: put_in(e, dict.fromkeys(lam, sp.S.Zero)))
    solution = _solve_exactly(evaluate(saddle), -evaluate(free), singular)
    changes = zip((*rates, *(f"{x}'" for x, _ in pairs)), (*solution[:m], *evaluate(x_dot)), strict=True)
    if nonzero := [f"{a} = {e}" for a, e in changes if decide_zero(e).answer != "zero"]:
        raise SingularError(f"linearise: {dict(at)} is no steady motion: {', '.join(nonzero)} is not zero")
    point |= dict(zip(lam, solution[m:], strict=True))
    P, P_inverse = map(sp.Matrix, small_turns(system, state))
    slope = (jacobian(list(whole), state) * P).row_join(jacobian(list(whole), inputs))
    _check_steady(system, point, evaluate(V), whole, (*slope, *saddle))
    response, size = _solve_exactly(evaluate(saddle), -evaluate(slope), singular), P.cols
    turning = P[:n, :].applyfunc(lambda e: along(e, system.c.q, V))
    carried = evaluate(jacobian(list(V), state) * P - turning).row_join(sp.zeros(n, len(inputs)))
    of_states = evaluate((jacobian(list(x_dot), state) * P).row_join(jacobian(list(x_dot), inputs)))
    both = evaluate(P_inverse) * carried.col_join(response[:m, :]).col_join(of_states)
    bound = evaluate(jacobian([*configuration, *residual], state) * P)
    places, T = _tangent(bound, size, len(configuration), size - m - len(pairs))
    independent = [i for i in range(size) if i not in places]
    sensitivity = (jacobian(measured, state) * P).row_join(jacobian(measured, inputs))
    y = evaluate(sensitivity) + evaluate(jacobian(measured, (*rates, *lam))) * response
    blocks = both[independent, :size] * T, both[independent, size:], y[:, :size] * T, y[:, size:]
    names = small_states(system)
    return StateEquations(tuple(names[i] for i in independent), *(e.applyfunc(sp.factor) for e in blocks))


def linearise(system: Equations, at: Mapping[Any, Any] | Equilibrium) -> LinearSystem:
    """Return the linear system about an equilibrium, in a basis of the null space of the constraints.

    `at` gives the coordinates on which the motion depends, and parameters if wanted. Velocities are zero unless given; a
    steady motion has one in a coordinate on which nothing depends. Equations that are 0/0 at the point are first reduced.

    Raises SingularError if the point is no equilibrium, if these coordinates are singular there, or if the constraints are
    dependent there. Raises InputError if anything depends on time.
    """
    c, point = system.c, at.at if isinstance(at, Equilibrium) else at
    if system.generalised_forces.free_symbols & {*system.multipliers}:
        raise InputError("linearise: a force depends on a reaction: give outputs or a velocity, for A, B, C, D")
    motion = euler_lagrange(system.L, c) - system.generalised_forces
    values = _place(system, point, (), motion, list(system.residual))
    evaluate = partial(_values, point, values)
    force, G = evaluate(motion), evaluate(system.rows)
    dependent = f"linearise: the constraints are dependent at {at}: leave out what follows from the others"
    lam = G * force if not G.rows else _solve_exactly(G * G.T, G * force, dependent)
    answers = [decide_zero(e).answer for e in force - G.T * lam]
    # A result of `equilibria` is an equilibrium, even if its roots are outside the class of decisions.
    if "nonzero" in answers or ("undecided" in answers and not isinstance(at, Equilibrium)):
        raise SingularError(f"linearise: {at} is no equilibrium: the force is not zero; start from one")
    residual = motion - system.rows.T * lam
    slopes = [jacobian(residual, names) for names in (c.a, c.v, c.q)]
    _check_steady(system, values, [values[v] for v in c.v], residual, [e for m in (*slopes, system.rows) for e in m])
    basis = sp.Matrix.hstack(*G.nullspace(iszerofunc=is_identically_zero)) if G.rows else sp.eye(len(c.q))
    mass, gyroscopic, stiffness = ((basis.T * evaluate(m) * basis).applyfunc(reduced) for m in slopes)
    if is_identically_zero(mass.det(method="berkowitz")):
        raise SingularError(f"linearise: the mass matrix is singular at {point}: use coordinates regular there")
    return LinearSystem(mass, gyroscopic, stiffness, basis)


def _place(
    system: Equations, at: Point, inputs: Sequence[sp.Symbol], motion: Sequence[sp.Expr], residual: Sequence[sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """Return the point as {symbol: value}, with zero for velocities, accelerations and inputs that `at` does not name.

    Raises InputError for wrong names, equations that depend on time, or a point off the constraints.
    """
    c, speeds, equations = system.c, system.speeds, [*motion, *system.residual]
    used = set[sp.Basic]().union(*(e.free_symbols for e in equations))
    symbols = {*system.variables} | system.L.free_symbols | system.generalised_forces.free_symbols | used
    if strangers := [str(u) for u in inputs if u not in symbols or u in (*c.v, *system.variables, t)]:
        raise InputError(
            f"linearise: inputs {', '.join(strangers)} are no symbols of forces or constraints: leave them out"
        )
    symbols = symbols - {*c.v} | {*speeds}
    point = by_symbol("linearise: at", at, symbols)
    if strangers := [str(s) for s in point if s not in symbols]:
        raise InputError(
            f"linearise: {', '.join(strangers)} in the point: it gives coordinates, velocities "
            f"({', '.join(map(str, speeds))}) and symbols of the system"
        )
    for joint in system.ball_joints:
        if all(q in point and point[q] == 0 for q in joint.quaternion):
            raise InputError(f"linearise: {no_turn(joint.quaternion, 0)}")
    if any(decide_zero(derivative(e, t)).answer != "zero" for e in equations):
        raise InputError("linearise: it depends on time explicitly: write a symbol for an input F(t), or simulate it")
    if missing := [str(q) for q in (*c.q, *(x for x, _ in system.states)) if q not in point and q in used]:
        raise InputError(f"linearise: {', '.join(missing)} without a value: give the point a value for each coordinate")
    values = dict.fromkeys((*c.v, *c.a, *system.variables, *system.speed_rates, *inputs), sp.S.Zero)
    values |= {s: expression(f"linearise: {s}", x) for s, x in point.items()}
    residuals = _values(at, values, sp.Matrix([*system.constraints, *residual]))
    if wrong := [e for e in residuals if decide_zero(e).answer == "nonzero"]:
        raise InputError(f"linearise: the point is off the constraints: a residual is {wrong[0]}: give a point on them")
    return values


def _values(at: Point, point: Point, matrix: sp.Matrix) -> sp.Matrix:
    """Return the matrix at the point, where entries that are 0/0 are first reduced.

    Raises SingularError if an entry is singular there, and InputError if a force jumps there.
    """
    numbers = {s: x for s, x in point.items() if not x.free_symbols}

    def value(e: sp.Expr) -> sp.Expr:
        e = put_in(e, {s: x for s, x in point.items() if x.free_symbols})
        number = put_in(e, numbers)
        if number.has(sp.nan, sp.zoo, sp.oo):
            try:
                number = put_in(normal_form(e), numbers)
            except NotExactError:
                number = sp.nan
        return shortest(number)

    values = matrix.applyfunc(value) if len(matrix) else matrix
    if values.has(sp.nan, sp.zoo, sp.oo):
        raise SingularError(f"linearise: the equations are singular at {dict(at)}: use coordinates regular there")
    if values.has(sp.DiracDelta):
        raise InputError(f"linearise: forces jump at {dict(at)}: write the expression of one side alone")
    return values


def _check_steady(
    system: Equations, point: Point, flow: Sequence[sp.Expr], forces: Sequence[sp.Expr], coefficients: Any
) -> None:
    """Raise InputError if forces or coefficients change along the motion, in which a ball joint turns about a fixed axis."""
    time = sp.Dummy("tau", real=True)
    rates = dict(zip(system.c.q, flow, strict=True))
    course = {q: point[q] + v * time for q, v in rates.items() if v != 0}
    for joint in system.ball_joints:
        if rate := shortest(sp.sqrt(sp.Add(*(rates[q] ** 2 for q in joint.quaternion)))):
            c, s = sp.cos(rate * time), sp.sin(rate * time) / rate
            rotation = {q: point[q] * c + rates[q] * s for q in joint.quaternion}
            course |= rotation
    for expressions, name in ((forces, "forces"), (coefficients, "coefficients")):
        for e in expressions:
            if (moving := e.free_symbols & course.keys()) and decide_zero(
                derivative(put_in(put_in(e, course), point), time)
            ).answer != "zero":
                raise InputError(
                    f"linearise: {', '.join(sorted(map(str, moving)))} moves there and enters the equations, whose {name} "
                    "change with time: use coordinates that rotate with the motion"
                )


def _in_speeds(system: Equations, e: sp.Expr, velocity_of: Mapping[Any, Any]) -> sp.Expr:
    """Write an output as an expression in q, u, u' and the multipliers that quasi-velocities leave."""
    kinematics = system.kinematics
    if kinematics is None:
        return e
    if e.free_symbols & {system.multipliers[i] for i in kinematics.used}:
        raise InputError(
            f"linearise: output {e} depends on a reaction that quasi-velocities leave without a value: drop them"
        )
    accelerations = kinematics.B * sp.Matrix(system.speed_rates) + kinematics.alpha
    return e.xreplace(dict(zip(system.c.a, accelerations, strict=True))).xreplace(dict(velocity_of))


def _solve_exactly(matrix: sp.Matrix, right: sp.Matrix, refusal: str) -> sp.Matrix:
    """Return matrix⁻¹ right in the field of the symbols. Raises SingularError(refusal) for a singular matrix."""
    if not right.cols:
        return right
    both = DomainMatrix.from_Matrix(matrix.row_join(right), extension=True).to_field()
    A, b = both[:, : matrix.cols], both[:, matrix.cols :]
    try:
        return A.to_sparse().lu_solve(b.to_sparse()).to_Matrix().applyfunc(shortest)
    except DMNonInvertibleMatrixError:
        raise SingularError(refusal) from None


def _tangent(slope: sp.Matrix, size: int, k: int, n: int) -> tuple[list[int], sp.Matrix]:
    """Return the indices of the dependent states, coordinates before velocities, and T with y = T x for the other states x."""
    if not slope.rows:
        return [], sp.eye(size)
    chosen: list[int] = []
    for rows, columns in ((range(k), range(n - 1, -1, -1)), (range(k, slope.rows), range(size - 1, n - 1, -1))):
        pivots = independent_rows(slope.extract(list(rows), list(columns)).T, len(rows)) if rows else []
        chosen += [columns[i] for i in pivots]
    independent = [i for i in range(size) if i not in chosen]
    T = sp.zeros(size, len(independent))
    refusal = "linearise: the constraints are dependent at the point: leave out what follows from the others"
    dependent = -_solve_exactly(slope[:, chosen], slope[:, independent], refusal)
    for i, j in enumerate(independent):
        T[j, i] = 1
    for i, j in enumerate(chosen):
        T[j, :] = dependent[i, :]
    return chosen, T
