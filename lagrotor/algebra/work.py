"""A bound on the work of a decision, counted in parts of the expressions that are looked at: the same on every machine."""

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


def spend(e: sp.Expr, factored: bool = False) -> None:
    """Count a look at an expression: its parts; their square where it is factored."""
    left = _LEFT.get()
    if left is not None:
        number = parts(e)
        left[0] -= number * number if factored else number
        if left[0] < 0:
            raise WorkError("it is too large")
