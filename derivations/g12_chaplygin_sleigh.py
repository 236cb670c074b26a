# %% [markdown]
# # Chaplygin's sleigh
#
# **Objective.** A body on a blade that cannot slip sideways: its equations, conservation of energy but not of momentum, and the
# straight line to which its path tends.
#
# **Assumptions.** A horizontal plane. The blade is on the body's axis, at the distance $l$ behind the centre of mass.
#
# **Notation.** $x, y$ the position of the blade, $\phi$ its direction, $\omega=\dot\phi$, $u$ the speed along it, $J$ the
# inertia about the centre of mass.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, constrained_accelerations, coordinates
from lagrotor.paper import Remark, prove, scientific

m, l, J = sp.symbols("m l J", positive=True)
c = coordinates("x y phi")
(x, y, phi), (x_v, y_v, phi_v) = c.q, c.v
blade = Frame(c).moved(x, y).turned("z", phi)
runner = blade.body(m, (0, 0, J), centre=(l, 0, 0))
sleigh = System(c, runner.kinetic, rolling=(blade.velocity()[1],))

# %% [markdown]
# ## The equations of motion (Neimark & Fufaev, ch. II)
#
# The multiplier $\lambda_1$ is the sideways force of the blade. Without it two equations remain, for $u$ and $\omega$.

# %%
sleigh

# %%
prove(sleigh.rolling[0], y_v * sp.cos(phi) - x_v * sp.sin(phi), "the constraint of no sideways slip", names="0")

# %%
u = sp.Symbol("u", real=True)
on_blade = {x_v: u * sp.cos(phi), y_v: u * sp.sin(phi)}
a, _ = constrained_accelerations(sleigh)
speeding = (a[0] * sp.cos(phi) + a[1] * sp.sin(phi) + phi_v * (y_v * sp.cos(phi) - x_v * sp.sin(phi))).subs(on_blade)
turning = -m * l * phi_v * u / (J + m * l**2)
prove(
    (speeding, a[2].subs(on_blade)), (l * phi_v**2, turning), "the reduced equations", names=(r"\dot u", r"\dot\omega")
)

# %% [markdown]
# ## Conservation of energy
#
# The energy is conserved. The momentum is not conserved, because the blade exerts a sideways force.

# %%
assert sleigh.cyclic == ()
prove(sleigh.power, 0, "the force of the blade does no work", names=r"\dot E")

# %% [markdown]
# ## Comparison with the closed solution
#
# For a start with $u=0$ the solution is $\omega=\omega_0\,\mathrm{sech}\,\nu t$ and $u=u_\infty\tanh\nu t$ with
# $u_\infty=\omega_0\sqrt{(J+ml^2)/m}$ and $\nu=m\,l\,u_\infty/(J+ml^2)$.

# %%
values, times, twin = {m: 2.0, l: 0.3, J: 0.5}, np.linspace(0, 12, 241), {J: 0.5001}
inertia = 0.5 + 2 * 0.3**2
last = 1.5 * np.sqrt(inertia / 2)
rate = 2 * 0.3 * last / inertia


def difference(parameters: dict) -> float:
    """The largest error of the angular velocity (rad/s) or of the speed (m/s) against the closed solution."""
    run = sleigh.simulate(parameters, (0, 0, 0), (0, 0, 1.5), times, tol=1e-12)
    speed = run.v[:, 0] * np.cos(run.q[:, 2]) + run.v[:, 1] * np.sin(run.q[:, 2])
    turn = np.abs(run.v[:, 2] - 1.5 / np.cosh(rate * times)).max()
    return float(max(turn, np.abs(speed - last * np.tanh(rate * times)).max()))


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of $\\omega$ (rad/s) or $u$ (m/s) within 12 s is {scientific(off, 1)}.")

# %% [markdown]
# ## The motion
#
# The sleigh starts with the rotation 1.5 rad/s only. The rotation stops, and the path tends to a straight line.

# %%
picture = sleigh.simulate(values, (0, 0, 0), (0, 0, 1.5), times).plot()
picture
