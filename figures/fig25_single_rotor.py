# %% [markdown]
# # Figure 25: a single rotor after a shock
#
# Spin 20, shock along x at the tip: the force, x of the tip against $\sin 16(t-2)$, and the spectrum from which the
# rate is read. Free, the rotor turns about its angular momentum at $G/(J\cos\theta)$ (5.23).

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, Shock, simulate
from lagrotor.pair import DAMPING, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import rate_numbers, rate_runs
from lagrotor.pictures import rate_figure

TOL, PRINTED = 1e-10, 16.0
SCENE = Scene(spins=(20, 0), link=None, shock=Shock(force=(40, 0, 0), at=2.0, width=1 / 20, body=1))

TITLE = "Single rotor, spin 20, after a shock"
ALT = (
    "There are four panels. The force is a narrow peak of 40 N at 2 s, after which x of the tip oscillates with the "
    "amplitude 0.15 m. The sine at 16 rad/s starts in phase and falls behind, so its residual grows to 0.2 m. The residual "
    "of the stiff springs grows to 0.1 m. The sine at the closed form's rate stays on the curve. In the spectrum the exact "
    "peak is at 16.2 rad/s, slightly above the mark at 16, and the peak of the springs lies between the two."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), force (N), x of tip 1 from its start (m) by both models and both sines, spectra after the shock."""
    return rate_runs(simulate(SCENE, np.linspace(0, 10, 2001), "spheres", TOL), PRINTED)


# %%
def measure() -> dict[str, float]:
    """Amplitude (m), rates read off the spectra and of the closed form (rad/s), largest residuals (m)."""
    return rate_numbers(data())


_m = measure()
CAPTION = (
    "A rotor with a spin of 20 rad/s and no bar receives the shock 40 exp(−(20 (t − 2))²) N along x on its tip (a). "
    "Exact: spheres "
    f"model, tolerance {TOL:g}. The paper's method has springs with S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20 and "
    f"omega_s = 10 rad/s, which the paper does not print; see figure 10) and a step of {STEP:g} s. The sines (b), (c) "
    "have the amplitude "
    f"{_m['amplitude (m)']:.4f} m. From 2.3 s to 10 s the spectrum (e) with a Hann window gives the rate "
    f"{_m['rate, exact model (rad/s)']:.3f} rad/s for the exact model and {_m['rate, spring model (rad/s)']:.3f} rad/s for the "
    f"paper's method. Over the first 3 s that method gives {_m['rate, spring model, first 3 s (rad/s)']:.3f} rad/s; later "
    "the dampers reduce the amplitude, and with it the rate. "
    f"The closed form 16/cos theta is {_m['rate, closed form (rad/s)']:.3f} rad/s; the "
    "paper prints "
    f"{PRINTED:g} rad/s. From 2.3 s on the largest residual (d) is {_m['printed rate, largest residual (m)']:.3f} m at "
    "the printed "
    f"rate, {_m['closed form, largest residual (m)']:.4f} m for the closed form, and "
    f"{_m['spring model, largest residual (m)']:.3f} m for the springs."
)


# %%
def figure() -> Figure:
    """Force, x of the tip, residual, spectrum."""
    return rate_figure(data(), PRINTED)
