# %% [markdown]
# # Figure 18: swing of the link length at constant inclination
#
# The length that the bar would need, $C = \sqrt{1 + 4\sin^2\theta_0\sin^2\phi}$ (5.19), with the paper's corrected
# inclinations (5.20), with the corrected series, and on the exact orbit.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR, legend_below, with_residual
from lagrotor.models import exact_orbit
from lagrotor.paper.rotor_pair.runs import ansatz_axes, paper_axes, series_axes
from lagrotor.pictures import over_one_turn

R0, TOL = 0.204, 1e-11

TITLE = "Swing of the link length"
ALT = (
    "The upper panel shows the length of the bar as a function of the angle over one turn. At constant inclination it "
    "varies between 1 m and 1.08 m with the period pi. With the paper's correction it stays near 1.08 m. The corrected "
    "series and the exact orbit stay at 1 m. The lower panel shows the difference from 1 m on a logarithmic scale. It is "
    "near 0.08 m for the paper's curves and at most a few millimetres for the series of orders 2 and 3, with opposite "
    "signs."
)


# %%
def length(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Distance of the tips (n,) in m from the two axes (n, 3), with ell = R = 1."""
    return np.linalg.norm(second - first + [1, 0, 0], axis=-1)


@cache
def data() -> dict[str, np.ndarray]:
    """Angle (rad) and the bar's lengths (m)."""
    phi = np.linspace(0, 2 * np.pi, 241)
    lengths = {
        "constant": length(*ansatz_axes([R0, R0], phi)),
        "paper": length(*paper_axes(R0, phi)),
        "order_2": length(*series_axes(2, R0, phi)),
        "order_3": length(*series_axes(3, R0, phi)),
    }
    orbit = exact_orbit(Scene(spins=(10, -10)), R0)
    run = simulate(orbit.scene, phi / orbit.frequency, "minimal", TOL)
    return {"phi": phi, **lengths, "exact": run.link_length}


# %%
def measure() -> dict[str, float]:
    """Range of the lengths (m) and their largest distance from 1 m."""
    d = data()
    return {
        "longest at constant inclination (m)": d["constant"].max(),
        "shortest by the paper's correction (m)": d["paper"].min(),
        "longest by the paper's correction (m)": d["paper"].max(),
        "order 2, largest distance from 1 m (m)": np.abs(d["order_2"] - 1).max(),
        "order 3, largest distance from 1 m (m)": np.abs(d["order_3"] - 1).max(),
    }


_constant, _least, _most, _second, _third = measure().values()
CAPTION = (
    f"The distance between the tips (a) and its difference from 1 m (b) are shown for r_0 = sin theta_0 = {R0}, ell = R "
    "= 1 m. At constant inclination it "
    "varies from 1 "
    f"to {_constant:.4f} m. With the paper's correction (5.20) it varies from {_least:.4f} to {_most:.4f} m, so it is nearly "
    f"constant but too long. The series of the exact orbit (massless bar) differs from 1 m by up to {_second:.1e} m "
    "at order 2 and "
    f"{_third:.1e} m at order 3. The exact orbit is computed with the minimal model at the tolerance {TOL:g}, with "
    "opposite spins "
    "of ±10 rad/s."
)


# %%
def figure() -> Figure:
    """Lengths, and below their distance from 1 m."""
    d = data()
    picture = Figure(figsize=(7.0, 5.6))
    main, residual = with_residual(picture)
    curves = (
        ("constant", PAPER_COLOUR, "-.", "constant inclination (5.19)"),
        ("paper", PAPER_COLOUR, "-", "paper's correction (5.20)"),
        ("order_2", CORRECTION_COLOUR, ":", "corrected series, order 2"),
        ("order_3", CORRECTION_COLOUR, "-", "corrected series, order 3"),
        ("exact", EXACT_COLOUR, "--", "exact orbit"),
    )
    for name, colour, line, label in curves:
        main.plot(d["phi"], d[name], color=colour, ls=line, label=label)
        if name != "exact":
            residual.semilogy(d["phi"], np.maximum(np.abs(d[name] - 1), 1e-9), color=colour, ls=line)
    main.set(ylabel="length of the bar (m)", ylim=(0.985, 1.095), title=f"Length of the bar, $r_0$ = {R0}")
    residual.set(
        ylabel="|length − ℓ| (m)",
        xlabel="angle $\\phi$ (rad)",
        title="Distance of the length from 1 m",
        ylim=(1e-5, 0.3),
    )
    residual.set_yticks([1e-5, 1e-4, 1e-3, 1e-2, 1e-1])
    over_one_turn(residual)
    legend_below(picture, 2)
    return picture
