# %% [markdown]
# # Are the integrals complete?
#
# **Objective.** The question if the pair has a first integral other than the energy $E$, the axial momenta $G_i$ and the momentum
# $P$ about the joint line; motions that are regular without one; the prediction horizon of chaotic motions.
#
# **Assumptions.** Opposite spins, no external force; numbers for a heavy bar, with which the mean $x$ turns back.
#
# **Notation.** $\alpha$ the azimuth about the joint line; $\lambda$ the largest Lyapunov exponent, per turn of the swing.

# %%
import warnings

import numpy as np

from lagrotor import Link, Scene, consistent_scene, natural_rate, simulate
from lagrotor.errors import LagrotorWarning
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.variational import flow
from lagrotor.pair import leaning_lagrangian
from lagrotor.pair.notation import LEANING
from lagrotor.paper import Remark, prove

# %% [markdown]
# ## The reduced motion
#
# Without the spins the pair has three degrees of freedom. One of them is cyclic:

# %%
prove(leaning_lagrangian().diff(LEANING.q[2]), 0, "the azimuth does not occur", names=r"\partial L/\partial\alpha")

# %% [markdown]
# With $E$ and $P$ fixed, the motion lies on a surface of three dimensions. One more integral would confine every motion to a
# surface of two dimensions, a curve in a Poincaré section. The distance of neighbouring motions would then grow at most like a
# power of time, $\lambda=0$, except near unstable orbits. Near rest such an integral exists to every order, the action of the
# swing (t11); its series need not converge.


# %%
PAIR = Scene((10, -10), link=Link(1.5, 12.0, 0.1))
RATE = natural_rate(PAIR)


def start(r0: float, momentum: float, phase: float = 0.0) -> Scene:
    """Return an upright start with P/G and the energy of a swing of amplitude r0, as a swing (phase 0) or a twist (π/2)."""
    turn = -momentum * PAIR.momenta[0] / (2 * sum(PAIR.inertias))
    swing, twist = r0 * RATE * np.cos(phase), r0 * RATE * np.sin(phase) * np.sqrt(PAIR.sigma)
    rates = ((swing, turn - twist, 0), (swing, turn + twist, 0))
    return consistent_scene(PAIR.spins, ((0, 0, 1),) * 2, rates, PAIR.rotor, PAIR.link)


def log_distances(scene: Scene, turns: int, piece: int = 1) -> np.ndarray:
    """Return the logarithm of the growth of an infinitesimal perturbation after every `piece` turns."""
    through, state, time = flow(scene), MODEL.start(scene), 2 * np.pi / RATE * piece
    unit, total = np.repeat([1.0, RATE], 3), [0.0]
    direction = unit * np.array([0.5, 0.6, 0.2, 0.3, -0.4, 0.3])
    for _ in range(turns // piece):
        step = through(state, time, 1e-9)
        state, direction = step.end, step.slope @ direction
        size = float(np.linalg.norm(direction / unit))
        direction, total = direction / size, [*total, total[-1] + np.log(size)]
    return np.array(total)


small, wide = start(0.05, -0.3), start(0.3, 0.1)
slow, fast = log_distances(small, 40), log_distances(wide, 40)
power = (slow[40] - slow[10]) / np.log(4)
assert power < 2.2 and fast[40] > 20
Remark(
    "Regular and chaotic",
    f"At r_0 = 0.05, P/G = −0.3 a perturbation grows ∝ t^{power:.2f}; at r_0 = 0.3, P/G = 0.1 it grows as exp(λ t) with "
    f"λ = {fast[40] / 40:.2f} per turn. With one more integral such growth would occur only near an unstable orbit. Figure t13 "
    "shows both kinds of motion over amplitude and momentum.",
)

# %% [markdown]
# ## The horizon
#
# An initial error $\varepsilon$ grows to the tolerance within $\ln(\mathrm{tol}/\varepsilon)/\lambda$ turns. The horizon of a run
# is this time:

# %%
with warnings.catch_warnings():
    warnings.simplefilter("ignore", LagrotorWarning)
    run = simulate(wide, np.linspace(0, 40 * 2 * np.pi / RATE, 801), tol=1e-6)
horizon = run.horizon * RATE / (2 * np.pi)
reach = float(np.interp(np.log(1e-6 / 1e-14), fast, np.arange(41)))
assert 0.4 * reach < horizon < 2.5 * reach
Remark(
    "How long a run is known",
    f"The run keeps tol = 10⁻⁶ for {horizon:.0f} turns; an initial error of 10⁻¹⁴ grows to it within {reach:.0f} turns.",
)
