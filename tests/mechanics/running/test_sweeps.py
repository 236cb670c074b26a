"""Equations of long Lagrangians by sweeps: against sympy's derivatives, and against the recursion of the same bodies."""

import math
from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp

from benchmarks.mechanisms.chains import VALUES, chain, g, l, m
from lagrotor.errors import InputError
from lagrotor.mechanics import Coordinates, System, SystemRun, coordinates, motion_program, t
from lagrotor.mechanics.running.programs import equations_of_speeds
from lagrotor.numerics import operations


def rods(n: int, weight: sp.Expr = g) -> System:
    """n rods in relative angles, as one writes them."""
    c = coordinates([f"q_{i}" for i in range(n)])
    L = x = z = height = angle = turning = sp.S.Zero
    for q, v in zip(c.q, c.v, strict=True):
        angle, turning = angle + q, turning + v
        x, z = x + l * sp.cos(angle) * turning, z + l * sp.sin(angle) * turning
        height += l * sp.cos(angle)
        L += m * (x**2 + z**2) / 2 + m * weight * height
    return System(c, L)


@pytest.mark.parametrize("n", [6, 9])
def test_a_long_lagrangian_moves_as_its_bodies(n: int) -> None:
    system, bodies = rods(n), chain("rods", n)
    y = np.random.default_rng(n).uniform(-0.6, 0.6, 2 * n)
    known = np.array(bodies.rhs(VALUES)(0.0, y))
    np.testing.assert_allclose(system.rhs(VALUES)(0.0, y), known, atol=1e-10 * np.abs(known).max())
    assert equations_of_speeds(system)[0] and operations(motion_program(system).program) < 24 * n**2
    other = np.array(rods(n, g * sp.Rational(11, 10)).rhs(VALUES)(0.0, y))
    assert np.abs(other - known).max() > 1e-3  # the twin


def test_a_long_lagrangian_keeps_its_energy() -> None:
    y = np.random.default_rng(9).uniform(-0.6, 0.6, 18)
    run = rods(9).simulate(VALUES, y[:9], y[9:], np.linspace(0, 1, 3), 1e-9)
    assert np.ptp(run.energy) < 1e-7


def test_time_and_velocities_of_ones_own_are_swept() -> None:
    """A chain whose support is shaken, in the absolute rates of its rods."""
    n, base = 6, rods(6)
    shaken = base.L + m * l * sp.cos(t) * sum(sp.sin(q) * v for q, v in zip(base.c.q, base.c.v, strict=True))
    plain = System(base.c, shaken)
    u = sp.symbols(f"u:{n}", real=True)
    own = System(base.c, shaken, velocities={s: sum(base.c.v[: i + 1]) for i, s in enumerate(u)})
    y = np.random.default_rng(1).uniform(-0.6, 0.6, 2 * n)
    rates = np.array(plain.rhs(VALUES)(0.7, y))
    turned = np.array(own.rhs(VALUES)(0.7, np.concatenate([y[:n], np.cumsum(y[n:])])))
    np.testing.assert_allclose(turned[n:], np.cumsum(rates[n:]), atol=1e-10 * np.abs(rates).max())
    bent = sp.Matrix([sp.diff(shaken, v) for v in base.c.v])  # Lagrange's equations, by sympy, at the same state
    at = dict(zip((*base.c.q, *base.c.v, *base.c.a), (*y, *rates[n:]), strict=True)) | VALUES | {t: 0.7}
    moved = sum(
        (bent.diff(q) * v + bent.diff(v) * a for q, v, a in zip(base.c.q, base.c.v, base.c.a, strict=True)),
        bent.diff(t),
    )
    left = moved - sp.Matrix([sp.diff(shaken, q) for q in base.c.q])
    assert max(abs(float(e)) for e in left.xreplace(at)) < 1e-9


def long_potential(c: Coordinates) -> sp.Expr:
    """Some hundreds of operations."""
    x, y, z = c.q
    rng = np.random.default_rng(5)
    terms = []
    for _ in range(60):
        i, j, k = map(int, rng.integers(1, 7, 3))
        terms.append(sp.Rational(int(rng.integers(1, 9)), 7) * sp.sin(i * x + j * y) * sp.cos(k * z + j) / 30)
    return sp.Add(*terms)


@pytest.mark.parametrize(
    "L",
    [
        lambda T, V, x: -sp.sqrt(2 - T / 9 + V / 40),
        lambda T, V, x: -(1 + x**2) * (V - T),
        lambda T, V, x: T - V - sp.Piecewise((x**2, x > 0), (x**3, True)),
    ],
    ids=["a root below zero", "a product below zero", "cases"],
)
def test_a_long_lagrangian_of_any_form_has_the_equations_of_its_derivatives(L: Callable[..., sp.Expr]) -> None:
    c = coordinates("x y z")
    system = System(c, L(sum(v**2 for v in c.v) / 2, long_potential(c), c.q[0]))
    y = np.random.default_rng(2).uniform(-0.5, 0.5, 6)
    assert equations_of_speeds(system)[0], "it is swept"
    swept = np.array(system.rhs({})(0.0, y))
    M, h = (
        m.subs(dict(zip((*c.q, *c.v), map(sp.Float, y), strict=True))).evalf()
        for m in (system.mass_matrix, system.bias)
    )
    np.testing.assert_allclose(swept[3:], np.array((M.inv() * -h).tolist(), float).ravel(), rtol=1e-9)


def test_a_letter_named_as_a_stage_is_refused() -> None:
    c, own = coordinates("x y z"), sp.Symbol("_a0", real=True)
    with pytest.raises(InputError, match="_a0: generated programs use names like _a0"):
        System(c, sum(v**2 for v in c.v) / 2 - own * long_potential(c)).rhs({own: 1})


def test_a_lagrangian_whose_parts_are_shared_runs_though_it_cannot_be_written_out(tmp_path) -> None:
    """V = u_40(q) with u_{k+1} = sin u_k + cos u_k: 10¹² parts, 121 different ones."""
    c, k = coordinates("q"), sp.Symbol("k", positive=True)
    u = k * c.q[0]
    for _ in range(40):
        u = sp.sin(u) + sp.cos(u)
    system = System(c, c.v[0] ** 2 / 2 - u)

    def force(q: float) -> float:
        value, slope = 0.7 * q, 0.7
        for _ in range(40):
            value, slope = math.sin(value) + math.cos(value), slope * (math.cos(value) - math.sin(value))
        return -slope

    np.testing.assert_allclose(system.rhs({k: 0.7})(0.0, np.array([0.4, 0.1])), [0.1, force(0.4)], rtol=1e-12)
    run = system.simulate({k: 0.7}, (0.4,), (0.0,), [0, 0.5, 1.0])
    np.testing.assert_allclose(run.energy, run.energy[0], rtol=1e-8)
    again = SystemRun.load(run.save(tmp_path / "run.npz"), system)
    np.testing.assert_array_equal(again.q, run.q)
    with pytest.raises(InputError):
        SystemRun.load(tmp_path / "run.npz", System(c, c.v[0] ** 2 / 2 + u))
