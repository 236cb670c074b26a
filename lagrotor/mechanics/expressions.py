"""Check the expressions that users give (plain symbols, finite, no text), and write results as short as possible."""

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
_MOST_OPERATIONS = 600  # of an expression for which a shorter form is sought


def expression(where: str, value: Any) -> sp.Expr:
    """Return a sympy expression; raise InputError for anything else. No text is parsed."""
    try:
        e = sp.sympify(value, strict=True)
    except (sp.SympifyError, TypeError):
        e = None
    if not isinstance(e, sp.Expr) or isinstance(e, sp.MatrixExpr | sp.MatrixBase):
        raise InputError(f"{where} = {value!r} is no expression: build it from sympy symbols")
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
        raise InputError(f"{where} = {e} is complex, and a system needs real functions: write its real part")
    return e


def no_coordinate(where: str, expressions: Any, names: Iterable[sp.Symbol]) -> None:
    """Raise InputError if a function has the name of a coordinate: θ(t) and θ would be two different quantities."""
    moving = {*map(str, names)}
    if wrong := [f for f in unknown_functions(expressions) if str(f.func) in moving]:
        raise InputError(f"{where} contains {wrong[0]}: {_PLAIN}")


def unknown_functions(expressions: Any) -> list[sp.Expr]:
    """Return the undefined functions U(r), y(t) … in expressions, in a fixed order."""
    listed = [
        sp.sympify(e, strict=True) for e in (expressions if isinstance(expressions, Iterable) else (expressions,))
    ]
    return sorted({e for e in subexpressions(*listed) if isinstance(e, AppliedUndef)}, key=sp.default_sort_key)


def put_in(e: sp.Expr, values: Mapping[Any, Any]) -> sp.Expr:
    """Replace symbols in an expression by values, also inside derivatives U'(r) of unknown functions."""
    return e.subs(values, simultaneous=True) if e.has(sp.Derivative) else e.xreplace(dict(values))


def jets_of(e: sp.Expr) -> list[sp.Expr]:
    """Return the undefined functions and their derivatives in an expression, outermost alone: of sin(U'(y(t))) only U'(y(t))."""
    if not e.has(AppliedUndef):
        return []
    return [e] if jet_of(e) is not None else [jet for a in e.args for jet in jets_of(a)]


def with_jets(
    e: sp.Expr, replacement: Callable[[str, tuple[int, ...], tuple[sp.Expr, ...]], sp.Expr | None]
) -> sp.Expr:
    """Replace undefined functions and derivatives by replacement(name, orders, arguments); where that is None they stay.

    `orders` is the order of differentiation by each argument, all zero for the function itself.
    """
    if not e.has(AppliedUndef):
        return e
    if (jet := jet_of(e)) is not None:
        (function, orders), arguments = jet
        inside = tuple(with_jets(a, replacement) for a in arguments)
        new = replacement(str(function), orders, inside)
        return e if new is None else new
    return e.func(*(with_jets(a, replacement) for a in e.args))


def longer(e: sp.Expr, operations: int) -> bool:
    """Return True if an expression has more than so many operations. Shared parts are not written out to count them."""
    return length(e) > 10 * operations or bool(sp.count_ops(e) > operations)


def shortest(e: sp.Expr) -> sp.Expr:
    """Return the shortest of three equal forms: the expression, its normal form, and that form with A sin² for A − A cos²."""
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
    """Replace each pair of terms A, −A cos² of a sum by A sin²."""
    terms = {*sp.Add.make_args(e)}
    for term in sorted(terms, key=sp.default_sort_key):
        for cosine in term.atoms(sp.cos):
            factor = term / cosine**2
            if term in terms and -factor in terms:
                terms = terms - {term, -factor} | {-factor * sp.sin(cosine.args[0]) ** 2}
    return sp.Add(*terms)


def vector_of(where: str, components: Any, n: int) -> tuple[sp.Expr, ...]:
    """Return n expressions; raise InputError for anything else."""
    if hasattr(components, "tolist") and not isinstance(components, sp.MatrixBase):
        components = components.tolist()  # an array of numpy
    if not isinstance(components, Sequence | sp.MatrixBase) or isinstance(components, str) or len(components) != n:
        raise InputError(f"{where} = {components!r} must be {n} expressions")
    return tuple(expression(f"{where}[{i}]", e) for i, e in enumerate(components))


def repeated_name(values: Mapping[Any, Any]) -> str:
    """Return a name that two keys of a mapping have, for example a symbol and its name; "" if there is none."""
    names = [str(key) for key in values]
    return next((name for name in names if names.count(name) > 1), "")


def by_symbol(where: str, values: Mapping[Any, Any], symbols: Iterable[sp.Symbol]) -> dict[Any, Any]:
    """Return {symbol: value} from a mapping by symbol or name, or from an Equilibrium; raise InputError for anything else, or if
    a value is text."""
    if not isinstance(values, Mapping):
        values = getattr(values, "at", values)
    if not isinstance(values, Mapping):
        raise InputError(f"{where} = {values!r} must be a dictionary by symbol, {{symbol: …}}")
    if text := next((f"{key} = {value!r}" for key, value in values.items() if isinstance(value, str)), ""):
        raise InputError(f"{where}: {text} is text: give a number or an expression")
    names = {str(s): s for s in symbols}
    by_key = {names.get(str(key), key): value for key, value in values.items()}
    if twice := repeated_name(values):
        raise InputError(f"{where}: {twice} is given twice, as a symbol and as a name: give one")
    return by_key


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


def no_letter(where: str, symbols: Iterable[sp.Symbol]) -> None:
    """Raise InputError for symbols without a number."""
    if names := ", ".join(sorted(map(str, symbols))):
        raise InputError(f"{where}: {names} without a value: give every symbol a number")
