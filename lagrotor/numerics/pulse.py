"""A Gaussian pulse exp(−(s/width)²) in an integration, s the time from its peak: where it ends, and how a run is cut there."""

from collections.abc import Iterator
from itertools import pairwise

# Beyond |s| = 6.5 widths a pulse is below the last bit of its peak: exp(−6.5²) = 4e-19.
PULSE_REACH = 6.5
# Longest step in a pulse, over its width, of a run's companion: were it 1 as the run's, both might take the same steps and agree.
COMPANION_STEP = 0.8


def segments(begin: float, end: float, width: float) -> Iterator[tuple[float, float, bool]]:
    """A run from s = begin to end ≥ begin, cut at the edges ± PULSE_REACH width of a pulse of that width, 0: there is none;
    of each part its ends, and whether it lies within the pulse."""
    reach = PULSE_REACH * width
    cuts = [begin, *(s for s in (-reach, reach) if width and begin < s < end), end]
    for left, right in pairwise(cuts):
        yield left, right, abs(left + right) / 2 < reach
