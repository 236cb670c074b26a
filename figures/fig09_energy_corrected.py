# %% [markdown]
# # Figure 9: energy over time, the bar in its place
#
# Nothing pulls, nothing moves but the wheels: the kinetic energy is that of the two spins, $\frac12(10^2 + 10^2)$ J.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import simulate
from lagrotor.models.spring_run import paper_system, run_steps
from lagrotor.report.style import EXACT, MODEL, with_residual
from lagrotor.rotors.scenes import DAMPING, SCENES, STEP, STIFFNESS

SCENE = SCENES["same-spin"].scene
TITLE = "Energy with the bar in its place"
ALT = (
    "Energy over 10 s: the spring-link run and the exact model both stay at 100 J. The lower panel, on a logarithmic "
    "scale, has their distance from 100 J: that of rounding."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """t (n,) in s; energies (n,) in J: the paper's method, and the exact model."""
    t = np.arange(1001) * (10 * STEP)
    run = run_steps(paper_system(SCENE, STIFFNESS, DAMPING), None, t, STEP)
    return {"t": t, "kinetic": run.paper_energy, "exact": simulate(SCENE, t).energy}


def measure() -> dict[str, float]:
    """Energy at the end and its largest distance from 100 (J)."""
    d = data()
    return {
        "energy at the end (J)": d["kinetic"][-1],
        "largest distance from 100 J (J)": np.abs(d["kinetic"] - 100).max(),
    }


CAPTION = (
    f"Spring-link model by the paper's step of {STEP:g} s, S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20, omega_s = 10 "
    "rad/s in 4.01, as in figure 10), bar of 1 kg and 1 kg m² with its centre midway between the tips, spins 10 and 10 rad/s, "
    f"no shock. The energy stays within {measure()['largest distance from 100 J (J)']:.0e} J of 100 J."
)


# %%
def figure() -> Figure:
    """The energy, and its distance from 100 J."""
    d = data()
    drawn = Figure(figsize=(7.0, 4.8))
    main, residual = with_residual(drawn)
    main.plot(d["t"], d["kinetic"], color=MODEL, linewidth=3, label="paper's method, kinetic energy")
    main.plot(d["t"], d["exact"], color=EXACT, linestyle="--", label="exact model")
    main.set(ylabel="energy [J]", ylim=(95, 105), title="Energy")
    for name, colour, line in (("kinetic", MODEL, "-"), ("exact", EXACT, "--")):
        residual.semilogy(d["t"], np.maximum(np.abs(d[name] - 100), 1e-15), color=colour, linestyle=line)
    residual.set(ylabel="|energy − 100 J| [J]", xlabel="t [s]", ylim=(1e-16, 1e-8), title="Residual")
    drawn.suptitle(TITLE)
    drawn.legend(loc="outside lower center", ncols=2)
    return drawn
