# %% [markdown]
# # Figure n7: waves that have a size
#
# How the rate of waves round a ring shifts with the square of their amplitude, and three waves that feed each other, by the
# averaged Lagrangian and on exact runs.

# %%
from functools import cache
from math import pi

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

from lagrotor import Link
from lagrotor.drawing import CASE_COLOURS, CASE_DASHES, CORRECTION_COLOUR, EXACT_COLOUR, legend_below
from lagrotor.structures import polygon_ring, wave_amplitude

CORNERS, AMPLITUDE = 7, 0.05
RING = polygon_ring(CORNERS, spins=17.0, hinge=45.0, link=Link(mass=0.15, inertia=0.03))
HEXAGON = polygon_ring(
    6, spring=30.0, spins=6.0, hinge=13.170295680965312
)  # three and four turns of phase add up to one
PUMPED, SEED = 0.03, 0.003

TITLE = "Nonlinear waves: shift of the rate, and exchange of three waves"
ALT = (
    "Left: the shift of the rate divided by the square of the amplitude, as a function of the wave number. The curve is "
    "positive for waves of one to two turns and negative beyond; marks of exact runs lie on it. Right: the amplitudes of "
    "three waves as functions of time. The first falls while the two others rise from a tenth of it, and then they return. "
    "Exact runs lie on the curves."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """q (m,) in rad and shift (m,) in rad/s; turns (6,) in rad with the shifts said, at, and exact; times (n,) in s, seen and
    said (3, n): amplitudes of the three waves."""
    q = np.linspace(0.02, 2 * pi - 0.02, 240)
    shift = [RING.nonlinear_wave(x, 0).shift for x in q]
    exact = []
    for turns in range(1, CORNERS):
        wave = RING.nonlinear_wave(2 * pi * turns / CORNERS, 0)
        t = np.linspace(0, 30 * pi / wave.rate, 601)
        run = RING.piece(CORNERS).simulate(t, *wave.state(CORNERS, amplitude=AMPLITUDE), tol=1e-5)
        part, weight = wave_amplitude(RING, run, (CORNERS,), wave.q, 0), np.hanning(len(t) + 2)[1:-1]
        rate = -np.polyfit(t, np.unwrap(np.angle(part)), 1, w=weight)[0]
        exact.append((rate - wave.rate) / np.average(np.abs(part), weights=weight) ** 2)
    triad = min(HEXAGON.three_waves(pi), key=lambda w: abs(w.q[1, 0] - 4 * pi / 3))
    begin = np.array([SEED, 0, PUMPED])
    waves = [HEXAGON.nonlinear_wave(triad.q[k], triad.bands[k]) for k in range(3)]
    starts = [wave.state(6, amplitude=a) for wave, a in zip(waves, begin, strict=True) if a]
    times = np.linspace(0, 90, 901)
    run = HEXAGON.piece(6).simulate(times, *map(sum, zip(*starts, strict=True)), tol=1e-5)
    one, two, three = triad.strengths

    def slow(_: float, a: np.ndarray) -> np.ndarray:
        return 1j * np.array([one * a[2] * a[1].conj(), two * a[2] * a[0].conj(), three * a[0] * a[1]])

    said = solve_ivp(slow, (0, times[-1]), begin + 0j, t_eval=times, rtol=1e-9, atol=1e-12).y
    seen = [wave_amplitude(HEXAGON, run, (6,), q, band) for q, band in zip(triad.q, triad.bands, strict=True)]
    return {
        "q": q,
        "shift": np.array(shift),
        "turns": 2 * pi * np.arange(1, CORNERS) / CORNERS,
        "at": np.array([RING.nonlinear_wave(2 * pi * k / CORNERS, 0).shift for k in range(1, CORNERS)]),
        "exact": np.array(exact),
        "times": times,
        "seen": np.abs(seen),
        "said": np.abs(said),
    }


def measure() -> dict[str, float]:
    """Largest distance of exact shifts from the law, over the largest of them, and of amplitudes, over the pumped one."""
    d = data()
    return {
        "shift, largest distance": float(np.abs(d["exact"] - d["at"]).max() / np.abs(d["at"]).max()),
        "amplitudes, largest distance in the first exchange": float(
            np.abs(d["seen"] - d["said"])[:, d["times"] < 30].max() / PUMPED
        ),
        "least amplitude of the pumped wave": float(d["seen"][2].min() / PUMPED),
    }


_off, _apart, _least = measure().values()
CAPTION = (
    f"(a) A ring of {CORNERS} rotors with heavy bars on hinges. Exact runs of amplitude {AMPLITUDE:g} differ from "
    "the law by at "
    f"most {100 * _off:.1f} % of the largest shift. At the poles the second harmonic is itself a wave. The kink at 2π/{CORNERS} "
    "comes from the definition of the amplitude, which is the larger semi-axis of a tip's path: there the paths are "
    "circles. (b) "
    "A hexagon of springs, in which the rates of the waves of three and four turns of phase add up to the rate of the "
    "wave of one "
    f"turn. That wave starts with the amplitude {PUMPED:g} and the wave of three turns with {SEED:g}. The former decreases to "
    f"{_least:.2f} of its initial amplitude and returns. In 30 s the exact amplitudes differ by at most "
    f"{100 * _apart:.0f} % of the initial amplitude of that wave "
    "from the law of second order, which neglects the shifts of the rates."
)


# %%
def figure() -> Figure:
    """The shift against the wave number; the exchange of three waves."""
    d = data()
    picture = Figure(figsize=(8.6, 4.4))
    shifts, exchange = picture.subplots(1, 2)
    shifts.axhline(0, color="#999999", lw=0.6)
    shifts.plot(
        d["q"],
        np.where(np.abs(d["shift"]) < 12, d["shift"], np.nan),
        color=CORRECTION_COLOUR,
        label="averaged Lagrangian",
    )
    shifts.plot(d["turns"], d["exact"], "o", color=EXACT_COLOUR, mfc="none", label="exact motion")
    shifts.set(
        xlabel="wave number per rotor (rad)",
        ylabel="shift / amplitude² (rad/s)",
        title="Shift of the rate",
        xlim=(0, 2 * pi),
    )
    for k, (name, ink) in enumerate(zip(("three turns", "four turns", "one turn"), CASE_COLOURS, strict=False)):
        exchange.plot(d["times"], d["said"][k], color=ink, ls=CASE_DASHES[ink], label=f"law, {name}")
        exchange.plot(d["times"][::20], d["seen"][k][::20], "o", ms=3, color=EXACT_COLOUR, mfc="none")
    exchange.set(xlabel="time $t$ (s)", ylabel="amplitude", title="Amplitudes of three waves", xlim=(0, d["times"][-1]))
    legend_below(picture, 3)
    return picture
