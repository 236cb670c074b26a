# %% [markdown]
# # Figure 6: the pair as three rigid bodies
#
# The paper's program for the pair (`paper_system`, listing of section 4.1): two rotors and the bar, two links to the
# ground and two between the tips and the bar. Centres, vertices and wheels are those of the system; the bar is lifted
# and the rotors are set apart so that every vertex is seen.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.drawing import BAR, INK, MARK, RADIUS, ROTORS, Camera
from lagrotor.models import paper_system
from lagrotor.pair import DAMPING, SCENES, STIFFNESS
from lagrotor.pictures import canvas, draw_wheel, ground, label

APART = np.array([[-0.12, 0, 0], [0.12, 0, 0], [0, 0, 0.24]])  # m, for the drawing only
TITLE = "Three rigid bodies and four links"
CAPTION = (
    "R1 and R2 are the rotors, R3 is the bar. Each body has two vertices, and its centre of mass is midway between them. The "
    "dotted lines are the links (1, 3, 2, 1) and (2, 3, 2, 2) of the listing and the two grounds. In the run all of "
    "them have zero "
    "length; in the drawing the bodies are pulled apart. Heights are measured from the ground joints; the paper's z "
    "is 0.5 m less."
)
ALT = (
    "Two wheels on upright axes, R1 indigo and R2 purple, have a grey bar R3 above them. Vertices 1 and 2 of every body are "
    "numbered, and the centres of mass are marked with their coordinates. Dotted green lines join the bar's ends to the "
    "upper vertices and the lower vertices to the ground."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Centres (3, 3), vertices (3, 2, 3) and rotations (3, 3, 3) of the bodies, the ground joints (2, 3); m."""
    system = paper_system(SCENES["same-spin"].scene, STIFFNESS, DAMPING)
    vertices = np.array([system.X[i] + system.vertices[i] @ system.R[i].T for i in range(3)])
    return {
        "centres": system.X[:3].copy(),
        "vertices": vertices,
        "rotations": system.R[:3].copy(),
        "joints": vertices[:2, 0],
        "gaps": system.gaps(system.X, system.R),
    }


def measure() -> dict[str, float]:
    """The longest link at the start (m): they are closed."""
    return {"longest link at the start (m)": float(np.linalg.norm(data()["gaps"], axis=-1).max())}


# %%
def figure() -> Figure:
    """The bodies, pulled apart."""
    d, camera = data(), Camera()
    R = float(np.linalg.norm(d["vertices"][0, 1] - d["vertices"][0, 0]))
    centres, vertices = camera(d["centres"] + APART), camera(d["vertices"] + APART[:, None])
    joints = camera(d["joints"] + APART[:2] - [0, 0, 0.16])
    drawn = Figure(figsize=(6.8, 6.2))
    wide = np.vstack([centres[:2] - [0.42, 0], centres[:2] - [-0.42, 0]])
    axes = canvas(drawn, np.vstack([vertices.reshape(-1, 2), joints - [0, 0.1], wide]), 0.14)
    for i, ink in enumerate(ROTORS):
        draw_wheel(axes, camera, d["rotations"][i], d["centres"][i] + APART[i], (RADIUS * R, R), ink)
        for start, end in ((vertices[i, 0], joints[i]), (vertices[i, 1], vertices[2, i])):
            axes.plot(*np.array([start, end]).T, color=MARK, linewidth=1.8, linestyle=":", zorder=3)
        x, y, z = d["centres"][i]
        axes.plot(*centres[i], "o", color=INK, markersize=6, zorder=5)
        label(axes, joints[i], "ground", INK, (0, -15), fontsize=10)
        label(axes, joints[i], f"R{i + 1}: ({x:g}, {y:g}, {z:g}) m".replace("-", "−"), ink, (0, -32), fontsize=11)
    axes.plot(*vertices[2].T, color=BAR, linewidth=7, solid_capstyle="round", zorder=2)
    axes.plot(*centres[2], "o", color=INK, markersize=6, zorder=5)
    x, y, z = d["centres"][2]
    label(axes, centres[2], f"R3: ({x:g}, {y:g}, {z:g}) m", BAR, (0, 16), fontsize=11)
    for i in range(3):
        for j in (0, 1):
            axes.plot(*vertices[i, j], "o", color="white", markeredgecolor=INK, markersize=13, zorder=6)
            label(axes, vertices[i, j], str(j + 1), INK, zorder=7, fontsize=9)
    label(axes, (vertices[0, 1] + vertices[2, 0]) / 2, "link(1, 3, 2, 1)", MARK, (-52, 4), fontsize=9)
    label(axes, (vertices[1, 1] + vertices[2, 1]) / 2, "link(2, 3, 2, 2)", MARK, (54, 4), fontsize=9)
    label(axes, (vertices[0, 0] + joints[0]) / 2, "ground(1, 1)", MARK, (-44, 0), fontsize=9)
    label(axes, (vertices[1, 0] + joints[1]) / 2, "ground(2, 1)", MARK, (44, 0), fontsize=9)
    ground(axes, joints)
    return drawn
