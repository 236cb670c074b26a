"""The ansatz of section 5.2 as premises; how far the paper's own motion breaks each is computed.

The numbers are those by which claim C15 is decided, on the exact paired precession of figure 21, for the massless
bar of the theory and for the bar of section 5.2.1.
"""

from lagrotor.pair.lagrangians import pair_with_bar
from lagrotor.pair.notation import ANSATZ, PAIR, theta_0
from lagrotor.paper.premises import Premise

# The multiplier of the bar's constraint: the bar's force.
(BAR_FORCE,) = pair_with_bar().multipliers


def breach() -> dict[str, tuple[float, float]]:
    """What breaks each premise, as a fraction, with a massless bar and with that of section 5.2.1.

    azimuths, spin angles, A: as `deviations`. inclinations: swing of sin theta over its mean.
    """
    import numpy as np  # here, since most derivations need the premises only

    from lagrotor.paper.rotor_pair.runs import MASSLESS, OPPOSITE, PAPER_BAR, PAPER_R0, deviations, once_round

    runs = [once_round(OPPOSITE, PAPER_R0, bar) for bar in (MASSLESS, PAPER_BAR)]
    sines = [np.sin(run.inclinations) for run in runs]
    of_each = [(*deviations(run), float(np.ptp(sine) / sine.mean())) for run, sine in zip(runs, sines, strict=True)]
    return dict(zip(("azimuths", "spin angles", "A", "inclinations"), zip(*of_each, strict=True), strict=True))


def _reaches(part: str, of: str) -> str:
    from lagrotor.paper.rotor_pair.runs import PAPER_R0

    massless, light = (100 * fraction for fraction in breach()[part])
    return f"{massless:.0f} % of {of} with a massless bar, {light:.0f} % with that of section 5.2.1, at r₀ = {PAPER_R0}"


def opposite_azimuths() -> Premise:
    """phi_1 = −phi_2 = phi, at every time."""
    (_, phi_1, _, _, phi_2, _), (_, phi_1_v, _, _, phi_2_v, _) = PAIR.q, PAIR.v
    phi, phi_v = ANSATZ.q[2], ANSATZ.v[2]
    put = {phi_1: phi, phi_2: -phi, phi_1_v: phi_v, phi_2_v: -phi_v}
    broken = f"φ₁′ + φ₂′ reaches {_reaches('azimuths', 'φ′')}"
    return Premise("the azimuths are opposite, φ₁′ = −φ₂′ = φ′", put, broken=broken)


def opposite_spin_angles() -> Premise:
    """psi_1 = −psi_2 = psi, at every time."""
    (_, _, psi_1, _, _, psi_2), (_, _, psi_1_v, _, _, psi_2_v) = PAIR.q, PAIR.v
    psi, psi_v = ANSATZ.q[3], ANSATZ.v[3]
    put = {psi_1: psi, psi_2: -psi, psi_1_v: psi_v, psi_2_v: -psi_v}
    broken = f"ψ₁′ + ψ₂′ reaches {_reaches('spin angles', 'ω')}"
    return Premise("the spin angles have opposite rates, ψ₁′ = −ψ₂′ = ψ′", put, broken=broken)


def one_inclination() -> Premise:
    """theta_1 = theta_2 = theta_0, constant."""
    theta_1, theta_2 = ANSATZ.q[:2]
    broken = f"the swing of sin θ reaches {_reaches('inclinations', 'its mean')}"
    return Premise(
        "the inclinations are one constant, θ₁ = θ₂ = θ₀", {theta_1: theta_0, theta_2: theta_0}, broken=broken
    )


def no_bar_force() -> Premise:
    """The bar exerts nothing: lambda = 0."""
    broken = f"the swing of A reaches {_reaches('A', 'the part of A that the motion makes')}"
    return Premise("the bar exerts no force, λ = 0", {BAR_FORCE: 0}, broken=broken)
