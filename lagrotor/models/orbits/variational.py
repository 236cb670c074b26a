"""The variational equations of the minimal model: its Jacobian, generated from the same program, along a motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import SingularError
from lagrotor.models.minimal import MODEL, RATIOS, program
from lagrotor.numerics.generated import generated
from lagrotor.numerics.integrate import TIGHTEST, Problem, integrate
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    import sympy as sp

    from lagrotor.models.programs.minimal_program import Ratio
    from lagrotor.numerics.codegen import Program

Array = NDArray[np.float64]


def _tangent_program(source: Program, by: Sequence[sp.Symbol]) -> Program:
    """The program that also gives the Jacobian of its outputs by the arguments `by`: outputs, then rows of the Jacobian.

    Forward differentiation, stage by stage: exact, and no longer than len(by) times the program.
    """
    import sympy as sp

    from lagrotor.numerics.codegen import Program

    tangents: dict[sp.Symbol, list[sp.Expr]] = {
        s: [sp.Integer(1 if s == direction else 0) for direction in by] for s in by
    }
    stages = []

    def slopes(e: sp.Expr) -> list[sp.Expr]:
        partial = {s: e.diff(s) for s in e.free_symbols if s in tangents}
        return [sum((d * tangents[s][j] for s, d in partial.items()), sp.Integer(0)) for j in range(len(by))]

    for name, expression in source.stages:
        stages.append((name, expression))
        row: list[sp.Expr] = []
        for j, slope in enumerate(slopes(expression)):
            if not slope.is_Atom:
                symbol = sp.Symbol(f"{name}_by_{by[j]}", real=True)
                stages.append((symbol, slope))
                slope = symbol
            row.append(slope)
        tangents[name] = row
    rows = [slope for e in source.outputs for slope in slopes(e)]
    return Program(source.arguments, tuple(stages), (*source.outputs, *rows))


@generated((massive, ratio) for massive in (False, True) for ratio in RATIOS)
def _tangents(massive: bool, ratio: Ratio) -> str:
    """parameters → the accelerations (3,) and their derivatives by the state (3, 6), of the time and the state."""
    from lagrotor.numerics.rhs import rhs_source

    whole = program(massive, ratio, 0)
    return rhs_source(_tangent_program(replace(whole, outputs=whole.outputs[3:]), whole.arguments[:6]), 6)


@dataclass(frozen=True)
class Flow:
    """The minimal model's flow from a state: `end` (6,), `slope` (6, 6) its derivative by the start, `rate` (6,) there."""

    end: Array
    slope: Array
    rate: Array


def flow(scene: Scene) -> Callable[..., Flow]:
    """(state (U, chi, alpha, rates), time in s, tol = the tightest) → Flow, for the scene's rotor, bar and spins, without shock.

    Raises SingularError without a bar; IntegrationError when the motion reaches a singular position.
    """
    if scene.link is None:
        raise SingularError("flow: the scene has no bar to eliminate")
    inertia_a, inertia_b = scene.inertias
    value = scene.k
    ratio: Ratio = "equal" if value == 1 else "short" if value < 1 else "long"
    parameters = [inertia_a]
    parameters += [inertia_b] if inertia_b != 0 else []
    parameters += [value] if ratio != "equal" else []
    parameters += scene.momenta
    accelerations = _tangents(inertia_b != 0, ratio)(*parameters)
    plain = MODEL.rate(scene, False)

    def rate(s: float, y: Array) -> Any:
        found = np.array(accelerations(s, y[:6]))
        turned = found[3:].reshape(3, 6).dot(y[6:].reshape(6, 6)).ravel()
        return np.concatenate((y[3:6], found[:3], y[24:], turned))

    def through(state: Array, time: float, tol: float = TIGHTEST) -> Flow:
        start = np.concatenate([state, np.eye(6).ravel()])
        end = integrate(Problem(rate, start, 12_000), np.array([time]), tol).states[0]
        return Flow(end[:6], end[6:].reshape(6, 6), np.array(plain(time, end[:6])))

    return through
