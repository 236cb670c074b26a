"""What a marked reading leaves open, and whether a step says by itself that it does not matter."""

import re
from collections.abc import Iterator, Sequence
from itertools import combinations, product

from lagrotor.paper.source.rows import UNITS
from lagrotor.paper.source.tree import KNOWN, Call, Letter, Node, letters_of, product_of, walk

# The one guess that verdicts rest on: that log is the natural logarithm.
ANY_BASE = "log is"
# Of what has a name or is a quantity of its own: it stands for itself, whatever it is, where nothing is differentiated.
_OF_NAMES = re.compile(r"with a dot is its rate|is (?:a|part of the) name, and no derivative|angle brackets are a mean")
_PLAIN = frozenset(
    (*KNOWN, "sum", "product", "quotient", "power", "negative", "dot", "cross", "norm", "column", "mean")
)
_FACTOR = re.compile(r"(\w+) before [(\[\\{]+ is a factor, and no function")
_NO_OPERATOR = re.compile(r"(\w+) is a factor of what follows, and no operator")
_NO_UNIT = re.compile(r"(\w+) behind the number is a letter, and no unit")
_NOT_SUMMED = re.compile(r"the index (\w+) is not summed over")
# What is an identity with a name in it is one with a product in its place.
_NO_NAME = re.compile(r"\w+ is a product, and no name")
_ENCLOSED = ("sqrt", "Abs", "factorial")  # functions whose argument is always plain
_ARGUMENT = re.compile(r"the argument of \w+ (?:is|ends)\b")


def is_settled(guess: str, nodes: Sequence[Node], put: Sequence[Node] = ()) -> bool:
    """Whether a guess does not matter to a step of these sides and premises.

    An index that is a letter of the step is a number; a factor before a bracket stands elsewhere without one; what might be an
    operator stands in one order with every other letter but those below fractions, and need not commute; V' is the derivative
    where it is put in as that. Where the argument of a function ends is left to `other_arguments`.

    put: the parts for which premises are put in.
    """
    if guess.startswith(ANY_BASE) or _ARGUMENT.match(guess) or _NO_NAME.match(guess):
        return True
    if index := _NOT_SUMMED.match(guess):
        return any(_stem(name) == index[1] for node in nodes for name in letters_of(node))
    if any(isinstance(each, Call) and each.name == f"{guess.split()[0]}prime" for each in put):
        return True
    if _OF_NAMES.search(guess):
        return all(each.name in _PLAIN for node in nodes for each in walk(node) if isinstance(each, Call))
    if _NO_UNIT.match(guess):  # of quantities alone the numbers may be rounded
        return any(_stem(name) not in UNITS for node in nodes for name in letters_of(node))
    if factor := _FACTOR.match(guess):
        return any(_stands_alone(factor[1], node) for node in nodes)
    if letter := _NO_OPERATOR.match(guess):
        numbers = {name for node in nodes for each in walk(node) for name in _below(each)}
        pairs = {pair for node in nodes for pair in _ordered(node) if not numbers & {*pair}}
        return not any((b, a) in pairs for a, b in pairs if letter[1] in (_stem(a), _stem(b)))
    return False


def is_of_argument(guess: str) -> bool:
    return bool(_ARGUMENT.match(guess))


def other_arguments(left: Node, right: Node) -> Iterator[tuple[Node, Node]]:
    """The two sides where arguments of functions end elsewhere: sin(k x) as sin(k) x, sin(k) x as sin(k x)."""
    options = [list(dict.fromkeys((side, _shorter(side), _longer(side)))) for side in (left, right)]
    for pair in product(*options):
        if pair != (left, right):
            yield pair[0], pair[1]


def _stem(name: str) -> str:
    return name.split("_")[0]


def _stands_alone(name: str, node: Node) -> bool:
    """Whether a letter stands somewhere but as a factor before a bracket."""
    if isinstance(node, Letter):
        return _stem(node.name) == name
    if not isinstance(node, Call):
        return False
    before = {id(a) for a, b in zip(node.args, node.args[1:], strict=False) if node.name == "product" and _is_sum(b)}
    return any(_stands_alone(name, part) for part in node.args if id(part) not in before)


def _is_sum(node: Node) -> bool:
    base = node.args[0] if isinstance(node, Call) and node.name == "power" else node
    return isinstance(base, Call) and base.name == "sum"


def _below(node: Node) -> list[str]:
    """The letters below a fraction: they are numbers."""
    return letters_of(node.args[1]) if isinstance(node, Call) and node.name == "quotient" else []


def _ordered(node: Node) -> Iterator[tuple[str, str]]:
    """Each two letters that are multiplied, in their order; of what is in a power or a function in both."""
    for each in walk(node):
        if not isinstance(each, Call) or each.name in ("sum", "negative", "quotient"):
            continue
        groups = list(map(letters_of, each.args)) if each.name == "product" else [letters_of(each)] * 2
        for one, other in combinations(groups, 2):
            yield from ((a, b) for a, b in product(one, other) if a != b)


def _function_in(node: Node) -> Call | None:
    """The function that a factor is, or a power of it; None for what is none or always has its argument in print."""
    inner = node.args[0] if isinstance(node, Call) and node.name == "power" else node
    return inner if isinstance(inner, Call) and inner.name in KNOWN and inner.name not in _ENCLOSED else None


def _with_argument(node: Node, argument: list[Node]) -> Node:
    inner = _function_in(node)
    if inner is None or not isinstance(node, Call):
        return node
    of = Call(inner.name, (product_of(argument),))
    return of if node is inner else Call(node.name, (of, *node.args[1:]))


def _shorter(node: Node) -> Node:
    """With each function that has a product in it as a function of the first factor, times the rest."""
    if not isinstance(node, Call):
        return node
    if (inner := _function_in(node)) is not None:
        argument = inner.args[0]
        first, *rest = argument.args if isinstance(argument, Call) and argument.name == "product" else (argument,)
        return product_of([_with_argument(node, [first]), *rest])
    return Call(node.name, tuple(map(_shorter, node.args)))


def _longer(node: Node) -> Node:
    """With each function in a product as one of all factors up to the next function."""
    if not isinstance(node, Call):
        return node
    args = tuple(map(_longer, node.args))
    if node.name != "product":
        return Call(node.name, args)
    made: list[Node] = []
    for part in args:
        if made and (inner := _function_in(made[-1])) is not None and _function_in(part) is None:
            made[-1] = _with_argument(made[-1], [*inner.args, part])
        else:
            made.append(part)
    return product_of(made)
