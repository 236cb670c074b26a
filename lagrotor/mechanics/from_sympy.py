"""Systems of sympy.physics.mechanics: functions of time become plain symbols, and loads become generalised forces.

The source is a Lagrangian of dynamicsymbols with its coordinates, a LagrangesMethod with its constraints and loads, a
KanesMethod, or a System with its joints and actuators after form_eoms(). Functions of time that are no coordinates remain
functions of t, for which a run takes values.

The generalised force of a load F at a point of velocity v is F·∂v/∂q', of a torque on a frame of angular velocity ω it is
T·∂ω/∂q'. Kane's speeds are u = W(q, t) q' + w, and the equations M u' = f become Wᵀ(M u' − f) = 0. A speed u3 without a
kinematic equation is the rate of a new coordinate q_u3. L is then the kinetic energy, and all loads are among the forces. If
the velocities of the source use a rolling constraint, the kinetic energy alone does not give the motion; the forces then
contain the missing terms.

Differences from sympy: in LagrangesMethod.eom the multipliers have the opposite sign, M a + … = Q − Gᵀ λ; in its
mass_matrix_full and here M a + … = Q + Gᵀ λ. Kane's method has no multipliers: here each constraint has one. Kane's method
takes no potential energy of a body, Lagrange's method does.
"""

from collections.abc import Sequence
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError
from lagrotor.mechanics.lagrangian import Coordinates, bias, coordinates, jacobian, t, total_derivative
from lagrotor.mechanics.quasi_velocities import independent_rows

_DECIDED = 3000  # operations up to which a difference is decided to vanish; a longer one is kept


def parts_from_sympy(source: Any, q: Sequence[Any] = ()) -> dict[str, Any]:
    """Return the arguments of a `System` by name: `System.from_sympy`."""
    from sympy.physics.mechanics import KanesMethod, LagrangesMethod, System, dynamicsymbols

    clock = dynamicsymbols._t
    if isinstance(source, System):
        if source.eom_method is None:
            raise InputError("from_sympy: a System of sympy has its equations after form_eoms(): call it first")
        source = source.eom_method
    if isinstance(source, KanesMethod):
        if not source.bodies:
            raise InputError("from_sympy: a KanesMethod has bodies after kanes_equations(bodies, loads): call it first")
        return _of_speeds(source)
    lagrange = isinstance(source, LagrangesMethod)
    if not lagrange and (not isinstance(source, sp.Expr) or q in ((), [])):
        raise InputError(
            f"from_sympy: {type(source).__name__} must be a LagrangesMethod, a KanesMethod, a System of sympy, or a Lagrangian "
            "with its coordinates: from_sympy(L, (q1, q2))"
        )
    if not isinstance(q, Sequence | sp.MatrixBase):
        raise InputError(f"from_sympy: q = {q!r} must be a tuple of coordinates: write ({q},)")
    c, functions = _coordinates(list(source.q) if lagrange else list(q), clock)
    if not lagrange:
        return {"c": c, "lagrangian": _plain(source, functions, c, clock)}
    Q = _generalised_forces(source.forcelist or (), source.inertial, [f.diff(clock) for f in functions])
    holonomic = list(source._hol_coneqs)
    return {
        "c": c,
        "lagrangian": _plain(source._L[0] if isinstance(source._L, sp.MatrixBase) else source._L, functions, c, clock),
        "constraints": tuple(_plain(e, functions, c, clock) for e in holonomic),
        "rolling": tuple(_plain(e, functions, c, clock) for e in list(source.coneqs)[len(holonomic) :]),
        "forces": tuple(_plain(e, functions, c, clock) for e in Q) if any(Q) else (),
    }


def _generalised_forces(loads: Sequence[Any], frame: Any, speeds: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Return the generalised forces: Σ F·∂v/∂u over forces at points plus Σ T·∂ω/∂u over torques on frames or bodies."""
    from sympy.physics.mechanics import Point

    Q = [sp.S.Zero] * len(speeds)
    for place, load in loads:
        turning = getattr(place, "frame", place)  # the frame of a body, or the frame itself
        velocity = place.vel(frame) if isinstance(place, Point) else turning.ang_vel_in(frame)
        Q = [total + velocity.diff(u, frame, var_in_dcm=False).dot(load) for total, u in zip(Q, speeds, strict=True)]
    return Q


def _of_speeds(kane: Any) -> dict[str, Any]:
    """Return the arguments of a `System` by name, from a KanesMethod whose velocities are linear in its speeds u."""
    from sympy.physics.mechanics import KanesMethod, dynamicsymbols

    frame, q, u, bodies = kane._inertial, kane.q, kane.u, kane.bodies
    kinematic = kane._k_kqdot_implicit * kane._qdot + kane._k_ku_implicit * u + kane._f_k_implicit
    velocity = kane._k_nh * u + kane._f_nh if len(kane._k_nh) else []
    clock = dynamicsymbols._t
    if len(kinematic) != len(q):
        raise InputError(
            f"from_sympy: {len(kinematic)} kinematic equations for {len(q)} coordinates: give one for each"
        )
    q, kinematic = _with_own_coordinates(list(q), list(u), list(kinematic))
    c, functions = _coordinates(q, clock)
    still = dict.fromkeys(kane._uaux, 0)
    equations = sp.Matrix([*kinematic, *velocity]).xreplace(still)
    speeds, remainder = _solved(equations, list(u))
    substitution = dict(zip(u, speeds, strict=True)) | still
    substitution |= {s.diff(clock): e.diff(clock) for s, e in zip(u, speeds, strict=True)} | {
        s.diff(clock): 0 for s in kane._uaux
    }

    def plain(e: Any) -> sp.Expr:
        return _plain(sp.sympify(e, strict=True).xreplace(substitution), functions, c, clock)

    method = KanesMethod(frame, q, list(u), kd_eqs=list(equations[: len(q), :]))
    loads = [
        (place, load.xreplace(still) if hasattr(load, "xreplace") else load) for place, load in kane.forcelist or ()
    ]
    method.kanes_equations(list(bodies), loads or None)
    energy = sp.Add(*(body.kinetic_energy(frame) for body in bodies))
    L = plain(energy)
    relations = sp.Matrix([_plain(e, functions, c, clock) for e in speeds])
    W = jacobian(list(relations), c.v)
    swing = sp.Matrix([total_derivative(e, c).xreplace(dict.fromkeys(c.a, sp.S.Zero)) for e in relations])
    M, f = method.mass_matrix.applyfunc(plain), method.forcing.applyfunc(plain)
    whole = list(bias(L, c) - W.T * (M * swing - f))
    acting = [plain(e) for e in _generalised_forces(loads, frame, list(u))]
    active = list(W.T * sp.Matrix(acting))
    missing = [a - b for a, b in zip(whole, active, strict=True)]
    forces = [b if _vanishes(e) else b + e for b, e in zip(active, missing, strict=True)]
    constraints = tuple(plain(e) for e in kane._f_h)
    return {
        "c": c,
        "lagrangian": L,
        "constraints": constraints,
        "rolling": _independent(constraints, [plain(e) for e in remainder], c),
        "forces": tuple(forces) if any(forces) else (),
    }


def _with_own_coordinates(q: list[Any], u: list[Any], kinematic: list[Any]) -> tuple[list[Any], list[Any]]:
    """Add a coordinate and its kinematic equation for each speed that the equations do not determine."""
    from sympy.physics.mechanics import dynamicsymbols

    rows = sp.Matrix(kinematic).jacobian(u).col_join(sp.eye(len(u)))
    missing = [u[i - len(q)] for i in independent_rows(rows, len(u)) if i >= len(q)]
    angles = [dynamicsymbols(f"q_{s.func.__name__}") for s in missing]
    return [*q, *angles], [*kinematic, *(x.diff() - s for x, s in zip(angles, missing, strict=True))]


def _solved(equations: sp.Matrix, u: list[Any]) -> tuple[sp.Matrix, list[sp.Expr]]:
    """Solve the first independent equations for the speeds u; return the speeds, and the equations that were not used.

    With fewer speeds than coordinates, as with a quaternion, some kinematic equations remain.
    """
    K = equations.jacobian(u)
    chosen = independent_rows(K, len(u))
    constant = equations.xreplace(dict.fromkeys(u, 0))
    speeds = -K[chosen, :].LUsolve(constant[chosen, :])
    return speeds, [equations[i] for i in range(K.rows) if i not in chosen]


def _vanishes(e: sp.Expr) -> bool:
    return e == 0 or (sp.count_ops(e) <= _DECIDED and decide_zero(e).answer == "zero")


def _independent(constraints: Sequence[sp.Expr], velocity: Sequence[sp.Expr], c: Coordinates) -> tuple[sp.Expr, ...]:
    """Return the velocity constraints that are independent of the holonomic ones at a random state."""
    holonomic = [total_derivative(g, c) for g in constraints]
    independent = independent_rows(jacobian([*holonomic, *velocity], c.v), len(c.v))
    return tuple(velocity[i - len(holonomic)] for i in independent if i >= len(holonomic))


def _coordinates(functions: list[Any], clock: sp.Symbol) -> tuple[Coordinates, list[Any]]:
    if not all(isinstance(f, sp.core.function.AppliedUndef) and f.args == (clock,) for f in functions):
        raise InputError(
            f"from_sympy: {functions} must be dynamicsymbols: give one function of time for each coordinate"
        )
    return coordinates([f.func.__name__ for f in functions]), functions


def _plain(e: Any, functions: Sequence[Any], c: Coordinates, clock: sp.Symbol) -> sp.Expr:
    """Replace the functions of time in an expression, and their derivatives, by plain symbols."""
    substitution: dict[Any, sp.Expr] = {}
    for f, q, v, a in zip(functions, c.q, c.v, c.a, strict=True):
        substitution |= {f.diff(clock, 2): a, f.diff(clock): v, f: q}
    return sp.sympify(e, strict=True).doit().xreplace(substitution).xreplace({clock: t})
