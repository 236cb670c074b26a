"""`Run`, the base class of every simulated motion: times, error estimate, horizon, ending, files and tables."""

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields, replace
from importlib import import_module
from itertools import product
from math import inf
from pathlib import Path
from typing import Any, Literal, NamedTuple, Self

import numpy as np

from lagrotor.errors import InputError
from lagrotor.files import FILMS, PICTURES, path_of, read_arrays, write_arrays, write_beside, write_text
from lagrotor.numerics.arrays import Array
from lagrotor.result_display import Shown, scientific

_SAYS = {
    "end": "the last time was reached",
    "lost": "the last time was reached, but neighbouring motions separate: the states are unknown",
    "budget": "its evaluations are spent",
    "singular": "a singular position was reached",
    "event": "an event ends it",
    "stopped": "the solver cannot go on",
}


@dataclass(frozen=True)
class Ending:
    """The ending of a run: its kind, one of _SAYS, the time `at` in s if it differs from the last time, and a reason in words."""

    kind: Literal["end", "lost", "budget", "singular", "event", "stopped"] = "end"
    at: float = inf
    reason: str = ""

    def __post_init__(self) -> None:
        valid = isinstance(self.at, float) and self.at == self.at and type(self.reason) is str
        if self.kind not in _SAYS or not valid:
            raise InputError(f"Ending: {self.kind!r} at {self.at!r} for {self.reason!r} is no valid ending")

    @property
    def early(self) -> bool:
        """True if the run ended before its last time."""
        return self.kind not in ("end", "lost")

    def __str__(self) -> str:
        at = (
            f" from t = {self.at:.6g} s on" if self.kind == "lost" else f" at t = {self.at:.6g} s" if self.early else ""
        )
        return _SAYS[self.kind] + at + (f": {self.reason}" if self.reason else "")


class Quantity(NamedTuple):
    """A quantity of a run: its values, the name of each axis of their array, one of them "t", and its unit."""

    values: Array
    axes: tuple[str, ...]
    unit: str


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Run(Shown):
    """A simulated motion at the times that were reached.

    Attributes
    ----------
    t : Array
        Times in s, shape (n,); the initial state holds at t[0].
    errors : Array
        Estimated largest error up to each time, relative to the size of the state, shape (n,); NaN if it is not known.
    horizon : float
        The time in s from which the errors exceed the tolerance; inf if they never do.
    evaluations : int
        Evaluations of the right-hand side in all integrations.
    ending : Ending
        The reason why the run ended where it did.
    """

    t: Array
    errors: Array
    horizon: float = inf
    evaluations: int = 0
    ending: Ending = Ending()

    @property
    def error(self) -> float:
        """The estimated largest error over the run, relative to the size of the state."""
        return float(self.errors[-1]) if len(self.errors) else 0.0

    @property
    @abstractmethod
    def energy(self) -> Array:
        """The sum of kinetic and potential energy in J, shape (n,). The kinetic energy includes that of the spins."""

    @abstractmethod
    def quantities(self) -> Mapping[str, Quantity]:
        """Return the state and the derived quantities by name, as they are saved and tabulated."""

    @abstractmethod
    def plot(self) -> Any:
        """Draw a figure that a notebook shows; `.savefig(path)` writes it."""

    @abstractmethod
    def animate(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write the run as a film to a .gif file, and return its path."""

    def summary(self) -> dict[str, str]:
        """Summarise the number of times, the evaluations, the error and the ending in words, by name."""
        n, error = len(self.t), self.error
        return {
            "times": f"{n}, from {self.t[0]:g} to {self.t[-1]:g} s" if n else "none",
            "evaluations": f"{self.evaluations:,}",
            "estimated error": "not known" if np.isnan(error) else scientific(error, 1),
            "ending": str(self.ending),
        }

    def _about(self) -> dict[str, Any]:
        """Return the entries that `save` writes as JSON with the arrays."""
        return {}

    def _columns(self) -> Iterator[tuple[str, Array, str]]:
        """Yield the name, the values (n,) and the unit of each component."""
        for name, quantity in self.quantities().items():
            values = np.moveaxis(quantity.values, quantity.axes.index("t"), -1)
            others = [axis for axis in quantity.axes if axis != "t"]
            labels = [_labels(axis, size) for axis, size in zip(others, values.shape[:-1], strict=True)]
            for at, label in zip(np.ndindex(*values.shape[:-1]), product(*labels), strict=True):
                yield "_".join([name, *map(str, label)]), values[at], quantity.unit

    def after(self, begin: float) -> Self:
        """Return the part of the run from a time on.

        Parameters
        ----------
        begin : float
            The time in s.

        Returns
        -------
        Self
            A run at the times t ≥ begin.

        Raises
        ------
        InputError
            If the run ends before `begin`.

        Examples
        --------
        >>> from lagrotor import Scene, simulate
        >>> simulate(Scene(spins=(10, -10)), [0, 1, 2]).after(0.5).t
        array([1., 2.])
        """
        if isinstance(begin, bool) or not isinstance(begin, int | float | np.number) or begin != begin:
            raise InputError(f"after: begin = {begin!r} must be a time in s")
        check_nonempty("after", self.t)
        i, quantities = int(np.searchsorted(self.t, begin)), self.quantities()
        if i == len(self.t):
            raise InputError(f"after: the run ends at t = {self.t[-1]:g} s, before {begin:g} s")
        sampled = ((item.name, quantities[item.name]) for item in fields(self) if item.name in quantities)
        slices: dict[str, Any] = {
            name: q.values[(slice(None),) * q.axes.index("t") + (slice(i, None),)] for name, q in sampled
        }
        return replace(self, t=self.t[i:], errors=self.errors[i:], **slices)

    def to_dataframe(self) -> Any:
        """Return the run as a table with one column for each component.

        Returns
        -------
        pandas.DataFrame
            The table, indexed by t in s; pandas must be installed.
        """
        pandas = optional_package("pandas")
        return pandas.DataFrame(
            {name: values for name, values, _ in self._columns()}, index=pandas.Index(self.t, name="t")
        )

    def to_xarray(self) -> Any:
        """Return the run as a labelled dataset, each variable with its unit.

        Returns
        -------
        xarray.Dataset
            The variables over t in s and the other axes of the quantities; xarray must be installed.
        """
        xarray, quantities = optional_package("xarray"), self.quantities()
        places: dict[str, Any] = {"t": ("t", self.t, {"units": "s"})}
        for quantity in quantities.values():
            sizes = zip(quantity.axes, quantity.values.shape, strict=True)
            places |= {axis: _labels(axis, size) for axis, size in sizes if axis != "t"}
        variables = {name: (q.axes, q.values, {"units": q.unit}) for name, q in quantities.items()}
        attributes = {name: value for name, value in self._about().items() if isinstance(value, str)}
        return xarray.Dataset(variables, coords=places, attrs=attributes | {"ending": str(self.ending)})

    def save(self, path: str | Path) -> Path:
        """Write the run to a file; the ending of its name chooses the format.

        A .npz file holds the times, the errors, every quantity, and a description as JSON with a digest; `load` of the same
        class reads it back. A .csv file has a column for each component. A .png, .svg or .pdf file holds the figure of `plot`,
        and a .gif file the film of `animate`.

        Parameters
        ----------
        path : str or Path
            The file name.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            If the name has another ending.

        Examples
        --------
        >>> from tempfile import gettempdir
        >>> from lagrotor import Scene, simulate
        >>> simulate(Scene(spins=(10, -10)), [0, 1, 2]).save(gettempdir() + "/run.csv").name
        'run.csv'
        """
        target = path_of("save: path", path)
        if target.suffix == ".npz":
            check_nonempty("save", self.t)
            outcome = {"horizon": self.horizon, "evaluations": self.evaluations, "ending": asdict(self.ending)}
            arrays = {name: quantity.values for name, quantity in self.quantities().items()}
            return write_arrays(target, self._about() | outcome, {"t": self.t, "errors": self.errors} | arrays)
        if target.suffix == ".csv":
            table = {"t [s]": self.t} | {
                f"{name} [{unit}]" if unit else name: values for name, values, unit in self._columns()
            }
            rows = (",".join(map(repr, row)) for row in np.column_stack(list(table.values())).tolist())
            return write_text(target, "\n".join([",".join(table), *rows, ""]))
        if target.suffix in PICTURES:
            return write_beside(target, lambda file: self.plot().savefig(file, format=target.suffix[1:]))
        if target.suffix in FILMS:
            return self.animate(target)
        raise InputError(f"save: {target.name} must end in .npz, .csv, {', '.join((*PICTURES, *FILMS))}")


def check_nonempty(where: str, t: Array) -> None:
    """Raise InputError for a run without times."""
    if not len(t):
        raise InputError(
            f"{where}: the run has no times, for example because no section is crossed: take a run with times"
        )


class Saved(NamedTuple):
    """The contents of a file that `Run.save` wrote. The entries `about` and the arrays belong to the class of the run; `fields`
    are those of `Run`."""

    about: dict[str, Any]
    arrays: dict[str, Array]
    fields: dict[str, Any]


def read_run(path: str | Path) -> Saved:
    """Read a run from an .npz file that `save` wrote, and check the fields of `Run`. Raise InputError if it is another file or
    incomplete, its times decrease, or its errors, evaluations or ending are invalid."""
    about, arrays = read_arrays(path_of("load: path", path))
    try:
        t, errors = arrays.pop("t"), arrays.pop("errors")
        horizon, evaluations, ending = (about.pop(name) for name in ("horizon", "evaluations", "ending"))
        end = Ending(**ending)
    except (KeyError, TypeError, InputError) as refusal:
        raise InputError(f"load: {path} is no run saved as .npz ({refusal}): give a file that `save` wrote") from None
    wrong = None
    if t.ndim != 1 or not len(t) or errors.shape != t.shape:
        wrong = f"t {t.shape} and errors {errors.shape} do not fit together"
    elif not np.isfinite(t).all() or (np.diff(t) < 0).any():  # crossings on an impact's gap have two states at one time
        wrong = "its times decrease"
    elif type(evaluations) is not int or evaluations < 0:
        wrong = "its number of evaluations is no count"
    elif type(horizon) is not float or (errors < 0).any():
        wrong = "its errors are negative, or its horizon is no number"
    if wrong:
        raise InputError(f"load: {path} is no run: {wrong}: give a file that `save` wrote")
    return Saved(
        about, arrays, {"t": t, "errors": errors, "horizon": horizon, "evaluations": evaluations, "ending": end}
    )


def _labels(axis: str, size: int) -> list[Any]:
    """Return the labels of the components along an axis: x, y, z for the axis "component", otherwise numbers from 1 on."""
    return list("xyz"[:size]) if axis == "component" else list(range(1, size + 1))


def optional_package(name: str) -> Any:
    """Import an optional package, or raise InputError with the command that installs it."""
    try:
        return import_module(name)
    except ModuleNotFoundError:
        raise InputError(f"{name} is not installed: pip install {name}") from None
