"""The public names as a page: how each is called and what its docstring says, read off the code."""

import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import Any

import lagrotor

# What the names of `lagrotor` return or are chosen by, and where more of them are.
_BESIDE = {
    "Trajectory": "lagrotor.numerics.trajectory",
    "choose": "lagrotor.models.choose",
    "sweep": "lagrotor.study.ensemble",
    "exact_orbit": "lagrotor.models.orbit",
    "ClosedForm": "lagrotor.rotors.closed_forms",
    "corrected_trajectories": "lagrotor.rotors.closed_forms",
    "paired_frequency": "lagrotor.rotors.closed_forms",
}


@dataclass(frozen=True)
class Entry:
    """A public name: where it is imported from, its call, its docstring, and (call, first line) of its members."""

    name: str
    module: str
    call: str
    text: str
    members: tuple[tuple[str, str], ...]


def entries() -> Iterator[Entry]:
    """Every public name of the package, then those beside it, in alphabetical order."""
    for name in lagrotor.__all__:
        yield _entry(name, "lagrotor", getattr(lagrotor, name))
    for name, module in sorted(_BESIDE.items()):
        yield _entry(name, module, getattr(import_module(module), name))


def _entry(name: str, module: str, thing: Any) -> Entry:
    members: tuple[tuple[str, str], ...] = ()
    if inspect.isclass(thing):
        public = [(n, value) for n, value in vars(thing).items() if not n.startswith("_") and _documented(value)]
        members = tuple((_call(n, value), _first_line(value)) for n, value in public)
    return Entry(name, module, _call(name, thing), inspect.getdoc(thing) or "", members)


def _documented(value: Any) -> bool:
    return bool(value.__doc__) and (inspect.isroutine(value) or isinstance(value, property | cached_property))


def _first_line(value: Any) -> str:
    return (inspect.getdoc(value) or "").split("\n\n")[0].replace("\n", " ")


def _call(name: str, thing: Any) -> str:
    """name(argument=default, …), types left to the docstring; a property is its name."""
    if isinstance(thing, property | cached_property):
        return name
    parts: list[str] = []
    star = False
    for argument in inspect.signature(thing).parameters.values():
        if argument.name == "self":
            continue
        if argument.kind is argument.KEYWORD_ONLY and not star:
            parts, star = [*parts, "*"], True
        prefix = (
            "*" if argument.kind is argument.VAR_POSITIONAL else "**" if argument.kind is argument.VAR_KEYWORD else ""
        )
        default = "" if argument.default is argument.empty else f"={_short(argument.default)}"
        parts.append(prefix + argument.name + default)
    return f"{name}({', '.join(parts)})"


def _short(default: Any) -> str:
    """A default value without the places of memory that some carry."""
    return "…" if re.search(r" at 0x|<factory>", repr(default)) else repr(default)


def api_markdown() -> str:
    """The page as Markdown."""
    blocks = [
        "# lagrotor from Python",
        "Angles in rad, lengths in m, masses in kg, times in s, unless a line says otherwise.",
    ]
    for entry in entries():
        blocks.append(
            f"## {entry.name}\n\n```python\nfrom {entry.module} import {entry.name}\n{entry.call}\n```\n\n{entry.text}"
        )
        if entry.members:
            blocks.append("\n".join(f"- `{call}`: {line}" for call, line in entry.members))
    return "\n\n".join(blocks) + "\n"
