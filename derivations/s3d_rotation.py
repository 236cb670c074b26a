# %% [markdown]
# # The rotation of a body in a step (3.14 to 3.18)
#
# **Objective.** The rotation of a body's vertices in one step of the paper's program, and its angular velocity without a matrix
# inversion, for columns and for the rows of the code.
#
# **Assumptions.** The angular velocity is constant during a step. Vectors are columns; the program stores them as rows, which
# are written here as transposes.
#
# **Notation.** $\Omega_\times$ the matrix of $\vec\Omega\times$; $n$ the unit vector along $\vec\Omega$ with inclination
# $\theta$ and azimuth $\phi$; $\Omega = |\vec\Omega|$; $Q$ any rotation, in Euler angles; $I_x, I_y, I_z$ the principal
# inertias.

# %%
import sympy as sp

from lagrotor.pair import axis
from lagrotor.pair.notation import PAIR, ROTOR
from lagrotor.paper import Formula, Premise, prove, verdict
from lagrotor.paper.grammar import cross_matrix, inverse, rotation, vector
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

body = PAPER.scripts.run("derivations", "s3b_rigid_body")
theta, phi, _ = ROTOR.q
dt = sp.Symbol("Delta_t", positive=True)
Omega, L, X_r = map(vector, ("Omega", "L", "X_r"))

# %% [markdown]
# ## A vertex
#
# A vertex at $\vec X_r = Q\vec d$ from the centre moves with $\dot Q\vec d + Q\dot{\vec d}$, the field of 3.09. The paper has
# the factors of the cross product in the other order. Its next sentence has $1 + \Delta t\,\Omega_\times$, which is not a
# rotation: it stretches the squares of vectors perpendicular to $\vec\Omega$ by

# %%
Q, d, d_v = (body[name] for name in ("Q", "d", "d_v"))
vertex_rate = body["rate"](Q) * d + Q * d_v
stretch = (sp.eye(3) + dt * cross_matrix(Omega)).T * (sp.eye(3) + dt * cross_matrix(Omega))
SPIN = 10  # rad/s, the paper's
stretched = sp.expand(stretch[0, 0].subs(dict(zip(Omega, (0, 0, SPIN), strict=True))))
Formula(stretch[0, 0], r"\left((1 + \Delta t\,\Omega_\times)^T(1 + \Delta t\,\Omega_\times)\right)_{xx}")

# %%
turning_vertex = form("cross(Omega, X_r)", Omega=body["Omega_turn"], X_r=Q * d)
verdict(
    "3.14",
    vertex_rate,
    premises=[body["rigid"]],
    correction=turning_vertex,
    wrong="The two factors of the cross product are interchanged.",
    uses=["3.09"],
    evidence=[
        "The sign is opposite to the sign in 3.09; storing rows instead of columns does not change it. The next sentence of the "
        "paper, (1 + dt Omega_x) X_r, and 3.15 have the right sign. That sentence is also right that 1 + dt Omega_x is not a "
        f"rotation: at a spin of {SPIN} rad/s it stretches a vector across the spin by the square root of {stretched}."
    ],
    form=turning_vertex,
)

# %% [markdown]
# ## The projection
#
# The projector on $n$ keeps the component along $n$ and removes the perpendicular one: $P = 1 + n_\times^2$.

# %%
n = axis(theta, phi)
N = cross_matrix(n)
P = sp.eye(3) + N**2
prove((P * P, P * n), (P, n), "P is a projector, and n stays", equations=(r"P^2 = P", r"P\,n = n"))

# %% [markdown]
# The paper's product lacks the norm of $\vec\Omega$:

# %%
w = sp.Symbol("Omega_norm", positive=True)
prove(
    (w * n) * (w * n).T,
    w**2 * P,
    "the outer product of Ω with itself",
    equations=r"\vec\Omega\,\vec\Omega^T = |\vec\Omega|^2\,P",
)

# %%
projector = form("Omega*transpose(Omega)/Omega_norm**2", {"Omega_norm": r"\|\Omega\|"}, Omega=w * n)
projection = verdict(
    "3.16",
    P,
    correction=projector,
    wrong="The projection is not divided by |Omega|², and for a column vector the printed product is a number, not a matrix.",
    evidence=[
        "For a column, Omega^T Omega is the number |Omega|^2. For a row, as the program stores it, it is the outer product, not "
        f"divided by |Omega|^2; at the paper's spin it is {SPIN**2} times too large. The paper's remark on NaN shows that the "
        "program divides by |Omega|^2."
    ],
    form=projector,
)
projection

# %% [markdown]
# ## The finite rotation
#
# With a constant $\vec\Omega$ the rotation over the step is the exponential of $\Delta t\,\Omega_\times$: it solves
# $dR' = \Omega_\times dR$ from $dR = 1$. As $n_\times^3 = -n_\times$, its power series closes.

# %%
prove(N**3, -N, "the cube of the cross matrix of a unit vector", equations=r"n_\times^3 = -n_\times")

# %%
angle = w * dt
exact_dR = sp.eye(3) + sp.sin(angle) * N + (1 - sp.cos(angle)) * N**2
prove(
    (exact_dR.diff(dt), exact_dR.subs(dt, 0)),
    (w * N * exact_dR, sp.eye(3)),
    "the equation of the rotation, and its start",
    equations=(r"\frac{d}{d\Delta_t}\,dR = |\vec\Omega|\,n_\times\,dR", r"dR\,\big|_{\Delta_t = 0} = 1"),
)

# %% [markdown]
# The paper prints $\sin(\|\Delta t\|\Omega)$, the sine of a vector; the bars belong to $\Omega$.

# %%
sine = sp.Symbol("Omega_in_sine", real=True)
bars = Premise("the bars in the sine belong to Ω: sin(‖Ω‖ Δt)", {sine: w})
verdict(
    "3.15",
    exact_dR,
    premises=[bars],
    uses=["3.14", projection],
    evidence=[
        "The printed line takes the sine of a vector. P is read as the projector on Omega, not as the product printed in 3.16. "
        "The matrix is the exponential of dt Omega_x: it satisfies dR' = Omega_x dR and starts from the unit matrix."
    ],
    form=form(
        "P + cos(Omega_norm*Delta_t)*(one - P) + sin(Omega_norm*Delta_t)*N",
        {"one": r"\mathbb{1}", "N": r"\hat\Omega_\times", "Omega_norm": r"\|\Omega\|"},
        P=P,
        N=N,
        one=sp.eye(3),
    ),
)

# %% [markdown]
# ## The angular velocity without a matrix inversion
#
# In the body's frame the tensor is always $I_0$, and the angular momentum is $R^T\vec L$. ($I_0$ is diagonal if the principal
# axes coincide with the ground's axes in the first orientation.) The angular velocity, transformed back to the ground's frame:

# %%
R = Q
principal = sp.diag(*sp.symbols("I_x I_y I_z", positive=True))
stored = inverse(principal)  # the program keeps it as I
in_body = stored * (R.T * L)
Omega_of_L = R * in_body
Formula(in_body, r"R^T\vec\Omega")

# %% [markdown]
# It agrees with $\vec L$ and the tensor of the rotated body (3.12 corrected), so only $I_0$ is inverted:

# %%
prove((R * principal * R.T) * Omega_of_L, L, "L = I(t) Ω", equations=r"R\,I_0\,R^T\,\vec\Omega = \vec L")

# %%
inverse_tensor = {"inverse": "I_0^{-1}"}
without_inversion = form("R*inverse*transpose(R)*L", inverse_tensor, R=R, inverse=stored)
verdict(
    "3.17",
    Omega_of_L,
    correction=without_inversion,
    wrong="R and its transpose are interchanged, as in the rotated tensor of section 3.1.",
    uses=["3.12"],
    evidence=[
        "The line follows from 3.12 as printed, which is wrong. With equal inertias the printed and the derived line agree."
    ],
    form=without_inversion,
)

# %% [markdown]
# ## Rows
#
# A row is the transpose of a column, and $(AB)' = B'A'$. The paper transposes rightly, also in the update of the vertices:

# %%
prove(
    (R.T * stored * R * L).T,
    L.T * R.T * stored * R,
    "the transposition of 3.17 as printed",
    equations=r"\big(R^T I_0^{-1} R\,\vec L\big)^T = \vec L^T R^T I_0^{-1} R",
)

# %%
theta_1, phi_1, psi_1 = PAIR.q[:3]
dR = rotation(phi_1, theta_1, psi_1)  # any rotation
row = form("transpose(L)*R*inverse*transpose(R)", inverse_tensor, R=R, inverse=stored)
verdict(
    "3.18",
    {"O": Omega_of_L.T, r"X_r(t + \Delta t)'": (dR * X_r).T},
    correction={"O": row},
    wrong="R and its transpose are interchanged, as in the rotated tensor of section 3.1.",
    uses=["3.17"],
    evidence=[
        "The transposition itself is right, with I the stored inverse of the symmetric I_0, and X_r*dR' is right too. "
        "The error is "
        "that the transposed line is 3.17."
    ],
    form={"O": row, r"X_r(t + \Delta t)'": form("transpose(X_r)*transpose(dR)", {"dR": "dR"}, dR=dR)},
)
