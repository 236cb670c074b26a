"""What the text gives before a step: letters and unknown functions by what stands for them, to be put into the two sides."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from lagrotor.paper.latex.boxes import GREEK
from lagrotor.paper.latex.statements import PrintedStatement
from lagrotor.paper.latex.tree import KNOWN, Call, Letter, Node, Number, is_vector, letters_of, product_of, walk

_MEMORY = 60  # displays back to which a step may refer
_MOST_ROUNDS = 4  # of putting in: what stands for a letter may have letters that others stand for
_ARITHMETIC = ("sum", "product", "quotient", "power", "negative", "norm", "dot", "cross", "column", "matrix")
# Operations whose second part is a letter that they use up.
BINDING = ("Derivative", "Integral", "Sum", "Product", "at", "limit")


@dataclass(frozen=True)
class PrintedMeaning:
    """What stands for a letter or an unknown function, and the print that gives it.

    name: the equation, (3), or the formula of the text; place: of the display; -1: of the text.
    """

    meaning: Node
    value: Node
    name: str
    section: str
    place: int
    statement: PrintedStatement

    @property
    def is_a_root(self) -> bool:
        """Whether its sign is taken and not printed: of x by x² = y."""
        return (
            self.value != self.statement.sides[-1].node and isinstance(self.value, Call) and self.value.name == "sqrt"
        )


@dataclass
class SectionMeanings:
    """The premises before a place, by what they give; `unread`: sections and letters that an unread display may give.

    negative: letters that are no positive root.
    """

    known: defaultdict[Node, list[PrintedMeaning]] = field(default_factory=lambda: defaultdict(list))
    functions: defaultdict[str, list[PrintedMeaning]] = field(default_factory=lambda: defaultdict(list))
    unread: set[tuple[str, str]] = field(default_factory=set)
    negative: frozenset[str] = frozenset()

    def add(self, statement: PrintedStatement, name: str, section: str, place: int) -> None:
        """Take over what an equation gives: its left side by each other one, the last first."""
        first, *others = statement.sides
        if statement.kind != "equation":
            return
        for side in reversed(others):
            worded = isinstance(side.node, Letter) and r"\text" in side.latex
            if worded or is_vector(first.node) != is_vector(side.node):
                continue
            for meaning, value in _values(first.node, side.node):
                is_negative = isinstance(meaning, Letter) and meaning.name in self.negative
                if meaning not in walk(value) and not (is_negative and value != side.node):
                    made = PrintedMeaning(meaning, value, name, section, place, statement)
                    self.known[meaning].append(made)
                    if isinstance(meaning, Call) and _is_of_a_letter(meaning.name):
                        self.functions[meaning.name].append(made)

    def of(self, parts: Iterable[Node], place: int, section: str, but: PrintedStatement) -> Iterator[PrintedMeaning]:
        """Yield for each part the last premise that is none of a statement itself, one of its section first."""
        for part in parts:
            near = [each for each in self._given(part, but) if each.place >= place - _MEMORY or each.section == section]
            if near:
                yield max(near, key=lambda each: (each.section == section, each.place))

    def _given(self, part: Node, but: PrintedStatement) -> list[PrintedMeaning]:
        """Return what equations but a statement itself give for a part, or else for the function that it is."""
        near = [each for each in self.known.get(part, ()) if each.statement is not but]
        return near or [each for each in self._called(part) if each.statement is not but]

    def _called(self, part: Node) -> Iterator[PrintedMeaning]:
        """Yield what a function, or its derivative by a prime, is at another place of its letters: V(r_0), V(0)."""
        if not isinstance(part, Call):
            return
        name = part.name.removesuffix("prime").removesuffix("prime")
        order = (len(part.name) - len(name)) // len("prime")
        for each in self.functions.get(name, ()):
            of, value = each.meaning.args if isinstance(each.meaning, Call) else (), each.value
            if len(of) != len(part.args) or (order and len(of) > 1) or not all(map(_is_place_of, part.args, of)):
                continue
            for _ in range(order):
                value = Call("Derivative", (value, of[0]))
            if part.args != of and order:
                value = Call("at", (value, *of, *part.args))
            yield replace(
                each, meaning=part, value=put_for(value, {} if order else dict(zip(of, part.args, strict=True)))
            )

    def is_called(self, node: Node, but: PrintedStatement) -> bool:
        """Return whether a node is a function at another place than the one that is printed, or its derivative by a prime."""
        return any(each not in self.known.get(node, ()) for each in self._given(node, but))

    def is_given_once(self, premise: PrintedMeaning, but: PrintedStatement) -> bool:
        """Return whether no equation of its section but a statement itself gives anything else for the same."""
        near = [each for each in self._given(premise.meaning, but) if each.section == premise.section]
        values = {each.value for each in near if each.statement is premise.statement}
        stems = {name.split("_")[0] for name in letters_of(premise.meaning)[:1]}
        unread = any((premise.section, stem) in self.unread for stem in stems)
        return not unread and all(each.value in values for each in near)


def _values(left: Node, right: Node) -> Iterator[tuple[Node, Node]]:
    """Yield what a side gives, and its value: itself, its rates; the rate or derivative of which a product is made."""
    if isinstance(left, Letter):
        yield left, right
        if not left.vector and isinstance(right, Call):
            once = Call("rate", (right,))
            yield Letter(f"{left.name}_dot"), once
            yield Letter(f"{left.name}_ddot"), Call("rate", (once,))
    elif isinstance(left, Call) and left.name == "product" and not is_vector(left):
        yield left, right
        moving = [each for each in left.args if _is_rate(each)]
        if len(moving) == 1:  # m d²x/dt² = F
            yield (
                moving[0],
                Call("quotient", (right, product_of([each for each in left.args if each is not moving[0]]))),
            )
    elif isinstance(left, Call) and left.name == "power" and _is_meaning(left.args[0]):
        yield left, right
        if left.args[1] == Number(Fraction(2)):
            yield left.args[0], Call("sqrt", (right,))
    elif isinstance(left, Call) and _is_meaning(left):
        yield left, right
        if all(isinstance(each, Letter) for each in left.args):
            yield Letter(left.name), right  # H(p, q) = …, where H alone is meant as well


def _is_of_a_letter(name: str) -> bool:
    """Return whether a function has a letter for its name, and is no operation such as a mean."""
    stem = name.split("_")[0]
    return len(stem) == 1 or (rf"\{stem}" in GREEK and stem.lower() != "delta")


def _is_place_of(node: Node, letter: Node) -> bool:
    """Return whether an argument is a place of a letter; V(x) beside V(r), or V in other coordinates, is another function."""
    stem = letter.name.split("_")[0] if isinstance(letter, Letter) else ""
    return not letters_of(node) or stem in {name.split("_")[0] for name in letters_of(node)}


def _is_rate(node: Node) -> bool:
    return (
        node.name.endswith("dot") if isinstance(node, Letter) else isinstance(node, Call) and node.name == "Derivative"
    )


def _is_meaning(node: Node) -> bool:
    """Return whether an equation may give a node: a letter, an unknown function, a derivative, tan δ or |Z| of a letter alone."""
    if not isinstance(node, Call):
        return isinstance(node, Letter)
    known = node.name in KNOWN and not isinstance(node.args[0], Letter)
    return node.name not in _ARITHMETIC and not known and bool(letters_of(node))


def _free(node: Node, bound: tuple[Node, ...] = ()) -> Iterator[Node]:
    """Yield the node and its parts, but for what derivatives and integrals in it use up."""
    if node not in bound:
        yield node
    if isinstance(node, Call):
        binding = node.name in BINDING and len(node.args) > 1
        for place, part in enumerate(node.args):
            if not (binding and place == 1):
                yield from _free(part, (*bound, node.args[1]) if binding and place == 0 else bound)


def put_for(node: Node, values: Mapping[Node, Node]) -> Node:
    """Return a node with parts replaced; not the variable of a derivative or an integral, nor what that variable is in it."""
    if node in values:
        return values[node]
    if not isinstance(node, Call) or not values:
        return node
    if node.name in BINDING and len(node.args) > 1:
        inner, variable, *ends = node.args
        free = {key: value for key, value in values.items() if key != variable}
        return Call(node.name, (put_for(inner, free), variable, *(put_for(each, values) for each in ends)))
    return Call(node.name, tuple(put_for(each, values) for each in node.args))


def put_rounds(node: Node, put: Iterable[dict[Node, PrintedMeaning]]) -> Node:
    """Return the node with premises put in, round by round."""
    for one in put:
        node = put_for(node, {key: each.value for key, each in one.items()})
    return node


def rounds(
    sides: Sequence[Node], premises: Callable[[Iterable[Node]], Iterator[PrintedMeaning]], constant_side: int | None
) -> list[dict[Node, PrintedMeaning]]:
    """Return what is put into two sides, round by round.

    Parameters
    ----------
    sides : sequence of Node
        The two sides.
    premises : callable
        Called with parts of the sides; returns the premise for each of them that has one.
    constant_side : int, optional
        The place of the side whose letters stay: x = f(y) and y = g(x) put into both sides would exchange x and y.
    """
    put: list[dict[Node, PrintedMeaning]] = []
    above: defaultdict[Node, set[Node]] = defaultdict(
        set
    )  # part → the parts in whose values it stands: x by y by x has no end
    for _ in range(_MOST_ROUNDS):
        stay = set() if constant_side is None else {*_free(sides[constant_side])}
        parts = dict.fromkeys(part for side in sides for part in _free(side) if part not in stay)
        new = {each.meaning: each for each in premises(parts) if each.meaning not in above[each.meaning]}
        if not new:
            break
        for square in [part for part in new if isinstance(part, Call) and part.name == "power"]:
            new.pop(square.args[0], None)  # by ω² = g/l no root is put in for ω in ω²
        for meaning, each in new.items():
            for part in walk(each.value):
                above[part] |= {meaning, *above[meaning]}
        put.append(new)
        sides = [put_rounds(side, [new]) for side in sides]
    return put
