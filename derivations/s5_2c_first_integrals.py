# %% [markdown]
# # The first integrals A and B (5.12 to 5.14)
#
# **Objective.** A and B from the ansatz Lagrangian by Noether's theorem, and what is left of them on the exact pair,
# where the bar is in force.
#
# **Assumptions.** As printed: equal inertias, $J = I_3 = I$.
#
# **Notation.** $p_i$ the momenta of the pair's own angles; $G_i = I_3 \omega_i$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Scene, Shock, simulate
from lagrotor.algebra import decide_zero
from lagrotor.mechanics import System
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.numerics.convergence import measured_order, swing
from lagrotor.pair.lagrangians import ansatz_integrals, ansatz_lagrangian, pair_with_bar
from lagrotor.pair.symbols import ANSATZ, I1, I3, PAIR, A, B, I, J
from lagrotor.pair.trajectory import ansatz_A
from lagrotor.paper.ledger import chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Formula, Judged

theta_1, theta_2, phi, psi = ANSATZ.q
_, _, phi_v, psi_v = ANSATZ.v
c1, c2, s1, s2 = sp.cos(theta_1), sp.cos(theta_2), sp.sin(theta_1), sp.sin(theta_2)
uniform = {J: I, I1: I, I3: I}
equal = "equal inertias about the joint; the paper's rotor has J = 5/4 and I_3 = 1"

# %% [markdown]
# ## On the ansatz Lagrangian
#
# $\phi$ and $\psi$ are cyclic, so their momenta are exact integrals of that Lagrangian.

# %%
L = ansatz_lagrangian()
assert set(System(ANSATZ, L).cyclic) == {phi, psi}
integral_A, integral_B = ansatz_integrals()
Formula(sp.Matrix([integral_A, integral_B]).expand())

# %% [markdown]
# ## On the exact pair
#
# $A = p_{\phi_1} - p_{\phi_2}$ and $B = p_{\psi_1} - p_{\psi_2}$. Along the constrained motion
# $\frac{d}{dt}(p \cdot \xi) = \delta_\xi L + \lambda\, \nabla g \cdot \xi$: the bar's multiplier enters unless the
# turning leaves the bar's length alone.

# %%
system = pair_with_bar()
turning = {"A": [0, 1, 0, 0, -1, 0], "B": [0, 0, 1, 0, 0, -1]}
rates = {name: system.noether_rate(xi) for name, xi in turning.items()}
conserved = {name: decide_zero(rate).answer for name, rate in rates.items()}
assert conserved == {"A": "nonzero", "B": "zero"}
exact_B = system.noether(turning["B"]).expression
first, second = (theta_1, phi, psi), (theta_2, -phi, -psi)
first_v, second_v = (ANSATZ.v[0], phi_v, psi_v), (ANSATZ.v[1], -phi_v, -psi_v)
on_ansatz = dict(zip((*PAIR.q, *PAIR.v), (*first, *second, *first_v, *second_v), strict=True))
assert decide_zero(exact_B.subs(on_ansatz) - integral_B).answer == "zero"
conserved

# %% [markdown]
# How A drifts is measured on two kinds of motion: the periodic orbit, and the motion after a shock from rest.


# %%
def on_orbit(r0: float) -> float:
    orbit = exact_orbit(Scene(spins=(10, -10)), r0)
    run = simulate(orbit.scene, np.linspace(0, 2 * np.pi / orbit.frequency, 201), "minimal", 1e-13)
    return swing(ansatz_A(run))


def after_shock(scale: float) -> float:
    scene = Scene(spins=(10, -10), shock=Shock((40 * scale, -11 * scale, 0), at=0.5, width=0.05))
    return swing(ansatz_A(simulate(scene, np.linspace(1.0, 3.0, 401), "minimal", 1e-13)))


def B_in_euler(r0: float) -> float:
    orbit = exact_orbit(Scene(spins=(10, -10)), r0)
    run = simulate(orbit.scene, np.linspace(0, 2, 201), "euler", 1e-11)
    return swing(run.momenta[0] - run.momenta[1])


amplitudes = (0.05, 0.1, 0.2)
orbit_drift = [on_orbit(r0) for r0 in amplitudes]
orbit_order = measured_order(amplitudes, orbit_drift)
shocks = (0.0025, 0.005, 0.01)
shock_drift = [after_shock(scale) for scale in shocks]
shock_order = measured_order(shocks, shock_drift)
{"on the orbit": orbit_order, "after a shock": shock_order}

# %% [markdown]
# ## What the paper prints

# %%
printed_A = (
    phi_v * (I1 * s1**2 + I3 * c1**2) + psi_v * I3 * c1 + phi_v * (I1 * s2**2 + I3 * c2**2) + psi_v * I3 * c2,
    2 * phi_v * I + psi_v * I * (c1 + c2),
)
printed_B = (
    phi_v * I * c1 + psi_v * I + phi_v * I * c2 + psi_v * I,
    phi_v * I * (c1 + c2) + 2 * psi_v * I,
)
A_uniform, B_uniform = integral_A.subs(uniform), integral_B.subs(uniform)

statements = [
    stated(
        "5.12",
        chain(integral_A, *printed_A),
        given=uniform,
        condition=equal,
        depends_on=("5.11",),
        evidence=(
            "Exact for the ansatz Lagrangian only. On the pair with its bar dA/dt = lambda (dg/dphi_1 − dg/dphi_2) is not "
            "identically zero (decided).",
            f"On the periodic orbit A swings by {orbit_drift[-1]:.3g} kg m²/s at r_0 = {amplitudes[-1]}, as r_0 to the power "
            f"{orbit_order:.2f}.",
            f"After a shock (40, −11, 0) N, scaled down, its swing goes as the scale to the power {shock_order:.2f}: the bar "
            "then carries a force of first order (massless bar).",
        ),
    ),
    stated(
        "5.13",
        chain(integral_B, *printed_B),
        given=uniform,
        condition="equal inertias",
        depends_on=("5.11",),
        evidence=(
            "Exact for the pair with its bar too: B = p_psi1 − p_psi2, and the bar does not touch the spins (decided). "
            f"Measured in the paper's angles, where psi is integrated: it swings by {B_in_euler(0.2):.1g} kg m²/s in 2 s.",
        ),
    ),
    stated(
        "5.14",
        chain(
            I * psi_v,
            ((A - 2 * phi_v * I) / (c1 + c2)).subs(A, A_uniform),
            ((B - phi_v * I * (c1 + c2)) / 2).subs(B, B_uniform),
        ),
        depends_on=("5.12", "5.13"),
        evidence=("Holds where cos theta_1 + cos theta_2 is not zero.",),
    ),
]
Judged(statements)
