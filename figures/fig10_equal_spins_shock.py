# %% [markdown]
# # Figure 10: equal spins, a shock along the bar
#
# The shock of section 4.2, $50\,e^{-(50(t-2))^2}$ N on the tip of rotor 1, does work: the energy goes from 100 to about
# 100.45 J. The exact model, whose bar and joints are rigid, is drawn beside the paper's method.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import simulate
from lagrotor.drawing import EXACT_COLOUR, FORCE_COLOUR, MODEL_COLOUR, legend_below
from lagrotor.models import paper_system, step_limit
from lagrotor.pair import DAMPING, SCENES, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import paper_run, pulse

SCENE = SCENES["same-spin-shock"].scene
TITLE = "Equal spins, shock along the bar"
ALT = (
    "The upper panel shows the energy over 10 s. It is level at 100 J and jumps to 100.45 J at t = 2 s. Then it is level in "
    "the exact model and decreases by 0.01 J in the spring-link run. The lower panel shows the force, a narrow pulse of 50 "
    "N at t = 2 s."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """t (n,) in s; energies (n,) in J: kinetic and total by the paper's method, exact; force (n,) in N."""
    t = np.arange(round(10 / STEP) + 1) * STEP
    run = paper_run(SCENE, t)
    return {
        "t": t,
        "kinetic": run.paper_energy,
        "total": run.energy,
        "exact": simulate(SCENE, t).energy,
        "force": pulse(SCENE, t),
    }


def measure() -> dict[str, float]:
    """Energies (J) at first, at most and at the end; the exact one after the shock; the longest stable step (s)."""
    d = data()
    return {
        "energy before (J)": d["kinetic"][0],
        "energy, largest (J)": d["kinetic"].max(),
        "energy at the end (J)": d["kinetic"][-1],
        "exact energy after the shock (J)": d["exact"][-1],
        "longest stable step (s)": step_limit(paper_system(SCENE, STIFFNESS, DAMPING)).whole,
    }


_before, _most, _end, _exact, _limit = measure().values()
CAPTION = (
    f"Run of the spring-link model with the paper's step of {STEP:g} s, a bar of 1 kg and 1 kg m², spins of 10 and 10 rad/s, and "
    "the shock 50 exp(−(50 (t − 2))²) N along x on the tip of rotor 1 (b). The energy (a) rises from "
    f"{_before:.0f} to {_most:.3f} J, and the dampers reduce it to {_end:.3f} J at 10 s. In the exact model it is {_exact:.3f} J "
    "after the shock. The paper does not give n and omega_s of 4.01. This figure and the others use omega_s = 10 "
    "rad/s and n = 20, "
    f"found by trying n (claim C08), hence S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s. The run is stable up to a step of "
    f"{1000 * _limit:.2f} ms."
)


# %%
def figure() -> Figure:
    """Energy and force over time."""
    d = data()
    drawn = Figure(figsize=(7.0, 5.4))
    upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    upper.plot(d["t"], d["kinetic"], color=MODEL_COLOUR, label="paper's method, kinetic energy")
    upper.plot(d["t"], d["exact"], color=EXACT_COLOUR, linestyle="--", label="exact model")
    upper.set(ylabel="energy (J)", title="Energy", ylim=(99.95, 100.5))
    lower.plot(d["t"], d["force"], color=FORCE_COLOUR)
    lower.set(ylabel="force in x (N)", xlabel="time $t$ (s)", title="Force on the tip of rotor 1", ylim=(-3, 55))
    legend_below(drawn, 2)
    return drawn
