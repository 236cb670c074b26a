# %% [markdown]
# # A rolling disc
#
# **Objective.** A thin disc that rolls on a plane without slipping: its constraints, conservation of energy, and the speed
# above which upright rolling is stable.
#
# **Assumptions.** A homogeneous disc of radius $R$. Its rim touches the plane and does not slip.
#
# **Notation.** $x, y, z$ the centre, $\varphi$ the heading, $\vartheta$ the lean, $\psi$ the rolling angle.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.paper import prove

m, R, g = sp.symbols("m R g", positive=True)
c = coordinates("x y z phi vartheta psi")
x, y, z, phi, lean, psi = c.q
axle = Frame(c).moved(x, y, z).turned("zx", (phi, lean))
wheel = axle.turned("y", psi)
disc = wheel.body(m, (m * R**2 / 4, m * R**2 / 2, m * R**2 / 4))
slip = wheel.velocity((0, 0, -R), frame=axle)
rolling = System(c, disc.kinetic - disc.potential((0, 0, -g)), (z - R * sp.cos(lean),), rolling=tuple(slip[:2, 0]))

# %% [markdown]
# ## The velocity of the contact point
#
# The velocity of the contact point is zero. In the axes of the axle, its components along the heading and across it are

# %%
x_v, y_v, z_v, phi_v, lean_v, psi_v = c.v
forward_speed = x_v * sp.cos(phi) + y_v * sp.sin(phi)
sideways_speed = y_v * sp.cos(phi) - x_v * sp.sin(phi)
expected = (
    forward_speed - R * (psi_v + phi_v * sp.sin(lean)),
    sideways_speed * sp.cos(lean) + z_v * sp.sin(lean) + R * lean_v,
)
prove(rolling.rolling, expected, "the constraints of no slip", names=("0", "0"))

# %%
prove(rolling.power, 0, "the forces of the plane do no work", names=r"\dot E")

# %% [markdown]
# ## Comparison with Newton's and Euler's equations
#
# The equations of momentum and of angular momentum about the centre, with the contact force eliminated, are integrated
# independently.

# %%
values, times, twin = {m: 2.0, R: 0.5, g: 9.81}, np.linspace(0, 2, 81), {R: 0.5001}
q0, v0 = rolling.consistent(values, (0, 0, 0.5 * np.cos(0.3), 0.2, 0.3, 0.1), (0, 0, 0, 0.8, 0.4, 5.0))


def wedge(a: np.ndarray) -> np.ndarray:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def newton_euler(_: float, state: np.ndarray) -> np.ndarray:
    Q, w, up = state[:9].reshape(3, 3), state[9:12], np.array([0, 0, 1.0])
    n = Q[:, 1]
    turn = wedge(w)
    steepest, n_v = up - (up @ n) * n, turn @ n
    length, steepest_v = np.linalg.norm(steepest), -(up @ n_v) * n - (up @ n) * n_v
    contact = -0.5 * steepest / length
    contact_v = -0.5 * (steepest_v / length - steepest * (steepest @ steepest_v) / length**3)
    inertia = Q @ (0.5 * np.diag([0.25, 0.5, 0.25])) @ Q.T
    force, arm = 2 * (9.81 * up - turn @ contact_v), wedge(contact)
    w_v = np.linalg.solve(inertia - 2 * arm @ arm, arm @ force - turn @ inertia @ w)
    return np.concatenate([(turn @ Q).ravel(), w_v, -turn @ contact])


def difference(parameters: dict) -> float:
    """The largest distance between the two centres, m."""
    start = rolling.consistent(parameters, q0, v0)
    run = rolling.simulate(parameters, *start, times, tol=1e-10)
    at = dict(zip((*c.q, *c.v), (*q0, *v0), strict=True)) | values
    origin = wheel.place()
    Q = np.column_stack([np.array((wheel.place(e) - origin).subs(at), float) for e in np.eye(3, dtype=int).tolist()])
    spin = Q @ np.array(wheel.angular_velocity.subs(at), float).ravel()
    state = np.concatenate([Q.ravel(), spin, q0[:3]])
    reference = solve_ivp(newton_euler, (0, 2), state, "DOP853", times, rtol=1e-13, atol=1e-13).y[12:].T
    return float(np.abs(run.q[:, :3] - reference).max())


off = difference(values)
assert off < 1e-9
off

# %% [markdown]
# ## Stability of upright rolling
#
# Upright rolling is stable above $\dot\psi_0^2 = g/(3R)$ (Routh, Advanced Rigid Dynamics, §244). A lean changes the heading,
# and to first order $\ddot\vartheta = \kappa\,(\vartheta - \eta^2(\vartheta-\vartheta_0))$. Here $\kappa>0$, $\vartheta_0$ is
# the initial lean, and $\eta$ is the ratio of the speed to the critical speed. For $\eta>1$ the lean oscillates between
# $\vartheta_0$ and $\vartheta_0(\eta^2+1)/(\eta^2-1)$. For $\eta<1$ it grows.

# %%
critical, first = np.sqrt(9.81 / (3 * 0.5)), 1e-5
leans = {}
for ratio in (0.9, 1.1, 1.5):
    rate = ratio * critical
    initial = rolling.consistent(values, (0, 0, 0.5, 0, first, 0), (0.5 * rate, 0, 0, 0, 0, rate))
    leans[ratio] = float(
        np.abs(rolling.simulate(values, *initial, np.linspace(0, 6, 601), 1e-11).q[:, 4]).max() / first
    )
assert leans[0.9] > 1e3
assert all(abs(leans[n] / ((n**2 + 1) / (n**2 - 1)) - 1) < 1e-3 for n in (1.1, 1.5))
leans

# %%
picture = rolling.simulate(values, q0, v0, times).plot()
picture
