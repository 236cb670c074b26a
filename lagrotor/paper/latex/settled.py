"""What a marked reading leaves open, and whether a step says by itself that it does not matter."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import combinations, groupby, pairwise, product

from lagrotor.paper.latex.chapters import PROOFS, TAKEN
from lagrotor.paper.latex.rows import UNITS
from lagrotor.paper.latex.tree import KNOWN, Call, Letter, Node, Number, letters_of, product_of, text_of, walk

# The one guess that verdicts rest on: that log is the natural logarithm.
ANY_BASE = "log is"
# Of what has a name or is a quantity of its own: it stands for itself, whatever it is, where nothing is differentiated.
_OF_NAMES = re.compile(r"with a dot is its rate|is (?:a|part of the) name, and no derivative|angle brackets are a mean")
_INDEX = re.compile(r"the index of (\w+) is part of the name, and no derivative")
_PLAIN = frozenset(
    (*KNOWN, "sum", "product", "quotient", "power", "negative", "dot", "cross", "norm", "column", "mean")
)
# Calls that keep the order of the factors in them: derivatives and integrals are linear.
_LINEAR = frozenset(("Derivative", "Integral", "rate", "at", "at_constant"))
_FACTOR = re.compile(r"(\w+) before [(\[\\{]+ is a factor, and no function")
_NO_OPERATOR = re.compile(r"(\w+) is a factor of what follows, and no operator")
_NO_UNIT = re.compile(r"(\w+) behind the number is a letter, and no unit")
_NOT_SUMMED = re.compile(r"the index (\w+) is not summed over")
_DIFFERENCE = re.compile(r"(\w+) (\w+) is one quantity, a difference, and no product")
_NO_NAME = re.compile(r"(\w+) is a product, and no name")
_POWER = re.compile(r"the superscript of (?:a bracket|(\w+)) is a power, and no index")
_NO_NUMBER = "e is a letter, and not Euler's number"
_ENCLOSED = ("sqrt", "Abs", "factorial")  # functions whose argument is always plain
_ARGUMENT = re.compile(r"the argument of \w+ (?:is|ends)\b")


def is_settled(guess: str, nodes: Sequence[Node], put: Sequence[Node]) -> bool:
    """Whether a guess does not matter to a step of these sides and premises.

    An index that is a letter of the step is a number; V' is the derivative, and |Z| a magnitude, where it is put in as that.
    What is an identity in e, or in Δx, is one in a number or a product. A letter that stands elsewhere without a bracket, before
    another one, or before one that is differentiated where no derivative of it is printed, is no function. What might be an
    operator stands in one order with every other letter but those below fractions and in exponents, and need not commute.
    `other_readings` are tried beside.

    put: the parts for which premises are put in.
    """
    letters = {name for node in nodes for name in letters_of(node)}
    calls = [each for node in nodes for each in walk(node) if isinstance(each, Call)]
    names = {each.name for each in calls}
    of_numbers = guess.startswith(TAKEN[PROOFS]) and not names.isdisjoint(KNOWN)  # of sets and maps there are no sines
    if of_numbers or guess.startswith(ANY_BASE) or _ARGUMENT.match(guess) or _NO_NAME.match(guess):
        return True
    if guess.startswith(_NO_NUMBER):
        powers = (each.args[1] for each in calls if each.name == "power")
        return "log" not in names and "exp" not in names and not any("e" in _differentiated(each) for each in calls) and all(
            not letters_of(each) for each in powers
        )  # fmt: skip
    if difference := _DIFFERENCE.match(guess):
        return not {*difference.groups()} & letters
    if index := _NOT_SUMMED.match(guess):
        return any(_stem(name) == index[1] for name in letters)
    if any(isinstance(each, Call) and each.name == f"{guess.split()[0]}prime" for each in put):
        return True
    if power := _POWER.match(guess):  # of which the derivative is taken by its base
        by = {_stem(letter) for each in calls for letter in _differentiated(each)}
        bases = [each.args[0] for each in calls if each.name == "power" and letters_of(each.args[1])]
        return (
            power[1] in by if power[1] else bool(bases) and all(by & {*map(_stem, letters_of(base))} for base in bases)
        )
    if guess.startswith("the bars are a magnitude"):
        return any(isinstance(each, Call) and each.name == "Abs" for each in put)
    if guess.startswith("the index of a bracket"):
        held = [each for each in calls if each.name == "at_constant"]
        return all(isinstance(each.args[0], Call) and each.args[0].name == "Derivative" for each in held)
    if _OF_NAMES.search(guess):
        stem = match[1] if (match := _INDEX.match(guess)) else ""
        own = sorted(name for name in letters if _stem(name) == stem)
        apart = bool(own) and not any(b.startswith(a) for a, b in pairwise(own)) and stem not in own
        return names <= (_PLAIN | _LINEAR if apart else _PLAIN)
    if _NO_UNIT.match(guess):  # of quantities alone the numbers may be rounded
        return any(_stem(name) not in UNITS for name in letters)
    if factor := _FACTOR.match(guess):
        return _is_no_function(factor[1], nodes, calls)
    if letter := _NO_OPERATOR.match(guess):
        numbers = {name for each in calls if each.name in ("quotient", "power") for name in letters_of(each.args[1])}
        pairs = {pair for node in nodes for pair in _ordered(node) if not numbers & {*pair}}
        return not any((b, a) in pairs for a, b in pairs if letter[1] in (_stem(a), _stem(b)))
    return False


def may_not_commute(nodes: Iterable[Node]) -> bool:
    """Whether two terms of a sum are products of the same in another order, ab − ba, or a product has a letter again, aba.

    No one prints that of numbers.
    """
    for each in (part for node in nodes for part in walk(node) if isinstance(part, Call)):
        terms = (term.args[0] if isinstance(term, Call) and term.name == "negative" else term for term in each.args)
        products = [term.args for term in terms if isinstance(term, Call) and term.name == "product"]
        factors = {tuple(map(text_of, row)) for row in products}
        if each.name == "sum" and len({tuple(sorted(row)) for row in factors}) < len(factors):
            return True
        letters = [part for part in each.args if isinstance(part, Letter)] if each.name == "product" else []
        if len({part for part, _ in groupby(letters)}) < len([*groupby(letters)]):
            return True
    return False


def is_of_argument(guess: str) -> bool:
    return bool(_ARGUMENT.match(guess))


def is_of_operators(guess: str) -> bool:
    return bool(_NO_OPERATOR.match(guess))


def other_readings(guess: str, left: Node, right: Node) -> Iterator[tuple[Node, Node]]:
    """The two sides as they may be meant as well, where a guess leaves it open.

    Arguments of functions that end elsewhere: sin(k x) as sin(k) x, sin(k) x as sin(k x); V before (x − y) as a function, even or
    odd; R e² as (Re)².
    """
    changes: list[Callable[[Node], Node]] = []
    if _ARGUMENT.match(guess):
        options = [list(dict.fromkeys((side, _shorter(side), _longer(side)))) for side in (left, right)]
        yield from ((a, b) for a, b in product(*options) if (a, b) != (left, right))
    elif factor := _FACTOR.match(guess):
        changes = [partial(_called, factor[1], sign) for sign in (1, -1)]
    elif name := _NO_NAME.match(guess):
        changes = [partial(_named, name[1])]
    for change in changes:
        yield change(left), change(right)


def _called(name: str, sign: int, node: Node) -> Node:
    """With each letter before a bracket as a function of it; sign: that the function takes with its argument."""
    if not isinstance(node, Call):
        return node
    args: list[Node] = []
    for part in (_called(name, sign, each) for each in node.args):
        before = args[-1] if args else None
        if node.name == "product" and isinstance(before, Letter) and _stem(before.name) == name and _is_sum(part):
            args[-1] = _of_a_sum(before.name, sign, part)
        else:
            args.append(part)
    return product_of(args) if node.name == "product" else Call(node.name, tuple(args))


def _of_a_sum(name: str, sign: int, bracket: Node) -> Node:
    """A function of a sum in the order of its terms as text, the first of them positive."""
    if not isinstance(bracket, Call):
        return bracket
    if bracket.name == "power":
        return Call("power", (_of_a_sum(name, sign, bracket.args[0]), *bracket.args[1:]))
    terms = [
        (part.args[0], -1) if isinstance(part, Call) and part.name == "negative" else (part, 1) for part in bracket.args
    ]
    terms.sort(key=lambda term: text_of(term[0]))
    turned = terms[0][1]
    ordered = tuple(part if own == turned else Call("negative", (part,)) for part, own in terms)
    of = Call(name, (Call("sum", ordered),))
    return Call("negative", (of,)) if turned == sign == -1 else of


def _named(name: str, node: Node) -> Node:
    """With the letters of a name that touch as one letter."""
    if not isinstance(node, Call):
        return node
    args = [_named(name, each) for each in node.args]
    size = len(name)
    for place in range(len(args) - size, -1, -1) if node.name == "product" else ():
        *first, last = args[place : place + size]
        power = last.args[1:] if isinstance(last, Call) and last.name == "power" else ()
        base = last.args[0] if isinstance(last, Call) and power else last
        if [*first, base] == [Letter(letter) for letter in name]:
            args[place : place + size] = [Call("power", (Letter(name), *power)) if power else Letter(name)]
    return product_of(args) if node.name == "product" else Call(node.name, tuple(args))


# What a paper of operators or matrices says, and prints.
_OF_OPERATORS = re.compile(
    r"operator|matri|ommut|quantum|tensor|algebra|\bspin|\\\\(?:hat|dagger|ket|bra|langle|hbar|otimes|circ|mathcal|operatorname)\b",
    re.I,
)


def is_of_numbers(texts: Iterable[str]) -> bool:
    """Whether no formula or sentence of a paper has a sign of operators or matrices."""
    return not any(map(_OF_OPERATORS.search, texts))


def _stem(name: str) -> str:
    return name.split("_")[0]


def _is_no_function(name: str, nodes: Sequence[Node], calls: Sequence[Call]) -> bool:
    brackets = {letter for each in calls for bracket in _brackets_of(name, each) for letter in letters_of(bracket)}
    by = {letter for each in calls for letter in _differentiated(each)}
    if by & brackets and not any(_is_derivative_of(name, each) for node in nodes for each in walk(node)):
        return True
    several = len({bracket for each in calls for bracket in _brackets_of(name, each)}) > 1
    return several or any(_stands_alone(name, node) for node in nodes)


def _brackets_of(name: str, each: Call) -> list[Node]:
    pairs = pairwise(each.args) if each.name == "product" else ()
    return [b for a, b in pairs if isinstance(a, Letter) and _stem(a.name) == name and _is_sum(b)]


def _differentiated(each: Call) -> list[str]:
    """The letter by which a derivative is taken: of y in dy/dx, of f′(x)."""
    if each.name == "Derivative":
        return letters_of(each.args[1])
    return letters_of(each.args[0]) if each.name.endswith("prime") and each.args else []


def _is_derivative_of(name: str, node: Node) -> bool:
    prime = not isinstance(node, Number) and node.name.startswith(f"{name}prime")
    return prime or (isinstance(node, Call) and node.name == "Derivative" and letters_of(node.args[0])[:1] == [name])


def _stands_alone(name: str, node: Node) -> bool:
    """Whether a letter stands somewhere but as a factor before a bracket."""
    if isinstance(node, Letter):
        return _stem(node.name) == name
    if not isinstance(node, Call):
        return False
    before = {id(a) for a, b in pairwise(node.args) if node.name == "product" and _is_sum(b)}
    return any(_stands_alone(name, part) for part in node.args if id(part) not in before)


def _is_sum(node: Node) -> bool:
    base = node.args[0] if isinstance(node, Call) and node.name == "power" else node
    return isinstance(base, Call) and base.name == "sum"


def _ordered(node: Node) -> Iterator[tuple[str, str]]:
    """Each two letters that are multiplied, in their order; of what is in a power or a function in both."""
    for each in walk(node):
        if not isinstance(each, Call) or each.name in ("sum", "negative", "quotient", *_LINEAR):
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
