"""The natural rate of a scene, its error and its limits; the functions are generated from `lagrotor.theory.natural_frequency`."""

from dataclasses import dataclass, replace
from math import hypot, pi, sqrt

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Link, Scene
from lagrotor.theory.fitted_factors import LARGEST_SHIFT, LARGEST_SWING, LIGHTEST_TWIST, MOST_GROWTH, NEXT_SHIFT
from lagrotor.theory.rate_shift import frequency_shift, opposite_share, twist_coefficient

# Limit → its formula and, where the bar is changed, what it makes of a and b.
LIMIT_FORMULAS = {
    "equal": ("G/(a + b)", ""),
    "opposite": ("G/√(a² − b²)", ""),
    "massless": ("G/a", "a = J, b = 0"),
    "dumbbell": ("G/a", "a = (2 J + R² m)/2, b = 0"),
}
TURNS = 20  # over which the rate of a swing is held to its error


@generated(((),))
def natural_frequency_value() -> str:
    """(a, b, G_1, G_2) → [Omega_0], numbers."""
    from lagrotor.theory.natural_frequency import natural_frequency

    return natural_frequency().code()


@generated(((),))
def _free_rate() -> str:
    """(theta, G, J) → [phi'], numbers."""
    from lagrotor.theory.natural_frequency import free_precession_rate

    return free_precession_rate().code()


def natural_rate(scene: Scene) -> float:
    """Natural angular frequency (rad/s) of a scene: of the coupled pair, or of rotor 1 alone when there is no bar.

    Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)); see `natural_frequency`. Exact in the limit of small
    motion; `natural_rate_error` gives the error at an amplitude. Source: 5.28, corrected.

    Raises
    ------
    InputError
        Not a Scene.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> round(natural_rate(Scene(spins=(10, -10))), 12)
    8.0
    """
    if not isinstance(scene, Scene):
        raise InputError(f"natural_rate: {scene!r} must be a Scene")
    first, second = scene.momenta
    if scene.link is None:
        return abs(float(_free_rate()(0.0, first, scene.rotor.J)[0]))
    return float(natural_frequency_value()(*scene.inertias, first, second)[0])


def natural_rate_error(scene: Scene, amplitude: float) -> float:
    """Estimated error (rad/s) of `natural_rate` for an orbit about upright, or 20 turns of a swing from the linear mode.

    `amplitude` r is the sine of the larger inclination. With c and share of `theory.rate_shift`, c the shift of the orbit, with
    d = share² sigma/(2 k²) what a swing adds that begins in another phase and so turns about the joint line, and C what c becomes
    with all its terms positive,

        Omega_0 ( (|c| + d) r²/(1 − r²) + 3 N r⁴ ),  N = C² + share sigma |sigma − 1| + share³ sigma²/k⁴.

    So it is an estimate, no bound: the first part is derived; N has the powers of the next order, but its factor 3 is
    empirical, held in 10,000 random swings, off by at most 0.71 of it. One rotor alone precesses at Omega_0 / cos theta
    exactly. A swing of opposite spins that is made to turn at nu besides is shifted by −(a + b) nu/(k G) of Omega_0 more.

    Raises
    ------
    DomainError
        Unless 0 <= r <= 0.4, √N r² <= 0.12, sigma r² <= 0.5, and where a twist beside the orbit grows by more than
        exp(6) in 20 turns.
    """
    rate = natural_rate(scene)
    if not 0 <= amplitude <= LARGEST_SWING.value:
        raise DomainError(
            f"natural_rate_error: amplitude = {amplitude:g} must lie between 0 and {LARGEST_SWING.value:g}, the range that "
            "was calibrated; use lagrotor.simulate, or precession_orbit for opposite spins"
        )
    if scene.link is None:
        return rate * (1 / sqrt(1 - amplitude**2) - 1)
    if not rate:
        return 0.0
    k, sigma, share, square = scene.k, scene.sigma, opposite_share(scene), amplitude**2
    in_all = 0.5 + 0.75 * share * (abs(sigma - 1) + share * sigma / k**2) + share**2 * abs(sigma**2 - 1) / 4
    following = in_all**2 + share * sigma * abs(sigma - 1) + share**3 * sigma**2 / k**4
    growth = sqrt(max(twist_coefficient(sigma, share), 0.0)) * 2 * pi * TURNS
    limits = {
        "the next order is not small": sqrt(LARGEST_SHIFT.value / sqrt(following)),
        "its twist has little inertia": sqrt(LIGHTEST_TWIST.value / sigma),
        f"a twist beside the swing grows within {TURNS} turns": MOST_GROWTH.value / growth if growth else 1.0,
    }
    why, most = min(limits.items(), key=lambda limit: limit[1])
    if not amplitude <= most:
        raise DomainError(
            f"natural_rate_error: amplitude = {amplitude:g} is too large for this bar: at most {most:.2g}, beyond which {why}; "
            "use lagrotor.simulate, or precession_orbit for opposite spins"
        )
    turning = share**2 * sigma / (2 * k * k)
    first = (abs(frequency_shift(scene)) + turning) * square / (1 - square)
    return rate * (first + NEXT_SHIFT.value * following * square**2)


@dataclass(frozen=True)
class RateLimit:
    """One limit: `rate` in rad/s, its formula as text, and what it changes in the scene."""

    rate: float
    formula: str
    says: str


def natural_rate_limits(scene: Scene) -> dict[str, RateLimit]:
    """Limits of the natural rate near a scene with a bar: equal, opposite, massless, dumbbell.

    equal and opposite: both momenta as large as their root mean square G, G/(a + b) and G/√(a² − b²). massless:
    a = J, b = 0. dumbbell: the bar's mass in its ends, K = m ell²/4, so that b = 0, a = J + m R²/2. The formulas are
    those of `natural_frequency` with the limit put in. Raises InputError without a bar.
    """
    if scene.link is None:
        raise InputError("natural_rate_limits: the scene has no bar: it has no limits")
    mean = hypot(*scene.spins) / sqrt(2)
    length, mass = scene.link.length, scene.link.mass
    changed = {
        "equal": (replace(scene, spins=(mean, mean)), "spins equal, of the root mean square G"),
        "opposite": (replace(scene, spins=(mean, -mean)), "spins opposite, of the same G"),
        "massless": (replace(scene, link=Link(length)), "a bar without mass: {}"),
        "dumbbell": (replace(scene, link=Link(length, mass, mass * length**2 / 4)), "K = m ℓ²/4: {}"),
    }
    return {
        name: RateLimit(natural_rate(one), LIMIT_FORMULAS[name][0], says.format(LIMIT_FORMULAS[name][1]))
        for name, (one, says) in changed.items()
    }
