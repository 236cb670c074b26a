"""Whether a structure stands upright, to first order and beyond, why not, and the least factor on its spins to first order.

To first order the theorems of `critical_spins` decide. What spins hold against weight has precessions of negative energy, and
resonances of third and fourth order between them let it fall all the same: see `resonances`.
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

PUSH = 0.01  # of the natural rate: the push that `kind` and `why` speak of
_FARTHEST = 5  # times the push that is trusted: beyond, an axis tilts by ½ before anything grows
_LEAST_TIMES = 20  # in which a push falls, if it does
_BOUNDED = "every small motion stays bounded"


Kind = Literal["never", "to first order", "falls at a resonance", "falls over a barrier", "holds"]


@dataclass(frozen=True, eq=False, repr=False)
class Standing(Shown):
    """Whether it stands to first order; growth (1/s) of the motion that falls fastest and its shape (N, 2), complex.

    critical_spin: the factor on all spins from which on it stands to first order, inf where there is none. A truth value: that of
    `stands`. `kind` says what lies beyond.
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
        """What it does beyond the linear motion:

        - "never": it does not stand to first order, and any push falls or goes on;
        - "falls at a resonance": from every push of more than PUSH times its natural rate, in some direction, and from
          smaller ones as `largest_push` says;
        - "falls over a barrier": likewise, but no rates resonate: so near the critical spins the barrier that the terms of third
          and fourth order leave is lower than such a push;
        - "holds": its energy is least when upright, or no resonance through fourth order falls from such a push;
        - "to first order": it stands in the linear motion, and no more is known: something neither falls nor is pulled back,
          friction acts, there are more degrees of freedom than are expanded, rates are so far apart that `resonances` refuses
          them, or the critical spins are so near that such a push tilts it by more than 0.1.
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
        except (InputError, SingularError):  # at the critical spins two modes are one, or rates are too far apart
            return "to first order"
        if resonance and resonance.push() < self._reference:
            return "falls at a resonance" if resonance.resonant else "falls over a barrier"
        return "to first order" if self._too_near else "holds"

    @cached_property
    def resonance(self) -> Resonance | None:
        """The resonance that the smallest push falls by; None where none is near. Raises InputError as `resonances` does."""
        return first_resonance(self.structure)

    @cached_property
    def _too_near(self) -> bool:
        """Whether a push of PUSH is beyond what the expansion is trusted, as beside the critical spins."""
        return trusted_push(self.structure) < self._reference

    @property
    def _reference(self) -> float:
        return PUSH * local_hamiltonian(self.structure).rate

    @property
    def why(self) -> str:
        """Why it stands or falls, in words."""
        if self.kind == "falls at a resonance" and self.resonance:
            least = self.resonance.push()
            words = (
                f"{self.first_order}, but it falls at a resonance of order {self.resonance.order}, "
                f"{self.resonance.words()}: from a push of {least:.2g} rad/s on"
            )
            if self._reference > _FARTHEST * trusted_push(self.structure):
                return f"{words}; one of {self._reference:.3g} rad/s tilts it so far that its time is not known"
            return (
                f"{words}, one of {self._reference:.3g} rad/s in {self.resonance.least_time(self._reference):.3g} s or more by "
                "the normal form, which may be off by half: measured_fall runs the exact motion"
            )
        if self.kind == "falls over a barrier" and self.resonance:
            return (
                f"{self.first_order}, but a push of about {self.resonance.push():.2g} rad/s in some direction passes the barrier "
                f"that the terms of order {self.resonance.order} leave, and it falls; no rates resonate (the nearest: "
                f"{self.resonance.words()})"
            )
        if self.kind == "holds" and not self.first_order.startswith(_BOUNDED):
            return (
                f"{self.first_order}; no resonance through fourth order falls from a push of {self._reference:.3g} rad/s; "
                "higher orders act later: not before `hold_time`"
            )
        if self.kind == "to first order" and self.__dict__.get("_too_near"):
            return (
                f"{self.first_order}; so near the critical spins a push of {self._reference:.3g} rad/s tilts it too far for more "
                "to be known"
            )
        return self.first_order

    def fall_time(self, push: float | ArrayLike) -> float:
        """Return when it falls, s: a least time for a number; for rates an estimate, which may be off by half and more.

        A number: the least time of pushes of that size by the resonance's own terms, inf where none falls. Rates (N, 2) of the
        axes, rad/s: that of this push from upright, by the normal form of fourth order, inf where it does not fall in 20 least
        times. `measured_fall` has the exact motion's.

        Raises InputError as `resonances` does, and for pushes whose tilts are beyond what the expansion is trusted.
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
                f"fall_time: this push of {size:.3g} rad/s does not fall in {_LEAST_TIMES * least:.3g} s by the expansion, which "
                f"is trusted to {trusted:.3g}: simulate it"
            )
        return time

    def hold_time(self, push: float) -> float:
        """Estimate the time (s) before which no push of that size grows to sqrt(2) times its size in the normal modes: see
        `structures.stability_time`.

        inf without bars and braces, where each rotor is a free top, and for staying near where the energy is least upright, of
        more than 8 degrees of freedom for pushes that are small enough; 0 where it does not stand or the push is beyond what the
        expansion is trusted. push: as `largest_push` has it.

        Raises InputError with friction, and for more than 8 degrees of freedom.
        """
        return hold_time(self.structure, push)

    def summary(self) -> dict[str, str]:
        """Return whether it stands and why, and what spins it needs, name → words."""
        least = "none" if self.critical_spin == inf else f"{self.critical_spin:.6g}"
        return {
            "stands to first order": "yes" if self.stands else "no",
            "beyond": "never at these spins" if self.kind == "never" and self.critical_spin < inf else self.kind,
            "why": self.why,
            "least factor on all spins, to first order": least,
        }


def stands(s: Assembly) -> Standing:
    """Return whether the linear motion about upright stays bounded, and what resonances do: see `Standing`.

    Raises InputError where upright breaks a bar's length, and where it falls more slowly than is resolved: an odd number of
    degrees of freedom that fall without spin do so at any (Kelvin), and so does what friction acts on (Tait and Chetaev, too).
    Raises InputError, too, where the fastest rate is more than 10⁶ times the slowest. What friction reaches by less than
    `critical_spin` counts stands here.
    """
    linear, normal, factor = check_rates(s, "stands"), modes(s), critical_spin(s)
    K = np.linalg.eigvalsh(stiffness_in_masses(linear))
    falling = int((K < -1e-12).sum())
    growth = 0.0 if len(K) and K[0] > 1e-12 else linear.growth  # energy that is least when upright grows nowhere
    if falling and growth == 0 and not linear.drifts:
        rubbed = friction_undoes(linear)
        if rubbed or falling % 2:
            cause = "friction lets it fall" if rubbed else f"an odd number of its degrees of freedom, {falling}, falls"
            raise InputError(
                f"stands: {cause} at any spins (Kelvin, Tait and Chetaev), but beside these so slowly that double precision "
                "cannot tell how fast: take slower spins" + (", or more friction" if rubbed else "")
            )
    falls = growth > 0
    shape = normal.shapes[0] if falls else np.zeros((len(s.joints), 2), dtype=complex)
    return Standing(not falls and not linear.drifts, growth, shape, factor, s, _why(linear, growth, factor))


def _why(linear: SmallMotion, growth: float, factor: float) -> str:
    K = np.linalg.eigvalsh(stiffness_in_masses(linear))
    n, falling = linear.dof, int((K < -1e-12).sum())
    if growth == 0:
        if linear.drifts:
            return "nothing falls, but a motion that nothing holds goes on at its speed after a push"
        if not n:
            return "the bars leave no degree of freedom"
        reason = (
            "springs or a hanging weight hold it"
            if K[0] > 1e-12
            else "nothing pulls at it, and spins or friction stop a push"
        )
        if not falling:
            return f"{_BOUNDED}: {reason}"
        return f"to first order: the spins hold {falling} of {n} degrees of freedom"
    first = f"{falling} of {n} degrees of freedom fall, the fastest e-fold in {1 / growth:.3g} s; "
    if falling % 2:
        return first + "an odd number of them, which no spins hold"
    if linear.damping.any():
        bare = spin_threshold(replace(linear, damping=np.zeros_like(linear.mass)))
        return first + (
            f"friction undoes what the spins hold; without it they would from {bare:.4g} times these spins on"
            if bare < inf
            else "and no multiple of these spins holds them"
        )
    if factor < inf:
        return first + f"the spins are too small: from {factor:.6g} times them on it stands"
    return first + "a motion on which these spins do not act, at any multiple of them"


def measured_fall(s: Assembly, push: ArrayLike, longest: float, tol: float = 1e-9) -> float:
    """Return the time (s) at which an axis of the exact motion first tilts by the sine 0.95, inf where none does.

    Parameters
    ----------
    s : Assembly
        The structure.
    push : array_like
        The axes' rates (N, 2), rad/s, from upright, brought onto the bars.
    longest : float
        S.
    tol : float, default 1e-09
        Of each step, relative.

    Raises
    ------
    InputError
        For what is no push.
    IntegrationError
        Where the solver fails.
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
