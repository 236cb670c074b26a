# %% [markdown]
# # Figure t4: frequency of the paired precession against its amplitude
#
# The paper's frequency, the series through orders 3 and 9, and the exact family followed towards the joint line.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, natural_rate, orbit_family
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, HIGH_ORDER_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.theory import paired_series
from lagrotor.theory.paired_precession.series import shape_of

BARS = {
    "massless, ℓ = R": Link(1, 0, 0),
    "massless, ℓ = 0.6 R": Link(0.6, 0, 0),
    "massless, ℓ = 1.6 R": Link(1.6, 0, 0),
}
EXACT_AT = np.array([0.05, *np.arange(0.1, 0.85, 0.1), 0.85, 0.9, 0.95])
READ_AT = 0.4

TITLE = "Frequency of the paired precession against its amplitude"
ALT = (
    "Three panels, one for each bar, show the frequency divided by the natural frequency as a function of the amplitude "
    "from 0 to 0.95. The paper's curve rises as one over the cosine in all of them. For a massless bar as long as the rotor "
    "and for a short one the exact points fall to a minimum and then rise; for a long bar they rise throughout. The series "
    "follow them, order 9 further than order 3."
)


# %%
def scene(name: str) -> Scene:
    """Opposite spins with one of the bars."""
    return Scene(spins=(10, -10), link=BARS[name])


@cache
def data() -> dict[str, np.ndarray]:
    """Amplitudes (1) of curves and points, and frequencies over natural frequency (1): paper, orders 3, 9, exact."""
    r0 = np.linspace(0, 0.95, 96)
    found = {"r0": r0, "exact_at": EXACT_AT, "paper": 1 / np.sqrt(1 - r0**2)}
    for i, name in enumerate(BARS):
        for order in (3, 9):
            series = paired_series(order, *shape_of(scene(name)))
            found[f"order {order}, {i}"] = np.array([series.relative_frequency(r) for r in r0])
        found[f"exact, {i}"] = orbit_family(scene(name), EXACT_AT).frequencies / natural_rate(scene(name))
    return found


# %%
def measure() -> dict[str, float]:
    """For each bar: frequency at the last amplitude, and errors of paper and series at r_0 = 0.4."""
    d, found = data(), {}
    for i, name in enumerate(BARS):
        exact = d[f"exact, {i}"]
        found[f"{name}: exact at {EXACT_AT[-1]:g}"] = exact[-1]
        for curve in ("paper", f"order 3, {i}", f"order 9, {i}"):
            said = curve.partition(",")[0]
            there = np.interp(READ_AT, EXACT_AT, exact)
            found[f"{name}: {said}, error at {READ_AT:g}"] = np.interp(READ_AT, d["r0"], d[curve]) - there
    return found


CAPTION = (
    "The frequency ratio is Omega divided by Omega_0 for massless bars of the lengths R (a), 0.6 R (b) and 1.6 R (c); "
    "r_0 is the sine of the inclination when the axes are parallel. The paper's "
    "curve is 1/cos theta_0 for every bar. The exact points are the family of periodic orbits, continued from small amplitudes "
    "without a fold. It ends at r_0 = 1, where the axes lie along the joint line. At r_0 = "
    f"{READ_AT:g} with the massless bar the errors are "
    + ", ".join(
        f"{list(measure().values())[i]:+.4f} ({said})"
        for i, said in ((1, "paper"), (2, "series of order 3"), (3, "order 9"))
    )
    + "."
)


# %%
def figure() -> Figure:
    """One panel a bar."""
    d = data()
    picture = Figure(figsize=(7.4, 4.2))
    for i, (name, panel) in enumerate(zip(BARS, picture.subplots(1, 3), strict=True)):
        exact = d[f"exact, {i}"]
        panel.plot(d["r0"], d["paper"], color=PAPER_COLOUR, label="paper" if i == 0 else None)
        panel.plot(d["r0"], d[f"order 3, {i}"], color=CORRECTION_COLOUR, label="series, order 3" if i == 0 else None)
        panel.plot(
            d["r0"], d[f"order 9, {i}"], color=HIGH_ORDER_COLOUR, lw=3.5, label="series, order 9" if i == 0 else None
        )
        panel.plot(
            d["exact_at"],
            exact,
            "o-",
            color=EXACT_COLOUR,
            lw=0.8,
            ms=3.5,
            mfc="none",
            label="exact" if i == 0 else None,
        )
        low, high = min(exact.min(), 1.0), max(exact.max(), 1.0)
        panel.set_ylim(low - 0.25 * (high - low), high + 0.6 * (high - low))
        panel.set(xlabel="amplitude $r_0$", ylabel=r"$\Omega / \Omega_0$" if i == 0 else "", xlim=(0, 1))
        panel.set_title(name.removeprefix("massless, "))
    legend_below(picture, 4)
    return picture
