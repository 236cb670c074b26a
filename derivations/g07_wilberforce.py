# %% [markdown]
# # Wilberforce's pendulum
#
# **Objective.** The beats between vertical oscillation and twist of a mass on a coil spring.
#
# **Assumptions.** A linear coupling $\tfrac12\epsilon z\vartheta$ of stretch and twist. The two uncoupled frequencies are equal.
#
# **Notation.** $z$ the stretch, $\vartheta$ the twist, $I$ the inertia about the vertical, $k$ and
# $\delta$ the stiffnesses, $\omega^2=k/m=\delta/I$.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import Remark, prove, scientific

m, I, w, eps = sp.symbols("m I omega epsilon", positive=True)
c = coordinates("z vartheta")
(z, twist), (z_v, twist_v) = c.q, c.v
bob = Frame(c).moved(0, 0, z).turned("z", twist).body(m, (I, I, I))
springs = m * w**2 * z**2 / 2 + I * w**2 * twist**2 / 2 + eps * z * twist / 2
pendulum = System(c, bob.kinetic - springs)

# %% [markdown]
# ## The equations of motion

# %%
pendulum

# %% [markdown]
# ## Two modes (Berg & Marshall, Am. J. Phys. 59, 32)
#
# In both modes the stretch and the twist have equal energies.

# %%
s = sp.Symbol("s")
linear = pendulum.linearise({z: 0, twist: 0})
split = eps / (2 * sp.sqrt(m) * sp.sqrt(I))
factors = (s**2 + w**2 + split) * (s**2 + w**2 - split)
prove(
    linear.characteristic(s) / (m * I),
    sp.expand(factors),
    "the splitting of the frequencies",
    names=r"\det(s^2M+K)/(mI)",
)

# %% [markdown]
# The equilibrium is stable if

# %%
stable = linear.stable_if
stable

# %% [markdown]
# ## Comparison with the closed solution
#
# The mass is released from rest with the stretch $z_0$. With $\omega_{1,2}^2=\omega^2\pm\epsilon/(2\sqrt{mI})$ the solution
# is $z=\tfrac12 z_0(\cos\omega_1t+\cos\omega_2t)$ and $\vartheta=\tfrac12 z_0\sqrt{m/I}\,(\cos\omega_1t-\cos\omega_2t)$.
# After half a beat, at $t=\pi/(\omega_1-\omega_2)$, all energy is in the twist.

# %%
values, times, twin = {m: 0.5, I: 1e-4, w: 6.0, eps: 1e-2}, np.linspace(0, 40, 801), {eps: 1.001e-2}
first, second = (np.sqrt(36 + sign * 1e-2 / (2 * np.sqrt(0.5e-4))) for sign in (1, -1))


def difference(parameters: dict) -> float:
    """The largest difference of the stretches, m."""
    run = pendulum.simulate(parameters, (0.1, 0), (0, 0), times, tol=1e-11)
    return float(np.abs(run.q[:, 0] - 0.05 * (np.cos(first * times) + np.cos(second * times))).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of the stretches within 40 s is {scientific(off, 1)} m.")

# %% [markdown]
# ## The beats
#
# The mass is released with a stretch of 0.1 m. The amplitudes of stretch and twist alternate.

# %%
run = pendulum.simulate(values, (0.1, 0), (0, 0), times)
half_beat = np.pi / (first - second)
around = run.at(np.linspace(half_beat - 0.5, half_beat + 0.5, 101))
assert np.abs(around.q[:, 0]).max() < 0.01
picture = run.plot()
picture
