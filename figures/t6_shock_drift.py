# %% [markdown]
# # Figure t6: the drift after a shock, and the force that cancels it
#
# Mean turning about the joint line after a shock of 40 N along x, against the force along y in the same pulse: closed
# form of second order, exact runs, the paper's force and the cancelling ones.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, Shock, cancelling_force, toppling_after_shock
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.models import run_after, turning_rate

ALONG, CHOSEN, SWINGS = 40.0, -11.0, 8

TITLE = "The drift after a shock, and the force that cancels it"
ALT = (
    "Left: the mean turning rate about the joint line as a function of the force along y, from minus 20 to 5 newtons. The "
    "closed form and the exact points fall together through zero near minus 11 newtons, where a vertical line marks the "
    "paper's force. Right: the closed form minus the exact rate, a few hundredths of a radian per second, which grows to "
    "both sides."
)


# %%
def scene(across: float) -> Scene:
    """The shock of section 5.2.1 with another force along y."""
    return Scene(spins=(10, -10), link=Link(1, 0.01, 0.1), shock=Shock((ALONG, across, 0), 0.5, 1 / 20))


@cache
def data() -> dict[str, np.ndarray]:
    """Forces along y (N) and mean alpha' (rad/s): closed form on a fine grid, exact runs and closed form at a few."""
    fine = np.linspace(-20, 5, 51)
    tried = np.array([-20.0, -16, -13, CHOSEN, -9, -6, -3, 0, 5])
    return {
        "fine": fine,
        "closed": np.array([toppling_after_shock(scene(f)) for f in fine]),
        "tried": tried,
        "closed_tried": np.array([toppling_after_shock(scene(f)) for f in tried]),
        "exact": np.array([turning_rate(run_after(scene(f), SWINGS, 1e-9)) for f in tried]),
    }


# %%
def measure() -> dict[str, float]:
    """Cancelling forces (N): closed form, and where the exact rate passes zero; exact rates (rad/s)."""
    d = data()
    order = np.argsort(d["exact"])
    return {
        "cancelling force, second order (N)": cancelling_force(scene(0.0)),
        "cancelling force, exact runs (N)": np.interp(0.0, d["exact"][order], d["tried"][order]),
        "exact rate without a force along y (rad/s)": np.interp(0.0, d["tried"], d["exact"]),
        "exact rate with the paper's force (rad/s)": np.interp(CHOSEN, d["tried"], d["exact"]),
    }


_second, _exact, _without, _chosen = measure().values()
CAPTION = (
    "The spins are ±10 rad/s, the bar has m = 0.01 kg and K = 0.1 kg m², and the shock has F_x = "
    f"{ALONG:g} N for 1/20 s. The mean of alpha' over {SWINGS} oscillations vanishes at F_y = −{-_second:.2f} N to "
    "second order in "
    f"the shock, and at −{-_exact:.2f} N in the exact motion (a). With the paper's −{-CHOSEN:g} N it is {_chosen:+.4f} "
    "rad/s, and "
    f"without F_y it is −{-_without:.4f} rad/s. The closed form differs from the exact runs by the curve in (b)."
)


# %%
def figure() -> Figure:
    """Rate against force; closed form less exact."""
    d = data()
    picture = Figure(figsize=(7.4, 4.8))
    rate, residual = picture.subplots(1, 2, width_ratios=(1.5, 1))
    rate.axhline(0, color="#777777", lw=0.8)
    rate.axvline(CHOSEN, color=PAPER_COLOUR, ls="--", label=f"the paper's force, −{-CHOSEN:g} N")
    rate.plot(d["fine"], d["closed"], color=CORRECTION_COLOUR, label="closed form, second order")
    rate.plot(d["tried"], d["exact"], "o", color=EXACT_COLOUR, mfc="none", label="exact runs")
    rate.plot(_second, 0, "D", color=CORRECTION_COLOUR, ms=7, label=f"cancels to second order, −{-_second:.2f} N")
    rate.plot(_exact, 0, "*", color=EXACT_COLOUR, ms=11, label=f"cancels on exact runs, −{-_exact:.2f} N")
    rate.set(
        xlabel="force along y (N)", ylabel="mean turning rate (rad/s)", title="Mean turning rate", xlim=(-20.5, 5.5)
    )
    residual.plot(d["tried"], d["closed_tried"] - d["exact"], "o-", color=CORRECTION_COLOUR, mfc="none")
    residual.axhline(0, color="#777777", lw=0.8)
    residual.set(xlabel="force along y (N)", ylabel="difference (rad/s)", title="Closed form − exact")
    residual.set_xlim(-20.5, 5.5)
    legend_below(picture, 2)
    return picture
