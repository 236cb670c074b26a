"""The public names as a page: how each is called and what its docstring says, read off the code."""

import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from html import escape
from importlib import import_module
from pathlib import Path
from typing import Any

import lagrotor
from lagrotor.numerics.any_run import Run
from lagrotor.report.page.page_pieces import code, prose

# What the names of `lagrotor` return or are chosen by, and where more of them are.
_BESIDE = {
    "Ensemble": "lagrotor.models.sweeps.ensemble",
    "choose": "lagrotor.models.simulate",
    "exact_orbit": "lagrotor.models.orbits.shooting",
    "ClosedForm": "lagrotor.theory.closed_form",
    "Frame": "lagrotor.mechanics",
    "System": "lagrotor.mechanics",
    "coordinates": "lagrotor.mechanics",
    "judge": "lagrotor.paper",
    "SystemRun": "lagrotor.mechanics",
    "Event": "lagrotor.mechanics",
    "Impact": "lagrotor.mechanics",
}


_TITLE = "lagrotor from Python"
_UNITS = "Angles in rad, lengths in m, masses in kg, times in s, unless a line says otherwise."


@dataclass(frozen=True)
class ApiEntry:
    """A public name: where it is imported from, its call, its docstring, and (call, first line) of its members."""

    name: str
    module: str
    call: str
    text: str
    members: tuple[tuple[str, str], ...]


def entries() -> Iterator[ApiEntry]:
    """Every public name of the package, then those beside it, in alphabetical order."""
    for name in lagrotor.__all__:
        yield _entry(name, "lagrotor", getattr(lagrotor, name))
    for name, module in sorted(_BESIDE.items()):
        yield _entry(name, module, getattr(import_module(module), name))


def _entry(name: str, module: str, thing: Any) -> ApiEntry:
    members: tuple[tuple[str, str], ...] = ()
    if inspect.isclass(thing):
        # Those of `Run`, which every run extends, belong to it.
        kinds = [thing, *([Run] if issubclass(thing, Run) else [])]
        held = {n: value for kind in reversed(kinds) for n, value in vars(kind).items()}
        public = [(n, value) for n, value in held.items() if not n.startswith("_") and _documented(value)]
        members = tuple((_call(n, value), _first_line(value)) for n, value in public)
    return ApiEntry(name, module, _call(name, thing), inspect.getdoc(thing) or "", members)


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


def _words(text: str) -> str:
    """Text of a docstring for HTML: what is between backticks as code."""
    parts = enumerate(text.split("`"))
    return "".join(f"<code>{escape(part)}</code>" if i % 2 else prose(part) for i, part in parts)


def api_page() -> str:
    """The page as HTML, in the report's style."""
    style = (Path(__file__).with_name("page") / "page.css").read_text(encoding="utf-8")
    blocks = []
    for entry in entries():
        text = "".join(f"<p>{_words(part)}</p>" for part in entry.text.split("\n\n"))
        members = "".join(f"<li><code>{escape(call)}</code>: {_words(line)}</li>" for call, line in entry.members)
        how = code(f"from {entry.module} import {entry.name}\n{entry.call}")
        listed = f"<ul>{members}</ul>" if members else ""
        blocks.append(f'<article id="{entry.name}"><h2>{entry.name}</h2>{how}{text}{listed}</article>')
    names = "".join(f'<li><a href="#{entry.name}">{entry.name}</a></li>' for entry in entries())
    return "\n".join(
        [
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{_TITLE}</title>\n<style>\n{style}</style></head>",
            f'<body id="top"><header><h1>{_TITLE}</h1><p>{_UNITS}</p></header>',
            f'<nav aria-label="Contents"><details id="contents" open><summary>Contents</summary><ul>{names}</ul></details></nav>',
            '<main id="content">',
            *blocks,
            "</main></body></html>\n",
        ]
    )
