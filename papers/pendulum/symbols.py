"""The letters of the paper with meanings and units: they are used in its printed lines, its derivations and its notation."""

from lagrotor.mechanics import coordinates
from lagrotor.paper import Glossary

GLOSSARY = Glossary()
g = GLOSSARY.letter("g", "acceleration of free fall", "m/s²", positive=True)
l = GLOSSARY.letter("l", "length of the pendulum", "m", positive=True)
m = GLOSSARY.letter("m", "mass of the bob", "kg", positive=True)
# theta, theta_dot, theta_ddot: plain symbols.
c = GLOSSARY.moving(coordinates("theta"), ("angle from the vertical", "rad"))
