"""Units of the symbols of a system, as far as its frames and bodies determine them."""

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.algebra.subexpressions import subexpressions
from lagrotor.mechanics.equations import Equations


def units_of(system: Equations) -> dict[sp.Symbol, str]:
    """Return the units of coordinates, velocities and parameters. A symbol whose unit is not known is left out.

    An angle turns a frame or is the argument of a sine or cosine, and a length shifts a frame.
    """
    c, units = system.c, dict[sp.Symbol, str]()
    frames = dict.fromkeys(f for body in system.bodies for f in body.frame.to_the_ground if f.parent is not None)
    units |= {f.amount: "rad" for f in frames if f.axis is not None and f.amount.is_Symbol}
    formulas = (*(() if system.bodies else (system.L,)), *system.constraints, *system.rolling)
    for e in (part for formula in formulas for part in subexpressions(formula)):
        slopes = [derivative(e.args[0], q) for q in c.q] if isinstance(e, sp.sin | sp.cos) else ()
        units |= {q: "rad" for q, slope in zip(c.q, slopes, strict=False) if slope.is_Rational and slope != 0}
    terms = getattr(system.lagrangian, "terms", ())
    lengths = [e for shift in (*(f.shift for f in frames), *(body.centre for body in system.bodies)) for e in shift]
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
    return units | {v: rate_unit(units[q]) for q, v in zip(c.q, c.v, strict=True) if q in units}


def rate_unit(unit: str) -> str:
    """Return the unit of a time derivative."""
    return "1/s" if unit == "1" else f"{unit}2" if unit.endswith("/s") else f"{unit}/s"
