# %% [markdown]
# # Claims of section 3: the simulator (C03 to C05)
#
# **Objective.** The finite rotation, the step without inversions, and springs in place of joints.
#
# **Assumptions.** The paper's step of 1 ms. Its stiffness and damping are $S = 2000(M/n)\omega_s^2$,
# $D = 500(M/n)\omega_s$ with $n$ and $\omega_s$ not given: n = 20, $\omega_s$ = 10 make them 10⁴ N/m and 250 kg/s (C08).
#
# What is measured, and how it is decided: `lagrotor/paper/rotor_pair/claims/simulator.py`.

# %%
from lagrotor.paper.rotor_pair.claims.simulator import C03, C04, C05

# %% [markdown]
# ## C03: orthogonality
#
# How far $1 + \Delta t\,\Omega_\times$ and the Rodrigues rotation are from orthogonal after one step at the paper's spin,
# against the rounding of a few products of matrices; and what ten seconds of such steps do to a length. For a step of
# 10⁻⁹ s the first is orthogonal to rounding: the claim is about a finite step.

# %%
C03

# %% [markdown]
# ## C04: no inversion in a step
#
# All of numpy's ways to invert or solve are counted during a hundred steps of the paper's three bodies and of one free body
# of unequal inertia. Its $\Omega$ is then compared with the solution of $R I_0 R^T\Omega = L$, since a step that inverts
# nothing could also be wrong. A program that turns and inverts the inertia at each step is counted 400 times; one with
# the printed transform inverts nothing and has the wrong $\Omega$.

# %%
C04

# %% [markdown]
# ## C05: springs as joints
#
# The equal pair with the shock of section 4.2 against the exact pair with a rigid bar: the largest gap of the links over
# the motion of the tips, and the largest error of the axes over the motion of the axes. A joint is enforced where both are
# below a tenth. Springs of 100 N/m, which answer more slowly than the pair moves, do not enforce it.

# %%
C05
