# %% [markdown]
# # Figure 11: no spin
#
# Without spin the pair keeps turning about its ground joints, in the plane of the bar: both rotors pass the horizontal,
# hang down and come up again, at the rate that the shock has given them.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import simulate
from lagrotor.pair import DAMPING, SCENES, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import centre_numbers, centre_off, centre_runs
from lagrotor.pictures import shock_figure

SCENE = SCENES["no-spin"].scene
TITLE = "No spin, shock along the bar"
ALT = (
    "Three panels show 10 s. The energy is zero, and 0.45 J from t = 2 s on. The force is a pulse of 50 N at 2 s. For the "
    "centre of rotor 1, x and z follow arcs of a circle of 0.5 m about the ground joint, while y stays zero. The dashed "
    "exact curves coincide with them and end at 4.8 s."
)

IN_LINE = 4.8  # s; the exact planar motion is determined until bar and axes are in line, a little later


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """t (n,) in s; energy (n,) in J, force (n,) in N, centre of rotor 1 (n, 3) in m; `exact_…`: by the exact model."""
    t = np.arange(2001) * (5 * STEP)
    exact = simulate(SCENE, t[t <= IN_LINE], "spheres")
    return centre_runs(t, exact) | {"exact_t": exact.t}


def measure() -> dict[str, float]:
    """Energy after the shock (J), the ranges of the centre's coordinates (m), distance from the exact model (m)."""
    return centre_numbers(data()) | {"centre, off the exact model at its end (m)": centre_off(data())}


_energy, _exact, _x, _y, _z, _off = measure().values()
CAPTION = (
    f"Run of the spring-link model with the paper's step of {STEP:g} s, S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20, "
    "omega_s = 10 rad/s in 4.01, as in figure 10), a bar of 1 kg and 1 kg m², no spins, and the shock 50 exp(−(50 (t − 2))²) N "
    f"along x on the tip of rotor 1 (b). The energy (a) rises by {_energy:.3f} J; the exact "
    f"model gives {_exact:.3f} J. The coordinate y (c) stays zero. The dashed "
    f"curves are the exact model, which differs by {1000 * _off:.1f} mm at {IN_LINE:g} s. Soon after, the bar and "
    "both axes lie in "
    "one line, where the motion with a rigid bar is not determined. The paper's z is 0.5 m less."
)


# %%
def figure() -> Figure:
    """Energy, force and centre of rotor 1 over time."""
    return shock_figure(data(), "x")
