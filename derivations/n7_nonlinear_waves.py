# %% [markdown]
# # Nonlinear waves
#
# **Objective.** The shift of the frequency of a wave of rotors with its amplitude, and the resonances of three waves.
#
# **Assumptions.** A periodic pattern of rotors, bars or springs between them, without friction. Whitham, Linear and Nonlinear
# Waves (1974), chs. 14 and 15; Craik, Wave Interactions and Fluid Flows (1985), ch. 5. The equations are known; the coefficients
# for rotors and bars are new.
#
# **Notation.** $a$ the largest tilt (its sine) of a wave, $z=a/2$, $\theta=qn-\omega t$ its phase in cell $n$;
# $g(\omega)|z|^2$ the mean of the quadratic Lagrangian; $A$ the inertia of an axis, $G$ its momentum, $S$ its first moment.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link
from lagrotor.numerics import measured_order
from lagrotor.paper import Remark, prove
from lagrotor.structures import polygon_ring, straight_row, wave_amplitude
from lagrotor.structures.coefficients import coefficients

N, c, g_1, omega, a, A, G, weight = sp.symbols("N c g' omega a A G w", positive=True)
B, f, b, shift = sp.symbols("B f b delta", real=True)

# %% [markdown]
# ## The averaged Lagrangian
#
# The wave $u=z\,s\,e^{i\theta}+\text{c.c.}$ forces responses at the phases 0 and $2\theta$, of size $b|z|^2$. The mean of the
# Lagrangian over cells and phases is, through fourth order and with $N=|z|^2$, $g(\omega_0)=0$ and $\omega=\omega_0+\delta$,
# $$\langle L\rangle=g'\delta\,N+\bigl(c+f\,b+\tfrac12B\,b^2\bigr)N^2.$$

# %%
averaged = g_1 * shift * N + (c + f * b + B * b**2 / 2) * N**2

# %% [markdown]
# By Hamilton's principle it is stationary in $b$ and in $N$; the equation of the phase conserves the wave action $g'N$. Hence
# $b=-f/B$ and $\delta=-(2c-f^2/B)\,N/g'$,

# %%
forced = -f / B
prove(averaged.diff(b).subs(b, forced), 0, "the forced response", names=r"\partial_b\langle L\rangle")
moved = -2 * (c - f**2 / (2 * B)) * N / g_1
prove(
    averaged.diff(N).subs({b: forced, shift: moved}),
    0,
    "the shift of the frequency",
    names=r"\partial_N\langle L\rangle",
)

# %% [markdown]
# In a cell $k$ steps away each product of exponentials has the factor $e^{ikqm}$, $m$ its multiple of $\theta$, and a time
# derivative is $-i\omega m$: $c$, $f$ and $B$ are read from the exact Lagrangian as a polynomial, with the bars' lengths put in
# as a series.
#
# ## A case in closed form
#
# For $q=0$ all rotors have the same tilt, the springs between them are not strained, and each rotor is a heavy top. At the tilt
# $\sin\vartheta=a$ it precesses steadily, with the Lagrangian (spin and precession in the same sense)

# %%
C = sp.Symbol("C", positive=True)  # cos of the lean
top = A * omega**2 * (1 - C**2) / 2 + G * omega * (1 - C) * -1 - weight * C
steady = A * C * omega**2 - G * omega + weight
prove(
    -top.diff(C),
    steady,
    "stationary: the steady precession of a heavy top, w = g S",
    names=r"-\partial_C\langle L\rangle",
)

# %% [markdown]
# With $C=1-\tfrac12a^2+\dots$ its rates $\omega_\pm=\bigl(G\pm\sqrt{G^2-4AwC}\bigr)/2AC$ begin as

# %%
root = sp.Symbol("R", positive=True)  # sqrt(G² − 4 A w)
upright = [(G + sign * root) / (2 * A) for sign in (1, -1)]
by_lean = [steady.diff(C).subs(omega, rate) / -2 for rate in upright]
slopes = [steady.diff(omega).subs({C: 1, omega: rate}) for rate in upright]
laws = [sign * A * rate**2 / (2 * root) for sign, rate in zip((1, -1), upright, strict=True)]
prove(
    [-c / slope for c, slope in zip(by_lean, slopes, strict=True)],
    laws,
    "the shifts of the heavy top over a², R² = G² − 4 A w",
    names=(r"\omega_{+,2}", r"\omega_{-,2}"),
)

# %% [markdown]
# The expansion of the waves gives the same:

# %%
row = straight_row(spring=31.0, spins=26.0, gravity=9.81, load=0.4)
alone = coefficients(row.piece(1))
numbers = {A: alone.A[0], G: alone.G[0], weight: 9.81 * alone.S[0]}
numbers[root] = np.sqrt(numbers[G] ** 2 - 4 * numbers[A] * numbers[weight])
closed = np.array([float(law.subs(numbers)) for law in laws])
expanded = np.array([row.nonlinear_wave(0.0, band).shift for band in (1, 0)])
assert np.abs(expanded / closed - 1).max() < 1e-9
Remark(
    "A row of heavy tops in phase",
    f"For the two rates the expansion gives the shifts {expanded[0]:.5f} a² and −{-expanded[1]:.5f} a² rad/s. Their relative "
    f"difference from the closed form is at most {np.abs(expanded / closed - 1).max():.0e}.",
)

# %% [markdown]
# ## Rings, compared with the exact motion
#
# A regular polygon of rotors closes after $2\pi/q$ cells if $q$ is a multiple of $2\pi/n$. The exact run starts from the wave
# through second order. Its frequency is the slope of the phase of its symplectic product with the linear wave.

# %%
ring = polygon_ring(7, spins=17.0, hinge=45.0, link=Link(mass=0.15, inertia=0.03))
amplitudes = (0.03, 0.045, 0.068)


def rates_seen(pattern: object, count: int, turns: int, band: int) -> tuple[object, np.ndarray, np.ndarray]:
    """The wave, and amplitudes and rates of exact runs of 15 of its turns."""
    wave = pattern.nonlinear_wave(2 * np.pi * turns / count, band)
    t = np.linspace(0, 30 * np.pi / wave.rate, 601)
    weight, seen = np.hanning(len(t) + 2)[1:-1], []
    for amplitude in amplitudes:
        run = pattern.piece(count).simulate(t, *wave.state(count, amplitude=amplitude), tol=1e-6)
        part = wave_amplitude(pattern, run, (count,), wave.q, band)
        seen.append(
            (np.average(np.abs(part), weights=weight), -np.polyfit(t, np.unwrap(np.angle(part)), 1, w=weight)[0])
        )
    return wave, *np.transpose(seen)


ROWS = (
    ("with bars, three turns of phase", 3, ring),
    ("of springs, one turn", 1, polygon_ring(7, spring=35.0, spins=17.0, hinge=45.0)),
)
orders, found = {}, []
for name, turns, pattern in ROWS:
    wave, sizes, rates = rates_seen(pattern, 7, turns, 0)
    orders[name] = measured_order(sizes, np.abs(rates - wave.rate_at(0) - wave.shift * sizes**2))
    assert abs(orders[name] - 4) < 0.1
    found.append(
        f"{name.capitalize()}: the wave has the rate {wave.rate:.4f} rad/s and the shift −{-wave.shift:.4f} a² rad/s; "
        "in exact runs of "
        f"amplitudes {', '.join(f'{x:.3f}' for x in sizes)} the remaining error is proportional to a to the power "
        f"{orders[name]:.2f} (expected 4)."
    )
Remark("Rings of seven rotors", " ".join(found))

# %% [markdown]
# ## Three waves
#
# Where $q_1+q_2=q_3$ and $\omega_1+\omega_2=\omega_3$ the mean of the cubic terms is $v\,z_1z_2\bar z_3+\text{c.c.}$, and with
# $\langle L\rangle=\sum i\,g_j'\dot z_j\bar z_j+\dots$ the amplitudes change slowly:

# %%
z, w = sp.symbols("z_1:4"), sp.symbols(r"\bar{z}_1:4")
v, v_bar = sp.symbols(r"v \bar{v}")
g = sp.symbols("g_1:4", real=True, nonzero=True)
i = sp.I
change = (i * v_bar * z[2] * w[1] / g[0], i * v_bar * z[2] * w[0] / g[1], i * v * z[0] * z[1] / g[2])
back = (-i * v * w[2] * z[1] / g[0], -i * v * w[2] * z[0] / g[1], -i * v_bar * w[0] * w[1] / g[2])
cubic = v * z[0] * z[1] * w[2] + v_bar * w[0] * w[1] * z[2]
prove(
    [g[k] * change[k] for k in range(3)],
    [i * cubic.diff(w[k]) for k in range(3)],
    "the equations of the amplitudes",
    names=[rf"g_{k}\dot z_{k}" for k in (1, 2, 3)],
)

# %% [markdown]
# Waves 1 and 2 gain the action $g_j|z_j|^2$ that wave 3 loses (Manley & Rowe 1956):

# %%
action = [g[k] * (change[k] * w[k] + z[k] * back[k]) for k in range(3)]
prove(action[0] + action[2], 0, "actions 1 and 3", names=r"\dot N_1+\dot N_3")
prove(action[1] + action[2], 0, "actions 2 and 3", names=r"\dot N_2+\dot N_3")

# %% [markdown]
# If the energies $\omega_jg_j|z_j|^2$ have one sign, $N_1+N_3$ and $N_2+N_3$ bound all three waves. If waves 1 and 2 have the
# opposite sign of wave 3, the waves are unbounded and all grow, as in n6. A small wave 1 in the presence of wave 3 grows by

# %%
second = i * v_bar * z[2] * back[1] / g[0]
prove(second, v * v_bar * z[2] * w[2] / (g[0] * g[1]) * z[0], "with wave 3 constant", names=r"\ddot z_1")

# %% [markdown]
# at the rate $|v||z_3|/\sqrt{g_1g_2}$, which is real where $g_1g_2>0$: the pumped wave decays.

# %%
hexagon = polygon_ring(6, spring=30.0, spins=6.0, hinge=13.170295680965312)
triad = min(hexagon.three_waves(np.pi), key=lambda t: abs(t.q[1, 0] - 4 * np.pi / 3))
pumped, short = (0.012, 0.018, 0.027), []
for amplitude in pumped:
    growth = triad.growth(2, amplitude)
    parts = [
        hexagon.nonlinear_wave(triad.q[k], triad.bands[k]).state(6, amplitude=x) for k, x in ((0, 1e-6), (2, amplitude))
    ]
    t = np.linspace(0, 5 / growth, 401)
    run = hexagon.piece(6).simulate(t, *(one + other for one, other in zip(*parts, strict=True)), tol=1e-6)
    grown = np.abs(wave_amplitude(hexagon, run, (6,), triad.q[0], triad.bands[0]))
    short.append(1 - np.polyfit(t[200:], np.log(grown[200:]), 1)[0] / growth)
assert max(np.abs(short)) < 0.02
Remark(
    "A wave that decays into two",
    f"A hexagon of springs is tuned so that the waves of three, four and one turns of phase have the rates "
    f"{triad.rates[0]:.4f} + "
    f"{triad.rates[1]:.4f} = {triad.rates[2]:.4f} rad/s. The third wave, with the amplitude a, makes the first two grow at the "
    f"rate {triad.growth(2, 1.0):.4f} a 1/s. In exact runs with a = {', '.join(map(str, pumped))} the first wave grows at a rate "
    f"that is smaller by {', '.join(f'{100 * x:.2f} %' for x in short)}, because the three rates shift and no longer add up "
    "exactly.",
)

# %%
heavy = polygon_ring(6, spring=0.3, spins=7.2, gravity=9.81, load=0.3)
explosive = [t for m in range(6) for t in heavy.three_waves(np.pi / 3 * m) if t.explosive]
assert explosive and all(t.energy_signs == (-1, -1, 1) for t in explosive)
Remark(
    "Waves that grow together",
    "Under weight, near the critical spins, two slow precessions and a fast one whose rate is the sum of theirs can grow "
    f"together without bound, according to the terms of third order. A hexagon of springs under weight has {len(explosive)} such "
    f"triads at its own wave numbers; the first has the rates {explosive[0].rates[0]:.3f} + {explosive[0].rates[1]:.3f} = "
    f"{explosive[0].rates[2]:.3f} rad/s.",
)
