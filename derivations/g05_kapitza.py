# %% [markdown]
# # Kapitza's pendulum
#
# **Objective.** The equation of a pendulum whose pivot is shaken, the averaged potential, and when it stands upright.
#
# **Assumptions.** The pivot moves as $A\cos\omega t$ up and down; averaging is for $A\ll l$ and fast shaking.
#
# **Notation.** $\theta$ from the downward vertical.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, accelerations, coordinates, t
from lagrotor.paper import prove

m, l, g, A, w = sp.symbols("m l g A omega", positive=True)
c = coordinates("theta")
(theta,), (theta_v,) = c.q, c.v
bob = Frame(c).moved(0, 0, A * sp.cos(w * t)).turned("y", -theta).body(m, centre=(0, 0, -l))
pendulum = System(c, bob.kinetic - bob.potential((0, 0, -g)))

# %% [markdown]
# ## The equation of motion (Landau & Lifshitz, §30): gravity in the accelerated frame of the pivot

# %%
(turned,) = accelerations(pendulum.L, c)
prove(turned, -(g - A * w**2 * sp.cos(w * t)) * sp.sin(theta) / l, "gravity in the pivot's frame", names=r"\ddot\theta")

# %% [markdown]
# ## Averaged
#
# The fast part $\xi$ follows $\ddot\xi = (A\omega^2/l)\cos\omega t\,\sin\theta$, so $\xi=-(A/l)\cos\omega t\,\sin\theta$.
# The mean of its force leaves the potential $-mgl\cos\theta + \tfrac14 mA^2\omega^2\sin^2\theta$, whose curvature
# at $\theta=\pi$ is positive if $A^2\omega^2>2gl$.

# %%
fast = -A / l * sp.cos(w * t) * sp.sin(theta)
driving = A * w**2 * sp.cos(w * t) * sp.sin(theta) / l
prove(sp.diff(fast, t, 2), driving, "the fast part follows the drive", names=r"\ddot\xi")

# %%
period = 2 * sp.pi / w
mean_force = sp.integrate(sp.expand(sp.diff(driving, theta) * fast), (t, 0, period)) / period
averaged = System(c, m * l**2 * theta_v**2 / 2 + m * g * l * sp.cos(theta) - m * A**2 * w**2 * sp.sin(theta) ** 2 / 4)
prove(
    mean_force * m * l**2, -sp.diff(m * A**2 * w**2 * sp.sin(theta) ** 2 / 4, theta), "its mean force has a potential"
)

# %%
upright = averaged.linearise({theta: sp.pi}).stable_if
prove(upright.lhs, A**2 * w**2 - 2 * g * l, "upright is stable where this is positive", names=r"A^2\omega^2-2gl")

# %% [markdown]
# ## Against the textbook's equation, integrated independently; and the threshold, measured

# %%
values, times, twin = {m: 1.0, l: 0.5, g: 9.81, A: 0.05, w: 100.0}, np.linspace(0, 1.5, 151), {A: 0.0501}


def textbook(s: float, y: np.ndarray) -> list[float]:
    return [y[1], -(9.81 - 0.05 * 1e4 * np.cos(100 * s)) * np.sin(y[0]) / 0.5]


def difference(given: dict) -> float:
    """The largest difference of the angles."""
    run = pendulum.simulate(given, (3.0,), (0,), times, tol=1e-10)
    other = solve_ivp(textbook, (0, 1.5), [3.0, 0], "DOP853", times, rtol=1e-13, atol=1e-13).y[0]
    return float(np.abs(run.q[:, 0] - other).max())


off = difference(values)
assert off < 1e-9
off

# %%
standing = pendulum.simulate(values, (3.0,), (0,), times)
falling = pendulum.simulate({**values, w: 50.0}, (3.0,), (0,), times)
assert 0.05**2 * 100**2 > 2 * 9.81 * 0.5 > 0.05**2 * 50**2
assert np.abs(standing.q - np.pi).max() < 0.3 and np.abs(falling.q - np.pi).max() > 1
picture = standing.plot()
picture
