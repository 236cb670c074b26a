# %% [markdown]
# # Speed against accuracy
#
# **Physics.** Two rotors of $M = R = I_1 = I_3 = 1$ with spins $\pm 10$ rad/s, a massless bar of length 1, no gravity. The
# exact pair is integrated in each of the models and by each solver of the core packages.
#
# **Consistent initial state.** The paired precession of amplitude $r_0 = 0.204$, by its series through $r_0^{21}$. The
# positions and velocities satisfy the bar's constraint. Without the velocity of second order the same pair falls within 20 s.
#
# **Reference.** Two formulations at the tolerance $10^{-13}$: the eliminated bar, and unit vectors with multipliers. Their
# difference is the error of the reference. A calculation with thirty digits, by extrapolation, agrees with both to
# $3\times10^{-13}$ (tests/benchmark).

# %%
from dataclasses import replace

from lagrotor.benchmark.runner import benchmark, front, work_at
from lagrotor.benchmark.scenes_and_methods import CASES, METHODS
from lagrotor.benchmark.scipy_solvers import TRAPS
from lagrotor.paper import Remark, Table

# %% [markdown]
# **Tolerances.** Every second power of ten from $10^{-3}$ to $10^{-13}$. The largest error of a tip over the run is compared
# with the number of evaluations of the right-hand side, nfev, which is the same on every machine. `lagrotor chart` adds the
# processor time, the fast extra, and Radau and BDF, which require the most evaluations. Other tools are in `b2_seconds`.

# %%
TOLERANCES = tuple(10.0**-n for n in range(3, 14, 2))
OURS = ("closed form", "minimal", "spheres", "euler", "minimal, Adams", "minimal, DOP853")
SCIPY = ("solve_ivp, RK45", "solve_ivp, LSODA", "ode, DOP853", "ode, Adams (VODE)")
displaced, shock = (replace(CASES[name](True), repeats=0) for name in ("displaced", "shock"))
found = benchmark("displaced", displaced, {name: METHODS[name] for name in (*OURS, *SCIPY)}, TOLERANCES, float("inf"))
series = [p for p in found.points if not p.nfev]
by_work = front([p for p in found.points if p.nfev], "nfev")


def least(method: str, error: float) -> float | None:
    """nfev of a method for an error (m), interpolated between its tolerances."""
    return work_at([p for p in found.points if p.method == method], error, "nfev")


def needed(method: str, error: float) -> str:
    """nfev to two digits, because it is interpolated; — if the method does not reach the error."""
    nfev = least(method, error)
    return "—" if nfev is None else f"{float(f'{nfev:.2g}'):,.0f}"


def exceeded(method: str) -> float:
    """The largest error (m) of a method divided by its tolerance."""
    return max(p.error / p.setting for p in found.points if p.method == method)


displaced.scene

# %% [markdown]
# **A pulse between two steps.** The shock of 5.2.1 follows two seconds of rest. A solver that is called once over the run,
# without a limit on its step, then has a step longer than the shock. Most solvers miss the shock without a warning.

# %%
missed = benchmark("shock", shock, TRAPS, (1e-3, 1e-6), float("inf"))
correct = sorted({p.method for p in missed.points if p.error < 0.1})
assert correct == ["solve_ivp, DOP853, one call"]

# %% [markdown]
# **Conclusion.**

# %%
best = min(series, key=lambda p: p.error)
ratio = least("solve_ivp, RK45", 1e-9) / least("minimal, Adams", 1e-9)
Remark(
    "Speed against accuracy",
    f"On the paired precession the closed form requires no evaluation; its error is {best.error:.0e} m. For the integrations "
    "the order of the method matters most. For an error of 1e-9 m Adams with equal steps requires about "
    f"{needed('minimal, Adams', 1e-9)} evaluations, and Runge–Kutta of order 5 requires {ratio:.0f} times as many. At a "
    "tolerance of 1e-13 the errors of scipy's solvers exceed the error of the reference, except for DOP853 in `ode`. That "
    "solver restarts at every output time, so its number of evaluations hardly depends on the tolerance.",
)

# %%
tables = [
    Table(
        "Speed against accuracy: the Pareto front in evaluations",
        ("method", "tolerance", "error of a tip (m)", "evaluations"),
        tuple((p.method, f"{p.setting:g}", f"{p.error:.1e}", f"{p.nfev:,}") for p in (best, *by_work)),
        f"The first row is the closed form with the smallest error; the other rows are integrations. The two formulations of the "
        f"reference agree to {found.floor:.0e} m.",
    ),
    Table(
        "Speed against accuracy: evaluations for an error of the tips (m)",
        ("method", "1e-6", "1e-9", "1e-12", "largest error / tolerance"),
        tuple(
            (name, *(needed(name, error) for error in (1e-6, 1e-9, 1e-12)), f"{exceeded(name):.2g}")
            for name in (*OURS, *SCIPY)
        ),
        "Logarithmic interpolation between the tolerances on either side of the error gives these numbers to two digits. The "
        "models closed form, minimal, spheres and euler estimate their error, for which they integrate twice, and warn if it "
        "exceeds the tolerance. Solvers without an estimate exceed the tolerance without a warning, by the last column.",
    ),
    Table(
        "Speed against accuracy: solvers called once over the shock of 5.2.1",
        ("method", "tolerance", "error of a tip (m)", "evaluations"),
        tuple((p.method, f"{p.setting:g}", f"{p.error:.1e}", f"{p.nfev:,}") for p in missed.points),
        "An error of 0.4 m is as large as the motion.",
    ),
]
tables[0]

# %%
tables[1]

# %%
tables[2]
