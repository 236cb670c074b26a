# %% [markdown]
# # The limit of fast spins
#
# **Objective.** The limit of fast spins: equations of first order, their error, and the published lattices of hanging
# gyroscopes as a special case.
#
# **Assumptions.** Small motion about upright (or hanging) axes, without friction. Nash, Kleckner, Read, Vitelli, Turner & Irvine,
# PNAS 112, 14495 (2015).
#
# **Notation.** $a$ the inertia of an axis, $G$ its momentum, $\kappa$ its stiffness (hinge or weight), $k$ the stiffness of a
# spring between tips, lengths of axes 1; $\psi=x+iy$ of an axis; $\delta$ the angle between one bond and the two others of a
# honeycomb.

# %%
from dataclasses import replace

import numpy as np
import sympy as sp

from lagrotor import Structure
from lagrotor.numerics import measured_order
from lagrotor.paper import Remark, prove
from lagrotor.structures import honeycomb
from lagrotor.structures.waves.chern import chern_numbers

a, kappa, k, G, omega, epsilon = sp.symbols("a kappa k G omega epsilon", positive=True)
x, y, theta, delta = sp.symbols("x y theta delta", real=True)
i = sp.I

# %% [markdown]
# ## Slow precessions
#
# One axis, $au''+Cu'+\kappa u=0$, precesses at the rates of $a\omega^2+G\omega-\kappa=0$; one of them is slow. With
# $\epsilon=a\kappa/G^2$

# %%
slow = (sp.sqrt(G**2 + 4 * a * kappa) - G) / (2 * a)
in_limit = kappa / G
prove(
    slow.subs(a, epsilon * G**2 / kappa),
    in_limit * (1 - epsilon),
    "the slow precession: κ/G, with the relative error $\\epsilon$",
    small=epsilon,
    order=1,
    names=r"\omega",
)

# %% [markdown]
# For any network $-\omega^2M-i\omega C+K$ has, from $(K-i\omega_0C)u=0$, the slow rate $\omega_0-\omega_0^2\,u^\dagger
# Mu/|u^\dagger Cu|+\dots$, and the limit keeps the first term. It has no fast precessions, whose rates are about $G/a$.

# %%
network = Structure(
    joints=[(0, 0), (1, 0.1), (0.5, 0.9), (1.6, 0.8)],
    braces=[(0, 1, 6.0), (1, 2, 5.0), (0, 2, 8.0), (1, 3, 7.0), (2, 3, 4.0)],
    spins=[1.0, 1.2, -0.9, 1.1],
    gravity=-9.81,
)
factors, off, rest = (30.0, 60.0, 120.0), [], []
for factor in factors:
    s = replace(network, spins=tuple(factor * w for w in network.spins))
    limit, whole = s.modes(inertia=False), np.sort(s.modes().rates)[:4]
    rising = np.argsort(limit.rates)
    off.append(float(np.abs(limit.rates[rising] / whole - 1).max()))
    rest.append(float(np.abs((limit.rates - limit.left_out)[rising] / whole - 1).max()))
powers = [measured_order(factors, errors) for errors in (off, rest)]
assert abs(powers[0] + 2) < 0.1 and abs(powers[1] + 4) < 0.1
Remark(
    "The error of the limit",
    "Four hanging gyroscopes are joined by five springs; their spins are in the ratio 1 : 1.2 : −0.9 : 1.1. If the first spin is "
    f"{', '.join(f'{f:g}' for f in factors)} rad/s, the slow rates in the limit have the relative errors "
    f"{', '.join(f'{e:.1e}' for e in off)}, proportional to the spins to the power −{-powers[0]:.2f}. With the next term the "
    f"errors are {', '.join(f'{e:.1e}' for e in rest)}, proportional to the power −{-powers[1]:.2f}.",
)

# %% [markdown]
# ## The published equation
#
# A spring along $n=(\cos\theta,\sin\theta)$ pulls by $-k\,n\,(n\cdot u)$, as a complex number

# %%
psi = x + i * y
along = (x * sp.cos(theta) + y * sp.sin(theta)) * (sp.cos(theta) + i * sp.sin(theta))
turn = sp.cos(2 * theta) + i * sp.sin(2 * theta)
prove(along, (psi + turn * sp.conjugate(psi)) / 2, "a spring", names=r"n\,(n\cdot u)")

# %% [markdown]
# and $Cu'$ is $-iG\psi'$, so that the limit is $i\psi_p'=\Omega_g\psi_p+\tfrac12\sum\Omega_k\bigl((\psi_p-\psi_q)+e^{2i\theta}
# (\psi_p-\psi_q)^*\bigr)$, $\Omega_g=\kappa/G$, $\Omega_k=k/G$: equation 1 of Nash et al. On a honeycomb the springs of one
# tip add up to $\tfrac32k$ in all directions (n5): at $q=0$ the two axes of a cell have equal or opposite tilts,

# %%
mu = kappa + sp.Rational(3, 2) * k
own = sp.Matrix([[mu, -i * omega * G], [i * omega * G, mu]])
between = -sp.Rational(3, 2) * k * sp.eye(2)
prove(
    sp.Matrix(sp.BlockMatrix([[own, between], [between, own]])).det(method="laplace"),
    (kappa**2 - omega**2 * G**2) * ((kappa + 3 * k) ** 2 - omega**2 * G**2),
    "the lowest and the highest rate",
    names=r"\det D(0)",
)

# %% [markdown]
# and at the corner $K$ of the zone (determinant in n5), with $a=0$

# %%
upper = mu / G
lower = sp.sqrt(kappa * (kappa + 3 * k)) / G
corner = (mu**2 - omega**2 * G**2) * (mu**2 - omega**2 * G**2 - sp.Rational(9, 4) * k**2)
prove(
    [corner.subs(omega, edge) for edge in (upper, lower)],
    [0, 0],
    "the edges of the gap are waves at K",
    names=(r"\det D(K)_{\omega=\omega_+}", r"\det D(K)_{\omega=\omega_-}"),
)

# %%
weight, spring, spin = 9.81 / 2, 8.0, 30.0
hanging = {"spring": spring, "gravity": -9.81, "spins": spin, "inertia": False}
grid = 2 * np.pi * np.stack(np.meshgrid(*[np.arange(12) / 12] * 2), -1).reshape(-1, 2)
low, high = honeycomb(**hanging).dispersion(grid).gaps[1]
numbers = {kappa: weight, k: spring, G: spin}
assert abs(float(lower.subs(numbers)) - low) < 1e-9 and abs(float(upper.subs(numbers)) - high) < 1e-9
with_inertia = honeycomb(**hanging | {"inertia": True}).dispersion(grid).gaps[1]

# %% [markdown]
# ## The bond angle
#
# Two bonds of each gyroscope have the angles $\pm\delta$ to the third, $\theta=0$. The factors $e^{2i\theta}$ break time
# reversal: under $\psi\to\psi^*$ and $t\to-t$ the equation keeps its form if they are real.

# %%
sense = sp.sin(2 * delta)
prove(sense.subs(delta, sp.pi / 2), 0, "at right angles they are real", names=r"\operatorname{Im}e^{2i\delta}")

# %%
angles = (120, 105, 90, 75, 60)
found = {angle: chern_numbers(honeycomb(angle=np.radians(angle), **hanging), 12) for angle in angles}
assert [found[angle].numbers for angle in (120, 105)] == [(-1, 1)] * 2 and found[90].groups == ((0, 1),)
assert [found[angle].numbers for angle in (75, 60)] == [(1, -1)] * 2
Remark(
    "Hanging gyroscopes on a honeycomb",
    f"The moment of the weight is {weight:g} N m, springs have {spring:g} N/m, and the axial momenta are {spin:g} kg "
    "m²/s. In the "
    f"limit of fast spins there is a gap from {low:.4f} to {high:.4f} rad/s, which equals the closed form; with the transverse "
    f"inertia it is from {with_inertia[0]:.4f} to {with_inertia[1]:.4f} rad/s. The Chern numbers of the two bands are "
    + ", ".join(
        f"{' and '.join(f'{n:+d}'.replace('-', '−') for n in chern.numbers)} at a bond angle of {angle}°"
        for angle, chern in found.items()
        if len(chern.groups) > 1
    )
    + ". At 90° the bands touch, and the waves on the border reverse their direction, as Nash et al. found.",
)
