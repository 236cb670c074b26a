"""Narrow terms of a system, which change within a small part of the motion: bumps, steps and walls.

A solver whose step is longer than such a term misses it. Therefore an auxiliary variable ψ is integrated along with the motion.
For a term exp(g), tanh(g) or another function of g, it is ψ = asinh(g). Then ψ' is proportional to 1/distance from g = 0, so
that the solver shortens its steps before that place. For a power Dᵖ, log(D) or a Lorentzian, ψ = log|D|. At some place the rate
of ψ with respect to a component of the state is largest. A term is narrow if at this rate ψ would change by more than MOST over
the range of the component. Newton's method seeks the place at zeros and turning points of g, from states of the motion.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from lagrotor.algebra import derivative
from lagrotor.algebra.subexpressions import subexpressions
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.programs import FOLLOWED, function_program
from lagrotor.numerics.error_estimate import EstimatedRun
from lagrotor.numerics.pulse import COMPANION_STEP
from lagrotor.numerics.segment import Array
from lagrotor.result_display import scientific

MOST = 8.0  # change of ψ over the swing of one component, beyond which a term is narrow
EDGE = 1e-6  # of the swing, within which two jumps of a Piecewise are one
_PLACES, _SWEEPS = 16, 6  # states from which zeros and turning points are sought; Newton steps of each component
_ZERO = 1e-20  # D over its size: solvers follow a power of zero, whose width is the distance of the motion
# Error of ψ over local^(1/4): DOP853 weighs its error of order 5 by the error of order 3 of all components, ∝ local^(−1/2). Of
# 120 steps and bumps of widths 10⁻⁵ to 0.03, the value 1 misses one, and 0.1 none.
_LOOSELY = 0.01
_WIDE = (sp.sin, sp.cos, sp.tan, sp.cot, sp.Abs, sp.sign, sp.Heaviside, sp.asin, sp.acos)


class NarrowPart(NamedTuple):
    """A term f(g) that may be narrow. A solver's steps are shortened near it by a variable ψ with ψ' = factor · g'; the argument
    is g."""

    argument: sp.Expr
    factor: sp.Expr
    term: sp.Expr


@lru_cache(maxsize=64)
def _parts(system: Equations, section: sp.Expr | None) -> tuple[NarrowPart, ...]:
    """Return the terms that may be narrow, one for each argument g. They are sought in the section, or in the energy and the
    forces if it is None."""
    energy = getattr(system.lagrangian, "remainder", system.lagrangian)
    states = {*system.c.v, *system.variables}
    narrow: dict[sp.Expr, NarrowPart] = {}

    def add(term: sp.Expr, g: sp.Expr, log: bool) -> None:
        unknown = g.free_symbols & {*system.reactions, *system.multipliers, *system.c.a}
        if g.free_symbols & states and not unknown and not g.has(AppliedUndef, sp.Derivative, sp.Piecewise):
            g = -g if g.could_extract_minus_sign() else g
            narrow.setdefault(g, NarrowPart(g, 1 / g if log else (1 + g**2) ** sp.Rational(-1, 2), term))

    for term in subexpressions(*((energy, *system.acting) if section is None else (section,))):
        of_base = isinstance(term, sp.Pow) and bool(term.base.free_symbols & states)
        if of_base and not (
            term.exp.is_number and abs(term.exp) <= MOST**2
        ):  # like exp(n (b² − 1)/2) where b is near 1
            add(term, term.exp * (term.base**2 - 1) / 2, False)
        if of_base and not (term.exp.is_positive and (term.exp.is_Integer or not term.exp.is_number)):
            add(term, term.base, True)
        elif isinstance(term, sp.Pow) and term.exp.free_symbols & states:
            add(term, term.exp * sp.log(term.base), False)
        elif isinstance(term, sp.Function) and len(term.args) == 1 and not isinstance(term, (AppliedUndef, *_WIDE)):
            add(term, term.args[0], isinstance(term, sp.log))
        elif isinstance(term, Relational):  # of a Piecewise
            add(term, term.lhs - term.rhs, False)
    return tuple(narrow.values())


def with_followed(scale: Array, followed: Sequence[NarrowPart], local: float, companion: bool = False) -> Array:
    """Append, to the solver's error scales (d,), one for each narrow term in `followed` whose ψ is integrated along with the
    state. The error of ψ may be larger than that of the state."""
    unit = FOLLOWED * (COMPANION_STEP if companion else 1.0) * _LOOSELY * local**0.25 / local
    return np.append(scale, np.full(len(followed), unit))


def narrow_parts(
    system: Equations, values: Mapping[Any, Any], states: Array, section: sp.Expr | None = None
) -> tuple[NarrowPart, ...]:
    """Return the terms that change sharply between neighbouring states of a run, which have the shape (n, d).

    They are terms of the system, or of the function `section` if it is given. A state is (q, u) or (q, u, t).
    """
    candidates = (_with_edge(system, values, candidate, states) for candidate in _parts(system, section))
    return tuple(candidate for candidate in candidates if _narrowness(system, values, candidate, states) > MOST)


def _with_edge(system: Equations, values: Mapping[Any, Any], feature: NarrowPart, states: Array) -> NarrowPart:
    """For a condition of a Piecewise, set ψ = asinh(g/width) with a width of about EDGE times the range of g. Return any other
    term unchanged."""
    if not isinstance(feature.term, Relational):
        return feature
    swing = np.ptp(function_program(system, feature.argument).along(values)(states, np.zeros(len(states))))
    width = sp.Float(EDGE * 10.0 ** np.ceil(np.log10(swing or 1.0)))
    return feature._replace(factor=(width**2 + feature.argument**2) ** sp.Rational(-1, 2))


def narrowest_words(
    system: Equations, values: Mapping[Any, Any], narrow: Sequence[NarrowPart], run: EstimatedRun
) -> str:
    """Return a sentence that names the narrowest term, the time in s of its first passage, and a remedy. Return "" if the run did
    not keep tol up to that time."""
    if not narrow or len(run.t) < 2:
        return ""
    narrowness = [_narrowness(system, values, feature, run.states) for feature in narrow]
    feature, greatest = max(zip(narrow, narrowness, strict=True), key=itemgetter(1))
    g = function_program(system, feature.argument).along(values)(run.states, run.t)[0]
    passed = np.flatnonzero(g[:-1] * g[1:] <= 0)
    i = int(passed[0] if len(passed) else np.argmin(np.abs(g[:-1])))
    words = (
        f"{feature.term} changes within {scientific(1 / max(greatest, MOST), 1)} of the swing, first between t = "
        f"{run.t[i]:.6g} and {run.t[i + 1]:.6g} s: a step or a wall so steep is followed exactly as an Event or an Impact"
    )
    return words if run.horizon >= run.t[i] else ""


def _narrowness(system: Equations, values: Mapping[Any, Any], feature: NarrowPart, states: Array) -> float:
    """Return the largest change of ψ when one component of the state moves through its whole range at the fastest rate of ψ.
    Return 0 if ψ = log|D| and D reaches zero."""
    every, g = system.variables, feature.argument
    moving = [i for i, s in enumerate(every) if s in g.free_symbols and np.ptp(states[:, i]) > 0]
    if not moving:
        return 0.0
    slopes = [derivative(g, every[i]) for i in moving]
    bends = [derivative(e, every[i]) for e, i in zip(slopes, moving, strict=True)]
    outputs = function_program(system, g, feature.factor, *slopes, *bends).along(values)
    logarithmic = feature.factor == 1 / g
    start = states[:: max(1, len(states) // _PLACES)]
    times = start[:, len(every)] if states.shape[1] > len(every) else np.zeros(len(start))
    swing, k, greatest, size = np.ptp(states[:, moving], axis=0)[:, None], len(moving), 0.0, 0.0
    with np.errstate(all="ignore"):
        for turning in (True, False):
            places = start[:, : len(every)].copy()
            for sweep in range(_SWEEPS * k):
                value, factor, first, second = np.split(outputs(places, times), [1, 2, 2 + k])
                sizes = np.abs(value[np.isfinite(value)])
                size = size or float(sizes.max(initial=0.0))
                if logarithmic and sizes.min(initial=size) <= _ZERO * size:
                    return 0.0
                rate, bend = np.abs(factor * first), np.abs(factor * second - value * factor**3 * first**2)
                greatest = max(greatest, float(np.nanmax(swing * np.maximum(rate, bend**0.5), initial=0.0)))
                j = sweep % k
                step = first[j] / second[j] if turning else value[0] / first[j]
                places[:, moving[j]] -= np.where(np.isfinite(step), step, 0.0)
    return greatest
