"""How a derivation states an equation, and how its paper puts the printed lines beside what was derived.

The printed lines come from the catalogue when the statement is judged: a script cannot touch them.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError, NotProved, ProofError
from lagrotor.paper.catalogue import Catalogue, Equation
from lagrotor.paper.grammar import Letters, Line, components
from lagrotor.paper.hypotheses import hypotheses
from lagrotor.paper.premises import Premise, with_meanings
from lagrotor.paper.proof import Form, Formula, left_out
from lagrotor.paper.theorems import Theorem, can_prove, verify
from lagrotor.paper.verdicts import Relation, Series, Side, Statement

Proof: TypeAlias = Callable[[], Theorem]


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
    prove: "Proof | Mapping[str, Proof] | None" = None

    @property
    def depends_on(self) -> tuple[str, ...]:
        """Ids of the equations that this one uses."""
        return tuple(used if isinstance(used, str) else used.id for used in self.uses)

    def _repr_latex_(self) -> str:
        rows = self.derived.items() if isinstance(self.derived, Mapping) else [("", self.derived)]
        lines = [Formula(_expression(right), name).tex + _rest(right) for name, right in rows if right is not None]
        return r"$\displaystyle " + r" \quad ".join([rf"\text{{{self.id}, as derived:}}", *lines]) + "$"


def _rest(side: Side) -> str:
    """What is left out of a series, in LaTeX."""
    return left_out(side.small, side.order) if isinstance(side, Series) else ""


def verdict(
    identifier: str,
    derived: Side | Mapping[str, Side] = None,
    premises: Iterable[Premise] = (),
    correction: Side | Mapping[str, Side] = None,
    wrong: str = "",
    uses: Iterable["str | Stated"] = (),
    evidence: Iterable[str] = (),
    written: "Form | Mapping[str, Form] | None" = None,
    prove: "Proof | Mapping[str, Proof] | None" = None,
) -> Stated:
    """What the paper prints as `identifier` is to be judged against what was derived under no premise.

    Parameters
    ----------
    derived : Side or mapping, optional
        The quantity that the line is about; a mapping, quantity in LaTeX → expression, where it has several. It is given
        without any premise put in, as a `Series` where it is known through some order only.
    premises : Iterable[Premise], default ()
        Without which the line does not hold.
    correction : Side or mapping, optional
        Likewise, what should be printed; it is judged against `derived`, which may hold quantities besides the
        printed ones.
    wrong : str, default ''
        What is wrong with the line, in words.
    uses : Iterable['str or Stated'], default ()
        Ids of equations that this one rests on, or what was stated of them, which gives the letters that are defined there
        their derived meaning.
    evidence : Iterable[str], default ()
        Sentences beside the verdict.
    written : Form or Mapping[str, Form] or None, optional
        What was derived, as a physicist writes it; a correction may be given as a form too. It is checked against the
        paper when it is judged.
    prove : Proof or Mapping[str, Proof] or None, optional
        For a number that is read off a run, what proves its bounds, called when it is judged; the theorem decides then.
    """
    return Stated(identifier, derived, tuple(premises), correction, wrong, tuple(uses), tuple(evidence), written, prove)


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
    known = _known(stated.derived, entry)
    forms = _forms(entry, lines, derived, stated, letters)
    theorems, evidence = _theorems(entry, stated)
    relations = [
        replace(
            relation,
            known=known.get(line.quantity),
            theorem=theorems.get(line.quantity),
            **forms.get(line.quantity, {}),
        )
        for line in lines
        if not line.names
        for relation in _relations(stated.id, line, derived, meanings, catalogue.written_out)
    ]
    return Statement(
        stated.id,
        tuple(relations),
        stated.premises,
        tuple(_corrected(entry, lines, derived, known, _named(stated.correction, entry), letters)),
        stated.wrong,
        names,
        entry.measured,
        stated.depends_on,
        (*stated.evidence, *evidence),
        entry.title,
    )


def _theorems(entry: Equation, stated: Stated) -> tuple[dict[str, Theorem], list[str]]:
    """quantity → the theorem that bounds it, without words where it cannot be proved here; what is not proved, in words.

    Raises InputError where a number is not read off a run, ProofError where a certificate is rejected.
    """
    theorems: dict[str, Theorem] = {}
    refusals: list[str] = []
    for name, prove in _named(stated.prove, entry).items():
        if not any(line["quantity"] == name and "read_off" in line for line in entry.line):
            raise InputError(
                f"verdict: {entry.id}: a theorem is given for {name}, which has no number that is read off"
            )
        if not can_prove():
            theorems[name] = Theorem("")
            continue
        try:
            theorem = prove()
        except NotProved as refusal:
            refusals.append(f"Not proved: {refusal}")
            continue
        if theorem.bounds is None:
            raise InputError(f"verdict: {entry.id}: the theorem about {name} has no bounds to hold the number against")
        verify([theorem], entry.id)
        theorems[name] = theorem
    return theorems, refusals


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
    return {name: _expression(value) for name, value in _named(given, entry).items()}


def _expression(side: Side) -> Side:
    return sp.sympify(side.expression if isinstance(side, Series) else side, strict=True)


def _known(given: Side | Mapping[str, Side], entry: Equation) -> dict[str, tuple[sp.Symbol, int]]:
    """Quantities that were derived as series → what is small, and through which order they are known."""
    sides = _named(given, entry).items()
    return {name: (side.small, side.order) for name, side in sides if isinstance(side, Series)}


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
        derived = with_meanings(derived, stands_for)
    for member in line.members:
        yield Relation(
            member.xreplace(meanings), derived, line.small, line.order, line.within, line.quantity, line.scene
        )


def _corrected(
    entry: Equation,
    lines: tuple[Line, ...],
    quantities: Mapping[str, Side],
    known: Mapping[str, tuple[sp.Symbol, int]],
    correction: dict[str, Any],
    letters: Letters,
) -> Iterator[Relation]:
    by_name = {line.quantity: line for line in lines}
    for name, given in correction.items():
        if name not in quantities:
            raise InputError(f"verdict: {entry.id}: the correction gives {name}, which was not derived")
        line = by_name.get(name) or next((line for line in lines if line.small is not None), None)
        small, order = (line.small, line.order) if line else (None, 0)
        if name in known and small is None:
            small, order = known[name]
        right, tex = (
            (given.value(letters), _tex(given, name, known, letters)) if isinstance(given, Form) else (given, "")
        )
        yield Relation(
            _expression(right), quantities[name], small, order, None, name, written=tex, known=known.get(name)
        )


def _forms(
    entry: Equation, lines: tuple[Line, ...], quantities: Mapping[str, Side], stated: Stated, letters: Letters
) -> dict[str, dict[str, Any]]:
    """quantity → its form in LaTeX, each decided to be what was derived, in general or under the premises."""
    forms: dict[str, dict[str, Any]] = {}
    for name, given in _named(stated.written, entry).items():
        if name not in quantities:
            raise InputError(f"verdict: {entry.id}: a form is given for {name}, which was not derived")
        scene = next((line.scene for line in lines if line.quantity == name), {})
        granted = needs_premises(
            sp.sympify(given.value(letters), strict=True), quantities[name], stated.premises, scene
        )
        if granted is None:
            raise ProofError(f"verdict: {entry.id}: {name} = {given.text} is not what was derived")
        tex = _tex(given, name, _known(stated.derived, entry), letters)
        forms[name] = {"written": tex, "granted": granted}
    return forms


def _tex(given: Form, name: str, known: Mapping[str, tuple[sp.Symbol, int]], letters: Letters) -> str:
    """A form as LaTeX, with what is left out where what was derived is a series."""
    return given.tex(letters) + (left_out(*known[name]) if name in known and not given.rest else "")


def needs_premises(
    value: Side, derived: Side, premises: tuple[Premise, ...], scene: Mapping[sp.Symbol, sp.Expr]
) -> bool | None:
    """Whether a form equals what was derived under the premises only; None where it does not even then."""
    if decide_equal(value, derived).answer == "zero":
        return False
    under = hypotheses((*premises, Premise("the values that the text gives", scene)) if scene else premises)
    return True if decide_equal(under.on(value), under.on(derived)).answer == "zero" else None
