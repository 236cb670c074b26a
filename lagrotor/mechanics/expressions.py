"""What is given as an expression is one: of plain symbols, finite, no text. What is found is written as short as it can be."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import sympy as sp

from lagrotor.algebra import normal_form
from lagrotor.errors import InputError, NotExactError

_MOST_OPERATIONS = 600  # of an expression that a shorter form is sought of: one that is still read


def expression(where: str, given: Any) -> sp.Expr:
    """A sympy expression; raise InputError, which begins with `where`, for anything else. No text is parsed."""
    try:
        e = sp.sympify(given, strict=True)
    except (sp.SympifyError, TypeError):
        e = None
    if not isinstance(e, sp.Expr) or isinstance(e, sp.MatrixExpr | sp.MatrixBase):
        raise InputError(f"{where} = {given!r} is no expression: build it from sympy symbols")
    if moving := e.atoms(sp.Derivative, sp.core.function.AppliedUndef):
        raise InputError(
            f"{where} contains {', '.join(sorted(map(str, moving)))}: coordinates and velocities are plain "
            "symbols here; use those of coordinates(…), c.q and c.v, and t for the time"
        )
    if e.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        raise InputError(f"{where} = {e} is not finite: correct it")
    if e.has(sp.I):
        raise InputError(f"{where} = {e} is complex: what a system moves by is real; write its real part")
    return e


def shortest(e: sp.Expr) -> sp.Expr:
    """The expression, its normal form, or that with A sin² for A − A cos²: whichever has the fewest operations."""
    if sp.count_ops(e) > _MOST_OPERATIONS:
        return e
    try:
        reduced = normal_form(e)
    except NotExactError:
        return e
    return min((e, reduced, _with_sines(reduced)), key=sp.count_ops)


def _with_sines(e: sp.Expr) -> sp.Expr:
    """A sum with A sin² for each pair of terms A, −A cos²."""
    terms = {*sp.Add.make_args(e)}
    for term in sorted(terms, key=sp.default_sort_key):
        for cosine in term.atoms(sp.cos):
            rest = term / cosine**2
            if term in terms and -rest in terms:
                terms = terms - {term, -rest} | {-rest * sp.sin(cosine.args[0]) ** 2}
    return sp.Add(*terms)


def vector_of(where: str, given: Any, n: int) -> tuple[sp.Expr, ...]:
    """n expressions; raise InputError, which begins with `where`, for anything else."""
    if not isinstance(given, Sequence | sp.MatrixBase) or isinstance(given, str) or len(given) != n:
        raise InputError(f"{where} = {given!r} must be {n} expressions")
    return tuple(expression(f"{where}[{i}]", e) for i, e in enumerate(given))


def by_symbol(values: Mapping[Any, Any], symbols: Iterable[sp.Symbol]) -> dict[Any, Any]:
    """Values by symbol, where names may stand for symbols. Raises InputError for what is no mapping."""
    if not isinstance(values, Mapping):
        raise InputError(f"values = {values!r} must be {{symbol: number, …}}, a dictionary")
    names = {str(s): s for s in symbols}
    return {names.get(str(key), key): value for key, value in values.items()}
