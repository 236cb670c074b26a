"""`python -m benchmarks.ratios.rods N [N …]`: derive the equations of N rods, check them, and print the processor time in s.

The check: the accelerations are those of point masses on massless rods, by the mass matrix in the angles to the vertical.
"""

import sys
import time

import numpy as np
from numpy.typing import NDArray

from benchmarks.mechanisms.chains import VALUES, chain, g, l
from lagrotor.benchmark.runner import check_work

SAME = 1e-9  # relative difference of the accelerations up to which they are equal


def accelerations(q: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    """The accelerations of the relative angles. With equal masses m at the ends of rods of length l, and n_ij masses beyond both
    rods: Σ_j n_ij (cos(θ_i − θ_j) θ_j'' + sin(θ_i − θ_j) θ_j'²) = −n_ii (g/l) sin θ_i."""
    angle, rate, n = np.cumsum(q), np.cumsum(v), len(q)
    beyond = n - np.maximum.outer(np.arange(n), np.arange(n))
    apart = np.subtract.outer(angle, angle)
    force = -(beyond * np.sin(apart)) @ rate**2 - np.diag(beyond) * VALUES[g] / VALUES[l] * np.sin(angle)
    return np.diff(np.linalg.solve(beyond * np.cos(apart), force), prepend=0.0)


def ready(n: int) -> float:
    """The processor time from the bodies to the first accelerations, s. Raises LagrotorError if these are wrong."""
    y = np.random.default_rng(n).uniform(-0.5, 0.5, 2 * n)
    began = time.process_time()
    derivative = np.asarray(chain("rods", n).rhs(VALUES)(0.0, y))
    taken = time.process_time() - began
    right = accelerations(y[:n], y[n:])
    check_work(
        f"{n} rods", 1, np.array([right]), float(np.abs(derivative[n:] - right).max() / np.abs(right).max()), SAME
    )
    return taken


if __name__ == "__main__":
    chain("rods", 2).rhs(VALUES)  # what is imported once is no part of the time
    for number in map(int, sys.argv[1:]):
        print(ready(number))
