"""Parts of the claims that are theorems: motions of the exact pair, enclosed. They need python-flint.

Each theorem says more than its part needs, so that rounding decides nothing: a crossing of the pair before a stated time, or the
frequency of a periodic orbit.
"""

from collections.abc import Iterator
from typing import Any

import sympy as sp

from lagrotor.pair.notation import AXES
from lagrotor.pair.quantities import Spins, Vector
from lagrotor.pair.scene import Link, Scene
from lagrotor.paper.claim_tests import Part
from lagrotor.paper.rotor_pair.shocked_runs import shocked_scene
from lagrotor.paper.theorems import Theorem

_TOL = 1e-16  # of a step: the times are known to 1e-4 s, and a theorem takes seconds
_X1, _Y1, _Z1, _X2, _Y2, _Z2 = AXES.q


def crossing_theorem(
    spins: Spins, force: Vector, event: sp.Expr, before: str, says: str, bar: Link | None = None
) -> Any:
    """That an expression of the axes passes zero before a time after the paper's shock, whose peak is at 0.2 s."""
    from lagrotor.proved import crossing

    scene = shocked_scene(spins, force) if bar is None else shocked_scene(spins, force, bar)
    return Theorem.of(crossing(scene, event=event, before=before, tol=_TOL), says)


def topples(part: str, spins: Spins) -> Iterator[Part]:
    """C10: without spins the axes fall to 75° after a shock along the bar, and to 90° after one across it."""
    if spins == (0, 0):
        along = crossing_theorem(spins, (50, 0, 0), _Z1 - sp.Rational(1, 4), "2.9", "z₁ = 1/4 is 75.5° from upright.")
        across = crossing_theorem(spins, (0, 50, 0), _Z1, "2.5", "z₁ = 0 is 90° from upright.")
        yield Part(part, True, theorems=(along, across))


def axes_part(part: str, bar: Link) -> Iterator[Part]:
    """C12: the angle between the axes of opposite spins passes 0.1 rad, 1 s after the start."""
    event = _X1 * _X2 + _Y1 * _Y2 + _Z1 * _Z2 - sp.cos(sp.Rational(1, 10))
    says = "Its zero is an angle of 0.1 rad between the axes."
    yield Part(part, True, theorems=(crossing_theorem((10, -10), (50, 0, 0), event, "1", says, bar),))


def rate_changes(part: str, scene: Scene, r0: float, unchanged: float) -> Iterator[Part]:
    """C17: the orbit's frequency is not G/(J cos θ), the one of constant inclination, by more than `unchanged` r0²."""
    from lagrotor.proved import precession

    if scene.spins[0] != -scene.spins[1]:
        return
    orbit = precession(scene, r0)
    constant = abs(scene.momenta[0]) / (scene.rotor.J * (1 - r0**2) ** 0.5)
    change = (abs(orbit.frequency) / constant - 1) / r0**2
    yield Part(
        part,
        bool(abs(change) < unchanged),
        theorems=(Theorem.of(orbit, f"At constant inclination: {constant:.4f} rad/s."),),
    )
