"""The ansatz of section 5.2 as premises. Each says by how much the exact motion of the paper's pair violates it.

The exact motion is the paired precession of figure 21, with a massless bar and with the bar of section 5.2.1. Claim C15 uses
the same numbers.
"""

from lagrotor.pair.lagrangians import pair_with_bar
from lagrotor.pair.notation import ANSATZ, PAIR, theta_0
from lagrotor.paper.premises import Premise

# The multiplier of the bar's constraint: the bar's force.
(BAR_FORCE,) = pair_with_bar().multipliers


def breach() -> dict[str, tuple[float, float]]:
    """Return, for each premise, the relative violation with a massless bar and with the bar of section 5.2.1."""
    import numpy as np  # not at the top, because most derivations need only the premises

    from lagrotor.paper.rotor_pair.runs import MASSLESS, OPPOSITE, PAPER_BAR, PAPER_R0, deviations, once_round

    runs = [once_round(OPPOSITE, PAPER_R0, bar) for bar in (MASSLESS, PAPER_BAR)]
    sines = [np.sin(run.inclinations) for run in runs]
    of_each = [(*deviations(run), float(np.ptp(sine) / sine.mean())) for run, sine in zip(runs, sines, strict=True)]
    return dict(zip(("azimuths", "spin angles", "A", "inclinations"), zip(*of_each, strict=True), strict=True))


def _reaches(premise: str, of: str) -> str:
    from lagrotor.paper.rotor_pair.runs import PAPER_R0

    massless, light = (100 * fraction for fraction in breach()[premise])
    return f"{massless:.0f} % of {of} with a massless bar, {light:.0f} % with that of section 5.2.1, at r₀ = {PAPER_R0}"


def opposite_azimuths() -> Premise:
    """Return the premise that phi_1 = −phi_2 = phi at every time."""
    (_, phi_1, _, _, phi_2, _), (_, phi_1_v, _, _, phi_2_v, _) = PAIR.q, PAIR.v
    phi, phi_v = ANSATZ.q[2], ANSATZ.v[2]
    substitution = {phi_1: phi, phi_2: -phi, phi_1_v: phi_v, phi_2_v: -phi_v}
    broken = f"φ₁′ + φ₂′ reaches {_reaches('azimuths', 'φ′')}"
    return Premise("the azimuths are opposite, φ₁′ = −φ₂′ = φ′", substitution, broken=broken)


def opposite_spin_angles() -> Premise:
    """Return the premise that psi_1 = −psi_2 = psi at every time."""
    (_, _, psi_1, _, _, psi_2), (_, _, psi_1_v, _, _, psi_2_v) = PAIR.q, PAIR.v
    psi, psi_v = ANSATZ.q[3], ANSATZ.v[3]
    substitution = {psi_1: psi, psi_2: -psi, psi_1_v: psi_v, psi_2_v: -psi_v}
    broken = f"ψ₁′ + ψ₂′ reaches {_reaches('spin angles', 'ω')}"
    return Premise("the spin angles have opposite rates, ψ₁′ = −ψ₂′ = ψ′", substitution, broken=broken)


def one_inclination() -> Premise:
    """Return the premise that theta_1 = theta_2 = theta_0 is constant."""
    theta_1, theta_2 = ANSATZ.q[:2]
    broken = f"the swing of sin θ reaches {_reaches('inclinations', 'its mean')}"
    return Premise(
        "the inclinations are one constant, θ₁ = θ₂ = θ₀", {theta_1: theta_0, theta_2: theta_0}, broken=broken
    )


def no_bar_force() -> Premise:
    """Return the premise that the bar exerts no force: lambda = 0."""
    broken = f"the swing of A reaches {_reaches('A', 'the part of A that the motion makes')}"
    return Premise("the bar exerts no force, λ = 0", {BAR_FORCE: 0}, broken=broken)
