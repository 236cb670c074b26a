# %% [markdown]
# # The rate of precession of the pair (5.15, 5.16)
#
# **Objective.** $\dot\phi$ from $A$ and $B$, the values that the paper gives $A$ and $B$, and the prediction of the formula.
#
# **Assumptions.** Those of $A$ and $B$ (5.12, 5.13), named where they are used. Figure t4 shows the actual rate.
#
# **Notation.** $A = p_{\phi_1} - p_{\phi_2}$, $B = p_{\psi_1} - p_{\psi_2}$; $S = \cos\theta_1 + \cos\theta_2$;
# $\theta_m$ the mean inclination, printed $\bar\theta$, and $\delta$ half the difference; $\omega_i$ the axial velocities.

# %%
import sympy as sp

from lagrotor import Link, Scene, natural_rate
from lagrotor.mechanics import momenta
from lagrotor.pair import ansatz_integrals, axis, pair_with_bar
from lagrotor.pair.notation import ANSATZ, G_1, G_2, I3, PAIR, A, B, G, J, a, b, omega, omega_1, omega_2
from lagrotor.paper import Premise, Remark, Table, prove, verdict
from lagrotor.paper.grammar import rate as moving
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.ansatz import no_bar_force, opposite_azimuths, opposite_spin_angles
from lagrotor.paper.rotor_pair.pair_page import compare_pair, comparison_rows
from lagrotor.paper.rotor_pair.premises import EQUAL_INERTIAS, MASSLESS_BAR, OPPOSITE_SPINS, PAPERS_ROTOR
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.rotor_pair.runs import OPPOSITE
from lagrotor.theory.natural_frequency import natural_frequency

theta_1, theta_2 = ANSATZ.q[:2]
phi_v, psi_v = ANSATZ.v[2:]
S = sp.cos(theta_1) + sp.cos(theta_2)

# %% [markdown]
# ## The rate from the two integrals
#
# Under the ansatz and without a bar, $A$ and $B$ are two linear equations for $\dot\phi$ and $\dot\psi$. Solved for any
# inertias:

# %%
integrals = sp.Matrix(ansatz_integrals())
coefficients = integrals.jacobian([phi_v, psi_v])
rate = sp.factor((coefficients.adjugate() * sp.Matrix([A, B]))[0] / coefficients.det())
tilting = J * (sp.sin(theta_1) ** 2 + sp.sin(theta_2) ** 2) + I3 * (sp.cos(theta_1) ** 2 + sp.cos(theta_2) ** 2)
prove(rate, (2 * A - B * S) / (2 * tilting - I3 * S**2), "the rate from the two integrals", names=r"\dot\phi")

# %% [markdown]
# With $J = I_3$ the denominator is $I(4 - S^2)$, the paper's. Into the printed line $A$ and $B$ are put as they are on the
# pair, under no premise; it must then give back $\dot\phi$.

# %%
on_pair = {s.id: s for s in PAPER.stated("s5_2c_first_integrals")}
massless = natural_rate(Scene(spins=(10, -10)))
heavy = natural_rate(Scene(spins=(10, -10), link=Link(mass=1, inertia=1)))
kept_rates = {name: on_pair[i].derived[name] for i, name in (("5.12", r"\dot A"), ("5.13", r"\dot B"))}
verdict(
    "5.15",
    {r"\dot\phi": phi_v, **kept_rates},
    premises=[MASSLESS_BAR, EQUAL_INERTIAS, opposite_azimuths(), opposite_spin_angles(), no_bar_force()],
    uses=[on_pair["5.12"], on_pair["5.13"], "5.14"],
    evidence=[
        "At the rest state θ₁ = θ₂ = 0 the formula is singular: numerator and denominator are zero.",
        "With the values of A and B (5.16) the formula reduces to φ′ = φ₀′ for any φ₀′, so it does not predict "
        "the rate.",
        f"The equations of motion determine the rate: it is {massless:.4g} rad/s for spins of ±10 rad/s and a massless bar, and "
        f"{heavy:.4g} rad/s with the bar of section 4.1.",
    ],
    form={
        r"\dot\phi": form(
            "(2*A - B*(cos(theta_1) + cos(theta_2)))/(I_3*(4 - (cos(theta_1) + cos(theta_2))**2))",
            A=on_pair["5.12"].derived["A"],
            B=on_pair["5.13"].derived["B"],
        ),
        r"\dot A": form("0"),
        r"\dot B": form("0"),
    },
)

# %% [markdown]
# ## The values of the integrals
#
# In terms of the conserved axial velocities $\omega_i = \dot\psi_i + \dot\phi_i\cos\theta_i$ the integrals are

# %%
p = momenta(pair_with_bar().L, PAIR)
_, phi_1_v, psi_1_v, _, phi_2_v, psi_2_v = PAIR.v
axial = {psi_1_v: omega_1 - phi_1_v * sp.cos(theta_1), psi_2_v: omega_2 - phi_2_v * sp.cos(theta_2)}
value_A, value_B = ((p[i] - p[i + 3]).subs(axial) for i in (1, 2))
prove(value_B, I3 * (omega_1 - omega_2), "B in the axial velocities", names="B")

# %%
prove(
    MASSLESS_BAR.on(value_A),
    J * (phi_1_v * sp.sin(theta_1) ** 2 - phi_2_v * sp.sin(theta_2) ** 2)
    + I3 * (omega_1 * sp.cos(theta_1) - omega_2 * sp.cos(theta_2)),
    "A in the axial velocities, the bar massless",
    names="A",
)

# %% [markdown]
# The paper puts one mean inclination for both. That is right to first order in their difference:

# %%
mean, half = sp.symbols("theta_m delta", real=True)
one_inclination = Premise(
    "the inclinations are nearly equal, θ₁ − θ₂ = 2δ", {theta_1: mean + half, theta_2: mean - half}, small=half
)
phi_1, phi_2 = PAIR.q[1], PAIR.q[4]
r_1, r_2 = axis(theta_1, phi_1), axis(theta_2, phi_2)
axes_and_rates = {
    "hat_r_1": r_1,
    "hat_r_2": r_2,
    "hat_r_1_dot": moving(r_1, PAIR.q, PAIR.v),
    "hat_r_2_dot": moving(r_2, PAIR.q, PAIR.v),
}
own_B = PAPERS_ROTOR.on(value_B).subs(dict(zip((omega_1, omega_2), OPPOSITE, strict=True)))
verdict(
    "5.16",
    {"B": value_B, "A": value_A},
    premises=[MASSLESS_BAR, EQUAL_INERTIAS, OPPOSITE_SPINS, opposite_azimuths(), one_inclination],
    correction={"B": form("I_3*(omega_1 - omega_2)")},
    wrong="B lacks the factor I. The correct value is 2Iω, an angular momentum like A. The printed A needs no correction. "
    f"With the paper's rotor and spins of ±10 rad/s B is {float(own_B):g} kg m²/s.",
    uses=["5.12", "5.13"],
    evidence=[
        "For opposite spins B is 2I₃ω. For the paper's rotor, with I₃ = 1 kg m², the printed value is the same number."
    ],
    form={
        "B": form("I_3*(omega_1 - omega_2)"),
        "A": form(
            "I_3*(omega_1*cos(theta_1) - omega_2*cos(theta_2))"
            " + a*(phi_1_dot*sin(theta_1)**2 - phi_2_dot*sin(theta_2)**2)"
            " + b*dot(hat_z, cross(hat_r_1, hat_r_2_dot) - cross(hat_r_2, hat_r_1_dot))",
            hat_z=sp.Matrix([0, 0, 1]),
            **axes_and_rates,
        ),
    },
)

# %% [markdown]
# ## What the formula then predicts
#
# With equal inclinations, $B = 2I\omega$ and the printed $A$, the formula gives back the $\dot\phi_0$ that was put into $A$,
# for every $\dot\phi_0$:

# %%
level = {theta_1: mean, theta_2: mean}
printed_A = 2 * I3 * (phi_v * sp.sin(mean) ** 2 + omega * sp.cos(mean))
fed_back = rate.subs(J, I3).subs(level).subs({A: printed_A, B: 2 * I3 * omega})
prove(fed_back, phi_v, "the formula with the values of the integrals put in")

# %% [markdown]
# It predicts no rate. The rate comes from the equation of motion that the ansatz leaves out; the linearised equations for
# opposite spins have one oscillation, at

# %%
natural = natural_frequency().expressions[0].subs({G_1: G, G_2: -G})
prove(natural**2, G**2 / (a**2 - b**2), "the square of the natural frequency, opposite spins", names=r"\Omega_0^2")

# %% [markdown]
# ## The formula along the motion
#
# The formula can also be read with the values that $A$ and $B$ have at the start of a motion. Along the paired precession
# $\theta_1$ and $\theta_2$ vary, and $A$ is not conserved, so the formula is off by a small amount.

# %%
pair = compare_pair()
Table(
    "The closed forms of the pair against its integrated motion",
    ("quantity", "error or difference"),
    tuple(comparison_rows(pair)),
    f"The run is one turn of the paired precession, {pair.run.t[-1]:.4f} s, for spins of ±10 rad/s, a massless bar, ℓ = R = 1 m "
    "and the amplitude r_0 = 0.204. The command `lagrotor pair` prints the formulas and these numbers.",
)

# %%
Remark(
    "What the formula of the rate (5.15) says",
    "With the paper's own values of A and B formula (5.15) is the identity φ′ = φ₀′. The actual rate of the paired precession is "
    f"the natural frequency G/√(a² − b²), which is {massless:.4g} rad/s for spins of ±10 rad/s and a massless bar.",
)
