# %% [markdown]
# # A rocking block
#
# **Objective.** The loss of angular velocity at each impact of a block that rocks from one of its lower edges to the other
# (Housner 1963), and the decay of the rocking.
#
# **Assumptions.** A uniform block of mass $m$ rotates about the left or right lower edge without sliding or rebounding.
#
# **Notation.** $R$ the distance from an edge to the centre, $\alpha$ the angle between this line and the vertical for the
# block at rest, $\theta$ the tilt, positive about the right edge; the inertia about an edge is $\tfrac43 mR^2$.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Event, System, SystemRun, coordinates
from lagrotor.paper import Remark, prove, scientific

m, g, R, alpha = sp.symbols("m g R alpha", positive=True)
c = coordinates("theta")
(theta,), (rate,) = c.q, c.v
height = R * sp.cos(alpha - sp.Abs(theta))
block = System(c, sp.Rational(2, 3) * m * R**2 * rate**2 - m * g * height)
rate_ratio = 1 - sp.Rational(3, 2) * sp.sin(alpha) ** 2
rocking = Event(theta, velocities=(rate_ratio * rate,))

# %% [markdown]
# ## The angular velocity after an impact
#
# The reaction acts at the new edge, so the angular momentum about this edge is conserved. Before the impact the velocity of
# the centre is perpendicular to the line from the old edge.

# %%
w, omega_1 = sp.symbols("omega omega_1", positive=True)
old, new = sp.Matrix([R * sp.sin(alpha), 0]), sp.Matrix([-R * sp.sin(alpha), 0])
centre = sp.Matrix([0, R * sp.cos(alpha)])
velocity = w * sp.Matrix([-(centre - old)[1], (centre - old)[0]])
arm = centre - new
about_new = m * R**2 / 3 * w + m * (arm[0] * velocity[1] - arm[1] * velocity[0])
(rate_after,) = sp.solve(sp.Eq(about_new, sp.Rational(4, 3) * m * R**2 * omega_1), omega_1)
prove(
    sp.expand_trig(rate_after / w),
    rate_ratio,
    "the ratio of the rates after and before an impact",
    names=r"\omega_1/\omega",
)

# %% [markdown]
# ## The decay of the tilt
#
# Between two impacts the energy is conserved. Therefore the largest tilt $\theta_1$ after an impact follows from the largest tilt
# $\theta_0$ before it: $\cos(\alpha-\theta_1)-\cos\alpha = r^2\,(\cos(\alpha-\theta_0)-\cos\alpha)$ with the ratio
# $r=\omega_1/\omega$.

# %%
tilt = sp.Symbol("theta_0", positive=True)
energy = m * g * R * (sp.cos(alpha - tilt) - sp.cos(alpha))
rate_squared = energy / (sp.Rational(2, 3) * m * R**2)
prove(
    sp.Rational(2, 3) * m * R**2 * rate_ratio**2 * rate_squared,
    rate_ratio**2 * m * g * R * (sp.cos(alpha - tilt) - sp.cos(alpha)),
    "the energy after an impact",
    names="E_1",
)

# %% [markdown]
# ## Comparison with a simulation
#
# The force is discontinuous at zero tilt, and the rate is discontinuous at each impact. The largest tilts occur at zero rate.

# %%
values, times, twin = {m: 80.0, g: 9.81, R: 1.1, alpha: 0.3}, np.linspace(0, 6.6, 241), {alpha: 0.301}


def tilts(count: int) -> np.ndarray:
    """The next `count` largest tilts after 0.25 rad, for alpha = 0.3."""
    r, largest = 1 - 1.5 * np.sin(0.3) ** 2, [0.25]
    for _ in range(count):
        cosine = np.cos(0.3) + r**2 * (np.cos(0.3 - largest[-1]) - np.cos(0.3))
        largest.append(0.3 - np.arccos(cosine))
    return np.array(largest[1:])


def motion(parameters: dict) -> SystemRun:
    """Simulate the block from rest at 0.25 rad."""
    return block.simulate(parameters, (0.25,), (0,), times, 1e-9, events=rocking)


def distance(run: SystemRun) -> float:
    """The largest difference of the largest tilts, rad."""
    return float(np.abs(np.abs(run.crossings(rate).q[:6, 0]) - tilts(6)).max())


def difference(parameters: dict) -> float:
    """The same for a new simulation."""
    return distance(motion(parameters))


run = motion(values)
off = distance(run)
assert off < 1e-9
Remark("Result", f"The largest difference of the first six largest tilts is {scientific(off, 1)} rad.")

# %% [markdown]
# ## The motion
#
# The block is released at 0.25 rad. The impacts follow each other ever faster. Infinitely many occur before 6.82 s, so the
# picture ends at 6.6 s.

# %%
picture = run.plot()
picture
