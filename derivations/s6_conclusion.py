# %% [markdown]
# # The conclusion (6.01, 6.02)
#
# **Objective.** Count the degrees of freedom and the modes of the pair with opposite spins, and hold the concluding
# rate against the pair's.
#
# **Assumptions.** No gravity, ideal joints, any bar; small motion for the modes.
#
# **Notation.** $X = x_1 = x_2$ of the linear pair, $D = y_1 - y_2$; $G_1 = -G_2 = G$; $a \pm b$ as in the glossary.

# %%
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.mechanics import degrees_of_freedom
from lagrotor.pair.lagrangians import INERTIAS, J_OF, axes_pair, pair_with_bar
from lagrotor.pair.symbols import AXES, G_1, G_2, I1, I3, PAIR, ROTOR, G, J, K, M, R, a, b, ell, k, m, omega, r0, sigma
from lagrotor.paper.ledger import Relation
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Formula, Judged
from lagrotor.theory.natural_frequency import linear_pair
from lagrotor.theory.paired_precession.closed_forms import paired_frequency
from lagrotor.theory.single_rotor import free_precession_rate

theta = ROTOR.q[0]
opposite = {G_1: G, G_2: -G}
in_bar = {name: INERTIAS[name].subs(J, J_OF) for name in (a, b)}

# %% [markdown]
# ## Degrees of freedom
#
# Coordinates less the rank of the constraints: with the spins in Euler angles, without them on two unit spheres.

# %%
angles = [sp.Rational(1, 3), sp.Rational(2, 5), 0, sp.Rational(1, 4), sp.Rational(-3, 7), 0]
with_spins = degrees_of_freedom(pair_with_bar(), {**dict(zip(PAIR.q, angles, strict=True)), a: 1, b: 0, I3: 1, k: 1})
upright = {**dict(zip(AXES.q, (0, 0, 1, 0, 0, 1), strict=True)), k: 1, a: 1, b: 0}
without_spins = degrees_of_freedom(axes_pair(), upright)
{"with the spins": with_spins, "without": without_spins}

# %% [markdown]
# ## Modes
#
# The characteristic polynomial has one pair $\pm i\Omega_0$ and four zeros. As nothing pulls the pair upright, every
# position at rest is an equilibrium: three eigenvectors belong to zero, in $(y_1, X, y_2)$ and its rates. One of them,
# the turning $y_1 = y_2$, begins a chain of two: it can go on at a constant rate. This is toppling. The other two are
# displacements that stay, in $X$ and in $D$: the centre of the paired precession.

# %%
pair = linear_pair()
s = sp.Symbol("s")
characteristic = sp.factor(pair.characteristic(s).subs(opposite))
polynomial = sp.Poly(characteristic, s)
zeros = min(power for (power,) in polynomial.monoms())
oscillations = (polynomial.degree() - zeros) // 2
gyroscopic = pair.gyroscopic.subs(opposite)
companion = sp.BlockMatrix(
    [
        [sp.zeros(3, 3), sp.eye(3)],
        [-pair.mass.inv(method="ADJ") * pair.stiffness, -pair.mass.inv(method="ADJ") * gyroscopic],
    ]
).as_explicit()
at_rest = 6 - companion.rank()
chains = 6 - (companion**2).rank() - at_rest
assert zeros == at_rest + chains
growing = gyroscopic.nullspace()
toppling = pair.basis * growing[0]
assert len(growing) == chains
assert toppling == sp.Matrix([0, 1, 0, 0, 1, 0])
topplings, centres = chains, (zeros - 2 * chains) // 2
modes = oscillations + topplings + centres
characteristic

# %% [markdown]
# The centre: two quantities that the linear pair keeps. Both are zero for a precession about the upright position.

# %%
first_v, X_v, second_v, first, X, second = sp.symbols("y_1_dot X_dot y_2_dot y_1 X y_2", real=True)
velocity = sp.Matrix([first_v, X_v, second_v])
acceleration = -pair.mass.inv(method="ADJ") * gyroscopic * velocity
kept_D = first - second + 2 * (a + b) * X_v / G
kept_X = X - (a - b) * (first_v - second_v) / (2 * G)


def drift(quantity: sp.Expr) -> sp.Expr:
    at = ((first, first_v), (X, X_v), (second, second_v))
    moved = sum(quantity.diff(place) * speed for place, speed in at)
    return moved + sum(quantity.diff(speed) * rate for speed, rate in zip(velocity, acceleration, strict=True))


centre_is_kept = {name: decide_zero(drift(e)).answer for name, e in (("X", kept_X), ("D", kept_D))}
assert set(centre_is_kept.values()) == {"zero"}
Formula(sp.Matrix([kept_X, kept_D]))

# %% [markdown]
# ## The rate
#
# Equal spins, parallel axes: one rotor with $a + b$ for $J$. Opposite spins: the linear rate and the series of the
# paired precession in the amplitude (5.27).

# %%
equal = free_precession_rate().expressions[0].subs(J, a + b).subs(in_bar).subs(G, I3 * omega)
squared = sp.factor(polynomial.coeff_monomial(s**4) / polynomial.coeff_monomial(s**6))
opposite_squared = squared.subs(in_bar).subs(G, I3 * omega)
ratio = paired_frequency(3).expressions[0]
curvature = sp.factor(sp.Poly(ratio, r0).coeff_monomial(r0**2))

printed_rate = sp.Rational(7125, 10000) * omega * I3 / (sp.cos(theta) * (I1 + R**2 * M / 4))
whole, twisting = I1 + M * R**2 / 4 + m * R**2 / 2, I1 + M * R**2 / 4 + 2 * K * R**2 / ell**2

statements = [
    stated(
        "6.01",
        (
            Relation(sp.Integer(5), sp.Integer(with_spins)),
            Relation(sp.Integer(5 - 2), sp.Integer(without_spins)),
            Relation(sp.Integer(2), sp.Integer(oscillations)),
        ),
        wrong="One mode oscillates, not two: toppling is a steady turning, and the third freedom is where the centre lies.",
        quantities=(
            r"\text{freedoms with the spins}",
            r"\text{without}",
            r"\text{oscillations}",
            r"\det(s^2 M + s C)",
        ),
        correction=(
            Relation(sp.Integer(5), sp.Integer(with_spins)),
            Relation(sp.Integer(3), sp.Integer(without_spins)),
            Relation(sp.Integer(1), sp.Integer(oscillations)),
            Relation(2 * (a + b) * s**4 * ((a**2 - b**2) * s**2 + G**2), characteristic),
        ),
        depends_on=("5.09",),
        evidence=(
            f"5 - 2 = 3 is right: {with_spins} with the spins, {without_spins} without (rank of the constraints).",
            f"Of the two modes printed {oscillations} oscillates; with the third freedom there are {modes} "
            f"motions. det(s² M + s C) = "
            f"{characteristic}: s² = -Omega_0² is the paired precession; of the {zeros} zero roots two are "
            f"toppling, y_1 = y_2 growing at a constant rate ({topplings} chain of two), and two the centre of the "
            "precession, a displacement in X and one in y_1 - y_2 that stay where a shock leaves them.",
            f"The linear pair keeps the centre: {kept_X} and {kept_D} are constant (decided).",
            "Small toppling is no oscillation: it has no restoring force, and comes round only as a full turn.",
        ),
    ),
    stated(
        "6.02",
        (
            Relation(printed_rate, equal),
            Relation(printed_rate**2, opposite_squared * ratio.subs(r0, sp.sin(theta)) ** 2),
        ),
        wrong="The constant belongs to one bar and to equal spins; opposite spins do not go as 1/cos theta.",
        quantities=(
            r"\dot\phi\text{ (equal spins)}",
            r"\Omega_0^2\text{ (opposite spins)}",
            r"\Omega/\Omega_0\text{ (opposite spins)}",
        ),
        correction=(
            Relation(omega * I3 / (sp.cos(theta) * whole), equal),
            Relation(omega**2 * I3**2 / (whole * twisting), opposite_squared),
            Relation(1 - r0**2 * sigma * (k**2 * sigma - 3 * k**2 + 3) / (4 * k**2), ratio, r0, 3),
        ),
        depends_on=("5.27", "5.28"),
        evidence=(
            f"Equal spins: {equal}, exact for parallel axes. Opposite spins: Omega_0² = {opposite_squared}, "
            f"times (1 + ({curvature}) r_0²)² at amplitude r_0: not 1/cos theta, and not the same constant.",
        ),
    ),
]
Judged(statements)
