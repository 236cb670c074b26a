"""The equations of `exact_motion` in single numbers of any kind: what is compiled.

Of few rotors they are the right-hand side, too: so few operations cost less in single numbers than calling arrays does.

Their linear system is solved in levels. Of the unknowns with the fewest neighbours, as many as are not neighbours of each other
go at once: in a chain every other one, and then every other one of what is left (cyclic reduction: Golub & Van Loan, § 4.5.4),
so that the operations grow as N and the longest row of operations that wait for each other as log N. A constraint waits for what
it holds: before, its pivot is zero; after, it is not, as the masses are positive and the constraints independent.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.generated import function_of
from lagrotor.numerics.printers import rhs_text
from lagrotor.numerics.recorded_numbers import Recorded
from lagrotor.numerics.segment import RightHandSide
from lagrotor.structures.coefficients import Coefficients
from lagrotor.structures.exact.exact_motion import Drive, ExactMotion
from lagrotor.structures.exact.forces import forces, pulls, right_side

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


# Axes and bars beyond which arrays cost less: with massless bars, where each axis is eliminated by itself, and with heavy ones.
_MOST, HEAVY = 40, 15


def structure_accelerations(
    c: Coefficients, r: Any, v: Any, G: Any, by: Any, add: Callable[[Terms], Any] = sum, more: Any = 0.0
) -> list[Any]:
    """r'' (3 N) of axes r and rates v, (N, 3), with axial momenta G (N).

    by: a module with sqrt for their kind of number; add: sums a list of them; more: what else acts on the axes, N m.
    What a structure has not (hinges, friction, heavy bars) costs nothing.
    """
    return eliminate_in_levels(*system(c, r, v, G, by, more), add).solve({}, add)[: 3 * len(c.R)]


def system(
    c: Coefficients, r: Any, v: Any, G: Any, by: Any, more: Any = 0.0
) -> tuple[list[Any], dict[tuple[int, int], Any], list[Any], int]:
    """The linear system for [r'' (3 N), multipliers of the axes (N) and of the bars (B)]: diagonal, {(i, j): entry off it},
    right side, and 3 N, the number of unknowns with a mass. Arguments as of `structure_accelerations`.
    """
    N, (r, v, G) = len(c.R), (np.array(each, dtype=object) for each in (r, v, G))
    right = right_side(c, forces(c, r, v, G, np.frompyfunc(by.sqrt, 1, 1)) + more, v).tolist()
    diagonal = [*np.repeat(c.A, 3).tolist(), *[0.0] * (N + len(c.i))]
    off: dict[tuple[int, int], Any] = {(3 * i + k, 3 * N + i): r[i, k] for i in range(N) for k in range(3)}
    first, second = pulls(c, r)
    for b, (i, j, coupling) in enumerate(zip(c.i.tolist(), c.j.tolist(), c.coupling.tolist(), strict=True)):
        for k in range(3):
            off[3 * i + k, 4 * N + b], off[3 * j + k, 4 * N + b] = first[b, k], second[b, k]
            if coupling:
                off[3 * i + k, 3 * j + k] = coupling
    return diagonal, off, right, 3 * N


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
    y, p, g = (np.array([Recorded(tape, name) for name in names]) for names in (states, pushes, shakes))
    r, v = y.reshape(2, N, 3)
    G = [Recorded(tape, f"({G}*exp({-k / rate}*s))") if k else G for G, k in zip(c.G, c.decay, strict=True)]
    more = c.R[:, None] * p.reshape(N, 3) * forced - c.S[:, None] * g * shaken
    accelerations = structure_accelerations(c, r, rate * v, G, recorded_numbers, more=more)
    lines, rates = recorded_numbers.lines((x / rate**2 for x in accelerations), tape)
    body = [f"{', '.join(states)} = y.tolist()"]
    body += [f"{', '.join(pushes)} = force(s/{rate})"] if forced else []
    body += [f"{', '.join(shakes)} = ground(s/{rate})"] if shaken else []
    body += [*lines, f"return [{', '.join([*states[3 * N :], *rates])}]"]
    return rhs_text(body, [], ["force", "ground"], 6 * N)
