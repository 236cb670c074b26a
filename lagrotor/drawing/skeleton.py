"""A film of lines that move: rods, wheels, whatever joins points; each leaves the path of its last point."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lagrotor.drawing.film import SIZE, Pixels, check_film, write_film
from lagrotor.drawing.style import paper_style
from lagrotor.drawing.wheel import BAR, GROUND, ROTORS, Camera
from lagrotor.numerics.rotations import Array

_DPI = 100


def animate_lines(path: str | Path, t: Array, lines: Sequence[Array], fps: float, inks: Sequence[str] = ROTORS) -> Path:
    """Write lines (m, p, 3) in m at the times t (m,) of the frames as a film, `.gif` or `.mp4`, at its own speed.

    inks: their colours, again from the first where there are fewer than lines.

    Seen along y where nothing moves along it, from above where nothing rises, else obliquely.

    Raises InputError for a name or a rate that will not do, before anything is drawn.
    """
    target = Path(path)
    check_film(target, float(t[-1] - t[0]), fps)
    return write_film(target, _frames(t, [_projection(line, _flat(lines)) for line in lines], inks), len(t), fps)


def _flat(lines: Sequence[Array]) -> int | None:
    """The direction (0, 1, 2) along which nothing extends, if there is one: 1 before 2 before 0."""
    extent = np.ptp(np.concatenate([line.reshape(-1, 3) for line in lines]), axis=0)
    return next((i for i in (1, 2, 0) if extent[i] <= 1e-9 * extent.max()), None)


def _projection(line: Array, flat: int | None) -> Array:
    return Camera()(line) if flat is None else np.delete(line, flat, axis=-1)


def _frames(t: Array, lines: Sequence[Array], inks: Sequence[str]) -> Iterator[Pixels]:
    """The frames (height, width, 3): what does not move is drawn once."""
    with paper_style():
        figure = Figure(figsize=(SIZE[0] / _DPI, SIZE[1] / _DPI), dpi=_DPI)
        canvas = FigureCanvasAgg(figure)
        axes = figure.subplots()
        _limits(axes, np.concatenate([line.reshape(-1, 2) for line in lines]))
        drawn = [_line(axes, inks[i % len(inks)], 2.4) for i in range(len(lines))]
        traces = [_line(axes, BAR if len(lines) > 1 and i < len(lines) - 1 else GROUND, 1.0) for i in range(len(lines))]
        clock = axes.text(0.02, 0.98, "", transform=axes.transAxes, va="top", animated=True, fontsize=11)
        canvas.draw()  # type: ignore[no-untyped-call]
        still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]
        for i, now in enumerate(t):
            canvas.restore_region(still)  # type: ignore[no-untyped-call]
            clock.set_text(f"t = {now:5.2f} s")
            for artist, trace, line in zip(drawn, traces, lines, strict=True):
                trace.set_data(*line[: i + 1, -1].T)
                artist.set_data(*line[i].T)
            for moved in (*traces, *drawn, clock):
                axes.draw_artist(moved)
            yield np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])  # type: ignore[no-untyped-call]


def _line(axes: Axes, colour: str, width: float) -> Line2D:
    return axes.plot([], [], color=colour, linewidth=width, animated=True, solid_capstyle="round")[0]


def _limits(axes: Axes, seen: Array) -> None:
    low, high = seen.min(0), seen.max(0)
    room = 0.08 * (high - low).max() or 1.0
    axes.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room), aspect="equal")
    axes.axis("off")
