"""Running spring-linked bodies: the paper's fixed step, and a stiff solver beside it."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass
from math import exp, isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, IntegrationError
from lagrotor.models.simulate import check_times
from lagrotor.models.spring_link.paper_bodies import TIP
from lagrotor.models.spring_link.rigid_body import Array
from lagrotor.models.spring_link.system import RigidBodySystem, step_limit
from lagrotor.numerics.integrate import check_tolerance
from lagrotor.numerics.pulse import segments
from lagrotor.numerics.rotations import cross_matrix
from lagrotor.pair.scene import Shock

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
    """Move a copy of `system` from t = 0 by the paper's step and read it at the times `t` (n,), whole multiples of dt.

    The shock of step k has its strength at k dt, as in the paper's loop. `step_limit` says which dt is stable; one
    above it is run all the same, for as long as it lasts.

    Raises InputError for dt not above zero, times between the steps, or a step longer than the shock is wide (it could
    miss it); IntegrationError when the state is not a number, or beyond LOST.
    """
    times = check_times(t)
    if not (isinstance(dt, int | float) and isfinite(dt) and dt > 0):
        raise InputError(f"run_steps: dt = {dt!r} s must be a finite number above zero")
    counts = np.rint(times / dt).astype(int)
    if (abs(counts * dt - times) > 1e-6 * dt * np.maximum(counts, 1)).any():
        raise InputError(f"run_steps: t holds times between the steps of dt = {dt:g} s: give whole multiples of dt")
    if shock is not None and dt > shock.width:
        raise InputError(
            f"run_steps: dt = {dt:g} s steps over a shock of width {shock.width:g} s; take dt well below it"
        )
    moving, k = deepcopy(system), 0
    seen: list[tuple[Array, ...]] = []
    with np.errstate(over="ignore", invalid="ignore"):
        for count in counts:
            while k < count:
                moving.compute_forces()
                _shake(moving, shock, k * dt - shock.at if shock else 0.0)
                moving.step(dt)
                k += 1
            state = moving.X.copy(), moving.U.copy(), moving.R, moving.L.copy()
            if not sum(np.vdot(part, part) for part in state) < LOST**2:
                raise IntegrationError(
                    f"run_steps: the state is not a number, or beyond {LOST:g}, at t = {k * dt:.6g} s with dt = {dt:g} "
                    f"s; the longest stable step is {step_limit(system).whole:.4g} s at the start: take dt below it"
                )
            seen.append(state)
    X, U, R, L = (np.array(part) for part in zip(*seen, strict=True))
    return _read(system, times, X, U, R, L, k)


def run_solver(
    system: RigidBodySystem, shock: Shock | None, t: ArrayLike, tol: float = 1e-8, method: str = "LSODA"
) -> SpringRun:
    """Move a copy of `system` from t = 0 by one of scipy's solvers, the same forces without the error of a fixed step.

    State X, U, R, L of every body, with R' = [Omega]× R. tol: relative and absolute local error / 20. The run is cut at
    the shock's edges, ± 6.5 widths, within which no step is longer than the width. LSODA changes to a stiff
    method where damping requires it; "Radau" and "BDF" are stiff throughout, "DOP853" nowhere.

    Raises InputError for bad times, tolerance or method, IntegrationError when the solver cannot go on.
    """
    from scipy.integrate import solve_ivp

    times, error = check_times(t), check_tolerance(tol) / 20
    if method not in ("LSODA", "Radau", "BDF", "DOP853"):
        raise InputError(f"run_solver: method = {method!r} is not one of LSODA, Radau, BDF, DOP853")
    moving, n = deepcopy(system), len(system.vertices)
    load, rhs = _right_hand_side(moving)
    at, width = (shock.at, shock.width) if shock else (0.0, 0.0)
    since_peak = times - at
    begin, end = -at, float(since_peak[-1])
    y = np.concatenate([part[:n].ravel() for part in (moving.X, moving.U, moving.L, moving.R)])
    states, evaluations = np.empty((len(times), len(y))), 0
    states[since_peak == begin] = y
    for left, right, pulsed in segments(begin, end, width):
        if right <= left:
            continue
        options: dict[str, Any] = {"max_step": width} if pulsed else {}
        inside = (since_peak > left) & (since_peak <= right)
        t_eval, acting = np.union1d(since_peak[inside], [right]), shock if pulsed else None
        found = solve_ivp(
            rhs, (left, right), y, method=method, args=(acting,), t_eval=t_eval,
            rtol=max(error, 2.3e-14), atol=error, **options,
        )  # fmt: skip
        if not found.success or not np.isfinite(found.y).all():
            raise IntegrationError(
                f"run_solver: {method} stopped between t = {at + left:.6g} and {at + right:.6g} s ({found.message}); "
                "lower S or D, or take a larger tol"
            )
        states[inside], y = found.y.T[: inside.sum()], found.y[:, -1]
        evaluations += found.nfev
    history: dict[str, list[Array]] = {"X": [], "U": [], "R": [], "L": []}
    for state in states:
        load(state)
        for name, kept in history.items():
            kept.append(getattr(moving, name).copy())
    X, U, R, L = (np.array(kept) for kept in history.values())
    return _read(system, times, X, U, R, L, evaluations)


def _right_hand_side(moving: RigidBodySystem) -> tuple[Callable[[Array], None], Callable[..., Array]]:
    """Putting a state y (18 n,) of X, U, L, R of n bodies into `moving`; and y' at s after a shock's peak, under that shock."""
    n = len(moving.vertices)

    def load(y: Array) -> None:
        moving.X[:n], moving.U[:n], moving.L[:n] = y[: 9 * n].reshape(3, n, 3)
        moving.R[:n] = y[9 * n :].reshape(n, 3, 3)

    def rhs(s: float, y: Array, acting: Shock | None) -> Array:
        load(y)
        moving.Omega = moving.angular_velocity()
        moving.compute_forces()
        _shake(moving, acting, s)
        changes = np.empty_like(y)
        changes[: 9 * n].reshape(3, n, 3)[:] = moving.U[:n], moving.F[:n] * moving.inverse_mass[:n], moving.tau[:n]
        changes[9 * n :] = (cross_matrix(moving.Omega[:n]) @ moving.R[:n]).ravel()
        return changes

    return load, rhs


def _shake(system: RigidBodySystem, shock: Shock | None, s: float) -> None:
    """The shock on the tip of its rotor, s after its peak (4.04); nothing once it underflows to zero."""
    if shock is None:
        return
    ratio = s / shock.width
    strength = exp(-ratio * ratio)
    if strength > 0:
        system.push(shock.body, TIP, strength * np.array(shock.force))


def _read(system: RigidBodySystem, t: Array, X: Array, U: Array, R: Array, L: Array, evaluations: int) -> SpringRun:
    """A run from states (n, n_b + 1, …), whose last body is the ground; Omega follows from L and R (3.17)."""
    if len(system.vertices) < 2 or min(len(vertices) for vertices in system.vertices[:2]) < TIP:
        raise InputError("SpringRun: bodies 1 and 2 must be rotors with two vertices; step other systems by hand")
    Omega = (system.transform(R, system.inverse_inertia) @ L[..., None])[..., 0]
    axes, rates, tips = [], [], []
    for i, vertices in enumerate(system.vertices[:2]):
        bottom, top = vertices[0], vertices[TIP - 1]
        axes.append(R[:, i] @ ((top - bottom) / np.linalg.norm(top - bottom)))
        rates.append(np.cross(Omega[:, i], axes[i]))
        tips.append(X[:, i] + R[:, i] @ top)
    stretches = np.linalg.norm(system.gaps(X, R), axis=-1).T
    momenta = U[:, :-1] / system.inverse_mass[:-1]
    return SpringRun(
        t=t,
        axes=np.array(axes),
        rates=np.array(rates),
        tips=np.array(tips),
        centres=X[:, :-1].swapaxes(0, 1),
        rotations=R[:, :-1].swapaxes(0, 1),
        stretches=stretches,
        momentum=momenta.sum(1),
        angular_momentum=(np.cross(X[:, :-1], momenta) + L[:, :-1]).sum(1),
        translation=((U[:, :-1] ** 2).sum(-1) / (2 * system.inverse_mass[:-1, 0])).T,
        rotation=(Omega * L).sum(-1)[:, :-1].T / 2,
        spring=system.stiffness * stretches**2 / 2,
        evaluations=evaluations,
    )
