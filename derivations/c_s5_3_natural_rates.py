# %% [markdown]
# # Claims of section 5.3: the natural rates (C20 to C23)
#
# **Objective.** The rates that the paper matched by eye, from runs: for one rotor, for equal and for opposite spins; and
# how they go with the inclination.
#
# **Assumptions.** The shock of the listings, 40 N along x for 1/20 s on tip 1. The paper's "..." leave the bar open: the
# bars it lists elsewhere are $m = K = 1$ (4.1) and $m = 0.01$, $K = 0.1$ (5.2.1); the first mass with the second inertia
# is measured too. Natural rates are measured after a shock a hundred times smaller.
#
# What is measured, and how it is decided: `lagrotor/paper/rotor_pair/claims/natural_rates.py`.

# %%
from lagrotor import Scene, natural_rate
from lagrotor.pair import HEAVY_LINK
from lagrotor.paper.rotor_pair.claims.natural_rates import C20, C21, C22, C23

# %% [markdown]
# ## C20: one rotor at 16
#
# A printed number stands for what rounds to it: 16 for 15.5 to 16.5 rad/s. The phase of $\sin 16(t - 2)$ at the end of the run
# shows the effect of the amplitude: a free rotor goes round at $|L|/J = G/(J\cos\theta)$.

# %%
C20

# %% [markdown]
# ## C21: the equal pair at 11.4
#
# By the same rule 11.4 stands for 11.35 to 11.45 rad/s: in the paper's own program, in the natural rate, and in the exact pair
# under the paper's own 40 N, whose finite amplitude adds to the rate; the constant is held to the same digits over 16. A
# constant of the coupling is the same at half the spins and for the other bars. Stiffness and damping go by n as in C08, where
# 10, 20, 40 and 80 are stable.

# %%
C21

# %% [markdown]
# In closed form the constant is $J/(a + b)$:

# %%
natural_rate(Scene((20, 20), link=HEAVY_LINK)) / natural_rate(Scene((20, 20), link=None))

# %% [markdown]
# ## C22: the anti-spin pair at 5.7
#
# $10\cdot\frac45\cdot 0.7125 = 5.7$ (printed 0.57), for each bar that the paper lists and for the mixed one, after a
# shock of 40 N and after a small one. "At least for the first few cycles": for three cycles or more the matched wave is
# within a quarter of a cycle of the motion, beyond which its peaks fall on the other side of zero. The rate is that over
# the first three cycles of the wave. A listed bar must do it; the mixed one is given for comparison. Last the inertia that a
# bar of mass 1 would need: $G^2/((J + m/2)(J + 2K)) = 5.7^2$.

# %%
C22

# %% [markdown]
# ## C23: the rate over the cosine
#
# $1/\cos\theta = 1 + \theta^2/2 + \dots$, so the measured rate over the natural one should be $1 + c\,\bar\theta^2$ with
# c = 1/2 and $\bar\theta$ the average inclination of both axes over a turn. For opposite spins on exact orbits, with four
# bars; for other spins after both axes got the same velocity, $\bar\theta$ the half-angle of their cone. c to half a unit of
# its decimal, 0.05, from the smallest amplitude. Equal spins beside the scene's own, and the scene after a shock from rest:
# for opposite spins that leaves the centres of precession twisted apart, no longer the symmetric orbit.

# %%
C23
