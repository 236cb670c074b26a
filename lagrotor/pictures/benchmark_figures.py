"""The figures of `lagrotor chart`, error against work, and the figure of the error of the series over its parameters."""

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lagrotor.benchmark.limits.error_map import USEFUL, Usefulness
from lagrotor.benchmark.runner import Benchmark, ChartPoint, Work, failure_sentences, front
from lagrotor.drawing.style import EXACT_COLOUR, OKABE_ITO, legend_below

_MARKS = "osD^vp*XP<>hd"
# Family → label and name of the colour, in the order of the legend.
_FAMILIES = {
    "closed": ("closed forms", "reddish purple"),
    "core": ("core: sympy, numpy, scipy", "blue"),
    "fast": ("fast extra: heyoka", "vermillion"),
    "compiled": ("other compiled solvers", "orange"),
    "scipy": ("other solvers of scipy, minimal model", "sky blue"),
    "springs": ("the paper's method", "black"),
    "peer": ("other tools", "bluish green"),
    "trap": ("one call over the shock, which it may miss", "grey"),
}
_WRAP = 225  # characters per line of a failure
_ACROSS: dict[Work, str] = {
    "seconds": "processor time of a run (s)",
    "nfev": "evaluations of the right-hand side (steps × order for fast)",
}


def speed_chart(chart: Benchmark) -> Figure:
    """Draw the error of all methods against computing time and against evaluations, in two panels.

    Each family of methods has a colour. The front joins the points that none beats in both; failed methods are listed.
    """
    failures = [
        line
        for failure in failure_sentences(chart.failures)
        for line in textwrap.wrap(failure, _WRAP, subsequent_indent="   ")
    ]
    figure = Figure(figsize=(12.0, 7.2 + 0.13 * len(failures)))
    lines: list[tuple[Line2D, bool]] = []
    for axes, work in zip(figure.subplots(1, 2, sharey=True), _ACROSS, strict=True):
        lines = _panel(axes, chart, work)
    figure.axes[0].set_ylabel("largest error of a tip (m)")
    figure.suptitle(chart.says, x=0.06, ha="left")
    legend = figure.legend(
        handles=[line for line, _ in lines],
        loc="outside right upper",
        fontsize=7,
        title="in brackets: set-up time",
        title_fontsize=7,
        alignment="left",
    )
    for text, (_, is_heading) in zip(legend.get_texts(), lines, strict=True):
        text.set_fontweight("bold" if is_heading else "normal")
    if failures:
        figure.supxlabel("left out:\n" + "\n".join(failures), x=0.01, ha="left", fontsize=6.5, linespacing=1.3)
    return figure


def _panel(axes: Axes, chart: Benchmark, work: Work) -> list[tuple[Line2D, bool]]:
    """Draw one panel; return the lines of its legend, each with True if it is the heading of a family of methods."""
    best = [p for p in front(chart.points, work) if getattr(p, work) > 0]
    grey: dict[str, Any] = {"color": "#bbbbbb", "linewidth": 6, "alpha": 0.5}
    axes.step([getattr(p, work) for p in best], [p.error for p in best], where="post", label="front", **grey)
    lines = [(Line2D([], [], label="front", **grey), False)]
    families = {p.method: p.family for p in chart.points}
    number = 0
    for family, (called, colour) in _FAMILIES.items():
        names = [name for name in families if families[name] == family]
        if names:
            lines.append((Line2D([], [], linestyle="", label=called), True))
        for place, name in enumerate(names):
            number += 1
            points = [p for p in chart.points if p.method == name and getattr(p, work) > 0 and p.error > 0]
            ready = f" ({chart.setup[name]:.1f} s)" if chart.setup[name] > 0.05 else ""
            look: dict[str, Any] = {"color": OKABE_ITO.get(colour, "#888888"), "marker": _MARKS[place % len(_MARKS)]}
            look["linestyle"] = "--" if family == "trap" else "-"
            line = _curve(axes, points, work, number, look)
            line.set_label(f"{number}  {name}{ready}")
            lines.append((line, False))
    axes.axhline(max(chart.floor, 1e-16), color="#888888", linestyle=":", linewidth=0.8)
    axes.set_xlabel(_ACROSS[work])
    axes.margins(0.06)
    return lines


def _curve(axes: Axes, points: list[ChartPoint], work: Work, number: int, look: dict[str, Any]) -> Line2D:
    """Draw the curve of one method, with the method's number at its most accurate point; return the curve."""
    costs, errors = [getattr(p, work) for p in points], [p.error for p in points]
    (line,) = axes.loglog(costs, errors, markersize=4, linewidth=0.9, **look)
    if points:
        end = min(points, key=lambda p: p.error)
        at = getattr(end, work), end.error
        axes.annotate(str(number), at, (3, -7), textcoords="offset points", fontsize=7, color=look["color"])
    return line


def stability_figure(useful: Usefulness) -> Figure:
    """Draw the error of the series of each order in colour, over the amplitude and the departure from opposite spins.

    A line marks where the error exceeds USEFUL times the amplitude.
    """
    figure = Figure(figsize=(7.4, 3.9))
    panels = figure.subplots(1, len(useful.orders), sharey=True, squeeze=False)[0]
    levels = np.arange(-8, 1)
    for panel, order, errors in zip(panels, useful.orders, useful.errors, strict=True):
        clipped = np.clip(np.log10(errors), levels[0], levels[-1])
        filled = panel.contourf(useful.amplitudes, useful.departures, clipped, levels, cmap="cividis")
        panel.contour(
            useful.amplitudes,
            useful.departures,
            np.log10(errors / useful.amplitudes / USEFUL),
            [0.0],
            colors=EXACT_COLOUR,
            linewidths=2,
        )
        panel.plot(
            [], [], color=EXACT_COLOUR, linewidth=2, label=f"error {USEFUL:g} $r_0$: useful left of and below it"
        )
        panel.set(xscale="log", yscale="log", title=f"Order {order}", xlabel="amplitude $r_0$")
        panel.grid(False)
    panels[0].set_ylabel(r"departure from opposite spins, $1 + \omega_2/\omega_1$")
    bar = figure.colorbar(filled, ax=list(panels))
    bar.set_label(r"$\log_{10}$ of the largest error over one turn (R)")
    legend_below(figure, 1)
    return figure
