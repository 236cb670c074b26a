"""A scene in its own units: length R, the smaller of the inertias a + b and a − b, and a rate of its motion.

Every integration runs in these units, so that a solver's absolute tolerance means the same for every scene and the answer
depends on the units of mass, length and time by rounding alone.
"""

from dataclasses import dataclass, replace
from math import hypot, sqrt

from lagrotor.pair.scene import Link, Rotor, Scene, Shock

# Rates of PACE and axes of 1 share an absolute tolerance: rates are held as many times more accurately, as the energy is.
PACE = 16.0


@dataclass(frozen=True)
class NaturalUnits:
    """`scene` with R = 1, min(a + b, a − b) = 1 and a typical rate of PACE; the units of rate (rad/s) and inertia (kg m²)."""

    scene: Scene
    rate: float
    inertia: float


def natural_units(scene: Scene) -> NaturalUnits:
    """The scene in its own units. At rest, without spins or shock, the unit of rate is 1/s."""
    inertia, R = min(together_and_apart(scene)), scene.rotor.length
    rate = typical_rate(scene) / PACE or 1.0
    rotor, link, shock = scene.rotor, scene.link, scene.shock
    weight = R * R / inertia
    in_units = replace(
        scene,
        spins=(scene.spins[0] / rate, scene.spins[1] / rate),
        rotor=Rotor(rotor.mass * weight, 1.0, rotor.I1 / inertia, rotor.I3 / inertia),
        link=link and Link(link.length / R, link.mass * weight, link.inertia / inertia),
        shock=shock
        and Shock(
            tuple(f * R / inertia / rate**2 for f in shock.force),  # type: ignore[arg-type]
            shock.at * rate,
            shock.width * rate,
            shock.body,
        ),
        rates=tuple(tuple(x / rate for x in v) for v in scene.rates),  # type: ignore[arg-type]
    )
    return NaturalUnits(in_units, rate, inertia)


def together_and_apart(scene: Scene) -> tuple[float, float]:
    """Inertias a + b = J + m R²/2 of the axes' sum, a − b = J + 2 K R²/ell² of their difference (kg m²)."""
    if scene.link is None:
        return scene.rotor.J, scene.rotor.J
    R, link = scene.rotor.length, scene.link
    return scene.rotor.J + link.mass * R**2 / 2, scene.rotor.J + 2 * link.inertia * (R / link.length) ** 2


def typical_rate(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: (|G_1| + |G_2|)/I + sqrt(2T/I) and the shock's, I the smaller
    of the inertias, T the energy of the tilting.

    A pulse adds its impulse over I or, where it is so broad that the rotor turns meanwhile, sqrt(force R / I).
    """
    (together, apart), (v1, v2) = together_and_apart(scene), scene.rates
    inertia = min(together, apart)
    total, difference = (hypot(*(x + sign * y for x, y in zip(v1, v2, strict=True))) for sign in (1, -1))
    rate = hypot(sqrt(together / inertia) * total, sqrt(apart / inertia) * difference) / sqrt(2)
    if scene.shock:
        torque = hypot(*scene.shock.force) * scene.rotor.length / inertia
        rate += min(2 * torque * scene.shock.width, sqrt(torque))
    return rate + (abs(scene.momenta[0]) + abs(scene.momenta[1])) / inertia
