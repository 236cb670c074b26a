"""Small displacements: Floquet multipliers of a periodic motion, the Lyapunov exponent of a motion.

For s' = f(s, t) of period T, δs(T) = Φ δs(0) with Φ' = (∂f/∂s) Φ and Φ(0) = 1. Under constraints, displacements lie in their
tangent space (see `state_space`). The Floquet multipliers are the eigenvalues of Φ; displacements grow if the modulus of one
exceeds 1. If the time does not enter explicitly, one multiplier is 1, and belongs to a shift along the orbit. Nayfeh & Mook,
Nonlinear Oscillations, 5.2. Rounding of Φ hides multipliers below 10⁻¹² of the largest. The period is then cut into pieces, and
the periodic Schur form of their matrices resolves each multiplier (Bojanczyk, Golub & Van Dooren 1992). The Lyapunov exponent
is computed from the motion linearised along a run (Benettin, Galgani, Giorgilli & Strelcyn 1980).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.flow import Array, Values, projection_of
from lagrotor.mechanics.running.initial_state import check_values
from lagrotor.mechanics.running.motion import SampledMotion
from lagrotor.mechanics.running.programs import motion_program, parameter_values, tangent_motion
from lagrotor.mechanics.running.scales import clock_windows
from lagrotor.mechanics.running.state_space import check_smooth, local_slope, motion_slope, point_state, tangent_space
from lagrotor.mechanics.steady_motions import small_states
from lagrotor.numerics.floquet_multipliers import multiplier_rows, product_eigenvalues, resolved_multipliers
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.pulse import windows_since
from lagrotor.result_display import Shown, scientific, text_of

_LOCAL = (1e-10, 1e-12)  # local errors of the two integrations that are compared
_CUTS = (1, 4, 32)  # pieces of the period, more where a multiplier is not resolved
_RESOLVED = 1e-3  # relative error below which a multiplier is resolved
_CLOSED = 1e-6  # relative distance between the ends of a closed orbit
_MOST = 2_000_000  # evaluations of an integration of Φ
MOST = 10_000_000  # evaluations for an exponent
_PIECES, _PARTS = 200, 10  # pieces of a run, after which the tangent is normalised; parts for the standard error
_TIGHTEST = 1e-9  # local error: an exponent has fewer digits


@dataclass(frozen=True, eq=False, repr=False)
class MonodromyMatrix(Shown):
    """The matrix Φ that maps small changes of the state to those one period later, and its eigenvalues, the Floquet multipliers.

    Attributes
    ----------
    states : tuple of Symbol
        The n independent states.
    matrix : Array
        Φ, shape (n, n).
    error : float
        Largest difference between two integrations of Φ, relative to its largest element (at least 1).
    multipliers : NDArray[complex128]
        The eigenvalues of Φ, the largest modulus first, shape (n,). One that is smaller than its error is NaN.
    errors : Array
        Absolute error of each multiplier, shape (n,). For a NaN it is an upper bound of the modulus.

    Examples
    --------
    >>> from sympy import pi
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x")
    >>> orbit = System(c, (c.v[0]**2 - c.q[0]**2) / 2).floquet({c.q[0]: 1}, {}, pi)
    >>> orbit.multipliers.real.round(6)
    array([-1., -1.])
    """

    states: tuple[sp.Symbol, ...]
    matrix: Array
    error: float
    multipliers: NDArray[np.complex128]
    errors: Array

    def summary(self) -> dict[str, str]:
        """Summarise the states, the error of Φ and the multipliers in words.

        Returns
        -------
        dict
            Words, by the name of the row.
        """
        head = {"states": text_of(self.states), "error of the matrix": scientific(self.error, 1)}
        return head | multiplier_rows(self.multipliers, self.errors)


def monodromy_matrix(system: Equations, at: Mapping[Any, Any], values: Values, period: float) -> MonodromyMatrix:
    duration = _number(period)
    if not 0 < duration < np.inf:
        raise InputError(f"floquet: period = {period!r} must be a positive time in s")
    check_values("floquet", system, values)
    given_time = {str(s): x for s, x in at.items()}.get(str(t), 0) if isinstance(at, Mapping) else 0
    begin = _number(given_time)
    if not np.isfinite(begin):
        raise InputError(f"floquet: t = {given_time!r} must be a time in s")
    place = {s: x for s, x in at.items() if str(s) != str(t)} if isinstance(at, Mapping) else at
    system, state = point_state("floquet", system, place, values, begin)
    program = motion_program(system)
    n, d, size = len(system.c.q), len(program.states), len(system.variables)
    free, T = tangent_space("floquet", system, values, state, begin)
    start = np.append(state, [begin] * (d - size))
    slope, width = motion_slope("floquet", program, values), T.shape[1]
    check_smooth("floquet", slope, start, [f"the rate of {s}" for s in system.variables], at)
    first, P, _ = local_slope(system, state, *_at(slope(start), size))
    largest = max(1.0, float(np.abs(start).max()))

    def rate(_: float, y: Array) -> list[float]:
        f, J, _inputs = slope(y[:d])
        spread = J[:size, :size] @ y[d:].reshape(size, width)
        return [*f.tolist(), *spread.ravel().tolist()]

    windows = windows_since(begin, clock_windows(system, values, begin + np.array([0.0, duration])))

    def factors(pieces: int, local: float) -> list[Array]:
        """Return matrices whose product is Φ, the first acting first.

        The first changes to an orthonormal basis, one follows for each of `pieces` parts of the period, and the last
        changes back.
        """
        (basis, upper), y = np.linalg.qr(P @ T), start
        triangles = [upper]
        for a, b in pairwise(np.linspace(0, duration, pieces + 1)):
            problem = Problem(rate, np.concatenate([y, basis.ravel()]), _MOST, windows=windows, begin=a)
            y, spread = np.split(integrate(problem, np.array([b]), local).end, [d])
            basis, upper = np.linalg.qr(spread.reshape(size, width))
            triangles.append(upper)
        last, _, inverse = local_slope(system, y[:size], *_at(slope(y), size))
        opened = np.abs(y - start)[n:size].max() / largest
        changed = np.abs(last - first).max() / max(1.0, float(np.abs(first).max()))
        if local == _LOCAL[1] and not max(opened, changed) < _CLOSED:
            raise InputError(
                f"floquet: after {duration:g} s the motion has not come back: its velocities are off by {opened:.2g} of their "
                f"size and its coefficients by {changed:.2g}; give a start on the orbit and its period"
            )
        return [*triangles, (inverse @ basis)[free]]

    for pieces in _CUTS:
        coarse, fine = (factors(pieces, local) for local in _LOCAL)
        (others, _), (roots, least) = (product_eigenvalues(*pair) for pair in zip((coarse, fine), _LOCAL, strict=True))
        apart = np.abs(np.subtract.outer(roots, others)).min(1)
        errors = np.maximum(apart + least, np.finfo(float).tiny)
        if (errors < _RESOLVED * np.abs(roots)).all():
            break
    looser, finer = (reduce(lambda product, factor: factor @ product, triangles) for triangles in (coarse, fine))
    error = float(np.abs(looser - finer).max() / max(1.0, float(np.abs(finer).max())))
    states = tuple(s for s, independent in zip(small_states(system), free, strict=True) if independent)
    return MonodromyMatrix(states, finer, error, *resolved_multipliers(roots, errors))


def _at(slope: tuple[Array, Array, Array], size: int) -> tuple[Array, Array]:
    return slope[0][:size], slope[1][:size, :size]


def _number(value: Any) -> float:
    """Convert an object to a float; return NaN if it is not a number."""
    try:
        return np.nan if isinstance(value, str | bool) else float(value)
    except (TypeError, ValueError):
        return np.nan


@dataclass(frozen=True, eq=False, repr=False)
class Lyapunov(Shown):
    """The largest Lyapunov exponent of a run, the mean growth rate of the distance of neighbouring motions.

    Attributes
    ----------
    exponent : float
        The exponent in 1/s.
    error : float
        Its standard error in 1/s, from ten parts of the run.
    t : Array
        Times in s after the start of the run, shape (m,).
    history : Array
        The mean growth rate in 1/s from the start up to each time, shape (m,).
    """

    exponent: float
    error: float
    t: Array
    history: Array

    def summary(self) -> dict[str, str]:
        return {
            "largest exponent [1/s]": f"{self.exponent:.4g} ± {self.error:.1g}",
            "over": f"{self.t[-1] - self.t[0]:g} s" if len(self.t) else "no time",
        }


def lyapunov_exponent(run: SampledMotion) -> Lyapunov:
    """Compute the largest Lyapunov exponent for `SystemRun.lyapunov`."""
    if len(run.t) < 2:
        raise InputError("lyapunov: a run of one sample has no duration: simulate to a later time")
    if not run.switched.smooth:
        raise InputError(
            "lyapunov: the motion has events or forces that jump, and its linearised motion, which jumps too, is not "
            "computed: use forces without jumps"
        )
    program, n = tangent_motion(motion_program(run.system)), len(run.system.variables)
    parameters, d = parameter_values(program, run.values), len(program.states) // 2
    project = projection_of(run.system, run.values) if run.system.multipliers else None
    grid = np.linspace(run.t[0], run.t[-1], _PIECES + 1)
    y = np.append(run.states[0, :n], [run.t[0]] * (d - n))
    tangent = np.append(np.random.default_rng(1).normal(size=n), [0.0] * (d - n))  # time is not displaced
    growth = np.zeros(_PIECES)
    for i, h in enumerate(np.diff(grid)):
        tangent = tangent / np.linalg.norm(tangent)
        begin = float(grid[i])
        problem = Problem(
            program.rate(parameters, begin),
            np.concatenate([y, tangent]),
            MOST // _PIECES,
            windows=windows_since(begin, run.scales.windows),
        )
        end = integrate(problem, np.array([h]), max(run.tol, _TIGHTEST)).states[-1]
        y, tangent = end[:d] if project is None else project(end[:d]), end[d:]
        growth[i] = np.log(np.linalg.norm(tangent))
    duration = grid[1:] - grid[0]
    means = growth.reshape(_PARTS, -1).sum(1) * _PARTS / duration[-1]
    history = np.cumsum(growth) / duration
    return Lyapunov(float(history[-1]), float(means.std(ddof=1) / np.sqrt(_PARTS)), grid[1:], history)
