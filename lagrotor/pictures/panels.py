"""Parts of the paper's figures: bodies, arrows and arcs; figures of a shock (11 to 13, 25, 27) and of orbits (17 to 20)."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from numpy.typing import ArrayLike

from lagrotor.drawing.style import (
    CORRECTION_COLOUR,
    EXACT_COLOUR,
    FORCE_COLOUR,
    HALO,
    MODEL_COLOUR,
    PAPER_COLOUR,
    legend_below,
)
from lagrotor.drawing.wheel import INK, MARK, Camera, place_points, wheel
from lagrotor.models.simulate import simulate
from lagrotor.numerics.rotations import Array
from lagrotor.pair.examples import DAMPING, STEP, STIFFNESS
from lagrotor.pair.scene import Scene
from lagrotor.paper.rotor_pair.runs import SPECTRUM_FROM, centre_numbers, centre_off, centre_runs
from lagrotor.renamed import accept_old_keywords


@accept_old_keywords
def canvas(figure: Figure, points: Array, room: float = 0.12) -> Axes:
    """Create the only panel of a figure, without axes; it fits points, shape (…, 2), with a margin `room`, in m."""
    axes = figure.subplots()
    bare(axes, points, room)
    return axes


@accept_old_keywords
def bare(axes: Axes, points: Array, room: float = 0.12) -> None:
    """Remove the frame and the axes of a panel and fit it to points, shape (…, 2), with a margin `room`, in m."""
    low, high = points.reshape(-1, 2).min(0) - room, points.reshape(-1, 2).max(0) + room
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.axis("off")


def arrow(
    axes: Axes, start: ArrayLike, end: ArrayLike, colour: str = INK, width: float = 2.0, style: str = "-|>"
) -> None:
    """Draw an arrow from `start` (2,) to `end` (2,)."""
    (x, y), (u, v) = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    axes.add_patch(
        FancyArrowPatch((x, y), (u, v), arrowstyle=style, mutation_scale=14, color=colour, linewidth=width,
                        shrinkA=0, shrinkB=0, zorder=4, joinstyle="miter")
    )  # fmt: skip


def path_arrow(axes: Axes, points: Array, colour: str = INK, width: float = 1.6) -> None:
    """Draw a line through points (n, 2) with an arrow head at its end."""
    axes.plot(points[:-1, 0], points[:-1, 1], color=colour, linewidth=width, zorder=4)
    arrow(axes, points[-2], points[-1], colour, width)


def label(
    axes: Axes, at: ArrayLike, text: str, colour: str = INK, shift: tuple[float, float] = (0, 0), **settings: Any
) -> None:
    """Write text at the point `at`, shape (2,), displaced by `shift` in typographic points, with a white rim."""
    x, y = np.asarray(at, dtype=float)
    style: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 11, "color": colour, "zorder": 6} | settings
    axes.annotate(text, (x, y), xytext=shift, textcoords="offset points", path_effects=HALO, **style)


def arc(centre: ArrayLike, u: Array, v: Array, radius: float, begin: float, end: float, n: int = 41) -> Array:
    """Return n points, shape (n, 3), of an arc: centre + radius (u cos a + v sin a), with a from `begin` to `end` in rad.

    u, v: orthonormal vectors, shape (3,).
    """
    a = np.linspace(begin, end, n)[:, None]
    return np.asarray(centre, dtype=float) + radius * (np.cos(a) * u + np.sin(a) * v)


def arc_between(u: Array, v: Array, radius: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Return 31 points, shape (31, 3), of the arc about `centre` from the direction u to v; both are unit vectors."""
    angle = float(np.arccos(np.clip(u @ v, -1, 1)))
    normal = v - (u @ v) * u
    return arc(centre, u, normal / np.linalg.norm(normal), radius, 0.0, angle, 31)


def draw_wheel(
    axes: Axes, camera: Camera, rotation: Array, centre: Array, size: tuple[float, float], colour: str
) -> None:
    """Draw a wheel with one marked spoke at a rotation (3, 3) and a centre (3,); `size` is (radius, axle) in m."""
    points, segments = wheel(*size, 8, 8)
    placed = place_points(points, rotation, centre)
    ends = camera(placed)[segments]
    near = camera.depth(placed)[segments].mean(1) >= camera.depth(centre)
    for front, alpha in ((False, 0.45), (True, 1.0)):
        chosen = list(ends[:-1][near[:-1] == front])
        axes.add_collection(LineCollection(chosen, colors=[colour], linewidths=1.3, alpha=alpha, capstyle="butt"))
    axes.plot(*ends[-1].T, color=INK, linewidth=2.2, zorder=3)
    axes.plot(*camera(placed)[[0, len(points) - 1]].T, color=MARK, linewidth=2.6, zorder=3)


def ground(axes: Axes, at: Sequence[ArrayLike], size: float = 9) -> None:
    """Draw a triangle for each ground joint at the points `at`, each of shape (2,)."""
    for x, y in np.asarray(at, dtype=float):
        axes.plot([x], [y], "^", color=INK, markersize=size, zorder=5)


def shock_figure(data: dict[str, Array], letter: str) -> Figure:
    """Draw the energy, the force and the centre of rotor 1 over time, as in figures 11 to 13; the exact model is dashed.

    data: t (n,) in s; energy (n,) in J; force (n,) in N along the direction `letter`; centre (n, 3) in m; exact_energy and
    exact_centre, the same of the exact model; exact_t (m,), its times in s, if it ends before the run.
    """
    figure = Figure(figsize=(7.0, 7.0))
    upper, middle, lower = figure.subplots(3, 1, sharex=True, height_ratios=(1, 0.7, 1.6))
    upper.plot(data["t"], data["energy"], color=MODEL_COLOUR, linewidth=3)
    upper.plot(data.get("exact_t", data["t"]), data["exact_energy"], color=EXACT_COLOUR, linestyle="--", linewidth=1.2)
    upper.set(ylabel="energy (J)", title="Energy")
    upper.margins(y=0.12)
    middle.plot(data["t"], data["force"], color=FORCE_COLOUR)
    middle.set(ylabel=f"force in {letter} (N)", title="Force on the tip of rotor 1", ylim=(-3, 55))
    for name, centre, exact in zip("xyz", data["centre"].T, data["exact_centre"].T, strict=True):
        first = name == "x"
        lower.plot(data["t"], centre, color=MODEL_COLOUR, linewidth=3, label="paper's method" if first else None)
        lower.plot(
            data.get("exact_t", data["t"]), exact, color=EXACT_COLOUR, linestyle="--", linewidth=1.2,
            label="exact model" if first else None,
        )  # fmt: skip
        lower.annotate(f"${name}$", (0.2, centre[0]), (0, 5), textcoords="offset points")
    if "exact_t" in data:
        end = data["exact_t"][-1]
        for panel in (upper, lower):
            panel.axvline(end, color=EXACT_COLOUR, linewidth=0.8, linestyle=":", label="end of the exact model")
        lower.annotate("bar and axes in line", (end, -0.8), (8, 0), textcoords="offset points")
    lower.set(ylabel="centre of rotor 1 (m)", xlabel="time $t$ (s)", title="Centre of mass of rotor 1")
    lower.margins(y=0.12)
    legend_below(figure, 3)
    return figure


def shock_script(scene: Scene, letter: str) -> tuple[Callable[[], Any], Callable[[], Any], str, Callable[[], Figure]]:
    """Return the parts of a script for figure 12 or 13: a pair after a shock of 50 N along the direction `letter`.

    They are the functions data and measure, the caption, and the function figure.
    """

    @cache
    def data() -> dict[str, Array]:
        t = np.arange(2001, dtype=float) * (5 * STEP)
        return centre_runs(t, simulate(scene, t))

    def measure() -> dict[str, float]:
        return centre_numbers(data()) | {"centre at 10 s, off the exact model (m)": centre_off(data())}

    energy, exact, x, y, z, distance = measure().values()
    caption = (
        f"Run of the spring-link model with the paper's step of {STEP:g} s, S = {STIFFNESS:g} N/m and D = {DAMPING:g} "
        "kg/s (n = 20, "
        "omega_s = 10 rad/s in 4.01, as in figure 10), a bar of 1 kg and 1 kg m², spins of 10 and −10 rad/s, and the shock "
        f"50 exp(−(50 (t − 2))²) N along {letter} on the tip of rotor 1 (b). The energy (a) rises from 100 to {energy:.3f} J; "
        f"the exact model gives {exact:.3f} J. In 10 s the centre of rotor 1 (c) moves over a range of {x:.2f} m in x, "
        f"{y:.2f} m in y and {z:.2f} m in z. The "
        f"dashed curves are the exact model, which differs by {1000 * distance:.1f} mm at 10 s. The paper's z is 0.5 m less."
    )
    return data, measure, caption, lambda: shock_figure(data(), letter)


# Time spans (s) in which the curves differ visibly: first swings after the shock, last swings of the run.
_FIRST, _LAST = (1.9, 4.0), (8.5, 10.0)


def rate_figure(data: dict[str, Array], printed: float) -> Figure:
    """Draw x of tip 1 in its first and last oscillations, the residual of x and its spectrum, as in figures 25 and 27.

    printed: the paper's rate, rad/s. data: t (n,) in s; force (n,) in N; exact, springs, printed, corrected (n,), the change
    of x of tip 1 in m by each method; rate in rad/s with exact_amplitude and springs_amplitude in m, the spectra;
    closed_form_rate (1,) in rad/s. The sine curves start with the shock; the residual is shown from the end of the shock.
    """
    figure = Figure(figsize=(7.0, 8.4))
    panels = figure.subplot_mosaic(
        [["force", "force"], ["first", "last"], ["residual", "residual"], ["heights", "heights"]],
        height_ratios=(0.7, 1.7, 1.2, 1.4),
    )
    force, residual, heights = (panels[name] for name in ("force", "residual", "heights"))
    force.plot(data["t"], data["force"], color=FORCE_COLOUR)
    force.set(ylabel="force (N)", title="Force on tip 1 along x", xlabel="time $t$ (s)", xlim=(1.5, 10))
    for x, span, says in ((panels["first"], _FIRST, "The first swings"), (panels["last"], _LAST, "The last swings")):
        x.plot(data["t"], data["exact"], color=EXACT_COLOUR, lw=2.4, label="exact model")
        x.plot(data["t"], data["springs"], color=MODEL_COLOUR, lw=1.2, label="paper's method, stiff springs")
        x.plot(data["t"], data["printed"], color=PAPER_COLOUR, ls="--", lw=1.2, label=f"sin {printed:g}(t − 2), scaled")
        x.plot(
            data["t"], data["corrected"], color=CORRECTION_COLOUR, ls=":", lw=2, label="sine at the closed form's rate"
        )
        x.set(xlim=span, xlabel="time $t$ (s)", ylabel="$x - x(0)$ (m)", title=f"x of tip 1: {says.lower()}")
    over = data["t"] > SPECTRUM_FROM
    for name, colour, line in (
        ("printed", PAPER_COLOUR, "--"),
        ("springs", MODEL_COLOUR, "-"),
        ("corrected", CORRECTION_COLOUR, ":"),
    ):
        residual.plot(
            data["t"][over], (data[name] - data["exact"])[over], color=colour, ls=line, lw=2 if line == ":" else 1.2
        )
    residual.set(xlabel="time $t$ (s)", ylabel="difference (m)", xlim=(1.5, 10))
    residual.set_title("Difference of x from the exact model, after the shock")
    heights.plot(data["rate"], data["exact_amplitude"], color=EXACT_COLOUR)
    heights.plot(data["rate"], data["springs_amplitude"], color=MODEL_COLOUR, lw=1.2)
    heights.axvline(printed, color=PAPER_COLOUR, ls="--", lw=1.2)
    heights.axvline(data["closed_form_rate"][0], color=CORRECTION_COLOUR, ls=":", lw=2)
    heights.set(xlabel="rate (rad/s)", ylabel="amplitude (m)", title="Spectrum of x after the shock")
    heights.set(xlim=(printed - 5, printed + 5), ylim=(0, None))
    legend_below(figure, 2)
    return figure


def orbits_from_above(panel: Axes, wide: float, high: float) -> None:
    """Prepare a panel for both tips seen from above: the ground joints at x = ∓0.5 m, and limits ±wide, ±high in m."""
    panel.plot([-0.5, 0.5], [0, 0], "s", color="#222222", ms=6, label="ground joints")
    panel.set(xlabel="x (m)", ylabel="y (m)", title="Top view", xlim=(-wide, wide), ylim=(-high, high))
    panel.set_aspect("equal")


def over_one_turn(panel: Axes) -> None:
    """Put ticks at quarter turns, 0 to 2π, on the horizontal axis of a panel, which shows the phase."""
    panel.set_xticks(np.arange(5) * np.pi / 2, ["0", "π/2", "π", "3π/2", "2π"])


@accept_old_keywords
def distance_over_one_turn(panel: Axes, least: float, greatest: float) -> None:
    """Prepare a panel for the distance, in m, of tip 1 from the exact tip over the phase; its limits are given in m."""
    panel.set(xlabel="phase (rad)", ylabel="distance (m)", title="Distance of tip 1 from the exact tip")
    panel.set_ylim(least, greatest)
    over_one_turn(panel)
