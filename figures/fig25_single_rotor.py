# %% [markdown]
# # Figure 25: a single rotor after a shock
#
# Spin 20, shock along x at the tip: the force, x of the tip against $\sin 16(t-2)$, and the spectrum from which the
# rate is read. Free, the rotor turns about its angular momentum at $G/(J\cos\theta)$ (5.23).

# %%
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor import Scene, Shock, simulate
from lagrotor.models.spring_run import paper_system, run_steps
from lagrotor.report.style import CORRECTED, EXACT, MODEL, PAPER
from lagrotor.rotors.closed_forms import free_precession_rate
from lagrotor.study.rates import peak, spectrum

TOL, PRINTED, HALF, SHOWN = 1e-10, 16.0, 0.5, (1.5, 10)
STIFFNESS, DAMPING, STEP = 1e4, 250.0, 1e-3
SCENE = Scene(spins=(20, 0), link=None, shock=Shock(force=(40, 0, 0), at=2.0, width=1 / 20, body=1))

TITLE = "Single rotor, spin 20, after a shock"
ALT = (
    "Four panels. The force is a narrow peak of 40 N at 2 s. x of the tip oscillates after it with amplitude 0.15 m. "
    "The sine at 16 rad/s starts in step and falls behind, so that its residual grows to 0.2 m; that of the stiff "
    "springs grows to 0.1 m; the sine at the closed form's rate stays on the curve. In the spectrum the exact peak is "
    "at 16.2 rad/s, a little above the mark at 16, and that of the springs between the two."
)


# %%
@cache
def data() -> dict[str, np.ndarray]:
    """Time (s), force (N), x of tip 1 from its start (m) by both models and both sines, spectra after the shock."""
    t = np.linspace(0, 10, 2001)
    exact = simulate(SCENE, t, "spheres", TOL).tips[0, :, 0] + HALF
    springs = run_steps(paper_system(SCENE, STIFFNESS, DAMPING), SCENE.shock, t, STEP).tips[0, :, 0] + HALF
    after, s = t > 2.3, t - 2
    size = np.ptp(exact[after]) / 2
    rate = float(free_precession_rate()(np.arcsin(size), SCENE.momenta[0], SCENE.rotor.J))
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
    "Spin 20 rad/s, no bar, shock 40 exp(−(20 (t − 2))²) N on the tip along x. Exact: spheres model, tolerance "
    f"{TOL:g}; paper's method: springs S = {STIFFNESS:g} N/m, D = {DAMPING:g} kg/s (n = 20, omega_s = 10 in the "
    f"paper's formulas: not printed; found by trying, as they give its 100.45 J after a shock), step {STEP:g} s. Sines "
    f"scaled to the amplitude {_m['amplitude (m)']:.4f} m. Rate read off the spectrum (Hann window, 2.3 s to 10 s): "
    f"exact {_m['rate, exact model (rad/s)']:.3f}, paper's method {_m['rate, spring model (rad/s)']:.3f}, closed form "
    f"16/cos theta = {_m['rate, closed form (rad/s)']:.3f}, printed {PRINTED:g} rad/s. Largest residual: printed rate "
    f"{_m['printed rate, largest residual (m)']:.3f} m, closed form {_m['closed form, largest residual (m)']:.4f} m."
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
    x.plot(d["t"], d["printed"], color=PAPER, ls="--", lw=1.2, label="sin 16(t − 2), scaled")
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
