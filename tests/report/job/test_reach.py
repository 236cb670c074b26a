"""What a script is made from: all that it reaches and nothing else; and the same digest wherever the package lies."""

import shutil
from pathlib import Path

import pytest

import lagrotor
from lagrotor.paper import Paper
from lagrotor.paper.rotor_pair.own_paper import PAPER
from lagrotor.report.job import reach
from lagrotor.report.job.reach import files_reached, imports, source_digest

PACKAGE = Path(lagrotor.__file__).parent


@pytest.fixture(autouse=True)
def fresh():
    clear()
    yield
    clear()


def clear() -> None:
    for cached in (
        reach._text,
        reach._face,
        reach.imports,
        reach.scripts_named,
        reach.files_reached,
        reach._file_digest,
        reach._data_in,
        reach._place,
    ):
        cached.cache_clear()


def derivation(stem: str) -> Path:
    return PAPER.scripts.path("derivations", stem)


def places(path: Path) -> set[str]:
    return {reach._place(file, PAPER) for file in files_reached(path, PAPER)}


def test_a_derivation_reaches_its_modules_and_their_data() -> None:
    found = places(derivation("s5_2a_single_rotor"))
    assert {
        "derivations/s5_2a_single_rotor.py",
        "pair/lagrangians.py",
        "mechanics/lagrangian.py",
        "algebra/identity.py",
    } <= found
    assert "paper/rotor_pair/equations.toml" in found
    assert "paper/rotor_pair/recorded.toml" not in found, "the record is compared with, nothing is made from it"
    # The check of a theorem makes a scene's program again: of the models it reaches the programs alone.
    assert not any(place.startswith(("report/", "commands/")) for place in found)
    assert {p.split("/")[1] for p in found if p.startswith("models/")} == {"programs"}


def test_names_of_the_face_lead_to_their_modules(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text("def later():\n    from lagrotor import simulate\n", encoding="utf-8")
    assert PACKAGE / "models" / "simulate.py" in files_reached(script, PAPER)
    assert imports(script, PAPER.folder) == {PACKAGE / "models" / "simulate.py"}
    script.write_text("from lagrotor.theory import twist_growth\n", encoding="utf-8")
    clear()
    assert imports(script, PAPER.folder) == {PACKAGE / "theory" / "parallel_twist.py"}


def test_a_script_that_names_a_derivation_is_made_from_it(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text('run("derivations", "s5_2a_single_rotor")', encoding="utf-8")
    assert derivation("s5_2a_single_rotor") in files_reached(script, PAPER)
    script.write_text('run("derivations", "no_such_script")', encoding="utf-8")
    clear()
    assert not any(file.parent.name == "derivations" for file in files_reached(script, PAPER))


@pytest.mark.parametrize(
    ("file", "matters"),
    [
        ("pair/lagrangians.py", True),
        ("paper/rotor_pair/equations.toml", True),
        ("models/simulate.py", False),
        ("report/page/page.css", False),
    ],
)
def test_a_product_is_made_from_what_is_reached_only(
    file: str, matters: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = tmp_path / "lagrotor"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__", "derivations", "figures"))
    for kind in ("derivations", "figures"):
        shutil.copytree(PAPER.scripts.base / kind, copy / kind, ignore=shutil.ignore_patterns("__pycache__"))
    here = source_digest(derivation("s5_2a_single_rotor"), PAPER)
    monkeypatch.setattr(reach, "_PACKAGE", copy)
    installed = Paper(copy / "paper" / "rotor_pair", scripts_in=copy)
    clear()
    there = copy / "derivations" / "s5_2a_single_rotor.py"
    assert source_digest(there, installed) == here, "an installed package has the digests of the checkout"
    with (copy / file).open("a", encoding="utf-8") as appended:
        appended.write("\n# changed\n")
    clear()
    assert (source_digest(there, installed) != here) == matters
