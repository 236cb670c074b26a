"""What a printed line may call, and what it may name."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import letter_latex
from lagrotor.paper.grammar import cross, declared, rate, read, vector

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


def test_a_section_reads_its_own_letters_before_those_of_the_glossary() -> None:
    assert read("cross(F, r)", declared({"vector": "F r"}), "here") == cross(vector("F"), r)
    with pytest.raises(InputError, match="declare the symbol"):
        read("cross(F, r)", {}, "here")
    with pytest.raises(InputError, match="not a kind of symbol"):
        declared({"tensor": "T"})


def test_a_component_of_a_vector_of_rates_has_its_dot() -> None:
    names = {
        "d_dotx": r"\dot{d}_x",
        "r_1_dotz": r"\dot{r}_{1z}",
        "theta_1_dot": r"\dot{\theta}_1",
        "x_ddot": r"\ddot{x}",
    }
    assert {name: letter_latex(sp.Symbol(name)) for name in names} == names
