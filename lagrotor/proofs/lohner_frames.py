"""Sets propagated along a motion in Lohner frames, which avoid the wrapping effect.

A node contains every x(t) that starts in x_0 + w:

    m + Q s + V w,   V in C + Q S.

m, Q, C are exact, s and S are balls. m + Q s encloses the motion of the middle x_0. V is the derivative with respect to w over
the whole set; by the mean-value theorem the node contains the motions. A step maps m to y and has the derivative D over the
set:

    m₁ + Q₁ s₁ ∋ y + D Q s,   C₁ + Q₁ S₁ ∋ D (C + Q S).

Q₁ is nearly orthogonal, and its inverse is enclosed. Lohner 1992; Zgliczyński, C¹-Lohner algorithm, 2002.
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
from lagrotor.proofs.taylor_step import SLACK, Motion, bound_remainder, scale_terms, step_derivative, taylor
from lagrotor.proofs.truncated_series import RemainderError

SHORTEST = 1e-5  # of the whole time: a shorter step means that the set is too wide, and the proof fails
MOST_STEPS = 5_000
_SHORTER, _LONGER = 0.7, 1.2
_WIDER, _WIDER_BY_ALL = 2**-9, 2**-28  # parts of a ball's size and of the largest ball's, added to its radius
_WIDE = 1e-7  # half-width of a box above which a second evaluation of its Taylor terms pays
_LARGEST_REMAINDER = 1e3  # over tol, since a bound exceeds the error
_SLOPE_TERMS = 0.85  # part of the terms for derivatives, which multiply a small spread


@dataclass(frozen=True)
class Node:
    """The set of the points m + Q s + (C + Q S) w at time t, for all w in the initial spread; t, m, Q, C are exact."""

    t: Ball
    m: Balls
    Q: Matrix
    s: Balls
    C: Matrix
    S: Matrix

    @property
    def middle(self) -> Balls:
        """The enclosure of the motion that starts in the middle of the initial set, at time t."""
        return (self.Q * column(self.s) + column(self.m)).entries()

    @property
    def derivative(self) -> Matrix:
        """The derivative of the state with respect to the initial state, enclosed over the whole initial set."""
        return self.C + self.Q * self.S

    def box(self, w: Balls) -> Balls:
        """Return a box that contains every motion from x_0 + w."""
        return [a + b for a, b in zip(self.middle, times(self.derivative, w), strict=True)]

    def data(self) -> dict[str, Any]:
        s, S = balls_data(self.s), [balls_data(row) for row in self.S.tolist()]
        return {"m": exact_data(self.m), "Q": matrix_data(self.Q), "s": s, "C": matrix_data(self.C), "S": S}


@dataclass(frozen=True)
class LohnerStep:
    """A step of length h from `node` to `end`, with n Taylor terms, and `slope_terms` terms of the derivative."""

    node: Node
    h: Ball
    n: int
    slope_terms: int
    end: Node

    def data(self) -> dict[str, Any]:
        return {"h": ball_data(self.h), "terms": self.n, "slope_terms": self.slope_terms, "node": self.end.data()}


@dataclass(frozen=True)
class Start:
    """The initial set x_0 + w: `middle` x_0, exact or with rounding errors, and `spread` w."""

    middle: Balls
    spread: Balls

    @property
    def node(self) -> Node:
        """The set at time 0."""
        size = len(self.middle)
        m = [exact(x) for x in self.middle]
        remainder = [x - y for x, y in zip(self.middle, m, strict=True)]
        return Node(arb(0), m, identity(size), remainder, identity(size), arb_mat(size, size))


@dataclass(frozen=True)
class Accuracy:
    """The tolerance of a step, its local error relative to the size of the state.

    It sets the number of terms and the precision.
    """

    tol: float

    @property
    def terms(self) -> int:
        return max(8, ceil(-1.15 * log10(self.tol)) + 4)

    @property
    def slope_terms(self) -> int:
        return max(8, ceil(_SLOPE_TERMS * self.terms))

    @property
    def bits(self) -> int:
        return ceil(-log10(self.tol) * 3.33) + 40


def step_of(
    motion: Motion, node: Node, w: Balls, h: Ball, accuracy: Accuracy, rows: Sequence[Balls] | None = None
) -> LohnerStep:
    """Return the step of length h. Raises RemainderError if no bound of its remainder is known, or if the bound is
    far above the tolerance.

    A pulse that begins within the step does not appear in the Taylor terms at its start, but the remainder bound includes it.
    """
    n, slope_terms = accuracy.terms, accuracy.slope_terms
    rows = taylor(motion, node.m, n) if rows is None else rows
    bounds, _ = bound_remainder(motion, at := scale_terms(rows, h, n), node.m, h, n)
    if not max_of(bounds) < _LARGEST_REMAINDER * accuracy.tol * size_of(rows):
        raise RemainderError("the remainder of the Taylor series is too large over the step")
    least = max_of(bounds) * arb(2) ** -16  # the checker's bounds of small components are larger
    image = [
        sum(row, arb(0)) + arb(0, (SLACK * bound + least).abs_upper()) for row, bound in zip(at, bounds, strict=True)
    ] + node.m[motion.moving :]
    D = derivative_over(motion, node.m, node.box(w), at, h, slope_terms)
    return LohnerStep(node, h, n, slope_terms, next_node(node, h, image, D, frame(D * node.Q, node)))


def derivative_over(motion: Motion, m: Balls, box: Balls, at: list[Balls], h: Ball, n: int) -> Matrix:
    """Enclose the derivative of the step over a box about m; `at` are the scaled Taylor terms of the motion from m.

    For a wide box, the mean-value theorem gives narrower Taylor terms from `at` and the derivatives of the terms.
    """
    wide = scale_terms(taylor(motion, box, n), h, n)
    shift = [x - y for x, y in zip(box, m, strict=True)]
    _, evaluation = bound_remainder(motion, wide, box, h, n)
    D, slopes = step_derivative(motion, evaluation, h, n)
    if max_of(shift) > _WIDE:
        shifts = [times(slope, shift) for slope in slopes]
        for i, (row, exactly) in enumerate(zip(wide, at, strict=True)):
            wide[i] = [narrower(c, a + shifts[k][i]) for k, (c, a) in enumerate(zip(row, exactly, strict=False))]
        _, evaluation = bound_remainder(motion, wide, box, h, n)
        D, _ = step_derivative(motion, evaluation, h, n)
        D = widen_radii(D)
    return D


def widen_radii(D: Matrix) -> Matrix:
    """Return a matrix with each radius enlarged by a quarter, since the checker's order of operations gives other radii.

    If all radii are as small as the remainder bounds, they are doubled and an eighth of the largest is added: the checker's
    bounds differ more.
    """
    radii = [radius(x) for x in D.entries()]
    largest = max_of(radii)
    share, least = (arb(0.25), arb(0)) if largest > _WIDE else (arb(1), largest / 8)
    wide = [x + arb(0, (share * r + least).upper()) for x, r in zip(D.entries(), radii, strict=True)]
    return arb_mat(D.nrows(), D.ncols(), wide)


def narrower(x: Ball, y: Ball) -> Ball:
    """Return the narrower of two balls that contain the same number."""
    return x if x.rad() < y.rad() else y


def frame(image: Matrix, node: Node) -> Matrix:
    """Return an exact, nearly orthogonal matrix; its columns follow the directions of the image's columns, the longest first."""
    size = image.nrows()
    columns = np.array([[float(x.mid()) for x in row] for row in image.tolist()])
    spread = [max(float(upper(x)) for x in (node.s[j], *(node.S[j, k] for k in range(size)))) for j in range(size)]
    lengths = np.linalg.norm(columns, axis=0)
    order = np.argsort(-lengths * (np.array(spread) + 1e-300), kind="stable")
    unit = columns[:, order] / np.where(lengths[order] > 0, lengths[order], 1.0)
    Q = np.linalg.qr(unit)[0]
    if not np.isfinite(Q).all():
        raise RemainderError("the frame is not finite")
    return arb_mat(size, size, Q.ravel().tolist())


def next_node(node: Node, h: Ball, image: Balls, D: Matrix, Q: Matrix) -> Node:
    """Return the node at the end of a step, in the frame Q."""
    m = [exact(x) for x in image]
    remainder = column([x - y for x, y in zip(image, m, strict=True)])
    inverse = Q.inv()
    rotation = inverse * (D * node.Q)
    s = (rotation * column(node.s) + inverse * remainder).entries()
    C = middle_of(D * node.C)
    wider = widen_radii(D)
    S = inverse * (wider * node.Q) * node.S + inverse * (wider * node.C - C)
    return Node(node.t + h, m, Q, widen(s), C, arb_mat(C.nrows(), C.ncols(), widen(S.entries())))


def widen(values: Balls) -> Balls:
    """Widen each ball in proportion to its size and to the largest one, so that the checker's balls lie within the results."""
    least = max_of(values) * _WIDER_BY_ALL
    return [x if x.is_zero() else x + arb(0, (abs(x) * _WIDER + least).upper()) for x in values]


def steps_of(motion: Motion, start: Start, t: Ball, accuracy: Accuracy) -> Iterator[LohnerStep]:
    """Yield the steps from the initial set to the time t. Raises NotProved if no step is short enough."""
    node, w = start.node, start.spread
    limit = longest = float(exact(t))
    for _ in range(MOST_STEPS):
        duration = t - node.t
        try:
            rows = taylor(motion, node.m, accuracy.terms)
        except RemainderError as reason:
            raise NotProved(f"the enclosure ends at t = {float(node.t):.6g}: {reason}") from None
        h = min(step_length(rows, accuracy.tol), limit * _LONGER)
        while True:
            last = not (duration > h * 1.0001)
            try:
                step = step_of(motion, node, w, duration if last else arb(h), accuracy, rows)
                break
            except (RemainderError, ZeroDivisionError, ValueError) as error:
                why = error if isinstance(error, RemainderError) else "the set is too wide for its frame"
                h = min(h, float(duration)) * _SHORTER
                if h < SHORTEST * longest:
                    place = f"the enclosure ends at t = {float(node.t):.6g}"
                    raise NotProved(f"{place}: {why}; shorten the time, or narrow the start") from None
        yield step
        if last:
            return
        node, limit = step.end, h
    raise NotProved(f"the enclosure ends at t = {float(node.t):.6g} after {MOST_STEPS} steps; shorten the time")


def step_length(rows: list[Balls], tol: float) -> float:
    """Return the step length, rounded to a few bits, at which the last Taylor terms are tol times the size of the state."""
    n, size = len(rows[0]), size_of(rows)
    length = 1e6
    for k in (n - 2, n - 1):
        largest = max(abs(float(exact(row[k]))) for row in rows)
        if largest > 0:
            length = min(length, (tol * size / largest) ** (1 / k))
    mantissa, exponent = np.frexp(length)
    return float(np.ldexp(np.floor(mantissa * 64) / 64, exponent))


def size_of(rows: Sequence[Balls]) -> float:
    return max(1.0, *(abs(float(row[0])) for row in rows))


def flow_data(about: Any, motion: Motion, start: Start, steps: Sequence[LohnerStep], bits: int) -> Certificate:
    """Return the certificate of a motion as data: its subject, start and steps. Each theorem adds its own entries."""
    initial = {"middle": balls_data(start.middle), "spread": balls_data(start.spread)}
    data = {"version": VERSION, "bits": bits, "about": about, "motion": motion.data(), "start": initial}
    return data | {"steps": [step.data() for step in steps]}
