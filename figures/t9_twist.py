# %% [markdown]
# # Figure t9: the twist instability of equal spins
#
# Growth rate of a small twist of the parallel pair against the bar's inertia: closed form, Hill's equation, exact.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, simulate
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.theory import parallel_scene, twist_growth, twist_multiplier_growth

MASS, SPIN, ANGLES = 1.0, 10.0, (0.1, 0.4)
EDGE = MASS / 4
TRIED = (0.4, 0.7, 1.0)

TITLE = "The twist instability of equal spins"
ALT = (
    "Left: the growth rate of a small twist as a function of the bar's inertia at a mass of 1 kg, for cones of 0.1 and 0.4 "
    "radians. It is zero up to the dumbbell's inertia 0.25, then rises steeply and levels off. Hill's equation lies above "
    "the closed form on the wider cone, and the exact points lie on Hill's equation. Right: the difference between closed "
    "form and Hill's equation."
)


# %%
def scene(inertia: float) -> Scene:
    """Equal spins and a bar of that inertia."""
    return Scene(spins=(SPIN, SPIN), link=Link(1, MASS, inertia))


def measured(inertia: float, angle: float) -> float:
    """Growth rate (1/s) of an exact twist, read once a half turn."""
    one = scene(inertia)
    growth = twist_multiplier_growth(one, angle)
    half = np.pi * sum(one.inertias) * np.cos(angle) / SPIN
    t = half * np.array([np.ceil(6 / growth / half), np.ceil(10 / growth / half)])
    axes = simulate(parallel_scene(one, angle, 1e-7), [0.0, *t], "minimal", 1e-10).after(t[0]).axes
    apart = np.linalg.norm(axes[0] - axes[1], axis=-1)
    return float(np.log(apart[1] / apart[0]) / (t[1] - t[0]))


@cache
def data() -> dict[str, np.ndarray]:
    """Inertias (kg m²) and growth rates (1/s): closed form and Hill (2, n), exact (2, 3)."""
    inertia = np.concatenate([np.linspace(0, EDGE, 6), EDGE + np.linspace(0.02, 1, 20) ** 2 * 0.85])
    form = twist_growth()
    return {
        "inertia": inertia,
        "closed": np.array([[float(form(np.sin(x), SPIN, *scene(K).inertias)) for K in inertia] for x in ANGLES]),
        "hill": np.array([[twist_multiplier_growth(scene(K), x) for K in inertia] for x in ANGLES]),
        "tried": np.array(TRIED),
        "exact": np.array([[measured(K, x) for K in TRIED] for x in ANGLES]),
    }


# %%
def measure() -> dict[str, float]:
    """Threshold (kg m²), growth at K = 1 (1/s), and the largest relative distance of the exact motion from Hill."""
    d = data()
    found = {"threshold m ell²/4 (kg m²)": EDGE}
    off = []
    for i, angle in enumerate(ANGLES):
        found[f"exact growth at K = {TRIED[-1]:g} on a cone of {angle:g} rad (1/s)"] = d["exact"][i, -1]
        off += [abs(d["exact"][i, j] / twist_multiplier_growth(scene(K), angle) - 1) for j, K in enumerate(TRIED)]
    return found | {"largest relative distance from Hill's equation": max(off)}


_edge, _narrow, _wide, _off = measure().values()
CAPTION = (
    f"The spins are equal, {SPIN:g} rad/s, the axes lie on a common cone, and the bar has a mass of {MASS:g} kg. A "
    "twist grows for "
    f"K above m ell²/4 = {_edge:g} kg m² and stays small for K below it. The closed form is of first order in the "
    "half-angle; Hill's "
    "equation is exact in the half-angle. The exact motion starts with a twist rate of 1e-7 rad/s; its growth rate (a) "
    "differs from "
    f"Hill's equation by at most {100 * _off:.1g} %. At K = {TRIED[-1]:g} kg m² the twist grows at {_narrow:.3f} 1/s "
    "on the narrow "
    f"cone and {_wide:.3f} 1/s on the wide one, where the closed form is too small (b)."
)


# %%
def figure() -> Figure:
    """Growth against inertia; closed form less Hill."""
    d = data()
    picture = Figure(figsize=(7.4, 4.8))
    growth, residual = picture.subplots(1, 2, width_ratios=(1.5, 1))
    for i, (angle, colour) in enumerate(zip(ANGLES, (CASE_COLOURS[0], CASE_COLOURS[2]), strict=True)):
        growth.plot(
            d["inertia"], d["closed"][i], color=CORRECTION_COLOUR, ls=":", lw=2, label="closed form" if i == 0 else None
        )
        growth.plot(
            d["inertia"], d["hill"][i], color=colour, ls=CASE_DASHES[colour], label=f"Hill's equation, {angle:g} rad"
        )
        growth.plot(
            d["tried"], d["exact"][i], "o", color=EXACT_COLOUR, mfc="none", label="exact motion" if i == 0 else None
        )
        residual.plot(d["inertia"], d["closed"][i] - d["hill"][i], color=colour, ls=CASE_DASHES[colour])
    for panel in (growth, residual):
        panel.axvline(EDGE, color="#777777", ls=":", label=r"threshold, $K = m\ell^2/4$" if panel is growth else None)
        panel.set_xlabel("inertia of the bar K (kg m²)")
    growth.axvline(1.0, color=PAPER_COLOUR, lw=5, alpha=0.25, label="the paper's bar")
    growth.set(ylabel="growth rate (1/s)", title="Growth of a small twist")
    residual.set(ylabel="difference (1/s)", title="Closed form − Hill")
    legend_below(picture, 3)
    return picture
