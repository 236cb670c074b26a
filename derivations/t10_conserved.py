# %% [markdown]
# # Conserved quantities of the pair
#
# **Objective.** The conserved quantities by Noether's theorem, checked on the exact models; the completeness of the list.
#
# **Assumptions.** No external force; any spins and any bar. The last two sections assume opposite spins.
#
# **Notation.** $E$ the energy, $G_i$ the axial momenta, $P$ the momentum about the joint line, which runs through both ground
# joints; $A$, $B$ the paper's integrals (5.12, 5.13); $r_i$ the axes; $a$, $b$ the inertias with the bar's share, $k=\ell/R$;
# Euler angles $\theta_i,\phi_i,\psi_i$; Mercator coordinates $u_i,\alpha_i$ about the joint line.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, floquet, simulate
from lagrotor.mechanics import System, energy
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order, swing
from lagrotor.pair import ansatz_A, joint_line_momentum, mercator_axis, mercator_lagrangian, pair_with_bar
from lagrotor.pair.notation import AXES, I3, MERCATOR, PAIR, k
from lagrotor.paper import Formula, Remark, prove

# %% [markdown]
# ## The spins
#
# The Lagrangian in Euler angles, with the bar's kinetic energy, and the bar's constraint are

# %%
whole = pair_with_bar()
Formula(whole.L, "L")

# %%
Formula(whole.constraints[0], "g")

# %% [markdown]
# Neither contains the spin angles:

# %%
psi_1, psi_2 = PAIR.q[2], PAIR.q[5]
prove(
    [e.diff(psi) for psi in (psi_1, psi_2) for e in (whole.L, *whole.constraints)],
    (0, 0, 0, 0),
    "the spin angles are cyclic, in the Lagrangian and in the bar's constraint",
    names=[rf"\partial {e} / \partial\psi_{i}" for i in (1, 2) for e in "Lg"],
)

# %% [markdown]
# Their momenta are therefore constant. These are the axial momenta $G_i=I_3(\dot\psi_i+\dot\phi_i\cos\theta_i)$:

# %%
theta_1, theta_2 = PAIR.q[0], PAIR.q[3]
spins = PAIR.v[2] + PAIR.v[1] * sp.cos(theta_1), PAIR.v[5] + PAIR.v[4] * sp.cos(theta_2)
prove(
    (whole.L.diff(PAIR.v[2]), whole.L.diff(PAIR.v[5])),
    tuple(I3 * spin for spin in spins),
    "the axial momenta",
    names=("G_1", "G_2"),
)

# %% [markdown]
# ## Rotation about the joint line
#
# The spins are eliminated (Routh), and the coordinates are Mercator coordinates. A rotation of both $\alpha_i$ by the same
# angle does not change the Lagrangian and the bar's constraint:

# %%
u1, al1, u2, al2 = MERCATOR.q
bar = sp.cosh(u1 - u2) - k * sp.sinh(u1 - u2) - sp.cos(al2 - al1)
reduced = System(MERCATOR, mercator_lagrangian(), (bar,))
prove(
    [e.diff(al1) + e.diff(al2) for e in (reduced.L, bar)],
    (0, 0),
    "rotation of both axes by the same angle changes neither the Lagrangian nor the bar's constraint",
    names=(r"\delta L", r"\delta g"),
)

# %% [markdown]
# A rotation in opposite senses changes the bar's constraint. Noether's theorem gives the momentum
# $P=\partial L/\partial\dot\alpha_1+\partial L/\partial\dot\alpha_2$. In Cartesian components of the axes it is the angular
# momentum about the joint line:

# %%
assert reduced.invariance((0, 1, 0, -1)).answer == "nonzero"
momentum = reduced.noether((0, 1, 0, 1)).expression
in_mercator = {}
for i, (u, al) in enumerate(((u1, al1), (u2, al2))):
    r = mercator_axis(u, al)
    rates = r.jacobian(MERCATOR.q) * sp.Matrix(MERCATOR.v)
    in_mercator |= dict(zip(AXES.q[3 * i : 3 * i + 3], r, strict=True))
    in_mercator |= dict(zip(AXES.v[3 * i : 3 * i + 3], rates, strict=True))
prove(
    momentum,
    joint_line_momentum().subs(in_mercator),
    "the momentum about the joint line",
    equations=r"P = \sum_i (a\,\dot r_i + b\,\dot r_j)\cdot(e_x\times r_i) + G_i\,x_i,\qquad j \neq i",
)

# %%
Formula(joint_line_momentum(), "P")

# %% [markdown]
# ## Time
#
# $L$ does not depend on time. The translation of time gives the energy. It equals the kinetic energy, because the gyroscopic
# terms are linear in the rates and cancel.

# %%
quadratic = reduced.L - sum(
    (v * reduced.L.diff(v).subs(dict.fromkeys(MERCATOR.v, 0)) for v in MERCATOR.v), sp.Integer(0)
)
prove(
    energy(reduced.L, MERCATOR),
    quadratic,
    "the energy",
    equations=r"E = \tfrac a2\big(|\dot r_1|^2 + |\dot r_2|^2\big) + b\,\dot r_1\cdot\dot r_2",
)

# %% [markdown]
# ## Conservation in the exact models

# %%
orbit = exact_orbit(Scene(spins=(10, -10), link=Link(1, 0, 0)), 0.3)
times = np.linspace(0, 3, 61)
drift = {}
for model in ("minimal", "spheres", "euler"):
    run = simulate(orbit.scene, times, model, 1e-11)
    values = {"E": run.energy, **run.invariants}
    drift[model] = max(swing(v) for v in values.values())
assert max(drift.values()) < 1e-7
Remark(
    "Conserved quantities",
    "E, G_1, G_2 and P are conserved by Noether's theorem. In a run of 3 s at the tolerance 1e-11 their largest change, in J or "
    "kg m²/s, is " + ", ".join(f"{value:.1e} for the model {model}" for model, value in drift.items()) + ".",
)

# %% [markdown]
# ## The paper's integrals
#
# $B = G_1 - G_2$ is conserved exactly. $A$ is an integral of the ansatz Lagrangian only, and it oscillates on the paired
# precession.

# %%
amplitudes = (0.05, 0.1, 0.2)
swings = []
for amplitude in amplitudes:
    precession = exact_orbit(Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)), amplitude)
    turn_times = np.linspace(0, 2 * np.pi / precession.frequency, 97)
    swings.append(swing(ansatz_A(simulate(precession.scene, turn_times, "minimal", 1e-12))))
order = measured_order(amplitudes, swings)
Remark(
    "The paper's A",
    "B = G_1 − G_2 is conserved exactly. On the paired precession A oscillates by "
    + ", ".join(f"{value:.4f} kg m²/s at r_0 = {r}" for r, value in zip(amplitudes, swings, strict=True))
    + f". This is proportional to r_0^{order:.2f}.",
)

# %% [markdown]
# ## Completeness
#
# With an integral independent of $E$ and $P$ along the paired precession, another pair of its multipliers would equal 1
# (Poincaré). The last pair does not equal 1 (t5: $\lambda^2=\frac9{32}r_0^8/k^4$ for a massless bar).

# %%
multiplier = floquet(orbit.scene, 0.3)
assert multiplier.kind == "hyperbolic" and multiplier.pair_sum - 2 > 1000 * multiplier.error
Remark(
    "No further integral",
    "No further analytic integral is independent of these along the paired precession. At r_0 = 0.3 with a massless bar its "
    f"multiplier is {multiplier.multipliers[4].real:.5f}, not 1: μ + 1/μ − 2 = {multiplier.pair_sum - 2:.1e}, with an error of "
    f"{multiplier.error:.0e}.",
)
