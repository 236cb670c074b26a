"""Sets carried along a motion without wrapping: Lohner's frames.

A node holds every x(t) that starts in x_0 + w as

    m + Q s + V w,   V in C + Q S,

m, Q, C exact, s and S balls: m + Q s encloses the motion of the start's middle x_0, V the derivative by w over the whole
set, so that the mean-value theorem gives the rest. A step with image y of m and derivative D of the set gives

    m₁ + Q₁ s₁ ∋ y + D Q s,   C₁ + Q₁ S₁ ∋ D (C + Q S),

where Q₁ is orthogonal nearly and its inverse is enclosed. Lohner 1992; Zgliczyński, C¹-Lohner algorithm, 2002.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, log10
from typing import Any

import numpy as np

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import (
    Ball,
    Balls,
    Matrix,
    arb,
    arb_mat,
    ball_data,
    balls_data,
    exact,
    exact_data,
    matrix_data,
    max_of,
    radius,
    upper,
)
from lagrotor.proofs.matrices import column, identity, middle_of, times
from lagrotor.proofs.statements import VERSION, Certificate
from lagrotor.proofs.taylor_step import SLACK, Motion, derivative_of_step, scaled, taylor, with_rest
from lagrotor.proofs.truncated_series import TailError

SHORTEST = 1e-5  # of the whole time: a step below it ends the proof, as it means that the set has grown too wide
MOST = 5_000  # steps
_SHORTER, _LONGER = 0.7, 1.2
_WIDER, _WIDER_BY_ALL = 2**-9, 2**-28  # of a set's size and of the largest one's, added at each node
_WIDE = 1e-7  # of a box, from which on its Taylor terms are worth the second evaluation
_REST = 1e3  # over tol: what a step leaves out may be, with all that its bound adds
_SLOPE_TERMS = 0.85  # of the series' terms, for derivatives: they multiply what is small already


@dataclass(frozen=True)
class Node:
    """The set at one time: m + Q s + (C + Q S) w; t, m, Q, C exact."""

    t: Ball
    m: Balls
    Q: Matrix
    s: Balls
    C: Matrix
    S: Matrix

    @property
    def middle(self) -> Balls:
        """Where the motion of the start's middle is."""
        return (self.Q * column(self.s) + column(self.m)).entries()

    @property
    def derivative(self) -> Matrix:
        """The derivative by the start, over the whole set."""
        return self.C + self.Q * self.S

    def box(self, w: Balls) -> Balls:
        """Where every motion is that starts in x_0 + w."""
        return [a + b for a, b in zip(self.middle, times(self.derivative, w), strict=True)]

    def data(self) -> dict[str, Any]:
        """Return the set as plain data."""
        return {
            "m": exact_data(self.m),
            "Q": matrix_data(self.Q),
            "s": balls_data(self.s),
            "C": matrix_data(self.C),
            "S": [balls_data(row) for row in self.S.tolist()],
        }


@dataclass(frozen=True)
class CarriedStep:
    """From `node` over the time h by n Taylor terms, of which the derivative takes `slope_terms`, to `end`."""

    node: Node
    h: Ball
    n: int
    slope_terms: int
    end: Node

    def data(self) -> dict[str, Any]:
        """Return the step with the set at its end as plain data."""
        return {
            "h": ball_data(self.h),
            "terms": self.n,
            "slope_terms": self.slope_terms,
            "node": self.end.data(),
        }


@dataclass(frozen=True)
class Start:
    """Every x_0 + w: middle x_0, of which rounding may leave a ball; spread w."""

    middle: Balls
    spread: Balls

    @property
    def node(self) -> Node:
        """The set at the time 0."""
        size = len(self.middle)
        m = [exact(x) for x in self.middle]
        off = [x - y for x, y in zip(self.middle, m, strict=True)]
        return Node(arb(0), m, identity(size), off, identity(size), arb_mat(size, size))


@dataclass(frozen=True)
class Accuracy:
    """tol: what one step may leave out, relative to the state's size; it sets the series' length and Arb's precision."""

    tol: float

    @property
    def terms(self) -> int:
        """Of the Taylor series."""
        return max(8, ceil(-1.15 * log10(self.tol)) + 4)

    @property
    def slope_terms(self) -> int:
        """Of the derivative's series."""
        return max(8, ceil(_SLOPE_TERMS * self.terms))

    @property
    def bits(self) -> int:
        """Arb's precision."""
        return ceil(-log10(self.tol) * 3.33) + 40


def step_of(
    motion: Motion, node: Node, w: Balls, h: Ball, accuracy: Accuracy, rows: Sequence[Balls] | None = None
) -> CarriedStep:
    """The step of length h. Raises TailError where its rest is not bounded, or far above what may be left out.

    A pulse that begins within the step is in no Taylor term at its start, but in the rest.
    """
    n, slope_terms = accuracy.terms, accuracy.slope_terms
    rows = taylor(motion, node.m, n) if rows is None else rows
    rests, _ = with_rest(motion, at := scaled(rows, h, n), node.m, h, n)
    if not max_of(rests) < _REST * accuracy.tol * size_of(rows):
        raise TailError("the rest of the Taylor series is large over the step")
    least = max_of(rests) * arb(2) ** -16  # another program's bounds of small components are not as small
    image = [
        sum(row, arb(0)) + arb(0, (SLACK * rest + least).abs_upper()) for row, rest in zip(at, rests, strict=True)
    ] + node.m[motion.moving :]
    D = derivative_over(motion, node.m, node.box(w), at, h, slope_terms)
    return CarriedStep(node, h, n, slope_terms, carried(node, h, image, D, frame(D * node.Q, node)))


def derivative_over(motion: Motion, m: Balls, box: Balls, at: list[Balls], h: Ball, n: int) -> Matrix:
    """The derivative of the step over a box around m, of which `at` are the scaled Taylor terms.

    Over a wide box the terms are taken a second time by the mean-value theorem, from those of m and their derivatives.
    """
    wide = scaled(taylor(motion, box, n), h, n)
    off = [x - y for x, y in zip(box, m, strict=True)]
    _, evaluation = with_rest(motion, wide, box, h, n)
    D, slopes = derivative_of_step(motion, evaluation, h, n)
    if max_of(off) > _WIDE:
        moved = [times(slope, off) for slope in slopes]
        wide = [
            [narrower(c, a + moved[k][i]) for k, (c, a) in enumerate(zip(row, exactly, strict=False))]
            for i, (row, exactly) in enumerate(zip(wide, at, strict=True))
        ]
        _, evaluation = with_rest(motion, wide, box, h, n)
        D, _ = derivative_of_step(motion, evaluation, h, n)
        D = by_other_orders(D)
    return D


def by_other_orders(D: Matrix) -> Matrix:
    """A matrix with a quarter more of each radius: another program's order of operations gives other widths. Where they are what
    the series leave out, whose bounds are others, twice each and an eighth of the largest."""
    radii = [radius(x) for x in D.entries()]
    most = max_of(radii)
    more, least = (arb(0.25), arb(0)) if most > _WIDE else (arb(1), most / 8)
    wide = [x + arb(0, (more * r + least).upper()) for x, r in zip(D.entries(), radii, strict=True)]
    return arb_mat(D.nrows(), D.ncols(), wide)


def narrower(x: Ball, y: Ball) -> Ball:
    """The narrower of two balls that hold the same number."""
    return x if x.rad() < y.rad() else y


def frame(image: Matrix, node: Node) -> Matrix:
    """An orthogonal matrix nearly: the directions of the image's columns, the widest first. Exact as it stands."""
    size = image.nrows()
    columns = np.array([[float(x.mid()) for x in row] for row in image.tolist()])
    spread = [max(float(upper(x)) for x in (node.s[j], *(node.S[j, k] for k in range(size)))) for j in range(size)]
    lengths = np.linalg.norm(columns, axis=0)
    order = np.argsort(-lengths * (np.array(spread) + 1e-300), kind="stable")
    unit = columns[:, order] / np.where(lengths[order] > 0, lengths[order], 1.0)
    Q = np.linalg.qr(unit)[0]
    if not np.isfinite(Q).all():
        raise TailError("the frame is not finite")
    return arb_mat(size, size, Q.ravel().tolist())


def carried(node: Node, h: Ball, image: Balls, D: Matrix, Q: Matrix) -> Node:
    """The node at the end of a step, in the frame Q."""
    m = [exact(x) for x in image]
    off = column([x - y for x, y in zip(image, m, strict=True)])
    back = Q.inv()
    turned = back * (D * node.Q)
    s = (turned * column(node.s) + back * off).entries()
    C = middle_of(D * node.C)
    wider = by_other_orders(D)
    S = back * (wider * node.Q) * node.S + back * (wider * node.C - C)
    return Node(node.t + h, m, Q, widened(s), C, arb_mat(C.nrows(), C.ncols(), widened(S.entries())))


def widened(values: Balls) -> Balls:
    """Balls a little wider than what is needed, by their own size and the largest, so that another program's stay within."""
    least = max_of(values) * _WIDER_BY_ALL
    return [x if x.is_zero() else x + arb(0, (abs(x) * _WIDER + least).upper()) for x in values]


def steps_of(motion: Motion, start: Start, t: Ball, accuracy: Accuracy) -> Iterator[CarriedStep]:
    """Steps from the start to the time t, as long as their rests allow; within `precision`.

    Raises NotProved where no step is short enough.
    """
    node, w = start.node, start.spread
    limit = longest = float(exact(t))
    for _ in range(MOST):
        left = t - node.t
        try:
            rows = taylor(motion, node.m, accuracy.terms)
        except TailError as reason:
            raise NotProved(f"the enclosure ends at t = {float(node.t):.6g}: {reason}") from None
        h = min(step_length(rows, accuracy.tol), limit * _LONGER)
        while True:
            last = not (left > h * 1.0001)
            try:
                made = step_of(motion, node, w, left if last else arb(h), accuracy, rows)
                break
            except (TailError, ZeroDivisionError, ValueError) as error:
                why = error if isinstance(error, TailError) else "the set is too wide for its frame"
                h = min(h, float(left)) * _SHORTER
                if h < SHORTEST * longest:
                    raise NotProved(
                        f"the enclosure ends at t = {float(node.t):.6g}: {why}; shorten the time, or narrow the start"
                    ) from None
        yield made
        if last:
            return
        node, limit = made.end, h
    raise NotProved(f"the enclosure ends at t = {float(node.t):.6g} after {MOST} steps; shorten the time")


def step_length(rows: list[Balls], tol: float) -> float:
    """The step at which the last Taylor terms are tol of the state's size, to a few bits."""
    n, size = len(rows[0]), size_of(rows)
    found = 1e6
    for k in (n - 2, n - 1):
        most = max(abs(float(exact(row[k]))) for row in rows)
        if most > 0:
            found = min(found, (tol * size / most) ** (1 / k))
    mantissa, exponent = np.frexp(found)
    return float(np.ldexp(np.floor(mantissa * 64) / 64, exponent))


def size_of(rows: Sequence[Balls]) -> float:
    """Of the state, at least 1."""
    return max(1.0, *(abs(float(row[0])) for row in rows))


def flow_data(about: Any, motion: Motion, start: Start, steps: Sequence[CarriedStep], bits: int) -> Certificate:
    """Return the entries that all certificates of a motion share."""
    return {
        "version": VERSION,
        "bits": bits,
        "about": about,
        "motion": motion.data(),
        "start": {"middle": balls_data(start.middle), "spread": balls_data(start.spread)},
        "steps": [step.data() for step in steps],
    }
