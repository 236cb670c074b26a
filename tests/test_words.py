"""Prose is plain: no personification in docstrings, comments, messages, captions and Markdown."""

import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
WORDS = (
    "foresee",
    "foresees",
    "foreseen",
    "foreseeing",
    "told",
    "heard",
    "struck",
    "asked",
    "asks",
    "allowance",
    "riddle",
    "freedoms",
    "would miss",
    "least exact",
)
FORBIDDEN = re.compile(
    rf"(?<!DOUBLE-)\b({'|'.join(WORDS)})\b|\bon trial\b|\bclaims tried\b|\bcount as parallel\b", re.IGNORECASE
)


def spoken(path: Path) -> list[str]:
    """Lines of prose with such a word; only a file that has it anywhere is read further."""
    if not FORBIDDEN.search(path.read_text(encoding="utf-8")):
        return []
    return [f"{path.name}: {line}" for line in prose(path) if FORBIDDEN.search(line)]


def prose(path: Path) -> list[str]:
    """Lines of a page or notebook, and comments and strings of a script with more than one word."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return text.splitlines()
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    kinds = (tokenize.COMMENT, tokenize.STRING)
    return [line for t in tokens if t.type in kinds and " " in t.string for line in t.string.splitlines()]


@pytest.mark.parametrize("folder", ["lagrotor", "derivations", "figures", "papers", "docs"])
def test_no_thing_is_spoken_of_as_a_person(folder: str) -> None:
    files = [
        path for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".py", ".md", ".js", ".html", ".ipynb")
    ]
    assert files and [line for path in files for line in spoken(path)] == []


def test_the_pages_of_the_house_are_as_plain() -> None:
    pages = ("README.md", "CONTRIBUTING.md")
    assert [line for page in pages for line in spoken(ROOT / page)] == []


def test_such_a_word_would_be_seen(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text('asked = 1\n"""The model is asked for a rate."""\n# what was told\n')
    assert spoken(tmp_path / "a.py") == ['a.py: """The model is asked for a rate."""', "a.py: # what was told"]
