"""A motion of a system that was run: its states at some times, and whatever else is a function of them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from math import inf
from typing import Any, Self

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lagrotor.algebra.subexpressions import written
from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import expression as checked
from lagrotor.mechanics.running.flow import Array, Values, smooth_motion
from lagrotor.mechanics.running.function_values import FunctionValue, with_values
from lagrotor.mechanics.running.phases import Observer, Switched, march
from lagrotor.mechanics.running.phases import evaluate as evaluate_in_phases
from lagrotor.mechanics.running.programs import energy_program, function_program, velocities_along
from lagrotor.mechanics.running.scales import Scales
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.integrate import Engine
from lagrotor.numerics.run import Quantity, Run, check_nonempty
from lagrotor.numerics.segment import Integrate


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SampledMotion(Run):
    """A motion of a system at the times t (n,) in s: coordinates q (n, N), velocities v (n, N), and u (n, m), those of one's
    own or v.

    errors are relative: of each coordinate to its largest value over the run, of each velocity to its own, neither less than a
    thousandth of what the kinetic energy makes it.
    """

    system: Equations
    values: Values
    tol: float
    engine: Engine
    scales: Scales
    states: Array  # of the integration, with time and mode
    local: float
    switched: Switched

    @property
    def q(self) -> Array:
        """The coordinates, (n, N)."""
        return self.states[:, : len(self.system.c.q)]

    @cached_property
    def v(self) -> Array:
        """Their velocities, (n, N)."""
        return velocities_along(self.system, self.values, self.states, self.t)

    @property
    def u(self) -> Array:
        """The velocities of the system's own, (n, m), or v."""
        n = len(self.system.c.q)
        return self.states[:, n : n + len(self.system.speeds)]

    def summary(self) -> dict[str, str]:
        """What moves, and how well its motion is known, name → words."""
        return {"coordinates": ", ".join(map(str, self.system.c.q))} | super().summary()

    @property
    def energy(self) -> Array:
        """The Jacobi integral v·∂L/∂v − L, (n,)."""
        return energy_program(self.system).along(self.values)(self.states, self.t)[0]

    @property
    def drift(self) -> Array:
        """The largest violation of a constraint, |g| or |G v + b|, (n,); zero without constraints."""
        off = (*self.system.constraints, *self.system.residual)
        return np.abs(self._values(*off)).max(0) if off else np.zeros(len(self.t))

    @property
    def reactions(self) -> dict[str, Array]:
        """The multipliers along the run, (n,) each, by the names of their constraints, or 1, 2, …: those of a gap in m, or of a
        slip in m/s, are forces in N."""
        both = zip(self.system.multiplier_names, self.system.multipliers, strict=True)
        return {name: self.evaluate(lam) for name, lam in both}

    def evaluate(self, expression: sp.Expr) -> Array:
        """An expression along the run, (n,): in q, v, t and the parameters, the accelerations c.a, and the multipliers λ
        of the constraints, system.multipliers, with which Gᵀ λ is the generalised force of the constraints.

        Where dry friction sticks, sign(w) is what holds it, between −1 and 1.
        Raises InputError when it contains anything else.
        """
        e = with_values(checked("evaluate: expression", expression), self.values)
        if self.switched.smooth:
            return self._values(e)[0]
        return evaluate_in_phases(self.switched, e, self.t, self.states)

    def _values(self, *expressions: sp.Expr) -> Array:
        return function_program(self.system, *expressions).along(self.values, "evaluate")(self.states, self.t)

    def at(self, times: ArrayLike) -> Self:
        """The motion at any times (m,) within the run, as exact as the run: integrated from the sample before each."""
        check_nonempty("at", self.t)
        wanted = check_times("at", np.atleast_1d(times))
        if wanted[0] < self.t[0] or wanted[-1] > self.t[-1]:
            raise InputError(f"at: times must lie between {self.t[0]:g} and {self.t[-1]:g} s, the ends of the run")
        before = np.clip(np.searchsorted(self.t, wanted, side="right") - 1, 0, len(self.t) - 1)
        run_on = integration_of(self.system, self.values, self.engine, self.scales, self.switched, self.states[0])
        states, evaluations = np.empty((len(wanted), self.states.shape[1])), self.evaluations
        for i in np.unique(before):
            inside = before == i
            grid = np.union1d(self.t[i], wanted[inside])
            part = run_on(self.states[i], grid, self.local, False, inf)
            states[inside] = part.states[np.searchsorted(grid, wanted[inside])]
            evaluations += part.evaluations
        return replace(self.read(wanted, states), evaluations=evaluations)

    def read(self, times: Array, states: Array) -> Self:
        """The run at other times, at which its states are known."""
        errors = self.errors[np.minimum(np.searchsorted(self.t, times), len(self.t) - 1)]
        return replace(self, t=times, errors=errors, states=states)

    def quantities(self) -> dict[str, Quantity]:
        """Coordinates, velocities, energy and, under constraints, their violation."""
        c, system = self.system.c, self.system
        names, columns = (*c.q, *c.v, *system.speeds), (*self.q.T, *self.v.T, *self.u.T)
        held = {str(s): Quantity(column, ("t",), "") for s, column in zip(names, columns, strict=True)}
        held["energy"] = Quantity(self.energy, ("t",), "J")
        if self.system.multipliers:
            held["drift"] = Quantity(self.drift, ("t",), "")
        return held

    def _about(self) -> dict[str, Any]:
        """What `save` writes beside the arrays, as JSON: no equation, which would have to be read as one."""
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
            "modes": self.states[:, len(self.system.c.q) + len(self.system.speeds) :].tolist(),
        }


def digest_of(system: Equations) -> str:
    """What identifies the equations of a system."""
    parts = (
        system.lagrangian if system.bodies else written(system.L),
        system.constraints,
        system.rolling,
        system.dissipation,
        system.forces,
        *([system.velocities] if system.velocities else []),
    )
    return sha256("; ".join(map(str, parts)).encode()).hexdigest()


def integration_of(
    system: Equations,
    values: Values,
    engine: Engine,
    scales: Scales | None,
    h: Switched,
    start: Array,
    progress: Callable[[float], None] | None = None,
) -> Integrate:
    """Return the integration of the motion; progress: called with times at which it is evaluated."""
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
    observe: Observer | None = progress and (lambda now, left, until, curve: progress(now + until))
    return lambda start, times, local, companion, budget: march(h, start, times, local, budget, observe, companion)
