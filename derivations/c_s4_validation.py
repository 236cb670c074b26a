# %% [markdown]
# # Claims of section 4: the validation runs (C06 to C09)
#
# **Objective.** The paper's energies, its NaN, and the conserved quantities.
#
# **Assumptions.** The bar of section 4.1 ($m = K = 1$), step 1 ms. Of the paper's two seconds of rest before the shock only
# ten widths are simulated; the eight seconds after it are kept.
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/simulator.py`.

# %%
from lagrotor.paper.rotor_pair.claims.simulator import C06, C07, C08, C09

# %% [markdown]
# ## C06: the bar placed wrongly
#
# The paper measures z from the centres of the rotors, this script from the ground joints: the paper's mistaken 1 is 1.5 here,
# and its right 0.5 is 1. A spike is a rise of the energy by more than half a unit of the printed 100 within 0.1 s. It decays
# if the energy returns to within the same. A bar in the right place keeps 100 J within half a unit and has no spike; without
# dampers the spike does not decay.

# %%
C06

# %% [markdown]
# ## C07: not a number
#
# The printed rotation divides by $|\Omega|^2$. At $|\Omega| = 10^{-169}$ rad/s the square rounds to zero, and $P = 0/0$.
# Bisection finds the largest $|\Omega|$ that fails: near 10⁻¹⁶², the square root of the smallest floating-point number. At
# 10⁻¹⁵⁰ rad/s the rotation does not fail. The paper's run follows, with the printed rotation and with the corrected one.

# %%
C07

# %% [markdown]
# ## C08: the energy after the shock
#
# The energy of the paper's program, of the exact pair, and in closed form: an impulse $P$ gives $P^2R^2/(4(a + b))$, times
# $e^{-(\Omega w)^2/2}$ for a pulse of width $w$. 100.45 means any number that rounds to it, 100.445 to 100.455 J; "constant"
# means constant to the same digits. With springs the final energy is compared at its maximum, because the dampers then reduce
# it.
#
# $S$ and $D$ depend on $n$ and $\omega_s$, which the paper does not give. With $\omega_s = 10$, the spin, several $n$ are
# tried. For each the step must be stable at 1 ms (`step_limit`), and the energy must be right for the first tenth of a second
# after the shock.

# %%
C08

# %% [markdown]
# ## C09: momenta
#
# Total momentum and total angular momentum over the 2.4 s after the shock, relative to the impulse. The angular momentum is
# taken about ground 1, about the midpoint of the grounds, and about the line through them; bodies and bar are included.
# "Because the grounds exert forces and torques": the same bodies without grounds must conserve both. Conserved means to 10⁻⁶
# for the exact pair, and to 10⁻³ for the paper's program, whose dampers are not central.

# %%
C09
