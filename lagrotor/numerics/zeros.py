"""All zeros of smooth functions on an interval, from their Chebyshev series: no zero between two samples is missed.

A function is sampled at Chebyshev's nodes; where the last coefficients are not small, the interval is halved. The zeros of the
series are eigenvalues (Boyd 2002, Computing zeros on a real interval through Chebyshev expansion and polynomial rootfinding).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from lagrotor.numerics.segment import Array

_DEGREE = 16
_NODES = np.cos(np.pi * np.arange(_DEGREE, -1, -1) / _DEGREE)  # from −1 to 1, the ends among them
_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, _DEGREE))  # values at the nodes → coefficients
_FALLEN = 1e-9  # last coefficients over the largest, for a resolved function
_HALVINGS = 8
_SLACK = 1e-7  # of a half interval: a zero at an end belongs to both neighbours, never to neither
_BESIDE_ENDS = np.array([-1 - 2 * _SLACK, 1 + 2 * _SLACK])
_REAL = 1e-6  # imaginary part of a real zero: for a double zero the square root of rounding

Functions = Callable[[Array], Array]  # times (m,) → values (k, m)


@dataclass(frozen=True)
class Zeros:
    """The zeros of k functions on an interval.

    Attributes
    ----------
    t : Array
        The zeros in increasing order, shape (n,).
    index : Array
        The index of the function of each zero, shape (n,).
    direction : Array
        1 for an upward crossing, −1 for a downward one, 0 for a zero that is touched, shape (n,).
    hidden : tuple of float or None
        An interval in which a function is not resolved and zeros may be missing; None if all zeros are known.
    """

    t: Array
    index: Array
    direction: Array
    hidden: tuple[float, float] | None


def zeros_between(
    functions: Functions, lower: float, upper: float, touch: Array | float = 0.0, noise: Array | float = 0.0
) -> Zeros:
    """Find the zeros of k functions in an interval. A turning point within `touch` of zero, a number or shape (k,), counts as a
    zero. The values have the rounding error `noise`, which no halving of the interval resolves."""
    roots: list[tuple[float, int, int]] = []
    hidden = _search(functions, lower, upper, touch, noise, roots, _HALVINGS)
    roots = _distinct(sorted(roots), _SLACK * (upper - lower))
    t, index, direction = (np.array(column) for column in zip(*roots, strict=True)) if roots else (np.zeros(0),) * 3
    return Zeros(t, index.astype(int), direction.astype(int), hidden)


def chebyshev_nodes(edges: Array) -> Array:
    """Return Chebyshev's nodes in each interval between increasing edges (p + 1,), including both ends, shape (p, m)."""
    return edges[:-1, None] + np.diff(edges)[:, None] * (1 + _NODES) / 2


def may_vanish(values: Array, touch: Array | float = 0.0, noise: Array | float = 0.0) -> NDArray[np.bool_]:
    """Return an array (k,) for k functions with values (k, m) at the nodes. An element is True if the function's Chebyshev series
    may have a zero and is not zero everywhere."""
    size = np.abs(values @ _SERIES.T)
    return (size[:, 0] <= size[:, 1:].sum(1) + touch) & (np.abs(values).max(1) > touch + noise)


def interpolant(length: float, values: Array) -> tuple[Callable[[Array], Array], Array]:
    """Return the polynomial through values (m, d) at the nodes of [0, length]. Return also the size of its last coefficients
    (d,), which is small if the polynomial resolves the curve."""
    series = _SERIES @ values

    def curve(times: Array) -> Array:
        angles = np.arccos(np.clip(2 * times / length - 1, -1, 1))
        return np.asarray(np.cos(angles[:, None] * np.arange(len(series))) @ series)

    return curve, np.abs(series[-3:]).sum(0)


def _search(
    functions: Functions,
    lower: float,
    upper: float,
    touch: Array | float,
    noise: Array | float,
    roots: list[tuple[float, int, int]],
    halvings: int,
) -> tuple[float, float] | None:
    middle, half = (lower + upper) / 2, (upper - lower) / 2
    values = functions(middle + half * _NODES)
    series, near = values @ _SERIES.T, may_vanish(values, touch, noise)
    size = np.abs(series)
    falling = size[:, -3:].sum(1) <= _FALLEN * size.max(1) + touch / 10 + noise
    if not (falling | ~near).all() or not np.isfinite(values).all():
        if halvings == 0:
            signs, t = np.sign(values), middle + half * (_NODES[:-1] + _NODES[1:]) / 2
            for row, k in np.argwhere(signs[:, :-1] * signs[:, 1:] < 0).tolist():  # only changes of sign are known
                roots.append((float(t[k]), row, int(signs[row, k + 1])))
            return lower, upper
        ends = [(lower, middle), (middle, upper)]
        hidden = [_search(functions, a, b, touch, noise, roots, halvings - 1) for a, b in ends]
        return next((interval for interval in hidden if interval), None)
    for i in np.flatnonzero(near):
        least = float(touch if np.ndim(touch) == 0 else np.asarray(touch)[i])
        roots += [(middle + half * x, int(i), way) for x, way in _zeros_of(series[i], least)]
    return None


def _zeros_of(series: Array, touch: float) -> list[tuple[float, int]]:
    """Return the zeros of a Chebyshev series as pairs (place in [−1, 1], direction); the direction 0 marks a touched zero."""
    series = np.where(np.abs(series) > 1e-15 * np.abs(series).max(), series, 0.0)
    slope: Array = np.asarray(chebyshev.chebder(series), float)
    if _keeps_its_sign(slope):
        ends = chebyshev.chebval(_BESIDE_ENDS, series)
        if ends[0] * ends[1] > 0:
            return []
    turns = [x for x in _real_roots(slope) if abs(chebyshev.chebval(x, series)) <= touch]
    crossed = []
    for x in _real_roots(series):
        # Two zeros at a turning point are one touched zero if no value between them exceeds `touch`.
        between = (np.abs(chebyshev.chebval(np.linspace(x, turn, 9), series)).max() for turn in turns)
        if not any(largest <= 1.01 * touch for largest in between):
            crossed.append((x, 1 if chebyshev.chebval(x, slope) > 0 else -1))
    return crossed + [(x, 0) for x in turns]


def _keeps_its_sign(series: Array) -> bool:
    """Return True if the constant term outweighs all others, so that there is no zero in [−1, 1] or slightly beyond. There |T_k|
    ≤ cosh(k √(2 · 10⁻⁶))."""
    return bool(abs(series[0]) > 1.001 * np.abs(series[1:]).sum())


def _real_roots(series: Array) -> list[float]:
    trimmed: Array = np.asarray(chebyshev.chebtrim(series, 0.0), float)
    if len(trimmed) < 2 or _keeps_its_sign(trimmed):
        return []
    roots = chebyshev.chebroots(trimmed)
    real = roots[(np.abs(roots.imag) < _REAL) & (np.abs(roots.real) <= 1 + _SLACK)].real
    return sorted(float(x) for x in np.clip(real, -1, 1))


def _distinct(roots: list[tuple[float, int, int]], near: float) -> list[tuple[float, int, int]]:
    """Remove the second of two equal zeros, which neighbouring intervals both found at their common end."""
    unique: list[tuple[float, int, int]] = []
    for t, i, way in roots:
        if not any(j == i and d == way and t - s <= near for s, j, d in unique[-4:]):
            unique.append((t, i, way))
    return unique
