# %% [markdown]
# # Figure n8: the limit of fast spins
#
# Bands of hanging gyroscopes on a honeycomb, in the limit and with inertia, and the gap between them against the bond angle.

# %%
from functools import cache
from math import pi, radians

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import minimize

from lagrotor import Pattern
from lagrotor.drawing import CASE_COLOURS, CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.structures import honeycomb
from lagrotor.structures.waves.chern import chern_numbers

SPIN, SPRING = 30.0, 8.0  # rad/s, N/m
LATTICE = {"spring": SPRING, "gravity": -9.81, "spins": SPIN}
ANGLES = np.array([120, 113, 106, 99, 94, 90, 86, 81, 74, 67, 60])  # degrees

TITLE = "Bands and gap of gyroscopes in the limit of fast spins"
ALT = (
    "Left: two bands of rates along a path through the wave numbers, with a gap at the corner of the zone. The curves are "
    "the limit of fast spins; the marks of the full equations lie just below them. Right: the edges of the gap as functions "
    "of the bond angle from 120 to 60 degrees. They meet at 90 degrees; below this angle the marks have another colour, "
    "because the Chern number has the other sign."
)


# %%
def closest(lattice: Pattern, grid: np.ndarray) -> np.ndarray:
    """The wave number (2,) at which the two bands are nearest to each other, from the best of a grid on."""

    def apart(q: np.ndarray) -> float:
        return float(np.diff(lattice.dispersion(q[None]).rates[0])[0])

    start = grid[np.diff(lattice.dispersion(grid).rates, axis=1)[:, 0].argmin()]
    return minimize(apart, start, method="Nelder-Mead", options={"xatol": 1e-6, "fatol": 1e-9}).x


@cache
def data() -> dict[str, np.ndarray]:
    """share (n,) of the path 0 – K – M – 0 and the limit's rates (n, 2); at (m,) with rates (m, 2) of the motion with inertia,
    rad/s; edges (angles, 2) of the gap, rad/s; numbers (angles,) of the lower band, 0 where the bands touch."""
    corners = 2 * pi * np.array([(0, 0), (1 / 3, -1 / 3), (1 / 2, 0), (0, 0)])
    limit, whole = honeycomb(**LATTICE, inertia=False), honeycomb(**LATTICE)

    def path(share: np.ndarray) -> np.ndarray:
        return np.stack([np.interp(share, range(4), corners[:, k]) for k in (0, 1)], axis=1)

    share, at = np.linspace(0, 3, 181), np.linspace(0, 3, 31)
    grid = 2 * pi * np.stack(np.meshgrid(*[np.arange(24) / 24] * 2), -1).reshape(-1, 2)
    lattices = [honeycomb(angle=radians(angle), **LATTICE, inertia=False) for angle in ANGLES]
    bands = [lattice.dispersion(np.vstack([grid, closest(lattice, grid)])).rates for lattice in lattices]
    chern = [chern_numbers(lattice, 12) for lattice in lattices]
    return {
        "share": share / 3,
        "limit": limit.dispersion(path(share)).rates,
        "at": at / 3,
        "whole": np.sort(whole.dispersion(path(at)).rates)[:, :2],
        "edges": np.array([(rates[:, 0].max(), rates[:, 1].min()) for rates in bands]),
        "numbers": np.array([c.numbers[0] if len(c.groups) == 2 else 0 for c in chern]),
    }


def measure() -> dict[str, float]:
    """How far the limit is above the whole, the least gap, and the numbers on both sides of 90°."""
    d = data()
    return {
        "limit over whole, largest": float((d["limit"][::6] / d["whole"]).max()),
        "limit over whole, least": float((d["limit"][::6] / d["whole"]).min()),
        "gap at 120° (rad/s)": float(np.ptp(d["edges"][0])),
        "gap at 90° (rad/s)": float(d["edges"][ANGLES == 90][0] @ [-1, 1]),
        "number above 90°": float(d["numbers"][ANGLES > 90].mean()),
        "number below 90°": float(d["numbers"][ANGLES < 90].mean()),
    }


_over, _, _wide, *_ = measure().values()
CAPTION = (
    f"Gyroscopes of 1 kg hang with spins of {SPIN:g} rad/s and are joined by springs of {SPRING:g} N/m. (a) The "
    "bands in the limit "
    "of fast spins along a path from q = 0 to K, M and back. The rates of the full equations are lower by up to "
    f"{100 * (1 - 1 / _over):.1f} %. (b) The gap of the bulk, which is {_wide:.3f} rad/s wide on the honeycomb. At "
    "a bond angle "
    "of 90° the bands touch, and the Chern number of the lower one changes its sign (Nash et al. 2015)."
)


# %%
def figure() -> Figure:
    """The bands; the gap against the bond angle."""
    d = data()
    picture = Figure(figsize=(8.6, 4.4))
    bands, gap = picture.subplots(1, 2)
    bands.plot(d["share"], d["limit"], color=CORRECTION_COLOUR, label=["limit of fast spins", None])
    bands.plot(d["at"], d["whole"], "o", ms=3.5, color=EXACT_COLOUR, mfc="none", label=["with inertia", None])
    bands.set(xlabel="share of the path 0 – K – M – 0", ylabel="rate (rad/s)", title="Bands of the bulk", xlim=(0, 1))
    gap.fill_between(ANGLES, *d["edges"].T, color="#999999", alpha=0.2, lw=0)
    for number, ink, mark in ((-1, CASE_COLOURS[0], "s"), (0, "#222222", "D"), (1, CASE_COLOURS[1], "o")):
        here = d["numbers"] == number
        name = "bands touch" if not number else f"Chern number {number:+d} below".replace("-", "−")
        gap.plot(np.repeat(ANGLES[here], 2), d["edges"][here].ravel(), mark, ms=5, color=ink, label=name)
    gap.set(xlabel="bond angle (deg)", ylabel="rate (rad/s)", title="Edges of the gap in the bulk")
    legend_below(picture, 3)
    return picture
