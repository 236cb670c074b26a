"""Resonances by which a structure that its spins stabilise is unstable, and the pushes that they need.

A position that spins hold against weight has modes of both signs of energy, H = sum_j ω_j |z_j|² + …, with ω_j < 0 for the
negative ones. Let k·ω = δ be small for integers k_j ≥ 0 with the sum d. The terms of degree d of the normal form, 2 Re P with P
of degree d in z alone, then feed all modes with k_j > 0 at once. With N = sum |z_j|² over these modes and c the largest |P| at
N = 1,

    |dN/dt| ≤ 2 d c N^(d/2):   no motion from N = ρ² topples before  t = 1/(d (d − 2) c ρ^(d−2)),

and a motion along the steepest direction topples at this time. Off resonance δ N/d + K_d is conserved, where K_d collects all
terms of degree d. With κ the largest value of K_d at N = 1, no start below ρ passes the barrier of δ N/d − κ N^(d/2) if

    |δ| > ½ d² κ (ρ²/x)^((d−2)/2),     x + (2/d) x^(d/2) = 1 − 2/d:    |δ| > 18 c ρ for d = 3.

The case d = 3 is that of Cherry, Trans. Camb. Phil. Soc. 23 (1925) 199. For d = 4 the terms in the actions may stop the growth:
a vector k is unstable if 2 |P| > |K_4 − 2 Re P| along |z_j|² ∝ k_j. Modes of equal rates may be combined in any basis.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations_with_replacement
from math import inf, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics.canonical.normal_forms import NormalForm, normal_form_of_series
from lagrotor.mechanics.canonical.polynomials import Polynomial, lie_transform, polynomial, variable
from lagrotor.numerics.arrays import finite_array
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Complex
from lagrotor.structures.critical_spins import spin_threshold
from lagrotor.structures.small_motion import WIDEST, SmallMotion, check_upright, small_motion
from lagrotor.structures.upright_hamiltonian import local_hamiltonian

MOST_DOF = 8  # limit of the expansion through fourth order
_BARRIER = {3: 0.25, 4: sqrt(2) - 1}  # x of the module: (ρ/ρ_barrier)² of the largest bounded start
_NEAR = 0.25  # relative to the largest rate: the largest detuning
_GROUP = 4.0  # times the least detuning: the largest detuning of a group
_NEGLIGIBLE = 1e-9  # relative to the largest coefficient: smaller ones are zero
_FALLEN = 1.0  # the sine of a tilt
_TRUSTED = 0.1  # the sine of a tilt
_EQUAL = 1e-6  # relative difference of equal rates
_ON_BARS = 1e-6  # relative to the largest rate: the bars do not allow more
_STOPPED = "no: terms of the same order stop the growth, at an unknown amplitude"
_CHECKED = 1 / 32  # relative to the distance from the critical factor: the error of an end
_FASTEST = 300.0  # times the critical factor: the end of the search
_TOP = 12.0  # times the critical factor: above, fast rates exceed three slow ones


@dataclass(frozen=True, eq=False, repr=False)
class Resonance(Shown):
    """A resonance of order 3 or 4 that feeds modes of both signs of energy, or slow modes of nearly zero rate.

    The size of a push is the root of the sum of squares of the rates of all axes at the start, in rad/s. All axes start upright.

    - `order`: the order, 3 or 4.
    - `vectors`: the integer vectors k with one number per mode, the vector nearest to resonance first.
    - `rates`: the rates of the modes, (n,), rad/s, negative for modes of negative energy.
    - `at`: the factor on all spins at which these rates hold.
    - `detuning`: the detuning k·rates of the first vector, rad/s.
    - `per_factor`: the derivative of the detuning with respect to the factor on all spins, rad/s.
    - `growth`: the coefficient c of the module, 1/s, for N = (reach × push)².
    - `largest`: the coefficient κ of the module, 1/s.
    - `reach`: the ratio sqrt(N)/push in the steepest direction, s.
    - `falls`: True if the terms of the same order do not stop the growth.
    """

    order: int
    vectors: tuple[tuple[int, ...], ...]
    rates: Array
    at: float
    detuning: float
    per_factor: float
    growth: float
    largest: float
    reach: float
    falls: bool

    @property
    def factor(self) -> float:
        """The factor on all spins at which the detuning vanishes, by linear extrapolation."""
        return self.at - self.detuning / self.per_factor if self.per_factor else inf

    @property
    def resonant(self) -> bool:
        """True if the detuning is below half of every rate in the resonance. If not, a push topples only over the barrier."""
        return 2 * abs(self.detuning) < np.abs(self.rates[np.array(self.vectors[0]) > 0]).min()

    def push(self) -> float:
        """Return the size (rad/s) below which no push topples the structure by this resonance."""
        d = self.order
        barrier = (2 * abs(self.detuning) / (d * d * self.largest)) ** (1 / (d - 2))
        return float(sqrt(_BARRIER[d]) * barrier / self.reach)

    def window(self, push: float) -> tuple[float, float]:
        """Return the factors (low, high) on all spins between which a push (rad/s) may topple the structure, extrapolated."""
        d, x = self.order, _BARRIER[self.order]
        half = d * d * self.largest / 2 * (self.reach * push / sqrt(x)) ** (d - 2) / abs(self.per_factor)
        return float(self.factor - half), float(self.factor + half)

    def least_time(self, push: float) -> float:
        """Return the time (s) before which no push of a given size (rad/s) topples the structure. At exact resonance a push of
        this size in the steepest direction takes exactly this time."""
        d = self.order
        return 1 / (d * (d - 2) * self.growth * (self.reach * push) ** (d - 2))

    def words(self) -> str:
        """Return the relation of the rates in words."""
        terms = [(m, abs(w), bool(w < 0)) for m, w in zip(self.vectors[0], self.rates, strict=True) if m]
        sides = [
            " + ".join(f"{f'{m} × ' if m > 1 else ''}{w:.4g}" for m, w, below in terms if below is side)
            for side in (False, True)
        ]
        if not all(sides):
            return f"{sides[0] or sides[1]} is small compared with {np.abs(self.rates).max():.4g} rad/s"
        return f"{sides[0]} = {sides[1]} rad/s but for {abs(self.detuning):.2g}"

    def summary(self) -> dict[str, str]:
        """Return the relation of the rates, the strength and the factor in words."""
        return {
            "rates": self.words(),
            "order": str(self.order),
            "at the factor on all spins": f"{self.factor:.6g}",
            "coefficient": f"{self.growth:.4g} 1/s",
            "falls": f"from {self.push():.3g} rad/s on" if self.falls else _STOPPED,
        }


def signed_rates(linear: SmallMotion, factor: float = 1.0) -> Array:
    """Return the rates ω_j, ascending, rad/s, negative for modes of negative energy; no rates if a mode grows or is neutral."""
    scaled = linear.at_spins(factor)
    roots, vectors = scaled.waves
    if scaled.growth > 0 or not roots.imag.all():
        return np.zeros(0)
    turning = roots.imag > 0
    return np.sort(scaled.energy_signs(roots[turning], vectors[:, turning]) * roots[turning].imag)


def resonances(s: Assembly, factor: float = 1.0, orders: Sequence[int] = (3, 4)) -> tuple[Resonance, ...]:
    """Return the resonances near the spins times a factor: see `Structure.resonances`."""
    check_upright(s, "resonances")
    finite_array("resonances: factor", factor, ())
    linear = small_motion(s)
    rates = signed_rates(linear, factor)
    if not len(rates):
        raise InputError("resonances: a mode grows or has the rate zero, and no resonance is defined: change spins")
    if not (rates[0] < 0 < rates[-1]):
        return ()
    if linear.dof > MOST_DOF:
        raise InputError(f"resonances: {linear.dof} degrees of freedom are too many to expand: at most {MOST_DOF}")
    slowest, fastest = np.abs(rates).min(), np.abs(rates).max()
    if fastest > WIDEST * slowest:
        raise SingularError(
            f"resonances: the fastest rate, {fastest:.3g} rad/s, is more than 10⁶ times the slowest, {slowest:.1g} rad/s, which "
            "rounding hides: take slower spins"
        )
    slope = _slopes(linear, factor)
    candidates = [r for d in orders for r in _of_order(s, rates, slope, factor, d)]
    return tuple(sorted(candidates, key=lambda r: r.push() if r.falls else inf))


def first_resonance(s: Assembly) -> Resonance | None:
    """Return the resonance that needs the smallest push; None if there is none."""
    return next((r for r in resonances(s) if r.falls), None)


def _of_order(s: Assembly, rates: Array, slopes: Array, factor: float, order: int) -> Iterator[Resonance]:
    """Yield the resonances of one order. Each collects the vectors k whose detunings k·rates are similar."""
    h = local_hamiltonian(s)
    pushed = start_of_push(s)
    vectors = sorted(_vectors(rates, order), key=lambda k: abs(np.dot(k, rates)))
    while vectors:
        least = max(abs(np.dot(vectors[0], rates)), 1e-9 * rates[-1])
        group = [k for k in vectors if abs(np.dot(k, rates)) <= _GROUP * least]
        vectors = [k for k in vectors if k not in group]
        n = normal_form_of(s, factor, max(abs(np.dot(k, rates)) for k in group) / h.rate * 1.001, order)
        resonance = _resonance(n, h.rate, pushed, group, rates, slopes, factor)
        if resonance:
            yield resonance


def start_of_push(s: Assembly) -> Array:
    """Return (q, p) after a push of 1 rad/s along each degree of freedom, (2n, n), in the units of `LocalHamiltonian`."""
    h = local_hamiltonian(s)
    return np.vstack([np.zeros_like(h.mass), h.mass / h.rate])


def _vectors(rates: Array, order: int) -> list[tuple[int, ...]]:
    """Return the integer vectors k with k_j ≥ 0, the sum `order` and small k·rates. Vectors of slow modes alone are included,
    because these modes grow by the same law."""
    near, n = _NEAR * np.abs(rates).max(), len(rates)
    combinations = combinations_with_replacement(range(n), order)
    return [tuple(c.count(j) for j in range(n)) for c in combinations if abs(rates[list(c)].sum()) < near]


def _resonance(
    n: NormalForm, unit: float, pushed: Array, group: list[tuple[int, ...]], rates: Array, slopes: Array, at: float
) -> Resonance | None:
    """Return the resonance of a group of vectors k; None if the normal form has no terms for these vectors."""
    size, order, place = len(rates), sum(group[0]), np.argsort(np.real(n.frequencies), kind="stable")
    vectors = [tuple(int(k[i]) for i in np.argsort(place)) for k in group]  # in the order of the normal form's modes
    modes = np.any(vectors, axis=0)
    terms = n.series.part(order)
    terms = terms.where(terms.exponents[:, np.tile(~modes, 2)].sum(1) == 0)
    up = terms.where(np.array([tuple(e[:size]) in vectors and not e[size:].any() for e in terms.exponents], dtype=bool))
    scale = np.abs(n.series.coefficients).max()
    if not len(up.coefficients) or np.abs(up.coefficients).max() < _NEGLIGIBLE * scale:
        return None
    groups = _of_equal_rates(np.real(n.frequencies))
    different = {tuple(sum(k[j] for j in g) for g in groups): k for k in vectors}.values()
    falls = order == 3 or any(_outweighs(terms, k, groups) for k in different)
    nearest = min(group, key=lambda k: abs(np.dot(k, rates)))
    over = np.linalg.inv(n.vectors)[:size][modes] @ pushed
    growth, *bounds = (
        -unit * _least(f, modes[None], np.ones(1)) for f in (up, *([terms, terms.times(-1)] * (order == 4)))
    )
    return Resonance(
        order, tuple(sorted(group, key=lambda k: abs(np.dot(k, rates)))), rates, at, float(np.dot(nearest, rates)),
        float(np.dot(nearest, slopes)), growth, max([2 * growth, *bounds]), float(np.linalg.norm(over, 2)), falls,
    )  # fmt: skip


def _outweighs(terms: Polynomial, k: tuple[int, ...], groups: list[list[int]]) -> bool:
    """Return True if 2 |P| of the vector k somewhere exceeds the other terms of the same order.

    The |z_j|² of modes with equal rates have the same sum as their k_j, because these modes may be combined in any basis. The
    phase of P is free, so the condition holds if the sum of all terms takes both signs.
    """
    n = len(k)
    of = np.array([[j in g for j in range(n)] for g in groups])
    sums = of @ k
    up, down = terms.exponents[:, :n] @ of.T, terms.exponents[:, n:] @ of.T
    fed = ((up == sums) & (down == 0)).all(1) | ((down == sums) & (up == 0)).all(1)
    chosen = terms.where((fed | (up == down).all(1)) & ((up + down)[:, sums == 0] == 0).all(1))
    return all(_least(chosen.times(sign), of[sums > 0], sums[sums > 0]) < 0 for sign in (1, -1))


def _least(f: Polynomial, groups: Array, sums: Array) -> float:
    """Return the least real part of f(z, z̄) that minimisations from eight starts find. Each row of `groups` is a mask of modes
    whose |z_j|² keep the sum in `sums`."""
    from scipy.optimize import minimize

    powers, double, sizes = f.exponents, np.hstack([groups, groups]), np.sqrt(sums)  # double: real and imaginary parts
    n, moving = f.variables // 2, np.flatnonzero(double.any(0))

    def value(x: Array) -> tuple[float, Array]:
        norms = np.sqrt(double @ x**2)
        scale = (sizes / norms) @ double
        z = (scale * x)[:n] + 1j * (scale * x)[n:]
        point = np.concatenate([z, z.conj()])
        terms = f.coefficients * np.prod(point**powers, axis=1)
        by_z, by_w = (terms @ powers / np.where(point == 0, 1, point)).reshape(2, n)
        slope = by_z + by_w.conj()
        slope = np.concatenate([slope.real, -slope.imag])
        radial = (double @ (x * slope) / norms**2) @ double
        return float(terms.sum().real), scale * (slope - radial * x)

    starts = np.zeros((8, 2 * n))
    starts[:, moving] = np.random.default_rng(0).standard_normal((8, len(moving)))
    return float(min(minimize(value, x, jac=True, method="BFGS").fun for x in starts))


def _slopes(linear: SmallMotion, factor: float) -> Array:
    """Return the derivatives of the rates with respect to the factor on all spins, (n,), rad/s; NaN if a mode grows nearby."""
    step = 1e-5 * factor
    near = [signed_rates(linear, factor + sign * step) for sign in (-1, 1)]
    if not all(map(len, near)):
        return np.full(linear.dof, np.nan)
    return (near[1] - near[0]) / (2 * step)


@lru_cache(maxsize=16)
def normal_form_of(s: Assembly, factor: float = 1.0, detuning: float = 0.0, order: int = 4) -> NormalForm:
    """Return the normal form about upright through `order`, in the units of `LocalHamiltonian`. It keeps the resonant terms
    whose detuning is at most `detuning`."""
    check_upright(s, "normal_form_of")
    form = normal_form_of_series(local_hamiltonian(s, order).at_spins(factor), order, detuning)
    if len(signed_rates(small_motion(s), factor)) and 0 in form.frequencies:
        raise SingularError("normal form: slow rates are lost in the rounding of the fastest ones: take slower spins")
    return form


def fall_time_along(s: Assembly, rates: ArrayLike, longest: float, detuning: float) -> float:
    """Return the time in s at which the sine of an axis's inclination reaches 1, according to the normal form. The axes start
    upright with the rates (N, 2) in rad/s. The result is inf if the time exceeds `longest` s."""
    from scipy.integrate import solve_ivp

    h = local_hamiltonian(s)
    n = normal_form_of(s, 1.0, detuning / h.rate)
    size = len(n.frequencies)
    push = finite_array("fall_time: push", rates)
    residual = push.ravel() - h.basis @ (h.basis.T @ push.ravel())
    if np.abs(residual).max() > _ON_BARS * np.abs(push).max():
        raise InputError("fall_time: push: the bars do not allow these rates: each bar must keep its length")
    start = np.linalg.inv(n.vectors) @ (start_of_push(s) @ (h.basis.T @ push.ravel()))
    begin = np.array([f.at(start) for f in _new_coordinates(n, 3)])[:size]
    steps = n.series.exponents[:, :size] - n.series.exponents[:, size:]
    turning = np.array(n.frequencies) - np.linalg.pinv(steps.astype(float)) @ (steps @ np.array(n.frequencies))
    slow = n.series - polynomial(
        {tuple(int(i in (j, size + j)) for i in range(2 * size)): w for j, w in enumerate(turning)}, 2 * size
    )
    slopes = [slow.derivative(size + j) for j in range(size)]
    shapes = 2 * (h.basis @ n.vectors[:size, :size])
    groups = _of_equal_rates(np.real(n.frequencies))

    def flow(_: float, z: Complex) -> Complex:
        point = np.concatenate([z, z.conj()])
        return np.array([-1j * f.at(point) for f in slopes])

    def fallen(t: float, z: Complex) -> float:
        z = z * np.exp(-1j * turning * t)
        tilts = sum(np.abs(shapes[:, g] @ z[g]) for g in groups)
        return float(np.hypot(*np.reshape(tilts, (-1, 2)).T).max()) - _FALLEN

    fallen.terminal = True  # type: ignore[attr-defined]
    tight = 1e-10 * np.abs(begin).max()
    run = solve_ivp(flow, (0, longest * h.rate), begin, events=fallen, rtol=1e-10, atol=tight, method="DOP853")
    return float(run.t[-1]) / h.rate if run.status == 1 else inf


def _new_coordinates(n: NormalForm, order: int) -> list[Polynomial]:
    """Return the coordinates of the normal form as polynomials in the coordinates that diagonalise the quadratic part."""
    new = [variable(j, 2 * len(n.frequencies)) for j in range(2 * len(n.frequencies))]
    for generator in reversed([g for g in n.generators if len(g.coefficients)]):
        new = [lie_transform(f, generator.times(-1), n.weights, order) for f in new]
    return new


@dataclass(frozen=True, eq=False, repr=False)
class LargestPush(Shown):
    """The largest push `value` (rad/s) that does not topple a structure, and `behind`, the reason in words. `resonance` is the
    resonance that needs the smallest push; None if there is none. If no resonance limits the push, a larger one tilts an axis
    by more than 0.1, the range in which the expansion is accurate."""

    value: float
    behind: str
    resonance: Resonance | None

    def __float__(self) -> float:
        return self.value

    def summary(self) -> dict[str, str]:
        """Return the largest push and its reason, as rows of a table."""
        return {"largest push": f"{self.value:.4g} rad/s", "behind": self.behind}


def largest_push(s: Assembly) -> LargestPush:
    """Return the largest push that does not topple a structure: see `Structure.largest_push`."""
    check_upright(s, "largest_push")
    if small_motion(s).growth > 0:
        return LargestPush(0.0, "it is linearly unstable", None)
    first, trusted = first_resonance(s), trusted_push(s)
    if first is None or first.push() > trusted:
        behind = f"no resonance needs less; a larger push tilts an axis by more than {_TRUSTED}"
        return LargestPush(trusted, behind, first)
    return LargestPush(first.push(), f"a resonance of order {first.order}: {first.words()}", first)


def trusted_push(s: Assembly, factor: float = 1.0) -> float:
    """Return a push (rad/s) after which no axis tilts by more than 0.1 in the linear motion; 0 if a mode grows or drifts."""
    if not len(signed_rates(small_motion(s), factor)):
        return 0.0
    scaled, tilts = small_motion(s).at_spins(factor), np.zeros(1)
    roots, vectors = scaled.waves
    n, turning = scaled.dof, roots.imag > 0
    w, u = roots[turning].imag, vectors[:, turning]
    for g in _of_equal_rates(w):  # the projection of a push q' on the modes, in the metric of their energy
        moving, still = (1j * w[g] * u[:, g]).conj().T @ scaled.mass, u[:, g].conj().T @ scaled.stiffness @ u[:, g]
        form = moving @ (1j * w[g] * u[:, g]) + still
        if np.abs(np.linalg.eigvalsh(form)).min() < _NEGLIGIBLE * np.linalg.norm(still, 2):
            return 0.0  # at the critical spins two modes coincide
        shares = (scaled.basis @ u[:, g] @ np.linalg.solve(form, moving)).reshape(-1, 2, n)
        tilts = tilts + 2 * np.linalg.norm(shares, 2, axis=(1, 2))
    return float(_TRUSTED / np.max(tilts))


def _of_equal_rates(rates: Array) -> list[list[int]]:
    """Return the numbers of the modes in groups of equal rates. Modes of a group may be combined in any basis."""
    equal = np.abs(rates[:, None] - rates) < _EQUAL * np.minimum(np.abs(rates[:, None]), np.abs(rates))
    return [list(g) for g in {tuple(np.flatnonzero(row).tolist()) for row in equal}]


def checked_push(where: str, push: Any) -> float:
    """Return a push as a number. Raises InputError if it is not above zero."""
    if isinstance(push, bool) or not isinstance(push, int | float | np.number) or not 0 < push < inf:
        raise InputError(f"{where}: push = {push!r} must be a number above zero")
    return float(push)


def spin_intervals(s: Assembly, push: float) -> tuple[tuple[float, float], ...]:
    """Return the factors on all spins at which no push of a size topples the structure: see `Structure.spin_intervals`."""
    check_upright(s, "spin_intervals")
    push, least = checked_push("spin_intervals", push), spin_threshold(small_motion(s))
    if least == 0:
        raise InputError("spin_intervals: the structure is stable without spins: use largest_push() at given spins")
    if least == inf:
        return ()
    top = _TOP * least
    while trusted_push(s, top) < push and top < _FASTEST * least:
        top *= 2
    factors = {least + float(x) for x in np.geomspace(1e-3 * least, top - least, 16)}
    for factor, resonance in resonant_factors(s):
        factors |= {factor, *resonance.window(push)}
    grid = sorted(f for f in factors if least < f < top * (1 + _NEGLIGIBLE))

    def holds(factor: float) -> bool:
        if trusted_push(s, factor) < push:
            return False
        try:
            return all(r.push() >= push for d in (3, 4) for r in resonances(s, factor, (d,)) if r.falls)
        except SingularError:  # not known
            return False

    def edge(outside: float, inside: float) -> float:
        while abs(inside - outside) > _CHECKED * (inside - least):
            middle = (inside + outside) / 2
            outside, inside = (outside, middle) if holds(middle) else (middle, inside)
        return inside

    enough, intervals, start = [holds(f) for f in grid], [], grid[0]
    for k in range(1, len(grid)):
        if enough[k] and not enough[k - 1]:
            start = edge(grid[k - 1], grid[k])
        elif enough[k - 1] and not enough[k]:
            intervals.append((start, edge(grid[k], grid[k - 1])))
    return (*intervals, (start, inf)) if enough[-1] else tuple(intervals)


def resonant_factors(s: Assembly, orders: Sequence[int] = (3, 4)) -> tuple[tuple[float, Resonance], ...]:
    """Return the factors on all spins, above the critical factor, at which a resonance makes the structure unstable.

    Parameters
    ----------
    s : Assembly
        The structure.
    orders : sequence, default (3, 4)
        The orders of the resonances.

    Returns
    -------
    tuple
        Pairs (factor, Resonance) in ascending order of the factor.
    """
    from scipy.optimize import brentq

    check_upright(s, "resonant_factors")
    linear = small_motion(s)
    least = spin_threshold(linear)
    if not 0 < least < inf:
        return ()
    factors = least * np.geomspace(1 + 1e-6, _TOP, 400)
    tracks = [(f, rates) for f in factors if len(rates := signed_rates(linear, f))]
    roots = set()
    for order in orders:
        n = linear.dof
        for c in combinations_with_replacement(range(n), order):
            sums = [rates[list(c)].sum() for _, rates in tracks]
            for k in np.flatnonzero(np.sign(sums[:-1]) * np.sign(sums[1:]) < 0):
                low, high = tracks[k][0], tracks[k + 1][0]
                root = brentq(lambda f, c=c: signed_rates(linear, f)[list(c)].sum(), low, high, xtol=1e-13 * low)
                roots.add((round(root, 9), order))
    matches = []
    for root, order in sorted(roots):
        nearest = next(_of_order(s, signed_rates(linear, root), _slopes(linear, root), root, order), None)
        if nearest and nearest.falls and abs(nearest.detuning) < 1e-6 * np.abs(nearest.rates).max():
            matches.append((root, nearest))
    return tuple(matches)
