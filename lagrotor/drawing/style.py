"""One style for every figure. Its colours have fixed meanings and are those of Okabe & Ito, distinct for the colour-blind."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

OKABE_ITO = {
    "black": "#000000",
    "orange": "#E69F00",
    "sky blue": "#56B4E9",
    "bluish green": "#009E73",
    "yellow": "#F0E442",
    "blue": "#0072B2",
    "vermillion": "#D55E00",
    "reddish purple": "#CC79A7",
}

# Meaning of curves: the paper's formula, its correction, the exact reference, a simulated model.
PAPER_COLOUR = OKABE_ITO["vermillion"]
CORRECTION_COLOUR = OKABE_ITO["bluish green"]
HIGH_ORDER_COLOUR = "#7FD3B8"  # high-order correction, a wide line below the correction
EXACT_COLOUR = OKABE_ITO["black"]
MODEL_COLOUR = OKABE_ITO["blue"]
# Curves that differ by a case, such as a bar or a spin; these colours have no fixed meaning. They are equally light in a
# print without colours, so lines have the dashes CASE_DASHES, colour → dashes, and points have different markers.
CASE_COLOURS = OKABE_ITO["sky blue"], OKABE_ITO["orange"], OKABE_ITO["reddish purple"], "#7A5C1E"
_DASHES: tuple[Any, ...] = "-", (0, (5, 1.5)), (0, (6, 1.5, 1.5, 1.5)), (0, (1.5, 1))
CASE_DASHES = dict(zip(CASE_COLOURS, _DASHES, strict=True))
FORCE_COLOUR = "#777777"

HALO = [withStroke(linewidth=3, foreground="white")]  # around a label on a line

_GRID = "#dddddd"
_INK = "#222222"
_STYLE: dict[Any, Any] = {
    "figure.figsize": (7.0, 4.6),
    "figure.dpi": 100,
    "figure.constrained_layout.use": True,
    "figure.titlesize": 12,
    "savefig.dpi": 160,
    "savefig.facecolor": "white",
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.titley": 1.0,  # fixed position saves its computation; no panel has ticks above
    "axes.labelsize": 10,
    "axes.edgecolor": _INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": cycler(
        color=[MODEL_COLOUR, PAPER_COLOUR, CORRECTION_COLOUR, OKABE_ITO["reddish purple"], OKABE_ITO["orange"]]
    ),
    "axes.formatter.useoffset": False,
    "axes.xmargin": 0.0,
    "grid.color": _GRID,
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "legend.fontsize": 9,
    "legend.framealpha": 0.9,
    "legend.edgecolor": "none",
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "mathtext.fontset": "dejavusans",
    "svg.fonttype": "path",
    "svg.hashsalt": "lagrotor",
}


@contextmanager
def paper_style() -> Iterator[None]:
    """Apply the figure style inside a `with` block, independent of the user's matplotlib settings."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        yield


@contextmanager
def laid_out(figure: Figure, dpi: float = _STYLE["savefig.dpi"]) -> Iterator[Figure]:
    """Yield the figure with its panels placed once for all files written inside the `with` block.

    dpi: pixels per inch, the same for the layout and all files, so that the text is measured only once. The layout engine
    of the figure is removed, because with an engine matplotlib draws each file twice.
    """
    FigureCanvasAgg(figure)
    figure.set_dpi(dpi)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
    with mpl.rc_context({"figure.constrained_layout.use": False, "figure.autolayout": False, "savefig.dpi": dpi}):
        figure.set_layout_engine(None)
        yield figure


def panel_letters(figure: Figure) -> dict[Axes, str]:
    """Return the letter (a), (b), … of each panel in the order of creation; a figure with one panel has no letters."""
    panels = [panel for panel in figure.axes if panel.get_label() != "<colorbar>"]
    return {panel: f"({chr(ord('a') + i)})" for i, panel in enumerate(panels)} if len(panels) > 1 else {}


def letter_panels(figure: Figure) -> Figure:
    """Write the title of each of several panels after its letter, flush left, and return the figure."""
    for panel, letter in panel_letters(figure).items():
        panel.set_title(f"{letter} {panel.get_title()}".rstrip(), loc="left")
        panel.set_title("")
    return figure


def legend_below(figure: Figure, ncols: int, **settings: Any) -> None:
    """Draw one legend below all panels; an entry that does not apply to all of them names the panels to which it does.

    An entry applies to a panel that holds an artist with its label, or an unlabelled line of its colour, dashes and marker.
    """
    entries: dict[str, Any] = {}
    for panel in figure.axes:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    letters = panel_letters(figure)
    names = []
    for label, handle in entries.items():
        its = [letter.strip("()") for panel, letter in letters.items() if _applies(label, handle, panel)]
        names.append(label if len(its) == len(letters) else f"({', '.join(its)}) {label}")
    figure.legend(list(entries.values()), names, loc="outside lower center", ncols=ncols, **settings)


def _applies(label: str, handle: Any, panel: Axes) -> bool:
    unlabelled = [line_look(line) for line in panel.lines if str(line.get_label()).startswith("_")]
    alike = isinstance(handle, Line2D) and line_look(handle) in unlabelled
    return alike or label in panel.get_legend_handles_labels()[1]


def line_look(line: Line2D) -> tuple[str, ...]:
    """Return what distinguishes a line in a legend: its colour, its dashes, its marker and the marker's filling."""
    marker = str(line.get_marker())
    filling = "" if marker == "None" else to_hex(line.get_markerfacecolor(), keep_alpha=True)
    return to_hex(line.get_color()), str(line.get_linestyle()), marker, filling


def with_residual(figure: Figure) -> tuple[Axes, Axes]:
    """Create a panel for curves and a lower panel for their residual, with a common time axis; return both."""
    main, residual = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": (3, 1)})
    return main, residual
