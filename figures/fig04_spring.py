# %% [markdown]
# # Figure 4: the spring between vertex 1 and vertex 2
#
# Two bodies whose vertices are linked and have come apart: a spring of no rest length and a damper beside it pull them
# together. The forces are those that `link_force` gives for this gap.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from lagrotor.drawing import BAR, INK, MARK, ROTORS
from lagrotor.models import RigidBody, RigidBodySystem, finite_rotation, link_force
from lagrotor.pictures import arrow, canvas, label

S, D, SCALE = 1.0, 0.2, 0.33  # N/m, kg/s; m drawn for 1 N
TITLE = "Spring between vertex 1 and vertex 2"
CAPTION = (
    "A link joins two vertices by a spring of rest length 0 and stiffness S with a damper D beside it. Here the vertices are at "
    "rest with a gap between them. The force on vertex 1 is therefore −S (X_1 − X_2), and the force on vertex 2 is its opposite."
)
ALT = (
    "Two bodies are drawn as an indigo and a purple bar with their centres of mass marked. A zigzag spring labelled S "
    "and a damper "
    "labelled D join their ends, vertex 1 and vertex 2. Green arrows at the vertices, F on 1 and F on 2, point to each other."
)


# %%
def turned(angle: float) -> np.ndarray:
    """Rotation by `angle` (rad) about e_y."""
    return finite_rotation(np.array([[0.0, 1.0, 0.0]]), angle)[0]


@cache
def data() -> dict[str, np.ndarray]:
    """Centres and vertices (2, 2, 3) of the two bodies, m; the force on each linked vertex, N."""
    ends, one = [[-0.5, 0, 0], [0.5, 0, 0]], np.eye(3)
    bodies = [
        RigidBody([-1.05, 0, 0.1], ends, one, turned(-0.25), 1.0, np.zeros(3), np.zeros(3)),
        RigidBody([1.05, 0, 0.25], ends, one, turned(-0.2), 1.0, np.zeros(3), np.zeros(3)),
    ]
    system = RigidBodySystem(bodies, S, D)
    system.link(1, 2, 2, 1)
    gap = system.gaps(system.X, system.R)
    on_first = link_force(gap, np.zeros_like(gap), system.stiffness, system.damping)
    return {
        "centres": system.X[:2],
        "vertices": np.array([system.X[i] + system.vertices[i] @ system.R[i].T for i in (0, 1)]),
        "gap": gap[0],
        "force": np.vstack([on_first, -on_first]),
    }


def measure() -> dict[str, float]:
    """The force on vertex 1 over S |X_1 − X_2|: 1."""
    d = data()
    return {"|F_12| / (S |X_1 − X_2|)": float(np.linalg.norm(d["force"][0]) / (S * np.linalg.norm(d["gap"])))}


# %%
def zigzag(start: np.ndarray, end: np.ndarray, width: float, turns: int = 7) -> np.ndarray:
    """A spring from `start` to `end`, (n, 2)."""
    along = np.r_[0, 0.12, np.linspace(0.17, 0.83, 2 * turns), 0.88, 1]
    aside = np.r_[0, 0, np.tile([1.0, -1.0], turns), 0, 0] * width
    e = (end - start) / np.linalg.norm(end - start)
    return start + along[:, None] * (end - start) + aside[:, None] * np.array([-e[1], e[0]])


def figure() -> Figure:
    """The two bodies in the x, z plane, spring above damper."""
    d = data()
    centres, vertices, force = d["centres"][:, ::2], d["vertices"][..., ::2], d["force"][:, ::2]
    drawn = Figure(figsize=(7.4, 3.2))
    axes = canvas(drawn, np.vstack([vertices.reshape(-1, 2), [[0, 0.6], [0, -0.2]]]), 0.1)
    first, second = vertices[0, 1], vertices[1, 0]
    e = (second - first) / np.linalg.norm(second - first)
    n = np.array([-e[1], e[0]])
    for side in (0.2, -0.2):  # the yokes that hold spring and damper
        for point in (first, second):
            axes.plot(*np.array([point, point + side * n]).T, color=INK, linewidth=1.4)
    axes.plot(*zigzag(first + 0.2 * n, second + 0.2 * n, 0.05).T, color=INK, linewidth=1.4)
    a, b = first - 0.2 * n, second - 0.2 * n
    cup, rod = a + 0.42 * (b - a), a + 0.5 * (b - a)
    axes.plot(*np.array([a, cup]).T, color=INK, linewidth=1.4)
    wall = np.array([cup + 0.2 * e + 0.05 * n, cup + 0.05 * n, cup - 0.05 * n, cup + 0.2 * e - 0.05 * n])
    axes.plot(*wall.T, color=INK, linewidth=1.4)
    axes.plot(*np.array([rod + 0.035 * n, rod - 0.035 * n]).T, color=INK, linewidth=2.4)
    axes.plot(*np.array([rod, b]).T, color=INK, linewidth=1.4)
    label(axes, (first + second) / 2 + 0.2 * n, "spring $S$", INK, (0, 20))
    label(axes, (first + second) / 2 - 0.2 * n, "damper $D$", INK, (0, -20))
    for i, ink in enumerate(ROTORS):
        axes.plot(*vertices[i].T, color=ink, linewidth=7, alpha=0.5, solid_capstyle="round", zorder=1)
        axes.plot(*centres[i], "o", color=ink, markersize=7)
        label(axes, centres[i], rf"body {i + 1}, $\vec X_{{cm}}$", ink, (0, -18))
        point = vertices[i, 1 - i]
        axes.add_patch(Circle(point, 0.03, color=INK, zorder=5))
        arrow(axes, point, point + SCALE * force[i], MARK, 2.6)
        label(axes, point, rf"vertex {i + 1}, $\vec X_{i + 1}$", INK, (-52 if i == 0 else 52, 30 if i == 0 else -26))
        label(axes, point + SCALE * force[i] / 2, rf"$\vec F$ on {i + 1}", MARK, (0, -12), fontsize=10)
    axes.plot(*np.array([first, second]).T, color=BAR, linewidth=0.8, linestyle=":")
    return drawn
