"""The command `lagrotor`. Exit status: 0 as recorded, 1 a verdict changed, 2 bad usage or input, 130 interrupted."""

import argparse
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from lagrotor.about import __version__
from lagrotor.commands.chart_command import add_chart, chart_command
from lagrotor.commands.options import Parser, add_pair, add_shock, add_start, check_folder
from lagrotor.commands.paper_commands import audit_command, claims_command, reproduce_command
from lagrotor.commands.scene_commands import animate_command, rate_command, simulate_command
from lagrotor.commands.stability_command import stability_command
from lagrotor.commands.terminal import say
from lagrotor.errors import LagrotorError

_CLOSED_PIPE = 141  # what a shell reports for a program stopped by SIGPIPE


class _Terminated(BaseException):
    """SIGTERM, which ends a run as an interrupt does: what it began is removed."""


def _terminated(number: int, frame: Any) -> None:
    raise _Terminated


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and give its exit status; every refusal is one line on stderr."""
    if sys.stdout is None:  # started with its output closed
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    with suppress(ValueError):  # not in the main thread: the caller keeps its signals
        signal.signal(signal.SIGTERM, _terminated)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a pipe's encoding may lack a letter: ? for it, no traceback
    try:
        arguments = _parser().parse_args(argv)
        status = int(arguments.run(arguments))
        sys.stdout.flush()
        return status
    except SystemExit as done:  # --help, --version
        return _flushed(int(done.code or 0))
    except BrokenPipeError:
        return _abandoned()
    except _Terminated:
        return say("terminated", 143)
    except KeyboardInterrupt:
        return say("interrupted", 130)
    except MemoryError:
        return say("not enough memory: ask for fewer samples", 2)
    except (LagrotorError, OSError) as error:
        return say(str(error), 2)


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
        reproduce_command,
        "judge every equation, draw every figure, write the report",
        "lagrotor reproduce --out report",
    )
    added.add_argument("--out", type=Path, default=Path("report"), metavar="DIR", help="folder (default: report)")
    added.add_argument("--jobs", type=int, metavar="N", help="processes (default: one a core, one in a debugger)")

    added = command("audit", audit_command, "judge the paper's equations", "lagrotor audit 5.12 5.15 --json")
    added.description = "Judge the paper's equations. For single ids only their own derivations run."
    added.add_argument("ids", nargs="*", metavar="ID", help="equations, such as 5.15 (default: all that are judged)")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object an equation")

    added = command("claims", claims_command, "test the paper's claims", "lagrotor claims C08 C22 --json")
    added.add_argument("ids", nargs="*", metavar="ID", help="claims, such as C08 (default: all)")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object a claim")

    added = command("figure", _figure, "draw figures as SVG and PNG", "lagrotor figure 17 t6 --out .")
    added.add_argument(
        "keys", nargs="+", metavar="N", help="the paper's figure number, or the name of another: t1 to t10, b1, m1"
    )
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")

    add_chart(command("chart", chart_command, "chart speed against accuracy", "lagrotor chart --quick --out ."))

    added = command(
        "simulate",
        simulate_command,
        "run a rotor pair and keep or show its motion",
        "lagrotor simulate --spins 10 -10 --shock 40 -11 0 --shock-time 2 --shock-width 0.05 --t-end 10 --out run.npz",
    )
    add_pair(added)
    add_start(added)
    add_shock(added)
    added.add_argument("--t-end", type=float, default=10.0, metavar="S", help="end of the run, s (default: 10)")
    added.add_argument("--samples", type=int, default=1001, metavar="N", help="times kept (default: 1001)")
    says = "auto, closed_form, linear, minimal, spheres or euler (default: auto)"
    added.add_argument("--model", default="auto", help=says)
    added.add_argument(
        "--tol", type=float, default=1e-9, help="error of the axes, or the solver's of a named model (default: 1e-9)"
    )
    says = "core, or fast where lagrotor[fast] is installed (default: core)"
    added.add_argument("--engine", default="core", help=says)
    added.add_argument(
        "--out",
        type=Path,
        metavar="FILE",
        help="write the run (.npz, .csv), a picture of it (.png, .svg, .pdf) or a film (.gif, .mp4); a line, no table",
    )
    added.add_argument("--json", action="store_true", help="print the summary as a JSON object")

    from lagrotor.pair.examples import SCENES

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

    added = command(
        "stability",
        stability_command,
        "where methods fail, predicted and found; how much runs in a second",
        "lagrotor stability --quick --out .",
    )
    added.add_argument("--quick", action="store_true", help="shorter runs and coarser thresholds: seconds, not minutes")
    added.add_argument("--json", action="store_true", help="print a JSON object")
    added.add_argument("--out", type=Path, metavar="DIR", help="existing folder for stability.svg, .png and .json")

    added = command(
        "rate", rate_command, "the natural rate of a rotor pair, in closed form", "lagrotor rate --spins 10 -10 --json"
    )
    add_pair(added)
    added.add_argument("--json", action="store_true", help="print a JSON object")
    return parser


def _figure(given: argparse.Namespace) -> int:
    from lagrotor.commands.terminal import progress
    from lagrotor.pictures.figures import check_keys, draw

    check_folder(given.out)
    keys = check_keys(given.keys)
    with progress(len(keys)) as step:
        for key in keys:
            step(f"figure {key}")
            picture = draw(key, given.out)
            print(picture.svg, picture.png, sep="\n")
    return 0
