"""The reference: every public name has its sections by numpydoc's own rules, and the pages of the site show every method.

Public are the names that a package hands on, and the methods and properties of these classes, without those for figures.
"""

import dataclasses
import importlib.util
import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import lagrotor

numpydoc = pytest.importorskip("numpydoc.validate", reason="the extra `test` is not installed")
PACKAGES = ["", *sorted(path.parent.name for path in Path(lagrotor.__file__).parent.glob("*/__init__.py"))]
PACKAGES = [name for name in PACKAGES if name not in ("drawing", "pictures")]
# Sections in order, no unknown one; a summary on one line; every parameter with its type, what is returned and yielded.
RULES = {
    "GL05", "GL06", "GL07", "GL08", "SS01", "SS02", "SS03", "SS04", "SS05", "SS06",
    "PR01", "PR02", "PR03", "PR04", "PR05", "PR07", "RT01", "RT03", "YD01",
}  # fmt: skip


def public_members(cls: type) -> Iterator[tuple[str, Any, bool]]:
    """Yield the full name, the function and whether it is a property, for each public member that lagrotor defines."""
    for name in (name for name in dir(cls) if not name.startswith("_")):
        owner = next((base for base in cls.__mro__ if name in vars(base)), object)
        member = vars(owner).get(name)
        function = getattr(member, "fget", None) or getattr(member, "func", None) or getattr(member, "__func__", member)
        if inspect.isfunction(function) and owner.__module__.startswith("lagrotor"):
            is_property = not inspect.isfunction(member) and not isinstance(member, staticmethod | classmethod)
            yield f"{owner.__module__}.{owner.__qualname__}.{name}", function, is_property


def public_names(package: str) -> dict[str, tuple[Any, bool]]:
    """Return {full name: (object, whether it is a property)} for what a package hands on."""
    module = import_module(f"lagrotor.{package}".rstrip("."))
    names: dict[str, tuple[Any, bool]] = {}
    for value in (getattr(module, name) for name in getattr(module, "__all__", ())):
        if inspect.isclass(value) or inspect.isfunction(inspect.unwrap(value) if callable(value) else value):
            names[f"{value.__module__}.{value.__qualname__}"] = value, False
        if inspect.isclass(value):
            names |= {name: (function, is_property) for name, function, is_property in public_members(value)}
    return names


def problems(name: str, value: Any, is_property: bool) -> list[str]:
    """Return what numpydoc refuses; a property has no arguments, a dataclass lists its fields as attributes."""
    ignored = {"RT01", "PR01"} if is_property else {"PR01", "PR02"} if dataclasses.is_dataclass(value) else set()
    codes = [f"{code} {text}" for code, text in numpydoc.validate(name)["errors"] if code in RULES - ignored]
    fields = dataclasses.fields(value) if inspect.isclass(value) and dataclasses.is_dataclass(value) else ()
    text = value.__doc__ or ""
    public = [field.name for field in fields if not field.name.startswith("_")]
    return codes + [f"no entry of {field}" for field in public if not re.search(rf"^ *{field}( :|$)", text, re.M)]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_has_its_sections(package: str) -> None:
    if package == "proofs" and importlib.util.find_spec("flint") is None:
        pytest.skip("python-flint is not installed: the extra `proof`")
    names = public_names(package)
    assert {name: lacks for name, (value, kind) in names.items() if (lacks := problems(name, value, kind))} == {}


def test_a_name_without_sections_is_seen() -> None:
    assert [text[:4] for text in problems("tests.test_reference.two", two, False)] == ["PR01", "RT01"]
    assert problems("tests.test_reference.Pair", Pair, False) == ["no entry of first"]


def two(first: int, second: int) -> int:
    """Add two numbers."""
    return first + second


@dataclasses.dataclass
class Pair:
    """A pair of numbers.

    Attributes
    ----------
    second : int
        The second number.
    """

    first: int
    second: int


def test_no_public_name_is_passed_over() -> None:
    """A name that is checked neither as a function nor as a class is a constant."""
    from lagrotor import theory

    callables = [value for value in (getattr(theory, name) for name in theory.__all__) if callable(value)]
    assert len(callables) > 30 and {f"{value.__module__}.{value.__qualname__}" for value in callables} <= set(
        public_names("theory")
    )


def test_examples_are_many() -> None:
    """Count the public names whose docstring has an example; tests/test_examples.py runs them."""
    packages = [p for p in PACKAGES if p != "proofs" or importlib.util.find_spec("flint")]
    names = {name: value for package in packages for name, (value, _) in public_names(package).items()}
    assert sum(">>>" in (value.__doc__ or "") for value in names.values()) >= 150
