# %% [markdown]
# # Figure n3: waves in rows and nets
#
# Bands of zigzags and rings, with the modes of finite structures on them; with hinges and under weight; the honeycomb.

# %%
from functools import cache
from math import pi

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Pattern, Rotor
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.structures import honeycomb, polygon_ring, zigzag

SPIN, HINGE, ROTORS = 10.0, 50.0, 16
RINGS = (12, 6, 4)  # corners: bars turned by 30°, 60°, 90°
LOADED = 40.0  # rad/s, the spin under weight

TITLE = "Bands of rotors joined by rigid bars"
ALT = (
    "Four panels show rate as a function of wave number. For zigzags of alternating spins there is a hump for each of three "
    "angles, steepest at zero for the straightest zigzag. For equal spins the curves fall from a common height at zero to "
    "zero at the end. The staircase on hinges has two curves and a gap; under weight two rates meet, and growth begins "
    "where they have met. The honeycomb of opposite spins is shown from the centre of its zone to a corner and a side. "
    "Marks of finite structures lie on the curves."
)


# %%
def positive(rates: np.ndarray) -> np.ndarray:
    """Rates above zero, rising."""
    return np.sort(rates[rates > 1e-9])


LOADED_STAIRCASE = zigzag(pi / 2, spins=(LOADED, -LOADED), gravity=9.81)


def on_band(ring: Pattern, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rates of the band at q, and the modes of the closed ring in the same order."""
    bands = ring.dispersion(q).rates[:, 0]
    modes = np.empty_like(bands)
    modes[np.argsort(bands)] = positive(ring.piece(round(2 * pi / ring.turn)).modes().rates)
    return bands, modes


@cache
def data() -> dict[str, np.ndarray]:
    """Wave numbers per rotor q (rad) and bands (rad/s) of alternating and equal spins at 30°, 60°, 90°; modes of rings and of
    open zigzags; the staircase on hinges and under weight; the honeycomb along a path (share of it)."""
    q = np.linspace(0.005, pi - 0.005, 200)
    turns = [2 * pi / n for n in RINGS]
    rings = [2 * pi * np.arange(1, (n + 1) // 2) / n for n in RINGS]
    closed = [on_band(polygon_ring(n, spins=SPIN), at) for n, at in zip(RINGS, rings, strict=True)]
    loaded = LOADED_STAIRCASE.dispersion(2 * q)
    corners = np.array([(0.02, 0.01), (2 * pi / 3, -2 * pi / 3), (pi, 0.0)])
    share = np.linspace(0, 2, 301)
    path = np.stack([np.interp(share, range(3), corners[:, k]) for k in (0, 1)], axis=1)
    return {
        "q": q,
        "alternating": np.array([polygon_ring(n, spins=SPIN).dispersion(q).rates[:, 0] for n in RINGS]),
        "equal": np.array([zigzag(turn, spins=SPIN).dispersion(2 * q).rates[:, 1] for turn in turns]),
        "ring_q": np.concatenate(rings),
        "ring_bands": np.concatenate([each for each, _ in closed]),
        "ring_modes": np.concatenate([each for _, each in closed]),
        "open_q": pi * np.arange(ROTORS // 2) / ROTORS,
        "open_modes": np.array(
            [positive(zigzag(turn, spins=SPIN).piece(ROTORS // 2).modes().rates)[::-1] for turn in turns]
        ),
        "hinged": polygon_ring(4, spins=SPIN, hinge=HINGE).dispersion(np.concatenate([q, -q])).rates.reshape(2, -1).T,
        "loaded": loaded.rates[:, -2:],
        "growth": loaded.growth.max(axis=1),
        "share": share / 2,
        "path": path,
        "honeycomb": np.abs(
            np.stack([honeycomb(spins=(sign * SPIN, -sign * SPIN)).dispersion(path).rates[:, 0] for sign in (1, -1)])
        ).max(axis=0),
    }


def honeycomb_formula(path: np.ndarray) -> np.ndarray:
    """|ω| (rad/s) of opposite spins in closed form."""
    d = np.array([path[:, 0], -path[:, 1], path[:, 1] - path[:, 0]])
    return np.abs(SPIN * Rotor().I3 / Rotor().J * np.sqrt(3) * np.sin(d).sum(0) / (3 - np.cos(d).sum(0)))


def held_from() -> float:
    """The wave number (rad) at which the growth of the loaded staircase ends, by halving between two that are on its sides."""
    falls, stands = 0.005, pi / 2
    while stands - falls > 1e-6:
        middle = (falls + stands) / 2
        grows = LOADED_STAIRCASE.dispersion(np.array([2 * middle])).growth.max() > 0
        falls, stands = (middle, stands) if grows else (falls, middle)
    return stands


# %%
def measure() -> dict[str, float]:
    """Distances of finite structures and closed forms from the bands; slopes; the wave number from which weight is held."""
    d = data()
    turns = np.array([2 * pi / n for n in RINGS])[:, None]
    closed = np.sin(turns) * np.cos(d["open_q"]) / np.sqrt(1 - (np.cos(turns) * np.cos(d["open_q"])) ** 2)
    return {
        "modes of rings, largest distance from the bands (rad/s)": np.abs(d["ring_modes"] - d["ring_bands"]).max(),
        "modes of open zigzags, largest distance from the bands (rad/s)": np.abs(
            d["open_modes"] - SPIN * Rotor().I3 / Rotor().J * closed
        ).max(),
        "honeycomb, largest distance from the closed form (rad/s)": np.abs(
            d["honeycomb"] - honeycomb_formula(d["path"])
        ).max(),
        "highest rate (rad/s)": d["alternating"].max(),
        "weight is held from (rad)": held_from(),
    }


*_, _top, _held = measure().values()
CAPTION = (
    f"The bars are massless, the rotors have 1 kg and 1 m, and the spins are {SPIN:g} rad/s; wave numbers are per "
    "rotor. The curves "
    f"are bands. The marks (a), (b) are modes of closed polygons and of open zigzags of {ROTORS} rotors at q = πm/{ROTORS}; "
    "they lie on the "
    f"bands to rounding error. The highest rate is G/a = {_top:.0f} rad/s. The staircase (c) of alternating spins is "
    "shown on hinges of "
    f"{HINGE:g} N m/rad, and under its weight with {LOADED:g} rad/s; there waves within {_held:.2f} of q = 0 and of q = π are "
    "unstable. The honeycomb (d) of opposite spins is shown from q = 0 to K and M; with equal spins its rate is zero."
)


# %%
def figure() -> Figure:
    """Alternating spins, equal spins, hinges and weight, honeycomb."""
    d = data()
    picture = Figure(figsize=(8.6, 7.0))
    panels = picture.subplots(2, 2)
    (turning, even), (staircase, net) = panels
    inks = CASE_COLOURS[:3]
    for n, ink, one, both, modes in zip(RINGS, inks, d["alternating"], d["equal"], d["open_modes"], strict=True):
        turning.plot(d["q"], one, color=ink, ls=CASE_DASHES[ink], label=f"bars turned by {360 / n:.0f}°")
        even.plot(d["q"][d["q"] < pi / 2], both[d["q"] < pi / 2], color=ink, ls=CASE_DASHES[ink])
        even.plot(d["open_q"], modes, "o", color=EXACT_COLOUR, mfc="none", ms=4)
    turning.plot(
        d["ring_q"], d["ring_modes"], "o", color=EXACT_COLOUR, mfc="none", ms=4, label="modes of finite structures"
    )
    for name, ink, label in (
        ("hinged", "#777777", "on hinges"),
        ("loaded", CASE_COLOURS[3], "under weight"),
    ):
        staircase.plot(d["q"], d[name], color=ink, lw=1.2, label=[label, None])
    staircase.plot(d["q"], d["growth"], "--", color=CASE_COLOURS[3], label="growth under weight")
    net.plot(d["share"], d["honeycomb"], color=CORRECTION_COLOUR, label="honeycomb, opposite spins")
    for panel, title in zip(
        panels.flat,
        ("Alternating spins, and rings", "Equal spins", "Staircase of alternating spins", "Honeycomb"),
        strict=True,
    ):
        panel.set(title=title, ylabel="rate (rad/s)", xlabel="wave number per rotor (rad)")
    staircase.set(ylabel="rate (rad/s), growth (1/s)")
    net.set(xlabel="share of the path 0 – K – M")
    even.set_xlim(0, pi / 2)
    legend_below(picture, 3)
    return picture
