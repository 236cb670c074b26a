"""Functions kept as source: read where they are kept, derived elsewhere, and never another than what is derived."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from lagrotor.numerics.codegen import Program
from lagrotor.numerics.printers import program_source
from lagrotor.numerics.source_cache import GeneratedFunction
from tests.numerics.renew_generated import derived_files, kept_functions

x, y = sp.symbols("x y", real=True)
DERIVED: list[int] = []


def _power(n: int) -> str:
    DERIVED.append(n)
    return program_source(Program((x, y), (), (sp.sin(x) ** n + y, sp.exp(x))))


def kept_in(folder: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> GeneratedFunction:
    """The function above, of a module that lies in `folder` beside a file of that text."""
    (folder / "generated.txt").write_text(text)
    monkeypatch.setattr(sys.modules[__name__], "__file__", str(folder / "test_generated.py"))
    DERIVED.clear()
    return GeneratedFunction(_power, ((2,),))


def test_a_kept_function_is_not_derived(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = f"# %% {GeneratedFunction(_power, ()).name(2)}\n{_power(2)}\n"
    power = kept_in(tmp_path, monkeypatch, text)
    assert power(2)(0.3, 1.0) == pytest.approx([sp.sin(0.3) ** 2 + 1, sp.exp(0.3)])
    assert DERIVED == []


def test_a_function_that_is_not_kept_is_derived_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    power = kept_in(tmp_path, monkeypatch, "")
    assert power(3)(0.3, 1.0) == power(3)(0.3, 1.0) == pytest.approx([sp.sin(0.3) ** 3 + 1, sp.exp(0.3)])
    assert DERIVED == [3]


MODELS = ("models.simulate", "models.orbits.precession")


def as_derived(one: GeneratedFunction, given: tuple[Any, ...]) -> bool:
    kept = one.file.read_text(encoding="utf-8").splitlines()[0]
    if kept != f"# sympy {sp.__version__}":
        pytest.skip(f"another sympy than {kept} may print the same function in another way")
    return one.derive(*given).rstrip() == one.source(*given)


def test_what_is_kept_of_the_models_is_what_is_derived() -> None:
    """All of them in the slow suite."""
    for name in MODELS:
        import_module(f"lagrotor.{name}")
    kinds = list(kept_functions())
    assert len(kinds) > 10
    for one in kinds:
        for given in one.cases:
            assert as_derived(one, given), f"{one.name(*given)}: python -m tests.numerics.renew_generated"


@pytest.mark.slow
def test_everything_kept_is_what_is_derived() -> None:
    for file, text in derived_files().items():
        kept = file.read_text(encoding="utf-8")
        if kept.split("\n")[0] != text.split("\n")[0]:
            pytest.skip(f"another sympy than {kept.splitlines()[0]} may print the same function in another way")
        assert kept == text, f"{file} is out of date: python -m tests.numerics.renew_generated"


def test_a_changed_derivation_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    from lagrotor.models import linear

    monkeypatch.setattr(sp, "sqrt", lambda e: sp.Integer(2) * e ** sp.Rational(1, 2))
    from lagrotor.theory.natural_frequency import natural_frequency

    natural_frequency.cache_clear()
    try:
        assert linear._matrices.derive() != linear._matrices.source()
    finally:
        monkeypatch.undo()
        natural_frequency.cache_clear()
