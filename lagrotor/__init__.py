"""lagrotor: the Lagrangian of axially coupled rotor pairs, derived, decided, and compared with its own simulation."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .rotors.parameters import Link, Rotor, Scene, Shock

if TYPE_CHECKING:
    from .models.simulate import simulate
    from .paper.audit import audit
    from .rotors.closed_forms import natural_rate
    from .rotors.consistent import consistent_scene, paired_scene
    from .rotors.drift import cancelling_force, toppling_after_shock
    from .rotors.momentum import paired_momentum
    from .rotors.precession import precession_orbit
    from .rotors.response import shock_response
    from .study.family import orbit_family
    from .study.floquet import floquet

# Names whose modules are heavy, imported when first asked for: `import lagrotor` needs neither sympy nor matplotlib.
_LATER = {
    "audit": "lagrotor.paper.audit",
    "cancelling_force": "lagrotor.rotors.drift",
    "consistent_scene": "lagrotor.rotors.consistent",
    "floquet": "lagrotor.study.floquet",
    "natural_rate": "lagrotor.rotors.closed_forms",
    "orbit_family": "lagrotor.study.family",
    "paired_momentum": "lagrotor.rotors.momentum",
    "paired_scene": "lagrotor.rotors.consistent",
    "precession_orbit": "lagrotor.rotors.precession",
    "shock_response": "lagrotor.rotors.response",
    "simulate": "lagrotor.models.simulate",
    "toppling_after_shock": "lagrotor.rotors.drift",
}

__version__ = "0.1.0"
__all__ = [
    "Link",
    "Rotor",
    "Scene",
    "Shock",
    "audit",
    "cancelling_force",
    "consistent_scene",
    "floquet",
    "natural_rate",
    "orbit_family",
    "paired_momentum",
    "paired_scene",
    "precession_orbit",
    "shock_response",
    "simulate",
    "toppling_after_shock",
]


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'lagrotor' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
