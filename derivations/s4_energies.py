# %% [markdown]
# # Energies and the shock (4.01 to 4.05)
#
# **Objective.** The numbers and the check of the paper's simulator: link constants and the damping they mean, the
# energy that is watched, its first value, the shock, and the energy as the program computes it.
#
# **Assumptions.** Three rigid bodies, linked by springs of rest length zero; no gravity.
#
# **Notation.** $C$ second moments of mass of a body about its centre, $\mathbb I = \mathrm{tr}\,C\,\mathbb 1 - C$ its
# inertia tensor; $s_j$ the length of link $j$; $\mu = M/n$; $\tau = t - 2\,\mathrm s$.

# %%
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.mechanics import coordinates, energy
from lagrotor.pair.lagrangians import rotor_lagrangian
from lagrotor.pair.symbols import I3, ROTOR, J
from lagrotor.paper.ledger import chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Judged


def vector(name: str) -> sp.Matrix:
    return sp.Matrix(sp.symbols(f"{name}_x {name}_y {name}_z", real=True))


# %% [markdown]
# ## The kinetic energy of a rigid body
#
# The velocity field is $\vec U + \vec\Omega\times\vec d$. Of the integral of $\frac12|\cdot|^2$ over the mass only the
# moments remain: $\int dm = M$, $\int d_i\,dm = 0$, $\int d_id_j\,dm = C_{ij}$. Any body whatever.

# %%
d = vector("d")


def over_mass(expression: sp.Expr, M: sp.Symbol, C: sp.Matrix) -> sp.Expr:
    """The integral over the mass of a polynomial in d of degree two."""
    moment = {(0, 0, 0): M}
    for i in range(3):
        for j in range(3):
            moment[tuple((i == n) + (j == n) for n in range(3))] = C[i, j]
    return sum(value * moment.get(powers, 0) for powers, value in sp.Poly(expression, *d).terms())


masses = sp.symbols("M_1 M_2 M_3", positive=True)
velocities = [vector(f"U_{i}") for i in (1, 2, 3)]
turns = [vector(f"Omega_{i}") for i in (1, 2, 3)]
moments = [sp.Matrix(3, 3, lambda i, j, n=n: sp.Symbol(f"C_{n}{min(i, j)}{max(i, j)}", real=True)) for n in (1, 2, 3)]
inertias = [sp.eye(3) * C.trace() - C for C in moments]


def kinetic(M: sp.Symbol, C: sp.Matrix, U: sp.Matrix, Omega: sp.Matrix) -> sp.Expr:
    field = U + Omega.cross(d)
    return over_mass(sp.expand(field.dot(field) / 2), M, C)


K = [kinetic(*row) for row in zip(masses, moments, velocities, turns, strict=True)]
M_1, M_2, M_3 = masses
U_1, U_2, U_3 = velocities
O_1, O_2, O_3 = turns
I_1, I_2, I_3 = inertias
printed_E = (
    M_1 * U_1.dot(U_1)
    + (I_1 * O_1).dot(O_1)
    + M_2 * U_2.dot(U_2)
    + (I_2 * O_2).dot(O_2)
    + M_3 * U_3.dot(U_3)
    + (I_3 * O_3).dot(O_3)
) / 2
listed_E = (
    M_1 * U_1.dot(U_1)
    + (O_1.T * I_1).dot(O_1)
    + M_2 * U_2.dot(U_2)
    + (O_2.T * I_2).dot(O_2)
    + M_2 * U_3.dot(U_3)
    + (O_3.T * I_3).dot(O_3)
) / 2

# %% [markdown]
# ## What the springs hold
#
# The Lagrangian of bodies and springs is $K - \frac S2\sum_j s_j^2$; its Jacobi integral is what is conserved without
# damping and external force. Four links: two to the ground, two to the bar.

# %%
S, D = sp.symbols("S D", positive=True)
lengths = coordinates("s_1 s_2 s_3 s_4")
velocity_symbols = [x for row in (*velocities, *turns) for x in row]
bodies = coordinates([f"q_{i}" for i in range(len(velocity_symbols))])
as_rates = dict(zip(velocity_symbols, bodies.v, strict=True))
held = sum(S * s**2 / 2 for s in lengths.q)
total = energy(sum(K).subs(as_rates) - held, bodies).subs({v: u for u, v in as_rates.items()})
first_run = held.subs(dict(zip(lengths.q, (0, 0, sp.S.Half, sp.S.Half), strict=True)))  # the bar set half a metre high
held

# %% [markdown]
# ## Constants, first value, shock

# %%
mu, n, omega_s, m_eff = sp.symbols("mu n omega_s m_eff", positive=True)
M = sp.Symbol("M", positive=True)
printed_S, printed_D = 2000 * (M / n) * omega_s**2, 500 * (M / n) * omega_s
kilogram, second, metre = sp.symbols("kg s m", positive=True)
units = {M: kilogram, n: 1, omega_s: 1 / second}
newton = kilogram * metre / second**2
damping_ratio_squared = printed_D**2 / (4 * printed_S * m_eff)
damping_ratio = sp.sqrt(damping_ratio_squared)
damping_time = sp.cancel(printed_D / printed_S)
two_tips = damping_ratio.subs(m_eff, M / 2)

upright = dict.fromkeys((*ROTOR.q, *ROTOR.v), 0) | {ROTOR.v[2]: 10, I3: 1}
one_rotor = rotor_lagrangian().subs(upright)
at_start = {**dict.fromkeys((*velocity_symbols, *lengths.q), 0), O_1[2]: 10, O_2[2]: 10}
unit_inertia = {C[i, j]: sp.Rational(int(i == j), 2) for C in moments for i in range(3) for j in range(3)}
first_value = total.subs(at_start).subs(unit_inertia)
assert decide_zero(first_value - 2 * one_rotor).answer == "zero"
assert J not in one_rotor.free_symbols

tau, radius = sp.Symbol("tau", real=True), sp.Symbol("rho", positive=True)
height, width = sp.Integer(50), sp.Rational(1, 50)
printed_exponent = -((50 * tau) ** 2)
printed_shock = 50 * sp.exp(printed_exponent)
impulse = sp.integrate(printed_shock, (tau, -sp.oo, sp.oo))
# The square of the impulse as an integral over the plane, in polar coordinates: no Gaussian integral is looked up.
plane = sp.integrate(2 * sp.pi * radius * height**2 * sp.exp(-(radius**2) / width**2), (radius, 0, sp.oo))
assert decide_zero(impulse**2 - plane).answer == "zero"

light = {M_2: 1, M_3: sp.Rational(1, 100)}
excess = sp.factor(listed_E - printed_E)
times = (M_2 / M_3).subs(light)
excess

# %% [markdown]
# ## What the paper prints

# %%
statements = [
    stated(
        "4.01",
        (
            *chain(2000 * newton / metre, printed_S.subs(units)),
            *chain(500 * newton * second / metre, printed_D.subs(units)),
        ),
        definition=True,
        evidence=(
            "Units: N/m and N s/m. The paper does not say what n and omega_s are.",
            f"D/S = {damping_time}; damping ratio of a mass m_eff on one link: {damping_ratio}, that is "
            f"{float(damping_ratio.subs({m_eff: M, n: 1})):.3g}/sqrt(n) for m_eff = M and "
            f"{float(two_tips.subs(n, 1)):.3g}/sqrt(n) for two bodies of mass M: overdamped unless n is large.",
        ),
    ),
    stated(
        "4.02",
        chain(sum(K), printed_E),
        correction=chain(total, printed_E + S / 2 * sum(s**2 for s in lengths.q)),
        depends_on=("3.09", "3.11"),
        evidence=(
            "It is the kinetic energy. What is conserved without damping and force has the springs' S/2 sum s_j^2 too, "
            "given as the correction for the total energy.",
            f"The paper's first run, with the bar half a metre too high, starts with {first_run} in its springs, none "
            "of which is in this E: hence the spike.",
        ),
    ),
    stated(
        "4.03",
        chain(first_value, sp.Rational(1, 2) * (1 * 10**2 + 1 * 10**2), 100),
        depends_on=("4.02",),
        evidence=(f"I_3 omega^2/2 = {one_rotor} J for each rotor, nothing for the bar; springs unstretched.",),
    ),
    stated(
        "4.04",
        (
            *chain(height, printed_shock.subs(tau, 0)),
            *chain(-((tau / width) ** 2), printed_exponent),
            *chain(plane, impulse**2),
        ),
        definition=True,
        evidence=(
            f"Height {height} N at t = 2 s, width {width} s, impulse {impulse} = {float(impulse):.4g} N s over all "
            f"time; the run begins {2 / width} widths before the peak and misses none of it that a double could hold.",
        ),
    ),
    stated(
        "4.05",
        chain(sum(K), listed_E),
        given={M_3: M_2},
        condition="the bar as heavy as a rotor, as in the first setup",
        depends_on=("4.02",),
        evidence=(
            f"The program takes R2.M for the third body. It exceeds the kinetic energy by {excess}: with the light "
            f"bar, M_3 = {light[M_3]} kg, the bar's energy of translation is counted {times} times. "
            "Rows times matrix, (Omega I).Omega, is right because I is symmetric.",
        ),
    ),
]
Judged(statements)
