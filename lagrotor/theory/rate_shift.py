"""An orbit about upright of any two spins: how its rate shifts with the amplitude, how its azimuth drifts, how a twist grows.

An orbit about upright swings between x = ±r0, where the axes are parallel, and closes up to a turn about the joint line. With
share = sigma (G_1 − G_2)² / ((G_1 + G_2)² + sigma (G_1 − G_2)²), 0 for equal and 1 for opposite spins, and k = ell/R,

    Omega = Omega_0 (1 + c r0² + …),
    c = 1/2 + 3/4 share (sigma − 1) − 1/4 share² (sigma² − 1) − 3/4 share² sigma/k²,
    alpha' = Omega_0 share^(3/2) sqrt(sigma) (sigma − 5)/(16 k) r0⁴ + …, of the sign of G_1 − G_2.

About a twist eta the pair swings at Omega_0 (1 − (sigma − 1)((sigma + 1) share − 1)/(2 sigma) eta² + …). Where that falls with
the twist, for a heavy bar and spins far from equal or for a light one with b < 0 and spins near equal, a twist beside the orbit
grows, as exp(lambda t) with lambda² = Omega_0² (1 − share)(sigma − 1)((sigma + 1) share − 1)/2 r0² + ….

Derived in derivations/t12_unequal_spins.py.
"""

from math import copysign, hypot
from typing import Any

from lagrotor.errors import InputError
from lagrotor.pair.scene import Scene


def shift_coefficient(sigma: Any, k: Any, share: Any) -> Any:
    """c of Omega = Omega_0 (1 + c r0² + …), of numbers or symbols.

    Parameters
    ----------
    sigma
        Shape of the bar.
    k
        Ell / R.
    share
        As `opposite_share` has it.
    """
    return (2 + 3 * share * (sigma - 1) - share**2 * (sigma**2 - 1) - 3 * share**2 * sigma / k**2) / 4


def drift_coefficient(sigma: Any, k: Any, root: Any) -> Any:
    """alpha'/(Omega_0 r0⁴), of numbers or symbols.

    Parameters
    ----------
    sigma
        Shape of the bar.
    k
        Ell / R.
    root
        Sqrt(share/sigma), of the sign of G_1 − G_2.
    """
    return root**3 * sigma**2 * (sigma - 5) / (16 * k)


def twist_coefficient(sigma: Any, share: Any) -> Any:
    """lambda²/(Omega_0 r0)², of numbers or symbols: growth of a twist where positive, its slow frequency where negative."""
    return (1 - share) * (sigma - 1) * ((sigma + 1) * share - 1) / 2


def opposite_share(scene: Scene) -> float:
    """sigma (G_1 − G_2)² / ((G_1 + G_2)² + sigma (G_1 − G_2)²): 0 for equal spins, 1 for opposite ones.

    Raises InputError without a bar, and without any spin.
    """
    if not isinstance(scene, Scene) or scene.link is None or scene.spins == (0, 0):
        raise InputError(f"the shift of the natural rate: {scene!r} needs a bar and a spin")
    first, second = scene.momenta
    apart = scene.sigma * (first - second) ** 2
    return float(apart / ((first + second) ** 2 + apart))


def frequency_shift(scene: Scene) -> float:
    """c of Omega = Omega_0 (1 + c r0² + …): the relative shift of the natural rate over the square of the amplitude.

    For any two spins, any bar: 1/2 for equal ones, as 1/cos has it.

    Raises
    ------
    InputError
        Without a bar, and without any spin.
    """
    share = opposite_share(scene)
    return float(shift_coefficient(scene.sigma, scene.k, share))


def azimuth_drift(scene: Scene) -> float:
    """alpha'/r0⁴ (rad/s): how fast an orbit about upright turns about the joint line, which keeps it from closing.

    Leading order for r0² well below |G_1 + G_2|/|G_1 − G_2|. Zero for equal spins; zero for opposite ones, of whose orbits, with
    any rate of turning, this is the paired precession.

    Raises
    ------
    InputError
        Without a bar, and without any spin.
    """
    share, (first, second) = opposite_share(scene), scene.momenta
    if first == -second:
        return 0.0
    root = copysign((share / scene.sigma) ** 0.5, first - second)
    natural = hypot(first + second, scene.sigma**0.5 * (first - second)) / (2 * sum(scene.inertias))
    return natural * float(drift_coefficient(scene.sigma, scene.k, root))
