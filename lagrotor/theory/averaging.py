"""The slow motion of opposite spins at any lean: the Hamiltonian averaged over the fast paired precession.

beta is the lean of the mean axis along the joint line, h half the angle between the axes. With h, beta', h' of first order,
alpha' and the momentum P about the joint line of second, beta itself of none, the Lagrangian has no odd order, and

    L_2 = (a + b) beta'² + (a − b) h'² + 2 G h beta'

is flat: the swing  beta = beta_s + s/sqrt(sigma) cos Phi,  h = eta + s sin Phi,  Phi' = Omega_0, has the same frequency at
every lean, and s² is the adiabatic invariant. The mean of L_4 over it moves the centre (beta_s, eta), conjugate to each
other through 2 G. With p = k P/G, kappa = (sigma − 1) k²/2,

    H = G²/((a + b) k²) W + …,    W = ((eta² + (s² − p)/2)² − 3 s⁴/8) / cos² beta_s − kappa s² eta²,

up to a part in s alone. `next_average` is the order after: W_6, of sixth order in eta, s and the root of P.

Derived in derivations/t11_slow_motion.py; `theory.averaged_motion` evaluates it for a scene.
"""

from functools import cache

import sympy as sp

from lagrotor.algebra import truncated_series
from lagrotor.pair.lagrangians import leaning_lagrangian
from lagrotor.pair.notation import G_1, G_2, HALF, LEAN, LEANING, SWING, G, P, a, b, k, sigma

_EPS, _ROOT = sp.symbols("epsilon r", positive=True)
_TAN, _PUSH = sp.symbols("tau p", real=True)
SWING_LETTERS = (_TAN, HALF, SWING, _PUSH, *sp.symbols("S C", real=True))


@cache
def _expanded(order: int) -> sp.Expr:
    """The Lagrangian of opposite spins in h, beta', h' ~ eps, alpha' ~ eps², beta ~ 1, through an order of eps."""
    (_, h, _), (beta_v, h_v, alpha_v) = LEANING.q, LEANING.v
    scaled = {s: _EPS * s for s in (h, beta_v, h_v)} | {alpha_v: _EPS**2 * alpha_v, G_1: G, G_2: -G}
    return sp.expand(truncated_series(leaning_lagrangian().xreplace(scaled), _EPS, order))


@cache
def quartic_lagrangian() -> tuple[sp.Expr, sp.Expr]:
    """(L_2, L_4) of opposite spins in h, beta', h' ~ eps, alpha' ~ eps², beta ~ 1: no odd term."""
    series = _expanded(4)
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
def oscillating_hamiltonian() -> tuple[sp.Poly, sp.Poly, sp.Poly]:
    """H_4, H_5 and H_6 over the swing, polynomials in tan beta_s, eta, s, p = k P/G and sin Phi, cos Phi (`SWING_LETTERS`).

    In units of (a + b) Omega_0², with 1/sigma = r²: momenta 2 r eta of beta_s and r² s² of Phi. To leading order beta' and h' are
    those of the swing; the orders that they leave add the squares of what L_4 gives of the momenta. beta is beta_s still.
    """
    (beta, h, _), (beta_v, h_v, alpha_v) = LEANING.q, LEANING.v
    w = sp.Symbol("w", positive=True)  # 1/cos beta
    unit = {a: (1 + _ROOT**2) / 2, b: (1 - _ROOT**2) / 2, G: _ROOT}
    unit |= {sp.tan(beta): _TAN, sp.sin(beta): _TAN / w, sp.cos(beta): 1 / w}
    four, five, six = (sp.expand(_expanded(6).coeff(_EPS, n).subs(unit)) for n in (4, 5, 6))
    turning = sp.solve(four.diff(alpha_v) - _ROOT * _PUSH / k, alpha_v, simplify=False)[0]
    fourth, fifth = ((e - n * alpha_v).subs(alpha_v, turning) for e, n in ((four, _ROOT * _PUSH / k), (five, 0)))
    sixth = (six - five.diff(alpha_v) ** 2 / (2 * four.diff(alpha_v, 2))).subs(alpha_v, turning)
    left = (fourth.diff(beta_v) / 2) ** 2 + (fourth.diff(h_v) / (2 * _ROOT)) ** 2
    _, _, _, _, sine, cosine = SWING_LETTERS
    swinging = {h: HALF + SWING * sine, h_v: SWING * cosine, beta_v: -_ROOT * SWING * sine}
    field = sp.QQ.frac_field(_ROOT, k)

    def polynomial(e: sp.Expr) -> sp.Poly:
        return sp.Poly(
            sp.expand(e.subs(w, sp.sqrt(1 + _TAN**2)).subs(swinging, simultaneous=True)), *SWING_LETTERS, domain=field
        )

    return polynomial(-fourth), polynomial(-fifth), polynomial(left - sixth)


@cache
def next_average() -> sp.Expr:
    """W_6 in beta_s, eta, s, p, sigma and k: H = G²/((a + b) k²) (W + W_6), up to parts in s alone.

    Of H = I + H_4(beta_s + delta) + H_5 + H_6 with delta = r s cos Phi and I = r² s², Phi' = 1,

        <H_6> + <delta dH_5/dbeta> + <delta² d²H_4/dbeta²>/2 − d/dI <(H_4 − <H_4>)²>/2.
    """
    H_4, H_5, H_6 = oscillating_hamiltonian()
    tangent, _, s, _, _, cosine = (sp.Poly(x, *SWING_LETTERS, domain=H_4.domain) for x in SWING_LETTERS)
    delta, slope = _ROOT * s * cosine, 1 + tangent**2  # d tan beta/dbeta
    shaken = H_6 + delta * slope * H_5.diff(_TAN) + delta**2 * slope * (slope * H_4.diff(_TAN)).diff(_TAN) / 2
    square = over_swing(H_4**2) - over_swing(H_4) ** 2
    sixth = over_swing(shaken) - square.diff(SWING).quo(s) / (4 * _ROOT**2)
    terms = (k**2 / _ROOT**2 * sixth).as_dict(native=False)
    return sp.Add(
        *(
            sp.factor(e.subs(_ROOT, 1 / sp.sqrt(sigma))) * sp.tan(LEAN) ** t * HALF**n * SWING**m * _PUSH**d
            for (t, n, m, d, _, _), e in terms.items()
        )
    )


def over_swing(f: sp.Poly) -> sp.Poly:
    """The mean over Phi of a polynomial in `SWING_LETTERS`.

    Args:
        f: the polynomial.
    """
    mean: dict[tuple[int, ...], sp.Expr] = {}
    for (*slow, m, n), coefficient in f.as_dict(native=False).items():
        mean[*slow, 0, 0] = mean.get((*slow, 0, 0), 0) + coefficient * _mean(m, n)
    return sp.Poly(mean, *SWING_LETTERS, domain=f.domain)


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
