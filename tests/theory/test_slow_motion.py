"""The averaged motion of opposite spins: its curves against its own equations, its laws against exact orbits and runs."""

from dataclasses import replace
from math import inf, pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrotor import Link, Scene, Shock, floquet, natural_rate, shock_response
from lagrotor.errors import DomainError, InputError
from lagrotor.models import exact_orbit, slow_frequency_error, time_to_reach_error, time_to_wander
from lagrotor.models.minimal import MODEL
from lagrotor.numerics import measured_order
from lagrotor.theory import SlowMotion, slow_frequency, slow_motion, slow_rates, time_to_reach, turns_back


def random_motion(rng: np.random.Generator) -> SlowMotion:
    """A light or a heavy bar, any sense of turning, started near upright; centre and swing of 0.03."""
    half, lean = rng.uniform(-1, 1, 2)
    momentum = rng.choice([0.0, rng.uniform(-2, 2)])
    return SlowMotion(
        lean, 0.03 * half, 0.03 * rng.uniform(0.2, 1), 9e-4 * momentum, rng.choice([0.0, rng.uniform(-1, 6)]), 1.0, 3.0
    )


@pytest.mark.parametrize("seed", range(6))
def test_the_motion_obeys_its_equations_until_it_turns(seed: int) -> None:
    """Against the equations in plain time; W stays, and where the lean is farthest it turns."""
    motion = random_motion(np.random.default_rng(seed))
    goal = abs(motion.lean) + 0.6 * (motion.farthest - abs(motion.lean))

    def there(t: float, y: np.ndarray) -> float:
        return abs(y[0]) - goal

    there.terminal = True  # type: ignore[attr-defined]
    unit = 1 / (motion.rate * motion.swing * (motion.swing**2 + motion.half**2 + abs(motion.momentum)))
    options = {"rtol": 1e-10, "atol": 1e-13, "method": "LSODA", "events": there, "max_step": unit / 4}
    run = solve_ivp(lambda t, y: motion._slopes(*y), (0, 60 * unit), (motion.lean, motion.half), **options)
    time, lean, half = motion._until(goal)
    assert (time, lean) == pytest.approx((run.t[-1], goal), rel=1e-5)
    assert replace(motion, lean=lean, half=half).invariant == pytest.approx(motion.invariant, rel=1e-6)
    if motion.farthest < pi / 2:
        time, lean, half = motion._until(motion.farthest * (1 + 1e-6))
        assert time == inf and abs(motion._slopes(lean, half)[0]) < 1e-6 / unit


@pytest.mark.parametrize("size", [1e-12, 1e-8, 1e-3])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_lean_that_starts_where_it_turns_grows_as_the_cosh_or_swings(size: float, side: int) -> None:
    """eta = 0 and s² << |p|, beta small: beta'' = g² p³ beta. The shock along y that starts it so."""
    motion = SlowMotion(side * size, 0.0, size, 1e4 * size**2, 2.0, 1.0, 3.0)
    assert motion._until(10 * size)[0] == pytest.approx(np.arccosh(10) / (3 * (100 * size) ** 3), rel=5e-3)
    held = replace(motion, momentum=-motion.momentum)
    assert held.farthest == pytest.approx(size, rel=1e-9)
    assert held._until(2 * size)[0] == inf
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
    assert motion._slopes(0.7, 0.05) == pytest.approx(exact, rel=1e-12)
    x, y1, y2 = shock_response(scene).displacement
    assert (motion.lean, motion.half) == pytest.approx((x, (y1 - y2) / 2))


@pytest.mark.parametrize(("link", "spin"), [(Link(1.1, 0.0), 11.0), (Link(0.8, 1.0, 0.02), -14.0)])
def test_x_is_reached_in_time(link: Link, spin: float) -> None:
    scene = Scene((spin, -spin), link=link, shock=Shock((38, 0, 0), 0.4, 0.05))
    law = time_to_reach(scene, 0.3)
    exact = time_to_wander(scene, 0.3, 1.5 * law)
    assert exact == pytest.approx(law, rel=0.15)
    assert time_to_reach_error(scene, 0.3) == pytest.approx(abs(exact - law), abs=0.05)


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
            assert time_to_reach(heavy, 0.5) < inf if side < 1 else slow_motion(heavy)._until(1.5)[0] == inf
            larger = replace(heavy, shock=Shock((5 * force, 0, 0), 2.0, width))
            assert (slow_motion(larger).farthest < pi / 2) is (side > 1)


def test_where_the_next_order_decides_whether_x_turns_back_nothing_is_said() -> None:
    """A seventh beyond the threshold the exact motion goes on past the farthest x of the leading order."""
    heavy = with_threshold(1.15, 1.0, 38.0, 0.05)
    motion = slow_motion(heavy)
    assert np.sin(motion.farthest) < 0.3
    assert time_to_wander(heavy, 0.6, 110) > 0
    with pytest.raises(DomainError, match="the next order of the averaged motion decides"):
        turns_back(heavy)
    with pytest.raises(DomainError, match="twists by more than 30° from the start"):
        turns_back(Scene((10, -10), link=Link(0.3), shock=Shock((35, 0, 0), 1.0, 0.05)))


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
    [(Link(0.9, 1.1, 0.1), 0.0), (Link(1.2, 0.0), -0.5)],
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
    assert abs(law - exact) <= slow_frequency_error(scene, r0, push) < 0.01 * abs(exact)
    assert abs(law / other - 1) > 3 * abs(law / exact - 1)


def test_a_push_in_one_sense_holds_a_massless_bar_and_in_the_other_does_not() -> None:
    scene = Scene((10, -10))
    held, lost = slow_frequency(scene, 0.1, 0.05), slow_frequency(scene, 0.1, -0.05)
    assert held.real > 0 == held.imag
    assert lost.imag > 0 and abs(lost.real) < 1e-12 * lost.imag


SHOCKED = Scene((10, -10), shock=Shock((40, 0, 0), 1.0, 0.05))
REFUSALS = [
    (lambda: time_to_reach(SHOCKED, 1.0), "x = 1 must lie"),
    (lambda: time_to_reach(SHOCKED, 0.95), "the pair twists by"),
    (lambda: time_to_reach(SHOCKED, None), "x = None"),
    (
        lambda: time_to_reach_error(replace(SHOCKED, shock=Shock((0.1, 0, 0), 1.0, 0.05)), 0.5),
        "swings, more than 10000",
    ),
    (lambda: time_to_wander(SHOCKED, 1e-3, 1.0), "within the first swings"),
    (lambda: time_to_wander(SHOCKED, 0.9, 1.0), "not reached within 1 s"),
    (lambda: turns_back(replace(SHOCKED, shock=Shock((400, 0, 0), 1.0, 0.05))), "rad against each other"),
    (lambda: turns_back(replace(SHOCKED, spins=(10.0, 9.0))), "opposite spins"),
    (lambda: slow_frequency(Scene((10, 10)), 0.1), "opposite spins"),
    (lambda: slow_frequency(Scene((10, -10)), 0.1, 400.0), "range: at k = 1, sigma = 1 the next order is 40 of the"),
    (lambda: slow_frequency(Scene((10, -10), link=Link(0.2)), 0.12), "the next order is"),
    (lambda: slow_frequency(Scene((10, -10)), 0.1, "x"), "momentum"),
    (lambda: slow_frequency(Scene((10, -10)), 0.1, np.nan), "momentum"),
    (lambda: slow_frequency(None, 0.1), "needs a bar"),
]


@pytest.mark.parametrize(("call", "message"), REFUSALS, ids=[message for _, message in REFUSALS])
def test_refused(call, message: str) -> None:
    with pytest.raises((DomainError, InputError), match=message):
        call()
    assert slow_motion(SHOCKED).farthest == pi / 2
