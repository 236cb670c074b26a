"""The run of a structure: its exact motion with an error estimate, its pictures, and its file."""

from dataclasses import asdict, dataclass
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import check_times, finite_array
from lagrotor.numerics.error_estimate import EvaluationBudget, Evolution, estimate_run
from lagrotor.numerics.integrate import Engine, Problem, check_engine, check_tolerance, integrate
from lagrotor.numerics.run import Quantity, Run, read_run
from lagrotor.numerics.segment import Integrate, StopError, Stretch
from lagrotor.pair.scene import Link, Rotor
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.exact import compiled_motion
from lagrotor.structures.exact.bar_closure import start_state
from lagrotor.structures.exact.compiled_motion import right_hand_side
from lagrotor.structures.exact.exact_motion import Drive, ExactMotion, LineWatch, bar_in_line, exact_motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from lagrotor.drawing.view import View


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StructureRun(Run):
    """The motion of a structure of N rotors and B bars at n times.

    Attributes
    ----------
    t : Array
        The times that were reached, (n,), s.
    errors : Array
        The estimated largest error of an axis up to each time, (n,).
    horizon : float
        The time from which the error exceeds the tolerance, s.
    evaluations : int
        The number of evaluations of the right-hand side in all integrations.
    ending : Ending
        The reason for which the run ended.
    structure : Assembly
        The structure.
    axes : Array
        The unit vectors of the axes, (N, n, 3).
    rates : Array
        The rates of the axes, (N, n, 3), 1/s.
    momenta : Array
        The axial momenta I3 ω, which spin friction decreases, (N, n), kg m²/s.

    Examples
    --------
    >>> from lagrotor.structures import example
    >>> run = example("corner").simulate([0.0, 0.5, 1.0], tilt=[[0.01, 0.0]] * 3)
    >>> run.tips.shape, run.link_length.shape, run.energy.shape
    ((3, 3, 3), (2, 3), (3,))
    """

    structure: Assembly
    axes: Array
    rates: Array
    momenta: Array

    def summary(self) -> dict[str, str]:
        """Return the structure, the times and the error in words.

        Returns
        -------
        dict
            The rows of the table.
        """
        s, energy = self.structure, self.energy
        return (
            {"structure": f"{len(s.joints)} rotors, {len(s.bars)} bars"}
            | super().summary()
            | {"energy [J]": f"{energy[0]:.6g} at first, {energy[-1]:.6g} at last"}
        )

    @property
    def tips(self) -> Array:
        """The positions of the tips, (N, n, 3), m."""
        c = coefficients(self.structure)
        return np.asarray(c.feet[:, None] + c.R[:, None, None] * self.axes)

    @property
    def tilt_energy(self) -> Array:
        """The kinetic energy of tilting axes and bars plus the potential energy, (n,), J."""
        return exact_motion(self.structure).energy(self.axes.swapaxes(0, 1), self.rates.swapaxes(0, 1))

    @property
    def energy(self) -> Array:
        """The total energy, which includes the energy of the spins, (n,), J. It is conserved without friction and drive."""
        I3 = np.array([rotor.I3 for rotor in self.structure.rotor])
        return np.asarray(self.tilt_energy + (self.momenta**2 / (2 * I3[:, None])).sum(0))

    @property
    def link_length(self) -> Array:
        """The lengths of the bars, (B, n), m."""
        c = coefficients(self.structure)
        return np.asarray(np.linalg.norm(self.tips[c.j] - self.tips[c.i], axis=-1))

    def quantities(self) -> dict[str, Quantity]:
        """Return the arrays that `save` and the tables contain.

        Returns
        -------
        dict
            axes, rates, tips, energy, link_length and momenta, each a `Quantity`.
        """
        rotors = "rotor", "t", "component"
        return {
            "axes": Quantity(self.axes, rotors, "1"),
            "rates": Quantity(self.rates, rotors, "1/s"),
            "tips": Quantity(self.tips, rotors, "m"),
            "energy": Quantity(self.energy, ("t",), "J"),
            "link_length": Quantity(self.link_length, ("bar", "t"), "m"),
            "momenta": Quantity(self.momenta, ("rotor", "t"), "kg m²/s"),
        }

    def _about(self) -> dict[str, Any]:
        """Return the fields of the structure as a dictionary that `save` writes to the file."""
        return {"structure": asdict(self.structure)}

    @staticmethod
    def load(path: str | Path) -> "StructureRun":
        """Read a run from a file that `save` wrote.

        Parameters
        ----------
        path : str or Path
            The file, .npz.

        Returns
        -------
        StructureRun
            The run. Its structure is an `Assembly`.
        """
        about, arrays, run_fields = read_run(path)
        try:
            kinds: dict[str, Any] = {"rotor": Rotor, "link": Link, "braces": Brace}
            structure_fields = about["structure"]
            structure_fields |= {name: [kind(**row) for row in structure_fields[name]] for name, kind in kinds.items()}
            s, (axes, rates, momenta) = (
                Assembly(**structure_fields),
                (arrays[name] for name in ("axes", "rates", "momenta")),
            )
        except (KeyError, TypeError, AttributeError, ValueError) as refusal:
            raise InputError(
                f"load: {path} is no run of a structure ({refusal}): give a file that `save` wrote"
            ) from None
        shape = (len(s.joints), len(run_fields["t"]), 3)
        expected = (axes, shape), (rates, shape), (momenta, shape[:2])
        if any(array.shape != size or not np.isfinite(array).all() for array, size in expected):
            raise InputError(f"load: {path} is no run: its axes and rates must be finite and of shape {shape}")
        return StructureRun(structure=s, axes=axes, rates=rates, momenta=momenta, **run_fields)

    def plot(self) -> "Figure":
        """Draw the tips over time and from above, and the energy.

        Returns
        -------
        Figure
            A figure that a notebook shows.
        """
        from lagrotor.drawing.run_figure import run_figure
        from lagrotor.drawing.style import OKABE_ITO

        inks = ["blue", "vermillion", "bluish green", "reddish purple", "orange", "sky blue"]
        bars = [bar[:2] for bar in self.structure.bars]
        return run_figure(self.t, self.tips, self.energy, inks=[OKABE_ITO[ink] for ink in inks], bars=bars)

    def animate(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write a film of the motion, with bars grey, braces green, and rotors in the colour of their spin.

        Parameters
        ----------
        path : str or Path
            The file, .gif.
        fps : float, default 25.0
            Frames per second. The film runs at the speed of the motion.

        Returns
        -------
        Path
            The file that was written.
        """
        from lagrotor.drawing.film import animate_lines, check_film, frame_times

        check_film(path, float(self.t[-1] - self.t[0]), fps)
        times = frame_times(float(self.t[0]), float(self.t[-1]), fps)
        lines, inks = self._lines(times)
        return animate_lines(path, times, lines, fps, inks)

    def view(self) -> "View":
        """Return the motion as an interactive page for a notebook, in the colours of `animate`.

        Returns
        -------
        View
            The page, which needs no network.
        """
        from lagrotor.drawing.view import view_lines, view_times

        times = view_times(float(self.t[0]), float(self.t[-1]))
        lines, inks = self._lines(times)
        rotors = range(len(lines) - len(self.structure.joints), len(lines))
        return view_lines(times, lines, inks, f"{len(rotors)} rotors, {len(self.structure.bars)} bars", rotors)

    def _lines(self, times: Array) -> tuple[list[Array], list[str]]:
        """Return the two ends of each bar, brace and rotor at m times, (m, 2, 3) in m, and the colour of each."""
        from lagrotor.drawing.wheel import BAR, MARK, ROTORS
        from lagrotor.numerics.rotations import between_samples

        axes, _ = between_samples(self.t, self.axes, self.rates, times)
        c = coefficients(self.structure)
        feet = np.broadcast_to(c.feet[:, None], axes.shape)
        tips = feet + c.R[:, None, None] * axes
        bars = [np.stack([tips[i], tips[j]], 1) for i, j in zip(c.i, c.j, strict=True)]
        far = np.where(c.brace_to[:, None, None] >= 0, tips[c.brace_to], c.brace_point[:, None])
        lines = [*bars, *np.stack([far, tips[c.brace_tip]], 2), *np.stack([feet, tips], 2)]
        rotors = [BAR if spin == 0 else ROTORS[spin < 0] for spin in self.structure.spins]
        return lines, [*[BAR] * len(bars), *[MARK] * len(far), *rotors]


_PATIENCE = EvaluationBudget(50_000, 2_000 * 2 * pi)


def simulate_structure(
    s: Assembly, t: ArrayLike, tilt: ArrayLike | None = None, rates: ArrayLike | None = None,
    drive: Drive | None = None, ground: Drive | None = None, tol: float = 1e-9, engine: Engine = "core",
) -> StructureRun:  # fmt: skip
    """Integrate the exact motion of a structure: see `Structure.simulate`."""
    times, tol = check_times("simulate", t), check_tolerance(tol)
    check_engine(engine)
    shape, begin = (len(s.joints), 3), float(times[0])
    drives = [
        None if function is None else _CheckedDrive(function, name, size, times)
        for function, name, size in ((drive, "drive", shape), (ground, "ground", shape[1:]))
    ]
    if engine == "fast" and any(drives):
        raise InputError("simulate: engine='fast' takes no drive and no motion of the ground: use engine='core'")
    motion = exact_motion(s, *(checked and checked.since(begin) for checked in drives))
    c = motion.c
    conserved = not (any(drives) or c.decay.any() or c.friction.any() or c.damping.any())
    evolution = Evolution(
        start_state(motion, tilt, rates),
        _integration(s, motion, engine),
        motion.distance,
        turn=2 * pi,
        budget=_PATIENCE,
        project=motion.project,
        conservation_error=lambda _, states: motion.defect(states, conserved),
        difference=motion.difference_of_rates,
        singular=lambda y: bar_in_line(motion, y),
    )
    try:
        run = estimate_run(evolution, c.rate * (times - begin), tol).by_clock(begin, 1 / c.rate)
    except StopError as stop:  # its time has no unit
        for checked in filter(None, drives):
            checked.refuse()
        at = begin + stop.at / c.rate
        raise StopError(at, stop.reason, evaluations=stop.evaluations, cause=stop.cause) from None
    for checked in filter(None, drives) if run.ending.early else ():
        checked.refuse()
    run.warn_unless_kept("the structure's run", tol)
    axes, velocities = motion.axes_and_rates(run.states).swapaxes(1, 2).copy()
    return StructureRun(
        **run.run_fields | {"t": times[: len(run.t)]}, structure=s, axes=axes, rates=c.rate * velocities,
        momenta=c.G[:, None] * np.exp(-c.decay[:, None] * (run.t - begin)),
    )  # fmt: skip


def _integration(s: Assembly, motion: ExactMotion, engine: Engine) -> Integrate:
    """Return a function that integrates a segment of a run by the fastest method. Its times are c.rate t, without unit."""
    if engine == "fast" and compiled_motion.runs_by_series(motion):
        return lambda start, times, local, companion, _: compiled_motion.integrate_series(
            s, motion, start, times, local, companion
        )
    rhs = compiled_motion.compiled_right_hand_side(s, motion) if engine == "fast" else right_hand_side(motion)

    def by_steps(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        watch, begin = LineWatch(motion), float(times[0])
        problem = Problem(watch.observe(rhs), start, budget, project=motion.project, typical_rate=1.0, begin=begin)
        stretch = integrate(problem, times, local)
        watch.keep(float(times[-1]), stretch.end)
        try:
            watch.check()
        except StopError as stop:
            states = stretch.states[times < stop.at]
            stop.reached = Stretch(states, states[-1], stretch.evaluations)
            raise
        return stretch

    return by_steps


@dataclass
class _CheckedDrive:
    """A drive of the user, which is tried at the times of the run when it is made. A call returns an array of the given shape;
    NaN if the function fails or returns anything else. `failure` then says why."""

    function: Drive
    name: str
    shape: tuple[int, ...]
    times: Array
    failure: str = ""

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise InputError(
                f"simulate: {self.name} = {self.function!r} must be a function t → array of shape {self.shape}"
            )
        for t in self.times.tolist():
            self(t)
            self.refuse()

    def __call__(self, t: float) -> Array:
        where = f"simulate: {self.name} at t = {t:g}"
        try:
            return finite_array(where, self.function(t), self.shape)
        except InputError as error:
            self.failure = str(error)
        except Exception as error:
            self.failure = f"{where} fails with {error!r}"
        return np.full(self.shape, np.nan)

    def since(self, begin: float) -> Drive:
        """Return the drive as a function of the time since `begin`."""
        return lambda t: self(begin + t)

    def refuse(self) -> None:
        """Raise InputError if the function has failed."""
        if self.failure:
            raise InputError(self.failure) from None
