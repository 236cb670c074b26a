"""The paired precession of one amplitude, proved.

Opposite spins. At Phi = 0 the axes are parallel in the x-z plane and turn through it (chi = alpha = 0, U' = 0, U = artanh r_0);
time reversed under A = diag(1, −1, −1, −1, 1, 1) in (U, chi, alpha, rates) is a motion, and so it is under
B = diag(−1, 1, −1, 1, −1, 1) where the spins are opposite. An orbit from the fixed set of A to that of B is a quarter of a
period (lagrotor.models.orbits.floquet). Energy and the momentum about the joint line leave one pair of multipliers.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from lagrotor.errors import DomainError, InputError
from lagrotor.models.orbits.shooting import QuarterPeriod
from lagrotor.pair.scene import Scene
from lagrotor.proofs.balls import Ball, Balls, arb, exact, precision, printed, rational
from lagrotor.proofs.fields import Field, ball, scene_field
from lagrotor.proofs.orbits.closed_orbits import Kind, OrbitProblem, PeriodicOrbit, orbit_of, prove_orbit
from lagrotor.proofs.orbits.enclosure import accuracy_of
from lagrotor.proofs.statements import Certificate, Proved
from lagrotor.proofs.tape import paced
from lagrotor.proofs.taylor_step import Motion

A, B = (1, -1, -1, -1, 1, 1), (-1, 1, -1, 1, -1, 1)
FREE, CONDITIONS = (4, 5, 6), (0, 2, 4)
TOL = 1e-20
_ONES = 4  # of the energy and of the momentum about the joint line


@dataclass(frozen=True, eq=False, repr=False)
class Precession(Proved):
    """The paired precession of amplitude r0.

    frequency: angular, rad/s, of rotor 1's sign; period, s; kind: elliptic, hyperbolic, or undecided where none is shown;
    pair_sum: μ + 1/μ of the slow motion of the mean x and the mean twist.
    """

    scene: Scene
    r0: Ball
    amplitude: Fraction
    orbit: PeriodicOrbit

    @property
    def frequency(self) -> Ball:
        """The angular frequency, rad/s."""
        frequency = self.orbit.frequency
        return frequency if self.scene.spins[0] > 0 else frequency.neg(exact=True)

    @property
    def period(self) -> Ball:
        """The period, s."""
        return self.orbit.period

    @property
    def pair_sum(self) -> Ball | None:
        """The sum μ + 1/μ of the multipliers of the slow motion."""
        return self.orbit.pair_sum

    @property
    def kind(self) -> Kind:
        """The stability."""
        return self.orbit.kind

    @cached_property
    def certificate(self) -> Certificate:
        """Plain data that `check` verifies."""
        whole = self.orbit.certificate
        return whole | {"claim": whole["claim"] | {"r0": [str(self.amplitude)] * 2}}

    def summary(self) -> dict[str, str]:
        """Return what is proved, name → words."""
        return {
            "amplitude": printed(self.r0, 15),
            "frequency [rad/s]": printed(self.frequency),
            "period [s]": printed(self.period),
            "kind": self.kind,
            "μ + 1/μ": "undecided" if self.pair_sum is None else printed(self.pair_sum, 20),
        }


def precession(scene: Scene, r0: Any, tol: float = TOL) -> Precession:
    """Prove that the paired precession of amplitude r0 = sin(theta) exists, theta the inclination when the axes are parallel.

    Parameters
    ----------
    scene : Scene
        With opposite spins and a bar.
    r0
        One number, exact as the decimal that it is written in.
    tol : float, default TOL
        What a step may leave out.

    Raises
    ------
    InputError
        Unless the spins are opposite and r0 is one number.
    DomainError
        Unless 0 < r0 < 1.
    NotProved
        With how far the proof came.
    """
    accuracy = accuracy_of(tol, "precession")
    if isinstance(r0, tuple | list):
        raise InputError(
            f"precession: r0 = {r0!r} must be one number; the precessions of an interval are not proved at once"
        )
    with precision(accuracy.bits, accuracy.terms):
        amplitude = ball(r0, "precession: r0")
        if not 0 < amplitude < 1:
            raise DomainError(f"precession: r0 = {r0!r} must lie above 0 and below 1")
        curve = QuarterPeriod(scene)
        made = scene_field(curve.scene)
        start = guess(curve, float(exact(amplitude)), amplitude.atanh())
        orbit = orbit_of(prove_orbit(problem_of_pair(made), start, accuracy, _ONES, "precession"), made)
        return Precession(scene, amplitude, exactly(r0), orbit)


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
