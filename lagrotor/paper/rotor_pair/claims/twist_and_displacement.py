"""Claims of sections 5 and 5.1: why (7) fails for opposite spins, and the mean displacement in x (C12, C13)."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np

from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import mean_between, measured_order
from lagrotor.pair.examples import HEAVY_LINK
from lagrotor.pair.quantities import Vector
from lagrotor.pair.scene import Link
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.proved_parts import axes_part, mean_displacement
from lagrotor.paper.rotor_pair.shocked_runs import (
    OPPOSITE,
    PAPER_RUN,
    after_shock,
    angle_between,
    shock_of,
    shocked_scene,
)
from lagrotor.theory.natural_rate import natural_rate

ALIKE = 0.1  # (7) holds to one part in ten, the accuracy to which a graph is compared with another
PARTED = 0.1  # rad, 6°: an angle that is seen
STIFFER = (10.0, 100.0, 1000.0)  # kg m², bars that resist twisting more and more
FORCES = (5.0, 10.0, 20.0)  # N, small shocks
NONE = 1e-6  # a mean within a hundred times the error of the runs is none
FASTER = 1.5  # a displacement that vanishes faster than the shock, its power half way from 1 to 2 or above, is none

FAILS, TWISTS, PARTS = "(7) fails for opposite spins", "the link twists out of its plane", "r₁ and r₂ are not parallel"
CAUSE = "the twist is the cause: where it is prevented, (7) holds"
NO_MEAN = "r₁ and r₂ have on average no displacement in x"


@dataclass(frozen=True)
class Twistable:
    """Inertia K (kg m²) of a bar that a twist has to turn, and those of three bars that are to prevent the twist."""

    K: float = HEAVY_LINK.inertia
    stiffer: tuple[float, float, float] = STIFFER


def measure_c12(case: Twistable) -> dict[str, float]:
    """Opposite spins with a bar that a twist has to turn, then with stiffer ones; shock along x.

    x over that without spins, which is what (7) gives for opposite spins; angle between the axes, and of the bar to the
    line through the grounds.
    """
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
    """x against (7), the twist of the bar and the angle of the axes; and the same with the bar that resists most."""
    x, *ratios = (m[f"largest_x_over_unspun_{bar}"] for bar in ("own", "stiffer_1", "stiffer_2", "stiffer_3"))
    bars = [m[f"inertia_kg_m2_stiffer_{i}"] for i in (1, 2, 3)]
    untwisted = m["largest_twist_of_bar_rad_stiffer_3"] < PARTED
    return Finding(
        (
            Part(FAILS, abs(x - 1) > ALIKE),
            Part(TWISTS, m["largest_twist_of_bar_rad_own"] > PARTED),
            Part(PARTS, m["largest_angle_of_axes_rad_own"] > PARTED),
            Part(CAUSE, untwisted and abs(ratios[-1] - 1) < ALIKE),
        ),
        f"Parted is by more than {PARTED} rad, and alike within a tenth. With this bar the link twists by "
        f"{m['largest_twist_of_bar_rad_own']:.2f} rad within 2.4 s, the axes part by "
        f"{m['largest_angle_of_axes_rad_own']:.2f} rad ({m['largest_angle_of_axes_rad_8_s']:.2f} within 8 s), and x reaches "
        f"{x:.2f} of what it would without spins, which is what (7) gives; with K = {bars[0]:g}, {bars[1]:g}, "
        f"{bars[2]:g} kg m² against the twist it is {ratios[0]:.2f}, {ratios[1]:.2f}, {ratios[2]:.2f} of it, and the angle "
        f"falls to {m['largest_angle_of_axes_rad_stiffer_3']:.3f} rad. With ℓ = R the angle between the axes is the one by "
        "which the bar has turned out of the line of the grounds.",
    )


def _means(cycles: float, force: Vector) -> Array:
    """Means (2,) of x_1 and x_2 over some cycles of the natural rate, from the end of the shock."""
    run = after_shock(shocked_scene(OPPOSITE, force), 6.5)
    seconds = cycles * 2 * pi / natural_rate(run.scene)
    return mean_between(run.t, run.axes[..., 0].T, run.t[0], run.t[0] + seconds)


def _powers(means: list[Array], name: str) -> dict[str, float]:
    """Powers of the shock in the common part of the means of x_1 and x_2, and in half their difference."""
    both = np.array(means)
    parts = {"common_mean": both.mean(1), "half_difference": (both[:, 0] - both[:, 1]) / 2}
    return {
        f"power_of_shock_{name}_in_{part}": measured_order(FORCES, np.maximum(abs(values), 1e-15))
        for part, values in parts.items()
    }


def measure_c13(cycles: float) -> dict[str, float]:
    """Means of x_1 and x_2 after small shocks along x and along y, their powers, and those after the paper's 50 N."""
    along, across = [_means(cycles, (f, 0, 0)) for f in FORCES], [_means(cycles, (0, f, 0)) for f in FORCES]
    scene = shocked_scene(OPPOSITE, (0, FORCES[0], 0))
    return {
        "shock_along_x_20_N_mean_x_1": along[-1][0],
        "shock_along_x_20_N_mean_x_2": along[-1][1],
        **_powers(along, "along_x"),
        "shock_along_y_5_N_mean_x": across[0].mean(),
        "shock_along_y_5_N_predicted": -shock_of(scene).impulse[1] / (2 * scene.momenta[0]),
        **_powers(across, "along_y"),
        "shock_along_x_50_N_mean_x": _means(cycles, (50, 0, 0)).mean(),
        "shock_along_y_50_N_mean_x": _means(cycles, (0, 50, 0)).mean(),
    }


def decide_c13(m: Mapping[str, float]) -> Finding:
    """Return whether the means of x_1 and x_2 are none, or vanish faster than the shock, along the bar and across it."""
    none = max(abs(value) for name, value in m.items() if "_mean_x" in name) < NONE
    along, across = (
        min(m[f"power_of_shock_{way}_in_{part}"] for part in ("common_mean", "half_difference")) > FASTER
        for way in ("along_x", "along_y")
    )
    needs = "to first order in the shock" if across else "the shock is along x, and to first order in it"
    return Finding(
        (Part(NO_MEAN, none, needs if along else ""),),
        "Means are over four cycles of the natural rate. After 20 N along x those of x₁ and x₂ are "
        f"{m['shock_along_x_20_N_mean_x_1']:+.4f} and {m['shock_along_x_20_N_mean_x_2']:+.4f}; their common part goes as F to "
        f"the power {m['power_of_shock_along_x_in_common_mean']:.2f}, half their difference to the power "
        f"{m['power_of_shock_along_x_in_half_difference']:.2f}. After 5 N along y the mean is "
        f"{m['shock_along_y_5_N_mean_x']:+.5f} (−PR/(2G), with P the impulse, gives {m['shock_along_y_5_N_predicted']:+.5f}), "
        f"as F to the power {m['power_of_shock_along_y_in_common_mean']:.2f}. After the paper's 50 N it is "
        f"{m['shock_along_x_50_N_mean_x']:+.3f} along x and {m['shock_along_y_50_N_mean_x']:+.3f} along y.",
    )


# C12: a bar of 1000 kg m² does not twist; then the axes stay parallel and (7) holds. Bars of 0.5 kg m² and less prevent no
# twist. C13: a quarter of a cycle is no average.
C12 = ClaimTest(
    "C12",
    Twistable(),
    {**dict.fromkeys((FAILS, TWISTS, PARTS), Twistable(1000.0)), CAUSE: Twistable(stiffer=(0.1, 0.2, 0.5))},
    "exact pair (spheres), bar m = 1 kg, K = 1 to 1000 kg m²",
    measure_c12,
    decide_c12,
    lambda case: axes_part(PARTS, Link(mass=1, inertia=case.K)) if case == Twistable() else (),
    "the other parts compare runs with bars of several inertias, to one part in ten",
)
C13 = ClaimTest(
    "C13",
    4.0,
    {NO_MEAN: 0.25},
    "exact pair (spheres), bar m = 1 kg, K = 1 kg m²",
    measure_c13,
    decide_c13,
    lambda cycles: mean_displacement(NO_MEAN) if cycles >= 4 else (),
)
