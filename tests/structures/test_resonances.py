"""Which structures fall by resonances, when, from which pushes and at which spins, held to the exact motion."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from lagrotor import Brace, Link, Rotor, Structure
from lagrotor.errors import InputError
from lagrotor.mechanics.canonical import normal_forms
from lagrotor.mechanics.canonical.normal_coordinates import normal_coordinates
from lagrotor.mechanics.canonical.polynomials import total, variable
from lagrotor.numerics import measured_order
from lagrotor.structures import exact_motion, example, local_hamiltonian, measured_fall, resonant_factors
from lagrotor.structures.exact.exact_motion import off_constraints
from lagrotor.structures.resonances import _outweighs, normal_form_of, trusted_push
from lagrotor.structures.small_motion import bar_rows, small_motion

WEIGHT = {"gravity": 9.81, "load": 2.0}
CORNER = {"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)], **WEIGHT}
SQUARE = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "bars": [(0, 1), (1, 2), (2, 3), (3, 0)], **WEIGHT}
DIRECTION = np.array([[0.151, -0.931], [0.151, -0.149], [0.205, -0.149]])  # on the corner's bars, of length 1
HEAVY = {
    "joints": [(0, 0), (1, 0.2), (1, 1.3)],
    "bars": [(0, 1), (1, 2)],
    "rotor": [Rotor(1, 1, 1, 1), Rotor(1.5, 0.8, 0.7, 1), Rotor(1, 1.3, 1, 0.5)],
    "link": [Link(1, 0.3, 0.05), Link(1, 0.1, 0.02)],
    "gravity": 9.81,
    "load": [2, 1, 0],
    "hinge": [3, 0, 2],
    "braces": [Brace(0, (0.3, 0.4, 0.1), 40.0), Brace(0, 2, 15.0)],
}
LENGTHS = Structure(
    [(0, 0), (1, 0), (2.1, 0.3)],
    [(0, 1), (1, 2)],
    [1, -0.5, 1],
    tuple(Rotor(length=x) for x in (1.0, 1.3, 0.8)),
    gravity=9.81,
)


def at(factor: float, shape, spins) -> Structure:
    """A structure with `factor` times its critical spins."""
    s = Structure(**shape, spins=spins)
    return replace(s, spins=tuple(factor * s.critical_spin() * w for w in s.spins))


RESONANT = at(1.0607, CORNER, [1, 0, 1])


def directions(s: Structure, count: int, seed: int = 0):
    """Rates (N, 2) of length 1 that the bars allow."""
    basis, rng = small_motion(s).basis, np.random.default_rng(seed)
    for _ in range(count):
        v = rng.normal(size=basis.shape[1])
        yield (basis @ v / np.linalg.norm(v)).reshape(-1, 2)


def test_modes_have_the_signs_of_their_energies():
    """Half of the degrees of freedom that fall have modes of less energy than rest; with springs that hold, none."""
    top = Structure(joints=[(0, 0)], spins=30, **WEIGHT).modes()
    assert top.rates[0] < top.rates[1] and top.energy_signs.tolist() == [-1, 1]
    for name in ("corner", "square", "hexagon", "grid"):
        signs = example(name).modes().energy_signs
        assert (signs == -1).sum() == (signs == 1).sum() == len(signs) // 2
    assert (Structure(**CORNER | {"hinge": 60.0}, spins=20).modes().energy_signs == 1).all()
    falling = Structure(**CORNER, spins=1).modes()
    assert falling.energy_signs[falling.growth > 0].tolist() == [0] * falling.topple
    assert "of negative energy" in repr(top)


def gap(s: Structure, order: int, eps: float, spins: float = 1.0) -> float:
    """How far q'' by the expanded Hamiltonian is from the exact one at a state of size eps, relative."""
    h, motion, linear = local_hamiltonian(s, order), exact_motion(s), small_motion(s)
    back, H, n = np.linalg.pinv(bar_rows(motion.c)), h.at_spins(spins), len(h.mass)
    slopes, step = [H.derivative(k) for k in range(2 * n)], 1e-5
    x = eps * np.random.default_rng(5).normal(size=2 * n)

    def flow(x):
        values = np.array([f.at(x) for f in slopes])
        return np.concatenate([values[n:], -values[:n]])

    def axes(q):
        u = linear.basis @ q
        for _ in range(60):
            xy = u.reshape(-1, 2)
            r = np.column_stack([xy, np.sqrt(1 - (xy**2).sum(1))])
            u = u + back @ (off_constraints(motion.c, r)[len(r) :] / motion.c.ell)
        return r

    second = (flow(x + step * flow(x)) - flow(x - step * flow(x)))[:n] / (2 * step) * h.rate**2
    q, v = x[:n], flow(x)[:n] * h.rate
    rates = (axes(q + step * v) - axes(q - step * v)) / (2 * step)
    exact = linear.basis.T @ motion.accelerations(0.0, axes(q), rates)[:, :2].ravel()
    return float(np.abs(second - exact).max() / np.abs(exact).max())


@pytest.mark.parametrize("order", [3, 4])
def test_the_expanded_hamiltonian_moves_as_the_exact_structure_to_its_order(order):
    s = Structure(**HEAVY, spins=[20, -13, 31])
    coarse, fine = gap(s, order, 0.04), gap(s, order, 0.02)
    assert np.log2(coarse / fine) > order - 1.3
    assert gap(s, order, 0.02, spins=1.01) > 10 * fine  # the twin: of other spins


@pytest.mark.parametrize(("shape", "spins"), [(CORNER, [1, 0, 1]), (SQUARE, [1, 1, 1, -1])])
def test_corner_and_square_fall_at_their_resonance(shape, spins):
    found = at(1.0607, shape, spins).stands()
    assert found and found.kind == "falls at a resonance" and "a resonance of order 3, " in found.why
    assert found.resonance.rates == pytest.approx(small_rates(found.structure) * np.array([-1, -1, 1, 1]))
    rate = local_hamiltonian(found.structure).rate
    assert found.resonance.rates / rate == pytest.approx([-0.70703, -0.70703, 1.41437, 1.41437], abs=1e-5)
    assert abs(found.resonance.detuning) / rate == pytest.approx(3.2e-4, rel=0.01)
    low, high = found.resonance.window(0.01 * rate)
    assert low < 1 < high and high - low < 0.02
    assert found.fall_time(0.01 * rate) * rate == pytest.approx(100, rel=0.2)
    assert found.fall_time(0.02 * rate) == pytest.approx(found.fall_time(0.01 * rate) / 2)


def small_rates(s: Structure):
    return np.sort(s.modes().rates)


def test_equal_spins_on_the_same_corner_hold_at_the_same_factor():
    """Two rates add up to a third there, too, but the coefficient vanishes."""
    equal = at(1.0607, CORNER, [1, 1, 1])
    found, rate = equal.stands(), local_hamiltonian(equal).rate
    assert found.kind == "holds" and found.resonance.push() > 0.1 * rate
    assert found.fall_time(0.02 * rate) == inf and found.fall_time(0.02 * rate * DIRECTION) == inf
    assert measured_fall(equal, 0.08 * rate * next(directions(equal, 1)), 30 / rate, tol=1e-6) == inf
    assert measured_fall(RESONANT, 0.08 * rate * next(directions(RESONANT, 1)), 30 / rate, tol=1e-6) < inf


def test_the_corner_falls_from_any_push_in_a_time_as_one_over_it():
    """The runs of the issue: start speeds of 0.02, 0.01, 0.005 along one direction, 75, 153, 306."""
    found, rate = RESONANT.stands(), local_hamiltonian(RESONANT).rate
    for speed, time in ((0.02, 75), (0.01, 153), (0.005, 306)):
        along = found.fall_time(speed * rate * DIRECTION) * rate
        assert abs(along - time) < 0.06 * time
        assert found.fall_time(speed * rate) * rate < along
    push = 0.02 * rate * DIRECTION
    assert measured_fall(RESONANT, push, 90 / rate) == pytest.approx(found.fall_time(push), rel=0.1)


@pytest.mark.parametrize(
    ("shape", "spins"), [(CORNER, [1, 0, 1]), pytest.param(SQUARE, [1, 1, 1, -1], marks=pytest.mark.slow)]
)
def test_what_is_said_does_not_depend_on_the_basis_of_modes_of_equal_rates(monkeypatch, shape, spins):
    """Both rates are double there: any unitary mixture of the two modes of a rate is as good, and a BLAS kernel picks one."""
    s, told, shapes = at(1.0607, shape, spins), [], []
    mixture = np.kron(np.eye(2), [[0.6, 0.8j], [0.8j, 0.6]])

    def rotated(A, bracket):
        normal = normal_coordinates(A, bracket)
        z = normal.vectors[:, : len(A) // 2] @ mixture
        return replace(normal, vectors=np.hstack([z, z.conj()]))

    for coordinates in (normal_coordinates, rotated):
        monkeypatch.setattr(normal_forms, "normal_coordinates", coordinates)
        normal_form_of.cache_clear()
        found, rate = s.stands(), local_hamiltonian(s).rate
        push = 0.02 * rate * next(directions(s, 1, seed=7))
        told.append([found.fall_time(push), s.largest_push().value, *found.resonance.window(0.02 * rate)])
        shapes.append(np.abs(normal_form_of(s, order=3).vectors))
    assert np.abs(shapes[0] - shapes[1]).max() > 0.05 and np.isfinite(told).all()
    assert told[1] == pytest.approx(told[0], rel=3e-8)
    normal_form_of.cache_clear()


@pytest.mark.parametrize(("fed", "falls"), [(1.2, True), (0.8, False)])
def test_whether_own_terms_stop_it_does_not_depend_on_the_basis_of_modes_of_equal_rates(fed, falls):
    """|z₁|⁴ + 50 |z₂|⁴ + 2 c Re z₁³ z₃ falls along z₂ = 0 alone: seen by no coefficient of another basis of z₁, z₂."""
    a, b, c, *conjugates = (variable(j, 6) for j in range(6))
    c_size = fed * 9 / (2 * 3**1.5)

    def terms(x, y, z, xc, yc, zc):
        own = [x.power(2, 4).product(xc.power(2, 4), 4), y.power(2, 4).product(yc.power(2, 4), 4).times(50)]
        return total([*own, *(u.power(3, 4).product(w, 4).times(c_size) for u, w in ((x, z), (xc, zc)))])

    def mixed(u, v):
        return (u + v).times(0.5**0.5), (u - v).times(0.5**0.5)

    plain = terms(a, b, c, *conjugates)
    rotated = terms(*mixed(a, b), c, *mixed(*conjugates[:2]), conjugates[2])
    for part in (plain, rotated):
        assert _outweighs(part, (3, 0, 1), [[0, 1], [2]]) is falls
    assert _outweighs(plain, (3, 0, 1), [[0], [1], [2]]) is falls
    assert not any(_outweighs(rotated, k, [[0], [1], [2]]) for k in ((3, 0, 1), (2, 1, 1), (1, 2, 1), (0, 3, 1)))


@pytest.mark.slow
def test_of_fourth_order_it_falls_more_slowly():
    """Three slow rates in a fast one: the time grows as one over the square of the push."""
    (factor, resonance), rate = resonant_factors(RESONANT, (4,))[0], local_hamiltonian(RESONANT).rate
    s = replace(RESONANT, spins=tuple(factor * w for w in RESONANT.spins))
    push = next(directions(s, 1))
    times = [measured_fall(s, p * rate * push, 4500 / rate) * rate for p in (0.06, 0.03)]
    assert resonance.least_time(0.03 * rate) == pytest.approx(4 * resonance.least_time(0.06 * rate))
    assert resonance.least_time(0.06 * rate) * rate < times[0] and times[1] / times[0] == pytest.approx(4, rel=0.25)


def test_beside_the_resonance_a_small_push_stays_and_a_large_one_falls():
    """|δ| against 18 c ρ: outside the window of a push nothing falls, well inside it something does."""
    s = RESONANT
    rate = local_hamiltonian(s).rate
    push = 0.02 * rate
    (high, _), *_ = s.spin_intervals(push)
    assert 1 < high < 1.001 * s.stands().resonance.window(push)[1]
    for factor, falls in ((0.7 + 0.3 * high, True), (high, False)):
        beside = replace(s, spins=tuple(factor * w for w in s.spins))
        ends = [measured_fall(beside, push * v, 130 / rate, tol=1e-7) for v in directions(beside, 2)]
        assert bool(min(ends) < inf) is falls
        resonance = beside.stands().resonance
        assert bool(resonance and resonance.push() < push) is falls


def test_spin_intervals_are_those_of_the_largest_push():
    s = RESONANT
    rate = local_hamiltonian(s).rate
    narrow, wide = s.spin_intervals(0.005 * rate), s.stands().resonance.window(0.02 * rate)
    assert s.critical_spin() < narrow[0][0] < 1.01 * s.critical_spin() and narrow[-1][1] == inf
    for edge, outside in ((narrow[0][0], -3e-3), (narrow[0][1], 6e-3), (narrow[1][0], -4e-3)):
        within, without = (
            replace(s, spins=tuple(edge * factor * w for w in s.spins)).largest_push().value
            for factor in (1, 1 + outside)
        )
        assert without < 0.005 * rate <= within
    assert len(narrow) == 3 and not any(low < 1 < high for low, high in narrow)
    assert wide[0] < narrow[0][1] < 1 < narrow[1][0] < wide[1]
    # The second window is that of 1 : 3, at the factor where three slow rates are a fast one.
    rates = small_rates(replace(s, spins=tuple(np.mean([narrow[1][1], narrow[2][0]]) * w for w in s.spins)))
    assert rates[-1] / rates[0] == pytest.approx(3, abs=0.03)
    assert Structure(joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=[10, 10], **WEIGHT).spin_intervals(0.1) == ()


@pytest.mark.slow
def test_no_end_of_a_spin_interval_lets_fall_what_the_largest_push_says_falls():
    """Unequal rotors: 2 × 2.05 stays 1.3 rad/s from 2.82 there, at no factor equal to it, yet falls from 0.38 of the push."""
    unequal = [Rotor(1, 1.12, 1.22, 1.08), Rotor(1, 1.03, 1.16, 1.13), Rotor(1, 0.98, 1.04, 1.15)]
    more = {"link": [Link(1, 0.03, 0.03), Link(1, 0.26, 0.03)], "load": [1.47, 0.8, 1.01], "hinge": [0.69, 1.95, 2.91]}
    joints = [(0, 0), (1, 0.2), (0.98, 1.2)]
    s = at(
        1, {"joints": joints, "bars": [(0, 1), (1, 2)], "rotor": unequal, "gravity": 9.81} | more, [-19.4, 50.8, 6.3]
    )
    push = 0.8 * trusted_push(s, 1.02)
    assert trusted_push(s, 1.013) > push

    def part(factor: float) -> float:
        return replace(s, spins=tuple(factor * w for w in s.spins)).largest_push().value / push

    (low, high), (_, end) = s.spin_intervals(push)
    assert end == inf and high > 1.05 and part(low) >= 1 - 1e-6
    assert part(1.013) < 0.5 and part(1 + (low - 1) / 1.3) < 1


@pytest.mark.parametrize("times", [100, *(pytest.param(x, marks=pytest.mark.slow) for x in (5, 40))])
def test_at_fast_spins_the_push_that_holds_lies_within_an_interval(times):
    """Slow precessions of 10⁻⁵ of the fast one are no rate zero; and with friction they fall, however slowly."""
    factor = times * LENGTHS.critical_spin()
    fast = replace(LENGTHS, spins=tuple(factor * w for w in LENGTHS.spins))
    push = 0.9 * fast.largest_push().value
    assert fast.stands().kind == "holds" and push > 0
    assert any(low <= factor <= high for low, high in LENGTHS.spin_intervals(push))
    rubbed = replace(fast, friction=0.1)
    assert rubbed.critical_spin() == inf and rubbed.stands().kind == "never"
    assert "friction undoes the stability by spins" in rubbed.stands().why


def test_what_lies_behind_the_largest_push():
    s = at(1.07, CORNER, [1, 0, 1])
    found, rate = s.largest_push(), local_hamiltonian(s).rate
    assert "order 3" in found.behind and float(found) == found.value == found.resonance.push()
    assert 0.001 < found.value / rate < 0.03
    assert at(0.95, CORNER, [1, 0, 1]).largest_push().value == 0
    top = Structure(joints=[(0, 0)], spins=60, **WEIGHT).largest_push()
    assert "no resonance" in top.behind and top.value > 0


def test_slow_rates_alone_limit_the_push_and_are_told_in_words():
    """Nothing stands on the other side of three slow rates, yet beyond their bound a run falls."""
    fast = replace(LENGTHS, spins=tuple(1.7 * LENGTHS.critical_spin() * w for w in LENGTHS.spins))
    largest, steep = fast.largest_push(), np.array([[0.033, 0.785], [0.025, 0.0], [0.201, -0.585]])
    assert "3 × 0.654 is small compared with 26.64 rad/s" in largest.behind
    assert trusted_push(fast) > 0.186 > 1.5 * largest.value
    assert measured_fall(fast, 0.186 * steep, 60.0, tol=1e-7) < 60 and np.linalg.norm(steep) == pytest.approx(
        1, abs=1e-2
    )
    assert measured_fall(fast, 0.98 * largest.value * steep, 60.0, tol=1e-7) == inf


@pytest.mark.slow
def test_no_exact_run_falls_from_the_largest_push():
    """Structures and spins drawn at random, four directions each."""
    rng = np.random.default_rng(11)
    tried = 0
    while tried < 12:
        shape = [CORNER, SQUARE, {"joints": [(0, 0), (1, 0.3)], **WEIGHT}][rng.integers(3)]
        more = {
            "load": rng.uniform(0, 3, len(shape["joints"])).tolist(),
            "link": Link(1, rng.uniform(0, 0.5), rng.uniform(0, 0.1)),
        }
        s = Structure(**shape | more, spins=(30 * rng.normal(size=len(shape["joints"]))).tolist())
        if not 0 < s.critical_spin() < 1e3:
            continue
        tried += 1
        s = replace(s, spins=tuple(rng.uniform(1.02, 1.6) * s.critical_spin() * w for w in s.spins))
        push, rate = s.largest_push().value, local_hamiltonian(s).rate
        for v in directions(s, 4, seed=tried):
            assert measured_fall(s, push * v, 200 / rate, tol=1e-7) == inf


def test_kinds_of_what_stands_and_what_does_not():
    assert Structure(**CORNER, spins=1).stands().kind == "never"
    assert Structure(**CORNER, spins=1).stands().fall_time(0.1) == 0
    hanging = Structure(**CORNER | {"hinge": 60.0}, spins=20).stands()
    assert hanging.kind == "holds" and hanging.fall_time(0.1) == inf and "stays bounded" in hanging.why
    assert Structure(joints=[(0, 0)], spins=[10]).stands().kind == "to first order"
    assert Structure(**CORNER, spins=[60, 0, 60], spin_friction=0.1).stands().kind == "to first order"
    many = [(k, j) for k in range(3) for j in range(2)]
    assert Structure(joints=many, spins=60, **WEIGHT).stands().kind == "to first order"
    assert "holds" in repr(example("corner").stands())
    assert "never at these spins" in repr(Structure(**CORNER, spins=[1, 0, 1]).stands())
    assert "at these spins" not in repr(Structure(joints=[(0, 0), (1, 0)], bars=[(0, 1)], spins=1, **WEIGHT).stands())
    # Two modes are one.
    assert at(1.0, CORNER, [1, 0, 1]).stands().kind in ("to first order", "never", "falls at a resonance")


def test_what_is_beyond_the_expansion_is_no_promise():
    """A top stands at any factor from its critical spins on, but not after any push."""
    top = Structure(joints=[(0, 0)], spins=60, **WEIGHT)
    trusted = top.largest_push().value
    assert top.stands().fall_time(0.99 * trusted) == inf
    with pytest.raises(InputError, match="too far for the expansion"):
        top.stands().fall_time(1.01 * trusted)
    (low, high), *_ = top.spin_intervals(2 * trusted)
    assert low > 1 and high == inf and top.spin_intervals(1e9) == ()
    assert replace(top, spins=(60 * low,)).largest_push().value == pytest.approx(2.04 * trusted, rel=0.02)


def test_beside_the_critical_spins_the_exact_motion_falls_and_none_is_said_to_hold():
    """Where two modes of both signs become one the terms of fourth order let it fall, as the exact runs do."""
    s = at(1.001, CORNER, [1, 0, 1])
    rate = local_hamiltonian(s).rate
    push = 0.01 * rate
    assert measured_fall(s, push * list(directions(s, 2))[1], 60 / rate, tol=1e-7) < inf
    assert s.largest_push().value < push and not any(low <= 1 <= high for low, high in s.spin_intervals(push))
    assert s.stands().kind == "falls at a resonance"
    with pytest.raises(InputError, match="does not topple it in"):
        s.stands().fall_time(push * next(directions(s, 1)))
    beside = at(1.01, CORNER, [1, 0, 1]).stands()
    assert beside.kind == "to first order" and "so near the critical spins" in beside.why
    assert at(1.03, CORNER, [1, 0, 1]).stands().kind == "holds"


def test_beside_the_critical_spins_a_barrier_is_no_resonance():
    """Three equal spins: 2.97 and 2 × 0.73 rad/s do not resonate, and the exact motion falls from the barrier on, not below."""
    s = at(1.003, CORNER, [1, 1, 1])
    found = s.stands()
    assert found and found.kind == "falls over a barrier" and not found.resonance.resonant
    assert "passes the barrier of the terms of order 3" in found.why and "no rates are resonant" in found.why
    barrier, pushes = found.resonance.push(), list(directions(s, 3))
    falls = [[measured_fall(s, size * barrier * d, 40, 1e-7) < inf for d in pushes] for size in (0.5, 2)]
    assert not any(falls[0]) and sum(falls[1]) >= 2
    assert RESONANT.stands().resonance.resonant  # twin


def test_how_long_it_holds():
    """As push^−4 by the form of fifth order; for ever where the energy is least, or of a free top; not at all
    beyond what is trusted. At a resonance of third order not as long as its least time."""
    s = at(1.5, CORNER, [1, 0.3, 1.2])
    found, rate = s.stands(), local_hamiltonian(s).rate
    pushes = (0.001, 0.002, 0.004)
    times = [found.hold_time(push * rate) for push in pushes]
    assert found.kind == "holds" and measured_order(pushes, times) == pytest.approx(-4, abs=0.1)
    assert Structure(joints=[(0, 0)], spins=60, **WEIGHT).stands().hold_time(0.1) == inf
    assert Structure(**CORNER | {"hinge": 60.0}, spins=20).stands().hold_time(0.1) == inf
    assert (
        Structure(**CORNER | {"hinge": 60.0}, spins=1).stands().hold_time(10) == 0
    )  # energy is least near upright alone
    assert found.hold_time(2 * s.largest_push().value) == 0 == at(0.9, CORNER, [1, 0, 1]).stands().hold_time(0.1)
    falling = RESONANT.stands()
    assert 0 < falling.hold_time(0.01 * rate) < falling.fall_time(0.01 * rate)


def test_odd_orders_that_symmetry_removes_are_no_promise():
    """Of two braces that face each other, equal ones leave no odd orders: nearly equal ones, which do, hold nearly as long."""
    pushes, times = (0.005, 0.01), []
    for stiffness in (20, 19.9):
        braces = [Brace(0, (1, 0, 0), 20), Brace(0, (-1, 0, 0), stiffness)]
        s = at(1.3, {"joints": [(0, 0)], "braces": braces, **WEIGHT}, 1)
        times.append([s.stands().hold_time(push) for push in pushes])
    assert times[0] == pytest.approx(times[1], rel=0.05)
    assert measured_order(pushes, times[0]) == pytest.approx(-4, abs=0.1)


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(2, marks=pytest.mark.slow)])
def test_no_exact_run_leaves_what_it_holds(seed):
    """As long as it is said to hold the tilts stay within sqrt(2) times the largest of the linear motion."""
    rng = np.random.default_rng(seed)
    s = at(rng.uniform(1.3, 1.8), CORNER, rng.uniform(0.3, 1.3, 3))
    rate, push = local_hamiltonian(s).rate, 0.9 * s.largest_push().value
    while s.stands().hold_time(push) < 60 / rate:
        push *= 0.9
    t = np.linspace(0, min(s.stands().hold_time(push), 80 / rate), 600)
    start = push * next(directions(s, 1, seed))
    run = s.simulate(t, rates=np.column_stack([start, np.zeros(3)]), tol=1e-6)
    tilts = np.linalg.norm(run.axes[..., :2], axis=-1).max(0)
    assert tilts.max() < np.sqrt(2) * 0.1 * push / trusted_push(s)
