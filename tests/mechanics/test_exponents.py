"""Characteristic exponents as a power series: a charge in a quartic well, whose exponents are known in closed form."""

import sympy as sp

from lagrotor.mechanics import characteristic_exponents, lindstedt_poincare

ORDER = 9


def charge(unknowns, frequency):
    """x'' = y' − x (x² + y²), y'' = −x' − y (x² + y²): a unit charge in a unit field, in the phase."""
    x, y = unknowns
    squared, well = frequency * frequency, x * x + y * y
    return [
        squared * x.derivative().derivative() - frequency * y.derivative() + x * well,
        squared * y.derivative().derivative() + frequency * x.derivative() + y * well,
    ]


def test_the_drift_of_the_guiding_centre() -> None:
    """A circle of radius e turns at w = (1 + sqrt(1 + 4 e²))/2, its neighbours at sqrt(1 + 6 e²) in its frame.

    So the centre drifts by sqrt(1 + 6 e²)/w − 1 per radian of phase: lambda² = −4 e⁴ + …
    """
    one, zero = sp.QQ.one, sp.QQ.zero
    orbit = lindstedt_poincare(charge, [zero, zero], [{1: one}, {-1: -one}], ORDER, sp.QQ)
    found = characteristic_exponents(charge, orbit, (False, True), (0, 1), ORDER - 1, sp.QQ)
    e = sp.Symbol("e", positive=True)
    exact = -((sp.sqrt(1 + 6 * e**2) / ((1 + sp.sqrt(1 + 4 * e**2)) / 2) - 1) ** 2)
    series = sp.series(exact, e, 0, ORDER).removeO()
    square = sum(sp.QQ.to_sympy(v) * e**n for (n, _), v in found.square.terms.items())
    assert sp.expand(series - square) == 0
    assert series.coeff(e, 4) == -4
    assert sp.expand(series - square.subs(e, 2 * e)) != 0  # twin


def test_p_and_q_solve_the_variational_equations() -> None:
    """By symmetry a shift along x drives one along y as the other way about, with the other sign: A = −B."""
    one, zero = sp.QQ.one, sp.QQ.zero
    orbit = lindstedt_poincare(charge, [zero, zero], [{1: one}, {-1: -one}], 5, sp.QQ)
    found = characteristic_exponents(charge, orbit, (False, True), (0, 1), 4, sp.QQ)
    assert (found.A + found.B).terms == {}
    assert found.p[0].harmonics(0) == {0: one} and found.q[1].harmonics(0) == {0: one}
