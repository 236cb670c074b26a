# %% [markdown]
# # Figure t1: the natural frequency of any bar
#
# The one oscillation of the linear pair against the bar's inertia and mass, for equal and for opposite spins, with the
# paper's single constant and its two bars.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Rotor, Scene, natural_rate, simulate
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, CORRECTION_COLOUR, EXACT_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.numerics import peak, spectrum

SPIN, MASS, INERTIA, PRINTED = 10.0, 1.0, 0.1, 0.7125
UNIT = Rotor().I3 * SPIN / Rotor().J
SPINS = {"equal": (SPIN, SPIN), "opposite": (SPIN, -SPIN)}

TITLE = "The natural frequency for any bar"
ALT = (
    "Two panels show the natural frequency in units of G over J. As a function of the bar's inertia at a mass of 1 kg the "
    "curve of equal spins is level at 0.714, and the curve of opposite spins falls; they cross at the dumbbell. As a "
    "function of the mass at an inertia of 0.1 kg m² both fall. The paper's constant is a level line that only equal spins "
    "with its heavy bar meet. Points of the exact model lie on the curves."
)


# %%
def measured(link: Link, spins: tuple[float, float]) -> float:
    """Rate (in G/J) of the highest peak of x in an exact run started upright with a small push along x."""
    scene = Scene(spins, link=link, rates=((0.01, 0, 0),) * 2)
    t = np.linspace(0, 12, 601)
    return peak(*spectrum(t, simulate(scene, t, "minimal", 1e-9).axes[0, :, 0])) / UNIT


@cache
def data() -> dict[str, np.ndarray]:
    """Bars' inertias (kg m²) and masses (kg), frequencies (1, in G/J) in closed form and of exact runs."""
    found = {"inertia": np.linspace(0, 1.2, 61), "mass": np.linspace(0.01, 2, 61)}
    found |= {"inertia_tried": np.array([0.0, 0.5, 1.0]), "mass_tried": np.array([0.01, 0.8, 1.6])}
    for name, spins in SPINS.items():
        for tail, read in (("", lambda link, s=spins: natural_rate(Scene(s, link=link)) / UNIT), ("_tried", None)):
            by = read or (lambda link, s=spins: measured(link, s))
            found[f"{name}_by_inertia{tail}"] = np.array([by(Link(1, MASS, K)) for K in found[f"inertia{tail}"]])
            found[f"{name}_by_mass{tail}"] = np.array([by(Link(1, m, INERTIA)) for m in found[f"mass{tail}"]])
    return found


# %%
def measure() -> dict[str, float]:
    """The paper's bars, and the largest distance of an exact run from the closed form (1)."""
    d = data()
    off = max(
        np.abs(np.interp(d[f"{by}_tried"], d[by], d[f"{name}_by_{by}"]) - d[f"{name}_by_{by}_tried"]).max()
        for name in SPINS
        for by in ("inertia", "mass")
    )
    bars = {"heavy": (Link(1, MASS, 1.0), "inertia", 2), "light": (Link(1, 0.01, INERTIA), "mass", 0)}
    found = {}
    for bar, (link, by, i) in bars.items():
        for name, spins in SPINS.items():
            found[f"{name} spins, {bar} bar (G/J)"] = natural_rate(Scene(spins, link=link)) / UNIT
            found[f"{name} spins, {bar} bar, exact run (G/J)"] = d[f"{name}_by_{by}_tried"][i]
    return found | {"largest distance of the exact model (G/J)": off}


_heavy_equal, _, _heavy, _heavy_run, _, _, _light, _light_run, _off = measure().values()
CAPTION = (
    f"Omega_0 is in units of G/J, with J = {Rotor().J:g} kg m² and ell = R = 1 m. (a) The bar has a mass of "
    f"{MASS:g} kg. (b) It "
    f"has an inertia of {INERTIA:g} kg m². The paper's constant {PRINTED} is J/(J + m R²/2) for equal spins with its heavy bar, "
    f"{_heavy_equal:.5f}. Opposite spins have {_heavy:.5f} with this bar and {_light:.5f} with the light bar of "
    "section 5.2.1. The "
    "circles are the highest peaks of the spectra of exact small motions over 12 s. For opposite spins with these two bars they "
    f"lie at {_heavy_run:.4f} and {_light_run:.4f}. All circles differ from the closed form by at most {_off:.1g}."
)


# %%
def figure() -> Figure:
    """Frequency against inertia and against mass."""
    d = data()
    picture = Figure(figsize=(7.4, 4.6))
    panels = dict(zip(("inertia", "mass"), picture.subplots(1, 2, sharey=True), strict=True))
    colours = {"equal": CORRECTION_COLOUR, "opposite": CASE_COLOURS[2]}
    for by, panel in panels.items():
        for name, colour in colours.items():
            panel.plot(
                d[by],
                d[f"{name}_by_{by}"],
                color=colour,
                ls=CASE_DASHES.get(colour, "-"),
                label=f"closed form, {name} spins",
            )
            panel.plot(
                d[f"{by}_tried"], d[f"{name}_by_{by}_tried"], "o", color=EXACT_COLOUR, ms=5, mfc="none",
                label="exact model", clip_on=False, zorder=4,
            )  # fmt: skip
        panel.axhline(PRINTED, color=PAPER_COLOUR, ls="--", label="the paper's constant")
        edge = MASS / 4 if by == "inertia" else 4 * INERTIA
        panel.axvline(edge, color="#777777", ls=":", label=r"dumbbell, $K = m\ell^2/4$")
        place = 1.0 if by == "inertia" else 0.01
        panel.axvline(place, color=PAPER_COLOUR, lw=5, alpha=0.25, label="the paper's bar")
        panel.set_ylabel("natural frequency Ω₀ (G/J)")
    panels["inertia"].set(xlabel="inertia of the bar K (kg m²)", title=f"Bar of mass m = {MASS:g} kg")
    panels["mass"].set(xlabel="mass of the bar m (kg)", title=f"Bar of inertia K = {INERTIA:g} kg m²")
    panels["mass"].set_xlim(-0.05, 2)
    panels["inertia"].set_ylim(0.4, 1.05)
    legend_below(picture, 3)
    return picture
