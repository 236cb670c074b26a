"""Generated functions that are stored as source, so that a first call reads it instead of deriving it.

A function that returns the source of another is marked `@generated(arguments)`. For these arguments its text is stored in
`generated.txt` beside its module, one block of plain Python each; for any others it is derived when it is called. `python -m
tests.numerics.renew_generated` writes these files, and a test derives every block again.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

_HEAD = re.compile(r"^# %% (.*)\n", re.MULTILINE)
_MOST = 64  # functions of one kind in the memory of a process


@dataclass(frozen=True, eq=False)
class GeneratedFunction:
    """A function whose source is returned by `derive`, as the last definition of the text. For the arguments in `cases` the text
    is stored in a file."""

    derive: Callable[..., str]
    cases: tuple[tuple[Any, ...], ...]
    _functions: Callable[..., Any] = field(init=False)

    def __post_init__(self) -> None:
        functions = lru_cache(_MOST)(lambda *arguments: function_of(self.source(*arguments)))
        object.__setattr__(self, "_functions", functions)

    def __call__(self, *arguments: Any) -> Any:
        return self._functions(*arguments)

    def source(self, *arguments: Any) -> str:
        """Return the source for these arguments: the stored text, or else the derived one."""
        return _blocks(self.file).get(self.name(*arguments)) or self.derive(*arguments)

    def name(self, *arguments: Any) -> str:
        """Return the heading of a block: module, function and arguments."""
        return f"{self.derive.__module__}.{self.derive.__name__}({', '.join(map(repr, arguments))})"

    @property
    def file(self) -> Path:
        """The file that stores the sources of all modules in the folder."""
        return Path(str(sys.modules[self.derive.__module__].__file__)).with_name("generated.txt")


def generated(cases: Iterable[tuple[Any, ...]]) -> Callable[[Callable[..., str]], GeneratedFunction]:
    """Mark a function that returns the source of another function. The sources for the arguments in `cases` are stored."""
    return lambda derive: GeneratedFunction(derive, tuple(cases))


def function_of(source: str) -> Callable[..., Any]:
    """Return the last function that a source defines."""
    names: dict[str, Any] = {}
    exec(source, names)
    function: Callable[..., Any] = list(names.values())[-1]
    return function


@cache
def _blocks(file: Path) -> dict[str, str]:
    """Return the blocks of a file by their headings; an empty dictionary if there is no file."""
    try:
        _, *blocks = _HEAD.split(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    return dict(zip(blocks[::2], (block.rstrip() for block in blocks[1::2]), strict=True))
