# %% [markdown]
# # Resonances of structures stabilised by spins
#
# **Objective.** A structure that is stable to first order can be unstable to arbitrarily small pushes: the resonances, the pushes
# and the times.
#
# **Assumptions.** Rotors under weight, stabilised by their spins, without friction; motion about upright through the terms of
# third order, compared with the exact motion. Cherry, Trans. Camb. Phil. Soc. 23 (1925) 199; Kelvin & Tait, Natural
# Philosophy, § 345.
#
# **Notation.** $a$ the inertia of a degree of freedom, $\kappa$ the moment of its weight, $\beta$ the spins' coupling of two;
# $z_j$ the normal coordinates, $\{z_j,\bar z_j\}=-i$, $\omega_j$ their rates with the sign of their energy, $N=\sum|z_j|^2$.

# %%
from dataclasses import replace

import numpy as np
import sympy as sp

from lagrotor import Structure
from lagrotor.numerics import measured_order
from lagrotor.paper import Remark, prove
from lagrotor.structures import local_hamiltonian, measured_fall, resonant_factors

a, kappa, beta, rho, c, delta, f = sp.symbols("a kappa beta rho c delta f", positive=True)
fast, slow = ((beta + sign * sp.sqrt(beta**2 - 4 * a * kappa)) / (2 * a) for sign in (1, -1))

# %% [markdown]
# ## Signs of energy
#
# Two degrees of freedom that are unstable under weight, coupled by the spins, have the rates of
# $a\omega^2-\beta\omega+\kappa=0$. A circular motion of radius $\rho$ has the energy $\tfrac12(a\omega^2-\kappa)\rho^2$,
# because the spins do no work. With the two rates

# %%
prove(sp.expand(fast * slow), kappa / a, "the product of the rates", names=r"\omega_f\omega_s")

# %% [markdown]
# the slow precession has a rate below $\sqrt{\kappa/a}$ and less energy than the rest state; the fast one has more. A slow
# precession therefore grows if it loses energy. The fast rate is twice the slow one if the spins exceed the critical ones,
# $\beta=2\sqrt{a\kappa}$, by

# %%
at_resonance = {beta: 2 * sp.sqrt(a * kappa) * f}
ratio = (fast / slow).subs(at_resonance)
prove(ratio.subs(f, 3 / sp.sqrt(8)), 2, "fast = 2 × slow at 3/√8 times the critical spins", names=r"\omega_f/\omega_s")
prove(ratio.subs(f, 2 / sp.sqrt(3)), 3, "and fast = 3 × slow, of fourth order, at 2/√3", names=r"\omega_f/\omega_s")

# %% [markdown]
# ## Three resonant waves
#
# With rates of signed energy, $H=\sum\omega_j|z_j|^2+\dots$, and $\omega_1+\omega_2+\omega_3=0$, the terms $P=c\,z_1z_2z_3$ and
# $\bar P$ cannot be removed by a canonical transformation. Of them

# %%
z, w = sp.symbols("z_1:4"), sp.symbols(r"\bar{z}_1:4")


def bracket(left: sp.Expr, right: sp.Expr) -> sp.Expr:
    """{f, g} with {z_j, z̄_j} = −i."""
    pairs = zip(z, w, strict=True)
    return sp.expand(-sp.I * sum(left.diff(p) * right.diff(q) - left.diff(q) * right.diff(p) for p, q in pairs))


P, P_bar = c * sp.Mul(*z), c * sp.Mul(*w)
actions = [p * q for p, q in zip(z, w, strict=True)]
prove(
    [bracket(action, P + P_bar) for action in actions],
    [sp.I * (P - P_bar)] * 3,
    "the actions grow at the same rate",
    names=[rf"\{{|z_{j}|^2,P+\bar P\}}" for j in (1, 2, 3)],
)

# %%
prove(
    bracket(sum(actions), P + P_bar),
    3 * sp.I * (P - P_bar),
    "their sum grows at −6 Im P and is unbounded",
    names=r"\dot N",
)

# %% [markdown]
# If one of the signs were different, the sum of two actions would be conserved and would bound them. For any $P$ of third degree,
# with $c$ the largest $|P|$ at $N=1$, Euler's theorem on homogeneous functions gives $|\dot N|\le6cN^{3/2}$. From $N=\rho^2$ no
# motion therefore diverges before the time at which

# %%
t = sp.Symbol("t", nonnegative=True)
size = rho / (1 - 3 * c * rho * t)
prove(
    (size**2).diff(t), 6 * c * size**3, "the steepest growth, N = size²", names=r"\dot N", equations=r"\dot N=6cN^{3/2}"
)

# %% [markdown]
# is infinite, $t=1/(3c\rho)$, inversely proportional to the push. Cherry's example has a solution in closed form. Its
# Hamiltonian is $H=\tfrac12(q_1^2+p_1^2)-(q_2^2+p_2^2)+\tfrac12\bigl(2q_1p_1p_2-q_2(q_1^2-p_1^2)\bigr)$, linearly stable:

# %%
tau, gamma = sp.symbols("tau gamma", real=True)
q_1, q_2, p_1, p_2 = sp.symbols("q_1 q_2 p_1 p_2", real=True)
cherry = (q_1**2 + p_1**2) / 2 - (q_2**2 + p_2**2) + (2 * q_1 * p_1 * p_2 - q_2 * (q_1**2 - p_1**2)) / 2
left = tau - t
falling = {
    q_1: sp.sqrt(2) * sp.sin(t + gamma) / left,
    p_1: sp.sqrt(2) * sp.cos(t + gamma) / left,
    q_2: sp.sin(2 * (t + gamma)) / left,
    p_2: -sp.cos(2 * (t + gamma)) / left,
}
pairs = ((q_1, p_1), (q_2, p_2))
prove(
    [falling[letter].diff(t) for pair in pairs for letter in pair],
    [side for q, p in pairs for side in (cherry.diff(p).subs(falling), -cherry.diff(q).subs(falling))],
    "Cherry's solution",
    names=[rf"\dot{{{letter}}}" for pair in pairs for letter in pair],
)

# %% [markdown]
# ## Near the resonance
#
# With the detuning $\delta=k\cdot\omega$, $\tfrac13\delta N+2\operatorname{Re}P$ is conserved, and
# $2|\operatorname{Re}P|\le2cN^{3/2}$. Its minimum at given $N$ has a barrier at $N=\delta^2/81c^2$:

# %%
N = sp.Symbol("N", positive=True)
lowest = delta * N / 3 - 2 * c * N ** sp.Rational(3, 2)
barrier = (delta / (9 * c)) ** 2
prove(lowest.diff(N).subs(N, barrier), 0, "the barrier", names=r"\partial_N(\tfrac13\delta N-2cN^{3/2})")

# %% [markdown]
# and a motion that starts at $\rho$, where the conserved quantity is at most $\tfrac13\delta\rho^2+2c\rho^3$, cannot pass it for

# %%
edge = delta / (18 * c)
prove(
    delta * edge**2 / 3 + 2 * c * edge**3,
    lowest.subs(N, barrier),
    "the largest push that stays bounded in any direction: ρ = δ/(18 c)",
    names=r"\tfrac13\delta\rho^2+2c\rho^3",
)

# %% [markdown]
# ## The corner of three
#
# The middle rotor does not spin, the two others do, and the bars form a right angle: four degrees of freedom in two equal
# pairs. The expansion of the Lagrangian gives rates, coefficient and largest push, all in units of $\sqrt{\kappa/a}$.

# %%
corner = Structure(joints=[(0, 0), (1, 0), (1, 1)], bars=[(0, 1), (1, 2)], spins=[1, 0, 1], gravity=9.81, load=2.0)
critical = corner.critical_spin()
rate = local_hamiltonian(corner).rate
(third, resonance), *_ = resonant_factors(corner, (3,))
(fourth, slower), *_ = resonant_factors(corner, (4,))
assert abs(third / critical - 3 / np.sqrt(8)) < 1e-6 and abs(fourth / critical - 2 / np.sqrt(3)) < 1e-6
at_third = replace(corner, spins=[third, 0, third])
standing = at_third.stands()
assert standing and standing.kind == "falls at a resonance"

direction = np.array([[0.151, -0.931], [0.151, -0.149], [0.205, -0.149]])
pushes = (0.04, 0.02, 0.01)
said = [standing.fall_time(push * rate * direction) * rate for push in pushes]
seen = [measured_fall(at_third, push * rate * direction, 2 / (push * rate)) * rate for push in pushes]
slope = float(np.polyfit(np.log(pushes), np.log(seen), 1)[0])
assert abs(slope + 1) < 0.1 and all(abs(x - y) < 5 for x, y in zip(said, seen, strict=True))
Remark(
    "At the resonance any push makes the corner fall",
    f"At {third / critical:.4f} times the critical spins the slow precessions of the corner have the rate "
    f"{-resonance.rates[0] / rate:.4f} √(κ/a), the fast ones {resonance.rates[-1] / rate:.4f} √(κ/a), and the coefficient of "
    f"third order is c = {resonance.growth / rate:.4f} √(κ/a). No push of {pushes[-1]} √(κ/a) makes the corner fall before "
    f"{standing.fall_time(pushes[-1] * rate) * rate:.1f} √(a/κ). After pushes of {', '.join(map(str, pushes))} √(κ/a) in one "
    f"direction it falls after {', '.join(f'{x:.1f}' for x in seen)} √(a/κ) in exact runs and after "
    f"{', '.join(f'{x:.1f}' for x in said)} √(a/κ) according to the normal form of fourth order. The exact time is proportional "
    f"to the push to the power −{-slope:.3f} (expected −1).",
)

# %%
low, high = resonance.window(0.01 * rate)
Remark(
    "The width of the resonance",
    f"A push of 0.01 √(κ/a) can make the corner fall between {low / critical:.4f} and {high / critical:.4f} times the critical "
    "spins. This interval is wider for larger pushes. "
    f"At {fourth / critical:.4f} times the critical spins the sum of three slow rates is a fast one. There the terms of fourth "
    "order make the corner fall more slowly, in a time proportional to one divided by the square of the push: after a "
    "push of 0.06 "
    f"√(κ/a) it does not fall before {slower.least_time(0.06 * rate) * rate:.0f} √(a/κ).",
)

# %%
equal = replace(corner, spins=1)
holding = replace(equal, spins=1.0607 * equal.critical_spin()).stands()
assert holding.kind == "holds"
Remark(
    "With equal spins the corner does not fall by this resonance",
    "If all three spins of the corner are equal, the rates add up at the same factor 1.0607, but the coefficient of third order "
    f"is zero. At 1.0607 times the critical spins no push below {holding.resonance.push() / rate:.2f} √(κ/a) makes it fall.",
)

# %% [markdown]
# ## The time of stability
#
# In the coordinates of the normal form through order $N$ the remainder begins with degree $N+1$, or with the degree $d\le N$
# of the resonant terms. A term $c\,z^\alpha\bar z^\beta$ changes $Q=\sum_j|z_j|^2$ by $|\dot
# Q|\le\big||\alpha|-|\beta|\big|\,|c|\,|z|^d$. With $g_d$ the sum of these coefficients in degree $d$,
#
# $$|\dot Q|\le\sum_d g_d\,Q^{d/2},\qquad t\ge\int_{\rho^2}^{2\rho^2}\frac{dQ}{\sum_d g_dQ^{d/2}},$$
#
# without resonances $g_d=0$ but for $d=N+1$:

# %%
g, Q, rho = sp.symbols("g Q rho", positive=True)
degree = 6
alone = sp.integrate(1 / (g * Q ** sp.Rational(degree, 2)), (Q, rho**2, 2 * rho**2))
prove(alone, sp.Rational(3, 8) / (g * rho**4), "the time to double without resonances, N = 5", names="t")

# %%
unequal = replace(corner, spins=(1, 0.3, 1.2))
unequal = replace(unequal, spins=tuple(1.5 * unequal.critical_spin() * w for w in unequal.spins))
unit = unequal.modes().rates.max()
small, times = (0.0005, 0.001, 0.002), []
for push in small:
    times.append(unequal.stands().hold_time(push * rate) * unit / (2 * np.pi))
assert abs(measured_order(small, times) + 4) < 0.1
Remark(
    "The time of stability",
    "The spins are in the ratio 1 : 0.3 : 1.2 and 1.5 times the critical ones, where no resonance is near. According "
    "to the normal "
    f"form of fifth order the motion after a push of {', '.join(f'{push:g}' for push in small)} √(κ/a) stays below √2 times its "
    f"initial size for at least {', '.join(f'{time:.1e}' for time in times)} turns of the fastest mode. This time is "
    "proportional "
    f"to the push to the power −{-measured_order(small, times):.2f} (expected −4).",
)
