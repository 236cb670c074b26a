# %% [markdown]
# # A spherical pendulum
#
# **Objective.** The equations of a pendulum that moves in three dimensions, its conserved momentum, its conical motion and the
# frequency of small perturbations of the conical motion.
#
# **Assumptions.** A point mass $m$ on a rigid massless rod of length $l$; gravity $g$.
#
# **Notation.** $\theta$ from the downward vertical, $\phi$ the azimuth.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import Remark, prove, scientific

m, l, g, Omega, tilt = sp.symbols("m l g Omega theta_0", positive=True)
c = coordinates("phi theta")
(phi, theta), (phi_v, theta_v) = c.q, c.v
bob = Frame(c).turned("zy", (phi, -theta)).body(m, centre=(0, 0, -l))
pendulum = System(c, bob.kinetic - bob.potential((0, 0, -g)))

# %% [markdown]
# ## The equations of motion

# %%
pendulum

# %% [markdown]
# ## The Lagrangian and the conserved momentum
#
# The azimuth $\phi$ is cyclic. Its momentum is the angular momentum about the vertical (Landau & Lifshitz, §14, problem 1).

# %%
swinging = m * l**2 * (theta_v**2 + phi_v**2 * sp.sin(theta) ** 2) / 2 + m * g * l * sp.cos(theta)
prove(pendulum.L, swinging, "the Lagrangian of the bodies equals the textbook's", names="L")

# %%
assert pendulum.cyclic == (phi,)
momentum = pendulum.noether((1, 0)).expression
prove(momentum, m * l**2 * phi_v * sp.sin(theta) ** 2, "the momentum of the azimuth", names=r"p_\phi")

# %% [markdown]
# ## The conical pendulum
#
# The pendulum rotates uniformly at $\Omega^2 = g/(l\cos\theta_0)$. Small perturbations of the cone oscillate at
# $\omega^2 = \Omega^2(1 + 3\cos^2\theta_0)$. This frequency is $2\Omega$ near the vertical and $\Omega$ near the horizontal.

# %%
steady = System(c, pendulum.L.subs(g, l * Omega**2 * sp.cos(tilt))).linearise({theta: tilt, phi_v: Omega})
s = sp.Symbol("s")
squared = -(steady.characteristic(s) / (steady.mass.det() * s**2) - s**2)
prove(
    -squared, Omega**2 * (1 + 3 * sp.cos(tilt) ** 2), "the frequency of oscillations about the cone", names=r"\omega^2"
)

# %% [markdown]
# ## Comparison with Cartesian coordinates
#
# In Cartesian coordinates $(x, y, z)$ the tension of the rod gives $\ddot r = -g e_z - (|\dot r|^2 - g z) r / l^2$. This
# equation is integrated independently.

# %%
values = {m: 1.3, l: 0.8, g: 9.81}
times = np.linspace(0, 4, 81)
twin = {g: 9.80}


def tension(_: float, y: np.ndarray) -> np.ndarray:
    r, v = y[:3], y[3:]
    return np.concatenate([v, -9.81 * np.eye(3)[2] - (v @ v - 9.81 * r[2]) * r / 0.64])


def difference(parameters: dict) -> float:
    """The largest distance between the two motions, m."""
    run = pendulum.simulate(parameters, (0, 1), (1.5, 0), times, tol=1e-12)
    start = 0.8 * np.array([np.sin(1), 0, -np.cos(1), 0, 1.5 * np.sin(1), 0])
    reference = solve_ivp(tension, (0, 4), start, "DOP853", times, rtol=1e-13, atol=1e-13).y[:3].T
    place = np.stack([run.evaluate(e) for e in bob.frame.place(bob.centre)], 1)
    return float(np.abs(place - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest distance between the two motions within 4 s is {scientific(off, 1)} m.")

# %% [markdown]
# ## The motion
#
# The pendulum starts at $\theta=1$ rad with $\dot\phi=1.5$ rad/s. The inclination oscillates between two values, and the
# azimuth advances fastest at the smaller one.

# %%
picture = pendulum.simulate(values, (0, 1), (1.5, 0), times).plot()
picture
