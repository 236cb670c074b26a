"""The slow motions after a shock of opposite spins from rest, to second and third order in the shock.

A shock F_y gives the pair the momentum −p_y about the joint line, p_y = R times the impulse along y, and the exact
integral P = A (alpha_1' + alpha_2') + G (x_1 − x_2) + … keeps it. The bar lets the axes twist apart only by leaning
towards each other, x_1 − x_2 = (y_1 − y_2)²/(2 k): a twist, of either sign, takes some of this momentum, and the
pair turns about the joint line,

    <y'> = ( p_y + G <(y_1 − y_2)²> / (2 k) ) / (2 A),        A = a + b.

A shock along x twists the pair by p_x/G and makes it swing as much; so it topples even without a force along y, in the
stable sense, and a force along y against it cancels the drift.
"""

from functools import cache
from math import pi, sqrt

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.errors import InputError
from lagrotor.pair.lagrangians import joint_line_momentum, link_constraint
from lagrotor.pair.notation import AXES, G_1, G_2, HALF, LEAN, P_1, P_2, P_X, SWING, G, P, a, att, b, k, p_y
from lagrotor.pair.scene import Scene
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.impulse_response import impulse_matrices
from lagrotor.theory.shock_response import shock_response


@cache
def second_order_momentum() -> sp.Expr:
    """P through second order in the axes' deviation from upright, in y_1, y_2 and their rates.

    The bar's constraint gives x_1 − x_2 to that order; the terms y z' and (z − 1) y' are of third order.
    """
    x1, y1, z1, x2, y2, z2 = AXES.q
    eps = sp.Symbol("epsilon")
    upright = {z1: sp.sqrt(1 - x1**2 - y1**2), z2: sp.sqrt(1 - x2**2 - y2**2)}
    apart = sp.Symbol("x_12")  # x_1 − x_2, second order
    bar = link_constraint(sp.Matrix(AXES.q[:3]), sp.Matrix(AXES.q[3:])).subs(upright).subs(x1, x2 + eps**2 * apart)
    bar = bar.subs({y1: eps * y1, y2: eps * y2, x2: eps * x2}, simultaneous=True)
    lean = sp.solve(derivative(derivative(bar, eps), eps).subs(eps, 0), apart, simplify=False)[0]
    still = {AXES.v[2]: 0, AXES.v[5]: 0, z1: 1, z2: 1, G_1: G, G_2: -G}
    momentum = joint_line_momentum().subs(still)
    return sp.expand(momentum.subs(x1, x2 + lean))


def mean_square_twist() -> sp.Expr:
    """<(y_1 − y_2)²> over the swing after a shock on rotor 1, from the linear response of opposite spins."""
    matrices = impulse_matrices()
    impulse = sp.Matrix([P_X, P_1, P_2])
    opposite = {G_1: G, G_2: -G, P_1: p_y, P_2: 0}
    apart = sp.Matrix([[0, 1, -1]])
    offset = sp.factor((apart * matrices.displacement * impulse)[0].subs(opposite))
    swing = sp.factor((apart * matrices.swing * impulse)[0].subs(opposite))
    squared = sp.factor(matrices.frequency_squared.subs(opposite))
    return sp.expand(offset**2 * (1 + att**2 / 2) + att**2 / 2 * sp.cancel(swing**2 / squared))


@cache
def shock_toppling() -> ClosedForm:
    """alpha' of the mean motion after a shock (p_x, p_y) on rotor 1 of opposite spins, to second order (rad/s).

    −(p_y + ((2 + A²) p_x² + A² sigma p_y²)/(4 k G)) / (2 (a + b)),  sigma = (a + b)/(a − b), A = exp(−(Omega_0 w)²/4).
    Arguments: p_x, p_y (N m s), A, G = G_1 = −G_2, a, b, k.
    """
    _, y1, _, _, y2, _ = AXES.q
    turning, twisting = AXES.v[1], AXES.v[4]
    momentum = second_order_momentum()
    mean_rate = sp.Symbol("alpha_mean")
    averaged = momentum.subs({turning: -mean_rate, twisting: -mean_rate})
    averaged = sp.expand(averaged).subs({y1: y2 + sp.Symbol("d")}).expand()
    averaged = averaged.subs(sp.Symbol("d") ** 2, mean_square_twist())
    rate = sp.solve(sp.expand(averaged) + p_y, mean_rate, simplify=False)[0]
    return _form("shock_toppling", "alpha'", sp.factor(rate), (P_X, p_y, att, G, a, b, k), (), 2)


@cache
def cancelling_impulse() -> ClosedForm:
    """p_y that cancels the drift after a shock p_x on rotor 1: the small root of shock_toppling = 0 (N m s).

    p_y = −2 (2 + A²) p_x² / (4 k G (1 + sqrt(1 − A² sigma (2 + A²) p_x²/(4 k² G²)))). Arguments: p_x, A, G, a, b, k.
    Beyond the root's domain no force along y stops the drift.
    """
    quadratic = sp.Poly(sp.numer(sp.together(shock_toppling().expressions[0])), p_y)
    two, one, zero = quadratic.all_coeffs()
    inside = sp.factor(1 - 4 * sp.cancel(two * zero / one**2))
    root = sp.factor(-2 * sp.cancel(zero / one)) / (1 + sp.sqrt(inside))
    return _form("cancelling_impulse", "p_y", root, (P_X, att, G, a, b, k), (sp.Ge(inside, 0),), 2)


@cache
def shock_wander() -> ClosedForm:
    """X' of the mean x after a shock (p_x, p_y) on rotor 1 of opposite spins, to third order (1/s).

    From the averaged motion: the mean twist Delta = p_x/G stays at first, and turning about the joint line carries it into x,

        X' = Delta ( (2 G Delta² + G d² + 4 k p_y) / k² − G b d² / (a − b) ) / (8 (a + b)),

    with d² = A² (p_x² + sigma p_y²)/G² the swing's part. Without p_y it goes as the cube of the shock, so that x keeps
    within a given bound for a time that falls as the cube. `theory.averaged_motion` follows it from there.
    Arguments: p_x, p_y, A, G, a, b, k.
    """
    from lagrotor.theory.averaging import slow_rates

    square = att**2 * (P_X**2 + (a + b) / (a - b) * p_y**2) / (4 * G**2)
    rate = slow_rates()[0].subs({LEAN: 0, SWING: sp.sqrt(square), HALF: P_X / (2 * G), P: -p_y})
    return _form("shock_wander", "X'", sp.factor(rate), (P_X, p_y, att, G, a, b, k), (), 3)


def _form(
    name: str,
    output: str,
    expression: sp.Expr,
    arguments: tuple[sp.Symbol, ...],
    domain: tuple[sp.Basic, ...],
    order: int,
) -> ClosedForm:
    return ClosedForm(
        name,
        (output,),
        (expression,),
        arguments,
        (sp.Gt(a, sp.Abs(b)), sp.Ne(G, 0), *domain),
        "opposite spins at rest upright, a shock on rotor 1",
        "5, 5.2.1",
        order,
        P_X,
    )


def toppling_after_shock(scene: Scene) -> float:
    """Mean rate alpha' (rad/s) about the joint line just after the scene's shock, to second order; opposite spins.

    `lagrotor.models.toppling_error` gives its error.

    Raises:
        InputError: as `shock_response` does, and unless the spins are opposite.
    """
    return float(shock_toppling()(*_arguments(scene, "toppling_after_shock")))  # type: ignore[arg-type]


def wander_after_shock(scene: Scene) -> float:
    """Mean rate of x (1/s, in units of R) just after the scene's shock, to third order; opposite spins.

    `lagrotor.models.wander_error` gives its error.

    Raises:
        InputError: as `toppling_after_shock`.
    """
    sign = 1.0 if scene.shock is None or scene.shock.body == 1 else -1.0
    first, *others = _arguments(scene, "wander_after_shock")
    # A shock on rotor 2 is the mirror image, x → −x, of one on rotor 1.
    return sign * float(shock_wander()(sign * first, *others))  # type: ignore[arg-type]


def cancelling_force(scene: Scene) -> float:
    """F_y (N) which, added to the scene's shock along x, leaves no mean turning about the joint line, to second order.

    The force that does so on exact runs depends on how long one averages: `lagrotor.models.cancelling_force_error`.

    Raises:
        InputError: as `toppling_after_shock`.
        DomainError: where no force does.
    """
    p_x, _, *others = _arguments(scene, "cancelling_force")
    assert scene.shock is not None
    wanted = float(cancelling_impulse()(p_x, *others))  # type: ignore[arg-type]
    return wanted / (scene.rotor.length * scene.shock.width * sqrt(pi))


def _arguments(scene: Scene, where: str) -> tuple[float, ...]:
    """(p_x, p_y, A, G, a, b, k) of a scene, for the forms above."""
    response = shock_response(scene)
    if scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0 or scene.link is None:
        raise InputError(f"{where}: needs opposite spins, not {scene.spins}")
    p_x, first, second = (float(p) for p in response.impulse)
    ratio = scene.link.length / scene.rotor.length
    return (p_x, first + second, response.attenuation, scene.momenta[0], *scene.inertias, ratio)
