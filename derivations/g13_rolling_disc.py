# %% [markdown]
# # A rolling disc
#
# **Objective.** A thin disc that rolls on a plane without slipping: its constraints, conservation of energy, and the speed
# above which upright rolling is stable.
#
# **Assumptions.** A homogeneous disc of radius $R$. Its rim touches the plane and does not slip.
#
# **Notation.** $x, y, z$ the centre, $\phi$ the heading, $\vartheta$ the lean, $\psi$ the angle of the disc
# about its axle, $\Omega=\dot\psi+\dot\phi\sin\vartheta$ its angular velocity along the axle.

# %%
import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates, total_derivative
from lagrotor.paper import Remark, Table, prove, scientific

m, R, g = sp.symbols("m R g", positive=True)
c = coordinates("x y z phi vartheta psi")
x, y, z, phi, lean, psi = c.q
axle = Frame(c).moved(x, y, z).turned("zx", (phi, lean))
wheel = axle.turned("y", psi)
disc = wheel.body(m, (m * R**2 / 4, m * R**2 / 2, m * R**2 / 4))
slip = wheel.velocity((0, 0, -R), frame=axle)
rolling = System(c, disc.kinetic - disc.potential((0, 0, -g)), (z - R * sp.cos(lean),), rolling=tuple(slip[:2, 0]))

# %% [markdown]
# ## The Lagrangian

# %%
x_v, y_v, z_v, phi_v, lean_v, psi_v = c.v
turning = m * R**2 / 8 * (lean_v**2 + phi_v**2 * sp.cos(lean) ** 2 + 2 * (psi_v + phi_v * sp.sin(lean)) ** 2)
prove(
    rolling.L,
    m * (x_v**2 + y_v**2 + z_v**2) / 2 + turning - m * g * z,
    "the Lagrangian of the free disc",
    names="L",
)

# %% [markdown]
# ## The constraints
#
# The rim touches the plane if $z = R\cos\vartheta$. The velocity of the contact point is zero. In the axes of the axle, its
# components along the heading and across it are

# %%
forward_speed = x_v * sp.cos(phi) + y_v * sp.sin(phi)
sideways_speed = y_v * sp.cos(phi) - x_v * sp.sin(phi)
expected = (
    forward_speed - R * (psi_v + phi_v * sp.sin(lean)),
    sideways_speed * sp.cos(lean) + z_v * sp.sin(lean) + R * lean_v,
)
prove(rolling.rolling, expected, "the constraints of no slip", names=("0", "0"))

# %% [markdown]
# ## The equations of motion
#
# The constraints determine the velocity of the centre:

# %%
Omega, Omega_a = sp.symbols("Omega Omega_dot", real=True)
along, across = R * (psi_v + phi_v * sp.sin(lean)), -R * lean_v * sp.cos(lean)
centre = {
    x_v: along * sp.cos(phi) - across * sp.sin(phi),
    y_v: along * sp.sin(phi) + across * sp.cos(phi),
    z_v: -R * lean_v * sp.sin(lean),
}
contact = (*rolling.rolling, total_derivative(rolling.constraints[0], c))
prove(
    [e.subs(centre) for e in contact],
    (0, 0, 0),
    "this velocity of the centre satisfies the three constraints",
    equations=(
        r"\dot x &= R\,(\Omega\cos\phi + \dot\vartheta\cos\vartheta\sin\phi)",
        r"\dot y &= R\,(\Omega\sin\phi - \dot\vartheta\cos\vartheta\cos\phi)",
        r"\dot z &= -R\,\dot\vartheta\sin\vartheta",
    ),
)

# %% [markdown]
# The reactions of the plane do no work in a displacement that the constraints allow. The component of Lagrange's equations
# along each of the three allowed displacements, $\delta\vartheta$, $\delta\phi$ and $\delta\psi$, is therefore free of
# reactions:

# %%
lagrange = rolling.motion.subs(dict.fromkeys(rolling.multipliers, 0))
allowed = sp.Matrix([[sp.diff(centre[v], w) for w in (lean_v, phi_v, psi_v)] for v in (x_v, y_v, z_v)])
of_centre = {a: total_derivative(centre[v], c).subs(centre) for a, v in zip(c.a[:3], centre, strict=True)}
along_lean, along_heading, along_roll = (
    allowed.T * lagrange[:3, :] + sp.Matrix([lagrange[i] for i in (4, 3, 5)])
).subs(of_centre)
spin = {psi_v: Omega - phi_v * sp.sin(lean)}
spin[c.a[5]] = Omega_a - c.a[3] * sp.sin(lean) - phi_v * lean_v * sp.cos(lean)
lean_law = phi_v * sp.cos(lean) * (6 * Omega - phi_v * sp.sin(lean)) + 4 * g / R * sp.sin(lean)
unit = 4 / (m * R**2)
prove(
    (
        (5 * c.a[4] - unit * along_lean).subs(spin),
        (sp.cos(lean) ** 2 * c.a[3] - unit * (along_heading - along_roll * sp.sin(lean))).subs(spin),
        (3 * Omega_a - unit / 2 * along_roll).subs(spin),
    ),
    (
        lean_law,
        2 * lean_v * sp.cos(lean) * (phi_v * sp.sin(lean) - Omega),
        -2 * phi_v * lean_v * sp.cos(lean),
    ),
    "the equations of motion of the rolling disc",
    names=(r"5\,\ddot\vartheta", r"\ddot\phi\,\cos^2\vartheta", r"3\,\dot\Omega"),
)

# %% [markdown]
# ## Conservation of energy

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
Remark("Result", f"The largest distance between the two centres within 2 s is {scientific(off, 1)} m.")

# %% [markdown]
# ## Stability of upright rolling
#
# To first order in the lean, $\Omega$ is constant and $\ddot\phi = -2\,\Omega\,\dot\vartheta$. For a disc that starts with the
# lean $\vartheta_0$ and a constant heading this gives $\dot\phi = -2\,\Omega\,(\vartheta-\vartheta_0)$. The lean obeys
# $\ddot\vartheta = \kappa\,(\vartheta - \eta^2(\vartheta-\vartheta_0))$ with $\kappa = 4g/(5R)$ and $\eta^2 = 3R\,\Omega^2/g$:

# %%
first_lean, small = sp.symbols("vartheta_0 delta", real=True)
slight = {lean: small * lean, phi_v: -2 * Omega * small * (lean - first_lean)}
prove(
    lean_law.subs(slight, simultaneous=True) / 5,
    small * 4 * g / (5 * R) * (lean - 3 * R * Omega**2 / g * (lean - first_lean)),
    "the equation of a small lean δϑ",
    small=small,
    order=1,
    names=r"\delta\,\ddot\vartheta",
)

# %% [markdown]
# Upright rolling is therefore stable above $\Omega^2 = g/(3R)$ (Routh, Advanced Rigid Dynamics, §244). For $\eta>1$ the lean
# oscillates between $\vartheta_0$ and $\vartheta_0(\eta^2+1)/(\eta^2-1)$. For $\eta<1$ it grows. Exact runs show both:

# %%
critical, first = np.sqrt(9.81 / (3 * 0.5)), 1e-4
leans = {}
for ratio in (0.9, 1.1, 1.5):
    rate = ratio * critical
    initial = rolling.consistent(values, (0, 0, 0.5 * np.cos(first), 0, first, 0), (0.5 * rate, 0, 0, 0, 0, rate))
    leans[ratio] = float(np.abs(rolling.simulate(values, *initial, np.linspace(0, 6, 601), 1e-9).q[:, 4]).max() / first)
assert leans[0.9] > 1e3
assert all(abs(leans[n] / ((n**2 + 1) / (n**2 - 1)) - 1) < 1e-3 for n in (1.1, 1.5))
Table(
    "Largest lean within 6 s, divided by the initial lean",
    ("speed / critical speed", "exact run", "to first order"),
    tuple(
        (f"{n:g}", f"{lean:.4g}", f"{(n**2 + 1) / (n**2 - 1):.4g}" if n > 1 else "grows") for n, lean in leans.items()
    ),
    "The initial lean is 1e-4 rad.",
)

# %% [markdown]
# ## The motion
#
# The disc of the comparison leans by 0.3 rad, rolls with 5 rad/s and turns. The path of its centre is curved.

# %%
picture = rolling.simulate(values, q0, v0, times).plot()
picture
