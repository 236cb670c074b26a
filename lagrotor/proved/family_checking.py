"""The second program for a family of motions: its own series in s and ε, which share nothing with `taylor_models`.

A function of 0 ≤ s ≤ 1 and |ε| ≤ 1 is a list of polynomials of ε, one for each power of s, and a bound of the rest in the maximum
norm. Functions come from recurrences in s; what they leave out is bounded by the equation that each satisfies: 1 − a q, a − q²,
q' − a' q, a q' − a'. Derivatives are found by dual numbers, forward.
"""

from collections.abc import Sequence
from typing import Any

from flint import arb, arb_poly, arb_series, ctx, fmpz

from lagrotor.errors import NotProved

Ball = Any
ZERO = arb(0)


def demand(holds: bool, what: str) -> None:
    """Raises NotProved where something does not hold."""
    if not holds:
        raise NotProved(f"check: {what}")


def top(x: Ball) -> Ball:
    """The upper end of what is no less than zero."""
    return arb(x.upper())


def bound(poly: Any) -> Ball:
    """Of a polynomial of ε."""
    return top(sum(map(abs, poly.coeffs()), ZERO))


class Sheet:
    """terms: n polynomials of ε of degree p; rest: None where it is not sought."""

    def __init__(self, terms: list[Any], rest: Ball | None, n: int, p: int) -> None:
        self.terms, self.rest, self.n, self.p = terms, rest, n, p

    def like(self, terms: list[Any], rest: Ball | None) -> "Sheet":
        """Another of the same order."""
        return Sheet(terms, rest, self.n, self.p)

    def number(self, value: Ball) -> "Sheet":
        """A constant."""
        return self.like([arb_poly([value])], None if self.rest is None else ZERO)

    def size(self) -> Ball:
        """Of the maximum of the absolute value."""
        return sum(map(bound, self.terms), ZERO) + (ZERO if self.rest is None else self.rest)

    def plus(self, other: "Sheet", sign: int = 1) -> "Sheet":
        """The sum, or the difference."""
        width = max(len(self.terms), len(other.terms))
        none = arb_poly([])
        a, b = (x.terms + [none] * (width - len(x.terms)) for x in (self, other))
        rest = None if self.rest is None or other.rest is None else self.rest + other.rest
        return self.like([x + y if sign > 0 else x - y for x, y in zip(a, b, strict=True)], rest)

    def times(self, other: "Sheet") -> "Sheet":
        """The product."""
        if not self.terms or not other.terms:
            return self.like([], _rest_of_product(self, other, ZERO))
        whole = [arb_poly([])] * (len(self.terms) + len(other.terms) - 1)
        most = self.n if self.rest is None or other.rest is None else len(whole)
        for i, x in enumerate(self.terms):
            for j, y in enumerate(other.terms[: max(most - i, 0)]):
                whole[i + j] += x * y
        terms = [poly.truncate(self.p + 1) for poly in whole[: self.n]]
        if self.rest is None or other.rest is None:
            return self.like(terms, None)
        left = sum((bound(poly.right_shift(self.p + 1)) for poly in whole[: self.n]), ZERO)
        left += sum((bound(poly) for poly in whole[self.n :]), ZERO)
        return self.like(terms, _rest_of_product(self, other, left))

    def rate(self) -> "Sheet":
        """The derivative by s of the terms alone."""
        return self.like([k * x for k, x in enumerate(self.terms)][1:], ZERO)

    def at_centre(self) -> Ball:
        """The value at s = ε = 0."""
        return self.terms[0][0] if self.terms else ZERO


def _rest_of_product(a: Sheet, b: Sheet, left: Ball) -> Ball | None:
    if a.rest is None or b.rest is None:
        return None
    return top(left + a.rest * b.size() + b.rest * (a.size() - a.rest))


def _series(a: Sheet) -> list[Any]:
    """The terms as truncated series of ε, all n of them."""
    return [arb_series(x.coeffs(), a.p + 1) for x in a.terms] + [arb_series([], a.p + 1)] * (a.n - len(a.terms))


def _sheet(a: Sheet, terms: Sequence[Any], rest: Ball | None) -> Sheet:
    return a.like([arb_poly(list(x)) for x in terms], rest)


def _left(x: Ball) -> Ball:
    demand(bool(x < 1), "a bound does not close over a step of the family")
    return 1 - x


def inverse_sheet(a: Sheet) -> Sheet:
    """1/a = q/(1 − r), r = 1 − a q."""
    demand(bool(a.at_centre() > 0 or a.at_centre() < 0), "a denominator is not shown to be other than zero")
    x = _series(a)
    q = [1 / x[0]]
    for k in range(1, a.n):
        q.append(-sum((x[j] * q[k - j] for j in range(1, k + 1)), ZERO) * q[0])
    if a.rest is None:
        return _sheet(a, q, None)
    found = _sheet(a, q, ZERO)
    r = a.number(arb(1)).plus(a.times(found), -1).size()
    return found.like(found.terms, top(found.size() * r / _left(r)))


def root(a: Sheet) -> Sheet:
    """√a with a − q² = d: |√a − q| ≤ |q| (1 − √(1 − |d|/q²))."""
    demand(bool(a.at_centre() > 0), "a root's argument is not shown to be positive")
    x = _series(a)
    q = [x[0].sqrt()]
    over = 1 / (2 * q[0])
    for k in range(1, a.n):
        q.append((x[k] - sum((q[j] * q[k - j] for j in range(1, k)), ZERO)) * over)
    if a.rest is None:
        return _sheet(a, q, None)
    found = _sheet(a, q, ZERO)
    d, k = a.plus(found.times(found), -1).size(), inverse_sheet(found).size()
    return found.like(found.terms, top(found.size() * (1 - _left(d * k * k).sqrt())))


def exponential(a: Sheet) -> Sheet:
    """q' − a' q = ρ gives |e^a − q| ≤ (|ρ_ε| + |ρ_s|) e^|a'|, first along ε, then along s."""
    x = _series(a)
    q = [x[0].exp()]
    for k in range(1, a.n):
        q.append(sum((j * x[j] * q[k - j] for j in range(1, k + 1)), ZERO) * (arb(1) / k))
    if a.rest is None:
        return _sheet(a, q, None)
    found, flat = _sheet(a, q, ZERO), a.like(a.terms, ZERO)
    start, first = (a.terms[0] if a.terms else arb_poly([])), found.terms[0]
    along = bound(first.derivative() - start.derivative() * first) * bound(start.derivative()).exp()
    slope = flat.rate()
    missed = found.rate().plus(slope.times(found), -1).size()
    error = (along + missed) * slope.size().exp()
    whole = found.size() + error
    return found.like(found.terms, top(error + whole * (a.rest.exp() - 1)))


def turning(a: Sheet) -> tuple[Sheet, Sheet]:
    """(sin a, cos a): the error's square sum grows by the defects alone."""
    x = _series(a)
    s, c = [x[0].sin()], [x[0].cos()]
    for k in range(1, a.n):
        s.append(sum((j * x[j] * c[k - j] for j in range(1, k + 1)), ZERO) * (arb(1) / k))
        c.append(-sum((j * x[j] * s[k - j] for j in range(1, k + 1)), ZERO) * (arb(1) / k))
    if a.rest is None:
        return _sheet(a, s, None), _sheet(a, c, None)
    sine, cosine = _sheet(a, s, ZERO), _sheet(a, c, ZERO)
    start = (a.terms[0] if a.terms else arb_poly([])).derivative()
    first, second = sine.terms[0], cosine.terms[0]
    error = bound(first.derivative() - start * second) + bound(second.derivative() + start * first)
    slope = a.like(a.terms, ZERO).rate()
    error += sine.rate().plus(slope.times(cosine), -1).size() + cosine.rate().plus(slope.times(sine)).size()
    rest = top(error + a.rest)
    return sine.like(sine.terms, rest), cosine.like(cosine.terms, rest)


def logarithm(a: Sheet, over: Sheet) -> Sheet:
    """a q' − a' = ρ gives |log a − q| ≤ (|ρ_ε| + |ρ_s|) |1/a|. over: 1/a."""
    demand(bool(a.at_centre() > 0), "a logarithm's argument is not shown to be positive")
    x = _series(a)
    q = [x[0].log()]
    below = 1 / x[0]
    for k in range(1, a.n):
        q.append((x[k] - sum((j * q[j] * x[k - j] for j in range(1, k)), ZERO) * (arb(1) / k)) * below)
    if a.rest is None:
        return _sheet(a, q, None)
    found, flat = _sheet(a, q, ZERO), a.like(a.terms, ZERO)
    start, first = a.terms[0], found.terms[0]
    along = bound(start * first.derivative() - start.derivative())
    missed = flat.times(found.rate()).plus(flat.rate(), -1).size()
    k = over.size()
    return found.like(found.terms, top((along + missed) * k + a.rest * k / _left(a.rest * k)))


def rational_of(text: str) -> Ball:
    """A number of a tape."""
    if text == "pi":
        return arb.pi()
    above, _, below = text.partition("/")
    return arb(fmpz(int(above))) / arb(fmpz(int(below or 1)))


Pair = tuple[Sheet, "list[Sheet] | None"]  # a value, and its derivatives by the start


def _linear(
    factor: Sheet, by: list[Sheet] | None, second: Sheet | None, other: list[Sheet] | None
) -> list[Sheet] | None:
    first = None if by is None else [factor.times(x) for x in by]
    if other is None or second is None:
        return first
    moved = [second.times(x) for x in other]
    return moved if first is None else [x.plus(y) for x, y in zip(first, moved, strict=True)]


def outputs_of(tape: Any, arguments: Sequence[Pair]) -> list[Pair]:
    """The tape's outputs."""
    found: list[Pair] = []
    for name, *on in tape["operations"]:
        if name == "argument":
            found.append(arguments[on[0]])
            continue
        if name == "number":
            found.append((arguments[0][0].number(rational_of(on[0])), None))
            continue
        a, by = found[on[0]]
        one = a.number(arb(1))
        if len(on) == 1:
            found.append(_function(name, a, by, one))
            continue
        b, other = found[on[1]]
        if name in ("add", "subtract"):
            sign = 1 if name == "add" else -1
            found.append((a.plus(b, sign), _linear(one, by, a.number(arb(sign)), other)))
        elif name == "multiply":
            found.append((a.times(b), _linear(b, by, a, other)))
        else:
            demand(name == "divide", f"the operation {name!r} is unknown")
            over = inverse_sheet(b)
            quotient = a.times(over)
            found.append((quotient, _linear(over, by, one.number(arb(-1)).times(quotient.times(over)), other)))
    return [found[place] for place in tape["outputs"]]


def _function(name: str, a: Sheet, by: list[Sheet] | None, one: Sheet) -> Pair:
    minus = one.number(arb(-1))
    if name == "exp":
        value = slope = exponential(a)
    elif name == "sqrt":
        value = root(a)
        slope = one.number(arb(0.5)).times(inverse_sheet(value))
    elif name == "log":
        slope = inverse_sheet(a)
        value = logarithm(a, slope)
    else:
        demand(name in ("sin", "cos"), f"{name} is no operation of a family")
        sine, cosine = turning(a)
        value, slope = (sine, cosine) if name == "sin" else (cosine, minus.times(sine))
    return value, _linear(slope, by, None, None)


class FamilyFlow:
    """The motions of every ε, followed by the steps of a certificate; x, b and V at their end.

    x: polynomials of ε; W: the box of the start; steps: h, tube, units, exact numbers.
    """

    def __init__(self, tape: Any, x: list[Any], W: list[Ball], n: int, p: int) -> None:
        self.tape, self.W, self.n, self.p = tape, W, n, p
        self.moving, self.size = len(tape["outputs"]), len(x)
        demand(self.size == len(tape["arguments"]), "a family's motion has no parameters but its pace")
        self.x, self.b = x, [ZERO] * self.size
        self.V = [[Sheet([arb_poly([int(i == j)])], ZERO, 1, p) for j in range(self.size)] for i in range(self.size)]

    def step(self, h: Ball, tube: list[Ball], units: list[Ball]) -> None:
        """One step."""
        demand(
            bool(h > 0) and all(r > 0 for r in tube) and all(u > 0 for u in units), "a step has no length or no bounds"
        )
        before, ctx.cap = ctx.cap, self.p + 1
        try:
            self._step(h, tube, units)
        finally:
            ctx.cap = before

    def _step(self, h: Ball, tube: list[Ball], units: list[Ball]) -> None:
        moving = self.moving
        terms = [[poly] for poly in self.x[:moving]]
        for k in range(1, self.n):
            rates = self._rates([Sheet(row, None, k, self.p) for row in terms], None)
            for row, rate in zip(terms, rates, strict=True):
                row.append((rate.terms[k - 1] if len(rate.terms) >= k else arb_poly([])) * (h / k))
        missed = []
        for row, rate in zip(terms, self._rates([self._full(row, ZERO) for row in terms], ZERO), strict=True):
            change = _integral(rate, h).plus(self._full(row, ZERO), -1).plus(self._full([row[0]], ZERO))
            missed.append(change.size())
        wide = [
            b + sum((v.size() * w for v, w in zip(row, self.W, strict=True)), ZERO)
            for b, row in zip(self.b, self.V, strict=True)
        ]
        J, growth = self._slopes(terms, wide, h, tube, units)
        off = [x + y for x, y in zip(wide, missed, strict=False)] + wide[moving:]
        demand(
            all(x <= r for x, r in zip(_grown(off, units, growth)[:moving], tube, strict=True)),
            "the tube about a family is too narrow",
        )
        D = self._derivative(J, h, units, growth)
        rests = [*_grown(missed, units, growth)[:moving], *[ZERO] * (self.size - moving)]
        self.b = [
            top(sum((d.size() * x for d, x in zip(row, self.b, strict=True)), rest))
            for row, rest in zip(D, rests, strict=True)
        ]
        self.V = [[self._along(row, j) for j in range(self.size)] for row in D]
        self.x = [*(sum(row, arb_poly([])) for row in terms), *self.x[moving:]]

    def _along(self, row: list[Sheet], j: int) -> Sheet:
        total = row[0].times(self.V[0][j])
        for d, v in zip(row[1:], self.V[1:], strict=True):
            total = total.plus(d.times(v[j]))
        return total

    def _full(self, terms: list[Any], rest: Ball | None) -> Sheet:
        return Sheet(terms, rest, self.n, self.p)

    def _rates(self, rows: list[Sheet], rest: Ball | None) -> list[Sheet]:
        still = [rows[0].like([poly], rest) for poly in self.x[self.moving :]]
        return [value for value, _ in outputs_of(self.tape, [(row, None) for row in (*rows, *still)])]

    def _slopes(
        self, terms: list[list[Any]], wide: list[Ball], h: Ball, tube: list[Ball], units: list[Ball]
    ) -> tuple[list[list[Sheet]], Ball]:
        """J over the tube, and exp of a bound of |h J| in the units."""
        rows = [self._full(row, r) for row, r in zip(terms, tube, strict=True)]
        rows += [self._full([poly], w) for poly, w in zip(self.x[self.moving :], wide[self.moving :], strict=True)]
        zero = self._full([], ZERO)
        by = [[zero.number(arb(int(i == j))) for j in range(self.size)] for i in range(self.size)]
        J = [slopes or [zero] * self.size for _, slopes in outputs_of(self.tape, list(zip(rows, by, strict=True)))]
        sums = [
            h * sum((x.size() * u for x, u in zip(row, units, strict=True)), ZERO) / unit
            for row, unit in zip(J, units, strict=False)
        ]
        return J, top(max(map(top, sums), key=float).exp())

    def _derivative(self, J: list[list[Sheet]], h: Ball, units: list[Ball], growth: Ball) -> list[list[Sheet]]:
        """Of the step, by states and pace."""
        size, none = self.size, arb_poly([])
        D = [[[arb_poly([int(i == j)])] for j in range(size)] for i in range(size)]
        for k in range(1, self.n):
            new = [[none] * size for _ in J]
            for i, row in enumerate(J):
                for m, g in enumerate(row):
                    for a, poly in enumerate(g.terms[:k]):
                        for j in range(size):
                            if k - 1 - a < len(D[m][j]):
                                new[i][j] += poly * D[m][j][k - 1 - a]
            for i, row_of_new in enumerate(new):
                for j in range(size):
                    D[i][j].append((row_of_new[j] * (h / k)).truncate(self.p + 1))
        end = [[Sheet([sum(entry, none)], ZERO, 1, self.p) for entry in row] for row in D]
        for j in range(size):
            missed = []
            for i, row in enumerate(J):
                rate = row[0].times(self._full(D[0][j], ZERO))
                for m in range(1, size):
                    rate = rate.plus(row[m].times(self._full(D[m][j], ZERO)))
                change = _integral(rate, h).plus(self._full(D[i][j], ZERO), -1)
                missed.append(change.plus(change.number(arb(int(i == j)))).size())
            for i, rest in enumerate(_grown(missed, units, growth)[: len(J)]):
                end[i][j] = end[i][j].like(end[i][j].terms, rest)
        return end

    def end(self, i: int, eps: Ball) -> Ball:
        """A state of the middle at the end, for every ε of a ball."""
        return self.x[i](eps) + arb(0, self.b[i].upper())

    def slope(self, i: int, j: int, eps: Ball) -> Ball:
        """Its derivative by a start, over the box."""
        v = self.V[i][j]
        return sum(v.terms, arb_poly([]))(eps) + arb(0, (v.rest or ZERO).upper())


def _integral(rate: Sheet, h: Ball) -> Sheet:
    terms = [arb_poly([]), *(poly * (h / (k + 1)) for k, poly in enumerate(rate.terms))]
    rest = h * rate.rest + sum((bound(poly) for poly in terms[rate.n :]), ZERO)
    return rate.like(terms[: rate.n], top(rest))


def _grown(off: Sequence[Ball], units: Sequence[Ball], growth: Ball) -> list[Ball]:
    """Gronwall's inequality."""
    most = max((top(x / u) for x, u in zip(off, units, strict=False)), key=float)
    return [top(u * most * growth) for u in units]
