"""Whether two formulations agree: `System.same_as`, and the same steps with sympy's simplify in place of the decision.

The Lagrangians are compared; where these differ, as they may by a total time derivative, the equations of motion; where
these differ, as they may by a factor, the accelerations. simplify is a tool here that is measured; nothing rests on its answer.
"""

import time
from collections.abc import Callable, Iterable
from typing import Any

import sympy as sp

from benchmarks.mechanisms.chains import I1, I3, chain, g, l, m
from benchmarks.mechanisms.tool import in_own_process
from lagrotor.benchmark.records import Decided
from lagrotor.errors import LagrotorError
from lagrotor.mechanics import Frame, System, constrained_accelerations, coordinates

LONGEST = 20.0  # s of processor time, given to simplify


def _absolute(n: int) -> System:
    """n rods in the angles to the vertical, written in the relative ones."""
    c = coordinates([f"theta_{i}" for i in range(n)])
    L, x, z = sp.S.Zero, sp.S.Zero, sp.S.Zero
    for q, v in zip(c.q, c.v, strict=True):
        x, z = x - l * sp.cos(q) * v, z + l * sp.sin(q) * v
        L += m * (x**2 + z**2) / 2
    L += sum(m * g * l * (n - i) * sp.cos(q) for i, q in enumerate(c.q))
    relative = chain("rods", n).c
    return System(c, L).in_coordinates(relative, {q: sum(relative.q[: i + 1]) for i, q in enumerate(c.q)})


def _heavier(n: int) -> System:
    """n rods, the last point a half heavier."""
    rods = chain("rods", n)
    q, v = rods.c.q, rods.c.v
    angles = [(sum(q[: i + 1]), sum(v[: i + 1])) for i in range(n)]
    x, z = (sum(l * f(angle) * rate for angle, rate in angles) for f in (sp.cos, sp.sin))
    return System(rods.c, rods.L + m / 4 * (x**2 + z**2) + m / 2 * g * l * sum(sp.cos(angle) for angle, _ in angles))


def _top(factor: sp.Expr) -> tuple[System, System]:
    """A heavy top from a body, and the Lagrangian of the textbooks with a factor at its gravity."""
    c = coordinates("phi theta psi")
    (_, theta, _), (phi_v, theta_v, psi_v) = c.q, c.v
    body = Frame(c).turned("zxz", c.q).body(m, (I1, I1, I3), (0, 0, l))
    L = (I1 + m * l**2) * (theta_v**2 + phi_v**2 * sp.sin(theta) ** 2) / 2
    L += I3 * (psi_v + phi_v * sp.cos(theta)) ** 2 / 2 - factor * m * g * l * sp.cos(theta)
    return System(c, body.kinetic - body.potential((0, 0, -g))), System(c, L)


PAIRS: dict[str, Callable[[], tuple[System, System]]] = {
    "double pendulum, relative and absolute angles": lambda: (chain("rods", 2), _absolute(2)),
    "triple pendulum, relative and absolute angles": lambda: (chain("rods", 3), _absolute(3)),
    "four rods, relative and absolute angles": lambda: (chain("rods", 4), _absolute(4)),
    "heavy top, from a body and the textbook's": lambda: _top(sp.S.One),
    "heavy top, another weight": lambda: _top(sp.Integer(2)),
    "double pendulum, another mass at its end": lambda: (chain("rods", 2), _heavier(2)),
    "triple pendulum, another mass at its end": lambda: (chain("rods", 3), _heavier(3)),
}

EXPECTED = {name: "nonzero" if "another" in name else "zero" for name in PAIRS}


def decide_pairs() -> list[Decided]:
    """Each pair by both."""
    decisions = []
    for name, make in PAIRS.items():
        left, right = make()
        assert left.motion.shape == right.motion.shape  # made before the clock starts
        before = time.process_time()
        answer = left.same_as(right).answer
        ours = time.process_time() - before
        theirs, their_answer = _by_simplify(name)
        if answer != EXPECTED[name] or their_answer not in (answer, "did not end"):
            raise LagrotorError(f"{name}: same_as says {answer}, simplify {their_answer}, right is {EXPECTED[name]}")
        decisions.append(Decided(name, ours, answer, theirs, their_answer))
    return decisions


def _by_simplify(name: str) -> tuple[float, str]:
    result = in_own_process(_simplify, LONGEST, name)
    return (LONGEST, "did not end") if isinstance(result, str) else result


def _simplify(send: Callable[[tuple[float, str]], None], spend: Callable[[], Any], name: str) -> None:
    left, right = PAIRS[name]()
    motions = left.motion, right.motion
    spend()
    before = time.process_time()
    agree = _vanishes([left.L - right.L]) or _vanishes(motions[0] - motions[1])
    if not agree:
        first, second = (constrained_accelerations(system)[0] for system in (left, right))
        agree = _vanishes(first - second)
    send((time.process_time() - before, "zero" if agree else "nonzero"))


def _vanishes(difference: Iterable[sp.Expr]) -> bool:
    return all(sp.simplify(e) == 0 for e in difference)
