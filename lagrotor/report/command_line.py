"""The command `lagrotor`. Exit status: 0 as recorded, 1 a verdict changed, 2 bad usage or input, 130 interrupted."""

import argparse
import json
import math
import os
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import __version__
from ..errors import InputError, LagrotorError
from .options import Parser, add_scene, add_shock, check_file, check_folder, scene_of, shock_of

_MOST_SAMPLES = 10_000_000
_CLOSED_PIPE = 141  # what a shell reports for a program stopped by SIGPIPE


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and give its exit status; every refusal is one line on stderr."""
    try:
        arguments = _parser().parse_args(argv)
        status = int(arguments.run(arguments))
        sys.stdout.flush()
        return status
    except SystemExit as done:  # --help, --version
        return _flushed(int(done.code or 0))
    except BrokenPipeError:
        return _abandoned()
    except KeyboardInterrupt:
        return _say("interrupted", 130)
    except MemoryError:
        return _say("not enough memory: ask for fewer samples", 2)
    except (LagrotorError, OSError) as error:
        return _say(str(error), 2)


def _say(message: str, status: int) -> int:
    print("lagrotor:", " ".join(message.split()), file=sys.stderr)
    return status


def _flushed(status: int) -> int:
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        return _abandoned()
    return status


def _abandoned() -> int:
    """The reader has left: what is still in the buffer goes nowhere, so that nothing complains at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return _CLOSED_PIPE


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="lagrotor",
        description="Lagrangian mechanics of axially coupled rotor pairs: derived, decided, compared.",
        epilog="exit status: 0 as recorded, 1 a verdict changed, 2 bad usage or input\nexample: lagrotor reproduce",
    )
    parser.add_argument("--version", action="version", version=f"lagrotor {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)

    def command(name: str, run: Any, says: str, example: str) -> argparse.ArgumentParser:
        added = commands.add_parser(
            name, help=says, description=f"{says[0].upper()}{says[1:]}.", epilog=f"example: {example}"
        )
        added.set_defaults(run=run)
        return added

    added = command(
        "reproduce",
        _reproduce,
        "judge every equation, draw every figure, write the report",
        "lagrotor reproduce --out report",
    )
    added.add_argument("--out", type=Path, default=Path("report"), metavar="DIR", help="folder (default: report)")

    added = command("audit", _audit, "judge the paper's equations", "lagrotor audit 5.12 5.15 --json")
    added.add_argument("ids", nargs="*", metavar="ID", help="equations, such as 5.15 (default: all that are judged)")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object an equation")

    added = command("claims", _claims, "put the paper's claims on trial", "lagrotor claims C08 C22 --json")
    added.add_argument("ids", nargs="*", metavar="ID", help="claims, such as C08 (default: all)")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object a claim")

    added = command("figure", _figure, "draw figures of the paper as SVG and PNG", "lagrotor figure 17 18 --out .")
    added.add_argument("numbers", nargs="+", type=int, metavar="N", help="the paper's figure number")
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")

    added = command(
        "simulate",
        _simulate,
        "run a rotor pair and keep or show its motion",
        "lagrotor simulate --spins 10 -10 --shock 40 -11 0 --shock-time 2 --shock-width 0.05 --t-end 10 --out run.npz",
    )
    add_scene(added)
    add_shock(added)
    added.add_argument("--t-end", type=float, default=10.0, metavar="S", help="end of the run, s (default: 10)")
    added.add_argument("--samples", type=int, default=1001, metavar="N", help="times kept (default: 1001)")
    added.add_argument("--model", default="auto", help="auto, minimal, spheres or euler (default: auto)")
    added.add_argument("--tol", type=float, default=1e-9, help="tolerance of the solver (default: 1e-9)")
    added.add_argument("--out", type=Path, metavar="FILE", help="write .npz or .csv instead of showing a table")
    added.add_argument("--json", action="store_true", help="print the summary as a JSON object")

    from ..rotors.scenes import SCENES

    added = command(
        "animate",
        _animate,
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

    added = command(
        "rate", _rate, "the natural rate of a rotor pair, in closed form", "lagrotor rate --spins 10 -10 --json"
    )
    add_scene(added)
    added.add_argument("--json", action="store_true", help="print a JSON object")
    return parser


def _reproduce(given: argparse.Namespace) -> int:
    from .content import word
    from .reproduce import check_target, recorded, reproduce, steps
    from .terminal import progress

    check_target(given.out)
    with progress(steps()) as step:
        report = reproduce(given.out, step)
    counts = ", ".join(f"{count} {word(answer)}" for answer, count in report.counts.items())
    print(f"{len(report.verdicts)} equations judged: {counts or 'none'}; {len(report.waiting)} not yet judged")
    if report.claims:
        told = Counter(word(result.finding.outcome) for result in report.claims)
        print(f"{len(report.claims)} claims tried: {', '.join(f'{n} {outcome}' for outcome, n in told.items())}")
    print(f"{len(report.pictures)} figures drawn; {report.seconds:.1f} s; report: {given.out / 'index.html'}")
    return _compared(list(report.changes), recorded())


def _audit(given: argparse.Namespace) -> int:
    from ..paper import audit, scripts
    from ..paper.catalogue import equation, equations
    from .content import note, word
    from .reproduce import changes, outcomes, recorded
    from .terminal import progress, table

    for identifier in given.ids:
        equation(identifier)
    with progress(len(scripts.names("derivations", "s"))) as step:
        verdicts = audit.audit(step)
    judged = {verdict.id for verdict in verdicts}
    if waiting := [i for i in given.ids if i not in judged]:
        raise InputError(f"equation {waiting[0]} is not yet judged: no derivation states it")
    shown = [verdict for verdict in verdicts if not given.ids or verdict.id in given.ids]
    if given.json:
        print(audit.to_json(shown))
    else:
        rows = [(v.id, word(v.verdict), ": ".join(filter(None, (equation(v.id).title, note(v))))) for v in shown]
        print(table(("id", "verdict", "equation: order or condition"), rows))
    on_record = recorded()
    return _compared(changes(outcomes(shown), on_record, given.ids or equations()), on_record)


def _claims(given: argparse.Namespace) -> int:
    from ..paper import trials
    from ..paper.catalogue import claims
    from .content import word
    from .reproduce import changes, outcomes, recorded
    from .terminal import progress, table

    if unknown := [i for i in given.ids if i not in claims()]:
        raise InputError(f"claim {unknown[0]!r} is not in the catalogue: ids run from C01 to C{len(claims()):02d}")
    wanted = frozenset(given.ids or claims())
    with progress(len(wanted)) as step:
        results = trials.hear_all(step, wanted)
    if given.json:
        print(trials.to_json(results))
    else:
        rows = [(r.trial.id, word(r.finding.outcome), r.finding.explanation) for r in results]
        print(table(("id", "outcome", "what was measured"), rows))
    on_record = recorded()
    return _compared(changes(outcomes(heard=results), on_record, wanted), on_record)


def _compared(changes: list[str], on_record: dict[str, str] | None) -> int:
    if on_record is None:
        return _say("no verdicts are on record yet: nothing to compare these with", 0)
    for change in changes:
        _say(f"changed: {change}", 1)
    return 1 if changes else 0


def _figure(given: argparse.Namespace) -> int:
    from .figures import check_numbers, draw
    from .terminal import progress

    check_folder(given.out)
    numbers = check_numbers(given.numbers)
    with progress(len(numbers)) as step:
        for number in numbers:
            step(f"figure {number}")
            picture = draw(number, given.out)
            print(picture.svg, picture.png, sep="\n")
    return 0


def _animate(given: argparse.Namespace) -> int:
    from ..rotors.scenes import SCENES
    from .animate import animate, check_film
    from .terminal import progress

    ready, target = SCENES[given.scene], given.out or Path(f"{given.scene}.gif")
    t_end = ready.duration if given.t_end is None else given.t_end
    check_film(target, t_end, given.fps)
    check_folder(target.parent)

    import numpy as np

    from ..models.simulate import simulate

    with progress(1 + math.ceil(t_end)) as step:
        step("motion")
        run = simulate(ready.scene, np.linspace(0.0, t_end, math.ceil(100 * t_end) + 1))
        animate(run, target, given.fps, step)
    print(target)
    return 0


def _simulate(given: argparse.Namespace) -> int:
    if not (math.isfinite(given.t_end) and given.t_end > 0):
        raise InputError(f"--t-end {given.t_end:g} must be greater than zero and finite, in s")
    if not 2 <= given.samples <= _MOST_SAMPLES:
        raise InputError(f"--samples {given.samples} must lie between 2 and {_MOST_SAMPLES}")
    if given.out:
        check_file(given.out)
    scene = scene_of(given, shock_of(given))

    import numpy as np

    from ..models.simulate import simulate

    run = simulate(scene, np.linspace(0.0, given.t_end, given.samples), model=given.model, tol=given.tol)
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


def _run_table(run: dict[str, Any]) -> str:
    from .terminal import table

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


def _rate(given: argparse.Namespace) -> int:
    scene = scene_of(given)

    from ..rotors.closed_forms import natural_rate

    rate = float(natural_rate(scene))
    period = 2 * math.pi / abs(rate) if rate else None
    if given.json:
        print(json.dumps({"rate": rate, "period": period}))
    else:
        print(f"natural rate  {rate:.12g} rad/s")
        print(f"period        {f'{period:.12g} s' if period else 'none: no oscillation'}")
    return 0
