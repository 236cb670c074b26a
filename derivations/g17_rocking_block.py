# %% [markdown]
# # A rocking block
#
# **Objective.** What an impact takes from a block that rocks from one of its lower edges to the other (Housner 1963), and how its
# rocking dies down.
#
# **Assumptions.** A uniform block of mass $m$ turns about the left or right lower edge without sliding or rebounding.
#
# **Notation.** $R$ from an edge to the centre, $\alpha$ the angle of that line to the vertical of the block at rest, $\theta$
# the tilt, positive about the right edge; the inertia about an edge is $\tfrac43 mR^2$.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Event, System, coordinates
from lagrotor.paper import prove

m, g, R, alpha = sp.symbols("m g R alpha", positive=True)
c = coordinates("theta")
(theta,), (rate,) = c.q, c.v
height = R * sp.cos(alpha - sp.Abs(theta))
block = System(c, sp.Rational(2, 3) * m * R**2 * rate**2 - m * g * height)
kept = 1 - sp.Rational(3, 2) * sp.sin(alpha) ** 2
rocking = Event(theta, velocities=(kept * rate,))

# %% [markdown]
# ## What an impact leaves
#
# The reaction acts at the edge that becomes the new centre of the turn: the angular momentum about it is kept. Before, the
# centre of the block moves at right angles to its line from the old edge.

# %%
w, after = sp.symbols("omega omega_1", positive=True)
old, new = sp.Matrix([R * sp.sin(alpha), 0]), sp.Matrix([-R * sp.sin(alpha), 0])
centre = sp.Matrix([0, R * sp.cos(alpha)])
velocity = w * sp.Matrix([-(centre - old)[1], (centre - old)[0]])
arm = centre - new
about_new = m * R**2 / 3 * w + m * (arm[0] * velocity[1] - arm[1] * velocity[0])
(left,) = sp.solve(sp.Eq(about_new, sp.Rational(4, 3) * m * R**2 * after), after)
prove(sp.expand_trig(left / w), kept, "the part of the rate that is left", names=r"\omega_1/\omega")

# %% [markdown]
# ## How the tilt dies down
#
# Between two impacts the energy is kept, so the next largest tilt $\theta_1$ follows from the one before, $\theta_0$:
# $\cos(\alpha-\theta_1)-\cos\alpha = r^2\,(\cos(\alpha-\theta_0)-\cos\alpha)$, with $r$ from above.

# %%
tilt = sp.Symbol("theta_0", positive=True)
energy = m * g * R * (sp.cos(alpha - tilt) - sp.cos(alpha))
rate_squared = energy / (sp.Rational(2, 3) * m * R**2)
prove(
    sp.Rational(2, 3) * m * R**2 * kept**2 * rate_squared,
    kept**2 * m * g * R * (sp.cos(alpha - tilt) - sp.cos(alpha)),
    "the energy after an impact",
    names="E_1",
)

# %% [markdown]
# ## Against the run
#
# The force jumps with the sign of the tilt, the rate at each impact; the largest tilts are where the rate is zero.

# %%
values, times, twin = {m: 80.0, g: 9.81, R: 1.1, alpha: 0.3}, np.linspace(0, 12, 241), {alpha: 0.301}


def tilts(count: int) -> np.ndarray:
    """The largest tilts, from 0.25 rad on, for alpha = 0.3."""
    r, found = 1 - 1.5 * np.sin(0.3) ** 2, [0.25]
    for _ in range(count):
        lifted = np.cos(0.3) + r**2 * (np.cos(0.3 - found[-1]) - np.cos(0.3))
        found.append(0.3 - np.arccos(lifted))
    return np.array(found[1:])


def difference(given: dict) -> float:
    """Of the largest tilts, rad."""
    run = block.simulate(given, (0.25,), (0,), times, 1e-9, events=rocking)
    largest = np.abs(run.crossings(rate).q[:6, 0])
    return float(np.abs(largest - tilts(6)).max())


off = difference(values)
assert off < 1e-9
off

# %%
run = block.simulate(values, (0.25,), (0,), times, events=rocking)
picture = run.plot()
picture
