# %% [markdown]
# # Figure 9: energy over time, the bar in its place
#
# Nothing pulls, nothing moves but the wheels: the kinetic energy is that of the two spins, $\frac12(10^2 + 10^2)$ J.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import simulate
from lagrotor.drawing import EXACT_COLOUR, MODEL_COLOUR, legend_below
from lagrotor.pair import DAMPING, SCENES, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import paper_run

SCENE = SCENES["same-spin"].scene
TITLE = "Energy with the bar in its place"
ALT = (
    "Two panels show 10 s. In the upper one the energy of the spring-link run, a wide blue line, and the energy of the "
    "exact model, a dashed black line on it, are level at 100 J. The lower one shows their differences from 100 J in "
    "billionths of a millijoule, which are zero."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """t (n,) in s; energies (n,) in J: the paper's method, and the exact model."""
    t = np.arange(1001) * (10 * STEP)
    run = paper_run(SCENE, t)
    return {"t": t, "kinetic": run.paper_energy, "exact": simulate(SCENE, t).energy}


def measure() -> dict[str, float]:
    """Energy at the end and its largest distance from 100 (J)."""
    d = data()
    return {
        "energy at the end (J)": d["kinetic"][-1],
        "largest distance from 100 J (J)": np.abs(d["kinetic"] - 100).max(),
    }


CAPTION = (
    f"Run of the spring-link model with the paper's step of {STEP:g} s, S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20, "
    "omega_s = 10 rad/s in 4.01, as in figure 10), spins of 10 and 10 rad/s and no shock. The bar has 1 kg and 1 kg m², and its "
    "centre is midway between the tips. In 10 s the energy (a) differs from 100 J by at most "
    f"{measure()['largest distance from 100 J (J)']:.0g} J (b)."
)


# %%
def figure() -> Figure:
    """The energy over time."""
    d = data()
    drawn = Figure(figsize=(7.0, 4.8))
    main, below = drawn.subplots(2, 1, sharex=True, height_ratios=(1.4, 1))
    main.plot(d["t"], d["kinetic"], color=MODEL_COLOUR, linewidth=3, label="paper's method, kinetic energy")
    main.plot(d["t"], d["exact"], color=EXACT_COLOUR, linestyle="--", label="exact model")
    main.set(ylabel="energy (J)", ylim=(0, 120), title="Energy")
    for name, colour, line in (("kinetic", MODEL_COLOUR, "-"), ("exact", EXACT_COLOUR, "--")):
        below.plot(d["t"], 1e12 * (d[name] - 100), color=colour, linestyle=line, linewidth=3 if line == "-" else 1.6)
    below.set(ylabel="energy − 100 J (pJ)", xlabel="time $t$ (s)", ylim=(-5, 5), title="Departure from 100 J")
    legend_below(drawn, 2)
    return drawn
