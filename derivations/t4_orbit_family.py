# %% [markdown]
# # The family of paired precessions up to its end
#
# **Objective.** The symmetry by which a quarter of a period determines the periodic orbit; frequency against amplitude; the
# turning points and the end of the family.
#
# **Assumptions.** Opposite spins, any bar. Only a few orbits of each bar are computed here; `ends()` follows the families to
# $r_0 = 0.99$.
#
# **Notation.** Mercator coordinates about the joint line, which runs through both ground joints:
# $r_i=(\tanh u_i,-\sin\alpha_i\,\mathrm{sech}\,u_i, \cos\alpha_i\,\mathrm{sech}\,u_i)$; $U=(u_1+u_2)/2$,
# $\Delta=\alpha_2-\alpha_1$, $\alpha=(\alpha_1+\alpha_2)/2$; $r_0$ the sine of the inclination when the axes are parallel;
# $\Omega_0$ the natural rate; $k=\ell/R$ the length of the bar over that of an axis.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, natural_rate, orbit_family, paired_frequency
from lagrotor.models import OrbitFamily, trace_family
from lagrotor.pair import mercator_lagrangian
from lagrotor.pair.notation import G_1, G_2, MERCATOR, G, k
from lagrotor.paper import Formula, Remark, prove

# %% [markdown]
# ## Lagrangian and bar
#
# The spins are opposite, $G_1=G$, $G_2=-G$. The Lagrangian and the bar's constraint are

# %%
u1, al1, u2, al2 = MERCATOR.q
u1_v, al1_v, u2_v, al2_v = MERCATOR.v
L = mercator_lagrangian().subs({G_1: G, G_2: -G})
bar = sp.cosh(u1 - u2) - k * sp.sinh(u1 - u2) - sp.cos(al2 - al1)
Formula(L, "L")

# %%
Formula(bar, "g")

# %% [markdown]
# ## First symmetry: time reversal and $y\to-y$
#
# The map is $\alpha_i\to-\alpha_i$ with $t\to-t$. Then $\dot\alpha_i$ is unchanged and $\dot u_i$ changes sign:

# %%
mirrored = {al1: -al1, al2: -al2, u1_v: -u1_v, u2_v: -u2_v}
prove(
    (L.xreplace(mirrored), bar.xreplace(mirrored)),
    (L, bar),
    "Lagrangian and bar under time reversal and y → −y",
    equations=("L^* = L", "g^* = g"),
)

# %% [markdown]
# ## Second symmetry: exchange of the rotors, $x\to-x$, and time reversal with $y\to-y$
#
# The map is $u_1\to-u_2$, $u_2\to-u_1$, $\alpha_1\to-\alpha_2$, $\alpha_2\to-\alpha_1$ with $t\to-t$:

# %%
exchanged = {u1: -u2, u2: -u1, al1: -al2, al2: -al1, u1_v: u2_v, u2_v: u1_v, al1_v: al2_v, al2_v: al1_v}
prove(
    (L.xreplace(exchanged), bar.xreplace(exchanged)),
    (L, bar),
    "Lagrangian and bar under exchange of the rotors and time reversal",
    equations=("L^* = L", "g^* = g"),
)

# %% [markdown]
# ## A quarter of a period determines the orbit
#
# If a motion passes through a state that a time-reversing symmetry leaves unchanged, its past is the image of its future. The
# first symmetry leaves the states with $\Delta=\alpha=0$, $\dot U=0$ unchanged. For the second symmetry

# %%
U_after, alpha_after = (
    ((u1 + u2) / 2).xreplace(exchanged),
    ((al1 + al2) / 2).xreplace(exchanged),
)
twist_after = (al2_v - al1_v).xreplace(exchanged)
prove(
    (U_after, alpha_after, twist_after),
    (-(u1 + u2) / 2, -(al1 + al2) / 2, -(al2_v - al1_v)),
    "U, α and the rate of the twist change sign, so they vanish in an unchanged state",
    names=("U^*", r"\alpha^*", r"\dot\Delta^*"),
)

# %% [markdown]
# A motion that leads from the first set of states to the second in the time $T/4$ is therefore periodic with the period $T$.
# These are three conditions, $U=\alpha=0$ and $\dot\Delta=0$, for the unknowns $\dot\Delta(0)$, $\dot\alpha(0)$ and $T/4$ at
# given $r_0$. `lagrotor` solves them by Newton's method with the exact derivative of the flow. It then follows the solutions
# along their curve.

# %%
BARS = {
    "massless, k = 1": Link(1, 0, 0),
    "massless, k = 0.6": Link(0.6, 0, 0),
    "m = 1, K = 0.05, k = 1": Link(1, 1, 0.05),
}
amplitudes = np.array([0.2, 0.6, 0.8, 0.9])


def scene_of(link: Link) -> Scene:
    """Return a pair with opposite spins of 10 rad/s and a bar."""
    return Scene(spins=(10, -10), link=link)


def ends() -> dict[str, OrbitFamily]:
    """Each family from r_0 = 0.05 up to 0.99."""
    return {name: trace_family(scene_of(link)) for name, link in BARS.items()}


# %% [markdown]
# ## The frequency curve

# %%
curves, errors = {}, []
for name, link in list(BARS.items())[:2]:
    family = orbit_family(scene_of(link), amplitudes)
    curves[name] = family.frequencies / natural_rate(scene_of(link))
    errors.append(family.frequency_errors.max() / natural_rate(scene_of(link)))
rows = " and ".join(f"{', '.join(f'{v:.5f}' for v in values)} ({name})" for name, values in curves.items())
assert all(values[0] < 1 for values in curves.values())
assert curves["massless, k = 1"][3] > curves["massless, k = 1"][2]
Remark(
    "The family of orbits",
    f"At r_0 = {', '.join(map(str, amplitudes))} the frequency ratio Ω/Ω_0 is {rows}. The estimated errors are at most "
    f"{max(errors):.1e}. For k = 1 the frequency decreases, has a minimum and increases again. With a massless bar longer than "
    "√(3/2) R it increases from the start (s5_3b). The families have no turning point up to r_0 = 0.99. They end at r_0 = 1, "
    "where the axes lie along the joint line.",
)

# %% [markdown]
# ## Error of the series
#
# The frequency through $r_0^3$ (t3) is compared with the exact frequency at the smallest of these amplitudes:

# %%
law = paired_frequency(3)
deviations = {}
for name, link in list(BARS.items())[:2]:
    at = (amplitudes[0], scene_of(link).sigma, scene_of(link).k)
    deviations[name] = (abs(float(law(*at)) - curves[name][0]), float(law.error(*at)))
assert all(error < bound for error, bound in deviations.values())
Remark(
    "The series at r_0 = 0.2",
    "The frequency through r_0³ differs from the exact frequency by "
    + " and ".join(f"{error:.1e} (estimated {bound:.1e}; {name})" for name, (error, bound) in deviations.items())
    + ".",
)
