"""A structure's run: exact motion from a tilt and its rates, with its error estimate; what it holds, its pictures, its file."""

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
    """Axes r_i and rates r_i' (N, n, 3), 1/s; momenta G_i = I3 omega_i (N, n), axial, kg m²/s, which the spins' own friction
    takes. errors: of an axis, a unit vector."""

    structure: Assembly
    axes: Array
    rates: Array
    momenta: Array

    def summary(self) -> dict[str, str]:
        """The structure, the times, and how well the run is known, name → words."""
        s, energy = self.structure, self.energy
        return (
            {"structure": f"{len(s.joints)} rotors, {len(s.bars)} bars"}
            | super().summary()
            | {"energy [J]": f"{energy[0]:.6g} at first, {energy[-1]:.6g} at last"}
        )

    @property
    def tips(self) -> Array:
        """Positions of the tips, (N, n, 3), m."""
        c = coefficients(self.structure)
        return np.asarray(c.feet[:, None] + c.R[:, None, None] * self.axes)

    @property
    def tilt_energy(self) -> Array:
        """Kinetic energy of the tilting axes and bars, and potential energy, (n,), J."""
        return exact_motion(self.structure).energy(self.axes.swapaxes(0, 1), self.rates.swapaxes(0, 1))

    @property
    def energy(self) -> Array:
        """The whole energy, that of the spins included, (n,), J. Constant without friction and drive."""
        I3 = np.array([rotor.I3 for rotor in self.structure.rotor])
        return np.asarray(self.tilt_energy + (self.momenta**2 / (2 * I3[:, None])).sum(0))

    @property
    def link_length(self) -> Array:
        """Lengths of the bars, (B, n), m."""
        c = coefficients(self.structure)
        return np.asarray(np.linalg.norm(self.tips[c.j] - self.tips[c.i], axis=-1))

    def quantities(self) -> dict[str, Quantity]:
        """axes, rates, tips, energy, link_length, momenta."""
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
        """The structure."""
        return {"structure": asdict(self.structure)}

    @staticmethod
    def load(path: str | Path) -> "StructureRun":
        """The run that `save` wrote as `.npz`; its structure is an `Assembly`.

        Raises
        ------
        InputError
            Where that is not what the file is: not whole, or not a motion of that structure.
        """
        about, held, known = read_run(path)
        try:
            kinds: dict[str, Any] = {"rotor": Rotor, "link": Link, "braces": Brace}
            given = about["structure"]
            given |= {name: [kind(**each) for each in given[name]] for name, kind in kinds.items()}
            s, (axes, rates, momenta) = Assembly(**given), (held[name] for name in ("axes", "rates", "momenta"))
        except (KeyError, TypeError, AttributeError, ValueError) as refusal:
            raise InputError(
                f"load: {path} is no run of a structure ({refusal}): give a file that `save` wrote"
            ) from None
        shape = (len(s.joints), len(known["t"]), 3)
        wanted = (axes, shape), (rates, shape), (momenta, shape[:2])
        if any(part.shape != size or not np.isfinite(part).all() for part, size in wanted):
            raise InputError(f"load: {path} is no run: its axes and rates are not finite numbers {shape}")
        return StructureRun(structure=s, axes=axes, rates=rates, momenta=momenta, **known)

    def plot(self) -> "Figure":
        """Tips over time and from above, and the energy: a figure that a notebook shows."""
        from lagrotor.drawing.run_figure import run_figure
        from lagrotor.drawing.style import OKABE_ITO

        inks = ["blue", "vermillion", "bluish green", "reddish purple", "orange", "sky blue"]
        bars = [bar[:2] for bar in self.structure.bars]
        return run_figure(self.t, self.tips, self.energy, inks=[OKABE_ITO[ink] for ink in inks], bars=bars)

    def animate(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write the motion as a film, `.gif`, at its own speed, axes between the samples by Hermite cubics; bars
        grey, braces green, rotors coloured by the sense of their spins.

        Raises
        ------
        InputError
            For a name, a folder or a frame rate that will not do, before anything is drawn.
        """
        from lagrotor.drawing.film import animate_lines, check_film, frame_times

        check_film(path, float(self.t[-1] - self.t[0]), fps)
        times = frame_times(float(self.t[0]), float(self.t[-1]), fps)
        lines, inks = self._lines(times)
        return animate_lines(path, times, lines, fps, inks)

    def view(self) -> "View":
        """The motion as a page that a notebook shows, turned by hand and played, without a network; colours as of `animate`."""
        from lagrotor.drawing.view import view_lines, view_times

        times = view_times(float(self.t[0]), float(self.t[-1]))
        lines, inks = self._lines(times)
        rotors = range(len(lines) - len(self.structure.joints), len(lines))
        return view_lines(times, lines, inks, f"{len(rotors)} rotors, {len(self.structure.bars)} bars", rotors)

    def _lines(self, times: Array) -> tuple[list[Array], list[str]]:
        """Bars, braces, rotors at the times, each (m, 2, 3) in m, and their colours."""
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
    s: Assembly,
    t: ArrayLike,
    tilt: ArrayLike | None = None,
    rates: ArrayLike | None = None,
    drive: Drive | None = None,
    ground: Drive | None = None,
    tol: float = 1e-9,
    engine: Engine = "core",
) -> StructureRun:
    """The exact motion from its start, which holds at t[0], read at the increasing times t (n,), s.

    tilt: x and y of the axes' unit vectors (N, 2), or the vectors (N, 3), upright unless given; rates: theirs, 1/s.
    Both are brought to the nearest state on the bars in the metric of the masses, which `run.axes[:, 0]` and
    `run.rates[:, 0]` show.
    drive: t → forces (N, 3) on the tips in N; ground: t → acceleration (3,) of the ground in m/s²; both smooth.
    tol: the largest error of an axis over the whole run, 1e-13 to 0.1; `run.errors` are its estimate, from two runs at two
    local errors, held to the energy where it is conserved. A LagrotorWarning says when it exceeds tol, or that the run ended
    before its last time; it then holds the times up to there. engine: "core", or "fast" with heyoka (`pip install
    lagrotor[fast]`), which takes some seconds to compile a structure, once for all spins.

    Raises InputError for what makes no sense, ConstraintError for a tilt that the bars do not allow, SingularError
    where bars and axes are in line, IntegrationError where nothing of the motion can be computed.
    """
    times, tol = check_times("simulate", t), check_tolerance(tol)
    check_engine(engine)
    shape, begin = (len(s.joints), 3), float(times[0])
    drives = [
        None if given is None else _TriedDrive(given, name, size, times)
        for given, name, size in ((drive, "drive", shape), (ground, "ground", shape[1:]))
    ]
    if engine == "fast" and any(drives):
        raise InputError("simulate: engine='fast' takes no drive and no motion of the ground: use engine='core'")
    motion = exact_motion(s, *(each and each.since(begin) for each in drives))
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
    except StopError as stop:  # at a time without unit
        for each in filter(None, drives):
            each.refuse()
        at = begin + stop.at / c.rate
        raise StopError(at, stop.reason, evaluations=stop.evaluations, cause=stop.cause) from None
    for each in filter(None, drives) if run.ending.early else ():
        each.refuse()
    run.warn_unless_kept("the structure's run", tol)
    axes, velocities = motion.axes_and_rates(run.states).swapaxes(1, 2).copy()
    return StructureRun(
        **run.run_fields | {"t": times[: len(run.t)]}, structure=s, axes=axes, rates=c.rate * velocities,
        momenta=c.G[:, None] * np.exp(-c.decay[:, None] * (run.t - begin)),
    )  # fmt: skip


def _integration(s: Assembly, motion: ExactMotion, engine: Engine) -> Integrate:
    """The integration of a stretch by what runs the structure fastest, in the time c.rate t since the start."""
    if engine == "fast" and compiled_motion.runs_by_series(motion):
        return lambda start, times, local, companion, _: compiled_motion.integrate_series(
            s, motion, start, times, local, companion
        )
    rhs = compiled_motion.compiled_right_hand_side(s, motion) if engine == "fast" else right_hand_side(motion)

    def by_steps(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        watch, begin = LineWatch(motion), float(times[0])
        problem = Problem(watch.observe(rhs), start, budget, project=motion.project, typical_rate=1.0, begin=begin)
        part = integrate(problem, times, local)
        watch.keep(float(times[-1]), part.end)
        try:
            watch.check()
        except StopError as stop:
            before = part.states[times < stop.at]
            stop.reached = Stretch(before, before[-1], part.evaluations)
            raise
        return part

    return by_steps


@dataclass
class _TriedDrive:
    """A drive, tried at the times of a run, that gives NaN where what was given fails or gives no finite array of its shape."""

    given: Drive
    name: str
    shape: tuple[int, ...]
    times: Array
    why: str = ""

    def __post_init__(self) -> None:
        if not callable(self.given):
            raise InputError(
                f"simulate: {self.name} = {self.given!r} must be a function t → array of shape {self.shape}"
            )
        for t in self.times.tolist():
            self(t)
            self.refuse()

    def __call__(self, t: float) -> Array:
        where = f"simulate: {self.name} at t = {t:g}"
        try:
            return finite_array(where, self.given(t), self.shape)
        except InputError as error:
            self.why = str(error)
        except Exception as error:
            self.why = f"{where} fails with {error!r}"
        return np.full(self.shape, np.nan)

    def since(self, begin: float) -> Drive:
        """The drive as a function of the time since `begin`."""
        return lambda t: self(begin + t)

    def refuse(self) -> None:
        """Raises InputError where it has failed."""
        if self.why:
            raise InputError(self.why) from None
