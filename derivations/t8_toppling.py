# %% [markdown]
# # Toppling, exactly
#
# **Objective.** Uniform turning about the joint line as an exact solution at any angle, and its stability; what it says
# of a shock of $+50$ against one of $-50$ along y.
#
# **Assumptions.** Both axes parallel in the y-z plane; any bar.
#
# **Notation.** $\alpha' = \nu$, $A=a+b$, $D=a-b$, $G=G_1=-G_2$, $e = b\nu^2 - G\nu/k$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.algebra import decide_zero
from lagrotor.pair.symbols import G_1, G_2, G, a, b, k, nu
from lagrotor.paper.notebook import findings_table
from lagrotor.theory.shock_response import shock_response
from lagrotor.theory.toppling import toppling_growth, toppling_polynomial, toppling_residual, toppling_threshold

statements: list = []
findings: list[tuple[str, str]] = []

# %% [markdown]
# ## An exact solution, of opposite spins only

# %%
left = toppling_residual()
assert all(decide_zero(e.subs(G_2, -G_1)).answer == "zero" for e in left)
assert decide_zero(left[0] + (G_1 + G_2) * nu).answer == "zero"
assert decide_zero(left[0]).answer == "nonzero"
left[0]

# %% [markdown]
# ## Stability
#
# $A D s^4 + (G^2 + A D \nu^2 + 2 A e) s^2 + 2 A \nu^2 e = 0$. The discriminant is
# $(A D\nu^2 - 2Ae)^2 + G^4 + 2G^2(AD\nu^2 + 2Ae)$, positive for $e > 0$: all $s^2$
# negative, stable. For $e<0$ one $s^2$ is positive.

# %%
two, one, zero = toppling_polynomial()
A, D, e = a + b, a - b, b * nu**2 - G * nu / k
for found, expected in ((two, A * D), (one, G**2 + A * D * nu**2 + 2 * A * e), (zero, 2 * A * nu**2 * e)):
    assert decide_zero(found - expected).answer == "zero"
discriminant = (A * D * nu**2 - 2 * A * e) ** 2 + G**4 + 2 * G**2 * (A * D * nu**2 + 2 * A * e)
assert decide_zero(one**2 - 4 * two * zero - discriminant).answer == "zero"
edge = toppling_threshold().expressions[0]
small = sp.factor(sp.limit(-zero / one / nu**3, nu, 0))
sp.Eq(nu, edge)

# %% [markdown]
# ## Predicted and measured

# %%


def measured(link: Link, rate: float) -> tuple[float, float]:
    """(predicted, measured) growth rate (1/s) of a tilt of 1e-9 out of the plane."""
    scene = Scene(spins=(10, -10), link=link, rates=((1e-9, -rate, 0.0),) * 2)
    predicted = float(toppling_growth()(rate, 10.0, *scene.inertias, link.length))
    times = np.linspace(8 / predicted, 13 / predicted, 41)
    x = np.abs(simulate(scene, times, "spheres", 1e-12).axes[:, :, 0].mean(0))
    return predicted, float(np.polyfit(times, np.log(x), 1)[0])


pairs = {
    "massless, nu = 2": measured(Link(1, 0, 0), 2.0),
    "m = 1, K = 1, nu = −15": measured(Link(1, 1, 1), -15.0),
}
assert all(abs(p / q - 1) < 0.01 for p, q in pairs.values())
pairs

# %% [markdown]
# ## A shock of +50 and one of −50 along y

# %%
shocks = {}
for force in (50, -50):
    scene = Scene(spins=(10, -10), link=Link(1, 1, 1), shock=Shock((0, force, 0), 2, 1 / 50))
    rate = shock_response(scene).toppling_rate
    growth = float(toppling_growth()(rate, 10.0, *scene.inertias, 1.0))
    x = simulate(scene, np.linspace(2.5, 20, 200), "spheres", 1e-8).axes[:, :, 0].mean(0)
    shocks[force] = (rate, growth, float(np.ptp(x)))
assert shocks[50][1] == 0 < shocks[-50][1]
assert shocks[-50][2] > shocks[50][2]

rows = "; ".join(f"{name}: predicted {p:.4f}, measured {q:.4f}" for name, (p, q) in pairs.items())
findings.append(
    (
        "Toppling is exact",
        "Uniform turning about the joint line solves the equations at any angle and rate if and only if (G_1 + G_2) nu = 0.",
    )
)
findings.append(
    (
        "Stability of toppling",
        f"Stable for b nu² > G nu/k, unstable for b nu² < G nu/k; without inertia in the bar only the sense "
        f"counts. Threshold nu = {edge}; "
        f"slow unstable turning grows with s² = ({small}) nu³. Growth rates (1/s): {rows}.",
    )
)
findings.append(
    (
        "+50 against −50 along y",
        "; ".join(
            f"F_y = {force:+d} N turns the pair at {rate:+.3f} rad/s, growth {growth:.3f} 1/s, exact mean x within "
            f"{width:.3f} R from 2.5 to 20 s"
            for force, (rate, growth, width) in shocks.items()
        )
        + ".",
    )
)
findings_table(findings)
