"""The trial of printed mathematics knows no paper of its own: what is said of rotors lies in `rotor_pair/`."""

import re
from pathlib import Path

import pytest

import lagrotor

ENGINE = sorted((Path(lagrotor.__file__).parent / "paper").glob("*.py"))
OWN = re.compile(r"\b(rotor|spin|the pair|paired|rod|lagrotor\.(pair|theory|models|benchmark))", re.IGNORECASE)


@pytest.mark.parametrize("path", ENGINE, ids=lambda path: path.stem)
def test_no_module_of_the_engine_names_one_paper(path: Path) -> None:
    # The examples of docstrings open the paper that comes with the package.
    text = path.read_text(encoding="utf-8").replace(
        ">>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER", ""
    )
    assert OWN.findall(text) == []


def test_a_name_of_one_paper_would_be_seen() -> None:
    for line in ("the spins are equal", "from lagrotor.pair.notation import J", "# of the rotor pair"):
        assert OWN.search(line)
