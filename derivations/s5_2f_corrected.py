# %% [markdown]
# # The corrected trajectories (5.20 to 5.22)
#
# **Objective.** The paired precession of the exact pair: its inclinations, trajectories and frequency as series in the amplitude,
# compared with the paper's amplitude-based correction.
#
# **Assumptions.** Opposite spins, the symmetric periodic orbit, any bar. The paper's massless bar with the length of the
# rotors is named where it is used.
#
# **Notation.** $r_0 = \sin\theta_0$ the sine of the inclination when the axes are parallel; $\Phi = \Omega t$ the phase;
# $\sigma = (a+b)/(a-b)$ the bar's shape, 1 for a massless one; $k = \ell/R$; $x_i$, $y_i$ components of the axes.

# %%
import numpy as np
import sympy as sp

from lagrotor import Scene, corrected_trajectories, natural_rate, paired_frequency, simulate
from lagrotor.mechanics import euler_lagrange
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order
from lagrotor.pair import rotor_lagrangian
from lagrotor.pair.notation import ANSATZ, I3, ROTOR, A, B, G, J, Phi, R, ell, k, r0, sigma, theta_0
from lagrotor.paper import Formula, Series, Table, prove, verdict
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.premises import BAR_AS_LONG_AS_ROTORS, EQUAL_INERTIAS, MASSLESS_BAR, UNIT_LENGTH
from lagrotor.paper.rotor_pair.runs import OPPOSITE, PAPER_BAR, PAPER_R0
from lagrotor.theory import pair_precession_rate, paired_series

cosine, sine = sp.cos(Phi), sp.sin(Phi)
bar_ratio = {k: ell / R}

# %% [markdown]
# ## The series
#
# The Lindstedt–Poincaré series of the exact equations with their multipliers is derived in t3, using the symmetry of the orbit.
# Through the second order:

# %%
x_1, y_1, _, x_2, y_2, _ = (e.subs(bar_ratio) for e in corrected_trajectories(3).expressions)
second = (r0 * cosine + r0**2 * sigma * R / ell * sine**2, r0 * cosine - r0**2 * sigma * R / ell * sine**2)
prove((x_1, x_2), second, "the components along the joint line", names=(r"x_1", r"x_2"), small=r0, order=2)

# %%
across = (r0 * sine - r0**2 * R / (2 * ell) * sine * cosine, -r0 * sine - r0**2 * R / (2 * ell) * sine * cosine)
width = sp.sqrt(sigma)
prove(
    (y_1 / width, y_2 / width),
    across,
    "the components across it, over √σ",
    names=(r"y_1/\sqrt\sigma", r"y_2/\sqrt\sigma"),
    small=r0,
    order=2,
)

# %% [markdown]
# ## The inclinations
#
# To leading order the axes go round ellipses, with $D^2 = \cos^2\Phi + \sigma\sin^2\Phi$; the second order follows from the
# third of $\sin^2\theta_i = x_i^2 + y_i^2$:

# %%
s = sp.sin(theta_0)
D = sp.sqrt(1 + (sigma - 1) * sine**2)
prove(D**2, cosine**2 + sigma * sine**2, "the leading order of the squared sines, over r₀²", names="D^2")

# %%
change = sigma * R / (2 * ell) * sine**2 * cosine / D
sines = s * D + s**2 * change, s * D - s**2 * change
prove(
    tuple(sp.expand((e**2).subs(s, r0)) for e in sines),
    (x_1**2 + y_1**2, x_2**2 + y_2**2),
    "the squares of the inclinations' sines",
    equations=(
        r"\Big(r_0 D + \frac{\sigma R}{2\ell}\,r_0^2\,\frac{\sin^2\Phi\cos\Phi}{D}\Big)^2 = x_1^2 + y_1^2",
        r"\Big(r_0 D - \frac{\sigma R}{2\ell}\,r_0^2\,\frac{\sin^2\Phi\cos\Phi}{D}\Big)^2 = x_2^2 + y_2^2",
    ),
    small=r0,
    order=3,
)

# %% [markdown]
# The paper's correction removes the oscillation of the bar's length, but the constant length is wrong: it is the maximum for
# constant inclinations. With the printed sines, $\ell = R = 1$ and opposite azimuths, the squared length is

# %%
shorter, longer = r0 - r0**2 * cosine, r0 + r0**2 * cosine
length_squared = (1 + cosine * (longer - shorter)) ** 2 + sine**2 * (longer + shorter) ** 2
prove(
    length_squared,
    1 + 4 * r0**2 + 4 * r0**4 * cosine**4,
    "the squared length of the bar with the printed correction",
    names=r"|\vec r_2 - \vec r_1|^2",
)

# %%
lengths = [float(sp.sqrt(length_squared.subs({r0: PAPER_R0, Phi: angle}))) for angle in (0, sp.pi / 2)]
sines_written = {
    rf"\sin\theta_{i}": form(
        f"sin(theta_0)*sqrt(1 + (sigma - 1)*sin(Phi)**2) {sign}"
        " sigma*R*sin(theta_0)**2*sin(Phi)**2*cos(Phi)/(2*ell*sqrt(1 + (sigma - 1)*sin(Phi)**2))"
    )
    for i, sign in ((1, "+"), (2, "-"))
}
verdict(
    "5.20",
    {rf"\sin\theta_{i}": Series(series, theta_0, 2) for i, series in enumerate(sines, 1)},
    premises=[MASSLESS_BAR, BAR_AS_LONG_AS_ROTORS],
    correction=sines_written,
    wrong="The correction keeps the bar's length nearly constant, but makes it too long by 2r₀². "
    f"At r₀ = {PAPER_R0} it gives the bar {min(lengths):.3f} to {max(lengths):.3f} times its true length. "
    "Φ = Ω t is not the azimuth: the azimuths that keep the length follow from x and y of 5.22.",
    uses=["5.19"],
    evidence=[
        f"At r₀ = {PAPER_R0} the printed correction makes the bar {min(lengths):.4f} to {max(lengths):.4f} times as "
        "long as it is.",
        "With opposite azimuths, as in 5.11, no correction of the inclinations can keep the length of the bar; the azimuths must "
        "change too (5.22).",
    ],
    form=sines_written,
)

# %% [markdown]
# ## The rate after the correction: at constant $A$ and $B$
#
# The paper varies the formula of the rate (5.15) at constant $A$ and $B$. The correction makes $\sin\theta_1$ smaller and
# $\sin\theta_2$ larger by the same $\varepsilon = \sin^2\theta_0\cos\phi$, so to first order the two changes of the rate
# have opposite signs:

# %%
theta_1, theta_2 = ANSATZ.q[:2]
rate = pair_precession_rate().expressions[0]
level = {theta_1: theta_0, theta_2: theta_0}
by_sine_1, by_sine_2 = (rate.diff(angle).subs(level) / sp.cos(theta_0) for angle in (theta_1, theta_2))
prove(
    by_sine_1,
    by_sine_2,
    "the derivatives of the rate by sin θ₁ and by sin θ₂, at equal inclinations",
    equations=r"\frac{\partial\dot\phi}{\partial\sin\theta_1} = \frac{\partial\dot\phi}{\partial\sin\theta_2}",
)

# %%
epsilon = s**2 * cosine
varied = rate.subs(level) - by_sine_1 * epsilon + by_sine_2 * epsilon
unvaried = (A - B * sp.cos(theta_0)) / (2 * J * s**2)
prove(varied, unvaried, "the rate to first order in the correction, at constant A and B", names=r"\dot\phi")

# %% [markdown]
# The paper multiplies the two derivatives where their difference is needed. A second error cancels the first, so its last line is
# correct.
#
# ## The frequency of the orbit
#
# The varied formula is an identity (5.15). The frequency of the orbit does change with the amplitude:

# %%
frequency = paired_frequency(3).expressions[0].subs(bar_ratio)
ratio = ell / R
curvature = sigma * (ratio**2 * sigma - 3 * ratio**2 + 3) / (4 * ratio**2)
prove(
    frequency,
    1 - curvature * r0**2,
    "the frequency of the paired precession",
    names=r"\Omega/\Omega_0",
    small=r0,
    order=3,
)

# %% [markdown]
# The paper compares with a constant inclination $\theta_0$. A rotor without a bar keeps it if its equation of motion in $\theta$
# has no acceleration; with $G = I_3(\dot\psi + \dot\phi\cos\theta)$

# %%
(theta, _, _), (theta_v, phi_v, psi_v), (theta_a, *_) = ROTOR.q, ROTOR.v, ROTOR.a
constant = {theta_v: 0, theta_a: 0, psi_v: G / I3 - phi_v * sp.cos(theta)}
prove(
    euler_lagrange(rotor_lagrangian(), ROTOR)[0].subs(constant),
    phi_v * sp.sin(theta) * (G - J * phi_v * sp.cos(theta)),
    "the equation of the inclination, to vanish while this is constant",
    names=r"E_\theta",
)

# %% [markdown]
# so that it precesses at $G/(J\cos\theta_0)$. With a massless bar $\Omega_0 = G/J$. The ratio of the orbit's frequency to this
# rate is, for $\ell = R$,

# %%
prove(
    frequency.subs({sigma: 1, ell: R}) * sp.sqrt(1 - r0**2),
    1 - sp.Rational(3, 4) * r0**2,
    "the frequency of the orbit over the rate at the constant inclination",
    names=r"\Omega\Big/\frac{G}{J\cos\theta_0}",
    small=r0,
    order=3,
)

# %% [markdown]
# For a massless bar with $\ell = R$, through the eighth order:

# %%
massless = paired_series(9, sp.Integer(1), sp.Integer(1))
massless_frequency = massless.expression(massless.frequency)
Formula(massless_frequency, r"\Omega/\Omega_0")

# %% [markdown]
# The orders are also measured, against the periodic orbit of the exact model found by shooting (massless bar, $\ell = R$).

# %%
amplitudes, phases = (0.005, 0.01, 0.02), np.linspace(0, 2 * np.pi, 73)
printed = (cosine * shorter, sine * shorter)
own = {sigma: 1, ell: 1, R: 1}
curves = {
    "as printed": printed,
    "corrected": (second[0].subs(own), across[0].subs(own)),
    "series of order 3": (x_1.subs(own), y_1.subs(own)),
}
functions = {name: sp.lambdify([r0, Phi], pair, "numpy") for name, pair in curves.items()}
errors: dict[str, list[list[float]]] = {name: [] for name in curves}
changes = []
for size in amplitudes:
    orbit = exact_orbit(Scene(spins=(10, -10)), size)
    axis = simulate(orbit.scene, phases / orbit.frequency, "minimal", 1e-13).axes[0]
    changes.append(1 - orbit.frequency / natural_rate(orbit.scene))
    for name, function in functions.items():
        errors[name].append([float(np.abs(c - axis[:, i]).max()) for i, c in enumerate(function(size, phases))])
slopes = {
    name: [measured_order(amplitudes, column) for column in zip(*rows, strict=True)] for name, rows in errors.items()
}
rate_slope = measured_order(amplitudes, changes)
Table(
    "Exponents of the errors in the amplitude",
    ("curve", "x", "y"),
    tuple((name, *(f"{slope:.2f}" for slope in pair)) for name, pair in slopes.items()),
    "The largest error within a period, against the exact orbit, is fitted by a power of r_0 for r_0 = "
    f"{', '.join(map(str, amplitudes))}.",
)

# %%
at_paper = float(massless_frequency.subs(r0, PAPER_R0))
total = sp.Symbol("S", real=True)
by_total = ((2 * A - B * total) / (J * (4 - total**2))).diff(total).subs(total, 2 * sp.cos(theta_0))
S_tex = r"(\cos\theta_1 + \cos\theta_2)"
unchanged = "(A - B*cos(theta_0))/(2*J*sin(theta_0)**2)"
# The printed line with the difference of the derivatives by the two sines in place of their product.
line_written = form(
    f"{unchanged} + D_S*(S_2 - S_1)*sin(theta_0)**2*cos(Phi)",
    {
        "D_S": rf"\left[\frac{{\partial}}{{\partial{S_tex}}}\frac{{2 A - B {S_tex}}}{{J \left(4 - {S_tex}^2\right)}}\right]",
        "S_1": rf"\frac{{\partial{S_tex}}}{{\partial\sin\theta_1}}",
        "S_2": rf"\frac{{\partial{S_tex}}}{{\partial\sin\theta_2}}",
    },
    D_S=by_total,
    S_1=-sp.tan(theta_0),
    S_2=-sp.tan(theta_0),
)
orbit_written = {
    r"\Omega/\Omega_0": form("1 - sigma*(k**2*sigma - 3*k**2 + 3)/(4*k**2)*r_0**2", k=ell / R),
}
verdict(
    "5.21",
    {
        r"\dot\phi": varied,
        r"\dot\phi\text{ (last member)}": unvaried,
        r"\Omega/\Omega_0": Series(frequency, r0, 3),
    },
    premises=[EQUAL_INERTIAS, MASSLESS_BAR, BAR_AS_LONG_AS_ROTORS],
    correction={r"\dot\phi": line_written, r"\dot\phi\text{ (last member)}": form(unchanged), **orbit_written},
    wrong="The derivatives are multiplied, but they should be subtracted. Their difference is zero, so the last member is right; "
    "but at constant A and B it does not say how the frequency depends on the amplitude. "
    f"The frequency of the orbit at r₀ = {PAPER_R0} is {at_paper:.4f} Ω₀ with a massless bar.",
    uses=["5.15", "5.20"],
    evidence=[
        "The printed product of derivatives should be their difference, which is zero; the last line is right because two errors "
        "cancel. The varied formula is an identity (5.15), so this argument does not give the rate. The rate of the "
        "orbit is lower "
        "by ¾ r₀² than G/(J cos θ₀), the rate at constant inclination with which the paper compares (C17), and by ¼ r₀² than the "
        "natural rate.",
        "On exact orbits with a massless bar Ω/Ω₀ − 1 is "
        f"{-changes[0] / amplitudes[0] ** 2:+.4f} r₀², with the measured exponent {rate_slope:.3f}. At r₀ = {PAPER_R0} the ratio "
        f"Ω/Ω₀ is {at_paper:.5f}.",
    ],
    form={r"\dot\phi": form(unchanged), **orbit_written},
)

# %% [markdown]
# ## The trajectories
#
# The left joint is at $-\ell/2$, the right one at $+\ell/2$. In $x$ the paper's second harmonic is right, but a constant of
# second order is missing, the displacement of the two centres. The mean of a polynomial of second degree in $\cos\Phi$ and
# $\sin\Phi$ is the mean of its values at four phases a quarter turn apart:

# %%
tips = -ell / 2 + R * x_1, ell / 2 + R * x_2
prove(
    tuple(sum(e.subs(Phi, turn * sp.pi / 2) for turn in range(4)) / 4 for e in (R * second[0], printed[0])),
    (r0**2 * sigma * R**2 / (2 * ell), -(r0**2) / 2),
    "the mean of x₁ from its joint, derived and printed",
    names=(r"\langle x_1\rangle", r"\langle x_1\rangle_{\text{printed}}"),
)

# %%
through_second = {
    "x_1": "-(ell/2) + A_x*(cos(Phi) + r_0*sigma/k*sin(Phi)**2",
    "x_2": "ell/2 + A_x*(cos(Phi) - r_0*sigma/k*sin(Phi)**2",
    "y_1": "A_y*(sin(Phi) - r_0/(2*k)*sin(Phi)*cos(Phi)",
    "y_2": "A_y*(-sin(Phi) - r_0/(2*k)*sin(Phi)*cos(Phi)",
}
of_x = " - r_0**2*(3*sigma + k**2*(sigma**2 + sigma - 2))/(48*k**2)*(cos(Phi) - cos(3*Phi))"
of_y = "((8*k**2 + 5*k**2*sigma - 13*k**2*sigma**2 - 39*sigma)*sin(Phi) + 3*sigma*(k**2*(sigma - 1) + 3)*sin(3*Phi))"
third = {"x_1": of_x, "x_2": of_x}
third |= {f"y_{i}": f" {sign} r_0**2/(48*k**2)*{of_y}" for i, sign in ((1, "+"), (2, "-"))}
short = {"k": ell / R, "A_x": R * r0, "A_y": R * width * r0}
light_big, light_coupled = Scene(spins=OPPOSITE, link=PAPER_BAR).inertias
light_sigma = (light_big + light_coupled) / (light_big - light_coupled)
in_words = "; ".join(f"{x:.2f} in x and {y:.2f} in y ({name})" for name, (x, y) in slopes.items())
verdict(
    "5.22",
    {name: Series(e, r0, 3) for name, e in {"x_1": tips[0], "x_2": tips[1], "y_1": R * y_1, "y_2": R * y_2}.items()},
    premises=[MASSLESS_BAR, BAR_AS_LONG_AS_ROTORS, UNIT_LENGTH],
    correction={name: form(text + ")", remainder="r_0^3", **short) for name, text in through_second.items()},
    form={name: form(text + third[name] + ")", **short) for name, text in through_second.items()},
    wrong="A constant of second order in the amplitude is missing: x₁ lacks r₀², x₂ lacks −r₀². "
    f"At r₀ = {PAPER_R0} this is {PAPER_R0**2:.4f} m. With the bar of section 5.2.1, whose σ is {light_sigma:.4f}, the "
    f"missing term varies during a turn from {light_sigma * PAPER_R0**2:.4f} m to {PAPER_R0**2:.4f} m.",
    uses=["5.20", "5.21"],
    evidence=[
        "In x the printed second harmonic is right. The paper does not print y = sin θ sin φ; with its correction of the "
        "inclinations the second harmonic of y would be twice too large.",
        f"The errors against the exact orbit are proportional to powers of r₀. The measured exponents are {in_words}.",
    ],
)
