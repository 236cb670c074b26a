# %% [markdown]
# # The escapement of a clock
#
# **Objective.** A clock with dry friction goes at one amplitude, whatever it was started with (Andronov, Vitt & Khaikin, *Theory
# of Oscillators*, ch. III).
#
# **Assumptions.** A balance of unit mass and stiffness under dry friction $F$; at each upward passage of rest the escapement
# gives it the energy $k^2/2$.
#
# **Notation.** $a_n$ the largest elongation to the right of the $n$-th turn.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Event, System, coordinates
from lagrotor.paper import prove

F, k, a = sp.symbols("F k a", positive=True)
c = coordinates("x")
(x,), (v,) = c.q, c.v
clock = System(c, v**2 / 2 - x**2 / 2, forces=(-F * sp.sign(v),))
escapement = Event(x, velocities=(sp.sqrt(v**2 + k**2),), direction=1)

# %% [markdown]
# ## One turn
#
# To the left the motion is a harmonic one about $+F$, to the right about $-F$. From $a$ on the right it comes to $-(a-2F)$ on the
# left, and passes rest with the speed $u$, $u^2=(a-3F)^2-F^2$.

# %%
u_squared = (a - 3 * F) ** 2 - F**2
prove(a - 2 * F, -(F - (a - F)), "the largest elongation to the left", names="b")

# %%
following = sp.sqrt(u_squared + k**2 + F**2) - F
prove((following + F) ** 2, (a - 3 * F) ** 2 + k**2, "the next elongation to the right", names="(a_1+F)^2")

# %% [markdown]
# ## The amplitude at which it goes
#
# It repeats itself where $(a+F)^2=(a-3F)^2+k^2$: at $a=F+k^2/(8F)$, and at no other.

# %%
(steady,) = sp.solve(sp.Eq((a + F) ** 2, (a - 3 * F) ** 2 + k**2), a)
prove(steady, F + k**2 / (8 * F), "the amplitude of the clock", names="a")

# %%
slope = (a - 3 * F) / (following + F)
prove(
    slope.subs(k, 0).subs(a, 5 * F),
    sp.Integer(1),
    "without impulses a difference stays: nothing brings it back",
    names=r"a_1'",
)

# %% [markdown]
# ## Against the run
#
# Stick and slip of the friction are followed, and the impulses located on the motion itself.

# %%
values, times, twin = {F: 0.02, k: 0.35}, np.linspace(0, 80, 401), {F: 0.0201}


def elongations(start: float, count: int) -> np.ndarray:
    """Largest elongations to the right for F = 0.02 and k = 0.35."""
    found = [start]
    for _ in range(count):
        found.append(np.sqrt((found[-1] - 0.06) ** 2 + 0.35**2) - 0.02)
    return np.array(found[1:])


def difference(given: dict) -> float:
    """Of ten elongations."""
    run = clock.simulate(given, (2.0,), (0,), times, 1e-11, events=escapement)
    return float(np.abs(run.crossings(v, -1).q[:10, 0] - elongations(2.0, 10)).max())


off = difference(values)
assert off < 1e-9
off

# %%
small, large = (
    clock.simulate(values, (start,), (0,), np.linspace(0, 400, 801), 1e-8, events=escapement) for start in (0.5, 2.0)
)
amplitude = float(steady.subs(values))
for run in (small, large):
    assert abs(run.crossings(v, -1).q[-1, 0] - amplitude) < 1e-2
amplitude

# %%
picture = large.plot()
picture
