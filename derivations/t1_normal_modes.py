# %% [markdown]
# # Normal modes of the coupled pair
#
# **Objective.** The small motions about the upright rest state for any two spins and any bar: matrices, natural
# frequency, what lies at zero.
#
# **Assumptions.** No gravity; the bar massless or not; the spins reduced (each axis feels $G_i\,r_i\times r_i'$).
#
# **Notation.** $a$, $b$ the inertias with the bar's share, $k=\ell/R$, $q=(x, y_1, y_2)$: the bar lets the axes move
# in $x$ together only.

# %%
import numpy as np
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.pair.lagrangians import INERTIAS, axes_pair
from lagrotor.pair.symbols import AXES, G_1, G_2, G, K, a, b, ell, m
from lagrotor.paper.notebook import findings_table
from lagrotor.theory.impulse_response import impulse_matrices
from lagrotor.theory.natural_frequency import natural_frequency

statements: list = []
findings: list[tuple[str, str]] = []

# %% [markdown]
# ## The matrices
#
# $M q'' + C q' = 0$: no stiffness at all.

# %%
linear = impulse_matrices()
M, C, n = linear.mass, linear.gyroscopic, linear.null
s = sp.Symbol("s")
characteristic = sp.factor((s**2 * M + s * C).det())
squared = linear.frequency_squared
expected = 2 * (a + b) * (a**2 - b**2) * s**4 * (s**2 + squared)
assert decide_zero(characteristic - expected).answer == "zero"
assert all(decide_zero(e).answer == "zero" for e in C * n)
sp.Tuple(M, C, n)

# %% [markdown]
# ## Limits

# %%
opposite = sp.factor(squared.subs({G_1: G, G_2: -G}))
equal = sp.factor(squared.subs({G_1: G, G_2: G}))
single = sp.factor(squared.subs({G_1: G, G_2: 0, b: 0}))
assert decide_zero(opposite - G**2 / (a**2 - b**2)).answer == "zero"
assert decide_zero(equal - G**2 / (a + b) ** 2).answer == "zero"
assert decide_zero(single - G**2 / (2 * a**2)).answer == "zero"
dumbbell = INERTIAS[b].subs(K, m * ell**2 / 4)
assert decide_zero(dumbbell).answer == "zero"
sp.Tuple(opposite, equal, single)

# %% [markdown]
# ## The zero modes and the static equilibria
#
# Four of the six roots are zero: three displacements at rest (a family of equilibria as large as the configuration
# space: without gravity every position at rest stays) and one uniform motion along $n$, $C n = 0$.

# %%
system = axes_pair()
rest = dict.fromkeys(AXES.v, 0)
assert system.L.subs(rest) == 0
assert all(e == 0 for e in system.push.subs(rest))
numeric = natural_frequency()
value = float(np.asarray(numeric(1.3525, -0.0975, 10.0, -10.0)))

findings.append(
    (
        "Normal modes",
        f"det(s² M + s C) = 2 (a + b)(a² − b²) s⁴ (s² + Omega_0²), Omega_0² = {squared}: one oscillation, four zero "
        f"roots. Equal spins {equal}, opposite {opposite}, one spin and a dumbbell {single}. "
        f"Paper's scene of 5.2.1: {value:.5f} rad/s.",
    )
)
findings.append(
    (
        "The zero mode",
        f"The free direction is n = {tuple(n)} in (x, y_1, y_2): toppling for opposite spins, twisting for equal ones, "
        "never x. Every position at rest is an equilibrium.",
    )
)
findings_table(findings)
