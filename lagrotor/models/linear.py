"""Rung 2: normal modes. Small motion about the upright equilibrium at any time at once, for any spins and any bar.

The coordinates are those of `minimal`, q = (U, chi, alpha). The bar and the axes therefore keep their lengths, and the rotation
about the joint line, a symmetry, may be large. To first order M q'' + C q' = Q(t). With N = M⁻¹ C and A = [[0, 1], [0, −N]] on
(q, q'), A² (A² + Omega²) = 0, so that

    exp(A t) = 1 + A t + A² (1 − cos Omega t)/Omega² + A³ (Omega t − sin Omega t)/Omega³.

A pulse adds the response of `theory.shock_response`. `linear_error` estimates the error of the linearisation.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from math import exp, nan, pi

import numpy as np

from lagrotor.errors import DomainError, SingularError
from lagrotor.models.minimal import MODEL, rhs_on_arrays
from lagrotor.models.model import Array, ClosedMotion, Observed
from lagrotor.numerics.error_estimate import UNKNOWN
from lagrotor.numerics.solver_constants import Calibrated
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene, Shock
from lagrotor.theory.shock_response import pulse_response, shock_response

LINEAR_MARGIN = Calibrated(
    1.2,
    "safety factor on the linear model's error, known to two orders",
    "8,000 random scenes with an estimate up to 0.1: at most 1.05 times off",
    "test_linear.py::test_the_linear_error_is_bounded",
)
_FARTHEST = pi / 3  # the largest lean across the joint line, and twist (rad), of small motion
_SAFETY = 1.1  # for 500 shocks up to 0.4 of the spin's momentum and 3 swings the largest ratio is 1.02
_FARTHEST_OFF = 0.1  # the largest error that the next orders estimate
_FAR = 0.1  # rad about the joint line: a smaller rotation spreads no error
# Points of the quadrature: before, within and after a pulse each; per turn; at most.
_A_PART, _A_TURN, _MOST = 17, 24, 100_000


@dataclass(frozen=True, eq=False)
class LinearPair:
    """The linear motion of a pair about upright in q = (U, chi, alpha). `upright` is the matrix from small changes of q to x,
    y_1, y_2. `mass` is M, `turning` is N = M⁻¹ C, `frequency` is Omega."""

    upright: Array
    mass: Array
    turning: Array
    frequency: float

    def free(self, q: Array, v: Array, t: Array) -> Array:
        """Return the free motion exp(A t) (q, v) from the start (q, v) at times t (n,), (n, 6)."""
        Omega, t = self.frequency, t[:, None]
        once, twice = self.turning @ v, self.turning @ self.turning @ v
        if Omega == 0:
            return np.hstack([q + t * v, v + 0 * t])
        versed, sine = 2 * (np.sin(Omega * t / 2) / Omega) ** 2, np.sin(Omega * t) / Omega
        return np.hstack([q + t * v - versed * once + (t - sine) / Omega**2 * twice, v - sine * once + versed * twice])

    def answer(self, t: Array, push: Array) -> Array:
        """Return the response (n, 6) of (q, v) to accelerations `push` (n, 3) that act at the times t (n,). It is the integral
        of exp(A (t − s)) (0, push(s)) over s from the first time to t."""
        Omega, t, once, twice = self.frequency, t[:, None], self.turning.T, (self.turning @ self.turning).T
        received = _integral(t, push)
        drift = t * received - _integral(t, t * push)
        if Omega == 0:
            return np.hstack([drift, received])
        c, s = np.cos(Omega * t), np.sin(Omega * t)
        even, odd = _integral(t, c * push), _integral(t, s * push)
        versed, sine = (received - c * even - s * odd) / Omega**2, (s * even - c * odd) / Omega
        displacement = drift - versed @ once + (drift - sine) / Omega**2 @ twice
        return np.hstack([displacement, received - sine @ once + versed @ twice])


def _integral(t: Array, values: Array) -> Array:
    """Return the integral of the values (n, 3) over time from the first time to each time, by the trapezoidal rule, (n, 3)."""
    steps = np.diff(t, axis=0) * (values[1:] + values[:-1]) / 2
    return np.vstack([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])


@generated(((),))
def _matrices() -> str:
    """Return the source of a function (a, b, G_1, G_2) → 19 numbers: M and C in (x, y_1, y_2), then Omega."""
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.theory.impulse_response import impulse_matrices
    from lagrotor.theory.natural_frequency import natural_frequency

    matrices, frequency = impulse_matrices(), natural_frequency()
    outputs = (*matrices.mass, *matrices.gyroscopic, *frequency.expressions)
    return program_source(Program(frequency.arguments, (), outputs))


@generated(((),))
def _toppling_growth() -> str:
    from lagrotor.theory.toppling import toppling_growth

    return toppling_growth().code("numpy")


def pair_modes(scene: Scene) -> LinearPair:
    """Return the matrices of the linear motion about upright. Raises SingularError without a bar."""
    if scene.link is None:
        raise SingularError("linear: the scene has no bar; use model='closed_form' or 'spheres'")
    # sin Delta = k sin chi for a bar shorter than the axes; y_i = −alpha_i.
    twist = min(1.0, scene.link.length / scene.rotor.length) / 2
    upright = np.array([[1, 0, 0], [0, twist, -1], [0, -twist, -1]])
    numbers = _matrices()(*scene.inertias, *scene.momenta)
    mass, gyroscopic = (upright.T @ np.reshape(block, (3, 3)) @ upright for block in (numbers[:9], numbers[9:18]))
    return LinearPair(upright, mass, np.linalg.solve(mass, gyroscopic), float(numbers[18]))


def _linear_states(scene: Scene, t: Array) -> Array:
    """Return (U, chi, alpha and their rates) of the linear motion at t (n,), (n, 6). Raises DomainError if |U| or |chi| >
    pi/3."""
    linear, start = pair_modes(scene), MODEL.start(scene)
    states, shock = linear.free(start[:3], start[3:], t), scene.shock_until(float(t[-1]))
    if shock is not None:
        pulse, response = _pulsed(scene, linear, _straightened(linear, start, shock), np.append(t, 0.0))
        # The pulse may have begun before t = 0, and its earlier effect is part of the start.
        states += pulse - linear.free(response[:3], response[3:], t)
    tilts = np.abs(states[:, :2]).max(axis=1)
    if not tilts.max() <= _FARTHEST:
        where = int(np.argmax(~(tilts <= _FARTHEST)))
        raise DomainError(
            f"linear: at t = {t[where]:.4g} s the motion is {np.degrees(tilts[where]):.3g}° from rest, across the joint line "
            f"or in twist; above {np.degrees(_FARTHEST):.0f}° the linear model is meaningless: use model='minimal'"
        )
    return states


def _straightened(linear: LinearPair, start: Array, shock: Shock) -> Shock:
    """Return the shock with its force in the frame of the pair. Its azimuth equals the azimuth of the axis at the peak."""
    at = linear.free(start[:3], start[3:], np.array([max(shock.at, 0.0)]))[0]
    angle = -(linear.upright @ at[:3])[shock.body]
    fx, fy, fz = shock.force
    c, s = np.cos(angle), np.sin(angle)
    return replace(shock, force=(fx, c * fy + s * fz, c * fz - s * fy))


def _pulsed(scene: Scene, linear: LinearPair, shock: Shock, t: Array) -> tuple[Array, Array]:
    """Return the response of (q, v) to the pulse at all times but the last, (n, 6), and at the last time, (6,)."""
    from scipy.special import erfc

    response = pulse_response(scene, shock)
    q = np.linalg.solve(linear.upright, response.through(t).T).T
    received = erfc((shock.at - t) / shock.width)[:, None] / 2
    kick = np.linalg.solve(linear.mass, linear.upright.T @ response.impulse)
    states = np.hstack([q, received * kick - q @ linear.turning.T])
    return states[:-1], states[-1]


def linear_run(scene: Scene, t: Array) -> Observed:
    """Return the axes and rates of the linear motion at t (n,). Raises DomainError if |U| or |chi| exceeds pi/3."""
    return MODEL.observe(scene, _linear_states(scene, t))


def linear_motion(scene: Scene, t_end: float, tol: float, best: bool = False) -> ClosedMotion:
    """Return the linear motion with its error up to t_end (s). With `best` an error that cannot be estimated is NaN."""
    try:
        error = linear_error(scene, t_end)
    except DomainError:
        if not best:
            raise
        error = nan

    def motion(t: Array) -> tuple[Array, Array]:
        observed = linear_run(scene, t)
        return observed.axes, observed.rates

    return ClosedMotion(error, "small motion: normal modes", motion)


def linear_error(scene: Scene, t_end: float) -> float:
    """Return the largest error of an axis (tips: in units of R) of the linear motion up to t_end (s).

    Along the linear motion the exact equations have a residual of second order, and the linear response to it is the leading
    error. The residual of the corrected motion gives the next order, and the difference of both is added. After a large
    rotation about the joint line the coordinates mix, and an error may grow exponentially: see `_spread`. The sum is multiplied
    by LINEAR_MARGIN. The result is 2, the largest possible error, if it is not small. Raises the errors of `linear_run`, and
    DomainError for a run of too many turns.
    """
    linear, shock = pair_modes(scene), scene.shock_until(t_end)
    turns = linear.frequency * t_end / (2 * pi)
    if _A_TURN * turns > _MOST:
        raise DomainError(f"linear: {turns:.0f} turns are too many to estimate the error over; use model='minimal'")
    pulse = shock.at + shock.width * np.linspace(-4, 4, 65) if shock else np.empty(0)
    pulse = pulse[(pulse > 0) & (pulse < t_end)]
    ends = [0.0, *pulse[:1], *pulse[-1:], t_end]
    grids = (
        np.linspace(a, b, _A_PART + int(_A_TURN * linear.frequency * (b - a) / (2 * pi))) for a, b in pairwise(ends)
    )
    t = np.unique(np.concatenate([pulse, *grids]))
    states = _linear_states(scene, t)
    with np.errstate(all="ignore"):  # corrections of a large motion may diverge
        first = linear.answer(t, _defect(scene, linear, shock, t, states))
        second = linear.answer(t, _defect(scene, linear, shock, t, states + first))
        axes = [MODEL.observe(scene, states + correction).axes for correction in (second, 0.0, first)]
        leading, unsure = (float(np.linalg.norm(axes[0] - reference, axis=-1).max()) for reference in axes[1:])
    since = max(0.0, shock.at) if shock else 0.0
    error = LINEAR_MARGIN.value * (leading + unsure * _spread(scene, float(np.ptp(states[:, 2])), t_end - since))
    return error if error < _FARTHEST_OFF else UNKNOWN


def shock_response_error(scene: Scene, t_end: float) -> float:
    """Return the error of `shock_response(scene).through` for (x, y) of the axes, in units of R.

    The error is the distance of the response from the linear motion plus `linear_error` of this motion, times a safety factor.

    Parameters
    ----------
    scene : Scene
        The pair with its shock.
    t_end : float
        The end of the run, s.

    Returns
    -------
    float
        The error, of second order in the motion, at most 0.1.
    """
    response = shock_response(scene)
    t = np.linspace(0.0, t_end, 17 + int(_A_TURN * response.frequency * t_end / (2 * pi)))
    axes, predicted = linear_run(scene, t).axes, response.through(t)
    difference = np.stack([axes[i, :, :2] - predicted[:, [0, i + 1]] for i in (0, 1)])
    error = _SAFETY * (float(np.linalg.norm(difference, axis=-1).max()) + linear_error(scene, t_end))
    if not error <= _FARTHEST_OFF:
        raise DomainError(
            f"shock_response_error: the error at t = {t_end:g} s is about {error:.2g}, above {_FARTHEST_OFF:g}: the response is "
            "not small; take a smaller shock or a shorter time, or use model='minimal'"
        )
    return error


def _spread(scene: Scene, angle: float, duration: float) -> float:
    """Return the factor by which a rotation through `angle` (rad) about the joint line in `duration` (s) increases an error.

    The factor is (1 + angle/(2k)) exp(growth duration). The parenthesis comes from the coupling G U' = −(G nu/k) Delta to a
    uniform rotation at the rate nu. `growth` is the growth rate of a perturbation of a pair with opposite spins that rotates at
    this rate.
    """
    assert scene.link is not None
    if angle < _FAR or duration <= 0:
        return 1.0
    momentum = (abs(scene.momenta[0]) + abs(scene.momenta[1])) / 2
    ratio, rate = scene.link.length / scene.rotor.length, angle / duration
    growth = max(float(_toppling_growth()(nu, momentum or 1e-9, *scene.inertias, ratio)[0]) for nu in (rate, -rate))
    return (1 + angle / (2 * ratio)) * exp(min(growth * duration, 600.0))


def _defect(scene: Scene, linear: LinearPair, shock: Shock | None, t: Array, states: Array) -> Array:
    """Return the exact minus the linear accelerations of (U, chi, alpha) at the states (n, 6) and times t (n,), (n, 3)."""
    kind, values = MODEL.kind(replace(scene, shock=shock), True)
    force: list[Array] = []
    acceleration = -states[:, 3:] @ linear.turning.T
    if shock is not None:
        pulse = scene.rotor.length * np.exp(-(((t - shock.at) / shock.width) ** 2))
        force = [f * pulse for f in shock.force]
        straight = _straightened(linear, states[0], shock)
        push = np.zeros(3)
        push[0], push[shock.body] = straight.force[:2]
        acceleration = acceleration + pulse[:, None] * np.linalg.solve(linear.mass, linear.upright.T @ push)
    exact = rhs_on_arrays(*kind)(*values)(*states.T, *force)
    return np.stack(exact[3:], axis=1) - acceleration
