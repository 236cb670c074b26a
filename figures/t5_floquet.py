# %% [markdown]
# # Figure t5: stability of the paired precession
#
# Growth a turn (or turning of the multiplier) against the amplitude for three bars, with the powers that the averaged
# motion gives; and the plane of bar and amplitude in which the orbit is elliptic or hyperbolic.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, floquet
from lagrotor.drawing.style import CORRECTED, EXACT, MODEL, OKABE_ITO
from lagrotor.numerics.convergence import measured_order
from lagrotor.theory.paired_precession.closed_forms import leading_square

BARS = {
    "b = 0: massless": (Link(1, 0, 0), OKABE_ITO["reddish purple"], "o"),
    "b < 0: m = 0.01 kg, K = 0.1 kg m²": (Link(1, 0.01, 0.1), MODEL, "s"),
    "b > 0: m = 1 kg, K = 0.05 kg m²": (Link(1, 1, 0.05), CORRECTED, "^"),
}
AMPLITUDES = np.array([0.08, 0.14, 0.24])
# A bar of small b > 0, on both sides of the edge.
TRIED = ((0.02, 0.07), (0.02, 0.13), (0.05, 0.11), (0.05, 0.18))

TITLE = "Stability of the paired precession"
ALT = (
    "Left, in logarithms: growth a turn against the amplitude for two hyperbolic bars, filled marks on lines of slope four "
    "and three, and the angle a turn of one elliptic bar, open marks on a line of slope three. Right: plane of amplitude "
    "and sigma; the orbit is hyperbolic below sigma = 1 and to the right of a curve that rises from there, elliptic above "
    "it; tried points fall on their sides."
)


# %%
def shape(link: Link) -> float:
    """Sigma of a bar."""
    a, b = Scene(spins=(10, -10), link=link).inertias
    return (a + b) / (a - b) if b else 1.0


def strength(link: Link, r0: float) -> float:
    """Growth a turn, or less the angle a turn (rad) where the orbit is elliptic."""
    found = floquet(Scene(spins=(10, -10), link=link), r0)
    return found.growth - found.turning


@cache
def data() -> dict[str, np.ndarray]:
    """Amplitudes (n,), growth or less the angle a turn (3, n), the law (3, 41); tried sigma, r_0, signs; the edge."""
    fine = np.geomspace(0.06, 0.3, 41)
    tried = [(shape(Link(1, mass, 0)), r0, strength(Link(1, mass, 0), r0)) for mass, r0 in TRIED]
    edge = np.linspace(1, 1.04, 81)
    return {
        "amplitudes": AMPLITUDES,
        "strength": np.array([[strength(link, r0) for r0 in AMPLITUDES] for link, *_ in BARS.values()]),
        "fine": fine,
        "law": 2 * np.pi * np.sqrt(np.abs([leading_square(fine, shape(link), 1.0) for link, *_ in BARS.values()])),
        "tried": np.array(tried),
        "edge_sigma": edge,
        "edge_r0": edge * np.sqrt(2 / 3 * (edge - 1)),
    }


# %%
def measure() -> dict[str, float]:
    """The power of the amplitude for each bar."""
    d = data()
    return {
        f"power, {name.partition(':')[0]}": measured_order(AMPLITUDES[:2], np.abs(values[:2]))
        for name, values in zip(BARS, d["strength"], strict=True)
    }


_none, _less, _more = measure().values()
CAPTION = (
    "Exact Floquet multipliers mu, 1/mu of the orbit, spins ±10 rad/s, ell = R. Filled: log|mu| a turn (hyperbolic); open: "
    f"angle of mu a turn (elliptic). Lines: leading terms. Powers between the two smallest amplitudes: {_none:.2f} for "
    f"b = 0, {_less:.2f} for b < 0, {_more:.2f} for b > 0. Right: sigma = (a + b)/(a − b), K = 0; the edge is where the two "
    "leading terms balance, r_0² = (2/3) sigma² (sigma − 1)."
)


# %%
def figure() -> Figure:
    """Growth against amplitude; elliptic and hyperbolic regions."""
    d = data()
    picture = Figure(figsize=(8.4, 4.8))
    growth, plane = picture.subplots(1, 2)
    for (name, (_, colour, mark)), values, law in zip(BARS.items(), d["strength"], d["law"], strict=True):
        fill = colour if values[0] > 0 else "white"
        growth.loglog(d["fine"], law, color=colour, lw=1.2)
        growth.loglog(d["amplitudes"], np.abs(values), mark, color=colour, mfc=fill, label=name)
    growth.set(xlabel="amplitude r_0 [1]", ylabel="growth or angle, a turn [rad]", title="Growth a turn")
    growth.set_xticks([0.06, 0.1, 0.2, 0.3], ["0.06", "0.1", "0.2", "0.3"])
    growth.set_xticks([], minor=True)
    plane.fill_betweenx(d["edge_sigma"], d["edge_r0"], 0, color=CORRECTED, alpha=0.18, lw=0, label="elliptic")
    plane.fill_betweenx(d["edge_sigma"], d["edge_r0"], 0.2, color=OKABE_ITO["orange"], alpha=0.22, lw=0)
    plane.axhspan(0.98, 1, color=OKABE_ITO["orange"], alpha=0.22, lw=0, label="hyperbolic")
    plane.plot(d["edge_r0"], d["edge_sigma"], color=EXACT, lw=1.2, label="edge, leading terms")
    for growing, fill, says in ((True, EXACT, "found hyperbolic"), (False, "white", "found elliptic")):
        sigma, r0, _ = d["tried"][(d["tried"][:, 2] > 0) == growing].T
        plane.plot(r0, sigma, "D", color=EXACT, mfc=fill, ms=5, label=says)
    plane.set(
        xlabel="amplitude r_0 [1]", ylabel="sigma [1]", title="Where it is stable", xlim=(0, 0.2), ylim=(0.98, 1.04)
    )
    picture.suptitle(TITLE)
    picture.legend(loc="outside lower center", ncols=3)
    return picture
