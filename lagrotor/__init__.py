"""lagrotor: the Lagrangian of axially coupled rotor pairs, derived, decided, and compared with its own simulation."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from lagrotor.about import __version__ as __version__
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

if TYPE_CHECKING:
    from lagrotor.models.ensemble import sweep
    from lagrotor.models.orbits.continuation import orbit_family
    from lagrotor.models.orbits.floquet import floquet
    from lagrotor.models.orbits.precession import paired_scene, precession_orbit
    from lagrotor.models.simulate import simulate
    from lagrotor.pair.initial_conditions import consistent_scene
    from lagrotor.pair.scene_document import read_scene, write_scene
    from lagrotor.pair.trajectory import Trajectory
    from lagrotor.paper.papers import Paper
    from lagrotor.paper.rotor_pair.own_paper import audit
    from lagrotor.structures.assembly import Brace
    from lagrotor.structures.structure import Structure
    from lagrotor.structures.waves.pattern import Pattern
    from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock
    from lagrotor.theory.natural_rate import natural_rate
    from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories, paired_frequency, paired_momentum
    from lagrotor.theory.shock_response import shock_response

# Names whose modules are heavy, imported when first asked for: `import lagrotor` needs neither sympy nor matplotlib.
_LATER = {
    "write_scene": "lagrotor.pair.scene_document",
    "sweep": "lagrotor.models.ensemble",
    "read_scene": "lagrotor.pair.scene_document",
    "paired_frequency": "lagrotor.theory.paired_precession.closed_forms",
    "corrected_trajectories": "lagrotor.theory.paired_precession.closed_forms",
    "Trajectory": "lagrotor.pair.trajectory",
    "Brace": "lagrotor.structures.assembly",
    "Pattern": "lagrotor.structures.waves.pattern",
    "Structure": "lagrotor.structures.structure",
    "Paper": "lagrotor.paper.papers",
    "audit": "lagrotor.paper.rotor_pair.own_paper",
    "cancelling_force": "lagrotor.theory.drift_after_shock",
    "consistent_scene": "lagrotor.pair.initial_conditions",
    "floquet": "lagrotor.models.orbits.floquet",
    "natural_rate": "lagrotor.theory.natural_rate",
    "orbit_family": "lagrotor.models.orbits.continuation",
    "paired_momentum": "lagrotor.theory.paired_precession.closed_forms",
    "paired_scene": "lagrotor.models.orbits.precession",
    "precession_orbit": "lagrotor.models.orbits.precession",
    "shock_response": "lagrotor.theory.shock_response",
    "simulate": "lagrotor.models.simulate",
    "toppling_after_shock": "lagrotor.theory.drift_after_shock",
}

__all__ = [
    "Brace",
    "Link",
    "Paper",
    "Pattern",
    "Rotor",
    "Scene",
    "Shock",
    "Structure",
    "Trajectory",
    "audit",
    "cancelling_force",
    "consistent_scene",
    "corrected_trajectories",
    "floquet",
    "natural_rate",
    "orbit_family",
    "paired_frequency",
    "paired_momentum",
    "paired_scene",
    "precession_orbit",
    "read_scene",
    "shock_response",
    "simulate",
    "sweep",
    "toppling_after_shock",
    "write_scene",
]


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'lagrotor' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
