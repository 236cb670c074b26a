"""lagrotor: the Lagrangian of axially coupled rotor pairs, derived, decided, and compared with its own simulation."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .rotors.parameters import Link, Rotor, Scene, Shock

if TYPE_CHECKING:
    from .models.simulate import simulate
    from .paper.audit import audit
    from .rotors.closed_forms import natural_rate
    from .rotors.consistent import consistent_scene, paired_scene

# Names whose modules are heavy, imported when first asked for: `import lagrotor` needs neither sympy nor matplotlib.
_LATER = {
    "audit": "lagrotor.paper.audit",
    "consistent_scene": "lagrotor.rotors.consistent",
    "natural_rate": "lagrotor.rotors.closed_forms",
    "paired_scene": "lagrotor.rotors.consistent",
    "simulate": "lagrotor.models.simulate",
}

__version__ = "0.1.0"
__all__ = [
    "Link",
    "Rotor",
    "Scene",
    "Shock",
    "audit",
    "consistent_scene",
    "natural_rate",
    "paired_scene",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'lagrotor' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
