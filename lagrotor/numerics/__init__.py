"""Tools for any right-hand side: generated programs, spectra, orders of convergence, rotations."""

from typing import TYPE_CHECKING

from lagrotor.faces import face

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program as Program
    from lagrotor.numerics.codegen import operations as operations
    from lagrotor.numerics.curves import best_harmonics as best_harmonics
    from lagrotor.numerics.curves import first_passage as first_passage
    from lagrotor.numerics.curves import harmonics_at as harmonics_at
    from lagrotor.numerics.curves import mean_between as mean_between
    from lagrotor.numerics.curves import measured_order as measured_order
    from lagrotor.numerics.curves import peak as peak
    from lagrotor.numerics.curves import spectrum as spectrum
    from lagrotor.numerics.curves import swing as swing
    from lagrotor.numerics.curves import turn_means as turn_means
    from lagrotor.numerics.printers import compile_program as compile_program
    from lagrotor.numerics.rotations import body_rotations as body_rotations
    from lagrotor.numerics.rotations import skew_matrix as skew_matrix

__getattr__, __dir__, __all__ = face(__name__)
