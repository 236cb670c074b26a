"""The ansatz of section 5.2 as premises: each says by how much the exact paired precession breaks it.

The paper's own scene is its figure 21: spins ±10, r_0 = 0.204, and the light bar of section 5.2.1; the bar without mass is
the one of its theory.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy as sp

from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.pair.lagrangians import pair_with_bar
from lagrotor.pair.scene import Link, Scene
from lagrotor.pair.symbols import ANSATZ, PAIR, theta_0
from lagrotor.pair.trajectory import ansatz_A
from lagrotor.paper.premises import LIGHT_BAR, Premise

AMPLITUDE, SPIN = 0.204, 10.0
# The multiplier of the bar's constraint: the bar's force.
(BAR_FORCE,) = pair_with_bar().multipliers


@dataclass(frozen=True)
class Breach:
    """How far one exact orbit is from the ansatz, each as a fraction.

    azimuths: largest |phi_1' + phi_2'| of the mean |phi'|. spins: largest |psi_1' + psi_2'| of omega. integral: swing of A
    of the mean of A − B, its part that varies with the motion. inclinations: swing of sin theta of its mean.
    """

    azimuths: float
    spins: float
    integral: float
    inclinations: float


@cache
def breach(mass: float, inertia: float) -> Breach:
    """The breach on the orbit of amplitude 0.204, with a bar of this mass and inertia, ell = R."""
    orbit = exact_orbit(Scene(spins=(SPIN, -SPIN), link=Link(1, mass, inertia)), AMPLITUDE)
    run = simulate(orbit.scene, np.linspace(0, 2 * np.pi / orbit.frequency, 401), "minimal", 1e-11)
    (x, y, z), (x_v, y_v, _) = (np.moveaxis(part, -1, 0) for part in (run.axes, run.rates))
    sine = np.hypot(x, y)
    azimuth_v = (x * y_v - y * x_v) / sine**2
    spin_v = np.array(orbit.scene.spins)[:, None] - azimuth_v * z
    A, B = ansatz_A(run), run.momenta[0] - run.momenta[1]
    return Breach(
        float(np.abs(azimuth_v.sum(0)).max() / np.abs(azimuth_v).mean()),
        float(np.abs(spin_v.sum(0)).max() / SPIN),
        float(np.ptp(A) / np.abs(A - B).mean()),
        float(np.ptp(sine) / sine.mean()),
    )


def _reaches(part: str, of: str) -> str:
    massless, light = (100 * getattr(breach(*map(float, bar)), part) for bar in ((0, 0), LIGHT_BAR.values()))
    return (
        f"{massless:.0f} % of {of} with a massless bar, {light:.0f} % with that of section 5.2.1, at r₀ = {AMPLITUDE}"
    )


@cache
def opposite_azimuths() -> Premise:
    """phi_1 = −phi_2 = phi, at every time."""
    (_, phi_1, _, _, phi_2, _), (_, phi_1_v, _, _, phi_2_v, _) = PAIR.q, PAIR.v
    phi, phi_v = ANSATZ.q[2], ANSATZ.v[2]
    put = {phi_1: phi, phi_2: -phi, phi_1_v: phi_v, phi_2_v: -phi_v}
    return Premise(
        "the azimuths are opposite, φ₁′ = −φ₂′ = φ′", put, broken=f"φ₁′ + φ₂′ reaches {_reaches('azimuths', 'φ′')}"
    )


@cache
def opposite_spin_angles() -> Premise:
    """psi_1 = −psi_2 = psi, at every time."""
    (_, _, psi_1, _, _, psi_2), (_, _, psi_1_v, _, _, psi_2_v) = PAIR.q, PAIR.v
    psi, psi_v = ANSATZ.q[3], ANSATZ.v[3]
    put = {psi_1: psi, psi_2: -psi, psi_1_v: psi_v, psi_2_v: -psi_v}
    broken = f"ψ₁′ + ψ₂′ reaches {_reaches('spins', 'ω')}"
    return Premise("the spin angles turn oppositely, ψ₁′ = −ψ₂′ = ψ′", put, broken=broken)


@cache
def one_inclination() -> Premise:
    """theta_1 = theta_2 = theta_0, constant."""
    theta_1, theta_2 = ANSATZ.q[:2]
    broken = f"the swing of sin θ reaches {_reaches('inclinations', 'its mean')}"
    return Premise(
        "the inclinations are one constant, θ₁ = θ₂ = θ₀", {theta_1: theta_0, theta_2: theta_0}, broken=broken
    )


@cache
def no_bar_force() -> Premise:
    """The bar exerts nothing: lambda = 0."""
    broken = f"the swing of A reaches {_reaches('integral', 'A − B')}"
    return Premise("the bar exerts no force, λ = 0", {BAR_FORCE: sp.Integer(0)}, broken=broken)
