# %% [markdown]
# # How long the x direction stays stable after a shock
#
# **Objective.** The rate at which the mean of $x$ leaves zero after a shock along $x$, by averaging; the time in which the
# mean, and the time in which an axis itself, passes a bound.
#
# **Assumptions.** Opposite spins, $G_1=G$, $G_2=-G$, at rest upright; a shock on rotor 1; third order in it. The law is the
# initial rate; each time of the mean is given with the error of that rate over it.
#
# **Notation.** $U=(u_1+u_2)/2$ with $x_i=\tanh u_i$; $\Delta=\alpha_2-\alpha_1$ the twist, $\alpha$ the mean turning angle
# about the joint line, which runs through both ground joints, $P$ the momentum about it; $a$, $b$ the inertias with the bar's
# share, $k=\ell/R$; $X$ and $\Delta_s$ the means of $U$ and $\Delta$ over the swing, $d$ the swing's amplitude in $\Delta$;
# $p_x$, $p_y$ the impulses times $R$; $A_w=e^{-(\Omega_0w)^2/4}$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, Shock, simulate, toppling_after_shock
from lagrotor.errors import DomainError
from lagrotor.models import run_after, time_to_wander, turning_rate, wandering_rate
from lagrotor.numerics import measured_order
from lagrotor.pair.notation import P_X, SWING, TWIST, TWISTED, G, P, X, a, att, b, k, p_y
from lagrotor.paper import Remark, prove
from lagrotor.theory import (
    averaged_routhian,
    quartic_lagrangian,
    quartic_routhian,
    shock_wander,
    slow_rates,
    wander_after_shock,
    wander_error,
)

# %% [markdown]
# ## The Lagrangian through fourth order
#
# With the bar eliminated; $U$, $\Delta$ and their rates of first order, $\dot\alpha$ of second. Odd orders vanish. Second order
# is the swing,

# %%
(U, Delta, _), (U_v, Delta_v, alpha_v) = TWISTED.q, TWISTED.v
quadratic, quartic = quartic_lagrangian()
prove(
    quadratic,
    (a + b) * U_v**2 + (a - b) * Delta_v**2 / 4 - G * U * Delta_v,
    "the second order of the Lagrangian",
    names="L_2",
)

# %% [markdown]
# and the fourth order is

# %%
leaning = (a + b) * alpha_v**2 + G * Delta**2 * alpha_v / (2 * k)
swinging = (
    Delta**2 * Delta_v**2 * (2 * (a - b) + b * k**2) / (8 * k**2)
    + b * U * U_v * Delta * Delta_v
    - (a - b) * U**2 * Delta_v**2 / 4
    - (a + b) * U**2 * U_v**2
    + G * U**3 * Delta_v / 3
)
prove(quartic, leaning + swinging, "the fourth order of the Lagrangian", names="L_4")

# %% [markdown]
# ## The cyclic angle eliminated
#
# $\alpha$ occurs only by its rate. $P=\partial L/\partial\dot\alpha$ is conserved and gives it,

# %%
rate = (P - G * Delta**2 / (2 * k)) / (2 * (a + b))
prove(
    quartic.diff(alpha_v).subs(alpha_v, rate),
    P,
    "the momentum about the joint line",
    names=r"\partial L_4/\partial\dot\alpha",
)

# %% [markdown]
# and leaves the Routhian $R_4=L_4-P\dot\alpha$ in $U$, $\Delta$:

# %%
prove(
    quartic_routhian(),
    swinging - (P - G * Delta**2 / (2 * k)) ** 2 / (4 * (a + b)),
    "the Routhian, fourth order",
    names="R_4",
)

# %% [markdown]
# ## The swing
#
# $L_2$ has the solution $U=X+u\cos\Phi$, $\Delta=\Delta_s+d\sin\Phi$, $\dot\Phi=\Omega_0=G/\sqrt{a^2-b^2}$, with any constant
# $X$, $\Delta_s$ and $u=d\sqrt{a^2-b^2}/(2(a+b))$: its equations of motion hold,

# %%
Phi, natural = sp.Symbol("Phi", real=True), G / sp.sqrt(a**2 - b**2)
share = SWING * sp.sqrt(a**2 - b**2) / (2 * (a + b))
U_t, Delta_t = X + share * sp.cos(Phi), TWIST + SWING * sp.sin(Phi)
prove(
    (2 * (a + b) * natural**2 * U_t.diff(Phi, 2) + G * natural * Delta_t.diff(Phi),
     (a - b) / 2 * natural**2 * Delta_t.diff(Phi, 2) - G * natural * U_t.diff(Phi)),
    (0, 0),
    "the equations of motion of U and of Δ, second order",
    names=("E_U", r"E_\Delta"),
)  # fmt: skip

# %% [markdown]
# ## The average
#
# The fourth order acts on the slow constants through its mean over the swing:

# %%
along = {U: U_t, Delta: Delta_t, U_v: natural * U_t.diff(Phi), Delta_v: natural * Delta_t.diff(Phi)}
by_hand = (swinging - (P - G * Delta**2 / (2 * k)) ** 2 / (4 * (a + b))).xreplace(along)
cosine, sine = sp.symbols("c s")
polynomial = sp.Poly(by_hand.xreplace({sp.cos(Phi): cosine, sp.sin(Phi): sine}), cosine, sine)
mean = sum(
    (
        coefficient * sp.factorial2(m - 1) * sp.factorial2(n - 1) / sp.factorial2(m + n)
        for (m, n), coefficient in polynomial.terms()
        if m % 2 == 0 and n % 2 == 0
    ),
    sp.Integer(0),
)
mean = sp.collect(sp.expand(mean), (X, TWIST, SWING, P), func=sp.factor)
prove(averaged_routhian(), mean, "the mean of the Routhian over the swing", names=r"\langle R_4\rangle")

# %% [markdown]
# (the mean of $\cos^m\Phi\sin^n\Phi$ is $(m-1)!!\,(n-1)!!/(m+n)!!$ for even $m$, $n$). In the means, $-G X\dot\Delta_s$ of $L_2$
# makes $X$ and $G\Delta_s$ conjugate: $G\dot X=-\partial\langle R_4\rangle/\partial\Delta_s$,
# $G\dot\Delta_s=\partial\langle R_4\rangle/\partial X$.

# %%
bracket = (2 * TWIST**2 + SWING**2 - 4 * k * P / G) / k**2 - b * SWING**2 / (a - b)
prove(
    (-mean.diff(TWIST) / G, mean.diff(X) / G),
    (G * TWIST * bracket / (8 * (a + b)), 0),
    "the slow motion, third order",
    names=(r"\dot X", r"\dot\Delta_s"),
)

# %% [markdown]
# The mean twist stays; turning about the joint line carries it into $x$.

# %%
prove(
    slow_rates(),
    (G * TWIST * bracket / (8 * (a + b)), 0),
    "which the library holds",
    names=(r"\dot X", r"\dot\Delta_s"),
)

# %% [markdown]
# ## After a shock
#
# The shock leaves $\Delta_s=p_x/G$, $P=-p_y$ and, with $\sigma=(a+b)/(a-b)$, $d^2=A_w^2(p_x^2+\sigma p_y^2)/G^2$ (t6).
# Along $x$ alone:

# %%
law = P_X**3 / (8 * (a + b) * G**2) * ((2 + att**2) / k**2 - att**2 * b / (a - b))
put = {TWIST: P_X / G, P: 0}
prove(
    (G * TWIST * bracket / (8 * (a + b))).subs(SWING, att * P_X / G).subs(put),
    law,
    "the initial rate of the mean x",
    names=r"\dot X",
)

# %%
alone = shock_wander().expressions[0].subs(p_y, 0)
prove(alone, law, "which the library holds", names=r"\dot X")

# %% [markdown]
# ## Measured over a decade

# %%
forces = (2.0, 6.3, 20.0)
BOUND, LEAN = 0.1, 0.5


def scene(force: float, across: float = 0.0) -> Scene:
    """The bar of section 5.2.1 and a shock of width 1/20."""
    return Scene(spins=(10, -10), link=Link(1, 0.01, 0.1), shock=Shock((force, across, 0), 0.5, 1 / 20))


runs = [run_after(scene(force), 20, 1e-9) for force in forces]
turning = [abs(turning_rate(run)) for run in runs]
wander = [abs(wandering_rate(run)) for run in runs]
slopes = measured_order(forces, turning), measured_order(forces, wander)
assert abs(slopes[0] - 2) < 0.05
assert abs(slopes[1] - 3) < 0.05
said = [abs(wander_after_shock(scene(force))) for force in forces]
given = [wander_error(scene(force), run.t[-1] - 0.5) for force, run in zip(forces, runs, strict=True)]
assert all(abs(one - two) < most for one, two, most in zip(wander, said, given, strict=True))
Remark(
    "The rate of the mean x",
    f"After a shock F along x the pair turns about the joint line as F² (measured {slopes[0]:.3f}) and the mean of x leaves zero "
    f"as F³ (measured {slopes[1]:.3f}). Mean rates over 20 swings against the law, and the error that it gives: "
    + "; ".join(
        f"{F:g} N: {seen:.3e} against {law_rate:.3e} 1/s, at most {most:.0e}"
        for F, seen, law_rate, most in zip(forces, wander, said, given, strict=True)
    )
    + ".",
)


# %% [markdown]
# ## Times: of the mean, and of an axis
#
# Two different quantities. The mean of $x$ over the swing, of both axes, reaches the bound after about $0.1/\dot X$, if the
# initial rate lasts; an axis itself swings, in first order by $u=A_wp_x/(2G\sqrt\sigma)$, and may pass the bound within the
# first swings.


# %%
def mean_time(force: float) -> tuple[float, float | None]:
    """(time by the initial rate, its relative error or None where the motion has left the law's range by then)."""
    rate = abs(wander_after_shock(scene(force)))
    try:
        return BOUND / rate, wander_error(scene(force), BOUND / rate) / rate
    except DomainError:
        return BOUND / rate, None


def axis_time(force: float, axis: int) -> float:
    """Time (s) from the pulse's peak until |x| of an axis itself passes the bound; inf when it does not within 3 s."""
    t = np.linspace(0, 3, 3001)
    beyond = np.abs(simulate(scene(force), t, "minimal", 1e-9).axes[axis, :, 0]) > BOUND
    return float(t[np.argmax(beyond)] - 0.5) if beyond.any() else np.inf


times = {force: mean_time(force) for force in forces}
lean = {force: LEAN / abs(toppling_after_shock(scene(force))) for force in forces}
strong = forces[-1]
followed = time_to_wander(scene(strong), BOUND, 3 * times[strong][0])
single = [axis_time(strong, axis) for axis in (0, 1)]
assert single[0] < 0.5 * followed
assert abs(followed / times[strong][0] - 1) < 2 * times[strong][1]
Remark(
    "How long x stays",
    f"By the initial rate the mean of x, over the swing and both axes, keeps within {BOUND:g} for "
    + "; ".join(
        f"{time:.3g} s at {force:g} N "
        + ("(beyond the range of the law)" if error is None else f"(rate known to {100 * error:.0f} %)")
        for force, (time, error) in times.items()
    )
    + f". Followed on the exact run at {strong:g} N it takes {followed:.2f} s. An axis itself passes {BOUND:g} much "
    f"earlier there, by its swing: x_1 after {single[0]:.2f} s, x_2 after {single[1]:.2f} s, counted from the pulse's peak. By "
    "the initial rate of turning the pair leans by "
    f"{LEAN:g} rad after " + ", ".join(f"{time:.3g} s" for time in lean.values()) + ".",
)

# %%
spared = wander_after_shock(scene(20, -2.633)) / wander_after_shock(scene(20))
Remark(
    "Why x does not stay for ever",
    "The shock leaves a mean twist Δ = p_x/G; turning about the joint line carries it into x, Ẋ = −α′ Δ/k "
    f"for b = 0, less for b > 0 and more for b < 0. The force along y that "
    f"cancels the drift (t6) leaves {spared:.3f} of that rate.",
)
