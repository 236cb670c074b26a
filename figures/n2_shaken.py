# %% [markdown]
# # Figure n2: spins against a tuned mass
#
# The largest amplification of a sway against the spin, for spins with the optimal brace and damper and for tuned
# masses; and the transfer functions.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Brace, Rotor, Structure
from lagrotor.drawing import CASE_COLOURS, CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.structures import mass_worst_case, spins_win_worst_case, spins_worst_case

ROTOR, LOAD, SWAY = Rotor(1, 1, 1 / 16, 1 / 8), 50.0, 2 * np.pi  # a disc of radius 0.5 m; 50 kg a tip; 1 Hz
INERTIA = ROTOR.J + LOAD * ROTOR.length**2
MASSES = (0.01, 0.02, 0.05)
SHOWN = 0.3

TITLE = "Damping of a sway by spins or by a tuned mass"
ALT = (
    "Left: the largest amplification as a function of the ratio of spin to sway rate. The curve of the spins falls as one "
    "divided by the spin and crosses the level lines of tuned masses of 1, 2 and 5 per cent. Peaks found on structures lie "
    "on the curve. Right: transfer functions of the bare sway, of a tuned mass of 2 per cent and of spins. The first has a "
    "pole, the others have two low peaks."
)


# %%
def pair(gamma: float, sign: int = -1) -> Structure:
    """The pair that sways along its bar at SWAY, with the optimal brace and damper across it."""
    best = spins_worst_case(gamma)
    spring, damper = float(INERTIA * SWAY**2 * best.tuning), float(2 * best.damping * INERTIA * SWAY)
    braces = [
        Brace(0, (-1.0, 0.0, 1.0), 2 * INERTIA * SWAY**2),
        *(Brace(k, (float(k), 1.0, 1.0), spring, damper) for k in (0, 1)),
    ]
    spin = gamma * INERTIA * SWAY / ROTOR.I3
    return Structure([(0, 0), (1, 0)], [(0, 1)], [spin, sign * spin], ROTOR, load=LOAD, braces=braces)


def amplification(gamma: float, rates: np.ndarray, sign: int = -1) -> np.ndarray:
    """|X K/F| of the sway at rates in units of SWAY."""
    return np.abs(pair(gamma, sign).response(SWAY * rates, (1, 0), 0)[:, 0, 0]) * 2 * INERTIA * SWAY**2


def tuned(mu: float, rates: np.ndarray) -> np.ndarray:
    """|X K/F| under Den Hartog's mass."""
    best, i = mass_worst_case(mu), 1j * rates
    hung = best.tuning + 2 * best.damping * np.sqrt(best.tuning) * i
    return np.abs(1 / (1 + i**2 + mu * i**2 * hung / (hung + i**2)))


@cache
def data() -> dict[str, np.ndarray]:
    """γ and peaks: closed form, of structures (equal, opposite); transfer functions over rates."""
    gamma, tried = np.linspace(0.04, 1.2, 200), np.array([0.06, 0.1, 0.2, 0.4, 0.8])
    fine, rates = np.linspace(0.2, 2, 4_001), np.linspace(0.6, 1.4, 801)
    return {
        "gamma": gamma,
        "peak": spins_worst_case(gamma).value,
        "tried": tried,
        "found": np.array([[amplification(x, fine, sign).max() for x in tried] for sign in (1, -1)]),
        "rates": rates,
        "bare": 1 / np.abs(1 - (rates + 1e-9) ** 2),
        "spun": amplification(SHOWN, rates),
        "tuned": tuned(0.02, rates),
    }


# %%
def measure() -> dict[str, float]:
    """Where spins and masses are even, γ; how far the structures' peaks are above the closed form; peaks shown."""
    d = data()
    found = {f"even with a mass of {mu:g}": float(spins_win_worst_case(mu)) for mu in MASSES}
    above = d["found"] / spins_worst_case(d["tried"]).value - 1
    return found | {
        "largest relative distance of a peak": np.abs(above).max(),
        "peak over √2/γ, most": (d["peak"] * d["gamma"]).max() / 2**0.5 - 1,
        "equal against opposite spins": np.abs(d["found"][0] / d["found"][1] - 1).max(),
        "peak shown, spins": d["spun"].max(),
        "peak shown, mass": d["tuned"].max(),
    }


_one, _two, _five, _above, _higher, _same, _spun, _tuned = measure().values()
CAPTION = (
    "Two discs of 1 kg under 50 kg each sway along the bar at 1 Hz. Brace and damper across the bar are optimal. With "
    f"γ = G/(aΩ) the peak (a) exceeds √2/γ by at most {100 * _higher:.1f} %. Spins are as good as a tuned mass of 1, 2 "
    "and 5 % at "
    f"γ = {_one:.3f}, {_two:.3f}, {_five:.3f}. The discs have 2 % of the mass, and γ = {_two:.3f} is a spin of "
    f"{_two * INERTIA * SWAY / ROTOR.I3:.0f} rad/s. The peaks found on structures agree with the curve within "
    f"{100 * _above:.3f} %, "
    f"for equal and for opposite spins. (b) With spins at γ = {SHOWN} the peak is {_spun:.2f}, with the tuned mass it is "
    f"{_tuned:.2f}."
)


# %%
def figure() -> Figure:
    """Peaks against γ; transfer functions."""
    d = data()
    picture = Figure(figsize=(8.6, 4.6))
    peaks, transfer = picture.subplots(1, 2)
    peaks.loglog(d["gamma"], d["peak"], color=CORRECTION_COLOUR, label="spins, optimal brace and damper")
    for values, mark, name in zip(d["found"], ("x", "o"), ("equal", "opposite"), strict=True):
        peaks.plot(d["tried"], values, mark, color=EXACT_COLOUR, mfc="none", label=f"structures, {name} spins")
    for mu, line in zip(MASSES, ("--", "-", ":"), strict=True):
        level = float(mass_worst_case(mu).value)
        peaks.plot(
            d["gamma"][[0, -1]], [level, level], line, color=CASE_COLOURS[2], label=f"tuned mass, {100 * mu:g} %"
        )
    peaks.set(xlabel="γ = G/(aΩ)", ylabel="largest |X K/F|", title="Largest response at any rate")
    peaks.set(yticks=(2, 5, 10, 20), yticklabels=("2", "5", "10", "20"))
    peaks.set(xticks=(0.05, 0.1, 0.2, 0.5, 1), xticklabels=("0.05", "0.1", "0.2", "0.5", "1"), xlim=d["gamma"][[0, -1]])
    peaks.minorticks_off()
    transfer.semilogy(d["rates"], d["bare"], color=CASE_COLOURS[1], ls="--", lw=1.2, label="sway alone")
    transfer.plot(d["rates"], d["tuned"], color=CASE_COLOURS[2])
    transfer.plot(d["rates"], d["spun"], color=CORRECTION_COLOUR, ls="-.", label=f"spins, γ = {SHOWN}")
    transfer.set(
        xlabel="rate of the force / Ω", ylabel="|X K/F|", title="Response to a periodic force", ylim=(0.5, 200)
    )
    legend_below(picture, 3)
    return picture
