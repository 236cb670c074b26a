"""`Structure`: any number of rotors and bars with its methods, and its TOML file, which holds the fields of `Structure`."""

from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagrotor.errors import InputError
from lagrotor.files import path_of, write_text
from lagrotor.pair.scene import Link, Rotor
from lagrotor.pair.scene_document import check_fields, part_of, read_document, toml_value
from lagrotor.structures import (
    characteristic,
    critical_spins,
    precession_law,
    resonances,
    response,
    small_motion,
    standing,
    steady_precession,
    tilted_equilibria,
)
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.exact import structure_run
from lagrotor.structures.exact.bar_closure import check_closure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Structure(Assembly):
    """Structure(joints, bars, spins, rotor, link, gravity, load, friction, hinge, braces): see `Assembly`.

    Raises
    ------
    InputError
        Bars that cannot close, a bar to itself, dependent constraints, no degree of freedom left, loads below zero.

    Examples
    --------
    >>> from lagrotor.structures import example
    >>> corner = example("corner")
    >>> len(corner.joints), len(corner.bars)
    (3, 2)
    """

    if TYPE_CHECKING:  # what may be given, which the fields then hold as tuples

        def __init__(
            self,
            joints: Sequence[Sequence[float]],
            bars: Sequence[Sequence[float]] = (),
            spins: float | Sequence[float] = 0.0,
            rotor: Rotor | Sequence[Rotor] = ...,
            link: Link | Sequence[Link] = ...,
            gravity: float = 0.0,
            load: float | Sequence[float] = 0.0,
            friction: float | Sequence[float] = 0.0,
            hinge: float | Sequence[float] = 0.0,
            braces: Sequence[Brace | Sequence[Any]] = (),
            spin_friction: float | Sequence[float] = 0.0,
        ) -> None: ...

    def __post_init__(self) -> None:
        super().__post_init__()
        check_closure(self)

    simulate = structure_run.simulate_structure
    modes = small_motion.modes
    rest_near = tilted_equilibria.rest_near
    modes_about = tilted_equilibria.modes_about
    steady_precession = steady_precession.steady_precession
    precession_law = precession_law.precession_law
    stands = standing.stands
    critical_spin = critical_spins.critical_spin
    spin_intervals = resonances.spin_intervals
    largest_push = resonances.largest_push
    resonances = resonances.resonances
    characteristic = characteristic.characteristic
    response = response.response

    def plot(self) -> "Figure":
        """The plan of the structure and the roots of its small motion: a figure that a notebook shows."""
        from lagrotor.structures.pictures import structure_picture

        return structure_picture(self)


_PARTS = {"rotor": Rotor, "link": Link, "braces": Brace}


def read_structure(path: str | Path) -> Structure:
    """The structure that a TOML file describes.

    Raises
    ------
    InputError
        With the reason where there is none.
    """
    return read_document(path, structure_of)


def structure_of(entries: dict[str, Any]) -> Structure:
    """The structure of a table with the fields' names.

    Raises
    ------
    InputError
        For other names and for values out of range.
    """
    check_fields(entries, Assembly, "a structure")
    if "joints" not in entries:
        raise InputError("joints is missing: give the ground joints, joints = [[0, 0], [1, 0]]")
    arguments = dict(entries)
    for name, kind in _PARTS.items():
        if name in entries:
            tables = entries[name] if isinstance(entries[name], list) else [entries[name]]
            arguments[name] = [part_of(name, kind, table) for table in tables]
    return Structure(**arguments)


def toml_of(s: Assembly) -> str:
    """The structure as TOML that `read_structure` reads back to the same."""
    lines = [
        f"{field.name} = {toml_value(getattr(s, field.name))}" for field in fields(Assembly) if field.name not in _PARTS
    ]
    for name in _PARTS:
        items = getattr(s, name)
        once = name != "braces" and len(set(items)) == 1
        for item in items[:1] if once else items:
            lines += ["", f"[{name}]" if once else f"[[{name}]]"]
            lines += [f"{key} = {toml_value(value)}" for key, value in asdict(item).items()]
    return "\n".join([*lines, ""])


def write_structure(s: Assembly, path: str | Path) -> Path:
    """Write the structure as TOML, whole or not at all.

    Raises
    ------
    InputError
        Where that cannot be.
    """
    return write_text(path_of("write_structure: path", path), toml_of(s))
