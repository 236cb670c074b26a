"""Windows of a run, in which something acts briefly by the clock: where a force of t changes fast, and how a run is cut there."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from lagrotor.numerics.arrays import Array

# Beyond |s| = 6.5 widths a pulse exp(−(s/width)²) is below the last bit of its peak: exp(−6.5²) = 4e-19.
PULSE_REACH = 6.5
# Longest step in a window, over that of the run, of its companion: were it 1, both might take the same steps and agree.
COMPANION_STEP = 0.8
_LOOKS = 2**14  # intervals of a run, at whose ends forces of t are looked at
_CELL = 8  # intervals of the smallest cell
_DEGREE = 4  # of the polynomial that a function is in a cell where it is smooth
_SMOOTH = 1e-6  # of its range over the run, to which it is that there
_TAIL, _TAILS = 1e-12, 6  # the same beside a cell where it is not, and in how many cells on each side that is looked at
_OFTEN, _FINER = 0.25, 4  # the part of a run that is no exception, and how much finer than there a window's cells are
_CUT = 10.0  # steps that a cut costs


class Window(NamedTuple):
    """From `begin` to `end` (s) no step is longer than `longest`."""

    begin: float
    end: float
    longest: float


def pulse_windows(width: float, companion: bool = False) -> tuple[Window, ...]:
    """That of a pulse exp(−(s/width)²): within its reach steps are no longer than its width."""
    reach = PULSE_REACH * width
    return windows_since(0.0, (Window(-reach, reach, width),), companion)


def windows_since(begin: float, windows: Sequence[Window], companion: bool = False) -> tuple[Window, ...]:
    """The windows by a clock that shows 0 at the time `begin`."""
    share = COMPANION_STEP if companion else 1.0
    return tuple(Window(a - begin, b - begin, share * longest) for a, b, longest in windows)


def segments(begin: float, end: float, windows: Sequence[Window]) -> Iterator[Window]:
    """A run from begin to end, cut at the edges of windows, which follow each other: the longest step of each part is inf outside
    of them."""
    now = begin
    for window in windows:
        if window.end <= now or window.begin >= end:
            continue
        if window.begin > now:
            yield Window(now, window.begin, inf)
        now = min(window.end, end)
        yield Window(max(begin, window.begin), now, window.longest)
    if now < end:
        yield Window(now, end, inf)


def brief_windows(functions: Callable[[Array], Array], begin: float, end: float) -> tuple[Window, ...]:
    """Where functions of t, times (n,) → values (k, n), change faster than they mostly do from begin to end.

    A cell is smooth if a polynomial of degree 4 is the function there, to 10⁻⁶ of its range. Cells are doubled as long as those
    that are not smooth are the exception; each is a window of steps no longer than itself, or, in the smallest, than the function
    takes to change by all that it does there at its fastest. What changes in a window is taken out before cells are doubled, or
    each would be found again in all larger ones. NaN, where a function has no value, is the value beside it.
    """
    import numpy as np  # here, since a scene needs the reach of a pulse only

    if not begin < end:
        return ()
    times, longest = np.linspace(begin, end, _LOOKS + 1), np.full(_LOOKS, np.inf)
    for values in functions(times):
        np.minimum(longest, _longest_steps(values), out=longest)
    edges = np.flatnonzero(np.concatenate([[True], longest[1:] != longest[:-1], [True]]))
    windows = list[Window]()
    for i, j in pairwise(edges):
        if np.isinf(longest[i]):
            continue
        window = Window(float(times[i]), float(times[j]), float(longest[i]) * (end - begin) / _LOOKS)
        while windows and (both := _one(windows[-1], window)):
            window = both
            windows.pop()
        windows.append(window)
    return tuple(windows)


def _one(first: Window, second: Window) -> Window | None:
    """Two windows as one, where that takes fewer steps than solvers take to begin anew."""
    merged = Window(first.begin, second.end, min(first.longest, second.longest))
    extra_steps = (merged.end - merged.begin) / merged.longest - sum(
        (b - a) / longest for a, b, longest in (first, second)
    )
    return merged if extra_steps <= _CUT * (1 + (second.begin > first.end)) else None


def _longest_steps(values: Array) -> Array:
    """Of one function: in intervals, the longest step in each of them (_LOOKS,), inf where it is smooth."""
    import numpy as np

    longest, finite = np.full(_LOOKS, np.inf), np.flatnonzero(np.isfinite(values))
    if not len(finite):
        return longest
    curve = np.interp(np.arange(_LOOKS + 1), finite, values[finite])
    size, noise = np.ptp(curve), 64 * np.finfo(float).eps * np.abs(curve).max()
    of_level: list[tuple[int, Array]] = []
    n = _CELL
    while n <= _LOOKS // _CELL:
        cells = np.lib.stride_tricks.sliding_window_view(curve, n + 1)[::n]
        basis = np.linalg.qr(np.vander(np.linspace(-1, 1, n + 1), _DEGREE + 1))[0]
        deviation = np.abs(cells - (cells @ basis) @ basis.T).max(1)
        rough, uneven = deviation > max(_SMOOTH * size, noise), deviation > max(_TAIL * size, noise)
        if rough.mean() > _OFTEN:
            break
        longer = rough.copy()
        for _ in range(_TAILS):
            longer[1:] |= longer[:-1] & uneven[1:]
            longer[:-1] |= longer[1:] & uneven[:-1]
        rough = longer if longer.mean() <= _OFTEN else rough
        narrow = np.repeat(rough, n)
        changes = np.diff(curve)
        steps = np.full(_LOOKS, np.inf)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], narrow, [False]])))
        for i, j in zip(edges[::2], edges[1::2], strict=True):
            fastest = np.ptp(curve[i : j + 1]) / np.abs(changes[i:j]).max() if n == _CELL else n
            steps[i:j] = min(max(fastest, 1.0), n)
        of_level.append((n, steps))
        if narrow.any():
            smooth = np.flatnonzero(~narrow)
            changes = np.interp(np.arange(_LOOKS), smooth, changes[smooth])
            curve = np.concatenate([curve[:1], curve[0] + np.cumsum(changes)])
        n *= 2
    mostly = n
    for n, steps in of_level:
        if n * _FINER <= mostly:
            np.minimum(longest, steps, out=longest)
    return longest
