"""The fast extra: the equations written out, compiled by heyoka, and integrated by its Taylor series.

Compiled once a process for a structure whatever its spins: about two seconds for nine rotors, four for 256 in a chain.
"""

from dataclasses import fields, replace
from functools import lru_cache
from threading import get_ident
from typing import Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.heyoka_programs import heyoka_module
from lagrotor.numerics.integrate import Solution
from lagrotor.numerics.taylor_steps import compiled_solver, dummy_size, march, taylor_order
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.exact.exact_motion import ExactMotion
from lagrotor.structures.exact.lines_passed import LineWatch
from lagrotor.structures.exact.written_out import accelerations

_RING, _MOST = 11, 64  # half bandwidth of a ring; what compiles in about half a minute
_BETWEEN = 10.0  # radians at the structure's rate between two projections onto the constraints


def integrate_compiled(
    s: Assembly, motion: ExactMotion, start: Array, times: Array, tols: tuple[float, float]
) -> list[Solution]:
    """For both tolerances, which a processor's vectors integrate side by side at the price of the tighter one: states
    (n, 6 N) as of `motion.rhs` at times in s, off the constraints by its error; steps times order for evaluations.

    Raises InputError without heyoka, for what it cannot compile, and StopError where it stops.
    """
    if motion.force is not None or motion.ground is not None:
        raise InputError("simulate: engine='fast' takes no drive and no ground: use engine='core'")
    narrow = motion.saddle.band <= _RING and not motion.c.coupling.any()
    if len(s.joints) > _MOST and not narrow:
        raise InputError(
            f"simulate: engine='fast' compiles chains and rings of massless bars, and other structures up to {_MOST} rotors, "
            f"not of {len(s.joints)}: use engine='core'"
        )
    c, order = motion.c, taylor_order(min(tols))
    solver, span = _solver(_without_spins(s), order, get_ident()), (0.0, float(times[-1]))
    solver.pars[: len(c.R)], solver.pars[len(c.R)] = c.G[:, None], c.rate
    sizes, watch = np.array([dummy_size(tol, order) for tol in tols]), LineWatch(motion)
    watch.keep(0.0, start)

    def keep(stepped: Any) -> bool:
        watch.keep(stepped.time[-1], stepped.state[:, -1])
        return True

    def onto(y: Array) -> Array:
        watch.check()
        return motion.projected(y)

    both = np.repeat(start[:, None], 2, axis=1)
    states, _, nfev = march(solver, both, times, span, sizes, onto, _BETWEEN / c.rate, after_step=keep)
    return [Solution(found, nfev // 2) for found in states.transpose(2, 0, 1)]


@lru_cache(maxsize=16)
def _without_spins(s: Assembly) -> Assembly:
    return Assembly(**{f.name: getattr(s, f.name) for f in fields(Assembly)} | {"spins": 0.0})


@lru_cache(maxsize=16)
def _solver(bare: Assembly, order: int, thread: int) -> Any:
    """The integrator in time t and the state (r, r'/rate); parameters: the axial momenta G (N), the rate."""
    heyoka = heyoka_module()
    c = coefficients(bare)
    N, time = len(c.R), heyoka.time
    names = heyoka.make_vars(*(f"{letter}{i:06d}" for letter in "rv" for i in range(3 * N)))
    rate = heyoka.par[N]
    r = [names[3 * i : 3 * i + 3] for i in range(N)]
    v = [[rate * x for x in names[3 * (N + i) : 3 * (N + i) + 3]] for i in range(N)]
    G = [heyoka.par[i] * heyoka.exp(-k * time) if k else heyoka.par[i] for i, k in enumerate(c.decay.tolist())]
    plain = replace(c, **{name: getattr(c, name).tolist() for name in ("R", "A", "S", "friction", "hinge", "coupling")})

    def add(terms: list[Any]) -> Any:
        return heyoka.sum([heyoka.expression(x) if isinstance(x, float) else x for x in terms])

    found = accelerations(plain, r, v, G, heyoka, add)
    rates = [x for axis in v for x in axis] + [x / rate for axis in found for x in axis]
    return compiled_solver(list(zip(names, rates, strict=True)), order, lanes=2)
