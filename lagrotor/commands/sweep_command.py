"""`lagrotor sweep`: a scene run many times with one of its numbers varied, as a table, CSV or JSON."""

import argparse
import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from lagrotor.commands.options import (
    add_pair,
    add_shock,
    add_start,
    check_folder,
    scene_from_options,
    shock_from_options,
)
from lagrotor.errors import InputError
from lagrotor.pair.scene import Scene

# What can be varied: name → (what it is, the scene with that value).
_Change = Callable[[Scene, float], Scene]


def _link(field: str) -> _Change:
    def change(scene: Scene, value: float) -> Scene:
        if scene.link is None:
            raise InputError(f"--vary link-{field}: a pair without a bar has none; leave out --no-link")
        return replace(scene, link=replace(scene.link, **{field: value}))

    return change


def _on_precession(scene: Scene, value: float) -> Scene:
    from lagrotor.models.orbits.precession import paired_scene

    return paired_scene(scene, value)


_VARIED: dict[str, tuple[str, _Change]] = {
    "paired": ("amplitude of the paired precession", _on_precession),
    "spin1": ("spin of rotor 1, rad/s", lambda scene, value: replace(scene, spins=(value, scene.spins[1]))),
    "spin2": ("spin of rotor 2, rad/s", lambda scene, value: replace(scene, spins=(scene.spins[0], value))),
    "link-length": ("length of the bar, m", _link("length")),
    "link-mass": ("mass of the bar, kg", _link("mass")),
    "link-inertia": ("inertia of the bar, kg m²", _link("inertia")),
}
_MOST = 100_000


def add_sweep(added: argparse.ArgumentParser) -> None:
    """The options of a sweep."""
    add_pair(added)
    add_start(added)
    add_shock(added)
    says = "; ".join(f"{name}: {what}" for name, (what, _) in _VARIED.items())
    added.add_argument("--vary", required=True, choices=_VARIED, metavar="NAME", help=says)
    added.add_argument(
        "--between", nargs=3, required=True, metavar=("FROM", "TO", "N"), help="N values, evenly from FROM to TO"
    )
    added.add_argument("--t-end", type=float, default=10.0, metavar="S", help="end of the runs, s (default: 10)")
    added.add_argument("--samples", type=int, default=3, metavar="N", help="times that each is read at (default: 3)")
    added.add_argument("--tol", type=float, default=1e-8, help="local error of the solver (default: 1e-8)")
    added.add_argument("--out", type=Path, metavar="FILE", help="write every time of every run as .csv")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object a run")


def _values(given: argparse.Namespace) -> list[float]:
    try:
        first, last, count = float(given.between[0]), float(given.between[1]), int(given.between[2])
    except ValueError:
        raise InputError(f"--between {' '.join(given.between)}: give two numbers and a count") from None
    if not (math.isfinite(first) and math.isfinite(last) and 1 <= count <= _MOST):
        raise InputError(f"--between {' '.join(given.between)}: two finite numbers and a count from 1 to {_MOST}")
    return [first + (last - first) * i / max(count - 1, 1) for i in range(count)]


def sweep_command(given: argparse.Namespace) -> int:
    """Run the family; a line a run, or all times of all runs as CSV."""
    if not (math.isfinite(given.t_end) and given.t_end > 0 and given.samples >= 2):
        raise InputError(f"--t-end {given.t_end:g} must be above zero and --samples {given.samples} at least 2")
    if given.out:
        if given.out.suffix != ".csv":
            raise InputError(f"--out {given.out}: the name must end in .csv")
        check_folder(given.out.parent)
    values, scene, change = _values(given), scene_from_options(given, shock_from_options(given)), _VARIED[given.vary][1]
    family = [change(scene, value) for value in values]

    import numpy as np

    from lagrotor.commands.terminal import progress, table
    from lagrotor.files import write_text
    from lagrotor.models.sweeps.ensemble import sweep

    with progress(1) as step:
        step(f"{len(family)} runs")
        ensemble = sweep(family, np.linspace(0.0, given.t_end, given.samples), tol=given.tol)
    runs = [ensemble.trajectory(i) for i in range(len(family))]
    rows = [
        {given.vary: value, "model": run.model, "evaluations": run.evaluations,
         "tip_1": run.tips[0, -1].tolist(), "tip_2": run.tips[1, -1].tolist()}
        for value, run in zip(values, runs, strict=True)
    ]  # fmt: skip
    if given.out:
        head = f"{given.vary},t [s],tip_1_x [m],tip_1_y [m],tip_1_z [m],tip_2_x [m],tip_2_y [m],tip_2_z [m]"
        lines = (
            ",".join(map(repr, (value, float(t), *map(float, run.tips[:, n].ravel()))))
            for value, run in zip(values, runs, strict=True)
            for n, t in enumerate(run.t)
        )
        print(write_text(given.out, "\n".join([head, *lines, ""])))
    elif given.json:
        print(json.dumps(rows, indent=1))
    else:
        cells = [
            (f"{r[given.vary]:.6g}", r["model"], str(r["evaluations"]), "  ".join(f"{x:.6f}" for x in r["tip_1"]))
            for r in rows
        ]
        print(table((given.vary, "model", "evaluations", f"tip 1 at {given.t_end:g} s [m]"), cells))
    return 1 if len(ensemble.failed) else 0
