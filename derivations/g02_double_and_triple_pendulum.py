# %% [markdown]
# # Double and triple pendulum
#
# **Objective.** The equations of the double and the triple pendulum, their frequencies of small oscillations, and the Lyapunov
# exponent of a large motion.
#
# **Assumptions.** Equal point masses $m$ on equal massless rods of length $l$, in a plane; gravity $g$.
#
# **Notation.** $q_i$ the angle of rod $i$ from the rod above it, $\theta_i=q_1+\dots+q_i$ the angle from the vertical.

# %%
import warnings

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.errors import LagrotorWarning
from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import Remark, prove, scientific

m, l, g = sp.symbols("m l g", positive=True)


def pendulum(n: int) -> System:
    c = coordinates([f"q_{i + 1}" for i in range(n)])
    frame, L = Frame(c), 0
    for angle in c.q:
        frame = frame.turned("y", angle)
        bob = frame.body(m, centre=(0, 0, -l))
        L, frame = L + bob.kinetic - bob.potential((0, 0, -g)), frame.moved(0, 0, -l)
    return System(c, L)


# %% [markdown]
# ## Two rods
#
# In the angles from the vertical this is the Lagrangian of Landau & Lifshitz, §5, problem 1.

# %%
double, angles = pendulum(2), coordinates("theta_1 theta_2")
(a, b), (a_v, b_v) = angles.q, angles.v
absolute = double.in_coordinates(angles, dict(zip(double.c.q, (a, b - a), strict=True)))
kinetic = m * l**2 * (2 * a_v**2 + b_v**2 + 2 * a_v * b_v * sp.cos(a - b)) / 2
prove(absolute.L, kinetic + m * g * l * (2 * sp.cos(a) + sp.cos(b)), "the Lagrangian of two rods", names="L")

# %%
pull = g / l
above = 2 * angles.a[0] + angles.a[1] * sp.cos(a - b) + b_v**2 * sp.sin(a - b) + 2 * pull * sp.sin(a)
below = angles.a[1] + angles.a[0] * sp.cos(a - b) - a_v**2 * sp.sin(a - b) + pull * sp.sin(b)
prove(list(absolute.motion / (m * l**2)), (above, below), "the equations of motion", names=("0", "0"))

# %%
s = sp.Symbol("s")
small = absolute.linearise({a: 0, b: 0})
prove(
    small.characteristic(s) / small.mass.det(),
    (s**2 + (2 + sp.sqrt(2)) * g / l) * (s**2 + (2 - sp.sqrt(2)) * g / l),
    "the two frequencies of small oscillations are $\\omega^2=(2\\pm\\sqrt2)\\,g/l$",
    names=r"\det(s^2M+K)/\det M",
)

# %% [markdown]
# ## Three rods
#
# The squares of the frequencies are the roots of a cubic. In units of $g/l$ they are the roots of the Laguerre polynomial $L_3$.

# %%
triple = pendulum(3)
hanging = triple.linearise(dict.fromkeys(triple.c.q, 0))
polynomial = hanging.characteristic(s) / hanging.mass.det() * (l / g) ** 3
prove(polynomial, 6 * sp.laguerre(3, -(s**2) * l / g), "the cubic equation of three rods")

# %% [markdown]
# ## Comparison with the textbook's equations
#
# The textbook's equations in the angles from the vertical are integrated independently.

# %%
values, times = {m: 1.0, l: 0.7, g: 9.81}, np.linspace(0, 2, 51)
twin = {l: 0.701}


def textbook(_: float, y: np.ndarray, below: np.ndarray) -> np.ndarray:
    theta, rate = y.reshape(2, -1)
    apart = theta[:, None] - theta[None, :]
    force = -(below * np.sin(apart)) @ rate**2 - np.diag(below) * 9.81 / 0.7 * np.sin(theta)
    return np.concatenate([rate, np.linalg.solve(below * np.cos(apart), force)])


def difference(parameters: dict) -> float:
    """The largest difference of an angle in the two systems."""
    differences = []
    for system, start in ((double, (0.5, 0.3)), (triple, (0.5, 0.3, -0.2))):
        run = system.simulate(parameters, start, np.zeros(len(start)), times, tol=1e-12)
        y = np.concatenate([np.cumsum(start), np.zeros(len(start))])
        n = np.arange(len(start))
        below = len(n) - np.maximum.outer(n, n)
        reference = solve_ivp(textbook, (0, 2), y, "DOP853", times, args=(below,), rtol=1e-13, atol=1e-13).y.T
        differences.append(np.abs(np.cumsum(run.q, axis=1) - reference[:, : len(start)]).max())
    return float(max(differences))


off = difference(values)
assert off < 1e-9
Remark(
    "Result", f"The largest difference of an angle within 2 s, for two and for three rods, is {scientific(off, 1)} rad."
)

# %% [markdown]
# ## Lyapunov exponent
#
# A large motion of two rods is chaotic: its largest Lyapunov exponent is positive and exceeds its error more than four times.
# Neighbouring motions separate exponentially, so no integration is accurate for the whole run. The exponent is a mean over the
# run and does not require this.

# %%
with warnings.catch_warnings():
    warnings.simplefilter("ignore", LagrotorWarning)  # the horizon is stated below
    wide = double.simulate(values, (2.0, 0.5), (0, 0), np.linspace(0, 40, 401), tol=1e-9)
chaos = wide.lyapunov()
assert chaos.exponent > 4 * chaos.error
Remark(
    "Exponent",
    f"The Lyapunov exponent is {chaos.exponent:.2f} ± {chaos.error:.2f} per second. With a relative tolerance of 1e-9 the run "
    f"is accurate for {wide.horizon:.1f} s.",
)

# %%
picture = wide.plot()
picture
