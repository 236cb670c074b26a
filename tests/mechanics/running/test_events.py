"""Sections, impacts and accumulations, each against a textbook's closed form, and a twin that is elsewhere."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.mechanics import Event, Impact, System, SystemRun, coordinates, t
from lagrotor.mechanics.running import phases

C = coordinates("x")
(x,), (v,) = C.q, C.v
g, e, w = sp.symbols("g e omega", positive=True)
OSCILLATOR, BALL = System(C, v**2 / 2 - x**2 / 2), System(C, v**2 / 2 - g * x)


def test_a_run_of_too_many_events_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball from 1 m bounces without loss, first after sqrt(2/g), then each 2 sqrt(2/g)."""
    first = np.sqrt(2 / 9.81)
    for most, ends in ((8, "end"), (5, "budget")):
        monkeypatch.setattr(phases, "MOST_EVENTS", phases.MOST_EVENTS._replace(value=most))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LagrotorWarning)
            run = BALL.simulate({g: 9.81}, (1,), (0,), np.linspace(0, 15.5 * first, 32), 1e-6, events=Impact(x))
        assert run.ending.kind == ends
    assert run.t[-1] == pytest.approx(11 * first) and "5 events" in run.ending.reason


@settings(max_examples=8, deadline=None)
@given(st.integers(2, 12), st.floats(5, 100), st.floats(-0.95, 0.95))
def test_every_crossing_is_on_its_section_however_few_times_are_read(n: int, duration: float, level: float) -> None:
    """x = cos t: upward through the level at 2πk − acos, downward at 2πk + acos."""
    run = OSCILLATOR.simulate({}, (1,), (0,), np.linspace(0, duration, n), 1e-10)
    turns, first = 2 * np.pi * np.arange(20), np.arccos(level)
    for direction, times in ((-1, turns + first), (1, turns + 2 * np.pi - first)):
        crossings = run.crossings(x - level, direction)
        expected = times[times < duration - 1e-6]
        assert crossings.t[: len(expected)] == pytest.approx(expected, abs=1e-7)
        assert len(crossings.t) - len(expected) in (0, 1)
        assert np.abs(crossings.q - level).max(initial=0) < 1e-10
        assert (np.sign(crossings.v) == direction).all()
    assert len(run.crossings(x - level).t) == len(run.crossings(x - level, 1).t) + len(run.crossings(x - level, -1).t)


@pytest.mark.parametrize(("samples", "tol"), [(21, 1e-9), (41, 1e-3), (61, 1e-7)])
def test_a_crossing_at_a_sample_is_one_and_in_its_direction(samples: int, tol: float) -> None:
    """x = cos t read where x is zero: rounding decides on which side of the sample the zero falls."""
    run = OSCILLATOR.simulate({}, [1.0], [0.0], t=np.linspace(0.5 * np.pi, 20.5 * np.pi, samples), tol=tol)
    for section in (x, v - sp.Rational(1, 10**12), x + v):
        for direction in (1, -1):
            there = run.crossings(section, direction)
            assert np.diff(there.t) == pytest.approx(2 * np.pi, abs=10 * tol)
            assert len(there.t) in (9, 10)
            rates = {x: v, v - sp.Rational(1, 10**12): -x, x + v: v - x}[section]
            assert (np.sign(there.evaluate(rates)) == direction).all()


def test_crossings_on_a_gap_hold_both_sides_of_an_impact_and_are_kept(tmp_path: Path) -> None:
    """A ball from 1 m with e = 4/5: v = ∓√2 (4/5)ⁿ. What has no times is refused in words, was an IndexError or lost."""
    events = (Impact(x, sp.Rational(4, 5)),)
    run = BALL.simulate({g: 1}, (1,), (0,), (0, 4.0), 1e-9, events=events)
    both = run.crossings(x)
    assert both.v[:, 0] == pytest.approx(np.sqrt(2) * np.array([-1, 0.8, -0.8, 0.64]), abs=1e-9)
    assert both.evaluations > run.evaluations
    again = SystemRun.load(both.save(tmp_path / "both.npz"), BALL, events)
    assert (again.states == both.states).all() and (again.t == both.t).all()
    none = run.crossings(x - 5)
    assert none.save(tmp_path / "none.csv").read_text().count("\n") == 1
    lines = [[(0, 0, 0), (0, 0, x)]]
    for refused in (
        lambda: none.save(tmp_path / "none.npz"),
        lambda: none.animate(tmp_path / "none.gif", lines=lines),
        lambda: none.view(lines),
        lambda: none.at([1.0]),
        lambda: none.after(1.0),
    ):
        with pytest.raises(InputError, match="the run has no times"):
            refused()


def test_a_section_that_is_only_touched_is_found_and_one_that_is_missed_is_not() -> None:
    run = OSCILLATOR.simulate({}, (1,), (0,), np.linspace(0, 20, 3), 1e-9)
    assert run.crossings(x - 1).t == pytest.approx(2 * np.pi * np.arange(1, 4), abs=1e-4)
    assert len(run.crossings(x - 1, 1).t) == len(run.crossings(x - 1 - sp.Rational(1, 10**6)).t) == 0
    near = run.crossings(x - 1 + sp.Rational(1, 10**6))  # twice each time, 2.8 ms apart
    assert len(near.t) == 7 and np.abs(near.q - 1 + 1e-6).max() < 1e-9


def test_fast_sections_are_resolved_and_what_cannot_be_is_announced() -> None:
    run = OSCILLATOR.simulate({}, (1,), (0,), (0, 3.0), 1e-9)
    assert len(run.crossings(sp.sin(300 * x)).t) == int(300 / np.pi) + int(-300 * np.cos(3) / np.pi) + 1
    with pytest.warns(LagrotorWarning, match="crossings may be hidden"):
        run.crossings(sp.sin(1 / (x + sp.Rational(1, 2))))


def henon_heiles(samples: int) -> tuple[SystemRun, sp.Expr]:
    c = coordinates("x y")
    (a, b), (a_v, b_v) = c.q, c.v
    system = System(c, (a_v**2 + b_v**2 - a**2 - b**2) / 2 - a**2 * b + b**3 / 3)
    return system.simulate({}, (0, 0.1), (0.4, 0.1), np.linspace(0, 60, samples), 1e-8), a


def van_der_pol(mu: float, duration: float, samples: int) -> tuple[SystemRun, sp.Expr]:
    system = System(C, v**2 / 2 - x**2 / 2, forces=(mu * (1 - x**2) * v,))
    return system.simulate({}, (2,), (0,), np.linspace(0, duration, samples), 1e-6), x


def bumpy(samples: int) -> tuple[SystemRun, sp.Expr]:
    """A bump 1/50 wide, over which v falls by 0.1 for 0.04 s: 0.95 is crossed four times in each half turn to the right."""
    system = System(C, v**2 / 2 - x**2 / 2 - sp.exp(-(((x - sp.Rational(1, 10)) * 50) ** 2)) / 10)
    return system.simulate({}, (-1,), (0,), np.linspace(0, 12.5, samples), 1e-8), v - sp.Rational(95, 100)


# Times of crossings by scipy: DOP853 with events, rtol 1e-12; of the stiff one Radau, rtol 1e-11.
SOUGHT = {
    "two samples": (lambda: henon_heiles(2), 18, [2.96674186, 6.4409149, 9.89681531]),
    "6,001 samples": (lambda: henon_heiles(6001), 18, [2.96674186, 6.4409149, 9.89681531]),
    "stiff": (lambda: van_der_pol(1000, 3000, 301), 3, [807.08474082, 1614.28530372, 2421.48586662]),
    "relaxation": (lambda: van_der_pol(20, 100, 2001), 5, [16.92174302, 34.26290467, 51.60406633]),
    "narrow": (lambda: bumpy(3), 8, [1.2532359, 1.65349752, 1.69347848, 1.89240504]),
    "impacts": (lambda: (BALL.simulate({g: 1}, (1,), (0,), np.linspace(0, 4, 2001), events=Impact(x, 0.8)), x), 4, []),
}


@pytest.mark.parametrize("kind", SOUGHT)
@pytest.mark.filterwarnings("ignore::lagrotor.errors.LagrotorWarning")
def test_crossings_cost_no_more_than_twice_the_run_and_none_is_lost(kind: str) -> None:
    """However many samples there are; by DOP853 from each to the next, 6,001 cost four runs, 2,001 of impacts fifty."""
    make, count, times = SOUGHT[kind]
    run, section = make()
    there = run.crossings(section)
    assert there.evaluations - run.evaluations <= 2 * run.evaluations
    assert len(there.t) == count
    assert there.t[: len(times)] == pytest.approx(times, abs=max(1e-6, 10 * run.error * run.t[-1]))


def test_crossings_of_a_run_that_is_lost_are_sought_as_it_went_on() -> None:
    """Beyond the horizon of a double pendulum its run goes on at a loose local error, and so do its crossings."""
    c = coordinates("a b")
    (a, b), (a_v, b_v) = c.q, c.v
    double = System(c, a_v**2 + b_v**2 / 2 + a_v * b_v * sp.cos(a - b) + 2 * sp.cos(a) + sp.cos(b))
    with pytest.warns(LagrotorWarning, match="motions separate"):
        run = double.simulate({}, (2, 2.5), (0, 0), np.linspace(0, 250, 251), 1e-9)
    assert run.ending.kind == "lost"
    there = run.crossings(b_v)
    assert there.evaluations <= 3 * run.evaluations
    assert len(there.t) > 50 and run.scales.distance(run.at(there.t).states, there.states).max() < 1e-3


def test_what_may_hide_an_event_is_announced_by_the_clock_of_the_run() -> None:
    fast = Event(sp.sin(1 / (x - 1 / sp.Integer(2))) + sp.Rational(11, 10))  # never zero, but too fast near x = 1/2
    with pytest.warns(LagrotorWarning, match=r"between t = 101\.0\d+ and 101\.0\d+ s a condition"):
        run = OSCILLATOR.simulate({}, (1,), (0,), (100, 103.0), 1e-6, events=fast)
    assert run.t[-1] == 103 and run.q[-1, 0] == pytest.approx(np.cos(3), abs=1e-6)


def test_a_section_may_move_and_depend_on_velocities() -> None:
    run = OSCILLATOR.simulate({}, (1,), (0,), (0, 30.0), 1e-10)
    moved = run.crossings(x - sp.cos(2 * t))
    assert np.abs(np.cos(moved.t) - np.cos(2 * moved.t)).max() < 1e-9
    assert len(moved.t) == 14  # 2πk/3 up to 30
    assert np.abs(run.crossings(v - x / 2).evaluate(v - x / 2)).max() < 1e-9


def test_an_event_ends_a_run_with_the_state_on_its_section() -> None:
    run = BALL.simulate({g: 9.81}, (1,), (0,), np.linspace(0, 3, 31), events=Event(x))
    assert run.ending.kind == "event" and "x = 0" in str(run.ending)
    assert run.t[-1] == run.ending.at == pytest.approx(np.sqrt(2 / 9.81), rel=1e-12)
    assert abs(run.q[-1, 0]) < 1e-12 and run.v[-1, 0] == pytest.approx(-np.sqrt(2 * 9.81), rel=1e-12)
    upward = BALL.simulate({g: 9.81}, (1,), (0,), (0, 0.3), events=Event(x, direction=1))
    assert upward.ending.kind == "end" and upward.t[-1] == 0.3


def flight(times: np.ndarray, restitution: float) -> np.ndarray:
    """A ball let fall from the height one, g = 9.81: its height."""
    speed, begin, heights = np.sqrt(2 * 9.81), -np.sqrt(2 / 9.81), np.zeros(len(times))
    while speed > 1e-9 and begin < times[-1]:
        since = times - begin
        inside = (since >= 0) & (since < 2 * speed / 9.81)
        heights[inside] = speed * since[inside] - 9.81 * since[inside] ** 2 / 2
        begin, speed = begin + 2 * speed / 9.81, speed * restitution
    return heights


@settings(max_examples=5, deadline=None)
@given(st.floats(0.3, 0.9))
def test_a_ball_bounces_infinitely_often_and_comes_to_rest(restitution: float) -> None:
    """The impacts accumulate at sqrt(2 h/g) (1 + e)/(1 − e)."""
    end = np.sqrt(2 / 9.81) * (1 + restitution) / (1 - restitution)
    times = np.linspace(0, 1.3 * end, 200)
    run = BALL.simulate({g: 9.81, e: restitution}, (1,), (0,), times, 1e-8, events=Impact(x, e))
    assert np.abs(run.q[:, 0] - flight(times, restitution)).max() < 1e-6
    assert (run.q[times > end] == pytest.approx(0, abs=1e-9)) and (run.v[times > end] == pytest.approx(0, abs=1e-9))
    assert "impacts on x accumulate" in str(run.ending)
    assert run.ending.reason and float(run.ending.reason.split("t = ")[1].split(" s")[0]) == pytest.approx(
        end, rel=1e-5
    )
    # Its twin with another restitution is elsewhere.
    assert np.abs(run.q[:, 0] - flight(times, restitution - 0.05)).max() > 1e-3


def test_what_does_not_rebound_is_held_while_it_is_pushed_and_let_go_when_it_is_pulled() -> None:
    """A mass on a table that goes up and down, A cos ωt with A ω² > g: it leaves where the table is pulled away from it."""
    A = sp.Rational(1, 10)
    gap = x - A * sp.cos(w * t)
    run = BALL.simulate(
        {g: 9.81, w: 12.0}, (-0.1,), (0,), np.linspace(np.pi / 12, np.pi / 12 + 0.45, 451), 1e-9, events=Impact(gap, 0)
    )
    above = run.evaluate(gap.subs(w, 12))
    left = run.t[np.argmax(above > 1e-7)]
    # Contact ends where the table's acceleration −A ω² cos ωt falls to −g.
    expected = (2 * np.pi - np.arccos(9.81 / (0.1 * 144))) / 12
    assert left == pytest.approx(expected, abs=5e-3)
    assert above.min() > -1e-9


def test_a_plastic_impact_projects_the_velocities_in_the_mass_metric() -> None:
    """A rod that falls and is caught at one end: angular momentum about that end is kept (Goldstein, ch. 5)."""
    c = coordinates("z theta")
    m, l = 2.0, 0.6
    rod = System(c, m * c.v[0] ** 2 / 2 + m * l**2 / 24 * c.v[1] ** 2 - m * 9.81 * c.q[0])
    end = c.q[0] - l / 2 * sp.cos(c.q[1])
    start = (1.0, 1.2), (0.0, 0.4)
    run = rod.simulate({}, *start, np.linspace(0, 0.5, 51), 1e-10, events=Impact(end, 0))
    before = rod.simulate({}, *start, np.linspace(0, 0.5, 51), 1e-10, events=Event(end))
    (z_v, spin), angle = before.v[-1], before.q[-1, 1]
    arm = l / 2 * np.sin(angle)
    after = (m * l**2 / 12 * spin - m * arm * z_v) / (m * l**2 / 12 + m * arm**2)
    caught = run.at([before.t[-1] + 1e-7])
    assert caught.v[0, 1] == pytest.approx(after, rel=1e-4)
    assert caught.v[0, 0] == pytest.approx(-arm * after, rel=1e-4)


def test_a_billiard_ball_between_four_walls_is_where_its_unfolded_straight_line_is() -> None:
    c = coordinates("x y")
    free = System(c, (c.v[0] ** 2 + c.v[1] ** 2) / 2)
    walls = tuple(Impact(gap) for gap in (c.q[0], 1 - c.q[0], c.q[1], 1 - c.q[1]))
    run = free.simulate({}, (0.3, 0.2), (1.0, 0.7), np.linspace(0, 10, 51), 1e-10, events=walls)
    for q, straight in zip(run.q.T, (0.3 + run.t, 0.2 + 0.7 * run.t), strict=True):
        assert q == pytest.approx(np.abs((straight + 1) % 2 - 1), abs=1e-10)


@pytest.mark.parametrize(("begin", "system"), [(-(2.0**27), "ball"), (2.0**24, "rubbing")])
def test_events_far_from_the_zero_of_the_clock_are_as_exact(begin: float, system: str) -> None:
    """Each impact, and each turn of what rubs, was rounded to the spacing of doubles at `begin`, 4×10⁻⁹ and 3×10⁻⁸ s."""
    x, v = C.q[0], C.v[0]
    ball = System(C, v**2 / 2 - 9.81 * x), Impact(x, 0.75)
    moving, *events = ball if system == "ball" else (System(C, v**2 / 2 - x**2 / 2, forces=(-0.125 * sp.sign(v),)),)
    times = np.arange(0.0, 3.0, 0.375)
    near, far = (moving.simulate({}, (1.0,), (0.5,), at + times, 1e-11, events=events) for at in (0.0, begin))
    off = far.scales.distance(np.hstack([near.q, near.v]), np.hstack([far.q, far.v]))
    assert (off <= far.errors + near.errors).all() and off.max() < 1e-12
    assert len(near.t) == 8 and near.v.min() < -0.5 < 0.5 <= near.v.max() + 1e-12


STOP, STIFFNESS, FRICTION = sp.symbols("X k F", positive=True)
RUBBED = System(C, v**2 / 2 - STIFFNESS * x**2 / 2, forces=(-FRICTION * sp.sign(v),))


def rubbed(length: float, time: float, start: float = 0.0) -> SystemRun:
    """A body on a spring that rubs, strikes a stop at 0.7 and comes to rest, in units so many times smaller."""
    values = {STIFFNESS: time**-2, FRICTION: 0.2 * length / time**2, STOP: 0.7 * length, e: 0.5}
    times = time * np.linspace(0, 9, 10)
    return RUBBED.simulate(values, [start * length], [1.2 * length / time], times, 1e-9, events=Impact(STOP - x, e))


@pytest.mark.parametrize("units", [(1e-15, 1e6), (1e9, 1.0), (1.0, 1e-9)])
def test_stops_and_friction_are_the_same_in_any_units(
    units: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 10⁻¹² m/s a velocity was held for rest, and the body for stuck; of 10⁻⁹ m a start beyond its stop was taken."""
    one, other = rubbed(1.0, 1.0), rubbed(*units)
    assert other.q / units[0] == pytest.approx(one.q, abs=one.error + other.error)
    rubbed(*units, start=0.7 + 1e-12)  # beyond the stop by rounding
    with pytest.raises(InputError, match="the gap"):
        rubbed(*units, start=0.701)
    if units[0] < 1e-12:  # twin: sizes of one, whatever the units are
        monkeypatch.setattr(phases.Switched, "sizes_of", lambda h, system, expressions, at: np.ones(len(expressions)))
        assert np.abs(rubbed(*units).q / units[0] - one.q).max() > 0.1
