# %% [markdown]
# # Completeness of the integrals
#
# **Objective.** Evidence against a first integral besides the energy $E$, the axial momenta $G_i$ and the momentum $P$ about
# the joint line; regular motion at small amplitude, and the horizon of a chaotic run.
#
# **Assumptions.** Opposite spins, no external force. The numbers are for a heavy bar, with which the mean $x$ turns back.
#
# **Notation.** $\alpha$ the azimuth about the joint line; $\lambda$ the largest Lyapunov exponent, per period of the oscillation.

# %%
import warnings

import numpy as np

from lagrotor import Link, Scene, consistent_scene, natural_rate, simulate
from lagrotor.errors import LagrotorWarning
from lagrotor.models.minimal import MODEL
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.pair import leaning_lagrangian
from lagrotor.pair.notation import LEANING
from lagrotor.paper import Remark, prove

# %% [markdown]
# ## The reduced system
#
# With the spins eliminated the pair has three degrees of freedom. The azimuth is cyclic:

# %%
prove(
    leaning_lagrangian().diff(LEANING.q[2]),
    0,
    "the Lagrangian is independent of the azimuth",
    names=r"\partial L/\partial\alpha",
)

# %% [markdown]
# So $E$ and $P$ restrict a motion to a manifold of three dimensions. A further integral would restrict it to two dimensions,
# a curve in a Poincaré section. Neighbouring motions would then separate no faster than a power of time, $\lambda=0$, except
# at unstable orbits and the motions that approach them. Near rest the action of the oscillation (t11) is such an integral to
# every order, but its series need not converge.


# %%
PAIR = Scene((10, -10), link=Link(1.5, 12.0, 0.1))
RATE = natural_rate(PAIR)


def start(r0: float, momentum: float, phase: float = 0.0) -> Scene:
    """Upright state with the energy of an oscillation of amplitude r0: oscillation (phase 0) or twist (π/2), with P/G."""
    turn = -momentum * PAIR.momenta[0] / (2 * sum(PAIR.inertias))
    swing, twist = r0 * RATE * np.cos(phase), r0 * RATE * np.sin(phase) * np.sqrt(PAIR.sigma)
    rates = ((swing, turn - twist, 0), (swing, turn + twist, 0))
    return consistent_scene(PAIR.spins, ((0, 0, 1),) * 2, rates, PAIR.rotor, PAIR.link)


APART = 1e-7  # distance of the neighbouring motion, in natural units


def log_distances(scene: Scene, turns: int, piece: int = 1) -> np.ndarray:
    """The logarithm of the distance of a neighbouring motion over the initial distance, after every `piece` periods. Both
    motions are integrated with the same steps, and the distance is reset to `APART` after every piece."""
    rate, times, unit = MODEL.rate(scene, False), np.array([2 * np.pi / RATE * piece]), np.repeat([1.0, RATE], 3)
    gap, total = unit * np.array([0.5, 0.6, 0.2, 0.3, -0.4, 0.3]), [0.0]
    state = MODEL.start(scene)
    for _ in range(turns // piece):
        both = np.concatenate([state, state + APART * gap])
        end = integrate(Problem(lambda s, y: [*rate(s, y[:6]), *rate(s, y[6:])], both, 12_000), times, 1e-10).end
        state, gap = end[:6], (end[6:] - end[:6]) / APART
        size = float(np.linalg.norm(gap / unit))
        gap, total = gap / size, [*total, total[-1] + np.log(size)]
    return np.array(total)


small, wide = start(0.05, -0.3), start(0.3, 0.1)
slow, fast = log_distances(small, 40), log_distances(wide, 40)
power = (slow[40] - slow[10]) / np.log(4)
KNOWN = 25  # periods after which the error of the second run has grown to its size
assert power < 2.2 and fast[KNOWN] > 12
Remark(
    "Regular and chaotic",
    "At r_0 = 0.05, P/G = −0.3 the distance of neighbouring motions is proportional to the time to the power "
    f"{power:.2f}. At r_0 = 0.3, P/G = 0.1 it is proportional to exp(λ t) with λ = {fast[KNOWN] / KNOWN:.2f} per period "
    f"during the first {KNOWN} periods. If there were a further integral, it could grow exponentially only near an unstable "
    "orbit. Figure t13 shows both cases over amplitude and momentum.",
)

# %% [markdown]
# The same exponents are computed over 30 periods for other amplitudes and momenta, and for six starts of the second motion.
# Figure t13 shows them.

# %%
TURNS, PIECE = 30, 3
AMPLITUDES, MOMENTA = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.5]), np.array([-0.6, -0.3, -0.1, 0.0, 0.1, 0.3, 0.6])
SECTIONS = ((0.1, -0.3), (0.3, 0.1))  # r_0, P/G
starts = [[start(r0, p, phase) for phase in np.linspace(0, np.pi / 2, 6)] for r0, p in SECTIONS]


def exponent(scene: Scene) -> float:
    """The largest Lyapunov exponent per period over `TURNS`, of a fixed direction."""
    return float(log_distances(scene, TURNS, PIECE)[-1]) / TURNS


exponents = np.array([[exponent(start(r0, p)) for r0 in AMPLITUDES] for p in MOMENTA])
of_section = [exponent(one) for one in starts[1]]
(
    f"For r_0 from {AMPLITUDES[0]:g} to {AMPLITUDES[-1]:g} and P/G from {MOMENTA[0]:g} to {MOMENTA[-1]:g} the exponents are "
    f"between {exponents.min():.2f} and {exponents.max():.2f} per period. For the six starts they are between "
    f"{min(of_section):.2f} and {max(of_section):.2f}."
)

# %% [markdown]
# ## The horizon of a run
#
# An initial error $\varepsilon$ grows to the tolerance after $\ln(\mathrm{tol}/\varepsilon)/\lambda$ periods. This time is
# the horizon of a run:

# %%
with warnings.catch_warnings():
    warnings.simplefilter("ignore", LagrotorWarning)
    run = simulate(wide, np.linspace(0, 40 * 2 * np.pi / RATE, 801), tol=1e-6)
horizon = run.horizon * RATE / (2 * np.pi)
reach = float(np.interp(np.log(1e-6 / 1e-14), fast, np.arange(41)))
assert 0.4 * reach < horizon < 2.5 * reach
Remark(
    "Horizon of a chaotic run",
    f"The error of the run is below tol = 10⁻⁶ for {horizon:.0f} periods. An initial error of 10⁻¹⁴ grows to tol after "
    f"{reach:.0f} periods.",
)
