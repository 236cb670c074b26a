"""The programs of the model `spheres`, derived: right-hand side and projection of two unit vectors with multipliers.

    a r_i'' + b r_j'' = G_i r_i × r_i' + F_i + sum_c lam_c grad_i g_c

The multipliers lam_c belong to the two unit lengths and the bar, one each.
"""

from dataclasses import replace

import sympy as sp

from lagrotor.mechanics import mass_matrix
from lagrotor.mechanics.lagrangian import linear_solve
from lagrotor.mechanics.running.programs import motion_program
from lagrotor.numerics.codegen import Program, Stage, solve_symmetric
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.pair.notation import AXES, G_1, G_2, a, b, k

_FORCE = sp.symbols("F_x F_y F_z", real=True)


def program(massive: bool, bar: bool, body: int) -> Program:
    """Derive the program (r_1, r_2, r_1', r_2'; a, b, k, G_1, G_2[, F]) → twelve derivatives. `body` 0 has no force F."""
    parameters = (a, *((b,) if massive else ()), *((k,) if bar else ()), G_1, G_2, *(_FORCE if body else ()))
    if not massive:
        stages, accelerations = _slim(bar, body)
        return Program((*AXES.q, *AXES.v, *parameters), tuple(stages), (*AXES.v, *accelerations))
    system = axes_pair(bar)
    if body:
        push = sp.Matrix([*(_FORCE if body == 1 else (0, 0, 0)), *(_FORCE if body == 2 else (0, 0, 0))])
        system = replace(system, forces=tuple(system.generalised_forces + push))
    motion = motion_program(system).program
    return Program((*AXES.q, *AXES.v, *parameters), motion.stages, motion.outputs)


def _slim(bar: bool, body: int) -> tuple[list[Stage], list[sp.Expr]]:
    """Return the intermediate results and the accelerations for a massless bar or none.

    Each axis alone is a r'' = Q − (a |r'|² + r . Q) r / r². A massless bar adds lam times the component normal to r_i of
    n_1 = r_2 + k e_x or n_2 = r_1 − k e_x, so that one multiplier suffices and no matrix is solved. The second derivatives of
    |r_i|² and of the bar's length vanish off the constraints, too; only r_i . (r_i × r_i') = 0 is omitted. To omit more would
    save 28 operations, but a run would drift exponentially where the bar compresses.
    """
    r, v = ([sp.Matrix(half[:3]), sp.Matrix(half[3:])] for half in (AXES.q, AXES.v))
    pull = [r[1] + sp.Matrix([k, 0, 0]), r[0] - sp.Matrix([k, 0, 0])]
    stages: list[Stage] = []
    rotors, closing, mobility = [], 2 * v[0].dot(v[1]), sp.Integer(0)
    for i, G in enumerate((G_1, G_2)):
        forces = sp.Matrix(sp.symbols(f"f{i}_0:3", real=True))
        square, normal, inward = sp.symbols(f"s_{i} n_{i} h_{i}", real=True)
        force = sp.Matrix(_FORCE) if body == i + 1 else sp.zeros(3, 1)
        stages += list(zip(forces, (G * r[i].cross(v[i]) + force) / a, strict=True))
        stages.append((square, r[i].dot(r[i]) if bar else sp.S.One))
        stages.append((normal, (r[0].dot(r[1]) + (-1) ** i * k * r[i][0]) / square))
        stages.append((inward, (v[i].dot(v[i]) + r[i].dot(force) / a) / square))
        rotors.append((forces, normal, inward))
        closing += forces.dot(pull[i]) - inward * normal * square
        mobility += pull[i].dot(pull[i]) - normal**2 * square
    if not bar:
        stages = [(name, e) for name, e in stages if k not in e.free_symbols]
        return stages, [e for i, (forces, _, inward) in enumerate(rotors) for e in forces - inward * r[i]]
    lam = sp.Symbol("lam", real=True)
    stages.append((lam, -closing / mobility))
    accelerations = []
    for i, (forces, normal, inward) in enumerate(rotors):
        radial = sp.Symbol(f"q_{i}", real=True)
        stages.append((radial, inward + lam * normal))
        accelerations += list(forces + lam * pull[i] - radial * r[i])
    return stages, accelerations


def projection(massive: bool, bar: bool) -> Program:
    """Derive the program of one Newton step towards the constraints g and their rates G v, with S = G M⁻¹ Gᵀ. It returns q −
    M⁻¹ Gᵀ S⁻¹ g and v − M⁻¹ Gᵀ S⁻¹ G v."""
    system = axes_pair(bar)
    mass = mass_matrix(system.L if massive else system.L.subs(b, 0), AXES)
    G, pull = system.rows, linear_solve(mass, system.rows.T, "the axes' mass matrix")
    residuals = sp.Matrix(system.constraints).row_join(system.residual)
    stages, x = solve_symmetric(G * pull, residuals, "p")
    corrected = sp.Matrix([*AXES.q, *AXES.v]) - (pull * x[:, 0]).col_join(pull * x[:, 1])
    parameters = (a, *((b,) if massive else ()), *((k,) if bar else ()))
    return Program((*AXES.q, *AXES.v, *parameters), tuple(stages), tuple(corrected))
