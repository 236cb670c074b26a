"""The equations of `exact_motion` written out, one component at a time, for numbers of any kind: what is compiled.

Of few rotors they are the right-hand side, too: so few operations cost less in single numbers than calling arrays does.
"""

from collections.abc import Callable, Sequence
from math import comb
from typing import Any

import numpy as np

from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.generated import function_of
from lagrotor.numerics.printers import rhs_text
from lagrotor.numerics.recorded_numbers import Recorded
from lagrotor.numerics.segment import RightHandSide
from lagrotor.structures.coefficients import Coefficients
from lagrotor.structures.exact.exact_motion import Drive, ExactMotion
from lagrotor.structures.exact.levels import eliminate_in_levels

_Vector = list[Any]
_TERMS = 17  # of the series of the arc sine, which leave 4e-14 where an axis hangs down, 1e-16 below 2 rad
# Axes and bars beyond which arrays cost less: with massless bars, where each axis is eliminated by itself, and with heavy ones.
_MOST, HEAVY = 40, 15


def structure_accelerations(
    c: Coefficients,
    r: Sequence[_Vector],
    v: Sequence[_Vector],
    G: Sequence[Any],
    by: Any,
    add: Callable[[_Vector], Any] = sum,
    more: Sequence[_Vector] = (),
) -> list[_Vector]:
    """r'' of axes r and rates v, N lists of three each, with axial momenta G (N).

    by: a module with sqrt for their kind of number; add: sums a list of them; more: what else acts on the axes, N m.
    What a structure has not (hinges, friction, heavy bars) costs nothing.
    """
    x = eliminate_in_levels(*system(c, r, v, G, by, more), add).solve({}, add)
    return [x[3 * i : 3 * i + 3] for i in range(len(c.R))]


def system(
    c: Coefficients, r: Sequence[_Vector], v: Sequence[_Vector], G: Sequence[Any], by: Any, more: Sequence[_Vector] = ()
) -> tuple[list[Any], dict[tuple[int, int], Any], list[Any], int]:
    """The linear system for [r'' (3 N), multipliers of the axes (N) and of the bars (B)]: diagonal, {(i, j): entry off it},
    right side, and 3 N, the number of unknowns with a mass. Arguments as of `structure_accelerations`.
    """
    N, B = len(c.R), len(c.i)
    forces = _forces(c, r, v, G, by)
    if more:
        forces = [[x + y for x, y in zip(F, other, strict=True)] for F, other in zip(forces, more, strict=True)]
    right = [x for F in forces for x in F] + [-_dot(w, w) for w in v]
    diagonal = [c.A[k // 3] for k in range(3 * N)] + [0.0] * (N + B)
    off: dict[tuple[int, int], Any] = {(3 * i + k, 3 * N + i): r[i][k] for i in range(N) for k in range(3)}
    for b, (i, j) in enumerate(zip(c.i.tolist(), c.j.tolist(), strict=True)):
        d, swing = _apart(c, r, i, j), [c.R[j] * y - c.R[i] * x for x, y in zip(v[i], v[j], strict=True)]
        for k in range(3):
            off[3 * i + k, 4 * N + b], off[3 * j + k, 4 * N + b] = -c.R[i] * d[k], c.R[j] * d[k]
            if c.coupling[b]:
                off[3 * i + k, 3 * j + k] = c.coupling[b]
        right.append(-_dot(swing, swing))
    return diagonal, off, right, 3 * N


def _forces(c: Coefficients, r: Sequence[_Vector], v: Sequence[_Vector], G: Sequence[Any], by: Any) -> list[_Vector]:
    """What acts on the axes besides the constraints, N m."""
    forces = []
    for i, ((x, y, z), (p, q, w)) in enumerate(zip(r, v, strict=True)):
        F = [G[i] * (y * w - z * q), G[i] * (z * p - x * w), G[i] * (x * q - y * p)]
        if c.friction[i]:
            F = [f - c.friction[i] * speed for f, speed in zip(F, v[i], strict=True)]
        if c.gravity:
            F[2] = F[2] - c.gravity * c.S[i]
        if c.hinge[i]:
            F[2] = F[2] + c.hinge[i] * _angle_by_sine(z, by)
        forces.append(F)
    for k in range(len(c.stiffness)):
        _brace(c, k, forces, r, v, by)
    return forces


def _brace(c: Coefficients, k: int, F: list[_Vector], r: Sequence[_Vector], v: Sequence[_Vector], by: Any) -> None:
    i, j = int(c.brace_tip[k]), int(c.brace_to[k])
    if j >= 0:
        d, swing = _apart(c, r, j, i), [c.R[i] * x - c.R[j] * y for x, y in zip(v[i], v[j], strict=True)]
    else:
        d = [c.feet[i, m] + c.R[i] * r[i][m] - c.brace_point[k, m] for m in range(3)]
        swing = [c.R[i] * x for x in v[i]]
    length = by.sqrt(_dot(d, d))
    pull = c.stiffness[k] * (length - c.brace_length[k]) / length
    if c.damping[k]:
        pull = pull + c.damping[k] * _dot(d, swing) / (length * length)
    for m in range(3):
        F[i][m] = F[i][m] - c.R[i] * (pull * d[m])
        if j >= 0:
            F[j][m] = F[j][m] + c.R[j] * (pull * d[m])


def _angle_by_sine(z: Any, by: Any) -> Any:
    """theta / sin(theta) from z = cos(theta), regular where the axis is upright.

    theta = 8 b, and b / sin(b) is the arc sine's series in sin(b)²; sin(8 b) = 8 sin(b) cos(b) cos(2 b) cos(4 b).
    """
    half = by.sqrt((1.0 + z) / 2.0)
    quarter = by.sqrt((1.0 + half) / 2.0)
    eighth = by.sqrt((1.0 + quarter) / 2.0)
    square, series = (1.0 - quarter) / 2.0, 0.0
    for n in reversed(range(_TERMS)):
        series = series * square + comb(2 * n, n) / 4**n / (2 * n + 1)
    return series / (half * quarter * eighth)


def _apart(c: Coefficients, r: Sequence[_Vector], i: int, j: int) -> _Vector:
    """From tip i to tip j, m."""
    return [c.feet[j, m] - c.feet[i, m] + (c.R[j] * r[j][m] - c.R[i] * r[i][m]) for m in range(3)]


def _dot(one: _Vector, other: _Vector) -> Any:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def right_hand_side(motion: ExactMotion) -> RightHandSide:
    """The right-hand side (s, y) → y' of an exact motion, that of `motion.rhs`: for few rotors in single numbers."""
    c = motion.c
    if len(c.R) + len(c.i) > (HEAVY if c.coupling.any() else _MOST):
        return motion.rhs

    def numbers(drive: Drive | None) -> Callable[[float], list[float]]:
        return lambda t: np.asarray(drive(t) if drive else (), dtype=float).ravel().tolist()

    make = function_of(_source(c, motion.force is not None, motion.ground is not None))
    rhs: RightHandSide = make(numbers(motion.force), numbers(motion.ground))
    return rhs


def _source(c: Coefficients, forced: bool, shaken: bool) -> str:
    """Source of (force, ground) → rhs(s, y); forced, shaken: whether there is a force on the tips, a motion of the ground."""
    N, rate, tape = len(c.R), c.rate, list[Recorded]()
    states, pushes, shakes = ([f"{x}{k}" for k in range(n)] for x, n in (("y", 6 * N), ("p", 3 * N), ("g", 3)))
    y, p, g = ([Recorded(tape, name) for name in names] for names in (states, pushes, shakes))
    r = [y[3 * i : 3 * i + 3] for i in range(N)]
    v = [[rate * x for x in y[3 * i : 3 * i + 3]] for i in range(N, 2 * N)]
    G = [Recorded(tape, f"({G}*exp({-k / rate}*s))") if k else G for G, k in zip(c.G, c.decay, strict=True)]
    more = [
        [(c.R[i] * p[3 * i + k] if forced else 0.0) - (c.S[i] * g[k] if shaken else 0.0) for k in range(3)]
        for i in range(N)
    ]
    by_axis = structure_accelerations(c, r, v, G, recorded_numbers, more=more if forced or shaken else ())
    lines, rates = recorded_numbers.lines((x / rate**2 for axis in by_axis for x in axis), tape)
    body = [f"{', '.join(states)} = y.tolist()"]
    body += [f"{', '.join(pushes)} = force(s/{rate})"] if forced else []
    body += [f"{', '.join(shakes)} = ground(s/{rate})"] if shaken else []
    body += [*lines, f"return [{', '.join([*states[3 * N :], *rates])}]"]
    return rhs_text(body, [], ["force", "ground"], 6 * N)
