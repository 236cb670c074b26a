"""A root of some equations, enclosed: Krawczyk's test proves that a small box holds exactly one.

    K(X) = x − Y F(x) + (1 − Y F'(X)) (X − x),    Y ≈ F'(x)⁻¹,    K(X) inside X ⇒ one root in X.

Neumaier, Interval Methods for Systems of Equations, ch. 5.
"""

from collections.abc import Iterable, Sequence

import sympy as sp
from mpmath import mp

from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.enclosures import Bounds, Point, enclosure

_DIGITS, _STEPS, _FAR, _NARROW = 60, 40, 1e9, sp.Rational(1, 10**25)
Box = dict[sp.Symbol, Bounds]


def enclosed_root(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], point: Point) -> Box | None:
    """A narrow box of the unknowns that holds a root of the equations, the other letters at their values in `point`.

    The search begins at the unknowns' values in `point`. None where no root is found, or none is proved.
    """
    others = {s: value for s, value in point.items() if s not in unknowns}
    functions = [e.xreplace(others) for e in equations]
    slopes = [[derivative(f, s) for s in unknowns] for f in functions]
    at = _near(functions, slopes, unknowns, point)
    if at is None:
        return None
    here = dict(zip(unknowns, at, strict=True))
    box = {s: (x - _NARROW, x + _NARROW) for s, x in here.items()}
    values = [v for f in functions if (v := enclosure(f, here)) is not None]
    spread = [[v for slope in row if (v := enclosure(slope, box)) is not None] for row in slopes]
    if len(values) < len(functions) or any(len(row) < len(unknowns) for row in spread):
        return None
    middle = sp.Matrix([[(low + high) / 2 for low, high in row] for row in spread])
    if middle.det() == 0:
        return None
    Y = middle.inv()
    n = len(unknowns)
    for i, s in enumerate(unknowns):
        moved = _sum(_times((Y[i, j], Y[i, j]), values[j]) for j in range(n))
        total = (here[s] - moved[1], here[s] - moved[0])
        for k in range(n):
            product = _sum(_times((Y[i, j], Y[i, j]), spread[j][k]) for j in range(n))
            off = (int(i == k) - product[1], int(i == k) - product[0])
            total = _sum([total, _times(off, (-_NARROW, _NARROW))])
        if not box[s][0] < total[0] <= total[1] < box[s][1]:
            return None
    return box


def _near(
    functions: Sequence[sp.Expr], slopes: Sequence[Sequence[sp.Expr]], unknowns: Sequence[sp.Symbol], point: Point
) -> list[sp.Rational] | None:
    """Rational values of the unknowns near a root, by Newton's method from those of the point."""
    f, jacobian = (
        sp.lambdify([list(unknowns)], each, "mpmath") for each in (list(functions), [list(r) for r in slopes])
    )
    with mp.workdps(_DIGITS):
        x = mp.matrix([mp.mpf(point[s].p) / point[s].q for s in unknowns])
        try:
            for _ in range(_STEPS):
                step = mp.lu_solve(mp.matrix(jacobian(list(x))), mp.matrix(f(list(x))))
                x -= step
                if not all(mp.isfinite(v) and mp.im(v) == 0 and abs(v) < _FAR for v in x):
                    return None
                if mp.norm(step) < mp.mpf(10) ** -45:
                    return [sp.Rational(int(mp.nint(v * mp.mpf(10) ** 45)), 10**45) for v in x]
        except (ArithmeticError, ValueError, TypeError, NameError):
            return None
    return None


def _times(a: Bounds, b: Bounds) -> Bounds:
    ends = [x * y for x in a for y in b]
    return min(ends), max(ends)


def _sum(parts: Iterable[Bounds]) -> Bounds:
    low, high = sp.S.Zero, sp.S.Zero
    for a, b in parts:
        low, high = low + a, high + b
    return low, high
