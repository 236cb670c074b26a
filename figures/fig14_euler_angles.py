# %% [markdown]
# # Figure 14: the Euler angles of one rotor
#
# Arnold's angles: the node line at $\varphi$ from $e_x$, the axis tipped by $\theta$ about it, the body turned by $\psi$
# about its axis. The body's frame is the product $R_z(\varphi) R_x(\theta) R_z(\psi)$ of the derivation of 5.01; the axis
# it gives has the azimuth $\phi = \varphi - \pi/2$.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from lagrotor.drawing import GROUND, INK, MARK, ROTORS, Camera
from lagrotor.pair import axis
from lagrotor.pictures import arc_between, arrow, canvas, label, path_arrow

NODE, THETA, PSI = 1.05, 0.7, 0.75  # the paper's varphi, theta, psi, rad
TITLE = "Euler angles of one rotor"
CAPTION = (
    "The fixed frame is e_x, e_y, e_z; the body's frame is e_1, e_2, e_3, with e_3 along the rotor's axis. The angle "
    "varphi leads "
    "from e_x to the node line, theta from e_z to e_3, and psi from the node line to e_1. The drawing has varphi = 60°, theta = "
    "40°, psi = 43°. The axis has the azimuth varphi − 90°."
)
ALT = (
    "A fixed black frame and a tilted indigo frame with a common origin. A dashed node line lies in the level plane "
    "and in the tilted plane. Green arcs with arrows mark varphi in the level plane, theta between e z and e 3, and psi in the "
    "tilted plane."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """The body's frame (3, 3), a vector a row, the node line (3,), and the arcs of the three angles (n, 3)."""
    body = Rotation.from_euler("ZXZ", [NODE, THETA, PSI]).as_matrix().T
    node = np.array([np.cos(NODE), np.sin(NODE), 0.0])
    fixed = np.eye(3)
    turn = np.linspace(0, 2 * np.pi, 121)[:, None]
    aside = np.cross(body[2], node)
    return {
        "body": body,
        "node": node,
        "level": np.cos(turn) * fixed[0] + np.sin(turn) * fixed[1],
        "tilted": np.cos(turn) * node + np.sin(turn) * aside,
        "varphi": arc_between(fixed[0], node, 0.42),
        "theta": arc_between(fixed[2], body[2], 0.5),
        "psi": arc_between(node, body[0], 0.62),
    }


def measure() -> dict[str, float]:
    """The body's third axis against r(theta, varphi − π/2) of the Lagrangian: the largest difference."""
    r = np.array(axis(THETA, NODE - np.pi / 2), dtype=float).ravel()
    return {"e_3 against r(theta, varphi - pi/2)": float(np.abs(data()["body"][2] - r).max())}


# %%
def figure() -> Figure:
    """Both frames, the planes, the node line and the angles."""
    d, camera = data(), Camera(azimuth=28, elevation=24)
    drawn = Figure(figsize=(6.4, 5.6))
    fixed, body, node = camera(1.15 * np.eye(3)), camera(1.12 * d["body"]), camera(1.25 * d["node"])
    level, tilted = camera(d["level"]), camera(d["tilted"])
    axes = canvas(drawn, np.vstack([fixed, body, [node], level, tilted]), 0.14)
    axes.fill(*level.T, color=GROUND, alpha=0.22, linewidth=0)
    axes.plot(*level.T, color=GROUND, linewidth=1.0)
    axes.fill(*tilted.T, color=ROTORS[0], alpha=0.10, linewidth=0)
    axes.plot(*tilted.T, color=ROTORS[0], linewidth=1.0, alpha=0.7)
    axes.plot(*np.array([-node * 0.84, node]).T, color=INK, linewidth=1.8, linestyle="--")
    label(axes, node, "node line", INK, (4, -12), fontsize=10)
    for frame, ink, names, width in (
        (fixed, INK, ("e_x", "e_y", "e_z"), 1.6),
        (body, ROTORS[0], ("e_1", "e_2", "e_3"), 2.2),
    ):
        for end, name in zip(frame, names, strict=True):
            arrow(axes, (0, 0), end, ink, width)
            label(axes, 1.09 * end, f"${name}$", ink)
    for name, text in (("varphi", r"\varphi"), ("theta", r"\theta"), ("psi", r"\psi")):
        curve = camera(d[name])
        path_arrow(axes, curve, MARK, 2.0)
        label(axes, 1.17 * curve[len(curve) // 2], f"${text}$", MARK, fontsize=13)
    return drawn
