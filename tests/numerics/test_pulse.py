"""Where a pulse ends, where functions of time change briefly, and how a run is cut there."""

from itertools import pairwise
from math import exp, inf

import numpy as np
import pytest

from lagrotor.numerics.pulse import PULSE_REACH, Window, brief_windows, pulse_windows, segments


def test_beyond_its_reach_a_pulse_is_below_the_last_bit_of_its_peak():
    assert 1 + exp(-(PULSE_REACH**2)) == 1
    assert 1 + exp(-((PULSE_REACH - 0.6) ** 2)) > 1  # twin


@pytest.mark.parametrize(
    ("begin", "end", "windows", "wanted"),
    [
        (-10, 10, pulse_windows(1), [(-10, -6.5, inf), (-6.5, 6.5, 1), (6.5, 10, inf)]),
        (-1, 2, pulse_windows(1), [(-1, 2, 1)]),
        (7, 9, pulse_windows(1), [(7, 9, inf)]),
        (-6.5, 6.5, pulse_windows(1, companion=True), [(-6.5, 6.5, 0.8)]),
        (-1, 2, (), [(-1, 2, inf)]),
        (9, 9, pulse_windows(1), []),
        (0, 9, [Window(1, 2, 0.1), Window(2, 3, 0.5), Window(4, 12, 1)],
         [(0, 1, inf), (1, 2, 0.1), (2, 3, 0.5), (3, 4, inf), (4, 9, 1)]),
    ],
)  # fmt: skip
def test_a_run_is_cut_at_the_edges_that_lie_inside(begin, end, windows, wanted):
    assert [tuple(part) for part in segments(begin, end, windows)] == wanted


def bell(t, at, width):
    return np.exp(-(((t - at) / width) ** 2))


BRIEF = {  # function, and where it acts
    "a pulse": (lambda t: bell(t, 5.003, 0.02), [(4.92, 5.08)]),
    "a small one in a drive": (lambda t: np.cos(3 * t) + 1e-3 * bell(t, 5.003, 0.02), [(4.97, 5.03)]),
    "a brief one beside a long one": (lambda t: bell(t, 2, 0.1) + 0.1 * bell(t, 7, 0.004), [(1.6, 2.4), (6.99, 7.01)]),
    "a step": (lambda t: 1.0 * (t > 5.0003), [(5.0001, 5.001)]),
    "a step in a drive": (lambda t: np.cos(t) + np.tanh((t - 5) / 0.01), [(4.97, 5.03)]),
    "the decay of a start": (lambda t: np.exp(-t / 0.05), [(0, 0.4)]),
    "a packet": (lambda t: np.sin(300 * (t - 5)) * bell(t, 5, 0.03), [(4.92, 5.08)]),
    "a large constant": (lambda t: 1e8 + bell(t, 5, 0.02), [(4.97, 5.03)]),
}


@pytest.mark.parametrize("unit", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("name", BRIEF)
def test_where_a_function_changes_briefly_steps_are_short(name, unit):
    """Wherever it acts it is within windows, of no more steps than some tens; and the spans before and after are free."""
    function, acts = BRIEF[name]
    windows = brief_windows(lambda t: function(t / unit)[None], 0.0, 10 * unit)
    assert all(a.end <= b.begin for a, b in pairwise(windows))
    assert sum((w.end - w.begin) / w.longest for w in windows) < 150
    assert sum(w.end - w.begin for w in windows) < 3 * unit
    t = np.linspace(0, 10, 100_001)
    for begin, end in acts:
        inside = [s for s in t[(begin < t) & (t < end)] * unit if not any(w.begin <= s <= w.end for w in windows)]
        assert not inside
        longest = min(w.longest for w in windows if w.begin < end * unit and w.end > begin * unit)
        assert longest < (end - begin) * unit


@pytest.mark.parametrize(
    "function",
    [
        lambda t: np.cos(3 * t),
        lambda t: np.cos(3 * t) + 0.7 * np.cos(4.1 * t),
        lambda t: np.sin(3 * t**2),
        lambda t: (1 + 0.9 * np.cos(t)) * np.cos(20 * t),
        lambda t: np.cos(1e5 * t),
        lambda t: t**4,
        lambda t: np.cos(t) + 1e-4 * np.random.default_rng(0).normal(size=len(t)),
        lambda t: np.full(len(t), np.nan),
        np.zeros_like,
    ],
)
def test_what_changes_alike_all_the_time_has_no_window(function):
    assert brief_windows(lambda t: function(t)[None], 0.0, 10.0) == ()
    assert brief_windows(lambda t: function(t)[None], 1.0, 1.0) == ()
