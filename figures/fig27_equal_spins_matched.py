# %% [markdown]
# # Figure 27: equal spins against the rate 11.4
#
# The run of figure 26: x of the tip against the paper's 11.4 and the closed form $80/7\,/\cos\theta$ (5.24), and the
# spectrum from which the rate is read.

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.models.spring_run import paper_system, run_steps
from lagrotor.report.style import CORRECTED, EXACT, MODEL, PAPER
from lagrotor.rotors.closed_forms import free_precession_rate
from lagrotor.study.rates import peak, spectrum

TOL, PRINTED, HALF, SHOWN = 1e-10, 11.4, 0.5, (1.5, 10)
STIFFNESS, DAMPING, STEP = 1e4, 250.0, 1e-3
SCENE = Scene(spins=(20, 20), link=Link(mass=1, inertia=1), shock=Shock(force=(40, 0, 0), at=2.0, width=1 / 20, body=1))

TITLE = "Equal spins 20, matched to a rate"
ALT = (
    "Four panels. The force is a narrow peak of 40 N at 2 s. x of the tip oscillates after it with amplitude 0.08 m. "
    "The sine at 11.4 rad/s and the stiff springs fall a little behind, with residuals growing to 0.04 and 0.06 m; "
    "the sine at the closed form's rate stays on the curve. In the spectrum the exact peak is at 11.5 rad/s, just "
    "above the mark at 11.4, that of the springs just below it."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), force (N), x of tip 1 from its start (m) by both models and both sines, spectra after the shock."""
    t = np.linspace(0, 10, 2001)
    exact = simulate(SCENE, t, "minimal", TOL).tips[0, :, 0] + HALF
    springs = run_steps(paper_system(SCENE, STIFFNESS, DAMPING), SCENE.shock, t, STEP).tips[0, :, 0] + HALF
    after, s = t > 2.3, t - 2
    size = np.ptp(exact[after]) / 2
    rate = float(free_precession_rate()(np.arcsin(size), SCENE.momenta[0], sum(SCENE.inertias)))
    rates, exact_amplitude = spectrum(t[after], exact[after])
    _, springs_amplitude = spectrum(t[after], springs[after])
    return {
        "t": t,
        "force": 40 * np.exp(-((20 * s) ** 2)),
        "exact": exact,
        "springs": springs,
        "printed": np.where(s > 0, size * np.sin(PRINTED * s), 0),
        "corrected": np.where(s > 0, size * np.sin(rate * s), 0),
        "rate": rates,
        "exact_amplitude": exact_amplitude,
        "springs_amplitude": springs_amplitude,
        "closed_form_rate": np.array([rate]),
    }


# %%
def measure() -> dict[str, float]:
    """Amplitude (m), rates read off the spectra and of the closed form (rad/s), largest residuals (m)."""
    d = data()
    after = d["t"] > 2.3
    return {
        "amplitude (m)": np.ptp(d["exact"][after]) / 2,
        "rate, exact model (rad/s)": peak(d["rate"], d["exact_amplitude"]),
        "rate, spring model (rad/s)": peak(d["rate"], d["springs_amplitude"]),
        "rate, closed form (rad/s)": d["closed_form_rate"][0],
        "printed rate, largest residual (m)": np.abs(d["printed"] - d["exact"])[after].max(),
        "closed form, largest residual (m)": np.abs(d["corrected"] - d["exact"])[after].max(),
    }


_m = measure()
CAPTION = (
    f"Spins 20 and 20 rad/s, bar 1 m, 1 kg, 1 kg m², shock as in figure 25. Exact: minimal model, tolerance {TOL:g}; "
    f"paper's method: springs S = {STIFFNESS:g} N/m, D = {DAMPING:g} kg/s (as in figure 25), step {STEP:g} s. Rate "
    f"read off the spectrum (Hann window, 2.3 s to 10 s): exact {_m['rate, exact model (rad/s)']:.3f}, paper's method "
    f"{_m['rate, spring model (rad/s)']:.3f}, closed form (80/7)/cos theta = {_m['rate, closed form (rad/s)']:.3f}, "
    f"printed {PRINTED:g} rad/s. Largest residual: printed rate {_m['printed rate, largest residual (m)']:.3f} m, "
    f"closed form {_m['closed form, largest residual (m)']:.1e} m."
)


# %%
def figure() -> Figure:
    """Force, x of the tip, residual, spectrum."""
    d = data()
    picture = Figure(figsize=(7.0, 8.4))
    force, x, residual, heights = picture.subplots(4, 1, height_ratios=(0.8, 1.7, 1.2, 1.4))
    force.plot(d["t"], d["force"], color=EXACT)
    force.set(ylabel="force [N]", title="Force on tip 1 along x")
    x.plot(d["t"], d["exact"], color=EXACT, label="exact model")
    x.plot(d["t"], d["springs"], color=MODEL, lw=1.2, label="paper's method, stiff springs")
    x.plot(d["t"], d["printed"], color=PAPER, ls="--", lw=1.2, label="sin 11.4(t − 2), scaled")
    x.plot(d["t"], d["corrected"], color=CORRECTED, ls=":", lw=2, label="sine at the closed form's rate")
    x.set(ylabel="$x - x(0)$ [m]", title="x of tip 1")
    residual.plot(d["t"], d["printed"] - d["exact"], color=PAPER)
    residual.plot(d["t"], d["springs"] - d["exact"], color=MODEL, lw=1.2)
    residual.plot(d["t"], d["corrected"] - d["exact"], color=CORRECTED)
    residual.set(xlabel="time [s]", ylabel="residual [m]", title="Residual against the exact model")
    for panel in (force, x, residual):
        panel.set_xlim(SHOWN)
    for panel in (force, x):
        panel.tick_params(labelbottom=False)
    heights.plot(d["rate"], d["exact_amplitude"], color=EXACT)
    heights.plot(d["rate"], d["springs_amplitude"], color=MODEL, lw=1.2)
    heights.axvline(PRINTED, color=PAPER, ls="--", lw=1.2)
    heights.axvline(d["closed_form_rate"][0], color=CORRECTED, ls=":", lw=2)
    heights.set(xlabel="rate [rad/s]", ylabel="amplitude [m]", title="Spectrum of x after the shock")
    heights.set(xlim=(PRINTED - 5, PRINTED + 5), ylim=(0, None))
    picture.suptitle(TITLE)
    picture.legend(loc="outside lower center", ncols=2)
    return picture
