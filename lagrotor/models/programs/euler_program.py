"""The programs of the model `euler`, derived: right-hand side, projection, axes."""

import sympy as sp

from lagrotor.mechanics.lagrangian import bias, mass_matrix, total_derivative
from lagrotor.numerics.codegen import Program, solve_symmetric
from lagrotor.pair.lagrangians import axis, pair_with_bar
from lagrotor.pair.notation import I3, PAIR, a, b, k

_FORCE = sp.symbols("F_x F_y F_z", real=True)
# The spins come first: their pivot is I_3, and the pivot of the azimuth is then a sin² theta.
ORDER = [2, 5, 0, 3, 1, 4]


def program(massive: bool, body: int) -> Program:
    """Derive the right-hand side of the model `euler` as a program.

    Its arguments are the angles theta_1, phi_1, psi_1, theta_2, phi_2, psi_2, their rates, the parameters a, b, k, I_3 and, if
    `body` is 1 or 2, the force F on that tip. It returns the twelve time derivatives.
    """
    system = pair_with_bar()
    lagrangian = system.L if massive else system.L.subs(b, 0)
    mass, G = mass_matrix(lagrangian, PAIR), system.rows
    force = -bias(lagrangian, PAIR)
    if body:
        i = 3 * (body - 1)
        tip = axis(PAIR.q[i], PAIR.q[i + 1])
        for j in (0, 1):
            force[i + j] += sp.Matrix(_FORCE).dot(tip.diff(PAIR.q[i + j]))
    mass, force, G = mass.extract(ORDER, ORDER), force.extract(ORDER, [0]), G.extract([0], ORDER)
    stages, free = solve_symmetric(mass, force.row_join(G.T), "m")
    # I_3 cos² theta cancels from the pivot of the azimuth symbolically; in floating point its rounding could exceed a sin² theta.
    ratios = {name: e for name, e in stages if e in (sp.cos(PAIR.q[0]), sp.cos(PAIR.q[3]))}
    stages = [(name, sp.expand(e.subs(ratios)) if e.has(*ratios) else e) for name, e in stages]
    lam = sp.Symbol("lam", real=True)
    row, acceleration, pull = G.row(0), free[:, 0], free[:, 1]
    gamma = system.gamma[0]
    stages.append((lam, -(row.dot(acceleration) + gamma) / row.dot(pull)))
    total = acceleration + lam * pull
    accelerations = [total[ORDER.index(i)] for i in range(6)]
    parameters = (a, *((b,) if massive else ()), k, I3, *(_FORCE if body else ()))
    return Program((*PAIR.q, *PAIR.v, *parameters), tuple(stages), (*PAIR.v, *accelerations))


def projection(massive: bool) -> Program:
    """Derive the program of one Newton step towards the bar's constraint and its time derivative, along M⁻¹ Gᵀ."""
    system = pair_with_bar()
    lagrangian = system.L if massive else system.L.subs(b, 0)
    mass, G = mass_matrix(lagrangian, PAIR), system.rows
    stages, pull = solve_symmetric(mass.extract(ORDER, ORDER), G.T.extract(ORDER, [0]), "p")
    gradient = [pull[ORDER.index(i)] for i in range(6)]
    strength = sum(x * y for x, y in zip(G, gradient, strict=True))
    residual, moving = system.constraints[0] / strength, system.residual[0] / strength
    corrected = [*(q - residual * x for q, x in zip(PAIR.q, gradient, strict=True))]
    corrected += [v - moving * x for v, x in zip(PAIR.v, gradient, strict=True)]
    parameters = (a, *((b,) if massive else ()), k, I3)
    return Program((*PAIR.q, *PAIR.v, *parameters), tuple(stages), tuple(corrected))


def observation() -> Program:
    """Derive the program (angles, rates) → the twelve components of r_1, r_2, r_1', r_2'."""
    q = PAIR.q
    r = [*axis(q[0], q[1]), *axis(q[3], q[4])]
    v = [total_derivative(e, PAIR) for e in r]
    return Program((*q, *PAIR.v), (), (*r, *v))
