"""Opposite spins averaged over the fast paired precession, at any lean, and the slow drift after a shock from rest.

beta is the lean of the mean axis along the joint line, h half the angle between the axes. To leading order they oscillate as
beta = beta_s + s/sqrt(sigma) cos Phi, h = eta + s sin Phi with one frequency at every lean, and s² is the adiabatic invariant.
The centre (beta_s, eta), conjugate to each other through 2 G, has the averaged Hamiltonian, up to a function of s alone,

    H = G²/((a + b) k²) W,    W = ((eta² + (s² − p)/2)² − 3 s⁴/8) / cos² beta_s − kappa s² eta²,

with p = k P/G, P the momentum about the joint line, and kappa = (sigma − 1) k²/2.

A shock (p_x, p_y) on rotor 1, upright, gives eta = p_x/(2 G), P = −p_y and s² = A² (p_x² + sigma p_y²)/(4 G²). The bar lets the
axes twist apart only by leaning towards each other. A twist of either sign therefore takes momentum, the pair turns about the
joint line, and the turning converts the twist into x.

Derived in derivations/t11_slow_motion.py and t6_shock_drift.py; `theory.averaged_motion` follows the motion.
"""

from functools import cache
from math import pi, sqrt

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.pair.notation import HALF, LEAN, P_X, SWING, G, P, a, att, b, k, p_y
from lagrotor.pair.scene import Scene
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.shock_response import shock_response

_SHAPE = (a + b) / (a - b)  # sigma


@cache
def averaged_hamiltonian() -> sp.Expr:
    """Derive the averaged Hamiltonian of opposite spins, including the terms that depend on s alone.

    Returns
    -------
    Expr
        H in J as a function of beta_s, eta and s (rad), P and G (kg m²/s), a and b (kg m²), and k.

    References
    ----------
    derivations/t11_slow_motion.py.
    """
    square, inner = SWING**2, HALF**2 + (SWING**2 - k * P / G) / 2
    W = (inner**2 - 3 * square**2 / 8) / sp.cos(LEAN) ** 2 - (_SHAPE - 1) * k**2 / 2 * square * HALF**2
    return G**2 / ((a + b) * k**2) * W + G**2 * (a - 2 * b) * square**2 / (4 * (a**2 - b**2))


@cache
def slow_rates() -> tuple[sp.Expr, sp.Expr]:
    """Derive the rates of the centre, to third order in eta, s and the square root of P, at any lean.

    Returns
    -------
    tuple[Expr, Expr]
        The rates (beta_s', eta') in rad/s as functions of the symbols of `averaged_hamiltonian`.

    References
    ----------
    derivations/t11_slow_motion.py.
    """
    mean = averaged_hamiltonian()
    return sp.factor(mean.diff(HALF) / (2 * G)), sp.factor(-mean.diff(LEAN) / (2 * G))


@cache
def shock_toppling() -> ClosedForm:
    """Derive the mean rate alpha' about the joint line after a shock on rotor 1 of opposite spins, to second order.

    alpha' = −(p_y + ((2 + A²) p_x² + A² sigma p_y²)/(4 k G)) / (2 (a + b)),  sigma = (a + b)/(a − b), A = exp(−(Omega_0 w)²/4).

    Returns
    -------
    ClosedForm
        The rate in rad/s as a function of p_x, p_y (N m s), A, G = G_1 = −G_2 (kg m²/s), a, b (kg m²), k.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t6_shock_drift.py.
    """
    rate = _after_shock(averaged_hamiltonian().diff(P))
    return _form("shock_toppling", "alpha'", rate, (P_X, p_y, att, G, a, b, k), 2)


@cache
def cancelling_impulse() -> ClosedForm:
    """Derive the impulse p_y that cancels the drift after a shock p_x on rotor 1: the smaller root of shock_toppling = 0.

    p_y = −2 (2 + A²) p_x² / (4 k G (1 + sqrt(1 − A² sigma (2 + A²) p_x²/(4 k² G²)))). Outside the domain of the root no force
    along y stops the drift.

    Returns
    -------
    ClosedForm
        The impulse in N m s as a function of p_x (N m s), A, G (kg m²/s), a, b (kg m²), k.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t6_shock_drift.py.
    """
    quadratic, linear, constant = sp.Poly(sp.numer(sp.together(shock_toppling().expressions[0])), p_y).all_coeffs()
    inside = sp.factor(1 - 4 * sp.cancel(quadratic * constant / linear**2))
    root = sp.factor(-2 * sp.cancel(constant / linear)) / (1 + sp.sqrt(inside))
    return _form("cancelling_impulse", "p_y", root, (P_X, att, G, a, b, k), 2, sp.Ge(inside, 0))


@cache
def shock_wander() -> ClosedForm:
    """Derive the rate X' of the mean x after a shock on rotor 1 of opposite spins, to third order.

    With the mean twist Delta = p_x/G and d² = A² (p_x² + sigma p_y²)/G² of the oscillation,

        X' = Delta ( (2 G Delta² + G d² + 4 k p_y) / k² − G b d² / (a − b) ) / (8 (a + b)).

    Returns
    -------
    ClosedForm
        The rate in 1/s as a function of p_x, p_y (N m s), A, G (kg m²/s), a, b (kg m²), k.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t7_duration.py.
    """
    return _form("shock_wander", "X'", _after_shock(slow_rates()[0]), (P_X, p_y, att, G, a, b, k), 3)


def _after_shock(e: sp.Expr) -> sp.Expr:
    swing = att * sp.sqrt(P_X**2 + _SHAPE * p_y**2) / (2 * G)
    return sp.factor(e.subs({LEAN: 0, HALF: P_X / (2 * G), P: -p_y, SWING: swing}))


def _form(
    name: str, output: str, e: sp.Expr, arguments: tuple[sp.Symbol, ...], order: int, *condition: sp.Basic
) -> ClosedForm:
    domain = sp.Gt(a, sp.Abs(b)), sp.Ne(G, 0), *condition
    assumptions = "opposite spins at rest upright, a shock on rotor 1"
    return ClosedForm(name, (output,), (e,), arguments, domain, assumptions, "5, 5.2.1", order, P_X)


def toppling_after_shock(scene: Scene) -> float:
    """Compute the mean rate alpha' about the joint line just after a shock, for opposite spins, to second order.

    `lagrotor.models.toppling_error` measures the error.

    Parameters
    ----------
    scene : Scene
        Opposite spins at rest upright, with a bar and a shock.

    Returns
    -------
    float
        The rate alpha' in rad/s.

    Raises
    ------
    InputError
        Unless the spins are opposite, and the pair, with a bar and a shock, starts at rest and upright.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t6_shock_drift.py.

    Examples
    --------
    >>> from lagrotor import Scene, Shock
    >>> round(toppling_after_shock(Scene(spins=(20, -20), shock=Shock((100, 0, 0), at=1.0, width=0.01))), 6)
    -0.046924
    """
    return float(shock_toppling()(*_arguments(scene, "toppling_after_shock")))  # type: ignore[arg-type]


def wander_after_shock(scene: Scene) -> float:
    """Compute the mean rate of x just after a shock, for opposite spins, to third order.

    `lagrotor.models.wander_error` measures the error.

    Parameters
    ----------
    scene : Scene
        Opposite spins at rest upright, with a bar and a shock.

    Returns
    -------
    float
        The rate in 1/s, in units of R.

    Raises
    ------
    InputError
        Unless the spins are opposite, and the pair, with a bar and a shock, starts at rest and upright.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t7_duration.py.

    Examples
    --------
    >>> from lagrotor import Scene, Shock
    >>> round(wander_after_shock(Scene(spins=(20, -20), shock=Shock((100, 0, 0), at=1.0, width=0.01))), 6)
    0.004159
    """
    sign = 1.0 if scene.shock is None or scene.shock.body == 1 else -1.0
    first, *others = _arguments(scene, "wander_after_shock")
    # A shock on rotor 2 is the mirror image, x → −x, of a shock on rotor 1.
    return sign * float(shock_wander()(sign * first, *others))  # type: ignore[arg-type]


def cancelling_force(scene: Scene) -> float:
    """Compute the force along y that, added to the shock along x, cancels the mean rotation about the joint line.

    The law is of second order in the shock. In exact simulations the force also depends on the averaging time:
    `lagrotor.models.cancelling_force_error`.

    Parameters
    ----------
    scene : Scene
        Opposite spins at rest upright, with a bar and a shock along x.

    Returns
    -------
    float
        The force F_y in N; it has the same time course as the shock.

    Raises
    ------
    InputError
        Unless the spins are opposite, and the pair, with a bar and a shock, starts at rest and upright.
    DomainError
        If no force along y cancels the rotation.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t6_shock_drift.py.

    Examples
    --------
    >>> from lagrotor import Scene, Shock
    >>> round(cancelling_force(Scene(spins=(20, -20), shock=Shock((100, 0, 0), at=1.0, width=0.01))), 6)
    -6.628133
    """
    p_x, _, *others = _arguments(scene, "cancelling_force")
    assert scene.shock is not None
    impulse = float(cancelling_impulse()(p_x, *others))  # type: ignore[arg-type]
    return impulse / (scene.rotor.length * scene.shock.width * sqrt(pi))


def _arguments(scene: Scene, where: str) -> tuple[float, ...]:
    """Return the arguments (p_x, p_y, A, G, a, b, k) of the closed forms above for a scene, in SI units."""
    response = shock_response(scene)
    if scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0 or scene.link is None:
        raise InputError(f"{where}: needs opposite spins, not {scene.spins}")
    p_x, first, second = (float(p) for p in response.impulse)
    return (p_x, first + second, response.attenuation, scene.momenta[0], *scene.inertias, scene.k)
