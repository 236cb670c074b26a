"""Elimination in levels: a symmetric sparse system solved on numbers of any kind, floats or expressions to be compiled.

Of the unknowns with the fewest neighbours, as many as are not neighbours of each other go at once. In a chain that is
every other one, and then every other one of what is left (cyclic reduction: Golub & Van Loan, § 4.5.4), so that the operations
grow as N and the longest row of operations that wait for each other as log N.

A constraint waits for what it holds: before, its pivot is zero; after, it is not, as the masses are positive and the
constraints independent.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

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
            _couple(rows, list(row), shares, row)
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


def _couple(rows: list[dict[int, Terms]], ends: list[int], shares: Mapping[int, Any], row: Mapping[int, Any]) -> None:
    """What an eliminated unknown leaves between each two of its neighbours."""
    for k, i in enumerate(ends):
        for j in ends[k + 1 :]:
            left = -(shares[i] * row[j])
            if j in rows[i]:
                rows[i][j].append(left)
            else:
                rows[i][j] = rows[j][i] = [left]
