# %% [markdown]
# # Claims of section 5.2.1: the confirmation of the theory (C18, C19)
#
# **Objective.** The paper's comparison of its formula with the simulation, on exact runs.
#
# **Assumptions.** Opposite spins ±10, the bar of 5.2.1 ($m = 0.01$, $K = 0.1$). $r_0 = 0.204$ is the paper's amplitude
# (figure 21).

# %%
from math import pi

import numpy as np

from lagrotor import Link, Scene, Shock, natural_rate, simulate
from lagrotor.paper.claim_tests import ClaimTest, Finding

LIGHT, PAPER_R0 = Link(mass=0.01, inertia=0.1), 0.204

# %% [markdown]
# ## C18: pinched valleys and peaks
#
# The formula's second harmonic in $x_1$, over the first and in its phase, is $-r_0/2$, in $x_2$ it is $+r_0/2$: valleys of
# the left, peaks of the right are pinched. The same two numbers by least squares from the exact run, at the rate that
# fits best within a tenth of the natural one. Shared, as an eye can tell it: the right signs, and a size of the formula's
# order of magnitude, that is nearer to once than to ten times or a tenth of it.

# %%
SHOCK = Shock((40, -11, 0), 0.5, 1 / 20)
AFTER, PAPER_RUN = SHOCK.at + 6 * SHOCK.width, 8.0


def paper_run(spins, force=(40, -11, 0)):
    scene = Scene(spins, link=LIGHT, shock=Shock(force, SHOCK.at, SHOCK.width))
    return simulate(scene, np.linspace(AFTER, SHOCK.at + PAPER_RUN, 400), "spheres", 1e-9)


def harmonics(run):
    """Rate of best fit; centres (2, 2), first and second harmonics (2, 2) of x and y of both axes, complex."""
    s, tips = run.t - run.t[0], np.concatenate(list(run.axes[..., :2]), axis=1)

    def fit(rate):
        waves = [f(n * rate * s) for n in (1, 2) for f in (np.cos, np.sin)]
        table = np.column_stack([np.ones_like(s), s - s.mean(), *waves])
        parts = np.linalg.lstsq(table, tips, rcond=None)[0]
        return float(((table @ parts - tips)[:, ::2] ** 2).sum()), parts

    natural = natural_rate(run.scene) if any(run.scene.spins) else 1.0
    rates = natural * np.linspace(0.9, 1.1, 41)
    for _ in range(2):
        best = rates[np.argmin([fit(rate)[0] for rate in rates])]
        rates = best + (rates[1] - rates[0]) * np.linspace(-1, 1, 21)
    parts = fit(best)[1].reshape(6, 2, 2)
    return best, parts[0], parts[2] - 1j * parts[3], parts[4] - 1j * parts[5]


def measure_c18(spins):
    run = paper_run(spins)
    rate, _, first, second = harmonics(run)
    in_phase = (second / (first / abs(first)) ** 2).real / abs(first)
    toppled = [
        abs(np.unwrap(np.arctan2(-r.axes[..., 1], r.axes[..., 2])).mean(0)[-1])
        for r in (run, paper_run(spins, (40, 0, 0)))
    ]
    r0 = abs(first[:, 0]).mean()
    return {
        "amplitude_r0": r0,
        "rate_rad_per_s": rate,
        "second_over_first_x_1": in_phase[0, 0],
        "second_over_first_x_2": in_phase[1, 0],
        "second_over_first_formula": r0 / 2,
        "turned_about_joint_line_rad": toppled[0],
        "turned_about_joint_line_without_y_shock_rad": toppled[1],
    }


def decide_c18(m):
    formula = m["second_over_first_formula"]
    ratios = (-m["second_over_first_x_1"] / formula, m["second_over_first_x_2"] / formula)
    signs = min(ratios) > 0
    alike = signs and all(abs(np.log10(ratio)) < 0.5 for ratio in ratios)
    return Finding(
        "confirmed" if alike else "refuted",
        f"Second over first harmonic, in phase: {m['second_over_first_x_1']:+.4f} in x_1, "
        f"{m['second_over_first_x_2']:+.4f} in x_2; the formula has ∓{formula:.4f} at r_0 = {m['amplitude_r0']:.3f}: "
        f"the signs {'agree' if signs else 'do not agree'}, the sizes are {ratios[0]:.2f} and {ratios[1]:.2f} of the "
        f"formula's: {'of' if alike else 'not of'} its order of magnitude, which is all that two graphs side by side can "
        "show. The −11 along y is what keeps the pair up: it turns by "
        f"{m['turned_about_joint_line_rad']:.2f} rad in 8 s, without it by "
        f"{m['turned_about_joint_line_without_y_shock_rad']:.2f}.",
    )


Scene((10, -10), link=LIGHT, shock=SHOCK)

# %% [markdown]
# ## C19: the skew axis
#
# The line through the two tips' centres of precession; the tips' components along it; and the formula with amplitude,
# rate, phase and one common shift fitted, the centres' distance as printed (5.22) or as corrected ($x_1 + r_0^2$,
# $x_2 - r_0^2$). What is left is the root of the mean square over the amplitude; the same with the centres left free, which
# compares shapes only. Beside them stands what a plain sine leaves with its centres free, that is without the second
# harmonic, which is what the formula has to offer. Agree: the formula leaves less than the plain sine. As printed it need
# only do that; corrected it must also leave less than half of what the printed one does, or the correction is not the cause.
# What leaves as much as the motion itself has, the amplitude over the root of two, describes nothing.


# %%
def residual(along, t, rate, r0, offset, second=1):
    """RMS of what the formula leaves of both components (2, n), over the amplitude; the amplitude.

    offset None: centres free; second 0: without the second harmonic, a plain sine.
    """
    from scipy.optimize import least_squares

    def left(unknown):
        size, faster, phase, shift = unknown
        cosine = np.cos(rate * faster * (t - t[0]) + phase)
        off = np.array(
            [along[i] - size * cosine + sign * second * size**2 * cosine**2 for i, sign in ((0, 1), (1, -1))]
        )
        if offset is None:
            return (off - off.mean(1, keepdims=True)).ravel()
        return (off - shift - np.array([[-0.5 + offset * size**2], [0.5 - offset * size**2]])).ravel()

    found = min(
        (least_squares(left, (r0, 1.0, phase, 0.0)) for phase in (0, pi / 2, pi, -pi / 2)), key=lambda f: f.cost
    )
    size = abs(float(found.x[0]))
    return float(np.sqrt((found.fun**2).mean())) / size, size


def measure_c19(spins):
    run = paper_run(spins)
    rate, centres, first, _ = harmonics(run)
    tips = run.tips[..., :2]
    line = centres[1] - centres[0] + np.array([1.0, 0.0])
    skew = np.arctan2(line[1], line[0])
    along = tips @ (line / np.linalg.norm(line))
    r0 = abs(first[:, 0]).mean()
    shape, size = residual(along, run.t, rate, r0, None)
    return {
        "skew_deg": np.degrees(skew),
        "left_unprojected_printed": residual(tips[..., 0], run.t, rate, r0, 0)[0],
        "left_projected_printed": residual(along, run.t, rate, r0, 0)[0],
        "left_projected_corrected": residual(along, run.t, rate, r0, 1)[0],
        "left_unprojected_shape": residual(tips[..., 0], run.t, rate, r0, None)[0],
        "left_projected_shape": shape,
        "left_projected_plain_sine": residual(along, run.t, rate, r0, None, second=0)[0],
        "amplitude_along_the_skew_axis": size,
    }


def decide_c19(m):
    printed, corrected, plain = (m[f"left_projected_{k}"] for k in ("printed", "corrected", "plain_sine"))
    how = (
        f"The centres lie at {m['skew_deg']:+.1f}° to x, which the paper calls a small angle. The printed formula leaves "
        f"{m['left_unprojected_printed']:.1%} of the amplitude before and {printed:.1%} after projection on that axis, "
        f"with the missing ± r_0² {corrected:.1%}; with the centres free, hence for the shape, "
        f"{m['left_unprojected_shape']:.1%} before, {m['left_projected_shape']:.1%} after, where a plain sine leaves "
        f"{plain:.1%}: the second harmonic accounts for {1 - (m['left_projected_shape'] / plain) ** 2:.0%} of the square "
        f"of that. The amplitude along that axis is {m['amplitude_along_the_skew_axis']:.3f}; figure 21 has {PAPER_R0}."
    )
    motion = 0.5**0.5
    if printed < min(plain, motion):
        return Finding("confirmed", how)
    if corrected < min(plain, printed / 2, motion):
        return Finding(
            "confirmed-if",
            how,
            f"with the missing ± r_0² in the centres' places, to {corrected:.1%} of the amplitude (a plain sine: "
            f"{plain:.1%}; as printed {printed:.1%}); the skew is {m['skew_deg']:.1f}°, no small angle",
        )
    return Finding("refuted", how)


# %%
tests = [
    ClaimTest("C18", (10, -10), (10, 10), "exact pair (spheres), bar m = 0.01, K = 0.1", measure_c18, decide_c18),
    ClaimTest("C19", (10, -10), (10, 10), "exact pair (spheres), bar m = 0.01, K = 0.1", measure_c19, decide_c19),
]
tests
