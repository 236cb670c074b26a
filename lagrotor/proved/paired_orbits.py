"""The paired precession proved: of one amplitude, or of every amplitude in an interval.

Opposite spins. At Phi = 0 the axes are parallel in the x-z plane and turn through it (chi = alpha = 0, U' = 0, U = artanh r_0);
time reversed under A = diag(1, −1, −1, −1, 1, 1) in (U, chi, alpha, rates) is a motion, and so it is under
B = diag(−1, 1, −1, 1, −1, 1) where the spins are opposite. An orbit from the fixed set of A to that of B is a quarter of a
period (lagrotor.models.orbits.floquet). Energy and the momentum about the joint line leave one pair of multipliers.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from lagrotor.errors import DomainError, NotProved
from lagrotor.models.orbits.shooting import QuarterPeriod
from lagrotor.pair.scene import Scene
from lagrotor.proved.balls import Ball, Balls, arb, ball, exact, precision, printed, radius, rational, upper
from lagrotor.proved.carried_sets import Accuracy, Start, entries_of, identity, steps_of
from lagrotor.proved.certificates import VERSION, Certificate
from lagrotor.proved.closed_orbits import (
    OrbitProblem,
    OrbitProof,
    PeriodicOrbit,
    closing,
    orbit_of,
    prove_orbit,
    refined,
)
from lagrotor.proved.enclosure import accuracy_of
from lagrotor.proved.fields import Field, scene_field
from lagrotor.proved.krawczyk import krawczyk
from lagrotor.proved.multipliers import Kind
from lagrotor.proved.statements import theorem_of
from lagrotor.proved.stepping import Motion
from lagrotor.proved.tape import paced
from lagrotor.shown import Shown

A, B = (1, -1, -1, -1, 1, 1), (-1, 1, -1, 1, -1, 1)
FREE, CONDITIONS, HELD = (4, 5, 6), (0, 2, 4), 0
TOL, TOL_OF_FAMILY = 1e-20, 1e-9
_NARROWEST = 1e-5  # of a family's piece
_ONES = 4  # of the energy and of the momentum about the joint line


@dataclass(frozen=True, eq=False, repr=False)
class Precession(Shown):
    """The paired precession of amplitude r0, or of every amplitude in r0, one orbit each.

    frequency: angular, rad/s, of rotor 1's sign; period, s: balls that hold those of every r0. kind: elliptic or hyperbolic
    where it is for all of them. pieces: r0 and orbit, one for a number, adjoining intervals for an interval.
    """

    scene: Scene
    r0: Ball
    ends: tuple[Fraction, Fraction]
    pieces: tuple[tuple[Ball, PeriodicOrbit], ...]

    @property
    def frequency(self) -> Ball:
        """rad/s."""
        found = hull([orbit.frequency for _, orbit in self.pieces])
        return found if self.scene.spins[0] > 0 else found.neg(exact=True)

    @property
    def period(self) -> Ball:
        """s."""
        return hull([orbit.period for _, orbit in self.pieces])

    @property
    def pair_sum(self) -> Ball | None:
        """μ + 1/μ of the slow motion of the mean x and the mean twist; None where it is not known for all."""
        sums = [orbit.pair_sum for _, orbit in self.pieces]
        return None if None in sums else hull(sums)

    @property
    def kind(self) -> Kind:
        """elliptic, hyperbolic, or undecided where it is not the same, or not shown, for all."""
        kinds = {orbit.kind for _, orbit in self.pieces}
        return kinds.pop() if len(kinds) == 1 else "undecided"

    @property
    def theorem(self) -> str:
        """In words."""
        return theorem_of(self.certificate)

    @cached_property
    def certificate(self) -> Certificate:
        """Plain data that `check` verifies."""
        bar = self.scene.summary()["bar"]
        who = f"The pair of spins {self.scene.spins[0]:g}, {self.scene.spins[1]:g} rad/s with a bar of {bar}"
        ends = [str(end) for end in self.ends]
        parts = [orbit.certificate for _, orbit in self.pieces]
        if len(parts) == 1:
            return parts[0] | {"who": who, "claim": parts[0]["claim"] | {"r0": ends}}
        return {"version": VERSION, "kind": "family", "who": who, "claim": {"r0": ends}, "pieces": parts}

    def summary(self) -> dict[str, str]:
        """What is proved, name → words."""
        return {
            "amplitude": printed(self.r0, 15) if len(self.pieces) == 1 else interval(self.r0),
            "frequency [rad/s]": printed(self.frequency),
            "period [s]": printed(self.period),
            "kind": self.kind,
            "μ + 1/μ": "undecided" if self.pair_sum is None else printed(self.pair_sum, 20),
            "pieces": str(len(self.pieces)),
        }


def hull(values: list[Any]) -> Ball:
    """A ball that holds all."""
    found = values[0]
    with precision(200):
        for value in values[1:]:
            found = found.union(value)
    return found


def interval(x: Ball) -> str:
    """Its ends to six digits."""
    return f"[{float(x.lower()):.6g}, {float(x.upper()):.6g}]"


def precession(scene: Scene, r0: Any, tol: float | None = None) -> Precession:
    """The paired precession of amplitude r0 = sin(theta), theta the inclination when the axes are parallel, proved to exist.

    r0: a number, exact as the decimal that it is written in, or a pair (lowest, highest): then for every amplitude between
    them one orbit is proved, alone near a smooth curve. tol: what a step may leave out.

    Raises InputError unless the spins are opposite, DomainError unless 0 < r0 < 1, NotProved with how far the proof came.
    """
    one = not isinstance(r0, tuple | list)
    accuracy = accuracy_of(tol or (TOL if one else TOL_OF_FAMILY), "precession")
    with precision(accuracy.bits, accuracy.terms):
        amplitude = ball(r0, "precession: r0")
        if not (0 < amplitude < 1):
            raise DomainError(f"precession: r0 = {r0!r} must lie between 0 and 1")
        curve = QuarterPeriod(scene)
        made = scene_field(curve.scene)
        problem = problem_of_pair(made)
        if one:
            start = guess(curve, float(exact(amplitude)), amplitude.atanh())
            orbit = orbit_of(prove_orbit(problem, start, accuracy, _ONES, "precession"), names(made))
            return Precession(scene, amplitude, (exactly(r0), exactly(r0)), ((amplitude, orbit),))
        pieces = tuple(family(problem, curve, ball(r0[0]), ball(r0[1]), accuracy, names(made)))
        return Precession(scene, amplitude, (exactly(r0[0]), exactly(r0[1])), pieces)


def exactly(r0: Any) -> Fraction:
    """The rational number that is meant; of a ball or an expression the middle."""
    middle = exact(ball(r0, "precession: r0")) if isinstance(r0, arb) or not getattr(r0, "is_Number", True) else None
    if middle is None:
        return rational(r0, "precession: r0")
    above, power = middle.man_exp()
    return int(above) * Fraction(2) ** int(power)


def names(made: Field) -> tuple[str, ...]:
    """The states."""
    return tuple(map(str, made.states))


def problem_of_pair(made: Field) -> OrbitProblem:
    """A quarter of a period in one unit of s."""
    motion = Motion(paced(made.motion.tape, len(made.states)), made.motion.parameters)
    return OrbitProblem(motion, FREE, CONDITIONS, A, B)


def guess(curve: QuarterPeriod, r0: float, u: Ball) -> Balls:
    """The start and the quarter period of amplitude r0, in floats but for U."""
    z = curve.follow(None, r0)
    state, pace = curve.state(z), float(z[3]) / abs(curve.natural)
    return [u, *(arb(float(x)) for x in state[1:]), arb(pace)]


def family(
    problem: OrbitProblem, curve: QuarterPeriod, low: Ball, high: Ball, accuracy: Accuracy, states: tuple[str, ...]
) -> Iterator[tuple[Ball, PeriodicOrbit]]:
    """Adjoining pieces of the family from r0 = low to high, each as wide as its proof allows.

    Within a piece the orbit lies near its tangent: z(U) = z̄ + z' (U − Ū) + w, and one w is proved for every U of the piece.
    Adjoining pieces share an end, where each holds the one orbit, so that they are one curve.
    """
    last, u, width = high.atanh(), low.atanh(), 1e-3
    end = exact(last) + radius(last)
    while u < end:
        tries = 0
        while True:
            right = exact(u + min(width, float((end - u).upper())))
            piece = u.union(right)
            proof = proof_of_piece(problem, curve, piece, accuracy)
            if proof is not None:
                break
            tries, width = tries + 1, 0.7 * width
            if width < _NARROWEST:
                raise NotProved(f"precession: the family is proved up to r0 = {np.tanh(float(u.lower())):.8g} only")
        yield piece.tanh(), orbit_of(proof, states)
        u, width = right, width if tries else 1.1 * width


def proof_of_piece(problem: OrbitProblem, curve: QuarterPeriod, piece: Ball, accuracy: Accuracy) -> OrbitProof | None:
    """One orbit for every U of a piece; None where the test does not close."""
    u = exact(piece)
    half = radius(piece)
    try:
        middle, inverse, _ = refined(problem, guess(curve, float(np.tanh(float(u))), u), accuracy, "precession")
        L = tangent_frame(problem, middle, accuracy)
        spread = [arb(0)] * len(middle)
        spread[HELD] = arb(0, half.upper())
        for i in FREE:
            spread[i] = arb(0, (half * half * (1 + abs(middle[i])) + arb(2) ** -40).upper())
        for _ in range(4):
            start = Start(middle, spread, L)
            steps = tuple(steps_of(problem.motion, start, arb(1), accuracy))
            proof = closing(problem, start, inverse, steps, _ONES, accuracy.bits, HELD)
            if proof is not None:
                return proof
            last = steps[-1].end
            needed = moved(problem, start, inverse, last)
            for i, x in zip(FREE, needed, strict=True):
                if not upper(x) < 1:
                    return None
                spread[i] = arb(0, (1.5 * upper(x)).upper())
    except (NotProved, DomainError):
        return None
    return None


def moved(problem: OrbitProblem, start: Start, inverse: Any, last: Any) -> Balls:
    """K about the middle, whether or not it closes."""
    w = [start.spread[i] for i in problem.free]
    slope, by = (problem.slope(last.derivative, columns) for columns in (problem.free, [HELD]))
    return krawczyk(problem.value(start.middle, last.middle), slope, inverse, w, by, [start.spread[HELD]])


def tangent_frame(problem: OrbitProblem, middle: Balls, accuracy: Accuracy) -> Any:
    """The unit matrix, its column of U along the family."""
    *_, step = steps_of(problem.motion, Start(middle, [arb(0)] * len(middle)), arb(1), accuracy)
    D = step.end.derivative
    slope, by = problem.slope(D, problem.free), problem.slope(D, [HELD])
    along = entries_of(slope.inv() * by)
    L = identity(len(middle))
    for i, x in zip(problem.free, along, strict=True):
        L[i, HELD] = exact(-x)
    return L
