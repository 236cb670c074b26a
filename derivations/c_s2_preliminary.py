# %% [markdown]
# # Claims of section 2: the parallel pair (C01, C02)
#
# **Objective.** What equal spins do after a shock, and whether opposite spins respond as if there were none.
#
# **Assumptions.** The bar of section 4.1 ($m = K = 1$), the shock of section 4.2: 50 N along x on tip 1, width 1/50 s.
# The paper's two seconds of rest before it are cut to ten widths.

# %%
from math import pi

import numpy as np

from lagrotor import Link, Scene, Shock, natural_rate, simulate
from lagrotor.paper.claim_tests import ClaimTest, Finding

BAR, WIDTH, AT = Link(mass=1, inertia=1), 1 / 50, 0.2
AFTER = AT + 5 * WIDTH  # the shock is over


def shocked(spins, force, seconds):
    """The exact pair from the end of the shock to `seconds` after its peak, and the impulse's components."""
    scene = Scene(spins, link=BAR, shock=Shock(force, AT, WIDTH))
    t = np.linspace(AFTER, AT + seconds, int(40 * seconds) + 1)
    return simulate(scene, t, "spheres", 1e-9), scene.shock.impulse


def angle(run):
    """Angle between the two axes, from their difference: exact where they are nearly parallel."""
    return 2 * np.arcsin(np.linalg.norm(run.axes[1] - run.axes[0], axis=-1) / 2)


def centre(run, start, cycles=5):
    """Mean axes (2, 3) over whole cycles of the natural rate."""
    period = 2 * pi / natural_rate(run.scene) if any(run.scene.spins) else 1.0
    t = run.t[0] + start + period * cycles * np.linspace(0, 1, 200, endpoint=False)
    return np.array([[np.interp(t, run.t, part).mean() for part in axis.T] for axis in run.axes])


Scene((10, 10), link=BAR, shock=Shock((50, 0, 0), AT, WIDTH))

# %% [markdown]
# ## C01: equal spins precess alike and stay displaced
#
# "Remains": the mean axis over the last five cycles is within one part in a hundred of that over the first five, and
# within a tenth of what (7) gives, $P_x R/(2G)$. The angle between the axes answers the paper's word that the motion is
# trivial because the axes are "necessarily aligned at all times" (section 5): for the paper's shock on tip 1 only, and
# for the same shock across the bar.


# %%
def measure_c01(spins):
    run, impulse = shocked(spins, (50, 0, 0), 12.0)
    first, last = centre(run, 0.0), centre(run, run.t[-1] - run.t[0] - 5 * 2 * pi / natural_rate(run.scene))
    off = run.axes[..., :2] - last[:, None, :2]
    turning = off[..., 0] * run.rates[..., 1] - off[..., 1] * run.rates[..., 0]
    sense = turning.mean(1) / (off**2).sum(-1).mean(1)
    across, _ = shocked(spins, (0, 50, 0), 12.0)
    parted = angle(across)
    return {
        "precession_1_rad_per_s": sense[0],
        "precession_2_rad_per_s": sense[1],
        "displacement_1_first_cycles": first[0, 1],
        "displacement_1_last_cycles": last[0, 1],
        "displacement_2_last_cycles": last[1, 1],
        "displacement_by_equation_7": impulse[0] / (abs(spins[0]) + abs(spins[1])),
        "angle_of_axes_shock_along_bar_rad": angle(run).max(),
        "angle_of_axes_shock_across_bar_rad": parted.max(),
        "seconds_until_axes_part_by_0.1_shock_across_bar": across.t[np.argmax(parted > 0.1)] - AT,
    }


def decide_c01(m):
    same = m["precession_1_rad_per_s"] * m["precession_2_rad_per_s"] > 0
    stays = abs(m["displacement_1_last_cycles"] / m["displacement_1_first_cycles"] - 1) < 0.01
    as_7 = all(abs(m[f"displacement_{i}_last_cycles"] / m["displacement_by_equation_7"] - 1) < 0.1 for i in (1, 2))
    how = (
        f"The axes turn at {m['precession_1_rad_per_s']:+.2f} and {m['precession_2_rad_per_s']:+.2f} rad/s; their "
        f"means stay displaced by {m['displacement_1_last_cycles']:+.4f} and {m['displacement_2_last_cycles']:+.4f} "
        f"across the shock, (7) gives {m['displacement_by_equation_7']:.4f}. "
    )
    if not (same and stays and as_7):
        return Finding("refuted", how)
    return Finding(
        "confirmed",
        how + "That the axes are aligned at all times (section 5) holds for this shock along the bar, to "
        f"{m['angle_of_axes_shock_along_bar_rad']:.0e} rad; the same shock across the bar on one tip parts them by "
        f"0.1 rad within {m['seconds_until_axes_part_by_0.1_shock_across_bar']:.2f} s and by "
        f"{m['angle_of_axes_shock_across_bar_rad']:.2f} rad within 12 s: alignment is not necessary.",
    )


# %% [markdown]
# ## C02: opposite spins as if there were none
#
# The largest x in the 2.4 s after the shock against that without spins, which by then has nearly fallen flat. "As if": to
# one part in ten. Beside it the mean displacement over (7) for equal and for unequal spins (a shock a fifth as large, so
# that squares of the amplitude do not show), and the turning about the joint line after a shock along y.


# %%
def drift_over_7(spins):
    run, impulse = shocked(spins, (10, 0, 0), 8.0)
    return centre(run, 0.0)[:, 1].mean() * sum(spins) / impulse[0]


def turned(spins):
    run, _ = shocked(spins, (0, 50, 0), 2.4)
    return abs(np.unwrap(np.arctan2(-run.axes[..., 1], run.axes[..., 2]))[:, -1].mean())


def measure_c02(spins):
    farthest, unspun = (abs(shocked(s, (50, 0, 0), 2.4)[0].axes[..., 0]).max() for s in (spins, (0, 0)))
    return {
        "largest_x": farthest,
        "largest_x_without_spins": unspun,
        "ratio_in_x": farthest / unspun,
        "ratio_of_turning_about_joint_line_shock_along_y": turned(spins) / turned((0, 0)),
        "drift_over_equation_7_spins_10_10": drift_over_7((10, 10)),
        "drift_over_equation_7_spins_10_5": drift_over_7((10, 5)),
    }


def decide_c02(m):
    how = (
        f"Within 2.4 s of a shock along x the axes reach x = {m['largest_x']:.3f}, without spins "
        f"{m['largest_x_without_spins']:.3f}: {m['ratio_in_x']:.2f} of it; only in turning about the joint line, after "
        f"a shock along y, are the two alike (ratio {m['ratio_of_turning_about_joint_line_shock_along_y']:.2f}). The "
        f"displacement over that of (7) is {m['drift_over_equation_7_spins_10_10']:.3f} for spins 10 and 10, "
        f"{m['drift_over_equation_7_spins_10_5']:.3f} for 10 and 5."
    )
    return Finding("confirmed" if abs(m["ratio_in_x"] - 1) < 0.1 else "refuted", how)


# %%
tests = [
    ClaimTest("C01", (10, 10), (10, -10), "exact pair (spheres), bar m = K = 1", measure_c01, decide_c01),
    ClaimTest("C02", (10, -10), (0, 0), "exact pair (spheres), bar m = K = 1", measure_c02, decide_c02),
]
tests
