"""Many scenes as arrays, one row for each scene. A `Scene` is made only when one is asked for."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.pulse import PULSE_REACH
from lagrotor.pair.quantities import SMALLEST, Vector
from lagrotor.pair.scene import CLOSE, Link, Rotor, Scene, Shock

_LARGEST = 9e59  # a tenth below the largest number that a scene takes
_TIGHTER = 0.99  # rounding differs between floats and arrays


@dataclass(frozen=True, eq=False)
class SceneColumns:
    """The scenes of a sweep as arrays in SI units, with one row for each of n scenes.

    Attributes
    ----------
    spins : Array
        The axial angular velocities, (n, 2), rad/s.
    rotor : Array
        Mass, length, I1 and I3 of the rotors, (n, 4), in kg, m and kg m².
    link : Array
        Length, mass and inertia of the bar, (n, 3), in m, kg and kg m²; NaN in all three where there is no bar.
    shock : Array
        The force x, y, z, the time of the peak, the width and the body of the shock, (n, 6), in N and s; NaN in all six where
        there is no shock.
    axes : Array
    rates : Array
        The unit vectors of the axes and their rates (1/s) at the start, (n, 2, 3).

    Examples
    --------
    >>> columns = SceneColumns.of_scenes([Scene((10, -10)), Scene((5, 5), link=None)])
    >>> len(columns), columns.link.shape, columns.take([1]).scene(0).link is None
    (2, (2, 3), True)
    """

    spins: Array
    rotor: Array
    link: Array
    shock: Array
    axes: Array
    rates: Array

    @classmethod
    def of_scenes(cls, scenes: Sequence[Scene]) -> "SceneColumns":
        """Return the columns of some scenes, with a row for each."""
        rotors, links, shocks = ([getattr(s, name) for s in scenes] for name in ("rotor", "link", "shock"))
        no_link, no_shock = (np.nan,) * 3, (np.nan,) * 6
        return cls(
            np.array([s.spins for s in scenes]).reshape(-1, 2),
            np.array([(r.mass, r.length, r.I1, r.I3) for r in rotors]).reshape(-1, 4),
            np.array([(b.length, b.mass, b.inertia) if b else no_link for b in links]).reshape(-1, 3),
            np.array([(*p.force, p.at, p.width, p.body) if p else no_shock for p in shocks]).reshape(-1, 6),
            np.array([s.axes for s in scenes]).reshape(-1, 2, 3),
            np.array([s.rates for s in scenes]).reshape(-1, 2, 3),
        )

    def __len__(self) -> int:
        return len(self.spins)

    def take(self, indices: ArrayLike) -> "SceneColumns":
        """Return the scenes of some rows, given by their numbers (k,) or by a mask (n,)."""
        rows = np.asarray(indices)
        return SceneColumns(*(getattr(self, f.name)[rows] for f in fields(self)))

    def since(self, begin: float, duration: float) -> "SceneColumns":
        """Return the scenes with time counted from `begin`, without shocks that do not act in the `duration` after it, in s."""
        shock = self.shock.copy()
        shock[:, 3] -= begin
        reach = PULSE_REACH * shock[:, 4]
        shock[~((shock[:, 3] - reach < duration) & (shock[:, 3] + reach > 0))] = np.nan
        return replace(self, shock=shock)

    def scene(self, i: int) -> Scene:
        """Return the scene of row i; raise InputError if the row describes none."""
        link, shock = self.link[i].tolist(), self.shock[i].tolist()
        return Scene(
            spins=tuple(self.spins[i].tolist()),
            rotor=Rotor(*self.rotor[i].tolist()),
            link=None if np.isnan(link).all() else Link(*link),
            shock=None if np.isnan(shock).all() else Shock(tuple(shock[:3]), *shock[3:]),
            axes=_vectors(self.axes[i]),
            rates=_vectors(self.rates[i]),
        )

    @property
    def linked(self) -> NDArray[np.bool_]:
        """True for the scenes with a bar, (n,)."""
        return np.asarray(~np.isnan(self.link).all(1))

    @property
    def shocked(self) -> NDArray[np.bool_]:
        """True for the scenes with a shock, (n,)."""
        return np.asarray(~np.isnan(self.shock).all(1))

    def check(self, first: int = 0) -> None:
        """Raise InputError for the first row that describes no valid scene; in the message row 0 has the number `first`."""
        with np.errstate(all="ignore"):
            suspicious = np.flatnonzero(~self._surely_valid())
        for i in suspicious.tolist():
            try:
                self.scene(i)
            except InputError as refusal:
                raise InputError(f"sweep: scene {first + i}: {refusal}") from None

    def _surely_valid(self) -> NDArray[np.bool_]:
        """Return True for the rows (n,) that satisfy the conditions of a Scene with a margin for rounding."""
        linked, shocked = self.linked, self.shocked
        link = np.where(linked[:, None], self.link, [1.0, 0.0, 0.0])
        shock = np.where(shocked[:, None], self.shock, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
        (R, I1, I3), ell = self.rotor.T[1:], link[:, 0]
        r, v, n = self.axes, self.rates, len(self)
        finite = np.concatenate([self.spins, self.rotor, link, shock, r.reshape(n, 6), v.reshape(n, 6)], axis=1)
        above_zero = np.concatenate([self.rotor, link[:, :1], shock[:, 4:5]], axis=1)
        valid = (np.abs(finite) < _LARGEST).all(1) & (above_zero > SMALLEST / _TIGHTER).all(1)
        valid &= ((self.spins == 0) | (np.abs(self.spins) > SMALLEST / _TIGHTER)).all(1)
        valid &= (I3 <= 2 * I1) & ((shock[:, 5] == 1) | (shock[:, 5] == 2))
        valid &= (link[:, 1:] >= 0).all(1) & ((link[:, 2] == 0) | (link[:, 1] > 0))
        close = _TIGHTER * CLOSE
        speeds = np.linalg.norm(v, axis=-1)
        valid &= (np.abs(np.linalg.norm(r, axis=-1) - 1) < close).all(1)
        valid &= (np.abs((r * v).sum(-1)) < close * (1 + speeds)).all(1)
        bar, w = R[:, None] * (r[:, 1] - r[:, 0]), v[:, 1] - v[:, 0]
        bar[:, 0] += ell
        stretch = (bar * w).sum(-1) / ell
        held = np.abs(np.linalg.norm(bar, axis=-1) - ell) < close * ell
        held &= np.abs(stretch) < close * (1 + np.linalg.norm(w, axis=-1))
        # Near the joint line both axes have an x component near 1; the scene itself decides then.
        held &= (np.abs(r[:, :, 0]) < _TIGHTER).any(1)
        return valid & (held | ~linked)


def _vectors(rows: Array) -> tuple[Vector, Vector]:
    first, second = rows.tolist()
    return tuple(first), tuple(second)


@dataclass(frozen=True, eq=False)
class LazyScenes(Sequence[Scene]):
    """The scenes of columns as a sequence; each scene is made when it is asked for."""

    columns: SceneColumns

    def __len__(self) -> int:
        return len(self.columns)

    def __getitem__(self, i: Any) -> Any:
        if isinstance(i, slice):
            return tuple(map(self.columns.scene, range(len(self))[i]))
        if not -len(self) <= i < len(self):
            raise IndexError(f"scene {i} of {len(self)} scenes")
        return self.columns.scene(i)

    def __iter__(self) -> Iterator[Scene]:
        return map(self.columns.scene, range(len(self)))
