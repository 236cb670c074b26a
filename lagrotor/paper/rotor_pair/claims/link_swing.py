"""Claims of section 5.2: the swing of the link under the ansatz, its correction, and the rate after it (C16, C17)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.simulate import simulate
from lagrotor.numerics.curves import measured_order
from lagrotor.pair.quantities import Spins
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.precession_runs import (
    AMPLITUDES,
    EQUAL,
    MASSLESS,
    OPPOSITE,
    PAPER_R0,
    once_round,
    precession_scene,
)
from lagrotor.paper.rotor_pair.claims.proved_parts import rate_changes

Array = NDArray[np.float64]
AS_PRINTED = 1e-3  # of the length, in m: what the printed four digits of figure 18 could show
HIGHER = 2.5  # the correction is of order r₀²: a swing left with a power well above 2 is removed to that order
UNCHANGED = 0.1  # of r₀², the order of the correction

SWINGS, REMOVED = "with θ constant the link length swings from 1 to √(1 + 4 sin²θ₀)", "the correction removes the swing"
SAME_RATE = "the precession rate is unchanged by the correction"


@dataclass(frozen=True)
class Correction:
    """Spins (rad/s), and the sign of the correction: +1 as printed in 5.20, −1 the other way round."""

    spins: Spins = OPPOSITE
    sign: int = 1


def _length(phi: Array, s1: Array, s2: Array) -> Array:
    """Distance of the tips (m) with azimuths ±phi and inclinations of sines s1, s2, for ℓ = R = 1 m and equal heights."""
    return np.hypot(1 + np.cos(phi) * (s2 - s1), np.sin(phi) * (s1 + s2))


def _lengths(run: Trajectory, r0: float, sign: int) -> tuple[Array, Array]:
    """The link's length over a run with θ constant, and corrected; phi is half the difference of the two azimuths."""
    phi = (run.azimuths[0] - run.azimuths[1]) / 2
    change = sign * r0**2 * np.cos(phi)
    return _length(phi, r0 + 0 * phi, r0 + 0 * phi), _length(phi, r0 - change, r0 + change)


def measure_c16(case: Correction) -> dict[str, float]:
    """The ansatz applied to the exact orbit: the length that the link then has, beside that of the exact orbit."""
    run = once_round(case.spins, PAPER_R0, MASSLESS)
    constant, corrected = _lengths(run, PAPER_R0, case.sign)
    left = [np.ptp(_lengths(once_round(case.spins, r0, MASSLESS), r0, case.sign)[1]) for r0 in AMPLITUDES]
    return {
        "constant_theta_shortest": constant.min(),
        "constant_theta_longest": constant.max(),
        "printed_longest": (1 + 4 * PAPER_R0**2) ** 0.5,
        "corrected_shortest": corrected.min(),
        "corrected_longest": corrected.max(),
        "order_of_the_swing_left": measured_order(AMPLITUDES, np.maximum(left, 1e-15)),
        "exact_orbit_shortest": run.link_length.min(),
        "exact_orbit_longest": run.link_length.max(),
    }


def decide_c16(m: Mapping[str, float]) -> Finding:
    """Both ends of the swing as printed; the swing that the correction leaves, and its power in r₀."""
    swing = m["constant_theta_longest"] - m["constant_theta_shortest"]
    left = m["corrected_longest"] - m["corrected_shortest"]
    ends = (m["constant_theta_shortest"] - 1, m["constant_theta_longest"] - m["printed_longest"])
    least, most = (m[f"corrected_{end}"] / m["exact_orbit_longest"] - 1 for end in ("shortest", "longest"))
    needs = f"to order r₀², and for the swing only: the length itself is not kept, the link is {least:.1%} too long throughout"
    return Finding(
        (
            Part(SWINGS, max(map(abs, ends)) < AS_PRINTED),
            Part(REMOVED, left < AS_PRINTED, needs if m["order_of_the_swing_left"] > HIGHER else ""),
        ),
        f"The swing: with θ constant and φ₁ = −φ₂ the link goes from {m['constant_theta_shortest']:.4f} to "
        f"{m['constant_theta_longest']:.4f} m (printed {m['printed_longest']:.4f}), corrected from "
        f"{m['corrected_shortest']:.4f} to {m['corrected_longest']:.4f} m, so that of {swing:.4f} m {left:.4f} are left, "
        f"which go as r₀ to the power {m['order_of_the_swing_left']:.2f}. The length: on the exact orbit it is "
        f"{m['exact_orbit_longest']:.4f} m throughout; corrected it is {least:.1%} to {most:.1%} too long throughout, where "
        "uncorrected it was right twice in a cycle. The correction makes the link steady at a wrong length: it does not "
        "satisfy the constraint for which it is made.",
    )


def measure_c17(spins: Spins) -> dict[str, float]:
    """The exact rate over that of constant inclination, G/(J cos θ_0), at three amplitudes, massless bar.

    Opposite spins on their orbit; any other spins by how fast both axes go round the vertical.
    """
    measured, changes = {}, []
    for r0 in AMPLITUDES:
        scene, rate = precession_scene(spins, r0, MASSLESS)
        constant = abs(scene.momenta[0]) / (scene.rotor.J * (1 - r0**2) ** 0.5)
        if spins[0] != -spins[1]:
            run = simulate(scene, np.linspace(0, 5, 101), "minimal", 1e-11)
            rate = abs(run.azimuths[0, -1] - run.azimuths[0, 0]) / 5
        changes.append(rate / constant - 1)
        measured[f"rate_over_constant_inclination_r0_{r0}"] = rate / constant
    return measured | {
        "change_over_r0_squared": changes[0] / AMPLITUDES[0] ** 2,
        "order_of_change": measured_order(AMPLITUDES, np.maximum(np.abs(changes), 1e-15)),
        f"rate_over_natural_r0_{PAPER_R0}": rate * scene.rotor.J / abs(scene.momenta[0]),
    }


def decide_c17(m: Mapping[str, float]) -> Finding:
    """The change of the rate over r₀²."""
    return Finding(
        (Part(SAME_RATE, abs(m["change_over_r0_squared"]) < UNCHANGED),),
        f"The exact rate is that of constant inclination times 1 {m['change_over_r0_squared']:+.3f} r₀² (the change goes as "
        f"r₀ to the power {m['order_of_change']:.2f}); at r₀ = {PAPER_R0} it is "
        f"{m[f'rate_over_constant_inclination_r0_{PAPER_R0}']:.4f} of it, and {m[f'rate_over_natural_r0_{PAPER_R0}']:.4f} of "
        "the natural rate.",
    )


C16 = ClaimTest(
    "C16",
    Correction(),
    {SWINGS: Correction(EQUAL), REMOVED: Correction(sign=-1)},
    "exact orbit, massless bar",
    measure_c16,
    decide_c16,
    unproved="it is about the ansatz, which is no motion of the pair; equations 5.19 and 5.20 are decided exactly",
)
C17 = ClaimTest(
    "C17",
    OPPOSITE,
    {SAME_RATE: EQUAL},
    "exact orbits, massless bar",
    measure_c17,
    decide_c17,
    lambda spins: rate_changes(SAME_RATE, Scene(spins, link=MASSLESS), PAPER_R0, UNCHANGED),
)
