"""What a theorem is about, as plain data of its certificate: a scene's or structure's numbers, a Lagrangian or rates in words.

None where the words cannot be read again: then a digest of the program stands for it.
"""

import re
from collections.abc import Sequence
from dataclasses import asdict, replace
from itertools import chain
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.numerics.codegen import Program
from lagrotor.pair.scene import Scene
from lagrotor.proofs.balls import rational
from lagrotor.proofs.tape import tape_of
from lagrotor.structures.assembly import Assembly

Subject = dict[str, Any] | None
_EXPRESSION, _LONGEST = re.compile(r"^\d|[\s+*/().-]"), 20_000  # a name that is one; characters


def in_rationals(e: sp.Basic) -> sp.Basic:
    """Decimals as the rational numbers that they mean."""
    return e.xreplace({x: sp.Rational(str(rational(x, "a number"))) for x in e.atoms(sp.Float)})


def exactly_meant(system: Equations) -> Equations:
    """The system with its decimals as rational numbers, so that none is rounded when its equations are derived."""
    acting = {name: getattr(system, name) for name in ("constraints", "rolling", "forces")}
    parts: dict[str, Any] = {name: tuple(map(in_rationals, each)) for name, each in acting.items()}
    whole = (system.L, system.dissipation, *chain(*acting.values()))
    if not any(e.has(sp.Float) for e in whole):
        return system
    return replace(system, lagrangian=in_rationals(whole[0]), dissipation=in_rationals(whole[1]), **parts)


def of_scene(scene: Scene) -> Subject:
    """Spins, rotor, bar and shock."""
    data = asdict(scene)
    return {"scene": {name: data[name] for name in ("spins", "rotor", "link", "shock")}}


def of_structure(s: Assembly) -> Subject:
    """All that it is made of."""
    return {"structure": asdict(s)}


def of_system(system: Equations, arguments: Sequence[str]) -> Subject:
    """The Lagrangian and what else acts, in words; letters: those that are in the words alone."""
    terms = system.L, *system.acting
    letters = set().union(*(map(str, e.free_symbols) for e in terms))
    data: dict[str, Any] = {
        name: [str(e) for e in getattr(system, name)] for name in ("constraints", "rolling", "forces")
    }
    data |= {"L": str(system.L), "dissipation": str(system.dissipation), "letters": sorted(letters - {*arguments})}
    known = _readable(terms, [*arguments, *data["letters"]])
    return {"Lagrangian": data} if known else None


def of_program(program: Program) -> Subject:
    """The rates in words."""
    rates = [in_rationals(e) for e in program.outputs]
    known = not program.stages and _readable(rates, [str(s) for s in program.arguments])
    return {"rates": [str(e) for e in rates]} if known else None


def _readable(expressions: Sequence[sp.Expr], letters: Sequence[str]) -> bool:
    """Whether the second program reads their words."""
    if any(_EXPRESSION.search(name) for name in letters) or any(len(str(e)) > _LONGEST for e in expressions):
        return False
    used: set[Any] = set().union(*(e.free_symbols for e in expressions))
    try:
        tape_of(Program(tuple(used), (), tuple(expressions)))
    except InputError:
        return False
    return True
