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
_KEPT: list[Any] = []


class _Spent(BaseException):
    """No error: what catches every error on the way must not go on."""


def kept(most: int) -> Callable[[Callable[..., Any]], Any]:
    """lru_cache that `at_most` begins without, so that what is too large depends on nothing decided before."""

    def with_cache(function: Callable[..., Any]) -> Any:
        _KEPT.append(lru_cache(maxsize=most)(function))
        return _KEPT[-1]

    return with_cache


class Calls:
    """What several pieces of work may call together."""

    def __init__(self, left: float) -> None:
        self.left, self.begun = left, False


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
        for each in _KEPT:
            each.cache_clear()
    left, shared.begun = shared.left, True
    tracer = sys.gettrace()

    def count(frame: FrameType, event: str, argument: Any) -> None:
        nonlocal left
        left -= 1
        if left < 0 and not frame.f_code.co_flags & CO_GENERATOR:  # where one is closed an error is lost
            sys.settrace(count)  # mpmath has `except:`, which holds this one; the next call ends it
            raise _Spent

    sys.setprofile(count)
    try:
        return work(*arguments)
    finally:
        spent, shared.left, left = left < 0, left, math.inf
        sys.setprofile(None)
        if spent:
            sys.settrace(tracer)
            raise WorkError("it is too large") from None
