"""Where a pulse ends, and how a run is cut at its edges."""

from math import exp

import pytest

from lagrotor import Scene, Shock
from lagrotor.numerics.pulse import PULSE_REACH, segments


def test_beyond_its_reach_a_pulse_is_below_the_last_bit_of_its_peak():
    assert 1 + exp(-(PULSE_REACH**2)) == 1
    assert 1 + exp(-((PULSE_REACH - 0.6) ** 2)) > 1  # twin


@pytest.mark.parametrize(
    ("begin", "end", "width", "wanted"),
    [
        (-10, 10, 1, [(-10, -6.5, False), (-6.5, 6.5, True), (6.5, 10, False)]),
        (-1, 2, 1, [(-1, 2, True)]),
        (7, 9, 1, [(7, 9, False)]),
        (-6.5, 6.5, 1, [(-6.5, 6.5, True)]),
        (-1, 2, 0.0, [(-1, 2, False)]),
    ],
)
def test_a_run_is_cut_at_the_edges_that_lie_inside(begin, end, width, wanted):
    assert [tuple(part) for part in segments(begin, end, width)] == wanted


def test_a_scene_knows_whether_its_pulse_acts_within_a_run():
    scene = Scene((10, -10), shock=Shock((1, 0, 0), at=2.0, width=0.1))
    assert scene.shock_until(1.4) is scene.shock is scene.shock_until(9)
    assert scene.shock_until(1.3) is None
    assert Scene((10, -10), shock=Shock((1, 0, 0), at=-0.7, width=0.1)).shock_until(5) is None
