# %% [markdown]
# # Figure t14: the guiding centre
#
# Where the centre of the swing goes for two unequal spins, in lean and half the twist and over time: the law and exact runs.

# %%
from dataclasses import replace
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, consistent_scene, simulate
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, EXACT_COLOUR, legend_below
from lagrotor.theory import guiding_centre, leaning_state

PAIR = Scene((11, 7), link=Link(0.8, 4.0, 0.0))
PUSHES = {  # x', y' of either axis
    "across the field": (0.1, 0.015, 0.1, -0.015),
    "along it": (0.01, 0.006, 0.01, -0.009),
    "both ways": (0.1, 0.027, 0.1, -0.034),
}
DURATION, POINTS, FINE = 75.0, 51, 16  # s; a circle every FINE points of the exact motion

TITLE = "The guiding centre of two unequal spins"
ALT = (
    "Left: half the twist as a function of the lean. Three curves follow thin lines of constant flux, with exact circles on "
    "the curves. Right: half the twist as a function of time. One curve continues in one direction; the two others, of "
    "pairs that oscillate, turn back. Circles lie on the curves, and the exact motion oscillates about them."
)


# %%
def start(push: tuple[float, ...]) -> Scene:
    """The pair, leaning and twisted, with the rates x', y' of both axes."""
    rates = ((push[0], push[1], 0), (push[2], push[3], 0))
    return consistent_scene(PAIR.spins, ((0.3, 0.1, 1), (0.3, -0.1, 1)), rates, PAIR.rotor, PAIR.link)


@cache
def data() -> dict[str, np.ndarray]:
    """Times (n,) in s; for each push the law's (beta, h, alpha) (n, 3), those of the exact centres, and of the exact motion."""
    t = np.linspace(0, DURATION, FINE * (POINTS - 1) + 1)
    found = {"times": t}
    for name, push in PUSHES.items():
        one = start(push)
        run = simulate(one, t, "minimal", 1e-9)
        states = [
            replace(one, axes=tuple(map(tuple, r)), rates=tuple(map(tuple, v)))
            for r, v in zip(run.axes.swapaxes(0, 1), run.rates.swapaxes(0, 1), strict=True)
        ]
        found[name] = guiding_centre(one).path(t)
        found[f"exact, {name}"] = np.array([guiding_centre(state).place for state in states])
        found[f"motion, {name}"] = np.array([leaning_state(state)[0] for state in states])
    return found


# %%
def measure() -> dict[str, float]:
    """How far (rad) the centre goes, and the largest distance of the law from the exact centres, for each push."""
    d = data()
    gone = {f"way of the push {name} (rad)": float(np.ptp(d[name][:, :2], axis=0).max()) for name in PUSHES}
    return gone | {f"off, {name} (rad)": float(np.abs(d[name] - d[f"exact, {name}"]).max()) for name in PUSHES}


_numbers = list(measure().values())
CAPTION = (
    f"The spins are {PAIR.spins[0]:g} and {PAIR.spins[1]:g} rad/s. A tilted and twisted initial state is pushed in "
    "three ways. In "
    f"{DURATION:g} s the centre (a) moves by up to {max(_numbers[:3]):.2f} rad, and the law differs from the centres of "
    "the exact runs "
    f"(circles) by at most {max(_numbers[3:]):.3f} rad. On the thin lines the part G₁x₁ + G₂x₂ of the momentum about "
    "the joint line "
    "is constant. The dotted curve (b) is the exact motion."
)


# %%
def figure() -> Figure:
    """The plane of lean and half the twist; half the twist over time."""
    d = data()
    picture = Figure(figsize=(7.6, 4.4))
    plane, course = picture.subplots(1, 2)
    beta, h = np.meshgrid(np.linspace(0.2, 0.36, 60), np.linspace(-0.3, 0.6, 60))
    first, second = PAIR.momenta
    flux = (first + second) * np.sin(beta) * np.cos(h) + (first - second) * np.sin(h) ** 2 / PAIR.k
    plane.contour(beta, h, flux, levels=14, colors="0.75", linewidths=0.7)
    for (name, _), colour in zip(PUSHES.items(), CASE_COLOURS, strict=False):
        law, centres, motion = d[name], d[f"exact, {name}"], d[f"motion, {name}"]
        plane.plot(law[:, 0], law[:, 1], color=colour, ls=CASE_DASHES[colour], label=f"law, pushed {name}")
        plane.plot(
            centres[::FINE, 0], centres[::FINE, 1], "o", color=EXACT_COLOUR, mfc="none", ms=4, label="exact centres"
        )
        course.plot(d["times"], motion[:, 1], ":", color=EXACT_COLOUR, lw=0.8, label="exact motion")
        course.plot(d["times"], law[:, 1], color=colour, ls=CASE_DASHES[colour])
        course.plot(d["times"][::FINE], centres[::FINE, 1], "o", color=EXACT_COLOUR, mfc="none", ms=4)
    plane.set(xlabel="lean β (rad)", ylabel="half the twist h (rad)", title="Path of the centre")
    course.set(xlabel="time $t$ (s)", ylabel="half the twist h (rad)", title="Twist over time")
    legend_below(picture, 3)
    return picture
