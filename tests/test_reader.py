"""What the reader's edition answers, here without a browser; `make test-reader` asks it in one."""

import sys
import tomllib
from functools import cache
from pathlib import Path

import pytest

EDITION = Path(__file__).parents[1] / "docs" / "edition"
EXAMPLES = tomllib.loads((EDITION / "examples.toml").read_text(encoding="utf-8"))
FIELDS = {
    "judge": ("equation", "given", "positive", "small", "order"),
    "system": ("c", "L", "constraints", "positive", "integral", "at"),
}


@cache
def answer(kind: str, **fields: str) -> str:
    """The answer of a form, with the fields that are left empty."""
    sys.path.insert(0, str(EDITION))
    import answers

    return str(answers.answer(kind, **(dict.fromkeys(FIELDS[kind], "") | fields)))


def example(held: dict[str, str], kind: str) -> str:
    """The answer of a form that begins with this example."""
    return answer(kind, **{name: text for name, text in held.items() if name in FIELDS[kind]})


@pytest.mark.parametrize("kind", EXAMPLES)
def test_every_example_is_answered_with_formulas(kind: str) -> None:
    for each in EXAMPLES[kind]:
        said = example(each, kind)
        assert "refusal" not in said and "<math" in said, (each["title"], said[:200])


def test_examples_have_the_verdicts_they_speak_of() -> None:
    said = {
        each["title"]: answer("judge", **{n: t for n, t in each.items() if n in FIELDS["judge"]})
        for each in EXAMPLES["judge"]
    }
    verdicts = {title: text.partition("verdict ")[2].partition('"')[0] for title, text in said.items()}
    assert list(verdicts.values()) == ["holds-if", "holds", "refuted", "holds-if"]
    assert "x ≥ 0" not in said["Logarithms"] and "<mo>&gt;</mo>" in said["Logarithms"]


def test_a_lagrangian_has_its_cyclic_coordinates_and_integrals() -> None:
    top = next(each for each in EXAMPLES["system"] if "top" in each["title"])
    said = example(top, "system")
    assert "φ is cyclic" in said and "ψ is cyclic" in said and "θ is cyclic" not in said
    assert "The energy is conserved" in said and "It is conserved" in said
    assert "It is not conserved" in answer("system", c="x", L="x_dot**2/2 - x**4", integral="x*x_dot")
    assert "The energy is not conserved" in answer("system", c="x", L="x_dot**2/2 - x**2*sin(t)")


@pytest.mark.parametrize(
    ("fields", "says"),
    [
        ({"c": "x", "L": "x_dot**2/2 - y_dot"}, "<math"),  # a letter like any other
        ({"c": "", "L": "1"}, "refusal"),
        ({"c": "x", "L": "x_dot^2"}, "write ** for a power"),
        ({"c": "x", "L": "x"}, "refusal"),  # no mass
        ({"c": "x", "L": "__import__('os')"}, "refusal"),
        ({"c": "x", "L": "x_dot**2/2", "at": "y = 0"}, "refusal"),
    ],
)
def test_what_is_no_system_is_refused_in_words(fields: dict[str, str], says: str) -> None:
    said = answer("system", **fields)
    assert says in said and "<script" not in said
