"""A bound on the work of a decision, counted in function calls of the interpreter."""

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
    """The budget is used up. This is a BaseException, so that no handler of general errors catches it on the way."""


def bounded_cache(maxsize: int) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator like `lru_cache`; `at_most` clears the cache, so that the count is independent of earlier decisions."""

    def with_cache(function: Callable[..., Any]) -> Any:
        _CACHES.append(lru_cache(maxsize=maxsize)(function))
        return _CACHES[-1]

    return with_cache


class Calls:
    """A number of function calls that several pieces of work share."""

    def __init__(self, limit: float) -> None:
        self.remaining, self.begun = limit, False


def at_most(calls: "int | Calls", work: Callable[..., _Result], *arguments: Any) -> _Result:
    """Return work(*arguments), or raise WorkError once it has made more function calls than allowed.

    Calls in sympy and of built-in functions count, too. The count is the same on all machines with the same Python and sympy,
    up to 0.1 %, which depends on the order of sets. A single call with numbers of many digits or polynomials of high degree may
    still be long. Counting doubles the time. Under a profiler, which counts calls itself, there is no bound.
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
        if remaining < 0 and not frame.f_code.co_flags & CO_GENERATOR:  # closing a generator loses an error
            sys.settrace(count)  # a bare `except:` in mpmath catches this error; the next call raises it again
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
