# %% [markdown]
# # The first integrals A and B (5.12 to 5.14)
#
# **Objective.** $A$ and $B$ by Noether's theorem, and their conservation on the exact pair, where the bar acts.
#
# **Assumptions.** Equal rotors, ideal joints, no gravity, any bar. Further assumptions of the paper are named where they are
# used. Figure t10 shows how far $A$, $B$ and the exact integrals are conserved.
#
# **Notation.** $p_i$ the momenta of the pair's own angles; $g = 0$ the bar's constraint and $\lambda$ its multiplier, the
# bar's force; $\omega_i = \dot\psi_i + \dot\phi_i\cos\theta_i$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Scene, Shock, simulate
from lagrotor.mechanics import momenta
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order, swing
from lagrotor.pair import ansatz_A, axis, pair_with_bar
from lagrotor.pair.notation import ANSATZ, I3, PAIR
from lagrotor.paper import prove, verdict
from lagrotor.paper.grammar import rate
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.ansatz import BAR_FORCE, no_bar_force, opposite_azimuths, opposite_spin_angles
from lagrotor.paper.rotor_pair.premises import ABOUT_JOINT, EQUAL_INERTIAS, MASSLESS_BAR

theta_1, phi_1, _, theta_2, phi_2, _ = PAIR.q
_, phi_1_v, psi_1_v, _, phi_2_v, psi_2_v = PAIR.v
_, _, phi_v, psi_v = ANSATZ.v

# %% [markdown]
# ## The momenta of the ansatz
#
# In the ansatz $\phi_1 = \phi$ and $\phi_2 = -\phi$, likewise $\psi_1 = \psi$ and $\psi_2 = -\psi$. So the momenta of $\phi$ and
# $\psi$ in the ansatz Lagrangian are differences of the pair's momenta,
# $\partial\mathcal L/\partial\dot\phi = p_{\phi_1} - p_{\phi_2}$ and
# $\partial\mathcal L/\partial\dot\psi = p_{\psi_1} - p_{\psi_2}$:

# %%
system = pair_with_bar()
p = momenta(system.L, PAIR)
A, B = p[1] - p[4], p[2] - p[5]
ansatz = [opposite_azimuths(), opposite_spin_angles()]
on_ansatz = {left: right for premise in ansatz for left, right in premise.put.items()}
ansatz_lagrangian, of_ansatz_A, of_ansatz_B = (e.xreplace(on_ansatz) for e in (system.L, A, B))
prove(
    (ansatz_lagrangian.diff(phi_v), ansatz_lagrangian.diff(psi_v)),
    (of_ansatz_A, of_ansatz_B),
    "the momenta of the ansatz Lagrangian as differences of the pair's",
    equations=(
        r"\frac{\partial\mathcal L}{\partial\dot\phi} = p_{\phi_1} - p_{\phi_2}",
        r"\frac{\partial\mathcal L}{\partial\dot\psi} = p_{\psi_1} - p_{\psi_2}",
    ),
)

# %% [markdown]
# ## The rates of $A$ and $B$
#
# Along a motion with constraint forces $\frac{d}{dt}(p\cdot\xi) = \delta_\xi\mathcal L + \lambda\,\nabla g\cdot\xi$. The
# rotation $\xi$ of the spin angles changes neither the Lagrangian nor the bar's length, so $B$ is constant on the exact pair:

# %%
of_B = system.noether_rate([0, 0, 1, 0, 0, -1])
prove(of_B, 0, "the rate of B", names=r"\dot B")

# %% [markdown]
# It is the axial momentum $I_3(\omega_1 - \omega_2)$:

# %%
prove(
    B,
    I3 * (psi_1_v + phi_1_v * sp.cos(theta_1)) - I3 * (psi_2_v + phi_2_v * sp.cos(theta_2)),
    "B in the axial velocities",
    names="B",
)

# %% [markdown]
# Opposite rotations of the azimuths change the length of the bar, so the bar's force changes $A$. For $b \neq 0$ the inertia of
# the bar changes it, too. For a massless bar:

# %%
of_A = system.noether_rate([0, 1, 0, 0, -1, 0])
constraint = system.constraints[0]
prove(
    MASSLESS_BAR.on(of_A),
    BAR_FORCE * (constraint.diff(phi_1) - constraint.diff(phi_2)),
    "the rate of A, the bar massless",
    equations=r"\dot A = \lambda_1\Big(\frac{\partial g}{\partial\phi_1} - \frac{\partial g}{\partial\phi_2}\Big)",
)

# %% [markdown]
# The oscillation of $A$ is measured on two kinds of motion with a massless bar: the periodic orbit, and the motion after a shock
# from rest.


# %%
def swing_on_orbit(amplitude: float) -> float:
    orbit = exact_orbit(Scene(spins=(10, -10)), amplitude)
    return swing(ansatz_A(simulate(orbit.scene, np.linspace(0, 2 * np.pi / orbit.frequency, 201), "minimal", 1e-12)))


def swing_after_shock(scale: float) -> float:
    scene = Scene(spins=(10, -10), shock=Shock((40 * scale, -11 * scale, 0), at=0.5, width=0.05))
    return swing(ansatz_A(simulate(scene, [0.0, *np.linspace(1.0, 3.0, 401)], "minimal", 1e-12).after(1.0)))


amplitudes, scales = (0.05, 0.1, 0.2), (0.0025, 0.005, 0.01)
orbit_order = measured_order(amplitudes, [swing_on_orbit(r0) for r0 in amplitudes])
shock_order = measured_order(scales, [swing_after_shock(scale) for scale in scales])
(
    f"On the orbit the oscillation of A is proportional to the amplitude to the power {orbit_order:.2f}. After a shock it is "
    f"proportional to the force to the power {shock_order:.2f}."
)

# %% [markdown]
# ## $A$ and $B$ as printed

# %%
r_1, r_2 = axis(theta_1, phi_1), axis(theta_2, phi_2)
axes_and_rates = {
    "hat_r_1": r_1,
    "hat_r_2": r_2,
    "hat_r_1_dot": rate(r_1, PAIR.q, PAIR.v),
    "hat_r_2_dot": rate(r_2, PAIR.q, PAIR.v),
}
A_written = form(
    "I_3*(omega_1*cos(theta_1) - omega_2*cos(theta_2))"
    " + a*(phi_1_dot*sin(theta_1)**2 - phi_2_dot*sin(theta_2)**2)"
    " + b*dot(hat_z, cross(hat_r_1, hat_r_2_dot) - cross(hat_r_2, hat_r_1_dot))",
    omega_1=psi_1_v + phi_1_v * sp.cos(theta_1),
    omega_2=psi_2_v + phi_2_v * sp.cos(theta_2),
    hat_z=sp.Matrix([0, 0, 1]),
    **axes_and_rates,
)
integral_A = verdict(
    "5.12",
    {"A": A, r"\dot A": of_A},
    premises=[ABOUT_JOINT, MASSLESS_BAR, EQUAL_INERTIAS, *ansatz, no_bar_force()],
    uses=["5.11"],
    evidence=[
        "A is an integral only of the ansatz Lagrangian; on the pair the force of the bar changes it.",
        "With a massless bar the oscillation of A is proportional to r₀ to the power "
        f"{orbit_order:.2f} on the periodic orbit. After the shock of 5.2.1, scaled down, it is proportional to the shock to the "
        f"power {shock_order:.2f}.",
    ],
    form={"A": A_written, r"\dot A": form("0")},
)
integral_A

# %%
integral_B = verdict(
    "5.13",
    {"B": B, r"\dot B": of_B},
    premises=ansatz,
    uses=["5.11"],
    evidence=[
        "On the exact pair B = I₃(ω₁ − ω₂) is constant for every bar and all inertias, if I₃ is taken for the paper's I.",
    ],
    form={
        "B": form("I_3*(psi_1_dot + phi_1_dot*cos(theta_1) - psi_2_dot - phi_2_dot*cos(theta_2))"),
        r"\dot B": form("0"),
    },
)
integral_B

# %% [markdown]
# ## Elimination of $\dot\psi$
#
# Each integral is linear in $\dot\psi$. With $A$ and $B$ as they were derived:

# %%
verdict(
    "5.14",
    I3 * psi_v,
    premises=[MASSLESS_BAR, EQUAL_INERTIAS, *ansatz],
    uses=[integral_A, integral_B],
    form=form("(B - I_3*phi_dot*(cos(theta_1) + cos(theta_2)))/2", B=B),
)
