# %% [markdown]
# # Figure t12: unequal spins
#
# How the rate shifts with the amplitude, and how fast the azimuth drifts, from opposite to equal spins for two bars; exact orbits
# on both laws.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, natural_rate
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, EXACT_COLOUR, legend_below
from lagrotor.models import upright_orbit
from lagrotor.theory import azimuth_drift, frequency_shift

BARS = {
    "b < 0: m = 0.01 kg, K = 0.1 kg m²": (Link(1, 0.01, 0.1), CASE_COLOURS[0]),
    "b > 0: m = 1 kg, K = 0": (Link(1, 1.0), CASE_COLOURS[1]),
}
R0, TRIED, FINE = 0.06, np.array([-0.7, -0.3, 0.1, 0.5]), np.linspace(-0.999, 1, 121)

TITLE = "Unequal spins: shift of the rate and drift of the azimuth"
ALT = (
    "Left: the relative shift of the rate divided by the square of the amplitude, as a function of the ratio of the spins, "
    "for two bars. Both curves end at one half for equal spins. Right: the drift of the azimuth divided by the fourth power "
    "of the amplitude. It is zero for equal spins and negative elsewhere. Exact circles lie on all curves."
)


# %%
def scene(link: Link, ratio: float) -> Scene:
    """Spins of 10 rad/s and `ratio` of it."""
    return Scene(spins=(10, 10 * ratio), link=link)


@cache
def data() -> dict[str, np.ndarray]:
    """Shift over r0² and drift over r0⁴ (rad/s): laws (2, n) over the fine ratios, exact (2, 4) and laws at the tried ones."""
    links = [link for link, _ in BARS.values()]
    orbits = [[upright_orbit(scene(link, float(x)), R0) for x in TRIED] for link in links]
    natural = np.array([[natural_rate(scene(link, float(x))) for x in TRIED] for link in links])
    return {
        "shift": np.array([[frequency_shift(scene(link, float(x))) for x in FINE] for link in links]),
        "drift": np.array([[azimuth_drift(scene(link, float(x))) for x in FINE] for link in links]),
        "exact shift": (np.array([[orbit.frequency for orbit in row] for row in orbits]) / natural - 1) / R0**2,
        "exact drift": np.array([[orbit.turning for orbit in row] for row in orbits]) / R0**4,
        "shift there": np.array([[frequency_shift(scene(link, float(x))) for x in TRIED] for link in links]),
        "drift there": np.array([[azimuth_drift(scene(link, float(x))) for x in TRIED] for link in links]),
    }


# %%
def measure() -> dict[str, float]:
    """Largest distances of the exact orbits from the laws, of the largest value of each."""
    d = data()
    return {
        f"largest distance, {name}": float(
            np.abs(d[f"exact {name}"] - d[f"{name} there"]).max() / np.abs(d[f"exact {name}"]).max()
        )
        for name in ("shift", "drift")
    }


_shift, _drift = measure().values()
CAPTION = (
    "The first spin is 10 rad/s; the second is the first multiplied by the ratio on the horizontal axis. For exact "
    "orbits of r₀ = "
    f"{R0} (circles) the shift (a) differs from the curve by at most {100 * _shift:.1f} %, and the drift (b) by at most "
    f"{100 * _drift:.1f} %, of the largest value. For opposite spins the paired precession is a closed orbit. The law "
    "of the drift "
    "requires that r₀² is much smaller than (G₁ + G₂)/(G₁ − G₂)."
)


# %%
def figure() -> Figure:
    """Shift and drift against the ratio of the spins."""
    d = data()
    picture = Figure(figsize=(7.4, 4.2))
    left, right = picture.subplots(1, 2)
    for panel, name, label in (
        (left, "shift", "relative shift of the rate / r₀²"),
        (right, "drift", "drift of the azimuth / r₀⁴ (rad/s)"),
    ):
        for i, (bar, (_, colour)) in enumerate(BARS.items()):
            panel.plot(FINE, d[name][i], color=colour, ls=CASE_DASHES[colour], label=f"closed form, {bar}")
            panel.plot(TRIED, d[f"exact {name}"][i], "o", color=EXACT_COLOUR, mfc="none", ms=6, label="exact orbits")
        panel.axhline(0, color="0.6", lw=0.7)
        panel.set(xlabel="ratio of the spins ω₂/ω₁", ylabel=label)
    left.set_title("Shift of the rate")
    right.set_title("Drift of the azimuth")
    legend_below(picture, 2)
    return picture
