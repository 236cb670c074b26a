"""What a run of the pair leaves: the axes over time and everything read off them, the same for every model."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.run import Quantity, Run, read_run
from lagrotor.pair.scene import Link, Rotor, Scene, Shock
from lagrotor.result_display import scientific

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from lagrotor.drawing.film import FilmedMotion
    from lagrotor.drawing.view import View


# How far the length of a stored axis may be off one: what the loosest tolerances leave.
UNIT_ERROR = 1e-3

UNITS = {
    "axes": "1",
    "rates": "1/s",
    "tips": "m",
    "energy": "J",
    "link_length": "m",
    "momenta": "kg m²/s",
    "P": "kg m²/s",
}
_AXES = {3: ("rotor", "t", "component"), 2: ("rotor", "t"), 1: ("t",)}


def tilting_energy(scene: Scene, rates: Array) -> Array:
    """a/2 (|r_1'|² + |r_2'|²) + b r_1'·r_2' of rates (2, n, 3), (n,), in J."""
    a, b = scene.inertias
    v1, v2 = rates
    return np.asarray(a / 2 * ((v1**2).sum(-1) + (v2**2).sum(-1)) + b * (v1 * v2).sum(-1))


def momentum_about_joints(scene: Scene, axes: Array, rates: Array, momenta: Array) -> Array:
    """Angular momentum about the line through the ground joints, (n,), in kg m²/s."""
    a, b = scene.inertias
    (r1, r2), (v1, v2) = axes, rates
    turning = np.cross(r1, a * v1 + b * v2) + np.cross(r2, a * v2 + b * v1)
    return np.asarray(turning[:, 0] + momenta[0] * r1[:, 0] + momenta[1] * r2[:, 0])


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Trajectory(Run):
    """A run of a scene by a model: why it was chosen is a sentence.

    axes, rates (2, n, 3): unit vectors r_i and r_i' (1/s); momenta (2, n): G_i, axial (kg m²/s). errors: of an axis (tips: in
    units of R).
    """

    scene: Scene
    model: str
    why: str
    axes: Array
    rates: Array
    momenta: Array

    @property
    def joints(self) -> Array:
        """Ground joints, (2, 3), in m."""
        half = (self.scene.link.length if self.scene.link else self.scene.rotor.length) / 2
        return np.array([[-half, 0.0, 0.0], [half, 0.0, 0.0]])

    @property
    def tips(self) -> Array:
        """Tips of the rotors, (2, n, 3), in m."""
        return self.joints[:, None, :] + self.scene.rotor.length * self.axes

    @property
    def link_length(self) -> Array:
        """Distance of the tips, (n,), in m: the bar's length, constant on the exact pair."""
        return np.linalg.norm(self.tips[1] - self.tips[0], axis=-1)

    @property
    def energy(self) -> Array:
        """Kinetic energy a/2 (|r_1'|² + |r_2'|²) + b r_1'.r_2' + (G_1² + G_2²)/(2 I_3), (n,), in J."""
        return tilting_energy(self.scene, self.rates) + (self.momenta**2).sum(0) / (2 * self.scene.rotor.I3)

    @property
    def joint_line_momentum(self) -> Array:
        """Angular momentum about the line through the ground joints, (n,), in kg m²/s: conserved but for the shock."""
        return momentum_about_joints(self.scene, self.axes, self.rates, self.momenta)

    @property
    def invariants(self) -> dict[str, Array]:
        """What the motion conserves, name → (n,): the two axial momenta and the momentum about the joint line."""
        return {"G_1": self.momenta[0], "G_2": self.momenta[1], "P": self.joint_line_momentum}

    @property
    def inclinations(self) -> Array:
        """Inclinations theta_i, (2, n), in rad."""
        return np.arctan2(np.hypot(self.axes[..., 0], self.axes[..., 1]), self.axes[..., 2])

    @property
    def azimuths(self) -> Array:
        """Azimuths phi_i of the axes, unwrapped, (2, n), in rad."""
        return np.unwrap(np.arctan2(self.axes[..., 1], self.axes[..., 0]), axis=-1)

    def plot(self) -> "Figure":
        """A figure that a notebook shows: tips over time and from above, energy over time; `.savefig(path)` writes it."""
        from lagrotor.drawing.run_figure import run_figure

        title = f"spins {self.scene.spins[0]:g} and {self.scene.spins[1]:g} rad/s, model {self.model}".replace("-", "−")
        return run_figure(self.t, self.tips, self.energy, title)

    def animate(self, path: str | Path, fps: float = 25.0, step: Callable[[str], None] = lambda name: None) -> Path:
        """Write the motion as a film.

        Parameters
        ----------
        path : str or Path
            A `.gif`.
        fps : float, default 25.0
            Pictures per second.
        step : callable, default lambda name: None
            Called with each second of the film as it begins.
        """
        from lagrotor.drawing.film import animate_lines, check_film, frame_times

        check_film(path, float(self.t[-1] - self.t[0]), fps)
        times = frame_times(self.t[0], self.t[-1], fps)
        lines, inks, traced = self.motion(times).lines()
        return animate_lines(path, times, lines, fps, inks, traced, step)

    def view(self) -> "View":
        """The motion as a page that a notebook shows, turned by hand and played, without a network; `.save("run.html")`."""
        from lagrotor.drawing.view import view_lines, view_times

        times = view_times(self.t[0], self.t[-1])
        spins = f"spins {self.scene.spins[0]:g} and {self.scene.spins[1]:g} rad/s".replace("-", "−")
        lines, inks, traced = self.motion(times).lines()
        return view_lines(times, lines, inks, spins, traced)

    def motion(self, times: Array) -> "FilmedMotion":
        """What a film draws at `times` (m,) in s: axes by Hermite cubics, the bodies turned along samples and frames."""
        from lagrotor.drawing.film import FilmedMotion
        from lagrotor.numerics.rotations import between_samples, body_rotations

        dense = np.union1d(self.t, times)
        axes, rates = between_samples(self.t, self.axes, self.rates, dense)
        at = np.searchsorted(dense, times)
        rotations = body_rotations(dense, axes, rates, self.momenta[:, 0] / self.scene.rotor.I3)[:, at]
        length, feet = self.scene.rotor.length, self.joints[:, None, :]
        tips, joined = feet + length * axes[:, at], self.scene.link is not None
        centres = feet + length / 2 * axes[:, at]
        return FilmedMotion(times, rotations, tips, centres, self.joints, length, joined)

    def summary(self) -> dict[str, str]:
        """What the run is and how well it kept what it should keep, name → words."""
        first, last = float(self.energy[0]), float(self.energy[-1])
        return (
            self.scene.summary()
            | {"model": f"{self.model}: {self.why}"}
            | super().summary()
            | {
                "energy, first to last [J]": f"{first:.9g} to {last:.9g}",
                "bar's length, spread [m]": scientific(float(np.ptp(self.link_length)), 1)
                if self.scene.link
                else "none",
            }
        )

    def quantities(self) -> dict[str, Quantity]:
        """axes, rates, tips, energy, link_length, momenta, and P, the momentum about the joint line."""
        held = {name: getattr(self, name) for name in UNITS if name != "P"} | {"P": self.joint_line_momentum}
        return {name: Quantity(values, _AXES[values.ndim], UNITS[name]) for name, values in held.items()}

    def _about(self) -> dict[str, Any]:
        """The scene, the model and why it was chosen."""
        return {"scene": asdict(self.scene), "model": self.model, "why": self.why}

    @staticmethod
    def load(path: str | Path) -> "Trajectory":
        """The run that `save` wrote as `.npz`.

        Raises
        ------
        InputError
            Where that is not what the file is: not whole, or not a motion (times that decrease, axes that are
            no unit vectors, numbers that are not finite).
        """
        about, held, known = read_run(path)
        try:
            given = about["scene"]
            parts = {"rotor": Rotor, "link": Link, "shock": Shock}
            given |= {name: kind(**given[name]) for name, kind in parts.items() if given[name] is not None}
            axes, rates, momenta = (held[name] for name in ("axes", "rates", "momenta"))
            scene, model, why = Scene(**given), about["model"], about["why"]
        except (KeyError, TypeError, AttributeError, ValueError) as refusal:
            raise InputError(
                f"load: {path} is no run saved as .npz ({refusal}): give a file that `save` wrote"
            ) from None
        wrong = _wrong(known["t"], axes, rates, momenta)
        if not (isinstance(model, str) and isinstance(why, str)):
            wrong = "its model is none"
        if wrong:
            raise InputError(f"load: {path} is no run: {wrong}: give a file that `save` wrote")
        return Trajectory(scene=scene, model=model, why=why, axes=axes, rates=rates, momenta=momenta, **known)


def _wrong(t: Array, axes: Array, rates: Array, momenta: Array) -> str | None:
    """What keeps these from being a motion, in words; None where nothing does."""
    n = len(t) if t.ndim == 1 else 0
    wanted = ((t, (n,)), (axes, (2, n, 3)), (rates, (2, n, 3)), (momenta, (2, n)))
    if not n or any(part.shape != shape for part, shape in wanted):
        return f"t {t.shape}, axes {axes.shape}, rates {rates.shape}, momenta {momenta.shape} do not fit together"
    if not all(np.isfinite(part).all() for part, _ in wanted):
        return "some of its numbers are not finite"
    if np.abs(np.linalg.norm(axes, axis=-1) - 1).max() > UNIT_ERROR:
        return "its axes are no unit vectors"
    return None


def ansatz_A(run: Trajectory) -> Array:
    """A = p_phi1 − p_phi2 along a run, (n,), in kg m²/s: the paper's integral (5.12), the bar's inertia included."""
    a, b = run.scene.inertias
    (r1, r2), (v1, v2) = run.axes, run.rates
    about_z = np.cross(r1, a * v1 + b * v2)[:, 2] - np.cross(r2, a * v2 + b * v1)[:, 2]
    return about_z + run.momenta[0] * r1[:, 2] - run.momenta[1] * r2[:, 2]
