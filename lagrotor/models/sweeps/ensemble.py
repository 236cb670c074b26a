"""The trajectories of many scenes as arrays."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import InputError
from lagrotor.models.model import constant_momenta
from lagrotor.models.sweeps.chunk import MODELS
from lagrotor.models.sweeps.dataset import dataset_of
from lagrotor.models.sweeps.endings import Endings
from lagrotor.numerics.error_estimate import first_time
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import Array
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.result_display import Shown, scientific


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Shown):
    """The trajectories of n scenes at m times.

    Attributes
    ----------
    scenes : Sequence of Scene
        The scenes.
    t : Array
        The times, (m,), s.
    axes : Array
        The unit vectors of the axes, (n, 2, m, 3); NaN after the end of a run.
    rates : Array
        The rates of the axes, (n, 2, m, 3), 1/s; NaN after the end of a run.
    errors : Array
        The estimated largest error of an axis up to each time, (n, m); NaN after the end of a run.
    tol : float
        The tolerance.
    evaluations : Array
        The number of evaluations of each run, (n,).
    models : Array
        Indices into MODELS, (n,). "spheres" ran scenes without a bar or near a singular position. "none" means that
        the run ended before the first time.
    endings : Sequence of Ending
        The reason for which each run ended.
    """

    scenes: Sequence[Scene]
    t: Array
    axes: Array
    rates: Array
    errors: Array
    tol: float
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]
    endings: Sequence[Ending]

    def summary(self) -> dict[str, str]:
        """Return the number of runs, their models and errors in words.

        Returns
        -------
        dict
            The rows of the table.
        """
        by_model = {name: int((self.models == i).sum()) for i, name in enumerate(MODELS)}
        return {
            "runs": str(len(self.scenes)),
            "times": f"{len(self.t)}, from {self.t[0]:g} to {self.t[-1]:g} s",
            "models": ", ".join(f"{count} by {name}" for name, count in by_model.items() if count),
            "evaluations": f"{int(self.evaluations.sum()):,}",
            "largest estimated error": scientific(float(np.nanmax(self.error, initial=0.0)), 1),
            "failed": str(len(self.failed)),
        }

    @property
    def error(self) -> Array:
        """The estimated largest error of an axis over each run, (n,); NaN for a run that ended early."""
        return self.errors[:, -1]

    @property
    def failed(self) -> NDArray[np.int64]:
        """The indices of the runs that ended early."""
        return np.flatnonzero(Endings.of(self.endings).early)

    def __len__(self) -> int:
        return len(self.scenes)

    def __iter__(self) -> Iterator[Trajectory]:
        return map(self.trajectory, range(len(self)))

    def to_xarray(self) -> Any:
        """Return the runs with their scenes as a labelled dataset.

        Returns
        -------
        xarray.Dataset
            The columns over run, rotor, t and component; xarray must be installed. Those of a folder are arrays of dask, which
            must be installed too.
        """
        return dataset_of(self, MODELS)

    def trajectory(self, i: int) -> Trajectory:
        """Return one run up to its end.

        Parameters
        ----------
        i : int
            The number of the scene.

        Returns
        -------
        Trajectory
            The run.
        """
        n = int(np.isfinite(self.errors[i]).sum())
        if not n:
            raise InputError(f"trajectory: the run of scene {i} ended before the first time of t: {self.endings[i]}")
        scene, errors, name = self.scenes[i], self.errors[i, :n], MODELS[self.models[i]]
        return Trajectory(
            scene=scene, model=name, why="one of an ensemble", t=self.t[:n], axes=self.axes[i, :, :n], rates=self.rates[i, :, :n],
            momenta=constant_momenta(scene, n), errors=errors, horizon=first_time(self.t[:n], errors > self.tol),
            evaluations=int(self.evaluations[i]), ending=self.endings[i],
        )  # fmt: skip
