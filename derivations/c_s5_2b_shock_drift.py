# %% [markdown]
# # Claims of section 5.2.1: the confirmation of the theory (C18, C19)
#
# **Objective.** The paper's comparison of its formula with the simulation, repeated on exact runs.
#
# **Assumptions.** Opposite spins ±10, the bar of 5.2.1 ($m = 0.01$, $K = 0.1$), the shock of the listing: 40 N along x and
# −11 N along y, width 1/20 s. $r_0 = 0.204$ is the paper's amplitude (figure 21).
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/precession_and_drift.py`.

# %%
from lagrotor.paper.rotor_pair.claims.precession_and_drift import C18, C19

# %% [markdown]
# ## C18: pinched valleys and peaks
#
# In the formula the ratio of the second harmonic of $x_1$ to the first, in phase with it, is $-r_0/2$; in $x_2$ it is
# $+r_0/2$. So the valleys of the left curve and the peaks of the right curve are pinched. A least-squares fit gives the same
# two numbers for the exact run, at the best rate within a tenth of the natural one. Only the component in phase pinches the
# curve. The other component slants it, which the paper ascribes to a mixture of $y$.
#
# The paper calls the pinching *visibly shared* by formula and simulation, and gives no size. "Shared" means that the run is
# closer to the formula than to a plain sine: its second harmonic agrees with the formula within half of it. "Visible" refers
# to the widths of peaks and valleys: $\cos\Phi+\varepsilon\cos2\Phi$ is positive for $\pi-2\varepsilon$ of its phase and
# negative for $\pi+2\varepsilon$. The difference is visible if $4\varepsilon/\pi$ exceeds 5 %. A heavier bar, or a quarter of
# the shock, has the right signs and fails this test.

# %%
C18

# %% [markdown]
# ## C19: the skew axis
#
# The angle between x and the line through the centres of precession of the two tips. The angle is small if $\sin\alpha =
# \alpha$ within one per cent, that is up to 14°. It is proportional to the shock; a quarter of the paper's shock would give a
# small one.
#
# The components along that line are fitted by the formula with free amplitude, rate, phase and one common shift. The distance
# of the centres is as printed (5.22) or as corrected ($x_1 + r_0^2$, $x_2 - r_0^2$). The residual is the root mean square
# over the amplitude. A second fit with free centres compares the shapes only. Both are compared with the residual of a plain
# sine with free centres, which lacks the second harmonic of the formula. The formula agrees if its residual is smaller than
# that of the plain sine. The correction is the cause if its residual is also below half of the printed formula's.

# %%
C19
