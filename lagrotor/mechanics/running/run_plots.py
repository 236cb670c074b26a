"""Pictures of a run: its coordinates and energy over time, and films and views of its bodies."""

from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp

from lagrotor.algebra.scalar import sympified
from lagrotor.errors import InputError, near
from lagrotor.mechanics.bodies.rigid_bodies import Body
from lagrotor.mechanics.expressions import vector_of
from lagrotor.mechanics.glossary import latex, letter_latex
from lagrotor.mechanics.running.flow import Array
from lagrotor.mechanics.running.motion import SampledMotion
from lagrotor.mechanics.units import units_of
from lagrotor.numerics.run import check_nonempty

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure
    from lagrotor.drawing.view import View

Point = Sequence[sp.Expr]
_WIDE = 18  # characters of a name beside a panel in one line
_NOTHING = (
    "{}: the Lagrangian was given without bodies, so there is nothing to draw: give lines=[[(0, 0, 0), (x, y, z)], …] with "
    "positions in the coordinates, or build L from Frame(c).body(…)"
)


def plot(run: SampledMotion, *quantities: Any) -> "RunFigure":
    from lagrotor.drawing.run_figure import coordinates_figure, curves_figure

    check_nonempty("plot", run.t)
    if not quantities:
        columns = zip((*run.system.c.q, *dict(run.system.states)), (*run.q.T, *run.x.T), strict=True)
        labels = {_label(run, s): values for s, values in columns}
        return coordinates_figure(run.t, labels, run.energy, run.drift) if run.q.size else curves_figure(run.t, labels)
    curves = (_curve(run, quantity) for quantity in quantities)
    return curves_figure(run.t, {label.replace(r"\&", "&"): values for label, values in curves})  # matplotlib's escape


def _label(run: SampledMotion, letter: sp.Symbol) -> str:
    unit = units_of(run.system).get(letter)
    return f"${letter_latex(letter)}$" + (f" ({unit})" if unit else "")


def _curve(run: SampledMotion, what: Any) -> tuple[str, Array]:
    """Return the label of a quantity, with formulas in TeX, and its values along the run, shape (n,)."""
    c, name = run.system.c, str(what)
    letters = (*c.q, *c.v, *run.system.variables[len(c.q) :])
    moving = dict(zip(map(str, letters), (*run.q.T, *run.v.T, *run.u.T, *run.x.T), strict=True))
    if name in moving:
        letter = next(s for s in letters if str(s) == name)
        return _label(run, letter), moving[name]
    if name in ("E", "energy"):
        return "$E$ (J)", run.energy
    if isinstance(what, str) and name in run.system.names:
        return fill(name, _WIDE).replace("$", r"\$"), run.reactions[name]
    if isinstance(what, str):
        names = [*moving, "E", *run.system.names]
        raise InputError(
            f"plot: {name!r} is none of {', '.join(names)}{near(name, names)}: name one, or give an expression"
        )
    if isinstance(what, sp.Equality):
        return f"${latex(what.lhs)}$", run.evaluate(what.rhs)
    expression = sympified(what, "plot")
    rounded = {number: sp.Float(number, 3) for number in expression.atoms(sp.Float)}
    return f"${latex(expression.xreplace(rounded))}$", run.evaluate(what)


def view(run: SampledMotion, lines: Sequence[Sequence[Point]] = ()) -> "View":
    """Return a three-dimensional view of the bodies with their frames, and of the given lines."""
    from lagrotor.drawing.view import view_lines, view_times
    from lagrotor.drawing.wheel import ROTORS

    check_nonempty("view", run.t)
    frames = run.at(view_times(run.t[0], run.t[-1]))
    drawn = _drawn("view", frames, lines)
    outlines = [(ROTORS[i % len(ROTORS)], _outline(frames, body)) for i, body in enumerate(run.system.bodies)]
    inks = [*(ink for ink, carried in outlines for _ in carried), *(ROTORS[i % len(ROTORS)] for i in range(len(drawn)))]
    moving = [*(line for _, carried in outlines for line in carried), *drawn]
    if not moving:
        raise InputError(_NOTHING.format("view"))
    # Only the first line of a body, from the frame to the centre, traces its path: paths of the rim would hide it.
    firsts = np.cumsum([0, *(len(carried) for _, carried in outlines)])[:-1].tolist()
    traced = [*firsts, *range(len(moving) - len(drawn), len(moving))]
    return view_lines(frames.t, moving, inks, f"motion of {', '.join(map(str, run.system.c.q))}", traced)


def animate(run: SampledMotion, path: str | Path, fps: float = 25.0, lines: Sequence[Sequence[Point]] = ()) -> Path:
    """Write a film of the given lines, or of the bodies if no lines are given."""
    from lagrotor.drawing.film import animate_lines, check_film, frame_times

    check_nonempty("animate", run.t)
    check_film(path, float(run.t[-1] - run.t[0]), fps)
    frames = run.at(frame_times(run.t[0], run.t[-1], fps))
    drawn = _drawn("animate", frames, lines) or [line for body in run.system.bodies for line in _outline(frames, body)]
    if not drawn:
        raise InputError(_NOTHING.format("animate"))
    return animate_lines(path, frames.t, drawn, fps)


def _drawn(where: str, frames: SampledMotion, lines: Sequence[Sequence[Point]]) -> list[Array]:
    """Evaluate the points of the lines along the run. Each line with p points gives an array (m, p, 3) for m times."""
    for item in (*([lines] if lines else ()), *lines):
        if not isinstance(item, Sequence) or not item:
            raise InputError(
                f"{where}: {item!r} in lines is no line: lines=[[(0, 0, 0), (x, y, z)], …], each of points (x, y, z)"
            )
    points = [[vector_of(f"{where}: a point of lines", e, 3) for e in line] for line in lines]
    return [np.stack([_vectors(frames, point) for point in line], 1) for line in points]


def _outline(frames: SampledMotion, body: Body) -> list[Array]:
    """Evaluate the outline of a body along the run. Each line with p points gives an array (m, p, 3) for m times."""
    origin = _vectors(frames, body.frame.place())
    axes = [_vectors(frames, body.frame.place(e) - body.frame.place()) for e in np.eye(3, dtype=int).tolist()]
    lines = [np.stack([_vectors(frames, point)[0] for point in line]) for line in body.outline]
    return [origin[:, None] + line @ np.stack(axes, 1) for line in lines]


def _vectors(frames: SampledMotion, point: Point) -> Array:
    """Evaluate a point (x, y, z) of expressions along the run, shape (m, 3)."""
    return np.stack([frames.evaluate(e) for e in point], -1)
