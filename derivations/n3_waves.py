# %% [markdown]
# # Waves in rows, rings and nets
#
# **Objective.** Small waves in periodic patterns of rotors and rigid bars: bands, zero bands, the speed of long waves, the
# effect of weight, and the convergence of finite patterns.
#
# **Assumptions.** Small motion about upright axes; bars are constraints. In the closed forms the rotors are equal and the
# bars massless, except where $b$ is named.
#
# **Notation.** $u=(x,y)$ tilt of an axis; $a$ its inertia about the joint, $b$ the coupling by a heavy bar, $G$ the axial
# momentum; $\kappa$ hinge stiffness minus the weight's moment $gS$. Waves $u_n\propto e^{i(qn-\omega t)}$. With $Z$ a basis
# of the motions that the bars allow at $q$: $\det(-\omega^2Z^\dagger MZ-i\omega Z^\dagger CZ+Z^\dagger KZ)=0$.

# %%
from math import pi

import numpy as np
import sympy as sp

from lagrotor import Link, Rotor, Structure
from lagrotor.paper import Remark, prove
from lagrotor.structures import honeycomb, polygon_ring, square, straight_row, zigzag
from lagrotor.structures.coefficients import coefficients
from lagrotor.structures.waves.dispersion import dispersion, long_wave_speeds

a, G, kappa, omega = sp.symbols("a G kappa omega", positive=True)
b, q, theta = sp.symbols("b q theta", real=True)
i, c, s = sp.I, sp.cos(theta), sp.sin(theta)


def inner(u: sp.Matrix, v: sp.Matrix) -> tuple[sp.Expr, sp.Expr]:
    """Real and imaginary part of u†v, u and v given as (real, imaginary) columns side by side."""
    p, r = u[:, 0], u[:, 1]
    return p.dot(v[:, 0]) + r.dot(v[:, 1]), p.dot(v[:, 1]) - r.dot(v[:, 0])


def turned(u: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    return sp.Matrix([[sp.cos(angle), -sp.sin(angle)], [sp.sin(angle), sp.cos(angle)]]) * u


def shifted(u: sp.Matrix, phase: sp.Expr) -> sp.Matrix:
    """exp(i phase) u."""
    return u * sp.Matrix([[sp.cos(phase), sp.sin(phase)], [-sp.sin(phase), sp.cos(phase)]])


crossed = sp.Matrix([[0, 1], [-1, 0]])  # C = G times it

# %% [markdown]
# ## The ring
#
# The angle between consecutive bars is $\theta$. With one bar per rotor there is one degree of freedom per rotor: the speed
# $s_k$ of bar $k$ along itself. In the frame of joint 0 bar 0 lies along $x$ and bar −1 along $(\cos\theta,-\sin\theta)$;
# with $s_k=e^{iqk}$ the two projections of $u$ are $1$ and $e^{-iq}$:

# %%
u = sp.Matrix([[1, 0], [(c - sp.cos(q)) / s, sp.sin(q) / s]])
prove(
    list(sp.Matrix([[c, -s]]) * u),
    [sp.cos(q), -sp.sin(q)],
    "the projection of u on the bar before",
    names=(r"\mathrm{Re}", r"\mathrm{Im}"),
)

# %%
mass = inner(u, u)[0]
prove(mass, 2 * (1 - c * sp.cos(q)) / s**2, "the mass of the wave over a", names=r"u^\dagger u")

# %%
gyroscopic = inner(u, crossed * u)[1]
prove(gyroscopic, 2 * sp.sin(q) / s, "the gyroscopic term over G", names=r"-iu^\dagger\epsilon u")

# %% [markdown]
# so that without weight the ring has one band,
# $$\omega(q)=\frac Ga\,\frac{\sin\theta\sin q}{1-\cos\theta\cos q},\qquad q=\frac{2\pi m}N,\quad\theta=\frac{2\pi}N .$$
# A positive rate belongs to only one sign of $q$: these waves run one way. The highest rate, $G/a$, is the free precession of all
# axes in phase, at $q=\theta$:

# %%
band = s * sp.sin(q) / (1 - c * sp.cos(q))
prove(
    sp.diff(band, q),
    s * (sp.cos(q) - c) / (1 - c * sp.cos(q)) ** 2,
    "the slope of the band in units of G/a",
    names=r"\frac{a}{G}\frac{d\omega}{dq}",
)

# %%
prove(band.subs(q, theta), 1, "its highest value", names=r"\frac aG\omega(\theta)")

# %%
tau = sp.Symbol("tau", positive=True)  # tan(theta/2)
cosine, sine = (1 - tau**2) / (1 + tau**2), 2 * tau / (1 + tau**2)
prove(
    [(sine / (1 - cosine)), sine / (1 + cosine)],
    [1 / tau, tau],
    "the slopes at q = 0 and at q = π, with tau = tan(theta/2)",
    names=(r"\frac aG\omega'(0)", r"-\frac aG\omega'(\pi)"),
)

# %% [markdown]
# Long waves are faster for smaller $\theta$, $\omega\approx(G/a)\cot(\theta/2)\,q$. In a straight row, where rigid bars
# transmit a push instantly, there is no wave along the row.
#
# A heavy bar couples neighbours by $b$; its coupling is $2b\,\mathrm{Re}(e^{iq}u^\dagger R_\theta u)$:

# %%
coupling = 2 * inner(u, turned(shifted(u, q), theta))[0]
prove(
    coupling,
    4 * (sp.sin(q) ** 2 - c**2 + c * sp.cos(q)) / s**2,
    "the mass that a heavy bar adds over b",
    names=r"2\,\mathrm{Re}(e^{iq}u^\dagger R_\theta u)",
)

# %% [markdown]
# $$\omega(q)=\frac{G\sin\theta\sin q}{a(1-\cos\theta\cos q)+2b(\sin^2q-\cos^2\theta+\cos\theta\cos q)} .$$
#
# ## The zigzag
#
# Bars turned by $+\theta$ and $-\theta$ in turn: the mass has the same $\cos\theta$, the gyroscopic term changes its sign
# with $\sin\theta$ from joint to joint. With spins $\pm G$ in turn the two signs cancel, and with massless bars every zigzag
# has the band of the ring, $q$ counted from rotor to rotor; $\theta=\pi/2$ is the staircase, $\omega=(G/a)\sin q$. With heavy
# bars the bands differ. Let $p$ be the speed of a bar along itself and $p_\pm$ the speeds of its neighbours. Across the bar
# its ends move by $-(p_--p\cos\theta)/\sin\theta$ and $(p_+-p\cos\theta)/\sin\theta'$, with $\theta'=\theta$ in the ring and
# $-\theta$ in the zigzag, so a part of the coupling changes its sign:

# %%
squared = (sp.cos(q) - c) ** 2 - sp.sin(q) ** 2  # the real part of (exp(iq) − cos θ)²
prove(
    2 * (1 + squared / s**2),
    4 * sp.cos(q) * (sp.cos(q) - c) / s**2,
    "the mass that a heavy bar adds over b in the zigzag",
    names=r"2\,\mathrm{Re}(u_n^\dagger u_{n+1})",
)

# %% [markdown]
# $$\omega(q)=\frac{G\sin\theta\sin q}{a(1-\cos\theta\cos q)+2b\cos q(\cos q-\cos\theta)} .$$
#
# With equal spins the bars come in two kinds, $e$ and $o$, two degrees of freedom a cell:

# %%
own, next_to = a + 2 * b * sp.cos(q) ** 2, -(a + 2 * b) * c * sp.cos(q)
M = 2 / s**2 * sp.Matrix([[own, next_to], [next_to, own]])
H = G / s * sp.Matrix([[0, -2 * i * sp.cos(q)], [2 * i * sp.cos(q), 0]])
prove(
    (omega * M - H).det() * s**4 / 4,
    omega**2 * ((a + 2 * b * sp.cos(q) ** 2) ** 2 - (a + 2 * b) ** 2 * c**2 * sp.cos(q) ** 2)
    - G**2 * s**2 * sp.cos(q) ** 2,
    "the bands of equal spins",
    names=r"\tfrac14\sin^4\!\theta\,\det(\omega M-H)",
)

# %% [markdown]
# $$\omega(q)=\frac{G\sin\theta\,|\cos q|}{\sqrt{(a+2b\cos^2q)^2-(a+2b)^2\cos^2\theta\cos^2q}}$$
# runs both ways; with massless bars it begins at $q=0$ with the highest rate.

# %%
bar = Link(mass=0.3, inertia=0.1)
mass, coupled, waves = (
    Rotor().J + 2 * (bar.mass / 4 + bar.inertia),
    bar.mass / 4 - bar.inertia,
    np.linspace(0.1, 3.0, 30),
)


def heavy_zigzag(turn: float) -> float:
    """How far the closed forms are from the rates, rad/s."""
    near = mass * (1 - np.cos(turn) * np.cos(waves)) + 2 * coupled * np.cos(waves) * (np.cos(waves) - np.cos(turn))
    far = mass * (1 + np.cos(turn) * np.cos(waves)) + 2 * coupled * np.cos(waves) * (np.cos(waves) + np.cos(turn))
    forms = {
        (10.0, -10.0): 10 * np.sin(turn) * np.sin(waves) / near,
        (10.0, 10.0): 10 * np.sin(turn) * np.abs(np.cos(waves)) / np.sqrt(near * far),
    }
    found = {spins: dispersion(zigzag(turn, spins=spins, link=bar), 2 * waves).rates[:, -1] for spins in forms}
    return max(float(np.abs(found[spins] - form).max()) for spins, form in forms.items())


off_zigzag = max(heavy_zigzag(turn) for turn in (0.7, pi / 2, 2.2))
assert off_zigzag < 1e-12
Remark(
    "The zigzag with heavy bars",
    f"The closed forms are compared with the rates of the pattern for bars of {bar.mass:g} kg and {bar.inertia:g} kg m², for "
    "alternating and for equal spins of 10 rad/s, and for angles of 0.7, π/2 (the staircase) and 2.2 rad between consecutive "
    f"bars. They differ by at most {off_zigzag:.0e} rad/s.",
)

# %% [markdown]
# ## An open zigzag of N rotors, exactly
#
# At an end the axis is free to move across its single bar. This degree of freedom is equivalent to the speed of a missing bar, so
# that the chain of $N$ rotors has $N+1$ degrees of freedom with $N$ equal terms. At an end the term of the missing rotor must
# vanish, $f(q)=0$ for a single wave with

# %%
w = sp.Symbol("w", positive=True)  # omega in units of G/a
f = w * (1 - c * (sp.cos(q) - i * sp.sin(q))) - i * s * (sp.cos(q) - i * sp.sin(q))
prove(
    f.subs(w, band),
    i * (band * c * sp.sin(q) - s * sp.cos(q)),
    "the term of the missing rotor, on the band",
    names="f(q)",
)

# %% [markdown]
# Imaginary at every $q$: at both ends the two waves $q_1$, $q_2$ of one rate enter in the same ratio, and
# $e^{i(q_1-q_2)N}=1$. With $t=\tan(q/2)$ the band is a quadratic in $t$, its roots $t_1t_2=\tau^2$, $t_1+t_2=2\tau/w$:

# %%
t, x = sp.symbols("t x", positive=True)
prove(
    (w * (1 - cosine * (1 - t**2) / (1 + t**2)) - sine * 2 * t / (1 + t**2)) * (1 + t**2) * (1 + tau**2) / 2,
    w * (t**2 + tau**2) - 2 * tau * t,
    "the band in t, tau",
    names=r"\tfrac12(1+t^2)(1+\tau^2)[w(1-\cos\theta\cos q)-\sin\theta\sin q]",
)

# %% [markdown]
# From $q_1-q_2=2x$, $x=\pi m/N$, follows $t_1-t_2=(1+\tau^2)\tan x$, and
# $(t_1+t_2)^2=(t_1-t_2)^2+4t_1t_2$ gives the rates of the open chain,
# $$\omega_m=\frac Ga\,\frac{\sin\theta\cos x}{\sqrt{1-\cos^2\theta\cos^2x}},\qquad x=\frac{\pi m}N :$$

# %%
rate = sine * sp.cos(x) / sp.sqrt(1 - cosine**2 * sp.cos(x) ** 2)
prove(
    (2 * tau / rate) ** 2,
    ((1 + tau**2) * sp.tan(x)) ** 2 + 4 * tau**2,
    "the rates of the open chain satisfy it",
    names=r"(2\tau/w)^2",
)

# %% [markdown]
# These are the bands of *equal* spins at $q=\pi m/N$. In an open zigzag equal spins and spins in turn have the same rates.


# %%
massless = Link()


def chain(angle: float, N: int, spins: tuple[float, float], link: Link = massless) -> np.ndarray:
    """Rates (rad/s) of an open zigzag, the zero ones left out."""
    rates = np.sort(zigzag(angle, spins=spins, link=link).piece(N // 2).modes().rates)
    return rates[rates > 1e-9]


free = 10 * Rotor().I3 / Rotor().J  # G/a at 10 rad/s, rad/s
worst = 0.0
for angle in (pi / 6, 0.9, pi / 2):
    for spins in ((10.0, 10.0), (10.0, -10.0)):
        for N in (16, 32, 64):
            at = np.pi * np.arange(N // 2) / N
            closed = free * np.sin(angle) * np.cos(at) / np.sqrt(1 - (np.cos(angle) * np.cos(at)) ** 2)
            worst = max(worst, float(np.abs(chain(angle, N, spins) / np.sort(closed) - 1).max()))
assert worst < 1e-12
Remark(
    "Open zigzags",
    "The closed form is compared with the rates of open zigzags of 16, 32 and 64 rotors at 30°, 51.6° and 90°, with equal and "
    f"with alternating spins. The largest relative difference is {worst:.0e}.",
)

# %% [markdown]
# A long wave travels out on one branch and returns on the other. In a long chain the lowest rate approaches $2\pi$ over the
# time of this round trip.


# %%
def orders(link: Link) -> tuple[list[float], list[float]]:
    """The lowest mode's distance from the long waves' round trip at N = 16, 32, 64, and the two orders in 1/N."""
    pattern = zigzag(0.9, spins=(10.0, -10.0), link=link)
    there, back = (float(long_wave_speeds(pattern, [sign])[0]) for sign in (1, -1))
    cell = np.hypot(*pattern.steps[0])
    far = []
    for N in (16, 32, 64):
        travel = N / 2 * cell * (1 / there + 1 / back)
        far.append(abs(chain(0.9, N, (10.0, -10.0), link)[0] * travel / (2 * np.pi) - 1))
    return far, [float(np.log2(far[k] / far[k + 1])) for k in (0, 1)]


light, heavy = orders(massless), orders(Link(mass=1.0, inertia=0.1))
Remark(
    "The lowest mode of a long zigzag",
    "The rate of the lowest mode approaches 2π divided by the time in which a long wave travels to the end and back. "
    "The relative "
    f"difference decreases as 1/N to the power {light[1][1]:.2f} for massless bars ({light[1][0]:.2f} between the two smaller N) "
    f"and is {light[0][2]:.1e} at N = 64. For heavy bars the power is {heavy[1][1]:.2f} ({heavy[1][0]:.2f}) and the difference "
    f"{heavy[0][2]:.1e}.",
)

# %% [markdown]
# ## The honeycomb
#
# Two rotors a cell, three bars: one degree of freedom. With $n_j$ the directions of the bars and $\phi_j$ the phases of
# their far
# ends, the projections $f_j=n_j\cdot u_A$ have $\sum f_j=0$ as the $n_j$ add up to zero, and those of $u_B$,
# $f_je^{-i\phi_j}$, too: $f=(1,1,1)\times e^{-i\phi}$, so $f_1=e^{-i\phi_3}-e^{-i\phi_2}$ and so on. With
# $\Delta_j$ the differences of the phases:

# %%
phi = sp.symbols("phi_1:4", real=True)
e = [sp.cos(p) - i * sp.sin(p) for p in phi]
conj = [sp.cos(p) + i * sp.sin(p) for p in phi]
F, Fc = ([v[2] - v[1], v[0] - v[2], v[1] - v[0]] for v in (e, conj))
d = (phi[0] - phi[1], phi[1] - phi[2], phi[2] - phi[0])
cosines, sines = sum(map(sp.cos, d)), sum(map(sp.sin, d))
prove(
    sum(p * r for p, r in zip(F, Fc, strict=True)),
    2 * (3 - cosines),
    "the squares of the projections, the same for A and B",
    names=r"\sum|f_j|^2",
)

# %%
prove(
    [Fc[0] * F[1] - F[0] * Fc[1], Fc[0] * F[1] * conj[0] * e[1] - F[0] * Fc[1] * e[0] * conj[1]],
    [2 * i * sines, -2 * i * sines],
    "twice i times the area of the ellipse of A and of B: opposite senses",
    names=(r"f_1^*f_2-f_1f_2^*", r"g_1^*g_2-g_1g_2^*"),
)

# %% [markdown]
# The two axes of a cell circle in opposite senses. The effects of equal spins cancel: **a honeycomb of rigid bars and equal spins
# has only one zero band.** The effects of opposite spins add. With $|u|^2=\tfrac23\sum|f_j|^2$ and the area $2/\sqrt3$ times
# $f_1\times f_2$:
# $$\omega=\frac{G_A-G_B}{2a}\,\frac{\sqrt3\,\sum\sin\Delta_j}{3-\sum\cos\Delta_j}$$
# (for one sign of each $q$). For long waves,
# $\Delta=\epsilon(d_1,d_2,-d_1-d_2)$,

# %%
epsilon = sp.Symbol("epsilon", positive=True)
d_1, d_2 = sp.symbols("d_1 d_2", real=True)
long = [epsilon * part for part in (d_1, d_2, -d_1 - d_2)]
prove(
    [sum(map(sp.sin, long)), 3 - sum(map(sp.cos, long))],
    [epsilon**3 * d_1 * d_2 * (d_1 + d_2) / 2, epsilon**2 * (d_1**2 + d_1 * d_2 + d_2**2)],
    "the two sums for long waves",
    small=epsilon,
    order=3,
    names=(r"\sum\sin\Delta_j", r"3-\sum\cos\Delta_j"),
)

# %% [markdown]
# so that they have a speed, which depends on their direction: $\frac{G_A-G_B}{4a}\cos3\chi$ lengths of a bar a second,
# with $\chi$ from the line across a bar.

# %%
draw = np.random.default_rng(0).uniform(-pi, pi, (200, 2))
delta = np.array([draw[:, 0], -draw[:, 1], draw[:, 1] - draw[:, 0]])
closed = np.sqrt(3) * free * np.sin(delta).sum(0) / (3 - np.cos(delta).sum(0))
opposite, equal = (dispersion(honeycomb(spins=spins), draw) for spins in ((10.0, -10.0), (10.0, 10.0)))
off = float(np.abs(np.abs(opposite.rates[:, 0]) - np.maximum(closed, 0)).max() / free)
assert off < 1e-12 and equal.zero_bands == 1 and opposite.zero_bands == 0
Remark(
    "The honeycomb's band",
    f"At 200 wave numbers the rates for opposite spins differ from the closed form by at most {off:.0e} G/a. With equal spins "
    f"the honeycomb has {equal.zero_bands} band at the rate zero, with opposite spins {opposite.zero_bands}.",
)

# %% [markdown]
# ## Zero bands and special wave numbers
#
# In the straight row the bars keep all $x$ equal. A wave $q\ne0$ has $x=0$, and no spin acts on it. Its rate depends only on
# hinges and bars, $\omega^2=\kappa/(a+2b\cos q)$.

# %%
row = straight_row(spins=10.0, hinge=50.0, link=Link(mass=1.0, inertia=0.1))
grid = np.linspace(0.1, 3.0, 30)
A, B = Rotor().J + 2 * (1 / 4 + 0.1), 1 / 4 - 0.1
off_row = float(np.abs(dispersion(row, grid).rates[:, 0] / np.sqrt(50 / (A + 2 * B * np.cos(grid))) - 1).max())
assert off_row < 1e-12
Remark(
    "The straight row",
    "For a row with hinges and heavy bars the closed form differs from the rates of the pattern by a relative error of at most "
    f"{off_row:.0e}.",
)

# %% [markdown]
# The square net has two bars per rotor. It has no degree of freedom except on the lines $q_x=0$ and $q_y=0$, where a row or a
# column moves as a whole.

# %%
counted = {
    "straight row": dispersion(straight_row(spins=10.0), grid),
    "zigzag": dispersion(zigzag(0.9, spins=(10.0, 10.0)), grid),
    "honeycomb, equal spins": equal,
    "honeycomb, opposite spins": opposite,
    "square": dispersion(square(spins=10.0), draw),
}
lines = dispersion(square(spins=10.0), [[0.0, 1.0], [1.0, 0.0], [0.0, 0.0]]).dof
assert [v.zero_bands for v in counted.values()] == [1, 0, 1, 0, 0] and lines.tolist() == [1, 1, 2]
Remark(
    "Degrees of freedom per cell, and bands at rate zero",
    "The straight row has {} degree of freedom per cell and {} band at the rate zero. These numbers are {} and {} for "
    "the zigzag, {} and {} for the honeycomb with equal spins, {} and {} for the honeycomb with opposite spins, and {} "
    "and {} for the square net. On the lines q_x = 0 and q_y = 0 the square net has {} degree of freedom per cell, at "
    "q = 0 it has {}.".format(*(n for v in counted.values() for n in (v.dof.min(), v.zero_bands)), lines[0], lines[2]),
)

# %% [markdown]
# ## Weight and hinges
#
# With $\kappa$ on every axis the stiffness is $\kappa$ times the mass over $a$, and with $\beta(q)$ the rate without it
# times $a$, $a\omega^2-\beta\omega-\kappa=0$ for each degree of freedom.

# %%
beta = sp.Symbol("beta", real=True)
p = sp.Symbol("p")
prove(
    sp.Poly(a * p**2 - beta * p - kappa, p).discriminant(),
    beta**2 + 4 * a * kappa,
    "the discriminant",
    names=r"\Delta",
)

# %% [markdown]
# With hinges, $\kappa>0$, there are two rates, one of each sense, and a gap above zero. With weight, $\kappa<0$, the wave is
# stable only if $\beta(q)^2>4a|\kappa|$. As $\beta$ passes through zero in the bands above, **no infinite zigzag or honeycomb
# of rigid bars with spins of one magnitude is stable under weight**. A finite zigzag has only certain $q$. For an even number
# of rotors one rate is zero, and the zigzag is unstable. For an odd number $N$ the least $\beta$ belongs to $x=\pi/2-\pi/2N$,
# and it is stable above $$G=2\sqrt{a|\kappa|}\;\frac{\sqrt{1-\cos^2\theta\sin^2(\pi/2N)}}{\sin\theta\,\sin(\pi/2N)}$$ which
# is proportional to its length.

# %%
loaded = zigzag(pi / 2, spins=(40.0, -40.0), gravity=9.81)
fine = np.linspace(0.01, 2 * pi - 0.01, 400)
falling = dispersion(loaded, fine)
turning = 40 * np.sin(fine / 2) * Rotor().I3
weight = 9.81 * Rotor().mass * Rotor().length / 2
growing = falling.growth.max(axis=1) > 0
assert (growing == (turning**2 < 4 * Rotor().J * weight)).all()
Remark(
    "An infinite staircase under weight",
    f"With spins of ±40 rad/s {growing.sum()} of {len(fine)} waves grow. These are exactly the waves with β² < 4a|κ|.",
)


# %%
def odd_zigzag(bend: float, N: int) -> Structure:
    even = zigzag(bend).piece((N + 1) // 2)
    return Structure(even.joints[:-1], even.bars[:-1], spins=1.0, gravity=9.81)


stands_from = []
for bend, N in ((pi / 2, 3), (pi / 2, 9), (0.9, 9), (0.9, 17)):
    least = np.sin(np.pi / 2 / N)
    closed_form = 2 * np.sqrt(Rotor().J * weight * (1 - (np.cos(bend) * least) ** 2)) / (np.sin(bend) * least)
    found = odd_zigzag(bend, N).critical_spin() * Rotor().I3
    assert abs(found / closed_form - 1) < 1e-9
    stands_from.append(f"{found:.2f} kg m²/s for {N} rotors at {np.degrees(bend):.0f}°")
assert zigzag(0.9, spins=1.0, gravity=9.81).piece(4).critical_spin() == np.inf
Remark(
    "Zigzags under weight",
    "With equal spins, massless bars, and rotors of 1 kg and 1 m the least axial momentum for stability is "
    f"{', '.join(stands_from)}. A zigzag of 8 rotors is unstable at every spin.",
)

# %% [markdown]
# ## Spins of two magnitudes: a gap, and stable long rows
#
# In a staircase with $G_1$ and $G_2$ in turn a cell has a tilt $X$ shared by its two rotors and a $Y$ shared by the second
# and the first of the next cell. With $\lambda=as^2+\kappa$ for motion as $e^{st}$ and $Q$ the phase of a cell

# %%
lam, S = sp.symbols("lambda S", real=True)
G_1, G_2, Q = sp.symbols("G_1 G_2 Q", real=True)
forth, back = (G_2 + G_1 * (sp.cos(Q) + sign * i * sp.sin(Q)) for sign in (-1, 1))
prove(
    sp.Matrix([[2 * lam, S * forth], [-S * back, 2 * lam]]).det(),
    4 * lam**2 + S**2 * (G_1**2 + G_2**2 + 2 * G_1 * G_2 * sp.cos(Q)),
    "the characteristic polynomial of the staircase",
    names="P(s,Q)",
)

# %% [markdown]
# so that $4\beta^2=G_1^2+G_2^2+2G_1G_2\cos Q$, the bands of Su, Schrieffer and Heeger's chain with spins for hoppings. They
# have the distance $||G_1|-|G_2||/2$ from zero, and an infinite staircase is stable under weight if this exceeds
# $2\sqrt{a|\kappa|}$. If every second rotor does not spin, the tilts form pairs, and the necessary spin does not grow with the
# length:


# %%
def staircase(N: int, rest: float) -> Structure:
    shape = [((k + 1) // 2, k // 2) for k in range(N)]
    spins = [1.0 if k % 2 == 0 else rest for k in range(N)]
    return Structure(shape, [(k, k + 1) for k in range(N - 1)], spins, gravity=9.81, load=2.0)


least_spins = {}
for N in (5, 9, 17, 33):
    coefficient = coefficients(staircase(N, 1.0))
    unit = float(np.sqrt(coefficient.A[0] * coefficient.gravity * coefficient.S[0])) / Rotor().I3
    least_spins[N] = [staircase(N, rest).critical_spin() / unit for rest in (1.0, 0.0)]
    assert abs(least_spins[N][0] * np.sin(np.pi / (2 * N)) / 2 - 1) < 1e-9 and abs(least_spins[N][1] / 4 - 1) < 1e-9
two = zigzag(pi / 2, spins=(12.0, -7.0)).dispersion(np.linspace(0, 2 * pi, 61))
assert np.allclose(two.gaps, [(0, 5 / 2 / Rotor().J)], rtol=1e-9)
Remark(
    "Long rows are stable if every second rotor does not spin",
    f"With all spins equal, a staircase of {', '.join(map(str, least_spins))} rotors is stable under load if the spin is at "
    f"least {', '.join(f'{all_:.2f}' for all_, _ in least_spins.values())} √(a|κ|)/I_3, in this order. If every "
    f"second rotor does not spin, the others need {max(half for _, half in least_spins.values()):.2f} √(a|κ|)/I_3 at each "
    "of these lengths.",
)

# %% [markdown]
# ## Compared with the exact motion
#
# The modes of the closed polygon of $N$ rotors are the band at $q=2\pi m/N$ exactly. One of them is simulated.

# %%
ring = polygon_ring(12, spins=10.0, link=Link(mass=0.3, inertia=0.1))
at = 2 * np.pi * np.arange(12) / 12
bands, body = dispersion(ring, at), ring.piece(12)
off_ring = float(np.abs(np.sort(bands.rates[:, 0]) - np.sort(body.modes().rates)).max() / bands.rates.max())
assert off_ring < 1e-12
m, tilt = 3, 1e-5
angle = ring.turn * np.arange(12)
turns = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]).transpose(2, 0, 1)
shape = np.einsum("nij,j->ni", turns, bands.shapes[m, 0, 0]) * np.exp(1j * at[m] * np.arange(12))[:, None]
times = np.linspace(0, 3 * 2 * np.pi / bands.rates[m, 0], 61)
run = body.simulate(times, tilt * shape.real, tilt * (-1j * bands.rates[m, 0] * shape).real, tol=1e-9)
wave = tilt * (shape[:, None] * np.exp(-1j * bands.rates[m, 0] * times)[None, :, None]).real
off_run = float(np.abs(run.axes[..., :2] - wave).max() / tilt)
assert off_run < 1e-3
Remark(
    "The bands and the exact model",
    "The 12 rates of a closed ring of 12 rotors with heavy bars differ from the band at q = 2πm/12 by at most "
    f"{off_ring:.0e} of the highest rate. In an exact run over 3 periods the wave m = 3 with a tilt of {tilt:g} differs from the "
    f"Bloch wave by at most {off_run:.0e} of the tilt.",
)
