"""A scene as TOML: the fields of `Scene`, read and written. Unknown names are refused."""

from collections.abc import Callable, Mapping
from dataclasses import MISSING, asdict, fields
from pathlib import Path
from typing import Any, TypeVar

from lagrotor.errors import InputError, near
from lagrotor.files import path_of, read_toml, write_text
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

Kind = TypeVar("Kind")
_PARTS: dict[str, type] = {"rotor": Rotor, "link": Link, "shock": Shock}


def read_scene(path: str | Path) -> Scene:
    """Read a scene from a TOML file.

    Parameters
    ----------
    path : str or Path
        A file with spins, and [rotor], [link], [shock], axes and rates if they are not the defaults. `link = "none"` is a pair
        without a bar.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    InputError
        If the file describes no scene.
    """
    return read_document(path, scene_of)


def read_document(path: str | Path, make: Callable[[dict[str, Any]], Kind]) -> Kind:
    """Return make(table) for the table of a TOML file, with the name of the file in every InputError."""
    table = read_toml(path)
    try:
        return make(table)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def scene_of(table: Mapping[str, Any]) -> Scene:
    """Return the scene whose fields a table gives by their names."""
    check_fields(table, Scene, "a scene")
    if "spins" not in table:
        raise InputError("spins is missing: give the axial angular velocities in rad/s, spins = [10, -10]")
    objects = {
        name: None if (name, table[name]) == ("link", "none") else part_of(name, kind, table[name])
        for name, kind in _PARTS.items()
        if name in table
    }
    return Scene(**dict(table) | objects)


def check_fields(table: Mapping[str, Any], kind: type, what: str) -> None:
    """Raise InputError for a name in a table that is no field of `kind`."""
    names = [field.name for field in fields(kind)]
    if unknown := [name for name in table if name not in names]:
        listed = ", ".join(names)
        raise InputError(f"{unknown[0]!r} is no field of {what}: the fields are {listed}{near(unknown[0], names)}")


def part_of(name: str, kind: type, table: Any) -> Any:
    """Return an object of the class `kind` from a table of its fields."""
    names = [field.name for field in fields(kind)]
    if not isinstance(table, dict) or any(key not in names for key in table):
        raise InputError(f"{name} = {table!r} must be a table of {', '.join(names)}")
    needed = [field.name for field in fields(kind) if field.default is MISSING and field.default_factory is MISSING]
    if lacking := [key for key in needed if key not in table]:
        raise InputError(f"{name} = {table!r} lacks {', '.join(lacking)}: add it")
    return kind(**table)


def scene_toml(scene: Scene) -> str:
    """Return TOML from which `read_scene` makes the same scene."""
    lines = [f"{name} = {toml_value(getattr(scene, name))}" for name in ("spins", "axes", "rates")]
    lines += [] if scene.link else ['link = "none"']
    for name in _PARTS:
        if item := getattr(scene, name):
            lines += ["", f"[{name}]", *(f"{key} = {toml_value(value)}" for key, value in asdict(item).items())]
    return "\n".join([*lines, ""])


def write_scene(scene: Scene, path: str | Path) -> Path:
    """Write a scene to a TOML file atomically.

    Parameters
    ----------
    scene : Scene
        The scene.
    path : str or Path
        The file.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        If the file cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     read_scene(write_scene(Scene((10, -10)), f"{folder}/scene.toml")) == Scene((10, -10))
    True
    """
    if not isinstance(scene, Scene):
        raise InputError(f"write_scene: scene = {scene!r} must be a Scene")
    return write_text(path_of("write_scene: path", path), scene_toml(scene))


def toml_value(value: Any) -> str:
    """Return a number, a text or a tuple of them as TOML."""
    return f"[{', '.join(map(toml_value, value))}]" if isinstance(value, tuple) else repr(value)
