# %% [markdown]
# # The parallel pair (2.01 to 2.13)
#
# **Objective.** The paper's first theory: two fast rotors whose axes stay parallel share one force. Every line from its
# premises, then the premise itself: for which spins can a bar between two points keep the axes parallel at all?
#
# **Assumptions.** No gravity, ideal joints. $\vec r = R\hat r$ is the lever from the ground joint to the tip, the
# paper's $I$ the axial inertia (its rotor has $I_1 = I_3 = I$), so that $G_i = I\omega_i$.
#
# **Notation.** $\hat r = (\sin\theta\cos\phi, \sin\theta\sin\phi, \cos\theta)$; $\varepsilon$: rate of the axis over
# the rate of the spin; $\rho = \omega_1/\omega_2$; $a$, $b$: inertias of the axes with their share of the bar.

# %%
import sympy as sp

from lagrotor.algebra import decide_equal, decide_zero
from lagrotor.mechanics import accelerations, euler_lagrange, jacobian, total_derivative
from lagrotor.paper.ledger import Relation, Statement, chain
from lagrotor.rotors.lagrangians import axes_pair, axis, rotor_lagrangian
from lagrotor.symbols import AXES, G_1, G_2, I3, ROTOR, I, J, Omega, R, a, b, k, m, omega, omega_1, omega_2, t

theta, phi, psi = ROTOR.q
theta_v, phi_v, psi_v = ROTOR.v
eps = sp.Symbol("epsilon", positive=True)


def vector(name: str) -> sp.Matrix:
    return sp.Matrix(sp.symbols(f"{name}_x {name}_y {name}_z", real=True))


def along(derived: sp.Matrix, printed: sp.Matrix, claimed: int) -> tuple[Relation, ...]:
    """Vectors held against each other component by component, up to epsilon**claimed."""
    return tuple(Relation(p, d, eps, claimed) for p, d in zip(printed, derived, strict=True))


# %% [markdown]
# ## Angular momentum of a rotor about its joint, and its rate
#
# $\vec L = Q\,\mathrm{diag}(J, J, I)\,\vec\Omega_{body}$ with $Q = R_z(\phi)R_y(\theta)R_z(\psi)$, whose last
# column is the axis; it is $J\hat r\times\hat r' + I\omega\hat r$. A force at the tip gives the rates by the
# Lagrangian.


# %%
def rate(expression: sp.Matrix) -> sp.Matrix:
    return expression.applyfunc(lambda e: total_derivative(e, ROTOR))


r_hat = axis(theta, phi)
Q = sp.rot_axis3(phi).T * sp.rot_axis2(theta).T * sp.rot_axis3(psi).T
assert decide_equal(Q[:, 2], r_hat).answer == "zero"
spin_matrix = Q.T * rate(Q)
Omega_body = sp.Matrix([spin_matrix[2, 1], spin_matrix[0, 2], spin_matrix[1, 0]])
L_exact = J * r_hat.cross(rate(r_hat)) + I * omega * r_hat
spin = psi_v + phi_v * sp.cos(theta)
assert decide_equal(Q * sp.diag(J, J, I) * Omega_body, L_exact.subs(omega, spin)).answer == "zero"

F_A, F_B, F, f = map(vector, ("F_A", "F_B", "F", "f"))
push = [R * F_A.dot(r_hat.diff(angle)) for angle in ROTOR.q]
motion = dict(zip(ROTOR.a, accelerations(rotor_lagrangian().subs(I3, I), ROTOR, push), strict=True))
torque = rate(L_exact.subs(omega, spin)).subs(motion)
assert decide_zero(total_derivative(spin, ROTOR).subs(motion)).answer == "zero"  # omega is conserved

# Slow motion: the axis is a function of epsilon omega t, so its rate is of first order, its acceleration of second.
p, q, p_t, q_t = sp.symbols("p q p_t q_t", real=True)
pace = {theta_v: eps * omega * p, phi_v: eps * omega * q}
slow = pace | {ROTOR.a[0]: (eps * omega) ** 2 * p_t, ROTOR.a[1]: (eps * omega) ** 2 * q_t}
slow_rate = rate(r_hat).subs(slow)
L_slow, torque_slow = L_exact.subs(slow), rate(L_exact).subs(slow)


def of_rotor(i: sp.Symbol, expression: sp.Matrix) -> sp.Matrix:
    return expression.subs(omega, i)


neglected = "The part left out, J r x r', is of first order in epsilon; the paper's footnote 1 says as much."
slowness = (
    "Slow means that r is a function of epsilon omega t. A force switched on at once also starts a nutation, whose "
    "acceleration J r x r'' is as large as the torque; the formula is then right for the mean motion only.",
)

# %% [markdown]
# ## The algebra of (3) to (7)
#
# Premises: $\omega_1 I w = T/2 + g$ and $\omega_2 I w = T/2 - g$ with $T = \vec r\times\vec F$,
# $g = \vec r\times\vec f$, $w = \hat r'$, both axes the same. Two linear equations give $g$ and $w$; $\vec f$ itself
# is fixed but for a part along $\vec r$.

# %%
r = vector("r")
T = r.cross(F)
rho = omega_1 / omega_2
share, turning, along_r = sp.symbols("share turning lambda_r", real=True)
solved = sp.solve(
    [omega_1 * I * turning - sp.S.Half - share, omega_2 * I * turning - sp.S.Half + share], [share, turning], dict=True
)[0]
w = solved[turning] * T
f_solved = solved[share] * F + along_r * r
halves = sp.solve([*(F_A + F_B - F), *((F_A - F_B) / 2 - f)], [*F_A, *F_B], dict=True)[0]
bar_acceleration = vector("A")
on_bar = sp.solve(list(F - F_A - F_B - m * bar_acceleration), list(F), dict=True)[0]

printed_g = (1 - rho) / (2 * (1 + rho)) * r.cross(F)
correct_g = (rho - 1) / (2 * (1 + rho)) * r.cross(F)
printed_6 = 1 / (omega_1 * I) * r.cross((1 + rho - rho + 1) / (1 + rho) * F / 2)
correct_6 = 1 / (omega_1 * I) * r.cross((1 + rho + rho - 1) / (1 + rho) * F / 2)
ratio_6 = sp.cancel(printed_6[0] / w[0])

# %% [markdown]
# ## Can the bar keep the axes parallel?
#
# The exact pair linearised about rest, $r_i = (x_i, y_i, 1)$: the bar ties $x_1 = x_2 = X$ and pulls along $x$ only.
# The force acts on the tip of rotor 1. What is left is
# $2(a+b)X'' = -G_1y_1' - G_2y_2' + RF_x$, $\;ay_1''+by_2'' = G_1X' + RF_y$, $\;ay_2''+by_1'' = G_2X'$.

# %%
system, gyroscopic = axes_pair()
pull = sp.Matrix(sp.symbols("lambda_1 lambda_2 N", real=True))
tip_force = sp.Matrix([F[0], F[1], 0, 0, 0, 0]) * R
balance = euler_lagrange(system.L, AXES) - gyroscopic - jacobian(system.g, AXES).T * pull - tip_force
x1, y1, z1, x2, y2, z2 = AXES.q
upright = {z1: 1, z2: 1, **dict.fromkeys((AXES.v[2], AXES.v[5], AXES.a[2], AXES.a[5]), 0)}
tilts = [s for row in (AXES.q, AXES.v, AXES.a) for s in row if s not in upright]
scaled = upright | {s: eps * s for s in [*tilts, *pull, F[0], F[1]]}
linear = balance.subs(scaled, simultaneous=True).diff(eps).subs(eps, 0)
tie = system.g[2].subs(scaled, simultaneous=True).diff(eps).subs(eps, 0)
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
    Statement(
        "2.01",
        chain(F.subs(on_bar), F_A + F_B),
        given={m: 0},
        condition="massless link",
        evidence=("With mass m the sum falls short of F by m times the acceleration of the link's centre.",),
    ),
    *(
        Statement(
            identifier,
            along(of_rotor(i, L_slow), I * i * r_hat, 0),
            evidence=(neglected,),
            steps=("L = Q diag(J, J, I) Omega_body = J r x r' + I omega r", "r' = epsilon omega (...)"),
        )
        for identifier, i in (("2.02", omega_1), ("2.03", omega_2))
    ),
    *(
        Statement(
            identifier,
            (
                *chain(torque.subs(dict(zip(F_A, force, strict=True))), R * r_hat.cross(force)),
                *along(of_rotor(i, torque_slow), i * I * of_rotor(i, slow_rate), 1),
            ),
            depends_on=(leans,),
            evidence=(
                *slowness,
                "omega is conserved: a force on the axis has no moment about it. The lever is R r, not the unit vector "
                "r that the paper's hats mix it with; the paper has R = 1.",
                "sin(theta) = 0 is excluded by the angles used here, not by the motion.",
            ),
            steps=("rates from the Lagrangian with the force at the tip", "d/dt (J r x r' + I omega r)"),
        )
        for identifier, i, force, leans in (("2.04", omega_1, F_A, "2.02"), ("2.05", omega_2, F_B, "2.03"))
    ),
    Statement(
        "2.06",
        (
            *chain(F_A.subs(halves), F / 2 + f),
            *chain(F_B.subs(halves), F / 2 - f),
            *chain(f, *(e.subs(halves) for e in (F_A / 2 - F_B / 2, F_A - F / 2, F / 2 - F_B))),
        ),
        definition=True,
        depends_on=("2.01",),
        evidence=(
            "The source is garbled by scanning (F_1 to F_4, sixths). What 2.07 uses, and what is judged here, is "
            "f = F_A/2 - F_B/2 = F_A - F/2, hence F_A = F/2 + f and F_B = F/2 - f.",
        ),
    ),
    Statement(
        "2.07",
        chain(
            omega_1 * I * w,
            r.cross(F / 2 + f_solved),
            rho * (omega_2 * I * w),
            rho * r.cross(F / 2 - f_solved),
        ),
        depends_on=("2.04", "2.05", "2.06"),
        steps=("(3) and (4) with one axis for both rotors, solved for r x f and r'",),
    ),
    Statement(
        "2.08",
        chain(r.cross(f_solved) + rho * r.cross(f_solved), r.cross(F) / 2 - rho * r.cross(F) / 2),
        wrong="The left side has the wrong sign.",
        quantities=(
            r"(1 + \rho)\,\vec r\times\vec f = (\rho - 1)\,\vec r\times\tfrac12\vec F,\quad \rho = \omega_1/\omega_2",
        ),
        correction=chain(r.cross(f_solved) + rho * r.cross(f_solved), rho * r.cross(F) / 2 - r.cross(F) / 2),
        depends_on=("2.07",),
        evidence=("The left side has the wrong sign: collecting 2.07 gives rho r x F/2 - r x F/2.",),
    ),
    Statement(
        "2.09",
        chain(r.cross(f_solved), printed_g),
        wrong="The sign of 2.08 is carried on.",
        quantities=(r"\vec r\times\vec f = \frac{\rho - 1}{2(1 + \rho)}\,\vec r\times\vec F",),
        correction=chain(r.cross(f_solved), correct_g),
        depends_on=("2.08",),
        evidence=("It inherits the sign of 2.08: the faster rotor takes more of the force, not less.",),
    ),
    Statement(
        "2.10",
        chain(omega_1 * I * w, r.cross(F) / 2 + printed_g),
        wrong="The sign of 2.08 is carried on.",
        quantities=(
            r"\omega_1 I\dot{\hat r} = \vec r\times\tfrac12\vec F + \frac{\rho - 1}{2(1 + \rho)}\,\vec r\times\vec F",
        ),
        correction=chain(omega_1 * I * w, r.cross(F) / 2 + correct_g),
        depends_on=("2.09", "2.04"),
    ),
    Statement(
        "2.11",
        chain(w, printed_6),
        wrong="The sign of 2.08 makes the factor 2/(1 + rho) where the premises give 2 rho/(1 + rho).",
        quantities=(r"\dot{\hat r} = \frac{1}{\omega_1 I}\,\vec r\times\frac{2\rho}{1 + \rho}\,\tfrac12\vec F",),
        correction=chain(w, correct_6),
        depends_on=("2.10",),
        evidence=(
            f"As printed it is {ratio_6} times the rate that the premises give, and (7) does not follow from it. (7) "
            "is what the premises give: the sign lost in 2.08 is made good between (6) and (7).",
        ),
    ),
    Statement(
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
    Statement(
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
