"""Names of earlier releases: the same object under its old name, with a warning that names the new one."""

import re
import subprocess
import sys
import warnings
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

from lagrotor.lazy_imports import face
from lagrotor.renamed import KEYWORDS, NAMES, RENAMED, accept_old_keywords, new_name


@pytest.fixture
def forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """No module is known by an old name."""
    for name in [name for name in sys.modules if new_name(name)]:
        monkeypatch.delitem(sys.modules, name)


@pytest.mark.usefixtures("forgotten")
@pytest.mark.parametrize("old", RENAMED)
def test_an_old_name_is_the_new_module_and_warns(old: str) -> None:
    if old.startswith("lagrotor.proved.") and find_spec("flint") is None:
        pytest.skip("python-flint is not installed: the extra `proof`")
    new = RENAMED[old]
    spec = import_module(new).__spec__
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        module = import_module(old)
    assert module is import_module(new) and module.__name__ == new and module.__spec__ is spec
    packages = [row for row in RENAMED if old.startswith(f"{row}.")]  # importing a module imports its package
    said = [f"{name} is now {RENAMED[name]}: import that instead" for name in (*packages, old)]
    assert [str(each.message) for each in warned] == said and new_name(new) is None


@pytest.mark.usefixtures("forgotten")
def test_a_module_of_a_renamed_package_is_no_second_copy() -> None:
    with pytest.warns(DeprecationWarning, match="is now lagrotor.proofs") as warned:
        from lagrotor.proved.coq import cofactors  # type: ignore[import-not-found]
    assert cofactors is import_module("lagrotor.proofs.coq.cofactors")
    assert {each.filename for each in warned} == {__file__}


@pytest.mark.usefixtures("forgotten")
def test_the_longest_row_counts_and_no_other_name_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RENAMED, "lagrotor.proved.steady", "lagrotor.errors")
    assert new_name("lagrotor.proved.steady") == "lagrotor.errors"
    assert new_name("lagrotor.proved_too") is None and find_spec("lagrotor.proved_too") is None
    with pytest.warns(DeprecationWarning, match="is now"), pytest.raises(ModuleNotFoundError, match="no_such"):
        import_module("lagrotor.proved.no_such")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        import_module("lagrotor.errors")


@pytest.mark.usefixtures("forgotten")
def test_without_the_finder_the_old_name_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "meta_path", sys.meta_path[1:])
    with pytest.raises(ModuleNotFoundError):
        import_module(next(iter(RENAMED)))


@pytest.mark.parametrize("old", NAMES)
def test_an_old_name_of_a_package_is_the_object_and_warns(old: str) -> None:
    (package, name), (module, attribute) = old.rsplit(".", 1), NAMES[old].rsplit(".", 1)
    with pytest.warns(DeprecationWarning, match=f"{old} is now {NAMES[old]}") as warned:
        assert getattr(import_module(package), name) is getattr(import_module(module), attribute)
    assert len(warned) == 1 and name not in import_module(package).__all__ and name not in face(package)[1]()
    with pytest.raises(AttributeError, match="no_such"):
        import_module(package).no_such  # noqa: B018


def test_an_old_keyword_is_the_new_one_and_warns(monkeypatch: pytest.MonkeyPatch) -> None:
    def scaled(number: float, factor: float = 1) -> float:
        return number * factor

    monkeypatch.setitem(KEYWORDS, scaled.__qualname__, {"times": "factor"})
    scale = accept_old_keywords(scaled)
    with pytest.warns(DeprecationWarning, match="times is now factor") as warned:
        assert scale(2, times=3) == 6  # type: ignore[call-arg]
    assert warned[0].filename == __file__ and scale(2, factor=3) == 6
    with pytest.raises(TypeError, match="times is the old name of factor"):
        scale(2, times=3, factor=3)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="timez"):
        scale(2, timez=3)  # type: ignore[call-arg]


def test_the_warning_of_an_old_name_points_at_the_import(tmp_path: Path) -> None:
    script = tmp_path / "user.py"
    script.write_text("from lagrotor.mechanics import bias\nimport lagrotor.mechanics as M\nM.project_position\n")
    ran = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    places = re.findall(r"user\.py:(\d): DeprecationWarning: lagrotor\.mechanics\.(\w+) is now", ran.stderr)
    assert places == [("1", "bias"), ("3", "project_position")]
