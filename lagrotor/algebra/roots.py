"""Square roots as generators: a maximal independent set, and the other roots in terms of it.

For B = N/D, a quotient of polynomials with rational coefficients, h = D*sqrt(B) has the square A = N*D.  Adjoining the roots h
of A_1, ..., A_k to the rational functions gives a field of degree 2**k if and only if no product of some of the A is a square
(Kummer theory; S. Lang, Algebra, VI.8).  Every A is written as a product of powers of pairwise coprime integers and polynomials,
none of them a square, by greatest common divisors without factoring integers.  A product is then a square if and only if all
its exponents are even.

If A*prod(A_k) = p**2, the root is sqrt(B) = sign*p*prod(h_k)/(D*prod(A_k)) with a sign +1 or -1 that may differ from region to
region: sqrt(x**2) is x or -x.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import gcd, isqrt, prod
from typing import Any, NamedTuple

import sympy as sp
from sympy.polys.rings import PolyElement

from lagrotor.algebra.quotients import Ring
from lagrotor.errors import TooLargeError

# Greatest common divisors of larger polynomials may take hours.
_MOST_TERMS, _MOST_DEGREE = 60, 16


class Root(NamedTuple):
    """A square root with sqrt(base) = h/denominator, where h is a generator of the ring and h**2 = square, a polynomial."""

    base: sp.Expr
    denominator: PolyElement
    square: PolyElement


class Dependent(NamedTuple):
    """A square root that other roots determine: sqrt(base) = ± numerator/denominator * product of h for the roots in `of`."""

    base: sp.Expr
    numerator: PolyElement
    denominator: PolyElement
    of: tuple[Root, ...]


def split_roots(
    ring: Ring, bases: Iterable[tuple[sp.Expr, PolyElement, PolyElement]]
) -> tuple[list[Root], list[Dependent]]:
    """Divide roots into independent and dependent ones; a root is given by (base, numerator, denominator)."""
    roots = [Root(base, under, ring.product(over, under)) for base, over, under in bases]
    for root in roots:
        if len(root.square) > _MOST_TERMS or max(map(sum, root.square.monoms()), default=0) > _MOST_DEGREE:
            raise TooLargeError(f"The root of {root.base} is too large: its square has {len(root.square)} terms.")
    numbers, polynomials = _coprime_parts([root.square for root in roots])
    independent: list[Root] = []
    dependent: list[Dependent] = []
    rows: list[tuple[int, int]] = []  # (parities of a product of independent squares, its members), as bits
    for root in roots:
        if not root.square:
            dependent.append(Dependent(root.base, ring.polynomials.zero, ring.one, ()))
            continue
        exponents, members = _exponents(root.square, numbers, polynomials), 0
        parity = sum((n % 2) << place for place, n in enumerate(exponents))
        for row, row_members in rows:
            if parity ^ row < parity:
                parity, members = parity ^ row, members ^ row_members
        if parity:
            rows.append((parity, members | 1 << len(independent)))
            rows.sort(reverse=True)
            independent.append(root)
        else:
            of = tuple(basis_root for place, basis_root in enumerate(independent) if members >> place & 1)
            dependent.append(_expressed(ring, root, of, numbers, polynomials))
    return independent, dependent


def _coprime_parts(squares: Iterable[PolyElement]) -> tuple[list[int], list[PolyElement]]:
    """Return pairwise coprime integers and polynomials, none of them a square.

    Each of the given polynomials is a product of their powers, up to its sign and the square of a rational number.
    """
    numbers, polynomials = [], []
    for square in filter(None, squares):
        numbers.append(abs(_content(square)))
        polynomials += [factor.monic() for factor, _ in square.sqf_list()[1]]
    return (
        _refined([_rootless(n) for n in numbers], gcd, lambda a, b: a // b, lambda n: n == 1, _rootless),
        _refined(polynomials, lambda a, b: a.gcd(b).monic(), lambda a, b: a.exquo(b), lambda p: p.is_ground),
    )


def _refined(
    values: list[Any],
    common: Callable[[Any, Any], Any],
    divided: Callable[[Any, Any], Any],
    is_unit: Callable[[Any], bool],
    rootless: Callable[[Any], Any] = lambda value: value,
) -> list[Any]:
    """Split values by common divisors until they are pairwise coprime."""
    coprime: list[Any] = []
    while values:
        value = rootless(values.pop())
        if is_unit(value) or value in coprime:
            continue
        for place, member in enumerate(coprime):
            shared = common(value, member)
            if not is_unit(shared):
                del coprime[place]
                values += [shared, divided(value, shared), divided(member, shared)]
                break
        else:
            coprime.append(value)
    return coprime


def _rootless(number: int) -> int:
    """Take the square root of an integer as often as the result is an integer."""
    while number > 1 and isqrt(number) ** 2 == number:
        number = isqrt(number)
    return number


def _content(square: PolyElement) -> int:
    """Return an integer that equals the leading coefficient of a polynomial times the square of a rational number."""
    return int(square.LC.numerator) * int(square.LC.denominator)


def _exponents(square: PolyElement, numbers: list[int], polynomials: list[PolyElement]) -> list[int]:
    """Return a polynomial's exponents: 0 or 1 for its sign, then the multiplicity of each number and each polynomial."""
    content, exponents = _content(square), [int(square.LC < 0)]
    for number in numbers:
        exponents.append(0)
        while content % number == 0:
            content, exponents[-1] = content // number, exponents[-1] + 1
    for polynomial in polynomials:
        exponents.append(0)
        while not (division := square.div(polynomial))[1]:
            square, exponents[-1] = division[0], exponents[-1] + 1
    return exponents


def _expressed(
    ring: Ring, root: Root, of: tuple[Root, ...], numbers: list[int], polynomials: list[PolyElement]
) -> Dependent:
    """Return the root in terms of the roots in `of`; its square times their squares is the square of a polynomial p."""
    squares = [root.square, *(basis_root.square for basis_root in of)]
    halves = [sum(n) // 2 for n in zip(*(_exponents(s, numbers, polynomials) for s in squares), strict=True)]
    content = prod((sp.Rational(int(s.LC.numerator), int(s.LC.denominator)) for s in squares), start=sp.S.One)
    p = ring.number(sp.Rational(isqrt(content.p), isqrt(content.q))).numerator
    for polynomial, times in zip(polynomials, halves[1 + len(numbers) :], strict=True):
        p = ring.product(p, ring.power(polynomial, times))
    numerator, denominator = p.cancel(ring.products(basis_root.square for basis_root in of))
    return Dependent(root.base, numerator, ring.product(denominator, root.denominator), of)
