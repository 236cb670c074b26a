# %% [markdown]
# # The parallel pair (2.01 to 2.11)
#
# **Objective.** The paper's first theory: two fast rotors whose axes stay parallel share one force. Every line from its
# premises; whether a bar can keep the axes parallel is the next script's question.
#
# **Assumptions.** No gravity, ideal joints. $\vec r = R\hat r$ is the lever from the ground joint to the tip, the
# paper's $I$ the axial inertia (its rotor has $I_1 = I_3 = I$), so that $G_i = I\omega_i$.
#
# **Notation.** $\hat r = (\sin\theta\cos\phi, \sin\theta\sin\phi, \cos\theta)$; $\varepsilon$: rate of the axis over
# the rate of the spin; $\rho = \omega_1/\omega_2$.

# %%
import sympy as sp

from lagrotor.algebra import decide_equal, decide_zero
from lagrotor.mechanics import accelerations, total_derivative
from lagrotor.pair.lagrangians import axis, rotor_lagrangian
from lagrotor.pair.symbols import I3, ROTOR, I, J, R, m, omega, omega_1, omega_2
from lagrotor.paper.ledger import Relation, chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Formula, Judged

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
Formula(sp.Eq(omega, spin))

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
sp.Tuple(sp.Eq(share, solved[share]), sp.Eq(turning, solved[turning]))

# %%
statements = [
    stated(
        "2.01",
        chain(F.subs(on_bar), F_A + F_B),
        given={m: 0},
        condition="massless link",
        evidence=("With mass m the sum falls short of F by m times the acceleration of the link's centre.",),
    ),
    *(
        stated(
            identifier,
            along(of_rotor(i, L_slow), I * i * r_hat, 0),
            evidence=(neglected,),
            steps=("L = Q diag(J, J, I) Omega_body = J r x r' + I omega r", "r' = epsilon omega (...)"),
        )
        for identifier, i in (("2.02", omega_1), ("2.03", omega_2))
    ),
    *(
        stated(
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
    stated(
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
    stated(
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
    stated(
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
    stated(
        "2.09",
        chain(r.cross(f_solved), printed_g),
        wrong="The sign of 2.08 is carried on.",
        quantities=(r"\vec r\times\vec f = \frac{\rho - 1}{2(1 + \rho)}\,\vec r\times\vec F",),
        correction=chain(r.cross(f_solved), correct_g),
        depends_on=("2.08",),
        evidence=("It inherits the sign of 2.08: the faster rotor takes more of the force, not less.",),
    ),
    stated(
        "2.10",
        chain(omega_1 * I * w, r.cross(F) / 2 + printed_g),
        wrong="The sign of 2.08 is carried on.",
        quantities=(
            r"\omega_1 I\dot{\hat r} = \vec r\times\tfrac12\vec F + \frac{\rho - 1}{2(1 + \rho)}\,\vec r\times\vec F",
        ),
        correction=chain(omega_1 * I * w, r.cross(F) / 2 + correct_g),
        depends_on=("2.09", "2.04"),
    ),
    stated(
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
]
Judged(statements)
