"""The pair on one page: Lagrangian, constraint, A and B, precession rate and corrected trajectories, compared with a run.

The run is a paired precession, integrated by scipy, of the paper's pair (spins ±10 rad/s, a massless bar, ell = R = 1 m) or of
another one.
"""

from dataclasses import dataclass

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.models.orbits.precession import paired_scene, precession_orbit
from lagrotor.models.simulate import simulate
from lagrotor.pair.notation import ANSATZ, I3, PAIR, A, B, J, Phi, a, b, k, r0, sigma
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory, ansatz_A
from lagrotor.paper.plain_text import from_latex
from lagrotor.paper.rotor_pair.runs import PAPER_R0, paper_axes
from lagrotor.result_display import scientific
from lagrotor.theory.natural_frequency import pair_precession_rate
from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories


def pair_formulas() -> dict[str, sp.Expr]:
    """Return the formulas of the pair as they are written by hand: {left-hand side in LaTeX: right-hand side}.

    L and g are those of `pair_with_bar`, A and B those of `ansatz_integrals`, the rate that of `pair_precession_rate`. The
    components x_i, y_i of the axes are `corrected_trajectories` through the second power of the amplitude r_0.

    Returns
    -------
    dict of Expr
        L, g = 0, A, B, phi', x_1, y_1, x_2, y_2.
    """
    (theta_1, phi_1, _, theta_2, phi_2, _), (u_1, w_1, spin_1, u_2, w_2, spin_2) = PAIR.q, PAIR.v
    s_1, s_2, c_1, c_2 = sp.sin(theta_1), sp.sin(theta_2), sp.cos(theta_1), sp.cos(theta_2)
    apart, across = sp.cos(phi_1 - phi_2), sp.sin(phi_1 - phi_2)
    product = u_1 * u_2 * (s_1 * s_2 + c_1 * c_2 * apart) + w_1 * w_2 * s_1 * s_2 * apart
    product += (u_1 * w_2 * c_1 * s_2 - u_2 * w_1 * c_2 * s_1) * across
    tilting = a / 2 * (u_1**2 + w_1**2 * s_1**2 + u_2**2 + w_2**2 * s_2**2)
    spinning = I3 / 2 * ((spin_1 + w_1 * c_1) ** 2 + (spin_2 + w_2 * c_2) ** 2)
    constraint = k * (s_2 * sp.cos(phi_2) - s_1 * sp.cos(phi_1)) + 1 - c_1 * c_2 - s_1 * s_2 * apart
    (t_1, t_2, _, _), (_, _, w, spin) = ANSATZ.q, ANSATZ.v
    s_1, s_2, c_1, c_2 = sp.sin(t_1), sp.sin(t_2), sp.cos(t_1), sp.cos(t_2)
    integral_B = I3 * (2 * spin + w * (c_1 + c_2))
    integral_A = J * w * (s_1**2 + s_2**2) + I3 * (c_1 * (spin + w * c_1) + c_2 * (spin + w * c_2))
    rate = (2 * A - B * (c_1 + c_2)) / (2 * J * (s_1**2 + s_2**2) + I3 * (c_1 - c_2) ** 2)
    sine, cosine, width = sp.sin(Phi), sp.cos(Phi), sp.sqrt(sigma)
    shift = r0**2 * sigma / k * sine**2
    swing = width * r0**2 / (2 * k) * sine * cosine
    return {
        r"\mathcal L": tilting + b * product + spinning,
        "g": constraint,
        "A": integral_A,
        "B": integral_B,
        r"\dot\phi": rate,
        "x_1": r0 * cosine + shift,
        "y_1": width * r0 * sine - swing,
        "x_2": r0 * cosine - shift,
        "y_2": -width * r0 * sine - swing,
    }


@dataclass(frozen=True)
class PairComparison:
    """The formulas compared with the run over one turn of the paired precession.

    Attributes
    ----------
    run : Trajectory
        The run; `run.error` is its estimated error.
    series : float
        The largest distance of a tip by the corrected series of order 3 from the run, in m.
    amplitude : float
        The sine of the inclination when the axes are parallel.
    printed_x : float
        The largest difference of the paper's x (5.22) from the run, in m.
    rate_error : float
        The largest relative difference of the formula (5.15), with A and B of the start, from the rate of the run.
    rate_mean : float
    run_mean : float
        The mean over one turn of the formula, and of the rate of the run, in rad/s.
    """

    run: Trajectory
    amplitude: float
    series: float
    printed_x: float
    rate_error: float
    rate_mean: float
    run_mean: float


def compare_pair(amplitude: float = PAPER_R0, scene: Scene | None = None, tol: float = 1e-11) -> PairComparison:
    """Compare the corrected series, the paper's x and the formula of the rate with the integrated paired precession.

    Parameters
    ----------
    amplitude : float, default 0.204
        The sine of the inclination when the axes are parallel.
    scene : Scene, default Scene((10, -10))
        The pair, with opposite spins and a bar. The run starts on its paired precession, whatever its axes and rates are.
    tol : float, default 1e-11
        The tolerance of the run.

    Returns
    -------
    PairComparison
        The run and the differences.

    Raises
    ------
    InputError
        If the spins are not opposite, or if the scene has no bar or has a shock.
    """
    scene = scene or Scene((10.0, -10.0))
    if scene.shock is not None:
        raise InputError("pair: the scene has a shock, but the formulas are those of free motion: remove the shock")
    phase = np.linspace(0, 2 * np.pi, 361)
    run = simulate(paired_scene(scene, amplitude), phase / precession_orbit(scene, amplitude).frequency, "minimal", tol)
    series = np.array(corrected_trajectories(3)(amplitude, phase, scene.sigma, scene.k)).reshape(2, 3, -1)
    series = series.swapaxes(1, 2)
    theta_1, theta_2 = run.inclinations
    start = ansatz_A(run)[0], run.momenta[0, 0] - run.momenta[1, 0]
    formula = np.asarray(pair_precession_rate()(theta_1, theta_2, *start, scene.rotor.J, scene.rotor.I3))
    (x, y, _), (x_rate, y_rate, _) = np.moveaxis(run.axes, -1, 0), np.moveaxis(run.rates, -1, 0)
    azimuth_rate = (x * y_rate - y * x_rate) / (x**2 + y**2)
    rate = (azimuth_rate[0] - azimuth_rate[1]) / 2
    return PairComparison(
        run=run,
        amplitude=amplitude,
        series=float(np.linalg.norm(series - run.axes, axis=-1).max()) * scene.rotor.length,
        printed_x=float(abs(paper_axes(amplitude, phase) - run.axes)[..., 0].max()) * scene.rotor.length,
        rate_error=float(abs(formula / rate - 1).max()),
        rate_mean=float(formula[:-1].mean()),
        run_mean=float(rate[:-1].mean()),
    )


# Letter on the page, heading, the left-hand sides of its formulas.
_PARTS = (
    ("a", "Lagrangian of the two rotors and the bar, in the Euler angles of each axis", (r"\mathcal L",)),
    ("b", "constraint of the bar, g = 0, with k = ell/R", ("g",)),
    ("c", "conserved quantities of the ansatz φ₁′ = −φ₂′ = φ′, ψ₁′ = −ψ₂′ = ψ′ without a bar", ("A", "B")),
    ("d", "precession rate from A and B, which depend on the rate at the start", (r"\dot\phi",)),
    ("e", "corrected axes through r₀², at the phase Φ = Ωt", ("x_1", "y_1", "x_2", "y_2")),
)


_LETTERS = (  # the meanings of the letters on the page
    "I₃, J: inertia of a rotor about its axis, and transverse inertia about the ground joint, kg m²",
    "m, K, ell: mass, transverse inertia and length of the bar; R: length of an axis, from joint to tip; k = ell/R",
    "a = J + m R²/4 + K R²/ell², b = m R²/4 − K R²/ell², σ = (a + b)/(a − b); a massless bar has b = 0 and σ = 1",
    "r₀: the amplitude, the sine of the inclination when the axes are parallel",
    "Ω: the frequency, rad/s; for small r₀ and spins ±ω it is I₃ ω/√(a² − b²)",
)


def comparison_rows(comparison: PairComparison) -> list[tuple[str, str]]:
    """Return the compared quantities, each with its largest difference from the run, as text."""
    c, scene = comparison, comparison.run.scene
    no_bar = "" if scene.inertias == (scene.rotor.J, 0) else ", which takes no inertia of a bar,"
    return [
        ("estimated error of the run", scientific(c.run.error, 1)),
        ("corrected series of order 3", f"within {c.series:.4f} m"),
        ("the paper's x (5.22)", f"within {c.printed_x:.3f} m"),
        (
            f"the paper's rate (5.15){no_bar} with A and B of the start",
            f"within {100 * c.rate_error:.2f} %; its mean is {c.rate_mean:.3f} rad/s, that of the run {c.run_mean:.3f} rad/s",
        ),
    ]


def pair_page(comparison: PairComparison) -> list[tuple[str, list[str]]]:
    """Return the page as text: headings (a) to (f), each with its lines, and the meanings of the letters."""
    formulas, c = pair_formulas(), comparison
    page = [
        (f"({part}) {heading}", [from_latex(f"{name} = {latex(formulas[name])}") for name in names])
        for part, heading, names in _PARTS
    ]
    scene, rotor, link = c.run.scene, c.run.scene.rotor, c.run.scene.link
    assert link
    bar = f"a bar of {link.mass:g} kg and {link.inertia:g} kg m²" if link.mass or link.inertia else "a massless bar"
    page.append(
        (
            f"(f) comparison with the scipy model {c.run.model}: one turn of {c.run.t[-1]:.4f} s, spins {scene.spins[0]:g} and "
            f"{scene.spins[1]:g} rad/s, {bar}, ell = {link.length:g} m, R = {rotor.length:g} m, J = {rotor.J:g} kg m², "
            f"I₃ = {rotor.I3:g} kg m², r₀ = {c.amplitude:g}",
            [f"{quantity}: {difference}" for quantity, difference in comparison_rows(c)],
        )
    )
    return [*page, ("letters", list(_LETTERS))]
