"""Expressions of sympy as terms of Coq's real numbers, and the conditions under which both have the same meaning.

Coq's functions are total: x/0, √−1 and the logarithm of −1 are real numbers about which nothing useful is provable. Each
term therefore comes with `conditions_of_value`: denominators are not zero, radicands not negative, arguments of logarithms
positive. Every symbol has a unique name that no term uses. An expression without a term raises NotExactError.
"""

import re
from collections.abc import Iterable
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from lagrotor.algebra.power_series import QUOTIENTS
from lagrotor.errors import NotExactError

# sympy's function -> Coq's, of one real argument.
_FUNCTIONS: dict[Any, str] = {
    **{sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.sinh: "sinh", sp.cosh: "cosh", sp.tanh: "tanh"},
    **{sp.exp: "exp", sp.log: "ln", sp.atan: "atan", sp.asin: "asin", sp.acos: "acos", sp.Abs: "Rabs"},
}
# Reserved names: Coq's words, those of the standard library, and the lemmas of the preamble.
_RESERVED = frozenset(
    """as at cofix do else end exists exists2 fix for forall fun if IF in let match mod return then where with using by
    Prop SProp Set Type R I O S Q Z N nat True False not or and PI sqrt Rpower pow IZR Rinv Rmult Rplus Rminus Rdiv Ropp
    sine_and_cosine root_squared size_squared a_letter_for by_cofactors more_than_zero exp_pos sqrt_lem_1
    same_by_squares sine_below sine_is_small inl inr sum half
    """.split()  # noqa: SIM905
) | set(_FUNCTIONS.values())
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
# Names that the proofs introduce; they are reserved, too.
PROOF_NAMES = re.compile(r"(?:known|apart|root|sum|atom|whole|factor|radical|zero|over|sign|premise|defined)_\d+")
Comparison = tuple[str, sp.Expr]  # ("<>" or "<=" or "<" zero, of an expression): 0 <> e, 0 <= e, 0 < e


class Terms:
    """The names of the symbols and functions of some expressions in Coq, and the text of these expressions.

    Raises NotExactError if two symbols have one name, or an expression has no term over the reals.
    """

    def __init__(self, expressions: Iterable[Any]) -> None:
        self.names: dict[Any, str] = {}
        self.stands_for: dict[sp.Expr, sp.Symbol] = {}
        sides = [sp.sympify(e, strict=True) for e in expressions]
        nodes = {node for e in sides for node in sp.preorder_traversal(e)}
        symbols = {node for node in nodes if node.is_Symbol} | {n.func for n in nodes if isinstance(n, AppliedUndef)}
        by_name: dict[str, Any] = {}
        for symbol in sorted(symbols, key=lambda x: (_plain(x), str(x))):
            if _plain(symbol) in by_name:
                raise NotExactError(f"two symbols are called {_plain(symbol)}")
            if symbol.is_Symbol and symbol.is_extended_real is False:
                raise NotExactError(f"{_plain(symbol)} is no real number")
            by_name[_plain(symbol)] = symbol
            self.add(symbol)

    def add(self, symbol: Any) -> str:
        """Give a symbol a name in Coq, if possible the symbol's name, and return it."""
        called = _plain(symbol)
        name = called if _WORD.fullmatch(called) else "x_" + re.sub(r"\W", "_", called, flags=re.ASCII)
        while name in _RESERVED or PROOF_NAMES.fullmatch(name) or name in self.names.values():
            name += "_"
        self.names[symbol] = name
        return name

    def write(self, node: Any) -> str:
        return self._within(node, 0)

    def alone(self, node: Any) -> str:
        """Return the term as the argument of a function: in brackets unless it is one word."""
        return self._within(node, 4)

    def _within(self, node: Any, strength: int) -> str:
        """Return the term, in brackets if it binds less than `strength`: 1 in a sum, 2 in a product, 3 a factor, 4 alone."""
        text, binds = self._term(node)
        return text if binds >= strength else f"({text})"

    def _term(self, node: Any) -> tuple[str, int]:
        if node in self.names:
            return self.names[node], 4
        if node.is_Integer:
            return (str(node), 4) if node >= 0 else (f"(- {-node})", 4)
        if node.is_Rational:
            return f"({node.p} / {node.q})" if node.p >= 0 else f"(- {-node.p} / {node.q})", 4
        if node is sp.pi:
            return "PI", 4
        if node is sp.E:
            return "exp 1", 3
        if node.is_Add:
            return self._sum(node), 1
        if node.is_Mul:
            return self._product(node), 2
        if node.is_Pow:
            return self._power(node)
        if isinstance(node, AppliedUndef):
            return " ".join([self.names[node.func], *(self._within(argument, 4) for argument in node.args)]), 3
        if node.func in _FUNCTIONS:
            return f"{_FUNCTIONS[node.func]} {self._within(node.args[0], 4)}", 3
        if node.func in QUOTIENTS:
            over, under = (1 if f is None else f(*node.args, evaluate=False) for f in QUOTIENTS[node.func])
            return f"{self._within(sp.sympify(over, strict=True), 2)} / {self._within(under, 3)}", 2
        raise NotExactError(f"{getattr(node, 'func', node)} has no term over the reals")

    def _sum(self, node: sp.Expr) -> str:
        text = ""
        for term in node.as_ordered_terms():
            negative = term.could_extract_minus_sign() and (term.is_Rational or term.is_Mul)
            summand = self._within(-term if negative else term, 2)
            text += f" {'-' if negative else '+'} {summand}" if text else f"- {summand}" if negative else summand
        return text

    def _product(self, node: sp.Expr) -> str:
        over, under = [], []
        number, factors = node.as_coeff_mul()
        for factor in factors:
            if factor.is_Pow and factor.exp.is_Rational and factor.exp < 0:
                under.append(factor.base**-factor.exp if factor.exp != -1 else factor.base)
            else:
                over.append(factor)
        sign = "- " if number < 0 else ""
        number = abs(number)
        upper = [self._within(sp.Integer(number.p), 3)] if number.p != 1 or not over else []
        lower = [self._within(sp.Integer(number.q), 3)] if number.q != 1 else []
        text = " * ".join([*upper, *(self._within(x, 3) for x in over)])
        lower += [self._within(x, 3) for x in under]
        if lower:
            text += f" / ({' * '.join(lower)})" if len(lower) > 1 else f" / {lower[0]}"
        return sign + text

    def _power(self, node: sp.Expr) -> tuple[str, int]:
        base, exponent = node.base, node.exp
        if exponent.is_Rational and exponent.q <= 2:
            if exponent < 0:
                return f"/ {self._within(base if exponent == -1 else base**-exponent, 3)}", 2
            root = f"sqrt {self._within(base, 4)}"
            if exponent.q == 2:
                return (root, 3) if exponent.p == 1 else (f"({root}) ^ {exponent.p}", 3)
            return f"{self._within(base, 4)} ^ {exponent.p}", 3
        if base is sp.E:
            return f"exp {self._within(exponent, 4)}", 3
        return f"Rpower {self._within(base, 4)} {self._within(exponent, 4)}", 3


def _plain(symbol: Any) -> str:
    return str(symbol.name if hasattr(symbol, "name") else symbol.__name__)


def conditions_of_value(expressions: Iterable[Any]) -> list[Comparison]:
    """Return the conditions under which the expressions have values, without those that hold trivially.

    ("<>", e): e is not zero; ("<=", e): 0 <= e; ("<", e): 0 < e.
    """
    conditions: dict[Comparison, None] = {}
    for expression in expressions:
        for node in sp.postorder_traversal(expression):
            conditions |= dict.fromkeys(_conditions_of(node))
    return [(sign, e) for sign, e in conditions if not _plainly(sign, e)]


def _conditions_of(node: Any) -> list[Comparison]:
    if isinstance(node, sp.MatrixBase) or not isinstance(node, sp.Expr):
        return []
    if node.is_Pow:
        base, exponent = node.base, node.exp
        if base is sp.E or (exponent.is_Integer and exponent > 0):
            return []
        if exponent.is_Integer:
            return [("<>", base)]
        if exponent.is_Rational and exponent.q == 2 and exponent > 0:
            return [("<=", base)]
        return [("<", base)]
    if node.func in QUOTIENTS:
        under = QUOTIENTS[node.func][1]
        return [("<>", under(*node.args))] if under is not sp.cosh else []
    if node.func is sp.log:
        return [("<", node.args[0])]
    if node.func in (sp.asin, sp.acos):
        return [("<=", 1 - node.args[0]), ("<=", 1 + node.args[0])]
    return []


def _plainly(sign: str, e: sp.Expr) -> bool:
    """Return True if a number satisfies a condition, or if the declared sign of a symbol, a hypothesis, implies it."""
    if e.is_Symbol:
        return bool(e.is_positive or (sign == "<>" and e.is_nonzero) or (sign == "<=" and e.is_nonnegative))
    plain = e.is_Rational or e is sp.pi
    return bool(plain and {"<>": e != 0, "<=": e >= 0, "<": e > 0}[sign])


def declared_signs(symbols: Iterable[sp.Symbol]) -> list[Comparison]:
    """Return the declared signs of the symbols as comparisons."""
    signs: list[Comparison] = []
    for symbol in sorted(symbols, key=str):
        declared = (
            (symbol.is_positive, "<", symbol), (symbol.is_negative, "<", -symbol), (symbol.is_nonnegative, "<=", symbol),
            (symbol.is_nonpositive, "<=", -symbol), (symbol.is_nonzero, "<>", symbol),
        )  # fmt: skip
        signs += [(sign, e) for holds, sign, e in declared if holds][:1]  # the first is the strongest
    return signs


def comparison(terms: Terms, sign: str, e: sp.Expr) -> str:
    return f"{terms.write(e)} <> 0" if sign == "<>" else f"0 {sign} {terms.write(e)}"


def comment(text: str) -> str:
    """Return text as a comment of Coq; no part of it ends the comment or begins a string."""
    plain = re.sub(r"\s+", " ", text).replace('"', "'")
    while "(*" in plain or "*)" in plain:
        plain = plain.replace("(*", "( *").replace("*)", "* )")
    return f"(* {plain} *)"
