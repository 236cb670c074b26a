"""The displaced pair by every method that is installed, other tools among them, and ensembles: `python -m benchmarks.speed`.

Some minutes. Writes the record that the report shows, and the chart of this run to `chart-displaced.svg`
in the folder that is named: `python -m benchmarks.speed FOLDER`.
"""

import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import asdict, replace
from importlib.util import find_spec
from itertools import repeat
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.compiled_solvers import COMPILED
from benchmarks.full_equations import diffrax_vmap, heyoka_lanes
from benchmarks.machine import machine, versions
from benchmarks.peers import PEERS
from lagrotor.benchmark.records import write_record
from lagrotor.benchmark.runner import TOLERANCES, Benchmark, Method, benchmark, check_work, work_at
from lagrotor.benchmark.scenes_and_methods import CASES, METHODS, OURS
from lagrotor.benchmark.throughput import DURATION, ENSEMBLE_ERRORS, Throughput, displaced_family, throughput
from lagrotor.drawing import paper_style
from lagrotor.files import write_beside
from lagrotor.models.sweeps.sweep import sweep
from lagrotor.pair.scene import Scene
from lagrotor.pictures.benchmark_figures import speed_chart
from lagrotor.process_settings import begin_process

ALL_METHODS: dict[str, Method] = METHODS | COMPILED | PEERS
_SAMPLES = 7
_ERRORS = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)
_PART, _TRIED = 512, 64  # scenes that one call runs, and scenes on which settings are tried
Ends = Callable[[Sequence[Scene], float, float], NDArray[np.float64]]  # scenes, t_end, tolerance → states (n, 12)
ENSEMBLES: dict[str, tuple[str, Ends]] = {
    "heyoka alone, taylor_adaptive_batch": ("heyoka", heyoka_lanes),
    "diffrax, jax.vmap": ("diffrax", diffrax_vmap),
}


def speed_record(chart: Benchmark, rates: list[Throughput]) -> dict[str, Any]:
    """The record: seconds of each method, and of the best of OURS, at each of some errors; the largest error of each method in
    units of the tolerance that it was given, None for methods with steps."""
    best = {f"best of {name}": [p for p in chart.points if p.family in of] for name, of in OURS.items()}
    best |= {name: [p for p in chart.points if p.method == name] for name in chart.setup}
    return {
        "machine": machine(),
        "versions": versions(),
        "at_error": {f"{e:g}": {name: work_at(points, e) for name, points in best.items()} for e in _ERRORS},
        "least_error": {name: min((p.error for p in points), default=None) for name, points in best.items()},
        "error_over_tolerance": {
            name: None if ALL_METHODS[name].steps else max((p.error / p.setting for p in best[name]), default=None)
            for name in chart.setup
        },
        "set_up": chart.setup,
        "failures": list(map(str, chart.failures)),
        "throughput": [asdict(rate) for rate in rates],
    }


def rival_throughput(n: int, executor: Executor, first: Throughput) -> list[Throughput]:
    """The rates of the ENSEMBLES that are installed, on the family of `throughput` and beside its `first` row. Each has the
    coarsest tolerance with which the true error, at the end of every scene, is no larger than that of `throughput`."""
    scenes, rows = displaced_family(n), list[Throughput]()
    parts = [scenes[i : i + _PART] for i in range(0, n, _PART)]
    truth = sweep(scenes, [0.0, DURATION], 1e-12, executor=executor).axes[:, :, -1].reshape(n, 6)
    for name, (module, ends) in ENSEMBLES.items():
        if find_spec(module) is None:
            continue
        for bound in ENSEMBLE_ERRORS:
            some = slice(None, None, -(-n // _TRIED))
            tried = (
                tol for tol in TOLERANCES if abs(ends(scenes[some], DURATION, tol)[:, :6] - truth[some]).max() <= bound
            )
            tol, seconds, reached = next(tried), list[float](), np.empty((0, 12))
            for _ in range(3):  # the first compiles
                began = time.perf_counter()
                reached = np.concatenate(list(executor.map(ends, parts, repeat(DURATION), repeat(tol))))
                seconds.append(time.perf_counter() - began)
            moved = np.stack([[s.axes for s in scenes], reached[:, :6].reshape(n, 2, 3)], axis=1)
            check_work(f"{name} at {tol:g}", n, moved, abs(reached[:, :6] - truth).max(), 2 * bound)
            what = f"trajectories of {DURATION:g} s, displaced family, {name}, error {bound:.0e}, with tol = {tol:.0e}"
            rate = n / min(seconds)
            rows.append(Throughput(what, first.unit, rate, rate / first.rate, "that of core, error 1e-06"))
    return rows


def main(folder: Path | None, scenes: int = 8192) -> None:
    """Measure; write the record and, where a folder is named, the chart."""
    with ProcessPoolExecutor(mp_context=get_context("spawn"), initializer=begin_process) as executor:
        rates = throughput(scenes, executor)
        rates += rival_throughput(scenes, executor, rates[0])
    chart = benchmark("displaced", replace(CASES["displaced"](False), repeats=_SAMPLES), ALL_METHODS)
    print(write_record("speed", speed_record(chart, rates)))
    if folder:
        with paper_style():
            figure = speed_chart(chart)
            print(write_beside(folder / "chart-displaced.svg", lambda file: figure.savefig(file, format="svg")))


if __name__ == "__main__":
    begin_process()
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
