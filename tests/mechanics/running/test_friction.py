"""Dry friction: stick and slip of textbook systems, against their closed solutions."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.errors import LagrotorWarning
from lagrotor.mechanics import System, coordinates, t

C = coordinates("x")
(x,), (v,) = C.q, C.v
F, k, g, mu, angle, belt = sp.symbols("F k g mu alpha u", positive=True)


@settings(max_examples=10, deadline=None)
@given(st.floats(0.02, 0.3), st.floats(0.5, 2.5))
def test_an_oscillator_loses_twice_the_same_length_each_half_cycle_and_stops(friction: float, start: float) -> None:
    """x'' + x = −F sign(x'): each half turn ends 2 F nearer, on the other side; at rest where |x| ≤ F."""
    times = np.pi * np.arange(0, 70)  # 2.5 is 62 times twice the least friction
    run = System(C, v**2 / 2 - x**2 / 2, forces=(-F * sp.sign(v),)).simulate({F: friction}, (start,), (0,), times, 1e-9)
    place, places = start, []
    for _ in times:
        places.append(place)
        if abs(place) > friction:
            place = -np.sign(place) * (abs(place) - 2 * friction)
    assert run.q[:, 0] == pytest.approx(places, abs=1e-7)
    assert abs(run.v[-1, 0]) < 1e-10
    # The force that holds it is that of the spring.
    assert run.evaluate(-F * sp.sign(v))[-1] == pytest.approx(places[-1], abs=1e-7)


@pytest.mark.parametrize("tilt", [0.2, 0.5])
def test_a_block_on_an_incline_stays_if_its_tangent_is_below_the_coefficient(tilt: float) -> None:
    """mu = tan(0.35): thrown upward it stops; on the steep incline it slides back."""
    block = System(C, v**2 / 2 + g * sp.sin(angle) * x, dissipation=mu * g * sp.cos(angle) * sp.Abs(v))
    rough = np.tan(0.35)
    run = block.simulate({g: 9.81, mu: rough, angle: tilt}, (0,), (-2,), np.linspace(0, 3, 61), 1e-10)
    down, hold = 9.81 * np.sin(tilt), 9.81 * rough * np.cos(tilt)
    stop, top = 2 / (down + hold), -2 / (down + hold)
    end = top + max(down - hold, 0) * (3 - stop) ** 2 / 2
    assert run.q[-1, 0] == pytest.approx(end, abs=1e-8)
    resting = block.simulate({g: 9.81, mu: rough, angle: tilt}, (0,), (0,), (0, 1.0), 1e-10)
    assert resting.q[-1, 0] == pytest.approx(max(down - hold, 0) / 2, abs=1e-9)


def test_a_mass_on_a_belt_sticks_and_slips_in_a_limit_cycle() -> None:
    """Friction that falls as soon as it slides, from 1 to 1/2; the mass sticks until the spring pulls as much."""
    w = v - belt
    sliding = sp.Rational(1, 2) + sp.Rational(1, 2) / (1 + 50 * sp.Abs(w))
    run = System(C, v**2 / 2 - x**2 / 2, forces=(-sliding * sp.sign(w),)).simulate(
        {belt: 0.1}, (0,), (0,), np.linspace(0, 80, 1601), 1e-8
    )
    sticking = np.abs(run.v[:, 0] - 0.1) < 1e-9
    assert 0.2 < sticking[800:].mean() < 0.9
    leaving = run.q[:-1, 0][sticking[:-1] & ~sticking[1:]]
    assert leaving == pytest.approx(1, abs=0.1 * 80 / 1600)  # of the last sample before
    assert run.error < 1e-7
    # The cycle repeats itself: crossings of x = 0.9 while it is carried along are equally far apart.
    carried = run.crossings(x - sp.Rational(9, 10), 1).t
    assert np.ptp(np.diff(carried)[1:]) < 1e-6


def test_two_blocks_hold_each_other_and_are_let_go_one_after_the_other() -> None:
    """The second is pulled by a growing force t: it slides at t = 2, and takes the first along when the spring pulls 1."""
    c = coordinates("a b")
    stretch = c.q[1] - c.q[0]
    L = (c.v[0] ** 2 + c.v[1] ** 2) / 2 - 50 * stretch**2 / 2
    run = System(c, L, forces=(-sp.sign(c.v[0]), -2 * sp.sign(c.v[1]) + t)).simulate(
        {}, (0, 0), (0, 0), np.linspace(0, 5, 501), 1e-9
    )
    second = run.t[np.argmax(run.q[:, 1] > 1e-7)]
    first = run.t[np.argmax(run.q[:, 0] > 1e-7)]
    assert 2 < second < 2.1 and first > second
    pull = 50 * (run.q[:, 1] - run.q[:, 0])
    assert pull[run.t < first - 0.01].max() < 1


def test_a_force_that_does_not_jump_is_run_through() -> None:
    """Quadratic drag −k v |v|: v = v_0/(1 + k v_0 t), and a start at rest stays at rest."""
    drag = System(C, v**2 / 2, forces=(-k * v * sp.Abs(v),))
    run = drag.simulate({k: 0.5}, (0,), (2,), np.linspace(0, 9, 10), 1e-10)
    assert run.v[:, 0] == pytest.approx(2 / (1 + run.t), abs=1e-9)
    assert (drag.simulate({k: 0.5}, (0,), (0,), (0, 1.0)).q == 0).all()


def test_a_potential_with_an_edge_has_the_period_of_its_flights() -> None:
    """x'' = −sign(x): from rest at h back in 4 sqrt(2 h)."""
    edge = System(C, v**2 / 2 - sp.Abs(x))
    run = edge.simulate({}, (0.5,), (0,), 4 * np.arange(6.0), 1e-10)
    assert run.q[:, 0] == pytest.approx(0.5, abs=1e-9) and np.abs(run.v).max() < 1e-8


def test_a_force_that_drives_away_from_both_sides_ends_the_run_in_words() -> None:
    with pytest.warns(LagrotorWarning, match="either side"):
        run = System(C, v**2 / 2, forces=(F * sp.sign(v),)).simulate({F: 1}, (0,), (0,), (0, 1.0))
    assert run.ending.kind == "stopped" and run.t[-1] == 0


def test_a_force_that_holds_but_is_no_friction_ends_the_run_in_words_and_at_once() -> None:
    """Two forces that push across one another's velocity: their sliding motion is outside what is followed."""
    c = coordinates("a b")
    system = System(c, (c.v[0] ** 2 + c.v[1] ** 2) / 2, forces=(-sp.sign(c.v[0]), -sp.sign(c.v[0])))
    with pytest.warns(LagrotorWarning, match="no dry friction"):
        run = system.simulate({}, (0, 0), (1, 0), np.linspace(0, 5, 11))
    assert run.t[-1] == pytest.approx(1, abs=1e-6) and run.evaluations < 5_000


def test_the_sign_of_the_friction_is_not_arbitrary() -> None:
    """The twin of the oscillator whose force is of the other sign gains what the first one loses."""
    gaining = System(C, v**2 / 2 - x**2 / 2, forces=(F * sp.sign(v - 10),))
    run = gaining.simulate({F: 0.1}, (1,), (0,), (0, np.pi), 1e-9)
    assert run.q[-1, 0] == pytest.approx(-1.2, abs=1e-8)  # a constant force −F moves the centre to −F
