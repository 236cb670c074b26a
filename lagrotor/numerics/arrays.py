"""Checks of arrays that a user gives; InputError names the value, the reason and the way out."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError

Array = NDArray[np.float64]


def finite_array(
    where: str, values: ArrayLike, shape: tuple[int, ...] | None = None, kind: type = float
) -> NDArray[Any]:
    """Return a copy of the values as an array of finite numbers, or raise InputError. If a shape is given, the array must have
    it; −1 in a shape stands for every length but zero."""
    try:
        if kind is not complex and np.iscomplexobj(values):
            raise TypeError
        array: NDArray[Any] = np.array(values, dtype=kind)
    except (TypeError, ValueError):
        raise InputError(f"{where} = {values!r} must be numbers{f' of shape {shape}' if shape else ''}") from None
    if shape is not None:
        lengths = zip(array.shape, shape, strict=False)
        if array.ndim != len(shape) or not all(n == m or (m == -1 and n > 0) for n, m in lengths):
            free = " (−1: any number but none)" if -1 in shape else ""
            raise InputError(f"{where} must be numbers of shape {shape}{free}, not {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"{where} = {array.tolist()} must be finite numbers")
    return array


def real_array(values: ArrayLike) -> Array | None:
    """Return the values as an array of real numbers; None if they are texts, dates, complex numbers or truth values."""
    try:
        plain = np.asarray(values)
        listed = values if isinstance(values, list | tuple) else plain.flat if plain.dtype.kind == "O" else ()
        if plain.dtype.kind not in "iufO" or any(isinstance(e, str | bool) for e in listed):
            return None
        return np.asarray(plain, dtype=float)
    except (TypeError, ValueError):
        return None


def increasing_array(where: str, values: ArrayLike, what: str = "numbers") -> Array:
    """Return increasing finite numbers as an array (n,), n > 0, or raise InputError. The message uses `what` as the name of the
    numbers."""
    numbers = real_array(values)
    listed = numbers is not None and numbers.ndim == 1 and len(numbers) > 0 and np.isfinite(numbers).all()
    if numbers is not None and listed and (numbers[1:] > numbers[:-1]).all():
        return numbers
    text = repr(values)
    text = text if len(text) < 60 else f"{text[:57]}…"
    kind = (
        f"an array of {what}" if numbers is None else f"an increasing array of finite {what}: np.linspace(0, 10, 101)"
    )
    raise InputError(f"{where} = {text} must be {kind}")


def check_times(where: str, times: ArrayLike) -> Array:
    """Return increasing finite times in s, shape (n,), or raise InputError."""
    return increasing_array(f"{where}: t", times, "times")
