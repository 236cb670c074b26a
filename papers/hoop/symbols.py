"""The letters of the paper with meanings and units."""

from lagrotor.paper import Glossary

GLOSSARY = Glossary()
m = GLOSSARY.letter("m", "mass of the bead", "kg", positive=True)
R = GLOSSARY.letter("R", "radius of the hoop", "m", positive=True)
g = GLOSSARY.letter("g", "acceleration of free fall", "m/s²", positive=True)
Omega = GLOSSARY.letter("Omega", "rate at which the hoop turns", "rad/s", positive=True)
theta = GLOSSARY.letter("theta", "angle of the bead from the lowest point", "rad", real=True)
theta_dot = GLOSSARY.letter("theta_dot", "rate of theta", "rad/s", real=True)
theta_ddot = GLOSSARY.letter("theta_ddot", "acceleration of theta", "rad/s²", real=True)
theta_0 = GLOSSARY.letter("theta_0", "angle at which the bead of a fast hoop rests", "rad", real=True)
