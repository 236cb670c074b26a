"""Films, as GIF or MP4: a run with its wheels, the bar, and the paths of the tips; lines that move, rods, whatever joins points,
each leaving the path of its last point."""

import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from numpy.typing import NDArray

from lagrotor.drawing.style import paper_style
from lagrotor.drawing.wheel import BAR, GROUND, INK, MARK, RADIUS, ROTORS, Camera, place_points, wheel
from lagrotor.errors import InputError, LagrotorError
from lagrotor.files import path_of, write_beside
from lagrotor.numerics.rotations import Array

_SUFFIXES = (".gif", ".mp4")
FASTEST = 50.0  # frames per second: a GIF counts in hundredths of a second, and players take 2 of them at least
SIZE = (720, 420)  # of a frame, in pixels; even, as MP4 needs them
SPOKES, ARCS = 5, 8  # few spokes, so that a turn of 0.4 rad from frame to frame is not seen as one backwards
LONGEST = 600  # s of a film
_DPI = 100
Pixels = NDArray[np.uint8]
# On a figure: axes, and what gives, for a frame's number, the artists to draw.
Stage = Callable[[Figure], tuple[Axes, Callable[[int], list[Artist]]]]


def check_film(path: str | Path, duration: float, fps: float) -> None:
    """Raises InputError unless a film of `duration` s, at `fps` frames per second, can be written to `path`."""
    path = path_of("animate: path", path)
    if path.suffix not in _SUFFIXES:
        raise InputError(f"animate: {path}: the name must end in .gif or .mp4")
    if path.is_dir():
        raise InputError(f"animate: {path} is a folder: give a file")
    if path.suffix == ".mp4" and not shutil.which("ffmpeg"):
        raise InputError("animate: an .mp4 needs the program ffmpeg, which is not here: install it, or write a .gif")
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
        if self.suffix == ".gif":
            return f'<img src="data:image/gif;base64,{data}" alt="The motion">'
        return f'<video controls loop src="data:video/mp4;base64,{data}"></video>'


def film_motion(
    moving: "FilmedMotion", path: str | Path, fps: float = 25.0, step: Callable[[str], None] = lambda name: None
) -> Path:
    """Write a motion at its own speed as a film of `fps` frames per second: `.gif`, or `.mp4` where ffmpeg is there.

    Left, the rotors from the side with their wheels (drawn, not to the inertia's scale), one spoke marked so that the spin
    is seen; right, the paths of the tips from above. `step` is called with each second of the film as it begins.

    Raises InputError for a name, a folder or a rate that will not do, before anything is drawn; LagrotorError when
    ffmpeg fails. A file is written whole or not at all.
    """
    target = Path(path)
    check_film(target, float(moving.t[-1] - moving.t[0]), fps)
    count = len(moving.t)

    def stage(figure: Figure) -> tuple[Axes, "_Rotors"]:
        side, above = figure.subplots(1, 2, width_ratios=(1.5, 1))
        return side, _Rotors(moving, side, above)

    return Film(write_film(target, _announce_seconds(_frames(count, stage), count, fps, step), count, fps))


def write_film(target: Path, frames: Iterator[Pixels], count: int, fps: float) -> Path:
    """Write `count` frames (height, width, 3) of SIZE as `.gif` or `.mp4`, whole or not at all; see `check_film`."""
    if target.suffix == ".gif":
        return write_beside(target, lambda file: _write_gif(file, frames, count, fps))
    return write_beside(target, lambda file: _write_mp4(file, frames, fps))


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


def _write_mp4(file: IO[bytes], frames: Iterator[Pixels], fps: float) -> None:
    """Through ffmpeg's standard input and output; a fragmented MP4, as a pipe cannot be wound back."""
    width, height = SIZE
    command = ["ffmpeg", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
    command += ["-r", f"{fps:g}", "-i", "pipe:0", "-an", "-c:v", "libx264", "-pix_fmt", "yuv420p"]
    command += ["-movflags", "frag_keyframe+empty_moov", "-f", "mp4", "pipe:1"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=file, stderr=subprocess.PIPE) as ffmpeg:
        assert ffmpeg.stdin
        assert ffmpeg.stderr
        try:
            for frame in frames:
                ffmpeg.stdin.write(frame.tobytes())
            ffmpeg.stdin.close()
        except BrokenPipeError:
            pass
        except BaseException:
            ffmpeg.kill()
            raise
        said = ffmpeg.stderr.read().decode(errors="replace").strip()
    if ffmpeg.returncode:
        raise LagrotorError(f"animate: ffmpeg failed ({said or ffmpeg.returncode}): write a .gif instead")


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


def _line(axes: Axes, colour: str, width: float, **more: Any) -> Line2D:
    return axes.plot([], [], color=colour, linewidth=width, animated=True, solid_capstyle="round", **more)[0]


def _clock(axes: Axes) -> Text:
    return axes.text(0.02, 0.98, "", transform=axes.transAxes, va="top", animated=True, fontsize=11)


@dataclass(frozen=True, eq=False)
class FilmedMotion:
    """What is drawn of N rotors at the times t (m,) in s: rotations (N, m, 3, 3), tips, centres (N, m, 3), joints (N, 3) in m.

    length: of an axis, m. spins: rad/s. joined: whether a bar is drawn between the tips.
    """

    t: Array
    rotations: Array
    tips: Array
    centres: Array
    joints: Array
    length: float
    spins: tuple[float, ...]
    joined: bool


class _Rotors:
    """The artists, and how they follow the motion: call with a frame's number for those to draw."""

    def __init__(self, moving: FilmedMotion, side: Axes, above: Axes) -> None:
        self.moving, self.camera, length = moving, Camera(), moving.length
        self.points, self.segments = wheel(RADIUS * length, length, SPOKES, ARCS)
        self.paths = self.camera(moving.tips)
        self._still(side, above, RADIUS * length)

        self.traces = [_line(side, ink, 1.2) for ink in ROTORS]
        self.traces_above = [_line(above, ink, 1.2) for ink in ROTORS]
        self.bar = _line(side, BAR, 4.0) if moving.joined else None
        self.bar_above = _line(above, BAR, 3.0) if moving.joined else None
        self.wheels = [LineCollection([], colors=[ink], linewidths=1.3, animated=True) for ink in ROTORS]
        for drawn in self.wheels:
            side.add_collection(drawn)
        self.marks = [_line(side, MARK, 3.0) for _ in ROTORS]
        self.axes = [_line(side, INK, 2.4) for _ in ROTORS]
        self.ends = [_line(axes, INK, 0, marker="o", markersize=5) for axes in (side, above)]
        self.clock = _clock(side)

    def _still(self, side: Axes, above: Axes, radius: float) -> None:
        moving, up = self.moving, self.camera
        rim = up(place_points(self.points, moving.rotations[:, :: max(len(moving.t) // 200, 1)].reshape(-1, 3, 3),
                         moving.centres[:, :: max(len(moving.t) // 200, 1)].reshape(-1, 3)))  # fmt: skip
        seen = np.vstack([rim.reshape(-1, 2), self.paths.reshape(-1, 2), up(moving.joints)])
        low, high = seen.min(0), seen.max(0)
        room = 0.08 * (high - low).max()
        side.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + 2.5 * room), aspect="equal")
        side.axis("off")
        side.plot(*up(moving.joints).T, color=GROUND, linewidth=2, zorder=0)
        side.plot(*up(moving.joints).T, "^", color=INK, markersize=9, zorder=0)
        for spin, ink, name, place in zip(moving.spins, ROTORS, "12", (0.02, 0.52), strict=True):
            side.text(
                place,
                0.0,
                f"rotor {name}: ω = {spin:g} rad/s".replace("-", "−"),
                color=ink,
                transform=side.transAxes,
                fontsize=10,
            )
        flat = moving.tips[..., :2].reshape(-1, 2)
        middle, half = (flat.max(0) + flat.min(0)) / 2, 0.55 * max(np.ptp(flat, axis=0).max(), 1.2 * radius)
        above.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half), aspect="equal")
        above.set(xlabel="x [m]", ylabel="y [m]", title="tips from above")
        above.locator_params(nbins=5)

    def __call__(self, i: int) -> list[Artist]:
        moving = self.moving
        order = np.argsort(self.camera.depth(moving.centres[:, i]))
        points = self.camera(place_points(self.points, moving.rotations[:, i], moving.centres[:, i]))
        spokes = len(self.points) - 2
        drawn: list[Artist] = []
        for k in (0, 1):
            self.traces[k].set_data(*self.paths[k, : i + 1].T)
            self.traces_above[k].set_data(*moving.tips[k, : i + 1, :2].T)
            self.wheels[k].set_segments(list(points[k][self.segments[:-1]]))
            self.marks[k].set_data(*points[k][[0, spokes + 1]].T)
            self.axes[k].set_data(*points[k][self.segments[-1]].T)
        tips = self.paths[:, i]
        self.ends[0].set_data(*tips.T)
        self.ends[1].set_data(*moving.tips[:, i, :2].T)
        drawn += [*self.traces, *self.traces_above]
        for bar, ends in ((self.bar, tips), (self.bar_above, moving.tips[:, i, :2])):
            if bar is not None:
                bar.set_data(*ends.T)
                drawn.append(bar)
        for k in order:
            drawn += [self.wheels[k], self.axes[k], self.marks[k]]
        self.clock.set_text(f"t = {moving.t[i]:5.2f} s")
        return [*drawn, *self.ends, self.clock]


def animate_lines(path: str | Path, t: Array, lines: Sequence[Array], fps: float, inks: Sequence[str] = ROTORS) -> Path:
    """Write lines (m, p, 3) in m at the times t (m,) of the frames as a film, `.gif` or `.mp4`, at its own speed.

    inks: their colours, again from the first where there are fewer than lines.

    Seen along y where nothing moves along it, from above where nothing rises, else obliquely.

    Raises InputError for a name or a rate that will not do, before anything is drawn.
    """
    target, flat = Path(path), _flat(lines)
    check_film(target, float(t[-1] - t[0]), fps)
    seen = [Camera()(line) if flat is None else np.delete(line, flat, axis=-1) for line in lines]

    def stage(figure: Figure) -> tuple[Axes, Callable[[int], list[Artist]]]:
        axes = figure.subplots()
        _limits(axes, np.concatenate([line.reshape(-1, 2) for line in seen]))
        drawn = [_line(axes, inks[i % len(inks)], 2.4) for i in range(len(seen))]
        traces = [_line(axes, BAR if len(seen) > 1 and i < len(seen) - 1 else GROUND, 1.0) for i in range(len(seen))]
        clock = _clock(axes)

        def update(i: int) -> list[Artist]:
            clock.set_text(f"t = {t[i]:5.2f} s")
            for artist, trace, line in zip(drawn, traces, seen, strict=True):
                trace.set_data(*line[: i + 1, -1].T)
                artist.set_data(*line[i].T)
            return [*traces, *drawn, clock]

        return axes, update

    return write_film(target, _frames(len(t), stage), len(t), fps)


def _flat(lines: Sequence[Array]) -> int | None:
    """The direction (0, 1, 2) along which nothing extends, if there is one: 1 before 2 before 0."""
    extent = np.ptp(np.concatenate([line.reshape(-1, 3) for line in lines]), axis=0)
    return next((i for i in (1, 2, 0) if extent[i] <= 1e-9 * extent.max()), None)


def _limits(axes: Axes, seen: Array) -> None:
    low, high = seen.min(0), seen.max(0)
    room = 0.08 * (high - low).max() or 1.0
    axes.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room), aspect="equal")
    axes.axis("off")
