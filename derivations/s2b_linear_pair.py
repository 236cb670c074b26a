# %% [markdown]
# # The parallel pair's bar (2.12, 2.13)
#
# **Objective.** The rate that the parallel pair's premises give, then the premise itself: for which spins can a bar
# between two points keep the axes parallel at all, and how do they drift when it does not?
#
# **Assumptions.** No gravity, ideal joints, small angles from rest: the exact pair linearised. A force acts on the tip of
# rotor 1. The paper's $I$ is the axial inertia, so that $G_i = I\omega_i$.
#
# **Notation.** $r_i = (x_i, y_i, 1)$; $\varepsilon$: the size of what is linearised; $a$, $b$: inertias of the axes with
# their share of the bar.

# %%
import sympy as sp

from lagrotor.algebra import decide_equal, decide_zero
from lagrotor.mechanics import euler_lagrange
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.pair.symbols import AXES, G_1, G_2, I, Omega, R, a, b, k, omega, omega_1, omega_2, t
from lagrotor.paper import scripts
from lagrotor.paper.ledger import chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Formula, Judged

eps = sp.Symbol("epsilon", positive=True)
premises = scripts.run("derivations", "s2a_parallel_pair")
F, r, w = (premises[name] for name in ("F", "r", "w"))  # w: the axes' rate by (3) and (4), solved there

# %% [markdown]
# ## Can the bar keep the axes parallel?
#
# The exact pair linearised about rest, $r_i = (x_i, y_i, 1)$: the bar ties $x_1 = x_2 = X$ and pulls along $x$ only.
# The force acts on the tip of rotor 1. What is left is
# $2(a+b)X'' = -G_1y_1' - G_2y_2' + RF_x$, $\;ay_1''+by_2'' = G_1X' + RF_y$, $\;ay_2''+by_1'' = G_2X'$.

# %%
system = axes_pair()
pull = sp.Matrix(sp.symbols("lambda_1 lambda_2 N", real=True))
tip_force = sp.Matrix([F[0], F[1], 0, 0, 0, 0]) * R
balance = euler_lagrange(system.L, AXES) - system.push - system.rows.T * pull - tip_force
x1, y1, z1, x2, y2, z2 = AXES.q
upright = {z1: 1, z2: 1, **dict.fromkeys((AXES.v[2], AXES.v[5], AXES.a[2], AXES.a[5]), 0)}
tilts = [s for row in (AXES.q, AXES.v, AXES.a) for s in row if s not in upright]
scaled = upright | {s: eps * s for s in [*tilts, *pull, F[0], F[1]]}
linear = balance.subs(scaled, simultaneous=True).diff(eps).subs(eps, 0)
tie = system.constraints[2].subs(scaled, simultaneous=True).diff(eps).subs(eps, 0)
assert decide_zero(tie - k * (x2 - x1)).answer == "zero"
X, X_v, X_a = sp.symbols("X X_dot X_ddot", real=True)
common = {x1: X, x2: X, AXES.v[0]: X_v, AXES.v[3]: X_v, AXES.a[0]: X_a, AXES.a[3]: X_a}
y1_v, y2_v, y1_a, y2_a = AXES.v[1], AXES.v[4], AXES.a[1], AXES.a[4]
reduced = sp.Matrix([linear[0] + linear[3], linear[1], linear[4]]).subs(common)  # the pull N drops out of the sum
expected = (
    2 * (a + b) * X_a + G_1 * y1_v + G_2 * y2_v - R * F[0],
    a * y1_a + b * y2_a - G_1 * X_v - R * F[1],
    a * y2_a + b * y1_a - G_2 * X_v,
)
assert decide_equal(reduced, sp.Matrix(expected)).answer == "zero"

# With y_1 = y_2 the last two equations differ by what a force across the bar would have to supply.
twisting = sp.expand((reduced[2] - reduced[1]).subs({y2_v: y1_v, y2_a: y1_a}))
assert decide_zero(twisting - (G_1 - G_2) * X_v - R * F[1]).answer == "zero"
Formula(sp.Eq(twisting, 0))

# %% [markdown]
# ## Linear response to a force on one tip, any two spins
#
# The last two equations integrate to $A y' = G X + R F_y t\,e_1$, $A = \begin{pmatrix}a&b\\b&a\end{pmatrix}$; the first
# is then an oscillator of frequency $\Omega^2 = D/(2(a+b)(a^2-b^2))$, $D = a(G_1^2+G_2^2) - 2bG_1G_2$, about a drift
# linear in time. The same with an impulse $P$ at $t = 0$.

# %%
A = sp.Matrix([[a, b], [b, a]])
G = sp.Matrix([G_1, G_2])
D = a * (G_1**2 + G_2**2) - 2 * b * G_1 * G_2
X_0, X_1 = sp.symbols("X_0 X_1", real=True)
y_rates = A.adjugate() / A.det() * (G * (X_0 + X_1 * t) + sp.Matrix([R * F[1] * t, 0]))
held = sp.Poly(sp.together(-G.dot(y_rates) + R * F[0]).as_numer_denom()[0], t).all_coeffs()
drift = sp.solve(held, [X_0, X_1], dict=True)[0]
y_drift = (y_rates.subs(drift)).applyfunc(sp.cancel)
spins = {G_1: I * omega_1, G_2: I * omega_2}
mean_drift = sp.Matrix([drift[X_1], (y_drift[0] + y_drift[1]) / 2]).subs(spins)
corrected_x = -R * (a * G_1 - b * G_2) * F[1] / D
corrected_y = R * (a - b) * (G_1 + G_2) * F[0] / (2 * D) + R * G_2 * (G_2 - G_1) * F[1] * t / (2 * D)
corrected_drift = sp.Matrix([corrected_x, corrected_y]).subs(spins)

# After an impulse P: X and y_i in closed form; checked against the linear equations for any inertia of X.
P_x, P_y = sp.symbols("P_x P_y", real=True)
inertia_X = sp.Symbol("m_X", positive=True)  # 2 (a + b)
X_c = -R * P_y * (a * G_1 - b * G_2) / D
X_response = X_c * (1 - sp.cos(Omega * t)) + R * P_x / (inertia_X * Omega) * sp.sin(Omega * t)
X_area = X_c * (t - sp.sin(Omega * t) / Omega) + R * P_x / (inertia_X * Omega**2) * (1 - sp.cos(Omega * t))
y_response = sp.Matrix(
    [(a * G_1 - b * G_2) * X_area + a * R * P_y * t, (a * G_2 - b * G_1) * X_area - b * R * P_y * t]
) / (a**2 - b**2)
Omega_squared = D / (2 * (a + b) * (a**2 - b**2))
in_Omega = {inertia_X: D / ((a**2 - b**2) * Omega**2)}
free = (
    inertia_X * X_response.diff(t, 2) + G.dot(y_response.diff(t)),
    *(A * y_response.diff(t, 2) - G * X_response.diff(t)),
    *(A * y_response.diff(t) - sp.Matrix([R * P_y, 0])).subs(t, 0),
    (inertia_X * X_response.diff(t) - R * P_x).subs(t, 0),
)
assert all(decide_zero(e.subs(in_Omega)).answer == "zero" for e in free)
impulse_response = tuple(e.subs(inertia_X, 2 * (a + b)) for e in (X_response, *y_response))
sp.Eq(Omega**2, Omega_squared)

# %% [markdown]
# ## What the paper prints

# %%
lever = R * sp.Matrix([0, 0, 1])
printed_drift = lever.cross(F)[:2, :] / ((omega_1 + omega_2) * I)
printed_half = lever.cross(F / 2)[:2, :] / (omega * I)
equal = {omega_1: omega, omega_2: omega}
own_drift = [sp.Matrix([drift[X_1], rate]).subs(spins).subs(equal) for rate in y_drift]


def off(ratio: sp.Rational) -> sp.Expr:
    """Mean drift over the paper's, for a force along a massless bar and omega_2 = ratio omega_1."""
    exact, printed = (e[1].diff(F[0]).subs({b: 0, omega_2: ratio * omega_1}) for e in (mean_drift, printed_drift))
    return sp.cancel(exact / printed)


halved, third = sp.Rational(1, 2), sp.Rational(1, 3)
table = ", ".join(f"{float(off(ratio)):.3g} at {ratio}" for ratio in (sp.S.One, halved, third, sp.S.Zero, -halved))
opposite = [sp.cancel(e.diff(F[0]).subs(spins).subs({b: 0, omega_2: -omega_1})) for e in y_drift]
shares = sp.factor((G_1 * y_drift[0] / (G_2 * y_drift[1])).subs({b: 0, F[1]: 0}))

statements = [
    stated(
        "2.12",
        (*chain(w, r.cross(F) / ((omega_1 + omega_2) * I)), *chain(mean_drift, printed_drift)),
        given={omega_2: omega_1},
        condition="drift of the mean axis of the linearised pair under a steady force on one tip",
        correction=chain(mean_drift, corrected_drift),
        depends_on=("2.11", "2.04", "2.05"),
        evidence=(
            "From the premises it follows for any spins. The premise of parallel axes does not: they stay parallel "
            f"only if {sp.factor(twisting)} = 0, since the bar pulls along itself alone; at rest that is along x. "
            "A force along the bar leaves them parallel if omega_1 = omega_2, a force across it on one tip, "
            "from rest, never: for equal spins the mean axis still follows (7), while the axes twist apart.",
            f"Mean drift under a steady force along a massless bar, over the paper's, by omega_2/omega_1: {table}. "
            f"The bar shares the force as {shares}, squares of the spins, not as the spins.",
            f"After an impulse the pair rings about the drift at Omega^2 = {Omega_squared}.",
            f"For omega_2 = -omega_1 the paper's rate has no bound; the axes drift at {opposite[0]} and {opposite[1]} "
            "per unit of force.",
        ),
        steps=(
            "linearise the pair about rest: x_1 = x_2 = X",
            "integrate the y equations; X = X_0 + X_1 t is the drift, Omega the nutation about it",
        ),
    ),
    stated(
        "2.13",
        tuple(r for each in own_drift for r in chain(each, printed_half, printed_drift.subs(equal))),
        given={F[1]: sp.Integer(0)},
        condition="force along the bar; drift of each axis of the linearised pair",
        depends_on=("2.12",),
        evidence=(
            "Each axis by itself drifts so for a force along the bar, which is shared in halves. A force across it "
            f"on one tip twists the pair: y_1' - y_2' grows as {sp.factor((y_drift[0] - y_drift[1]).subs(G_2, G_1))}.",
        ),
    ),
]
Judged(statements)
