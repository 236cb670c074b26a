"""The averaged motion of opposite spins: its curves against its own equations, its laws against exact orbits and runs."""

from dataclasses import replace
from functools import cache
from math import cos, inf, pi, sqrt

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor import Link, Scene, Shock, floquet, natural_rate, shock_response, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.models import exact_orbit, mean_over, slow_frequency_error, time_to_reach_error, time_to_wander
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.floquet import _pushed
from lagrotor.numerics import measured_order
from lagrotor.pair import leaning_lagrangian
from lagrotor.pair.notation import G_1, G_2, LEANING, a, b, k
from lagrotor.theory import SlowMotion, slow_frequency, slow_motion, slow_rates, time_to_reach, turns_back
from lagrotor.theory.averaged_motion import _next_order
from tests.models.orbits_at_once import ENOUGH, exact_orbits
from tests.theory.random_pairs import exact_axes, held, random_pair, shocked


def random_motion(rng: np.random.Generator) -> SlowMotion:
    """A light or a heavy bar, any sense of turning, started near upright; centre and swing of 0.03."""
    half, lean = rng.uniform(-1, 1, 2)
    momentum = rng.choice([0.0, rng.uniform(-2, 2)])
    return SlowMotion(
        lean, 0.03 * half, 0.03 * rng.uniform(0.2, 1), 9e-4 * momentum, rng.choice([0.0, rng.uniform(-1, 6)]), 1.0, 3.0
    )


@pytest.mark.parametrize("seed", range(12))
def test_the_time_by_quadrature_is_that_of_the_equations(seed: int) -> None:
    motion = random_motion(np.random.default_rng(seed))
    goal = abs(motion.lean) + 0.6 * (motion.farthest - abs(motion.lean))

    def there(t: float, y: np.ndarray) -> float:
        return abs(y[0]) - goal

    there.terminal = True  # type: ignore[attr-defined]
    unit = 1 / (motion.rate * motion.swing * (motion.swing**2 + motion.half**2 + abs(motion.momentum)))
    options = {"rtol": 1e-10, "atol": 1e-13, "method": "LSODA", "events": there, "max_step": unit / 4}
    run = solve_ivp(lambda t, y: motion.slopes(*y), (0, 60 * unit), (motion.lean, motion.half), **options)
    assert run.status == 1
    assert motion.time_to(goal) == pytest.approx(run.t[-1], rel=1e-5)


def test_the_farthest_lean_is_never_passed() -> None:
    rng, turned = np.random.default_rng(5), 0
    for motion in (random_motion(rng) for _ in range(40)):
        if motion.farthest == pi / 2:
            continue
        turned += 1
        assert motion.time_to(motion.farthest * (1 + 1e-6)) == inf
        assert np.isfinite(motion.time_to(motion.farthest * (1 - 1e-6)))
        assert motion.half_squared(motion.farthest + 1e-3, motion.legs[-1].branch) < 0 or motion.slopes(
            motion.farthest, sqrt(max(motion.half_squared(motion.farthest - 1e-9, motion.legs[-1].branch), 0.0))
        )[0] == pytest.approx(0, abs=1e-4)
    assert turned > 5


@pytest.mark.parametrize("size", [1e-12, 1e-8, 1e-3])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_lean_that_starts_where_it_turns_grows_as_the_cosh_or_swings(size: float, side: int) -> None:
    """eta = 0 and s² << |p|, beta small: beta'' = g² p³ beta. The shock along y that starts it so."""
    motion = SlowMotion(side * size, 0.0, size, 1e4 * size**2, 2.0, 1.0, 3.0)
    assert motion.time_to(10 * size) == pytest.approx(np.arccosh(10) / (3 * (100 * size) ** 3), rel=5e-3)
    held = replace(motion, momentum=-motion.momentum)
    assert held.farthest == pytest.approx(size, rel=1e-9)
    assert held.time_to(2 * size) == inf
    for link in (Link(0.5), Link(2.0, 1.0, 0.1)):
        for body in (1, 2):
            pair = Scene((10, -10), link=link, shock=Shock((0, side * 40 * size, 0), 1.0, 0.05, body))
            grows = slow_motion(pair).momentum > 0
            assert turns_back(pair) is not grows
            assert 0 < time_to_reach(pair, 0.1) < inf if grows else time_to_reach(pair, 0.1) == inf


def test_the_numbers_are_the_derived_expressions() -> None:
    scene = Scene((9, -9), link=Link(1.3, 0.7, 0.1), shock=Shock((8, 3, 0), 1.0, 0.1, 2))
    motion, (a, b) = slow_motion(scene), scene.inertias
    names = {s.name: s for e in slow_rates() for s in e.free_symbols}
    values = {"beta_s": 0.7, "eta": 0.05, "s": motion.swing, "P": -scene.shock.impulse[1], "G": 9, "k": 1.3}
    values |= {"a": a, "b": b}
    exact = [float(e.subs({names[n]: v for n, v in values.items() if n in names})) for e in slow_rates()]
    assert motion.slopes(0.7, 0.05) == pytest.approx(exact, rel=1e-12)
    x, y1, y2 = shock_response(scene).displacement
    assert (motion.lean, motion.half) == pytest.approx((x, (y1 - y2) / 2))


@pytest.mark.parametrize(("link", "spin"), [(Link(1.1, 0.0), 11.0), (Link(0.8, 1.0, 0.02), -14.0)])
def test_x_is_reached_in_time(link: Link, spin: float) -> None:
    scene = Scene((spin, -spin), link=link, shock=Shock((38, 0, 0), 0.4, 0.05))
    law = time_to_reach(scene, 0.3)
    assert time_to_wander(scene, 0.3, 1.5 * law) == pytest.approx(law, rel=0.15)


def shocked_pair(rng):
    """Opposite spins of natural rate 1, a bar 0.4 to 2.5 axes long, massless or up to 60 kg, a shock, and an x to be reached."""
    one = random_pair(rng, "opposite")
    length, mass = one.link.length, rng.choice([0, 1]) * np.exp(rng.uniform(np.log(0.01), np.log(60)))
    one = replace(one, link=Link(length, mass, mass * length**2 * rng.choice([0.0, rng.uniform(0, 0.3)])))
    one = replace(one, spins=tuple(w / natural_rate(one) for w in one.spins))
    return shocked(rng, one, 0.1, 0.5), rng.uniform(0.15, 0.9)


@pytest.mark.parametrize(
    ("seed", "count"), [(1, 1), *(pytest.param(seed, 1_000, marks=pytest.mark.slow) for seed in range(2, 12))]
)
def test_the_time_to_reach_tells_its_error(seed: int, count: int) -> None:
    """Against exact runs side by side, averaged over six swings."""
    rng, scenes, pairs, turn = np.random.default_rng(seed), [], [], 2 * pi
    while len(scenes) < count:
        scene, x = shocked_pair(rng)
        try:
            law = time_to_reach(scene, x)
            if 8 * turn < law < 60 * turn:  # beyond the first swings, and not for hours
                scenes.append((scene, x, law, time_to_reach_error(scene, x)))
        except DomainError:  # not small, or the pair twists too far
            continue
    times = [np.r_[0, np.arange(s.shock.end, s.shock.at + 3 * law + 8 * turn, turn / 32)] for s, _, law, _ in scenes]
    u = (np.arange(192) + 0.5) / 192
    weight = np.exp(-1 / (u * (1 - u)))
    for (scene, x, law, error), t, seen in zip(scenes, times, exact_axes([s for s, *_ in scenes], times), strict=True):
        mean = np.abs(np.convolve(seen[0][:, 1:, 0].mean(0), weight / weight.sum(), "valid"))
        there = t[1] + (np.argmax(mean >= x) + 95.5) * turn / 32 - scene.shock.at if mean.max() >= x else inf
        pairs.append((min(abs(there - law), 1e9), min(error, 1e9)))
    held(pairs, 0, count, 0)
    assert max(off / error for off, error in pairs) > 0.5  # twin: half of it is no bound


def with_threshold(side: float, k: float, force: float, width: float) -> Scene:
    """A heavy bar for which (sigma − 1) k² is `side` times 1 + 2/A² + sqrt(3/2), and a shock along x."""
    heavy = Scene((10, -10), link=Link(k, 1.0, 0.0), shock=Shock((force, 0, 0), 2.0, width))
    for _ in range(40):  # the width's A depends on the bar
        A = np.exp(-((natural_rate(heavy) * width) ** 2) / 4)
        shape = side * (1 + 2 / A**2 + sqrt(1.5)) / k**2
        heavy = replace(heavy, link=Link(k, 2 * heavy.rotor.J * shape, 0.0))
    return heavy


def test_beyond_the_threshold_x_turns_back() -> None:
    """At any k and width; to leading order at any size of the shock."""
    for ratio, force, width in ((1.0, 4.0, 1e-3), (0.7, 2.0, 0.01), (1.6, 0.3, 0.3)):
        for side in (0.99, 1.01):
            heavy = with_threshold(side, ratio, force, width)
            assert turns_back(heavy) is (side > 1)
            assert time_to_reach(heavy, 0.5) < inf if side < 1 else slow_motion(heavy).time_to(1.5) == inf
            larger = replace(heavy, shock=Shock((5 * force, 0, 0), 2.0, width))
            assert (slow_motion(larger).farthest < pi / 2) is (side > 1)


def test_where_the_next_order_decides_whether_x_turns_back_nothing_is_said() -> None:
    """A seventh beyond the threshold the exact motion goes on past the farthest x of the leading order."""
    heavy = with_threshold(1.15, 1.0, 38.0, 0.05)
    motion = slow_motion(heavy)
    assert np.sin(motion.farthest) < 0.3
    assert time_to_wander(heavy, 0.6, 110) > 0
    assert [motion.turns(share) for share in (0.0, 1.0)] == [True, False]
    with pytest.raises(DomainError, match="the next order of the averaged motion decides"):
        turns_back(heavy)
    with pytest.raises(DomainError, match="twists by more than 30° from the start"):
        turns_back(Scene((10, -10), link=Link(0.3), shock=Shock((35, 0, 0), 1.0, 0.05)))


@cache
def momenta_of_the_lean():
    """(beta, h, their rates, alpha', a, b, k, G_1, G_2) → the momenta of beta, h and alpha."""
    exact = leaning_lagrangian()
    letters = (*LEANING.q[:2], *LEANING.v, a, b, k, G_1, G_2)
    return sp.lambdify(letters, [exact.diff(v) for v in LEANING.v], "numpy", cse=True)


def leaning_states(run, k):
    """(beta, h, beta', h', alpha') of a run: along n × e_x lies 2 sin h cos chi of r_1 − r_2, sin chi = sin h/(k cos beta)."""
    n, n_v, d, d_v = (f(v[0], v[1]) for f in (np.add, np.subtract) for v in (run.axes, run.rates))
    size = np.linalg.norm(n, axis=1)[:, None]
    n, n_v = n / size, n_v / size
    n_v = n_v - n * (n * n_v).sum(1)[:, None]
    beta, c = np.arcsin(n[:, 0]), np.sqrt(1 - n[:, 0] ** 2)
    beta_v, c_v = n_v[:, 0] / c, -n[:, 0] * n_v[:, 0] / c
    e = np.cross(n, [1, 0, 0]) / c[:, None]
    e_v = np.cross(n_v, [1, 0, 0]) / c[:, None] - e * (c_v / c)[:, None]
    part_v = (d_v * e + d * e_v).sum(1)
    u = np.copysign(np.linalg.norm(d, axis=1) / 2, (d * e).sum(1))
    square = (k * c) ** 2
    u_v = part_v * np.sqrt(1 - u**2 / square) - 2 * u**3 * c_v / (square * c)
    h_v = u_v / (2 * (1 - 2 * u**2 / square)) / np.sqrt(1 - u**2)
    return beta, np.arcsin(u), beta_v, h_v, (n[:, 1] * n_v[:, 2] - n[:, 2] * n_v[:, 1]) / c**2


def changes(link: Link, size: float, push: float) -> tuple[float, float, float]:
    """By what part of s⁴ W, W + W_6 and W + 1.5 W_6 change on the exact motion from 15 to 45 degrees of lean.

    Of means over six swings of p_beta/(2 G), beta − p_h/(2 G) and (h − eta)² + sigma (p_h/(2 G))²: the centre and s².
    """
    pair = Scene((10, -10), link=link)
    G, area = pair.momenta[0], 0.05 * sqrt(pi)
    pair = replace(pair, shock=Shock((2 * size * G / area, push * size**2 * G / (pair.k * area), 0), 0.4, 0.05))
    motion, turn = slow_motion(pair), 2 * pi / natural_rate(pair)
    begin, average = pair.shock.end, _next_order()
    t = begin + np.arange(0, motion.time_to(np.radians(55)) + 9 * turn, turn / 24)
    run = simulate(pair, [0.0, *t], "minimal", 1e-10).after(begin)
    states = leaning_states(run, pair.k)
    p_beta, p_h, P = momenta_of_the_lean()(*states, *pair.inertias, pair.k, *pair.momenta)
    eta, lean = p_beta / (2 * G), states[0] - p_h / (2 * G)
    squares = (states[1] - eta) ** 2 + pair.sigma * (p_h / (2 * G)) ** 2
    assert np.ptp(P) < 1e-7 * size**2 * G
    rows = []
    for i in range(0, len(t) - 144, 72):
        beta, half, s2 = (mean_over(t[i : i + 145], v[i : i + 145]) for v in (lean, eta, squares))
        one = replace(motion, lean=beta, half=half, swing=sqrt(s2), momentum=pair.k * P.mean() / G)
        more = average(half**2, np.tan(beta) ** 2, one.swing, one.momentum, pair.sigma, pair.k)[0]
        rows.append((abs(beta), one.invariant, one.invariant + more, one.invariant + 1.5 * more))
    leans, *values = np.array(rows)[: int(np.argmax(np.array(rows)[:, 0])) + 1].T
    ends = [np.interp(np.radians((15, 45)), leans, v) for v in values]
    return tuple(float(abs(after - before)) / motion.swing**4 for before, after in ends)


@pytest.mark.parametrize(("link", "push"), [(Link(1.0), 1.0), (Link(1.5, 1.0, 0.1), 0.0)])
def test_the_next_order_is_conserved_two_orders_better_at_any_lean(link: Link, push: float) -> None:
    sizes = (0.14, 0.1)
    orders = [measured_order(sizes, change) for change in zip(*(changes(link, s, push) for s in sizes), strict=True)]
    assert orders[1] > 3.5
    assert max(orders[0], orders[2]) < 3  # twins: without it, and half as large again


def pushed_orbit(rng):
    """Opposite spins, a bar from 0.15 to 4 axes long, massless or up to 50 kg; the amplitude, the push and the exact orbit."""
    one, length = random_pair(rng, "opposite"), np.exp(rng.uniform(np.log(0.15), np.log(4)))
    mass = rng.choice([0, 1]) * np.exp(rng.uniform(np.log(0.01), np.log(50)))
    length *= one.rotor.length
    scene = replace(one, link=Link(length, mass, mass * length**2 * rng.choice([0.0, rng.uniform(0, 1)])))
    r0, share = 10 ** rng.uniform(-2, np.log10(0.4)), rng.choice([0.0, rng.uniform(-3, 3)])
    momentum = share * scene.sigma * r0**2 * scene.momenta[0] / scene.k
    orbit = exact_orbit(scene, r0)
    return scene, r0, momentum, _pushed(orbit, momentum) if momentum else orbit


@pytest.mark.skipif(not ENOUGH, reason="needs numbers of 64 bits")
@pytest.mark.parametrize(
    ("seed", "count", "steps"),
    [(8, 2, 20), *(pytest.param(seed, 2_500, 40, marks=pytest.mark.slow) for seed in range(2, 6))],
)
def test_the_slow_frequency_tells_its_error(seed: int, count: int, steps: int) -> None:
    """Against monodromies in 64 bits, of pushes up to three times sigma r0²."""
    rng, found, told = np.random.default_rng(seed), [], []
    while len(found) < count:
        try:
            scene, r0, momentum, orbit = pushed_orbit(rng)
            law, error = slow_frequency(scene, r0, momentum), slow_frequency_error(scene, r0, momentum)
        except DomainError:  # beyond the range, or the family ends before
            continue
        found.append(orbit)
        told.append((law, error, r0, momentum == 0))
    pairs = []
    for still in (True, False):
        those = [i for i, one in enumerate(told) if one[3] == still]
        exact = exact_orbits(
            [(found[i].scene, found[i].frequency) for i in those], [told[i][2] for i in those], steps, not still
        )
        for i, excess, quarter in zip(those, exact.excess, exact.time, strict=True):
            angle = 2 * np.arcsin(np.sqrt(-complex(excess)) / 2)  # excess = 2 cos(angle) − 2
            pairs.append((abs(told[i][0] - angle.conjugate() / (4 * float(quarter))), told[i][1]))
    held(pairs, 0, count, 0)
    assert max(off / error for off, error in pairs) > 0.9  # twin: nine tenths of it are no bound


AMPLITUDES = (0.06, 0.085, 0.12)


def distances(link: Link, share: float, change: float = 0.0) -> list[float]:
    """Relative distance of the slow frequency's square from exact multipliers, at d = share s²; by `change` r0² too large."""
    apart = []
    for r0 in AMPLITUDES:
        scene = Scene((-12, 12), link=link)
        momentum = share * scene.sigma * r0**2 * scene.momenta[0] / scene.k
        exact = (floquet(scene, r0, momentum).slow_frequency ** 2).real
        law = (slow_frequency(scene, r0, momentum) ** 2).real * (1 + change * r0**2)
        apart.append(abs(law / exact - 1))
    return apart


@pytest.mark.parametrize(
    ("link", "share"),
    [(Link(0.9, 1.1, 0.1), 0.0), (Link(1.2, 0.0), 0.5), (Link(1.2, 0.0), -0.5), (Link(0.9, 0.6), 0.3)],
)
def test_the_slow_frequency_is_right_to_fourth_order(link: Link, share: float) -> None:
    assert measured_order(AMPLITUDES, distances(link, share)) == pytest.approx(4, abs=0.15)
    assert measured_order(AMPLITUDES, distances(link, share, 1.0)) < 2.5


@pytest.mark.parametrize(
    ("link", "share"), [(Link(0.8, 0.5, 0.1), -0.5), (Link(1.5, 1.0, 0.1), -0.5), (Link(1.0), 2.0)]
)
def test_the_momentum_is_beyond_that_of_the_exact_precession(link: Link, share: float) -> None:
    """Twin: less G s²/k, the precession's momentum to leading order, the law is three times and more as far off."""
    scene, r0 = Scene((10, -10), link=link), 0.2 if share < 0 else 0.1
    G, square = scene.momenta[0], scene.sigma * r0**2
    start, push = MODEL.start(exact_orbit(scene, r0).scene), share * square * G / scene.k
    precession = 2 * sum(scene.inertias) * (1 - r0**2) * start[5]
    law, exact = slow_frequency(scene, r0, push), floquet(scene, r0, push).slow_frequency
    other = floquet(scene, r0, push + G * square / scene.k - precession).slow_frequency
    assert abs(law / exact - 1) < 0.01 and slow_frequency_error(scene, r0, push) < 0.01 * abs(exact)
    assert abs(law / other - 1) > 3 * abs(law / exact - 1)


def test_a_push_in_one_sense_holds_a_massless_bar_and_in_the_other_does_not() -> None:
    scene = Scene((10, -10))
    held, lost = slow_frequency(scene, 0.1, 0.05), slow_frequency(scene, 0.1, -0.05)
    assert held.real > 0 == held.imag
    assert lost.imag > 0 and abs(lost.real) < 1e-12 * lost.imag


def test_refused() -> None:
    shocked = Scene((10, -10), shock=Shock((40, 0, 0), 1.0, 0.05))
    with pytest.raises(DomainError, match="x = 1 must lie"):
        time_to_reach(shocked, 1.0)
    with pytest.raises(DomainError, match="the pair twists by"):
        time_to_reach(shocked, 0.95)
    with pytest.raises(DomainError, match="rad against each other"):
        turns_back(replace(shocked, shock=Shock((400, 0, 0), 1.0, 0.05)))
    with pytest.raises(InputError, match="opposite spins"):
        turns_back(replace(shocked, spins=(10.0, 9.0)))
    with pytest.raises(InputError, match="opposite spins"):
        slow_frequency(Scene((10, 10)), 0.1)
    with pytest.raises(DomainError, match=r"beyond the law's range: at k = 1, sigma = 1 the next order is 40 of the"):
        slow_frequency(Scene((10, -10)), 0.1, 400.0)
    with pytest.raises(DomainError, match="the next order is"):
        slow_frequency(Scene((10, -10), link=Link(0.2)), 0.12)
    for momentum in (None, "x", np.nan):
        with pytest.raises(InputError, match="momentum"):
            slow_frequency(Scene((10, -10)), 0.1, momentum)
    with pytest.raises(InputError, match="x = None"):
        time_to_reach(shocked, None)
    with pytest.raises(InputError, match="needs a bar"):
        slow_frequency(None, 0.1)
    assert cos(slow_motion(shocked).farthest) < 1e-15
