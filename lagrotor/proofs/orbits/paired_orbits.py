"""The paired precession proved: of one amplitude, or of every amplitude in an interval.

Opposite spins. At Phi = 0 the axes are parallel in the x-z plane and turn through it (chi = alpha = 0, U' = 0, U = artanh r_0);
time reversed under A = diag(1, −1, −1, −1, 1, 1) in (U, chi, alpha, rates) is a motion, and so it is under
B = diag(−1, 1, −1, 1, −1, 1) where the spins are opposite. An orbit from the fixed set of A to that of B is a quarter of a
period (lagrotor.models.orbits.floquet). Energy and the momentum about the joint line leave one pair of multipliers.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, reduce
from typing import Any

import numpy as np

from lagrotor.errors import DomainError, NotProved
from lagrotor.models.orbits.shooting import FAILURES, QuarterPeriod
from lagrotor.pair.scene import Scene
from lagrotor.proofs.balls import (
    Ball,
    Balls,
    arb,
    arb_poly,
    ball_data,
    exact,
    exact_data,
    precision,
    printed,
    rational,
)
from lagrotor.proofs.carried_sets import Accuracy
from lagrotor.proofs.fields import Field, ball, of_scene, scene_field
from lagrotor.proofs.orbits.closed_orbits import Kind, OrbitProblem, PeriodicOrbit, orbit_of, prove_orbit
from lagrotor.proofs.orbits.enclosure import accuracy_of, loosened
from lagrotor.proofs.orbits.families import FamilyProof, prove_family
from lagrotor.proofs.statements import VERSION, Certificate, Proved
from lagrotor.proofs.stepping import Motion
from lagrotor.proofs.tape import paced

A, B = (1, -1, -1, -1, 1, 1), (-1, 1, -1, 1, -1, 1)
FREE, CONDITIONS = (4, 5, 6), (0, 2, 4)
TOL, TOL_OF_FAMILY = 1e-20, 1e-12
_FIRST_WIDTH, _NARROWEST = 0.1, 1e-3  # of a family's piece, in U
_ONES = 4  # of the energy and of the momentum about the joint line


@dataclass(frozen=True, eq=False)
class FamilyPiece:
    """The orbits of every U = middle + half ε, |ε| ≤ 1, one smooth curve."""

    middle: Ball
    half: Ball
    proof: FamilyProof

    @property
    def ends(self) -> tuple[Ball, Ball]:
        """Of U."""
        return self.middle - self.half, self.middle + self.half

    def start(self, U: Ball) -> Balls:
        """The states at Phi = 0 and the quarter period, s, of the U of a ball, which its piece must hold."""
        off = dict(zip(self.proof.problem.free, self.proof.w, strict=True))
        return self._about(U, [off.get(i, arb(0)) for i in range(len(self.proof.x))])

    def _about(self, U: Ball, off: Sequence[Ball]) -> Balls:
        eps = (U - self.middle) / self.half
        *states, pace = (poly(eps) + w for poly, w in zip(self.proof.x, off, strict=True))
        return [*states, pace]

    @property
    def period(self) -> Ball:
        """s, of all orbits."""
        return 4 * self.start(self.middle + arb(0, self.half.upper()))[-1]

    def box(self, U: Ball) -> Balls:
        """Where the start and the quarter period of the orbit of U are alone."""
        return self._about(U, [arb(0, W.upper()) for W in self.proof.W])

    def joins(self, after: "FamilyPiece") -> bool:
        """Whether the orbit at this piece's end is that of the next piece: one of them lies where the other is alone."""
        U = self.ends[1]
        return any(
            all(one.box(U)[i].contains_interior(other.start(U)[i]) for i in FREE)
            for one, other in ((self, after), (after, self))
        )


@dataclass(frozen=True, eq=False, repr=False)
class Precession(Proved):
    """The paired precession of amplitude r0, or of every amplitude in r0, one orbit each.

    frequency: angular, rad/s, of rotor 1's sign; period, s: balls that hold those of every r0. pieces: the orbit of a number, or
    the parts of a family, each beginning where the one before ends.
    """

    scene: Scene
    r0: Ball
    ends: tuple[Fraction, Fraction]
    pieces: tuple[PeriodicOrbit, ...] | tuple[FamilyPiece, ...]
    bits: int

    @property
    def frequency(self) -> Ball:
        """rad/s."""
        with precision(self.bits):
            return self._signed(self.period)

    def _signed(self, period: Ball) -> Ball:
        frequency = 2 * arb.pi() / period
        return frequency if self.scene.spins[0] > 0 else frequency.neg(exact=True)

    @property
    def period(self) -> Ball:
        """s."""
        with precision(self.bits):
            return hull([piece.period for piece in self.pieces])

    @property
    def pair_sum(self) -> Ball | None:
        """μ + 1/μ of the slow motion of the mean x and the mean twist, of one orbit."""
        first = self.pieces[0]
        return first.pair_sum if isinstance(first, PeriodicOrbit) else None

    @property
    def kind(self) -> Kind:
        """The stability of one orbit: elliptic, hyperbolic, or undecided where none is shown; undecided of a family."""
        first = self.pieces[0]
        return first.kind if isinstance(first, PeriodicOrbit) else "undecided"

    @cached_property
    def certificate(self) -> Certificate:
        """Plain data that `check` verifies."""
        ends = [str(end) for end in self.ends]
        first = self.pieces[0]
        if isinstance(first, PeriodicOrbit):
            return first.certificate | {"claim": first.certificate["claim"] | {"r0": ends}}
        with precision(self.bits):
            return {
                "version": VERSION,
                "kind": "family",
                "bits": self.bits,
                "about": of_scene(replace(self.scene, shock=None)),
                "motion": first.proof.problem.motion.data(),
                "reversals": [list(A), list(B)],
                "claim": {"r0": ends, "period": ball_data(loosened(self.period))},
                "pieces": [piece_data(piece) for piece in self.pieces if isinstance(piece, FamilyPiece)],
            }

    def summary(self) -> dict[str, str]:
        """What is proved, name → words."""
        return {
            "amplitude": interval(self.r0) if self.ends[0] < self.ends[1] else printed(self.r0, 15),
            "frequency [rad/s]": printed(self.frequency),
            "period [s]": printed(self.period),
            "kind": self.kind,
            "μ + 1/μ": "undecided" if self.pair_sum is None else printed(self.pair_sum, 20),
            "pieces": str(len(self.pieces)),
        }


def hull(values: list[Any]) -> Ball:
    """A ball that holds all."""
    with precision(200):
        return reduce(lambda a, b: a.union(b), values)


def interval(x: Ball) -> str:
    """Its ends to six digits."""
    return f"[{float(x.lower()):.6g}, {float(x.upper()):.6g}]"


def precession(scene: Scene, r0: Any, tol: float | None = None) -> Precession:
    """The paired precession of amplitude r0 = sin(theta), theta the inclination when the axes are parallel, proved to exist.

    Args:
        scene: with opposite spins and a bar.
        r0: a number, exact as the decimal that it is written in, or a pair (lowest, highest): then for every amplitude between
            them one orbit is proved, all of them one smooth curve; the stability is shown of one amplitude alone.
        tol: what a step may leave out.

    Raises:
        InputError: unless the spins are opposite.
        DomainError: unless 0 < r0 < 1.
        NotProved: with how far the proof came.
    """
    one = not isinstance(r0, tuple | list)
    accuracy = accuracy_of(tol or (TOL if one else TOL_OF_FAMILY), "precession")
    with precision(accuracy.bits, accuracy.terms):
        amplitude = ball(r0, "precession: r0")
        if not (0 < amplitude < 1 and (one or ball(r0[0]) < ball(r0[1]))):
            raise DomainError(f"precession: r0 = {r0!r} must lie above 0 and below 1, the lowest of a pair first")
        curve = QuarterPeriod(scene)
        made = scene_field(curve.scene)
        problem = problem_of_pair(made)
        if one:
            start = guess(curve, float(exact(amplitude)), amplitude.atanh())
            orbit = orbit_of(prove_orbit(problem, start, accuracy, _ONES, "precession"), made)
            return Precession(scene, amplitude, (exactly(r0), exactly(r0)), (orbit,), accuracy.bits)
        pieces = tuple(family(problem, curve, ball(r0[0]), ball(r0[1]), accuracy))
        return Precession(scene, amplitude, (exactly(r0[0]), exactly(r0[1])), pieces, accuracy.bits)


def exactly(r0: Any) -> Fraction:
    """The rational number that is meant; of a ball or an expression the middle."""
    middle = exact(ball(r0, "precession: r0")) if isinstance(r0, arb) or not getattr(r0, "is_Number", True) else None
    if middle is None:
        return rational(r0, "precession: r0")
    above, power = middle.man_exp()
    return int(above) * Fraction(2) ** int(power)


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
    problem: OrbitProblem, curve: QuarterPeriod, low: Ball, high: Ball, accuracy: Accuracy
) -> Iterator[FamilyPiece]:
    """Yield pieces of the family from r0 = low to high, each as wide as its proof allows."""
    u, last = np.nextafter(float(low.atanh().lower()), 0), np.nextafter(float(high.atanh().upper()), 1e9)
    width, before = _FIRST_WIDTH, None
    while u < last:
        right = min(u + width, last)
        try:
            piece = prove_piece(problem, curve, u, right, accuracy)
        except (NotProved, *FAILURES):
            width *= 0.6
            if width < _NARROWEST:
                raise NotProved(f"precession: the family is proved up to r0 = {np.tanh(u):.8g} only") from None
            continue
        if before is not None and not before.joins(piece):
            raise NotProved(f"precession: the family is one curve up to r0 = {np.tanh(u):.8g} only")
        yield piece
        u, before, width = right, piece, 1.2 * width


def prove_piece(problem: OrbitProblem, curve: QuarterPeriod, u: float, right: float, accuracy: Accuracy) -> FamilyPiece:
    """Prove the orbits between two U, about polynomials of ε that go through those of floats at Chebyshev's points."""
    degree = 3 * accuracy.terms // 4
    middle, half = (u + right) / 2, np.nextafter((right - u) / 2 * (1 + 1e-15), 1)
    points = -np.cos(np.pi * (np.arange(degree + 3) + 0.5) / (degree + 3))
    z, rows = None, []
    for x in points:
        z = curve.follow(z, np.tanh(middle + half * x))
        rows.append([*curve.state(z)[4:], z[3] / abs(curve.natural)])
    cheb = np.polynomial.chebyshev
    powers = [cheb.cheb2poly(cheb.chebfit(points, column, degree)) for column in np.array(rows).T]
    U, zero = arb_poly([arb(middle), arb(half)]), arb_poly([])
    x = [U, zero, zero, zero, *(arb_poly([arb(float(c)) for c in row]) for row in powers)]
    return FamilyPiece(arb(middle), arb(half), prove_family(problem, x, accuracy.terms, accuracy.tol))


def piece_data(piece: FamilyPiece) -> dict[str, Any]:
    """Of a certificate."""
    proof = piece.proof
    return {
        "middle": exact_data([piece.middle])[0],
        "half": exact_data([piece.half])[0],
        "x": [exact_data(poly.coeffs()) for poly in proof.x],
        "W": exact_data(proof.W),
        "terms": proof.n,
        "degree": max(poly.degree() for poly in proof.x),
        "steps": [{"h": exact_data([step.h])[0], "tube": exact_data(step.tube)} for step in proof.steps],
        "cuts": exact_data(proof.cuts),
    }
