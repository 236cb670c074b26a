# %% [markdown]
# # Figure 13: opposite spins, a shock across the bar
#
# Pushed across the bar, the pair topples at once in that plane, while x swings about its place.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import simulate
from lagrotor.pair import DAMPING, SCENES, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import centre_numbers, centre_off, centre_runs
from lagrotor.pictures import shock_figure

SCENE = SCENES["anti-spin-shock-y"].scene
TITLE = "Opposite spins, shock across the bar"
ALT = (
    "Three panels over 10 s. Energy: 100 J, then 100.68 J from t = 2 s. Force: a pulse of 50 N in y at 2 s. Centre of "
    "rotor 1: x swings a little about −0.5 m while y and z go round the ground joint; the dashed exact "
    "curves run a little ahead in the end."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """t (n,) in s; energy (n,) in J, force (n,) in N, centre of rotor 1 (n, 3) in m; `exact_…`: by the exact model."""
    t = np.arange(2001) * (5 * STEP)
    return centre_runs(t, simulate(SCENE, t))


def measure() -> dict[str, float]:
    """Energy after the shock (J), the ranges of the centre's coordinates (m), distance from the exact model (m)."""
    return centre_numbers(data()) | {"centre at 10 s, off the exact model (m)": centre_off(data())}


_energy, _exact, _x, _y, _z, _off = measure().values()
CAPTION = (
    f"Spring-link model by the paper's step of {STEP:g} s, S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20, "
    "omega_s = 10 rad/s in 4.01, as in figure 10), bar of 1 kg and 1 kg m², spins 10 and −10 rad/s, "
    "shock 50 exp(−(50 (t − 2))²) N in y on the tip of rotor 1. "
    f"Energy 100 to {_energy:.3f} J (exact: {_exact:.3f} J); "
    f"in 10 s x keeps within {_x:.2f} m, y moves by {_y:.2f} m, z by {_z:.2f} m. "
    f"Dashed: the exact model, {1000 * _off:.1f} mm away at 10 s. The paper's z is 0.5 m less."
)


# %%
def figure() -> Figure:
    """Energy, force and centre of rotor 1 over time."""
    return shock_figure(data(), "y")
