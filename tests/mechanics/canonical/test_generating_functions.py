"""Canonical transformations from generating functions: textbook ones, Hamilton and Jacobi, and what generates nothing."""

import pytest
import sympy as sp

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import System, coordinates, t

m, k, g, a = sp.symbols("m k g a", positive=True)


def oscillator():
    c = coordinates("x")
    return System(c, m * c.v[0] ** 2 / 2 - k * c.q[0] ** 2 / 2).hamiltonian()


def plane():
    c = coordinates("x y")
    return System(c, m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - m * g * c.q[1]).hamiltonian()


def explicit(made):
    """Q and P of (q, p, t)."""
    (solution,) = sp.solve([p - of for p, of in zip(made.old, made.p_of, strict=True)], made.new, dict=True)
    return tuple(Q.subs(solution) for Q in made.Q_of), tuple(solution[P] for P in made.new)


def test_point_transformations_identity_and_shears_are_canonical() -> None:
    """Goldstein (9.20) ff: F = sum q P is the identity, F = f(q)·P a change of coordinates."""
    h = plane()
    (x, y), P = h.q, sp.symbols("P_1 P_2", real=True)
    assert explicit(h.generated(x * P[0] + y * P[1], P)) == ((x, y), h.p)
    shear = x * P[0] + y * P[1] + a * P[0] ** 2 * P[1] + x * y
    for F in (x**3 * P[0] / 3 + (x + y) * P[1], shear, (x + y) * P[0] + x * sp.exp(y) * P[1]):
        Q, new = explicit(h.generated(F, P))
        assert h.canonical(Q, new).answer == "zero"
        assert h.canonical([2 * Q[0], Q[1]], new).answer == "nonzero"  # twin


def test_hamiltons_principal_function_leaves_no_hamiltonian() -> None:
    """A body thrown up: K = 0, P and Q = ∂F/∂P are integrals. Arnold § 47; the twin has another factor."""
    c = coordinates("y")
    h = System(c, m * c.v[0] ** 2 / 2 - m * g * c.q[0]).hamiltonian()
    (y,), P = h.q, sp.Symbol("P", real=True)
    F = y * (P - m * g * t) - (P**2 * t - m * g * P * t**2 + m**2 * g**2 * t**3 / 3) / (2 * m)
    made = h.generated(F, [P])
    assert made.K == 0 and h.generated(F + P * t, [P]).K != 0
    (Q,), (new,) = explicit(made)
    assert h.conserved(Q).answer == h.conserved(new).answer == "zero" and h.canonical([Q], [new]).answer == "zero"


def test_what_generates_nothing_or_is_no_generating_function_is_refused() -> None:
    h = oscillator()
    (x,), (p,), P = h.q, h.p, sp.Symbol("P", real=True)
    with pytest.raises(SingularError, match="generates no transformation"):
        h.generated(x**2 + P**2, [P])
    with pytest.raises(InputError, match="function of q and P"):
        h.generated(x * P + p, [P])
    for bad in ([p], [x], [k], [x * P], [2]):
        with pytest.raises(InputError, match="symbols that H does not have"):
            h.generated(x * P, bad)
    for bad in ([P, P], [], P):
        with pytest.raises(InputError, match="generated: P"):
            h.generated(x * P, bad)
