"""The displaced pair by every method that is installed, other tools among them, and ensembles: `python -m benchmarks.speed`.

A few minutes. Writes the record that the report shows, and the chart of this run to `chart-displaced.svg`
in the folder that is named: `python -m benchmarks.speed FOLDER`.
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, replace
from pathlib import Path

from benchmarks.compiled_solvers import COMPILED
from benchmarks.machine import machine, versions
from benchmarks.peers import PEERS
from lagrotor.benchmark.records import SPEED, stamp
from lagrotor.benchmark.runner import Benchmark, Method, benchmark, work_at
from lagrotor.benchmark.scenes_and_methods import CASES, METHODS, OURS
from lagrotor.benchmark.throughput import Throughput, throughput
from lagrotor.drawing import paper_style
from lagrotor.files import write_beside, write_text
from lagrotor.pictures.benchmark_figures import speed_chart
from lagrotor.process_settings import begin_process

ALL_METHODS: dict[str, Method] = METHODS | COMPILED | PEERS
_SAMPLES = 7
_ERRORS = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)


def speed_record(chart: Benchmark, rates: list[Throughput]) -> str:
    """The record as JSON: seconds of each method, and of the best of OURS, at each of some errors."""
    best = {f"best of {name}": [p for p in chart.points if p.family in of] for name, of in OURS.items()}
    best |= {name: [p for p in chart.points if p.method == name] for name in chart.setup}
    data = stamp("speed") | {
        "machine": machine(),
        "versions": versions(),
        "at_error": {f"{e:g}": {name: work_at(points, e) for name, points in best.items()} for e in _ERRORS},
        "least_error": {name: min((p.error for p in points), default=None) for name, points in best.items()},
        "set_up": chart.setup,
        "failures": list(map(str, chart.failures)),
        "throughput": [asdict(rate) for rate in rates],
    }
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def main(folder: Path | None) -> None:
    """Measure; write the record and, where a folder is named, the chart."""
    chart = benchmark("displaced", replace(CASES["displaced"](False), repeats=_SAMPLES), ALL_METHODS)
    with ProcessPoolExecutor() as executor:
        rates = throughput(8192, executor)
    print(write_text(SPEED, speed_record(chart, rates)))
    if folder:
        with paper_style():
            figure = speed_chart(chart)
            print(write_beside(folder / "chart-displaced.svg", lambda file: figure.savefig(file, format="svg")))


if __name__ == "__main__":
    begin_process()
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
