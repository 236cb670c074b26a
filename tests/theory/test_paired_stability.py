"""Growth and turning of the paired precession's neighbours: the derived series against exact Floquet multipliers."""

from dataclasses import replace
from math import cosh, pi, sqrt

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, floquet
from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics.weakly_nonlinear import characteristic_exponents
from lagrotor.pair.notation import k, r0, sigma
from lagrotor.theory import elliptic_edge, exponent_series, growth_squared, paired_series
from lagrotor.theory.paired_precession import stability
from lagrotor.theory.paired_precession.series import equations, shape_of
from tests.theory.random_pairs import held

BARS = {"b = 0": Link(1), "b < 0": Link(1, 0.01, 0.1), "b > 0": Link(0.9, 0.8, 0.05), "edge": Link(1.3, 0.35, 0.11)}
SHOWN = [pytest.param(name, marks=pytest.mark.slow) if name == "b > 0" else name for name in BARS]


def pair_sum(series, amplitude: float) -> float:
    """mu + 1/mu = 2 cosh(2 pi lambda) from a series of lambda²."""
    A, B = (sum(float(v) * amplitude**n for (n, _), v in part.terms.items()) for part in (series.A, series.B))
    square = A * B
    return 2 * np.cosh(2 * pi * np.sqrt(complex(square))).real


@pytest.mark.parametrize("name", SHOWN)
def test_the_series_is_the_exact_multipliers_to_rounding(name: str) -> None:
    """Through r0^10 both agree at r0 = 0.05 and 0.08 to some 1e-13; through r0^4 they do not."""
    scene = Scene(spins=(10, -10), link=BARS[name])
    series = exponent_series(10, *shape_of(scene))
    for amplitude in (0.05, 0.08):
        found = floquet(scene, amplitude)
        assert abs(pair_sum(series, amplitude) - found.pair_sum) < found.error
        assert abs(found.pair_sum - 2) > 1000 * found.error
    fewer = exponent_series(4, *shape_of(scene))
    assert abs(pair_sum(fewer, 0.08) - floquet(scene, 0.08).pair_sum) > 1e-11


def test_the_leading_terms() -> None:
    assert sp.expand(growth_squared().expressions[0] - 3 * sigma**2 * (1 - sigma) * r0**6 / (16 * k**2)) == 0
    assert sp.expand(growth_squared(8, dumbbell=True).expressions[0] - 9 * r0**8 / (32 * k**4)) == 0
    with pytest.raises(InputError, match="at least 6"):
        growth_squared(4)


def test_another_equation_has_other_exponents() -> None:
    """Twin: without the tension of the bar nothing couples the two displacements in this way."""
    orbit = paired_series(4, sp.Rational(7, 5), sp.Integer(1))
    residual = equations(orbit.shape, orbit.ratio, orbit.field)

    def changed(unknowns, frequency):
        first, *others = residual(unknowns, frequency)
        return [first + unknowns[0] * unknowns[0] * unknowns[0], *others]

    sines = (False, True, False, False, False)
    found = [
        characteristic_exponents(r, orbit.solution, sines, (0, 1), 4, orbit.field, -1) for r in (residual, changed)
    ]
    assert found[0].A.terms == exponent_series(4, sp.Rational(7, 5), sp.Integer(1)).A.terms
    assert found[0].B.terms != found[1].B.terms


@pytest.mark.parametrize("name", SHOWN)
def test_the_law_tells_its_error(name: str) -> None:
    scene = Scene(spins=(10, -10), link=BARS[name])
    law = growth_squared(8, dumbbell=True) if name == "b = 0" else growth_squared()
    for amplitude in (0.08, 0.15):
        found = floquet(scene, amplitude)
        square = (found.growth**2 - found.turning**2) / (2 * pi) ** 2
        off = abs(float(law(amplitude, scene.sigma, scene.k)) - square)
        assert off < float(law.error(amplitude, scene.sigma, scene.k)) < 5 * off
    with pytest.raises(DomainError, match="does not converge"):
        law.error(0.8, scene.sigma, scene.k)


# sigma and r0 at k = 1, by bisection on exact multipliers.
EDGES = [
    (1.02, 0.11392),
    (1.2, 0.32220),
]


@pytest.mark.parametrize(("shape", "seen"), EDGES)
def test_elliptic_turns_hyperbolic_where_the_law_says_within_its_error(shape: float, seen: float) -> None:
    """K = 0 and m so that sigma is the given one; the edge between the two kinds is where the exact orbits have it."""
    scene = Scene(spins=(10, -10), link=Link(1, 2 * 1.25 * (shape - 1), 0))
    assert scene.sigma == pytest.approx(shape, rel=1e-12)
    law = elliptic_edge()
    edge, error = float(law(shape, 1.0)), float(law.error(shape, 1.0))
    assert abs(edge - seen) < error < 0.1 * edge
    assert [floquet(scene, seen + d).kind for d in (-0.0005, 0.0005)] == ["elliptic", "hyperbolic"]
    older = shape * sqrt(2 / 3 * (shape - 1))  # the balance of the leading terms
    assert abs(older - seen) > 2 * abs(edge - seen)


def test_far_from_a_dumbbell_the_edge_is_not_known() -> None:
    assert elliptic_edge().error(1.7, 1.0) == np.inf or elliptic_edge().error(1.7, 1.0) > 0.3


def random_bars(count: int):
    rng = np.random.default_rng(5)
    while count:
        length, mass = rng.uniform(0.5, 2), rng.choice([0.0, rng.uniform(0, 1.5)])
        scene = Scene(spins=(10, -10), link=Link(length, mass, mass * rng.uniform(0, 0.5)))
        if 0.4 < scene.sigma < 1.8:
            count -= 1
            yield scene, rng.uniform(0.1, 0.5)


@pytest.mark.parametrize("count", [12, pytest.param(40, marks=pytest.mark.slow)])
def test_no_orbit_grows_faster_than_both_laws_together(count: int) -> None:
    close = []
    for scene, amplitude in random_bars(count):
        growth = floquet(scene, amplitude).growth / (2 * pi)
        bound = stability.growth_bound(amplitude, scene.sigma, scene.k)
        assert growth <= bound, scene
        close.append(growth > bound / 2)
    assert any(close)  # twin: half the bound is none


def test_the_floquet_numbers_hold_together() -> None:
    found = floquet(Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)), 0.204)
    assert 2 * cosh(found.growth) == pytest.approx(found.pair_sum, rel=1e-14)
    assert 0 < found.exponent_error < 1e-9


def test_an_exponent_told_as_zero_may_be_the_root_of_twice_the_error() -> None:
    """Where the kind is unresolved, mu + 1/mu − 2 is below the error, and the true one below twice as much."""
    scene = Scene(spins=(10, -10), link=Link(0.86, 0.01, 0.002))
    found = floquet(scene, 0.001)
    turning = sqrt(0.999 * found.error)
    mu = np.array([1, 1, 1, 1, np.exp(1j * turning), np.exp(-1j * turning)])
    unresolved = replace(
        found, multipliers=mu, pair_sum=2 * np.cos(turning), kind="unresolved", growth=0.0, turning=0.0
    )
    assert unresolved.exponent_error >= sqrt(1.999 * found.error)
    assert replace(unresolved, kind="elliptic").exponent_error < 0.8 * unresolved.exponent_error  # twin: of a known one


def any_bar(rng):
    length, mass = np.exp(rng.uniform(-1.2, 1.2)), rng.choice([0.0, np.exp(rng.uniform(-4.6, 1.2))])
    return Scene(spins=(10, -10), link=Link(length, mass, mass * length**2 * rng.uniform(0, 0.6)))


def test_growth_and_turning_are_within_their_error() -> None:
    """Against the series through r0^20 where that is known better, down to amplitudes at which rounding hides the kind."""
    rng, pairs = np.random.default_rng(8), []
    for _ in range(2):
        scene = any_bar(rng)
        series = paired_series(20, *shape_of(scene), exact=False)
        A, B = stability._numbers(series, series.order)
        for amplitude in 10 ** rng.uniform(-2, -0.6, 10):
            square = np.polynomial.polynomial.polyval(amplitude, A) * np.polynomial.polynomial.polyval(amplitude, B)
            exact, found = 2 * pi * np.sqrt(complex(square)), floquet(scene, amplitude)
            if 2 * pi * sqrt(stability._square_rest(series, amplitude)) < found.exponent_error / 10:
                off = max(abs(found.growth - exact.real), abs(found.turning - exact.imag))
                pairs.append((off, 1.1 * found.exponent_error))
    assert len(pairs) > 16
    held(pairs, 0, len(pairs), 0)
    assert max(off / error for off, error in pairs) > 0.05  # twin: a twentieth of it is no bound
