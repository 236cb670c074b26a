"""Brackets, first integrals in involution, canonical transformations, against textbooks and against the motion itself."""

from importlib import import_module

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics import System, coordinates, energy, t
from lagrotor.pair import bar_curve, mercator_lagrangian, minimal_embedding
from lagrotor.pair.notation import MERCATOR, MINIMAL
from tests.systems import g, k, kepler, m


def angular_momentum(h):
    return sp.Matrix(h.q).cross(sp.Matrix(h.p))


def test_kepler_has_its_brackets_and_integrals():
    h = kepler().hamiltonian()
    L, r = angular_momentum(h), sp.sqrt(sum(q**2 for q in h.q))
    assert h.bracket(h.q[0], h.p[0]) == 1 and h.bracket(h.q[0], h.p[1]) == 0
    assert sp.expand(h.bracket(L[0], L[1]) - L[2]) == 0
    A = sp.Matrix(h.p).cross(L) - m * k * sp.Matrix(h.q) / r  # Laplace, Runge & Lenz
    assert all(h.conserved(a).answer == "zero" for a in A)
    assert h.bracket(L.dot(L), L[2]) == 0 and h.conserved(h.p[0]).answer == "nonzero"


def test_the_rate_of_what_depends_on_time_has_its_derivative():
    c = coordinates("x")
    h = System(c, m * c.v[0] ** 2 / 2 - m * g * c.q[0]).hamiltonian()
    assert h.conserved(h.q[0] - h.p[0] * t / m - g * t**2 / 2).answer == "zero"
    assert h.rate(h.p[0]) == -m * g


def test_canonical_transformations_and_one_that_is_none():
    c = coordinates("x")
    h = System(c, m * c.v[0] ** 2 / 2 - k * c.q[0] ** 2 / 2).hamiltonian()
    (x,), (p,) = h.q, h.p
    w = sp.sqrt(k * m)
    assert h.canonical([sp.atan(w * x / p)], [p**2 / (2 * w) + w * x**2 / 2]).answer == "zero"  # angle and action
    assert h.canonical([p], [-x]).answer == "zero" and h.canonical([p], [x]).answer == "nonzero"
    assert h.canonical([2 * x], [p]).answer == "nonzero"


def test_it_moves_as_the_lagrangian_does():
    """Random states of a double pendulum: q' = ∂H/∂p and p' = −∂H/∂q by finite differences of a run of the system."""
    c = coordinates("a b")
    (a, b), (u, w) = c.q, c.v
    pair = System(c, u**2 + w**2 / 2 + u * w * sp.cos(a - b) + 2 * sp.cos(a) + sp.cos(b))
    h = pair.hamiltonian()
    rates = sp.lambdify((*h.q, *h.p), [h.rate(s) for s in (*h.q, *h.p)])
    momenta = sp.lambdify((*c.q, *c.v), list(sp.Matrix([pair.L]).jacobian(c.v)))
    rng = np.random.default_rng(3)
    for _ in range(3):
        q, v = rng.normal(size=(2, 2))
        run = pair.simulate({}, q, v, t=np.linspace(0, 2e-3, 3), tol=1e-12)
        state = np.array([[*run.q[k], *momenta(*run.q[k], *run.v[k])] for k in range(3)])
        assert (state[2] - state[0]) / 2e-3 == pytest.approx(rates(*state[1]), abs=1e-4)


def test_a_long_lagrangian_is_not_multiplied_out(monkeypatch: pytest.MonkeyPatch):
    """The pair in three coordinates, its bar longer than the axes; H is the energy at a random state. A top's H stays short."""
    curve = bar_curve("long")
    embedding = minimal_embedding(curve.twist, curve.latitude)
    pair = System(MERCATOR, mercator_lagrangian()).in_coordinates(MINIMAL, embedding)
    with monkeypatch.context() as without:
        without.setattr(import_module("sympy.simplify.simplify"), "dotprodsimp", None)  # which multiplies out
        h = pair.hamiltonian()
    numbers = {s: {"a": 1.2, "b": 0.3, "k": 1.7, "G_1": 2.1, "G_2": -1.6}.get(str(s)) for s in pair.L.free_symbols}
    at = {s: x for s, x in numbers.items() if x} | dict(
        zip((*MINIMAL.q, *MINIMAL.v), (0.2, 0.5, 0.9, 0.3, 0.7, 0.4), strict=True)
    )
    momenta = [sp.diff(pair.L, v).xreplace(at) for v in MINIMAL.v]
    energy_of_momenta = h.H.xreplace(at | dict(zip(h.p, momenta, strict=True)))
    assert float(energy_of_momenta) == pytest.approx(float(energy(pair.L, MINIMAL).xreplace(at)), rel=1e-9)

    c = coordinates("theta phi psi")
    theta, (theta_v, phi_v, psi_v) = c.q[0], c.v
    turning = (theta_v**2 + (phi_v * sp.sin(theta)) ** 2) / 2 + m * (psi_v + phi_v * sp.cos(theta)) ** 2 / 2
    assert sp.count_ops(System(c, turning - g * sp.cos(theta)).hamiltonian().H) < 60


def test_what_has_no_hamiltonian_is_refused():
    c = coordinates("x")
    for more in ({"dissipation": c.v[0] ** 2}, {"constraints": (c.q[0] - 1,)}):
        with pytest.raises(DomainError, match="no Hamiltonian"):
            System(c, c.v[0] ** 2 / 2, **more).hamiltonian()


def test_another_symbol_of_the_same_name_and_a_velocity_are_no_constants():
    """sympy's Symbol("p_x") is not the real p_x of H: as a constant it would be "conserved"."""
    c = coordinates("x")
    h = System(c, m * c.v[0] ** 2 / 2 - k * c.q[0] ** 2 / 2).hamiltonian()
    (x,), (p,) = h.q, h.p
    for wrong in (sp.Symbol("p_x"), sp.Symbol("x"), x * sp.Symbol("t"), c.v[0] ** 2):
        for ask in (h.conserved, h.rate, lambda f: h.bracket(x, f)):
            with pytest.raises(InputError, match=r"another symbol than|the velocity x_dot"):
                ask(wrong)
    assert h.conserved(m * k).answer == "zero" and h.conserved(p).answer == "nonzero"  # letters are constants
    with pytest.raises(InputError, match="k = nan is not finite"):
        h.normal_form(4, {x: 0}, {k: sp.nan, m: 1})
