"""Whether the equations of a source agree with one another: dimensions; letters that are defined twice, or used before."""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from lagrotor.paper.latex.dimensions import FormulaDimensions
from lagrotor.paper.latex.displays import Displayed
from lagrotor.paper.latex.statements import PrintedStatement
from lagrotor.paper.latex.tree import Letter, Node, Number, letters_of, walk
from lagrotor.paper.latex.usage import Notation, notation_of
from lagrotor.paper.latex.words_beside import gives_a_meaning

UNITS, MEANINGS, BEFORE = "dimensions differ", "two meanings", "used before it is given"
# Formulas of the text that give a value: with a unit, or in units where it is 1.
VALUED = re.compile(r"\\(?:mathrm|rm|text|hbar)\b|k_")


@dataclass(frozen=True)
class ReadStatement:
    """One statement of an equation."""

    equation: Displayed
    statement: PrintedStatement


def other_dimensions(
    statements: Iterable[ReadStatement], values: Iterable[tuple[str, list[Node]]], words: Mapping[str, str]
) -> Iterator[tuple[Displayed, str]]:
    """Equations whose dimensions contradict those of the others, and how.

    They are known where the paper prints units, of displays or in the text. A letter that several equations need otherwise
    than the rest has another meaning there: of these only what contradicts its own section is reported.

    values: sections, and sides of what the text gives a value, m = 2 kg; words: beside each equation.
    """
    printed = [r for r in statements if r.statement.kind in ("equation", "approximation", "inequality")]
    held: list[tuple[str, list[Node], ReadStatement | None]] = [(section, sides, None) for section, sides in values]
    held += [(read.equation.section, _without_values(read.statement), read) for read in printed]
    numbers = {
        side.name
        for _, sides, _ in held
        if any(isinstance(side, Number) for side in sides)
        for side in sides
        if isinstance(side, Letter)
    }
    whole = FormulaDimensions(numbers)
    sections: defaultdict[str, FormulaDimensions] = defaultdict(lambda: FormulaDimensions(numbers))
    broken: list[tuple[ReadStatement, str, bool]] = []
    for section, sides, read in held:
        near = sections[section.split(".")[0]].add(sides) is not None
        why = whole.add(sides)
        if why is not None and read is not None:
            broken.append((read, why, near))
    letters = Counter(name for read, _, _ in broken for name in statement_letters(read.statement))
    for read, why, near in broken:
        alone = all(letters[name] == 1 for name in statement_letters(read.statement))
        if near or (alone and not gives_a_meaning(words.get(read.equation.id, ""))):
            yield read.equation, why


def other_letters(
    statements: Sequence[ReadStatement], differ: Callable[[ReadStatement, ReadStatement], bool]
) -> Iterator[tuple[Displayed, str, str]]:
    """Letters that are defined twice or used before they are given: the equation, which of both, and why.

    differ: whether two definitions do, the other one first.
    """
    definitions: dict[str, tuple[int, ReadStatement]] = {}
    for place, read in enumerate(statements):
        first = read.statement.sides[0].node
        if not isinstance(first, Letter) or ":=" not in read.statement.relations[:1]:
            continue
        if first.name in definitions:
            _, other = definitions[first.name]
            if differ(other, read):
                yield read.equation, MEANINGS, f"{first.name} is defined in ({other.equation.id}) otherwise"
            continue
        definitions[first.name] = place, read
    # by letter and chapter, the first use: in another chapter a letter may have another meaning
    used: dict[tuple[str, str], tuple[int, ReadStatement]] = {}
    for place, read in enumerate(statements):
        for name in statement_letters(read.statement):
            used.setdefault((name, read.equation.section.split(".")[0]), (place, read))
    for name, (place, read) in definitions.items():
        first_use, user = used[name, read.equation.section.split(".")[0]]
        if first_use < place and user.equation.id != read.equation.id:
            yield user.equation, BEFORE, f"{name} is given in ({read.equation.id})"


def two_meanings_of_e(equations: Sequence[Displayed], notation: Notation) -> Iterator[tuple[Displayed, str, str]]:
    """Where e is a letter, and elsewhere the base of exponentials."""
    if not (notation.exponential and "e" in notation.bare):
        return
    own = [(each, notation_of([each.latex], Notation(made=notation.made))) for each in equations]
    letter = [each for each, seen in own if "e" in seen.bare]  # none: e is a letter in the text alone
    places = [*letter, *(each for each, seen in own if seen.exponential), equations[0]]
    yield places[0], MEANINGS, "e is a letter and the base of exponentials"


def statement_letters(statement: PrintedStatement) -> set[str]:
    """The letters of all its sides."""
    return {name for side in statement.sides for name in letters_of(side.node)}


def _without_values(statement: PrintedStatement) -> list[Node]:
    """Its sides, but those behind a ≈ with a number that the side before has not: it may be a quantity without its unit."""
    nodes = [side.node for side in statement.sides]
    numbers = [{each for each in walk(node) if isinstance(each, Number)} for node in nodes]
    pairs = zip(statement.relations, numbers, numbers[1:], nodes[1:], strict=False)
    return [nodes[0], *(node for relation, before, own, node in pairs if relation != "~" or own <= before)]
