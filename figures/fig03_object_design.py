# %% [markdown]
# # Figure 3: the object design of the simulator
#
# Read off the classes themselves: the fields of `RigidBody`, the public methods of `RigidBodySystem`, the functions that
# run it. What is not in the code cannot be in the picture.

# %%
import inspect
from dataclasses import fields
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from lagrotor.drawing import CORRECTED, MODEL, OKABE_ITO
from lagrotor.models import RigidBody, RigidBodySystem
from lagrotor.models.spring_link import run as spring_run
from lagrotor.models.spring_link import system as spring_link
from lagrotor.pictures import arrow, bare

TITLE = "Object design of the rigid-body simulator"
CAPTION = (
    "A RigidBodySystem holds rigid bodies, which it copies into stacked arrays, and links between their vertices; the "
    "ground is one more body, which nothing moves. In bold the paper's methods (constructor, addExternal, link, ground, "
    "computeForces, step); names and arguments are read off the classes."
)
ALT = (
    "Four boxes. Left, RigidBody with its seven fields. Middle, RigidBodySystem with its public methods, the paper's in "
    "bold. Right, above, the force laws and the step limit; below, the functions that set a scene up and run it. Arrows "
    "lead from the bodies to the system, from the force law to it, and from the system to the runs."
)
PAPER = ("RigidBodySystem", "add_external", "link", "ground", "compute_forces", "step")


# %%
def signature(function: object, name: str) -> str:
    """The function's name and the names of its positional arguments, `self` left out."""
    positional = inspect.Parameter.POSITIONAL_OR_KEYWORD
    taken = [p.name for p in inspect.signature(function).parameters.values() if p.kind is positional]
    return f"{name}({', '.join(n for n in taken if n != 'self')})"


@cache
def data() -> dict[str, np.ndarray]:
    """Box → the lines in it."""
    methods = [
        signature(value, name)
        for name, value in vars(RigidBodySystem).items()
        if inspect.isfunction(value) and not name.startswith("_")
    ]

    def public(module: object, names: tuple[str, ...]) -> np.ndarray:
        return np.array([signature(getattr(module, name), name) for name in names])

    return {
        "RigidBody": np.array([field.name for field in fields(RigidBody)]),
        "RigidBodySystem": np.array([signature(RigidBodySystem.__init__, "RigidBodySystem"), *methods]),
        "spring_link": public(spring_link, ("link_force", "step_limit")),
        "spring_run": public(spring_run, ("paper_system", "run_steps", "run_solver")),
    }


# %%
PLACES = {  # left, top, width in the picture, and what the box is
    "RigidBody": (0.0, 7.6, 3.0, "a body as it starts", MODEL),
    "RigidBodySystem": (4.0, 9.0, 5.3, "bodies, links, ground", CORRECTED),
    "spring_link": (10.3, 9.0, 4.2, "the law of a link", OKABE_ITO["orange"]),
    "spring_run": (10.3, 4.9, 4.2, "scenes and runs", OKABE_ITO["reddish purple"]),
}
LINE = 0.55


def figure() -> Figure:
    """The boxes, and who uses whom."""
    drawn = Figure(figsize=(7.4, 4.9))
    axes = drawn.subplots()
    bare(axes, np.array([[0.0, 0.9], [14.5, 9.0]]), 0.25)
    side = {}
    for name, lines in data().items():
        left, top, width, says, colour = PLACES[name]
        lines = [(part, line.split("(")[0] in PAPER) for line in lines for part in wrapped(line, width)]
        height = LINE * (len(lines) + 2.4)
        axes.add_patch(
            FancyBboxPatch((left, top - height), width, height, boxstyle="round,pad=0,rounding_size=0.15",
                           facecolor="white", edgecolor=colour, linewidth=1.8)
        )  # fmt: skip
        axes.text(left + 0.2, top - 0.42, name, fontsize=10, fontweight="bold", color=colour, va="center")
        axes.text(left + 0.2, top - 0.92, says, fontsize=8.5, fontstyle="italic", va="center")
        for i, (line, bold) in enumerate(lines):
            axes.text(left + 0.2, top - LINE * (i + 2.75), line, fontsize=7, family="DejaVu Sans Mono", va="center",
                      fontweight="bold" if bold else "normal")  # fmt: skip
        side[name] = (left, left + width, top - height / 2)
    for start, end in (("RigidBody", "RigidBodySystem"), ("spring_link", "RigidBodySystem")):
        (a, b, y), (c, d, _) = side[start], side[end]
        arrow(axes, (b if b < c else a, y), (c if b < c else d, y), width=1.4)
    (_, b, _), (a, _, y) = side["RigidBodySystem"], side["spring_run"]
    arrow(axes, (b, y), (a, y), width=1.4)
    return drawn


def wrapped(line: str, width: float) -> list[str]:
    """The line cut at commas where it is longer than its box."""
    most, parts = int(width * 7.6), [""]
    for piece in line.replace(", ", ",§").split("§"):
        if len(parts[-1]) + len(piece) > most:
            parts.append("    ")
        parts[-1] += piece if not parts[-1].strip() else f" {piece}"
    return parts
