# %% [markdown]
# # Claims of sections 5 and 5.1: toppling and stability (C10 to C13)
#
# **Objective.** The fall of the pair without spins, the time for which opposite spins prevent motion in x, and the reason why
# (7) fails.
#
# **Assumptions.** The bar of section 4.1 ($m = K = 1$) and the shock of section 4.2, 50 N for 1/50 s on tip 1. The exact
# pair, except where the paper's program is named. "Fallen in x" means $|x| > 0.5$, 30° from upright. The paper's run lasts 8
# s after the shock.
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/shock_toppling_and_twist.py`.

# %%
from lagrotor.paper.rotor_pair.claims.shock_toppling_and_twist import C10, C11, C12, C13
from lagrotor.paper.rotor_pair.runs import shocked_scene

shocked_scene((10, -10), (50, 0, 0))

# %% [markdown]
# ## C10: no spin
#
# The paper does not give the shock of figure 11. Two are simulated: along x as in figure 10, and the same along y. Rotation
# about the line through the two grounds (the x axis) is an angle in the y-z plane.
#
# After a shock along x both axes fall towards $\pm e_x$, where they and the bar lie in one line. At this singular position
# the gradient of the bar's constraint is a combination of the gradients of the two unit lengths, so the bar constrains
# nothing, and the motion of a pair in the plane is not unique. The run therefore ends before it. "Toppled" means that an axis
# is 75° from upright within 2.7 s along x, and has passed 90° within 6 s along y.
#
# The angle between the axes is measured with a side force of 1 N in addition to the 50 N, which keeps the exact pair away
# from the singular position. It is measured within 2 s after the shock, for the exact pair and for springs of three
# stiffnesses with equal damping ratio ($D \propto \sqrt S$, the paper's 250 kg/s at 10⁴ N/m), by a solver of variable step.

# %%
C10

# %% [markdown]
# ## C11: stability in x
#
# For each sign and direction of the paper's shock: the largest x within the paper's 8 s, the time of the fall, and the rate
# of rotation about the joint line. Less than 0.1 rad (6°) in the 8 s would not be seen as toppling; less than one radian in
# one period of the natural rate is slow. For other shocks the exponents of those times are given.

# %%
C11

# %% [markdown]
# ## C12: is the twist the cause?
#
# If the twist is the cause, a bar that resists twisting must restore (7), by which a pair of opposite spins responds like a
# pair without spins. A twist has to accelerate the inertia K of the bar about its centre. Three quantities are measured for K
# from 1 to 1000 kg m²: the largest x within 2.4 s of the shock along x, relative to the pair without spins; the largest twist
# of the bar out of its plane; and the largest angle between the axes. (7) fails if x differs by more than a tenth.

# %%
C12

# %% [markdown]
# ## C13: no displacement in x on average
#
# The means of each axis over the first four cycles after small shocks, and their exponents in the shock. A displacement is
# zero to first order if its exponent is above 1.5. Over a quarter of a cycle, which is no average, the means are proportional
# to the shock.

# %%
C13
