# %% [markdown]
# # Claims of section 5.2: the paired precession (C14 to C17)
#
# **Objective.** The degrees of freedom, the ansatz and the correction, on exact orbits.
#
# **Assumptions.** Opposite spins ±10. A massless bar where the theory is meant, the bar of 5.2.1 ($m = 0.01$, $K = 0.1$)
# where the simulation is. $r_0 = 0.204$ is the paper's amplitude (figure 21).
#
# What is measured, and how it is decided: `lagrotor/paper/rotor_pair/claims/precession_and_drift.py`.

# %%
from lagrotor.paper.rotor_pair.claims.precession_and_drift import C14, C15, C16, C17

# %% [markdown]
# ## C14: degrees of freedom
#
# Velocities: six components of the axes and the two axial spins, whether the rotors turn or not (of the six Euler angles,
# four for the axes, with the two unit lengths built in, and two for the spins). Constraints: the two unit lengths and the
# bar; the rank of their Jacobian along a shocked run, by its singular values, and beside it where both axes and the bar lie
# in one line. Without its bar the pair has 6 and 4.

# %%
C14

# %% [markdown]
# ## C15: the ansatz and its integrals
#
# On exact orbits: the largest sum of the rates of the azimuths over their mean size, of the spin angles over the spin; the
# swing of A over the part of A that the motion makes, $A - 2G$; and the powers of $r_0$ with which they go. Agreeing, and
# constant, mean within 5 %. A deviation that vanishes with the amplitude holds for small ones, and the amplitude is sought
# at which the larger sum is 5 %. One that does not vanish holds for none: so it is with A and the paper's own bar.
# B is measured in the paper's program, which does not presume it.

# %%
C15

# %% [markdown]
# ## C16: the swing of the link
#
# The ansatz applied to the exact orbit: azimuths $\pm\phi$ with $\phi$ half the difference of the two, once with $\theta$
# constant and once with the paper's correction. Printed: from 1 to $\sqrt{1 + 4r_0^2}$. The correction is of order $r_0^2$;
# it removes the swing to that order if what is left goes with a higher power. With the other sign it doubles the swing. The
# length that the link then keeps is given beside it.

# %%
C16

# %% [markdown]
# ## C17: the rate after the correction
#
# With constant inclination and no bar, each rotor precesses at $G/(J\cos\theta_0)$. The exact rate against it, massless
# bar. Unchanged: by less than a tenth of $r_0^2$, the order of the correction. For equal spins, whose axes go round together,
# it is unchanged.

# %%
C17
