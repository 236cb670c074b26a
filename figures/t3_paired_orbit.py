# %% [markdown]
# # Figure t3: the series of the paired precession against the exact orbit
#
# Error of every order from 1 to 9 against the amplitude, and the slopes read off it.

# %%
from functools import cache

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, simulate
from lagrotor.drawing.style import CORRECTED, EXACT
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.numerics.convergence import measured_order
from lagrotor.theory.paired_precession.series import evaluate, paired_series, shape_of

SCENE = Scene(spins=(10, -10), link=Link(1.3, 0.35, 0.11))
AMPLITUDES = np.array([0.05, 0.08, 0.12, 0.18, 0.27, 0.4])
ORDERS = range(1, 10)

TITLE = "Error of the series, order by order"
ALT = (
    "Left, in logarithms: largest distance between series and exact orbit against the amplitude, nine nearly straight "
    "lines, one for each order from 1 to 9, ever lower and ever steeper, down to the exact orbit's own error. Right: the "
    "measured slope of each line against the order; the points lie on the line order plus one."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Amplitudes (n,), orders (9,), largest distances of an axis (9, n) from the exact orbit at equal phase."""
    series = paired_series(ORDERS[-1], *shape_of(SCENE))
    width = float(shape_of(SCENE)[0]) ** 0.5
    phases = np.linspace(0, 2 * np.pi, 49)
    errors = np.empty((len(ORDERS), len(AMPLITUDES)))
    for j, r0 in enumerate(AMPLITUDES):
        orbit = exact_orbit(SCENE, r0)
        axes = simulate(orbit.scene, phases / orbit.frequency, "minimal", 1e-13).axes[0]
        for i, order in enumerate(ORDERS):
            parts = (series.x, series.Y, series.z)
            mine = np.column_stack([evaluate(part.through(order), r0, phases) for part in parts]) * (1, width, 1)
            errors[i, j] = np.linalg.norm(mine - axes, axis=1).max()
    return {"amplitudes": AMPLITUDES, "orders": np.array(ORDERS), "errors": errors}


def slopes() -> np.ndarray:
    """Slope of each order's line, over the three amplitudes that are smallest but clear of the exact orbit's error."""
    d = data()
    found = []
    for errors in d["errors"]:
        first = int(np.argmax(errors > 3e-11))
        found.append(measured_order(d["amplitudes"][first : first + 3], errors[first : first + 3]))
    return np.array(found)


# %%
def measure() -> dict[str, float]:
    """The slopes, and the smallest and largest error of order 9."""
    found = {f"slope of order {order}": slope for order, slope in zip(ORDERS, slopes(), strict=True)}
    return found | {"error of order 9 at the largest amplitude (R)": data()["errors"][-1, -1]}


CAPTION = (
    f"Bar ell = 1.3 R, m = 0.35 kg, K = 0.11 kg m², not used while the series was made; spins ±10 rad/s. Largest "
    f"distance of the tip in units of R at equal phase from the periodic orbit found by shooting. An order n promises an "
    f"error of order n + 1; measured slopes are at most {np.abs(slopes() - np.array(ORDERS) - 1).max():.2f} away."
)


# %%
def figure() -> Figure:
    """Errors and slopes."""
    d = data()
    picture = Figure(figsize=(8.0, 4.6))
    errors, slope = picture.subplots(1, 2, width_ratios=(1.5, 1))
    shades = mpl.colormaps["viridis"](np.linspace(0, 0.9, len(ORDERS)))
    for i, order in enumerate(ORDERS):
        errors.loglog(
            d["amplitudes"], d["errors"][i], "o-", ms=3.5, color=shades[i], label=f"order {order}", clip_on=False
        )
    errors.set(xlabel="amplitude r_0 [1]", ylabel="largest distance [1]", title="Error of the series", ylim=(1e-13, 1))
    errors.set_xticks([0.05, 0.1, 0.2, 0.4], ["0.05", "0.1", "0.2", "0.4"], minor=False)
    errors.set_xticks([], minor=True)
    slope.plot(d["orders"], d["orders"] + 1, color=CORRECTED, label="promised: order + 1")
    slope.plot(d["orders"], slopes(), "o", color=EXACT, mfc="none", label="measured slope")
    slope.set(xlabel="order of the series [1]", ylabel="slope [1]", title="Residual's slope", xlim=(0.5, 9.5))
    slope.set_xticks(range(1, 10))
    picture.suptitle(TITLE)
    picture.legend(loc="outside lower center", ncols=4)
    return picture
