"""`Pattern`: a periodic pattern of rotors, and what can be found out about its waves; patterns that have a name: rows, zigzags,
rings, honeycomb, square, squares with octagons, their bars one metre long.

More of `Pattern` is given by name: spins, link, gravity, hinge …
"""

from math import cos, pi, sin, sqrt
from typing import Any

from lagrotor.errors import InputError
from lagrotor.pair.quantities import finite_number
from lagrotor.structures.waves import chern, dispersion, nonlinear_waves
from lagrotor.structures.waves.cell import Cell


class Pattern(Cell):
    """Pattern(joints, steps, bars, spins, turn, rotor, link, gravity, load, friction, hinge, braces): see `Cell`."""

    long_wave_speeds = dispersion.long_wave_speeds
    dispersion = dispersion.dispersion
    chern_numbers = chern.chern_numbers
    edge_waves = chern.edge_waves
    nonlinear_wave = nonlinear_waves.nonlinear_wave
    three_waves = nonlinear_waves.three_waves


def straight_row(spring: float | None = None, **settings: Any) -> Pattern:
    """Rotors along a line, each joined to the next; with `spring` (N/m) braces instead of bars."""
    return _joined(((0, 0),), ((1, 0),), ((0, 0, 1),), spring, settings)


def zigzag(angle: float, **settings: Any) -> Pattern:
    """Two rotors a cell, each bar turned by ±angle (rad) against the one before it; π/2 is the staircase."""
    x, y = cos(angle / 2), sin(angle / 2)
    return Pattern(joints=((0, 0), (x, y)), steps=((2 * x, 0),), bars=((0, 1), (1, 0, 1)), **settings)


def polygon_ring(count: int, spring: float | None = None, **settings: Any) -> Pattern:
    """One rotor a cell, each bar turned by 2π/count against the one before it: `piece(count)` is the closed ring; with `spring`
    (N/m) braces instead of bars.

    Raises
    ------
    InputError
        Below 3.
    """
    if count < 3:
        raise InputError(f"polygon_ring: {count} rotors are no polygon: give 3 or more")
    return _joined(((0, 0),), ((1, 0),), ((0, 0, 1),), spring, settings | {"turn": 2 * pi / count})


def honeycomb(spring: float | None = None, angle: float = 2 * pi / 3, **settings: Any) -> Pattern:
    """Two rotors a cell, three bars at each, two of them at `angle` (rad) from the third: π/2 are bricks, less are bow ties; with
    `spring` (N/m) braces instead of bars.
    """
    angle = finite_number(angle, "honeycomb: angle", "rad")
    joins, (x, y) = ((0, 1, (0, 0)), (0, 1, (-1, 0)), (0, 1, (0, -1))), (sin(angle), 1 - cos(angle))
    return _joined(((0, 0), (0, 1)), ((x, y), (-x, y)), joins, spring, settings)


def square(spring: float | None = None, **settings: Any) -> Pattern:
    """One rotor a cell, joined to its four neighbours; with `spring` (N/m) braces instead of bars."""
    return _joined(((0, 0),), ((1, 0), (0, 1)), ((0, 0, (1, 0)), (0, 0, (0, 1))), spring, settings)


def square_octagon(move: tuple[float, float] = (0.0, 0.0), **settings: Any) -> Pattern:
    """Four rotors a cell, at the corners of a square, each joined to one of the next square; `move` (m) displaces one."""
    r, step = sqrt(0.5), 1 + sqrt(2)
    joints = ((r + move[0], move[1]), (0, r), (-r, 0), (0, -r))
    bars = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2, (1, 0)), (1, 3, (0, 1)))
    return Pattern(joints, ((step, 0), (0, step)), bars=bars, **settings)


def _joined(joints: Any, steps: Any, joins: Any, spring: float | None, settings: dict[str, Any]) -> Pattern:
    if spring is None:
        return Pattern(joints, steps, bars=joins, **settings)
    return Pattern(joints, steps, braces=tuple((*join, spring) for join in joins), **settings)
