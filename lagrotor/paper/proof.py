"""What a derivation shows: formulas, remarks, and steps decided by `prove(left, right, "in words")`.

`prove` displays both sides, or raises ProofError.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import agreement_order, check_names, decide_equal
from lagrotor.errors import ProofError
from lagrotor.mechanics.glossary import latex


@dataclass(frozen=True)
class Formula:
    """An expression, a matrix or an equation, shown as mathematics; `name` is LaTeX for what it is equal to."""

    expression: Any
    name: str = ""

    @property
    def tex(self) -> str:
        """The formula as LaTeX."""
        left = f"{self.name} = " if self.name else ""
        return left + latex(self.expression)

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.tex}$"


def left_out(small: sp.Symbol, order: int) -> str:
    """+ O(small**(order + 1)), in LaTeX."""
    return rf" + O\left({latex(small ** (order + 1))}\right)"


@dataclass(frozen=True)
class Remark:
    """Something that a derivation found besides the judged equations: a heading and what was found, with its numbers."""

    title: str
    text: str

    def _repr_markdown_(self) -> str:
        return f"**{self.title}.** {self.text}"


# Characters of LaTeX beyond which a side cannot be read: it is to be named, or the equation written in vectors.
_LONGEST = 240


@dataclass(frozen=True)
class Step:
    """Equations that were decided. pairs: (left, right). names: LaTeX of the left sides. written: LaTeX of the equations,
    where vectors read better than the components that were compared. domain: factors that must not vanish. order: of a
    series in `small`."""

    pairs: tuple[tuple[Any, Any], ...]
    says: str
    domain: tuple[sp.Expr, ...]
    names: tuple[str, ...] = ()
    small: sp.Symbol | None = None
    order: int | None = None
    written: tuple[str, ...] = ()

    @property
    def tex(self) -> str:
        """The equations below each other, as LaTeX."""
        end = left_out(self.small, self.order or 0) if self.small is not None else ""
        lines = [f"{line}{end}" for line in self.written] or [
            f"{name} &= {latex(right)}{end}" for name, (_, right) in zip(self.names, self.pairs, strict=True)
        ]
        guarded = ["{}" * line.startswith("[") + line for line in lines]  # after \\ and \begin a bracket is an option
        return r"\begin{aligned} " + r" \\ ".join(guarded) + r" \end{aligned}"

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.tex}$"


def prove(
    left: Any,
    right: Any,
    says: str = "",
    small: sp.Symbol | None = None,
    order: int | None = None,
    names: str | Sequence[str] = (),
    written: str | Sequence[str] = (),
) -> Step:
    """Decide left = right exactly, or through small**order; for rows of expressions and matrices entry by entry.

    Args:
        says: what is decided, in words.
        names: LaTeX shown for the left sides.
        written: LaTeX shown for the whole equations, in vectors and sums where what is compared are components.

    Raises:
        ProofError: with the difference where it does not hold or is not decided, and where a left side is too long to be read and
            neither named nor written.
    """
    pairs = _pairs(left, right)
    check_names(f"prove: {says or 'this step'}", pairs, small)
    named, shown = ((given,) if isinstance(given, str) else tuple(given) for given in (names, written))
    for given, what in ((named, "names"), (shown, "equations are written")):
        if given and len(given) != len(pairs):
            raise ProofError(f"prove: {len(given)} {what} for {len(pairs)} equations")
    if not (named or shown):
        named = tuple(latex(left) for left, _ in pairs)
        if any(len(name) > _LONGEST for name in named):
            raise ProofError(
                f"prove: {says or 'this step'}: a left side is too long to be read; give `names` or `written`"
            )
    domain: dict[sp.Expr, None] = {}
    for a, b in pairs:
        if small is not None:
            _through(a, b, small, order or 0, says)
            continue
        decision = decide_equal(a, b)
        if decision.answer != "zero":
            raise ProofError(f"prove: {says or 'this step'} is {decision.answer}: {a} against {b}: {decision.reason}")
        domain |= dict.fromkeys(f for f in decision.domain if not (f.is_positive or f.is_number))
    return Step(pairs, says, tuple(domain), named, small, order, shown)


def _pairs(left: Any, right: Any) -> tuple[tuple[Any, Any], ...]:
    if isinstance(left, sp.Equality) and not isinstance(right, Sequence):
        raise ProofError("prove: give the two sides, not an equation")
    if isinstance(left, Sequence) or isinstance(right, Sequence):
        rows = list(left), list(right)
        if len(rows[0]) != len(rows[1]):
            raise ProofError(f"prove: {len(rows[0])} left sides and {len(rows[1])} right sides")
        return tuple((sp.sympify(a, strict=True), sp.sympify(b, strict=True)) for a, b in zip(*rows, strict=True))
    return ((sp.sympify(left, strict=True), sp.sympify(right, strict=True)),)


def _through(a: Any, b: Any, small: sp.Symbol, order: int, says: str) -> None:
    entries = zip(a, b, strict=True) if isinstance(a, sp.MatrixBase) else [(a, b)]
    for p, q in entries:
        first = agreement_order(p, q, small, order)
        if first.order is not None:
            raise ProofError(
                f"prove: {says or 'this step'} fails at order {first.order} in {small}, by {first.coefficient}: {p} against {q}"
            )
