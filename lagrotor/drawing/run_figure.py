"""Figures of a run over time: the tips and the energy of rotors, or the coordinates and the energy of any system."""

from collections.abc import Collection, Mapping, Sequence
from io import BytesIO

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lagrotor.drawing.style import paper_style
from lagrotor.drawing.wheel import BAR, GROUND, INK, ROTORS
from lagrotor.numerics.rotations import Array

_CONSTANT = 1e-7  # relative variation of a curve that counts as constant


class RunFigure(Figure):
    """A matplotlib figure that a notebook displays although it is made without pyplot."""

    def _repr_png_(self) -> bytes:
        with BytesIO() as file:
            self.savefig(file, format="png")
            return file.getvalue()


def run_figure(
    t: Array,
    tips: Array,
    energy: Array,
    title: str = "",
    inks: Sequence[str] = ROTORS,
    bars: Sequence[tuple[int, int]] = (),
) -> RunFigure:
    """Draw the displacements of the tips over time, the paths of the tips seen from above, and the change of the energy.

    t: shape (n,) in s. tips: shape (N, n, 3) in m. energy: shape (n,) in J. inks: colours of the rotors, repeated if
    there are more rotors. bars: pairs of indices of tips that a line joins in the view from above.
    """
    with paper_style():
        figure = RunFigure(figsize=(9.0, 6.0))
        panels = figure.subplot_mosaic([["x", "above"], ["y", "above"], ["z", "energy"]], width_ratios=(1.5, 1))
        for i, tip in enumerate(tips):
            ink = inks[i % len(inks)]
            for letter, way in zip("xyz", (tip - tip[0]).T, strict=True):
                panels[letter].plot(t, way, color=ink, linewidth=1.2, label=f"rotor {i + 1}")
            panels["above"].plot(tip[:, 0], tip[:, 1], color=ink)
        for i, j in bars:
            panels["above"].plot(*tips[[i, j], 0, :2].T, color=BAR, linewidth=3, zorder=0)
        for letter in "xyz":
            panels[letter].set_ylabel(f"Δ{letter} of the tip (m)")
            panels[letter].tick_params(labelbottom=letter == "z")
        panels["above"].set(xlabel="x of the tip (m)", ylabel="y of the tip (m)", aspect="equal", xmargin=0.05)
        panels["above"].set_adjustable("datalim")
        panels["energy"].plot(t, energy - energy[0], color=INK)
        panels["energy"].set_ylabel("change of the energy (J)")
        panels["energy"].margins(y=0.2)
        for name in ("z", "energy"):
            panels[name].set_xlabel("time $t$ (s)")
        if len(tips) <= len(inks):
            handles, labels = panels["x"].get_legend_handles_labels()
            figure.legend(handles, labels, loc="outside lower center", ncols=len(tips))
        figure.suptitle(title)
    return figure


def coordinates_figure(t: Array, coordinates: Mapping[str, Array], energy: Array, drift: Array) -> RunFigure:
    """Draw coordinates and the change of the energy over the time t, shape (n,) in s, one panel each.

    coordinates: label → values (n,). drift: violation of the constraints, (n,); it is drawn unless all of it is zero.
    """
    below = {"E − E(0) (J)": energy - energy[0]} | ({"largest |g|": drift} if drift.any() else {})
    return curves_figure(t, {**coordinates, **below}, below)


def curves_figure(t: Array, curves: Mapping[str, Array], others: Collection[str] = ()) -> RunFigure:
    """Draw curves, label → values (n,), over t (n,) in s, one panel each; `others` are the labels with a second colour."""
    with paper_style():
        figure = RunFigure(figsize=(7.0, max(3.0, 1.4 * len(curves))))
        axes = figure.subplots(len(curves), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (label, values) in zip(axes, curves.items(), strict=True):
            panel.plot(t, values, color=ROTORS[label in others])
            panel.set_ylabel(label)
            middle = float(np.abs(values).max(initial=0.0))
            if np.ptp(values) < _CONSTANT * middle:  # rounding only
                panel.set_ylim(*sorted((0.9 * values[0], 1.1 * values[0])))
        axes[-1].set_xlabel("time $t$ (s)")
    return figure


def rates_figure(letter: str, numbers: Array, rates: NDArray[np.complex128], marks: Sequence[float]) -> RunFigure:
    """Draw the real and imaginary parts of rates, shape (m, n) in 1/s, over the values `numbers` (m,) of a symbol.

    letter: the label of the symbol. marks: values of the symbol that get a vertical line.
    """
    with paper_style():
        figure = RunFigure(figsize=(7.0, 5.0))
        above, below = figure.subplots(2, 1, sharex=True)
        for panel, values, label in (
            (above, rates.real, "real part (1/s)"),
            (below, rates.imag, "imaginary part (1/s)"),
        ):
            panel.plot(numbers, values, color=ROTORS[0])
            panel.axhline(0, color=GROUND, linewidth=1)
            panel.set_ylabel(label)
            for mark in marks:
                panel.axvline(mark, color=ROTORS[1], linestyle="--", linewidth=1)
        below.set_xlabel(letter)
    return figure


def chart_figure(names: tuple[str, str], numbers: tuple[Array, Array], growth: Array, edges: Array) -> RunFigure:
    """Draw growth rates, shape (n, m) in 1/s, in colour over the values, (m,) and (n,), of two symbols.

    edges: points (k, 2) of the boundary between stable and unstable values, drawn as dots.
    """
    with paper_style():
        figure = RunFigure(figsize=(7.0, 5.0))
        panel = figure.subplots()
        visible = np.where(growth > 1e-6 * max(float(growth.max()), 1e-300), growth, np.nan)
        mesh = panel.pcolormesh(*numbers, visible, cmap="Blues", vmin=0, shading="nearest")
        figure.colorbar(mesh, label="growth rate (1/s)")
        panel.plot(*edges.T, ".", color=ROTORS[1], markersize=4)
        panel.set_xlabel(names[0])
        panel.set_ylabel(names[1])
    return figure
