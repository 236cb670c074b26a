"""The glossary of the pair of rotors: every symbol with its meaning and its unit.

Coordinates, velocities and accelerations are plain symbols: `theta_1`, `theta_1_dot`, `theta_1_ddot`.
"""

from functools import partial

import sympy as sp

from lagrotor.mechanics.glossary import Glossary
from lagrotor.mechanics.lagrangian import Coordinates, coordinates

GLOSSARY = Glossary()
_real = partial(GLOSSARY.letter, real=True)
_positive = partial(GLOSSARY.letter, positive=True)
_nonnegative = partial(GLOSSARY.letter, nonnegative=True)

M = _positive("M", "mass of a rotor", "kg")
R = _positive("R", "length of a rotor's axis from the ground joint to the tip", "m")
I1 = _positive("I_1", "transverse inertia of a rotor about its centre", "kg m²")
I3 = _positive("I_3", "axial inertia of a rotor", "kg m²")
I = _positive("I", "the paper's uniform inertia, I_1 = I_3 = I", "kg m²")
J = _positive("J", "transverse inertia of a rotor about its ground joint, I_1 + M R²/4", "kg m²")
ell = _positive("ell", "length of the link bar, distance of the ground joints", "m")
m = _nonnegative("m", "mass of the bar", "kg")
K = _nonnegative("K", "transverse inertia of the bar about its centre", "kg m²")
k = _positive("k", "ell / R: length of the bar in units of a rotor's", "1")
a = _positive("a", "J + m R²/4 + K R²/ell²: inertia of one axis, its share of the bar included", "kg m²")
b = _real("b", "m R²/4 − K R²/ell²: inertia by which the bar couples the axes", "kg m²")
sigma = _positive("sigma", "(a + b)/(a − b): the bar's shape, 1 for no bar or a dumbbell", "1")
omega = _real("omega", "axial angular velocity of a rotor", "rad/s")
omega_1 = _real("omega_1", "axial angular velocity of rotor 1, psi_1' + phi_1' cos theta_1", "rad/s")
omega_2 = _real("omega_2", "axial angular velocity of rotor 2", "rad/s")
G = _real("G", "axial angular momentum I_3 omega", "kg m²/s")
G_1 = _real("G_1", "axial angular momentum of rotor 1, I_3 omega_1", "kg m²/s")
G_2 = _real("G_2", "axial angular momentum of rotor 2, I_3 omega_2", "kg m²/s")
Omega = _real("Omega", "angular frequency of the paired precession", "rad/s")
r0 = _real("r_0", "amplitude: sine of the inclination when the two axes are parallel", "1")
q = _positive("q", "average inclination divided by r_0: the mean of √(cos² Phi + sigma sin² Phi) over a turn", "1")
A_x = _positive("A_x", "amplitude of a tip along the joint line, R r_0", "m")
A_y = _positive("A_y", "amplitude of a tip across the joint line, R √sigma r_0", "m")
theta_0 = _real("theta_0", "inclination of the parallel axes: its sine is r_0", "rad")
Phi = _real("Phi", "phase of the paired precession, Omega t", "rad")
t = _real("t", "time", "s")
A = _real("A", "the ansatz integral of phi", "kg m²/s")
B = _real("B", "the ansatz integral of psi", "kg m²/s")
a_const = _real("a_M", "the constant M_z / I of one rotor", "rad/s")
M_z = _real("M_z", "angular momentum of one rotor about the vertical", "kg m²/s")
M_3 = _real("M_3", "axial angular momentum of one rotor", "kg m²/s")
nu = _real("nu", "rate of uniform turning about the joint line, alpha'", "rad/s")
rho = _positive("rho", "sine of the half-angle of the cone of equal spins", "1")
P = _real("P", "momentum about the joint line", "kg m²/s")
P_X = _real("p_x", "R times the impulse along x", "kg m²/s")
P_1 = _real("p_1", "R times the impulse along y on rotor 1", "kg m²/s")
P_2 = _real("p_2", "R times the impulse along y on rotor 2", "kg m²/s")
p_y = _real("p_y", "R times the impulse along y on the shocked rotor", "kg m²/s")
att = _positive("A_w", "factor by which the width of the pulse reduces the swing, exp(−(Omega_0 w)²/4)", "1")
LEAN = _real("beta_s", "lean of the mean axis along the joint line, mean over the swing", "rad")
HALF = _real("eta", "half the angle between the axes, mean over the swing", "rad")
SWING = _real("s", "amplitude of the swing in half the angle between the axes", "rad")

_ANGLES = {
    "theta": "inclination of the axis",
    "phi": "azimuth of the axis",
    "psi": "spin angle",
    "x": "component of the axis along the joint line",
    "y": "horizontal component of the axis across the joint line",
    "z": "vertical component of the axis",
    "u": "Mercator latitude about the joint line, artanh x",
    "alpha": "turning angle about the joint line",
    "U": "mean Mercator latitude (u_1 + u_2)/2",
    "chi": "twist of the pair, alpha_2 − alpha_1 when ell >= R",
    "Delta": "twist of the pair, alpha_2 − alpha_1",
    "beta": "lean of the mean axis along the joint line",
    "h": "half the angle between the axes",
}


def _row(q: sp.Symbol) -> tuple[str, str]:
    """Return the meaning and the unit of a coordinate."""
    stem, _, index = q.name.partition("_")
    return _ANGLES[stem] + (f" of rotor {index}" if index else ""), "1" if stem in "xyzuU" else "rad"


def _coordinates(names: str) -> Coordinates:
    c = coordinates(names)
    return GLOSSARY.moving(c, *map(_row, c.q))


# One rotor, the pair, and the pair under the ansatz: the paper's Euler angles.
ROTOR: Coordinates = _coordinates("theta phi psi")
PAIR: Coordinates = _coordinates("theta_1 phi_1 psi_1 theta_2 phi_2 psi_2")
ANSATZ: Coordinates = _coordinates("theta_1 theta_2 phi psi")
# The pair in Cartesian components of its two axes, in Mercator coordinates, and with the bar eliminated:
# by one parameter, near no twist, and by the mean axis and the angle between the axes.
AXES: Coordinates = _coordinates("x_1 y_1 z_1 x_2 y_2 z_2")
MERCATOR: Coordinates = _coordinates("u_1 alpha_1 u_2 alpha_2")
MINIMAL: Coordinates = _coordinates("U chi alpha")
TWISTED: Coordinates = _coordinates("U Delta alpha")
LEANING: Coordinates = _coordinates("beta h alpha")
