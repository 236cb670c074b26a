# %% [markdown]
# # Figure t11: the slow motion of opposite spins
#
# The phase portrait of the averaged motion in closed form, lean of the mean axis against half the angle between the axes, for a
# light and for a heavy bar; an exact run on its curve. And the slow frequency beside the paired precession under a push.

# %%
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lagrotor import Link, Scene, Shock, floquet, natural_rate, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.theory import SlowMotion, slow_frequency, slow_motion

LIGHT, HEAVY = Link(1, 0.01, 0.1), Link(1, 12.0, 0.0)
FORCE, LASTS, SHARE = 30.0, 15.0, 36
R0, PUSHES = 0.06, np.array([-0.9, -0.4, 0.3, 0.8, 1.1])
UNIT = (10 / (2 * 1.25)) ** 2 * R0**6  # g² s⁶ of the massless bar

OTHERS = "#999999"  # colour of motions from other starts

TITLE = "The slow motion of opposite spins"
ALT = (
    "Left and middle: curves of the lean as a function of half the angle between the axes, in units of the oscillation. "
    "With the light bar the green curve of the shock runs out to large lean, and an exact run follows it. With the heavy "
    "bar the curve closes near the upright position. Right: the squared slow frequency as a function of the push. It is "
    "positive from zero to about 1.2 and negative outside; exact circles lie near the curve."
)


# %%
def scene(link: Link) -> Scene:
    """Opposite spins and a shock along x."""
    return Scene(spins=(10, -10), link=link, shock=Shock((FORCE, 0, 0), 0.5, 1 / 20))


def centre(one: Scene) -> tuple[np.ndarray, np.ndarray]:
    """(lean, half-angle) on an exact run, averaged over three swings by a smooth weight."""
    assert one.shock is not None
    turn = 2 * np.pi / natural_rate(one)
    t = one.shock.end + np.arange(0, LASTS, turn / SHARE)
    r = simulate(one, [0.0, *t], "minimal", 1e-6).axes[:, 1:]
    mean, angle = r.sum(0), np.arctan2(-r[..., 1], r[..., 2])
    lean = np.arcsin(mean[:, 0] / np.linalg.norm(mean, axis=1))
    half = np.arcsin(np.linalg.norm(r[1] - r[0], axis=1) / 2) * np.sign(np.sin(angle[1] - angle[0]))
    u = (np.arange(3 * SHARE) + 0.5) / (3 * SHARE)
    weight = np.exp(-1 / (u * (1 - u)))
    return np.convolve(lean, weight / weight.sum(), "valid"), np.convolve(half, weight / weight.sum(), "valid")


def squares(pushes: np.ndarray) -> np.ndarray:
    """Square of the slow frequency of a massless bar by the law, over g² s⁶, at pushes d/s²."""
    one = Scene((10, -10), link=Link(1))
    return np.array([(slow_frequency(one, R0, float(d) * R0**2 * one.momenta[0]) ** 2).real for d in pushes]) / UNIT


@cache
def data() -> dict[str, np.ndarray]:
    """Exact centres; pushes d/s² and squares of the slow frequency over g² s⁶, exact and by the law."""
    lean, half = centre(scene(LIGHT))
    one = Scene((10, -10), link=Link(1))
    orbits = [floquet(one, R0, float(d) * R0**2 * one.momenta[0]) for d in PUSHES]
    exact = [(o.turning**2 - o.growth**2) * (o.frequency / (2 * np.pi)) ** 2 for o in orbits]
    return {"lean": lean, "half": half, "pushes": PUSHES, "exact": np.array(exact) / UNIT, "law": squares(PUSHES)}


# %%
def measure() -> dict[str, float]:
    """How far the exact centre leaves its curve, of the half-angle at the start; the slow frequency's distance."""
    d, motion = data(), slow_motion(scene(LIGHT))
    s2, c = motion.swing**2, np.cos(d["lean"]) ** 2
    D = np.sqrt(3 * s2**2 / 8 + (motion.invariant - motion.weight * s2**2 / 2) * c + (motion.weight * s2 * c / 2) ** 2)
    curve = np.sqrt(np.maximum(D - s2 * (1 - motion.weight * c) / 2, 0.0))  # the shock along x leaves P = 0
    return {
        "largest distance from the curve": float(np.abs(curve - np.abs(d["half"])).max() / abs(motion.half)),
        "largest lean of the run": float(np.abs(d["lean"]).max()),
        "largest relative distance of the frequency squared": float(
            np.abs(d["law"] - d["exact"]).max() / np.abs(d["exact"]).max()
        ),
    }


_off, _lean, _apart = measure().values()
CAPTION = (
    f"The spins are ±10 rad/s, and the shock is {FORCE:g} N along x. (a) With a bar of 0.01 kg the exact run, "
    "averaged over three "
    f"oscillations, leans to {np.degrees(_lean):.0f}° in {LASTS:g} s. Its distance from its curve is at most "
    f"{_off:.2f} times the "
    "initial half-angle. (b) With a bar of 12 kg, above the threshold, x turns back; the motion does not reach "
    "the curves of the "
    f"same value at large lean. (c) The square of the slow frequency near the paired precession of r₀ = {R0}, with a massless "
    "bar, as a function of a push d = k P/G about the joint line, in units of g² s⁶. The exact multipliers differ by at most "
    f"{1e4 * _apart:.1f}×10⁻⁴ of the largest value. Where it is negative, a perturbation grows."
)


# %%
def portrait(panel: Axes, motion: SlowMotion, name: str) -> None:
    """Curves of W over lean and half-angle, both axes in units that a reader sees; that of the motion in green."""
    lean, half = np.meshgrid(np.linspace(-1.45, 1.45, 201), np.linspace(-2.2, 2.2, 201))
    s2, c = motion.swing**2, np.cos(lean) ** 2
    W = ((half**2 + 0.5) ** 2 - 3 / 8) / c - motion.weight * half**2
    start = motion.invariant / s2**2
    levels = np.unique([*(start + np.array([-2.0, -1.2, -0.6, -0.2, 0.4, 1.2, 3, 8, 20]))])
    panel.contour(np.degrees(lean), half, W, levels, colors=[OTHERS], linewidths=0.8, linestyles="-")
    panel.contour(np.degrees(lean), half, W, [start], colors=[CORRECTION_COLOUR], linewidths=1.8, linestyles="-")
    panel.plot([], [], color=OTHERS, lw=0.8, label="closed form, other starts")
    panel.plot([], [], color=CORRECTION_COLOUR, lw=1.8, label="closed form, after the shock")
    panel.set(xlabel="lean β (deg)", title=name, ylim=(-2.2, 2.2))


def figure() -> Figure:
    """Two portraits; slow frequency against push."""
    d = data()
    picture = Figure(figsize=(8.6, 4.4))
    left, middle, right = picture.subplots(1, 3)
    for panel, link, name in ((left, LIGHT, "Light bar"), (middle, HEAVY, "Heavy bar")):
        portrait(panel, slow_motion(scene(link)), name)
    left.plot(
        np.degrees(d["lean"]),
        d["half"] / slow_motion(scene(LIGHT)).swing,
        color=EXACT_COLOUR,
        lw=1.2,
        label="exact run",
    )
    left.set_ylabel("half-angle η/s")
    fine = np.linspace(-1.1, 1.3, 121)
    right.plot(fine, squares(fine), color=CORRECTION_COLOUR, label="closed form, frequency")
    right.plot(d["pushes"], d["exact"], "o", mfc="none", color=EXACT_COLOUR, ms=6, label="exact multipliers")
    right.axhline(0, color="0.6", lw=0.7)
    right.set(xlabel="push d/s²", ylabel="frequency²/(g² s⁶)", title="Slow frequency")
    legend_below(picture, 3)
    return picture
