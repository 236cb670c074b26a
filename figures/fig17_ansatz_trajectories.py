# %% [markdown]
# # Figure 17: trajectories of the pair by the ansatz
#
# Top view of both tips by the ansatz of section 5.2 (constant inclination, $\phi_1 = -\phi_2$) against the exact
# periodic orbit of the same amplitude; the length that the bar would need on the way, and the distance between the two.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, simulate
from lagrotor.drawing import EXACT_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.models import exact_orbit
from lagrotor.paper.rotor_pair.runs import ansatz_axes
from lagrotor.pictures import orbits_from_above, over_one_turn

R0, TOL, SHOWN = 0.204, 1e-11, (0, 22, 60, 90)

TITLE = "Trajectories of the pair by the ansatz"
ALT = (
    "The top view shows two circles of radius 0.204 m around the ground joints, with opposite directions of motion, and the "
    "exact closed orbits, which touch the circles on the x-axis and are slightly flatter on the outer side. Four positions "
    "of the bar are drawn. Below, the length that the bar would need rises from 1 m to 1.08 m twice a turn, and the "
    "distance from the exact tip rises from 0 to 0.04 m twice a turn."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Phase (rad), tips (2, n, 3) and bar length (m) by the ansatz and on the exact orbit, distance of tip 1 (m)."""
    phase = np.linspace(0, 2 * np.pi, 181)
    orbit = exact_orbit(Scene(spins=(10, -10)), R0)
    run = simulate(orbit.scene, phase / orbit.frequency, "minimal", TOL)
    ansatz = run.joints[:, None] + ansatz_axes([R0, R0], phase)
    return {
        "phase": phase,
        "ansatz": ansatz,
        "exact": run.tips,
        "ansatz_length": np.linalg.norm(ansatz[1] - ansatz[0], axis=-1),
        "exact_length": run.link_length,
        "distance": np.linalg.norm(ansatz - run.tips, axis=-1),
    }


# %%
def measure() -> dict[str, float]:
    """Longest bar by the ansatz and largest distance of a tip from the exact one (m)."""
    d = data()
    return {
        "longest bar by the ansatz (m)": d["ansatz_length"].max(),
        "largest distance from the exact orbit (m)": d["distance"].max(),
    }


_longest, _distance = measure().values()
CAPTION = (
    f"The ansatz has a constant inclination with sin theta_0 = r_0 = {R0} and phi_1 = −phi_2. The exact orbit is the "
    "periodic orbit "
    "of the minimal model, found by shooting, with opposite spins of ±10 rad/s, a massless bar, ell = R = 1 m and the tolerance "
    f"{TOL:g}; it is drawn at the same phase (a). The ansatz needs a bar of up to {_longest:.4f} m (b), and its tips are up "
    f"to {_distance:.3f} m away from the exact ones (c)."
)


# %%
def figure() -> Figure:
    """Top view with bars and senses of turning; bar length; distance."""
    d = data()
    picture = Figure(figsize=(7.0, 6.05))
    axes = picture.subplot_mosaic([["top", "top"], ["length", "distance"]], height_ratios=(1.5, 1))
    top, length, distance = axes["top"], axes["length"], axes["distance"]
    bars = "#999999"
    for n, j in enumerate(SHOWN):
        top.plot(
            d["ansatz"][:, j, 0], d["ansatz"][:, j, 1], "-o", color=bars, lw=1.2, ms=4,
            label="bar by the ansatz, four positions" if n == 0 else None,
        )  # fmt: skip
    for i in (0, 1):
        first = i == 0
        top.plot(*d["ansatz"][i, :, :2].T, color=PAPER_COLOUR, ls="-.", label="ansatz (5.19)" if first else None)
        top.plot(*d["exact"][i, :, :2].T, color=EXACT_COLOUR, ls="--", label="exact orbit" if first else None)
        j, k = (33, 40)
        arrow = {"arrowstyle": "-|>", "color": PAPER_COLOUR, "lw": 1.6, "mutation_scale": 20}
        top.annotate("", xy=d["ansatz"][i, k, :2], xytext=d["ansatz"][i, j, :2], arrowprops=arrow)
    orbits_from_above(top, 0.85, 0.27)

    length.plot(d["phase"], d["ansatz_length"], color=PAPER_COLOUR, ls="-.")
    length.plot(d["phase"], d["exact_length"], color=EXACT_COLOUR, ls="--")
    length.set(ylabel="length of the bar (m)", title="Length of the bar", ylim=(0.99, 1.09))
    distance.plot(d["phase"], d["distance"][0], color=PAPER_COLOUR, label="distance of tip 1")
    distance.plot(d["phase"], d["distance"][1], color=PAPER_COLOUR, ls=":", label="distance of tip 2")
    distance.set(ylabel="distance (m)", title="Distance from the exact tips", ylim=(0, None))
    for panel in (length, distance):
        panel.set_xlabel("phase (rad)")
        over_one_turn(panel)
    legend_below(picture, 3)
    return picture
