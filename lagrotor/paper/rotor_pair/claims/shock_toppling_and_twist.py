"""Tests of the claims of sections 2, 5 and 5.1 on the pair after a shock. C01 and C02 compare it with one gyroscope; C10 and C11
are about toppling. C12 is about the failure of (7) for opposite spins, C13 about the mean displacement in x."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.run import run_solver
from lagrotor.models.spring_link.system import paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import first_passage, mean_between, measured_order
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, STIFFNESS
from lagrotor.pair.quantities import Spins, Vector
from lagrotor.pair.scene import Link, Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.claim_theorems import (
    axes_part,
    lasting_displacement,
    mean_displacement,
    not_without_spin,
    topples,
    topples_slowly,
)
from lagrotor.paper.rotor_pair.runs import (
    OPPOSITE,
    PAPER_RUN,
    after_shock,
    angle_between,
    paper_run,
    shock_of,
    shocked_scene,
    turned_about_joint_line,
)
from lagrotor.result_display import scientific
from lagrotor.theory.natural_rate import natural_rate

_EXACT = "exact pair (spheres), bar m = 1 kg, K = 1 kg m²"
_ALONG, _ACROSS, _WEAK = (50.0, 0.0, 0.0), (0.0, 50.0, 0.0), (10.0, 0.0, 0.0)
CYCLES = 5  # of each mean
_PARTED = 0.1  # rad, 6°: a visible angle between the axes
_STEADY = 0.01  # "remains": the relative difference of the means of the last and the first cycles
DISPLACED = 0.1  # a mean below this fraction of the amplitude would not be visible as a displacement
_ALIKE = 0.1  # "as", "as if": the relative accuracy to which two graphs are compared

SAME_SENSE, REMAINS = "both axes precess in the same direction", "a displacement of both axes remains"
ONE_GYROSCOPE = "the pair is one gyroscope of spin ω₁ + ω₂"
AS_WITHOUT_SPIN = "opposite spins respond as if there were none"


def _shocked(spins: Spins, force: Vector, seconds: float, bar: Link = HEAVY_LINK) -> Trajectory:
    return after_shock(shocked_scene(spins, force, bar), seconds)


def _centre(run: Trajectory, start: float) -> NDArray[np.float64]:
    """Return the mean of each axis, shape (2, 3), over five natural periods, from `start` (s) after the first sample."""
    begin, turn = run.t[0] + start, 2 * pi / natural_rate(run.scene)
    return np.array([mean_between(run.t, axis, begin, begin + CYCLES * turn) for axis in run.axes])


def measure_c01(spins: Spins) -> dict[str, float]:
    """Measure the mean precession rates, the mean positions in the first and last cycles, and the angle between the axes."""
    run = _shocked(spins, _ALONG, 12.0)
    end = run.t[-1] - run.t[0] - CYCLES * 2 * pi / natural_rate(run.scene)
    first, last = _centre(run, 0.0), _centre(run, end)
    offsets = run.axes[..., :2] - last[:, None, :2]
    turning = offsets[..., 0] * run.rates[..., 1] - offsets[..., 1] * run.rates[..., 0]
    sense = turning.mean(1) / (offsets**2).sum(-1).mean(1)
    run_y = _shocked(spins, _ACROSS, 12.0)
    parted = angle_between(run_y.axes)
    measured = {
        "displacement_by_equation_7": shock_of(run.scene).impulse[0] / (abs(spins[0]) + abs(spins[1])),
        "angle_of_axes_shock_along_bar_rad": angle_between(run.axes).max(),
        "angle_of_axes_shock_across_bar_rad": parted.max(),
        "seconds_until_axes_part_by_0.1_shock_across_bar": first_passage(run_y.t, parted, _PARTED)
        - shock_of(run_y.scene).at,
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
    """Decide by the signs of both precession rates, and by whether the displacements stay the same and are visible."""
    last = [m[f"displacement_{i}_last_cycles"] for i in (1, 2)]
    stays = [abs(last[i] / m[f"displacement_{i + 1}_first_cycles"] - 1) < _STEADY for i in (0, 1)]
    is_visible = [abs(last[i]) > DISPLACED * m[f"swing_{i + 1}_about_the_displaced_position"] for i in (0, 1)]
    return Finding(
        (
            Part(SAME_SENSE, m["precession_1_rad_per_s"] * m["precession_2_rad_per_s"] > 0),
            Part(REMAINS, all(stays) and all(is_visible)),
        ),
        f"In 12 s the axes precess at {m['precession_1_rad_per_s']:+.2f} and {m['precession_2_rad_per_s']:+.2f} rad/s. Their "
        f"mean positions are displaced across the shock, in the last {CYCLES} cycles by {last[0]:+.4f} and {last[1]:+.4f}, and "
        f"in the first {CYCLES} by {m['displacement_1_first_cycles']:+.4f} and {m['displacement_2_first_cycles']:+.4f}; (7) "
        f"gives {m['displacement_by_equation_7']:.4f}. After this shock along the bar the axes are parallel at all times "
        f"(section 5), to within {scientific(m['angle_of_axes_shock_along_bar_rad'])} rad. After the same shock across the bar "
        f"on one tip, the angle between them reaches {_PARTED} rad {m['seconds_until_axes_part_by_0.1_shock_across_bar']:.3f} s "
        f"after the peak. Within 12 s it reaches {m['angle_of_axes_shock_across_bar_rad']:.2f} rad: equal spins do not keep the "
        "axes parallel.",
    )


def _drift_over_7(spins: Spins, bar: Link) -> float:
    """Return the mean displacement divided by its value from (7), after a shock so weak that its square is negligible."""
    run = _shocked(spins, _WEAK, 8.0, bar)
    return float(_centre(run, 0.0)[:, 1].mean() * sum(spins) / shock_of(run.scene).impulse[0])


def measure_c02(bar: Link) -> dict[str, float]:
    """Measure the displacement relative to (7), and the response of opposite spins relative to the response without spins."""
    farthest, unspun = (abs(_shocked(s, _ALONG, 2.4, bar).axes[..., 0]).max() for s in ((10, -10), (0, 0)))
    angle, free_angle = (
        abs(turned_about_joint_line(_shocked(s, _ACROSS, 2.4, bar).axes)[-1]) for s in ((10, -10), (0, 0))
    )
    return {
        "largest_x": farthest,
        "largest_x_without_spins": unspun,
        "ratio_in_x": farthest / unspun,
        "ratio_of_turning_about_joint_line_shock_along_y": angle / free_angle,
        "drift_over_equation_7_spins_10_10": _drift_over_7((10, 10), bar),
        "drift_over_equation_7_spins_10_5": _drift_over_7((10, 5), bar),
    }


def decide_c02(m: Mapping[str, float]) -> Finding:
    """Decide by the displacement relative to (7), and by two responses of opposite spins relative to those without spins."""
    drifts = [m[f"drift_over_equation_7_spins_{pair}"] for pair in ("10_10", "10_5")]
    responses = m["ratio_in_x"], m["ratio_of_turning_about_joint_line_shock_along_y"]
    return Finding(
        (
            Part(ONE_GYROSCOPE, all(abs(ratio - 1) < _ALIKE for ratio in drifts)),
            Part(AS_WITHOUT_SPIN, all(abs(ratio - 1) < _ALIKE for ratio in responses)),
        ),
        f"After a weak shock the mean displacement over {CYCLES} cycles is {drifts[0]:.3f} times (7) for spins 10 and 10 rad/s, "
        f"and {drifts[1]:.3f} times (7) for 10 and 5. With spins 10 and −10, however, the axes reach x = {m['largest_x']:.3f} "
        f"within 2.4 s of a shock along x; without spins they reach {m['largest_x_without_spins']:.3f}. The ratio is "
        f"{responses[0]:.2f}. Only the angle turned about the joint line within 2.4 s of a shock along y is the same, with a "
        f"ratio of {responses[1]:.2f}. (Responses count as the same if they differ by less than a tenth.)",
    )


# C02: a bar of 1000 kg m² cannot be twisted and keeps the axes parallel, as (7) assumes. With 10 kg in the middle of the bar,
# unequal spins drift by (a − b)(G₁ + G₂)²/(2D) = 0.64 of (7), where D = a(G₁² + G₂²) − 2b G₁G₂.
C01 = ClaimTest(
    "C01", (10, 10), {SAME_SENSE: (10, -10), REMAINS: (10, -10)}, _EXACT, measure_c01, decide_c01,
    lambda spins: lasting_displacement(SAME_SENSE, REMAINS, spins),
)  # fmt: skip
C02 = ClaimTest(
    "C02", HEAVY_LINK, {ONE_GYROSCOPE: Link(mass=10, inertia=0), AS_WITHOUT_SPIN: Link(mass=1, inertia=1000)}, _EXACT,
    measure_c02, decide_c02, lambda bar: not_without_spin(AS_WITHOUT_SPIN, bar) if bar == HEAVY_LINK else (),
    "the claim that the pair is one gyroscope compares means over five cycles, to one part in ten",
)  # fmt: skip


FALLEN = 0.5  # |x| of an axis at 30° from upright
TILTED, FLAT = 75.0, 90.0  # degrees: toppled along x, where 90° is a dead point, and across it
IN_PLANE = 0.01  # an invisible y of an axis: the pair stays in the X-Z plane
SEEN = 0.1  # rad, 6°: the least visible toppling
SLOW = 1.0  # rad in one period of the natural rate: the pair oscillates in x before it has toppled
WATCHED = 40.0  # s, the longest simulation of a fall
SIDE, SPRINGS = 1.0, {"1e4": 1e4, "1e5": 1e5, "1e6": 1e6}  # N, N/m
PAPER_SHOCKS: dict[str, Vector] = {"+x": (50, 0, 0), "-x": (-50, 0, 0), "+y": (0, 50, 0), "-y": (0, -50, 0)}
ALONG, ACROSS, _SMALL = (60.0, 72.0, 86.0), (25.0, 35.0, 70.0), (12.0, 24.0, 48.0)  # N, besides the paper's 50 N

TOPPLES, TURNS = "the pair topples after the shock", "it turns around the line through the two grounds"
STABLE, TOPPLES_YZ, SLOWLY = "it stays stable in x", "it topples in the Y-Z plane", "it topples slowly"
THRESHOLDS = (
    f"The pair counts as stable in x while |x| is below {FALLEN}, 30° from upright. It topples if it turns about the joint line "
    f"by more than {SEEN} rad in 8 s, and slowly if it turns by less than {SLOW:.0f} rad in a period of the natural rate."
)


def _tilt(axes: Array) -> float:
    return float(np.degrees(np.arccos(axes[..., 2].min())))


def measure_c10(spins: Spins) -> dict[str, float]:
    """Measure the tilt after shocks along and across the bar and, if the pair topples, what follows the dead point."""
    scene = shocked_scene(spins, (50, 0, 0))
    run_x, run_y = after_shock(scene, 2.7), after_shock(shocked_scene(spins, (0, 50, 0)), 6.0)
    in_xz = np.unwrap(np.arctan2(run_x.axes[..., 0], run_x.axes[..., 2]))
    rate = abs(np.polyfit(run_x.t, in_xz[0], 1)[0])
    measured = {
        "shock_along_x_tilt_after_2.7_s_deg": _tilt(run_x.axes),
        "shock_along_x_turned_in_XZ_rad": abs(in_xz[:, -1]).max(),
        "shock_along_x_rate_in_XZ_rad_per_s": rate,
        "shock_along_x_largest_y": abs(run_x.axes[..., 1]).max(),
        "shock_along_y_tilt_deg": _tilt(run_y.axes),
        "shock_along_y_turned_about_joint_line_rad": abs(turned_about_joint_line(run_y.axes)[-1]),
        "rate_by_closed_form_rad_per_s": shock_of(scene).impulse[0] / (2 * sum(scene.inertias)),
    }
    return (
        measured
        if measured["shock_along_x_tilt_after_2.7_s_deg"] < TILTED
        else measured | _past_dead_point(pi / 2 / rate)
    )


def _past_dead_point(dead: float) -> dict[str, float]:
    """Measure the angle between the axes up to 2 s after the dead point, with a side force of 1 N beside the 50 N."""
    scene = shocked_scene((0, 0), (50, SIDE, 0))
    exact = after_shock(scene, PAPER_RUN)
    t = np.linspace(exact.t[0], shock_of(scene).at + dead + 2, 101)
    soon = angle_between(exact.axes[:, exact.t <= t[-1]]).max()
    measured = {
        "dead_point_after_s": dead,
        "side_1_N_tilt_deg": _tilt(exact.axes),
        "side_1_N_axes_part_by_deg": np.degrees(soon),
        "side_1_N_axes_part_by_deg_after_8_s": np.degrees(angle_between(exact.axes)[-1]),
    }
    for name, S in SPRINGS.items():  # with one damping ratio, D ∝ √S, the paper's 250 kg/s at 10⁴ N/m
        run = run_solver(paper_system(scene, S, DAMPING * (S / STIFFNESS) ** 0.5), scene.shock, np.append(0, t), 1e-5)
        measured[f"side_1_N_axes_part_by_deg_springs_S_{name}"] = np.degrees(angle_between(run.axes).max())
        measured[f"side_1_N_tilt_deg_springs_S_{name}"] = _tilt(run.axes)
    return measured


def decide_c10(m: Mapping[str, float]) -> Finding:
    """Decide by the tilt after both shocks, and by the angle turned about the joint line."""
    tilt, angle = m["shock_along_x_tilt_after_2.7_s_deg"], m["shock_along_y_turned_about_joint_line_rad"]
    topples, turns = tilt > TILTED and m["shock_along_y_tilt_deg"] > FLAT, angle > pi / 2
    if not topples:
        how = f"It tilts by no more than {tilt:.0f}° within 2.7 s of a shock along x."
        return Finding((Part(TOPPLES, False), Part(TURNS, turns)), how)
    needs = (
        "the shock is across the bar; along it each rotor turns about its own ground, and the motion is determined only up "
        f"to the dead point, {m['dead_point_after_s']:.1f} s after the shock"
    )
    separations, tilts = (
        [m[f"side_1_N_{what}_deg_springs_S_{name}"] for name in SPRINGS] for what in ("axes_part_by", "tilt")
    )
    return Finding(
        (
            Part(TOPPLES, topples),
            Part(TURNS, turns and m["shock_along_x_largest_y"] > IN_PLANE, needs if turns else ""),
        ),
        f"After a shock along x the pair topples in the X-Z plane at a steady {m['shock_along_x_rate_in_XZ_rad_per_s']:.3f} "
        f"rad/s (PR/(2(a + b)) = {m['rate_by_closed_form_rad_per_s']:.3f} rad/s), by {tilt:.0f}° after 2.7 s. Each rotor "
        "turns about its own ground and not about the line through both, since |y| is at most "
        f"{scientific(m['shock_along_x_largest_y'])}. After a shock along y the pair turns about this line, by {angle:.2f} "
        f"rad within 6 s. Along x it reaches a dead point {m['dead_point_after_s']:.1f} s after the shock, where the bar and "
        "both axes lie in one line and the constraint of the bar loses its rank. The further motion depends on arbitrarily small "
        f"side forces and on the softness of the springs. With {SIDE:.0f} N along y beside the 50 N the exact pair tilts by at "
        f"most {m['side_1_N_tilt_deg']:.1f}° in 8 s; the angle between its axes reaches {m['side_1_N_axes_part_by_deg']:.0f}° "
        f"within 2 s after the dead point and {m['side_1_N_axes_part_by_deg_after_8_s']:.1f}° at the end. With springs of S = "
        f"10⁴, 10⁵, 10⁶ N/m it passes the dead point, to tilts of {tilts[0]:.0f}°, {tilts[1]:.0f}°, {tilts[2]:.0f}°; the "
        f"angle between the axes reaches {separations[0]:.1f}°, {separations[1]:.1f}°, {separations[2]:.1f}° within the same "
        "2 s.",
    )


def _passage(t: Array, axes: Array) -> float:
    """Return the first time at which |x| of either axis reaches 0.5; inf if it does not."""
    return min(first_passage(t, sign * x, FALLEN) for x in axes[..., 0] for sign in (1, -1))


def fall(spins: Spins, force: Vector, seconds: float) -> float:
    """Return the time in s from the shock's peak until |x| first reaches 0.5; inf if that is later than `seconds`."""
    scene = shocked_scene(spins, force)
    at = shock_of(scene).at
    # Without spins, steps of two seconds end before the dead point at 90°.
    run, began = after_shock(scene, 2.4), 0.0
    while True:
        passed = _passage(run.t, run.axes)
        if passed < inf:
            return began + passed - at
        began += run.t[-1]
        if began - at > seconds - 1e-6:
            return inf
        now = Scene(spins, link=HEAVY_LINK, axes=run.axes[:, -1], rates=run.rates[:, -1])  # type: ignore[arg-type]
        run = simulate(now, np.linspace(0, min(2.0, at + seconds - began), 81), "spheres", 1e-9)


def _fall_of_springs(spins: Spins, force: Vector, seconds: float) -> float:
    """Return the time in s from the shock's peak until |x| first reaches 0.5 in the paper's program; inf if it does not."""
    scene = shocked_scene(spins, force)
    t = np.round(np.arange(15, round(50 * (shock_of(scene).at + seconds))) * 0.02, 3)
    return _passage(t, paper_run(scene, np.append(0, t)).axes[:, 1:]) - shock_of(scene).at


def measure_c11(spins: Spins) -> dict[str, float]:
    """Measure the largest |x|, the turning and the time of the fall after four shocks; fit powers of the force."""
    measured: dict[str, float] = {}
    falls = {name: fall(spins, force, WATCHED) for name, force in PAPER_SHOCKS.items()}
    for name, force in PAPER_SHOCKS.items():
        early = after_shock(shocked_scene(spins, force), min(PAPER_RUN, falls[name]))
        angles = turned_about_joint_line(early.axes)
        when = "not_fallen_within_s" if falls[name] == inf else "fallen_in_x_after_s"
        measured |= {
            f"{when}_{name}": min(falls[name], WATCHED),
            f"largest_x_{name}": abs(early.axes[..., 0]).max(),
            f"turned_about_joint_line_rad_{name}": angles[-1],
            f"mean_turning_rate_rad_per_s_{name}": np.polyfit(early.t, angles, 1)[0],
        }
    rate = natural_rate(Scene(spins, link=HEAVY_LINK))
    measured["period_of_the_natural_rate_s"] = (
        2 * pi / rate if rate else PAPER_RUN
    )  # without oscillation, the whole run
    if min(falls.values()) < PAPER_RUN or falls["-y"] == inf:
        return measured
    return measured | _powers_in_times(spins, falls["+x"], falls["-y"])


def _powers_in_times(spins: Spins, plus_x: float, minus_y: float) -> dict[str, float]:
    """Fit the times of falling, known for 50 N along +x and −y, and the toppling rate by powers of the force."""
    times_x = [plus_x, *(fall(spins, (f, 0, 0), WATCHED) for f in ALONG)]
    times_y = [minus_y, *(fall(spins, (0, -f, 0), WATCHED) for f in ACROSS)]
    rates = []
    for f in _SMALL:
        run = after_shock(shocked_scene(spins, (f, 0, 0)), 12.0)
        rates.append(abs(np.polyfit(run.t, turned_about_joint_line(run.axes), 1)[0]))
    return {
        "fallen_in_x_after_s_-y_springs": _fall_of_springs(spins, PAPER_SHOCKS["-y"], 1.1 * minus_y),
        "power_of_shock_in_time_x": measured_order((50.0, *ALONG), times_x),
        "power_of_shock_in_time_minus_y": measured_order((50.0, *ACROSS), times_y),
        "power_of_shock_in_toppling_rate_x": measured_order(_SMALL, rates),
        "toppling_rate_48_N_over_12_s_rad_per_s": rates[-1],
    }


def _when(m: Mapping[str, float], name: str) -> str:
    """Return in words when |x| passes 0.5 after one of the paper's shocks."""
    key = f"fallen_in_x_after_s_{name}"
    return f"after {m[key]:.2f} s" if key in m else f"not within {m[f'not_fallen_within_s_{name}']:.0f} s"


def decide_c11(m: Mapping[str, float]) -> Finding:
    """Decide by how long |x| stays below 0.5, and by the angle and the rate of turning after each of the four shocks."""
    first = min((value for key, value in m.items() if key.startswith("fallen_in_x")), default=inf)
    x, angles = ([m[f"{key}_{name}"] for name in PAPER_SHOCKS] for key in ("largest_x", "turned_about_joint_line_rad"))
    rates = [abs(m[f"mean_turning_rate_rad_per_s_{name}"]) for name in PAPER_SHOCKS]
    per_turn = [m["period_of_the_natural_rate_s"] * rate for rate in rates]
    for_a_while = (
        f"for a while: x passes {FALLEN} {_when(m, '+x')} for 50 N along x, {_when(m, '-y')} for 50 N along −y"
    )
    parts = (
        Part(STABLE, first == inf, for_a_while if first > PAPER_RUN else ""),
        Part(TOPPLES_YZ, min(rates) * PAPER_RUN > SEEN),
        Part(SLOWLY, max(per_turn) < SLOW),
    )
    how = (
        f"{THRESHOLDS} In the 8 s of the paper's runs |x| reaches {x[0]:.2f}, {x[1]:.2f}, {x[2]:.2f} and {x[3]:.2f} for 50 N "
        f"along +x, −x, +y and −y. The pair turns about the joint line by {angles[0]:.2f}, {angles[1]:.2f}, {angles[2]:.2f} and "
        f"{angles[3]:.2f} rad, at a mean rate of {min(per_turn):.2f} to {max(per_turn):.2f} rad per period of the natural rate."
    )
    if "power_of_shock_in_time_x" not in m:
        return Finding(parts, f"{how} x passes {FALLEN} {_when(m, '+x')} (+x) and {_when(m, '-y')} (−y).")
    return Finding(
        parts,
        f"{how} After shocks along +x and −x it turns to the same side, at a rate proportional to F to the power "
        f"{m['power_of_shock_in_toppling_rate_x']:.2f}. But x grows slowly. It passes {FALLEN} {_when(m, '+x')} (+x), "
        f"{_when(m, '-x')} (−x), {_when(m, '-y')} (−y; with springs after {m['fallen_in_x_after_s_-y_springs']:.2f} s) and "
        f"{_when(m, '+y')} (+y). These times are proportional to F to the power {m['power_of_shock_in_time_x']:.1f} along x and "
        f"{m['power_of_shock_in_time_minus_y']:.1f} along −y.",
    )


C10 = ClaimTest(
    "C10", (0, 0), {TOPPLES: (10, 10), TURNS: (10, 10)}, f"{_EXACT}; spring-linked bodies", measure_c10, decide_c10,
    lambda spins: topples(TOPPLES, spins), "what follows the dead point is determined by no motion of the exact pair",
)  # fmt: skip
C11 = ClaimTest(
    "C11", (10, -10), {STABLE: (0, 0), TOPPLES_YZ: (10, 10), SLOWLY: (0, 0)}, _EXACT, measure_c11, decide_c11,
    lambda spins: topples_slowly(STABLE, TOPPLES_YZ, SLOWLY, spins, SEEN, SLOW),
)  # fmt: skip


STIFFER = (10.0, 100.0, 1000.0)  # kg m², bars that resist twisting increasingly
FORCES = (5.0, 10.0, 20.0)  # N, small shocks
NONE = 1e-6  # a mean below a hundred times the error of the simulations counts as zero
FASTER = 1.5  # a displacement proportional to a higher power of the shock vanishes to first order

FAILS, TWISTS, PARTS = "(7) fails for opposite spins", "the link twists out of its plane", "r₁ and r₂ are not parallel"
CAUSE = "the twist is the cause: where it is prevented, (7) holds"
NO_MEAN = "r₁ and r₂ have on average no displacement in x"


@dataclass(frozen=True)
class Twistable:
    """The data of claim C12: the transverse inertia K (kg m²) of the paper's bar, and the inertias of three stiffer bars.

    The claim says that a bar of larger inertia prevents the twist.
    """

    K: float = HEAVY_LINK.inertia
    stiffer: tuple[float, float, float] = STIFFER


def measure_c12(case: Twistable) -> dict[str, float]:
    """Measure x relative to its value without spins, the twist and the angle between the axes, with four bars."""
    unspun = abs(after_shock(shocked_scene((0, 0), (50, 0, 0)), 2.4).axes[..., 0]).max()
    measured = {f"inertia_kg_m2_stiffer_{i}": K for i, K in enumerate(case.stiffer, 1)}
    for name, inertia in (("own", case.K), *((f"stiffer_{i}", K) for i, K in enumerate(case.stiffer, 1))):
        scene = shocked_scene(OPPOSITE, (50, 0, 0), Link(mass=1, inertia=inertia))
        run = after_shock(scene, 2.4)
        bar = (run.tips[1] - run.tips[0]) / HEAVY_LINK.length
        measured |= {
            f"largest_x_over_unspun_{name}": abs(run.axes[..., 0]).max() / unspun,
            f"largest_angle_of_axes_rad_{name}": angle_between(run.axes).max(),
            f"largest_twist_of_bar_rad_{name}": abs(np.arctan2(bar[:, 1], bar[:, 0])).max(),
        }
    whole = after_shock(shocked_scene(OPPOSITE, (50, 0, 0), Link(mass=1, inertia=case.K)), PAPER_RUN)
    return measured | {"largest_angle_of_axes_rad_8_s": angle_between(whole.axes).max()}


def decide_c12(m: Mapping[str, float]) -> Finding:
    """Decide by x relative to (7), the twist of the bar and the angle between the axes, with this bar and with the stiffest."""
    x, *ratios = (m[f"largest_x_over_unspun_{bar}"] for bar in ("own", "stiffer_1", "stiffer_2", "stiffer_3"))
    bars = [m[f"inertia_kg_m2_stiffer_{i}"] for i in (1, 2, 3)]
    untwisted = m["largest_twist_of_bar_rad_stiffer_3"] < _PARTED
    return Finding(
        (
            Part(FAILS, abs(x - 1) > _ALIKE),
            Part(TWISTS, m["largest_twist_of_bar_rad_own"] > _PARTED),
            Part(PARTS, m["largest_angle_of_axes_rad_own"] > _PARTED),
            Part(CAUSE, untwisted and abs(ratios[-1] - 1) < _ALIKE),
        ),
        f"Axes count as parallel up to an angle of {_PARTED} rad, and values as equal if they differ by less than a tenth. With "
        f"this bar the link twists by {m['largest_twist_of_bar_rad_own']:.2f} rad within 2.4 s. The angle between the axes "
        f"reaches {m['largest_angle_of_axes_rad_own']:.2f} rad ({m['largest_angle_of_axes_rad_8_s']:.2f} within 8 s), and x "
        f"reaches {x:.2f} of its value without spins, which (7) predicts. With moments of inertia K = {bars[0]:g}, {bars[1]:g}, "
        f"{bars[2]:g} kg m², which resist the twist, x reaches {ratios[0]:.2f}, {ratios[1]:.2f}, {ratios[2]:.2f} of that value, "
        f"and the angle decreases to {m['largest_angle_of_axes_rad_stiffer_3']:.3f} rad with the last. With ℓ = R the angle "
        "between the axes equals the twist of the bar.",
    )


def _mean_x(cycles: float, force: Vector) -> Array:
    """Return the means (2,) of x_1 and x_2 over a number of periods of the natural rate, from the end of the shock."""
    run = after_shock(shocked_scene(OPPOSITE, force), 6.5)
    seconds = cycles * 2 * pi / natural_rate(run.scene)
    return mean_between(run.t, run.axes[..., 0].T, run.t[0], run.t[0] + seconds)


def _powers_in_means(means: list[Array], name: str) -> dict[str, float]:
    """Fit half the sum and half the difference of the means (one pair per force) by powers of the force."""
    both = np.array(means)
    components = {"common_mean": both.mean(1), "half_difference": (both[:, 0] - both[:, 1]) / 2}
    return {
        f"power_of_shock_{name}_in_{component}": measured_order(FORCES, np.maximum(abs(values), 1e-15))
        for component, values in components.items()
    }


def measure_c13(cycles: float) -> dict[str, float]:
    """Measure the means of x_1 and x_2 after small shocks along x and y, with their powers of the force, and after 50 N."""
    means_x, means_y = [_mean_x(cycles, (f, 0, 0)) for f in FORCES], [_mean_x(cycles, (0, f, 0)) for f in FORCES]
    scene = shocked_scene(OPPOSITE, (0, FORCES[0], 0))
    return {
        "shock_along_x_20_N_mean_x_1": means_x[-1][0],
        "shock_along_x_20_N_mean_x_2": means_x[-1][1],
        **_powers_in_means(means_x, "along_x"),
        "shock_along_y_5_N_mean_x": means_y[0].mean(),
        "shock_along_y_5_N_predicted": -shock_of(scene).impulse[1] / (2 * scene.momenta[0]),
        **_powers_in_means(means_y, "along_y"),
        "shock_along_x_50_N_mean_x": _mean_x(cycles, (50, 0, 0)).mean(),
        "shock_along_y_50_N_mean_x": _mean_x(cycles, (0, 50, 0)).mean(),
    }


def decide_c13(m: Mapping[str, float]) -> Finding:
    """Decide by whether the means of x_1 and x_2 vanish, exactly or to first order in the shock, along and across the bar."""
    none = max(abs(value) for name, value in m.items() if "_mean_x" in name) < NONE
    vanishes_x, vanishes_y = (
        min(m[f"power_of_shock_{way}_in_{component}"] for component in ("common_mean", "half_difference")) > FASTER
        for way in ("along_x", "along_y")
    )
    needs = "to first order in the shock" if vanishes_y else "the shock is along x, and to first order in it"
    return Finding(
        (Part(NO_MEAN, none, needs if vanishes_x else ""),),
        "The means are taken over four periods of the natural rate. After 20 N along x the means of x₁ and x₂ are "
        f"{m['shock_along_x_20_N_mean_x_1']:+.4f} and {m['shock_along_x_20_N_mean_x_2']:+.4f}. Half their sum is proportional "
        f"to F to the power {m['power_of_shock_along_x_in_common_mean']:.2f}, half their difference to F to the power "
        f"{m['power_of_shock_along_x_in_half_difference']:.2f}. After 5 N along y the mean of x is "
        f"{m['shock_along_y_5_N_mean_x']:+.5f} (−PR/(2G), with the impulse P, gives {m['shock_along_y_5_N_predicted']:+.5f}). "
        f"It is proportional to F to the power {m['power_of_shock_along_y_in_common_mean']:.2f}. After the paper's 50 N the "
        f"mean of x is {m['shock_along_x_50_N_mean_x']:+.3f} for a force along x and {m['shock_along_y_50_N_mean_x']:+.3f} for "
        "one along y.",
    )


# C12: a bar of 1000 kg m² does not twist, so that the axes stay parallel and (7) holds; bars up to 0.5 kg m² prevent no twist.
# C13: a quarter of a period gives no average.
C12 = ClaimTest(
    "C12", Twistable(),
    {**dict.fromkeys((FAILS, TWISTS, PARTS), Twistable(1000.0)), CAUSE: Twistable(stiffer=(0.1, 0.2, 0.5))},
    "exact pair (spheres), bar m = 1 kg, K = 1 to 1000 kg m²", measure_c12, decide_c12,
    lambda case: axes_part(PARTS, Link(mass=1, inertia=case.K)) if case == Twistable() else (),
    "they compare simulations with bars of several inertias, to one part in ten",
)  # fmt: skip
C13 = ClaimTest(
    "C13", 4.0, {NO_MEAN: 0.25}, "exact pair (spheres), bar m = 1 kg, K = 1 kg m²", measure_c13, decide_c13,
    lambda cycles: mean_displacement(NO_MEAN) if cycles >= 4 else (),
)  # fmt: skip
