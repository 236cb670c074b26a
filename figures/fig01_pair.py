# %% [markdown]
# # Figure 1: the axially coupled rotor pair
#
# Two wheels on upright axes that stand on ground joints, their tips joined by a bar: a `Scene` as it starts, its bodies
# turned by `body_rotations`.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene
from lagrotor.drawing import BAR, INK, RADIUS, ROTORS, Camera
from lagrotor.numerics import body_rotations
from lagrotor.pictures import arc, arrow, canvas, draw_wheel, ground, label, path_arrow

SCENE = Scene(spins=(10.0, -10.0))
TITLE = "Axially coupled rotor pair"
CAPTION = (
    "Two equal rotors stand on ground joints that are ell = 1 m apart; a bar of this length joins their tips. Each rotor turns "
    "about its axis of length R = 1 m with its own spin omega_i; here the spins are opposite. The wheels are not "
    "drawn to the scale "
    "of the inertia; one spoke of each is marked."
)
ALT = (
    "Two wheels, indigo on the left and purple on the right, on upright axes above two ground joints on the x axis. A grey "
    "bar joins the upper ends of the axes. Arrows about the axes show spins of opposite sense."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Joints, tips and centres (2, 3) in m, rotations (2, 3, 3), and the arrows of the spins (2, n, 3) in m."""
    axes, rates = np.array(SCENE.axes)[:, None], np.array(SCENE.rates)[:, None]
    half, R = SCENE.link.length / 2, SCENE.rotor.length
    joints = np.array([[-half, 0, 0], [half, 0, 0]])
    turned = body_rotations(np.zeros(1), axes, rates, np.array(SCENE.spins))[:, 0]
    # From the far side round the front, in the sense of the spin.
    sweep = [np.sign(spin) * np.array([-0.35, 1.25]) * np.pi for spin in SCENE.spins]
    spins = [
        arc(joint + 1.18 * R * Q[:, 2], Q[:, 0], Q[:, 1], 0.13 * R, *angles)
        for joint, Q, angles in zip(joints, turned, sweep, strict=True)
    ]
    return {
        "joints": joints,
        "tips": joints + R * turned[..., 2],
        "centres": joints + R / 2 * turned[..., 2],
        "rotations": turned,
        "spins": np.array(spins),
    }


# %%
def figure() -> Figure:
    """The pair from the side."""
    d, camera = data(), Camera()
    R = SCENE.rotor.length
    drawn = Figure(figsize=(6.4, 5.6))
    wide = d["centres"] + RADIUS * R * np.array([[-1, 0, 0], [1, 0, 0]])
    joints, tips = camera(d["joints"]), camera(d["tips"])
    right = joints[1] + [0.58, 0]
    axes = canvas(drawn, np.vstack([camera(np.vstack([wide, d["spins"].reshape(-1, 3)])), joints, right]), 0.18)
    for i, ink in enumerate(ROTORS):
        draw_wheel(axes, camera, d["rotations"][i], d["centres"][i], (RADIUS * R, R), ink)
        path_arrow(axes, camera(d["spins"][i]), ink)
        label(axes, camera(d["spins"][i]).mean(0), rf"$\omega_{i + 1}$", ink, (0, 26))
        label(axes, camera(wide[i]), f"rotor {i + 1}", ink, (-12 if i == 0 else 12, -44))
        label(axes, joints[i], "ground joint", INK, (0, -16), fontsize=9)
    axes.plot(*tips.T, color=BAR, linewidth=6, solid_capstyle="round", zorder=2)
    axes.plot(*tips.T, "o", color=INK, markersize=6, zorder=5)
    ground(axes, joints)
    label(axes, tips.mean(0), r"bar, length $\ell$", INK, (0, 16))
    arrow(axes, right, right + tips[1] - joints[1], INK, 1.0, "<|-|>")
    label(axes, right + (tips[1] - joints[1]) / 2, r"$R$", INK, (12, 0))
    origin, e = camera(np.zeros(3)), camera(0.3 * np.eye(3))
    for j, letter in enumerate("xyz"):
        arrow(axes, origin, origin + e[j], INK, 1.2)
        label(axes, origin + 1.2 * e[j], f"${letter}$", INK)
    return drawn
