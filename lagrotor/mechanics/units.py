"""Units of the symbols of a system, as far as its frames and bodies determine them."""

import sympy as sp

from lagrotor.mechanics.equations import Equations


def units_of(system: Equations) -> dict[sp.Symbol, str]:
    """Return the units of coordinates, velocities and parameters. A symbol whose unit is not known is left out.

    A coordinate is an angle if its multiple stands in a sine or cosine of L, of a constraint or of a frame's rotation.
    """
    frames = dict.fromkeys(frame for body in system.bodies for frame in body.frame.to_the_ground if frame.parent)
    given = [*((system.L,) if not system.bodies else ()), *system.constraints, *system.rolling]
    given += [e for frame in frames for e in frame.rotation]
    arguments = [node.args[0] for node in set().union(*(e.atoms(sp.sin, sp.cos) for e in given))]
    units = {q: "rad" for q in system.c.q if any(u.has(q) and u.diff(q).is_Number for u in arguments)}
    terms = getattr(system.lagrangian, "terms", ())
    lengths = [e for frame in frames for e in frame.shift]
    lengths += [e for body in system.bodies for e in body.centre]
    of_unit = {
        "kg": [body.mass for body in system.bodies],
        "m": lengths,
        "kg m2": [e for body in system.bodies for e in body.inertia],
        "m/s2": [e for _, field, _ in terms for e in field or ()],
    }
    for unit, entries in of_unit.items():
        multiples = {s for e in entries for s in e.free_symbols if (e / s).is_number}
        units |= {s: unit for s in sorted(multiples, key=str) if s not in units}
    for frame in frames:
        units |= dict.fromkeys(frame.quaternion, "1") | dict.fromkeys(frame.omega, "rad/s")
    return units | {v: rate_unit(units[q]) for q, v in zip(system.c.q, system.c.v, strict=True) if q in units}


def rate_unit(unit: str) -> str:
    """Return the unit of a time derivative."""
    return "1/s" if unit == "1" else f"{unit}2" if unit.endswith("/s") else f"{unit}/s"
