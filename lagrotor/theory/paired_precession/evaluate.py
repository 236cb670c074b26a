"""The paired precession of a scene as a function of time: its series, summed at one amplitude.

With c = cos Phi, s = sin Phi, w = c² the symmetry of the orbit halves the work: each coordinate has a part even in c
and one odd in c, and the other rotor, half a period later, has the same parts with another sign,

    x_1, x_2 = c O_x(w) ± E_x(w),    y_1, y_2 = s (c O_y(w) ± E_y(w)),    z_1, z_2 = E_z(w) ± c O_z(w).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import copysign
from typing import Any

import numpy as np
import sympy as sp
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.numerics.codegen import Program, compile_program, in_blocks
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_frequency import natural_rate
from lagrotor.theory.paired_precession.closed_forms import paired_momentum, paired_scene
from lagrotor.theory.paired_precession.series import evaluate, last_terms, paired_series, shape_of

Array = NDArray[np.float64]
_UNDECIDED = 0.05  # of the last terms of a series of order 5 or more, beyond which it is taken to diverge


@dataclass(frozen=True, eq=False)
class PrecessionOrbit:
    """The paired precession through r0**order. Called with times it gives both axes.

    frequency: angular, rad/s, negative where rotor 1 spins negatively; through r0**(order − 1).
    momentum: P about the joint line, kg m²/s. At t = 0 the axes are parallel.
    """

    scene: Scene
    r0: float
    order: int
    frequency: float
    momentum: float
    _coefficients: tuple[float, ...]

    @property
    def start(self) -> Scene:
        """The scene started on the orbit at t = 0, to be simulated; raises DomainError as `paired_scene` does."""
        return paired_scene(self.scene, self.r0, self.order)

    def __call__(self, t: ArrayLike) -> Array:
        """Axes at times t (…) in s: (2, …, 3), unit vectors to the order of the series. Raises DomainError for NaN."""
        return self.at_phase(self.frequency * np.asarray(t, dtype=float))

    def at_phase(self, phase: ArrayLike) -> Array:
        """Axes at phases (…) in rad: (2, …, 3), as of a run. Raises DomainError for a phase that is not finite."""
        phases = np.asarray(phase, dtype=float)
        if not np.isfinite(phases).all():
            raise DomainError("precession_orbit: a time is not finite")
        flat = phases.ravel()
        axes = in_blocks(_at_phases(self.order), [flat, *self._coefficients], 6, flat.size)
        return np.moveaxis(axes.reshape(2, 3, *phases.shape), 1, -1)


def precession_orbit(scene: Scene, r0: float, order: int = 15) -> PrecessionOrbit:
    """The paired precession of the scene's rotors, bar and opposite spins, of amplitude r0, as a series through r0**order.

    r0 is the sine of the inclination when the axes are parallel; `rotors.amplitudes` turns it into other amplitudes. At a
    given phase the error is O(r0**(order + 1)); that of the frequency, O(r0**(order + 1)) for an odd order, adds to the
    phase as time goes on. At r0 = 0.204 the axes are within 1e-6 of the exact orbit over a turn from order 9 on for the
    bar of section 5.2.1, from order 11 on for a massless one; with order 15 over hundreds of turns.
    Raises InputError unless the spins are opposite, there is a bar, and order is at least 1; DomainError unless
    |r0| < 1, and where the series does not converge (massless, from r0 = 0.6 on). Source: 5.21 and 5.22 of the paper, corrected.
    """
    if isinstance(order, bool) or not isinstance(order, int) or order < 1:
        raise InputError(f"precession_orbit: order = {order!r} must be a whole number, 1 or more")
    if not (isinstance(r0, int | float | np.floating) and -1 < r0 < 1):
        raise DomainError(f"precession_orbit: r0 = {r0} must lie between −1 and 1: it is the sine of an inclination")
    shape, ratio = shape_of(scene)
    series, amplitude = paired_series(order, shape, ratio), float(r0)
    if order >= 5 and (off := last_terms(series, amplitude)) > _UNDECIDED:
        raise DomainError(
            f"precession_orbit: at r0 = {r0:g} the last terms of the series of order {order} are still {off:.2g}: it does not "
            "converge there; take a smaller amplitude, or find the orbit by lagrotor.models.orbits.shooting.exact_orbit"
        )
    relative = float(evaluate(series.frequency, amplitude, 0.0))
    momentum = scene.momenta[0] * float(paired_momentum(order, shape, ratio)(amplitude, float(shape), float(ratio)))  # type: ignore[arg-type]
    width = float(shape) ** 0.5
    sizes: list[float] = []
    for part, scale, sine in ((series.x, 1.0, False), (series.Y, width, True), (series.z, 1.0, False)):
        sizes += [scale * value for value in _powers(part, amplitude, order, sine)]
    return PrecessionOrbit(
        scene,
        amplitude,
        order,
        copysign(natural_rate(scene) * relative, scene.spins[0]),
        momentum,
        tuple(sizes),
    )


def _powers(series: FourierSeries, amplitude: float, order: int, sine: bool) -> list[float]:
    """Coefficients of c⁰ … c^order of a cosine series, or of a sine series over s: sum_h a_h T_h(c), b_h U_(h−1)(c)."""
    waves = np.zeros(order + 2)
    for (n, h), value in series.terms.items():
        waves[abs(h)] += float(value) * amplitude**n
    if sine:  # s U_(h−1) = −(1/h) d cos(h Phi)/dPhi: U_(h−1) = T_h'/h
        waves[1:] /= np.arange(1, order + 2)
        powers = chebyshev.cheb2poly(chebyshev.chebder(waves))
    else:
        powers = chebyshev.cheb2poly(waves)
    return [float(v) for v in np.pad(powers, (0, order + 1))[: order + 1]]


@cache
def _at_phases(order: int) -> Callable[..., Any]:
    function = compile_program(program(order), "numpy")
    return lambda phases, *coefficients: function(np.cos(phases), np.sin(phases), *coefficients)


def program(order: int) -> Program:
    """(c, s, coefficients of x, y, z) → x_1, y_1, z_1, x_2, y_2, z_2: Horner's rule in w = c², generated."""
    c, s, w = sp.symbols("c s w", real=True)
    names = [[sp.Symbol(f"{q}{n}", real=True) for n in range(order + 1)] for q in "xyz"]
    stages = [(w, c * c)]

    def keep(name: str, expression: sp.Expr) -> sp.Symbol:
        stages.append((sp.Symbol(name, real=True), expression))
        return stages[-1][0]

    def horner(of: list[sp.Symbol]) -> sp.Expr:
        total = sp.Integer(0)
        for coefficient in reversed(of):
            total = coefficient + w * total
        return total

    (ex, ox), (ey, oy), (ez, oz) = (
        (keep(f"E_{q}", horner(of[0::2])), keep(f"O_{q}", c * horner(of[1::2])))
        for q, of in zip("xyz", names, strict=True)
    )
    outputs = (ox + ex, s * (oy + ey), ez + oz, ox - ex, s * (oy - ey), ez - oz)
    arguments = (c, s, *(n for group in names for n in group))
    return Program(arguments, tuple(stages), outputs)
