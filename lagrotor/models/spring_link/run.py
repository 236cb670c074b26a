"""Running spring-linked bodies: the paper's fixed step, and a stiff solver beside it.

The step of a few bodies, or the rates of their state, is in single numbers: arrays cost more for so few operations.
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from math import exp, hypot, inf, isfinite, nan
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, IntegrationError
from lagrotor.models.simulate import check_times
from lagrotor.models.spring_link.paper_bodies import TIP
from lagrotor.models.spring_link.rigid_body import Array, finite_rotation, inertia_transform
from lagrotor.models.spring_link.system import RigidBodySystem, link_force, step_limit
from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.generated import function_of
from lagrotor.numerics.integrate import check_tolerance
from lagrotor.numerics.pulse import segments
from lagrotor.numerics.recorded_numbers import Recorded
from lagrotor.numerics.rotations import skew_matrix
from lagrotor.numerics.segment import LOST as OUT_OF_RANGE
from lagrotor.pair.scene import Shock

OfState = Callable[[Sequence[float], float], list[float]]  # of a state and the strength of a shock
_MOST = 12  # bodies beyond which arrays cost less
_STRAIGHT = link_force, finite_rotation, inertia_transform  # laws that branch on no value
LOST = 1e100  # a state of this norm has blown up; its energies are still finite


@dataclass(frozen=True, eq=False)
class SpringRun:
    """A run of n_b bodies, the first two the rotors, and n_l links, read at n times t (n,) in s.

    axes, rates, tips (2, n, 3): unit vectors from vertex 1 to 2 of each rotor, their rates (1/s), vertex 2 (m);
    centres (n_b, n, 3) in m, rotations (n_b, n, 3, 3); stretches |X_1 − X_2| (n_l, n) in m;
    momentum (n, 3) in kg m/s and angular_momentum (n, 3) in kg m²/s about the origin, of all bodies together;
    energies in J: translation M U²/2 and rotation Omega·L/2 (n_b, n), spring S |X_1 − X_2|²/2 (n_l, n);
    evaluations: how often the forces were computed.
    """

    t: Array
    axes: Array
    rates: Array
    tips: Array
    centres: Array
    rotations: Array
    stretches: Array
    momentum: Array
    angular_momentum: Array
    translation: Array
    rotation: Array
    spring: Array
    evaluations: int

    @property
    def paper_energy(self) -> Array:
        """What the paper records (4.02), the kinetic energy alone, (n,) in J: the springs' share is missing."""
        return self.translation.sum(0) + self.rotation.sum(0)

    @property
    def energy(self) -> Array:
        """Kinetic energy and that of the springs, (n,) in J: conserved without damping, shock and external force."""
        return self.paper_energy + self.spring.sum(0)


def run_steps(system: RigidBodySystem, shock: Shock | None, t: ArrayLike, dt: float) -> SpringRun:
    """Move a copy of `system` from t[0] by the paper's step and read it at the times `t` (n,), whole multiples of dt.

    The shock of step k has its strength at k dt, as in the paper's loop. `step_limit` says which dt is stable; one
    above it is run all the same, for as long as it lasts.

    Raises InputError for dt not above zero, times between the steps, or a step longer than the shock is wide (it could
    miss it); IntegrationError when the state is not a number, or beyond LOST.
    """
    times = check_times(t)
    if not (isinstance(dt, int | float) and isfinite(dt) and dt > 0):
        raise InputError(f"run_steps: dt = {dt!r} s must be a finite number above zero")
    counts = np.rint(times / dt).astype(int)
    if (abs(counts * dt - times) > 1e-6 * dt * np.maximum(abs(counts), 1)).any():
        raise InputError(f"run_steps: t holds times between the steps of dt = {dt:g} s: give whole multiples of dt")
    if shock is not None and dt > shock.width:
        raise InputError(
            f"run_steps: dt = {dt:g} s steps over a shock of width {shock.width:g} s; take dt well below it"
        )
    step, state, k, at = step_function(system, shock, dt), system.state.tolist(), counts[0], shock.at if shock else 0.0
    seen = []
    with np.errstate(over="ignore", invalid="ignore"):
        for count in counts:
            try:
                while k < count:
                    state = step(state, _strength(shock, k * dt - at))
                    k += 1
            except OUT_OF_RANGE:
                state = [nan]  # which arrays would hold here
            if not hypot(*state) < LOST:
                raise IntegrationError(
                    f"run_steps: the state is not a number, or beyond {LOST:g}, at t = {k * dt:.6g} s with dt = {dt:g} "
                    f"s; the longest stable step is {step_limit(system).whole:.4g} s at the start: take dt below it"
                )
            seen.append(state)
    return _read(system, times, np.array(seen), int(k - counts[0]))


def run_solver(
    system: RigidBodySystem, shock: Shock | None, t: ArrayLike, tol: float = 1e-8, method: str = "LSODA"
) -> SpringRun:
    """Move a copy of `system` from t[0] by one of scipy's solvers, the same forces without the error of a fixed step.

    State X, U, R, L of every body, with R' = [Omega]× R. tol: relative and absolute local error / 20. The run is cut at
    the shock's edges, ± 6.5 widths, within which no step is longer than the width. LSODA changes to a stiff
    method where damping requires it; "Radau" and "BDF" are stiff throughout, "DOP853" nowhere.

    Raises InputError for bad times, tolerance or method, IntegrationError when the solver cannot go on.
    """
    from scipy.integrate import solve_ivp

    times, error = check_times(t), check_tolerance(tol) / 20
    if method not in ("LSODA", "Radau", "BDF", "DOP853"):
        raise InputError(f"run_solver: method = {method!r} is not one of LSODA, Radau, BDF, DOP853")
    rate = rate_function(system, shock)
    at, width = (shock.at, shock.width) if shock else (0.0, 0.0)
    since_peak = times - at
    begin, end = float(since_peak[0]), float(since_peak[-1])
    y = system.state[: 18 * len(system.vertices)]
    states, evaluations = np.empty((len(times), len(y))), 0
    states[since_peak == begin] = y
    for left, right, pulsed in segments(begin, end, width):
        if right <= left:
            continue
        options: dict[str, Any] = {"max_step": width} if pulsed else {}
        inside = (since_peak > left) & (since_peak <= right)
        t_eval, acting = np.union1d(since_peak[inside], [right]), shock if pulsed else None
        found = solve_ivp(
            lambda s, y, acting: rate(y.tolist(), _strength(acting, s)), (left, right), y, method=method, args=(acting,),
            t_eval=t_eval, rtol=max(error, 2.3e-14), atol=error, **options,
        )  # fmt: skip
        if not found.success or not np.isfinite(found.y).all():
            raise IntegrationError(
                f"run_solver: {method} stopped between t = {at + left:.6g} and {at + right:.6g} s ({found.message}); "
                "lower S or D, or take a larger tol"
            )
        states[inside], y = found.y.T[: inside.sum()], found.y[:, -1]
        evaluations += found.nfev
    return _read(system, times, states, evaluations)


def step_function(system: RigidBodySystem, shock: Shock | None, dt: float) -> OfState:
    """`system.state` → the state dt later, by `compute_forces`, `push` and `step` of the system."""

    def after(moving: RigidBodySystem) -> Array:
        moving.step(dt)
        return moving.state

    return _recorded(system, shock, after, 21)


def rate_function(system: RigidBodySystem, shock: Shock | None) -> OfState:
    """The state y (18 n,) of X, U, L, R of n bodies → y', by `compute_forces` and `push` of the system."""

    def rates(moving: RigidBodySystem) -> Array:
        turning = skew_matrix(moving.Omega) @ moving.R
        changes = moving.U, moving.F * moving.inverse_mass, moving.tau, turning
        return np.concatenate([change[:-1].ravel() for change in changes])

    return _recorded(system, shock, rates, 18)


def _recorded(
    system: RigidBodySystem, shock: Shock | None, read: Callable[[RigidBodySystem], Array], size: int
) -> OfState:
    """What `read` finds when the forces on a state, of `size` numbers a body, are computed.

    With few bodies and laws that branch on no value this is gone through once, with numbers that record, and what they have
    recorded is compiled.
    """
    moving, n = copy(system), len(system.vertices)

    def found(state: Sequence[Any], strength: Any) -> list[Any]:
        moving.load(np.array(state))
        moving.compute_forces()
        if shock is not None:
            moving.push(shock.body, TIP, shock.force, strength)
        numbers: list[Any] = read(moving).tolist()
        return numbers

    if n > _MOST or (system.force, system.rotation, system.transform) != _STRAIGHT:
        return found
    tape: list[Recorded] = []
    names = [f"y{k}" for k in range(size * n)]
    outputs = found([Recorded(tape, name) for name in names], Recorded(tape, "strength"))
    lines, texts = recorded_numbers.lines(outputs, tape)
    body = [f"{', '.join(names)} = state", *lines, f"return [{', '.join(texts)}]"]
    return function_of("\n    ".join(["from math import *\ndef of_state(state, strength):", *body]))


def _strength(shock: Shock | None, s: float) -> float:
    """exp(−(s/width)²) at s after the peak (4.04), 0 without a shock."""
    ratio = s / shock.width if shock else inf
    return exp(-ratio * ratio)


def _read(system: RigidBodySystem, t: Array, states: Array, evaluations: int) -> SpringRun:
    """A run from states (n, 18 n_b or more) of X, U, L and R; Omega follows from L and R (3.17)."""
    if len(system.vertices) < 2 or min(len(vertices) for vertices in system.vertices[:2]) < TIP:
        raise InputError("SpringRun: bodies 1 and 2 must be rotors with two vertices; step other systems by hand")
    n, n_b = len(t), len(system.vertices)
    X, U, L = states[:, : 9 * n_b].reshape(n, 3, n_b, 3).swapaxes(0, 1)
    R = states[:, 9 * n_b : 18 * n_b].reshape(n, n_b, 3, 3)
    Omega = (system.transform(R, system.inverse_inertia[:-1]) @ L[..., None])[..., 0]
    axes, rates, tips = [], [], []
    for i, vertices in enumerate(system.vertices[:2]):
        bottom, top = vertices[0], vertices[TIP - 1]
        axes.append(R[:, i] @ ((top - bottom) / np.linalg.norm(top - bottom)))
        rates.append(np.cross(Omega[:, i], axes[i]))
        tips.append(X[:, i] + R[:, i] @ top)
    held = (np.broadcast_to(part[-1:], (n, *part[-1:].shape)) for part in (system.X, system.R))
    places = (np.concatenate((part, ground), axis=1) for part, ground in zip((X, R), held, strict=True))
    stretches = np.linalg.norm(system.gaps(*places), axis=-1).T
    momenta = U / system.inverse_mass[:-1]
    return SpringRun(
        t=t,
        axes=np.array(axes),
        rates=np.array(rates),
        tips=np.array(tips),
        centres=X.swapaxes(0, 1),
        rotations=R.swapaxes(0, 1),
        stretches=stretches,
        momentum=momenta.sum(1),
        angular_momentum=(np.cross(X, momenta) + L).sum(1),
        translation=((U**2).sum(-1) / (2 * system.inverse_mass[:-1, 0])).T,
        rotation=(Omega * L).sum(-1).T / 2,
        spring=system.stiffness * stretches**2 / 2,
        evaluations=evaluations,
    )
