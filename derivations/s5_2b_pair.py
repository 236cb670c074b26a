# %% [markdown]
# # The pair, its bar and the ansatz (5.07 to 5.11)
#
# **Objective.** The Lagrangian of two rotors and a bar, in two sets of Euler angles; the constraint of the bar; and the
# consequences of substituting $\dot\phi_1 = -\dot\phi_2$, $\dot\psi_1 = -\dot\psi_2$ into the Lagrangian before varying it.
#
# **Assumptions.** Equal rotors, ideal joints, no gravity. The bar has a mass $m$ and an inertia $K$ about its centre.
#
# **Notation.** $r_i$ unit vectors along the axes; $J = I_1 + M R^2/4$ transverse inertia about the ground joint;
# $a = J + m R^2/4 + K R^2/\ell^2$, $b = m R^2/4 - K R^2/\ell^2$; $k = \ell/R$.

# %%
import sympy as sp

from lagrotor.mechanics import degrees_of_freedom, total_derivative
from lagrotor.pair import axis, pair_lagrangian, pair_with_bar
from lagrotor.pair.notation import I3, PAIR, J, K, Phi, R, a, b, ell, k, m, r0
from lagrotor.paper import Formula, Remark, prove, verdict
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.ansatz import opposite_azimuths, opposite_spin_angles
from lagrotor.paper.rotor_pair.premises import ABOUT_JOINT, MASSLESS_BAR, in_parameters
from lagrotor.theory import paired_series

theta_1, phi_1, psi_1, theta_2, phi_2, psi_2 = PAIR.q

# %% [markdown]
# ## Two rotors and a bar
#
# The bar lies between the tips $\mp\frac\ell2 e_x + R\,r_i$. Its centre moves with $\frac R2(\dot r_1 + \dot r_2)$, and it
# turns with $\frac R\ell|\dot r_2 - \dot r_1|$. Its energy adds to the inertia of each axis and couples the two:

# %%
r_1, r_2 = axis(theta_1, phi_1), axis(theta_2, phi_2)
v_1, v_2 = (r.applyfunc(lambda e: total_derivative(e, PAIR)) for r in (r_1, r_2))
along, apart = R / 2 * (v_1 + v_2), R / ell * (v_2 - v_1)
bar_energy = m / 2 * along.dot(along) + K / 2 * apart.dot(apart)
prove(
    bar_energy,
    in_parameters((a - J) / 2 * (v_1.dot(v_1) + v_2.dot(v_2)) + b * v_1.dot(v_2)),
    "the kinetic energy of the bar",
    equations=(
        r"\tfrac m2\,\tfrac{R^2}{4}\,|\dot r_1 + \dot r_2|^2"
        r" + \tfrac K2\,\tfrac{R^2}{\ell^2}\,|\dot r_2 - \dot r_1|^2"
        r" = \tfrac{a - J}{2}\,\big(|\dot r_1|^2 + |\dot r_2|^2\big) + b\,\dot r_1\cdot\dot r_2"
    ),
)

# %% [markdown]
# The Lagrangian of the pair is this and the energy of each rotor (5.01):

# %%
system = pair_with_bar()
L = system.L
prove(
    in_parameters(L),
    in_parameters(pair_lagrangian()) + bar_energy,
    "the Lagrangian of the pair",
    equations=(
        r"\mathcal L = \sum_i\tfrac J2\big(\dot\theta_i^2 + \dot\phi_i^2\sin^2\theta_i\big)"
        r" + \tfrac{I_3}{2}\big(\dot\psi_i + \dot\phi_i\cos\theta_i\big)^2"
        r" + \tfrac{a - J}{2}\,\big(|\dot r_1|^2 + |\dot r_2|^2\big) + b\,\dot r_1\cdot\dot r_2"
    ),
)

# %% [markdown]
# The paper's Lagrangian has only the two rotors, in the angles of the nodes:

# %%
lagrangian_written = form(
    "a/2*(theta_1_dot**2 + phi_1_dot**2*sin(theta_1)**2 + theta_2_dot**2 + phi_2_dot**2*sin(theta_2)**2)"
    " + b*dot(hat_r_1_dot, hat_r_2_dot)"
    " + I_3/2*((psi_1_dot + phi_1_dot*cos(theta_1))**2 + (psi_2_dot + phi_2_dot*cos(theta_2))**2)",
    hat_r_1_dot=v_1,
    hat_r_2_dot=v_2,
)
verdict(
    "5.07",
    L,
    premises=[ABOUT_JOINT, MASSLESS_BAR],
    uses=["5.01"],
    form=lagrangian_written,
)

# %% [markdown]
# ## The azimuth of the axis
#
# Any constant shift of both azimuths leaves the Lagrangian unchanged:

# %%
shift = sp.Symbol("gamma", real=True)
shifted = L.subs({phi_1: phi_1 + shift, phi_2: phi_2 + shift}, simultaneous=True)
prove(
    shifted,
    L,
    "the Lagrangian after a shift of both azimuths",
    equations=r"\mathcal L(\phi_1 + \gamma,\ \phi_2 + \gamma) = \mathcal L(\phi_1,\ \phi_2)",
)

# %%
verdict(
    "5.08",
    L,
    premises=[ABOUT_JOINT, MASSLESS_BAR],
    uses=["5.07"],
    form=lagrangian_written,
)

# %% [markdown]
# The shift from the node angle $\varphi$ of the cited book to the azimuth of the axis follows from the third axis of the body,
# $R_z(\varphi)R_x(\theta)\,e_z$.

# %%
node, tilt = sp.symbols("varphi theta", real=True)
third_axis = (sp.rot_axis3(node).T * sp.rot_axis1(tilt).T)[:, 2]
prove(
    third_axis,
    axis(tilt, node - sp.pi / 2),
    "the axis of the body, in its azimuth",
    names=r"R_z(\varphi)\,R_x(\theta)\,e_z",
)

# %%
Remark(
    "The shift of the azimuth",
    "With the zxz angles of the cited book the axis has the azimuth φ − π/2, while the paper adds π/2. No later equation depends "
    "on this difference.",
)

# %% [markdown]
# ## The constraint of the bar
#
# One holonomic constraint, $g = k(x_2 - x_1) + 1 - r_1\cdot r_2 = 0$, keeps the distance of the tips at $\ell$:

# %%
joint = sp.Matrix([ell / 2, 0, 0])
tip_1, tip_2 = -joint + R * r_1, joint + R * r_2
distance_squared = (tip_2 - tip_1).dot(tip_2 - tip_1)
constraint = system.constraints[0].subs(k, ell / R)
prove(
    distance_squared,
    ell**2 + 2 * R**2 * constraint,
    "the squared distance of the tips",
    equations=r"\big|\ell\,e_x + R\,(r_2 - r_1)\big|^2 = \ell^2 + 2 R^2\,g",
)

# %% [markdown]
# This is the distance of the tips in the upright position:

# %%
bar_upright = (tip_2 - tip_1).subs({theta_1: 0, theta_2: 0})
prove(bar_upright, sp.Matrix([ell, 0, 0]), "the bar, the axes upright", names=r"\vec r_2 - \vec r_1")

# %% [markdown]
# Its gradient has rank one where it does not vanish, so five of the six degrees of freedom remain:

# %%
state = {theta_1: sp.Rational(1, 3), phi_1: sp.Rational(2, 5), theta_2: sp.Rational(1, 4), phi_2: sp.Rational(-3, 7)}
somewhere = {**dict.fromkeys(PAIR.q, 0), **state, a: 1, b: 0, I3: 1, k: 1}
verdict(
    "5.09",
    {
        r"\text{degrees of freedom}": degrees_of_freedom(system, somewhere),
        r"\text{degrees of freedom without the bar}": len(PAIR.q),
    },
    evidence=["The length R = 1 is a choice. ℓ = R is the statement of the line, not a premise."],
)

# %% [markdown]
# ## Opposite spin angles
#
# The paper puts $\dot\psi_1 = -\dot\psi_2$. That is not $\omega_1 = -\omega_2$: the axial velocities, which alone are
# conserved, are $\dot\psi + \dot\phi_1\cos\theta_1$ and $-\dot\psi + \dot\phi_2\cos\theta_2$.

# %%
verdict(
    "5.10",
    L,
    premises=[ABOUT_JOINT, MASSLESS_BAR, opposite_spin_angles()],
    uses=["5.08"],
    evidence=["The conserved quantities are ω₁ and ω₂, not ψ₁′ and ψ₂′."],
    form=lagrangian_written,
)

# %% [markdown]
# ## The ansatz in the Lagrangian
#
# With $\dot\phi_1 = -\dot\phi_2$ as well, $\phi_1 + \phi_2$ and $\psi_1 + \psi_2$ are constant: two holonomic constraints.
# Substituting them before the variation is correct if forces enforce them without doing work. The pair has no such forces.

# %%
ansatz_case = verdict(
    "5.11",
    L,
    premises=[ABOUT_JOINT, MASSLESS_BAR, opposite_spin_angles(), opposite_azimuths()],
    uses=["5.10"],
    evidence=[
        "The line follows algebraically from its premises. Equations of motion derived from it are wrong: they describe a "
        "pair without a bar, in which nonexistent constraints keep φ₁ + φ₂ and ψ₁ + ψ₂ constant."
    ],
    form=lagrangian_written,
)
ansatz_case

# %% [markdown]
# The ansatz also contradicts the bar: at $\phi_1 = -\phi_2 = \pi/2$, with $\ell = R$, its constraint allows only
# $\theta_2 = -\theta_1$, that is zero inclination.

# %%
quarter = {phi_1: sp.pi / 2, phi_2: -sp.pi / 2, k: 1}
prove(
    system.constraints[0].subs(quarter),
    1 - sp.cos(theta_1 + theta_2),
    "the bar's constraint a quarter period on",
    names="g",
)

# %% [markdown]
# On the exact orbit $\phi_1 + \phi_2$ oscillates in proportion to the amplitude. From the second order of its series
# ($\sigma = k = 1$; $x_i$, $y_i$ through $r_0^2$, with $x_2 = -x_1$ and $y_2 = y_1$ in the second order):

# %%
series = paired_series(2, sp.Integer(1), sp.Integer(1))
X, Y = (sp.expand(series.expression(part)).coeff(r0, 2) for part in (series.x, series.Y))
azimuth_sum = sp.factor(sp.expand_trig(2 * r0 * (Y * sp.cos(Phi) - X * sp.sin(Phi))))
Formula(azimuth_sum, r"\phi_1 + \phi_2")
