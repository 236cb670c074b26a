"""A derivation whose values come from another process is not run; what did not come is taken by running it."""

import warnings
from pathlib import Path

import pytest

from lagrotor.errors import LagrotorWarning
from lagrotor.paper.scripts import Scripts


@pytest.fixture
def scripts(tmp_path: Path) -> Scripts:
    (tmp_path / "derivations").mkdir()
    (tmp_path / "derivations" / "t1_one.py").write_text("rate = 2\nmass = 3\n")
    return Scripts(tmp_path)


def test_values_from_elsewhere_are_taken_without_a_run(scripts: Scripts) -> None:
    with scripts.remote_values({"t1_one": {"rate": 5}}):
        assert scripts.run("derivations", "t1_one")["rate"] == 5
    assert not scripts.ran


def test_a_value_that_did_not_come_is_computed_here(scripts: Scripts) -> None:
    with scripts.remote_values({"t1_one": {"rate": 5}}):
        assert scripts.run("derivations", "t1_one")["mass"] == 3
    assert len(scripts.ran) == 1


def test_its_warnings_are_not_those_of_the_script_that_imports_it(scripts: Scripts) -> None:
    (scripts.base / "derivations" / "t1_one.py").write_text(WARNS)
    with scripts.remote_values({"t1_one": {}}), warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert callable(scripts.run("derivations", "t1_one")["run"])
    assert not [warning for warning in caught if issubclass(warning.category, LagrotorWarning)]


WARNS = """# %%
import warnings
from lagrotor.errors import LagrotorWarning
def run():
    warnings.warn("tol = 1e-13 is not kept", LagrotorWarning)
    warnings.warn("of another tool")
run()
run()
# %%
1 + 1
"""


def test_what_a_run_warns_of_stays_with_its_cell_and_is_warned_of(scripts: Scripts) -> None:
    (scripts.base / "derivations" / "t2_two.py").write_text(WARNS)
    with pytest.warns(LagrotorWarning, match="not kept"), pytest.warns(UserWarning, match="another tool"):
        script = scripts.executed("derivations", "t2_two")
    assert [cell.warned for cell in script.cells] == [("tol = 1e-13 is not kept",), ()]
