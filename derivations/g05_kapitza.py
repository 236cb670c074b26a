# %% [markdown]
# # Kapitza's pendulum
#
# **Objective.** The equation of a pendulum with a vibrating pivot, the averaged potential, and the stability of the upright
# position.
#
# **Assumptions.** The vertical position of the pivot is $A\cos\omega t$. Averaging assumes $A\ll l$ and a high frequency.
#
# **Notation.** $\theta$ the angle from the downward vertical.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, accelerations, coordinates, t
from lagrotor.paper import Remark, prove, scientific

m, l, g, A, w = sp.symbols("m l g A omega", positive=True)
c = coordinates("theta")
(theta,), (theta_v,) = c.q, c.v
bob = Frame(c).moved(0, 0, A * sp.cos(w * t)).turned("y", -theta).body(m, centre=(0, 0, -l))
pendulum = System(c, bob.kinetic - bob.potential((0, 0, -g)))

# %% [markdown]
# ## The equation of motion (Landau & Lifshitz, §30)
#
# The acceleration of the pivot adds to gravity.

# %%
(acceleration,) = accelerations(pendulum.L, c)
prove(
    acceleration,
    -(g - A * w**2 * sp.cos(w * t)) * sp.sin(theta) / l,
    "the acceleration in the frame of the pivot",
    names=r"\ddot\theta",
)

# %% [markdown]
# ## The averaged potential
#
# The fast oscillation $\xi$ obeys $\ddot\xi = (A\omega^2/l)\cos\omega t\,\sin\theta$, so $\xi=-(A/l)\cos\omega t\,\sin\theta$.
# With the mean of its force the averaged potential is $-mgl\cos\theta + \tfrac14 mA^2\omega^2\sin^2\theta$. Its curvature at
# $\theta=\pi$ is positive if $A^2\omega^2>2gl$.

# %%
fast = -A / l * sp.cos(w * t) * sp.sin(theta)
driving = A * w**2 * sp.cos(w * t) * sp.sin(theta) / l
prove(sp.diff(fast, t, 2), driving, "the equation of the fast oscillation", names=r"\ddot\xi")

# %%
period = 2 * sp.pi / w
mean_force = sp.integrate(sp.expand(sp.diff(driving, theta) * fast), (t, 0, period)) / period
averaged = System(c, m * l**2 * theta_v**2 / 2 + m * g * l * sp.cos(theta) - m * A**2 * w**2 * sp.sin(theta) ** 2 / 4)
prove(
    mean_force * m * l**2,
    -sp.diff(m * A**2 * w**2 * sp.sin(theta) ** 2 / 4, theta),
    "the mean force is the derivative of the additional potential",
)

# %%
upright = averaged.linearise({theta: sp.pi}).stable_if
prove(
    upright.lhs,
    A**2 * w**2 - 2 * g * l,
    "the upright position is linearly stable if this is positive",
    names=r"A^2\omega^2-2gl",
)

# %% [markdown]
# ## Comparison with the textbook's equation
#
# The textbook's equation is integrated independently.

# %%
values, times, twin = {m: 1.0, l: 0.5, g: 9.81, A: 0.05, w: 100.0}, np.linspace(0, 1.5, 151), {A: 0.0501}


def textbook(s: float, y: np.ndarray) -> list[float]:
    return [y[1], -(9.81 - 0.05 * 1e4 * np.cos(100 * s)) * np.sin(y[0]) / 0.5]


def difference(parameters: dict) -> float:
    """The largest difference of the angles."""
    run = pendulum.simulate(parameters, (3.0,), (0,), times, tol=1e-10)
    reference = solve_ivp(textbook, (0, 1.5), [3.0, 0], "DOP853", times, rtol=1e-13, atol=1e-13).y[0]
    return float(np.abs(run.q[:, 0] - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of the angles within 1.5 s is {scientific(off, 1)} rad.")

# %% [markdown]
# ## The upright position
#
# At $\omega=100$ rad/s, above the threshold, the pendulum stays near the upright position $\theta=\pi$. At 50 rad/s it falls.
# The picture shows the first motion.

# %%
standing = pendulum.simulate(values, (3.0,), (0,), times)
falling = pendulum.simulate({**values, w: 50.0}, (3.0,), (0,), times)
assert 0.05**2 * 100**2 > 2 * 9.81 * 0.5 > 0.05**2 * 50**2
assert np.abs(standing.q - np.pi).max() < 0.3 and np.abs(falling.q - np.pi).max() > 1
picture = standing.plot()
picture
