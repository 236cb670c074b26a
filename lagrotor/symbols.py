"""The one glossary: every symbol of the project with its LaTeX, meaning and unit.

Coordinates, velocities and accelerations are plain symbols: `theta_1`, `theta_1_dot`, `theta_1_ddot`.
"""

from dataclasses import dataclass

import sympy as sp

from .mechanics.lagrangian import Coordinates, coordinates


@dataclass(frozen=True)
class Entry:
    """One row of the glossary."""

    symbol: sp.Symbol
    latex: str
    meaning: str
    unit: str


def _positive(name: str) -> sp.Symbol:
    return sp.Symbol(name, positive=True)


def _real(name: str) -> sp.Symbol:
    return sp.Symbol(name, real=True)


M, R, I1, I3, I = map(_positive, ("M", "R", "I_1", "I_3", "I"))
ell = _positive("ell")
m, K = sp.symbols("m K", nonnegative=True)
J, a, b, k = _positive("J"), _positive("a"), _real("b"), _positive("k")
sigma = _positive("sigma")
omega, omega_1, omega_2 = map(_real, ("omega", "omega_1", "omega_2"))
G, G_1, G_2 = map(_real, ("G", "G_1", "G_2"))
Omega = _real("Omega")
r0, Phi, t = _real("r_0"), _real("Phi"), _real("t")
theta_0 = _real("theta_0")
A, B, a_const = map(_real, ("A", "B", "a_M"))
M_z, M_3 = _real("M_z"), _real("M_3")
nu, rho = _real("nu"), _positive("rho")
P, P_X, P_1, P_2, p_y = map(_real, ("P", "p_x", "p_1", "p_2", "p_y"))
att = _positive("A_w")
X, TWIST, SWING = map(_real, ("X", "Delta_s", "d"))
a_1, COSINE = _real("a_1"), _real("c")

# One rotor, the pair, and the pair under the ansatz: the paper's Euler angles.
ROTOR: Coordinates = coordinates("theta phi psi")
PAIR: Coordinates = coordinates("theta_1 phi_1 psi_1 theta_2 phi_2 psi_2")
ANSATZ: Coordinates = coordinates("theta_1 theta_2 phi psi")
# The pair in Cartesian components of its two axes, in Mercator coordinates, and with the bar eliminated.
AXES: Coordinates = coordinates("x_1 y_1 z_1 x_2 y_2 z_2")
MERCATOR: Coordinates = coordinates("u_1 alpha_1 u_2 alpha_2")
MINIMAL: Coordinates = coordinates("U chi alpha")
TWISTED: Coordinates = coordinates("U Delta alpha")

_ROWS: tuple[tuple[sp.Symbol, str, str, str], ...] = (
    (M, "M", "mass of a rotor", "kg"),
    (R, "R", "length of a rotor's axis from the ground joint to the tip", "m"),
    (I1, "I_1", "transverse inertia of a rotor about its centre", "kg m²"),
    (I3, "I_3", "axial inertia of a rotor", "kg m²"),
    (I, "I", "the paper's uniform inertia, I_1 = I_3 = I", "kg m²"),
    (J, "J", "transverse inertia of a rotor about its ground joint, I_1 + M R²/4", "kg m²"),
    (ell, r"\ell", "length of the link bar, distance of the ground joints", "m"),
    (m, "m", "mass of the bar", "kg"),
    (K, "K", "transverse inertia of the bar about its centre", "kg m²"),
    (k, "k", "ell / R", "1"),
    (a, "a", "J + m R²/4 + K R²/ell²: inertia of one axis, its share of the bar included", "kg m²"),
    (b, "b", "m R²/4 − K R²/ell²: inertia by which the bar couples the axes", "kg m²"),
    (sigma, r"\sigma", "(a + b)/(a − b): the bar's shape, 1 for no bar or a dumbbell", "1"),
    (omega, r"\omega", "axial angular velocity of a rotor", "rad/s"),
    (omega_1, r"\omega_1", "axial angular velocity of rotor 1, psi_1' + phi_1' cos theta_1", "rad/s"),
    (omega_2, r"\omega_2", "axial angular velocity of rotor 2", "rad/s"),
    (G, "G", "axial angular momentum I_3 omega", "kg m²/s"),
    (G_1, "G_1", "axial angular momentum of rotor 1", "kg m²/s"),
    (G_2, "G_2", "axial angular momentum of rotor 2", "kg m²/s"),
    (Omega, r"\Omega", "angular frequency of the paired precession", "rad/s"),
    (r0, "r_0", "amplitude: sine of the inclination when the two axes are parallel", "1"),
    (theta_0, r"\theta_0", "inclination that belongs to r_0 = sin theta_0", "rad"),
    (Phi, r"\Phi", "phase of the paired precession, Omega t", "rad"),
    (t, "t", "time", "s"),
    (A, "A", "the ansatz integral of phi", "kg m²/s"),
    (B, "B", "the ansatz integral of psi", "kg m²/s"),
    (a_const, "a", "the constant M_z / I of one rotor", "rad/s"),
    (M_z, "M_z", "angular momentum of one rotor about the vertical", "kg m²/s"),
    (M_3, "M_3", "axial angular momentum of one rotor", "kg m²/s"),
    (nu, r"\nu", "rate of uniform turning about the joint line, alpha'", "rad/s"),
    (rho, r"\rho", "sine of the half-angle of the cone of equal spins", "1"),
    (P, "P", "momentum about the joint line", "kg m²/s"),
    (P_X, "p_x", "R times the impulse along x", "kg m²/s"),
    (P_1, "p_1", "R times the impulse along y on rotor 1", "kg m²/s"),
    (P_2, "p_2", "R times the impulse along y on rotor 2", "kg m²/s"),
    (p_y, "p_y", "R times the impulse along y on the rotor that is struck", "kg m²/s"),
    (att, "A_w", "what the pulse's width leaves of the swing, exp(−(Omega_0 w)²/4)", "1"),
    (X, "X", "mean of U over the swing", "1"),
    (TWIST, r"\Delta_s", "mean of the twist over the swing", "rad"),
    (SWING, "d", "amplitude of the swing in the twist", "rad"),
    (a_1, "a_1", "amplitude of cos Phi in x_1", "1"),
    (COSINE, "c", "cosine of the phase", "1"),
)
_ANGLES = {
    "theta": (r"\theta", "inclination of the axis"),
    "phi": (r"\phi", "azimuth of the axis"),
    "psi": (r"\psi", "spin angle"),
    "x": ("x", "component of the axis along the joint line"),
    "y": ("y", "horizontal component of the axis across the joint line"),
    "z": ("z", "vertical component of the axis"),
    "u": ("u", "Mercator latitude about the joint line, artanh x"),
    "alpha": (r"\alpha", "turning angle about the joint line"),
    "U": ("U", "mean Mercator latitude (u_1 + u_2)/2"),
    "chi": (r"\chi", "twist of the pair, alpha_2 − alpha_1 when ell >= R"),
    "Delta": (r"\Delta", "twist of the pair, alpha_2 − alpha_1"),
}


def _coordinate_rows() -> list[Entry]:
    rows = {}
    for c in (ROTOR, PAIR, ANSATZ, AXES, MERCATOR, MINIMAL, TWISTED):
        for q, v, acc in zip(c.q, c.v, c.a, strict=True):
            stem, _, index = q.name.partition("_")
            tex, meaning = _ANGLES[stem]
            unit = "1" if stem in "xyzuU" else "rad"
            tail = f"_{{{index}}}" if index else ""
            of = f" of rotor {index}" if index else ""
            per = "1" if unit == "1" else "rad"
            rows[q] = Entry(q, tex + tail, meaning + of, unit)
            rows[v] = Entry(v, rf"\dot{{{tex}}}{tail}", f"rate of {q.name}", f"{per}/s")
            rows[acc] = Entry(acc, rf"\ddot{{{tex}}}{tail}", f"acceleration of {q.name}", f"{per}/s²")
    return list(rows.values())


GLOSSARY: dict[sp.Symbol, Entry] = {row[0]: Entry(*row) for row in _ROWS} | {e.symbol: e for e in _coordinate_rows()}


def latex(expression: sp.Basic) -> str:
    """LaTeX of an expression in the glossary's letters."""
    return sp.latex(expression, symbol_names={s: GLOSSARY[s].latex for s in expression.free_symbols if s in GLOSSARY})
