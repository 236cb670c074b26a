"""Claims of section 5: how the pair falls without spins, and how long opposite spins keep it from moving in x (C10, C11)."""

from collections.abc import Mapping
from math import inf, pi

import numpy as np

from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.run import run_solver
from lagrotor.models.spring_link.system import paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import first_passage, measured_order
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, STIFFNESS
from lagrotor.pair.quantities import Spins, Vector
from lagrotor.pair.scene import Scene
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.proved_parts import topples, topples_slowly
from lagrotor.paper.rotor_pair.shocked_runs import (
    PAPER_RUN,
    after_shock,
    angle_between,
    paper_run,
    shock_of,
    shocked_scene,
    turned_about_joint_line,
)
from lagrotor.shown import scientific
from lagrotor.theory.natural_rate import natural_rate

FALLEN = 0.5  # |x| of an axis that is 30° from upright
TILTED, FLAT = 75.0, 90.0  # degrees: toppled along x, where 90° is a dead point, and across it
IN_PLANE = 0.01  # a y of an axis that would not be seen: the pair stays in the X-Z plane
SEEN = 0.1  # rad, 6°: less would not be seen as toppling
SLOW = 1.0  # rad in one turn of the natural rate: the pair swings in x before it has turned
WATCHED = 40.0  # s over which a fall is waited for
SIDE, SPRINGS = 1.0, {"1e4": 1e4, "1e5": 1e5, "1e6": 1e6}  # N, N/m
PAPER_SHOCKS: dict[str, Vector] = {"+x": (50, 0, 0), "-x": (-50, 0, 0), "+y": (0, 50, 0), "-y": (0, -50, 0)}
ALONG, ACROSS, _SMALL = (60.0, 72.0, 86.0), (25.0, 35.0, 70.0), (12.0, 24.0, 48.0)  # N, besides the paper's 50 N

TOPPLES, TURNS = "the pair topples after the shock", "it turns around the line through the two grounds"
STABLE, TOPPLES_YZ, SLOWLY = "it stays stable in x", "it topples in the Y-Z plane", "it topples slowly"
THRESHOLDS = (
    f"Stable in x is |x| below {FALLEN}, 30° from upright. To topple is to turn about the joint line by more than {SEEN} rad in "
    f"8 s, and slowly is by less than {SLOW:.0f} rad in a period of the natural rate."
)


def _tilt(axes: Array) -> float:
    return float(np.degrees(np.arccos(axes[..., 2].min())))


def measure_c10(spins: Spins) -> dict[str, float]:
    """Tilt after a shock along the bar and across it; where it topples, what follows the dead point."""
    scene = shocked_scene(spins, (50, 0, 0))
    along, across = after_shock(scene, 2.7), after_shock(shocked_scene(spins, (0, 50, 0)), 6.0)
    in_xz = np.unwrap(np.arctan2(along.axes[..., 0], along.axes[..., 2]))
    rate = abs(np.polyfit(along.t, in_xz[0], 1)[0])
    measured = {
        "shock_along_x_tilt_after_2.7_s_deg": _tilt(along.axes),
        "shock_along_x_turned_in_XZ_rad": abs(in_xz[:, -1]).max(),
        "shock_along_x_rate_in_XZ_rad_per_s": rate,
        "shock_along_x_largest_y": abs(along.axes[..., 1]).max(),
        "shock_along_y_tilt_deg": _tilt(across.axes),
        "shock_along_y_turned_about_joint_line_rad": abs(turned_about_joint_line(across.axes)[-1]),
        "rate_by_closed_form_rad_per_s": shock_of(scene).impulse[0] / (2 * sum(scene.inertias)),
    }
    return (
        measured
        if measured["shock_along_x_tilt_after_2.7_s_deg"] < TILTED
        else measured | _past_dead_point(pi / 2 / rate)
    )


def _past_dead_point(dead: float) -> dict[str, float]:
    """With a side force beside the 50 N: the parting of the axes within 2 s after the dead point, exactly and by springs.

    Springs of three stiffnesses damped alike (D ∝ √S, the paper's 250 kg/s at 10⁴ N/m), by a solver of variable step.
    """
    beside = shocked_scene((0, 0), (50, SIDE, 0))
    exact = after_shock(beside, PAPER_RUN)
    t = np.linspace(exact.t[0], shock_of(beside).at + dead + 2, 101)
    soon = angle_between(exact.axes[:, exact.t <= t[-1]]).max()
    measured = {
        "dead_point_after_s": dead,
        "side_1_N_tilt_deg": _tilt(exact.axes),
        "side_1_N_axes_part_by_deg": np.degrees(soon),
        "side_1_N_axes_part_by_deg_after_8_s": np.degrees(angle_between(exact.axes)[-1]),
    }
    for name, S in SPRINGS.items():
        run = run_solver(paper_system(beside, S, DAMPING * (S / STIFFNESS) ** 0.5), beside.shock, np.append(0, t), 1e-5)
        measured[f"side_1_N_axes_part_by_deg_springs_S_{name}"] = np.degrees(angle_between(run.axes).max())
        measured[f"side_1_N_tilt_deg_springs_S_{name}"] = _tilt(run.axes)
    return measured


def decide_c10(m: Mapping[str, float]) -> Finding:
    """Tilts after both shocks; turning about the joint line after both."""
    tilt, turned = m["shock_along_x_tilt_after_2.7_s_deg"], m["shock_along_y_turned_about_joint_line_rad"]
    topples, turns = tilt > TILTED and m["shock_along_y_tilt_deg"] > FLAT, turned > pi / 2
    if not topples:
        how = f"It tilts by no more than {tilt:.0f}° within 2.7 s of a shock along x."
        return Finding((Part(TOPPLES, False), Part(TURNS, turns)), how)
    needs = (
        "the shock is across the bar; along it each rotor turns about its own ground, and the motion is determined only up "
        f"to the dead point, {m['dead_point_after_s']:.1f} s after the shock"
    )
    part, most = ([m[f"side_1_N_{what}_deg_springs_S_{name}"] for name in SPRINGS] for what in ("axes_part_by", "tilt"))
    return Finding(
        (
            Part(TOPPLES, topples),
            Part(TURNS, turns and m["shock_along_x_largest_y"] > IN_PLANE, needs if turns else ""),
        ),
        "After a shock along x the pair topples in the X-Z plane at a steady "
        f"{m['shock_along_x_rate_in_XZ_rad_per_s']:.3f} rad/s (PR/(2(a + b)) = {m['rate_by_closed_form_rad_per_s']:.3f} "
        f"rad/s), by {tilt:.0f}° after 2.7 s, each rotor about its own ground: |y| is "
        f"{scientific(m['shock_along_x_largest_y'])} at most, so it turns around the two grounds but not about the line "
        f"through them. After a shock along y it does: by {turned:.2f} rad within 6 s. Along x it reaches a dead point "
        f"{m['dead_point_after_s']:.1f} s after the shock: the bar and both axes are in line, the constraint of the bar loses "
        "its rank, and what follows depends on the smallest side force or on the softness of the springs. With "
        f"{SIDE:.0f} N along y beside the 50 N the exact pair tilts by {m['side_1_N_tilt_deg']:.1f}° at most in 8 s, and its "
        f"axes part by {m['side_1_N_axes_part_by_deg']:.0f}° within 2 s after the dead point and by "
        f"{m['side_1_N_axes_part_by_deg_after_8_s']:.1f}° at the end of the 8 s; with springs of S = 10⁴, 10⁵, 10⁶ N/m it goes "
        f"through the dead point, to {most[0]:.0f}°, {most[1]:.0f}°, {most[2]:.0f}°, and the axes part by {part[0]:.1f}°, "
        f"{part[1]:.1f}°, {part[2]:.1f}° within the same 2 s.",
    )


def _passage(t: Array, axes: Array) -> float:
    """Return when |x| of either axis first reaches FALLEN; infinity where it does not."""
    return min(first_passage(t, sign * x, FALLEN) for x in axes[..., 0] for sign in (1, -1))


def fall(spins: Spins, force: Vector, seconds: float) -> float:
    """When |x| first reaches FALLEN, in s after the shock's peak; infinite if it does not by then.

    Goes on in parts of two seconds: without spins, from 30°, that ends before the dead point at 90°.
    """
    scene = shocked_scene(spins, force)
    at = shock_of(scene).at
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
    """The same by the paper's program."""
    scene = shocked_scene(spins, force)
    t = np.round(np.arange(15, round(50 * (shock_of(scene).at + seconds))) * 0.02, 3)
    return _passage(t, paper_run(scene, np.append(0, t)).axes[:, 1:]) - shock_of(scene).at


def measure_c11(spins: Spins) -> dict[str, float]:
    """For each of the paper's shocks: largest x and turning within its 8 s, when x has fallen; powers of other shocks."""
    measured: dict[str, float] = {}
    falls = {name: fall(spins, force, WATCHED) for name, force in PAPER_SHOCKS.items()}
    for name, force in PAPER_SHOCKS.items():
        early = after_shock(shocked_scene(spins, force), min(PAPER_RUN, falls[name]))
        turned = turned_about_joint_line(early.axes)
        when = "not_fallen_within_s" if falls[name] == inf else "fallen_in_x_after_s"
        measured |= {
            f"{when}_{name}": min(falls[name], WATCHED),
            f"largest_x_{name}": abs(early.axes[..., 0]).max(),
            f"turned_about_joint_line_rad_{name}": turned[-1],
            f"mean_turning_rate_rad_per_s_{name}": np.polyfit(early.t, turned, 1)[0],
        }
    rate = natural_rate(Scene(spins, link=HEAVY_LINK))
    measured["period_of_the_natural_rate_s"] = 2 * pi / rate if rate else PAPER_RUN  # without swing, the whole run
    if min(falls.values()) < PAPER_RUN or falls["-y"] == inf:
        return measured
    return measured | _powers(spins, falls["+x"], falls["-y"])


def _powers(spins: Spins, plus_x: float, minus_y: float) -> dict[str, float]:
    """Powers of the shock in the times of falling and in the rate of turning; the fall after −y by the paper's program."""
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
    """When the pair falls after one of the paper's shocks, in words."""
    key = f"fallen_in_x_after_s_{name}"
    return f"after {m[key]:.2f} s" if key in m else f"not within {m[f'not_fallen_within_s_{name}']:.0f} s"


def decide_c11(m: Mapping[str, float]) -> Finding:
    """After each of the paper's four shocks: how long x keeps below FALLEN, how far and how fast the pair turns."""
    first = min((value for key, value in m.items() if key.startswith("fallen_in_x")), default=inf)
    x, turned = ([m[f"{key}_{name}"] for name in PAPER_SHOCKS] for key in ("largest_x", "turned_about_joint_line_rad"))
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
        f"{THRESHOLDS} In the 8 s of the paper's runs |x| reaches {x[0]:.2f}, {x[1]:.2f}, {x[2]:.2f}, {x[3]:.2f} for 50 N along "
        f"+x, −x, +y, −y, while the pair turns about the joint line by {turned[0]:.2f}, {turned[1]:.2f}, {turned[2]:.2f}, "
        f"{turned[3]:.2f} rad, at a mean rate of {min(per_turn):.2f} to {max(per_turn):.2f} rad per period of the natural rate."
    )
    if "power_of_shock_in_time_x" not in m:
        return Finding(parts, f"{how} x passes {FALLEN} {_when(m, '+x')} (+x) and {_when(m, '-y')} (−y).")
    return Finding(
        parts,
        f"{how} After ±x it turns to the same side, at a rate that goes as F to the power "
        f"{m['power_of_shock_in_toppling_rate_x']:.2f}. But x grows slowly: it passes {FALLEN} {_when(m, '+x')} (+x), "
        f"{_when(m, '-x')} (−x), {_when(m, '-y')} (−y; by springs after {m['fallen_in_x_after_s_-y_springs']:.2f} s), times "
        f"that go as F to the power {m['power_of_shock_in_time_x']:.1f} along x and "
        f"{m['power_of_shock_in_time_minus_y']:.1f} along −y; after +y {_when(m, '+y')}.",
    )


_EXACT = "exact pair (spheres), bar m = 1 kg, K = 1 kg m²"
C10 = ClaimTest(
    "C10",
    (0, 0),
    {TOPPLES: (10, 10), TURNS: (10, 10)},
    f"{_EXACT}; spring-linked bodies",
    measure_c10,
    decide_c10,
    lambda spins: topples(TOPPLES, spins),
    "what follows the dead point is determined by no motion of the exact pair",
)
C11 = ClaimTest(
    "C11",
    (10, -10),
    {STABLE: (0, 0), TOPPLES_YZ: (10, 10), SLOWLY: (0, 0)},
    _EXACT,
    measure_c11,
    decide_c11,
    lambda spins: topples_slowly(STABLE, TOPPLES_YZ, SLOWLY, spins, SEEN, SLOW),
)
