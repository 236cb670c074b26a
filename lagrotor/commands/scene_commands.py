"""The commands for a scene (simulate, sweep, animate, rate) and for a structure.

Bad input is refused before any computation.
"""

import argparse
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from lagrotor.commands.robot_commands import add_robot, simulate_robot
from lagrotor.commands.terminal import Command, add_json, check_folder, print_json, progress, table
from lagrotor.errors import InputError
from lagrotor.files import FILMS, PICTURES
from lagrotor.pair.examples import SCENES
from lagrotor.pair.scene import Link, Scene, Shock


def add_scene(parser: argparse.ArgumentParser) -> None:
    """Add the options that state a scene: spins and bar, or a scene file with all data."""
    group = parser.add_argument_group("scene")
    group.add_argument("--spins", nargs=2, type=float, metavar=("W1", "W2"), help="axial angular velocities, rad/s")
    group.add_argument("--link-length", type=float, metavar="M", help=f"length of the bar (default: {Link.length:g})")
    group.add_argument("--link-mass", type=float, metavar="KG", help=f"mass of the bar (default: {Link.mass:g})")
    says = f"transverse inertia of the bar, kg m² (default: {Link.inertia:g})"
    group.add_argument("--link-inertia", type=float, metavar="X", help=says)
    says = "the whole scene from a TOML file: rotors, bar, axes, rates, shock; simulate --write-scene writes one"
    group.add_argument("--scene", type=Path, metavar="FILE", help=says)


def add_shock(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("shock: force exp(-((t - time)/width)^2) on the tip of rotor 1")
    group.add_argument("--shock", nargs=3, type=float, metavar=("FX", "FY", "FZ"), help="force, N")
    group.add_argument("--shock-time", type=float, metavar="S", help="centre of the pulse, s")
    group.add_argument("--shock-width", type=float, metavar="S", help="width of the pulse, s")


def scene_from_options(options: argparse.Namespace) -> Scene:
    """Return the scene that the options state or the scene file contains. Raises InputError if both are given."""
    shock = _shock(options) if "shock" in options else None  # pair and rate take none
    link = {
        name: value for name in ("length", "mass", "inertia") if (value := vars(options)[f"link_{name}"]) is not None
    }
    if options.scene:
        from lagrotor.pair.scene_document import read_scene

        named = {"--spins": options.spins, "--shock": shock} | {f"--link-{name}": x for name, x in link.items()}
        if both := [name for name, value in named.items() if value is not None]:
            raise InputError(f"--scene and {both[0]}: the file has the whole scene; change it there")
        return read_scene(options.scene)
    if options.spins is None:
        raise InputError("--spins W1 W2 is missing: give the axial angular velocities in rad/s, or --scene FILE")
    return Scene(spins=tuple(options.spins), link=Link(**link), shock=shock)


def _shock(options: argparse.Namespace) -> Shock | None:
    """Return the shock that the options state, None if no option does. Raises InputError if only some are given."""
    values = {"--shock": options.shock, "--shock-time": options.shock_time, "--shock-width": options.shock_width}
    missing = [name for name, value in values.items() if value is None]
    if len(missing) == len(values):
        return None
    if missing:
        raise InputError(f"a shock needs {' and '.join(missing)} too: give its force, its time and its width")
    return Shock(tuple(options.shock), options.shock_time, options.shock_width)


def check_file(path: Path) -> None:
    """Raise InputError unless a run can be written to the path: its ending must be known, its folder writable."""
    endings = (".npz", ".csv", *PICTURES, *FILMS)
    if path.suffix not in endings:
        raise InputError(f"--out {path}: the name must end in {', '.join(endings)}")
    if path.is_dir():
        raise InputError(f"--out {path} is a folder: give a file")
    check_folder(path.parent)


# A function that returns a scene with one value changed.
_Change = Callable[[Scene, float], Scene]


def _bar_field(field: str) -> _Change:
    def change(scene: Scene, value: float) -> Scene:
        if scene.link is None:
            raise InputError(f"--vary link-{field}: a pair without a bar has none: vary paired, spin1 or spin2")
        return replace(scene, link=replace(scene.link, **{field: value}))

    return change


def _on_precession(scene: Scene, value: float) -> Scene:
    from lagrotor.models.orbits.precession import paired_scene

    return paired_scene(scene, value)


_VARIED: dict[str, tuple[str, _Change]] = {
    "paired": ("amplitude of the paired precession", _on_precession),
    "spin1": ("spin of rotor 1, rad/s", lambda scene, value: replace(scene, spins=(value, scene.spins[1]))),
    "spin2": ("spin of rotor 2, rad/s", lambda scene, value: replace(scene, spins=(scene.spins[0], value))),
    "link-length": ("length of the bar, m", _bar_field("length")),
    "link-mass": ("mass of the bar, kg", _bar_field("mass")),
    "link-inertia": ("inertia of the bar, kg m²", _bar_field("inertia")),
}
_MOST = 100_000  # values of a varied parameter; their scenes are in memory at once
_TOLERANCE = "target for the estimated largest error of an axis over the run"


def add_sweep(added: argparse.ArgumentParser) -> None:
    """Add the options of the command sweep."""
    add_scene(added)
    add_shock(added)
    says = "; ".join(f"{name}: {what}" for name, (what, _) in _VARIED.items())
    added.add_argument("--vary", choices=_VARIED, metavar="NAME", help=says)
    added.add_argument("--between", nargs=3, metavar=("FROM", "TO", "N"), help="N values, evenly from FROM to TO")
    added.add_argument("--t-end", type=float, default=10.0, metavar="S", help="end of the runs, s (default: 10)")
    added.add_argument("--samples", type=int, default=3, metavar="N", help="number of times (default: 3)")
    added.add_argument("--tol", type=float, default=1e-8, help=f"{_TOLERANCE} (default: 1e-8)")
    says = "write the results to a folder; after an interruption the same command goes on"
    added.add_argument("--folder", type=Path, metavar="FOLDER", help=says)
    added.add_argument(
        "--workers", type=int, metavar="N", help="number of processes on this machine (default: this one)"
    )
    added.add_argument("--scheduler", metavar="ADDRESS", help="run on the cluster of a dask scheduler, tcp://HOST:PORT")
    add_json(added, "a JSON list, one object per run; with --folder one object for all")


def _values(options: argparse.Namespace) -> list[float]:
    if options.vary is None or options.between is None:
        raise InputError("--vary NAME and --between FROM TO N are needed")
    try:
        first, last, count = float(options.between[0]), float(options.between[1]), int(options.between[2])
    except ValueError:
        raise InputError(f"--between {' '.join(options.between)}: give two numbers and a count") from None
    if not (math.isfinite(first) and math.isfinite(last) and 1 <= count <= _MOST):
        raise InputError(f"--between {' '.join(options.between)}: give finite numbers and a count from 1 to {_MOST}")
    return [first + (last - first) * i / max(count - 1, 1) for i in range(count)]


@contextmanager
def _executor(options: argparse.Namespace) -> Iterator[Any]:
    """Yield the executor that the options state. An interruption says how to go on."""
    from lagrotor.models.sweeps.executors import process_pool
    from lagrotor.numerics.run import optional_package

    if options.workers is not None and (options.workers < 1 or options.scheduler):
        raise InputError(f"--workers {options.workers}: give 1 or more, without --scheduler")
    try:
        if options.scheduler:
            with optional_package("distributed").Client(options.scheduler) as client:
                yield client
        elif options.workers:
            with process_pool(options.workers) as pool:
                yield pool
        else:
            yield None
    except BaseException as stop:
        if isinstance(stop, Exception) or not options.folder:
            raise
        says = f"the finished runs are in {options.folder}; the same command goes on"
        raise type(stop)(says) from None


def sweep_command(options: argparse.Namespace) -> int:
    """Simulate the scene for each value of the varied parameter. Print one line per run, or the summary of a folder."""
    if not (math.isfinite(options.t_end) and options.t_end > 0):
        raise InputError(f"--t-end {options.t_end:g} must be above zero")
    if not 2 <= options.samples <= _MOST_SAMPLES:
        raise InputError(f"--samples {options.samples} must lie between 2 and {_MOST_SAMPLES}")
    name, values, scene = options.vary, _values(options), scene_from_options(options)
    scenes = [_VARIED[name][1](scene, value) for value in values]

    import numpy as np

    from lagrotor.models.sweeps.sweep import sweep

    times = np.linspace(0.0, options.t_end, options.samples)
    with progress(len(values)) as step, _executor(options) as executor:
        ensemble = sweep(
            scenes, times, options.tol, folder=options.folder, executor=executor,
            progress=lambda done, n: step("runs", done),
        )  # fmt: skip
    if options.folder:
        print_json(ensemble.summary()) if options.json else print(ensemble)
        return 1 if len(ensemble.failed) else 0
    rows = [
        {name: value, "model": run.model, "evaluations": run.evaluations,
         "tip_1": run.tips[0, -1].tolist(), "tip_2": run.tips[1, -1].tolist()}
        for value, run in zip(values, ensemble, strict=True)
    ]  # fmt: skip
    if options.json:
        print_json(rows)
    else:
        cells = [
            (f"{r[name]:.6g}", r["model"], str(r["evaluations"]), "  ".join(f"{x:.6f}" for x in r["tip_1"]))
            for r in rows
        ]
        print(table((name, "model", "evaluations", f"tip 1 at {options.t_end:g} s [m]"), cells))
    return 1 if len(ensemble.failed) else 0


_MOST_SAMPLES = 10_000_000  # about 2 GB of memory
_FPS = 25.0  # frames per second


def add_scene_commands(command: Command) -> None:
    """Add the commands for scenes: simulate, sweep, animate and rate."""
    _add_simulate(
        command(
            "simulate",
            simulate_command,
            "simulate a rotor pair, or the robot of a URDF or MJCF file; save or show the motion",
            "lagrotor simulate --spins 10 -10 --shock 40 -11 0 --shock-time 2 --shock-width 0.05 --t-end 10 --out run.npz",
        )
    )
    add_sweep(
        command(
            "sweep",
            sweep_command,
            "simulate a rotor pair for many values of one parameter",
            "lagrotor sweep --spins 10 -10 --vary paired --between 0.05 0.3 6",
        )
    )
    added = command(
        "animate",
        animate_command,
        "write the motion of an example scene as a GIF",
        "lagrotor animate free-precession --out pair.gif",
    )
    says = "\n".join(f"  {name:<18} {ready.says}" for name, ready in SCENES.items())
    added.epilog = f"scenes:\n{says}\n\n{added.epilog}"
    added.add_argument("scene", choices=SCENES, metavar="SCENE", help="one of the scenes below")
    added.add_argument("--out", type=Path, metavar="FILE", help="a .gif (default: SCENE.gif here)")
    added.add_argument("--t-end", type=float, metavar="S", help="end of the run, s (default: the scene's own)")
    add_json(added, "a JSON object with the file's name")

    added = command(
        "rate", rate_command, "compute the natural rate of a rotor pair", "lagrotor rate --spins 10 -10 --json"
    )
    add_scene(added)
    add_json(added)


def _add_simulate(added: argparse.ArgumentParser) -> None:
    says = "a URDF or MJCF file in place of the options of a scene"
    added.add_argument("file", nargs="?", type=Path, metavar="FILE", help=says)
    says = "initial coordinates and velocities of a file, such as elbow=0.5 elbow_dot=1 (default: at rest as the file says)"
    added.add_argument("--start", nargs="+", metavar="NAME=X", help=says)
    add_robot(added)
    add_scene(added)
    add_shock(added)
    says = "start on the paired precession of this amplitude (opposite spins)"
    added.add_argument("--paired", type=float, metavar="R0", help=says)
    added.add_argument("--write-scene", type=Path, metavar="FILE", help="also write the scene as TOML, for --scene")
    added.add_argument("--t-end", type=float, default=10.0, metavar="S", help="end of the run, s (default: 10)")
    added.add_argument("--samples", type=int, default=1001, metavar="N", help="number of saved times (default: 1001)")
    says = "auto, closed_form, linear, averaged, minimal, spheres or euler (default: auto)"
    added.add_argument("--model", default="auto", help=says)
    added.add_argument("--tol", type=float, default=1e-9, help=f"{_TOLERANCE} (default: 1e-9)")
    added.add_argument(
        "--out",
        type=Path,
        metavar="FILE",
        help="write the run (.npz, .csv), a picture (.png, .svg, .pdf) or a film (.gif), and print one line instead of the table",
    )
    add_json(added, "the summary as a JSON object")


def animate_command(options: argparse.Namespace) -> int:
    from lagrotor.drawing.film import check_film

    ready, target = SCENES[options.scene], options.out or Path(f"{options.scene}.gif")
    t_end = ready.duration if options.t_end is None else options.t_end
    check_film(target, t_end, _FPS)
    check_folder(target.parent)

    import numpy as np

    from lagrotor.models.simulate import simulate

    with progress(1 + math.ceil(t_end)) as step:
        step("motion")
        run = simulate(ready.scene, np.linspace(0.0, t_end, math.ceil(100 * t_end) + 1))
        run.animate(target, _FPS, step)
    print_json({"file": str(target)}) if options.json else print(target)
    return 0


def simulate_command(options: argparse.Namespace) -> int:
    if not (math.isfinite(options.t_end) and options.t_end > 0):
        raise InputError(f"--t-end {options.t_end:g} must be greater than zero and finite, in s")
    if not 2 <= options.samples <= _MOST_SAMPLES:
        raise InputError(f"--samples {options.samples} must lie between 2 and {_MOST_SAMPLES}")
    if options.write_scene and options.write_scene.suffix != ".toml":
        raise InputError(f"--write-scene {options.write_scene}: the name must end in .toml")
    if options.out:
        check_file(options.out)
    if options.out and options.out.suffix in FILMS:
        from lagrotor.drawing.film import check_film

        check_film(options.out, options.t_end, _FPS)
    if options.file:
        of_scene = (
            "spins",
            "link_mass",
            "link_inertia",
            "scene",
            "shock",
            "shock_time",
            "shock_width",
            "paired",
            "write_scene",
            "model",
        )
        if given := [name for name in of_scene if vars(options)[name] not in (None, "auto")]:
            raise InputError(
                f"--{given[0].replace('_', '-')} belongs to a scene, and {options.file} is none: leave it out"
            )
        return simulate_robot(options)
    if options.start or options.base != "fixed":
        raise InputError("--start and --base belong to a robot file: name the file, lagrotor simulate arm.urdf")
    scene = _scene_with_start(scene_from_options(options), options)

    import numpy as np

    from lagrotor.models.simulate import simulate

    times = np.linspace(0.0, options.t_end, options.samples)
    run = simulate(scene, times, options.model, options.tol)
    if options.out:
        run.save(options.out)
    summary = {
        "model": run.model,
        "why": run.why,
        "samples": options.samples,
        "t_end": options.t_end,
        "evaluations": run.evaluations,
        "energy_first": float(run.energy[0]),
        "energy_last": float(run.energy[-1]),
        "link_length_spread": float(np.ptp(run.link_length)),
        "tip_1": run.tips[0, -1].tolist(),
        "tip_2": run.tips[1, -1].tolist(),
    }
    if options.json:
        print_json(summary)
    elif options.out:
        print(f"{options.out}: {options.samples} times by the model {run.model} ({run.why})")
    else:
        print(_run_table(summary))
    return 0


def _scene_with_start(scene: Scene, options: argparse.Namespace) -> Scene:
    """Return the scene to simulate. With `--paired` it starts on the paired precession of this amplitude.

    With `--write-scene` the scene is also written to a file.
    """
    if options.paired is not None:
        from lagrotor.models.orbits.precession import paired_scene

        scene = paired_scene(scene, options.paired)
    if options.write_scene:
        from lagrotor.pair.scene_document import write_scene

        write_scene(scene, options.write_scene)
    return scene


def _run_table(run: dict[str, Any]) -> str:
    def point(tip: list[float]) -> str:
        return "  ".join(f"{x:.9f}" for x in tip)

    rows = [
        ("model", f"{run['model']} ({run['why']})"),
        ("evaluations", str(run["evaluations"])),
        ("initial energy [J]", f"{run['energy_first']:.12g}"),
        ("final energy [J]", f"{run['energy_last']:.12g}"),
        ("link length, spread [m]", f"{run['link_length_spread']:.3g}"),
        ("tip 1 at the end [m]", point(run["tip_1"])),
        ("tip 2 at the end [m]", point(run["tip_2"])),
    ]
    return table((f"{run['t_end']:g} s", f"{run['samples']} times"), rows)


def rate_command(options: argparse.Namespace) -> int:
    scene = scene_from_options(options)

    from lagrotor.theory.natural_rate import natural_rate, natural_rate_limits

    rate, limits = natural_rate(scene), natural_rate_limits(scene) if scene.link else {}
    period = 2 * math.pi / abs(rate) if rate else None
    if options.json:
        rates = {name: limit.rate for name, limit in limits.items()}
        print_json({"rate": rate, "period": period, "limits": rates})
    else:
        print(f"natural rate  {rate:.12g} rad/s")
        print(f"period        {f'{period:.12g} s' if period else 'none: no oscillation'}")
        if not limits:
            return 0
        print()
        rows = [(name, limit.formula, f"{limit.rate:.12g}", limit.says) for name, limit in limits.items()]
        print(table(("limit", "formula", "rad/s", "change"), rows))
    return 0


_ENDINGS = (*PICTURES, *FILMS, ".toml")


def add_structure_commands(command: Command) -> None:
    """Add the command structure."""
    added = command(
        "structure",
        structure_command,
        "show the stability and the modes of a structure of rotors and bars",
        "lagrotor structure corner --out corner.png",
    )
    says = "a TOML file with joints, bars, spins …, or a name of the gallery, such as corner; list prints the names"
    added.add_argument("structure", metavar="FILE", help=says)
    added.add_argument("--out", type=Path, metavar="FILE", help="write a picture, a film (.gif) or the .toml itself")
    add_json(added)


def structure_command(options: argparse.Namespace) -> int:
    from lagrotor.structures.gallery import GALLERY, example
    from lagrotor.structures.structure import read_structure

    if options.structure == "list":
        listed = {name: entry.says for name, entry in GALLERY.items()}
        print_json(listed) if options.json else print(table(("name", "description"), list(listed.items())))
        return 0
    if options.out and options.out.suffix not in _ENDINGS:
        raise InputError(f"--out {options.out}: the name must end in {', '.join(_ENDINGS)}")
    if options.out:
        check_folder(options.out.parent)
    s = read_structure(options.structure) if options.structure.endswith(".toml") else example(options.structure)
    if options.out:
        ready = GALLERY.get(options.structure)
        _write(s, options.out, ready.duration if ready else 5.0)
    summary = _summary(s)
    print_json(summary) if options.json else print(_table(summary))
    if options.out and not options.json:
        print(options.out)
    return 0


def _write(s: Any, out: Path, duration: float) -> None:
    import numpy as np

    from lagrotor.files import write_beside
    from lagrotor.structures.structure import write_structure

    if out.suffix == ".toml":
        write_structure(s, out)
    elif out.suffix in PICTURES:
        write_beside(out, lambda file: s.plot().savefig(file, format=out.suffix[1:]))
    else:
        from lagrotor.drawing.film import check_film

        check_film(out, duration, _FPS)
        tilt = 0.05 * np.random.default_rng(1).standard_normal((len(s.joints), 2))
        s.simulate(np.linspace(0, duration, math.ceil(100 * duration) + 1), tilt, tol=1e-6).animate(out)


def _summary(s: Any) -> dict[str, Any]:
    rotors, bars = len(s.joints), len(s.bars)
    summary: dict[str, Any] = {"rotors": rotors, "bars": bars, "degrees_of_freedom": 2 * rotors - bars}
    if not s.natural:
        why = "upright, a bar is not as long as the distance of its tips; a film shows the motion (--out FILE.gif)"
        return summary | {"stands": None, "why": why}
    standing, modes = s.stands(), s.modes()
    return summary | {
        "stands": standing.stands,
        "kind": standing.kind,
        "why": standing.why,
        "growth": standing.growth,
        "critical_spin": standing.critical_spin if standing.critical_spin < math.inf else None,
        "topple": modes.topple,
        "modes": [
            {"rate": float(w), "growth": float(g), "energy_sign": int(sign)}
            for w, g, sign in zip(modes.rates, modes.growth, modes.energy_signs, strict=True)
        ],
    }


def _table(summary: dict[str, Any]) -> str:
    verdict = {True: "yes", False: "no", None: "not judged"}[summary["stands"]]
    rows = [("stable", f"{verdict}: {summary['why']}")]
    count = f"{summary['degrees_of_freedom']}; rotors: {summary['rotors']}, bars: {summary['bars']}"
    if summary["stands"] is None:
        return table(("structure", ""), [*rows, ("degrees of freedom", count)])
    factor = summary["critical_spin"]
    least = "no spin suffices" if factor is None else f"{factor:.6g} times the given spins" if factor else "zero"
    modes = enumerate(summary["modes"], 1)
    kind = "never at these spins" if summary["kind"] == "never" and factor else summary["kind"]
    rows.insert(0, ("stability", kind))
    rows += [
        ("least spins for linear stability", least),
        ("degrees of freedom", f"{count}; modes that grow: {summary['topple']}"),
    ]
    energies = {1: "", 0: "", -1: ", of negative energy"}
    rows += [
        (f"mode {k}", f"{m['rate']:.6g} rad/s, growth {m['growth']:.4g} 1/s{energies[m['energy_sign']]}")
        for k, m in modes
    ]
    return table(("structure", ""), rows)
