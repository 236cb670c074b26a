# %% [markdown]
# # A four-bar linkage
#
# **Objective.** A closed loop of bars: its single degree of freedom, its motion under gravity, and the error of the loop closure.
#
# **Assumptions.** Three uniform bars of mass $\mu$ per length and lengths $a, b, c$; the ground bar has length $d$.
#
# **Notation.** $q_1, q_2, q_3$ the angle of each bar from the previous bar, in a vertical plane.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates, degrees_of_freedom
from lagrotor.paper import Remark, prove, scientific

mu, g, d = sp.symbols("mu g d", positive=True)
lengths = sp.symbols("a b c", positive=True)
angles = coordinates("q_1 q_2 q_3")
frame, L = Frame(angles), 0
for angle, length in zip(angles.q, lengths, strict=True):
    frame = frame.turned("y", -angle)
    inertia = mu * length**3 / 12
    bar = frame.body(mu * length, (0, inertia, inertia), (length / 2, 0, 0))
    L, frame = L + bar.kinetic - bar.potential((0, 0, -g)), frame.moved(length)
end = frame.place()
linkage = System(angles, L, (end[0] - d, end[2]))

# %% [markdown]
# ## The single degree of freedom
#
# If opposite bars have equal lengths ($c=a$, $d=b$), the loop can be a parallelogram. The coupler is then horizontal, $q_2=-q_1$.

# %%
a, b, c = lengths
q_1, q_2, q_3 = angles.q
closed = [e.subs({d: b, c: a}).subs({q_2: -q_1, q_3: q_1 - sp.pi}) for e in linkage.constraints]
prove(closed, (0, 0), "a parallelogram satisfies the loop constraints", names=("g_1", "g_2"))

# %% [markdown]
# For the lengths of the comparison below, the rank of the two constraints is computed at the initial position.

# %%
values = {mu: 2.0, g: 9.81, a: 0.4, b: 0.9, c: 0.7, d: 1.0}
q0, v0 = linkage.consistent(values, (1.0, -0.5, -1.5), (3.0, 0, 0))
freedom = degrees_of_freedom(linkage, dict(zip(angles.q, q0, strict=True)) | values)
assert freedom == 1
Remark("Degrees of freedom", f"Three angles and two independent constraints leave {freedom} degree of freedom.")

# %% [markdown]
# ## Comparison with angles from the horizontal
#
# The mass matrix and the multipliers in the angles from the horizontal are written by hand and integrated independently.

# %%
size = np.array([0.4, 0.9, 0.7])
mass, times, twin = 2 * size, np.linspace(0, 2, 81), {b: 0.9001}
lever = np.array([mass[i + 1 :].sum() + mass[i] / 2 for i in range(3)])
beyond = lever[np.maximum.outer(np.arange(3), np.arange(3))] - np.diag(mass / 6)
weight = np.outer(size, size) * beyond


def by_hand(_: float, y: np.ndarray) -> np.ndarray:
    theta, rate = y[:3], y[3:]
    apart, horizontal, vertical = theta[:, None] - theta[None, :], size * np.cos(theta), size * np.sin(theta)
    force = -(weight * np.sin(apart)) @ rate**2 - 9.81 * lever * horizontal
    rows = np.array([-vertical, horizontal])
    bent = np.array([horizontal, vertical]) @ rate**2
    whole = np.block([[weight * np.cos(apart), rows.T], [rows, np.zeros((2, 2))]])
    return np.concatenate([rate, np.linalg.solve(whole, np.concatenate([force, bent]))[:3]])


def difference(parameters: dict) -> float:
    """The largest difference of an angle."""
    start = linkage.consistent(parameters, q0, v0)
    run = linkage.simulate(parameters, *start, times, tol=1e-11)
    begin = np.concatenate([np.cumsum(q0), np.cumsum(v0)])
    reference = solve_ivp(by_hand, (0, 2), begin, "DOP853", times, rtol=1e-13, atol=1e-13).y[:3].T
    return float(np.abs(np.cumsum(run.q, axis=1) - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of an angle within 2 s is {scientific(off, 1)} rad.")

# %% [markdown]
# ## The motion
#
# The first bar starts with 3 rad/s.

# %%
run = linkage.simulate(values, q0, v0, times)
assert run.drift.max() < 1e-12
picture = run.plot()
picture

# %%
Remark("Loop closure", f"The loop stays closed within {scientific(run.drift.max(), 1)} m.")
