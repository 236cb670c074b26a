# %% [markdown]
# # A bead on a rotating hoop
#
# **Objective.** The equilibria of the bead as functions of the hoop's rate, the conserved quantity, and the same system with a
# time-dependent constraint.
#
# **Assumptions.** A bead of mass $m$ slides without friction on a hoop of radius $R$. A motor rotates the hoop about the
# vertical at the constant rate $\Omega$.
#
# **Notation.** $\theta$ the angle from the lowest point.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.algebra import decide_equal
from lagrotor.mechanics import Frame, System, coordinates, t
from lagrotor.paper import Formula, Remark, prove, scientific

m, R, g, Omega = sp.symbols("m R g Omega", positive=True)
c = coordinates("theta")
(theta,), (theta_v,) = c.q, c.v
bead = Frame(c).turned("zy", (Omega * t, -theta)).body(m, centre=(0, 0, -R))
hoop = System(c, bead.kinetic - bead.potential((0, 0, -g)))

# %% [markdown]
# ## The Lagrangian (Goldstein, problem 2.17)
#
# The position of the bead depends on time, but the Lagrangian in $\theta$ does not.

# %%
spun = m * R**2 * (theta_v**2 + Omega**2 * sp.sin(theta) ** 2) / 2 + m * g * R * sp.cos(theta)
prove(hoop.L, spun, "the Lagrangian does not depend on time", names="L")

# %%
hoop

# %% [markdown]
# ## Jacobi's integral
#
# Jacobi's integral is conserved. The energy is not conserved, because the motor does work.

# %%
jacobi = m * R**2 * (theta_v**2 - Omega**2 * sp.sin(theta) ** 2) / 2 - m * g * R * sp.cos(theta)
prove(hoop.energy, jacobi, "Jacobi's integral", names="h")

# %%
energy = jacobi + m * R**2 * Omega**2 * sp.sin(theta) ** 2
assert hoop.conserved(jacobi).answer == "zero" and hoop.conserved(energy).answer == "nonzero"
Formula(energy, "E")

# %% [markdown]
# ## Equilibria
#
# The equilibria are the bottom, the top, and the two positions with $\cos\theta = g/(R\Omega^2)$. The bottom is stable for
# $R\Omega^2 < g$. The two tilted positions are stable for $R\Omega^2 > g$, with the frequency $\omega^2=\Omega^2\sin^2\theta$.

# %%
places = {e.at[theta]: hoop.linearise(e) for e in hoop.equilibria()}
tilted = sp.acos(g / (R * Omega**2))
assert set(places) == {0, sp.pi, tilted, -tilted}
assert places[0].stable_if == sp.Gt(g - R * Omega**2, 0) and places[tilted].stable_if == sp.Gt(R * Omega**2 - g, 0)
assert places[sp.pi].stable_if == sp.false
aside = places[tilted]
prove(
    aside.stiffness[0] / aside.mass[0],
    Omega**2 - g**2 / (R * Omega) ** 2,
    "the frequency at the tilted equilibrium",
    names=r"\omega^2",
)

# %% [markdown]
# ## Comparison with a bead in space under two constraints
#
# The bead has Cartesian coordinates and two constraints: the sphere and the rotating plane of the hoop.

# %%
space = coordinates("x y z")
x, y, z = space.q
free = m * sum(v**2 for v in space.v) / 2 - m * g * z
wire = System(space, free, (x**2 + y**2 + z**2 - R**2, y * sp.cos(Omega * t) - x * sp.sin(Omega * t)))
bead_position = (R * sp.sin(theta) * sp.cos(Omega * t), R * sp.sin(theta) * sp.sin(Omega * t), -R * sp.cos(theta))
solved = wire.in_coordinates(c, dict(zip(space.q, bead_position, strict=True)))
assert solved.constraints == () and solved.same_as(hoop).answer == "zero"
assert decide_equal(solved.L, hoop.L).answer == "zero"
values, times, twin = {m: 0.4, R: 0.5, g: 9.81, Omega: 6.0}, np.linspace(0, 5, 101), {Omega: 6.001}


def textbook(_: float, y: np.ndarray) -> list[float]:
    return [y[1], (36.0 * np.cos(y[0]) - 9.81 / 0.5) * np.sin(y[0])]


def difference(parameters: dict) -> float:
    """The largest difference between the bead in space and the textbook's equation, m."""
    rate = parameters[Omega]
    start = (0.5 * np.sin(1.2), 0, -0.5 * np.cos(1.2)), (0, 0.5 * rate * np.sin(1.2), 0)
    run = wire.simulate(parameters, *start, times, tol=1e-10)
    angle = solve_ivp(textbook, (0, 5), [1.2, 0], "DOP853", times, rtol=1e-13, atol=1e-13).y[0]
    reference = 0.5 * np.stack(
        [np.sin(angle) * np.cos(6 * times), np.sin(angle) * np.sin(6 * times), -np.cos(angle)], 1
    )
    return float(np.abs(run.q - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest distance between the two motions within 5 s is {scientific(off, 1)} m.")

# %% [markdown]
# ## The motion
#
# At $\Omega=6$ rad/s the bead oscillates about one of the two tilted equilibria.

# %%
picture = hoop.simulate(values, (1.2,), (0,), times).plot()
picture
