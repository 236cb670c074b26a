"""Expressions along a periodic orbit: their values at its start, the least and the largest one."""

from collections.abc import Iterator
from heapq import heapify, heappop, heappush
from itertools import count
from math import inf, nextafter
from typing import TYPE_CHECKING

import sympy as sp

from lagrotor.proved.balls import Ball, Balls, arb, arb_poly
from lagrotor.proved.crossings import Watch
from lagrotor.proved.fields import Field, values_at
from lagrotor.proved.stepping import scaled, taylor, with_rest
from lagrotor.proved.tails import Evaluation, Tailed

if TYPE_CHECKING:
    from lagrotor.proved.closed_orbits import OrbitProof

_NARROW = 2.0**-60  # of an extreme value, relative
_MOST = 3_000  # pieces


def value_at_start(proof: "OrbitProof", made: Field, expression: sp.Expr) -> Ball:
    """An expression of the states, enclosed at t = 0."""
    return values_at(made.function([expression]), [*proof.states()[: len(made.states)], *_fixed(made)])[0]


def extremes(proof: "OrbitProof", made: Field, expression: sp.Expr) -> tuple[Ball, Ball]:
    """The least and the largest value of an expression over the whole orbit, images under its reversals included."""
    pieces = [*_along(proof, made, expression)]
    return -_largest([Watch(-piece.series) for piece in pieces]), _largest(pieces)


def _fixed(made: Field) -> Balls:
    return [made.values[s] for s in made.arguments[len(made.states) :]]


def _along(proof: "OrbitProof", made: Field, expression: sp.Expr) -> Iterator[Watch]:
    """The expression along each step, and along the step's images under the reversals A and B, which the orbit passes, too."""
    problem, tape = proof.problem, made.function([expression])
    motion, one = problem.motion, (1,) * problem.motion.moving
    A, B = (signs or one for signs in (problem.first, problem.last))
    images = {one, A, B, tuple(a * b for a, b in zip(A, B, strict=True))}
    w = [arb(0)] * len(proof.start.middle)
    for i, x in zip(problem.free, proof.found, strict=True):
        w[i] = x
    for step in proof.steps:
        box, n = step.node.box(w), step.n
        rows = scaled(taylor(motion, box, n), step.h, n)
        rests, _ = with_rest(motion, rows, box, step.h, n)
        states = [Tailed(arb_poly(row), rest, n) for row, rest in zip(rows, rests, strict=True)]
        fixed = [Tailed(arb_poly([c]), arb(0), n) for c in _fixed(made)]
        for signs in images:
            moved = [x if s > 0 else -x for x, s in zip(states, signs, strict=True)]
            yield Watch(Evaluation(tape, [*moved, *fixed]).outputs[0])


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
