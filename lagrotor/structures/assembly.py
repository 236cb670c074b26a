"""The parts of a structure (joints, bars, rotors, loads, braces) and their checks."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import hypot
from operator import index
from typing import Any

from lagrotor.errors import InputError
from lagrotor.pair.quantities import finite_number, finite_vector, not_negative, numbers
from lagrotor.pair.scene import Link, Rotor
from lagrotor.result_display import Printed, text_of

_Point = tuple[float, float, float]
Bar = tuple[int, int, float]


_MOST_PRINTED = 8  # joints, bars or spins that are written out


@dataclass(frozen=True)
class Brace(Printed):
    """A spring and damper from a tip to another tip or to a point of the ground.

    It is unstrained when all axes are upright.

    Attributes
    ----------
    tip : int
        The rotor whose tip is the first end, from 0.
    to : int or tuple
        The rotor of the second end, or a point (x, y, z) of the ground, m.
    stiffness : float
        The force per extension, N/m.
    damping : float
        The force per rate of extension, N s/m.

    Examples
    --------
    >>> from lagrotor import Brace, Structure
    >>> Structure([(0, 0)], braces=[Brace(0, (1, 0, 1), stiffness=100.0)]).modes().rates.round(3).tolist()
    [0.0, 8.944]
    """

    _shown = (
        ("tip", "tip"),
        ("to", lambda b: f"tip {b.to}" if isinstance(b.to, int) else f"({text_of(b.to)}) m"),
        ("stiffness [N/m]", "stiffness"),
        ("damping [N s/m]", "damping"),
    )

    tip: int
    to: int | _Point
    stiffness: float = 0.0
    damping: float = 0.0


def _alike(values: Any) -> str:
    """Return the values as text: equal values once, and empty text if all are zero."""
    texts = [text_of(value) for value in (values if isinstance(values, Sequence) else (values,))]
    if set(texts) == {"0"}:
        return ""
    return f"{texts[0]}{' each' if len(texts) > 1 else ''}" if len(set(texts)) == 1 else _first(texts)


def _first(texts: Sequence[str]) -> str:
    return ", ".join(texts[:_MOST_PRINTED]) + (f" … ({len(texts)})" if len(texts) > _MOST_PRINTED else "")


def _rotors(s: Any) -> str:
    rotors = list(dict.fromkeys(s.rotor if isinstance(s.rotor, Sequence) else (s.rotor,)))
    if len(rotors) > 1:
        return f"{len(rotors)} kinds"
    return "{0.length:g} m, {0.mass:g} kg, I₁ = {0.I1:g}, I₃ = {0.I3:g} kg m²".format(rotors[0])


ROWS = (
    ("joints [m]", lambda s: _first([f"({x:g}, {y:g})" for x, y in s.joints])),
    ("bars", lambda s: _first([f"{i}–{j}" for i, j, *_ in s.bars]) or "none"),
    ("spins [rad/s]", lambda s: _alike(s.spins) or "0"),
    ("rotors", _rotors),
    ("gravity [m/s²]", lambda s: s.gravity or None),
    ("load [kg]", lambda s: _alike(s.load)),
    ("friction [N m s/rad]", lambda s: _alike(s.friction)),
    ("hinge [N m/rad]", lambda s: _alike(s.hinge)),
    ("braces", lambda s: len(s.braces) or None),
)


@dataclass(frozen=True)
class Assembly(Printed):
    """A structure without methods of analysis. Its fields are checked at construction; `Structure` documents them."""

    _shown = ROWS

    joints: tuple[tuple[float, float], ...]
    bars: tuple[Bar, ...] = ()
    spins: tuple[float, ...] = (0.0,)
    rotor: tuple[Rotor, ...] = (Rotor(),)
    link: tuple[Link, ...] = (Link(),)
    gravity: float = 0.0
    load: tuple[float, ...] = (0.0,)
    friction: tuple[float, ...] = (0.0,)
    hinge: tuple[float, ...] = (0.0,)
    braces: tuple[Brace, ...] = ()
    spin_friction: tuple[float, ...] = (0.0,)

    def __post_init__(self) -> None:
        assign = object.__setattr__
        assign(
            self,
            "joints",
            tuple(numbers(joint, 2, f"Structure: joints[{i}]", "m") for i, joint in enumerate(_row(self.joints))),
        )
        n = len(self.joints)
        if not n:
            raise InputError("Structure: joints is empty: give at least one ground joint (x, y) in m")
        assign(self, "rotor", _each(self.rotor, n, "rotor", Rotor))
        assign(self, "gravity", finite_number(self.gravity, "Structure: gravity", "m/s²"))
        assign(self, "spins", _amounts(self.spins, n, "spins", "rad/s", signed=True))
        for name, unit in (
            ("load", "kg"),
            ("friction", "N m s/rad"),
            ("spin_friction", "N m s/rad"),
            ("hinge", "N m/rad"),
        ):
            assign(self, name, _amounts(getattr(self, name), n, name, unit))
        bars = tuple(self._bar(k, bar) for k, bar in enumerate(_row(self.bars)))
        first_bar: dict[frozenset[int], int] = {}
        for k, (i, j, _) in enumerate(bars):
            first = first_bar.setdefault(frozenset((i, j)), k)
            if first != k:
                raise InputError(
                    f"Structure: bars[{k}] = ({i}, {j}) joins the same tips as bars[{first}]: dependent constraints; remove one"
                )
        assign(self, "bars", bars)
        assign(self, "link", _each(self.link, len(bars), "link", Link))
        assign(self, "braces", tuple(self._brace(k, brace) for k, brace in enumerate(_row(self.braces))))

    def _bar(self, k: int, bar: Any) -> Bar:
        items = _row(bar)
        if len(items) not in (2, 3):
            raise InputError(f"Structure: bars[{k}] = {bar!r} must be (i, j) or (i, j, length)")
        i, j = (self._tip(item, f"bars[{k}]") for item in items[:2])
        if i == j:
            raise InputError(f"Structure: bars[{k}] = ({i}, {j}) is a bar to itself: join two different tips")
        reach = self.rotor[i].length, self.rotor[j].length
        apart = hypot(self.joints[i][0] - self.joints[j][0], self.joints[i][1] - self.joints[j][1])
        upright = hypot(apart, reach[0] - reach[1])
        length = finite_number(items[2], f"Structure: bars[{k}] length", "m") if len(items) == 3 else upright
        if length <= 0:
            raise InputError(
                f"Structure: bars[{k}] = ({i}, {j}) is {length:g} m long: its tips must be apart; give a length above zero"
            )
        low, high = apart - sum(reach), apart + sum(reach)
        if not low <= length <= high:
            raise InputError(
                f"Structure: bars[{k}] = ({i}, {j}), {length:g} m long, cannot close: the distance of its "
                f"tips can be {max(low, 0):g} to {high:g} m; give a length in this range"
            )
        return i, j, length

    def _brace(self, k: int, entry: Any) -> Brace:
        where = f"braces[{k}]"
        try:
            brace = entry if isinstance(entry, Brace) else Brace(*_row(entry))
        except TypeError:
            raise InputError(f"Structure: {where} = {entry!r} must be (tip, to, stiffness, damping)") from None
        tip = self._tip(brace.tip, where)
        ground = isinstance(brace.to, Iterable)
        to = finite_vector(brace.to, f"Structure: {where} to", "m") if ground else self._tip(brace.to, where)
        stiffness = not_negative(brace.stiffness, f"Structure: {where} stiffness", "N/m")
        damping = not_negative(brace.damping, f"Structure: {where} damping", "N s/m")
        ends = [self.upright_tip(tip), self.upright_tip(to) if isinstance(to, int) else to]
        if tip == to or ends[0] == ends[1]:
            raise InputError(f"Structure: {where} has both ends at one place: join two different points")
        return Brace(tip, to, stiffness, damping)

    def _tip(self, value: Any, where: str) -> int:
        try:
            number = -1 if isinstance(value, bool) else index(value)
        except TypeError:
            number = -1
        if not 0 <= number < len(self.joints):
            raise InputError(
                f"Structure: {where}: {value!r} is no rotor: rotors are numbered 0 to {len(self.joints) - 1}"
            )
        return number

    def upright_tip(self, i: int) -> _Point:
        """Return the tip of a rotor with its axis upright.

        Parameters
        ----------
        i : int
            The rotor, from 0.

        Returns
        -------
        tuple
            The position (x, y, z), m.
        """
        if i not in range(len(self.joints)):
            raise InputError(f"upright_tip: i = {i!r} must be a rotor's number, from 0 to {len(self.joints) - 1}")
        return (*self.joints[i], self.rotor[i].length)

    @property
    def natural(self) -> bool:
        """True if the length of each bar equals the distance between its tips when all axes are upright."""
        return all(
            abs(hypot(*(p - q for p, q in zip(self.upright_tip(i), self.upright_tip(j), strict=True))) - length)
            <= 1e-12 * length
            for i, j, length in self.bars
        )


def _row(value: Any) -> list[Any]:
    if not isinstance(value, Iterable) or isinstance(value, str | bytes):
        raise InputError(f"Structure: {value!r} must be a list")
    return list(value)


def _amounts(value: Any, n: int, where: str, unit: str, signed: bool = False) -> tuple[float, ...]:
    """Return a single number or a list of n numbers as n numbers. Raises InputError for negative ones unless `signed`."""
    check = finite_number if signed else not_negative
    items = _row(value) if isinstance(value, Iterable) and not isinstance(value, str) else [value]
    if len(items) not in (1, n):
        raise InputError(f"Structure: {where} has {len(items)} numbers for {n} rotors: give one for all, or {n}")
    amounts = [check(item, f"Structure: {where}[{i}]", unit) for i, item in enumerate(items)]
    return tuple(amounts * n if len(amounts) == 1 else amounts)


def _each(value: Any, n: int, where: str, kind: type) -> tuple[Any, ...]:
    items = list(value) if isinstance(value, Sequence) else [value]
    if len(items) not in (1, n) or not all(isinstance(item, kind) for item in items):
        raise InputError(f"Structure: {where} must be one {kind.__name__}, or a list of {n} of them")
    return tuple(items * n if len(items) == 1 else items)
