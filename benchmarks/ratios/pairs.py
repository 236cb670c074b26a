"""A row of the table: the ratio of two measurements that take turns, A, B, A, B, …, in one run.

Other work on the machine slows both halves of a pair, so that it cancels from the ratio of the pair. A row is the median of these
ratios. Before its first pair a row checks that both sides do their work; a side that does not raises LagrotorError.
"""

import gc
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from math import inf, log
from statistics import median

from lagrotor.errors import LagrotorError

_SAMPLE = 0.05  # s for which a short call is repeated
Pairs = Iterator[tuple[float, float]]


@dataclass(frozen=True)
class Row:
    """A row of the table.

    `pairs` checks the work of both sides and then yields their times, ours first, without end; `count` of them are taken. A row
    in seconds has the time 1 as its second side. `wanted` is the largest median that is wanted, inf if none is.
    """

    name: str
    unit: str
    wanted: float
    pairs: Callable[[], Pairs]
    count: int = 9


def seconds(call: Callable[[], object]) -> float:
    """The processor time of a call in s, averaged over as many calls as take _SAMPLE seconds, at least one."""
    gc.collect()
    began, calls, elapsed = time.process_time(), 0, 0.0
    while elapsed < _SAMPLE:
        call()
        calls, elapsed = calls + 1, time.process_time() - began
    return elapsed / calls


def measured(row: Row, count: int | None = None) -> str:
    """Measure a row; return its line, with the median of the ratios, the least and the largest of them, and their number."""
    ratios = [a / b for a, b in islice(row.pairs(), count or row.count)]
    wanted = "—" if row.wanted == inf else f"{row.wanted:g}"
    spread = f"{min(ratios):.3g} to {max(ratios):.3g}"
    missed = "  missed" if median(ratios) > row.wanted else ""
    return f"{row.name:<58}{row.unit:<26}{wanted:>7}{median(ratios):>9.3g}  {spread:<16}{len(ratios):>3}{missed}"


HEAD = f"{'row':<58}{'in units of':<26}{'wanted':>7}{'median':>9}  {'spread':<16}{'n':>3}"


def at_equal_error(
    ours: Callable[[], object],
    error: float,
    rival: Callable[[float], object],
    errors: Mapping[float, float],
    bound: float,
) -> Pairs:
    """Yield the times of our run and of the rival at our true error.

    `errors` maps each tolerance of the rival, from coarse to fine, to its true error. The rival is timed at the two tolerances
    between whose errors ours lies, and its time is interpolated there, as on a chart with logarithmic axes. Where our error is
    larger or smaller than all of the rival's, the coarsest or the most exact tolerance is taken; the second favours the rival.
    Raises LagrotorError if the rival does not reach `bound`.
    """
    tolerances, least = list(errors), min(errors.values())
    if not least <= bound:
        raise LagrotorError(f"the rival reaches {least:.2g} at best, and {bound:.2g} is asked for: no comparison")
    enough = next(i for i, tol in enumerate(tolerances) if errors[tol] <= max(error, least))
    fine, coarse = tolerances[enough], tolerances[max(enough - 1, 0)]
    share = log(max(error, least) / errors[coarse]) / log(errors[fine] / errors[coarse]) if enough else 1.0
    while True:
        own, exact = seconds(ours), seconds(lambda: rival(fine))
        yield own, exact**share * seconds(lambda: rival(coarse)) ** (1 - share)
