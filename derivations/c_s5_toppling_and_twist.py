# %% [markdown]
# # Claims of sections 5 and 5.1: toppling and stability (C10 to C13)
#
# **Objective.** How the pair falls without spins, how long opposite spins keep it from moving in x, and why (7) fails.
#
# **Assumptions.** The bar of section 4.1 ($m = K = 1$) and the shock of section 4.2, 50 N for 1/50 s on tip 1. The exact
# pair, except where the paper's program is named. Fallen in x: $|x| > 0.5$, 30° from upright. The paper's run lasts 8 s
# after the shock.
#
# What is measured, and how it is decided:
# `lagrotor/paper/rotor_pair/claims/shock_toppling_and_twist.py`.

# %%
from lagrotor.paper.rotor_pair.claims.shock_toppling_and_twist import C10, C11, C12, C13
from lagrotor.paper.rotor_pair.runs import shocked_scene

shocked_scene((10, -10), (50, 0, 0))

# %% [markdown]
# ## C10: no spin
#
# The paper does not say which shock figure 11 has: along x as in figure 10, and the same along y. Turning about the line
# through the two grounds (the x axis) is an angle in the y-z plane.
#
# After a shock along x both axes fall towards $\pm e_x$, where they and the bar lie in one line. There the gradient of the
# bar's constraint is a combination of those of the two unit lengths: the bar constrains nothing, and a pair that is exactly
# in the plane may leave in more than one way. The run therefore ends before that dead point. Toppled: an axis is 75° from
# upright in 2.7 s along x, and has passed 90° in 6 s along y.
#
# What follows is measured with a side force of 1 N beside the 50 N, which keeps the exact pair clear of the dead point:
# the angle between the axes within 2 s after it, exactly and for springs of three stiffnesses, damped alike
# ($D \propto \sqrt S$, the paper's 250 kg/s at 10⁴ N/m), by a solver of variable step.

# %%
C10

# %% [markdown]
# ## C11: stability in x
#
# For each sign and direction of the paper's shock: how far x goes within the paper's 8 s, when it has fallen, and how fast
# the pair turns about the joint line. Less than 0.1 rad (6°) in the 8 s would not be seen as toppling; less than one radian
# in one turn of the natural rate is slow. Then the same for other shocks: the powers with which those times go.

# %%
C11

# %% [markdown]
# ## C12: is the twist the cause?
#
# If it is, then a bar that resists twisting must restore (7), by which opposite spins do not count: x as without spins.
# The inertia K of the bar about its centre is what a twist has to turn. Largest x within 2.4 s of the shock along x, over
# that without spins; the largest twist of the bar out of its plane; the largest angle between the axes; for K from 1 to
# 1000 kg m². (7) fails where x is off by more than a tenth.

# %%
C12

# %% [markdown]
# ## C13: no displacement in x on average
#
# Means over the first four cycles after small shocks, of each axis, and with which power of the shock they go. A displacement
# that vanishes faster than the shock is none to first order: its power is above 1.5. Over a quarter of a cycle, which
# is no average, the means go as the shock.

# %%
C13
