"""What a printed line may call, and what it may name."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import letter_latex
from lagrotor.paper.grammar import components, cross, cross_matrix, declared, inverse, rate, read, symmetric, vector
from lagrotor.paper.rotor_pair.own_paper import PAPER

r, v, a = vector("r"), vector("v"), vector("a")


def test_a_rate_follows_what_moves_and_nothing_else() -> None:
    m = sp.Symbol("m")
    assert rate(m * r, (r,), (v,)) == m * v
    assert rate(r.dot(r), (r,), (v,)) == 2 * sum(x * y for x, y in zip(r, v, strict=True))
    assert rate(v, (r,), (v,)) == sp.zeros(3, 1)
    both = rate(cross(r, v), (r, v), (v, a))
    assert decide_equal(both, cross(r, a)).answer == "zero"
    assert decide_equal(both, cross(a, r)).answer == "nonzero"
    with pytest.raises(ValueError, match="shorter"):
        rate(r, (r,), (m,))


def test_the_inverse_is_the_inverse() -> None:
    matrix = sp.eye(3) + cross_matrix(r)
    assert decide_equal(matrix * inverse(matrix), sp.eye(3)).answer == "zero"
    assert decide_equal(matrix * inverse(matrix.T), sp.eye(3)).answer == "nonzero"


def test_a_symmetric_letter_has_six_components() -> None:
    matrix = symmetric("I_0")
    assert matrix == matrix.T == declared({"symmetric": "I_0"})["I_0"]
    assert len(matrix.free_symbols) == 6


def test_components_take_vectors_apart() -> None:
    x = sp.Symbol("x")
    assert components((x, r)) == [x, *r]


def test_a_section_reads_its_own_letters_before_those_of_the_glossary() -> None:
    assert read("cross(F, r)", declared({"vector": "F r"}), "here") == cross(vector("F"), r)
    with pytest.raises(InputError, match="declare the letter"):
        read("cross(F, r)", {}, "here")
    with pytest.raises(InputError, match="not a kind of letter"):
        declared({"tensor": "T"})


def test_a_scene_may_give_vectors_and_matrices() -> None:
    scene = {symbol.name: value for symbol, value in PAPER.lines("4.03")[0].scene.items()}
    assert (scene["Omega_1_z"], scene["Omega_1_x"], scene["I_2_xx"], scene["I_2_xy"], scene["s_1"]) == (10, 0, 1, 0, 0)


def test_a_component_of_a_vector_of_rates_has_its_dot() -> None:
    names = {
        "d_dotx": r"\dot{d}_x",
        "r_1_dotz": r"\dot{r}_{1z}",
        "theta_1_dot": r"\dot{\theta}_1",
        "x_ddot": r"\ddot{x}",
    }
    assert {name: letter_latex(sp.Symbol(name)) for name in names} == names
