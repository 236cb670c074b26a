"""What the diagrams are drawn with: a bare canvas, arrows, arcs and labels, all in metres of the picture."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from numpy.typing import ArrayLike

from lagrotor.drawing.style import HALO
from lagrotor.drawing.wheel import INK, MARK, Camera, place_points, wheel
from lagrotor.numerics.rotations import Array


def canvas(figure: Figure, seen: Array, room: float = 0.12) -> Axes:
    """The figure's one panel, without axes, of equal scales, around the points seen (…, 2) with `room` (m) about them."""
    axes = figure.subplots()
    bare(axes, seen, room)
    return axes


def bare(axes: Axes, seen: Array, room: float = 0.12) -> None:
    """Take the frame off a panel and fit it around the points seen (…, 2), with `room` (m) about them."""
    low, high = seen.reshape(-1, 2).min(0) - room, seen.reshape(-1, 2).max(0) + room
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.axis("off")


def arrow(
    axes: Axes, start: ArrayLike, end: ArrayLike, colour: str = INK, width: float = 2.0, style: str = "-|>"
) -> None:
    """An arrow from `start` (2,) to `end` (2,)."""
    (x, y), (u, v) = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    axes.add_patch(
        FancyArrowPatch((x, y), (u, v), arrowstyle=style, mutation_scale=14, color=colour, linewidth=width,
                        shrinkA=0, shrinkB=0, zorder=4, joinstyle="miter")
    )  # fmt: skip


def path_arrow(axes: Axes, points: Array, colour: str = INK, width: float = 1.6) -> None:
    """A line through points (n, 2) with a head at its end: an arc that says which way."""
    axes.plot(points[:-1, 0], points[:-1, 1], color=colour, linewidth=width, zorder=4)
    arrow(axes, points[-2], points[-1], colour, width)


def label(
    axes: Axes, at: ArrayLike, text: str, colour: str = INK, shift: tuple[float, float] = (0, 0), **more: Any
) -> None:
    """Text near `at` (2,), moved by `shift` points, with a white rim so that no line runs through it."""
    x, y = np.asarray(at, dtype=float)
    style: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 11, "color": colour, "zorder": 6} | more
    axes.annotate(text, (x, y), xytext=shift, textcoords="offset points", path_effects=HALO, **style)


def arc(centre: ArrayLike, u: Array, v: Array, radius: float, begin: float, end: float, n: int = 41) -> Array:
    """Points (n, 3) of centre + radius (u cos a + v sin a), a from `begin` to `end` (rad); u, v unit and orthogonal."""
    a = np.linspace(begin, end, n)[:, None]
    return np.asarray(centre, dtype=float) + radius * (np.cos(a) * u + np.sin(a) * v)


def arc_between(u: Array, v: Array, radius: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Points (31, 3) of the arc of `radius` (m) about `centre` from the direction u to the direction v, unit vectors."""
    angle = float(np.arccos(np.clip(u @ v, -1, 1)))
    across = v - (u @ v) * u
    return arc(centre, u, across / np.linalg.norm(across), radius, 0.0, angle, 31)


def draw_wheel(
    axes: Axes, camera: Camera, rotation: Array, centre: Array, size: tuple[float, float], colour: str
) -> None:
    """A wheel of eight spokes and (radius, axle) in m carried by a body's rotation and centre, one spoke marked."""
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
    """Ground joints at points (2,)."""
    for x, y in np.asarray(at, dtype=float):
        axes.plot([x], [y], "^", color=INK, markersize=size, zorder=5)
