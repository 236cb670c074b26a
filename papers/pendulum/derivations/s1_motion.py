# %% [markdown]
# # The equation of motion
#
# **Objective.** The equation that the paper prints, from the Lagrangian.
#
# **Assumptions.** A bob on a rod without mass, no friction.
#
# **Notation.** $\theta$ the angle from the vertical, $l$ the length, $m$ the mass, $g$ the acceleration of free fall.

# %%
import sympy as sp
from symbols import c, g, l, m

from lagrotor.mechanics import System
from lagrotor.paper import prove, verdict

(theta,), (theta_v,), (theta_a,) = c.q, c.v, c.a
pendulum = System(c, m * l**2 * theta_v**2 / 2 + m * g * l * sp.cos(theta))

# %% [markdown]
# Lagrange's equation $\frac{d}{dt}\frac{\partial L}{\partial\dot\theta} - \frac{\partial L}{\partial\theta} = 0$ is

# %%
prove(pendulum.motion[0], m * l**2 * theta_a + m * g * l * sp.sin(theta), "Lagrange's equation", names=r"0")

# %% [markdown]
# Solved for the acceleration it is the general result. No small angle is put in here: the paper prints $\theta$ for
# $\sin\theta$, and claims it to first order, which is what is judged.

# %%
(acceleration,) = sp.solve(pendulum.motion[0], theta_a)
verdict("1.1", acceleration)
