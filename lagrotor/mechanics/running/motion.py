"""A simulated motion of a system: its states at some times, and any function of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from math import inf
from typing import Any, Self, TypeVar

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lagrotor.algebra.subexpressions import written
from lagrotor.errors import InputError, near
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import expression as checked
from lagrotor.mechanics.running.flow import Array, Values, smooth_motion
from lagrotor.mechanics.running.function_values import FunctionValue, with_values
from lagrotor.mechanics.running.phases import Observer, Switched, march
from lagrotor.mechanics.running.phases import evaluate as evaluate_in_phases
from lagrotor.mechanics.running.programs import energy_program, function_program, velocities_along
from lagrotor.mechanics.running.redundant_constraints import Redundancy
from lagrotor.mechanics.running.scales import Scales
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.integrate import Engine
from lagrotor.numerics.run import Quantity, Run, check_nonempty
from lagrotor.numerics.segment import Integrate
from lagrotor.result_display import text_of

Kind = TypeVar("Kind", bound="SampledMotion")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SampledMotion(Run):
    """The states of a simulated motion, and functions of them; `SystemRun` lists the fields."""

    system: Equations
    values: Values
    tol: float
    engine: Engine
    scales: Scales
    states: Array
    local: float
    switched: Switched
    redundancy: Redundancy | None = None

    @property
    def q(self) -> Array:
        """The N coordinates at the n times, shape (n, N).

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> run = System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 1, 2])
        >>> run.q.round(6).T
        array([[ 1.      ,  0.540302, -0.416147]])
        """
        return self.states[:, : len(self.system.c.q)]

    @cached_property
    def v(self) -> Array:
        """The velocities of the N coordinates at the n times, shape (n, N).

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> System(c, c.v[0]**2 / 2 + c.q[0]).simulate({}, (0,), (0,), [0, 1, 2]).v.round(6).T
        array([[0., 1., 2.]])
        """
        return velocities_along(self.system, self.values, self.states, self.t)

    @property
    def u(self) -> Array:
        """The m quasi-velocities at the n times, shape (n, m); the velocities v if the system has none.

        Examples
        --------
        >>> from sympy import Symbol
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> twice = {Symbol("u", real=True): 2 * c.v[0]}
        >>> System(c, c.v[0]**2 / 2, velocities=twice).simulate({}, (0,), (4,), [0, 1]).u.round(6).T
        array([[4., 4.]])
        """
        n = len(self.system.c.q)
        return self.states[:, n : n + len(self.system.speeds)]

    @property
    def x(self) -> Array:
        """The k first-order states at the n times, shape (n, k).

        Examples
        --------
        >>> from sympy import Symbol
        >>> from lagrotor.mechanics import System
        >>> x = Symbol("x", real=True)
        >>> System(states={x: -x}).simulate({}, t=[0, 1], x0={"x": 1}).x.round(6).T
        array([[1.      , 0.367879]])
        """
        first = len(self.system.c.q) + len(self.system.speeds)
        return self.states[:, first : len(self.system.variables)]

    def summary(self) -> dict[str, str]:
        """Summarise the coordinates, the times, the error and the ending in words.

        Returns
        -------
        dict
            Words, by the name of the row.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> System(c, c.v[0]**2 / 2).simulate({}, (0,), (1,), [0, 1]).summary()["ending"]
        'the last time was reached'
        """
        rows = {"coordinates": self.system.c.q, "states": tuple(dict(self.system.states))}
        return {name: text_of(symbols) for name, symbols in rows.items() if symbols} | super().summary()

    @property
    def energy(self) -> Array:
        """The Jacobi integral v·∂L/∂v − L in J, shape (n,).

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> System(c, c.v[0]**2 / 2 - c.q[0]).simulate({}, (3,), (0,), [0, 1]).energy.round(6)
        array([3., 3.])
        """
        return energy_program(self.system).along(self.values)(self.states, self.t)[0]

    @property
    def drift(self) -> Array:
        """The largest violation of a constraint, |g| or |G v + b|, shape (n,); zero without constraints.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x y")
        >>> pendulum = System(c, sum(s**2 for s in c.v) / 2 - c.q[1], [sum(s**2 for s in c.q) - 1])
        >>> bool(pendulum.simulate({}, (0, -1), (1, 0), [0, 1]).drift.max() < 1e-12)
        True
        """
        residuals = (*self.system.constraints, *self.system.residual)
        residuals += self.redundancy.residuals if self.redundancy else ()
        return np.abs(self._values(*residuals)).max(0) if residuals else np.zeros(len(self.t))

    @cached_property
    def reactions(self) -> Mapping[str, Any]:
        """The multipliers of the constraints, shape (n,) each, and the `JointForce` of each joint, by their names.

        The names of constraints are 1, 2, … unless the system gives others. For a gap in m or a slip in m/s the multiplier is
        a force in N. A joint without a name is called after its coordinates; its force and torque are in the ground's axes,
        and `joint_force` has them in the joint's. Redundant constraints share a force that the motion does not divide among
        them: InputError is raised for their names, and for the forces in joints.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, System, coordinates
        >>> c = coordinates("x y")
        >>> pendulum = System(c, sum(s**2 for s in c.v) / 2 - c.q[1], [sum(s**2 for s in c.q) - 1])
        >>> pendulum.simulate({}, (0, -1), (0, 0), [0, 1]).reactions["1"].round(6)
        array([-0.5, -0.5])
        >>> c = coordinates("theta")
        >>> rod = Frame(c).pin("theta", name="hook").body(mass=2, centre=(0, -1, 0))
        >>> hanging = System(c, rod.kinetic - rod.potential((0, -9, 0)))
        >>> hanging.simulate({}, (0,), (0,), [0, 1]).reactions["hook"].force.round(6)
        array([[ 0., 18.,  0.],
               [ 0., 18.,  0.]])
        """
        from lagrotor.mechanics.running.joint_programs import Reactions

        return Reactions(self)

    def joint_force(self, name: str, axes: str = "ground") -> Any:
        """Return the force and the torque in a joint along the run.

        They are what the frame before the joint exerts on the frame after it; `System.joint_force` says more.

        Parameters
        ----------
        name : str
            The name of the joint.
        axes : str, default 'ground'
            The axes of the components: "ground", or "joint" for the frame after the joint.

        Returns
        -------
        JointForce
            `force` in N and `torque` in N m, shape (n, 3) each.

        Raises
        ------
        InputError
            If no joint has this name, or a term of the system does not say on which bodies it acts.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, System, coordinates
        >>> rod = Frame(c := coordinates("theta")).pin("theta").body(mass=2, centre=(0, -1, 0))
        >>> run = System(c, rod.kinetic - rod.potential((0, -9, 0))).simulate({}, (1.2,), (0,), [0, 1])
        >>> run.joint_force("theta", axes="joint").force[0].round(3)
        array([0.   , 6.522, 0.   ])
        """
        return self.reactions.joint(name, axes)  # type: ignore[attr-defined]

    def evaluate(self, expression: sp.Expr | str) -> Array:
        """Evaluate an expression along the run.

        Where dry friction sticks, sign(w) is the friction force divided by its bound, between −1 and 1. In several directions
        that is w/√Q. Where another force keeps w at zero, sign(w) is the value that does so.

        Parameters
        ----------
        expression : Expr or str
            The name of a coordinate or velocity, or a function of q, v, t, the parameters, the accelerations c.a and the
            multipliers λ of `system.multipliers`. The generalised force of the constraints is Gᵀ λ.

        Returns
        -------
        Array
            Shape (n,).

        Raises
        ------
        InputError
            If the expression contains another symbol.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 1]).evaluate(c.a[0]).round(6)
        array([-1.      , -0.540302])
        """
        if isinstance(expression, str):
            names = {str(s): s for s in (*self.system.c.q, *self.system.c.v, *self.system.variables)}
            if expression not in names:
                raise InputError(
                    f"evaluate: {expression!r} is none of {', '.join(names)}{near(expression, names)}: name one, or give an "
                    "expression"
                )
            expression = names[expression]
        e = with_values(checked("evaluate: expression", expression), self.values)
        if self.redundancy and (lost := e.free_symbols & self.redundancy.symbols):
            raise InputError(f"evaluate: {min(lost, key=str)} is not determined: {self.redundancy.words}")
        if self.switched.smooth:
            return self._values(e)[0]
        return evaluate_in_phases(self.switched, e, self.t, self.states)

    def _values(self, *expressions: sp.Expr) -> Array:
        return function_program(self.system, *expressions).along(self.values, "evaluate")(self.states, self.t)

    def at(self, times: ArrayLike) -> Self:
        """Return the motion at other times within the run, integrated from the sample before each as accurately as the run.

        Parameters
        ----------
        times : ArrayLike
            Increasing times in s, shape (m,).

        Returns
        -------
        Self
            A run at these times.

        Raises
        ------
        InputError
            For a time outside the run.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 3]).at([1, 2]).q.round(6).T
        array([[ 0.540302, -0.416147]])
        """
        check_nonempty("at", self.t)
        instants = check_times("at", np.atleast_1d(times))
        if instants[0] < self.t[0] or instants[-1] > self.t[-1]:
            raise InputError(f"at: times must lie between {self.t[0]:g} and {self.t[-1]:g} s, the ends of the run")
        samples = np.clip(np.searchsorted(self.t, instants, side="right") - 1, 0, len(self.t) - 1)
        run_on = integration_of(self.system, self.values, self.engine, self.scales, self.switched, self.states[0])
        states, evaluations = np.empty((len(instants), self.states.shape[1])), self.evaluations
        for i in np.unique(samples):
            inside = samples == i
            grid = np.union1d(self.t[i], instants[inside])
            stretch = run_on(self.states[i], grid, self.local, False, inf)
            states[inside] = stretch.states[np.searchsorted(grid, instants[inside])]
            evaluations += stretch.evaluations
        return replace(with_states(self, instants, states), evaluations=evaluations)

    def quantities(self) -> dict[str, Quantity]:
        """Return coordinates, velocities, states, energy and, with constraints, their violation.

        Returns
        -------
        dict
            Name → `Quantity` with values (n,), axes and unit.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> list(System(c, c.v[0]**2 / 2).simulate({}, (0,), (1,), [0, 1]).quantities())
        ['x', 'x_dot', 'energy']
        """
        c, system = self.system.c, self.system
        names = (*c.q, *c.v, *system.variables[len(c.q) :])
        columns = (*self.q.T, *self.v.T, *self.u.T, *self.x.T)
        table = {str(s): Quantity(column, ("t",), "") for s, column in zip(names, columns, strict=True)}
        if c.q:
            table["energy"] = Quantity(self.energy, ("t",), "J")
        if self.system.multipliers:
            table["drift"] = Quantity(self.drift, ("t",), "")
        return table

    def _about(self) -> dict[str, Any]:
        """Return the entries that `save` writes. They hold a digest in place of the equations, which a file would not give
        back."""
        return {
            "coordinates": [str(q) for q in self.system.c.q],
            "equations": digest_of(self.system),
            "values": {
                str(name): float(value)
                for name, value in self.values.items()
                if not isinstance(value, FunctionValue | sp.Lambda)
            },
            "tol": self.tol,
            "engine": self.engine,
            "local": self.local,
            "turn": self.scales.turn,
            "sizes": self.scales.sizes.tolist(),
            "modes": self.states[:, len(self.system.variables) :].tolist(),
            "redundant": self.redundancy and [self.redundancy.dropped, self.redundancy.undetermined],
        }


def with_states(run: Kind, times: Array, states: Array) -> Kind:
    """Return the run with other times (m,) in s and the states (m, d) at these times."""
    errors = run.errors[np.minimum(np.searchsorted(run.t, times), len(run.t) - 1)]
    return replace(run, t=times, errors=errors, states=states)


def digest_of(system: Equations) -> str:
    """Return a digest that identifies the equations of a system."""
    equations = (
        system.lagrangian if system.bodies else written(system.L),
        system.constraints,
        system.rolling,
        system.dissipation,
        system.forces,
        *(e for e in (system.velocities, system.states) if e),
    )
    return sha256("; ".join(map(str, equations)).encode()).hexdigest()


def integration_of(
    system: Equations,
    values: Values,
    engine: Engine,
    scales: Scales | None,
    h: Switched,
    start: Array,
    progress: Callable[[float], None] | None = None,
) -> Integrate:
    """Return a function of the type `Integrate` that integrates the motion. It calls `progress` with the times in s that it
    reaches."""
    if h.smooth and scales:
        return smooth_motion(
            system,
            values,
            engine,
            scales.sizes,
            scales.turn,
            start,
            scales.windows,
            h.narrow,
            progress,
            stiff=scales.stiff,
        )
    observe: Observer | None = progress and (lambda now, lower, until, curve: progress(now + until))
    return lambda start, times, local, companion, budget: march(h, start, times, local, budget, observe, companion)
