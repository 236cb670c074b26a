"""The proved paired precession of one amplitude.

The spins are opposite. At Phi = 0 the axes are parallel and cross the x-z plane: chi = alpha = 0, U' = 0, U = artanh r_0.
The motion is reversible under A = diag(1, −1, −1, −1, 1, 1) in (U, chi, alpha, rates). For opposite spins it is also
reversible under B = diag(−1, 1, −1, 1, −1, 1). An orbit from the fixed set of A to the fixed set of B is a quarter of a
period (lagrotor.models.orbits.floquet). Energy and the momentum about the joint line leave one pair of multipliers.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from lagrotor.errors import DomainError, InputError
from lagrotor.models.orbits.shooting import QuarterPeriod
from lagrotor.pair.scene import Scene
from lagrotor.proofs.balls import Ball, Balls, arb, exact, format_ball, precision, rational
from lagrotor.proofs.fields import Field, ball, scene_field
from lagrotor.proofs.orbits.closed_orbits import Kind, OrbitProblem, PeriodicOrbit, orbit_of, prove_orbit
from lagrotor.proofs.orbits.enclosure import accuracy_of
from lagrotor.proofs.statements import Certificate, Proved
from lagrotor.proofs.tape import with_pace
from lagrotor.proofs.taylor_step import Motion

A, B = (1, -1, -1, -1, 1, 1), (-1, 1, -1, 1, -1, 1)
FREE, CONDITIONS = (4, 5, 6), (0, 2, 4)
TOL = 1e-20
_ONES = 4  # multipliers equal to 1, by the energy and the momentum about the joint line


@dataclass(frozen=True, eq=False, repr=False)
class Precession(Proved):
    """A proved paired precession of amplitude r0.

    Attributes
    ----------
    scene : Scene
        The pair with opposite spins.
    r0 : Ball
        The amplitude: the sine of the inclination when the axes are parallel.
    amplitude : Fraction
        The amplitude as an exact rational number.
    orbit : PeriodicOrbit
        The periodic orbit, with the proof.
    """

    scene: Scene
    r0: Ball
    amplitude: Fraction
    orbit: PeriodicOrbit

    @property
    def frequency(self) -> Ball:
        """The angular frequency in rad/s, with the sign of spin 1."""
        frequency = self.orbit.frequency
        return frequency if self.scene.spins[0] > 0 else frequency.neg(exact=True)

    @property
    def period(self) -> Ball:
        """The period in s."""
        return self.orbit.period

    @property
    def pair_sum(self) -> Ball | None:
        """The sum μ + 1/μ of the slow pair of Floquet multipliers (mean x and mean twist); None if it is not enclosed."""
        return self.orbit.pair_sum

    @property
    def kind(self) -> Kind:
        """The stability: 'elliptic', 'hyperbolic', or 'undecided' without a proof."""
        return self.orbit.kind

    @cached_property
    def certificate(self) -> Certificate:
        """The plain data that `check` verifies."""
        whole = self.orbit.certificate
        return whole | {"claim": whole["claim"] | {"r0": [str(self.amplitude)] * 2}}

    def summary(self) -> dict[str, str]:
        """Return amplitude, frequency, period, stability and multipliers.

        Returns
        -------
        dict[str, str]
            Name → text.
        """
        return {
            "amplitude": format_ball(self.r0, 15),
            "frequency [rad/s]": format_ball(self.frequency),
            "period [s]": format_ball(self.period),
            "kind": self.kind,
            "μ + 1/μ": "undecided" if self.pair_sum is None else format_ball(self.pair_sum, 20),
        }


def precession(scene: Scene, r0: Any, tol: float = TOL) -> Precession:
    """Prove that the paired precession of amplitude r0 exists.

    Parameters
    ----------
    scene : Scene
        A pair with opposite spins and a bar.
    r0 : number
        The sine of the inclination when the axes are parallel, 0 < r0 < 1. A decimal denotes the exact rational number.
    tol : float, default 1e-20
        Local error of a step, relative to the size of the state.

    Returns
    -------
    Precession
        The enclosed period, and the stability.

    Raises
    ------
    InputError
        If the spins are not opposite, or r0 is an interval.
    DomainError
        If r0 is not between 0 and 1.
    NotProved
        If no orbit can be proved. The message says how far the proof came.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> precession(Scene((10, -10)), "0.2", tol=1e-12).frequency
    [7.921273224 +/- 2.01e-10]
    """
    accuracy = accuracy_of(tol, "precession")
    if isinstance(r0, tuple | list):
        what = "must be one number; the precessions of an interval are not proved at once"
        raise InputError(f"precession: r0 = {r0!r} {what}")
    with precision(accuracy.bits, accuracy.terms):
        amplitude = ball(r0, "precession: r0")
        if not 0 < amplitude < 1:
            raise DomainError(f"precession: r0 = {r0!r} must lie above 0 and below 1")
        curve = QuarterPeriod(scene)
        field = scene_field(curve.scene)
        start = guess(curve, float(exact(amplitude)), amplitude.atanh())
        orbit = orbit_of(prove_orbit(problem_of_pair(field), start, accuracy, _ONES, "precession"), field)
        return Precession(scene, amplitude, exactly(r0), orbit)


def exactly(r0: Any) -> Fraction:
    """Return the rational number that r0 denotes; for a ball or an expression, the midpoint.

    Examples
    --------
    >>> exactly(0.2)
    Fraction(1, 5)
    """
    middle = exact(ball(r0, "precession: r0")) if isinstance(r0, arb) or not getattr(r0, "is_Number", True) else None
    if middle is None:
        return rational(r0, "precession: r0")
    above, power = middle.man_exp()
    return int(above) * Fraction(2) ** int(power)


def problem_of_pair(field: Field) -> OrbitProblem:
    """Return the boundary-value problem of the pair's orbit over a quarter of a period, which takes one unit of s."""
    motion = Motion(with_pace(field.motion.tape, len(field.states)), field.motion.parameters)
    return OrbitProblem(motion, FREE, CONDITIONS, A, B)


def guess(curve: QuarterPeriod, r0: float, u: Ball) -> Balls:
    """Return an approximate initial state and quarter period of amplitude r0, as balls; the ball u for U is exact."""
    z = curve.follow(None, r0)
    state, pace = curve.state(z), float(z[3]) / abs(curve.natural)
    return [u, *(arb(float(x)) for x in state[1:]), arb(pace)]
