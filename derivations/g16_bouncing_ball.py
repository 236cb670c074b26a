# %% [markdown]
# # A bouncing ball
#
# **Objective.** Infinitely many impacts in a finite time, the time of the last impact, and the state of rest after it.
#
# **Assumptions.** A ball of mass $m$ falls from the height $h$. Each impact multiplies its speed by $e<1$.
#
# **Notation.** $x$ the height, $t_0=\sqrt{2h/g}$ the time of the first fall, $S$ the time from the first impact to the last.

# %%
import numpy as np
import sympy as sp

from lagrotor.mechanics import Event, Impact, System, coordinates
from lagrotor.paper import Remark, prove, scientific

m, g, h, e, t0, S = sp.symbols("m g h e t_0 S", positive=True)
c = coordinates("x")
(x,), (v,) = c.q, c.v
ball = System(c, m * v**2 / 2 - m * g * x)
floor = Impact(x, restitution=e)

# %% [markdown]
# ## An impact
#
# The velocity is reversed and multiplied by $e$. The next height is $e^2h$, and the next flight lasts $2et_0$.

# %%
speed = g * t0
prove(
    (e * speed) ** 2 / (2 * g),
    e**2 * (g * t0**2 / 2),
    "the height after an impact, e² times the height before",
    names="h_1",
)

# %%
prove(2 * (e * speed) / g, 2 * e * t0, "the time to the next impact", names="t_1")

# %% [markdown]
# ## The time of the last impact
#
# The motion after the second impact equals the motion after the first with all times multiplied by $e$. Hence $S = 2et_0 + eS$,
# and the last impact is at $t_0+S=t_0\,(1+e)/(1-e)$.

# %%
(total,) = sp.solve(sp.Eq(S, 2 * e * t0 + e * S), S)
prove(t0 + total, t0 * (1 + e) / (1 - e), "the time of the last impact", names="t_{\\infty}")

# %% [markdown]
# ## Comparison with the single flights
#
# The simulation locates the impacts independently of the output times. After the last impact the ball rests on the floor.

# %%
values, twin = {m: 0.3, g: 9.81, e: 0.7}, {e: 0.701}
last = float(np.sqrt(2 / 9.81) * 1.7 / 0.3)
times = np.linspace(0, 1.2 * last, 241)


def flights(restitution: float) -> np.ndarray:
    """Heights of a ball that falls from the height 1 m."""
    begin, up, heights = -np.sqrt(2 / 9.81), np.sqrt(2 * 9.81), np.zeros(len(times))
    while up > 1e-12:
        since = times - begin
        inside = (since >= 0) & (since < 2 * up / 9.81)
        heights[inside] = up * since[inside] - 9.81 * since[inside] ** 2 / 2
        begin, up = begin + 2 * up / 9.81, up * restitution
    return heights


def difference(parameters: dict) -> float:
    """The largest difference between the run and the flights with e = 0.7, m."""
    run = ball.simulate(parameters, (1,), (0,), times, 1e-11, events=floor)
    return float(np.abs(run.q[:, 0] - flights(0.7)).max())


off = difference(values)
assert off < 1e-9
Remark("Result", f"The largest difference of the heights is {scientific(off, 1)} m.")

# %%
run = ball.simulate(values, (1,), (0,), times, 1e-9, events=floor)
assert abs(float(run.ending.reason.split("t = ")[1].split(" s")[0]) - last) < 1e-6
assert not run.q[times > last].any() or np.abs(run.q[times > last]).max() < 1e-9
run.ending.reason

# %% [markdown]
# ## A run that ends at an event
#
# An event that does not change the velocities ends the run at the first impact.

# %%
first = ball.simulate(values, (1,), (0,), times, events=Event(x))
assert abs(first.t[-1] - np.sqrt(2 / 9.81)) < 1e-9 and abs(first.q[-1, 0]) < 1e-12
str(first.ending)

# %% [markdown]
# ## The motion
#
# The ball falls from 1 m and rests after infinitely many impacts.

# %%
picture = run.plot()
picture
