"""The whole audit in several processes is that of one."""

import shutil
from pathlib import Path

import pytest

from lagrotor import Paper
from lagrotor.errors import ScriptError
from lagrotor.paper.scripts import beside
from lagrotor.report.job.steps import audit_in_processes


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(beside("papers") / "heavy_top", tmp_path / "top"))


def test_two_processes_judge_as_one_does(folder: Path) -> None:
    begun: list[str] = []
    one, two = Paper(folder).audit(), audit_in_processes(Paper(folder), begun.append, jobs=2)
    assert [(v.id, v.verdict, v.premises, v.domain) for v in two] == [
        (v.id, v.verdict, v.premises, v.domain) for v in one
    ]
    assert two.waiting == one.waiting
    assert sorted(begun) == sorted(Paper(folder).stating_scripts)


def test_a_script_that_fails_in_another_process_says_where(folder: Path) -> None:
    script = sorted((folder / "derivations").glob("s*.py"))[0]
    script.write_text(script.read_text("utf-8") + "\n1 / 0\n", "utf-8")
    with pytest.raises(ScriptError, match=f"{script.name}:.*ZeroDivisionError"):
        audit_in_processes(Paper(folder), lambda stem: None, jobs=2)
