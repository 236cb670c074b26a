"""Windows of a run, in which a force that depends on t changes fast. A run is cut at the edges of its windows, and its steps are
bounded in them. A companion is a second run, with which the first one is compared."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from lagrotor.numerics.arrays import Array

# Beyond |s| = 6.5 widths a pulse exp(−(s/width)²) is below the last bit of its peak: exp(−6.5²) = 4e-19.
PULSE_REACH = 6.5
# Longest step of a companion in a window, divided by that of its run. With 1 both might take the same steps and agree.
COMPANION_STEP = 0.8
_LOOKS = 2**14  # intervals of a run, at whose ends forces of t are sampled
_CELL = 8  # intervals of the smallest cell
_DEGREE = 4  # of the polynomial that fits a function in a smooth cell
_SMOOTH = 1e-6  # error of that fit over the range of the function in the run
_TAIL, _TAILS = 1e-12, 6  # the same bound beside a cell that is not smooth, and the number of cells on each side
_OFTEN, _FINER = 0.25, 4  # share of the run above which fast changes are usual; ratio of usual cells to a window's
_CUT = 10.0  # cost of a cut in steps


class Window(NamedTuple):
    """A time interval from `begin` to `end` (s) in which no step is longer than `longest`."""

    begin: float
    end: float
    longest: float


def pulse_windows(width: float, companion: bool = False) -> tuple[Window, ...]:
    """Return the window of a pulse exp(−(s/width)²), in which steps are at most as long as its width, and shorter for a
    companion."""
    reach = PULSE_REACH * width
    return windows_since(0.0, (Window(-reach, reach, width),), companion)


def windows_since(begin: float, windows: Sequence[Window], companion: bool = False) -> tuple[Window, ...]:
    """Return the windows with times that count from `begin` in s. In the windows of a companion the steps are shorter."""
    share = COMPANION_STEP if companion else 1.0
    return tuple(Window(a - begin, b - begin, share * longest) for a, b, longest in windows)


def segments(begin: float, end: float, windows: Sequence[Window]) -> Iterator[Window]:
    """Yield the intervals of a run, cut at the edges of its windows; outside of windows the longest step is inf."""
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
    """Find the windows of time in which functions of t, times (n,) → values (k, n), change faster than in most of the run. A cell
    of the run is smooth if a polynomial of degree 4 fits the function to 10⁻⁶ of its range. The cells are doubled as long as most
    of them are smooth; each other cell becomes a window. The longest step in a window is its length, or in the smallest cells the
    time of the fastest change. Changes inside a window are removed before cells are doubled, because all larger cells would
    contain them."""
    import numpy as np  # imported late: a scene needs only the reach of a pulse

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
        while windows and (both := _merged(windows[-1], window)):
            window = both
            windows.pop()
        windows.append(window)
    return tuple(windows)


def _merged(first: Window, second: Window) -> Window | None:
    """Return the union of two windows if it takes fewer steps than a restart of the solver between them; None otherwise."""
    merged = Window(first.begin, second.end, min(first.longest, second.longest))
    extra_steps = (merged.end - merged.begin) / merged.longest - sum(
        (b - a) / longest for a, b, longest in (first, second)
    )
    return merged if extra_steps <= _CUT * (1 + (second.begin > first.end)) else None


def _longest_steps(values: Array) -> Array:
    """Return the longest step in each interval for one function, shape (_LOOKS,), in units of an interval; inf where the function
    is smooth."""
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
