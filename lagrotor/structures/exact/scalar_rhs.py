"""The right-hand side of few rotors in single numbers: so few operations cost less than calling arrays does."""

from collections.abc import Callable

import numpy as np

from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.generated import function_of
from lagrotor.numerics.printers import rhs_text
from lagrotor.numerics.recorded_numbers import Recorded
from lagrotor.numerics.segment import RightHandSide
from lagrotor.structures.coefficients import Coefficients
from lagrotor.structures.exact.exact_motion import Drive, ExactMotion
from lagrotor.structures.exact.written_out import structure_accelerations

# Axes and bars beyond which arrays cost less: with massless bars, where each axis is eliminated by itself, and with heavy ones.
_MOST, HEAVY = 40, 15


def right_hand_side(motion: ExactMotion) -> RightHandSide:
    """The right-hand side (s, y) → y' of an exact motion, that of `motion.rhs`: for few rotors in single numbers."""
    c = motion.c
    if len(c.R) + len(c.i) > (HEAVY if c.coupling.any() else _MOST):
        return motion.rhs
    make = function_of(_source(c, motion.force is not None, motion.ground is not None))
    rhs: RightHandSide = make(*(_listed(drive) for drive in (motion.force, motion.ground)))
    return rhs


def _listed(drive: Drive | None) -> Callable[[float], list[float]]:
    return lambda t: np.asarray(drive(t) if drive else (), dtype=float).ravel().tolist()


def _source(c: Coefficients, forced: bool, shaken: bool) -> str:
    """Source of (force, ground) → rhs(s, y); forced, shaken: whether there is a force on the tips, a motion of the ground."""
    N, rate, tape = len(c.R), c.rate, list[Recorded]()
    states, pushes, shakes = ([f"{x}{k}" for k in range(n)] for x, n in (("y", 6 * N), ("p", 3 * N), ("g", 3)))
    y, p, g = ([Recorded(tape, name) for name in names] for names in (states, pushes, shakes))
    r = [y[3 * i : 3 * i + 3] for i in range(N)]
    v = [[rate * x for x in y[3 * i : 3 * i + 3]] for i in range(N, 2 * N)]
    G = [Recorded(tape, f"({G}*exp({-k / rate}*s))") if k else G for G, k in zip(c.G, c.decay, strict=True)]
    more = [
        [(c.R[i] * p[3 * i + k] if forced else 0.0) - (c.S[i] * g[k] if shaken else 0.0) for k in range(3)]
        for i in range(N)
    ]
    found = structure_accelerations(c, r, v, G, recorded_numbers, more=more if forced or shaken else ())
    lines, rates = recorded_numbers.lines((x / rate**2 for axis in found for x in axis), tape)
    body = [f"{', '.join(states)} = y.tolist()"]
    body += [f"{', '.join(pushes)} = force(s/{rate})"] if forced else []
    body += [f"{', '.join(shakes)} = ground(s/{rate})"] if shaken else []
    body += [*lines, f"return [{', '.join([*states[3 * N :], *rates])}]"]
    return rhs_text(body, [], ["force", "ground"], 6 * N)
