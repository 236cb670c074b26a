# %% [markdown]
# # The recorded energy (4.02, 4.03, 4.05)
#
# **Objective.** The energy of the paper's system of three bodies and four links, compared with the paper's equation and with its
# program.
#
# **Assumptions.** Three rigid bodies of any shape, linked by springs of rest length zero; no gravity. The energy is the quantity
# conserved without damping and external force.
#
# **Notation.** $M_i$, $\vec U_i$, $\vec\Omega_i$, $I_i$ mass, velocity, angular velocity and inertia tensor of body $i$; $s_j$
# the length of link $j$, $S$ the stiffness; $\vec d$ the place in a body from its centre.

# %%
import sympy as sp

from lagrotor.mechanics import coordinates, energy
from lagrotor.paper import Formula, Premise, parameter_premise, prove, verdict
from lagrotor.paper.grammar import components, cross, dot, symmetric, vector
from lagrotor.paper.proof import form

M_1, M_2, M_3 = masses = sp.symbols("M_1 M_2 M_3", positive=True)
velocities, turns = ([vector(f"{name}_{i}") for i in (1, 2, 3)] for name in ("U", "Omega"))
inertias = [symmetric(f"I_{i}") for i in (1, 2, 3)]

# %% [markdown]
# ## The kinetic energy of a rigid body
#
# The velocity field is $\vec U + \vec\Omega\times\vec d$. Of the integral of $\frac12|\cdot|^2$ over the mass only the moments
# remain: $\int dm = M$, $\int d_i\,dm = 0$, $\int d_id_j\,dm = C_{ij}$.

# %%
d = vector("d")


def over_mass(expression: sp.Expr, M: sp.Symbol, C: sp.Matrix) -> sp.Expr:
    """The integral over the mass of a polynomial in d of degree two."""
    moment = {(0, 0, 0): M}
    for i in range(3):
        for j in range(3):
            moment[tuple((i == n) + (j == n) for n in range(3))] = C[i, j]
    return sum(value * moment.get(powers, 0) for powers, value in sp.Poly(expression, *d).terms())


C = symmetric("C")
prove(
    (sp.eye(3) * dot(d, d) - d * d.T).applyfunc(lambda entry: over_mass(entry, M_1, C)),
    sp.eye(3) * C.trace() - C,
    "the inertia tensor by the second moments",
    names=r"\int(|\vec d|^2\,\mathbb 1 - \vec d\,\vec d^T)\,dm",
)

# %% [markdown]
# The moments are $C = \frac12\mathrm{tr}\,I\;\mathbb 1 - I$. They give the kinetic energy of any body from its mass and its
# tensor.


# %%
def kinetic(M: sp.Symbol, I: sp.Matrix, U: sp.Matrix, Omega: sp.Matrix) -> sp.Expr:
    """Half the integral of the squared velocity over a body of mass M and inertia tensor I."""
    field = U + cross(Omega, d)
    return over_mass(sp.expand(dot(field, field) / 2), M, sp.eye(3) * I.trace() / 2 - I)


K = [kinetic(*row) for row in zip(masses, inertias, velocities, turns, strict=True)]
prove(
    K[0],
    M_1 * dot(velocities[0], velocities[0]) / 2 + dot(inertias[0] * turns[0], turns[0]) / 2,
    "translation of the centre and rotation about it",
    equations=r"K_1 = \tfrac12 M_1\,|\vec U_1|^2 + \tfrac12\,\vec\Omega_1\cdot I_1\,\vec\Omega_1",
)

# %% [markdown]
# ## The energy of the system
#
# The Lagrangian of bodies and springs is $K - \frac S2\sum_j s_j^2$, with two links to the ground and two to the bar. Its Jacobi
# integral is conserved without damping and external force.

# %%
S = sp.Symbol("S", positive=True)
lengths = coordinates("s_1 s_2 s_3 s_4")
held = sum(S * s**2 / 2 for s in lengths.q)
rates = components([*velocities, *turns])
bodies = coordinates([f"q_{i}" for i in range(len(rates))])
lagrangian = (sum(K) - held).xreplace(dict(zip(rates, bodies.v, strict=True)))
total = energy(lagrangian, bodies).xreplace(dict(zip(bodies.v, rates, strict=True)))
prove(
    total,
    sum(K) + held,
    "the energy: kinetic energy and energy of the springs",
    equations=r"E = \sum_i K_i + \frac S2\sum_j s_j^2",
)

# %% [markdown]
# The paper records the kinetic energy as "the energy of the system". This is the total energy only while no link is stretched. In
# its first run the bar starts half a metre too high, and two links store

# %%
first_run = held.subs(dict(zip(lengths.q, (0, 0, sp.S.Half, sp.S.Half), strict=True)))
Formula(first_run, "E - K")

# %%
unstretched = Premise(
    "no link is stretched, s_j = 0",
    dict.fromkeys(lengths.q, sp.S.Zero),
    broken=f"its first run begins with two links stretched by 0.5 m, which store {first_run}",
)
whole_energy = form(
    "sum_i(M_i*dot(U_i, U_i) + dot(I_i*Omega_i, Omega_i))/2 + S/2*(s_1**2 + s_2**2 + s_3**2 + s_4**2)", S=S
)
energy_verdict = verdict(
    "4.02",
    total,
    premises=[unstretched],
    correction=whole_energy,
    uses=["3.09", "3.11"],
    evidence=[
        "The printed E is the kinetic energy. The conserved energy also contains S/2 sum s_j^2 of the springs, which the "
        "correction adds.",
        "In the paper's first run the bar is half a metre too high, so its springs initially store "
        f"{first_run}. The printed E omits this energy, which explains the spike.",
    ],
    form=whole_energy,
)
energy_verdict

# %% [markdown]
# ## The first value
#
# Two rotors spin with 10 rad/s about their upright axes and everything else is at rest. One upright rotor of spin $\omega$ has

# %%
omega = sp.Symbol("omega", real=True)
resting = dict.fromkeys(components([velocities[0], turns[0]]), 0)
one_rotor = sp.expand(K[0].subs(resting | {turns[0][2]: omega}))
first_rotor = one_rotor.subs({inertias[0][2, 2]: 1, omega: 10})
Formula(one_rotor, "K(1)")

# %%
verdict(
    "4.03",
    total,
    uses=["4.02"],
    evidence=[f"Each rotor has {first_rotor} J and the bar has none; the springs are unstretched."],
    form=whole_energy,
)

# %% [markdown]
# ## What the program computes
#
# The listing has rows times matrix, $(\Omega I)\cdot\Omega$, which is right because $I$ is symmetric, and it takes the mass of
# body 2 for body 3. With the lighter bar of section 5.2.1 the bar's energy of translation is counted a hundred times.

# %%
LIGHT = sp.Rational(1, 100)  # kg, the bar of section 5.2.1
heavy_bar = parameter_premise(
    "the bar is as heavy as a rotor, M₃ = M₂", {M_3: M_2}, scene_values={M_2: sp.S.One, M_3: LIGHT}
)
excess = K[2].subs(M_3, M_2) - K[2]
prove(
    excess,
    (M_2 - M_3) * dot(velocities[2], velocities[2]) / 2,
    "the excess of the listing",
    names=r"K_{\text{listing}} - K",
)

# %%
verdict(
    "4.05",
    total,
    premises=[heavy_bar, unstretched],
    correction=whole_energy,
    uses=["4.02"],
    evidence=[
        "The program uses R2.M, the mass of rotor 2, for the third body. Its E exceeds the kinetic energy by (M_2 - "
        "M_3) U_3^2/2: "
        f"for the light bar, M_3 = {LIGHT} kg, the energy of the bar's translation is {1 / LIGHT} times too large. "
        "The product of "
        "a row and the matrix, (Omega I).Omega, is right because I is symmetric.",
    ],
    form=whole_energy,
)
