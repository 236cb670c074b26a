# %% [markdown]
# # Runs of the exact top
#
# **Objective.** What the text says of nutation, of the mean precession and of the sleeping top, tested by runs.
#
# **Assumptions.** $I_1 = 0.66$, $I_3 = 0.5$ kg m², $m = 1$ kg, $l = 0.6$ m. "Fast" is 60 rad/s.

# %%
from functools import cache

import numpy as np
from symbols import I_1, I_3, c, g, l, m
from top import VALUES, top

from lagrotor.paper import ClaimTest, Finding, Part, scientific

FAST, THETA_0 = 60.0, 0.5
NEAR = 0.02  # one rate is another: to two parts in a hundred
AT_REST = 1e-3  # of the largest precession rate
phi_v, theta_v, _ = c.v
EXACT = "exact top"


@cache
def released(spin: float, push: float = 0.0):
    """A run over ten nutations from THETA_0, with the precession rate `push` (rad/s), and the times of its turning points."""
    period = 2 * np.pi * VALUES[I_1] / (VALUES[I_3] * spin)
    start = (push, 0.0, spin - push * np.cos(THETA_0))
    run = top.simulate(VALUES, (0.0, THETA_0, 0.0), start, np.linspace(0, 10 * period, 2001), tol=1e-11)
    return run, run.crossings(theta_v).t


# %% [markdown]
# ## C01: cusps
#
# Two kinds of turning points alternate; at every second one the axis is back at $\theta_0$ and its precession is compared with
# zero. A push along the precession is the case in which the axis does not come to rest.

# %%
BETWEEN, RESTS = "the inclination swings between two values", "the axis comes to rest at the upper one"


def measure_c01(push: float) -> dict[str, float]:
    """The inclinations at the turning points; how far it sinks; the precession at the upper ones over the largest."""
    run, turns = released(FAST, push)
    lower, upper = run.at(turns[turns > 1e-6][::2]), run.at(turns[turns > 1e-6][1::2])
    sunk = np.cos(THETA_0) - np.cos(lower.q[:, 1]).mean()
    printed = VALUES[m] * VALUES[g] * VALUES[l] * VALUES[I_1] * np.sin(THETA_0) ** 2 / (VALUES[I_3] * FAST) ** 2
    return {
        "spread of the lower (rad)": np.ptp(lower.q[:, 1]),
        "spread of the upper (rad)": np.ptp(upper.q[:, 1]),
        "sunk": sunk,
        "over_printed": sunk / printed,
        "precession at the upper": np.abs(upper.v[:, 0]).max() / np.abs(run.v[:, 0]).max(),
    }


def decide_c01(found: dict[str, float]) -> Finding:
    """Both spreads against the extent of the nutation; the precession against zero."""
    spread = max(found["spread of the lower (rad)"], found["spread of the upper (rad)"])
    parts = Part(BETWEEN, spread < AT_REST * found["sunk"]), Part(RESTS, found["precession at the upper"] < AT_REST)
    text = (
        f"The turning points lie within {scientific(spread)} rad of two inclinations; the axis sinks by "
        f"{found['sunk']:.5f} in the cosine, {found['over_printed']:.3f} times what (3.2) prints; at the upper ones it "
        f"precesses at {scientific(found['precession at the upper'])} of its largest rate."
    )
    return Finding(parts, text)


ClaimTest("C01", 0.0, {RESTS: 0.5}, EXACT, measure_c01, decide_c01)

# %% [markdown]
# ## C02: the mean precession
#
# A slow top is the case in which the printed rate is not the mean.

# %%
MEAN = "the mean precession is at the slow rate"


def measure_c02(spin: float) -> dict[str, float]:
    """The mean precession rate over whole nutations (rad/s), and over the printed one."""
    run, turns = released(spin)
    whole = run.at(turns[turns > 1e-6][1::2])
    mean = (whole.q[-1, 0] - whole.q[0, 0]) / (whole.t[-1] - whole.t[0])
    printed = VALUES[m] * VALUES[g] * VALUES[l] / (VALUES[I_3] * spin)
    return {"mean (rad/s)": mean, "over_printed": mean / printed}


def decide_c02(found: dict[str, float]) -> Finding:
    """The ratio against one."""
    text = f"The mean precession is {found['mean (rad/s)']:.4f} rad/s, {found['over_printed']:.4f} of the printed rate."
    return Finding((Part(MEAN, abs(found["over_printed"] - 1) < NEAR),), text)


ClaimTest("C02", FAST, {MEAN: 8.0}, EXACT, measure_c02, decide_c02)

# %% [markdown]
# ## C03: sleep
#
# The spin is a tenth above and a tenth below $2\sqrt{mglI_1}/I_3$, the corrected threshold; the tilt is 0.01 rad at first. Held
# against the printed threshold, which for these inertias is lower, the claim comes out otherwise.

# %%
STAYS, FALLS = "above the threshold the top stays upright", "below it falls"


def measure_c03(threshold: float) -> dict[str, float]:
    """The largest inclinations (rad) within 10 s for spins about this threshold (rad/s)."""
    found = {}
    for name, factor in (("above (rad)", 1.1), ("below (rad)", 0.9)):
        start = (0.0, 0.0, factor * threshold)
        run = top.simulate(VALUES, (0.0, 0.01, 0.0), start, np.linspace(0, 10, 2001), tol=1e-10)
        found[name] = float(run.q[:, 1].max())
    return {"threshold (rad/s)": threshold, **found}


def decide_c03(found: dict[str, float]) -> Finding:
    """Upright is within 0.2 rad, fallen beyond half a radian."""
    text = (
        f"About {found['threshold (rad/s)']:.2f} rad/s the inclination reaches {found['above (rad)']:.3f} rad above and "
        f"{found['below (rad)']:.2f} rad below."
    )
    return Finding((Part(STAYS, found["above (rad)"] < 0.2), Part(FALLS, found["below (rad)"] > 0.5)), text)


root = 2 * np.sqrt(VALUES[m] * VALUES[g] * VALUES[l] * VALUES[I_1])
ClaimTest("C03", root / VALUES[I_3], {STAYS: root / np.sqrt(VALUES[I_3])}, EXACT, measure_c03, decide_c03)

# %% [markdown]
# ## C04: the rate of nutation
#
# The text says it of a top, without a word on its spin: it is measured at 60 and at 8 rad/s.

# %%
AT_THE_RATE = "the top nutates at the rate I₃ω₃/I₁"


def measure_c04(spins: tuple[float, float]) -> dict[str, float]:
    """The rate of nutation over the printed one, of a fast and of a slow top."""
    found = {}
    for name, spin in zip(("fast", "slow"), spins, strict=True):
        _, turns = released(spin)
        inside = turns[turns > 1e-6]
        period = 2 * (inside[-1] - inside[0]) / (len(inside) - 1)
        found[name] = 2 * np.pi / period / (VALUES[I_3] * spin / VALUES[I_1])
    return found


def decide_c04(found: dict[str, float]) -> Finding:
    """Both ratios against one."""
    fast, slow = (abs(found[name] - 1) < NEAR for name in ("fast", "slow"))
    text = f"Over the printed rate that of a fast top is {found['fast']:.4f}, that of a slow one {found['slow']:.3f}."
    return Finding((Part(AT_THE_RATE, fast and slow, "the top is fast" if fast else ""),), text)


ClaimTest("C04", (FAST, 8.0), {AT_THE_RATE: (8.0, 8.0)}, EXACT, measure_c04, decide_c04)
