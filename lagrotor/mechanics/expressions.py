"""What is given as an expression is one: of plain symbols, finite, no text. What is found is written as short as it can be."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from lagrotor.algebra import normal_form
from lagrotor.algebra.enclosures import jet_of
from lagrotor.algebra.subexpressions import length, subexpressions, with_shared_parts
from lagrotor.errors import InputError, NotExactError, near

_PLAIN = (
    "coordinates and velocities are plain symbols here; use those of coordinates(…), c.q and c.v, and t for the time"
)
_MOST_OPERATIONS = 600  # of an expression that a shorter form is sought of: one that is still read


def expression(where: str, given: Any) -> sp.Expr:
    """A sympy expression; raise InputError, which begins with `where`, for anything else. No text is parsed."""
    try:
        e = sp.sympify(given, strict=True)
    except (sp.SympifyError, TypeError):
        e = None
    if not isinstance(e, sp.Expr) or isinstance(e, sp.MatrixExpr | sp.MatrixBase):
        raise InputError(f"{where} = {given!r} is no expression: build it from sympy symbols")
    e = with_shared_parts(e)
    inside = subexpressions(e)
    if any(isinstance(d, sp.Derivative) and not d.expr.atoms(AppliedUndef) for d in inside):
        raise InputError(f"{where} = {e}: {_PLAIN}")
    if any(isinstance(d, sp.Derivative | sp.Subs) for d in inside):
        e = e.doit()
        inside = subexpressions(e)
    if strange := [d for d in inside if isinstance(d, sp.Derivative) and jet_of(d) is None]:
        raise InputError(
            f"{where} contains {strange[0]}, which is no derivative of a function of symbols: write it out"
        )
    if {sp.nan, sp.zoo, sp.oo, -sp.oo} & {*inside}:
        raise InputError(f"{where} = {e} is not finite: correct it")
    if sp.I in inside:
        raise InputError(f"{where} = {e} is complex: what a system moves by is real; write its real part")
    return e


def no_coordinate(where: str, given: Any, names: Iterable[sp.Symbol]) -> None:
    """Raise InputError where a function has the name of a coordinate: θ(t) beside θ would be another quantity."""
    moving = {*map(str, names)}
    if wrong := [f for f in unknown_functions(given) if str(f.func) in moving]:
        raise InputError(f"{where} contains {wrong[0]}: {_PLAIN}")


def unknown_functions(given: Any) -> list[sp.Expr]:
    """The functions U(r), y(t) … in expressions of which nothing is known but their name, in a fixed order."""
    listed = [sp.sympify(e, strict=True) for e in (given if isinstance(given, Iterable) else (given,))]
    return sorted({e for e in subexpressions(*listed) if isinstance(e, AppliedUndef)}, key=sp.default_sort_key)


def put_in(e: sp.Expr, values: Mapping[Any, Any]) -> sp.Expr:
    """The expression with values for symbols; a derivative U'(r) is then one at that place."""
    return e.subs(values, simultaneous=True) if e.has(sp.Derivative) else e.xreplace(dict(values))


def jets_of(e: sp.Expr) -> list[sp.Expr]:
    """The outermost unknown functions and derivatives of them."""
    if not e.has(AppliedUndef):
        return []
    return [e] if jet_of(e) is not None else [jet for a in e.args for jet in jets_of(a)]


def with_jets(e: sp.Expr, made: Callable[[str, tuple[int, ...], tuple[sp.Expr, ...]], sp.Expr | None]) -> sp.Expr:
    """The expression with made(name, orders, arguments) for each unknown function and each of its derivatives, where that
    is not None; orders: how often it is differentiated by each argument."""
    if not e.has(AppliedUndef):
        return e
    if (jet := jet_of(e)) is not None:
        (function, orders), arguments = jet
        inside = tuple(with_jets(a, made) for a in arguments)
        new = made(str(function), orders, inside)
        return e if new is None else new
    return e.func(*(with_jets(a, made) for a in e.args))


def longer(e: sp.Expr, operations: int) -> bool:
    """Whether an expression, written out, has more operations; it may be too long to be written out."""
    return length(e) > 10 * operations or bool(sp.count_ops(e) > operations)


def shortest(e: sp.Expr) -> sp.Expr:
    """The expression, its normal form, or that with A sin² for A − A cos²: whichever has the fewest operations."""
    if longer(e, _MOST_OPERATIONS):
        return e
    if jets := jets_of(e):
        letters = {jet: sp.Dummy() for jet in jets}
        return shortest(e.xreplace(letters)).xreplace({letter: jet for jet, letter in letters.items()})
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


def by_symbol(where: str, values: Mapping[Any, Any], symbols: Iterable[sp.Symbol]) -> dict[Any, Any]:
    """Values by symbol, where names may stand for symbols. Raises InputError for what is no mapping, and for text."""
    if not isinstance(values, Mapping):
        raise InputError(f"{where} = {values!r} must be a dictionary by symbol, {{symbol: …}}")
    if text := next((f"{key} = {value!r}" for key, value in values.items() if isinstance(value, str)), ""):
        raise InputError(f"{where}: {text} is text: give a number or an expression")
    names = {str(s): s for s in symbols}
    return {names.get(str(key), key): value for key, value in values.items()}


def in_order(where: str, numbers: Any, symbols: Sequence[sp.Symbol]) -> Any:
    """Return a mapping {symbol or name: number} as a list in the order of the symbols; anything else unchanged."""
    if not isinstance(numbers, Mapping):
        return numbers
    names, by_name = [str(s) for s in symbols], {str(key): number for key, number in numbers.items()}
    if unknown := [name for name in by_name if name not in names]:
        meant = near(unknown[0], names) or ": leave it out"
        raise InputError(f"{where} names {unknown[0]}, which is none of {', '.join(names)}{meant}")
    if missing := [name for name in names if name not in by_name]:
        raise InputError(f"{where} lacks {', '.join(missing)}: give each of {', '.join(names)} a number")
    if len(by_name) < len(numbers):
        raise InputError(f"{where} = {numbers}: a symbol and its name have two numbers: give one")
    return [by_name[name] for name in names]


def no_letter(where: str, left: Iterable[sp.Symbol]) -> None:
    """Raise InputError where a letter is left without a number."""
    if names := ", ".join(sorted(map(str, left))):
        raise InputError(f"{where}: {names} without a value: give every letter a number")
