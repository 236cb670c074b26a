# %% [markdown]
# # The length of the bar under the ansatz (5.17 to 5.19)
#
# **Objective.** The length that the bar would have if both inclinations were constant: its projection on the X-Y plane, its value
# under the ansatz, and its range.
#
# **Assumptions.** Ideal joints at the distance $\ell$, axes of length $R$. The paper's $\ell = R = 1$ is named where it is used.
#
# **Notation.** $\theta_i$, $\phi_i$ inclinations and azimuths of the axes; $\varepsilon$ scales both inclinations,
# $\theta_i = \varepsilon\,\vartheta_i$; $C$ the projected length.

# %%
import sympy as sp

from lagrotor.pair import axis
from lagrotor.pair.notation import ANSATZ, PAIR, R, ell, r0, theta_0
from lagrotor.paper import Premise, prove, verdict
from lagrotor.paper.grammar import norm
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.ansatz import one_inclination, opposite_azimuths
from lagrotor.paper.rotor_pair.premises import BAR_AS_LONG_AS_ROTORS, UNIT_LENGTH
from lagrotor.paper.rotor_pair.runs import PAPER_R0

theta_1, phi_1, _, theta_2, phi_2, _ = PAIR.q
phi = ANSATZ.q[2]

# %% [markdown]
# ## Projected on the plane
#
# The tips lie $R\,r_i$ from their joints. The projection of the bar leaves out its vertical part,
# $R(\cos\theta_2 - \cos\theta_1)$, whose square is of fourth order in the inclinations:

# %%
bar = sp.Matrix([ell, 0, 0]) + R * (axis(theta_2, phi_2) - axis(theta_1, phi_1))
projected = bar[:2, :]
prove(
    bar.dot(bar) - projected.dot(projected),
    R**2 * (sp.cos(theta_2) - sp.cos(theta_1)) ** 2,
    "what the projection leaves out of the squared length",
    names=r"\|\vec r_2 - \vec r_1\|^2 - C^2",
)

# %%
epsilon, v_1, v_2 = sp.symbols("varepsilon vartheta_1 vartheta_2", real=True)
small = Premise("the inclinations are small, θᵢ = εϑᵢ", {theta_1: epsilon * v_1, theta_2: epsilon * v_2}, small=epsilon)
units = [BAR_AS_LONG_AS_ROTORS, UNIT_LENGTH]
verdict(
    "5.17",
    {r"\|\vec r_2 - \vec r_1\|(\theta_i, \phi_i)": norm(bar)},
    premises=[*units, small],
    uses=["5.09"],
    form={
        r"\|\vec r_2 - \vec r_1\|(\theta_i, \phi_i)": form(
            "norm(ell*hat_x + R*(hat_r_2 - hat_r_1))",
            hat_x=sp.Matrix([1, 0, 0]),
            hat_r_1=axis(theta_1, phi_1),
            hat_r_2=axis(theta_2, phi_2),
        )
    },
)

# %% [markdown]
# ## Under the ansatz
#
# The square of the projected length, for any azimuths:

# %%
C_squared = projected.dot(projected)
x_1, x_2 = (R * sp.sin(theta) * sp.cos(azimuth) for theta, azimuth in ((theta_1, phi_1), (theta_2, phi_2)))
y_1, y_2 = (R * sp.sin(theta) * sp.sin(azimuth) for theta, azimuth in ((theta_1, phi_1), (theta_2, phi_2)))
prove(C_squared, (ell + x_2 - x_1) ** 2 + (y_2 - y_1) ** 2, "the square of the projected length", names=r"C^2")

# %%
C_written = form(
    "(ell + R*(sin(theta_2)*cos(phi_2) - sin(theta_1)*cos(phi_1)))**2"
    " + R**2*(sin(theta_2)*sin(phi_2) - sin(theta_1)*sin(phi_1))**2"
)
verdict("5.18", {"C^2": C_squared}, [*units, opposite_azimuths()], uses=["5.17"], form=C_written)

# %% [markdown]
# ## At one constant inclination
#
# With $\ell = R = 1$, opposite azimuths and one inclination, $C^2 = 1 + 4\sin^2\theta_0\,\sin^2\phi$: least at $\phi = 0$,
# largest at $\phi = \pi/2$, of period $\pi$.

# %%
assumed = [*units, opposite_azimuths(), one_inclination()]
level = C_squared
for premise in assumed:
    level = premise.on(level)
prove(
    level, 1 + 4 * sp.sin(theta_0) ** 2 * sp.sin(phi) ** 2, "the square of the length at one inclination", names="C^2"
)

# %%
longest = float(sp.sqrt(1 + (2 * r0) ** 2).subs(r0, PAPER_R0))
verdict(
    "5.19",
    {"C^2(0)": C_squared, r"C^2(\pi/2)": C_squared, r"C(\pi/2)": norm(projected), r"C^2(\phi)": C_squared},
    premises=assumed,
    uses=["5.18"],
    evidence=[f"At r₀ = {PAPER_R0} the bar would have to stretch to {longest:.4f} times its length."],
    form={
        "C^2(0)": form("1"),
        r"C^2(\pi/2)": form("1 + 4*sin(theta_0)**2"),
        r"C(\pi/2)": form("sqrt(1 + 4*sin(theta_0)**2)"),
        r"C^2(\phi)": form("1 + 4*sin(theta_0)**2*sin(phi)**2"),
    },
)
