"""Printed lines as expressions: what their names stand for, symbols, vectors, the functions that every paper may call."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from lagrotor.algebra import along
from lagrotor.algebra.enclosures import are_apart
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError, LagrotorError
from lagrotor.paper.grammar import parsed


def vector(name: str) -> sp.Matrix:
    """A vector of three real components name_x, name_y, name_z, (3, 1)."""
    return sp.Matrix(sp.symbols(f"{name}_x {name}_y {name}_z", real=True))


def symmetric(name: str) -> sp.Matrix:
    """A symmetric matrix of six real components name_xx, name_xy, …, (3, 3)."""
    return sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"{name}_{'xyz'[min(i, j)]}{'xyz'[max(i, j)]}", real=True))


def rotation(phi: sp.Expr, theta: sp.Expr, psi: sp.Expr) -> sp.Matrix:
    """R_z(phi) R_x(theta) R_z(psi), (3, 3): from the body's frame to the ground's."""
    return sp.rot_axis3(phi).T * sp.rot_axis1(theta).T * sp.rot_axis3(psi).T


def cross(u: sp.Matrix, v: sp.Matrix) -> sp.Matrix:
    """u × v."""
    return u.cross(v)


def cross_matrix(v: sp.Matrix) -> sp.Matrix:
    """The matrix of v ×, (3, 3)."""
    return sp.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def dot(u: sp.Matrix, v: sp.Matrix) -> sp.Expr:
    """u · v."""
    return u.dot(v)


def norm(u: sp.Matrix) -> sp.Expr:
    """The length of u."""
    return sp.sqrt(u.dot(u))


def rate(expression: Any, moving: Iterable[Any], velocities: Iterable[Any]) -> Any:
    """d/dt of an expression or a matrix: `moving` are symbols or vectors, `velocities` their rates in the same order."""
    flow = components(moving), components(velocities)
    if isinstance(expression, sp.MatrixBase):
        return expression.applyfunc(lambda entry: along(entry, *flow))
    return along(expression, *flow)


def components(row: Iterable[Any]) -> list[Any]:
    """Symbols and the components of vectors, in a row."""
    return [entry for item in row for entry in (item if isinstance(item, sp.MatrixBase) else [item])]


def inverse(matrix: sp.Matrix) -> sp.Matrix:
    """The inverse of a square matrix, its adjugate over its determinant."""
    return matrix.adjugate() / matrix.det()


def column(*entries: sp.Expr) -> sp.Matrix:
    """A vector of the given components."""
    return sp.Matrix(entries)


def integral(body: sp.Expr, *over: Any) -> sp.Expr:
    """∫ body: between limits an integral that `algebra` decides, since sympy passes over poles; else an antiderivative."""
    definite = bool(over) and all(isinstance(each, tuple | list | sp.Tuple) and len(each) == 3 for each in over)
    return sp.Integral(body, *over) if definite else sp.integrate(body, *over)


_OF_SYMPY = (
    "sin cos tan exp log sqrt Abs sinh cosh tanh asin acos atan asinh acosh atanh atan2 sign factorial besselj "
    "eye diag zeros diff pi oo Integer Float Rational"
)
# What a printed line may call.
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{f.__name__: f for f in (rotation, cross, cross_matrix, dot, norm, rate, inverse, column)},
    **{name: getattr(sp, name) for name in _OF_SYMPY.split()},
    "integrate": integral,
}


@dataclass(frozen=True)
class Letters:
    """What a section is written in: name → symbol, vector or function; name → LaTeX where the name alone does not say it."""

    names: Mapping[str, Any] = field(default_factory=dict)
    latex: Mapping[str, str] = field(default_factory=dict)


def declared(letters: Mapping[str, str]) -> dict[str, Any]:
    """Letters that a section has besides the paper's own: kind → names in a row.

    Kinds: "vector", (3, 1); "symmetric", a symmetric matrix (3, 3); or an assumption of sympy's, such as "real" or
    "positive". Raises InputError for another kind.
    """
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
                raise InputError(f"letters: {kind!r} is not a kind of letter: vector, symmetric, real, positive")
    return symbols


def read(text: str, letters: Mapping[str, Any], where: str) -> Any:
    """The expression that `text` writes in these letters; decimals are read as the rationals they are.

    Raises InputError where it cannot be read, or holds a letter that is not declared.
    """
    return parsed(text, {**FUNCTIONS, **letters}, where)


def read_side(text: str, letters: Mapping[str, Any], where: str) -> tuple[Any, Any]:
    """Return a printed side as it is decided, and as it is written.

    Raises InputError where it cannot be read, and LagrotorError where an enclosure at a random point keeps the two apart.
    """
    value, written = (parsed(text, {**FUNCTIONS, **letters}, where, as_written) for as_written in (False, True))
    for left, right in zip(*(components([side]) for side in (value, written)), strict=True):
        for point in points(left.free_symbols | right.free_symbols, 2):
            if are_apart(left, right, point):
                raise LagrotorError(f"{where}: {text!r} is not {value}, as it was read: report this error of lagrotor")
    return value, written


@dataclass(frozen=True)
class Line:
    """One printed line `quantity = member = member …`, each member an expression in the paper's letters.

    quantity: what the line is about, in LaTeX. order, small: where it is claimed through small**order only. within: for a
    number read off a run, half a unit of its last printed digit, relative. scene: values that the text gives for this line.
    names: the line only introduces a letter.
    """

    quantity: str
    members: tuple[Any, ...] = ()
    order: int = 0
    small: Any = None
    within: Any = None
    scene: Mapping[Any, Any] = field(default_factory=dict)
    names: bool = False


def read_line(given: Mapping[str, Any], names: Mapping[str, Any], where: str) -> Line:
    """A printed line from what the catalogue says of it. Raises InputError where an expression cannot be read."""

    def read_off(digits: str) -> Any:
        number = read(digits, {}, where)
        return read("1", {}, where) / (2 * number * 10 ** len(digits.partition(".")[2]))

    scene = [(read(name, names, where), read(value, names, where)) for name, value in given.get("scene", {}).items()]
    return Line(
        quantity=given["quantity"],
        members=tuple(read_side(member, names, where)[0] for member in given.get("members", ())),
        order=given.get("order", 0),
        small=read(given["small"], names, where) if "small" in given else None,
        within=read_off(given["read_off"]) if "read_off" in given else None,
        scene=dict(zip(*(components(side) for side in zip(*scene, strict=True)), strict=True)) if scene else {},
        names=given.get("names", False),
    )
