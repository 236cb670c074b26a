# %% [markdown]
# # The period
#
# **Objective.** Whether the period at 0.2 rad is that of small swings, $2\pi\sqrt{l/g}$.
#
# What is measured is the time of two swings of the exact pendulum; "does not depend" is read as: to one part in a hundred.

# %%
import numpy as np
import sympy as sp
from symbols import c, g, l, m

from lagrotor.mechanics import System
from lagrotor.paper import ClaimTest, Finding, Part

ALIKE = 0.01
THE_SAME = "the period is that of small swings"
VALUES = {m: 1.0, g: 9.81, l: 1.0}
pendulum = System(c, m * l**2 * c.v[0] ** 2 / 2 + m * g * l * sp.cos(c.q[0]))


def measure(amplitude: float) -> dict[str, float]:
    """Period (s) of a swing of this amplitude (rad), and over that of small ones."""
    small = 2 * np.pi * np.sqrt(VALUES[l] / VALUES[g])
    run = pendulum.simulate(VALUES, (amplitude,), (0.0,), np.linspace(0, 3 * small, 301))
    passes = run.crossings(c.q[0]).t
    period = float(passes[2] - passes[0])
    return {"period": period, "ratio": period / small}


def decide(measured: dict[str, float]) -> Finding:
    """The ratio of the periods against one."""
    same = abs(measured["ratio"] - 1) < ALIKE
    text = f"The period is {measured['period']:.4f} s, {measured['ratio']:.4f} of that of small swings."
    return Finding((Part(THE_SAME, same),), text)


# A swing of 1 rad is a case in which the claim comes out otherwise: every test has one.
ClaimTest("C01", 0.2, {THE_SAME: 1.0}, "exact pendulum, l = 1 m", measure, decide)
