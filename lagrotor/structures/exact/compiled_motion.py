"""The fast extra: the equations written out, and compiled by heyoka, once a process for a structure whatever its spins.

Few rotors are integrated by heyoka's Taylor series. The series of many outgrow a processor's caches, and a drive has none:
there the right-hand side alone is compiled, for the integrators of the core; that of long chains and rings in segments.
"""

from dataclasses import fields, replace
from functools import lru_cache
from threading import get_ident
from typing import Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.segment import RightHandSide, Stretch, states_on_constraints
from lagrotor.numerics.taylor import (
    companion_order,
    compiled_solver,
    dummy_size,
    heyoka_module,
    heyoka_sum,
    taylor_march,
    taylor_order,
)
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.exact.exact_motion import ExactMotion
from lagrotor.structures.exact.lines_passed import LineWatch
from lagrotor.structures.exact.segments import has_segments, right_hand_side_in_segments
from lagrotor.structures.exact.written_out import structure_accelerations

_RING = 11  # half bandwidth of a ring
_SERIES, _SERIES_SLIM = 32, 128  # rotors up to which series are faster; slim: in chains and rings of massless bars
_WHOLE, _WHOLE_HEAVY = 512, 128  # rotors of a chain or ring up to which it is faster compiled whole; of heavy bars
_WIDE, _HEAVY = 100, 512  # rotors of a net, of a tree with heavy bars, that compile in about half a minute
_BETWEEN = 10.0  # radians at the structure's rate between two projections onto the constraints


def runs_by_series(motion: ExactMotion) -> bool:
    """Whether its Taylor series run a structure fastest."""
    few = _SERIES if motion.saddle.band > _RING or motion.c.coupling.any() else _SERIES_SLIM
    return motion.force is None and motion.ground is None and len(motion.c.R) <= few


def integrate_series(
    s: Assembly, motion: ExactMotion, start: Array, times: Array, local: float, companion: bool
) -> Stretch:
    """States (n, 6 N) as of `motion.rhs` at its times, the start at the first of them; steps times order for evaluations.

    companion: by another order. Raises InputError without heyoka, and StopError where it stops.
    """
    order, watch = companion_order(local) if companion else taylor_order(local), LineWatch(motion)
    solver = _solver(_without_spins(s), order, get_ident())
    solver.pars[:] = _parameters(motion)
    watch.keep(float(times[0]), start)

    def keep(stepped: Any) -> bool:
        watch.keep(stepped.time, stepped.state)
        return True

    def onto(y: Array) -> Array:
        watch.check()
        return motion.project(y)

    span, size = (float(times[0]), float(times[-1])), dummy_size(local, order)
    run = taylor_march(solver, start, times, span, size, onto, _BETWEEN, after_step=keep)
    return Stretch(states_on_constraints(motion.project, run.states), run.end, run.evaluations)


def compiled_right_hand_side(s: Assembly, motion: ExactMotion) -> RightHandSide:
    """(s, y) → y', as `motion.rhs` gives it. Raises InputError without heyoka, and for what takes minutes to compile."""
    N, force, ground = len(motion.c.R), motion.force, motion.ground
    wide, heavy = motion.saddle.band > _RING, motion.c.coupling.any()
    if has_segments(motion):
        if (_WHOLE_HEAVY if heavy else _WHOLE) < N:
            return right_hand_side_in_segments(motion)
    elif (N > _WIDE and wide) or (N > _HEAVY and heavy):
        raise InputError(
            f"simulate: engine='fast' compiles chains and rings of any length, and other structures of up to {_WIDE} rotors "
            f"(trees of up to {_HEAVY}), not of {N}: use engine='core'"
        )
    compiled = _compiled(_without_spins(s), force is not None, ground is not None)
    rate, parameters = motion.c.rate, _parameters(motion)

    def rhs(s: float, y: Array) -> Any:
        given = [np.asarray(drive(s / rate), dtype=float).ravel() for drive in (force, ground) if drive]
        return compiled(y, pars=np.concatenate([parameters, *given]), time=s)

    return rhs


def _parameters(motion: ExactMotion) -> Array:
    return np.append(motion.c.G, motion.c.rate)


@lru_cache(maxsize=16)
def _without_spins(s: Assembly) -> Assembly:
    return Assembly(**{f.name: getattr(s, f.name) for f in fields(Assembly)} | {"spins": 0.0})


@lru_cache(maxsize=16)
def _solver(bare: Assembly, order: int, thread: int) -> Any:
    """The integrator of the state (r, r'/rate); parameters: the axial momenta G (N), the rate."""
    return compiled_solver(_equations(bare), order)


@lru_cache(maxsize=16)
def _compiled(bare: Assembly, forced: bool, shaken: bool) -> Any:
    """heyoka's function of the state; parameters: G (N), the rate, the force on the tips (N, 3), the ground's acceleration."""
    equations = _equations(bare, forced, shaken)
    names, rates = zip(*equations, strict=True)
    return heyoka_module().cfunc(rates, names, compact_mode=True, fast_math=True)


def _equations(bare: Assembly, forced: bool = False, shaken: bool = False) -> list[tuple[Any, Any]]:
    """(variable, its rate) of the state, in heyoka's expressions."""
    heyoka = heyoka_module()
    c, par = coefficients(bare), heyoka.par
    N = len(c.R)
    names = heyoka.make_vars(*(f"{letter}{i:06d}" for letter in "rv" for i in range(3 * N)))
    rate = par[N]
    r = [names[3 * i : 3 * i + 3] for i in range(N)]
    v = [[rate * x for x in names[3 * (N + i) : 3 * (N + i) + 3]] for i in range(N)]
    G = [par[i] * heyoka.exp(-k * heyoka.time / rate) if k else par[i] for i, k in enumerate(c.decay.tolist())]
    plain = replace(c, **{name: getattr(c, name).tolist() for name in ("R", "A", "S", "friction", "hinge", "coupling")})
    pushes, shakes = N + 1, N + 1 + (3 * N if forced else 0)
    more = [
        [plain.R[i] * par[pushes + 3 * i + k] * forced - plain.S[i] * par[shakes + k] * shaken for k in range(3)]
        for i in range(N)
    ]

    found = structure_accelerations(plain, r, v, G, heyoka, heyoka_sum, more if forced or shaken else ())
    return list(zip(names, [*names[3 * N :], *(x / (rate * rate) for axis in found for x in axis)], strict=True))
