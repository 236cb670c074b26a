"""The gallery of structures. Each entry has a name, a caption and the duration of its film."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import cos, pi, sin
from typing import Any

from lagrotor.errors import InputError, near
from lagrotor.pair.scene import Link
from lagrotor.structures.assembly import Brace
from lagrotor.structures.structure import Structure

_PAIR: dict[str, Any] = {"joints": [(0, 0), (1, 0)], "bars": [(0, 1)]}
_SQUARE: dict[str, Any] = {"joints": [(0, 0), (1, 0), (1, 1), (0, 1)], "bars": [(0, 1), (1, 2), (2, 3), (3, 0)]}
_WEIGHT: dict[str, Any] = {"gravity": 9.81, "load": 2.0}


@dataclass(frozen=True)
class Example:
    """An entry of the gallery: `make` returns the structure, `says` is its caption, `duration` the length of its film in s."""

    make: Callable[[], Structure]
    says: str
    duration: float


def _row() -> Structure:
    return Structure(joints=[(k, 0) for k in range(4)], bars=[(k, k + 1) for k in range(3)], spins=40, **_WEIGHT)


def _hexagon() -> Structure:
    joints = [(cos(k * pi / 3), sin(k * pi / 3)) for k in range(6)]
    return Structure(joints=joints, bars=[(k, (k + 1) % 6) for k in range(6)], spins=[50, -50] * 3, **_WEIGHT)


def _grid() -> Structure:
    bars = [(i, i + 1) for i in range(9) if i % 3 < 2] + [(i, i + 3) for i in range(6)]
    spins = [-24.0 if i % 4 == 0 else 48.0 for i in range(9)]
    return Structure(joints=[(i % 3, i // 3) for i in range(9)], bars=bars, spins=spins, **_WEIGHT)


GALLERY = {
    "top": Example(
        lambda: Structure(joints=[(0, 0)], spins=30, **_WEIGHT), "a single loaded rotor, which its spin stabilises", 6
    ),
    "pair": Example(
        lambda: Structure(**_PAIR, spins=[10, -10], link=Link(1, 0.01, 0.1)), "the paper's pair, without weight", 6
    ),
    "loaded-pair": Example(
        lambda: Structure(**_PAIR, spins=[60, -60], **_WEIGHT), "a pair under load, which no spins stabilise", 2.5
    ),
    "braced-pair": Example(
        lambda: Structure(**_PAIR, spins=40, **_WEIGHT, braces=[Brace(0, (0.0, 1.0, 1.0), 400.0)]),
        "a pair that a brace across the bar at one tip makes stable",
        5,
    ),
    "corner": Example(
        lambda: Structure(joints=[(0, 0), (1, 0), (1, 1)], bars=[(0, 1), (1, 2)], spins=[35, 0, 35], **_WEIGHT),
        "three rotors and two bars, the smallest jointed structure that is stable",
        6,
    ),
    "row": Example(_row, "a straight row, which falls in a motion on which no spin acts", 2.5),
    "square": Example(
        lambda: Structure(**_SQUARE, spins=[-35, 35, 35, 35], **_WEIGHT),
        "four rotors in a square, one of which spins the other way",
        6,
    ),
    "plate": Example(
        lambda: Structure(joints=_SQUARE["joints"], bars=[*_SQUARE["bars"], (0, 2)], spins=60, **_WEIGHT),
        "a rigid plate on four rotors, unstable in an odd number of degrees of freedom, three",
        2.5,
    ),
    "hexagon": Example(_hexagon, "a ring of six rotors with alternating spins", 5),
    "grid": Example(
        _grid, "nine rotors, the diagonal turning the other way at half speed, which needs the least spin found", 5
    ),
}


@cache
def example(name: str) -> Structure:
    """Return a structure of the gallery.

    Parameters
    ----------
    name : str
        One of the names in `GALLERY`, such as "corner".

    Returns
    -------
    Structure
        The structure.

    Examples
    --------
    >>> len(example("hexagon").bars)
    6
    """
    if name not in GALLERY:
        raise InputError(
            f"structure: {name!r} is neither a .toml file nor one of {', '.join(GALLERY)}{near(name, GALLERY)}"
        )
    return GALLERY[name].make()
