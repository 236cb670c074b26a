"""How a derivation states an equation: the printed lines come from the catalogue, and a script cannot touch them."""

from collections.abc import Iterable, Mapping

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.paper.catalogue import Equation, Line, equation
from lagrotor.paper.ledger import Relation, Side, Statement
from lagrotor.paper.letters import components, scalars
from lagrotor.paper.premises import Premise, in_parameters


def verdict(
    identifier: str,
    derived: Side | Mapping[str, Side] = None,
    premises: Iterable[Premise] = (),
    correction: Side | Mapping[str, Side] = None,
    wrong: str = "",
    uses: Iterable["str | Statement"] = (),
    evidence: Iterable[str] = (),
) -> Statement:
    """What the paper prints as `identifier`, from the catalogue, against what was derived under no premise.

    derived: the quantity that the line is about; a mapping, quantity in LaTeX → expression, where it has several. It is
    given without any premise put in. correction: likewise, what should stand there; it is judged against `derived`, which
    may hold quantities besides the printed ones. uses: ids of equations that this one rests on, or their statements, which
    give the letters that are defined there their derived meaning. Raises InputError for a quantity that is printed and not
    derived, or corrected and not derived, and for a definition that something is held against.
    """
    entry = equation(identifier)
    quantities = _by_quantity(derived, entry.lines)
    names = bool(entry.lines) and all(line.names for line in entry.lines)
    if names and quantities:
        raise InputError(f"verdict: {identifier} only introduces a letter, and nothing can be held against it")
    uses = tuple(uses)
    meanings = _defined_elsewhere(entry, uses)
    relations = [
        r for line in entry.lines if not line.names for r in _relations(identifier, line, quantities, meanings)
    ]
    return Statement(
        identifier,
        tuple(relations),
        tuple(premises),
        tuple(_corrected(identifier, entry.lines, quantities, _by_quantity(correction, entry.lines))),
        wrong,
        names,
        entry.measured,
        tuple(used if isinstance(used, str) else used.id for used in uses),
        tuple(evidence),
    )


def _defined_elsewhere(entry: Equation, uses: tuple["str | Statement", ...]) -> dict[sp.Symbol, Side]:
    """Letters of a line that another equation defines → what was derived for that one; of vectors, every component."""
    stated = {used.id: used.relations[0].derived for used in uses if isinstance(used, Statement)}
    names = {**scalars(), **entry.declared}
    meanings: dict[sp.Symbol, Side] = {}
    for letter, other in entry.refers.items():
        if other not in stated:
            raise InputError(f"verdict: {entry.id}: {letter} is defined in {other}: give its statement among `uses`")
        meanings |= zip(components([names[letter]]), components([stated[other]]), strict=True)
    return meanings


def _by_quantity(given: Side | Mapping[str, Side], lines: tuple[Line, ...]) -> dict[str, Side]:
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return {name: sp.sympify(value) for name, value in given.items()}
    return {lines[0].quantity if lines else "": sp.sympify(given)}


def _relations(
    identifier: str, line: Line, quantities: Mapping[str, Side], meanings: Mapping[sp.Symbol, Side]
) -> Iterable[Relation]:
    if line.quantity not in quantities:
        raise InputError(
            f"verdict: {identifier} prints {line.quantity}: derive it ({', '.join(quantities) or 'nothing is'})"
        )
    derived = quantities[line.quantity]
    if line.scene:
        derived = in_parameters(derived)
    for member in line.members:
        printed = member.subs(meanings)
        yield Relation(printed, derived, line.small, line.order, line.within, line.quantity, line.scene)


def _corrected(
    identifier: str, lines: tuple[Line, ...], quantities: Mapping[str, Side], correction: Mapping[str, Side]
) -> Iterable[Relation]:
    by_name = {line.quantity: line for line in lines}
    for name, right in correction.items():
        if name not in quantities:
            raise InputError(f"verdict: {identifier}: the correction gives {name}, which was not derived")
        line = by_name.get(name) or next((line for line in lines if line.small is not None), None)
        small, order = (line.small, line.order) if line else (None, 0)
        yield Relation(right, quantities[name], small, order, None, name)
