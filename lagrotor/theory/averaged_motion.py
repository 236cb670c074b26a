"""The slow motion of opposite spins: its frequency about the paired precession, and the drift of x after a shock.

With g = G/(2 (a + b) k²) and W derived in `theory.drift_after_shock`, the centre (beta, eta) of the fast oscillation obeys

    beta' = g dW/deta,    eta' = −g dW/dbeta,    W = ((eta² + (s² − p)/2)² − 3 s⁴/8)/c − kappa s² eta²,    c = cos² beta.

After a shock along x alone, with s = eta, x turns back if (sigma − 1) k² > 3 + sqrt(3/2); otherwise it grows until bar and axes
are in line. The next order shifts this threshold by as much as it changes the slow frequency.
"""

from dataclasses import dataclass, replace
from math import asin, cos, hypot, inf, pi, sqrt, tan
from typing import Any

import numpy as np

from lagrotor.errors import DomainError, InputError
from lagrotor.pair.quantities import finite_number
from lagrotor.pair.scene import Scene
from lagrotor.result_display import Printed
from lagrotor.theory.fitted_factors import LARGEST_SWING
from lagrotor.theory.paired_precession.series_orbit import amplitude_of
from lagrotor.theory.shock_response import shock_response

# Largest sin chi = sin h/(k cos beta) of the expansion; upright the bar tilts by 2 chi.
FARTHEST_TWIST = 0.5
LARGEST_SHARE = 0.5  # largest ratio of the next order to the leading one
_ROUNDED = 1e-13  # relative size of a component that is rounding
_IN_LINE = pi / 2 - 1e-3  # rad, the lean at which bar and axes count as in line
_LONGEST = 1e4  # in units of the motion's time; only motions near a saddle take longer


@dataclass(frozen=True)
class SlowMotion(Printed):
    """The slow motion of the centre of a fast oscillation, for opposite spins.

    Attributes
    ----------
    lean : float
        Lean beta of the centre along the joint line, in rad.
    half : float
        Half-angle eta between the axes at the centre, in rad.
    swing : float
        Amplitude s of the fast oscillation in the half-angle, in rad.
    momentum : float
        Momentum about the joint line, p = k P/G, dimensionless.
    weight : float
        Coefficient kappa = (sigma − 1) k²/2.
    ratio : float
        Length ratio k = ell/R.
    rate : float
        Rate g = G/(2 (a + b) k²) in rad/s.
    """

    _shown = (
        ("lean β [rad]", "lean"),
        ("half-angle η [rad]", "half"),
        ("amplitude s of the fast oscillation [rad]", "swing"),
        ("momentum p", "momentum"),
        ("rate g [rad/s]", "rate"),
        ("invariant W", "invariant"),
    )

    lean: float
    half: float
    swing: float
    momentum: float
    weight: float
    ratio: float
    rate: float

    @property
    def invariant(self) -> float:
        """The conserved quantity W, dimensionless."""
        y, s2, c = self.half**2, self.swing**2, cos(self.lean) ** 2
        return ((y + (s2 - self.momentum) / 2) ** 2 - 3 * s2**2 / 8) / c - self.weight * s2 * y

    def _slopes(self, lean: float, half: float) -> tuple[float, float]:
        """Return the rates (beta', eta') of the centre in rad/s."""
        s2, c = self.swing**2, cos(lean) ** 2
        inner = half**2 + (s2 - self.momentum) / 2
        half_slope = 4 * half * inner / c - 2 * self.weight * s2 * half
        return self.rate * half_slope, -2 * self.rate * tan(lean) / c * (inner**2 - 3 * s2**2 / 8)

    def _until(self, lean: float) -> tuple[float, float, float]:
        """Return the time (s), |beta| and eta when |beta| reaches `lean` (rad) or turns back; the time is inf if it turns back.

        Near a saddle the integration stops after 10⁴ units of time. Beyond beta = 0 the motion continues as its mirror image.
        """
        from scipy.integrate import solve_ivp
        from scipy.optimize import brentq

        scale = sqrt(max(self.swing**2, self.half**2, abs(self.momentum)))
        if abs(self.lean) >= lean:
            return 0.0, abs(self.lean), self.half
        if scale == 0 or self.rate == 0:
            return inf, abs(self.lean), self.half
        unit = abs(self.rate) * scale**3

        def rhs(_: float, y: Any) -> list[float]:
            c = cos(y[0])  # the time is scaled by c³, so that rates stay finite where c vanishes
            lean_rate, half_rate = self._slopes(y[0], scale * y[1])
            return [lean_rate * c**3 / unit, half_rate * c**3 / (unit * scale), c**3]

        def reached(_: float, y: Any) -> float:
            return abs(y[0]) - lean

        def turning(_: float, y: Any) -> float:
            return float(y[0] * rhs(0.0, y)[0])

        reached.terminal = turning.terminal = True  # type: ignore[attr-defined]
        turning.direction = -1  # type: ignore[attr-defined]
        options = {"events": (reached, turning), "dense_output": True, "rtol": 1e-9, "atol": 1e-30}
        run = solve_ivp(rhs, (0, _LONGEST), (self.lean, self.half / scale, 0.0), "DOP853", **options)
        end = run.t[-1]
        if not len(run.t_events[0]) and reached(end, run.y[:, -1]) > 0:  # reached and left again within the last step
            end = brentq(lambda t: reached(t, run.sol(t)), *run.t[-2:])
        beta, eta, time = run.sol(end).tolist()
        return (time / unit if end < run.t[-1] or len(run.t_events[0]) else inf), abs(beta), scale * eta

    @property
    def farthest(self) -> float:
        """The largest |beta| of the motion in rad; pi/2 if it does not turn back."""
        time, lean, _ = self._until(_IN_LINE)
        return lean if time == inf else pi / 2

    def _twist(self, lean: float, half: float) -> float:
        """Return the largest sin chi while the axes oscillate about a centre; chi is the angle by which their plane rotates."""
        return (abs(half) + self.swing) / (self.ratio * cos(lean))


def slow_motion(scene: Scene) -> SlowMotion:
    """Return the slow motion of opposite spins after the scene's shock, from rest upright.

    The linear response gives the centre (x, (y_1 − y_2)/2), the amplitude s in (y_1 − y_2)/2, and P = −p_y.

    Parameters
    ----------
    scene : Scene
        Opposite spins with a bar and a shock.

    Returns
    -------
    SlowMotion
        The motion of leading order in the shock.

    Raises
    ------
    InputError
        Unless the spins are opposite, and the pair, with a bar and a shock, starts at rest and upright.
    DomainError
        Where |eta| + s > 0.4.

    References
    ----------
    derivations/t11_slow_motion.py.
    """
    response = shock_response(scene)
    if scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0:
        raise InputError(f"slow_motion: needs opposite spins, not {scene.spins}")

    def half(vector: np.ndarray) -> float:
        return float(vector[1] - vector[2]) / 2

    swing, apart = hypot(half(response.cosine), half(response.sine)), half(response.displacement)
    if abs(apart) < _ROUNDED * hypot(*response.displacement, swing):  # a shock along y starts where beta' = 0
        apart = 0.0
    if not abs(apart) + swing <= LARGEST_SWING.value:
        raise DomainError(
            f"slow_motion: the shock turns the axes {2 * (abs(apart) + swing):.3g} rad against each other, beyond "
            f"{2 * LARGEST_SWING.value:g}: it is not small; take a smaller one, or run it with lagrotor.simulate"
        )
    p_y = float(response.impulse[1] + response.impulse[2])
    return _motion(scene, float(response.displacement[0]), apart, swing, -p_y)


def _motion(scene: Scene, lean: float, half: float, swing: float, momentum: float) -> SlowMotion:
    (a, b), G, k = scene.inertias, scene.momenta[0], scene.k
    return SlowMotion(lean, half, swing, k * momentum / G, (scene.sigma - 1) * k * k / 2, k, G / (2 * (a + b) * k * k))


def time_to_reach(scene: Scene, x: float) -> float:
    """Return the time from the peak of the shock until the mean |x| of opposite spins reaches a value.

    The averaged motion is of leading order in the shock at any x; the relative error is of second order, and
    `lagrotor.models.time_to_reach_error` measures it.

    Parameters
    ----------
    scene : Scene
        Opposite spins with a bar and a shock.
    x : float
        Value of |x| between 0 and 1.

    Returns
    -------
    float
        Time in s; inf if x turns back before.

    Raises
    ------
    InputError
        Unless the spins are opposite, and the pair, with a bar and a shock, starts at rest and upright.
    DomainError
        Unless 0 < x < 1; for |eta| + s > 0.4; for a twist above 30 degrees, sin chi = (|eta| + s)/(k sqrt(1 − x²)); and where
        `turns_back` cannot decide.

    References
    ----------
    derivations/t11_slow_motion.py.
    """
    if not 0 < finite_number(x, "time_to_reach: x", "1") < 1:
        raise DomainError(f"time_to_reach: x = {x:g} must lie between 0 and 1")
    motion = slow_motion(scene)
    time, _, half = motion._until(asin(x))
    if time == inf:
        turns_back(scene)  # raises DomainError where the next order decides
        return time
    twist = motion._twist(asin(x), max(abs(half), abs(motion.half)))
    if twist > FARTHEST_TWIST:
        raise DomainError(
            f"time_to_reach: at x = {x:g} the pair twists by {np.degrees(asin(min(1.0, twist))):.0f}°, more than 30°: take a "
            "smaller x or shock, or run it with lagrotor.simulate"
        )
    return time


def turns_back(scene: Scene) -> bool:
    """Return True if the mean x of opposite spins stays bounded after the scene's shock.

    To leading order x turns back after a shock along x, which gives eta = p_x/(2 G) and s = A |eta|, if

        (sigma − 1) k² > 1 + 2/A² + sqrt(3/2),

    where the right side is 3 + sqrt(3/2) for a short pulse. Otherwise x grows, at least until the twist is 30 degrees, which is
    the limit of the expansion.

    Parameters
    ----------
    scene : Scene
        Opposite spins with a bar and a shock.

    Returns
    -------
    bool
        True if x turns back again and again.

    Raises
    ------
    InputError
        Unless the spins are opposite, and the pair, with a bar and a shock, starts at rest and upright.
    DomainError
        For |eta| + s > 0.4; for a twist above 30 degrees; and if twice the next order could change the answer.

    References
    ----------
    derivations/t11_slow_motion.py.

    Examples
    --------
    >>> from lagrotor import Link, Scene, Shock
    >>> shock = Shock((100, 0, 0), at=1.0, width=0.01)
    >>> [turns_back(Scene((20, -20), link=link, shock=shock)) for link in (Link(1.0), Link(1.0, 50.0))]
    [False, True]
    """
    motion = slow_motion(scene)
    size = motion.swing**2 + motion.half**2
    share = 2 * _next_share(size, motion.momentum - size, scene.sigma, motion.ratio**2) if size else 0.0
    margin = share * max(1.0, abs(motion.weight))
    endings = [replace(motion, weight=motion.weight + change)._until(_IN_LINE) for change in (0.0, margin, -margin)]
    time, lean, half = endings[0]
    twist_before = motion._twist(lean, half) if time == inf else 0.0
    if max(motion._twist(motion.lean, motion.half), twist_before) > FARTHEST_TWIST:
        raise DomainError(
            "turns_back: the pair twists by more than 30° from the start or before x turns back: take a smaller shock, or run it "
            "with lagrotor.simulate"
        )
    if len({ending[0] == inf for ending in endings}) > 1:
        raise DomainError(
            "turns_back: the shock is so near the threshold that the next order of the averaged motion decides: take a smaller "
            "shock, or run it with lagrotor.simulate"
        )
    return time == inf


def next_brackets(s2: Any, d: Any, sigma: Any, k2: Any) -> tuple[Any, Any]:
    """Return the next-order terms F_6 and L_4 of `slow_frequency`; s2 = sigma r0², d = k momentum/G, k2 = k²."""
    cubic = (3 / sigma + 10 - 8 * sigma) * k2 - 12, 8 * k2 / sigma + 14, (4 / sigma + 2) * k2 + 8
    square = (8 / sigma + 15 - 54 * sigma + 31 * sigma**2) * k2 + 6 / sigma - 21 + 51 * sigma
    F_6 = s2 * (cubic[0] * s2**2 - cubic[1] * d * s2 - cubic[2] * d**2) / (4 * k2)
    L_4 = ((k2 / sigma - k2 + 4) * d**2 - 4 * (k2 / sigma - 2) * d * s2) / (4 * k2) - square * s2**2 / 48
    return F_6, L_4


def _next_share(s2: float, d: float, sigma: float, k2: float) -> float:
    """Return the larger ratio of next-order terms to leading-order terms, taken as positive, in F and L of `slow_frequency`."""
    sizes = 1.5 * s2**2 + d**2, abs(d) + max(1.0, abs(sigma - 1) * k2 / 2) * s2
    return max((abs(n) / size for n, size in zip(next_brackets(s2, d, sigma, k2), sizes, strict=True) if n), default=0)


def slow_frequency(scene: Scene, r0: float, momentum: float = 0.0) -> complex:
    """Return the slow angular frequency about the paired precession of amplitude r0.

    With s² = sigma r0², d = k momentum/G, kappa = (sigma − 1) k²/2 and g = G/(2 (a + b) k²),

        frequency² = g² F L,    F = 3 s⁴/2 − d² + F_6,    L = d + kappa s² + L_4,

        4 k² F_6 = s² ((3 k²/sigma + 10 k² − 8 k² sigma − 12) s⁴ − (8 k²/sigma + 14) d s² − (4 k²/sigma + 2 k² + 8) d²),

        48 k² L_4 = 12 (k²/sigma − k² + 4) d² − 48 (k²/sigma − 2) d s²
                    − (8 k⁴/sigma + 15 k⁴ − 54 k⁴ sigma + 31 k⁴ sigma² + 6 k²/sigma − 21 k² + 51 k² sigma) s⁴.

    The relative error of a bracket is O(r0⁴) for d of order r0²; `lagrotor.models.slow_frequency_error` measures the error of
    the frequency, which is large where a bracket nearly vanishes.

    Parameters
    ----------
    scene : Scene
        Opposite spins with a bar.
    r0 : float
        Sine of the inclination at the moments of parallel axes.
    momentum : float, default 0.0
        Momentum about the joint line in kg m²/s, relative to the exact paired precession of this r0; a push adds it. The
        leading order G s²/k of the precession's momentum is not accurate enough here.

    Returns
    -------
    complex
        Frequency in rad/s; imaginary if the motion grows.

    Raises
    ------
    InputError
        Unless the spins are opposite and there is a bar.
    DomainError
        If the next order exceeds half of the leading one, in which all terms are taken as positive.

    References
    ----------
    derivations/t11_slow_motion.py.

    Examples
    --------
    >>> from lagrotor import Link, Scene
    >>> round(slow_frequency(Scene(spins=(10, -10), link=Link(1.0, 1.0, 0.1)), r0=0.1).real, 5)
    0.00139
    """
    amplitude = amplitude_of(r0, "slow_frequency")
    push = finite_number(momentum, "slow_frequency: momentum", "kg m²/s")
    if not isinstance(scene, Scene) or scene.link is None or sum(scene.spins) != 0 or scene.spins[0] == 0:
        raise InputError(f"slow_frequency: {scene!r} needs a bar and opposite spins")
    sigma, k2 = scene.sigma, scene.k**2
    s2, d = sigma * amplitude**2, push * scene.k / scene.momenta[0]
    motion = _motion(scene, 0.0, 0.0, sqrt(s2), 0.0)
    share, (F_6, L_4) = _next_share(s2, d, sigma, k2), next_brackets(s2, d, sigma, k2)
    if not share <= LARGEST_SHARE:
        raise DomainError(
            f"slow_frequency: r0 = {r0:g} with k momentum/G = {d:.3g} is beyond the law's range: at k = {scene.k:.3g}, "
            f"sigma = {sigma:.3g} the next order is {share:.2g} of the leading one, more than {LARGEST_SHARE:g}; use "
            "lagrotor.floquet"
        )
    squared = (1.5 * s2**2 - d**2 + F_6) * (d + motion.weight * s2 + L_4)
    return abs(motion.rate) * complex(squared) ** 0.5
