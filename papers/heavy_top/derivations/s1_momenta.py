# %% [markdown]
# # The top and its momenta
#
# **Objective.** The Lagrangian of a symmetric body with a fixed tip, its two momenta, and the motion of the inclination.
#
# **Assumptions.** A rigid body of mass $m$ whose tip is fixed on its axis, at the distance $l$ from the centre of mass.
#
# **Notation.** $\phi,\theta,\psi$ Euler's angles; $I_1$ and $I_3$ the inertias about the tip.

# %%
import sympy as sp
from symbols import I_1, c, p_phi, p_psi
from top import top

from lagrotor.mechanics import momenta
from lagrotor.paper import prove, verdict

_, theta, _ = c.q
phi_v, theta_v, psi_v = c.v

# %% [markdown]
# ## The Lagrangian
#
# `top.py` turns a body by Euler's angles; its transverse inertia about the centre is $I_1 - ml^2$.

# %%
verdict("1.1", top.L)

# %% [markdown]
# ## The momenta
#
# The azimuth and the spin angle do not enter the Lagrangian, so their momenta are conserved.

# %%
about_vertical, _, about_axis = momenta(top.L, c)
verdict("1.2", about_axis)

# %%
verdict("1.3", about_vertical)

# %% [markdown]
# Solved for the velocities:

# %%
velocities = sp.solve([about_vertical - p_phi, about_axis - p_psi], [phi_v, psi_v], dict=True)[0]
verdict("1.4", velocities[phi_v], uses=["1.2", "1.3"])

# %%
verdict("1.5", velocities[psi_v], uses=["1.2", "1.3"])

# %% [markdown]
# ## The effective potential
#
# With both momenta given, Routh's function is left with the inclination alone; what does not move in it is $-V$.

# %%
reduced = top.routh("phi psi")
potential = -reduced.L.subs(theta_v, 0)
prove(reduced.L, I_1 * theta_v**2 / 2 - potential, "Routh's function", names="R")

# %%
verdict("1.6", potential, uses=["1.4", "1.5"])

# %%
(acceleration,) = sp.solve(reduced.motion[0], reduced.c.a[0])
verdict("1.7", acceleration, uses=["1.6"])
