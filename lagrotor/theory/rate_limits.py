"""The natural rate of a scene beside its limits: equal spins, opposite spins, a massless bar, a dumbbell."""

from dataclasses import dataclass, replace
from math import hypot, sqrt

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.pair.symbols import G_1, G_2, K, a, b, ell, m
from lagrotor.theory.natural_frequency import natural_frequency, natural_rate
from lagrotor.pair.lagrangians import INERTIAS
from lagrotor.pair.scene import Link, Scene

_G, _A, _B, _G1, _G2 = sp.symbols("G a b G_1 G_2", positive=True)


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
