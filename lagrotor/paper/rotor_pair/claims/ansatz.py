"""Claims of section 5.2: the ansatz and its integrals (C15), the swing of the link under it, its correction, and the rate after
that (C16, C17)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.system import paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import measured_order
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, STEP, STIFFNESS
from lagrotor.pair.quantities import Spins
from lagrotor.pair.scene import Link, Scene
from lagrotor.pair.trajectory import Trajectory, ansatz_A
from lagrotor.paper.claim_tests import ClaimTest, Finding, Part
from lagrotor.paper.rotor_pair.claims.proved_parts import rate_changes
from lagrotor.paper.rotor_pair.shocked_runs import (
    AMPLITUDES,
    EQUAL,
    MASSLESS,
    OPPOSITE,
    PAPER_BAR,
    PAPER_R0,
    once_round,
    precession_scene,
)
from lagrotor.shown import scientific

WITHIN = 0.05  # "agrees", "constant": to one part in twenty, the difference that two curves drawn over each other do not show
VANISHES = 0.9  # the power in r₀ of a relative deviation that goes to zero with the amplitude; 1 is the next order
_ROUNDING = 1e-9  # of B, over half a second in steps of 1 ms
AS_PRINTED = 1e-3  # of the length, in m: what the printed four digits of figure 18 could show
HIGHER = 2.5  # the correction is of order r₀²: a swing left with a power well above 2 is removed to that order
UNCHANGED = 0.1  # of r₀², the order of the correction

AZIMUTHS, SPIN_ANGLES = "φ₁′ = −φ₂′", "ψ₁′ = −ψ₂′"
A_CONSTANT, B_CONSTANT = "A is a constant of the motion", "B is a constant of the motion"
SWINGS, REMOVED = "with θ constant the link length swings from 1 to √(1 + 4 sin²θ₀)", "the correction removes the swing"
SAME_RATE = "the precession rate is unchanged by the correction"


@dataclass(frozen=True)
class Ansatz:
    """Spins (rad/s), and the bar that the theory is given; the bar of 5.2.1 is run beside it.

    I2_over_I1: ratio of the transverse inertias of rotor 1, by which B is measured; 1 for a symmetric rotor.
    """

    spins: Spins = OPPOSITE
    bar: Link = MASSLESS
    I2_over_I1: float = 1.0


def deviations(run: Trajectory) -> tuple[float, float, float]:
    """max |φ₁′ + φ₂′| over the mean |φ′|; max |ψ₁′ + ψ₂′| over the spin; swing of A over the part that the motion makes."""
    (x, y, z), (vx, vy, _) = np.moveaxis(run.axes, -1, 0), np.moveaxis(run.rates, -1, 0)
    phi = (x * vy - y * vx) / (x**2 + y**2)
    psi = run.momenta / run.scene.rotor.I3 - phi * z
    A, at_rest = ansatz_A(run), sum(abs(G) for G in run.scene.momenta)
    return (
        float(abs(phi[0] + phi[1]).max() / abs(phi).mean()),
        float(abs(psi[0] + psi[1]).max() / max(map(abs, run.scene.spins))),
        float(np.ptp(A) / abs(A.mean() - at_rest)),
    )


def _drift_of_b(spins: Spins, I2_over_I1: float) -> float:
    """Largest change of B = G_1 − G_2 over |G_1| + |G_2| in the paper's program, which does not presume it, on the orbit."""
    scene, _ = precession_scene(spins, PAPER_R0, HEAVY_LINK)
    system = paper_system(scene, STIFFNESS, DAMPING)
    system.inverse_inertia[0, 1, 1] /= I2_over_I1
    B = []
    for _ in range(round(0.5 / STEP)):  # half a second
        B.append(system.L[0] @ system.R[0][:, 2] - system.L[1] @ system.R[1][:, 2])
        system.compute_forces()
        system.step(STEP)
    return float(np.ptp(B) / sum(map(abs, scene.momenta)))


def measure_c15(case: Ansatz) -> dict[str, float]:
    """Deviations from the ansatz and swing of A on precessions of three amplitudes, their powers in r₀; drift of B.

    Where the deviation of the azimuths vanishes with r₀, the amplitude at which it is WITHIN is found by two secant steps.
    """
    measured: dict[str, float] = {}
    what = ("azimuth_rates_sum", "spin_rates_sum", "swing_of_A")
    for name, bar in (("massless", case.bar), ("light_bar", PAPER_BAR)):
        seen = np.array([deviations(once_round(case.spins, r0, bar)) for r0 in AMPLITUDES])
        for k, quantity in enumerate(what):
            measured[f"{quantity}_relative_r0_{PAPER_R0}_{name}"] = seen[-1, k]
            measured[f"order_of_{quantity}_relative_{name}"] = measured_order(AMPLITUDES, np.maximum(seen[:, k], 1e-15))
        if measured[f"order_of_azimuth_rates_sum_relative_{name}"] > VANISHES:
            r0, off = AMPLITUDES[0], seen[0]
            for _ in range(2):
                r0 *= WITHIN / off[0]
                off = np.array(deviations(once_round(case.spins, r0, bar)))
            measured[f"r0_at_which_the_azimuth_sum_is_5_percent_{name}"] = r0
            measured |= {f"{quantity}_relative_there_{name}": off[k] for k, quantity in enumerate(what)}
    return measured | {"drift_of_B_relative": _drift_of_b(case.spins, case.I2_over_I1)}


def _small(m: Mapping[str, float], quantity: str) -> Part:
    """One half of the ansatz: it holds at the paper's amplitude, or below the one at which the azimuths are WITHIN."""
    key = f"{quantity}_rates_sum_relative"
    seen = [m[f"{key}_r0_{PAPER_R0}_{name}"] for name in ("massless", "light_bar")]
    vanishes = all(m[f"order_of_{key}_{name}"] > VANISHES for name in ("massless", "light_bar"))
    below = min((m[k] for k in m if k.startswith("r0_at_which")), default=0.0)
    needs = (
        f"r₀ below {below:.3f}, for the ansatz within {WITHIN:.0%} (at the paper's {PAPER_R0} φ₁′ + φ₂′ is up to "
        f"{m[f'azimuth_rates_sum_relative_r0_{PAPER_R0}_massless']:.0%} of φ′)"
    )
    says = AZIMUTHS if quantity == "azimuth" else SPIN_ANGLES
    return Part(says, max(seen) < WITHIN, needs if vanishes and below else "")


def decide_c15(m: Mapping[str, float]) -> Finding:
    """Both sums and the swing of A at the paper's amplitude, with their powers in r₀, for both bars; the drift of B."""
    massless, light = (m[f"swing_of_A_relative_r0_{PAPER_R0}_{name}"] for name in ("massless", "light_bar"))
    needs = (
        f"for A a massless bar: within {massless:.1%} at r₀ = {PAPER_R0}, where with the paper's light bar it swings by "
        f"{light:.0%} of its varying part at any amplitude"
    )
    parts = (
        _small(m, "azimuth"),
        _small(m, "spin"),
        Part(A_CONSTANT, max(massless, light) < WITHIN, needs if massless < WITHIN else ""),
        Part(B_CONSTANT, m["drift_of_B_relative"] < _ROUNDING),
    )
    how = (
        f"At r₀ = {PAPER_R0} φ₁′ + φ₂′ reaches {m[f'azimuth_rates_sum_relative_r0_{PAPER_R0}_massless']:.0%} of φ′ "
        f"({m[f'azimuth_rates_sum_relative_r0_{PAPER_R0}_light_bar']:.0%} with the light bar) and ψ₁′ + ψ₂′ "
        f"{m[f'spin_rates_sum_relative_r0_{PAPER_R0}_massless']:.0%} of the spin; they go as r₀ to the power "
        f"{m['order_of_azimuth_rates_sum_relative_massless']:.2f} and {m['order_of_spin_rates_sum_relative_massless']:.2f}. "
        f"A swings by {massless:.1%} of the part that the motion makes, as r₀ to the power "
        f"{m['order_of_swing_of_A_relative_massless']:.2f}; with the light bar by {light:.0%}, as r₀ to the power "
        f"{m['order_of_swing_of_A_relative_light_bar']:.2f}: at any amplitude. B drifts by "
        f"{scientific(m['drift_of_B_relative'])} of itself."
    )
    if "r0_at_which_the_azimuth_sum_is_5_percent_light_bar" not in m:
        return Finding(parts, how)
    r0, light_r0 = (m[f"r0_at_which_the_azimuth_sum_is_5_percent_{name}"] for name in ("massless", "light_bar"))
    return Finding(
        parts,
        f"{how} At r₀ = {r0:.3f} ({light_r0:.3f} with the light bar) φ₁′ + φ₂′ is {WITHIN:.0%} of φ′, ψ₁′ + ψ₂′ "
        f"{m['spin_rates_sum_relative_there_massless']:.1%} of the spin, and A swings by "
        f"{m['swing_of_A_relative_there_massless']:.2%} of its varying part "
        f"({m['swing_of_A_relative_there_light_bar']:.0%} with the light bar).",
    )


# With the light bar in place of the theory's, A has no small amplitude at which it is constant. A rotor of unequal transverse
# inertias has no axial momentum that is conserved.
C15 = ClaimTest(
    "C15",
    Ansatz(),
    {
        AZIMUTHS: Ansatz(EQUAL),
        SPIN_ANGLES: Ansatz(EQUAL),
        A_CONSTANT: Ansatz(bar=PAPER_BAR),
        B_CONSTANT: Ansatz(I2_over_I1=1.1),
    },
    "exact orbits; the paper's program for B",
    measure_c15,
    decide_c15,
    unproved="it is a likeness to what is observed; equations 5.11 to 5.13 are decided exactly",
)


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
        f"Unchanged is within {UNCHANGED} r₀². The exact rate is that of constant inclination times 1 "
        f"{m['change_over_r0_squared']:+.3f} r₀² (the change goes as r₀ to the power {m['order_of_change']:.2f}); at r₀ = "
        f"{PAPER_R0} it is {m[f'rate_over_constant_inclination_r0_{PAPER_R0}']:.4f} of it, and "
        f"{m[f'rate_over_natural_r0_{PAPER_R0}']:.4f} of the natural rate.",
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
