"""Pictures of any run: its coordinates and energy over time, and a film of its bodies."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.rigid_bodies import Body
from lagrotor.mechanics.expressions import vector_of
from lagrotor.mechanics.running.flow import Array
from lagrotor.mechanics.running.motion import SampledMotion

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure

Point = Sequence[sp.Expr]


def plot(run: SampledMotion) -> "RunFigure":
    """A figure of the coordinates, the change of the energy and, under constraints, their violation over time."""
    from lagrotor.drawing.run_figure import coordinates_figure

    labels = {f"${sp.latex(q)}$": run.q[:, i] for i, q in enumerate(run.system.c.q)}
    return coordinates_figure(run.t, labels, run.energy, run.drift)


def animate(run: SampledMotion, path: str | Path, fps: float = 25.0, lines: Sequence[Sequence[Point]] = ()) -> Path:
    """Write the run as a film (.gif or .mp4) of its bodies, or of `lines`: each a sequence of points (x, y, z) in q and t.

    Raises InputError when the system has no bodies and no lines are given, or for a name or rate that will not do.
    """
    from lagrotor.drawing.film import check_film, frame_times
    from lagrotor.drawing.skeleton import animate_lines

    check_film(Path(path), float(run.t[-1] - run.t[0]), fps)
    frames = run.at(frame_times(run.t[0], run.t[-1], fps))
    if lines:
        points = [[vector_of("animate: a point of lines", e, 3) for e in _sequence(line)] for line in _sequence(lines)]
        drawn = [np.stack([_vectors(frames, point) for point in line], 1) for line in points]
    else:
        drawn = [carried for body in run.system.bodies for carried in _outline(frames, body)]
    if not drawn:
        raise InputError(
            "animate: the Lagrangian was given without bodies, so there is nothing to draw: give lines=[[(0, 0, 0), "
            "(x, y, z)], …] with positions in the coordinates, or build L from Frame(c).body(…)"
        )
    return animate_lines(path, frames.t, drawn, fps)


def _sequence(given: Sequence[Any]) -> Sequence[Any]:
    if not isinstance(given, Sequence) or not given:
        raise InputError(
            f"animate: {given!r} in lines is no line: lines=[[(0, 0, 0), (x, y, z)], …], each of points (x, y, z)"
        )
    return given


def _outline(frames: SampledMotion, body: Body) -> list[Array]:
    """The body's lines carried along, each (m, p, 3)."""
    origin = _vectors(frames, body.frame.place())
    rows = [_vectors(frames, body.frame.place(e) - body.frame.place()) for e in np.eye(3, dtype=int).tolist()]
    lines = [np.stack([_vectors(frames, point)[0] for point in line]) for line in body.outline]
    return [origin[:, None] + line @ np.stack(rows, 1) for line in lines]


def _vectors(frames: SampledMotion, point: Point) -> Array:
    """A point (x, y, z) of expressions along the run, (m, 3)."""
    return np.stack([frames.evaluate(e) for e in point], -1)
