# %% [markdown]
# # Claim of section 6: two modes (C24)
#
# **Objective.** The modes of the anti-spin pair, from the roots of the linearised equations and from a simulation.
#
# **Assumptions.** The bar of section 4.1; a shock of 0.5 N along x and 0.3 N along y, so small that terms of second order are
# negligible. Figure 28 shows the oscillation for two bars.
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/precession_and_drift.py`.

# %%
from lagrotor.paper import Remark
from lagrotor.paper.rotor_pair.claims.precession_and_drift import C24
from lagrotor.paper.rotor_pair.premises import TWO_MODES

# %% [markdown]
# ## C24
#
# The state of the linearised equations has six components ($x$, $y_1$, $y_2$ and their velocities). A pair of imaginary roots
# is an oscillation. Zero roots in excess of the displacements at rest are steady rotations. A run is then fitted: x and y of
# both axes by a constant, a slope and one wave of that rate. Toppling has $y_1 : y_2 = 1 : 1$ and no x; paired precession has
# $x_1 : x_2 = 1 : 1$ and $y_1 : y_2 = 1 : -1$. The residual must be below 10⁻³ of the largest motion. Equal spins have
# neither mode: their axes precess together, and the twist rotates steadily.
#
# Two modes are counted under a condition. Only one of them is an oscillation, the word of equation 6.01:

# %%
Remark("Condition", TWO_MODES)

# %%
C24
