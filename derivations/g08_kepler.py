# %% [markdown]
# # Kepler's problem
#
# **Objective.** Conservation of angular momentum and of the Laplace–Runge–Lenz vector in Cartesian coordinates; the elliptic
# orbit.
#
# **Assumptions.** A mass $m$ in the potential $-k/r$ of a fixed centre, in a plane.
#
# **Notation.** $r=\sqrt{x^2+y^2}$, $\ell$ the angular momentum, $A=(A_x, A_y)$ the Laplace–Runge–Lenz vector.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, accelerations, coordinates, total_derivative
from lagrotor.paper import Remark, prove, scientific

m, k = sp.symbols("m k", positive=True)
c = coordinates("x y")
(x, y), (x_v, y_v) = c.q, c.v
r = sp.sqrt(x**2 + y**2)
planet = Frame(c).moved(x, y).body(m)
kepler = System(c, planet.kinetic + k / r)

# %% [markdown]
# ## The equations of motion

# %%
attraction = c.a[0] + k * x / (m * r**3), c.a[1] + k * y / (m * r**3)
prove(list(kepler.motion / m), attraction, "the equations of motion", names=("0", "0"))

# %% [markdown]
# ## Two symmetries
#
# Rotation of the plane gives the angular momentum. The second symmetry is not a map of points, because its field depends on
# the velocity, $\xi = m\,(-y\dot y,\; 2x\dot y-\dot x y)$. It changes $L$ by the time derivative of a gauge function
# (Lévy-Leblond 1971).

# %%
spin = kepler.noether((-y, x)).expression
prove(spin, m * (x * y_v - y * x_v), "the angular momentum, from rotation of the plane", names=r"\ell")

# %%
A = m * y_v * spin - m * k * x / r, -m * x_v * spin - m * k * y / r
field = m * (x * y_v - y * x_v) * sp.Matrix([0, 1]) + m * y_v * sp.Matrix([-y, x])
along_y = kepler.noether(list(field), gauge=m**2 * y_v * (x * y_v - y * x_v) + m * k * x / r)
prove(along_y.expression, A[0], "the Laplace–Runge–Lenz vector by Noether's theorem", names="A_x")

# %% [markdown]
# ## Conservation and the orbit
#
# The vector satisfies $|A|^2 = m^2k^2 + 2mE\ell^2$ and $A\cdot r = \ell^2 - mkr$. The orbit is therefore
# $r = \ell^2/(mk + |A|\cos\phi)$, an ellipse for $E<0$. Here $\phi$ is the angle from $A$ and
# $E$ the energy.

# %%
motion = dict(zip(c.a, accelerations(kepler.L, c), strict=True))
prove(
    [total_derivative(e, c).subs(motion) for e in A],
    (0, 0),
    "the vector is conserved",
    names=(r"\dot A_x", r"\dot A_y"),
)

# %%
assert all(kepler.conserved(e).answer == "zero" for e in (*A, spin, kepler.energy))
assert kepler.conserved(A[0] + k * x).answer == "nonzero"
prove(A[0] ** 2 + A[1] ** 2, m**2 * k**2 + 2 * m * kepler.energy * spin**2, "the length of the vector", names="|A|^2")

# %%
prove(A[0] * x + A[1] * y, spin**2 - m * k * r, "the equation of the orbit", names=r"A\cdot r")

# %% [markdown]
# ## Comparison with Kepler's equation
#
# Kepler's equation is $n\,t = u - e\sin u$ with the mean motion $n$, the eccentricity $e$ and the eccentric anomaly $u$.

# %%
values, times, twin = {m: 2.0, k: 2.0}, np.linspace(0, 20, 201), {k: 2.001}
eccentricity = 0.6


def difference(parameters: dict) -> float:
    """The largest distance between the two motions, for a semi-major axis of one."""
    run = kepler.simulate(
        parameters, (1 - eccentricity, 0), (0, np.sqrt((1 + eccentricity) / (1 - eccentricity))), times, 1e-9
    )
    u = times.copy()
    for _ in range(60):
        u -= (u - eccentricity * np.sin(u) - times) / (1 - eccentricity * np.cos(u))
    reference = np.stack([np.cos(u) - eccentricity, np.sqrt(1 - eccentricity**2) * np.sin(u)], 1)
    return float(np.abs(run.q - reference).max())


off = difference(values)
assert off < 1e-9
Remark(
    "Result",
    f"The largest distance between the two motions within 20 time units is {scientific(off, 1)} semi-major axes.",
)

# %% [markdown]
# ## The motion
#
# The orbit has the eccentricity 0.6 and the semi-major axis 1. It starts at the pericentre.

# %%
picture = kepler.simulate(values, (1 - eccentricity, 0), (0, 2.0), times).plot()
picture
