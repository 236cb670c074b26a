# %% [markdown]
# # The shock (4.04)
#
# **Objective.** Height, time, width and impulse of the shock of section 4.2.
#
# **Assumptions.** None: the function is chosen.
#
# **Notation.** $h$, $t_0$, $w$ height, time of the peak and width of a Gaussian pulse, $\tau = t - t_0$.

# %%
import sympy as sp

from lagrotor.paper import Remark, prove, verdict

# %% [markdown]
# ## The pulse
#
# $F(t) = h\,e^{-((t - t_0)/w)^2}$ has its maximum $h$ at $t_0$, where the exponent vanishes. The paper prints $h = 50$ N and
# $t_0 = 2$ s, as in its text, and $w = 1/50$ s.

# %%
h, w, t_0 = sp.symbols("h w t_0", positive=True)
own = {h: sp.Integer(50), w: sp.Rational(1, 50), t_0: sp.Integer(2)}
verdict(
    "4.04",
    evidence=[
        f"The force is a choice, which cannot be wrong. Its height {own[h]} N and its time {own[t_0]} s agree with the text; its "
        f"width is {own[w]} s."
    ],
)

# %% [markdown]
# ## The impulse
#
# It is $\sqrt\pi\,h\,w$. Its square is an integral over the plane, which polar coordinates make elementary.

# %%
tau, radius = sp.Symbol("tau", real=True), sp.Symbol("rho", positive=True)
impulse = sp.integrate(h * sp.exp(-((tau / w) ** 2)), (tau, -sp.oo, sp.oo))
plane = sp.integrate(2 * sp.pi * radius * h**2 * sp.exp(-(radius**2) / w**2), (radius, 0, sp.oo))
prove(impulse**2, plane, "the square of the impulse", names=r"\left(\int F\,dt\right)^2")

# %%
Remark(
    "The impulse of the shock",
    f"The impulse is {impulse.subs(own)} = {float(impulse.subs(own)):.4g} N s over all time. The run begins "
    f"{own[t_0] / own[w]} widths before the peak; the omitted part is below the rounding error of a double.",
)
