"""The guiding centre about which the pair oscillates, for any two spins, bar, lean and twist, and its path.

With the spins eliminated the pair is a charged particle in three dimensions, q = (beta, h, alpha) of `leaning_lagrangian`,

    L = q'·M q'/2 + g·q',    f = curl g,

of mass matrix M in the field f of the spins, without other forces. It can rest anywhere. A push along the field carries it on;
a push perpendicular to the field makes it oscillate at the local rate Omega. The oscillation's energy over that rate, J, is the
adiabatic invariant. The centre Q, with the speed u along the unit vector b of the field, obeys to leading order

    L = (g + u b)·Q' − H,    H = J Omega + u²/2,    Omega² = f·M f/det M,    b = M f/sqrt(f·M f),
    Q' = (u B + b × J grad Omega)/(b·B),    u' = −J B·grad Omega/(b·B),    B = f + u curl b.

alpha is cyclic: P = g_alpha + u b_alpha is conserved, and with H gives the path of (beta, h) without integration,

    J Omega + (P − g_alpha)²/(2 b_alpha²) = H,    g_alpha = (G_1 + G_2) sin beta cos h + (G_1 − G_2) sin² h/k.

So a slow pair follows the line g_alpha = P, and turns back on it where J Omega reaches H.

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
from lagrotor.result_display import Printed
from lagrotor.theory.fitted_factors import LARGEST_SWING

if TYPE_CHECKING:
    import sympy as sp

_IN_LINE = 0.999  # largest sin(h)/(k cos beta): at 1 the coordinates are singular
_LOCAL = 1e-9, 1e-12  # relative and absolute tolerance of the path


class _Place(NamedTuple):
    """The fields of the charged particle at one place, with the symbols of the module's text.

    Mass matrix M, shape (3, 3); g_alpha; the field f, its direction b and curl b, shape (3,) each; the rate Omega in rad/s and
    its gradient, shape (3,).
    """

    mass: Array
    flux: float
    field: Array
    direction: Array
    curl: Array
    rate: float
    gradient: Array


@dataclass(frozen=True)
class GuidingCentre(Printed):
    """A guiding centre of the pair.

    Attributes
    ----------
    scene : Scene
        The scene, with its start at time 0.
    place : tuple[float, float, float]
        Lean beta, half-angle h and azimuth alpha in rad.
    speed : float
        Speed u along the field in (kg m²)^(1/2)/s.
    action : float
        Adiabatic invariant J in kg m²/s.
    """

    _shown = (
        ("β, h, α [rad]", "place"),
        ("speed along the field [(kg m²)^½/s]", "speed"),
        ("adiabatic invariant J [kg m²/s]", "action"),
        ("energy [J]", "energy"),
    )

    scene: Scene
    place: tuple[float, float, float]
    speed: float
    action: float

    @property
    def energy(self) -> float:
        """The energy H = J Omega + u²/2 in J."""
        return self.action * _at(self.scene, *self.place[:2]).rate + self.speed**2 / 2

    def path(self, t: ArrayLike) -> Array:
        """Integrate the path of the centre, to leading order.

        No error bound is known; `lagrotor.models.guiding_centre_error` measures the error on the exact motion.

        Parameters
        ----------
        t : array_like
            Ascending times in s after the scene's start, shape (n,).

        Returns
        -------
        ndarray
            The angles (beta, h, alpha) in rad, shape (n, 3).

        Raises
        ------
        InputError
            Unless the times are finite, ascending and not negative.
        DomainError
            If the bar comes into line with an axis before the last time.
        """
        from scipy.integrate import solve_ivp

        times = check_times("guiding_centre", t)
        if times[0] < 0:
            raise InputError(f"guiding_centre: t[0] = {times[0]:g} s is before the start; take times from 0 on")

        def rhs(_: float, y: Array) -> Array:
            try:
                at = _at(self.scene, y[0], y[1])
            except DomainError:  # in a trial step, which the solver then shortens
                return np.full(4, np.nan)
            B, pull = at.field + y[3] * at.curl, self.action * at.gradient
            return np.append(y[3] * B + np.cross(at.direction, pull), -(B @ pull)) / (at.direction @ B)

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
    """Return the guiding centre of the scene's start, for spins that are not opposite, to leading order in the motion.

    While the centre moves a finite distance, the error of its path is of first order in the amplitude of the oscillation.

    Parameters
    ----------
    scene : Scene
        Two spins with a bar and no shock.

    Returns
    -------
    GuidingCentre
        The centre at time 0.

    Raises
    ------
    InputError
        Without a bar or spin, with a shock, and for opposite spins: near upright their rate is uniform, so that the next order
        matters; `slow_motion` contains it.
    DomainError
        If the oscillation exceeds 0.4 rad, or the bar is in line with an axis.

    References
    ----------
    derivations/t14_guiding_centre.py.
    """
    if not isinstance(scene, Scene) or scene.link is None or scene.shock is not None or sum(scene.spins) == 0:
        raise InputError(f"guiding_centre: {scene!r} needs a bar, spins that are not opposite, and no shock")
    place, velocity = leaning_state(scene)
    at = _at(scene, *place[:2])
    swing = np.linalg.solve(at.mass, np.cross(velocity, at.field)) / at.rate**2
    if not np.linalg.norm(swing) <= LARGEST_SWING.value:
        raise DomainError(
            f"guiding_centre: the pair swings by {np.linalg.norm(swing):.3g} rad, beyond {LARGEST_SWING.value:g}, so that "
            "no guiding centre describes it; take a smaller motion, or lagrotor.simulate"
        )
    speed = float(at.direction @ velocity)
    action = (float(velocity @ at.mass @ velocity) - speed**2) / (2 * at.rate)
    return GuidingCentre(scene, tuple(place + swing), speed, action)


def leaning_state(scene: Scene) -> tuple[Array, Array]:
    """Return the angles (beta, h, alpha) of a scene's axes at the start, and the rates of these angles.

    Parameters
    ----------
    scene : Scene
        A scene with a bar.

    Returns
    -------
    tuple[ndarray, ndarray]
        The angles (beta, h, alpha) in rad and the rates in rad/s, shape (3,) each.

    References
    ----------
    derivations/t14_guiding_centre.py.
    """
    (r1, r2), (v1, v2) = np.array(scene.axes), np.array(scene.rates)
    height = np.linalg.norm(r1 + r2) / 2  # cos h
    mean, apart = (r1 + r2) / (2 * height), (r2 - r1) / 2
    beta, alpha = np.arcsin(mean[0]), np.arctan2(-mean[1], mean[2])
    c, s = np.cos(alpha), np.sin(alpha)
    lean = np.array([np.cos(beta), np.sin(beta) * s, -np.sin(beta) * c])
    normal = np.array([0.0, -c, -s])
    sine = np.copysign(np.linalg.norm(apart), apart @ normal)
    tilt = -sine / (scene.k * np.cos(beta))
    mean_rate = (v1 + v2) / (2 * height)
    mean_rate -= mean * (mean @ mean_rate)
    half = (normal * np.sqrt(1 - tilt**2) + lean * tilt) @ (v2 - v1) / (2 * height)
    rates = lean @ mean_rate, half, normal @ mean_rate / np.cos(beta)
    return np.array([beta, np.arctan2(sine, height), alpha]), np.array(rates)


def leaning_field() -> "tuple[sp.Matrix, sp.Matrix]":
    """Derive the mass matrix M and the vector potential g of the pair with its spins eliminated.

    The Lagrangian is L = q'·M q'/2 + g·q' in q = (beta, h, alpha).

    Returns
    -------
    tuple[Matrix, Matrix]
        The mass matrix M in kg m², shape (3, 3), and the vector potential g in kg m²/s, shape (3, 1).

    References
    ----------
    derivations/t14_guiding_centre.py.
    """
    from lagrotor.algebra import hessian
    from lagrotor.mechanics.lagrangian import gradient
    from lagrotor.pair.lagrangians import leaning_lagrangian
    from lagrotor.pair.notation import LEANING

    L = leaning_lagrangian()
    return hessian(L, LEANING.v), gradient(L, LEANING.v).subs(dict.fromkeys(LEANING.v, 0))


@generated(((),))
def _field_functions() -> str:
    """Return the source code of a function of (beta, h, a, b, k, G_1, G_2) with 37 outputs.

    They are M and f, their derivatives with respect to beta and to h, and g_alpha.
    """
    import sympy as sp

    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import G_1, G_2, LEANING, a, b, k

    (beta, h, _), (M, g) = LEANING.q, leaning_field()
    values = [*M, g[2].diff(h), -g[2].diff(beta), g[1].diff(beta) - g[0].diff(h)]
    outputs = [*values, *(e.diff(s) for s in (beta, h) for e in values), sp.expand(g[2])]
    return program_source(Program((beta, h, a, b, k, G_1, G_2), (), tuple(outputs)))


def _at(scene: Scene, beta: float, h: float) -> _Place:
    if not abs(np.sin(h)) < scene.k * np.cos(beta) * (1 - 1e-12):
        raise DomainError(
            f"guiding_centre: at the lean {beta:.4g} and the half-angle {h:.4g} rad the bar is in line with an axis or does not "
            f"reach: |sin h| = {abs(np.sin(h)):.4g}, k cos beta = {scene.k * np.cos(beta):.4g}; take a smaller lean or twist, or "
            "lagrotor.simulate"
        )
    *numbers, flux = _field_functions()(beta, h, *scene.inertias, scene.k, *scene.momenta)
    blocks = np.array(numbers).reshape(3, 12)
    (M, *M_slopes), (f, *f_slopes) = blocks[:, :9].reshape(3, 3, 3), blocks[:, 9:]
    size, det = sqrt(f @ M @ f), float(np.linalg.det(M))
    direction, rate = M @ f / size, size / sqrt(det)
    gradient, slopes = np.zeros(3), np.zeros((3, 3))
    for i, (dM, df) in enumerate(zip(M_slopes, f_slopes, strict=True)):
        log_size = (f @ dM @ f / 2 + f @ M @ df) / size**2
        gradient[i] = rate * (log_size - np.trace(np.linalg.solve(M, dM)) / 2)
        slopes[i] = (dM @ f + M @ df) / size - direction * log_size
    curl = np.array([slopes[1, 2], -slopes[0, 2], slopes[0, 1] - slopes[1, 0]])
    return _Place(M, float(flux), f, direction, curl, rate, gradient)
