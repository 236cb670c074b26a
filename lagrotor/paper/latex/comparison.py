"""The equality of two printed sides: first a test in floating point, then an exact decision with bounded work."""

from collections.abc import Callable
from random import Random
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.algebra.scalar import degree
from lagrotor.algebra.work_budget import Calls, at_most
from lagrotor.errors import LagrotorError, WorkError
from lagrotor.paper.latex.tree import Node, Opaque, sympy_expression

# Bounds on the degree, and on the function calls (a few seconds), for the decision of one step.
_MOST_DEGREE, MOST_CALLS = 1000, 3_000_000
TOO_LARGE = "the difference is too large"
LARGEST = 1e300  # bound on compared numbers
_MOST_POINTS = 16  # test points at which two sides are evaluated until both are real

_step: Calls | None = None  # remaining calls of the current step


def bound_work(work: Callable[..., Any], *arguments: Any, too_large: Any = None) -> Any:
    """Return work(*arguments), or the value `too_large` if the work needs more than MOST_CALLS function calls."""
    global _step
    previous, _step = _step, Calls(MOST_CALLS)
    try:
        return work(*arguments)
    except (WorkError, RecursionError):
        return too_large
    finally:
        _step = previous


def count_calls(work: Callable[..., Any], *arguments: Any) -> Any:
    """Return work(*arguments). Inside `bound_work` the function calls count against its bound: WorkError beyond it."""
    return work(*arguments) if _step is None else at_most(_step, work, *arguments)


def expression_of(node: Node, opaque: Opaque) -> Any:
    """Return the node as a sympy expression; None if sympy cannot form it."""
    try:
        return count_calls(sympy_expression, node, opaque)
    except (TypeError, ValueError, ArithmeticError, AttributeError):
        return None


def value_at(side: Any, point: dict[sp.Symbol, sp.Rational]) -> Any:
    """Return the numerical value of a side at a point (of a matrix, its first nonzero entry); nan if that fails."""
    entry = next((e for e in side if e != 0), sp.S.Zero) if isinstance(side, sp.MatrixBase) else side
    try:
        value = count_calls(sp.N, entry.xreplace(point), 15)
        return value if abs(complex(value)) < LARGEST else sp.nan
    except (ArithmeticError, AttributeError, ValueError, TypeError):
        return sp.nan


def nearly_equal(a: Any, b: Any) -> bool:
    """Return True if two numbers differ by at most 1e-9 of the sum of their magnitudes."""
    try:
        return bool(abs(a - b) <= 1e-9 * (abs(a) + abs(b)))
    except TypeError:
        return False


def may_agree(a: Any, b: Any) -> bool:
    """Return False if two expressions are real at a test point and differ there; no exact decision is then needed."""
    if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase):
        return True
    symbols = sorted(a.free_symbols | b.free_symbols, key=str)
    random = Random(len(symbols))
    for trial in range(_MOST_POINTS):
        point = {s: sp.Rational(2 * n + 4 * trial + 3, 5 * n + 7) for n, s in enumerate(symbols)}
        if trial > 2:  # any sign and size: roots may be real there
            point = {s: sp.Rational(random.randrange(-99, 100, 2), random.choice((7, 80))) for s in symbols}
        values = value_at(a, point), value_at(b, point)
        if all(value.is_real and value.is_finite for value in values):
            return nearly_equal(*values)
    return True


def is_large(*sides: Any) -> bool:
    """Return True if the degree of an expression exceeds _MOST_DEGREE, so that it cannot be multiplied out."""
    entries = (e for side in sides for e in (side if isinstance(side, sp.MatrixBase) else [side]))
    return any(degree(e) > _MOST_DEGREE for e in entries)


def agree(a: Any, b: Any) -> bool:
    """Return True if two sides are proved equal."""
    return may_agree(a, b) and equality(a, b) == "zero"


def equality(a: Any, b: Any) -> str:
    """Decide whether a − b is zero. Return 'zero', 'nonzero' or 'undecided', or 'shape' if the shapes differ.

    A matrix and the number zero are compared entry by entry.
    """
    matrices = isinstance(a, sp.MatrixBase), isinstance(b, sp.MatrixBase)
    if all(matrices):
        return _matrix_equality(a - b) if a.shape == b.shape else "shape"
    if any(matrices):
        return _matrix_equality(a if matrices[0] else b) if sp.S.Zero in (a, b) else "shape"
    return _scalar_equality(a, b)


def _matrix_equality(matrix: sp.MatrixBase) -> str:
    answers = {_scalar_equality(entry, sp.S.Zero) for entry in matrix}
    return next(answer for answer in ("nonzero", "undecided", "zero") if answer in answers)


def _scalar_equality(a: Any, b: Any) -> str:
    if any(side.has(sp.oo, sp.nan, sp.zoo, sp.I) for side in (a, b)):
        return "undecided"
    if a == b and radicands(a):  # even if its roots are real nowhere
        return "zero"
    try:
        decision = count_calls(decide_equal, a, b, [sp.Gt(radicand, 0) for radicand in radicands(a, b)])
    except WorkError:
        raise
    except (LagrotorError, TypeError, ValueError, ArithmeticError):
        return "undecided"
    return "undecided" if decision.partly else decision.answer


def radicands(*sides: Any) -> set[Any]:
    """Return the expressions under roots. Sides are compared where these are positive: √(x/y) = 1/√(y/x) fails at x = −1."""
    roots = (root for side in sides for root in side.atoms(sp.Pow) if root.exp.is_Rational and not root.exp.is_Integer)
    return {root.base for root in roots if root.free_symbols}


def agree_for_positive(a: Any, b: Any) -> bool:
    """Return True if two sides with a root or a magnitude are equal when all symbols are positive, such as √(x²) = x."""
    if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase) or not (radicands(a, b) or (a - b).has(sp.Abs)):
        return False
    positive = {symbol: sp.Symbol(symbol.name, positive=True) for symbol in a.free_symbols | b.free_symbols}
    return agree(a.subs(positive), b.subs(positive))
