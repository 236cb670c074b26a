"""Toppling exactly: both axes parallel in the y-z plane, turning uniformly about the joint line, and its stability.

U = chi = 0, alpha = nu t solves the equations of motion of opposite spins at any angle and any rate nu, for any bar.
As alpha is cyclic, the motions near it have constant coefficients; in (U, Delta, alpha), Delta the twist,

    L_2 = A U'² + D Delta'²/4 − A nu² U² + (G nu/k − b nu²) Delta²/2 − G U Delta' + A alpha'²,   A = a + b, D = a − b,

so that turning is stable where  e = b nu² − G nu / k > 0  and unstable where e < 0  (G = G_1 = −G_2). A massless
bar leaves only the sense: nu against G is stable, nu with G is not. Derived in derivations/t8_toppling.py.
"""

from functools import cache

import sympy as sp

from lagrotor.pair.lagrangians import mercator_lagrangian, minimal_embedding
from lagrotor.pair.notation import MERCATOR, MINIMAL, TWISTED, G, a, b, k, nu
from lagrotor.theory.closed_form import ClosedForm


@cache
def twisted_lagrangian() -> sp.Expr:
    """Return the Lagrangian of the pair in (U, Delta, alpha), Delta = alpha_2 − alpha_1, for every k = ell / R; alpha is cyclic.

    The bar, cosh w − k sinh w = cos Delta, is solved through Delta²: exact for everything at Delta = 0 that takes no
    more than two derivatives by Delta, as the equations of motion there and their linearisation do.
    """
    Delta, bend = TWISTED.q[1], sp.Symbol("w_2")
    w = bend * Delta**2 / 2
    bar = sp.cosh(w) - k * sp.sinh(w) - sp.cos(Delta)
    w = w.subs(bend, sp.solve(bar.diff(Delta, 2).subs(Delta, 0), bend)[0])
    names = dict(zip(MINIMAL.q, TWISTED.q, strict=True))
    where = {q: e.subs(names) for q, e in minimal_embedding(Delta, w).items()}
    rates = {
        v: sum((where[q].diff(p) * p_v for p, p_v in zip(TWISTED.q, TWISTED.v, strict=True)), sp.Integer(0))
        for q, v in zip(MERCATOR.q, MERCATOR.v, strict=True)
    }
    return mercator_lagrangian().xreplace(rates).xreplace(where)


def toppling_polynomial() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Return (p_2, p_1, p_0) of opposite spins: motions near uniform turning grow as exp(s t), p_2 s⁴ + p_1 s² + p_0 = 0."""
    A, D, e = a + b, a - b, b * nu**2 - G * nu / k
    return A * D, G**2 + A * D * nu**2 + 2 * A * e, 2 * A * nu**2 * e


@cache
def toppling_growth() -> ClosedForm:
    """Return the growth rate (1/s) of the fastest motion away from uniform toppling at rate nu; 0 where it is stable.

    growth² = −2 p_0 / (p_1 + sqrt(p_1² − 4 p_2 p_0)) where p_0 = 2 A nu² (b nu² − G nu/k) < 0.
    Arguments: nu (rad/s, alpha' = −y'/z), G = G_1 = −G_2, a, b, k.
    """
    two, one, zero = toppling_polynomial()
    falling = sp.Abs(zero) * sp.Heaviside(-zero, 0)
    growth = sp.sqrt(2 * falling / (one + sp.sqrt(one**2 + 4 * two * falling)))
    return ClosedForm(
        "toppling_growth",
        ("growth",),
        (growth,),
        (nu, G, a, b, k),
        (sp.Gt(a, sp.Abs(b)), sp.Ne(G, 0)),
        "opposite spins, axes parallel in the y-z plane, alpha' = nu",
        "5, 7",
    )


@cache
def toppling_threshold() -> ClosedForm:
    """Return nu* = G / (k b): beyond it the sense of turning changes its stability. b > 0: nu in (0, nu*) is unstable (G > 0);
    b < 0: nu > 0 and nu < nu* are; b = 0 has no threshold."""
    return ClosedForm(
        "toppling_threshold",
        ("nu",),
        (G / (k * b),),
        (G, b, k),
        (sp.Ne(b, 0),),
        "opposite spins, uniform turning about the joint line",
        "5, 7",
    )
