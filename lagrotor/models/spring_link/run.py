"""Runs of bodies on springs, by the paper's fixed step or by a stiff solver.

For few bodies the step, or the derivative of the state, is generated scalar code, which is faster than operations on arrays.
"""

import warnings
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass
from math import exp, hypot, inf, isfinite, nan, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.models.spring_link.rigid_body import Array, finite_rotation, inertia_transform
from lagrotor.models.spring_link.system import TIP, RigidBodySystem, link_force, step_limit
from lagrotor.numerics import operation_recorder
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.error_estimate import EvaluationBudget, Evolution, estimate_run
from lagrotor.numerics.integrate import Problem, check_tolerance, integrate
from lagrotor.numerics.operation_recorder import Recorded
from lagrotor.numerics.pulse import pulse_windows
from lagrotor.numerics.rotations import skew_matrix
from lagrotor.numerics.run import Ending, Quantity, Run, read_run
from lagrotor.numerics.segment import LOST as OUT_OF_RANGE
from lagrotor.numerics.segment import RightHandSide, Stretch
from lagrotor.numerics.solvers import lsoda
from lagrotor.numerics.source_cache import function_of
from lagrotor.pair.scene import Shock

_OfState = Callable[[Sequence[float], float], list[float]]  # of a state and the strength of a shock
_MOST = 12  # the most bodies for scalar code
_STRAIGHT = link_force, finite_rotation, inertia_transform  # laws without branches
_TIGHTEST = 2.3e-14  # the least local error of LSODA
LOST = 1e100  # the norm of a diverged state, whose energies are still finite


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SpringRun(Run):
    """A run of n_b bodies, the first two the rotors, and n_l links, at n times.

    - `axes` and `rates`: the unit vectors from vertex 1 to vertex 2 of each rotor, and their rates in 1/s, (2, n, 3).
    - `tips` and `feet`: the positions of vertices 2 and 1 of each rotor, (2, n, 3), m.
    - `spins`: the angular velocities of the rotors about their axes, (2, n), rad/s.
    - `centres` and `rotations`: the centres of all bodies, (n_b, n, 3), m, and their rotations, (n_b, n, 3, 3).
    - `stretches`: the gaps |X_1 − X_2| of the links, (n_l, n), m.
    - `momentum` and `angular_momentum`: the sums over all bodies, (n, 3), kg m/s, and about the origin in kg m²/s.
    - `translation` and `rotation`: the energies M U²/2 and Omega·L/2 of each body, (n_b, n), J.
    - `spring`: the energies S |X_1 − X_2|²/2 of the links, (n_l, n), J.
    - `evaluations`: the number of evaluations of the forces.
    - `errors`: the error of positions in units of the largest body, and of R, (n,); NaN for the paper's step.
    """

    axes: Array
    rates: Array
    tips: Array
    feet: Array
    spins: Array
    centres: Array
    rotations: Array
    stretches: Array
    momentum: Array
    angular_momentum: Array
    translation: Array
    rotation: Array
    spring: Array

    @property
    def paper_energy(self) -> Array:
        """The kinetic energy, which the paper records (4.02), without the energy of the springs, (n,), J."""
        return self.translation.sum(0) + self.rotation.sum(0)

    @property
    def energy(self) -> Array:
        """The kinetic energy plus the energy of the springs, (n,), J. Damping, shock and external forces change it."""
        return self.paper_energy + self.spring.sum(0)

    def quantities(self) -> dict[str, Quantity]:
        """Return the arrays of the run and its energy."""
        stored = {name: Quantity(getattr(self, name), axes, unit) for name, (axes, unit) in _QUANTITIES.items()}
        return stored | {"energy": Quantity(self.energy, ("t",), "J")}

    def plot(self) -> Any:
        """Draw the tips over time and from above, and the energy."""
        from lagrotor.drawing.run_figure import run_figure

        return run_figure(self.t, self.tips, self.energy, "rigid bodies on springs")

    def animate(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write a film of the motion to `path`, a `.gif`, with splines between the samples."""
        from scipy.interpolate import CubicSpline
        from scipy.spatial.transform import Rotation, Slerp

        from lagrotor.drawing.film import FilmedMotion, animate_lines, check_film, frame_times

        check_film(Path(path), float(self.t[-1] - self.t[0]), fps)
        times = frame_times(self.t[0], self.t[-1], fps)
        rotations = np.array([Slerp(self.t, Rotation.from_matrix(R))(times).as_matrix() for R in self.rotations[:2]])
        tips, centres = (CubicSpline(self.t, curve, axis=1)(times) for curve in (self.tips, self.centres[:2]))
        length = float(np.linalg.norm(self.tips[0, 0] - self.feet[0, 0]))
        moving = FilmedMotion(times, rotations, tips, centres, self.feet[:, 0], length, len(self.centres) > 2)
        lines, inks, traced = moving.lines()
        return animate_lines(path, times, lines, fps, inks, traced)

    @staticmethod
    def load(path: str | Path) -> "SpringRun":
        """Read a run from an .npz file that `save` wrote. Raises InputError if it contains no such run."""
        _, arrays, run_fields = read_run(path)
        n = len(run_fields["t"])
        sizes: dict[str, int] = {"t": n, "rotor": 2, "component": 3, "row": 3}
        try:
            quantities: dict[str, Any] = {name: arrays[name] for name in _QUANTITIES}
            for name, array in quantities.items():
                for axis, size in zip(_QUANTITIES[name][0], array.shape, strict=True):
                    if sizes.setdefault(axis, size) != size:
                        raise ValueError(f"{name} has shape {array.shape}")
                if not np.isfinite(array).all():
                    raise ValueError(f"{name} contains a number that is not finite")
        except (KeyError, ValueError) as refusal:
            raise InputError(
                f"load: {path} is no run of bodies on springs ({refusal}): give a file that `save` wrote"
            ) from None
        return SpringRun(**quantities, **run_fields)


_OF_ROTORS, _OF_BODIES, _OF_LINKS = ("rotor", "t", "component"), ("body", "t"), ("link", "t")
_QUANTITIES: dict[str, tuple[tuple[str, ...], str]] = {
    "axes": (_OF_ROTORS, "1"), "rates": (_OF_ROTORS, "1/s"), "tips": (_OF_ROTORS, "m"), "feet": (_OF_ROTORS, "m"),
    "spins": (("rotor", "t"), "rad/s"), "centres": ((*_OF_BODIES, "component"), "m"),
    "rotations": ((*_OF_BODIES, "component", "row"), "1"), "stretches": (_OF_LINKS, "m"),
    "momentum": (("t", "component"), "kg m/s"), "angular_momentum": (("t", "component"), "kg m²/s"),
    "translation": (_OF_BODIES, "J"), "rotation": (_OF_BODIES, "J"), "spring": (_OF_LINKS, "J"),
}  # fmt: skip


def run_steps(system: RigidBodySystem, shock: Shock | None, t: ArrayLike, dt: float) -> SpringRun:
    """Move a copy of a system by the paper's fixed step, with the shock of step k at the time k dt.

    A step above `step_limit` is run, too. If the state then is not a number or exceeds LOST, the run ends with a
    LagrotorWarning. The error is not estimated.

    Parameters
    ----------
    system : RigidBodySystem
        The bodies and links.
    shock : Shock or None
        A shock on a vertex.
    t : array_like
        The times (n,), integer multiples of dt, s.
    dt : float
        The step, s.

    Returns
    -------
    SpringRun
        The run at the times that were reached.

    Raises
    ------
    InputError
        If dt is not positive or exceeds the width of the shock, or a time lies between the steps.
    """
    times = check_times("run_steps", t)
    if not (isinstance(dt, int | float) and isfinite(dt) and dt > 0):
        raise InputError(f"run_steps: dt = {dt!r} s must be a finite number above zero")
    counts = np.rint(times / dt).astype(int)
    if (abs(counts * dt - times) > 1e-6 * dt * np.maximum(abs(counts), 1)).any():
        raise InputError(f"run_steps: t contains times between the steps of dt = {dt:g} s: give whole multiples of dt")
    if shock is not None and dt > shock.width:
        raise InputError(
            f"run_steps: dt = {dt:g} s steps over a shock of width {shock.width:g} s; take dt well below it"
        )
    step, state, k, at = step_function(system, shock, dt), system.state.tolist(), counts[0], shock.at if shock else 0.0
    states, ending = [], Ending("end", float(times[-1]))
    with np.errstate(over="ignore", invalid="ignore"):
        for count in counts:
            try:
                while k < count:
                    state = step(state, _strength(shock, k * dt - at))
                    k += 1
            except OUT_OF_RANGE:
                state = [nan]  # as arrays would give
            if not hypot(*state) < LOST:
                reason = f"the state is not a number, or beyond {LOST:g}, with dt = {dt:g} s"
                if system.joints:
                    reason += (
                        f"; the longest stable step is {step_limit(system).whole:.4g} s at the start: take dt below it"
                    )
                ending = Ending("stopped", float(k * dt), reason)
                warnings.warn(
                    f"run_steps: the run ended early: {ending}; it has the times that were reached",
                    LagrotorWarning,
                    stacklevel=2,
                )
                break
            states.append(state)
    n = len(states)
    run_fields = {"errors": np.full(n, nan), "horizon": nan, "evaluations": int(k - counts[0]), "ending": ending}
    return _run_of(system, np.array(states), run_fields | {"t": times[:n]})


def run_solver(system: RigidBodySystem, shock: Shock | None, t: ArrayLike, tol: float = 1e-8) -> SpringRun:
    """Move a copy of a system by LSODA, with the same forces and a tolerance instead of a fixed step.

    LSODA changes to a stiff method where damping requires it. The state is X, U, R, L of every body, with R' = [Omega]× R.
    The run is divided at ± 6.5 widths of the shock, within which no step exceeds the width.

    Parameters
    ----------
    system : RigidBodySystem
        The bodies and links.
    shock : Shock or None
        A shock on a vertex.
    t : array_like
        The times (n,), s.
    tol : float, default 1e-8
        The largest error of the run: of positions in units of the largest body, and of R. A LagrotorWarning is issued if it
        is exceeded.

    Returns
    -------
    SpringRun
        The run at the times that were reached.
    """
    times, tolerance = check_times("run_solver", t), check_tolerance(tol, "run_solver")
    rate, n_b = rate_function(system, shock), len(system.vertices)
    size = max(float(np.linalg.norm(arms, axis=1).max()) for arms in system.vertices) or 1.0
    # A time far from zero has few digits for steps.
    at = shock.at if shock else float(times[0])
    stiff = np.linalg.eigvalsh(system.joint_mobility())[-1] * system.stiffness if system.joints else 0.0
    turn = (
        2
        * pi
        / max(sqrt(stiff), float(np.linalg.norm(system.Omega, axis=1).max()), 1 / max(times[-1] - times[0], 1e-300))
    )

    def distance(first: Array, second: Array) -> Array:
        places, rotations = (np.split(states, [3 * n_b, 9 * n_b], axis=1)[::2] for states in (first, second))
        apart = [
            (a - b).reshape(len(first), n_b, -1) / unit
            for a, b, unit in zip(places, rotations, (size, 1.0), strict=True)
        ]
        return np.maximum(*(np.linalg.norm(states, axis=-1).max(axis=1) for states in apart))

    def under(shock: Shock | None) -> RightHandSide:
        def rhs(s: float, y: Array) -> list[float]:
            try:
                return rate(y.tolist(), _strength(shock, s))
            except OUT_OF_RANGE:
                return [nan] * len(y)

        return rhs

    def integrate_from(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        windows = pulse_windows(shock.width, companion) if shock else ()
        driven = under(shock) if shock else None
        problem = Problem(under(None), start, budget, driven, at, windows, begin=float(times[0]))
        return integrate(problem, times, local, lambda segment, _, error: lsoda(segment, max(error / 20, _TIGHTEST)))

    evolution = Evolution(system.state[: 18 * n_b], integrate_from, distance, turn, EvaluationBudget(50_000, 2_000))
    run = estimate_run(evolution, times, tolerance)
    run.warn_unless_kept("run_solver", tolerance)
    return _run_of(system, run.states, run.run_fields)


def step_function(system: RigidBodySystem, shock: Shock | None, dt: float) -> _OfState:
    """Return a function of `system.state` and the strength of the shock that gives the state a step dt later. It applies
    `compute_forces`, `push` and `step` of the system."""

    def after(moving: RigidBodySystem) -> Array:
        moving.step(dt)
        return moving.state

    return _recorded(system, shock, after, 21)


def rate_function(system: RigidBodySystem, shock: Shock | None) -> _OfState:
    """Return a function of the state y, (18n,), with X, U, L, R of n bodies and the strength of the shock that gives y'. It
    applies `compute_forces` and `push` of the system."""

    def rates(moving: RigidBodySystem) -> Array:
        turning = skew_matrix(moving.Omega) @ moving.R
        changes = moving.U, moving.F * moving.inverse_mass, moving.tau, turning
        return np.concatenate([change[:-1].ravel() for change in changes])

    return _recorded(system, shock, rates, 18)


def _recorded(
    system: RigidBodySystem, shock: Shock | None, read: Callable[[RigidBodySystem], Array], size: int
) -> _OfState:
    """Return a function of a state and the strength of the shock that computes the forces and returns what `read` reads.

    The state has `size` numbers per body. For few bodies and laws without branches, the function is evaluated once with numbers
    that record their operations, and the record is compiled.
    """
    moving, n = copy(system), len(system.vertices)

    def evaluate(state: Sequence[Any], strength: Any) -> list[Any]:
        moving.load(np.array(state))
        moving.compute_forces()
        if shock is not None:
            moving.push(shock.body, TIP, shock.force, strength)
        numbers: list[Any] = read(moving).tolist()
        return numbers

    if n > _MOST or (system.force, system.rotation, system.transform) != _STRAIGHT:
        return evaluate
    tape: list[Recorded] = []
    names = [f"y{k}" for k in range(size * n)]
    outputs = evaluate([Recorded(tape, name) for name in names], Recorded(tape, "strength"))
    lines, texts = operation_recorder.lines(outputs, tape)
    body = [f"{', '.join(names)} = state", *lines, f"return [{', '.join(texts)}]"]
    return function_of("\n    ".join(["from math import *\ndef of_state(state, strength):", *body]))


def _strength(shock: Shock | None, s: float) -> float:
    """Return the strength exp(−(s/width)²) of a shock at s after its peak (4.04); 0 without a shock."""
    ratio = s / shock.width if shock else inf
    return exp(-ratio * ratio)


def _run_of(system: RigidBodySystem, states: Array, run_fields: dict[str, Any]) -> SpringRun:
    """Return the run with the states (n, 18 n_b or more), rows of X, U, L and R. Omega follows from L and R (3.17)."""
    if len(system.vertices) < 2 or min(len(vertices) for vertices in system.vertices[:2]) < TIP:
        raise InputError("SpringRun: bodies 1 and 2 must be rotors with two vertices; step other systems by hand")
    n, n_b = len(states), len(system.vertices)
    X, U, L = states[:, : 9 * n_b].reshape(n, 3, n_b, 3).swapaxes(0, 1)
    R = states[:, 9 * n_b : 18 * n_b].reshape(n, n_b, 3, 3)
    Omega = (system.transform(R, system.inverse_inertia[:-1]) @ L[..., None])[..., 0]
    axes, rates, tips, feet, spins = [], [], [], [], []
    for i, vertices in enumerate(system.vertices[:2]):
        bottom, top = vertices[0], vertices[TIP - 1]
        axes.append(R[:, i] @ ((top - bottom) / np.linalg.norm(top - bottom)))
        rates.append(np.cross(Omega[:, i], axes[i]))
        tips.append(X[:, i] + R[:, i] @ top)
        feet.append(X[:, i] + R[:, i] @ bottom)
        spins.append((Omega[:, i] * axes[i]).sum(-1))
    fixed = (np.broadcast_to(array[-1:], (n, *array[-1:].shape)) for array in (system.X, system.R))
    places = (np.concatenate((array, ground), axis=1) for array, ground in zip((X, R), fixed, strict=True))
    stretches = np.linalg.norm(system.gaps(*places), axis=-1).T
    momenta = U / system.inverse_mass[:-1]
    return SpringRun(
        axes=np.array(axes), rates=np.array(rates), tips=np.array(tips), feet=np.array(feet), spins=np.array(spins),
        centres=X.swapaxes(0, 1), rotations=R.swapaxes(0, 1), stretches=stretches, momentum=momenta.sum(1),
        angular_momentum=(np.cross(X, momenta) + L).sum(1), rotation=(Omega * L).sum(-1).T / 2,
        translation=((U**2).sum(-1) / (2 * system.inverse_mass[:-1, 0])).T, spring=system.stiffness * stretches**2 / 2,
        **run_fields,
    )  # fmt: skip
