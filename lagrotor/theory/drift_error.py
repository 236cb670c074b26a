"""Errors of the closed forms for the slow motion after a shock: their next order, and how the motion leaves its start.

With q² = (p_x² + sigma p_y²)/G², P = −p_y the momentum about the joint line, S = |G| q²/(2k) what a twist takes of it,
the next orders are, for the rate of turning and for the rate of the mean x,

    ( |G| q⁴ (c_1/k + c_2/k³) + |P| q² (c_3 + c_4/k²) ) / (a + b),
    ( |G| q⁵ (c_1 + c_2/k⁴) + |P| q³ (c_3 + c_4/k²) ) / (a + b),

with empirical factors c (`theory.calibrated_factors`). In the time T the mean x grows to X = |X'| T. That lowers the inertia
about the joint line by the factor 1 − X², and turning at alpha' carries X back into the twist, by
alpha' (|P| + S) X T / (2 |G|) (derivations/t6_shock_drift.py); both change the rates. So what a run gives depends on how
long one averages.
"""

from dataclasses import dataclass, replace
from math import sqrt

from lagrotor.errors import DomainError, InputError
from lagrotor.pair.scene import Scene
from lagrotor.theory.calibrated_factors import CANCELLING, FARTHEST_TURN, FIFTH_ORDER, FOURTH_ORDER, LARGEST_SWING
from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock, wander_after_shock
from lagrotor.theory.shock_response import shock_response

# What the factors were calibrated on, and held for by 600 pairs from end to end of it: ell/R,
# sigma (a bar's weight and shape), the pulse's width over the swing's 1/Omega_0.
BARS, SHAPES, BROADEST = (0.4, 2.5), (0.3, 3.0), 1.2


@dataclass(frozen=True)
class _Drift:
    """What the errors are made of. size: q. momentum: |P|. taken: S (N m s). twist: |p_x/G|. length: |x| grown to. change: of
    the twist (rad), both after the duration."""

    size: float
    momentum: float
    taken: float
    spin: float
    inertia: float
    ratio: float
    twist: float
    length: float
    change: float


def toppling_error(scene: Scene, duration: float) -> float:
    """Error (rad/s) of `toppling_after_shock` as the mean rate over `duration` s from the pulse's peak.

    Raises as `toppling_after_shock`; DomainError where the shock or the duration is out of the range that was calibrated:
    q > 0.4, a turn by more than 3 rad, a mean x beyond 0.5; a bar shorter than 0.4 or longer than 2.5 axes, or of sigma below
    0.3 or above 3; a pulse wider than 1.2/Omega_0.
    """
    d = _drift(scene, duration, "toppling_error")
    c, k = FOURTH_ORDER.value, d.ratio
    fourth = d.spin * d.size**4 * (c[0] / k + c[1] / k**3) + d.momentum * d.size**2 * (c[2] + c[3] / k**2)
    slow = (d.momentum + d.taken) * d.length**2 / 2 + d.spin * d.twist * d.change / (2 * k)
    return (fourth + slow) / d.inertia


def wander_error(scene: Scene, duration: float) -> float:
    """Error (1/s) of `wander_after_shock` as the mean rate of x over `duration` s from the pulse's peak.

    Raises as `toppling_error`.
    """
    d = _drift(scene, duration, "wander_error")
    c, k = FIFTH_ORDER.value, d.ratio
    fifth = d.spin * d.size**5 * (c[0] + c[1] / k**4) + d.momentum * d.size**3 * (c[2] + c[3] / k**2)
    slow = (d.momentum + d.taken) / (2 * k) * (d.change + d.twist * d.length**2)
    return (fifth + slow) / d.inertia


def cancelling_force_error(scene: Scene, duration: float) -> float:
    """How far (N) `cancelling_force` may lie from the force that leaves no mean turning over `duration` s after the pulse's
    peak: c q² (1 + 1/k²) of itself, q of both forces; c is empirical. Raises as `toppling_error`."""
    if scene.shock is None:
        raise InputError("cancelling_force_error: the scene has no shock")
    force = cancelling_force(scene)
    shock = replace(scene.shock, force=(scene.shock.force[0], force, 0.0))
    d = _drift(replace(scene, shock=shock), duration, "cancelling_force_error")
    return CANCELLING.value * d.size**2 * (1 + 1 / d.ratio**2) * abs(force)


def _drift(scene: Scene, duration: float, where: str) -> _Drift:
    turning, wander = toppling_after_shock(scene), abs(wander_after_shock(scene))
    response, (a, b) = shock_response(scene), scene.inertias
    assert scene.link is not None
    spin, k = abs(scene.momenta[0]), scene.k
    assert scene.shock is not None
    broad = response.frequency * scene.shock.width
    if not (BARS[0] <= k <= BARS[1] and SHAPES[0] <= scene.sigma <= SHAPES[1] and broad <= BROADEST):
        raise DomainError(
            f"{where}: ell/R = {k:.3g} ({BARS[0]:g} to {BARS[1]:g}), sigma = {scene.sigma:.3g} ({SHAPES[0]:g} to {SHAPES[1]:g}), "
            f"width Omega_0 = {broad:.3g} (at most {BROADEST:g}): beyond the pairs that the next order was calibrated on; run it "
            "with lagrotor.simulate, or follow the mean by lagrotor.theory.slow_motion"
        )
    p_x, p_y = abs(float(response.impulse[0])), abs(float(response.impulse[1] + response.impulse[2]))
    size = sqrt(p_x**2 + (a + b) / (a - b) * p_y**2) / spin
    taken, length, turn = spin * size**2 / (2 * k), wander * duration, abs(turning) * duration
    if not (size <= LARGEST_SWING.value and turn <= FARTHEST_TURN.value and length <= 0.5):
        raise DomainError(
            f"{where}: q = {size:.3g} (at most {LARGEST_SWING.value:g}), a turn by {turn:.3g} rad (3) and a mean x of "
            f"{length:.3g} R (0.5) within {duration:g} s: out of the range of validity; take a smaller shock or a shorter "
            "duration, or run it with lagrotor.simulate"
        )
    change = turn * (p_y + taken) * length / (2 * spin)
    return _Drift(size, p_y, taken, spin, a + b, k, p_x / spin, length, change)
