"""The fast extra: the equations written out, and compiled by heyoka, once a process for a structure whatever its spins.

Few rotors are integrated by heyoka's Taylor series. The series of many outgrow a processor's caches, and a drive has none:
there the right-hand side alone is compiled, for the integrators of the core.

A program that is compiled for all rotors of a long chain or ring has tables of where each of its numbers lies, which outgrow the
processor's caches, too. There the equations of one segment are compiled, once for all structures, and evaluated for all segments
side by side in the processor's vectors (substructures: Przemieniecki 1963), so that N changes neither the cost of a rotor nor
what is compiled. A segment has its rotors, the bar to the left of each, and sees the rotors beside it. What lies within is
eliminated; what is left joins, in a narrow band, the bars between segments, and where bars are heavy the segments' first rotors
and the bars at them. Of these unknowns all accelerations follow.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import lru_cache
from itertools import count
from threading import get_ident
from types import SimpleNamespace
from typing import Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.segment import RightHandSide, Stretch, states_on_constraints
from lagrotor.numerics.taylor import (
    compiled_solver,
    dummy_size,
    heyoka_module,
    heyoka_sum,
    taylor_march,
    taylor_order,
)
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Index, coefficients
from lagrotor.structures.exact.exact_motion import ExactMotion, LineWatch
from lagrotor.structures.exact.forces import brace_forces
from lagrotor.structures.exact.saddle import in_band, narrow_order
from lagrotor.structures.exact.written_out import eliminate_in_levels, structure_accelerations, system

LENGTH = 16  # rotors of a segment
_SEEN = ("R", "x", "y", "coupling", "loose")  # the numbers of all rotors seen, and of the bar to the left of each
_NAMES = (*_SEEN, "A", "S", "friction", "hinge")


@dataclass(frozen=True, eq=False)
class Programs:
    """forward: (r, r' of the rotors seen, G, what else acts on a segment's own) → entries between the unknowns kept, then
    their right side; back: (the same, unknowns kept) → r''. own: how many come first that are the segment's, of which the
    others are the next one's first. entries (2, …): of which two of them, those on the diagonal first.
    """

    forward: Any
    back: Any
    own: int
    entries: Index


@lru_cache(maxsize=32)
def programs(length: int, names: tuple[str, ...], pushed: bool) -> Programs:
    """The compiled programs of a segment; names: which of its numbers are not zero; pushed: whether something else acts."""
    heyoka, N = heyoka_module(), length + 2
    r, v, push = (
        [heyoka.make_vars(*(f"{letter}{i:03d}{k}" for k in range(3))) for i in range(many)]
        for letter, many in (("r", N), ("v", N), ("f", length * pushed))
    )
    G, still = [heyoka.make_vars(f"g{i:03d}") for i in range(length)], [0.0] * 3
    c = _segment_parameters(length, names)
    more = np.array([still, *push, still], dtype=object) if pushed else 0.0
    diagonal, off, right, masses = system(c, r, v, [0.0, *G, 0.0], heyoka, more)
    first, unit, bar, last = 3, masses + 1, masses + N, masses + N + length
    for b, loose in ((bar, c.loose[1]), (last, c.loose[-1])):
        off |= {pair: (1.0 - loose) * entry for pair, entry in off.items() if pair[1] == b}
    diagonal[bar], right[last] = c.loose[1], 0.0  # the rest of this bar's row is the next segment's
    off = {(i, j): entry for (i, j), entry in off.items() if j != last or i < masses - 3}
    heavy = "coupling" in names
    own = [bar, *[first, first + 1, first + 2, unit, *[bar + 1] * (length > 1)] * heavy]
    kept = [*own, last, *[masses - 3, masses - 2, masses - 1] * heavy]
    left = eliminate_in_levels(
        diagonal, off, right, masses, heyoka_sum, {*kept, 0, 1, 2, masses - 3, masses - 2, masses - 1, masses, bar - 1}
    )
    left_over = {(p, p): left.pivots[i] for p, i in enumerate(kept)}
    left_over |= {(p, q): left.rows[i].get(j, []) for p, i in enumerate(kept) for q, j in enumerate(kept) if p < q}
    left_over = {pair: terms for pair, terms in left_over.items() if any(x != 0.0 for x in terms)}
    inputs = [*(x for each in (r, v) for axis in each for x in axis), *G, *(x for axis in push for x in axis)]
    outputs = [heyoka_sum(terms) for terms in [*left_over.values(), *(left.right[i] for i in kept)]]
    known = dict(zip(kept, heyoka.make_vars(*(f"x{p}" for p in range(len(kept)))), strict=True))
    return Programs(
        heyoka.cfunc(outputs, inputs, fast_math=True),
        heyoka.cfunc(left.solve(known, heyoka_sum)[3 : masses - 3], [*inputs, *known.values()], fast_math=True),
        len(own),
        np.transpose(list(left_over)),
    )


def _segment_parameters(length: int, names: tuple[str, ...]) -> Any:
    """The coefficients of the rotors that a segment sees, its parameters those of these names."""
    par, places, c = heyoka_module().par, count(), dict[str, Any]()
    for name in _NAMES:
        beside = [0.0] * (name not in _SEEN)
        many = length + 2 * (name in _SEEN)
        numbers = [par[next(places)] if name in names else 0.0 for _ in range(many)]
        c[name] = np.array([*beside, *numbers, *beside], dtype=object)
    feet = np.array([*zip(c["x"], c["y"], [0.0] * (length + 2), strict=True)], dtype=object)
    ends = np.arange(length + 1)
    c["coupling"] = c["coupling"][1:]
    return SimpleNamespace(**c, i=ends, j=ends + 1, feet=feet, gravity=1.0, stiffness=())


@dataclass(frozen=True, eq=False)
class _Group:
    """Segments of one length, P of them. unknowns (kept, P): rows of those kept; take (…, P): where the inputs lie in the
    state, the momenta and what else acts; put (…, P): r''; pars (…, P): the numbers.
    """

    programs: Programs
    unknowns: Index
    take: Index
    put: Index
    pars: Array


def _has_segments(motion: ExactMotion) -> bool:
    """Whether every rotor has at most two bars, as in chains and rings."""
    return bool((np.bincount(np.concatenate([motion.c.i, motion.c.j]), minlength=1) <= 2).all())


def right_hand_side_in_segments(motion: ExactMotion) -> RightHandSide:
    """(s, y) → y', as `motion.rhs` gives it, where `_has_segments`. Raises InputError without heyoka."""
    c, N, rate = motion.c, len(motion.c.R), motion.c.rate
    pushed = motion.force is not None or motion.ground is not None or len(c.stiffness) > 0
    groups = _groups(motion, pushed)
    loads = np.concatenate([group.unknowns.ravel() for group in groups])
    # Rows and columns of the entries that the programs find, then those off the diagonal the other way.
    both_ways = [(e, e[::-1, e[0] != e[1]]) for e in (group.programs.entries for group in groups)]
    rows, columns = np.concatenate(
        [g.unknowns[e].reshape(2, -1) for g, ways in zip(groups, both_ways, strict=True) for e in ways], axis=1
    )
    n, band = int(loads.max()) + 1, int(np.abs(rows - columns).max())
    width = 3 * band + 1
    places = columns * width + 2 * band + rows - columns

    def rhs(s: float, y: Array) -> Any:
        momenta = c.G * np.exp(-c.decay * (s / rate)) if c.decay.any() else c.G
        state, matrix, right = [y, momenta / rate], list[Any](), list[Any]()
        if pushed:
            r, v = y.reshape(2, N, 3)
            state.append((brace_forces(c, r, v * rate) + motion.pushes(s / rate)).ravel() / rate**2)
        inputs = [np.concatenate(state)[group.take] for group in groups]
        for group, given in zip(groups, inputs, strict=True):
            entries, (p, q) = group.programs.forward(given, pars=group.pars), group.programs.entries
            matrix += [entries[: len(p)].ravel(), entries[np.count_nonzero(p == q) : len(p)].ravel()]
            right.append(entries[len(p) :].ravel())
        ab: Any = np.bincount(places, np.concatenate(matrix), n * width)
        b: Any = np.bincount(loads, np.concatenate(right), n)
        x = in_band(band, ab.reshape(n, width), b)
        rates = np.empty_like(y)
        rates[: 3 * N] = y[3 * N :]
        for group, given in zip(groups, inputs, strict=True):
            known, back = np.concatenate([given, x[group.unknowns]]), group.programs.back
            rates[group.put] = back(known, pars=group.pars[: back.nparams])
        return rates

    return rhs


def _groups(motion: ExactMotion, pushed: bool) -> list[_Group]:
    """The segments by their lengths."""
    N, cut, bar = len(motion.c.R), list[list[int]](), np.full(len(motion.c.R), -1)
    for rotors, bars in _lines(N, motion.c.i.tolist(), motion.c.j.tolist()):
        bar[rotors], around, whole = bars, [rotors[-1], *rotors, rotors[0]], len(rotors) // LENGTH * LENGTH
        cut += [around[k : k + LENGTH + 2] for k in range(0, whole, LENGTH)]
        cut += [around[k : k + 3] for k in range(whole, len(rotors))]
    numbers = _numbers(motion, bar)
    names, groups = tuple(name for name in _NAMES if numbers[name].any()), list[_Group]()
    number = {seen[1]: k for k, seen in enumerate(cut)}
    # Beyond an end all is multiplied by zero, and may be added anywhere.
    after = np.array([k if bar[seen[-1]] < 0 else number[seen[-1]] for k, seen in enumerate(cut)])
    own = np.array([programs(len(seen) - 2, names, pushed).own for seen in cut])
    order = np.argsort(-narrow_order(len(cut), np.arange(len(cut)), after))  # not reversed: next ones come later
    begin = np.empty_like(after)
    begin[order] = np.cumsum(own[order]) - own[order]
    for length in sorted({len(seen) - 2 for seen in cut}):
        which = np.array([k for k, seen in enumerate(cut) if len(seen) == length + 2])
        seen = np.ascontiguousarray(np.transpose([cut[k] for k in which]))
        compiled, shared = programs(length, names, pushed), np.arange(4 if "coupling" in names else 1)[:, None]
        unknowns = np.concatenate([begin[which] + np.arange(compiled.own)[:, None], begin[after[which]] + shared])
        axes = (3 * seen[:, None] + np.arange(3)[:, None]).reshape(-1, len(which))
        take = [axes, 3 * N + axes, 6 * N + seen[1:-1], *([7 * N + axes[3:-3]] if pushed else [])]
        pars = [numbers[name][seen if name in _SEEN else seen[1:-1]] for name in names]
        groups.append(_Group(compiled, unknowns, np.concatenate(take), 3 * N + axes[3:-3], np.concatenate(pars)))
    return groups


def _numbers(motion: ExactMotion, bar: Index) -> dict[str, Array]:
    """name → (N,), where the structure's rate is 1; bar: the one to the left of each rotor, −1 where there is none."""
    c, rate = motion.c, motion.c.rate
    scaled: Any = c.gravity * c.S / rate**2, c.friction / rate, c.hinge / rate**2
    numbers = dict(zip(("R", "x", "y", "A", "S", "friction", "hinge"), (c.R, *c.feet.T[:2], c.A, *scaled), strict=True))
    return numbers | {"coupling": np.append(c.coupling, 0.0)[bar], "loose": 1.0 * (bar < 0)}


def _lines(N: int, i: list[int], j: list[int]) -> Iterator[tuple[list[int], list[int]]]:
    """The chains and rings: rotors in a row, and the bar before each, −1 at the beginning of a chain."""
    beside: list[list[tuple[int, int]]] = [[] for _ in range(N)]
    for b, (one, other) in enumerate(zip(i, j, strict=True)):
        beside[one].append((b, other))
        beside[other].append((b, one))
    passed = [False] * N
    for start in sorted(range(N), key=lambda k: len(beside[k])):
        if passed[start]:
            continue
        rotors, bars = list[int](), [-1]
        k: int | None = start
        while k is not None and not passed[k]:
            passed[k] = True
            rotors.append(k)
            onward = next(((b, other) for b, other in beside[k] if b != bars[-1]), (-1, None))
            bars.append(onward[0])
            k = onward[1]
        yield rotors, [bars[-1], *bars[1:-1]]


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
    """(s, y) → y', as `motion.rhs` gives it. Raises InputError without heyoka, and for what takes minutes to compile."""
    N, force, ground = len(motion.c.R), motion.force, motion.ground
    wide, heavy = motion.saddle.band > _RING, motion.c.coupling.any()
    if _has_segments(motion):
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
    r, v = np.array(names, dtype=object).reshape(2, N, 3)
    G = [par[i] * heyoka.exp(-k * heyoka.time / rate) if k else par[i] for i, k in enumerate(c.decay.tolist())]
    given = np.array([par[N + 1 + k] for k in range(3 * N * forced + 3 * shaken)], dtype=object)
    more: Any = c.R[:, None] * given[: 3 * N].reshape(N, 3) if forced else 0.0
    more = more - c.S[:, None] * given[-3:] if shaken else more
    accelerations = structure_accelerations(c, r, rate * v, G, heyoka, heyoka_sum, more)
    return list(zip(names, [*names[3 * N :], *(x / (rate * rate) for x in accelerations)], strict=True))
