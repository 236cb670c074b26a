"""Linear algebra has one thread in each process, as the command `lagrotor` gives it: set before numpy is imported."""

import os

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")
