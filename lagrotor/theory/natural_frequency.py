"""The natural frequency of the coupled pair, derived for any spins and any bar, and the formulas of its limits.

`lagrotor.theory.natural_rate` evaluates them for a scene.
"""

from functools import cache

import sympy as sp

from lagrotor.mechanics import LinearSystem
from lagrotor.pair.lagrangians import INERTIAS, axes_pair
from lagrotor.pair.notation import AXES, G_1, G_2, K, a, b, ell, m
from lagrotor.theory.closed_form import ClosedForm

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


def limit_formulas() -> dict[str, tuple[str, str]]:
    """Limit → its formula and, where the bar is changed, what it makes of a and b, as text.

    equal and opposite spins, any bar; a massless bar; K = m ell²/4, the bar's mass in its ends.
    """
    dumbbell = sp.factor(INERTIAS[a].subs(K, m * ell**2 / 4))
    return {
        "equal": (_formula({_G1: _G, _G2: _G}), ""),
        "opposite": (_formula({_G1: _G, _G2: -_G}), ""),
        "massless": (_formula({_B: 0}), f"a = {_text(dumbbell.subs(m, 0))}, b = 0"),
        "dumbbell": (_formula({_B: 0}), f"a = {_text(dumbbell)}, b = 0"),
    }


def _formula(put: dict[sp.Symbol, sp.Expr]) -> str:
    plain = {a: _A, b: _B, G_1: _G1, G_2: _G2}
    squared = sp.factor((natural_frequency().expressions[0] ** 2).subs(plain).subs(put))
    squared = sp.factor(sp.expand(squared).subs(_G1**2, 2 * _G**2 - _G2**2))
    above, below = (sp.sqrt(part) for part in sp.fraction(squared))
    return _text(above / (below if below.is_polynomial() else sp.sqrt(sp.expand(below**2))))


def _text(expression: sp.Expr) -> str:
    """On one line, as people write it."""
    return str(expression).replace("**2", "²").replace("*", " ").replace("sqrt(", "√(").replace(" - ", " − ")
