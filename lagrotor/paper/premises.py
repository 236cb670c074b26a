"""Premises: the assumptions under which an equation is judged, in words and as relations."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.relational import Relational

from lagrotor.algebra.scalar import sympified
from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.plain_text import readable
from lagrotor.renamed import accept_old_keywords
from lagrotor.result_display import Printed

_LONGEST = 160  # characters; a longer formula is shown as data only
_SIGNS = {sp.Eq: "=", sp.Ne: "≠", sp.Ge: "≥", sp.Gt: ">", sp.Le: "≤", sp.Lt: "<"}


@dataclass(frozen=True)
class Premise(Printed):
    """An assumption, in words and as equations and inequalities.

    Attributes
    ----------
    says : str
        The assumption in a physicist's words.
    put : Mapping[Basic, Any], default {}
        The equations of the assumption as a substitution, old → new.
    small : Symbol or None, optional
        For an approximation, the small quantity; only leading terms in it are compared. `put` introduces it. In a row
        x → small·x, the x on the right stands for x/small.
    broken : str, default ''
        How far the paper's own scene violates the assumption, in words; empty if the scene satisfies it.
    where : tuple[Relational, ...], default ()
        Further relations: Eq, Ne, Ge, Gt, Le, Lt.
    defines : bool, default False
        True if the premise only defines a printed symbol. An equation that repeats such a premise is not circular.

    Examples
    --------
    >>> from sympy import symbols
    >>> ell, R = symbols("ell R", positive=True)
    >>> premise = Premise("the bar is as long as the arms", {ell: R})
    >>> premise.with_formula, premise.on(ell**2 - R * ell)
    ('the bar is as long as the arms: ℓ = R', 0)
    """

    _shown = (("premise", "with_formula"), ("not met by the paper's own scene", "broken"))

    says: str
    put: Mapping[sp.Basic, Any] = field(default_factory=dict)
    small: sp.Symbol | None = None
    broken: str = ""
    where: tuple[Relational, ...] = ()
    defines: bool = False

    def __post_init__(self) -> None:
        for side in (expression for row in self.put.items() for expression in row):
            sympified(side, f"premise {self.says!r}")
        for relation in self.where:
            if not isinstance(relation, Relational):
                raise InputError(
                    f"premise {self.says!r}: {relation!r} is not a relation: write Eq(a, b), Ne(a, b) or a >= b"
                )

    @property
    def sentence(self) -> str:
        """The assumption in words, followed by how far the paper's own scene violates it."""
        return self.says + self._breach

    @property
    def _breach(self) -> str:
        return f" (not met by the paper's own scene: {self.broken})" if self.broken else ""

    @property
    def equations(self) -> tuple[tuple[sp.Basic, Any], ...]:
        """The left and right sides of the equations in `put` and `where`."""
        return (*self.put.items(), *((r.lhs, r.rhs) for r in self.where if isinstance(r, sp.Eq)))

    @property
    def conditions(self) -> tuple[Relational, ...]:
        """The relations in `where` that are not equations."""
        return tuple(r for r in self.where if not isinstance(r, sp.Eq))

    @property
    def formula(self) -> str:
        """The equations and conditions as text, J = I₃, x ≥ 0; empty if the premise only names a small quantity."""
        return ", ".join((*(_equated(a, b) for a, b in self.put.items()), *map(relation_text, self.where)))

    @property
    def with_formula(self) -> str:
        """The `sentence`; if the words do not contain the formula, it follows them."""
        formula = self.formula if len(self.formula) <= _LONGEST else f"{len(self.equations)} equations"
        is_shown = formula and _letters_of(self.formula) not in _letters_of(self.says)
        return self.says + (f": {formula}" if is_shown else "") + self._breach

    @property
    def tex(self) -> tuple[str, ...]:
        """The equations and conditions in LaTeX, one string each; an empty tuple if they are too long to be read."""
        if len(self.formula) > _LONGEST:
            return ()
        sides = [
            f"{latex(sp.sympify(a, strict=True))} = {latex(sp.sympify(b, strict=True))}" for a, b in self.put.items()
        ]
        return (*sides, *map(latex, self.where))

    def on(self, side: Any) -> Any:
        """Substitute all rows of `put` into an expression, simultaneously.

        Parameters
        ----------
        side : Expr or Matrix
            A side of an equation.

        Returns
        -------
        Expr or Matrix
            The side after the substitution.
        """
        if all(isinstance(old, sp.Symbol) for old in self.put):
            return side.xreplace({old: sp.sympify(new, strict=True) for old, new in self.put.items()})
        return side.subs(list(self.put.items()), simultaneous=True)


def _letters_of(text: str) -> str:
    return "".join(text.split())


def _equated(lhs: Any, rhs: Any) -> str:
    return f"{readable(str(lhs))} = {readable(str(rhs))}"


def relation_text(relation: Relational) -> str:
    """Return a relation as plain text, such as x ≥ 0."""
    return f"{readable(str(relation.lhs))} {_SIGNS[relation.func]} {readable(str(relation.rhs))}"


@accept_old_keywords
def parameter_premise(
    says: str,
    substitution: Mapping[sp.Symbol, Any],
    scene_values: Mapping[sp.Symbol, Any],
    meanings: Mapping[sp.Symbol, sp.Expr] | None = None,
) -> Premise:
    """Return a premise about parameters whose `broken` compares it with the values of the paper's scene.

    Parameters
    ----------
    says : str
        The premise in words.
    substitution : Mapping[Symbol, Any]
        Parameter → the value or expression that replaces it.
    scene_values : Mapping[Symbol, Any]
        Parameter → its value in the paper's own scene.
    meanings : Mapping[Symbol, Expr] or None, optional
        Symbol → the expression that it abbreviates.

    Returns
    -------
    Premise
        The premise; if the scene violates it, `broken` has the values of its parameters.

    Examples
    --------
    >>> from sympy import symbols
    >>> ell, R = symbols("ell R", positive=True)
    >>> parameter_premise("the bar is as long as the arms", {ell: R}, {ell: 2, R: 1}).broken
    'ell = 2, R = 1'
    """
    differences = []
    for lhs, rhs in substitution.items():
        sides = [
            (side, with_meanings(sp.sympify(side, strict=True), meanings or {}).subs(scene_values))
            for side in (lhs, rhs)
        ]
        (_, lhs_value), (_, rhs_value) = sides
        if lhs_value.is_number and rhs_value.is_number and lhs_value != rhs_value:
            differences += [f"{sp.pretty(side)} = {float(value):g}" for side, value in sides if side != value]
    return Premise(says, substitution, broken=", ".join(differences))


def with_meanings(expression: Any, meanings: Mapping[sp.Symbol, sp.Expr]) -> Any:
    """Replace each symbol by its meaning, in the order of `meanings`; a meaning may contain symbols that come later."""
    for letter, meaning in meanings.items():
        expression = expression.xreplace({letter: sp.sympify(meaning, strict=True)})
    return expression


Assumptions: TypeAlias = (
    "Mapping[sp.Basic, Any] | Relational | Premise | Iterable[Premise | Relational | Mapping[sp.Basic, Any]]"
)


def premises_of(assumptions: Assumptions) -> tuple[Premise, ...]:
    """Return one premise for each relation, row of a substitution and Premise; raise InputError for anything else."""
    if isinstance(assumptions, Premise):
        return (assumptions,)
    if isinstance(assumptions, Mapping):
        return tuple(premise for row in assumptions.items() for premise in _premises_of_row(*row))
    if isinstance(assumptions, Relational | bool) or assumptions in (sp.true, sp.false):
        return _premises_of_relation(assumptions)
    if isinstance(assumptions, sp.Basic | str) or not isinstance(assumptions, Iterable):
        raise InputError(
            f"premises: {assumptions!r} is not a premise: give Eq(a, b), a >= b, Ne(a, b), {{old: new}} or a Premise"
        )
    return tuple(premise for assumption in assumptions for premise in premises_of(assumption))


def _premises_of_row(old: Any, new: Any) -> tuple[Premise, ...]:
    if isinstance(old, Relational) and new in (True, False, sp.true, sp.false):
        return _premises_of_relation(old if new in (True, sp.true) else sp.Not(old))
    if isinstance(old, sp.MatrixBase):
        rhs = sympified(new, "premises")
        if getattr(rhs, "shape", None) != old.shape:
            raise InputError(f"premises: {old} and {new} differ in shape: give vectors or matrices of the same shape")
        return (Premise(_equated(old, rhs), dict(zip(old, rhs, strict=True))),)
    lhs, rhs = (sympified(side, "premises") for side in (old, new))
    return (Premise(_equated(lhs, rhs), {lhs: rhs}),)


def _premises_of_relation(relation: Any) -> tuple[Premise, ...]:
    if relation in (True, sp.true):
        return ()
    if relation in (False, sp.false):
        return (Premise("a relation that the assumptions of its symbols exclude", {sp.S.Zero: sp.S.One}),)
    if isinstance(relation, sp.And):
        return tuple(premise for conjunct in relation.args for premise in _premises_of_relation(conjunct))
    if not isinstance(relation, Relational):
        raise InputError(f"premises: {relation} is not a single relation: give Eq, Ne, Ge, Gt, Le or Lt, one at a time")
    return (Premise(relation_text(relation), where=(relation,)),)
