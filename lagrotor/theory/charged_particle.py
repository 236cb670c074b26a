"""The guiding centre about which the pair swings, for any two spins, bar, lean and twist, and the path that it takes.

With the spins eliminated the pair is a charged particle in three dimensions, q = (beta, h, alpha) of `leaning_lagrangian`,

    L = q'·M q'/2 + g·q',    f = curl g,

of mass M in the field f that the spins make, and nothing else acts. At rest it stays anywhere; a push along the field carries
it on, one across makes it swing, at the rate Omega of the place. The swing's energy over that rate, J, is the adiabatic
invariant, and the centre Q, with the speed u along the unit vector b of the field, obeys to leading order in the motion

    L = (g + u b)·Q' − H,    H = J Omega + u²/2,    Omega² = f·M f/det M,    b = M f/sqrt(f·M f),
    Q' = (u B + b × J grad Omega)/(b·B),    u' = −J B·grad Omega/(b·B),    B = f + u curl b.

alpha is cyclic: P = g_alpha + u b_alpha stays, and with H gives the path of (beta, h) without integration,

    J Omega + (P − g_alpha)²/(2 b_alpha²) = H,    g_alpha = (G_1 + G_2) sin beta cos h + (G_1 − G_2) sin² h/k.

So a slow pair keeps to the line g_alpha = P, and turns back on it where J Omega has grown to H.

Derived in derivations/t14_guiding_centre.py. Northrop, The Adiabatic Motion of Charged Particles, 1963; Littlejohn,
J. Plasma Phys. 29 (1983) 111, in flat space.
"""

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.arrays import Array, check_times
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene
from lagrotor.theory.fitted_factors import LARGEST_SWING

if TYPE_CHECKING:
    import sympy as sp

_IN_LINE = 0.999  # sin(h)/(k cos beta), beyond which the bar lies across the joint line no more: the coordinates end
_LOCAL = 1e-9, 1e-12  # of the path's integration


class _Place(NamedTuple):
    """At a place: M (3, 3), g_alpha, f and b (3,), curl b (3,), Omega and its gradient (3,)."""

    mass: Array
    flux: float
    field: Array
    along: Array
    curl: Array
    rate: float
    gradient: Array


@dataclass(frozen=True)
class GuidingCentre:
    """A guiding centre: place (beta, h, alpha) in rad, speed u along the field ((kg m²)^(1/2)/s), action J (kg m²/s)."""

    scene: Scene
    place: tuple[float, float, float]
    speed: float
    action: float

    @property
    def energy(self) -> float:
        """H = J Omega + u²/2 (J)."""
        return self.action * _at(self.scene, *self.place[:2]).rate + self.speed**2 / 2

    def path(self, t: ArrayLike) -> Array:
        """Return (beta, h, alpha) in rad at ascending times t (n,) in s after the scene's start: (n, 3), to leading order.

        No bound of what is left is known; `lagrotor.models.guiding_centre_error` measures it on the exact motion.

        Raises
        ------
        InputError
            Unless the times are finite, ascending and not before 0.
        DomainError
            Where the bar comes into line with an axis before.
        """
        from scipy.integrate import solve_ivp

        times = check_times("guiding_centre", t)
        if times[0] < 0:
            raise InputError(f"guiding_centre: t[0] = {times[0]:g} s is before the start; take times from 0 on")

        def rhs(_: float, y: Array) -> Array:
            try:
                at = _at(self.scene, y[0], y[1])
            except DomainError:  # of a trial: the step is made smaller
                return np.full(4, np.nan)
            B, pull = at.field + y[3] * at.curl, self.action * at.gradient
            return np.append(y[3] * B + np.cross(at.along, pull), -(B @ pull)) / (at.along @ B)

        def in_line(_: float, y: Array) -> float:
            return _IN_LINE * self.scene.k * float(np.cos(y[0])) - abs(float(np.sin(y[1])))

        in_line.terminal = True  # type: ignore[attr-defined]
        begin, end = [*self.place, self.speed], times[-1] or 1e-9
        run = solve_ivp(rhs, (0.0, end), begin, "DOP853", t_eval=times, events=in_line, rtol=_LOCAL[0], atol=_LOCAL[1])
        if run.status != 0:
            raise DomainError(
                f"guiding_centre: the bar comes into line with an axis before {times[-1]:.3g} s; take a shorter time, or "
                "lagrotor.simulate"
            )
        return np.asarray(run.y[:3].T)


def guiding_centre(scene: Scene) -> GuidingCentre:
    """The guiding centre of the scene's start, of any two spins that are not opposite: leading order in the motion.

    Over the time in which it goes some finite way its path is off by an angle of first order in the amplitude of the swing.

    Raises
    ------
    InputError
        Without a bar or spin, with a shock, and for opposite spins: near upright the rate of their swing is the
        same everywhere, so that the next order counts (`slow_motion`).
    DomainError
        Where the swing exceeds 0.4 rad, or the bar is in line with an axis.
    """
    if not isinstance(scene, Scene) or scene.link is None or scene.shock is not None or sum(scene.spins) == 0:
        raise InputError(f"guiding_centre: {scene!r} needs a bar, spins that are not opposite, and no shock")
    place, velocity = leaning_state(scene)
    at = _at(scene, *place[:2])
    swing = np.linalg.solve(at.mass, np.cross(velocity, at.field)) / at.rate**2
    if not np.linalg.norm(swing) <= LARGEST_SWING.value:
        raise DomainError(
            f"guiding_centre: the pair swings by {np.linalg.norm(swing):.3g} rad, beyond {LARGEST_SWING.value:g}: it has no "
            "centre near; take a smaller motion, or lagrotor.simulate"
        )
    speed = float(at.along @ velocity)
    action = (float(velocity @ at.mass @ velocity) - speed**2) / (2 * at.rate)
    return GuidingCentre(scene, tuple(place + swing), speed, action)


def leaning_state(scene: Scene) -> tuple[Array, Array]:
    """(beta, h, alpha) of a scene's start and their rates, (3,) each: see `leaning_frame`."""
    (r1, r2), (v1, v2) = np.array(scene.axes), np.array(scene.rates)
    height = np.linalg.norm(r1 + r2) / 2  # cos h
    mean, apart = (r1 + r2) / (2 * height), (r2 - r1) / 2
    beta, alpha = np.arcsin(mean[0]), np.arctan2(-mean[1], mean[2])
    c, s = np.cos(alpha), np.sin(alpha)
    lean = np.array([np.cos(beta), np.sin(beta) * s, -np.sin(beta) * c])
    across = np.array([0.0, -c, -s])
    sine = np.copysign(np.linalg.norm(apart), apart @ across)
    tilt = -sine / (scene.k * np.cos(beta))
    turned = (v1 + v2) / (2 * height)
    turned -= mean * (mean @ turned)
    half = (across * np.sqrt(1 - tilt**2) + lean * tilt) @ (v2 - v1) / (2 * height)
    return np.array([beta, np.arctan2(sine, height), alpha]), np.array(
        [lean @ turned, half, across @ turned / np.cos(beta)]
    )


def leaning_field() -> "tuple[sp.Matrix, sp.Matrix]":
    """M (3, 3) and g (3, 1) of the spin-reduced pair L = q'·M q'/2 + g·q' in (beta, h, alpha)."""
    from lagrotor.algebra import hessian
    from lagrotor.mechanics.lagrangian import gradient
    from lagrotor.pair.lagrangians import leaning_lagrangian
    from lagrotor.pair.notation import LEANING

    L = leaning_lagrangian()
    return hessian(L, LEANING.v), gradient(L, LEANING.v).subs(dict.fromkeys(LEANING.v, 0))


@generated(((),))
def _field_functions() -> str:
    """(beta, h, a, b, k, G_1, G_2) → M, f and their derivatives by beta and by h, and g_alpha: 37 numbers."""
    import sympy as sp

    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import G_1, G_2, LEANING, a, b, k

    (beta, h, _), (M, g) = LEANING.q, leaning_field()
    parts = [*M, g[2].diff(h), -g[2].diff(beta), g[1].diff(beta) - g[0].diff(h)]
    outputs = [*parts, *(e.diff(s) for s in (beta, h) for e in parts), sp.expand(g[2])]
    return program_source(Program((beta, h, a, b, k, G_1, G_2), (), tuple(outputs)))


def _at(scene: Scene, beta: float, h: float) -> _Place:
    if not abs(np.sin(h)) < scene.k * np.cos(beta) * (1 - 1e-12):
        raise DomainError(
            f"guiding_centre: at the lean {beta:.4g} and the half-angle {h:.4g} rad the bar is in line with an axis or does not "
            f"reach: |sin h| = {abs(np.sin(h)):.4g}, k cos beta = {scene.k * np.cos(beta):.4g}; take a smaller lean or twist, or "
            "lagrotor.simulate"
        )
    *numbers, flux = _field_functions()(beta, h, *scene.inertias, scene.k, *scene.momenta)
    parts = np.array(numbers).reshape(3, 12)
    (M, *M_slopes), (f, *f_slopes) = parts[:, :9].reshape(3, 3, 3), parts[:, 9:]
    size, det = sqrt(f @ M @ f), float(np.linalg.det(M))
    along, rate = M @ f / size, size / sqrt(det)
    gradient, slopes = np.zeros(3), np.zeros((3, 3))
    for i, (dM, df) in enumerate(zip(M_slopes, f_slopes, strict=True)):
        log_size = (f @ dM @ f / 2 + f @ M @ df) / size**2
        gradient[i] = rate * (log_size - np.trace(np.linalg.solve(M, dM)) / 2)
        slopes[i] = (dM @ f + M @ df) / size - along * log_size
    curl = np.array([slopes[1, 2], -slopes[0, 2], slopes[0, 1] - slopes[1, 0]])
    return _Place(M, float(flux), f, along, curl, rate, gradient)
