"""The paper's system in symbols: one rotor, the pair, the bar, the ansatz with A and B, and the pair on two unit spheres.

All expressions use the symbols of the glossary. The kinetic energy of the coupled pair is

    T = a/2 (|r_1'|² + |r_2'|²) + b r_1' . r_2' + (G_1² + G_2²) / (2 I_3),
    a = J + m R²/4 + K R²/ell²,   b = m R²/4 − K R²/ell²,   J = I_1 + M R²/4,

and the bar keeps  ell (x_2 − x_1) + R (1 − r_1 . r_2) = 0.
"""

from dataclasses import dataclass
from typing import Literal

import sympy as sp

from lagrotor.mechanics import Coordinates, System, momenta, total_derivative
from lagrotor.pair.notation import (
    ANSATZ,
    AXES,
    G_1,
    G_2,
    I1,
    I3,
    LEANING,
    MERCATOR,
    MINIMAL,
    PAIR,
    ROTOR,
    J,
    K,
    M,
    R,
    a,
    b,
    ell,
    k,
    m,
)

JOINT_LINE = sp.Matrix([1, 0, 0])
J_OF = I1 + M * R**2 / 4
# The centre of the bar moves with the mean velocity of the tips; K is the inertia of the bar's own rotation.
INERTIAS: dict[sp.Symbol, sp.Expr] = {
    a: J + m * R**2 / 4 + K * R**2 / ell**2,
    b: m * R**2 / 4 - K * R**2 / ell**2,
    k: ell / R,
}


def axis(theta: sp.Expr, phi: sp.Expr) -> sp.Matrix:
    """Return the unit vector of an axis from the ground joint to the tip.

    Parameters
    ----------
    theta, phi : Expr
        Inclination and azimuth in rad.

    Returns
    -------
    Matrix
        The vector, shape (3, 1).
    """
    return sp.Matrix([sp.sin(theta) * sp.cos(phi), sp.sin(theta) * sp.sin(phi), sp.cos(theta)])


def rotor_lagrangian(inertia: sp.Expr = J) -> sp.Expr:
    """Return L = J/2 (theta'² + phi'² sin² theta) + I_3/2 (psi' + phi' cos theta)² of a rotor without gravity (5.01).

    Parameters
    ----------
    inertia : Expr, default J
        The transverse inertia J.

    Returns
    -------
    Expr
        L in `ROTOR`.
    """
    return _rotor_energy(inertia, ROTOR.q[0], *ROTOR.v)


def _rotor_energy(inertia: sp.Expr, theta: sp.Expr, theta_v: sp.Expr, phi_v: sp.Expr, psi_v: sp.Expr) -> sp.Expr:
    tilt = inertia / 2 * (theta_v**2 + phi_v**2 * sp.sin(theta) ** 2)
    return tilt + I3 / 2 * (psi_v + phi_v * sp.cos(theta)) ** 2


def pair_lagrangian(inertia: sp.Expr = J) -> sp.Expr:
    """Return the Lagrangian of two uncoupled rotors in Euler angles (5.08).

    Parameters
    ----------
    inertia : Expr, default J
        The transverse inertia J.

    Returns
    -------
    Expr
        L in `PAIR`.
    """
    q, v = PAIR.q, PAIR.v
    return _rotor_energy(inertia, q[0], *v[:3]) + _rotor_energy(inertia, q[3], *v[3:])


def pair_with_bar() -> System:
    """Return the exact pair in Euler angles, with the bar's energy and its constraint.

    Returns
    -------
    System
        Six coordinates `PAIR` and one constraint.
    """
    q = PAIR.q
    r1, r2 = axis(q[0], q[1]), axis(q[3], q[4])
    v1, v2 = (r.applyfunc(lambda e: total_derivative(e, PAIR)) for r in (r1, r2))
    lagrangian = pair_lagrangian(a) + b * sp.expand_trig(v1.dot(v2))
    return System(PAIR, lagrangian, (link_constraint(r1, r2),))


def link_constraint(r1: sp.Matrix, r2: sp.Matrix) -> sp.Expr:
    """Return the bar's constraint g = k (x_2 − x_1) + 1 − r_1 · r_2 = (|ell e_x + R (r_2 − r_1)|² − ell²) / (2 R²).

    Parameters
    ----------
    r1, r2 : Matrix
        Unit vectors of the axes, shape (3, 1).

    Returns
    -------
    Expr
        g, with k = ell / R.
    """
    return k * (r2[0] - r1[0]) + 1 - r1.dot(r2)


def ansatz_lagrangian(inertia: sp.Expr = J) -> sp.Expr:
    """Return the pair's Lagrangian for phi_1' = −phi_2' = phi' and psi_1' = −psi_2' = psi' (5.11)."""
    theta_1, theta_2 = ANSATZ.q[:2]
    theta_1_v, theta_2_v, phi_v, psi_v = ANSATZ.v
    first = _rotor_energy(inertia, theta_1, theta_1_v, phi_v, psi_v)
    return first + _rotor_energy(inertia, theta_2, theta_2_v, -phi_v, -psi_v)


def ansatz_integrals() -> tuple[sp.Expr, sp.Expr]:
    """Return A = dL/dphi' and B = dL/dpsi' of the ansatz Lagrangian (5.12, 5.13).

    They are integrals of the ansatz, not of the pair with its bar.

    Returns
    -------
    tuple of Expr
        A and B in `ANSATZ`, in kg m²/s.
    """
    p = momenta(ansatz_lagrangian(), ANSATZ)
    return p[2], p[3]


def axes_pair(bar: bool = True) -> System:
    """Return the pair as two points on unit spheres, in coordinates without a singularity.

    The spins are eliminated by Routh's reduction, after which the force G_i r_i × r_i' acts on each axis.

    Parameters
    ----------
    bar : bool, default True
        If True, the constraint of the bar is added to the two unit lengths.

    Returns
    -------
    System
        Six coordinates `AXES`.
    """
    q, v = sp.Matrix(AXES.q), sp.Matrix(AXES.v)
    r1, r2, v1, v2 = q[:3, :], q[3:, :], v[:3, :], v[3:, :]
    lagrangian = a / 2 * (v1.dot(v1) + v2.dot(v2)) + b * v1.dot(v2)
    units = ((r1.dot(r1) - 1) / 2, (r2.dot(r2) - 1) / 2)
    constraints = (*units, link_constraint(r1, r2)) if bar else units
    forces = (G_1 * r1.cross(v1)).col_join(G_2 * r2.cross(v2))
    return System(AXES, lagrangian, constraints, forces=tuple(forces))


def mercator_axis(u: sp.Expr, alpha: sp.Expr) -> sp.Matrix:
    """Return r = (tanh u, −sin(alpha) sech u, cos(alpha) sech u) of Mercator coordinates about the joint line.

    Parameters
    ----------
    u, alpha : Expr
        Latitude and angle.

    Returns
    -------
    Matrix
        The unit vector, shape (3, 1).
    """
    return sp.Matrix([sp.tanh(u), -sp.sin(alpha) / sp.cosh(u), sp.cos(alpha) / sp.cosh(u)])


def mercator_lagrangian() -> sp.Expr:
    """Return the Lagrangian of the spin-reduced pair in Mercator coordinates, without the bar's constraint.

    The sphere's metric is sech² u (du² + dalpha²). The gyroscopic force derives from G tanh(u) alpha', which is regular
    except on the joint line.

    Returns
    -------
    Expr
        L in `MERCATOR`.
    """
    u1, al1, u2, al2 = MERCATOR.q
    u1_v, al1_v, u2_v, al2_v = MERCATOR.v
    s1, s2, t1, t2 = 1 / sp.cosh(u1), 1 / sp.cosh(u2), sp.tanh(u1), sp.tanh(u2)
    c, s = sp.cos(al2 - al1), sp.sin(al2 - al1)
    single = a / 2 * (s1**2 * (u1_v**2 + al1_v**2) + s2**2 * (u2_v**2 + al2_v**2))
    parallel = (s1 * s2 + t1 * t2 * c) * u1_v * u2_v + c * al1_v * al2_v
    transverse = t1 * s * u1_v * al2_v - t2 * s * u2_v * al1_v
    return single + b * s1 * s2 * (parallel + transverse) + G_1 * t1 * al1_v + G_2 * t2 * al2_v


@dataclass(frozen=True)
class BarCurve:
    """The solution of the bar's constraint in one parameter chi: the twist Delta, rho, and the latitude w.

    In Mercator coordinates Delta = alpha_2 − alpha_1 and w = u_1 − u_2, and the constraint is cosh w − k sinh w = cos Delta
    with k = ell / R, independent of the mean latitude. The pair then has the coordinates (U, chi, alpha). rho is k cosh w −
    sinh w.
    """

    twist: sp.Expr
    rho: sp.Expr
    latitude: sp.Expr


def bar_curve(ratio: Literal["short", "equal", "long"]) -> BarCurve:
    """Return the curve of the bar's constraint through the upright state chi = 0.

    long:   Delta = chi,                rho = sqrt(cos² chi + k² − 1)   for every chi
    equal:  Delta = chi,                rho = cos chi                   for |chi| < pi/2, where w is unbounded
    short:  sin Delta = k sin chi,      rho = k cos chi                 a closed curve: the bar can fold over
    and  e^w = (k + 1) / (cos Delta + rho),  which for ell = R is 1 / cos chi.

    Parameters
    ----------
    ratio : str
        "short" for ell < R, "equal" for ell = R, "long" for ell > R.

    Returns
    -------
    BarCurve
        Twist, rho and latitude in chi.
    """
    chi = MINIMAL.q[1]
    if ratio == "equal":
        return BarCurve(chi, sp.cos(chi), -sp.log(sp.cos(chi)))
    if ratio == "long":
        twist, rho = chi, sp.sqrt(sp.cos(chi) ** 2 + k**2 - 1)
    else:
        twist, rho = sp.asin(k * sp.sin(chi)), k * sp.cos(chi)
    return BarCurve(twist, rho, sp.log((k + 1) / (sp.cos(twist) + rho)))


def minimal_embedding(twist: sp.Expr, latitude: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """Return the Mercator coordinates of the axes: u = U ± w/2, alpha_i = alpha ∓ Delta/2.

    Parameters
    ----------
    twist, latitude : Expr
        Delta and w.

    Returns
    -------
    dict of Expr
        The coordinates `MERCATOR` in U, alpha, Delta and w.
    """
    u1, al1, u2, al2 = MERCATOR.q
    U, _, alpha = MINIMAL.q
    return {u1: U + latitude / 2, al1: alpha - twist / 2, u2: U - latitude / 2, al2: alpha + twist / 2}


def leaning_frame() -> tuple[sp.Matrix, sp.Matrix]:
    """Return orthonormal n and q with r_1 = n cos h − q sin h and r_2 = n cos h + q sin h.

    The mean axis n is inclined by beta along the joint line and turned by alpha about that line. The bar requires q_x =
    −sin(h)/k, so q = f cos chi + e sin chi with sin chi = −sin(h)/(k cos beta), f across the joint line and e along the lean.

    Returns
    -------
    tuple of Matrix
        n and q in `LEANING`, each of shape (3, 1).
    """
    beta, h, alpha = LEANING.q
    c, s = sp.cos(alpha), sp.sin(alpha)
    mean = sp.Matrix([sp.sin(beta), -sp.cos(beta) * s, sp.cos(beta) * c])
    lean = sp.Matrix([sp.cos(beta), sp.sin(beta) * s, -sp.sin(beta) * c])
    normal = sp.Matrix([0, -c, -s])
    tilt = -sp.sin(h) / (k * sp.cos(beta))
    return mean, normal * sp.sqrt(1 - tilt**2) + lean * tilt


def leaning_lagrangian() -> sp.Expr:
    """Return the Lagrangian of the spin-reduced pair with its bar in (beta, h, alpha), exact for every k.

    alpha is cyclic. With c = cos chi and s = sin chi,

    T = (a + b) (h'² sin² h + |n'|² cos² h) + (a − b) (h'² cos² h + |q'|² sin² h),  |n'|² = beta'² + alpha'² cos² beta,
    |q'|² = (chi' + alpha' sin beta)² + (alpha' c cos beta + beta' s)²,
    and the spins add (G_1 + G_2) cos h (chi' + alpha' sin beta) + (G_1 − G_2) sin h (beta' c + alpha' sin(h)/k).

    Returns
    -------
    Expr
        L in `LEANING`.
    """
    (beta, h, _), (beta_v, h_v, alpha_v) = LEANING.q, LEANING.v
    s = -sp.sin(h) / (k * sp.cos(beta))
    c = sp.sqrt(1 - s**2)
    about_mean = (s.diff(beta) * beta_v + s.diff(h) * h_v) / c + alpha_v * sp.sin(beta)
    mean = beta_v**2 + (alpha_v * sp.cos(beta)) ** 2
    apart = about_mean**2 + (alpha_v * c * sp.cos(beta) + beta_v * s) ** 2
    together = (a + b) * ((h_v * sp.sin(h)) ** 2 + mean * sp.cos(h) ** 2)
    against = (a - b) * ((h_v * sp.cos(h)) ** 2 + apart * sp.sin(h) ** 2)
    spins = (G_1 + G_2) * sp.cos(h) * about_mean + (G_1 - G_2) * sp.sin(h) * (beta_v * c + alpha_v * sp.sin(h) / k)
    return together + against + spins


def joint_line_momentum(c: Coordinates = AXES) -> sp.Expr:
    """Return the Noether integral P = sum_i (dT/dr_i') · (e_x × r_i) + G_i x_i of rotation about the joint line.

    Parameters
    ----------
    c : Coordinates, default AXES
        Coordinates of the axes.

    Returns
    -------
    Expr
        P in kg m²/s.
    """
    q, v = sp.Matrix(c.q), sp.Matrix(c.v)
    r1, r2, v1, v2 = q[:3, :], q[3:, :], v[:3, :], v[3:, :]
    p1, p2 = a * v1 + b * v2, a * v2 + b * v1
    turning = p1.dot(JOINT_LINE.cross(r1)) + p2.dot(JOINT_LINE.cross(r2))
    return turning + G_1 * r1[0] + G_2 * r2[0]
