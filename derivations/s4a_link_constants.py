# %% [markdown]
# # Stiffness and damping of the links (4.01)
#
# **Objective.** The units of the constants of the paper's links, and their damping ratio.
#
# **Assumptions.** The links of section 3.3: force $S s$ of the spring, $D\dot s$ of the damper.
#
# **Notation.** $n$ and $\omega_s$ are not explained in the paper; $m_{\mathrm{eff}}$ a mass on one link.

# %%
import sympy as sp

from lagrotor.paper import Formula, Remark, prove, verdict
from lagrotor.paper.proof import form

M, n, omega_s, m_eff = sp.symbols("M n omega_s m_eff", positive=True)
kilogram, second, metre = sp.symbols("kilogram second metre", positive=True)

# %% [markdown]
# ## Units
#
# A damper's constant is a force over a velocity:

# %%
newton = kilogram * metre / second**2
unit_of_damping = newton / (metre / second)
Formula(unit_of_damping, "[D]")

# %% [markdown]
# The paper chooses $S = 2000\,(M/n)\,\omega_s^2$ and $D = 500\,(M/n)\,\omega_s$. With a number $n$ and an angular frequency
# $\omega_s$ both have their units, N/m and N s/m.

# %%
S, D = 2000 * (M / n) * omega_s**2, 500 * (M / n) * omega_s
in_units = {M: kilogram, n: 1, omega_s: 1 / second}
prove(
    (S.subs(in_units), D.subs(in_units)),
    (2000 * newton / metre, 500 * unit_of_damping),
    "the units of the chosen constants, at M = 1 kg, n = 1, ω_s = 1 rad/s",
    equations=(r"S = 2000\ \mathrm{N/m}", r"D = 500\ \mathrm{N\,s/m}"),
)

# %%
verdict(
    "4.01",
    {"[D]": unit_of_damping},
    evidence=[
        "S and D are chosen values, which cannot be false. If n is a number and omega_s an angular frequency, their "
        "units are N/m "
        "and N s/m = kg/s. The paper does not say what n and omega_s are."
    ],
    form={"[D]": form("kilogram/second", {"kilogram": r"\mathrm{kg}", "second": r"\mathrm{s}"})},
)

# %% [markdown]
# ## Damping
#
# A mass $m_{\mathrm{eff}}$ on one link obeys $m_{\mathrm{eff}}\ddot s + D\dot s + S s = 0$; its damping ratio $\zeta$ is
# $D/(2\sqrt{S m_{\mathrm{eff}}})$.

# %%
damping_ratio = sp.sqrt(D**2 / (4 * S * m_eff))
prove(damping_ratio**2, sp.Rational(125, 4) * M / (n * m_eff), "the square of the damping ratio", names=r"\zeta^2")

# %%
one_body, two_bodies = (damping_ratio.subs({m_eff: mass, n: 1}) for mass in (M, M / 2))
Remark(
    "The links are overdamped",
    f"The ratio D/S is {sp.cancel(D / S)}. The damping ratio is {float(one_body):.3g}/√n for a mass M on one link and "
    f"{float(two_bodies):.3g}/√n for two bodies of mass M. The links are therefore overdamped unless n is large.",
)
