"""The benchmark commands: `chart` measures speed against accuracy, `stability` the limits of methods and throughput."""

import argparse
import json
import os
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagrotor.commands.terminal import Command, add_json, check_folder, print_json, progress, table

if TYPE_CHECKING:
    from lagrotor.benchmark.runner import Benchmark
    from lagrotor.benchmark.throughput import Throughput

LIMIT_HEAD = ("regime", "quantity", "predicted", "measured", "ratio", "behaviour of the tool")
THROUGHPUT_HEAD = ("quantity", "per second", "share", "of")


def add_benchmark_commands(command: Command) -> None:
    """Add the commands chart and stability to the parser."""
    added = command("chart", chart_command, "measure speed against accuracy", "lagrotor chart --quick --out .")
    added.add_argument(
        "--quick", action="store_true", help="fewer methods, tolerances, repeats: seconds instead of minutes"
    )
    add_json(added, "the points as a JSON object")
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")

    added = command(
        "stability",
        stability_command,
        "show where methods fail, predicted and measured, and the throughput",
        "lagrotor stability --quick",
    )
    added.add_argument("--quick", action="store_true", help="shorter runs and coarser thresholds: seconds, not minutes")
    add_json(added)


def chart_command(options: argparse.Namespace) -> int:
    """Run all benchmarks, write chart.json and chart-SCENE.svg and .png, and print the tables and the files' names."""
    from lagrotor.benchmark.scenes_and_methods import benchmarks
    from lagrotor.drawing.style import paper_style
    from lagrotor.files import write_beside, write_text
    from lagrotor.pictures.benchmark_figures import speed_chart

    check_folder(options.out)
    with progress(4) as step:
        charts = benchmarks(options.quick, step)
    data = chart_data(charts)
    text = json.dumps(data, indent=1, ensure_ascii=False)
    files = [write_text(options.out / "chart.json", text)]
    for chart in charts:
        with paper_style():
            figure = speed_chart(chart)
            for form in ("svg", "png"):
                target = options.out / f"chart-{chart.scene}.{form}"
                files.append(write_beside(target, partial(figure.savefig, format=form)))
    if options.json:
        print(text)
    else:
        print(chart_tables(charts), *files, sep="\n")
    return 0


def chart_data(charts: "list[Benchmark]") -> dict[str, Any]:
    """Return as JSON data the benchmarks, and the ratios of times at equal error in the first scene, the displaced one."""
    from lagrotor.benchmark.scenes_and_methods import ratios

    return {"charts": [asdict(chart) for chart in charts], "ratios": ratios(charts[0])}


def chart_tables(charts: "list[Benchmark]") -> str:
    """Return a text with one table per scene: methods that none beats in time and error, set-up times, failures.

    The last table has the ratios of computing times at equal error.
    """
    from lagrotor.benchmark.runner import failure_sentences, front
    from lagrotor.benchmark.scenes_and_methods import OURS, ratios

    blocks = []
    for chart in charts:
        rows = [
            (p.method, f"{p.setting:g}", f"{p.error:.1e}", f"{p.nfev}", f"{1e3 * p.seconds:.3g}")
            for p in front(chart.points)
        ]
        blocks += [f"{chart.scene}: {chart.says}; the two reference solutions agree to {chart.floor:.1e} m"]
        blocks += [table(("front", "tol or step", "error (m)", "nfev", "ms"), rows)]
        slow = sorted(((s, name) for name, s in chart.setup.items() if s > 0.2), reverse=True)
        blocks += [f"  set-up: {', '.join(f'{name} {s:.2g} s' for s, name in slow)}"] if slow else []
        blocks += [f"  left out: {failure}" for failure in failure_sentences(chart.failures)]
        blocks += [""]
    compared = [
        (error, name, f"{1e3 * value:.3g} ms" if name in OURS else f"{value:.3g}")
        for error, row in ratios(charts[0]).items()
        for name, value in row.items()
        if value is not None
    ]
    blocks += [table(("error (m)", "at equal error, displaced", "time or ratio"), compared)]
    return "\n".join(blocks)


def stability_command(options: argparse.Namespace) -> int:
    from lagrotor.benchmark.limits.step_size import LIMITS, limits
    from lagrotor.benchmark.throughput import throughput

    with progress(len(LIMITS) + 1) as step:
        thresholds = limits(options.quick, step)
        step("throughput")
        rates = _throughput(throughput, options.quick)
    if options.json:
        data = [asdict(limit) | {"ratio": limit.ratio} for limit in thresholds]
        print_json({"quick": options.quick, "limits": data, "throughput": [asdict(rate) for rate in rates]})
    else:
        limit_rows = [
            (x.regime, x.what, f"{x.predicted:.3g}", f"{x.measured:.3g}", f"{x.ratio:.3g}", x.tool) for x in thresholds
        ]
        throughput_rows = [(x.what, f"{x.rate:.3g} {x.unit}", f"{x.share:.2g}", x.against) for x in rates]
        print(table(LIMIT_HEAD, limit_rows), table(THROUGHPUT_HEAD, throughput_rows), sep="\n\n")
    return 0


def _throughput(measure: Any, quick: bool) -> "list[Throughput]":
    """Return what the function `measure` measures with one process per core, or in this process only if `quick`."""
    if quick:
        return list(measure(256))
    from concurrent.futures import ProcessPoolExecutor

    with ProcessPoolExecutor(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None) as executor:
        return list(measure(8192, executor))
