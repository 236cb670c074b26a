# %% [markdown]
# # Figure n6: spin against push
#
# At which spins a corner of three falls from which pushes, by the law of third order and on the exact motion, and when.

# %%
from dataclasses import replace
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Structure
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.structures import local_hamiltonian, measured_fall, resonant_factors

CORNER = Structure(joints=[(0, 0), (1, 0), (1, 1)], bars=[(0, 1), (1, 2)], spins=[1, 0, 1], gravity=9.81, load=2.0)
PUSHES, OFFSETS = (0.015, 0.03), (-0.02, -0.012, -0.006, 0.0, 0.006, 0.012, 0.02)  # √(κ/a); of the critical spins
TIMED = (0.01, 0.02, 0.04)  # √(κ/a), the pushes whose times are compared
DIRECTION = np.array(
    [[-0.051, -0.647], [-0.051, -0.265], [0.661, -0.265]]
)  # of length 1, rates of the axes; a steep one

TITLE = "Falls of the corner near a resonance"
ALT = (
    "Left: pushes and spins, in units of the critical ones. Two straight lines rise from a point at 1.0607. All exact runs "
    "that fell lie between the lines, and the runs outside did not fall. Right: the time until the corner falls as a "
    "function of the push, on logarithmic axes. Exact runs lie along a line of slope minus one, above the least time of any "
    "direction."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """centre and width: of the window, in critical spins, and for a push of 1 √(κ/a); ends (offsets, pushes): times of exact
    runs, inf where they stayed; exact, said, least (3,): times of TIMED."""
    critical, rate = CORNER.critical_spin(), local_hamiltonian(CORNER).rate
    (factor, resonance), *_ = resonant_factors(CORNER, (3,))
    low, high = resonance.window(rate)
    at_centre = replace(CORNER, spins=(factor, 0, factor))
    beside = [replace(CORNER, spins=(factor + off * critical, 0, factor + off * critical)) for off in OFFSETS]
    standing = at_centre.stands()

    def exact(s: Structure, push: float) -> float:
        return measured_fall(s, push * rate * DIRECTION, 2 / (push * rate), tol=1e-8) * rate

    return {
        "centre": np.array(factor / critical),
        "width": np.array((high - low) / 2 / critical),
        "ends": np.array([[exact(s, push) for push in PUSHES] for s in beside]),
        "exact": np.array([exact(at_centre, push) for push in TIMED]),
        "said": np.array([standing.fall_time(push * rate * DIRECTION) * rate for push in TIMED]),
        "least": np.array([resonance.least_time(push * rate) * rate for push in TIMED]),
    }


# %%
def measure() -> dict[str, float]:
    """The window's place and width, falls outside it, falls within its inner third, and times."""
    d = data()
    inside = np.abs(np.array(OFFSETS))[:, None] / (d["width"] * np.array(PUSHES))
    fell = np.isfinite(d["ends"])
    return {
        "at, critical spins": float(d["centre"]),
        "half the window for a push of 0.01": float(d["width"] / 100),
        "falls outside the window": float((fell & (inside > 1)).sum()),
        "runs outside the window": float((inside > 1).sum()),
        "stays in its inner third": float((~fell & (inside < 1 / 3)).sum()),
        "slope of the times": float(np.polyfit(np.log(TIMED), np.log(d["exact"]), 1)[0]),
        "largest distance from the normal form": float(np.abs(d["exact"] - d["said"]).max()),
        "exact over least, smallest": float((d["exact"] / d["least"]).min()),
    }


_centre, _half, _outside, _runs, _, _slope, _off, _over = measure().values()
CAPTION = (
    "The corner has three rotors, the middle one without spin, 2 kg on each tip, and massless bars. Pushes are in "
    "√(κ/a), times in "
    f"√(a/κ). (a) At {_centre:.4f} times the critical spins two slow rates add up to a fast one. The two lines are {_half:.4f} "
    "to each side for a push of 0.01. Outside them no motion falls according to the terms of third order; "
    f"{_outside:.0f} of {_runs:.0f} exact runs fell there. (b) The time until the corner falls at the resonance, "
    "for a push in a "
    f"direction of fast growth. The exact time is proportional to the push to the power −{-_slope:.3f}. It differs "
    "from the normal "
    f"form of fourth order by at most {_off:.1f} √(a/κ), and is at least {_over:.2f} times the minimum over all directions."
)


# %%
def figure() -> Figure:
    """The map of spins and pushes; the times at the resonance."""
    d = data()
    picture = Figure(figsize=(8.6, 4.6))
    plane, times = picture.subplots(1, 2, width_ratios=(1.3, 1))
    reach = np.linspace(0, 0.04, 2)
    edges = [d["centre"] + sign * d["width"] * reach for sign in (-1, 1)]
    plane.fill_betweenx(reach, *edges, color=CORRECTION_COLOUR, alpha=0.2, lw=0, label="may fall, third order")
    for edge in edges:
        plane.plot(edge, reach, color=CORRECTION_COLOUR, label="may fall, third order")
    x, y = np.meshgrid(d["centre"] + np.array(OFFSETS), PUSHES, indexing="ij")
    fell = np.isfinite(d["ends"])
    plane.plot(x[fell], y[fell], "o", color=EXACT_COLOUR, label="exact run, fell")
    plane.plot(x[~fell], y[~fell], "o", color=EXACT_COLOUR, mfc="none", label="exact run, stayed")
    plane.set(xlabel="spins / critical spins", ylabel="push (√(κ/a))", title="Pushes after which it falls")
    plane.set(xlim=(float(d["centre"]) - 0.027, float(d["centre"]) + 0.027), ylim=(0, 0.04))
    times.loglog(TIMED, d["said"], "-", color=CORRECTION_COLOUR, label="normal form, this direction")
    times.loglog(TIMED, d["least"], "--", color=CORRECTION_COLOUR, label="least time of any direction")
    times.loglog(TIMED, d["exact"], "o", color=EXACT_COLOUR, mfc="none", label="exact motion")
    times.set(xlabel="push (√(κ/a))", ylabel="time to fall (√(a/κ))", title="Time to fall at resonance")
    times.set(xlim=(0.008, 0.05), xticks=TIMED, xticklabels=[f"{push:g}" for push in TIMED])
    times.set(yticks=(25, 50, 100), yticklabels=("25", "50", "100"), ylim=(20, 160))
    times.minorticks_off()
    legend_below(picture, 3)
    return picture
