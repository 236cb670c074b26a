# %% [markdown]
# # A gyroscope in gimbals
#
# **Objective.** The Lagrangian of rotor, inner and outer gimbal, the frequency of nutation, and the drift of the outer gimbal
# due to a finite nutation.
#
# **Assumptions.** All centres of mass at the centre; no friction.
#
# **Notation.** $\alpha$ the angle of the outer gimbal about $z$, $\beta$ the angle of the inner gimbal about its $x$ axis,
# $\gamma$ the angle of the rotor about its axis $y$; at $\beta=0$ the three axes are perpendicular. $A_o$ the inertia of the
# outer gimbal about its axis; $B_i, C_i, A_i$ the inertias of the inner gimbal about its $x, y, z$; $I_3$, $I_1$ the axial and
# transverse inertias of the rotor; $H$ its axial momentum.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import Remark, prove, scientific

Ao, A, Bi, Ci, I1, I3 = sp.symbols("A_o A_i B_i C_i I_1 I_3", positive=True)
H = sp.Symbol("H", real=True)
c = coordinates("alpha beta gamma")
(alpha, beta, gamma), (alpha_v, beta_v, gamma_v) = c.q, c.v
outer = Frame(c).turned("z", alpha)
inner = outer.turned("x", beta)
rotor = inner.turned("y", gamma).body(1, (I1, I3, I1))
gimbals = System(c, outer.body(1, (0, 0, Ao)).kinetic + inner.body(1, (Bi, Ci, A)).kinetic + rotor.kinetic)

# %% [markdown]
# ## The equations of motion

# %%
gimbals

# %% [markdown]
# ## The Lagrangian (Arnold & Maunder, Gyrodynamics, ch. 6)

# %%
about = Ao + (A + I1) * sp.cos(beta) ** 2 + Ci * sp.sin(beta) ** 2
textbook = (about * alpha_v**2 + (Bi + I1) * beta_v**2 + I3 * (gamma_v + alpha_v * sp.sin(beta)) ** 2) / 2
prove(gimbals.L, textbook, "the Lagrangian of the three bodies", names="L")

# %% [markdown]
# ## Nutation
#
# With the axial momentum $H=I_3(\dot\gamma+\dot\alpha\sin\beta)$ the two gimbals oscillate at the frequency
# $H/\sqrt{(A_o+A_i+I_1)(B_i+I_1)}$.

# %%
assert gimbals.cyclic == (alpha, gamma)
reduced = gimbals.routh({"gamma": H})
nutation = reduced.linearise({alpha: 0, beta: 0})
s = sp.Symbol("s")
frequency = H**2 / ((Ao + A + I1) * (Bi + I1))
prove(
    nutation.characteristic(s) / nutation.mass.det(),
    s**2 * (s**2 + frequency),
    "the frequency of nutation",
    names=r"\det(s^2M+sC)/\det M",
)

# %% [markdown]
# ## Comparison with the equation of one angle
#
# Both momenta are conserved, so the two cyclic angles can be eliminated by hand. The remaining equation of $\beta$ is integrated
# independently.

# %%
values = {Ao: 0.3, A: 0.1, Bi: 0.2, Ci: 0.15, I1: 0.4, I3: 0.6}
times, twin = np.linspace(0, 5, 301), {Ci: 0.16}


def by_hand(_: float, y: np.ndarray) -> list[float]:
    """y = (alpha, beta, beta'); H = 6, the outer momentum p = 0.3."""
    sine, cosine = np.sin(y[1]), np.cos(y[1])
    inertia = 0.3 + 0.5 * cosine**2 + 0.15 * sine**2
    rate = (0.3 + 6 * np.sin(0.4) - 6 * sine) / inertia
    return [rate, y[2], ((0.15 - 0.5) * sine * cosine * rate**2 + 6 * cosine * rate) / 0.6]


def difference(parameters: dict) -> float:
    """The largest difference of a gimbal's angle."""
    inertia = 0.3 + 0.5 * np.cos(0.4) ** 2 + 0.15 * np.sin(0.4) ** 2
    rate = 0.3 / inertia
    run = gimbals.simulate(parameters, (0, 0.4, 0), (rate, 0, 10 - rate * np.sin(0.4)), times, tol=1e-11)
    reference = solve_ivp(by_hand, (0, 5), [0, 0.4, 0], "DOP853", times, rtol=1e-13, atol=1e-13).y[:2].T
    return float(np.abs(run.q[:, :2] - reference).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of a gimbal's angle within 5 s is {scientific(off, 1)} rad.")

# %% [markdown]
# ## The drift of the outer gimbal
#
# If the mean inclination is not zero, nutation makes the outer gimbal drift.

# %%
run = gimbals.simulate(values, (0, 0.4, 0), (0.5, 0, 10), np.linspace(0, 20, 801))
turned_by = float(run.q[-1, 0])
picture = run.plot()
picture

# %%
Remark("Drift", f"Within 20 s the outer gimbal turns by {turned_by:.2f} rad.")
