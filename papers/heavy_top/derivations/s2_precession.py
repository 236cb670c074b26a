# %% [markdown]
# # Steady precession, nutation, sleep
#
# **Objective.** At which rates the top precesses steadily, how it nutates about that, and when the upright position is stable.
#
# **Assumptions.** Those of the first section. Gravity is weak, $mgl \ll I_3^2\omega_3^2/I_1$, only where the print says so:
# this is a premise, put in by $g \to \varepsilon g$.
#
# **Notation.** $\omega_3$ the axial angular velocity, $\Omega$ the rate of steady precession.

# %%
import sympy as sp
from symbols import I_1, I_3, Omega, c, epsilon, g, l, m, omega_3, p_phi, p_psi, theta_0
from top import top

from lagrotor.paper import Premise, prove, verdict

_, theta, _ = c.q
phi_v, theta_v, psi_v = c.v
weak_gravity = Premise("gravity is weak, m g l ≪ I₃²ω₃²/I₁", {g: epsilon * g}, small=epsilon)

# %% [markdown]
# ## Steady precession
#
# With $\theta$ constant, $\dot\phi=\Omega$ and $\dot\psi=\omega_3-\Omega\cos\theta$, Lagrange's equation of the inclination is
# $\sin\theta$ times a condition, which gives $mgl$.

# %%
steady = {**dict.fromkeys(c.a, 0), theta_v: 0, phi_v: Omega, psi_v: omega_3 - Omega * sp.cos(theta)}
balance = sp.expand(top.motion[1].subs(steady))
weight = sp.Symbol("w", positive=True)
(torque,) = sp.solve(balance.subs(g, weight / (m * l)), weight)
verdict("2.1", torque)

# %% [markdown]
# It is a quadratic equation for $\Omega$. With $\Omega = (I_3\omega_3 \mp s)/(2I_1\cos\theta)$ its right side depends on
# $s^2$ alone, and is $mgl$ where $s^2 = I_3^2\omega_3^2 - 4I_1mgl\cos\theta$:

# %%
s = sp.Symbol("s", real=True)
slow, fast = ((I_3 * omega_3 + sign * s) / (2 * I_1 * sp.cos(theta)) for sign in (-1, 1))
of_s = ((I_3 * omega_3) ** 2 - s**2) / (4 * I_1 * sp.cos(theta))
prove((torque.subs(Omega, slow), torque.subs(Omega, fast)), (of_s, of_s), "the torque of both", names=("mgl", "mgl"))

# %%
root = sp.sqrt((I_3 * omega_3) ** 2 - 4 * I_1 * m * g * l * sp.cos(theta))
slow, fast = slow.subs(s, root), fast.subs(s, root)

# %%
verdict("2.2", slow, premises=[weak_gravity], uses=["2.1"])

# %%
verdict("2.3", fast, premises=[weak_gravity], uses=["2.1"])

# %% [markdown]
# ## Small nutation
#
# About a steady precession the inclination swings with $\omega_n^2 = V''/I_1$, both momenta being kept.

# %%
reduced = top.routh("phi psi")
potential = -reduced.L.subs(theta_v, 0)
kept = {p_psi: I_3 * omega_3, p_phi: I_1 * Omega * sp.sin(theta) ** 2 + I_3 * omega_3 * sp.cos(theta)}
stiffness = potential.diff(theta, 2).subs(kept).subs(g, torque / (m * l))
swing = (I_3 * omega_3) ** 2 / I_1 - 4 * I_3 * omega_3 * Omega * sp.cos(theta)
swing += I_1 * Omega**2 * (1 + 3 * sp.cos(theta) ** 2)
prove(stiffness, swing, "the curvature of the effective potential", names="V''")

# %%
slowly = Premise("the precession is slow, Ω ≪ ω₃", {Omega: epsilon * Omega}, small=epsilon)
verdict("3.1", sp.sqrt(swing / I_1), premises=[slowly], uses=["1.6", "2.1"])

# %% [markdown]
# ## A top released at rest
#
# Then $p_\phi = p_\psi\cos\theta_0$, and the inclination turns where the effective potential is again what it was at
# $\theta_0$. With $x=\cos\theta_0-\cos\theta_1$ that is a quadratic equation, once the root $x=0$ is divided out.

# %%
x = sp.Symbol("x", real=True)
released = potential.subs({p_phi: p_psi * sp.cos(theta_0)}).subs(p_psi, I_3 * omega_3)
u = sp.cos(theta_0) - x
turned = (I_3 * omega_3 * x) ** 2 / (2 * I_1 * (1 - u**2)) + I_3 * omega_3**2 / 2 + m * g * l * u
prove(turned.subs(x, sp.cos(theta_0) - sp.cos(theta)), released, "the effective potential over x", names="V")

# %%
quadratic = (I_3 * omega_3) ** 2 * x / (2 * I_1) - m * g * l * (1 - u**2)
prove(
    (turned - turned.subs(x, 0)) * (1 - u**2),
    x * quadratic,
    "what vanishes where it turns",
    names=r"(V-V_0)\sin^2\theta",
)

# %% [markdown]
# $x = 2mgl\sin^2\theta_0/(b+s)$ is its root where $s^2 = b^2 + (2mgl\sin\theta_0)^2$:

# %%
b = (I_3 * omega_3) ** 2 / (2 * I_1) - 2 * m * g * l * sp.cos(theta_0)
square = b**2 + (2 * m * g * l * sp.sin(theta_0)) ** 2
sunk = 2 * m * g * l * sp.sin(theta_0) ** 2 / (b + s)
left = quadratic.subs(x, sunk) * (b + s) ** 2
prove(left, m * g * l * sp.sin(theta_0) ** 2 * (square - s**2), "what vanishes there", names="q(x)(b+s)^2")
sunk = sunk.subs(s, sp.sqrt(square))

# %%
verdict(
    "3.2",
    sunk,
    premises=[weak_gravity],
    correction=2 * m * g * l * I_1 * sp.sin(theta_0) ** 2 / (I_3 * omega_3) ** 2,
    wrong="A factor of two is missing.",
    uses=["1.6"],
)

# %% [markdown]
# ## The sleeping top
#
# Upright both momenta are $I_3\omega_3$; small tilts are stable above a least spin.

# %%
p = sp.Symbol("p", positive=True)
upright = top.routh({"phi": p, "psi": p}).linearise({theta: 0})
(least,) = sp.solve(upright.stable_if.lhs.subs(p, I_3 * sp.sqrt(weight)), weight)
verdict(
    "4.1",
    least,
    correction=4 * m * g * l * I_1 / I_3**2,
    wrong="The axial inertia is printed without its square: the right side is no rate squared.",
    uses=["1.6"],
)
