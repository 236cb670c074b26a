"""The Hamiltonian of a structure about upright as a polynomial through any order, derived from its exact Lagrangian.

With u = (x, y) of the axes, z = sqrt(1 − x² − y²), q the degrees of freedom with the bars, and p their momenta,

    L = ½ sum_ij A_ij r_i'·r_j' − sum_i G_i (x_i y_i' − y_i x_i')/(1 + z_i) − V,       H = ½ (p − a)·m⁻¹ (p − a) + V.

The second sum belongs to the spins and gives the torque G_i r_i × r_i'. A bar along n_b determines the combination s_b =
n_b·(R_i u_i − R_j u_j) of tilts: its constraint |d|² = ℓ² gives s_b as a series in q. Then u = Z q + rows⁺ s(q), with the
pseudo-inverse of the bars' rows. The iteration s ← s + (|d|² − ℓ²)/2ℓ gains one order per step.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np
from scipy.special import binom

from lagrotor.errors import InputError
from lagrotor.mechanics.canonical.polynomials import (
    Polynomial,
    constant,
    inverse_matrix,
    linear_form,
    polynomial,
    total,
    variable,
)
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Coefficients, coefficients
from lagrotor.structures.small_motion import bar_rows, check_upright, small_motion

Row = list[Polynomial]


@dataclass(frozen=True, eq=False)
class LocalHamiltonian:
    """The Hamiltonian about upright as a polynomial in q = basisᵀ u and p/(inertia rate).

    The unit of inertia is the largest entry of the mass matrix.

    - `powers`: three polynomials with H/(inertia rate²) = powers[0] + f powers[1] + f² powers[2], where f multiplies all spins.
    - `basis`: the basis of `small_motion`, (2N, n).
    - `mass`: the mass matrix upright in units of inertia, (n, n).
    - `rate`: the unit of rate, rad/s.
    - `axes`: the components x, y, z of each axis as polynomials in q.
    """

    powers: tuple[Polynomial, Polynomial, Polynomial]
    basis: Array
    mass: Array
    rate: float
    axes: list[Row]

    def at_spins(self, factor: float) -> Polynomial:
        """Return the Hamiltonian with all spins multiplied by a factor."""
        return total([self.powers[0], *(self.powers[k].times(factor**k) for k in (1, 2) if factor)])


@lru_cache(maxsize=16)
def local_hamiltonian(s: Assembly, order: int = 4) -> LocalHamiltonian:
    """Expand the Hamiltonian about upright.

    Parameters
    ----------
    s : Assembly
        The structure, without friction.
    order : int, default 4
        The highest degree of the polynomial.

    Returns
    -------
    LocalHamiltonian
        The polynomial with its basis and units.
    """
    check_upright(s, "local_hamiltonian")
    linear, c = small_motion(s), coefficients(s)
    if linear.damping.any() or c.decay.any():
        raise InputError(
            "local_hamiltonian: friction acts, and only motion without friction has a Hamiltonian: set it to zero"
        )
    n = linear.dof
    pseudo_inverse = np.linalg.pinv(bar_rows(c))
    axes = on_bars(  # polynomials in q, exact through order − 1 in x and y
        c,
        [linear_form(row, float) for row in linear.basis],
        lambda u: [axis_of(u[k : k + 2], order) for k in range(0, len(u), 2)],
        lambda bound: [combined(row, bound) for row in pseudo_inverse],
        order,
    )
    inertia = float(np.abs(linear.mass).max())
    rate = float(np.sqrt(np.abs(linear.stiffness).max() / inertia)) or c.rate
    J = [[[f.derivative(b) for f in axis] for b in range(n)] for axis in axes]
    mass = _mass(c, J, order - 2, inertia)
    spinning = [(i, axis, -c.G[i] / (inertia * rate)) for i, axis in enumerate(axes) if c.G[i]]
    vector = [
        total([turned(axis, J[i][b], order - 1).times(G) for i, axis, G in spinning] or [_none(n)]) for b in range(n)
    ]
    V = potential_of(c, axes, order).times(1 / (inertia * rate**2))
    inverse = inverse_matrix(mass, order - 2)
    momenta = [variable(n + b, 2 * n, kind=float) for b in range(n)]
    rows = [[_lifted(f) for f in row] for row in inverse]
    a = [_lifted(f) for f in vector]
    by_p = [total([rows[i][j].product(momenta[j], order - 1) for j in range(n)]) for i in range(n)]
    by_a = [total([rows[i][j].product(a[j], order - 1) for j in range(n)]) for i in range(n)]
    terms = (
        total([*(momenta[i].product(by_p[i], order) for i in range(n)), _lifted(V).times(2.0)]).times(0.5),
        total([a[i].product(by_p[i], order) for i in range(n)]).times(-1.0),
        total([a[i].product(by_a[i], order) for i in range(n)]).times(0.5),
    )
    return LocalHamiltonian(terms, linear.basis, linear.mass / inertia, rate, axes)


def on_bars(
    c: Coefficients, free: Row, axes_of: Callable[[Row], list[Row]], closing: Callable[[Row], Row], order: int
) -> list[Row]:
    """Return x, y, z of all axes as polynomials with which the bars keep their lengths through an order. The tilts are u = free
    + rows⁺ s, and an iteration determines s. `axes_of` maps u to the axes, `closing` maps s to rows⁺ s."""
    bound, axes = [_none(free[0].variables)] * len(c.i), axes_of(free)
    for _ in range(2, order) if bound else ():
        bound = [f + over_length(c, axes, b, order - 1) for b, f in enumerate(bound)]
        axes = axes_of([f + g for f, g in zip(free, closing(bound), strict=True)])
    return axes


def combined(numbers: Array | Sequence[float], row: Row) -> Polynomial:
    """Return the linear combination sum_k numbers_k row_k of polynomials."""
    return total(
        [f.times(number) for number, f in zip(numbers, row, strict=True) if number] or [_none(row[0].variables)]
    )


def axis_of(xy: Row, order: int) -> Row:
    """Return x, y and z = sqrt(1 − x² − y²) of an axis through an order, from the polynomials x and y."""
    return [*xy, of_square(xy, [float(binom(0.5, k) * (-1) ** k) for k in range(order // 2 + 1)], order)]


def of_square(xy: Row, series: list[float], order: int) -> Polynomial:
    """Return the polynomial sum_k series_k (x² + y²)^k through an order."""
    square = xy[0].product(xy[0], order) + xy[1].product(xy[1], order)
    result = constant(series[-1], square.variables, float)
    for value in reversed(series[:-1]):
        result = result.product(square, order) + constant(value, square.variables, float)
    return result


def over_length(c: Coefficients, axes: list[Row], b: int, order: int) -> Polynomial:
    """Return (|d|² − ℓ²)/2ℓ of bar b through an order, in m: to first order the excess of its length."""
    i, j = c.i[b], c.j[b]
    upright = c.feet[j] - c.feet[i]
    d = [
        axes[j][k].times(c.R[j]) - axes[i][k].times(c.R[i]) + constant(upright[k], axes[i][k].variables, float)
        for k in range(3)
    ]
    square = total([component.product(component, order) for component in d])
    return (square - constant(c.ell[b] ** 2, square.variables, float)).times(0.5 / c.ell[b])


def turned(axis: Row, slope: Row, order: int) -> Polynomial:
    """Return (x ∂y − y ∂x)/(1 + z) of an axis, whose derivatives ∂x, ∂y are in `slope`, through an order. The factor 1/(1 + z)
    = (1 − z)/(x² + y²) is a series in x² + y²."""
    series = [float(-binom(0.5, k + 1) * (-1) ** (k + 1)) for k in range(order // 2 + 1)]
    around = axis[0].product(slope[1], order) - axis[1].product(slope[0], order)
    return around.product(of_square(axis[:2], series, order), order)


def _mass(c: Coefficients, J: list[list[Row]], order: int, inertia: float) -> list[Row]:
    """Return the mass matrix m_ab = sum_ij A_ij ∂_a r_i·∂_b r_j in units of `inertia`, with ∂_b r_i in J[i][b]."""
    n = len(J[0])
    pairs = [(i, i, value) for i, value in enumerate(c.A)]
    pairs += [
        (i, j, value)
        for first, second, value in zip(c.i, c.j, c.coupling, strict=True)
        if value
        for i, j in ((first, second), (second, first))
    ]
    m = [[_none(n)] * n for _ in range(n)]
    for a in range(n):
        for b in range(a, n):
            terms = [
                f.product(g, order).times(value / inertia)
                for i, j, value in pairs
                for f, g in zip(J[i][a], J[j][b], strict=True)
            ]
            m[a][b] = m[b][a] = total(terms)
    return m


def potential_of(c: Coefficients, axes: list[Row], order: int) -> Polynomial:
    """Return the energy of weight, hinges κ θ²/2 with θ = asin sqrt(x² + y²), and braces k (|d| − d₀)²/2. The polynomial in q
    goes through an order. Its value upright is subtracted."""
    squares = [0.0] + [4.0**k / (2 * k**2 * comb(2 * k, k)) for k in range(1, order // 2 + 1)]
    terms = [_none(axes[0][0].variables)]
    for i, axis in enumerate(axes):
        terms += [axis[2].times(c.gravity * c.S[i])] if c.gravity * c.S[i] else []
        terms += [of_square(axis[:2], squares, order).times(c.hinge[i] / 2)] if c.hinge[i] else []
    for b, (tip, to) in enumerate(zip(c.brace_tip, c.brace_to, strict=True)):
        if not c.stiffness[b]:
            continue
        n = axes[0][0].variables
        place = c.feet[tip] - (c.feet[to] if to >= 0 else c.brace_point[b])
        d = [axes[tip][k].times(c.R[tip]) + constant(place[k], n, float) for k in range(3)]
        d = [d[k] - axes[to][k].times(c.R[to]) for k in range(3)] if to >= 0 else d
        longer = (
            total([component.product(component, order) for component in d]) - constant(c.brace_length[b] ** 2, n, float)
        ).times(1 / c.brace_length[b] ** 2)
        stretch, power = _none(n), longer
        for k in range(1, order + 1):
            stretch, power = (
                stretch + power.times(float(binom(0.5, k)) * c.brace_length[b]),
                power.product(longer, order),
            )
        terms.append(stretch.product(stretch, order).times(c.stiffness[b] / 2))
    V = total(terms)
    return V - V.part(0)


def _none(n: int) -> Polynomial:
    return polynomial({}, n, float)


def _lifted(f: Polynomial) -> Polynomial:
    """Return a polynomial in q as a polynomial in (q, p) that does not depend on p."""
    return Polynomial(np.hstack([f.exponents, np.zeros_like(f.exponents)]), f.coefficients)
