"""Energies and momenta are written as short as a textbook writes them."""

import sympy as sp

from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.mechanics.expressions import shortest

m, g, l = sp.symbols("m g l", positive=True)


def test_what_is_found_is_written_as_a_textbook_writes_it() -> None:
    """Energy and momenta of a heavy top, from the components of its angular velocity in the body."""
    I1, I3 = sp.symbols("I_1 I_3", positive=True)
    c = coordinates("phi theta psi")
    (_, inclination, _), (turning, falling, spinning) = c.q, c.v
    body = Frame(c).turned("zxz", c.q).body(m, (I1, I1, I3))
    top = System(c, body.kinetic - m * g * l * sp.cos(inclination))
    kinetic = I1 * (turning**2 * sp.sin(inclination) ** 2 + falling**2) / 2
    kinetic += I3 * (turning * sp.cos(inclination) + spinning) ** 2 / 2
    assert top.energy == sp.expand(kinetic + m * g * l * sp.cos(inclination))
    assert top.noether((0, 0, 1)).expression == sp.expand(I3 * (turning * sp.cos(inclination) + spinning))


def test_no_shorter_form_is_taken_for_one_nor_sought_of_what_nobody_reads() -> None:
    x, y = sp.symbols("x y", real=True)
    assert shortest((x + y) ** 9) == (x + y) ** 9
    assert shortest(m * x * sp.cos(y) ** 2 - m * x) == -m * x * sp.sin(y) ** 2
    assert shortest(x - 2 * x * sp.cos(y) ** 2) == x - 2 * x * sp.cos(y) ** 2
    assert shortest(sp.atan(x) - sp.atan(x + 1)) == sp.atan(x) - sp.atan(x + 1)
    long = sum(sp.sin(n * x) ** 2 + sp.cos(n * x) ** 2 for n in range(1, 200))
    assert shortest(long) == long
