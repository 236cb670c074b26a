"""The least and the largest value of an expression along an orbit, by branch and bound."""

from collections.abc import Iterable, Sequence
from heapq import heapify, heappop, heappush
from itertools import count
from math import inf, nextafter

import sympy as sp

from lagrotor.proved.balls import Ball, Balls, arb, arb_poly
from lagrotor.proved.carried_sets import CarriedStep
from lagrotor.proved.crossings import Watch
from lagrotor.proved.fields import Field
from lagrotor.proved.stepping import Motion, scaled, taylor, with_rest
from lagrotor.proved.tails import Evaluation, Tailed

Signs = tuple[int, ...]
_NARROW = 2.0**-60  # of an extreme value, relative
_MOST = 3_000  # pieces


def extremes(
    made: Field, motion: Motion, steps: Sequence[CarriedStep], w: Balls, images: Iterable[Signs], expression: sp.Expr
) -> tuple[Ball, Ball]:
    """The least and the largest value of an expression along steps from the starts w, and along their images under signs."""
    tape, pieces = made.function([expression]), list[Watch]()
    for step in steps:
        box, n = step.node.box(w), step.n
        rows = scaled(taylor(motion, box, n), step.h, n)
        rests, _ = with_rest(motion, rows, box, step.h, n)
        states = [Tailed(arb_poly(row), rest, n) for row, rest in zip(rows, rests, strict=True)]
        fixed = [Tailed(arb_poly([made.values[s]]), arb(0), n) for s in made.arguments[len(states) :]]
        for signs in images:
            moved = [x if s > 0 else -x for x, s in zip(states, signs, strict=True)]
            pieces.append(Watch(Evaluation(tape, [*moved, *fixed]).outputs[0]))
    return -_largest([Watch(-piece.series) for piece in pieces]), _largest(pieces)


def _largest(pieces: list[Watch]) -> Ball:
    """The largest value, by branch and bound over 0 ≤ s ≤ 1 of each piece."""
    order = count()

    def entry(piece: Watch, low: Ball, high: Ball) -> tuple[float, int, Watch, Ball, Ball]:
        return -nextafter(float(piece.over(low, high).upper()), inf), next(order), piece, low, high

    heap = [entry(piece, arb(0), arb(1)) for piece in pieces]
    heapify(heap)
    seen = pieces[0].over(arb(0), arb(0))
    for _ in range(_MOST):
        bound, _, piece, low, high = heap[0]
        middle = (low + high) / 2
        for s in (low, middle, high):
            seen = seen.max(piece.over(s, s))
        if -bound - float(seen.lower()) <= _NARROW * abs(bound) + 4 * float(seen.rad()):
            break
        heappop(heap)
        for part in ((low, middle), (middle, high)):
            heappush(heap, entry(piece, *part))
    return seen.union(arb(-heap[0][0]))
