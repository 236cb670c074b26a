"""The stability of the upright position, linearly and beyond, its reason in words, and the critical factor on the spins.

The theorems of `critical_spins` decide the linear motion. Spins that work against weight make precessions of negative energy.
Resonances of third and fourth order between them can make the position unstable: see `resonances`.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, IntegrationError, SingularError
from lagrotor.numerics.arrays import finite_array
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Complex, coefficients
from lagrotor.structures.critical_spins import critical_spin, friction_undoes, spin_threshold, stiffness_in_masses
from lagrotor.structures.exact.bar_closure import start_state
from lagrotor.structures.exact.compiled_motion import right_hand_side
from lagrotor.structures.exact.exact_motion import exact_motion
from lagrotor.structures.resonances import (
    MOST_DOF,
    Resonance,
    checked_push,
    fall_time_along,
    first_resonance,
    signed_rates,
    trusted_push,
)
from lagrotor.structures.small_motion import SmallMotion, check_rates, modes, small_motion
from lagrotor.structures.stability_time import hold_time
from lagrotor.structures.upright_hamiltonian import local_hamiltonian

PUSH = 0.01  # relative to the natural rate: the push of `kind` and `why`
_FARTHEST = 5  # times the trusted push: from there an axis tilts by ½ before it grows
_LEAST_TIMES = 20  # the length of the search for a fall
_BOUNDED = "every small motion stays bounded"


Kind = Literal["never", "to first order", "falls at a resonance", "falls over a barrier", "holds"]


@dataclass(frozen=True, eq=False, repr=False)
class Standing(Shown):
    """The stability of the upright position. The truth value is linear stability; `kind` describes the nonlinear motion.

    - `stands`: True if the upright position is linearly stable.
    - `growth`: the growth rate of the fastest growing motion, 1/s; 0 if no motion grows.
    - `shape`: the shape of the fastest growing motion, (N, 2); zeros if no motion grows.
    - `critical_spin`: the factor on all spins above which the position is linearly stable; inf if there is none.
    - `structure`: the structure.
    - `first_order`: the reason for the linear result in words.
    """

    stands: bool
    growth: float
    shape: Complex
    critical_spin: float
    structure: Assembly
    first_order: str

    def __bool__(self) -> bool:
        return self.stands

    @cached_property
    def kind(self) -> Kind:
        """The stability beyond the linear motion, for a push of `PUSH` (0.01) times the natural rate.

        - "never": linearly unstable; any push grows or drifts.
        - "falls at a resonance": linearly stable, but such a push in some direction topples it by a resonance: see
          `largest_push`.
        - "falls over a barrier": such a push topples it although no rates are resonant. Near the critical spins the barrier of
          the terms of order 3 and 4 is low.
        - "holds": the energy has a minimum, or no resonance through fourth order topples it from such a push.
        - "to first order": linearly stable, and no more is known: a motion has no restoring force, friction acts,
          there are more than 8 degrees of freedom, the rates are too far apart, or the push tilts it by more than 0.1.
        """
        linear = small_motion(self.structure)
        if not self.stands:
            return "never"
        if linear.dof and np.linalg.eigvalsh(stiffness_in_masses(linear))[0] > 1e-12:
            return "holds"
        rubs = linear.damping.any() or coefficients(self.structure).decay.any()
        if rubs or linear.dof > MOST_DOF or not len(signed_rates(linear)):
            return "to first order"
        try:
            resonance = self.resonance
        except (InputError, SingularError):  # two modes coincide, or rates are too far apart
            return "to first order"
        if resonance and resonance.push() < self._reference:
            return "falls at a resonance" if resonance.resonant else "falls over a barrier"
        return "to first order" if self._too_near else "holds"

    @cached_property
    def resonance(self) -> Resonance | None:
        """The resonance that needs the smallest push; None if there is none. Raises the InputErrors of `resonances`."""
        return first_resonance(self.structure)

    @cached_property
    def _too_near(self) -> bool:
        """True if the push of `kind` exceeds the range of the expansion, which is small near the critical spins."""
        return trusted_push(self.structure) < self._reference

    @property
    def _reference(self) -> float:
        return PUSH * local_hamiltonian(self.structure).rate

    @property
    def why(self) -> str:
        """The reason for `stands` and `kind` in words."""
        if self.kind == "falls at a resonance" and self.resonance:
            least = self.resonance.push()
            words = (
                f"{self.first_order}, but a resonance of order {self.resonance.order}, "
                f"{self.resonance.words()}, topples it from pushes above {least:.2g} rad/s"
            )
            if self._reference > _FARTHEST * trusted_push(self.structure):
                return f"{words}; {self._reference:.3g} rad/s tilts it too far for an estimate of the time"
            return (
                f"{words}; {self._reference:.3g} rad/s takes {self.resonance.least_time(self._reference):.3g} s or more by the "
                "normal form, with an error of a half: measured_fall runs the exact motion"
            )
        if self.kind == "falls over a barrier" and self.resonance:
            return (
                f"{self.first_order}, but a push of about {self.resonance.push():.2g} rad/s in some direction passes the barrier "
                f"of the terms of order {self.resonance.order} and topples it; no rates are resonant (the nearest: "
                f"{self.resonance.words()})"
            )
        if self.kind == "holds" and not self.first_order.startswith(_BOUNDED):
            return (
                f"{self.first_order}; no resonance through fourth order topples it from a push of {self._reference:.3g} rad/s; "
                "higher orders act later: not before `hold_time`"
            )
        if self.kind == "to first order" and self.__dict__.get("_too_near"):
            return (
                f"{self.first_order}; so near the critical spins a push of {self._reference:.3g} rad/s tilts it too far for the "
                "expansion"
            )
        return self.first_order

    def fall_time(self, push: float | ArrayLike) -> float:
        """Return the time (s) in which a push topples the structure, inf if it does not.

        If `push` is a number, the result is the shortest time of all pushes of this size (rad/s). If `push` gives the rates
        (N, 2) of the axes, the normal form of fourth order estimates the time for this push, with an error of a half or more.
        This search ends after 20 shortest times. Raises the InputErrors of `resonances`, and InputError if the push exceeds
        the range of the expansion. `measured_fall` measures the time on the exact motion.
        """
        directed = np.ndim(push) > 0
        if directed and np.shape(push) != (shape := (len(self.structure.joints), 2)):
            raise InputError(f"fall_time: push must be a number or rates {shape}, not of shape {np.shape(push)}")
        size = (
            float(np.linalg.norm(finite_array("fall_time: push", push)))
            if directed
            else checked_push("fall_time", push)
        )
        if not self.stands:
            return 0.0
        resonance, trusted = self.resonance, trusted_push(self.structure)
        if resonance and size <= resonance.push():
            resonance = None
        if size > (_FARTHEST if resonance else 1) * trusted:
            raise InputError(
                f"fall_time: a push of {size:.3g} rad/s tilts an axis too far for the expansion, which is trusted to "
                f"{trusted:.3g}: simulate it"
            )
        if not resonance:
            return inf
        least = resonance.least_time(size)
        if not directed:
            return least
        reach = max(abs(np.dot(k, resonance.rates)) for k in resonance.vectors)
        time = fall_time_along(self.structure, push, _LEAST_TIMES * least, 1.001 * reach)
        if time == inf and size > trusted:
            raise InputError(
                f"fall_time: this push of {size:.3g} rad/s does not topple it in {_LEAST_TIMES * least:.3g} s by the expansion, "
                f"which is trusted to {trusted:.3g}: simulate it"
            )
        return time

    def hold_time(self, push: float) -> float:
        """Estimate a time (s) within which no push of a given size (rad/s) grows by a factor sqrt(2) in the normal modes.

        It is inf for rotors without bars and braces, and if the energy has a minimum upright. It is 0 if the structure is
        linearly unstable or the push exceeds the range of the expansion. Raises InputError with friction, and for more than 8
        degrees of freedom.
        """
        return hold_time(self.structure, push)

    def summary(self) -> dict[str, str]:
        """Return the stability, the reason and the critical factor in words."""
        least = "none" if self.critical_spin == inf else f"{self.critical_spin:.6g}"
        return {
            "linearly stable": "yes" if self.stands else "no",
            "beyond": "never at these spins" if self.kind == "never" and self.critical_spin < inf else self.kind,
            "why": self.why,
            "critical factor on all spins": least,
        }


def stands(s: Assembly) -> Standing:
    """Decide if the upright position is stable: see `Structure.stands`."""
    linear, normal, factor = check_rates(s, "stands"), modes(s), critical_spin(s)
    K = np.linalg.eigvalsh(stiffness_in_masses(linear))
    falling = int((K < -1e-12).sum())
    growth = 0.0 if len(K) and K[0] > 1e-12 else linear.growth  # at a minimum of the energy no motion grows
    if falling and growth == 0 and not linear.drifts:
        rubbed = friction_undoes(linear)
        if rubbed or falling % 2:
            cause = (
                "friction makes it unstable"
                if rubbed
                else f"an odd number of degrees of freedom, {falling}, is unstable"
            )
            raise InputError(
                f"stands: {cause} at any spins (Kelvin, Tait and Chetaev), but at these spins so slowly that double precision "
                "does not resolve the growth: take slower spins" + (", or more friction" if rubbed else "")
            )
    falls = growth > 0
    shape = normal.shapes[0] if falls else np.zeros((len(s.joints), 2), dtype=complex)
    return Standing(not falls and not linear.drifts, growth, shape, factor, s, _why(linear, growth, factor))


def _why(linear: SmallMotion, growth: float, factor: float) -> str:
    K = np.linalg.eigvalsh(stiffness_in_masses(linear))
    n, falling = linear.dof, int((K < -1e-12).sum())
    if growth == 0:
        if linear.drifts:
            return "no motion grows, but one that nothing holds drifts at constant speed after a push"
        if not n:
            return "no degree of freedom remains with the bars"
        reason = (
            "springs or a hanging weight restore it"
            if K[0] > 1e-12
            else "no force acts on some motion, and spins or friction stop a push"
        )
        if not falling:
            return f"{_BOUNDED}: {reason}"
        return f"linearly stable: the spins hold {falling} of {n} degrees of freedom"
    first = f"{falling} of {n} degrees of freedom are unstable, the fastest grows e-fold in {1 / growth:.3g} s; "
    if falling % 2:
        return first + "no spins stabilise an odd number"
    if linear.damping.any():
        bare = spin_threshold(replace(linear, damping=np.zeros_like(linear.mass)))
        return first + (
            f"friction undoes the stability by spins; without it these spins times {bare:.4g} suffice"
            if bare < inf
            else "no multiple of these spins holds them"
        )
    if factor < inf:
        return first + f"the spins are too small: {factor:.6g} times these spins suffice"
    return first + "these spins do not act on some motion, at any multiple"


def measured_fall(s: Assembly, push: ArrayLike, longest: float, tol: float = 1e-9) -> float:
    """Measure the time until the sine of an axis's tilt reaches 0.95, by integrating the exact motion.

    Parameters
    ----------
    s : Assembly
        The structure.
    push : array_like
        The rates of the axes at the start, upright, (N, 2), rad/s. They are projected onto the bars.
    longest : float
        The end of the integration, s.
    tol : float, default 1e-9
        The relative local error.

    Returns
    -------
    float
        The time, s; inf if no axis tilts so far.
    """
    from scipy.integrate import solve_ivp

    motion, rate = exact_motion(s), coefficients(s).rate
    start = start_state(motion, None, finite_array("measured_fall: push", push, (len(s.joints), 2)))

    def fallen(_: float, y: Array) -> float:
        return float(np.hypot(*motion.axes_and_rates(y)[0, 0, :, :2].T).max()) - 0.95

    fallen.terminal = True  # type: ignore[attr-defined]
    span, tolerances = (0, longest * rate), {"rtol": tol, "atol": 1e-3 * tol}
    run = solve_ivp(right_hand_side(motion), span, start, events=fallen, method="DOP853", **tolerances)
    if run.status < 0:
        raise IntegrationError(f"measured_fall: {run.message}")
    return float(run.t[-1]) / rate if run.status == 1 else inf
