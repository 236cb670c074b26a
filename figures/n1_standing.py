# %% [markdown]
# # Figure n1: which structures stand
#
# Largest growth rate against the spin, in closed form and on the exact motion, and the least spin of grids.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Structure
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, EXACT_COLOUR, legend_below
from lagrotor.structures import measured_growth
from lagrotor.structures.coefficients import coefficients
from lagrotor.structures.small_motion import small_motion

WEIGHT = {"gravity": 9.81, "load": 2.0}
SQUARE = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "bars": [(0, 1), (1, 2), (2, 3), (3, 0)]}
SHOWN = {
    "a rotor alone": ({"joints": [(0, 0)]}, [1], CASE_COLOURS[0]),
    "loaded pair, any spins": ({"joints": [(0, 0), (1, 0)], "bars": [(0, 1)]}, [1, -1], CASE_COLOURS[2]),
    "corner of three": ({"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)]}, [1, 0, 1], CASE_COLOURS[1]),
    "square, one spin opposite": (SQUARE, [-1, 1, 1, 1], CASE_COLOURS[3]),
}
TRIED = (0.5, 1.2, 1.8, 2.5)  # spins of the exact runs, in sqrt(a κ)/I3

TITLE = "Stability under load"
ALT = (
    "Left: the growth rate as a function of the spin for a single loaded rotor, a pair, a corner of three and a square. The "
    "growth rate of the pair does not depend on the spin; the others become zero at thresholds. Exact runs lie on the "
    "curves. Right: the tilt of the corner after a push, with spins 3 per cent below and above its threshold; it grows "
    "without end or stays bounded."
)


# %%
def structure(name: str, spin: float) -> Structure:
    """One of those shown, its spins in units of sqrt(a κ)/I3."""
    shape, signs, _ = SHOWN[name]
    c = coefficients(Structure(**shape, spins=0, **WEIGHT))
    unit = float(np.sqrt(c.A[0] * c.gravity * c.S[0]))
    return Structure(**shape, spins=[spin * unit * sign for sign in signs], **WEIGHT)


@cache
def data() -> dict[str, np.ndarray]:
    """Spins, growth (4, n) over sqrt(κ/a); measured growth (4, m), NaN where nothing grows; tilt of the corner, (2, t)."""
    spins = np.linspace(0, 4, 161)
    c = coefficients(structure("a rotor alone", 1))
    fall = float(np.sqrt(c.gravity * c.S[0] / c.A[0]))
    unit_spins = [small_motion(structure(name, 1)) for name in SHOWN]
    found = {name: [structure(name, x) for x in TRIED] for name in SHOWN}
    t = np.linspace(0, 24 / fall, 401)
    runs = [structure("corner of three", 8**0.5 * x).simulate(t, rates=[(1e-3, 0)] * 3, tol=1e-8) for x in (0.97, 1.03)]
    return {
        "spins": spins,
        "growth": np.array([[motion.at_spins(x).growth / fall for x in spins] for motion in unit_spins]),
        "measured": np.array(
            [[measured_growth(s) / fall if small_motion(s).growth else np.nan for s in row] for row in found.values()]
        ),
        "predicted": np.array([[small_motion(s).growth / fall for s in row] for row in found.values()]),
        "t": t * fall,
        "tilt": np.array([np.abs(run.axes[0, :, 0]) for run in runs]),
    }


# %%
def measure() -> dict[str, float]:
    """Least spins in sqrt(a κ)/I3, how far the measured growth is off, tilt at the end under and over the threshold."""
    d = data()
    found = {f"least spin, {name}": structure(name, 1.0).critical_spin() for name in SHOWN if name[0] != "l"}
    off = np.nanmax(np.abs(d["measured"] - d["predicted"]))
    return found | {
        "largest distance, measured growth": off,
        "largest tilt under": d["tilt"][0].max(),
        "largest tilt over": d["tilt"][1].max(),
    }


_alone, _corner, _square, _off, _under, _over = measure().values()
CAPTION = (
    "The rotors are equal, with 2 kg on each tip, and the bars are massless; a is the inertia about the joint and κ "
    "the moment of "
    f"the weight. The least spin for stability is {_alone:.3f} √(aκ)/I₃ for a single rotor, {_corner:.3f} √(aκ)/I₃ "
    "for the corner, "
    f"and {_square:.3f} √(aκ)/I₃ for the square with one spin opposite. A pair is never stable. The growth rates (a) of "
    "exact runs "
    f"differ from the curves by at most {_off:.0e} √(κ/a). After a push of 0.001 rad/s (b) the corner tilts by "
    f"{_under:.2f} rad if its "
    f"spins are 3 % below the threshold, and by {_over:.4f} rad if they are 3 % above it."
)


# %%
def figure() -> Figure:
    """Growth against spin; the corner under and over its threshold."""
    d = data()
    picture = Figure(figsize=(8.6, 4.6))
    growth, tilt = picture.subplots(1, 2, width_ratios=(1.3, 1))
    for (name, (_, _, colour)), values in zip(SHOWN.items(), d["growth"], strict=True):
        line = {"ls": "--" if name[0] == "s" else CASE_DASHES[colour], "lw": 3.2 if name[0] == "c" else 1.6}
        growth.plot(d["spins"], values, color=colour, label=name, **line)
    growth.plot(np.tile(TRIED, 4), d["measured"].ravel(), "o", color=EXACT_COLOUR, mfc="none", label="exact motion")
    growth.set(xlabel="spin (√(aκ)/I₃)", ylabel="growth rate (√(κ/a))", title="Largest growth rate")
    for values, name, line in zip(d["tilt"], ("3 % under", "3 % over"), (":", "-"), strict=True):
        tilt.semilogy(d["t"], values + 1e-6, line, color=EXACT_COLOUR, lw=1.2, label=f"corner, {name} its threshold")
    tilt.set(xlabel="time $t$ (√(a/κ))", ylabel="|x| of the first axis", title="Corner after a push")
    legend_below(picture, 3)
    return picture
