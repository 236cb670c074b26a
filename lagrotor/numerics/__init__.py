"""Numerical tools for any right-hand side: generated programs, solvers, runs with error estimates, curves.

Data passes through the modules in this order:

- `codegen.Program` is a straight-line program of sympy expressions; `printers` writes it as Python or JavaScript, and
  `source_cache` keeps functions as source.
- `integrate.Problem` is an initial value problem. `integrate.integrate` cuts it at the windows of `pulse`, in which a
  force acts briefly. It solves each `segment.Segment` by one of the `solvers`, or by `taylor` for engine = "fast".
- `error_estimate.Evolution` is a motion to be run. `estimate_run` integrates it at two local errors and returns an
  `EstimatedRun`: states, errors, horizon and ending.
- `run.Run` is the base class of every simulated motion: its errors, files and tables.
- `curves`, `zeros`, `rotations` and `floquet_multipliers` evaluate a run.

A new solver is a function of a `Segment` and a local error that returns a `Stretch` or raises `StopError`; a table in `solvers`
says when each is chosen. A new kind of motion needs an `Evolution`, and a class that inherits from `Run`.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import operations as operations
    from lagrotor.numerics.curves import first_passage as first_passage
    from lagrotor.numerics.curves import measured_order as measured_order
    from lagrotor.numerics.curves import peak as peak
    from lagrotor.numerics.curves import spectrum as spectrum
    from lagrotor.numerics.curves import swing as swing
    from lagrotor.numerics.curves import turn_means as turn_means
    from lagrotor.numerics.rotations import body_rotations as body_rotations

__getattr__, __dir__, __all__ = face(__name__)
