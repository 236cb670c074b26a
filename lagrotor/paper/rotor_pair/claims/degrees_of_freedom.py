"""Claims of sections 5.2 and 6: the degrees of freedom and the modes of the pair (C14, C24)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.models.simulate import simulate
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import harmonics_at
from lagrotor.pair.examples import HEAVY_LINK
from lagrotor.pair.notation import G_1, G_2, a, b, k
from lagrotor.pair.quantities import Spins, Vector
from lagrotor.pair.scene import Link, Scene, Shock
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.shared_premises import TWO_MODES
from lagrotor.paper.rotor_pair.shocked_runs import EQUAL, OPPOSITE
from lagrotor.shown import scientific
from lagrotor.theory.natural_frequency import linear_pair
from lagrotor.theory.natural_rate import natural_rate

RANK = 1e-9  # singular values below it count as zero; the least along the run is near one
DIRECTION = 0.01  # the direction of a mode in a run of a small shock, to one part in a hundred
REST = 1e-3  # what two modes leave of the motion: the square of the shock, left out, is below it

FIVE, THREE = "the constrained pair has 5 degrees of freedom", "without the rotor spins it has 3"
TOPPLING, PRECESSION = "one mode is toppling in the Y-Z plane", "one mode is the paired precession"
TWO = "these 2 are its modes"


def _constraints(r1: ArrayLike, r2: ArrayLike, link: Link | None) -> Array:
    """Gradients of the constraints, one row each: the unit lengths and, where there is one, the bar (ℓ = R)."""
    r1, r2 = np.asarray(r1, dtype=float), np.asarray(r2, dtype=float)
    d, none = np.array([1.0, 0, 0]) + r2 - r1, np.zeros(3)
    rows = [[*r1, *none], [*none, *r2], *([[*-d, *d]] if link else [])]
    return np.array(rows)


def measure_c14(link: Link | None) -> dict[str, float]:
    """Velocities less the rank of the constraints, along a shocked run.

    Velocities: six components of the axes and the two axial spins, whether the rotors turn or not (of the six Euler angles,
    four for the axes, with the two unit lengths built in, and two for the spins).
    """
    scene = Scene(OPPOSITE, link=link, shock=Shock((40, -11, 0), 0.5, 1 / 20))
    run = simulate(scene, np.linspace(0, 2.4, 25), "spheres", 1e-8)
    gradients = [_constraints(r1, r2, link) for r1, r2 in zip(*run.axes, strict=True)]
    values = [np.linalg.svd(rows, compute_uv=False) for rows in gradients]
    ranks = [int((v > RANK).sum()) for v in values]
    velocities = run.axes.shape[0] * run.axes.shape[2] + len(scene.spins)
    return {
        "velocities_of_axes_and_spins": velocities,
        "rank_of_constraints_least": min(ranks),
        "rank_of_constraints_most": max(ranks),
        "least_singular_value": min(v[-1] for v in values),
        "rank_where_axes_and_bar_are_in_line": float(np.linalg.matrix_rank(_constraints([1, 0, 0], [1, 0, 0], link))),
        "degrees_of_freedom": velocities - max(ranks),
        "degrees_of_freedom_without_spins": velocities - len(scene.spins) - max(ranks),
    }


def decide_c14(m: Mapping[str, float]) -> Finding:
    """Both counts, from a rank that is the same all along the run."""
    same = m["rank_of_constraints_least"] == m["rank_of_constraints_most"]
    return Finding(
        (
            Part(FIVE, same and m["degrees_of_freedom"] == 5),
            Part(THREE, same and m["degrees_of_freedom_without_spins"] == 3),
        ),
        f"{m['velocities_of_axes_and_spins']:.0f} velocities, constraints of rank {m['rank_of_constraints_most']:.0f} "
        f"all along the run (least singular value {m['least_singular_value']:.2f}; only where both axes and the bar lie "
        f"in one line it is {m['rank_where_axes_and_bar_are_in_line']:.0f}): {m['degrees_of_freedom']:.0f} degrees of "
        f"freedom, {m['degrees_of_freedom_without_spins']:.0f} without the two turns about the axes, whatever the spins.",
    )


def _counted(scene: Scene) -> dict[str, float]:
    """Roots of the linear pair, whose state has six components (x, y_1, y_2 and their velocities).

    A pair of imaginary roots is an oscillation; zero roots beyond the displacements at rest are steady turnings.
    """
    values = dict(zip((a, b, G_1, G_2), (*scene.inertias, *scene.momenta), strict=True)) | {k: 1}
    pair = linear_pair()
    M, C = (np.array(part.subs(values), dtype=float) for part in (pair.mass, pair.gyroscopic))
    state = np.block([[np.zeros((3, 3)), np.eye(3)], [np.zeros((3, 3)), -np.linalg.solve(M, C)]])
    roots = np.linalg.eigvals(state)
    # A double zero is known to the square root of the rounding only.
    rank, moving = int(np.linalg.matrix_rank(state)), abs(roots) > 1e-6 * max(abs(roots).max(), 1.0)
    return {
        "oscillations": int(moving.sum()) / 2,
        "zero_roots": 6 - int(moving.sum()),
        "displacements_at_rest": 6 - rank,
        "steady_turnings": rank - int(moving.sum()),
        "rate_rad_per_s": abs(roots).max(),
    }


@dataclass(frozen=True)
class _SmallMotion:
    """Spins (rad/s), and the shock (N) after which the motion is taken to be small."""

    spins: Spins = OPPOSITE
    force: Vector = (0.5, 0.3, 0)


def measure_c24(case: _SmallMotion) -> dict[str, float]:
    """The counts, and a run after the shock fitted by a constant, a slope and the natural rate."""
    scene = Scene(case.spins, link=HEAVY_LINK, shock=Shock(case.force, 0.2, 1 / 50))
    run = simulate(scene, [0.0, *np.linspace(0.4, 8, 200)], "spheres", 1e-11).after(0.4)
    x_y = np.concatenate(list(run.axes[..., :2]), axis=1)
    fit = harmonics_at(run.t, x_y, natural_rate(scene), 1)
    (x_1, y_1, x_2, y_2), slope = fit.waves[0], fit.slope
    return _counted(scene) | {
        "left_by_one_line_and_a_slope_relative": abs(fit.rest).max() / abs(x_y).max(),
        "slope_y_1_per_s": slope[1],
        "slope_ratio_y_2_to_y_1": slope[3] / slope[1],
        "slope_x_over_slope_y": abs(slope[0] / slope[1]),
        "wave_ratio_x_2_to_x_1": (x_2 / x_1).real,
        "wave_ratio_y_2_to_y_1": (y_2 / y_1).real,
        "centre_x_1": fit.constant[0] - slope[0] * (run.t - run.t[0]).mean(),
    }


def decide_c24(m: Mapping[str, float]) -> Finding:
    """One steady turning, alike in y_1 and y_2 and none in x; one oscillation, alike in x and opposite in y; no more."""
    slopes = m["slope_ratio_y_2_to_y_1"] - 1, m["slope_x_over_slope_y"]
    waves = m["wave_ratio_x_2_to_x_1"] - 1, m["wave_ratio_y_2_to_y_1"] + 1
    one_each = m["steady_turnings"] == 1 and m["oscillations"] == 1
    complete = one_each and m["left_by_one_line_and_a_slope_relative"] < REST
    return Finding(
        (
            Part(TOPPLING, m["steady_turnings"] == 1 and max(map(abs, slopes)) < DIRECTION),
            Part(PRECESSION, m["oscillations"] == 1 and max(map(abs, waves)) < DIRECTION),
            # Without the word oscillations, which 6.01 prints, two modes may be counted: section 5.2 does.
            Part(TWO, complete and m["oscillations"] == 2, TWO_MODES if complete else ""),
        ),
        f"{m['oscillations']:.0f} oscillation at {m['rate_rad_per_s']:.3f} rad/s, with x₂ : x₁ = "
        f"{m['wave_ratio_x_2_to_x_1']:+.3f} and y₂ : y₁ = {m['wave_ratio_y_2_to_y_1']:+.3f}, and {m['zero_roots']:.0f} zero "
        f"roots: {m['displacements_at_rest']:.0f} displacements at rest and {m['steady_turnings']:.0f} steady turning, along "
        f"y₂ : y₁ = {m['slope_ratio_y_2_to_y_1']:+.4f}. A run of 8 s is made of these to "
        f"{scientific(m['left_by_one_line_and_a_slope_relative'])} of its motion. To first order the pair has three "
        "degrees of freedom: paired precession, which oscillates; steady turning about the joint line; and the displacement "
        "of the precession centre (in x and in the twist), which has no rate and stays where a shock leaves it, here at x = "
        f"{m['centre_x_1']:+.5f}. Of the two modes of the paper one oscillates.",
    )


# No spins change the count of C14: a rotor at rest about its axis keeps that degree of freedom. Without its bar the pair has 6
# and 4.
# C24: after ten times the shock more is in the motion than its modes.
C14 = ClaimTest(
    "C14",
    HEAVY_LINK,
    {FIVE: None, THREE: None},
    "exact pair (spheres), bar m = 1 kg, K = 1 kg m²",
    measure_c14,
    decide_c14,
    unproved="it is a count, of a rank along a run; equation 5.09 has the constraint",
)
C24 = ClaimTest(
    "C24",
    _SmallMotion(),
    {TOPPLING: _SmallMotion(EQUAL), PRECESSION: _SmallMotion(EQUAL), TWO: _SmallMotion(force=(5, 3, 0))},
    "linear pair; exact pair (spheres), bar m = 1 kg, K = 1 kg m²",
    measure_c24,
    decide_c24,
    unproved="it is a count of roots, and of what a small motion shows",
)
