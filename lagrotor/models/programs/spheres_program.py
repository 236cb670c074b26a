"""The programs of the model `spheres`, derived: right-hand side and projection of two unit vectors with multipliers.

    a r_i'' + b r_j'' = G_i r_i × r_i' + F_i + sum_c lam_c grad_i g_c

What vanishes on the constraints is left out of the generated code (|r_i|² = 1, r_1 . r_2 = 1 + k (x_2 − x_1)).
"""

import sympy as sp

from lagrotor.mechanics import bias, mass_matrix
from lagrotor.mechanics.lagrangian import linear_solve
from lagrotor.numerics.codegen import Program, Stage, solve_symmetric
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.pair.notation import AXES, G_1, G_2, a, b, k

FORCE = sp.symbols("F_x F_y F_z", real=True)


def _on_constraint(expression: sp.Expr, bar: bool) -> sp.Expr:
    """`expression` with z_1², z_2² and, under the bar, z_1 z_2 eliminated by the constraints."""
    x1, y1, z1, x2, y2, z2 = AXES.q
    rules = {z1**2: 1 - x1**2 - y1**2, z2**2: 1 - x2**2 - y2**2}
    if bar:
        rules[z1 * z2] = 1 + k * (x2 - x1) - x1 * x2 - y1 * y2
    return sp.expand(sp.expand(expression).subs(rules))


def program(massive: bool, bar: bool, body: int) -> Program:
    """(r_1, r_2, r_1', r_2'; a, b, k, G_1, G_2[, F]) → rates of the twelve; `body` 0: no force."""
    if bar and not massive:
        return _slim(body)
    system = axes_pair(bar)
    lagrangian = system.L if massive else system.L.subs(b, 0)
    mass, G = mass_matrix(lagrangian, AXES), system.rows
    force = system.push - bias(lagrangian, AXES)
    if body:
        force[3 * body - 3 : 3 * body, 0] += sp.Matrix(FORCE)
    # M⁻¹ of the block matrix [[a, b], [b, a]] ⊗ 1.
    p, q = sp.symbols("p q", real=True)
    inverse = sp.Matrix([[p, q], [q, p]]) if massive else sp.Matrix([[p, 0], [0, p]])
    pivots = [(p, a / (a**2 - b**2)), (q, -b / (a**2 - b**2))] if massive else [(p, 1 / a)]
    whole = sp.kronecker_product(inverse, sp.eye(3))
    assert (whole * mass).xreplace(dict(pivots)).applyfunc(sp.cancel) == sp.eye(6)

    free = whole * force
    gamma = system.gamma
    named_gamma = [(sp.Symbol(f"g_{i}", real=True), e) for i, e in enumerate(gamma)]
    # The gyroscopic part of G M⁻¹ Q vanishes where r . (r × r') does.
    right = -(G * free).applyfunc(lambda e: _on_constraint(e, bar)) - sp.Matrix([s for s, _ in named_gamma])
    schur = (G * whole * G.T).applyfunc(lambda e: sp.collect(_on_constraint(e, bar), (p, q)))
    stages, lam = solve_symmetric(schur, right, "s")
    acceleration = free + whole * G.T * lam
    parameters = (a, *((b,) if massive else ()), *((k,) if bar else ()), G_1, G_2, *(FORCE if body else ()))
    return Program((*AXES.q, *AXES.v, *parameters), (*pivots, *named_gamma, *stages), (*AXES.v, *acceleration))


def _slim(body: int) -> Program:
    """Massless bar: each axis alone is a r'' = Q − (a |r'|² + r . Q) r / r², and the bar pulls it by lam times the part of

        n_1 = r_2 + k e_x,  n_2 = r_1 − k e_x

    across it: one multiplier, no matrix. Off the constraints, too, |r_i|² and the bar's length keep their second
    derivatives zero: what is left out by r_i . (r_i × r_i') = 0 alone. Leaving out more saves 28 operations, and
    drifts exponentially where the axes are pressed.
    """
    r, v = ([sp.Matrix(part[:3]), sp.Matrix(part[3:])] for part in (AXES.q, AXES.v))
    pull = [r[1] + sp.Matrix([k, 0, 0]), r[0] - sp.Matrix([k, 0, 0])]
    stages: list[Stage] = []
    parts, closing, mobility = [], 2 * v[0].dot(v[1]), sp.Integer(0)
    for i, G in enumerate((G_1, G_2)):
        own = sp.Matrix(sp.symbols(f"f{i}_0:3", real=True))
        square, along, inward = sp.symbols(f"s_{i} n_{i} h_{i}", real=True)
        force = sp.Matrix(FORCE) if body == i + 1 else sp.zeros(3, 1)
        stages += list(zip(own, (G * r[i].cross(v[i]) + force) / a, strict=True))
        stages += [(square, r[i].dot(r[i])), (along, (r[0].dot(r[1]) + (-1) ** i * k * r[i][0]) / square)]
        stages.append((inward, (v[i].dot(v[i]) + r[i].dot(force) / a) / square))
        parts.append((own, along, inward))
        closing += own.dot(pull[i]) - inward * along * square
        mobility += pull[i].dot(pull[i]) - along**2 * square
    lam = sp.Symbol("lam", real=True)
    stages.append((lam, -closing / mobility))
    accelerations = []
    for i, (own, along, inward) in enumerate(parts):
        radial = sp.Symbol(f"q_{i}", real=True)
        stages.append((radial, inward + lam * along))
        accelerations += list(own + lam * pull[i] - radial * r[i])
    parameters = (a, k, G_1, G_2, *(FORCE if body else ()))
    return Program((*AXES.q, *AXES.v, *parameters), tuple(stages), (*AXES.v, *accelerations))


def projection(massive: bool, bar: bool) -> Program:
    """One Newton step onto the constraints and their rates, along M⁻¹ Gᵀ: q − M⁻¹ Gᵀ S⁻¹ g, v − M⁻¹ Gᵀ S⁻¹ G v."""
    system = axes_pair(bar)
    mass = mass_matrix(system.L if massive else system.L.subs(b, 0), AXES)
    G, pull = system.rows, linear_solve(mass, system.rows.T, "the axes' mass matrix")
    off = sp.Matrix(system.constraints).row_join(system.residual)
    stages, x = solve_symmetric(G * pull, off, "p")
    corrected = sp.Matrix([*AXES.q, *AXES.v]) - (pull * x[:, 0]).col_join(pull * x[:, 1])
    parameters = (a, *((b,) if massive else ()), *((k,) if bar else ()))
    return Program((*AXES.q, *AXES.v, *parameters), tuple(stages), tuple(corrected))
