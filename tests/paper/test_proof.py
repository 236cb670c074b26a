"""A step is shown with both sides, and refused where it does not hold or cannot be decided."""

import pytest
import sympy as sp

from lagrotor.errors import ProofError
from lagrotor.pair.notation import theta_0
from lagrotor.paper import prove

x, y = sp.symbols("x y", real=True)
SQUARES = sp.sin(x) ** 2 + sp.cos(x) ** 2


def test_a_step_that_holds_shows_both_sides() -> None:
    step = prove(sp.tan(x) * sp.cos(x), sp.sin(x), "a quotient")
    assert step.tex.count("&=") == 1
    assert r"\tan x" in step._repr_latex_()
    assert step.domain == (sp.cos(x),)


def test_rows_and_matrices_are_proved_entry_by_entry() -> None:
    assert prove((SQUARES, x), (1, x)).tex.count("&=") == 2
    turn = sp.Matrix([[sp.cos(x), -sp.sin(x)], [sp.sin(x), sp.cos(x)]])
    assert prove(turn * turn.T, sp.eye(2)).pairs
    with pytest.raises(ProofError, match="2 left sides and 1 right"):
        prove((x, y), (x,))


@pytest.mark.parametrize(
    ("left", "right"), [(SQUARES, 2), (sp.Function("f")(x), x), ((x, y), (x, -y)), (sp.eye(2), 2 * sp.eye(2))]
)
def test_what_does_not_hold_or_is_not_decided_is_refused(left, right) -> None:
    with pytest.raises(ProofError, match="this claim"):
        prove(left, right, "this claim")


def test_a_series_is_held_to_its_order() -> None:
    step = prove(sp.cos(theta_0), 1 - theta_0**2 / 2, "the cosine", small=theta_0, order=3)
    assert r"O\left(\theta_0^{4}\right)" in step.tex
    with pytest.raises(ProofError, match="first differ at order 4"):
        prove(sp.cos(theta_0), 1 - theta_0**2 / 2, "the cosine", small=theta_0, order=4)


def test_a_long_left_side_is_named_or_the_equation_written() -> None:
    assert prove(SQUARES, 1, names=r"|r|^2").tex == r"\begin{aligned} |r|^2 &= 1 \end{aligned}"
    long = sum(sp.Symbol(f"a_{n}") for n in range(60))
    assert prove(long, long, names="A").tex.startswith(r"\begin{aligned} A &=")
    assert prove(long, long, equations=r"A = \sum_n a_n").tex == r"\begin{aligned} A = \sum_n a_n \end{aligned}"
    with pytest.raises(ProofError, match="give `names` or `equations`"):
        prove(long, long)
    with pytest.raises(ProofError, match="2 equations are written for 1"):
        prove(x, x, equations=("a", "b"))
    with pytest.raises(ProofError, match="2 names for 1"):
        prove(x, x, names=("a", "b"))
