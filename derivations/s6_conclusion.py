# %% [markdown]
# # The conclusion (6.01, 6.02)
#
# **Objective.** The degrees of freedom and the modes of the pair with opposite spins, and the concluding rate against the
# pair's. Figure 28 shows the oscillation for two bars.
#
# **Assumptions.** No gravity, ideal joints, any bar, any spins; the modes are those of small motion about the upright rest
# state.
#
# **Notation.** $x$ the common component of the axes along the joint line, $y_1$, $y_2$ those across it; $G_i = I_3\omega_i$;
# $a \pm b$ and $\sigma = (a+b)/(a-b)$ as in 5.3.

# %%
import sympy as sp

from lagrotor import paired_frequency
from lagrotor.mechanics import degrees_of_freedom
from lagrotor.pair import axes_pair, pair_with_bar
from lagrotor.pair.notation import (
    AXES,
    G_1,
    G_2,
    I1,
    I3,
    PAIR,
    ROTOR,
    G,
    J,
    K,
    M,
    R,
    a,
    b,
    ell,
    k,
    m,
    omega,
    q,
    r0,
    sigma,
)
from lagrotor.paper import Formula, Remark, Series, prove, verdict
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.premises import HEAVY_BAR, PAPERS_ROTOR, in_parameters
from lagrotor.paper.rotor_pair.runs import OPPOSITE, listed_rates
from lagrotor.theory import linear_pair

# %% [markdown]
# ## Degrees of freedom
#
# The number of degrees of freedom is the number of coordinates minus the rank of the constraints. With the spins the
# coordinates are Euler angles, without them unit vectors on two spheres.

# %%
angles = [sp.Rational(1, 3), sp.Rational(2, 5), 0, sp.Rational(1, 4), sp.Rational(-3, 7), 0]
with_spins = degrees_of_freedom(pair_with_bar(), {**dict(zip(PAIR.q, angles, strict=True)), a: 1, b: 0, I3: 1, k: 1})
upright = {**dict(zip(AXES.q, (0, 0, 1, 0, 0, 1), strict=True)), k: 1, a: 1, b: 0}
without_spins = degrees_of_freedom(axes_pair(), upright)
f"The pair has {with_spins} degrees of freedom with the spins, and {without_spins} without them."

# %% [markdown]
# ## Small motion
#
# To first order the bar leaves the coordinates $(y_1, x, y_2)$. Nothing pulls the pair upright; the spins couple the three:
# $M\ddot q + C\dot q = 0$ with

# %%
pair = linear_pair()
prove(pair.stiffness, sp.zeros(3, 3), "the stiffness")

# %%
prove(pair.mass, sp.Matrix([[a, 0, b], [0, 2 * (a + b), 0], [b, 0, a]]), "the mass matrix M")

# %%
prove(pair.gyroscopic, sp.Matrix([[0, -G_1, 0], [G_1, 0, G_2], [0, -G_2, 0]]), "the gyroscopic matrix C")

# %% [markdown]
# The characteristic polynomial has one pair of imaginary roots and four zeros, for any spins:

# %%
s = sp.Symbol("s")
characteristic = sp.Poly(pair.characteristic(s), s)
oscillating = 2 * (a + b) * (a**2 - b**2) * s**2 + a * (G_1**2 + G_2**2) - 2 * b * G_1 * G_2
prove(characteristic.as_expr(), s**4 * oscillating, "the characteristic polynomial det(s²M + sC)")

# %% [markdown]
# Every position at rest is an equilibrium: three of the zeros. The fourth belongs to a motion with $C\dot q = 0$, which goes on
# at a constant velocity. So of the three degrees of freedom one oscillates, one turns steadily, and one rests where it is put.

# %%
steady = pair.gyroscopic.nullspace()
zeros = min(power for (power,) in characteristic.monoms())
oscillations, turnings = (characteristic.degree() - zeros) // 2, len(steady)
resting = without_spins - oscillations - turnings
prove(zeros, without_spins + turnings, "the number of zero roots")

# %%
f"Of the {without_spins} degrees of freedom {oscillations} oscillates, {turnings} turns steadily and {resting} is at rest."

# %% [markdown]
# The steady motion is across the joint line. For opposite spins it is $y_1 = y_2$: the toppling.

# %%
x_1, y_1, _, x_2, y_2, _ = pair.basis * steady[0]
toppling = sp.Matrix([x_2 / y_1, y_2 / y_1])
prove(toppling, sp.Matrix([0, -G_1 / G_2]), "the direction of the steady turning")

# %% [markdown]
# In the oscillation the first and the third equation give $(\dot y_1, \dot y_2)$ from $x$, by $M$ and $C$ without their row and
# column of $x$. For opposite spins $y_1 = -y_2$: the paired precession.

# %%
across = pair.mass.extract([0, 2], [0, 2])
y_1_v, y_2_v = across.LUsolve(-pair.gyroscopic.extract([0, 2], [1]))
x_1, _, _, x_2, _, _ = pair.basis[:, 1]
precession = sp.Matrix([x_2 / x_1, sp.cancel(y_2_v / y_1_v)])
prove(precession, sp.Matrix([1, (a * G_2 - b * G_1) / (a * G_1 - b * G_2)]), "the direction of the oscillation")

# %%
verdict(
    "6.01",
    {
        r"\text{degrees of freedom}": with_spins,
        r"\text{degrees of freedom without the spins}": without_spins,
        r"\text{modes of oscillation}": oscillations,
        r"(x_2/y_1, y_2/y_1)\text{ of the toppling}": toppling,
        r"(x_2/x_1, y_2/y_1)\text{ of the precession}": precession,
    },
    correction={r"\text{modes of oscillation}": sp.Integer(oscillations)},
    wrong="Only the paired precession oscillates; toppling is a steady turning.",
    form={
        r"(x_2/y_1, y_2/y_1)\text{ of the toppling}": form("column(0, -(G_1/G_2))"),
        r"(x_2/x_1, y_2/y_1)\text{ of the precession}": form("column(1, (a*G_2 - b*G_1)/(a*G_1 - b*G_2))"),
    },
    uses=["5.09"],
    evidence=[
        f"To first order the {without_spins} degrees of freedom without the spins are {oscillations} oscillation, {turnings} "
        f"steady turning and {resting} constant displacement. The paper's conclusion calls both of its modes oscillations. "
        "Toppling has no restoring force and repeats only after a full turn, so it is not one. Section 5.2 says only that the "
        "turning can be thought of as a mode; with this meaning there are two modes (claim C24).",
    ],
)

# %% [markdown]
# ## The third degree of freedom
#
# For opposite spins, $G_1 = -G_2 = G$, the linearised equations conserve two quantities. They say where the centre of the
# precession rests; both are zero for one about the upright position.

# %%
first_v, x_v, second_v, first, x, second = sp.symbols("y_1_dot x_dot y_2_dot y_1 x y_2", real=True)
velocity = sp.Matrix([first_v, x_v, second_v])
acceleration = -pair.mass.LUsolve(pair.gyroscopic.subs({G_1: G, G_2: -G}) * velocity)
kept = sp.Matrix([x - (a - b) * (first_v - second_v) / (2 * G), first - second + 2 * (a + b) * x_v / G])
Formula(kept)

# %%
moved = kept.jacobian([first, x, second]) * velocity + kept.jacobian(velocity) * acceleration
prove(
    moved,
    sp.zeros(2, 1),
    "their rates along the linear motion",
    equations=(
        r"\frac{d}{dt}\Big(x - \frac{a - b}{2G}\,(\dot y_1 - \dot y_2)\Big) = 0"
        r",\qquad \frac{d}{dt}\Big(y_1 - y_2 + \frac{2(a + b)}{G}\,\dot x\Big) = 0"
    ),
)

# %%
Remark(
    "Where the third degree of freedom is",
    "After a shock the precession centre keeps its displacement in x and in y₁ − y₂. These are two constants of the linearised "
    "equations; together with the two of toppling they are the four zero roots.",
)

# %% [markdown]
# ## The rate
#
# Equal spins, parallel axes: one rotor with $a + b$ for $J$ (5.27). Opposite spins: the natural frequency, and the series of the
# paired precession in the amplitude, $r_0 = \sin\theta_0$. The average inclination is $\theta = q\,r_0$ (5.27).

# %%
theta = ROTOR.q[0]
with_mass, with_inertia = I1 + M * R**2 / 4 + m * R**2 / 2, I1 + M * R**2 / 4 + 2 * K * R**2 / ell**2
equal_rate = in_parameters(I3 * omega / (a + b))
opposite_rate = in_parameters(I3 * omega / sp.sqrt(a**2 - b**2))
prove(
    (equal_rate, opposite_rate**2),
    (omega * I3 / with_mass, omega**2 * I3**2 / (with_mass * with_inertia)),
    "the natural frequency of equal spins, and the square of that of opposite spins",
)

# %%
ratio = paired_frequency(3).expressions[0]
through_third = 1 - sigma * (k**2 * sigma - 3 * k**2 + 3) / (4 * k**2) * r0**2
prove(ratio, through_third, "the rate of the paired precession over the natural frequency, through the third order")

# %%
printed_rate = float(sp.Rational(7125, 10000) * PAPERS_ROTOR.on(in_parameters(I3 * omega / J)).subs(omega, OPPOSITE[0]))
at_theta = ratio.subs(r0, sp.sin(theta) / q).subs({k: ell / R, sigma: with_mass / with_inertia})
inertias = {"a": in_parameters(a), "b": in_parameters(b)}
cone_written = form("I_3*omega/((a + b)*cos(theta))", **inertias)
square_written = form("(I_3*omega)**2/((a + b)*(a - b))", **inertias)
opposite_written = form(
    "I_3*omega/sqrt(a**2 - b**2)*(1 - sigma*sin(theta)**2/(4*k**2*q**2)*(k**2*sigma - 3*k**2 + 3))",
    sigma=with_mass / with_inertia,
    k=ell / R,
    **inertias,
)
through_third_written = form("1 - sigma*(k**2*sigma - 3*k**2 + 3)/(4*k**2)*r_0**2")
verdict(
    "6.02",
    {
        r"\dot\phi\text{ (equal spins)}": equal_rate / sp.cos(theta),
        r"\dot\phi\text{ (opposite spins)}": Series(opposite_rate * at_theta, theta, 3),
        r"\Omega_0^2\text{ (opposite spins)}": opposite_rate**2,
        r"\Omega/\Omega_0\text{ (opposite spins, through }r_0^3)": Series(ratio, r0, 3),
    },
    premises=[PAPERS_ROTOR, HEAVY_BAR],
    correction={
        r"\dot\phi\text{ (equal spins)}": cone_written,
        r"\dot\phi\text{ (opposite spins)}": opposite_written,
        r"\Omega_0^2\text{ (opposite spins)}": square_written,
        r"\Omega/\Omega_0\text{ (opposite spins, through }r_0^3)": through_third_written,
    },
    form={
        r"\dot\phi\text{ (equal spins)}": cone_written,
        r"\dot\phi\text{ (opposite spins)}": opposite_written,
    },
    wrong="The constant holds for one bar and equal spins only; for opposite spins the rate is not proportional to 1/cos θ. "
    "θ is the average inclination, as printed. It is q r₀, with r₀ the sine of the inclination when the axes are parallel, and q "
    "the mean of √(cos² Φ + σ sin² Φ) over a turn. "
    f"For opposite spins of 10 rad/s the rate at small θ is {listed_rates(OPPOSITE)}; the print gives {printed_rate:g} rad/s.",
    uses=["5.27", "5.28"],
    evidence=["The line repeats 5.27 for both kinds of pair; the evidence of 5.27 applies to each of them."],
)
