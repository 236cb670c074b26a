"""An orbit about the upright position for any two spins: shift of its rate with amplitude, azimuth drift, growth of a twist.

The orbit oscillates between x = ±r0, where the axes are parallel, and closes up to a rotation about the joint line. With
share = sigma (G_1 − G_2)² / ((G_1 + G_2)² + sigma (G_1 − G_2)²), 0 for equal and 1 for opposite spins, and k = ell/R,

    Omega = Omega_0 (1 + c r0² + …),
    c = 1/2 + 3/4 share (sigma − 1) − 1/4 share² (sigma² − 1) − 3/4 share² sigma/k²,
    alpha' = Omega_0 share^(3/2) sqrt(sigma) (sigma − 5)/(16 k) r0⁴ + …, of the sign of G_1 − G_2.

About a twist eta the frequency is Omega_0 (1 − (sigma − 1)((sigma + 1) share − 1)/(2 sigma) eta² + …). If it decreases with the
twist (a heavy bar and spins far from equal, or a light bar with b < 0 and nearly equal spins), a twist of the orbit grows as
exp(lambda t), lambda² = Omega_0² (1 − share)(sigma − 1)((sigma + 1) share − 1)/2 r0² + ….

Derived in derivations/t12_unequal_spins.py.
"""

from math import copysign, hypot
from typing import Any

from lagrotor.errors import InputError
from lagrotor.pair.scene import Scene


def shift_coefficient(sigma: Any, k: Any, share: Any) -> Any:
    """Return the coefficient c in Omega = Omega_0 (1 + c r0² + …); the arguments are numbers or symbols."""
    return (2 + 3 * share * (sigma - 1) - share**2 * (sigma**2 - 1) - 3 * share**2 * sigma / k**2) / 4


def drift_coefficient(sigma: Any, k: Any, root: Any) -> Any:
    """Return the azimuth drift alpha'/(Omega_0 r0⁴); `root` is sqrt(share/sigma) with the sign of G_1 − G_2."""
    return root**3 * sigma**2 * (sigma - 5) / (16 * k)


def twist_coefficient(sigma: Any, share: Any) -> Any:
    """Return lambda²/(Omega_0 r0)² of a twist, which is positive if the twist grows and negative if it oscillates."""
    return (1 - share) * (sigma - 1) * ((sigma + 1) * share - 1) / 2


def opposite_share(scene: Scene) -> float:
    """Return `share`, 1 for opposite and 0 for equal spins. Raises InputError without a bar, or if neither rotor spins."""
    if not isinstance(scene, Scene) or scene.link is None or scene.spins == (0, 0):
        raise InputError(f"the shift of the natural rate: {scene!r} needs a bar and a spin")
    first, second = scene.momenta
    apart = scene.sigma * (first - second) ** 2
    return float(apart / ((first + second) ** 2 + apart))


def frequency_shift(scene: Scene) -> float:
    """Return the relative shift c of the natural rate over the squared amplitude, Omega = Omega_0 (1 + c r0² + …).

    Parameters
    ----------
    scene : Scene
        Any two spins with a bar.

    Returns
    -------
    float
        The coefficient c, dimensionless; 1/2 for equal spins.

    Raises
    ------
    InputError
        If the scene has no bar, or if neither rotor spins.

    References
    ----------
    derivations/t12_unequal_spins.py.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> [frequency_shift(Scene(spins=spins)) for spins in ((10, 10), (10, -10))]
    [0.5, -0.25]
    """
    share = opposite_share(scene)
    return float(shift_coefficient(scene.sigma, scene.k, share))


def azimuth_drift(scene: Scene) -> float:
    """Return the rate alpha'/r0⁴ at which an orbit about upright rotates about the joint line, and so does not close.

    The law is of leading order and valid if r0² is well below |G_1 + G_2|/|G_1 − G_2|. It gives 0 for opposite spins, where
    the paired precession may rotate at any rate.

    Parameters
    ----------
    scene : Scene
        Any two spins with a bar.

    Returns
    -------
    float
        The rate in rad/s; 0 for equal and for opposite spins.

    Raises
    ------
    InputError
        If the scene has no bar, or if neither rotor spins.

    References
    ----------
    derivations/t12_unequal_spins.py.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> round(azimuth_drift(Scene(spins=(10, -20))), 9)
    -2.7
    """
    share, (first, second) = opposite_share(scene), scene.momenta
    if first == -second:
        return 0.0
    root = copysign((share / scene.sigma) ** 0.5, first - second)
    natural = hypot(first + second, scene.sigma**0.5 * (first - second)) / (2 * sum(scene.inertias))
    return natural * float(drift_coefficient(scene.sigma, scene.k, root))
