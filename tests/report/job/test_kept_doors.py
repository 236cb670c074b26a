"""A report's folder is data: a product that would call something, or have text parsed, is not read."""

import pickle
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from lagrotor.paper.papers import opened
from lagrotor.paper.scripts import beside
from lagrotor.report.job.kept import _read


class Call:
    """What a hostile pickle holds: a function and its arguments."""

    def __init__(self, function: object, *arguments: object) -> None:
        self.function, self.arguments = function, arguments

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return self.function, self.arguments


def code(mark: Path) -> str:
    return f"__import__('pathlib').Path({str(mark)!r}).touch()"


@pytest.mark.parametrize(
    "function", [sp.sympify, sp.sin, sp.Matrix, sp.parse_expr, sp.Add, sp.lambdify, eval, exec, open]
)
def test_a_product_that_would_run_something_is_not_read(function: object, tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    arguments = [[code(mark)]] if function is sp.Matrix else [str(mark), "w"] if function is open else [code(mark)]
    with pytest.raises((pickle.UnpicklingError, TypeError, sp.SympifyError)):
        _read(pickle.dumps(Call(function, *arguments)))
    assert not mark.exists()


@pytest.mark.parametrize("function", [np.memmap, np.load, np.lib.npyio.DataSource, subprocess.Popen, opened])
def test_no_class_that_does_more_than_hold_values_is_made(function: object, tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    arguments = [str(mark), "float64", "w+", 0, (1,)] if function is np.memmap else [tmp_path]
    with pytest.raises(pickle.UnpicklingError):
        _read(pickle.dumps(Call(function, *arguments)))
    assert not mark.exists()


def test_the_only_paper_that_is_opened_is_the_one_that_is_reported(tmp_path: Path) -> None:
    paper = opened((beside("papers") / "pendulum").resolve())
    assert _read(pickle.dumps(paper), paper) is paper
    with pytest.raises(pickle.UnpicklingError, match="another paper"):
        _read(pickle.dumps(Call(opened, tmp_path, None)), paper)


def test_what_products_are_made_of_is_read() -> None:
    x = sp.Symbol("x", positive=True)
    product = {"a": sp.sin(x) ** 2 + sp.Rational(1, 3), "b": sp.Matrix([x, 1]), "c": (1.5, "text", Path("a"), {x: 1})}
    arrays = _read(pickle.dumps([np.arange(3.0), np.float64(2), np.array(["a"])], protocol=5))
    assert list(arrays[0]) == [0, 1, 2] and arrays[1] == 2
    assert _read(pickle.dumps(product, protocol=5)) == product
