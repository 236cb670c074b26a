"""The slow motion of opposite spins for a scene: its frequency beside the paired precession, and how far a shock carries x.

The centre of the fast swing obeys, with rate g = G/(2 (a + b) k²) and W of `theory.averaging`,

    beta' = g dW/deta,    eta' = −g dW/dbeta,    W = ((eta² + (s² − p)/2)² − 3 s⁴/8)/c − kappa s² eta²,    c = cos² beta.

W is conserved and quadratic in eta², so that its curves, the phase portrait, are known in closed form:

    eta² = D − (s² − p − kappa s² c)/2,    D² = 3 s⁴/8 + (W − kappa s² (s² − p)/2) c + (kappa s² c/2)²,
    beta' = 4 g eta D/c,    t = ∫ c dbeta / (4 g eta D),

with D of either sign, the branch. beta turns where D or eta vanishes. After a shock along x alone that leaves s = eta it does so
if (sigma − 1) k² > 3 + sqrt(3/2); for less, x grows until bar and axes come into line. The next order, W_6 (`next_average`),
moves this threshold, for heavy bars by a good part already at small shocks.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import asin, copysign, cos, hypot, inf, pi, sin, sqrt, tan
from typing import Any, NamedTuple

import numpy as np

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.generated import generated
from lagrotor.pair.quantities import finite_number
from lagrotor.pair.scene import Scene
from lagrotor.theory.calibrated_factors import LARGEST_SWING
from lagrotor.theory.paired_precession.series_orbit import amplitude_of
from lagrotor.theory.shock_response import shock_response

# sin chi = sin h/(k cos beta) beyond which no expansion in it is made; upright the bar tilts by 2 chi.
FARTHEST_TWIST = 0.5
LARGEST_SHARE = 0.5  # of the leading order, that the next one may be
_ROUNDED = 1e-13  # part of a vector that is rounding
_LEANS, _TRIES = 300, 30  # of a curve that is followed; steps of Newton's method at each


@generated(((),))
def _next_order() -> str:
    """(eta², tan² beta_s, s, p, sigma, k) → W_6 and its derivative by eta²."""
    import sympy as sp

    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import HALF, LEAN, SWING, k, sigma
    from lagrotor.theory.averaging import SWING_LETTERS, next_average

    square, steep = sp.symbols("square steep", positive=True)
    average = next_average().subs({HALF: sp.sqrt(square), sp.tan(LEAN): sp.sqrt(steep)})
    return program_source(
        Program((square, steep, SWING, SWING_LETTERS[3], sigma, k), (), (average, average.diff(square)))
    )


@generated(((),))
def _uneven_action() -> str:
    """(eta, s, p, sin Phi, sigma, k) → (H_4 − <H_4>)/I upright: by what share of itself s² is more in the mean."""
    import sympy as sp

    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import HALF, SWING, k, sigma
    from lagrotor.theory.averaging import SWING_LETTERS, oscillating_hamiltonian, over_swing

    tangent, _, _, push, sine, cosine = SWING_LETTERS
    H_4, root = oscillating_hamiltonian()[0], sp.Symbol("r", positive=True)
    uneven = (H_4 - over_swing(H_4)).as_expr().subs({tangent: 0, cosine: sp.sqrt(1 - sine**2)}) / (root * SWING) ** 2
    share = sp.expand(sp.expand(uneven).subs(root, 1 / sp.sqrt(sigma)))
    return program_source(Program((HALF, SWING, push, sine, sigma, k), (), (share,)))


class _Leg(NamedTuple):
    """A part of the motion in which |beta| goes one way, on one branch."""

    begin: float
    end: float
    branch: float


@dataclass(frozen=True)
class SlowMotion:
    """The centre (lean beta, half-angle eta, rad) of a swing of amplitude `swing` s (rad, in the half-angle).

    Attributes:
        momentum: p = k P/G.
        weight: kappa = (sigma − 1) k²/2.
        ratio: k.
        rate: g = G/(2 (a + b) k²), rad/s.
        phase: sin Phi of the swing at the start.
    """

    lean: float
    half: float
    swing: float
    momentum: float
    weight: float
    ratio: float
    rate: float
    phase: float = 0.0

    @cached_property
    def invariant(self) -> float:
        """W, which is conserved."""
        y, s2, c = self.half**2, self.swing**2, cos(self.lean) ** 2
        return ((y + (s2 - self.momentum) / 2) ** 2 - 3 * s2**2 / 8) / c - self.weight * s2 * y

    def slopes(self, lean: float, half: float) -> tuple[float, float]:
        """(beta', eta') in rad/s at a centre."""
        s2, c = self.swing**2, cos(lean) ** 2
        inner = half**2 + (s2 - self.momentum) / 2
        across = 4 * half * inner / c - 2 * self.weight * s2 * half
        return self.rate * across, -2 * self.rate * tan(lean) / c * (inner**2 - 3 * s2**2 / 8)

    def turning(self, lean: float, half: float) -> float:
        """Mean rate alpha' (rad/s) of turning about the joint line at a centre."""
        inner = half**2 + (self.swing**2 - self.momentum) / 2
        return -2 * self.rate * self.ratio * inner / cos(lean) ** 2

    def half_squared(self, lean: float, branch: float = 1.0) -> float:
        """eta² on the curve of the motion at a lean; negative, or not a number, where the curve does not come."""
        v = sin(lean - self.lean) * sin(lean + self.lean)
        square, offset = np.polyval(self._square, v), self._offset + self.weight * self.swing**2 * v / 2
        if square < 0:
            return -inf
        apart = branch * sqrt(square)
        return float((self._product - self.invariant * v) / (apart + offset) if apart * offset > 0 else apart - offset)

    @cached_property
    def _offset(self) -> float:
        """D − eta² at the start."""
        return (self.swing**2 * (1 - self.weight * cos(self.lean) ** 2) - self.momentum) / 2

    @cached_property
    def _product(self) -> float:
        """D² − (D − eta²)² at the start; elsewhere it is less by W v."""
        return self.half**2 * (self.half**2 + 2 * self._offset)

    @cached_property
    def _square(self) -> tuple[float, float, float]:
        """Coefficients of D² in v = sin² beta − sin² of the start's, as cos² beta rounds small leans away."""
        s2, c, push = self.swing**2, cos(self.lean) ** 2, self.swing**2 - self.momentum
        bend = (self.weight * s2 / 2) ** 2
        slope = self.invariant - self.weight * s2 * push / 2 + 2 * bend * c
        return bend, -slope, (self.half**2 + self._offset) ** 2

    def _turns(self, branch: float) -> list[tuple[float, float]]:
        """(|beta|, the branch from there on) of the points where beta turns on a branch."""
        rising, start = self.weight * self.swing**2 / 2, sin(self.lean) ** 2
        folds = [(float(v.real), -branch) for v in np.roots(self._square) if v.imag == 0]
        turns = [(v, after) for v, after in folds if self._offset + rising * v <= 0]
        if self.invariant != 0:  # where a branch has eta = 0: D = the offset
            level = self._product / self.invariant
            if branch * (self._offset + rising * level) >= 0:
                turns.append((level, branch))
        return [(asin(sqrt(start + v)), after) for v, after in turns if 0 < start + v < 1 - 1e-12]

    @cached_property
    def legs(self) -> tuple[_Leg, ...]:
        """The motion from its start until |beta| has grown as far as it does: to a turning point, or to pi/2.

        Beyond beta = 0 it goes on as its mirror image.
        """
        here = abs(self.lean)
        branch = copysign(1.0, self.half**2 + self._offset)
        along, across = self.slopes(self.lean, self.half)
        # Where eta = 0 beta turns, and eta' tells to which side.
        outward = self.lean * (along or branch * self.rate * across)
        legs = []
        if outward < 0:
            inner = max((turn for turn in self._turns(branch) if turn[0] < here * (1 - 1e-9)), default=(0.0, branch))
            legs.append(_Leg(here, inner[0], branch))
            here, branch = inner
        end = min((turn for turn, _ in self._turns(branch) if turn > here * (1 + 1e-9)), default=pi / 2)
        return (*legs, _Leg(here, end, branch))

    @property
    def farthest(self) -> float:
        """The largest |beta| of the motion (rad), pi/2 where it does not turn back."""
        return max(leg.end for leg in self.legs)

    def twist(self, lean: float, half: float) -> float:
        """The largest sin chi in a swing about a centre, chi the turn of the plane of the axes about their mean."""
        return (abs(half) + self.swing) / (self.ratio * cos(lean))

    def turns(self, share: float) -> bool:
        """Return whether |beta| turns back on the curve of W + share W_6, its s² that of the mean to the same share.

        False where, before, chi is more than 30 degrees, or the next order's part of the slope by eta² is more than
        half of the leading one's with all its terms positive.
        """
        p, sigma, average = self.momentum, 1 + 2 * self.weight / self.ratio**2, _next_order()
        s2, least = self.swing**2, 1e-9 * (self.swing**2 + self.half**2 + abs(p))
        if share and s2:
            s2 *= max(0.0, 1 + share * _uneven_action()(self.half, self.swing, p, self.phase, sigma, self.ratio)[0])

        def level(y: float, c: float) -> tuple[float, float, bool]:
            """W + share W_6, its derivative by y = eta², and whether the next order is small in it."""
            inner = y + (s2 - p) / 2
            more, steeper = average(y, 1 / c - 1, sqrt(s2), p, sigma, self.ratio)
            leading = (inner**2 - 3 * s2**2 / 8) / c - self.weight * s2 * y
            slopes, steeper = (2 * inner / c, self.weight * s2), share * steeper
            small = abs(steeper) <= LARGEST_SHARE * (abs(slopes[0]) + abs(slopes[1]))
            return leading + share * more, slopes[0] - slopes[1] + steeper, small

        wanted, *_ = level(self.half**2, cos(self.lean) ** 2)
        begin, _, branch = self.legs[-1]
        y = max(self.half_squared(begin, branch), 0.0)
        for lean in np.linspace(begin, pi / 2, _LEANS, endpoint=False)[1:]:
            for _ in range(_TRIES):
                here, slope, small = level(y, cos(lean) ** 2)
                step = (wanted - here) / slope if slope else inf
                if not abs(step) < 1e12 * least:
                    break
                y += step
                if abs(step) <= least:
                    break
            if not small:
                return False
            if not (abs(step) <= least and y > 0 and slope * branch > 0):
                return True
            if self.twist(lean, sqrt(y)) > FARTHEST_TWIST:
                return False
        return False

    def time_to(self, lean: float) -> float:
        """Time (s) until |beta| grows to `lean` (rad); inf where it does not get there."""
        if abs(self.lean) >= lean:
            return 0.0
        *before, last = self.legs
        if last.end < lean or self.slopes(self.lean, self.half) == (0.0, 0.0):
            return inf
        return sum(self._duration(leg) for leg in (*before, last._replace(end=lean)))

    def _duration(self, leg: _Leg) -> float:
        """∫ c dbeta/(4 g |eta D|), by beta = begin ± u² next to the start and the end, where D or eta may vanish."""
        from scipy.integrate import quad

        def density(lean: float) -> float:
            v = sin(lean - self.lean) * sin(lean + self.lean)
            square, y = np.polyval(self._square, v), self.half_squared(lean, leg.branch)
            return cos(lean) ** 2 / sqrt(square * y) if square > 0 and y > 0 else 0.0

        sense, root = copysign(1.0, leg.end - leg.begin), sqrt(abs(leg.end - leg.begin) / 2)
        first = quad(lambda u: u * density(leg.begin + sense * u * u), 0, root, epsabs=0, epsrel=1e-7, limit=200)[0]
        last = quad(lambda u: u * density(leg.end - sense * u * u), 0, root, epsabs=0, epsrel=1e-7, limit=200)[0]
        return float(first + last) / (2 * abs(self.rate))


def slow_motion(scene: Scene) -> SlowMotion:
    """The slow motion after the scene's shock of opposite spins from rest upright.

    The pulse leaves the centre (x, (y_1 − y_2)/2) of the linear response, its swing s in (y_1 − y_2)/2, and P = −p_y.

    Raises:
        InputError: as `shock_response`, and unless the spins are opposite.
        DomainError: where |eta| + s > 0.4.
    """
    response = shock_response(scene)
    if scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0:
        raise InputError(f"slow_motion: needs opposite spins, not {scene.spins}")

    def half(vector: np.ndarray) -> float:
        return float(vector[1] - vector[2]) / 2

    swing, apart = hypot(half(response.cosine), half(response.sine)), half(response.displacement)
    if abs(apart) < _ROUNDED * hypot(*response.displacement, swing):  # a shock along y starts where beta turns
        apart = 0.0
    if not abs(apart) + swing <= LARGEST_SWING.value:
        raise DomainError(
            f"slow_motion: the shock turns the axes {2 * (abs(apart) + swing):.3g} rad against each other, beyond "
            f"{2 * LARGEST_SWING.value:g}: it is not small; take a smaller one, or run it with lagrotor.simulate"
        )
    p_y = float(response.impulse[1] + response.impulse[2])
    phase = half(response.cosine) / swing if swing else 0.0
    return replace(_motion(scene, float(response.displacement[0]), apart, swing, -p_y), phase=phase)


def _motion(scene: Scene, lean: float, half: float, swing: float, momentum: float) -> SlowMotion:
    (a, b), G, k = scene.inertias, scene.momenta[0], scene.k
    return SlowMotion(lean, half, swing, k * momentum / G, (scene.sigma - 1) * k * k / 2, k, G / (2 * (a + b) * k * k))


def time_to_reach(scene: Scene, x: float) -> float:
    """Time (s) from the peak of the scene's shock until the mean |x| of opposite spins reaches `x`; inf where it turns back.

    By quadrature over the averaged motion, to leading order in the shock at any x: the relative error is of second order in it,
    and `lagrotor.models.time_to_reach_error` measures it.

    Raises:
        InputError: as `slow_motion`.
        DomainError: as `slow_motion`, unless 0 < x < 1, where the pair comes to twist by more than 30 degrees before,
            sin chi = (|eta| + s)/(k sqrt(1 − x²)), and where x turns back before but `turns_back` refuses to say so.
    """
    if not 0 < finite_number(x, "time_to_reach: x", "1") < 1:
        raise DomainError(f"time_to_reach: x = {x:g} must lie between 0 and 1")
    motion, lean = slow_motion(scene), asin(x)
    if lean > motion.farthest:
        turns_back(scene)  # which refuses where the next order decides
    else:
        half = sqrt(max(motion.half_squared(lean, motion.legs[-1].branch), 0.0))
        twist = motion.twist(lean, max(half, abs(motion.half)))
        if twist > FARTHEST_TWIST:
            raise DomainError(
                f"time_to_reach: at x = {x:g} the pair twists by {np.degrees(asin(min(1.0, twist))):.0f}°, more than 30°: take a "
                "smaller x or shock, or run it with lagrotor.simulate"
            )
    return motion.time_to(lean)


def turns_back(scene: Scene) -> bool:
    """Return whether the mean x of opposite spins stays bounded after the scene's shock: it turns back, again and again.

    Of the averaged motion. To leading order it does after a shock along x, which leaves eta = p_x/(2 G) and s = A |eta|, beyond a
    threshold that the next order moves:

        (sigma − 1) k² > 1 + 2/A² + sqrt(3/2),

    3 + sqrt(3/2) for a short pulse. Below it x grows, at least until the pair twists by 30 degrees, the end of the expansion.

    Raises:
        InputError: as `slow_motion`.
        DomainError: as `slow_motion`, where the pair twists by more than 30 degrees before x turns back or from the start, and
            beside the threshold, where W, W + W_6 and W + 2 W_6 decide differently.
    """
    motion = slow_motion(scene)
    answers = {motion.turns(share) for share in (0.0, 1.0, 2.0)}
    if motion.twist(motion.lean, motion.half) > FARTHEST_TWIST or (answers == {False} and motion.farthest < pi / 2):
        raise DomainError(
            "turns_back: the pair twists by more than 30° from the start or before x turns back: take a smaller shock, or run it "
            "with lagrotor.simulate"
        )
    if len(answers) > 1:
        raise DomainError(
            "turns_back: so near the threshold the next order of the averaged motion decides: take a smaller shock, or run it "
            "with lagrotor.simulate"
        )
    return answers.pop()


def next_brackets(s2: Any, d: Any, sigma: Any, k2: Any) -> tuple[Any, Any]:
    """(F_6, L_4) of `slow_frequency`, of numbers or symbols.

    Args:
        s2: s² = sigma r0².
        d: the push.
        sigma: shape of the bar.
        k2: k².
    """
    cubic = (3 / sigma + 10 - 8 * sigma) * k2 - 12, 8 * k2 / sigma + 14, (4 / sigma + 2) * k2 + 8
    square = (8 / sigma + 15 - 54 * sigma + 31 * sigma**2) * k2 + 6 / sigma - 21 + 51 * sigma
    F_6 = s2 * (cubic[0] * s2**2 - cubic[1] * d * s2 - cubic[2] * d**2) / (4 * k2)
    L_4 = ((k2 / sigma - k2 + 4) * d**2 - 4 * (k2 / sigma - 2) * d * s2) / (4 * k2) - square * s2**2 / 48
    return F_6, L_4


def slow_frequency(scene: Scene, r0: float, momentum: float = 0.0) -> complex:
    """Slow angular frequency (rad/s) of the motion beside the paired precession of amplitude r0: imaginary where it grows.

    With s² = sigma r0², d = k momentum/G, kappa = (sigma − 1) k²/2 and g = G/(2 (a + b) k²),

        frequency² = g² F L,    F = 3 s⁴/2 − d² + F_6,    L = d + kappa s² + L_4,

        4 k² F_6 = s² ((3 k²/sigma + 10 k² − 8 k² sigma − 12) s⁴ − (8 k²/sigma + 14) d s² − (4 k²/sigma + 2 k² + 8) d²),

        48 k² L_4 = 12 (k²/sigma − k² + 4) d² − 48 (k²/sigma − 2) d s²
                    − (8 k⁴/sigma + 15 k⁴ − 54 k⁴ sigma + 31 k⁴ sigma² + 6 k²/sigma − 21 k² + 51 k² sigma) s⁴.

    The relative error of a bracket is of fourth order in r0 where r0² and d are small alike; that of the frequency, which
    `lagrotor.models.slow_frequency_error` measures, is large where a bracket nearly vanishes.

    Args:
        scene: with opposite spins and a bar.
        r0: sine of the inclination at the moments when the axes are parallel, with the push.
        momentum: P about the joint line (kg m²/s) less that of the exact paired precession of this r0: a push, by which the pair
            turns. That of the precession is G s²/k to leading order only; with P less G s²/k the law is off at the next order.

    Raises:
        InputError: unless the spins are opposite and there is a bar.
        DomainError: where F_6 and L_4 are more than half of what F and L are with all their leading terms positive, and s² for
            kappa s² where that is larger.
    """
    amplitude = amplitude_of(r0, "slow_frequency")
    push = finite_number(momentum, "slow_frequency: momentum", "kg m²/s")
    if not isinstance(scene, Scene) or scene.link is None or sum(scene.spins) != 0 or scene.spins[0] == 0:
        raise InputError(f"slow_frequency: {scene!r} needs a bar and opposite spins")
    sigma, k2 = scene.sigma, scene.k**2
    s2, d = sigma * amplitude**2, push * scene.k / scene.momenta[0]
    one = _motion(scene, 0.0, 0.0, sqrt(s2), 0.0)
    F_6, L_4 = next_brackets(s2, d, sigma, k2)
    sizes = 1.5 * s2**2 + d**2, abs(d) + max(1.0, abs(one.weight)) * s2
    share = max((abs(n) / size for n, size in zip((F_6, L_4), sizes, strict=True) if n), default=0.0)
    if not share <= LARGEST_SHARE:
        raise DomainError(
            f"slow_frequency: r0 = {r0:g} with k momentum/G = {d:.3g} is beyond the law's range: at k = {scene.k:.3g}, "
            f"sigma = {sigma:.3g} the next order is {share:.2g} of the leading one, more than {LARGEST_SHARE:g}; use "
            "lagrotor.floquet"
        )
    squared = (1.5 * s2**2 - d**2 + F_6) * (d + one.weight * s2 + L_4)
    return abs(one.rate) * complex(squared) ** 0.5
