"""A product of an earlier run is taken only where all that it was made from, and the product itself, are as they were."""

import json
import math
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from lagrotor.mechanics.glossary import latex
from lagrotor.paper import FigureLink, Table
from lagrotor.paper.papers import opened
from lagrotor.paper.scripts import beside
from lagrotor.pictures import Picture
from lagrotor.report.job import cache as cache_module
from lagrotor.report.job.cache import (
    Cache,
    cache_folder,
    derived_as_json,
    derived_from_json,
    picture_as_json,
    picture_from_json,
)
from lagrotor.report.job.steps import Derived
from lagrotor.report.job.stored_values import value_from_json, values_as_json

VALUE = {"slope": 0.1 + 0.2, "limit": math.inf, "words": ["θ", None, True]}


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Cache:
    """A cache with one product."""
    monkeypatch.setattr(cache_module, "cache_folder", lambda: tmp_path / "cache")
    cache = Cache(opened(beside("papers") / "pendulum"))
    cache.keep("claim C01", "inputs", VALUE)
    return cache


def test_a_product_is_taken_for_the_same_inputs_name_and_paper_alone(cache: Cache) -> None:
    assert cache.take("claim C01", "inputs") == VALUE
    assert cache.take("claim C01", "other inputs") is None
    assert cache.take("claim C02", "inputs") is None
    assert Cache(opened(beside("papers") / "hoop")).take("claim C01", "inputs") is None


def edited(change: Callable[[dict], object]) -> Callable[[Path], object]:
    def edit(file: Path) -> None:
        entry = json.loads(file.read_text())
        change(entry)
        file.write_text(json.dumps(entry))

    return edit


@pytest.mark.parametrize(
    "harm",
    [
        Path.unlink,
        lambda file: file.write_bytes(b"\xff"),
        lambda file: file.write_text("{"),
        lambda file: file.write_text("[1]"),
        lambda file: file.write_text("null"),
        edited(lambda entry: entry["product"].update(slope=0.25)),
        edited(lambda entry: entry.pop("digest")),
        edited(lambda entry: entry.pop("product")),
    ],
)
def test_what_is_damaged_is_not_taken(harm: Callable[[Path], object], cache: Cache) -> None:
    (file,) = cache_module.cache_folder().rglob("*.json")
    harm(file)
    assert cache.take("claim C01", "inputs") is None


def no_home() -> Path:
    raise RuntimeError("Could not determine home directory.")


@pytest.mark.parametrize("place", [no_home, lambda: Path(os.devnull)])
def test_without_a_folder_nothing_is_kept(
    place: Callable[[], Path], cache: Cache, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cache_module, "cache_folder", place)
    cache.keep("claim C01", "inputs", VALUE)
    assert cache.take("claim C01", "inputs") is None


@pytest.mark.parametrize(
    ("home", "place"), [("/cache", "/cache/lagrotor"), ("", "~/.cache/lagrotor"), ("cache", "~/.cache/lagrotor")]
)
def test_the_folder_is_the_users(home: str, place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A relative XDG_CACHE_HOME is ignored, as the standard says: a working folder that came from elsewhere brings no cache."""
    monkeypatch.setenv("XDG_CACHE_HOME", home)
    assert cache_folder() == Path(place).expanduser()


def test_a_picture_comes_back_with_its_files_and_writes_nowhere_else(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    old.mkdir()
    new.mkdir()
    svg, png = old / "fig01.svg", old / "fig01.png"
    svg.write_text("<svg>θ</svg>", encoding="utf-8")
    png.write_bytes(bytes(range(256)))
    data = picture_as_json(Picture("fig01", "1", "Title", "Caption", "Alt", svg, png, {"period (s)": 0.1}))
    again = picture_from_json(json.loads(json.dumps(data)), new)
    assert (again.svg.read_bytes(), again.png.read_bytes()) == (svg.read_bytes(), png.read_bytes())
    assert again == Picture(
        "fig01", "1", "Title", "Caption", "Alt", new / svg.name, new / png.name, {"period (s)": 0.1}
    )
    assert picture_from_json(data | {"stem": "../../fig01"}, new).svg.parent == new


def derived(cell: object, verdicts: tuple = ()) -> Derived:
    table = Table("Rates", ("rate", "figure"), ((cell, FigureLink("19")), (("one", "below"), "")), "A note.")
    return Derived(
        "t1_rate", "The rate", verdicts, (("It holds", "because θ is small"),), (table,), "<p>θ</p>", {"r": 1, "f": max}
    )


def test_a_derivation_comes_back_with_those_values_that_can_be_stored() -> None:
    again = derived_from_json(json.loads(json.dumps(derived_as_json(derived("16 rad/s")))))
    assert again == replace(derived("16 rad/s"), values={"r": 1})


a, k = sp.Symbol("a", positive=True), sp.Symbol("k", real=True)


@pytest.mark.parametrize(
    "value",
    [
        {1.5: ("hyperbolic", [np.float64(0.1), None, True]), "θ": 10**30},
        np.array([[0.1, math.inf], [-0.0, 1e-300]]),
        sp.sqrt(a) * sp.sin(k) / 3 + sp.pi * sp.Max(k, 2) - sp.cosh(a) ** -2,
        sp.Add(k, k, evaluate=False),
        sp.S.NegativeOne,
    ],
)
def test_a_value_comes_back_as_it_is(value: object) -> None:
    again = value_from_json(json.loads(json.dumps(values_as_json({"value": value})["value"])))
    assert type(again) is type(value)
    assert str(again) == str(value)
    assert isinstance(value, np.ndarray) or again == value


@pytest.mark.parametrize("value", [max, sp.Dummy("x"), sp.Float("0.1", 30), sp.Function("f")(k), [object()], sp.eye(2)])
def test_any_other_value_is_not_stored(value: object) -> None:
    assert values_as_json({"value": value}) == {}


@pytest.mark.parametrize(
    "data", [["open", ["x"]], ["__import__", ["os"]], ["Function", ["f"]], ["constant", "oo"], ["list"]]
)
def test_data_of_another_form_are_no_value(data: list) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        value_from_json(data)


def test_of_a_formula_in_a_table_the_latex_comes_back() -> None:
    x, t = sp.symbols("x theta_dot")
    for formula in (sp.Eq(x, sp.sin(t) ** 2 / 2), sp.sqrt(1 - x**2)):
        stored = json.loads(json.dumps(derived_as_json(derived(formula))))
        assert "Eq" not in json.dumps(stored)
        assert latex(derived_from_json(stored).tables[0].rows[0][0]) == latex(formula)


@pytest.mark.parametrize("product", [derived(sp.Symbol("x")), derived(sp.eye(2)), derived("16", verdicts=(object(),))])
def test_a_derivation_with_symbols_matrices_or_verdicts_is_not_stored(product: Derived, cache: Cache) -> None:
    cache.keep("derivation t1_rate", "inputs", derived_as_json(product))
    assert cache.take("derivation t1_rate", "inputs") is None
