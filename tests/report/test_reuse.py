"""What the last run found is taken only where all that it was made from, and the thing itself, are as they were."""

import ast
import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import lagrotor
from lagrotor.paper import scripts
from lagrotor.report import reuse
from lagrotor.report.folder import MADE
from lagrotor.report.reuse import Kept, digest

PACKAGE = Path(lagrotor.__file__).parent


@pytest.fixture
def last(tmp_path: Path) -> Path:
    """A report with one part: a value and a file."""
    folder = tmp_path / "last"
    folder.mkdir()
    (folder / "a.svg").write_text("drawn")
    kept = Kept(tmp_path / "none", folder)
    kept.keep("figure 1", "inputs", {"slope": 1.25}, [folder / "a.svg"])
    kept.write()
    return folder


def taken(last: Path, made_from: str = "inputs") -> object:
    new = last.with_name("new")
    new.mkdir()
    kept = Kept(last, new)
    value = kept.take("figure 1", made_from)
    assert kept.taken == ["figure 1"] * (value is not None)
    assert (new / "a.svg").exists() == (value is not None)
    return value


def test_what_is_the_same_is_taken_and_kept_for_the_next_run(last: Path) -> None:
    assert taken(last) == {"slope": 1.25}
    new = last.with_name("new")
    again = Kept(last, new)
    again.take("figure 1", "inputs")
    again.write()
    assert (new / MADE).read_bytes() == (last / MADE).read_bytes()


def test_other_inputs_are_not_taken(last: Path) -> None:
    assert taken(last, "other inputs") is None


def edited(change: Callable[[dict], object]) -> Callable[[Path], object]:
    def edit(last: Path) -> None:
        made = json.loads((last / MADE).read_text())
        change(made["figure 1"])
        (last / MADE).write_text(json.dumps(made))

    return edit


@pytest.mark.parametrize(
    "harm",
    [
        lambda last: (last / "a.svg").write_text("drawn again"),
        lambda last: (last / "a.svg").unlink(),
        lambda last: (last / MADE).unlink(),
        lambda last: (last / MADE).write_text("{"),
        lambda last: (last / MADE).write_text("[1]"),
        lambda last: (last / MADE).write_text('{"figure 1": null}'),
        edited(lambda part: part["value"].update(slope=1.5)),
        edited(lambda part: part.update(files={})),
        edited(lambda part: part.pop("value")),
        edited(lambda part: part.update(files=["a.svg"])),
    ],
)
def test_what_is_damaged_is_not_taken(harm: Callable[[Path], object], last: Path) -> None:
    harm(last)
    assert taken(last) is None


def test_no_two_lists_have_one_digest() -> None:
    assert digest("ab", "c") != digest("a", "bc") != digest("abc")
    assert digest("é") == digest("é".encode())


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A package of a few files, and a figure's script."""
    package = tmp_path / "lagrotor"
    for name in (
        "mechanics/lagrangian.py",
        "pictures/style.py",
        "report/page_parts.py",
        "report/page.css",
        "a.toml",
        "study/a.json",
    ):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(name)
    (package / "figures").mkdir()
    (package / "figures" / "fig01_pair.py").write_text("figure")
    monkeypatch.setattr(reuse, "_PACKAGE", package)
    monkeypatch.setattr(scripts, "folder", lambda kind: package / "figures")
    reuse.inputs.cache_clear()
    yield package
    reuse.inputs.cache_clear()


@pytest.mark.parametrize(
    ("file", "found"),
    [
        ("mechanics/lagrangian.py", True),
        ("pictures/style.py", True),
        ("a.toml", True),
        ("study/a.json", True),
        ("report/page_parts.py", False),
        ("report/page.css", False),
    ],
)
def test_what_is_found_depends_on_all_but_what_writes_it(file: str, found: bool, copy: Path) -> None:
    before, whole = reuse.foundation(), dict(reuse.inputs())
    reuse.inputs.cache_clear()
    assert (reuse.foundation(), reuse.inputs()) == (before, whole)
    (copy / file).write_text("changed")
    reuse.inputs.cache_clear()
    assert (reuse.foundation() != before) == found
    assert sum(reuse.inputs()[name] != seen for name, seen in whole.items()) == 1


def test_an_installed_package_has_the_digests_of_the_checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its scripts and CITATION.cff lie inside it."""
    installed, checkout = tmp_path / "lagrotor", dict(reuse.inputs())
    shutil.copytree(PACKAGE, installed, ignore=shutil.ignore_patterns("__pycache__"))
    for kind in ("derivations", "figures"):
        shutil.copytree(scripts.folder(kind), installed / kind, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(scripts.beside("CITATION.cff"), installed)
    (installed / "pictures" / "drawn.gif").write_bytes(b"GIF89a")
    for module in (reuse, scripts):
        monkeypatch.setattr(module, "_PACKAGE", installed)
    reuse.inputs.cache_clear()
    assert scripts.folder("figures") == installed / "figures"
    assert reuse.inputs() == checkout
    (installed / "pictures" / "drawn.txt").touch()
    reuse.inputs.cache_clear()
    assert reuse.inputs() != checkout, "what is not known to be no source counts"
    reuse.inputs.cache_clear()


def imported(file: Path) -> set[str]:
    """The rooms of the package that a file imports from, however it writes it."""
    found: set[str] = set()
    inside = file.relative_to(PACKAGE.parent).with_suffix("").parts if PACKAGE in file.parents else ()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import | ast.ImportFrom) else []
        if isinstance(node, ast.ImportFrom):
            above = ".".join(inside[: len(inside) - node.level]) if node.level else ""
            names = [".".join(filter(None, (above, node.module, name))) for name in names]
        found |= {parts[1] for name in names if (parts := name.split("."))[0] == "lagrotor" and len(parts) > 1}
    return found


def test_nothing_that_finds_imports_what_writes() -> None:
    """Else a change there could change a claim or a figure that is taken from the last run."""
    finders = [path for path in PACKAGE.rglob("*.py") if not reuse._writes(path) and path.stem != "__main__"]
    finders += [path for kind in ("derivations", "figures") for path in scripts.folder(kind).glob("*.py")]
    assert len(finders) > 100
    assert {path.name: rooms for path in finders if (rooms := imported(path) & set(reuse._WRITERS))} == {}
    assert imported(PACKAGE / "commands" / "command_line.py") >= {"commands", "pictures"}, "the check sees imports"


def test_no_figure_runs_another_figure() -> None:
    """A figure is taken when its own script is as it was."""
    for path in scripts.folder("figures").glob("*.py"):
        source = path.read_text(encoding="utf-8")
        assert 'run("figures"' not in source and "import fig" not in source, path.name
