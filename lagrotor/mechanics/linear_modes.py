"""The linear system of small motion, M a + C v + K q = 0, its modes, and the condition of its stability.

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
from lagrotor.result_display import Shown, ShownInOneLine

_S = sp.Symbol("s")


@dataclass(frozen=True, repr=False)
class Mode(ShownInOneLine):
    """A solution Re(shape exp(rate t)) of a linear system.

    Attributes
    ----------
    rate : Expr
        Complex rate in 1/s, i ω for an undamped oscillation.
    shape : Matrix
        Complex amplitudes of all n coordinates, shape (n, 1), up to a common factor.
    """

    _shown = (
        ("rate [1/s]", "rate"),
        ("shape", lambda mode: _scaled(mode.shape)),
    )

    rate: sp.Expr
    shape: sp.Matrix


def _scaled(shape: sp.Matrix) -> sp.Matrix:
    """Return a numeric shape with the largest component 1, and a symbolic one without the factors that all components have."""
    if not shape.free_symbols:
        return shape.evalf() / max((complex(x) for x in shape), key=abs)
    return shape / sp.Mul(*set.intersection(*({*sp.Mul.make_args(x)} for x in shape if x != 0)))


@dataclass(frozen=True, repr=False)
class LinearSystem(Shown):
    """The linear system M a + C v + K q = 0 in d independent small coordinates.

    Attributes
    ----------
    mass : Matrix
        Mass matrix M, shape (d, d).
    gyroscopic : Matrix
        Matrix C of gyroscopic forces and friction, shape (d, d).
    stiffness : Matrix
        Matrix K of conservative and nonconservative forces, shape (d, d).
    basis : Matrix
        Change of all n coordinates per unit of each independent coordinate, shape (n, d).

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x")
    >>> oscillator = System(c, c.v[0] ** 2 / 2 - 9 * c.q[0] ** 2 / 2).linearise({"x": 0})
    >>> [mode.rate for mode in oscillator.modes()], oscillator.stable_if
    ([-3*I, 3*I], True)
    """

    _shown = (
        ("equations", lambda _: "M a + C v + K q = 0"),
        ("M", "mass"),
        ("C", "gyroscopic"),
        ("K", "stiffness"),
    )

    mass: sp.Matrix
    gyroscopic: sp.Matrix
    stiffness: sp.Matrix
    basis: sp.Matrix

    def characteristic(self, s: sp.Symbol) -> sp.Expr:
        """Return the characteristic polynomial det(s² M + s C + K), factored.

        Parameters
        ----------
        s : Symbol
            The rate.

        Returns
        -------
        Expr
            A polynomial in s of degree 2 d.
        """
        return sp.factor(self._pencil(s).det(method="berkowitz"))

    def _pencil(self, s: sp.Expr) -> sp.Matrix:
        return s**2 * self.mass + s * self.gyroscopic + self.stiffness

    def modes(self, values: Mapping[sp.Symbol, Any] | None = None) -> tuple[Mode, ...]:
        """Return the modes, in closed form or in numbers.

        Parameters
        ----------
        values : mapping, optional
            {symbol: number} for every symbol. Without values each factor of the characteristic polynomial must have degree at
            most two in s or in s².

        Returns
        -------
        tuple[Mode, ...]
            The exact modes, or with values the numeric ones, by ascending absolute rate.

        Raises
        ------
        InputError
            When no closed form exists, or a symbol has no value.
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
        """Return the null vectors at a root: a nonzero column of the adjugate, else a basis of the null space."""
        pencil = self._pencil(rate).applyfunc(reduced)
        columns = [pencil.adjugate()[:, j] for j in range(pencil.cols)]
        column = next((column for column in columns if not all(map(is_identically_zero, column))), None)
        return [column] if column is not None else list(pencil.nullspace(iszerofunc=is_identically_zero))

    def _numeric_modes(self, values: Mapping[sp.Symbol, Any]) -> tuple[Mode, ...]:
        import numpy as np

        matrices = (self.mass, self.gyroscopic, self.stiffness, self.basis)
        numeric = [m.subs(by_symbol("modes: values", values, m.free_symbols)) for m in matrices]
        no_letter("modes", set().union(*(m.free_symbols for m in numeric)))
        M, C, K, basis = (np.array(m.tolist(), dtype=float) for m in numeric)
        d = len(M)
        below = np.linalg.solve(M, np.hstack([-K, -C]))
        rates, vectors = np.linalg.eig(np.vstack([np.hstack([np.zeros((d, d)), np.eye(d)]), below]))
        order = sorted(range(2 * d), key=lambda i: (round(float(abs(rates[i])), 9), rates[i].imag))
        return tuple(Mode(sp.sympify(complex(rates[i]), strict=True), sp.Matrix(basis @ vectors[:d, i])) for i in order)

    @property
    def stable_if(self) -> sp.Basic:
        """The condition on the parameters under which every mode stays bounded or decays, a sympy relation.

        The condition is sufficient, and necessary except on its boundary. If det(s² M + s C + K) is even in s, the roots s²
        must be real, negative and distinct: the coefficients and the Hankel minors of the power sums are positive. Without
        gyroscopic forces roots may coincide. If the polynomial is not even, its even factors satisfy this condition, and its
        other factors have positive Routh–Hurwitz determinants.

        Factors that are positive by the assumptions are divided out, and an eigenvalue shared by independent modes counts
        once. Zero roots are allowed if they belong to neighbouring equilibria or to drifts at constant velocity. Growth as t²
        gives False.
        """
        natural = all(map(is_identically_zero, (*self.gyroscopic, *(self.stiffness - self.stiffness.T))))
        return sp.false if self._zeros > max(2, self._drifts) else stability_condition(self._pencil(_S), _S, natural)

    @property
    def _zeros(self) -> int:
        """The multiplicity of the root s = 0 of det(s² M + s C + K)."""
        coefficients = sp.Poly(sp.numer(sp.together(self._pencil(_S).det(method="berkowitz"))), _S).all_coeffs()
        return next(i for i, e in enumerate(reversed(coefficients)) if not is_identically_zero(e))

    @property
    def _drifts(self) -> int:
        """The number of independent solutions q₀ + v t: equilibria with K q₀ = 0, drifts with K v = 0 and K q₀ + C v = 0."""
        K = self.stiffness
        right, left_null = (m.nullspace(iszerofunc=is_identically_zero) for m in (K, K.T))
        coupled = sp.Matrix(len(left_null), len(right), lambda i, j: left_null[i].dot(self.gyroscopic * right[j]))
        return 2 * len(right) - int(coupled.rank(iszerofunc=is_identically_zero))


def stability_condition(pencil: sp.Matrix, s: sp.Symbol, natural: bool = False) -> sp.Basic:
    """Return the condition of stability for the roots s of det(pencil) = 0, as `LinearSystem.stable_if` describes it.

    `natural` says that the pencil is s² M + K with symmetric M and K.
    """
    pencil = pencil.applyfunc(lambda e: e.xreplace({x: sp.Rational(x) for x in e.atoms(sp.Float)}))
    factors = _last_invariant(pencil, s)
    products = [sp.Mul(*factors)]
    if not _is_even(products[0], s):
        products = [sp.Mul(*(f for f in factors if _is_even(f, s) is even)) for even in (True, False)]
    conditions: list[sp.Expr] = []
    for product in products:
        coefficients = _coefficients(product, s)
        if natural:
            conditions += [reduced(x / coefficients[0]) for x in coefficients[2::2]]
        else:
            conditions += _all_negative(coefficients[::2]) if _is_even(product, s) else _hurwitz(coefficients)
    return _conjunction(conditions)


def _coefficients(e: sp.Expr, s: sp.Symbol) -> list[sp.Expr]:
    """Return the coefficients of a polynomial in s, the highest first, without its zero roots."""
    coefficients = [reduced(c) for c in sp.Poly(e, s).all_coeffs()]
    while is_identically_zero(coefficients[-1]):
        coefficients.pop()
    return coefficients


def _is_even(e: sp.Expr, s: sp.Symbol) -> bool:
    return all(is_identically_zero(c) for c in _coefficients(e, s)[1::2])


def _last_invariant(pencil: sp.Matrix, s: sp.Symbol) -> list[sp.Expr]:
    """Return the factors of the last invariant polynomial, in which a root s is repeated only if a motion grows as t exp(s t).

    The common divisor of the minors of order n − 1 is divided out. Gantmacher, vol. 1, ch. VI.
    """
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
    """Return a shorter equal form, which is unique for an expression that has a normal form."""
    try:
        return sp.factor(normal_form(e))
    except NotExactError:
        return sp.factor(e)


def is_identically_zero(e: sp.Expr) -> bool:
    return e == 0 or decide_zero(e).answer == "zero"


def _roots(factor: sp.Poly) -> list[sp.Expr]:
    """Return the roots of a factor of degree one or two in s or in s²."""
    s = factor.gen
    if factor.degree() <= 2:
        return list(sp.roots(factor, multiple=True))
    even = all(power % 2 == 0 for (power,) in factor.monoms())
    if even and factor.degree() == 4:
        squares = sp.roots(sp.Poly(factor.as_expr().subs(s, sp.sqrt(s)), s), multiple=True)
        return [sign * sp.sqrt(square) for square in squares for sign in (1, -1)]
    raise InputError(
        f"modes: {factor.as_expr()} = 0 is not solved in closed form: modes(values={{symbol: number, …}}) gives numbers"
    )


def _all_negative(a: list[sp.Expr]) -> list[sp.Expr]:
    """Return the expressions whose positivity makes all roots of a_0 x^n + … + a_n real, negative and distinct."""
    a = [reduced(x / a[0]) for x in a]
    n = len(a) - 1
    sums: list[sp.Expr] = [sp.Integer(n)]
    for k in range(1, 2 * n - 1):  # Newton's identities
        total = sum((a[i] * sums[k - i] for i in range(1, min(k, n + 1)) if i <= n), sp.S.Zero)
        sums.append(-total - (k * a[k] if k <= n else 0))
    hankel = [sp.Matrix(m, m, lambda i, j: sums[i + j]).det(method="berkowitz") for m in range(2, n + 1)]
    return [*a[1:], *hankel]


def _hurwitz(a: list[sp.Expr]) -> list[sp.Expr]:
    """Return expressions that are all positive exactly if all roots of a_0 x^n + … + a_n have negative real parts.

    They are the ratios a_i/a_0 and the Routh–Hurwitz determinants.
    """
    a = [reduced(x / a[0]) for x in a]
    n = len(a) - 1

    def entry(i: int, j: int) -> sp.Expr:
        place = 2 * j - i + 1
        return a[place] if 0 <= place <= n else sp.S.Zero

    return [*a[1:], *(sp.Matrix(m, m, entry).det(method="berkowitz") for m in range(2, n))]


def _conjunction(expressions: list[sp.Expr]) -> sp.Basic:
    """Return the relation that all expressions are positive. Factors known as positive and implied conditions are left out."""
    positive = list(dict.fromkeys(factor for e in expressions for factor in _essential(e) if not factor.is_positive))
    if any(e.is_nonpositive for e in positive):
        return sp.false
    differences = {(e, f): sp.Add.make_args(sp.expand(e - f)) for e in positive for f in positive if e != f}
    implied = {e for (e, _), terms in differences.items() if all(term.is_nonnegative for term in terms)}
    return sp.And(*(sp.Gt(e, 0) for e in positive if e not in implied))


def _essential(e: sp.Expr) -> list[sp.Expr]:
    """Return simpler expressions that are all positive exactly if e is positive.

    They are the product of the factors with an odd power, and the square of each factor with an even power.
    """
    above, below = sp.fraction(sp.together(reduced(e)))
    coefficient, factors = sp.factor_list(above * below)
    odd = [factor for factor, power in factors if power % 2 and not factor.is_positive]
    product = sp.sign(coefficient) * sp.Mul(*odd)
    return [sp.expand(product) if len(odd) == 1 else product, *(f**2 for f, power in factors if power % 2 == 0)]
