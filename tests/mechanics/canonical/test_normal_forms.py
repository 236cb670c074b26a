"""Normal forms against published coefficients, and as what they are: a canonical transformation and the same Hamiltonian."""

from math import sqrt

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics import NormalForm, System, coordinates, t
from lagrotor.mechanics.canonical.normal_forms import normal_form_of_series
from lagrotor.mechanics.canonical.polynomials import linear_form, poisson_bracket, polynomial
from tests.systems import henon_heiles, plane_motion

R = sp.Rational


def plane(V, magnetic=0):
    return plane_motion(V, magnetic).hamiltonian()


def check_transformation(n: NormalForm, H, x, at) -> None:
    """The bracket of the old coordinates is theirs through the order, and H in the new ones is the series."""
    new, half = [n.original(linear_form(row)) for row in n.vectors], len(n.frequencies)
    for a in range(2 * half):
        for b in range(a):
            bracket = poisson_bracket(new[a], new[b], n.weights, n.known_through - 2)
            want = 1.0 * (b == a - half) * -1
            bracket = bracket - polynomial({(0,) * (2 * half): want}, 2 * half) if want else bracket
            assert np.abs(bracket.coefficients).max(initial=0) < 1e-9
    generator = np.random.default_rng(1)
    z = generator.normal(size=half) + 1j * generator.normal(size=half)
    oscillate = n.weights != 1
    w = np.where(oscillate, z.conj(), z.imag)
    z = np.where(oscillate, z, z.real)
    value = sp.lambdify(x, H)
    gaps = []
    for eps in (0.02, 0.01):
        point = eps * np.concatenate([z, w])
        old = [complex(f.at(point)).real + float(at.get(s, 0)) for f, s in zip(new, x, strict=True)]
        gaps.append(abs(value(*old) - n.series.at(point)))
    scale = abs(n.series.at(0.02 * np.concatenate([z, w])))
    assert gaps[0] < 1e-12 * scale or np.log2(gaps[0] / gaps[1]) > n.known_through + 0.5


def test_henon_heiles_as_gustavson_printed_it():
    """Gustavson 1966, Braun 1973: −5/12 I² + 7/12 L² at order 4, with I = I₁ + I₂ and L² = (2 Im z₁ w₂)²."""
    n = henon_heiles().hamiltonian().normal_form(order=6, at={"x": 0, "y": 0})
    assert n.frequencies == (1, 1) and n.energy_signs == (1, 1) and n.error == 0
    assert {e: n.actions[e] for e in ((2, 0), (0, 2), (1, 1))} == {
        (2, 0): R(-5, 12),
        (0, 2): R(-5, 12),
        (1, 1): R(1, 3),
    }
    assert n.resonances[2, 0, 0, 2] == n.resonances[0, 2, 2, 0] == R(-7, 12)
    # Of order 6 the invariants of the threefold symmetry: −235/432 I³ − 47/16 I L² + a cos 3φ, odd under y → −y in no term.
    assert n.actions[0, 3] == R(-235, 432) and sum(e[0] == 3 for e in n.actions) == 1


KINDS = {
    "oscillations": (lambda x, y: 0.5 * x**2 + 2 * y**2 + x * y**2 / 3 - x**3 / 5 + x**2 * y**2, 0, (1, 1)),
    "magnetic": (
        lambda x, y: -(x**2) / 2 - y**2 + x**2 * y + x**4,
        2.1,
        (-1, 1),
    ),  # slow, of negative energy, on a hill
    "free": (lambda x, y: y**2 * 0.81 + x**2 * y + y**3, 0, (1, 0)),
    "saddle": (lambda x, y: -(x**2) / 2 + y**2 * 0.81 + x**2 * y + y**3, 0, (1, 0)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_a_canonical_transformation_and_the_same_hamiltonian(kind):
    V, magnetic, signs = KINDS[kind]
    h = plane(V, magnetic)
    n = h.normal_form(order=5, at={"x": 0, "y": 0})
    assert n.error < 1e-12 and sorted(n.energy_signs) == sorted(signs)
    if kind != "saddle":
        check_transformation(n, h.H, (*h.q, *h.p), {})
        twin = type(n)(**{**vars(n), "generators": (n.generators[0].times(2), *n.generators[1:])})
        with pytest.raises(AssertionError):
            check_transformation(twin, h.H, (*h.q, *h.p), {})


def test_pendulum_and_duffing_by_their_action():
    """H(I) of the pendulum: Jacobi's ω (I − I²/16 − I³/256 − 5 I⁴/8192 − …); of Duffing's, 3 α I²/(2 ω²) − 17 α² I³/(4 ω⁵)."""
    c = coordinates("x")
    (x,), (v,) = c.q, c.v
    n = System(c, v**2 / 2 + sp.cos(x)).hamiltonian().normal_form(order=10, at={x: 0})
    wanted = {(0,): -1, (1,): 1, (2,): R(-1, 16), (3,): R(-1, 256), (4,): R(-5, 8192), (5,): R(-33, 262144)}
    assert n.actions == wanted and not n.resonances
    omega, alpha = sp.symbols("omega alpha", positive=True)
    h = System(c, v**2 / 2 - omega**2 * x**2 / 2 - alpha * x**4).hamiltonian()
    n = h.normal_form(order=6, at={x: 0})
    assert n.actions == {(1,): omega, (2,): 3 * alpha / (2 * omega**2), (3,): -17 * alpha**2 / (4 * omega**5)}
    assert n.frequencies_at([R(1, 2)])[0] == omega + 3 * alpha / (2 * omega**2) - 51 * alpha**2 / (16 * omega**5)


def lagrange_point(mu):
    """The restricted problem of three bodies about L4, in coordinates that turn, with masses 1 − mu and mu."""
    c = coordinates("x y")
    (x, y), (u, w) = c.q, c.v
    X, Y = x + R(1, 2) - mu, y + sp.sqrt(3) / 2
    V = -(1 - mu) / sp.sqrt((X + mu) ** 2 + Y**2) - mu / sp.sqrt((X - 1 + mu) ** 2 + Y**2)
    return System(c, ((u - Y) ** 2 + (w + X) ** 2) / 2 - V).hamiltonian()


def deprit(a, b):
    """The quartic terms ½ (A I₁² + 2 B I₁ I₂ + C I₂²) at L4 of frequencies a > b with a² + b² = 1.

    Deprit & Deprit-Bartholomé, Astron. J. 72 (1967) 173; Meyer & Offin, Introduction to Hamiltonian Dynamical Systems, 11.5.
    """

    def own(a, b):
        return b**2 * (81 - 696 * a**2 + 124 * a**4) / (72 * (1 - 2 * a**2) ** 2 * (1 - 5 * a**2))

    mixed = -a * b * (43 + 64 * a**2 * b**2) / (6 * (4 * a**2 * b**2 - 1) * (25 * a**2 * b**2 - 4))
    return own(a, b), mixed, own(b, a)


@pytest.mark.parametrize("mu", [R(1, 100), R(3, 1000)])
def test_l4_has_the_coefficients_of_deprit_and_deprit_bartholome(mu):
    n = lagrange_point(mu).normal_form(order=4, at={"x": 0, "y": 0})
    (slow, fast), minus = sorted(map(abs, n.frequencies)), n.energy_signs.index(-1)
    assert fast**2 + slow**2 == pytest.approx(1) and (fast * slow) ** 2 == pytest.approx(27 / 4 * float(mu * (1 - mu)))
    assert abs(n.frequencies[minus]) == pytest.approx(slow)  # the long period has negative energy
    A, B, C = deprit(fast, slow)
    of = {tuple(sorted(((k, m) for k, m in enumerate(e) if m), key=str)): c for e, c in n.actions.items()}
    plus = 1 - minus
    assert of[(plus, 2),] == pytest.approx(A / 2) and of[(minus, 2),] == pytest.approx(C / 2)
    assert of[(0, 1), (1, 1)] == pytest.approx(B, rel=1e-8)


def test_a_sleeping_top_precesses_at_its_published_rates():
    """Of a top in the Cartesian components of its axis: two rates of both signs of energy, and Routh's I3² w² > 4 I1 m g l."""
    c = coordinates("x y")
    (x, y), (u, w) = c.q, c.v
    z = sp.sqrt(1 - x**2 - y**2)
    spin = sp.Symbol("G", positive=True)
    L = (u**2 + w**2 + (x * u + y * w) ** 2 / z**2) / 2 - spin * (x * w - y * u) / (1 + z) - z
    h = System(c, L).hamiltonian()
    n = h.normal_form(order=4, at={x: 0, y: 0}, values={spin: R(5, 2)})
    assert sorted(n.frequencies) == [-R(1, 2), 2]  # s² − G s + 1 = 0
    with pytest.raises(SingularError, match="double"):
        h.normal_form(order=4, at={x: 0, y: 0}, values={spin: 2.0})


def test_frequencies_that_are_letters_stay_exact_and_surds_are_numbers():
    a, b = sp.symbols("a b", positive=True)
    n = plane(lambda x, y: a**2 * x**2 / 2 + b**2 * y**2 / 2 + x**2 * y**2).normal_form(order=4, at={"x": 0, "y": 0})
    assert n.actions == {(1, 0): a, (0, 1): b, (1, 1): 1 / (a * b)} and n.energy_signs == (1, 1)
    n = plane(lambda x, y: x**2 + y**2 / 2 + x**2 * y).normal_form(order=4, at={"x": 0, "y": 0})
    assert n.frequencies == pytest.approx((1, sqrt(2))) and n.actions[1, 1] == pytest.approx(-sqrt(2) / 7)
    with pytest.raises(InputError, match="no rational frequency: give a values"):
        plane(lambda x, y: a * x**2 + y**2 / 2).normal_form(order=4, at={"x": 0, "y": 0})


def test_a_near_resonance_is_kept_within_its_detuning():
    h = plane(lambda x, y: x**2 / 2 + R(201, 100) ** 2 * y**2 / 2 + x**2 * y)
    assert not h.normal_form(order=4, at={"x": 0, "y": 0}).resonances
    n = h.normal_form(order=4, at={"x": 0, "y": 0}, detuning=0.02)
    assert {(2, 0, 0, 1), (0, 1, 2, 0)} <= set(n.resonances)
    assert abs(complex(n.resonances[2, 0, 0, 1])) ** 2 > 0


ONE = coordinates("x")
A = sp.Symbol("a")
REFUSED = {
    "give a values": (InputError, sp.cos(A * ONE.q[0]), {}),
    "no equilibrium": (InputError, sp.cos(A * ONE.q[0]), {"at": {"x": 1}, "values": {A: 1}}),
    "x without a value": (InputError, sp.cos(ONE.q[0]), {"at": {}}),
    "order = 1": (InputError, sp.cos(ONE.q[0]), {"order": 1}),
    "detuning = -1": (InputError, sp.cos(ONE.q[0]), {"detuning": -1}),
    "detuning = 'a'": (InputError, sp.cos(ONE.q[0]), {"detuning": "a"}),
    "analytic": (DomainError, -(sp.Abs(ONE.q[0]) ** 3) - ONE.q[0] ** 2, {}),
    "singular": (DomainError, -(ONE.q[0] ** 2) - ONE.q[0] ** 3 * sp.log(ONE.q[0]), {}),
    "name the period": (DomainError, -(ONE.q[0] ** 2) * (1 + sp.cos(t)), {}),
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_makes_no_sense_is_refused(message):
    error, potential, more = REFUSED[message]
    h = System(ONE, ONE.v[0] ** 2 / 2 + potential).hamiltonian()
    with pytest.raises(error, match=message):
        h.normal_form(**({"order": 4, "at": {"x": 0}} | more))


def test_frequencies_that_are_taken_as_equal_tell_what_that_leaves_out():
    """1 and 1 + 5e-9 are one frequency in floating-point numbers; in rational ones they are two."""
    near = lambda square: plane(lambda x, y: (x**2 + square * y**2) / 2 + x**2 * y)  # noqa: E731
    at = {"x": 0, "y": 0}
    merged, apart = near(1.00000001).normal_form(4, at), near(1.0001).normal_form(4, at)
    assert merged.error == pytest.approx(5e-9, rel=0.01)
    assert apart.error < 1e-9 and apart.frequencies[1] == pytest.approx(sqrt(1.0001), rel=1e-12)


def test_what_rests_and_what_drifts_keep_the_rate_zero():
    """A charge in a magnetic field: its circle, the circle's centre, and free flight along the field, in mixed coordinates."""
    rng, n = np.random.default_rng(1), 3
    bracket = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    rows = np.zeros((3, 6))  # the velocities
    rows[0, [3, 1]], rows[1, [4, 0]], rows[2, 5] = (1, 0.5), (1, -0.5), 1
    for _ in range(5):
        half = rng.normal(size=(6, 6)) / 4
        mixing = expm(bracket @ (half + half.T))
        A = mixing.T @ rows.T @ rows @ mixing
        H = polynomial({tuple(int(k == i) + int(k == j) for k in range(6)): A[i, j] * (0.5 if i == j else 1.0)
                        for i in range(6) for j in range(i, 6)}, 6, float)  # fmt: skip
        form = normal_form_of_series(H, 2)
        assert np.abs(np.array(form.frequencies) - [1, 0, 0]).max() < 1e-9 and form.error < 1e-9


def test_a_steady_motion_is_the_equilibrium_that_routh_leaves():
    """Kepler's circles: K = −1/2(I + P)², so that the perihelion does not turn: ∂K/∂P = ∂K/∂I."""
    c, P = coordinates("r phi"), sp.Symbol("P", positive=True)
    (r, _), (u, w) = c.q, c.v

    def form(potential, momentum, radius):
        system = System(c, (u**2 + r**2 * w**2) / 2 - potential).routh({c.q[1]: momentum})
        return system.hamiltonian().normal_form(6, {r: radius})

    kepler, I = form(-1 / r, P, P**2), sp.Symbol("I")
    K = sum(c * I ** e[0] for e, c in kepler.actions.items())
    assert kepler.frequencies == (P**-3,)
    assert sp.expand(K - sp.series(-1 / (2 * (I + P) ** 2), I, 0, 4).removeO()) == 0
    # Twin: an oscillator's ellipses, of equal rates at all amplitudes and with two swings of r a turn.
    assert form(r**2 / 2, P**2, P).actions == {(0,): P**2, (1,): 2}


def test_what_is_taken_to_be_zero_and_is_not_is_refused_where_its_series_has_no_end() -> None:
    def form(slow: float):
        rates = {0: 1e4, 1: 0.011, 2: slow}
        squares = {tuple(2 * (k == j + side) for k in range(6)): w / 2 for j, w in rates.items() for side in (0, 3)}
        return normal_form_of_series(polynomial(squares | {(0, 1, 2, 0, 0, 0): 1.0}, 6), 3)

    assert np.isfinite(form(0.003).generators[0].coefficients).all()
    with pytest.raises(SingularError, match="so small beside the largest"):
        form(0.009)
