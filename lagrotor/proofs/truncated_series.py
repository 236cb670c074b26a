"""Taylor models on 0 ≤ s ≤ 1: a polynomial of n terms and a remainder bound.

A function is sum_{k<n} c_k s^k + e, where e has powers from n on. Its norm is the sum of the absolute values of its
coefficients; the norm of e is at most `remainder`. Since |f g| ≤ |f| |g|, each operation propagates the bound. The high
terms of a product are summed. A quotient and a root are fixed points of contractions. exp, sin and cos solve their
differential equations, where the integral of s^(n−1) brings the factor 1/n.
"""

from collections.abc import Sequence
from typing import Any

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import ZERO, Ball, arb, arb_poly, arb_series, ctx, max_of, upper
from lagrotor.proofs.tape import Tape


class RemainderError(NotProved):
    """No remainder bound is proved, because the step is too long for the series."""


class TaylorModel:
    """A polynomial `poly` of at most n terms, and `remainder`, a bound of the norm of all further terms."""

    __slots__ = ("_norm", "n", "poly", "remainder")

    def __init__(self, poly: Any, remainder: Ball, n: int) -> None:
        self.poly, self.remainder, self.n, self._norm = poly, remainder, n, None

    @property
    def norm(self) -> Ball:
        """A bound of the norm of the whole function."""
        if self._norm is None:
            self._norm = _norm(self.poly) + self.remainder
        return self._norm

    def series(self) -> Any:
        """Return the polynomial as Arb's truncated series, whose functions have at most `ctx.cap` terms."""
        if ctx.cap < self.n:
            raise RemainderError(f"series of {self.n} terms need precision(…, {self.n}), not {ctx.cap}")
        return arb_series(self.poly.coeffs(), self.n)

    def __add__(self, b: "TaylorModel") -> "TaylorModel":
        return TaylorModel(self.poly + b.poly, self.remainder + b.remainder, self.n)

    def __sub__(self, b: "TaylorModel") -> "TaylorModel":
        return TaylorModel(self.poly - b.poly, self.remainder + b.remainder, self.n)

    def __neg__(self) -> "TaylorModel":
        return TaylorModel(-self.poly, self.remainder, self.n)

    def __mul__(self, b: "TaylorModel") -> "TaylorModel":
        whole = self.poly * b.poly
        remainder = beyond(whole, self.n)
        if not self.remainder.is_zero():
            remainder += self.remainder * b.norm
        if not b.remainder.is_zero():
            remainder += b.remainder * _norm(self.poly)
        return TaylorModel(whole.truncate(self.n), remainder, self.n)

    def __truediv__(self, b: "TaylorModel") -> "TaylorModel":
        return self * b.inverse()

    def inverse(self) -> "TaylorModel":
        """Return 1/a = q/(1 − r), with q the truncated inverse of a, and r = 1 − a q, whose powers begin at n."""
        _constant(self, "a denominator")
        q = _poly(self.series().inv())
        size = _norm(q)
        r = beyond(self.poly * q, self.n) + size * self.remainder
        return TaylorModel(q, size * r / _margin(1 - r), self.n)

    def sqrt(self) -> "TaylorModel":
        """Return √a = q + s with the truncated root q. The error s = (a − q² − s²)/(2 q) is bounded by a contraction.

        With k = |1/q| and d = |a − q²| the bound σ satisfies σ = k (d + σ²)/2 and k σ < 1.
        """
        if not _constant(self, "a root's argument") > 0:
            raise RemainderError("a root's argument is not proved to be positive")
        q = _poly(self.series().sqrt())
        k = TaylorModel(q, ZERO, self.n).inverse().norm
        d = beyond(q * q, self.n) + self.remainder
        return TaylorModel(q, k * d / (1 + _margin(1 - k * k * d).sqrt()), self.n)

    def exp(self) -> "TaylorModel":
        """Return exp(a + e) = (q + s) exp(e), where s' = a' s + (a' q − q'); the norm is at most exp(a_0 + |a − a_0|)."""
        q = _poly(self.series().exp())
        slope = self.poly.derivative()
        remainder = (self.poly[0] + _norm(self.poly - arb_poly([self.poly[0]])) + self.remainder).exp()
        margin = 1 - _norm(slope) / (self.n + 1)
        if margin > 0:
            s = beyond(slope * q, self.n - 1) / self.n / margin
            remainder = remainder.min(s + (_norm(q) + s) * self.remainder.expm1())
        return TaylorModel(q, upper(remainder), self.n)

    def sin_cos(self) -> tuple["TaylorModel", "TaylorModel"]:
        """Return sine and cosine from (S, C)' = a' (C, −S), then sin(a + e) = S cos e + C sin e."""
        n, slope = self.n, self.poly.derivative()
        pair = [_poly(q) for q in self.series().sin_cos()]
        sizes = [_norm(q) for q in pair]
        s = max_of([beyond(slope * q, n - 1) for q in pair]) / n
        s /= _margin(1 - _norm(slope) / (n + 1))
        rise, turn = self.remainder.cosh() - 1, self.remainder.sinh()
        sine, cosine = sizes[0] + s, sizes[1] + s
        sine_model = TaylorModel(pair[0], s + sine * rise + cosine * turn, n)
        return sine_model, TaylorModel(pair[1], s + cosine * rise + sine * turn, n)

    def by_slope(self, name: str, slope: "TaylorModel") -> "TaylorModel":
        """Return the function g(a + e) = g(a_0) + ∫ a' g'(a) ds + e ∫ g'(a + θ e) dθ from its derivative `slope`."""
        q = _poly(getattr(self.series(), name)())
        rate = self.poly.derivative()
        high = beyond(rate * slope.poly, self.n - 1) + _norm(rate) * slope.remainder
        return TaylorModel(q, high / self.n + self.remainder * slope.norm, self.n)


def _norm(poly: Any) -> Ball:
    """Return an upper bound of the sum of the coefficients' absolute values."""
    return upper(sum(map(abs, poly.coeffs()), ZERO))


def beyond(poly: Any, n: int) -> Ball:
    """Return the norm of those terms of a polynomial that have powers from s^n on."""
    return _norm(poly.right_shift(n)) if poly.length() > n else ZERO


def _constant(a: TaylorModel, what: str) -> Ball:
    """Return the value at s = 0, which must not be zero. Raises RemainderError if it can be zero."""
    value = a.poly[0]
    if not (value > 0 or value < 0):
        raise RemainderError(f"{what} is not proved to be nonzero")
    return value


def _margin(x: Ball) -> Ball:
    """Return x, which is positive if a map is a contraction. Raises RemainderError if it is not proved to be positive."""
    if not x > 0:
        raise RemainderError("the series does not converge over the step")
    return x


def _poly(series: Any) -> Any:
    return arb_poly(list(series))


def _number(text: str) -> Ball:
    if text == "pi":
        return arb.pi()
    above, _, below = text.partition("/")
    return arb(int(above)) / int(below or 1)


def series_values(tape: Tape, arguments: Sequence[Any]) -> list[Any]:
    """Return the outputs of a tape for arguments that are truncated series or numbers."""
    results: list[Any] = []
    for name, *on in tape.operations:
        if name == "argument":
            results.append(arguments[on[0]])
        elif name == "number":
            results.append(_number(on[0]))
        elif name == "add":
            results.append(results[on[0]] + results[on[1]])
        elif name == "subtract":
            results.append(results[on[0]] - results[on[1]])
        elif name == "multiply":
            results.append(results[on[0]] * results[on[1]])
        elif name == "divide":
            results.append(results[on[0]] / results[on[1]])
        else:
            results.append(getattr(results[on[0]], name)())
    return [results[place] for place in tape.outputs]


class Evaluation:
    """The values of a tape for Taylor models, and reverse-mode derivatives of its outputs."""

    def __init__(self, tape: Tape, arguments: Sequence[TaylorModel]) -> None:
        self.tape, self._arguments = tape, arguments
        self.values: list[TaylorModel] = []
        self._slopes: dict[int, TaylorModel] = {}  # derivatives of unary operations
        self._twins: dict[int, tuple[TaylorModel, TaylorModel]] = {}
        self._inverses: dict[int, TaylorModel] = {}
        for place, (name, *on) in enumerate(tape.operations):
            if name == "argument":
                self.values.append(arguments[on[0]])
            elif name == "number":
                self.values.append(self.fixed(_number(on[0])))
            else:
                self.values.append(self._value(place, name, on))

    @property
    def outputs(self) -> list[TaylorModel]:
        return [self.values[place] for place in self.tape.outputs]

    def fixed(self, value: Ball) -> TaylorModel:
        return TaylorModel(arb_poly([value]), ZERO, self._arguments[0].n)

    def _value(self, place: int, name: str, on: list[int]) -> TaylorModel:
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

    def _inverse(self, operand: int) -> TaylorModel:
        if operand not in self._inverses:
            self._inverses[operand] = self.values[operand].inverse()
        return self._inverses[operand]

    def _function(self, place: int, name: str, operand: int, a: TaylorModel) -> TaylorModel:
        unit = self.fixed(arb(1))
        if name in ("sin", "cos"):
            if operand not in self._twins:
                self._twins[operand] = a.sin_cos()
            sine, cosine = self._twins[operand]
            self._slopes[place] = cosine if name == "sin" else -sine
            return sine if name == "sin" else cosine
        if name == "exp":
            value = self._slopes[place] = a.exp()
            return value
        if name == "sqrt":
            value = a.sqrt()
            self._slopes[place] = (value + value).inverse()
            return value
        if name == "log":
            if not _constant(a, "a logarithm's argument") > 0:
                raise RemainderError("a logarithm's argument is not proved to be positive")
            slope = self._inverse(operand)
        elif name == "asin":
            slope = (unit - a * a).sqrt().inverse()
        else:
            slope = (unit + a * a).inverse()
        self._slopes[place] = slope
        return a.by_slope(name, slope)

    def gradient(self, output: int) -> list[TaylorModel | None]:
        """Return the derivatives of one output with respect to each argument; None for an argument without influence."""
        place = self.tape.outputs[output]
        adjoints: dict[int, TaylorModel] = {place: self.fixed(arb(1))}
        derivatives: list[TaylorModel | None] = [None] * len(self.tape.arguments)
        for k in range(place, -1, -1):
            if k not in adjoints:
                continue
            g = adjoints.pop(k)
            name, *on = self.tape.operations[k]
            if name == "argument":
                derivatives[on[0]] = g
            elif name != "number":
                for operand, term in self._parts(k, name, on, g):
                    if self.tape.operations[operand][0] != "number":
                        adjoints[operand] = adjoints[operand] + term if operand in adjoints else term
        return derivatives

    def _parts(self, k: int, name: str, on: list[int], g: TaylorModel) -> list[tuple[int, TaylorModel]]:
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
