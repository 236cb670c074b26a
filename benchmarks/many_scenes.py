"""Many scenes into a folder: memory, seconds and bytes. `python -m benchmarks.many_scenes [RUNS] [ENGINE] [processes]`

The columns of all scenes are in memory, the results only in the folder. The work is asserted: every run reaches the last time,
keeps its tolerance, and a few are as `simulate` has them.
"""

import resource
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from lagrotor import simulate, sweep
from lagrotor.models.sweeps.sweep_folder import Sweep

TIMES, TOL = np.linspace(0.0, 10.0, 11), 1e-6


def columns(n: int) -> dict[str, object]:
    """Return n pairs that stand upright and are pushed along and across the joint line."""
    draw = np.random.default_rng(1)
    rates = np.zeros((n, 2, 3))
    rates[:, :, 1] = draw.uniform(-0.5, 0.5, (n, 2))
    rates[:, :, 0] = draw.uniform(-0.5, 0.5, (n, 1))  # equal, so that the bar is not stretched
    return {"spins_1": draw.uniform(8, 12, n), "spins_2": -10.0, "rates": rates}


def measure(n: int, engine: str, executor: str | None, folder: Path) -> Sweep:
    """Run n scenes into a folder, print what that costs, and return the runs."""
    began = time.perf_counter()
    runs = sweep(columns(n), TIMES, TOL, folder=folder, engine=engine, executor=executor)
    seconds = time.perf_counter() - began
    own, others = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    work = sum(usage.ru_utime + usage.ru_stime for usage in (own, others))
    size = sum(file.stat().st_size for file in folder.iterdir())
    print(
        f"{n:,} runs of {TIMES[-1]:g} s at {len(TIMES)} times, engine {engine}, {executor or 'this process'}, tol {TOL:g}"
    )
    print(f"  {seconds:.1f} s, {work:.1f} s of processors: {1e6 * work / n / 3600:.3g} core-hours for 10⁶ runs")
    print(f"  {size / n:.0f} bytes in the folder for each run, {size / 1e6:.1f} MB in all")
    print(f"  peak of memory {own.ru_maxrss / 1024:.0f} MB, of a worker {others.ru_maxrss / 1024:.0f} MB")
    assert isinstance(runs, Sweep)
    return runs


def check(runs: Sweep, n: int) -> None:
    """Assert that the runs are the work that was asked for."""
    assert len(runs) == n == len(Sweep.open(runs.folder)) and not len(runs.failed)
    assert (runs.error <= TOL).all() and (runs.evaluations > 0).all()
    for i in np.linspace(0, n - 1, 5).astype(int):
        exact = simulate(runs.scenes[i], TIMES, "spheres", 1e-10)
        apart = np.linalg.norm(runs.axes[i] - exact.axes, axis=-1).max()
        assert apart <= runs.error[i] + exact.error, (i, apart, runs.error[i])


def main(n: int = 100_000, engine: str = "core", executor: str | None = None) -> None:
    with TemporaryDirectory() as folder:
        check(measure(n, engine, executor, Path(folder) / "out"), n)


if __name__ == "__main__":
    main(*(kind(word) for kind, word in zip((int, str, str), sys.argv[1:], strict=False)))
