"""A bound on the work of a decision, counted in parts of the expressions that are looked at: the same on every machine."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from typing import Any

import sympy as sp

from lagrotor.algebra.scalar import parts
from lagrotor.errors import WorkError

_LEFT: ContextVar[list[int] | None] = ContextVar("left", default=None)


_KEPT: list[Any] = []


def kept(most: int) -> Callable[[Callable[..., Any]], Any]:
    """lru_cache of what `spend` counts: `at_most` begins without it, so that what is too large depends on nothing before."""

    def with_cache(function: Callable[..., Any]) -> Any:
        _KEPT.append(lru_cache(maxsize=most)(function))
        return _KEPT[-1]

    return with_cache


@contextmanager
def at_most(work: int) -> Iterator[None]:
    """Decisions within raise WorkError, and are not kept, where they need more work; without it none does."""
    for each in _KEPT:
        each.cache_clear()
    token = _LEFT.set([work])
    try:
        yield
    finally:
        _LEFT.reset(token)


def spend(e: sp.Expr, squared: bool = False) -> None:
    """Count a look at an expression: its parts; their square where it is reduced."""
    _charge(e, parts, 2 if squared else 1)


def spend_on_products(e: sp.Expr, factored: bool = False) -> None:
    """Count what is multiplied out over one denominator: its parts; their square where it is factored."""
    _charge(e, lambda e: max(parts(e), multiplied_out(e)), 2 if factored else 1)


def factored(e: sp.Expr) -> sp.Expr:
    """The product of its factors, which is counted before they are sought."""
    spend_on_products(e, factored=True)
    return sp.factor(e)


def _charge(e: sp.Expr, size: Callable[[sp.Expr], int], power: int) -> None:
    left = _LEFT.get()
    if left is not None:
        left[0] -= size(e) ** power
        if left[0] < 0:
            raise WorkError("it is too large")


def multiplied_out(e: sp.Expr) -> int:
    """A bound on the letters printed where e, and what stands in its functions, is multiplied out over one denominator."""
    sizes: dict[sp.Expr, tuple[int, int, dict[sp.Expr, int]]] = {}
    total = 0

    def size(node: sp.Expr) -> tuple[int, int, dict[sp.Expr, int]]:
        """Terms and degree of the numerator; the sums in the denominator with their powers."""
        if node not in sizes:
            sizes[node] = sought(node)
        return sizes[node]

    def product(terms: int, degree: int, sums: dict[sp.Expr, int]) -> tuple[int, int]:
        for base, k in sums.items():
            more, of, _ = size(base)
            terms, degree = terms * _power(more, k), degree + k * of
        return terms, degree

    def sought(node: sp.Expr) -> tuple[int, int, dict[sp.Expr, int]]:
        nonlocal total
        if node.is_Mul:
            terms, degree, under = 1, 0, dict[sp.Expr, int]()
            for n, k, sums in map(size, node.args):
                terms, degree = terms * n, degree + k
                under = {base: under.get(base, 0) + sums.get(base, 0) for base in {**under, **sums}}
            return terms, degree, under
        if node.is_Add:
            each = [size(part) for part in node.args]
            under = {}
            for _, _, sums in each:
                under = {base: max(under.get(base, 0), sums.get(base, 0)) for base in {**under, **sums}}
            over = [product(n, k, {b: m - sums.get(b, 0) for b, m in under.items()}) for n, k, sums in each]
            return sum(n for n, _ in over), max(k for _, k in over), under
        if node.is_Pow and node.exp.is_Integer:
            n, k, sums = size(node.base)
            power = abs(int(node.exp))
            if node.exp > 0:
                return _power(n, power), k * power, {base: m * power for base, m in sums.items()}
            return (*product(1, 0, {base: m * power for base, m in sums.items()}), {node.base: power})
        inner = [
            size(part) for part in node.args if isinstance(part, sp.Expr)
        ]  # of a function, which is a letter itself
        total += sum(n * k for n, k, _ in inner)
        return 1, 0 if node.is_number else 1, {}

    terms, degree, under = size(e)
    return total + terms * degree + math.prod(_power(size(base)[0], k) for base, k in under.items()) - 1


def _power(terms: int, k: int) -> int:
    """The terms of a power of a sum, of which none agree."""
    return terms if terms < 2 else math.comb(terms + min(k, 10**4) - 1, min(k, 10**4))
