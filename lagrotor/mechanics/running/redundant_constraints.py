"""Redundant constraints: rows of G that follow from the others at every state, so that the motion is unique, its multipliers not.

The rank of G is measured on the constraints, at the start and at states near to it, because a parallelogram with a third crank
has dependent rows only where it closes. A subset of independent rows is kept for the run, holonomic ones first. A dropped
constraint must hold wherever the kept ones hold. Row i has a determined multiplier if no vector z with Gᵀ z = 0 has an entry z_i.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np
import sympy as sp

from lagrotor.errors import ConstraintError, InputError, LagrotorError
from lagrotor.mechanics.constraints import project_position
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.flow import Array
from lagrotor.mechanics.running.programs import function_program
from lagrotor.mechanics.running.singular_positions import rows_at

Kind = TypeVar("Kind", bound=Equations)
_SUSPECT = 1e-5  # least singular value of scaled rows, below which the rank is measured
_DEPENDENT = 1e-8  # part of a scaled row outside the span of the others, below which it is dependent
_HOLDS = 1e-9  # residual of a dropped constraint over its row, at a state that satisfies the others
_TAKES_PART = 1e-6  # entry of a left null vector of the rows, from which a multiplier is not determined
_NEAR, _STATES = 0.03, 3  # distance over the size of a configuration, and number, of states near the start
_STEPS = 100


class Redundancy(NamedTuple):
    """The constraints that a run leaves out because they follow from the others.

    Attributes
    ----------
    dropped : tuple of str
        Their names.
    residuals : tuple of Expr
        Their expressions, g and G v + b, which stay zero.
    undetermined : tuple of str
        The names of all constraints whose multipliers are not determined.
    symbols : frozenset of Symbol
        The symbols of these multipliers.
    """

    dropped: tuple[str, ...]
    residuals: tuple[sp.Expr, ...]
    undetermined: tuple[str, ...]
    symbols: frozenset[sp.Symbol]

    @property
    def words(self) -> str:
        """The reason why a reaction is refused, and the remedy."""
        names = ", ".join(self.undetermined)
        return (
            f"the constraints {names} are dependent (rank of G), so that only sums of their reactions are determined: "
            f"leave {', '.join(self.dropped)} out to give the whole force to the others, or give the parts elasticity"
        )


def without_redundant(
    where: str, system: Kind, values: Mapping[Any, Any], q: Array, u: Array, t: float
) -> tuple[Kind, Redundancy | None]:
    """Return the system without its redundant constraints, and what was left out; None if the rows are independent near (q, u).

    Raises ConstraintError if dependent constraints contradict each other there.
    """
    if not system.left or (len(system.left) < 2 and system.kinematics is None):
        return system, None
    G = rows_at(system, values, np.concatenate([q, u, np.zeros(len(system.states)), [t]]))
    length = np.linalg.norm(G, axis=1, keepdims=True)
    if not np.isfinite(G).all() or (length.all() and np.linalg.svd(G / length, compute_uv=False)[-1] > _SUSPECT):
        return system, None
    at = _Rows(system, values, t)
    q = at.closed(where, q)
    G = at(q, u)[0]
    kept = independent(G, len(system.constraints))
    dropped = [i for i in range(len(G)) if i not in kept]
    if not dropped:
        return system, None
    offset = at(q, 0 * u)[2]
    if (np.abs(offset - G @ (np.linalg.pinv(G) @ offset)) > _HOLDS * (1 + np.abs(offset).max())).any():
        at.contradict(where, G, offset)
    near = [(q, G), *at.neighbours(q, kept)]
    if any(len(independent(rows, len(system.constraints))) > len(kept) for _, rows in near):
        return system, None  # a singular position, whose neighbours have more independent rows
    if any((np.abs(at.violation(place)[[i for i in dropped if i < at.h]]) > _HOLDS).any() for place, _ in near):
        return system, None
    names = system.multiplier_names
    free = {i for _, rows in near for i in _undetermined(rows, len(kept))}
    undetermined = tuple(names[i] for i in sorted(free))
    symbols = frozenset(system.multipliers[i] for i in free)
    if rubbing := symbols & system.generalised_forces.free_symbols:
        raise InputError(
            f"{where}: a force depends on {min(rubbing, key=str)}, which is not determined, as the constraints "
            f"{', '.join(undetermined)} are dependent: leave out {', '.join(names[i] for i in dropped)}"
        )
    return without(system, {"dropped": [names[i] for i in dropped], "undetermined": undetermined})


def without(system: Kind, about: Mapping[str, Any]) -> tuple[Kind, Redundancy | None]:
    """Return the system without the constraints named in `about`, the entry of a saved run, and what was left out."""
    if not about:
        return system, None
    names, h = system.multiplier_names, len(system.constraints)
    dropped, undetermined = (
        [i for i, name in enumerate(names) if name in about[k]] for k in ("dropped", "undetermined")
    )
    residuals = [system.residual[i] for i in dropped] + [system.constraints[i] for i in dropped if i < h]
    reduced = replace(
        system,
        constraints=tuple(system.constraints[i] for i in range(h) if i not in dropped),
        rolling=tuple(system.rolling[i - h] for i in range(h, len(names)) if i not in dropped),
        names=tuple(name for i, name in enumerate(names) if i not in dropped),
    )
    symbols = frozenset(s for i in undetermined for s in (system.multipliers[i], system.reactions[i]))
    both = (tuple(names[i] for i in places) for places in (dropped, undetermined))
    return reduced, Redundancy(next(both), tuple(residuals), next(both), symbols)


def nearest_without_redundant(
    where: str, system: Kind, values: Mapping[Any, Any], q: Array, u: Array, t: float
) -> tuple[Kind, Redundancy | None]:
    """Do the same for a configuration that need not be near to the constraints, by first moving onto them."""
    return without_redundant(where, system, values, _Rows(system, values, t).closed(where, q), u, t)


def independent(G: Array, h: int) -> list[int]:
    """Return the indices of independent rows of length one, in ascending order. The first h, of holonomic constraints, have
    priority; within both groups the row with the largest part outside the span of those before it comes next."""
    chosen, remainder = list[int](), G.copy()
    for group in (range(h), range(h, len(G))):
        while len(group):
            i = max(group, key=lambda k: np.linalg.norm(remainder[k]))
            size = np.linalg.norm(remainder[i])
            if size <= _DEPENDENT:
                break
            direction = remainder[i] / size
            remainder = remainder - np.outer(remainder @ direction, direction)
            chosen.append(i)
    return sorted(chosen)


def _undetermined(G: Array, rank: int) -> list[int]:
    z = np.linalg.svd(G)[0][:, rank:]
    return [int(i) for i in np.flatnonzero(np.abs(z).max(1) > _TAKES_PART)]


class _Rows:
    """The rows of all constraints on the velocities v, at configurations and quasi-velocities u at the time t in s."""

    def __init__(self, system: Equations, values: Mapping[Any, Any], t: float) -> None:
        self.system, self.h, self.time = system, len(system.constraints), np.array([t])
        self._rows = function_program(system, *system.rows, *system.constraints, *system.residual).along(values)
        self._mass = np.ones(len(system.c.q))

    def __call__(self, q: Any, u: Array) -> tuple[Array, Array, Array]:
        """Return the rows G of length one, shape (k, n), and g (h,) and G v + b (k,) in their units."""
        k, n, d = len(self.system.residual), len(q), len(self.system.states)
        numbers = self._rows(np.concatenate([q, u, np.zeros(d)])[None], self.time)[:, 0]
        G, g, residual = np.split(numbers, [k * n, k * n + self.h])
        G = G.reshape(k, n)
        length = np.linalg.norm(G, axis=1)
        length = np.where(length > 0, length, 1.0)
        return G / length[:, None], g / length[: self.h], residual / length

    def violation(self, q: Array) -> Array:
        """Return |g| of each constraint over the length of its row and the size of the configuration; zero for rolling."""
        _, g, residual = self(q, np.zeros(len(self.system.speeds)))
        return np.append(np.abs(g) / (1 + np.abs(q).max()), np.zeros(len(residual) - self.h))

    def closed(self, where: str, q: Array) -> Array:
        """Return a configuration that satisfies all constraints, by Gauss and Newton's method with the pseudo-inverse."""
        u = np.zeros(len(self.system.speeds))
        for _ in range(_STEPS):
            G, g, _ = self(q, u)
            step = np.linalg.pinv(G[: self.h], rcond=_SUSPECT) @ g if self.h else 0 * q
            if not np.isfinite(step).all():
                break
            q = q - step
            if np.abs(step).max(initial=0) <= 1e-14 * (1 + np.abs(q).max()):
                break
        G, g, _ = self(q, u)
        if (np.abs(g) > _HOLDS * (1 + np.abs(q).max())).any():
            self.contradict(where, G[: self.h], g)
        return q

    def contradict(self, where: str, G: Array, residual: Array) -> None:
        """Raise ConstraintError with the names of dependent constraints that no state satisfies."""
        excess = residual - G @ (np.linalg.pinv(G, rcond=_SUSPECT) @ residual)
        names = [self.system.multiplier_names[i] for i in np.flatnonzero(np.abs(excess) > 0.1 * np.abs(excess).max())]
        raise ConstraintError(
            f"{where}: no state near the start satisfies the constraints {', '.join(names)} beside the others: they leave "
            f"{np.abs(residual).max():.3g}; correct a constraint or a length, or leave out what contradicts the others"
        )

    def neighbours(self, q: Array, kept: list[int]) -> list[tuple[Array, Array]]:
        """Return states near q, which satisfy the kept constraints, each with the rows G there."""
        u, first = np.zeros(len(self.system.speeds)), [i for i in kept if i < self.h]
        G = self(q, u)[0][kept]
        free, random = np.linalg.svd(G)[2][len(G) :], np.random.default_rng(1)
        near = []
        for _ in range(_STATES if len(free) else 0):
            place = np.asarray(q + _NEAR * (1 + np.abs(q).max()) * (random.normal(size=len(free)) @ free))
            try:
                if first:
                    place = np.asarray(
                        project_position(lambda p: self(p, u)[1][first], lambda p: self(p, u)[0][first], place)
                    )
            except LagrotorError:
                continue
            near.append((place, self(place, u)[0]))
        return near
