# %% [markdown]
# # Figure t7: how long the x direction stays stable
#
# Times to lean by half a radian about the joint line and for the mean of x, over the swing and both axes, to move by a
# tenth, against the force of the shock over a decade, by the initial rates; and one run, in which leaning carries the twist
# into x.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, Shock, natural_rate, simulate, toppling_after_shock
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.models import run_after, time_to_wander, turning_rate, wandering_rate
from lagrotor.numerics import measured_order
from lagrotor.theory import wander_after_shock

LEAN, BOUND, SHOWN, AT = 0.5, 0.1, 12.0, 0.5
FORCES = np.array([2.0, 3.6, 6.3, 11.2, 20.0])
FOLLOWED = np.array([9.0, 13.0, 18.0])

TITLE = "Time of stability in x after a shock"
ALT = (
    "Left, on logarithmic axes: from 2 to 20 newtons the time to lean by half a radian falls as the square of the force, "
    "and the time for the mean x to move by a tenth falls as its cube. Exact points lie on both lines. Right: one run at 12 "
    "newtons. Here x oscillates about a mean that moves steadily away along the predicted straight line, while the mean "
    "turning angle grows along its predicted line."
)


# %%
def scene(force: float) -> Scene:
    """The bar of section 5.2.1 and a shock along x of width 1/20 s."""
    return Scene(spins=(10, -10), link=Link(1, 0.01, 0.1), shock=Shock((force, 0, 0), AT, 1 / 20))


def followed(force: float) -> float:
    """Time (s) until the mean of x over six swings reaches the bound on an exact run."""
    one = scene(force)
    return time_to_wander(one, BOUND, 1.5 * BOUND / abs(wander_after_shock(one)))


@cache
def data() -> dict[str, np.ndarray]:
    """Forces (N) and times (s) by closed form, by measured rates and followed; one run's mean x (1) and alpha (rad)."""
    runs = [run_after(scene(force), 16, 1e-9) for force in FORCES]
    turns = 24
    t = np.linspace(0, AT + turns * 2 * np.pi / natural_rate(scene(1)), 24 * turns)
    axes = simulate(scene(SHOWN), t, "minimal", 1e-9).axes
    return {
        "forces": FORCES,
        "lean_law": np.array([LEAN / abs(toppling_after_shock(scene(f))) for f in FORCES]),
        "leave_law": np.array([BOUND / abs(wander_after_shock(scene(f))) for f in FORCES]),
        "lean": np.array([LEAN / abs(turning_rate(run)) for run in runs]),
        "leave": np.array([BOUND / abs(wandering_rate(run)) for run in runs]),
        "followed": np.array([followed(force) for force in FOLLOWED]),
        "t": t,
        "x": axes[..., 0].mean(0),
        "alpha": np.arctan2(-axes[..., 1], axes[..., 2]).mean(0),
    }


# %%
def measure() -> dict[str, float]:
    """Powers of the force, measured over the decade, and times followed over those of the law."""
    d = data()
    found = {
        "power of the force, leaning": measured_order(FORCES, d["lean"]),
        "power of the force, x": measured_order(FORCES, d["leave"]),
    }
    for force, time in zip(FOLLOWED, d["followed"], strict=True):
        found[f"time followed at {force:g} N over the law's"] = time * abs(wander_after_shock(scene(force))) / BOUND
    return found


_lean, _leave, *_ratios = measure().values()
CAPTION = (
    "A pair at rest has opposite spins of ±10 rad/s and a bar with m = 0.01 kg, K = 0.1 kg m². (a) The time until the lean is "
    f"{LEAN:g} rad, and until the mean of x is {BOUND:g} R, according to the initial rates. The measured exponents of "
    "the force are "
    f"−{-_lean:.3f} and −{-_leave:.3f}. Circles use the mean rate of exact runs over 16 oscillations. Crosses are "
    "exact times; they "
    f"are {min(_ratios):.2f} to {max(_ratios):.2f} times the times of the law. (b) A run at {SHOWN:g} N. The shock "
    "leaves a twist "
    "p_x/G, and leaning about the joint line converts it into x."
)


# %%
def figure() -> Figure:
    """Times against force; one run."""
    d = data()
    picture = Figure(figsize=(7.4, 5.0))
    times, run = picture.subplots(1, 2)
    purple = CASE_COLOURS[2]
    times.loglog(
        FORCES, d["lean_law"], color=purple, ls=CASE_DASHES[purple], label="closed form: leaning, square of the force"
    )
    times.loglog(FORCES, d["leave_law"], color=CORRECTION_COLOUR, label="closed form: x, cube of the force")
    for name in ("lean", "leave"):
        times.loglog(
            FORCES, d[name], "o", color=EXACT_COLOUR, mfc="none", ms=6, label="exact mean rates", clip_on=False
        )
    times.loglog(FOLLOWED, d["followed"], "x", color=EXACT_COLOUR, ms=7, label="exact, mean of x at the bound")
    times.set(
        xlabel="force along x (N)", ylabel="time to the bound (s)", title="Time to reach the bound", xlim=(1.9, 21)
    )
    times.set_xticks([2, 5, 10, 20], ["2", "5", "10", "20"])
    times.set_xticks([], minor=True)
    run.plot(d["t"], d["x"], color=EXACT_COLOUR, lw=1.0, label="exact run: mean x of both axes (R)")
    run.plot(d["t"], d["alpha"], color=EXACT_COLOUR, ls=":", label="exact run: mean turning angle (rad)")
    after = d["t"] > AT
    run.plot(d["t"][after], wander_after_shock(scene(SHOWN)) * (d["t"][after] - AT), color=CORRECTION_COLOUR)
    run.plot(
        d["t"][after], toppling_after_shock(scene(SHOWN)) * (d["t"][after] - AT), color=purple, ls=CASE_DASHES[purple]
    )
    run.set(xlabel="time $t$ (s)", ylabel="mean x (R), turning angle (rad)", title=f"Run after {SHOWN:g} N")
    legend_below(picture, 2)
    return picture
