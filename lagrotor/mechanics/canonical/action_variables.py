"""The action of a libration in one degree of freedom, and its frequency, by quadrature.

For H = p²/2m(q) + b(q) p + V(q), with W = V − m b²/2 what is left at the velocity zero, q turns where W(q) = E and

    J(E) = (1/2π) ∮ p dq = (1/π) ∫ sqrt(2m (E − W)) dq,      2π/ω = 2π dJ/dE = 2 ∫ sqrt(m/(2 (E − W))) dq.

q = middle + half sin θ makes both integrands smooth and periodic, so that the trapezoid rule converges faster than any power.
Arnold, Mathematical Methods of Classical Mechanics, § 50; Trefethen & Weideman, SIAM Review 56 (2014) 385.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import DomainError, InputError, IntegrationError
from lagrotor.mechanics.canonical.hamiltonians import Hamiltonian
from lagrotor.mechanics.expressions import by_symbol

_MOST_POINTS = 1 << 14
_FARTHEST, _MOST_CROSSINGS = (
    1e3,
    1e5,
)  # in units of 1 + |at|: where it is said to escape; of the time at the start's speed
_ROUNDED = 1e-8  # of the largest kinetic energy


@dataclass(frozen=True)
class Libration:
    """action J (J s), frequency ω = dE/dJ (rad/s) of the libration of an energy (J) between the turning points q."""

    energy: float
    action: float
    frequency: float
    turning_points: tuple[float, float]
    error: float


def libration(h: Hamiltonian, energy: float, at: float, values: Mapping[Any, Any] | None = None) -> Libration:
    """The libration of that energy about the place `at`, where it can be; error: of the action, relative, from half the points.

    Raises DomainError for more than one degree of freedom or an H that is not quadratic in p, InputError where the energy is
    below that of rest `at`, IntegrationError where it does not turn on both sides: it goes round, or escapes.
    """
    import numpy as np
    from scipy.integrate import solve_ivp

    if len(h.q) != 1 or h.constraints or h.H.has(sp.Symbol("t", real=True)):
        raise DomainError(
            "libration: one degree of freedom without constraints and time: reduce by Routh's transform first"
        )
    (q,), (p,) = h.q, h.p
    H = h.H.xreplace({s: sp.sympify(v) for s, v in by_symbol(values or {}, h.H.free_symbols).items()})
    curvature = sp.diff(H, p, 2)
    if decide_zero(sp.diff(curvature, p)).answer != "zero" or curvature == 0:
        raise DomainError(f"libration: H = {H} must be quadratic in {p}")
    if letters := H.free_symbols - {q, p}:
        raise InputError(
            f"libration: {', '.join(sorted(map(str, letters)))} without a value: give every letter a number"
        )
    slope = sp.diff(H, p).subs(p, 0)
    mass = sp.lambdify(q, 1 / curvature + 0 * q, "numpy")
    rest = energy - H.subs(p, 0) + slope**2 / (2 * curvature)
    left, pull = sp.lambdify(q, rest + 0 * q, "numpy"), sp.lambdify(q, sp.diff(rest, q) + 0 * q, "numpy")
    if not left(at) > 0:
        raise InputError(
            f"libration: energy = {energy:g} is not above that of rest at {q} = {at:g}: raise it, or start elsewhere"
        )
    flow = sp.lambdify((q, p), [sp.diff(H, p), -sp.diff(H, q)], "numpy")
    speed, beside = float(np.sqrt(2 * left(at) / mass(at))), float(sp.lambdify(q, slope, "numpy")(at))
    ends = []
    for side in (-1, 1):

        def turns(_: float, y: Any) -> float:
            return float(flow(*y)[0])

        def leaves(_: float, y: Any) -> float:
            return float(abs(y[0] - at) - _FARTHEST * (1 + abs(at)))

        turns.terminal = leaves.terminal = True  # type: ignore[attr-defined]
        start = [at, float(mass(at)) * (side * speed - beside)]
        longest = _MOST_CROSSINGS * (1 + abs(at)) / speed
        run = solve_ivp(lambda _, y: flow(*y), (0, longest), start, events=(turns, leaves), rtol=1e-10, atol=1e-12)
        if run.status != 1 or not len(run.t_events[0]):
            far = float(run.y[0, -1])
            raise IntegrationError(
                f"libration: it does not turn before {q} = {far:g}: at this energy it goes round, or escapes"
            )
        end = float(run.y[0, -1])
        for _ in range(4):  # Newton's steps from where the motion turned
            end -= float(left(end) / pull(end))
        ends.append(end)
    middle, half, points = sum(ends) / 2, (ends[1] - ends[0]) / 2, 16
    before = np.inf
    while points <= _MOST_POINTS:
        theta = (np.arange(points) + 0.5) * pi / points - pi / 2
        place = middle + half * np.sin(theta)
        E, m, ends_pull = left(place), mass(place) + 0 * place, np.where(theta < 0, pull(ends[0]), -pull(ends[1]))
        # Beside a turning point E − W is the force times the distance, 1 − |sin θ| = cos² θ/(1 + |sin θ|), and not rounding.
        by_force = half * ends_pull * np.cos(theta) ** 2 / (1 + np.abs(np.sin(theta)))
        E = np.where(_ROUNDED * E.max() > E, by_force, E)
        action = half * (np.sqrt(2 * m * E) * np.cos(theta)).mean()
        if abs(action - before) <= 1e-13 * action:
            break
        before, points = action, 2 * points
    period = 2 * pi * half * (np.sqrt(m / (2 * E)) * np.cos(theta)).mean()
    return Libration(
        float(energy), float(action), float(2 * pi / period), (ends[0], ends[1]), float(abs(action - before) / action)
    )
