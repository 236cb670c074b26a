"""The tree of a printed formula (numbers, symbols, calls), its text with Python names, and its sympy expression."""

import operator
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, reduce
from itertools import pairwise
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.paper.grammar import FUNCTIONS


@dataclass(frozen=True)
class Number:
    """An exact printed number."""

    value: Fraction


@dataclass(frozen=True)
class Letter:
    r"""A printed symbol; its name contains index, accents and dots, such as theta_1_dot for \dot\theta_1.

    `vector` is True for a vector and for a matrix, `matrix` for a matrix only.
    """

    name: str
    vector: bool = False
    matrix: bool = False


@dataclass(frozen=True)
class Call:
    """An operation (sum, product, quotient, power, negative) or a named function, with its arguments."""

    name: str
    args: tuple["Node", ...]

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash((self.name, self.args))


Node: TypeAlias = Number | Letter | Call

_PRECEDENCE = {"sum": 1, "negative": 2, "product": 3, "quotient": 3, "power": 5}
# Operations with a vector or matrix as value; operations whose value has the kind of their first argument.
_VECTORS = ("cross", "column", "matrix", "inverse", "transpose")
_CARRYING_NAMES = "sum negative quotient Derivative rate prime Integral Sum at power"
_CARRYING = frozenset(_CARRYING_NAMES.split())
# Names that a line of the catalogue may call with a meaning other than the printed one.
_NOT_PRINTED = "rate diff integrate diag eye zeros rotation Integer Float Rational"
_CALLED = FUNCTIONS.keys() - {*_NOT_PRINTED.split()}
_MOST_BITS = 20_000  # of a number that is evaluated
_MOST_ADDED = 40  # terms of an explicit sum
_DOTTED = re.compile(r"(\w+?)_(d*)ot")
_CONSTANTS = {"pi": sp.pi, "imaginary_unit": sp.I, "oo": sp.oo}
_ARITHMETIC = ("sum", "product", "quotient", "power", "negative")
_KNOWN_NAMES = (
    "sin cos tan cot sec csc sinh cosh tanh coth sech csch asin acos atan asinh acosh atanh exp log sqrt Abs sign "
    "factorial atan2 besselj"
)
# Functions whose identities are decided.
KNOWN = {name: getattr(sp, name) for name in _KNOWN_NAMES.split()}


def number(value: int | str) -> Number:
    return Number(Fraction(value))


def rational_value(node: Node) -> Fraction | None:
    """Return the value of a node that is a printed number, such as 2, -1 or 3/2; None for any other node."""
    if isinstance(node, Number):
        return node.value
    values = [rational_value(arg) for arg in node.args] if isinstance(node, Call) else []
    match (node.name, *values):
        case ("negative", Fraction() as value):
            return -value
        case ("quotient", Fraction() as above, Fraction() as below) if below:
            return above / below
    return None


def walk(node: Node) -> Iterator[Node]:
    """Yield the node and all nodes below it."""
    waiting = [node]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, Call):
            waiting += node.args[::-1]


def letters_of(node: Node) -> list[str]:
    """Return the names of the symbols in printed order, without the constants pi, e and i."""
    return list(dict.fromkeys(n.name for n in walk(node) if isinstance(n, Letter) and not is_constant(n)))


def is_constant(letter: Letter) -> bool:
    """Return True for pi, i and infinity."""
    return letter.name in _CONSTANTS


def is_vector(node: Node) -> bool:
    """Return True if the value is a vector or a matrix."""
    if not isinstance(node, Call):
        return isinstance(node, Letter) and node.vector
    if node.name in ("product", "matmul"):
        return any(map(is_vector, node.args))
    if node.name in _CARRYING:
        return is_vector(node.args[0])
    return node.name in _VECTORS or node.name.split("_")[0].removesuffix("prime").endswith(("bold", "vec"))


def is_printed_zero(node: Node) -> bool:
    return node == number(0)


def product_of(factors: list[Node]) -> Node:
    flat: list[Node] = []
    for factor in factors:
        flat += factor.args if isinstance(factor, Call) and factor.name == "product" else (factor,)
    return flat[0] if len(flat) == 1 else Call("product", tuple(flat))


def is_matrix(node: Node) -> bool:
    """Return True if the value is a matrix: a declared or printed matrix, a transpose, or a product with a matrix."""
    if not isinstance(node, Call):
        return isinstance(node, Letter) and node.matrix
    if node.name in ("sum", "negative", "quotient", "power", "rate", "Derivative", "Sum"):
        return is_matrix(node.args[0])
    if node.name == "matmul":
        return is_matrix(node.args[-1]) or node.args[-1] == Call("transpose", node.args[-1:])
    product = node.name == "product" and any(map(is_matrix, node.args))
    return product or node.name in ("matrix", "transpose", "inverse")


def divisors(node: Node) -> Iterator[Node]:
    """Yield the nodes that must not vanish, outside sums and integrals: divisors, bases of negative powers, arguments of log."""
    if isinstance(node, Call) and node.name not in BINDING:
        if node.name == "quotient":
            yield node.args[1]
        elif node.name == "log" or (node.name == "power" and "-" in text_of(node.args[1])):
            yield node.args[0]
        for arg in node.args:
            yield from divisors(arg)


def put_for(node: Node, values: Mapping[Node, Node]) -> Node:
    """Return a node with each key of `values` replaced, except the variable of a derivative, integral or sum inside it."""
    if node in values:
        return values[node]
    if not isinstance(node, Call) or not values:
        return node
    if node.name in BINDING and len(node.args) > 1:
        inner, variable, *ends = node.args
        free = {key: value for key, value in values.items() if key != variable}
        return Call(node.name, (put_for(inner, free), variable, *(put_for(arg, values) for arg in ends)))
    return Call(node.name, tuple(put_for(arg, values) for arg in node.args))


def in_catalogue(node: Node) -> bool:
    """Return True if a line of equations.toml can express the node by arithmetic and by functions of equal meaning."""
    nodes = list(walk(node))
    names = {call.name for call in nodes if isinstance(call, Call)}
    return names <= {*_ARITHMETIC, *_CALLED} and Letter("imaginary_unit") not in nodes


def text_of(node: Node) -> str:
    """Return the node as text with Python names in printed order, such as 1/2*m*x_dot**2."""
    return _text(node, 0)


def _text(node: Node, above: int) -> str:
    if isinstance(node, Letter):
        return node.name
    if isinstance(node, Number):
        text = str(node.value)
        return f"({text})" if above > 3 and ("/" in text or "-" in text) else text
    if node.name not in _PRECEDENCE:
        return f"{node.name}({', '.join(_text(term, 0) for term in node.args)})"
    level = _PRECEDENCE[node.name]
    if node.name == "sum":
        text = _text(node.args[0], 1)
        for term in node.args[1:]:
            subtracted = isinstance(term, Call) and term.name == "negative"
            inner = term.args[0] if isinstance(term, Call) and subtracted else term
            text += (" - " if subtracted else " + ") + _text(inner, 2)
    elif node.name == "negative":
        text = "-" + _text(node.args[0], 3)
    elif node.name == "product":
        text = "*".join([_text(node.args[0], 3), *(_text(term, 4) for term in node.args[1:])])
    elif node.name == "quotient":
        text = f"{_text(node.args[0], 3)}/{_text(node.args[1], 4)}"
    else:
        text = f"{_text(node.args[0], 6)}**{_text(node.args[1], 5)}"
    return f"({text})" if level < above or (node.name == "power" and above == 6) else text


@dataclass
class Opaque:
    """The symbols that stand for terms without an explicit formula: derivatives, integrals and unknown functions.

    names: text of a term → its symbol. rates: symbol → its time derivative. If rates are given, derivatives and integrals
    of explicit expressions are evaluated with all other symbols constant; `fixing` becomes True if there are such symbols.
    refuses: True if a term without a formula raises InputError; f(x) is then a sympy function, and sums stay unevaluated.
    letters: name → symbol, for symbols that are not merely real.
    """

    names: dict[str, sp.Symbol] = field(default_factory=dict)
    rates: Mapping[sp.Symbol, sp.Symbol] | None = None
    fixing: bool = False
    refuses: bool = False
    letters: Mapping[str, sp.Symbol] = field(default_factory=dict)

    def symbol(self, node: Node) -> Any:
        """Return the symbol that stands for a term without an explicit formula, or the components of a vector (3, 1).

        If `refuses` is True, return the sympy function of a call f(x), and raise InputError for any other term.
        """
        text = text_of(node)
        if self.refuses and isinstance(node, Call):
            if isinstance(getattr(sp, node.name, None), sp.FunctionClass) and node.name not in _GREEK:
                why = f"judge has no rules for the function {node.name}; write it by other functions"
                raise InputError(f"{text} cannot be decided: {why}")
            if node.name not in _UNDECIDED and not any(map(is_vector, (node, *node.args))):
                return sp.Function(node.name, real=True)(*(sympy_expression(arg, self) for arg in node.args))
            raise InputError(f"{text} cannot be decided: {_UNDECIDED.get(node.name, 'write its components')}")
        if is_vector(node) and not is_matrix(node):
            return sp.Matrix(sp.symbols([f"[{text}]_{k}" for k in (1, 2, 3)], real=True))
        return self.names.setdefault(text, sp.Symbol(f"[{text}]", real=True))


_GREEK = ("beta", "gamma", "zeta")  # usually a function of the author
# Calls that are not decided → remedy.
_UNDECIDED = {
    "Integral": "write an integral of an explicit expression between two limits",
    "Derivative": "write the expression that is differentiated, or give it by a premise, L = …",
    "rate": "write the expression that is differentiated, or give it by a premise", "prime": "write the argument, V'(r)",
    "Sum": "write the first and the last index as numbers, or use no symbols with the index",
    "Product": "write the factors", "at": "write the value", "dots": "write the omitted terms",
    "matmul": "write the entries of the matrices", "det": "write the entries of the matrix", "order": "write O(x^n) at the end",
    "transpose": "write the entries of the matrix", "inverse": "write the entries of the matrix",
    "tr": "write the entries of the matrix",
    "arg": "write it with real symbols", "Re": "write it with real symbols", "Im": "write it with real symbols",
    "max": "write one of the arguments", "min": "write one of the arguments",
    **dict.fromkeys(("sum", "product", "quotient", "power", "cross", "dot", "norm", "column", "matrix", "row"),
                    "write arguments of one kind and size, and smaller numbers"),
}  # fmt: skip


def sympy_expression(node: Node, opaque: Opaque) -> Any:
    """Return the node as a sympy expression of real symbols; a term without an explicit formula becomes one symbol."""
    if isinstance(node, Number):
        return sp.Rational(node.value.numerator, node.value.denominator)
    if isinstance(node, Letter):
        if node.name in _CONSTANTS:
            return _CONSTANTS[node.name]
        if node.vector:
            return sp.Matrix(sp.symbols(f"{node.name}_1:4", real=True))
        return opaque.letters.get(node.name, sp.Symbol(node.name, real=True))
    value = _bound(node, opaque) if node.name in BINDING else _value(node, opaque)
    return opaque.symbol(node) if value is None else value


def _value(node: Call, opaque: Opaque) -> Any:
    """Return the value of arithmetic, of a function in KNOWN, of vectors or explicit matrices; None for any other call."""
    if node.name == "matrix":
        rows = (row.args for row in node.args if isinstance(row, Call))
        return sp.Matrix([[sympy_expression(arg, opaque) for arg in row] for row in rows])
    if node.name not in _VALUES and node.name not in KNOWN:
        return None
    if node.name in _OF_MATRICES and any(isinstance(arg, Letter) and arg.matrix for arg in walk(node)):
        return None  # the entries are unknown
    values = [sympy_expression(arg, opaque) for arg in node.args]
    sizes = [value.shape if isinstance(value, sp.MatrixBase) else () for value in values]
    if _too_large(node, values) or not _fits(node.name, sizes):
        return None
    if node.name in KNOWN:
        return KNOWN[node.name](*values, evaluate=not any(value.has(sp.Function) for value in values))
    return _VALUES[node.name](*values)


def _fits(name: str, sizes: list[tuple[int, ...]]) -> bool:
    """Return True if the operation `name` is defined for arguments of these shapes; () is the shape of a number."""
    if name == "sum":
        return len(set(sizes)) == 1
    if name == "product":
        return len([size for size in sizes if size]) < 2
    if name == "matmul":
        inner = [size for size in sizes if size]
        return all(a[1] == b[0] for a, b in pairwise(inner))
    if name == "power":
        return not sizes[1] and (not sizes[0] or sizes[0][0] == sizes[0][1])
    if name in ("cross", "dot", "norm"):
        return len(set(sizes)) == 1 and sizes[0][-1:] == (1,) and (name != "cross" or sizes[0][0] == 3)
    if name in ("det", "inverse", "tr"):
        return bool(sizes[0]) and sizes[0][0] == sizes[0][1] <= 4
    return bool(sizes[0]) if name == "transpose" else name in ("negative", "quotient") or not any(sizes)


def has_opaque(*values: Any) -> bool:
    """Return True if an expression contains a symbol that stands for a term without an explicit formula."""
    return any(symbol.name.startswith("[") for value in values for symbol in value.free_symbols)


def rates_of(nodes: Iterable[Node]) -> dict[sp.Symbol, sp.Symbol]:
    """Return a map from x to x_dot, and x_dot to x_ddot, for each symbol that has these dots; components for a vector."""
    rates: dict[sp.Symbol, sp.Symbol] = {}
    for letter in {inner for node in nodes for inner in walk(node)}:
        if isinstance(letter, Letter) and (dotted := _DOTTED.fullmatch(letter.name)):
            names = [dotted[1], *(f"{dotted[1]}_{'d' * n}ot" for n in range(1, len(dotted[2]) + 2))]
            for end in ("_1", "_2", "_3") if letter.vector else ("",):
                rates |= dict(pairwise(sp.Symbol(name + end, real=True) for name in names))
    return rates


def _bound(node: Call, opaque: Opaque) -> Any:
    """Return the value of a call that binds a variable, such as a sum or a derivative; None if it has no explicit value."""
    inner = sympy_expression(node.args[0], opaque)
    if node.name == "rate":
        return None if isinstance(node.args[0], Letter) or opaque.rates is None else _rate(inner, opaque)
    if not isinstance(node.args[1], Letter) or node.args[1].vector or isinstance(inner, sp.MatrixBase):
        return None
    name, ends = node.args[1].name, [sympy_expression(limit, opaque) for limit in node.args[2:]]
    variable = opaque.letters.get(name, sp.Symbol(name, real=True))
    if has_opaque(inner):
        return None
    if node.name == "at":
        return None if len(ends) != 1 else inner.subs(variable, ends[0])
    if node.name in ("Sum", "Product"):
        return _series(node, inner, variable, ends, opaque)
    others = inner.free_symbols - {variable}
    if (variable not in inner.free_symbols and (others or not opaque.refuses)) or (others and opaque.rates is None):
        return None
    if node.name == "Derivative":
        order = ends[0] if ends else sp.S.One
        value = sp.diff(inner, variable, int(order)) if order.is_Integer and 0 < order < 20 else None
    elif len(ends) != 2 or inner.has(sp.I):  # complex integrals are not decided
        return None
    else:
        value = sp.Integral(inner, (variable, *ends))
    opaque.fixing |= bool(others)
    return None if value is None or value.has(sp.nan, sp.zoo) else value


def _series(node: Call, inner: Any, variable: sp.Symbol, ends: list[Any], opaque: Opaque) -> Any:
    """Return a sum or product of few terms, evaluated; with `opaque.refuses` a long sum unevaluated; None for any other."""
    name = variable.name
    if len(ends) != 2 or ends[0].is_Integer is not True:
        return None
    if ends[1].is_Integer and ends[1] - ends[0] <= _MOST_ADDED:
        numbers = range(int(ends[0]), int(ends[1]) + 1)
        terms = [sympy_expression(_with_index(node.args[0], name, k), opaque) for k in numbers]
        return (sp.Add if node.name == "Sum" else sp.Mul)(*terms)
    free = not any(name in symbol.name.split("_")[1:] for symbol in inner.free_symbols)
    return sp.Sum(inner, (variable, *ends)) if opaque.refuses and free and node.name == "Sum" else None


def _with_index(node: Node, name: str, k: int) -> Node:
    """Return the term of a sum in which its index `name` has the value k; for k = 2, i becomes 2 and x_i becomes x_2."""
    if isinstance(node, Letter):
        stem, *index = node.name.split("_")
        named = replace(node, name="_".join((stem, *(str(k) if word == name else word for word in index))))
        return number(k) if node.name == name else named
    return Call(node.name, tuple(_with_index(arg, name, k) for arg in node.args)) if isinstance(node, Call) else node


def _rate(inner: Any, opaque: Opaque) -> Any:
    """Return the time derivative by the rates in `opaque`, with all other symbols constant; None if none has a rate."""
    time = sp.Symbol("t", real=True)
    rates = {**(opaque.rates or {}), time: sp.S.One}
    moving = sorted(inner.free_symbols & rates.keys(), key=str)
    if has_opaque(inner) or not moving:
        return None
    opaque.fixing |= len(moving) < len(inner.free_symbols)
    return reduce(operator.add, [inner.diff(symbol) * rates[symbol] for symbol in moving])


# Operations that bind their second argument; `rate` binds t.
BINDING = ("Sum", "Product", "Derivative", "Integral", "at", "rate")
_OF_MATRICES = ("matmul", "det", "inverse", "transpose", "tr", "power")
_VALUES: dict[str, Any] = {
    "sum": lambda *values: reduce(operator.add, values),
    "product": lambda *values: reduce(operator.mul, values),
    "matmul": lambda *values: reduce(operator.mul, values),
    "negative": operator.neg,
    "quotient": operator.truediv,
    "power": lambda base, exponent: _power(base, exponent),
    "cross": lambda u, v: u.cross(v),
    "dot": lambda u, v: u.dot(v),
    "norm": lambda u: sp.sqrt(u.dot(u)),
    "column": lambda *entries: sp.Matrix(entries),
    "transpose": lambda A: A.T,
    "inverse": lambda A: A.adjugate() / A.det(),
    "det": lambda A: A.det(),
    "tr": lambda A: A.trace(),
    "binomial": sp.binomial,
}


def _power(base: Any, exponent: Any) -> Any:
    """Return a power; a fractional power of an expression with an unknown function is left unevaluated."""
    if isinstance(base, sp.Expr) and base.has(sp.Function) and not exponent.is_Integer:
        return sp.Pow(base, exponent, evaluate=False)
    return base**exponent


def _too_large(node: Call, values: list[Any]) -> bool:
    """Return True if the value of a power, a factorial or a binomial would have too many digits, such as 9**9**9."""
    if node.name == "power" and all(isinstance(value, sp.Rational) for value in values):
        base, exponent = values
        return bool(abs(exponent) * max(base.p.bit_length(), base.q.bit_length()) > _MOST_BITS)
    if node.name == "power" and isinstance(values[0], sp.MatrixBase):
        return not (isinstance(values[1], sp.Integer) and 0 < values[1] < 10)
    numbers = node.name in ("factorial", "binomial") and all(isinstance(value, sp.Rational) for value in values)
    return numbers and any(abs(value) > _MOST_BITS // 10 for value in values)
