"""The command `lagrotor`.

Exit status: 0 as recorded, 1 a verdict changed, 2 bad usage or input, 130 interrupted, 143 terminated.
"""

import argparse
import os
import signal
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from lagrotor.about import __version__
from lagrotor.commands.benchmark_commands import add_benchmark_commands
from lagrotor.commands.paper_commands import add_paper_commands
from lagrotor.commands.robot_commands import add_robot_commands
from lagrotor.commands.scene_commands import add_scene_commands, add_structure_commands
from lagrotor.commands.terminal import Parser, say
from lagrotor.errors import LagrotorError
from lagrotor.process_settings import begin_process

_CLOSED_PIPE = 141  # exit status in a shell after SIGPIPE


class _Terminated(BaseException):
    """The exception raised by the signal SIGTERM. It ends a run as an interrupt does: unfinished files are removed."""


def _raise_terminated(number: int, frame: Any) -> None:
    raise _Terminated


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status; every refusal is one line on stderr."""
    if sys.stdout is None:  # started with its output closed
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    begin_process()
    with suppress(ValueError):  # outside the main thread, signals belong to the caller
        signal.signal(signal.SIGTERM, _raise_terminated)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a character outside a pipe's encoding becomes ?
    try:
        parser, words = _parser(), sys.argv[1:] if argv is None else argv
        if not words:
            parser.print_help()
            return 0
        arguments = parser.parse_args(words)
        with warnings.catch_warnings(record=True) as caught:
            status = int(arguments.run(arguments))
        for warning in caught:
            say(f"warning: {warning.message}", 0)
        sys.stdout.flush()
        return status
    except SystemExit as stop:  # --help, --version
        return _flush(int(stop.code or 0))
    except BrokenPipeError:
        return _close_pipe()
    except _Terminated as stop:
        return say(": ".join(filter(None, ("terminated", str(stop)))), 143)
    except KeyboardInterrupt as stop:
        return say(": ".join(filter(None, ("interrupted", str(stop)))), 130)
    except MemoryError:
        return say("not enough memory: take fewer samples", 2)
    except LagrotorError as error:
        return say(str(error), 2)
    except OSError as error:
        return say(": ".join(str(text) for text in (error.filename, error.strerror) if text) or str(error), 2)


def _flush(status: int) -> int:
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        return _close_pipe()
    return status


def _close_pipe() -> int:
    """Redirect the buffered output to the null device, because the reader of the pipe has closed it."""
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

    def command(name: str, run: Callable[..., int], says: str, example: str) -> argparse.ArgumentParser:
        added = commands.add_parser(
            name, help=says, description=f"{says[0].upper()}{says[1:]}.", epilog=f"example: {example}"
        )
        added.set_defaults(run=run)
        return added

    add_paper_commands(command)
    add_scene_commands(command)
    add_structure_commands(command)
    add_robot_commands(command)
    add_benchmark_commands(command)
    return parser
