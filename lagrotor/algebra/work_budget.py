"""A bound on the work of a decision, counted in calls of functions as the interpreter makes them."""

import math
import sys
from collections.abc import Callable
from functools import lru_cache
from inspect import CO_GENERATOR
from types import FrameType
from typing import Any, TypeVar

from sympy.core.cache import clear_cache

from lagrotor.errors import WorkError

_Result = TypeVar("_Result")
_CACHES: list[Any] = []


class _Exhausted(BaseException):
    """No error: what catches every error on the way must not go on."""


def bounded_cache(maxsize: int) -> Callable[[Callable[..., Any]], Any]:
    """lru_cache that `at_most` begins without, so that what is too large depends on nothing decided before."""

    def with_cache(function: Callable[..., Any]) -> Any:
        _CACHES.append(lru_cache(maxsize=maxsize)(function))
        return _CACHES[-1]

    return with_cache


class Calls:
    """What several pieces of work may call together."""

    def __init__(self, limit: float) -> None:
        self.remaining, self.begun = limit, False


def at_most(calls: "int | Calls", work: Callable[..., _Result], *arguments: Any) -> _Result:
    """work(*arguments); raise WorkError as soon as it has called more functions, here, in sympy or built in.

    calls: of this work, or what is left of them for this one and the next.

    The count is one of the program, not of the machine: with the same Python and sympy it is the same everywhere, but for
    parts in a thousand (the order of sets). One call may still be long on numbers of many digits or polynomials of large
    degree, which are to be refused before. Counting takes as long again as what is counted. Under a profiler, which counts
    calls itself, there is no bound.
    """
    if sys.getprofile() is not None:
        return work(*arguments)
    shared = calls if isinstance(calls, Calls) else Calls(calls)
    if not shared.begun:
        clear_cache()
        for cache in _CACHES:
            cache.cache_clear()
    remaining, shared.begun = shared.remaining, True
    tracer = sys.gettrace()

    def count(frame: FrameType, event: str, argument: Any) -> None:
        nonlocal remaining
        remaining -= 1
        if remaining < 0 and not frame.f_code.co_flags & CO_GENERATOR:  # where one is closed an error is lost
            sys.settrace(count)  # mpmath has `except:`, which holds this one; the next call ends it
            raise _Exhausted

    sys.setprofile(count)
    try:
        return work(*arguments)
    finally:
        is_exhausted, shared.remaining, remaining = remaining < 0, remaining, math.inf
        sys.setprofile(None)
        if is_exhausted:
            sys.settrace(tracer)
            raise WorkError("it is too large") from None
