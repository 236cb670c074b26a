"""The linear system of small motion, its modes, and the condition of its stability.

Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., ch. 6; Merkin, Introduction to the Theory of Stability, chs. 4, 6;
Gantmacher, The Theory of Matrices, vol. 2, ch. XV (Routh–Hurwitz, Hankel forms).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero, normal_form
from lagrotor.errors import InputError, NotExactError
from lagrotor.mechanics.expressions import by_symbol, no_letter

_S = sp.Symbol("s")


@dataclass(frozen=True)
class Mode:
    """A solution Re(shape exp(rate t)): rate = i ω for an oscillation, 1/s; shape (n, 1) in the full coordinates."""

    rate: sp.Expr
    shape: sp.Matrix


@dataclass(frozen=True)
class LinearSystem:
    """M a + C v + K q = 0 in independent small coordinates; `basis` (n, d) carries them to the full ones.

    `gyroscopic` is C, with friction and nonconservative forces in it where there are any.
    """

    mass: sp.Matrix
    gyroscopic: sp.Matrix
    stiffness: sp.Matrix
    basis: sp.Matrix

    def characteristic(self, s: sp.Symbol) -> sp.Expr:
        """det(s² M + s C + K), factored."""
        return sp.factor(self._pencil(s).det(method="berkowitz"))

    def _pencil(self, s: sp.Expr) -> sp.Matrix:
        return s**2 * self.mass + s * self.gyroscopic + self.stiffness

    def modes(self, values: Mapping[sp.Symbol, Any] | None = None) -> tuple[Mode, ...]:
        """The modes, exact where the factors of the characteristic polynomial are of degree two in s or s²; with `values`
        for every symbol, numbers, sorted by |rate|.

        Raises
        ------
        InputError
            When neither is possible, or a symbol has no value.
        """
        if values is not None:
            return self._numeric_modes(values)
        modes: list[Mode] = []
        for factor, _ in sp.factor_list(sp.numer(sp.together(self.characteristic(_S))))[1]:
            if factor.has(_S):
                for rate in _roots(sp.Poly(factor, _S)):
                    modes += [Mode(rate, (self.basis * vector).applyfunc(reduced)) for vector in self._shapes(rate)]
        return tuple(modes)

    def _shapes(self, rate: sp.Expr) -> list[sp.Matrix]:
        """Null vectors at a root of the characteristic polynomial: a column of the adjugate, where one is not zero."""
        pencil = self._pencil(rate).applyfunc(reduced)
        columns = [pencil.adjugate()[:, j] for j in range(pencil.cols)]
        column = next((column for column in columns if not all(map(is_identically_zero, column))), None)
        return [column] if column is not None else list(pencil.nullspace(iszerofunc=is_identically_zero))

    def _numeric_modes(self, values: Mapping[sp.Symbol, Any]) -> tuple[Mode, ...]:
        import numpy as np

        matrices = (self.mass, self.gyroscopic, self.stiffness, self.basis)
        parts = [m.subs(by_symbol("modes: values", values, m.free_symbols)) for m in matrices]
        no_letter("modes", set().union(*(m.free_symbols for m in parts)))
        M, C, K, basis = (np.array(m.tolist(), dtype=float) for m in parts)
        d = len(M)
        below = np.linalg.solve(M, np.hstack([-K, -C]))
        rates, vectors = np.linalg.eig(np.vstack([np.hstack([np.zeros((d, d)), np.eye(d)]), below]))
        order = sorted(range(2 * d), key=lambda i: (round(float(abs(rates[i])), 9), rates[i].imag))
        return tuple(Mode(sp.sympify(complex(rates[i]), strict=True), sp.Matrix(basis @ vectors[:d, i])) for i in order)

    @property
    def stable_if(self) -> sp.Basic:
        """When every mode stays bounded or decays: a condition on the parameters.

        It is sufficient and, but for equality, necessary.
        Without friction (det(s² M + s C + K) even in s): all roots s² real, negative and distinct: the coefficients and
        the Hankel minors of the roots' power sums are positive; without gyroscopic forces these are real, and may be equal.
        Otherwise so for the product of its even factors, and for that of the others the Routh–Hurwitz determinants are positive.
        Factors that are positive by the symbols' assumptions are divided out. Zero roots are left aside where they are those
        of rest elsewhere and of drifts at constant velocity; where a motion grows as t², it is false.
        Rates that several independent modes have at any parameters, as those of a spherical pendulum, count once.
        """
        natural = all(map(is_identically_zero, (*self.gyroscopic, *(self.stiffness - self.stiffness.T))))
        return sp.false if self._zeros > max(2, self._drifts) else stability_condition(self._pencil(_S), _S, natural)

    @property
    def _zeros(self) -> int:
        """How often s = 0 is a root of det(s² M + s C + K)."""
        coefficients = sp.Poly(sp.numer(sp.together(self._pencil(_S).det(method="berkowitz"))), _S).all_coeffs()
        return next(i for i, e in enumerate(reversed(coefficients)) if not is_identically_zero(e))

    @property
    def _drifts(self) -> int:
        """The dimension of K q = 0, of rest elsewhere, and that of K q + C v = 0 with K v = 0, of constant velocities v."""
        K = self.stiffness
        right, left = (m.nullspace(iszerofunc=is_identically_zero) for m in (K, K.T))
        coupled = sp.Matrix(len(left), len(right), lambda i, j: left[i].dot(self.gyroscopic * right[j]))
        return 2 * len(right) - int(coupled.rank(iszerofunc=is_identically_zero))


def stability_condition(pencil: sp.Matrix, s: sp.Symbol, natural: bool = False) -> sp.Basic:
    """When the roots s of det(pencil) = 0 are as `LinearSystem.stable_if` says; natural: of s² M + K, both symmetric."""
    pencil = pencil.applyfunc(lambda e: e.xreplace({x: sp.Rational(x) for x in e.atoms(sp.Float)}))
    factors = _last_invariant(pencil, s)
    parts = [sp.Mul(*factors)]
    if not _is_even(parts[0], s):
        parts = [sp.Mul(*(f for f in factors if _is_even(f, s) is even)) for even in (True, False)]
    conditions: list[sp.Expr] = []
    for part in parts:
        coefficients = _coefficients(part, s)
        if natural:
            conditions += [reduced(x / coefficients[0]) for x in coefficients[2::2]]
        else:
            conditions += _all_negative(coefficients[::2]) if _is_even(part, s) else _hurwitz(coefficients)
    return _conjunction(conditions)


def _coefficients(e: sp.Expr, s: sp.Symbol) -> list[sp.Expr]:
    """Those of a polynomial in s, the highest first, without its zero roots."""
    coefficients = [reduced(c) for c in sp.Poly(e, s).all_coeffs()]
    while is_identically_zero(coefficients[-1]):
        coefficients.pop()
    return coefficients


def _is_even(e: sp.Expr, s: sp.Symbol) -> bool:
    return all(is_identically_zero(c) for c in _coefficients(e, s)[1::2])


def _last_invariant(pencil: sp.Matrix, s: sp.Symbol) -> list[sp.Expr]:
    """The determinant's factors without what the minors of order n − 1 have in common of repeated ones: these stay repeated where
    motions grow as t exp(s t). Gantmacher, vol. 1, ch. VI (invariant polynomials)."""
    _, factors = sp.factor_list(sp.numer(sp.together(pencil.det(method="berkowitz"))))
    lasting = {f: k for f, k in factors if f.has(s)}
    repeated = [(f, k) for f, k in factors if k > 1 and f.has(s) and f != s]
    minors = [sp.Poly(e, s) for e in pencil.adjugate(method="berkowitz") if e != 0] if repeated else []
    for f, k in repeated:
        shared = 0
        while shared < k - 1 and all(
            all(map(is_identically_zero, m.rem(sp.Poly(f ** (shared + 1), s)).all_coeffs())) for m in minors
        ):
            shared += 1
        lasting[f] -= shared
    return [f**k for f, k in lasting.items()]


def reduced(e: sp.Expr) -> sp.Expr:
    """A shorter form of the same: unique where the class of decisions has one."""
    try:
        return sp.factor(normal_form(e))
    except NotExactError:
        return sp.factor(e)


def is_identically_zero(e: sp.Expr) -> bool:
    return e == 0 or decide_zero(e).answer == "zero"


def _roots(factor: sp.Poly) -> list[sp.Expr]:
    """Roots of a factor of degree one or two in s, or of degree one or two in s²."""
    s = factor.gen
    if factor.degree() <= 2:
        return list(sp.roots(factor, multiple=True))
    even = all(power % 2 == 0 for (power,) in factor.monoms())
    if even and factor.degree() == 4:
        squares = sp.roots(sp.Poly(factor.as_expr().subs(s, sp.sqrt(s)), s), multiple=True)
        return [sign * sp.sqrt(square) for square in squares for sign in (1, -1)]
    raise InputError(f"modes: {factor.as_expr()} = 0 is not solved in closed form: give values={{symbol: number, …}}")


def _all_negative(a: list[sp.Expr]) -> list[sp.Expr]:
    """What must be positive for a_0 x^n + … + a_n to have real, negative and distinct roots only."""
    a = [reduced(x / a[0]) for x in a]
    n = len(a) - 1
    sums: list[sp.Expr] = [sp.Integer(n)]
    for k in range(1, 2 * n - 1):  # Newton's identities
        total = sum((a[i] * sums[k - i] for i in range(1, min(k, n + 1)) if i <= n), sp.S.Zero)
        sums.append(-total - (k * a[k] if k <= n else 0))
    hankel = [sp.Matrix(m, m, lambda i, j: sums[i + j]).det(method="berkowitz") for m in range(2, n + 1)]
    return [*a[1:], *hankel]


def _hurwitz(a: list[sp.Expr]) -> list[sp.Expr]:
    """The leading coefficient divided out, the coefficients and the Routh–Hurwitz determinants."""
    a = [reduced(x / a[0]) for x in a]
    n = len(a) - 1

    def entry(i: int, j: int) -> sp.Expr:
        place = 2 * j - i + 1
        return a[place] if 0 <= place <= n else sp.S.Zero

    return [*a[1:], *(sp.Matrix(m, m, entry).det(method="berkowitz") for m in range(2, n))]


def _conjunction(expressions: list[sp.Expr]) -> sp.Basic:
    """All of them positive: positive factors divided out, and what another one implies left out."""
    kept = list(dict.fromkeys(part for e in expressions for part in _essential(e) if not part.is_positive))
    if any(e.is_nonpositive for e in kept):
        return sp.false
    more = {(e, other): sp.Add.make_args(sp.expand(e - other)) for e in kept for other in kept if e != other}
    implied = {e for (e, _), terms in more.items() if all(term.is_nonnegative for term in terms)}
    return sp.And(*(sp.Gt(e, 0) for e in kept if e not in implied))


def _essential(e: sp.Expr) -> list[sp.Expr]:
    """What must be positive for e to be: its factors of odd power together, the squares of the others each."""
    above, below = sp.fraction(sp.together(reduced(e)))
    coefficient, factors = sp.factor_list(above * below)
    odd = [factor for factor, power in factors if power % 2 and not factor.is_positive]
    product = sp.sign(coefficient) * sp.Mul(*odd)
    return [sp.expand(product) if len(odd) == 1 else product, *(f**2 for f, power in factors if power % 2 == 0)]
