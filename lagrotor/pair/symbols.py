"""The one glossary: every symbol of the project with its LaTeX, meaning and unit.

Coordinates, velocities and accelerations are plain symbols: `theta_1`, `theta_1_dot`, `theta_1_ddot`.
"""

import re
from dataclasses import dataclass
from functools import partial
from typing import Any

import sympy as sp

from lagrotor.mechanics.lagrangian import Coordinates, coordinates


@dataclass(frozen=True)
class Entry:
    """One row of the glossary."""

    symbol: sp.Symbol
    latex: str
    meaning: str
    unit: str


GLOSSARY: dict[sp.Symbol, Entry] = {}


def _letter(name: str, meaning: str, unit: str, tex: str = "", **assumptions: bool) -> sp.Symbol:
    """A symbol that enters the glossary as it is declared; its LaTeX is its name where none is given."""
    symbol = sp.Symbol(name, **assumptions)
    GLOSSARY[symbol] = Entry(symbol, tex or name, meaning, unit)
    return symbol


_real = partial(_letter, real=True)
_positive = partial(_letter, positive=True)
_nonnegative = partial(_letter, nonnegative=True)

M = _positive("M", "mass of a rotor", "kg")
R = _positive("R", "length of a rotor's axis from the ground joint to the tip", "m")
I1 = _positive("I_1", "transverse inertia of a rotor about its centre", "kg m²")
I3 = _positive("I_3", "axial inertia of a rotor", "kg m²")
I = _positive("I", "the paper's uniform inertia, I_1 = I_3 = I", "kg m²")
J = _positive("J", "transverse inertia of a rotor about its ground joint, I_1 + M R²/4", "kg m²")
ell = _positive("ell", "length of the link bar, distance of the ground joints", "m", r"\ell")
m = _nonnegative("m", "mass of the bar", "kg")
K = _nonnegative("K", "transverse inertia of the bar about its centre", "kg m²")
k = _positive("k", "ell / R", "1")
a = _positive("a", "J + m R²/4 + K R²/ell²: inertia of one axis, its share of the bar included", "kg m²")
b = _real("b", "m R²/4 − K R²/ell²: inertia by which the bar couples the axes", "kg m²")
sigma = _positive("sigma", "(a + b)/(a − b): the bar's shape, 1 for no bar or a dumbbell", "1", r"\sigma")
omega = _real("omega", "axial angular velocity of a rotor", "rad/s", r"\omega")
omega_1 = _real("omega_1", "axial angular velocity of rotor 1, psi_1' + phi_1' cos theta_1", "rad/s", r"\omega_1")
omega_2 = _real("omega_2", "axial angular velocity of rotor 2", "rad/s", r"\omega_2")
G = _real("G", "axial angular momentum I_3 omega", "kg m²/s")
G_1 = _real("G_1", "axial angular momentum of rotor 1", "kg m²/s")
G_2 = _real("G_2", "axial angular momentum of rotor 2", "kg m²/s")
Omega = _real("Omega", "angular frequency of the paired precession", "rad/s", r"\Omega")
r0 = _real("r_0", "amplitude: sine of the inclination when the two axes are parallel", "1")
theta_0 = _real("theta_0", "inclination that belongs to r_0 = sin theta_0", "rad", r"\theta_0")
Phi = _real("Phi", "phase of the paired precession, Omega t", "rad", r"\Phi")
t = _real("t", "time", "s")
A = _real("A", "the ansatz integral of phi", "kg m²/s")
B = _real("B", "the ansatz integral of psi", "kg m²/s")
a_const = _real("a_M", "the constant M_z / I of one rotor", "rad/s", "a")
M_z = _real("M_z", "angular momentum of one rotor about the vertical", "kg m²/s")
M_3 = _real("M_3", "axial angular momentum of one rotor", "kg m²/s")
nu = _real("nu", "rate of uniform turning about the joint line, alpha'", "rad/s", r"\nu")
rho = _positive("rho", "sine of the half-angle of the cone of equal spins", "1", r"\rho")
P = _real("P", "momentum about the joint line", "kg m²/s")
P_X = _real("p_x", "R times the impulse along x", "kg m²/s")
P_1 = _real("p_1", "R times the impulse along y on rotor 1", "kg m²/s")
P_2 = _real("p_2", "R times the impulse along y on rotor 2", "kg m²/s")
p_y = _real("p_y", "R times the impulse along y on the shocked rotor", "kg m²/s")
att = _positive("A_w", "what the pulse's width leaves of the swing, exp(−(Omega_0 w)²/4)", "1")
X = _real("X", "mean of U over the swing", "1")
TWIST = _real("Delta_s", "mean of the twist over the swing", "rad", r"\Delta_s")
SWING = _real("d", "amplitude of the swing in the twist", "rad")
a_1 = _real("a_1", "amplitude of cos Phi in x_1", "1")
COSINE = _real("c", "cosine of the phase", "1")

# One rotor, the pair, and the pair under the ansatz: the paper's Euler angles.
ROTOR: Coordinates = coordinates("theta phi psi")
PAIR: Coordinates = coordinates("theta_1 phi_1 psi_1 theta_2 phi_2 psi_2")
ANSATZ: Coordinates = coordinates("theta_1 theta_2 phi psi")
# The pair in Cartesian components of its two axes, in Mercator coordinates, and with the bar eliminated.
AXES: Coordinates = coordinates("x_1 y_1 z_1 x_2 y_2 z_2")
MERCATOR: Coordinates = coordinates("u_1 alpha_1 u_2 alpha_2")
MINIMAL: Coordinates = coordinates("U chi alpha")
TWISTED: Coordinates = coordinates("U Delta alpha")

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


def _add_coordinates() -> None:
    for c in (ROTOR, PAIR, ANSATZ, AXES, MERCATOR, MINIMAL, TWISTED):
        for q, v, acc in zip(c.q, c.v, c.a, strict=True):
            stem, _, index = q.name.partition("_")
            tex, meaning = _ANGLES[stem]
            unit = "1" if stem in "xyzuU" else "rad"
            tail = f"_{{{index}}}" if index else ""
            of = f" of rotor {index}" if index else ""
            GLOSSARY[q] = Entry(q, tex + tail, meaning + of, unit)
            GLOSSARY[v] = Entry(v, rf"\dot{{{tex}}}{tail}", f"rate of {q.name}", f"{unit}/s")
            GLOSSARY[acc] = Entry(acc, rf"\ddot{{{tex}}}{tail}", f"acceleration of {q.name}", f"{unit}/s²")


_add_coordinates()


def latex(expression: Any) -> str:
    """LaTeX in the glossary's letters, with dots over what a symbol's name calls a velocity or an acceleration."""
    free = (s for s in getattr(expression, "free_symbols", ()) if isinstance(s, sp.Symbol))
    return light(sp.latex(expression, symbol_names={s: _letter_of(s) for s in free}))


# sin, cos or tan, perhaps to a power, of one letter in brackets.
_OF_A_LETTER = re.compile(r"(\\(?:sin|cos|tan)(?:\^\{\d+\})?)\{\\left\((\\?[A-Za-z]+(?:_(?:\{\w+\}|\w))?) ?\\right\)\}")


def light(source: str) -> str:
    r"""LaTeX in which sine, cosine and tangent of one letter need no brackets: \cos\theta."""
    return _OF_A_LETTER.sub(r"\1 \2", source)


def _letter_of(symbol: sp.Symbol) -> str:
    if symbol in GLOSSARY:
        return GLOSSARY[symbol].latex
    dotted = re.fullmatch(r"(.+)_(d?dot)", symbol.name)
    return rf"\{dotted[2]}{{{sp.latex(sp.Symbol(dotted[1]))}}}" if dotted else sp.latex(symbol)
