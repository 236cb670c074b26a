"""Nonlinear waves of a pattern: the shift of their rate with amplitude, and the resonances of three waves.

Whitham's averaged Lagrangian: with u = sum_j Re(a_j s_j exp(i θ_j)) + …, θ_j = q_j . n − ω_j t, the mean of L over cells and
phases is

    ⟨L⟩ = sum_j g_j(ω_j) |z_j|² + terms of third and fourth order,    z_j = a_j/2,    g = s†(ω² M + i ω C − K) s.

A cell n steps away multiplies each product of exponentials by exp(i q . n), and a time derivative by −i ω. The exact
Lagrangian, with bars as in `upright_hamiltonian`, is therefore a polynomial in z_j. One wave: the forced amplitudes b at (0, 0)
and (2 q, 2 ω) make ⟨L⟩ = c |z|⁴ + f(b) + b·B b/2 stationary, and ∂⟨L⟩/∂|z|² = 0 gives ω = ω₀ − 2 (c − f·B⁻¹f/2) |z|²/g'. Three
waves with q₁ + q₂ = q₃, ω₁ + ω₂ = ω₃ and ⟨L⟩₃ = 2 Re(v z₁ z₂ z̄₃): g₃' z₃' = i v z₁ z₂, g₁' z₁' = i v̄ z₃ z̄₂. Whitham, Linear
and Nonlinear Waves (1974), chs. 14, 15; Craik, Wave Interactions and Fluid Flows (1985), ch. 5.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.mechanics.canonical.polynomials import Polynomial, linear_form, total
from lagrotor.numerics.arrays import finite_array
from lagrotor.pair.quantities import finite_number
from lagrotor.result_display import Shown
from lagrotor.structures.coefficients import Array, Coefficients, Complex
from lagrotor.structures.exact.structure_run import StructureRun
from lagrotor.structures.upright_hamiltonian import Row, axis_of, combined, on_bars, over_length, potential_of, turned
from lagrotor.structures.waves.cell import Cell
from lagrotor.structures.waves.dispersion import Bloch, bloch, cell_coefficients, dispersion

_ZERO = 1e-9  # relative to the largest: smaller values are zero
_POINTS = 181  # wave numbers of the search for triads
_SAME = 1e-7  # relative to the highest rate: smaller detunings are zero


@dataclass(frozen=True, eq=False)
class _Phases:
    """The phases of m variables of polynomials. Each carries a factor exp(i (q . n − rate t)), with q (m, d) and rate (m,)."""

    q: Array
    rate: Array

    def apart(self, f: Polynomial, shift: tuple[int, ...]) -> Polynomial:
        """Translate the polynomial f by `shift` cells: each term gets the phase that its wave gains over this distance."""
        return f.times(np.exp(1j * (f.exponents @ self.q @ np.array(shift))))

    def slope(self, f: Polynomial) -> Polynomial:
        """Return the time derivative of the polynomial f."""
        rates = f.exponents @ self.rate
        return f.where(rates != 0).times(-1j * rates[rates != 0])


@dataclass(frozen=True, eq=False)
class _Wave:
    """A linear wave: q (d,), its rate > 0 (rad/s), its shape (2N,), and `slope`, which is g'(rate) of the module. The largest
    tilt of an axis in Re(shape e^{iθ}) is 1."""

    q: Array
    rate: float
    shape: Complex
    slope: float


def _wave(p: Cell, b: Bloch, q: ArrayLike, band: int) -> _Wave:
    at = finite_array("nonlinear waves: q", q).reshape(1, -1)
    d, where = dispersion(p, np.vstack([at, -at])), f"band {band!r} at q = {np.round(at[0], 6).tolist()}"
    if isinstance(band, bool) or not isinstance(band, int | np.integer) or not -d.dof[0] <= band < d.dof[0]:
        raise InputError(f"nonlinear waves: {where}: the bands there are 0 to {d.dof[0] - 1}, or −1 to {-d.dof[0]}")
    n, below = int(d.dof[0]), int(band < 0)
    rates = np.concatenate([-d.rates[1, n - 1 :: -1], d.rates[0, :n]])
    rate, growth = float(rates[n + band]), float(d.growth[below, -1 - band if below else band])
    if not rate > 0 or growth:
        hint = f"it is band {-1 - band} of −q" if rate < 0 else "take another band"
        raise InputError(f"nonlinear waves: {where} has the rate {rate:g} rad/s and grows by {growth:g} 1/s: {hint}")
    degenerate = (np.abs(rates - rate) < _SAME * np.abs(rates).max()).sum()
    if degenerate > 1:
        raise InputError(
            f"nonlinear waves: {where}: {degenerate} waves have this rate, {rate:g} rad/s, and are not distinguished; change q"
        )
    s = d.shapes[1, -1 - band].conj() if below else d.shapes[0, band]
    largest = max(np.linalg.svd(np.array([x.real, x.imag]), compute_uv=False)[0] for x in s)
    shape = (s / largest).ravel()
    (M, _, G, _), _ = b.at(at[0])
    return _Wave(at[0], rate, shape, float((shape.conj() @ (2 * rate * M + 1j * G) @ shape).real))


def _bloch_without_friction(p: Cell) -> Bloch:
    if not p.inertia:
        raise InputError("nonlinear waves: inertia=False is a linear limit: keep the inertia")
    if any(p.friction) or any(brace[4] for brace in p.braces):
        raise InputError("nonlinear waves: with friction or damping the waves decay; set them to zero")
    return bloch(p)


def _averaged(p: Cell, b: Bloch, u: Row, phases: _Phases, order: int) -> tuple[Polynomial, list[Row]]:
    """Return the averaged Lagrangian (J per cell) of the tilts u, 2N polynomials, and x, y, z of all axes, through an order."""
    c, _ = cell_coefficients(p)

    def axes_of(tips: Row) -> list[Row]:
        axes = [axis_of(tips[k : k + 2], order) for k in range(0, len(tips), 2)]
        for j, shift in p.neighbours:
            x, y, z = (phases.apart(f, shift) for f in axes[j])
            turn = p.turn * shift[0]
            C, S = np.cos(turn), np.sin(turn)
            axes.append([combined((C, -S), [x, y]), combined((S, C), [x, y]), z])
        return axes

    def back(bound: Row) -> Row:
        rows = list[list[Polynomial]]()
        for k, f in enumerate(bound):
            by = np.linalg.pinv(b.at(f.exponents @ phases.q)[1], rcond=1e-10)[:, :, k]
            rows.append([f.times(column) for column in by.T])
        return [total([row[k] for row in rows]) for k in range(len(u))]

    axes = on_bars(c, u, axes_of, back, order)
    for k in range(len(c.i)):
        residual = over_length(c, axes, k, order - 1).coefficients
        if np.abs(residual).max(initial=0) > _ZERO * c.ell[k]:
            raise InputError(
                "nonlinear waves: the bars keep their lengths to first order only, as in a straight row of bars; replace the "
                "bars by springs (braces), or close the row to a ring"
            )
    L = _kinetic(c, axes, phases, order) - potential_of(c, axes, order)
    e = np.exp(1j * (L.exponents @ phases.q))
    return L.where((np.abs(e - 1) < _SAME).all(1)), axes


def _kinetic(c: Coefficients, axes: list[Row], phases: _Phases, order: int) -> Polynomial:
    """Return the kinetic terms ½ sum_ij A_ij r_i'·r_j' − sum_i G_i (x_i y_i' − y_i x_i')/(1 + z_i)."""
    rates = [[phases.slope(f) for f in axis] for axis in axes]
    pairs = [(i, i, A / 2) for i, A in enumerate(c.A)] + list(zip(c.i, c.j, c.coupling, strict=True))
    terms = [
        f.product(g, order).times(value)
        for i, j, value in pairs
        if value
        for f, g in zip(rates[i], rates[j], strict=True)
    ]
    terms += [turned(axis, rates[i], order).times(-c.G[i]) for i, axis in enumerate(axes) if c.G[i]]
    return total([axes[0][0].part(-1), *terms])


@dataclass(frozen=True, eq=False, repr=False)
class NonlinearWave(Shown):
    """A wave u = Re(a shape e^{iθ}) + a² (mean + Re(harmonic e^{2iθ})) + O(a³), θ = q . n − (rate + shift a²) t.

    The amplitude a is the sine of the largest tilt of an axis in the first term. The shifted rate has an error O(a⁴).

    - `rate` and `shift`: the rate of the linear wave and its change divided by a², rad/s.
    - `shape`, `mean` and `harmonic`: the terms of u above, (N, 2) each.
    - `detuning`: the distance of twice the rate from the rate of the nearest wave of 2 q, rad/s; inf if there is none.
    - `energy_sign`: −1 if the wave has less energy than the equilibrium, otherwise 1.
    - `tips`: x and y of each axis as polynomials in z, z̄ and the forced amplitudes b of the module.
    - `multiples`: the multiple of θ in the phase of each variable of these polynomials. `forced` is b/z².
    """

    pattern: Cell
    q: Array
    rate: float
    shift: float
    shape: Complex
    mean: Array
    harmonic: Complex
    detuning: float
    energy_sign: int
    tips: tuple[Polynomial, ...]
    multiples: Array
    forced: Complex

    @property
    def trusted(self) -> float:
        """The largest amplitude at which mean and harmonic are at most a fifth of the first term; it is at most 0.2."""
        return float(0.2 / max(1.0, np.abs(self.mean).max(), np.abs(self.harmonic).max()))

    def rate_at(self, amplitude: float) -> float:
        """Return rate + shift a², rad/s. Raises InputError for an amplitude beyond `trusted`."""
        if not 0 <= finite_number(amplitude, "NonlinearWave: amplitude", "1") <= self.trusted:
            raise InputError(
                f"NonlinearWave: amplitude = {amplitude!r} must be from 0 to {self.trusted:.3g}: above, the mean and the second "
                "harmonic are not small; simulate it"
            )
        return self.rate + self.shift * amplitude**2

    def state(self, *counts: int, amplitude: float) -> tuple[Array, Array]:
        """Return the tilts and rates (1/s) of the rotors of `pattern.piece(*counts)` at t = 0, (n, 2), through second order."""
        omega = self.rate_at(amplitude)
        point = np.array([1, 1, *self.forced * amplitude / 2]) * amplitude / 2
        cells = np.array(self.pattern.cells(*counts))
        tilts, rates = np.zeros((2, len(cells), len(self.tips)), dtype=complex)
        for k, f in enumerate(self.tips):
            theta = f.exponents @ self.multiples
            terms = f.coefficients * np.prod(point**f.exponents, axis=1) * np.exp(1j * np.outer(cells @ self.q, theta))
            tilts[:, k], rates[:, k] = terms.sum(1), -1j * omega * (terms @ theta)
        turn = np.exp(1j * self.pattern.turn * cells[:, :1])
        around = [(u.real[:, ::2] + 1j * u.real[:, 1::2]) * turn for u in (tilts, rates)]
        return tuple(np.stack([u.real, u.imag], -1).reshape(-1, 2) for u in around)  # type: ignore[return-value]

    def summary(self) -> dict[str, str]:
        """Return rate, shift and second harmonic in words."""
        return {
            "rate": f"{self.rate:.8g} rad/s",
            "shift": f"{self.shift:.6g} a² rad/s, a the largest tilt, up to {self.trusted:.3g}",
            "twice the rate misses a wave of 2 q by": f"{self.detuning:.4g} rad/s",
            "energy": "less than rest" if self.energy_sign < 0 else "more than rest",
        }


def nonlinear_wave(p: Cell, q: ArrayLike, band: int) -> NonlinearWave:
    """Expand a wave in its amplitude: see `Pattern.nonlinear_wave`."""
    b = _bloch_without_friction(p)
    wave = _wave(p, b, q, band)
    still, twice = (next(b.motions(m * wave.q[None]))[1] for m in (0, 2))
    bases = [wave.shape[:, None], wave.shape.conj()[:, None], still.basis[0], twice.basis[0], twice.basis[0].conj()]
    multiples = np.repeat([1.0, -1, 0, 2, -2], [basis.shape[1] for basis in bases])
    phases = _Phases(np.outer(multiples, wave.q), multiples * wave.rate)
    L, axes = _averaged(p, b, [linear_form(row) for row in np.hstack(bases)], phases, 4)
    L = L.where(L.exponents @ multiples == 0)
    quartic, forcing, curvature = _forced_terms(L)
    forced = -np.linalg.pinv(curvature, rcond=_ZERO) @ forcing
    if np.abs(curvature @ forced + forcing).max(initial=0) > 1e-6 * np.abs(forcing).max(initial=0):
        raise InputError(
            f"nonlinear_wave: at q = {wave.q.tolist()} the mean or the second harmonic that the wave forces is itself a "
            "wave, and grows with time: change q"
        )
    shift = -(quartic + forcing @ forced / 2).real / (2 * wave.slope)
    tips = tuple(f for axis in axes[: len(p.joints)] for f in axis[:2])
    point: Complex = np.array([0.5, 0.5, *forced / 4], dtype=complex)
    mean, harmonic = (_terms_of_phase(tips, multiples, point, m) for m in (0, 2))
    nearest = np.abs(-twice.roots.imag - 2 * wave.rate).min(initial=np.inf)
    return NonlinearWave(
        p, wave.q, wave.rate, float(shift), wave.shape.reshape(-1, 2), mean.real, 2 * harmonic, float(nearest),
        int(np.sign(wave.slope)), tips, multiples, forced,
    )  # fmt: skip


def wave_amplitude(p: Cell, run: StructureRun, counts: Sequence[int], q: ArrayLike, band: int) -> Complex:
    """Measure the amplitude of a linear wave in a run of a piece, by the symplectic product.

    The motion is u = Re(a shape e^{i(q . n − ωt)}) + other waves.

    Parameters
    ----------
    p : Pattern
        The pattern.
    run : StructureRun
        A run of `p.piece(*counts)`.
    counts : sequence
        The number of cells along each step.
    q : array_like
        The wave number (d,), rad per cell.
    band : int
        The number of the band, with the numbering of `Pattern.nonlinear_wave`.

    Returns
    -------
    Complex
        The amplitude a e^{−iωt} at each time, (n,).
    """
    b = _bloch_without_friction(p)
    wave, cells = _wave(p, b, q, band), np.array(p.cells(*counts))
    if len(run.axes) != len(cells) * len(p.joints):
        raise InputError(f"wave_amplitude: the run has {len(run.axes)} rotors, piece{tuple(counts)} has another number")
    rotation = np.exp(-1j * (p.turn * cells[:, 0]))[:, None, None]
    U, V = (
        np.tensordot(np.exp(-1j * cells @ wave.q), np.stack([x.real, x.imag], -1), 1)
        .swapaxes(0, 1)
        .reshape(len(run.t), -1)
        / len(cells)
        for f in (run.axes, run.rates)
        for x in [(f[..., 0] + 1j * f[..., 1]).reshape(len(cells), len(p.joints), -1) * rotation]
    )
    (M, _, C, _), _ = b.at(wave.q)
    momentum = M @ (-1j * wave.rate * wave.shape) + C @ wave.shape / 2
    product_of = (V @ M.T + U @ C.T / 2) @ wave.shape.conj() - U @ momentum.conj()
    return np.asarray(2j * product_of / wave.slope)


def _terms_of_phase(tips: tuple[Polynomial, ...], multiples: Array, point: Complex, m: int) -> Complex:
    """Return the second-order terms of x and y of each axis that have the phase m θ, (N, 2), at the values `point`."""
    order = np.where(np.arange(len(multiples)) < 2, 1, 2)
    values = [f.where((f.exponents @ order == 2) & (f.exponents @ multiples == m)).at(point) for f in tips]
    return np.reshape(values, (-1, 2))


def _forced_terms(L: Polynomial) -> tuple[complex, Complex, Complex]:
    """Return three kinds of coefficients of the averaged Lagrangian with m forced amplitudes b. They are the coefficient of z²
    z̄², the coefficients (m,) of b times two of z and z̄, and the second derivatives (m, m) by b."""
    m, quartic = L.variables - 2, 0j
    forcing, curvature = np.zeros(m, dtype=complex), np.zeros((m, m), dtype=complex)
    for e, c in L.terms.items():
        where = [k for k, power in enumerate(e[2:]) for _ in range(power)]
        if sum(e[:2]) == 4:
            quartic += c
        elif sum(e[:2]) == 2 and len(where) == 1:
            forcing[where[0]] += c
        elif not sum(e[:2]) and len(where) == 2:
            i, j = where
            curvature[i, j] += c
            curvature[j, i] += c
    return quartic, forcing, curvature


@dataclass(frozen=True, eq=False, repr=False)
class ThreeWaves(Shown):
    """Three waves in resonance: q₁ + q₂ = q₃ modulo 2π, and ω₁ + ω₂ = ω₃ with all rates positive.

    - `q`: the wave numbers, (3, 1), rad per cell.
    - `bands`: the numbers of the three bands.
    - `rates`: the rates ω, (3,), rad/s.
    - `energy_signs`: −1 for a wave with less energy than the equilibrium, otherwise 1.
    - `strengths`: the coefficients c (3,), 1/s, of a₁' = i c₁ a₃ ā₂, a₂' = i c₂ a₃ ā₁ and a₃' = i c₃ a₁ a₂. The amplitudes
      a_j e^{−iω_j t} are the largest tilts. The coefficients are zero if the waves exchange no energy.
    - `shapes`: the x and y of each axis, (3, N, 2), with the largest tilt 1.
    """

    q: Array
    bands: tuple[int, int, int]
    rates: Array
    energy_signs: tuple[int, int, int]
    strengths: Complex
    shapes: Complex

    def growth(self, wave: int, amplitude: float) -> float:
        """Return the growth (1/s) that wave number 0, 1 or 2 of this amplitude gives the two others, small ones; 0 if none."""
        others = [self.strengths[k] for k in range(3) if k != wave]
        # a₁' = i c₁ a₃ ā₂ and a₂' = i c₂ a₃ ā₁ give a₁'' = c₁ c̄₂ |a₃|² a₁; ā₂' = −i c̄₂ ā₃ a₁, a₃' = i c₃ a₁ a₂: a₃'' = −c₃ c̄₂ …
        fed = (others[0] * others[1].conjugate()).real if wave == 2 else -(others[0] * others[1]).real
        return float(np.sqrt(max(fed, 0.0)) * amplitude)

    @property
    def explosive(self) -> bool:
        """True if all three waves grow without bound by the terms of third order, at the cost of one another's energy."""
        first, second, third = self.energy_signs
        return first == second != third and bool(np.abs(self.strengths).min())

    def summary(self) -> dict[str, str]:
        """Return the triad and its growth in words."""
        first, second, third = (f"{w:.6g}" for w in self.rates)
        sums = " + ".join(f"{q:.5g}" for q in self.q[:2, 0])
        feeds = [f"wave {k + 1}: {self.growth(k, 1.0):.4g} a 1/s" for k in range(3) if self.growth(k, 1.0)]
        return {
            "wave numbers": f"{sums} = {self.q[2, 0]:.5g} rad a cell",
            "rates": f"{first} + {second} = {third} rad/s",
            "feeds the two others": ", ".join(feeds) or "none",
            "all grow without end": "yes" if self.explosive else "no",
        }


def three_waves(p: Cell, q: float) -> tuple[ThreeWaves, ...]:
    """Find the resonant triads that contain a wave of wave number q: see `Pattern.three_waves`."""
    from scipy.optimize import brentq

    if len(p.steps) != 1:
        raise InputError("three_waves: a pattern with two steps has curves of triads; take a strip")
    b, others = _bloch_without_friction(p), np.linspace(0, 2 * np.pi, _POINTS) + 1e-4
    q = float(finite_array("three_waves: q", q, ()))

    def waves(at: Array) -> dict[int, Complex]:
        """Return {number of the band: rate + i growth} at the wave numbers `at` (n,), each value (n,)."""
        d = dispersion(p, np.concatenate([at, -at]))
        forward, opposite = np.split(d.rates + 1j * d.growth, 2)
        return dict(enumerate(forward.T)) | {-1 - k: -f.conj() for k, f in enumerate(opposite.T)}

    first, second, third = waves(np.array([q])), waves(others), waves(others + q)
    triads, highest = [], max(float(np.nanmax(np.abs(f))) for f in second.values())
    for (i, (rate,)), j, k in product(first.items(), second, third):

        def three(x: float, rate: complex = rate, j: int = j, k: int = k) -> Complex:
            return np.array([rate, waves(np.array([x]))[j][0], waves(np.array([x + q]))[k][0]])

        detuning = (rate + second[j] - third[k]).real
        steady = _is_steady(rate) & _is_steady(second[j]) & _is_steady(third[k])
        for n in np.flatnonzero((detuning[:-1] * detuning[1:] < 0) & steady[:-1] & steady[1:]):
            x = float(brentq(lambda x: float((three(x) @ [1, 1, -1]).real), others[n], others[n + 1], xtol=1e-13))
            at = three(x)
            if abs((at @ [1, 1, -1]).real) < _SAME * highest and _is_steady(at).all():
                triads.append(_triad(p, b, np.array([[q], [x], [q + x]]), (i, j, k)))
    return tuple(triads)


def _is_steady(wave: Any) -> Any:
    """Return True where the real part (the rate) is positive and the imaginary part (the growth) is zero."""
    return (wave.real > 0) & (wave.imag == 0)


def _triad(p: Cell, b: Bloch, q: Array, bands: tuple[int, int, int]) -> ThreeWaves:
    waves = [_wave(p, b, at, band) for at, band in zip(q, bands, strict=True)]
    columns = np.stack([s for w in waves for s in (w.shape, w.shape.conj())], 1)
    signs, slopes = np.tile([1.0, -1.0], 3), np.array([w.slope for w in waves])
    carried = np.repeat(q, 2, axis=0) * signs[:, None], np.repeat([w.rate for w in waves], 2) * signs
    L, _ = _averaged(p, b, [linear_form(row) for row in columns], _Phases(*carried), 3)
    v = L.terms.get((1, 0, 1, 0, 0, 1), 0j)
    v = v if abs(v) > _ZERO * max(abs(w.slope) * w.rate for w in waves) else 0j
    return ThreeWaves(
        q, bands, np.array([w.rate for w in waves]), tuple(np.sign(slopes).astype(int).tolist()),
        np.array([v.conjugate(), v.conjugate(), v]) / (2 * slopes), np.array([w.shape.reshape(-1, 2) for w in waves]),
    )  # fmt: skip
