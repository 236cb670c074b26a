# %% [markdown]
# # Chains: n rods, and n gyroscopes on each other's tips
#
# **Objective.** That the program of a tree of bodies grows with their number and not faster, and that it is right.
#
# **Assumptions.** Rods without mass with a mass at each joint, in a plane, relative angles; gyroscopes on two angles and a spin.
#
# **Notation.** $n$ the number of rods or gyroscopes.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates, motion_program
from lagrotor.numerics import operations
from lagrotor.paper import prove

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
# Each rod more costs the same; so does each gyroscope. The first costs less, since the ground does not move, so that twice
# as many take a little more than twice the operations, the less so the longer the chain.

# %%
counts = {
    made.__name__: {n: operations(motion_program(made(n)).program) for n in (5, 6, 12)} for made in (rods, gyroscopes)
}
doubling = {name: found[12] / found[6] for name, found in counts.items()}
for found in counts.values():
    assert found[12] - found[6] == 6 * (found[6] - found[5])
assert max(doubling.values()) < 2.3
counts, doubling

# %% [markdown]
# ## The spins of the gyroscopes are conserved

# %%
pair = gyroscopes(2)
assert pair.cyclic == (pair.c.q[2], pair.c.q[5])
spin = pair.noether((0, 0, 0, 0, 0, 1)).expression
tip = Frame(pair.c).turned("xy", pair.c.q[:2]).turned("xy", pair.c.q[3:5])
prove(spin, I3 * (pair.c.v[5] + tip.angular_velocity[2]), "the axial momentum of the upper one", names="p")

# %% [markdown]
# ## Against the textbook's equations in the angles to the vertical, six rods

# %%
values, times, twin = {m: 1.0, l: 0.5, g: 9.81}, np.linspace(0, 1, 41), {l: 0.5001}
below = 6 - np.maximum.outer(np.arange(6), np.arange(6))


def textbook(_: float, y: np.ndarray) -> np.ndarray:
    theta, rate = y.reshape(2, -1)
    apart = theta[:, None] - theta[None, :]
    force = -(below * np.sin(apart)) @ rate**2 - np.diag(below) * 9.81 / 0.5 * np.sin(theta)
    return np.concatenate([rate, np.linalg.solve(below * np.cos(apart), force)])


def difference(given: dict) -> float:
    """The largest difference of an angle to the vertical."""
    start = np.linspace(0.5, 0.0, 6)
    run = rods(6).simulate(given, start, 0 * start, times, tol=1e-12)
    y = np.concatenate([np.cumsum(start), 0 * start])
    other = solve_ivp(textbook, (0, 1), y, "DOP853", times, rtol=1e-13, atol=1e-13).y[:6].T
    return float(np.abs(np.cumsum(run.q, axis=1) - other).max())


off = difference(values)
assert off < 1e-9
off

# %%
start = np.tile([0.2, 0.1, 0.0], 3)
fast = gyroscopes(3).simulate({**values, I1: 0.02, I3: 0.03}, start, np.tile([0, 0, 200.0], 3), np.linspace(0, 1, 201))
assert np.ptp(fast.energy) < 1e-7 * np.abs(fast.energy).max()
picture = fast.plot()
picture
