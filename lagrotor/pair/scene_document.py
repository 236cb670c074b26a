"""A scene as TOML: the fields of `Scene`, read and written; what is not one of them is refused."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError, near
from lagrotor.files import read_toml, write_text
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

_PARTS: dict[str, type] = {"rotor": Rotor, "link": Link, "shock": Shock}


def read_scene(path: str | Path) -> Scene:
    """The scene that a TOML file describes: spins, and [rotor], [link], [shock], axes, rates as far as they are not usual.

    `link = "none"` is a pair without a bar. Raises InputError with the reason where there is none.
    """
    given = read_toml(path)
    try:
        return scene_of(given)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def scene_of(given: Mapping[str, Any]) -> Scene:
    """The scene of a table with the fields' names. Raises InputError for names that are none, or values that make no sense."""
    names = [field.name for field in fields(Scene)]
    if unknown := [name for name in given if name not in names]:
        known = ", ".join(names)
        raise InputError(f"{unknown[0]!r} is no field of a scene: they are {known}{near(unknown[0], names)}")
    if "spins" not in given:
        raise InputError("spins is missing: give the axial angular velocities in rad/s, spins = [10, -10]")
    made = dict(given) | {name: _part(name, kind, given[name]) for name, kind in _PARTS.items() if name in given}
    return Scene(**made)


def _part(name: str, kind: type, table: Any) -> Any:
    if name == "link" and table == "none":
        return None
    known = [field.name for field in fields(kind)]
    if not isinstance(table, dict) or any(key not in known for key in table):
        raise InputError(f"{name} = {table!r} must be a table of {', '.join(known)}")
    try:
        return kind(**table)
    except TypeError as error:
        raise InputError(f"{name}: {str(error).rpartition('missing ')[2]}") from None


def scene_toml(scene: Scene) -> str:
    """The scene as TOML that `read_scene` reads back to the same."""
    lines = [f"{name} = {_value(getattr(scene, name))}" for name in ("spins", "axes", "rates")]
    lines += [] if scene.link else ['link = "none"']
    for name in _PARTS:
        if part := getattr(scene, name):
            lines += ["", f"[{name}]", *(f"{key} = {_value(value)}" for key, value in asdict(part).items())]
    return "\n".join([*lines, ""])


def write_scene(scene: Scene, path: str | Path) -> Path:
    """Write the scene as TOML, whole or not at all. Raises InputError where that cannot be."""
    if not isinstance(scene, Scene):
        raise InputError(f"write_scene: scene = {scene!r} must be a Scene")
    return write_text(Path(path), scene_toml(scene))


def _value(value: Any) -> str:
    return f"[{', '.join(map(_value, value))}]" if isinstance(value, tuple) else repr(value)
