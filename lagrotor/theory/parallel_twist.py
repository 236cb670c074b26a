"""Equal spins: the parallel pair is exactly one rotor; the growth of a small twist on it.

With r_1 = r_2 = r and G_1 = G_2 no force drives a twist: the pair is one rotor of inertia a + b and momentum G for each axis,
and precesses steadily about any fixed direction h at G / ((a + b) cos theta). A small twist Delta obeys, on any parallel motion
r(t), x = r . e_x,

    d/dt ( (a − b)/2 (1 − x²) Delta' ) + b (|r'|² + x x'') Delta = 0,

independent of G and ell / R. The twist grows for b < 0: a bar with K > m ell²/4, more inertia than two point masses at the ends.
It drifts for b = 0. For b > 0 it is bounded on cones with pi² beta sin² theta <= 4 cos theta, beta = b/(a − b) (Lyapunov's
criterion; Magnus & Winkler, Hill's Equation, 1966, ch. V); on wider cones it may grow by resonance. Derived in
derivations/t9_twist.py.
"""

from dataclasses import replace
from functools import cache
from math import cos, pi, sin

import numpy as np
import sympy as sp

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.arrays import Array
from lagrotor.pair.notation import G, Phi, a, b, rho
from lagrotor.pair.scene import Scene
from lagrotor.theory.closed_form import ClosedForm


@cache
def twist_growth() -> ClosedForm:
    """Derive the growth rate of a small twist on the steady precession of equal spins, to first order in the half-angle.

    It is rho |G| sqrt(−b / (a − b)) / (a + b) for b < 0, and zero for b >= 0 (b = 0: a drift in time), with rho the sine of the
    half-angle of the cone: the mean of the twist's stiffness b Omega² rho² sin² Phi over its inertia (a − b)/2.

    Returns
    -------
    ClosedForm
        The rate in 1/s as a function of rho, G (kg m²/s), a, b (kg m²). A call raises DomainError for b > 0 on a cone wider than
        Lyapunov's criterion allows.

    References
    ----------
    Section 5 of the paper; derivations/t9_twist.py.
    """
    rate = G / (a + b)
    mean = sp.integrate(b * rate**2 * rho**2 * sp.sin(Phi) ** 2, (Phi, 0, 2 * sp.pi)) / (2 * sp.pi)
    squared = sp.factor(-mean / ((a - b) / 2))
    growth, domain = sp.sqrt(sp.Max(squared, 0)), (sp.Gt(a, sp.Abs(b)), sp.Lt(rho, 1), lyapunov_criterion())
    validity = "equal spins, parallel axes on a cone about the vertical", "5", 1, rho

    def error(*values: Array) -> Array:
        return np.asarray(twist_growth_error()(*values))

    return ClosedForm("twist_growth", ("growth",), (growth,), (rho, G, a, b), domain, *validity, error)


@cache
def twist_growth_error() -> ClosedForm:
    """Derive the error of `twist_growth`: the third-order term of the exact growth, divided by 1 − rho².

    The exact growth is rho |G| sqrt(−beta)/(a + b) (1 + (3/4 + beta/16) rho² + …), beta = b/(a − b), −1/2 < beta < 0. The
    factor 1/(1 − rho²) accounts for higher orders; it is not derived, but was observed on Hill's equation.

    Returns
    -------
    ClosedForm
        The error in 1/s as a function of rho, G (kg m²/s), a, b (kg m²).

    References
    ----------
    derivations/t9_twist.py.
    """
    form, beta = twist_growth(), b / (a - b)
    error = form.expressions[0] * rho**2 * (sp.Rational(3, 4) + sp.Abs(beta) / 16) / (1 - rho**2)
    name = "twist_growth_error"
    return replace(form, name=name, outputs=("error",), expressions=(error,), order=None, small=None, bound=None)


@cache
def lyapunov_criterion() -> sp.Rel:
    """Derive the condition under which a small twist is bounded for b > 0: pi² beta rho² <= 4 sqrt(1 − rho²).

    Lyapunov: all solutions of (p y')' + q y = 0 with p > 0, q >= 0 of period T are bounded if the mean of q is positive and ∫
    dΦ/p ∫ q dΦ <= 4 over a period; p = 1 − rho² cos² Phi, q = 2 beta rho² sin² Phi, T = pi.

    Returns
    -------
    Rel
        The inequality in rho, a and b, with beta = b/(a − b).

    References
    ----------
    derivations/t9_twist.py.
    """
    length = sp.pi / sp.sqrt(1 - rho**2)
    stiffness = sp.integrate(2 * b / (a - b) * rho**2 * sp.sin(Phi) ** 2, (Phi, 0, sp.pi))
    return sp.Le(length * stiffness, 4)


def parallel_scene(scene: Scene, angle: float, twist_rate: float = 0.0) -> Scene:
    """Return a scene in parallel steady precession of rate G / ((a + b) cos angle), at x = sin(angle).

    Parameters
    ----------
    scene : Scene
        Equal spins with a bar.
    angle : float
        Half-angle of the cone about the vertical in rad.
    twist_rate : float, default 0.0
        Initial twist rate Delta' in rad/s, small.

    Returns
    -------
    Scene
        The same rotors and bar on the precession.

    Raises
    ------
    InputError
        Unless the spins are equal and there is a bar.

    References
    ----------
    derivations/t9_twist.py.
    """
    from lagrotor.pair.initial_conditions import consistent_scene

    inertia_a, inertia_b, G_value = _equal(scene, angle, "parallel_scene")
    rate = G_value / ((inertia_a + inertia_b) * cos(angle))
    axis = (sin(angle), 0.0, cos(angle))
    # At x = sin(angle) turning about the joint line moves y alone: alpha' = −y'/z.
    first, second = ((0.0, rate * sin(angle) + sign * twist_rate / 2 * cos(angle), 0.0) for sign in (1.0, -1.0))
    return consistent_scene(scene.spins, (axis, axis), (first, second), scene.rotor, scene.link)


def twist_multiplier_growth(scene: Scene, angle: float) -> float:
    """Compute the growth rate of a small twist from Hill's equation, exact in the angle of the cone.

    The equation has period pi in the phase Phi, and the error is at most 5·10⁻⁶ of the precession rate:

        ((1 − rho² cos² Phi) Delta')' + 2 b rho² sin² Phi / (a − b) Delta = 0.

    Parameters
    ----------
    scene : Scene
        Equal spins with a bar.
    angle : float
        Half-angle of the cone in rad.

    Returns
    -------
    float
        The rate in 1/s; 0 for a bounded twist.

    Raises
    ------
    InputError
        Unless the spins are equal and there is a bar.
    DomainError
        Unless 0 < angle < pi/2.

    References
    ----------
    derivations/t9_twist.py.
    """
    from scipy.integrate import solve_ivp

    inertia_a, inertia_b, G_value = _equal(scene, angle, "twist_multiplier_growth")
    squared, weight = sin(angle) ** 2, 2 * inertia_b / (inertia_a - inertia_b)

    def rhs(phase: float, y: Array) -> Array:
        inertia = 1 - squared * cos(phase) ** 2
        stiffness = weight * squared * sin(phase) ** 2
        return np.array([y[2] / inertia, y[3] / inertia, -stiffness * y[0], -stiffness * y[1]])

    end = solve_ivp(rhs, (0, pi), np.array([1.0, 0.0, 0.0, 1.0]), method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    half_trace = abs(float(end[0] + end[3])) / 2
    turn = abs(G_value) / ((inertia_a + inertia_b) * cos(angle))
    return float(np.arccosh(half_trace)) / pi * turn if half_trace > 1 + 1e-11 else 0.0


def twist_bounded(scene: Scene, angle: float) -> bool:
    """Return True if the parallel precession of equal spins keeps a small twist bounded.

    The condition is b > 0, that is K < m ell²/4, and Lyapunov's criterion.

    Parameters
    ----------
    scene : Scene
        Equal spins with a bar.
    angle : float
        Half-angle of the cone in rad.

    Returns
    -------
    bool
        True if both conditions hold.

    Raises
    ------
    InputError
        Unless the spins are equal and there is a bar.

    References
    ----------
    derivations/t9_twist.py.

    Examples
    --------
    >>> from lagrotor import Link, Scene
    >>> [twist_bounded(Scene((10, 10), link=Link(1.0, 1.0, K)), angle=0.3) for K in (0.1, 0.5)]
    [True, False]
    """
    inertia_a, inertia_b, _ = _equal(scene, angle, "twist_bounded")
    criterion = lyapunov_criterion().subs({a: inertia_a, b: inertia_b, rho: sin(angle)})
    return inertia_b > 0 and bool(criterion)


def _equal(scene: Scene, angle: float, where: str) -> tuple[float, float, float]:
    if scene.spins[0] != scene.spins[1] or scene.spins[0] == 0 or scene.link is None:
        raise InputError(f"{where}: a parallel precession needs a bar and equal spins, not {scene.spins}")
    if not 0 < angle < pi / 2:
        raise DomainError(f"{where}: angle = {angle:g} must lie between 0 and pi/2 rad")
    return *scene.inertias, scene.momenta[0]
