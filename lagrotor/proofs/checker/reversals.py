"""Reversals: f(S x) = −S f(x) for signs S of the states, decided on the tape of f.

The identity is treated as one of rational functions. Their variables are the arguments, π, and functions of these. The rules
are: sin, asin and atan are odd, sin² + cos² = 1, e^(a+b) = e^a e^b, and √a and e^(n log a) are powers of a. The identity is
evaluated modulo a 512-bit prime at one point; a digest of the tape determines both. Every radicand has a square root at this
point, and both signs of up to four roots are tested. If a tape has more roots, they are variables, and fewer identities are
recognized.

A false identity holds at the point with a probability of at most its degree divided by the prime (Schwartz and Zippel), here
below 2⁻²⁵⁰. A true identity that needs further rules is rejected. The laws of roots and logarithms hold for positive arguments.
An argument that must be positive at S x must therefore also have to be positive at x, on the motion.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from functools import lru_cache
from hashlib import sha512
from math import floor, gcd
from typing import Any, NamedTuple

from sympy import nextprime

from lagrotor.proofs.checker.tapes import Tape, demand, results_of

Terms = Mapping[int, Fraction]
_DEGREE = 2**256
_PARTS = 5040
_ODD = 315  # every residue has one root of each order that divides it
_MOST_ROOTS, _MOST_TRIES, _OF_ONE_PRIME = 4, 256, 64


class Residue(NamedTuple):
    """A result modulo the prime, a bound of its degree, and for exponentials a linear form {variable: coefficient}."""

    value: int
    degree: int
    terms: Terms


def check_reversal(tape: Tape, signs: Any) -> None:
    """Verify f(S x) = −S f(x) for the signs ±1 of the states x."""
    fits = len(signs) == len(tape["outputs"]) and all(type(s) is int and abs(s) == 1 for s in signs)
    demand(fits, "a reversal needs a sign 1 or −1 for each state")
    for residues in points_of(tape):
        rates = residues.outputs([1] * len(signs))
        followed = len(residues.domain)
        stays, images = False, list[Residue]()
        with suppress(NoSquareError):  # a new radicand is no square
            images = residues.outputs(signs)
            stays = len(residues.domain) == followed
        demand(stays, "the reversed motion may leave the domain of its roots and logarithms")
        for s, a, b in zip(signs, rates, images, strict=True):
            demand(
                (s * a.value + b.value) % residues.p == 0,
                "the reversed motion does not satisfy the equations of motion",
            )


class NoSquareError(Exception):
    """A radicand has no square root modulo the prime at a point."""


def points_of(tape: Tape) -> Iterator["Residues"]:
    """Yield the tape at one point modulo a prime, once for each choice of the signs of its roots.

    Every root exists there. For a tape with too many roots, the only point has variables in place of the roots.
    """
    variables = Residues(tape, None)
    variables.outputs([])
    for attempt in range(_MOST_TRIES if variables.roots <= _MOST_ROOTS else 0):
        with suppress(NoSquareError):
            for signs in range(2**variables.roots):
                Residues(tape, attempt, signs).outputs([])
            yield from (Residues(tape, attempt, signs) for signs in range(2**variables.roots))
            return
    yield Residues(tape, None)


@lru_cache(maxsize=64)
def _prime(seed: str) -> int:
    """Return a prime of about 512 bits for a seed, modulo which −1 has no square root and odd roots are unique."""
    p = int(nextprime(int(sha512(seed.encode()).hexdigest(), 16)))
    while not (p % 4 == 3 and gcd(p - 1, _ODD) == 1):
        p = int(nextprime(p))
    return p


class Residues:
    """The results of a tape modulo a prime.

    `attempt` is the number of the point, None if roots are variables. Each bit of `signs` is the sign of a root.
    """

    def __init__(self, tape: Tape, attempt: int | None, signs: int = 0) -> None:
        self.tape, self._digest = tape, sha512(f"{tape} {attempt}".encode()).hexdigest()
        self.p = _prime(f"{tape} {(attempt or 0) // _OF_ONE_PRIME}")
        self._signs = None if attempt is None else signs
        self._roots: dict[int, int] = {}  # of radicands, by the variable of the logarithm
        self._logarithms: dict[int, Terms] = {}  # of exponentials and of arguments of logarithms and roots
        # Of a product: the logarithm of one factor, the other factor, its power.
        self._halves: dict[int, tuple[Terms, Residue, int]] = {}
        self._arguments: dict[int, Residue] = {}  # of logarithms, by variable
        self.domain: set[tuple[str, int]] = set()  # arguments that must be positive, or in [−1, 1]

    def outputs(self, signs: list[int]) -> list[Residue]:
        """Return the outputs of the tape, after its first arguments were multiplied by `signs`."""

        def argument(place: int) -> Residue:
            return self._variable(self._point("argument", place) * (signs[place] if place < len(signs) else 1))

        def number(x: str) -> Residue:
            return self._variable(self._point(x)) if x == "pi" else self._number(Fraction(x))

        results = results_of(self.tape, argument, number, self._result)
        demand(max(x.degree for x in results) < _DEGREE, "the degree of the motion is too large to decide a reversal")
        return [results[place] for place in self.tape["outputs"]]

    def _point(self, *of: Any) -> int:
        return int(sha512(f"{self._digest} {of}".encode()).hexdigest(), 16) % self.p

    def _variable(self, value: int, degree: int = 1) -> Residue:
        value %= self.p
        least = min(value, self.p - value)
        return Residue(value, degree, {least: Fraction(1 if least == value else -1)})

    def _number(self, x: Fraction) -> Residue:
        size = x.numerator.bit_length() + x.denominator.bit_length()  # as a degree: a random prime divides it as rarely
        return Residue(x.numerator * pow(x.denominator, -1, self.p) % self.p, size, {1: x} if x else {})

    def _result(self, name: str, *on: Residue) -> Residue:
        if name in ("add", "subtract"):
            return self._sum(on[0], on[1], 1 if name == "add" else -1)
        if name in ("multiply", "divide"):
            return self._product(on[0], on[1], 1 if name == "multiply" else -1)
        (a,) = on
        if name == "asin":
            self.domain.add((name, min(a.value, self.p - a.value)))
        if name == "exp":
            return self._exponential(a.terms)
        if name == "sqrt":
            return self._exponential({variable: x / 2 for variable, x in self._logarithm(a).items()})
        if name == "log":
            if a.value not in self._logarithms:
                self.domain.add(("positive", a.value))
            (variable,) = self._variable(self._point("log", a.value)).terms
            self._arguments[variable], self._logarithms[a.value] = a, {variable: Fraction(1)}
            return self._variable(variable)
        least = min(a.value, self.p - a.value)
        sign, point = 1 if least == a.value else -1, self._point("sin" if name == "cos" else name, least)
        if name not in ("sin", "cos"):
            return self._variable(sign * point)
        below = pow(1 + point**2, -1, self.p)  # by the tangent of half the angle
        return self._variable((2 * sign * point if name == "sin" else 1 - point**2) * below, 2)

    def _logarithm(self, a: Residue) -> Terms:
        """Return the logarithm of a radicand, which is positive; hence its one factor of unknown sign is positive, too."""
        if a.value not in self._logarithms:
            logarithm, factor, power = self._halves.get(a.value, ({}, a, 1))
            if factor.value not in self._logarithms:
                self._result("log", factor)
            self._logarithms[a.value] = _combine(logarithm, self._logarithms[factor.value], power)
        return self._logarithms[a.value]

    def _sum(self, a: Residue, b: Residue, sign: int) -> Residue:
        return Residue((a.value + sign * b.value) % self.p, a.degree + b.degree, _combine(a.terms, b.terms, sign))

    def _product(self, a: Residue, b: Residue, power: int) -> Residue:
        value, degree = a.value * pow(b.value, power, self.p) % self.p, a.degree + abs(power) * b.degree
        first, second = (self._logarithms.get(x.value) for x in (a, b))
        if first is not None and second is not None:
            self._logarithms[value] = _combine(first, second, power)
        elif first is not None:
            self._halves[value] = first, b, power
        elif second is not None:
            self._halves[value] = _combine({}, second, power), a, 1
        if not {*b.terms} - {1}:
            factor = b.terms.get(1, Fraction(0)) ** power
            return Residue(value, degree, {variable: factor * x for variable, x in a.terms.items() if factor})
        if power == 1 and not {*a.terms} - {1}:
            return self._product(b, a, 1)
        return self._variable(value, degree)

    def _exponential(self, terms: Terms) -> Residue:
        """Return e^Σ of a linear form Σ. A term x a gives the power 5040 x of e^(a/5040), a term x log a the power x of a.

        A fractional rest of the exponent is a variable of its own.
        """
        product = self._number(Fraction(1))
        for variable, x in terms.items():
            of_log = variable in self._arguments
            base = self._arguments[variable] if of_log else self._variable(self._point("exp", variable))
            y = x if of_log else x * _PARTS
            product = self._product(product, base, floor(y))
            if y != floor(y):
                root = self._root(variable, base, y - floor(y)) if of_log else None
                factor = root or self._variable(self._point("exp", variable, str(y - floor(y))))
                product = self._product(product, factor, 1)
        self._logarithms[product.value] = terms
        return product

    @property
    def roots(self) -> int:
        return len(self._roots)

    def _root(self, variable: int, a: Residue, power: Fraction) -> Residue | None:
        """Return a^power if it exists modulo the prime, else None. A bit gives the sign of √a; odd roots are unique."""
        odd = power.denominator if power.denominator % 2 else power.denominator // 2
        if odd != power.denominator and self._signs is None:
            self._roots[variable] = 0
        if self._signs is None or _ODD % odd:
            return None
        value = a.value
        if odd != power.denominator:
            if variable not in self._roots:
                place, root = len(self._roots), pow(value, (self.p + 1) // 4, self.p)
                self._roots[variable] = self.p - root if self._signs >> place & 1 else root
            value = self._roots[variable]
            if value * value % self.p != a.value:
                raise NoSquareError
        whole = power.numerator * pow(odd, -1, self.p - 1) % (self.p - 1)
        return self._variable(pow(value, whole, self.p), a.degree + 1)


def _combine(a: Terms, b: Terms, times: int) -> Terms:
    total = {variable: a.get(variable, Fraction(0)) + times * b.get(variable, Fraction(0)) for variable in {**a, **b}}
    return {variable: x for variable, x in total.items() if x}
