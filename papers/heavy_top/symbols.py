"""The letters of the heavy symmetric top."""

from lagrotor.mechanics import coordinates
from lagrotor.paper import Glossary

GLOSSARY = Glossary()
letter = GLOSSARY.letter
I_1 = letter("I_1", "transverse inertia about the fixed tip", "kg m²", positive=True)
I_3 = letter("I_3", "axial inertia", "kg m²", positive=True)
m = letter("m", "mass", "kg", positive=True)
g = letter("g", "acceleration of free fall", "m/s²", positive=True)
l = letter("l", "distance of the centre of mass from the tip", "m", positive=True)
p_phi = letter("p_phi", "angular momentum about the vertical", "kg m²/s", real=True)
p_psi = letter("p_psi", "angular momentum about the axis", "kg m²/s", real=True)
omega_3 = letter("omega_3", "axial angular velocity, psi' + phi' cos theta", "rad/s", positive=True)
Omega = letter("Omega", "rate of steady precession", "rad/s", real=True)
theta_0 = letter("theta_0", "inclination at which the top is released", "rad", real=True)
epsilon = letter("epsilon", "weakness of gravity: potential over rotational energy", "1", positive=True)
c = GLOSSARY.moving(
    coordinates("phi theta psi"),
    ("azimuth of the axis", "rad"),
    ("inclination of the axis", "rad"),
    ("spin angle", "rad"),
)
