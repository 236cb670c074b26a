"""The command `lagrotor stability`: where methods fail, predicted and found, and how much runs in a second."""

import argparse
import json
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from lagrotor.commands.options import check_folder

if TYPE_CHECKING:
    from lagrotor.benchmark.limits.threshold import Limit
    from lagrotor.benchmark.throughput import Throughput

LIMIT_HEAD = ("regime", "what", "predicted", "found", "ratio", "what the tool does")
THROUGHPUT_HEAD = ("what", "a second", "share", "of")


def stability_command(given: argparse.Namespace) -> int:
    if given.out:
        check_folder(given.out)

    import numpy as np

    from lagrotor.benchmark.limits.step_size import LIMITS, limits
    from lagrotor.benchmark.throughput import throughput
    from lagrotor.commands.terminal import progress, table
    from lagrotor.files import write_text

    with progress(len(LIMITS) + 1 + bool(given.out)) as step:
        found = limits(given.quick, step)
        step("throughput")
        rates = _throughput(throughput, given.quick)
        content: dict[str, Any] = {
            "quick": given.quick,
            "limits": [asdict(limit) | {"ratio": limit.ratio} for limit in found],
            "throughput": [asdict(rate) for rate in rates],
        }
        if given.out:
            from lagrotor.benchmark.limits.error_map import usefulness
            from lagrotor.pictures.stability_figure import draw_stability

            step("figure")
            n, m = (8, 9) if given.quick else (24, 40)
            useful = usefulness(np.geomspace(0.01, 0.5, n), np.geomspace(1e-6, 1.0, m))
            content["usefulness"] = {name: np.asarray(value).tolist() for name, value in vars(useful).items()}
    text = json.dumps(content, indent=1, ensure_ascii=False)
    if given.json:
        print(text)
    else:
        print(table(LIMIT_HEAD, limit_rows(found)), table(THROUGHPUT_HEAD, throughput_rows(rates)), sep="\n\n")
    if given.out:
        written = [*draw_stability(useful, given.out), write_text(given.out / "stability.json", text + "\n")]
        if not given.json:
            print(*written, sep="\n")
    return 0


def limit_rows(found: "Sequence[Limit]") -> list[tuple[str, ...]]:
    """The limits as rows under LIMIT_HEAD."""
    return [(x.regime, x.what, f"{x.predicted:.3g}", f"{x.measured:.3g}", f"{x.ratio:.3g}", x.tool) for x in found]


def throughput_rows(rates: "Sequence[Throughput]") -> list[tuple[str, ...]]:
    """The rates as rows under THROUGHPUT_HEAD."""
    return [(x.what, f"{x.rate:.3g} {x.unit}", f"{x.share:.2g}", x.against) for x in rates]


def _throughput(measure: Any, quick: bool) -> "list[Throughput]":
    """In one process a core; here, when quick, as starting them costs more than the run."""
    if quick:
        return list(measure(256))
    with ProcessPoolExecutor(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None) as executor:
        return list(measure(8192, executor))
