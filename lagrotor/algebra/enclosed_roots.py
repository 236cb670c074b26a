"""Enclosures of the roots of equations.

Krawczyk's test proves that a small box X contains exactly one root:

    K(X) = x − Y F(x) + (1 − Y F'(X)) (X − x),    Y ≈ F'(x)⁻¹,    K(X) inside X ⇒ one root in X.

Neumaier, Interval Methods for Systems of Equations, ch. 5.
"""

from collections.abc import Iterable, Sequence

import sympy as sp
from mpmath import mp

from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.enclosures import Bounds, Point, enclosure, enclosures

_DIGITS, _STEPS, _FAR, _NARROW = 60, 40, 1e9, sp.Rational(1, 10**25)
_MOST_BOXES, _MOST_UNDECIDED, _LEAST = 4_000, 16, sp.Rational(1, 10**6)
_CUT = sp.Rational(49, 100)  # off the middle, where roots are frequent
_REACH = 32  # widths of a narrow box by which it is enlarged in the search for a kink
_PIECEWISE = (sp.Abs, sp.sign, sp.Heaviside, sp.Max, sp.Min)
Box = dict[sp.Symbol, Bounds]


def enclosed_root(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], point: Point) -> Box | None:
    """Search for a root near a point, and return a narrow box that is proved to contain one root; None if the proof fails.

    Symbols other than the unknowns keep the values that `point` gives them.
    """
    others = {s: value for s, value in point.items() if s not in unknowns}
    functions = [e.xreplace(others) for e in equations]
    slopes = [[derivative(f, s) for s in unknowns] for f in functions]
    at = _near(functions, slopes, unknowns, point)
    if at is None:
        return None
    centre = dict(zip(unknowns, at, strict=True))
    box = {s: (x - _NARROW, x + _NARROW) for s, x in centre.items()}
    values = [v for f in functions if (v := enclosure(f, centre)) is not None]
    spread = [[v for slope in row if (v := enclosure(slope, box)) is not None] for row in slopes]
    if len(values) < len(functions) or any(len(row) < len(unknowns) for row in spread):
        return None
    middle = sp.Matrix([[(low + high) / 2 for low, high in row] for row in spread])
    if middle.det() == 0:
        return None
    K = _image(values, spread, middle.inv(), centre, box)
    return box if all(box[s][0] < K[s][0] <= K[s][1] < box[s][1] for s in unknowns) else None


def _image(values: Sequence[Bounds], spread: Sequence[Sequence[Bounds]], Y: sp.Matrix, x: Point, X: Box) -> Box:
    """Return the Krawczyk image K(X) of a box X, from enclosures of F(x) and F'(X), the matrix Y and the centre x of X."""
    K: Box = {}
    for i, s in enumerate(X):
        correction = _sum(_times((Y[i, j], Y[i, j]), v) for j, v in enumerate(values))
        summands = [(x[s] - correction[1], x[s] - correction[0])]
        for k, t in enumerate(X):
            product = _sum(_times((Y[i, j], Y[i, j]), row[k]) for j, row in enumerate(spread))
            defect = (int(i == k) - product[1], int(i == k) - product[0])
            summands.append(_times(defect, (X[t][0] - x[t], X[t][1] - x[t])))
        K[s] = _sum(summands)
    return K


def _near(
    functions: Sequence[sp.Expr], slopes: Sequence[Sequence[sp.Expr]], unknowns: Sequence[sp.Symbol], point: Point
) -> list[sp.Rational] | None:
    """Return rational values of the unknowns near a root, found by Newton's method from `point`; None without convergence."""
    f, jacobian = (
        sp.lambdify([list(unknowns)], outputs, "mpmath") for outputs in (list(functions), [list(r) for r in slopes])
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


def _sum(intervals: Iterable[Bounds]) -> Bounds:
    low, high = sp.S.Zero, sp.S.Zero
    for a, b in intervals:
        low, high = low + a, high + b
    return low, high


def roots_in_box(equations: Sequence[sp.Expr], box: Box) -> tuple[list[Box], list[Box]]:
    """Return narrow boxes with exactly one root each, and small undecided boxes; there is no root outside all of these.

    A box has no root if some equation excludes zero in it, or if it is disjoint from its Krawczyk image. A box that contains its
    Krawczyk image has one root. Any other box is intersected with the image and bisected, until 16 boxes are undecided or 4,000
    were examined. A root on the boundary of `box` is included. Where a denominator may vanish the numerators replace the
    equations. A box in which a function may switch its piece is undecided.
    """
    unknowns = list(box)
    equations = [e.rewrite(_PIECEWISE, sp.Piecewise) for e in equations]
    quotients = [
        e.replace(sp.tan, lambda a: sp.sin(a) / sp.cos(a)).replace(sp.cot, lambda a: sp.cos(a) / sp.sin(a))
        for e in equations
    ]
    fractions = [sp.fraction(sp.together(e)) for e in quotients]
    below = [d for _, d in fractions if d.free_symbols & {*unknowns}]
    whole = _Equations(equations, unknowns)
    above = _Equations([numerator for numerator, _ in fractions], unknowns) if below else whole
    roots: list[Box] = []
    open_boxes, undecided, visits = [box], list[Box](), 0
    while open_boxes:
        X = open_boxes.pop()
        visits += 1
        wide = {s: (low - (high - low) / 8, high + (high - low) / 8) for s, (low, high) in X.items()}
        system = above if any(_may_vanish(d, wide) for d in below) else whole
        if any(v is not None and not v[0] <= 0 <= v[1] for v in enclosures(system.equations, X)):
            continue
        K = _krawczyk(system, wide)
        if K is not None and not all(_meet(K[s], X[s]) for s in unknowns):
            continue
        if K is not None and all(wide[s][0] < K[s][0] and K[s][1] < wide[s][1] for s in unknowns):
            root = enclosed_root(system.equations, unknowns, {s: sum(side) / 2 for s, side in K.items()})
            if root is not None and all(wide[s][0] <= root[s][0] and root[s][1] <= wide[s][1] for s in unknowns):
                is_duplicate = any(all(_meet(root[s], earlier[s]) for s in unknowns) for earlier in roots)
                inside = all(_meet(root[s], box[s]) for s in unknowns)
                if inside and not is_duplicate and not any(_may_vanish(d, root) for d in below):
                    roots.append(root)
                continue
        if K is not None:
            X = {s: _not_too_narrow(_common(X[s], K[s])) for s in unknowns}
        widest = max(unknowns, key=lambda s: (X[s][1] - X[s][0]) / (box[s][1] - box[s][0]))
        low, high = X[widest]
        if visits > _MOST_BOXES or len(undecided) == _MOST_UNDECIDED:
            return roots, [*undecided, X, *open_boxes]
        if high - low < _LEAST * (box[widest][1] - box[widest][0]):
            undecided.append(X)
            continue
        cut = low + (high - low) * _CUT
        open_boxes += [{**X, widest: (low, cut)}, {**X, widest: (cut, high)}]
    return roots, undecided


def kinks_in(equations: Sequence[sp.Expr], narrow: Box, box: Box) -> list[sp.Expr]:
    """Return denominators, radicands and conditions of piecewise functions that may vanish in or near a narrow box."""
    if any(high - low > _LEAST * (box[s][1] - box[s][0]) for s, (low, high) in narrow.items() if s in box):
        return []
    near = {s: (low - _REACH * (high - low), high + _REACH * (high - low)) for s, (low, high) in narrow.items()}
    pieces = [e.rewrite(_PIECEWISE, sp.Piecewise) for e in equations]
    powers = set().union(*(e.atoms(sp.Pow) for e in pieces))
    relations = set().union(*(e.atoms(sp.core.relational.Relational) for e in pieces))
    switches = {p.base for p in powers if not (p.exp.is_Integer and p.exp.is_positive)}
    switches |= {r.lhs - r.rhs for r in relations}
    return sorted((e for e in switches if e.free_symbols & {*narrow} and _may_vanish(e, near)), key=sp.default_sort_key)


class _Equations:
    """Equations, their Jacobian matrix row by row, and expressions that vanish where a piecewise function switches."""

    def __init__(self, equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> None:
        self.equations, self.unknowns = equations, unknowns
        self.slopes = [derivative(f, s) for f in equations for s in unknowns]
        relations = set().union(*(f.atoms(sp.core.relational.Relational) for f in equations))
        self.switches = [r.lhs - r.rhs for r in sorted(relations, key=sp.default_sort_key)]


def _may_vanish(e: sp.Expr, X: Box) -> bool:
    bounds = enclosure(e, X)
    return bounds is None or bounds[0] <= 0 <= bounds[1]


def _krawczyk(system: _Equations, X: Box) -> Box | None:
    """Return K(X); None if an enclosure is unknown, a piecewise function may switch in X, or the middle of F'(X) is singular."""
    equations, unknowns = system.equations, system.unknowns
    if any(_may_vanish(e, X) for e in system.switches):
        return None  # the derivatives of the pieces do not bound a jump
    middle = {s: _short((low + high) / 2) for s, (low, high) in X.items()}
    values, n = enclosures(equations, middle), len(unknowns)
    flat = enclosures(system.slopes, X)
    spread = [flat[i * n : (i + 1) * n] for i in range(n)]
    if any(v is None for v in (*values, *(v for row in spread for v in row))):
        return None
    mean = sp.Matrix([[_short((v[0] + v[1]) / 2) for v in row if v] for row in spread])
    if mean.det() == 0:
        return None
    Y = mean.inv().applyfunc(_short)
    return _image([v for v in values if v], [[v for v in row if v] for row in spread], Y, middle, X)


def _meet(a: Bounds, b: Bounds) -> bool:
    return a[0] <= b[1] and b[0] <= a[1]


def _common(a: Bounds, b: Bounds) -> Bounds:
    """Return the intersection of two overlapping intervals; ends are rounded outward to numbers with few digits."""
    low = max(a[0], _below(b[0])) if a[0] < b[0] else a[0]
    return low, min(a[1], -_below(-b[1])) if b[1] < a[1] else a[1]


def _not_too_narrow(side: Bounds) -> Bounds:
    """Return an interval that contains a side, with room for the narrow box in which `enclosed_root` proves a root.

    One side of a box may shrink to less than that box before the others permit the proof.
    """
    low, high = side
    return (low - 8 * _NARROW, high + 8 * _NARROW) if high - low < 8 * _NARROW else side


def _below(x: sp.Rational) -> sp.Rational:
    near = _short(x)
    return near - max(abs(near) / 2**50, sp.Rational(1, 2**1000))


def _short(x: sp.Rational) -> sp.Rational:
    """Return a rational near x with few digits."""
    return sp.Rational(float(x))
