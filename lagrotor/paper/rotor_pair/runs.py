"""Simulations that several claims and figures share, and the numbers computed from them.

There are three kinds of simulation. The pair after a shock is simulated exactly and by the paper's program (figures 7, 9 to 13
and 25 to 28). The paired precession of a given amplitude is simulated over one period. The paired precession by the ansatz, by
the paper's correction and by the series is compared with the exact orbit.
"""

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.models.orbits.shooting import ExactOrbit, exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.run import SpringRun, run_steps
from lagrotor.models.spring_link.system import paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import best_harmonics, peak, spectrum
from lagrotor.numerics.pulse import PULSE_REACH
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, LIGHT, STEP, STIFFNESS
from lagrotor.pair.initial_conditions import consistent_scene
from lagrotor.pair.quantities import Spins, Vector
from lagrotor.pair.scene import Link, Scene, Shock
from lagrotor.pair.trajectory import Trajectory, ansatz_A
from lagrotor.theory.natural_frequency import free_precession_rate
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories

# s. The paper's shocks have their peak at 2 s. They end before the first time, at which energies are read; the wider shocks of
# section 5 end before the second, at which spectra begin.
ENERGY_FROM, SPECTRUM_FROM = 2.2, 2.3
PAPER_RUN = 8.0  # s that the paper's runs last after the shock
OPPOSITE, EQUAL = (10.0, -10.0), (10.0, 10.0)
MASSLESS, PAPER_BAR = Link(), LIGHT  # the bar of the theory, and that of the listing in 5.2.1
PAPER_R0 = 0.204  # the amplitude of figure 21
AMPLITUDES = (0.051, 0.102, PAPER_R0)


def shocked_scene(
    spins: tuple[float, float], force: Vector, bar: Link | None = HEAVY_LINK, width: float = 1 / 50
) -> Scene:
    """Return a scene of the pair at rest; rotor 1 gets a shock of this force (N) and width (s) at ten widths."""
    return Scene(spins, link=bar, shock=Shock(force, 10 * width, width))


def after_shock(scene: Scene, seconds: float, tol: float = 1e-9) -> Trajectory:
    """Simulate the exact pair and return the run from the end of the shock to `seconds` after its peak, 40 samples per s."""
    shock = shock_of(scene)
    first, last = shock.at + PULSE_REACH * shock.width, shock.at + seconds
    times = np.linspace(first, last, round(40 * seconds) + 1)
    return simulate(scene, [0.0, *times], "spheres", tol).after(first)


def listed_rates(spins: tuple[float, float]) -> str:
    """Return in words the natural frequencies of the pair with each of the two bars that the paper lists."""
    bars = {"the heavy bar of section 4.1": HEAVY_LINK, "the light bar of section 5.2.1": PAPER_BAR}
    return " and ".join(f"{natural_rate(Scene(spins, link=bar)):.3f} rad/s with {name}" for name, bar in bars.items())


def angle_between(axes: Array) -> Array:
    """Return the angle (n,) in rad between two axes (2, n, 3), computed so that small angles are accurate."""
    return 2 * np.arcsin(np.linalg.norm(axes[1] - axes[0], axis=-1) / 2)


def turned_about_joint_line(axes: Array) -> Array:
    """Return the angle (n,) in rad by which the axes (2, n, 3) have turned about the line through the joints, their mean."""
    angle: Array = np.unwrap(np.arctan2(-axes[..., 1], axes[..., 2])).mean(0)
    return angle


def paper_run(scene: Scene, t: Array) -> SpringRun:
    """Simulate a scene by the paper's program. The sample times t (n,) in s must be multiples of its step."""
    return run_steps(paper_system(scene, STIFFNESS, DAMPING), scene.shock, t, STEP)


def shock_of(scene: Scene) -> Shock:
    """Return the scene's shock; raise InputError if it has none."""
    if scene.shock is None:
        raise InputError(
            "the scene has no shock: give it one, as Scene(shock=Shock(force=(50, 0, 0), at=2, width=1 / 50))"
        )
    return scene.shock


def pulse(scene: Scene, t: Array) -> Array:
    """Return the magnitude (n,) in N of the shock's force at the times t (n,); raise InputError if the scene has no shock."""
    shock = shock_of(scene)
    return np.linalg.norm(shock.force) * np.exp(-(((t - shock.at) / shock.width) ** 2))


def centre_runs(t: Array, exact: Trajectory) -> dict[str, Array]:
    """Return energy (J), shock force (N) and centre of rotor 1 (m) at t (n,) in s, by the paper's program and exactly."""
    run = paper_run(exact.scene, t)
    return {
        "t": t,
        "energy": run.paper_energy,
        "exact_energy": exact.energy,
        "force": pulse(exact.scene, t),
        "centre": run.centres[0],
        "exact_centre": (exact.joints[0] + exact.tips[0]) / 2,
    }


def centre_numbers(runs: dict[str, Array]) -> dict[str, float]:
    """Return, from `centre_runs`, both energies after the shock (J) and the range of each coordinate of the centre (m)."""
    ranges = {f"{letter} of the centre, range (m)": np.ptp(runs["centre"][:, k]) for k, letter in enumerate("xyz")}
    return {
        "energy after the shock (J)": runs["energy"][runs["t"] >= ENERGY_FROM][0],
        "exact energy after the shock (J)": runs["exact_energy"][-1],
        **ranges,
    }


def centre_off(runs: dict[str, Array]) -> float:
    """Return the distance (m) of rotor 1's centre in the paper's program from the exact one, at the end of the exact run."""
    end = len(runs["exact_centre"]) - 1
    return float(np.linalg.norm(runs["centre"][end] - runs["exact_centre"][end]))


def rate_runs(exact: Trajectory, printed: float) -> dict[str, Array]:
    """Return x of tip 1 (m) over time and its spectrum, exactly and with the paper's springs.

    Also return two sines: one with the printed rate (rad/s), one with the closed-form rate.
    """
    scene, t = exact.scene, exact.t
    start, is_after, s = exact.joints[0, 0], t > SPECTRUM_FROM, t - shock_of(scene).at
    x = exact.tips[0, :, 0] - start
    springs = paper_run(scene, t).tips[0, :, 0] - start
    size = np.ptp(x[is_after]) / 2
    # Free precession (5.23, 5.24), G/(I cos theta), with the inertia I = a + b of both axes.
    rate = float(free_precession_rate()(np.arcsin(size), scene.momenta[0], sum(scene.inertias)))  # type: ignore[arg-type]
    rates, exact_amplitude = spectrum(t[is_after], x[is_after])
    return {
        "t": t,
        "force": pulse(scene, t),
        "exact": x,
        "springs": springs,
        "printed": np.where(s > 0, size * np.sin(printed * s), 0),
        "corrected": np.where(s > 0, size * np.sin(rate * s), 0),
        "rate": rates,
        "exact_amplitude": exact_amplitude,
        "springs_amplitude": spectrum(t[is_after], springs[is_after])[1],
        "closed_form_rate": np.array([rate]),
    }


def rate_numbers(runs: dict[str, Array]) -> dict[str, float]:
    """Return amplitude (m), rates (rad/s) and largest residuals (m) of the curves in `rate_runs`."""
    t, exact, springs, rate = runs["t"], runs["exact"], runs["springs"], runs["closed_form_rate"][0]
    is_after = t > SPECTRUM_FROM
    early = is_after & (t < SPECTRUM_FROM + 3)
    return {
        "amplitude (m)": np.ptp(exact[is_after]) / 2,
        "rate, exact model (rad/s)": peak(runs["rate"], runs["exact_amplitude"]),
        "rate, spring model (rad/s)": peak(runs["rate"], runs["springs_amplitude"]),
        "rate, spring model, first 3 s (rad/s)": best_harmonics(t[early], springs[early], rate).rate,
        "rate, closed form (rad/s)": runs["closed_form_rate"][0],
        "printed rate, largest residual (m)": np.abs(runs["printed"] - exact)[is_after].max(),
        "spring model, largest residual (m)": np.abs(springs - exact)[is_after].max(),
        "closed form, largest residual (m)": np.abs(runs["corrected"] - exact)[is_after].max(),
    }


@cache
def precession_scene(spins: Spins, r0: float, bar: Link) -> tuple[Scene, float]:
    """Return a scene that precesses with amplitude r0, and its rate (rad/s).

    Opposite spins give the exact paired precession, other spins a start with both axes on one cone.
    """
    scene = Scene(spins, link=bar)
    if spins[0] == -spins[1] != 0:
        orbit = exact_orbit(scene, r0)
        return orbit.scene, orbit.frequency
    upright = (1 - r0**2) ** 0.5
    rate = abs(scene.momenta[0]) / (sum(scene.inertias) * upright)
    start = [(0, np.sign(spin) * rate * r0, 0) for spin in spins]
    return consistent_scene(spins, ((r0, 0, upright),) * 2, start, link=bar), rate


@cache
def once_round(spins: Spins, r0: float, bar: Link) -> Trajectory:
    """Simulate one period of the precession with amplitude r0 and return 361 samples."""
    scene, rate = precession_scene(spins, r0, bar)
    return simulate(scene, np.linspace(0, 2 * np.pi / rate, 361), "minimal", 1e-11)


def deviations(run: Trajectory) -> tuple[float, float, float]:
    """Return three relative deviations of a run from the ansatz.

    They are the largest |φ₁′ + φ₂′| divided by the mean |φ′|, the largest |ψ₁′ + ψ₂′| divided by the spin, and the range of A
    divided by the difference of the mean A from its value at rest.
    """
    (x, y, z), (vx, vy, _) = np.moveaxis(run.axes, -1, 0), np.moveaxis(run.rates, -1, 0)
    phi = (x * vy - y * vx) / (x**2 + y**2)
    psi = run.momenta / run.scene.rotor.I3 - phi * z
    A, at_rest = ansatz_A(run), sum(abs(G) for G in run.scene.momenta)
    return (
        float(abs(phi[0] + phi[1]).max() / abs(phi).mean()),
        float(abs(psi[0] + psi[1]).max() / max(map(abs, run.scene.spins))),
        float(np.ptp(A) / abs(A.mean() - at_rest)),
    )


def ansatz_axes(sines: ArrayLike, phase: Array) -> Array:
    """Return the axes (2, n, 3) of the ansatz phi_1 = −phi_2 = phase (n,).

    `sines` (2,) or (2, n) are the sines of the inclinations.
    """
    size = np.broadcast_to(np.asarray(sines, dtype=float).reshape(2, -1), (2, len(phase)))
    azimuths = np.array([phase, -phase])
    return np.stack([size * np.cos(azimuths), size * np.sin(azimuths), np.sqrt(1 - size**2)], -1)


def paper_axes(r0: float, phase: Array) -> Array:
    """Return the axes (2, n, 3) that equation (5.20) of the paper gives.

    The sines of the inclinations are r_0 ∓ r_0² cos(phase).
    """
    change = r0**2 * np.cos(phase)
    return ansatz_axes(np.array([r0 - change, r0 + change]), phase)


def series_axes(order: int, r0: float, phase: Array) -> Array:
    """Return the axes (2, n, 3) by the corrected series through an order in r_0, for a massless bar and ell = R."""
    return np.array(corrected_trajectories(order)(r0, phase, 1, 1)).reshape(2, 3, -1).swapaxes(1, 2)


def against_orbit(orbit: ExactOrbit, phase: Array, curves: dict[str, Array], tol: float) -> dict[str, Array]:
    """Compare approximate axes with the exact orbit at the phases (n,). `curves` maps names to axes (2, n, 3).

    Return the tips (2, n, 3) in m of each curve and of the orbit, and the distances (n,) in m of each curve's tip 1 from the
    orbit's.
    """
    run = simulate(orbit.scene, phase / orbit.frequency, "minimal", tol)
    tips = {name: run.joints[:, None] + run.scene.rotor.length * axes for name, axes in curves.items()}
    away = {f"{name}_distance": np.linalg.norm(curve[0] - run.tips[0], axis=-1) for name, curve in tips.items()}
    return {"phase": phase, **tips, "exact": run.tips, **away}
