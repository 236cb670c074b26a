# %% [markdown]
# # One rotor on a ground joint (5.01 to 5.06)
#
# **Objective.** The Lagrangian of one symmetric rotor that turns about the lower end of its axis, from nothing but its
# rotation matrix; its two first integrals; the rate of precession in terms of them.
#
# **Assumptions.** No gravity, an ideal ball joint, a rigid body with transverse inertia $I_1$ and axial inertia $I_3$
# about its centre, which lies half way along the axis of length $R$.
#
# **Notation.** $\theta$ inclination, $\phi$ the node angle (the paper's $\varphi$), $\psi$ the spin angle;
# $J = I_1 + M R^2/4$ the transverse inertia about the joint; $\omega = \dot\psi + \dot\phi\cos\theta$ the axial angular
# velocity.

# %%
import sympy as sp

from lagrotor.mechanics import System, accelerations, momenta, total_derivative
from lagrotor.pair import J_OF, rotor_lagrangian
from lagrotor.pair.notation import I1, I3, M_3, ROTOR, J, M, M_z, R, omega
from lagrotor.paper import Formula, prove, verdict
from lagrotor.paper.grammar import rotation
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.premises import ABOUT_JOINT, EQUAL_INERTIAS

theta, phi, psi = ROTOR.q
theta_v, phi_v, psi_v = ROTOR.v
c, s = sp.cos(theta), sp.sin(theta)

# %% [markdown]
# ## Angular velocity
#
# The rotation of the body is $Q = R_z(\phi) R_x(\theta) R_z(\psi)$, and its angular velocity in the body's frame is the axial
# vector of $Q^T\dot Q$. The square of its component across the axis is $\dot\theta^2 + \dot\phi^2\sin^2\theta$; the component
# along the axis is $\omega$.

# %%
Q = rotation(phi, theta, psi)
spin_matrix = Q.T * Q.applyfunc(lambda e: total_derivative(e, ROTOR))
across = spin_matrix[2, 1] ** 2 + spin_matrix[0, 2] ** 2
along = spin_matrix[1, 0]
prove(
    (across, along),
    (theta_v**2 + phi_v**2 * s**2, psi_v + phi_v * c),
    "the angular velocity across and along the axis",
    names=(r"\Omega_x^2 + \Omega_y^2", r"\Omega_z"),
)

# %% [markdown]
# ## Kinetic energy
#
# The centre lies at $\frac R2 r$ with $r = Q e_z$ the unit vector along the axis.

# %%
centre_velocity = R / 2 * Q[:, 2].applyfunc(lambda e: total_derivative(e, ROTOR))
prove(
    centre_velocity.dot(centre_velocity),
    R**2 / 4 * (theta_v**2 + phi_v**2 * s**2),
    "the square of the centre's velocity",
    names=r"\tfrac{R^2}{4}\,|\dot r|^2",
)

# %% [markdown]
# The Lagrangian is the sum of rotation about the centre and translation of the centre. The translation adds $M R^2/4$ to $I_1$,
# which gives $J$.

# %%
kinetic = I1 / 2 * across + I3 / 2 * along**2 + M / 2 * centre_velocity.dot(centre_velocity)
L = rotor_lagrangian()
prove(kinetic, L.subs(J, J_OF), "the kinetic energy, with J for the inertia about the joint", names=r"\mathcal L")

# %% [markdown]
# The paper writes $I_1$ where $J$ belongs. It calls $I_1$ "the rotational inertia perpendicular to the gyroscope axis";
# about the centre, the energy of translation is missing.

# %%
verdict(
    "5.01",
    L,
    premises=[ABOUT_JOINT],
    written=form("J/2*(theta_dot**2 + phi_dot**2*sin(theta)**2) + I_3/2*(psi_dot + phi_dot*cos(theta))**2"),
)

# %% [markdown]
# ## First integrals
#
# $\phi$ and $\psi$ do not occur in $L$, so their momenta are constants of the motion.

# %%
assert set(System(ROTOR, L).cyclic) == {phi, psi}
p_theta, p_phi, p_psi = momenta(L, ROTOR)
prove(
    (p_phi, p_psi),
    (phi_v * (J * s**2 + I3 * c**2) + psi_v * I3 * c, I3 * (psi_v + phi_v * c)),
    "the momenta of the two cyclic coordinates",
    names=(r"p_\phi", r"p_\psi"),
)

# %%
momenta_written = {
    "M_z": form("phi_dot*(J*sin(theta)**2 + I_3*cos(theta)**2) + psi_dot*I_3*cos(theta)"),
    "M_3": form("I_3*(psi_dot + phi_dot*cos(theta))"),
}
verdict(
    "5.03",
    {"M_z": p_phi, "M_3": p_psi},
    premises=[ABOUT_JOINT],
    uses=["5.01"],
    written=momenta_written,
)

# %% [markdown]
# With all inertias equal to $I$ the first integral is simpler. For the paper's rotor the inertias are equal about the centre, not
# about the joint.

# %%
verdict(
    "5.04",
    {"M_z": p_phi, "M_3": p_psi},
    premises=[EQUAL_INERTIAS],
    uses=["5.03"],
    written=momenta_written,
)

# %% [markdown]
# ## Rate of precession
#
# The two integrals, $p_\phi = M_z$ and $p_\psi = M_3$, are two linear equations for $\dot\phi$ and $\dot\psi$.

# %%
rate = sp.solve([p_phi - M_z, p_psi - M_3], [phi_v, psi_v], dict=True, simplify=False)[0][phi_v]
Formula(sp.factor(rate), r"\dot\phi")

# %%
verdict(
    "5.02",
    rate,
    premises=[ABOUT_JOINT],
    uses=["5.01", "5.03"],
    written=form("(M_z - M_3*cos(theta))/(J*sin(theta)**2)"),
)

# %% [markdown]
# The axial momentum is $M_3 = I_3\omega$. For equal inertias the rate then depends on one constant, $a = M_z/I$:

# %%
rate_of_spin = rate.subs(M_3, I3 * omega)
prove(
    rate_of_spin, (M_z - I3 * omega * c) / (J * s**2), "the rate of precession by the axial velocity", names=r"\dot\phi"
)

# %%
verdict(
    "5.05",
    rate_of_spin,
    premises=[EQUAL_INERTIAS],
    uses=["5.02", "5.04"],
    written=form("(M_z - I_3*omega*cos(theta))/(J*sin(theta)**2)"),
)

# %% [markdown]
# ## The constant $a$
#
# It is $p_\phi/I$, and it is conserved:

# %%
motion = dict(zip(ROTOR.a, accelerations(L, ROTOR), strict=True))
change = total_derivative(p_phi / I3, ROTOR).subs(motion)
prove(change, 0, "the rate of a along the motion", names=r"\dot a")

# %%
verdict(
    "5.06",
    {"a": p_phi / I3, r"\dot a": change},
    premises=[EQUAL_INERTIAS],
    uses=["5.04"],
    written={
        "a": form("J/I_3*phi_dot*sin(theta)**2 + (psi_dot + phi_dot*cos(theta))*cos(theta)"),
        r"\dot a": form("0"),
    },
)
