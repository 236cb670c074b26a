"""The natural frequency of the coupled pair, for any spins and any bar, and its limits."""

from dataclasses import dataclass, replace
from functools import cache
from math import hypot, sqrt

import sympy as sp

from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics import LinearSystem
from lagrotor.pair.lagrangians import INERTIAS, axes_pair
from lagrotor.pair.scene import Link, Scene
from lagrotor.pair.symbols import AXES, G_1, G_2, K, a, b, ell, m
from lagrotor.theory.calibrated import FREQUENCY_SHIFT, LARGEST_SWING
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.single_rotor import free_precession_rate

_G, _A, _B, _G1, _G2 = sp.symbols("G a b G_1 G_2", positive=True)


@cache
def linear_pair() -> LinearSystem:
    """The coupled pair linearised at rest, in (x, y_1, y_2), for any spins and any bar."""
    return axes_pair().linearise(dict(zip(AXES.q, (0, 0, 1, 0, 0, 1), strict=True)))


@cache
def natural_frequency() -> ClosedForm:
    """Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)): the one oscillation of the linear pair.

    The other roots of det(s² M + s C) are zero: turning about the joint line and displacements at rest.
    """
    s = sp.Symbol("s")
    polynomial = sp.Poly(linear_pair().characteristic(s), s)
    leading, constant = polynomial.coeff_monomial(s**6), polynomial.coeff_monomial(s**4)
    return ClosedForm(
        "natural_frequency",
        ("Omega_0",),
        (sp.sqrt(sp.factor(constant / leading)),),
        (a, b, G_1, G_2),
        (sp.Gt(a, sp.Abs(b)),),
        "small motion about the upright rest state, any spins, any bar",
        "5.28",
    )


def natural_rate(scene: Scene) -> float:
    """Natural angular frequency (rad/s) of a scene: of the coupled pair, or of rotor 1 alone when there is no bar.

    Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)); see `natural_frequency`. Exact in the limit of small
    motion; `natural_rate_error` gives the error at an amplitude. Source: 5.28, corrected.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"natural_rate: {scene!r} must be a Scene")
    first, second = scene.momenta
    if scene.link is None:
        return abs(float(free_precession_rate()(0.0, first, scene.rotor.J)))  # type: ignore[arg-type]
    return float(natural_frequency()(*scene.inertias, first, second))  # type: ignore[arg-type]


def natural_rate_error(scene: Scene, amplitude: float) -> float:
    """Error (rad/s) of `natural_rate` for a swing about the upright position, of `amplitude` r = sine of its inclination.

    Of second order in r: 1/2 (1 + 1/k²) r² Omega_0 with a bar (the factor is empirical, `theory.calibrated`); one rotor
    alone precesses at Omega_0 / cos theta exactly. The swing of opposite spins that turns about the joint line at nu is
    shifted by −(a + b) nu/(k G) of Omega_0 besides. Raises DomainError unless 0 <= r <= 0.4.
    """
    rate = natural_rate(scene)
    if not 0 <= amplitude <= LARGEST_SWING.value:
        raise DomainError(
            f"natural_rate_error: amplitude = {amplitude:g} must lie between 0 and {LARGEST_SWING.value:g}, the range that "
            "was calibrated; use lagrotor.simulate, or precession_orbit for opposite spins"
        )
    if scene.link is None:
        return rate * (1 / sqrt(1 - amplitude**2) - 1)
    ratio = scene.link.length / scene.rotor.length
    return FREQUENCY_SHIFT.value * (1 + 1 / ratio**2) * amplitude**2 * rate


@dataclass(frozen=True)
class RateLimit:
    """One limit: `rate` in rad/s, its formula as text, and what it changes in the scene."""

    rate: float
    formula: str
    says: str


def natural_rate_limits(scene: Scene) -> dict[str, RateLimit]:
    """Limits of the natural rate near a scene with a bar: equal, opposite, massless, dumbbell.

    equal and opposite: both momenta as large as their root mean square G, G/(a + b) and G/sqrt(a² − b²). massless:
    a = J, b = 0. dumbbell: the bar's mass in its ends, K = m ell²/4, so that b = 0, a = J + m R²/2. The formulas are
    those of `natural_frequency` with the limit put in. Raises InputError without a bar.
    """
    if scene.link is None:
        raise InputError("natural_rate_limits: the scene has no bar: it has no limits")
    mean = hypot(*scene.spins) / sqrt(2)
    length, mass = scene.link.length, scene.link.mass
    ends = Link(length, mass, mass * length**2 / 4)
    dumbbell = sp.factor(INERTIAS[a].subs(K, m * ell**2 / 4))
    massless = dumbbell.subs(m, 0)
    tried = {
        "equal": (replace(scene, spins=(mean, mean)), {_G1: _G, _G2: _G}, "spins equal, of the root mean square G"),
        "opposite": (replace(scene, spins=(mean, -mean)), {_G1: _G, _G2: -_G}, "spins opposite, of the same G"),
        "massless": (replace(scene, link=Link(length)), {_B: 0}, f"a bar without mass: a = {massless}, b = 0"),
        "dumbbell": (replace(scene, link=ends), {_B: 0}, f"K = m ell**2/4: a = {dumbbell}, b = 0"),
    }
    return {name: RateLimit(natural_rate(one), _formula(put), says) for name, (one, put, says) in tried.items()}


def _formula(put: dict[sp.Symbol, sp.Expr]) -> str:
    plain = {a: _A, b: _B, G_1: _G1, G_2: _G2}
    squared = sp.factor((natural_frequency().expressions[0] ** 2).subs(plain).subs(put))
    squared = sp.factor(sp.expand(squared).subs(_G1**2, 2 * _G**2 - _G2**2))
    above, below = (sp.sqrt(part) for part in sp.fraction(squared))
    return str(above / (below if below.is_polynomial() else sp.sqrt(sp.expand(below**2))))
