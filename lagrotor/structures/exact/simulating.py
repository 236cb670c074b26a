"""A structure's run: exact motion from a tilt and its rates, with its error estimate."""

import warnings
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, LagrotorWarning, SingularError
from lagrotor.numerics.integrate import Engine, Problem, Solution, check_engine, check_tolerance, integrate
from lagrotor.numerics.segment import RightHandSide, StopError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, finite
from lagrotor.structures.exact import compiled_motion
from lagrotor.structures.exact.closing import closed
from lagrotor.structures.exact.exact_motion import Drive, ExactMotion, exact_motion
from lagrotor.structures.exact.lines_passed import LineWatch
from lagrotor.structures.exact.scalar_rhs import right_hand_side
from lagrotor.structures.exact.structure_run import StructureRun

_APART = 30.0  # the two runs' tolerances: the difference is the error of the looser one
_FIRST = 1e-2  # of tol: the local error that the first run is given
_ROUNDING = 2e-15  # error a turn of the fastest axis that no tolerance avoids, in both runs alike


def simulate(
    s: Assembly,
    t: ArrayLike,
    tilt: ArrayLike | None = None,
    rates: ArrayLike | None = None,
    drive: Drive | None = None,
    ground: Drive | None = None,
    tol: float = 1e-9,
    engine: Engine = "core",
) -> StructureRun:
    """The exact motion from t = 0, read at the increasing times t (n,), s.

    tilt: x and y of the axes' unit vectors (N, 2), or the vectors (N, 3), upright unless given; rates: theirs, 1/s.
    Both are brought to the nearest state on the bars in the metric of the masses, which `run.axes[:, 0]` and
    `run.rates[:, 0]` show.
    drive: t → forces (N, 3) on the tips in N; ground: t → acceleration (3,) of the ground in m/s²; both smooth.
    tol: the largest error of an axis over the run, 1e-13 to 0.1; `run.error` is its estimate, from a second run at another
    tolerance, and a LagrotorWarning says when it exceeds tol. engine: "core", or "fast" with heyoka (`pip install
    lagrotor[fast]`), which takes some seconds to compile a structure, once for all spins.

    Raises InputError for what makes no sense, ConstraintError for a tilt that the bars do not allow, SingularError
    where bars and axes are in line, IntegrationError where they come to be, or the motion cannot go on.
    """
    times, wanted = _times(t), check_tolerance(tol)
    check_engine(engine)
    shape = (len(s.joints), 3)
    drives = _checked(drive, "drive", shape, times), _checked(ground, "ground", shape[1:], times)
    motion = exact_motion(s, *drives)
    start, local = _start(motion, tilt, rates), max(wanted * _FIRST, 3e-12)
    run = partial(_integrated, s, motion, start, times, engine)
    (coarse, fine), N = run(local), len(s.joints)
    nfev, unavoidable = coarse.nfev + fine.nfev, _ROUNDING * (1 + motion.c.rate * float(times[-1]) / (2 * np.pi))
    while True:
        off = (fine.states - coarse.states)[:, : 3 * N].reshape(-1, N, 3)
        error = float(np.linalg.norm(off, axis=-1).max()) + unavoidable
        if error <= wanted or local <= 3e-12 or unavoidable > wanted:
            break
        local = max(local / _APART**2, 3e-12)
        coarse, fine = run(local)
        nfev += coarse.nfev + fine.nfev
    if error > wanted:
        why = "as neighbouring motions part" if 2 * unavoidable < error else "as rounding adds up over its turns"
        warnings.warn(
            f"simulate: tol = {wanted:g} is not kept: the error is {error:.1e}, {why}; shorten the run",
            LagrotorWarning,
            stacklevel=2,
        )
    states = motion.projected(fine.states.T).T if engine == "fast" else fine.states
    axes, velocities = states.reshape(-1, 2, N, 3).transpose(1, 2, 0, 3).copy()
    return StructureRun(s, times, axes, motion.c.rate * velocities, error, nfev)


def _integrated(
    s: Assembly, motion: ExactMotion, start: Array, times: Array, engine: Engine, local: float
) -> list[Solution]:
    """States (n, 6 N) of (r, r'/rate) with the local error and a tighter one; those of a Taylor series are off the
    constraints by their error.
    """
    rate, tols = motion.c.rate, (local, max(local / _APART, 1e-13))
    try:
        if engine == "fast" and compiled_motion.runs_by_series(motion):
            return compiled_motion.integrate_series(s, motion, start, rate * times, tols)
        rhs = compiled_motion.compiled_right_hand_side(s, motion) if engine == "fast" else right_hand_side(motion)
        return [_by_right_hand_side(motion, rhs, start, rate * times, tol) for tol in tols]
    except StopError as stopped:  # at a time without unit
        for drive in (motion.force, motion.ground):
            if isinstance(drive, _Checked) and drive.refused:
                raise InputError(drive.refused) from None
        raise StopError(stopped.at / rate, stopped.reason) from None


def _by_right_hand_side(motion: ExactMotion, rhs: RightHandSide, start: Array, times: Array, tol: float) -> Solution:
    watch, most = LineWatch(motion), 50_000 + 2_000 * float(times[-1])
    problem: Any = Problem(watch.watched(rhs), start, most, project=motion.projected, typical_rate=1.0)
    found = integrate(problem, times, tol)
    watch.keep(float(times[-1]), found.states[-1])
    watch.check()
    return found


def _start(motion: ExactMotion, tilt: ArrayLike | None, rates: ArrayLike | None) -> Array:
    """The state (r, r'/rate) on the constraints."""
    N = len(motion.c.R)
    x = _vectors("tilt", tilt, N)
    if x.shape[1] == 2:
        height = 1 - (x**2).sum(1)
        if (height < 0).any():
            raise InputError(f"simulate: tilt of rotor {int(np.argmin(height))} exceeds 1, the sine of a right angle")
        r = np.column_stack([x, np.sqrt(height)])
    else:
        r = x / np.linalg.norm(x, axis=1, keepdims=True)
    r = closed(motion, r)
    v = _vectors("rates", rates, N)
    if v.shape[1] == 2:
        safe = np.where(np.abs(r[:, 2]) > 1e-6, r[:, 2], np.inf)
        v = np.column_stack([v, -(r[:, :2] * v).sum(1) / safe])
    y = np.concatenate([r.ravel(), v.ravel() / motion.c.rate])
    start = np.concatenate([r.ravel(), motion.projected(y)[3 * N :]])
    if not np.isfinite(start).all():
        raise SingularError(
            "simulate: the constraints are dependent at this tilt (bar and axes in line): start elsewhere"
        )
    return start


def _vectors(name: str, given: ArrayLike | None, N: int) -> Array:
    if given is None:
        return np.zeros((N, 2))
    found = finite(f"simulate: {name}", given)
    if found.shape not in ((N, 2), (N, 3)):
        raise InputError(f"simulate: {name} must be numbers ({N}, 2) or ({N}, 3), not of shape {found.shape}")
    if found.size == 3 * N and name == "tilt" and not (np.linalg.norm(found, axis=1) > 0).all():
        raise InputError("simulate: tilt holds a vector of length zero")
    return found


@dataclass
class _Checked:
    """A drive that gives NaN, and says why, where what was given for it fails or gives no finite array of its shape."""

    given: Drive
    name: str
    shape: tuple[int, ...]
    refused: str = ""

    def __call__(self, t: float) -> Array:
        where = f"simulate: {self.name} at t = {t:g}"
        try:
            found = finite(where, self.given(t))
            if found.shape == self.shape:
                return found
            self.refused = f"{where} must give an array of shape {self.shape}, not {found.shape}"
        except InputError as error:
            self.refused = str(error)
        except Exception as error:
            self.refused = f"{where} fails with {error!r}"
        return np.full(self.shape, np.nan)


def _checked(drive: Drive | None, name: str, shape: tuple[int, ...], times: Array) -> Drive | None:
    """The drive, tried at t = 0 and at the times of the run."""
    if drive is None:
        return None
    if not callable(drive):
        raise InputError(f"simulate: {name} = {drive!r} must be a function t → array of shape {shape}")
    checked = _Checked(drive, name, shape)
    for t in (0.0, *times.tolist()):
        checked(t)
        if checked.refused:
            raise InputError(checked.refused)
    return checked


def _times(t: ArrayLike) -> Array:
    times = np.atleast_1d(finite("simulate: t", t))
    if times.ndim != 1 or not len(times) or times[0] < 0 or (np.diff(times) <= 0).any():
        raise InputError("simulate: t must be an increasing row of finite times in s, from 0 on")
    return times
