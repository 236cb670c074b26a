"""From a Lagrangian to its equations of motion, in plain symbols.

A Lagrangian L(q, v, t) is an expression in the coordinates q, the velocities v = q' and the time t. Along a motion its
Euler–Lagrange equations are affine in the accelerations a = q'':

    d/dt ∂L/∂v − ∂L/∂q  =  M a + h  =  Q,      M = ∂²L/∂v∂v,      h = (∂²L/∂v∂q) v + ∂²L/∂v∂t − ∂L/∂q,

with the mass matrix M, the bias h and the generalised forces Q. Because q, v, a and t are independent symbols, q never
a function of t, d/dt is the vector field  v ∂/∂q + a ∂/∂v + ∂/∂t.

Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., §§1.4, 2.7; Arnold, Mathematical Methods of Classical
Mechanics, §§12, 19.
"""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar
from unicodedata import normalize

import sympy as sp

from lagrotor.algebra import along, decide_zero
from lagrotor.algebra.differentiation import slopes
from lagrotor.errors import InputError, SingularError, near

t = sp.Symbol("t", real=True)  # the time, s, where a Lagrangian, a force or a constraint depends on it explicitly


@dataclass(frozen=True)
class Coordinates:
    """The coordinates of a system with their velocities and accelerations, n of each.

    Each symbol is also found by its name: c.theta, c["theta_dot"]. For a coordinate called q, v or a write c["q"], because
    c.q is the tuple of all coordinates.

    Attributes
    ----------
    q : tuple of Symbol
        The coordinates.
    v : tuple of Symbol
        The velocities q'.
    a : tuple of Symbol
        The accelerations q''.

    Examples
    --------
    >>> c = coordinates("theta")
    >>> c.theta is c.q[0] and c["theta_dot"] is c.v[0]
    True
    """

    q: tuple[sp.Symbol, ...]
    v: tuple[sp.Symbol, ...]
    a: tuple[sp.Symbol, ...]

    def __post_init__(self) -> None:
        if not len(self.q) == len(self.v) == len(self.a):
            raise InputError(
                f"Coordinates: {len(self.q)} coordinates, {len(self.v)} velocities, {len(self.a)} accelerations: "
                "each coordinate has one velocity and one acceleration; give equally many"
            )
        symbols = (*self.q, *self.v, *self.a, t)
        if repeated := sorted(str(s) for s, times in Counter(symbols).items() if times > 1):
            raise InputError(f"Coordinates: {', '.join(repeated)} repeated: the symbols are independent; rename one")

    __iter__: ClassVar[None] = None  # the symbols are c.q, c.v and c.a

    @cached_property
    def _symbols(self) -> dict[str, sp.Symbol]:
        """The coordinates, velocities and accelerations by name."""
        return {str(s): s for s in (*self.q, *self.v, *self.a)}

    @cached_property
    def sources(self) -> dict[sp.Expr, list[Any]]:
        """The frames between which constraints act, by constraint, as far as methods of frames built them.

        An expression in the coordinates does not say on which bodies its reaction acts, and joint forces depend on that.
        """
        return {}

    def __getitem__(self, name: str) -> sp.Symbol:
        """Return the coordinate, velocity or acceleration with this name."""
        if not isinstance(name, str) or name not in self._symbols:
            meant = near(name, self._symbols) or ": find these symbols by their names"
            raise InputError(f"Coordinates: {name!r} is none of {', '.join(self._symbols)}{meant}")
        return self._symbols[name]

    def __getattr__(self, name: str) -> sp.Symbol:
        """Return the symbol with this name, if no attribute has it."""
        if name.startswith("_") or "a" not in vars(self):
            raise AttributeError(name)
        # Python reads c.ϕ as c.φ: it normalizes the letters of identifiers.
        normal = {normalize("NFKC", text): s for text, s in self._symbols.items()}
        if name in normal:
            return normal[name]
        try:
            return self[name]
        except InputError as refusal:
            raise AttributeError(str(refusal), name=name, obj=self) from None

    def __dir__(self) -> list[str]:
        """Return the names of attributes and symbols."""
        return [*object.__dir__(self), *self._symbols]


def coordinates(names: str | Sequence[str]) -> Coordinates:
    """Return real symbols for the named coordinates: theta, theta_dot, theta_ddot, ….

    Parameters
    ----------
    names : str or sequence
        "theta phi", or a list of names.

    Returns
    -------
    Coordinates
        The symbols.

    Examples
    --------
    >>> c = coordinates("theta phi")
    >>> c.q, c.v
    ((theta, phi), (theta_dot, phi_dot))
    """
    if not isinstance(names, Sequence):
        raise InputError(f"coordinates: {names!r} must be names: coordinates('phi theta psi')")
    stems = names.replace(",", " ").split() if isinstance(names, str) else list(names)
    if strange := [stem for stem in stems if not isinstance(stem, str)]:
        raise InputError(f"coordinates: {strange[0]!r} must be a name: coordinates('phi theta psi')")
    if odd := [e for e in stems if not re.fullmatch(r"\\?[^\W\d_]\S*", e) or e.count("{") != e.count("}")]:
        raise InputError(
            f"coordinates: {odd[0]!r} would be another symbol in a formula: a name begins with a letter, has no blanks, and "
            "closes its braces"
        )
    q, v, a = (tuple(sp.Symbol(stem + order, real=True) for stem in stems) for order in ("", "_dot", "_ddot"))
    return Coordinates(q, v, a)


NO_COORDINATES = Coordinates((), (), ())  # the coordinates of a system of first-order states alone


def gradient(f: sp.Expr, symbols: Sequence[sp.Symbol]) -> sp.Matrix:
    """Return the column ∂f/∂s, one row for each symbol."""
    return sp.Matrix(len(symbols), 1, slopes(f, symbols))


def jacobian(rows: Sequence[sp.Expr], symbols: Sequence[sp.Symbol]) -> sp.Matrix:
    """Return ∂f_i/∂s_j, one row for each f and one column for each symbol."""
    return sp.Matrix(len(rows), len(symbols), [slope for row in rows for slope in slopes(row, symbols)])


def depends_on(f: sp.Expr, symbols: Sequence[sp.Symbol]) -> bool:
    """Return True if a partial derivative of an expression by one of the symbols is not identically zero."""
    return any(slope != 0 and decide_zero(slope).answer != "zero" for slope in slopes(f, symbols))


def is_affine(f: sp.Expr, symbols: Sequence[sp.Symbol]) -> bool:
    """Return True if the partial derivatives of an expression by the symbols do not depend on them."""
    return not any(slope != 0 and depends_on(slope, symbols) for slope in slopes(f, symbols))


def total_derivative(expression: sp.Expr, c: Coordinates) -> sp.Expr:
    """Return df/dt = v·∂f/∂q + a·∂f/∂v + ∂f/∂t along any motion.

    Parameters
    ----------
    expression : Expr
        f(q, v, t).
    c : Coordinates
        The coordinates.

    Returns
    -------
    Expr
        df/dt in q, v, a and t.

    Examples
    --------
    >>> c = coordinates("x")
    >>> total_derivative(c.x * c.x_dot, c)
    x*x_ddot + x_dot**2
    """
    return along(expression, (*c.q, t, *c.v), (*c.v, 1, *c.a))


def momenta(L: sp.Expr, c: Coordinates) -> sp.Matrix:
    """Return the conjugate momenta p = ∂L/∂v.

    Parameters
    ----------
    L, c : Expr, Coordinates
        The Lagrangian and its coordinates.

    Returns
    -------
    Matrix
        p, shape (n, 1).
    """
    return gradient(L, c.v)


def mass_matrix(L: sp.Expr, c: Coordinates) -> sp.Matrix:
    """Return the mass matrix M = ∂²L/∂v∂v.

    Parameters
    ----------
    L, c : Expr, Coordinates
        The Lagrangian and its coordinates.

    Returns
    -------
    Matrix
        M, symmetric, shape (n, n).
    """
    return jacobian(momenta(L, c), c.v)


def bias(L: sp.Expr, c: Coordinates) -> sp.Matrix:
    """Return h = (∂²L/∂v∂q) v + ∂²L/∂v∂t − ∂L/∂q: centrifugal, gyroscopic and driving terms minus potential forces."""
    drift = momenta(L, c).applyfunc(lambda p: along(p, (*c.q, t), (*c.v, 1)))
    return drift - gradient(L, c.q)


def coriolis_matrix(M: sp.Matrix, c: Coordinates) -> sp.Matrix:
    """Return C_ij = ½ Σ_k (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) v_k, shape (n, n); M' − 2 C is skew."""
    if moving := M.free_symbols & {*c.v, t}:
        raise InputError(
            f"coriolis_matrix: the mass matrix contains {min(map(str, moving))}: it must depend on the coordinates alone"
        )
    n = len(c.q)
    slope = [jacobian(list(M.col(j)), c.q) for j in range(n)]  # slope[j][i, k] = ∂M_ij/∂q_k
    return sp.Matrix(
        n,
        n,
        lambda i, j: sp.Add(*((slope[j][i, k] + slope[k][i, j] - slope[k][j, i]) * c.v[k] / 2 for k in range(n))),
    )


def energy(L: sp.Expr, c: Coordinates) -> sp.Expr:
    """Return the Jacobi integral E = v·∂L/∂v − L, with dE/dt = Q·v − ∂L/∂t along a motion.

    Parameters
    ----------
    L, c : Expr, Coordinates
        The Lagrangian and its coordinates.

    Returns
    -------
    Expr
        E in q, v and t.
    """
    return along(L, c.v, c.v) - L


def euler_lagrange(L: sp.Expr, c: Coordinates) -> sp.Matrix:
    """Return d/dt ∂L/∂v − ∂L/∂q, which equals the generalised forces Q along a motion.

    Parameters
    ----------
    L, c : Expr, Coordinates
        The Lagrangian and its coordinates.

    Returns
    -------
    Matrix
        The column in q, v and a, shape (n, 1).

    Examples
    --------
    >>> c = coordinates("x")
    >>> euler_lagrange(c.x_dot**2 / 2 - c.x**2 / 2, c)
    Matrix([[x + x_ddot]])
    """
    return momenta(L, c).applyfunc(lambda p: total_derivative(p, c)) - gradient(L, c.q)


def accelerations(L: sp.Expr, c: Coordinates, forces: Sequence[sp.Expr] | None = None) -> sp.Matrix:
    """Return the accelerations a = M⁻¹ (Q − h).

    Parameters
    ----------
    L, c : Expr, Coordinates
        The Lagrangian and its coordinates.
    forces : sequence or None, optional
        Q, one component for each coordinate; zero by default.

    Returns
    -------
    Matrix
        a, shape (n, 1).

    Raises
    ------
    SingularError
        If det M vanishes identically.
    """
    M = mass_matrix(L, c)
    return linear_solve(M, force_column(forces, c, "accelerations") - bias(L, c), singular_mass("accelerations", M, c))


def force_column(forces: Sequence[sp.Expr] | None, c: Coordinates, where: str) -> sp.Matrix:
    """Return the generalised forces Q as a column, shape (n, 1); zero for None."""
    if forces is None:
        return sp.zeros(len(c.q), 1)
    if len(forces) != len(c.q):
        raise InputError(
            f"{where}: {len(forces)} forces for {len(c.q)} coordinates: Q has one component for each coordinate; "
            "give 0 where no force acts"
        )
    return sp.Matrix(len(c.q), 1, list(forces))


def dependent_rows(where: str, value: str) -> str:
    """Return the error message for constraints that are dependent; `value` is the evidence in words."""
    return f"{where}: the constraints are dependent ({value}): their multipliers are not unique; drop a constraint"


def singular_mass(where: str, M: sp.Matrix, c: Coordinates) -> str:
    """Return the error message for a Lagrangian whose momenta do not determine its velocities."""
    idle = [v for j, v in enumerate(c.v) if M[:, j].is_zero_matrix] or c.v
    return (
        f"{where}: the mass matrix is singular (det M = 0): the Lagrangian is not regular in "
        f"{', '.join(map(str, idle))}; use fewer coordinates"
    )


def linear_solve(A: sp.Matrix, B: sp.Matrix, refusal: str) -> sp.Matrix:
    """Return A⁻¹ B = adj(A) B / det A, or raise SingularError(refusal) if det A vanishes identically.

    The adjugate needs no division, so no pivot has to be recognised as zero.
    """
    determinant = A.det(method="berkowitz")
    if decide_zero(determinant).answer == "zero":
        raise SingularError(refusal)
    return A.adjugate(method="berkowitz") * B / determinant


def clock_parts(
    stages: Iterable[tuple[sp.Symbol, sp.Expr]], outputs: Iterable[sp.Expr], moving: AbstractSet[sp.Basic]
) -> tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]:
    """Find the parts of a program that depend on time but not on the state.

    `stages` are pairs (symbol, expression) that later expressions may use, and `moving` are the symbols of the state. The
    result is the list of stages without these symbols, and the list of the largest subexpressions that contain t and none of
    them.
    """
    moving, by_time = {*moving}, {t}
    clocks, maximal = list[tuple[sp.Symbol, sp.Expr]](), dict[sp.Expr, None]()
    for name, whole in (*stages, *((None, e) for e in outputs)):
        if name is not None and not whole.free_symbols & moving:
            clocks.append((name, whole))  # also one of parameters alone: later stages may use it
            if whole.free_symbols & by_time:
                by_time.add(name)
                maximal[name] = None
            continue
        if name is not None:
            moving.add(name)
        queue = [whole]
        while queue:
            e = queue.pop()
            if e != t and e.free_symbols & by_time:
                if e.free_symbols & moving:
                    queue += e.args
                else:
                    maximal[e] = None
    return clocks, list(maximal)
