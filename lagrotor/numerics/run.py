"""`Run`: what every simulated motion is, whatever moves: times, error estimate, horizon, ending, and how it is kept and shown."""

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
    "lost": "the last time was reached, but neighbouring motions part: nothing is known of the states",
    "budget": "its evaluations are spent",
    "singular": "a singular position was reached",
    "event": "an event ends it",
    "stopped": "the solver cannot go on",
}


@dataclass(frozen=True)
class Ending:
    """How a run ended: at its last time (end), there although neighbouring motions had parted from `at` on (lost), or at the
    time `at` (s) before: with its evaluations spent (budget), at a singular position that was measured, by an event, or
    because the solver cannot go on (stopped)."""

    kind: Literal["end", "lost", "budget", "singular", "event", "stopped"] = "end"
    at: float = inf
    reason: str = ""

    def __post_init__(self) -> None:
        if (
            self.kind not in _SAYS
            or not isinstance(self.at, float)
            or self.at != self.at
            or type(self.reason) is not str
        ):
            raise InputError(f"Ending: {self.kind!r} at {self.at!r} for {self.reason!r} is none")

    @property
    def early(self) -> bool:
        """Whether the run ended before its last time."""
        return self.kind not in ("end", "lost")

    def __str__(self) -> str:
        at = (
            f" from t = {self.at:.6g} s on" if self.kind == "lost" else f" at t = {self.at:.6g} s" if self.early else ""
        )
        return _SAYS[self.kind] + at + (f": {self.reason}" if self.reason else "")


class Quantity(NamedTuple):
    """What is known of a run at each of its times: values, the name of each axis ("t" among them), and the unit."""

    values: Array
    axes: tuple[str, ...]
    unit: str


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Run(Shown):
    """A simulated motion at the times t (n,) that were reached, in s; its start holds at t[0].

    errors (n,): the estimated largest error up to each time, relative to the state's size; NaN where none is known. horizon:
    the time (s) from which they exceed the tolerance. evaluations: of the right-hand side, by every integration that was made.
    """

    t: Array
    errors: Array
    horizon: float = inf
    evaluations: int = 0
    ending: Ending = Ending()

    @property
    def error(self) -> float:
        """The estimated largest error over the run, relative to the state's size."""
        return float(self.errors[-1]) if len(self.errors) else 0.0

    @property
    @abstractmethod
    def energy(self) -> Array:
        """The whole kinetic and potential energy, that of spins included, (n,), in J."""

    @abstractmethod
    def quantities(self) -> Mapping[str, Quantity]:
        """What the run holds and what is derived from it, by name: what is written, tabulated and handed on."""

    @abstractmethod
    def plot(self) -> Any:
        """A figure that a notebook shows; `.savefig(path)` writes it."""

    @abstractmethod
    def animate(self, path: str | Path, fps: float = 25.0) -> Path:
        """Write the motion to `path`, a `.gif`."""

    def summary(self) -> dict[str, str]:
        """How long the run is, how well it is known, how it ended, name → words."""
        n, error = len(self.t), self.error
        return {
            "times": f"{n}, from {self.t[0]:g} to {self.t[-1]:g} s" if n else "none",
            "evaluations": f"{self.evaluations:,}",
            "estimated error": "not known" if np.isnan(error) else scientific(error, 1),
            "ending": str(self.ending),
        }

    def check_times(self, where: str) -> None:
        """Raises InputError for a run without times."""
        if not len(self.t):
            raise InputError(f"{where}: the run has no times, as that of crossings where there are none")

    def about(self) -> dict[str, Any]:
        """What `save` writes beside the arrays, as JSON."""
        return {}

    def columns(self) -> Iterator[tuple[str, Array, str]]:
        """Each component of each quantity: a name, its values (n,), its unit."""
        for name, quantity in self.quantities().items():
            values = np.moveaxis(quantity.values, quantity.axes.index("t"), -1)
            others = [axis for axis in quantity.axes if axis != "t"]
            labels = [_labels(axis, size) for axis, size in zip(others, values.shape[:-1], strict=True)]
            for at, label in zip(np.ndindex(*values.shape[:-1]), product(*labels), strict=True):
                yield "_".join([name, *map(str, label)]), values[at], quantity.unit

    def after(self, begin: float) -> Self:
        """The part of the run from the time `begin` (s) on. Raises InputError where nothing is left."""
        if isinstance(begin, bool) or not isinstance(begin, int | float | np.number) or begin != begin:
            raise InputError(f"after: begin = {begin!r} must be a time in s")
        self.check_times("after")
        i, quantities = int(np.searchsorted(self.t, begin)), self.quantities()
        if i == len(self.t):
            raise InputError(f"after: the run ends at t = {self.t[-1]:g} s, before {begin:g} s")
        sampled = ((item.name, quantities[item.name]) for item in fields(self) if item.name in quantities)
        slices: dict[str, Any] = {
            name: q.values[(slice(None),) * q.axes.index("t") + (slice(i, None),)] for name, q in sampled
        }
        return replace(self, t=self.t[i:], errors=self.errors[i:], **slices)

    def to_dataframe(self) -> Any:
        """The run as a pandas DataFrame, t (s) its index, a column a component.

        Raises InputError where pandas is not installed.
        """
        pandas = optional_package("pandas")
        return pandas.DataFrame(
            {name: values for name, values, _ in self.columns()}, index=pandas.Index(self.t, name="t")
        )

    def to_xarray(self) -> Any:
        """The run as an xarray Dataset over t (s) and what else its quantities have, each variable with its unit.

        Raises InputError where xarray is not installed.
        """
        xarray, quantities = optional_package("xarray"), self.quantities()
        places: dict[str, Any] = {"t": ("t", self.t, {"units": "s"})}
        for quantity in quantities.values():
            sizes = zip(quantity.axes, quantity.values.shape, strict=True)
            places |= {axis: _labels(axis, size) for axis, size in sizes if axis != "t"}
        variables = {name: (q.axes, q.values, {"units": q.unit}) for name, q in quantities.items()}
        attributes = {name: value for name, value in self.about().items() if isinstance(value, str)}
        return xarray.Dataset(variables, coords=places, attrs=attributes | {"ending": str(self.ending)})

    def save(self, path: str | Path) -> Path:
        """Write the run by the name's ending.

        .npz: t, errors, every quantity, and as JSON what is run, horizon, evaluations, ending, version and a digest of it all,
        which `load` of the same class reads back. .csv: a column a component. .png, .svg, .pdf: `plot`. .gif: `animate`.
        Raises InputError for another ending.
        """
        target = path_of("save: path", path)
        if target.suffix == ".npz":
            self.check_times("save")
            outcome = {"horizon": self.horizon, "evaluations": self.evaluations, "ending": asdict(self.ending)}
            arrays = {name: quantity.values for name, quantity in self.quantities().items()}
            return write_arrays(target, self.about() | outcome, {"t": self.t, "errors": self.errors} | arrays)
        if target.suffix == ".csv":
            table = {"t [s]": self.t} | {f"{name} [{unit}]": values for name, values, unit in self.columns()}
            rows = (",".join(map(repr, row)) for row in np.column_stack(list(table.values())).tolist())
            return write_text(target, "\n".join([",".join(table), *rows, ""]))
        if target.suffix in PICTURES:
            return write_beside(target, lambda file: self.plot().savefig(file, format=target.suffix[1:]))
        if target.suffix in FILMS:
            return self.animate(target)
        raise InputError(f"save: {target.name} must end in .npz, .csv, {', '.join((*PICTURES, *FILMS))}")


class Saved(NamedTuple):
    """What a file of `Run.save` holds: about, what the class wrote of itself; arrays; fields, those of `Run`."""

    about: dict[str, Any]
    arrays: dict[str, Array]
    fields: dict[str, Any]


def read_run(path: str | Path) -> Saved:
    """The contents of a run that was saved as .npz, those of `Run` checked.

    Raises InputError where that is not what the file is: not whole, or with times that decrease, or errors, evaluations or an
    ending that are none.
    """
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
        wrong = "its number of evaluations is none"
    elif type(horizon) is not float or (errors < 0).any():
        wrong = "its errors or its horizon is none"
    if wrong:
        raise InputError(f"load: {path} is no run: {wrong}: give a file that `save` wrote")
    return Saved(
        about, arrays, {"t": t, "errors": errors, "horizon": horizon, "evaluations": evaluations, "ending": end}
    )


def _labels(axis: str, size: int) -> list[Any]:
    """Components are x, y, z; what else there is several of is counted from 1."""
    return list("xyz"[:size]) if axis == "component" else list(range(1, size + 1))


def optional_package(name: str) -> Any:
    """An optional package; raises InputError with the way to it."""
    try:
        return import_module(name)
    except ModuleNotFoundError:
        raise InputError(f"{name} is not installed: pip install {name}") from None
