"""Films (GIF) of moving lines such as rods and wheels; a line may leave a trace of its last point."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from lagrotor.drawing.style import paper_style
from lagrotor.drawing.wheel import BAR, GROUND, INK, MARK, RADIUS, ROTORS, Camera, place_points
from lagrotor.errors import InputError
from lagrotor.files import path_of, write_beside
from lagrotor.numerics.rotations import Array

FASTEST = 50.0  # frames per second; a GIF counts in 0.01 s, and players show a frame for at least 0.02 s
SIZE = (720, 420)  # of a frame, in pixels
SPOKES = 5  # few, so that a turn of 0.4 rad per frame does not look like a backward turn
LONGEST = 600  # s of a film
_DPI = 100
Pixels = NDArray[np.uint8]
# A function of a figure that returns its axes, and a function of the frame number that returns the artists to draw.
Stage = Callable[[Figure], tuple[Axes, Callable[[int], list[Artist]]]]


def check_film(path: str | Path, duration: float, fps: float) -> None:
    """Raise InputError unless a film of `duration` s, at `fps` frames per second, can be written to `path`."""
    path = path_of("animate: path", path)
    if path.suffix != ".gif":
        raise InputError(f"animate: {path}: the name must end in .gif; `ffmpeg -i run.gif run.mp4` converts it")
    if path.is_dir():
        raise InputError(f"animate: {path} is a folder: give a file")
    if not 1 <= fps <= FASTEST:
        raise InputError(f"animate: fps = {fps:g} must lie between 1 and {FASTEST:g} frames per second")
    if not 1 / fps <= duration <= LONGEST:
        raise InputError(f"animate: {duration:g} s: a film must last from one frame ({1 / fps:g} s) to {LONGEST} s")


def frame_times(begin: float, end: float, fps: float) -> Array:
    """Return the times of the frames (m,) in s, 1/fps apart from `begin` to at most `end`."""
    return np.minimum(begin + np.arange(int((end - begin) * fps * (1 + 1e-12)) + 1) / fps, end)


class Film(type(Path())):  # type: ignore[misc]
    """The path of a film's file; a notebook displays the film."""

    def _repr_html_(self) -> str:
        from base64 import b64encode

        data = b64encode(self.read_bytes()).decode()
        return f'<img src="data:image/gif;base64,{data}" alt="The motion">'


def _announce_seconds(
    frames: Iterator[Pixels], count: int, fps: float, step: Callable[[str], None]
) -> Iterator[Pixels]:
    second = 0
    for i, frame in enumerate(frames):
        if i / fps >= second and (i < count - 1 or second == 0):
            second += 1
            step(f"second {second}")
        yield frame


def _write_gif(file: IO[bytes], frames: Iterator[Pixels], count: int, fps: float) -> None:
    """Write frames as a GIF with one palette, so that nothing flickers. The durations, rounded, add up to the total."""
    from PIL import Image

    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette().ravel().tolist())
    images = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    # Pillow merges equal neighbouring frames into one that lasts as long as both.
    ends = 10 * np.rint(100 / fps * np.arange(count + 1)).astype(int)
    next(images).save(
        file, "GIF", save_all=True, append_images=images, duration=np.diff(ends).tolist(), loop=0, optimize=False
    )


def _palette() -> Pixels:
    """Return the palette, shape (96, 3). It has each ink in 24 steps from white, as anti-aliasing mixes it with white."""
    inks = np.array([to_rgb(ink) for ink in (INK, *ROTORS, MARK)])
    share = np.append(0, np.linspace(0.08, 1, 23))[:, None, None]
    return np.rint(255 * (1 + share * (inks - 1))).astype(np.uint8).reshape(-1, 3)


def _frames(count: int, stage: Stage) -> Iterator[Pixels]:
    """Yield `count` frames, each an array of pixels (height, width, 3); the background is drawn only once."""
    with paper_style():
        figure = Figure(figsize=(SIZE[0] / _DPI, SIZE[1] / _DPI), dpi=_DPI)
        canvas = FigureCanvasAgg(figure)
        axes, update = stage(figure)
        canvas.draw()  # type: ignore[no-untyped-call]
        still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]
        for i in range(count):
            canvas.restore_region(still)  # type: ignore[no-untyped-call]
            for artist in update(i):
                axes.draw_artist(artist)  # draws with the figure's renderer, so any of its axes will do
            yield np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])  # type: ignore[no-untyped-call]


def _line(axes: Axes, colour: str, width: float) -> Line2D:
    return axes.plot([], [], color=colour, linewidth=width, animated=True, solid_capstyle="round")[0]


@dataclass(frozen=True, eq=False)
class FilmedMotion:
    """The motion of N rotors at the times t, shape (m,) in s, for a film.

    rotations: shape (N, m, 3, 3). tips, centres: shape (N, m, 3) in m. joints: the ground joints, shape (N, 3) in m.
    length: of an axis, in m. joined: True if a bar through all tips is drawn.
    """

    t: Array
    rotations: Array
    tips: Array
    centres: Array
    joints: Array
    length: float
    joined: bool

    def lines(self) -> tuple[list[Array], list[str], list[int]]:
        """Return the lines, each of shape (m, p, 3) in m, their colours, and the indices of those that leave a trace.

        The lines are wheels with one marked spoke, axes, bar and ground. The wheels do not show the inertia to scale.
        """
        angles = np.linspace(0, 2 * np.pi, 6 * SPOKES + 1)
        rim = RADIUS * self.length * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
        hub = np.zeros((1, 3))
        spokes = np.vstack([[hub[0], rim[6 * k], hub[0]] for k in range(1, SPOKES)])
        lines = [np.broadcast_to(self.joints[[0, -1]] * [1.8, 1, 1], (len(self.t), 2, 3))]
        inks, traced = [GROUND], list[int]()
        for body, tips in enumerate(self.tips):
            place = self.rotations[body], self.centres[body]
            lines += [place_points(points, *place) for points in (rim, spokes, np.vstack([hub, rim[:1]]))]
            traced.append(len(lines))
            lines.append(np.stack([np.broadcast_to(self.joints[body], tips.shape), tips], 1))
            inks += [ROTORS[body % len(ROTORS)]] * 2 + [MARK, INK]
        return [*lines, *([np.stack([*self.tips], 1)] * self.joined)], [*inks, BAR], traced


def animate_lines(
    path: str | Path,
    t: Array,
    lines: Sequence[Array],
    fps: float,
    inks: Sequence[str] = ROTORS,
    traced: Sequence[int] | None = None,
    step: Callable[[str], None] = lambda name: None,
) -> Path:
    """Write moving lines as a film, `.gif`, in real time.

    The view is along y if nothing moves along y, from above if nothing moves along z, and oblique otherwise.

    Parameters
    ----------
    path : str or Path
        The file; it is written completely or not at all.
    t : Array
        Times of the frames, (m,), in s.
    lines : sequence
        The lines, each of shape (m, p, 3) in m: p points at m times.
    fps : float
        Frames per second.
    inks : sequence, default ROTORS
        Colours of the lines; they repeat if there are fewer colours than lines.
    traced : Sequence[int] or None, optional
        Indices of the lines whose last point leaves a trace; None means all lines.
    step : callable, default lambda name: None
        A function that is called with "second n" at the begin of each second of the film.

    Raises
    ------
    InputError
        Before anything is drawn, for an unsuitable file name, rate or duration.
    """
    target, flat = Path(path), _flat(lines)
    check_film(target, float(t[-1] - t[0]), fps)
    views = [Camera()(line) if flat is None else np.delete(line, flat, axis=-1) for line in lines]

    def stage(figure: Figure) -> tuple[Axes, Callable[[int], list[Artist]]]:
        axes = figure.subplots()
        _limits(axes, np.concatenate([line.reshape(-1, 2) for line in views]))
        drawn = [_line(axes, inks[i % len(inks)], 2.0) for i in range(len(views))]
        traces = [(_line(axes, GROUND, 1.0), views[i]) for i in (range(len(views)) if traced is None else traced)]
        clock = axes.text(0.02, 0.98, "", transform=axes.transAxes, va="top", animated=True, fontsize=11)

        def update(i: int) -> list[Artist]:
            clock.set_text(f"t = {t[i]:5.2f} s")
            for artist, line in zip(drawn, views, strict=True):
                artist.set_data(*line[i].T)
            for trace, line in traces:
                trace.set_data(*line[: i + 1, -1].T)
            return [*(trace for trace, _ in traces), *drawn, clock]

        return axes, update

    frames = _announce_seconds(_frames(len(t), stage), len(t), fps, step)
    return Film(write_beside(target, lambda file: _write_gif(file, frames, len(t), fps)))


def _flat(lines: Sequence[Array]) -> int | None:
    """Return the direction along which the lines have no extent: 1 (y), else 2 (z), else 0 (x); None if there is none."""
    extent = np.ptp(np.concatenate([line.reshape(-1, 3) for line in lines]), axis=0)
    return next((i for i in (1, 2, 0) if extent[i] <= 1e-9 * extent.max()), None)


def _limits(axes: Axes, points: Array) -> None:
    low, high = points.min(0), points.max(0)
    room = 0.08 * (high - low).max() or 1.0
    axes.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room), aspect="equal")
    axes.axis("off")
