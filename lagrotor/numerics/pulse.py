"""Windows of a run, in which something acts briefly by the clock: those of a pulse, and how a run is cut at their edges."""

from collections.abc import Iterator, Sequence
from math import inf
from typing import NamedTuple

# Beyond |s| = 6.5 widths a pulse exp(−(s/width)²) is below the last bit of its peak: exp(−6.5²) = 4e-19.
PULSE_REACH = 6.5
# Longest step in a window, over that of the run, of its companion: were it 1, both might take the same steps and agree.
COMPANION_STEP = 0.8


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
