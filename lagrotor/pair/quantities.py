"""Check the numbers and vectors that users give; a refusal names the value, the reason and the remedy."""

from collections.abc import Iterable
from math import isfinite, nan

from lagrotor.errors import InputError

Vector = tuple[float, float, float]
Spins = tuple[float, float]  # axial angular velocities of the two rotors, rad/s
SMALLEST, _LARGEST = 1e-60, 1e60  # magnitudes whose fifth powers are still doubles


def finite_number(value: object, where: str, unit: str) -> float:
    """Return a value as a float; raise InputError unless it is a finite number of size at most _LARGEST."""
    try:
        number = nan if isinstance(value, str | bytes) else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{where} = {value!r} is not a number: give it in {unit}") from None
    if isinstance(value, bool) or not isfinite(number):
        raise InputError(f"{where} = {value!r} is not a finite number: give it in {unit}")
    if abs(number) > _LARGEST:
        raise InputError(
            f"{where} = {number:g} {unit} is beyond {_LARGEST:g}, where squares overflow; change the units"
        )
    return number


def not_vanishing(value: object, where: str, unit: str) -> float:
    """Return a value as a float; raise InputError unless it is zero or of a size between SMALLEST and _LARGEST."""
    number = finite_number(value, where, unit)
    if 0 < abs(number) < SMALLEST:
        raise InputError(f"{where} = {number:g} {unit} is below {SMALLEST:g}, where squares vanish; change the units")
    return number


def positive(value: object, where: str, unit: str) -> float:
    """Return a value as a float; raise InputError unless it is positive, between SMALLEST and _LARGEST."""
    number = finite_number(value, where, unit)
    if number <= 0:
        raise InputError(f"{where} = {number:g} {unit} must be greater than zero: give a positive number")
    return not_vanishing(number, where, unit)


def not_negative(value: object, where: str, unit: str) -> float:
    number = finite_number(value, where, unit)
    if number < 0:
        raise InputError(f"{where} = {number:g} {unit} must not be negative: give 0 or more")
    return number


def numbers(value: object, count: int, where: str, unit: str) -> tuple[float, ...]:
    """Return a sequence as a tuple of floats; raise InputError unless it has `count` finite numbers."""
    items = list(value) if isinstance(value, Iterable) and not isinstance(value, str) else None
    if items is None or len(items) != count:
        raise InputError(f"{where} = {value!r} must be {count} numbers in {unit}")
    return tuple(finite_number(item, f"{where}[{i}]", unit) for i, item in enumerate(items))


def finite_vector(value: object, where: str, unit: str) -> Vector:
    x, y, z = numbers(value, 3, where, unit)
    return x, y, z


def two_vectors(value: object, where: str, unit: str) -> tuple[Vector, Vector]:
    """Return two vectors of three finite numbers, one vector for each rotor; raise InputError for anything else."""
    items = list(value) if isinstance(value, Iterable) and not isinstance(value, str) else []
    if len(items) != 2:
        raise InputError(f"{where} = {value!r} must be two vectors, one for each rotor")
    return finite_vector(items[0], f"{where}[0]", unit), finite_vector(items[1], f"{where}[1]", unit)
