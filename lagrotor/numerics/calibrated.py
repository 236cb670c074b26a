"""Constants found by trial, of the solvers: what each was calibrated on, and the test that holds it."""

from math import pi

CROSSOVER = 5e-11
DETOUR = 4 * pi
