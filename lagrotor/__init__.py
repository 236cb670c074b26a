"""lagrotor: the Lagrangian of axially coupled rotor pairs, derived, decided, and compared with its own simulation."""

from typing import TYPE_CHECKING

from lagrotor.about import __version__ as __version__
from lagrotor.lazy_imports import face
from lagrotor.renamed import install

if TYPE_CHECKING:
    from lagrotor.models.orbits.floquet import floquet as floquet
    from lagrotor.models.orbits.precession import paired_scene as paired_scene
    from lagrotor.models.orbits.precession import precession_orbit as precession_orbit
    from lagrotor.models.orbits.shooting import orbit_family as orbit_family
    from lagrotor.models.simulate import simulate as simulate
    from lagrotor.models.sweeps.sweep import sweep as sweep
    from lagrotor.models.sweeps.sweep_folder import Sweep as Sweep
    from lagrotor.pair.initial_conditions import consistent_scene as consistent_scene
    from lagrotor.pair.lagrangians import ansatz_integrals as ansatz_integrals
    from lagrotor.pair.lagrangians import pair_with_bar as pair_with_bar
    from lagrotor.pair.scene import Link as Link
    from lagrotor.pair.scene import Rotor as Rotor
    from lagrotor.pair.scene import Scene as Scene
    from lagrotor.pair.scene import Shock as Shock
    from lagrotor.pair.scene_document import read_scene as read_scene
    from lagrotor.pair.scene_document import write_scene as write_scene
    from lagrotor.pair.trajectory import Trajectory as Trajectory
    from lagrotor.paper.papers import Paper as Paper
    from lagrotor.paper.rotor_pair.rotor_pair_audit import audit as audit
    from lagrotor.structures.assembly import Brace as Brace
    from lagrotor.structures.structure import Structure as Structure
    from lagrotor.structures.waves.patterns import Pattern as Pattern
    from lagrotor.theory.drift_after_shock import cancelling_force as cancelling_force
    from lagrotor.theory.drift_after_shock import toppling_after_shock as toppling_after_shock
    from lagrotor.theory.natural_frequency import pair_precession_rate as pair_precession_rate
    from lagrotor.theory.natural_rate import natural_rate as natural_rate
    from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories as corrected_trajectories
    from lagrotor.theory.paired_precession.closed_forms import paired_frequency as paired_frequency
    from lagrotor.theory.paired_precession.closed_forms import paired_momentum as paired_momentum
    from lagrotor.theory.shock_response import shock_response as shock_response

install()
__getattr__, __dir__, __all__ = face(__name__)
