# %% [markdown]
# # Figure 16: top view of the coordinates
#
# The pair of figure 15 from above: shadows of the axes, $\sin\theta_i$ long at the azimuths $\phi_i$, and that of the
# bar, which is shorter than $\ell$ when the tips are not at one height. The paper's constraint (5.17) takes the shadow's
# length for the bar's.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import consistent_scene
from lagrotor.drawing import BAR, GROUND, INK, MARK, ROTORS
from lagrotor.pair import axis
from lagrotor.pictures import arc_between, arrow, ground, label, path_arrow

WISHED = ((0.62, 0.75), (0.62, -0.85))  # as in figure 15
TITLE = "Top view of the coordinates"
ALT = (
    "The plan has x to the right and y up, in metres. From the ground joints at −0.5 and 0.5 m the shadows of the axes r 1 "
    "(indigo, forward) and r 2 (purple, backward) lead to the tips, which the grey bar joins. Green arcs mark phi 1 and phi "
    "2 from the x direction. Dotted circles have the radii sin theta 1 and sin theta 2."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Joints and tips from above (2, 2) in m, their heights (2,), azimuths (2,) in rad, sines of the inclinations (2,)."""
    wished = [np.array(axis(*angles), dtype=float).ravel() for angles in WISHED]
    scene = consistent_scene((10.0, -10.0), wished)
    axes, half = np.array(scene.axes), scene.link.length / 2
    joints = np.array([[-half, 0.0], [half, 0.0]])
    return {
        "joints": joints,
        "tips": joints + scene.rotor.length * axes[:, :2],
        "heights": scene.rotor.length * axes[:, 2],
        "phi": np.arctan2(axes[:, 1], axes[:, 0]),
        "sines": np.hypot(axes[:, 0], axes[:, 1]),
    }


def measure() -> dict[str, float]:
    """The bar's shadow and its length (m)."""
    d = data()
    shadow = float(np.linalg.norm(d["tips"][1] - d["tips"][0]))
    return {"shadow of the bar (m)": shadow, "length of the bar (m)": float(np.hypot(shadow, np.ptp(d["heights"])))}


_shadow, _length = measure().values()
CAPTION = (
    "This is the state of figure 15 seen from above. The shadows of the axes have the lengths R sin theta_i and the "
    "azimuths phi_i. "
    f"The bar is {_length:.3f} m long, and its shadow {_shadow:.4f} m. The squares of the two lengths differ by the "
    "square of the "
    "difference in height of the tips."
)


# %%
def figure() -> Figure:
    """The plan."""
    d = data()
    drawn = Figure(figsize=(7.4, 4.4))
    axes = drawn.subplots()
    turn = np.linspace(0, 2 * np.pi, 121)
    for i, ink in enumerate(ROTORS):
        foot, tip = d["joints"][i], d["tips"][i]
        axes.plot(
            foot[0] + d["sines"][i] * np.cos(turn), foot[1] + d["sines"][i] * np.sin(turn), ":", color=ink, linewidth=1
        )
        axes.plot([foot[0], foot[0] + 0.42], [0, 0], color=GROUND, linewidth=1.4, zorder=1)
        arrow(axes, foot, tip, ink, 2.6)
        label(axes, (foot + tip) / 2, rf"$R\,\sin\theta_{i + 1}$", ink, (-34, 8 if i == 0 else -8))
        label(axes, tip, rf"$\vec r_{i + 1}$", ink, (-14 if i == 0 else 14, 10 if i == 0 else -12))
        east, flat = np.array([1.0, 0, 0]), np.array([np.cos(d["phi"][i]), np.sin(d["phi"][i]), 0.0])
        curve = arc_between(east, flat, 0.22)[:, :2] + foot
        path_arrow(axes, curve, MARK)
        label(axes, foot + 1.35 * (curve[len(curve) // 2] - foot), rf"$\phi_{i + 1}$", MARK)
    axes.plot(*d["tips"].T, color=BAR, linewidth=6, solid_capstyle="round", zorder=2)
    label(axes, d["tips"].T @ [0.75, 0.25], "bar", INK, (18, 8))
    ground(axes, d["joints"])
    axes.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
    axes.margins(x=0.06, y=0.06)
    return drawn
