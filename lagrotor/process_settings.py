"""The settings with which each process of a long computation begins."""

import gc
import os

# Of linear algebra: matrices are small here, so that more threads wait for each other up to four times as long as they
# compute, and their sums would depend on how many there are.
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
# Results that each function of sympy remembers; of its own 1,000 a long derivation forgets some that it needs again.
_REMEMBERED = "20000"
# New objects between two searches for garbage; searches of the young between two of the middle-aged, and of these between
# two of all. Expressions refer to each other without circles, so that Python's own 700 finds nothing for a tenth of the time.
_GARBAGE = 100_000, 10, 10


def begin_process(objects: int = _GARBAGE[0]) -> None:
    """One thread of linear algebra and a longer memory of sympy, where they are not imported yet and nobody has chosen;
    few searches for garbage, one for so many new objects, none among what is loaded."""
    for name in _THREADS:
        os.environ.setdefault(name, "1")
    os.environ.setdefault("SYMPY_CACHE_SIZE", _REMEMBERED)
    gc.freeze()
    gc.set_threshold(objects, *_GARBAGE[1:])
