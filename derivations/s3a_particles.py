# %% [markdown]
# # Particles (3.01 to 3.08)
#
# **Objective.** The mechanics of the paper's simulator, from Newton's law for particles: mass, centre of mass, angular momentum,
# torque, and the rates of momentum and angular momentum.
#
# **Assumptions.** Three particles with any masses, positions and velocities. Every sum in these equations runs over single
# particles or pairs, so three particles represent any number. The forces between them are arbitrary.
# Figure 3 shows the simulator.
#
# **Notation.** $m_i$, $\vec X_i$, $\vec U_i$, $\vec A_i$ the particles' masses, places, velocities, accelerations;
# $\vec F_i$ the external forces, $\vec f_{ij}$ the force of particle $j$ on particle $i$.

# %%
from itertools import permutations

import sympy as sp

from lagrotor.paper import Formula, Premise, prove, verdict
from lagrotor.paper.grammar import cross, rate, vector
from lagrotor.paper.proof import form

NUMBERS = (1, 2, 3)
m1, m2, m3 = masses = sp.symbols("m_1 m_2 m_3", positive=True)
places, velocities, accelerations, external = ([vector(f"{name}_{i}") for i in NUMBERS] for name in "XUAF")
internal = {(i, j): vector(f"f_{i}{j}") for i, j in permutations(NUMBERS, 2)}


def summed(terms) -> sp.Matrix:
    return sum(terms, sp.zeros(3, 1))


def gradient(quantity: sp.Expr, of: sp.Matrix) -> sp.Matrix:
    return sp.Matrix([sp.diff(quantity, component) for component in of])


# %% [markdown]
# ## Mass
#
# The mass of the system is its inertia against a common velocity $\vec U$: the second derivative of the kinetic energy.

# %%
common = vector("U")
moving = sum(m * common.dot(common) / 2 for m in masses)
total_mass = sp.diff(moving, common[0], 2)
prove(gradient(moving, common), total_mass * common, "the momentum of the common motion", names=r"\sum_i m_i\vec U")

# %%
mass = verdict(
    "3.01",
    total_mass,
    form=form("sum_i(m_i)"),
)
mass

# %% [markdown]
# ## Force
#
# For each particle $m_i\vec A_i = \vec F_i + \sum_j\vec f_{ij}$. The total force is the rate of the total momentum, including
# the internal forces.


# %%
def inside(i: int) -> sp.Matrix:
    """The internal forces on particle i."""
    return summed(internal[i, j] for j in NUMBERS if j != i)


on_the_whole = summed(F + inside(i) for i, F in zip(NUMBERS, external, strict=True))
Formula(on_the_whole, r"\frac{d}{dt}\sum_i m_i\vec U_i")

# %% [markdown]
# The internal forces cancel in pairs if they are opposite, as the paper assumes.

# %%
PAIRS = ((1, 2), (1, 3), (2, 3))
action_and_reaction = Premise(
    "two particles act on each other with opposite forces, f_ij = −f_ji",
    {back: -there for i, j in PAIRS for back, there in zip(internal[j, i], internal[i, j], strict=True)},
)
verdict(
    "3.02",
    on_the_whole,
    premises=[action_and_reaction],
    form=form("sum_i(F_i)"),
)

# %% [markdown]
# ## Centre of mass
#
# It is the point $\vec X_{cm}$ about which the first moment of the masses vanishes.

# %%
centre = vector("X_cm")
moment = summed(m * (X - centre) for m, X in zip(masses, places, strict=True))
X_cm = centre.subs(sp.solve(list(moment), list(centre), dict=True, simplify=False)[0])
Formula(X_cm, r"\vec X_{cm}")

# %%
centre_of_mass = verdict(
    "3.03",
    X_cm,
    uses=[mass],
    form=form("sum_i(m_i*X_i)/M", M=total_mass),
)
centre_of_mass

# %% [markdown]
# Its velocity is the mean of the velocities with the masses as weights. The paper prints their sum:

# %%
U_cm = rate(X_cm, places, velocities)
mean_velocity = form("sum_i(m_i*U_i)/M", M=total_mass)
verdict(
    "3.04",
    U_cm,
    correction=mean_velocity,
    wrong="The weights of the mean, each mass over the sum of the masses, are missing.",
    uses=[centre_of_mass],
    evidence=[
        "The mean of the velocities is printed as their sum. A body of three equal particles in a common motion would move "
        f"{sp.Integer(len(places))} times too fast."
    ],
    form=mean_velocity,
)

# %% [markdown]
# ## Angular momentum about the centre of mass
#
# This is the angular momentum of the motion relative to the centre. The velocity of the centre does not contribute, because the
# first moment vanishes:

# %%
arms = [X - X_cm for X in places]
L = summed(m * cross(d, U - U_cm) for m, d, U in zip(masses, arms, velocities, strict=True))
prove(
    summed(m * d for m, d in zip(masses, arms, strict=True)),
    sp.zeros(3, 1),
    "the first moment about the centre",
    equations=r"\sum_i m_i\,(\vec X_i - \vec X) = 0",
)

# %%
verdict(
    "3.05",
    L,
    uses=[centre_of_mass],
    form=form("sum_i(m_i*cross(X_i - X_cm, U_i - U_cm))", X_cm=X_cm, U_cm=U_cm),
)

# %% [markdown]
# ## Torque
#
# The work of the external forces in a small turn $\vec n$ about the centre is $\vec\tau\cdot\vec n$: the torque is its
# gradient.

# %%
turn = vector("n")
work = sum(F.dot(cross(turn, d)) for F, d in zip(external, arms, strict=True))
torque = gradient(work, turn)
verdict(
    "3.06",
    torque,
    uses=[centre_of_mass],
    form=form("sum_i(cross(X_i - X_cm, F_i))", X_cm=X_cm),
)

# %% [markdown]
# ## The centre moves as one particle
#
# Newton's law gives the external forces by the motion, $\vec F_i = m_i\vec A_i - \sum_j\vec f_{ij}$. Their sum is

# %%
by_the_motion = [m * A - inside(i) for i, m, A in zip(NUMBERS, masses, accelerations, strict=True)]
verdict(
    "3.07",
    summed(by_the_motion),
    premises=[action_and_reaction],
    uses=[mass, "3.02", centre_of_mass],
    form=form("sum_i(m_i*A_i)"),
)

# %% [markdown]
# ## The torque is the rate of the angular momentum
#
# The internal forces have no total torque if they are opposite and act along the line between their particles.

# %%
put_central = {}
for i, j in PAIRS:
    line = sp.Symbol(f"c_{i}{j}", real=True) * (places[i - 1] - places[j - 1])
    put_central |= dict(zip(internal[i, j], line, strict=True))
central = Premise("the internal forces are central, f_ij along X_i − X_j", put_central)
torque_by_the_motion = summed(cross(d, F) for d, F in zip(arms, by_the_motion, strict=True))
twisting = summed(cross(d, inside(i)) for i, d in zip(NUMBERS, arms, strict=True))
prove(
    central.on(action_and_reaction.on(twisting)),
    sp.zeros(3, 1),
    "the moment of opposite, central forces",
    equations=r"\sum_i (\vec X_i - \vec X)\times\sum_{j\neq i}\vec f_{ij} = 0",
)

# %% [markdown]
# The paper requires only that they are opposite. Two particles on the $x$ axis that push each other perpendicularly to it satisfy
# this, but start to rotate without an external torque:

# %%
opposite = action_and_reaction.on(twisting)
apart_along_x = dict.fromkeys(opposite.free_symbols, sp.S.Zero)
apart_along_x |= dict.fromkeys((m1, m2, m3, places[0][0], internal[1, 2][1]), sp.S.One)
spin_up = opposite.xreplace(apart_along_x)
Formula(spin_up, r"\dot{\vec L}")

# %%
verdict(
    "3.08",
    torque_by_the_motion,
    premises=[action_and_reaction, central],
    uses=["3.05", "3.06"],
    evidence=[
        "The paper requires f_ij = -f_ji only. Two particles 1 m apart that push each other with 1 N "
        f"perpendicularly to the line between them obey that and start to rotate: dL/dt = {tuple(spin_up)} N m "
        "without any torque from outside."
    ],
    form=form("sum_i(m_i*cross(X_i - X_cm, A_i))", X_cm=X_cm),
)
