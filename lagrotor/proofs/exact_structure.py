"""A structure's equations of motion with exact numbers: what `compiled_motion` writes for floats, recorded as stages."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from operator import add, mul, neg, sub, truediv
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.lagrangian import Coordinates, coordinates, t
from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.codegen import Program, Stage
from lagrotor.numerics.recorded_numbers import Recorded, Term
from lagrotor.proofs.balls import rational
from lagrotor.proofs.statements import as_upright
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Coefficients, coefficients_in
from lagrotor.structures.exact.compiled_motion import structure_accelerations
from lagrotor.structures.exact.exact_motion import off_constraints, rates_of_constraints

_OPERATIONS: dict[str, Callable[..., sp.Expr]] = {
    "+": add,
    "-": sub,
    "*": mul,
    "/": truediv,
    "neg": neg,
    "sqrt": sp.sqrt,
}


def exact_number(x: Any) -> sp.Rational:
    """The rational that a float's decimal means."""
    value = rational(x, "Structure")
    return sp.Rational(value.numerator, value.denominator)


_numbers: Callable[[Any], Any] = np.vectorize(exact_number, otypes=[object])


def exact_coefficients(s: Assembly) -> Coefficients:
    """`coefficients` in rationals. A brace's length is that of its ends, as a root."""
    if any(s.hinge):
        raise InputError("proved: a hinge's moment θ/sin θ has no rigorous series here; leave the hinges out")
    if any(brace.along for brace in s.braces):
        raise InputError("proved: braces in guides are not taken: leave `along` out")
    ell = np.array([_bar(s, *bar) for bar in s.bars], dtype=object)
    return coefficients_in(s, _numbers, ell, np.frompyfunc(sp.sqrt, 1, 1))


def _bar(s: Assembly, i: int, j: int, ell: float) -> sp.Expr:
    """A bar's length: as it is written or, where that is the rounded distance of the upright tips, this distance."""
    if not as_upright(asdict(s), i, j, ell):
        return exact_number(ell)
    ends = [[*map(exact_number, (*s.joints[k], s.rotor[k].length))] for k in (i, j)]
    return sp.sqrt(sum((x - y) ** 2 for x, y in zip(*ends, strict=True)))


def structure_coordinates(s: Assembly) -> Coordinates:
    """x_0 y_0 z_0 x_1 …: components of the axes' unit vectors, rotors counted from 0."""
    return coordinates(" ".join(f"{letter}_{i}" for i in range(len(s.joints)) for letter in "xyz"))


def structure_program(s: Assembly) -> tuple[Program, tuple[sp.Expr, ...]]:
    """(r, r'[, t]) → (r', r''[, 1]), and the expressions that stay zero: |r_i|² − 1, |d|² − ell² and their rates, halved."""
    c, letters = exact_coefficients(s), structure_coordinates(s)
    N, timed, tape = len(c.R), any(x != 0 for x in c.decay), list[Recorded]()
    of_time = {f"G_{i}": G * sp.exp(-k * t) for i, (G, k) in enumerate(zip(c.G, c.decay, strict=True)) if k}
    r, v = (
        [[Recorded(tape, str(x)) for x in part[3 * i : 3 * i + 3]] for i in range(N)] for part in (letters.q, letters.v)
    )
    G = [Recorded(tape, f"G_{i}") if f"G_{i}" in of_time else G for i, G in enumerate(c.G)]
    accelerations = structure_accelerations(c, r, v, G, recorded_numbers)
    leaves = {str(x): x for x in (*letters.q, *letters.v)} | of_time
    stages, rates = _stages(tape, leaves, accelerations)
    arguments = (*letters.q, *letters.v, *((t,) if timed else ()))
    outputs = (*letters.v, *rates, *((sp.S.One,) if timed else ()))
    return Program(arguments, tuple(stages), outputs, shared=True), _held(c, letters)


def _stages(
    tape: Sequence[Recorded], leaves: Mapping[str, sp.Expr], outputs: Sequence[Term]
) -> tuple[list[Stage], list[sp.Expr]]:
    """Each recorded operation as a stage, its constants as they are meant, and the outputs; leaves: what names stand for."""
    stages, known = list[Stage](), dict[Recorded, sp.Expr]()

    def expression(x: Any) -> sp.Expr:
        return known[x] if isinstance(x, Recorded) else x if isinstance(x, sp.Expr) else exact_number(x)

    for x in tape:
        known[x] = _OPERATIONS[x.kind](*map(expression, x.parts)) if x.parts else leaves[x.kind]
        if x.parts and x.kind != "neg" and not known[x].is_Atom:
            stages.append((sp.Symbol(f"w_{len(stages)}", real=True), known[x]))
            known[x] = stages[-1][0]
    return stages, [expression(x) for x in outputs]


def _held(c: Coefficients, letters: Coordinates) -> tuple[sp.Expr, ...]:
    r, v = (np.array(part, dtype=object).reshape(-1, 3) for part in (letters.q, letters.v))
    return (*off_constraints(c, r), *rates_of_constraints(c, r, v))
