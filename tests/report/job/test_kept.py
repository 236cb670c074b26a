"""A product of the last run is taken only where all that it was made from, and the product itself, are as they were."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
import sympy as sp

from lagrotor.report.job.folder import MADE, PRODUCTS
from lagrotor.report.job.kept import Kept

VALUE = {"slope": 1.25, "formula": sp.Symbol("x", positive=True) ** 2}


@pytest.fixture
def last(tmp_path: Path) -> Path:
    """A report with one product: a value and a file."""
    folder = tmp_path / "last"
    (folder / "figures").mkdir(parents=True)
    (folder / "figures" / "a.svg").write_text("drawn")
    kept = Kept(tmp_path / "none", folder)
    kept.keep("figure 1", "inputs", VALUE, [folder / "figures" / "a.svg"])
    kept.write()
    return folder


def taken(last: Path, made_from: str = "inputs") -> object:
    new = last.with_name("new")
    new.mkdir()
    kept = Kept(last, new)
    value = kept.take("figure 1", made_from)
    assert kept.taken == ["figure 1"] * (value is not None)
    assert (new / "figures" / "a.svg").exists() == (value is not None)
    return value


def test_what_is_the_same_is_taken_and_kept_for_the_next_run(last: Path) -> None:
    assert taken(last) == VALUE
    new = last.with_name("new")
    again = Kept(last, new)
    again.take("figure 1", "inputs")
    again.write()
    assert (new / MADE).read_bytes() == (last / MADE).read_bytes()
    assert Kept(new, new).last("figure 1", "inputs") == VALUE


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
        lambda last: (last / "figures" / "a.svg").write_text("drawn again"),
        lambda last: (last / "figures" / "a.svg").unlink(),
        lambda last: (last / PRODUCTS / "figure-1.pickle").write_bytes(b"other"),
        lambda last: (last / PRODUCTS / "figure-1.pickle").unlink(),
        lambda last: (last / MADE).unlink(),
        lambda last: (last / MADE).write_text("{"),
        lambda last: (last / MADE).write_text("[1]"),
        lambda last: (last / MADE).write_text('{"figure 1": null}'),
        edited(lambda part: part.update(files={})),
        edited(lambda part: part.pop("seal")),
        edited(lambda part: part.update(files=["figures/a.svg"])),
    ],
)
def test_what_is_damaged_is_not_taken(harm: Callable[[Path], object], last: Path) -> None:
    harm(last)
    assert taken(last) is None
