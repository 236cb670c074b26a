"""Any number of rotors and bars: stability under load, response, waves, and the exact motion.

- `Structure` contains joints, bars, spins and loads; `read_structure` reads one from TOML. `Pattern` repeats a cell of rotors,
  and its `piece` is a `Structure`.
- `Coefficients` has the coefficients of all equations of motion in arrays.
- `SmallMotion` is the linear system about upright. `Modes`, `Standing`, `response` and the bands of a pattern follow from it.
- `local_hamiltonian` expands the exact Lagrangian about upright. `Resonance`, `PrecessionLaw` and `hold_time` follow from it.
- `ExactMotion` is the right-hand side of large motion; `Structure.simulate` integrates it to a `StructureRun`.

To add a load, give it a field in `Assembly`, an array in `Coefficients`, and a term in each of three functions:
`exact.exact_motion.forces`, `small_motion.matrices` and `upright_hamiltonian.potential_of`.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.structures.critical_spins import sign_patterns as sign_patterns
    from lagrotor.structures.exact.exact_comparison import bounded_motion as bounded_motion
    from lagrotor.structures.exact.exact_comparison import measured_growth as measured_growth
    from lagrotor.structures.exact.exact_motion import exact_motion as exact_motion
    from lagrotor.structures.exact.structure_run import StructureRun as StructureRun
    from lagrotor.structures.gallery import GALLERY as GALLERY
    from lagrotor.structures.gallery import example as example
    from lagrotor.structures.pictures import draw_plan as draw_plan
    from lagrotor.structures.resonances import resonant_factors as resonant_factors
    from lagrotor.structures.response import mass_worst_case as mass_worst_case
    from lagrotor.structures.response import spins_white_noise as spins_white_noise
    from lagrotor.structures.response import spins_win_white_noise as spins_win_white_noise
    from lagrotor.structures.response import spins_win_worst_case as spins_win_worst_case
    from lagrotor.structures.response import spins_worst_case as spins_worst_case
    from lagrotor.structures.standing import measured_fall as measured_fall
    from lagrotor.structures.structure import read_structure as read_structure
    from lagrotor.structures.structure import write_structure as write_structure
    from lagrotor.structures.upright_hamiltonian import local_hamiltonian as local_hamiltonian
    from lagrotor.structures.waves.nonlinear_waves import wave_amplitude as wave_amplitude
    from lagrotor.structures.waves.patterns import honeycomb as honeycomb
    from lagrotor.structures.waves.patterns import polygon_ring as polygon_ring
    from lagrotor.structures.waves.patterns import square as square
    from lagrotor.structures.waves.patterns import square_octagon as square_octagon
    from lagrotor.structures.waves.patterns import straight_row as straight_row
    from lagrotor.structures.waves.patterns import zigzag as zigzag

__getattr__, __dir__, __all__ = face(__name__)
