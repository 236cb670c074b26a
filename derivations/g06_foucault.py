# %% [markdown]
# # Foucault's pendulum
#
# **Objective.** The exact rotation of the plane of oscillation in the frame of the ground at the latitude $\lambda$.
#
# **Assumptions.** Small oscillations: the bob moves in the horizontal plane under the force $-m(g/l)(x, y)$. The ground
# rotates about its vertical at $\Omega\sin\lambda$. The centrifugal force is included.
#
# **Notation.** $x, y$ coordinates on the ground, $n=\Omega\sin\lambda$.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, coordinates, t
from lagrotor.paper import Remark, prove, scientific

m, l, g, Omega, latitude = sp.symbols("m l g Omega lambda", positive=True)
n = Omega * sp.sin(latitude)
c = coordinates("x y")
(x, y), (x_v, y_v) = c.q, c.v
bob = Frame(c).turned("z", n * t).moved(x, y).body(m)
pendulum = System(c, bob.kinetic - m * g * (x**2 + y**2) / (2 * l))

# %% [markdown]
# ## The Lagrangian and the equations of motion
#
# The rotation of the ground adds a term linear in the velocity to the kinetic energy. It gives the Coriolis force.

# %%
turning = m * (x_v**2 + y_v**2) / 2 + m * n * (x * y_v - y * x_v) + m * n**2 * (x**2 + y**2) / 2
prove(pendulum.L, turning - m * g * (x**2 + y**2) / (2 * l), "the Lagrangian in the frame of the ground", names="L")

# %%
coriolis = c.a[0] - 2 * n * y_v + (g / l - n**2) * x, c.a[1] + 2 * n * x_v + (g / l - n**2) * y
prove(list(pendulum.motion / m), coriolis, "the equations of motion", names=("0", "0"))

# %% [markdown]
# ## Two circular motions
#
# The characteristic polynomial is $(s^2 + (\omega_0+n)^2)(s^2+(\omega_0-n)^2)$, so the frequencies
# are $\omega_0\pm n$ with $\omega_0=\sqrt{g/l}$.
# Because of their difference $2n$ the plane of oscillation rotates at the rate $-\Omega\sin\lambda$.

# %%
s, w0 = sp.Symbol("s"), sp.sqrt(g / l)
small = pendulum.linearise({x: 0, y: 0})
both = sp.expand((s**2 + (w0 + n) ** 2) * (s**2 + (w0 - n) ** 2))
prove(small.characteristic(s) / m**2, both, "the characteristic polynomial", names=r"\det(s^2M+sC+K)/m^2")

# %%
spin = pendulum.noether((-y, x)).expression
prove(spin, m * (x * y_v - y * x_v) + m * n * (x**2 + y**2), "the angular momentum in the inertial frame", names="p")

# %% [markdown]
# ## Comparison with the closed solution
#
# The path is an ellipse in the inertial frame. On the ground $\zeta = x+iy$ is
# $\zeta = e^{-int}\,(\zeta_0\cos\omega_0 t + (\dot\zeta_0+in\zeta_0)\sin(\omega_0t)/\omega_0)$.

# %%
values = {m: 28.0, l: 67.0, g: 9.81, Omega: 0.02, latitude: 0.85}
times, twin = np.linspace(0, 120, 601), {Omega: 0.0201}


def difference(parameters: dict) -> float:
    """The largest distance between the two motions, m."""
    run = pendulum.simulate(parameters, (3.0, 0), (0, 0), times, tol=1e-10)
    rate, frequency = 0.02 * np.sin(0.85), np.sqrt(9.81 / 67)
    in_space = 3 * np.cos(frequency * times) + 3j * rate * np.sin(frequency * times) / frequency
    return float(np.abs(run.q[:, 0] + 1j * run.q[:, 1] - np.exp(-1j * rate * times) * in_space).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest distance between the two motions within 2 min is {scientific(off, 1)} m.")

# %% [markdown]
# ## The motion
#
# The bob is released at rest 3 m east of its equilibrium. The plane of oscillation turns, so the amplitude along $x$ decreases
# and the amplitude along $y$ increases. For a visible rotation the ground turns at 0.02 rad/s.

# %%
picture = pendulum.simulate(values, (3.0, 0), (0, 0), times).plot()
picture
