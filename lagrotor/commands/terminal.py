"""The terminal: a parser that reports errors in one line, tables that fit the terminal, and the display of progress."""

import argparse
import json
import os
import re
import shutil
import sys
import textwrap
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn

from lagrotor.errors import InputError, near

# A function that adds a command: name, function to run, description, example.
Command = Callable[[str, Callable[[argparse.Namespace], int], str, str], argparse.ArgumentParser]


class Parser(argparse.ArgumentParser):
    """An argparse parser that raises InputError for bad usage, and reads -1e-3 and -inf as numbers, not as options."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **settings)
        self._negative_number_matcher = re.compile(r"-(\d|\.\d|inf|nan)", re.IGNORECASE)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Refuse what this command does not know here, so that the message names the help of this command."""
        known, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return known, unknown

    def error(self, message: str) -> NoReturn:
        choice = re.search(r"invalid choice: (.*) \(choose from (.*)\)", message)
        hint = near(choice[1].strip("'"), re.findall(r"[\w-]+", choice[2])) if choice else ""
        raise InputError(f"{message}{hint}; see {self.prog} --help")


def check_folder(folder: Path) -> None:
    """Raise InputError unless files can be written into the folder."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--out: {folder} is a file: give a folder")
    if not folder.is_dir():
        raise InputError(f"--out: there is no folder {folder}: make it first")
    if not os.access(folder, os.W_OK):
        raise InputError(f"--out: the folder {folder} cannot be written to: choose another")


def add_json(parser: argparse.ArgumentParser, what: str = "a JSON object") -> None:
    """Add the option --json, which prints data instead of text."""
    parser.add_argument("--json", action="store_true", help=f"print {what}")


def print_json(data: Any) -> None:
    print(json.dumps(data, indent=1, ensure_ascii=False))


_NARROWEST, _WIDTH = 20, 100  # columns: least width of wrapped text, width without a terminal


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a text table. On a terminal the last column wraps at its edge; elsewhere no line wraps."""
    widths = [max(len(row[i]) for row in (head, *rows)) for i in range(len(head) - 1)]
    indent = sum(widths) + 2 * len(widths)
    room = max(shutil.get_terminal_size().columns - indent, _NARROWEST) if sys.stdout.isatty() else sys.maxsize
    lines = []
    for row in (head, *rows):
        first = "".join(f"{cell:<{width}}  " for cell, width in zip(row, widths, strict=False))
        for i, text in enumerate(textwrap.wrap(row[-1], room) or [""]):
            lines.append(((first if i == 0 else " " * indent) + text).rstrip())
    return "\n".join(lines)


def wrap(text: str, indent: int) -> str:
    """Return a text wrapped to the terminal's width, without one to 100 characters.

    All lines but the first are indented by `indent` spaces.
    """
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _WIDTH
    return textwrap.fill(text, max(width, indent + _NARROWEST), subsequent_indent=" " * indent)


def say(message: str, status: int) -> int:
    """Print a message in one line on stderr and return the exit status `status`."""
    print("lagrotor:", " ".join(message.split()), file=sys.stderr)
    return status


def _clear_line() -> None:
    print(f"\r{'':<{shutil.get_terminal_size().columns - 1}}\r", end="", file=sys.stderr, flush=True)


@contextmanager
def progress(total: int, first: str = "") -> Iterator[Callable[..., None]]:
    """Yield a function that shows the progress of a work of `total` steps; it is called with a step's name at its begin, or with
    a name and the number of steps that are done.

    A terminal shows all steps in the same line; any other stderr gets one line per step. The line `first` stands before them.
    """
    if first:
        say(first, 0)
    count, start, live = 0, time.perf_counter(), sys.stderr.isatty()

    def step(name: str, done: int | None = None) -> None:
        nonlocal count
        count = count + 1 if done is None else done
        line = f"[{count}/{total}] {time.perf_counter() - start:4.0f} s  {name}"
        width = shutil.get_terminal_size().columns - 1
        print(f"\r{line[:width]:<{width}}" if live else line, end="" if live else "\n", file=sys.stderr, flush=True)

    try:
        yield step
    finally:
        if live and count:
            _clear_line()
