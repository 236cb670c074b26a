"""A run over time: of the pair its tips, their paths from above, energy; of any system its coordinates and energy."""

from collections.abc import Mapping
from io import BytesIO

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lagrotor.drawing.style import paper_style
from lagrotor.drawing.wheel import ROTORS
from lagrotor.numerics.rotations import Array


class RunFigure(Figure):
    """A figure that a notebook shows by itself, without pyplot."""

    def _repr_png_(self) -> bytes:
        with BytesIO() as file:
            self.savefig(file, format="png")
            return file.getvalue()


def run_figure(t: Array, tips: Array, energy: Array, title: str) -> RunFigure:
    """Tips (2, n, 3) in m over t (n,) in s and from above, and the energy (n,) in J: five panels, a colour a rotor."""
    with paper_style():
        figure = RunFigure(figsize=(9.0, 6.0))
        panels = figure.subplot_mosaic([["x", "above"], ["y", "above"], ["z", "energy"]], width_ratios=(1.5, 1))
        for j, letter in enumerate("xyz"):
            panel = panels[letter]
            for i, ink in enumerate(ROTORS):
                panel.plot(t, tips[i, :, j], color=ink, label=f"rotor {i + 1}")
            panel.set_ylabel(f"{letter} of the tip [m]")
            _over_time(panel, letter == "z")
        above = panels["above"]
        for i, ink in enumerate(ROTORS):
            above.plot(tips[i, :, 0], tips[i, :, 1], color=ink)
        above.set(xlabel="x of the tip [m]", ylabel="y of the tip [m]", aspect="equal", xmargin=0.05)
        above.set_adjustable("datalim")
        panels["energy"].plot(t, energy, color=ROTORS[0])
        panels["energy"].set_ylabel("energy [J]")
        panels["energy"].margins(y=0.2)
        _over_time(panels["energy"], True)
        handles, labels = panels["x"].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)
        figure.suptitle(title)
    return figure


def coordinates_figure(t: Array, coordinates: Mapping[str, Array], energy: Array, drift: Array) -> RunFigure:
    """Coordinates {label: (n,)} over t (n,) in s, the change of the energy, and the constraints' violation if there is any."""
    below = {"E − E(0)": energy - energy[0]} | ({"largest |g|": drift} if drift.any() else {})
    panels = [*coordinates.items(), *below.items()]
    with paper_style():
        figure = RunFigure(figsize=(7.0, max(3.0, 1.4 * len(panels))))
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (label, values) in zip(axes, panels, strict=True):
            panel.plot(t, values, color=ROTORS[label in below])
            panel.set_ylabel(label)
        axes[-1].set_xlabel("time [s]")
    return figure


def _over_time(panel: Axes, labelled: bool) -> None:
    panel.set_xlabel("time [s]" if labelled else "")
    panel.tick_params(labelbottom=labelled)
