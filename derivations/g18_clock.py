# %% [markdown]
# # The escapement of a clock
#
# **Objective.** The amplitude of a clock with dry friction, which is independent of the initial amplitude (Andronov, Vitt &
# Khaikin, *Theory of Oscillators*, ch. III).
#
# **Assumptions.** A balance of unit mass and stiffness under dry friction $F$. When it passes $x=0$ to the right, the
# escapement adds the energy $k^2/2$.
#
# **Notation.** $a_n$ the largest elongation to the right in the $n$-th period.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Event, System, coordinates
from lagrotor.paper import Remark, prove, scientific

F, k, a = sp.symbols("F k a", positive=True)
c = coordinates("x")
(x,), (v,) = c.q, c.v
clock = System(c, v**2 / 2 - x**2 / 2, forces=(-F * sp.sign(v),))
escapement = Event(x, velocities=(sp.sqrt(v**2 + k**2),), direction=1)

# %% [markdown]
# ## One period
#
# Motion to the left is harmonic about $+F$, motion to the right is harmonic about $-F$. From $a$ on the right the balance
# moves to $-(a-2F)$ on the left. It then passes $x=0$ with the speed $u$, $u^2=(a-3F)^2-F^2$.

# %%
u_squared = (a - 3 * F) ** 2 - F**2
prove(a - 2 * F, -(F - (a - F)), "the largest elongation to the left", names="b")

# %%
following = sp.sqrt(u_squared + k**2 + F**2) - F
prove((following + F) ** 2, (a - 3 * F) ** 2 + k**2, "the next elongation to the right", names="(a_1+F)^2")

# %% [markdown]
# ## The amplitude of the periodic motion
#
# The motion is periodic if $(a+F)^2=(a-3F)^2+k^2$. The only solution is $a=F+k^2/(8F)$.

# %%
(steady,) = sp.solve(sp.Eq((a + F) ** 2, (a - 3 * F) ** 2 + k**2), a)
prove(steady, F + k**2 / (8 * F), "the amplitude of the clock", names="a")

# %%
slope = (a - 3 * F) / (following + F)
prove(
    slope.subs(k, 0).subs(a, 5 * F),
    sp.Integer(1),
    "without impulses a difference of amplitudes is constant",
    names=r"a_1'",
)

# %% [markdown]
# ## Comparison with a simulation
#
# The simulation follows the stick and slip of the friction and locates the impulses.

# %%
values, times, twin = {F: 0.02, k: 0.35}, np.linspace(0, 80, 401), {F: 0.0201}


def elongations(start: float, count: int) -> np.ndarray:
    """Largest elongations to the right for F = 0.02 and k = 0.35."""
    largest = [start]
    for _ in range(count):
        largest.append(np.sqrt((largest[-1] - 0.06) ** 2 + 0.35**2) - 0.02)
    return np.array(largest[1:])


def difference(parameters: dict) -> float:
    """The largest difference of ten elongations."""
    run = clock.simulate(parameters, (2.0,), (0,), times, 1e-11, events=escapement)
    return float(np.abs(run.crossings(v, -1).q[:10, 0] - elongations(2.0, 10)).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of ten elongations is {scientific(off, 1)}.")

# %%
small, large = (
    clock.simulate(values, (start,), (0,), np.linspace(0, 400, 801), 1e-8, events=escapement) for start in (0.5, 2.0)
)
amplitude = float(steady.subs(values))
for run in (small, large):
    assert abs(run.crossings(v, -1).q[-1, 0] - amplitude) < 1e-2
Remark(
    "Amplitude",
    f"Runs from the elongations 0.5 and 2 both tend to the amplitude {amplitude:.4f}.",
)

# %% [markdown]
# The picture shows the run from the elongation 2.

# %%
picture = large.plot()
picture
