"""The judgement of an equation that is given as text, with its premises, for the shell and for the page in a browser.

Text with a backslash, a brace or a ^ is read as LaTeX, other text as Python; no text is executed. Every symbol is real, and
those named in `positive` are positive.
"""

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.paper.grammar import FUNCTIONS, read, read_side
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.notation import Notation, propose, with_proposals
from lagrotor.paper.latex.statements import PrintedStatement, without_order
from lagrotor.paper.latex.tree import (
    Call,
    Letter,
    Node,
    Opaque,
    divisors,
    put_for,
    rates_of,
    sympy_expression,
    text_of,
    walk,
)
from lagrotor.paper.ledger import decide
from lagrotor.paper.premises import Premise, premises_of
from lagrotor.paper.verdicts import Relation, Statement, Verdict, chain, check_premises
from lagrotor.renamed import accept_old_keywords

_RELATIONS = {"=": sp.Eq, "!=": sp.Ne, ">=": sp.Ge, ">": sp.Gt, "<=": sp.Le, "<": sp.Lt}
_SIGN = re.compile(r"(==|>=|<=|!=|[=<>≥≤≠])")
# Symbols that are numbers to most who type them in this way.
_OPEN = (
    (
        re.compile(r"(?<![\w\\])e\s*\*\*\s*(?:-?\s*[A-Za-z]|\([^()]*[A-Za-z])"),
        "e may be Euler's number or a symbol: write exp(…), or another letter for the symbol",
    ),
    (
        re.compile(r"\bexp\([^()]*\b[iI]\b"),
        "i may be the imaginary unit or a symbol: write 1j, or another letter for the symbol",
    ),
)
# Operations that act on an expression and not on the symbol that abbreviates it.
_ACTING = ("Derivative", "rate", "Integral", "Sum")
_TYPED = {"==": "=", "≥": ">=", "≤": "<=", "≠": "!="}


@dataclass(frozen=True)
class Judgement:
    """The verdict on an equation that was given as text.

    Attributes
    ----------
    verdict : Verdict
        The verdict on the equation.
    readings : tuple[str, ...]
        The equation and the premises as they were read, in plain text.
    """

    verdict: Verdict
    readings: tuple[str, ...]

    def __repr__(self) -> str:
        return repr(self.verdict)

    def _repr_html_(self) -> str:
        return self.verdict._repr_html_()


@dataclass(frozen=True)
class _Text:
    """A relation as text: its sides and signs, (symbol, power) of its O(…) or None, and the sides as LaTeX trees."""

    sides: tuple[str, ...]
    signs: tuple[str, ...]
    order: tuple[str, int] | None = None
    nodes: tuple[Node, ...] = ()

    def __str__(self) -> str:
        order_term = f" + O({self.order[0]}**{self.order[1]})" if self.order else ""
        return (
            self.sides[0] + "".join(f" {a} {b}" for a, b in zip(self.signs, self.sides[1:], strict=True)) + order_term
        )


@accept_old_keywords
def judge_text(
    equation: str, premises: Iterable[str] = (), positive: Iterable[str] = (), small: str = "", order: int = 0
) -> Judgement:
    """Judge an equation that is given as text. In a chain a = b = c, each member is compared with the last.

    Parameters
    ----------
    equation : str
        An equation lhs = rhs or a chain a = b = c, written as Python or LaTeX.
    premises : Iterable[str], default ()
        The premises as text, with one relation each: `J = I_3`, `x >= 0`, `a != b`.
    positive : Iterable[str], default ()
        Names of the symbols that are positive; the others are real.
    small : str, default ''
        The variable of the series, if the equation is claimed through small**order only.
    order : int, default 0
        The order in `small` that is claimed. An O(…) in the equation sets both.

    Returns
    -------
    Judgement
        The verdict, and the equation and premises as they were read.

    Raises
    ------
    InputError
        If the text cannot be read; the message names the place and the remedy.

    Examples
    --------
    >>> judge_text("sqrt(x**2) = x", premises=["x >= 0"])
    sqrt(x**2) = x: holds-if
      under the given premise x ≥ 0
    """
    texts = tuple(_statements(equation, "judge"))
    if not all(set(text.signs) == {"="} for text in texts):
        raise InputError(f"judge: {equation!r} is not an equation: write left = right")
    assumed = tuple(statement for line in premises for statement in _statements(line, "premises"))
    if wrong := next((text for text in assumed if len(text.signs) != 1), None):
        raise InputError(
            f"premises: {str(wrong)!r} is not a premise: write one relation in each, such as x >= 0 or J = I_3"
        )
    for text in texts:
        _check_says_something(text, (*texts, *assumed))
    small, order = next(((text.order[0], text.order[1] - 1) for text in texts if text.order), (small, order))
    letters = letters_in(
        (*filter(None, [small]), *(side for text in (*texts, *assumed) for side in text.sides)), positive
    )
    texts = tuple(_substitute_premises(text, assumed) for text in texts)
    whole = sorted({name for text in texts for node in text.nodes for name in _lengths(node)})
    letters |= {name: sp.Symbol(name, integer=True, positive=True) for name in whole}
    rates = rates_of(node for text in (*texts, *assumed) for node in text.nodes)
    rates = {letters.get(a.name, a): letters.get(b.name, b) for a, b in rates.items()}
    opaque = Opaque(rates=rates, refuses=True, letters=letters)
    premise_relations = [
        _relation(text, letters, opaque) for text in assumed if not _is_substituted(text, assumed, texts)
    ]
    about = read(small, letters, "small") if small else None
    relations: list[Relation] = []
    prints: list[Any] = [about]
    poles, cancelled = set[sp.Expr](), set[sp.Expr]()
    for text in texts:
        sides = _values(text, letters, opaque)
        first, *members = (value for value, _ in sides)
        relations += chain(members[-1], first, *members[:-1], small=about, claimed=order)
        for value, unevaluated in sides:
            prints += [value, unevaluated]
            poles, cancelled = poles | _poles(unevaluated), cancelled | (_poles(unevaluated) - _poles(value))
    statement = Statement("", tuple(relations), premises_of(premise_relations), title="; ".join(map(str, texts)))
    check_premises(prints, statement.premises)
    verdict = decide(statement)
    # sympy cancels the x of x/x and of exp(log(x)), but the domain of the printed text excludes x = 0.
    kept_apart = {sp.expand(sign * (a - b)) for a, b in _strict(verdict.premises) for sign in (1, -1)}
    unseen = sorted((cancelled if verdict.domain else poles) - kept_apart, key=sp.default_sort_key)
    domain = tuple(dict.fromkeys((*verdict.domain, *(sp.Ne(e, 0) for e in unseen))))
    fixed = ["the other symbols are constant in derivatives and integrals"] if opaque.fixing else []
    natural = [f"{name} is a natural number, the last index of a sum" for name in whole]
    return Judgement(replace(verdict, domain=domain), (*map(str, (*texts, *assumed)), *natural, *fixed))


def _lengths(node: Node) -> Iterator[str]:
    """Yield the names of symbols that are the last index of a sum."""
    for call in walk(node):
        if isinstance(call, Call) and call.name == "Sum" and isinstance(call.args[-1], Letter) and len(call.args) == 4:
            yield call.args[-1].name


def _values(text: _Text, letters: Mapping[str, Any], opaque: Opaque) -> list[tuple[Any, Any]]:
    """Return each side as a pair of an evaluated and an unevaluated object. LaTeX is converted directly from its tree."""
    if not text.nodes:
        return [read_side(side, letters, "judge") for side in text.sides]
    subtrees = [subtree for node in text.nodes for subtree in walk(node)]
    called = {subtree.name for subtree in subtrees if isinstance(subtree, Call)}
    if both := next((leaf.name for leaf in subtrees if isinstance(leaf, Letter) and leaf.name in called), None):
        raise InputError(
            f"judge: {both} has an argument in one place and none in another: write the argument everywhere"
        )
    values = [_value(node, opaque) for node in text.nodes]
    shapes = [value.shape for value in values if isinstance(value, sp.MatrixBase)]
    values = [sp.zeros(*shapes[0]) if shapes and value == 0 else value for value in values]
    if len({getattr(value, "shape", ()) for value in values}) > 1:
        raise InputError(f"judge: {text}: the sides must both be numbers, or vectors or matrices of the same shape")
    inverses = ([sp.Pow(_value(d, opaque), -1, evaluate=False) for d in divisors(n)] for n in text.nodes)
    return [(value, sp.Tuple(*factors)) for value, factors in zip(values, inverses, strict=True)]


def _value(node: Node, opaque: Opaque) -> Any:
    try:
        value = sympy_expression(node, opaque)
    except InputError as error:
        raise InputError(f"judge: {error}") from None
    except (TypeError, ValueError, AttributeError, NotImplementedError, RecursionError) as error:
        raise InputError(f"judge: {text_of(node)} has no value: {error}") from None
    return value


def _definitions(assumed: Iterable[_Text]) -> dict[Node, Node]:
    """Return symbol or function → its value, from the LaTeX premises that are equations for it."""
    pairs = (text.nodes for text in assumed if text.signs == ("=",) and text.nodes)
    return {a: b for a, b in pairs if isinstance(a, Letter) or (isinstance(a, Call) and text_of(a).isidentifier())}


def _substitute_premises(text: _Text, assumed: Iterable[_Text]) -> _Text:
    """Substitute the premises into an equation for the symbols that it differentiates or integrates."""
    acting = [n.args[0] for node in text.nodes for n in walk(node) if isinstance(n, Call) and n.name in _ACTING]
    operands = {subtree for node in acting for subtree in walk(node)}
    substitution = {subtree: value for subtree, value in _definitions(assumed).items() if subtree in operands}
    if not substitution:
        return text
    nodes = tuple(put_for(node, substitution) for node in text.nodes)
    return replace(text, nodes=nodes, sides=tuple(map(text_of, nodes)))


def _is_substituted(text: _Text, assumed: Iterable[_Text], texts: Iterable[_Text]) -> bool:
    """Return True if a premise need not be assumed: it was substituted, so that no equation contains its symbol any more."""
    first = text.nodes[0] if text.nodes else None
    return first in _definitions(assumed) and not any(
        first in walk(node) for equation in texts for node in equation.nodes
    )


def _poles(e: Any) -> set[sp.Expr]:
    """Return the expressions that must not vanish: divisors and arguments of logarithms that are not known to be nonzero."""
    if isinstance(e, sp.MatrixBase):
        return set().union(*map(_poles, e))
    bases = {power.base for power in e.atoms(sp.Pow) if power.exp.could_extract_minus_sign()}
    bases |= {log.args[0] for log in e.atoms(sp.log)}
    factors = (
        factor.args[0] if isinstance(factor, sp.Abs) else factor.as_base_exp()[0]
        for b in bases
        for factor in sp.Mul.make_args(b.doit().together().as_numer_denom()[0])
    )
    free = e.free_symbols  # without the bound symbols of integrals and sums
    return {
        factor for factor in factors if factor.free_symbols and factor.free_symbols <= free and not factor.is_nonzero
    }


def _strict(premises: Iterable[Premise]) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    """Yield (a, b) for each premise a > b, a < b or a ≠ b."""
    conditions = (relation for premise in premises for relation in premise.conditions)
    yield from (r.args for r in conditions if isinstance(r, sp.StrictGreaterThan | sp.StrictLessThan | sp.Unequality))


_CALL = re.compile(r"(?<![\\\w])([A-Za-z]\w+)\(")  # a call of a function whose name has more than one letter


def _statements(text: str, where: str) -> Iterator[_Text]:
    typed = [name for name in _CALL.findall(text) if name in FUNCTIONS]
    latex = re.search(r"[\\{}]|!(?!=)", text)
    if typed and latex:
        raise InputError(
            f"{where}: {text!r} has {typed[0]}(…) as in Python beside LaTeX, which reads it as the letters "
            f"{' '.join(typed[0])}: write \\{typed[0]}, or all of it as in Python"
        )
    if typed:
        text = text.replace("^", "**")
    if not latex and "^" not in text:
        for pattern, what in _OPEN:
            if pattern.search(text):
                raise InputError(f"{where}: {text!r}: {what}")
        sides = [side.strip() for side in _SIGN.split(text)]
        yield _Text(tuple(sides[::2]), tuple(_TYPED.get(sign, sign) for sign in sides[1::2]))
        return
    reading = read_formula(text, with_proposals(Notation(), propose([text])))
    if reading.stop is not None:
        what, way = reading.stop
        raise InputError(f"{where}: {text!r}: {what}: {way}")
    for statement in reading.statements:
        if not set(statement.relations) <= _RELATIONS.keys():
            raise InputError(f"{where}: {text!r} has {', '.join(statement.relations)}: write =, !=, >=, >, <= or <")
        yield _text_of_statement(statement)


def _text_of_statement(statement: PrintedStatement) -> _Text:
    """Convert a statement read from LaTeX. If several sides have an O(…), the one of lowest order counts."""
    orders, nodes = zip(*(without_order(side.node) for side in statement.sides), strict=True)
    powers = [order for order in (*orders, statement.order) if order is not None]
    lowest = min(powers, key=lambda order: order[1], default=None)
    return _Text(tuple(map(text_of, nodes)), statement.relations, lowest, nodes)


def _check_says_something(text: _Text, texts: Iterable[_Text]) -> None:
    """Raise InputError if the first side is a symbol that occurs nowhere else, because the equation then only defines it."""
    name, *members = text.sides
    others = (*members, *(side for equation in texts if equation is not text for side in equation.sides))
    if (
        name.isidentifier()
        and name not in FUNCTIONS
        and len(members) == 1
        and not any(re.search(rf"\b{name}\b", side) for side in others)
    ):
        raise InputError(
            f"judge: {text} only defines {name}, which occurs nowhere else: write an expression in place of {name}, or "
            f"give its value by a premise, --given '{name} = …'"
        )


def letters_in(sides: Iterable[str], positive: Iterable[str] = ()) -> dict[str, sp.Symbol]:
    """Return name → real symbol, for the names in the texts that are not functions.

    Those in `positive` are positive; raise InputError if one of them occurs in no text.
    """
    names = set[str]()
    for side in sides:
        try:
            names |= {node.id for node in ast.walk(ast.parse(side.strip(), mode="eval")) if isinstance(node, ast.Name)}
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            continue  # `read` says what is wrong with it
    letters = {name: sp.Symbol(name, real=True) for name in sorted(names - FUNCTIONS.keys())}
    for name in positive:
        if name not in letters:
            raise InputError(
                f"positive: {name!r} is not a symbol of the equation or the premises: {', '.join(letters)}"
            )
        letters[name] = sp.Symbol(name, positive=True)
    return letters


def _relation(text: _Text, letters: Mapping[str, Any], opaque: Opaque) -> Any:
    (lhs, _), (rhs, _) = _values(text, letters, opaque)
    if isinstance(lhs, sp.MatrixBase):
        raise InputError(f"premises: {text} relates vectors: write one premise for each component")
    relation = _RELATIONS[text.signs[0]](lhs, rhs)
    if relation is sp.true:
        raise InputError(f"premises: {text} is always true: omit it")
    return {lhs: rhs} if text.signs[0] == "=" else relation
