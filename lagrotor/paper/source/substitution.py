"""What the text gives before a step: letters and unknown functions by what stands for them, to be put into the two sides."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from lagrotor.paper.source.read_statements import PrintedStatement
from lagrotor.paper.source.tree import KNOWN, Call, Letter, Node, is_vector, letters_of, walk

_MEMORY = 60  # displays back to which a step may refer
_MOST_ROUNDS = 4  # of putting in: what stands for a letter may have letters that others stand for
_ARITHMETIC = ("sum", "product", "quotient", "power", "negative", "norm", "dot", "cross", "column", "matrix")
_BINDING = ("Derivative", "Integral", "Sum", "at", "limit")  # their second part is a letter that they use up


@dataclass(frozen=True)
class PrintedMeaning:
    """What stands for a letter or an unknown function, and the print that gives it.

    name: the equation, (3), or the formula of the text; latex: of the two sides; place: of the display; -1: of the text.
    """

    meaning: Node
    value: Node
    name: str
    latex: str
    section: str
    place: int
    statement: PrintedStatement


@dataclass
class SectionMeanings:
    """The premises before a place, by what they give."""

    known: defaultdict[Node, list[PrintedMeaning]] = field(default_factory=lambda: defaultdict(list))

    def add(self, statement: PrintedStatement, name: str, section: str, place: int) -> None:
        """Take over what an equation gives: its left side by each other one, the last first."""
        first, *others = statement.sides
        if statement.kind != "equation" or not _is_meaning(first.node):
            return
        meanings = [first.node]
        if isinstance(first.node, Call) and all(isinstance(each, Letter) for each in first.node.args):
            meanings.append(Letter(first.node.name))  # H(p, q) = …, where H alone is meant as well
        for side in reversed(others):
            worded = isinstance(side.node, Letter) and r"\text" in side.latex
            if worded or is_vector(first.node) != is_vector(side.node) or _holds(side.node, first.node):
                continue
            latex = f"{first.latex} = {side.latex}"
            values = dict.fromkeys(meanings, side.node)
            if isinstance(first.node, Letter) and not first.node.vector and isinstance(side.node, Call):
                once = Call("rate", (side.node,))
                values |= {
                    Letter(f"{first.node.name}_dot"): once,
                    Letter(f"{first.node.name}_ddot"): Call("rate", (once,)),
                }
            for meaning, value in values.items():
                self.known[meaning].append(PrintedMeaning(meaning, value, name, latex, section, place, statement))

    def of(self, parts: Iterable[Node], place: int, section: str, but: PrintedStatement) -> Iterator[PrintedMeaning]:
        """For each part that something stands for, the last premise but of a statement itself, of its section first."""
        for part in parts:
            near = [
                each
                for each in self.known.get(part, ())
                if each.statement is not but and (each.place >= place - _MEMORY or each.section == section)
            ]
            if near:
                yield max(near, key=lambda each: (each.section == section, each.place))

    def is_given_once(self, premise: PrintedMeaning) -> bool:
        """Whether no other equation of its section gives anything else for the same."""
        near = [each for each in self.known[premise.meaning] if each.section == premise.section]
        own = {each.value for each in near if each.statement is premise.statement}
        return all(each.value in own for each in near)


def _is_meaning(node: Node) -> bool:
    """Whether something can stand for a node: a letter, an unknown function or a derivative."""
    return isinstance(node, Letter) or (
        isinstance(node, Call) and node.name not in _ARITHMETIC and node.name not in KNOWN and bool(letters_of(node))
    )


def _holds(node: Node, part: Node) -> bool:
    return any(each == part for each in walk(node))


def _free(node: Node, bound: tuple[Node, ...] = ()) -> Iterator[Node]:
    """The node and its parts, but for what derivatives and integrals in it use up."""
    if node not in bound:
        yield node
    if isinstance(node, Call):
        binding = node.name in _BINDING and len(node.args) > 1
        for place, part in enumerate(node.args):
            if not (binding and place == 1):
                yield from _free(part, (*bound, node.args[1]) if binding and place == 0 else bound)


def put_for(node: Node, values: Mapping[Node, Node]) -> Node:
    """A node with parts replaced; not the variable of a derivative or an integral, nor what that variable is in it."""
    if node in values:
        return values[node]
    if not isinstance(node, Call) or not values:
        return node
    if node.name in _BINDING and len(node.args) > 1:
        inner = {key: value for key, value in values.items() if key != node.args[1]}
        return Call(
            node.name, (put_for(node.args[0], inner), node.args[1], *(put_for(each, values) for each in node.args[2:]))
        )
    return Call(node.name, tuple(put_for(each, values) for each in node.args))


def rounds(
    left: Node, right: Node, premises: Callable[[Iterable[Node]], Iterator[PrintedMeaning]], both: bool
) -> list[dict[Node, PrintedMeaning]]:
    """What is put into two sides, round by round; each part once: x by y and y by x would go on without end.

    both: also what the two sides share.
    """
    put: list[dict[Node, PrintedMeaning]] = []
    done: set[Node] = set()
    for _ in range(_MOST_ROUNDS):
        parts = [dict.fromkeys(_free(side)) for side in (left, right)]
        wanted = [each for each in {**parts[0], **parts[1]} if both or not (each in parts[0] and each in parts[1])]
        new = {each.meaning: each for each in premises(wanted) if each.meaning not in done}
        if not new:
            break
        done |= new.keys()
        put.append(new)
        left, right = (put_for(side, {key: each.value for key, each in new.items()}) for side in (left, right))
    return put
