# %% [markdown]
# # Can the bar keep the axes parallel?
#
# **Objective.** The paper's first theory assumes parallel axes. The exact pair, linearised about rest, shows for which spins and
# forces the axes stay parallel, and how they drift otherwise.
#
# **Assumptions.** The pair of figure 1. No gravity, ideal joints, small tilts from rest. A force acts on the tip of rotor 1.
# Nothing is assumed of the spins or of the bar.
#
# **Notation.** $r_i = (x_i, y_i, 1)$ the axes; $a$, $b$ the inertias of the axes with their share of the bar; $k = \ell/R$;
# $G_i = I_3\omega_i$; $\epsilon$ the size of what is linearised.

# %%
import sympy as sp

from lagrotor.mechanics import euler_lagrange
from lagrotor.pair import axes_pair
from lagrotor.pair.notation import AXES, G_1, G_2, I3, Omega, R, a, b, k, omega_1, omega_2, t
from lagrotor.paper import Formula, Remark, prove
from lagrotor.paper.grammar import vector

eps = sp.Symbol("epsilon", positive=True)
F = vector("F")

# %% [markdown]
# ## Linear equations
#
# Lagrange's equations of the exact pair with multipliers $\lambda_1$, $\lambda_2$ (unit lengths) and $N$ (the bar), each
# scaled by $\epsilon$ about rest, where every tilt and every force is small.

# %%
system = axes_pair()
pull = sp.Matrix(sp.symbols("lambda_1 lambda_2 N", real=True))
tip_force = sp.Matrix([F[0], F[1], 0, 0, 0, 0]) * R
balance = euler_lagrange(system.L, AXES) - system.generalised_forces - system.rows.T * pull - tip_force

x1, y1, z1, x2, y2, z2 = AXES.q
still = (AXES.v[2], AXES.v[5], AXES.a[2], AXES.a[5])
upright = dict.fromkeys((z1, z2), sp.S.One) | dict.fromkeys(still, sp.S.Zero)
tilts = [s for row in (AXES.q, AXES.v, AXES.a) for s in row if s not in upright]
scaled = upright | {s: eps * s for s in [*tilts, *pull, F[0], F[1]]}


def linearised(expression):
    """The part of first order in the tilts and the forces."""
    return expression.xreplace(scaled).diff(eps).xreplace({eps: sp.S.Zero})


linear = linearised(balance)
prove(linearised(system.constraints[2]), k * (x2 - x1), "the bar's length, to first order: both tips have the same x")

# %% [markdown]
# The common tilt is $X = x_1 = x_2$. The sum of its two equations does not contain the bar's force $N$, so three equations
# remain.

# %%
X, X_v, X_a = sp.symbols("X X_dot X_ddot", real=True)
common = {x1: X, x2: X, AXES.v[0]: X_v, AXES.v[3]: X_v, AXES.a[0]: X_a, AXES.a[3]: X_a}
y1_v, y2_v, y1_a, y2_a = AXES.v[1], AXES.v[4], AXES.a[1], AXES.a[4]
reduced = tuple(e.subs(common) for e in (linear[0] + linear[3], linear[1], linear[4]))
prove(
    reduced,
    (
        2 * (a + b) * X_a + G_1 * y1_v + G_2 * y2_v - R * F[0],
        a * y1_a + b * y2_a - G_1 * X_v - R * F[1],
        a * y2_a + b * y1_a - G_2 * X_v,
    ),
    "the equations of motion along the bar and across it, each equal to zero",
)

# %% [markdown]
# ## Parallel axes
#
# For parallel axes, $y_1 = y_2$, the difference of the last two equations must vanish for every $\dot X$. From rest the axes
# therefore stay parallel only if the spins are equal and the force acts along the bar.

# %%
twisting = (reduced[2] - reduced[1]).subs({y2_v: y1_v, y2_a: y1_a})
prove(twisting, (G_1 - G_2) * X_v + R * F[1], "the condition for parallel axes: this expression vanishes")

# %% [markdown]
# ## Drift under a steady force
#
# From rest the last two equations integrate to $A\,\dot y = G X + (R F_y t, 0)$ with $A = \begin{pmatrix}a&b\\b&a\end{pmatrix}$.
# The drift is the solution without nutation, $X = X_0 + X_1 t$:

# %%
X_0, X_1 = sp.symbols("X_0 X_1", real=True)
once = {y1_a: y1_v, y2_a: y2_v, X_v: X_0 + X_1 * t, F[1]: F[1] * t}
turning = sp.solve([e.xreplace(once) for e in reduced[1:]], [y1_v, y2_v], dict=True, simplify=False)[0]
y_rates = sp.Matrix([turning[y1_v], turning[y2_v]])
inertia, G = sp.Matrix([[a, b], [b, a]]), sp.Matrix([G_1, G_2])
prove(
    inertia * y_rates,
    G * (X_0 + X_1 * t) + sp.Matrix([R * F[1] * t, 0]),
    "the integrated equations across the bar",
    equations=r"A\,\dot y = G\,(X_0 + X_1 t) + (R F_y t,\ 0)",
)

# %% [markdown]
# The equation along the bar holds at all times for one choice of $X_0$ and $X_1$.

# %%
along_bar = sp.Poly(sp.together(reduced[0].subs(X_a, 0).subs(turning)).as_numer_denom()[0], t).all_coeffs()
drift = sp.solve(along_bar, [X_0, X_1], dict=True, simplify=False)[0]
y_drift = y_rates.subs(drift).applyfunc(sp.cancel)
D = a * (G_1**2 + G_2**2) - 2 * b * G_1 * G_2
prove(drift[X_1], -R * (a * G_1 - b * G_2) * F[1] / D, "the common drift along the bar", names="X_1")

# %% [markdown]
# Across the bar the two axes drift independently; their mean is

# %%
mean_drift_y = R * (a - b) * (G_1 + G_2) * F[0] / (2 * D) + R * G_2 * (G_2 - G_1) * F[1] * t / (2 * D)
prove(
    (y_drift[0] + y_drift[1]) / 2,
    mean_drift_y,
    "the drift of the mean axis across the bar",
    names=r"\langle\dot y_1 + \dot y_2\rangle/2",
)

# %% [markdown]
# With $G_i = I_3\omega_i$ these are the drifts of the two axes as vectors, for any spins, any bar and any force.

# %%
written_out = {G_1: I3 * omega_1, G_2: I3 * omega_2}
drift_1, drift_2 = (sp.Matrix([drift[X_1], rate, 0]).subs(written_out) for rate in y_drift)
mean_drift = (drift_1 + drift_2) / 2
Formula(sp.Matrix([drift_1[1], drift_2[1]]), r"\langle(\dot y_1, \dot y_2)\rangle")

# %% [markdown]
# A massless bar divides a force along it in the ratio of the squares of the spins, not of the spins:

# %%
shares = (G_1 * y_drift[0] / (G_2 * y_drift[1])).subs({b: 0, F[1]: 0})
prove(shares, G_1**2 / G_2**2, "the torque on rotor 1 over that on rotor 2", names=r"\tau_1/\tau_2")

# %% [markdown]
# The paper's rate (2.12) for such a force is $F_xR/(I(\omega_1 + \omega_2))$. The mean axis drifts less:


# %%
def off(ratio: sp.Expr) -> sp.Expr:
    """Mean drift divided by the paper's, for a force along a massless bar and omega_2 = ratio omega_1."""
    paper = R / (I3 * (omega_1 + omega_2))
    return sp.cancel((mean_drift[1].diff(F[0]) / paper).subs({b: 0, omega_2: ratio * omega_1}))


rho = sp.Symbol("rho", real=True)
prove(
    off(rho),
    (1 + rho) ** 2 / (2 * (1 + rho**2)),
    "the drift of the mean axis divided by the paper's, ρ = ω₂/ω₁",
    names=r"\text{mean} / \text{paper}",
)

# %%
half, third = sp.Rational(1, 2), sp.Rational(1, 3)
ratios = (sp.S.One, half, third, sp.S.Zero, -half)
table = (
    f"{', '.join(f'{float(off(ratio)):.3g}' for ratio in ratios)} for ω₂/ω₁ = {', '.join(map(str, ratios))}"
).replace("-", "−")
opposite = [sp.cancel(e[1].diff(F[0]).subs({b: 0, omega_2: -omega_1})) for e in (drift_1, drift_2)]
apart = sp.cancel(opposite[1] / opposite[0])  # of the drifts of the two axes
twist_rate = sp.factor((y_drift[0] - y_drift[1]).subs(G_2, G_1))
Remark(
    "Error of the paper's drift",
    "A steady force along a massless bar makes the mean axis drift; the rate, divided by the paper's rate, is "
    f"{table}. For opposite spins the paper's rate is infinite, while the two axes drift at {opposite[0]} and {opposite[1]} per "
    "unit of force. A force across the bar on one tip twists a pair of equal spins: y₁′ − y₂′ grows as "
    f"{twist_rate}.",
)

# %% [markdown]
# ## Response to an impulse
#
# After an impulse $P$ on tip 1 the equations across the bar integrate to $A\,\dot y = G X + (R P_y, 0)$. Substituted into the
# equation along the bar, $2(a+b)\ddot X + G\cdot\dot y = 0$, they give an oscillator about a new centre.

# %%
P_x, P_y = sp.symbols("P_x P_y", real=True)
y_after = inertia.adjugate() / inertia.det() * (G * X + sp.Matrix([R * P_y, 0]))
centre = -R * P_y * (a * G_1 - b * G_2) / D
prove(
    G.dot(y_after),
    D / (a**2 - b**2) * (X - centre),
    "the force that drives X back to its centre",
    equations=(
        r"G\cdot\dot y = \frac{D\,(X - X_c)}{a^2 - b^2},\quad D = a\,(G_1^2 + G_2^2) - 2b\,G_1G_2,"
        r"\quad X_c = -\frac{R P_y\,(a\,G_1 - b\,G_2)}{D}"
    ),
)

# %%
Omega_squared = D / (2 * (a + b) * (a**2 - b**2))
Formula(Omega_squared, r"\Omega^2")

# %% [markdown]
# It starts at rest with the momentum $RP_x$ along the bar; $X_c$ is the centre.

# %%
X_c = sp.Symbol("X_c", real=True)
X_t = X_c * (1 - sp.cos(Omega * t)) + R * P_x / (2 * (a + b) * Omega) * sp.sin(Omega * t)
prove(
    (X_t.diff(t, 2), X_t.subs(t, 0), 2 * (a + b) * X_t.diff(t).subs(t, 0)),
    (-(Omega**2) * (X_t - X_c), 0, R * P_x),
    "the oscillation about the centre, from rest with the impulse",
    names=(r"\ddot X", "X(0)", r"2(a + b)\,\dot X(0)"),
)

# %% [markdown]
# Across the bar the axes follow $\int X\,dt$.

# %%
X_area = X_c * (t - sp.sin(Omega * t) / Omega) + R * P_x / (2 * (a + b) * Omega**2) * (1 - sp.cos(Omega * t))
prove(
    (X_area.diff(t), X_area.subs(t, 0)),
    (X_t, 0),
    "the area under X",
    names=(r"\frac{d}{dt}\int X\,dt", r"\int_0^0 X\,dt"),
)

# %%
y_t = inertia.adjugate() / inertia.det() * (G * X_area + sp.Matrix([R * P_y * t, 0]))
prove(
    tuple(y_t.diff(t)),
    tuple(y_after.subs(X, X_t)),
    "the rates of the axes across the bar",
    names=(r"\dot y_1", r"\dot y_2"),
)

# %%
impulse_response = tuple(e.subs(X_c, centre) for e in (X_t, *y_t))
Formula(sp.Matrix(impulse_response), "(X, y_1, y_2)")
