# %% [markdown]
# # Figure 8: energy over time with the bar misplaced
#
# The listing of 4.1 puts the bar's centre at z = 1, half a metre above the tips, whose links then pull it down. What the
# paper plots is the kinetic energy alone (4.02); with the springs' share the run begins at 2600 J, and the dampers take
# all but the rotors' 100 J away.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.drawing import MODEL_COLOUR, OKABE_ITO, legend_below
from lagrotor.models import paper_system, run_steps
from lagrotor.pair import DAMPING, SCENES, STEP, STIFFNESS

SCENE = SCENES["same-spin"].scene
BAR_HEIGHT, RIGHT_HEIGHT = 1.5, 1.0  # m above the ground joints; the paper's z = 1 and 0.5
TOTAL = OKABE_ITO["orange"]
TITLE = "Energy with the bar misplaced"
ALT = (
    "Three panels show energy as a function of time. Over the whole run the kinetic energy jumps from 100 J to 200 J and "
    "falls back to 100 J. In the first 0.15 s it has a peak after a few milliseconds and then decays. On a logarithmic "
    "scale of the excess over 100 J the kinetic and the total energy fall along curves that become straight; the total "
    "energy starts at 2500 J."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """t (n,) in s; kinetic energy and with the springs' (n,), J."""
    t = np.arange(round(10 / STEP) + 1) * STEP
    run = run_steps(paper_system(SCENE, STIFFNESS, DAMPING, BAR_HEIGHT), None, t, STEP)
    return {"t": t, "kinetic": run.paper_energy, "total": run.energy}


def predicted_decay() -> float:
    """Twice the slowest rate (1/s) at which the paper's step closes the gaps that the misplaced bar opens.

    Along an eigenvector of the joints' mobility, of eigenvalue w, the step is a map of trace 2 − h w D − h² w S and
    determinant 1 − h w D (see `step_limit`); the gaps point along two of them.
    """
    system = paper_system(SCENE, STIFFNESS, DAMPING, BAR_HEIGHT)
    w, vectors = np.linalg.eigh(system.joint_mobility())
    opened = np.abs(vectors.T @ system.gaps(system.X, system.R).ravel()) > 1e-6
    slow = []
    for k in w[opened]:
        trace, determinant = 2 - STEP * k * DAMPING - STEP**2 * k * STIFFNESS, 1 - STEP * k * DAMPING
        slow.append(-np.log(np.abs(np.roots([1, -trace, determinant])).max()) / STEP)
    return float(2 * min(slow))


def measure() -> dict[str, float]:
    """The peak (J) and its time (s), total energy at the start (J), rate of decay from 0.2 s on (1/s), the end (J)."""
    d = data()
    peak, fit = int(d["kinetic"].argmax()), slice(round(0.2 / STEP), round(0.24 / STEP) + 1)
    return {
        "kinetic energy, peak (J)": d["kinetic"][peak],
        "time of the peak (s)": d["t"][peak],
        "total energy at the start (J)": d["total"][0],
        "decay of the kinetic energy (1/s)": -np.polyfit(d["t"][fit], np.log(d["kinetic"][fit] - 100), 1)[0],
        "decay by the joints' mobility (1/s)": predicted_decay(),
        "kinetic energy at the end (J)": d["kinetic"][-1],
    }


_peak, _at, _start, _decay, _predicted, _ = measure().values()
CAPTION = (
    f"Run of the spring-link model with the paper's step of {STEP:g} s, S = {STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (n = 20, "
    "omega_s = 10 rad/s in 4.01, as in figure 10), a bar of 1 kg and 1 kg m², and spins of 10 and 10 rad/s. The bar starts "
    f"{BAR_HEIGHT:g} m above the ground joints instead of {RIGHT_HEIGHT:g} m. The paper plots only the kinetic "
    "energy (a). It rises to "
    f"{_peak:.1f} J after {1000 * _at:.0f} ms (b) and then decays (c), in the end at the rate {_decay:.2f} 1/s; the mobility "
    "of the joints "
    f"predicts {_predicted:.2f} 1/s. Together with the energy of the springs the run begins at {_start:.0f} J."
)


# %%
def figure() -> Figure:
    """The whole run; the spike; the decay on a logarithmic scale."""
    d = data()
    drawn = Figure(figsize=(7.4, 5.4))
    panels = drawn.subplot_mosaic([["run", "run"], ["spike", "decay"]])
    early = (d["t"] > 0) & (d["t"] <= 0.15)
    panels["run"].plot(d["t"], d["kinetic"], color=MODEL_COLOUR, label="kinetic energy, as the paper records it")
    panels["run"].set(title="Kinetic energy, whole run", xlim=(-0.1, 10), ylim=(90, 215))
    panels["spike"].plot(d["t"][: early.sum() + 1], d["kinetic"][: early.sum() + 1], color=MODEL_COLOUR)
    panels["spike"].set(title="Kinetic energy, first 0.15 s", ylim=(90, 215))
    for name, colour in (("kinetic", MODEL_COLOUR), ("total", TOTAL)):
        above = d[name][early] - 100
        label = "kinetic and spring energy" if name == "total" else None
        panels["decay"].semilogy(d["t"][early], above, color=colour, ls="-" if name == "kinetic" else "--", label=label)
    panels["decay"].set(title="Energy above 100 J", ylim=(1e-3, 1e4), ylabel="energy − 100 J (J)")
    for name in ("run", "spike"):
        panels[name].set_ylabel("energy (J)")
    for panel in panels.values():
        panel.set_xlabel("time $t$ (s)")
    legend_below(drawn, 2)
    return drawn
