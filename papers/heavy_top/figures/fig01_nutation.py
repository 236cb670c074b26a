# %% [markdown]
# # Figure 1: nutation of a top released at rest, as printed and exact

# %%
import numpy as np
from matplotlib.figure import Figure
from symbols import I_1, I_3, g, l, m
from top import VALUES, top

from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR

TITLE = "Nutation of a top released at rest"
CAPTION = "cos θ₀ − cos θ over two nutations at 60 rad/s, exact, and by (3.1) with the printed and the corrected extent (3.2)."
ALT = "Three curves over time that rise from zero and come back twice; the printed one reaches half as high as the others."
SPIN, THETA_0 = 60.0, 0.5


def data() -> dict[str, np.ndarray]:
    """Time (s); cos θ₀ − cos θ exact, with the printed extent and with the corrected one."""
    rate = VALUES[I_3] * SPIN / VALUES[I_1]
    t = np.linspace(0, 4 * np.pi / rate, 401)
    run = top.simulate(VALUES, (0.0, THETA_0, 0.0), (0.0, 0.0, SPIN), t, tol=1e-11)
    extent = VALUES[m] * VALUES[g] * VALUES[l] * VALUES[I_1] * np.sin(THETA_0) ** 2 / (VALUES[I_3] * SPIN) ** 2
    wave = (1 - np.cos(rate * t)) / 2
    exact = np.cos(THETA_0) - np.cos(run.q[:, 1])
    return {"t": t, "exact": exact, "printed": extent * wave, "corrected": 2 * extent * wave}


def figure() -> Figure:
    """The three curves."""
    found, drawn = data(), Figure(figsize=(6, 3), layout="constrained")
    axes = drawn.subplots()
    for name, colour, line in (
        ("exact", EXACT_COLOUR, "-"),
        ("printed", PAPER_COLOUR, "--"),
        ("corrected", CORRECTION_COLOUR, ":"),
    ):
        axes.plot(found["t"], found[name], line, color=colour, label=name)
    axes.set(xlabel="$t$ [s]", ylabel=r"$\cos\theta_0-\cos\theta$ [1]", title=TITLE)
    axes.legend(loc="upper right")
    return drawn


def measure() -> dict[str, float]:
    """The largest distances of both curves from the exact one, over its extent."""
    found = data()
    return {
        f"{name}, largest distance over the extent": float(
            np.abs(found[name] - found["exact"]).max() / found["exact"].max()
        )
        for name in ("printed", "corrected")
    }
