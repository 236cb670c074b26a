"""The slow motion of opposite spins at any lean: the Hamiltonian averaged over the fast paired precession.

beta is the lean of the mean axis along the joint line, h half the angle between the axes. With h, beta', h' of first order,
alpha' and the momentum P about the joint line of second, beta itself of none, the Lagrangian has no odd order, and

    L_2 = (a + b) beta'² + (a − b) h'² + 2 G h beta'

is flat: the swing  beta = beta_s + s/sqrt(sigma) cos Phi,  h = eta + s sin Phi,  Phi' = Omega_0, has the same frequency at
every lean, and s² is the adiabatic invariant. The mean of L_4 over it moves the centre (beta_s, eta), conjugate to each
other through 2 G. With p = k P/G, kappa = (sigma − 1) k²/2,

    H = G²/((a + b) k²) W + …,    W = ((eta² + (s² − p)/2)² − 3 s⁴/8) / cos² beta_s − kappa s² eta²,

up to a part in s alone.

Derived in derivations/t11_slow_motion.py; `theory.averaged_motion` evaluates it for a scene.
"""

from functools import cache

import sympy as sp

from lagrotor.algebra import truncated_series
from lagrotor.pair.lagrangians import leaning_lagrangian
from lagrotor.pair.notation import G_1, G_2, HALF, LEAN, LEANING, SWING, G, P, a, b

_EPS = sp.Symbol("epsilon", positive=True)


@cache
def quartic_lagrangian() -> tuple[sp.Expr, sp.Expr]:
    """(L_2, L_4) of opposite spins in h, beta', h' ~ eps, alpha' ~ eps², beta ~ 1: no odd term."""
    (_, h, _), (beta_v, h_v, alpha_v) = LEANING.q, LEANING.v
    scaled = {s: _EPS * s for s in (h, beta_v, h_v)} | {alpha_v: _EPS**2 * alpha_v, G_1: G, G_2: -G}
    series = sp.expand(truncated_series(leaning_lagrangian().xreplace(scaled), _EPS, 4))
    if series.coeff(_EPS, 1) != 0 or series.coeff(_EPS, 3) != 0:
        raise ArithmeticError("quartic_lagrangian: an odd order is left")
    return series.coeff(_EPS, 2), series.coeff(_EPS, 4)


@cache
def quartic_routhian() -> sp.Expr:
    """L_4 − P alpha' with alpha' = (P − 2 G h²/k) / (2 (a + b) cos² beta) put in: in beta, h and their rates."""
    alpha_v = LEANING.v[2]
    quartic = quartic_lagrangian()[1]
    rate = sp.solve(quartic.diff(alpha_v) - P, alpha_v, simplify=False)[0]
    return sp.expand((quartic - P * alpha_v).subs(alpha_v, rate))


@cache
def averaged_hamiltonian() -> sp.Expr:
    """−<R_4> over the swing of amplitude s in h: a polynomial in eta, s, P, with 1/cos² beta_s."""
    (beta, h, _), (beta_v, h_v, _) = LEANING.q, LEANING.v
    c, s, rate = sp.symbols("c s rate")
    # beta' of amplitude s Omega_0/sqrt(sigma) = s G/(a + b); Omega_0 itself occurs squared.
    moving = {beta: LEAN, h: HALF + SWING * s, h_v: SWING * rate * c, beta_v: -SWING * G / (a + b) * s}
    polynomial = sp.Poly(sp.expand(quartic_routhian().subs(moving)), c, s)
    mean = sum((coefficient * _mean(m, n) for (m, n), coefficient in polynomial.terms()), sp.Integer(0))
    mean = sp.expand(mean.subs(rate**2, G**2 / ((a + b) * (a - b))))
    terms = sp.Poly(-mean, HALF, SWING, P).as_dict(native=False)
    return sp.Add(*(sp.factor(e) * sp.Mul(*map(sp.Pow, (HALF, SWING, P), powers)) for powers, e in terms.items()))


@cache
def slow_rates() -> tuple[sp.Expr, sp.Expr]:
    """(beta_s', eta') of the mean, to third order in eta, s and the root of P at any lean."""
    mean = averaged_hamiltonian()
    return sp.factor(mean.diff(HALF) / (2 * G)), sp.factor(-mean.diff(LEAN) / (2 * G))


def _mean(m: int, n: int) -> sp.Rational:
    """Mean of cos^m sin^n over a turn: zero unless both are even, else (m−1)!! (n−1)!! / (m+n)!!."""
    if m % 2 or n % 2:
        return sp.Integer(0)
    return sp.factorial2(m - 1) * sp.factorial2(n - 1) / sp.factorial2(m + n)
