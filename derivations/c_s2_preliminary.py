# %% [markdown]
# # Claims of section 2: the parallel pair (C01, C02)
#
# **Objective.** The motion of equal spins after a shock, and the question whether opposite spins respond like a pair without
# spin.
#
# **Assumptions.** The bar of section 4.1 ($m = K = 1$), the shock of section 4.2: 50 N along x on tip 1, width 1/50 s. Of the
# paper's two seconds of rest before the shock only ten widths are simulated. Figure 10 shows the motion of equal spins.
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/shock_toppling_and_twist.py`.

# %%
from lagrotor.paper.rotor_pair.claims.shock_toppling_and_twist import C01, C02
from lagrotor.paper.rotor_pair.runs import shocked_scene

shocked_scene((10, 10), (50, 0, 0))

# %% [markdown]
# ## C01: equal spins precess alike and stay displaced
#
# Each axis moves around its mean position, and the sense of this rotation is compared for both. "Remains" means two
# conditions: the mean over the last five cycles of 12 s equals the mean over the first five within one per cent, and it is
# not small compared with the oscillation.

# %%
C01

# %% [markdown]
# For comparison, (7) gives $P_x R/(2G)$. In section 5 the paper calls this motion trivial because the axes are "necessarily
# aligned at all times". They are aligned after a shock along the bar, but not after the same shock across the bar on one tip.
#
# ## C02: opposite spins respond as without spins
#
# The denominator of (7) is the sum of the spins. For equal and for unequal spins of one sign the mean displacement agrees with
# (7) within a tenth. For opposite spins the sum is zero, and the pair should fall as without spins. Two quantities are compared
# with a pair without spins, which is almost horizontal after 2.4 s: the largest x in the 2.4 s after a shock along the bar, and
# the rotation about the joint line after a shock across it.

# %%
C02

# %% [markdown]
# With a bar of 1000 kg m², which cannot be twisted, the same test is confirmed: (7) neglects the twist (C12).
