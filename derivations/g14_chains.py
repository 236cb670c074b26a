# %% [markdown]
# # Chains of n rods and of n gyroscopes
#
# **Objective.** The program of a tree of bodies: its number of operations, which is proportional to the number of bodies, and its
# correctness.
#
# **Assumptions.** A plane chain of massless rods with a mass at each joint, in relative angles. A chain of gyroscopes, each
# on the tip of the previous gyroscope, with two angles and a spin.
#
# **Notation.** $n$ the number of rods or gyroscopes.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates, motion_program
from lagrotor.numerics import operations
from lagrotor.paper import Remark, Table, prove, scientific

m, l, g, I1, I3 = sp.symbols("m l g I_1 I_3", positive=True)


def rods(n: int) -> System:
    c = coordinates([f"q_{i + 1}" for i in range(n)])
    frame, L = Frame(c), 0
    for angle in c.q:
        frame = frame.turned("y", angle)
        bob = frame.body(m, centre=(0, 0, -l))
        L, frame = L + bob.kinetic - bob.potential((0, 0, -g)), frame.moved(0, 0, -l)
    return System(c, L)


def gyroscopes(n: int) -> System:
    c = coordinates([f"{name}_{i + 1}" for i in range(n) for name in ("alpha", "beta", "gamma")])
    frame, L = Frame(c), 0
    for i in range(n):
        axis = frame.turned("xy", c.q[3 * i : 3 * i + 2])
        rotor = axis.turned("z", c.q[3 * i + 2]).body(m, (I1, I1, I3), (0, 0, l / 2))
        L, frame = L + rotor.kinetic - rotor.potential((0, 0, -g)), axis.moved(0, 0, l)
    return System(c, L)


# %% [markdown]
# ## Operations of one evaluation
#
# Each additional rod requires the same number of operations, and so does each additional gyroscope. The first body requires
# fewer, because the ground does not move. A chain of double length therefore requires slightly more than twice the
# operations. For longer chains the ratio approaches two.

# %%
counts = {
    chain.__name__: {n: operations(motion_program(chain(n)).program) for n in (5, 6, 12)}
    for chain in (rods, gyroscopes)
}
doubling = {name: count[12] / count[6] for name, count in counts.items()}
for count in counts.values():
    assert count[12] - count[6] == 6 * (count[6] - count[5])
assert max(doubling.values()) < 2.3
Table(
    "Operations of a right-hand side",
    ("chain of", "5 bodies", "6 bodies", "12 bodies", "12 bodies / 6 bodies"),
    tuple(
        (name, *(f"{number:,}" for number in count.values()), f"{doubling[name]:.2f}") for name, count in counts.items()
    ),
)

# %% [markdown]
# ## Conservation of the spins of the gyroscopes

# %%
pair = gyroscopes(2)
assert pair.cyclic == (pair.c.q[2], pair.c.q[5])
spin = pair.noether((0, 0, 0, 0, 0, 1)).expression
tip = Frame(pair.c).turned("xy", pair.c.q[:2]).turned("xy", pair.c.q[3:5])
prove(spin, I3 * (pair.c.v[5] + tip.angular_velocity[2]), "the axial momentum of the upper gyroscope", names="p")

# %% [markdown]
# ## Comparison with the textbook's equations for six rods
#
# The textbook's equations in the angles from the vertical are integrated independently.

# %%
values, times, twin = {m: 1.0, l: 0.5, g: 9.81}, np.linspace(0, 1, 41), {l: 0.5001}
below = 6 - np.maximum.outer(np.arange(6), np.arange(6))


def textbook(_: float, y: np.ndarray) -> np.ndarray:
    theta, rate = y.reshape(2, -1)
    apart = theta[:, None] - theta[None, :]
    force = -(below * np.sin(apart)) @ rate**2 - np.diag(below) * 9.81 / 0.5 * np.sin(theta)
    return np.concatenate([rate, np.linalg.solve(below * np.cos(apart), force)])


def difference(parameters: dict) -> float:
    """The largest difference of an angle from the vertical."""
    start = np.linspace(0.5, 0.0, 6)
    run = rods(6).simulate(parameters, start, 0 * start, times, tol=1e-12)
    y = np.concatenate([np.cumsum(start), 0 * start])
    reference = solve_ivp(textbook, (0, 1), y, "DOP853", times, rtol=1e-13, atol=1e-13).y[:6].T
    return float(np.abs(np.cumsum(run.q, axis=1) - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of an angle within 1 s is {scientific(off, 1)} rad.")

# %% [markdown]
# ## The motion of three gyroscopes
#
# Each gyroscope spins at 200 rad/s. The chain precesses instead of falling.

# %%
start = np.tile([0.2, 0.1, 0.0], 3)
fast = gyroscopes(3).simulate({**values, I1: 0.02, I3: 0.03}, start, np.tile([0, 0, 200.0], 3), np.linspace(0, 1, 201))
assert np.ptp(fast.energy) < 1e-7 * np.abs(fast.energy).max()
picture = fast.plot()
picture
