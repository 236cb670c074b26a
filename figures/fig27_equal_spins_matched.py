# %% [markdown]
# # Figure 27: equal spins against the rate 11.4
#
# The run of figure 26: x of the tip against the paper's 11.4 and the closed form $80/7\,/\cos\theta$ (5.24), and the
# spectrum from which the rate is read.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, Shock, simulate
from lagrotor.pair import DAMPING, HEAVY_LINK, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import rate_numbers, rate_runs
from lagrotor.pictures import rate_figure

TOL, PRINTED = 1e-10, 11.4
SCENE = Scene(spins=(20, 20), link=HEAVY_LINK, shock=Shock(force=(40, 0, 0), at=2.0, width=1 / 20, body=1))

TITLE = "Equal spins 20, matched to a rate"
ALT = (
    "There are four panels. The force is a narrow peak of 40 N at 2 s, after which x of the tip oscillates with the "
    "amplitude 0.08 m. The sine at 11.4 rad/s and the stiff springs fall behind, and their residuals grow to 0.04 and 0.06 "
    "m. The sine at the closed form's rate stays on the curve. In the spectrum the exact peak is at 11.5 rad/s, just above "
    "the mark at 11.4, and the peak of the springs is just below it."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), force (N), x of tip 1 from its start (m) by both models and both sines, spectra after the shock."""
    return rate_runs(simulate(SCENE, np.linspace(0, 10, 2001), "minimal", TOL), PRINTED)


# %%
def measure() -> dict[str, float]:
    """Amplitude (m), rates read off the spectra and of the closed form (rad/s), largest residuals (m)."""
    return rate_numbers(data())


_m = measure()
CAPTION = (
    "The spins are 20 and 20 rad/s, the bar has 1 m, 1 kg and 1 kg m², and the shock (a) is as in figure 25. The exact "
    "curve (b), (c) is the "
    f"minimal model at the tolerance {TOL:g}. The paper's method has springs with S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s "
    f"(as in figure 25) and a step of {STEP:g} s. From 2.3 s to 10 s the spectrum (e) with a Hann window gives the rate "
    f"{_m['rate, exact model (rad/s)']:.3f} rad/s for the exact model and {_m['rate, spring model (rad/s)']:.3f} rad/s for the "
    f"paper's method. The closed form (80/7)/cos theta is {_m['rate, closed form (rad/s)']:.3f} rad/s; the paper prints "
    f"{PRINTED:g} rad/s. From 2.3 s on the largest residual (d) is {_m['printed rate, largest residual (m)']:.3f} m at "
    "the printed rate "
    f"and {_m['closed form, largest residual (m)']:.1e} m for the closed form."
)


# %%
def figure() -> Figure:
    """Force, x of the tip, residual, spectrum."""
    return rate_figure(data(), PRINTED)
