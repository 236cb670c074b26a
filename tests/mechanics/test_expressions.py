"""What a system, a frame, a body or a run cannot mean is refused with the way out."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.mechanics.expressions import shortest

m, g, l = sp.symbols("m g l", positive=True)
C = coordinates("theta")
(theta,), (theta_v,) = C.q, C.v
PENDULUM = System(C, m * l**2 * theta_v**2 / 2 + m * g * l * sp.cos(theta))
VALUES, TIMES = {m: 1, g: 9.81, l: 1}, (0, 1)
MOVING = sp.Function("q")(sp.Symbol("t"))
BODY = Frame(C).turned("z", theta).body(m, (1, 1, 1))


def run():
    return PENDULUM.simulate(VALUES, (1,), (0,), TIMES)


REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "a function of time": (lambda: System(C, MOVING.diff() ** 2), "two different symbols are called 't'"),
    "no Lagrangian": (lambda: System(C, None), "L = None is no expression"),
    "a matrix for a Lagrangian": (lambda: System(C, sp.Matrix([theta_v])), "L = Matrix.* is no expression"),
    "a Lagrangian of accelerations": (lambda: System(C, C.a[0] * theta), "L contains theta_ddot"),
    "one constraint alone": (lambda: System(C, theta_v**2, theta), r"must be a tuple of expressions: write \(theta,\)"),
    "a dictionary of forces": (lambda: System(C, theta_v**2, forces={theta: 1}), "must be a tuple of expressions$"),
    "an equation": (lambda: System(C, theta_v**2, (sp.Eq(theta, 1),)), "is no expression"),
    "text for a shift": (lambda: Frame(C).moved("x"), r"moved: \(x, y, z\)\[0\] = 'x' is no expression"),
    "text for an angle": (lambda: Frame(C).turned("z", ["30"]), "turned: angle = '30' is no expression"),
    "a negative mass": (lambda: Frame(C).body(-1), "mass = -1 must not be negative"),
    "a negative inertia": (lambda: Frame(C).body(1, (1, 1, -1)), "must not be negative about an axis"),
    "a field of one number": (lambda: BODY.potential(-g), "field = -g must be 3 expressions"),
    "a field of two numbers": (lambda: BODY.potential((0, -g)), r"field = \(0, -g\) must be 3 expressions"),
    "a list of values": (lambda: PENDULUM.simulate([1, 2], (1,), (0,), TIMES), "must be {symbol: number, …}"),
    "one time": (lambda: PENDULUM.simulate(VALUES, (1,), (0,), 5), "t = 5 must be an increasing array.*linspace"),
    "times that fall": (lambda: PENDULUM.simulate(VALUES, (1,), (0,), (5, 0)), r"t = \(5, 0\) must be an increasing"),
    "an unknown engine": (lambda: PENDULUM.rhs(VALUES, "gpu"), "engine = 'gpu' is neither core nor fast"),
    "a section in words": (lambda: run().crossings("theta"), "section = 'theta' is no expression"),
    "a section that is an inequality": (lambda: run().crossings(theta > 0), "is no expression"),
    "one coordinate of a section": (lambda: run().poincare(theta, theta), "of = theta must be 2 expressions"),
    "a vector along a run": (lambda: run().evaluate(sp.Matrix([theta])), "is no expression"),
    "a number for a transformation": (lambda: PENDULUM.noether(1), "ξ = 1: a transformation has one component"),
    "a function without code": (
        lambda: System(C, theta_v**2 - sp.besselj(0, theta)).simulate({}, (1,), (0,), TIMES),
        r"besselj\(1, theta\) has no code in Python's math module",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_it_is_refused_with_the_way_out(what: str) -> None:
    call, words = REFUSED[what]
    with pytest.raises(InputError, match=words):
        call()


def test_a_function_that_the_fast_engine_does_not_know_is_named() -> None:
    pytest.importorskip("heyoka")
    rough = System(C, theta_v**2 / 2, forces=(-theta_v * sp.Abs(theta_v),))
    with pytest.raises(InputError, match="no force that jumps: use engine='core'"):
        rough.simulate({}, (1,), (1,), TIMES, engine="fast")
    odd = System(C, theta_v**2 / 2, forces=(-theta_v * sp.loggamma(2 + theta**2),))
    with pytest.raises(InputError, match="does not know the function loggamma: use engine='core'"):
        odd.simulate({}, (1,), (1,), TIMES, engine="fast")
    assert rough.simulate({}, (1,), (1,), TIMES).v[-1] == pytest.approx(1 / 2)  # v' = −v²


def test_what_makes_sense_is_taken() -> None:
    assert System(C, theta_v**2, [theta]).constraints == (theta,)
    assert run().at(0.5).q.shape == (1, 1)
    assert np.isfinite(PENDULUM.simulate({"m": sp.Rational(1, 2), g: 9.81, l: sp.pi}, (1,), (0,), TIMES).q).all()


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
