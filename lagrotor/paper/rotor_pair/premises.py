"""Premises that several derivations share, and the ansatz of section 5.2: how far the paper's own scene breaks each is computed.

The numbers of the ansatz are those by which claim C15 is decided, on the exact paired precession of figure 21, for the massless
bar of the theory and for the bar of section 5.2.1.
"""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from lagrotor.pair.lagrangians import pair_with_bar
from lagrotor.pair.notation import (
    ANSATZ,
    I1,
    I3,
    PAIR,
    J,
    K,
    M,
    R,
    a,
    b,
    ell,
    m,
    omega,
    omega_1,
    omega_2,
    sigma,
    theta_0,
)
from lagrotor.paper.premises import Premise, parameter_premise, with_meanings
from lagrotor.paper.rotor_pair.symbols import WRITTEN_OUT

# The paper's own rotor and bar (section 4.1), SI units, and the lighter bar of section 5.2.1.
PAPERS_OWN: Mapping[sp.Symbol, sp.Expr] = {I1: 1, I3: 1, M: 1, R: 1, ell: 1, m: 1, K: 1}
LIGHT_BAR: Mapping[sp.Symbol, sp.Expr] = {m: sp.Rational(1, 100), K: sp.Rational(1, 10)}


def in_parameters(expression: Any) -> Any:
    """The expression in the rotor's and the bar's own parameters: a, b, k, J by what they are."""
    return with_meanings(expression, WRITTEN_OUT)


def about_parameters(says: str, put: Mapping[sp.Symbol, Any]) -> Premise:
    """A premise about parameters, such as J = I_3, with how far the paper's own values break it."""
    return parameter_premise(says, put, PAPERS_OWN, WRITTEN_OUT)


def massless_bar() -> Premise:
    """The bar has no mass and no inertia: a = J, b = 0, sigma = 1."""
    own = ", ".join(f"{sp.pretty(s)} = {float(PAPERS_OWN[s]):g} or {float(LIGHT_BAR[s]):g}" for s in (m, K))
    return Premise("the bar is massless, m = K = 0", {a: J, b: 0, sigma: 1, m: 0, K: 0}, broken=own)


# Premises that several derivations share. Where more than one is offered, they are put in in this order.
ABOUT_JOINT = about_parameters("I₁ is read as the transverse inertia about the ground joint, I₁ = J", {I1: J})
MASSLESS_BAR = massless_bar()
EQUAL_INERTIAS = about_parameters("the inertias about the ground joint are equal, J = I₃", {J: I3})
BAR_AS_LONG_AS_ROTORS = about_parameters("the bar is as long as the rotors, ℓ = R", {ell: R})
UNIT_LENGTH = about_parameters("lengths are measured in units of the rotor's, R = 1", {R: 1})
PAPERS_ROTOR = about_parameters("the rotor is the paper's, I₁ = I₃ = M = R = ℓ = 1", {I1: 1, I3: 1, M: 1, R: 1, ell: 1})
ONE_KILOGRAM_BAR = about_parameters("the bar has a mass of 1 kg", {m: 1})
HEAVY_BAR = about_parameters("the bar is that of section 4.1, m = K = 1", {m: 1, K: 1})
LIGHT_BAR_PREMISE = Premise("the bar is that of section 5.2.1, m = 0.01, K = 0.1", LIGHT_BAR)
EQUAL_SPINS = Premise("the spins are equal, ω₁ = ω₂ = ω", {omega_1: omega, omega_2: omega})
OPPOSITE_SPINS = Premise("the spins are opposite, ω₁ = −ω₂ = ω", {omega_1: omega, omega_2: -omega})
# What section 5.2 counts as a mode (claim C24); the conclusion speaks of oscillations, of which there is one (6.01).
TWO_MODES = (
    "to first order in the motion; toppling counts as a mode though it is a steady turning, not an oscillation, and the "
    "displacement of the precession centre, which rests, does not"
)


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
    return Premise("the spin angles turn oppositely, ψ₁′ = −ψ₂′ = ψ′", put, broken=broken)


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
