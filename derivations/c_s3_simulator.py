# %% [markdown]
# # Claims of section 3: the simulator (C03 to C05)
#
# **Objective.** The finite rotation, the step without matrix inversions, and springs instead of joints.
#
# **Assumptions.** The paper's step of 1 ms. Its stiffness and damping are $S = 2000(M/n)\omega_s^2$, $D = 500(M/n)\omega_s$.
# The paper does not give $n$ and $\omega_s$; n = 20, $\omega_s$ = 10 give 10⁴ N/m and 250 kg/s (C08).
#
# The measurement and the decision are in `lagrotor/paper/rotor_pair/claims/simulator.py`.

# %%
from lagrotor.paper.rotor_pair.claims.simulator import C03, C04, C05

# %% [markdown]
# ## C03: orthogonality
#
# The deviation of $1 + \Delta t\,\Omega_\times$ and of the Rodrigues rotation from orthogonality after one step at the
# paper's spin, compared with the rounding error of a few matrix products. The change of a length after ten seconds of such
# steps is given, too. For a step of 10⁻⁹ s the first matrix is orthogonal to rounding: the claim is about a finite step.

# %%
C03

# %% [markdown]
# ## C04: no inversion in a step
#
# All functions of numpy that invert or solve are counted during a hundred steps of the paper's three bodies and of one free
# body of unequal inertia. A step that inverts nothing could still be wrong, so its $\Omega$ is compared with the solution of
# $R I_0 R^T\Omega = L$. Two controls: a program that rotates and inverts the inertia at each step is counted 400 times; a
# program with the printed transform inverts nothing and has the wrong $\Omega$.

# %%
C04

# %% [markdown]
# ## C05: springs as joints
#
# The equal pair with the shock of section 4.2, compared with the exact pair with a rigid bar. Two ratios are measured: the
# largest gap of the links over the motion of the tips, and the largest error of the axes over the motion of the axes. The
# springs enforce a joint if both are below a tenth. Springs of 100 N/m, which respond more slowly than the pair moves, do
# not.

# %%
C05
