"""Typical slips of an author. One sign, factor, power or function is changed, and two sides become equal."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from itertools import islice
from typing import Any

import sympy as sp

from lagrotor.paper.latex.comparison import LARGEST, equality, nearly_equal, value_at
from lagrotor.paper.latex.tree import KNOWN, Call, Letter, Node, Number, has_opaque, rational_value, text_of

# Functions that authors confuse.
_TAKEN_FOR = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh"}
_FACTORS = (
    (Fraction(-1), "the sign of {} changed"),
    (Fraction(2), "{} doubled"),
    (Fraction(1, 2), "{} halved"),
)
_MOST_SLIPS = 100  # number of changes tried
_MOST_PARTS = 100  # largest denominator of a factor


def change_to_agree(fixed: Any, changing: Node, value: Callable[[Node], Any]) -> str:
    """Return in words the single change of the side `changing` that makes it equal to the expression `fixed`.

    "" means that no such change was found. `value` returns the expression of a side, None if there is none.
    """
    expression = value(changing)
    point = point_of(fixed, expression)
    number = value_at(fixed, point)
    ratio = _ratio(number, value_at(expression, point))
    if ratio and not has_opaque(fixed) and equality(fixed, sp.Rational(str(ratio)) * expression) == "zero":
        return f"an additional factor {ratio}"
    for variant, change in islice(_slips(changing), _MOST_SLIPS):
        slip = value(variant)
        if slip is not None and nearly_equal(number, value_at(slip, point)) and equality(fixed, slip) == "zero":
            return change
    return ""


def _slips(node: Node, embed: Callable[[Node], Node] = lambda new: new) -> Iterator[tuple[Node, str]]:
    """Yield pairs of a side with one changed part, and this change in words.

    `node` is the part that is changed, with the parts below it; `embed` returns the side with a new part in its place.
    """
    yield from ((embed(changed), change) for changed, change in _changes(node))
    if isinstance(node, Call):
        for place, argument in enumerate(node.args):
            yield from _slips(argument, partial(_embed_argument, embed, node, place))


def _embed_argument(embed: Callable[[Node], Node], node: Call, place: int, new: Node) -> Node:
    return embed(_with_argument(node, place, new))


def _with_argument(node: Call, place: int, argument: Node) -> Call:
    return Call(node.name, (*node.args[:place], argument, *node.args[place + 1 :]))


def _changes(node: Node) -> Iterator[tuple[Node, str]]:
    """Yield pairs of a changed node and the change in words: another power, function or argument, or a factor of a term.

    The parts of the node stay unchanged otherwise.
    """
    base, power, steps = _powers(node)
    for exponent in (power + difference for difference in steps):
        if exponent:  # not 0: cos² nπ = 1 for integer n is no slip
            yield Call("power", (base, Number(exponent))), f"the power {exponent} of {text_of(base)}"
    if isinstance(node, Call) and node.name in KNOWN:
        if function := _TAKEN_FOR.get(node.name):
            yield Call(function, node.args), f"{function} in place of {node.name}"
        for factor, words in _FACTORS:
            changed = _with_argument(node, 0, _times(factor, node.args[0]))
            yield changed, words.format(f"the argument of {text_of(node)}")
    if isinstance(node, Call) and node.name == "sum":
        for place, term in enumerate(node.args):
            for factor, words in _FACTORS:
                yield _with_argument(node, place, _times(factor, term)), words.format(text_of(term))


def _powers(node: Node) -> tuple[Node, Fraction, tuple[Fraction | int, ...]]:
    """Return the base and the exponent of a node, and the errors that are tried: numbers to be added to this exponent."""
    if isinstance(node, Call) and node.name == "power" and (power := rational_value(node.args[1])) is not None:
        return node.args[0], power, (1, -1, 2, -2)
    if isinstance(node, Call) and node.name == "sqrt":
        return node.args[0], Fraction(1, 2), (1, Fraction(1, 2))
    single = node.name in _TAKEN_FOR if isinstance(node, Call) else isinstance(node, Letter) and not node.vector
    return node, Fraction(1), (1,) if single else ()


def _times(factor: Fraction, node: Node) -> Node:
    return Call("product", (Number(factor), node))


def _ratio(a: Any, b: Any) -> Fraction | None:
    """Return a/b as a fraction with a denominator of at most _MOST_PARTS; None if it is not such a fraction."""
    if not (a.is_real and b.is_real and b and abs(a / b) < LARGEST):
        return None
    fraction = Fraction(float(a / b)).limit_denominator(_MOST_PARTS)
    return fraction if nearly_equal(a, sp.Rational(str(fraction)) * b) else None


def constant_value(a: Any) -> sp.Rational | None:
    """Return the rational value of an expression if it does not depend on its symbols, else None."""
    ratio = None if isinstance(a, sp.MatrixBase) else _ratio(value_at(a, point_of(a)), sp.S.One)
    constant = None if ratio is None else sp.Rational(str(ratio))
    return constant if constant is not None and equality(a, constant) == "zero" else None


def point_of(*sides: Any) -> dict[sp.Symbol, sp.Rational]:
    """Return a test point: a map from each symbol of some sides to a rational value between 1/2 and 1."""
    symbols = sorted(set().union(*(side.free_symbols for side in sides)), key=str)
    return {symbol: sp.Rational(2 * place + 3, 2 * place + 5) for place, symbol in enumerate(symbols)}
