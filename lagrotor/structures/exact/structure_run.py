"""A structure's run: axes, tips, energy, bars; its plot and its film."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lagrotor.shown import Shown, scientific
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.exact.exact_motion import exact_motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class StructureRun(Shown):
    """Times t (n,) in s, axes r_i and rates r_i' (N, n, 3), 1/s.

    error: the estimated largest error of an axis; nfev: evaluations of the right-hand side, of all runs.
    """

    structure: Assembly
    t: Array
    axes: Array
    rates: Array
    error: float
    nfev: int

    def summary(self) -> dict[str, str]:
        """The structure, the times, and how well the run is known, name → words."""
        s, energy = self.structure, self.energy
        return {
            "structure": f"{len(s.joints)} rotors, {len(s.bars)} bars",
            "times": f"{len(self.t)}, 0 to {self.t[-1]:g} s",
            "estimated error of an axis": scientific(self.error, 1),
            "energy [J]": f"{energy[0]:.6g} at first, {energy[-1]:.6g} at last",
            "evaluations": str(self.nfev),
        }

    @property
    def tips(self) -> Array:
        """Positions of the tips, (N, n, 3), m."""
        c = coefficients(self.structure)
        return np.asarray(c.feet[:, None] + c.R[:, None, None] * self.axes)

    @property
    def energy(self) -> Array:
        """Kinetic and potential energy, (n,), J; the spins' own energy left out. Constant without friction and drive."""
        return exact_motion(self.structure).energy(self.axes.swapaxes(0, 1), self.rates.swapaxes(0, 1))

    @property
    def bar_length(self) -> Array:
        """Lengths of the bars, (B, n), m."""
        c = coefficients(self.structure)
        return np.asarray(np.linalg.norm(self.tips[c.j] - self.tips[c.i], axis=-1))

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
