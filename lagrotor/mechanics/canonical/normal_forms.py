"""Birkhoff's normal form of a Hamiltonian about an equilibrium, to any order, by Lie series (of orbits: `return_maps`).

In normal coordinates (see `normal_coordinates`) the quadratic part is H₂ = sum_j ω_j z_j w_j + N and

    {H₂, z^a w^b} = D z^a w^b + {N, z^a w^b},     D = i sum_j ω_j (a_j − b_j)   for oscillations.

Degree by degree the terms with D ≠ 0 are removed by exp(L_χ), where {H₂, χ} is the sum of these terms; the transformation is
canonical at every order. The remaining series contains the actions I_j = z_j w_j and the resonant terms, with D = 0 or |D| at
most the `detuning`. N is the quadratic part of modes with rate zero; the normal form is then the Hamiltonian averaged over
all oscillations. Arnold, Mathematical Methods of Classical Mechanics, app. 7; Giorgilli & Galgani, Cel. Mech. 17 (1978) 267;
Deprit, Cel. Mech. 1 (1969) 12.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError, NotExactError, SingularError
from lagrotor.mechanics.canonical.normal_coordinates import element, exact_coordinates, normal_coordinates
from lagrotor.mechanics.canonical.polynomials import (
    Coefficients,
    Exponents,
    Polynomial,
    lie_transform,
    linear_form,
    poisson_bracket,
    polynomial,
    total,
)
from lagrotor.mechanics.canonical.taylor_series import LocalSeries
from lagrotor.result_display import Shown, scientific, text_of

_EQUAL = 1e-9  # of the largest frequency: a smaller divisor counts as zero in floating point
_STEADY = "for a steady motion take the equilibrium of System.routh, for another periodic orbit give its period"
_LARGE = 1e30  # times the first term: growth that no finite series of a nilpotent part has
_SMALL = 1e-16  # of the largest coefficient: smaller terms of a nilpotent part's series are rounding


def _number(value: Any) -> str:
    return text_of(value) if isinstance(value, sp.Expr) else f"{value:.8g}".replace("-", "−")


def _monomial(exponents: Exponents, letters: str) -> str:
    """Return a product of powers as text; the letters share the exponents alike: I₁ I₂², or z₁ w₂."""
    n = len(exponents) // len(letters)
    names = (sp.Symbol(f"{letter}_{j + 1}") for letter in letters for j in range(n))
    return text_of(sp.Mul(*map(sp.Pow, names, exponents))) if any(exponents) else "constant"


@dataclass(frozen=True, eq=False, repr=False)
class NormalForm(Shown):
    """A Hamiltonian H(z, w) in normal form, and the canonical transformation to it.

    Attributes
    ----------
    frequencies : tuple[Any, ...]
        Rate ω_j of each mode in rad/s, negative for negative energy; λ (1/s) of a saddle, 0 of a mode of rate zero.
    series : Polynomial
        H as a polynomial in z_1 … z_n, w_1 … w_n; w_j = z̄_j in floating point, k z̄_j with k > 0 in exact coefficients.
    weights : ndarray
        The brackets {z_j, w_j}, shape (n,): −i of an oscillation, 1 of other modes.
    generators : tuple[Polynomial, ...]
        The functions χ of degree 3, 4, … in the order in which exp(L_χ) act.
    vectors : ndarray or Matrix
        The normal coordinates of H₂: (q, p) − (q₀, p₀) = vectors (z, w), shape (2n, 2n).
    known_through : int
        Degree through which H is transformed.
    error : float
        Largest relative error of the coefficients of one degree in the Hamiltonian that the inverse transformation gives, and
        of the brackets of the normal coordinates; 0 if exact.
    field : Domain, optional
        The field of exact coefficients; None for floating-point numbers.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("theta")
    >>> H = System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0])).hamiltonian()
    >>> sorted(H.normal_form(order=4, at={"theta": 0}).actions.items())
    [((0,), -1), ((1,), 1), ((2,), -1/16)]
    """

    _rate, _unit, _series = "frequency", "rad/s", "H"

    frequencies: tuple[Any, ...]
    series: Polynomial
    weights: Coefficients
    generators: tuple[Polynomial, ...]
    vectors: Any
    known_through: int
    error: float
    field: Any = None

    @property
    def energy_signs(self) -> tuple[int, ...]:
        """The sign of each oscillation's energy, +1 or −1; 0 of a saddle and of a mode of rate zero, length n."""
        negative = [w.could_extract_minus_sign() if isinstance(w, sp.Expr) else w.real < 0 for w in self.frequencies]
        signs = zip(self.weights, negative, strict=True)
        return tuple(0 if self._plain(c) == 1 else -1 if below else 1 for c, below in signs)

    @cached_property
    def actions(self) -> dict[Exponents, Any]:
        """The terms of H in the actions alone: {(m_1 … m_n): coefficient of prod_j I_j^m_j}; m_j = 0 for modes of rate zero."""
        n = len(self.frequencies)
        return {e[:n]: self._real(c) for e, c in self.series.terms.items() if self._is_of_actions(e)}

    @cached_property
    def resonances(self) -> dict[Exponents, Any]:
        """The resonant terms z^a w^b: {(a_1 … a_n, b_1 … b_n): coefficient}."""
        return {e: self._plain(c) for e, c in self.series.terms.items() if not self._is_of_actions(e)}

    def _is_of_actions(self, e: Exponents) -> bool:
        n = len(self.frequencies)
        return e[:n] == e[n:] and not any(m and w == 0 for m, w in zip(e[:n], self.frequencies, strict=True))

    def frequencies_at(self, actions: Sequence[Any]) -> tuple[Any, ...]:
        """Return the frequencies ∂H/∂I_j at given actions, without the resonances.

        Parameters
        ----------
        actions : sequence
            The action of each mode in J s, numbers or expressions.

        Returns
        -------
        tuple[Any, ...]
            Rates in rad/s, numbers or expressions.
        """
        slopes = []
        for j in range(len(self.frequencies)):
            lower = {e: tuple(m - (i == j) for i, m in enumerate(e)) for e in self.actions if e[j]}
            slopes.append(sum(e[j] * self.actions[e] * prod(map(pow, actions, d)) for e, d in lower.items()))
        return tuple(slopes)

    def original(self, f: Polynomial) -> Polynomial:
        """Transform a function of the normal coordinates of H₂ to those of the normal form.

        Parameters
        ----------
        f : Polynomial
            A function of (z, w) of H₂.

        Returns
        -------
        Polynomial
            The same function of the new coordinates, through the order.
        """
        for generator in self.generators:
            f = lie_transform(f, generator, self.weights, self.known_through)
        return f

    def summary(self) -> dict[str, str]:
        """Summarise frequencies, action terms, resonances and error.

        Returns
        -------
        dict[str, str]
            Name → value in words.
        """
        actions = sorted(self.actions.items(), key=lambda term: (sum(term[0]), [-m for m in term[0]]))
        rows = {f"{self._rate} {j + 1} [{self._unit}]": _number(w) for j, w in enumerate(self.frequencies)}
        rows |= {f"{_monomial(e, 'I')} in {self._series}": _number(c) for e, c in actions[:12]}
        resonant = {"resonances": ", ".join(_monomial(e, "zw") for e in self.resonances) or "none"}
        return rows | resonant | {"known through": str(self.known_through), "error": scientific(self.error, 1)}

    def _plain(self, c: Any) -> Any:
        return c if self.field is None else self.field.to_sympy(c)

    def _real(self, c: Any) -> Any:
        if self.field is not None:
            return self._plain(c)
        return complex(c) if any(isinstance(w, complex) for w in self.frequencies) else float(c.real)


def birkhoff(
    H: Polynomial, weights: Coefficients, order: int, detuning: float = 0.0, vectors: Any = None, field: Any = None
) -> NormalForm:
    """Compute the normal form of H(z, w), which begins with sum_j ω_j z_j w_j + N.

    Parameters
    ----------
    H : Polynomial
        The Hamiltonian, with complex coefficients or elements of `field`.
    weights : ndarray
        The brackets {z_j, w_j}, shape (n,): −i of oscillations, 1 of saddles and of modes of rate zero.
    order : int
        Highest degree.
    detuning : float, default 0.0
        Largest |D| in rad/s of a term that is kept as resonant.
    vectors : optional
        The matrix of the normal coordinates of H₂, which the result keeps.
    field : Domain, optional
        The field of the coefficients; None for numbers.

    Returns
    -------
    NormalForm
        The normal form through the order.

    Raises
    ------
    SingularError
        If rates are so small that they count as zero although they are not zero.
    """
    n = len(weights)
    pair = [tuple(int(i in (j, n + j)) for i in range(2 * n)) for j in range(n)]
    zero = 0 * weights[0]
    frequencies = np.array([H.terms.get(e, zero) for e in pair], dtype=weights.dtype)
    rates = weights * frequencies
    plain = [w * frequencies[j] for j, w in enumerate(weights)] if field is None else [field.to_sympy(r) for r in rates]
    has_parameters = field is not None and any(r.free_symbols for r in plain)
    least = 0.0 if has_parameters else max(detuning, _EQUAL * max((abs(complex(r)) for r in plain), default=0.0))

    def split(f: Polynomial) -> tuple[Polynomial, Polynomial, Coefficients]:
        """Return the resonant terms of f, the removable ones, and their divisors D."""
        steps = f.exponents[:, n:] - f.exponents[:, :n]
        D = (steps.astype(weights.dtype) * rates).sum(1)
        if field is None:
            resonant = np.abs(D) <= least
        elif has_parameters or not detuning:
            resonant = ~D.astype(bool)
        else:
            resonant = np.array([abs(complex(field.to_sympy(d))) <= least for d in D], dtype=bool)
        return f.where(resonant), f.where(~resonant), D[~resonant]

    quadratic = H.part(2)
    steady, _, _ = split(quadratic)
    diagonal = np.array([e in set(pair) for e in map(tuple, steady.exponents.tolist())], dtype=bool)
    nilpotent = steady.where(~diagonal)
    K, generators = total([H.part(0), steady, *(H.part(d) for d in range(3, order + 1))]), list[Polynomial]()
    for degree in range(3, order + 1):
        _, removable, D = split(K.part(degree))
        term = generator = removable.over(-D) if len(removable.coefficients) else removable
        first = np.abs(generator.coefficients).max(initial=0) if field is None else 0
        while len(nilpotent.coefficients) and len(term.coefficients):
            _, removable, D = split(poisson_bracket(nilpotent, term, weights, degree))
            term = removable.over(-D) if len(removable.coefficients) else removable
            if field is None:
                if np.abs(term.coefficients).max(initial=0) > _LARGE * first:
                    raise SingularError(
                        "normal_form: some rates are so small beside the largest that they count as zero, and are not: "
                        "change a parameter"
                    )
                term = term.where(np.abs(term.coefficients) > _SMALL * np.abs(generator.coefficients).max())
            generator = generator + term
        generators.append(generator)
        K = lie_transform(K, generator, weights, order)
        resonant, _, _ = split(K.part(degree))  # drops the rounding errors of the removed terms
        K = total([*(term_d for d, term_d in K.parts.items() if d != degree), resonant])
    error = 0.0 if field is not None else _error(H.through(order) - H.part(1), K, generators, weights, order)
    if field is not None:
        values = tuple(field.to_sympy(f) for f in frequencies)
    else:
        values = tuple(complex(f) if abs(f.imag) > 0 else float(f.real) for f in frequencies)
    return NormalForm(values, K, weights, tuple(generators), vectors, order, error, field)


def _error(H: Polynomial, K: Polynomial, generators: Sequence[Polynomial], weights: Coefficients, order: int) -> float:
    for generator in reversed(generators):
        K = lie_transform(K, generator.times(-1), weights, order) if len(generator.coefficients) else K
    sizes = {d: np.abs(H.part(d).coefficients).max(initial=0.0) for d in range(order + 1)}
    differences = {d: float(np.abs(difference.coefficients).max()) for d, difference in (H - K).parts.items()}
    return max((size / max(sizes[d], sizes[2]) for d, size in differences.items()), default=0.0)


def check_form_order(order: int, detuning: float) -> None:
    """Raise InputError for an order below 2 or a negative detuning."""
    if not isinstance(order, int | np.integer) or isinstance(order, bool) or order < 2:
        raise InputError(f"normal_form: order = {order!r} must be a whole number from 2 on")
    if not isinstance(detuning, int | float | np.number) or not 0 <= detuning < np.inf:
        raise InputError(f"normal_form: detuning = {detuning!r} must be a rate from 0 on, in rad/s")


def normal_form_at(
    H: sp.Expr, x: Sequence[sp.Symbol], at: Mapping[sp.Symbol, sp.Expr], order: int, detuning: float = 0.0
) -> NormalForm:
    """Return the normal form of H(x), x = (q_1 … q_n, p_1 … p_n) with canonical brackets, about the equilibrium `at`.

    The form is exact if H has no floating-point number and the frequencies are rational, or rational in the symbols of H.
    Raises InputError if `at` is no equilibrium or symbols need values, DomainError if H is not analytic there, and
    SingularError if a double rate has too few eigenvectors.
    """
    check_form_order(order, detuning)
    parameters = H.free_symbols - {*x} | set().union(*(sp.sympify(v, strict=True).free_symbols for v in at.values()))
    try:
        return _exact(H, x, at, order, detuning)
    except NotExactError as error:
        if parameters:
            names = ", ".join(sorted(map(str, parameters)))
            raise InputError(f"{error}: give {names} values, {{symbol: number, …}}") from None
    plain = _expanded(H, x, at, sp.eye(len(x)), order, lambda e: complex(sp.N(e, 20)), complex)
    slope, curvature = (np.abs(plain.part(n).coefficients).max(initial=0.0) for n in (1, 2))
    if slope > 1e-9 * max(curvature, 1e-300):
        raise InputError(f"normal_form: the point is no equilibrium: ∂H/∂x is not zero there; {_STEADY}")
    return normal_form_of_series(plain, order, detuning)


def normal_form_of_series(H: Polynomial, order: int, detuning: float = 0.0) -> NormalForm:
    """Return the normal form of H(q_1 … q_n, p_1 … p_n), a polynomial with real coefficients and canonical brackets, about 0."""
    n, A = H.variables // 2, np.zeros((H.variables, H.variables))
    for e, c in H.part(2).terms.items():
        i, j = (k for k, m in enumerate(e) for _ in range(m))
        A[i, j] += c.real
        A[j, i] += c.real
    normal = normal_coordinates(A, _symplectic(n))
    rows = [linear_form(row) for row in normal.vectors]
    full = Polynomial(H.exponents, H.coefficients + 0j).through(order).substitute(rows, order)
    quadratic = normal_quadratic(A, normal.vectors, normal.weights, normal.frequencies)
    series = total([quadratic, *(full.part(d) for d in (0, *range(3, order + 1)))])
    form = birkhoff(series, normal.weights, order, detuning, normal.vectors)
    # Close rates that count as equal make the coordinates slightly noncanonical, or H₂ slightly coupled.
    pair, none = np.diag(normal.weights), np.zeros((n, n))
    brackets = normal.vectors @ np.block([[none, pair], [-pair, none]]) @ normal.vectors.T - _symplectic(n)
    discrepancy = np.abs((full.part(2) - quadratic).coefficients).max(initial=0.0) / np.abs(A).max(initial=1e-300)
    return replace(form, error=max(form.error, float(discrepancy), float(np.abs(brackets).max())))


def _symplectic(n: int) -> Any:
    return np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])


def normal_quadratic(A: Any, vectors: Any, weights: Coefficients, frequencies: Coefficients) -> Polynomial:
    """Return ½ x·A x in normal coordinates, without terms that are rounding errors.

    It is the sum of ω_j z_j w_j, and of the products that contain only modes of rate zero.
    """
    n, terms = len(weights), dict[Exponents, complex]()
    B = vectors.T @ A @ vectors / 2
    still = [j for j in range(n) if frequencies[j] == 0]
    for i in (*still, *(n + j for j in still)):
        for j in (*still, *(n + j for j in still)):
            e = tuple(int(k == i) + int(k == j) for k in range(2 * n))
            terms[e] = terms.get(e, 0) + B[i, j]
    largest = max(np.abs(B).max(), 1e-300)
    terms = {e: c for e, c in terms.items() if abs(c) > 1e-11 * largest}
    for j, frequency in enumerate(frequencies):
        if frequency:
            terms[tuple(int(k in (j, n + j)) for k in range(2 * n))] = frequency
    return polynomial(terms, 2 * n)


def _exact(
    H: sp.Expr, x: Sequence[sp.Symbol], at: Mapping[sp.Symbol, sp.Expr], order: int, detuning: float
) -> NormalForm:
    if H.has(sp.Float) or any(sp.sympify(v, strict=True).has(sp.Float) for v in at.values()):
        raise NotExactError("normal_form: the Hamiltonian has floating-point numbers")
    n = len(x) // 2
    slope, A = sp.zeros(len(x), 1), sp.zeros(len(x), len(x))
    for e, c in _expanded(H, x, at, sp.eye(len(x)), 2, sp.expand, object).terms.items():
        where = [k for k, m in enumerate(e) for _ in range(m)]
        if len(where) == 1:
            slope[where[0]] += c
        elif where:
            A[where[0], where[1]] += c
            A[where[1], where[0]] += c
    answers = {decide_zero(e).answer for e in slope}
    if "nonzero" in answers:
        raise InputError(f"normal_form: {dict(at)} is no equilibrium: ∂H/∂x = {list(slope)} there; {_STEADY}")
    if "undecided" in answers:
        raise NotExactError(f"normal_form: whether ∂H/∂x = {list(slope)} is zero at {dict(at)} is not decided")
    bracket = sp.Matrix(sp.BlockMatrix([[sp.zeros(n), sp.eye(n)], [-sp.eye(n), sp.zeros(n)]]))
    parameters = H.free_symbols - {*x} | A.free_symbols
    normal = exact_coordinates(A, bracket, parameters)

    def value(e: sp.Expr) -> Any:
        return element(normal.field, sp.sympify(e, strict=True))

    full = _expanded(H, x, at, normal.vectors, order, value, object)
    pair = [tuple(int(k in (j, n + j)) for k in range(2 * n)) for j in range(n)]
    if set(full.part(2).terms) != set(pair):
        raise NotExactError("normal_form: the quadratic part is not diagonal")
    weights = np.empty(n, dtype=object)
    weights[:] = [value(-sp.I)] * n
    return birkhoff(full, weights, order, detuning, normal.vectors, normal.field)


def _expanded(
    H: sp.Expr,
    x: Sequence[sp.Symbol],
    at: Mapping[sp.Symbol, sp.Expr],
    vectors: Any,
    order: int,
    value: Callable[[sp.Expr], Any],
    kind: Any,
) -> Polynomial:
    """Return H at x = at + vectors y as a polynomial in y; `value` makes its coefficients from numbers of sympy."""
    convert = value if kind is object else complex
    displacements = {s: linear_form([convert(vectors[k, j]) for j in range(len(x))], kind) for k, s in enumerate(x)}
    return LocalSeries(at, displacements, order, value).of(H)
