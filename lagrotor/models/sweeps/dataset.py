"""The runs of a sweep as a labelled dataset of xarray, whose files are read by dask."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.sweeps.column_names import FLAT
from lagrotor.models.sweeps.endings import KINDS
from lagrotor.numerics.run import optional_package

_BLOCK = 2**23  # bytes of a block that dask reads at once
_UNITS = {"mass": "kg", "length": "m", "force": "N", "at": "s", "width": "s", "body": "1"}


@dataclass(frozen=True)
class _OnDisk:
    """A memory map that is opened where it is read: dask sends the name of the file to a worker, and not the numbers."""

    path: str
    offset: int
    dtype: np.dtype[Any]
    shape: tuple[int, ...]

    @property
    def ndim(self) -> int:
        return len(self.shape)

    def __getitem__(self, key: Any) -> NDArray[Any]:
        return np.array(np.memmap(self.path, self.dtype, "r", self.offset, self.shape)[key])


def _lazy(array: NDArray[Any]) -> Any:
    """Return a memory map as an array of dask, and any other array as it is."""
    if not isinstance(array, np.memmap) or array.filename is None:
        return array
    optional_package("dask")
    dask_array, rows = optional_package("dask.array"), max(1, _BLOCK * len(array) // array.nbytes)
    file = _OnDisk(str(array.filename), array.offset, array.dtype, array.shape)
    return dask_array.from_array(file, chunks=(rows, *array.shape[1:]))


def dataset_of(runs: Any, models: tuple[str, ...]) -> Any:
    """Return the xarray.Dataset of an Ensemble, with the scenes as variables."""
    xarray, scenes, endings, run = optional_package("xarray"), runs.scenes.columns, runs.endings, ("run",)
    still, moving = ("run", "rotor", "component"), ("run", "rotor", "t", "component")
    rows = (
        ("spins", ("run", "rotor"), scenes.spins, "rad/s"), ("initial_axes", still, scenes.axes, "1"),
        ("initial_rates", still, scenes.rates, "1/s"), ("axes", moving, runs.axes, "1"), ("rates", moving, runs.rates, "1/s"),
        ("errors", ("run", "t"), runs.errors, "1"), ("evaluations", run, runs.evaluations, "1"),
        ("ending_time", run, endings.times, "s"),
    )  # fmt: skip
    variables: dict[str, Any] = {
        name: (dimensions, _lazy(values), {"units": unit}) for name, dimensions, values, unit in rows
    }
    for part in ("rotor", "link", "shock"):
        columns = _lazy(getattr(scenes, part))
        for i, name in enumerate(FLAT[part]):
            variables[name] = (run, columns[:, i], {"units": _UNITS.get(name.split("_")[1], "kg m²")})
    for name, codes, meanings in (("model", runs.models, models), ("ending", endings.kinds, KINDS)):
        flags = {"flag_values": list(range(len(meanings))), "flag_meanings": " ".join(meanings)}
        variables[name] = (run, _lazy(codes), flags)
    places = {"t": ("t", runs.t, {"units": "s"}), "rotor": [1, 2], "component": ["x", "y", "z"]}
    return xarray.Dataset(variables, coords=places, attrs={"tol": runs.tol})
