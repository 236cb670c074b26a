"""Normal coordinates of a quadratic Hamiltonian without rounding, where its frequencies are rational, algebraic or rational in
parameters.

The vector w of each mode is scaled by ω/(v†A v) and no root is taken: w = k z̄ with k > 0, and the action is z w.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, reduce
from operator import add, mul
from typing import Any

import sympy as sp
from sympy import QQ, QQ_I
from sympy.polys.matrices import DomainMatrix
from sympy.polys.polyerrors import CoercionFailed

from lagrotor.errors import NotExactError

_MOST_ROOTS = 2  # square roots of rational numbers that make the field, beside i


@dataclass(frozen=True)
class ExactCoordinates:
    """As `NormalCoordinates`, of oscillations alone, as expressions; and the field that holds them."""

    vectors: sp.Matrix
    frequencies: tuple[sp.Expr, ...]
    field: Any


def exact_coordinates(A: sp.Matrix, bracket: sp.Matrix, letters: set[sp.Symbol], H: sp.Expr) -> ExactCoordinates:
    """Normal coordinates of ½ x·A x, the quadratic part of H; letters: the parameters.

    Raises NotExactError where a frequency is not in closed form, not real, or zero.
    """
    rates = _frequencies(bracket * A)
    field = _field(letters, sp.Tuple(H, A, *rates))
    modes: list[tuple[sp.Expr, sp.Matrix, sp.Matrix]] = []
    for omega in {elements(field)(omega): omega for omega in rates}.values():
        for v in _orthogonal(_null_vectors(bracket * A + sp.I * omega * sp.eye(A.rows), field), A, field):
            modes.append(_signed(omega, v, A, field))
    modes.sort(key=lambda mode: sp.default_sort_key(abs(mode[0])) if A.free_symbols else float(abs(mode[0])))
    if 2 * len(modes) != A.rows:
        raise NotExactError("normal_form: a frequency is double and not diagonal")
    vectors = sp.Matrix.hstack(*(mode[1] for mode in modes), *(mode[2] for mode in modes))
    return ExactCoordinates(vectors, tuple(mode[0] for mode in modes), field)


def _frequencies(W: sp.Matrix) -> list[sp.Expr]:
    """The positive ω of det(W + i ω) = 0, which is even in ω."""
    s, found = sp.Dummy("s"), []
    squares = sp.Poly(W.charpoly().all_coeffs()[::2], s)
    for factor, _ in sp.factor_list(squares.as_expr(), s, extension=sorted(_roots_in(W), key=str) or None)[1]:
        if not factor.has(s):
            continue
        roots = sp.roots(sp.Poly(factor, s), multiple=True) if sp.degree(factor, s) <= 2 else []
        for root in roots:
            omega = sp.sqrtdenest(sp.sqrt(sp.factor(-root)))
            _roots_in(omega)
            if not omega.is_positive or (W.free_symbols and not omega.is_rational_function(*W.free_symbols)):
                raise NotExactError(f"normal_form: the frequency {omega} is not one in closed form")
            found.append(omega)
        if not roots:
            raise NotExactError(f"normal_form: {factor} = 0 is not solved in closed form")
    return found


def _roots_in(e: Any) -> set[sp.Expr]:
    """The radicals of numbers in an expression. Raises NotExactError where they are more than a small field holds."""
    roots = {power for power in e.atoms(sp.Pow) if not power.exp.is_Integer and not power.free_symbols}
    squares = {power.base for power in roots}
    if len(squares) > _MOST_ROOTS or not all(r.base.is_Rational and (2 * r.exp).is_Integer for r in roots):
        raise NotExactError(f"normal_form: {', '.join(sorted(map(str, roots)))} make no small field of numbers")
    return {sp.sqrt(square) for square in squares}


def _field(letters: set[sp.Symbol], numbers: sp.Tuple) -> Any:
    roots = _roots_in(numbers)
    if letters and roots:
        raise NotExactError(f"normal_form: {roots} beside {letters}")
    if letters:
        return QQ_I.frac_field(*sorted(letters, key=str))
    return QQ.algebraic_field(sp.I, *sorted(roots, key=str)) if roots else QQ_I


@lru_cache(maxsize=8)
def elements(field: Any) -> Callable[[sp.Expr], Any]:
    """What takes a number to the field: sums, products and powers of its square roots and i there, and not by sympy's search."""
    if not field.is_Algebraic:
        return lambda e: field.from_sympy(e)
    known = {root: field.from_sympy(root) for root in field.orig_ext}

    def element(e: sp.Expr) -> Any:
        if e in known:
            return known[e]
        if e.is_Rational:
            return field.convert(QQ(int(e.p), int(e.q)))
        if e.is_Add or e.is_Mul:
            return reduce(add if e.is_Add else mul, map(element, e.args))
        if e.is_Pow and e.exp.is_Integer:
            return element(e.base) ** int(e.exp)
        if e.is_Pow and sp.sqrt(e.base) in known:
            return known[sp.sqrt(e.base)] ** int(2 * e.exp)
        return field.from_sympy(e)

    return element


def _null_vectors(M: sp.Matrix, field: Any) -> list[sp.Matrix]:
    element = elements(field)
    try:
        entries = [[element(M[i, j]) for j in range(M.cols)] for i in range(M.rows)]
    except CoercionFailed as error:
        raise NotExactError(f"normal_form: {error}") from None
    rows = DomainMatrix(entries, M.shape, field).nullspace().to_Matrix()
    return [rows[k, :].T for k in range(rows.rows)]


def _orthogonal(vectors: list[sp.Matrix], A: sp.Matrix, field: Any) -> list[sp.Matrix]:
    """Vectors of the same span with v†A u = 0, none with v†A v = 0."""
    left, found = list(vectors), list[sp.Matrix]()
    while left:
        energies = [_reduced((v.H * A * v)[0], field) for v in left]
        best = next((k for k, energy in enumerate(energies) if energy != 0), None)
        if best is None:
            raise NotExactError("normal_form: modes of equal frequency whose energies vanish")
        v, energy = left.pop(best), energies[best]
        left = [(u - v * ((v.H * A * u)[0] / energy)).applyfunc(lambda e: _reduced(e, field)) for u in left]
        found.append(v)
    return found


def _reduced(e: sp.Expr, field: Any) -> sp.Expr:
    """The expression as its field writes it."""
    return field.to_sympy(elements(field)(e.expand() if field.is_Algebraic else e))


def _signed(omega: sp.Expr, v: sp.Matrix, A: sp.Matrix, field: Any) -> tuple[sp.Expr, sp.Matrix, sp.Matrix]:
    """(ω with the sign of the energy, the vector of z, that of w)."""
    energy, bar = _reduced((v.H * A * v)[0], field), v.conjugate()
    sign = _sign(energy)
    scaled = [(x * (sign * omega / energy)).applyfunc(lambda e: _reduced(e, field)) for x in (bar, v)]
    return (omega, v, scaled[0]) if sign > 0 else (-omega, bar, scaled[1])


def _sign(energy: sp.Expr) -> int:
    """The sign of a number, or of an expression that is zero only where a square is."""
    odd = energy
    if energy.free_symbols:
        coefficient, factors = sp.factor_list(sp.numer(sp.together(energy)) * sp.denom(sp.together(energy)))
        odd = coefficient * sp.Mul(*(factor for factor, power in factors if power % 2))
    if not (odd.is_positive or odd.is_negative):
        raise NotExactError(f"normal_form: the sign of the energy {energy} is not known")
    return 1 if odd.is_positive else -1
