# %% [markdown]
# # The rate of precession of the pair (5.15, 5.16)
#
# **Objective.** $\dot\phi$ from A and B, the values that the paper gives A and B, and what the formula then predicts.
#
# **Assumptions.** The ansatz; equal inertias $J = I_3 = I$ as printed.
#
# **Notation.** $\omega = (\omega_1 - \omega_2)/2 = \dot\psi + \dot\phi\,(\cos\theta_1 + \cos\theta_2)/2$ is the mean
# axial velocity; $\bar\theta$ the mean inclination and $\delta$ half the difference.

# %%
import sympy as sp

from lagrotor import Link, Scene, natural_rate
from lagrotor.algebra import decide_zero
from lagrotor.pair.lagrangians import ansatz_integrals
from lagrotor.pair.symbols import ANSATZ, G_1, G_2, I1, I3, A, B, G, I, J, a, b, omega
from lagrotor.paper.ledger import Relation, chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Formula, Judged
from lagrotor.theory.natural_frequency import natural_frequency
from lagrotor.theory.single_rotor import pair_precession_rate

theta_1, theta_2 = ANSATZ.q[:2]
phi_v, psi_v = ANSATZ.v[2:]
total = sp.cos(theta_1) + sp.cos(theta_2)
uniform = {J: I, I1: I, I3: I}

# %% [markdown]
# ## The rate from the two integrals

# %%
rate = pair_precession_rate().expressions[0]
printed_rate = (2 * A - B * total) / (I * (4 - total**2))
Formula(sp.Eq(phi_v, rate))

# %% [markdown]
# ## The values of the integrals
#
# Put $\dot\psi = \omega - \dot\phi\,(\cos\theta_1 + \cos\theta_2)/2$ into A and B, and expand in $\delta$.

# %%
mean, half = sp.symbols("theta_m delta", real=True)
apart = {theta_1: mean + half, theta_2: mean - half}
integral_A, integral_B = (e.subs(uniform).subs(psi_v, omega - phi_v * total / 2) for e in ansatz_integrals())
value_A, value_B = integral_A.subs(apart), integral_B.subs(apart)
printed_A = 2 * I * (phi_v * sp.sin(mean) ** 2 + omega * sp.cos(mean))
printed_B = 2 * omega
Formula(sp.Matrix([value_A, value_B]).subs(half, 0).expand())

# %% [markdown]
# ## What the formula then says
#
# With equal inclinations and these values the formula gives back the $\dot\phi_0$ that was put into A: an identity for
# every $\dot\phi_0$. It predicts no rate. The rate comes from the equation of motion that the ansatz leaves out: the
# linear pair has one oscillation, at $\Omega_0$.

# %%
level = {theta_1: mean, theta_2: mean}
fed_back = printed_rate.subs(level).subs({A: printed_A, B: 2 * I * omega})
tautology = decide_zero(fed_back - phi_v).answer
assert tautology == "zero"

squared = sp.factor(natural_frequency().expressions[0].subs({G_1: G, G_2: -G}) ** 2)
assert decide_zero(squared - G**2 / (a**2 - b**2)).answer == "zero"
massless = natural_rate(Scene(spins=(10, -10)))
heavy = natural_rate(Scene(spins=(10, -10), link=Link(mass=1, inertia=1)))

statements = [
    stated(
        "5.15",
        chain(rate, printed_rate),
        given=uniform,
        condition="equal inertias about the joint; the paper's rotor has J = 5/4 and I_3 = 1",
        depends_on=("5.14",),
        evidence=(
            "Singular at theta_1 = theta_2 = 0, the rest state, where the numerator vanishes too.",
            "With A and B given their values (5.16) it returns phi_0', whatever phi_0' is (decided): it is an identity, "
            "not a prediction of the rate.",
            f"The rate is fixed by the dynamics: Omega_0² = {squared} for opposite spins, {massless:.4g} rad/s for "
            f"spins ±10 and no bar mass, {heavy:.4g} with the bar of mass 1 and inertia 1.",
        ),
    ),
    stated(
        "5.16",
        (Relation(printed_B, value_B), Relation(printed_A, value_A, half, 1)),
        wrong="B lacks the factor I.",
        quantities=(
            r"B",
            r"A",
        ),
        correction=(Relation(2 * I * omega, value_B), Relation(printed_A, value_A, half, 1)),
        depends_on=("5.12", "5.13"),
        evidence=(
            "B lacks the inertia: it is 2 I omega (the two agree in the paper's units, I = 1). "
            "A is right to first order in the difference of the inclinations.",
        ),
    ),
]
Judged(statements)
