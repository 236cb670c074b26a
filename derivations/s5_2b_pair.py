# %% [markdown]
# # The pair, its bar and the ansatz (5.07 to 5.11)
#
# **Objective.** The Lagrangian of two rotors in two sets of Euler angles, what the bar demands, and what it means to
# put $\dot\phi_1 = -\dot\phi_2$, $\dot\psi_1 = -\dot\psi_2$ into the Lagrangian before varying it.
#
# **Assumptions.** Equal rotors, ideal joints, no gravity. $r_i$ in the paper's bar equation are the positions of the
# tips, as its next line (5.17) has them.
#
# **Notation.** $J$ transverse inertia about the ground joint, $a$, $b$, $k = \ell/R$ as in the glossary.

# %%
import numpy as np
import sympy as sp

from lagrotor import Scene, simulate
from lagrotor.algebra import decide_equal, decide_zero
from lagrotor.mechanics import degrees_of_freedom
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.numerics.convergence import measured_order
from lagrotor.pair.lagrangians import ansatz_lagrangian, axis, pair_lagrangian, pair_with_bar
from lagrotor.pair.symbols import ANSATZ, I1, I3, PAIR, J, Phi, R, a, b, ell, k, r0
from lagrotor.paper.ledger import Relation, chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Formula, Judged
from lagrotor.theory.paired_precession.series import paired_series

th1, ph1, ps1, th2, ph2, ps2 = PAIR.q
th1_v, ph1_v, ps1_v, th2_v, ph2_v, ps2_v = PAIR.v
about_joint = "I_1 read as the transverse inertia about the ground joint"

# %% [markdown]
# ## Two rotors
#
# Each line is read as printed. The shift of the azimuth leaves the Lagrangian alone, whatever its size; which shift
# turns the node angle into the azimuth of the axis is another question.

# %%
L = pair_lagrangian()


def printed_pair(first: sp.Expr, second: sp.Expr) -> sp.Expr:
    one = I1 / 2 * (th1_v**2 + first**2 * sp.sin(th1) ** 2) + I3 / 2 * (ps1_v + first * sp.cos(th1)) ** 2
    two = I1 / 2 * (th2_v**2 + second**2 * sp.sin(th2) ** 2) + I3 / 2 * (ps2_v + second * sp.cos(th2)) ** 2
    return one + two


node, tilt = sp.symbols("varphi theta", real=True)
third_axis = (sp.rot_axis3(node).T * sp.rot_axis1(tilt).T)[:, 2]
shift_is_minus = decide_equal(third_axis, axis(tilt, node - sp.pi / 2)).answer
shift_is_plus = decide_equal(third_axis, axis(tilt, node + sp.pi / 2)).answer
assert (shift_is_minus, shift_is_plus) == ("zero", "nonzero")
Formula(L)

# %% [markdown]
# ## The bar
#
# The tips are $P_i = \mp\frac\ell2 e_x + R r_i$. One holonomic constraint on six coordinates.

# %%
tips = (-ell / 2 * sp.Matrix([1, 0, 0]) + R * axis(th1, ph1), ell / 2 * sp.Matrix([1, 0, 0]) + R * axis(th2, ph2))
squared = (tips[1] - tips[0]).dot(tips[1] - tips[0])
system = pair_with_bar()
state = {th1: sp.Rational(1, 3), ph1: sp.Rational(2, 5), th2: sp.Rational(1, 4), ph2: sp.Rational(-3, 7), k: 1}
freedom = degrees_of_freedom(system, {**dict.fromkeys(PAIR.q, 0), **state, a: 1, b: 0, I3: 1})
sp.Eq(system.constraints[0], 0)

# %% [markdown]
# ## The ansatz in the Lagrangian
#
# $\phi_1 + \phi_2$ and $\psi_1 + \psi_2$ constant are two holonomic constraints. Putting them in before varying is
# right for a system on which something enforces them without doing work. Nothing does: on the exact pair they would
# have to follow from the equations. They do not, for two reasons that are computed here.
#
# 1. With $\phi_1 = -\phi_2 = \phi$ the bar's constraint at $\phi = \pi/2$ leaves only $\sin\theta_1 = -\sin\theta_2$,
#    no inclination at all.
# 2. On the exact periodic orbit $\phi_1 + \phi_2$ swings with the first power of the amplitude.

# %%
ansatz = ansatz_lagrangian()
phi_v, psi_v = ANSATZ.v[2:]
a1, a2 = ANSATZ.q[:2]
a1_v, a2_v = ANSATZ.v[:2]
tilts = I1 / 2 * (a1_v**2 + phi_v**2 * sp.sin(a1) ** 2), I1 / 2 * (a2_v**2 + phi_v**2 * sp.sin(a2) ** 2)
printed_ansatz = tuple(
    tilts[0] + I3 / 2 * (psi_v + phi_v * sp.cos(a1)) ** 2 + tilts[1] + I3 / 2 * (last) ** 2
    for last in (-psi_v - phi_v * sp.cos(a2), psi_v + phi_v * sp.cos(a2))
)

g = system.constraints[0].subs({ph1: sp.pi / 2, ph2: -sp.pi / 2, k: 1})
at_quarter = decide_zero(g - (1 + sp.sin(th1) * sp.sin(th2) - sp.cos(th1) * sp.cos(th2))).answer
assert at_quarter == "zero"  # 1 − cos(theta_1 + theta_2) = 0: theta_2 = −theta_1

# phi_1 + phi_2 in the first power of r_0, from the second order of the periodic series (sigma = 1, k = 1): with
# (x_i, y_i) = r_0 (cos, ± sin) + r_0² (X_i, Y_i) and X_2 = −X_1, Y_2 = Y_1 it is 2 r_0 (Y_1 cos Phi − X_1 sin Phi).
series = paired_series(2, sp.Integer(1), sp.Integer(1))
X, Y = (sp.expand(series.expression(part)).coeff(r0, 2) for part in (series.x, series.Y))
azimuth_sum = sp.factor(sp.expand_trig(2 * (Y * sp.cos(Phi) - X * sp.sin(Phi))))
at_top = azimuth_sum.subs(Phi, sp.pi / 2)

amplitudes = (0.02, 0.04, 0.08, 0.16)


def largest_sum(amplitude: float) -> float:
    orbit = exact_orbit(Scene(spins=(10, -10)), amplitude)
    run = simulate(orbit.scene, np.linspace(0, 2 * np.pi / orbit.frequency, 201), "minimal", 1e-11)
    return float(np.abs(run.azimuths.sum(axis=0)).max())


sums = [largest_sum(amplitude) for amplitude in amplitudes]
order = measured_order(amplitudes, sums)
sp.Eq(ph1 + ph2, r0 * azimuth_sum, evaluate=False)

# %%
statements = [
    stated("5.07", chain(L, printed_pair(ph1_v, ph2_v)), given={J: I1}, condition=about_joint, depends_on=("5.01",)),
    stated(
        "5.08",
        chain(L, printed_pair(ph1_v, ph2_v)),
        given={J: I1},
        condition=about_joint,
        depends_on=("5.07",),
        evidence=(
            "A constant shift of the azimuth leaves the Lagrangian alone. With the zxz angles of the cited book the axis "
            "has azimuth varphi − pi/2 (decided); the printed + pi/2 points the other way, which nothing later uses.",
        ),
    ),
    stated(
        "5.09",
        (
            Relation(squared - R**2, squared - ell**2),
            Relation(sp.Integer(5), sp.Integer(freedom)),
        ),
        given={ell: R},
        condition="r_i read as the tips' positions, as in 5.17; with axes from the joints the printed length is 0 at rest",
        evidence=(f"Rank of the bar's Jacobian is one: {freedom} of 6 coordinates are free.",),
    ),
    stated(
        "5.10",
        chain(
            L.subs({ps1_v: psi_v, ps2_v: -psi_v}),
            printed_pair(ph1_v, ph2_v).subs({ps1_v: psi_v, ps2_v: -psi_v}),
        ),
        given={J: I1},
        condition=about_joint,
        depends_on=("5.08",),
        evidence=(
            "psi_1' = −psi_2' is not omega_1 = −omega_2: the axial velocities are psi' + phi_1' cos theta_1 and "
            "−psi' + phi_2' cos theta_2, and only these are conserved.",
        ),
    ),
    stated(
        "5.11",
        chain(ansatz, *printed_ansatz),
        given={J: I1},
        condition=about_joint,
        depends_on=("5.10",),
        evidence=(
            "As algebra the line holds. Varying it is not legitimate: it is the Lagrangian of a pair in which "
            "phi_1 + phi_2 and psi_1 + psi_2 are held constant by constraints that do not exist, and without the bar.",
            "With phi_1 = −phi_2 the bar cannot be kept: at phi = pi/2 its constraint is 1 − cos(theta_1 + theta_2) = 0.",
            f"On the exact orbit phi_1 + phi_2 swings by {sums[-1]:.4f} rad at r_0 = {amplitudes[-1]}, "
            f"as r_0 to the power {order:.3f}; the series has "
            f"{at_top} r_0 at Phi = pi/2.",
        ),
        steps=("phi_1' = phi', phi_2' = −phi', psi_1' = psi', psi_2' = −psi' in the pair's Lagrangian",),
    ),
]
Judged(statements)
