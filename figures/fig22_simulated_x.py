# %% [markdown]
# # Figure 22: simulated $x_1$ and $x_2$ over time
#
# The anti-spin pair of section 5.2.1 after its shock: x of both tips, by the exact model.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import simulate
from lagrotor.drawing import EXACT_COLOUR, ROTORS, legend_below
from lagrotor.pair import SCENES

TOL = 1e-10
SCENE = SCENES["free-precession"].scene

TITLE = "Simulated $x_1$ and $x_2$ over time"
ALT = (
    "Two panels show x of the right and the left tip over 10 s. The tips rest at 0.5 m and −0.5 m until the shock at 2 s "
    "and then make nine oscillations of amplitude 0.2 m. The valleys of the left tip and the peaks of the right one are "
    "narrower. A third panel shows y of both tips, which oscillate on opposite sides of zero between 0 and 0.37 m."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), x and y of the tips as rows (2, n) in m."""
    t = np.linspace(0, 10, 1001)
    tips = simulate(SCENE, t, "minimal", TOL).tips
    return {"t": t, "x": tips[:, :, 0], "y": tips[:, :, 1]}


# %%
def measure() -> dict[str, float]:
    """After the shock: ranges of x (m) and the rate between upward crossings of y_1 − y_2 (rad/s)."""
    d = data()
    after = d["t"] > 2.3
    t, x, apart = d["t"][after], d["x"][:, after], (d["y"][0] - d["y"][1])[after]
    apart = apart - (apart.max() + apart.min()) / 2
    up = np.flatnonzero((apart[:-1] < 0) & (apart[1:] >= 0))
    crossings = t[up] - apart[up] * (t[up + 1] - t[up]) / (apart[up + 1] - apart[up])
    return {
        "x_1, least (m)": x[0].min(),
        "x_1, most (m)": x[0].max(),
        "x_2, least (m)": x[1].min(),
        "x_2, most (m)": x[1].max(),
        "rate (rad/s)": 2 * np.pi * (len(crossings) - 1) / (crossings[-1] - crossings[0]),
    }


_m = measure()
CAPTION = (
    "The scene of 5.2.1 has spins of ±10 rad/s, a bar of 1 m, 0.01 kg and 0.1 kg m², and the shock (40, −11, 0) exp(−(20 (t − "
    f"2))²) N on tip 1. It is simulated with the minimal model at the tolerance {TOL:g}. From 2.3 to 10 s x_1 (b) varies from "
    f"{_m['x_1, least (m)']:.3f} to {_m['x_1, most (m)']:.3f} m and x_2 (a) from {_m['x_2, least (m)']:.3f} to "
    f"{_m['x_2, most (m)']:.3f} m, at the rate {_m['rate (rad/s)']:.3f} rad/s; (c) shows y."
).replace(" -", " −")


# %%
def figure() -> Figure:
    """x_2, x_1, both y."""
    d = data()
    picture = Figure(figsize=(7.0, 6.6))
    right, left, across = picture.subplots(3, 1, sharex=True)
    right.plot(d["t"], d["x"][1], color=ROTORS[1], label="right tip, of rotor 2")
    left.plot(d["t"], d["x"][0], color=ROTORS[0], label="left tip, of rotor 1")
    across.plot(d["t"], d["y"][1], color=ROTORS[1])
    across.plot(d["t"], d["y"][0], color=ROTORS[0])
    for panel in (right, left, across):
        panel.axvline(2, color=EXACT_COLOUR, lw=1, ls=":", label="shock" if panel is across else None)
    right.set(ylabel="$x_2$ (m)", title="x of the right tip", ylim=(0.28, 0.78))
    left.set(ylabel="$x_1$ (m)", title="x of the left tip", ylim=(-0.65, -0.15))
    across.set(xlabel="time $t$ (s)", ylabel="$y$ (m)", title="y of both tips")
    legend_below(picture, 3)
    return picture
