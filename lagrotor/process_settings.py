"""The settings of each process of a long computation."""

import gc
import os

# Threads of linear algebra: matrices are small here, so several threads wait for each other up to four times as long as they
# compute, and sums would depend on their number.
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
# Results that each function of sympy caches; with the default of 1,000 a long derivation loses some that it needs again.
_REMEMBERED = "20000"
# New objects between two garbage collections of generation 0, and collections between two of generations 1 and 2. Expressions
# have no reference cycles, so Python's default of 700 takes a tenth of the time without effect.
_GARBAGE = 100_000, 10, 10


def begin_process(objects: int = _GARBAGE[0]) -> None:
    """Prepare a process for long work: one thread of linear algebra, a larger cache of sympy, rarer garbage collections.

    Environment variables that the user has set are kept. The first two settings act only before numpy and sympy are imported.
    `objects` is the number of new objects between two garbage collections.
    """
    for name in _THREADS:
        os.environ.setdefault(name, "1")
    os.environ.setdefault("SYMPY_CACHE_SIZE", _REMEMBERED)
    gc.freeze()
    gc.set_threshold(objects, *_GARBAGE[1:])
