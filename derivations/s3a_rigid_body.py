# %% [markdown]
# # Particles and rigid bodies (3.01 to 3.12)
#
# **Objective.** The mechanics behind the paper's simulator, from Newton's law for particles: centre of mass, angular
# momentum, torque, the rigid velocity field, the inertia tensor and how it turns.
#
# **Assumptions.** Three particles with any masses, places and velocities: every sum in these equations runs over single
# particles or pairs, so three show what any number does. Internal forces obey $\vec f_{ij} = -\vec f_{ji}$.
#
# **Notation.** $\vec d_i = \vec X_i - \vec X_{cm}$, $\mathbb 1(\vec d)^2$ read as $|\vec d|^2\,\mathbb 1$; $R$ turns
# the body from its first orientation, $\vec d = R\,\vec d_0$, as in the paper's update $R(t + \Delta t) = dR\,R(t)$.

# %%
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.mechanics import total_derivative
from lagrotor.pair.symbols import ROTOR
from lagrotor.paper.ledger import chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Judged


def vector(name: str) -> sp.Matrix:
    return sp.Matrix(sp.symbols(f"{name}_x {name}_y {name}_z", real=True))


def summed(terms) -> sp.Matrix:
    return sum(terms, sp.zeros(3, 1))


m1, m2, m3 = masses = sp.symbols("m_1 m_2 m_3", positive=True)
X1, X2, X3 = places = [vector(f"X_{i}") for i in (1, 2, 3)]
U1, U2, U3 = velocities = [vector(f"U_{i}") for i in (1, 2, 3)]
F1, F2, F3 = external = [vector(f"F_{i}") for i in (1, 2, 3)]
everything = list(zip(masses, places, velocities, external, strict=True))

# %% [markdown]
# ## Newton's law, particle by particle
#
# Any internal force is a part along the line between its two particles and a rest:
# $\vec f_{ij} = c_{ij}(\vec X_i - \vec X_j) + s\,\vec n_{ij}$, with $s = 0$ for central forces.

# %%
s = sp.Symbol("s", real=True)
internal = [sp.zeros(3, 1) for _ in places]
for i, j in ((0, 1), (0, 2), (1, 2)):
    f_ij = sp.Symbol(f"c_{i + 1}{j + 1}", real=True) * (places[i] - places[j]) + s * vector(f"n_{i + 1}{j + 1}")
    internal[i] += f_ij
    internal[j] -= f_ij
accelerations = [(F + f) / m for m, F, f in zip(masses, external, internal, strict=True)]
flow = [(x, u) for X, U in zip(places, velocities, strict=True) for x, u in zip(X, U, strict=True)]
flow += [(u, a) for U, acc in zip(velocities, accelerations, strict=True) for u, a in zip(U, acc, strict=True)]


def rate(quantity: sp.Matrix) -> sp.Matrix:
    """d/dt along the motion of the particles."""
    return quantity.applyfunc(lambda e: sum(sp.diff(e, x) * v for x, v in flow))


common, centre, turn_about = vector("U"), vector("X"), vector("n")
moving = sum(m * common.dot(common) / 2 for m in masses)
total_mass = sp.diff(moving, common[0], 2)  # what answers to a velocity common to all
balanced = sp.solve(list(summed(m * (X - centre) for m, X, _, _ in everything)), list(centre), dict=True)[0]
X_cm = centre.subs(balanced)
U_cm = rate(X_cm)
total_force = rate(summed(m * U for m, _, U, _ in everything))
L = summed(m * (X - X_cm).cross(U - U_cm) for m, X, U, _ in everything)  # about the moving centre
work = sum(F.dot(turn_about.cross(X - X_cm)) for _, X, _, F in everything)  # in a small turn n about the centre
torque = sp.Matrix([sp.diff(work, n) for n in turn_about])

printed_M = m1 + m2 + m3
printed_X_cm = (m1 * X1 + m2 * X2 + m3 * X3) / printed_M
printed_L = m1 * (X1 - X_cm).cross(U1) + m2 * (X2 - X_cm).cross(U2) + m3 * (X3 - X_cm).cross(U3)
printed_tau = (X1 - X_cm).cross(F1) + (X2 - X_cm).cross(F2) + (X3 - X_cm).cross(F3)

# Two particles a unit apart along x push each other across that line; no force from outside.
spinning_up = rate(L)
pair = dict.fromkeys(spinning_up.free_symbols | torque.free_symbols, sp.S.Zero)
pair |= dict.fromkeys((m1, m2, m3, X1[0], s, sp.Symbol("n_12_y", real=True)), sp.S.One)
spin_up, outside = spinning_up.subs(pair), torque.subs(pair)
assert spin_up != outside == sp.zeros(3, 1)
spin_up

# %% [markdown]
# ## The rigid velocity field
#
# $\vec X_i = \vec X_{cm} + Q\vec d_0$ with a rotation $Q$; $Q'Q^T$ is skew and its axial vector is $\vec\Omega$.


# %%
def along_turn(matrix: sp.Matrix) -> sp.Matrix:
    return matrix.applyfunc(lambda e: total_derivative(e, ROTOR))


def axial(skew: sp.Matrix) -> sp.Matrix:
    return sp.Matrix([skew[2, 1], skew[0, 2], skew[1, 0]])


phi, theta, psi = ROTOR.q[1], ROTOR.q[0], ROTOR.q[2]
Q = sp.rot_axis3(phi).T * sp.rot_axis1(theta).T * sp.rot_axis3(psi).T
assert decide_equal(Q * Q.T, sp.eye(3)).answer == "zero"
skew = along_turn(Q) * Q.T
assert decide_equal(skew, -skew.T).answer == "zero"
Omega_turn, d0 = axial(skew), vector("d")
field = common + along_turn(Q) * d0

# %% [markdown]
# ## The inertia tensor
#
# A rigid body is known to its kinetic energy through its moments alone; the angular momentum is taken from the
# particles, the tensor from the energy of turning.

# %%
Omega = vector("Omega")
arms = [X - X_cm for X in places]
rigid_L = summed(m * d.cross(common + Omega.cross(d)) for m, d in zip(masses, arms, strict=True))
turning = sum(m * Omega.cross(d).dot(Omega.cross(d)) / 2 for m, d in zip(masses, arms, strict=True))
inertia = sp.hessian(turning, list(Omega))


def spread(d: sp.Matrix) -> sp.Matrix:
    return sp.eye(3) * d.dot(d) - d * d.T


printed_I = m1 * spread(X1 - printed_X_cm) + m2 * spread(X2 - printed_X_cm) + m3 * spread(X3 - printed_X_cm)

# A body in its principal axes; one of its particles shows how each turns.
I_0 = m1 * spread(d0)
I_turned = m1 * spread(Q * d0)
unequal = sp.diag(1, 2, 3)
quarter = {phi: sp.pi / 2, theta: sp.pi / 2, psi: 0}
right, wrong = (e.subs(quarter) for e in (Q * unequal * Q.T, Q.T * unequal * Q))
isotropic = sp.Symbol("I", positive=True) * sp.eye(3)
assert decide_equal(Q * isotropic * Q.T, Q.T * isotropic * Q).answer == "zero"
assert right != wrong
sp.Tuple(right, wrong)

# %% [markdown]
# ## What the paper prints

# %%
statements = [
    stated("3.01", chain(total_mass, printed_M), definition=True),
    stated(
        "3.02",
        chain(total_force, F1 + F2 + F3),
        definition=True,
        evidence=("The internal forces cancel in pairs: the sum is the rate of the whole momentum.",),
    ),
    stated("3.03", chain(X_cm, printed_X_cm), definition=True, depends_on=("3.01",)),
    stated(
        "3.04",
        chain(U_cm, U1 + U2 + U3),
        wrong="The weights m_i/M of the mean are missing.",
        quantities=(r"\vec U_{cm} = \frac1M \sum_i m_i \vec U_i",),
        correction=chain(U_cm, (m1 * U1 + m2 * U2 + m3 * U3) / (m1 + m2 + m3)),
        depends_on=("3.03",),
        evidence=(
            "The weights m_i/M are missing: the mean of velocities is printed as their sum. "
            f"A body of three equal particles in a common motion would move {sp.Integer(len(places))} times too fast.",
        ),
    ),
    stated(
        "3.05",
        chain(L, printed_L),
        depends_on=("3.03",),
        evidence=("The velocity of the centre drops out of U_i, because the sum of m_i (X_i - X_cm) is zero.",),
    ),
    stated(
        "3.06",
        chain(torque, printed_tau),
        definition=True,
        depends_on=("3.03",),
        evidence=("It is what the external forces do in a small turn about the centre, by the angle of the turn.",),
    ),
    stated("3.07", chain(total_mass * rate(U_cm), F1 + F2 + F3), depends_on=("3.01", "3.02", "3.03")),
    stated(
        "3.08",
        chain(spinning_up, printed_tau),
        given={s: 0},
        condition="f_ij along X_i - X_j; the paper asks for f_ij = -f_ji only",
        depends_on=("3.05", "3.06"),
        evidence=(
            "Two particles 1 m apart that push each other with 1 N across the line between them obey f_ij = -f_ji and "
            f"turn by themselves: dL/dt = {tuple(spin_up)} N m at a torque of {tuple(outside)}.",
        ),
    ),
    stated(
        "3.09",
        chain(field, common + Omega_turn.cross(Q * d0)),
        steps=("X_i = X_cm + Q d_0", "Omega is the axial vector of Q' Q^T"),
    ),
    stated(
        "3.10",
        chain(rigid_L, printed_I * Omega),
        depends_on=("3.05", "3.09"),
        evidence=("1(X)^2 is read as |X|^2 times the unit matrix, (X)(X)^T as the outer product.",),
    ),
    stated("3.11", chain(inertia, printed_I), definition=True, depends_on=("3.10",)),
    stated(
        "3.12",
        chain(I_turned, Q.adjugate() * I_0 * Q, Q.T * I_0 * Q),
        wrong="R and its transpose have changed places.",
        quantities=(r"I(t) = R I_0 R^T",),
        correction=chain(I_turned, Q * I_0 * Q.T),
        depends_on=("3.11",),
        evidence=(
            "R and R^T have changed places: with X_r(t) = R X_r(0), as the update X_r -> dR X_r, R -> dR R demands, "
            "the tensor is R I_0 R^T. The listing X*R' + X_cm says the same of R.",
            f"Principal inertias (1, 2, 3), a quarter turn about x and then one about z: along the diagonal "
            f"{tuple(right.diagonal())}, as printed {tuple(wrong.diagonal())}. With equal inertias, as in all the "
            "paper's runs, both are the same: no run of the paper can tell.",
        ),
    ),
]
Judged(statements)
