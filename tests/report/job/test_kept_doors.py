"""A report's folder is data: a product that would call something, or have text parsed, is not read."""

import pickle
from pathlib import Path

import pytest
import sympy as sp

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


def test_what_products_are_made_of_is_read() -> None:
    x = sp.Symbol("x", positive=True)
    product = {"a": sp.sin(x) ** 2 + sp.Rational(1, 3), "b": sp.Matrix([x, 1]), "c": (1.5, "text", Path("a"), {x: 1})}
    assert _read(pickle.dumps(product, protocol=5)) == product
