# %% [markdown]
# # Figure t2: the linear response to a shock
#
# Closed form, through the Gaussian pulse, against the exact motion; their difference; and the order in which it falls
# with the shock.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, Shock, shock_response, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, ROTORS, legend_below
from lagrotor.numerics import measured_order

FORCE, AT, WIDTH, TOL = (8.0, -2.0, 0.0), 0.5, 1 / 20, 1e-11
SIZES = np.array([0.125, 0.25, 0.5, 1.0, 2.0])

TITLE = "The linear response to a shock"
ALT = (
    "Above: after a pulse at half a second x oscillates about zero, and y of tip 1 and tip 2 oscillate about two centres on "
    "opposite sides, while both drift slowly. The curves of the closed form and of the exact run nearly coincide. Lower "
    "left: their difference stays within a few hundredths and grows slowly. Lower right: the largest difference as a "
    "function of the force lies on a straight line of slope two on logarithmic axes."
)


# %%
def scene(factor: float = 1.0) -> Scene:
    """The bar of section 5.2.1 under `factor` times the force."""
    force = tuple(factor * f for f in FORCE)
    return Scene(spins=(10, -10), link=Link(1, 0.01, 0.1), shock=Shock(force, AT, WIDTH))


def exact(factor: float, t: np.ndarray) -> np.ndarray:
    """(x_1, y_1, y_2) of an exact run, (n, 3)."""
    run = simulate(scene(factor), t, "minimal", TOL)
    return np.stack([run.axes[0, :, 0], run.axes[0, :, 1], run.axes[1, :, 1]], -1)


@cache
def data() -> dict[str, np.ndarray]:
    """Times (s), (x_1, y_1, y_2) in closed form and exactly (n, 3), forces (N) and largest errors over 2 s."""
    t = np.linspace(0, 4, 401)
    short = np.linspace(0, 2, 101)
    errors = [np.abs(shock_response(scene(f)).through(short) - exact(f, short)).max() for f in SIZES]
    return {
        "t": t,
        "closed": shock_response(scene()).through(t),
        "exact": exact(1.0, t),
        "forces": SIZES * FORCE[0],
        "errors": np.array(errors),
    }


# %%
def measure() -> dict[str, float]:
    """Largest difference over the run (1), and the power of the force with which it falls."""
    d = data()
    return {
        "largest difference (R)": np.abs(d["closed"] - d["exact"]).max(),
        "power of the force": measured_order(d["forces"][:3], d["errors"][:3]),
    }


_difference, _power = measure().values()
CAPTION = (
    "A pair at rest with opposite spins of ±10 rad/s and a bar with m = 0.01 kg, K = 0.1 kg m² receives a pulse of "
    f"{FORCE[0]:g} N along x and {FORCE[1]:g} N along y on tip 1 at {AT:g} s, with the width {WIDTH:g} s. The exact curve is the "
    f"minimal model at the tolerance {TOL:g}. The positions (a) are those of the tips relative to the ground joints, in "
    "units of R. The "
    f"difference is up to {_difference:.3f} R (b); it is proportional to the force to the power {_power:.2f} (c)."
)


# %%
def figure() -> Figure:
    """Motion; difference; order."""
    d = data()
    picture = Figure(figsize=(7.4, 6.2))
    axes = picture.subplot_mosaic([["motion", "motion"], ["difference", "order"]], height_ratios=(1.4, 1))
    motion, difference, order = axes["motion"], axes["difference"], axes["order"]
    colours = dict(zip(("x of both tips", "y, tip 1", "y, tip 2"), (CORRECTION_COLOUR, *ROTORS), strict=True))
    for i, (name, colour) in enumerate(colours.items()):
        motion.plot(d["t"], d["closed"][:, i], color=colour, label=f"closed form, {name}")
        motion.plot(
            d["t"], d["exact"][:, i], color=EXACT_COLOUR, ls=":", lw=1.3, label="exact model" if i == 0 else None
        )
        difference.plot(d["t"], d["closed"][:, i] - d["exact"][:, i], color=colour)
    motion.set(xlabel="time $t$ (s)", ylabel="x or y of the tip (R)", title="Motion after the shock")
    difference.set(xlabel="time $t$ (s)", ylabel="difference (R)", title="Closed form minus exact")
    order.loglog(d["forces"], d["errors"], "o", color=EXACT_COLOUR, label="largest difference over 2 s")
    law = d["errors"][0] * (d["forces"] / d["forces"][0]) ** 2
    order.loglog(d["forces"], law, color=CORRECTION_COLOUR, ls="--", label="square of the force")
    order.set(xlabel="force along x (N)", ylabel="largest difference (R)", title="Largest difference", xlim=(0.8, 20))
    legend_below(picture, 3)
    return picture
