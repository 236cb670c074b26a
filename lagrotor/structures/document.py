"""Structures as TOML: the fields of `Structure`, read and written; what is not one of them is refused."""

from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError
from lagrotor.files import path_of, write_text
from lagrotor.pair.scene import Link, Rotor
from lagrotor.pair.scene_document import check_fields, part_of, read_document, toml_value
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.structure import Structure

_PARTS = {"rotor": Rotor, "link": Link, "braces": Brace}


def read_structure(path: str | Path) -> Structure:
    """The structure that a TOML file describes.

    Raises:
        InputError: with the reason where there is none.
    """
    return read_document(path, structure_of)


def structure_of(given: dict[str, Any]) -> Structure:
    """The structure of a table with the fields' names.

    Raises:
        InputError: for other names and for values out of range.
    """
    check_fields(given, Assembly, "a structure")
    if "joints" not in given:
        raise InputError("joints is missing: give the ground joints, joints = [[0, 0], [1, 0]]")
    made = dict(given)
    for name, kind in _PARTS.items():
        if name in given:
            tables = given[name] if isinstance(given[name], list) else [given[name]]
            made[name] = [part_of(name, kind, table) for table in tables]
    return Structure(**made)


def toml_of(s: Assembly) -> str:
    """The structure as TOML that `read_structure` reads back to the same."""
    lines = [
        f"{field.name} = {toml_value(getattr(s, field.name))}" for field in fields(Assembly) if field.name not in _PARTS
    ]
    for name in _PARTS:
        parts = getattr(s, name)
        once = name != "braces" and len(set(parts)) == 1
        for part in parts[:1] if once else parts:
            lines += ["", f"[{name}]" if once else f"[[{name}]]"]
            lines += [f"{key} = {toml_value(value)}" for key, value in asdict(part).items() if value != ()]
    return "\n".join([*lines, ""])


def write_structure(s: Assembly, path: str | Path) -> Path:
    """Write the structure as TOML, whole or not at all.

    Raises:
        InputError: where that cannot be.
    """
    return write_text(path_of("write_structure: path", path), toml_of(s))
