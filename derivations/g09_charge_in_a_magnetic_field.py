# %% [markdown]
# # A charge in crossed fields
#
# **Objective.** The Noether integrals of a charge in uniform magnetic and electric fields, in which translations require a gauge
# term; the gyration and drift of the charge.
#
# **Assumptions.** $B$ along $z$, $E$ along $y$, both constant; the symmetric gauge.
#
# **Notation.** $q$ the charge, $\omega = qB/m$ the cyclotron frequency.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, coordinates, t
from lagrotor.paper import Remark, prove, scientific

m, q, B, E = sp.symbols("m q B E", positive=True)
c = coordinates("x y z")
(x, y, z), (x_v, y_v, z_v) = c.q, c.v
particle = Frame(c).moved(x, y, z).body(m)
charge = System(c, particle.kinetic + q * B * (x * y_v - y * x_v) / 2 + q * E * y)

# %% [markdown]
# ## The equations of motion

# %%
charge

# %% [markdown]
# ## Three translations
#
# Only a translation along $z$ leaves $L$ unchanged. A translation along $x$ changes $L$ by $\tfrac12 qB\,\dot y$. A
# translation along $y$ changes $L$ by $-\tfrac12 qB\,\dot x+qE$.

# %%
guiding_y = charge.noether((1, 0, 0), gauge=q * B * y / 2).expression
guiding_x = charge.noether((0, 1, 0), gauge=-q * B * x / 2 + q * E * t).expression
expected = m * x_v - q * B * y, m * y_v + q * B * x - q * E * t
prove((guiding_y, guiding_x), expected, "the integrals of two translations", names=("P_x", "P_y"))

# %%
assert charge.cyclic == (z,)
drift = {x_v: E / B, y_v: 0, z_v: 0}
steady = charge.motion.subs(dict.fromkeys(c.a, 0)).subs(drift)
prove(
    steady, sp.zeros(3, 1), "the uniform drift E/B satisfies the equations of motion", names=r"m\ddot r-q(E+v\times B)"
)

# %% [markdown]
# ## Comparison with the closed solution
#
# The path in the plane $z=0$ is a circle with a uniform drift. With $\zeta=x+iy$ and $u=E/B$ it is
# $\zeta = (\dot\zeta_0-u)\,(1-e^{-i\omega t})/(i\omega) + u\,t$.

# %%
values, times, twin = {m: 1.5, q: 0.8, B: 2.0, E: 0.7}, np.linspace(0, 20, 201), {B: 2.001}


def difference(parameters: dict) -> float:
    """The largest distance between the two motions."""
    run = charge.simulate(parameters, (0, 0, 0), (1, 0.5, 0.2), times, tol=1e-12)
    w, u = 0.8 * 2 / 1.5, 0.7 / 2
    path = (1 - u + 0.5j) * (np.exp(-1j * w * times) - 1) / (-1j * w) + u * times
    reference = np.stack([path.real, path.imag, 0.2 * times], 1)
    return float(np.abs(run.q - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest distance between the two motions within 20 s is {scientific(off, 1)} m.")

# %% [markdown]
# ## The motion
#
# The charge gyrates in the plane, drifts along $x$ and moves uniformly along $z$.

# %%
picture = charge.simulate(values, (0, 0, 0), (1, 0.5, 0.2), times).plot()
picture
