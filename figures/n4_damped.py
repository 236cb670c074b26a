# %% [markdown]
# # Figure n4: what friction does to the paired precession
#
# The angle about the joint line while friction stops the paired precession, and the radius of the precession as the rotors
# spin down.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, Structure, paired_scene
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, CORRECTION_COLOUR, EXACT_COLOUR, legend_below

SPIN, TILT = 10.0, 0.1
FRICTIONS = (0.3, 0.5, 0.8)  # N m s/rad
SHOWN, AT_REST = 6.0, 20.0  # a/c: what is drawn, and when the motion is e^−20 of its start
FAST, SMALL, WEAR, LONG = 40.0, 0.02, 0.1, 6.0

TITLE = "Friction of the paired precession"
ALT = (
    "Left: the angle about the joint line as a function of time for three values of friction. Each run oscillates and then "
    "comes to rest at an angle, which is larger for smaller friction. A dotted line marks the predicted angle G r0 squared "
    "divided by 2 c. Right: the radius of the precession for friction that is the same in every direction, and with "
    "constant spins; the first grows and the second shrinks."
)


# %%
def decaying(friction: float) -> tuple[np.ndarray, np.ndarray]:
    """Times over a/c, the last of them at rest, and the mean angle about the joint line (rad) of a pair stopped by friction."""
    start = paired_scene(Scene(spins=(SPIN, -SPIN), link=Link(1, 0, 0)), TILT)
    s = Structure([(0, 0), (1, 0)], [(0, 1)], [SPIN, -SPIN], friction=friction)
    t = np.append(np.linspace(0, SHOWN, 400), AT_REST) * 1.25 / friction
    run = s.simulate(t, start.axes, start.rates, tol=1e-6)
    return t * friction / 1.25, np.unwrap(np.arctan2(-run.axes[..., 1], run.axes[..., 2]).mean(0))


def radius(on_spins: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the tilt along the bar over its first amplitude, friction WEAR on the axes and `on_spins` on the spins."""
    start = paired_scene(Scene(spins=(FAST, -FAST), link=Link(1, 0, 0)), SMALL)
    s = Structure([(0, 0), (1, 0)], [(0, 1)], [FAST, -FAST], friction=WEAR, spin_friction=on_spins)
    t = np.linspace(0, LONG, 1201)
    run = s.simulate(t, start.axes, start.rates, tol=1e-6)
    return t, run.axes[..., 0].mean(0) / SMALL


@cache
def data() -> dict[str, np.ndarray]:
    """Times and angles of the runs, (3, n), the last at rest; times and tilts with friction on the spins too, and of spins that
    are kept, (2, m)."""
    runs, slowed = [decaying(c) for c in FRICTIONS], [radius(c) for c in (WEAR, 0.0)]
    return {
        "times": np.array([t for t, _ in runs]),
        "angles": np.array([angle for _, angle in runs]),
        "t": slowed[0][0],
        "tilts": np.array([x for _, x in slowed]),
    }


# %%
def measure() -> dict[str, float]:
    """Angles at rest over G r0²/2c; the radius at the end over the law's, both cases."""
    d = data()
    found = {
        f"angle at rest over the law, c = {c:g}": angle[-1] / (SPIN * TILT**2 / (2 * c))
        for c, angle in zip(FRICTIONS, d["angles"], strict=True)
    }
    late = d["t"] > LONG - 0.5
    for name, x, rate in zip(
        ("friction on the spins too", "spins kept up"), d["tilts"], (WEAR * (1 - 0.8), -WEAR * 0.8), strict=True
    ):
        found[f"radius over the law, {name}"] = np.ptp(x[late]) / 2 / np.exp(rate * (LONG - 0.25))
    return found


_found = list(measure().values())
CAPTION = (
    f"(a) The bar is massless, the spins are ±{SPIN:g} rad/s, and the amplitude is {TILT:g}. The pair comes to rest "
    "rotated about "
    f"the joint line by {', '.join(f'{x:.3f}' for x in _found[:3])} times G r0²/2c (dotted) for c = "
    f"{', '.join(f'{c:g}' for c in FRICTIONS)} N m s/rad. (b) The spins are ±{FAST:g} rad/s, and c = {WEAR:g} N m s/rad. The "
    "radius is proportional to exp((1/I₃ − 1/a) c t) if the friction also acts on the spins, and to exp(−c t/a) if the spins are "
    f"constant. After {LONG - 0.25:g} s it differs from these laws by at most {100 * max(abs(x - 1) for x in _found[3:]):.1f} %."
)


# %%
def figure() -> Figure:
    """Angles over time; radii over time."""
    d = data()
    picture = Figure(figsize=(8.6, 4.6))
    angle, tilt = picture.subplots(1, 2)
    for t, values, c, ink in zip(d["times"], d["angles"], FRICTIONS, CASE_COLOURS[:3], strict=True):
        angle.plot(t[:-1], values[:-1], color=ink, ls=CASE_DASHES[ink], lw=1.4, label=f"exact, c = {c:g} N m s/rad")
    for t, c in zip(d["times"], FRICTIONS, strict=True):
        law = SPIN * TILT**2 / (2 * c)
        angle.plot(t[[0, -2]], [law, law], ":", color=CORRECTION_COLOUR, label="law, G r₀²/2c")
    angle.set(
        xlabel="time $t$ (a/c)",
        ylabel="angle about the joint line (rad)",
        title="Angle of the pair as it comes to rest",
    )
    for x, ink, name in zip(
        d["tilts"], (EXACT_COLOUR, CASE_COLOURS[3]), ("friction on the spins too", "spins kept up"), strict=True
    ):
        tilt.plot(d["t"], x, color=ink, lw=0.8, label=f"exact, {name}")
    for rate, line in ((WEAR * 0.2, "-"), (-WEAR * 0.8, "-")):
        label = "law, radius" if rate > 0 else None
        tilt.plot(d["t"], np.exp(rate * d["t"]), line, color=CORRECTION_COLOUR, lw=1.4, label=label)
    tilt.set(xlabel="time $t$ (s)", ylabel="tilt along the bar / initial tilt", title="Radius of the precession")
    legend_below(picture, 3)
    return picture
