"""Redundant constraints: rows of G that follow from the others at every state, so that the motion is unique, its multipliers not.

The rank of G is measured on the constraints, at the start and at states near to it, because a parallelogram with a third crank
has dependent rows only where it closes. A subset of independent rows is kept for the run, holonomic ones first. Row i has a
determined multiplier if no vector z with Gᵀ z = 0 has an entry z_i.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
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
_SUSPECT, _DEPENDENT = 1e-5, 1e-8  # least singular value of scaled rows: measure the rank; dependent
_LATER = 1e-4  # weight of rolling constraints: a holonomic one is kept before them, unless it is nearly dependent
_HOLDS = 1e-10  # distance from a constraint over 1 + the largest coordinate
_TAKES_PART = 1e-6  # entry of a left null vector of the rows, from which a multiplier is not determined
_NEAR, _STATES, _STEPS = 1e-3, 3, 100  # distance and number of states near the start; steps of Newton's method


class Redundancy(NamedTuple):
    """The names of the constraints that a run leaves out, their expressions g and G v + b, which stay zero, the names of all
    constraints whose multipliers are not determined, and the symbols of these multipliers."""

    dropped: tuple[str, ...]
    residuals: tuple[sp.Expr, ...]
    undetermined: tuple[str, ...]
    symbols: frozenset[sp.Symbol]

    @property
    def words(self) -> str:
        """The reason why a reaction is refused, and the remedy."""
        return (
            f"the constraints {', '.join(self.undetermined)} are dependent (rank of G), so that only sums of their reactions are "
            f"determined: leave {', '.join(self.dropped)} out to give the whole force to the others, or give the parts elasticity"
        )


def without_redundant(
    where: str, system: Kind, values: Mapping[Any, Any], q: Array, u: Array, t: float, moved: bool = False
) -> tuple[Kind, Redundancy | None]:
    """Return the system without its redundant constraints, and what was left out; None if the rows are independent near (q, u).
    If `moved` is true, q may be far from the constraints. Raise ConstraintError if dependent ones contradict each other."""
    if not system.left or (len(system.left) < 2 and system.kinematics is None):
        return system, None
    if not moved:
        G = rows_at(system, values, np.concatenate([q, u, np.zeros(len(system.states)), [t]]))
        length = np.linalg.norm(G, axis=1, keepdims=True)
        wide = np.isfinite(G).all() and length.all() and len(G) <= G.shape[1]
        if not np.isfinite(G).all() or (wide and np.linalg.svd(G / length, compute_uv=False)[-1] > _SUSPECT):
            return system, None
    h, names, rows = len(system.constraints), system.multiplier_names, _rows(system, values, t)
    q = _closed(where, names, rows, h, q)
    G, _, offset = rows(q)
    kept = _independent(G, h)
    dropped = [i for i in range(len(G)) if i not in kept]
    if not dropped:
        return system, None
    _check_contradiction(where, names, G, offset, 1 + np.abs(offset).max())
    near = [G, *(rows(place)[0] for place in _neighbours(rows, q, kept, h))]
    if any(len(_independent(G_there, h)) > len(kept) for G_there in near):
        return system, None  # a singular position, whose neighbours have more independent rows
    null = np.max([np.abs(np.linalg.svd(G_there)[0][:, len(kept) :]).max(1) for G_there in near], axis=0)
    lost = np.flatnonzero(null > _TAKES_PART).tolist()
    if rubbing := {system.multipliers[i] for i in lost} & system.generalised_forces.free_symbols:
        raise InputError(
            f"{where}: a force depends on {min(rubbing, key=str)}, which is not determined, as the constraints "
            f"{', '.join(names[i] for i in lost)} are dependent: leave out {', '.join(names[i] for i in dropped)}"
        )
    return without(system, [names[i] for i in dropped], [names[i] for i in lost])


def without(system: Kind, dropped: Sequence[str], undetermined: Sequence[str]) -> tuple[Kind, Redundancy]:
    """Return the system without the constraints with the names in `dropped`, and what was left out."""
    names, h = system.multiplier_names, len(system.constraints)
    kept, out = ([i for i, name in enumerate(names) if (name in dropped) == left_out] for left_out in (False, True))
    residuals = (*(system.residual[i] for i in out), *(system.constraints[i] for i in out if i < h))
    lost = [i for i, name in enumerate(names) if name in undetermined]
    symbols = frozenset(s for i in lost for s in (system.multipliers[i], system.reactions[i]))
    reduced = replace(
        system,
        constraints=tuple(system.constraints[i] for i in kept if i < h),
        rolling=tuple(system.rolling[i - h] for i in kept if i >= h),
        names=tuple(names[i] for i in kept),
    )
    return reduced, Redundancy(tuple(dropped), residuals, tuple(undetermined), symbols)


Rows = Callable[[Any], tuple[Array, Array, Array]]


def _rows(system: Equations, values: Mapping[Any, Any], t: float) -> Rows:
    """Return a function of q that returns the rows G of all constraints, scaled to length one, shape (k, n), and g and the offset
    b in G v + b over the length of their rows, shapes (h,) and (k,)."""
    still = dict.fromkeys(system.c.v, sp.S.Zero)
    offset = [e.xreplace(still) for e in system.residual]
    program = function_program(system, *system.rows, *system.constraints, *offset).along(values)
    k, n, h = len(offset), len(system.c.q), len(system.constraints)

    def rows(q: Any) -> tuple[Array, Array, Array]:
        state = np.append(q, np.zeros(len(system.variables) - n))
        G, g, b = np.split(program(state[None], np.array([t]))[:, 0], [k * n, k * n + h])
        length = np.linalg.norm(G.reshape(k, n), axis=1)
        length = np.where(length > 0, length, 1.0)
        return G.reshape(k, n) / length[:, None], g / length[:h], b / length

    return rows


def _closed(where: str, names: Sequence[str], rows: Rows, h: int, q: Array) -> Array:
    """Return a configuration that satisfies all constraints, by Newton's method with the pseudo-inverse."""
    for _ in range(_STEPS):
        G, g, _ = rows(q)
        step = np.linalg.pinv(G[:h], rcond=_SUSPECT) @ g if np.isfinite(G).all() and h else 0 * q
        q = q - step
        if np.abs(step).max() <= 1e-14 * (1 + np.abs(q).max()):
            break
    G, g, _ = rows(q)
    _check_contradiction(where, names, G[:h], g, 1 + np.abs(q).max())
    return q


def _check_contradiction(where: str, names: Sequence[str], G: Array, residual: Array, size: float) -> None:
    """Raise ConstraintError if no small displacement, or no velocity, makes the residuals (k,) of the rows G zero."""
    excess = np.abs(residual - G @ (np.linalg.pinv(G, rcond=_SUSPECT) @ residual))
    if not (excess <= _HOLDS * size).all():
        wrong = ", ".join(names[int(i)] for i in np.flatnonzero(~(excess <= 0.1 * excess.max())))
        raise ConstraintError(
            f"{where}: no state near the start satisfies the constraints {wrong} beside the others: they leave "
            f"{excess.max():.3g}; correct a constraint or a length, or leave out what contradicts the others"
        )


def _independent(G: Array, h: int) -> list[int]:
    """Return the indices of independent rows of length one, in ascending order. The first h, of holonomic constraints, come
    before the others by their weight in the pivoted factorization."""
    from scipy.linalg import qr

    weight = np.where(np.arange(len(G)) < h, 1.0, _LATER)
    _, triangle, order = qr((G * weight[:, None]).T, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(triangle)) / weight[order[: len(triangle)]]
    return sorted(order[: len(triangle)][sizes > _DEPENDENT].tolist())


def _neighbours(rows: Rows, q: Array, kept: Sequence[int], h: int) -> list[Array]:
    """Return configurations near q that satisfy the kept constraints."""
    free = np.linalg.svd(rows(q)[0][kept])[2][len(kept) :]
    random, first, near = np.random.default_rng(1), [i for i in kept if i < h], list[Array]()
    for direction in random.normal(size=(_STATES, len(free))) @ free if len(free) else ():
        place = np.asarray(q + _NEAR * np.clip(np.abs(q).max(), _NEAR, 1) * direction)
        with suppress(LagrotorError):
            place = np.asarray(project_position(lambda p: rows(p)[1][first], lambda p: rows(p)[0][first], place), float)
            near.append(place)
    return near
