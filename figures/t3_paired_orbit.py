# %% [markdown]
# # Figure t3: the series of the paired precession against the exact orbit
#
# Error of every order from 1 to 9 against the amplitude, the bounds that the series give for themselves, and the slopes.

# %%
from functools import cache

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order
from lagrotor.theory import paired_series, series_orbit
from lagrotor.theory.paired_precession.series import shape_of

SCENE = Scene(spins=(10, -10), link=Link(1.3, 0.35, 0.11))
AMPLITUDES = np.array([0.05, 0.08, 0.12, 0.18, 0.27, 0.4])
ORDERS = range(1, 10)
BOUNDED, AT = (5, 7, 9), AMPLITUDES[:5]  # orders whose own bounds are drawn, at amplitudes where their terms fall

TITLE = "Error of the series, order by order"
ALT = (
    "Left, on logarithmic axes: the largest distance between series and exact orbit as a function of the amplitude. Nine "
    "nearly straight lines, one for each order from 1 to 9, become lower and steeper, down to the error of the exact orbit "
    "itself. Dashed lines above the lines of order 5, 7 and 9 are the error bounds of the series. Right: the measured slope "
    "of each line as a function of the order; the points lie on the line order plus one."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Amplitudes (n,), orders (9,), largest distances of an axis (9, n) from the exact orbit; bounds (3, 5) of some."""
    phases = np.linspace(0, 2 * np.pi, 49)
    errors = np.empty((len(ORDERS), len(AMPLITUDES)))
    for j, r0 in enumerate(AMPLITUDES):
        orbit = exact_orbit(SCENE, r0)
        # A thirtieth of the smallest error that is read.
        axes = simulate(orbit.scene, phases / orbit.frequency, "minimal", 1e-12).axes[0]
        for i, order in enumerate(ORDERS):
            mine = paired_series(order, *shape_of(SCENE)).axes(r0, phases)[0]
            errors[i, j] = np.linalg.norm(mine - axes, axis=1).max()
    bounds = np.array([[series_orbit(SCENE, r0, order).error for r0 in AT] for order in BOUNDED])
    return {"amplitudes": AMPLITUDES, "orders": np.array(ORDERS), "errors": errors, "bounds": bounds}


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
    """The slopes, the largest error of order 9, and the largest error over its bound."""
    d = data()
    found = {f"slope of order {order}": slope for order, slope in zip(ORDERS, slopes(), strict=True)}
    found["error of order 9 at the largest amplitude (R)"] = d["errors"][-1, -1]
    ratio = d["errors"][[order - 1 for order in BOUNDED], : len(AT)] / d["bounds"]
    return found | {"largest error over its bound": ratio.max()}


CAPTION = (
    "The bar has ell = 1.3 R, m = 0.35 kg and K = 0.11 kg m², which the derivation does not use; the spins are ±10 "
    "rad/s. The error (a) "
    "is the largest distance of the tip, in units of R, from the periodic orbit found by shooting, at equal phase. The error of "
    "order n should be proportional to r_0 to the power n + 1; the measured slopes (b) differ from n + 1 by at most "
    f"{np.abs(slopes() - np.array(ORDERS) - 1).max():.2f}. The dashed lines are bounds from the terms of the series; "
    "the errors are "
    f"at most {100 * measure()['largest error over its bound']:.0f} % of them."
)


# %%
def figure() -> Figure:
    """Errors and slopes."""
    d = data()
    picture = Figure(figsize=(7.4, 5.0))
    errors, slope = picture.subplots(1, 2, width_ratios=(1.5, 1))
    shades = mpl.colormaps["viridis"](np.linspace(0, 0.9, len(ORDERS)))
    for i, order in enumerate(ORDERS):
        errors.loglog(
            d["amplitudes"], d["errors"][i], "o-", ms=3.5, color=shades[i], label=f"order {order}", clip_on=False
        )
    for i, (order, bounds) in enumerate(zip(BOUNDED, d["bounds"], strict=True)):
        says = "bound, orders 5, 7, 9" if i == 0 else None
        errors.loglog(AT, bounds, ls="--", lw=1.0, color=shades[order - 1], label=says)
    errors.set(xlabel="amplitude $r_0$", ylabel="largest distance (R)", title="Error of the series", ylim=(1e-13, 1))
    errors.set_xticks([0.05, 0.1, 0.2, 0.4], ["0.05", "0.1", "0.2", "0.4"], minor=False)
    errors.set_xticks([], minor=True)
    slope.plot(d["orders"], d["orders"] + 1, color=CORRECTION_COLOUR, label="promised: order + 1")
    slope.plot(d["orders"], slopes(), "o", color=EXACT_COLOUR, mfc="none", label="measured slope")
    slope.set(xlabel="order of the series", ylabel="slope", title="Slope of the error", xlim=(0.5, 9.5))
    slope.set_xticks(range(1, 10))
    legend_below(picture, 4)
    return picture
