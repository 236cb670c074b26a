# %% [markdown]
# # Figure b2: other tools on growing mechanisms
#
# The points of derivations/b3_mechanisms.py: time to be ready and time of a right-hand side, n rods and n gyroscopes. lagrotor
# and sympy's methods are from the record of bodies and Lagrangians, the other tools from the record of mechanisms.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation, LogLocator

from lagrotor.benchmark.mechanism_tables import mechanism_name
from lagrotor.benchmark.records import LINKS, record_age, recorded_bodies_and_lagrangians, recorded_mechanisms
from lagrotor.drawing import OKABE_ITO, legend_below

BESIDE = ("lagrotor, bodies", "KanesMethod", "LagrangesMethod")  # of the record of bodies and Lagrangians
LOOKS = {
    "lagrotor, bodies": ("blue", "o"),
    "lagrotor, fast": ("sky blue", "s"),
    "KanesMethod": ("vermillion", "^"),
    "LagrangesMethod": ("orange", "v"),
    "PyDy, Cython": ("reddish purple", "D"),
    "MuJoCo": ("bluish green", "X"),
    "Pinocchio": ("black", "P"),
    "Drake": ("olive", "p"),
}
WHAT = {"ready": "time until ready (s)", "rhs": "time of a right-hand side (µs)"}

TITLE = "Other tools on growing mechanisms"
ALT = (
    "Four panels on logarithmic axes show times as functions of the number of links. The upper ones show the time until a "
    "tool is ready, the lower ones the time of one right-hand side; rods in relative angles are on the left, gyroscopes on "
    "the right. The lines of lagrotor lie below those of sympy's methods, which end at the time limit. The compiled engines "
    "are ready at once. Solid and dotted lines are two runs on two machines."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Numbers of links, and seconds (tools, numbers) for each mechanism and measure, NaN where there is none."""
    found: dict[str, np.ndarray] = {}
    for kind, numbers in LINKS.items():
        found[f"n of {kind}"] = np.array(numbers)
        names = {mechanism_name(kind, n): n for n in numbers}
        for what in WHAT:
            seconds = {(x.tool, x.n): getattr(x, what) for x in recorded_mechanisms().measured if x.kind == kind}
            beside = [x for x in recorded_bodies_and_lagrangians()["rows"] if x["mechanism"] in names]
            seconds |= {(x["tool"], names[x["mechanism"]]): x[what] for x in beside}
            rows = [[seconds.get((name, n)) or np.nan for n in numbers] for name in LOOKS]
            found[f"{what} of {kind}"] = np.array(rows)
    return found


def measure() -> dict[str, float]:
    """How the time to be ready and that of a right-hand side grow from the smallest to the largest, by one link."""
    d, found = data(), dict[str, float]()
    for kind in ("rods", "gyroscopes"):
        n = d[f"n of {kind}"]
        for what in WHAT:
            row = d[f"{what} of {kind}"][0]
            found[f"power of n, {what}, {kind}"] = float(np.log(row[-1] / row[0]) / np.log(n[-1] / n[0]))
    return found


_BESIDE, _OTHERS = recorded_bodies_and_lagrangians(), recorded_mechanisms()
CAPTION = (
    "Processor times of several tools: (a), (b) until the mechanism is ready, (c), (d) of a right-hand side. Each tool "
    "runs in its own process, and its right-hand side equals the others' "
    "to 1e-9. Solid "
    f"lines are one run on {_BESIDE['machine']['processor']}. "
    f"{record_age('bodies_and_lagrangians', _BESIDE['date'], _BESIDE['digest'])} Dotted lines are "
    f"another run on {_OTHERS.machine['processor']}. {record_age('mechanisms', _OTHERS.date, _OTHERS.digest)} "
    "Between the smallest and the largest mechanism the time until lagrotor is ready is proportional to n to the power "
    f"{measure()['power of n, ready, rods']:.2f} for rods and {measure()['power of n, ready, gyroscopes']:.2f} for gyroscopes. "
    "A line ends at the time limit; 'fast' means compiled by heyoka. Engines take their mechanisms as data and derive nothing."
)


# %%
def figure() -> Figure:
    """A row for each measure, a column for each mechanism."""
    d = data()
    picture = Figure(figsize=(8.6, 7.2))
    panels = picture.subplots(2, 2)
    for row, (what, label) in zip(panels, WHAT.items(), strict=True):
        for panel, kind in zip(row, ("rods", "gyroscopes"), strict=True):
            for (name, (colour, marker)), seconds in zip(LOOKS.items(), d[f"{what} of {kind}"], strict=True):
                line = {"color": OKABE_ITO.get(colour, colour), "marker": marker, "markersize": 5, "linewidth": 1.0}
                line["linestyle"] = "-" if name in BESIDE else ":"
                panel.loglog(d[f"n of {kind}"], seconds * (1e6 if what == "rhs" else 1), label=name, **line)
            panel.set(
                xlabel=f"number of {kind}", ylabel=label, title=f"{kind.capitalize()}: {label.rpartition(' (')[0]}"
            )
            panel.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if what == "rhs" else (1,)))
            panel.yaxis.set_major_formatter("{x:g}" if what == "rhs" else LogFormatterSciNotation())
            panel.set_xticks(d[f"n of {kind}"], [str(n) for n in d[f"n of {kind}"]])
            panel.minorticks_off()
            panel.margins(x=0.04)
    legend_below(picture, 4)
    return picture
