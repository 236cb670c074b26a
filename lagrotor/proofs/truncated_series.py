"""Power series on 0 ≤ s ≤ 1 as a polynomial of n terms and a bound of all that is left out.

A function is held as sum_{k<n} c_k s^k + e, where e has only powers from n on and the sum of its coefficients' absolute
values, its norm, is at most `tail`. In this norm |f g| ≤ |f| |g|, so each operation carries the bound along exactly: what
a product has beyond n is summed as it is, a quotient and a root are the fixed point of a contraction, and exp, sin and
cos solve their differential equations, where integrating s^(n−1) divides by n.
"""

from collections.abc import Sequence
from typing import Any

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import ZERO, Ball, arb, arb_poly, arb_series, ctx, max_of, upper
from lagrotor.proofs.tape import Tape


class TailError(NotProved):
    """A bound that does not close: the step is too long for the series."""


class Tailed:
    """poly: arb_poly of at most n terms; tail: bound of the norm of the rest; norm: bound of the whole norm."""

    __slots__ = ("_norm", "n", "poly", "tail")

    def __init__(self, poly: Any, tail: Ball, n: int) -> None:
        self.poly, self.tail, self.n, self._norm = poly, tail, n, None

    @property
    def norm(self) -> Ball:
        """Bound of the sum of all coefficients' absolute values."""
        if self._norm is None:
            self._norm = _norm(self.poly) + self.tail
        return self._norm

    def constant(self, value: Ball) -> "Tailed":
        """A number as a series."""
        return Tailed(arb_poly([value]), ZERO, self.n)

    def series(self) -> Any:
        """The polynomial as Arb's truncated series, whose functions are exact to n terms, but never to more than `ctx.cap`."""
        if ctx.cap < self.n:
            raise TailError(f"series of {self.n} terms need precision(…, {self.n}), not {ctx.cap}")
        return arb_series(self.poly.coeffs(), self.n)

    def __add__(self, other: "Tailed") -> "Tailed":
        return Tailed(self.poly + other.poly, self.tail + other.tail, self.n)

    def __sub__(self, other: "Tailed") -> "Tailed":
        return Tailed(self.poly - other.poly, self.tail + other.tail, self.n)

    def __neg__(self) -> "Tailed":
        return Tailed(-self.poly, self.tail, self.n)

    def __mul__(self, other: "Tailed") -> "Tailed":
        whole = self.poly * other.poly
        tail = beyond(whole, self.n)
        if not self.tail.is_zero():
            tail += self.tail * other.norm
        if not other.tail.is_zero():
            tail += other.tail * _norm(self.poly)
        return Tailed(whole.truncate(self.n), tail, self.n)

    def __truediv__(self, other: "Tailed") -> "Tailed":
        return self * other.inverse()

    def inverse(self) -> "Tailed":
        """1/a: with q the truncated inverse and r = 1 − a q, whose powers begin at n, it is q/(1 − r)."""
        _constant(self, "a denominator")
        q = _poly(self.series().inv())
        size = _norm(q)
        r = beyond(self.poly * q, self.n) + size * self.tail
        return Tailed(q, size * r / _left(1 - r), self.n)

    def sqrt(self) -> "Tailed":
        """q + s with s = (a − q² − s²)/(2 q): a contraction of |s| ≤ σ where σ = k (d + σ²)/2 and k σ < 1, k = |1/q|."""
        if not _constant(self, "a root's argument") > 0:
            raise TailError("a root's argument is not shown to be positive")
        q = _poly(self.series().sqrt())
        k = Tailed(q, ZERO, self.n).inverse().norm
        d = beyond(q * q, self.n) + self.tail
        return Tailed(q, k * d / (1 + _left(1 - k * k * d).sqrt()), self.n)

    def exp(self) -> "Tailed":
        """q + s with s' = a' s + (a' q − q'), then the tail's factor exp(e); never more than the whole, exp(a_0 + |a − a_0|)."""
        q = _poly(self.series().exp())
        slope = self.poly.derivative()
        tail = (self.poly[0] + _norm(self.poly - arb_poly([self.poly[0]])) + self.tail).exp()
        left = 1 - _norm(slope) / (self.n + 1)
        if left > 0:
            s = beyond(slope * q, self.n - 1) / self.n / left
            tail = tail.min(s + (_norm(q) + s) * self.tail.expm1())
        return Tailed(q, upper(tail), self.n)

    def sin_cos(self) -> tuple["Tailed", "Tailed"]:
        """Both solve (S, C)' = a' (C, −S); then sin(a + e) = S cos e + C sin e."""
        n, slope = self.n, self.poly.derivative()
        pair = [_poly(q) for q in self.series().sin_cos()]
        sizes = [_norm(q) for q in pair]
        s = max_of([beyond(slope * q, n - 1) for q in pair]) / n
        s /= _left(1 - _norm(slope) / (n + 1))
        rise, turn = self.tail.cosh() - 1, self.tail.sinh()
        sine, cosine = sizes[0] + s, sizes[1] + s
        return (
            Tailed(pair[0], s + sine * rise + cosine * turn, n),
            Tailed(pair[1], s + cosine * rise + sine * turn, n),
        )

    def by_slope(self, name: str, slope: "Tailed") -> "Tailed":
        """g(a) from its derivative g'(a): g(a + e) = g(a_0) + ∫ a' g'(a) ds + e ∫ g'(a + θ e) dθ."""
        q = _poly(getattr(self.series(), name)())
        rate = self.poly.derivative()
        left = beyond(rate * slope.poly, self.n - 1) + _norm(rate) * slope.tail
        return Tailed(q, left / self.n + self.tail * slope.norm, self.n)


def _norm(poly: Any) -> Ball:
    """The sum of the coefficients' absolute values, an upper bound."""
    return upper(sum(map(abs, poly.coeffs()), ZERO))


def beyond(poly: Any, n: int) -> Ball:
    """The norm of the terms from s^n on."""
    return _norm(poly.right_shift(n)) if poly.length() > n else ZERO


def _constant(a: Tailed, what: str) -> Ball:
    """The value at s = 0, which must not be zero."""
    value = a.poly[0]
    if not (value > 0 or value < 0):
        raise TailError(f"{what} is not shown to be other than zero")
    return value


def _left(x: Ball) -> Ball:
    """What must be positive for a contraction."""
    if not x > 0:
        raise TailError("the series does not converge over the step")
    return x


def _poly(series: Any) -> Any:
    return arb_poly(list(series))


def _number(text: str) -> Ball:
    """The constant of a tape: a rational number or pi."""
    if text == "pi":
        return arb.pi()
    above, _, below = text.partition("/")
    return arb(int(above)) / int(below or 1)


def series_values(tape: Tape, arguments: Sequence[Any]) -> list[Any]:
    """The tape's outputs as truncated series, of arguments as truncated series (or numbers)."""
    found: list[Any] = []
    for name, *on in tape.operations:
        if name == "argument":
            found.append(arguments[on[0]])
        elif name == "number":
            found.append(_number(on[0]))
        elif name == "add":
            found.append(found[on[0]] + found[on[1]])
        elif name == "subtract":
            found.append(found[on[0]] - found[on[1]])
        elif name == "multiply":
            found.append(found[on[0]] * found[on[1]])
        elif name == "divide":
            found.append(found[on[0]] / found[on[1]])
        else:
            found.append(getattr(found[on[0]], name)())
    return [found[place] for place in tape.outputs]


class Evaluation:
    """The tape over series with their tails: its values, and derivatives of the outputs backwards."""

    def __init__(self, tape: Tape, arguments: Sequence[Tailed]) -> None:
        self.tape, self._arguments = tape, arguments
        self.values: list[Tailed] = []
        self._slopes: dict[int, Tailed] = {}  # of an operation of one operand, by that operand
        self._twins: dict[int, tuple[Tailed, Tailed]] = {}
        self._inverses: dict[int, Tailed] = {}
        for place, (name, *on) in enumerate(tape.operations):
            if name == "argument":
                self.values.append(arguments[on[0]])
            elif name == "number":
                self.values.append(self.fixed(_number(on[0])))
            else:
                self.values.append(self._value(place, name, on))

    @property
    def outputs(self) -> list[Tailed]:
        """The tape's outputs."""
        return [self.values[place] for place in self.tape.outputs]

    def fixed(self, value: Ball) -> Tailed:
        """A number as a series."""
        return self._arguments[0].constant(value)

    def _value(self, place: int, name: str, on: list[int]) -> Tailed:
        a = self.values[on[0]]
        if name == "add":
            return a + self.values[on[1]]
        if name == "subtract":
            return a - self.values[on[1]]
        if name == "multiply":
            return a * self.values[on[1]]
        if name == "divide":
            self._slopes[place] = self._inverse(on[1])
            return a * self._slopes[place]
        return self._function(place, name, on[0], a)

    def _inverse(self, operand: int) -> Tailed:
        """1/a, once for each operand."""
        if operand not in self._inverses:
            self._inverses[operand] = self.values[operand].inverse()
        return self._inverses[operand]

    def _function(self, place: int, name: str, operand: int, a: Tailed) -> Tailed:
        one = self.fixed(arb(1))
        if name in ("sin", "cos"):
            if operand not in self._twins:
                self._twins[operand] = a.sin_cos()
            sine, cosine = self._twins[operand]
            self._slopes[place] = cosine if name == "sin" else -sine
            return sine if name == "sin" else cosine
        if name == "exp":
            found = self._slopes[place] = a.exp()
            return found
        if name == "sqrt":
            found = a.sqrt()
            self._slopes[place] = (found + found).inverse()
            return found
        if name == "log":
            if not _constant(a, "a logarithm's argument") > 0:
                raise TailError("a logarithm's argument is not shown to be positive")
            slope = self._inverse(operand)
        elif name == "asin":
            slope = (one - a * a).sqrt().inverse()
        else:
            slope = (one + a * a).inverse()
        self._slopes[place] = slope
        return a.by_slope(name, slope)

    def gradient(self, output: int) -> list[Tailed | None]:
        """The derivatives of one output by the arguments, None where it does not depend on one; backwards through the tape."""
        place = self.tape.outputs[output]
        left: dict[int, Tailed] = {place: self.fixed(arb(1))}
        found: list[Tailed | None] = [None] * len(self.tape.arguments)
        for k in range(place, -1, -1):
            if k not in left:
                continue
            g = left.pop(k)
            name, *on = self.tape.operations[k]
            if name == "argument":
                found[on[0]] = g
            elif name != "number":
                for operand, part in self._parts(k, name, on, g):
                    if self.tape.operations[operand][0] != "number":
                        left[operand] = left[operand] + part if operand in left else part
        return found

    def _parts(self, k: int, name: str, on: list[int], g: Tailed) -> list[tuple[int, Tailed]]:
        if name == "add":
            return [(on[0], g), (on[1], g)]
        if name == "subtract":
            return [(on[0], g), (on[1], -g)]
        if name == "multiply":
            return [(on[0], g * self.values[on[1]]), (on[1], g * self.values[on[0]])]
        slope = g * self._slopes[k]
        if name == "divide":
            return [(on[0], slope), (on[1], -(slope * self.values[k]))]
        return [(on[0], slope)]
