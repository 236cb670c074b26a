"""Claims of section 2: the parallel pair (C01, C02)."""

from collections.abc import Mapping
from math import pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.curves import first_passage, mean_between
from lagrotor.pair.examples import HEAVY_LINK
from lagrotor.pair.quantities import Spins, Vector
from lagrotor.pair.scene import Link
from lagrotor.pair.trajectory import Trajectory
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.proved_parts import lasting_displacement, not_without_spin
from lagrotor.paper.rotor_pair.shocked_runs import (
    after_shock,
    angle_between,
    shock_of,
    shocked_scene,
    turned_about_joint_line,
)
from lagrotor.shown import scientific
from lagrotor.theory.natural_rate import natural_rate

_ALONG, _ACROSS, _WEAK = (50.0, 0.0, 0.0), (0.0, 50.0, 0.0), (10.0, 0.0, 0.0)
CYCLES = 5  # over which a mean is taken
_PARTED = 0.1  # rad, 6°: an angle between the axes that is seen
_STEADY = 0.01  # "remains": the mean of the last cycles is that of the first ones to one part in a hundred
DISPLACED = 0.1  # a mean below a tenth of the swing about it would not be seen as a displacement
_ALIKE = 0.1  # "as", "as if": to one part in ten, the accuracy to which a graph is compared with another

SAME_SENSE, REMAINS = "both axes precess in the same direction", "a displacement of both axes remains"
ONE_GYROSCOPE = "the pair is one gyroscope of spin ω₁ + ω₂"
AS_WITHOUT_SPIN = "opposite spins respond as if there were none"


def _shocked(spins: Spins, force: Vector, seconds: float, bar: Link = HEAVY_LINK) -> Trajectory:
    return after_shock(shocked_scene(spins, force, bar), seconds)


def _centre(run: Trajectory, start: float) -> NDArray[np.float64]:
    """Mean axes (2, 3) over CYCLES turns of the natural rate, from `start` (s) after the first sample."""
    begin, turn = run.t[0] + start, 2 * pi / natural_rate(run.scene)
    return np.array([mean_between(run.t, axis, begin, begin + CYCLES * turn) for axis in run.axes])


def measure_c01(spins: Spins) -> dict[str, float]:
    """Mean rates of precession about the mean axes; these at the start and at the end; how far the axes part."""
    run = _shocked(spins, _ALONG, 12.0)
    end = run.t[-1] - run.t[0] - CYCLES * 2 * pi / natural_rate(run.scene)
    first, last = _centre(run, 0.0), _centre(run, end)
    off = run.axes[..., :2] - last[:, None, :2]
    turning = off[..., 0] * run.rates[..., 1] - off[..., 1] * run.rates[..., 0]
    sense = turning.mean(1) / (off**2).sum(-1).mean(1)
    across = _shocked(spins, _ACROSS, 12.0)
    parted = angle_between(across.axes)
    measured = {
        "displacement_by_equation_7": shock_of(run.scene).impulse[0] / (abs(spins[0]) + abs(spins[1])),
        "angle_of_axes_shock_along_bar_rad": angle_between(run.axes).max(),
        "angle_of_axes_shock_across_bar_rad": parted.max(),
        "seconds_until_axes_part_by_0.1_shock_across_bar": first_passage(across.t, parted, _PARTED)
        - shock_of(across.scene).at,
    }
    for i in (0, 1):
        measured |= {
            f"precession_{i + 1}_rad_per_s": sense[i],
            f"displacement_{i + 1}_first_cycles": first[i, 1],
            f"displacement_{i + 1}_last_cycles": last[i, 1],
            f"swing_{i + 1}_about_the_displaced_position": np.ptp(run.axes[i, :, 1]) / 2,
        }
    return measured


def decide_c01(m: Mapping[str, float]) -> Finding:
    """The senses of both precessions, and of both axes the displacement at the end against that at the start."""
    last = [m[f"displacement_{i}_last_cycles"] for i in (1, 2)]
    stays = [abs(last[i] / m[f"displacement_{i + 1}_first_cycles"] - 1) < _STEADY for i in (0, 1)]
    seen = [abs(last[i]) > DISPLACED * m[f"swing_{i + 1}_about_the_displaced_position"] for i in (0, 1)]
    return Finding(
        (
            Part(SAME_SENSE, m["precession_1_rad_per_s"] * m["precession_2_rad_per_s"] > 0),
            Part(REMAINS, all(stays) and all(seen)),
        ),
        f"In 12 s the axes precess at {m['precession_1_rad_per_s']:+.2f} and {m['precession_2_rad_per_s']:+.2f} rad/s; their "
        f"mean positions in the last {CYCLES} cycles of 12 s are displaced by {last[0]:+.4f} and {last[1]:+.4f} across the "
        f"shock (in the first {CYCLES} by {m['displacement_1_first_cycles']:+.4f} and {m['displacement_2_first_cycles']:+.4f}); "
        f"(7) gives {m['displacement_by_equation_7']:.4f}. The axes are parallel at all times (section 5) for this shock along "
        f"the bar, to {scientific(m['angle_of_axes_shock_along_bar_rad'])} rad. The same shock across the bar on one tip parts "
        f"them by {_PARTED} rad {m['seconds_until_axes_part_by_0.1_shock_across_bar']:.3f} s after its peak, and by "
        f"{m['angle_of_axes_shock_across_bar_rad']:.2f} rad at most within 12 s: equal spins do not keep the axes parallel.",
    )


def _drift_over_7(spins: Spins, bar: Link) -> float:
    """Mean displacement after a weak shock, so that squares of the amplitude do not show, over that of (7)."""
    run = _shocked(spins, _WEAK, 8.0, bar)
    return float(_centre(run, 0.0)[:, 1].mean() * sum(spins) / shock_of(run.scene).impulse[0])


def measure_c02(bar: Link) -> dict[str, float]:
    """With a given bar: displacements over (7), and responses of opposite spins over those without spins."""
    farthest, unspun = (abs(_shocked(s, _ALONG, 2.4, bar).axes[..., 0]).max() for s in ((10, -10), (0, 0)))
    turned, freely = (
        abs(turned_about_joint_line(_shocked(s, _ACROSS, 2.4, bar).axes)[-1]) for s in ((10, -10), (0, 0))
    )
    return {
        "largest_x": farthest,
        "largest_x_without_spins": unspun,
        "ratio_in_x": farthest / unspun,
        "ratio_of_turning_about_joint_line_shock_along_y": turned / freely,
        "drift_over_equation_7_spins_10_10": _drift_over_7((10, 10), bar),
        "drift_over_equation_7_spins_10_5": _drift_over_7((10, 5), bar),
    }


def decide_c02(m: Mapping[str, float]) -> Finding:
    """The displacements by (7), and both responses of opposite spins, along the bar and across it."""
    drifts = [m[f"drift_over_equation_7_spins_{pair}"] for pair in ("10_10", "10_5")]
    responses = m["ratio_in_x"], m["ratio_of_turning_about_joint_line_shock_along_y"]
    return Finding(
        (
            Part(ONE_GYROSCOPE, all(abs(ratio - 1) < _ALIKE for ratio in drifts)),
            Part(AS_WITHOUT_SPIN, all(abs(ratio - 1) < _ALIKE for ratio in responses)),
        ),
        f"The mean displacement over {CYCLES} cycles after a weak shock, over that of (7), is {drifts[0]:.3f} for spins 10 and "
        f"10 rad/s, {drifts[1]:.3f} for 10 and 5. But with spins 10 and −10, within 2.4 s of a shock along x, the axes reach x "
        f"= {m['largest_x']:.3f}, without spins {m['largest_x_without_spins']:.3f}: {responses[0]:.2f} of it. Only the turning "
        f"about the joint line within 2.4 s of a shock along y is alike (ratio {responses[1]:.2f}; alike is within a tenth).",
    )


_EXACT = "exact pair (spheres), bar m = 1 kg, K = 1 kg m²"
# C02: a bar of 1000 kg m² cannot be twisted, and keeps the axes parallel as (7) assumes. With a mass of 10 kg in the middle of
# the bar unequal spins drift by (a − b)(G₁ + G₂)²/(2D) = 0.64 of (7), D = a(G₁² + G₂²) − 2b G₁G₂.
C01 = ClaimTest(
    "C01",
    (10, 10),
    {SAME_SENSE: (10, -10), REMAINS: (10, -10)},
    _EXACT,
    measure_c01,
    decide_c01,
    lambda spins: lasting_displacement(SAME_SENSE, REMAINS, spins),
)
C02 = ClaimTest(
    "C02",
    HEAVY_LINK,
    {ONE_GYROSCOPE: Link(mass=10, inertia=0), AS_WITHOUT_SPIN: Link(mass=1, inertia=1000)},
    _EXACT,
    measure_c02,
    decide_c02,
    lambda bar: not_without_spin(AS_WITHOUT_SPIN, bar) if bar == HEAVY_LINK else (),
    "that the pair is one gyroscope is a likeness to one part in ten, of means over five cycles",
)
