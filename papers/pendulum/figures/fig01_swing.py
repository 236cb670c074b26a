# %% [markdown]
# # Figure 1: a swing of 0.2 rad, as printed and exact

# %%
import numpy as np
import sympy as sp
from matplotlib.figure import Figure
from symbols import c, g, l, m

from lagrotor.drawing import EXACT_COLOUR, PAPER_COLOUR
from lagrotor.mechanics import System

TITLE = "A swing of 0.2 rad"
CAPTION = "The angle by the printed equation (1.1), a cosine, and by the exact one, over three periods."
ALT = "Two curves of the angle over time that lie on each other for the first period and slowly part."
AMPLITUDE = 0.2
VALUES = {m: 1.0, g: 9.81, l: 1.0}


def data() -> dict[str, np.ndarray]:
    """Time (s) and the angle (rad), as printed and exact."""
    pendulum = System(c, m * l**2 * c.v[0] ** 2 / 2 + m * g * l * sp.cos(c.q[0]))
    rate = np.sqrt(VALUES[g] / VALUES[l])
    t = np.linspace(0, 6 * np.pi / rate, 301)
    exact = pendulum.simulate(VALUES, (AMPLITUDE,), (0.0,), t).q[:, 0]
    return {"t": t, "printed": AMPLITUDE * np.cos(rate * t), "exact": exact}


def figure() -> Figure:
    """Both curves."""
    found, drawn = data(), Figure(figsize=(6, 3), layout="constrained")
    axes = drawn.subplots()
    axes.plot(found["t"], found["exact"], color=EXACT_COLOUR, label="exact")
    axes.plot(found["t"], found["printed"], "--", color=PAPER_COLOUR, label="as printed")
    axes.set(xlabel="$t$ [s]", ylabel=r"$\theta$ [rad]", title=TITLE)
    axes.legend(loc="upper right")
    return drawn


def measure() -> dict[str, float]:
    """How far the printed curve is from the exact one."""
    found = data()
    return {"largest distance (rad)": float(np.abs(found["printed"] - found["exact"]).max())}
