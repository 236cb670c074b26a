"""The slim programs of rung 3 against the Lagrangian's own mass matrix and bias, eliminated by machine."""

from functools import lru_cache
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.mechanics import bias, mass_matrix
from lagrotor.models.programs.minimal_program import observation, program
from lagrotor.numerics import Program, compile_program, operations
from lagrotor.numerics.codegen import Stage, solve_symmetric
from lagrotor.pair import bar_curve, mercator_axis, mercator_lagrangian, minimal_embedding
from lagrotor.pair.notation import G_1, G_2, MERCATOR, MINIMAL, a, b, k

KINDS = [
    (massive, ratio, body) for massive in (False, True) for ratio in ("short", "equal", "long") for body in (0, 1, 2)
]
LENGTH = {"short": [0.8], "equal": [], "long": [1.3]}
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


def _curve(ratio: Any) -> list[Stage]:
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
def eliminated(massive: bool, ratio: Any, body: int) -> Program:
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


@pytest.mark.parametrize(
    ("massive", "ratio", "body"),
    # Each ratio with and without mass, no force and a force on either rotor; the other half is slow.
    [
        k if (k[0], k[2]) in ((True, 1), (False, 0), (False, 2)) else pytest.param(*k, marks=pytest.mark.slow)
        for k in KINDS
    ],
)
def test_the_slim_program_is_the_eliminated_one(massive: bool, ratio: Any, body: int) -> None:
    slim, full = program(massive, ratio, body), eliminated(massive, ratio, body)
    assert slim.arguments == full.arguments
    one, other = compile_program(slim), compile_program(full)
    draw = np.random.default_rng(body)
    for _ in range(20):
        state = [*draw.normal(0, 0.4, 3), *draw.normal(0, 2, 3)]
        parameters = [
            1.3,
            *([0.4] if massive else []),
            *LENGTH[ratio],
            10.0,
            -7.0,
            *(draw.normal(0, 3, 3) if body else []),
        ]
        values = [float(x) for x in (*state, *parameters)]
        assert one(*values) == pytest.approx(other(*values), rel=1e-11, abs=1e-11)


def test_a_changed_sign_is_seen() -> None:
    """Twin: the comparison above tells the program from one with a gyroscopic force turned round."""
    slim = program(True, "equal", 0)
    stages = tuple((s, e.subs(G_2, -G_2)) for s, e in slim.stages)
    values = [0.1, 0.2, -0.1, 1.0, 0.5, -0.4, 1.3, 0.4, 10.0, -7.0]
    wrong = compile_program(Program(slim.arguments, stages, slim.outputs))(*values)
    assert wrong != pytest.approx(compile_program(slim)(*values), rel=1e-3)


@pytest.mark.parametrize(("massive", "ratio", "body"), KINDS)
def test_slim_is_what_it_is_called(massive: bool, ratio: Any, body: int) -> None:
    assert operations(program(massive, ratio, body)) < 0.72 * operations(eliminated(massive, ratio, body))


@pytest.mark.parametrize("ratio", LENGTH)
def test_what_is_seen_is_the_embedding_and_its_derivative(ratio: Any) -> None:
    curve, draw = bar_curve(ratio), np.random.default_rng(3)
    embedding = minimal_embedding(curve.twist, curve.latitude)
    axes = [mercator_axis(u, alpha).subs(embedding) for u, alpha in (MERCATOR.q[:2], MERCATOR.q[2:])]
    rates = [r.jacobian(MINIMAL.q) * sp.Matrix(MINIMAL.v) for r in axes]
    expected = compile_program(Program((*MINIMAL.q, *MINIMAL.v, k), (), (*axes[0], *axes[1], *rates[0], *rates[1])))
    seen = compile_program(observation(ratio))
    for _ in range(10):
        values = [*draw.normal(0, 0.5, 6).tolist(), *(LENGTH[ratio] or [1.0])]
        assert seen(*values) == pytest.approx(expected(*values), rel=1e-12, abs=1e-13)
    # Twin: the other rotor is not this one.
    assert seen(*values)[:3] != pytest.approx(expected(*values)[3:6], rel=1e-3)
