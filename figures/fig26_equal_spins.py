# %% [markdown]
# # Figure 26: equal spins after a shock
#
# The pair with spins 20 and 20 and the bar of section 4.1: the force on tip 1, x of the tip by the exact model and by
# the paper's method, and the distance between the two.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, Shock, simulate
from lagrotor.drawing import EXACT_COLOUR, FORCE_COLOUR, MODEL_COLOUR, legend_below
from lagrotor.pair import DAMPING, HEAVY_LINK, STEP, STIFFNESS
from lagrotor.paper.rotor_pair.runs import paper_run, pulse

TOL = 1e-10
SCENE = Scene(spins=(20, 20), link=HEAVY_LINK, shock=Shock(force=(40, 0, 0), at=2.0, width=1 / 20, body=1))

TITLE = "Pair of equal spins 20 after a shock"
ALT = (
    "Three panels show 10 s. The force is a narrow peak of 40 N at 2 s. Until then x of tip 1 rests at −0.5 m; afterwards "
    "it makes fifteen oscillations of amplitude 0.08 m about this value by both methods. The difference between the methods "
    "is small at first and grows with time, because the spring-linked bodies turn slightly more slowly."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), force (N), x of tip 1 (m) by the exact model and by spring-linked bodies."""
    t = np.linspace(0, 10, 2001)
    return {
        "t": t,
        "force": pulse(SCENE, t),
        "exact": simulate(SCENE, t, "minimal", TOL).tips[0, :, 0],
        "springs": paper_run(SCENE, t).tips[0, :, 0],
    }


# %%
def measure() -> dict[str, float]:
    """Amplitudes after the shock and largest residual between the methods (m)."""
    d = data()
    after = d["t"] > 2.3
    return {
        "amplitude, exact model (m)": np.ptp(d["exact"][after]) / 2,
        "amplitude, paper's method (m)": np.ptp(d["springs"][after]) / 2,
        "largest residual (m)": np.abs(d["springs"] - d["exact"]).max(),
    }


_exact, _springs, _residual = measure().values()
CAPTION = (
    "The spins are 20 and 20 rad/s, the bar has 1 m, 1 kg and 1 kg m² (section 4.1), and the shock 40 exp(−(20 (t − "
    "2))²) N acts on "
    f"tip 1 along x (a). The exact curve is the minimal model at the tolerance {TOL:g}. The paper's method has springs with S = "
    f"{STIFFNESS:g} N/m and D = {DAMPING:g} kg/s (as in figure 25) and a step of {STEP:g} s. The amplitude (b) is "
    f"{_exact:.4f} m in the "
    f"exact model and {_springs:.4f} m by the paper's method; the largest residual (c) is {_residual:.3f} m."
)


# %%
def figure() -> Figure:
    """Force, x of the tip, residual."""
    d = data()
    picture = Figure(figsize=(7.0, 6.4))
    force, x, residual = picture.subplots(3, 1, sharex=True, height_ratios=(1, 2, 1))
    force.plot(d["t"], d["force"], color=FORCE_COLOUR)
    x.plot(d["t"], d["exact"], color=EXACT_COLOUR, label="exact model")
    x.plot(d["t"], d["springs"], color=MODEL_COLOUR, ls="--", lw=1.2, label="paper's method, stiff springs")
    residual.plot(d["t"], d["springs"] - d["exact"], color=MODEL_COLOUR)
    force.set(ylabel="force (N)", title="Force on tip 1 along x")
    x.set(ylabel="$x_1$ (m)", title="x of tip 1")
    residual.set(xlabel="time $t$ (s)", ylabel="residual (m)", title="Paper's method minus exact model")
    legend_below(picture, 2)
    return picture
