# %% [markdown]
# # Figure 19: corrected trajectories
#
# Top view of both tips with the paper's corrected inclinations (5.20), with the corrected series of order 3 and on the
# exact orbit, and the distance from the exact tip at the same phase.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.models import exact_orbit
from lagrotor.paper.rotor_pair.runs import against_orbit, paper_axes, series_axes
from lagrotor.pictures import distance_over_one_turn, orbits_from_above

R0, TOL = 0.204, 1e-11

TITLE = "Corrected trajectories of the pair"
ALT = (
    "The top view shows, around each ground joint, the exact closed orbit with the series of order 3 on top of it, and the "
    "paper's corrected curve, which lies about 0.04 m further out. Below, on a logarithmic scale, the distance from the "
    "exact tip over one turn is about 0.04 m for the paper, up to several millimetres for order 2, and about two "
    "millimetres for order 3."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Phase (rad), tips (2, n, 3) and distances of tip 1 from the exact orbit (n,), in m."""
    phase = np.linspace(0, 2 * np.pi, 181)
    curves = {
        "paper": paper_axes(R0, phase),
        "order_2": series_axes(2, R0, phase),
        "order_3": series_axes(3, R0, phase),
    }
    return against_orbit(exact_orbit(Scene(spins=(10, -10)), R0), phase, curves, TOL)


# %%
def measure() -> dict[str, float]:
    """Largest distance of each curve from the exact tip (m)."""
    d = data()
    return {f"{name}, largest distance (m)": d[f"{name}_distance"].max() for name in ("paper", "order_2", "order_3")}


_paper, _second, _third = measure().values()
CAPTION = (
    f"Orbits of the tips (a): the amplitude is r_0 = {R0}, the bar is massless, and ell = R = 1 m. The exact curve is "
    "the periodic orbit of the minimal "
    f"model with spins of ±10 rad/s at the tolerance {TOL:g}. The largest distance from the exact tip at the same phase "
    f"(b) is {_paper:.3f} m for the paper's correction (5.20), {_second:.4f} m for the corrected series of order 2, and "
    f"{_third:.4f} m "
    "for order 3."
)


# %%
def figure() -> Figure:
    """Top view, and the distance from the exact orbit."""
    d = data()
    picture = Figure(figsize=(7.0, 6.0))
    top, residual = picture.subplots(2, 1, height_ratios=(1.4, 1))
    for i in (0, 1):
        first = i == 0
        top.plot(*d["paper"][i, :, :2].T, color=PAPER_COLOUR, label="paper's correction (5.20)" if first else None)
        for name, line, width in (("order_2", ":", 1.6), ("order_3", "-", 2.4)):
            label = f"corrected series, order {name[-1]}" if first else None
            top.plot(*d[name][i, :, :2].T, color=CORRECTION_COLOUR, ls=line, lw=width, label=label)
        top.plot(*d["exact"][i, :, :2].T, color=EXACT_COLOUR, ls="--", lw=1.2, label="exact orbit" if first else None)
    orbits_from_above(top, 0.85, 0.28)
    residual.semilogy(d["phase"], d["paper_distance"], color=PAPER_COLOUR)
    residual.semilogy(d["phase"], d["order_2_distance"], color=CORRECTION_COLOUR, ls=":")
    residual.semilogy(d["phase"], d["order_3_distance"], color=CORRECTION_COLOUR)
    distance_over_one_turn(residual, 5e-5, 0.2)
    legend_below(picture, 3)
    return picture
