# %% [markdown]
# # Figure b1: error against evaluations
#
# The points of derivations/b1_chart.py: each model and solver of the core packages on the displaced pair, at every second
# power of ten as tolerance.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.benchmark.runner import work_at
from lagrotor.drawing import OKABE_ITO, legend_below
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

# Method → colour and marker: models as `simulate` runs them, engines on the minimal model, other solvers of scipy on it.
LOOKS = {
    "minimal": ("blue", "o"),
    "spheres": ("black", "s"),
    "euler": ("orange", "D"),
    "minimal, Adams": ("vermillion", "^"),
    "minimal, DOP853": ("reddish purple", "v"),
    "solve_ivp, RK45": ("sky blue", "p"),
    "solve_ivp, LSODA": ("grey", "*"),
    "ode, DOP853": ("olive", "X"),
    "ode, Adams (VODE)": ("bluish green", "P"),
}
CLOSED = "closed form"
SHOWN = (500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000)  # evaluations with a tick

TITLE = "Error of each method against its number of evaluations"
ALT = (
    "A chart on logarithmic axes shows the largest error of a tip over ten seconds as a function of the number of "
    "evaluations of the right-hand side. There is one curve for each method, from the coarsest to the finest tolerance. All "
    "curves fall to the right; Adams in equal steps and the models of simulate fall most steeply, Runge–Kutta of order 5 "
    "least. A grey band follows the front. A dashed line is the closed form, which needs no evaluation."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Errors (m) and evaluations (9, 6), NaN where a method failed; errors (6,) of the closed form; front (n, 2); floor."""
    made = PAPER.scripts.run("derivations", "b1_chart")
    found, tolerances = made["found"], made["TOLERANCES"]
    errors, evaluations = np.full((2, len(LOOKS), len(tolerances)), np.nan)
    closed = np.full(len(tolerances), np.nan)
    for p in found.points:
        j = tolerances.index(p.setting)
        if p.method == CLOSED:
            closed[j] = p.error
        else:
            i = list(LOOKS).index(p.method)
            errors[i, j], evaluations[i, j] = p.error, p.nfev
    front = np.array([(p.nfev, p.error) for p in made["by_work"] if p.nfev])
    return {
        "errors": errors, "evaluations": evaluations, "closed": closed, "front": front, "floor": np.array([found.floor])
    }  # fmt: skip


# %%
def needed(error: float) -> dict[str, float]:
    """Evaluations of each method that reaches `error` (m), between its tolerances: to two digits."""
    points = PAPER.scripts.run("derivations", "b1_chart")["found"].points
    spent = {name: work_at([p for p in points if p.method == name], error, "nfev") for name in LOOKS}
    return {name: float(f"{nfev:.2g}") for name, nfev in spent.items() if nfev is not None}


def measure() -> dict[str, float]:
    """The least evaluations of any method for three errors, and the closed form's error."""
    found: dict[str, float] = {f"evaluations for {e:g} m": min(needed(e).values()) for e in (1e-6, 1e-9, 1e-12)}
    return found | {"error of the closed form (m)": float(np.nanmin(data()["closed"]))}


CAPTION = (
    "Ten seconds of the paired precession with r_0 = 0.204, spins of ±10 rad/s and a massless bar are computed at "
    "1001 output times. "
    "The tolerance is every second power of ten from 1e-3 to 1e-13. For an error of 1e-9 m the best method needs about "
    f"{min(needed(1e-9).values()):,.0f} evaluations, and Runge–Kutta of order 5 needs "
    f"{needed(1e-9)['solve_ivp, RK45']:,.0f}. The grey band joins the points that no method beats, and the "
    "dotted line is the error of the reference. ode is called for every output time, where DOP853, a one-step method, "
    "starts anew. "
    "solve_ivp and ode run the minimal model."
)


# %%
def figure() -> Figure:
    """One panel: a curve a method, the front behind them."""
    d = data()
    picture = Figure(figsize=(7.4, 6.0))
    panel = picture.subplots()
    panel.step(
        d["front"][:, 0],
        d["front"][:, 1],
        where="post",
        color="#bbbbbb",
        linewidth=6,
        alpha=0.5,
        label="fewest evaluations",
    )
    for (name, (colour, marker)), off, spent in zip(LOOKS.items(), d["errors"], d["evaluations"], strict=True):
        panel.loglog(
            spent,
            off,
            color=OKABE_ITO.get(colour, colour),
            marker=marker,
            markersize=5,
            linewidth=1.0,
            label=name if "," in name else f"simulate, {name}",
        )
    panel.axhline(np.nanmin(d["closed"]), color="#222222", linestyle="--", label="closed form, no evaluation")
    panel.axhline(d["floor"][0], color="#888888", linestyle=":", linewidth=0.9, label="error of the reference")
    panel.set(xlabel="evaluations of the right-hand side", ylabel="largest error of a tip (m)")
    panel.set_title("Paired precession over 10 s")
    panel.set_xticks(SHOWN, [f"{n:,}" for n in SHOWN])
    panel.minorticks_off()
    panel.margins(0.05)
    legend_below(picture, 3)
    return picture
