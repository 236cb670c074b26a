"""The coefficients of the paired precession's series against exact orbits of bars not used elsewhere; its momentum."""

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Rotor, Scene, natural_rate, paired_momentum, simulate
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order
from lagrotor.theory import paired_series

# sigma = 5/9, 7/5 and 11/8, with k = 13/10, 4/5 and 1.
BARS = {
    "sigma 5/9, k 1.3": (sp.Rational(5, 9), sp.Rational(13, 10)),
    "sigma 7/5, k 0.8": (sp.Rational(7, 5), sp.Rational(4, 5)),
    "sigma 11/8, k 1": (sp.Rational(11, 8), sp.Integer(1)),
}


def scene_of(shape, ratio):
    """A scene whose bar has that sigma and k, with J = 5/4."""
    J, mass = sp.Rational(5, 4), sp.Rational(4, 5) if shape > 1 else sp.Rational(1, 10)
    half = mass / 4
    # sigma = (J + 2 half)/(J + 2 twist), twist = K/k².
    twist = ((J + 2 * half) / shape - J) / 2
    if twist < 0:
        half = (shape * J - J) / 2 + sp.Rational(1, 10)
        twist = ((J + 2 * half) / shape - J) / 2
    link = Link(float(ratio), float(4 * half), float(twist * ratio**2))
    return Scene(spins=(10, -10), rotor=Rotor(), link=link)


def harmonics(scene, r0, highest, samples=32):
    """Frequency ratio and the Fourier coefficients of x_1 (cos) and y_1 (sin), h = 0 … highest."""
    orbit = exact_orbit(scene, r0)
    phase = 2 * np.pi * np.arange(samples) / samples
    run = simulate(orbit.scene, phase / orbit.frequency, "minimal", 1e-13)
    x, y = (np.fft.rfft(run.axes[0, :, i]) / samples * 2 for i in (0, 1))
    x[0] /= 2
    return orbit.frequency / natural_rate(scene), x.real[: highest + 1], -y.imag[: highest + 1]


@pytest.mark.parametrize("name", BARS)
def test_coefficients_equal_those_fitted_to_exact_orbits(name):
    """Each harmonic is r0^n times a power series in r0²: the leading coefficients by Richardson's extrapolation."""
    shape, ratio = BARS[name]
    scene, series = scene_of(shape, ratio), paired_series(5, shape, ratio)
    sizes = np.array([0.04, 0.06, 0.08, 0.1, 0.12])
    found = [harmonics(scene, r, 3) for r in sizes]
    powers = np.vander(sizes**2, 5, increasing=True)

    def leading(values, power, count):
        return np.linalg.solve(powers, np.asarray(values) / sizes**power)[:count]

    rates = leading([f[0] for f in found], 0, 3)
    assert rates[1] == pytest.approx(float(series.frequency.terms[2, 0]), abs=2e-4)
    assert rates[2] == pytest.approx(float(series.frequency.terms[4, 0]), abs=0.05)
    scale = float(sp.sqrt(shape))
    for h, power in ((0, 2), (1, 1), (2, 2), (3, 3)):
        x = leading([f[1][h] for f in found], power, 2)
        expected = [float(series.x.terms.get((power + 2 * i, h), 0)) for i in range(2)]
        assert x[0] == pytest.approx(expected[0], abs=1e-4)
        assert x[1] == pytest.approx(expected[1], abs=2e-2)
        if h:
            y = leading([f[2][h] for f in found], power, 2)
            expected = [scale * float(series.Y.terms.get((power + 2 * i, -h), 0)) for i in range(2)]
            assert y[0] == pytest.approx(expected[0], abs=1e-4)
            assert y[1] == pytest.approx(expected[1], abs=2e-2)


@pytest.mark.parametrize("order", range(1, 10))
def test_errors_fall_with_the_order(order):
    """At a bar of sigma = 5/9, k = 1.3: the error of x through r0^n falls as r0^(n + 1), the next term not zero."""
    shape, ratio = BARS["sigma 5/9, k 1.3"]
    scene, series = scene_of(shape, ratio), paired_series(order, shape, ratio)
    sizes = (0.02, 0.03) if order < 4 else (0.06, 0.08) if order < 8 else (0.1, 0.13)
    errors = []
    for r in sizes:
        _, x, _ = harmonics(scene, r, 12)
        mine = np.zeros(13)
        for (n, h), value in series.x.terms.items():
            mine[h] += float(value) * r**n
        errors.append(np.abs(x - mine).max())
    assert measured_order(sizes, errors) == pytest.approx(order + 1, abs=0.1)


def test_momentum_is_constant_and_right():
    form = paired_momentum(4)
    scene = scene_of(*BARS["sigma 5/9, k 1.3"])
    off = []
    for r in (0.05, 0.1, 0.2):
        run = simulate(exact_orbit(scene, r).scene, np.array([0.0, 0.3]), "minimal", 1e-13)
        off.append(abs(float(form(r, 5 / 9, 1.3)) - run.joint_line_momentum[1] / 10))
    assert measured_order((0.05, 0.1, 0.2), off) == pytest.approx(6, abs=0.3)
