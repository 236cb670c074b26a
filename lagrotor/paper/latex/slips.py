"""Slips of an author: one sign, factor, power, index or function of a side changed, so that it agrees with another."""

from collections.abc import Callable, Collection, Iterator
from fractions import Fraction
from functools import partial
from itertools import chain, islice
from typing import Any

import sympy as sp

from lagrotor.paper.latex.comparison import LARGEST, decided, nearly_equal, value_at
from lagrotor.paper.latex.tree import KNOWN, Call, Letter, Node, Number, has_opaque, text_of

# Functions that are taken for each other.
_TAKEN_FOR = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh"}
_TWICE = ((Fraction(2), "doubled"), (Fraction(1, 2), "halved"))
_MOST_SLIPS = 120  # changes that are tried


def change_to_agree(
    fixed: Any,
    changing: Node,
    names: set[str],
    value: Callable[[Node], Any],
    by_identity: bool = False,
) -> str | None:
    """The one change of a side with which it is the other, `fixed`; value: of a side as an expression.

    by_identity: by more than to the same print, as cos x = sin x, and not by putting θ₁ for θ₂: both may be conditions.
    """
    given = value(changing)
    letters = (sp.Symbol(name, real=True) for name in names)
    symbols = sorted({*fixed.free_symbols, *given.free_symbols, *letters}, key=str)
    point = {symbol: sp.Rational(2 * place + 3, 2 * place + 5) for place, symbol in enumerate(symbols)}
    number = value_at(fixed, point)
    ratio = _ratio(fixed, given, point)
    bare = by_identity or has_opaque(fixed)  # {f, f} = −{f, f} = 0 and tan x = cot x may be conditions
    if ratio is not None and not (bare and fixed == sp.Rational(str(ratio)) * given):
        return f"with the factor {ratio} of the whole they agree"
    whole = () if bare else _whole(changing)
    for mutant, said in islice(chain(whole, slips(changing, () if by_identity else names)), _MOST_SLIPS):
        other = value(mutant)
        if other is None or (by_identity and fixed == other):
            continue
        if nearly_equal(number, value_at(other, point)) and decided(fixed, other) == "zero":
            return f"with {said} they agree"
    return None if by_identity else _term_to_agree(fixed, changing, value, number, point)


def _term_to_agree(
    fixed: Any, changing: Node, value: Callable[[Node], Any], number: Any, point: dict[sp.Symbol, sp.Rational]
) -> str | None:
    """The number of one digit by which one term of a sum is multiplied, so that the two agree."""
    whole = value_at(value(changing), point)
    for with_term, term in _terms(changing):
        without = value_at(value(with_term(Number(Fraction(0)))), point)
        try:
            ratio = Fraction(float((number - without) / (whole - without))).limit_denominator(9)
        except (TypeError, ValueError, ArithmeticError):
            continue
        mutant = with_term(_times(ratio, term))
        near = 0 < abs(ratio.numerator) < 10 and ratio != 1 and nearly_equal(number, value_at(value(mutant), point))
        if near and decided(fixed, value(mutant)) == "zero":
            return f"with {text_of(term)} times {ratio} they agree"
    return None


def _terms(node: Node) -> Iterator[tuple[Callable[[Node], Node], Node]]:
    """The terms of the sums in a node, each with what the node is for another in its place."""
    if not isinstance(node, Call):
        return
    for place, part in enumerate(node.args):
        inside = partial(_with, node, place)
        if node.name == "sum":
            yield inside, part
        yield from ((lambda new, a=inside, b=deeper: a(b(new)), term) for deeper, term in _terms(part))


def slips(node: Node, names: Collection[str] = ()) -> Iterator[tuple[Node, str]]:
    """The node with one sign, factor 2, power, index or function changed, and what was changed; names: letters about."""
    if isinstance(node, Letter) and not node.vector:
        for name in sorted(names):
            if name != node.name and name.split("_")[0] == node.name.split("_")[0]:
                yield Letter(name), f"{name} for {node.name}"
        yield Call("power", (node, Number(Fraction(2)))), f"{node.name} squared"
    if not isinstance(node, Call):
        return
    if node.name in KNOWN:
        yield from _of_function(node)
    if node.name == "sum":
        for place, term in enumerate(node.args):
            other = term.args[0] if isinstance(term, Call) and term.name == "negative" else Call("negative", (term,))
            yield _with(node, place, other), f"the sign of {text_of(term)} changed"
            yield from (
                (_with(node, place, _times(factor, term)), f"{text_of(term)} {said}") for factor, said in _TWICE
            )
    yield from _of_power(node)
    for place, part in enumerate(node.args):
        for changed, said in slips(part, names):
            yield _with(node, place, changed), said


def _of_power(node: Call) -> Iterator[tuple[Node, str]]:
    """Another power by one or two, of a root by a half more, and exp of the opposite."""
    if node.name == "power" and (power := _rational(node.args[1])) is not None:
        for more, said in ((1, "one"), (-1, "one"), (2, "two"), (-2, "two")):
            if power + more:  # cos² nπ is 1 for whole n
                yield _with(node, 1, Number(power + more)), f"the power of {text_of(node)} changed by {said}"
    if node.name == "sqrt":
        for power in (Fraction(3, 2), Fraction(1)):
            yield (
                Call("power", (*node.args, Number(power))),
                f"the power {power} for the root of {text_of(node.args[0])}",
            )
    if node.name == "exp":
        yield _with(node, 0, Call("negative", node.args)), f"the sign in {text_of(node)} changed"


def _of_function(node: Call) -> Iterator[tuple[Node, str]]:
    """Another function for sine or cosine, its square, and twice or half the argument of any function."""
    if node.name in _TAKEN_FOR:
        yield Call(_TAKEN_FOR[node.name], node.args), f"{_TAKEN_FOR[node.name]} for {node.name}"
        yield Call("power", (node, Number(Fraction(2)))), f"{text_of(node)} squared"
    for factor, said in _TWICE:
        yield Call(node.name, (_times(factor, node.args[0]),)), f"the argument of {text_of(node)} {said}"


def _rational(node: Node) -> Fraction | None:
    """The number that a power is: 2, −1, 3/2."""
    if isinstance(node, Number):
        return node.value
    parts = [_rational(part) for part in node.args] if isinstance(node, Call) else []
    match (node.name, *parts):
        case ("negative", Fraction() as value):
            return -value
        case ("quotient", Fraction() as above, Fraction() as below) if below:
            return above / below
    return None


def _times(factor: Fraction, node: Node) -> Node:
    return Call("product", (Number(factor), node))


def _whole(node: Node) -> Iterator[tuple[Node, str]]:
    """The node with its sign changed, or turned over."""
    if not (isinstance(node, Call) and node.name == "sum"):
        yield Call("negative", (node,)), "the sign of the whole changed"
    yield Call("quotient", (Number(Fraction(1)), node)), "the whole turned over"
    yield Call("sqrt", (node,)), "the root of the whole"
    yield Call("power", (node, Number(Fraction(2)))), "the whole squared"


def _ratio(a: Any, b: Any, point: dict[sp.Symbol, sp.Rational]) -> Fraction | None:
    """The number of few digits by which b is multiplied to be a."""
    if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase):
        return None
    value, other = value_at(a, point), value_at(b, point)
    if not (value.is_real and other.is_real and value and other):
        return None
    if abs(value / other) > LARGEST:
        return None
    ratio = Fraction(float(value / other)).limit_denominator(100)
    exact = sp.Rational(ratio.numerator, ratio.denominator)
    return ratio if ratio > 0 and nearly_equal(value, exact * other) and decided(a, exact * b) == "zero" else None


def constant_value(a: Any) -> sp.Rational | None:
    """The number that an expression may be, whatever its letters are."""
    if isinstance(a, sp.MatrixBase):
        return None
    values = {}
    for shift in (3, 7):
        point = {s: sp.Rational(2 * n + shift, 2 * n + 5) for n, s in enumerate(sorted(a.free_symbols, key=str))}
        values[shift] = value_at(a, point)
    if not all(value.is_real for value in values.values()) or not nearly_equal(*values.values()):
        return None
    return sp.Rational(str(Fraction(float(values[3])).limit_denominator(100)))


def _with(node: Call, place: int, part: Node) -> Call:
    return Call(node.name, (*node.args[:place], part, *node.args[place + 1 :]))
