# %% [markdown]
# # Figure n5: waves along a border
#
# Bands of a strip of a pattern, coloured by where each wave is: gyroscopes joined by springs on a honeycomb, and rigid bars
# on squares and octagons.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.drawing import CASE_COLOURS, legend_below
from lagrotor.structures import honeycomb, square_octagon
from lagrotor.structures.waves.chern import chern_numbers, edge_waves

WIDTH, POINTS, NEAR = 10, 91, 0.2  # cells; wave numbers; share of the strip that counts as a border
SPIN, HINGE, SPRING = 30.0, 200.0, 50.0
PATTERNS = {
    "springs": honeycomb(spring=SPRING, spins=SPIN, hinge=HINGE),
    "bars": square_octagon((0.3, 0.3), spins=(SPIN, SPIN / 3, SPIN, SPIN / 3), hinge=HINGE),
}

TITLE = "Waves that run one way along a border"
ALT = (
    "The two panels show the rates of the waves of a strip as functions of the wave number along it, for a honeycomb of "
    "springs and for squares and octagons of rigid bars. The waves of the bulk form two clouds of curves with a gap between "
    "them. Two curves cross the gap: a falling one for waves on the first border and a rising one for waves on the last."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """q (m,), rad; of each pattern: rates (m, n) of the strip, place (m, n) of its waves, gap (2,) of the bulk, numbers."""
    grid = 2 * np.pi * np.stack(np.meshgrid(*[np.arange(24) / 24] * 2), -1).reshape(-1, 2)
    found = {}
    for name, pattern in PATTERNS.items():
        bulk = pattern.dispersion(grid).rates
        gap = np.array([bulk[:, 0].max(), bulk[:, 1].min()])
        waves = edge_waves(pattern, float(gap.mean()), WIDTH, POINTS)
        found |= {"q": waves.strip.q[:, 0], f"{name}_rates": waves.strip.rates, f"{name}_place": waves.place}
        found |= {f"{name}_gap": gap, f"{name}_border": np.array([waves.first, waves.last])}
        found[f"{name}_numbers"] = np.array(chern_numbers(pattern, 12).numbers[:2])
    return found


def measure() -> dict[str, float]:
    """The gaps (rad/s), the Chern numbers of the band below, and the waves along the first and the last border."""
    d, found = data(), {}
    for name in PATTERNS:
        found |= {f"{name}, gap from (rad/s)": d[f"{name}_gap"][0], f"{name}, gap to (rad/s)": d[f"{name}_gap"][1]}
        found[f"{name}, Chern number below"] = d[f"{name}_numbers"][0]
        found |= {f"{name}, {one} border": n for one, n in zip(("first", "last"), d[f"{name}_border"], strict=True)}
    return found


def signed(number: float) -> str:
    return f"{number:+.0f}".replace("-", "−")


_low, _high, _number, _first, _last, _low_2, _high_2, _number_2, *_ = measure().values()
CAPTION = (
    f"Both strips have {WIDTH} cells and rotors of 1 kg and 1 m on hinges of {HINGE:g} N m/rad. (a) The springs have "
    f"{SPRING:g} N/m, and the spins are {SPIN:g} rad/s. The bulk has a gap from {_low:.2f} to {_high:.2f} rad/s, and the band "
    f"below it has the Chern number {signed(_number)}. (b) The bars are rigid, one joint of four is displaced by 0.3 m along "
    f"both axes, and the spins alternate between {SPIN:g} and {SPIN / 3:g} rad/s. The gap is from {_low_2:.2f} to {_high_2:.2f} "
    f"rad/s, and the Chern number is {signed(_number_2)}. The dashed lines bound the gaps. Colour and shape mark the waves whose "
    f"mean position is closer to a border than {100 * NEAR:.0f} % of the width. "
    f"The net number of rising curves across the gap is {signed(_first)} at the "
    f"first border and {signed(_last)} at the last."
)


# %%
def figure() -> Figure:
    """The bands of both strips about their gaps."""
    d = data()
    picture = Figure(figsize=(8.6, 4.8))
    panels = picture.subplots(1, 2)
    for panel, name, title in zip(
        panels, PATTERNS, ("Honeycomb of springs", "Rigid bars, squares and octagons"), strict=True
    ):
        rates, place = d[f"{name}_rates"], d[f"{name}_place"]
        at = np.broadcast_to(d["q"][:, None], rates.shape)
        first, last = place < NEAR, place > 1 - NEAR
        low, high = d[f"{name}_gap"]
        reach = 3 * max(high - low, 0.25)
        shown = (rates > low - reach) & (rates < high + reach)
        for kept, ink, mark, size, label in (
            (~first & ~last, "#c4c4c4", ".", 3.5, "bulk"),
            (first, CASE_COLOURS[1], "^", 3, "first border"),
            (last, CASE_COLOURS[0], "s", 2.5, "last border"),
        ):
            seen = kept & shown
            panel.plot(at[seen], rates[seen], mark, ms=size, color=ink, label=label, rasterized=label == "bulk")
        for edge in (low, high):
            panel.axhline(edge, color="#222222", lw=0.8, ls="--", label="edges of the gap")
        panel.set(xlabel="wave number along the strip (rad)", ylabel="rate (rad/s)", title=title, xlim=(0, 2 * np.pi))
        panel.set_ylim(low - reach, high + reach)
    legend_below(picture, 4, markerscale=2)
    return picture
