"""The wheels of section 3.4 of the paper, drawn as wireframes, and the camera that projects them onto the picture."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from lagrotor.drawing.style import OKABE_ITO
from lagrotor.errors import InputError
from lagrotor.numerics.rotations import Array

RADIUS = 0.36  # of a wheel per length of its axis: wheels on a bar of that length do not touch; independent of inertia

INK, BAR, GROUND, MARK = "#222222", "#777777", "#aaaaaa", OKABE_ITO["bluish green"]
ROTORS = ("#332288", "#a0568a")  # indigo and purple as on the page, used for rotors only


def wheel(radius: float, axle: float, n: int, arcs: int = 1) -> tuple[Array, NDArray[np.intp]]:
    """Return the wireframe of a wheel about e_z: its points, and its segments as pairs of indices of points.

    The points have the shape (n arcs + 2, 3) in m, the segments (n arcs + 2 n + 1, 2). The n joints on the rim are at radius
    (cos 2πk/n, sin 2πk/n, 0). Two spokes join each joint to the ends (0, 0, ∓axle/2) of the axle, the last two points. The
    segments are the rim, with `arcs` chords between neighbouring joints (1 in the paper), the spokes and the axle. Raises
    InputError unless the lengths are positive, n is at least 3 and arcs at least 1.
    """
    if not (radius > 0 and axle > 0 and n >= 3 and arcs >= 1):
        raise InputError(
            f"wheel: radius = {radius:g} m, axle = {axle:g} m must be positive, n = {n} at least 3, arcs at least 1"
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
    """Return the points of a body in space, Xn = X Rᵀ + X_cm as in the paper's listing, shape (…, p, 3) in m.

    points: X, shape (p, 3) in m. rotation: R, shape (…, 3, 3). centre: X_cm, shape (…, 3) in m.
    """
    placed: Array = points @ np.swapaxes(rotation, -1, -2) + centre[..., None, :]
    return placed


@dataclass(frozen=True)
class Camera:
    """A parallel projection from a distant viewpoint.

    Attributes
    ----------
    azimuth : float
        Direction of the viewpoint, from e_x towards e_y, in degrees.
    elevation : float
        Height of the viewpoint above the horizon, in degrees.
    """

    azimuth: float = -72.0
    elevation: float = 16.0

    @property
    def frame(self) -> Array:
        """The unit vectors right, up and towards the viewer as rows, shape (3, 3)."""
        a, e = radians(self.azimuth), radians(self.elevation)
        right, towards = np.array([-sin(a), cos(a), 0]), np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)])
        return np.array([right, np.cross(towards, right), towards])

    def __call__(self, points: Array) -> Array:
        """Return the projections of points, shape (…, 3), onto the picture, shape (…, 2), in m."""
        picture: Array = points @ self.frame[:2].T
        return picture

    def depth(self, points: Array) -> Array:
        """Return how far points, shape (…, 3), are in front of the origin, towards the viewer; shape (…) in m."""
        depths: Array = points @ self.frame[2]
        return depths
