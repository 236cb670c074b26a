"""Slips of an author: one sign, factor, power, index or function of a side changed, so that it agrees with another."""

from collections.abc import Callable, Collection, Iterator
from fractions import Fraction
from functools import partial
from itertools import islice
from typing import Any

import sympy as sp

from lagrotor.paper.latex.comparison import LARGEST, decided, nearly_equal, value_at
from lagrotor.paper.latex.tree import KNOWN, Call, Letter, Node, Number, has_opaque, rational_value, text_of

# Functions that are taken for each other.
_TAKEN_FOR = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh"}
_TWICE = ((Fraction(2), "{} doubled"), (Fraction(1, 2), "{} halved"))
_FACTORS = ((Fraction(-1), "the sign of {} changed"), *_TWICE)
_MOST_SLIPS = 120  # changes that are tried
_MOST_PARTS = 100  # denominator of a factor


def change_to_agree(
    fixed: Any, changing: Node, names: Collection[str], value: Callable[[Node], Any], by_identity: bool = False
) -> str | None:
    """Return the one change of a side with which it agrees with another, in words; None where there is none.

    Parameters
    ----------
    fixed : sympy.Expr or sympy.Matrix
        The other side.
    changing : Node
        The side that is changed.
    names : collection of str
        Letters that may stand for each other if they differ in their index.
    value : callable
        Called with a changed side; returns its expression, or None.
    by_identity : bool
        Whether the sides are said to be equal for all values. A change that makes them the same print, as in cos x = sin x,
        or that puts another index, is none then: both may be conditions.
    """
    expression = value(changing)
    point = point_of(fixed, expression)
    number = value_at(fixed, point)
    bare = by_identity or has_opaque(fixed)  # {f, f} = −{f, f} = 0 and tan x = cot x may be conditions
    ratio = _ratio(number, value_at(expression, point))
    scaled = sp.Rational(str(ratio or 0)) * expression
    if ratio is not None and decided(fixed, scaled) == "zero":
        if ratio == -1 and not bare:
            return "with the sign of the whole changed they agree"
        if ratio > 0 and not (bare and fixed == scaled):
            return f"with the factor {ratio} of the whole they agree"
    for changed, said in islice(slips(changing, () if by_identity else names), _MOST_SLIPS):
        other = value(changed)
        if other is None or (by_identity and fixed == other):
            continue
        if nearly_equal(number, value_at(other, point)) and decided(fixed, other) == "zero":
            return f"with {said} they agree"
    return None


def slips(node: Node, names: Collection[str] = ()) -> Iterator[tuple[Node, str]]:
    """Yield the node with one part changed as authors do, and the change in words; names: letters about."""
    for part, put in _parts(node):
        yield from ((put(changed), said) for changed, said in _changes(part, names))


def _parts(node: Node, put: Callable[[Node], Node] = lambda new: new) -> Iterator[tuple[Node, Callable[[Node], Node]]]:
    """Yield each part of a node with the function that puts another in its place."""
    yield node, put
    if isinstance(node, Call):
        for place, part in enumerate(node.args):
            yield from _parts(part, partial(_put_within, put, node, place))


def _put_within(put: Callable[[Node], Node], node: Node, place: int, new: Node) -> Node:
    return put(_with(node, place, new))


def _with(node: Node, place: int, part: Node) -> Node:
    return Call(node.name, (*node.args[:place], part, *node.args[place + 1 :])) if isinstance(node, Call) else part


def _changes(node: Node, names: Collection[str]) -> Iterator[tuple[Node, str]]:
    """Yield a node with another index, power, function or argument, or with another factor of a term."""
    if isinstance(node, Letter) and not node.vector:
        stem = node.name.split("_")[0]
        for name in sorted(names):
            if name != node.name and name.split("_")[0] == stem:
                yield Letter(name), f"{name} for {node.name}"
    base, power, more = _powers(node)
    for each in (power + difference for difference in more):
        if each:  # cos² nπ is 1 for whole n
            yield Call("power", (base, Number(each))), f"the power {each} of {text_of(base)}"
    if isinstance(node, Call) and node.name in KNOWN:
        if other := _TAKEN_FOR.get(node.name):
            yield Call(other, node.args), f"{other} for {node.name}"
        for factor, said in _TWICE:
            yield (
                Call(node.name, (_times(factor, node.args[0]), *node.args[1:])),
                f"the argument of {said.format(text_of(node))}",
            )
    if isinstance(node, Call) and node.name == "sum":
        for place, term in enumerate(node.args):
            for factor, said in _FACTORS:
                yield _with(node, place, _times(factor, term)), said.format(text_of(term))


def _powers(node: Node) -> tuple[Node, Fraction, tuple[Fraction | int, ...]]:
    """Return the base and the power that a node is, and the differences of powers that are tried."""
    if isinstance(node, Call) and node.name == "power" and (power := rational_value(node.args[1])) is not None:
        return node.args[0], power, (1, -1, 2, -2)
    if isinstance(node, Call) and node.name == "sqrt":
        return node.args[0], Fraction(1, 2), (1, Fraction(1, 2))
    single = node.name in _TAKEN_FOR if isinstance(node, Call) else isinstance(node, Letter) and not node.vector
    return node, Fraction(1), (1,) if single else ()


def _times(factor: Fraction, node: Node) -> Node:
    return Call("product", (Number(factor), node))


def _ratio(value: Any, other: Any) -> Fraction | None:
    """Return the quotient of two numbers as a fraction of small numbers; None where it is none."""
    if not (value.is_real and other.is_real and other and abs(value / other) < LARGEST):
        return None
    fraction = Fraction(float(value / other)).limit_denominator(_MOST_PARTS)
    return fraction if nearly_equal(value, sp.Rational(str(fraction)) * other) else None


def constant_value(a: Any) -> sp.Rational | None:
    """Return the number that an expression is for all values of its letters; None where it is none."""
    ratio = None if isinstance(a, sp.MatrixBase) else _ratio(value_at(a, point_of(a)), sp.S.One)
    constant = None if ratio is None else sp.Rational(str(ratio))
    return constant if constant is not None and decided(a, constant) == "zero" else None


def point_of(*sides: Any) -> dict[sp.Symbol, sp.Rational]:
    """Return a value for each letter of some sides."""
    symbols = sorted(set().union(*(side.free_symbols for side in sides)), key=str)
    return {symbol: sp.Rational(2 * place + 3, 2 * place + 5) for place, symbol in enumerate(symbols)}
