"""Films, as GIF, of lines that move: rods, wheels, whatever joins points, some leaving the path of their last point."""

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

FASTEST = 50.0  # frames per second: a GIF counts in hundredths of a second, and players take 2 of them at least
SIZE = (720, 420)  # of a frame, in pixels
SPOKES = 5  # few, so that a turn of 0.4 rad from frame to frame is not seen as one backwards
LONGEST = 600  # s of a film
_DPI = 100
Pixels = NDArray[np.uint8]
# On a figure: axes, and what gives, for a frame's number, the artists to draw.
Stage = Callable[[Figure], tuple[Axes, Callable[[int], list[Artist]]]]


def check_film(path: str | Path, duration: float, fps: float) -> None:
    """Raises InputError unless a film of `duration` s, at `fps` frames per second, can be written to `path`."""
    path = path_of("animate: path", path)
    if path.suffix != ".gif":
        raise InputError(
            f"animate: {path}: the name must end in .gif; `ffmpeg -i run.gif run.mp4` makes other films of it"
        )
    if path.is_dir():
        raise InputError(f"animate: {path} is a folder: give a file")
    if not 1 <= fps <= FASTEST:
        raise InputError(f"animate: fps = {fps:g} must lie between 1 and {FASTEST:g} frames per second")
    if not 1 / fps <= duration <= LONGEST:
        raise InputError(
            f"animate: {duration:g} s: a film lasts one frame ({1 / fps:g} s) at least, {LONGEST} s at most"
        )


def frame_times(begin: float, end: float, fps: float) -> Array:
    """Times of the frames (m,) in s, 1/fps apart from `begin` to `end`, both counted where the last falls on it."""
    return np.minimum(begin + np.arange(int((end - begin) * fps * (1 + 1e-12)) + 1) / fps, end)


class Film(type(Path())):  # type: ignore[misc]
    """The file of a film; a notebook shows it."""

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
    """Frames in one palette, so that nothing flickers; durations in hundredths of a second whose sum is right."""
    from PIL import Image

    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette().ravel().tolist())
    images = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    # Two neighbours that are the same become one frame that lasts as long as both.
    ends = 10 * np.rint(100 / fps * np.arange(count + 1)).astype(int)
    next(images).save(
        file, "GIF", save_all=True, append_images=images, duration=np.diff(ends).tolist(), loop=0, optimize=False
    )


def _palette() -> Pixels:
    """Every ink in steps from white to itself, (96, 3): what anti-aliasing makes of it on white, of which nothing is so near
    that the nearest colour of white could be another."""
    inks = np.array([to_rgb(ink) for ink in (INK, *ROTORS, MARK)])
    share = np.append(0, np.linspace(0.08, 1, 23))[:, None, None]
    return np.rint(255 * (1 + share * (inks - 1))).astype(np.uint8).reshape(-1, 3)


def _frames(count: int, stage: Stage) -> Iterator[Pixels]:
    """The frames (height, width, 3). What does not move is drawn once; of the rest only the data change."""
    with paper_style():
        figure = Figure(figsize=(SIZE[0] / _DPI, SIZE[1] / _DPI), dpi=_DPI)
        canvas = FigureCanvasAgg(figure)
        axes, update = stage(figure)
        canvas.draw()  # type: ignore[no-untyped-call]
        still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]
        for i in range(count):
            canvas.restore_region(still)  # type: ignore[no-untyped-call]
            for artist in update(i):
                axes.draw_artist(artist)  # which hands it to the figure's renderer: any of the figure's axes will do
            yield np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])  # type: ignore[no-untyped-call]


def _line(axes: Axes, colour: str, width: float) -> Line2D:
    return axes.plot([], [], color=colour, linewidth=width, animated=True, solid_capstyle="round")[0]


@dataclass(frozen=True, eq=False)
class FilmedMotion:
    """The motion of N rotors at the times t (m,) in s: rotations (N, m, 3, 3), tips, centres (N, m, 3), joints (N, 3) in m.

    length: of an axis, m. joined: whether a bar is drawn between the tips.
    """

    t: Array
    rotations: Array
    tips: Array
    centres: Array
    joints: Array
    length: float
    joined: bool

    def lines(self) -> tuple[list[Array], list[str], list[int]]:
        """Return lines (m, p, 3) in m, their colours, and which leave a path: wheels with a spoke marked, axes, bar, ground.

        The wheels are not to the inertia's scale.
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
    """Write lines (m, p, 3) in m at the times t (m,) of the frames as a film, `.gif`, at its own speed.

    Seen along y where nothing moves along it, from above where nothing rises, else obliquely.

    Parameters
    ----------
    path : str or Path
        Of the file, which is written whole or not at all.
    t : Array
        Times of the frames, (m,), in s.
    lines : sequence
        Each (m, p, 3), in m.
    fps : float
        Frames per second.
    inks : sequence, default ROTORS
        Colours of the lines, again from the first where there are fewer than lines.
    traced : Sequence[int] or None, optional
        The lines whose last point leaves its path; all where it is not given.
    step : callable, default lambda name: None
        Called with each second of the film as it begins.

    Raises
    ------
    InputError
        For a name or a rate that will not do, before anything is drawn.
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
    """The direction (0, 1, 2) along which nothing extends, if there is one: 1 before 2 before 0."""
    extent = np.ptp(np.concatenate([line.reshape(-1, 3) for line in lines]), axis=0)
    return next((i for i in (1, 2, 0) if extent[i] <= 1e-9 * extent.max()), None)


def _limits(axes: Axes, points: Array) -> None:
    low, high = points.min(0), points.max(0)
    room = 0.08 * (high - low).max() or 1.0
    axes.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room), aspect="equal")
    axes.axis("off")
