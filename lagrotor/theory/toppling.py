"""Exact toppling, in which both axes are parallel in the y-z plane and rotate uniformly about the joint line, and its stability.

In the coordinates (U, chi, alpha) of `pair.notation`, U = chi = 0, alpha = nu t solves the equations of motion of opposite
spins at any angle and any rate nu, for any bar. As alpha is cyclic, the linearised motions have constant coefficients; in (U,
Delta, alpha), Delta the twist,

    L_2 = A U'² + D Delta'²/4 − A nu² U² + (G nu/k − b nu²) Delta²/2 − G U Delta' + A alpha'²,   A = a + b, D = a − b,

so that the rotation is stable if  e = b nu² − G nu / k > 0  and unstable if e < 0  (G = G_1 = −G_2). For a massless bar the
sense of rotation decides: nu against G is stable, nu with G is unstable. Derived in derivations/t8_toppling.py.
"""

from functools import cache

import sympy as sp

from lagrotor.pair.lagrangians import mercator_lagrangian, minimal_embedding
from lagrotor.pair.notation import MERCATOR, MINIMAL, TWISTED, G, a, b, k, nu
from lagrotor.theory.closed_form import ClosedForm


@cache
def twisted_lagrangian() -> sp.Expr:
    """Derive the Lagrangian of the pair in (U, Delta, alpha), Delta = alpha_2 − alpha_1, for every k = ell/R; alpha is cyclic.

    The bar's constraint, cosh w − k sinh w = cos Delta, is solved for w through order Delta². Derivatives at Delta = 0
    are exact to second order in Delta, so the equations of motion there and their linearisation are exact.

    Returns
    -------
    Expr
        The Lagrangian in J.

    References
    ----------
    derivations/t8_toppling.py.
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
    """Return the coefficients of the characteristic polynomial p_2 s⁴ + p_1 s² + p_0 about uniform rotation of opposite spins.

    Returns
    -------
    tuple[Expr, Expr, Expr]
        The coefficients (p_2, p_1, p_0) as functions of nu (rad/s), G (kg m²/s), a, b (kg m²), k.

    References
    ----------
    derivations/t8_toppling.py.
    """
    A, D, e = a + b, a - b, b * nu**2 - G * nu / k
    return A * D, G**2 + A * D * nu**2 + 2 * A * e, 2 * A * nu**2 * e


@cache
def toppling_growth() -> ClosedForm:
    """Derive the growth rate of the fastest motion away from uniform toppling at rate nu; 0 if it is stable.

    growth² = −2 p_0 / (p_1 + sqrt(p_1² − 4 p_2 p_0)) if p_0 = 2 A nu² (b nu² − G nu/k) < 0.

    Returns
    -------
    ClosedForm
        The rate in 1/s as a function of nu (rad/s, alpha' = −y'/z), G = G_1 = −G_2 (kg m²/s), a, b (kg m²), k.

    References
    ----------
    Sections 5 and 7 of the paper; derivations/t8_toppling.py.
    """
    p_2, p_1, p_0 = toppling_polynomial()
    falling = sp.Abs(p_0) * sp.Heaviside(-p_0, 0)
    growth = sp.sqrt(2 * falling / (p_1 + sp.sqrt(p_1**2 + 4 * p_2 * falling)))
    validity = "opposite spins, axes parallel in the y-z plane, alpha' = nu", "5, 7"
    domain = sp.Gt(a, sp.Abs(b)), sp.Ne(G, 0)
    return ClosedForm("toppling_growth", ("growth",), (growth,), (nu, G, a, b, k), domain, *validity)


@cache
def toppling_threshold() -> ClosedForm:
    """Derive nu* = G / (k b), beyond which the stability of a sense of rotation is reversed.

    For G > 0 the unstable rates are 0 < nu < nu* if b > 0, and nu < nu* or nu > 0 if b < 0. There is no threshold for b = 0.

    Returns
    -------
    ClosedForm
        The threshold in rad/s as a function of G (kg m²/s), b (kg m²), k.

    References
    ----------
    Sections 5 and 7 of the paper; derivations/t8_toppling.py.

    Examples
    --------
    >>> toppling_threshold().expressions
    (G/(b*k),)
    """
    validity = "opposite spins, uniform turning about the joint line", "5, 7"
    return ClosedForm("toppling_threshold", ("nu",), (G / (k * b),), (G, b, k), (sp.Ne(b, 0),), *validity)
