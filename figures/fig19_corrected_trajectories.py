# %% [markdown]
# # Figure 19: corrected trajectories
#
# Top view of both tips with the paper's corrected inclinations (5.20), with the corrected series of order 3 and on the
# exact orbit, and the distance from the exact tip at the same phase.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, simulate
from lagrotor.models.orbit import exact_orbit
from lagrotor.report.style import CORRECTED, EXACT, PAPER
from lagrotor.rotors.closed_forms import corrected_trajectories

R0, TOL = 0.204, 1e-11

TITLE = "Corrected trajectories of the pair"
ALT = (
    "Top view: round each ground joint the exact closed orbit with the series of order 3 on top of it, and the "
    "paper's corrected curve, displaced outwards by about 0.04 m. Below, on a logarithmic scale, the distance from "
    "the exact tip over one turn: about 0.04 m for the paper, up to several millimetres for order 2, about two "
    "millimetres for order 3."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Phase (rad), tips (2, n, 3) and distances of tip 1 from the exact orbit (n,), in m."""
    phase = np.linspace(0, 2 * np.pi, 181)
    joints = np.array([[-0.5, 0, 0], [0.5, 0, 0]])[:, None]
    change, tips = R0**2 * np.cos(phase), {}
    sines = np.array([R0 - change, R0 + change])
    azimuths = np.array([phase, -phase])
    tips["paper"] = joints + np.stack([sines * np.cos(azimuths), sines * np.sin(azimuths), np.sqrt(1 - sines**2)], -1)
    for order in (2, 3):
        axes = np.array(corrected_trajectories(order)(R0, phase, 1, 1)).reshape(2, 3, -1).swapaxes(1, 2)
        tips[f"order_{order}"] = joints + axes
    orbit = exact_orbit(Scene(spins=(10, -10)), R0)
    exact = simulate(orbit.scene, phase / orbit.frequency, "minimal", TOL).tips
    away = {f"{name}_distance": np.linalg.norm(curve[0] - exact[0], axis=-1) for name, curve in tips.items()}
    return {"phase": phase, **tips, "exact": exact, **away}


# %%
def measure() -> dict[str, float]:
    """Largest distance of each curve from the exact tip (m)."""
    d = data()
    return {f"{name}, largest distance (m)": d[f"{name}_distance"].max() for name in ("paper", "order_2", "order_3")}


_paper, _second, _third = measure().values()
CAPTION = (
    f"r_0 = {R0}, massless bar, ell = R = 1 m. Exact: periodic orbit of the minimal model, spins ±10 rad/s, tolerance "
    f"{TOL:g}. Largest distance from the exact tip at the same phase: paper's correction (5.20) {_paper:.3f} m, "
    f"corrected series of order 2 {_second:.4f} m, of order 3 {_third:.4f} m."
)


# %%
def figure() -> Figure:
    """Top view, and the distance from the exact orbit."""
    d = data()
    picture = Figure(figsize=(7.0, 6.2))
    top, residual = picture.subplots(2, 1, height_ratios=(1.4, 1))
    for i in (0, 1):
        first = i == 0
        top.plot(*d["paper"][i, :, :2].T, color=PAPER, label="paper's correction (5.20)" if first else None)
        top.plot(
            *d["order_3"][i, :, :2].T, color=CORRECTED, lw=3, alpha=0.7,
            label="corrected series, order 3" if first else None,
        )  # fmt: skip
        top.plot(*d["exact"][i, :, :2].T, color=EXACT, ls="--", lw=1.2, label="exact orbit" if first else None)
    top.plot([-0.5, 0.5], [0, 0], "s", color="#222222", ms=6, label="ground joints")
    top.set(xlabel="x [m]", ylabel="y [m]", title="Top view", xlim=(-0.85, 0.85), ylim=(-0.28, 0.28))
    top.set_aspect("equal")
    residual.semilogy(d["phase"], d["paper_distance"], color=PAPER)
    residual.semilogy(d["phase"], d["order_2_distance"], color=CORRECTED, ls=":", label="corrected series, order 2")
    residual.semilogy(d["phase"], d["order_3_distance"], color=CORRECTED)
    residual.set(xlabel="phase [rad]", ylabel="distance [m]", title="Residual: distance of tip 1 from the exact one")
    residual.set_ylim(5e-5, 0.2)
    residual.set_xticks(np.arange(5) * np.pi / 2, ["0", "π/2", "π", "3π/2", "2π"])
    picture.suptitle(TITLE)
    picture.legend(loc="outside lower center", ncols=3)
    return picture
