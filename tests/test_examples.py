"""Examples that are run: those of the docstrings, and those of the pages of the documentation."""

import doctest
import inspect
from importlib import import_module
from pathlib import Path

import pytest

import lagrotor

PACKAGE = Path(lagrotor.__file__).parent
DOCS = PACKAGE.parent / "docs"
MODULES = sorted(
    {
        ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
        for path in PACKAGE.rglob("*.py")
        if ">>> " in path.read_text(encoding="utf-8")
    }
)
PAGES = [page for page in sorted(DOCS.glob("*.md")) if ">>>" in page.read_text(encoding="utf-8")]
HOW = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


@pytest.mark.parametrize("module", MODULES)
def test_examples_of_docstrings(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # A function that accepts old keywords is a wrapper with the globals of another module, which doctest would pass over.
    is_of_module = doctest.DocTestFinder._from_module  # type: ignore[attr-defined]
    monkeypatch.setattr(
        doctest.DocTestFinder,
        "_from_module",
        lambda self, where, value: is_of_module(self, where, inspect.unwrap(value)),
    )
    if module.startswith("lagrotor.proofs"):
        pytest.importorskip("flint", reason="the extra `proof` is not installed")
    ran = doctest.testmod(import_module(module), optionflags=HOW)
    assert ran.attempted and not ran.failed


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_examples_of_pages(page: Path) -> None:
    ran = doctest.testfile(str(page), module_relative=False, optionflags=HOW, encoding="utf-8")
    assert ran.attempted and not ran.failed


def test_a_wrong_example_would_be_seen(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = tmp_path / "wrong.md"
    wrong.write_text("```\n>>> 1 + 1\n3\n\n```\n", encoding="utf-8")
    assert doctest.testfile(str(wrong), module_relative=False).failed
    assert "Expected" in capsys.readouterr().out
