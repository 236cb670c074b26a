"""A structure's run: axes, tips, energy, bars; its plot and its film; written and read back."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.any_run import Quantity, Run, read_run
from lagrotor.pair.scene import Link, Rotor
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.exact.exact_motion import exact_motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    def spin_energy(self) -> Array:
        """Kinetic energy of the spins, G_i²/(2 I3) summed, (n,), J."""
        I3 = np.array([rotor.I3 for rotor in self.structure.rotor])
        return np.asarray((self.momenta**2 / (2 * I3[:, None])).sum(0))

    @property
    def tilt_energy(self) -> Array:
        """Kinetic energy of the tilting axes and bars, and potential energy, (n,), J."""
        return exact_motion(self.structure).energy(self.axes.swapaxes(0, 1), self.rates.swapaxes(0, 1))

    @property
    def energy(self) -> Array:
        """The whole energy, that of the spins included, (n,), J. Constant without friction and drive."""
        return self.tilt_energy + self.spin_energy

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

    def about(self) -> dict[str, Any]:
        """The structure."""
        return {"structure": asdict(self.structure)}

    @staticmethod
    def load(path: str | Path) -> "StructureRun":
        """The run that `save` wrote as `.npz`; its structure is an `Assembly`.

        Raises InputError where that is not what the file is: not whole, or not a motion of that structure.
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
        from lagrotor.structures.pictures import run_picture

        return run_picture(self.structure, self.t, self.tips, self.energy)

    def animate(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write the motion as a film, `.gif` or `.mp4`, at its own speed, axes between the samples by Hermite cubics; bars
        grey, braces green, rotors coloured by the sense of their spins.

        Raises InputError for a name, a folder or a frame rate that will not do, before anything is drawn.
        """
        from lagrotor.drawing.film import check_film, frame_times
        from lagrotor.drawing.skeleton import animate_lines
        from lagrotor.drawing.wheel import BAR, MARK, ROTORS
        from lagrotor.numerics.rotations import between_samples

        check_film(Path(path), float(self.t[-1] - self.t[0]), fps)
        times = frame_times(float(self.t[0]), float(self.t[-1]), fps)
        axes, _ = between_samples(self.t, self.axes, self.rates, times)
        c = coefficients(self.structure)
        feet = np.broadcast_to(c.feet[:, None], axes.shape)
        tips = feet + c.R[:, None, None] * axes
        bars = [np.stack([tips[i], tips[j]], 1) for i, j in zip(c.i, c.j, strict=True)]
        far = np.where(c.brace_to[:, None, None] >= 0, tips[c.brace_to], c.brace_point[:, None])
        lines = [*bars, *np.stack([far, tips[c.brace_tip]], 2), *np.stack([feet, tips], 2)]
        rotors = [BAR if spin == 0 else ROTORS[spin < 0] for spin in self.structure.spins]
        return animate_lines(path, times, lines, fps, [*[BAR] * len(bars), *[MARK] * len(far), *rotors])
