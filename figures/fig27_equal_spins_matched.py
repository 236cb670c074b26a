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
    "Four panels. The force is a narrow peak of 40 N at 2 s. x of the tip oscillates after it with amplitude 0.08 m. "
    "The sine at 11.4 rad/s and the stiff springs fall a little behind, with residuals growing to 0.04 and 0.06 m; "
    "the sine at the closed form's rate stays on the curve. In the spectrum the exact peak is at 11.5 rad/s, just "
    "above the mark at 11.4, that of the springs just below it."
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
    f"Spins 20 and 20 rad/s, bar 1 m, 1 kg, 1 kg m², shock as in figure 25. Exact: minimal model, tolerance {TOL:g}; "
    f"paper's method: springs S = {STIFFNESS:g} N/m, D = {DAMPING:g} kg/s (as in figure 25), step {STEP:g} s. Rate "
    f"read off the spectrum (Hann window, 2.3 s to 10 s): exact {_m['rate, exact model (rad/s)']:.3f}, paper's method "
    f"{_m['rate, spring model (rad/s)']:.3f}, closed form (80/7)/cos theta = {_m['rate, closed form (rad/s)']:.3f}, "
    f"printed {PRINTED:g} rad/s. Largest residual from 2.3 s on: printed rate {_m['printed rate, largest residual (m)']:.3f} m, "
    f"closed form {_m['closed form, largest residual (m)']:.1e} m."
)


# %%
def figure() -> Figure:
    """Force, x of the tip, residual, spectrum."""
    return rate_figure(data(), PRINTED)
