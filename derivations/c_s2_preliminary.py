# %% [markdown]
# # Claims of section 2: the parallel pair (C01, C02)
#
# **Objective.** What equal spins do after a shock, and whether opposite spins respond as if there were none.
#
# **Assumptions.** The bar of section 4.1 ($m = K = 1$), the shock of section 4.2: 50 N along x on tip 1, width 1/50 s.
# The paper's two seconds of rest before it are left out but for ten widths.
#
# What is measured, and how it is decided: `lagrotor/paper/rotor_pair/claims/shock_toppling_and_twist.py`.

# %%
from lagrotor.paper.rotor_pair.claims.shock_toppling_and_twist import C01, C02
from lagrotor.paper.rotor_pair.runs import shocked_scene

shocked_scene((10, 10), (50, 0, 0))

# %% [markdown]
# ## C01: equal spins precess alike and stay displaced
#
# Each axis goes round its mean position; the sense of that turning is compared for the two. "Remains" means that the mean
# over the last five cycles of 12 s is the mean over the first five, to one part in a hundred, and that it is not small
# beside the swing.

# %%
C01

# %% [markdown]
# For comparison: what (7) gives, $P_x R/(2G)$, and the paper's remark of section 5 that this motion is trivial because the
# axes are "necessarily aligned at all times". They are after a shock along the bar; after the same shock across the bar
# on one tip they are not.
#
# ## C02: opposite spins as if there were none
#
# (7) has the sum of the spins in its denominator. For equal and for unequal spins of one sign the mean displacement is
# that of (7), to one part in ten. For opposite spins the sum is zero, and the pair should fall as without spins: the
# largest x in the 2.4 s after a shock along the bar, and the turning about the joint line after one across it, are compared
# with those of a pair that does not spin, which by then has nearly fallen flat.

# %%
C02

# %% [markdown]
# With a bar of 1000 kg m², which cannot be twisted, the same test comes out as confirmed: it is the twist that (7) leaves
# out (C12).
