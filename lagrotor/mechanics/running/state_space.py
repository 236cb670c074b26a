"""Small motion about an equilibrium or a steady motion in numbers: x' = A x + B u, y = C x + D u, under any constraints.

The motion is s' = f(s, u) with the state s = (q, v) under the constraints Φ(s) = (g, G v + b) = 0. Small displacements are
δs = T x. The columns of T span the null space of ∂Φ/∂s; its rows at the independent states x are the unit matrix. Then
A = ∂f/∂s T and B = ∂f/∂u, in the rows of x. Derivatives are taken by a complex step, which needs no difference of close numbers
(Squire & Trapp 1998).

Rolling: Schwab & Meijaard, Linearized dynamics of nonholonomic systems (2003).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import by_symbol, expression
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.initial_state import check_pole, check_values, consistent, rounding_of_start
from lagrotor.mechanics.running.programs import (
    Generated,
    depends_on_time,
    function_program,
    motion_program,
    parameter_values,
)
from lagrotor.mechanics.running.redundant_constraints import without_redundant
from lagrotor.mechanics.steady_motions import small_states, small_turns
from lagrotor.result_display import Shown

_STEP = 1e-30  # of the complex step, whose square is below all rounding
_OTHER = -4  # factor of a second step, which gives the same derivative if one exists
_STEADY, _SAME = 1e-8, 1e-7  # relative: accelerations of a steady motion, changes of a constant matrix
_ROUNDING = 1e-12  # of accelerations of free motion
_DEPENDENT = 1e-10  # least pivot of the constraints' rows, relative, below which they are dependent
_NOT_ANALYTIC = (sp.Abs, sp.sign, sp.Max, sp.Min, sp.Heaviside, sp.atan2, sp.floor, sp.ceiling, sp.Mod, sp.Piecewise)


class Slope(Protocol):
    """A function of the state (d,) that returns k outputs (k,), and their derivatives with respect to the state (k, d) and to p
    inputs (k, p). The derivatives are taken by a complex step."""

    def __call__(self, state: Array, step: float = _STEP) -> tuple[Array, Array, Array]: ...


@dataclass(frozen=True, eq=False, repr=False)
class StateSpace(Shown):
    """The linear system x' = A x + B u, y = C x + D u for small displacements x from a steady motion.

    For a ball joint, the state turn_p is a small rotation angle. Its axis is the one of the turned frame to which the angular
    velocity component p belongs.

    Attributes
    ----------
    states : tuple of Symbol
        The coordinates and velocities that x displaces, n symbols.
    A : Array
        Matrix of the states in x', shape (n, n).
    B : Array
        Matrix of the p inputs in x', shape (n, p).
    C : Array
        Matrix of the states in the k outputs y, shape (k, n).
    D : Array
        Matrix of the inputs in y, shape (k, p).

    Examples
    --------
    >>> from sympy import Symbol
    >>> from lagrotor.mechanics import System, coordinates
    >>> c, F = coordinates("x"), Symbol("F")
    >>> linear = System(c, c.v[0]**2 / 2 - c.q[0]**2, forces=(F,)).linearise({c.q[0]: 0}, {}, [F], [c.q[0]])
    >>> linear.A, linear.B.T, linear.C
    (array([[ 0.,  1.],
           [-2.,  0.]]), array([[0., 1.]]), array([[1., 0.]]))
    """

    _shown = (
        ("states x", "states"),
        ("A", "A"),
        ("B", "B"),
        ("C", "C"),
        ("D", "D"),
        ("rates [1/s]", "rates"),
    )

    states: tuple[sp.Symbol, ...]
    A: Array
    B: Array
    C: Array
    D: Array

    @property
    def rates(self) -> NDArray[np.complex128]:
        """The eigenvalues of A in 1/s, the largest real part first, shape (n,).

        A coordinate on which nothing depends gives the eigenvalue zero.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> System(c, c.v[0]**2 / 2 + 2 * c.q[0]**2).linearise({c.q[0]: 0}, {}).rates.real
        array([ 2., -2.])
        """
        roots = np.linalg.eigvals(self.A).astype(complex)
        return roots[np.lexsort((roots.imag, -roots.real))]


def state_space(
    system: Equations,
    at: Mapping[Any, Any],
    values: Values,
    inputs: Sequence[sp.Symbol] = (),
    outputs: Sequence[sp.Expr] = (),
    where: str = "linearise",
) -> StateSpace:
    """Linearise a system about a point at which all accelerations vanish, for `System.linearise`."""
    output_expressions = tuple(expression(f"{where}: outputs[{i}]", e) for i, e in enumerate(outputs))
    if not isinstance(values, Mapping):
        raise InputError(f"{where}: values = {values!r} must be a dictionary")
    if strangers := {*inputs} & {*system.c.v, *system.variables, t}:
        raise InputError(
            f"{where}: the input {min(strangers, key=str)} moves: inputs are symbols of forces or constraints"
        )
    numbers = {str(s): 0.0 for s in inputs} | {str(s): value for s, value in values.items()}
    check_values(where, system, numbers, output_expressions)
    if depends_on_time(system):
        raise InputError(
            f"{where}: the motion depends on time explicitly: write a symbol for an input F(t), or simulate it"
        )
    system, start = point_state(where, system, at, numbers)
    motion = motion_slope(where, motion_program(system), numbers, inputs)
    rate, J, B = motion(start)
    check_smooth(where, motion, start, [f"the rate of {s}" for s in system.variables], at)
    n, d = len(system.c.q), len(start)
    size = max(1.0, float(np.abs(start).max()))
    least = _STEADY * size * float(np.abs(J[n:d]).max()) + _ROUNDING
    if np.abs(rate[n:]).max() > least:
        rates = [*(system.c.a if system.kinematics is None else [f"{u}'" for u in system.speeds])]
        rates += [f"{x}'" for x, _ in system.states]
        rates_text = ", ".join(f"{a} = {x:.3g}" for a, x in zip(rates, rate[n:], strict=True) if abs(x) > least)
        raise SingularError(f"{where}: {dict(at)} is no steady motion: {rates_text} is not zero; system.rest finds one")
    A, P, inverse = local_slope(system, start, rate, J)
    later = start + np.concatenate([rate[:n], np.zeros(d - n)]) / size
    for joint in system.ball_joints:  # a turn about a fixed axis
        places = [system.c.q.index(q) for q in joint.quaternion]
        later[places] /= np.linalg.norm(later[places])
    onward, J, _ = motion(later)
    later_A = local_slope(system, later, onward, J)[0]
    if np.abs(onward[n:]).max() > least or np.abs(later_A - A).max() > _SAME * max(1.0, float(np.abs(A).max())):
        raise InputError(
            f"{where}: the coefficients of the linear equations change with time: use coordinates that "
            "turn along with the motion"
        )
    free, T = tangent_space(where, system, numbers, start)
    output_slope = motion_slope(where, function_program(system, *output_expressions), numbers, inputs)
    output_state = np.append(start, 0.0)
    check_smooth(where, output_slope, output_state, output_expressions, at)
    _, C, D = output_slope(output_state)
    states = tuple(s for s, independent in zip(small_states(system), free, strict=True) if independent)
    return StateSpace(states, A[free] @ T, (inverse @ B)[free], C[:, :d] @ P @ T, D)


def local_slope(system: Equations, state: Array, rate: Array, J: Array) -> tuple[Array, Array, Array]:
    """Return the matrix P⁻ (J P − P') of the linear motion at a state (q, u), and P and P⁻. The matrix P of `small_turns` maps
    small displacements to changes of (q, u). The rate of the state is (q', u'), and J = ∂f/∂(q, u)."""
    P, inverse = (np.array(e, np.float64) for e in small_turns(system, state))
    change_of_P = np.array(small_turns(system, rate)[0], np.float64) - np.array(
        small_turns(system, 0 * rate)[0], np.float64
    )
    return inverse @ (J @ P - change_of_P), P, inverse


def point_state(
    where: str, system: Equations, at: Mapping[Any, Any], values: Values, time: float = 0.0, moved: bool = False
) -> tuple[Equations, Array]:
    """Return the system without redundant constraints, and the state (q, u, x) at a point. Coordinates that the point omits are
    zero if the motion does not depend on them, otherwise InputError is raised. If `moved` is true, a point off the constraints
    is moved onto them."""
    n, m = len(system.c.q), len(system.c.q) + len(system.speeds)
    point = by_symbol(f"{where}: at", at, system.variables)
    if omitted := [s for i, s in enumerate(system.variables) if s not in point and not n <= i < m]:
        motion = motion_program(system)
        moving = dict(zip(system.variables, motion.program.arguments, strict=False))  # a program may rename symbols
        if missing := [str(s) for s in omitted if moving[s] in _parts(motion)[0]]:
            raise InputError(
                f"{where}: {', '.join(missing)} without a value: the point needs each coordinate and state"
            )
    if strangers := [str(s) for s in point if s not in system.variables]:
        names = "" if system.kinematics is None else f" ({', '.join(map(str, system.speeds))})"
        raise InputError(
            f"{where}: the point has {', '.join(strangers)}: give it coordinates and velocities{names}, other symbols in values"
        )
    entries = [expression(f"{where}: {s}", point.get(s, 0)) for s in system.variables]
    inside = {s for e in entries for s in e.free_symbols}
    letters = {s: x for s, x in by_symbol(f"{where}: values", values, inside).items() if s in inside}
    try:
        start = np.array([float(e.subs(letters)) for e in entries])
    except (TypeError, ValueError):
        raise InputError(f"{where}: {dict(at)} must be numbers, {{coordinate: number, …}}") from None
    if not np.isfinite(start).all():
        raise InputError(f"{where}: {dict(at)} must be finite")
    if system.multipliers:
        system, _ = without_redundant(where, system, values, start[:n], start[n:m], time, moved)
        near = np.concatenate(consistent(where, system, values, start[:n], start[n:m], time))
        if not moved and (np.abs(near - start[:m]) > rounding_of_start(system, values, start[:m], time)).any():
            nearest = ", ".join(f"{s} = {x:.9g}" for s, x in zip(system.variables, near, strict=False) if x)
            raise ConstraintError(
                f"{where}: the point is off the constraints; the nearest on them is {nearest or 'zero'}"
            )
        start = np.append(near, start[m:])
    check_pole(where, system, values, np.append(start, time))
    return system, start


@lru_cache(maxsize=64)
def _parts(program: Generated) -> tuple[set[sp.Basic], set[sp.Basic]]:
    """Return the symbols of a program, and those of its terms that are not differentiable everywhere."""
    expressions = [*(e for _, e in program.program.stages), *program.program.outputs]
    symbols = set().union(*(e.free_symbols for e in expressions))
    return symbols, set().union(*(e.atoms(*_NOT_ANALYTIC) for e in expressions))


def motion_slope(where: str, program: Generated, values: Values, inputs: Sequence[sp.Symbol] = ()) -> Slope:
    """Return a function that takes a state and returns the outputs of a program with their derivatives with respect to the state
    and the inputs."""
    _, jumping = _parts(program)
    if jumping:
        raise InputError(
            f"{where}: {min(jumping, key=str)} has no derivative everywhere: write only the case that applies there"
        )
    numbers, d = parameter_values(program, values, where), len(program.states)
    calls = [f for f in numbers if callable(f)]
    numbers = numbers[: len(numbers) - len(calls)]
    names = [str(s) for s in (*program.states, *program.parameters)]

    def slope(state: Array, step: float = _STEP) -> tuple[Array, Array, Array]:
        at = np.concatenate([state, numbers]).astype(complex)
        displaced = at[:, None] + 1j * step * np.eye(len(at))
        with np.errstate(all="ignore"):
            rows = [np.broadcast_to(e, len(at)) for e in program.function(*displaced, *calls)]
        table = np.array(rows, complex).reshape(len(rows), len(at))
        by = table.imag / step
        columns = [names.index(str(s)) if str(s) in names else None for s in inputs]
        pushed = [np.zeros(len(by)) if i is None else by[:, i] for i in columns]
        return table[:, 0].real, by[:, :d], np.array(pushed).reshape(len(inputs), len(by)).T

    return slope


def check_smooth(where: str, slope: Slope, state: Array, names: Sequence[Any], at: Mapping[Any, Any]) -> None:
    """Raise SingularError if an output has no value or no derivative at the state, as √x at zero. Its derivative then depends on
    the complex step."""
    first, second = (np.column_stack(slope(state, h))[: len(names)] for h in (_STEP, _OTHER * _STEP))
    with np.errstate(invalid="ignore"):
        smooth = np.abs(first - second) <= _SAME * np.abs(first) + _ROUNDING * (1 + np.abs(first).max(initial=0))
    if not smooth.all():
        name = names[int(np.argmin(smooth.all(1)))]
        raise SingularError(
            f"{where}: {name} has no value or no derivative at {dict(at)}: use coordinates that are regular there"
        )


def tangent_space(
    where: str, system: Equations, values: Values, state: Array, time: float = 0.0
) -> tuple[NDArray[np.bool_], Array]:
    """Return a mask of the independent small displacements (d,), and the matrix T, which maps these to all d displacements of
    `small_turns`."""
    P = np.array(small_turns(system, state)[0], np.float64)
    d = P.shape[1]
    n = d - len(system.speeds) - len(system.states)
    units = [joint.unit_length for joint in system.ball_joints]
    holonomic = [g for g in system.constraints if g not in units]
    if not holonomic and not system.left:
        return np.ones(d, bool), np.eye(d)
    from scipy.linalg import qr

    h = len(holonomic)
    bound = function_program(system, *holonomic, *(system.residual[i] for i in system.left))
    slope = motion_slope(where, bound, values)(np.append(state, time))[1][:, : len(state)] @ P
    dependent = np.zeros(0, int)
    for rows, first in ((slope[:h, :n], 0), (slope[h:, n:], n)):  # dependent coordinates, then velocities
        if len(rows):
            _, triangle, order = qr(rows, pivoting=True)
            diagonal = np.abs(np.diag(triangle))
            if len(diagonal) < len(rows) or diagonal.min() < _DEPENDENT * diagonal.max():
                raise SingularError(
                    f"{where}: the constraints are dependent there: leave out what follows from the others"
                )
            dependent = np.append(dependent, first + order[: len(rows)])
    free = np.ones(d, bool)
    free[dependent] = False
    T = np.zeros((d, int(free.sum())))
    T[free] = np.eye(T.shape[1])
    T[dependent] = -np.linalg.solve(slope[:, dependent], slope[:, free])
    return free, T
