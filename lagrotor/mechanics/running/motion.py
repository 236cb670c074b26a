"""A motion: its states at some times, and whatever else is a function of them."""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, TypeVar

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import expression as checked
from lagrotor.mechanics.running.integration import Array, Values, increasing, states
from lagrotor.mechanics.running.programs import (
    Generated,
    energy_program,
    function_program,
    motion_program,
    parameter_values,
)
from lagrotor.numerics.integrate import Engine

Kind = TypeVar("Kind", bound="Motion")


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion at the times t (n,) in s: coordinates q (n, N) and velocities v (n, N)."""

    system: Equations
    values: Values
    t: Array
    q: Array
    v: Array
    tol: float
    engine: Engine

    def __repr__(self) -> str:
        names, n = ", ".join(map(str, self.system.c.q)), len(self.t)
        return f"{type(self).__name__} of {names}: {n} times" + (f", {self.t[0]:g} to {self.t[-1]:g} s" if n else "")

    @property
    def energy(self) -> Array:
        """The Jacobi integral v·∂L/∂v − L, (n,)."""
        given = energy_program(self.system)
        return self._values(given, given.function)

    @property
    def drift(self) -> Array:
        """The largest violation of a constraint, |g| or |G v + b|, (n,); zero without constraints."""
        off = [*self.system.constraints, *self.system.residual]
        return np.abs([self.evaluate(e) for e in off]).max(0) if off else np.zeros(len(self.t))

    def evaluate(self, expression: sp.Expr) -> Array:
        """An expression along the run, (n,): in q, v, t and the parameters, the accelerations c.a, and the multipliers λ
        of the constraints, system.multipliers, with which Gᵀ λ is the generalised force of the constraints.

        Raises InputError when it contains anything else.
        """
        given = _function(self.system, checked("evaluate: expression", expression))
        return self._values(given, given.function)

    def _values(self, given: Generated, function: Any) -> Array:
        columns = [*self.q.T, *self.v.T, *((self.t,) if len(given.states) > 2 * self.q.shape[1] else ())]
        with np.errstate(all="ignore"):
            (found,) = function(*columns, *parameter_values(given, self.values))
        return np.broadcast_to(np.asarray(found, float), self.t.shape).copy()

    def at(self: Kind, times: ArrayLike) -> Kind:
        """The motion at any times (m,) within the run, as exact as the run: integrated from the sample before each."""
        wanted = increasing(np.atleast_1d(times))
        if wanted[0] < self.t[0] or wanted[-1] > self.t[-1]:
            raise InputError(f"at: times must lie between {self.t[0]:g} and {self.t[-1]:g} s, the ends of the run")
        found = np.empty((len(wanted), 2 * self.q.shape[1]))
        before = np.clip(np.searchsorted(self.t, wanted, side="right") - 1, 0, len(self.t) - 1)
        for i in np.unique(before):
            inside = before == i
            start = np.concatenate([self.q[i], self.v[i]])
            found[inside] = states(self.system, self.values, start, self.t[i], wanted[inside], self.tol, self.engine)
        n = self.q.shape[1]
        return replace(self, t=wanted, q=found[:, :n], v=found[:, n:])

    def derivatives(self) -> Array:
        """(v, a) at the samples, (n, 2 N)."""
        given = motion_program(self.system)
        rhs = given.rhs(*parameter_values(given, self.values))
        clock = len(given.states) > 2 * self.q.shape[1]
        rows = np.hstack([self.q, self.v, *([self.t[:, None]] if clock else [])])
        return np.array([rhs(0.0, y) for y in rows])[:, : 2 * self.q.shape[1]]


@lru_cache(maxsize=256)
def _function(system: Equations, expression: sp.Expr) -> Generated:
    return function_program(system, expression)
