# %% [markdown]
# # Claim of section 6: two modes (C24)
#
# **Objective.** The modes of the anti-spin pair, by the roots of the linear pair and by a run.
#
# **Assumptions.** The bar of section 4.1; a shock of 0.5 N along x and 0.3 N along y, so small that its square does not
# show.
#
# What is measured, and how it is decided: `lagrotor/paper/rotor_pair/claims/precession_and_drift.py`.

# %%
from lagrotor.paper import Remark
from lagrotor.paper.rotor_pair.claims.precession_and_drift import C24
from lagrotor.paper.rotor_pair.premises import TWO_MODES

# %% [markdown]
# ## C24
#
# Roots of the linear pair, whose state has six components ($x$, $y_1$, $y_2$ and their velocities): a pair of imaginary ones
# is an oscillation. Zero roots beyond the displacements at rest are steady turnings. Then a run: x and y of both axes
# fitted with a constant, a slope and one wave of that rate. Toppling has $y_1 : y_2 = 1 : 1$ and no x; paired precession has
# $x_1 : x_2 = 1 : 1$ and $y_1 : y_2 = 1 : -1$. What is left of the largest motion must be below 10⁻³. Equal spins have neither:
# their axes precess together, and it is the twist that turns steadily.
#
# Two modes are counted under a condition; of modes of oscillation, which equation 6.01 prints, there is one:

# %%
Remark("Condition", TWO_MODES)

# %%
C24
