# %% [markdown]
# # Figure 28: opposite spins in the second mode
#
# Spins ±10 with both bars that the paper lists: x of tip 1, its spectrum, and the phase drift of a sine at the paper's
# $10\cdot\frac45\cdot0.7125 = 5.7$ (5.26, printed 0.57) and at the natural rate $G/\sqrt{a^2-b^2}$.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, natural_rate, simulate
from lagrotor.drawing import CORRECTION_COLOUR, EXACT_COLOUR, MODEL_COLOUR, PAPER_COLOUR, legend_below
from lagrotor.numerics import peak, spectrum
from lagrotor.pair import HEAVY_LINK, LIGHT, SHOCK_PAIRED, STEP
from lagrotor.paper.rotor_pair.runs import paper_run

TOL, PRINTED = 1e-10, 10 * 4 / 5 * 0.7125
BARS = {"heavy": HEAVY_LINK, "light": LIGHT}
SCENES = {name: Scene(spins=(10, -10), link=bar, shock=SHOCK_PAIRED) for name, bar in BARS.items()}

SINE, NATURAL = f"sine at {PRINTED:g} rad/s", "sine at the natural rate"  # labels

TITLE = "Opposite spins ±10 in the second mode"
ALT = (
    "The panels show x of tip 1 from 1.5 s to 10 s for two bars, each with sines at 5.7 rad/s and at the natural rate. The "
    "sine at 5.7 rad/s loses phase within two periods: it is too fast for the heavy bar and too slow for the light one, "
    "with a phase drift of +7 and −10 rad. The sine at the natural rate stays in phase with both. The spectra peak near 4.2 "
    "rad/s for the heavy bar, in the exact model and by the paper's method, and at 7.4 rad/s for the light one, on both "
    "sides of the mark at 5.7."
)


# %%
def phase(t: np.ndarray, x: np.ndarray, rate: float) -> np.ndarray:
    """Phase of x at each of t (rad), turning with `rate`: unwrapped angle of its mean over one period around it."""
    wide = round(2 * np.pi / rate / (t[1] - t[0]))
    kernel = np.hanning(2 * wide + 1)
    wave = np.convolve((x - x.mean()) * np.exp(-1j * rate * t), kernel / kernel.sum(), mode="same")
    return np.unwrap(np.angle(wave)) + rate * t


@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), x of tip 1 (m), spectra; sines fitted in size, offset and phase over the first period; phase drifts."""
    t = np.linspace(0, 10, 2001)
    after = t > 2.3
    found = {"t": t}
    for name, scene in SCENES.items():
        natural = natural_rate(scene)
        x = simulate(scene, t, "minimal", TOL).tips[0, :, 0]
        found[f"{name}_x"], found[f"{name}_natural_rate"] = x, np.array([natural])
        found["rate"], found[f"{name}_amplitude"] = spectrum(t[after], x[after])
        early = after & (t < 2.3 + 2 * np.pi / natural)
        inside = (t > 2.3 + 2 * np.pi / natural) & (t < 10 - 2 * np.pi / natural)
        found[f"{name}_phase_t"] = t[inside]
        seen = phase(t[after], x[after], natural)[inside[after]]
        for label, rate in (("printed", PRINTED), ("natural", natural)):
            waves = np.column_stack([np.ones_like(t), np.cos(rate * t), np.sin(rate * t)])
            found[f"{name}_{label}"] = waves @ np.linalg.lstsq(waves[early], x[early], rcond=None)[0]
            drift = rate * t[inside] - seen
            found[f"{name}_{label}_drift"] = drift - drift[0]
    springs = paper_run(SCENES["heavy"], t).tips[0, :, 0]
    return {**found, "springs_x": springs, "springs_amplitude": spectrum(t[after], springs[after])[1]}


# %%
def measure() -> dict[str, float]:
    """Rates read off the spectra and natural rates (rad/s), phase drifts per second (rad/s)."""
    d = data()
    out = {"rate to match (rad/s)": PRINTED}
    for name in SCENES:
        span = np.ptp(d[f"{name}_phase_t"])
        out |= {
            f"{name} bar, rate (rad/s)": peak(d["rate"], d[f"{name}_amplitude"]),
            f"{name} bar, natural rate (rad/s)": d[f"{name}_natural_rate"][0],
            f"{name} bar, drift of 5.7 (rad/s)": d[f"{name}_printed_drift"][-1] / span,
            f"{name} bar, drift of the natural rate (rad/s)": d[f"{name}_natural_drift"][-1] / span,
        }
    return out | {"heavy bar, spring model, rate (rad/s)": peak(d["rate"], d["springs_amplitude"])}


_m = measure()
CAPTION = (
    "The spins are ±10 rad/s, and the shock is (40, −11, 0) N of 5.2.1 on tip 1, because the listing of 5.3 has no shock and no "
    "bar. Both bars are 1 m long; the heavy one (a) has 1 kg and 1 kg m² (4.1), the light one (b) 0.01 kg and 0.1 kg m² "
    "(5.2.1). The exact "
    f"curves are the minimal model at the tolerance {TOL:g}. The paper's method, for the heavy bar, has springs as in figure 25 "
    f"and a step of {STEP:g} s. From 2.3 s to 10 s the spectra (d) with a Hann window give {_m['heavy bar, rate (rad/s)']:.3f} "
    "rad/s for the "
    f"heavy bar (paper's method {_m['heavy bar, spring model, rate (rad/s)']:.3f}, natural rate "
    f"{_m['heavy bar, natural rate (rad/s)']:.3f}) and {_m['light bar, rate (rad/s)']:.3f} rad/s for the light bar (natural rate "
    f"{_m['light bar, natural rate (rad/s)']:.3f}). Neither is {PRINTED:g} rad/s, printed as 0.57. The sines have given rates; "
    "their offset, size and phase are fitted over the first period after 2.3 s; (c) is their phase minus that of x_1."
)


# %%
def figure() -> Figure:
    """x of tip 1 for each bar, phase drift, spectra."""
    d = data()
    picture = Figure(figsize=(7.0, 8.4))
    heavy, light, drift, heights = picture.subplots(4, 1, height_ratios=(1.3, 1.3, 1.1, 1.3))
    after = d["t"] > 2.3
    for panel, name, title in (
        (heavy, "heavy", "Heavy bar: 1 kg, 1 kg m²"),
        (light, "light", "Light bar: 0.01 kg, 0.1 kg m²"),
    ):
        panel.plot(d["t"], d[f"{name}_x"], color=EXACT_COLOUR, label="exact model")
        panel.plot(d["t"][after], d[f"{name}_printed"][after], color=PAPER_COLOUR, ls="--", lw=1.2, label=SINE)
        panel.plot(
            d["t"][after],
            d[f"{name}_natural"][after],
            color=CORRECTION_COLOUR,
            ls=":",
            lw=2,
            label=NATURAL,
        )
        panel.set(ylabel="$x_1$ (m)", title=title, xlim=(1.5, 10))
        panel.tick_params(labelbottom=False)
        line = "-" if name == "heavy" else "-."
        drift.plot(d[f"{name}_phase_t"], d[f"{name}_printed_drift"], color=PAPER_COLOUR, ls=line, label=SINE)
        drift.plot(d[f"{name}_phase_t"], d[f"{name}_natural_drift"], color=CORRECTION_COLOUR, ls=line, label=NATURAL)
        heights.plot(d["rate"], d[f"{name}_amplitude"], color=EXACT_COLOUR, ls=line)
        heights.axvline(d[f"{name}_natural_rate"][0], color=CORRECTION_COLOUR, ls=":", lw=2)
    heavy.plot(d["t"], d["springs_x"], color=MODEL_COLOUR, lw=1.2, label="paper's method (heavy bar)")
    heights.plot(d["rate"], d["springs_amplitude"], color=MODEL_COLOUR, lw=1.2)
    heights.axvline(PRINTED, color=PAPER_COLOUR, ls="--", lw=1.2)
    drift.set(xlabel="time $t$ (s)", ylabel="phase drift (rad)", xlim=(1.5, 10))
    drift.set_title("Phase of the sine minus that of $x_1$ (solid heavy, dash-dotted light bar)")
    heights.set(xlabel="rate (rad/s)", ylabel="amplitude (m)", xlim=(0, 12), ylim=(0, None))
    heights.set_title("Spectrum of $x_1$ after the shock (solid heavy, dash-dotted light bar)")
    legend_below(picture, 2)
    return picture
