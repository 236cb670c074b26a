# %% [markdown]
# # Figure t13: are the integrals complete?
#
# Lyapunov exponents over amplitude and momentum, Poincaré sections of a regular and a chaotic energy, and the horizon that
# `auto` gives.

# %%
import warnings
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, OKABE_ITO, legend_below
from lagrotor.errors import LagrotorWarning
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

MADE = PAPER.scripts.run("derivations", "t13_integrals")
PAIR, RATE, TURNS = (MADE[name] for name in ("PAIR", "RATE", "TURNS"))
AMPLITUDES, MOMENTA, SECTIONS = (MADE[name] for name in ("AMPLITUDES", "MOMENTA", "SECTIONS"))
STARTS, EXPONENTS, OF_SECTION = (MADE[name] for name in ("starts", "exponents", "of_section"))
SECTION, TOL = 100, 1e-6
CHAOTIC = 0.25  # 1/turn, above what 30 turns of a regular motion leave

TITLE = "Regular and chaotic motion of the pair"


# %%
def section(scene: Scene, turns: int, model: str) -> tuple[np.ndarray, float]:
    """(mean x, half the twist in rad) where the mean x stops growing, (n, 2), until tol is lost; and when that is, turns."""
    t = np.linspace(0, turns * 2 * np.pi / RATE, turns * 60 + 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        run = simulate(scene, t, model, TOL)
    known = run.t < run.horizon
    about = np.arctan2(-run.axes[:, known, 1], run.axes[:, known, 2])
    x, h = run.axes[:, known, 0].mean(0), np.angle(np.exp(1j * (about[1] - about[0]))) / 2
    speed = run.rates[:, known, 0].mean(0)
    at = np.flatnonzero((speed[:-1] > 0) & (speed[1:] <= 0))
    part = speed[at] / (speed[at] - speed[at + 1])
    points = np.column_stack([part * values[at + 1] + (1 - part) * values[at] for values in (x, h)])
    return points, min(run.horizon, run.t[-1]) * RATE / (2 * np.pi)


@cache
def data() -> dict[str, np.ndarray]:
    """exponents (momenta, amplitudes), 1/turn; sections, (n, 3): which start, mean x, half the twist (rad); horizons (phases, 2):
    exponent and horizon (turns) of the starts of the chaotic section."""
    regular, chaotic = STARTS
    # A chaotic run is lost long before the end; the half of it has the same horizon.
    turns = [SECTION // 2 if growth > CHAOTIC else SECTION for growth in OF_SECTION]
    parts = {
        "regular": [section(one, SECTION, "minimal") for one in regular],
        "chaotic": [section(one, most, "auto") for one, most in zip(chaotic, turns, strict=True)],
    }
    return {
        "exponents": EXPONENTS,
        "horizons": np.array(
            [(growth, until) for growth, (_, until) in zip(OF_SECTION, parts["chaotic"], strict=True)]
        ),
    } | {
        name: np.concatenate([np.column_stack([np.full(len(s), k), s]) for k, (s, _) in enumerate(part)])
        for name, part in parts.items()
    }


# %%
def measure() -> dict[str, float]:
    """The largest exponent of the smallest swings of P <= 0 and of all; chaotic starts; horizons."""
    d = data()
    told = d["exponents"]
    own, until = d["horizons"].T
    return {
        "largest exponent at r_0 = 0.05, P <= 0 (1/turn)": float(told[MOMENTA <= 0, 0].max()),
        "largest exponent (1/turn)": float(told.max()),
        "chaotic starts": float((told > CHAOTIC).sum()),
        "chaotic starts of the second section": float((own > CHAOTIC).sum()),
        "shortest horizon (turns)": float(until.min()),
        "turns that the others are known for": float(until[own < CHAOTIC].min()),
        "points of the regular section": float(len(d["regular"])),
    }


_small, _largest, _chaotic, _wild, _short, _long, _ = measure().values()
ALT = (
    "There are four panels. A map of amplitude and momentum shows an exponent in each cell: small oscillations are dark, "
    "near zero, and the middle is bright. Two sections show six starts each. On the first the points of each start lie "
    "along a curve of its own; on the second some do, and the others scatter over one area. Below on the left, the time for "
    "which runs are known is shown against their exponents: some twenty turns for chaotic runs, the whole time for the "
    "others."
)
CAPTION = (
    f"The spins are ±10 rad/s, and the bar has {PAIR.link.mass:g} kg and {PAIR.link.length:g} m. The map (a) shows "
    "exponents over "
    f"{TURNS} turns for amplitudes r_0 and momenta P about the joint line. At r_0 = 0.05 with P ≤ 0 they are at most "
    f"{_small:.2f} "
    f"per turn, as for growth by a power of time; the largest is {_largest:.1f}. {_chaotic:.0f} of "
    f"{AMPLITUDES.size * MOMENTA.size} exceed {CHAOTIC:g}. The sections are "
    "taken at the maxima of the mean x while the error is below 10⁻⁶, in one colour and shape per start, named after "
    "its phase. At r_0 = "
    f"{SECTIONS[0][0]:g}, P/G = {SECTIONS[0][1]:g} (b) each start stays on a curve of constant averaged action. At r_0 = "
    f"{SECTIONS[1][0]:g}, P/G = {SECTIONS[1][1]:g} (d), {_wild:.0f} of {len(STARTS[1])} starts are chaotic. Their error stays "
    "below 10⁻⁶ for "
    f"at least {_short:.0f} turns, the error of the others for all {_long:.0f}. The line in (c) is the time in which "
    "10⁻¹⁴ grows to tol."
).replace("-", "−")


# %%
def figure() -> Figure:
    """The map of exponents, the two sections, the horizons."""
    d = data()
    picture = Figure(figsize=(8.6, 7.6))
    plane, regular, horizons, chaotic = picture.subplots(2, 2).ravel()
    plane.imshow(d["exponents"], origin="lower", aspect="auto", cmap="magma", vmin=0, vmax=1.2)
    plane.set_xticks(range(AMPLITUDES.size), [f"{r:g}" for r in AMPLITUDES])
    plane.set_yticks(range(MOMENTA.size), [f"{p:g}".replace("-", "−") for p in MOMENTA])
    plane.set(xlabel="amplitude $r_0$", ylabel="momentum P/G", title="Lyapunov exponent (1/turn)")
    for (i, j), value in np.ndenumerate(d["exponents"]):
        plane.text(
            j, i, f"{value:.2f}", ha="center", va="center", color="white" if value < 0.8 else "black", fontsize=9
        )
    plane.grid(visible=False)
    looks = list(zip([name for name in OKABE_ITO if name != "yellow"], "osD^vXP", strict=True))
    for panel, name, (r0, p) in zip((regular, chaotic), ("regular", "chaotic"), SECTIONS, strict=True):
        for k in range(len(STARTS[1])):
            points = d[name][d[name][:, 0] == k]
            colour, mark = looks[k]
            panel.plot(points[:, 1], points[:, 2], mark, ms=2.5, color=OKABE_ITO[colour], label=f"start at {18 * k}°")
        panel.margins(0.04)
        panel.set(
            xlabel="mean x",
            ylabel="half the twist (rad)",
            title=f"Section at $r_0$ = {r0:g}, P/G = {p:g}".replace("-", "−"),
        )
    rate = np.linspace(0.3, 1.0, 60)
    horizons.plot(
        d["horizons"][:, 0],
        d["horizons"][:, 1],
        "o",
        color=EXACT_COLOUR,
        mfc="none",
        label="horizon of the model 'auto'",
    )
    horizons.plot(rate, np.log(TOL / 1e-14) / rate, color=CORRECTION_COLOUR, label="ln(tol/10⁻¹⁴) over the exponent")
    horizons.margins(0.04)
    horizons.set(xlabel="exponent (1/turn)", ylabel="horizon (turns)", title="Horizon of a run")
    legend_below(picture, 4, markerscale=1.6)
    return picture
