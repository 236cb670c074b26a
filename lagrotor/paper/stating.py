"""How a derivation states an equation, and how its paper puts the printed lines beside what was derived.

The printed lines come from the catalogue when the statement is judged: a script cannot touch them.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError, ProofError
from lagrotor.paper.catalogue import Catalogue, Equation
from lagrotor.paper.form import Form
from lagrotor.paper.letters import Letters, Line, components
from lagrotor.paper.premises import Premise, written_out
from lagrotor.paper.proof import Formula
from lagrotor.paper.verdicts import Relation, Side, Statement


@dataclass(frozen=True)
class Stated:
    """What a derivation says of the equation `id`, before it is held against the print; the arguments of `verdict`."""

    id: str
    derived: Side | Mapping[str, Side]
    premises: tuple[Premise, ...]
    correction: Side | Mapping[str, Side]
    wrong: str
    uses: tuple["str | Stated", ...]
    evidence: tuple[str, ...]
    written: "Form | Mapping[str, Form] | None" = None

    @property
    def depends_on(self) -> tuple[str, ...]:
        """Ids of the equations that this one uses."""
        return tuple(used if isinstance(used, str) else used.id for used in self.uses)

    def _repr_latex_(self) -> str:
        rows = self.derived.items() if isinstance(self.derived, Mapping) else [("", self.derived)]
        lines = [Formula(sp.sympify(right), name).tex for name, right in rows if right is not None]
        return r"$\displaystyle " + r" \quad ".join([rf"\text{{{self.id}, as derived:}}", *lines]) + "$"


def verdict(
    identifier: str,
    derived: Side | Mapping[str, Side] = None,
    premises: Iterable[Premise] = (),
    correction: Side | Mapping[str, Side] = None,
    wrong: str = "",
    uses: Iterable["str | Stated"] = (),
    evidence: Iterable[str] = (),
    written: "Form | Mapping[str, Form] | None" = None,
) -> Stated:
    """What the paper prints as `identifier` is to be judged against what was derived under no premise.

    derived: the quantity that the line is about; a mapping, quantity in LaTeX → expression, where it has several. It is
    given without any premise put in. correction: likewise, what should be printed; it is judged against `derived`, which
    may hold quantities besides the printed ones. uses: ids of equations that this one rests on, or what was stated of them,
    which gives the letters that are defined there their derived meaning. written: what was derived, as a physicist writes
    it; a correction may be given as a form too. It is checked against the paper when it is judged.
    """
    return Stated(identifier, derived, tuple(premises), correction, wrong, tuple(uses), tuple(evidence), written)


def statement(stated: Stated, catalogue: Catalogue) -> Statement:
    """The printed lines of the catalogue beside what was derived.

    Raises InputError for an equation that the catalogue does not have, a quantity that is printed and not derived, or
    corrected and not derived, and for a definition that something is held against; ProofError where a form is not what was
    derived.
    """
    entry = catalogue.equation(stated.id)
    for other in stated.depends_on:
        catalogue.equation(other)
    lines = catalogue.lines(stated.id)
    derived, letters = _by_quantity(stated.derived, entry), catalogue.letters(entry.section)
    names = bool(lines) and all(line.names for line in lines)
    if names and derived:
        raise InputError(f"verdict: {stated.id} only introduces a letter, and nothing can be held against it")
    if not lines:
        raise InputError(f"verdict: {stated.id} has no printed line to be judged: write it as an [[equation.line]]")
    meanings = _defined_elsewhere(entry, stated, catalogue)
    forms = _forms(entry, lines, derived, stated, letters)
    relations = [
        replace(relation, **forms.get(line.quantity, {}))
        for line in lines
        if not line.names
        for relation in _relations(stated.id, line, derived, meanings, catalogue.written_out)
    ]
    return Statement(
        stated.id,
        tuple(relations),
        stated.premises,
        tuple(_corrected(entry, lines, derived, _named(stated.correction, entry), letters)),
        stated.wrong,
        names,
        entry.measured,
        stated.depends_on,
        stated.evidence,
        entry.title,
    )


def _defined_elsewhere(entry: Equation, stated: Stated, catalogue: Catalogue) -> dict[sp.Symbol, Side]:
    """Letters of a line that another equation defines → what was derived for that one; of vectors, every component."""
    if not entry.refers:
        return {}
    used = {other.id: other for other in stated.uses if isinstance(other, Stated)}
    names = catalogue.letters(entry.section).names
    meanings: dict[sp.Symbol, Side] = {}
    for letter, other in entry.refers.items():
        if other not in used:
            raise InputError(f"verdict: {entry.id}: {letter} is defined in {other}: give its statement among `uses`")
        defining = catalogue.equation(other)
        derived = _by_quantity(used[other].derived, defining)
        quantity = next(line["quantity"] for line in defining.line if not line.get("names"))
        meanings |= zip(components([names[letter]]), components([derived[quantity]]), strict=True)
    return meanings


def _by_quantity(given: Side | Mapping[str, Side], entry: Equation) -> dict[str, Side]:
    return {name: sp.sympify(value) for name, value in _named(given, entry).items()}


def _named(given: Any, entry: Equation) -> dict[str, Any]:
    """What is given by quantity; a single one is about the first line."""
    if given is None:
        return {}
    return dict(given) if isinstance(given, Mapping) else {entry.line[0]["quantity"] if entry.line else "": given}


def _relations(
    identifier: str,
    line: Line,
    quantities: Mapping[str, Side],
    meanings: Mapping[sp.Symbol, Side],
    stands_for: Mapping[sp.Symbol, sp.Expr],
) -> Iterator[Relation]:
    if line.quantity not in quantities:
        raise InputError(
            f"verdict: {identifier} prints {line.quantity}: derive it ({', '.join(quantities) or 'nothing is'})"
        )
    derived = quantities[line.quantity]
    if line.scene:
        derived = written_out(derived, stands_for)
    for member in line.members:
        yield Relation(
            member.xreplace(meanings), derived, line.small, line.order, line.within, line.quantity, line.scene
        )


def _corrected(
    entry: Equation,
    lines: tuple[Line, ...],
    quantities: Mapping[str, Side],
    correction: dict[str, Any],
    letters: Letters,
) -> Iterator[Relation]:
    by_name = {line.quantity: line for line in lines}
    for name, given in correction.items():
        if name not in quantities:
            raise InputError(f"verdict: {entry.id}: the correction gives {name}, which was not derived")
        line = by_name.get(name) or next((line for line in lines if line.small is not None), None)
        small, order = (line.small, line.order) if line else (None, 0)
        right, tex = (given.value(letters), given.tex(letters)) if isinstance(given, Form) else (given, "")
        yield Relation(sp.sympify(right), quantities[name], small, order, None, name, written=tex)


def _forms(
    entry: Equation, lines: tuple[Line, ...], quantities: Mapping[str, Side], stated: Stated, letters: Letters
) -> dict[str, dict[str, Any]]:
    """quantity → its form in LaTeX, each decided to be what was derived, in general or under the premises."""
    found: dict[str, dict[str, Any]] = {}
    for name, given in _named(stated.written, entry).items():
        if name not in quantities:
            raise InputError(f"verdict: {entry.id}: a form is given for {name}, which was not derived")
        scene = next((line.scene for line in lines if line.quantity == name), {})
        granted = needs_premises(sp.sympify(given.value(letters)), quantities[name], stated.premises, scene)
        if granted is None:
            raise ProofError(f"verdict: {entry.id}: {name} = {given.text} is not what was derived")
        found[name] = {"written": given.tex(letters), "granted": granted}
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
