# %% [markdown]
# # Figure t10: what the pair conserves
#
# Swing of the energy, the axial momenta, the momentum about the joint line and the paper's integrals over a turn of the
# paired precession, against its amplitude.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, simulate
from lagrotor.drawing import CASE_COLOURS, CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order, swing
from lagrotor.pair import ansatz_A

AMPLITUDES = np.array([0.05, 0.1, 0.2, 0.4])
FLOOR, MODELS = 1e-16, ("minimal", "euler")

TITLE = "Conserved quantities of the pair"


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Amplitudes (n,); swings over a turn, (2, n): E (J), G_1, P, A, B (kg m²/s), by model."""
    found: dict[str, list[list[float]]] = {name: [[], []] for name in ("E", "G_1", "P", "A", "B")}
    for r0 in AMPLITUDES:
        orbit = exact_orbit(Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)), r0)
        t = np.linspace(0, 2 * np.pi / orbit.frequency, 97)
        for i, model in enumerate(MODELS):
            run = simulate(orbit.scene, t, model, 1e-12)
            held = {"E": run.energy, "A": ansatz_A(run), **run.invariants}
            held["B"] = held["G_1"] - held["G_2"]
            for name in found:
                found[name][i].append(swing(held[name]))
    return {"amplitudes": AMPLITUDES} | {name: np.maximum(values, FLOOR) for name, values in found.items()}


# %%
def measure() -> dict[str, float]:
    """The power of the amplitude with which A swings, its swing at r_0 = 0.2, and the largest swing of the others."""
    d = data()
    return {
        "power of A's swing": measured_order(AMPLITUDES[:3], d["A"][0][:3]),
        "swing of A at r_0 = 0.2 (kg m²/s)": d["A"][0, 2],
        "largest swing of E, G_1, P, B": max(d[name].max() for name in ("E", "G_1", "P", "B")),
    }


_power, _swing, _largest = measure().values()
_first, *_, _last = data()["A"][0]
ALT = (
    "Two panels, one for each model, show on logarithmic axes the variation over one turn as a function of the amplitude. The "
    f"paper's A varies as the square of the amplitude, from {_first:.1g} to {_last:.1g} kg m²/s. Energy, momentum "
    "about the joint line, axial momentum and "
    f"the paper's B stay at the rounding and step errors of the run, all below {_largest:.0e}."
)
CAPTION = (
    "The spins are ±10 rad/s, the bar has m = 0.01 kg and K = 0.1 kg m². Each point is one turn of the exact orbit in "
    "the minimal (a) or Euler (b) model at "
    "the tolerance "
    f"1e-12. Values below {FLOOR:g} are drawn at this value. The axial momenta are constant parameters of the reduced models. E, "
    f"G_1, P and B = G_1 − G_2 vary by at most {_largest:.1e} in SI units. The paper's A varies by {_swing:.3f} kg m²/s at r_0 = "
    f"0.2; its variation is proportional to the amplitude to the power {_power:.2f}."
)


# %%
def figure() -> Figure:
    """Swings against amplitude, one panel a model."""
    d = data()
    picture = Figure(figsize=(7.4, 5.0))
    looks = {
        "A": (PAPER_COLOUR, "o", "the paper's A (kg m²/s)"),
        "E": (EXACT_COLOUR, "s", "energy E (J)"),
        "P": (CORRECTION_COLOUR, "^", "momentum about the joint line P (kg m²/s)"),
        "B": (CASE_COLOURS[1], "D", "the paper's B (kg m²/s)"),
        "G_1": (CASE_COLOURS[0], "x", "axial momentum $G_1$ (kg m²/s)"),
    }
    for i, (model, panel) in enumerate(zip(MODELS, picture.subplots(1, 2, sharey=True), strict=True)):
        for name, (colour, mark, says) in looks.items():
            panel.loglog(
                AMPLITUDES, d[name][i], f"-{mark}", color=colour, ms=6, mfc="none", clip_on=False,
                label=says if i == 0 else None,
            )  # fmt: skip
        panel.set(
            xlabel="amplitude $r_0$",
            ylabel="" if i else "change over one turn (SI)",
            title=f"{model.capitalize()} model",
        )
        panel.set_ylim(FLOOR / 3, 10)
        panel.set_xticks(AMPLITUDES, [f"{r:g}" for r in AMPLITUDES])
        panel.set_xticks([], minor=True)
    legend_below(picture, 2)
    return picture
