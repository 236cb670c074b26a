"""Toppling exactly: both axes parallel in the y-z plane, turning uniformly about the joint line, and its stability.

U = chi = 0, alpha = nu t solves the equations of motion of opposite spins at any angle and any rate nu, for any bar.
As alpha is cyclic, the motions near it have constant coefficients; in (U, Delta, alpha), Delta the twist,

    L_2 = A U'² + D Delta'²/4 − A nu² U² + (G nu/k − b nu²) Delta²/2 − G U Delta' + A alpha'²,   A = a + b, D = a − b,

so that turning is stable where  e = b nu² − G nu / k > 0  and unstable where e < 0  (G = G_1 = −G_2). A massless
bar leaves only the sense: nu against G is stable, nu with G is not.
"""

from functools import cache

import sympy as sp

from lagrotor.algebra import hessian
from lagrotor.mechanics import LinearSystem, euler_lagrange
from lagrotor.pair.lagrangians import mercator_lagrangian, minimal_embedding
from lagrotor.pair.notation import G_1, G_2, MERCATOR, MINIMAL, TWISTED, G, a, b, k, nu
from lagrotor.theory.closed_form import ClosedForm


@cache
def twisted_lagrangian() -> sp.Expr:
    """The pair in (U, Delta, alpha), Delta = alpha_2 − alpha_1, for every k = ell / R; alpha is cyclic.

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


def uniform_toppling() -> dict[sp.Symbol, sp.Expr]:
    """The state of uniform toppling: U = Delta = 0 and at rest, alpha' = nu, no acceleration."""
    still: dict[sp.Symbol, sp.Expr] = dict.fromkeys((*TWISTED.q, *TWISTED.v, *TWISTED.a), sp.Integer(0))
    return still | {TWISTED.v[2]: nu}


def toppling_residual() -> tuple[sp.Expr, ...]:
    """What the equations of motion leave of uniform turning, (U, Delta, alpha): zero exactly if (G_1 + G_2) nu = 0."""
    return tuple(sp.expand(e) for e in euler_lagrange(twisted_lagrangian(), TWISTED).subs(uniform_toppling()))


@cache
def linear_toppling() -> LinearSystem:
    """M a + C v + K q = 0 about uniform turning in (U, Delta, alpha), for any two spins, rate nu, any bar.

    From the second derivatives of L: M = L_vv, C = L_vq − L_qv, K = −L_qq. Meaningful where it is a solution.
    """
    L = twisted_lagrangian()
    q, v = list(TWISTED.q), list(TWISTED.v)
    second = hessian(L, q + v).subs(uniform_toppling()).applyfunc(sp.factor)
    qq, vq, vv = second[:3, :3], second[3:, :3], second[3:, 3:]
    return LinearSystem(vv, (vq - vq.T).applyfunc(sp.factor), -qq, sp.eye(3))


@cache
def toppling_polynomial() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """(p_2, p_1, p_0): the motions near uniform turning grow as exp(s t), p_2 s⁴ + p_1 s² + p_0 = 0 (opposite spins)."""
    s = sp.Symbol("s")
    polynomial = sp.Poly(linear_toppling().characteristic(s).subs({G_1: G, G_2: -G}), s)
    parts = [polynomial.coeff_monomial(s**n) for n in (6, 4, 2)]
    scale = sp.cancel(parts[0] / ((a + b) * (a - b)))
    two, one, zero = (sp.factor(sp.cancel(part / scale)) for part in parts)
    return two, one, zero


@cache
def toppling_growth() -> ClosedForm:
    """Growth rate (1/s) of the fastest motion away from uniform toppling at rate nu; 0 where it is stable.

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
    """nu* = G / (k b): beyond it the sense of turning changes its stability. b > 0: nu in (0, nu*) is unstable (G > 0);
    b < 0: nu > 0 and nu < nu* are; b = 0 has no threshold."""
    edge = sp.solve(sp.cancel(toppling_polynomial()[2] / nu**3), nu, simplify=False)
    return ClosedForm(
        "toppling_threshold",
        ("nu",),
        (sp.factor(edge[0]),),
        (G, b, k),
        (sp.Ne(b, 0),),
        "opposite spins, uniform turning about the joint line",
        "5, 7",
    )
