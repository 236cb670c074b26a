"""The recursion of Newton and Euler as programs: the forces in joints along a run, and inverse dynamics at given states."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.joint_forces import (
    JointForce,
    ball_rates,
    inverse_outputs,
    joint_names,
    joint_outputs,
    placed_loads,
    rate_stages,
    unsteady_weights,
    written_out,
)
from lagrotor.mechanics.bodies.small_matrices import Stages
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import in_order, shortest
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.function_values import put_functions, with_values
from lagrotor.mechanics.running.programs import Generated, _program, equations_of_speeds, velocity_stages
from lagrotor.numerics.codegen import Stage


class Reactions(Mapping[str, Any]):
    """The reactions of a run by name: the multiplier of each constraint, shape (n,), and the `JointForce` of each joint."""

    def __init__(self, run: Any) -> None:
        self._run, self._joints = run, dict[str, dict[str, JointForce]]()
        self._undetermined = run.redundancy.undetermined if run.redundancy else ()

    def __getitem__(self, name: str) -> Any:
        multipliers = dict(zip(self._run.system.multiplier_names, self._run.system.multipliers, strict=True))
        if name in self._undetermined:
            raise InputError(f"reactions: {name} is not determined: {self._run.redundancy.words}")
        if name in multipliers:
            return self._run.evaluate(multipliers[name])
        if name not in joint_names(self._run.system):
            raise KeyError(f"{name!r} is none of the reactions {', '.join(self)}")
        return self.joint(name, "ground")

    def __iter__(self) -> Iterator[str]:
        system = self._run.system
        joints = () if self._run.redundancy else joint_names(system)
        names = dict.fromkeys((*system.multiplier_names, *joints))
        return (name for name in names if name not in self._undetermined)

    def __len__(self) -> int:
        return len(list(iter(self)))

    def joint(self, name: str, axes: str) -> JointForce:
        """Return the force in one joint; the first call computes those of all joints."""
        if axes not in self._joints:
            self._joints[axes] = joint_forces_along(self._run, axes)
        if name not in self._joints[axes]:
            joint_outputs(self._run.system, [name], axes, (), Stages())  # raises InputError
        return self._joints[axes][name]


def joint_forces_along(run: Any, axes: str) -> dict[str, JointForce]:
    """Compute the forces in all joints along a run.

    Accelerations, multipliers and loads are evaluated first and enter the program as inputs: dry friction and contacts make
    them jump.
    """
    system, names, components = run.system, joint_names(run.system), list[sp.Expr]()
    if run.redundancy:
        raise InputError(f"reactions: the forces in joints are not determined: {run.redundancy.words}")
    if not run.switched.smooth and any(sum(run.switched.mode(state).closed) for state in run.states):
        raise InputError(
            "reactions: the gap of an Impact is closed in this run, and an Impact does not say on which bodies its force "
            "acts: end the run before the gap closes"
        )

    def input_of(e: sp.Expr) -> sp.Expr:
        components.append(e)
        return e if e.is_number else sp.Symbol(f"_load{len(components) - 1}", real=True)

    loads = [load.each(input_of) for load in placed_loads("reactions", system)]
    needed = (*system.c.a, *system.multipliers, *components)
    inputs = (*system.c.a, *system.multipliers, *(sp.Symbol(f"_load{i}", real=True) for i in range(len(components))))
    keep = Stages()
    outputs = joint_outputs(system, names, axes, loads, keep)
    stages = [*velocity_stages(system), *ball_rates(system), *keep.made]
    program = _program((*system.c.q, *system.speeds, *inputs, t), stages, outputs)
    smooth = run.switched.smooth
    rows = run._values(*(with_values(e, run.values) for e in needed)) if smooth else map(run.evaluate, needed)
    states = np.hstack([run.states[:, : len(system.c.q) + len(system.speeds)], np.array(list(rows)).T])
    pairs = program.along(run.values, "reactions")(states, run.t).reshape(-1, 2, 3, len(run.t))
    return {name: JointForce(force.T, torque.T) for name, (torque, force) in zip(names, pairs, strict=True)}


def inverse_dynamics(system: Equations, q: Any, v: Any, a: Any, values: Any, time: Any) -> Any:
    """Return the forces that must act besides those of the system: `System.inverse_dynamics`."""
    rows = list[Any]()
    for name, numbers, symbols in (("q", q, system.c.q), ("v", v, system.speeds), ("a", a, system.speed_rates)):
        row = symbols if numbers is None else in_order(f"inverse_dynamics: {name}", numbers, symbols)
        if np.shape(row)[-1:] != (len(symbols),):
            raise InputError(
                f"inverse_dynamics: {name} has the shape {np.shape(row)}: its last axis must have {len(symbols)} numbers, for "
                f"{', '.join(map(str, symbols))}"
            )
        rows.append(row)
    if any(isinstance(e, sp.Expr) and not e.is_number for row in rows for e in np.ravel(np.array(row, dtype=object))):
        symbols = (*system.c.q, *system.speeds, *system.speed_rates)
        given = dict(zip(symbols, (e for row in rows for e in row), strict=True))
        return sp.Matrix([shortest(e).subs(given, simultaneous=True) for e in written_out(*_inverse(system))])
    system, values = put_functions("inverse_dynamics", system, values or {})
    arrays = np.broadcast_arrays(*(np.asarray(row, dtype=float)[..., :1] for row in rows))
    shape = arrays[0].shape[:-1]
    states = np.hstack(
        [np.broadcast_to(row, (*shape, np.shape(row)[-1])).reshape(-1, np.shape(row)[-1]) for row in rows]
    )
    program = inverse_program(system)
    outputs = program.along(values, "inverse_dynamics")(states.astype(float), np.full(len(states), float(time)))
    return outputs.T.reshape(*shape, len(system.speeds))


def inverse_program(system: Equations) -> Generated:
    """Generate (q, u, u', t) → the forces for u that must act besides those of the system."""
    return _program((*system.c.q, *system.speeds, *system.speed_rates, t), *_inverse(system))


def _inverse(system: Equations) -> tuple[list[Stage], list[sp.Expr]]:
    if not system.bodies or unsteady_weights(system):
        stages, M, push = equations_of_speeds(system)
        return stages, list(M * sp.Matrix(system.speed_rates) - push)
    keep = Stages()
    outputs = inverse_outputs(system, keep)
    return [*rate_stages(system), *keep.made], outputs
