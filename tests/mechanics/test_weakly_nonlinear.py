"""Lindstedt–Poincaré and averaging straight from a System: textbook series, and orders of convergence against exact runs."""

import numpy as np
import pytest
import sympy as sp
from sympy import Rational as Q

from lagrotor.mechanics import System, coordinates, t

C = coordinates("x")
(x,), (v,) = C.q, C.v
eps, m, g, l, sigma, A = sp.symbols("epsilon m g l sigma A", positive=True)
DUFFING = System(C, v**2 / 2 - x**2 / 2 - eps * x**4 / 4)
PENDULUM = System(C, m * l**2 * v**2 / 2 + m * g * l * sp.cos(x))
VAN_DER_POL = System(C, v**2 / 2 - x**2 / 2, forces=(eps * (1 - x**2) * v,))
MATHIEU = System(C, v**2 / 2 - (Q(1, 4) + eps * (sigma + sp.cos(t))) * x**2 / 2)


def test_series_of_textbooks() -> None:
    """Nayfeh & Mook, 2.3: Duffing; the elliptic integral of a pendulum; a force with x²."""
    duffing = DUFFING.lindstedt_poincare(order=3, small=eps)
    assert duffing.known_through == 3
    expected = 1 + Q(3, 8) * A**2 * eps - Q(21, 256) * A**4 * eps**2 + Q(81, 2048) * A**6 * eps**3
    assert sp.expand(duffing.frequency.removeO() - expected) == 0
    pendulum = PENDULUM.lindstedt_poincare(order=6, small=eps)
    expected = sp.sqrt(g / l) * (1 - eps**2 / 16 + eps**4 / 3072 - 23 * eps**6 / 737280)
    assert sp.expand(pendulum.frequency.removeO() - sp.expand(expected)) == 0
    skew = System(C, v**2 / 2 - x**2 / 2 - x**3 / 3).lindstedt_poincare(order=2, small=eps)
    assert skew.frequency.removeO() == 1 - Q(5, 12) * eps**2
    R, Omega = sp.symbols("R Omega", positive=True)
    hoop = System(C, m * R**2 * (v**2 + Omega**2 * sp.sin(x) ** 2) / 2 + m * g * R * sp.cos(x)).lindstedt_poincare(
        2, eps
    )
    nu = sp.sqrt(g / R - Omega**2)  # as a book writes it, without the mass: ν (1 − ε² (g − 4 Ω² R)/(16 ν² R))
    assert not hoop.frequency.has(m)
    assert sp.simplify(hoop.frequency.removeO() - nu + eps**2 * (g - 4 * Omega**2 * R) / (16 * nu * R)) == 0
    assert skew.motion.removeO().subs(sp.Symbol("Phi", real=True), 0).expand() == eps  # what the amplitude is


@pytest.mark.parametrize(
    ("series", "values", "ratio"),
    [
        (DUFFING.lindstedt_poincare(2, eps), {A: 1}, 8),
        (PENDULUM.lindstedt_poincare(2, eps), {g: 9.81, l: 0.7, m: 1}, 16),  # no odd orders
        (System(C, v**2 / 2 - x**2 / 2 - x**3 / 3).lindstedt_poincare(3, eps), {}, 16),
    ],
)
def test_the_error_of_a_frequency_falls_as_its_order_says(series, values, ratio) -> None:
    large, small = (series.error(values | {eps: e}) for e in (0.2, 0.1))
    assert large / small == pytest.approx(ratio, rel=0.25)


def test_other_equilibria_and_kinetic_energies() -> None:
    """A bead on a turning hoop about its tilted rest, against the period of exact runs."""
    hoop = System(C, v**2 / 2 + sp.sin(x) ** 2 / 2 + sp.cos(x) / 2)  # rest at cos x = 1/2
    about = hoop.lindstedt_poincare(4, eps, at=sp.pi / 3)
    large, small = (about.error({eps: e}) for e in (0.1, 0.05))
    assert large / small == pytest.approx(32, rel=0.25) and large < 2e-5
    rolled = System(C, (1 + x**2) * v**2 / 2 - x**2 / 2)  # v² x in the equation
    assert rolled.lindstedt_poincare(2, eps).frequency.removeO() == 1 - eps**2 / 4


def test_averaged_amplitudes_of_textbooks() -> None:
    """Van der Pol and Mathieu: Sanders, Verhulst & Murdock, 2.2, 2.9; Duffing to the second order: Nayfeh & Mook, 2.3."""
    r = sp.Symbol("r", positive=True)
    first = VAN_DER_POL.averaged(1, eps)
    assert [sp.expand(e) for e in first.polar] == [sp.expand(eps * r / 2 * (1 - r**2 / 4)), 0]
    second = VAN_DER_POL.averaged(2, eps)
    assert second.polar[1].subs(r, 2) == -(eps**2) / 16  # of its limit cycle, ω = 1 − ε²/16
    a, b = MATHIEU.averaged(1, eps).amplitudes
    assert [sp.expand(e) for e in MATHIEU.averaged(1, eps).rates] == [
        sp.expand(eps * b * (sigma - Q(1, 2))),
        sp.expand(-eps * a * (sigma + Q(1, 2))),
    ]  # it grows for |σ| < 1/2
    turned = DUFFING.averaged(2, eps).polar
    assert turned[0] == 0 and sp.expand(turned[1] - (3 * eps * r**2 / 8 - 51 * eps**2 * r**4 / 256)) == 0


@pytest.mark.parametrize(("system", "values"), [(VAN_DER_POL, {}), (MATHIEU, {sigma: 0.3})])
@pytest.mark.parametrize("order", [1, 2])
def test_the_error_of_an_averaged_motion_falls_as_its_order_says(system, values, order) -> None:
    slow = system.averaged(order, eps)
    errors = []
    for e in (0.04, 0.02):
        known, times = values | {eps: e}, np.linspace(0, 2 / e, 41)
        exact = system.simulate(known, (0.7,), (0.1,), times, 1e-10).q[:, 0]
        errors.append(np.abs(slow.run(known, 0.7, 0.1, times)[0] - exact).max())
    assert errors[0] / errors[1] == pytest.approx(2**order, rel=0.35)


def test_the_amplitudes_of_a_run_give_its_start() -> None:
    """By u₁ too; where the second order is no longer valid none are found, which is refused."""
    skew = System(C, v**2 / 2 - x**2 / 2 - eps * x**3 / 3).averaged(2, eps)
    for small in (0.04, 0.5):
        assert skew.run({eps: small}, 1, 0.3, [0, 1])[:, 0] == pytest.approx([1, 0.3], abs=1e-9)
