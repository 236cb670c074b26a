"""Moving bodies in three dimensions that turn: a page by itself, which a notebook shows and a browser opens, with no network."""

import json
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np

from lagrotor.drawing.wheel import BAR, GROUND, INK, ROTORS
from lagrotor.files import write_text
from lagrotor.numerics.rotations import Array

_DIGITS = 4  # of a place, relative to the size of the picture
_HEIGHT = 420  # pixels
_STYLE = (
    "body{margin:0;font:14px sans-serif;color:#222;background:#fff}canvas{display:block;width:100%;cursor:grab;touch-action:none}"
    "div{display:flex;gap:8px;align-items:center;padding:4px 8px}input{flex:1}output{width:8em;text-align:right}"
)
_SCRIPT = Path(__file__).with_name("turning_view.js")


@dataclass(frozen=True, eq=False)
class RigidOutline:
    """Lines (p, 3) fixed to a body, m, and at each time its origin (m, 3) and rotation (m, 3, 3), the body's axes as columns."""

    lines: tuple[Array, ...]
    origin: Array
    rotation: Array


@dataclass(frozen=True, eq=False)
class TurningView:
    """Bodies, and lines (m, p, 3) whose points move freely, at the times t (m,) in s; `save` writes what a notebook shows."""

    t: Array
    bodies: tuple[RigidOutline, ...]
    lines: tuple[Array, ...]
    title: str

    @property
    def page(self) -> str:
        """The whole page as HTML: a canvas, a slider and a script."""
        size = self._size
        digits = int(_DIGITS - np.floor(np.log10(size)))

        def plain(values: Array) -> list[float]:
            return np.round(np.asarray(values, float), digits).ravel().tolist()

        data = {
            "t": np.round(self.t, 6).tolist(),
            "size": size,
            "middle": plain(self._middle),
            "bodies": [
                {
                    "lines": [plain(line) for line in body.lines],
                    "origin": plain(body.origin),
                    "rotation": np.round(body.rotation, 5).ravel().tolist(),
                    "ink": ROTORS[i % len(ROTORS)],
                }
                for i, body in enumerate(self.bodies)
            ],
            "lines": [
                {"points": plain(line), "count": line.shape[1], "ink": ROTORS[i % len(ROTORS)]}
                for i, line in enumerate(self.lines)
            ],
            "inks": {"trace": BAR, "ground": GROUND, "text": INK},
        }
        script = _SCRIPT.read_text(encoding="utf-8")
        title = escape(self.title)
        return (
            f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{_STYLE}</style></head>'
            f'<body><canvas role="img" aria-label="{title}: drag to turn" height="{_HEIGHT}"></canvas>'
            '<div><button type="button">pause</button><input type="range" min="0" step="any" aria-label="time">'
            f"<output></output></div>\n<script>const scene = {json.dumps(data)};\n{script}</script></body></html>\n"
        )

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{escape(self.page)}" title="{escape(self.title)}" width="100%" height="{_HEIGHT + 40}" '
            'style="border:0"></iframe>'
        )

    def save(self, path: str | Path) -> Path:
        """Write the page to a file."""
        return write_text(Path(path), self.page)

    @property
    def _places(self) -> Array:
        """Everything that is drawn, (…, 3)."""
        moved = [
            body.origin[:, None] + line @ body.rotation.swapaxes(1, 2) for body in self.bodies for line in body.lines
        ]
        return np.concatenate([each.reshape(-1, 3) for each in (*moved, *self.lines)])

    @property
    def _middle(self) -> Array:
        return np.asarray((self._places.min(0) + self._places.max(0)) / 2)

    @property
    def _size(self) -> float:
        """Half of the length of what is drawn, m."""
        return float(np.linalg.norm(self._places - self._middle, axis=1).max()) or 1.0
