# %% [markdown]
# # One rotor on a ground joint (5.01 to 5.06)
#
# **Objective.** The Lagrangian of one symmetric rotor that turns about the lower end of its axis, from nothing but its
# rotation matrix; its two first integrals; the rate of precession in terms of them.
#
# **Assumptions.** No gravity, an ideal ball joint, a rigid body with transverse inertia $I_1$ and axial inertia $I_3$
# about its centre, which lies half way along the axis of length $R$.
#
# **Notation.** $\theta$ inclination, $\phi$ the node angle (the paper's $\varphi$), $\psi$ the spin angle,
# $J = I_1 + M R^2/4$, and plain symbols for rates: `phi_dot` is $\dot\phi$.

# %%
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.mechanics import cyclic_coordinates, momenta, total_derivative
from lagrotor.pair.lagrangians import J_OF, rotor_lagrangian
from lagrotor.pair.symbols import I1, I3, M_3, ROTOR, I, J, M, M_z, R, a_const, omega
from lagrotor.paper.ledger import Statement, chain
from lagrotor.paper.notebook import Formula, Judged

theta, phi, psi = ROTOR.q
theta_v, phi_v, psi_v = ROTOR.v
c, s = sp.cos(theta), sp.sin(theta)

# %% [markdown]
# ## The kinetic energy from the rotation
#
# The body frame is carried by $Q = R_z(\phi) R_x(\theta) R_z(\psi)$; its angular velocity in the body frame is the
# axial vector of $Q^T \dot Q$. The centre moves with $\frac R2 \dot r$, $r = Q e_z$.


# %%
def turn(about: int, angle: sp.Expr) -> sp.Matrix:
    return sp.Matrix(sp.rot_axis1(angle) if about == 0 else sp.rot_axis3(angle)).T


Q = turn(2, phi) * turn(0, theta) * turn(2, psi)
spin_matrix = Q.T * Q.applyfunc(lambda e: total_derivative(e, ROTOR))
Omega_body = sp.Matrix([spin_matrix[2, 1], spin_matrix[0, 2], spin_matrix[1, 0]])
centre_velocity = R / 2 * (Q[:, 2]).applyfunc(lambda e: total_derivative(e, ROTOR))
turning = (I1 * (Omega_body[0] ** 2 + Omega_body[1] ** 2) + I3 * Omega_body[2] ** 2) / 2
kinetic = turning + M / 2 * centre_velocity.dot(centre_velocity)

# The two-angle form with J in place of I_1 is the same function: decided, not simplified.
reduced = rotor_lagrangian().subs(J, J_OF)
assert decide_zero(kinetic - reduced).answer == "zero"
Formula(reduced)

# %% [markdown]
# ## First integrals
#
# $\phi$ and $\psi$ are cyclic; their momenta are the constants of the motion $M_z$ and $M_3$.

# %%
L = rotor_lagrangian()
assert set(cyclic_coordinates(L, ROTOR)) == {phi, psi}
p_theta, p_phi, p_psi = momenta(L, ROTOR)
rate = sp.solve([p_phi - M_z, p_psi - M_3], [phi_v, psi_v], dict=True)[0][phi_v]
uniform = {I1: I, I3: I, J: I}
Formula(sp.Eq(phi_v, rate))

# %% [markdown]
# ## What the paper prints
#
# The paper's Lagrangian carries $I_1$, "the rotational inertia perpendicular to the gyroscope axis". Taken about the
# centre the kinetic energy of translation, $\frac12 M \frac{R^2}{4}|\dot r|^2$, is missing; taken about the joint it is
# there. The paper's own rotor has $I_1 = 1$ about its centre and $J = 5/4$.

# %%
about_joint = {M: 0, J: I1}
printed_L = I1 / 2 * (theta_v**2 + phi_v**2 * s**2) + I3 / 2 * (psi_v + phi_v * c) ** 2
missing = sp.factor(sp.expand_trig(reduced - printed_L).expand())

printed_rate = (M_z - M_3 * c) / (I1 * s**2)
printed_M_z = phi_v * (I1 * s**2 + I3 * c**2) + psi_v * I3 * c
printed_M_z_uniform = phi_v * I + psi_v * I * c
spin_v = omega - phi_v * c  # psi' from omega = psi' + phi' cos theta
phi_v0, theta_0 = sp.symbols("phi_0_dot theta_0", real=True)
constant = (p_phi / I).subs(uniform)

in_joint_words = "I_1 read as the transverse inertia about the ground joint"
statements = [
    Statement(
        "5.01",
        chain(L, printed_L),
        given={J: I1},
        condition=in_joint_words,
        evidence=(
            f"The derived energy exceeds the printed one by {missing}: with I_1 about the centre the energy "
            "of translation is missing.",
        ),
        steps=(
            "Q = R_z(phi) R_x(theta) R_z(psi)",
            "L = sum of rotation about the centre and translation of the centre",
        ),
    ),
    Statement(
        "5.02",
        chain(rate, printed_rate),
        given={J: I1},
        condition=in_joint_words,
        depends_on=("5.01", "5.03"),
        steps=("phi and psi are cyclic", "solve p_phi = M_z, p_psi = M_3 for phi'"),
    ),
    Statement("5.03", chain(p_phi, printed_M_z), given={J: I1}, condition=in_joint_words, depends_on=("5.01",)),
    Statement(
        "5.04",
        chain(p_phi, printed_M_z_uniform),
        given={J: I, I3: I},
        condition="equal inertias about the joint; the paper's rotor has J = 5/4 and I_3 = 1",
        depends_on=("5.03",),
    ),
    Statement(
        "5.05",
        chain(
            rate.subs(M_3, I3 * omega),
            (M_z - I * omega * c) / (I * s**2),
            ((a_const - omega * c) / s**2).subs(a_const, M_z / I),
        ),
        given={J: I, I3: I},
        condition="equal inertias about the joint",
        depends_on=("5.02", "5.04"),
    ),
    Statement(
        "5.06",
        chain(
            constant.subs(psi_v, spin_v),
            (phi_v + psi_v * c).subs(psi_v, spin_v),
            phi_v + (omega - phi_v * c) * c,
            phi_v * (1 - c**2) + omega * c,
            (phi_v0 * sp.sin(theta_0) ** 2 + omega * sp.cos(theta_0)).subs({phi_v0: phi_v, theta_0: theta}),
        ),
        depends_on=("5.04",),
    ),
]
Judged(statements)
