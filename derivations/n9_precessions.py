# %% [markdown]
# # Precessions at finite tilt
#
# **Objective.** Each mode of a structure continues as a precession at finite tilt. Its frequency, and the tilt up to which it is
# stable.
#
# **Assumptions.** Rotors and bars without friction, upright at rest, every mode an oscillation; small tilts, compared with
# the exact motion. Each mode of a simple frequency continues as a family of periodic motions if no multiple of its frequency
# is another mode's (Lyapunov 1907); for equal frequencies see Weinstein (1973) and Moser (1976). The precession and nutation
# of one top: Routh, Advanced Rigid Dynamics, § 207. The coefficients for rotors and bars are new, as far as we know.
#
# **Notation.** $I_k=|z_k|^2$ the actions of the normal coordinates, $\{z_k,\bar z_k\}=-i$, $\omega_k$ their rates with the sign
# of their energy; $\tau$ the tilt (its sine) of the axis that moves most; $\Omega$ the rate and $T=2\pi/\Omega$ the period of
# the precession of mode $j$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Structure
from lagrotor.numerics import measured_order
from lagrotor.paper import Remark, prove
from lagrotor.structures.coefficients import coefficients

tau, ell, R, phi, A, G, w, p = sp.symbols("tau ell R phi A G w p", positive=True)
b, omega, curvature = sp.symbols("b omega_j A_jj", real=True)

# %% [markdown]
# ## A periodic motion that is no steady rotation
#
# The precession of one top is steady: it is at rest in a rotating frame. The joints of a bar are fixed in space. If all axes were
# rotated about the vertical by $\phi$, the distance $|\ell e_x+R(r_2-r_1)|$ of two tips would change at the rate

# %%
x, y, z = sp.symbols("x y z", real=True)  # of r_2 − r_1
turned = sp.Matrix([x * sp.cos(phi) - y * sp.sin(phi), x * sp.sin(phi) + y * sp.cos(phi), z])
apart = sp.Matrix([ell, 0, 0]) + R * turned
prove(
    sp.expand(apart.dot(apart)).diff(phi),
    -2 * ell * R * (x * sp.sin(phi) + y * sp.cos(phi)),
    "a common rotation changes a bar's length",
    names=r"\partial_\phi|\ell e_x+R(r_2-r_1)|^2",
)

# %% [markdown]
# so that with bars the motion is at rest in no frame. The precession is a periodic motion: all axes return after $T$.
#
# ## The rate
#
# In the normal form through fourth order the plane of mode $j$ is invariant where no multiple of $\omega_j$ is another rate,
# as each term linear in another $z_k$ has been removed. There $H=\omega_jI+\tfrac12A_{jj}I^2$, and $\Omega=\partial
# H/\partial I$. The tilt of the axis that moves most is $a\cos\Omega t$ with $a=p\sqrt I$. The responses forced at the
# frequencies 0 and $2\Omega$ add $b\,a^2$ at the extreme:

# %%
I = sp.Symbol("I", positive=True)
amplitude = tau - b * tau**2
turning = (omega * I + curvature * I**2 / 2).diff(I).subs(I, amplitude**2 / p**2)
second = curvature / p**2
law = omega + second * (tau**2 - 2 * b * tau**3)
prove(
    sp.series(turning, tau, 0, 4).removeO(),
    law,
    "the rate through third order, ω_j2 = A_jj/p²",
    names=r"\Omega",
    equations=r"\Omega=\omega_j+\omega_{j2}(\tau^2-2b\tau^3)+O(\tau^4)",
)

# %% [markdown]
# For one top $A\Omega^2\cos\vartheta-G\Omega+w=0$ with $w=gS$ and $\sin\vartheta=\tau$; in the upright limit the rates are
# $\omega_\pm$. The nutation about this precession has $\nu^2=\Omega^2-2(w/A)\cos\vartheta+(w/A\Omega)^2$, in the upright
# limit the difference of the two rates:

# %%
root = sp.Symbol("r", positive=True)  # sqrt(G² − 4 A w)
fast, slow = ((G + sign * root) / (2 * A) for sign in (1, -1))
pull = (G**2 - root**2) / (4 * A)
nutation = [rate**2 - 2 * pull / A + (pull / (A * rate)) ** 2 for rate in (fast, slow)]
prove(
    [sp.cancel(square) for square in nutation],
    [sp.cancel((fast - slow) ** 2)] * 2,
    "Routh's nutation in the limit of zero tilt",
    names=(r"\nu_+^2", r"\nu_-^2"),
)

# %% [markdown]
# and $e^{2\pi i\nu/\Omega}$ is the multiplier $e^{2\pi i\omega_k/\omega_j}$ of the other mode.

# %%
top = Structure([(0, 0)], spins=15.0, gravity=9.81, load=0.35)
alone, laws = coefficients(top), [top.precession_law(mode) for mode in (0, 1)]
size = 1e-3


def routh(rate_sign: int, tilt: float) -> tuple[float, float]:
    """Ω and ν of a top."""
    inertia, spin, weight, cosine = alone.A[0], alone.G[0], 9.81 * alone.S[0], np.sqrt(1 - tilt**2)
    rate = (spin + rate_sign * np.sqrt(spin**2 - 4 * inertia * cosine * weight)) / (2 * inertia * cosine)
    return rate, np.sqrt(rate**2 - 2 * weight / inertia * cosine + (weight / (inertia * rate)) ** 2)


off = []
for rate_sign, one in zip((-1, 1), laws, strict=True):
    closed = (routh(rate_sign, size)[0] - routh(rate_sign, 0.0)[0]) / size**2
    angles = [2 * np.pi * np.divide(*routh(rate_sign, tilt)[::-1]) for tilt in (0.0, size)]
    ends = [max(one.multipliers_at(tilt), key=lambda m: m.imag) for tilt in (0.0, size)]
    off += [one.shift / closed - 1, abs(np.angle(ends[1] / ends[0])) / abs(angles[1] - angles[0]) - 1]
assert max(map(abs, off)) < 1e-4
Remark(
    "One top",
    f"The shifts of its two rates are −{-laws[0].shift:.5f} τ² and {laws[1].shift:.5f} τ² rad/s. These and the shifts of both "
    "multipliers equal Routh's closed forms.",
)

# %% [markdown]
# ## The multipliers
#
# During the precession another mode has the frequency $\omega_k+A_{jk}I_j$, and after $T$ the multipliers $e^{\pm
# iT(\omega_k+A_{jk}I_j)}$, on the unit circle. Two other modes may be coupled by nearly resonant terms. In a frame that
# rotates with the precession let $\Delta_k$ and $\Delta_l$ be their detunings. Terms
# $g(\zeta_k\zeta_l+\bar\zeta_k\bar\zeta_l)$, $g=|c|I_j^{m/2}$, of rates that add up to $m|\omega_j|$, give

# %%
D_k, D_l, g, mu = sp.symbols("Delta_k Delta_l g mu", real=True)
i, delta = sp.I, D_k + D_l
(u, u_bar), (v, v_bar) = sp.symbols(r"zeta_k \bar{zeta}_k"), sp.symbols(r"zeta_l \bar{zeta}_l")
added = D_k * u * u_bar + D_l * v * v_bar + g * (u * v + u_bar * v_bar)
slopes = sp.Matrix([-i * added.diff(u_bar), i * added.diff(v)]).jacobian([u, v_bar])
prove(
    ((mu - i * (D_k - D_l) / 2) * sp.eye(2) - slopes).det(),
    mu**2 - g**2 + delta**2 / 4,
    "of rates that add up: growth where g exceeds half of δ = Δ_k + Δ_l, at the rate μ",
    names=r"\det\bigl((\mu-\tfrac i2(\Delta_k-\Delta_l))-\partial(\dot\zeta_k,\dot{\bar\zeta}_l)\bigr)",
)

# %%
taken = D_k * u * u_bar + D_l * v * v_bar + g * (u * v_bar + u_bar * v)
slopes = sp.Matrix([-i * taken.diff(u_bar), -i * taken.diff(v_bar)]).jacobian([u, v])
prove(
    ((mu - i * delta / 2) * sp.eye(2) - slopes).det(),
    mu**2 + g**2 + (D_k - D_l) ** 2 / 4,
    "of rates of which one is the other and Ω: none, μ² is negative",
    names=r"\det\bigl((\mu-\tfrac i2\delta)-\partial(\dot\zeta_k,\dot\zeta_l)\bigr)",
)

# %% [markdown]
# The sign of $\omega_k$ is the sign of the energy, so the frequencies add up with their signs:
# $|\omega_k+\omega_l|=m|\omega_j|$. Modes of positive energy exchange energy with the precession. Two modes of negative
# energy, $\omega_j=|\omega_k|+|\omega_l|$ under weight, grow together with it. For $m=1$, $g=|c|\sqrt I$, the edge is
# $|c|\sqrt I=|\delta|/2$, a tilt proportional to the detuning. Beyond it the square of the growth is linear in $\tau^2$:

# %%
c, miss = sp.symbols("c delta", positive=True)
growth = sp.sqrt(c**2 * tau**2 / p**2 - miss**2 / 4)
edge = miss * p / (2 * c)
prove(growth.subs(tau, edge), 0, "the edge to leading order", names=r"\mu")

# %%
prove((growth**2).diff(tau, 2), 2 * c**2 / p**2, "the square of the growth", names=r"\partial_\tau^2\mu^2")

# %% [markdown]
# ## Measured on exact orbits
#
# Periodic orbits of the exact motion, by shooting, and their multipliers; parameters used nowhere else.

# %%
TILTS = (0.01, 0.015, 0.0225)
BARS = [(0, 1), (1, 2)]
STRUCTURES = {
    "a triangle on hinges": (
        Structure(
            [(0, 0), (1.1, 0), (0.4, 0.8)], [*BARS, (2, 0)], [8, -13, 5], hinge=35.0, link=Link(mass=0.2, inertia=0.04)
        ),
        0,
    ),
    "two unequal spins on unequal hinges": (Structure([(0, 0), (0.9, 0)], BARS[:1], [14, -6], hinge=(30.0, 18.0)), 1),
    "a corner under weight": (
        Structure([(0, 0), (1, 0), (1.4, 0.9)], BARS, [43, 8, 51], gravity=9.81, load=1.5),
        3,
    ),
}


def farthest(some: np.ndarray, of: np.ndarray) -> float:
    """The largest distance of a number from the nearest of others."""
    return float(np.abs(np.subtract.outer(some, of)).min(1).max())


measured = {}
for name, (structure, mode) in STRUCTURES.items():
    one = structure.precession_law(mode)
    linear = np.exp(2j * np.pi / one.rate * np.concatenate([one.others, -one.others]))
    left = []
    for tilt in TILTS:
        orbit = structure.steady_precession(mode, tilt)
        rate = 2 * np.pi / orbit.period
        left.append(
            (
                abs(rate - one.rate),
                abs(rate - one.rate_at(tilt)),
                farthest(orbit.multipliers[2:], linear),
                farthest(orbit.multipliers[2:], one.multipliers_at(tilt)),
            )
        )
    measured[name] = tuple(measured_order(TILTS, part) for part in np.transpose(left))
    assert np.abs(np.subtract(measured[name], (2, 4, 2, 4))).max() < 0.1, (name, measured[name])
Remark(
    "Orders",
    "The errors of four predictions are proportional to powers of the tilt: of the upright frequency (expected exponent 2), of "
    "the frequency with its shift (4), of the upright multipliers (2) and of the multipliers with their shifts (4). The measured "
    "exponents are "
    + "; ".join(f"{', '.join(f'{order:.2f}' for order in orders)} for {name}" for name, orders in measured.items())
    + ".",
)

# %% [markdown]
# ## The edge of stability
#
# In this triangle on hinges the largest frequency is nearly the sum of the two others. The exact edge is the zero of the line
# through the squares of two growth rates beyond it.

# %%
near = Structure([(0, 0), (1, 0), (0.3, 0.9)], [*BARS, (2, 0)], [-6.5, 7.7, 7.5], hinge=20.0)
said = near.precession_law(2)
law_edge = said.edge
beyond = np.array([1.1, 1.3]) * said.edge
grown = [near.steady_precession(2, tilt).growth for tilt in beyond]
(first, last), (low, high) = np.square(grown), np.square(beyond)
seen = float(np.sqrt(low - first * (high - low) / (last - first)))
assert abs(seen / said.edge - 1) < 0.05 and near.steady_precession(2, 0.9 * said.edge).growth == 0
Remark(
    "The edge of stability",
    f"The triangle has the rates {', '.join(f'{rate:.4f}' for rate in near.modes().rates)} rad/s. Its fastest precession is "
    f"stable up to a tilt of {said.edge:.4f} according to the law and of {seen:.4f} on exact orbits. At a tilt of "
    f"{beyond[1]:.4f} the exact growth exponent of a perturbation is {grown[1]:.4f} per turn; the law gives "
    f"{said.growth_at(beyond[1]):.4f}.",
)
