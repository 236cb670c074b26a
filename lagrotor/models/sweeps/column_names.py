"""Scenes from a table: a mapping of arrays or a DataFrame whose names are those of `Scene`, nested or flat."""

from collections.abc import Mapping
from dataclasses import fields
from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import InputError, near
from lagrotor.models.sweeps.scene_columns import SceneColumns
from lagrotor.numerics.arrays import Array, real_array
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

_VECTORS = [f"{i}{x}" for i in "12" for x in "xyz"]
# The fields of SceneColumns, each with the names of its numbers.
FLAT = {
    "spins": ("spins_1", "spins_2"),
    "rotor": tuple(f"rotor_{field.name}" for field in fields(Rotor)),
    "link": tuple(f"link_{field.name}" for field in fields(Link)),
    "shock": ("shock_force_x", "shock_force_y", "shock_force_z", "shock_at", "shock_width", "shock_body"),
    "axes": tuple(f"axes_{label}" for label in _VECTORS),
    "rates": tuple(f"rates_{label}" for label in _VECTORS),
}
_NESTED = {"spins": (2,), "axes": (2, 3), "rates": (2, 3), "shock_force": (3,)}  # with the shape of one row
_PARTS = {"rotor": Rotor, "link": Link, "shock": Shock}
_NEEDED_OF_A_SHOCK = FLAT["shock"][:5]


def is_table(data: object) -> bool:
    """Return True for a mapping and for a DataFrame, which has columns."""
    return isinstance(data, Mapping) or hasattr(data, "columns")


def scenes_of_table(data: Any) -> SceneColumns:
    """Return the scenes of a table, with the defaults of `Scene` for missing names.

    Raises InputError for unknown names, for columns of different lengths and for a field that is stated twice. The rows are not
    checked.
    """
    columns, origin = dict[str, Array](), dict[str, str]()
    for name in map(str, data if isinstance(data, Mapping) else data.columns):
        for flat, column in _numbers(name, data[name]).items():
            if flat in columns:
                raise InputError(f"sweep: {origin[flat]} and {name} both state {flat}: give one of them")
            columns[flat], origin[flat] = column, name
    for needed in (FLAT["spins"], _NEEDED_OF_A_SHOCK if any(name in columns for name in FLAT["shock"]) else ()):
        if missing := [name for name in needed if name not in columns]:
            raise InputError(f"sweep: the column {missing[0]} is missing: {', '.join(needed)} are needed")
    lengths = {origin[flat]: len(column) for flat, column in columns.items() if column.ndim}
    if not (n := max(lengths.values(), default=1)):
        raise InputError("sweep: the table has no rows: give one for each scene")
    if wrong := [name for name, length in lengths.items() if length != n]:
        longest = max(lengths, key=lambda name: lengths[name])
        says = f"the column {wrong[0]} has {lengths[wrong[0]]} rows, {longest} has {n}"
        raise InputError(f"sweep: {says}: give each column one number per scene, or one number for all")
    plain, shocked = SceneColumns.of_scenes([Scene((1.0, 1.0))]), "shock_at" in columns
    whole = dict[str, Array]()
    for field, names in FLAT.items():
        usual = getattr(plain, field).reshape(-1)
        rows = [np.broadcast_to(columns.get(name, value), n) for name, value in zip(names, usual, strict=True)]
        whole[field] = np.stack(rows, axis=1)
    whole["link"][np.isnan(whole["link"][:, 0])] = nan
    if shocked:
        shock = whole["shock"]
        if "shock_body" not in columns:
            shock[:, 5] = 1.0
        shock[np.isnan(shock[:, :5]).all(1)] = nan
    return SceneColumns(**{f: a.reshape(n, 2, 3) if f in ("axes", "rates") else a for f, a in whole.items()})


def _numbers(name: str, values: Any) -> dict[str, Array]:
    """Return {flat name: its numbers, of shape (n,), or () for one number for all scenes} of a column of the table."""
    if name in _PARTS:
        return _of_parts(name, values)
    flat = next((names for names in FLAT.values() if name in names), ())
    row = () if flat else _NESTED.get(name)
    if row is None:
        names = [*_NESTED, *_PARTS, *(each for names in FLAT.values() for each in names)]
        hint = near(name, names) or f": the names are {', '.join(dict.fromkeys(names))}"
        raise InputError(f"sweep: {name!r} is no column of scenes{hint}")
    tuples = row and getattr(getattr(values, "dtype", None), "kind", "") == "O"  # in a column of a DataFrame
    array = real_array(list(values) if tuples else values)
    if array is None or array.ndim - len(row) not in (0, 1) or array.shape[array.ndim - len(row) :] != row:
        shape = f"of shape {('n', *row)}".replace("'", "") if row else "one per scene"
        says = f", not of shape {array.shape}" if array is not None else ""
        raise InputError(f"sweep: the column {name} must be numbers, {shape}, or the same for all scenes{says}")
    if row == ():
        return {name: array}
    of_row = FLAT["shock"][:3] if name == "shock_force" else FLAT[name]
    return dict(zip(of_row, np.moveaxis(array.reshape(*array.shape[: array.ndim - len(row)], -1), -1, 0), strict=True))


def _of_parts(name: str, values: Any) -> dict[str, Array]:
    """Return the numbers of a column of rotors, bars or shocks, or of one value for all scenes. None means no bar or no shock."""
    kind, alone = _PARTS[name], values is None or isinstance(values, Rotor | Link | Shock)
    parts = [values] if alone else list(values) if hasattr(values, "__iter__") else [values]
    if not all(isinstance(part, kind) or (part is None and name != "rotor") for part in parts):
        raise InputError(f"sweep: the column {name} must be a {kind.__name__} or one per scene: or give {FLAT[name]}")
    scenes = SceneColumns.of_scenes([Scene((1.0, 1.0), **({"link": None} | {name: part})) for part in parts])
    columns: NDArray[Any] = getattr(scenes, name)
    return dict(zip(FLAT[name], columns[0] if alone else columns.T, strict=True))
