# %% [markdown]
# # The simulator's time step (3.13 to 3.20)
#
# **Objective.** What one step of the paper's rigid body program does, against the exact motion: the Euler update and
# its order, the finite rotation, the row-vector form of the code, and the force of a link.
#
# **Assumptions.** Vectors are columns; the program stores them as rows, which are written here as transposes. The body
# frame at the start of a step is the principal one.
#
# **Notation.** $\Omega_\times$ is the matrix of $\vec\Omega\times$, $n$ the unit vector along $\vec\Omega$,
# $\Omega = |\vec\Omega|$; $e$ the unit vector from vertex 2 to vertex 1 (one reading of the paper's $\hat e_{21}$), $s$
# their distance.

# %%
import sympy as sp

from lagrotor.algebra import agreement_order, decide_equal, decide_zero
from lagrotor.pair.lagrangians import axis
from lagrotor.paper.ledger import Relation, chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Judged

dt = sp.Symbol("Delta_t", positive=True)


def vector(name: str) -> sp.Matrix:
    return sp.Matrix(sp.symbols(f"{name}_x {name}_y {name}_z", real=True))


def cross(v: sp.Matrix) -> sp.Matrix:
    """The matrix of v ×."""
    return sp.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def same(left: sp.Matrix, right: sp.Matrix) -> bool:
    return decide_equal(left, right).answer == "zero"


# %% [markdown]
# ## The Euler step against the exact motion
#
# Force and torque vary in time with rates $\dot F$, $\dot\tau$. Through the second order the exact motion is
# $L + \tau\Delta t + \frac12\dot\tau\Delta t^2$ and so on; $\Omega = I^{-1}L$ with a tensor that turns,
# $I' = \Omega_\times I - I\,\Omega_\times$.

# %%
L, tau, tau_v, U, F, F_v, X_cm, Omega = map(vector, ("L", "tau", "tau_dot", "U", "F", "F_dot", "X", "Omega"))
I_x, I_y, I_z, M = sp.symbols("I_x I_y I_z M", positive=True)
tensor = sp.diag(I_x, I_y, I_z)
tensor_rate = cross(Omega) * tensor - tensor * cross(Omega)
inverse = tensor.inv()
inverse_rate = -inverse * tensor_rate * inverse
L_of = tensor * Omega
exact_L = L + tau * dt + tau_v * dt**2 / 2
exact_U = U + F / M * dt + F_v / M * dt**2 / 2
exact_X = X_cm + U * dt + F / M * dt**2 / 2 + F_v / M * dt**3 / 6
exact_Omega = Omega + (inverse * tau + inverse_rate * L_of) * dt

printed_Omega = inverse * (L_of + tau * dt)
new_U = U + F * dt / M
lag = agreement_order(printed_Omega[0], exact_Omega[0], dt, 2)
by_old, by_new = (agreement_order(e[0], exact_X[0], dt, 3) for e in (X_cm + U * dt, X_cm + new_U * dt))
assert by_old.order == by_new.order == 2


def through(printed: sp.Matrix, exact: sp.Matrix, claimed: int) -> tuple[Relation, ...]:
    return tuple(Relation(p, e, dt, claimed) for p, e in zip(printed, exact, strict=True))


sp.factor(lag.coefficient)

# %% [markdown]
# ## The finite rotation
#
# $dR$ is the exponential of $\Delta t\,\Omega_\times$: the matrix $E(\varphi)$ with $E' = n_\times E$, $E(0) = 1$ at
# $\varphi = \Omega\Delta t$. As $n_\times^3 = -n_\times$, its power series closes:
# $E = 1 + \sin\varphi\,n_\times + (1 - \cos\varphi)\,n_\times^2$.

# %%
w = sp.Symbol("Omega", positive=True)
n = axis(*sp.symbols("alpha beta", real=True))
N = cross(n)
angle = w * dt
exact_dR = sp.eye(3) + sp.sin(angle) * N + (1 - sp.cos(angle)) * N**2
assert same(N**3, -N)
assert same(exact_dR.diff(dt), w * N * exact_dR)
assert same(exact_dR.subs(dt, 0), sp.eye(3))
assert same(exact_dR * exact_dR.T, sp.eye(3))
X_r = vector("X_r")
vertex_rate = (exact_dR * X_r).diff(dt).subs(dt, 0)

in_sine = sp.Symbol("Omega_plain", real=True)
P = n * n.T
printed_dR = P + sp.cos(w * dt) * (sp.eye(3) - P) + sp.sin(dt * in_sine) * cross(n)

squared = Omega.dot(Omega)
projector = sp.eye(3) + cross(Omega) ** 2 / squared  # keeps what lies along Omega, takes away what cross(Omega) turns
assert same(projector**2, projector)
assert same(projector * Omega, Omega)
paper_spin = {Omega[0]: 0, Omega[1]: 0, Omega[2]: 10}
too_large = (Omega * Omega.T).subs(paper_spin)[2, 2] / projector.subs(paper_spin)[2, 2]
first_order = sp.eye(3) + dt * cross(Omega)
stretch = sp.expand((first_order.T * first_order).subs(paper_spin)[0, 0])
stretch

# %% [markdown]
# ## The inertia of the turned body, and rows
#
# $I(t)^{-1} = R I_0^{-1}R^T$ with $R$ from vertex update. A row is the transpose of a column and $(AB)' = B'A'$.

# %%
turn_a, turn_b, turn_c = sp.symbols("phi theta psi", real=True)
R = sp.rot_axis3(turn_a).T * sp.rot_axis1(turn_b).T * sp.rot_axis3(turn_c).T
stored = sp.diag(*(1 / sp.Symbol(f"I_{i}", positive=True) for i in "xyz"))  # I_0^{-1}, what the program keeps as I
Omega_of_L = R * stored * R.T * L
assert same(R * tensor * R.T * (R * inverse * R.T), sp.eye(3))
row = L.T
transposed_right = same((R.T * stored * R * L).T, row * R.T * stored * R)
vertex_rows_right = same((exact_dR * F).T, F.T * exact_dR.T)
assert transposed_right
assert vertex_rows_right
isotropic = sp.eye(3) / I_x
assert same(R * isotropic * R.T, R.T * isotropic * R)

# %% [markdown]
# ## The link
#
# A spring of rest length zero has the energy $\frac S2|X_1 - X_2|^2$; a damper along it loses
# $D\dot s^2$, half of which is Rayleigh's function. Both give the forces on either vertex.

# %%
S, D, s = sp.symbols("S D s", positive=True)
e_hat = axis(*sp.symbols("mu nu", real=True))
X1, X2, U1, U2 = map(vector, ("X_1", "X_2", "U_1", "U_2"))
at_distance = dict(zip(X1, X2 + s * e_hat, strict=True))
stored_energy = S / 2 * (X1 - X2).dot(X1 - X2)
rayleigh = D / 2 * (U1 - U2).dot(e_hat) ** 2


def force_on(X: sp.Matrix, U: sp.Matrix) -> sp.Matrix:
    return sp.Matrix(
        [-sp.diff(stored_energy, x).subs(at_distance) - sp.diff(rayleigh, u) for x, u in zip(X, U, strict=True)]
    )


on_1, on_2 = force_on(X1, U1), force_on(X2, U2)
printed_size = S * s + D * (U1 - U2).dot(e_hat)
corrected_F12 = -(S * s + D * (U1 - U2).dot(e_hat)) * e_hat
is_tension = decide_zero(printed_size + on_1.dot(e_hat)).answer == "zero"
assert is_tension
energy_rate = sum(sp.diff(stored_energy, x) * u for x, u in zip((*X1, *X2), (*U1, *U2), strict=True)).subs(at_distance)
lost = on_1.dot(U1) + on_2.dot(U2) + energy_rate
assert decide_zero(lost + D * (U1 - U2).dot(e_hat) ** 2).answer == "zero"
# The unit vector read as pointing from 1 to 2, and the force along it: what the damper then does.
damper_other_way = D * (U1 - U2).dot(-e_hat) * -e_hat
gained = damper_other_way.dot(U1) - damper_other_way.dot(U2)
head_on = {**dict.fromkeys((*U1, *U2), 0), U1[2]: 1, **dict.fromkeys(e_hat.free_symbols, 0)}

# %% [markdown]
# ## What the paper prints

# %%
statements = [
    stated(
        "3.13",
        (
            *through(L + tau * dt, exact_L, 1),
            *through(U + F * dt / M, exact_U, 1),
            *through(printed_Omega, exact_Omega, 1),
            *through(X_cm + U * dt, exact_X, 1),
        ),
        given={I_y: I_x, I_z: I_x},
        condition="equal inertias, as in the paper's runs",
        depends_on=("3.07", "3.08", "3.12"),
        evidence=(
            "Omega is computed with the tensor of the old orientation. For unequal inertias it is off at order "
            f"{lag.order} in the step, its x component by {sp.factor(lag.coefficient)}; as L and R are what is carried "
            "on, the step stays a first-order method.",
            f"X_cm with the old or with the new U: both first differ at order {by_old.order}.",
        ),
    ),
    stated(
        "3.14",
        chain(vertex_rate, X_r.cross(w * n)),
        wrong="The two factors of the cross product have changed places.",
        quantities=(r"\dot{\vec X_r} = \vec\Omega\times\vec X_r",),
        correction=chain(vertex_rate, (w * n).cross(X_r)),
        depends_on=("3.09",),
        evidence=(
            "The sign is that of 3.09 turned round; rows instead of columns do not change it. The next sentence, "
            "(1 + dt Omega_x) X_r, and 3.15 have the right one. That sentence also holds: 1 + dt Omega_x is not a "
            f"rotation, it stretches by the square root of {stretch} across a spin of 10.",
        ),
    ),
    stated(
        "3.15",
        chain(exact_dR, printed_dR),
        given={in_sine: w},
        condition="the bars in the sine belong to Omega, not to the step: sin(|Omega| dt)",
        depends_on=("3.14", "3.16"),
        evidence=(
            "As printed the sine is taken of a vector. P is read as the projector on Omega (see 3.16). "
            "The matrix is the exponential of dt Omega_x: it solves dR' = Omega_x dR from 1.",
        ),
    ),
    stated(
        "3.16",
        chain(projector, Omega * Omega.T),
        wrong="The projection is not divided by |Omega|², and for a column the product is a number.",
        quantities=(r"P = \Omega\,\Omega^T/|\Omega|^2",),
        correction=chain(projector, Omega * Omega.T / Omega.dot(Omega)),
        evidence=(
            "For a column Omega^T Omega is the number |Omega|^2; for a row, as the program stores it, the outer "
            f"product without its norm: {too_large} times too large at the paper's spin. The paper's remark on NaN "
            "shows that the program divides by |Omega|^2.",
        ),
    ),
    stated(
        "3.17",
        chain(Omega_of_L, R.T * stored * R * L),
        wrong="R and its transpose have changed places, as in 3.12.",
        quantities=(r"\Omega = R I_0^{-1} R^T L",),
        correction=chain(Omega_of_L, R * stored * R.T * L),
        depends_on=("3.12",),
        evidence=("It follows from 3.12 as printed and falls with it; with equal inertias the two agree.",),
    ),
    stated(
        "3.18",
        chain(Omega_of_L.T, (R.T * stored * R * L).T, L.T * R.T * stored * R, row * R.T * stored * R),
        wrong="R and its transpose have changed places, as in 3.12.",
        quantities=(r"O = L' R I_0^{-1} R'",),
        correction=chain(Omega_of_L.T, row * R * stored * R.T),
        depends_on=("3.17",),
        evidence=(
            "The transposition itself is right, with I the stored inverse of the symmetric I_0, and so is X_r*dR'; "
            "what is transposed is 3.17.",
        ),
    ),
    stated(
        "3.19",
        chain(on_1.dot(e_hat), printed_size),
        wrong="A number stands for a vector: the direction of the link is missing.",
        quantities=(
            r"\vec F_{12} = -\bigl(S s + D(\vec U_1 - \vec U_2)\cdot\hat e\bigr)\hat e,\quad s\,\hat e = \vec X_1 - \vec X_2",
        ),
        correction=chain(on_1, corrected_F12),
        evidence=(
            "The right side is a number, the left a vector. The number is the tension of the link, S s + D s', if e_21 "
            "points from 2 to 1; the force on vertex 1 is the tension along -e_21. With e_21 from 1 to 2 the "
            f"damper would feed the link: {gained.subs(head_on)} W to a link that opens at 1 m/s.",
            "With the force corrected the link's energy changes by -D ((U_1 - U_2).e)^2, never upwards. The direction "
            "is undefined at s = 0. The sentence before it calls S the damping and D the spring constant: exchanged.",
        ),
        steps=("spring energy S/2 |X_1 - X_2|^2", "Rayleigh's function D/2 (s')^2, s' = (U_1 - U_2).e"),
    ),
    stated("3.20", chain(on_2, -corrected_F12), depends_on=("3.19",)),
]
Judged(statements)
