# %% [markdown]
# # Figure 23: skewness of the precession centres
#
# Top view of the run of figure 22. The centre of each tip is its mean over whole turns; a turn lasts from one upward
# crossing of $y_1 - y_2$ through the middle of its range to the next. The line through both centres is the skew axis.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import shock_response, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, ROTORS, legend_below
from lagrotor.numerics import turn_means
from lagrotor.pair import SCENES

TOL = 1e-10
SCENE = SCENES["free-precession"].scene

AXIS, RESPONSE = "centres and skew axis", "by the linear response"  # labels in both panels

TITLE = "Skewness of the precession centres"
ALT = (
    "In the top view the traces of both tips after the shock are rings of radius 0.2 m, the left one above the x-axis, the "
    "right one below it. A straight line through their centres falls from left to right at about 21 degrees to x; the line "
    "predicted by the linear response nearly coincides with it. Below, the angle varies by 0.1 degree from turn to turn and "
    "lies about one degree below the linear prediction."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Tips after the shock (2, n, 3) in m, centres of each turn (2, turns, 3), angles (deg), predicted centres."""
    t = np.linspace(2.4, 10, 1901)
    tips = simulate(SCENE, [0.0, *t], "minimal", TOL).after(t[0]).tips
    _, means = turn_means(t, tips)
    lines = np.concatenate([means[1] - means[0], (means[1] - means[0]).mean(0)[None]])
    angles = np.degrees(np.arctan2(lines[:, 1], lines[:, 0]))
    x, y1, y2 = shock_response(SCENE).displacement
    return {
        "t": t,
        "tips": tips,
        "centres": means,
        "turn_angles": angles[:-1],
        "angle": angles[-1:],
        "predicted_centres": np.array([[x - 0.5, y1], [x + 0.5, y2]]),
        "predicted_angle": np.degrees(np.arctan2([y2 - y1], [1.0])),
    }


# %%
def measure() -> dict[str, float]:
    """Skew angle and its spread over the turns (deg), predicted angle (deg), centres (m)."""
    d = data()
    first, second = d["centres"].mean(1)
    return {
        "skew angle (deg)": d["angle"][0],
        "spread over the turns (deg)": np.ptp(d["turn_angles"]),
        "skew angle by the linear response (deg)": d["predicted_angle"][0],
        "whole turns": len(d["turn_angles"]),
        "centre 1, x (m)": first[0],
        "centre 1, y (m)": first[1],
        "centre 2, x (m)": second[0],
        "centre 2, y (m)": second[1],
    }


_m = measure()
CAPTION = (
    f"This is the run of figure 22 (spins of ±10 rad/s, a bar of 0.01 kg and 0.1 kg m², minimal model, tolerance {TOL:g}) after "
    f"2.4 s. Each centre is the mean of a tip over {_m['whole turns']:.0f} whole turns. The line through the centres "
    "(a) has the angle "
    f"{_m['skew angle (deg)']:.2f}° to x; from turn to turn (b) the angle varies by "
    f"{_m['spread over the turns (deg)']:.2f}°. The "
    f"linear response to the shock gives {_m['skew angle by the linear response (deg)']:.2f}°. The paper does not "
    "print the angle."
).replace(" -", " −")


# %%
def figure() -> Figure:
    """Top view, and the angle of each turn."""
    d = data()
    picture = Figure(figsize=(7.0, 7.0))
    top, turns = picture.subplots(2, 1, height_ratios=(2.2, 1))
    for i, colour in enumerate(ROTORS):
        top.plot(*d["tips"][i, :, :2].T, color=colour, lw=0.9, label=f"{('left', 'right')[i]} tip, of rotor {i + 1}")
    centres = d["centres"].mean(1)[:, :2]
    for points, colour, line, mark, label in (
        (centres, EXACT_COLOUR, "-", "o", AXIS),
        (d["predicted_centres"], CORRECTION_COLOUR, "--", "^", RESPONSE),
    ):
        middle, along = points.mean(0), points[1] - points[0]
        ends = middle + np.array([[-0.85], [0.85]]) * along
        top.plot(*ends.T, color=colour, ls=line, lw=1.2)
        top.plot(*points.T, mark, color=colour, ms=7)
        top.plot([], [], color=colour, ls=line, marker=mark, ms=7, label=label)
    top.plot([-0.5, 0.5], [0, 0], "s", color="#888888", ms=6, label="ground joints")
    top.set(xlabel="x (m)", ylabel="y (m)", title="Top view", xlim=(-0.85, 1.0), ylim=(-0.45, 0.45))
    top.set_aspect("equal")
    top.text(0.06, 0.06, f"{d['angle'][0]:.1f}° to x".replace("-", "−"), fontsize=10)
    turns.plot(np.arange(1, len(d["turn_angles"]) + 1), d["turn_angles"], "o", color=EXACT_COLOUR, ms=5, label=AXIS)
    turns.axhline(d["predicted_angle"][0], color=CORRECTION_COLOUR, ls="--", label=RESPONSE)
    turns.set(xlabel="turn after the shock", ylabel="angle to x (deg)", title="Angle of the skew axis in each turn")
    turns.set(ylim=(-21.5, -19), xlim=(0.5, len(d["turn_angles"]) + 0.5))
    legend_below(picture, 3)
    return picture
