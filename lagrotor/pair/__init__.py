"""The paper's system: two rotors on ground joints, a bar between their tips, and a pulse of force.

- `notation` has every symbol with its meaning and unit, `lagrangians` the kinetic energies, the constraint and A and
  B in symbols.
- A `Scene` holds rotors, bar, spins, shock and initial state in SI units. `read_scene` reads one from TOML.
- `consistent_scene` (`initial_conditions`) projects an initial state onto the bar's constraint.
- A `Trajectory` is the result of a simulation: axes over time, tips, energy, momentum, error and ending, the same for
  every model.

A new quantity of a run is a property of `Trajectory`, which is computed from the axes and their rates alone.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.pair.examples import DAMPING as DAMPING
    from lagrotor.pair.examples import HEAVY_LINK as HEAVY_LINK
    from lagrotor.pair.examples import LIGHT as LIGHT
    from lagrotor.pair.examples import SCENES as SCENES
    from lagrotor.pair.examples import SHOCK_PAIRED as SHOCK_PAIRED
    from lagrotor.pair.examples import SHOCK_Y as SHOCK_Y
    from lagrotor.pair.examples import STEP as STEP
    from lagrotor.pair.examples import STIFFNESS as STIFFNESS
    from lagrotor.pair.lagrangians import INERTIAS as INERTIAS
    from lagrotor.pair.lagrangians import J_OF as J_OF
    from lagrotor.pair.lagrangians import ansatz_integrals as ansatz_integrals
    from lagrotor.pair.lagrangians import axes_pair as axes_pair
    from lagrotor.pair.lagrangians import axis as axis
    from lagrotor.pair.lagrangians import bar_curve as bar_curve
    from lagrotor.pair.lagrangians import joint_line_momentum as joint_line_momentum
    from lagrotor.pair.lagrangians import leaning_frame as leaning_frame
    from lagrotor.pair.lagrangians import leaning_lagrangian as leaning_lagrangian
    from lagrotor.pair.lagrangians import link_constraint as link_constraint
    from lagrotor.pair.lagrangians import mercator_axis as mercator_axis
    from lagrotor.pair.lagrangians import mercator_lagrangian as mercator_lagrangian
    from lagrotor.pair.lagrangians import minimal_embedding as minimal_embedding
    from lagrotor.pair.lagrangians import pair_lagrangian as pair_lagrangian
    from lagrotor.pair.lagrangians import pair_with_bar as pair_with_bar
    from lagrotor.pair.lagrangians import rotor_lagrangian as rotor_lagrangian
    from lagrotor.pair.trajectory import ansatz_A as ansatz_A

__getattr__, __dir__, __all__ = face(__name__)
