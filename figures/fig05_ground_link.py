# %% [markdown]
# # Figure 5: a body on the ground
#
# `ground(body, vertex)` gives the ground a vertex where the body's vertex is, and links the two. The body has then moved
# a little: the gap, and the force of the link that closes it, are those of the system.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from lagrotor import Scene
from lagrotor.drawing import GROUND, INK, MARK, ROTORS
from lagrotor.models import paper_system
from lagrotor.pictures import arrow, canvas, label

S, D, MOVED = 1.0, 0.2, np.array([0.24, 0.0, 0.18])  # N/m, kg/s; m
TITLE = "Link between a ground vertex and a body vertex"
CAPTION = (
    "The ground G is a body that no force moves. Grounding vertex 1 of a rotor creates the vertex G_r(1) at the position of "
    "X_r(1), and a link between the two. In the drawing the rotor has then been displaced by 0.3 m; the arrows show "
    "the forces of "
    "the link."
)
ALT = (
    "A hatched strip is the ground, with a vertex G r 1. Above it the lower end of an upright indigo rotor, vertex X r 1, "
    "is joined to the ground vertex by a zigzag spring. A green arrow at the rotor's vertex points to the ground vertex. An "
    "equal and opposite force acts on the ground."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Vertices (2, 3) and centre (3,) of the rotor, the ground's vertex (3,), in m; the force on the rotor (3,), N."""
    axes = ((0.2588190451025207, 0.0, 0.9659258262890683),) * 2  # 15 degrees from upright
    system = paper_system(Scene((10.0, 10.0), link=None, axes=axes), S, D)
    system.X[0] += MOVED
    system.U[:], system.L[:], system.Omega[:] = 0, 0, 0
    system.compute_forces()
    vertices = system.X[0] + system.vertices[0] @ system.R[0].T
    gap = system.gaps(system.X, system.R)[1]  # the paper grounds rotor 2 first
    return {"vertices": vertices, "centre": system.X[0], "ground": vertices[0] - gap, "force": system.F[0]}


def measure() -> dict[str, float]:
    """How far the rotor's vertex is from the ground's (m), and the force over S times that: 1."""
    d = data()
    gap = float(np.linalg.norm(d["vertices"][0] - d["ground"]))
    return {"gap (m)": gap, "|F| / (S gap)": float(np.linalg.norm(d["force"])) / (S * gap)}


# %%
def figure() -> Figure:
    """The rotor's lower half in the x, z plane."""
    d = data()
    vertices, centre, foot, force = (d[name][..., ::2] for name in ("vertices", "centre", "ground", "force"))
    drawn = Figure(figsize=(6.4, 4.4))
    axes = canvas(drawn, np.vstack([centre, foot - [0.5, 0.15], foot - [-0.75, 0.15]]), 0.06)
    axes.add_patch(Rectangle(foot - [0.5, 0.14], 1.25, 0.14, facecolor="#f2f2f2", edgecolor=GROUND, hatch="///", lw=0))
    axes.plot([foot[0] - 0.5, foot[0] + 0.75], [foot[1]] * 2, color=INK, linewidth=1.6)
    label(axes, foot - [-0.6, 0.07], "ground $G$", INK)
    point, e = vertices[0], (vertices[0] - foot) / np.linalg.norm(vertices[0] - foot)
    n = np.array([-e[1], e[0]])
    along = np.r_[0, 0.12, np.linspace(0.17, 0.83, 12), 0.88, 1][:, None]
    aside = np.r_[0, 0, np.tile([0.02, -0.02], 6), 0, 0][:, None]
    axes.plot(*(foot + along * (point - foot) + aside * n).T, color=INK, linewidth=1.3)
    axes.plot(*np.array([point, centre]).T, color=ROTORS[0], linewidth=8, alpha=0.5, solid_capstyle="round", zorder=1)
    axes.plot(*centre, "o", color=ROTORS[0], markersize=8)
    label(axes, centre, r"$\vec X_{cm}$ of body 1", ROTORS[0], (58, -4))
    for place, text, shift in ((point, r"vertex 1, $\vec X_r(1)$", (64, -2)), (foot, r"$\vec G_r(1)$", (-28, 11))):
        axes.add_patch(Circle(place, 0.014, color=INK, zorder=5))
        label(axes, place, text, INK, shift)
    for place, sign in ((point, 1), (foot, -1)):
        start = place + 0.07 * n
        arrow(axes, start, start + 0.36 * sign * force, MARK, 2.4)
    label(axes, point + 0.07 * n, r"$\vec F$ on the body", MARK, (-44, 8), fontsize=10)
    label(axes, foot + 0.07 * n - 0.36 * force, r"$-\vec F$ on the ground", MARK, (-60, 2), fontsize=10)
    label(axes, (point + foot) / 2, "$S$, $D$", INK, (34, -8))
    return drawn
