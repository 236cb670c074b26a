# %% [markdown]
# # Rigid bodies (3.09 to 3.12)
#
# **Objective.** The velocity field of a rigid body, its angular momentum by the inertia tensor, and the tensor of the rotated
# body.
#
# **Assumptions.** A body of three particles as in the previous script; for the tensor, any body. Rigidity is a premise, named
# where it is used.
#
# **Notation.** $Q = R_z(\phi)R_x(\theta)R_z(\psi)$ is the rotation of the body; $\vec d_i = \vec X_i - \vec X_{cm}$, in the
# body's frame $\vec d = Q^T\vec d_i$; $\vec\Omega$ the angular velocity in the ground's frame; $\mathbb 1(\vec d)^2$ is read
# as $|\vec d|^2\,\mathbb 1$.

# %%
import sympy as sp

from lagrotor.algebra import hessian
from lagrotor.mechanics import total_derivative
from lagrotor.pair.notation import ROTOR
from lagrotor.paper import Formula, Premise, prove, verdict
from lagrotor.paper.grammar import cross, rotation, symmetric, vector
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

particles = PAPER.scripts.run("derivations", "s3a_particles")
masses, places, velocities, arms, L = (particles[name] for name in ("masses", "places", "velocities", "arms", "L"))
centre_of_mass = particles["centre_of_mass"]
theta, phi, psi = ROTOR.q


def rate(expression: sp.Matrix) -> sp.Matrix:
    """d/dt in the Euler angles of the body."""
    return expression.applyfunc(lambda entry: total_derivative(entry, ROTOR))


# %% [markdown]
# ## Angular velocity
#
# $Q$ is orthogonal, so $\dot Q Q^T$ is skew: it is the matrix of $\vec\Omega\times$.

# %%
Q = rotation(phi, theta, psi)
prove(Q * Q.T, sp.eye(3), "Q is a rotation", equations=r"Q\,Q^T = 1")

# %%
skew = rate(Q) * Q.T
prove(skew, -skew.T, "the rate of a rotation is skew", equations=r"\dot Q\,Q^T = -(\dot Q\,Q^T)^T")

# %%
theta_v, phi_v, psi_v = ROTOR.v
Omega_turn = sp.Matrix([skew[2, 1], skew[0, 2], skew[1, 0]])
prove(
    Omega_turn,
    sp.Matrix(
        [
            theta_v * sp.cos(phi) + psi_v * sp.sin(theta) * sp.sin(phi),
            theta_v * sp.sin(phi) - psi_v * sp.sin(theta) * sp.cos(phi),
            phi_v + psi_v * sp.cos(theta),
        ]
    ),
    "the angular velocity in Euler angles",
    names=r"\vec\Omega",
)

# %% [markdown]
# ## Velocity field
#
# A particle of any body lies at $\vec X_i = \vec X_{cm} + Q\vec d$ and moves with $\vec U_{cm} + \dot Q\vec d + Q\dot{\vec d}$.
# The last part vanishes for a rigid body.

# %%
U_cm, d, d_v = vector("U_cm"), vector("d"), vector("d_dot")
field = U_cm + rate(Q) * d + Q * d_v
rigid = Premise("the body is rigid, its particles are at rest in the body's frame", dict.fromkeys(d_v, sp.S.Zero))
verdict(
    "3.09",
    field,
    premises=[rigid],
    form=form("U_cm + cross(Omega, Q*d)", Omega=Omega_turn, Q=Q),
)

# %% [markdown]
# ## Angular momentum
#
# With this field the velocities of the particles are $\vec U_i = \vec U_{cm} + \vec\Omega\times\vec d_i$. This is the premise
# for the angular momentum (3.05) of a system of particles:

# %%
Omega = vector("Omega")
put_rigid = {}
for U, arm in zip(velocities, arms, strict=True):
    put_rigid |= dict(zip(U, U_cm + cross(Omega, arm), strict=True))
turning_rigidly = Premise("the body is rigid, U_i = U_cm + Ω × (X_i − X_cm)", put_rigid)
verdict(
    "3.10",
    L,
    premises=[turning_rigidly],
    uses=["3.05", "3.09", centre_of_mass],
    evidence=["1(X)^2 is read as |X|^2 times the unit matrix, and (X)(X)^T is read as the outer product."],
    form=form("sum_i(m_i*cross(X_i - X_cm, cross(Omega, X_i - X_cm)))", X_cm=particles["X_cm"]),
)

# %% [markdown]
# ## Inertia tensor
#
# The factor of $\vec\Omega$ is also the matrix of the rotational kinetic energy, $\frac12\vec\Omega\cdot I\,\vec\Omega$:

# %%
turning = sum(m * cross(Omega, arm).dot(cross(Omega, arm)) / 2 for m, arm in zip(masses, arms, strict=True))
inertia = hessian(turning, list(Omega))
prove(
    turning,
    (Omega.T * inertia * Omega)[0] / 2,
    "the rotational energy",
    equations=r"\sum_i \tfrac{m_i}{2}\,\big|\vec\Omega\times(\vec X_i - \vec X)\big|^2 = \tfrac12\,\vec\Omega\cdot I\,\vec\Omega",
)

# %%
verdict(
    "3.11",
    inertia,
    uses=["3.10", centre_of_mass],
    form=form(
        "sum_i(m_i*(dot(X_i - X_cm, X_i - X_cm)*one - (X_i - X_cm)*transpose(X_i - X_cm)))",
        {"one": r"\mathbb{1}"},
        X_cm=particles["X_cm"],
        one=sp.eye(3),
    ),
)

# %% [markdown]
# ## The tensor of the rotated body
#
# The tensor depends on the body through the second moments $C = \int \vec d\,\vec d^T\,dm$ alone,
# $I = \mathrm{tr}\,C\;\mathbb 1 - C$.

# %%
C = symmetric("C")
prove(
    sp.eye(3) * d.dot(d) - d * d.T,
    (sp.eye(3) * C.trace() - C).subs(dict(zip(C, d * d.T, strict=True))),
    "the tensor of one particle by its second moments",
    names=r"|\vec d|^2\,1 - \vec d\,\vec d^T",
)

# %% [markdown]
# The moments of the first orientation are $C = \frac12\mathrm{tr}\,I_0\;\mathbb 1 - I_0$. A rotation takes $\vec d$ to
# $R\vec d$ and $C$ to $R\,C R^T$; here $R$ is any rotation $Q$.

# %%
I_0 = symmetric("I_0")
C_0 = sp.eye(3) * I_0.trace() / 2 - I_0
C_turned = Q * C_0 * Q.T
I_turned = sp.eye(3) * C_turned.trace() - C_turned
prove(sp.eye(3) * C_0.trace() - C_0, I_0, "these moments have the tensor I_0", names=r"\mathrm{tr}\,C\;1 - C")

# %% [markdown]
# The paper has the transpose on the wrong side. A body with the principal inertias $1, 2, 3$ shows the difference after a quarter
# turn about $x$ and another about $z$:

# %%
unequal, quarter = sp.diag(1, 2, 3), {phi: sp.pi / 2, theta: sp.pi / 2, psi: 0}
right, wrong = ((turn * unequal * turn.T).subs(quarter) for turn in (Q, Q.T))
Formula(right, "R I_0 R^T"), Formula(wrong, "R^T I_0 R")

# %% [markdown]
# With equal inertias the two agree:

# %%
isotropic = sp.Symbol("I", positive=True) * sp.eye(3)
prove(
    Q * isotropic * Q.T,
    Q.T * isotropic * Q,
    "with equal principal inertias both are the same",
    equations=r"Q\,(I\,1)\,Q^T = Q^T(I\,1)\,Q",
)

# %%
turned = form("R*I_0*transpose(R)", R=Q)
verdict(
    "3.12",
    I_turned,
    correction=turned,
    wrong="R and its transpose are interchanged.",
    uses=["3.11"],
    evidence=[
        "The update X_r -> dR X_r, R -> dR R requires X_r(t) = R X_r(0); the tensor is then R I_0 R^T. The listing X*R' + X_cm "
        "defines R in the same way.",
        "A body with the principal inertias (1, 2, 3) is turned by a quarter turn about x and then by one about z. "
        "The diagonal of "
        f"its tensor is then {tuple(right.diagonal())}; the printed formula gives {tuple(wrong.diagonal())}. All bodies in the "
        "paper's runs have equal inertias, for which both formulas agree, so no run of the paper shows the error.",
    ],
    form=turned,
)
