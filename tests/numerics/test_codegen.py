"""Generated code against the expressions it came from, and linear solves against numpy."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.errors import InputError, SingularError
from lagrotor.numerics import operations
from lagrotor.numerics.codegen import Program, reduce_common, solve_symmetric
from lagrotor.numerics.printers import compile_program, in_blocks, javascript

x, y, z = sp.symbols("x y z", real=True)
s, t = sp.symbols("s t", real=True)


def staged() -> Program:
    """Two stages, one made of the other, shared pieces, and functions of every kind the models use."""
    first, second = sp.sin(x + y) * sp.exp(-y), s**2 + sp.sqrt(1 + x**2)
    outputs = (s + t * sp.cos(x + y), sp.log(t) / sp.cosh(y), sp.tanh(x) * sp.asin(s / 10) - sp.atan2(y, x + 3), x)
    return Program((x, y), ((s, first), (t, second)), outputs)


def by_substitution(program: Program, at: dict[sp.Symbol, float]) -> list[float]:
    known: dict[sp.Symbol, sp.Expr] = dict(at)
    for name, expression in program.stages:
        known[name] = expression.subs(known)
    return [float(e.subs(known)) for e in program.outputs]


@pytest.mark.parametrize(
    "build",
    [
        lambda: Program((x,), (), (x + y,)),
        lambda: Program((x,), ((s, y),), (s,)),
        # A stage may use what comes before it, not after it, nor itself.
        lambda: Program((x,), ((t, s + x), (s, x)), (t,)),
        lambda: Program((x,), ((s, s + x),), (s,)),
    ],
)
def test_what_is_used_before_it_is_defined_is_refused(build: Callable[[], Program]) -> None:
    with pytest.raises(SingularError, match="is used before it is defined: add it to the arguments"):
        build()


values = st.floats(-2, 2)


@settings(max_examples=10, deadline=None)
@given(values, values)
def test_reducing_and_compiling_change_nothing(at_x: float, at_y: float) -> None:
    program, at = staged(), {x: at_x, y: at_y}
    stages, outputs = reduce_common(program)
    assert by_substitution(Program(program.arguments, tuple(stages), tuple(outputs)), at) == pytest.approx(
        by_substitution(program, at), rel=1e-12, abs=1e-14
    )
    assert compile_program(program)(at_x, at_y) == pytest.approx(by_substitution(program, at), rel=1e-12, abs=1e-14)


def test_reducing_drops_what_no_output_needs_and_shares_the_rest() -> None:
    heavy = (x + y + z) ** 3
    program = Program((x, y, z), ((s, sp.sin(heavy)), (t, sp.exp(heavy) * x)), (t + heavy, heavy * t))
    stages, outputs = reduce_common(program)
    assert not any(e.has(sp.sin) for _, e in stages)
    counted = sum(sp.count_ops(e) for _, e in stages) + sum(sp.count_ops(e) for e in outputs)
    assert operations(program) == counted
    # exp, product, two sums, the cube, one sum, one product.
    assert operations(program) == 7
    # Twin: without sharing it would be more.
    unshared = [e.subs(t, sp.exp(heavy) * x) for e in program.outputs]
    assert operations(program) < sum(sp.count_ops(e) for e in unshared)


@pytest.mark.parametrize(
    "e",
    [y - x, 2 - x, -2 * x * y * (z - x), (x + y) * sp.sin(-x * z), 1 / (x - y), -x * sp.Rational(3, 4) - y / 2, x**-2],
    ids=str,
)
def test_operations_are_those_that_sympy_counts(e: sp.Expr) -> None:
    assert operations(Program((x, y, z), (), (e,), shared=True)) == sp.count_ops(e)


def test_a_numpy_function_broadcasts_as_the_scalar_one_counts() -> None:
    program = Program((x, y), staged().stages, staged().outputs[:3])
    many, one = compile_program(program, "numpy"), compile_program(program)
    at_x, at_y = np.linspace(-1, 1, 5)[:, None], np.linspace(0.1, 2, 4)
    for i, found in enumerate(many(at_x, at_y)):
        assert found.shape == (5, 4)
        expected = [[one(p, q)[i] for q in at_y.tolist()] for p in at_x.ravel().tolist()]
        assert found == pytest.approx(np.array(expected), rel=1e-14)


def test_javascript_refuses_a_function_it_does_not_have() -> None:
    from sympy.printing.codeprinter import PrintMethodNotImplementedError

    assert javascript(Program((x,), (), (sp.atanh(x), x ** sp.Rational(-1, 2))), "f").count("Math.") == 2
    with pytest.raises(PrintMethodNotImplementedError, match="besselj"):
        javascript(Program((x,), (), (sp.besselj(0, x),)), "f")


entries = st.floats(-2, 2)


@settings(max_examples=10, deadline=None)
@given(st.integers(1, 4).flatmap(lambda n: st.lists(entries, min_size=n * (n + 2), max_size=n * (n + 2))))
def test_symmetric_systems_are_solved(numbers: list[float]) -> None:
    n = {3: 1, 8: 2, 15: 3, 24: 4}[len(numbers)]
    root = np.reshape(numbers[: n * n], (n, n))
    matrix, right = root @ root.T + np.eye(n), np.reshape(numbers[n * n :], (n, 2))
    names = sp.Matrix(n, n, lambda i, j: sp.Symbol(f"A_{max(i, j)}{min(i, j)}", real=True))
    sides = sp.Matrix(n, 2, lambda i, j: sp.Symbol(f"B_{i}{j}", real=True))
    stages, solution = solve_symmetric(names, sides, "q")
    lower = [(i, j) for i in range(n) for j in range(i + 1)]
    program = Program((*(names[i, j] for i, j in lower), *sides), tuple(stages), tuple(solution))
    found = compile_program(program)(*(float(matrix[i, j]) for i, j in lower), *right.ravel().tolist())
    assert np.reshape(found, (n, 2)) == pytest.approx(np.linalg.solve(matrix, right), rel=1e-9, abs=1e-9)


def test_a_pivot_that_is_zero_is_refused() -> None:
    with pytest.raises(SingularError, match="pivot 0 is zero"):
        solve_symmetric(sp.Matrix([[0, 1], [1, x]]), sp.Matrix([1, 1]), "q")
    with pytest.raises(SingularError, match="pivot 1 is zero"):
        solve_symmetric(sp.Matrix([[x, 0], [0, 0]]), sp.Matrix([1, 1]), "q")


@pytest.mark.parametrize("outputs", [1, 3])
def test_a_program_with_another_number_of_outputs_is_not_taken(outputs: int) -> None:
    def two(values: np.ndarray) -> list[np.ndarray]:
        return [values, 2 * values]

    n = 20_000  # more than two blocks, the last one shorter
    assert in_blocks(two, [np.arange(float(n))], 2, n)[1].tolist() == (2 * np.arange(n)).tolist()
    with pytest.raises(ValueError, match="zip"):
        in_blocks(two, [np.arange(float(n))], outputs, n)


def test_stages_of_many_columns_have_different_names() -> None:
    """With one digit after another, y1 of column 11 and y11 of column 1 were one stage."""
    n = 12
    matrix = sp.Matrix(n, n, lambda i, j: sp.Symbol(f"a{min(i, j)}_{max(i, j)}", real=True))
    stages, x = solve_symmetric(matrix, sp.eye(n), "_m")
    program = Program(tuple(sorted(matrix.free_symbols, key=str)), tuple(stages), tuple(x))
    numbers = np.eye(n) + np.fromfunction(lambda i, j: 1 / (1 + i + j), (n, n))
    values = {matrix[i, j]: numbers[i, j] for i in range(n) for j in range(n)}
    inverse = compile_program(program)(*(values[s] for s in program.arguments))
    assert np.reshape(inverse, (n, n)) @ numbers == pytest.approx(np.eye(n), abs=1e-12)


def test_a_stage_has_a_name_of_its_own() -> None:
    x, s = sp.symbols("x s", real=True)
    with pytest.raises(InputError, match="s names two quantities"):
        Program((x,), ((s, x + 1), (s, x + 2)), (s,))
    with pytest.raises(InputError, match="x names two quantities"):
        Program((x,), ((x, sp.Integer(2)),), (x,))


def test_common_parts_do_not_take_the_name_of_a_stage_that_nothing_uses() -> None:
    x, y, c = sp.symbols("x y c_0", real=True)
    program = Program((x, y), ((c, sp.sin(x)),), (x * y + sp.cos(x * y), 1 / (x * y)))
    assert compile_program(program)(2.0, 3.0) == [6 + np.cos(6.0), 1 / 6]
