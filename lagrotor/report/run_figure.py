"""Runs over time: what `Trajectory.plot()` shows at a prompt, and the panels that figures 11 to 13 share."""

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..numerics.attitude import Array
from .style import EXACT, MODEL, OKABE_ITO, paper_style
from .wheel import ROTORS

if TYPE_CHECKING:
    from ..numerics.trajectory import Trajectory

COMPONENTS = {"x": OKABE_ITO["blue"], "y": OKABE_ITO["vermillion"], "z": OKABE_ITO["orange"]}


def run_figure(run: "Trajectory") -> Figure:
    """Tips x, y, z over time, from above, and the energy: five panels, a colour a rotor."""
    with paper_style():
        figure = Figure(figsize=(9.0, 6.0))
        panels = figure.subplot_mosaic([["x", "above"], ["y", "above"], ["z", "energy"]], width_ratios=(1.5, 1))
        for j, letter in enumerate("xyz"):
            panel = panels[letter]
            for i, ink in enumerate(ROTORS):
                panel.plot(run.t, run.tips[i, :, j], color=ink, label=f"rotor {i + 1}")
            panel.set_ylabel(f"{letter} of the tip [m]")
            _over_time(panel, letter == "z")
        above = panels["above"]
        for i, ink in enumerate(ROTORS):
            above.plot(run.tips[i, :, 0], run.tips[i, :, 1], color=ink)
        above.set(xlabel="x of the tip [m]", ylabel="y of the tip [m]", aspect="equal", xmargin=0.05)
        above.set_adjustable("datalim")
        panels["energy"].plot(run.t, run.energy, color=ROTORS[0])
        panels["energy"].set_ylabel("energy [J]")
        panels["energy"].margins(y=0.2)
        _over_time(panels["energy"], True)
        handles, labels = panels["x"].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper left", ncols=2)
        figure.suptitle(f"spins {run.scene.spins[0]:g} and {run.scene.spins[1]:g} rad/s, model {run.model}")
    return figure


def _over_time(panel: Axes, labelled: bool) -> None:
    panel.set_xlabel("t [s]" if labelled else "")
    panel.tick_params(labelbottom=labelled)


def shock_figure(data: dict[str, Array], title: str, letter: str) -> Figure:
    """Energy, force and centre of rotor 1 over time, as in the paper's figures 11 to 13; dashed, the exact model.

    data: t (n,) in s, energy (n,) in J, force (n,) in N along `letter`, centre (n, 3) in m, exact_energy, exact_centre;
    exact_t (m,) where the exact model ends before the run.
    """
    figure = Figure(figsize=(7.0, 7.0))
    upper, middle, lower = figure.subplots(3, 1, sharex=True, height_ratios=(1, 0.7, 1.6))
    upper.plot(data["t"], data["energy"], color=MODEL, linewidth=3)
    upper.plot(data.get("exact_t", data["t"]), data["exact_energy"], color=EXACT, linestyle="--", linewidth=1.2)
    upper.set(ylabel="energy [J]", title="Energy")
    upper.margins(y=0.12)
    middle.plot(data["t"], data["force"], color=OKABE_ITO["reddish purple"])
    middle.set(ylabel=f"force in {letter} [N]", title="Force on the tip of rotor 1", ylim=(-3, 55))
    for j, (name, colour) in enumerate(COMPONENTS.items()):
        lower.plot(data["t"], data["centre"][:, j], color=colour, linewidth=3, label=f"{name}, paper's method")
        exact = "exact model" if j == 2 else None
        lower.plot(
            data.get("exact_t", data["t"]),
            data["exact_centre"][:, j],
            color=EXACT,
            linestyle="--",
            linewidth=1.0,
            label=exact,
        )
    lower.set(ylabel="centre of rotor 1 [m]", xlabel="t [s]", title="Centre of mass of rotor 1")
    lower.margins(y=0.06)
    figure.suptitle(title)
    figure.legend(loc="outside lower center", ncols=4)
    return figure
