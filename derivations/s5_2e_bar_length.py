# %% [markdown]
# # The length of the bar under the ansatz (5.17 to 5.19)
#
# **Objective.** How long the bar would be if both inclinations stayed constant: projected on the X-Y plane, under the
# ansatz, and its range.
#
# **Assumptions.** $\ell = R = 1$, as the paper puts numbers in.
#
# **Notation.** $\varepsilon$ scales both inclinations, $\theta_i = \varepsilon\,\vartheta_i$.

# %%
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.pair.lagrangians import axis
from lagrotor.pair.symbols import PAIR, r0, theta_0
from lagrotor.paper.ledger import Relation, chain
from lagrotor.paper.legacy import stated
from lagrotor.paper.notebook import Judged

th1, ph1, _, th2, ph2, _ = PAIR.q
half = sp.Rational(1, 2)
joint = sp.Matrix([half, 0, 0])
bar = (joint + axis(th2, ph2)) - (-joint + axis(th1, ph1))
squared = bar.dot(bar)
bar

# %% [markdown]
# ## Projected on the plane
#
# What the projection leaves out is $(\cos\theta_1 - \cos\theta_2)^2$, of fourth order in the inclinations.

# %%
first = sp.Matrix([sp.sin(th1) * sp.cos(ph1) - half, sp.sin(th1) * sp.sin(ph1)])
second = sp.Matrix([sp.sin(th2) * sp.cos(ph2) + half, sp.sin(th2) * sp.sin(ph2)])
flat = (first - second).dot(first - second)
left_out = sp.cos(th1) - sp.cos(th2)
assert decide_zero(squared - flat - left_out**2).answer == "zero"
small, v1, v2 = sp.symbols("varepsilon vartheta_1 vartheta_2", real=True)
scaled = {th1: small * v1, th2: small * v2}
left_out**2

# %% [markdown]
# ## Under the ansatz, and at one constant inclination

# %%
phi = sp.Symbol("phi", real=True)
s1, s2 = sp.sin(th1), sp.sin(th2)
under_ansatz = flat.subs({ph1: phi, ph2: -phi})
printed_vectors = (s1 * sp.cos(phi) - half - (s2 * sp.cos(phi) + half)) ** 2 + (
    s1 * sp.sin(phi) + s2 * sp.sin(phi)
) ** 2
printed_C = (1 + sp.cos(phi) * (s2 - s1)) ** 2 + sp.sin(phi) ** 2 * (s2 + s1) ** 2

level = under_ansatz.subs({th1: theta_0, th2: theta_0})
swing = level.subs(sp.sin(theta_0), r0)
# C² = 1 + 4 sin² theta_0 sin² phi: least at phi = 0, largest at pi/2, with period pi.
assert decide_zero(level - 1 - 4 * sp.sin(theta_0) ** 2 * sp.sin(phi) ** 2).answer == "zero"
largest = sp.sqrt(1 + (2 * r0) ** 2)
at_paper = float(largest.subs(r0, sp.Rational(204, 1000)))

statements = [
    stated(
        "5.17",
        (Relation(sp.sqrt(flat.subs(scaled)), sp.sqrt(squared.subs(scaled)), small, 2),),
        depends_on=("5.09",),
        evidence=("Left out is (cos theta_1 − cos theta_2)² in the square of the length (decided).",),
    ),
    stated(
        "5.18",
        chain(under_ansatz, printed_vectors, printed_C),
        depends_on=("5.17",),
        evidence=("Judged on the squares: both sides of the root are lengths and not negative.",),
    ),
    stated(
        "5.19",
        (
            Relation(sp.Integer(1), level.subs(phi, 0)),
            Relation(1 + (2 * sp.sin(theta_0)) ** 2, level.subs(phi, sp.pi / 2)),
            Relation(level.subs(phi, phi + sp.pi), level),
            Relation(1 + half * (2 * r0) ** 2, sp.sqrt(swing.subs(phi, sp.pi / 2)), r0, 2),
        ),
        depends_on=("5.18",),
        evidence=(
            "C² = 1 + 4 sin² theta_0 sin² phi (decided), so the ends of the range are at phi = 0 and pi/2.",
            f"At r_0 = 0.204 the bar would have to stretch to {at_paper:.4f} of its length.",
        ),
    ),
]
Judged(statements)
