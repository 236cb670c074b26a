"""Numbers that are given as arrays, checked: what makes no sense is refused with its value, the reason and the way out."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError

Array = NDArray[np.float64]


def finite_array(
    where: str, values: ArrayLike, shape: tuple[int, ...] | None = None, kind: type = float
) -> NDArray[Any]:
    """A copy of what is given as an array of finite numbers, of a shape if one is said (−1: any length but none).

    Raises InputError where it is none.
    """
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
    """Real numbers as they are given; None for texts, dates, complex numbers, truths and what else is none."""
    try:
        plain = np.asarray(values)
        listed = values if isinstance(values, list | tuple) else plain.flat if plain.dtype.kind == "O" else ()
        if plain.dtype.kind not in "iufO" or any(isinstance(e, str | bool) for e in listed):
            return None
        return np.asarray(plain, dtype=float)
    except (TypeError, ValueError):
        return None


def increasing_array(where: str, values: ArrayLike, what: str = "numbers") -> Array:
    """Increasing finite numbers (n,), n > 0. Raises InputError for anything else."""
    numbers, text = real_array(values), repr(values)
    text = text if len(text) < 60 else f"{text[:57]}…"
    if numbers is None:
        raise InputError(f"{where} = {text} must be an array of {what}")
    if numbers.ndim != 1 or not len(numbers) or not np.isfinite(numbers).all() or (np.diff(numbers) <= 0).any():
        raise InputError(f"{where} = {text} must be an increasing array of finite {what}: np.linspace(0, 10, 101)")
    return numbers


def check_times(where: str, times: ArrayLike) -> Array:
    """Increasing finite times in s (n,). Raises InputError for anything else."""
    return increasing_array(f"{where}: t", times, "times")
