"""The equations of `exact_motion` in scalars instead of arrays, as generated code or compiled by heyoka (extra `fast`).

For few rotors generated scalar code evaluates the right-hand side, because it is faster than operations on arrays. With the
extra `fast`, heyoka integrates few rotors by Taylor series. For more rotors heyoka only compiles the right-hand side, once per
process for all values of the spins.

The linear system is solved in levels. Independent unknowns with the fewest neighbours are eliminated together: in a chain every
other one, then every other one of the remainder (cyclic reduction: Golub & Van Loan, § 4.5.4). The operations are ∝ N, and the
longest chain of dependent operations is ∝ log N. A constraint is eliminated after the accelerations that it couples, because
its own diagonal entry is zero until then.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from functools import lru_cache
from itertools import combinations
from threading import get_ident
from typing import Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics import operation_recorder
from lagrotor.numerics.operation_recorder import Recorded
from lagrotor.numerics.printers import rhs_text
from lagrotor.numerics.segment import RightHandSide, Stretch, states_on_constraints
from lagrotor.numerics.source_cache import function_of
from lagrotor.numerics.taylor import compiled_solver, dummy_size, heyoka_module, heyoka_sum, taylor_march, taylor_order
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Coefficients, coefficients
from lagrotor.structures.exact.exact_motion import Drive, ExactMotion, LineWatch, forces, pulls, right_side

Terms = list[Any]
# The most axes and bars for scalar code: with massless bars, which decouple the axes, and with heavy ones.
_MOST, HEAVY = 40, 15
_RING = 11  # half bandwidth of a ring
_SERIES, _SERIES_SLIM = 32, 128  # the most rotors for series; slim: chains and rings of massless bars
_WIDE, _NARROW = 100, 512  # the most rotors of nets, and of chains, rings and trees, that compile in half a minute
_BETWEEN = 10.0  # radians at the structure's rate between two projections onto the constraints


def eliminate_in_levels(
    diagonal: Sequence[Any], couplings: Mapping[tuple[int, int], Any], right: Sequence[Any], masses: int,
    add: Callable[[Terms], Any] = sum,
) -> list[Any]:  # fmt: skip
    """Solve a symmetric linear system by elimination in levels, and return its unknowns.

    `couplings` maps each pair (i, j) of coupled unknowns to its entry, every pair once. The first `masses` unknowns have the
    entries of `diagonal`; the later unknowns are multipliers of constraints, whose diagonal is zero. `add` sums a list.
    """
    n = len(diagonal)
    pivots, b = [[entry] for entry in diagonal], [[entry] for entry in right]
    rows: list[dict[int, Terms]] = [{} for _ in range(n)]
    for (i, j), entry in couplings.items():
        rows[i][j] = rows[j][i] = [entry]
    holds = [{j for j in row if j < masses} if i >= masses else set[int]() for i, row in enumerate(rows)]
    remaining, eliminated = set(range(n)), list[tuple[int, Any, Any, dict[int, Any]]]()
    while remaining:
        for i in _level(remaining, rows, holds):
            inverse, load = 1.0 / add(pivots[i]), add(b[i])
            row = {j: add(terms) for j, terms in rows[i].items()}
            shares = {j: entry * inverse for j, entry in row.items()}
            for j, entry in row.items():
                pivots[j].append(-(shares[j] * entry))
                b[j].append(-(shares[j] * load))
                del rows[j][i]
            for first, second in combinations(row, 2):
                between = -(shares[first] * row[second])
                if second in rows[first]:
                    rows[first][second].append(between)
                else:
                    rows[first][second] = rows[second][first] = [between]
            eliminated.append((i, inverse, load, shares))
            remaining.discard(i)
    x: list[Any] = [None] * n
    for i, inverse, load, shares in reversed(eliminated):
        x[i] = add([load * inverse, *(-(share * x[j]) for j, share in shares.items())])
    return x


def _level(remaining: set[int], rows: list[dict[int, Terms]], holds: list[set[int]]) -> list[int]:
    """Return unknowns to eliminate together: no two of them are coupled, and each has few neighbours. The limit on the
    neighbours lets half of a chain with heavy bars go at once. A constraint waits for the unknowns in `holds`."""
    ready = [i for i in remaining if not holds[i] & remaining]
    limit = 2 * min(len(rows[i]) for i in ready) + 2
    chosen, neighbours = list[int](), set[int]()
    for i in sorted((i for i in ready if len(rows[i]) <= limit), key=lambda i: (len(rows[i]), i)):
        if i not in neighbours:
            chosen.append(i)
            neighbours.update(rows[i])
    return chosen


def structure_accelerations(
    c: Coefficients, r: Any, v: Any, G: Any, by: Any, add: Callable[[Terms], Any] = sum, external: Any = 0.0
) -> list[Any]:
    """Return the 3N components of r'' (1/s²) for axes r and rates v, both (N, 3), and axial momenta G (N,).

    `by` is a module whose function sqrt takes numbers of this kind, and `add` sums a list of them. `external` are further
    torques on the axes, (N, 3), N m.
    """
    N, (r, v, G) = len(c.R), (np.array(values, dtype=object) for values in (r, v, G))
    right = right_side(c, forces(c, r, v, G, np.frompyfunc(by.sqrt, 1, 1)) + external, v).tolist()
    diagonal = [*np.repeat(c.A, 3).tolist(), *[0.0] * (N + len(c.i))]
    couplings: dict[tuple[int, int], Any] = {(3 * i + k, 3 * N + i): r[i, k] for i in range(N) for k in range(3)}
    first, second = pulls(c, r)
    for b, (i, j, coupling) in enumerate(zip(c.i.tolist(), c.j.tolist(), c.coupling.tolist(), strict=True)):
        for k in range(3):
            couplings[3 * i + k, 4 * N + b], couplings[3 * j + k, 4 * N + b] = first[b, k], second[b, k]
            if coupling:
                couplings[3 * i + k, 3 * j + k] = coupling
    return eliminate_in_levels(diagonal, couplings, right, 3 * N, add)[: 3 * N]


def right_hand_side(motion: ExactMotion) -> RightHandSide:
    """Return the right-hand side (s, y) → y' of an exact motion: generated scalar code for few rotors, arrays for more."""
    c = motion.c
    if len(c.R) + len(c.i) > (HEAVY if c.coupling.any() else _MOST):
        return motion.rhs

    def numbers(drive: Drive | None) -> Callable[[float], list[float]]:
        return lambda t: np.asarray(drive(t) if drive else (), dtype=float).ravel().tolist()

    make = function_of(_source(c, motion.force is not None, motion.ground is not None))
    rhs: RightHandSide = make(numbers(motion.force), numbers(motion.ground))
    return rhs


def _source(c: Coefficients, forced: bool, shaken: bool) -> str:
    """Return the source of a function (force, ground) → rhs, where rhs(s, y) is the right-hand side. Forces on the tips enter
    if `forced` is True, and the acceleration of the ground if `shaken` is True."""
    N, rate, tape = len(c.R), c.rate, list[Recorded]()
    states, pushes, shakes = ([f"{x}{k}" for k in range(n)] for x, n in (("y", 6 * N), ("p", 3 * N), ("g", 3)))
    y, p, g = (np.array([Recorded(tape, name) for name in names]) for names in (states, pushes, shakes))
    r, v = y.reshape(2, N, 3)
    G = [Recorded(tape, f"({G}*exp({-k / rate}*s))") if k else G for G, k in zip(c.G, c.decay, strict=True)]
    external = c.R[:, None] * p.reshape(N, 3) * forced - c.S[:, None] * g * shaken
    accelerations = structure_accelerations(c, r, rate * v, G, operation_recorder, external=external)
    lines, rates = operation_recorder.lines((x / rate**2 for x in accelerations), tape)
    body = [f"{', '.join(states)} = y.tolist()"]
    body += [f"{', '.join(pushes)} = force(s/{rate})"] if forced else []
    body += [f"{', '.join(shakes)} = ground(s/{rate})"] if shaken else []
    body += [*lines, f"return [{', '.join([*states[3 * N :], *rates])}]"]
    return rhs_text(body, [], ["force", "ground"], 6 * N)


def runs_by_series(motion: ExactMotion) -> bool:
    """Return True if the structure has so few rotors that heyoka's Taylor series is the fastest method."""
    few = _SERIES if motion.saddle.band > _RING or motion.c.coupling.any() else _SERIES_SLIM
    return len(motion.c.R) <= few


def integrate_series(
    s: Assembly, motion: ExactMotion, start: Array, times: Array, local: float, companion: bool
) -> Stretch:
    """Integrate `motion.rhs` by heyoka's Taylor series from the state `start` at times[0]. The states are (n, 6N)."""
    order, watch = taylor_order(local, companion), LineWatch(motion)
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
    """Return the right-hand side (s, y) → y' compiled by heyoka. Raises InputError if heyoka is not installed, or if the
    compilation would take more than half a minute."""
    N = len(motion.c.R)
    if (_WIDE if motion.saddle.band > _RING else _NARROW) < N:
        raise InputError(
            f"simulate: engine='fast' compiles chains, rings and trees of up to {_NARROW} rotors and nets of up to {_WIDE}, "
            f"not {N} rotors: use engine='core'"
        )
    compiled, parameters = _compiled(_without_spins(s)), _parameters(motion)
    return lambda s, y: compiled(y, pars=parameters, time=s)


def _parameters(motion: ExactMotion) -> Array:
    return np.append(motion.c.G, motion.c.rate)


@lru_cache(maxsize=16)
def _without_spins(s: Assembly) -> Assembly:
    return Assembly(**{f.name: getattr(s, f.name) for f in fields(Assembly)} | {"spins": 0.0})


@lru_cache(maxsize=16)
def _solver(bare: Assembly, order: int, thread: int) -> Any:
    """Return heyoka's integrator of the state (r, r'/rate) for one thread. Its parameters are G (N,) and the rate."""
    return compiled_solver(_equations(bare), order)


@lru_cache(maxsize=16)
def _compiled(bare: Assembly) -> Any:
    """Return heyoka's compiled derivative of the state (r, r'/rate). Its parameters are the momenta G (N,) and the rate."""
    names, rates = zip(*_equations(bare), strict=True)
    return heyoka_module().cfunc(rates, names, compact_mode=True, fast_math=True)


def _equations(bare: Assembly) -> list[tuple[Any, Any]]:
    """Return a pair (variable, derivative in s = rate t) for each component of the state, as heyoka's expressions."""
    heyoka = heyoka_module()
    c, par = coefficients(bare), heyoka.par
    N = len(c.R)
    names = heyoka.make_vars(*(f"{letter}{i:06d}" for letter in "rv" for i in range(3 * N)))
    rate = par[N]
    r, v = np.array(names, dtype=object).reshape(2, N, 3)
    G = [par[i] * heyoka.exp(-k * heyoka.time / rate) if k else par[i] for i, k in enumerate(c.decay.tolist())]
    accelerations = structure_accelerations(c, r, rate * v, G, heyoka, heyoka_sum)
    return list(zip(names, [*names[3 * N :], *(x / (rate * rate) for x in accelerations)], strict=True))
