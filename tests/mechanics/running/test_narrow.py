"""Forces that are narrow in a coordinate or a velocity, against the time of passage, an integral over the place alone."""

import warnings
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad

from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.mechanics import Event, System, SystemRun, coordinates
from lagrotor.mechanics.running import simulation
from lagrotor.mechanics.running.singular_positions import unbounded_force

A, W, C = 0.1, sp.Symbol("w", positive=True), 0.3
LINE = coordinates("x")
(X,), (V,) = LINE.q, LINE.v
SHAPES = {
    "a bump": lambda u: sp.exp(-(u**2)),
    "an odd bump": lambda u: u * sp.exp(-(u**2)),
    "a Lorentzian": lambda u: 1 / (1 + u**2),
    "a step": lambda u: sp.tanh(u),
    "a flat bump": lambda u: sp.exp(-(u**4)),
}
T = np.linspace(0, 2.5, 4)


def numbers(shape: str, width: float) -> Callable[[float], float]:
    u, bound = sp.Symbol("u", real=True), np.inf if shape == "a Lorentzian" else 25.0
    f = sp.lambdify(u, SHAPES[shape](u), "scipy")
    return lambda x: float(f(np.clip((x - C) / width, -bound, bound)))


def passage(slowness: Callable[[float], float], end: float, width: float) -> float:
    """The integral of the slowness from 0 to `end`, with its narrow part apart."""
    edges = [0.0, *(C + width * k for k in (-1e3, -30, -6, -2, 0, 2, 6, 30, 1e3) if 0 < C + width * k < end), end]
    return sum(quad(slowness, a, b, epsabs=1e-14, epsrel=1e-13, limit=400)[0] for a, b in pairwise(edges))


def hill(shape: str) -> System:
    return System(LINE, V**2 / 2 - A * SHAPES[shape]((X - C) / W))


def off(run: SystemRun, shape: str, width: float) -> float:
    """How far the last place is off, with the velocity 1 at x = 0: by its time of passage."""
    f = numbers(shape, width)
    late = passage(lambda x: (1 - 2 * A * (f(x) - f(0.0))) ** -0.5, float(run.q[-1, 0]), width) - T[-1]
    return abs(late * float(run.v[-1, 0])) / 2.5


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("width", "tol"), [(0.1, 1e-6), (3e-3, 1e-9), (1e-4, 1e-5), (1e-5, 1e-10)])
def test_no_step_passes_over_a_narrow_part(shape: str, width: float, tol: float) -> None:
    run = hill(shape).simulate({W: width}, (0,), (1,), T, tol)
    assert off(run, shape, width) <= run.error + 1e-13 and run.error < tol


def test_a_run_that_does_not_follow_it_is_silently_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """The twin."""
    monkeypatch.setattr(simulation, "narrow_parts", lambda *given: ())
    run = hill("a bump").simulate({W: 1e-4}, (0,), (1,), T, 1e-9)
    assert off(run, "a bump", 1e-4) > 1e3 * run.error


@pytest.mark.parametrize("how", [{"engine": "fast"}, {"events": Event(X - 100)}])
def test_the_fast_engine_and_phases_follow_it(how: dict[str, object]) -> None:
    if "engine" in how:
        pytest.importorskip("heyoka")
    run = hill("a bump").simulate({W: 1e-4}, (0,), (1,), T, 1e-9, **how)
    assert off(run, "a bump", 1e-4) <= run.error < 1e-9
    assert run.at(T[1:3]).q == pytest.approx(run.q[1:3], abs=1e-9)


def test_a_part_of_two_coordinates_and_one_of_a_velocity() -> None:
    """r = x − y has the mass 1/2; x'' = 1 + 50 f(x') takes the time ∫ dv/(1 + 50 f)."""
    c, width = coordinates("x y"), 1e-4
    (x, y), (vx, vy) = c.q, c.v
    two = System(c, (vx**2 + vy**2) / 2 - A / 2 * SHAPES["a bump"]((x - y - C) / W))
    run = two.simulate({W: width}, (0, 0), (1 / 2, -1 / 2), T)
    f = numbers("a bump", width)
    late = passage(lambda r: (1 - 2 * A * (f(r) - f(0.0))) ** -0.5, float(run.q[-1, 0] - run.q[-1, 1]), width) - T[-1]
    assert abs(late) < 1e-8 and run.error < 1e-9
    pushed = System(LINE, V**2 / 2, forces=[1 + 50 * SHAPES["a bump"]((V - C) / W)])
    run = pushed.simulate({W: width}, (0,), (0,), [0, 1])
    assert abs(passage(lambda v: 1 / (1 + 50 * f(v)), float(run.v[-1, 0]), width) - 1) < 1e-8


POWERS = {
    "a cosine": (lambda n: sp.cos(X - C) ** n, lambda x, n: np.cos(x - C) ** n),
    "a Lorentzian": (lambda n: (1 + (X - C) ** 2) ** -n, lambda x, n: (1 + (x - C) ** 2) ** -n),
}


@pytest.mark.parametrize("shape", POWERS)
def test_a_power_with_a_large_exponent_is_narrow(shape: str) -> None:
    """Each is like exp(−n (x − c)²/2) or exp(−n (x − c)²)."""
    exponent, (expression, f), n = sp.Symbol("n", positive=True), POWERS[shape], 1e7
    bump = System(LINE, V**2 / 2 - A * expression(exponent))
    run = bump.simulate({exponent: n}, (0,), (1,), T, 1e-9)
    late = passage(lambda x: (1 - 2 * A * (f(x, n) - f(0.0, n))) ** -0.5, float(run.q[-1, 0]), n**-0.5) - T[-1]
    assert abs(late) <= 2.5 * run.error + 1e-13 and run.error < 1e-9


SWING = System(LINE, V**2 / 2 - X**2 / 2)
PAST_BUMP = System(LINE, V**2 / 2 - X**2 / 2 - A / 2 * SHAPES["a bump"]((X - C) / W))
SECTIONS = {
    "a bump as a section": (SWING, 1e-9, sp.exp(-(((X - C) / 1e-3) ** 2)) - sp.Rational(1, 2), 4),
    "a narrower one": (SWING, 1e-9, sp.exp(-(((X - C) / 1e-6) ** 2)) - sp.Rational(1, 2), 4),
    "a step within tol of zero": (PAST_BUMP, 1e-5, X - C, 2),
    "two zeros in a bump": (PAST_BUMP, 1e-9, (X - C) * (X - C - 1e-4), 4),
    "zero all along": (SWING, 1e-9, V**2 + X**2 - 1, 0),
}


@pytest.mark.parametrize("kind", SECTIONS)
def test_no_crossing_of_a_narrow_section_or_in_short_steps_is_lost(kind: str) -> None:
    """Of x = cos t, which passes 0.3 twice in 6 s."""
    system, tol, section, count = SECTIONS[kind]
    run = system.simulate({W: 1e-5 if count == 2 else 1e-4}, (1,), (0,), [0, 6], tol)
    assert len(run.crossings(section).t) == count


def test_a_run_that_is_read_again_follows_what_is_narrow(tmp_path: Path) -> None:
    """Its two samples are a period apart, so that they show no swing."""
    run = PAST_BUMP.simulate({W: 1e-4}, (1,), (0,), [0, 1e-3, 2 * np.pi], 1e-9)
    run.save(tmp_path / "run.npz")
    again = SystemRun.load(tmp_path / "run.npz", PAST_BUMP)
    assert len(again.switched.narrow) == 1
    assert again.at([6.0]).q == pytest.approx(run.at([6.0]).q, abs=1e-12)


def test_where_nothing_is_narrow_nothing_is_followed() -> None:
    """Of a power that is zero at one place, Kepler's, each scale is as narrow as another, and solvers follow it."""
    c = coordinates("x y")
    (x, y), (vx, vy) = c.q, c.v
    kepler = System(c, (vx**2 + vy**2) / 2 + (x**2 + y**2) ** sp.Rational(-1, 2))
    assert kepler.simulate({}, (1, 0), (0, 0.5), T).switched.narrow == ()
    morse = System(LINE, V**2 / 2 - (1 - sp.exp(-X)) ** 2)
    assert morse.simulate({}, (1,), (0,), T).switched.narrow == ()
    (part,) = hill("a step").simulate({W: 0.01}, (0,), (1,), T).switched.narrow
    assert part.term == sp.tanh((X - C) / W)


def test_a_step_that_is_followed_does_not_warn_and_one_beyond_all_digits_is_named() -> None:
    """A tanh step of 6×10⁻⁵ of the swing, passed after the sample at 1.2 s, up to which tol is kept."""
    step = System(LINE, V**2 / 2 - X**2 / 2 - A * SHAPES["a step"]((X - C) / W))
    t = np.linspace(0, 6, 11)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for tol in (1e-8, 1e-9, 1e-10):
            assert step.simulate({W: 1.3e-4}, (1,), (0,), t, tol).error <= tol
    with pytest.warns(
        LagrotorWarning, match=r"tanh.* of the swing, first between t = 1.2 and 1.8 s.*Event or an Impact"
    ):
        assert step.simulate({W: 1.3e-4}, (1,), (0,), t, 1e-13).horizon >= 1.2


def test_a_tight_tolerance_of_a_stiff_motion_is_kept_without_a_word() -> None:
    """Van der Pol's oscillator."""
    k = sp.Symbol("k", positive=True)
    oscillator = System(LINE, V**2 / 2 - X**2 / 2, forces=[k * (1 - X**2) * V])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = oscillator.simulate({k: 41.55}, (2,), (0,), np.linspace(0, 30, 11), 4.5e-12)
    assert run.error < 4.5e-12


def test_a_collision_is_said() -> None:
    """Two bodies at rest meet after π/(2√2)."""
    c = coordinates("x y")
    (x, y), (vx, vy) = c.q, c.v
    fall = System(c, (vx**2 + vy**2) / 2 + (x**2 + y**2) ** sp.Rational(-1, 2))
    with pytest.warns(LagrotorWarning, match="the force grows without bound there"):
        ending = fall.simulate({}, (1, 0), (0, 0), np.linspace(0, 2, 11)).ending
    assert ending.kind == "singular" and ending.at == pytest.approx(np.pi / 8**0.5, rel=1e-6)


@pytest.mark.parametrize(("stiffness", "end"), [(1e12, 1e4), (1e30, 1.0)])
def test_a_run_beyond_all_patience_is_refused_at_once(stiffness: float, end: float) -> None:
    k = sp.Symbol("k", positive=True)
    spring = System(LINE, V**2 / 2 - k * X**2 / 2)
    with pytest.raises(IntegrationError, match=r"turns and takes .*×10.* evaluations, more than"):
        spring.simulate({k: stiffness}, (1,), (0,), np.linspace(0, end, 5), 1e-6)
    assert spring.simulate({k: stiffness}, (1,), (0,), [0, 1e3 * stiffness**-0.5], 1e-6).ending.kind == "end"


@pytest.mark.parametrize(("end", "words"), [((1, 0), False), ((1e3, 0), False), ((1e-6, 1e3), True)])
def test_only_a_force_that_has_grown_is_said_to_grow_without_bound(end: tuple[float, float], words: bool) -> None:
    """x'' = −10⁸ x, and −1/x², where a solver stops with sizes that show none of it."""
    potential = -1 / X if words else 5e7 * X**2
    fall, sizes = System(LINE, V**2 / 2 - potential), np.array([1.0, 1e-4])
    assert bool(unbounded_force(fall, {}, np.array([1.0, 0.0]), np.array(end, float), sizes)) == words


def test_progress_is_called_with_times() -> None:
    spring, times = System(LINE, V**2 / 2 - X**2 / 2), list[float]()
    for events in ((), Event(X + 2)):
        times.clear()
        spring.simulate({}, (1,), (0,), [0, 5], events=events, progress=times.append)
        assert len(times) > 10 and min(times) >= 0 and 4 < max(times) <= 5
