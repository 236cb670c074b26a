# %% [markdown]
# # Figure n0: ten structures
#
# The gallery from above: the sense and size of each spin, bars, braces, and from which multiple of its spins each stands.

# %%
from math import inf

import numpy as np
from matplotlib.figure import Figure

from lagrotor.structures import GALLERY, draw_plan, example

TITLE = "Ten structures and their stability"
ALT = (
    "The picture has ten plans: one rotor, pairs, a corner, a row, a square, a plate, a hexagon and a grid. Indigo rotors "
    "spin in one sense and purple ones in the other; a ring around each rotor shows how fast it spins. Above each plan is "
    "written whether it is stable, and the least multiple of its spins for which it is."
)


# %%
def data() -> dict[str, np.ndarray]:
    """The factors on the spins from which on each stands, whether it does, how many degrees of freedom and bars it has."""
    found = [example(name).stands() for name in GALLERY]
    return {
        "factor": np.array([each.critical_spin for each in found]),
        "stands": np.array([each.stands for each in found]),
        "weighed": np.array([example(name).gravity > 0 for name in GALLERY]),
        "bars": np.array([len(example(name).bars) for name in GALLERY]),
        "braces": np.array([len(example(name).braces) for name in GALLERY]),
    }


# %%
def measure() -> dict[str, float]:
    """The factor of each that some spins hold."""
    factors = zip(GALLERY, data()["factor"], strict=True)
    return {f"least factor, {name}": float(factor) for name, factor in factors if 0 < factor < inf}


CAPTION = (
    "The gallery of `lagrotor structure` is seen from above: (a) to (j), with 2 kg on each tip. The "
    "numbers are spins in rad/s. Blue rotors turn in the positive sense, purple ones in the negative; the dashed line is a "
    "brace. The pair is not loaded and drifts after a push. "
    f"{int(data()['stands'].sum())} of {len(GALLERY)} structures are stable. Under weight, a structure with an odd "
    "number of bars "
    "and no brace is never stable. A stable structure stays stable if its spins are multiplied by a factor not below "
    + ", ".join(f"{factor:.3f} ({name.removeprefix('least factor, ')})" for name, factor in measure().items())
    + "."
)


# %%
def figure() -> Figure:
    """A plan a structure."""
    picture = Figure(figsize=(8.6, 4.4))
    panels = picture.subplots(2, 5).ravel()
    for panel, name, factor, stands in zip(panels, GALLERY, data()["factor"], data()["stands"], strict=True):
        draw_plan(panel, example(name))
        verdict = "stands" if stands else "drifts" if factor == 0 else "falls"
        panel.set(title=f"{name}\n{verdict}", xticks=[], yticks=[], xlabel="", ylabel="")
        panel.axis("off")
        ends = np.array([*example(name).joints, *(brace.to[:2] for brace in example(name).braces)])
        middle, half = (ends.max(0) + ends.min(0)) / 2, 0.75 * max(np.ptp(ends, axis=0).max(), 1.0)
        panel.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
        panel.set_aspect(1, adjustable="box")
    return picture
