# %% [markdown]
# # Figure t15: the normal form about a periodic orbit
#
# The section of Hénon and Heiles' orbit along the axis, and how many turns about an orbit a motion makes in a return, by the
# normal form of the return map and on exact runs.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.drawing import CASE_COLOURS, CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

MADE = PAPER.scripts.run("derivations", "t15_return_maps")
FORMS, SIZES, RUNS, ANGLES = (MADE[name] for name in ("forms", "SIZES", "runs", "angles"))
AXIS = next(iter(SIZES))
SHORT = dict(zip(SIZES, ("Hénon–Heiles: rotation", "Duffing: rotation"), strict=True))

TITLE = "The normal form about a periodic orbit"
ALT = (
    "Left: five closed curves around a point on the section, with dots of exact returns on the inner ones and beside the "
    "outermost. Middle and right: the turns per return as a function of the action, with a straight line for the twist and "
    "a curve of sixth order. Circles of exact runs depart from the line earlier than from the curve."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Of each case: actions I (m,) with the exact turns in a return, and for a curve I (n,) the line's and the form's turns. On
    the section x and p_x, exact (m, returns, 2) and of the form (m, n, 2)."""
    found = {}
    for name, sizes in SIZES.items():
        n, runs = FORMS[name], RUNS[name]
        actions = np.linspace(0, 1.1 * sizes[-1] ** 2, 80)
        found |= {
            f"I, {name}": sizes**2,
            f"exact, {name}": ANGLES[name] / (2 * np.pi),
            f"form at the runs, {name}": np.array([n.rotation_numbers([size**2])[0] for size in sizes]),
            f"curve I, {name}": actions,
            f"line, {name}": (n.frequencies[0] + n.twist[0, 0] * actions) / (2 * np.pi),
            f"form, {name}": np.array([n.rotation_numbers([action])[0] for action in actions]),
        }
        if name == AXIS:
            least = min(map(len, runs))
            found["section"] = np.array([apart[:least, [0, 2]] for apart in runs])
            turn = np.exp(1j * np.linspace(0, 2 * np.pi, 61))
            places = [[list(n.place([size * z]).values()) for z in turn] for size in sizes]
            found["section of the form"] = (np.array(places) - list(n.orbit.values()))[..., [0, 2]]
    return found


def measure() -> dict[str, float]:
    """Largest distances (turns in a return) of the form and of the line from the exact runs but the widest, of each case."""
    d, found = data(), {}
    for name in SIZES:
        exact = d[f"exact, {name}"][:-1]
        line = np.interp(d[f"I, {name}"][:-1], d[f"curve I, {name}"], d[f"line, {name}"])
        found[f"form, {name} (turns)"] = float(np.abs(d[f"form at the runs, {name}"][:-1] - exact).max())
        found[f"line, {name} (turns)"] = float(np.abs(line - exact).max())
    return found


_form, _line, _driven_form, _driven_line = measure().values()
CAPTION = (
    "(a) and (b): the orbit of Hénon–Heiles along the axis, which crosses y = 0 at "
    f"{MADE['CASES'][AXIS][1][MADE['y_v']]:g}. (a) The section through its neighbourhood according to the normal form of sixth "
    "order (curves), and 120 exact returns of each run (dots). The widest run rotates once in "
    f"{1 / data()[f'exact, {AXIS}'][-1]:.2f} returns, so its dots form clusters. (b) and (c): the rotations "
    "about the orbit per "
    f"return. Except for the widest run the error of the normal form is at most {_form:.5f} turns (b) and "
    f"{_driven_form:.4f} "
    f"turns (c); the error of the linear twist is at most {_line:.5f} and {_driven_line:.4f} turns. The form is "
    "due to Birkhoff "
    "(1927)."
)


# %%
def figure() -> Figure:
    """The section; turns against the action, of two cases."""
    d = data()
    picture = Figure(figsize=(8.6, 4.2))
    section, *panels = picture.subplots(1, 3)
    for curve, dots in zip(d["section of the form"], d["section"], strict=True):
        section.plot(*curve.T, color=CORRECTION_COLOUR, lw=1)
        section.plot(*dots.T, ".", color=EXACT_COLOUR, ms=3, label="exact returns")
    section.set(xlabel="x", ylabel="momentum of x", title="Hénon–Heiles: section")
    section.margins(0.06)
    for panel, name in zip(panels, SIZES, strict=True):
        panel.plot(d[f"curve I, {name}"], d[f"line, {name}"], "--", color=CASE_COLOURS[0], label="with the twist alone")
        panel.plot(d[f"curve I, {name}"], d[f"form, {name}"], color=CORRECTION_COLOUR, label="form of sixth order")
        panel.plot(d[f"I, {name}"], d[f"exact, {name}"], "o", color=EXACT_COLOUR, mfc="none", ms=5, label="exact runs")
        panel.set(xlabel="action I", ylabel="rotation (turns per return)", title=SHORT[name])
    panels[0].set_xticks(np.arange(4) / 1000)
    legend_below(picture, 4)
    return picture
