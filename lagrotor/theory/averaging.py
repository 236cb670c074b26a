"""The slow motion of opposite spins: the quartic Routhian averaged over the swing.

With U, Delta of first order and alpha' of second, the Lagrangian of the pair has no cubic term once the cyclic alpha
is eliminated at its momentum P; so one average over the swing

    U = X + u cos Phi,    Delta = Delta_s + d sin Phi,    Phi' = Omega_0

gives the slow motion of the mean (X, Delta_s), conjugate to each other through G, to third order:

    G X' = −d<R_4>/d Delta_s,      G Delta_s' = d<R_4>/d X.
"""

from functools import cache

import sympy as sp

from lagrotor.algebra import truncated_series
from lagrotor.pair.notation import G_1, G_2, SWING, TWIST, TWISTED, G, P, X, a, b, k
from lagrotor.theory.toppling import twisted_lagrangian

_EPS = sp.Symbol("epsilon", positive=True)


@cache
def quartic_lagrangian() -> tuple[sp.Expr, sp.Expr]:
    """(L_2, L_4) of opposite spins in U, Delta ~ eps, alpha' ~ eps²: no odd term."""
    (U, Delta, _), (U_v, Delta_v, alpha_v) = TWISTED.q, TWISTED.v
    scaled = {s: _EPS * s for s in (U, Delta, U_v, Delta_v)} | {alpha_v: _EPS**2 * alpha_v, G_1: G, G_2: -G}
    series = sp.expand(truncated_series(twisted_lagrangian().xreplace(scaled), _EPS, 4))
    if series.coeff(_EPS, 1) != 0 or series.coeff(_EPS, 3) != 0:
        raise ArithmeticError("quartic_lagrangian: an odd order is left")
    return series.coeff(_EPS, 2), series.coeff(_EPS, 4)


@cache
def quartic_routhian() -> sp.Expr:
    """L_4 − P alpha' with alpha' = (P − G Delta²/(2k)) / (2 (a + b)) put in: in U, Delta and their rates."""
    (U, Delta, _), (U_v, Delta_v, alpha_v) = TWISTED.q, TWISTED.v
    quartic = quartic_lagrangian()[1]
    rate = sp.solve(quartic.diff(alpha_v) - P, alpha_v, simplify=False)[0]
    return sp.Poly((quartic - P * alpha_v).subs(alpha_v, rate), U, Delta, U_v, Delta_v).as_expr()


@cache
def averaged_routhian() -> sp.Expr:
    """<R_4> over the swing of amplitude d in Delta: a polynomial in X, Delta_s, d, P."""
    (U, Delta, _), (U_v, Delta_v, _) = TWISTED.q, TWISTED.v
    c, s, share, rate = sp.symbols("c s share rate")
    moving = {U: X + SWING * share * c, Delta: TWIST + SWING * s}
    moving |= {U_v: -SWING * share * rate * s, Delta_v: SWING * rate * c}
    polynomial = sp.Poly(quartic_routhian().subs(moving), c, s)
    mean = sum((coefficient * _mean(m, n) for (m, n), coefficient in polynomial.terms()), sp.Integer(0))
    root = sp.sqrt((a + b) * (a - b))
    swing = {share: root / (2 * (a + b)), rate: G / root}  # 2 (a + b) U'' = −G Delta'
    terms = sp.Poly(mean, X, TWIST, SWING, P).as_dict(native=False)
    return sp.Add(
        *(
            sp.factor(coefficient.subs(swing)) * sp.Mul(*map(sp.Pow, (X, TWIST, SWING, P), powers))
            for powers, coefficient in terms.items()
        )
    )


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

    The first vanishes: to this order nothing holds the mean x; the second is b Omega_0² d²/8: zero for a massless bar.
    """
    mean = averaged_routhian()
    momentum = G * SWING**2 / (4 * k)  # <alpha'> = 0
    at = {X: 0, TWIST: 0, P: momentum}
    first, second = (sp.factor(mean.diff(q, 2).subs(at)) for q in (X, TWIST))
    return first, second
