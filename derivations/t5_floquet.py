# %% [markdown]
# # Stability of the paired precession
#
# **Objective.** Floquet multipliers of the exact orbit: where it is elliptic, where hyperbolic, and the growth per turn
# as a power of the amplitude.
#
# **Assumptions.** Opposite spins; small amplitudes for the powers.
#
# **Notation.** $\mu$, $1/\mu$ the two multipliers that are not 1; $\log\mu = 2\pi\lambda$.

# %%
import numpy as np
import sympy as sp

from lagrotor import Link, Scene
from lagrotor.algebra import decide_zero
from lagrotor.models.orbits.floquet import floquet
from lagrotor.numerics.convergence import measured_order
from lagrotor.pair.symbols import SWING, G, a, b
from lagrotor.paper.notebook import findings_table
from lagrotor.theory.averaging import slow_rates, slow_stiffness
from lagrotor.theory.paired_precession.stability import growth_squared

statements: list = []
findings: list[tuple[str, str]] = []

# %% [markdown]
# ## What the averaged motion says
#
# To third order the mean twist stays, and the mean x feels nothing: its stiffness vanishes, that of the twist is
# proportional to $b$. So $\lambda^2$ is a product of one term of order $r_0^2$, with the sign of $-b$, and one of
# order $r_0^4$: growth per turn as $r_0^3$; with $b=0$ as $r_0^4$.

# %%
in_x, in_twist = slow_stiffness()
assert decide_zero(in_x).answer == "zero"
assert decide_zero(in_twist - b * G**2 * SWING**2 / (8 * (a**2 - b**2))).answer == "zero"
assert decide_zero(slow_rates()[1]).answer == "zero"
in_twist

# %% [markdown]
# ## Measured on exact orbits

# %%
BARS = {
    "massless, k = 1": (Link(1, 0, 0), (0.1, 0.14)),
    "m = 0.01, K = 0.1": (Link(1, 0.01, 0.1), (0.06, 0.09)),
    "m = 0.4, K = 0.05, k = 1": (Link(1, 0.4, 0.05), (0.06, 0.09)),
}


def measure(link: Link, amplitudes: tuple[float, ...]) -> tuple[str, float, float]:
    """(kind, slope of |mu + 1/mu − 2|, its coefficient over the one of `leading_square` extrapolated to r_0 = 0)."""
    scene = Scene(spins=(10, -10), link=link)
    law = growth_squared(8, dumbbell=True) if scene.sigma == 1 else growth_squared()
    found = [floquet(scene, r0) for r0 in amplitudes]
    excess = np.array([f.pair_sum - 2 for f in found])
    squares = np.array([float(np.arccosh(complex(1 + e / 2)).real ** 2) for e in excess])
    squares = np.where(excess > 0, squares, -(np.arccos(np.clip(1 + excess / 2, -1, 1)) ** 2)) / (4 * np.pi**2)
    ratio = squares / [float(law(r0, scene.sigma, scene.k)) for r0 in amplitudes]
    (near, far), (r, q) = ratio[:2], amplitudes[:2]
    return found[0].kind, measured_order(amplitudes, np.abs(excess)), float(near + (near - far) * r**2 / (q**2 - r**2))


measured = {name: measure(link, amplitudes) for name, (link, amplitudes) in BARS.items()}
assert measured["massless, k = 1"][0] == "hyperbolic"
assert measured["m = 0.01, K = 0.1"][0] == "hyperbolic"
assert measured["m = 0.4, K = 0.05, k = 1"][0] == "elliptic"
assert all(abs(coefficient - 1) < 0.01 for *_, coefficient in measured.values())

rows = "; ".join(
    f"{name}: {kind}, mu + 1/mu − 2 ~ r_0^{slope:.2f}, coefficient/expected {ratio:.4f}"
    for name, (kind, slope, ratio) in measured.items()
)
findings.append(
    (
        "Stability of the paired precession",
        "At small amplitude it is elliptic for b > 0 and hyperbolic for b <= 0, lambda² = (3/16) sigma² (1 − sigma) r_0⁶/k² "
        f"per radian, and (9/32) r_0⁸/k⁴ for sigma = 1 (powers derived, factors identified). Measured: {rows}. In the "
        "paper's scene the growth per turn at r_0 = 0.204 is "
        f"{floquet(Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)), 0.204).growth:.5f}.",
    )
)
onset = sp.Rational(2, 3)
findings.append(
    (
        "Elliptic to hyperbolic",
        f"The two leading terms balance at r_0² = {onset} sigma² (sigma − 1) k² for sigma slightly above 1: beyond it even "
        "b > 0 gives a hyperbolic orbit.",
    )
)
findings_table(findings)
