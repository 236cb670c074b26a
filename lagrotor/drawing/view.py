"""An interactive view of a motion for web pages and notebooks: moving lines that can be turned and played, offline."""

import json
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.files import write_text
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.run import optional_package

FRAMES = 600  # largest number of frames of a view, for a small page
FPS = 30.0
_HERE = Path(__file__).parent
_LARGEST = 32_000  # largest coordinate as a 16-bit integer


@dataclass(frozen=True, eq=False)
class View:
    """A motion as a page, which a notebook displays and `save` writes, or as a widget in a running notebook.

    Attributes
    ----------
    motion : dict
        The times `t` in s, and the lines, whose points are encoded as 16-bit integers.
    title : str
        A line above the motion.
    """

    motion: dict[str, Any]
    title: str

    @property
    def html(self) -> str:
        """The page as HTML text; it needs no network."""
        replacements = {
            "/* style */": _text("view.css"),
            "/* script */": canvas_script() + _text("view.js"),
            "/* data */": json.dumps(self.motion),
            "<!-- motion -->": self._parts(),
        }
        page = _text("view.html")
        for place, content in replacements.items():
            page = page.replace(place, content)
        return page

    def widget(self) -> Any:
        """Return the motion as an anywidget.

        Returns
        -------
        anywidget.AnyWidget
            The widget. Its traits `time` (s) and `playing` may be set, observed, and linked to those of other widgets.

        Raises
        ------
        InputError
            If anywidget is not installed.
        """
        anywidget = optional_package("anywidget")
        import traitlets

        begin, end = self.motion["t"][0], self.motion["t"][-1]
        members = {
            "_esm": canvas_script() + _text("view.js") + _text("view_widget.js"),
            "_css": _text("view.css"),
            "motion": traitlets.Dict(self.motion).tag(sync=True),
            "parts": traitlets.Unicode(self._parts()).tag(sync=True),
            "time": traitlets.Float(begin, min=begin, max=end).tag(sync=True),
            "playing": traitlets.Bool(False).tag(sync=True),
        }
        return type("MotionWidget", (anywidget.AnyWidget,), members)()

    def _parts(self) -> str:
        return _text("view_parts.html").replace("<!-- title -->", escape(self.title))

    def save(self, path: str | Path) -> Path:
        """Write the page to a file.

        Parameters
        ----------
        path : str or Path
            A name that ends in `.html`.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            If the name has another ending, or the file cannot be written.
        """
        if Path(path).suffix != ".html":
            raise InputError(f"view: {path}: the name must end in .html")
        return write_text(Path(path), self.html)

    def _repr_html_(self) -> str:
        frame = 'style="width: 100%; height: 27rem; border: 0" title="The motion"'
        return f'<iframe {frame} srcdoc="{escape(self.html)}"></iframe>'

    def __repr__(self) -> str:
        return f"<View: {len(self.html) / 1000:.0f} kB; a notebook shows it, save('run.html') writes it>"


def view_times(begin: float, end: float) -> Array:
    """Return the times of the frames of a view, shape (m,) in s, from `begin` to `end`: FPS per s, at most FRAMES."""
    return np.linspace(begin, end, int(min(FRAMES, max(2, (end - begin) * FPS + 1))))


def view_lines(
    t: Array,
    lines: Sequence[Array],
    inks: Sequence[str],
    title: str = "",
    traced: Sequence[int] | None = None,
) -> View:
    """Return a view of moving lines at the times t, shape (m,) in s.

    lines: each of shape (m, p, 3) in m, or (1, p, 3) if it does not move. inks: colours, repeated if there are more lines.
    title: a line above the motion. traced: indices of the lines whose last point leaves a trace; None means all lines.
    Raises InputError for an empty or non-finite motion.
    """
    arrays = [np.asarray(line, float) for line in lines]
    if not arrays or len(t) < 2 or not all(line.size and np.isfinite(line).all() for line in arrays):
        why = "nothing moves, or a coordinate is not finite: give lines and at least 2 times, all finite"
        raise InputError(f"view: {len(arrays)} lines at {len(t)} times: {why}")
    corners = np.array([[line.reshape(-1, 3).min(0), line.reshape(-1, 3).max(0)] for line in arrays])
    low, high = corners[:, 0].min(0), corners[:, 1].max(0)
    middle, unit = (low + high) / 2, float((high - low).max() or 1.0) / 2 / _LARGEST
    paths = range(len(lines)) if traced is None else traced

    def encoded(place: int, line: Array) -> dict[str, Any]:
        steps = np.rint((line - middle) / unit).astype("<i2")
        data = b64encode(steps.tobytes()).decode("ascii")
        return {"data": data, "points": line.shape[1], "ink": inks[place % len(inks)], "traced": place in paths}

    motion = {
        "t": [float(f"{item:.6g}") for item in t],
        "unit": unit,
        "middle": middle.tolist(),
        "lines": [encoded(*item) for item in enumerate(arrays)],
    }
    return View(motion, title)


def canvas_script() -> str:
    """Return the JavaScript functions that draw every animation of a page."""
    return _text("canvas.js")


def _text(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")
