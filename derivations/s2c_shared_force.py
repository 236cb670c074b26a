# %% [markdown]
# # How the rotors share the force (2.06 to 2.13)
#
# **Objective.** The paper's equations from the torques on the two rotors to the rate of the parallel pair, each derived from its
# premises; then the rate of the exact pair.
#
# **Assumptions.** No gravity, ideal joints. The paper's assumptions about the axes, the link and the spins are premises of its
# equations.
#
# Figure 2 shows the forces.
#
# **Notation.** $\vec r$, $\vec r_2$ the levers of the two rotors, $\hat r_i$ their axes; $\vec A$ the acceleration of the
# link's centre; $\vec a_i = \ddot{\hat r}_i$; $\rho = \omega_1/\omega_2$.

# %%
import sympy as sp

from lagrotor.pair.notation import I3, J, R, m, omega_1, omega_2
from lagrotor.paper import Formula, Premise, prove, verdict
from lagrotor.paper.grammar import cross, vector
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.premises import EQUAL_SPINS
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

rotors = PAPER.scripts.run("derivations", "s2a_angular_momentum")
pair = PAPER.scripts.run("derivations", "s2b_linear_pair")
F, A, shared, massless_link = (rotors[name] for name in ("F", "A", "shared", "massless_link"))

# %% [markdown]
# ## Half the difference
#
# With $\vec f = \frac12(\vec F_A - \vec F_B)$ the two forces follow from their sum $\vec F - m\vec A$.

# %%
f = vector("f")
F_A, F_B = shared / 2 + f, shared / 2 - f
prove((F_A - F_B) / 2, f, "f is half the difference of the forces on the rotors")

# %%
verdict(
    "2.06",
    {r"\vec F_A + \vec F_B": shared, r"\vec F_A": F_A, r"\vec F_B": F_B},
    premises=[massless_link],
    uses=["2.01"],
    evidence=[
        "The scanned source is garbled: it prints F_1 to F_4 and a sixth symbol. Only the lines that 2.07 uses are judged."
    ],
    form={
        r"\vec F_A + \vec F_B": form("F - m*A"),
        r"\vec F_A": form("(F - m*A)/2 + f"),
        r"\vec F_B": form("(F - m*A)/2 - f"),
    },
)

# %% [markdown]
# ## The rate of each axis
#
# The torque on a rotor is $\vec r\times\vec F = I_3\omega\,\dot{\hat r} + J\,\hat r\times\ddot{\hat r}$ (2.04), with
# $\hat r = \vec r/R$. Solved for the rate of the axis:

# %%
r, r_2, a_1, a_2 = (vector(name) for name in ("r", "r_2", "a_1", "a_2"))


def torque_along_spin(lever: sp.Matrix, force: sp.Matrix, acceleration: sp.Matrix) -> sp.Matrix:
    """I_3 omega r': the torque less what accelerates the axis."""
    return cross(lever, force) - J * cross(lever / R, acceleration)


spinning_1, spinning_2 = torque_along_spin(r, F_A, a_1), torque_along_spin(r_2, F_B, a_2)
rate_1, rate_2 = spinning_1 / (I3 * omega_1), spinning_2 / (I3 * omega_2)
Formula(rate_1, r"\dot{\hat r}_1")

# %% [markdown]
# ## The forces that parallel axes need
#
# With $\vec r_2 = \vec r$ at all times the accelerations are the same too, and the rates differ by

# %%
together = dict(zip([*r_2, *a_2], [*r, *a_1], strict=True))
bracket = (omega_1 + omega_2) * f - (omega_1 - omega_2) * (shared / 2 - J / R * a_1)
prove(
    I3 * omega_1 * omega_2 * (rate_1 - rate_2).xreplace(together),
    cross(r, bracket),
    "the difference of the rates of two parallel axes",
    equations=(
        r"I_3\,\omega_1\omega_2\,(\dot{\vec r}_1 - \dot{\vec r}_2) = \vec r\times\Big[(\omega_1"
        r" + \omega_2)\,\vec f - (\omega_1 - \omega_2)\Big(\tfrac12(\vec F - m\vec A)"
        r" - \tfrac JR\,\vec a\Big)\Big]"
    ),
)

# %% [markdown]
# The axes stay parallel if this vanishes, so the other factor of the product lies along $\vec r$. This fixes $\vec f$ up to a
# component along $\vec r$.

# %%
along_r = sp.Symbol("lambda_r", real=True)
f_parallel = (omega_1 - omega_2) / (omega_1 + omega_2) * (shared / 2 - J / R * a_1) + along_r * r
prove(
    (rate_1 - rate_2).xreplace(dict(zip(f, f_parallel, strict=True))).xreplace(together),
    sp.zeros(3, 1),
    "with this f both axes have the same rate",
    equations=r"\dot{\vec r}_1 - \dot{\vec r}_2 = 0",
)

# %% [markdown]
# These are the premises of the paper's equations. The exact pair satisfies the first only for equal spins.

# %%
parallel = Premise("the axes are parallel, r̂₁ = r̂₂, and have equal accelerations", together)
turning_alike = Premise(
    "the axes stay parallel, which fixes f up to a component along r",
    dict(zip(f, f_parallel, strict=True)),
    broken=f"with opposite spins the drift of axis 2 is {pair['apart']} times that of axis 1",
)
slow = Premise(
    "the axes turn slowly compared with the spins, so that J r̂ × r̂″ is neglected as in equations (3) and (4)",
    dict.fromkeys(a_1, sp.S.Zero),
    broken=rotors["slow_force"](omega_1).broken,
)
premises = [parallel, turning_alike, slow, massless_link]

# %%
verdict(
    "2.07",
    spinning_1,
    premises=premises,
    uses=["2.04", "2.05", "2.06"],
    form=form("cross(r, (F - m*A)/2 + f) - J*cross(hat_r, hat_r_ddot)", hat_r=r / R, hat_r_ddot=a_1),
)

# %% [markdown]
# ## Solved for $\vec r\times\vec f$
#
# Under the premises the faster rotor takes the larger share of the force, $\vec f = \frac{\rho - 1}{2(1 + \rho)}\vec F$ up to a
# component along $\vec r$. The paper collects the terms with the opposite sign.

# %%
rho = omega_1 / omega_2
prove(
    cross(r, f_parallel).subs({m: 0, **dict.fromkeys(a_1, 0)}),
    (rho - 1) / (2 * (1 + rho)) * cross(r, F),
    "r × f under the premises",
    equations=(
        r"\vec r\times\vec f = \frac{\rho - 1}{2(1 + \rho)}\,\vec r\times\vec F,\qquad \rho"
        r" = \frac{\omega_1}{\omega_2}"
    ),
)

# %%
right_8 = form("(omega_1/omega_2 - 1)/2*cross(r, F)")
right_9 = form("(omega_1/omega_2 - 1)/(2*(1 + omega_1/omega_2))*cross(r, F)")
verdict(
    "2.08",
    (1 + rho) * cross(r, f),
    premises=premises,
    correction=right_8,
    wrong="The left side has the wrong sign.",
    uses=["2.07"],
    evidence=["If 2.07 is solved for r x f, the right side is rho r x F/2 - r x F/2, with rho = omega_1/omega_2."],
    form=right_8,
)

# %%
verdict(
    "2.09",
    cross(r, f),
    premises=premises,
    correction=right_9,
    wrong="This line has the same sign error as the equation before (5).",
    uses=["2.08"],
    evidence=[
        "The sign error of 2.08 is carried over. In the corrected line the faster rotor takes the larger share of the force; the "
        "printed line gives it the smaller share."
    ],
    form=right_9,
)

# %%
right_10 = form("omega_1/(omega_1 + omega_2)*cross(r, F)")
verdict(
    "2.10",
    spinning_1,
    premises=premises,
    correction=right_10,
    wrong="This line has the same sign error as the equation before (5).",
    uses=["2.09", "2.04"],
    form=right_10,
)

# %% [markdown]
# ## The rate of the parallel pair
#
# As printed, (6) is not the rate that the premises give, and (7) does not follow from it:

# %%
right_11 = form("cross(r, F)/(I_3*(omega_1 + omega_2))")
verdict(
    "2.11",
    rate_1,
    premises=premises,
    correction=right_11,
    wrong="The same sign error gives the factor 2/(1 + omega_1/omega_2) instead of 2 omega_1/(omega_1 + omega_2).",
    uses=["2.10"],
    evidence=["(7) follows from the premises: a second sign error between (6) and (7) cancels that of 2.08."],
    form=right_11,
)

# %% [markdown]
# The premises imply (7) for any spins, but the exact pair violates the premise of parallel axes. Its linearised equations give a
# different drift of the mean axis, which agrees with the paper only for equal spins.

# %%
a, b, t = (pair[name] for name in ("a", "b", "t"))
mean_drift = form(
    "R*column(-2*(a*omega_1 - b*omega_2)*F_y,"
    " (a - b)*(omega_1 + omega_2)*F_x + I_3*omega_2*(omega_2 - omega_1)*F_y*t, 0)"
    "/(2*I_3*(a*(omega_1**2 + omega_2**2) - 2*b*omega_1*omega_2))",
    F_x=F[0],
    F_y=F[1],
)
mean_axis = r"\tfrac12\langle\dot{\hat r}_1 + \dot{\hat r}_2\rangle"

# %%
verdict(
    "2.12",
    {r"\dot{\hat r}": rate_1, mean_axis: pair["mean_drift"]},
    premises=premises,
    correction={mean_axis: mean_drift},
    uses=["2.11", "2.04", "2.05"],
    evidence=[
        f"From rest the axes stay parallel only if {sp.factor(pair['twisting'])} = 0, because the bar exerts a "
        "force only along itself. This holds for a force along the bar if omega_1 = omega_2. It never holds for a "
        "force across the "
        "bar on one tip: for equal spins the mean axis still follows (7), while the axes twist apart.",
        "A steady force along a massless bar makes the mean axis drift; the rate, divided by the paper's rate, is "
        f"{pair['table']}. The torques on the two rotors have the ratio {pair['shares']}: the bar shares the force in "
        "the ratio of "
        "the squares of the spins, not of the spins.",
        f"After an impulse the axes oscillate about the drift, with Omega^2 = {pair['Omega_squared']}.",
        f"For omega_2 = -omega_1 the paper's rate is infinite; the two axes drift at {pair['opposite'][0]} and "
        f"{pair['opposite'][1]} per unit of force.",
    ],
    form={r"\dot{\hat r}": form("cross(r, F)/((omega_1 + omega_2)*I_3)"), mean_axis: mean_drift},
)

# %% [markdown]
# ## Equal spins
#
# The linearised exact pair gives the drifts of the two axes under a steady force on one tip, for any spins and any bar. Small
# tilts are a premise. The lever is then $R$ along the vertical.

# %%
eps = pair["eps"]
small_tilts = Premise(
    "small tilts from rest under a small, steady force",
    {**dict(zip(r, (eps * r[0], eps * r[1], R), strict=True)), **{part: eps * part for part in F}},
    small=eps,
)
along_bar = Premise("the force acts along the bar", {F[1]: sp.S.Zero})
sharing = "/(I_3*(a*(omega_1**2 + omega_2**2) - 2*b*omega_1*omega_2))"
across = "R*column(-(a*omega_1 - b*omega_2)*F_y, "
drifts = {
    r"\langle\dot{\hat r}_1\rangle": across + "(a*omega_1 - b*omega_2)*F_x + I_3*omega_2**2*F_y*t, 0)" + sharing,
    r"\langle\dot{\hat r}_2\rangle": across + "(a*omega_2 - b*omega_1)*F_x - I_3*omega_1*omega_2*F_y*t, 0)" + sharing,
}
verdict(
    "2.13",
    {r"\langle\dot{\hat r}_1\rangle": pair["drift_1"], r"\langle\dot{\hat r}_2\rangle": pair["drift_2"]},
    premises=[small_tilts, EQUAL_SPINS, along_bar],
    form={name: form(text, F_x=F[0], F_y=F[1]) for name, text in drifts.items()},
    uses=["2.12"],
    evidence=[
        "If the force acts along the bar, each axis drifts at this rate, because each rotor carries half the force, "
        "for any bar. A "
        f"force across the bar on one tip twists the pair: y_1' - y_2' grows as {pair['twist_rate']}.",
    ],
)
