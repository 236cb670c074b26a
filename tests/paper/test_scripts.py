"""A derivation whose values come from another process is not run; what did not come is taken by running it."""

from pathlib import Path

import pytest

from lagrotor.paper.scripts import Scripts


@pytest.fixture
def scripts(tmp_path: Path) -> Scripts:
    (tmp_path / "derivations").mkdir()
    (tmp_path / "derivations" / "t1_one.py").write_text("rate = 2\nmass = 3\n")
    return Scripts(tmp_path)


def test_values_from_elsewhere_are_taken_without_a_run(scripts: Scripts) -> None:
    with scripts.ran_elsewhere({"t1_one": {"rate": 5}}):
        assert scripts.run("derivations", "t1_one")["rate"] == 5
    assert not scripts.ran


def test_a_value_that_did_not_come_is_computed_here(scripts: Scripts) -> None:
    with scripts.ran_elsewhere({"t1_one": {"rate": 5}}):
        assert scripts.run("derivations", "t1_one")["mass"] == 3
    assert len(scripts.ran) == 1


def test_outside_the_block_the_script_runs(scripts: Scripts) -> None:
    with scripts.ran_elsewhere({"t1_one": {"rate": 5}}):
        pass
    assert scripts.run("derivations", "t1_one")["rate"] == 2
