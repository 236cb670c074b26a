# %% [markdown]
# # Speed against accuracy
#
# **Physics.** Two rotors of $M = R = I_1 = I_3 = 1$ with spins $\pm 10$ rad/s, a massless bar as long as they are, no
# gravity: the exact pair, as it is stepped by each rung of the ladder and by each solver.
#
# **Consistent initial state.** The paired precession of amplitude $r_0 = 0.204$ by its series through $r_0^9$: on the bar,
# and with the velocities that belong to it. A tilt without its velocity of second order stretches the bar or drifts.
#
# **Reference.** Two formulations at 1e-13, the bar eliminated and unit vectors with multipliers; how far they are apart is
# the floor of the chart. With thirty digits, by extrapolation, they agree to the last one kept: tests/study holds that.

# %%
from lagrotor.paper.tables import Table
from lagrotor.study.chart import METHODS, chart, courses, front

# %% [markdown]
# **Tolerances.** From crude to the floor; what counts is the largest error of a tip over the run, against evaluations, the
# same on every machine, and against seconds, medians of runs that take turns.

# %%
OURS = {name: METHODS[name] for name in ("closed form", "minimal", "spheres", "minimal, DOP853", "minimal, Adams 12")}
found = chart("displaced", courses(quick=True)["displaced"], OURS, (1e-3, 1e-6, 1e-9, 1e-11, 1e-13))
by_work = front(found.points, "evaluations")

# %% [markdown]
# **Conclusion.** In evaluations the series wins as far as it goes, then methods of high order. In seconds what counts in
# Python is who calls the rate: scipy's compiled loop down to 1e-10, Adams of order 12 in equal steps below, and DOP853 in
# Python nowhere. `lagrotor chart` draws all of it, with the fast extra and other tools where they are installed.

# %%
tables = [
    Table(
        "Speed against accuracy: the front in evaluations",
        ("method", "tolerance", "error of a tip (m)", "evaluations"),
        tuple((p.method, f"{p.tol:g}", f"{p.error:.1e}", f"{p.evaluations:,}") for p in by_work),
        f"The reference's two formulations agree to {found.floor:.0e} m.",
    ),
]
