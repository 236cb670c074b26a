"""A periodic pattern of rotors: one cell, the steps that repeat it, and its bars and braces."""

from cmath import exp
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from math import pi
from typing import Any, Self

import numpy as np

from lagrotor.errors import InputError
from lagrotor.pair.scene import Link, Rotor
from lagrotor.result_display import Printed
from lagrotor.structures.assembly import ROWS, Brace
from lagrotor.structures.structure import Structure

Shift = tuple[int, ...]
Site = tuple[int, Shift]  # joint of the cell, and which cell


@dataclass(frozen=True)
class Cell(Printed):
    """A pattern without waves: its checked fields, which `Pattern` documents, and its finite pieces."""

    _shown = (("steps [m]", lambda s: ", ".join(f"({x:g}, {y:g})" for x, y in s.steps)),) + ROWS

    joints: tuple[tuple[float, float], ...]
    steps: tuple[tuple[float, float], ...]
    bars: tuple[Any, ...] = ()
    spins: Any = 0.0
    turn: float = 0.0
    rotor: Any = field(default_factory=Rotor)
    link: Any = field(default_factory=Link)
    gravity: float = 0.0
    load: Any = 0.0
    friction: Any = 0.0
    hinge: Any = 0.0
    braces: tuple[Any, ...] = ()
    inertia: bool = True

    def __post_init__(self) -> None:
        assign = object.__setattr__
        if not isinstance(self.inertia, bool):
            raise InputError(f"Pattern: inertia = {self.inertia!r} must be True or False")
        for name in ("joints", "steps"):
            assign(self, name, tuple((float(x), float(y)) for x, y in getattr(self, name)))
        if len(self.steps) not in (1, 2) or not self.joints:
            raise InputError(
                f"Pattern: {len(self.joints)} joints and {len(self.steps)} steps: give a joint at least, and one or two steps"
            )
        if self.turn and len(self.steps) == 2:
            raise InputError(f"Pattern: turn = {self.turn:g} rad with two steps: only a row of cells turns; remove one")
        if len(self.steps) == 2 and abs((complex(*self.steps[0]).conjugate() * complex(*self.steps[1])).imag) < 1e-12:
            raise InputError(f"Pattern: steps = {self.steps} lie along one line: they span no plane")
        assign(self, "bars", tuple(self._ends("bars", k, bar, bar[2:]) for k, bar in enumerate(self.bars)))
        assign(self, "braces", tuple(self._brace(k, brace) for k, brace in enumerate(self.braces)))
        for name in ("spins", "rotor", "load", "friction", "hinge"):
            assign(self, name, _each(getattr(self, name), len(self.joints), name))
        assign(self, "link", _each(self.link, len(self.bars), "link"))

    def _ends(self, what: str, k: int, entry: Any, shift: Any) -> tuple[int, int, Shift]:
        i, j = entry[:2]
        where = f"Pattern: {what}[{k}] = {entry!r}"
        if not all(isinstance(end, int) and 0 <= end < len(self.joints) for end in (i, j)):
            raise InputError(f"{where}: joints are numbered 0 to {len(self.joints) - 1}")
        steps = shift[0] if shift else (0,) * len(self.steps)
        cells = tuple(steps) if isinstance(steps, Sequence) else (steps,)
        if len(cells) != len(self.steps) or not all(isinstance(n, int) for n in cells):
            raise InputError(f"{where}: its shift must be {len(self.steps)} whole number(s) of steps")
        if i == j and not any(cells):
            raise InputError(f"{where} joins a tip to itself: give two different tips")
        return i, j, cells

    def _brace(self, k: int, entry: Any) -> tuple[int, int, Shift, float, float]:
        if len(entry) not in (4, 5):
            raise InputError(f"Pattern: braces[{k}] = {entry!r} must be (i, j, shift, stiffness, damping)")
        return (
            *self._ends("braces", k, entry, entry[2:3]),
            float(entry[3]),
            float(entry[4]) if len(entry) > 4 else 0.0,
        )

    @property
    def neighbours(self) -> tuple[Site, ...]:
        """The joints of other cells at which bars or braces of this cell end, each once, as (joint, shift of its cell)."""
        return tuple(dict.fromkeys((j, shift) for _, j, shift, *_ in (*self.bars, *self.braces) if any(shift)))

    def place(self, site: Site) -> tuple[float, float]:
        """Return the position of a joint of any cell.

        Parameters
        ----------
        site : tuple
            The number of the joint in its cell, and the shift of this cell in steps.

        Returns
        -------
        tuple
            The position (x, y), m.
        """
        shift = site[1]
        z = complex(*self.joints[site[0]])
        if self.turn:  # each step is turned relative to the previous one
            rotation = exp(1j * self.turn * shift[0])
            z = z * rotation + complex(*self.steps[0]) * (rotation - 1) / (exp(1j * self.turn) - 1)
        else:
            z += sum(n * complex(*step) for n, step in zip(shift, self.steps, strict=True))
        return z.real, z.imag

    def cells(self, *counts: int) -> list[Shift]:
        """Return the shifts of all cells of a finite piece.

        Parameters
        ----------
        *counts : int
            The number of cells along each step.

        Returns
        -------
        list
            The shifts of the cells; the last step varies fastest.
        """
        if len(counts) != len(self.steps) or not all(isinstance(n, int | np.integer) and n > 0 for n in counts):
            raise InputError(f"Pattern: piece{counts}: give {len(self.steps)} number(s) of cells, 1 or more")
        return list(product(*map(range, counts)))

    def piece(self, *counts: int) -> Structure:
        """Return a finite piece of the pattern with free borders.

        It is a closed ring if turn × count is a full turn. Joint i of cell n is rotor N n + i.

        Parameters
        ----------
        *counts : int
            The number of cells along each step.

        Returns
        -------
        Structure
            The piece.

        Examples
        --------
        >>> from lagrotor.structures import polygon_ring
        >>> ring = polygon_ring(6, spins=20.0).piece(6)
        >>> len(ring.joints), len(ring.bars)
        (6, 6)
        """
        if not self.inertia:
            raise InputError(
                "Pattern: piece: a structure has inertia: remove inertia=False, and use modes(inertia=False) of the piece"
            )
        ring = bool(self.turn) and abs(abs(self.turn) * counts[0] - 2 * pi) < 1e-9
        cells = self.cells(*counts)
        number = {(i, cell): len(self.joints) * k + i for k, cell in enumerate(cells) for i in range(len(self.joints))}

        def within(joined: Sequence[Any]) -> Iterator[tuple[int, int, int]]:
            for cell in cells:
                for k, (i, j, shift, *_) in enumerate(joined):
                    far_cell = tuple((a + b) % counts[0] if ring else a + b for a, b in zip(cell, shift, strict=True))
                    if (j, far_cell) in number:
                        yield k, number[i, cell], number[j, far_cell]

        bars = list(within(self.bars))
        return Structure(
            joints=tuple(self.place(site) for site in number),
            bars=tuple((a, b) for _, a, b in bars),
            link=tuple(self.link[k] for k, *_ in bars) or Link(),
            braces=tuple(Brace(a, b, *self.braces[k][3:]) for k, a, b in within(self.braces)),
            gravity=self.gravity,
            **{name: getattr(self, name) * len(cells) for name in ("spins", "rotor", "load", "friction", "hinge")},
        )

    def strip(self, width: int) -> Self:
        """Return a strip of a pattern with two steps, which repeats along the first one.

        Parameters
        ----------
        width : int
            The number of cells along the second step, whose borders are free.

        Returns
        -------
        Pattern
            The strip.
        """
        if len(self.steps) != 2 or width < 1:
            raise InputError(
                f"Pattern: strip({width}) of {len(self.steps)} step(s): a strip needs two, and a width of 1 or more"
            )
        N = len(self.joints)

        def within(joined: Sequence[Any]) -> list[tuple[int, tuple[Any, ...]]]:
            rows = [
                (n, k, entry) for n in range(width) for k, entry in enumerate(joined) if 0 <= n + entry[2][1] < width
            ]
            return [(k, (N * n + i, N * (n + s[1]) + j, (s[0],), *constants)) for n, k, (i, j, s, *constants) in rows]

        bars = within(self.bars)
        return type(self)(
            joints=tuple(self.place((i, (0, n))) for n in range(width) for i in range(N)), steps=self.steps[:1],
            bars=tuple(bar for _, bar in bars), link=tuple(self.link[k] for k, _ in bars) or Link(),
            braces=tuple(brace for _, brace in within(self.braces)), gravity=self.gravity, inertia=self.inertia,
            **{name: getattr(self, name) * width for name in ("spins", "rotor", "load", "friction", "hinge")},
        )  # fmt: skip


def _each(value: Any, count: int, name: str) -> tuple[Any, ...]:
    items = tuple(value) if isinstance(value, Sequence) else (value,) * count
    if len(items) != count:
        raise InputError(f"Pattern: {name} has {len(items)} values for {count}: give one for all, or {count}")
    return items
