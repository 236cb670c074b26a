# %% [markdown]
# # Figure 20: corrected trajectories at a large oscillation
#
# As figure 19 at $r_0 = 0.5$: the paper's corrected curve, series of orders 3 and 9, and the exact orbit.

# %%
from functools import cache

import numpy as np
import sympy as sp
from matplotlib.figure import Figure

from lagrotor import Scene, natural_rate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, HIGH_ORDER_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.models import exact_orbit
from lagrotor.pair.notation import Phi, r0
from lagrotor.paper.rotor_pair.runs import against_orbit, paper_axes
from lagrotor.pictures import distance_over_one_turn, orbits_from_above
from lagrotor.theory import paired_series

R0, TOL = 0.5, 1e-11

TITLE = "Corrected trajectories at a large oscillation"
ALT = (
    "In the top view the exact orbits are egg-shaped closed curves of half-width 0.5 m that meet near the origin. The "
    "paper's curves lie 0.25 m further out and are nearly straight on the inner side. The series of order 3 differs visibly "
    "from the exact orbit, the series of order 9 covers it. Below, on a logarithmic scale, the distances are near 0.3 m for "
    "the paper, some centimetres for order 3, and millimetres for order 9."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Phase (rad), tips (2, n, 3), distances of tip 1 from the exact orbit (n,) and the paper's bar length, in m."""
    phase = np.linspace(0, 2 * np.pi, 181)
    curves = {"paper": paper_axes(R0, phase)}
    for order in (3, 9):
        series = paired_series(order, sp.Integer(1), sp.Integer(1))
        curve = sp.lambdify([r0, Phi], [series.expression(part) for part in (series.x, series.Y, series.z)], "numpy")
        first, later = (np.array([part + 0 * phase for part in curve(R0, angle)]).T for angle in (phase, phase + np.pi))
        curves[f"order_{order}"] = np.array([first, later * [-1, 1, 1]])
    orbit = exact_orbit(Scene(spins=(10, -10)), R0)
    found = against_orbit(orbit, phase, curves, TOL)
    return found | {
        "paper_length": np.linalg.norm(found["paper"][1] - found["paper"][0], axis=-1),
        "exact_rate_ratio": np.array([orbit.frequency / natural_rate(orbit.scene)]),
    }


# %%
def measure() -> dict[str, float]:
    """Largest distance of each curve from the exact tip, the paper's longest bar (m), exact rate over natural rate."""
    d = data()
    away = {f"{name}, largest distance (m)": d[f"{name}_distance"].max() for name in ("paper", "order_3", "order_9")}
    return {
        **away,
        "longest bar by the paper's correction (m)": d["paper_length"].max(),
        "exact rate over natural rate": d["exact_rate_ratio"][0],
    }


_paper, _third, _ninth, _longest, _ratio = measure().values()
CAPTION = (
    f"Orbits of the tips (a): the amplitude is r_0 = {R0} (the paper does not print its value), the bar is massless, "
    "and ell = R = 1 m. The "
    "exact curve is "
    f"the periodic orbit of the minimal model with spins of ±10 rad/s at the tolerance {TOL:g}; its rate is "
    f"{_ratio:.4f} times the "
    f"natural rate. The largest distance from the exact tip at the same phase (b) is {_paper:.2f} m for the paper's "
    "correction, which "
    f"needs a bar of up to {_longest:.2f} m, {_third:.3f} m for the series of order 3, and {_ninth:.4f} m for order 9."
)


# %%
def figure() -> Figure:
    """Top view, and the distance from the exact orbit."""
    d = data()
    picture = Figure(figsize=(7.0, 7.3))
    top, residual = picture.subplots(2, 1, height_ratios=(2, 1))
    curves = (
        ("paper", PAPER_COLOUR, "-", 1.6, "paper's correction (5.20)"),
        ("order_3", CORRECTION_COLOUR, "-", 1.6, "corrected series, order 3"),
        ("order_9", HIGH_ORDER_COLOUR, "-", 3.5, "corrected series, order 9"),
        ("exact", EXACT_COLOUR, "--", 1.2, "exact orbit"),
    )
    for name, colour, line, width, label in curves:
        for i in (0, 1):
            top.plot(*d[name][i, :, :2].T, color=colour, ls=line, lw=width, label=None if i else label)
        if name != "exact":
            residual.semilogy(d["phase"], d[f"{name}_distance"], color=colour, ls=line, lw=min(width, 1.6))
    orbits_from_above(top, 1.35, 0.68)
    distance_over_one_turn(residual, 1e-5, 1)
    legend_below(picture, 3)
    return picture
