"""The right-hand side of the model `minimal` as a short program: the bar eliminated, one multiplier, no linear system.

Mercator coordinates of an axis, r = (tanh u, −sin alpha sech u, cos alpha sech u), and its tangent frame
e = (sech u, sin alpha tanh u, −cos alpha tanh u), f = (0, −cos alpha, −sin alpha):

    r' = sech u (u' e + alpha' f),   r × r' = sech u (alpha' e − u' f),
    u'' = tanh u (u'² − alpha'²) + r''.e / sech u,   alpha'' = 2 tanh u u' alpha' + r''.f / sech u.

The bar is a curve w(chi), Delta(chi) of u_1 − u_2 and alpha_2 − alpha_1; its force acts along ± (Delta', w') / sech u_i.
The tests compare each program with the mass matrix of the Lagrangian, solved automatically.
"""

from functools import lru_cache
from typing import Literal, NamedTuple

import sympy as sp

from lagrotor.models.model import FARTHEST_ALONG
from lagrotor.numerics.codegen import Program, Stage, solve_symmetric
from lagrotor.pair.notation import G_1, G_2, MINIMAL, a, b, k

Ratio = Literal["short", "equal", "long"]
_Pair = tuple[sp.Expr, sp.Expr]
FORCE = sp.symbols("F_x F_y F_z", real=True)
(_U, _CHI, _ALPHA), (_U_V, _CHI_V, _ALPHA_V) = MINIMAL.q, MINIMAL.v
# Delta, its cosine and sine, rho of the bar's curve, exp(−w), exp(2 U).
_D, _C, _S, _RHO, _DROP, _E = sp.symbols("D c_D s_D rho drop e_U", real=True)
_D1, _D2, _W1, _W2 = sp.symbols("D_1 D_2 w_1 w_2", real=True)


class _Curve(NamedTuple):
    """First and second derivatives D1, D2 of Delta and W1, W2 of w by chi, and `square`, which is Delta'² + w'²."""

    D1: sp.Expr
    D2: sp.Expr
    W1: sp.Expr
    W2: sp.Expr
    square: sp.Expr


class _Rotor(NamedTuple):
    """The quantities of one rotor: exp(2 u), tanh u, u', alpha', G/a, and the force divided by a in the tangent frame."""

    e: sp.Symbol
    t: sp.Symbol
    u_v: sp.Symbol
    alpha_v: sp.Symbol
    g: sp.Expr
    force: _Pair


class _Stages(list[Stage]):
    def keep(self, name: str, expression: sp.Expr) -> sp.Symbol:
        symbol = sp.Symbol(name, real=True)
        self.append((symbol, expression))
        return symbol


@lru_cache(maxsize=32)
def program(massive: bool, ratio: Ratio, body: int) -> Program:
    """Derive the program (U, chi, alpha, rates; a[, b][, k], G_1, G_2[, F]) → six derivatives. `body` 0 has no force F."""
    stages = _Stages()
    curve = _curve(stages, ratio)
    rotors = _rotors(stages, curve, ratio, body)
    accelerations = _massive(stages, rotors, curve) if massive else _massless(stages, rotors, curve)
    lengths = () if ratio == "equal" else (k,)
    parameters = (a, *((b,) if massive else ()), *lengths, G_1, G_2, *(FORCE if body else ()))
    away = tuple(sp.Rational(*FARTHEST_ALONG) ** 2 - r.t**2 for r in rotors)
    return Program((*MINIMAL.q, *MINIMAL.v, *parameters), tuple(stages), (*MINIMAL.v, *accelerations), positive=away)


def observation(ratio: Ratio) -> Program:
    """Derive the program (U, chi, alpha, rates; k) → the twelve components of r_1, r_2, r_1', r_2'."""
    stages = _Stages()
    rotors = _rotors(stages, _curve(stages, ratio), ratio, 0)
    axes, rates = [], []
    for i, (r, sign) in enumerate(zip(rotors, (1, -1), strict=True), start=1):
        turn = _ALPHA - sign * _D / 2
        sech = stages.keep(f"s_{i}", 2 * sp.sqrt(r.e) / (r.e + 1))
        c, s = stages.keep(f"c_{i}", sp.cos(turn)), stages.keep(f"n_{i}", sp.sin(turn))
        e_rate, round_ = stages.keep(f"x_{i}", sech * r.t * r.u_v), stages.keep(f"y_{i}", sech * r.alpha_v)
        axes += [r.t, -sech * s, sech * c]
        rates += [sech**2 * r.u_v, e_rate * s - round_ * c, -e_rate * c - round_ * s]
    return Program((*MINIMAL.q, *MINIMAL.v, k), tuple(stages), (*axes, *rates))


def _curve(stages: _Stages, ratio: Ratio) -> _Curve:
    """Return the curve of the bar (`pair.lagrangians.bar_curve`): rho w' = sin(Delta) Delta', rho' = −cos(Delta) w'."""
    unity = sp.Integer(1)
    if ratio == "short":
        # sin Delta = k sin chi: rho / cos Delta = Delta', so w' = tan Delta.
        # 1 − S² would lose digits at the fold of a bar almost as long as the axes.
        stages += [(_S, k * sp.sin(_CHI)), (_RHO, k * sp.cos(_CHI)), (_C, sp.sqrt(_RHO**2 + (1 - k) * (1 + k)))]
        stages += [(_D, sp.asin(_S))]
        stages += [(_D1, _RHO / _C), (_W1, _S / _C), (_DROP, (_C + _RHO) / (k + 1))]
        return _Curve(_D1, _W1 * (_D1**2 - 1), _W1, _D1 / _C**2, stages.keep("N", _D1**2 + _W1**2))
    stages += [(_D, _CHI), (_S, sp.sin(_CHI)), (_C, sp.cos(_CHI))]
    if ratio == "equal":
        stages += [(_W1, _S / _C), (_DROP, _C)]
        return _Curve(unity, 0 * unity, _W1, _C**-2, _C**-2)
    stages += [(_RHO, sp.sqrt(_C**2 + (k - 1) * (k + 1))), (_W1, _S / _RHO), (_DROP, (_C + _RHO) / (k + 1))]
    square = stages.keep("N", 1 + _W1**2)
    return _Curve(unity, 0 * unity, _W1, _C * square / _RHO, square)


def _rotors(stages: _Stages, curve: _Curve, ratio: Ratio, body: int) -> list[_Rotor]:
    """Return the quantities of both rotors from U, chi, alpha: u_i = U ± w/2 and alpha_i = alpha ∓ Delta/2."""
    # For ell = R the logarithm also excludes chi above a right angle, where there is no state.
    e_1 = sp.exp(2 * _U - stages.keep("falling", sp.log(_C))) if ratio == "equal" else sp.exp(2 * _U) / _DROP
    e_1 = stages.keep("e_1", e_1)
    rotors = []
    for i, (e, G, sign) in enumerate(((e_1, G_1, 1), (e_1 * _DROP**2, G_2, -1)), start=1):
        e = stages.keep(f"e_{i}", e) if i == 2 else e
        t = stages.keep(f"t_{i}", (e - 1) / (e + 1))
        u_v = stages.keep(f"u_{i}_v", _U_V + sign * curve.W1 * _CHI_V / 2)
        alpha_v = stages.keep(f"al_{i}_v", _ALPHA_V - sign * curve.D1 * _CHI_V / 2)
        force: _Pair = (sp.Integer(0), sp.Integer(0))
        if body == i:
            turn, (x, y, z) = _ALPHA - sign * _D / 2, FORCE
            c, s, sech = sp.cos(turn), sp.sin(turn), 2 * sp.sqrt(e) / (e + 1)
            force = (sech * x + t * (y * s - z * c)) / a, -(y * c + z * s) / a
        rotors.append(_Rotor(e, t, u_v, alpha_v, G / a, force))
    return rotors


def _massless(stages: _Stages, rotors: list[_Rotor], curve: _Curve) -> tuple[sp.Expr, ...]:
    """Return the accelerations for a massless bar.

    With g = G/a, each rotor alone has u'' = tanh u (u'² − alpha'²) + g alpha' and alpha'' = u' (2 alpha' tanh u − g). Its
    inertia is a sech² u in both coordinates. The force of the bar is normal to its curve, so that chi'' does not change. The
    force enters the means U'' and alpha'' with half the difference of 1/sech² u_i, where sech² u_1 : sech² u_2 = (1 + exp 2
    u_2)² : (1 + exp 2 u_1)² exp(−2 w).
    """
    (D1, D2, W1, W2, square), free = curve, []
    for i, (e, t, u_v, al_v, g, force) in enumerate(rotors, start=1):
        u_sum, round_ = t * (u_v - al_v) * (u_v + al_v) + g * al_v, u_v * (2 * t * al_v - g)
        if force != (0, 0):
            sech = 2 * sp.sqrt(e) / (e + 1)
            u_sum, round_ = u_sum + force[0] / sech, round_ + force[1] / sech
        free.append((stages.keep(f"f_{i}", u_sum), stages.keep(f"h_{i}", round_)))
    (f_1, h_1), (f_2, h_2) = free
    twist = stages.keep("twist", h_2 - h_1)
    # Across the curve, D1 (u_1'' − u_2'') − W1 (alpha_2'' − alpha_1'') = (D1 W2 − W1 D2) chi'².
    pull = stages.keep("pull", (D1 * W2 - W1 * D2) * _CHI_V**2 / square + (W1 * twist - D1 * (f_1 - f_2)) / square)
    wide = [stages.keep("wide_1", (rotors[0].e + 1) * _DROP), stages.keep("wide_2", rotors[1].e + 1)]
    share = stages.keep("share", pull * (wide[0] ** 2 - wide[1] ** 2) / (wide[0] ** 2 + wide[1] ** 2))
    u_sum, round_ = stages.keep("along", f_1 + f_2 + share * D1), stages.keep("round", h_1 + h_2 + share * W1)
    if D1 == 1:
        return u_sum / 2, twist - W1 * pull, round_ / 2
    twisted = (D1 * (twist - D2 * _CHI_V**2) + W1 * (f_1 - f_2 - W2 * _CHI_V**2)) / square
    return u_sum / 2, twisted, round_ / 2


def _massive(stages: _Stages, rotors: list[_Rotor], curve: _Curve) -> tuple[sp.Expr, ...]:
    """Return the accelerations for a massive bar.

    In units of a, with m_i = sech² u_i and p = b/a sech u_1 sech u_2 [e(1), f(1)]ᵀ [e(2), f(2)], the Mercator mass matrix is
    [[m_1, p], [pᵀ, m_2]]. The columns (1, 0, 1, 0), (w', −Delta', −w', Delta')/2 and (0, 1, 0, 1) transform it to (U, chi,
    alpha).
    """
    (D1, D2, W1, W2, square), keep, beta = curve, stages.keep, stages.keep("beta", b / a)
    t_1, t_2 = (r.t for r in rotors)
    s_1, s_2 = (keep(f"s_{i}", 2 * sp.sqrt(r.e) / (r.e + 1)) for i, r in enumerate(rotors, start=1))
    m_1, m_2, both = keep("m_1", s_1**2), keep("m_2", s_2**2), keep("both", beta * s_1 * s_2)
    shared = [[s_1 * s_2 + _C * t_1 * t_2, t_1 * _S], [-t_2 * _S, _C]]
    p = sp.Matrix(2, 2, lambda i, j: keep(f"p_{i}{j}", both * shared[i][j]))
    # The direction of the other axis in each frame, along which its centripetal term acts.
    toward_2 = sp.Matrix([s_1 * (s_1 * t_2 - _C * t_1 * s_2), s_1 * s_2 * _S])
    toward_1 = sp.Matrix([s_2 * (s_2 * t_1 - _C * t_2 * s_1), -s_1 * s_2 * _S])
    bend = sp.Matrix([W2, -D2]) * _CHI_V**2 / 2
    bent, spun, pulled = [], [], []
    for i, (r, m, sign) in enumerate(zip(rotors, (m_1, m_2), (1, -1), strict=True)):
        turning = sp.Matrix([r.t * (r.u_v - r.alpha_v) * (r.u_v + r.alpha_v), 2 * r.t * r.u_v * r.alpha_v])
        bent.append((turning - sign * bend).applyfunc(lambda e, i=i: keep(f"d_{i}{len(stages)}", e)))
        spun.append(m * (sp.Matrix([r.g * r.alpha_v, -r.g * r.u_v]) + bent[i]) + (s_1, s_2)[i] * sp.Matrix(r.force))
        pulled.append(keep(f"v_{i}", beta * m * (r.u_v**2 + r.alpha_v**2)))
    force_1 = (spun[0] + p * bent[1] + pulled[1] * toward_2).applyfunc(lambda e: keep(f"R_{len(stages)}", e))
    force_2 = (spun[1] + p.T * bent[0] + pulled[0] * toward_1).applyfunc(lambda e: keep(f"R_{len(stages)}", e))
    whole, gap = keep("sum", m_1 + m_2), keep("gap", m_1 - m_2)
    even, skew = keep("even", p[0, 1] + p[1, 0]), keep("skew", p[0, 1] - p[1, 0])
    by_u, by_alpha = (W1 * gap + D1 * skew) / 2, (W1 * skew - D1 * gap) / 2
    by_chi = (square * whole - 2 * (W1**2 * p[0, 0] + D1**2 * p[1, 1] - W1 * D1 * even)) / 4
    mass = sp.Matrix(
        [[whole + 2 * p[0, 0], even, by_u], [even, whole + 2 * p[1, 1], by_alpha], [by_u, by_alpha, by_chi]]
    )
    apart = (force_1 - force_2) / 2
    right = sp.Matrix([*(force_1 + force_2), W1 * apart[0] - D1 * apart[1]])
    solver_stages, (u_rate, round_, twisted) = solve_symmetric(mass, right, "m")
    stages += solver_stages
    return u_rate, twisted, round_
