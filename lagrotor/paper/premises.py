"""Premises: what is assumed when an equation is judged, in words and as relations, and whether the paper's scene keeps it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.relational import Relational

from lagrotor.algebra.scalar import sympified
from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.plain_text import readable

_LONGEST = 160  # characters of a formula beyond which it is shown as data only
_SIGNS = {sp.Eq: "=", sp.Ne: "≠", sp.Ge: "≥", sp.Gt: ">", sp.Le: "≤", sp.Lt: "<"}


@dataclass(frozen=True)
class Premise:
    """What is assumed. says: in a physicist's words. put: the equations that state it, old = new, as a substitution.

    Attributes
    ----------
    where : tuple[Relational, ...], default ()
        Further relations, Eq, Ne, Ge, Gt, Le, Lt.
    small : Symbol or None, optional
        For an approximation, the quantity in which only the leading terms are kept; `put` then brings it in, and a letter
        on both sides of a row stands on the right for its scaled value.
    broken : str, default ''
        How far the paper's own scene is from it, in words; empty where the scene keeps it.
    defines : bool, default False
        It says what a letter of the print stands for, and nothing of what is derived: an equation that says the same is
        no circle then.
    """

    says: str
    put: Mapping[sp.Basic, Any] = field(default_factory=dict)
    small: sp.Symbol | None = None
    broken: str = ""
    where: tuple[Relational, ...] = ()
    defines: bool = False

    def __post_init__(self) -> None:
        for side in (each for row in self.put.items() for each in row):
            sympified(side, f"premise {self.says!r}")
        for relation in self.where:
            if not isinstance(relation, Relational):
                raise InputError(
                    f"premise {self.says!r}: {relation!r} is no relation: write Eq(a, b), Ne(a, b) or a >= b"
                )

    @property
    def sentence(self) -> str:
        """What is assumed, and by how much the paper's own scene breaks it."""
        return self.says + self._breach

    @property
    def _breach(self) -> str:
        return f" (not met by the paper's own scene: {self.broken})" if self.broken else ""

    @property
    def equations(self) -> tuple[tuple[sp.Basic, Any], ...]:
        """Its equations, (left, right) of each."""
        return (*self.put.items(), *((r.lhs, r.rhs) for r in self.where if isinstance(r, sp.Eq)))

    @property
    def conditions(self) -> tuple[Relational, ...]:
        """Its inequalities."""
        return tuple(r for r in self.where if not isinstance(r, sp.Eq))

    @property
    def formula(self) -> str:
        """Its equations and conditions as text: J = I₃, x ≥ 0; empty where it only names what is small."""
        return ", ".join((*(_equated(a, b) for a, b in self.put.items()), *map(relation_text, self.where)))

    @property
    def with_formula(self) -> str:
        """In words, then as a formula where the words are not that already, and by how much the paper's own scene breaks it."""
        formula = self.formula if len(self.formula) <= _LONGEST else f"{len(self.equations)} equations"
        shown = formula and _letters_of(self.formula) not in _letters_of(self.says)
        return self.says + (f": {formula}" if shown else "") + self._breach

    @property
    def tex(self) -> tuple[str, ...]:
        """Its equations and conditions in LaTeX, where they are few enough to be read."""
        if len(self.formula) > _LONGEST:
            return ()
        sides = [
            f"{latex(sp.sympify(a, strict=True))} = {latex(sp.sympify(b, strict=True))}" for a, b in self.put.items()
        ]
        return (*sides, *map(latex, self.where))

    def on(self, side: Any) -> Any:
        """A side with the substitution made, all rows at once."""
        if all(isinstance(old, sp.Symbol) for old in self.put):
            return side.xreplace({old: sp.sympify(new, strict=True) for old, new in self.put.items()})
        return side.subs(list(self.put.items()), simultaneous=True)


def _letters_of(text: str) -> str:
    return "".join(text.split())


def _equated(left: Any, right: Any) -> str:
    return f"{readable(str(left))} = {readable(str(right))}"


def relation_text(relation: Relational) -> str:
    """A relation as plain text."""
    return f"{readable(str(relation.lhs))} {_SIGNS[relation.func]} {readable(str(relation.rhs))}"


def parameter_premise(
    says: str,
    put: Mapping[sp.Symbol, Any],
    own: Mapping[sp.Symbol, Any],
    meanings: Mapping[sp.Symbol, sp.Expr] | None = None,
) -> Premise:
    """A premise about parameters, such as ell = R: how far the paper's own values break it is computed from them.

    Parameters
    ----------
    says : str
        In words.
    put : mapping
        Letter → what is put in for it.
    own : mapping
        Letter → the value of the paper's own scene.
    meanings : Mapping[Symbol, Expr] or None, optional
        Letters that stand for expressions in other letters.
    """
    off = []
    for left, right in put.items():
        sides = [
            (side, with_meanings(sp.sympify(side, strict=True), meanings or {}).subs(own)) for side in (left, right)
        ]
        (_, here), (_, there) = sides
        if here.is_number and there.is_number and here != there:
            off += [f"{sp.pretty(side)} = {float(value):g}" for side, value in sides if side != value]
    return Premise(says, put, broken=", ".join(off))


def with_meanings(expression: Any, meanings: Mapping[sp.Symbol, sp.Expr]) -> Any:
    """The expression with each letter replaced by what it stands for, one after the other: later ones may be in earlier."""
    for letter, meaning in meanings.items():
        expression = expression.xreplace({letter: sp.sympify(meaning, strict=True)})
    return expression


Given: TypeAlias = (
    "Mapping[sp.Basic, Any] | Relational | Premise | Iterable[Premise | Relational | Mapping[sp.Basic, Any]]"
)


def premises_of(given: Given) -> tuple[Premise, ...]:
    """Premises as they are; one for each relation and for each row of a substitution, old → new.

    Raises InputError for what is none of these. A relation that sympy finds true by itself is left out; of one that it finds
    false only that is kept.
    """
    if isinstance(given, Premise):
        return (given,)
    if isinstance(given, Mapping):
        return tuple(premise for row in given.items() for premise in _of_row(*row))
    if isinstance(given, Relational | bool) or given in (sp.true, sp.false):
        return _of_relation(given)
    if isinstance(given, sp.Basic | str) or not isinstance(given, Iterable):
        raise InputError(f"given: {given!r} is no premise: give Eq(a, b), a >= b, Ne(a, b), {{old: new}} or a Premise")
    return tuple(premise for each in given for premise in premises_of(each))


def _of_row(old: Any, new: Any) -> tuple[Premise, ...]:
    if isinstance(old, Relational) and new in (True, False, sp.true, sp.false):
        return _of_relation(old if new in (True, sp.true) else sp.Not(old))
    if isinstance(old, sp.MatrixBase):
        right = sympified(new, "given")
        if getattr(right, "shape", None) != old.shape:
            raise InputError(f"given: {old} and {new} differ in shape: nothing says which entries are equal")
        return (Premise(_equated(old, right), dict(zip(old, right, strict=True))),)
    left, right = (sympified(side, "given") for side in (old, new))
    return (Premise(_equated(left, right), {left: right}),)


def _of_relation(relation: Any) -> tuple[Premise, ...]:
    if relation in (True, sp.true):
        return ()
    if relation in (False, sp.false):
        return (Premise("a relation that the assumptions of its letters exclude", {sp.S.Zero: sp.S.One}),)
    if isinstance(relation, sp.And):
        return tuple(premise for part in relation.args for premise in _of_relation(part))
    if not isinstance(relation, Relational):
        raise InputError(f"given: {relation} is no single relation: give Eq, Ne, Ge, Gt, Le or Lt, one at a time")
    return (Premise(relation_text(relation), where=(relation,)),)
