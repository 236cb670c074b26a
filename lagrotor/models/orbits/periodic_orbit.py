"""A motion that returns to its start after one period: integrated once over that period, then a Fourier series at any time."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.minimal import MODEL
from lagrotor.models.model import Array, integrate_model, natural_units
from lagrotor.models.orbits.variational import flow
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.pair.scene import Scene

_SAMPLES = 256  # of one period: harmonics to 127
_FLOW = 1e-12  # tolerance of the variational equations
_LEAST = 1e-16  # of a harmonic that is kept


@dataclass(frozen=True, eq=False)
class FourierOrbit:
    """period (s); mismatch: how far axes, and rates over the frequency, are from the start after one period, and what the
    series leaves out; monodromy (6, 6): of small deviations over one period, in the minimal model's natural units; motion:
    times (n,) in s → axes and rates, each (2, n, 3)."""

    period: float
    mismatch: float
    monodromy: Array
    motion: Callable[[Array], tuple[Array, Array]]


def fourier_orbit(scene: Scene, period: float) -> FourierOrbit:
    """The scene's motion, its period known to a small share, as the Fourier series of one integrated period.

    The period is corrected so that the axes return as nearly as they do: r(T) − r(0) + r'(0) dT is least. Raises
    SingularError or IntegrationError where `minimal` cannot run the scene over a period.
    """
    units = natural_units(scene)
    turn = period * units.rate
    for _ in range(3):
        times = turn * np.linspace(0.0, 1.0, _SAMPLES + 1)
        seen = MODEL.observe(units.scene, integrate_model(MODEL, units.scene, times, TIGHTEST, bounded=True).states)
        off, ahead = seen.axes[:, -1] - seen.axes[:, 0], seen.rates[:, 0]
        shift = float((off * ahead).sum() / (ahead**2).sum())
        last, turn = turn, turn - shift
    turning = (seen.rates[:, -1] - seen.rates[:, 0]) * last / (2 * np.pi)
    waves = np.fft.rfft(seen.axes[:, :-1], axis=1) / _SAMPLES
    sizes = np.abs(waves).max(axis=(0, 2))
    kept = int(np.flatnonzero(sizes > _LEAST).max()) + 1
    tail = float(sizes[_SAMPLES // 4 :].sum())
    waves[:, 1:] *= 2  # of those of negative harmonics, too
    return FourierOrbit(
        last / units.rate,
        float(np.abs(off).max() + np.abs(turning).max()) + tail,
        flow(units.scene)(MODEL.start(units.scene), last, _FLOW).slope,
        fourier_motion(waves[:, :kept], 2 * np.pi * units.rate / last),
    )


def parting(orbit: FourierOrbit, t_end: float) -> float:
    """How far deviations from the orbit grow up to t_end (s): the largest norm of the monodromy's powers of 2ⁿ periods."""
    power, most, count = orbit.monodromy, 1.0, t_end / orbit.period
    while count >= 1 and most < 1e20:
        most, power, count = max(most, float(np.linalg.norm(power, 2))), power @ power, count / 2
    return 2 * most  # between two powers of two


def fourier_motion(
    waves: NDArray[np.complex128], frequency: float, phase: float = 0.0
) -> Callable[[Array], tuple[Array, Array]]:
    """t ↦ axes and rates, Re sum_h waves_h exp(i h (phase + frequency t)) and its derivative, from both axes' waves (2, h, 3)."""
    count = waves.shape[1]
    slopes = 1j * frequency * np.arange(count)[:, None] * waves
    table = np.concatenate([waves, slopes]).transpose(1, 0, 2).reshape(count, 12)
    table = np.concatenate([table.real, -table.imag])  # over cos and sin: a real product takes half of a complex one

    def motion(t: Array) -> tuple[Array, Array]:
        turn = np.exp(1j * (phase + frequency * t))
        powers = np.ones((count, len(t)), dtype=complex)
        for n in range(count - 1):
            np.multiply(powers[n], turn, out=powers[n + 1])
        seen = (np.concatenate([powers.real, powers.imag]).T @ table).reshape(-1, 2, 2, 3).transpose(1, 2, 0, 3)
        return seen[0], seen[1]

    return motion
