"""Statements that a derivation makes about equations, and their combination with the printed lines.

The printed lines are read from the catalogue when the statement is judged, so that a script cannot change them.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy as sp

from lagrotor.algebra.identity import are_equal
from lagrotor.errors import InputError, NotProved, ProofError
from lagrotor.paper.catalogue import Catalogue, Equation
from lagrotor.paper.grammar import Letters, Line, components
from lagrotor.paper.hypotheses import hypotheses
from lagrotor.paper.premises import Premise, with_meanings
from lagrotor.paper.proof import Form, Formula, left_out
from lagrotor.paper.theorems import Theorem, can_prove, verify
from lagrotor.paper.verdicts import Relation, Series, Side, Statement
from lagrotor.renamed import accept_old_keywords, old_attribute

Proof: TypeAlias = Callable[[], Theorem]


@dataclass(frozen=True)
class Stated:
    """The statement of a derivation about an equation. `verdict` returns it; it is compared with the print later.

    Attributes
    ----------
    id : str
        The equation's id.
    derived : Any
        The derived side. If the equation gives several quantities, a mapping: quantity in LaTeX → side.
    premises : tuple[Premise, ...]
        The premises that the line needs.
    correction : Any
        The side that should be printed, or a mapping: quantity in LaTeX → side.
    wrong : str
        The error of the printed line in one sentence.
    uses : tuple[str or Stated, ...]
        The equations that this one uses.
    evidence : tuple[str, ...]
        Sentences with computed numbers.
    form : Form or Mapping[str, Form] or None, optional
        The derived side as a physicist writes it.
    prove : Callable or Mapping[str, Callable] or None, optional
        A function that proves bounds of a number that the paper read off a simulation.
    """

    id: str
    derived: Side | Mapping[str, Side]
    premises: tuple[Premise, ...]
    correction: Side | Mapping[str, Side]
    wrong: str
    uses: tuple["str | Stated", ...]
    evidence: tuple[str, ...]
    form: "Form | Mapping[str, Form] | None" = None
    prove: "Proof | Mapping[str, Proof] | None" = None

    if not TYPE_CHECKING:
        __getattr__ = old_attribute

    @property
    def depends_on(self) -> tuple[str, ...]:
        """The ids of the equations that this one uses."""
        return tuple(used if isinstance(used, str) else used.id for used in self.uses)

    def _repr_latex_(self) -> str:
        rows = self.derived.items() if isinstance(self.derived, Mapping) else [("", self.derived)]
        lines = [Formula(_expression(right), name).tex + _remainder(right) for name, right in rows if right is not None]
        return r"$\displaystyle " + r" \quad ".join([rf"\text{{{self.id}, as derived:}}", *lines]) + "$"


def _remainder(side: Side) -> str:
    """Return the LaTeX of a series' omitted terms, + O(…); empty if the side is not a series."""
    return left_out(side.small, side.order) if isinstance(side, Series) else ""


@accept_old_keywords
def verdict(
    identifier: str,
    derived: Side | Mapping[str, Side] = None,
    premises: Iterable[Premise] = (),
    correction: Side | Mapping[str, Side] = None,
    wrong: str = "",
    uses: Iterable["str | Stated"] = (),
    evidence: Iterable[str] = (),
    form: "Form | Mapping[str, Form] | None" = None,
    prove: "Proof | Mapping[str, Proof] | None" = None,
) -> Stated:
    """State the derived side of an equation. The ledger later compares it with the printed line.

    Parameters
    ----------
    identifier : str
        The equation's id in the catalogue.
    derived : Side or Mapping[str, Side], optional
        The derived side, in which no premise is substituted. For several quantities, a mapping: quantity in LaTeX →
        side. A side that is known through some order only is a `Series`.
    premises : Iterable[Premise], default ()
        The premises that the line needs.
    correction : Side or Mapping[str, Side], optional
        The side that should be printed, as an expression or a `Form`; it is judged against `derived`.
    wrong : str, default ''
        The error of the printed line in one sentence.
    uses : Iterable[str or Stated], default ()
        Ids or statements of the equations that this one uses. If such an equation defines a symbol, its statement gives
        the symbol's derived meaning.
    evidence : Iterable[str], default ()
        Sentences shown beside the verdict.
    form : Form or Mapping[str, Form] or None, optional
        The derived side as a physicist writes it; the ledger checks that it is equal to `derived`.
    prove : Callable or Mapping[str, Callable] or None, optional
        For a number read off a simulation, a function that proves bounds of it and returns the theorem, which decides.

    Returns
    -------
    Stated
        The statement; a derivation shows it as the last expression of a cell.

    Examples
    --------
    >>> verdict("2.01", sp.Symbol("F"), uses=["2.02"]).depends_on
    ('2.02',)
    """
    return Stated(identifier, derived, tuple(premises), correction, wrong, tuple(uses), tuple(evidence), form, prove)


def statement(assertion: Stated, catalogue: Catalogue) -> Statement:
    """Combine the derived sides of an equation with its printed lines in the catalogue; raise an error if they do not fit."""
    entry = catalogue.equation(assertion.id)
    for used in assertion.depends_on:
        catalogue.equation(used)
    lines = catalogue.lines(assertion.id)
    derived, letters = _expressions(assertion.derived, entry), catalogue.letters(entry.section)
    names = bool(lines) and all(line.names for line in lines)
    if names and derived:
        raise InputError(
            f"verdict: {assertion.id} only introduces a symbol, so that there is nothing to compare: omit `derived`"
        )
    if not lines:
        raise InputError(f"verdict: {assertion.id} has no printed line to be judged: write it as an [[equation.line]]")
    meanings = _referred_meanings(entry, assertion, catalogue)
    known_orders = _known_orders(assertion.derived, entry)
    forms = _forms(entry, lines, derived, assertion, letters)
    theorems, evidence = _theorems(entry, assertion)
    relations = [
        replace(
            relation,
            known=known_orders.get(line.quantity),
            theorem=theorems.get(line.quantity),
            **forms.get(line.quantity, {}),
        )
        for line in lines
        if not line.names
        for relation in _relations(assertion.id, line, derived, meanings, catalogue.written_out)
    ]
    return Statement(
        assertion.id,
        tuple(relations),
        assertion.premises,
        tuple(_corrections(entry, lines, derived, known_orders, _by_quantity(assertion.correction, entry), letters)),
        assertion.wrong,
        names,
        entry.measured,
        assertion.depends_on,
        (*assertion.evidence, *evidence),
        entry.title,
    )


def _theorems(entry: Equation, assertion: Stated) -> tuple[dict[str, Theorem], list[str]]:
    """Return quantity → its theorem, and a sentence for each failed proof. Theorems are empty without python-flint."""
    theorems: dict[str, Theorem] = {}
    refusals: list[str] = []
    for name, prove in _by_quantity(assertion.prove, entry).items():
        if not any(line["quantity"] == name and "read_off" in line for line in entry.line):
            raise InputError(
                f"verdict: {entry.id}: a theorem is given for {name}, which has no number that is read off: omit `prove`"
            )
        if not can_prove():
            theorems[name] = Theorem("")
            continue
        try:
            theorem = prove()
        except NotProved as refusal:
            refusals.append(f"The proof failed: {refusal}")
            continue
        if theorem.bounds is None:
            raise InputError(
                f"verdict: {entry.id}: the theorem about {name} has no bounds: name its quantity in `Theorem.of`"
            )
        verify([theorem], entry.id)
        theorems[name] = theorem
    return theorems, refusals


def _referred_meanings(entry: Equation, assertion: Stated, catalogue: Catalogue) -> dict[sp.Symbol, Side]:
    """Return symbol → derived side, for the symbols that another equation defines. Vectors are given by their components."""
    if not entry.refers:
        return {}
    used = {source.id: source for source in assertion.uses if isinstance(source, Stated)}
    names = catalogue.letters(entry.section).names
    meanings: dict[sp.Symbol, Side] = {}
    for letter, source in entry.refers.items():
        if source not in used:
            raise InputError(f"verdict: {entry.id}: {letter} is defined in {source}: give its statement among `uses`")
        defining = catalogue.equation(source)
        derived = _expressions(used[source].derived, defining)
        quantity = next(line["quantity"] for line in defining.line if not line.get("names"))
        meanings |= zip(components([names[letter]]), components([derived[quantity]]), strict=True)
    return meanings


def _expressions(sides: Side | Mapping[str, Side], entry: Equation) -> dict[str, Side]:
    return {name: _expression(value) for name, value in _by_quantity(sides, entry).items()}


def _expression(side: Side) -> Side:
    return sp.sympify(side.expression if isinstance(side, Series) else side, strict=True)


def _known_orders(derived: Side | Mapping[str, Side], entry: Equation) -> dict[str, tuple[sp.Symbol, int]]:
    """Return quantity → (variable, highest known order), for the derived sides that are series."""
    sides = _by_quantity(derived, entry).items()
    return {name: (side.small, side.order) for name, side in sides if isinstance(side, Series)}


def _by_quantity(value: Any, entry: Equation) -> dict[str, Any]:
    """Return a mapping of quantities to values. A single value belongs to the quantity of the first line."""
    if value is None:
        return {}
    return dict(value) if isinstance(value, Mapping) else {entry.line[0]["quantity"] if entry.line else "": value}


def _relations(
    identifier: str,
    line: Line,
    quantities: Mapping[str, Side],
    meanings: Mapping[sp.Symbol, Side],
    stands_for: Mapping[sp.Symbol, sp.Expr],
) -> Iterator[Relation]:
    if line.quantity not in quantities:
        raise InputError(
            f"verdict: {identifier} prints {line.quantity}: derive it, besides {', '.join(quantities) or 'nothing'}"
        )
    derived = quantities[line.quantity]
    if line.scene:
        derived = with_meanings(derived, stands_for)
    for member in line.members:
        yield Relation(
            member.xreplace(meanings), derived, line.small, line.order, line.within, line.quantity, line.scene
        )


def _corrections(
    entry: Equation,
    lines: tuple[Line, ...],
    quantities: Mapping[str, Side],
    known_orders: Mapping[str, tuple[sp.Symbol, int]],
    correction: dict[str, Any],
    letters: Letters,
) -> Iterator[Relation]:
    by_name = {line.quantity: line for line in lines}
    for name, value in correction.items():
        if name not in quantities:
            raise InputError(
                f"verdict: {entry.id}: the correction gives {name}, which was not derived: add it to `derived`"
            )
        line = by_name.get(name) or next((line for line in lines if line.small is not None), None)
        small, order = (line.small, line.order) if line else (None, 0)
        if name in known_orders and small is None:
            small, order = known_orders[name]
        right, tex = (
            (value.value(letters), _tex(value, name, known_orders, letters)) if isinstance(value, Form) else (value, "")
        )
        yield Relation(
            _expression(right), quantities[name], small, order, None, name, written=tex, known=known_orders.get(name)
        )


def _forms(
    entry: Equation, lines: tuple[Line, ...], quantities: Mapping[str, Side], assertion: Stated, letters: Letters
) -> dict[str, dict[str, Any]]:
    """Return quantity → the form's LaTeX and if it needs premises; raise ProofError if it is not the derived side."""
    forms: dict[str, dict[str, Any]] = {}
    for name, form in _by_quantity(assertion.form, entry).items():
        if name not in quantities:
            raise InputError(
                f"verdict: {entry.id}: a form is given for {name}, which was not derived: add it to `derived`"
            )
        scene = next((line.scene for line in lines if line.quantity == name), {})
        granted = needs_premises(
            sp.sympify(form.value(letters), strict=True), quantities[name], assertion.premises, scene
        )
        if granted is None:
            raise ProofError(f"verdict: {entry.id}: the form {name} = {form.text} is not what was derived")
        tex = _tex(form, name, _known_orders(assertion.derived, entry), letters)
        forms[name] = {"written": tex, "granted": granted}
    return forms


def _tex(form: Form, name: str, known_orders: Mapping[str, tuple[sp.Symbol, int]], letters: Letters) -> str:
    """Return a form as LaTeX. If the derived side is a series, + O(…) is appended."""
    return form.tex(letters) + (left_out(*known_orders[name]) if name in known_orders and not form.remainder else "")


def needs_premises(
    value: Side, derived: Side, premises: tuple[Premise, ...], scene: Mapping[sp.Symbol, sp.Expr]
) -> bool | None:
    """Return False if a form is equal to the derived side, True if it is so only under the premises, and None otherwise."""
    if are_equal(value, derived):
        return False
    under = hypotheses((*premises, Premise("the values that the text gives", scene)) if scene else premises)
    return True if are_equal(under.on(value), under.on(derived)) else None
