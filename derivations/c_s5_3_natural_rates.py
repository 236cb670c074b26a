# %% [markdown]
# # Claims of section 5.3: the natural rates (C20 to C23)
#
# **Objective.** The rates that the paper matched by eye, measured on runs: for one rotor, for equal and for opposite spins,
# and as functions of the inclination.
#
# **Assumptions.** The shock of the listings, 40 N along x for 1/20 s on tip 1. The paper's "..." do not specify the bar. The
# bars listed elsewhere are $m = K = 1$ (4.1) and $m = 0.01$, $K = 0.1$ (5.2.1); the first mass with the second inertia is
# measured, too. Natural rates are measured after a shock a hundred times smaller.
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/natural_rates.py`.

# %%
from lagrotor import Scene, natural_rate
from lagrotor.pair import HEAVY_LINK
from lagrotor.paper.rotor_pair.claims.natural_rates import C20, C21, C22, C23

# %% [markdown]
# ## C20: one rotor at 16
#
# A printed number means any number that rounds to it: 16 means 15.5 to 16.5 rad/s. The phase of $\sin 16(t - 2)$ at the end
# of the run shows the effect of the amplitude: a free rotor precesses at $|L|/J = G/(J\cos\theta)$.

# %%
C20

# %% [markdown]
# ## C21: the equal pair at 11.4
#
# By the same rule 11.4 means 11.35 to 11.45 rad/s. This is required of three rates: in the paper's own program, in the
# natural rate, and in the exact pair after the paper's 40 N, whose finite amplitude raises the rate. The constant is compared
# to the same digits divided by 16. A constant of the coupling must be the same at half the spins and for the other bars.
# Stiffness and damping depend on n as in C08; 10, 20, 40 and 80 are stable.

# %%
C21

# %% [markdown]
# In closed form the constant is $J/(a + b)$:

# %%
ratio = natural_rate(Scene((20, 20), link=HEAVY_LINK)) / natural_rate(Scene((20, 20), link=None))
f"With the bar of section 4.1 the constant is {ratio:.4f}."

# %% [markdown]
# ## C22: the anti-spin pair at 5.7
#
# $10\cdot\frac45\cdot 0.7125 = 5.7$ (printed 0.57), for each bar that the paper lists and for the mixed one, after a shock of
# 40 N and after a small one. "At least for the first few cycles" means that for three cycles or more the matched wave is
# within a quarter of a cycle of the motion. Beyond this its peaks have the wrong sign. The rate is the mean over the first
# three cycles of the wave. A listed bar must satisfy this; the mixed one is given for comparison. The last number is the
# inertia that a bar of mass 1 would need: $G^2/((J + m/2)(J + 2K)) = 5.7^2$.

# %%
C22

# %% [markdown]
# ## C23: the rate over the cosine
#
# As $1/\cos\theta = 1 + \theta^2/2 + \dots$, the measured rate over the natural one should be $1 + c\,\bar\theta^2$ with c =
# 1/2. Here $\bar\theta$ is the average inclination of both axes over a turn. Opposite spins are measured on exact orbits with
# four bars, other spins after equal velocities of both axes, with $\bar\theta$ the half-angle of their cone. The smallest
# amplitude gives c within half a unit of its decimal, 0.05. Two more motions are compared: equal spins, and the same scene
# after a shock from rest. For opposite spins such a shock displaces the centres of precession, and the motion is no longer
# the symmetric orbit.

# %%
C23
