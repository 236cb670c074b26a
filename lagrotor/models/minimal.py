"""Rung 3: the bar eliminated. Three free coordinates (U, chi, alpha), no constraint, nothing that can drift.

Exact for any bar and any k = ell / R. Singular only where an axis lies along the joint line.
"""

from collections.abc import Callable
from functools import lru_cache
from math import asin, atan2, atanh, cosh, hypot, sin, sinh
from typing import Any, Literal

import numpy as np
import sympy as sp

from ..errors import SingularError
from ..mechanics import bias, mass_matrix
from ..numerics.codegen import Program, Stage, compile_program, solve_symmetric
from ..numerics.rates import rate_factory
from ..numerics.solve import Rate
from ..rotors.lagrangians import bar_curve, mercator_axis, mercator_lagrangian, minimal_embedding
from ..rotors.parameters import Scene
from ..symbols import G_1, G_2, MERCATOR, MINIMAL, a, b, k
from .model import Array, Model, Observed, constant_momenta, python_rate

Ratio = Literal["short", "equal", "long"]
FORCE = sp.symbols("F_x F_y F_z", real=True)
# tanh and sech of u_i; Delta, its cosine and sine; w and rho of the bar's curve; first and second derivatives by chi.
_T1, _T2, _S1, _S2 = sp.symbols("t_1 t_2 s_1 s_2", real=True)
_D, _C, _S, _W, _RHO = sp.symbols("D c_D s_D w rho", real=True)
_D1, _D2, _W1, _W2 = sp.symbols("D_1 D_2 w_1 w_2", real=True)


def _named(expression: sp.Expr) -> sp.Expr:
    """The Mercator functions by name, with tanh² = 1 − sech²."""
    u1, al1, u2, al2 = MERCATOR.q
    by_name: dict[sp.Expr, sp.Expr] = {
        sp.cos(al1 - al2): _C, sp.cos(al2 - al1): _C, sp.sin(al1 - al2): -_S, sp.sin(al2 - al1): _S,
    }  # fmt: skip
    for u, t, s in ((u1, _T1, _S1), (u2, _T2, _S2)):
        by_name |= {sp.tanh(u): t, sp.cosh(u): 1 / s, sp.sinh(u): t / s}
    return sp.expand(expression.xreplace(by_name)).subs({_T1**2: 1 - _S1**2, _T2**2: 1 - _S2**2})


def _curve(ratio: Ratio) -> list[Stage]:
    """The bar's curve and its derivatives by chi, from rho w' = sin(Delta) Delta', rho' = −cos(Delta) w'."""
    chi, one = MINIMAL.q[1], sp.Integer(1)
    curve = bar_curve(ratio)
    if ratio == "short":
        # sin Delta = k sin chi: rho / cos Delta = Delta', so w' = tan Delta.
        twist = [(_S, k * sp.sin(chi)), (_C, sp.sqrt(1 - _S**2)), (_D, sp.asin(_S)), (_RHO, curve.rho)]
        first = [(_D1, _RHO / _C), (_W1, _S / _C), (_D2, _W1 * (_D1**2 - 1)), (_W2, _D1 / _C**2)]
        return [*twist, (_W, sp.log((k + 1) / (_C + _RHO))), *first]
    rho = _C if ratio == "equal" else sp.sqrt(_C**2 + k**2 - 1)
    latitude = -sp.log(_C) if ratio == "equal" else sp.log((k + 1) / (_C + _RHO))
    twist = [(_D, chi), (_S, sp.sin(chi)), (_C, sp.cos(chi)), (_RHO, rho), (_W, latitude)]
    return [*twist, (_D1, one), (_D2, 0 * one), (_W1, _S / _RHO), (_W2, _C * (1 + _W1**2) / _RHO)]


@lru_cache(maxsize=32)
def program(massive: bool, ratio: Ratio, body: int) -> Program:
    """(U, chi, alpha, rates; a[, b][, k], G_1, G_2[, F]) → rates of the six; `body` 0: no force.

    By elimination; for the massless bar as long as the rotors, with one multiplier, which takes half the operations.
    """
    return _slim(body) if ratio == "equal" and not massive else eliminated(massive, ratio, body)


def _slim(body: int) -> Program:
    """Massless bar, ell = R: each rotor alone has, with g = G/a,

        u'' = tanh u (u'² − alpha'²) + g alpha',   alpha'' = u' (2 alpha' tanh u − g),

    and inertia a sech² u in both; one multiplier keeps u_1 − u_2 = −ln cos(alpha_2 − alpha_1), where w'' = 1 + w'².
    """
    (U, chi, alpha), (U_v, chi_v, alpha_v) = MINIMAL.q, MINIMAL.v
    E1, w, shared, twist = sp.symbols("E_1 w share twist", real=True)
    stages: list[Stage] = [(_C, sp.cos(chi)), (_W1, sp.sin(chi) / _C), (w, -sp.log(_C)), (E1, sp.exp(2 * U + w))]
    own, widths = [], []
    for i, (E, G, sign) in enumerate(((E1, G_1, 1), (E1 * _C**2, G_2, -1))):
        t, s, u_v, al_v, square, g = sp.symbols(f"t_{i} s_{i} u_{i}_v al_{i}_v e_{i} g_{i}", real=True)
        stages += [(square, E), (t, (square - 1) / (square + 1)), (s, 4 * square / (square + 1) ** 2), (g, G / a)]
        stages += [(u_v, U_v + sign * _W1 * chi_v / 2), (al_v, alpha_v - sign * chi_v / 2)]
        along, round_ = t * (u_v**2 - al_v**2) + g * al_v, u_v * (2 * t * al_v - g)
        if body == i + 1:
            root, turn, (x, y, z) = sp.sqrt(s), alpha - sign * chi / 2, FORCE
            along += x / a + t * (y * sp.sin(turn) - z * sp.cos(turn)) / (a * root)
            round_ -= (y * sp.cos(turn) + z * sp.sin(turn)) / (a * root)
        forces = sp.symbols(f"f_{i} h_{i}", real=True)
        stages += list(zip(forces, (along, round_), strict=True))
        own.append(forces)
        widths.append(s)
    (along_1, round_1), (along_2, round_2) = own
    stages += [(twist, round_2 - round_1)]
    lam = sp.Symbol("lam", real=True)
    stages += [(lam, chi_v**2 + (_W1 * twist - along_1 + along_2) / (1 + _W1**2))]
    # The multiplier moves rotor i by 1/s_i: half the difference of the two is left in the means.
    stages += [(shared, lam * (widths[1] - widths[0]) / (2 * (widths[0] + widths[1])))]
    means = (along_1 + along_2) / 2 + shared, (round_1 + round_2) / 2 + shared * _W1
    accelerations = means[0], twist - _W1 * lam, means[1]
    parameters = (a, G_1, G_2, *(FORCE if body else ()))
    return Program((*MINIMAL.q, *MINIMAL.v, *parameters), tuple(stages), (*MINIMAL.v, *accelerations))


@lru_cache(maxsize=32)
def eliminated(massive: bool, ratio: Ratio, body: int) -> Program:
    """(U, chi, alpha, rates; a[, b][, k], G_1, G_2[, F]) → rates of the six; `body` 0: no force.

    Mass matrix and bias of the Mercator Lagrangian, embedded by q₄ = e(q):  M = Eᵀ M₄ E,  h = Eᵀ (h₄ + M₄ E' v).
    """
    chi_v = MINIMAL.v[1]
    u1, al1, u2, al2 = MERCATOR.q
    lagrangian = mercator_lagrangian() if massive else mercator_lagrangian().subs(b, 0)
    mass4 = mass_matrix(lagrangian, MERCATOR).applyfunc(_named)
    bias4 = bias(lagrangian, MERCATOR).applyfunc(_named)

    lowest = _curve(ratio)
    trivial = {s: e for s, e in lowest if e.is_Number}
    embedding = minimal_embedding(_D, _W)
    by_chi, twice = {_D: _D1, _W: _W1}, {_D: _D2, _W: _W2}
    q4 = [embedding[q] for q in MERCATOR.q]
    E = sp.Matrix(
        [[e.diff(MINIMAL.q[0]), sum(e.diff(s) * d for s, d in by_chi.items()), e.diff(MINIMAL.q[2])] for e in q4]
    )
    Ev = sp.Matrix([sum(e.diff(s) * d for s, d in twice.items()) * chi_v**2 for e in q4])
    E, Ev = E.subs(trivial), Ev.subs(trivial)
    for u, t, s in ((u1, _T1, _S1), (u2, _T2, _S2)):
        lowest += [(t, sp.tanh(embedding[u])), (s, 1 / sp.cosh(embedding[u]))]
    lowest += list(zip(MERCATOR.v, E * sp.Matrix(MINIMAL.v), strict=True))

    force4 = sp.zeros(4, 1)
    if body:
        u, alpha = ((u1, al1), (u2, al2))[body - 1]
        tip = mercator_axis(u, alpha)
        force4[2 * body - 2] = sp.Matrix(FORCE).dot(tip.diff(u))
        force4[2 * body - 1] = sp.Matrix(FORCE).dot(tip.diff(alpha))
        force4 = force4.applyfunc(_named)
        lowest.append((alpha, embedding[alpha]))
    stages, acceleration = solve_symmetric(E.T * mass4 * E, E.T * (force4 - bias4 - mass4 * Ev), "m")
    parameters = (
        a,
        *((b,) if massive else ()),
        *(() if ratio == "equal" else (k,)),
        G_1,
        G_2,
        *(FORCE if body else ()),
    )
    return Program((*MINIMAL.q, *MINIMAL.v, *parameters), (*lowest, *stages), (*MINIMAL.v, *acceleration))


@lru_cache(maxsize=32)
def _factory(massive: bool, ratio: Ratio, body: int) -> Callable[..., Rate]:
    return rate_factory(program(massive, ratio, body), 6)


@lru_cache(maxsize=32)
def _compiled(massive: bool, ratio: Ratio, body: int) -> Any:
    return compile_program(program(massive, ratio, body))


def _ratio(scene: Scene) -> tuple[float, Ratio]:
    if scene.link is None:
        raise SingularError("minimal: the scene has no bar to eliminate; use model='spheres'")
    value = scene.link.length / scene.rotor.length
    return value, "equal" if value == 1 else "short" if value < 1 else "long"


def _terms(scene: Scene, pulsed: bool) -> tuple[tuple[bool, Ratio, int], tuple[float, ...]]:
    """What picks the scene's program, and the values of its parameters but for the force."""
    inertia_a, inertia_b = scene.inertias
    value, ratio = _ratio(scene)
    massive = inertia_b != 0
    body = scene.shock.body if pulsed and scene.shock else 0
    parameters = (
        inertia_a,
        *((inertia_b,) if massive else ()),
        *(() if ratio == "equal" else (value,)),
        *scene.momenta,
    )
    return (massive, ratio, body), parameters


def _rate(scene: Scene, pulsed: bool) -> Rate:
    picked, parameters = _terms(scene, pulsed)
    if not pulsed:
        return _factory(*picked)(*parameters)
    return python_rate(scene, _compiled(*picked), parameters, pulsed)


def generated(scene: Scene, pulsed: bool) -> tuple[Program, tuple[float, ...]]:
    """The scene's program, for a solver that takes expressions, and the values of its parameters but for the force."""
    picked, parameters = _terms(scene, pulsed)
    return program(*picked), parameters


def _start(scene: Scene) -> Array:
    value, ratio = _ratio(scene)
    u, alpha, u_v, alpha_v = [], [], [], []
    for i, (r, v) in enumerate(zip(scene.axes, scene.rates, strict=True)):
        radius = hypot(r[1], r[2])
        if radius < 1e-6:
            raise SingularError(f"minimal: axis {i + 1} lies along the joint line, r = {r}; use model='spheres'")
        u.append(atanh(r[0] / hypot(*r)))
        alpha.append(atan2(-r[1], r[2]))
        u_v.append(v[0] / radius**2)
        alpha_v.append((r[1] * v[2] - r[2] * v[1]) / radius**2)
    twist = (alpha[1] - alpha[0] + np.pi) % (2 * np.pi) - np.pi
    w, twist_v, w_v = u[0] - u[1], alpha_v[1] - alpha_v[0], u_v[0] - u_v[1]
    if ratio == "short":
        # Where the bar starts to fold over, Delta turns back while chi and w go on: take the rate from both.
        rho, c, s = value * cosh(w) - sinh(w), np.cos(twist), sin(twist)
        chi = atan2(s, rho)
        chi_v = (rho / c * twist_v + s / c * w_v) / ((rho**2 + s**2) / c**2)
    else:
        chi, chi_v = twist, twist_v
    Delta = asin(max(-1.0, min(1.0, value * sin(chi)))) if ratio == "short" else chi
    middle = [(u[0] + u[1]) / 2, chi, alpha[0] + Delta / 2]
    return np.array([*middle, (u_v[0] + u_v[1]) / 2, chi_v, (alpha_v[0] + alpha_v[1]) / 2])


@lru_cache(maxsize=3)
def _axes_function(ratio: Ratio) -> Any:
    """(U, chi, alpha, rates, k) → r_1, r_2, r_1', r_2' as twelve arrays."""
    curve = bar_curve(ratio)
    embedding = minimal_embedding(curve.twist, curve.latitude)
    outputs, velocities = [], []
    for u, alpha in (MERCATOR.q[:2], MERCATOR.q[2:]):
        r = mercator_axis(u, alpha).subs(embedding)
        outputs += list(r)
        velocities += list(r.jacobian(MINIMAL.q) * sp.Matrix(MINIMAL.v))
    return compile_program(Program((*MINIMAL.q, *MINIMAL.v, k), (), (*outputs, *velocities)), "numpy")


def _observe(scene: Scene, states: Array) -> Observed:
    value, ratio = _ratio(scene)
    columns = np.stack(_axes_function(ratio)(*states.T, value))
    parts = columns.reshape(2, 2, 3, -1).transpose(0, 1, 3, 2)
    return Observed(parts[0], parts[1], constant_momenta(scene, len(states)))


MODEL = Model("minimal", _start, _rate, _observe)
