"""`lagrotor chart`: speed against accuracy as figures, JSON and a table."""

import argparse
import json
import textwrap
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagrotor.commands.options import check_folder
from lagrotor.commands.terminal import progress, table

if TYPE_CHECKING:
    from lagrotor.benchmark.runner import Chart

_MARKS = "osD^vp*XP<>hd"
# Family → what it is called, and its colour's name; in the order of the legend.
_FAMILIES = {
    "closed": ("closed forms", "reddish purple"),
    "core": ("core: sympy, numpy, scipy", "blue"),
    "fast": ("fast extra: heyoka", "vermillion"),
    "candidate": ("candidates for the fast extra", "orange"),
    "scipy": ("other solvers of scipy, minimal model", "sky blue"),
    "springs": ("the paper's method", "black"),
    "peer": ("other tools", "bluish green"),
    "trap": ("traps: called once over the shock", "grey"),
}
_WRAP = 225  # characters of a failure on a line as wide as the figure


def add_chart(added: argparse.ArgumentParser) -> None:
    """The options of `lagrotor chart`."""
    added.add_argument(
        "--quick", action="store_true", help="fewer methods, tolerances and repeats: seconds for minutes"
    )
    added.add_argument("--json", action="store_true", help="print the points as a JSON object")
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")


def chart_command(given: argparse.Namespace) -> int:
    """Run the charts; write chart-SCENE.svg and .png and chart.json; print the fronts, the ratios and the files."""
    from lagrotor.benchmark.scenes_and_methods import charts
    from lagrotor.drawing.style import paper_style
    from lagrotor.files import write_beside, write_text

    check_folder(given.out)
    with progress(4) as step:
        found = charts(given.quick, step)
    data = as_data(found)
    text = json.dumps(data, indent=1, ensure_ascii=False)
    written = [write_text(given.out / "chart.json", text)]
    for one in found:
        with paper_style():
            figure = draw(one)
            for form in ("svg", "png"):
                target = given.out / f"chart-{one.scene}.{form}"
                written.append(write_beside(target, partial(figure.savefig, format=form)))
    if given.json:
        print(text)
    else:
        print(in_words(found), *written, sep="\n")
    return 0


def as_data(found: "list[Chart]") -> dict[str, Any]:
    """The charts and the ratios of the displaced scene, for JSON."""
    from lagrotor.benchmark.scenes_and_methods import ratios

    return {"charts": [asdict(one) for one in found], "ratios": ratios(found[0])}


def in_words(found: "list[Chart]") -> str:
    """The front of each scene, set-up, what failed, and the ratios, as tables."""
    from lagrotor.benchmark.runner import front, listed
    from lagrotor.benchmark.scenes_and_methods import LADDERS, ratios

    parts = []
    for one in found:
        rows = [
            (p.method, f"{p.knob:g}", f"{p.error:.1e}", f"{p.evaluations}", f"{1e3 * p.seconds:.3g}")
            for p in front(one.points)
        ]
        parts += [f"{one.scene}: {one.says}; the reference's two formulations agree to {one.floor:.1e} m"]
        parts += [table(("front", "tol", "error (m)", "evaluations", "ms"), rows)]
        slow = sorted(((s, name) for name, s in one.setup.items() if s > 0.2), reverse=True)
        parts += [f"  to get ready: {', '.join(f'{name} {s:.2g} s' for s, name in slow)}"] if slow else []
        parts += [f"  not there: {failure}" for failure in listed(one.failures)]
        parts += [""]
    compared = [
        (error, name, f"{1e3 * value:.3g} ms" if name in LADDERS else f"{value:.3g}")
        for error, row in ratios(found[0]).items()
        for name, value in row.items()
        if value is not None
    ]
    return "\n".join([*parts, table(("error (m)", "at equal error, displaced", "time or ratio"), compared)])


def draw(one: "Chart") -> Any:
    """Error against seconds and against evaluations, with the front, a colour a family; under it what failed."""
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from lagrotor.benchmark.runner import front, listed
    from lagrotor.drawing.style import OKABE_ITO

    families = {p.method: p.family for p in one.points}
    names = [name for family in _FAMILIES for name in families if families[name] == family]
    failures = [
        line for failure in listed(one.failures) for line in textwrap.wrap(failure, _WRAP, subsequent_indent="   ")
    ]
    figure = Figure(figsize=(12.0, 7.2 + 0.13 * len(failures)))
    shown: list[Any] = []
    for axes, work in zip(figure.subplots(1, 2, sharey=True), ("seconds", "evaluations"), strict=True):
        best = [p for p in front(one.points, work) if getattr(p, work) > 0]
        across, errors = [getattr(p, work) for p in best], [p.error for p in best]
        axes.step(across, errors, where="post", color="#bbbbbb", linewidth=6, alpha=0.5, label="front")
        shown = [Line2D([], [], color="#bbbbbb", linewidth=6, alpha=0.5, label="front")]
        last = ""
        for number, name in enumerate(names, 1):
            family = families[name]
            said, colour = _FAMILIES[family][0], OKABE_ITO.get(_FAMILIES[family][1], "#888888")
            if family != last:
                shown.append(Line2D([], [], linestyle="", label=said))
                last, place = family, 0
            points = [p for p in one.points if p.method == name and getattr(p, work) > 0 and p.error > 0]
            (line,) = axes.loglog(
                [getattr(p, work) for p in points],
                [p.error for p in points],
                marker=_MARKS[place % len(_MARKS)],
                linestyle="--" if family == "trap" else "-",
                color=colour,
                markersize=4,
                linewidth=0.9,
                label=f"{number}  {name}" + (f" ({one.setup[name]:.1f} s)" if one.setup[name] > 0.05 else ""),
            )
            shown.append(line)
            place += 1
            if points:
                end = min(points, key=lambda p: p.error)
                at = getattr(end, work), end.error
                axes.annotate(str(number), at, (3, -7), textcoords="offset points", fontsize=7, color=colour)
        axes.axhline(max(one.floor, 1e-16), color="#888888", linestyle=":", linewidth=0.8)
        axes.set_xlabel(
            {"seconds": "processor time of a run (s)", "evaluations": "evaluations (steps × order for fast)"}[work]
        )
        axes.margins(0.06)
    figure.axes[0].set_ylabel("largest error of a tip (m)")
    figure.suptitle(one.says, x=0.06, ha="left")
    legend = figure.legend(
        handles=shown,
        loc="outside right upper",
        fontsize=7,
        title="in brackets: time to get ready",
        title_fontsize=7,
        alignment="left",
    )
    for text in legend.get_texts():
        if text.get_text() in {said for said, _ in _FAMILIES.values()}:
            text.set_fontweight("bold")
    if failures:
        figure.supxlabel("not there:\n" + "\n".join(failures), x=0.01, ha="left", fontsize=6.5, linespacing=1.3)
    return figure
