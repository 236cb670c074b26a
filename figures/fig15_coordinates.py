# %% [markdown]
# # Figure 15: the generalized coordinates of the pair
#
# Two axes $\vec r_i$ with an inclination $\theta_i$, an azimuth $\phi_i$ and a spin angle $\psi_i$ each, and the bar that
# ties them: the state drawn is a consistent one, its bar has the right length.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import consistent_scene
from lagrotor.drawing import BAR, GROUND, INK, MARK, ROTORS, Camera
from lagrotor.pair import axis
from lagrotor.pictures import arc, arc_between, arrow, canvas, ground, label, path_arrow

WISHED = ((0.62, 0.75), (0.62, -0.85))  # theta, phi of the two axes before they are brought onto the bar, rad
TITLE = "Generalized coordinates of the pair"
ALT = (
    "Two inclined axes r 1 (indigo) and r 2 (purple) stand on ground joints, and a grey bar joins their tips. Each joint "
    "has a dashed upright line and a faint line along x. Green arcs mark theta from the upright to the axis, phi from x to "
    "the axis's shadow on the ground, and psi around the axis."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Axes (2, 3), angles theta and phi (2,) in rad, joints and tips (2, 3) in m."""
    wished = [np.array(axis(*angles), dtype=float).ravel() for angles in WISHED]
    scene = consistent_scene((10.0, -10.0), wished)
    axes, half = np.array(scene.axes), scene.link.length / 2
    joints = np.array([[-half, 0, 0], [half, 0, 0]])
    return {
        "axes": axes,
        "theta": np.arccos(axes[:, 2]),
        "phi": np.arctan2(axes[:, 1], axes[:, 0]),
        "joints": joints,
        "tips": joints + scene.rotor.length * axes,
    }


def measure() -> dict[str, float]:
    """The bar's length in the drawing (m), and the axes against r(theta, phi)."""
    d = data()
    again = [np.array(axis(*angles), dtype=float).ravel() for angles in zip(d["theta"], d["phi"], strict=True)]
    return {
        "length of the bar (m)": float(np.linalg.norm(d["tips"][1] - d["tips"][0])),
        "axes against r(theta, phi)": float(np.abs(np.array(again) - d["axes"]).max()),
    }


_degrees = np.degrees(np.array([data()["theta"], data()["phi"]]))
CAPTION = (
    "The coordinates of both rotors are the inclination theta_i, the azimuth phi_i (the paper's varphi_i shifted by 90°) and the "
    "spin angle psi_i. In the drawing the bar has its length ell = 1 m: "
    f"theta is {_degrees[0, 0]:.0f}° and {_degrees[0, 1]:.0f}°, phi is {_degrees[1, 0]:.0f}° and −{-_degrees[1, 1]:.0f}°. Six "
    "angles with one constraint leave five degrees of freedom."
)


# %%
def figure() -> Figure:
    """The two axes with their angles."""
    d, camera = data(), Camera(azimuth=-75, elevation=28)
    drawn = Figure(figsize=(7.6, 5.4))
    joints, tips = camera(d["joints"]), camera(d["tips"])
    east, up = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    axes = canvas(drawn, np.vstack([joints, tips, joints + camera(0.62 * east), joints + camera(1.02 * up)]), 0.16)
    axes.plot(*tips.T, color=BAR, linewidth=6, solid_capstyle="round", zorder=2)
    label(axes, tips.T @ [0.75, 0.25], r"bar $\ell$", INK, (20, 12))
    for i, ink in enumerate(ROTORS):
        foot, r = d["joints"][i], d["axes"][i]
        shadow = np.array([r[0], r[1], 0.0])
        shadow_end, flat = foot + shadow, shadow / np.linalg.norm(shadow)
        for end, line in ((foot + up, "--"), (foot + 0.55 * east, "-"), (shadow_end, ":")):
            axes.plot(*camera(np.array([foot, end])).T, color=GROUND, linewidth=1.3, linestyle=line, zorder=1)
        axes.plot(*camera(np.array([shadow_end, d["tips"][i]])).T, color=GROUND, linewidth=1.3, linestyle=":", zorder=1)
        label(axes, camera(foot + 1.04 * up), "$z$", BAR, fontsize=10)
        arrow(axes, joints[i], tips[i], ink, 2.6)
        label(axes, tips[i], rf"$\vec r_{i + 1}$", ink, (-18 if i == 0 else 20, 2))
        theta, phi = arc_between(up, r, 0.5, foot), arc_between(east, flat, 0.32, foot)
        across = np.cross(up, r) / np.linalg.norm(np.cross(up, r))
        psi = arc(foot + 0.82 * r, across, np.cross(r, across), 0.09, -0.7 * np.pi, np.pi)
        for curve, name, out in ((theta, "theta", 1.14), (phi, "phi", 1.3)):
            path_arrow(axes, camera(curve), MARK)
            middle = camera(foot + out * (curve[len(curve) // 2] - foot))
            label(axes, middle, rf"$\{name}_{i + 1}$", MARK)
        path_arrow(axes, camera(psi), ink)
        label(axes, camera(foot + 0.82 * r), rf"$\psi_{i + 1}$", ink, (34, -6))
    label(axes, camera(d["joints"][1] + 0.6 * east), "$x$", BAR, fontsize=10)
    axes.plot(*joints.T, color=GROUND, linewidth=1.3, zorder=1)
    ground(axes, joints)
    return drawn
