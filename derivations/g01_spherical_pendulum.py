# %% [markdown]
# # A spherical pendulum
#
# **Objective.** The equations of a mass on a rod that may swing any way, its conserved momentum, its conical motion and the
# frequency of small departures from it.
#
# **Assumptions.** A point of mass $m$ on a rigid rod of length $l$ without mass; gravity $g$.
#
# **Notation.** $\theta$ from the downward vertical, $\varphi$ the azimuth.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import prove

m, l, g, Omega, tilt = sp.symbols("m l g Omega theta_0", positive=True)
c = coordinates("phi theta")
(phi, theta), (phi_v, theta_v) = c.q, c.v
bob = Frame(c).turned("zy", (phi, -theta)).body(m, centre=(0, 0, -l))
pendulum = System(c, bob.kinetic - bob.potential((0, 0, -g)))

# %% [markdown]
# ## The Lagrangian and what is conserved
#
# $\varphi$ is cyclic; its momentum is the angular momentum about the vertical (Landau & Lifshitz, §14, problem 1).

# %%
swinging = m * l**2 * (theta_v**2 + phi_v**2 * sp.sin(theta) ** 2) / 2 + m * g * l * sp.cos(theta)
prove(pendulum.L, swinging, "the Lagrangian of the sketch is the textbook's", names="L")

# %%
assert pendulum.cyclic == (phi,)
momentum = pendulum.noether((1, 0)).expression
prove(momentum, m * l**2 * phi_v * sp.sin(theta) ** 2, "the momentum of the azimuth", names=r"p_\varphi")

# %% [markdown]
# ## The conical pendulum
#
# It turns steadily at $\Omega^2 = g/(l\cos\theta_0)$. Departures from the cone swing at
# $\omega^2 = \Omega^2(1 + 3\cos^2\theta_0)$: between $2\Omega$ near the vertical and $\Omega$ near the horizontal.

# %%
steady = System(c, pendulum.L.subs(g, l * Omega**2 * sp.cos(tilt))).linearise({theta: tilt, phi_v: Omega})
s = sp.Symbol("s")
squared = -(steady.characteristic(s) / (steady.mass.det() * s**2) - s**2)
prove(-squared, Omega**2 * (1 + 3 * sp.cos(tilt) ** 2), "the frequency of nodding about the cone", names=r"\omega^2")

# %% [markdown]
# ## Against the mass in Cartesian coordinates
#
# The same mass as $(x, y, z)$ under its tension, $\ddot r = -g e_z - (|\dot r|^2 - g z) r / l^2$, integrated independently.

# %%
values = {m: 1.3, l: 0.8, g: 9.81}
times = np.linspace(0, 4, 81)
twin = {g: 9.80}


def tension(_: float, y: np.ndarray) -> np.ndarray:
    r, v = y[:3], y[3:]
    return np.concatenate([v, -9.81 * np.eye(3)[2] - (v @ v - 9.81 * r[2]) * r / 0.64])


def difference(given: dict) -> float:
    """The largest distance between the two, m."""
    run = pendulum.simulate(given, (0, 1), (1.5, 0), times, tol=1e-12)
    start = 0.8 * np.array([np.sin(1), 0, -np.cos(1), 0, 1.5 * np.sin(1), 0])
    other = solve_ivp(tension, (0, 4), start, "DOP853", times, rtol=1e-13, atol=1e-13).y[:3].T
    place = np.stack([run.evaluate(e) for e in bob.frame.place(bob.centre)], 1)
    return float(np.abs(place - other).max())


off = difference(values)
assert off < 1e-9
off

# %%
picture = pendulum.simulate(values, (0, 1), (1.5, 0), times).plot()
picture
