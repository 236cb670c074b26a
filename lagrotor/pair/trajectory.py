"""The trajectory of the pair: the axes over time and the quantities computed from them, the same for every model."""

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


# The largest error of the length of a stored axis, reached at the loosest tolerances.
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


Inertias = tuple[float | Array, float | Array]


def tilting_energy(inertias: Inertias, rates: Array) -> Array:
    """Return the energy a/2 (|r_1'|² + |r_2'|²) + b r_1'·r_2' in J, shape (…), for rates of shape (2, …, 3) and inertias (a, b)
    that broadcast with it."""
    (a, b), (v1, v2) = inertias, rates
    return np.asarray(a / 2 * ((v1**2).sum(-1) + (v2**2).sum(-1)) + b * (v1 * v2).sum(-1))


def momentum_about_joints(inertias: Inertias, axes: Array, rates: Array, momenta: Array) -> Array:
    """Return the angular momentum about the line through the ground joints in kg m²/s, shape (…), for axes and rates of shape
    (2, …, 3), and inertias (a, b) and two axial momenta that broadcast with it."""
    (a, b), (G_1, G_2) = inertias, momenta
    (x_1, y_1, z_1), (x_2, y_2, z_2) = np.moveaxis(axes, -1, 1)
    (_, y_v1, z_v1), (_, y_v2, z_v2) = np.moveaxis(rates, -1, 1)
    turning = y_1 * (a * z_v1 + b * z_v2) - z_1 * (a * y_v1 + b * y_v2)
    turning = turning + y_2 * (a * z_v2 + b * z_v1) - z_2 * (a * y_v2 + b * y_v1)
    return np.asarray(turning + G_1 * x_1 + G_2 * x_2)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Trajectory(Run):
    """The result of `simulate`: the motion of a scene by a model.

    Attributes
    ----------
    scene : Scene
        The scene.
    model : str
    why : str
        The model and the reason why it was chosen.
    axes : ndarray
    rates : ndarray
        The unit vectors r_i and their derivatives (1/s), shape (2, n, 3).
    momenta : ndarray
        The axial angular momenta G_i in kg m²/s, shape (2, n).
    t : ndarray
    errors : ndarray
    horizon : float
    evaluations : int
    ending : Ending
        The fields of `Run`. The errors are those of an axis, which equal the errors of a tip in units of R.

    Examples
    --------
    >>> from lagrotor import Scene, simulate
    >>> run = simulate(Scene((10, -10)), [0, 1, 2])
    >>> run.model, run.tips.shape
    ('closed_form', (2, 3, 3))
    >>> run.energy, run.link_length, sorted(run.invariants)
    (array([100., 100., 100.]), array([1., 1., 1.]), ['G_1', 'G_2', 'P'])
    """

    scene: Scene
    model: str
    why: str
    axes: Array
    rates: Array
    momenta: Array

    @property
    def joints(self) -> Array:
        """The ground joints, shape (2, 3), in m."""
        half = (self.scene.link.length if self.scene.link else self.scene.rotor.length) / 2
        return np.array([[-half, 0.0, 0.0], [half, 0.0, 0.0]])

    @property
    def tips(self) -> Array:
        """The tips of the rotors, shape (2, n, 3), in m."""
        return self.joints[:, None, :] + self.scene.rotor.length * self.axes

    @property
    def link_length(self) -> Array:
        """The distance between the tips, shape (n,), in m. With a bar it equals the bar's length, up to the error of the run."""
        return np.linalg.norm(self.tips[1] - self.tips[0], axis=-1)

    @property
    def energy(self) -> Array:
        """The kinetic energy a/2 (|r_1'|² + |r_2'|²) + b r_1'.r_2' + (G_1² + G_2²)/(2 I_3), shape (n,), in J."""
        return tilting_energy(self.scene.inertias, self.rates) + (self.momenta**2).sum(0) / (2 * self.scene.rotor.I3)

    @property
    def joint_line_momentum(self) -> Array:
        """The angular momentum about the line through the joints, shape (n,), in kg m²/s; only the shock changes it."""
        return momentum_about_joints(self.scene.inertias, self.axes, self.rates, self.momenta)

    @property
    def invariants(self) -> dict[str, Array]:
        """The conserved quantities by name, each of shape (n,): G_1, G_2 and P, the momentum about the joint line."""
        return {"G_1": self.momenta[0], "G_2": self.momenta[1], "P": self.joint_line_momentum}

    @property
    def inclinations(self) -> Array:
        """The inclinations theta_i, shape (2, n), in rad."""
        return np.arctan2(np.hypot(self.axes[..., 0], self.axes[..., 1]), self.axes[..., 2])

    @property
    def azimuths(self) -> Array:
        """The azimuths phi_i of the axes, unwrapped, shape (2, n), in rad."""
        return np.unwrap(np.arctan2(self.axes[..., 1], self.axes[..., 0]), axis=-1)

    def plot(self) -> "Figure":
        """Draw the tips over time and from above, and the energy over time.

        Returns
        -------
        Figure
            A figure that a notebook shows; `.savefig(path)` writes it.
        """
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
            Called with a text at the start of each second of the film.

        Returns
        -------
        Path
            The file.
        """
        from lagrotor.drawing.film import animate_lines, check_film, frame_times

        check_film(path, float(self.t[-1] - self.t[0]), fps)
        times = frame_times(self.t[0], self.t[-1], fps)
        lines, inks, traced = self.motion(times).lines()
        return animate_lines(path, times, lines, fps, inks, traced, step)

    def view(self) -> "View":
        """Draw the motion as a page that a notebook shows, to be turned and played without a network.

        Returns
        -------
        View
            The page; `.save("run.html")` writes it.
        """
        from lagrotor.drawing.view import view_lines, view_times

        times = view_times(self.t[0], self.t[-1])
        spins = f"spins {self.scene.spins[0]:g} and {self.scene.spins[1]:g} rad/s".replace("-", "−")
        lines, inks, traced = self.motion(times).lines()
        return view_lines(times, lines, inks, spins, traced)

    def motion(self, times: Array) -> "FilmedMotion":
        """Interpolate the motion for a film by Hermite cubics of the axes.

        Parameters
        ----------
        times : ndarray
            The times of the pictures in s, shape (m,).

        Returns
        -------
        FilmedMotion
            Rotations, tips and centres at these times.
        """
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
        """Return the scene, the model and the errors of the invariants in words.

        Returns
        -------
        dict of str
            {name: description in words}.
        """
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
        """Return axes, rates, tips, energy, link_length, momenta and the momentum P about the joint line.

        Returns
        -------
        dict of Quantity
            {name: its values, the names of the array's dimensions, and its unit}.
        """
        arrays = {name: getattr(self, name) for name in UNITS if name != "P"} | {"P": self.joint_line_momentum}
        return {name: Quantity(values, _AXES[values.ndim], UNITS[name]) for name, values in arrays.items()}

    def _about(self) -> dict[str, Any]:
        """Return the scene, the model and the reason why it was chosen."""
        return {"scene": asdict(self.scene), "model": self.model, "why": self.why}

    @staticmethod
    def load(path: str | Path) -> "Trajectory":
        """Read a run that `save` wrote.

        Parameters
        ----------
        path : str or Path
            An `.npz`.

        Returns
        -------
        Trajectory
            The run.

        Raises
        ------
        InputError
            If the file is damaged or no motion: decreasing times, axes that are no unit vectors, numbers that are not finite.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> from lagrotor import Scene, simulate
        >>> with TemporaryDirectory() as folder:
        ...     Trajectory.load(simulate(Scene((10, -10)), [0, 1]).save(f"{folder}/run.npz")).scene.spins
        (10.0, -10.0)
        """
        about, arrays, run_fields = read_run(path)
        try:
            fields = about["scene"]
            kinds = {"rotor": Rotor, "link": Link, "shock": Shock}
            fields |= {name: kind(**fields[name]) for name, kind in kinds.items() if fields[name] is not None}
            axes, rates, momenta = (arrays[name] for name in ("axes", "rates", "momenta"))
            scene, model, why = Scene(**fields), about["model"], about["why"]
        except (KeyError, TypeError, AttributeError, ValueError) as refusal:
            raise InputError(
                f"load: {path} is no run saved as .npz ({refusal}): give a file that `save` wrote"
            ) from None
        wrong = _wrong(run_fields["t"], axes, rates, momenta)
        if not (isinstance(model, str) and isinstance(why, str)):
            wrong = "its model or the reason for that is no text"
        if wrong:
            raise InputError(f"load: {path} is no run: {wrong}: give a file that `save` wrote")
        return Trajectory(scene=scene, model=model, why=why, axes=axes, rates=rates, momenta=momenta, **run_fields)


def _wrong(t: Array, axes: Array, rates: Array, momenta: Array) -> str | None:
    """Return the reason in words why these arrays are no motion; None if they are one."""
    n = len(t) if t.ndim == 1 else 0
    shapes = ((t, (n,)), (axes, (2, n, 3)), (rates, (2, n, 3)), (momenta, (2, n)))
    if not n or any(array.shape != shape for array, shape in shapes):
        return f"t {t.shape}, axes {axes.shape}, rates {rates.shape}, momenta {momenta.shape} do not fit together"
    if not all(np.isfinite(array).all() for array, _ in shapes):
        return "some of its numbers are not finite"
    if np.abs(np.linalg.norm(axes, axis=-1) - 1).max() > UNIT_ERROR:
        return "its axes are no unit vectors"
    return None


def ansatz_A(run: Trajectory) -> Array:
    """Return the paper's integral (5.12), A = p_phi1 − p_phi2, along a run, with the bar's inertia.

    The integral B of the paper is G_1 − G_2, run.momenta[0] − run.momenta[1].

    Parameters
    ----------
    run : Trajectory
        The run.

    Returns
    -------
    ndarray
        A in kg m²/s, shape (n,).
    """
    a, b = run.scene.inertias
    (r1, r2), (v1, v2) = run.axes, run.rates
    about_z = np.cross(r1, a * v1 + b * v2)[:, 2] - np.cross(r2, a * v2 + b * v1)[:, 2]
    return about_z + run.momenta[0] * r1[:, 2] - run.momenta[1] * r2[:, 2]
