"""The solvers one by one: order, reading, counting, stopping, and the programs they are given."""

from dataclasses import replace
from math import cos

import numpy as np
import pytest

from lagrotor.numerics import solvers as lsoda_module
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.segment import Array, Segment, StopError
from lagrotor.numerics.solvers import _piece as piece
from lagrotor.numerics.solvers import adams, adams_order, adams_weights, dop853, lsoda

TIMES = np.linspace(0.3, 20, 57)


def oscillate(s: float, y: Array) -> list[float]:
    return [y[1], -y[0]]


def segment(**more: object) -> Segment:
    return Segment(oscillate, np.array([1.0, 0.0]), 0.0, 20.0, TIMES, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("engine", "error", "within"), [(lsoda, 1e-10, 2e-8), (adams, 1e-12, 1e-12), (dop853, 1e-12, 1e-11)]
)
def test_each_engine_reads_the_oscillator_at_any_time(engine, error, within) -> None:
    run = engine(segment(), error)
    assert run.states == pytest.approx(np.column_stack([np.cos(TIMES), -np.sin(TIMES)]), abs=within)
    assert run.end[0] == pytest.approx(cos(20), abs=within)


@pytest.mark.parametrize("engine", [lsoda, adams, dop853])
def test_evaluations_are_those_that_were_made(engine) -> None:
    calls = 0

    def counted(s: float, y: Array) -> list[float]:
        nonlocal calls
        calls += 1
        return oscillate(s, y)

    run = engine(Segment(counted, np.array([1.0, 0.0]), 0.0, 20.0, TIMES), 1e-8)
    assert run.evaluations == pytest.approx(calls, abs=2)


def test_the_first_step_of_lsoda_is_short_where_the_start_is_fast() -> None:
    seen = list[float]()

    def fast(s: float, y: Array) -> list[float]:
        seen.append(s)
        return [-1e6 * y[0]]

    lsoda(Segment(fast, np.array([1.0]), 0.0, 1.0, np.array([0.5])), 1e-8)
    assert 0 < max(seen[:4]) < 1e-9


def test_rounding_of_the_weights_does_not_gather(monkeypatch: pytest.MonkeyPatch) -> None:
    """Weights that are rounded once change the energy in each step alike, and in each run: two runs would agree, and be wrong."""

    def drift() -> float:
        """Largest change of a pendulum's energy in 80 turns, over it: order 12 leaves no other error than rounding."""
        swing = Segment(lambda s, y: [y[1], -np.sin(y[0])], np.array([0.25, 0.0]), 0.0, 500.0, TIMES, longest=0.05)
        angle, rate = piece(swing, 12, swing.start, 0.0, 0.05, 10_000, 1e9).states.T
        energy = rate**2 / 2 + 2 * np.sin(angle / 2) ** 2
        return float(np.abs(energy / energy[0] - 1).max())

    assert drift() < 4e-14
    A, B, *others = adams_weights(12)
    monkeypatch.setattr("lagrotor.numerics.solvers.adams_weights", lambda q: (A * [[1], [0]], B * [[1], [0]], *others))
    assert drift() > 1e-13


@pytest.mark.parametrize("error", [1e-6, 1e-12])
def test_the_order_is_what_it_is_called(error: float) -> None:
    """Powers below the order are integrated exactly, to the rounding; the next ones are not."""
    order = adams_order(error)

    def off(power: int) -> float:
        rising = Segment(lambda s, y: [(power + 1) * s**power], np.zeros(1), 0.0, 1.0, TIMES[:1])
        reached = piece(rising, order, np.zeros(1), 0.0, 1 / 20, 20, 1e9).states[:, 0]
        return float(np.abs(reached - (np.arange(len(reached)) / 20) ** (power + 1)).max())

    assert max(off(power) for power in range(order)) < 1e-13
    assert off(order + 4) > 1e-12


def test_the_adams_pair_shortens_a_step_that_becomes_too_long() -> None:
    def quickens(s: float, y: Array) -> list[float]:
        faster = 1 + 20 / (1 + np.exp(-4 * (s - 10)))
        return [y[1] * faster, -y[0] * faster]

    run = adams(Segment(quickens, np.array([1.0, 0.0]), 0.0, 20.0, np.array([20.0])), 1e-10)
    turned = 20 + 5 * (np.log1p(np.exp(40)) - np.log1p(np.exp(-40)))
    assert run.states[0, 0] == pytest.approx(cos(turned), abs=1e-8)


@pytest.mark.parametrize(("error", "ceiling"), [(1e-3, 1100), (1e-6, 1100), (1e-9, 800), (1e-12, 2000)])
def test_the_adams_pair_finds_its_step_at_once(error: float, ceiling: int) -> None:
    """A loose tolerance takes no more than a tight one: a step that is not stable is not tried again and again."""
    assert adams(segment(), error).evaluations < ceiling


def around_the_circle(s: float, y: Array) -> list[float]:
    """The unit circle at unit speed; off it the radius grows, and with it the speed, so that a projection has lost the angle."""
    off = y @ y - 1
    return [float(1.5 * off * y[0] - (1 + off) * y[1]), float(1.5 * off * y[1] + (1 + off) * y[0])]


@pytest.mark.parametrize("bounded", [True, False])
def test_a_projection_from_far_off_is_not_taken(bounded: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twin: without a bound on what is projected the same run is wrong, and nothing says so."""
    if not bounded:
        monkeypatch.setattr(lsoda_module, "_DRIFT", np.inf)
    times = np.linspace(1, 60, 60)
    problem = Problem(around_the_circle, np.array([1.0, 0.0]), 1e6, project=lambda y: y / np.hypot(*y))
    found = integrate(problem, times, 1e-6).states
    off = np.abs(found - np.transpose([np.cos(times), np.sin(times)])).max()
    assert off < 1e-4 if bounded else off > 0.1


@pytest.mark.parametrize("engine", [lsoda, adams, dop853])
def test_no_step_passes_a_singular_position(engine) -> None:
    """A straight motion through it feels nothing: only the time that is left until then shortens the steps."""

    def until_zero(y: Array) -> float:
        return float(y[0]) if y[0] > 0 else np.inf

    straight = Segment(
        lambda s, y: [-1.0], np.ones(1), 0.0, 2.0, np.array([2.0]), budget=20_000, project=lambda y: y, typical_rate=1
    )
    with pytest.raises(StopError) as stopped:
        engine(replace(straight, time_to_singular=until_zero), 1e-9)
    assert stopped.value.at == pytest.approx(1, abs=0.1) and stopped.value.at <= 1
    assert engine(straight, 1e-9).end[0] == pytest.approx(-1)  # twin: what is not watched is passed


@pytest.mark.parametrize(("scale", "phase"), [(51.27, 0.419), (9.05, 0.442), (7.21, 4.468), (17.25, 1.77)])
def test_what_lsoda_reached_is_at_the_time_that_it_says(scale: float, phase: float) -> None:
    """Four of 600 runs that stop just before a part's end, where the state was taken for the end's, 0.016 to 0.09 off."""
    segment = Segment(
        oscillate,
        np.array([np.cos(phase), -np.sin(phase)]),
        0.0,
        20.0,
        np.array([20.0]),
        project=lambda y: y,
        time_to_singular=lambda y: scale * abs(float(y[0])),
        budget=20_000,
    )
    assert lsoda(segment, 1e-9).states[-1] == pytest.approx([np.cos(20 + phase), -np.sin(20 + phase)], abs=1e-6)
