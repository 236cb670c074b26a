"""The paired precession: series against exact orbits of bars not used elsewhere, family, multipliers, momentum."""

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Rotor, Scene, natural_rate
from lagrotor.errors import DomainError, InputError
from lagrotor.models.orbits.continuation import orbit_family, trace_family
from lagrotor.models.orbits.floquet import floquet
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.orbits.variational import flow
from lagrotor.models.simulate import simulate
from lagrotor.numerics.convergence import measured_order
from lagrotor.theory.paired_precession.closed_forms import leading_square, most_growth, paired_momentum
from lagrotor.theory.paired_precession.series import paired_series

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
    form = paired_momentum(4, sp.Rational(5, 9), sp.Rational(13, 10))
    scene = scene_of(*BARS["sigma 5/9, k 1.3"])
    off = []
    for r in (0.05, 0.1, 0.2):
        run = simulate(exact_orbit(scene, r).scene, np.array([0.0, 0.3]), "minimal", 1e-13)
        off.append(abs(float(form(r, 5 / 9, 1.3)) - run.joint_line_momentum[1] / 10))
    assert measured_order((0.05, 0.1, 0.2), off) == pytest.approx(6, abs=0.3)


def test_slope_of_the_flow_is_the_derivative():
    scene = scene_of(*BARS["sigma 7/5, k 0.8"])
    through, state = flow(scene), np.array([0.1, 0.2, 0.3, -0.4, 0.5, 0.2])
    slope = through(state, 0.7).slope
    step = 1e-5 * np.eye(6)
    differences = np.column_stack([(through(state + s, 0.7).end - through(state - s, 0.7).end) / 2e-5 for s in step])
    assert np.abs(slope - differences).max() < 1e-7


@pytest.mark.parametrize(
    ("link", "kind", "amplitude"),
    [
        (Link(1, 0, 0), "hyperbolic", 0.15),
        (Link(1.3, 0.1, 0.2), "hyperbolic", 0.08),
        (Link(1, 0.8, 0.1), "elliptic", 0.08),
    ],
)
def test_multipliers(link, kind, amplitude):
    scene = Scene(spins=(10, -10), link=link)
    found = floquet(scene, amplitude)
    assert found.kind == kind
    assert np.prod(found.multipliers).real == pytest.approx(1, abs=1e-10)
    assert np.linalg.det(found.monodromy) == pytest.approx(1, abs=1e-8)
    a, b = scene.inertias
    square = leading_square(amplitude, (a + b) / (a - b), link.length)
    measured = (found.growth**2 - found.turning**2) / (4 * np.pi**2)
    assert measured == pytest.approx(square, rel=0.1)


@pytest.mark.parametrize("link", [
    Link(1), Link(0.6), Link(1.6), Link(1, 1, 1), Link(1, 0.01, 0.1), Link(1.3, 0.5, 0.2), Link(1, 1, 0.3), Link(1, 1, 0.2),
    Link(0.7, 1, 0.02), Link(1, 0.1, 0.02),
])  # fmt: skip
def test_no_orbit_grows_faster_than_both_laws_together(link):
    scene, bounded = Scene(spins=(10, -10), link=link), []
    a, b = scene.inertias
    for amplitude in (0.2, 0.5):
        growth = floquet(scene, amplitude).growth / (2 * np.pi)
        bound = most_growth(amplitude, (a + b) / (a - b), link.length)
        assert growth <= bound
        bounded.append(growth > bound / 3)
    assert any(bounded)  # twin: a third of the bound is none


def test_elliptic_turns_hyperbolic_where_the_leading_terms_balance():
    scene = Scene(spins=(10, -10), link=Link(1, 0.02, 0))
    a, b = scene.inertias
    shape = (a + b) / (a - b)
    edge = shape * np.sqrt(2 * (shape - 1) / 3)
    assert floquet(scene, 0.93 * edge).kind == "elliptic"
    assert floquet(scene, 1.03 * edge).kind == "hyperbolic"


def test_family_agrees_with_shooting():
    scene = Scene(spins=(10, -10), link=Link(1, 0.01, 0.1))
    family = orbit_family(scene, [0.1, 0.4])
    for i, r0 in enumerate((0.1, 0.4)):
        assert family.frequencies[i] == pytest.approx(exact_orbit(scene, r0).frequency, rel=1e-10)
    end = simulate(family.orbit(1).scene, np.array([2 * np.pi / family.frequencies[1]]), "minimal", 1e-13)
    assert np.abs(end.axes[:, 0] - np.array(family.orbit(1).scene.axes)).max() < 1e-9


def test_refused():
    with pytest.raises(InputError, match="opposite"):
        orbit_family(Scene(spins=(10, 10)), [0.1])
    with pytest.raises(DomainError, match="increase"):
        orbit_family(Scene(spins=(10, -10)), [0.3, 0.2])


@pytest.mark.slow
@pytest.mark.parametrize("link", [Link(1, 0, 0), Link(0.6, 0, 0), Link(1.6, 0, 0)])
def test_family_reaches_the_joint_line_without_a_turn(link):
    family = trace_family(Scene(spins=(10, -10), link=link))
    assert family.turns == ()
    assert family.amplitudes[-1] > 0.98
    falls = np.diff(family.frequencies) < 0
    # A long bar's frequency only rises; the others fall to a least value and rise from there.
    assert falls.any() != (link.length > 1)
    assert not falls[-1]
    assert (np.diff(falls.astype(int)) != 0).sum() == (0 if link.length > 1 else 1)
