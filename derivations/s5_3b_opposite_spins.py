# %% [markdown]
# # The pair with opposite spins, and one constant for both (5.26 to 5.28)
#
# **Objective.** The rate of the pair with opposite spins, how both rates depend on the inclination, and whether the paper's
# constant 0.7125 fits both kinds of pair.
#
# **Assumptions.** No gravity, ideal joints, equal rotors, any bar. Opposite spins: the symmetric periodic orbit.
#
# **Notation.** $J = I_1 + M R^2/4$; $a + b = J + m R^2/2$, $a - b = J + 2 K R^2/\ell^2$; $\sigma = (a+b)/(a-b)$,
# $k = \ell/R$; $\theta$ the average inclination, for equal spins to the angular momentum; $\theta_0$ the inclination when the
# axes are parallel, $r_0 = \sin\theta_0$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, natural_rate, paired_frequency, simulate
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order
from lagrotor.pair.notation import (
    G_1,
    G_2,
    I1,
    I3,
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
    omega_1,
    omega_2,
    q,
    r0,
    sigma,
)
from lagrotor.paper import Formula, Premise, Remark, Series, Table, prove, scientific, verdict
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.claims.natural_rates import coefficient
from lagrotor.paper.rotor_pair.premises import HEAVY_BAR, LIGHT_BAR_PREMISE, PAPERS_ROTOR, in_parameters
from lagrotor.paper.rotor_pair.runs import EQUAL, OPPOSITE, listed_rates
from lagrotor.theory.natural_frequency import natural_frequency

theta = ROTOR.q[0]
with_mass, with_inertia = I1 + M * R**2 / 4 + m * R**2 / 2, I1 + M * R**2 / 4 + 2 * K * R**2 / ell**2

# %% [markdown]
# ## The natural frequency
#
# The linearised equations have one oscillation, for any spins and any bar:

# %%
natural = natural_frequency().expressions[0]
any_spins = (a * (G_1**2 + G_2**2) - 2 * b * G_1 * G_2) / (2 * (a + b) * (a**2 - b**2))
prove(natural**2, any_spins, "the square of the natural frequency")

# %% [markdown]
# Opposite spins twist the bar, and its inertia $K$ matters as well as its mass:

# %%
opposite = G / sp.sqrt(a**2 - b**2)
prove(natural.subs({G_1: G, G_2: -G}) ** 2, opposite**2, "the square of the natural frequency, opposite spins")

# %%
opposite_rate = in_parameters(opposite.subs(G, I3 * omega))
prove(
    opposite_rate**2, omega**2 * I3**2 / (with_mass * with_inertia), "the same in the rotor's and the bar's parameters"
)

# %% [markdown]
# ## What the paper matches
#
# Its run has spins ±10; the bar of this run is not listed. The rates with the bars that the paper lists elsewhere, and with
# their masses and inertias mixed:

# %%
bars = {f"m = {mass:g}, K = {turn:g}": Link(1, mass, turn) for mass, turn in ((1, 1), (0.01, 0.1), (1, 0.1), (0.01, 1))}
rates = {name: natural_rate(Scene(spins=(10, -10), link=bar)) for name, bar in bars.items()}
Table("Natural rates, spins ±10", ("bar", "rate (rad/s)"), tuple((name, f"{rate:.4f}") for name, rate in rates.items()))

# %% [markdown]
# The product $10\cdot\frac45\cdot0.7125$ is 5.7, not 0.57. That is the rate of the paper's rotor on one curve of $(m, K)$:

# %%
product = 10 * sp.Rational(4, 5) * sp.Rational(7125, 10000)
own_rate = PAPERS_ROTOR.on(opposite_rate).subs(omega, 10)
(inertia_of_product,) = sp.solve(own_rate**2 - product**2, K, simplify=False)
Formula(sp.factor(inertia_of_product), "K")

# %%
inertias = {"a": in_parameters(a), "b": in_parameters(b)}
cone_written = form("I_3*omega/((a + b)*cos(theta))", **inertias)
square_written = form("(I_3*omega)**2/((a + b)*(a - b))", **inertias)
through_third_written = form("1 - sigma*(k**2*sigma - 3*k**2 + 3)/(4*k**2)*r_0**2")
of_spins = natural.subs({G_1: I3 * omega_1, G_2: I3 * omega_2})
eta = sp.Symbol("eta", real=True)
any_rate = form(
    "sqrt((a*(G_1**2 + G_2**2) - 2*b*G_1*G_2)/((a - b)*(a + b)**2))/sqrt(2)",
    G_1=I3 * omega_1,
    G_2=I3 * omega_2,
)
small_motion = Premise("the motion is so small that the rate does not depend on its amplitude", {eta: 0})
of_a_kilogram = float(inertia_of_product.subs(m, 1))
listed = ", ".join(f"{rate:.4f} rad/s for {name}" for name, rate in rates.items())
verdict(
    "5.26",
    {
        r"\dot\phi": of_spins * (1 + eta),
        r"\Omega_0^2\text{ (opposite spins)}": opposite_rate**2,
    },
    premises=[HEAVY_BAR, small_motion],
    correction={r"\Omega_0^2\text{ (opposite spins)}": square_written},
    wrong="The product is 5.7, not 0.57, and no bar listed in the paper has this rate. "
    f"The rate is {listed_rates(OPPOSITE)}.",
    uses=["5.25"],
    evidence=[
        f"The natural frequency is {listed}. Each of the last two bars has the mass of one listed bar and the inertia "
        "of the other.",
        f"With a bar of 1 kg the rate is {float(product)} rad/s for K = {of_a_kilogram:.4f} kg m².",
        "The constant of equal spins does not apply, because opposite spins twist the bar, so that its inertia matters.",
    ],
    form={r"\dot\phi": any_rate, r"\Omega_0^2\text{ (opposite spins)}": square_written},
)

# %% [markdown]
# ## The rate at an inclination
#
# Equal spins: one rotor with $a + b$ for $J$ (derived with 5.24), the factor $1/\cos\theta$ included.

# %%
equal_rate = in_parameters(I3 * omega / (a + b))
prove(equal_rate, omega * I3 / with_mass, "the natural frequency of equal spins")

# %% [markdown]
# It is exact: a cone on which both axes turn together, run on the exact pair with the bar of section 4.1.

# %%
tilt = 0.6
heavy = Link(mass=1, inertia=1)
turning = float(HEAVY_BAR.on(PAPERS_ROTOR.on(equal_rate)).subs(omega, 20)) / np.cos(tilt)
cone = Scene(
    spins=(20, 20),
    link=heavy,
    axes=((np.sin(tilt), 0, np.cos(tilt)),) * 2,
    rates=((0, turning * np.sin(tilt), 0),) * 2,
)
steady = simulate(cone, np.linspace(0, 4 * 2 * np.pi / turning, 41), "minimal", 1e-11)
apart = float(np.abs(steady.axes[0] - steady.axes[1]).max())
steady_rate = float((steady.azimuths[0, -1] - steady.azimuths[0, 0]) / steady.t[-1])
(
    f"The derived rate is {turning:.6f} rad/s. The exact pair turns at {steady_rate:.6f} rad/s, and its axes stay parallel "
    f"within {scientific(apart, 1)}."
)

# %% [markdown]
# Opposite spins: along the periodic orbit the rate changes by the square of the amplitude, and not as $1/\cos\theta$, which
# is $1 + r_0^2/2$.

# %%
ratio = paired_frequency(3).expressions[0]
through_third = 1 - sigma * (k**2 * sigma - 3 * k**2 + 3) / (4 * k**2) * r0**2
prove(ratio, through_third, "the rate of the periodic orbit over the natural frequency, through the third order")

# %% [markdown]
# Its sign turns at $\sigma = 3 - 3/k^2$; a massless bar ($\sigma = 1$) has to be longer than $\sqrt{3/2}\,R$ for the rate to
# rise.

# %%
curvature = sp.factor(sp.Poly(ratio, r0).coeff_monomial(r0**2))
(flip_sigma,) = sp.solve(sp.cancel(curvature / sigma), sigma, simplify=False)
flip_k = next(root for root in sp.solve(flip_sigma - 1, k, simplify=False) if root.is_positive)
prove((flip_sigma, flip_k), (3 - 3 / k**2, sp.sqrt(sp.Rational(3, 2))), "where the change of the rate turns its sign")

# %%
amplitudes = (0.02, 0.04)
slopes = []
for name, bar in {"m = K = 1, ℓ = R": heavy, "massless, ℓ = 2R": Link(length=2)}.items():
    scene = Scene(spins=(10, -10), link=bar)
    big, coupled = scene.inertias
    changes = [exact_orbit(scene, size).frequency / natural_rate(scene) - 1 for size in amplitudes]
    predicted = float(curvature.subs({sigma: (big + coupled) / (big - coupled), k: bar.length}))
    order = measured_order(amplitudes, np.abs(changes))
    slopes.append(
        f"{changes[0] / amplitudes[0] ** 2:+.4f} (derived {predicted:+.4f}) for {name}, with the measured exponent {order:.2f}"
    )
f"The relative change of the rate divided by r_0² is {'; it is '.join(slopes)}."

# %% [markdown]
# The print has the average inclination. To first order in $r_0$ the sines of both inclinations are $r_0 D$ with
# $D^2 = \cos^2\Phi + \sigma\sin^2\Phi$ (5.20), and the second order has opposite signs in the two. So the average over a turn
# and both axes is $\theta = q\,r_0 + O(r_0^3)$, with $q$ the mean of $D$ over a turn, a complete elliptic integral of the second
# kind:

# %%
mean_D = 2 / sp.pi * sp.elliptic_e(1 - sigma)
Formula(mean_D, "q")

# %%
in_average = sp.cancel(curvature) / mean_D**2
by_average = []
for bar in list(bars.values())[:3]:
    scene = Scene(spins=(10, -10), link=bar)
    big, coupled = scene.inertias
    put = {sigma: (big + coupled) / (big - coupled), k: 1}
    measured, _ = coefficient((10, -10), bar)
    by_average.append(
        f"{measured:+.4f} (derived {float(in_average.subs(put)):+.4f}; with θ₀ in place of θ it would be "
        f"{float(curvature.subs(put)):+.4f}) for m = {bar.mass:g}, K = {bar.inertia:g}"
    )
f"The relative change of the rate divided by θ² is {'; it is '.join(by_average)}."

# %%
at_theta = ratio.subs(r0, sp.sin(theta) / q).subs({k: ell / R, sigma: with_mass / with_inertia})
opposite_written = form(
    "I_3*omega/sqrt(a**2 - b**2)*(1 - sigma*sin(theta)**2/(4*k**2*q**2)*(k**2*sigma - 3*k**2 + 3))",
    sigma=with_mass / with_inertia,
    k=ell / R,
    **inertias,
)
average = (
    "θ is the average inclination, as printed. It is q r₀, with r₀ the sine of the inclination when the axes are parallel, and q "
    "the mean of √(cos² Φ + σ sin² Φ) over a turn."
)
own_sigma = PAPERS_ROTOR.on(with_mass / with_inertia)
own_shape = {sigma: HEAVY_BAR.on(own_sigma), k: 1}
own_mean, own_change = (float(e.subs(own_shape)) for e in (mean_D, sp.Rational(1, 2) - in_average))
own_change *= float(product / HEAVY_BAR.on(own_rate))
changing = " and ".join(
    f"{float(premise.on(own_rate)):.3f} (1 {'−' if change < 0 else '+'} {abs(change):.4f} θ²) rad/s with {name}"
    for name, premise in (("the bar of section 4.1", HEAVY_BAR), ("that of section 5.2.1", LIGHT_BAR_PREMISE))
    for change in [float(in_average.subs({sigma: premise.on(own_sigma), k: 1}))]
)
verdict(
    "5.27",
    {
        r"\dot\phi\text{ (equal spins)}": equal_rate / sp.cos(theta),
        r"\dot\phi\text{ (opposite spins)}": Series(opposite_rate * at_theta, theta, 3),
        r"\Omega/\Omega_0\text{ (opposite spins, through }r_0^3)": Series(ratio, r0, 3),
    },
    premises=[PAPERS_ROTOR, HEAVY_BAR],
    correction={
        r"\dot\phi\text{ (equal spins)}": cone_written,
        r"\dot\phi\text{ (opposite spins)}": opposite_written,
        r"\Omega/\Omega_0\text{ (opposite spins, through }r_0^3)": through_third_written,
    },
    wrong="The constant holds for one bar and equal spins only; for opposite spins the rate is not proportional to 1/cos θ. "
    f"{average} Through θ², with spins of ±10 rad/s, the rate is {changing}; the print gives "
    f"{float(product):g} (1 + 0.5 θ²) rad/s.",
    uses=["5.25", "5.26"],
    evidence=[
        f"Equal spins: on the exact pair at θ = {tilt} the axes differ by at most {apart:.0e} and turn at "
        f"{steady_rate:.6f} rad/s; the derived rate is {turning:.6f} rad/s.",
        f"Opposite spins: on exact orbits the relative change of the rate, divided by r₀², is {'; '.join(slopes)}. "
        "With 1/cos θ it "
        "would be +0.5.",
        "Opposite spins: on exact orbits of r₀ = 0.051 the relative change of the rate, divided by the square of the average "
        f"inclination θ, is {'; '.join(by_average)}.",
        f"With the bar of section 4.1 q is {own_mean:.4f}, and the printed rate divided by the derived one changes by "
        f"{own_change:.4f} θ².",
        "These numbers are for the symmetric orbit. After a shock along x from rest the centres of precession are displaced, and "
        "the rate increases with the shock (claim C23).",
    ],
    form={
        r"\dot\phi\text{ (equal spins)}": cone_written,
        r"\dot\phi\text{ (opposite spins)}": opposite_written,
        r"\Omega/\Omega_0\text{ (opposite spins, through }r_0^3)": through_third_written,
    },
)

# %% [markdown]
# ## One constant for both kinds of pair?
#
# The paper's constant is, for equal and for opposite spins,
# $c_= = J/(J + mR^2/2)$ and $c_\pm^2 = J^2/\big((J + mR^2/2)(J + 2KR^2/\ell^2)\big)$.
# They are one for a bar whose mass sits in its ends, $K = m\ell^2/4$, and differ for both of the paper's.

# %%
single_rate = in_parameters(I3 * omega / J)
squares = [(rate / single_rate) ** 2 for rate in (equal_rate, opposite_rate)]
dumbbell = {K: m * ell**2 / 4}
prove(squares[0], squares[1].subs(dumbbell), "the squares of the two constants, the bar's mass in its ends")

# %%
constants = {
    premise.says: [float(sp.sqrt(premise.on(PAPERS_ROTOR.on(square)))) for square in squares]
    for premise in (HEAVY_BAR, LIGHT_BAR_PREMISE)
}
in_words = "; ".join(f"{equal:.4f} and {other:.4f} if {says}" for says, (equal, other) in constants.items())
verdict(
    "5.28",
    {
        r"\dot\phi\text{ (equal spins)}": equal_rate,
        r"\dot\phi\text{ (opposite spins)}": opposite_rate,
        r"\Omega_0^2\text{ (opposite spins)}": opposite_rate**2,
        r"\Omega_0^2\text{ (any spins)}": natural**2,
    },
    premises=[PAPERS_ROTOR, HEAVY_BAR],
    correction={
        r"\dot\phi\text{ (equal spins)}": form("I_3*omega/(a + b)", **inertias),
        r"\Omega_0^2\text{ (opposite spins)}": square_written,
        r"\Omega_0^2\text{ (any spins)}": form("(a*(G_1**2 + G_2**2) - 2*b*G_1*G_2)/(2*(a + b)*(a**2 - b**2))"),
    },
    form={
        r"\dot\phi\text{ (equal spins)}": form("I_3*omega/(a + b)", **inertias),
        r"\dot\phi\text{ (opposite spins)}": form("I_3*omega/sqrt(a**2 - b**2)", **inertias),
    },
    wrong="The constant holds for one bar and equal spins only. Where it gives "
    f"{float(product):g} rad/s, at ω = 10 rad/s, the rate for opposite spins is {listed_rates(OPPOSITE)}; for equal spins it is "
    f"{listed_rates(EQUAL)}.",
    uses=["5.25", "5.27"],
    evidence=[
        f"The constants for equal and for opposite spins are {in_words}.",
        "5.25 is measured with equal spins and a bar of 1 kg. This line prints the same constant for opposite spins "
        "too, for which "
        "it is wrong.",
    ],
)

# %%
Remark(
    "One constant for equal and for opposite spins",
    "Divided by the natural frequency of one rotor, the natural frequencies of the two kinds of pair are equal only if the bar's "
    "mass is concentrated at its ends, K = mℓ²/4. The paper's bars are not of this kind.",
)
