"""The slow motion of opposite spins: the quartic Routhian averaged over the swing.

With U, Delta of first order and alpha' of second, the Lagrangian of the pair has no cubic term once the cyclic alpha
is eliminated at its momentum P; so one average over the swing

    U = X + u cos Phi,    Delta = Delta_s + d sin Phi,    Phi' = Omega_0

gives the slow motion of the mean (X, Delta_s), conjugate to each other through G, to third order:

    G X' = −d<R_4>/d Delta_s,      G Delta_s' = d<R_4>/d X.
"""

from functools import cache

import sympy as sp

from ..symbols import G_1, G_2, G, a, b, k
from .toppling import TWISTED, twisted_lagrangian

P = sp.Symbol("P", real=True)  # momentum about the joint line (kg m²/s)
X, TWIST, SWING = sp.symbols("X Delta_s d", real=True)  # mean of U and of Delta; amplitude of the swing in Delta
_EPS = sp.Symbol("epsilon", positive=True)


@cache
def quartic_lagrangian() -> tuple[sp.Expr, sp.Expr]:
    """(L_2, L_4) of opposite spins in U, Delta ~ eps, alpha' ~ eps²: no odd term."""
    (U, Delta, _), (U_v, Delta_v, alpha_v) = TWISTED.q, TWISTED.v
    L = twisted_lagrangian().subs({G_1: G, G_2: -G})
    L = L.subs({s: _EPS * s for s in (U, Delta, U_v, Delta_v)} | {alpha_v: _EPS**2 * alpha_v}, simultaneous=True)
    parts = []
    for n in range(5):
        parts.append(sp.expand(L.subs(_EPS, 0) / sp.factorial(n)))
        L = L.diff(_EPS)
    if any(part != 0 for part in (parts[1], parts[3])):
        raise ArithmeticError("quartic_lagrangian: an odd order is left")
    return parts[2], parts[4]


@cache
def quartic_routhian() -> sp.Expr:
    """L_4 − P alpha' with alpha' = (P − G Delta²/(2k)) / (2 (a + b)) put in: in U, Delta and their rates."""
    alpha_v = TWISTED.v[2]
    quartic = quartic_lagrangian()[1]
    rate = sp.solve(quartic.diff(alpha_v) - P, alpha_v)[0]
    return sp.expand((quartic - P * alpha_v).subs(alpha_v, rate))


@cache
def averaged_routhian() -> sp.Expr:
    """<R_4> over the swing of amplitude d in Delta: a polynomial in X, Delta_s, d, P."""
    (U, Delta, _), (U_v, Delta_v, _) = TWISTED.q, TWISTED.v
    A, D = a + b, a - b
    rate = G / sp.sqrt(A * D)
    # 2 A U'' = −G Delta': the swing's share in U.
    share = SWING * sp.sqrt(D / A) / 2
    c, s = sp.symbols("c s")
    moving = {U: X + share * c, U_v: -share * rate * s, Delta: TWIST + SWING * s, Delta_v: SWING * rate * c}
    polynomial = sp.Poly(quartic_routhian().subs(moving), c, s)
    mean = sum((coefficient * _mean(m, n) for (m, n), coefficient in polynomial.terms()), sp.Integer(0))
    return sp.expand(mean)


def _mean(m: int, n: int) -> sp.Rational:
    """Mean of cos^m sin^n over a turn: zero unless both are even, else (m−1)!! (n−1)!! / (m+n)!!."""
    if m % 2 or n % 2:
        return sp.Integer(0)
    return sp.factorial2(m - 1) * sp.factorial2(n - 1) / sp.factorial2(m + n)


@cache
def slow_rates() -> tuple[sp.Expr, sp.Expr]:
    """(X', Delta_s') of the mean to third order, in X, Delta_s, d, P."""
    mean = averaged_routhian()
    return sp.factor(-mean.diff(TWIST) / G), sp.factor(mean.diff(X) / G)


@cache
def slow_stiffness() -> tuple[sp.Expr, sp.Expr]:
    """Second derivatives of <R_4> by X and by Delta_s on the paired precession of amplitude d in Delta (no drift).

    The first vanishes: to this order nothing holds the mean x; the second is b Omega_0² d²/4: zero for a massless bar.
    """
    mean = averaged_routhian()
    momentum = G * SWING**2 / (4 * k)  # <alpha'> = 0
    at = {X: 0, TWIST: 0, P: momentum}
    first, second = (sp.factor(mean.diff(q, 2).subs(at)) for q in (X, TWIST))
    return first, second
