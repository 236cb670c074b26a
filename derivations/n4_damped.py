# %% [markdown]
# # Friction and spin-down of the pair
#
# **Objective.** The decay of the paired precession under friction of the axes, the angle by which friction topples the pair, and
# the change of the radius as the rotors spin down.
#
# **Assumptions.** No weight; friction $-c\,r_i'$ on each axis, and $-c_s\omega_i$ on the spins. The first section is linear,
# the second of second order in the tilt; both are compared with the exact motion.
#
# **Notation.** $a$, $b$ the pair's inertias, $A=a+b$, $D=a-b$; $x$ the tilt along the bar, $y_1,y_2$ across; $\alpha$ the
# angle about the joint line, $y=-\alpha$ for small ones; $P$ the momentum about it; $k=\ell/R$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, Structure, paired_scene, simulate
from lagrotor.paper import Remark, prove

a, b, c, c_s, G_1, G_2, G, I3, k, t = sp.symbols("a b c c_s G_1 G_2 G I_3 k t", positive=True)
s, beta = sp.Symbol("s"), sp.Symbol("beta", positive=True)

# %% [markdown]
# ## Decay
#
# With a massless bar the degrees of freedom are $(x,y_1,y_2)$ as in "Stability under load", each with $as^2+cs$:

# %%
own = a * s**2 + c * s
pencil = sp.Matrix([[2 * own, G_1 * s, G_2 * s], [-G_1 * s, own, 0], [-G_2 * s, 0, own]])
prove(
    sp.expand(pencil.det()),
    s**3 * (a * s + c) * (2 * (a * s + c) ** 2 + G_1**2 + G_2**2),
    "the characteristic polynomial of the pair with friction",
    names="P(s)",
)

# %% [markdown]
# All roots except the three zero roots have the real part $-c/a$: precession and toppling decay at the same rate for any
# spins, and displacements remain. For massless bars the energy gives the same rate for any motion of any number of rotors and
# any amplitude. It is $\tfrac a2\sum|r_i'|^2$; bars and spins do no work, so $E'=-c\sum|r_i'|^2=-2cE/a$.
#
# With a heavy bar the inertia of $x$ and of $y_1+y_2$ is twice $A=a+b$, and that of the twist $y_1-y_2$ is half of $D=a-b$.
# Opposite spins couple $x$ and the twist:

# %%
A, D = a + b, a - b
heavy = sp.Matrix([[2 * (A * s**2 + c * s), G * s], [-2 * G * s, D * s**2 + c * s]])
prove(
    heavy.det(),
    2 * s**2 * (A * D * s**2 + c * (A + D) * s + c**2 + G**2),
    "the characteristic polynomial of x and the twist, heavy bar",
    names="P(s)",
)

# %%
rate = sp.Symbol("Omega", real=True)
decay = c * (A + D) / (2 * A * D)
prove(
    sp.expand((A * D * s**2 + c * (A + D) * s + c**2 + G**2).subs(s, -decay + sp.I * rate)),
    sp.expand(-A * D * rate**2 - A * D * decay**2 + c**2 + G**2),
    "at s = −c (A + D)/(2AD) + iΩ it is real, and zero for one Ω²",
    names=r"P(-\tfrac{c(A+D)}{2AD}+i\Omega)",
)

# %%
prove(decay, a * c / (a**2 - b**2), "the decay of the paired precession", names=r"\tfrac{c}{2}(1/A+1/D)")


# %%
def decayed(link: Link, friction: float) -> tuple[float, float]:
    """The closed form of the decay, 1/s, and that of an exact run over whole half turns, from its energy."""
    start = paired_scene(Scene(spins=(10.0, -10.0), link=link), 0.01)
    own_a, own_b = start.inertias
    body = Structure([(0, 0), (1, 0)], [(0, 1)], [10.0, -10.0], link=link, friction=friction)
    until = np.pi * round(5 / friction) / body.modes().rates.max()
    energy = body.simulate([0.0, until], start.axes, start.rates, tol=1e-10).tilt_energy
    return own_a * friction / (own_a**2 - own_b**2), float(-np.log(energy[1] / energy[0]) / 2 / until)


bars = (Link(1, 1, 0.5), Link(1, 1, 0))
decays = {link.inertia: decayed(link, 0.4) for link in bars}
assert all(abs(found / closed - 1) < 1e-4 for closed, found in decays.values())
Remark(
    "The decay on the exact motion",
    "The law ac/(a² − b²) of the rate of decay is compared with exact runs of amplitude 0.01 with c = 0.4 N m s/rad. "
    + " ".join(
        f"For a bar of 1 kg and {K:g} kg m² the law gives {closed:.6f} 1/s and the exact run {found:.6f} 1/s."
        for K, (closed, found) in decays.items()
    ),
)

# %% [markdown]
# With a massless bar the energy decays as $e^{-2ct/a}$ at any amplitude, even while the spins decrease:

# %%
large = paired_scene(Scene(spins=(10.0, -10.0), link=Link(1, 0, 0)), 0.3)
lasting = np.linspace(0, 5, 26)
slowing = Structure([(0, 0), (1, 0)], [(0, 1)], [10.0, -10.0], friction=0.2, spin_friction=0.1)
lost = slowing.simulate(lasting, large.axes, large.rates, tol=1e-9).tilt_energy
off = float(np.abs(lost / lost[0] / np.exp(-2 * 0.2 * lasting / slowing.rotor[0].J) - 1).max())
assert off < 1e-8
Remark(
    "The decay at a large amplitude",
    f"In an exact run from the amplitude 0.3 the energy is E_0 e^(−2ct/a), with a relative error of at most {off:.0e}.",
)

# %% [markdown]
# ## Friction topples the pair
#
# Friction changes the momentum about the joint line: $P'=-c\sum(r_i\times r_i')_x$, and

# %%
x, x_v, alpha, alpha_v = sp.symbols("x x_v alpha alpha_v", real=True)
radius = sp.sqrt(1 - x**2)
y, z = -radius * sp.sin(alpha), radius * sp.cos(alpha)
y_v, z_v = (e.diff(x) * x_v + e.diff(alpha) * alpha_v for e in (y, z))
prove(
    sp.expand(y * z_v - z * y_v),
    (1 - x**2) * alpha_v,
    "the momentum of a unit mass about the joint line",
    names=r"(r\times r')_x",
)

# %% [markdown]
# so that to second order $P+c\,(\alpha_1+\alpha_2)$ is constant. At the end the pair is at rest. Apart from the momentum of a
# static twist, $P$ has changed into an angle: **the pair rotates about the joint line by $\Delta\alpha=\Delta P/2c$ in
# total**. This angle is larger for smaller friction.
#
# A paired precession has such a $P$. The bar makes $x_1-x_2$ of second order:

# %%
y_1, y_2, w = sp.symbols("y_1 y_2 w", real=True)
epsilon = sp.Symbol("epsilon", positive=True)
gap = (y_1 - y_2) ** 2 / (2 * k)
z_1, z_2 = (sp.sqrt(1 - epsilon**2 * (w**2 + e**2)) for e in (y_1, y_2))
bar = (k - epsilon**2 * gap) ** 2 + epsilon**2 * (y_2 - y_1) ** 2 + (z_2 - z_1) ** 2 - k**2
prove(
    bar,
    0,
    "the constraint of the bar is satisfied through third order by x_1 − x_2 = (y_1 − y_2)²/2k",
    small=epsilon,
    order=3,
    names=r"|\ell e_x+R(r_2-r_1)|^2/R^2-k^2",
)

# %% [markdown]
# so that opposite spins have $P=A(\alpha_1'+\alpha_2')+G(y_1-y_2)^2/2k$ to second order. On the periodic precession of
# amplitude $r_0$ the first term has no mean, and $y_1-y_2$ the amplitude $2r_0\sqrt{A/D}$ (its energy passes to and fro
# between $x$ and the twist):

# %%
r_0, phase = sp.symbols("r_0 phi", positive=True)
twist = 2 * r_0 * sp.sqrt((a + b) / (a - b)) * sp.sin(phase)
mean = sp.integrate(G * twist**2 / (2 * k), (phase, 0, 2 * sp.pi)) / (2 * sp.pi)
prove(mean, G * r_0**2 * (a + b) / (k * (a - b)), "the momentum of the paired precession", names="P")

# %% [markdown]
# The total angle is $Gr_0^2(a+b)/(2ck(a-b))$. On the exact motion:


# %%
def begun(link: Link, r0: float = 0.1, spin: float = 10.0) -> tuple[Scene, float, float]:
    """A paired precession, its momentum about the joint line, and G r0² A/D."""
    start = paired_scene(Scene(spins=(spin, -spin), link=link), r0)
    A, B = start.inertias
    return (
        start,
        float(simulate(start, [0.0], model="minimal").joint_line_momentum[0]),
        spin * r0**2 * (A + B) / (A - B),
    )


def turned(start: Scene, P: float, mean: float, friction: float) -> tuple[float, float, float]:
    """(angle about the joint line at rest, ΔP/2c, the closed form) of a paired precession that friction stops."""
    spin, until = start.spins[0], 10 * sum(start.inertias) / friction
    s = Structure([(0, 0), (1, 0)], [(0, 1)], start.spins, link=start.link, friction=friction)
    run = s.simulate(np.linspace(0, until, 70), start.axes, start.rates, tol=1e-6)
    angle = np.unwrap(np.arctan2(-run.axes[..., 1], run.axes[..., 2]).mean(0))
    left = spin * float(run.axes[0, -1, 0] - run.axes[1, -1, 0])  # what a twist at rest keeps of P
    return float(angle[-1]), (P - left) / (2 * friction), mean / (2 * friction)


starts = {link.mass: begun(link) for link in (Link(1, 0, 0), Link(1, 1, 0.5))}
toppled = {(mass, friction): turned(*starts[mass], friction) for mass in starts for friction in (0.4, 0.8)}
assert all(
    abs(found / whole - 1) < 2e-3 and abs(found / closed - 1) < 0.02 for found, whole, closed in toppled.values()
)
Remark(
    "Friction topples the paired precession",
    "Exact runs start from the amplitude 0.1 with spins of ±10 rad/s and end at rest, rotated about the joint line. "
    + " ".join(
        f"For a bar of {mass:g} kg and c = {friction:g} N m s/rad the angle is {found:.4f} rad; ΔP/2c is {whole:.4f} "
        "rad, and the "
        f"closed form gives {closed:.4f} rad."
        for (mass, friction), (found, whole, closed) in toppled.items()
    ),
)

# %% [markdown]
# ## Spin-down
#
# With $G(t)=G e^{-c_st/I_3}$ the linear equation of the complex tilt, $au''+cu'=iG(t)u'$, still has a closed solution:

# %%
turn = sp.Function("Phi")(t)
velocity = sp.exp(-c * t / a + sp.I * turn)
left = (a * velocity.diff(t) + c * velocity).subs(turn.diff(t), G * sp.exp(-c_s * t / I3) / a)
prove(
    sp.expand(left / velocity),
    sp.I * G * sp.exp(-c_s * t / I3),
    "the velocity turns at G(t)/a and shrinks by friction alone",
    names="(au''+cu')/u'",
)

# %% [markdown]
# The radius of a precession is its velocity over its rate $G(t)/a$, which is proportional to $e^{(c_s/I_3-c/a)t}$. Spin-down
# alone increases it as $1/G$. If the friction of the joint is the same in every direction, $c_s=c$, the radius **grows for
# $I_3<a$** and decreases for $I_3>a$.

# %%
friction, spin, r0, until = 0.05, 40.0, 0.02, 8.0
whole = Scene(spins=(spin, -spin), link=Link(1, 0, 0))
start = paired_scene(whole, r0)
s_pair = Structure([(0, 0), (1, 0)], [(0, 1)], [spin, -spin], friction=friction, spin_friction=friction)
late = np.linspace(until, until + 2 * np.pi * 1.25 / (spin * np.exp(-friction * until)), 65)[:-1]
run = s_pair.simulate(np.concatenate([[0.0], late]), start.axes, start.rates, tol=1e-7)
swing = run.axes[:, 1:, 0].mean(0)
found_radius = float(np.ptp(swing) / 2 / r0)
middle = until + float(late[-1] - late[0]) / 2
expected = float(np.exp((friction / 1 - friction / 1.25) * middle))
assert abs(found_radius / expected - 1) < 0.01
assert found_radius > 1
Remark(
    "The radius of the precession grows as the rotors spin down",
    f"The friction is {friction:g} N m s/rad in every direction, I_3 = 1 kg m² and a = 1.25 kg m². After {until:g} s the radius "
    f"of the exact paired precession is {found_radius:.4f} times its initial value; the law exp((1/I_3 − 1/a) c t) gives "
    f"{expected:.4f}.",
)

# %% [markdown]
# ## Conserved quantities under spin-down
#
# The torque that slows a spin is along its axis: it does no work on the tilt, as the spin itself does none. With $c=0$
# the energy of the tilt is constant while $G$ falls, at any amplitude and any speed of the spin-down; the action
# $E/\Omega$, the adiabatic invariant of a Lagrangian that depends on time, is not, and grows as $1/G$.
#
# The torque does change the momentum about the joint line, $P'=\sum G_i'x_i$. With $r=r_0G_0/G$ the mean of $P$ is
# $2A\bar\alpha'+Gr^2A/(kD)$, and the mean of $P'$ is $G'r^2A/(kD)$. From $G_0$ to $G$ the term $2A\bar\alpha'$ becomes

# %%
G_0, now = sp.symbols("G_0 g", positive=True)
share = (r_0 * G_0 / now) ** 2 * (a + b) / (k * (a - b))
gained = sp.integrate(share - sp.diff(now * share, now), (now, G_0, G))
prove(
    gained / (2 * (a + b)),
    -G_0 * r_0**2 / (k * (a - b)) * (G_0 / G - 1),
    "the rate at which spin-down topples the paired precession",
    names=r"\bar\alpha'",
)

# %% [markdown]
# The pair topples faster as the radius grows; in the time $t$ it topples by
# $-\frac{G_0r_0^2}{kD}\left(\frac{e^{\nu t}-1}{\nu}-t\right)$ with $\nu=c_s/I_3$.


# %%
def slowed(link: Link, narrow: float, spin: float = 40.0, loss: float = 0.2) -> tuple[float, float, float]:
    """Angle about the joint line (rad) as the spins have halved, its closed form, and the change of the energy."""
    start = paired_scene(Scene(spins=(spin, -spin), link=link), narrow)
    own_a, own_b = start.inertias
    body = Structure([(0, 0), (1, 0)], [(0, 1)], [spin, -spin], link=link, spin_friction=loss)
    until = np.log(2) / loss
    turn_time = 2 * np.pi * np.sqrt(own_a**2 - own_b**2) / (spin / 2)
    about = until + turn_time * (np.arange(64) / 64 - 0.5)
    run = body.simulate([0.0, *about], start.axes, start.rates, tol=1e-8)
    angle = np.arctan2(-run.axes[:, 1:, 1], run.axes[:, 1:, 2]).mean()
    closed = -spin * narrow**2 / (own_a - own_b) * (1 / loss - until)
    return float(angle), float(closed), float(np.ptp(run.tilt_energy) / run.tilt_energy[0])


halved = {(link.mass, narrow): slowed(link, narrow) for link in (Link(), Link(1, 1, 0.5)) for narrow in (0.06,)}
assert all(abs(found / closed - 1) < 0.02 and change < 1e-7 for found, closed, change in halved.values())
Remark(
    "Spin-down topples too",
    "Spins of ±40 rad/s decrease to half in 3.5 s, without friction of the axes (c = 0). The angle about the joint "
    "line is averaged "
    "over the turn at that time. "
    + " ".join(
        f"For a bar of {mass:g} kg and the amplitude {narrow:g} its mean is −{-found:.4f} rad in the exact motion; "
        "the closed form "
        f"gives −{-closed:.4f} rad."
        for (mass, narrow), (found, closed, _) in halved.items()
    )
    + f" The relative change of the energy is at most {max(change for *_, change in halved.values()):.0e}.",
)
