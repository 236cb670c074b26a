"""`check`: a small second program that verifies a certificate. It shares no arithmetic of series with the search.

It looks for no step, frame, order or orbit: all are in the certificate. At each node the set is carried through the step by
this program's own Taylor terms, found by recurrences, and must lie within the certificate's next set. The derivative of the
rates is found by dual numbers, forward.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

from flint import arb, arb_mat, arb_poly, ctx, fmpz

from lagrotor.errors import InputError, NotProved
from lagrotor.proved.family_checking import FamilyFlow
from lagrotor.proved.near_rest_checking import FlowNearRest
from lagrotor.proved.recurrences import ZERO, demand, motion_terms, rational_of, slopes_of, terms_of
from lagrotor.proved.statements import theorem_of

Ball = Any
_MORE_BITS = 64
_WIDE = 2.0**-24  # of a box, from which on its terms are taken twice
_POINTS = (
    "0.137",
    "-0.219",
    "0.083",
    "0.311",
    "-0.171",
    "0.059",
    "0.263",
    "-0.097",
    "0.149",
    "-0.043",
    "0.201",
    "0.117",
)


class Rest:
    """A power series on 0 ≤ s ≤ 1: n terms, and a bound of the sum of the absolute values of all further ones, which is no
    number where the series may not converge."""

    def __init__(self, terms: list[Ball], rest: Ball, n: int) -> None:
        self.terms, self.rest, self.n = terms[:n], rest, n

    @cached_property
    def total(self) -> Ball:
        """The sum of the terms' absolute values, rounded up."""
        return total(self.terms)

    def size(self) -> Ball:
        """Bound of the sum of all absolute values."""
        return self.total + self.rest

    def __add__(self, other: "Rest") -> "Rest":
        return Rest(longer(self.terms, other.terms, 1), self.rest + other.rest, self.n)

    def __sub__(self, other: "Rest") -> "Rest":
        return Rest(longer(self.terms, other.terms, -1), self.rest + other.rest, self.n)

    def __mul__(self, other: "Rest") -> "Rest":
        product = (arb_poly(self.terms) * arb_poly(other.terms)).coeffs()
        rest = total(product[self.n :])
        if not other.rest.is_zero():
            rest += self.size() * other.rest
        if not self.rest.is_zero():
            rest += other.total * self.rest
        return Rest(product, rest, self.n)

    def at_start(self) -> Ball:
        """The value at s = 0."""
        return self.terms[0] if self.terms else ZERO


def total(terms: Sequence[Ball]) -> Ball:
    """The sum of the absolute values, rounded up."""
    return arb(sum(map(abs, terms), ZERO).upper())


def longer(a: list[Ball], b: list[Ball], sign: int) -> list[Ball]:
    """a ± b, term by term."""
    width = max(len(a), len(b))
    first, second = a + [ZERO] * (width - len(a)), b + [ZERO] * (width - len(b))
    return [x + y if sign > 0 else x - y for x, y in zip(first, second, strict=True)]


def high(a: list[Ball], b: list[Ball], n: int) -> Ball:
    """What the product of two polynomials has from s^n on."""
    return total((arb_poly(a) * arb_poly(b)).coeffs()[n:])


def below_one(x: Ball) -> Ball:
    """1 − x where that is positive; else no number, with which nothing compares."""
    return 1 - x if x < 1 else arb("nan")


def inverse(a: Rest) -> Rest:
    """1/a = q/(1 − r), r = 1 − a q."""
    demand(a.at_start() > 0 or a.at_start() < 0, "a denominator is not shown to be other than zero")
    q, _ = terms_of("divide", a.terms, a.n)
    size = total(q)
    r = high(a.terms, q, a.n) + size * a.rest
    return Rest(q, size * r / below_one(r), a.n)


def root(a: Rest) -> Rest:
    """q + e with e = (a − q² − e²)/(2 q): |e| ≤ k d/(1 + √(1 − k² d)), k = |1/q|, d = |a − q²|."""
    demand(a.at_start() > 0, "a root's argument is not shown to be positive")
    q, _ = terms_of("sqrt", a.terms, a.n)
    k = inverse(Rest(q, ZERO, a.n)).size()
    d = high(q, q, a.n) + a.rest
    return Rest(q, k * d / (1 + below_one(k * k * d).sqrt()), a.n)


def logarithm(a: Rest) -> Rest:
    """log a_0 + ∫ a'/a."""
    demand(a.at_start() > 0, "a logarithm's argument is not shown to be positive")
    return integral_of(a, inverse(a), a.at_start().log())


def exponential(a: Rest) -> Rest:
    """q + e with e' = a' e + (a' q − q'); never more than the whole, exp(a_0 + |a − a_0|)."""
    (q, _), rate = terms_of("exp", a.terms, a.n), slopes_of(a.terms)
    whole = (a.at_start() + total(a.terms[1:]) + a.rest).exp()
    if not total(rate) / (a.n + 1) < 1:
        return Rest(q, arb(whole.upper()), a.n)
    e = high(rate, q, a.n - 1) / a.n / below_one(total(rate) / (a.n + 1))
    return Rest(q, arb(whole.upper()).min(e + (total(q) + e) * (a.rest.exp() - 1)), a.n)


def turning(a: Rest) -> tuple[Rest, Rest]:
    """sin(a) and cos(a): the errors of both solve a linear equation with the coefficient a'."""
    rate, pair = slopes_of(a.terms), terms_of("sin", a.terms, a.n)
    e = sum((high(rate, q, a.n - 1) for q in pair), ZERO) / a.n / below_one(total(rate) / (a.n + 1))
    rest = e + (sum(map(total, pair), ZERO) + 2 * e) * (a.rest.exp() - 1)
    return Rest(pair[0], rest, a.n), Rest(pair[1], rest, a.n)


def integral_of(a: Rest, slope: Rest, value: Ball) -> Rest:
    """g(a) from g' (a): g(a_0) + ∫ a' g'(a) ds, and the rest of a times g'."""
    rate = slopes_of(a.terms)
    product = (arb_poly(rate) * arb_poly(slope.terms)).coeffs()
    terms = [value, *(x / (k + 1) for k, x in enumerate(product[: a.n - 1]))]
    left = total(product[a.n - 1 :]) + total(rate) * slope.rest
    return Rest(terms, left / a.n + a.rest * slope.size(), a.n)


class Dual:
    """A series and its derivatives by the start's coordinates; none where it does not depend on them."""

    def __init__(self, value: Rest, by: list[Rest] | None = None) -> None:
        self.value, self.by = value, by

    def linear(self, factor: Rest, other: "Dual | None" = None, second: Rest | None = None) -> list[Rest] | None:
        """factor · self' + second · other'."""
        first = None if self.by is None else [factor * x for x in self.by]
        if other is None or other.by is None or second is None:
            return first
        moved = [second * x for x in other.by]
        return moved if first is None else [x + y for x, y in zip(first, moved, strict=True)]


def evaluated(tape: Any, arguments: list[Dual], n: int) -> list[Dual]:
    """The tape's outputs."""
    one, minus = Rest([arb(1)], ZERO, n), Rest([arb(-1)], ZERO, n)
    found: list[Dual] = []
    for name, *on in tape["operations"]:
        if name == "argument":
            found.append(arguments[on[0]])
            continue
        if name == "number":
            found.append(Dual(Rest([rational_of(on[0])], ZERO, n)))
            continue
        a = found[on[0]]
        b = found[on[1]] if len(on) > 1 else a
        if name == "add":
            found.append(Dual(a.value + b.value, a.linear(one, b, one)))
        elif name == "subtract":
            found.append(Dual(a.value - b.value, a.linear(one, b, minus)))
        elif name == "multiply":
            found.append(Dual(a.value * b.value, a.linear(b.value, b, a.value)))
        elif name == "divide":
            over = inverse(b.value)
            quotient = a.value * over
            found.append(Dual(quotient, a.linear(over, b, minus * quotient * over)))
        else:
            found.append(function(name, a, one, n))
    return [found[place] for place in tape["outputs"]]


def function(name: str, a: Dual, one: Rest, n: int) -> Dual:
    """A function of one variable with its derivative."""
    x = a.value
    if name == "exp":
        value = slope = exponential(x)
    elif name == "sqrt":
        value = root(x)
        slope = inverse(value + value)
    elif name == "log":
        value, slope = logarithm(x), inverse(x)
    elif name in ("sin", "cos"):
        sine, cosine = turning(x)
        value, slope = (sine, cosine) if name == "sin" else (cosine, Rest([arb(-1)], ZERO, n) * sine)
    elif name == "asin":
        slope = inverse(root(one - x * x))
        value = integral_of(x, slope, x.at_start().asin())
    elif name == "atan":
        slope = inverse(one + x * x)
        value = integral_of(x, slope, x.at_start().atan())
    else:
        raise InputError(f"check: the operation {name!r} is unknown")
    return Dual(value, a.linear(slope))


def number(text: str) -> Ball:
    """An exact number, mantissa in base 16 and power of two."""
    mantissa, _, power = text.partition("p")
    before, ctx.prec = ctx.prec, max(ctx.prec, 4 * len(mantissa) + 8)
    found = arb(fmpz(int(mantissa, 16))) * arb(2) ** int(power)
    ctx.prec = before
    demand(found.is_exact(), f"{text} is not an exact number")
    return found


def read_ball(data: Any) -> Ball:
    """[midpoint, radius]."""
    middle, wide = (number(text) for text in data)
    demand(wide >= 0, "a radius is negative")
    return middle + arb(0, wide.upper())


def balls(data: Any) -> list[Ball]:
    """A list of balls."""
    return [read_ball(x) for x in data]


def matrix(data: Any, entry: Callable[[Any], Ball] = number) -> Any:
    """A matrix."""
    return arb_mat([[entry(x) for x in row] for row in data])


def column(values: Sequence[Ball]) -> Any:
    """A column."""
    return arb_mat(len(values), 1, list(values))


def unit(size: int) -> Any:
    """The unit matrix."""
    return arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


class Flow:
    """x' = f(x) of a certificate: what moves, what stands still."""

    def __init__(self, data: Any) -> None:
        self.tape = data
        self.parameters = balls(data["parameters"])
        self.moving = len(data["outputs"])
        self.size = len(data["arguments"]) - len(self.parameters)
        demand(0 < self.moving <= self.size, "the motion has no states")

    def arguments(self, rows: list[Rest], still: Sequence[Ball], by: list[list[Rest]] | None, n: int) -> list[Dual]:
        """Series of all arguments; with derivatives by the start where `by` has those of what moves."""
        flat = [Rest([c], ZERO, n) for c in (*still, *self.parameters)]
        if by is None:
            return [Dual(x) for x in (*rows, *flat)]
        unit_rows = [
            [Rest([arb(int(i == j))], ZERO, n) for j in range(self.size)] for i in range(self.moving, self.size)
        ]
        found = [Dual(x, row) for x, row in zip(rows, by, strict=True)]
        found += [Dual(x, row) for x, row in zip(flat, unit_rows, strict=False)]
        return found + [Dual(x) for x in flat[len(still) :]]

    def step(self, start: list[Ball], h: Ball, n: int, known: list[list[Ball]] | None = None) -> list[Rest]:
        """Series of what moves over one step, all starts within the balls. known: terms that are known already."""
        still = start[self.moving :]
        terms = known or motion_terms(self.tape, start[: self.moving], [*still, *self.parameters], h, n)
        rests = [ZERO] * len(terms)
        for _ in range(9):
            rates = self._rates([Rest(row, rest, n) for row, rest in zip(terms, rests, strict=True)], still, n)
            new = [left_out(rate, h, n) for rate in rates]
            if within(new, rests):
                return [Rest(row, rest, n) for row, rest in zip(terms, new, strict=True)]
            least = max(new, key=lambda x: float(x.upper())) / 2**16
            rests = [arb((2 * x + least).upper()) for x in new]
        raise NotProved("check: the rest of the Taylor series is not bounded over a step")

    def _rates(self, rows: list[Rest], still: Sequence[Ball], n: int) -> list[Rest]:
        return [rate.value for rate in evaluated(self.tape, self.arguments(rows, still, None, n), n)]

    def slopes(self, rows: list[Rest], still: Sequence[Ball], h: Ball, n: int) -> tuple[list[Any], Ball]:
        """The terms of D, D' = h J D and D(0) = 1, and a bound of the rest of each entry."""
        size, n_rows = self.size, self.moving
        by = [[Rest([arb(int(i == j))], ZERO, n) for j in range(size)] for i in range(n_rows)]
        zero = [Rest([], ZERO, n)] * size
        found = [rate.by or zero for rate in evaluated(self.tape, self.arguments(rows, still, by, n), n)]
        found += [zero] * (size - n_rows)
        J = [arb_mat([[h * term(x, k) for x in row] for row in found]) for k in range(n)]
        rest = widest([total([h * x.rest for x in row]) for row in found])
        D = [unit(size)]
        for k in range(1, n):
            D.append(sum((J[i] * D[k - 1 - i] for i in range(1, k)), J[0] * D[k - 1]) * (arb(1) / k))
        a, b = ([widest([total(row) for row in X.tolist()]) for X in matrices] for matrices in (J, D))
        over = sum((x * y for i, x in enumerate(a) for j, y in enumerate(b) if i + j >= n - 1), ZERO)
        error = (over / n + rest * sum(b, ZERO) / (n + 1)) / below_one((sum(a, ZERO) + rest) / (n + 1))
        demand(error.is_finite(), "the derivative's series does not converge over a step")
        return D, arb(error.upper())

    def derivative(self, box: list[Ball], m: list[Ball], image: list[Rest], h: Ball, n: int) -> Any:
        """That of the step over a box about m. Over a wide box the terms are taken again by the mean-value theorem."""
        still = box[self.moving :]
        rows = self.step(box, h, n)
        D, error = self.slopes(rows, still, h, n)
        off = [x - y for x, y in zip(box, m, strict=True)]
        if any(abs(x).upper() > _WIDE for x in off):
            shifts = [(X * column(off)).entries() for X in D]
            known = [
                [narrower(term(row, k), term(exactly, k) + shifts[k][i]) for k in range(n)]
                for i, (row, exactly) in enumerate(zip(rows, image, strict=True))
            ]
            D, error = self.slopes(self.step(box, h, n, known), still, h, n)
        wide = [arb(0, error) if i < self.moving else ZERO for i in range(self.size) for _ in range(self.size)]
        return sum(D[1:], D[0]) + arb_mat(self.size, self.size, wide)


def narrower(x: Ball, y: Ball) -> Ball:
    """The narrower of two balls that hold the same number."""
    return min(x, y, key=lambda ball: float(ball.rad()))


def widest(values: Sequence[Ball]) -> Ball:
    """The largest of some bounds."""
    return arb(max(values, key=lambda x: float(x.upper())).upper())


def term(a: Rest, k: int) -> Ball:
    """The coefficient of s^k."""
    return a.terms[k] if k < len(a.terms) else ZERO


def left_out(rate: Rest, h: Ball, n: int) -> Ball:
    """h ∫ of what the rate has from s^(n−1) on."""
    return arb((abs(h) * (abs(term(rate, n - 1)) / n + rate.rest / (n + 1))).upper())


def within(new: Sequence[Ball], old: Sequence[Ball]) -> bool:
    """Whether each is at most as large."""
    return all(x <= y for x, y in zip(new, old, strict=True))


def end_of(a: Rest) -> Ball:
    """The value at s = 1."""
    return sum(a.terms, ZERO) + arb(0, a.rest.upper())


def read_node(data: Any) -> tuple[Any, ...]:
    """m, Q, s, C, S."""
    return (
        [number(x) for x in data["m"]],
        matrix(data["Q"]),
        column(balls(data["s"])),
        matrix(data["C"]),
        matrix(data["S"], read_ball),
    )


class Carried:
    """The sets of a certificate, each verified to hold the image of the one before."""

    def __init__(self, certificate: Any) -> None:
        self.flow = Flow(certificate["motion"])
        start, size = certificate["start"], self.flow.size
        self.middle, self.w = balls(start["middle"]), balls(start["spread"])
        demand(len(self.middle) == len(self.w) == size and len(certificate["steps"]) > 0, "the start has other states")
        m = [x.mid() for x in self.middle]
        node = (
            m,
            unit(size),
            column([x - y for x, y in zip(self.middle, m, strict=True)]),
            unit(size),
            arb_mat(size, size),
        )
        self.time = ZERO
        self.boxes: list[tuple[list[Ball], Ball, int]] = []  # of each step: its start over all w, its length, its terms
        for k, step in enumerate(certificate["steps"]):
            node = self._step(node, step, k)
        m, Q, s, C, S = node
        self.derivative = C + Q * S
        self.point = (column(m) + Q * s).entries()
        self.box = box_of(node, self.w)

    def _step(self, node: Any, data: Any, k: int) -> Any:
        m, Q, s, C, S = node
        h, n, few = read_ball(data["h"]), int(data["terms"]), int(data["slope_terms"])
        demand(h > 0 and n > 2 and few > 2, f"step {k} has no length")
        moving = self.flow.moving
        image = self.flow.step(m, h, n)
        box = box_of(node, self.w)
        D = self.flow.derivative(box, m, image, h, few)
        after = read_node(data["node"])
        m1, Q1, s1, C1, S1 = after
        back = Q1.inv()
        turned = back * (D * Q)
        y = [*map(end_of, image), *m[moving:]]
        point = turned * s + back * (column(y) - column(m1))
        slope = turned * S + back * (D * C - C1)
        demand(s1.contains(point), f"node {k + 1} does not hold the motion of the middle")
        demand(S1.contains(slope), f"node {k + 1} does not hold the derivative")
        self.boxes.append((box, h, n))
        self.time += h
        return after


def box_of(node: Any, w: Sequence[Ball]) -> list[Ball]:
    """m + Q s + (C + Q S) w."""
    m, Q, s, C, S = node
    return (column(m) + Q * s + (C + Q * S) * column(w)).entries()


def check(certificate: Any) -> str:
    """Verify a certificate; returns the theorem that it proves, in words composed from what was verified.

    What an expression is called is the certificate's own: what it is, the recorded operations say.

    Raises:
        InputError: for what is no certificate.
        NotProved: with the first thing that does not hold.
    """
    try:
        version, kind = certificate["version"], certificate["kind"]
        rule = _RULES[kind]
    except (KeyError, TypeError, IndexError):
        raise InputError(
            "check: a certificate is the dictionary of `.certificate`, with a known version and kind"
        ) from None
    if version != 1:
        raise InputError(f"check: version {version} of certificates is unknown; this program reads 1")
    before = ctx.prec
    try:
        ctx.prec = int(certificate.get("bits", 64)) + _MORE_BITS
        rule(certificate)
        words = theorem_of(certificate)
    except (KeyError, TypeError, IndexError, ValueError, ZeroDivisionError):
        raise NotProved(
            "check: the certificate cannot be followed: an entry is missing, is no number, or has another shape"
        ) from None
    finally:
        ctx.prec = before
    return words


def check_enclosure(certificate: Any) -> None:
    """The last box lies within the states that are claimed, at the time that is claimed."""
    carried, claim = Carried(certificate), certificate["claim"]
    demand(carried.time.contains(read_ball(claim["t"])), "the steps do not end at the time that is claimed")
    claimed = balls(claim["states"])
    demand(0 < len(claimed) <= len(carried.box), "no states are claimed")
    demand(
        all(y.contains(x) for x, y in zip(carried.box, claimed, strict=False)),
        "the states are not those that are claimed",
    )


def pieces_of(certificate: Any, carried: Carried) -> Any:
    """Of each step: its begin, its length, the expressions' series."""
    at = ZERO
    tape = certificate["expression"]
    for box, h, n in carried.boxes:
        rows = carried.flow.step(box, h, n)
        arguments = carried.flow.arguments(rows, box[carried.flow.moving :], None, n)
        yield at, h, [found.value for found in evaluated(tape, arguments, n)]
        at += h


def sign_over(a: Rest, low: Ball, high: Ball, depth: int = 30) -> int:
    """The sign of a series between two places of a step; 0 where it has none."""
    s = low.union(high)
    middle = s.mid()
    poly = arb_poly(a.terms)
    value = poly(middle) + poly.derivative()(s) * (s - middle) + arb(0, a.rest.upper())
    if value > 0 or value < 0:
        return 1 if value > 0 else -1
    if not depth or poly(middle).contains(0):
        return 0
    half = (low + high) / 2
    first = sign_over(a, low, half, depth - 1)
    return first if first and sign_over(a, half, high, depth - 1) == first else 0


def check_crossing(certificate: Any) -> None:
    """Opposite signs at both ends of the claimed time; up to its begin one sign, where it is the first."""
    carried, claim = Carried(certificate), certificate["claim"]
    time = read_ball(claim["time"])
    signs: list[int] = []
    ends = []
    for moment in (arb(time.lower()), arb(time.upper())):
        for at, h, (series,) in pieces_of(certificate, carried):
            s = (moment - at) / h
            if s >= 0 and s <= 1 + arb(2) ** -40:
                poly = arb_poly(series.terms)
                value = poly(s.min(arb(1))) + arb(0, series.rest.upper())
                ends.append(1 if value > 0 else -1 if value < 0 else 0)
                break
    demand(len(ends) == 2 and ends[0] * ends[1] == -1, "the expression does not change its sign over the claimed time")
    if claim["first"]:
        for at, h, (series,) in pieces_of(certificate, carried):
            s = (arb(time.lower()) - at) / h
            if s > 0:
                signs.append(sign_over(series, ZERO, s.min(arb(1))))
        demand(set(signs) == {ends[0]}, "the expression may pass zero before the claimed time")


def check_no_crossing(certificate: Any) -> None:
    """One sign over every step."""
    carried = Carried(certificate)
    claimed = read_ball(certificate["claim"]["time"])
    demand(carried.time.contains(claimed) or carried.time >= claimed, "the steps end before the claimed time")
    signs = {sign_over(series, ZERO, arb(1)) for _, _, (series,) in pieces_of(certificate, carried)}
    demand(len(signs) == 1 and 0 not in signs, "the expression may pass zero")


def check_means(certificate: Any) -> None:
    """The integrals of the expressions over the spans that are claimed, step by step."""
    carried, claims = Carried(certificate), certificate["claim"]["means"]
    spans = [(read_ball(x["since"]), read_ball(x["until"])) for x in claims]
    for since, until in spans:
        demand(bool(since >= 0 and since < until), "a span has no length")
        demand(carried.time.contains(until) or carried.time >= until, "the steps end before a span does")
    totals = [ZERO] * len(claims)
    for at, h, series in pieces_of(certificate, carried):
        for i, (f, span) in enumerate(zip(series, spans, strict=True)):
            low, high = (((x - at) / h).max(ZERO).min(arb(1)) for x in span)
            whole = arb_poly(f.terms).integral()
            totals[i] += h * (whole(high) - whole(low) + arb(0, ((high - low) * f.rest).abs_upper()))
    for x, total, (since, until) in zip(claims, totals, spans, strict=True):
        demand(read_ball(x["mean"]).contains(total / (until - since)), "a mean is another")


def check_orbit(certificate: Any) -> None:
    """Krawczyk's test at the end of the steps; the reversals; the period; the multipliers."""
    carried = Carried(certificate)
    free, conditions = certificate["free"], certificate["conditions"]
    first, last = certificate["reversals"]
    size, moving = carried.flow.size, carried.flow.moving
    demand(
        size == moving + 1 and len(free) == len(conditions) and moving in free, "the conditions do not fit the unknowns"
    )
    demand(carried.time.contains(1) and carried.time.rad() < arb(2) ** -40, "the steps are not one unit of s")
    check_conditions(carried, first, last, free, conditions)
    A, D = matrix(certificate["A"]), carried.derivative
    back = 0 if first else 1

    def slope(columns: Sequence[int]) -> Any:
        return arb_mat([[D[i, j] - back * int(i == j) for j in columns] for i in conditions])

    miss = column([carried.point[i] - back * carried.middle[i] for i in conditions])
    w = column([carried.w[i] for i in free])
    K = (unit(len(free)) - A * slope(free)) * w - A * miss
    for x, box in zip(K.entries(), w.entries(), strict=True):
        demand(box.contains_interior(x), "Krawczyk's test does not close")
    start = list(carried.middle)
    for i, x in zip(free, K.entries(), strict=True):
        start[i] += x
    turns = 1 if not first else 2 if first == last else 4
    claim = certificate["claim"]
    states = balls(claim["start"])
    demand(
        len(states) == moving and all(y.contains(x) for x, y in zip(start, states, strict=False)),
        "the start is another",
    )
    demand(start[moving] > 0 and read_ball(claim["period"]).contains(turns * start[moving]), "the period is another")
    check_kind(certificate, carried, first, last)
    if "r0" in claim:
        check_amplitude(certificate, claim["r0"])


def check_amplitude(certificate: Any, claimed: Any) -> None:
    """The one orbit has the amplitude that is claimed, at the middle of its turn through the plane of the joint line."""
    check_pair(certificate)
    U = read_ball(certificate["start"]["middle"][0]) + read_ball(certificate["start"]["spread"][0])
    demand(claimed[0] == claimed[1] and U.contains(rational_of(claimed[0]).atanh()), "the amplitude is another")


def check_pair(certificate: Any) -> None:
    """The states and reversals are the pair's."""
    demand(
        certificate["motion"]["arguments"][0] == "U"
        and certificate["reversals"] == [[1, -1, -1, -1, 1, 1], [-1, 1, -1, 1, -1, 1]],
        "it is no precession of the pair",
    )


def check_conditions(carried: Carried, first: Any, last: Any, free: Any, conditions: Any) -> None:
    """The start lies in the fixed set of the first reversal; the conditions put the end into that of the last."""
    moving = carried.flow.moving
    if not first:
        demand(sorted(conditions) == list(range(moving)), "the orbit is not followed to its start")
        return
    demand(
        sorted(conditions) == [i for i, s in enumerate(last) if s < 0], "the conditions are not those of the reversal"
    )
    for i, s in enumerate(first):
        fixed = carried.middle[i].is_zero() and carried.w[i].is_zero()
        demand(s > 0 or (fixed and i not in free), "the start is not in the fixed set of the reversal")
    for signs in (first, last):
        check_reversal(carried.flow, signs)


def check_reversal(flow: Flow, signs: Any) -> None:
    """f(A x) = −A f(x), at points chosen beforehand, to more digits than anything else is known. The identity itself is proved
    where the certificate is made, from the Lagrangian."""
    moving, before = flow.moving, ctx.prec
    ctx.prec = 4 * before
    for shift in range(3):
        x = [arb(_POINTS[(i + 5 * shift) % len(_POINTS)]) for i in range(moving)]
        pace = [arb(1)] * (flow.size - moving)
        values = []
        for state in (x, [s * y for s, y in zip(signs, x, strict=True)]):
            rows = [Rest([y], ZERO, 1) for y in state]
            values.append([f.value.at_start() for f in evaluated(flow.tape, flow.arguments(rows, pace, None, 1), 1)])
        for s, a, b in zip(signs, *values, strict=True):
            off = s * a + b
            demand(off.contains(0), "time reversed is no motion")
    ctx.prec = before


def check_kind(certificate: Any, carried: Carried, first: Any, last: Any) -> None:
    """The trace of the monodromy less the ones, against ±2."""
    claim, moving = certificate["claim"], carried.flow.moving
    demand(claim["kind"] in ("undecided", "elliptic", "hyperbolic", "attracting", "parabolic"), "the kind is unknown")
    if claim["kind"] == "undecided":
        return
    whole = carried.derivative
    D = arb_mat([[whole[i, j] for j in range(moving)] for i in range(moving)])
    ones = certificate["ones"]
    if not first:
        values = D.eig()
        along = [z for z in values if z.contains(1)]
        others = [abs(z) for z in values if not z.contains(1)]
        fine = all(x < 1 for x in others) if claim["kind"] == "attracting" else all(x < 1 or x > 1 for x in others)
        demand(
            len(along) == 1 and fine and claim["kind"] in ("attracting", "hyperbolic"),
            "the multipliers are not shown to be apart from the unit circle",
        )
        return
    pair = pair_sum(D, first, last, ones)
    if claim["kind"] == "parabolic":
        demand(moving == ones, "a pair of multipliers is left that need not be one")
        return
    demand(moving - ones == 2, "more than one pair of multipliers is left")
    demand(read_ball(claim["pair_sum"]).contains(pair), "the multipliers' sum is another")
    demand(claim["kind"] == kind_of(pair), f"the orbit is not shown to be {claim['kind']}")


def kind_of(pair: Ball) -> str:
    """By μ + 1/μ."""
    return "elliptic" if abs(pair) < 2 else "hyperbolic" if abs(pair) > 2 else "undecided"


def pair_sum(D: Any, first: Any, last: Any, ones: int) -> Ball:
    """μ + 1/μ of the multipliers that are left beside the ones, from the derivative between two reversals."""
    moving = D.nrows()
    X = arb_mat(moving, moving, [x.mid() for x in D.entries()]).inv()
    X = arb_mat(moving, moving, [x.mid() for x in X.entries()])
    R = unit(moving) - D * X
    size = max((total(row) for row in R.tolist()), key=lambda x: float(x.upper()))
    demand(size < 1, "the derivative cannot be inverted")
    rest = (size**2 / (1 - size)).upper()
    back = X * (unit(moving) + R + arb_mat(moving, moving, [arb(0, rest)] * moving**2))
    reflect = [
        arb_mat(moving, moving, [s[i] if i == j else 0 for i in range(moving) for j in range(moving)])
        for s in (first, last)
    ]
    part = reflect[0] * back * reflect[1] * D
    M = part if first == last else part * part
    pair = sum((M[i, i] for i in range(moving)), ZERO) - ones
    left = arb_poly([1, -pair, 1]) if moving > ones else arb_poly([1])
    off = M.charpoly() - arb_poly([-1, 1]) ** ones * left
    demand(all(x.contains(0) for x in off.coeffs()), "the multipliers are not as many ones and a pair")
    return pair


def check_family(certificate: Any) -> None:
    """Krawczyk's test over every piece; each begins where the one before ends, with the same orbit."""
    check_pair(certificate)
    flow = Flow(certificate["motion"])
    for signs in certificate["reversals"]:
        check_reversal(flow, signs)
    pieces = [CheckedPiece(certificate["motion"], piece) for piece in certificate["pieces"]]
    for one, other in pairwise(pieces):
        demand(other.low <= one.high and one.high <= other.high, "there is a gap between two pieces")
        same = [
            all(y.contains_interior(x) for x, y in zip(a.start(one.high), b.box(one.high), strict=True))
            for a, b in ((one, other), (other, one))
        ]
        demand(any(same), "two pieces have other orbits at their common end")
    low, high = (rational_of(text).atanh() for text in certificate["claim"]["r0"])
    fits = low >= 0 and low < high and pieces[0].low <= low and high <= pieces[-1].high
    demand(bool(fits), "the amplitudes are others")
    period = read_ball(certificate["claim"]["period"])
    kind = certificate["claim"].get("kind", "undecided")
    demand(kind in ("elliptic", "hyperbolic", "undecided"), "the kind is unknown")
    for piece in pieces:
        fine = kind == "undecided" or piece.is_shown(kind, certificate["reversals"], arb(-1), arb(1))
        demand(fine, f"the orbits are not shown to be {kind}")
        pace = piece.start(piece.low.union(piece.high))[-1]
        demand(bool(pace > 0) and period.contains(4 * pace), "the period is another")


class CheckedPiece:
    """One piece of the pair's family: unknown are the rates of chi and alpha and the pace; U is middle + half ε."""

    def __init__(self, motion: Any, data: Any) -> None:
        free, conditions = (4, 5, 6), (0, 2, 4)
        self.middle, self.half = number(data["middle"]), number(data["half"])
        self.x = [arb_poly([number(c) for c in poly]) for poly in data["x"]]
        n, p, W = int(data["terms"]), int(data["degree"]), [number(w) for w in data["W"]]
        still = all(self.x[i].degree() < 0 and W[i].is_zero() for i in (1, 2, 3)) and W[0].is_zero()
        self.near_rest = data["near rest"] is True
        U = arb_poly([self.middle, self.half])
        off = self.x[0] - (arb_poly([1]) if self.near_rest else U)
        straight = all(c.is_zero() for c in off.coeffs())
        demand(
            len(self.x) == len(W) == 7 and still and straight and bool(self.half > 0),
            "a piece does not start in the fixed set of the reversal",
        )
        demand(
            n > 2 and all(poly.degree() <= p for poly in self.x) and all(W[i] > 0 for i in free), "a piece has no box"
        )
        self.low, self.high, self.W = self.middle - self.half, self.middle + self.half, [W[i] for i in free]
        demand(not self.near_rest or self.low.is_zero(), "the piece near the rest does not begin there")
        made = (motion, list(self.x), W, n, p)
        self.flow = flow = FlowNearRest(*made, U) if self.near_rest else FamilyFlow(*made)
        time = ZERO
        for step in data["steps"]:
            h = number(step["h"])
            flow.step(h, [number(r) for r in step["tube"]])
            time += h
        demand(time.is_exact() and time == 1, "the steps are not one unit of s")
        cuts = [number(c) for c in data["cuts"]]
        demand(
            bool(cuts[0] == -1 and cuts[-1] == 1 and all(a < b for a, b in pairwise(cuts))), "the cuts leave a part out"
        )
        self.w = [ZERO] * 3
        box = column([arb(0, w) for w in self.W])
        for a, b in pairwise(cuts):
            eps = a.union(b)
            slope = arb_mat([[flow.slope(i, j, eps) for j in free] for i in conditions])
            A = arb_mat(3, 3, [x.mid() for x in arb_mat(3, 3, [x.mid() for x in slope.entries()]).inv().entries()])
            K = (unit(3) - A * slope) * box - A * column([flow.end(i, eps) for i in conditions])
            for x, y in zip(K.entries(), box.entries(), strict=True):
                demand(y.contains_interior(x), "Krawczyk's test does not close over a family")
            for _ in range(2):
                K = (unit(3) - A * slope) * K - A * column([flow.end(i, eps) for i in conditions])
            self.w = [x.union(y) for x, y in zip(self.w, K.entries(), strict=True)]

    def is_shown(self, kind: str, reversals: Any, low: Ball, high: Ball, depth: int = 14) -> bool:
        """Whether every orbit from ε = low to high is of a kind, by halves; energy and momentum leave one pair beside 4 ones."""
        eps = low.union(high)
        D = arb_mat([[self.flow.slope(i, j, eps) for j in range(6)] for i in range(6)])
        try:
            if kind_of(pair_sum(D, reversals[0], reversals[1], 4)) == kind:
                return True
        except (NotProved, ZeroDivisionError):
            pass
        middle = (low + high) / 2
        return depth > 0 and all(
            self.is_shown(kind, reversals, *part, depth - 1) for part in ((low, middle), (middle, high))
        )

    def start(self, U: Ball) -> list[Ball]:
        """What was unknown, for the U of a ball."""
        return self._about(U, self.w)

    def box(self, U: Ball) -> list[Ball]:
        """Where it is alone."""
        return self._about(U, [arb(0, w) for w in self.W])

    def _about(self, U: Ball, off: Sequence[Ball]) -> list[Ball]:
        eps = (U - self.middle) / self.half
        *rates, pace = (poly(eps) + w for poly, w in zip(self.x[4:], off, strict=True))
        return [*(U * x if self.near_rest else x for x in rates), pace]


def check_equilibrium(certificate: Any) -> None:
    """Krawczyk's test for the forces at rest; definite energy, or an eigenvalue with a positive real part."""
    flow = Flow(certificate["motion"])
    n = flow.moving // 2
    middle, box = [number(x) for x in certificate["middle"]], balls(certificate["box"])
    demand(len(middle) == len(box) == n, "the equilibrium has other coordinates")
    A = matrix(certificate["A"])
    wide = [x + y for x, y in zip(middle, box, strict=True)]
    at = gradients(flow.tape, flow, [*middle, *[ZERO] * n])
    J = gradients(flow.tape, flow, [*wide, *[ZERO] * n])
    value = column([f.value.at_start() for f in at[n:]])
    slope = arb_mat([[x.at_start() for x in (f.by or [])[:n]] for f in J[n:]])
    w = column(box)
    K = (unit(n) - A * slope) * w - A * value
    for x, y in zip(K.entries(), box, strict=True):
        demand(y.contains_interior(x), "Krawczyk's test does not close")
    states = [x + y for x, y in zip(middle, K.entries(), strict=True)]
    demand(
        all(y.contains(x) for x, y in zip(states, balls(certificate["claim"]["q"]), strict=True)),
        "the coordinates are others",
    )
    claim = certificate["claim"]["stability"]
    demand(claim in ("stable", "stable to first order", "unstable", "undecided"), "the stability is unknown")
    if claim == "stable":
        demand(not grows(J, n), "an eigenvalue has a positive real part")
        state = [Dual(Rest([x], ZERO, 1)) for x in (*wide, *[ZERO] * n, *flow.parameters)]
        H = [f.value.at_start() for f in evaluated(certificate["energy"], state, 1)]
        for k in range(1, 2 * n + 1):
            minor = arb_mat([[H[2 * n * i + j] for j in range(k)] for i in range(k)])
            demand(minor.det() > 0, "the energy is not shown to be definite")
    elif claim != "undecided":
        values = linear(J, n).eig()
        if claim == "unstable":
            demand(any(z.real > 0 for z in values), "no eigenvalue is shown to have a positive real part")
        else:
            apart = all(not a.imag.overlaps(b.imag) for i, a in enumerate(values) for b in values[:i])
            fine = certificate["conservative"] and apart and all(z.real.contains(0) for z in values)
            demand(fine, "the eigenvalues are not shown to be imaginary")


def grows(J: Sequence[Dual], n: int) -> bool:
    """Whether an eigenvalue of the linear motion is shown to have a positive real part."""
    try:
        return any(z.real > 0 for z in linear(J, n).eig())
    except ValueError:  # Not apart.
        return False


def linear(J: Sequence[Dual], n: int) -> Any:
    """The matrix of the linear motion in (q, v)."""
    zero = Rest([ZERO], ZERO, 1)
    return arb_mat([[x.at_start() for x in (f.by or [zero] * 2 * n)] for f in J])


def gradients(tape: Any, flow: Flow, state: list[Ball]) -> list[Dual]:
    """The tape's outputs with their derivatives by the states."""
    rows = [Rest([x], ZERO, 1) for x in state]
    by = [[Rest([arb(int(i == j))], ZERO, 1) for j in range(len(state))] for i in range(len(state))]
    return evaluated(tape, flow.arguments(rows, [], by, 1), 1)


_RULES: dict[str, Callable[[Any], None]] = {
    "enclosure": check_enclosure,
    "crossing": check_crossing,
    "no crossing": check_no_crossing,
    "means": check_means,
    "periodic orbit": check_orbit,
    "equilibrium": check_equilibrium,
    "family": check_family,
}
