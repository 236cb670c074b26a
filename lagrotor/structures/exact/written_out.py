"""The equations of `exact_motion` written out, one component at a time, for numbers of any kind: what is compiled.

Of few rotors they are the right-hand side, too: so few operations cost less in single numbers than calling arrays does.

Their linear system is solved in levels. Of the unknowns with the fewest neighbours, as many as are not neighbours of each other
go at once: in a chain every other one, and then every other one of what is left (cyclic reduction: Golub & Van Loan, § 4.5.4),
so that the operations grow as N and the longest row of operations that wait for each other as log N. A constraint waits for what
it holds: before, its pivot is zero; after, it is not, as the masses are positive and the constraints independent.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
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

Terms = list[Any]


@dataclass(frozen=True)
class Elimination:
    """What is left of a symmetric system after an elimination, and how its unknowns follow from those that were kept.

    done: (unknown, 1/pivot, right side, {neighbour: share}) in the order of elimination; rows: i → {j: terms}.
    """

    done: list[tuple[int, Any, Any, dict[int, Any]]]
    pivots: list[Terms]
    rows: list[dict[int, Terms]]
    right: list[Terms]

    def solve(self, known: Mapping[int, Any], add: Callable[[Terms], Any] = sum) -> list[Any]:
        """All unknowns from those that were kept."""
        x: list[Any] = [known.get(i) for i in range(len(self.rows))]
        for i, inverse, own, shares in reversed(self.done):
            x[i] = add([own * inverse, *(-(share * x[j]) for j, share in shares.items())])
        return x


def eliminate_in_levels(
    diagonal: Sequence[Any],
    off: Mapping[tuple[int, int], Any],
    right: Sequence[Any],
    masses: int,
    add: Callable[[Terms], Any] = sum,
    kept: Iterable[int] = (),
) -> Elimination:
    """Eliminate all unknowns of a symmetric system but those kept. off: {(i, j): entry}, each pair once; masses: how many
    unknowns come first that have a diagonal of their own; those after them are constraints, whose diagonal is zero.
    add: sums some terms.
    """
    n = len(diagonal)
    pivots, b = [[entry] for entry in diagonal], [[entry] for entry in right]
    rows: list[dict[int, Terms]] = [{} for _ in range(n)]
    for (i, j), entry in off.items():
        rows[i][j] = rows[j][i] = [entry]
    holds = [{j for j in row if j < masses} if i >= masses else set[int]() for i, row in enumerate(rows)]
    left, done = set(range(n)).difference(kept), list[tuple[int, Any, Any, dict[int, Any]]]()
    while left:
        for i in _level(left, rows, holds):
            inverse, own = 1.0 / add(pivots[i]), add(b[i])
            row = {j: add(terms) for j, terms in rows[i].items()}
            shares = {j: entry * inverse for j, entry in row.items()}
            for j, entry in row.items():
                pivots[j].append(-(shares[j] * entry))
                b[j].append(-(shares[j] * own))
                del rows[j][i]
            for one, other in combinations(row, 2):
                between = -(shares[one] * row[other])
                if other in rows[one]:
                    rows[one][other].append(between)
                else:
                    rows[one][other] = rows[other][one] = [between]
            done.append((i, inverse, own, shares))
            left.discard(i)
    return Elimination(done, pivots, rows, b)


def _level(left: set[int], rows: list[dict[int, Terms]], holds: list[set[int]]) -> list[int]:
    """Unknowns that can go at once: few neighbours, none of them among each other, no constraint before what it holds.

    At most two more than twice the least number of neighbours: a heavy chain, too, is halved by a few levels.
    """
    ready = [i for i in left if not holds[i] & left]
    most = 2 * min(len(rows[i]) for i in ready) + 2
    chosen, beside = list[int](), set[int]()
    for i in sorted((i for i in ready if len(rows[i]) <= most), key=lambda i: (len(rows[i]), i)):
        if i not in beside:
            chosen.append(i)
            beside.update(rows[i])
    return chosen


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
    if c.brace_along[k].any():  # in guides
        along = c.brace_along[k].tolist()
        pull = c.stiffness[k] * (_dot(along, d) - c.brace_length[k])
        if c.damping[k]:
            pull = pull + c.damping[k] * _dot(along, swing)
        d = along
    else:
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
