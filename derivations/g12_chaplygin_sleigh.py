# %% [markdown]
# # Chaplygin's sleigh
#
# **Objective.** A body on a blade that cannot slip sideways: its equations, the energy it keeps, the momenta it does not, and
# the straight line it ends on.
#
# **Assumptions.** A horizontal plane; the blade lies on the body's axis, the distance $l$ behind the centre of mass.
#
# **Notation.** $x, y$ the blade, $\varphi$ its direction, $\omega=\dot\varphi$, $u$ the speed along it, $J$ the inertia about
# the centre.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Frame, System, constrained_accelerations, coordinates
from lagrotor.paper import prove

m, l, J = sp.symbols("m l J", positive=True)
c = coordinates("x y phi")
(x, y, phi), (x_v, y_v, phi_v) = c.q, c.v
blade = Frame(c).moved(x, y).turned("z", phi)
runner = blade.body(m, (0, 0, J), centre=(l, 0, 0))
sleigh = System(c, runner.kinetic, rolling=(blade.velocity()[1],))

# %% [markdown]
# ## The blade's constraint and the reduced equations (Neimark & Fufaev, ch. II)

# %%
prove(sleigh.rolling[0], y_v * sp.cos(phi) - x_v * sp.sin(phi), "no slip sideways", names="0")

# %%
u = sp.Symbol("u", real=True)
on_blade = {x_v: u * sp.cos(phi), y_v: u * sp.sin(phi)}
a, _ = constrained_accelerations(sleigh)
speeding = (a[0] * sp.cos(phi) + a[1] * sp.sin(phi) + phi_v * (y_v * sp.cos(phi) - x_v * sp.sin(phi))).subs(on_blade)
turning = -m * l * phi_v * u / (J + m * l**2)
prove((speeding, a[2].subs(on_blade)), (l * phi_v**2, turning), "speed and turn", names=(r"\dot u", r"\dot\omega"))

# %% [markdown]
# ## Energy stays, momentum does not: the blade pushes across

# %%
assert sleigh.cyclic == ()
prove(sleigh.power, 0, "the blade does no work", names=r"\dot E")

# %% [markdown]
# ## Against the closed solution
#
# From $u=0$: $\omega=\omega_0\,\mathrm{sech}\,\nu t$ and $u=u_\infty\tanh\nu t$ with $u_\infty=\omega_0\sqrt{(J+ml^2)/m}$ and
# $\nu=m\,l\,u_\infty/(J+ml^2)$.

# %%
values, times, twin = {m: 2.0, l: 0.3, J: 0.5}, np.linspace(0, 12, 241), {J: 0.5001}
inertia = 0.5 + 2 * 0.3**2
last = 1.5 * np.sqrt(inertia / 2)
rate = 2 * 0.3 * last / inertia


def difference(given: dict) -> float:
    """The largest difference of the angular velocity from its closed form, rad/s."""
    run = sleigh.simulate(given, (0, 0, 0), (0, 0, 1.5), times, tol=1e-12)
    along = run.v[:, 0] * np.cos(run.q[:, 2]) + run.v[:, 1] * np.sin(run.q[:, 2])
    turn = np.abs(run.v[:, 2] - 1.5 / np.cosh(rate * times)).max()
    return float(max(turn, np.abs(along - last * np.tanh(rate * times)).max()))


off = difference(values)
assert off < 1e-9
off

# %%
picture = sleigh.simulate(values, (0, 0, 0), (0, 0, 1.5), times).plot()
picture
