# %% [markdown]
# # Figure t5: stability of the paired precession
#
# Growth per turn (or turning of the multiplier) against the amplitude for three bars, with the derived leading terms; and
# the plane of bar and amplitude in which the orbit is elliptic or hyperbolic, with the derived edge and its error.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, floquet
from lagrotor.drawing import CASE_COLOURS, EXACT_COLOUR, OKABE_ITO, legend_below
from lagrotor.numerics import measured_order
from lagrotor.theory import elliptic_edge, growth_squared

BARS = {
    "b = 0: massless": (Link(1, 0, 0), CASE_COLOURS[2], "o"),
    "b < 0: m = 0.01 kg, K = 0.1 kg m²": (Link(1, 0.01, 0.1), CASE_COLOURS[0], "s"),
    "b > 0: m = 1 kg, K = 0.05 kg m²": (Link(1, 1, 0.05), CASE_COLOURS[1], "^"),
}
AMPLITUDES = np.array([0.08, 0.14, 0.24])
# Masses (kg) of a bar of small b > 0, and amplitudes on both sides of the edge.
TRIED = ((0.05, 0.1), (0.05, 0.13), (0.25, 0.22), (0.25, 0.26), (0.5, 0.3), (0.5, 0.345))
LAST = 1.22  # of sigma

TITLE = "Stability of the paired precession"
ALT = (
    "Left, on logarithmic axes: the growth per turn as a function of the amplitude for two hyperbolic bars, filled marks on "
    "lines of slope four and three, and the angle per turn of one elliptic bar, open marks on a line of slope three. Right: "
    "the plane of amplitude and sigma. The orbit is hyperbolic below sigma = 1 and to the right of a curve that rises from "
    "there, and elliptic above it. Tested points lie on the expected sides. A grey band about the curve is its error."
)


# %%
def scene(link: Link) -> Scene:
    """Opposite spins with a bar."""
    return Scene(spins=(10, -10), link=link)


def strength(link: Link, r0: float) -> float:
    """Growth per turn, or less the angle per turn (rad) where the orbit is elliptic."""
    found = floquet(scene(link), r0)
    return found.growth - found.turning


def law(link: Link, r0: np.ndarray) -> np.ndarray:
    """Growth or angle per turn (rad) by the leading term."""
    sigma = scene(link).sigma
    return 2 * np.pi * np.sqrt(np.abs(growth_squared(*((8, True) if sigma == 1 else ()))(r0, sigma, 1.0)))


@cache
def data() -> dict[str, np.ndarray]:
    """Amplitudes (n,), growth or less the angle per turn (3, n), the law (3, 41); tried sigma, r_0, signs; edge and error."""
    fine = np.geomspace(0.06, 0.3, 41)
    tried = [(scene(Link(1, mass)).sigma, r0, strength(Link(1, mass), r0)) for mass, r0 in TRIED]
    edge = 1 + np.linspace(0.01, np.sqrt(LAST - 1), 13) ** 2
    return {
        "amplitudes": AMPLITUDES,
        "strength": np.array([[strength(link, r0) for r0 in AMPLITUDES] for link, *_ in BARS.values()]),
        "fine": fine,
        "law": np.array([law(link, fine) for link, *_ in BARS.values()]),
        "tried": np.array(tried),
        "edge_sigma": edge,
        "edge_r0": np.asarray(elliptic_edge()(edge, 1.0)),
        # At every third sigma: each is a series of its own through r_0^12.
        "edge_error": np.interp(edge, edge[::3], np.asarray(elliptic_edge().error(edge[::3], 1.0))),
    }


# %%
def measure() -> dict[str, float]:
    """The power of the amplitude for each bar, and the edge's error at the largest sigma over its amplitude."""
    d = data()
    powers = {
        f"power, {name.partition(':')[0]}": measured_order(AMPLITUDES[:2], np.abs(values[:2]))
        for name, values in zip(BARS, d["strength"], strict=True)
    }
    return powers | {f"relative error of the edge at sigma = {LAST:g}": float(d["edge_error"][-1] / d["edge_r0"][-1])}


_none, _less, _more, _error = measure().values()
CAPTION = (
    "(a) Exact Floquet multipliers mu, 1/mu of the orbit for spins of ±10 rad/s and ell = R. Filled marks are log|mu| per turn "
    "(hyperbolic), open marks the angle of mu per turn (elliptic), and lines the leading terms. Between the two "
    "smallest amplitudes "
    f"they are proportional to r_0 to the power {_none:.2f} for b = 0, {_less:.2f} for b < 0, and {_more:.2f} for b > 0. (b) "
    "Here sigma = (a + b)/(a − b) for K = 0. The line is the derived edge, which is right to first order in sigma − 1, "
    "where r_0² is "
    f"(2/3) (sigma − 1). The grey band is its error, {100 * _error:.0f} % of r_0 at sigma = {LAST:g}."
)


# %%
def figure() -> Figure:
    """Growth against amplitude; elliptic and hyperbolic regions."""
    d = data()
    picture = Figure(figsize=(7.4, 5.0))
    growth, plane = picture.subplots(1, 2)
    for (name, (_, colour, mark)), values, law in zip(BARS.items(), d["strength"], d["law"], strict=True):
        fill = colour if values[0] > 0 else "white"
        growth.loglog(d["fine"], law, color=colour, lw=1.2)
        growth.loglog(d["amplitudes"], np.abs(values), mark, color=colour, mfc=fill, label=name)
    growth.set(xlabel="amplitude $r_0$", ylabel="growth or angle per turn (rad)", title="Growth or angle per turn")
    growth.set_xticks([0.06, 0.1, 0.2, 0.3], ["0.06", "0.1", "0.2", "0.3"])
    growth.set_xticks([], minor=True)
    plane.fill_betweenx(d["edge_sigma"], d["edge_r0"], 0.4, color=OKABE_ITO["yellow"], alpha=0.3, lw=0)
    plane.axhspan(0.96, 1, color=OKABE_ITO["yellow"], alpha=0.3, lw=0)
    plane.text(0.06, 1.13, "elliptic")
    plane.text(0.25, 1.05, "hyperbolic")
    low, high = d["edge_r0"] - d["edge_error"], d["edge_r0"] + d["edge_error"]
    plane.fill_betweenx(d["edge_sigma"], low, high, color="#777777", alpha=0.5, lw=0, label="error of the edge")
    plane.plot(d["edge_r0"], d["edge_sigma"], color=EXACT_COLOUR, lw=1.2, label="edge, derived")
    for growing, fill, says in (
        (True, EXACT_COLOUR, "exact orbit, hyperbolic"),
        (False, "white", "exact orbit, elliptic"),
    ):
        sigma, r0, _ = d["tried"][(d["tried"][:, 2] > 0) == growing].T
        plane.plot(r0, sigma, "D", color=EXACT_COLOUR, mfc=fill, ms=5, label=says)
    plane.set(
        xlabel="amplitude $r_0$",
        ylabel="σ = (a + b)/(a − b)",
        title="Regions of stability",
        xlim=(0, 0.4),
        ylim=(0.96, LAST),
    )
    legend_below(picture, 3)
    return picture
