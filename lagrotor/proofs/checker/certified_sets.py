"""The sets of a certificate: each is verified to contain the image of the previous one, by the checker's own Taylor terms."""

import re
from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, arb_mat, ctx, fmpz

from lagrotor.errors import NotProved
from lagrotor.proofs.checker.bounded_series import Dual, Series, below_one, evaluate, total
from lagrotor.proofs.checker.tapes import ZERO, demand, is_place, motion_terms, read_tape

Ball = Any
_EXACT = re.compile(r"-?[0-9a-f]+p-?\d+", re.ASCII)
MOST_BITS = 100_000  # in a number
MOST_TERMS = 10_000  # in a series
_WIDE = 2.0**-24  # half-width of a box above which its Taylor terms are computed twice


def number(text: str) -> Ball:
    """Read an exact number from text: mantissa in base 16, p, exponent of two. For example, 3p-1 is 3/2."""
    demand(_EXACT.fullmatch(text) is not None, f"{text[:60]!r} is not an exact number")
    mantissa, _, power = text.partition("p")
    demand(abs(int(power)) <= MOST_BITS and len(mantissa) <= MOST_BITS, "a number has too many digits")
    outer, ctx.prec = ctx.prec, max(ctx.prec, 4 * len(mantissa) + 8)
    value = arb(fmpz(int(mantissa, 16))) * arb(2) ** int(power)
    ctx.prec = outer
    return value


def read_ball(data: Any) -> Ball:
    middle, wide = (number(text) for text in data)
    demand(wide >= 0, "a radius is negative")
    return middle + arb(0, wide.upper())


def balls(data: Any) -> list[Ball]:
    return [read_ball(x) for x in data]


def matrix(data: Any, entry: Callable[[Any], Ball] = number) -> Any:
    return arb_mat([[entry(x) for x in row] for row in data])


def column(values: Sequence[Ball]) -> Any:
    return arb_mat(len(values), 1, list(values))


def unit(size: int) -> Any:
    return arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


def middle_inverse(D: Any) -> Any:
    """Return an exact matrix near the inverse of the midpoint of a matrix ball."""
    X = arb_mat(D.nrows(), D.ncols(), [x.mid() for x in D.entries()]).inv()
    return arb_mat(D.nrows(), D.ncols(), [x.mid() for x in X.entries()])


def krawczyk(miss: Any, slope: Any, A: Any, w: Sequence[Ball]) -> list[Ball]:
    """Return the Krawczyk image (1 − A D) w − A F with D = `slope` and F = `miss`.

    The image must lie in the interior of the box w; then F has exactly one zero in the box.
    """
    K = ((unit(len(w)) - A * slope) * column(w) - A * miss).entries()
    for x, box in zip(K, w, strict=True):
        demand(box.contains_interior(x), "Krawczyk's test does not close")
    return list(K)


class Flow:
    """The motion x' = f(x) of a certificate: its tape, parameters and number of states."""

    def __init__(self, data: Any) -> None:
        self.tape = read_tape(data)
        self.parameters = balls(data["parameters"])
        self.moving = len(data["outputs"])
        self.size = len(data["arguments"]) - len(self.parameters)
        demand(0 < self.moving <= self.size, "the motion has no states")

    def arguments(self, rows: list[Series], still: Sequence[Ball], by: list[list[Series]] | None, n: int) -> list[Dual]:
        """Return the series of all arguments; if `by` has the derivatives of the states, each series has derivatives."""
        flat = [Series([c], ZERO, n) for c in (*still, *self.parameters)]
        if by is None:
            return [Dual(x) for x in (*rows, *flat)]
        places = range(self.size)
        unit_rows = [[Series([arb(int(i == j))], ZERO, n) for j in places] for i in places[self.moving :]]
        duals = [Dual(x, row) for x, row in zip(rows, by, strict=True)]
        duals += [Dual(x, row) for x, row in zip(flat, unit_rows, strict=False)]
        return duals + [Dual(x) for x in flat[len(still) :]]

    def step(self, start: list[Ball], h: Ball, n: int, coefficients: list[list[Ball]] | None = None) -> list[Series]:
        """Return the series of the states over a step from the balls `start`; `coefficients` replace the computed terms."""
        still = start[self.moving :]
        terms = coefficients or motion_terms(self.tape, start[: self.moving], [*still, *self.parameters], h, n)
        bounds = [ZERO] * len(terms)
        for _ in range(9):
            rows = [Series(row, bound, n) for row, bound in zip(terms, bounds, strict=True)]
            rates = evaluate(self.tape, self.arguments(rows, still, None, n))
            new = [remainder_bound(rate.value, h, n) for rate in rates]
            if within(new, bounds):
                return [Series(row, bound, n) for row, bound in zip(terms, new, strict=True)]
            least = max(new, key=lambda x: float(x.upper())) / 2**16
            bounds = [arb((2 * x + least).upper()) for x in new]
        raise NotProved("check: the remainder of the Taylor series is not bounded over a step")

    def slopes(self, rows: list[Series], still: Sequence[Ball], h: Ball, n: int) -> tuple[list[Any], Ball]:
        """Return the terms of the derivative D of a step, with D' = h J D and D(0) = 1, and a remainder bound of each entry."""
        size, n_rows = self.size, self.moving
        by = [[Series([arb(int(i == j))], ZERO, n) for j in range(size)] for i in range(n_rows)]
        zero = [Series([], ZERO, n)] * size
        gradients = [rate.by or zero for rate in evaluate(self.tape, self.arguments(rows, still, by, n))]
        gradients += [zero] * (size - n_rows)
        J = [arb_mat([[h * term(x, k) for x in row] for row in gradients]) for k in range(n)]
        bound = widest([total([h * x.remainder for x in row]) for row in gradients])
        D = [unit(size)]
        for k in range(1, n):
            D.append(sum((J[i] * D[k - 1 - i] for i in range(1, k)), J[0] * D[k - 1]) * (arb(1) / k))
        a, b = ([widest([total(row) for row in X.tolist()]) for X in matrices] for matrices in (J, D))
        over = sum((x * y for i, x in enumerate(a) for j, y in enumerate(b) if i + j >= n - 1), ZERO)
        error = (over / n + bound * sum(b, ZERO) / (n + 1)) / below_one((sum(a, ZERO) + bound) / (n + 1))
        demand(error.is_finite(), "the derivative's series does not converge over a step")
        return D, arb(error.upper())

    def derivative(self, box: list[Ball], m: list[Ball], image: list[Series], h: Ball, n: int) -> Any:
        """Enclose the derivative of the step over a box about m. Over a wide box, the mean-value theorem gives narrower terms."""
        still = box[self.moving :]
        rows = self.step(box, h, n)
        D, error = self.slopes(rows, still, h, n)
        shift = [x - y for x, y in zip(box, m, strict=True)]
        if any(abs(x).upper() > _WIDE for x in shift):
            shifts = [(X * column(shift)).entries() for X in D]
            coefficients = []
            for i, (row, exactly) in enumerate(zip(rows, image, strict=True)):
                coefficients.append([narrower(term(row, k), term(exactly, k) + shifts[k][i]) for k in range(n)])
            D, error = self.slopes(self.step(box, h, n, coefficients), still, h, n)
        wide = [arb(0, error) if i < self.moving else ZERO for i in range(self.size) for _ in range(self.size)]
        return sum(D[1:], D[0]) + arb_mat(self.size, self.size, wide)


def narrower(x: Ball, y: Ball) -> Ball:
    return min(x, y, key=lambda ball: float(ball.rad()))


def widest(values: Sequence[Ball]) -> Ball:
    return arb(max(values, key=lambda x: float(x.upper())).upper())


def term(a: Series, k: int) -> Ball:
    return a.terms[k] if k < len(a.terms) else ZERO


def remainder_bound(rate: Series, h: Ball, n: int) -> Ball:
    """Return a bound of h times the integral of the terms of a rate from s^(n−1) on."""
    return arb((abs(h) * (abs(term(rate, n - 1)) / n + rate.remainder / (n + 1))).upper())


def within(new: Sequence[Ball], old: Sequence[Ball]) -> bool:
    """Return True if each new bound is at most as large as the old one."""
    return all(x <= y for x, y in zip(new, old, strict=True))


def end_of(a: Series) -> Ball:
    """Return the value of a series at the end of the step, s = 1."""
    return sum(a.terms, ZERO) + arb(0, a.remainder.upper())


def read_node(data: Any) -> tuple[Any, ...]:
    m, s = [number(x) for x in data["m"]], column(balls(data["s"]))
    return m, matrix(data["Q"]), s, matrix(data["C"]), matrix(data["S"], read_ball)


class VerifiedSteps:
    """The sets of a certificate, each verified to contain the image of the previous one."""

    def __init__(self, certificate: Any) -> None:
        self.flow = Flow(certificate["motion"])
        start, size = certificate["start"], self.flow.size
        self.middle, self.w = balls(start["middle"]), balls(start["spread"])
        fits = len(self.middle) == len(self.w) == size and len(certificate["steps"]) > 0
        demand(fits, "the start does not fit the motion")
        demand(all(x.contains(0) for x in self.w), "the start's box does not contain its middle")
        m = [x.mid() for x in self.middle]
        s = column([x - y for x, y in zip(self.middle, m, strict=True)])
        node = (m, unit(size), s, unit(size), arb_mat(size, size))
        self.time = ZERO
        self.boxes: list[tuple[list[Ball], Ball, int]] = []  # box, length and terms of each step
        for k, step in enumerate(certificate["steps"]):
            node = self._step(node, step, k)
        m, Q, s, C, S = node
        self.derivative = C + Q * S
        self.point = (column(m) + Q * s).entries()
        self.box = box_of(node, self.w)

    def _step(self, node: Any, data: Any, k: int) -> Any:
        m, Q, s, C, S = node
        h, n, few = read_ball(data["h"]), data["terms"], data["slope_terms"]
        fits = h > 0 and all(is_place(x, MOST_TERMS) and x > 2 for x in (n, few))
        demand(fits, f"step {k} has no length or no terms")
        moving = self.flow.moving
        image = self.flow.step(m, h, n)
        box = box_of(node, self.w)
        D = self.flow.derivative(box, m, image, h, few)
        end = read_node(data["node"])
        m1, Q1, s1, C1, S1 = end
        inverse = Q1.inv()
        rotation = inverse * (D * Q)
        y = [*map(end_of, image), *m[moving:]]
        point = rotation * s + inverse * (column(y) - column(m1))
        slope = rotation * S + inverse * (D * C - C1)
        demand(all(x.contains(0) for x in s1.entries()), f"node {k + 1} does not contain its middle")
        demand(s1.contains(point), f"node {k + 1} does not contain the motion of the middle")
        demand(S1.contains(slope), f"node {k + 1} does not contain the derivative")
        self.boxes.append((box, h, n))
        self.time += h
        return end


def box_of(node: Any, w: Sequence[Ball]) -> list[Ball]:
    """Return the box m + Q s + (C + Q S) w, which contains the set of a node."""
    m, Q, s, C, S = node
    return (column(m) + Q * s + (C + Q * S) * column(w)).entries()
