"""Two symbols of one name are refused wherever symbols come in; one symbol used twice, and a dummy, are not."""

import pytest
import sympy as sp

from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.numerics.codegen import Program
from lagrotor.paper import Premise, judge, prove, verdict
from lagrotor.paper.equation_statements import statement
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

g, other_g = sp.Symbol("g", positive=True), sp.Symbol("g")
x = sp.Symbol("x", real=True)
c = coordinates("theta")
theta, theta_dot = c.q[0], c.v[0]


def pendulum(own: sp.Symbol, second: sp.Symbol) -> System:
    return System(c, theta_dot**2 / 2 + own * sp.cos(theta), forces=(second * theta,))


@pytest.mark.parametrize(
    "door",
    [
        lambda s: check_names("here", g * x, {s: 1}),
        lambda s: check_names("here", [sp.Matrix([g, s])]),
        lambda s: pendulum(g, s),
        lambda s: Frame(c).turned("z", g * theta).moved(s, 0, 0),
        lambda s: Program((g, x), (), (s * x,)),
        lambda s: prove(g * x, s * x, names="g x"),
        lambda s: judge(g * x, s * x),
        lambda s: judge(g * x, g * x, premises={x: s}),
        lambda s: judge(g * x, g * x, premises=[Premise("x is g", {x: s})]),
        lambda s: judge("g*x", g * x, premises={s: 1}),
    ],
)
def test_two_symbols_of_one_name_are_refused_at_the_door(door) -> None:
    door(g)
    with pytest.raises(InputError, match="two different symbols are called 'g'"):
        door(other_g)


def test_a_statement_is_refused_that_does_not_use_the_papers_letter() -> None:
    total = sum(sp.symbols("m_1:4", positive=True))
    statement(verdict("3.01", total), PAPER)
    with pytest.raises(InputError, match=r"3\.01: two different symbols are called 'm_1'"):
        statement(verdict("3.01", sum(sp.symbols("m_1:4"))), PAPER)


def test_a_dummy_is_no_other_letter() -> None:
    check_names("here", sp.Dummy("g") * g * sp.Dummy("g"))
