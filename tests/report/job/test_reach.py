"""What a script's product is made from; and the same digest wherever the package lies."""

import shutil
from pathlib import Path

import pytest

import lagrotor
from lagrotor.paper import Paper
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.job import dependencies
from lagrotor.report.job.dependencies import scripts_named, source_digest, values_taken

PACKAGE = Path(lagrotor.__file__).parent


@pytest.fixture(autouse=True)
def fresh():
    clear()
    yield
    clear()


def clear() -> None:
    for cached in (dependencies._text, dependencies._place, dependencies._shared, dependencies._stems, scripts_named):
        cached.cache_clear()


def test_a_script_names_the_derivations_that_it_runs(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        'run("derivations", "s5_2a_single_rotor"); run("derivations", "no_such_script")', encoding="utf-8"
    )
    assert scripts_named(script, PAPER) == ("s5_2a_single_rotor",)
    path = PAPER.scripts.path("derivations", "p1_past_the_paper")
    assert {stem[:2] for stem in scripts_named(path, PAPER)} >= {"t1", "t9", "n6"}
    assert {"measured", "edges"} <= values_taken("t5_floquet", PAPER)
    assert "values" not in values_taken("t5_floquet", PAPER)  # twin: a name that nobody takes


@pytest.mark.parametrize(
    ("file", "matters"),
    [
        ("pair/lagrangians.py", True),
        ("paper/rotor_pair/equations.toml", True),
        ("paper/rotor_pair/recorded.toml", False),  # it is compared with, and nothing is made from it
        ("derivations/p1_past_the_paper.py", True),
        ("derivations/t1_natural_rate.py", True),
        ("derivations/s6_conclusion.py", False),
    ],
)
def test_a_product_is_made_from_its_script_those_it_runs_and_the_package(
    file: str, matters: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = tmp_path / "lagrotor"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__", "derivations", "figures"))
    for kind in ("derivations", "figures"):
        shutil.copytree(PAPER.scripts.base / kind, copy / kind, ignore=shutil.ignore_patterns("__pycache__"))
    here = source_digest(PAPER.scripts.path("derivations", "p1_past_the_paper"), PAPER)
    monkeypatch.setattr(dependencies, "_PACKAGE", copy)
    installed = Paper(copy / "paper" / "rotor_pair", scripts_in=copy)
    clear()
    there = copy / "derivations" / "p1_past_the_paper.py"
    assert source_digest(there, installed) == here, "an installed package has the digests of the checkout"
    with (copy / file).open("a", encoding="utf-8") as appended:
        appended.write("\n# changed\n")
    clear()
    assert (source_digest(there, installed) != here) == matters
