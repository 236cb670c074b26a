"""How a derivation states an equation: the printed lines come from the catalogue, and a script cannot touch them."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError, ProofError
from lagrotor.paper.catalogue import Equation, Line, equation
from lagrotor.paper.form import Form
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
    written: "Form | Mapping[str, Form] | None" = None,
) -> Statement:
    """What the paper prints as `identifier`, from the catalogue, against what was derived under no premise.

    derived: the quantity that the line is about; a mapping, quantity in LaTeX → expression, where it has several. It is
    given without any premise put in. correction: likewise, what should stand there; it is judged against `derived`, which
    may hold quantities besides the printed ones. uses: ids of equations that this one rests on, or their statements, which
    give the letters that are defined there their derived meaning. written: what was derived, as a physicist writes it; a
    correction may be given as a form too. Raises InputError for a quantity that is printed and not derived, or corrected and
    not derived, and for a definition that something is held against; ProofError where a form is not what was derived.
    """
    entry, premises = equation(identifier), tuple(premises)
    quantities = _by_quantity(derived, entry.lines)
    forms = _forms(entry, quantities, written, premises)
    names = bool(entry.lines) and all(line.names for line in entry.lines)
    if names and quantities:
        raise InputError(f"verdict: {identifier} only introduces a letter, and nothing can be held against it")
    uses = tuple(uses)
    meanings = _defined_elsewhere(entry, uses)
    relations = [
        replace(r, **forms.get(line.quantity, {}))
        for line in entry.lines
        if not line.names
        for r in _relations(identifier, line, quantities, meanings)
    ]
    return Statement(
        identifier,
        tuple(relations),
        premises,
        tuple(_corrected(entry, quantities, correction)),
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
    return {name: sp.sympify(value) for name, value in _named(given, lines).items()}


def _named(given: Any, lines: tuple[Line, ...]) -> dict[str, Any]:
    """What is given by quantity; a single one is about the first line."""
    if given is None:
        return {}
    return dict(given) if isinstance(given, Mapping) else {lines[0].quantity if lines else "": given}


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


def _corrected(entry: Equation, quantities: Mapping[str, Side], correction: Any) -> Iterable[Relation]:
    by_name = {line.quantity: line for line in entry.lines}
    for name, given in _named(correction, entry.lines).items():
        if name not in quantities:
            raise InputError(f"verdict: {entry.id}: the correction gives {name}, which was not derived")
        line = by_name.get(name) or next((line for line in entry.lines if line.small is not None), None)
        small, order = (line.small, line.order) if line else (None, 0)
        right, tex = (
            (given.value(entry.declared), given.tex(entry.declared)) if isinstance(given, Form) else (given, "")
        )
        yield Relation(sp.sympify(right), quantities[name], small, order, None, name, written=tex)


def _forms(
    entry: Equation, quantities: Mapping[str, Side], written: Any, premises: tuple[Premise, ...]
) -> dict[str, dict[str, Any]]:
    """quantity → its form in LaTeX, each decided to be what was derived, in general or under the premises."""
    found: dict[str, dict[str, Any]] = {}
    for name, given in _named(written, entry.lines).items():
        if name not in quantities:
            raise InputError(f"verdict: {entry.id}: a form is given for {name}, which was not derived")
        scene = next((line.scene for line in entry.lines if line.quantity == name), {})
        granted = needs_premises(sp.sympify(given.value(entry.declared)), quantities[name], premises, scene)
        if granted is None:
            raise ProofError(f"verdict: {entry.id}: {name} = {given.text} is not what was derived")
        found[name] = {"written": given.tex(entry.declared), "granted": granted}
    return found


def needs_premises(
    value: Side, derived: Side, premises: tuple[Premise, ...], scene: Mapping[sp.Symbol, sp.Expr]
) -> bool | None:
    """Whether a form equals what was derived under the premises only; None where it does not even then."""
    if decide_equal(value, derived).answer == "zero":
        return False
    for premise in premises:
        value, derived = premise.on(value), premise.on(derived)
    return True if decide_equal(value.subs(scene), derived.subs(scene)).answer == "zero" else None
