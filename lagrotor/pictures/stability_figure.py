"""The figure of `lagrotor stability`: where each closed form stops being useful."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lagrotor.benchmark.limits.error_map import USEFUL, Usefulness
from lagrotor.drawing.style import EXACT_COLOUR, paper_style
from lagrotor.files import write_beside

STEM = "stability"


def stability_figure(useful: Usefulness) -> Figure:
    """Error of each order over amplitude and departure from opposite spins, and the line beyond which it is no use."""
    figure = Figure(figsize=(7.4, 3.9))
    panels = figure.subplots(1, len(useful.orders), sharey=True, squeeze=False)[0]
    levels = np.arange(-8, 1)
    for panel, order, errors in zip(panels, useful.orders, useful.errors, strict=True):
        shown = np.clip(np.log10(errors), levels[0], levels[-1])
        filled = panel.contourf(useful.amplitudes, useful.departures, shown, levels, cmap="cividis")
        panel.contour(
            useful.amplitudes,
            useful.departures,
            np.log10(errors / useful.amplitudes / USEFUL),
            [0.0],
            colors=EXACT_COLOUR,
            linewidths=2,
        )
        panel.set(xscale="log", yscale="log", title=f"order {order}", xlabel="amplitude $r_0$")
        panel.grid(False)
    panels[0].set_ylabel(r"departure from opposite spins, $1 + \omega_2/\omega_1$")
    bar = figure.colorbar(filled, ax=list(panels))
    bar.set_label(r"largest error over one turn, $\log_{10}$ of R")
    line = Line2D([], [], color=EXACT_COLOUR, linewidth=2, label=f"error {USEFUL:g} $r_0$: useful left of and below it")
    figure.legend(handles=[line], loc="outside lower center")
    return figure


def draw_stability(useful: Usefulness, folder: Path) -> tuple[Path, Path]:
    """Write `stability.svg` and `stability.png` into the folder. Raises InputError when it cannot be written to."""
    with paper_style():
        figure = stability_figure(useful)
        svg = write_beside(
            folder / f"{STEM}.svg", lambda file: figure.savefig(file, format="svg", metadata={"Date": None})
        )
        png = write_beside(
            folder / f"{STEM}.png", lambda file: figure.savefig(file, format="png", metadata={"Software": None})
        )
    return svg, png
