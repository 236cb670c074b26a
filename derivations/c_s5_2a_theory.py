# %% [markdown]
# # Claims of section 5.2: the paired precession (C14 to C17)
#
# **Objective.** The degrees of freedom, the ansatz and the correction, tested on exact orbits.
#
# **Assumptions.** Opposite spins ±10. The bar is massless for statements about the theory, and the bar of 5.2.1 ($m = 0.01$,
# $K = 0.1$) for statements about the simulation. $r_0 = 0.204$ is the paper's amplitude (figure 21).
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/precession_and_drift.py`.

# %%
from lagrotor.paper.rotor_pair.claims.precession_and_drift import C14, C15, C16, C17

# %% [markdown]
# ## C14: degrees of freedom
#
# Velocities: six components of the axes and two axial spins. In Euler angles they are four angular velocities of the axes and
# two spins, since the angles satisfy the unit lengths. Constraints: two unit lengths and the bar. The rank of their Jacobian
# is computed from its singular values along a shocked run, and at a position where both axes and the bar lie in one line.
# Without the bar the numbers are 6 and 4.

# %%
C14

# %% [markdown]
# ## C15: the ansatz and its integrals
#
# Three quantities are measured on exact orbits: the largest sum of the rates of the azimuths over their mean size, the same
# of the spin angles over the spin, and the oscillation of A over the part of A that is due to the motion, $A - 2G$. Their
# exponents in $r_0$ are given, too. "Agrees" and "constant" mean within 5 %. A deviation that vanishes with the amplitude is
# within 5 % up to some amplitude, and this amplitude is computed. A deviation that does not vanish excludes every amplitude;
# this is the case for A and the paper's own bar. B is measured in the paper's program, which does not presume it.

# %%
C15

# %% [markdown]
# ## C16: the swing of the link
#
# The ansatz is applied to the exact orbit: azimuths $\pm\phi$ with $\phi$ half their difference, once with constant $\theta$
# and once with the paper's correction. The printed range is 1 to $\sqrt{1 + 4r_0^2}$. The correction is of order $r_0^2$. It
# removes the oscillation to that order if the remainder has a higher exponent. With the opposite sign it doubles the
# oscillation. The remaining constant length of the link is given, too.

# %%
C16

# %% [markdown]
# ## C17: the rate after the correction
#
# With constant inclination and no bar, each rotor precesses at $G/(J\cos\theta_0)$. The exact rate is compared with it for a
# massless bar. "Unchanged" means by less than a tenth of $r_0^2$, the order of the correction. For equal spins, whose axes
# precess together, it is unchanged.

# %%
C17
