"""The action of a libration in one degree of freedom, and its frequency, by quadrature.

For H = p²/2m(q) + b(q) p + V(q), with W = V − m b²/2 what is left at the velocity zero, q turns where W(q) = E and

    J(E) = (1/2π) ∮ p dq = (1/π) ∫ sqrt(2m (E − W)) dq,      2π/ω = 2π dJ/dE = 2 ∫ sqrt(m/(2 (E − W))) dq.

q = middle + half sin θ makes both integrands smooth and periodic, so that the trapezoid rule converges faster than any power.
Beside a turning point E − W is its Taylor series there, and no difference of like numbers. Near a separatrix ω falls as one over
the logarithm of what is left of the energy, and E itself is rounded: `frequency_error` is what rounding of E and W changes.
Arnold, Mathematical Methods of Classical Mechanics, § 50; Trefethen & Weideman, SIAM Review 56 (2014) 385.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import factorial, isfinite, nan, pi
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import DomainError, InputError, IntegrationError
from lagrotor.mechanics.canonical.hamiltonians import Hamiltonian
from lagrotor.mechanics.expressions import by_symbol, no_letter

_MOST_POINTS = 1 << 14
_FARTHEST = 1e3  # in units of 1 + |at|: where it is said to escape
_MOST_CROSSINGS = 1e5  # of the time for 1 + |at| at the start's speed
_ROUNDED = 1e-8  # of the largest kinetic energy
_TERMS = 6  # of the Taylor series beside a turning point
_MOST_ROUNDED = 1e-2  # of the period, which on a separatrix is one over the logarithm of rounding
_UNSURE = "libration: the energy is that of a separatrix or of rest, to rounding: give one farther from it"
_EPS = 4 * 2.2e-16  # of the largest energy on the way: what rounding does to E and W


@dataclass(frozen=True)
class Libration:
    """action J (J s), frequency ω = dE/dJ (rad/s) of the libration of an energy (J) between the turning points q.

    error, frequency_error: of the action and of the frequency, relative: from half the points, and from rounding.
    """

    energy: float
    action: float
    frequency: float
    turning_points: tuple[float, float]
    error: float
    frequency_error: float


def libration(h: Hamiltonian, energy: float, at: float, values: Mapping[Any, Any] | None = None) -> Libration:
    """The libration of an energy about a place.

    Args:
        h: of one degree of freedom.
        energy: E = H.
        at: where it can be.
        values: of all letters.

    Raises:
        DomainError: for more than one degree of freedom or an H that is not quadratic in p.
        InputError: where the energy is below that of rest `at` or no number.
        IntegrationError: where it does not turn on both sides: it goes round, escapes, or is so near a separatrix that rounding
            decides.
    """
    import numpy as np

    H, energy, at = _in_one_coordinate(h, energy, at, values)
    (q,), (p,) = h.q, h.p
    slope, curvature = sp.diff(H, p).subs(p, 0), sp.diff(H, p, 2)
    rest = energy - H.subs(p, 0) + slope**2 / (2 * curvature)
    slopes = [
        sp.diff(rest, q, k).replace(sp.DiracDelta, lambda *_: sp.S.Zero) / factorial(k) for k in range(1, _TERMS + 1)
    ]
    left, mass, beside, *taylor = (sp.lambdify(q, e, "numpy") for e in (rest, 1 / curvature, slope, *slopes))
    well = _Well(left, mass, taylor)
    if not left(at) > 0:
        raise InputError(
            f"libration: energy = {energy:g} is not above that of rest at {q} = {at:g}: raise it, or start elsewhere"
        )
    flow = sp.lambdify((q, p), [sp.diff(H, p), -sp.diff(H, q)], "numpy")
    speed = float(np.sqrt(2 * left(at) / mass(at)))
    ends = [_first_turn(flow, (at, float(mass(at) * (v - beside(at)))), q) for v in (-speed, speed)]
    action, period, off, period_off, turned = well.cycle(ends, 0.0)
    rounding = _EPS * max(abs(energy), float(np.abs(energy - left(np.linspace(*turned, 33))).max()))
    lower, longer, *_ = well.cycle(ends, rounding)
    if abs(longer / period - 1) > _MOST_ROUNDED:
        raise IntegrationError(_UNSURE)
    return Libration(
        energy, action, 2 * pi / period, turned, off + abs(lower / action - 1), period_off + abs(longer / period - 1)
    )


@dataclass(frozen=True)
class _Well:
    """E − W, m and the Taylor coefficients of E − W, of q."""

    left: Callable[[Any], Any]
    mass: Callable[[Any], Any]
    taylor: Sequence[Callable[[Any], Any]]

    def turning_point(self, start: float, lower: float) -> float:
        """Where E − W = lower, by Newton's steps. Raises IntegrationError where they lead away, as on a separatrix."""
        end = start
        for _ in range(8):
            pull = float(self.taylor[0](end))
            end -= (float(self.left(end)) - lower) / pull if pull else 0.0
        most = 1e-4 * abs(float(self.taylor[0](end))) * (1 + abs(end))
        if not abs(end - start) < 1e-3 * (1 + abs(start)) or abs(float(self.left(end)) - lower) > most:
            raise IntegrationError(_UNSURE)
        return end

    def cycle(self, ends: Sequence[float], lower: float) -> tuple[float, float, float, float, tuple[float, float]]:
        """Action and period of the energy less `lower`, how far each was from half the points, and the turning points."""
        import numpy as np

        first, last = (self.turning_point(end, lower) for end in ends)
        series = [[float(f(end)) for f in self.taylor] for end in (first, last)]
        middle, half, points = (first + last) / 2, (last - first) / 2, 16
        action = period = np.inf
        while True:
            theta = (np.arange(points) + 0.5) * pi / points - pi / 2
            place, away = middle + half * np.sin(theta), half * np.cos(theta) ** 2 / (1 + np.abs(np.sin(theta)))
            E, m = self.left(place) - lower, self.mass(place)
            near = [np.polyval([*c[::-1], 0], d) for c, d in zip(series, (away, -away), strict=True)]
            E = np.where(_ROUNDED * E.max() > E, np.where(theta < 0, *near), E)
            if not (E > 0).all():
                raise IntegrationError(_UNSURE)
            before, action = action, half * (np.sqrt(2 * m * E) * np.cos(theta)).mean()
            coarse, period = period, 2 * pi * half * (np.sqrt(m / (2 * E)) * np.cos(theta)).mean()
            off = abs(action / before - 1), abs(period / coarse - 1)
            if points >= _MOST_POINTS or (off[0] <= 1e-13 and off[1] <= 1e-12):
                return float(action), float(period), float(off[0]), float(off[1]), (first, last)
            points *= 2


def _first_turn(flow: Callable[..., Any], start: tuple[float, float], q: sp.Symbol) -> float:
    """Where q' first vanishes from (q, p) on. Raises IntegrationError where it does not."""
    from scipy.integrate import solve_ivp

    def turns(_: float, y: Any) -> float:
        return float(flow(*y)[0])

    def leaves(_: float, y: Any) -> float:
        return float(abs(y[0] - start[0]) - _FARTHEST * size)

    size = 1 + abs(start[0])

    turns.terminal = leaves.terminal = True  # type: ignore[attr-defined]
    longest = _MOST_CROSSINGS * size / abs(turns(0, start))
    run = solve_ivp(lambda _, y: flow(*y), (0, longest), start, events=(turns, leaves), rtol=1e-10, atol=1e-12)
    end = float(run.y[0, -1])
    if run.status == 1 and len(run.t_events[0]):
        return end
    raise IntegrationError(
        f"libration: it does not turn before {q} = {end:g}: at this energy it goes round, or escapes"
    )


def _in_one_coordinate(
    h: Hamiltonian, energy: float, at: float, values: Mapping[Any, Any] | None
) -> tuple[sp.Expr, float, float]:
    """H(q, p) with its values, quadratic in p, the energy and the place as numbers."""
    if not isinstance(h, Hamiltonian):
        raise InputError(f"libration: h = {h!r} must be a Hamiltonian: system.hamiltonian() makes it")
    if len(h.q) != 1 or h.constraints or h.H.has(sp.Symbol("t", real=True)):
        raise DomainError(
            "libration: one degree of freedom without constraints and time: reduce by Routh's transform first"
        )
    try:
        energy, at = float(energy), float(at)
    except (TypeError, ValueError):
        energy = nan
    if not (isfinite(energy) and isfinite(at)):
        raise InputError("libration: energy and at must be finite numbers, in J and as q")
    (q,), (p,) = h.q, h.p
    H = h.H.xreplace(
        {
            s: sp.sympify(v, strict=True)
            for s, v in by_symbol("libration: values", values or {}, h.H.free_symbols).items()
        }
    )
    if decide_zero(sp.diff(H, p, 3)).answer != "zero" or sp.diff(H, p, 2) == 0:
        raise DomainError(f"libration: H = {H} must be quadratic in {p}")
    no_letter("libration", H.free_symbols - {q, p})
    return H, energy, at
