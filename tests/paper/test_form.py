"""Results as they are written: one text gives the LaTeX and the components, and a form that is not the result is refused."""

import pytest
import sympy as sp

from lagrotor.errors import InputError, ProofError
from lagrotor.paper import verdict
from lagrotor.paper.equation_statements import statement
from lagrotor.paper.grammar import cross, vector
from lagrotor.paper.proof import form
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

DECLARED = PAPER.letters("3")


def test_a_text_in_vectors_gives_its_components() -> None:
    m = sp.symbols("m_1:4", positive=True)
    arms, velocities = ([vector(f"{name}_{i}") for i in (1, 2, 3)] for name in "XU")
    by_hand = sum((c * cross(r, v) for c, r, v in zip(m, arms, velocities, strict=True)), sp.zeros(3, 1))
    found = form("sum_i(m_i*cross(X_i, U_i))").value(DECLARED)
    assert (found - by_hand).applyfunc(sp.expand) == sp.zeros(3, 1)
    assert form("sum_i(m_i)/2", bodies=2).value(DECLARED) == (m[0] + m[1]) / 2


@pytest.mark.parametrize(
    ("text", "tex"),
    [
        ("F - M*U", r"\vec{F} - M \vec{U}"),
        ("sum_i(m_i*X_i)", r"\sum_i m_{i} \vec{X}_{i}"),
        ("cross(F, cross(L, F))", r"\vec{F}\times \left(\vec{L}\times \vec{F}\right)"),
        ("dot(U_1, U_1)/2", r"\frac{\vec{U}_{1}^{2}}{2}"),
        ("phi_dot*cos(theta)", r"\dot{\phi} \cos \theta"),
        ("Q*I_0*transpose(Q)", r"Q I_{0} Q^{T}"),
        ("Delta_t*F", r"\Delta t \vec{F}"),
        ("M + M", "M + M"),
        ("norm(X_1)", r"\left\|\vec{X}_{1}\right\|"),
        ("2*hat_r_1_dot", r"2 \dot{\hat{r}}_{1}"),
    ],
)
def test_a_text_is_written_as_it_stands(text: str, tex: str) -> None:
    assert form(text, Q=sp.eye(3), hat_r_1_dot=vector("v")).tex(DECLARED) == tex


def test_a_form_that_is_not_the_result_is_refused() -> None:
    derived = sum(sp.symbols("m_1:4", positive=True))
    assert statement(verdict("3.01", derived, form=form("sum_i(m_i)")), PAPER).relations[0].written == r"\sum_i m_{i}"
    with pytest.raises(ProofError, match="is not what was derived"):
        statement(verdict("3.01", derived, form=form("sum_i(2*m_i)")), PAPER)
    with pytest.raises(InputError, match="which was not derived"):
        statement(verdict("3.01", derived, form={"N": form("sum_i(m_i)")}), PAPER)


@pytest.mark.parametrize("text", ["sum_i(m_i", "nobody*2"])
def test_a_text_that_cannot_be_read_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        form(text).value(DECLARED)
