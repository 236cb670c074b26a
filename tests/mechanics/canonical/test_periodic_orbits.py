"""Normal forms about periodic orbits: published twists, steady motions, and what exact motions do."""

from math import acos, cos, pi, sin, tan

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics import System, coordinates, t
from lagrotor.mechanics.canonical import return_maps
from lagrotor.mechanics.canonical.polynomials import linear_form, poisson_bracket, polynomial, variable
from lagrotor.mechanics.canonical.return_maps import map_normal_form
from lagrotor.mechanics.canonical.taylor_series import jet_space
from lagrotor.numerics import measured_order
from tests.systems import henon_heiles

R = sp.Rational
c = coordinates("x y")
(x, y), (u, w) = c.q, c.v
line = coordinates("x")


def plane(V):
    return System(c, (u**2 + w**2) / 2 - V).hamiltonian()


def henon(a):
    """x' = x cos a − (y − x²) sin a, y' = x sin a + (y − x²) cos a."""
    kicked = variable(1, 2) - variable(0, 2).power(2, 9)
    one = variable(0, 2)
    return [one.times(cos(a)) - kicked.times(sin(a)), one.times(sin(a)) + kicked.times(cos(a))]


def twist_of(a):
    """Of Hénon's map; Dullin, Meiss & Sterling, Nonlinearity 13 (2000) 203: zero at cos a = −1/4."""
    return (3 / tan(a / 2) + 1 / tan(3 * a / 2)) / 8


@pytest.mark.parametrize("a", [0.3, 2.4, acos(-1 / 4)])
def test_the_twist_of_henons_map(a):
    n = map_normal_form(henon(a), 6)
    assert n.frequencies == pytest.approx((-a,))
    assert 2 * n.actions.get((2,), 0.0) == pytest.approx(twist_of(a), rel=1e-11, abs=1e-13)
    assert n.error < 1e-11 and not n.resonances


def test_resonances_of_third_and_fourth_order_are_kept():
    assert set(map_normal_form(henon(2 * pi / 3), 4).resonances) == {(3, 0), (0, 3)}
    assert {(4, 0), (0, 4)} <= set(map_normal_form(henon(pi / 2), 4).resonances)
    near = map_normal_form(henon(2 * pi / 3 + 0.01), 3, detuning=0.1)
    assert set(near.resonances) == {(3, 0), (0, 3)}


def turned(*angles):
    """Rotations of the pairs (u_j, v_j)."""
    c, s = np.diag(np.cos(angles)), np.diag(np.sin(angles))
    return [linear_form(row) for row in np.block([[c, s], [-s, c]])]


def test_multipliers_that_are_nearly_equal_are_taken_as_equal():
    assert map_normal_form(turned(pi - 1e-2, 1e-2), 4).frequencies == pytest.approx((1e-2, pi - 1e-2), rel=1e-10)
    near = map_normal_form(turned(1.0, 1.0 + 1e-8), 4)  # taken as equal
    assert 1e-9 < near.error < 1e-7 and map_normal_form(turned(1.0, 2.0), 4).error < 1e-14


NO_MAPS = [
    ([f.times(c) for f, c in zip(turned(1.0, 0.5), (1, 2, 1, 1 / 3), strict=True)], InputError, "no canonical map"),
    ([turned(1.0)[0] + polynomial({(0, 0): 0.1}, 2), turned(1.0)[1]], InputError, "a constant"),
    (turned(1.0)[:1], InputError, "2 m polynomials"),
    ([variable(0, 2) + variable(1, 2), variable(1, 2)], SingularError, "multiplier is 1"),
    (turned(pi - 1e-4, 1e-2), SingularError, "not separated"),  # was given as hyperbolic with the rate 0
]


@pytest.mark.parametrize(("F", "error", "match"), NO_MAPS)
def test_what_is_no_canonical_map_with_a_fixed_point_is_refused(F, error, match):
    with pytest.raises(error, match=match):
        map_normal_form(F, 4)
    f, g = henon(1.0)  # of a map without one of its terms the error says it
    assert map_normal_form([f, g.where(g.exponents.sum(1) < 2)], 4).error > 1e-2


def test_jets_are_taylor_series():
    space = jet_space(2, 5)
    p, q = space.variable(0) + 1.0, space.variable(1) + 1.1
    f = np.sqrt(p) * np.sin(q) / (2 - np.exp(-p * q)) + p**-2 * np.arctan(q) + np.log(p + q**3) ** 2 + 2**p + p**q

    def along(h):
        P, Q = 1 + mp.mpf("0.6") * h, mp.mpf("1.1") - mp.mpf("0.8") * h
        return mp.sqrt(P) * mp.sin(Q) / (2 - mp.exp(-P * Q)) + mp.atan(Q) / P**2 + mp.log(P + Q**3) ** 2 + 2**P + P**Q

    for d, wanted in enumerate(mp.taylor(along, 0, 5)):
        assert f.polynomial.part(d).at(np.array([0.6, -0.8])).real == pytest.approx(float(wanted), rel=1e-9)
    with pytest.raises(DomainError, match="floor"):
        np.floor(p)


def exact_angle(h, n, size, returns=120):
    """Angle of a return (rad) of the exact motion from z = size, by scipy; weighted, which converges faster than any power."""
    states = (*h.q, *h.p)
    rates = sp.lambdify((*states, t), [*(sp.diff(h.H, p) for p in h.p), *(-sp.diff(h.H, q) for q in h.q)])
    start, base = (np.array(list(place.values())) for place in (n.place([size]), n.orbit))
    drive, v = h.H.has(t), np.array(rates(*base, 0.0))

    def apart(states):
        angles = (np.arange(len(base)) < len(base) // 2) * 2 * pi
        return states - base - angles * np.round((states - base) / (2 * pi))

    def section(_, state):
        return 1.0 if drive else apart(state) @ v

    section.direction = 1
    times = n.period * np.arange(returns + 1)
    run = solve_ivp(
        lambda s, z: rates(*z, s), (0, times[-1]), start, "DOP853", times, events=section, rtol=1e-12, atol=1e-14
    )
    points = apart(run.y.T if drive else run.y_events[0])
    points = points[np.abs(points).max(axis=1) < 0.5]  # the plane is crossed elsewhere, too
    slope = np.array([[f.terms.get(e, 0.0) for e in ((1, 0), (0, 1))] for f in n.frame]) @ n.vectors
    z = np.linalg.lstsq(slope, points.T + 0j, rcond=None)[0][0]
    turned = np.angle(z[:-1] / z[1:] * np.exp(-1j * n.frequencies[0])) + n.frequencies[0]
    share = (np.arange(len(turned)) + 0.5) / len(turned)
    weights = np.exp(-1 / (share * (1 - share)))
    return (weights * turned).sum() / weights.sum()


def driven(V):
    return System(line, line.v[0] ** 2 / 2 - V(line.q[0])).hamiltonian()


ORBITS = {
    "a turning pendulum and an oscillator": (
        lambda: plane(-sp.cos(x) + y**2 / 2 - y**2 * sp.cos(x) / 5 + y**4 / 9 - y**3 / 5),
        ({x: 0, y: 0, u: 3.6}, 1.9, 0.15),
    ),
    "a driven Duffing oscillator": (
        lambda: driven(lambda x: x**2 / 2 + x**4 / 8 - x * sp.cos(R(17, 10) * t) / 5),
        ({line.q[0]: -0.1}, 2 * pi / 1.7, 0.1),
    ),
}


@pytest.mark.parametrize("name", ORBITS)
def test_the_angle_of_a_return_is_that_of_the_exact_motion(name):
    system, (at, period, size) = ORBITS[name]
    h = system()
    n = h.normal_form(order=4, at=at, period=period)
    assert n.error < 1e-11 and abs(n.multipliers) == pytest.approx(1)
    sizes = np.array([1, 0.7, 0.5]) * size
    exact = np.array([exact_angle(h, n, s) for s in sizes])
    law = np.array([n.frequencies_at([s**2])[0] for s in sizes])
    assert abs(measured_order(sizes, np.abs(exact - law)) - 4) < 0.1
    assert abs(measured_order(sizes, np.abs(exact - n.frequencies[0])) - 2) < 0.2  # without the twist
    assert n.rotation_numbers([size**2])[0] == pytest.approx(law[0] / (2 * pi))


def test_normal_coordinates_are_canonical_and_the_section_has_the_orbits_energy():
    h = henon_heiles().hamiltonian()
    n = h.normal_form(order=6, at={x: 0, y: 0, w: 0.45}, period=7.1)
    new = [n.original(linear_form(row)) for row in n.vectors]
    bracket = poisson_bracket(new[0], new[1], n.weights, 4) - polynomial({(0, 0): 1.0}, 2)
    scale = max(np.abs(f.coefficients).max() for f in new) ** 2
    assert np.abs(bracket.coefficients).max() < 1e-11 * scale
    value = sp.lambdify((*h.q, *h.p), h.H)
    gaps = [abs(value(*n.place([s]).values()) - value(*n.orbit.values())) for s in (0.04, 0.02)]
    assert gaps[0] < 1e-6 and np.log2(gaps[0] / gaps[1]) > 5.5


def test_an_ion_at_rest_in_a_trap():
    """Ω = 10⁷ rad/s, m = 10⁻²⁵ kg, q in metres: the trap of Ω = m = 1, whose unit of action is m Ω (1 mm)²."""
    q, v = line.q[0], line.v[0]

    def trap(m, omega, length):
        V = m * omega**2 * (q**2 / 2 * (R(1, 50) + R(3, 20) * sp.cos(omega * t)) + q**4 / length**2 / 100)
        return System(line, m * v**2 / 2 - V).hamiltonian().normal_form(order=4, at={q: 0}, period=2 * pi / omega)

    plain, ion = trap(1, 1, 1), trap(R(1, 10**25), 10**7, R(1, 1000))
    assert ion.frequencies == pytest.approx(plain.frequencies, rel=1e-10)
    assert ion.twist[0, 0] * 1e-24 == pytest.approx(plain.twist[0, 0], rel=1e-9)


def test_a_pulse_by_which_an_oscillator_is_driven_is_not_passed_over(monkeypatch):
    """x'' = −(1 + 3 δ(t − s)) x, once in 7 s, about its rest: the angle of a period has the cosine cos 7 − 3/2 sin 7 at any s.

    Without the cut a step may come upon the pulse, which hangs on the processor; not upon each of three.
    """
    x, p = symbols = sp.symbols("x p", real=True)
    width = 0.002

    def off(s):
        pulse = 3 / (width * sp.sqrt(sp.pi)) * sp.exp(-((sp.sin((t - s) * sp.pi / 7) * 7 / sp.pi / width) ** 2))
        H, rest = p**2 / 2 + (1 + pulse) * x**2 / 2, {x: 0, p: 0, t: 0}
        cosine = np.real(return_maps.return_map_form(H, symbols, rest, 7.0, 2, 1e-6).multipliers[0])
        return abs(cosine - cos(7) + 1.5 * sin(7))

    assert off(1.1) < 4 * width
    monkeypatch.setattr(return_maps, "brief_windows", lambda *_: ())
    assert max(map(off, (1.1, 2.3, 3.3))) > 0.5  # twin


def test_hyperbolic_orbits():
    q = line.q[0]
    inverted = driven(lambda x: sp.cos(x) - x * sp.cos(R(3, 2) * t) / 5)
    n = inverted.normal_form(order=4, at={q: 0}, period=2 * pi / 1.5)
    assert n.energy_signs == (0,) and np.prod(n.multipliers) == pytest.approx(1)
    whole = System(line, line.v[0] ** 2 / 2 - sp.cos(q) + q * sp.cos(R(3, 2) * t) / 5)
    turned = whole.floquet({q: n.orbit[q], line.v[0]: n.orbit[inverted.p[0]]}, {}, n.period)
    assert sorted(n.multipliers.real) == pytest.approx(sorted(turned.multipliers.real), rel=1e-6)
    parametric = driven(lambda x: x**2 / 2 * (1 + sp.cos(2 * t) / 5) + x**4 / 4)
    n = parametric.normal_form(order=4, at={q: 0}, period=pi)
    assert (n.multipliers.real < 0).all() and np.isnan(n.rotation_numbers()).all()


@pytest.mark.parametrize("T", [8, 20])
def test_multipliers_of_a_saddle_are_its_rates_and_too_large_ones_are_refused(T):
    """About x = 0 of V = −x²/2 + x³ cos(2πt/T)/10 they are exp(±T)."""
    saddle = driven(lambda x: -(x**2) / 2 + x**3 * sp.cos(2 * sp.pi * t / T) / 10)
    if T == 8:
        n = saddle.normal_form(order=3, at={line.q[0]: 0}, period=T)
        assert n.multipliers == pytest.approx(np.exp([T, -T]), rel=1e-4)
    else:
        with pytest.raises(SingularError, match=r"a multiplier is 4\.9e\+08, too far from its reciprocal"):
            saddle.normal_form(order=3, at={line.q[0]: 0}, period=T)


def test_three_degrees_of_freedom_and_the_twist_as_a_matrix():
    b = coordinates("x y z")
    (x, y, z), v = b.q, b.v
    V = (x**2 + 2 * y**2 + 3 * z**2) / 2 + x * y**2 / 5 + x**2 * z**2 / 7 + x**4 / 10
    h = System(b, sum(s**2 for s in v) / 2 - V).hamiltonian()
    n = h.normal_form(order=4, at={x: 0, y: 0, z: 0, v[0]: 0.5}, period=6.1)
    assert n.twist.shape == (2, 2) and n.twist[0, 1] == pytest.approx(n.twist[1, 0])
    assert n.error < 1e-10 and abs(n.multipliers) == pytest.approx(1)


def test_the_start_may_be_off_and_letters_have_values():
    g = sp.Symbol("g", positive=True)
    h = plane((x**2 + y**2) / 2 + g * (x**2 * y - y**3 / 3))
    near = h.normal_form(order=4, at={x: 0.02, y: 0.01, w: 0.45}, period=6.9, values={g: 1})
    exact = (
        henon_heiles()
        .hamiltonian()
        .normal_form(order=4, at={x: 0, y: 0, w: np.sqrt(0.2025 + 5e-4 + 2 * 2e-4**2)}, period=7.1)
    )
    assert near.orbit[x] == pytest.approx(0, abs=1e-10)
    assert near.frequencies[0] == pytest.approx(exact.frequencies[0], rel=1e-2)
    with pytest.raises(InputError, match="g without a value"):
        h.normal_form(order=4, at={x: 0, y: 0, w: 0.45}, period=7.1)


REFUSED = [
    ({"period": -1.0}, {}, "period"),
    ({"period": "7"}, {}, "period"),
    ({"period": 7.1, "order": 1}, {}, "order"),
    ({"period": 7.1}, {"y": None}, "y"),
    ({"period": 7.1}, {"y_dot": 0.0}, "nothing moves"),
    ({"period": 3.0}, {}, "normal_form"),
    ({"period": 3.6}, {}, "another momentum"),  # the same place on the way back
]


@pytest.mark.parametrize(("options", "changed", "match"), REFUSED)
def test_what_is_no_orbit_is_refused(options, changed, match):
    at = {k: e for k, e in ({"x": 0, "y": 0, "y_dot": 0.45} | changed).items() if e is not None}
    with pytest.raises(InputError, match=match):
        henon_heiles().hamiltonian().normal_form(**({"order": 4} | options), at=at)


def test_symmetries_and_single_degrees_of_freedom_are_refused():
    h = plane((x**2 + y**2) / 2)  # every orbit is closed
    with pytest.raises(SingularError, match="multiplier is 1"):
        h.normal_form(order=4, at={x: 1, y: 0, w: 0.5}, period=2 * pi)
    q = line.q[0]
    with pytest.raises(DomainError, match="leave out the period"):
        driven(lambda x: x**4).normal_form(order=4, at={q: 1}, period=3.0)
    for wrong in (3.0, pi / 1.7):
        with pytest.raises(InputError, match="the period of the drive"):
            driven(lambda x: x**2 * (1 + sp.cos(R(17, 10) * t) / 5)).normal_form(order=4, at={q: 0}, period=wrong)
