# %% [markdown]
# # Force and angular momentum of each rotor (2.01 to 2.05)
#
# **Objective.** The start of the paper's first theory: the link divides the external force, and each rotor responds to its
# share.
#
# **Assumptions.** No gravity, ideal joints, symmetric rotors that turn about the lower end of their axes.
#
# **Notation.** $\hat r$ the unit vector along an axis, with inclination $\theta$ and azimuth $\phi$; $\vec r = R\hat r$
# the lever from the ground joint to the tip; $\omega = \dot\psi + \dot\phi\cos\theta$ the axial angular velocity; $I_3$
# and $J$ the axial inertia and the transverse one about the joint; $\epsilon$ the rate of an axis over that of its spin.

# %%
import sympy as sp

from lagrotor.mechanics import accelerations, total_derivative
from lagrotor.pair import axis, rotor_lagrangian
from lagrotor.pair.notation import I3, ROTOR, J, R, m, omega_1, omega_2
from lagrotor.paper import Formula, Premise, prove, verdict
from lagrotor.paper.grammar import rotation, vector
from lagrotor.paper.proof import Form, form
from lagrotor.paper.rotor_pair.premises import about_parameters

theta, phi, psi = ROTOR.q
theta_v, phi_v, psi_v = ROTOR.v
theta_a, phi_a, psi_a = ROTOR.a

# %% [markdown]
# ## The link
#
# The force $\vec F$ acts on the link, which pushes the rotors with $\vec F_A$ and $\vec F_B$. Newton's law for the link, of
# mass $m$ and with the acceleration $\vec A$ of its centre, is $m\vec A = \vec F - \vec F_A - \vec F_B$.

# %%
F, A = vector("F"), vector("A")
shared = F - m * A
Formula(shared, r"\vec F_A + \vec F_B")

# %%
massless_link = about_parameters("the link is massless, m = 0", {m: 0})
verdict(
    "2.01",
    shared,
    premises=[massless_link],
    evidence=[
        "With a massive link the sum of the two forces is F minus the mass times the acceleration of the link's centre."
    ],
    form=form("F - m*A"),
)

# %% [markdown]
# ## Angular momentum about the joint
#
# With $\phi$ the azimuth of the axis, the rotation $Q = R_z(\phi + \pi/2)\,R_x(\theta)\,R_z(\psi)$ gives the body's frame:

# %%


def rate(expression: sp.Matrix) -> sp.Matrix:
    """d/dt in the rotor's angles."""
    return expression.applyfunc(lambda entry: total_derivative(entry, ROTOR))


r_hat = axis(theta, phi)
Q = rotation(phi + sp.pi / 2, theta, psi)
prove(Q[:, 2], r_hat, "the last column of Q is the axis", names=r"Q\,e_z")

# %% [markdown]
# The angular velocity in that frame is the axial vector of $Q^T\dot Q$. With the inertias $J, J, I_3$ the angular momentum
# has a part across the axis and one along it.

# %%
W = Q.T * rate(Q)
Omega_body = sp.Matrix([W[2, 1], W[0, 2], W[1, 0]])
spin = psi_v + phi_v * sp.cos(theta)


def angular_momentum(omega: sp.Expr) -> sp.Matrix:
    """J r × r' + I_3 omega r."""
    return J * r_hat.cross(rate(r_hat)) + I3 * omega * r_hat


prove(
    Q * sp.diag(J, J, I3) * Omega_body,
    angular_momentum(spin),
    "the angular momentum is J r × r′ + I₃ ω r",
    equations=r"\vec L = Q\,\mathrm{diag}(J, J, I_3)\,\vec\Omega = J\,\hat r\times\dot{\hat r} + I_3\,\omega\,\hat r",
)

# %% [markdown]
# The paper keeps the component along the axis. It dominates if the axis turns slowly compared with the spin: $\dot\theta$ and
# $\dot\phi$ are of order $\epsilon\omega$.

# %%
eps = sp.Symbol("epsilon", positive=True)
p, q, p_t, q_t = sp.symbols("p q p_t q_t", real=True)


def slow_axis(omega: sp.Symbol) -> Premise:
    """The axis turns slowly against the spin omega."""
    return Premise(
        "the axis turns slowly compared with the spin, |r̂′| ≪ ω",
        {theta_v: eps * omega * p, phi_v: eps * omega * q},
        small=eps,
    )


neglected = "The neglected term J r × r' is of first order in epsilon, as the paper's footnote 1 says."
verdict(
    "2.02",
    angular_momentum(omega_1),
    premises=[slow_axis(omega_1)],
    evidence=[neglected],
    form=form("I_3*omega_1*axis(theta, phi) + J*cross(axis(theta, phi), hat_r_dot)", hat_r_dot=rate(r_hat)),
)

# %%
verdict(
    "2.03",
    angular_momentum(omega_2),
    premises=[slow_axis(omega_2)],
    evidence=[neglected],
    form=form("I_3*omega_2*axis(theta, phi) + J*cross(axis(theta, phi), hat_r_dot)", hat_r_dot=rate(r_hat)),
)

# %% [markdown]
# ## Torque
#
# A force $\vec F$ at the tip has the generalized forces $R\,\vec F\cdot\partial\hat r/\partial q$. It does not change the
# spin:

# %%
push = [R * F.dot(r_hat.diff(angle)) for angle in ROTOR.q]
motion = dict(zip(ROTOR.a, accelerations(rotor_lagrangian(), ROTOR, push), strict=True))
prove(
    total_derivative(spin, ROTOR).xreplace(motion),
    0,
    "ω is conserved: a force on the axis has no moment about it",
    names=r"\dot\omega",
)

# %% [markdown]
# Along the motion that Lagrange's equations give, the angular momentum changes by the moment of the force.

# %%
prove(
    rate(angular_momentum(spin)).xreplace(motion),
    R * r_hat.cross(F),
    "the torque is the rate of the angular momentum, exactly",
    equations=r"\dot{\vec L} = R\,\hat r\times\vec F",
)

# %% [markdown]
# With $\omega$ constant this rate is $J\hat r\times\ddot{\hat r} + I_3\omega\,\dot{\hat r}$. The paper's torque is the
# second part. The first is smaller by one order in $\epsilon$ if the rate of the axis itself also changes slowly.


# %%
def torque(omega: sp.Symbol) -> sp.Matrix:
    """d/dt of the angular momentum with omega constant."""
    return rate(angular_momentum(omega))


prove(
    torque(omega_1),
    J * r_hat.cross(rate(rate(r_hat))) + I3 * omega_1 * rate(r_hat),
    "the torque is J r × r″ + I₃ ω r′",
    equations=r"\dot{\vec L} = J\,\hat r\times\ddot{\hat r} + I_3\,\omega_1\,\dot{\hat r}",
)

# %% [markdown]
# The paper's shock violates this condition: it lasts about $1/50$ s, less than one revolution of the rotor.

# %%
SPIN, WIDTH = 10, sp.Rational(1, 50)  # rad/s and s: the paper's rotor and its shock (section 4.2)


def slow_force(omega: sp.Symbol) -> Premise:
    """The rate of the axis changes slowly against the spin omega."""
    return Premise(
        "the force changes slowly compared with the spin, |r̂″| ≪ ω |r̂′|",
        {theta_a: (eps * omega) ** 2 * p_t, phi_a: (eps * omega) ** 2 * q_t},
        small=eps,
        broken=f"its shock lasts {float(WIDTH):g} s, while the rotor turns by {float(SPIN * WIDTH):.1g} rad",
    )


def torque_written(omega: str) -> Form:
    """The torque in vectors."""
    moved = {"hat_r_dot": rate(r_hat), "hat_r_ddot": rate(rate(r_hat))}
    return form(f"I_3*{omega}*hat_r_dot + J*cross(axis(theta, phi), hat_r_ddot)", **moved)


slowness = (
    "A force switched on suddenly also starts a nutation, whose acceleration J r × r'' is as large as the "
    "torque. The formula then describes only the mean motion.",
    "The lever is R r. The paper uses the same symbol for the unit vector, which is no difference for R = 1.",
)
verdict(
    "2.04",
    torque(omega_1),
    premises=[slow_axis(omega_1), slow_force(omega_1)],
    uses=["2.02"],
    evidence=slowness,
    form=torque_written("omega_1"),
)

# %%
verdict(
    "2.05",
    torque(omega_2),
    premises=[slow_axis(omega_2), slow_force(omega_2)],
    uses=["2.03"],
    evidence=slowness,
    form=torque_written("omega_2"),
)
