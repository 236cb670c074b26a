# %% [markdown]
# # A heavy symmetric top
#
# **Objective.** The Lagrangian of the top, its effective potential, steady precession, the stability threshold of the upright
# (sleeping) top, and nutation.
#
# **Assumptions.** A body with inertias $I_1, I_1, I_3$ about its centre, which is at the distance $l$ from a fixed tip.
#
# **Notation.** $\phi,\theta,\psi$ Euler's angles, $J=I_1+ml^2$, $p_\phi, p_\psi$ the momenta.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import Remark, prove, scientific

I1, I3, m, g, l = sp.symbols("I_1 I_3 m g l", positive=True)
c = coordinates("phi theta psi")
(phi, theta, psi), (phi_v, theta_v, psi_v) = c.q, c.v
body = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
top = System(c, body.kinetic - m * g * l * sp.cos(theta))
J = I1 + m * l**2

# %% [markdown]
# ## The equations of motion

# %%
top

# %% [markdown]
# ## The Lagrangian (Goldstein, §5.7)
#
# The precession $\phi$ and the spin $\psi$ are cyclic. The Routhian contains their momenta instead of their velocities.

# %%
turning = J * (theta_v**2 + phi_v**2 * sp.sin(theta) ** 2) / 2 + I3 * (psi_v + phi_v * sp.cos(theta)) ** 2 / 2
prove(top.L, turning - m * g * l * sp.cos(theta), "the Lagrangian of the body equals the textbook's", names="L")

# %%
assert top.cyclic == (phi, psi)
reduced = top.routh("phi psi")
p_phi, p_psi, p = sp.symbols("p_phi p_psi p", real=True)
effective = (p_phi - p_psi * sp.cos(theta)) ** 2 / (2 * J * sp.sin(theta) ** 2) + p_psi**2 / (2 * I3)
prove(reduced.L, J * theta_v**2 / 2 - effective - m * g * l * sp.cos(theta), "the Routhian", names="R")

# %% [markdown]
# ## Steady precession
#
# At any inclination with $p_\psi^2 \ge 4 J m g l\cos\theta$ steady precession has two values of $p_\phi$, one for slow and one
# for fast precession:

# %%
steady = reduced.equilibria("p_phi")
assert len(steady) == 2 and steady[0].domain == (p_psi**2 - sp.expand(4 * J * m * g * l * sp.cos(theta)) >= 0,)
slow_plus_fast = steady[0].at[p_phi] + steady[1].at[p_phi]
prove(
    slow_plus_fast,
    p_psi * (1 + sp.cos(theta) ** 2) / sp.cos(theta),
    "the sum of the two values",
    names=r"p_{\phi,1}+p_{\phi,2}",
)

# %% [markdown]
# ## The sleeping top
#
# In the upright position both momenta are equal. It is linearly stable if $p^2 > 4 J m g l$:

# %%
upright = top.routh({"phi": p, "psi": p}).linearise({theta: 0})
threshold = upright.stable_if.lhs
prove(threshold, p**2 - 4 * J * m * g * l, "the sleeping top's threshold", names=r"p^2-p_{\min}^2")

# %% [markdown]
# ## Comparison with Euler's equations
#
# Euler's equations of the body and the equation of its rotation matrix are integrated independently.

# %%
values = {I1: 0.3, I3: 0.5, m: 1.0, g: 9.81, l: 0.6}
times, twin = np.linspace(0, 2, 201), {I3: 0.501}
inertia = np.array([0.66, 0.66, 0.5])


def euler(_: float, y: np.ndarray) -> np.ndarray:
    Q, w = y[:9].reshape(3, 3), y[9:]
    torque = 0.6 * 9.81 * np.array([Q[2, 1], -Q[2, 0], 0])  # of the weight, on the arm along the axis
    spun = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    return np.concatenate([(Q @ spun).ravel(), (torque - spun @ (inertia * w)) / inertia])


def difference(parameters: dict) -> float:
    """The largest distance between the two unit vectors of the axis."""
    run = top.simulate(parameters, (0, 0.5, 0), (0, 0, 12), times, tol=1e-12)
    c_, s_ = np.cos(0.5), np.sin(0.5)
    start = np.array([[1, 0, 0], [0, c_, -s_], [0, s_, c_]])
    reference = solve_ivp(euler, (0, 2), [*start.ravel(), 0, 0, 12], "DOP853", times, rtol=1e-13, atol=1e-13).y
    axis = np.stack([run.evaluate(e) for e in body.frame.place((0, 0, 1))])
    return float(np.abs(axis - reference[[2, 5, 8]]).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest distance between the two unit vectors of the axis within 2 s is {scientific(off, 1)}.")

# %% [markdown]
# ## Nutation
#
# The axis is released at rest at $\theta=0.5$ with the spin 12 rad/s. The inclination oscillates between two turning points.

# %%
run = top.simulate(values, (0, 0.5, 0), (0, 0, 12), times)
turns = run.crossings(theta_v).q[:, 1]
picture = run.plot()
picture

# %%
Remark("Turning points", f"The inclination oscillates between {turns.min():.3f} and {turns.max():.3f} rad.")
