"""The reader of expressions. It converts text to sympy objects by a grammar of known nodes and names, and executes no text.

The text is Python: numbers (1j is the imaginary unit), names, + - * / **, calls of known functions with tuples as arguments,
`.T` of a matrix and `.subs(symbol, value)`. Strings, other attributes and unknown names are refused before any object is built.
`FUNCTIONS` are the functions that every paper may call. `declared` makes the symbols of a section, `read_line` reads a printed
line.
"""

import ast
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import accumulate
from typing import Any

import sympy as sp
from sympy.core.function import FunctionClass

from lagrotor.algebra import along
from lagrotor.algebra.enclosures import are_apart
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError, LagrotorError

# Limits on sizes, which keep a hostile text from using all memory or time.
_MOST_CHARACTERS, _MOST_DIGITS, _MOST_POWER, _MOST_ROWS, _MOST_BRACKETS = 20_000, 400, 1000, 50, 100
_SIGNS: dict[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_SIZED = {sp.eye, sp.zeros}


def parsed(text: str, names: Mapping[str, Any], where: str, as_written: bool = False) -> Any:
    """Convert a text to a sympy object.

    `names` maps each name to a symbol, matrix or function; decimals become exact rationals.

    If `as_written` is True, sums, products and functions stay unevaluated. Raises InputError for an unknown name and for text
    outside the grammar; its message begins with `where`.
    """
    if not isinstance(text, str):
        raise InputError(f"{where}: {text!r} is not a text: write the expression between quotes")
    line = " ".join(text.split())
    if len(line) > _MOST_CHARACTERS:
        raise InputError(f"{where}: an expression of {len(line)} characters is too long: give names to its parts")
    if max(accumulate((c == "(") - (c == ")") for c in line), default=0) > _MOST_BRACKETS:
        raise InputError(f"{where}: more than {_MOST_BRACKETS} brackets within brackets: give names to the parts")
    try:
        tree = ast.parse(line, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(f"{where}: {text!r} cannot be read: {getattr(error, 'msg', error)}") from None
    try:
        value = _Reader(line.encode(), names, as_written).value(tree.body)
        if callable(value) and not isinstance(value, sp.Basic | sp.MatrixBase):
            raise _RefusalError("it is a function without an argument: write the argument in brackets")
        return value
    except _RefusalError as refusal:
        raise InputError(f"{where}: {text!r}: {refusal}") from None
    except (TypeError, AttributeError, ValueError, ArithmeticError, RecursionError) as refusal:
        raise InputError(f"{where}: {text!r} cannot be read: {refusal}") from None


class _RefusalError(Exception):
    """The error that a text lies outside the grammar."""


@dataclass(frozen=True)
class _Reader:
    source: bytes
    names: Mapping[str, Any]
    as_written: bool

    def value(self, node: ast.expr) -> Any:
        """Return the sympy object of a node of the syntax tree."""
        if isinstance(node, ast.Constant):
            return self._number(node)
        if isinstance(node, ast.Name):
            return self._lookup(node.id)
        if isinstance(node, ast.Tuple):
            return tuple(map(self.value, node.elts))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            value = self._operand(node.operand)
            return -value if isinstance(node.op, ast.USub) else value
        if isinstance(node, ast.BinOp):
            return self._operation(node)
        if isinstance(node, ast.Attribute) and node.attr == "T":
            return self._matrix(node.value).T
        if isinstance(node, ast.Call) and not node.keywords:
            return self._call(node)
        raise self._refusal(node)

    def _refusal(self, node: ast.expr) -> _RefusalError:
        text = self.source[node.col_offset : node.end_col_offset].decode()
        hint = ": write ** for a power" if isinstance(getattr(node, "op", None), ast.BitXor) else ""
        return _RefusalError(f"{text!r} is no part of an expression{hint}")

    def _number(self, node: ast.Constant) -> sp.Expr:
        text = self.source[node.col_offset : node.end_col_offset].decode()
        if type(node.value) is complex and text[-1] == "j":
            return sp.I * parsed(text[:-1], {}, "number")
        if type(node.value) not in (int, float) or not text.replace("_", "").isascii():
            raise self._refusal(node)
        if len(text) > _MOST_DIGITS or (type(node.value) is float and not 1e-300 < abs(node.value or 1) < 1e300):
            raise _RefusalError(f"the number {text[:20]}… has too many digits: use a symbol for it")
        return sp.Integer(node.value) if type(node.value) is int else sp.Rational(text.replace("_", ""))

    def _lookup(self, name: str) -> Any:
        if name not in self.names:
            raise _RefusalError(f"name {name!r} is not defined: declare the symbol, or give its meaning")
        value = self.names[name]
        return sp.Integer(value) if type(value) is int else value

    def _operand(self, node: ast.expr) -> Any:
        value = self.value(node)
        if not isinstance(value, sp.Expr | sp.MatrixBase):
            raise self._refusal(node)
        return value

    def _matrix(self, node: ast.expr) -> Any:
        value = self._operand(node)
        if not isinstance(value, sp.MatrixBase):
            raise _RefusalError(f"{self.source[node.col_offset : node.end_col_offset].decode()!r} is not a matrix")
        return value

    def _call(self, node: ast.Call) -> Any:
        arguments = [self.value(argument) for argument in node.args]
        if isinstance(node.func, ast.Attribute) and node.func.attr == "subs" and len(arguments) == 2:
            letter, value = arguments
            if not isinstance(letter, sp.Symbol) or not isinstance(value, sp.Expr):
                raise _RefusalError(".subs takes a symbol and its value")
            return self._operand(node.func.value).subs(letter, value)
        if not isinstance(node.func, ast.Name):
            raise self._refusal(node)
        function = self._lookup(node.func.id)
        if not callable(function) or isinstance(function, sp.Basic | sp.MatrixBase):
            raise _RefusalError(f"{node.func.id} is a symbol, not a function: write {node.func.id}*(…)")
        if function in _SIZED and not all(n.is_Integer and 0 <= n <= _MOST_ROWS for n in arguments):
            raise _RefusalError(f"{node.func.id} takes numbers of rows and columns up to {_MOST_ROWS}")
        if isinstance(function, FunctionClass) or function is sp.sqrt:
            return function(*arguments, evaluate=not (self.as_written or _holds_function(*arguments)))
        return function(*arguments)

    def _operation(self, node: ast.BinOp) -> Any:
        sign = _SIGNS.get(type(node.op))
        if sign is None:
            raise self._refusal(node)
        if self.as_written:
            return self._unevaluated(node, sign)
        lhs, rhs = self._operand(node.left), self._operand(node.right)
        if sign == "**":
            _check_power(lhs, rhs)
            if _holds_function(lhs) and isinstance(rhs, sp.Expr) and not rhs.is_Integer:
                return sp.Pow(lhs, rhs, evaluate=False)
        return _OPERATIONS[sign](lhs, rhs)

    def _unevaluated(self, node: ast.BinOp, sign: str) -> Any:
        """Return a sum, product or power as an unevaluated object, in which nested sums and products are flattened."""
        lhs, rhs = self._operand(node.left), self._operand(node.right)
        if sign == "**":
            _check_power(lhs, rhs)
        if any(isinstance(side, sp.MatrixBase) for side in (lhs, rhs)):
            return _OPERATIONS[sign](lhs, rhs)
        if sign == "**":
            return sp.Pow(lhs, rhs, evaluate=False)
        kind = sp.Add if sign in "+-" else sp.Mul
        if sign == "-":
            rhs = sp.Mul(sp.S.NegativeOne, rhs, evaluate=False)
        elif sign == "/":
            rhs = sp.Pow(rhs, sp.S.NegativeOne, evaluate=False)
        arguments: list[Any] = []
        for value, operand in ((lhs, node.left), (rhs, node.right if sign in "+*" else None)):
            joined = isinstance(operand, ast.BinOp) and isinstance(operand.op, _SAME[kind])
            arguments += value.args if joined and isinstance(value, kind) else [value]
        return kind(*arguments, evaluate=False)


_SAME: dict[Any, Any] = {sp.Add: ast.Add | ast.Sub, sp.Mul: ast.Mult | ast.Div}
_OPERATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": operator.pow,
}  # fmt: skip


def _holds_function(*arguments: Any) -> bool:
    """Return True if an argument contains a function; operations on such arguments stay unevaluated."""
    return any(isinstance(argument, sp.Expr) and argument.has(sp.Function) for argument in arguments)


def _check_power(base: Any, exponent: Any) -> None:
    """Raise _RefusalError if a power has too many digits, or if its exponent is a matrix."""
    if isinstance(exponent, sp.MatrixBase):
        raise _RefusalError("an exponent cannot be a matrix")
    whole = isinstance(exponent, sp.Integer)
    if isinstance(exponent, sp.Expr) and exponent.is_number and (not whole or abs(exponent) > _MOST_POWER):
        size = abs(sp.N(exponent, 5)) if not whole else abs(exponent)
        if not bool(size <= _MOST_POWER):
            raise _RefusalError(f"the exponent {exponent} exceeds {_MOST_POWER}: use a symbol for it")
    if (
        isinstance(base, sp.Rational)
        and whole
        and abs(exponent) * max(abs(base.p), base.q).bit_length() > 4 * _MOST_POWER
    ):
        raise _RefusalError(f"{base}**{exponent} has too many digits: use a symbol for it")


def vector(name: str) -> sp.Matrix:
    """Return a vector of real components name_x, name_y, name_z, shape (3, 1)."""
    return sp.Matrix(sp.symbols(f"{name}_x {name}_y {name}_z", real=True))


def symmetric(name: str) -> sp.Matrix:
    """Return a symmetric matrix of real components name_xx, name_xy, …, shape (3, 3)."""
    return sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"{name}_{'xyz'[min(i, j)]}{'xyz'[max(i, j)]}", real=True))


def rotation(phi: sp.Expr, theta: sp.Expr, psi: sp.Expr) -> sp.Matrix:
    """Return R_z(phi) R_x(theta) R_z(psi), shape (3, 3), from the body's frame to the ground's."""
    return sp.rot_axis3(phi).T * sp.rot_axis1(theta).T * sp.rot_axis3(psi).T


def cross(u: sp.Matrix, v: sp.Matrix) -> sp.Matrix:
    """Return u × v."""
    return u.cross(v)


def cross_matrix(v: sp.Matrix) -> sp.Matrix:
    """Return the matrix, shape (3, 3), that multiplies a vector u to give v × u."""
    return sp.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def dot(u: sp.Matrix, v: sp.Matrix) -> sp.Expr:
    """Return u · v."""
    return u.dot(v)


def norm(u: sp.Matrix) -> sp.Expr:
    """Return the length of u."""
    return sp.sqrt(u.dot(u))


def rate(expression: Any, moving: Iterable[Any], velocities: Iterable[Any]) -> Any:
    """Return the time derivative of an expression or a matrix; `velocities` are the rates of `moving`, in its order."""
    flow = components(moving), components(velocities)
    if isinstance(expression, sp.MatrixBase):
        return expression.applyfunc(lambda entry: along(entry, *flow))
    return along(expression, *flow)


def components(row: Iterable[Any]) -> list[Any]:
    """Return one list of expressions: symbols as they are, vectors by their components."""
    return [entry for item in row for entry in (item if isinstance(item, sp.MatrixBase) else [item])]


def inverse(matrix: sp.Matrix) -> sp.Matrix:
    """Return the inverse of a square matrix, computed as its adjugate divided by its determinant."""
    return matrix.adjugate() / matrix.det()


def column(*entries: sp.Expr) -> sp.Matrix:
    """Return a column vector of the given components."""
    return sp.Matrix(entries)


def integral(body: sp.Expr, *limits: Any) -> sp.Expr:
    """Return an unevaluated integral if limits are given, because sympy ignores poles; otherwise return an antiderivative."""
    definite = bool(limits) and all(isinstance(limit, tuple | list | sp.Tuple) and len(limit) == 3 for limit in limits)
    return sp.Integral(body, *limits) if definite else sp.integrate(body, *limits)


_OF_SYMPY = (
    "sin cos tan exp log sqrt Abs sinh cosh tanh asin acos atan asinh acosh atanh atan2 sign factorial besselj "
    "eye diag zeros diff pi oo Integer Float Rational"
)
# The functions that a printed line may call.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{f.__name__: f for f in (rotation, cross, cross_matrix, dot, norm, rate, inverse, column)},
    **{name: getattr(sp, name) for name in _OF_SYMPY.split()},
    "integrate": integral,
}


@dataclass(frozen=True)
class Letters:
    """The symbols of a section: name → symbol, vector or function, and name → LaTeX if that is not the name."""

    names: Mapping[str, Any] = field(default_factory=dict)
    latex: Mapping[str, str] = field(default_factory=dict)


def declared(letters: Mapping[str, str]) -> dict[str, Any]:
    """Return name → symbol. `letters` has the names of each kind: vector, symmetric, real, positive or nonnegative."""
    symbols: dict[str, Any] = {}
    for kind, names in letters.items():
        for name in names.split():
            if kind == "vector":
                symbols[name] = vector(name)
            elif kind == "symmetric":
                symbols[name] = symmetric(name)
            elif kind in ("real", "positive", "nonnegative"):
                symbols[name] = sp.Symbol(name, **{kind: True})
            else:
                raise InputError(
                    f"letters: {kind!r} is not a kind of symbol: write vector, symmetric, real, positive or nonnegative"
                )
    return symbols


def read(text: str, letters: Mapping[str, Any], where: str) -> Any:
    """Read an expression in the given symbols; raise InputError for unreadable text and undeclared symbols."""
    return parsed(text, {**FUNCTIONS, **letters}, where)


def read_side(text: str, letters: Mapping[str, Any], where: str) -> tuple[Any, Any]:
    """Return a printed side twice, evaluated and unevaluated. Raise LagrotorError if the two differ at a random point."""
    value, unevaluated = (parsed(text, {**FUNCTIONS, **letters}, where, as_written) for as_written in (False, True))
    for lhs, rhs in zip(*(components([side]) for side in (value, unevaluated)), strict=True):
        for point in points(lhs.free_symbols | rhs.free_symbols, 2):
            if are_apart(lhs, rhs, point):
                raise LagrotorError(
                    f"{where}: {text!r} was read as {value}, which differs: report this error of lagrotor"
                )
    return value, unevaluated


@dataclass(frozen=True)
class Line:
    """One printed line `quantity = member = member …`, in which the quantity is LaTeX and each member an expression.

    An approximate line is claimed through small**order. For a number read off a simulation, `within` is the relative error that
    its digits allow, half a unit of the last digit. `scene` has the values that the text gives for this line. `names` is True
    if the line only introduces a symbol.
    """

    quantity: str
    members: tuple[Any, ...] = ()
    order: int = 0
    small: Any = None
    within: Any = None
    scene: Mapping[Any, Any] = field(default_factory=dict)
    names: bool = False


def read_line(table: Mapping[str, Any], names: Mapping[str, Any], where: str) -> Line:
    """Return the printed line that a table `[[equation.line]]` of the catalogue describes."""

    def read_off(digits: str) -> Any:
        number = read(digits, {}, where)
        return read("1", {}, where) / (2 * number * 10 ** len(digits.partition(".")[2]))

    scene = [(read(name, names, where), read(value, names, where)) for name, value in table.get("scene", {}).items()]
    return Line(
        quantity=table["quantity"],
        members=tuple(read_side(member, names, where)[0] for member in table.get("members", ())),
        order=table.get("order", 0),
        small=read(table["small"], names, where) if "small" in table else None,
        within=read_off(table["read_off"]) if "read_off" in table else None,
        scene=dict(zip(*(components(side) for side in zip(*scene, strict=True)), strict=True)) if scene else {},
        names=table.get("names", False),
    )
