# %% [markdown]
# # The family of paired precessions to its end
#
# **Objective.** Frequency against amplitude, and where the family turns or ends: found by continuation along the curve.
#
# **Assumptions.** Opposite spins. Here few orbits of each bar; `ends()` follows the families to $r_0 = 0.99$.
#
# **Notation.** $r_0$ as before; the frequency in units of $\Omega_0$.

# %%
import numpy as np

from lagrotor import Link, Scene, natural_rate
from lagrotor.models.orbits.continuation import OrbitFamily, orbit_family, trace_family
from lagrotor.paper.notebook import findings_table

statements: list = []
findings: list[tuple[str, str]] = []

BARS = {
    "massless, k = 1": Link(1, 0, 0),
    "massless, k = 0.6": Link(0.6, 0, 0),
    "m = 1, K = 0.05, k = 1": Link(1, 1, 0.05),
}
amplitudes = np.array([0.2, 0.6, 0.8, 0.9])


def scene_of(link: Link) -> Scene:
    """Opposite spins of 10 rad/s with a bar."""
    return Scene(spins=(10, -10), link=link)


def ends() -> dict[str, OrbitFamily]:
    """Each family from r_0 = 0.05 as far as 0.99."""
    return {name: trace_family(scene_of(link)) for name, link in BARS.items()}


BARS

# %% [markdown]
# ## The frequency curve

# %%
curves = {}
for name, link in list(BARS.items())[:2]:
    family = orbit_family(scene_of(link), amplitudes)
    curves[name] = family.frequencies / natural_rate(scene_of(link))
rows = "; ".join(f"{name}: " + ", ".join(f"{v:.5f}" for v in values) for name, values in curves.items())
assert all(values[0] < 1 for values in curves.values())
assert curves["massless, k = 1"][3] > curves["massless, k = 1"][2]

findings.append(
    (
        "The family of orbits",
        f"Omega/Omega_0 at r_0 = {', '.join(map(str, amplitudes))}: {rows}. For k = 1 the frequency "
        "falls, passes a least value and rises again; a long bar's only rises. The families are followed to "
        "r_0 = 0.99 without a turn (`ends`, slow): they end where the axes come to lie along the joint line, r_0 = 1.",
    )
)
findings_table(findings)
