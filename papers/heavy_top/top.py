"""The top as a system: what its derivations, runs and figures have in common."""

import sympy as sp
from symbols import I_1, I_3, c, g, l, m

from lagrotor.mechanics import Frame, System

# The transverse inertia about the centre is I_1 − m l².
body = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(I_1 - m * l**2, I_1 - m * l**2, I_3), centre=(0, 0, l))
top = System(c, body.kinetic - m * g * l * sp.cos(c.q[1]))
# That of the runs, SI units.
VALUES = {I_1: 0.66, I_3: 0.5, m: 1.0, g: 9.81, l: 0.6}
