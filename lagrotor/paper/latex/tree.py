"""What a printed formula says: numbers, letters and calls; as text in the names of letters, and as a sympy expression."""

import operator
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.algebra.proving import evaluated
from lagrotor.algebra.work import at_most
from lagrotor.errors import WorkError
from lagrotor.paper.letters import FUNCTIONS


@dataclass(frozen=True)
class Number:
    """A number as printed, exact."""

    value: Fraction


@dataclass(frozen=True)
class Letter:
    r"""A letter with its index, marks and dots, theta_1_dot for \dot\theta_1; a matrix is a vector, too."""

    name: str
    vector: bool = False
    matrix: bool = False


@dataclass(frozen=True)
class Call:
    """An operation, sum product quotient power negative, or a function by its name, of its arguments."""

    name: str
    args: tuple["Node", ...]

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash((self.name, self.args))


Node: TypeAlias = Number | Letter | Call

# Relations as calls, in the condition of a case or of a sum.
CONDITIONS = {"=": "Eq", "<": "Lt", ">": "Gt", "<=": "Le", ">=": "Ge", "!=": "Ne", "in": "In"}
_PRECEDENCE = {"sum": 1, "negative": 2, "product": 3, "quotient": 3, "power": 5}
# Operations whose value is a vector or a matrix, and those that are one where their first argument is.
_VECTORS = ("cross", "column", "matrix", "gradient", "curl", "inverse", "transpose")
_CARRYING = ("sum", "negative", "quotient", "Derivative", "rate", "prime", "Integral", "limit", "Sum", "differential", "laplacian",
             "at", "power", "cases", "case")  # fmt: skip
# What a line of the catalogue may call, but in another sense than a print.
_NOT_PRINTED = "rate diff integrate diag eye zeros rotation Integer Float Rational"
_CALLED = FUNCTIONS.keys() - {*_NOT_PRINTED.split()}
_MOST_BITS = 20_000  # of a number that is evaluated
# Operations of what is integrated in closed form, and the calls of functions that it may take.
_MOST_INTEGRATED, _MOST_CALLS = 60, 3_000_000
_MOST_ADDED = 40  # terms of a sum that is written out
_CONSTANTS = {"pi": sp.pi, "imaginary_unit": sp.I, "oo": sp.oo}
_ARITHMETIC = ("sum", "product", "quotient", "power", "negative")
_KNOWN_NAMES = (
    "sin cos tan cot sec csc sinh cosh tanh coth sech csch asin acos atan asinh acosh atanh exp log sqrt Abs sign "
    "factorial"
)
# Functions whose identities are decided.
KNOWN = {name: getattr(sp, name) for name in _KNOWN_NAMES.split()}


def number(value: int | str) -> Number:
    """A number from its digits."""
    return Number(Fraction(value))


def walk(node: Node) -> Iterator[Node]:
    """The node and all that it holds."""
    waiting = [node]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, Call):
            waiting += node.args[::-1]


def letters_of(node: Node) -> list[str]:
    """The names of its letters, in the order in which they are printed; pi, e and i as numbers are none."""
    return list(dict.fromkeys(each.name for each in walk(node) if isinstance(each, Letter) and not is_constant(each)))


def is_constant(letter: Letter) -> bool:
    """Whether it is pi, i or infinity."""
    return letter.name in _CONSTANTS


def is_vector(node: Node) -> bool:
    """Whether its value is a vector or a matrix."""
    if not isinstance(node, Call):
        return isinstance(node, Letter) and node.vector
    if node.name in ("product", "matmul"):
        return any(map(is_vector, node.args))
    if node.name in _CARRYING and not (node.name == "differential" and len(node.args) > 1):  # d^3 r
        return is_vector(node.args[0])
    return node.name in _VECTORS or node.name.split("_")[0].removesuffix("prime").endswith(("bold", "vec"))


def is_printed_zero(node: Node) -> bool:
    return node == number(0)


def product_of(factors: list[Node]) -> Node:
    flat: list[Node] = []
    for each in factors:
        flat += each.args if isinstance(each, Call) and each.name == "product" else (each,)
    return flat[0] if len(flat) == 1 else Call("product", tuple(flat))


def is_matrix(node: Node) -> bool:
    """Whether a node is a matrix: a declared one, one that is written out, a transposed one, a product of such."""
    if not isinstance(node, Call):
        return isinstance(node, Letter) and node.matrix
    if node.name in ("sum", "negative", "quotient", "power", "rate", "Derivative", "Sum"):
        return is_matrix(node.args[0])
    if node.name == "matmul":
        return is_matrix(node.args[-1]) or node.args[-1] == Call("transpose", node.args[-1:])
    return node.name in ("matrix", "transpose", "inverse") or (
        node.name == "product" and any(map(is_matrix, node.args))
    )


def in_catalogue(node: Node) -> bool:
    """Whether a printed line of the catalogue can hold it: arithmetic and what a line may call in the same sense."""
    each = list(walk(node))
    names = {part.name for part in each if isinstance(part, Call)}
    return names <= {*_ARITHMETIC, *_CALLED} and Letter("imaginary_unit") not in each


def text_of(node: Node) -> str:
    """The node as text, in the order of the print: 1/2*m*x_dot**2."""
    return _text(node, 0)


def _text(node: Node, above: int) -> str:
    if isinstance(node, Letter):
        return node.name
    if isinstance(node, Number):
        text = str(node.value)
        return f"({text})" if above > 3 and ("/" in text or "-" in text) else text
    if node.name not in _PRECEDENCE:
        return f"{node.name}({', '.join(_text(each, 0) for each in node.args)})"
    level = _PRECEDENCE[node.name]
    if node.name == "sum":
        text = _text(node.args[0], 1)
        for each in node.args[1:]:
            taken = isinstance(each, Call) and each.name == "negative"
            inner = each.args[0] if isinstance(each, Call) and taken else each
            text += (" - " if taken else " + ") + _text(inner, 2)
    elif node.name == "negative":
        text = "-" + _text(node.args[0], 3)
    elif node.name == "product":
        text = "*".join([_text(node.args[0], 3), *(_text(each, 4) for each in node.args[1:])])
    elif node.name == "quotient":
        text = f"{_text(node.args[0], 3)}/{_text(node.args[1], 4)}"
    else:
        text = f"{_text(node.args[0], 6)}**{_text(node.args[1], 5)}"
    return f"({text})" if level < above or (node.name == "power" and above == 6) else text


@dataclass
class Opaque:
    """Parts that stand for themselves in a sympy expression: derivatives, integrals, functions that are not known.

    rates: letters and components to their rates. Where they are known, derivatives and integrals of explicit expressions are
    taken, the other letters held fixed, and `fixing` says whether any were. positive: letters that are; `assuming` says whether
    others were taken as positive, so that an integral has a value.
    """

    names: dict[str, sp.Symbol] = field(default_factory=dict)
    rates: Mapping[sp.Symbol, sp.Symbol] | None = None
    fixing: bool = False
    positive: frozenset[str] = frozenset()
    assuming: bool = False

    def symbol(self, node: Node) -> sp.Symbol | sp.MatrixBase:
        """The symbol that stands for a part; of a vector, its components."""
        text = text_of(node)
        if is_vector(node) and not is_matrix(node):
            return sp.Matrix(sp.symbols([f"[{text}]_{k}" for k in (1, 2, 3)], real=True))
        return self.names.setdefault(text, sp.Symbol(f"[{text}]", real=True))


def sympy_expression(node: Node, opaque: Opaque) -> sp.Expr | sp.MatrixBase:
    """The node as a sympy expression of real letters; what is not arithmetic stands for itself."""
    if isinstance(node, Number):
        return sp.Rational(node.value.numerator, node.value.denominator)
    if isinstance(node, Letter):
        if node.name in _CONSTANTS:
            return _CONSTANTS[node.name]
        if node.vector:
            return sp.Matrix(sp.symbols(f"{node.name}_1:4", real=True))
        return sp.Symbol(node.name, real=True)
    if not _transparent(node):
        value = _evaluated(node, opaque)
        return opaque.symbol(node) if value is None else value
    parts = [sympy_expression(each, opaque) for each in node.args]
    if _too_large(node, parts):
        return opaque.symbol(node)
    return _VALUES[node.name](*parts) if node.name in _VALUES else KNOWN[node.name](*parts)


def has_opaque(*values: Any) -> bool:
    """Whether a part of an expression stands for itself."""
    return any(symbol.name.startswith("[") for value in values for symbol in value.free_symbols)


@lru_cache(maxsize=1000)
def _in_closed_form(integral: sp.Integral) -> sp.Expr:
    """The value of an integral, which a section may have in many steps and with each premise; itself beyond its own bound."""
    try:
        return at_most(_MOST_CALLS, evaluated, integral)
    except WorkError:
        return integral


def _integrated(integral: sp.Integral, opaque: Opaque) -> sp.Expr | None:
    """The value of an integral: of the factor that its variable is in, with positive letters where signs decide on it."""
    variable, low, high = integral.limits[0]
    outside, inner = integral.function.as_independent(variable, as_Add=False)
    if sp.count_ops(inner) > _MOST_INTEGRATED:
        return None
    powers = (each.exp for each in inner.atoms(sp.Pow) if each.has(variable))
    entire = not inner.has(sp.log, sp.tan) and all(exponent.is_Integer and exponent > 0 for exponent in powers)
    if (
        not {low, high} & {sp.oo, -sp.oo}
        and entire
        and (inner.free_symbols == {variable} or inner.is_polynomial(variable))
    ):
        return outside * _in_closed_form(sp.Integral(inner, (variable, low, high)))
    signed = {s: sp.Symbol(s.name, positive=True) for s in sorted(integral.free_symbols, key=str)}
    inner, low, high = (each.xreplace(signed) for each in (inner, low, high))
    value = _in_closed_form(sp.Integral(inner, (variable, low, high)))
    opaque.assuming |= not {s.name for s in signed} <= opaque.positive
    return outside * sp.logcombine(value).xreplace({dummy: symbol for symbol, dummy in signed.items()})


def _evaluated(node: Call, opaque: Opaque) -> Any:
    """A determinant, a column, a sum of a few terms, the derivative or integral of an explicit expression; else None."""
    if node.name == "det":
        inner = sympy_expression(node.args[0], opaque)
        explicit = isinstance(inner, sp.MatrixBase) and not has_opaque(inner) and inner.rows == inner.cols <= 4
        return inner.det() if explicit else None
    if node.name == "column" and len(node.args) == 3 and not any(map(is_vector, node.args)):
        return sp.Matrix([sympy_expression(each, opaque) for each in node.args])
    if node.name == "rate" and opaque.rates is not None and isinstance(node.args[0], Call):
        return _rate(sympy_expression(node.args[0], opaque), opaque)
    if node.name == "at_constant":
        return _at_constant(node, opaque)
    if node.name not in ("Sum", "Derivative", "Integral", "at") or not isinstance(node.args[1], Letter):
        return None
    inner, name, rest = sympy_expression(node.args[0], opaque), node.args[1].name, node.args[2:]
    variable = sp.Symbol(name, real=True)
    if isinstance(inner, sp.MatrixBase) or (
        has_opaque(inner) and not (node.name == "Derivative" and _apart(node, inner))
    ):
        return None
    if node.name == "at":
        return None if len(rest) != 1 else inner.subs(variable, sympy_expression(rest[0], opaque))
    if node.name == "Sum":
        ends = [each.value for each in rest if isinstance(each, Number) and each.value.denominator == 1]
        indexed = any(name in symbol.name.split("_")[1:] for symbol in inner.free_symbols)
        if len(rest) != 2 or len(ends) != 2 or ends[1] - ends[0] > _MOST_ADDED or indexed:
            return None
        return sum((inner.subs(variable, k) for k in range(int(ends[0]), int(ends[1]) + 1)), sp.S.Zero)
    others = inner.free_symbols - {variable}
    if variable not in inner.free_symbols or (others and opaque.rates is None):
        return None
    if node.name == "Derivative":
        order = rest[0].value if rest and isinstance(rest[0], Number) else Fraction(len(rest) + 1)
        value = sp.diff(inner, variable, int(order)) if order.denominator == 1 and 0 < order < 20 else None
    elif len(rest) != 2 or inner.has(sp.I):  # what is complex is not decided
        return None
    else:
        value = _integrated(sp.Integral(inner, (variable, *(sympy_expression(each, opaque) for each in rest))), opaque)
    opaque.fixing |= bool(others)
    return None if value is None or value.has(sp.Integral, sp.Derivative, sp.nan, sp.zoo) else value


def _apart(derivative: Call, inner: sp.Expr) -> bool:
    """Whether what stands for itself are functions of other letters than the derivative's: V(r) beside a velocity."""
    functions = {
        f"[{text_of(each)}]"
        for each in walk(derivative.args[0])
        if isinstance(each, Call)
        and each.name not in ("Sum", "Derivative", "Integral", "at", "limit", "rate")
        and not set(letters_of(derivative.args[1])) & set(letters_of(each))
    }
    return {symbol.name for symbol in inner.free_symbols if has_opaque(symbol)} <= functions


def _at_constant(node: Call, opaque: Opaque) -> Any:
    """(∂p/∂T)_V of an explicit expression in T and V; None where it is none, or V is not in it."""
    derivative, *held = node.args
    if not isinstance(derivative, Call) or derivative.name != "Derivative":
        return None
    names = {symbol.name for symbol in sympy_expression(derivative.args[0], opaque).free_symbols}
    explicit = all(isinstance(each, Letter) and each.name in names for each in held)
    return _evaluated(derivative, opaque) if explicit else None


def _rate(inner: Any, opaque: Opaque) -> Any:
    """The derivative by t along the rates of its letters, those without one held fixed; None where it has no rate."""
    time = sp.Symbol("t", real=True)
    rates = {**(opaque.rates or {}), time: sp.S.One}
    moving = sorted(inner.free_symbols & rates.keys(), key=str)
    if has_opaque(inner) or not moving:
        return None
    opaque.fixing |= len(moving) < len(inner.free_symbols)
    return reduce(operator.add, [inner.diff(symbol) * rates[symbol] for symbol in moving])


_VALUES: dict[str, Any] = {
    "sum": lambda *parts: reduce(operator.add, parts),
    "product": lambda *parts: reduce(operator.mul, parts),
    "negative": operator.neg,
    "quotient": operator.truediv,
    "power": operator.pow,
    "cross": lambda u, v: u.cross(v),
    "dot": lambda u, v: u.dot(v),
    "norm": lambda u: sp.sqrt(u.dot(u)),
}


def _too_large(node: Call, parts: list[Any]) -> bool:
    """Whether the value is a number that no one writes out: 9**9**9, 99999!."""
    if node.name == "power" and all(isinstance(part, sp.Rational) for part in parts):
        base, exponent = parts
        return bool(abs(exponent) * max(base.p.bit_length(), base.q.bit_length()) > _MOST_BITS)
    return node.name == "factorial" and isinstance(parts[0], sp.Integer) and parts[0] > _MOST_BITS // 10


def _transparent(node: Call) -> bool:
    """Whether the parts of a call are looked into."""
    vectors = [is_vector(each) for each in node.args]
    if node.name == "sum":
        return all(vectors) or not any(vectors)
    if node.name == "product":
        return sum(vectors) <= 1
    if node.name in ("quotient", "power"):
        return not vectors[1] and (node.name == "quotient" or not vectors[0])
    if node.name in ("cross", "dot"):
        return all(map(_column, node.args))
    if node.name == "norm":
        return _column(node.args[0])
    return node.name == "negative" or (node.name in KNOWN and not any(vectors))


def _column(node: Node) -> bool:
    """Whether it is a vector of three components."""
    if not isinstance(node, Call):
        return isinstance(node, Letter) and node.vector
    if node.name in ("negative", "quotient"):
        return _column(node.args[0])
    if node.name in ("sum", "cross"):
        return all(map(_column, node.args))
    return node.name == "product" and sum(map(is_vector, node.args)) == 1 and any(map(_column, node.args))
