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

from lagrotor.drawing import CORRECTION_COLOUR, MODEL_COLOUR, OKABE_ITO
from lagrotor.models import RigidBody, RigidBodySystem
from lagrotor.models.spring_link import run, system
from lagrotor.pictures import arrow, bare

TITLE = "Object design of the rigid-body simulator"
CAPTION = (
    "A RigidBodySystem holds rigid bodies, which it copies into stacked arrays, and links between their vertices. The "
    "ground is a "
    "further body, which does not move. The paper's methods (constructor, addExternal, link, ground, computeForces, step) are in "
    "bold; all names and arguments are read from the classes."
)
ALT = (
    "The drawing has four boxes. At the top left is RigidBody with its seven fields, at the top right RigidBodySystem with "
    "its public methods, the paper's in bold. At the bottom left are the force law and the step limit, at the bottom right "
    "the functions that set up a scene and run it. Arrows lead from the bodies to the system, from the force law to it, and "
    "from the system to the runs."
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
        "Force": public(system, ("link_force", "step_limit")),
        "Runs": np.concatenate([public(system, ("paper_system",)), public(run, ("run_steps", "run_solver"))]),
    }


# %%
PLACES = {  # left, top, width in inches, and what the box is
    "RigidBody": (0.0, 4.5, 2.2, "a body as it starts", MODEL_COLOUR),
    "RigidBodySystem": (2.9, 5.0, 4.1, "bodies, links, ground", CORRECTION_COLOUR),
    "Force": (0.0, 1.3, 2.7, "the law of a link", OKABE_ITO["orange"]),
    "Runs": (3.0, 1.6, 4.0, "scenes and runs", OKABE_ITO["reddish purple"]),
}
LINE, LETTER = 0.21, 0.088  # inches


def figure() -> Figure:
    """The boxes, and who uses whom."""
    drawn = Figure(figsize=(7.4, 5.4))
    axes = drawn.subplots()
    bare(axes, np.array([[0.0, 0.0], [7.0, 5.0]]), 0.1)
    side = {}
    for name, lines in data().items():
        left, top, width, says, colour = PLACES[name]
        lines = [(part, line.split("(")[0] in PAPER) for line in lines for part in wrapped(line, width)]
        height = LINE * (len(lines) + 3.1)
        axes.add_patch(
            FancyBboxPatch((left, top - height), width, height, boxstyle="round,pad=0,rounding_size=0.08",
                           facecolor="white", edgecolor=colour, linewidth=1.8)
        )  # fmt: skip
        axes.text(left + 0.1, top - 0.2, name, fontsize=12, fontweight="bold", color=colour, va="center")
        axes.text(left + 0.1, top - 0.42, says, fontsize=10.5, fontstyle="italic", va="center")
        for i, (line, bold) in enumerate(lines):
            axes.text(left + 0.1, top - LINE * (i + 3.3), line, fontsize=10, family="DejaVu Sans Mono", va="center",
                      fontweight="bold" if bold else "normal")  # fmt: skip
        side[name] = (left, left + width, top, top - height)
    (_, right, top, bottom), (left, end, _, foot) = side["RigidBody"], side["RigidBodySystem"]
    arrow(axes, (right, (top + bottom) / 2), (left, (top + bottom) / 2), width=1.4)
    arrow(axes, (side["Force"][1], side["Force"][2] - 0.2), (left + 0.1, foot), width=1.4)
    arrow(axes, ((left + end) / 2 + 0.2, foot), ((left + end) / 2 + 0.2, side["Runs"][2]), width=1.4)
    return drawn


def wrapped(line: str, width: float) -> list[str]:
    """The line cut at commas where it is longer than its box."""
    most, parts = int((width - 0.2) / LETTER), [""]
    for piece in line.replace(", ", ",§").split("§"):
        if len(parts[-1]) + len(piece) >= most:
            parts.append("    ")
        parts[-1] += piece if not parts[-1].strip() else f" {piece}"
    return parts
