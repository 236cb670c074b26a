"""The paired precession as a program for generated code: Horner's rule in the cosine of the phase.

With c = cos Phi, s = sin Phi, w = c² the symmetry of the orbit halves the work: each coordinate is a sum of an even and an odd
function of c, and the other rotor, half a period later, has the same functions with other signs,

    x_1, x_2 = c O_x(w) ± E_x(w),    y_1, y_2 = s (c O_y(w) ± E_y(w)),    z_1, z_2 = E_z(w) ± c O_z(w).
"""

import sympy as sp

from lagrotor.numerics.codegen import Program


def horner_program(order: int) -> Program:
    """Return a program that computes x_1, y_1, z_1, x_2, y_2, z_2 from c, s and the coefficients of x, y, z."""
    c, s, w = sp.symbols("c s w", real=True)
    names = [[sp.Symbol(f"{q}{n}", real=True) for n in range(order + 1)] for q in "xyz"]
    stages = [(w, c * c)]

    def keep(name: str, expression: sp.Expr) -> sp.Symbol:
        stages.append((sp.Symbol(name, real=True), expression))
        return stages[-1][0]

    def horner(of: list[sp.Symbol]) -> sp.Expr:
        total = sp.Integer(0)
        for coefficient in reversed(of):
            total = coefficient + w * total
        return total

    (ex, ox), (ey, oy), (ez, oz) = (
        (keep(f"E_{q}", horner(of[0::2])), keep(f"O_{q}", c * horner(of[1::2])))
        for q, of in zip("xyz", names, strict=True)
    )
    outputs = (ox + ex, s * (oy + ey), ez + oz, ox - ex, s * (oy - ey), ez - oz)
    arguments = (c, s, *(n for group in names for n in group))
    return Program(arguments, tuple(stages), outputs)
