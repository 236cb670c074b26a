"""The commands that are given a scene: simulate, sweep, animate, rate. Everything is refused before work starts."""

import argparse
import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from lagrotor.commands.options import (
    Command,
    add_pair,
    add_shock,
    add_start,
    check_file,
    check_folder,
    scene_from_options,
    shock_from_options,
)
from lagrotor.errors import InputError
from lagrotor.files import FILMS
from lagrotor.pair.examples import SCENES
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
_TOLERANCE = "target for the estimated largest error of an axis over the run"


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
    added.add_argument("--tol", type=float, default=1e-8, help=f"{_TOLERANCE} (default: 1e-8)")
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


_MOST_SAMPLES = 10_000_000


def add_scene_commands(command: Command) -> None:
    """simulate, sweep, animate, rate."""
    _add_simulate(
        command(
            "simulate",
            simulate_command,
            "run a rotor pair and keep or show its motion",
            "lagrotor simulate --spins 10 -10 --shock 40 -11 0 --shock-time 2 --shock-width 0.05 --t-end 10 --out run.npz",
        )
    )
    add_sweep(
        command(
            "sweep",
            sweep_command,
            "run a rotor pair many times with one of its numbers varied",
            "lagrotor sweep --spins 10 -10 --vary paired --between 0.05 0.3 6",
        )
    )
    added = command(
        "animate",
        animate_command,
        "write a ready scene's motion as GIF or MP4",
        "lagrotor animate free-precession --out pair.gif",
    )
    says = "\n".join(f"  {name:<18} {ready.says}" for name, ready in SCENES.items())
    added.epilog = f"scenes:\n{says}\n\n{added.epilog}"
    added.add_argument("scene", choices=SCENES, metavar="SCENE", help="one of the scenes below")
    added.add_argument(
        "--out", type=Path, metavar="FILE", help="a .gif, or an .mp4 by ffmpeg (default: SCENE.gif here)"
    )
    added.add_argument("--t-end", type=float, metavar="S", help="end of the run, s (default: the scene's own)")
    added.add_argument("--fps", type=float, default=25.0, metavar="N", help="frames per second (default: 25)")
    added.add_argument("--json", action="store_true", help="print a JSON object with the file's name")

    added = command(
        "rate", rate_command, "the natural rate of a rotor pair, in closed form", "lagrotor rate --spins 10 -10 --json"
    )
    add_pair(added)
    added.add_argument("--json", action="store_true", help="print a JSON object")


def _add_simulate(added: argparse.ArgumentParser) -> None:
    add_pair(added)
    add_start(added)
    add_shock(added)
    says = "start on the paired precession of this amplitude (opposite spins; no --axes, --rates)"
    added.add_argument("--paired", type=float, metavar="R0", help=says)
    added.add_argument("--write-scene", type=Path, metavar="FILE", help="write the scene as TOML too, for --scene")
    added.add_argument("--t-end", type=float, default=10.0, metavar="S", help="end of the run, s (default: 10)")
    added.add_argument("--samples", type=int, default=1001, metavar="N", help="times kept (default: 1001)")
    says = "auto, closed_form, linear, averaged, minimal, spheres or euler (default: auto)"
    added.add_argument("--model", default="auto", help=says)
    added.add_argument("--tol", type=float, default=1e-9, help=f"{_TOLERANCE} (default: 1e-9)")
    says = "core, or fast where lagrotor[fast] is installed (default: core)"
    added.add_argument("--engine", default="core", help=says)
    added.add_argument(
        "--out",
        type=Path,
        metavar="FILE",
        help="write the run (.npz, .csv), a picture of it (.png, .svg, .pdf) or a film (.gif, .mp4); a line, no table",
    )
    added.add_argument("--json", action="store_true", help="print the summary as a JSON object")


def animate_command(given: argparse.Namespace) -> int:
    from lagrotor.commands.terminal import progress
    from lagrotor.drawing.film import check_film

    ready, target = SCENES[given.scene], given.out or Path(f"{given.scene}.gif")
    t_end = ready.duration if given.t_end is None else given.t_end
    check_film(target, t_end, given.fps)
    check_folder(target.parent)

    import numpy as np

    from lagrotor.models.simulate import simulate

    with progress(1 + math.ceil(t_end)) as step:
        step("motion")
        run = simulate(ready.scene, np.linspace(0.0, t_end, math.ceil(100 * t_end) + 1))
        run.animate(target, given.fps, step)
    print(json.dumps({"file": str(target)}) if given.json else target)
    return 0


def simulate_command(given: argparse.Namespace) -> int:
    if not (math.isfinite(given.t_end) and given.t_end > 0):
        raise InputError(f"--t-end {given.t_end:g} must be greater than zero and finite, in s")
    if not 2 <= given.samples <= _MOST_SAMPLES:
        raise InputError(f"--samples {given.samples} must lie between 2 and {_MOST_SAMPLES}")
    if given.write_scene and given.write_scene.suffix != ".toml":
        raise InputError(f"--write-scene {given.write_scene}: the name must end in .toml")
    if given.out:
        check_file(given.out)
    if given.out and given.out.suffix in FILMS:
        from lagrotor.drawing.film import check_film

        check_film(given.out, given.t_end, 25.0)
    scene = _scene_with_start(scene_from_options(given, shock_from_options(given)), given)

    import numpy as np

    from lagrotor.commands.terminal import show_time
    from lagrotor.models.simulate import simulate

    times = np.linspace(0.0, given.t_end, given.samples)
    with show_time(given.t_end) as at:
        run = simulate(scene, times, given.model, given.tol, given.engine, at)
    if given.out:
        run.save(given.out)
    summary = {
        "model": run.model,
        "why": run.why,
        "samples": given.samples,
        "t_end": given.t_end,
        "evaluations": run.evaluations,
        "energy_first": float(run.energy[0]),
        "energy_last": float(run.energy[-1]),
        "link_length_spread": float(np.ptp(run.link_length)),
        "tip_1": run.tips[0, -1].tolist(),
        "tip_2": run.tips[1, -1].tolist(),
    }
    if given.json:
        print(json.dumps(summary, indent=1, ensure_ascii=False))
    elif given.out:
        print(f"{given.out}: {given.samples} times by the model {run.model} ({run.why})")
    else:
        print(_run_table(summary))
    return 0


def _scene_with_start(scene: Scene, given: argparse.Namespace) -> Scene:
    """The scene, on its paired precession with `--paired`, written with `--write-scene`. Raises InputError for two starts."""
    if given.paired is not None:
        if given.axes is not None or given.rates is not None:
            raise InputError("--paired and --axes or --rates: each is a start; give one")
        from lagrotor.models.orbits.precession import paired_scene

        scene = paired_scene(scene, given.paired)
    if given.write_scene:
        from lagrotor.pair.scene_document import write_scene

        write_scene(scene, given.write_scene)
    return scene


def _run_table(run: dict[str, Any]) -> str:
    from lagrotor.commands.terminal import table

    def point(tip: list[float]) -> str:
        return "  ".join(f"{x:.9f}" for x in tip)

    rows = [
        ("model", f"{run['model']} ({run['why']})"),
        ("evaluations", str(run["evaluations"])),
        ("energy at first [J]", f"{run['energy_first']:.12g}"),
        ("energy at last [J]", f"{run['energy_last']:.12g}"),
        ("link length, spread [m]", f"{run['link_length_spread']:.3g}"),
        ("tip 1 at the end [m]", point(run["tip_1"])),
        ("tip 2 at the end [m]", point(run["tip_2"])),
    ]
    return table((f"{run['t_end']:g} s", f"{run['samples']} times"), rows)


def rate_command(given: argparse.Namespace) -> int:
    scene = scene_from_options(given)

    from lagrotor.commands.terminal import table
    from lagrotor.theory.natural_rate import natural_rate, natural_rate_limits

    rate, limits = natural_rate(scene), natural_rate_limits(scene) if scene.link else {}
    period = 2 * math.pi / abs(rate) if rate else None
    if given.json:
        rates = {name: limit.rate for name, limit in limits.items()}
        print(json.dumps({"rate": rate, "period": period, "limits": rates}))
    else:
        print(f"natural rate  {rate:.12g} rad/s")
        print(f"period        {f'{period:.12g} s' if period else 'none: no oscillation'}")
        if not limits:
            return 0
        print()
        rows = [(name, limit.formula, f"{limit.rate:.12g}", limit.says) for name, limit in limits.items()]
        print(table(("limit", "formula", "rad/s", "what is changed"), rows))
    return 0
