"""The wheels of section 3.4 and the camera that draws them: a wireframe carried by each body's rotation and centre."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from lagrotor.drawing.style import OKABE_ITO
from lagrotor.errors import InputError
from lagrotor.numerics.rotations import Array

RADIUS = 0.36  # of a wheel, in lengths of its axis; two wheels on a bar of that length do not meet. Not to the inertia

INK, BAR, GROUND, MARK = "#222222", "#777777", "#aaaaaa", OKABE_ITO["bluish green"]
ROTORS = ("#332288", "#a0568a")  # indigo and purple, as on the page: no curve of a model or of the paper has them


def wheel(radius: float, axle: float, n: int, arcs: int = 1) -> tuple[Array, NDArray[np.intp]]:
    """Wireframe of a wheel about e_z: (points (n arcs + 2, 3) in m, segments (n arcs + 2 n + 1, 2) as indices of them).

    n joints on the rim at radius (cos 2πk/n, sin 2πk/n, 0), with two spokes each, to both ends (0, 0, ∓axle/2) of the
    axle: the last two points. Segments: the rim, of `arcs` chords between two joints (1 as in the paper, more for a
    rounder one), the spokes joint by joint, the axle last.

    Raises InputError for a length not above zero, n below 3, arcs below 1.
    """
    if not (radius > 0 and axle > 0 and n >= 3 and arcs >= 1):
        raise InputError(
            f"wheel: radius = {radius:g} m, axle = {axle:g} m must exceed 0, n = {n} be 3 at least, arcs 1"
        )
    count = n * arcs
    angle = 2 * pi / count * np.arange(count)
    rim = radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    points = np.vstack([rim, [[0, 0, -axle / 2], [0, 0, axle / 2]]])
    k = np.arange(count)
    around = np.column_stack([k, (k + 1) % count])
    spokes = np.column_stack([np.repeat(k[::arcs], 2), np.tile([count, count + 1], n)])
    return points, np.vstack([around, spokes, [[count, count + 1]]]).astype(np.intp)


def place_points(points: Array, rotation: Array, centre: Array) -> Array:
    """Xn = X Rᵀ + X_cm (the paper's listing): points (p, 3) with R (…, 3, 3), X_cm (…, 3) → (…, p, 3), in m."""
    placed: Array = points @ np.swapaxes(rotation, -1, -2) + centre[..., None, :]
    return placed


@dataclass(frozen=True)
class Camera:
    """A parallel projection seen from far away at `azimuth` (from e_x towards e_y) and `elevation`, in degrees."""

    azimuth: float = -72.0
    elevation: float = 16.0

    @property
    def frame(self) -> Array:
        """Rows: right, up and towards the viewer, (3, 3), orthonormal."""
        a, e = radians(self.azimuth), radians(self.elevation)
        right, towards = np.array([-sin(a), cos(a), 0]), np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)])
        return np.array([right, np.cross(towards, right), towards])

    def __call__(self, points: Array) -> Array:
        """Points (…, 3) on the picture (…, 2), in m."""
        picture: Array = points @ self.frame[:2].T
        return picture

    def depth(self, points: Array) -> Array:
        """How far towards the viewer points (…, 3) are, (…), in m."""
        depths: Array = points @ self.frame[2]
        return depths
