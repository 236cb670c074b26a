# %% [markdown]
# # Figure 2: forces on the rotors and the bar
#
# Section 2 takes the axes as parallel and the bar as massless. Then $\vec r\times\vec F_i = \omega_i I\,\dot{\hat r}$
# with one $\dot{\hat r}$, so that the rotors share the force as $\vec F_i = \vec F\,\omega_i/(\omega_1 + \omega_2)$ and
# the shares add up to $\vec F$.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Rotor
from lagrotor.drawing import BAR, INK, MARK, ROTORS, Camera
from lagrotor.pair import axis
from lagrotor.pictures import arc, arrow, canvas, ground, label, path_arrow

ROTOR, ELL, SPINS, INCLINATION, FORCE = Rotor(), 1.0, (12.0, 6.0), 0.28, np.array([0.6, 0.0, 0.0])
TITLE = "Forces on the rotors and the bar"
CAPTION = (
    "The axes r are parallel, and the bar is massless. The force F on the bar reaches the tips as F_A and F_B, in the "
    "ratio of the "
    f"spins, here omega_1 : omega_2 = {SPINS[0]:g} : {SPINS[1]:g}. The force arrows are drawn to scale. Both tips then move in "
    "the same direction, along r × F."
)
ALT = (
    "Two parallel inclined axes, indigo and purple, with spins omega 1 and omega 2, are joined by a grey bar. A green arrow "
    "along the bar is the force F. Below it the arrow F A on tip 1 is twice as long as the arrow F B on tip 2. Thin black "
    "arrows at both tips point into the picture, along r cross F."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Joints, tips, directions and forces (drawn 1 m for 1 N), and the arrows of the spins."""
    r = np.array(axis(INCLINATION, 0.0), dtype=float).ravel()
    joints = np.array([[-ELL / 2, 0, 0], [ELL / 2, 0, 0]])
    share = np.array(SPINS)[:, None] / sum(SPINS) * FORCE
    across = np.cross(r, [0, 1, 0])
    rings = [arc(joint + 0.5 * r, across, np.cross(r, across), 0.1, -0.6 * np.pi, 1.1 * np.pi) for joint in joints]
    return {
        "r": r,
        "joints": joints,
        "tips": joints + ROTOR.length * r,
        "forces": share,
        "force": FORCE,
        "rate": np.cross(r, FORCE),
        "spins": np.array(rings),
    }


def measure() -> dict[str, float]:
    """How far the shares are from adding up to F, and from r × F_i = omega_i I r' with one r' (both relative)."""
    d = data()
    turning = np.cross(d["r"], d["forces"]) / np.array(SPINS)[:, None]
    return {
        "F_A + F_B against F": np.abs(d["forces"].sum(0) - d["force"]).max() / np.abs(d["force"]).max(),
        "r' of rotor 1 against 2": np.abs(turning[0] - turning[1]).max() / np.abs(turning).max(),
    }


# %%
def figure() -> Figure:
    """The pair with the forces on it."""
    d, camera = data(), Camera(azimuth=-66, elevation=20)
    joints, tips = camera(d["joints"]), camera(d["tips"])
    middle = tips.mean(0) + np.array([0, 0.2])
    force, rate = camera(d["force"]), camera(d["rate"])
    drawn = Figure(figsize=(7.0, 5.2))
    axes = canvas(
        drawn, np.vstack([joints, tips, tips + rate, middle + force, tips[1:] + camera(d["forces"][1])]), 0.16
    )
    axes.plot(*tips.T, color=BAR, alpha=0.6, linewidth=6, solid_capstyle="round", zorder=2)
    for i, (ink, letter) in enumerate(zip(ROTORS, "AB", strict=True)):
        arrow(axes, joints[i], tips[i], ink, 2.6)
        label(axes, joints[i] + 0.75 * (tips[i] - joints[i]), rf"$\vec r_{i + 1}$", ink, (-14, 2))
        path_arrow(axes, camera(d["spins"][i]), ink)
        label(axes, camera(d["spins"][i]).mean(0), rf"$\omega_{i + 1}$", ink, (34, 0))
        pulled = tips[i] + camera(d["forces"][i])
        arrow(axes, tips[i], pulled, MARK, 2.4)
        label(axes, pulled, rf"$\vec F_{letter}$", MARK, (6, -14))
        arrow(axes, tips[i], tips[i] + rate, INK, 1.4)
        label(axes, tips[i] + rate, r"$\vec r \times \vec F$", INK, (-4, 12))
    arrow(axes, middle, middle + force, MARK, 3.2)
    label(axes, middle + force / 2, r"$\vec F = \vec F_A + \vec F_B$", MARK, (12, 16))
    axes.plot(*np.array([middle, tips.mean(0)]).T, color=BAR, linewidth=0.9, linestyle=":")
    ground(axes, joints)
    return drawn
