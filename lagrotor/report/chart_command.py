"""`lagrotor chart`: speed against accuracy as figures, JSON and a table."""

import argparse
import json
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import check_folder
from .terminal import progress, table

if TYPE_CHECKING:
    from ..study.chart import Chart

_MARKS = "osD^v<>ph*XPd"


def add_chart(added: argparse.ArgumentParser) -> None:
    """The options of `lagrotor chart`."""
    added.add_argument("--quick", action="store_true", help="fewer tolerances and repeats: half a minute")
    added.add_argument("--json", action="store_true", help="print the points as a JSON object")
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")


def chart_command(given: argparse.Namespace) -> int:
    """Run the charts; write chart-SCENE.svg and .png and chart.json; print the fronts and the ratios."""
    from ..numerics.files import write_beside, write_text
    from ..study.chart import charts
    from .style import paper_style

    check_folder(given.out)
    with progress(4) as step:
        found = charts(given.quick, step)
    data = as_data(found)
    text = json.dumps(data, indent=1, ensure_ascii=False)
    write_text(given.out / "chart.json", text)
    for one in found:
        with paper_style():
            figure = draw(one)
            for form in ("svg", "png"):
                write_beside(given.out / f"chart-{one.scene}.{form}", partial(figure.savefig, format=form))
    print(text if given.json else in_words(found))
    return 0


def as_data(found: "list[Chart]") -> dict[str, Any]:
    """The charts and the ratios of the displaced scene, for JSON."""
    from ..study.chart import ratios

    return {"charts": [asdict(one) for one in found], "ratios": ratios(found[0])}


def in_words(found: "list[Chart]") -> str:
    """The front of each scene, what failed, and the ratios, as tables."""
    from ..study.chart import front, ratios

    parts = []
    for one in found:
        rows = [
            (p.method, f"{p.tol:g}", f"{p.error:.1e}", f"{p.evaluations}", f"{1e3 * p.seconds:.3g}")
            for p in front(one.points)
        ]
        parts += [f"{one.scene}: {one.says}; the reference's two formulations agree to {one.floor:.1e} m"]
        parts += [table(("front", "tol", "error (m)", "evaluations", "ms"), rows)]
        parts += [f"  not there: {name}: {reason}" for name, reason in one.failures.items()]
        parts += [""]
    compared = [
        (error, name, f"{1e3 * value:.3g} ms" if name in ("core", "fast") else f"{value:.3g}")
        for error, row in ratios(found[0]).items()
        for name, value in row.items()
        if value is not None
    ]
    return "\n".join([*parts, table(("error (m)", "at equal error, displaced", "time or ratio"), compared)])


def draw(one: "Chart") -> Any:
    """Error against seconds and against evaluations, with the front; seconds of set-up beside the names."""
    from matplotlib.figure import Figure

    from ..study.chart import front
    from .style import OKABE_ITO

    figure = Figure(figsize=(10.0, 5.4))
    colours = list(OKABE_ITO.values())
    names = list(dict.fromkeys(p.method for p in one.points))
    for axes, work in zip(figure.subplots(1, 2, sharey=True), ("seconds", "evaluations"), strict=True):
        for i, name in enumerate(names):
            points = [p for p in one.points if p.method == name and getattr(p, work) > 0 and p.error > 0]
            label = f"{name} (first result {one.setup[name]:.2g} s)"
            axes.loglog(
                [getattr(p, work) for p in points],
                [p.error for p in points],
                marker=_MARKS[i % len(_MARKS)],
                color=colours[i % len(colours)],
                markersize=4,
                linewidth=0.8,
                label=label,
            )
        best = [p for p in front(one.points, work) if getattr(p, work) > 0]
        axes.step(
            [getattr(p, work) for p in best],
            [p.error for p in best],
            where="post",
            color="#888888",
            linewidth=4,
            alpha=0.4,
            label="front",
        )
        axes.axhline(max(one.floor, 1e-16), color="#888888", linestyle=":", linewidth=0.8)
        axes.set_xlabel({"seconds": "time of a run (s)", "evaluations": "evaluations (steps × order for fast)"}[work])
        axes.margins(0.05)
    figure.axes[0].set_ylabel("largest error of a tip (m)")
    figure.suptitle(one.says)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=7)
    return figure
